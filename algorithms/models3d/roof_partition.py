"""The footprint of a building divided among the planes of its roof."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..facades.facade_outline import inside_ring
from ..geometry.subdivision import SNAP, Subdivision
from ..packages import spatial
from .labelling import cheapest_labels
from .roof_lines import find_roof_lines
from .roof_planes import RoofPlanes

# The footprint itself is kept to this, m.
_SNAP_OUTLINE = 0.005

# A point off a plane by this many tolerances explains nothing more; farther ones count the same.
_FAR_OFF = 2.0

# A meter of border between two planes costs as much as this area (m²) of roof that no plane explains, and so does a
# square meter of the wall between them, up to a step of 1 m. A dormer of 1.5 m by 1.5 m has 6 m of border.
_BORDER, _STEP, _MOST_STEP = 0.10, 0.05, 1.0

# Places farther from the points of planes (spacings) than this are gaps; what the nearest point tells of them counts
# for this share of their area.
_GAP_SPACINGS, _GAP_WEIGHT = 2.0, 0.3

# Roofs end no lower over the ground (m), and reach no farther (m) beyond the heights of their points. A plane that
# leaves these limits within a cell is charged with more than any cell's points could.
_LEAST_HEIGHT, _BEYOND_POINTS, _FORBIDDEN = 0.5, 1.5, 3.0

# Cells of the grid on which gaps are looked for, m.
_GAP_CELL = 0.5


@dataclass
class Partition:
    """Cells of a footprint, and what is on top of them.

    Attributes
    ----------
    cells : Subdivision
        The cells; those beside the footprint too.
    label : ndarray of shape (cells,)
        Plane of each cell, -1 outside of the footprint.
    coefficients : ndarray of shape (m, 3)
        The planes z = a x + b y + c.
    cost : ndarray of shape (cells, m)
        What each plane costs in each cell, m² that are not explained.
    """

    cells: Subdivision
    label: np.ndarray
    coefficients: np.ndarray
    cost: np.ndarray = field(repr=False)


def inside_rings(xy: np.ndarray, rings: list) -> np.ndarray:
    """Return which places (n, 2) a polygon holds."""
    inside = np.zeros(len(xy), bool)
    for ring in rings:
        inside ^= inside_ring(xy, ring)
    return inside


def empty_partition(rings: list, xy: np.ndarray) -> tuple[Subdivision, np.ndarray]:
    """Return cells, with the points ``xy`` in them, and which of them lie inside a footprint."""
    every = np.concatenate(rings)
    low, high = every.min(axis=0) - 1.0, every.max(axis=0) + 1.0
    cells = Subdivision(low, high, xy)
    pieces = np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])
    length = np.hypot(*(pieces[:, 1] - pieces[:, 0]).T)
    for start, end in pieces[np.argsort(-length, kind="stable")]:
        cells.cut(start, end, _SNAP_OUTLINE)
    inside = inside_rings(cells.centers(), rings) & ~cells.touch_rectangle()
    cells.close(~inside)
    return cells, inside


def divide_footprint(
    xyz: np.ndarray, planes: RoofPlanes, rings: list, spacing: float, tolerance: float, base: float
) -> Partition:
    """Divide a footprint among roof planes so that points and borders cost least.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points over the footprint (m), relative to a place nearby.
    planes : RoofPlanes
        Their planes, at least one.
    rings : list of ndarray
        The footprint.
    spacing, tolerance : float
        Mean distance of neighboring points, and the one at which a point lies on a plane (m).
    base : float
        Height of the ground (m).
    """
    cells, _ = empty_partition(rings, xyz[:, :2])
    for piece in find_roof_lines(xyz, planes, rings, spacing):
        cells.cut(piece.start, piece.end, SNAP)
    inside = inside_rings(cells.centers(), rings) & ~cells.touch_rectangle()
    used = np.flatnonzero(inside)
    cost = np.zeros((len(cells), len(planes)))
    cost[used] = _costs(xyz, planes, cells, used, spacing, tolerance) + _forbidden(planes, cells, used, xyz, base)
    label = np.full(len(cells), -1)
    label[used] = _labels(planes, cells, used, cost[used])
    return Partition(cells, label, planes.coefficients, cost)


def _labels(planes: RoofPlanes, cells: Subdivision, used: np.ndarray, cost: np.ndarray) -> np.ndarray:
    """Return the plane of each of the cells ``used``."""
    number = np.full(len(cells), -1)
    number[used] = np.arange(len(used))
    ends, beside = cells.edges()
    beside = number[beside]
    between = (beside >= 0).all(axis=1)
    ends, beside = ends[between], beside[between]
    places = np.array(cells.vertices)
    length = np.hypot(*(places[ends[:, 0]] - places[ends[:, 1]]).T)
    heights = [planes.coefficients[:, :2] @ places[ends[:, k]].T + planes.coefficients[:, 2:] for k in (0, 1)]
    rows = np.arange(len(ends))

    def border(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        step = sum(np.minimum(np.abs(height[one, rows] - height[other, rows]), _MOST_STEP) for height in heights) / 2
        return length * np.where(one == other, 0.0, _BORDER + _STEP * step)

    at_most = np.bincount(beside.ravel(), np.repeat(length, 2) * (_BORDER + _STEP * _MOST_STEP), len(used))
    return cheapest_labels(cost, beside, border, at_most, np.argmin(cost, axis=1))


def _costs(
    xyz: np.ndarray, planes: RoofPlanes, cells: Subdivision, used: np.ndarray, spacing: float, tolerance: float
) -> np.ndarray:
    """Return the area (m²) of each cell (len(used), m) that each plane leaves unexplained."""
    on_plane = planes.label >= 0
    cell = np.full(len(xyz), -1)
    for number, c in enumerate(used):
        cell[cells.members[c]] = number
    counted = np.flatnonzero(on_plane & (cell >= 0))
    cost = np.zeros((len(used), len(planes)))
    if not len(counted):
        return cost
    place, nearest = _gaps(xyz[counted], cells, used, spacing)
    sample = np.concatenate([counted, counted[nearest]])
    of_cell = np.concatenate([cell[counted], place])
    weight = np.full(len(sample), spacing**2)
    weight[len(counted) :] = _GAP_WEIGHT * _GAP_CELL**2
    # Of a gap its nearest point tells the plane, not the height.
    for plane in range(len(planes)):
        off = np.abs(xyz[sample, 2] - planes.height(plane, xyz[sample, :2])) * planes.cosine[plane] / tolerance
        share = np.minimum(off / _FAR_OFF, 1.0) ** 2
        cost[:, plane] = np.bincount(of_cell, weight * share, len(used))
    return cost


def _gaps(xyz: np.ndarray, cells: Subdivision, used: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the cell of each sample of gaps, numbered as in ``used``, and the nearest of the points ``xyz``."""
    tree = spatial.cKDTree(xyz[:, :2])
    places, of_cell = [], []
    for number, c in enumerate(used):
        corners = np.array([cells.vertices[v] for v in cells.loops[c]])
        if len(cells.members[c]) * spacing**2 > 0.5 * cells.area(cells.loops[c]):
            continue
        inside = _lattice_in(corners)
        places.append(inside)
        of_cell.append(np.full(len(inside), number))
    if not places:
        return np.zeros(0, int), np.zeros(0, int)
    xy, of = np.concatenate(places), np.concatenate(of_cell)
    distance, nearest = tree.query(xy)
    far = distance > _GAP_SPACINGS * spacing
    return of[far], nearest[far]


