"""Outlines of points in a plane: alpha shapes without their holes."""

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..geometry.groups import components, mask_of, members, placed
from ..geometry.rings import rings_of_edges, signed_area
from ..packages import spatial


@dataclass(frozen=True)
class Tracing:
    """Triangles over points, and the piece that each is part of.

    An edge lies opposite a corner of its triangle and has the triangle on its left.
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
        corners = self.xy[self.triangles]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        return 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])

    @property
    def parts(self) -> list[np.ndarray]:
        """The closed ring (m) around each piece, counterclockwise: the largest of one that touches itself."""
        across = np.where(self.neighbors >= 0, self.face[self.neighbors], -1)
        triangle, corner = np.nonzero((self.face[:, None] >= 0) & (across != self.face[:, None]))
        start, end = (self.triangles[triangle, (corner + step) % 3] for step in (1, 2))
        edges = members(self.face[triangle] + 1).values()
        found = (rings_of_edges(zip(start[own].tolist(), end[own].tolist())) for own in edges)
        rings = ([self.xy[[*ring, ring[0]]] for ring in of_piece] for of_piece in found)
        return [max(of_piece, key=signed_area) for of_piece in rings]


def triangulated(xy: np.ndarray) -> Optional[Any]:
    """Return the Delaunay triangulation of points (n, 2), m, about their middle; None where they have no area."""
    # With a standard deviation below a millimeter across, the points lie on a line.
    if len(xy) < 3 or np.linalg.eigvalsh(np.cov((xy - xy.mean(axis=0)).T))[0] < 1e-6:
        return None
    return spatial.Delaunay(xy - xy.mean(axis=0))


def trace_outlines(xy: np.ndarray, max_edge: float, triangulation: Any) -> Optional[Tracing]:
    """Return the pieces of triangles that share edges and have none longer than ``max_edge`` (m), holes filled.

    The triangulation is made of the points ``xy`` (n, 2), m; None where no triangle is left.

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
    reaches_rim = mask_of(piece.max() + 1, piece[(neighbors < 0).any(axis=1)])
    is_kept |= ~reaches_rim[piece]
    piece = np.unique(pieces_of(is_kept, neighbors)[is_kept], return_inverse=True)[1]
    return Tracing(xy, triangles, neighbors, placed(piece, is_kept, len(triangles), -1))


def pieces_of(value: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """Return the number (t,) from 0 of the piece that each triangle is in: triangles of one value that share edges."""
    rows, sides = np.nonzero((neighbors >= 0) & (value[neighbors] == value[:, None]))
    return components(rows, neighbors[rows, sides], len(value))[1]
