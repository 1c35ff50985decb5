"""Triangles of a plane face with holes, on its own vertices."""

import math
from collections import deque

import numpy as np

from ..criteria import ROUNDING
from ..geometry.polygons import area_vector, axes_across


def triangulate_face(vertices: np.ndarray, rings: list[list[int]]) -> list[list[int]]:
    """Return the constrained Delaunay triangles (a, b, c) of a plane face, oriented as it is.

    Parameters
    ----------
    vertices : ndarray of shape (n, 3)
        Positions (m).
    rings : list of list of int
        Exterior and holes, open, counterclockwise and clockwise seen from outside.

    References
    ----------
    Held, M., 2001. FIST: fast industrial-strength triangulation of polygons (bridges to holes, then ears). [held2001]
    Lawson, C. L., 1977. Software for C1 surface interpolation (sides turned until all are Delaunay). [lawson1977]
    """
    used = sorted({v for ring in rings for v in ring})
    positions = dict(zip(used, _in_plane(vertices, rings, used).tolist()))
    ring = list(rings[0])
    # The rightmost hole first: its bridge then crosses no other hole.
    for hole in sorted(rings[1:], key=lambda hole: -max(positions[v][0] for v in hole)):
        ring = _bridged(ring, hole, positions)
    triangles = []
    while len(ring) > 3:
        ear = next((i for i in range(len(ring)) if _is_ear(ring, i, positions)), None)
        if ear is None:
            # Only vertices on straight edges are left over by rounding.
            ear = int(np.argmax([_turn(*(positions[v] for v in _corner(ring, i))) for i in range(len(ring))]))
        triangles.append(list(_corner(ring, ear)))
        ring.pop(ear)
    return _turned([*triangles, ring], rings, positions)


def _turned(triangles: list[list[int]], rings: list[list[int]], positions: dict) -> list[list[int]]:
    """Return triangles after each side between two has become the other one where that is Delaunay's."""
    edges = {edge for ring in rings for a, b in zip(ring, [*ring[1:], ring[0]]) for edge in ((a, b), (b, a))}
    across = {(a, b): c for ring in triangles for a, b, c in (ring, ring[1:] + ring[:1], ring[2:] + ring[:2])}
    waiting = deque(sorted((a, b) for a, b in across if a < b and (a, b) not in edges))
    while waiting:
        a, b = waiting.popleft()
        c, d = across.get((a, b)), across.get((b, a))
        if c is None or d is None or not _is_better(*(positions[v] for v in (a, b, c, d))):
            continue
        del across[a, b], across[b, a]
        for u, v, w in ((a, d, c), (d, b, c)):
            across[u, v], across[v, w], across[w, u] = w, u, v
        waiting.extend((min(u, v), max(u, v)) for u, v in ((a, d), (d, b), (b, c), (c, a)) if (u, v) not in edges)
    return [list(corners) for corners in sorted((a, b, c) for (a, b), c in across.items() if a < b and a < c)]


def _is_better(a, b, c, d) -> bool:
    """Return whether Delaunay triangles have the side from c to d where a to b is now, c to the left of it."""
    if _turn(c, a, d) <= ROUNDING or _turn(d, b, c) <= ROUNDING:
        return False
    (ax, ay), (bx, by), (cx, cy) = ((x - d[0], y - d[1]) for x, y in (a, b, c))
    a2, b2, c2 = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    inside = a2 * (bx * cy - cx * by) - b2 * (ax * cy - cx * ay) + c2 * (ax * by - bx * ay)
    return inside > ROUNDING * (a2 + b2 + c2)


def _in_plane(vertices: np.ndarray, rings: list[list[int]], used: list[int]) -> np.ndarray:
    """Return the vertices of a face in two axes of its plane, counterclockwise for the exterior."""
    normal = area_vector(vertices[rings[0]])
    return (vertices[used] - vertices[rings[0][0]]) @ np.column_stack(axes_across(normal / np.linalg.norm(normal)))


def _corner(ring: list[int], i: int) -> tuple[int, int, int]:
    return ring[i - 1], ring[i], ring[(i + 1) % len(ring)]


def _turn(a, b, c) -> float:
    """Return twice the area (m²) of a triangle, negative where it turns clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _is_ear(ring: list[int], i: int, positions: dict) -> bool:
    names = _corner(ring, i)
    a, b, c = (positions[v] for v in names)
    if _turn(a, b, c) <= ROUNDING:
        return False
    others = (positions[v] for v in ring if v not in names)
    return not any(_turn(a, b, p) >= 0 and _turn(b, c, p) >= 0 and _turn(c, a, p) >= 0 for p in others)


def _bridged(ring: list[int], hole: list[int], positions: dict) -> list[int]:
    """Return one ring of a ring and a hole in it, joined along a line that crosses neither."""
    start = max(range(len(hole)), key=lambda i: positions[hole[i]])
    order = sorted(range(len(ring)), key=lambda i: math.dist(positions[ring[i]], positions[hole[start]]))
    # Only a hole that touches the ring is seen from none of its vertices, or one that rounding put there.
    i = next((i for i in order if _sees(ring, i, hole, positions[hole[start]], positions)), order[0])
    return [*ring[: i + 1], *hole[start:], *hole[: start + 1], *ring[i:]]


def _sees(ring: list[int], i: int, hole: list[int], position, positions: dict) -> bool:
    """Return whether nothing of ring and hole lies between a vertex of the ring and a position inside it."""
    before, vertex, after = (positions[v] for v in _corner(ring, i))
    # Of a vertex that an earlier bridge doubled, the corner that faces the hole counts.
    is_convex = _turn(before, vertex, after) >= 0
    within = (_turn(before, vertex, position) > 0, _turn(vertex, after, position) > 0)
    if not (all(within) if is_convex else any(within)):
        return False
    edges = [*zip(ring, [*ring[1:], ring[0]]), *zip(hole, [*hole[1:], hole[0]])]
    return not any(_do_cross(vertex, position, positions[u], positions[v]) for u, v in edges)


def _do_cross(a, b, c, d) -> bool:
    """Return whether the segments ab and cd cross between their ends."""
    return _turn(a, b, c) * _turn(a, b, d) < 0 and _turn(c, d, a) * _turn(c, d, b) < 0
