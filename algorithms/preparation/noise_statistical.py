"""Isolated points, from the distances to their nearest neighbors."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..packages import spatial
from ..stage import Monitor, Param, stage

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
    monitor=None,
):
    """Find isolated points: those whose nearest neighbors are much farther away than is usual in the cloud.

    Suits clouds of even density, such as photogrammetric and terrestrial ones. It takes sparse parts of the scene for
    noise sooner than the height histogram does. Low noise (class 7) lies under its neighbors, high noise (class 18)
    over them.

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
    most.
    Points very far away raise the standard deviation and hide less distant ones; run the height histogram first.

    References
    ----------
    Rusu et al. (2008), Towards 3D point cloud based object maps for household environments.
    """
    made = classification.astype(np.uint8)
    used = np.flatnonzero(~np.isin(made, NOISE))
    points = xyz[used]
    if len(points) <= n_neighbors:
        monitor.warn(f"No noise was looked for: {len(points)} points are not enough for {n_neighbors} neighbors.")
        return made
    distance, rise = _neighbor_distances(points, n_neighbors, monitor)
    limit = float(distance.mean() + deviations * distance.std())
    monitor.resolved(max_mean_distance=limit)
    is_noise = distance > limit
    made[used[is_noise]] = np.where(rise[is_noise] < 0, PointClass.LOW_NOISE, PointClass.HIGH_NOISE)
    return made


def _neighbor_distances(points: np.ndarray, n_neighbors: int, monitor: Monitor) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean distance to the neighbors and the height over their median (n,), both in m."""
    tree = spatial.cKDTree(points)
    distance, rise = np.empty(len(points)), np.empty(len(points))
    for start in range(0, len(points), _CHUNK):
        # In the order of the tree's leaves the neighbors of a chunk lie together.
        rows = tree.indices[start : start + _CHUNK]
        # The nearest point is the point itself.
        found, neighbors = tree.query(points[rows], n_neighbors + 1, workers=-1)
        distance[rows] = found[:, 1:].mean(axis=1)
        rise[rows] = points[rows, 2] - np.median(points[neighbors[:, 1:], 2], axis=1)
        monitor.progress(min(1.0, (start + _CHUNK) / len(points)))
    return distance, rise
