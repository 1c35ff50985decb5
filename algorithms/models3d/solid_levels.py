"""Heights at the vertices of a divided footprint: one for each plane there, one where planes meet."""

from __future__ import annotations

import math
from collections import defaultdict

import numpy as np

from ..geometry.subdivision import OUTSIDE, SNAP, Subdivision, loop_area
from .solids import DECIMALS

# Planes that intersect within this distance (m) of a vertex, in plan, meet in it: cuts pass that closely to vertices.
_MEET = 2 * SNAP

# Heights at one position that differ by at most this (m) become one: planes stay plane to half of that, where more than
# three nearly meet.
_SAME_HEIGHT = 0.016

# Vertices stay where planes meet to this (m).
_EXACT = 0.0001

# Lines that turn by less than this (sine) have no intersection to go to.
_LEAST_TURN = 0.05

# What is beyond the outline in place of a plane: the ground.
BASE = -1

# Easting, northing and height (m).
Position = tuple[float, float, float]

# A line in plan: its unit normal (x, y) and its distance along that from a position (m).
_Line = tuple[float, float, float]

# As many changes between up and down around a vertex are one edge with four walls.
_CROWD = 4

# More planes than this have no point in common but by chance.
_IN_A_POINT = 3


class Levels:
    """Heights at the vertices of a partition: one for each plane there, and one of planes that meet.

    Vertices move in plan, by centimeters, to where the planes beside them intersect: faces stay plane.

    Parameters
    ----------
    cells : Subdivision
        The cells.
    label : ndarray of shape (cells,)
        Plane of each cell, -1 outside.
    coefficients : ndarray of shape (m, 3)
        The planes z = a x + b y + c.
    base : float
        Height of the ground (m).
    """

    def __init__(self, cells: Subdivision, label: np.ndarray, coefficients: np.ndarray, base: float) -> None:
        self.cells, self.label, self.base = cells, label.tolist(), round(base, DECIMALS)
        self.coefficients = [tuple(row) for row in coefficients.tolist()]
        self.around: dict[int, set[int]] = defaultdict(set)
        self._spokes: dict[int, list[int]] = defaultdict(list)
        self._outline: dict[int, list[int]] = defaultdict(list)
        for (u, v), cell in cells.cell_of.items():
            self._spokes[u].append(v)
            if self.label[cell] >= 0:
                self.around[u].add(self.label[cell])
                if self.plane_beyond(u, v) == BASE:
                    self._outline[u].append(v)
                    self._outline[v].append(u)
        self.plan = list(cells.vertices)
        self.number: dict[tuple[int, int], int] = {}
        self.positions: list[Position] = []
        for vertex, planes in self.around.items():
            if len(planes) > 1:
                self._move_to_intersection(vertex, sorted(planes))
            if vertex in self._outline:
                planes.add(BASE)
        for vertex in self.around:
            self._number(vertex)

    def plane_beyond(self, u: int, v: int) -> int:
        """Return the plane to the right of an edge, the ground beyond the outline."""
        cell = self.cells.cell_of.get((v, u), OUTSIDE)
        return BASE if cell == OUTSIDE else self.label[cell]

    def height(self, vertex: int, plane: int) -> float:
        """Return the height (m) at which a plane, or the ground, is at a vertex."""
        return self.positions[self.number[vertex, plane]][2]

    def _height_at(self, plane: int, plan: tuple[float, float]) -> float:
        if plane == BASE:
            return self.base
        a, b, c = self.coefficients[plane]
        return a * plan[0] + b * plan[1] + c

    def _move_to_intersection(self, vertex: int, planes: list[int]) -> None:
        """Move a vertex to where planes intersect, on the outline if it lies on that, or else by less."""
        plan = self.plan[vertex]
        meeting = self._meeting(planes, plan)
        if not meeting or meeting[-1][0] < _EXACT:
            return
        near = sorted({plane for _, _, pair in meeting for plane in pair})
        if len(near) > _IN_A_POINT and vertex not in self._outline:
            step = self._nearest_point(near, plan)
            if math.hypot(*step) <= _MEET and self._keeps_cells(vertex, (plan[0] + step[0], plan[1] + step[1])):
                self.plan[vertex] = plan[0] + step[0], plan[1] + step[1]
                return
        along = [self._across(plan, self.plan[other]) for other in self._outline.get(vertex, ())]
        for lines, farthest in ((along, _MEET), ([], SNAP)) if along else (([], _MEET),):
            step = _common_step([*lines, *(line for _, line, _ in meeting)], farthest)
            moved = plan[0] + step[0], plan[1] + step[1]
            if step != (0.0, 0.0) and self._keeps_cells(vertex, moved):
                self.plan[vertex] = moved
                return

    def _meeting(self, planes: list[int], plan: tuple[float, float]) -> list[tuple[float, _Line, tuple[int, int]]]:
        """Return the lines in which planes intersect near a position, each with its distance (m); nearest first."""
        found = []
        for i, one in enumerate(planes):
            a, b, c = self.coefficients[one]
            for other in planes[i + 1 :]:
                d, e, f = self.coefficients[other]
                turn = math.hypot(a - d, b - e)
                step = (a - d) * plan[0] + (b - e) * plan[1] + c - f
                if turn > 0 and abs(step) <= _MEET * turn:
                    found.append((abs(step) / turn, ((a - d) / turn, (b - e) / turn, -step / turn), (one, other)))
        return sorted(found)

    def _nearest_point(self, planes: list[int], plan: tuple[float, float]) -> tuple[float, float]:
        """Return the step (m) from a position to where planes are nearest to having one height."""
        rows = np.array([self.coefficients[plane] for plane in planes])
        height = rows @ [*plan, 1.0]
        step = np.linalg.lstsq(np.column_stack([rows[:, :2], -np.ones(len(rows))]), height.mean() - height, rcond=None)[
            0
        ]
        return float(step[0]), float(step[1])

    @staticmethod
    def _across(plan: tuple[float, float], other: tuple[float, float]) -> _Line:
        """Return the line from a position to another one."""
        x, y = other[0] - plan[0], other[1] - plan[1]
        length = math.hypot(x, y)
        return -y / length, x / length, 0.0

    def _keeps_cells(self, vertex: int, moved: tuple[float, float]) -> bool:
        """Return whether the cells around a vertex keep their orientation when it is moved."""
        before, self.plan[vertex] = self.plan[vertex], moved
        loops = [self.cells.loops[self.cells.cell_of[vertex, other]] for other in self._spokes[vertex]]
        kept = all(loop_area([self.plan[v] for v in loop]) > 0 for loop in loops)
        self.plan[vertex] = before
        return kept

    def _number(self, vertex: int) -> None:
        """Give numbers to the positions at a vertex."""
        x, y = self.plan[vertex]
        plan = self.plan[vertex] = round(x, DECIMALS), round(y, DECIMALS)
        group: list[tuple[float, int]] = []
        for height, plane in sorted((self._height_at(plane, plan), plane) for plane in self.around[vertex]):
            if group and height - group[0][0] > _SAME_HEIGHT:
                self._enter(vertex, group)
                group = []
            group.append((height, plane))
        self._enter(vertex, group)

    def _enter(self, vertex: int, group: list[tuple[float, int]]) -> None:
        is_ground = any(plane == BASE for _, plane in group)
        z = self.base if is_ground else round(sum(height for height, _ in group) / len(group), DECIMALS)
        for _, plane in group:
            self.number[vertex, plane] = len(self.positions)
        self.positions.append((*self.plan[vertex], z))

    def part_crossing_roofs(self) -> None:
        """Put a vertex where one of two planes beside an edge comes from below the other."""
        for u, v in list(self.cells.cell_of):
            if u > v:
                continue
            one, other = self._planes_beside(u, v)
            if one == other or BASE in (one, other):
                continue
            at_u = self.height(u, one) - self.height(u, other)
            at_v = self.height(v, one) - self.height(v, other)
            if at_u * at_v >= 0:
                continue
            share = at_u / (at_u - at_v)
            (x0, y0), (x1, y1) = self.plan[u], self.plan[v]
            new = self.cells.insert(u, v, (x0 + share * (x1 - x0), y0 + share * (y1 - y0)))
            self.plan.append(self.cells.vertices[new])
            self.around[new] = {one, other}
            self._number(new)

    def _planes_beside(self, u: int, v: int) -> tuple[int, int]:
        cell = self.cells.cell_of[u, v]
        return self.label[cell], self.plane_beyond(u, v)

    def crowded(self) -> list[int]:
        """Return the vertices where more than two walls would meet in an edge."""
        # Four changes between up and down need four cells.
        some = [v for v, planes in self.around.items() if len(planes) > 1 and len(self._spokes[v]) >= _CROWD]
        return [vertex for vertex in some if self._is_crowded(vertex)]

    def _is_crowded(self, vertex: int) -> bool:
        planes = [self.label[cell] for cell in self.cells_around(vertex)]
        return turns_around([self.height(vertex, plane) for plane in planes]) >= _CROWD

    def cells_around(self, vertex: int) -> list[int]:
        """Return the cells around a vertex within the rectangle, counterclockwise."""
        following = {}
        for v in self._spokes[vertex]:
            cell = self.cells.cell_of[vertex, v]
            loop = self.cells.loops[cell]
            following[v] = (cell, loop[loop.index(vertex) - 1])
        start = here = next(iter(following))
        ring = []
        while True:
            cell, here = following[here]
            ring.append(cell)
            if here == start:
                return ring


def turns_around(heights: list[float]) -> int:
    """Return how often a ring of heights changes between up and down."""
    steps = [b - a for a, b in zip(heights, [*heights[1:], heights[0]]) if abs(b - a) > 1e-9]
    return sum(a * b < 0 for a, b in zip(steps, [*steps[1:], *steps[:1]]))


def _common_step(lines: list[_Line], farthest: float) -> tuple[float, float]:
    """Return the shortest step (m) onto lines (nx, ny, offset), in this order; those that it can't reach are left out.

    Steps are not longer than ``farthest``.
    """
    first, step, is_point = None, (0.0, 0.0), False
    for line in lines:
        nx, ny, offset = line
        if abs(nx * step[0] + ny * step[1] - offset) <= _EXACT:
            first = first or line
            continue
        if is_point:
            continue
        if first is None:
            wanted = nx * offset, ny * offset
        else:
            mx, my, other = first
            turn = mx * ny - my * nx
            if abs(turn) < _LEAST_TURN:
                continue
            wanted = (other * ny - offset * my) / turn, (mx * offset - nx * other) / turn
        if math.hypot(*wanted) <= farthest:
            step, is_point = wanted, first is not None
            first = first or line
    return step
