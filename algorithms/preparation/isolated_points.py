"""Isolated points: those in the air over the scene, and those under its ground.

Both are recognized by physics rather than by numbers of points: solid objects are supported from below, and a laser
pulse does not pass the ground. The points of a plume or a flock are few among all points of a column of air, since most
pulses pass it; those of a roof or a crown are most of them, whether or not its walls or its trunk were seen.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.grid import Grid, connected_cells, distinct, find_cells, fixed_grid_over, plan_box
from ..geometry.groups import components, ordered
from ..packages import spatial
from ..stage import Monitor

# Largest distance (m) between points of one object: chimneys and structures on roofs are lower, points along masts and
# wires closer.
_LINK = 2.4

# The same in point spacings, where that is more: of points at random hardly any has none within it.
_LINK_SPACINGS = 3.5

# Share of the pulses that an object stops, below which it is not solid.
_SOLID_SHARE = 0.3

# Side (point spacings) of the columns in which this share is measured: 16 points of the scene in each.
_SHARE_SPACINGS = 4.0

# Points that a column counts as having at least: those that the edge of the cloud cuts count as half full.
_LEAST_IN_COLUMN = 8

# Size (m) up to which three points or more are the head of a lamp: birds are farther apart.
_COMPACT = 1.0

# The same in point spacings, where that is more.
_COMPACT_SPACINGS = 1.5

# Largest standard deviation (m) of points across a plane: roofs of glass are no thicker.
_THIN = 0.3

# Largest standard deviation across a plane or a line, as a share of that along it.
_THIN_RATIO = 0.1

# Wires in bundles are lines in small neighborhoods only: share of the points whose neighbors must lie along a line.
_BUNDLE_SHARE = 0.5

# Points of these neighborhoods.
_BUNDLE_NEIGHBORS = 8

# Largest variance of a neighborhood across its line, as a share of that along it.
_BUNDLE_RATIO = 0.1

# Fewest points near one line that show a wire of which little is seen.
_TUBE_POINTS = 5

# Largest distance (m) of these from the line, sideways.
_TUBE_ACROSS = 0.35

# Largest distance (m) of these from the line, up and down: wires sag.
_TUBE_UP = 0.6

# Least length (m) along the line over which they are spread.
_TUBE_LENGTH = 12.0

# Nearest points of each point through which lines are tried.
_TUBE_NEIGHBORS = 24

# Least distance (m) between the two points of a line: between nearer ones its direction is chance.
_TUBE_NEAREST = 1.0

# Largest distance (m) between the two points of a line.
_TUBE_REACH = 16.0

# Depth (m) under the ground down to which points are those of grass, ruts and the noise of the scanner.
_DEPTH = 0.45

# The same in point spacings, where that is more.
_DEPTH_SPACINGS = 0.4

# Side (point spacings) of the cells that show the ground close by: four points in each, the lowest of which is its
# level.
_CLOSE_SPACINGS = 2.0

# Side (m) of the cells that show the ground of the surroundings: some of it is seen in each, even among trees.
_AROUND = 10.0

# The same in point spacings, where that is more.
_AROUND_SPACINGS = 16.0

# Share of the points of such a cell that may lie below its level; where more lie below it, they are ground.
_AROUND_PART = 0.02

# Largest step (m) between neighboring cells of ground and roofs; crowns have larger ones.
_SMOOTH = 0.3

# Largest height (m) of a smooth surface above the ground of the surroundings with which it is ground itself.
_ON_GROUND = 0.5

# Largest depth (m) at which a point is under such a surface; deeper ones are beside it.
_SHALLOW = 2.0

# Rounds in which low points are searched for: those that are found hide others beneath the surface that they pull down.
_ROUNDS = 3

# Other points in a flat disk around a point that make it part of a surface: ground seen here and there between leaves.
_SUPPORT_POINTS = 3

# Half the height (m) of this disk.
_SUPPORT_HEIGHT = 0.3

# Radius of this disk in point spacings. A wider one would reach from a point under a slope to where the slope is as
# low.
_SUPPORT_SPACINGS = 2.5

# Radius (m) of this disk in dense clouds.
_SUPPORT_REACH = 1.25

# Largest radius of this disk in dense clouds, in point spacings.
_SUPPORT_MOST_SPACINGS = 5.0

# Fewest points that are a floor and no low noise, if they are also enough by the share or the cells that follow.
_FLOOR_POINTS = 5

# Share of all points in their cells from which they are a floor.
_FLOOR_SHARE = 0.5

# Cells side by side, of more of which they are a trench.
_FLOOR_CELLS = 8

# Cells at once, so that memory stays small.
_CHUNK = 50_000


def link_length(spacing: float) -> float:
    """Return up to which distance (m) points belong to one thing."""
    return max(_LINK, _LINK_SPACINGS * spacing)


def add_isolated(points: np.ndarray, is_low: np.ndarray, is_high: np.ndarray, spacing: float, monitor: Monitor) -> None:
    """Add the isolated points among the others to those that are low or high noise, in place.

    Parameters
    ----------
    points : ndarray of shape (n, 3)
        Coordinates (m).
    is_low, is_high : ndarray of shape (n,), bool
        Points that are noise already; they are not looked at.
    spacing : float
        Point spacing (m).
    monitor : Monitor
        Receives progress.
    """
    rest = np.flatnonzero(~(is_low | is_high))
    hanging = in_the_air(points[rest], spacing, monitor.part(0.0, 0.4))
    is_high[rest[hanging]] = True
    rest = rest[~hanging]
    is_low[rest[under_ground(points[rest], spacing, monitor.part(0.4, 1.0))]] = True


def in_the_air(xyz: np.ndarray, spacing: float, monitor: Monitor) -> np.ndarray:
    """Return which points (n,) are loose things in the open air, apart from the scene below them.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    spacing : float
        Point spacing (m).
    monitor : Monitor
        Receives progress.
    """
    link = link_length(spacing)
    thing = _things(xyz, link)
    is_loose = (_loose(xyz, thing, spacing, monitor) & ~_is_cut(xyz, thing, link))[thing]
    rows = np.flatnonzero(is_loose)
    rows = rows[_is_open(xyz, is_loose, rows, link)]
    rows = rows[~_on_wires(xyz[rows])]
    found = np.zeros(len(xyz), bool)
    found[rows] = True
    return found


def _things(xyz: np.ndarray, link: float) -> np.ndarray:
    """Return the thing (n,) that each point belongs to, from 0: occupied voxels of side ``link`` that touch."""
    steps = [np.floor((axis - axis.min()) / link).astype(np.int32) + 1 for axis in xyz.T]
    shape = [int(step.max()) + 2 for step in steps]
    number = (steps[2].astype(np.int64) * shape[1] + steps[1]) * shape[0] + steps[0]
    del steps
    voxels, voxel = distinct(number)
    del number
    here, there = [], []
    for up, north, east in np.ndindex(3, 3, 3):
        step = ((up - 1) * shape[1] + north - 1) * shape[0] + east - 1
        if step > 0:
            beside, found = find_cells(voxels, voxels + step)
            here.append(np.flatnonzero(found))
            there.append(beside[found])
    return components(np.concatenate(here), np.concatenate(there), len(voxels))[1][voxel]


def _loose(xyz: np.ndarray, thing: np.ndarray, spacing: float, monitor: Monitor) -> np.ndarray:
    """Return which things let most pulses pass and are neither compact, nor lines, nor planes."""
    n_points = np.bincount(thing)
    small = np.flatnonzero((n_points < n_points.max())[thing])
    cell = fixed_grid_over(xyz, _SHARE_SPACINGS * spacing).number(xyz)
    cells, which = distinct(cell)
    in_cell = np.bincount(which)
    pairs = np.unique(thing[small].astype(np.int64) * len(cells) + which[small])
    in_columns = np.bincount(
        pairs // len(cells), np.maximum(in_cell[pairs % len(cells)], _LEAST_IN_COLUMN), len(n_points)
    )
    is_loose = (in_columns > 0) & (n_points < _SOLID_SHARE * in_columns)

    order = small[np.argsort(thing[small], kind="stable")]
    ends = np.searchsorted(thing[order], np.arange(len(n_points) + 1))
    for number in np.flatnonzero(is_loose & (n_points >= 3)).tolist():
        points = xyz[order[ends[number] : ends[number + 1]]]
        is_loose[number] = not _has_form(points, max(_COMPACT, _COMPACT_SPACINGS * spacing))
        monitor.progress(0.5)
    return is_loose


def _is_cut(xyz: np.ndarray, thing: np.ndarray, link: float) -> np.ndarray:
    """Return which things of three points or more reach the border of the cloud: they may be parts of larger ones."""
    low, high = plan_box(xyz)
    x, y = xyz[:, 0], xyz[:, 1]
    is_outer = (x < low[0] + link) | (x > high[0] - link) | (y < low[1] + link) | (y > high[1] - link)
    return (np.bincount(thing, is_outer) > 0) & (np.bincount(thing) >= 3)


def _has_form(points: np.ndarray, compact: float) -> bool:
    """Return whether points fill a small place, or lie along lines or in a plane."""
    if (np.ptp(points, axis=0) <= compact).all():
        return True
    if len(points) < _TUBE_POINTS:
        return False
    deviation = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(points.T)), 0))
    is_line = deviation[1] <= _THIN_RATIO * deviation[2]
    is_plane = len(points) >= 2 * _TUBE_POINTS and deviation[0] <= min(_THIN, _THIN_RATIO * deviation[1])
    return bool(is_line or is_plane or _share_of_lines(points) > _BUNDLE_SHARE)


def _share_of_lines(points: np.ndarray) -> float:
    """Return the share of points whose nearest ones lie along a line, as those of bundled wires do."""
    near = points[spatial.cKDTree(points).query(points, min(_BUNDLE_NEIGHBORS, len(points)))[1]]
    near -= near.mean(axis=1, keepdims=True)
    eigenvalues = np.linalg.eigvalsh(np.einsum("nki,nkj->nij", near, near))
    return float((eigenvalues[:, 1] < _BUNDLE_RATIO * eigenvalues[:, 2]).mean())


def _is_open(xyz: np.ndarray, is_loose: np.ndarray, rows: np.ndarray, link: float) -> np.ndarray:
    """Return which rows have the scene, all that isn't loose, below them and nothing of it above, close by in plan."""
    if not len(rows) or is_loose.all():
        return np.zeros(len(rows), bool)
    grid = fixed_grid_over(xyz, link / 2)
    cells, which = distinct(grid.number(xyz))
    scene = np.flatnonzero(_mask(len(cells), _near(grid, cells, which[rows]))[which] & ~is_loose)
    top = np.full(len(cells), -np.inf)
    np.maximum.at(top, which[scene], xyz[scene, 2])
    highest = np.full(len(rows), -np.inf)
    for step in (0, *grid.around):
        beside, found = find_cells(cells, cells[which[rows]] + step)
        highest = np.maximum(highest, np.where(found, top[beside], -np.inf))
    return np.isfinite(highest) & (xyz[rows, 2] > highest)


