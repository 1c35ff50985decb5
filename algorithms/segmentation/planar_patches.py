"""Planar patches: points that lie on one smooth surface with their neighbors."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Union

import numpy as np

from ..neighborhoods.covariance import Nearest, smallest_eigenvectors, symmetric_eigenvalues
from ..neighborhoods.wide_in_plan import Wide
from ..packages import csgraph, sparse, spatial
from ..sampling.surface_noise import LEAST_NEIGHBORS
from ..stage import Monitor
from ..threads import in_chunks

# Distance within which a point lies on a plane (deviations of points from planes).
_ON_PLANE = 2.3195

# A plane is smooth if its own points deviate by less (the same deviations).
_SMOOTH = 2.3195

# Two planes are one surface when each holds the other's point within this distance (the same deviations) ...
_SAME_SURFACE = 3.48

# ... and the angle between their normals is no larger (cosine).
_SAME_DIRECTION = np.cos(np.radians(15.0))

# Links are looked for among so many neighbors.
_LINKS = 8

_CHUNK = 100_000


@dataclass
class LocalPlanes:
    """The plane of each point and its neighbors: point ``center``, unit ``normal`` upward, ``deviation`` (m) across."""

    center: np.ndarray
    normal: np.ndarray
    deviation: np.ndarray
    neighbors: np.ndarray

    def distance(self, points: np.ndarray, plane: np.ndarray) -> np.ndarray:
        """Return the distance (m) of points (m, 3) to the planes numbered ``plane`` (m,)."""
        return np.abs(np.einsum("ij,ij->i", points - self.center[plane], self.normal[plane]))


def segment_patches(
    xyz: np.ndarray, neighborhood: Union[Nearest, Wide], off_plane: float, max_slope: float, monitor: Monitor
) -> tuple[np.ndarray, np.ndarray]:
    """Group points that lie on smooth surfaces.

    Each point takes the smoothest plane among those of its neighbors that hold it, so that
    points at edges and ridges belong to the surface beside them and not to a plane across
    the edge; points whose planes agree then make one patch.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    neighborhood : Nearest or Wide
        The points that show the plane of a surface.
    off_plane : float
        Standard deviation of points of a surface from the planes of their neighbors, m.
    max_slope : float
        Steepest patch, degrees; 90 is any.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    patch : ndarray of shape (n,), int32
        Patch of each point from 0, -1 where it lies on no smooth surface.
    roughness : ndarray of shape (n,), float32
        Standard deviation of points across the plane that each is held by, m; where none holds it, it means nothing.
    """
    if len(xyz) < LEAST_NEIGHBORS:
        return np.full(len(xyz), -1, np.int32), np.zeros(len(xyz), np.float32)
    tree = spatial.cKDTree(xyz)
    neighborhood = replace(neighborhood, count=min(neighborhood.count, len(xyz)))
    planes = _local_planes(xyz, tree, neighborhood, monitor.part(0, 0.6))
    del tree  # What is large goes as soon as it can: the links below are large, too.
    plane = _smoothest_plane(xyz, planes, off_plane, monitor.part(0.6, 0.8))
    on_surface = (planes.deviation[plane] <= _SMOOTH * off_plane) & (plane >= 0)
    on_surface &= planes.normal[plane, 2] >= np.sin(np.radians(90 - max_slope))
    links = _links(xyz, planes, plane, on_surface, off_plane, monitor.part(0.8, 1))
    # Three of its points make a plane and tell nothing of how far others lie off it. Wide neighborhoods hold more
    # points than this: there it is a little too much.
    across = planes.deviation * np.sqrt(neighborhood.count / (neighborhood.count - 3))
    roughness = across.astype(np.float32)[plane]
    del planes, plane, across
    component = csgraph.connected_components(links, directed=False)[1]
    return np.where(on_surface, component, -1).astype(np.int32), roughness


def _local_planes(xyz: np.ndarray, tree: Any, neighborhood: Union[Nearest, Wide], monitor: Monitor) -> LocalPlanes:
    columns = np.ascontiguousarray(xyz.T)
    planes = LocalPlanes(
        np.empty((len(xyz), 3)),
        np.empty((len(xyz), 3)),
        np.empty(len(xyz)),
        np.empty((len(xyz), neighborhood.n_named), np.int32),
    )

    def work(rows: np.ndarray) -> None:
        neighbors, centers, covariances = neighborhood.moments(columns, tree, rows)
        eigenvalues = symmetric_eigenvalues(covariances)
        planes.neighbors[rows] = neighbors
        planes.center[rows] = centers
        planes.normal[rows] = smallest_eigenvectors(covariances, eigenvalues)
        planes.deviation[rows] = np.sqrt(eigenvalues[:, 2])

    in_chunks(work, tree.indices, neighborhood.rows_per_chunk(len(xyz)), monitor)
    # Coincident neighbors have no normal and so no plane.
    undefined = ~np.isfinite(planes.normal).all(axis=1)
    planes.normal[undefined], planes.deviation[undefined] = 0.0, np.inf
    return planes


def _smoothest_plane(xyz: np.ndarray, planes: LocalPlanes, off_plane: float, monitor: Monitor) -> np.ndarray:
    """Return the number (n,) of the smoothest plane that holds each point; -1 where none does."""
    plane = np.full(len(xyz), -1, np.int32)

    def work(rows: np.ndarray) -> None:
        smoothest = np.full(len(rows), np.inf)
        for candidate in planes.neighbors[rows].T:
            better = planes.deviation[candidate] < smoothest
            better[better] = planes.distance(xyz[rows[better]], candidate[better]) <= _ON_PLANE * off_plane
            smoothest[better] = planes.deviation[candidate[better]]
            plane[rows[better]] = candidate[better]

    in_chunks(work, np.arange(len(xyz)), _CHUNK, monitor)
    return plane


def _links(
    xyz: np.ndarray, planes: LocalPlanes, plane: np.ndarray, on_surface: np.ndarray, off_plane: float, monitor: Monitor
) -> Any:
    """Return the graph, sparse (n, n), of neighbors whose planes are one surface."""
    # Spread over the ranks, so that links cross from one scan line to the next.
    ranks = np.unique(np.linspace(1, planes.neighbors.shape[1] - 1, _LINKS - 1).astype(int))
    planes.neighbors = planes.neighbors[:, ranks]
    n_links = np.zeros(len(xyz) + 1, np.int64)
    there: list[np.ndarray] = [np.empty(0, np.int32)] * -(-len(xyz) // _CHUNK)

    def work(rows: np.ndarray) -> None:
        neighbors = planes.neighbors[rows]
        is_link = on_surface[rows, None] & on_surface[neighbors]
        for column, neighbor in enumerate(neighbors.T):
            pair = is_link[:, column].nonzero()[0]
            a, b = rows[pair], neighbor[pair]
            # Normals point upward, those of walls to either side by chance.
            cosine = np.einsum("ij,ij->i", planes.normal[plane[a]], planes.normal[plane[b]])
            same = np.abs(cosine) >= _SAME_DIRECTION
            same &= planes.distance(xyz[b], plane[a]) <= _SAME_SURFACE * off_plane
            same &= planes.distance(xyz[a], plane[b]) <= _SAME_SURFACE * off_plane
            is_link[pair, column] = same
        n_links[rows + 1] = is_link.sum(axis=1)
        there[rows[0] // _CHUNK] = neighbors[is_link]

    in_chunks(work, np.arange(len(xyz)), _CHUNK, monitor)
    columns = np.concatenate(there)
    there.clear()
    # The weights are of the type that the search for components would turn them to.
    return sparse.csr_matrix((np.ones(len(columns)), columns, np.cumsum(n_links)), (len(xyz), len(xyz)))
