"""A map of polygons in the colors of their kinds, for the pages; on request over the shaded surface of points."""

import html
from typing import Optional

import numpy as np

from ..geometry.grid import plan_box
from .hillshade import draw_hillshade
from .page import draw_legend, position


def draw_polygons(
    geometries: list, kinds: list[str], colors: dict[str, str], xyz: Optional[np.ndarray] = None, what: str = ""
) -> str:
    """Return the HTML of a map, north up.

    Parameters
    ----------
    geometries : list of list of ndarray of shape (k, 2)
        Polygons as rings, m.
    kinds : list of str
        The kind of each.
    colors : dict
        The color of each kind, in the order of the legend. The last kinds are drawn on top.
    xyz : ndarray of shape (n, 3), optional
        Points (m) whose surface is shaded below the polygons.
    what : str
        What the kinds are of, before the legend.
    """
    if not geometries:
        return ""
    corners = [np.asarray(rings[0])[:, :2] for rings in geometries]
    low, high = plan_box(np.concatenate(corners if xyz is None else [*corners, xyz[:, :2]]))
    size = np.maximum(high - low, 1e-3)
    # Width of the map and its greatest height, in units of the picture.
    scale = min(720.0 / size[0], 900.0 / size[1])
    width, height = size * scale
    order = sorted(range(len(kinds)), key=lambda row: list(colors).index(kinds[row]))
    paths = [" ".join(_path((np.asarray(ring)[:, :2] - low) * scale, height) for ring in rings) for rings in geometries]
    shapes = [f'<path fill="{colors[kinds[row]]}" d="{paths[row]}"/>' for row in order]
    legend = draw_legend(colors.items())
    below = "" if xyz is None else draw_hillshade(xyz, low, high, scale)
    return (
        f'<h2>Map</h2>\n<p>{html.escape(what)}{legend}</p>\n<svg role="img" aria-label="Map of the buildings" '
        f'viewBox="-2 -2 {width + 4:.0f} {height + 4:.0f}" width="{width + 4:.0f}" fill-rule="evenodd" '
        f'stroke="#222" stroke-width="0.5">{below}<g fill-opacity="{1.0 if xyz is None else 0.75}">{"".join(shapes)}'
        f"</g></svg>\n<p>The map is {size[0]:,.0f} m wide and {size[1]:,.0f} m high, north is up; its lower left "
        f"corner is at {position(*low.tolist())}.</p>"
    )


def _path(ring: np.ndarray, height: float) -> str:
    return "M" + " ".join(f"{x:.1f},{height - y:.1f}" for x, y in ring[:-1].tolist()) + "Z"
