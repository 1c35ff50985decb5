"""Which clusters are buildings: mean entropy and two means."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, Optional, Union

import numpy as np

from ..cloud.asprs import PointClass
from ..cloud.density import even_density, point_density
from ..features.eigen import Nearest, neighborhood_eigenvalues, shannon_entropy_lps, symmetric_eigenvalues
from ..features.noise import SurfaceSample
from ..features.wide import Wide
from ..packages import cluster
from ..params import MinBuildingArea, PointDensity, Seed
from ..segmentation.extent import (
    join_beside,
    penetration,
    plan_areas,
    share_around,
    share_beneath,
    share_going_on,
)
from ..stage import Measure, Monitor, Param, stage
from .decisions import Clusters, build_report
from .reasons import Reason

# Half as sure as what was measured says are clusters with so many times the points of the smallest building.
_SUPPORTED = 2.0

# An entropy needs half as many points again as a plane: three shares come from it and not one direction. On lines,
# where neighbors tell little that is new, it needs three quarters more.
_TIMES, _TIMES_ON_LINES = 1.5, 1.75

# Entropies that differ by less than this are alike.
_ALIKE = 1e-3

# The entropies of planes and volumes count as so many clusters; two means in one dimension settle in a few rounds.
_HELD_BY, _MOST_ROUNDS = 100, 100

# Crowns have no smooth spots so many times as large as the smallest building: what the beam passes there is glass.
_TOO_LARGE_FOR_LEAVES = 10.0

# At the edges of a roof some pulses split; in leaves most do. Less of a roof's points than this go on.
_SPLIT_AT_EDGES = 0.3

# Balconies and terraces, past which walls and lower floors are seen, have at least so much of buildings around.
_AMID_BUILDINGS = 0.5


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
            "Nearest points",
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
            "Hold the two means by the entropies that planes and volumes have at this density and noise, so that a "
            "handful of clusters, or clusters of one kind only, are not split in two. Off is the method as published.",
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
    min_share_around: Annotated[
        float,
        Param(
            "Minimum share of buildings around",
            "Share of the points standing within a few meters of a building that must be of buildings, its own among "
            "them. Around smooth spots of crowns it is less. Where it is looked at, planes that the beam passes are "
            "buildings amid others (balconies). 0 is the method as published.",
            low=0,
            high=1,
        ),
    ] = 0.0,
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
        its distances from both (and solidity and size, see Notes). More than 0.5 is a building; what is none in
        spite of its entropy has 0.5 at most, what is undecided 0.5. NaN elsewhere.
    reason : ndarray of shape (n,), uint8
        Why the point's cluster is called building or not, see :class:`~.reasons.Reason`; 0 outside clusters.
    report : Report
        Counts and the two mean entropies, and a page that shows what decided.

    Notes
    -----
    Equations 5 to 11 of the paper; the neighborhood is taken among the clustered points, with N = Ar_min d. A
    single cluster, or clusters that are all alike, have nothing for K-means to separate; unless guarded, none is
    then called a building, and the log says so. The guard knows what N random points on a disk, as rough as the
    cloud's surfaces, and in a ball have for mean entropy; K-means then starts from these two, and each counts as 100
    clusters of that entropy.

    Penetration is this project's: a roof stops the beam and a crown lets it through. A cluster's confidence is
    then the geometric mean of what its entropy and its penetration say, and none with more penetration than the
    maximum is a building, except beside one: dormers, eaves and parapets are all edge, and what is seen past them
    tells nothing. There entropy alone decides, as long as few of the pulses go on. And a cluster smaller than the
    smallest building is one only beside another: crowns have smooth spots, but no large ones. A plane of ten times
    that size is a roof of glass where the beam passes, or a row of wires: there the geometric mean of the entropy's
    confidence and of the share of points that the plane stopped decides, if it is more.

    The minimum share of buildings around is this project's, too: the fewer points there are, the larger are the spots
    of crowns that are smooth by chance. What stands around these are leaves, for the most part. Around a balcony or a
    terrace, which the beam seems to pass, are buildings: of the size of one, it is part of them when half of the
    points around are of other clusters that are.

    Small things can look like a roof by chance: a car does. What confidence has above 0.5 therefore grows with the
    size of the cluster, to half at twice the points of the smallest building, which changes no decision.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using
    entropy and the k-means concept, section 2.4.
    """
    if density is None:
        density = point_density(xyz) if neighborhood == "published" else even_density(xyz)
    around = _around(xyz, density, min_area, neighborhood) if n_neighbors is None else Nearest(n_neighbors)
    monitor.resolved(density=density, n_neighbors=around.count)
    result = np.where(classification == PointClass.BUILDING, np.uint8(PointClass.UNCLASSIFIED), classification)
    why = np.zeros(len(xyz), np.uint8) if reason is None else np.where(cluster_id > 0, 0, reason).astype(np.uint8)
    clustered = np.flatnonzero(cluster_id > 0)
    if not len(clustered):
        monitor.warn("There are no clusters, so no buildings were found.")
        undefined = (np.full(len(xyz), np.nan, np.float32) for _ in range(3))
        return result.astype(np.uint8), *undefined, why, build_report(Clusters.none())

    # 1. The mean entropy of each cluster, and the two means that tell buildings from everything else.
    values = shannon_entropy_lps(neighborhood_eigenvalues(xyz[clustered], around, monitor=monitor.part(0, 0.85)))
    ids, position, size = np.unique(cluster_id[clustered], return_inverse=True, return_counts=True)
    means = _cluster_means(values, position, len(ids))
    if guard:
        split = _held_means(means, *_usual_entropies(xyz, around.count, density), monitor)
    else:
        split = _two_means(means, seed, monitor)
    monitor.resolved(building_entropy=split.building, other_entropy=split.other)

    # 2. What each cluster is.
    places = _Places(xyz, cluster_id - 1, ids - 1, density, return_number, number_of_returns)
    planar, reasons = _by_entropy(means, split)
    sure = planar
    monitor.progress(0.9)
    through = places.penetration() if max_penetration < 1 and split.separates else None
    if through is not None:
        monitor.progress(0.94)
        sure, reasons = _by_both(sure, reasons, through, max_penetration, places, min_area)
    monitor.progress(0.98)
    if min_share_around > 0:
        sure, reasons = _by_surroundings(sure, planar, reasons, places, min_share_around, min_area)
    sure = _supported(sure, size / (min_area * density))
    monitor.progress(1.0)

    # 3. Its points are the same.
    why[clustered] = reasons[position]
    result[clustered[(sure > 0.5)[position]]] = PointClass.BUILDING
    measures = (_at_points(of, clustered, len(xyz)) for of in (values, means[position], sure[position]))
    made = Clusters(means, through, reasons, split.building, split.other, max_penetration, split.is_given)
    return result.astype(np.uint8), *measures, why, build_report(made)


