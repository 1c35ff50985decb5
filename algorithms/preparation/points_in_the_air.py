"""Find loose points in the air over the scene: birds, flocks, plumes of dust.

Solid objects are supported from below. The points of a plume or a flock are few among all points of a column of air,
since most pulses pass it. Points of a roof or a crown are most of their column, also where neither walls nor trunk were
seen.
"""

import numpy as np

from ..criteria import MAJORITY
from ..geometry.grid import distinct, find_cells, fixed_grid_over, plan_box
from ..geometry.groups import components, least_of, mask_of
from ..packages import spatial
from ..stage import Monitor
from .points_under_ground import UNDER_GROUND, near_cells

# Largest distance (m) between points of one object: chimneys and structures on roofs are lower, points along masts and
# wires closer.
_LINK = 2.4

# Least such distance in point spacings: hardly any point of a random sample has no other within it.
_LINK_SPACINGS = 3.5

# A solid object stops at least this share of the pulses.
_SOLID_SHARE = 0.3

# Side (point spacings) of the columns in which the share of stopped pulses is measured: 16 points of the scene in each.
_SHARE_SPACINGS = 4.0

# A component up to this size (m) is the head of a lamp; the points of birds are farther apart.
_COMPACT = 1.0

# Least such size in point spacings, which counts in sparse clouds.
_COMPACT_SPACINGS = 1.5

# Largest standard deviation (m) of points across a plane: roofs of glass are no thicker.
_THIN = 0.3

# Largest standard deviation across a plane or a line, as a share of that along it.
_THIN_RATIO = 0.1

# Points of the neighborhoods that show the wires of a bundle.
_BUNDLE_NEIGHBORS = 8

# Largest variance of a neighborhood across its line, as a share of that along it.
_BUNDLE_RATIO = 0.1

# Fewest points that show a line, such as a wire of which little is seen; a plane takes twice as many.
_LINE_POINTS = 5

# Largest distance (m) of the points of a wire from a straight line, sideways.
_TUBE_ACROSS = 0.35

# Largest distance (m) of the points of a wire from a straight line, up and down: wires sag.
_TUBE_UP = 0.6

# Least length (m) along the line over which the points of a wire are spread.
_TUBE_LENGTH = 12.0

# Lines are tried from each point through as many of the nearest ones.
_TUBE_NEIGHBORS = 24

# Width (m) of the surroundings that decide on a point: chains of points that connect it to the scene, and the second
# points of lines, are searched there.
REACH = 16.0


def link_length(spacing: float) -> float:
    """Return up to which distance (m) points belong to one object."""
    return max(_LINK, _LINK_SPACINGS * spacing)


def in_the_air(xyz: np.ndarray, spacing: float, monitor: Monitor) -> np.ndarray:
    """Return the mask of points (n, 3), m, of loose objects in the air, apart from the scene below them."""
    link = link_length(spacing)
    component = _components(xyz, link)
    is_loose = (_loose(xyz, component, spacing, monitor) & ~_is_cut(xyz, component, link))[component]
    rows = np.flatnonzero(is_loose)
    rows = rows[_is_open(xyz, is_loose, rows, link)]
    rows = rows[~_on_wires(xyz[rows])]
    return mask_of(len(xyz), rows)


def _components(xyz: np.ndarray, link: float) -> np.ndarray:
    """Return the component (n,) of each point, from 0: occupied voxels of side ``link`` that touch."""
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


