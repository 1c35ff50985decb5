"""Points in the columns of buildings: walls and structures belong to a roof, bushes and crowns next to it do not."""

from dataclasses import dataclass

import numpy as np

from ..geometry.grid import EIGHT
from ..packages import ndimage
from ..rules import rule
from ..sampling.kinds import SCENE
from ..sampling.top_surface import TOP


@dataclass(frozen=True)
class ColumnRules:
    """Which cells belong to a roof, and which adjoin it."""

    wall_reach: float = rule(1.0, "m", "physics: eaves reach out by up to this, and roof surfaces end before them")
    sparse_share: float = rule(0.3, "share", "chimneys and dormers cover less of the cells around, crowns more")
    bush_share: float = rule(0.33, "share", "of the roof's height, up to which points next to a roof may be bushes")
    around: int = rule(7, "cells", "side of the square in which cells and pulses are counted, some 4 m")
    bush_height: float = rule(2.5, "m", "physics: hedges and bushes at walls are trimmed lower than a floor")

    @property
    def edge(self) -> float:
        """Distance (m) from edges of buildings within which points may be called wrong: eaves reach out both ways."""
        return 2 * self.wall_reach


COLUMNS = ColumnRules()


@dataclass(frozen=True)
class ColumnPoints:
    """All points (n,), as they are compared with buildings."""

    cell: tuple[np.ndarray, np.ndarray]  #: tuple of two (n,): row and column of the cell that each is in
    #: elevation, height, (n,): elevation and height above ground, m
    elevation: np.ndarray
    height: np.ndarray
    raised: np.ndarray  #: (n,), bool: higher than the foot of a wall, and no noise
    goes_on: np.ndarray  #: (n,), bool: whether the pulse went on to another return, as it does in crowns; walls stop it


def column_size(density: float) -> float:
    """Return the side (m) of the cells that buildings are counted in, at a density (points/m²)."""
    return max(SCENE.least_cell, TOP.cell / float(np.sqrt(density)))


class Columns:
    """The cells of buildings, the cells that adjoin them, and the elevations of their roofs.

    Parameters
    ----------
    building : ndarray of shape (rows, columns), int32
        Number of the building that covers each cell; 0 for none.
    top : ndarray of shape (rows, columns)
        Elevation of the roof in each cell or the nearest one with a roof, m.
    cell_size : float
        Side of a cell, m.

    Attributes
    ----------
    highest : ndarray of shape (rows, columns)
        Elevation of the highest roof near each cell, as far as walls reach, m; -inf where no roof is near.
    beside : ndarray of shape (rows, columns), int32
        Number of the building that each cell without building adjoins; 0 for others.
    """

    def __init__(self, building: np.ndarray, top: np.ndarray, cell_size: float) -> None:
        self.building = building
        self.top = top
        window = 2 * max(1, round(COLUMNS.wall_reach / cell_size)) + 1
        self.highest = ndimage.maximum_filter(np.where(building > 0, top, -np.inf), window)
        self.beside = np.where(building > 0, 0, ndimage.grey_dilation(building, footprint=EIGHT))

    def owners(self, points: ColumnPoints, clearance: float, structure_height: float) -> np.ndarray:
        """Return the building (n,), int32, that each point belongs to; 0 if unassigned.

        Over a building these are the points up to ``clearance`` (m) above the roof, and where points above it are few,
        those up to ``structure_height`` (m). Next to it they are of walls: below the roof, and of no plant.
        """
        above = points.elevation - self.top[points.cell]
        inside = points.raised & (self.building[points.cell] > 0)
        is_above = inside & (above > clearance)
        is_chimney = is_above & (above <= structure_height) & self.is_sparse(points.cell, is_above)[points.cell]
        is_bush = points.height < np.minimum(COLUMNS.bush_share * (points.height - above), COLUMNS.bush_height)
        is_plant = is_bush | self.is_beside_crown(points)[points.cell]
        # Points between a roof and the next higher one are the wall of the higher one.
        is_wall = points.raised & (points.elevation <= self.highest[points.cell]) & (inside | ~is_plant)
        owner = np.where(inside, self.building[points.cell], self.beside[points.cell])
        return np.where((inside & (above <= clearance)) | is_chimney | is_wall, owner, 0).astype(np.int32)

    def is_sparse(self, cell: tuple[np.ndarray, np.ndarray], is_above: np.ndarray) -> np.ndarray:
        """Return the cells (rows, columns) around which the points above the roof cover a small part of it."""
        occupied = np.zeros(self.building.shape)
        occupied[tuple(axis[is_above] for axis in cell)] = 1
        around = ndimage.uniform_filter(occupied, COLUMNS.around, mode="constant")
        roof = ndimage.uniform_filter((self.building > 0).astype(float), COLUMNS.around, mode="constant")
        return around < COLUMNS.sparse_share * roof

    def is_beside_crown(self, points: ColumnPoints) -> np.ndarray:
        """Return the cells (rows, columns) of crowns apart from buildings, and the cells next to them."""
        apart = points.raised & (self.building[points.cell] == 0) & (self.beside[points.cell] == 0)
        shape = self.building.shape
        number = np.ravel_multi_index(points.cell, shape)[apart]
        weights = (points.goes_on[apart], None)
        n_passed, n_points = (np.bincount(number, one, np.prod(shape)).reshape(shape) for one in weights)
        # Crowns are three cells wide or more, balconies and walls are not. The beam passes most points of a crown.
        is_wide = ndimage.binary_opening(n_points > 0, EIGHT)
        mean_excess = ndimage.uniform_filter(2.0 * n_passed - n_points, COLUMNS.around, mode="constant")
        # Rounded to the whole number that the sum over the square is.
        is_mostly_passed = np.rint(COLUMNS.around**2 * mean_excess) > 0
        return ndimage.binary_dilation(is_wide & is_mostly_passed, EIGHT)
