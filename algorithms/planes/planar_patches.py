"""Planar patches: points that lie on one smooth surface with their neighbors."""

from dataclasses import dataclass, replace
from typing import Union

import numpy as np

from ..geometry.boxes import by_first_point
from ..geometry.groups import placed
from ..neighborhoods.covariance import Nearest, smallest_eigenvectors, symmetric_eigenvalues
from ..neighborhoods.wide_in_plan import Wide
from ..packages import csgraph, sparse, spatial
from ..rules import rule, rules
from ..sampling.surface_noise import LEAST_NEIGHBORS, ON_PLANE
from ..stage import Monitor
from ..threads import ROWS_AT_ONCE, in_chunks


@rules
class PATCHES:
    """When neighbors share a smooth surface; deviations are distances of points from planes."""

    same_surface: float = rule(
        3.5, "deviations", "statistics: points and planes of a surface, each with their own error"
    )
    same_direction: float = rule(15.0, "°", "between normals of one surface, whose errors are a few degrees")


@dataclass
class _PointPlanes:
    """The planes of points and their neighbors."""

    #: (n, 4), float32, exact to a millimeter within 10 km: unit normal upward, and how far along it the plane lies from
    #: the first of the points (m). The distance of (x, y, z, -1) from the plane is one sum of products
    planes: np.ndarray
    deviation: np.ndarray  #: (n,), float32: standard deviation across the plane, m
    neighbors: np.ndarray  #: (n, k), int32: points that showed the plane


def segment_patches(
    xyz: np.ndarray,
    used: np.ndarray,
    neighborhood: Union[Nearest, Wide],
    off_plane: float,
    max_slope: float,
    monitor: Monitor,
    corner: Union[np.ndarray, float] = 0.0,
) -> np.ndarray:
    """Group the points that lie on smooth surfaces.

    Each point takes the smoothest plane among its neighbors' planes that hold it, so that points at edges and ridges
    belong to the nearest surface and not to a plane across the edge. Points whose planes agree then make one patch.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    used : ndarray of shape (u,), int64
        Rows of the points that are grouped.
    neighborhood : Nearest or Wide
        The points that show the plane of a surface.
    off_plane : float
        Standard deviation of points of a surface from the planes of their neighbors, m.
    max_slope : float
        Steepest patch, degrees; 90 is any.
    monitor : Monitor
        Receives progress.
    corner : ndarray of shape (2,) or 0
        Easting and northing (m) from which points are measured.

    Returns
    -------
    patch : ndarray of shape (u,), int32
        Patch of each of them from 0, -1 where it lies on no smooth surface.
    """
    if len(used) < LEAST_NEIGHBORS:
        return np.full(len(used), -1, np.int32)
    # Only the used points are copied: all points of the cloud would take as much memory again.
    xyz = xyz.take(used, axis=0)
    xyz[:, :2] -= corner
    # Points that are near each other follow each other, so that values of neighbors are in the processor's caches.
    order = spatial.cKDTree(xyz, balanced_tree=False).indices.astype(np.int32)
    neighborhood = replace(neighborhood, count=min(neighborhood.count, len(used)))
    xyz = xyz.take(order, axis=0)
    planes = _local_planes(xyz, neighborhood, monitor.part(0, 0.6))
    points = np.full((len(xyz), 4), -1.0)
    np.subtract(xyz, xyz[0], out=points[:, :3])
    del xyz
    plane = _smoothest_plane(points, planes, ON_PLANE * off_plane, monitor.part(0.6, 0.8))
    # The other neighbors are freed before links are found, which take memory of their own.
    _keep_linked(planes.neighbors)
    on_surface = (planes.deviation[plane] <= ON_PLANE * off_plane) & (plane >= 0)
    on_surface &= planes.planes[plane, 2] >= np.sin(np.radians(90 - max_slope))
    links = _links(points, planes, plane, on_surface, PATCHES.same_surface * off_plane, monitor.part(0.8, 1))
    # The search for components needs the memory that these take.
    del points, planes, plane
    component = np.empty(len(order), np.int32)
    component[order] = np.where(on_surface, _components(*links), -1)
    return placed(by_first_point(component[component >= 0]), component >= 0, len(order), -1)


def _local_planes(xyz: np.ndarray, neighborhood: Union[Nearest, Wide], monitor: Monitor) -> _PointPlanes:
    """Return the planes of the neighborhoods of all points (n, 3), m."""
    tree = spatial.cKDTree(xyz, balanced_tree=False)
    planes, deviation = np.empty((len(xyz), 4), np.float32), np.empty(len(xyz), np.float32)
    made = _PointPlanes(planes, deviation, np.empty((len(xyz), neighborhood.n_named), np.int32))

    def work(rows: np.ndarray) -> None:
        neighbors, centers, covariances = neighborhood.moments(tree, rows)
        eigenvalues = symmetric_eigenvalues(covariances)
        normals = smallest_eigenvectors(covariances, eigenvalues)
        made.neighbors[rows] = neighbors
        made.planes[rows, :3] = normals
        made.planes[rows, 3] = np.einsum("ij,ij->i", normals, centers - xyz[0])
        made.deviation[rows] = np.sqrt(eigenvalues[:, 2])

    in_chunks(work, np.arange(len(xyz)), neighborhood.rows_per_chunk(len(xyz)), monitor)
    # Coincident neighbors have no normal and so no plane.
    undefined = ~np.isfinite(made.planes).all(axis=1)
    made.planes[undefined], made.deviation[undefined] = 0.0, np.inf
    return made


