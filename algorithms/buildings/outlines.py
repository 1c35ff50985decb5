"""Outlines of points in plan: alpha shapes as rings.

A ring is a float64 array (m, 2), closed (last vertex equals first); an outline is a
list of rings, first the exterior counterclockwise, then the holes clockwise.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..packages import csgraph, sparse, spatial

# Between this percentile of the points' own spacing and the longest edge: room for what chance leaves open.
_PERCENTILE, _ROOM = 95, 2.0

# In terms of the mean point spacing: no shorter, which would tear roofs, and no longer, which would fill courtyards.
_SHORTEST, _LONGEST = 4.0, 8.0


@dataclass(frozen=True)
class Outlines:
    """The parts of an alpha shape, the rings of each, and the part of each point (-1 where it is in none)."""

    parts: list
    part_of_point: np.ndarray
    max_edge: float


def trace_outlines(xy: np.ndarray, spacing: float, max_edge: Optional[float] = None) -> Outlines:
    """Return the outlines of points, made of the triangles of their triangulation that have no long edge.

    Parameters
    ----------
    xy : ndarray of shape (n, 2)
        Coordinates (m).
    spacing : float
        Mean distance between neighboring points (m), a rough scale.
    max_edge : float, optional
        Longest edge (m). None adapts it to these points: twice the longest edge of the smallest triangle at a
        point, at the 95th percentile of the points, from 4 to 8 times the spacing.

    Returns
    -------
    Outlines
        Parts are groups of triangles that share edges; none when the points have no area. Rings never cross
        themselves or each other; a hole may touch another ring in single points.

    References
    ----------
    Edelsbrunner et al. (1983), On the shape of a set of points in the plane.
    Santos et al. (2019), Extraction of building roof boundaries from LiDAR data using an adaptive alpha shape.
    """
    nowhere = np.full(len(xy), -1)
    if len(xy) < 3:
        return Outlines([], nowhere, 0.0)
    local = xy - xy.mean(axis=0)
    # A millimeter of width, below which there is nothing to triangulate.
    if np.linalg.eigvalsh(np.cov(local.T))[0] < 1e-6:
        return Outlines([], nowhere, 0.0)
    triangulation = spatial.Delaunay(local)
    triangles, neighbors = triangulation.simplices, triangulation.neighbors
    longest = _longest_edges(local, triangles)
    if max_edge is None:
        max_edge = _adapted_edge(triangles, longest, len(xy), spacing)
    is_kept = longest <= max_edge
    component = _components(is_kept, neighbors)
    parts: list = [[] for _ in range(int(component.max(initial=-1)) + 1)]
    for ring, triangle in _rings(triangles, neighbors, is_kept):
        parts[component[triangle]].append(xy[ring])
    part_of_point = nowhere
    part_of_point[triangles[is_kept].ravel()] = np.repeat(component[is_kept], 3)
    return Outlines([sorted(rings, key=signed_area, reverse=True) for rings in parts], part_of_point, max_edge)


def signed_area(ring: np.ndarray) -> float:
    """Return the area (m²) within a ring, negative when it runs clockwise."""
    x, y = (ring - ring[0]).T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def perimeter(ring: np.ndarray) -> float:
    """Return the length (m) of a ring."""
    return float(np.hypot(*np.diff(ring, axis=0).T).sum())


def _longest_edges(xy: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    corners = xy[triangles]
    edges = corners - corners[:, [1, 2, 0]]
    return np.sqrt(np.einsum("ijk,ijk->ij", edges, edges).max(axis=1))


def _adapted_edge(triangles: np.ndarray, longest: np.ndarray, n_points: int, spacing: float) -> float:
    """Return the longest edge that suits these points: scan lines far apart need longer ones than an even cloud."""
    smallest = np.full(n_points, np.inf)
    np.minimum.at(smallest, triangles.ravel(), np.repeat(longest, 3))
    own = _ROOM * float(np.percentile(smallest[np.isfinite(smallest)], _PERCENTILE))
    return float(np.clip(own, _SHORTEST * spacing, _LONGEST * spacing))


def _components(is_kept: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """Return the group (from 0) of each kept triangle, those that share edges being one; -1 of the others."""
    number = np.full(len(is_kept), -1)
    number[is_kept] = np.arange(int(is_kept.sum()))
    there = neighbors[is_kept]
    inside = (there >= 0) & is_kept[there]
    pairs = np.repeat(number[is_kept], 3)[inside.ravel()], number[there[inside]]
    if not len(there):
        return number
    graph = sparse.coo_matrix((np.ones(len(pairs[0]), bool), pairs), (len(there), len(there)))
    number[is_kept] = csgraph.connected_components(graph, directed=False)[1]
    return number


def _rings(triangles: np.ndarray, neighbors: np.ndarray, is_kept: np.ndarray):
    """Yield the rings around the kept triangles, as closed lists of points, and one triangle of each.

    The half-edge ``3 t + i`` lies opposite corner i of triangle t and has the triangle on its left.
    """
    is_border = (is_kept[:, None] & ((neighbors < 0) | ~is_kept[neighbors])).ravel()
    border = np.flatnonzero(is_border)
    successor = dict(zip(border.tolist(), _next_on_border(border, is_border, neighbors).tolist()))
    start_of = triangles[:, [1, 2, 0]].ravel()
    while successor:
        first = next(iter(successor))
        edges, edge = [], first
        while edge in successor:
            edges.append(edge)
            edge = successor.pop(edge)
        for ring in _simple_rings(start_of[edges].tolist()):
            yield ring, first // 3


def _next_on_border(border: np.ndarray, is_border: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """Return the half-edge that follows each on the border, turning about its end through the kept triangles."""
    following = 3 * (border // 3) + (border % 3 + 1) % 3
    inner = np.flatnonzero(~is_border[following])
    while len(inner):
        triangle, corner = np.divmod(following[inner], 3)
        other = neighbors[triangle, corner]
        twin = np.argmax(neighbors[other] == triangle[:, None], axis=1)
        following[inner] = 3 * other + (twin + 1) % 3
        inner = inner[~is_border[following[inner]]]
    return following


def _simple_rings(points: list) -> list:
    """Split a closed walk at the points it visits twice, so that no ring touches itself."""
    rings: list = []
    walk: list = []
    position: dict = {}
    for point in [*points, points[0]]:
        if point in position:
            start = position[point]
            rings.append([*walk[start:], point])
            for left in walk[start:]:
                del position[left]
            del walk[start:]
        position[point] = len(walk)
        walk.append(point)
    return rings
