"""Isolated points, from the distances to their nearest neighbors."""

from __future__ import annotations

from typing import Annotated, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..geometry.grid import plan_box
from ..packages import spatial
from ..params import IsolatedPoints
from ..sampling.cloud_sampling import CloudSampling
from ..stage import Monitor, Param, stage
from ..threads import n_threads
from .isolated_points import add_isolated, link_length

# Points asked for at once, so that progress is told and the neighbors of only so many are held.
_CHUNK = 100_000


@stage(
    "Classify noise by distance",
    group="Preparation",
    tags="noise,outliers,statistical outlier removal,SOR,isolated points,clean",
    writes=("classification",),
)
def classify_noise_statistical(
    xyz,
    classification,
    *,
    n_neighbors: Annotated[
        int,
        Param(
            "Neighbors", "Nearest points whose mean distance is taken, the point itself not counted.", low=1, high=200
        ),
    ] = 8,
    deviations: Annotated[
        float,
        Param(
            "Standard deviations",
            "How far a point's mean distance may lie over that of the whole cloud. Smaller values remove more, "
            "and sparse parts of the scene with it.",
            low=0,
            high=100,
        ),
    ] = 6.0,
    isolated: IsolatedPoints = True,
    sampling: Optional[CloudSampling] = None,
    monitor=None,
):
    """Find points far from their nearest neighbors, and groups of points apart from all others.

    The distances to neighbors find points that are alone. Then come isolated points, alone or many together, by their
    distance to the scene: loose things in the open air, and few points under the ground. Low noise (class 7) lies under
    its neighbors, high noise (class 18) over them.

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

    Notes
    -----
    A point is noise when the mean distance to its k nearest neighbors exceeds mean + m * standard deviation of all
    these means. Distances have a long tail wherever there are trees and walls: with m = 2 or 3, often seen elsewhere,
    every hundredth point or more of a good airborne cloud is lost, with the default less than two in a thousand on
    most. Points very far away raise the standard deviation and hide less distant ones, and points of a flock or a plume
    have near neighbors.

    With isolated points, both are mended. A point must then be farther than 4.8 m (7 point spacings on sparse clouds)
    from its nearest one, too, so that facades and crowns keep their sparse parts. And noise is what no chain of points
    half as far apart ties to the scene, and what lies under the ground: the height histogram's stage finds these in the
    same way, and its notes say what stays.

    References
    ----------
    Rusu et al. (2008), Towards 3D point cloud based object maps for household environments.
    """
    sampling = sampling or CloudSampling.of(xyz, classification)
    made = classification.astype(np.uint8)
    used = np.flatnonzero(~np.isin(made, NOISE))
    points = xyz[used]
    if len(points) <= n_neighbors:
        monitor.warn(f"No noise was looked for: {len(points)} points are not enough for {n_neighbors} neighbors.")
        return made
    nearest, distance, rise = _neighbor_distances(points, n_neighbors, monitor.part(0.0, 0.5))
    limit = float(distance.mean() + deviations * distance.std())
    monitor.resolved(max_mean_distance=limit)
    is_noise = distance > limit
    isolated = isolated and bool(np.ptp(plan_box(points), axis=0).any())
    spacing = sampling.spacing if isolated else 0.0
    if isolated:
        is_noise &= nearest > 2 * link_length(spacing)
    is_low, is_high = is_noise & (rise < 0), is_noise & (rise >= 0)
    if isolated:
        add_isolated(points, is_low, is_high, spacing, monitor.part(0.5, 1.0))
    made[used[is_low]] = PointClass.LOW_NOISE
    made[used[is_high]] = PointClass.HIGH_NOISE
    monitor.resolved(low_noise=int(is_low.sum()), high_noise=int(is_high.sum()))
    return made


def _neighbor_distances(
    points: np.ndarray, n_neighbors: int, monitor: Monitor
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return least and mean distance to the neighbors, and the height over their median (n,), all in m."""
    tree = spatial.cKDTree(points)
    nearest, distance, rise = (np.empty(len(points), dtype) for dtype in (np.float32, np.float64, np.float32))
    for start in range(0, len(points), _CHUNK):
        # In the order of the tree's leaves the neighbors of a chunk lie together.
        rows = tree.indices[start : start + _CHUNK]
        # The nearest point is the point itself.
        found, neighbors = tree.query(points[rows], n_neighbors + 1, workers=n_threads())
        nearest[rows] = found[:, 1]
        distance[rows] = found[:, 1:].mean(axis=1)
        rise[rows] = points[rows, 2] - np.median(points[neighbors[:, 1:], 2], axis=1)
        monitor.progress(min(1.0, (start + _CHUNK) / len(points)))
    return nearest, distance, rise
