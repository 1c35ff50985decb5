"""The surface that is seen from above, in cells: how high it is, and which points are of it and not of walls below."""

import numpy as np

from ..geometry.grid import distinct, fixed_grid_over, raster_cells, refuse_sparse
from ..geometry.groups import least_of, topmost
from ..packages import ndimage
from ..rules import rule, rules
from .closed_surface import CLOSED


@rules
class TOP:
    """The surface seen from above, in cells."""

    cell: float = rule(1.2, "point spacings", "statistics: cells hold a point nearly everywhere")
    filled: float = rule(2.0, "cells", "up to which empty cells take the height of the nearest one")


class TopSurface:
    """The highest point of each cell.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    height : ndarray of shape (n,)
        Height above ground of each, m.
    counted : ndarray of shape (n,), bool
        Which of them are looked at: those that are no noise.
    density : float
        Points per square meter.

    Attributes
    ----------
    size : float
        Side of a cell, m.
    cell : tuple of two ndarrays of shape (n,), int64
        Row and column of each point's cell; around the cloud there is an empty border.
    height, elevation : ndarray of shape (rows, columns)
        Of the highest point, m; height 0 and elevation -inf in larger gaps.
    """

    def __init__(self, xyz: np.ndarray, height: np.ndarray, counted: np.ndarray, density: float) -> None:
        self.size = max(CLOSED.least_spacing, TOP.cell / float(np.sqrt(density)))
        refuse_sparse(xyz, self.size)
        # Cells of the empty border on each side.
        margin = 4
        self.cell = row, column = raster_cells(xyz, self.size, margin)
        shape = (int(row.max()) + margin + 1, int(column.max()) + margin + 1)
        cell = row[counted] * shape[1] + column[counted]
        self.elevation = -least_of(-xyz[counted, 2], cell, shape[0] * shape[1]).reshape(shape)
        self.height = np.full(shape, -np.inf)
        np.maximum.at(self.height, (row[counted], column[counted]), height[counted])
        distance, nearest = ndimage.distance_transform_edt(~np.isfinite(self.elevation), return_indices=True)
        is_near = distance <= TOP.filled
        self.elevation = np.where(is_near, self.elevation[tuple(nearest)], -np.inf)
        self.height = np.where(is_near, self.height[tuple(nearest)], 0.0)

    def on_top(self, xyz: np.ndarray) -> np.ndarray:
        """Return the mask of points (n,), given as to the constructor, of the surface.

        They lie at most the side of a cell below the highest point of their cell, as a slope of 45° does.
        """
        return xyz[:, 2] >= self.elevation[self.cell] - self.size


def highest_of_cells(xyz: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the highest point (m,) of each occupied cell of ``size`` (m), and which of these each point (n,) is under.

    Of points equally high the one farthest to the east counts, so that their order in the file does not matter.
    """
    number = fixed_grid_over(xyz, size).number(xyz)
    return topmost(xyz[:, 2], number, xyz[:, 0], xyz[:, 1]), distinct(number)[1]
