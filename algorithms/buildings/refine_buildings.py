"""Refine buildings by self-training: a classifier learns from the result that it then corrects."""

from dataclasses import dataclass
from functools import cached_property, partial
from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..cloud.reasons import Reason
from ..geometry.grid import raster_cells, refuse_sparse
from ..packages import ndimage
from ..params import POINT_DENSITY, POINT_SOURCE
from ..rules import rule, rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..sampling.kinds import IMAGES, LASER
from ..sampling.sufficiency import doubted, why_doubtful
from ..stage import Monitor, stage, tunable
from .building_columns import COLUMNS, column_size
from .cell_features import CellFeatures, CellPoints
from .chance_buildings import CHANCE, without_chance
from .edge_classes import decided_together
from .reviewed_buildings import NEVER, REVIEWED, ReviewedBuildings, with_changed, without_gaps
from .scene_learning import RULES as HALVES
from .scene_learning import LabeledCells, learn_halves, predict, shared_by_surfaces
from .space_cells import SpaceCells

# Key of the survey-wide values that were learned.
_LEARNED = "building_likeness"


@rules
class _RULES:
    """Points examined and limits of changes; fitted on seven real airborne clouds, where F rises by 0.86 %."""

    cell_spacings: float = rule(
        4.0, "point spacings", "fitted: side of a cell, 16 points of a roof; 3 and 6 gain 0.1 less"
    )
    becomes: float = rule(0.65, "probability", "fitted: over it a point by itself becomes building; 0.5 gains 0.2 less")
    ceases: float = rule(
        0.17, "probability", "fitted: under it a point by itself ceases to be building; 0.2 gains the same"
    )


