"""Closed solids of divided footprints: roofs on top, walls where heights differ, one level ground."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..geometry.points_in_polygons import are_within
from ..geometry.rings import signed_area
from ..geometry.subdivision import OUTSIDE, SNAP, Subdivision

ROOF, WALL, GROUND = "roof", "wall", "ground"

# Positions have as many decimals (m) as files: a corner that rounding moves by half a tenth of a millimeter turns a
# triangle 5 mm high by less than a degree.
DECIMALS = 4

# Planes that intersect within this distance (m) of a vertex, in plan, meet in it: cuts pass that closely to vertices.
_MEET = 2 * SNAP

# Heights at one position that differ by at most this (m) become one: planes stay plane to half of that, where more than
# three nearly meet.
_SAME_HEIGHT = 0.016

# Vertices stay where planes meet to this (m).
_EXACT = 0.0001

# A vertex with two edges that is off the line of their other ends by less than this (m) is superfluous.
_SUPERFLUOUS = 0.0005

# Lines that turn by less than this (sine) have no intersection to go to.
_LEAST_TURN = 0.05

# Walls whose corners are off their common plane by less than this (m) are one face.
_STRAIGHT = 0.0005

_BASE = -1

Ring = list[int]

# Easting, northing and height (m).
_Position = tuple[float, float, float]

# A line in plan: its unit normal (x, y) and its distance along that from a position (m).
_Line = tuple[float, float, float]

# As many changes between up and down around a vertex are one edge with four walls.
_CROWD = 4

# More planes than this have no point in common but by chance.
_IN_A_POINT = 3


@dataclass
class Solid:
    """A closed surface."""

    vertices: np.ndarray  #: (n, 3): positions (m)
    #: The rings of each face, exterior first: counterclockwise seen from outside the solid, holes clockwise; open (the
    #: last vertex is not the first one again)
    faces: list[list[Ring]] = field(default_factory=list)
    kinds: list[str] = field(default_factory=list)  #: "roof", "wall" or "ground"
    planes: list[int] = field(default_factory=list)  #: Of which plane a roof face is part, -1 for others

    @cached_property
    def normals(self) -> np.ndarray:
        """Vectors (faces, 3) across the faces, outward, as long as their areas (m²)."""
        rings = [ring for rings in self.faces for ring in rings]
        length = np.array([len(ring) for ring in rings])
        corner = self.vertices[np.concatenate(rings)]
        start = np.cumsum(length) - length
        offset = corner - corner[np.repeat(start, length)]
        following = np.arange(1, len(corner) + 1)
        following[start + length - 1] = start
        x, y, z = offset.T
        u, v, w = offset[following].T
        across = 0.5 * np.column_stack([y * w - z * v, z * u - x * w, x * v - y * u])
        first = np.cumsum([0, *(len(rings) for rings in self.faces[:-1])])
        return np.add.reduceat(across, start[first], axis=0)

    @property
    def volume(self) -> float:
        """Volume (m³)."""
        corner = self.vertices[[rings[0][0] for rings in self.faces]] - self.vertices.mean(axis=0)
        return float(np.einsum("ij,ij->", corner, self.normals)) / 3


def build_solid(levels: Levels) -> tuple[Solid, list[list[int]]]:
    """Return the solid between a level ground and the planes of cells, and the cells beside each of its faces.

    Parameters
    ----------
    levels : Levels
        The heights; cells get vertices where roofs cross.

    Raises
    ------
    ValueError
        If more than two faces would meet in an edge; see :func:`Levels.crowded`.
    """
    levels.part_crossing_roofs()
    return _Builder(levels).solid()


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
                if self.plane_beyond(u, v) == _BASE:
                    self._outline[u].append(v)
                    self._outline[v].append(u)
        self.plan = list(cells.vertices)
        self.number: dict[tuple[int, int], int] = {}
        self.positions: list[_Position] = []
        for vertex, planes in self.around.items():
            if len(planes) > 1:
                self._move_to_intersection(vertex, sorted(planes))
            if vertex in self._outline:
                planes.add(_BASE)
        for vertex in self.around:
            self._number(vertex)

    def plane_beyond(self, u: int, v: int) -> int:
        """Return the plane to the right of an edge, the ground beyond the outline."""
        cell = self.cells.cell_of.get((v, u), OUTSIDE)
        return _BASE if cell == OUTSIDE else self.label[cell]

    def height(self, vertex: int, plane: int) -> float:
        """Return the height (m) at which a plane, or the ground, is at a vertex."""
        return self.positions[self.number[vertex, plane]][2]

    def _height_at(self, plane: int, plan: tuple[float, float]) -> float:
        if plane == _BASE:
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
        kept = all(_loop_area([self.plan[v] for v in loop]) > 0 for loop in loops)
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
        is_ground = any(plane == _BASE for _, plane in group)
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
            if one == other or _BASE in (one, other):
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


def _loop_area(positions: list[tuple[float, float]]) -> float:
    x0, y0 = positions[0]
    offset = [(x - x0, y - y0) for x, y in positions]
    return 0.5 * sum(xa * yb - xb * ya for (xa, ya), (xb, yb) in zip(offset, [*offset[1:], offset[0]]))


@dataclass(frozen=True)
class _Wall:
    """A wall: its ring, the vertices in plan from which and to which it runs, and the cells beside it."""

    ring: Ring
    start: int
    end: int
    cells: list[int]


# Kind, plane, rings of positions, and cells of a face.
_Built = tuple[str, int, list[Ring], list[int]]


class _Builder:
    """Makes the faces of a solid."""

    def __init__(self, levels: Levels) -> None:
        self.levels, self.cells, self.label = levels, levels.cells, levels.label
        self.at: dict[int, list[int]] = defaultdict(list)
        for number, (vertex, _) in {n: key for key, n in levels.number.items()}.items():
            self.at[vertex].append(number)
        for numbers in self.at.values():
            numbers.sort(key=lambda n: levels.positions[n][2])
        self.plan = np.array(levels.positions)[:, :2]

    def solid(self) -> tuple[Solid, list[list[int]]]:
        """Return the solid without superfluous vertices, and the cells beside each face."""
        faces: list[_Built] = []
        part = self._parts()
        cells_of: dict[int, list[int]] = defaultdict(list)
        for cell, root in part.items():
            cells_of[root].append(cell)
        for (root, plane), edges in self._roof_edges(part).items():
            for rings in self._polygons(_rings(edges), upward=True):
                faces.append((ROOF, plane, rings, cells_of[root]))
        faces += [(WALL, -1, [ring], cells) for ring, cells in self._walls()]
        for rings in self._polygons(_rings(self._ground_edges()), upward=False):
            faces.append((GROUND, -1, rings, []))
        return _compact(self.levels.positions, faces), [cells for *_, cells in faces]

    def _roof_edges(self, part: dict[int, int]) -> dict[tuple[int, int], list[tuple[int, int]]]:
        """Return the edges around each connected part of a plane, by (part, plane)."""
        edges: dict[tuple[int, int], list[tuple[int, int]]] = defaultdict(list)
        number = self.levels.number
        for (u, v), cell in self.cells.cell_of.items():
            plane = self.label[cell]
            if plane >= 0 and self.levels.plane_beyond(u, v) != plane:
                edges[part[cell], plane].append((number[u, plane], number[v, plane]))
        return edges

    def _parts(self) -> dict[int, int]:
        """Return which connected part of equal planes each cell is in."""
        pairs = []
        for (u, v), cell in self.cells.cell_of.items():
            if self.label[cell] >= 0 and self.levels.plane_beyond(u, v) == self.label[cell]:
                pairs.append((cell, self.cells.cell_of[v, u]))
        group = groups_of(pairs, len(self.cells))
        return {cell: group[cell] for cell in range(len(group)) if self.label[cell] >= 0}

    def _ground_edges(self) -> list[tuple[int, int]]:
        number = self.levels.number
        return [
            (number[v, _BASE], number[u, _BASE])
            for (u, v), cell in self.cells.cell_of.items()
            if self.label[cell] >= 0 and self.levels.plane_beyond(u, v) == _BASE
        ]

    def _walls(self) -> list[tuple[Ring, list[int]]]:
        """Return the walls, those in line with each other as one, and the cells beside each."""
        walls = []
        for (u, v), cell in self.cells.cell_of.items():
            plane = self.label[cell]
            beyond = self.levels.plane_beyond(u, v)
            if plane >= 0 and beyond != plane:
                ring = self._wall(u, v, plane, beyond)
                if ring:
                    cells = [cell] if beyond == _BASE else [cell, self.cells.cell_of[v, u]]
                    walls.append(_Wall(ring, u, v, cells))
        return self._joined(walls)

    def _wall(self, u: int, v: int, plane: int, beyond: int) -> Ring:
        """Return the wall that is seen from the right of an edge, empty where what lies there is as high."""
        number, positions = self.levels.number, self.levels.positions
        low_u, low_v, high_u, high_v = number[u, beyond], number[v, beyond], number[u, plane], number[v, plane]
        if positions[low_u][2] > positions[high_u][2] or positions[low_v][2] > positions[high_v][2]:
            return []
        if low_u == high_u and low_v == high_v:
            return []
        up, down = self._between(v, low_v, high_v), self._between(u, low_u, high_u)[::-1]
        return [*up, *down]

    def _between(self, vertex: int, low: int, high: int) -> list[int]:
        """Return the positions at a vertex from one up to another one."""
        numbers = self.at[vertex]
        return numbers[numbers.index(low) : numbers.index(high) + 1]

    def _joined(self, walls: list[_Wall]) -> list[tuple[Ring, list[int]]]:
        """Return walls with neighbors in one line joined, and the cells beside each."""
        owner = {edge: i for i, wall in enumerate(walls) for edge in zip(wall.ring, [*wall.ring[1:], wall.ring[0]])}
        pairs = []
        for (a, b), i in owner.items():
            j = owner.get((b, a))
            if j is not None and j > i and self._is_upright(a, b) and self._are_in_line(walls[i], walls[j]):
                pairs.append((i, j))
        members: dict[int, list[int]] = defaultdict(list)
        for i, group in enumerate(groups_of(pairs, len(walls))):
            members[group].append(i)
        joined: list[tuple[Ring, list[int]]] = []
        for numbers in members.values():
            of_group = [walls[i] for i in numbers]
            rings = self._around(of_group) if len(numbers) > 1 and self._is_straight(of_group) else []
            # A joint wall around an opening, or one that touches itself, stays in its parts.
            if len(rings) == 1 and len(set(rings[0])) == len(rings[0]):
                joined.append((rings[0], [cell for wall in of_group for cell in wall.cells]))
            else:
                joined += [(wall.ring, wall.cells) for wall in of_group]
        return joined

    @staticmethod
    def _around(walls: list[_Wall]) -> list[Ring]:
        """Return the rings around walls."""
        edges = {edge for wall in walls for edge in zip(wall.ring, [*wall.ring[1:], wall.ring[0]])}
        return _rings([(a, b) for a, b in edges if (b, a) not in edges])

    def _are_in_line(self, one: _Wall, other: _Wall) -> bool:
        """Return whether two walls face the same way in one line."""
        (ax, ay), (bx, by) = (self._direction(wall) for wall in (one, other))
        return ax * bx + ay * by > 0 and self._is_straight([one, other])

    def _direction(self, wall: _Wall) -> tuple[float, float]:
        (x0, y0), (x1, y1) = self.levels.plan[wall.start], self.levels.plan[wall.end]
        return x1 - x0, y1 - y0

    def _is_straight(self, walls: list[_Wall]) -> bool:
        """Return whether the ends of walls lie in one line."""
        xy = [self.levels.plan[end] for wall in walls for end in (wall.start, wall.end)]
        start = max(xy, key=lambda end: math.dist(end, xy[0]))
        x0, y0 = start
        x1, y1 = max(xy, key=lambda end: math.dist(end, start))
        x, y = x1 - x0, y1 - y0
        most = _STRAIGHT * max(math.hypot(x, y), 1e-9)
        return all(abs((px - x0) * y - (py - y0) * x) <= most for px, py in xy)

    def _is_upright(self, a: int, b: int) -> bool:
        return self.levels.positions[a][:2] == self.levels.positions[b][:2]

    def _polygons(self, rings: list[Ring], upward: bool) -> list[list[Ring]]:
        """Return the rings of one part: the exterior first, then its holes."""
        plan = self.plan
        areas = [signed_area(plan[[*ring, ring[0]]]) * (1 if upward else -1) for ring in rings]
        outer = [i for i, area in enumerate(areas) if area > 0]
        if len(outer) == 1:
            return [[rings[outer[0]], *(ring for i, ring in enumerate(rings) if i != outer[0])]]
        polygons = {i: [rings[i]] for i in sorted(outer, key=lambda i: areas[i])}
        for i, ring in enumerate(rings):
            if i in polygons:
                continue
            middle = plan[ring].mean(axis=0)[None]
            for exterior, *_ in polygons.values():
                if are_within(middle, edges_of(plan[exterior]))[0]:
                    polygons[rings.index(exterior)].append(ring)
                    break
        return list(polygons.values())


def groups_of(pairs: Iterable[tuple[int, int]], count: int) -> list[int]:
    """Return the group (count,) of each item that pairs hold together: its first item.

    A building has too few items for a sparse matrix to be worth its set-up.
    """
    first = list(range(count))

    def of(item: int) -> int:
        while first[item] != item:
            first[item] = item = first[first[item]]
        return item

    for one, other in pairs:
        low, high = sorted((of(one), of(other)))
        first[high] = low
    return [of(item) for item in range(count)]


def edges_of(ring: np.ndarray) -> np.ndarray:
    """Return the edges (n, 2, 2) of an open ring (n, 2)."""
    return np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)


def _rings(edges: list[tuple[int, int]]) -> list[Ring]:
    """Return the rings that directed edges make; where rings touch in a vertex they are parted."""
    following: dict[int, list[int]] = defaultdict(list)
    for a, b in edges:
        following[a].append(b)
    rings = []
    while following:
        path, position = [next(iter(following))], {}
        position[path[0]] = 0
        while True:
            ways = following[path[-1]]
            step = ways.pop()
            if not ways:
                del following[path[-1]]
            if step in position:
                # A loop within the path is a ring of its own.
                at = position[step]
                rings.append(path[at:])
                for vertex in path[at + 1 :]:
                    del position[vertex]
                path = path[: at + 1]
                if at == 0 and step not in following:
                    break
            else:
                position[step] = len(path)
                path.append(step)
    return rings


def _compact(positions: list[_Position], faces: list[_Built]) -> Solid:
    """Return the solid of faces without vertices on straight edges and without unused ones."""
    beside: dict[int, set[int]] = defaultdict(set)
    for _, _, rings, _ in faces:
        for ring in rings:
            for a, b in zip(ring, [*ring[1:], ring[0]]):
                beside[a].add(b)
                beside[b].add(a)
    straight = _straight(positions, beside)
    kept = sorted(set(beside) - straight)
    number = {old: new for new, old in enumerate(kept)}
    solid = Solid(np.array([positions[old] for old in kept]))
    for kind, plane, rings, _ in faces:
        solid.faces.append([[number[v] for v in ring if v in number] for ring in rings])
        solid.kinds.append(kind)
        solid.planes.append(plane)
    return solid


def _straight(positions: list[_Position], beside: dict[int, set[int]]) -> set[int]:
    """Return the vertices with two edges in one line; never two in a row, unless those about them are in line too."""
    straight: set[int] = set()
    links = {vertex: set(others) for vertex, others in beside.items()}
    for vertex in list(links):
        if len(links[vertex]) != 2:
            continue
        a, b = links[vertex]
        if b in links[a]:
            continue
        if _is_between(positions[vertex], positions[a], positions[b]):
            straight.add(vertex)
            links[a].remove(vertex)
            links[b].remove(vertex)
            links[a].add(b)
            links[b].add(a)
            del links[vertex]
    return straight


def _is_between(position: _Position, one: _Position, other: _Position) -> bool:
    """Return whether a position lies in line with two others, from the first one toward the second one."""
    (x, y, z), (a, b, c) = ([p - q for p, q in zip(end, one)] for end in (position, other))
    across = math.hypot(y * c - z * b, z * a - x * c, x * b - y * a)
    return across < _SUPERFLUOUS * max(math.hypot(a, b, c), 1e-12) and x * a + y * b + z * c > 0
