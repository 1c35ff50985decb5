"""Where bridges over water may be."""

from __future__ import annotations

import numpy as np

from ..geometry.grid import raster_cells, refuse_sparse
from ..packages import ndimage

# Side of the cells (m) in which distances to water are measured: finer ones find no more.
_CELL = 2.0

# Distance (m) from water within which points are looked at: a deck with the ground at its ends, of which twice the
# reach of the search counts.
_AROUND = 20.0


def near_water(xyz: np.ndarray, is_water: np.ndarray) -> np.ndarray:
    """Return which points (n, 3), m, are within 20 m of water, or between water that is no farther apart than 40 m."""
    if not is_water.any():
        return np.zeros(len(xyz), bool)
    refuse_sparse(xyz, _CELL)
    row, column = raster_cells(xyz, _CELL, 0)
    wet = np.zeros((row.max() + 1, column.max() + 1), bool)
    wet[row[is_water], column[is_water]] = True
    return (ndimage.distance_transform_edt(~wet) * _CELL <= _AROUND)[row, column]
