"""Local planes of points: of all their neighbors, or robust to those across an edge."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..criteria import MAJORITY
from ..neighborhoods.covariance import smallest_eigenvectors, symmetric_eigenvalues
from ..neighborhoods.nearest_blocks import PAIRS
from ..packages import spatial
from ..stage import Monitor
from ..threads import NEIGHBORS_AT_ONCE, in_chunks

# Fewest points of a plane with a deviation.
LEAST_POINTS = 5

# Fits of a plane that was voted for or robust, each to the points near the one before.
REFITS = 3

# Directions of the local Hough transform, even on the half sphere: 13° apart, so that a plane between two of them
# leaves most of its points within the bins of one.
_DIRECTIONS = 128

# Points of a leaf of the tree, at most: searched in as much time as the usual 16, in a third less memory.
_LEAF = 24


@dataclass(frozen=True)
class Criteria:
    """Criteria by which a point belongs to the surface next to it."""

    tolerance: Optional[float]  #: Largest distance to the plane of the surface, m; None leaves the criterion out
    cosine: Optional[float]  #: Least cosine of the angle between the normals; None leaves the criterion out

    def hold(self, away: np.ndarray, normal: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Return whether surfaces hold points.

        Parameters
        ----------
        away : ndarray of shape (m, 3)
            Points, from a point on the plane of each surface (m).
        normal, other : ndarray of shape (m, 3)
            Normals of the surfaces, and of the points.
        """
        held = np.ones(len(away), bool)
        if self.tolerance is not None:
            held &= np.abs(np.einsum("ij,ij->i", away, normal)) <= self.tolerance
        if self.cosine is not None:
            held &= np.abs(np.einsum("ij,ij->i", normal, other)) >= self.cosine
        return held


