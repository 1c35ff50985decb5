"""Square cells in plan: numbering points by them without ever holding the whole grid."""

from dataclasses import dataclass

import numpy as np

from ..packages import sparse
from .groups import components, mask_of

# A cell of a raster and the eight around it.
EIGHT = np.ones((3, 3), bool)


@dataclass(frozen=True)
class Grid:
    """Cells of ``size`` (m), ``rows`` of them northward and ``columns`` eastward.

    They are cells of a lattice from ``origin``, from column and row ``first`` of it on. A cell's number is
    ``row * columns + column``. An empty border of one cell keeps the neighbors of the outermost cells apart, so that
    numbers can be compared by their differences.
    """

    origin: tuple[float, float]
    size: float
    rows: int
    columns: int
    first: tuple[int, int] = (0, 0)

    @property
    def corner(self) -> np.ndarray:
        """Easting and northing (2,) of the south-western corner, m, of the first cell within the border."""
        return np.array(self.origin) + np.array(self.first) * self.size

    def number(self, xyz: np.ndarray) -> np.ndarray:
        """Return the cell number (n,), int64, of points inside the grid."""
        column, row = (lattice(xyz[:, k] - self.origin[k], self.size) + (1 - self.first[k]) for k in (0, 1))
        return row * self.columns + column

    def center(self, number: np.ndarray) -> np.ndarray:
        """Return easting and northing (m, 2) of the middle of cells."""
        row, column = np.divmod(number, self.columns)
        return np.column_stack([column - 0.5, row - 0.5]) * self.size + self.corner

    @property
    def around(self) -> tuple[int, ...]:
        """Differences in number to the eight cells around a cell."""
        return tuple(row * self.columns + column for row in (-1, 0, 1) for column in (-1, 0, 1) if row or column)


def grid_over(xyz: np.ndarray, size: float) -> Grid:
    """Return the grid of cells of ``size`` (m) whose first cell starts at the least easting and northing."""
    low, high = plan_box(xyz)
    columns, rows = (np.floor((high - low) / size).astype(np.int64) + 3).tolist()
    return Grid((float(low[0]), float(low[1])), size, rows, columns)


def fixed_grid_over(xyz: np.ndarray, size: float) -> Grid:
    """Return the grid of those cells of ``size`` (m) at multiples of it that points lie in.

    A part of a cloud has the cells of the whole, so that results do not depend on where a cloud was cut. Positions
    are to be measured from the corner of the whole, see :meth:`.CloudSampling.from_corner`.
    """
    (west, south), (east, north) = lattice(plan_box(xyz), size).tolist()
    return Grid((0.0, 0.0), size, north - south + 3, east - west + 3, (west, south))


def raster_cells(xyz: np.ndarray, size: float, margin: int) -> tuple[np.ndarray, np.ndarray]:
    """Return row and column (n,), int64, of each point's cell in a raster with ``margin`` empty cells around.

    The cells are as of :func:`fixed_grid_over`.
    """
    column, row = (number - (number.min() - margin) for number in (lattice(xyz[:, axis], size) for axis in (0, 1)))
    return row, column


def lattice(values: np.ndarray, size: float) -> np.ndarray:
    """Return the number, int64, of the interval of ``size`` (m) from zero that each coordinate (m) lies in."""
    return np.floor(values / size).astype(np.int64)


def plan_box(xyz: np.ndarray) -> np.ndarray:
    """Return the least and the greatest easting and northing (2, 2) of points, m."""
    # Column by column is many times faster than along the axis.
    columns = xyz[:, 0], xyz[:, 1]
    return np.array([[column.min() for column in columns], [column.max() for column in columns]])


def turned_in_plan(positions: np.ndarray, angle: float) -> np.ndarray:
    """Return positions (n, 2 or 3) turned counterclockwise by an angle (°) about the vertical through zero."""
    if not angle:
        return positions
    x, y, *z = positions.T
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.column_stack([cos * x - sin * y, sin * x + cos * y, *z])


