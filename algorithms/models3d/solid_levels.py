"""Heights at the vertices of a divided footprint: one for each plane there, one where planes meet."""

import math
from collections import defaultdict

import numpy as np

from ..criteria import MILLIMETER, PARALLEL
from ..geometry.subdivision import OUTSIDE, SNAP, Subdivision, loop_area
from .solids import DECIMALS, RESOLUTION, edges_around

# Planes that intersect within this distance (m) of a vertex, in plan, meet in it: the snapping distance of cuts.
_MEET = 2 * SNAP

# Heights at one position that differ by at most this (m) become their mean. Two planes then move by half of it, less
# than the 0.01 m that corners may be off a face. If up to three planes meet, the vertex moves and the planes stay.
_SAME_HEIGHT = 0.016

# The outline of a footprint is kept within this distance (m): a vertex that close to the line between its neighbors is
# no corner.
ON_OUTLINE = 0.005

# Number beyond the outline, in place of a plane: the ground.
BASE = -1

# Vertical thickness (m) of roofs over eaves: rafters, boards and tiles.
_THICKNESS = 0.25

# Easting, northing and height (m).
Position = tuple[float, float, float]


class Levels:
    """Heights at the vertices of a partition: one for each plane there, and one of planes that meet.

    Vertices move in plan, by centimeters, to where the planes next to them intersect: faces stay plane.

    ``label`` (cells,) is the plane of each cell, -1 outside; ``coefficients`` (m, 3) are of z = a x + b y + c;
    ``base`` (m) is the height of the ground.
    """

    def __init__(self, cells: Subdivision, label: np.ndarray, coefficients: np.ndarray, base: float) -> None:
        self.cells, self.label, self.base = cells, label.tolist(), round(base, DECIMALS)
        self.coefficients = [tuple(row) for row in coefficients.tolist()]
        # What each cell ends in below: the ground, or the number of its soffit.
        self.bottom = [BASE] * len(self.label)
        # Per vertex: its planes, the vertices joined to it by an edge, and the same along the outline.
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
        # The positions, and the number of each by vertex and plane.
        self.number: dict[tuple[int, int], int] = {}
        self.positions: list[Position] = []
        for vertex, planes in self.around.items():
            if len(planes) > 1:
                self._move_to_intersection(vertex, sorted(planes))
            if vertex in self._outline:
                planes.add(BASE)
        self._join_close_vertices()
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
        """Move a vertex to where the planes that nearly meet in it intersect, along the outline if it lies on that."""
        (x, y), coefficients = self.plan[vertex], np.array([self.coefficients[plane] for plane in planes])
        one, other = np.triu_indices(len(planes), 1)
        difference = coefficients[one] - coefficients[other]
        turn = np.hypot(difference[:, 0], difference[:, 1])
        apart = difference @ [x, y, 1.0]
        is_near = (turn > 0) & (np.abs(apart) <= _MEET * turn)
        if not (np.abs(apart[is_near]) >= RESOLUTION * turn[is_near]).any():
            return
        # Where it may go: anywhere, or along the outline.
        ways = np.eye(2)
        for neighbor in self._outline.get(vertex, ())[:1]:
            ways = np.subtract(self.plan[neighbor], (x, y))[:, None] / math.dist(self.plan[neighbor], (x, y))
        step = ways @ np.linalg.lstsq(difference[is_near, :2] @ ways, -apart[is_near], PARALLEL)[0]
        if np.hypot(*step) <= _MEET:
            self._move(vertex, tuple(step.tolist()))

    def _step_to_one_height(self, planes: list[int], plan: tuple[float, float]) -> tuple[float, float]:
        """Return the step (m) from a position to where planes are nearest to having one height."""
        rows = np.array([self.coefficients[plane] for plane in planes])
        height = rows @ [*plan, 1.0]
        factors = np.column_stack([rows[:, :2], -np.ones(len(rows))])
        x, y, _ = np.linalg.lstsq(factors, height.mean() - height, rcond=None)[0].tolist()
        return x, y

    def _move(self, vertex: int, step: tuple[float, float]) -> None:
        """Move a vertex by a step (m) if the cells around it keep their orientation."""
        x, y = before = self.plan[vertex]
        self.plan[vertex] = x + step[0], y + step[1]
        loops = [self.cells.loops[self.cells.cell_of[vertex, other]] for other in self._spokes[vertex]]
        if any(loop_area([self.plan[v] for v in loop]) <= 0 for loop in loops):
            self.plan[vertex] = before

    def _join_close_vertices(self) -> None:
        """Join the ends of edges that are shorter than cuts snap to vertices.

        The outline keeps its corners, and no position gets more heights than it had: walls would come of it.
        """
        for u, v in list(self.cells.cell_of):
            is_present = (u, v) in self.cells.cell_of and len(self.around[u]) > 1 and len(self.around[v]) > 1
            if is_present and math.dist(self.plan[u], self.plan[v]) < SNAP:
                _ = self._join(u, v) or self._join(v, u)

    def _join(self, kept: int, gone: int) -> bool:
        """Join a vertex to the one that is kept, unless it is a corner of the outline; return whether that was done."""
        planes = self.around[kept] | self.around[gone]
        options = [self.plan[kept]]
        if BASE in self.around[gone]:
            if not self._is_on_straight_outline(gone, kept):
                return False
        elif BASE not in planes:
            x, y = self.plan[kept]
            step = self._step_to_one_height(sorted(planes), (x, y))
            options += [self.plan[gone], (x + step[0], y + step[1])]
        most = max(len(self._groups(self.plan[one], self.around[one])) for one in (kept, gone))
        near = (plan for plan in options if math.dist(plan, self.plan[kept]) <= _MEET)
        return any(len(self._groups(plan, planes)) <= most and self._join_at(kept, gone, plan) for plan in near)

    def _is_on_straight_outline(self, vertex: int, neighbor: int) -> bool:
        """Return whether the outline goes on straight at a vertex from one of its neighbors."""
        beside = set(self._outline[vertex])
        if len(beside) != 2 or neighbor not in beside:
            return False
        (beyond,) = beside - {neighbor}
        (x0, y0), (x1, y1), (x, y) = (self.plan[v] for v in (neighbor, beyond, vertex))
        across = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
        return abs(across) < ON_OUTLINE * math.hypot(x1 - x0, y1 - y0)

    def _join_at(self, kept: int, gone: int, plan: tuple[float, float]) -> bool:
        """Join two vertices at a position if no cell turns over or falls apart; return whether they were joined.

        A cell that has two vertices left is gone.
        """
        cells, moved = self.cells, {kept: plan}
        around = dict.fromkeys(cells.cell_of[v, other] for v in (kept, gone) for other in self._spokes[v])
        replaced = {edge for cell in around for edge in edges_around(cells.loops[cell])}
        loops, edges = {}, {}
        for cell in around:
            loop = [kept if v == gone else v for v in cells.loops[cell]]
            loop = [v for v, before in zip(loop, [loop[-1], *loop]) if v != before]
            loops[cell] = loop if len(loop) > 2 else []
            new = edges_around(loops[cell])
            is_taken = any(edge in edges or (edge in cells.cell_of and edge not in replaced) for edge in new)
            if is_taken or len(set(loop)) < len(loop):
                return False
            if new and loop_area([moved.get(v, self.plan[v]) for v in loop]) <= 0:
                return False
            edges.update(dict.fromkeys(new, cell))
        for edge in replaced:
            del cells.cell_of[edge]
        cells.cell_of.update(edges)
        for cell, loop in loops.items():
            cells.loops[cell] = loop
        self.plan[kept] = cells.vertices[kept] = plan
        self.around[kept] |= self.around.pop(gone)
        for links in (self._spokes, self._outline):
            if gone in links:
                links[kept] += links.pop(gone)
            for vertex in {kept, *links.get(kept, ())} - {gone}:
                joined = dict.fromkeys(kept if other == gone else other for other in links[vertex])
                links[vertex] = [v for v in joined if v != vertex]
        return True

    def _groups(self, plan: tuple[float, float], planes: set[int]) -> list[list[tuple[float, int]]]:
        """Return the heights (m) of planes at a position, with these, in groups that become one."""
        groups: list[list[tuple[float, int]]] = []
        for height, plane in sorted((self._height_at(plane, plan), plane) for plane in planes):
            if not groups or height - groups[-1][0][0] > _SAME_HEIGHT:
                groups.append([])
            groups[-1].append((height, plane))
        return groups

    def _number(self, vertex: int) -> None:
        """Give numbers to the positions at a vertex."""
        x, y = self.plan[vertex]
        plan = self.plan[vertex] = round(x, DECIMALS), round(y, DECIMALS)
        for group in self._groups(plan, self.around[vertex]):
            is_ground = any(plane == BASE for _, plane in group)
            z = self.base if is_ground else round(sum(height for height, _ in group) / len(group), DECIMALS)
            for _, plane in group:
                self.number[vertex, plane] = len(self.positions)
            self.positions.append((*plan, z))

    def part_crossing_roofs(self, rise: float = 0.0) -> None:
        """Put a vertex where one of two planes next to an edge comes from below the other one, raised (m) if asked."""
        for u, v in list(self.cells.cell_of):
            if u > v:
                continue
            one, other = self.label[self.cells.cell_of[u, v]], self.plane_beyond(u, v)
            if one == other or BASE in (one, other):
                continue
            at_u = self.height(u, one) - self.height(u, other) - rise
            at_v = self.height(v, one) - self.height(v, other) - rise
            if at_u * at_v >= 0 or min(abs(at_u), abs(at_v)) < MILLIMETER:
                continue
            share = at_u / (at_u - at_v)
            (x0, y0), (x1, y1) = self.plan[u], self.plan[v]
            new = self.cells.insert(u, v, (x0 + share * (x1 - x0), y0 + share * (y1 - y0)))
            self.plan.append(self.cells.vertices[new])
            self.around[new] = {one, other}
            self._number(new)

    def overhang(self, is_eave: np.ndarray) -> None:
        """Let cells (cells,), bool, end in a soffit that is parallel to their roof, and not on the ground."""
        for rise in (_THICKNESS, -_THICKNESS):
            self.part_crossing_roofs(rise)
        at: dict[int, set[int]] = defaultdict(set)
        for (vertex, _), number in self.number.items():
            at[vertex].add(number)
        for cell, plane in enumerate(self.label):
            if plane < 0:
                continue
            if is_eave[cell]:
                self.bottom[cell] = BASE - 1 - plane
            for vertex in self.cells.loops[cell]:
                x, y, z = self.positions[self.number[vertex, plane]]
                z = round(z - _THICKNESS, DECIMALS) if is_eave[cell] else self.base
                same = [number for number in at[vertex] if abs(self.positions[number][2] - z) < MILLIMETER]
                self.number[vertex, self.bottom[cell]] = new = same[0] if same else len(self.positions)
                if not same:
                    self.positions.append((x, y, z))
                    at[vertex].add(new)

    def crowded(self) -> list[int]:
        """Return the vertices where more than two walls would meet in an edge."""
        some = [vertex for vertex, planes in self.around.items() if len(planes) > 1]
        return [vertex for vertex in some if is_crowded(self._heights_around(vertex))]

    def _heights_around(self, vertex: int) -> list[float]:
        return [self.height(vertex, self.label[cell]) for cell in self.cells_around(vertex)]

    def cells_around(self, vertex: int) -> list[int]:
        """Return the cells around a vertex within the rectangle, counterclockwise."""
        following = {}
        for v in self._spokes[vertex]:
            cell = self.cells.cell_of[vertex, v]
            loop = self.cells.loops[cell]
            following[v] = (cell, loop[loop.index(vertex) - 1])
        start = spoke = next(iter(following))
        ring = []
        while True:
            cell, spoke = following[spoke]
            ring.append(cell)
            if spoke == start:
                return ring


def is_crowded(heights: list[float]) -> bool:
    """Return whether a ring of heights turns between up and down more than twice: four walls would meet in an edge."""
    steps = [b - a for a, b in zip(heights, [*heights[1:], heights[0]]) if abs(b - a) > 1e-9]
    return sum(a * b < 0 for a, b in zip(steps, [*steps[1:], *steps[:1]])) > 2