@dataclass
class LocalPlanes:
    """The plane of each point and its neighbors."""

    xyz: np.ndarray  #: (n, 3), float64: the points, m
    offset: np.ndarray  #: (n, 3), float32: center of the plane from its point, m
    normal: np.ndarray  #: (n, 3), float32: unit normals, upward; 0 where there is no plane
    #: (n,), float32: root mean square distance of its points, m, with the divisor count - 3 of a fit of three
    #: parameters; inf without a plane
    deviation: np.ndarray
    #: (n, k), int32: points near each point, nearest first; the point itself where there are fewer
    neighbors: np.ndarray

    def hold(self, criteria: Criteria, plane: np.ndarray, point: np.ndarray) -> np.ndarray:
        """Return whether the planes of some points (m,) hold others (m,)."""
        away = (self.xyz[point] - self.xyz[plane]).astype(np.float32) - self.offset[plane]
        return criteria.hold(away, self.normal[plane], self.normal[point])

    def agree(self, criteria: Criteria, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Return whether the planes of points (m,) and of others (m,) hold one another's points and centers.

        At an edge, the planes of both sides hold points of the other side, but not their center.
        """
        apart = (self.xyz[other] - self.xyz[one]).astype(np.float32)
        agreed = np.ones(len(one), bool)
        for a, b, step in ((one, other, apart), (other, one, -apart)):
            away = step - self.offset[a]
            for offset in (0, self.offset[b]):
                agreed &= criteria.hold(away + offset, self.normal[a], self.normal[b])
        return agreed


def local_planes(
    xyz: np.ndarray, count: int, radius: float, method: str, tolerance: float, monitor: Monitor
) -> LocalPlanes:
    """Fit a plane to the neighborhood of each point.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    count : int
        Points of a neighborhood at most, the point itself among them.
    radius : float
        Reach of a neighborhood, m.
    method : {"least squares", "robust", "hough"}
        How planes are fitted.
    tolerance : float
        Distance within which a point lies on a robust plane, m.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    LocalPlanes
        Planes, by point.
    """
    # Balanced: of points at the same distance it hardly depends on their order which are found.
    n, tree = len(xyz), spatial.cKDTree(xyz, _LEAF)
    # Points at exactly the radius are near, however coordinates are rounded.
    count, reach = min(count, n), radius * (1 + 1e-7)
    offset, normal = np.zeros((2, n, 3), np.float32)
    planes = LocalPlanes(xyz, offset, normal, np.full(n, np.inf, np.float32), np.empty((n, count - 1), np.int32))
    inliers = {"least squares": _every, "robust": _without_outliers, "hough": _voted}[method]

    def work(rows: np.ndarray) -> None:
        own = xyz[rows]
        neighbors = tree.query(own, k=count, distance_upper_bound=reach)[1].reshape(len(rows), count)
        near = neighbors < n
        neighbors = np.where(near, neighbors, rows[:, None])
        planes.neighbors[rows] = neighbors[:, 1:]
        offsets = (xyz[neighbors] - own[:, None]).astype(np.float32)
        chosen = inliers(offsets, near, tolerance)
        # With less, the other side of an edge could be the plane.
        enough = chosen.sum(axis=1) >= np.maximum(LEAST_POINTS, MAJORITY * near.sum(axis=1))
        store_planes(planes, rows[enough], *fit_planes(offsets[enough], chosen[enough]))

    # In the order of the tree's leaves the neighbors of one chunk lie together in memory.
    # The Hough transform takes ten times as much memory for each neighbor.
    chunk = (NEIGHBORS_AT_ONCE // 10 if method == "hough" else NEIGHBORS_AT_ONCE) // max(count, 1)
    in_chunks(work, tree.indices, max(chunk, 1), monitor)
    return planes


def store_planes(planes: LocalPlanes, rows: np.ndarray, center, normal, deviation) -> None:
    """Set the planes of some points, where they are defined.

    Parameters
    ----------
    planes : LocalPlanes
        Planes of all points; changed.
    rows : ndarray of shape (k,)
        The points.
    center, normal : ndarray of shape (k, 3)
        Centers, m, and unit normals of their planes.
    deviation : ndarray of shape (k,)
        Root mean square distances from these, m.
    """
    defined = np.isfinite(normal).all(axis=1)
    rows = rows[defined]
    planes.offset[rows], planes.normal[rows] = center[defined], normal[defined]
    planes.deviation[rows] = deviation[defined]


def fit_planes(offsets: np.ndarray, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return center (m, 3), normal (m, 3) and deviation (m,) of the ``chosen`` (m, k) points of neighborhoods."""
    weight = chosen.astype(np.float32)
    count = np.maximum(weight.sum(axis=1), 1).astype(float)
    center = np.einsum("ijk,ij->ik", offsets, weight) / count[:, None]
    away = (offsets - center[:, None].astype(np.float32)) * weight[..., None]
    products = np.column_stack([np.einsum("ij,ij->i", away[..., a], away[..., b]) for a, b in PAIRS]) / count[:, None]
    eigenvalues = symmetric_eigenvalues(products)
    free = np.maximum(count - 3, 1)
    return center, smallest_eigenvectors(products, eigenvalues), np.sqrt(eigenvalues[:, 2] * count / free)


def _every(offsets: np.ndarray, near: np.ndarray, tolerance: float) -> np.ndarray:
    """Return all neighbors (m, k)."""
    return near


def _without_outliers(offsets: np.ndarray, near: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the mask of points on a least-squares plane, fitted repeatedly without the outliers of the last fit."""
    chosen = near
    # Leave out few at first, while the plane still follows the outliers.
    for share in (0.8, 0.65, MAJORITY, MAJORITY):
        distance = _distances(offsets, *fit_planes(offsets, chosen)[:2])
        distance[~near] = np.inf
        rank = np.ceil(share * near.sum(axis=1)).astype(int) - 1
        nearest = np.take_along_axis(np.sort(distance, axis=1), rank[:, None], axis=1)
        chosen = near & (distance <= np.maximum(nearest, tolerance))
    return near & (_distances(offsets, *fit_planes(offsets, chosen)[:2]) <= tolerance)


def _voted(offsets: np.ndarray, near: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the mask of points that lie on the plane through the point that most neighbors vote for."""
    size = offsets.shape
    distance = np.abs(offsets.reshape(-1, 3) @ _half_sphere().T).reshape(size[0], size[1], -1)
    # Points in the middle of a bin count more: of several planes with all points the best one is taken.
    vote = np.divide(distance, -2 * tolerance, out=distance)
    vote += 1
    np.maximum(vote, 0, out=vote)
    vote *= near[..., None]
    best = vote.sum(axis=1).argmax(axis=1)
    chosen = near & (np.take_along_axis(vote, best[:, None, None], axis=2)[..., 0] > 0)
    for _ in range(REFITS):
        center, normal, _ = fit_planes(offsets, chosen)
        chosen = near & (_distances(offsets, center, normal) <= tolerance)
    return chosen


def _half_sphere() -> np.ndarray:
    """Return directions (d, 3), float32, even on the upper half sphere (Fibonacci's spiral)."""
    number = np.arange(_DIRECTIONS) + 0.5
    up = 1 - number / _DIRECTIONS
    angle = np.pi * (1 + np.sqrt(5)) * number
    out = np.sqrt(1 - up**2)
    return np.column_stack([out * np.cos(angle), out * np.sin(angle), up]).astype(np.float32)


def _distances(offsets: np.ndarray, center: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the distances (m, k), m, of neighbors from planes; undefined planes have normal and level 0."""
    level = np.einsum("ij,ij->i", center, normal)
    return np.abs(np.einsum("ijk,ik->ij", offsets, np.nan_to_num(normal)) - np.nan_to_num(level)[:, None])
