"""Points that may be on wires: high, nothing close below them, and on a line with others."""

from typing import Any

import numpy as np

from ..geometry.grid import fixed_grid_over
from ..geometry.groups import components, items, run_starts
from ..geometry.sparse_voxels import one_per_voxel
from ..packages import spatial
from ..rules import rules
from ..stage import Monitor
from ..threads import in_chunks
from .wire_spans import RULES as SPAN


@rules
class _RULES:
    """Where wires are looked for."""

    least_column: float = 1.0  #: Least side of the columns in which heights are compared, m
    column_spacings: float = 2.0  #: Least side of these columns in point spacings: those in crowns hold several points
    free: float = 3.0  #: Height (m) below a bundle of wires that holds no points: crowns hold some
    thickest: float = 1.5  #: Largest height (m) of a bundle of wires one above the other
    thinning: float = 1.0  #: Side (m) of the voxels of which one point each is looked at
    around: float = 3.0  #: Radius (m) in which other points are counted
    #: Most thinned points around one of a wire: three parallel wires have 18 in dense clouds, surfaces 28, crowns more
    most_around: int = 20
    most_trials: int = 8  #: Lines through each point that are tried
    #: gap, gap_end: Multiples of ``SPAN.aside`` from a line between which points show a surface: parallel wires are
    #: farther away
    gap: float = 1.5
    gap_end: float = 2.5
    steepest: float = 0.4  #: Steepest slope of a wire (tangent), at masts in hills
    turn: float = 8.0  #: Largest angle (°) between directions at points of one wire
    bend: float = 0.02  #: Height over the tangent of a wire that farther points may have, as a share of their distance


# Points whose neighbors are found, and lines whose points are counted at once: some hundred neighbors each.
_CHUNK = 1000


def over_free_space(xyz: np.ndarray, spacing: float) -> np.ndarray:
    """Return the rows (m,) of points (n, 3), m, in thin layers with free space below them."""
    if not len(xyz):
        return np.zeros(0, np.int64)
    column = fixed_grid_over(xyz, max(_RULES.least_column, _RULES.column_spacings * spacing)).number(xyz)
    order = np.lexsort((xyz[:, 2], column))
    z, column = xyz[order, 2], column[order]
    is_first = np.ones(len(z), bool)
    is_first[1:] = (column[1:] != column[:-1]) | (np.diff(z) > _RULES.free)
    start = np.flatnonzero(is_first)
    thickness = z[np.append(start[1:], len(z)) - 1] - z[start]
    return np.sort(order[(thickness <= _RULES.thickest)[np.cumsum(is_first) - 1]])


def thinned(xyz: np.ndarray) -> np.ndarray:
    """Return the rows (m,) of one point per voxel, of those with few others around."""
    rows = one_per_voxel(xyz, _RULES.thinning)
    count = spatial.cKDTree(xyz[rows]).query_ball_point(xyz[rows], _RULES.around, return_length=True)
    return rows[count <= _RULES.most_around]


def strands(xyz: np.ndarray, reach: float, monitor: Monitor) -> tuple[np.ndarray, np.ndarray]:
    """Return the number (n,), from 0, of the line that each point is on, -1 for none, and its direction (n, 3).

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Thinned points.
    reach : float
        Distance (m) within which points are on a line together.
    monitor : Monitor
        Receives progress.
    """
    if len(xyz) < SPAN.least_points:
        return np.full(len(xyz), -1), np.zeros((len(xyz), 3))
    # Wires run far in plan and little in height.
    stretched = xyz * [1.0, 1.0, 2.0]
    tree = spatial.cKDTree(stretched)
    count, direction = np.zeros(len(xyz), np.int64), np.zeros((len(xyz), 3))

    def look(rows: np.ndarray) -> None:
        one, other = _pairs(stretched, rows, tree, reach)
        offset = xyz[other] - xyz[rows[one]]
        count[rows], direction[rows] = _best_lines(one, offset, len(rows), reach)

    # Neighbors in plan together: their own neighbors are the same.
    in_chunks(look, np.lexsort(xyz[:, :2].T), _CHUNK, monitor)
    is_linear = count >= SPAN.least_points - 1
    linear = np.flatnonzero(is_linear)
    one, other = linear[spatial.cKDTree(stretched[linear]).query_pairs(reach, output_type="ndarray")].T
    one, other = np.concatenate([one, other]), np.concatenate([other, one])
    offset = xyz[other] - xyz[one]
    aside, off_height, along = _off_line(offset, direction[one])
    alike = np.abs((direction[one, :2] * direction[other, :2]).sum(axis=1)) > np.cos(np.radians(_RULES.turn))
    # A wire bends: farther points are higher than its tangent.
    on_line = (aside <= SPAN.aside) & (off_height <= SPAN.aside + _RULES.bend * np.abs(along)) & alike
    _, line = components(one[on_line], other[on_line], len(xyz))
    return np.where(is_linear, line, -1), direction


