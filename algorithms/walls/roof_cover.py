"""Where a roof covers the plan, and how deep positions lie within it."""

from __future__ import annotations

import numpy as np

from ..geometry.grid import EIGHT, refuse_sparse
from ..geometry.line_segments import are_inside
from ..packages import ndimage

# Side (m) of the cells in which a roof is compared with walls.
_CELL = 0.25

# Most cells of one building: those of extended ones are larger.
_MOST_CELLS = 5e5

# Side (m) of the largest cells.
_LARGEST_CELL = 1.0

# Rounds of closing, by a cell each on all sides: gaps of up to four cells between points of a roof are covered.
_CLOSING = 2

# Width (m) of the margin around the roof in which walls are searched for.
_ROOM = 2.0


class RoofCover:
    """Where a roof is, in small cells.

    Parameters
    ----------
    roof : ndarray of shape (n, 2)
        Points of the roof in plan, m.
    courtyards : list of ndarray of shape (k, 2)
        Closed rings, m, within which there is roof only where it has points.

    Attributes
    ----------
    cell : float
        Side of a cell, m.
    low, high : ndarray of shape (2,)
        Corners of the raster, m.
    positions : ndarray of shape (rows * columns, 2)
        Middles of the cells, row by row, m.
    depth : ndarray of shape (rows, columns)
        Distance of each middle from the edge of the roof, m: positive under it, negative beyond.
    """

    def __init__(self, roof: np.ndarray, courtyards: list) -> None:
        self.cell = float(np.clip(np.sqrt(np.ptp(roof, axis=0).prod() / _MOST_CELLS), _CELL, _LARGEST_CELL))
        refuse_sparse(roof, self.cell)
        room = int(_ROOM / self.cell)
        self.low = roof.min(axis=0) - _ROOM - self.cell
        column, row = ((roof - self.low) / self.cell).astype(np.int64).T
        has_points = np.zeros((row.max() + room + 2, column.max() + room + 2), bool)
        has_points[row, column] = True
        rows, columns = np.indices(has_points.shape).reshape(2, -1)
        self.positions = np.column_stack([columns, rows]) * self.cell + self.cell / 2 + self.low
        covered = ndimage.binary_fill_holes(ndimage.binary_closing(has_points, EIGHT, iterations=_CLOSING))
        for ring in courtyards:
            covered &= ~are_inside(self.positions, ring).reshape(covered.shape) | has_points
        inside, outside = ndimage.distance_transform_edt(covered), ndimage.distance_transform_edt(~covered)
        self.depth = np.where(covered, inside - 0.5, 0.5 - outside) * self.cell
        self.high = self.low + np.array(covered.shape[::-1]) * self.cell
