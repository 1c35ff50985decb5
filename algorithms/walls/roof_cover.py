"""Where a roof covers the plan, and how deep positions lie within it."""

from __future__ import annotations

import numpy as np

from ..geometry.grid import refuse_sparse
from ..geometry.line_segments import are_inside
from ..packages import ndimage

# Side (m) of the cells in which a roof is compared with walls.
_CELL = 0.25

# Side (m) of the largest cells, which are taken where smaller ones would be more than the most of one building.
_LARGEST_CELL = 1.0

# Most cells of one building.
_MOST_CELLS = 5e5

# Width (m) of the margin around the roof in which walls are searched for.
_ROOM = 2.0


class RoofCover:
    """Where a roof is, in small cells, and how deep (m) under it a position lies, negative beyond its edge."""

    def __init__(self, roof: np.ndarray, courtyards: list) -> None:
        self.cell = float(np.clip(np.sqrt(np.ptp(roof, axis=0).prod() / _MOST_CELLS), _CELL, _LARGEST_CELL))
        refuse_sparse(roof, self.cell)
        room = int(_ROOM / self.cell)
        self.low = roof.min(axis=0) - _ROOM - self.cell
        column, row = ((roof - self.low) / self.cell).astype(np.int64).T
        mask = np.zeros((row.max() + room + 2, column.max() + room + 2), bool)
        mask[row, column] = True
        rows, columns = np.indices(mask.shape).reshape(2, -1)
        self.positions = np.column_stack([columns, rows]) * self.cell + self.cell / 2 + self.low
        self.mask = ndimage.binary_fill_holes(ndimage.binary_closing(mask, np.ones((3, 3), bool), iterations=2))
        for ring in courtyards:
            self.mask &= ~are_inside(self.positions, ring).reshape(mask.shape) | mask
        inside, outside = ndimage.distance_transform_edt(self.mask), ndimage.distance_transform_edt(~self.mask)
        self.depth = np.where(self.mask, inside - 0.5, 0.5 - outside) * self.cell
        self.high = self.low + np.array(mask.shape[::-1]) * self.cell
