"""Whether a cloud is one closed surface seen from above, as matched images give it, or is seen through in places."""

from __future__ import annotations

import numpy as np

from ..geometry.grid import find_cells, grid_over

# Cells in which depth is looked for: no smaller than this (m), and this many point spacings, so that ten points share
# a cell.
_LEAST_CELL, _CELL_SPACINGS = 0.75, 3.0

# A cell whose points lie farther apart in height than this (m) is deep: the edge of a roof, a wall, or a crown that is
# seen through.
_DEEP = 2.0


def seen_through_share(xyz: np.ndarray, spacing: float) -> float:
    """Return the share of the occupied area in which points lie far beneath others, edges and walls left out.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    spacing : float
        Point spacing (m).

    Returns
    -------
    float
        Share, 0 to 1, of occupied cells that are deep and have eight deep neighbors. Edges and walls make cells deep
        along lines, and few have eight such neighbors. Crowns that pulses pass make them deep over areas. Measured:
        0 to 0.011 on image-matched clouds, 0.023 to 0.53 on airborne laser clouds with trees.
    """
    grid = grid_over(xyz, max(_LEAST_CELL, _CELL_SPACINGS * spacing))
    number = grid.number(xyz)
    order = np.argsort(number, kind="stable")
    cells, start = np.unique(number[order], return_index=True)
    z = xyz[order, 2]
    deep = cells[np.maximum.reduceat(z, start) - np.minimum.reduceat(z, start) > _DEEP]
    is_inner = np.ones(len(deep), bool)
    for step in grid.around:
        is_inner &= find_cells(deep, deep + step)[1]
    return float(is_inner.sum() / len(cells))
