"""Houses whose walls are known, and what a raster of cells shows of them."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from lidar_buildings.algorithms.geometry.cell_outlines import outline_cells
from lidar_buildings.algorithms.geometry.grid import Grid
from lidar_buildings.algorithms.models3d.roof_partition import inside_rings

# Side (m) of the cells.
CELL = 0.5


def box(west, south, width, depth, turn=25.0):
    """Return a closed ring around a house, turned about the zero (°)."""
    corners = np.array([[0, 0], [width, 0], [width, depth], [0, depth], [0, 0.0]]) + [west, south]
    cosine, sine = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    return corners @ np.array([[cosine, sine], [-sine, cosine]])


def traced(polygons, noise=0.0, seed=0, cell=CELL):
    """Return the outlines of the cells that polygons hold, of their largest parts; the first that holds one has it."""
    places = np.concatenate([ring for rings in polygons for ring in rings])
    low, shape = places.min(axis=0) - 2, np.ceil((np.ptp(places, axis=0)[::-1] + 4) / cell).astype(int)
    row, column = np.indices(shape).reshape(2, -1)
    middles = low + (np.column_stack([column, row]) - 0.5) * cell
    middles = middles + np.random.default_rng(seed).normal(0, noise, middles.shape)
    free, made = np.ones(len(middles), bool), []
    for rings in polygons:
        part = ndimage.label((inside_rings(middles, rings) & free).reshape(shape))[0].ravel()
        own = np.flatnonzero(part == 1 + np.bincount(part)[1:].argmax())
        free[own] = False
        made.append(outline_cells(Grid(low, cell, *shape), own, np.zeros(len(own), int))[0])
    return [rings if len(before) > 1 else rings[:1] for rings, before in zip(made, polygons)]