def _mask(length: int, places: np.ndarray) -> np.ndarray:
    """Return a mask (length,) that is true at some places."""
    mask = np.zeros(length, bool)
    mask[places] = True
    return mask


def _on_wires(points: np.ndarray) -> np.ndarray:
    """Return which of few points lie in a line with others, as the points of wires do that a scanner rarely hits."""
    on_wire = np.zeros(len(points), bool)
    if len(points) < _TUBE_POINTS:
        return on_wire
    count = min(_TUBE_NEIGHBORS, len(points))
    distance, near = spatial.cKDTree(points).query(points, count, distance_upper_bound=_TUBE_REACH)
    # Missing neighbors stand at infinity.
    places = np.concatenate([points, np.full((1, 3), np.inf)])
    for row in np.flatnonzero(np.isfinite(distance).sum(axis=1) >= _TUBE_POINTS).tolist():
        others = near[row][np.isfinite(distance[row])]
        off = places[others] - points[row]
        along = off[1:, :2]
        length = np.linalg.norm(along, axis=1)
        usable = length > _TUBE_NEAREST
        along, rise = along[usable] / length[usable, None], off[1:, 2][usable] / length[usable]
        at = along @ off[:, :2].T
        across = np.abs(along[:, :1] * off[:, 1] - along[:, 1:] * off[:, 0])
        inside = (across <= _TUBE_ACROSS) & (np.abs(off[:, 2] - rise[:, None] * at) <= _TUBE_UP)
        reach = np.where(inside, at, -np.inf).max(axis=1) - np.where(inside, at, np.inf).min(axis=1)
        for line in np.flatnonzero((inside.sum(axis=1) >= _TUBE_POINTS) & (reach >= _TUBE_LENGTH)):
            on_wire[others[inside[line]]] = True
    return on_wire


