"""Eigenvalues of neighborhoods: the core that every covariance feature shares.

Neighborhoods are gathered in chunks, so that the workspace stays small however many points there are. The chunks are
shared out among threads: the k-d tree and numpy both release the interpreter while they work. The result does not
depend on the number of threads, and on the chunks only by rounding.
"""

from dataclasses import dataclass
from typing import Any, Callable, Optional, Protocol

import numpy as np

from ..geometry.tin import PLANE_POINTS
from ..packages import spatial
from ..stage import Monitor
from ..threads import NEIGHBORS_AT_ONCE, ROWS_AT_ONCE, in_chunks
from .nearest_blocks import PAIRS, Shapes, nearest_shapes, shapes_within

# A neighborhood larger than this on average is a radius chosen by mistake: it would run for days.
_MAX_MEAN_NEIGHBORS = 20_000

# Within this distance of a degenerate case closed forms lose half of their digits; LAPACK is used instead.
_DOUBTFUL = 1e-6


class Neighborhood(Protocol):
    """The points that describe a point: :class:`Nearest`, :class:`Within`, the best number, or as many as are wide."""

    def check(self, xyz: np.ndarray, tree: Any) -> None:
        """Raise ValueError when the neighborhood does not suit the cloud."""

    def rows_per_chunk(self, n_points: int) -> int:
        """Return the number of points that are worked on at once."""

    def shapes(self, columns: np.ndarray, tree: Any, rows: np.ndarray, extents: bool) -> Shapes:
        """Return the shapes of the neighborhoods of the points ``rows``, with extents if wanted."""


