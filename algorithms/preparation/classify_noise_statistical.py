"""Isolated points, from the distances to their nearest neighbors."""

import numpy as np

from ..geometry.grid import distinct, plan_box
from ..packages import spatial
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise, with_noise
from ..stage import Monitor, stage, tunable
from ..threads import ROWS_AT_ONCE, n_threads
from .points_in_the_air import in_the_air, link_length
from .points_under_ground import under_ground

# A sample of about this many points in dense neighborhoods gives mean and standard deviation of the distances to some
# thousandths.
_SAMPLE = 200_000

# The sample is taken from thin sheets across this wave vector (waves per meter). Its components are incommensurable
# with each other and with the steps of coordinates in files.
_SAMPLE_WAVE = 1e3 * np.sqrt([2.0, 3.0, 5.0])


@stage(
    "Preparation",
    title="Classify noise by distance",
    tags="noise,outliers,statistical outlier removal,SOR,isolated points,clean,denoise,lasnoise",
    writes=("classification",),
    cost=4.0,
)
def classify_noise_statistical(
    xyz,
    classification,
    *,
    n_neighbors: int = tunable(8, label="Neighbors", within="[1, 200]"),
    deviations: float = tunable(6.0, label="Standard deviations", within="[0, 100]"),
    isolated: bool = tunable(True, label="Isolated points"),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find points far from their nearest neighbors, and groups of points apart from all others.

    Single points are found by the distances to their neighbors. Isolated points, single or in groups, are found by
    their distance to the scene: loose objects in the open air, and a few points under the ground. Low noise (class 7)
    lies under its neighbors, high noise (class 18) over them.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points that are noise already stay so and are not counted.

    Returns
    -------
    ndarray of shape (n,), uint8
        The classes, 7 and 18 for the noise that was found, all others as they were.

    Other Parameters
    ----------------
    n_neighbors
        Nearest points whose mean distance is taken, the point itself not counted.
    deviations
        How far a point's mean distance may lie over the mean of the whole cloud. Smaller values remove more, and sparse
        parts of the scene with it.
    isolated
        Also find isolated points in the air (birds, flocks, plumes of dust) and under the ground (multipath), within
        the heights of the scene.

    Notes
    -----
    A point is noise when the mean distance to its k nearest neighbors exceeds mean + m * standard deviation of all
    these means. Distances have a long tail wherever there are trees and walls: with m = 2 or 3, often seen elsewhere,
    every hundredth point or more of a good airborne cloud is lost. With the default these are less than two in a
    thousand on most. Two kinds of noise are missed: points very far away raise the standard deviation and hide less
    distant ones, and points of a flock or a plume have near neighbors.

    With *Isolated points*, both are found. A point must then be farther than 4.8 m (7 point spacings on sparse clouds)
    from its nearest one, too, so that facades and crowns keep their sparse parts. Points that no chain of points half
    as far apart ties to the scene are noise too, and so are points under the ground. 'Classify noise in the air' and
    'Classify noise by height histogram' find these in the same way; their notes name the objects that stay. Only points
    with nothing around them can be noise by their distance then. So neighbors are looked up for those in voxels with
    few points, and of the others of large clouds for a sample of ``_SAMPLE``, which gives mean and standard deviation
    of all.

    References
    ----------
    Rusu et al. (2008), Towards 3D point cloud based object maps for household environments. [rusu2008]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> bird = np.vstack([xyz, [20, 20, 60]])
    >>> int(classify_noise_statistical(bird, np.zeros(len(bird)))[-1])
    18
    """
    xyz = sampling.from_corner(xyz)
    made = classification.astype(np.uint8)
    used = not_noise(made)
    points = xyz[used]
    if len(points) <= n_neighbors:
        monitor.warn(f"No noise was looked for: {len(points)} points are not enough for {n_neighbors} neighbors.")
        return made
    isolated = isolated and bool(np.ptp(plan_box(points), axis=0).any())
    spacing = sampling.spacing if isolated else 0.0
    # Isolated points are farther than this from their nearest one.
    apart = 2 * link_length(spacing) if isolated else 0.0
    rows, weight = _measured(points, apart, n_neighbors)
    nearest, distance, rise = _neighbor_distances(points, rows, n_neighbors, monitor.part(0.0, 0.5))
    mean = float(np.average(distance, weights=weight))
    limit = mean + deviations * float(np.sqrt(np.average((distance - mean) ** 2, weights=weight)))
    monitor.resolved(max_mean_distance=limit)
    noise = (distance > limit) & (nearest > apart)
    is_low, is_high = np.zeros((2, len(points)), bool)
    is_low[rows[noise]], is_high[rows[noise]] = rise[noise] < 0, rise[noise] >= 0
    if isolated:
        rest = np.flatnonzero(~(is_low | is_high))
        hanging = in_the_air(points[rest], spacing, monitor.part(0.5, 0.7))
        is_high[rest[hanging]] = True
        rest = rest[~hanging]
        is_low[rest[under_ground(points[rest], spacing, sampling.noise, monitor.part(0.7, 1.0))]] = True
    return with_noise(made, used[is_low], used[is_high], monitor)


def _measured(points: np.ndarray, apart: float, n_neighbors: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows (m,) of the points whose neighbors are looked up, and how many points each of them represents.

    These are all points of voxels with few points, among which are all that lie farther than ``apart`` (m) from their
    nearest one, and of the others a sample, if they are many.
    """
    share = _SAMPLE / len(points)
    if not apart or share >= 1:
        return np.arange(len(points)), np.ones(len(points))
    offsets = points - points.min(axis=0)
    step = np.floor(offsets * (np.sqrt(3.0) / apart)).astype(np.int64)
    width, depth, _ = step.max(axis=0) + 1
    which = distinct((step[:, 2] * depth + step[:, 1]) * width + step[:, 0])[1]
    is_dense = (np.bincount(which) > n_neighbors)[which]
    # Chosen by coordinates, the sample does not depend on the order of the points.
    phase = offsets @ _SAMPLE_WAVE
    is_sampled = is_dense & (phase - np.floor(phase) < share)
    if is_dense.any() and not is_sampled.any():
        # If all points lie at a few positions, none may lie in a sheet.
        is_sampled = is_dense
    rows = np.flatnonzero(is_sampled | ~is_dense)
    weight = np.where(is_dense[rows], np.count_nonzero(is_dense) / max(np.count_nonzero(is_sampled), 1), 1.0)
    return rows, weight


def _neighbor_distances(
    points: np.ndarray, rows: np.ndarray, n_neighbors: int, monitor: Monitor
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return least and mean distance to the neighbors, and height over their median (m,), of some rows, all in m."""
    tree = spatial.cKDTree(points, balanced_tree=False)
    nearest, distance, rise = np.empty((3, len(rows)))
    # In the order of the tree's leaves the neighbors of a chunk lie together.
    position = np.full(len(points), -1, np.int64)
    position[rows] = np.arange(len(rows))
    order = position[tree.indices]
    order = order[order >= 0]
    for start in range(0, len(order), ROWS_AT_ONCE):
        chunk = order[start : start + ROWS_AT_ONCE]
        own = points[rows[chunk]]
        # The nearest point is the point itself.
        found, neighbors = tree.query(own, n_neighbors + 1, workers=n_threads())
        nearest[chunk] = found[:, 1]
        distance[chunk] = found[:, 1:].mean(axis=1)
        rise[chunk] = own[:, 2] - np.median(points[neighbors[:, 1:], 2], axis=1)
        monitor.progress(min(1.0, (start + ROWS_AT_ONCE) / len(order)))
    return nearest, distance, rise
