"""Closed solids of divided footprints: roofs on top, walls where heights differ, one level ground, and soffits."""

import math
from collections import defaultdict
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.rings import polygons_of, rings_of_edges
from .solid_levels import BASE, Levels, Position
from .solids import GROUND, ROOF, SOFFIT, WALL, Ring, Solid, edges_around, groups_of

# A vertex with two edges is superfluous within this distance (m) of the line between their other ends. Walls are one
# face if their corners lie within this distance of a common plane.
_STRAIGHT = 0.0005


def build_solid(levels: Levels, is_eave: Optional[np.ndarray] = None) -> tuple[Solid, list[list[int]]]:
    """Return the solid between a level ground and the planes of cells, and the cells next to each of its faces.

    Cells get vertices where roofs cross. The levels have no crowded vertices (:meth:`.Levels.crowded`), at which edges
    would have more than two faces. Cells that are eaves (cells,), bool, end in a soffit.
    """
    levels.part_crossing_roofs()
    if is_eave is not None:
        levels.overhang(is_eave)
    return _Builder(levels).solid()


@dataclass(frozen=True)
class _Wall:
    """A wall: its ring, the vertices in plan from which and to which it runs, and the cells next to it."""

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
        # Edges of cells with a plane: vertices, the cell and its plane to the left, the plane to the right.
        roofs = ((u, v, cell) for (u, v), cell in self.cells.cell_of.items() if self.label[cell] >= 0)
        self.edges = [(u, v, cell, self.label[cell], levels.plane_beyond(u, v)) for u, v, cell in roofs]
        # The positions at each vertex, from the lowest up.
        self.at: dict[int, list[int]] = defaultdict(list)
        for number, (vertex, _) in {n: key for key, n in levels.number.items()}.items():
            self.at[vertex].append(number)
        for numbers in self.at.values():
            numbers.sort(key=lambda n: levels.positions[n][2])
        self.plan = np.array(levels.positions)[:, :2]

    def solid(self) -> tuple[Solid, list[list[int]]]:
        """Return the solid without superfluous vertices, and the cells next to each face."""
        faces: list[_Built] = []
        part = self._parts()
        cells_of: dict[int, list[int]] = defaultdict(list)
        for cell, root in part.items():
            cells_of[root].append(cell)
        for (root, plane), edges in self._roof_edges(part).items():
            for rings in self._polygons(rings_of_edges(edges), upward=True):
                faces.append((ROOF, plane, rings, cells_of[root]))
        faces += [(WALL, -1, [ring], cells) for ring, cells in self._walls()]
        for bottom, edges in self._bottom_edges().items():
            for rings in self._polygons(rings_of_edges(edges), upward=False):
                faces.append((GROUND if bottom == BASE else SOFFIT, -1, rings, []))
        return _compact(self.levels.positions, faces), [cells for *_, cells in faces]

    def _roof_edges(self, part: dict[int, int]) -> dict[tuple[int, int], list[tuple[int, int]]]:
        """Return the edges around each connected part of a plane, by (part, plane)."""
        edges: dict[tuple[int, int], list[tuple[int, int]]] = defaultdict(list)
        number = self.levels.number
        for u, v, cell, plane, beyond in self.edges:
            if beyond != plane:
                edges[part[cell], plane].append((number[u, plane], number[v, plane]))
        return edges

    def _parts(self) -> dict[int, int]:
        """Return the number of the connected part of equal planes of each cell."""
        pairs = [(cell, self.cells.cell_of[v, u]) for u, v, cell, plane, beyond in self.edges if beyond == plane]
        return {cell: part for cell, part in enumerate(groups_of(pairs, len(self.cells))) if self.label[cell] >= 0}

    def _bottom_edges(self) -> dict[int, list[tuple[int, int]]]:
        """Return the edges around the ground and around soffits, clockwise, by what cells end in below."""
        edges: dict[int, list[tuple[int, int]]] = defaultdict(list)
        number, bottom = self.levels.number, self.levels.bottom
        for u, v, cell, _, beyond in self.edges:
            own = bottom[cell]
            if beyond == BASE or bottom[self.cells.cell_of[v, u]] != own:
                edges[own].append((number[v, own], number[u, own]))
        return edges

    def _walls(self) -> list[tuple[Ring, list[int]]]:
        """Return the walls, those in line with each other as one, and the cells next to each."""
        walls = []
        for u, v, cell, plane, beyond in self.edges:
            cells = [cell] if beyond == BASE else [cell, self.cells.cell_of[v, u]]
            if beyond == plane and len({self.levels.bottom[one] for one in cells}) == 1:
                continue
            rings = [self._wall(u, v, low, high) for low, high in self._sides(u, v, plane, beyond, cells)]
            walls += [_Wall(ring, u, v, cells) for ring in rings if ring]
        return self._joined(walls)

    def _sides(self, u: int, v: int, plane: int, beyond: int, cells: list[int]) -> list[tuple[int, int]]:
        """Return the pairs of planes between which a wall shows right of an edge: above the cell there, and below it.

        The lower one of a pair is not below the upper one where the cell beyond hides it.
        """
        low, *others = (self.levels.bottom[cell] for cell in cells)
        if not others:
            return [(low, plane)]
        if low == others[0] == BASE:
            return [(beyond, plane)]

        def height(one: int) -> float:
            return self.levels.height(u, one) + self.levels.height(v, one)

        return [(max(low, beyond, key=height), plane), (low, min(plane, others[0], key=height))]

    def _wall(self, u: int, v: int, low: int, high: int) -> Ring:
        """Return the wall between two planes on an edge, seen from its right; empty where the first is not below."""
        number, positions = self.levels.number, self.levels.positions
        low_u, low_v, high_u, high_v = number[u, low], number[v, low], number[u, high], number[v, high]
        is_below = positions[low_u][2] <= positions[high_u][2] and positions[low_v][2] <= positions[high_v][2]
        if not is_below or (low_u == high_u and low_v == high_v):
            return []
        return [*self._between(v, low_v, high_v), *self._between(u, low_u, high_u)[::-1]]

    def _between(self, vertex: int, low: int, high: int) -> list[int]:
        """Return the positions at a vertex from one up to another one."""
        numbers = self.at[vertex]
        return numbers[numbers.index(low) : numbers.index(high) + 1]

    def _joined(self, walls: list[_Wall]) -> list[tuple[Ring, list[int]]]:
        """Return walls with neighbors in one line joined, and the cells next to each."""
        owner = {edge: i for i, wall in enumerate(walls) for edge in edges_around(wall.ring)}
        pairs = []
        for (a, b), i in owner.items():
            j = owner.get((b, a))
            is_upright = self.levels.positions[a][:2] == self.levels.positions[b][:2]
            if j is not None and j > i and is_upright and self._are_in_line(walls[i], walls[j]):
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
        edges = {edge for wall in walls for edge in edges_around(wall.ring)}
        return rings_of_edges([(a, b) for a, b in edges if (b, a) not in edges])

    def _are_in_line(self, one: _Wall, other: _Wall) -> bool:
        """Return whether two walls face the same way in one line."""
        plan = self.levels.plan
        (ax, ay), (bx, by) = (np.subtract(plan[wall.end], plan[wall.start]).tolist() for wall in (one, other))
        return ax * bx + ay * by > 0 and self._is_straight([one, other])

    def _is_straight(self, walls: list[_Wall]) -> bool:
        """Return whether the ends of walls lie in one line."""
        xy = [self.levels.plan[end] for wall in walls for end in (wall.start, wall.end)]
        start = max(xy, key=lambda end: math.dist(end, xy[0]))
        x0, y0 = start
        x1, y1 = max(xy, key=lambda end: math.dist(end, start))
        x, y = x1 - x0, y1 - y0
        most = _STRAIGHT * max(math.hypot(x, y), 1e-9)
        return all(abs((px - x0) * y - (py - y0) * x) <= most for px, py in xy)

    def _polygons(self, rings: list[Ring], upward: bool) -> list[list[Ring]]:
        """Return the polygons that rings make, each exterior first; exteriors are clockwise unless ``upward``."""
        closed = [self.plan[[*ring, ring[0]]][:: 1 if upward else -1] for ring in rings]
        return [[rings[i] for i in part] for part in polygons_of(closed)]


