"""The footprint of a building divided among the planes of its roof, along lines where these may meet or end."""

import math
from dataclasses import dataclass, field

import numpy as np

from ..criteria import MILLIMETER, PARALLEL
from ..geometry.cheapest_labels import cheapest_labels
from ..geometry.delaunay import triangulate
from ..geometry.groups import members, placed, split_groups
from ..geometry.polygon_overlap import are_within
from ..geometry.rings import sides_of_rings
from ..geometry.subdivision import SNAP, Subdivision
from ..sampling.density import DENSITY, link_distance
from .roof_planes import RoofPlanes
from .solid_levels import ON_OUTLINE

# A tip of a cell narrower than this (m) is closed: twice the distance that edges of a face keep from each other.
_TIP = 2 * MILLIMETER

# Cells with a mean width below this (m) are wedges between lines that are nearly the same.
_WEDGE = 0.02

# Distances from a plane are cut off at this many tolerances.
_FAR_OFF = 2.0

# All points on top of the roof draw their cells to nearby planes. From this distance (m) on they count in full, and
# steps between two planes cost no more.
FARTHEST = 1.0

# Weight of a point on top that counts in full, as a share of its area.
_FAR_WEIGHT = 0.5

# Area (m²) of roof without a plane that costs as much as a meter of border between two planes. A dormer of 1.5 m by
# 1.5 m has 6 m of border.
_BORDER = 0.10

# Area (m²) of roof without a plane that costs as much as a square meter of the wall between two planes.
_STEP = 0.05

# Least height (m) of roofs over the ground.
_LEAST_HEIGHT = 0.5

# Largest depth (m) of a roof below the lowest of its points.
_BELOW_POINTS = 1.5

# Cost (m²) of a plane that is too low within a cell, and of a cell left out: more than the points of any cell can cost.
FORBIDDEN = 1000.0

# Points of two planes are adjacent if a side of a triangle of at most this length joins them (spacings, or m if that is
# more).
_BESIDE_SPACINGS, _BESIDE = 6.0, 2.0

# Least number of contacts of a line.
_LEAST_CONTACTS = 3

# A line whose ends lie no farther than this (m) from another one is the same.
_SAME_OFFSET = 0.10

# Walls of at least this share of the length of the longest one give main directions.
_LONG = 0.5

# A step is located by points no farther from it than this (m), or than points of one object are apart.
_NEAR = 0.6

# Factor by which contacts count more along the main directions, and along and across the slopes of the two planes.
_PREFERENCE = 1.15


@dataclass(frozen=True)
class LinePiece:
    """A piece of a line in plan: its ends (m), and its weight, the number of its contacts."""

    start: np.ndarray
    end: np.ndarray
    weight: float


def find_roof_lines(xyz: np.ndarray, planes: RoofPlanes, rings: list, spacing: float) -> list[LinePiece]:
    """Find the lines along which planes intersect or step, sorted by the order in which they cut.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points (m).
    planes : RoofPlanes
        Their planes.
    rings : list of ndarray of shape (k, 2)
        Closed rings of the footprint (m), whose walls give the main directions.
    spacing : float
        Mean distance between neighboring points (m).

    Returns
    -------
    list of LinePiece
        Intersections first, heaviest first; without those that lie on a heavier one.
    """
    member = np.flatnonzero(planes.label >= 0)
    if len(planes) < 2 or len(member) < 4:
        return []
    one, other, middle = _contacts(xyz[member, :2], planes.label[member], spacing)
    main = main_directions(rings)
    points = [xyz[rows, :2] for rows in split_groups(planes.label, len(planes))]
    meeting, stepping = [], []
    for number, rows in members(one * len(planes) + other + 1).items():
        pair = divmod(number - 1, len(planes))
        border = _Border(planes, pair, middle[rows], [points[plane] for plane in pair], spacing)
        meeting += border.intersection()
        stepping += border.steps(main)
    return _without_doubles(sorted(meeting, key=lambda p: -p.weight) + sorted(stepping, key=lambda p: -p.weight))


