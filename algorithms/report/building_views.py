"""Views of single buildings: their points from above and from the side, as SVG within the page."""

from __future__ import annotations

import html
from typing import Optional

import numpy as np

from ..geometry.grid import fixed_grid_over
from .page import position, svg_image

# Largest width and height of a view, pixels.
_WIDTH, _HEIGHT = 340, 240

# Width of the surroundings of a building in its view, m.
_AROUND = 4.0

# Height left empty below the lowest and above the highest point of a view from the south, m.
_ROOM = 1.0

# Colors of a view (red, green, blue): background, other points, points of buildings.
_COLORS = np.array([[255, 255, 255], [187, 187, 187], [187, 85, 102]])

# Pixels of the dot of a point, from its middle: right, up.
_DOT = ((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1))

# Side of the cells by which the points around a building are found, m.
_CELL = 25.0


class Views:
    """The points of a cloud (n, 3), m, and which are of buildings (n,), by cells in plan."""

    def __init__(self, xyz: np.ndarray, is_building: np.ndarray) -> None:
        self.xyz, self.is_building = xyz, is_building
        self._grid = fixed_grid_over(xyz, _CELL)
        number = self._grid.number(xyz)
        self._order = np.argsort(number, kind="stable")
        self._number = number[self._order]

    def near(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return the rows of the points in a box in plan."""
        steps = [np.arange(start, end + _CELL, _CELL) for start, end in zip(low, high)]
        corners = np.stack(np.meshgrid(*(np.append(one[:-1], end) for one, end in zip(steps, high))), axis=-1)
        cells = np.unique(self._grid.number(corners.reshape(-1, 2)))
        starts, ends = (np.searchsorted(self._number, cells, side=side) for side in ("left", "right"))
        rows = np.concatenate([self._order[start:end] for start, end in zip(starts, ends)])
        plan = self.xyz[rows, :2]
        return rows[((plan >= low) & (plan <= high)).all(axis=1)]


def boxes_around(geometries: list) -> np.ndarray:
    """Return the boxes (k, 2, 2), m, that the views of some buildings (rings of each, m) show."""
    outer = [np.asarray(rings[0])[:, :2] for rings in geometries]
    boxes = [(ring.min(axis=0) - _AROUND, ring.max(axis=0) + _AROUND) for ring in outer]
    return np.array(boxes).reshape(-1, 2, 2)


def draw_views(views: Views, geometries: list, captions: list[str]) -> str:
    """Return the HTML of the views of doubtful buildings (rings of each, m), each under its caption."""
    parts = ["<h2>Doubtful buildings</h2>"]
    parts.append("<p>From above with the footprint, and from the south. Points of buildings are red.</p>")
    for rings, (low, high), caption in zip(geometries, boxes_around(geometries), captions):
        outer = np.asarray(rings[0])[:, :2]
        rows = views.near(low, high)
        xyz, is_building = views.xyz[rows], views.is_building[rows]
        middle = position(*((low + high) / 2).tolist())
        parts.append(f'<div class="building"><p>{html.escape(caption)} At {middle}.</p>')
        parts.append(_view(xyz[:, :2], xyz[:, 2], is_building, low, high, outer))
        if len(xyz):
            floor, top = xyz[:, 2].min() - _ROOM, xyz[:, 2].max() + _ROOM
            ends = np.array([low[0], floor]), np.array([high[0], top])
            parts.append(_view(xyz[:, [0, 2]], -xyz[:, 1], is_building, *ends, None))
        parts.append("</div>")
    return "\n".join(parts)


def _view(
    plan: np.ndarray,
    depth: np.ndarray,
    is_building: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    ring: Optional[np.ndarray],
) -> str:
    """Return the SVG of points (n, 2), those of the greatest ``depth`` (n,) drawn last, and of a ring (m, 2) over them.

    All are in meters within the box from ``low`` to ``high`` (2,).
    """
    size = float(max((high - low) / (_WIDTH, _HEIGHT)))
    columns, lines = np.maximum(np.ceil((high - low) / size), 1).astype(int)
    image = np.zeros((lines, columns), np.uint8)
    order = np.argsort(depth, kind="stable")
    column, row = ((plan[order] - low) / size).astype(int).T
    for right, up in _DOT:
        image[np.clip(row + up, 0, lines - 1), np.clip(column + right, 0, columns - 1)] = 1 + is_building[order]
    drawn = svg_image(image[::-1], _COLORS, (0.0, 0.0, columns, lines))
    outline = ""
    if ring is not None:
        points = " ".join(f"{x:.1f},{lines - y:.1f}" for x, y in (ring - low) / size)
        outline = f'<polygon points="{points}" fill="none" stroke="#222" stroke-width="1.2"/>'
    return (
        f'<svg class="view" viewBox="0 0 {columns} {lines}" width="{columns}" height="{lines}">{drawn}{outline}</svg>'
    )