def _at_points(values: np.ndarray, rows: np.ndarray, n_points: int) -> np.ndarray:
    """Return values (n_points,), float32, of which those of some ``rows`` are known, NaN elsewhere."""
    whole = np.full(n_points, np.nan, np.float32)
    whole[rows] = values
    return whole


def _around(xyz: np.ndarray, density: float, min_area: float, neighborhood: str) -> Union[Nearest, Wide]:
    """Return the neighborhood: as many points as the smallest building has, or the fewest that show a plane."""
    if neighborhood == "published":
        return Nearest(max(3, round(min_area * density)))
    sample = SurfaceSample(xyz)
    plane = sample.neighborhood(density, sample.noise())
    return replace(plane, count=round((_TIMES_ON_LINES if isinstance(plane, Wide) else _TIMES) * plane.count))


def _usual_entropies(xyz: np.ndarray, n_neighbors: int, density: float) -> tuple[float, float]:
    """Return the mean entropy of planes as rough as the cloud's surfaces, and that of volumes."""
    reach = np.sqrt(n_neighbors / (np.pi * density))
    return reference_entropies(n_neighbors, SurfaceSample(xyz).roughness(density) / reach)


def _by_entropy(means: np.ndarray, split: _Split) -> tuple[np.ndarray, np.ndarray]:
    """Return how sure each cluster is a building by its entropy (more than 0.5 is one), and the reason."""
    sure = split.confidence(means)
    reasons = np.where(sure > 0.5, Reason.PLANE, Reason.ROUGH)
    if not split.separates:
        reasons[:] = Reason.ALIKE
    undefined = ~np.isfinite(means)
    reasons[undefined] = Reason.WITHOUT_ENTROPY
    return np.where(undefined, 0.5, sure), reasons.astype(np.uint8)