def main_directions(rings: list) -> np.ndarray:
    """Return unit vectors (k, 2) along and across the longer walls of a footprint."""
    edge = np.concatenate([np.diff(ring, axis=0) for ring in rings])
    length = np.hypot(*edge.T)
    is_long = length >= _LONG * length.max()
    along = edge[is_long] / length[is_long, None]
    return np.concatenate([along, np.column_stack([-along[:, 1], along[:, 0]])])


def _contacts(xy: np.ndarray, label: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find pairs of neighboring points (n, 2) on different planes.

    Returns the numbers (m,), (m,) of the two planes, the smaller one first, and the middles (m, 2) of the pairs.
    """
    if np.linalg.matrix_rank(xy - xy.mean(axis=0)) < 2:
        return np.zeros(0, int), np.zeros(0, int), np.zeros((0, 2))
    mesh = triangulate(xy)
    side = np.unique(np.sort(mesh.facets[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    side = side[label[side[:, 0]] != label[side[:, 1]]]
    length = np.hypot(*(xy[side[:, 0]] - xy[side[:, 1]]).T)
    side = side[length <= max(_BESIDE, _BESIDE_SPACINGS * spacing)]
    pair = np.sort(label[side], axis=1)
    return pair[:, 0], pair[:, 1], xy[side].mean(axis=1)


class _Border:
    """Where two planes are next to each other: positions (m, 2) between their points, and the points of both (k, 2)."""

    def __init__(
        self, planes: RoofPlanes, pair: tuple[int, int], positions: np.ndarray, points: list[np.ndarray], spacing: float
    ) -> None:
        one, other = pair
        self.points, self.positions, self.spacing = points, positions, spacing
        self.difference = planes.coefficients[one] - planes.coefficients[other]
        self.slopes = planes.coefficients[[one, other], :2]
        self.turn = float(np.hypot(*self.difference[:2]))
        step = np.abs(positions @ self.difference[:2] + self.difference[2])
        self.at_line = (step <= link_distance(spacing) * self.turn) & (self.turn > PARALLEL)

    def intersection(self) -> list[LinePiece]:
        """Return the piece of the line in which the planes intersect, if they meet there."""
        if self.at_line.sum() < _LEAST_CONTACTS:
            return []
        normal = self.difference[:2] / self.turn
        position = -normal * self.difference[2] / self.turn
        return [self._piece(position, np.array([-normal[1], normal[0]]), self.positions[self.at_line])]

    def steps(self, main: np.ndarray) -> list[LinePiece]:
        """Return lines along the contacts where one plane is above the other."""
        remaining = self.positions[~self.at_line]
        directions, weight = self._directions(main)
        normals = np.column_stack([-directions[:, 1], directions[:, 0]])
        found: list[LinePiece] = []
        # Width (m) of the strip whose contacts are of one step.
        width = max(0.3, self.spacing)
        while len(remaining) >= _LEAST_CONTACTS:
            offset = normals @ remaining.T
            order = np.sort(offset, axis=1)
            # Shift the rows apart, so that all directions make one ascending array.
            apart = (np.ptp(order) + width + 1.0) * np.arange(len(order))[:, None]
            ends = np.searchsorted((order + apart).ravel(), (order + apart + width).ravel(), side="right")
            count = (ends - np.arange(order.size)).reshape(order.shape)
            best = int(np.argmax(count.max(axis=1) * weight))
            first = order[best, np.argmax(count[best])]
            chosen = (offset[best] >= first) & (offset[best] <= first + width)
            if chosen.sum() < _LEAST_CONTACTS:
                break
            direction, normal = directions[best], normals[best]
            position = normal * self._between(normal, direction, remaining[chosen])
            found.append(self._piece(position, direction, remaining[chosen]))
            remaining = remaining[~chosen]
        return found

    def _between(self, normal: np.ndarray, direction: np.ndarray, contacts: np.ndarray) -> float:
        """Return the offset (m) of the line that separates the points of both planes along contacts best."""
        middle = float(np.median(contacts @ normal))
        low, high = (contacts @ direction).min(), (contacts @ direction).max()
        near = max(_NEAR, DENSITY.link * self.spacing)
        offsets = []
        for xy in self.points:
            along, offset = xy @ direction, xy @ normal
            offsets.append(offset[(along >= low) & (along <= high) & (np.abs(offset - middle) <= near)])
        if not all(map(len, offsets)):
            return middle
        if np.median(offsets[0]) > np.median(offsets[1]):
            offsets.reverse()
        every = np.sort(np.concatenate(offsets))
        cuts = np.concatenate([[every[0]], (every[1:] + every[:-1]) / 2, [every[-1]]])
        beyond = len(offsets[0]) - np.searchsorted(np.sort(offsets[0]), cuts)
        wrong = beyond + np.searchsorted(np.sort(offsets[1]), cuts)
        best = np.flatnonzero(wrong == wrong.min())
        return float(cuts[best[np.argmin(np.abs(cuts[best] - middle))]])

    def _directions(self, main: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return directions (k, 2) that steps may have, and how much they are preferred (k,)."""
        slopes = self.slopes[np.hypot(*self.slopes.T) > PARALLEL]
        slopes = slopes / np.hypot(*slopes.T)[:, None]
        preferred = np.concatenate([main, slopes, np.column_stack([-slopes[:, 1], slopes[:, 0]])])
        fan = np.deg2rad(np.arange(0, 180, 15))
        found = np.concatenate([preferred, np.column_stack([np.cos(fan), np.sin(fan)])])
        return found, np.repeat([_PREFERENCE, 1.0], [len(preferred), len(fan)])

    def _piece(self, position: np.ndarray, direction: np.ndarray, contacts: np.ndarray) -> LinePiece:
        along = (contacts - position) @ direction
        # As far as the next contact might lie: a cell is cut from side to side anyway.
        beyond = link_distance(self.spacing)
        low, high = along.min() - beyond, along.max() + beyond
        return LinePiece(position + low * direction, position + high * direction, float(len(contacts)))


def _without_doubles(pieces: list[LinePiece]) -> list[LinePiece]:
    """Return the pieces but those that an earlier one covers."""
    if not pieces:
        return []
    start, end = np.array([one.start for one in pieces]), np.array([one.end for one in pieces])
    length = np.hypot(*(end - start).T)
    direction, beyond = (end - start) / length[:, None], DENSITY.least_link
    kept: list[int] = []
    for i in range(len(pieces)):
        u = direction[kept]
        covers = np.ones(len(kept), bool)
        for position in (start[i], end[i]):
            offset = position - start[kept]
            along = np.einsum("ij,ij->i", offset, u)
            across = np.abs(u[:, 0] * offset[:, 1] - u[:, 1] * offset[:, 0])
            covers &= (across <= _SAME_OFFSET) & (along >= -beyond) & (along <= length[kept] + beyond)
        if not covers.any():
            kept.append(i)
    return [pieces[i] for i in kept]


@dataclass
class Partition:
    """Cells of a footprint, and the planes on top of them."""

    cells: Subdivision  #: The cells; those outside the footprint too
    label: np.ndarray  #: (cells,): plane of each cell, -1 outside of the footprint
    coefficients: np.ndarray  #: (m, 3): the planes z = a x + b y + c
    cost: np.ndarray = field(repr=False)  #: (cells, m): what each plane costs in each cell, m² that are not explained

    def above(self, xyz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the heights (n,), m, of points (n, 3) above planes, NaN outside, and the planes over or under them."""
        plane = np.full(len(xyz), -1)
        for cell in np.flatnonzero(self.label >= 0):
            plane[self.cells.members[cell]] = self.label[cell]
        a, b, c = self.coefficients[plane].T
        return np.where(plane >= 0, xyz[:, 2] - a * xyz[:, 0] - b * xyz[:, 1] - c, np.nan), plane


def inside_rings(xy: np.ndarray, rings: list) -> np.ndarray:
    """Return the mask of positions (n, 2) in a polygon."""
    return are_within(xy, sides_of_rings(rings))


def cells_inside(rings: list, size: float) -> np.ndarray:
    """Return columns and rows (k, 2), from zero, of the cells of a size (m) whose middles lie in a footprint."""
    low, high = (np.floor(end / size).astype(int) for end in (rings[0].min(axis=0), rings[0].max(axis=0)))
    cells = low + np.indices(high - low + 1).reshape(2, -1).T
    return cells[inside_rings((cells + 0.5) * size, rings)]


def covered_share(rings: list, xyz: np.ndarray, spacing: float) -> float:
    """Return the share of a footprint with points (n, 2 or 3), m: of its cells, two point spacings wide."""
    cells = cells_inside(rings, 2 * spacing)
    used = set(map(tuple, np.floor(xyz[:, :2] / (2 * spacing)).astype(int).tolist()))
    return float(np.mean([tuple(cell) in used for cell in cells.tolist()])) if len(cells) else np.nan


def empty_partition(rings: list, xy: np.ndarray) -> tuple[Subdivision, np.ndarray]:
    """Return cells, with the points ``xy`` in them, and which of them lie inside a footprint."""
    every = np.concatenate(rings)
    low, high = every.min(axis=0) - 1.0, every.max(axis=0) + 1.0
    cells = Subdivision(low, high, xy)
    pieces = sides_of_rings(rings)
    length = np.hypot(*(pieces[:, 1] - pieces[:, 0]).T)
    for start, end in pieces[np.argsort(-length, kind="stable")]:
        cells.cut(start, end, ON_OUTLINE)
    cells.close_tips(_TIP)
    inside = are_inside(cells, rings)
    cells.close(~inside)
    return cells, inside


def are_inside(cells: Subdivision, rings: list) -> np.ndarray:
    """Return the mask of cells inside a footprint; very narrow ones as the neighbor along their longest edge.

    Lines along a facade that are nearly in line leave wedges of millimeters between each other.
    """
    is_rim = cells.is_on_rim()
    inside = inside_rings(cells.centers(), rings) & ~is_rim
    for cell in np.flatnonzero((_mean_widths(cells) < _WEDGE) & ~is_rim):
        loop = cells.loops[cell]
        edges = [(v, u) for u, v in zip(loop, [*loop[1:], loop[0]]) if (v, u) in cells.cell_of]
        longest = max(edges, key=lambda edge: (math.dist(*(cells.vertices[v] for v in edge)), edge))
        inside[cell] = inside[cells.cell_of[longest]]
    return inside


def _mean_widths(cells: Subdivision) -> np.ndarray:
    """Return the mean widths (cells,), m: twice the areas over the perimeters."""
    positions = np.array(cells.vertices)
    width = np.zeros(len(cells))
    for cell, area in enumerate(cells.areas()):
        corner = positions[cells.loops[cell]]
        width[cell] = 2 * area / np.hypot(*(corner - np.roll(corner, 1, axis=0)).T).sum()
    return width


def divide_footprint(
    xyz: np.ndarray, is_top: np.ndarray, planes: RoofPlanes, rings: list, spacing: float, tolerance: float, base: float
) -> Partition:
    """Divide a footprint among roof planes so that points and borders cost least.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points over the footprint (m), relative to a position nearby.
    is_top : ndarray of shape (n,), bool
        Which of them have no higher point next to them.
    planes : RoofPlanes
        Their planes, at least one.
    rings : list of ndarray
        The footprint.
    spacing, tolerance : float
        Mean distance of neighboring points, and the one at which a point lies on a plane (m).
    base : float
        Height of the ground (m).

    Returns
    -------
    Partition
        The cells, each with its plane.
    """
    cells, _ = empty_partition(rings, xyz[:, :2])
    for piece in find_roof_lines(xyz, planes, rings, spacing):
        cells.cut(piece.start, piece.end, SNAP)
    used = np.flatnonzero(are_inside(cells, rings))
    cost = np.zeros((len(cells), len(planes)))
    # Each point stands for an area.
    cost[used] = spacing**2 * _unexplained(xyz, is_top, planes, cells, used, tolerance)
    cost[used] += _forbidden(planes, cells, used, xyz, base)
    label = placed(_labels(planes, cells, used, cost[used]), used, len(cells), -1)
    return Partition(cells, label, planes.coefficients, cost)


def _labels(planes: RoofPlanes, cells: Subdivision, used: np.ndarray, cost: np.ndarray) -> np.ndarray:
    """Return the plane of each of the cells ``used``."""
    number = placed(np.arange(len(used)), used, len(cells), -1)
    ends, beside = cells.edges()
    beside = number[beside]
    between = (beside >= 0).all(axis=1)
    ends, beside = ends[between], beside[between]
    positions = np.array(cells.vertices)
    length = np.hypot(*(positions[ends[:, 0]] - positions[ends[:, 1]]).T)
    heights = [planes.coefficients[:, :2] @ positions[ends[:, k]].T + planes.coefficients[:, 2:] for k in (0, 1)]

    def border(one: np.ndarray, other: np.ndarray, rows: np.ndarray) -> np.ndarray:
        step = sum(np.minimum(np.abs(height[one, rows] - height[other, rows]), FARTHEST) for height in heights) / 2
        return length[rows] * np.where(one == other, 0.0, _BORDER + _STEP * step)

    at_most = np.bincount(beside.ravel(), np.repeat(length, 2) * (_BORDER + _STEP * FARTHEST), len(used))
    return cheapest_labels(cost, beside, border, at_most, np.argmin(cost, axis=1))


def _unexplained(
    xyz: np.ndarray, is_top: np.ndarray, planes: RoofPlanes, cells: Subdivision, used: np.ndarray, tolerance: float
) -> np.ndarray:
    """Return the number of points of each cell (len(used), m) that each plane leaves unexplained, by their shares."""
    on_plane = planes.label >= 0
    cell = np.full(len(xyz), -1)
    for number, c in enumerate(used):
        cell[cells.members[c]] = number
    counted = np.flatnonzero((on_plane | is_top) & (cell >= 0))
    found = np.zeros((len(used), len(planes)))
    for plane in range(len(planes)):
        off = np.abs(xyz[counted, 2] - planes.height(plane, xyz[counted, :2])) * planes.cosine[plane]
        share = on_plane[counted] * np.minimum(off / (_FAR_OFF * tolerance), 1.0) ** 2
        share += _FAR_WEIGHT * np.minimum(off / FARTHEST, 1.0) ** 2
        found[:, plane] = np.bincount(cell[counted], share, len(used))
    return found


def _forbidden(planes: RoofPlanes, cells: Subdivision, used: np.ndarray, xyz: np.ndarray, base: float) -> np.ndarray:
    """Return a charge (len(used), m) for planes that within a cell are too near the ground or too far below points."""
    low = max(base + _LEAST_HEIGHT, float(xyz[planes.label >= 0, 2].min()) - _BELOW_POINTS)
    size = np.array([len(cells.loops[cell]) for cell in used])
    xy = np.array(cells.vertices)[np.concatenate([cells.loops[cell] for cell in used])]
    z = xy @ planes.coefficients[:, :2].T + planes.coefficients[:, 2]
    return FORBIDDEN * np.logical_or.reduceat(z < low, np.cumsum(size) - size, axis=0)
