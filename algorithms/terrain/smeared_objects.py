"""Ground points of matched images that lie on the smeared walls and roofs of small objects."""

import numpy as np

from ..geometry.grid import EIGHT, raster_cells, refuse_sparse
from ..geometry.raster_opening import open_surface
from ..packages import ndimage
from ..rules import rule, rules
from ..sampling.density import DENSITY
from ..sampling.kinds import LASER, SCENE
from .free_standing import FREE


@rules
class SMEARED:
    """Small objects with smeared walls in matched images."""

    width: float = rule(
        4.5, "m", "physics: narrower raised surfaces are objects: a shed of 3 m, walls smeared over 0.7 m"
    )


def on_smeared_objects(xyz: np.ndarray, is_ground: np.ndarray, spacing: float) -> np.ndarray:
    """Return the mask of ground points (n,) on small objects: a ground surface climbs them over smeared walls.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    is_ground : ndarray of shape (n,), bool
        Points that the filter has found to be ground.
    spacing : float
        Point spacing (m).

    Notes
    -----
    The lowest ground points of cells are opened with a window of ``SMEARED.width`` m. Planes of any slope and plateaus
    wider than the window stay as they are. Sheds are removed, and so is the ring of ground points on the smeared walls
    of a house, since no window is centered on its roof. Ridges and dikes narrower than the window rise above the
    opened surface as well: objects longer than two windows stay, except for such rings.
    """
    if not is_ground.any():
        return np.zeros(len(xyz), bool)
    size = max(SCENE.least_cell, DENSITY.filled_cell * spacing)
    refuse_sparse(xyz, size)
    radius = max(1, round(SMEARED.width / 2 / size))
    row, column = raster_cells(xyz, size, radius + 1)
    lowest = np.full((row.max() + radius + 2, column.max() + radius + 2), np.inf)
    np.minimum.at(lowest, (row[is_ground], column[is_ground]), xyz[is_ground, 2])
    has_ground, is_occupied = np.isfinite(lowest), np.zeros(lowest.shape, bool)
    is_occupied[row, column] = True
    is_far = ndimage.distance_transform_edt(~has_ground) > radius
    opened = open_surface(lowest, radius, is_far | (is_occupied & ~has_ground))
    # On a slope a point may lie higher than the lowest one of its cell, but not higher than the lowest one of the next
    # cell uphill.
    highest = ndimage.maximum_filter(np.where(has_ground, opened, -np.inf), 3)
    is_above = is_ground & (xyz[:, 2] > highest[row, column] + LASER.foot)
    above = np.zeros(lowest.shape, bool)
    above[row[is_above], column[is_above]] = True
    return is_above & _of_objects(above, is_occupied & ~has_ground, size)[row, column]


def _of_objects(above: np.ndarray, is_other: np.ndarray, size: float) -> np.ndarray:
    """Return the mask of cells (rows, columns) ``above`` the surface, of small objects or next to large ones.

    Cells of large ones are ``is_other`` (rows, columns): they have points, and no ground.
    """
    # Parts are joined over a cell: noise interrupts crests of terrain. Parts longer than two windows are such crests.
    part, count = ndimage.label(ndimage.binary_dilation(above, EIGHT), EIGHT)
    is_short = np.zeros(count + 1, bool)
    for number, box in enumerate(ndimage.find_objects(part), 1):
        is_short[number] = max(side.stop - side.start - 2 for side in box) * size <= 2 * SMEARED.width
    to_other = ndimage.distance_transform_edt(~is_other) * size if is_other.any() else np.full(above.shape, np.inf)
    cells = np.bincount(part[above], minlength=count + 1)
    beside = np.bincount(part[above & (to_other <= SMEARED.width / 2)], minlength=count + 1)
    return above & (is_short | (beside >= FREE.most * np.maximum(cells, 1)))[part]
