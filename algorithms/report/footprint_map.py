"""A map of footprints as SVG within the page: colored by confidence, over a hillshade of the points."""

from __future__ import annotations

import base64
from typing import Optional

import numpy as np

from ..packages import ndimage
from .charts import BLUE, GRAY, RED, YELLOW
from .page import png

# Longest side of the map, pixels.
_SIDE = 900

# Azimuth and altitude of the light (°), as in most hillshades, and the factor of heights.
_AZIMUTH, _ALTITUDE = 315.0, 45.0

# Colors that a hillshade has.
_GRAYS = np.repeat(np.arange(256)[:, None], 3, axis=1)

# Confidence below which a building is as likely as not.
_EVEN = 0.5


def draw_footprints(geometries: list, confidence: np.ndarray, sure: float, xyz: Optional[np.ndarray]) -> str:
    """Return the HTML of a map, north up.

    Parameters
    ----------
    geometries : list
        Rings of each polygon, m.
    confidence : ndarray of shape (n,)
        Confidence of each, NaN if unknown.
    sure : float
        Confidence from which on a building is sure.
    xyz : ndarray of shape (m, 3), optional
        Points (m) whose surface is shaded below the polygons.
    """
    if not geometries:
        return "<h2>Map</h2>\n<p>There are no footprints to show.</p>"
    corners = np.concatenate([np.asarray(ring)[:, :2] for rings in geometries for ring in rings])
    extent = corners if xyz is None else np.concatenate([corners, xyz[:, :2]])
    low, high = extent.min(axis=0), extent.max(axis=0)
    size = max(float((high - low).max()) / _SIDE, 1e-3)
    width, height = (high - low) / size
    shapes = []
    for rings, value in zip(geometries, confidence):
        lines = "".join(_path((np.asarray(ring)[:, :2] - low) / size, height) for ring in rings)
        shapes.append(f'<path d="{lines}" fill="{_color(value, sure)}" fill-rule="evenodd"/>')
    below = "" if xyz is None else _hillshade(xyz, low, high, width, height)
    legend = ((BLUE, f"{sure} and more"), (YELLOW, f"{_EVEN} to {sure}"), (RED, f"below {_EVEN}"), (GRAY, "unknown"))
    swatches = "".join(f'<span class="swatch" style="background:{color}"></span>{text}' for color, text in legend)
    return (
        f"<h2>Map</h2>\n<p>Confidence:{swatches}</p>\n"
        f'<svg role="img" aria-label="Map of the footprints" viewBox="0 0 {width:.1f} {height:.1f}" '
        f'width="{width:.0f}" height="{height:.0f}">{below}'
        f'<g fill-opacity="0.75" stroke="#222" stroke-width="0.6">{"".join(shapes)}</g></svg>\n'
        f"<p>The map is {high[0] - low[0]:,.0f} m wide and {high[1] - low[1]:,.0f} m high, north is up.</p>"
    )


def _color(value: float, sure: float) -> str:
    if np.isnan(value):
        return GRAY
    return BLUE if value >= sure else YELLOW if value >= _EVEN else RED


def _path(ring: np.ndarray, height: float) -> str:
    return "M" + "L".join(f"{x:.1f} {height - y:.1f}" for x, y in ring[:-1]) + "Z"


def _hillshade(xyz: np.ndarray, low: np.ndarray, high: np.ndarray, width: float, height: float) -> str:
    """Return the surface of the points, shaded, as a picture in the map."""
    # Four points per cell on average leave few cells empty.
    cell = max(float((high - low).max()) / _SIDE, 2 * float(np.sqrt((high - low).prod() / len(xyz))), 1e-3)
    column, row = ((xyz[:, :2] - low) / cell).astype(np.int64).T
    surface = np.full((int(row.max()) + 1, int(column.max()) + 1), np.nan)
    order = np.argsort(xyz[:, 2], kind="stable")
    surface[row[order], column[order]] = xyz[order, 2]
    empty = np.isnan(surface)
    if empty.any():
        nearest = ndimage.distance_transform_edt(empty, return_distances=False, return_indices=True)
        surface = surface[tuple(nearest)]
    rise = np.gradient(surface, cell) if min(surface.shape) > 1 else [np.zeros(surface.shape)] * 2
    azimuth, altitude = np.deg2rad(_AZIMUTH), np.deg2rad(_ALTITUDE)
    light = np.sin(azimuth) * np.cos(altitude), np.cos(azimuth) * np.cos(altitude), np.sin(altitude)
    shade = (light[2] - light[0] * rise[1] - light[1] * rise[0]) / np.sqrt(1 + rise[0] ** 2 + rise[1] ** 2)
    image = np.where(empty, 255, 90 + 160 * np.clip(shade, 0, 1)).astype(np.uint8)
    data = base64.b64encode(png(image[::-1], _GRAYS)).decode()
    across, up = surface.shape[1] * cell, surface.shape[0] * cell
    scale = width / float(high[0] - low[0]) if high[0] > low[0] else 1.0
    return (
        f'<image x="0" y="{height - up * scale:.1f}" width="{across * scale:.1f}" height="{up * scale:.1f}" '
        f'preserveAspectRatio="none" href="data:image/png;base64,{data}"/>'
    )