def _lattice_in(corners: np.ndarray) -> np.ndarray:
    """Return the places (k, 2) of a lattice in a convex cell."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    axes = [np.arange(np.ceil(a / _GAP_CELL), np.floor(b / _GAP_CELL) + 1) * _GAP_CELL for a, b in zip(low, high)]
    xy = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    edge = np.roll(corners, -1, axis=0) - corners
    left = edge[:, 0] * (xy[:, 1:] - corners[:, 1]) - edge[:, 1] * (xy[:, :1] - corners[:, 0])
    return xy[(left >= -1e-9).all(axis=1)]


def _forbidden(planes: RoofPlanes, cells: Subdivision, used: np.ndarray, xyz: np.ndarray, base: float) -> np.ndarray:
    """Return a charge (len(used), m) for planes that reach into the ground or into the sky within a cell."""
    on_plane = planes.label >= 0
    low = max(base + _LEAST_HEIGHT, float(xyz[on_plane, 2].min()) - _BEYOND_POINTS)
    high = float(xyz[on_plane, 2].max()) + _BEYOND_POINTS
    charge = np.zeros((len(used), len(planes)))
    for number, c in enumerate(used):
        corners = np.array([cells.vertices[v] for v in cells.loops[c]])
        z = corners @ planes.coefficients[:, :2].T + planes.coefficients[:, 2]
        beyond = (z < low).any(axis=0) | (z > high).any(axis=0)
        charge[number, beyond] = 1.0 + _FORBIDDEN * cells.area(cells.loops[c])
    return charge
