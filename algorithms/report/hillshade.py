"""The surface of points, shaded, as a picture for the maps of the pages."""

import numpy as np

from ..geometry.raster_filling import nearest_known
from .page import pixel_size, svg_image

# Cells along the longest side of a map: as many as pages have pixels for it.
CELLS = 900

# Azimuth and altitude of the light (radians), as in most hillshades.
_AZIMUTH, _ALTITUDE = np.deg2rad(315.0), np.deg2rad(45.0)

# Colors that a hillshade has.
_GRAYS = np.repeat(np.arange(256)[:, None], 3, axis=1)


def draw_hillshade(xyz: np.ndarray, low: np.ndarray, high: np.ndarray, scale: float) -> str:
    """Return the SVG of the shaded surface of points (n, 3), m, on a map from ``low`` to ``high`` (2,), m.

    ``scale`` is in units of the picture per meter.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m.
    low : ndarray of shape (2,)
        Lower left corner of the map, m.
    high : ndarray of shape (2,)
        Upper right corner, m.
    scale : float
        Units of the picture per meter.
    """
    cell = pixel_size(high - low, len(xyz), CELLS)
    surface = topmost(xyz, low, cell)
    empty = np.isnan(surface)
    surface = nearest_known(surface, empty)
    image = np.where(empty, 255, 90 + 160 * _shade(surface, cell)).astype(np.uint8)
    height, (up, across) = float(high[1] - low[1]) * scale, np.array(surface.shape) * cell * scale
    return svg_image(image[::-1], _GRAYS, (0.0, height - up, across, up))


def topmost(xyz: np.ndarray, low: np.ndarray, cell: float) -> np.ndarray:
    """Return the greatest elevation (rows, columns) in each cell of a lattice from ``low`` on, NaN in empty ones, m."""
    column, row = ((xyz[:, :2] - low) / cell).astype(np.int64).T
    surface = np.full((int(row.max()) + 1, int(column.max()) + 1), np.nan)
    np.fmax.at(surface, (row, column), xyz[:, 2])
    return surface


def _shade(surface: np.ndarray, cell: float) -> np.ndarray:
    """Return the light that cells of a surface reflect, from 0 to 1."""
    rise = np.gradient(surface, cell) if min(surface.shape) > 1 else [np.zeros(surface.shape)] * 2
    light = np.sin(_AZIMUTH) * np.cos(_ALTITUDE), np.cos(_AZIMUTH) * np.cos(_ALTITUDE), np.sin(_ALTITUDE)
    shade = (light[2] - light[0] * rise[1] - light[1] * rise[0]) / np.sqrt(1 + rise[0] ** 2 + rise[1] ** 2)
    return np.clip(shade, 0, 1)