def under_ground(xyz: np.ndarray, spacing: float, monitor: Monitor) -> np.ndarray:
    """Return which points (n,) lie under the ground, alone or few together.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    spacing : float
        Point spacing (m).
    monitor : Monitor
        Receives progress.
    """
    grid = fixed_grid_over(xyz, _CLOSE_SPACINGS * spacing)
    cells, which = distinct(grid.number(xyz))
    order = _by_cell_and_height(which, xyz)
    n_points = np.bincount(which)
    start = np.cumsum(n_points) - n_points
    middle = xyz[order[start + n_points // 2]]
    size = max(_AROUND, _AROUND_SPACINGS * spacing)
    depth = max(_DEPTH, _DEPTH_SPACINGS * spacing)

    found, n_found = np.zeros(len(xyz), bool), np.zeros(len(cells), np.int64)
    near = np.arange(len(cells))
    for turn in range(_ROUNDS):
        # Without the points found before, which are the lowest of their cells, their companions stand out.
        lowest = xyz[order[start + np.minimum(n_found, n_points - 1)]]
        lowest[n_found == n_points] = np.nan
        # Below the surface close by, below the ground around, and not beside others of the same height.
        surface = _close_surface(grid, cells, lowest, middle, near)
        rows = _deep(xyz, which, np.flatnonzero(_mask(len(cells), near)[which] & ~found), surface, depth)
        around = _surroundings(lowest[n_found < n_points], xyz[rows], size)
        close, is_smooth = surface.at(xyz, rows, which), surface.is_smooth[which[rows]]
        rows = rows[_is_under(xyz[rows, 2], close, is_smooth, around, depth)]
        near = _near(grid, cells, which[rows])
        rows = rows[~_is_supported(xyz, rows, _mask(len(cells), near)[which], spacing)]
        monitor.progress((turn + 1) / _ROUNDS)
        if not len(rows):
            break
        found[rows] = True
        low = np.flatnonzero(found)
        found[low[_is_floor(grid, cells, which[low], n_points)]] = False
        n_found = np.bincount(which[found], minlength=len(cells))
        near = _near(grid, cells, which[rows])
    return found


def _by_cell_and_height(which: np.ndarray, xyz: np.ndarray) -> np.ndarray:
    """Return the rows (n,) in the order of cells, those of a cell from the lowest up, of equal ones from the west."""
    x, y, z = xyz.T
    # One number for both sorts three times as fast; heights count to a part in two thousand million of their range.
    key = which.astype(np.int64) << 32
    key |= ((z - z.min()) * ((2**31 - 1) / max(float(np.ptp(z)), 1e-9))).astype(np.int64)
    return ordered(key, x, y)


def _deep(xyz: np.ndarray, which: np.ndarray, rows: np.ndarray, surface: _Surface, depth: float) -> np.ndarray:
    """Return those of the rows that lie more than ``depth`` (m) below the surface, or where it is not known."""
    parts = [rows[start : start + _CHUNK] for start in range(0, len(rows), _CHUNK)]
    return np.concatenate(
        [rows[:0], *(part[~(xyz[part, 2] >= surface.at(xyz, part, which) - depth)] for part in parts)]
    )


def _near(grid: Grid, cells: np.ndarray, which: np.ndarray) -> np.ndarray:
    """Return the places in ``cells`` of some cells and those around them, ascending."""
    at, is_cell = find_cells(cells, (cells[np.unique(which)][:, None] + [0, *grid.around]).ravel())
    return np.unique(at[is_cell])


def _is_supported(xyz: np.ndarray, rows: np.ndarray, is_near: np.ndarray, spacing: float) -> np.ndarray:
    """Return which points have others close by at their own height: ground seen between leaves or walls.

    Echoes that took a detour come at all depths, those of the ground agree to centimeters.
    """
    if not len(rows):
        return np.zeros(0, bool)
    radius = max(_SUPPORT_SPACINGS * spacing, min(_SUPPORT_MOST_SPACINGS * spacing, _SUPPORT_REACH))
    # Heights are stretched so that the neighborhood is a flat disk.
    stretch = np.array([1.0, 1.0, radius / _SUPPORT_HEIGHT])
    tree = spatial.cKDTree(xyz[is_near] * stretch)
    distance = tree.query(xyz[rows] * stretch, _SUPPORT_POINTS + 1)[0]
    return distance[:, -1] <= radius


def _is_under(z: np.ndarray, close: np.ndarray, is_smooth: np.ndarray, around: np.ndarray, depth: float) -> np.ndarray:
    """Return which elevations (m) below the surface close by are below the ground, too."""
    # Among crowns, walls and water the ground may be anywhere down to where it is seen to be, and as much lower again.
    unsure = np.where(is_smooth, around[:, 1], 2 * around[:, 0] - around[:, 2])
    is_on_ground = is_smooth & (close <= around[:, 1] + _ON_GROUND)
    return (z < unsure - depth) | (is_on_ground & (z >= close - _SHALLOW))


@dataclass(frozen=True)
class _Surface:
    """The lowest surface around each cell: a plane through ``origin`` with a slope, and whether neighbors agree.

    ``origin`` (m, 3) has NaN where the surface is not known; ``slope`` is (m, 2), ``is_smooth`` (m,).
    """

    origin: np.ndarray
    slope: np.ndarray
    is_smooth: np.ndarray

    def at(self, xyz: np.ndarray, rows: np.ndarray, which: np.ndarray) -> np.ndarray:
        """Return the elevation (m) of the surface at some points, ``which`` is the cell of each point."""
        cell = which[rows]
        off = xyz[rows, :2] - self.origin[cell, :2]
        return self.origin[cell, 2] + np.einsum("ij,ij->i", self.slope[cell], off)


def _close_surface(
    grid: Grid, cells: np.ndarray, lowest: np.ndarray, middle: np.ndarray, wanted: np.ndarray
) -> _Surface:
    """Return the lowest surface around the ``wanted`` cells (places in ``cells``).

    ``lowest`` and ``middle`` are the points of each cell at these ranks in height. Up to three neighbors may hold
    companions of a low point; most points of such a cell are on the surface, though, unlike those of a cell
    beyond an edge or farther along a ditch.
    """
    origin, slope, is_smooth = np.full((len(cells), 3), np.nan), np.zeros((len(cells), 2)), np.zeros(len(cells), bool)
    for start in range(0, len(wanted), _CHUNK):
        part = wanted[start : start + _CHUNK]
        around = [find_cells(cells, cells[part] + step) for step in grid.around]
        beside = _beside(around, lowest, middle[part])
        slope[part] = _slope(beside)
        low = _flattened(beside, slope[part])
        mid = _flattened(_beside(around, middle, middle[part]), slope[part])
        smooth = low[:, 4:] - low[:, :4] <= _SMOOTH
        is_smooth[part] = smooth.any(axis=1)
        base = np.take_along_axis(low, np.argmax(smooth, axis=1)[:, None], axis=1)[:, 0]
        rough = low[:, 1] - (low[:, 3] - low[:, 1])
        origin[part, :2] = middle[part, :2]
        origin[part, 2] = np.minimum(np.where(is_smooth[part], base, rough), mid[:, 0])
    return _Surface(origin, slope, is_smooth)


def _surroundings(levels: np.ndarray, points: np.ndarray, size: float) -> np.ndarray:
    """Return elevations (m) of the ground in the eight cells of ``size`` (m) around points (m, 8), ascending."""
    grid = fixed_grid_over(levels, size)
    cells, which = distinct(grid.number(levels))
    order = _by_cell_and_height(which, levels)
    count = np.bincount(which)
    start = np.cumsum(count) - count
    chosen = levels[order[start + np.floor(_AROUND_PART * count).astype(np.int64)]]
    number = grid.number(points)
    beside = _beside([find_cells(cells, number + step) for step in grid.around], chosen, points)
    return _flattened(beside, _slope(beside))


def _beside(around: list[tuple[np.ndarray, np.ndarray]], levels: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """Return the levels of the eight cells around some (m, 8, 3), NaN if none; plan from ``origin``.

    ``around`` has for each of the eight where they are in ``levels``, and which of them are there.
    """
    beside = np.full((len(origin), 8, 3), np.nan)
    for column, (at, found) in enumerate(around):
        beside[found, column] = levels[at[found]]
    beside[:, :, :2] -= origin[:, None, :2]
    return beside


def _slope(beside: np.ndarray) -> np.ndarray:
    """Return rise eastward and northward (m, 2): the middle one of those between opposite neighbors.

    So that one odd height does not change it.
    """
    west, east, south, north = ([0, 3, 5], [2, 4, 7], [0, 1, 2], [5, 6, 7])
    eastward = (beside[:, east, 2] - beside[:, west, 2]) / (beside[:, east, 0] - beside[:, west, 0])
    northward = (beside[:, north, 2] - beside[:, south, 2]) / (beside[:, north, 1] - beside[:, south, 1])
    return np.column_stack([_middle(eastward), _middle(northward)])


def _flattened(beside: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Return heights (m, 8) carried to the origin along the slope, ascending, NaN last."""
    return np.sort(beside[:, :, 2] - np.einsum("ikj,ij->ik", beside[:, :, :2], slope), axis=1)


def _middle(values: np.ndarray) -> np.ndarray:
    """Return the median (m,) of three values each, 0 where none is known."""
    values = np.sort(values, axis=1)
    known = np.isfinite(values).sum(axis=1)
    middle = np.where(known == 2, (values[:, 0] + values[:, 1]) / 2, np.where(known == 1, values[:, 0], values[:, 1]))
    return np.where(known > 0, middle, 0.0)


def _is_floor(grid: Grid, cells: np.ndarray, which: np.ndarray, n_points: np.ndarray) -> np.ndarray:
    """Return which points, in the cells ``which``, belong to a floor; ``n_points`` are all points of each cell."""
    own, inverse, count = np.unique(which, return_inverse=True, return_counts=True)
    groups, group = connected_cells(grid, cells[own])
    if not groups:
        return np.zeros(len(which), bool)
    low = np.bincount(group, count, groups)
    all_points = np.bincount(group, n_points[own], groups)
    is_trench = np.bincount(group, minlength=groups) > _FLOOR_CELLS
    is_floor = ((low >= _FLOOR_POINTS) & (low >= _FLOOR_SHARE * all_points)) | is_trench
    return is_floor[group][inverse]
