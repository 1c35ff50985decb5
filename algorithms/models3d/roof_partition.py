"""The footprint of a building divided among the planes of its roof."""

import math
from dataclasses import dataclass, field

import numpy as np

from ..criteria import MILLIMETER
from ..geometry.cheapest_labels import cheapest_labels
from ..geometry.groups import placed
from ..geometry.polygon_overlap import are_within
from ..geometry.rings import sides_of_rings
from ..geometry.subdivision import SNAP, Subdivision
from .roof_lines import find_roof_lines
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
    inside = are_inside(cells, rings)
    used = np.flatnonzero(inside)
    cost = np.zeros((len(cells), len(planes)))
    cost[used] = _costs(xyz, is_top, planes, cells, used, spacing, tolerance)
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


def _costs(
    xyz: np.ndarray,
    is_top: np.ndarray,
    planes: RoofPlanes,
    cells: Subdivision,
    used: np.ndarray,
    spacing: float,
    tolerance: float,
) -> np.ndarray:
    """Return the area (m²) of each cell (len(used), m) that each plane leaves unexplained."""
    on_plane = planes.label >= 0
    cell = np.full(len(xyz), -1)
    for number, c in enumerate(used):
        cell[cells.members[c]] = number
    counted = np.flatnonzero((on_plane | is_top) & (cell >= 0))
    cost = np.zeros((len(used), len(planes)))
    for plane in range(len(planes)):
        off = np.abs(xyz[counted, 2] - planes.height(plane, xyz[counted, :2])) * planes.cosine[plane]
        share = on_plane[counted] * np.minimum(off / (_FAR_OFF * tolerance), 1.0) ** 2
        share += _FAR_WEIGHT * np.minimum(off / FARTHEST, 1.0) ** 2
        cost[:, plane] = spacing**2 * np.bincount(cell[counted], share, len(used))
    return cost


def _forbidden(planes: RoofPlanes, cells: Subdivision, used: np.ndarray, xyz: np.ndarray, base: float) -> np.ndarray:
    """Return a charge (len(used), m) for planes that within a cell are too near the ground or too far below points."""
    low = max(base + _LEAST_HEIGHT, float(xyz[planes.label >= 0, 2].min()) - _BELOW_POINTS)
    size = np.array([len(cells.loops[cell]) for cell in used])
    xy = np.array(cells.vertices)[np.concatenate([cells.loops[cell] for cell in used])]
    z = xy @ planes.coefficients[:, :2].T + planes.coefficients[:, 2]
    return FORBIDDEN * np.logical_or.reduceat(z < low, np.cumsum(size) - size, axis=0)
