"""Decks of inner courts: ground with buildings on all sides that lies higher than the streets around them."""

from __future__ import annotations

import numpy as np

from ..geometry.groups import least_of
from ..geometry.raster_filling import nearest_known
from ..packages import ndimage
from ..sampling.kinds import LASER
from ..sampling.surface_noise import ON_PLANE
from .roof_coverage import Cell

# Width of the widest court (m), and how far from it streets count: beyond a building of 15 m, as far again.
AROUND = 30.0


def deck_cells(
    building: np.ndarray, cell: Cell, elevation: np.ndarray, is_ground: np.ndarray, cell_size: float, min_area: float
) -> np.ndarray:
    """Return the building (rows, columns) that surrounds the deck in each cell; 0 in cells without a deck.

    A deck lies as high over the streets around as the lowest roof over ground, and over what a hill that rises toward
    the court would reach there: the court of a castle is ground.

    Parameters
    ----------
    building : ndarray of shape (rows, columns), int32
        Number of the building that covers each cell, 0 for none; the outermost cells have none.
    cell : Cell
        Cell of each point.
    elevation : ndarray of shape (n,)
        Elevation of each point, m.
    is_ground : ndarray of shape (n,), bool
        Points of the ground.
    cell_size : float
        Side of a cell, m.
    min_area : float
        Least area of a deck, m².
    """
    region, count = ndimage.label(building == 0)
    number = np.ravel_multi_index(cell, building.shape)[is_ground]
    ground = least_of(elevation[is_ground], number, building.size).reshape(building.shape)
    boxes = ndimage.find_objects(region)
    widest = np.array([max(side.stop - side.start for side in box) for box in boxes]) * cell_size
    is_court = np.append(False, widest <= AROUND)
    is_large = np.bincount(region.ravel(), minlength=count + 1) * cell_size**2 >= min_area
    street = np.where(is_court[region] | (region == 0), np.inf, ground)
    margin = int(np.ceil(AROUND / cell_size))
    deck = np.zeros(building.shape, bool)
    for court in np.flatnonzero(is_court & is_large):
        around = tuple(slice(max(0, side.start - margin), side.stop + margin) for side in boxes[court - 1])
        is_inside = region[around] == court
        deck[around] |= is_inside & (_rise(street[around], ground[around], is_inside, cell_size) > LASER.lowest_roof)
    patch, count = ndimage.label(deck)
    is_large = np.bincount(patch.ravel(), minlength=count + 1) * cell_size**2 >= min_area
    return np.where(deck & is_large[patch], nearest_known(building, building == 0), 0)


def _rise(street: np.ndarray, ground: np.ndarray, is_court: np.ndarray, cell_size: float) -> np.ndarray:
    """Return how high (rows, columns) the ground of a court lies over the streets, continued to it, m.

    ``street`` and ``ground`` are elevations, m, infinite in cells without; -inf where there are fewer cells of streets
    than of the court.
    """
    outside = np.isfinite(street)
    if outside.sum() < is_court.sum():
        return np.full(ground.shape, -np.inf)
    away, depth = (ndimage.distance_transform_edt(cells) * cell_size for cells in (~is_court, is_court))
    near, level = away[outside], street[outside]
    fall = max(0.0, -float(np.cov(near, level)[0, 1] / near.var())) if np.ptp(near) else 0.0
    continued = level + fall * near
    # Few cells of streets are higher: stairs and walls.
    rise = ground - (continued.mean() + ON_PLANE * continued.std()) - fall * depth
    return np.where(np.isfinite(ground), rise, -np.inf)
