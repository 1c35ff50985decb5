"""Separate roof points of buildings from wall points, and find the non-building points next to roofs."""

from typing import Any

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..geometry.grid import distinct, find_cells, fixed_grid_over, grid_over
from ..geometry.groups import topmost
from ..packages import spatial
from ..stage import Monitor
from ..threads import ROWS_AT_ONCE, in_chunks, n_threads
from .soft_shares import REACH

# A building point is no roof point if another one lies steeply above it by more than this height (m); roofs are less
# rough.
_STEP = 0.4

# Least height (m) of a roof above adjacent non-building points, and above points that were only attached to the
# building, at any slope: these are bushes under eaves.
_BELOW = 1.0

# Slope (tangent) up to which a higher point is of the same steep roof: 72°. Such a roof rises by as many spacings from
# one point to the next, which is the least height above attached points.
_UPRIGHT = 3.0

# Side (spacings) of the cells in which walls end a roof: half a square spacing.
_CELL = 0.71

# Weight of roof points in a cell with points on a wall. Half of such a cell is roof, and nearly all of them have a
# roof point, while two fifths of the cells of a roof without walls have one.
_AT_WALL = 0.43

# Radius (spacings) in which roof points are counted to decide whether a point lies under a roof: 12 on the average.
_AROUND = 2.0

# Number of nearest roof points whose surroundings give the density of the roof.
_NEAREST = 24

# A point lies under a roof that is this share as dense around it as around its nearest roof points: next to a straight
# edge it is half. Measured on simulated roofs.
_UNDER = 0.7

# Least density of a roof, as a share of the density by the mean spacing: bushes that are taken for it are thinner.
_DENSE = 0.6


def find_roof_points(xyz: np.ndarray, cluster: np.ndarray, is_attached: np.ndarray, spacing: float) -> np.ndarray:
    """Return the mask of building points (n,) on roofs: no other of their cluster lies far and steeply above.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Building points (m), in plan from the corner of the whole.
    cluster : ndarray of shape (n,), int64
        Building of each.
    is_attached : ndarray of shape (n,), bool
        Whether it was only attached to its building: above such a one no other may lie far, however steeply.
    spacing : float
        Mean distance of neighboring points (m). The highest point of each cell of this size, and of the eight around,
        is compared.
    """
    grid = fixed_grid_over(xyz, spacing)
    # The keys of two clusters differ by at least the size of the grid.
    cell = grid.number(xyz) + distinct(cluster)[1].astype(np.int64) * (grid.rows * grid.columns)
    highest = topmost(xyz[:, 2], cell)
    cells, top = cell[highest], xyz[highest]
    is_roof = np.ones(len(xyz), bool)
    step = np.where(is_attached, max(_BELOW, _UPRIGHT * spacing), _STEP)
    steepest = np.where(is_attached, 0.0, _UPRIGHT)

    def work(rows: np.ndarray) -> None:
        for offset in (0, *grid.around):
            position, found = find_cells(cells, cell[rows] + offset)
            own = rows[found]
            x, y, rise = (top[position[found]] - xyz[own]).T
            is_roof[own] &= rise <= np.maximum(step[own], steepest[own] * np.hypot(x, y))

    in_chunks(work, np.arange(len(xyz)), ROWS_AT_ONCE, Monitor())
    return is_roof


def edge_weights(roof: np.ndarray, walls: np.ndarray, spacing: float) -> np.ndarray:
    """Return the weights (n,), 0 to 1, of points of roofs (n, 3), m: less where a wall (m, 3) below ends the roof."""
    if not len(walls) or not len(roof):
        return np.ones(len(roof))
    grid = fixed_grid_over(np.concatenate([roof, walls]), spacing * _CELL)
    return np.where(find_cells(np.unique(grid.number(walls)), grid.number(roof))[1], _AT_WALL, 1.0)


def find_non_building_points(xyz: np.ndarray, classes: np.ndarray, roof: np.ndarray, spacing: float) -> np.ndarray:
    """Return the indices (m,) of non-building points next to roofs and clearly below them, where the roof has ended.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m.
    classes : ndarray of shape (n,)
        Classes.
    roof : ndarray of shape (k,), int64
        Rows of the points of roofs.
    spacing : float
        Point spacing, m.
    """
    reach = REACH * spacing
    grid = grid_over(xyz, reach)
    cells = distinct(grid.number(xyz[roof]))[0]
    near = np.unique(np.concatenate([cells, *(cells + step for step in grid.around)]))
    other = np.flatnonzero(~np.isin(classes, (PointClass.BUILDING, *NOISE)))
    other = other[find_cells(near, grid.number(xyz[other]))[1]]
    if not len(other):
        return other
    tree = spatial.cKDTree(xyz[roof, :2], balanced_tree=False)
    # A pulse that was split by the edge counts on both sides, so that the roof ends in the middle of such pulses.
    distance, nearest = tree.query(xyz[other, :2], distance_upper_bound=reach, workers=n_threads())
    beside = np.isfinite(distance)
    other, nearest = other[beside], nearest[beside]
    other = other[xyz[other, 2] < xyz[roof[nearest], 2] - _BELOW]
    return other[~is_under_roof(xyz[other, :2], tree, spacing)]


def is_under_roof(positions: np.ndarray, tree: Any, spacing: float) -> np.ndarray:
    """Return the mask of positions (n, 2) under a roof, given as a tree: it is as dense there as around its points.

    From the side, a scanner sees the ground and the wall under the eaves.
    """
    if not len(positions):
        return np.zeros(0, bool)
    count = tree.query_ball_point(positions, _AROUND * spacing, return_length=True, workers=n_threads())
    _, nearest = tree.query(positions, min(_NEAREST, tree.n), workers=n_threads())
    nearest = nearest.reshape(len(positions), -1)
    beside, row = distinct(nearest.ravel())
    usual = tree.query_ball_point(tree.data[beside], _AROUND * spacing, return_length=True, workers=n_threads())
    # Bushes next to a roof that are taken for it are thinner than a roof.
    least = _DENSE * np.pi * _AROUND**2
    return count > _UNDER * np.maximum(usual[row.reshape(nearest.shape)].mean(axis=1), least)
