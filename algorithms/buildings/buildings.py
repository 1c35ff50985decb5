"""Which clusters are buildings: mean entropy and two means."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..cloud.density import point_density
from ..features.eigen import neighborhood_eigenvalues, shannon_entropy_lps, symmetric_eigenvalues
from ..features.noise import surface_neighbors, surface_noise
from ..packages import cluster
from ..params import MinBuildingArea, PointDensity, Seed
from ..segmentation.extent import penetration
from ..stage import Measure, Monitor, Param, stage
from .decisions import Clusters, build_report
from .reasons import Reason

# Entropies that differ by less than this are alike.
_ALIKE = 1e-3


@stage(
    "Classify buildings",
    group="Buildings",
    tags="building,entropy,k-means,unsupervised,classification",
    writes=("classification", "entropy", "cluster_entropy", "confidence", "reason"),
    measures=(
        Measure("clusters", "Clusters"),
        Measure("building_clusters", "Clusters called building"),
        Measure("undecided_clusters", "Undecided clusters"),
        Measure("building_entropy", "Mean entropy of buildings"),
        Measure("other_entropy", "Mean entropy of everything else"),
    ),
)
def classify_buildings(
    xyz,
    classification,
    cluster_id,
    return_number=None,
    number_of_returns=None,
    reason=None,
    *,
    min_area: MinBuildingArea = 4.0,
    n_neighbors: Annotated[
        Optional[int],
        Param(
            "Neighbors",
            "Points of the neighborhood in which the entropy of a point is measured, itself among them (N).",
            low=3,
            high=10_000,
            automatic="as the neighborhood says.",
        ),
    ] = None,
    neighborhood: Annotated[
        str,
        Param(
            "Neighborhood",
            "How large automatic neighborhoods are: 'published' holds the points of the minimum building area; "
            "'surface' is the smallest in which neither noise nor scan lines blur a plane, for clusters that are "
            "narrow or single roof surfaces.",
            choices=("published", "surface"),
        ),
    ] = "published",
    guard: Annotated[
        bool,
        Param(
            "Guard against one kind only",
            "Where both means lie on the same side of what planes and volumes have (no trees, or no buildings), "
            "compare each cluster with that instead of splitting one kind in two.",
        ),
    ] = True,
    max_penetration: Annotated[
        float,
        Param(
            "Maximum penetration",
            "How much of the beam may pass through a building (cells with points beneath, returns that are not the "
            "last). Below 1 the penetration of a cluster counts as much as its entropy; 1 is the method as published.",
            low=0,
            high=1,
            open_low=True,
        ),
    ] = 1.0,
    density: PointDensity = None,
    seed: Seed = 0,
    monitor=None,
):
    """Find the buildings among clusters by their mean entropy.

    Roofs are planar everywhere and have low entropy, crowns are not and have high entropy. Two-class K-means on
    the mean entropies of the clusters separates them; the class with the lower mean is buildings (class 6).

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
        What the segmentation said of points outside clusters, which stays.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Building clusters get 6; what was 6 and is not found again becomes 1.
    entropy : ndarray of shape (n,), float32
        Entropy of each clustered point, 0 to ln 3; NaN elsewhere.
    cluster_entropy : ndarray of shape (n,), float32
        Mean entropy of the point's cluster; NaN elsewhere.
    confidence : ndarray of shape (n,), float32
        How sure the cluster is a building, 0 to 1: the distance of its entropy from the upper mean over the sum of
        its distances from both (and solidity and size, see Notes); 0.5 is undecided. NaN elsewhere.
    reason : ndarray of shape (n,), uint8
        Why the point's cluster is called building or not, see :class:`~.reasons.Reason`; 0 outside clusters.
    report : Report
        Counts and the two mean entropies, and a page that shows what decided.

    Notes
    -----
    Equations 5 to 11 of the paper; the neighborhood is taken among the clustered points, with N = Ar_min d. A
    single cluster, or clusters that are all alike, have nothing for K-means to separate; unless guarded, none is
    then called a building, and the log says so. The guard knows what N random points on a disk and in a ball have
    for mean entropy; where K-means' means lie on both sides of the middle, it changes nothing.

    Penetration is this project's: a roof stops the beam and a crown lets it through. A cluster's confidence is
    then the geometric mean of what its entropy and its penetration say, and none with more penetration than the
    maximum is a building.

    Small things can look like a roof by chance: a car does. Confidence above 0.5 is therefore averaged with as many
    undecided points as the smallest building has, which changes no decision.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using
    entropy and the k-means concept, section 2.4.
    """
    clustered = np.flatnonzero(cluster_id > 0)
    density = point_density(xyz) if density is None else density
    if n_neighbors is None:
        n_neighbors = _neighbors(xyz, density, min_area, neighborhood)
    monitor.resolved(density=density, n_neighbors=n_neighbors)

    entropy = np.full(len(xyz), np.nan, np.float32)
    cluster_entropy, confidence = entropy.copy(), entropy.copy()
    result = np.where(classification == PointClass.BUILDING, np.uint8(PointClass.UNCLASSIFIED), classification)
    why = np.zeros(len(xyz), np.uint8) if reason is None else np.where(cluster_id > 0, 0, reason).astype(np.uint8)
    if not len(clustered):
        monitor.warn("There are no clusters, so no buildings were found.")
        return result.astype(np.uint8), entropy, cluster_entropy, confidence, why, build_report(Clusters.none())

    values = shannon_entropy_lps(neighborhood_eigenvalues(xyz[clustered], None, n_neighbors, monitor))
    ids, position, size = np.unique(cluster_id[clustered], return_inverse=True, return_counts=True)
    means = _cluster_means(values, position, len(ids))
    split = _split(means, n_neighbors, guard, seed, monitor)
    monitor.resolved(building_entropy=split.building, other_entropy=split.other)
    through = None
    if max_penetration < 1 and split.separates:
        through = penetration(xyz, cluster_id - 1, density, return_number, number_of_returns)[ids - 1]
    sure, reasons = _decide(means, through, max_penetration, split)
    sure = _supported(sure, size / (min_area * density))

    entropy[clustered] = values
    cluster_entropy[clustered] = means[position]
    confidence[clustered] = sure[position]
    why[clustered] = reasons[position]
    result[clustered[(sure > 0.5)[position]]] = PointClass.BUILDING
    made = Clusters(means, through, reasons, split.building, split.other, max_penetration, split.is_given)
    return result.astype(np.uint8), entropy, cluster_entropy, confidence, why, build_report(made)


def _neighbors(xyz: np.ndarray, density: float, min_area: float, neighborhood: str) -> int:
    """Return the size of neighborhoods: the points of the smallest building, or the fewest that show a plane."""
    if neighborhood == "published":
        return max(3, round(min_area * density))
    # An entropy needs half as many again as a plane: three shares come from it and not one direction.
    return round(1.5 * surface_neighbors(xyz, density, surface_noise(xyz)))


def _decide(
    means: np.ndarray, through: Optional[np.ndarray], most: float, split: _Split
) -> tuple[np.ndarray, np.ndarray]:
    """Return how sure each cluster is a building (more than 0.5 is one), and the reason.

    ``through`` is the penetration of each cluster, None where it doesn't count, and ``most`` the greatest allowed.
    """
    sure = split.confidence(means)
    is_planar = sure > 0.5
    reasons = np.where(is_planar, Reason.PLANE, Reason.ROUGH)
    if through is not None:
        sure = _with_solidity(sure, through, most)
        solid = np.where(is_planar, Reason.SOLID_PLANE, Reason.SOLID)
        reasons = np.where(sure > 0.5, solid, np.where(is_planar, Reason.PENETRATED, Reason.ROUGH))
    if not split.separates:
        reasons[:] = Reason.ALIKE
    # A cluster without entropy stays undecided, however solid it is.
    undefined = ~np.isfinite(means)
    reasons[undefined] = Reason.WITHOUT_ENTROPY
    return np.where(undefined, 0.5, sure), reasons.astype(np.uint8)


def _with_solidity(sure: np.ndarray, penetration: np.ndarray, most: float) -> np.ndarray:
    """Return the geometric mean of the entropy's confidence and of solidity, 0 at twice the penetration allowed."""
    solid = np.clip(1 - penetration / (2 * most), 0, 1)
    # Geometric, so that neither makes up for the other: a dense crown stops the beam and is no roof.
    both = np.sqrt(sure * solid)
    return np.where(penetration <= most, both, np.minimum(both, 0.5))


