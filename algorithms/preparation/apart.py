"""Points that belong to nothing: what hangs in the air over the scene, and what lies under its ground.

Both are told by what a scanner can't do rather than by numbers of points: nothing solid hangs free in the air, and the
laser doesn't see through the ground. A plume or a flock lets most pulses pass, so that among the points of its
columns its own are few; a roof or a crown stops most of them, seen or not what carries it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cloud.cells import Grid, connected_cells, find_cells, grid_over
from ..packages import csgraph, sparse, spatial
from ..stage import Monitor

# Points so near to each other (m, and point spacings) are one thing: chimneys and what stands on roofs are lower,
# points along masts and wires closer.
_LINK, _LINK_SPACINGS = 2.4, 3.5
# A thing that stops a smaller share of the pulses than this is loose.
_SOLID_SHARE = 0.3
# Cells, in point spacings, whose points tell the share: 16 of the scene in each.
_SHARE_SPACINGS = 4.0
# Three points in so small a space (m, and point spacings) are the head of a lamp; birds fly farther apart.
_COMPACT, _COMPACT_SPACINGS = 1.0, 1.5
# Wires are lines, roofs of glass are planes: points so near (m) to one, per length along it.
_THIN, _THIN_RATIO = 0.3, 0.1
# A wire that gives few points: so many of them in a tube of that radius (m, across and up) over this length (m).
_TUBE_POINTS, _TUBE_ACROSS, _TUBE_UP, _TUBE_LENGTH, _TUBE_REACH = 5, 0.35, 0.6, 12.0, 16.0
_TUBE_NEIGHBORS = 24

# Depth (m) under the ground within which points are those of grass, ruts and the scanner's own noise.
_DEPTH, _DEPTH_SPACINGS = 0.45, 0.4
# Cells of the ground close by, in point spacings: four points in each, the lowest of which is its level.
_CLOSE_SPACINGS = 2.0
# Cells of the surroundings (m, and point spacings), where ground is seen even among trees, and how large a part of
# them may lie lower: more points under the ground than these are believed.
_AROUND, _AROUND_SPACINGS, _AROUND_PART = 10.0, 16.0, 0.02
# Ground and roofs are that smooth (m) from cell to cell, crowns are not; what lies no deeper (m) under a smooth surface
# is under it and not beside it.
_SMOOTH, _SHALLOW, _ON_GROUND = 0.3, 2.0, 0.5
_ROUNDS = 3
# So many others within that height (m) and distance (point spacings) make a point part of a surface.
_SUPPORT_POINTS, _SUPPORT_HEIGHT, _SUPPORT_SPACINGS = 3, 0.15, 2.5
# Cells at once, so that memory stays small.
_CHUNK = 200_000


def in_the_air(xyz: np.ndarray, spacing: float, monitor: Monitor) -> np.ndarray:
    """Return which points (n,) are loose things in the open air, apart from the scene below them.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    spacing : float
        Point spacing (m).
    """
    link = max(_LINK, _LINK_SPACINGS * spacing)
    thing = _things(xyz, link)
    is_loose = (_loose(xyz, thing, spacing, monitor) & ~_is_cut(xyz, thing, link))[thing]
    rows = np.flatnonzero(is_loose)
    rows = rows[_is_open(xyz[~is_loose], xyz[rows], link)]
    rows = rows[~_on_wires(xyz[rows])]
    found = np.zeros(len(xyz), bool)
    found[rows] = True
    return found


def _things(xyz: np.ndarray, link: float) -> np.ndarray:
    """Return the thing (n,) that each point belongs to, from 0: occupied voxels of side ``link`` that touch."""
    steps = np.floor((xyz - xyz.min(axis=0)) / link).astype(np.int64) + 1
    shape = steps.max(axis=0) + 2
    voxels, voxel = np.unique((steps[:, 2] * shape[1] + steps[:, 1]) * shape[0] + steps[:, 0], return_inverse=True)
    here, there = [], []
    for up, north, east in np.ndindex(3, 3, 3):
        step = ((up - 1) * shape[1] + north - 1) * shape[0] + east - 1
        if step > 0:
            beside, found = find_cells(voxels, voxels + step)
            here.append(np.flatnonzero(found))
            there.append(beside[found])
    rows, columns = np.concatenate(here), np.concatenate(there)
    pairs = sparse.coo_matrix((np.ones(len(rows), bool), (rows, columns)), (len(voxels), len(voxels)))
    return csgraph.connected_components(pairs, directed=False)[1][voxel]


def _loose(xyz: np.ndarray, thing: np.ndarray, spacing: float, monitor: Monitor) -> np.ndarray:
    """Return which things let most pulses pass and are neither compact, nor lines, nor planes."""
    n_points = np.bincount(thing)
    small = np.flatnonzero((n_points < n_points.max())[thing])
    cell = grid_over(xyz, _SHARE_SPACINGS * spacing).number(xyz)
    cells, which, in_cell = np.unique(cell, return_inverse=True, return_counts=True)
    pairs = np.unique(thing[small] * len(cells) + which[small])
    in_columns = np.bincount(pairs // len(cells), np.maximum(in_cell[pairs % len(cells)], 8), len(n_points))
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
    plan = xyz[:, :2]
    is_outer = ((plan < plan.min(axis=0) + link) | (plan > plan.max(axis=0) - link)).any(axis=1)
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
    return bool(is_line or is_plane or _share_of_lines(points) > 0.5)


def _share_of_lines(points: np.ndarray) -> float:
    """Return the share of points whose nearest ones lie along a line, as those of bundled wires do."""
    near = points[spatial.cKDTree(points).query(points, min(8, len(points)))[1]]
    near -= near.mean(axis=1, keepdims=True)
    eigenvalues = np.linalg.eigvalsh(np.einsum("nki,nkj->nij", near, near))
    return float((eigenvalues[:, 1] < 0.1 * eigenvalues[:, 2]).mean())


def _is_open(scene: np.ndarray, points: np.ndarray, link: float) -> np.ndarray:
    """Return which points have the scene below them and nothing of it above, close by in plan."""
    if not len(points) or not len(scene):
        return np.zeros(len(points), bool)
    grid = grid_over(np.concatenate([scene, points])[:, :2], link / 2)
    cells, which = np.unique(grid.number(scene), return_inverse=True)
    top = np.full(len(cells), -np.inf)
    np.maximum.at(top, which, scene[:, 2])
    highest = np.full(len(points), -np.inf)
    cell = grid.number(points)
    for step in (0, *grid.around):
        beside, found = find_cells(cells, cell + step)
        highest = np.maximum(highest, np.where(found, top[beside], -np.inf))
    return np.isfinite(highest) & (points[:, 2] > highest)


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
        usable = length > 1.0
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
    """
    grid = grid_over(xyz, _CLOSE_SPACINGS * spacing)
    cell = grid.number(xyz)
    order = np.lexsort((xyz[:, 2], cell))
    cells, start, n_points = np.unique(cell[order], return_index=True, return_counts=True)
    which = np.searchsorted(cells, cell)
    middle = xyz[order[start + n_points // 2]]
    size = max(_AROUND, _AROUND_SPACINGS * spacing)
    depth = max(_DEPTH, _DEPTH_SPACINGS * spacing)

    found, n_found = np.zeros(len(xyz), bool), np.zeros(len(cells), np.int64)
    rows, near = np.arange(len(xyz)), np.arange(len(cells))
    for turn in range(_ROUNDS):
        # Without the points found before, which are the lowest of their cells, their companions stand out.
        lowest = xyz[order[start + np.minimum(n_found, n_points - 1)]]
        lowest[n_found == n_points] = np.nan
        surface = _close_surface(grid, cells, lowest, middle, near)
        rows = rows[~(xyz[rows, 2] >= surface.at(xyz, rows, which) - depth)]
        around = _surroundings(lowest[n_found < n_points], xyz[rows], size)
        close, is_smooth = surface.at(xyz, rows, which), surface.is_smooth[which[rows]]
        rows = rows[_is_under(xyz[rows, 2], close, is_smooth, around, depth)]
        rows = rows[~_is_supported(xyz, rows, np.isin(which, _near(grid, cells, which[rows])), spacing)]
        monitor.progress((turn + 1) / _ROUNDS)
        if not len(rows):
            break
        found[rows] = True
        low = np.flatnonzero(found)
        found[low[_is_floor(grid, cell[low], cells, n_points)]] = False
        n_found = np.bincount(which[found], minlength=len(cells))
        near = _near(grid, cells, which[rows])
        rows = np.flatnonzero(np.isin(which, near) & ~found)
    return found


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
    # Heights are stretched so that the neighborhood is a flat disk.
    stretch = np.array([1.0, 1.0, _SUPPORT_SPACINGS * spacing / _SUPPORT_HEIGHT])
    tree = spatial.cKDTree(xyz[is_near] * stretch)
    distance = tree.query(xyz[rows] * stretch, _SUPPORT_POINTS + 1)[0]
    return distance[:, -1] <= _SUPPORT_SPACINGS * spacing


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
        beside = _beside(grid, cells, lowest, cells[part], middle[part])
        slope[part] = _slope(beside)
        low = _flattened(beside, slope[part])
        mid = _flattened(_beside(grid, cells, middle, cells[part], middle[part]), slope[part])
        smooth = low[:, 4:] - low[:, :4] <= _SMOOTH
        is_smooth[part] = smooth.any(axis=1)
        base = np.take_along_axis(low, np.argmax(smooth, axis=1)[:, None], axis=1)[:, 0]
        rough = low[:, 1] - (low[:, 3] - low[:, 1])
        origin[part, :2] = middle[part, :2]
        origin[part, 2] = np.minimum(np.where(is_smooth[part], base, rough), mid[:, 0])
    return _Surface(origin, slope, is_smooth)


def _surroundings(levels: np.ndarray, points: np.ndarray, size: float) -> np.ndarray:
    """Return elevations (m) of the ground in the eight cells of ``size`` (m) around points (m, 8), ascending."""
    grid = grid_over(levels, size)
    cell = grid.number(levels)
    order = np.lexsort((levels[:, 2], cell))
    cells, start, count = np.unique(cell[order], return_index=True, return_counts=True)
    chosen = levels[order[start + np.floor(_AROUND_PART * count).astype(np.int64)]]
    beside = _beside(grid, cells, chosen, grid.number(points), points)
    return _flattened(beside, _slope(beside))


def _beside(grid: Grid, cells: np.ndarray, levels: np.ndarray, wanted: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """Return the levels of the eight cells around the ``wanted`` ones (m, 8, 3), NaN if none; plan from ``origin``."""
    beside = np.full((len(wanted), 8, 3), np.nan)
    for column, step in enumerate(grid.around):
        at, found = find_cells(cells, wanted + step)
        beside[found, column] = levels[at[found]]
    beside[:, :, :2] -= origin[:, None, :2]
    return np.where(np.isfinite(beside), beside, np.nan)


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


def _is_floor(grid: Grid, cell: np.ndarray, cells: np.ndarray, n_points: np.ndarray) -> np.ndarray:
    """Return which points belong to a floor: most points of five or more cells, or of a narrow trench."""
    own, which, count = np.unique(cell, return_inverse=True, return_counts=True)
    groups, group = connected_cells(grid, own)
    if not groups:
        return np.zeros(len(cell), bool)
    low = np.bincount(group, count, groups)
    all_points = np.bincount(group, n_points[np.searchsorted(cells, own)], groups)
    is_floor = ((low >= 5) & (low >= 0.5 * all_points)) | (np.bincount(group, minlength=groups) > 8)
    return is_floor[group][which]
