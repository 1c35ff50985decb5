"""Refine buildings by self-training: a classifier learns from the result that it then corrects.

Points at edges are decided on together, by a minimum cut in the graph of their nearest neighbors. Crowns that look like
buildings by chance are removed: of thousands in a forest, some are smooth and closed.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import product
from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..cloud.reasons import Reason
from ..geometry.cheapest_labels import cheapest_cut
from ..geometry.grid import lattice, raster_cells, refuse_sparse
from ..geometry.groups import placed, run_starts
from ..packages import ndimage, spatial
from ..params import POINT_DENSITY, POINT_SOURCE
from ..rules import rule, rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..sampling.kinds import IMAGES, LASER
from ..sampling.sufficiency import doubted, why_doubtful
from ..sampling.surface_noise import SURFACES
from ..stage import Monitor, stage, tunable
from .building_columns import COLUMNS, column_size
from .cell_features import CellFeatures, CellPoints
from .cluster_decisions import HALF_SUPPORT, support
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


# Key of the survey-wide value that says whether doubtful buildings are chance.
CHANCE = "chance_buildings"

Found = tuple[np.ndarray, np.ndarray, np.ndarray, Optional[np.ndarray], Optional[np.ndarray]]


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
        measured = xyz, height_above_ground, segment_id, return_number, number_of_returns, intensity
        found = _as_learned(found, measured, density, bool(doubt), sampling, monitor)
    review = ReviewedBuildings.of(reviewed)
    if review is None:
        return found
    return (*review.decide(xyz, height_above_ground, found[:4], monitor.part(0.95, 1.0)), found[4])


def _as_learned(
    found: Found, measured: tuple, density: float, is_doubtful: bool, sampling: CloudSampling, monitor: Monitor
) -> tuple:
    """Return the results of the stage, corrected by what the scene shows; those before where it shows nothing.

    Parameters
    ----------
    found : tuple
        The results before.
    measured : tuple
        Coordinates (n, 3), m, heights (m), roof surfaces, return numbers, numbers of returns and intensities, (n,)
        each; but for coordinates and heights None where unknown.
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
    xyz, height, segment_id, *recorded = (None if values is None else values.take(used, axis=0) for values in measured)
    scene = _Scene(sampling.from_corner(xyz), classification[used], height, cluster_id[used])

    # 1. Learn from the cells of each half, or take what was learned on the whole survey.
    labeled = scene.labeled(_RULES.cell_spacings / float(np.sqrt(density)), recorded, monitor.part(0.1, 0.7))
    learned = sampling.learned(_LEARNED, partial(labeled.sample, scene.cluster_id), learn_halves)
    monitor.progress(0.8)
    if not learned:
        monitor.inform("Buildings are not refined: the scene has too few buildings or other objects to learn from.")
        return found

    # 2. The probability of each point, by what was learned on the other half.
    likely = labeled.smooth(predict(learned, labeled.features, labeled.half))
    probability = np.full(len(classification), np.nan)
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
        return (self.height > IMAGES.foot) & ~np.isin(self.classification, NEVER)

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
        of_cells = placed(likely, labeled.chosen, len(labeled.cells.count))
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
        chosen = decided_together(self.xyz[rows], gain, 1 / float(np.sqrt(density)), HALVES.half, COLUMNS.edge, monitor)
        becomes, ceases = rows[chosen & ~was], rows[was & ~chosen]
        return becomes, ceases, building[tuple(nearest)][tuple(index[becomes] for index in cell)]


def _log_odds(probability: np.ndarray) -> np.ndarray:
    """Return the logarithms (n,) of the odds of probabilities (n,)."""
    return np.log(probability / (1 - probability))


def without_chance(found: Found, height: np.ndarray, least: float, sampling: CloudSampling, monitor: Monitor) -> Found:
    """Remove the doubtful buildings of a scene that has no sure one, where they are few among all that is raised.

    A building is sure from 0.75 on: the confidence of one of twice the minimum area without any contrary evidence.

    Parameters
    ----------
    found : tuple
        Classes, buildings from 1 (0 if unassigned), confidences, reasons or None, of points (n,), and anything.
    height : ndarray of shape (n,)
        Heights above ground, m.
    least : float
        Share of the raised points that doubtful buildings must hold to stay.
    sampling : CloudSampling
        Of the cloud; of a part of a survey it says whether the doubtful buildings of the whole are chance.
    monitor : Monitor
        Receives a message with the number of removed buildings.

    Returns
    -------
    tuple
        The same, where nothing is removed; else copies, with the reason ``BY_CHANCE``.
    """
    classification, cluster_id, confidence, reason, other = found
    points = np.bincount(cluster_id, minlength=1)
    mean = np.bincount(cluster_id, np.nan_to_num(confidence), 1) / np.maximum(points, 1)
    raised = np.count_nonzero((height > LASER.raised) & (cluster_id == 0) & ~np.isin(classification, NEVER))
    points[0], mean[0] = raised, 0.0
    (is_chance,) = sampling.learned(CHANCE, lambda: np.column_stack([points, mean]), partial(_is_chance, least))
    # The rest of the scene is no building, with a mean confidence of 0.
    doubtful = is_chance * (mean > 0) * (mean < _sure())
    if not doubtful.any():
        return found
    monitor.inform(
        f"No building of the scene is sure (confidence {_sure():g}), so {doubtful.sum():g} doubtful ones are left out."
    )
    gone = doubtful[cluster_id] > 0
    return (
        np.where(gone, np.uint8(PointClass.UNCLASSIFIED), classification),
        without_gaps(np.where(gone, 0, cluster_id)),
        np.where(gone, np.minimum(confidence, np.float32(0.5)), confidence),
        None if reason is None else np.where(gone, np.uint8(Reason.BY_CHANCE), reason),
        other,
    )


