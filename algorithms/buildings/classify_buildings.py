"""Decide which clusters are buildings by mean entropy, penetration by the beam, adjacent clusters and surroundings."""

from dataclasses import dataclass, replace
from typing import Optional, Union

import numpy as np

from ..neighborhoods.covariance import Nearest
from ..neighborhoods.wide_in_plan import Wide
from ..params import MIN_BUILDING_AREA, POINT_DENSITY, POINT_SOURCE, nearest_points
from ..rules import rule, rules
from ..sampling.cloud_sampling import GROUND_NOISE, MEASURED, CloudSampling
from ..sampling.sufficiency import doubted, why_doubtful
from ..sampling.surface_noise import plane_roughness
from ..segmentation.cluster_measures import pulses_going_on
from ..stage import Monitor, stage, tunable
from .cluster_decisions import Decisions, decide_by_entropy, no_clusters, weakest_evidence, written_to_points
from .cluster_entropies import cluster_entropies
from .cluster_evidence import ClusterEvidence, with_penetration, with_surroundings
from .cluster_report import MEASURES, Clusters, build_report
from .entropy_split import MEAN_ENTROPIES, held_means, reference_entropies, split_of_whole
from .surface_evidence import decide_in_images, green_clusters, without_green


@rules
class ENTROPY:
    """Neighborhoods of entropies."""

    points: float = rule(1.5, "ratio", "to those that show a plane: three shares come from them, not one direction")
    points_on_lines: float = rule(1.75, "ratio", "the same on scan lines, along which neighbors say little")


# Size of the sample of each cluster whose entropy is measured. Entropies of a cluster scatter by 0.15, so that the mean
# of 256 is accurate to 0.01: half of what K-means moves the threshold by.
_MEASURED = 256


_MAX_PENETRATION = tunable(
    0.4,
    "Share of the beam that may pass through a building: cells with points below, and returns that are not the last.",
    within="(0, 1]",
)


_MIN_SHARE_AROUND = tunable(
    0.5,
    "Share of the points within a few meters around a building that must belong to buildings, its own "
    "included. Around smooth spots of crowns it is less.",
    label="Minimum share of buildings around",
    within="[0, 1]",
)