def _compact(positions: list[Position], faces: list[_Built]) -> Solid:
    """Return the solid of faces without vertices on straight edges and without unused ones."""
    beside: dict[int, set[int]] = defaultdict(set)
    for _, _, rings, _ in faces:
        for ring in rings:
            for a, b in edges_around(ring):
                beside[a].add(b)
                beside[b].add(a)
    kept = sorted(set(beside) - _straight(positions, beside))
    number = {old: new for new, old in enumerate(kept)}
    solid = Solid(np.array([positions[old] for old in kept]))
    for kind, plane, rings, _ in faces:
        solid.faces.append([[number[v] for v in ring if v in number] for ring in rings])
        solid.kinds.append(kind)
        solid.planes.append(plane)
    return solid


def _straight(positions: list[Position], beside: dict[int, set[int]]) -> set[int]:
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


def _is_between(position: Position, one: Position, other: Position) -> bool:
    """Return whether a position lies in line with two others, from the first one toward the second one."""
    (x, y, z), (a, b, c) = ([p - q for p, q in zip(end, one)] for end in (position, other))
    across = math.hypot(y * c - z * b, z * a - x * c, x * b - y * a)
    return across < _STRAIGHT * max(math.hypot(a, b, c), 1e-12) and x * a + y * b + z * c > 0