def _smoothest_plane(points: np.ndarray, planes: _PointPlanes, reach: float, monitor: Monitor) -> np.ndarray:
    """Return the number (n,) of the smoothest plane within ``reach`` (m) of each point (n, 4); -1 where none is."""
    found = np.full(len(points), -1, np.int32)

    def work(rows: np.ndarray) -> None:
        own, candidates = points[rows], planes.neighbors[rows]
        deviation = planes.deviation[candidates]
        left = np.arange(len(rows))
        # The smoothest plane holds most points; test the other planes for the rest only.
        for is_last in (False, True):
            if is_last:
                off = np.einsum("ikj,ij->ik", planes.planes[candidates], own)
                deviation[np.abs(off) > reach] = np.inf
            every, best = np.arange(len(left)), np.argmin(deviation, axis=1)
            plane = candidates[every, best]
            holds = np.isfinite(deviation[every, best])
            holds &= np.abs(np.einsum("ij,ij->i", planes.planes[plane], own)) <= reach
            found[rows[left[holds]]] = plane[holds]
            rest = ~holds
            left, own, candidates, deviation = left[rest], own[rest], candidates[rest], deviation[rest]

    in_chunks(work, np.arange(len(found)), Nearest(planes.neighbors.shape[1]).rows_per_chunk(len(found)), monitor)
    return found


def _keep_linked(neighbors: np.ndarray) -> None:
    """Keep as many of the neighbors (n, k), nearest first, as show a plane: links are looked for among these only.

    Memory of the others is freed, without a copy.
    """
    # Take ranks evenly, so that links cross from one scan line to the next.
    ranks = np.unique(np.linspace(1, neighbors.shape[1] - 1, LEAST_NEIGHBORS - 1).astype(int))
    flat = neighbors.reshape(-1)
    for first in range(0, len(neighbors), ROWS_AT_ONCE):
        kept = neighbors[first : first + ROWS_AT_ONCE, ranks].ravel()
        flat[first * len(ranks) : first * len(ranks) + len(kept)] = kept
    del flat
    neighbors.resize((len(neighbors), len(ranks)), refcheck=False)


def _links(
    points: np.ndarray, planes: _PointPlanes, plane: np.ndarray, on_surface: np.ndarray, reach: float, monitor: Monitor
) -> tuple[np.ndarray, np.ndarray]:
    """Return the neighbors (m,) of each point whose planes are one surface with its own, and where (n + 1,) they start.

    One surface is within ``reach`` (m) of both points.
    """
    n_links = np.zeros(len(plane) + 1, np.int64)
    linked: list[np.ndarray] = [np.empty(0, np.int32)] * -(-len(plane) // ROWS_AT_ONCE)

    def work(rows: np.ndarray) -> None:
        neighbors = planes.neighbors[rows]
        is_link = on_surface[rows, None] & on_surface[neighbors]
        # Most neighbors have the same plane, so that only the others are compared.
        apart = np.nonzero(is_link & (plane[neighbors] != plane[rows, None]))
        a, b = rows[apart[0]], neighbors[apart]
        of_a, of_b = planes.planes[plane[a]], planes.planes[plane[b]]
        # Normals point upward, on walls to either side by chance.
        same = np.abs(np.einsum("ij,ij->i", of_a[:, :3], of_b[:, :3])) >= np.cos(np.radians(PATCHES.same_direction))
        same &= np.abs(np.einsum("ij,ij->i", points[b], of_a)) <= reach
        same &= np.abs(np.einsum("ij,ij->i", points[a], of_b)) <= reach
        is_link[apart] = same
        n_links[rows + 1] = is_link.sum(axis=1)
        linked[rows[0] // ROWS_AT_ONCE] = neighbors[is_link]

    in_chunks(work, np.arange(len(plane)), ROWS_AT_ONCE, monitor)
    return np.concatenate(linked), np.cumsum(n_links)


def _components(linked: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Return the number (n,) of the component of each point, from the links by :func:`_links`."""
    count = len(starts) - 1
    # The weights are of the type that the search for components would turn them to.
    graph = sparse.csr_matrix((np.ones(len(linked)), linked, starts), (count, count))
    return csgraph.connected_components(graph, directed=False)[1]