def _supported(sure: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Return how sure clusters are that hold ``size`` times the points of the smallest building, if they may be one."""
    return np.where(sure > 0.5, 0.5 + (sure - 0.5) * size / (size + 1), sure)


def _cluster_means(values: np.ndarray, position: np.ndarray, count: int) -> np.ndarray:
    """Return the mean entropy of each cluster (equation 5), NaN where no point of it has one."""
    defined = np.isfinite(values)
    size = np.bincount(position[defined], minlength=count)
    total = np.bincount(position[defined], values[defined], count)
    return np.divide(total, size, out=np.full(count, np.nan), where=size > 0)


@dataclass(frozen=True)
class _Split:
    """Two mean entropies, of buildings and of everything else; alike, they leave every cluster undecided.

    They are ``is_given`` where they are those of planes and volumes and not of clusters.
    """

    building: float
    other: float
    is_given: bool = False

    @property
    def separates(self) -> bool:
        """Whether there are two means and not one."""
        return self.building < self.other

    def confidence(self, means: np.ndarray) -> np.ndarray:
        """Return the distance to the others' mean over the sum of both distances."""
        to_other, to_building = np.abs(means - self.other), np.abs(means - self.building)
        both = to_other + to_building
        # Beyond its own mean a cluster is no less sure.
        outside = np.where(means <= self.building, 1.0, np.where(means >= self.other, 0.0, np.nan))
        between = np.divide(to_other, both, out=np.full(len(means), 0.5), where=both > 0)
        return np.where(np.isnan(outside) | (self.building == self.other), between, outside)


def _split(means: np.ndarray, n_neighbors: int, guard: bool, seed: int, monitor: Monitor) -> _Split:
    """Separate the clusters' mean entropies in two."""
    known = means[np.isfinite(means)]
    alike = len(known) < 2 or np.ptp(known) < _ALIKE
    if alike and not guard:
        one = "is only one cluster" if len(known) < 2 else "are only clusters of the same entropy"
        monitor.warn(f"There {one}: nothing to separate, so nothing was called a building.")
        same = float(known.mean()) if len(known) else np.nan
        return _Split(same, same)
    if not alike:
        two_means = cluster.KMeans(n_clusters=2, n_init=10, random_state=seed).fit(known[:, None])
        low, high = sorted(two_means.cluster_centers_[:, 0].tolist())
        plane, volume = reference_entropies(n_neighbors)
        if not guard or low < (plane + volume) / 2 < high:
            return _Split(low, high)
    plane, volume = reference_entropies(n_neighbors)
    monitor.warn(
        "The entropies of the clusters don't form two groups; each cluster was compared "
        f"with the entropy of planes ({plane:.2f}) and volumes ({volume:.2f}) instead."
    )
    return _Split(plane, volume, is_given=True)


def reference_entropies(n_points: int, trials: int = 400) -> tuple[float, float]:
    """Return the mean entropy of ``n_points`` random points on a disk and in a ball.

    Fixed random numbers: the same count always gives the same two figures.
    """
    random = np.random.default_rng(0)
    n_points = min(n_points, 500)  # beyond, the figures change by less than 0.01
    directions = random.normal(size=(trials, n_points, 3))
    ball = directions / np.linalg.norm(directions, axis=2, keepdims=True)
    ball *= random.random((trials, n_points, 1)) ** (1 / 3)
    angle = random.random((trials, n_points)) * 2 * np.pi
    radius = np.sqrt(random.random((trials, n_points)))
    disk = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros_like(angle)], axis=2)
    return _mean_entropy(disk), _mean_entropy(ball)


def _mean_entropy(points: np.ndarray) -> float:
    offsets = points - points.mean(axis=1, keepdims=True)
    products = np.einsum("tni,tnj->tij", offsets, offsets) / points.shape[1]
    covariances = products[:, [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    return float(shannon_entropy_lps(symmetric_eigenvalues(covariances)).mean())