@stage(
    "Buildings",
    tags="building,entropy,k-means,unsupervised,classification,lasclassify",
    writes=("classification", "entropy", "cluster_entropy", "confidence", "reason", "weakest_evidence"),
    measures=MEASURES,
    # Reach of neighborhoods, and of the surroundings of a cluster.
    reach=5.0,
    of_whole=(*MEAN_ENTROPIES, GROUND_NOISE),
    cost=3.0,
    report_title="Why clusters are buildings",
)
def classify_buildings(
    xyz,
    classification,
    cluster_id,
    return_number=None,
    number_of_returns=None,
    reason=None,
    segment_id=None,
    red=None,
    green=None,
    blue=None,
    *,
    min_area: float = MIN_BUILDING_AREA,
    n_neighbors: Optional[int] = nearest_points(
        "the smallest neighborhood in which neither noise nor scan lines blur a plane."
    ),
    max_penetration: float = _MAX_PENETRATION,
    min_share_around: float = _MIN_SHARE_AROUND,
    density: Optional[float] = POINT_DENSITY,
    source: str = POINT_SOURCE,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find the buildings among clusters by their mean entropy and by how far laser beams penetrate them.

    Roofs are planar everywhere and have low entropy; crowns are not and have high entropy. A cluster is compared with
    the entropies of planes and volumes that are as dense and as rough as the cloud. Roofs stop the beam, crowns let it
    through: a building (class 6) needs both, or the support of buildings around it.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes.
    cluster_id : ndarray of shape (n,), int32
        Clusters from 1; points of 0 keep their class.
    return_number, number_of_returns : ndarray of shape (n,), uint8, optional
        Used for penetration where given.
    reason : ndarray of shape (n,), uint8, optional
        Reasons that the segmentation gave to points outside clusters, which they keep.
    segment_id : ndarray of shape (n,), int32, optional
        Roof surfaces; 0 if unassigned. In matched images they distinguish roofs from crowns; without them entropy does.
    red, green, blue : ndarray of shape (n,), uint16, optional
        Color, used where no pulse has several returns.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Building clusters get 6; earlier points of 6 that are not found again become 1.
    entropy : ndarray of shape (n,), float32
        Entropy of each clustered point, 0 to ln 3; NaN elsewhere.
    cluster_entropy : ndarray of shape (n,), float32
        Mean entropy of the point's cluster; NaN elsewhere.
    confidence : ndarray of shape (n,), float32
        Confidence that the cluster is a building, 0 to 1, more than 0.5 for buildings. Clusters refused in spite of a
        low entropy have 0.5 at most, undecided ones 0.5. NaN elsewhere.
    reason : ndarray of shape (n,), uint8
        Why the point's cluster is called building or not, see :class:`~..cloud.reasons.Reason`; 0 outside clusters.
    weakest_evidence : ndarray of shape (n,), uint32
        The measure nearest to its limit of the point's cluster, see :func:`~..cloud.reasons.packed_evidence`: kind,
        value and limit as digits kvvvvllll; 0 outside clusters.
    report : Report
        Counts and the two mean entropies, and a page that shows what decided.

    Notes
    -----
    Entropies follow equations 5 to 11 of the paper, in the smallest neighborhood in which neither noise nor scan lines
    blur a plane. Only clustered points are neighbors. 'Classify buildings (as published 2019)' is the method of
    the paper; everything below is this project's.

    Two-class K-means starts from the mean entropies of random points on a disk, as rough as the cloud's surfaces, and
    in a ball. These two stay in the data, each with many times the weight of all clusters, and so decide. A handful of
    clusters, or clusters of one kind only as in a forest, are not split in two. Surfaces are as rough as the ground at
    most, since nearly all points of a forest are of crowns.

    The confidence is the geometric mean of what entropy and penetration say, and nothing with more penetration than
    the maximum is a building, with one exception. Clusters adjacent to a building (dormers, eaves, parapets) are all
    edge, and points seen past an edge are no evidence: there entropy alone decides, if few of the pulses split. A
    cluster smaller than the minimum area is a building only next to another.

    Where points are few, larger spots of crowns are smooth by chance. Most of the points around these are leaves, so
    clusters with too few building points around them are refused. Such spots may lie next to each other, but none of
    them is sure. So adjacent clusters are also decided on together, by their mean confidence times the mean share
    around them, unless they are so large that ground would be seen in them among trees.

    In clouds of matched images, crowns are as closed as roofs, and penetration says nothing. There, roof surfaces are
    buildings, planar over half a meter, if the minimum share of the points around them lie on such surfaces. There, and
    in scans without second returns, colored clusters that are as green as plants are refused, roofs of grass too. The
    threshold of greenness comes from the scene: it is the middle between the medians of rough clusters and of surfaces
    of ten times the minimum area, if it separates the two. Otherwise it separates all points best into two kinds, if
    their means differ by 0.1 or more. Greenness is the normalized excess green, which shadow hardly changes.

    Confidence above 0.5 grows with the size of the cluster, to half at twice the points of the smallest building, as
    small objects such as cars can look like a roof by chance. This changes no decision. Nor does a cloud that can
    hardly show buildings, as it is thin, small or without ground: a warning says so, and no confidence is over 0.65.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy
    and the k-means concept, section 2.4. [santos2019]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> found, *_, report = classify_buildings(xyz, classes, np.where(z > 0, 1, 0))
    >>> bool((found[z > 0] == 6).all())
    True
    """
    xyz = sampling.from_corner(xyz)
    doubt = why_doubtful(xyz, classification, sampling)
    if doubt:
        monitor.warn(doubt)
    density = sampling.effective_density if density is None else density
    noise = sampling.noise_with_ground(xyz, classification)
    around = _surface_neighborhood(sampling, density, noise) if n_neighbors is None else Nearest(n_neighbors)
    monitor.resolved(density=density, n_neighbors=around.count)
    if not (cluster_id > 0).any():
        return no_clusters(classification, reason, monitor)

    # 1. The mean entropy of each cluster, and the two means that separate buildings from everything else.
    entropies = cluster_entropies(xyz, cluster_id, around, monitor.part(0, 0.85), _MEASURED)
    references = _usual_entropies(noise, around.count, density)
    split = split_of_whole(sampling, lambda: held_means(entropies.means, *references, monitor))
    monitor.resolved(building_entropy=split.building, other_entropy=split.other)
    by_entropy = decide_by_entropy(entropies.means, split)
    monitor.progress(0.9)

    # 2. Evidence of penetration and of the surroundings of each cluster.
    goes_on = pulses_going_on(return_number, number_of_returns)
    # Other programs number clusters as they like.
    group, numbers = entropies.groups(len(xyz)), np.arange(len(entropies.ids))
    evidence = ClusterEvidence(xyz, group, numbers, density, min_area, goes_on)
    through = evidence.penetration()
    monitor.progress(0.94)
    surface = by_entropy.is_building.astype(float) if segment_id is None else entropies.share_of(segment_id > 0)
    thresholds, colors = (split.separates, max_penetration, min_share_around), (red, green, blue)
    given = _Given(by_entropy, evidence, through, *thresholds, surface, colors)
    kind = sampling.kind(source)
    decided = kind.choose(laser=_decided_in_scan, images=_decided_in_images)(given, monitor)

    # 3. All points of a cluster get its class.
    report = build_report(Clusters(entropies.means, decided.reasons, split, through, max_penetration))
    smallest = min_area * density
    by_beam = {} if kind.is_surface else {"split": split, "penetration": through, "max_penetration": max_penetration}
    weakest = weakest_evidence(entropies, smallest, decided=decided, **by_beam)
    found = written_to_points(classification, reason, entropies, decided, weakest, smallest, report)
    classes, entropy, cluster_entropy, confidence, *rest = found
    return classes, entropy, cluster_entropy, doubted(confidence) if doubt else confidence, *rest


@dataclass(frozen=True)
class _Given:
    """What clusters are decided by: decisions by entropy, evidence, penetration (m,), and the thresholds of these.

    ``separates`` is whether the entropies have two means, ``surface_share`` (m,) the share of points on surfaces,
    ``colors`` are red, green and blue (n,).
    """

    by_entropy: Decisions
    evidence: ClusterEvidence
    through: np.ndarray
    separates: bool
    max_penetration: float
    min_share: float
    surface_share: np.ndarray
    colors: tuple[Optional[np.ndarray], ...]


def _decided_in_scan(given: _Given, monitor: Monitor) -> Decisions:
    """Decide on the clusters of a laser scan by entropy, penetration and surroundings."""
    if not given.separates:
        return given.by_entropy
    decided = with_penetration(given.by_entropy, given.through, given.max_penetration, given.evidence)
    monitor.progress(0.98)
    if given.evidence.goes_on is None:
        is_green, green_from = green_clusters(given.colors, given.evidence, given.surface_share > 0.5)
        monitor.resolved(plant_greenness=green_from)
        decided = without_green(decided, is_green)
    return with_surroundings(decided, given.min_share, given.evidence)


def _decided_in_images(given: _Given, monitor: Monitor) -> Decisions:
    """Decide on the clusters of matched images by :func:`.decide_in_images`, with the greenness of the scene."""
    is_green, green_from = green_clusters(given.colors, given.evidence, given.surface_share > 0.5)
    monitor.resolved(matched_images=True, plant_greenness=green_from)
    return decide_in_images(given.surface_share, is_green, given.evidence, given.min_share)


def _surface_neighborhood(sampling: CloudSampling, density: float, noise: float) -> Union[Nearest, Wide]:
    """Return the smallest neighborhood in which neither noise nor scan lines blur a plane's entropy."""
    plane = sampling.neighborhood(density, noise)
    times = ENTROPY.points_on_lines if isinstance(plane, Wide) else ENTROPY.points
    return replace(plane, count=round(times * plane.count))


def _usual_entropies(noise: float, n_neighbors: int, density: float) -> tuple[float, float]:
    """Return the mean entropies of planes of that noise, m, and of volumes."""
    reach = np.sqrt(n_neighbors / (np.pi * density))
    return reference_entropies(n_neighbors, plane_roughness(noise, density) / reach)