def _pairs(points: np.ndarray, rows: np.ndarray, tree: Any, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs of some points, by their position among ``rows``, and others up to ``reach`` (m) away, in order."""
    found = spatial.cKDTree(points[rows]).sparse_distance_matrix(tree, reach, output_type="ndarray")
    one, other = found["i"], found["j"]
    is_other = rows[one] != other
    one, other = one[is_other], other[is_other]
    order = np.lexsort((other, one))
    return one[order], other[order]


def _best_lines(one: np.ndarray, offset: np.ndarray, count: int, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Return how many neighbors (n,) are on the best line through each point, and its direction (n, 3), 1 m in plan."""
    distance, gap = np.hypot(offset[:, 0], offset[:, 1]), _RULES.gap * SPAN.aside
    # Neighbors above or below all lines count neither as on a line nor as next to one.
    near = np.abs(offset[:, 2]) <= _RULES.steepest * distance + gap
    one, offset, distance = one[near], offset[near], distance[near]
    # Nearer neighbors give the direction of a line less accurately.
    far = np.flatnonzero((distance >= reach / 3) & (np.abs(offset[:, 2]) <= _RULES.steepest * distance))
    start, size = np.searchsorted(one, np.arange(count)), np.bincount(one, minlength=count)
    # Evenly spread over the neighbors of a point.
    first, number = np.searchsorted(one[far], np.arange(count)), np.bincount(one[far], minlength=count)
    point, trial = items(np.minimum(number, _RULES.most_trials))
    tried = far[first[point] + trial * number[point] // np.minimum(number[point], _RULES.most_trials)]
    best, direction = np.zeros(count, np.int64), np.zeros((count, 3))
    for chunk in np.array_split(np.arange(len(tried)), len(tried) // _CHUNK + 1):
        rows = point[chunk]
        line = offset[tried[chunk]] / distance[tried[chunk], None]
        which, item = items(size[rows])
        aside, off_height, _ = _off_line(offset[start[rows][which] + item], line[which])
        on_line = np.bincount(which, (aside <= SPAN.aside) & (off_height <= SPAN.aside), len(rows))
        in_gap = (aside > gap) & (aside <= _RULES.gap_end * SPAN.aside) & (off_height <= gap)
        beside = np.bincount(which, in_gap, len(rows))
        score = np.where(beside <= on_line / 2, on_line - beside, 0).astype(np.int64)
        order = np.lexsort((-score, rows))
        leading = order[run_starts(rows[order])]
        leading = leading[score[leading] > best[rows[leading]]]
        best[rows[leading]], direction[rows[leading]] = score[leading], line[leading]
    return best, direction


def _off_line(offset: np.ndarray, line: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return how far offsets (m, 3) lie aside of lines (m, 3) in plan, above or below them, and along them, m."""
    along = offset[:, 0] * line[:, 0] + offset[:, 1] * line[:, 1]
    aside = np.abs(offset[:, 0] * line[:, 1] - offset[:, 1] * line[:, 0])
    return aside, np.abs(offset[:, 2] - along * line[:, 2]), along
