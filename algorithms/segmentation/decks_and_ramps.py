"""Decks and the ramps that join them to the ground: parted where one is narrow beside the other."""

from __future__ import annotations

import numpy as np

from ..geometry.grid import Grid, connected_cells, distinct, find_cells, fixed_grid_over
from ..geometry.groups import members
from ..packages import ndimage

# Side of the cells, in point spacings, and its least value (m): wide enough that gaps between scan lines, and gaps by
# chance, do not divide a surface.
_CELL_SPACINGS, _LEAST_CELL = 3.0, 2.0

# A ramp rises no more than this over its length, and the wall of a deck does.
_STEEPEST = 0.5

# A ramp is at most so wide beside the deck that it leads up to; a bridge is as wide as its ends.
_MOST_OF_WIDTH = 0.5

# Cells on one side of a line that touch one on the other: their length is that of the line times this, on the average
# over its directions.
_LENGTH = np.pi / 4


def part_decks(
    xyz: np.ndarray, patch: np.ndarray, height: np.ndarray, density: float, min_height: float, min_area: float
) -> np.ndarray:
    """Separate decks from surfaces that a ramp joins them to: the road to a parking deck, the bank behind a terrace.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    patch : ndarray of shape (n,), int32
        Patch of each point from 0, all of them smooth surfaces that go on into the ground; -1 for points of no such.
    height : ndarray of shape (n,)
        Heights above ground, m.
    density : float
        Points per square meter.
    min_height, min_area : float
        A deck lies at least so high (m), and is at least so large (m²).

    Returns
    -------
    ndarray of shape (n,), int32
        Deck of each point from 0, -1 where it lies on none.

    Notes
    -----
    A deck is a high part of a patch that goes on to lower parts along less than half of its width. A bridge goes on at
    both of its ends, as wide as it is.
    """
    deck = np.full(len(xyz), -1, np.int32)
    is_high = np.bincount(patch + 1, height >= min_height) > 0
    member = np.flatnonzero((patch >= 0) & is_high[patch + 1])
    if not len(member):
        return deck
    grid = fixed_grid_over(xyz, max(_LEAST_CELL, _CELL_SPACINGS / np.sqrt(density)))
    # One copy of the grid for each patch: its empty border keeps them apart.
    cells, which = distinct(patch[member].astype(np.int64) * (grid.rows * grid.columns) + grid.number(xyz[member]))
    # The highest point of a cell: at the edge of a deck it is the deck's.
    level, top = np.full((2, len(cells)), -np.inf)
    np.maximum.at(level, which, height[member])
    np.maximum.at(top, which, xyz[member, 2])
    is_low = level < min_height
    high = np.flatnonzero(~is_low)
    count, part = connected_cells(grid, cells[high])
    area = np.bincount(part) * grid.size**2
    contact = _LENGTH * np.bincount(part, _goes_on(grid, cells, top, is_low)[high], count) * grid.size
    # No circle in a part is larger than the part: most are seen to be too narrow without looking for the largest.
    may_be = (area >= min_area) & (contact > 0) & (contact <= _MOST_OF_WIDTH * 2 * np.sqrt(area / np.pi))
    number = np.full(count, -1, np.int32)
    for following, places in members(np.where(may_be[part], part + 1, 0)).items():
        if contact[following - 1] < _MOST_OF_WIDTH * _width(grid, cells[high[places]]):
            number[following - 1] = number.max() + 1
    deck_of_cell = np.full(len(cells), -1, np.int32)
    deck_of_cell[high] = number[part]
    # At its edge a deck shares cells with lower points at its foot.
    is_deck = xyz[member, 2] >= top[which] - _STEEPEST * grid.size
    deck[member[is_deck]] = deck_of_cell[which[is_deck]]
    return deck


def _goes_on(grid: Grid, cells: np.ndarray, top: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return from which ``cells`` the surface goes on to a chosen one as a ramp does; ``top`` is their elevation."""
    goes_on = np.zeros(len(cells), bool)
    for step in (-grid.columns, -1, 1, grid.columns):
        there, found = find_cells(cells, cells + step)
        goes_on |= found & chosen[there] & (np.abs(top - top[there]) <= _STEEPEST * grid.size)
    return goes_on


def _width(grid: Grid, cells: np.ndarray) -> float:
    """Return the diameter (m) of the largest circle in a connected part, its holes filled."""
    row, column = np.divmod(cells, grid.columns)
    row, column = row - row.min() + 1, column - column.min() + 1
    mask = np.zeros((row.max() + 2, column.max() + 2), bool)
    mask[row, column] = True
    inward = ndimage.distance_transform_edt(ndimage.binary_fill_holes(mask)).max()
    return float(2 * inward - 1) * grid.size