def distinct(numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return each number once, ascending, and which of these every number is.

    Parameters
    ----------
    numbers : ndarray of shape (n,), int64
        Numbers of cells or the like.

    Returns
    -------
    values : ndarray of shape (m,), int64
        The numbers that occur.
    which : ndarray of shape (n,), int32 or int64
        Where among these each number is.

    Notes
    -----
    As ``numpy.unique``; where numbers are not far apart, as in occupied cells, without sorting.
    """
    least = int(numbers.min()) if len(numbers) else 0
    length = int(numbers.max()) - least + 1 if len(numbers) else 0
    # A table of up to four entries per number takes less memory and time than sorting the numbers.
    if length > 4 * len(numbers):
        return np.unique(numbers, return_inverse=True)
    is_there = mask_of(length, numbers - least)
    rank = np.cumsum(is_there, dtype=np.int32) - np.int32(1)
    return np.flatnonzero(is_there) + least, rank[numbers - least]


class SparsePointsError(ValueError):
    """Points lie too far apart for a raster of cells over them."""


def is_nearly_empty(xyz: np.ndarray, size: float, most_cells: int = 200_000) -> bool:
    """Return whether a raster over points (n, 2 or 3), with cells of ``size`` (m), is large and nearly all empty.

    Many are more than ``most_cells``; up to these a raster costs hardly any time, however empty it is. Nearly empty is
    a raster with more than twenty cells for each point, which is due to wrong coordinates.
    """
    width, height = np.ptp(plan_box(xyz), axis=0)
    return bool((width / size + 1) * (height / size + 1) > max(most_cells, 20 * len(xyz)))


def refuse_sparse(xyz: np.ndarray, size: float, most_cells: int = 10_000_000) -> None:
    """Refuse points that lie too far apart for a raster of cells, which would be nearly empty.

    Parameters
    ----------
    xyz : ndarray of shape (n, 2 or 3)
        Points (m), n >= 1.
    size : float
        Side of a cell, m.
    most_cells : int
        Cells that are no burden however empty they are, unless given ten million: an array of tens of megabytes.

    Raises
    ------
    SparsePointsError
        If the raster had more cells than that and more than twenty for each point.
    """
    if is_nearly_empty(xyz, size, most_cells):
        width, height = np.ptp(plan_box(xyz), axis=0)
        raise SparsePointsError(
            f"The {len(xyz)} points are spread over {width:,.0f} m by {height:,.0f} m, which is nearly empty in cells "
            f"of {size:.2g} m; remove points that lie far off in plan, cut the cloud into pieces, or set larger cells."
        )


def connected_cells(grid: Grid, cells: np.ndarray) -> tuple[int, np.ndarray]:
    """Group cells that touch by a side or a corner.

    Parameters
    ----------
    grid : Grid
        The grid that the numbers belong to.
    cells : ndarray of shape (m,), int64
        Cell numbers, ascending and each once.

    Returns
    -------
    count : int
        Number of groups.
    group : ndarray of shape (m,), int32
        Group of each cell, from 0.
    """
    if not len(cells):
        return 0, np.zeros(0, np.int32)
    one, other = [], []
    # Four of the eight directions: the others are the same pairs seen from the other side.
    for step in grid.around[4:]:
        beside, found = find_cells(cells, cells + step)
        one.append(np.flatnonzero(found))
        other.append(beside[found])
    return components(np.concatenate(one), np.concatenate(other), len(cells))


def shared_cells(
    xyz: np.ndarray, group: np.ndarray, count: int, size: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the pairs of groups that have points in the same cells.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    group : ndarray of shape (n,), int
        Group of each point, from 0 to ``count`` - 1.
    count : int
        How many groups there are.
    size : float
        Side of a cell in plan (m).

    Returns
    -------
    one, other : ndarray of shape (k,), int32
        The groups of each pair, the lesser first.
    cells : ndarray of shape (k,), int64
        In how many cells both have points.
    """
    cells, cell = distinct(grid_over(xyz, size).number(xyz))
    of_cell, of_group = np.divmod(distinct(cell.astype(np.int64) * count + group)[0], count)
    holds = sparse.csr_matrix((np.ones(len(of_cell), np.int64), (of_group, of_cell)), shape=(count, len(cells)))
    shared = sparse.triu(holds @ holds.T, k=1).tocoo()
    return shared.row, shared.col, shared.data


def find_cells(cells: np.ndarray, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the positions of ``wanted`` numbers in ``cells`` (ascending), and the mask of those found."""
    position = np.searchsorted(cells, wanted)
    position[position == len(cells)] = 0
    found = cells[position] == wanted if len(cells) else np.zeros(len(wanted), bool)
    return position, found
