"""Views of single buildings: their points from above and in sections, as SVG."""

import html

import numpy as np

from ..geometry.grid import fixed_grid_over, plan_box
from .page import position, svg_image

# Largest width and height of a view, pixels.
_WIDTH, _HEIGHT = 340, 240

# Width of the surroundings of a building in its view, m.
AROUND = 4.0

# Colors of the sections along and across a building.
_CUTS = ("#004488", "#aa4499")

# Colors of a view (red, green, blue): background, other points, points of buildings.
_COLORS = np.array([[255, 255, 255], [187, 187, 187], [187, 85, 102]])

# Pixels of the dot of a point, from its middle: right, up.
_DOT = ((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1))


class Views:
    """The points of a cloud (n, 3), m, and which are of buildings (n,), by cells in plan."""

    def __init__(self, xyz: np.ndarray, is_building: np.ndarray) -> None:
        self.xyz, self.is_building = xyz, is_building
        # Cells by which the points around a building are found; any size gives the same points.
        self._grid = fixed_grid_over(xyz, AROUND)
        number = self._grid.number(xyz)
        self._order = np.argsort(number, kind="stable")
        self._number = number[self._order]

    def near(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return the rows of the points in a box in plan."""
        steps = [np.arange(start, end + AROUND, AROUND) for start, end in zip(low, high)]
        corners = np.stack(np.meshgrid(*(np.append(one[:-1], end) for one, end in zip(steps, high))), axis=-1)
        cells = np.unique(self._grid.number(corners.reshape(-1, 2)))
        starts, ends = (np.searchsorted(self._number, cells, side=side) for side in ("left", "right"))
        rows = np.concatenate([self._order[start:end] for start, end in zip(starts, ends)])
        plan = self.xyz[rows, :2]
        return rows[((plan >= low) & (plan <= high)).all(axis=1)]


def boxes_around(geometries: list) -> np.ndarray:
    """Return the boxes (k, 2, 2), m, that the views of some buildings (rings of each, m) show."""
    boxes = [plan_box(np.asarray(rings[0])) + [[-AROUND], [AROUND]] for rings in geometries]
    return np.array(boxes).reshape(-1, 2, 2)


def draw_views(views: Views, geometries: list, captions: list[str]) -> str:
    """Return the HTML of the views of doubtful buildings (rings of each, m), each under its caption."""
    parts = ["<h2>Doubtful buildings</h2>"]
    parts.append(
        "<p>From above with the footprint, and in sections of 2 m along and across it. Points of buildings are red.</p>"
    )
    for rings, (low, high), caption in zip(geometries, boxes_around(geometries), captions):
        rows = views.near(low, high)
        middle = position(*((low + high) / 2).tolist())
        parts.append(f'<div class="building"><p>{html.escape(caption)} At {middle}.</p>')
        parts += draw_sections(views.xyz[rows], views.is_building[rows], np.asarray(rings[0])[:, :2])
        parts.append("</div>")
    return "\n".join(parts)


def draw_sections(xyz: np.ndarray, kind: np.ndarray, ring: np.ndarray, colors: np.ndarray = _COLORS) -> list[str]:
    """Return the SVGs of the points around a building: from above, and in sections along and across its middle.

    Parameters
    ----------
    xyz, kind : ndarray of shape (n, 3) and (n,)
        Coordinates (m), and which color each point has, counted from the second. Without points there are no sections.
    ring : ndarray of shape (m, 2)
        Closed outline of the building, m. Its longest side is the direction of the first section.
    colors : ndarray of shape (k, 3)
        Red, green and blue of the background and of the points.
    """
    sides = np.diff(ring, axis=0)
    east, north = sides[np.argmax(np.hypot(*sides.T))]
    axes = np.array([[east, -north], [north, east]]) / np.hypot(east, north)
    turned, corners = xyz[:, :2] @ axes, ring @ axes
    ends = plan_box(corners)
    lines, sections = [(ring, "#222")], []
    for axis, color in enumerate(_CUTS if len(xyz) else ()):
        cut = np.repeat([ends.mean(axis=0)], 2, axis=0)
        # At one point per square meter each roof has points in a section of 2 m.
        is_in = np.abs(turned[:, 1 - axis] - cut[0, 1 - axis]) <= 1.0
        cut[:, axis] = ends[:, axis] + (-AROUND, AROUND)
        lines.append((cut @ axes.T, color))
        seen = xyz[is_in, 2] if is_in.any() else xyz[:, 2]
        heights = np.array([seen.min() - 1.0, seen.max() + 1.0])
        walls = [(np.column_stack([[at, at], heights]), color) for at in ends[:, axis]]
        plane = np.column_stack([turned[:, axis], xyz[:, 2]])[is_in]
        sections.append(_view(plane, kind[is_in], np.column_stack([cut[:, axis], heights]), walls, colors))
    return [_view(xyz, kind, boxes_around([[ring]])[0], lines, colors), *sections]


def _view(
    points: np.ndarray, kind: np.ndarray, box: np.ndarray, lines: list[tuple[np.ndarray, str]], colors: np.ndarray
) -> str:
    """Return the SVG of points (n, 2 or 3), the highest drawn last, and of lines (k, 2) over them, each with its color.

    All are in meters within a box (2, 2) of the first two axes; the last one is the height.
    """
    low, high = box
    size = float(max((high - low) / (_WIDTH, _HEIGHT)))
    columns, rows = np.maximum(np.ceil((high - low) / size), 1).astype(int)
    image = np.zeros((rows, columns), np.uint8)
    order = np.argsort(points[:, -1], kind="stable")
    column, row = ((points[order, :2] - low) / size).astype(int).T
    for right, up in _DOT:
        image[np.clip(row + up, 0, rows - 1), np.clip(column + right, 0, columns - 1)] = 1 + kind[order]
    drawn = svg_image(image[::-1], colors, (0.0, 0.0, columns, rows))
    for line, color in lines:
        points = " ".join(f"{x:.1f},{rows - y:.1f}" for x, y in (line - low) / size)
        drawn += f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="1.2"/>'
    names = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    return f'<svg class="view" {names} viewBox="0 0 {columns} {rows}" width="{columns}" height="{rows}">{drawn}</svg>'
