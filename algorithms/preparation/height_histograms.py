"""Height histograms of square cells in plan."""

from dataclasses import dataclass

import numpy as np

from ..geometry.grid import Grid, fixed_grid_over, lattice
from ..packages import spatial

# Points of a histogram on average: enough that the highest and lowest meter of a scene hold some at any density.
HISTOGRAM_POINTS = 4000

# Cells, ascending, and the lowest and highest level of the scene in each.
Ranges = tuple[np.ndarray, np.ndarray, np.ndarray]

# Automatic height of the bins, for the help.
AUTOMATIC_BIN = "twice the point spacing, at least 1 m."


def automatic_bin_height(spacing: float) -> float:
    """Return the height of bins (m) on a cloud of a point ``spacing`` (m).

    A third of a storey holds many points of a roof. In a sparse cloud higher bins keep its few points together.
    """
    return max(1.0, 2 * spacing)


@dataclass(frozen=True)
class Histogram:
    """Occupied bins (k,) of the cells, sorted by cell, then by level."""

    cell: np.ndarray  #: (k,), int64: number of the cell in its grid
    level: np.ndarray  #: (k,), int64: number of the bin of height, from 0
    count: np.ndarray  #: (k,), int64: points in the bin


def cells_and_levels(points: np.ndarray, cell_size: float, bin_height: float) -> tuple[Grid, np.ndarray, np.ndarray]:
    """Return square cells (m) over points (n, 3), and the numbers (n,) of the cell and of the bin of each point."""
    grid, level = fixed_grid_over(points, cell_size), lattice(points[:, 2], bin_height)
    return grid, grid.number(points), level - level.min()


def pooled_histogram(grid: Grid, cell: np.ndarray, level: np.ndarray) -> Histogram:
    """Return the histogram of each occupied cell, the points of the eight cells around it among them."""
    levels = int(level.max()) + 1
    own, count = np.unique(cell * levels + level, return_counts=True)
    keys = np.concatenate([own + step * levels for step in (0, *grid.around)])
    keys, which = np.unique(keys, return_inverse=True)
    pooled = np.bincount(which, np.tile(count, 9)).astype(np.int64)
    # Empty cells next to occupied ones have no points to judge.
    occupied = np.isin(keys // levels, own // levels)
    return Histogram(keys[occupied] // levels, keys[occupied] % levels, pooled[occupied])


def own_histogram(cell: np.ndarray, level: np.ndarray) -> Histogram:
    """Return the histogram of each occupied cell by itself."""
    levels = int(level.max()) + 1
    own, count = np.unique(cell * levels + level, return_counts=True)
    return Histogram(own // levels, own % levels, count.astype(np.int64))


def with_borrowed_ranges(grid: Grid, cells: np.ndarray, low: np.ndarray, high: np.ndarray, slack: int = 0) -> Ranges:
    """Give cells without a range the nearest cell's, ``slack`` levels wider; without any, return no cells.

    Parameters
    ----------
    grid : Grid
        The cells.
    cells : ndarray of shape (c,), int64
        Numbers of cells.
    low : ndarray of shape (c,)
        Lowest level of each; changed.
    high : ndarray of shape (c,)
        Highest level of each, negative without a range; changed.
    slack : int
        Levels by which borrowed ranges are wider.

    Returns
    -------
    cells, low, high : ndarrays of shape (c,)
        The cells and their ranges.
    """
    has_range = high >= 0
    if not has_range.any():
        return cells[:0], low[:0], high[:0]
    if not has_range.all():
        lender = np.flatnonzero(has_range)
        tree = spatial.cKDTree(grid.center(cells[lender]))
        nearest = lender[tree.query(grid.center(cells[~has_range]))[1]]
        low[~has_range], high[~has_range] = low[nearest] - slack, high[nearest] + slack
    return cells, low, high
