"""Outlines of labeled points in plan: alpha shapes that share their edges where they touch.

A ring is a float64 array (m, 2), closed (last vertex equals first); an outline is a
list of rings, first the exterior counterclockwise, then the holes clockwise.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..geometry.grid import distinct, find_cells, grid_over
from ..geometry.groups import components
from ..geometry.rings import signed_area
from ..packages import spatial

# Percentile of the points' own spacing that the longest edge follows.
_PERCENTILE = 95

# The longest edge as a multiple of this percentile: chance leaves wider gaps.
_ROOM = 2.0

# Least value of the longest edge (mean point spacings): a shorter one would tear roofs.
_SHORTEST = 4.0

# Largest value of the longest edge (mean point spacings): a longer one would fill courtyards.
_LONGEST = 8.0

# Cells (times the mean point spacing) in which the inside of an area is mapped: a lattice of their middles has no
# triangle with an edge as long as the shortest of the longest edges.
_INNER_CELL = 2.5

# Width (cells) of the margin of cells with points around the inside of an area: flat triangles at an edge span one.
_DEEP_CELLS = 2

# Buildings whose points are closer than this (spacings) touch; chance leaves wider gaps in one roof of twenty.
_TOUCHING = 3.0

# Mean distance of the outermost points from the edge of their roof (mean point spacings), on simulated roofs.
_INSET = 0.3

# Distance by which the edge lies beyond the middle between the outermost points and the non-building points beside
# them (mean point spacings), on simulated roofs: those nearest to the roof lie ahead of the others.
_AHEAD = 0.2

# Distance (mean point spacings) from which non-building points no longer show where the edge is.
_SEEN = 2.0


@dataclass(frozen=True)
class Tracing:
    """Triangles over points, the face (building) of each, and the half-edges between faces.

    The half-edge ``3 t + i`` lies opposite corner i of triangle t and has the triangle on its left.

    Attributes
    ----------
    xy : ndarray of shape (n, 2)
        The points (m).
    label : ndarray of shape (n,)
        Building of each point, 0 for non-building points.
    triangles, neighbors : ndarray of shape (t, 3)
        Points of each triangle, counterclockwise, and the triangle across from each, -1 for none.
    face : ndarray of shape (t,)
        Face of each triangle, from 0; -1 outside.
    labels : ndarray of shape (f,)
        Label of each face.
    outset : ndarray of shape (3 t,)
        Distance (m) from a half-edge outward to where the building is taken to end, half of the way to the next
        non-building point, at most half a spacing; 0 between two faces.
    max_edge : float
        Longest edge (m) that joins two points of one building.
    triangulation : scipy.spatial.Delaunay
        The triangles, to find positions in; its points are ``xy`` less their mean.
    """

    xy: np.ndarray
    label: np.ndarray
    triangles: np.ndarray
    neighbors: np.ndarray
    face: np.ndarray
    labels: np.ndarray
    outset: np.ndarray
    max_edge: float
    triangulation: Any

    @property
    def starts(self) -> np.ndarray:
        """Point that each half-edge starts from."""
        return self.triangles[:, [1, 2, 0]].ravel()

    @property
    def ends(self) -> np.ndarray:
        """Point that each half-edge leads to."""
        return self.triangles[:, [2, 0, 1]].ravel()

    def beyond(self, group: np.ndarray) -> np.ndarray:
        """Return the group (3 t,) across each half-edge, -1 outside, for groups (t,) of triangles."""
        return np.where(self.neighbors >= 0, group[self.neighbors], -1).ravel()

    @property
    def areas(self) -> np.ndarray:
        """Area (m²) of each triangle."""
        return _areas(self.xy, self.triangles)

    def locate(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the triangle (n,) around each position (n, 2), -1 outside, and the shares (n, 3) of its corners."""
        positions = positions - self.xy.mean(axis=0)
        triangle = self.triangulation.find_simplex(positions)
        transform = self.triangulation.transform[triangle]
        share = np.einsum("nij,nj->ni", transform[:, :2], positions - transform[:, 2])
        return triangle, np.column_stack([share, 1 - share.sum(axis=1)])

    @property
    def parts(self) -> list:
        """Outlines through the points: for each face its rings, the exterior first."""
        found: list = [[] for _ in self.labels]
        for face, edges in self.rings(self.face):
            points = self.xy[self.starts[edges]]
            found[face].append(np.concatenate([points, points[:1]]))
        return [sorted(rings, key=signed_area, reverse=True) for rings in found]

    def rings(self, group: np.ndarray) -> list:
        """Return the borders of groups of triangles (t,), -1 being none, as pairs of group and half-edges in order."""
        is_border = (group[:, None] >= 0).repeat(3, axis=1).ravel() & (np.repeat(group, 3) != self.beyond(group))
        border = np.flatnonzero(is_border)
        following = _next_on_border(border, is_border, self.neighbors)
        successor = dict(zip(border.tolist(), following.tolist()))
        starts = dict(zip(border.tolist(), self.starts[border].tolist()))
        found = []
        while successor:
            first = next(iter(successor))
            edges, edge = [], first
            while edge in successor:
                edges.append(edge)
                edge = successor.pop(edge)
            found += [(int(group[first // 3]), np.array(ring)) for ring in _simple_rings(edges, starts)]
        return found


def triangulated(xy: np.ndarray) -> Optional[Any]:
    """Return the Delaunay triangulation of points (n, 2), m, about their middle; None where they have no area."""
    # A millimeter of width, below which there is nothing to triangulate.
    if len(xy) < 3 or np.linalg.eigvalsh(np.cov((xy - xy.mean(axis=0)).T))[0] < 1e-6:
        return None
    return spatial.Delaunay(xy - xy.mean(axis=0))


def trace_outlines(
    xy: np.ndarray,
    label: np.ndarray,
    spacing: float,
    max_edge: Optional[float] = None,
    min_area: float = 0.0,
    min_hole_area: float = 0.0,
    stands_for: Optional[np.ndarray] = None,
    triangulation: Optional[Any] = None,
) -> Optional[Tracing]:
    """Divide the area of labeled points among their labels: triangles of their triangulation without long edges.

    Parameters
    ----------
    xy : ndarray of shape (n, 2)
        Coordinates (m).
    label : ndarray of shape (n,)
        Building of each point, from 1. Points of 0 are non-building: no building reaches them.
    spacing : float
        Mean distance between neighboring points (m), a rough scale.
    max_edge : float, optional
        Longest edge (m) within a building. None adapts it to these points: twice the longest edge of the smallest
        triangle at a point, at the 95th percentile of the points, from 4 to 8 times the spacing.
    min_area : float
        Smaller pieces (m²) go to the building beside them, or vanish.
    min_hole_area : float
        Smaller holes (m²) are filled.
    stands_for : ndarray of shape (n,), optional
        How many points inside a building each point stands for, as :func:`without_inside` gives it; 0 for one itself.
    triangulation : Delaunay, optional
        That of the points, as :func:`triangulated` gives it, where it is there already.

    Returns
    -------
    Tracing or None
        Faces are groups of triangles of one label that share edges. None when the points have no area.

    References
    ----------
    Edelsbrunner et al. (1983), On the shape of a set of points in the plane. [edelsbrunner1983]
    Santos et al. (2019), Extraction of building roof boundaries from LiDAR data using an adaptive alpha shape.
    [santosroofs2019]
    """
    triangulation = triangulated(xy) if triangulation is None else triangulation
    if triangulation is None:
        return None
    triangles, neighbors = triangulation.simplices, triangulation.neighbors
    length = _edge_lengths(xy, triangles)
    longest = length.max(axis=1)
    corner_label = label[triangles]
    is_roof = (corner_label > 0).all(axis=1)
    if not is_roof.any():
        return None
    if max_edge is None:
        stands_for = np.zeros(len(xy)) if stands_for is None else stands_for
        max_edge = _adapted_edge(triangles[is_roof], longest[is_roof], stands_for, spacing)
    is_mixed = (corner_label != corner_label[:, :1]).any(axis=1)
    is_kept = is_roof & (longest <= np.where(is_mixed, min(max_edge, _TOUCHING * spacing), max_edge))
    value = np.where(is_kept, _majority(corner_label), 0)
    area = _areas(xy, triangles)
    _absorb(value, neighbors, length, area, spacing, 0, min_hole_area)
    _absorb(value, neighbors, length, area, spacing, 1, min_area)
    face, labels = _faces(value, neighbors)
    outset = _outsets(neighbors, triangles, face, label, length, area, spacing)
    return Tracing(xy, label, triangles, neighbors, face, labels, outset, max_edge, triangulation)


def _edge_lengths(xy: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the lengths (t, 3) of the edges opposite each corner."""
    edges = xy[triangles[:, [2, 0, 1]]] - xy[triangles[:, [1, 2, 0]]]
    return np.sqrt(np.einsum("ijk,ijk->ij", edges, edges))


def _areas(xy: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b = xy[triangles[:, 1]] - xy[triangles[:, 0]], xy[triangles[:, 2]] - xy[triangles[:, 0]]
    return 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _adapted_edge(triangles: np.ndarray, longest: np.ndarray, stands_for: np.ndarray, spacing: float) -> float:
    """Return the longest edge that suits these points: scan lines far apart need longer ones than an even cloud."""
    smallest = np.full(len(stands_for), np.inf)
    np.minimum.at(smallest, triangles.ravel(), np.repeat(longest, 3))
    # Points inside a building that others stand for are close to each other.
    own = np.sort(smallest[np.isfinite(smallest) & (stands_for == 0)])
    n_close = int(stands_for.sum())
    rank = _PERCENTILE / 100 * (len(own) + n_close - 1) - n_close
    if rank < 0:
        return _SHORTEST * spacing
    edge = _ROOM * float(np.interp(rank, np.arange(len(own)), own))
    return float(np.clip(edge, _SHORTEST * spacing, _LONGEST * spacing))


def without_inside(xy: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Return points of one area with a lattice in the place of those well inside, which no outline comes near.

    Parameters
    ----------
    xy : ndarray of shape (n, 2)
        Points (m).
    spacing : float
        Mean distance between neighboring points (m).

    Returns
    -------
    points : ndarray of shape (m, 2)
        The points near gaps and edges, then the middles of cells well inside of such with points.
    stands_for : ndarray of shape (m,), int64
        How many points each of these stands for, 0 for a point itself.
    """
    grid = grid_over(xy, _INNER_CELL * spacing)
    cells, which = distinct(grid.number(xy))
    is_inner = np.ones(len(cells), bool)
    around = [find_cells(cells, cells + step) for step in grid.around]
    for _ in range(_DEEP_CELLS):
        is_inner &= np.all([found & is_inner[row] for row, found in around], axis=0)
    rest = xy[~is_inner[which]]
    count = np.bincount(which, minlength=len(cells))[is_inner]
    points = np.concatenate([rest, grid.center(cells[is_inner])])
    return points, np.concatenate([np.zeros(len(rest), np.int64), count])


def _majority(labels: np.ndarray) -> np.ndarray:
    """Return the label (t,) that two corners or three have, of three different ones the least."""
    a, b, c = labels.T
    return np.where(b == c, b, np.where((a == b) | (a == c), a, np.minimum(np.minimum(a, b), c)))


def pieces_of(value: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """Return the number (t,) from 0 of the piece that each triangle is in: those of one value that share edges."""
    rows, sides = np.nonzero((neighbors >= 0) & (value[neighbors] == value[:, None]))
    return components(rows, neighbors[rows, sides], len(value))[1]


def _absorb(
    value: np.ndarray,
    neighbors: np.ndarray,
    length: np.ndarray,
    area: np.ndarray,
    spacing: float,
    least: int,
    min_area: float,
) -> None:
    """Give pieces that are too small to the label beside them, in place: holes (``least`` 0) or buildings (1)."""
    piece = pieces_of(value, neighbors)
    size = np.bincount(piece, area)
    # The points of a roof lie inside its edge, so that it is larger than the triangles over them, and a hole smaller.
    rows, sides = np.nonzero((neighbors >= 0) & ((value[neighbors] > 0) != (value[:, None] > 0)))
    rim = np.bincount(piece[rows], length[rows, sides], len(size)) * spacing / 2
    kind = np.zeros(len(size), value.dtype)
    kind[piece] = value
    size = np.maximum(size + rim * (1 if least else -1), 0.0)
    small = (size < min_area) & ((kind > 0) if least else (kind == 0))
    # What reaches the rim of the triangulation is no hole.
    if not least:
        small[piece[(neighbors < 0).any(axis=1)]] = False
    rows, sides = np.nonzero(small[piece][:, None] & (neighbors >= 0))
    other = neighbors[rows, sides]
    beside = (value[other] > 0) & (piece[other] != piece[rows])
    if least:
        beside &= ~small[piece[other]]
    mine, theirs, shared = piece[rows][beside], value[other][beside], length[rows, sides][beside]
    given = np.zeros(len(size), value.dtype)
    if len(mine):
        pairs, inverse = np.unique(np.column_stack([mine, theirs]), axis=0, return_inverse=True)
        border = np.bincount(inverse.ravel(), shared)
        # The longest border comes last for each piece, and stays.
        order = np.argsort(border, kind="stable")
        given[pairs[order, 0]] = pairs[order, 1]
    changed = small[piece]
    value[changed] = given[piece[changed]]


def _faces(value: np.ndarray, neighbors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the face of each triangle, -1 outside, and the label of each face, in ascending order."""
    piece = pieces_of(value, neighbors)
    label = np.zeros(piece.max() + 1, value.dtype)
    label[piece] = value
    order = np.argsort(label, kind="stable")
    order = order[label[order] > 0]
    number = np.full(len(label), -1)
    number[order] = np.arange(len(order))
    return number[piece], label[order]


def _outsets(
    neighbors: np.ndarray,
    triangles: np.ndarray,
    face: np.ndarray,
    label: np.ndarray,
    length: np.ndarray,
    area: np.ndarray,
    spacing: float,
) -> np.ndarray:
    """Return how far (3 t,) beyond its outermost points a building reaches: half-way to the non-building points."""
    outset = np.full(neighbors.size, _INSET * spacing)
    triangle, side = np.nonzero((face[:, None] >= 0) & (neighbors >= 0))
    other = neighbors[triangle, side]
    half_edge = 3 * triangle + side
    outset[half_edge[face[other] >= 0]] = 0.0
    back = np.argmax(neighbors[other] == triangle[:, None], axis=1)
    is_non_building = (label[triangles[other, back]] == 0) & (face[other] < 0)
    height = 2 * area[other[is_non_building]] / length[other[is_non_building], back[is_non_building]]
    beside = height <= _SEEN * spacing
    outset[half_edge[is_non_building][beside]] = np.minimum(height[beside] / 2 + _AHEAD * spacing, height[beside])
    return outset


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
            for left in walk[start:]:
                del position[starts[left]]
            del walk[start:]
        position[point] = len(walk)
        walk.append(edge)
    rings.append(walk)
    return rings
