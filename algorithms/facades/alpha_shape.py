"""Outlines of points in a plane: alpha shapes without their holes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..geometry.groups import components
from ..geometry.rings import signed_area
from ..packages import spatial


@dataclass(frozen=True)
class Tracing:
    """Triangles over points, and the piece that each is part of.

    The half-edge ``3 t + i`` lies opposite corner i of triangle t and has the triangle on its left.
    """

    xy: np.ndarray  #: (n, 2): the points (m)
    #: triangles, neighbors, (t, 3): points of each triangle, counterclockwise, and the triangle across from each, -1
    #: for none
    triangles: np.ndarray
    neighbors: np.ndarray
    face: np.ndarray  #: (t,): piece of each triangle, from 0; -1 outside

    @property
    def areas(self) -> np.ndarray:
        """Area (m²) of each triangle."""
        return _areas(self.xy, self.triangles)

    @property
    def parts(self) -> list[np.ndarray]:
        """The closed ring (m) around each piece, counterclockwise."""
        starts = self.triangles[:, [1, 2, 0]].ravel()
        found: list = [[] for _ in range(int(self.face.max(initial=-1)) + 1)]
        for face, edges in self._rings(starts):
            points = self.xy[starts[edges]]
            found[face].append(np.concatenate([points, points[:1]]))
        return [max(rings, key=signed_area) for rings in found]

    def _rings(self, starts: np.ndarray) -> list:
        """Return the borders of the pieces, as pairs of piece and half-edges (with ``starts``) in order."""
        across = np.where(self.neighbors >= 0, self.face[self.neighbors], -1).ravel()
        is_border = (np.repeat(self.face, 3) >= 0) & (np.repeat(self.face, 3) != across)
        border = np.flatnonzero(is_border)
        following = _next_on_border(border, is_border, self.neighbors)
        successor = dict(zip(border.tolist(), following.tolist()))
        start_of = dict(zip(border.tolist(), starts[border].tolist()))
        found = []
        while successor:
            first = next(iter(successor))
            edges, edge = [], first
            while edge in successor:
                edges.append(edge)
                edge = successor.pop(edge)
            found += [(int(self.face[first // 3]), np.array(ring)) for ring in _simple_rings(edges, start_of)]
        return found


def triangulated(xy: np.ndarray) -> Optional[Any]:
    """Return the Delaunay triangulation of points (n, 2), m, about their middle; None where they have no area."""
    # With a standard deviation below a millimeter across, the points lie on a line.
    if len(xy) < 3 or np.linalg.eigvalsh(np.cov((xy - xy.mean(axis=0)).T))[0] < 1e-6:
        return None
    return spatial.Delaunay(xy - xy.mean(axis=0))


def trace_outlines(xy: np.ndarray, max_edge: float, triangulation: Any) -> Optional[Tracing]:
    """Return the pieces of triangles that share edges and have none longer than ``max_edge`` (m), holes filled.

    Parameters
    ----------
    xy : ndarray of shape (n, 2)
        Coordinates (m).
    max_edge : float
        Longest edge (m).
    triangulation : Delaunay
        That of the points, as :func:`triangulated` gives it.

    Returns
    -------
    Tracing or None
        None where no triangle is left.

    References
    ----------
    Edelsbrunner et al. (1983), On the shape of a set of points in the plane. [edelsbrunner1983]
    Santos et al. (2019), Extraction of building roof boundaries from LiDAR data using an adaptive alpha shape.
    [santosroofs2019]
    """
    triangles, neighbors = triangulation.simplices, triangulation.neighbors
    corners = xy[triangles]
    is_kept = (np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2) <= max_edge).all(axis=1)
    if not is_kept.any():
        return None
    piece = pieces_of(is_kept, neighbors)
    reaches_rim = np.zeros(piece.max() + 1, bool)
    reaches_rim[piece[(neighbors < 0).any(axis=1)]] = True
    is_kept |= ~reaches_rim[piece]
    face = np.full(len(triangles), -1)
    face[is_kept] = np.unique(pieces_of(is_kept, neighbors)[is_kept], return_inverse=True)[1]
    return Tracing(xy, triangles, neighbors, face)


def _areas(xy: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b = xy[triangles[:, 1]] - xy[triangles[:, 0]], xy[triangles[:, 2]] - xy[triangles[:, 0]]
    return 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def pieces_of(value: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """Return the number (t,) from 0 of the piece that each triangle is in: those of one value that share edges."""
    rows, sides = np.nonzero((neighbors >= 0) & (value[neighbors] == value[:, None]))
    return components(rows, neighbors[rows, sides], len(value))[1]


def _next_on_border(border: np.ndarray, is_border: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """Return the half-edge that follows each on the border, turning about its end through its own triangles."""
    following = 3 * (border // 3) + (border % 3 + 1) % 3
    inner = np.flatnonzero(~is_border[following])
    while len(inner):
        triangle, corner = np.divmod(following[inner], 3)
        other = neighbors[triangle, corner]
        twin = np.argmax(neighbors[other] == triangle[:, None], axis=1)
        following[inner] = 3 * other + (twin + 1) % 3
        inner = inner[~is_border[following[inner]]]
    return following


def _simple_rings(edges: list, starts: dict) -> list:
    """Split a closed walk of half-edges at the points it visits twice, so that no ring touches itself."""
    rings: list = []
    walk: list = []
    position: dict = {}
    for edge in edges:
        point = starts[edge]
        if point in position:
            start = position[point]
            rings.append(walk[start:])
            for closed in walk[start:]:
                del position[starts[closed]]
            del walk[start:]
        position[point] = len(walk)
        walk.append(edge)
    rings.append(walk)
    return rings
