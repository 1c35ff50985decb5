"""Decide which clusters are buildings as published in 2019, by mean entropy and two means."""

from typing import Optional

import numpy as np

from ..geometry.tin import PLANE_POINTS
from ..neighborhoods.covariance import Nearest
from ..packages import cluster
from ..params import MIN_BUILDING_AREA, PAPER_THRESHOLDS, POINT_DENSITY, THRESHOLDS, nearest_points
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Monitor, stage, tunable
from .cluster_decisions import decide_by_entropy, no_clusters, weakest_evidence, written_to_points
from .cluster_entropies import cluster_entropies
from .cluster_report import MEASURES, Clusters, build_report
from .entropy_split import MEAN_ENTROPIES, Split, split_of_whole

# Reach of neighborhoods (m): 1.1 m for 4 m², more in sparse clouds.
_REACH = 5.0


@stage(
    "Buildings",
    title="Classify buildings (as published 2019)",
    tags="building,entropy,k-means,kmeans,unsupervised,classification,Santos",
    writes=("classification", "entropy", "cluster_entropy", "confidence", "reason", "weakest_evidence"),
    measures=MEASURES,
    reach=_REACH,
    of_whole=MEAN_ENTROPIES,
    cost=2.0,
    packages=("scipy", "scikit-learn"),
)
def classify_buildings_2019(
    xyz,
    classification,
    cluster_id,
    reason=None,
    *,
    thresholds: str = THRESHOLDS,
    min_area: float = MIN_BUILDING_AREA,
    n_neighbors: Optional[int] = nearest_points(
        f"the points of the minimum building area (Ar_min d), at least {PLANE_POINTS}."
    ),
    two_classes: str = tunable("k-means", choices=("k-means", "exact")),
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find the buildings among clusters by their mean entropy, as published in 2019.

    Roofs are planar everywhere and have low entropy; crowns are not and have high entropy. Two-class K-means on the
    mean entropies of the clusters separates them; the class with the lower mean is buildings (class 6).

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes.
    cluster_id : ndarray of shape (n,), int32
        Clusters from 1; points of 0 keep their class.
    reason : ndarray of shape (n,), uint8, optional
        Reasons that the segmentation gave to points outside clusters, which they keep.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Building clusters get 6; earlier points of 6 that are not found again become 1.
    entropy : ndarray of shape (n,), float32
        Entropy of each clustered point, 0 to ln 3; NaN elsewhere.
    cluster_entropy : ndarray of shape (n,), float32
        Mean entropy of the point's cluster; NaN elsewhere.
    confidence : ndarray of shape (n,), float32
        The distance of the cluster's entropy from the upper mean over the sum of its distances from both, 0 to 1, more
        than 0.5 for buildings, 0.5 for undecided clusters (and less with fewer points, see Notes). NaN elsewhere.
    reason : ndarray of shape (n,), uint8
        Why the point's cluster is called building or not, see :class:`~..cloud.reasons.Reason`; 0 outside clusters.
    weakest_evidence : ndarray of shape (n,), uint32
        The measure nearest to its limit, see :func:`~..cloud.reasons.packed_evidence`; 0 outside clusters.
    report : Report
        Counts and the two mean entropies, and a page that shows what decided.

    Other Parameters
    ----------------
    two_classes
        How the mean entropies are separated: 'k-means' is scikit-learn's, from ten random starts; 'exact' tries every
        gap between them.

    Notes
    -----
    Equations 5 to 11 of the paper, with N = Ar_min d (the paper has N = 50 and 16 at 12.5 and 4 points per m², which
    'Thresholds' takes whatever the density of the cloud is).
    Neighbors are clustered points, and points equally far away at rank N share its weight, so that the order of the
    points decides nothing. 'exact' finds the optimum that K-means approaches: in one dimension by sorting.

    A single cluster, or clusters of one entropy, leave nothing to separate: none is called a building then, and the
    log says so. Clusters of one kind only are split in two nevertheless; 'Classify buildings' is not misled by that.

    The paper has no confidence. Above 0.5 it grows with the size of the cluster, to half at twice the points of the
    smallest building, as small objects such as cars can look like a roof by chance. This changes no decision.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy
    and the k-means concept, section 2.4. [santos2019]

    Examples
    --------
    >>> import numpy as np
    >>> rng = np.random.default_rng(1)
    >>> x, y, u = rng.uniform(0, 10, (3, 4000))
    >>> crown = np.arange(4000) >= 2000
    >>> xyz = np.column_stack([x + 20 * crown, y, np.where(crown, u, 5.0)])
    >>> found, *_ = classify_buildings_2019(xyz, np.ones(4000), 1 + crown)
    >>> bool((found[~crown] == 6).all()), bool((found[crown] == 6).any())
    (True, False)
    """
    if density is None:
        density = PAPER_THRESHOLDS[thresholds].density if thresholds in PAPER_THRESHOLDS else sampling.density
    if n_neighbors is None:
        n_neighbors = max(PLANE_POINTS, round(min_area * density))
    monitor.resolved(density=density, n_neighbors=n_neighbors)
    if not (cluster_id > 0).any():
        return no_clusters(classification, reason, monitor)
    entropies = cluster_entropies(xyz, cluster_id, Nearest(n_neighbors), monitor.part(0, 0.95))
    separated = k_means if two_classes == "k-means" else two_means
    split = split_of_whole(sampling, lambda: separated(entropies.means, monitor))
    monitor.resolved(building_entropy=split.building, other_entropy=split.other)
    decided = decide_by_entropy(entropies.means, split)
    report = build_report(Clusters(entropies.means, decided.reasons, split))
    smallest = min_area * density
    weakest = weakest_evidence(entropies, smallest, split)
    return written_to_points(classification, reason, entropies, decided, weakest, smallest, report)


def two_means(means: np.ndarray, monitor: Monitor) -> Split:
    """Separate the clusters' mean entropies (m,) in two so that the sum of squares within both classes is least.

    This is what two-class K-means approaches by rounds. In one dimension each class is an interval, so that trying
    every gap between the sorted values finds the optimum.
    """
    known = np.sort(means[np.isfinite(means)])
    alike = _alike(known, monitor)
    if alike is not None:
        return alike
    n_low = np.flatnonzero(np.diff(known) > 0) + 1
    low = np.cumsum(known)[n_low - 1] / n_low
    high = (known.sum() - n_low * low) / (len(known) - n_low)
    # The sum of squares between the classes is greatest where that within them is least.
    best = np.argmax(n_low * (len(known) - n_low) * (high - low) ** 2)
    return Split(float(low[best]), float(high[best]))


def k_means(means: np.ndarray, monitor: Monitor) -> Split:
    """Separate the clusters' mean entropies (m,) by scikit-learn's K-means with two classes, from ten random starts."""
    known = np.sort(means[np.isfinite(means)])
    alike = _alike(known, monitor)
    if alike is not None:
        return alike
    found = cluster.KMeans(n_clusters=2, n_init=10, random_state=0).fit(known[:, None])
    building, other = np.sort(found.cluster_centers_.ravel())
    return Split(float(building), float(other))


def _alike(known: np.ndarray, monitor: Monitor) -> Optional[Split]:
    """Return the split of ascending mean entropies that can't be separated, and say so; None if they can."""
    # Means closer than this are equal; real clusters differ by 0.01 and more.
    if len(known) >= 2 and np.ptp(known) >= 1e-3:
        return None
    only = "are only clusters of the same entropy"
    if len(known) < 2:
        only = "is only one cluster" if len(known) else "is no cluster with an entropy"
    monitor.warn(f"There {only}: nothing to separate, so nothing was called a building.")
    same = float(known.mean()) if len(known) else np.nan
    return Split(same, same)
