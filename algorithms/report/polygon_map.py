"""A map of polygons in the colors of their kinds, for the quality pages."""

from __future__ import annotations

import html

import numpy as np

# Width of the map and its greatest height, in units of the picture.
_WIDTH, _HEIGHT = 720.0, 900.0


def draw_polygons(geometries: list, kinds: list[str], colors: dict[str, str]) -> str:
    """Return the HTML of a map, north up.

    Parameters
    ----------
    geometries : list of list of ndarray of shape (k, 2)
        Polygons as rings, m.
    kinds : list of str
        The kind of each.
    colors : dict
        The color of each kind, in the order of the legend. The last kinds are drawn on top.
    """
    if not geometries:
        return ""
    corners = np.concatenate([rings[0] for rings in geometries])
    low, extent = corners.min(axis=0), np.maximum(np.ptp(corners, axis=0), 1e-3)
    scale = min(_WIDTH / extent[0], _HEIGHT / extent[1])
    width, height = extent * scale
    order = sorted(range(len(kinds)), key=lambda row: list(colors).index(kinds[row]))
    paths = [" ".join(_path((ring - low) * scale, height) for ring in rings) for rings in geometries]
    shapes = [f'<path fill="{colors[kinds[row]]}" d="{paths[row]}"/>' for row in order]
    legend = "".join(
        f'<span class="swatch" style="background:{color}"></span>{html.escape(kind)}' for kind, color in colors.items()
    )
    caption = f"The map is {extent[0]:,.0f} m wide and {extent[1]:,.0f} m high, north is up."
    return (
        f'<h2>Map</h2>\n<p>{legend}</p>\n<svg role="img" aria-label="Map of the buildings" '
        f'viewBox="-2 -2 {width + 4:.0f} {height + 4:.0f}" width="{width + 4:.0f}" fill-rule="evenodd" '
        f'stroke="#222" stroke-width="0.5">{"".join(shapes)}</svg>\n<p>{caption}</p>'
    )


def _path(ring: np.ndarray, height: float) -> str:
    return "M" + " ".join(f"{x:.1f},{height - y:.1f}" for x, y in ring[:-1].tolist()) + "Z"