@dataclass(frozen=True)
class Nearest:
    """The ``count`` points nearest to a point, itself among them; all points where there are fewer."""

    count: int

    @property
    def n_named(self) -> int:
        """How many neighbors :meth:`moments` names of a cloud with enough points: all."""
        return self.count

    def check(self, xyz: np.ndarray, tree: Any) -> None:
        """Take every cloud."""

    def rows_per_chunk(self, n_points: int) -> int:
        """Return the number of points that are worked on at once."""
        return max(1, NEIGHBORS_AT_ONCE // min(self.count, n_points))

    def shapes(self, columns: np.ndarray, tree: Any, rows: np.ndarray, extents: bool) -> Shapes:
        """Return the shapes of the neighborhoods of the points ``rows``."""
        return nearest_shapes(columns, tree, rows, min(self.count, columns.shape[1]), extents)

    def moments(self, tree: Any, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return neighbors (m, k), their centers (m, 3) and covariances (m, 6) of the points ``rows`` of a tree."""
        neighbors, offsets = nearest_offsets(tree, rows, self.count)
        means, products = _moments(offsets)
        return neighbors, tree.data[rows] + np.column_stack(means), np.column_stack(products)


def nearest_offsets(tree: Any, rows: np.ndarray, count: int) -> tuple[np.ndarray, list]:
    """Return the neighbors (m, k) of the points ``rows``, nearest first, and their offsets in x, y, z.

    Parameters
    ----------
    tree : cKDTree
        Tree of the points (n, 3), m.
    rows : ndarray of shape (m,), int64
        Points that are asked for.
    count : int
        Number of neighbors k.
    """
    own, count, coordinates = tree.data[rows], min(count, tree.n), tree.data.ravel()
    neighbors = tree.query(own, k=count)[1].reshape(len(rows), count)
    first = 3 * neighbors
    # Offsets to the point itself are exact however large the coordinates are.
    return neighbors, [np.take(coordinates[axis:], first) - own[:, axis, None] for axis in range(3)]


def _moments(offsets: list) -> tuple[list, list]:
    """Return means and covariances of offsets (m, k) in x, y and z."""
    means = [offset.mean(axis=1) for offset in offsets]
    count = offsets[0].shape[1]
    return means, [np.einsum("ij,ij->i", offsets[a], offsets[b]) / count - means[a] * means[b] for a, b in PAIRS]


@dataclass(frozen=True)
class Within:
    """All points at most ``radius`` (m) from a point, itself among them."""

    radius: float

    def check(self, xyz: np.ndarray, tree: Any) -> None:
        """Raise ValueError when the radius holds far more points than are local."""
        mean = tree.query_ball_point(xyz[:: max(1, len(xyz) // 100)], self.radius, return_length=True).mean()
        if mean > _MAX_MEAN_NEIGHBORS:
            raise ValueError(
                f"A radius of {self.radius:g} m holds {mean:,.0f} points on average, more than "
                f"{_MAX_MEAN_NEIGHBORS:,}; choose a smaller radius or thin the cloud first."
            )

    def rows_per_chunk(self, n_points: int) -> int:
        """Return the number of points that are worked on at once."""
        return ROWS_AT_ONCE

    def shapes(self, columns: np.ndarray, tree: Any, rows: np.ndarray, extents: bool) -> Shapes:
        """Return the shapes of the neighborhoods of the points ``rows``."""
        return shapes_within(columns, tree, rows, self.radius, extents)


def reduce_neighborhoods(
    xyz: np.ndarray,
    neighborhood: Neighborhood,
    reduce: Callable[[np.ndarray, Shapes], None],
    tree: Any = None,
    monitor: Optional[Monitor] = None,
    extents: bool = False,
    chosen: Optional[np.ndarray] = None,
) -> None:
    """Call ``reduce(rows, shapes)`` for all points, or the chosen ones, chunk by chunk, in threads.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    neighborhood : Neighborhood
        Which points belong to a point.
    reduce : callable
        Stores what it makes of the points ``rows`` (m,) and the :class:`Shapes` of their neighborhoods. Chunks
        never share a row.
    tree : scipy.spatial.cKDTree, optional
        Tree of ``xyz``, built when absent.
    monitor : Monitor, optional
        Receives progress.
    extents : bool
        Whether height range and plan radius are wanted too.
    chosen : ndarray of shape (n,), bool, optional
        The points whose neighborhoods are wanted.

    Raises
    ------
    ValueError
        If a radius holds more than 20,000 points on average.
    """
    monitor = monitor or Monitor()
    xyz = np.asarray(xyz, dtype=np.float64)
    # Cells cut at their middle are built in half the time of balanced ones, and are a little rounder to search in.
    tree = spatial.cKDTree(xyz, balanced_tree=False) if tree is None else tree
    neighborhood.check(xyz, tree)
    columns = np.ascontiguousarray(xyz.T)

    def work(rows: np.ndarray) -> None:
        reduce(rows, neighborhood.shapes(columns, tree, rows, extents))

    # In the order of the tree's leaves the neighbors of one chunk lie together in memory.
    rows = tree.indices if chosen is None else tree.indices[chosen[tree.indices]]
    in_chunks(work, rows, neighborhood.rows_per_chunk(len(xyz)), monitor)


def neighborhood_eigenvalues(
    xyz: np.ndarray,
    neighborhood: Neighborhood,
    tree: Any = None,
    monitor: Optional[Monitor] = None,
    chosen: Optional[np.ndarray] = None,
) -> np.ndarray:
    """Return the eigenvalues of the covariance of each point with its neighbors.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m), of any magnitude.
    neighborhood : Neighborhood
        Which points belong to a point, itself among them.
    tree : scipy.spatial.cKDTree, optional
        Tree of ``xyz``, built when absent.
    monitor : Monitor, optional
        Receives progress.
    chosen : ndarray of shape (n,), bool, optional
        The points whose neighborhoods are wanted; the eigenvalues of all others are NaN.

    Returns
    -------
    ndarray of shape (n, 3), float64
        l1 >= l2 >= l3 >= 0 (m²); NaN where there are fewer than three neighbors or all coincide.
    """
    eigenvalues = np.empty((len(xyz), 3)) if chosen is None else np.full((len(xyz), 3), np.nan)

    def keep(rows: np.ndarray, shapes: Shapes) -> None:
        eigenvalues[rows] = defined_eigenvalues(shapes.covariances, shapes.counts)

    reduce_neighborhoods(xyz, neighborhood, keep, tree, monitor, chosen=chosen)
    return eigenvalues


def defined_eigenvalues(covariances: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Return the eigenvalues (m, 3) of covariances (m, 6), NaN where a neighborhood has no extent or under 3 points."""
    eigenvalues = symmetric_eigenvalues(covariances)
    eigenvalues[(counts < PLANE_POINTS) | (eigenvalues[:, 0] <= 0)] = np.nan
    return eigenvalues


def symmetric_eigenvalues(covariances: np.ndarray) -> np.ndarray:
    """Return the eigenvalues of positive semidefinite 3 x 3 matrices, in closed form.

    Parameters
    ----------
    covariances : ndarray of shape (m, 6)
        xx, yy, zz, xy, xz, yz of each matrix.

    Returns
    -------
    ndarray of shape (m, 3), float64
        l1 >= l2 >= l3 >= 0, right to about 1e-13 of l1.

    Notes
    -----
    The trigonometric solution of the characteristic polynomial. Where two eigenvalues are nearly equal the angle
    loses half its digits, so those matrices go to LAPACK.
    """
    xx, yy, zz, xy, xz, yz = np.asarray(covariances, dtype=np.float64).T
    mean = (xx + yy + zz) / 3
    ax, ay, az = xx - mean, yy - mean, zz - mean
    spread = np.sqrt((ax * ax + ay * ay + az * az + 2 * (xy * xy + xz * xz + yz * yz)) / 6)
    determinant = ax * (ay * az - yz * yz) - xy * (xy * az - yz * xz) + xz * (xy * yz - ay * xz)
    cubed = spread**3
    cosine = np.divide(determinant, 2 * cubed, out=np.ones_like(mean), where=cubed > 0)
    angle = np.arccos(np.clip(cosine, -1, 1)) / 3
    largest = mean + 2 * spread * np.cos(angle)
    smallest = mean + 2 * spread * np.cos(angle + 2 * np.pi / 3)
    eigenvalues = np.column_stack([largest, 3 * mean - largest - smallest, smallest])
    doubtful = np.flatnonzero(np.abs(cosine) > 1 - _DOUBTFUL)
    if len(doubtful):
        eigenvalues[doubtful] = np.linalg.eigvalsh(full_matrices(covariances[doubtful]))[:, ::-1]
    # Rounding may leave a flat neighborhood a tiny negative extent.
    return np.maximum(eigenvalues, 0, out=eigenvalues)


def smallest_eigenvectors(covariances: np.ndarray, eigenvalues: np.ndarray) -> np.ndarray:
    """Return the unit eigenvectors (m, 3), n_z >= 0, of the smallest eigenvalues.

    Covariances (m, 6) are xx, yy, zz, xy, xz, yz; eigenvalues (m, 3) are largest first, and NaN gives NaN. On a line,
    where every direction across it would do, it is one of them.
    """
    # In units of l1, so that neither small nor large neighborhoods leave the range of floats.
    largest = np.where(eigenvalues[:, 0] > 0, eigenvalues[:, 0], np.nan)
    xx, yy, zz, xy, xz, yz = np.asarray(covariances, dtype=np.float64).T / largest
    smallest = eigenvalues[:, 2] / largest
    xx, yy, zz = xx - smallest, yy - smallest, zz - smallest
    # All rows of the shifted matrix lie across the eigenvector: two of them give it, the most independent two best.
    crosses = np.empty((3, 3, len(xx)))
    crosses[0] = xy * yz - xz * yy, xz * xy - xx * yz, xx * yy - xy * xy
    crosses[1] = xy * zz - xz * yz, xz * xz - xx * zz, xx * yz - xy * xz
    crosses[2] = yy * zz - yz * yz, yz * xz - xy * zz, xy * yz - yy * xz
    sizes = np.einsum("ijk,ijk->ik", crosses, crosses)
    best = np.argmax(sizes, axis=0)
    every = np.arange(len(best))
    normals, size = crosses[best, :, every], np.sqrt(sizes[best, every])
    doubtful = np.flatnonzero(size < _DOUBTFUL)
    if len(doubtful):
        normals[doubtful] = np.linalg.eigh(full_matrices(covariances[doubtful] / largest[doubtful, None]))[1][:, :, 0]
        size[doubtful] = 1.0
    normals /= size[:, None]
    normals[normals[:, 2] < 0] *= -1
    return normals


def full_matrices(covariances: np.ndarray) -> np.ndarray:
    """Return (m, 3, 3) symmetric matrices from their six numbers (m, 6)."""
    return np.asarray(covariances)[:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(-1, 3, 3)


def dimensionality(eigenvalues: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return linearity, planarity and scattering (n,) of eigenvalues (n, 3); they add up to 1."""
    first, second, third = np.asarray(eigenvalues).T
    return (first - second) / first, (second - third) / first, third / first


def shannon_entropy(*shares: np.ndarray) -> np.ndarray:
    """Return -sum s ln s of shares that add up to 1, with 0 ln 0 = 0; NaN stays NaN."""
    total = np.zeros(len(shares[0]))
    for share in shares:
        total -= share * np.log(share, out=np.zeros(len(share)), where=~(share <= 0))
    # Adding and subtracting zeros may leave -0.
    return total + 0.0


def shannon_entropy_lps(eigenvalues: np.ndarray) -> np.ndarray:
    """Return the Shannon entropy of linearity, planarity and scattering.

    Parameters
    ----------
    eigenvalues : ndarray of shape (n, 3)
        l1 >= l2 >= l3 >= 0.

    Returns
    -------
    ndarray of shape (n,), float64
        E = -L ln L - P ln P - S ln S, from 0 (purely one of them) to ln 3; NaN where the eigenvalues are.

    References
    ----------
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept, equations 6-9.
    [santos2019]
    """
    return shannon_entropy(*dimensionality(eigenvalues))
