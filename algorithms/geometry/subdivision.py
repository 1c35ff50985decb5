"""A rectangle cut into convex cells by segments that end where they meet others."""

from __future__ import annotations

import math
from typing import Optional

import numpy as np

# A cut passes through a vertex within this distance (m).
SNAP = 0.05

# The cell beyond the rim of the rectangle.
OUTSIDE = -1


class Subdivision:
    """Convex cells with common vertices: where an edge of one cell meets several others, it has a vertex.

    Parameters
    ----------
    low, high : ndarray of shape (2,)
        Corners of the rectangle (m).
    xy : ndarray of shape (n, 2)
        Points in it, which are sorted into the cells.

    Attributes
    ----------
    vertices : list of tuple
        Positions (x, y), m.
    loops : list of list of int
        The vertices around each cell, counterclockwise; some lie on straight edges.
    members : list of ndarray
        The points in each cell.
    cell_of : dict
        The cell to the left of each edge, which is a pair of vertices (start, end).
    is_closed : list of bool
        Cells that no further line cuts.
    """

    def __init__(self, low: np.ndarray, high: np.ndarray, xy: np.ndarray) -> None:
        (x0, y0), (x1, y1) = np.asarray(low, float).tolist(), np.asarray(high, float).tolist()
        self.vertices: list[tuple[float, float]] = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        self.loops: list[list[int]] = [[0, 1, 2, 3]]
        self.members: list[np.ndarray] = [np.arange(len(xy))]
        self.cell_of: dict[tuple[int, int], int] = {(0, 1): 0, (1, 2): 0, (2, 3): 0, (3, 0): 0}
        self.is_closed: list[bool] = [False]
        self._boxes: list[tuple[float, float, float, float]] = [(x0, y0, x1, y1)]
        self._xy = xy
        # Measured when first asked for, and again after a change: areas by cell, and the edges.
        self._areas: dict[int, float] = {}
        self._edges: Optional[tuple[np.ndarray, np.ndarray]] = None

    def __len__(self) -> int:
        return len(self.loops)

    def copy(self) -> Subdivision:
        """Return a copy that can be given vertices and cuts by itself."""
        copy = Subdivision.__new__(Subdivision)
        copy.vertices, copy.loops = list(self.vertices), [list(loop) for loop in self.loops]
        copy.members, copy.cell_of = list(self.members), dict(self.cell_of)
        copy.is_closed, copy._boxes, copy._xy = list(self.is_closed), list(self._boxes), self._xy
        copy._areas, copy._edges = dict(self._areas), self._edges
        return copy

    def close(self, is_closed: np.ndarray) -> None:
        """Mark the cells (cells,), bool, that no further line cuts."""
        self.is_closed = list(is_closed)

    def cut(self, start: np.ndarray, end: np.ndarray, snap: float = SNAP) -> list[int]:
        """Cut all open cells that the piece of a line from ``start`` to ``end`` (m) passes through.

        A cell is cut from side to side. Vertices at most ``snap`` (m) off the line become vertices of the cut; the tip
        of a sharp corner, where the cut would be shorter than half of that, stays. Returns the cells that were cut, in
        the order of the new ones.
        """
        (x0, y0), (x1, y1) = np.asarray(start, float).tolist(), np.asarray(end, float).tolist()
        length = float(np.hypot(x1 - x0, y1 - y0))
        parted: list[int] = []
        if length == 0:
            return parted
        line = (x0, y0, (x1 - x0) / length, (y1 - y0) / length)
        (west, east), (south, north) = sorted((x0, x1)), sorted((y0, y1))
        for cell in range(len(self.loops)):
            low_x, low_y, high_x, high_y = self._boxes[cell]
            is_near = low_x <= east and low_y <= north and high_x >= west and high_y >= south
            if is_near and not self.is_closed[cell]:
                before = len(self)
                self._cut_cell(cell, line, length, snap)
                parted += [cell] * (len(self) - before)
        return parted

    def cut_cell(self, cell: int, position: np.ndarray, direction: np.ndarray) -> bool:
        """Cut one cell along the whole line through a position (m) in a unit direction; return whether it was cut."""
        before = len(self)
        reach = math.dist(self.vertices[0], self.vertices[2])
        line = (*(position - reach * direction).tolist(), *direction.tolist())
        self._cut_cell(cell, line, 2 * reach, SNAP)
        return len(self) > before

    def _cut_cell(self, cell: int, line: tuple, length: float, snap: float) -> None:
        """Split one cell where a line crosses it within its length: a position x, y (m) and a unit direction."""
        x0, y0, ux, uy = line
        loop = self.loops[cell]
        positions = [self.vertices[v] for v in loop]
        across = [ux * (y - y0) - uy * (x - x0) for x, y in positions]
        if max(across) <= snap or min(across) >= -snap:
            return
        side = [0 if abs(d) <= snap else 1 if d > 0 else -1 for d in across]
        crossings = _crossings(side)
        if len(crossings) != 2:
            return
        along = []
        for i, j in crossings:
            (xa, ya), (xb, yb) = positions[i], positions[j]
            share = 0.0 if i == j else across[i] / (across[i] - across[j])
            along.append(ux * (xa + share * (xb - xa) - x0) + uy * (ya + share * (yb - ya) - y0))
        first, last = min(along), max(along)
        # A segment must reach into a cell by 2.5 snapping distances, or by half its width if that is less.
        least = min(2.5 * snap, 0.5 * (last - first))
        if last - first < 0.5 * snap or min(last, length) - max(first, 0.0) < least:
            return
        # Taken before the first vertex is inserted, which shifts positions in the loop.
        crossed = [(loop[i], loop[j], across[i], across[j]) for i, j in crossings]
        one, other = (u if u == v else self._vertex_on(u, v, from_u, from_v) for u, v, from_u, from_v in crossed)
        self._split(cell, one, other, line)

    def _vertex_on(self, u: int, v: int, from_u: float, from_v: float) -> int:
        """Put a vertex where an edge crosses a line, at signed distances ``from_u`` and ``from_v`` (m) of its ends."""
        (xa, ya), (xb, yb) = self.vertices[u], self.vertices[v]
        share = from_u / (from_u - from_v)
        return self.insert(u, v, (xa + share * (xb - xa), ya + share * (yb - ya)))

    def insert(self, u: int, v: int, position: tuple[float, float]) -> int:
        """Put a vertex on the edge from ``u`` to ``v`` of the cells on both sides; return its number."""
        new, self._edges = len(self.vertices), None
        self.vertices.append(position)
        for start, end in ((u, v), (v, u)):
            cell = self.cell_of.pop((start, end), None)
            if cell is not None:
                loop = self.loops[cell]
                loop.insert(loop.index(start) + 1, new)
                self._areas.pop(cell, None)
                self.cell_of[start, new] = self.cell_of[new, end] = cell
        return new

    def _split(self, cell: int, one: int, other: int, line: tuple) -> None:
        """Part a cell between two of its vertices; what lies to the right of the line becomes a new cell."""
        loop = self.loops[cell]
        i, j = loop.index(one), loop.index(other)
        first = loop[i : j + 1] if i < j else loop[i:] + loop[: j + 1]
        second = loop[j : i + 1] if j < i else loop[j:] + loop[: i + 1]
        x0, y0, ux, uy = line
        # The first part lies to the left of the line if its vertex farthest off the line does.
        beyond = [ux * (self.vertices[v][1] - y0) - uy * (self.vertices[v][0] - x0) for v in first]
        if max(beyond) < -min(beyond):
            first, second = second, first
        new, self._edges = len(self.loops), None
        self._areas.pop(cell, None)
        self.loops[cell] = first
        self.loops.append(second)
        self.is_closed.append(False)
        for start, end in zip(second, [*second[1:], second[0]]):
            self.cell_of[start, end] = new
        self.cell_of[first[-1], first[0]] = cell
        self._boxes[cell] = self._box(first)
        self._boxes.append(self._box(second))
        rows = self.members[cell]
        is_left = ux * (self._xy[rows, 1] - y0) - uy * (self._xy[rows, 0] - x0) > 0
        self.members[cell] = rows[is_left]
        self.members.append(rows[~is_left])

    def close_tips(self, width: float) -> None:
        """Join the sides of corners of cells, up to the end of the shorter one, where they are ``width`` (m) apart.

        Outlines with such a tip have edges that touch.
        """
        for cell, loop in enumerate(self.loops):
            for tip in list(loop):
                k = loop.index(tip)
                before, after = loop[k - 1], loop[(k + 1) % len(loop)]
                near, far = sorted((before, after), key=lambda v: math.dist(self.vertices[v], self.vertices[tip]))
                length = math.dist(self.vertices[tip], self.vertices[far])
                is_narrow = 2 * abs(self.area([near, tip, far])) < width * length
                is_tip = math.dist(self.vertices[near], self.vertices[far]) < length
                if len(loop) > 3 and is_narrow and is_tip:
                    # The longer side, as the neighbor beyond it has it.
                    self._join_sides(cell, (before, tip, after), near, (far, tip) if far == after else (tip, far))

    def _join_sides(self, cell: int, corner: tuple[int, int, int], near: int, edge: tuple[int, int]) -> None:
        """Take the tip of a corner off a cell; its side to ``near`` becomes a side of the neighbor with the edge."""
        before, tip, after = corner
        beyond = self.cell_of.get(edge, OUTSIDE)
        if beyond == OUTSIDE or near in self.loops[beyond]:
            return
        self.loops[cell].remove(tip)
        self.loops[beyond].insert(self.loops[beyond].index(edge[0]) + 1, near)
        for pair in ((before, tip), (tip, after), edge):
            del self.cell_of[pair]
        self.cell_of[edge[0], near] = self.cell_of[near, edge[1]] = beyond
        self.cell_of[before, after] = cell
        self._edges = None
        for changed in (cell, beyond):
            self._areas.pop(changed, None)
            self._boxes[changed] = self._box(self.loops[changed])

    def _box(self, loop: list[int]) -> tuple[float, float, float, float]:
        """Return the least and greatest x and y of a ring of vertices: west, south, east, north (m)."""
        xs, ys = zip(*(self.vertices[v] for v in loop))
        return min(xs), min(ys), max(xs), max(ys)

    def is_on_rim(self) -> np.ndarray:
        """Return the mask of cells (cells,), bool, that touch the rim of the rectangle."""
        boxes = np.array(self._boxes)
        low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
        return (boxes[:, :2] == low).any(axis=1) | (boxes[:, 2:] == high).any(axis=1)

    def areas(self) -> np.ndarray:
        """Return the areas (cells,), m²."""
        for cell in range(len(self.loops)):
            if cell not in self._areas:
                self._areas[cell] = self.area(self.loops[cell])
        return np.array([self._areas[cell] for cell in range(len(self.loops))])

    def area(self, loop: list[int]) -> float:
        """Return the area (m²) within a ring of vertices."""
        return loop_area([self.vertices[v] for v in loop])

    def centers(self) -> np.ndarray:
        """Return the means of the vertices (cells, 2), m, which lie inside."""
        count = [len(loop) for loop in self.loops]
        cell, corner = np.repeat(np.arange(len(count)), count), np.array(self.vertices)[np.concatenate(self.loops)]
        return np.column_stack([np.bincount(cell, along) for along in corner.T]) / np.array(count)[:, None]

    def edges(self) -> tuple[np.ndarray, np.ndarray]:
        """Return each edge between two cells once: its vertices (m, 2), and the cells to its left and right (m, 2)."""
        if self._edges is None:
            pairs = ((u, v, cell, self.cell_of.get((v, u), OUTSIDE)) for (u, v), cell in self.cell_of.items())
            table = np.array([pair for pair in pairs if pair[2] < pair[3]], int).reshape(-1, 4)
            self._edges = table[:, :2], table[:, 2:]
        return self._edges


def _crossings(side: list[int]) -> list[tuple[int, int]]:
    """Return the sign changes of a ring of sides (-1, 0, 1): (i, i + 1) between two corners, (i, i) in a corner."""
    n = len(side)
    found = []
    for i in range(n):
        j = (i + 1) % n
        if side[i] * side[j] < 0:
            found.append((i, j))
        elif side[i] == 0:
            before = next((side[i - k] for k in range(1, n) if side[i - k]), 0)
            # Of successive corners on the line, the last one counts.
            if side[j] and before * side[j] < 0:
                found.append((i, i))
    return found


def loop_area(positions: list[tuple[float, float]]) -> float:
    """Return the area (m²) within a ring of few positions, negative when it runs clockwise."""
    x0, y0 = positions[0]
    offset = [(x - x0, y - y0) for x, y in positions]
    return 0.5 * sum(xa * yb - xb * ya for (xa, ya), (xb, yb) in zip(offset, [*offset[1:], offset[0]]))