def _is_chance(least_share: float, scene: np.ndarray) -> tuple[float]:
    """Return 1.0 where the doubtful buildings of a scene are chance, 0.0 where not.

    ``scene`` (k, 2) has the points and the mean confidence of each building, and of all else that is raised, with 0.
    """
    points, mean = scene.T
    few = points[mean > 0].sum() < least_share * points.sum()
    return (float(few and (mean < _sure()).all()),)


def _sure() -> float:
    """Return the confidence from which a building is sure."""
    return float(0.5 + 0.5 * support(np.float64(HALF_SUPPORT)))


def decided_together(
    xyz: np.ndarray, gain: np.ndarray, spacing: float, side: float, margin: float, monitor: Monitor
) -> np.ndarray:
    """Return the mask of points (n,) of buildings that together contradict evidence and neighbors least.

    The cut is exact in each square of a fixed lattice with a margin around it; only the square itself is kept. So a
    part of a survey with these margins gives the same result as the whole. A cut of all points at once differs in few
    of them.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m, with easting and northing from the corner of the whole.
    gain : ndarray of shape (n,)
        Log odds of building of each point by itself; infinite where its class does not change.
    spacing : float
        Mean distance between neighboring points in plan, m.
    side, margin : float
        Side of the squares and width of their margin, at most half of it, m.
    monitor : Monitor
        Receives progress.

    References
    ----------
    Greig, D.M., Porteous, B.T., Seheult, A.H., 1989. Exact maximum a posteriori estimation for binary images. Journal
    of the Royal Statistical Society B 51(2), 271-279. [greig1989]
    """
    alone = gain > 0
    if not len(alone):
        return alone
    together, done = alone.copy(), 0
    for rows, is_own in _squares(xyz[:, :2], side, margin):
        # If all points lean to one class, there is nothing to decide.
        if alone[rows].any() and not alone[rows].all():
            together[rows[is_own]] = _cheapest(xyz[rows], gain[rows], spacing)[is_own]
        done += int(is_own.sum())
        monitor.progress(done / len(xyz))
    return together


def _squares(plan: np.ndarray, side: float, margin: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the rows of the points (n, 2) in each square with its margin, and which of them are in the square."""
    shifts = product((-margin, margin), repeat=2)
    squares = np.concatenate([lattice(plan, side), *(lattice(plan + shift, side) for shift in shifts)])
    east, north = (squares - squares.min(axis=0)).T
    number = east * (north.max() + 1) + north
    own, row = number[: len(plan)], np.tile(np.arange(len(plan)), 5)
    order = np.lexsort((row, number))
    number, row = number[order], row[order]
    once = np.append(True, (np.diff(number) != 0) | (np.diff(row) != 0))
    number, row = number[once], row[once]
    for rows, numbers in zip(*(np.split(values, run_starts(number)[1:]) for values in (row, number))):
        yield rows, own[rows] == numbers


def _cheapest(xyz: np.ndarray, gain: np.ndarray, spacing: float) -> np.ndarray:
    """Return the mask of points (n,) that the minimum cut puts on the side of buildings; n >= 2."""
    distance, near = spatial.cKDTree(xyz).query(xyz, min(SURFACES.neighbors + 1, len(xyz)))
    row = np.repeat(np.arange(len(xyz)), near.shape[1])
    # A neighbor at distance 0 weighs as much as odds of e to 1, one at the usual distance half as much.
    cost = 1 / (1 + (distance.ravel() / spacing) ** 2)
    is_other = near.ravel() != row
    ends = row[is_other], near.ravel()[is_other]
    return cheapest_cut(*ends, cost[is_other], np.maximum(-gain, 0.0), np.maximum(gain, 0.0))
