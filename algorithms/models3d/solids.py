"""Closed solids of divided footprints: roofs on top, walls where heights differ, one level ground."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np

from ..facades.facade_outline import inside_ring
from ..geometry.rings import signed_area
from ..geometry.subdivision import OUTSIDE, Subdivision

ROOF, WALL, GROUND = "roof", "wall", "ground"

# Heights at one place that differ by at most this (m) become one: planes stay plane to half of that.
_SAME_HEIGHT = 0.016

# Faces are plane to this (m); vertices lie no closer together than that (m).
PLANAR, _APART = 0.01, 0.002

# Decimals of positions (m), as files have them.
_DECIMALS = 3

# A vertex with two edges that is off the line of their other ends by less than this (m), in plan by a tenth of it, is
# superfluous: heights that became one have moved by as much.
_SUPERFLUOUS = 0.005

# Walls that turn by less than this (rad) are one face.
_STRAIGHT = 1e-3

_BASE = -1

Ring = list[int]


@dataclass
class Solid:
    """A closed surface.

    Attributes
    ----------
    vertices : ndarray of shape (n, 3)
        Positions (m).
    faces : list of list of list of int
        The rings of each face, exterior first: counterclockwise seen from outside the solid, holes clockwise; open
        (the last vertex is not the first one again).
    kinds : list of str
        "roof", "wall" or "ground".
    planes : list of int
        Of which plane a roof face is part, -1 for others.
    """

    vertices: np.ndarray
    faces: list[list[Ring]] = field(default_factory=list)
    kinds: list[str] = field(default_factory=list)
    planes: list[int] = field(default_factory=list)

    @property
    def volume(self) -> float:
        """Volume (m³)."""
        origin = self.vertices.mean(axis=0)
        total = 0.0
        for rings in self.faces:
            for ring in rings:
                corner = self.vertices[ring] - origin
                total += float(
                    np.einsum("ij,ij->", np.cross(corner[1:-1], corner[2:]), corner[:1].repeat(len(ring) - 2, 0))
                )
        return total / 6

    def normal(self, face: int) -> np.ndarray:
        """Return the vector (3,) across a face, outward, as long as its area (m²)."""
        return sum((_area_vector(self.vertices[ring]) for ring in self.faces[face]), np.zeros(3))


def _area_vector(corners: np.ndarray) -> np.ndarray:
    """Return the vector (3,) across a ring, as long as its area."""
    offset = corners - corners[0]
    return 0.5 * np.cross(offset, np.roll(offset, -1, axis=0)).sum(axis=0)


def build_solid(cells: Subdivision, label: np.ndarray, coefficients: np.ndarray, base: float) -> Solid:
    """Return the solid between a level ground and the planes of cells.

    Parameters
    ----------
    cells : Subdivision
        The cells; they get vertices where roofs cross.
    label : ndarray of shape (cells,)
        Plane of each cell, -1 outside.
    coefficients : ndarray of shape (m, 3)
        The planes.
    base : float
        Height of the ground (m).

    Raises
    ------
    ValueError
        If more than two faces would meet in an edge; see :func:`Levels.crowded`.
    """
    levels = Levels(cells, label, coefficients, base)
    levels.part_crossing_roofs()
    return _Builder(levels).solid()


class Levels:
    """Heights at the vertices of a partition: one for each plane there; those that are nearly the same are one."""

    def __init__(self, cells: Subdivision, label: np.ndarray, coefficients: np.ndarray, base: float) -> None:
        self.cells, self.label, self.coefficients, self.base = cells, label, coefficients, base
        self.around: dict[int, list[int]] = defaultdict(list)
        for (u, v), cell in cells.cell_of.items():
            if label[cell] >= 0:
                self.around[u].append(label[cell])
                if self.plane_beyond(u, v) == _BASE:
                    self.around[u].append(_BASE)
                    self.around[v].append(_BASE)
        self.number: dict[tuple[int, int], int] = {}
        self.positions: list[tuple[float, float, float]] = []
        self._spokes: dict[int, list[int]] = defaultdict(list)
        for u, v in cells.cell_of:
            self._spokes[u].append(v)
        for vertex in self.around:
            self._number(vertex)

    def plane_beyond(self, u: int, v: int) -> int:
        """Return the plane to the right of an edge, the ground where there is none."""
        cell = self.cells.cell_of.get((v, u), OUTSIDE)
        return _BASE if cell == OUTSIDE else int(self.label[cell])

    def height(self, vertex: int, plane: int) -> float:
        """Return the height (m) at which a plane, or the ground, is at a vertex."""
        return self.positions[self.number[vertex, plane]][2]

    def _number(self, vertex: int) -> None:
        """Give numbers to the positions at a vertex."""
        x, y = self.cells.vertices[vertex]
        heights = []
        for plane in sorted(set(self.around[vertex])):
            a, b, c = self.coefficients[plane] if plane != _BASE else (0.0, 0.0, self.base)
            heights.append((a * x + b * y + c, plane))
        heights.sort()
        group: list[tuple[float, int]] = []
        for height, plane in heights:
            if group and height - group[0][0] > _SAME_HEIGHT:
                self._enter(vertex, group)
                group = []
            group.append((height, plane))
        if group:
            self._enter(vertex, group)

    def _enter(self, vertex: int, group: list[tuple[float, int]]) -> None:
        x, y = self.cells.vertices[vertex]
        is_ground = any(plane == _BASE for _, plane in group)
        z = self.base if is_ground else sum(height for height, _ in group) / len(group)
        for _, plane in group:
            self.number[vertex, plane] = len(self.positions)
        self.positions.append((x, y, z))

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
            (x0, y0), (x1, y1) = self.cells.vertices[u], self.cells.vertices[v]
            new = self.cells.insert(u, v, (x0 + share * (x1 - x0), y0 + share * (y1 - y0)))
            self.around[new] = [one, other]
            self._number(new)

    def _planes_beside(self, u: int, v: int) -> tuple[int, int]:
        cell = self.cells.cell_of[u, v]
        return int(self.label[cell]), self.plane_beyond(u, v)

    def crowded(self) -> list[int]:
        """Return the vertices where more than two walls would meet in an edge."""
        return [vertex for vertex in self.around if self._is_crowded(vertex)]

    def _is_crowded(self, vertex: int) -> bool:
        planes = [int(self.label[cell]) for cell in self.cells_around(vertex)]
        return turns_around([self.height(vertex, plane) for plane in planes]) > 2

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


class _Builder:
    """Makes the faces of a solid."""

    def __init__(self, levels: Levels) -> None:
        self.levels, self.cells, self.label = levels, levels.cells, levels.label
        self.at: dict[int, list[int]] = defaultdict(list)
        for number, (vertex, _) in {n: key for key, n in levels.number.items()}.items():
            self.at[vertex].append(number)
        for numbers in self.at.values():
            numbers.sort(key=lambda n: levels.positions[n][2])

    def solid(self) -> Solid:
        """Return the solid without superfluous vertices."""
        faces: list[tuple[str, int, list[Ring]]] = []
        for plane, edges in self._roof_edges().items():
            faces += [(ROOF, plane[1], rings) for rings in self._polygons(_rings(edges), upward=True)]
        faces += [(WALL, -1, [ring]) for ring in self._walls()]
        faces += [(GROUND, -1, rings) for rings in self._polygons(_rings(self._ground_edges()), upward=False)]
        return _compact(np.array(self.levels.positions), faces)

    def _roof_edges(self) -> dict[tuple[int, int], list[tuple[int, int]]]:
        """Return the edges around each connected part of a plane, by (part, plane)."""
        part = self._parts()
        edges: dict[tuple[int, int], list[tuple[int, int]]] = defaultdict(list)
        number = self.levels.number
        for (u, v), cell in self.cells.cell_of.items():
            plane = int(self.label[cell])
            if plane >= 0 and self.levels.plane_beyond(u, v) != plane:
                edges[part[cell], plane].append((number[u, plane], number[v, plane]))
        return edges

    def _parts(self) -> dict[int, int]:
        """Return which connected part of equal planes each cell is in."""
        parent = {cell: cell for cell in range(len(self.cells)) if self.label[cell] >= 0}

        def root(cell: int) -> int:
            while parent[cell] != cell:
                parent[cell] = parent[parent[cell]]
                cell = parent[cell]
            return cell

        for (u, v), cell in self.cells.cell_of.items():
            other = self.cells.cell_of.get((v, u), OUTSIDE)
            if other != OUTSIDE and self.label[cell] >= 0 and self.label[other] == self.label[cell]:
                parent[root(cell)] = root(other)
        return {cell: root(cell) for cell in parent}

    def _ground_edges(self) -> list[tuple[int, int]]:
        number = self.levels.number
        return [
            (number[v, _BASE], number[u, _BASE])
            for (u, v), cell in self.cells.cell_of.items()
            if self.label[cell] >= 0 and self.levels.plane_beyond(u, v) == _BASE
        ]

    def _walls(self) -> list[Ring]:
        """Return the walls, those in line with each other as one."""
        walls = []
        for (u, v), cell in self.cells.cell_of.items():
            plane = int(self.label[cell])
            beyond = self.levels.plane_beyond(u, v)
            if plane >= 0 and beyond != plane:
                ring = self._wall(u, v, plane, beyond)
                if ring:
                    walls.append((ring, u, v))
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

    def _joined(self, walls: list[tuple[Ring, int, int]]) -> list[Ring]:
        """Return walls with neighbors in one line joined."""
        place = np.array(self.cells.vertices)
        angle = [np.arctan2(*(place[v] - place[u])[::-1]) for _, u, v in walls]
        owner = {edge: i for i, (ring, _, _) in enumerate(walls) for edge in zip(ring, [*ring[1:], ring[0]])}
        parent = list(range(len(walls)))

        def root(i: int) -> int:
            while parent[i] != i:
                parent[i] = parent[parent[i]]
                i = parent[i]
            return i

        for (a, b), i in owner.items():
            j = owner.get((b, a))
            if j is not None and j != i and self._is_upright(a, b):
                turn = (angle[i] - angle[j] + np.pi) % (2 * np.pi) - np.pi
                if abs(turn) < _STRAIGHT:
                    parent[root(i)] = root(j)
        edges: dict[int, list[tuple[int, int]]] = defaultdict(list)
        for (a, b), i in owner.items():
            j = owner.get((b, a))
            if j is None or root(j) != root(i):
                edges[root(i)].append((a, b))
        joined = []
        for group, around in edges.items():
            rings = _rings(around)
            # A joint wall around an opening, or one that touches itself, stays in its parts.
            members = [ring for i, (ring, _, _) in enumerate(walls) if root(i) == group]
            is_simple = len(rings) == 1 and len(set(rings[0])) == len(rings[0])
            joined += rings if is_simple else members
        return joined

    def _is_upright(self, a: int, b: int) -> bool:
        return self.levels.positions[a][:2] == self.levels.positions[b][:2]

    def _polygons(self, rings: list[Ring], upward: bool) -> list[list[Ring]]:
        """Return the rings of one part: the exterior first, then its holes."""
        plan = np.array(self.levels.positions)[:, :2]
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
                if inside_ring(middle, plan[[*exterior, exterior[0]]])[0]:
                    polygons[rings.index(exterior)].append(ring)
                    break
        return list(polygons.values())


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


def _compact(positions: np.ndarray, faces: list[tuple[str, int, list[Ring]]]) -> Solid:
    """Return the solid of faces without vertices on straight edges and without unused ones."""
    beside: dict[int, set[int]] = defaultdict(set)
    for _, _, rings in faces:
        for ring in rings:
            for a, b in zip(ring, [*ring[1:], ring[0]]):
                beside[a].add(b)
                beside[b].add(a)
    straight = _straight(positions, beside)
    kept = sorted(set(beside) - straight)
    number = {old: new for new, old in enumerate(kept)}
    # What is checked is what files hold, which is rounded.
    solid = Solid(np.round(positions[kept], _DECIMALS))
    for kind, plane, rings in faces:
        solid.faces.append([[number[v] for v in ring if v in number] for ring in rings])
        solid.kinds.append(kind)
        solid.planes.append(plane)
    return solid


def _straight(positions: np.ndarray, beside: dict[int, set[int]]) -> set[int]:
    """Return the vertices with two edges in one line; never two in a row, unless those about them are in line too."""
    straight: set[int] = set()
    links = {vertex: set(others) for vertex, others in beside.items()}
    for vertex in list(links):
        if len(links[vertex]) != 2:
            continue
        a, b = links[vertex]
        if b in links[a]:
            continue
        u, v = positions[vertex] - positions[a], positions[b] - positions[a]
        length = max(float(np.linalg.norm(v)), 1e-12)
        off = np.linalg.norm(np.cross(u, v)) / length
        off_in_plan = abs(u[0] * v[1] - u[1] * v[0]) / length
        if off < _SUPERFLUOUS and off_in_plan < 0.1 * _SUPERFLUOUS and u @ v > 0:
            straight.add(vertex)
            links[a].remove(vertex)
            links[b].remove(vertex)
            links[a].add(b)
            links[b].add(a)
            del links[vertex]
    return straight


def fault_of(solid: Solid) -> str:
    """Return what is wrong with a solid, "" where it is closed, oriented, plane and has proper edges."""
    edges: set[tuple[int, int]] = set()
    for rings in solid.faces:
        for ring in rings:
            if len(ring) < 3 or len(set(ring)) != len(ring):
                return "a ring is degenerate"
            for edge in zip(ring, [*ring[1:], ring[0]]):
                if edge in edges:
                    return "an edge has more than two faces"
                edges.add(edge)
    if any((b, a) not in edges for a, b in edges):
        return "the surface is open"
    pairs = np.array(sorted(edges))
    length = np.linalg.norm(solid.vertices[pairs[:, 0]] - solid.vertices[pairs[:, 1]], axis=1)
    if length.min() < _APART:
        return "an edge is too short"
    for face, rings in enumerate(solid.faces):
        normal = solid.normal(face)
        area = float(np.linalg.norm(normal))
        corners = solid.vertices[[v for ring in rings for v in ring]]
        if area < 1e-6:
            return "a face has no area"
        off = (corners - corners.mean(axis=0)) @ (normal / area)
        if np.abs(off).max() > PLANAR:
            return "a face is not plane"
        if _crosses_itself(solid.vertices, rings, normal / area):
            return "edges of a face cross"
    return ""


def _crosses_itself(vertices: np.ndarray, rings: list[Ring], normal: np.ndarray) -> bool:
    """Return whether edges of a face that have no vertex in common cross, seen along its normal."""
    edge = np.array([pair for ring in rings for pair in zip(ring, [*ring[1:], ring[0]])])
    axis = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    plan = (vertices - vertices[edge[0, 0]]) @ np.column_stack([axis, np.cross(normal, axis)])
    start, end = plan[edge[:, 0]], plan[edge[:, 1]]
    step = end - start

    def side(places: np.ndarray) -> np.ndarray:
        """Return on which side of each edge (k, 1) each place (k,) is, as an area."""
        offset = places[None] - start[:, None]
        return step[:, None, 0] * offset[..., 1] - step[:, None, 1] * offset[..., 0]

    parts = side(start) * side(end) < 0
    apart = (edge[:, None, :, None] != edge[None, :, None, :]).all(axis=(2, 3))
    return bool((parts & parts.T & apart).any())