def _loose(xyz: np.ndarray, component: np.ndarray, spacing: float, monitor: Monitor) -> np.ndarray:
    """Return the mask of components that let most pulses pass and are neither compact, nor lines, nor planes."""
    n_points = np.bincount(component)
    in_smaller = np.flatnonzero((n_points < n_points.max())[component])
    cells, which = distinct(fixed_grid_over(xyz, _SHARE_SPACINGS * spacing).number(xyz))
    in_cell = np.bincount(which)
    pairs = np.unique(component[in_smaller].astype(np.int64) * len(cells) + which[in_smaller])
    # Columns that the edge of the cloud cuts count as half full.
    full = np.maximum(in_cell[pairs % len(cells)], _SHARE_SPACINGS**2 / 2)
    in_columns = np.bincount(pairs // len(cells), full, len(n_points))
    is_loose = (in_columns > 0) & (n_points < _SOLID_SHARE * in_columns)

    order = in_smaller[np.argsort(component[in_smaller], kind="stable")]
    ends = np.searchsorted(component[order], np.arange(len(n_points) + 1))
    # Fewer points have no form.
    for number in np.flatnonzero(is_loose & (n_points >= UNDER_GROUND.few)).tolist():
        points = xyz[order[ends[number] : ends[number + 1]]]
        is_loose[number] = not _has_form(points, max(_COMPACT, _COMPACT_SPACINGS * spacing))
        monitor.progress(0.5)
    return is_loose


def _is_cut(xyz: np.ndarray, component: np.ndarray, link: float) -> np.ndarray:
    """Return the mask of components with a form at the cloud's border: they may be parts of others."""
    low, high = plan_box(xyz)
    x, y = xyz[:, 0], xyz[:, 1]
    is_outer = (x < low[0] + link) | (x > high[0] - link) | (y < low[1] + link) | (y > high[1] - link)
    return (np.bincount(component, is_outer) > 0) & (np.bincount(component) >= UNDER_GROUND.few)


def _has_form(points: np.ndarray, compact: float) -> bool:
    """Return whether points fill a small volume, or lie along lines or in a plane."""
    if (np.ptp(points, axis=0) <= compact).all():
        return True
    if len(points) < _LINE_POINTS:
        return False
    deviation = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(points.T)), 0))
    is_line = deviation[1] <= _THIN_RATIO * deviation[2]
    is_plane = len(points) >= 2 * _LINE_POINTS and deviation[0] <= min(_THIN, _THIN_RATIO * deviation[1])
    return bool(is_line or is_plane or _share_of_lines(points) > MAJORITY)


def _share_of_lines(points: np.ndarray) -> float:
    """Return the share of points whose nearest ones lie along a line, as in bundled wires."""
    near = points[spatial.cKDTree(points).query(points, min(_BUNDLE_NEIGHBORS, len(points)))[1]]
    near -= near.mean(axis=1, keepdims=True)
    eigenvalues = np.linalg.eigvalsh(np.einsum("nki,nkj->nij", near, near))
    return float((eigenvalues[:, 1] < _BUNDLE_RATIO * eigenvalues[:, 2]).mean())


def _is_open(xyz: np.ndarray, is_loose: np.ndarray, rows: np.ndarray, link: float) -> np.ndarray:
    """Return the mask of rows with the scene, all that isn't loose, below them and nothing of it above, close by."""
    if not len(rows) or is_loose.all():
        return np.zeros(len(rows), bool)
    grid = fixed_grid_over(xyz, link / 2)
    cells, which = distinct(grid.number(xyz))
    scene = np.flatnonzero(mask_of(len(cells), near_cells(grid, cells, which[rows]))[which] & ~is_loose)
    top = -least_of(-xyz[scene, 2], which[scene], len(cells))
    highest = np.full(len(rows), -np.inf)
    for step in (0, *grid.around):
        beside, found = find_cells(cells, cells[which[rows]] + step)
        highest = np.maximum(highest, np.where(found, top[beside], -np.inf))
    return np.isfinite(highest) & (xyz[rows, 2] > highest)


def _on_wires(points: np.ndarray) -> np.ndarray:
    """Return the mask of points in a line with few others, as points of wires are that a scanner rarely hits."""
    on_wire = np.zeros(len(points), bool)
    if len(points) < _LINE_POINTS:
        return on_wire
    count = min(_TUBE_NEIGHBORS, len(points))
    distance, near = spatial.cKDTree(points).query(points, count, distance_upper_bound=REACH)
    for row in np.flatnonzero(np.isfinite(distance).sum(axis=1) >= _LINE_POINTS).tolist():
        others = near[row][np.isfinite(distance[row])]
        off = points[others] - points[row]
        along = off[1:, :2]
        length = np.linalg.norm(along, axis=1)
        # Between nearer points, which may be of one compact object, the direction of a line is random.
        usable = length > _COMPACT
        along, rise = along[usable] / length[usable, None], off[1:, 2][usable] / length[usable]
        at = along @ off[:, :2].T
        across = np.abs(along[:, :1] * off[:, 1] - along[:, 1:] * off[:, 0])
        inside = (across <= _TUBE_ACROSS) & (np.abs(off[:, 2] - rise[:, None] * at) <= _TUBE_UP)
        reach = np.where(inside, at, -np.inf).max(axis=1) - np.where(inside, at, np.inf).min(axis=1)
        for line in np.flatnonzero((inside.sum(axis=1) >= _LINE_POINTS) & (reach >= _TUBE_LENGTH)):
            on_wire[others[inside[line]]] = True
    return on_wire