@stage(
    "Buildings",
    tags="building,self-training,learning,logistic regression,refine",
    input_layers=(REVIEWED,),
    writes=("classification", "cluster_id", "confidence", "reason", "building_probability"),
    written_if={
        "confidence": "where the cloud has them",
        "reason": "where the cloud has them",
        "building_probability": "where the buildings of the scene could be learned",
    },
    # The margin of the squares in which points are decided together, and two rings of cells around each point, 4 m wide
    # at 1 point/m²: one for the features of a cell, and one for smoothing.
    reach=HALVES.half + COLUMNS.edge + 8.0,
    of_whole=(_LEARNED, CHANCE),
    cost=2.5,
)
def refine_buildings(
    xyz,
    classification,
    height_above_ground,
    cluster_id,
    confidence=None,
    reason=None,
    segment_id=None,
    return_number=None,
    number_of_returns=None,
    intensity=None,
    reviewed=None,
    *,
    learn: bool = tunable(True, label="Learn from the scene"),
    # Significance: 1.8 % at most in seven forests, as they come and thinned; 6 % for a shed amid eight trees.
    min_doubtful_share: float = tunable(0.05, label="Least share of doubtful buildings", within="[0, 1]"),
    density: Optional[float] = POINT_DENSITY,
    source: str = POINT_SOURCE,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Correct the edges of buildings by what the other buildings of the scene look like.

    The classes at hand are the labels of a logistic regression. On one half of the scene it learns how points of
    buildings differ from all others in shape, height, returns and intensity. It then gives a probability to each point
    of the other half, and the reverse. Points up to 2 m from the edge of a building then get new classes, all together:
    the ones that contradict the probabilities, the present classes and each other least. A minimum cut in the graph of
    nearest neighbors finds them. Nothing comes from outside the cloud.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes with whole buildings (6), as 'Complete buildings' leaves them.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.
    cluster_id : ndarray of shape (n,), int32
        Buildings from 1; 0 if unassigned.
    confidence : ndarray of shape (n,), float32, optional
        Confidence that points are of buildings, 0 to 1.
    reason : ndarray of shape (n,), uint8, optional
        Why points are called building or not, see :class:`~..cloud.reasons.Reason`.
    segment_id : ndarray of shape (n,), int32, optional
        Roof surfaces, whose points share a part of their probability; 0 if unassigned.
    return_number, number_of_returns : ndarray of shape (n,), uint8, optional
        Used where pulses have several returns.
    intensity : ndarray of shape (n,), uint16, optional
        Used where it differs between points.
    reviewed : LayerFeatures, optional
        Footprints with decisions. Raised points within one that was kept or changed become building where hardly
        any is yet; points of deleted ones cease to be. Decisions are no labels: they would change nothing else.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Points that look like buildings become 6, points of buildings that don't become 1; ground, water, bridge decks,
        noise and points up to 0.5 m above the ground never change.
    cluster_id : ndarray of shape (n,), int32
        Buildings from 1 without gaps; points that become building get the nearest one, and points of deleted reviewed
        buildings keep their number.
    confidence : ndarray of shape (n,), float32, or None
        Points that change get their probability, other points of buildings the geometric mean of theirs and it; None
        where not given.
    reason : ndarray of shape (n,), uint8, or None
        The same with the reason; None where not given.
    building_probability : ndarray of shape (n,), float32, or None
        Probability of building, 0 to 1, smooth over neighbors; 0 for ground, water, bridge decks and points lower than
        0.2 m, NaN for noise. None where nothing was learned.

    Other Parameters
    ----------------
    learn
        Learn what buildings of this cloud look like, and correct points near their edges that look otherwise. Without
        it nothing is changed.
    min_doubtful_share
        In a scene without a sure building, doubtful ones are left out where they hold less than this share of the
        raised points: of thousands of crowns some look like roofs by chance. 0 keeps them.

    Notes
    -----
    This is self-training in one round, on all labels: half-wrong ones cancel out, and walls are learned although few
    points of walls are certain. Points are described in cubes of four point spacings, alone and with the 26 around:
    shape (eigenvalues), elevation, height, returns, intensity, and the column in plan, three cubes wide. Halves
    are squares of 10 m in turn, so that no point is judged by labels of its own surroundings alone. What is wrong
    everywhere in a scene is learned, too.

    First, the doubtful buildings of a scene without a sure one are left out, where they hold under a twentieth of the
    raised points: of thousands of crowns some look like roofs by chance. A cloud that can hardly show buildings keeps
    them, as none of it is sure.

    Edges are not changed in scenes with a single building. Nothing is changed in clouds of matched images, which show
    crowns and roofs as one closed surface: there the corrections lose as much as they gain.

    References
    ----------
    Yarowsky, D., 1995. Unsupervised word sense disambiguation rivaling supervised methods. Proceedings of the 33rd
    Annual Meeting of the Association for Computational Linguistics, 189-196 (self-training). [yarowsky1995]
    Weinmann, M., Jutzi, B., Hinz, S., Mallet, C., 2015. Semantic point cloud interpretation based on optimal
    neighborhoods, relevant features and efficient classifiers. ISPRS Journal of Photogrammetry and Remote Sensing 105,
    286-304 (features). [weinmann2015]

    Greig, D.M., Porteous, B.T., Seheult, A.H., 1989. Exact maximum a posteriori estimation for binary images. Journal
    of the Royal Statistical Society B 51(2), 271-279 (minimum cut). [greig1989]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> found, *_ = refine_buildings(xyz, classes, z, np.where(z > 0, 1, 0))
    >>> bool((found == classes).all())
    True
    """
    density = sampling.effective_density if density is None else density
    monitor.resolved(density=density)
    monitor.progress(0.1)
    found = classification, cluster_id, confidence, reason, None
    if learn and not sampling.is_closed_surface(source):
        doubt = why_doubtful(xyz, classification, sampling)
        if confidence is not None and not doubt:
            found = without_chance(found, height_above_ground, min_doubtful_share, sampling, monitor)
        measured = height_above_ground, segment_id, return_number, number_of_returns, intensity
        found = _as_learned(xyz, found, measured, density, bool(doubt), sampling, monitor)
    review = ReviewedBuildings.of(reviewed)
    if review is None:
        return found
    return (*review.decide(xyz, height_above_ground, found[:4], monitor.part(0.95, 1.0)), found[4])


def _as_learned(
    xyz: np.ndarray,
    found: tuple,
    measured: tuple,
    density: float,
    is_doubtful: bool,
    sampling: CloudSampling,
    monitor: Monitor,
) -> tuple:
    """Return the results of the stage, corrected by what the scene shows; those before where it shows nothing.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates, m.
    found : tuple
        The results before.
    measured : tuple
        Heights (m), roof surfaces, return numbers, numbers of returns and intensities, (n,) each; but for the heights
        None where unknown.
    density : float
        Points per square meter.
    is_doubtful : bool
        Whether the cloud can hardly show buildings.
    sampling : CloudSampling
        How the cloud was sampled.
    monitor : Monitor
        Receives progress and messages.
    """
    classification, cluster_id, confidence, reason, _ = found
    used = not_noise(classification)
    if not len(used):
        return found
    height, segment_id, *recorded = (None if values is None else values[used] for values in measured)
    scene = _Scene(sampling.from_corner(xyz.take(used, axis=0)), classification[used], height, cluster_id[used])

    # 1. Learn from the cells of each half, or take what was learned on the whole survey.
    size = _RULES.cell_spacings / float(np.sqrt(density))
    labeled = scene.labeled(size, recorded, monitor.part(0.1, 0.7))
    learned = sampling.learned(_LEARNED, partial(labeled.sample, scene.cluster_id), learn_halves)
    monitor.progress(0.8)
    if not learned:
        monitor.inform("Buildings are not refined: the scene has too few buildings or other objects to learn from.")
        return found

    # 2. The probability of each point, by what was learned on the other half.
    likely = labeled.smooth(predict(learned, labeled.features, labeled.half))
    probability = np.full(len(xyz), np.nan)
    probability[used] = shared_by_surfaces(scene.of_points(labeled, likely), segment_id)
    # Free them first, as the distances to edges need the memory.
    del labeled, likely
    monitor.progress(0.9)

    # 3. The classes of points near edges, all together.
    becomes, ceases, nearest = scene.changes(probability[used], density, monitor.part(0.9, 0.95))
    becomes, ceases = used[becomes], used[ceases]
    monitor.resolved(points_added=len(becomes), points_removed=len(ceases))
    if confidence is not None:
        sure = doubted(probability) if is_doubtful else probability
        # Evidence and likeness can each make a building doubtful.
        both = np.where(classification == PointClass.BUILDING, np.sqrt(confidence * sure), confidence)
        confidence = with_changed(both.astype(np.float32), sure[becomes], becomes, sure[ceases], ceases)
    if reason is not None:
        reason = with_changed(reason, Reason.LIKE_BUILDINGS, becomes, Reason.UNLIKE_BUILDINGS, ceases)
    return (
        with_changed(classification, PointClass.BUILDING, becomes, PointClass.UNCLASSIFIED, ceases),
        without_gaps(with_changed(cluster_id, nearest, becomes, 0, ceases)),
        confidence,
        reason,
        probability.astype(np.float32),
    )


@dataclass(frozen=True)
class _Scene:
    """All points (n,) but noise: coordinates (m) from the corner of the whole, classes, heights (m) and buildings."""

    xyz: np.ndarray
    classification: np.ndarray
    height: np.ndarray
    cluster_id: np.ndarray

    @property
    def is_building(self) -> np.ndarray:
        """Which points are of buildings."""
        return self.classification == PointClass.BUILDING

    @cached_property
    def is_raised(self) -> np.ndarray:
        """Which points are learned, and may be of buildings."""
        never = np.isin(self.classification, NEVER)
        return (self.height > IMAGES.foot) & ~never

    def labeled(self, size: float, recorded: list[Optional[np.ndarray]], monitor: Monitor) -> LabeledCells:
        """Return the cells of a ``size`` (m) with raised points, and what they are like.

        ``recorded`` are return numbers, numbers of returns and intensities, (n,) each; None where unknown.
        """
        number, of, intensity = recorded
        has_returns = number is not None and of is not None and of.max(initial=0) > 1
        cells = SpaceCells(self.xyz, size)
        monitor.progress(0.3)
        raised = cells.sums(self.is_raised)
        chosen = np.flatnonzero(raised)
        label = cells.sums(self.is_raised & self.is_building)[chosen] / raised[chosen]
        points = CellPoints(
            self.xyz,
            self.height,
            self.classification == PointClass.GROUND,
            (number, of) if has_returns else None,
            intensity if intensity is not None and intensity.any() else None,
        )
        around = cells.around(chosen)
        features = CellFeatures(points, cells, chosen, around)
        monitor.progress(1.0)
        return LabeledCells(cells, chosen, around, raised[chosen], label, features)

    def of_points(self, labeled: LabeledCells, likely: np.ndarray) -> np.ndarray:
        """Return the probability (n,) of points, that (k,) of their cells; 0 where they are not raised."""
        of_cells = np.zeros(len(labeled.cells.count))
        of_cells[labeled.chosen] = likely
        return np.where(self.is_raised, of_cells[labeled.cells.cell], 0.0)

    def changes(
        self, probability: np.ndarray, density: float, monitor: Monitor
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the rows of points that become building, and of those that cease; the building nearest to the former.

        ``probability`` (n,) is the probability of building, ``density`` the density of points (points/m²).
        """
        size = column_size(density)
        refuse_sparse(self.xyz, size)
        cell = raster_cells(self.xyz, size, 1)
        building = np.zeros((cell[0].max() + 2, cell[1].max() + 2), np.int32)
        # If a cell has several buildings, take the greatest number, so that the order of points doesn't matter.
        np.maximum.at(building, tuple(index[self.is_building] for index in cell), self.cluster_id[self.is_building])
        outside, nearest = ndimage.distance_transform_edt(building == 0, return_indices=True)
        inside = ndimage.distance_transform_edt(building > 0)
        distance = np.maximum(outside, inside)[cell] * size
        # Points beyond the edges are neighbors of those that change. A part of a survey may hold no building.
        near = (distance <= 2 * COLUMNS.edge) & (building.max() > 0)
        rows = np.flatnonzero(self.is_raised & (self.height > LASER.foot) & near)
        was = self.is_building[rows]
        gain = _log_odds(probability[rows]) - _log_odds(np.where(was, _RULES.ceases, _RULES.becomes))
        gain = np.where(distance[rows] <= COLUMNS.edge, gain, np.where(was, np.inf, -np.inf))
        together = decided_together(
            self.xyz[rows], gain, 1 / float(np.sqrt(density)), HALVES.half, COLUMNS.edge, monitor
        )
        becomes, ceases = rows[together & ~was], rows[was & ~together]
        of_nearest = building[tuple(nearest)]
        return becomes, ceases, of_nearest[tuple(index[becomes] for index in cell)]


def _log_odds(probability: np.ndarray) -> np.ndarray:
    """Return the logarithms (n,) of the odds of probabilities (n,)."""
    return np.log(probability / (1 - probability))
