"""The cells that roofs of buildings cover: gaps closed, regions numbered, with the height of roofs."""

from dataclasses import dataclass

import numpy as np

from ..cloud.reasons import Reason
from ..geometry.grid import EIGHT
from ..geometry.groups import least_of, mask_of
from ..geometry.raster_filling import nearest_known
from ..packages import ndimage

# Row and column (n,) of the cell of a raster that each point is in.
Cell = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Coverage:
    """The cells that buildings cover."""

    cell: Cell  #: tuple of two (n,): row and column of the cell that each point is in
    cell_size: float  #: Their size, m
    #: (rows, columns), int32: number of the building that covers each cell; 0 for cells without building
    building: np.ndarray
    refused: np.ndarray  #: (rows, columns), uint8: reason why the roof over a cell was rejected
    top: np.ndarray  #: (rows, columns): elevation of the roof in each cell or the nearest one with a roof, m
    raised: np.ndarray  #: (n,), bool: points that belong to a building if their cell does

    def refusal(self, owner: np.ndarray) -> np.ndarray:
        """Return the reasons of points of no building, as :class:`~..cloud.reasons.Reason`; 0 for points of one.

        ``owner`` (n,) is the building of each point, 0 for none.
        """
        why = np.where(self.building[self.cell] > 0, np.uint8(Reason.TOO_LOW), self.refused[self.cell])
        return np.where(owner > 0, np.uint8(0), why)


def covered_cells(cell: Cell, is_roof: np.ndarray, is_low: np.ndarray, gap: float, cell_size: float) -> np.ndarray:
    """Return the cells (rows, columns) that roofs cover, gaps closed where the ground doesn't show.

    Parameters
    ----------
    cell : Cell
        Cell of each point.
    is_roof : ndarray of shape (n,), bool
        Points of roofs.
    is_low : ndarray of shape (n,), bool
        Points that show the ground.
    gap : float
        Width of gaps that are closed, m.
    cell_size : float
        Side of a cell, m.
    """
    row, column = cell
    margin = int(np.ceil(gap / cell_size)) + 2
    shape = (row.max() + margin, column.max() + margin)
    roof, open_ground = (cells_with(cell, points, shape) for points in (is_roof, is_low))
    reach = round(gap / 2 / cell_size)
    closed = roof | ndimage.binary_closing(roof, disk(reach)) if reach else roof
    holes = ndimage.binary_fill_holes(closed) & ~closed
    # A hole of at most the area of a square as wide as the gap is closed too; a courtyard is larger.
    small = _small(holes, max(1.0, (gap / cell_size) ** 2))
    return roof | ((closed | small) & ~open_ground)


def cells_with(cell: Cell, points: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Return the mask of cells of a raster that hold one of the chosen points (n,)."""
    row, column = cell
    return mask_of(shape, (row[points], column[points]))


def _small(mask: np.ndarray, most: float) -> np.ndarray:
    """Return the part of ``mask`` that lies in regions of at most ``most`` cells."""
    region, count = ndimage.label(mask)
    size = np.bincount(region.ravel(), minlength=count + 1)
    size[0] = 0
    return mask & (size <= most)[region]


def numbered(covered: np.ndarray, min_area: float, cell_size: float) -> tuple[np.ndarray, np.ndarray]:
    """Return numbers from 1 for regions that are large enough, from the south-west, and why the others are refused."""
    region, count = ndimage.label(covered, EIGHT)
    is_large = np.bincount(region.ravel(), minlength=count + 1) * cell_size**2 >= min_area
    return renumbered(is_large)[region], np.where(is_large, 0, Reason.TOO_SMALL).astype(np.uint8)[region]


def mostly_roof(
    building: np.ndarray, refused: np.ndarray, cell: Cell, at_roof: np.ndarray, on_surface: np.ndarray, least: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return numbers as :func:`numbered`, without buildings with less than ``least`` of their roof on surfaces.

    Parameters
    ----------
    building : ndarray of shape (rows, columns), int
        Numbers of the buildings.
    refused : ndarray of shape (rows, columns), uint8
        Reason why the roof over a cell was rejected.
    cell : Cell
        Cell of each point.
    at_roof : ndarray of shape (n,), bool
        Points at the height of the roof.
    on_surface : ndarray of shape (n,), bool
        Points on surfaces of roofs.
    least : float
        Least share on surfaces.
    """
    number = building[cell]
    whole, part = (np.bincount(number[of], minlength=building.max() + 1) for of in (at_roof, at_roof & on_surface))
    # Buildings too narrow for anything but edges are not judged.
    share = np.where(whole > 0, part / np.maximum(whole, 1), 1.0)
    kept = renumbered(share >= least)[building]
    return kept, np.where((building > 0) & (kept == 0), np.uint8(Reason.MOSTLY_OTHER), refused)


def renumbered(kept: np.ndarray) -> np.ndarray:
    """Return the new numbers (m,), int32, of regions: from 1 for those that are kept, 0 for others and for region 0."""
    kept = kept & (np.arange(len(kept)) > 0)
    return np.where(kept, np.cumsum(kept), 0).astype(np.int32)


def roof_top(cell: Cell, elevation: np.ndarray, is_roof: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Return the elevation (rows, columns) of the highest roof point of each cell, or of the nearest such cell.

    Parameters
    ----------
    cell : Cell
        Cell of each point.
    elevation : ndarray of shape (n,)
        Elevations, m.
    is_roof : ndarray of shape (n,), bool
        Points of roofs.
    shape : tuple of int
        Rows and columns.
    """
    row, column = cell
    number = row[is_roof] * shape[1] + column[is_roof]
    top = -least_of(-elevation[is_roof], number, shape[0] * shape[1]).reshape(shape)
    return nearest_known(top, ~np.isfinite(top))


def disk(radius: int) -> np.ndarray:
    """Return a disk of a radius (cells) and a quarter of a cell more, so that it looks round."""
    row, column = np.mgrid[-radius : radius + 1, -radius : radius + 1]
    return row**2 + column**2 <= radius**2 + 0.5 * radius