def _by_both(
    sure: np.ndarray, reasons: np.ndarray, through: np.ndarray, most: float, places: _Places, min_area: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return how sure each cluster is a building by its entropy and by how much passes through, and the reason.

    ``through`` is the penetration of each cluster, ``most`` the greatest allowed.
    """
    undefined = reasons == Reason.WITHOUT_ENTROPY
    is_planar = (sure > 0.5) & ~undefined
    # A cluster without entropy stays undecided, however solid it is.
    both = np.where(undefined, 0.5, _with_solidity(sure, through, most))
    is_large = is_planar & (places.areas >= _TOO_LARGE_FOR_LEAVES * min_area)
    as_glass = np.where(is_large, np.sqrt(sure * (1 - places.share_beneath(is_large))), 0)
    is_glass, both = both <= 0.5, np.maximum(both, as_glass)
    is_solid = both > 0.5
    beside_only = is_planar & (places.share_going_on() < _SPLIT_AT_EDGES)
    is_building = places.standing_or_beside(is_solid, beside_only, min_area)
    found = {
        Reason.WITHOUT_ENTROPY: undefined,
        Reason.LARGE_PLANE: is_building & is_solid & is_glass,
        Reason.SOLID_PLANE: is_building & is_solid & is_planar,
        Reason.SOLID: is_building & is_solid,
        Reason.BESIDE: is_building,
        Reason.TOO_SMALL: is_solid,
        Reason.PENETRATED: is_planar,
    }
    reasons = np.select(list(found.values()), list(found), Reason.ROUGH).astype(np.uint8)
    return np.where(is_building, np.where(is_solid, both, sure), np.minimum(both, 0.5)), reasons


def _by_surroundings(
    sure: np.ndarray, planar: np.ndarray, reasons: np.ndarray, places: _Places, least: float, min_area: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return how sure each cluster is a building, and the reason, given how much around it is of buildings.

    ``planar`` is how sure its entropy alone is.
    """
    is_building = sure > 0.5
    share = places.share_around(is_building)
    amid_others = is_building & (share < least)
    amid_buildings = (reasons == Reason.PENETRATED) & (places.areas >= min_area) & (share >= _AMID_BUILDINGS)
    reasons = np.select([amid_others, amid_buildings], [Reason.AMID_OTHERS, Reason.BESIDE], reasons)
    return np.select([amid_others, amid_buildings], [0.5, planar], sure), reasons.astype(np.uint8)


@dataclass(frozen=True)
class _Places:
    """Where clusters (m,) lie among all points, to ask what is beneath, beside and around them.

    ``group`` (n,) is the cluster of each point, negative for none; ``numbers`` (m,) are those that have points.
    """

    xyz: np.ndarray
    group: np.ndarray
    numbers: np.ndarray
    density: float
    return_number: Optional[np.ndarray]
    number_of_returns: Optional[np.ndarray]

    @cached_property
    def areas(self) -> np.ndarray:
        """The area (m²) of each cluster."""
        member = self.group >= 0
        return plan_areas(self.xyz[member], self.group[member], self.density)[self.numbers]

    def penetration(self) -> np.ndarray:
        """Return how much of the beam passes through each cluster."""
        through = penetration(self.xyz, self.group, self.density, self.return_number, self.number_of_returns)
        return through[self.numbers]

    def share_beneath(self, is_chosen: np.ndarray) -> np.ndarray:
        """Return the share of the points that passed each of the chosen clusters (m,), 0 for others."""
        shares = np.zeros(len(self.numbers))
        if is_chosen.any():
            group = np.where(np.append(self._by_number(is_chosen), False)[self.group], self.group, -1)
            shares[is_chosen] = share_beneath(self.xyz, group, self.density)[self.numbers[is_chosen]]
        return shares

    def share_going_on(self) -> np.ndarray:
        """Return the share of each cluster's points that are not the last of their pulse."""
        return share_going_on(self.group, self.return_number, self.number_of_returns)[self.numbers]

    def share_around(self, is_chosen: np.ndarray) -> np.ndarray:
        """Return how much of what stands around each cluster is of the chosen ones (m,)."""
        return share_around(self.xyz, self.group, self._by_number(is_chosen))[self.numbers]

    def standing_or_beside(self, is_solid: np.ndarray, is_plane: np.ndarray, min_area: float) -> np.ndarray:
        """Return the solid clusters of a building's size, and those beside them that are solid or else plane."""
        strong = self._by_number(is_solid & (self.areas >= min_area))
        weak = self._by_number(is_solid | is_plane)
        return join_beside(self.xyz, self.group, strong, weak, self.density)[self.numbers]

    def _by_number(self, mask: np.ndarray) -> np.ndarray:
        """Return a mask of the clusters with False at the numbers between them that none has."""
        every = np.zeros(int(self.numbers[-1]) + 1, bool)
        every[self.numbers] = mask
        return every


def _with_solidity(sure: np.ndarray, through: np.ndarray, most: float) -> np.ndarray:
    """Return the geometric mean of the entropy's confidence and of solidity, 0 at twice the penetration allowed."""
    solid = np.clip(1 - through / (2 * most), 0, 1)
    # Geometric, so that neither makes up for the other: a dense crown stops the beam and is no roof.
    both = np.sqrt(sure * solid)
    return np.where(through <= most, both, np.minimum(both, 0.5))


def _supported(sure: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Return how sure clusters are that hold ``size`` times the points of the smallest building, if they may be one."""
    return np.where(sure > 0.5, 0.5 + (sure - 0.5) * size**2 / (size**2 + _SUPPORTED**2), sure)


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


def _two_means(means: np.ndarray, seed: int, monitor: Monitor) -> _Split:
    """Separate the clusters' mean entropies in two, as published."""
    known = means[np.isfinite(means)]
    if len(known) < 2 or np.ptp(known) < _ALIKE:
        one = "is only one cluster" if len(known) < 2 else "are only clusters of the same entropy"
        monitor.warn(f"There {one}: nothing to separate, so nothing was called a building.")
        same = float(known.mean()) if len(known) else np.nan
        return _Split(same, same)
    two_means = cluster.KMeans(n_clusters=2, n_init=10, random_state=seed).fit(known[:, None])
    return _Split(*sorted(two_means.cluster_centers_[:, 0].tolist()))


def _held_means(means: np.ndarray, plane: float, volume: float, monitor: Monitor) -> _Split:
    """Separate in two as K-means does, from the entropies of planes and volumes and held by them.

    Each of the two counts as ``_HELD_BY`` clusters: many clusters move the means to where they are, a handful can't.
    """
    known = np.sort(means[np.isfinite(means)])
    low, high = plane, volume
    for _ in range(_MOST_ROUNDS):
        is_low = known <= (low + high) / 2
        before = low, high
        low = float((known[is_low].sum() + _HELD_BY * plane) / (is_low.sum() + _HELD_BY))
        high = float((known[~is_low].sum() + _HELD_BY * volume) / ((~is_low).sum() + _HELD_BY))
        if (low, high) == before:
            break
    is_one_kind = bool(is_low.all() or not is_low.any())
    if is_one_kind:
        monitor.warn(
            "The entropies of the clusters don't form two groups; each cluster was compared "
            f"with the entropy of planes ({plane:.2f}) and volumes ({volume:.2f}) instead."
        )
    return _Split(low, high, is_given=is_one_kind)


def reference_entropies(n_points: int, roughness: float = 0.0, trials: int = 400) -> tuple[float, float]:
    """Return the mean entropy of ``n_points`` random points on a disk and in a ball.

    Parameters
    ----------
    n_points : int
        Points of a neighborhood.
    roughness : float
        Standard deviation of the points across the disk, as a share of its radius.
    trials : int
        Disks and balls drawn.

    Returns
    -------
    plane, volume : float
        Fixed random numbers: the same arguments always give the same two figures.
    """
    random = np.random.default_rng(0)
    n_points = min(n_points, 500)  # beyond, the figures change by less than 0.01
    directions = random.normal(size=(trials, n_points, 3))
    ball = directions / np.linalg.norm(directions, axis=2, keepdims=True)
    ball *= random.random((trials, n_points, 1)) ** (1 / 3)
    angle = random.random((trials, n_points)) * 2 * np.pi
    radius = np.sqrt(random.random((trials, n_points)))
    across = roughness * random.normal(size=angle.shape)
    disk = np.stack([radius * np.cos(angle), radius * np.sin(angle), across], axis=2)
    return _mean_entropy(disk), _mean_entropy(ball)


def _mean_entropy(points: np.ndarray) -> float:
    offsets = points - points.mean(axis=1, keepdims=True)
    products = np.einsum("tni,tnj->tij", offsets, offsets) / points.shape[1]
    covariances = products[:, [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    return float(shannon_entropy_lps(symmetric_eigenvalues(covariances)).mean())
