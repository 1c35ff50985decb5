"""Lines that cut the plane into cells, and the ring around some of the cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..packages import csgraph, sparse

# Costs become whole numbers of 32 bits for the flow, to this precision. Those of a cell's sides on the rectangle, four
# at most, and its own are added there: none may be more than a fifth of what fits.
_STEPS, _LARGEST_COST = 1000, 3e5


@dataclass(frozen=True)
class Edge:
    """A piece of a line between two cells: the line's number, its ends (m), the cells left and right of it."""

    line: int
    start: tuple[int, int]
    end: tuple[int, int]
    left: int
    right: int


class Arrangement:
    """All cells that lines cut out of a rectangle.

    Parameters
    ----------
    points, directions : ndarray of shape (m, 2)
        The lines.
    low, high : ndarray of shape (2,)
        Corners of the rectangle (m), beyond everything that matters.

    Attributes
    ----------
    edges : list of Edge
        Pieces of lines between two cells; beyond the rectangle's sides, which are the last four lines, lies nothing,
        numbered as one cell more. A corner is named by the two lines that meet in it.
    signs : ndarray of shape (cells, m), bool
        On which side of each line each cell lies: True is left.
    """

    def __init__(self, points: np.ndarray, directions: np.ndarray, low: np.ndarray, high: np.ndarray) -> None:
        m = len(points)
        frame = np.array([low, [high[0], low[1]], high, [low[0], high[1]]], float)
        self.points = np.concatenate([points, frame])
        self.directions = np.concatenate([directions, [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]])
        # Numbers of Python's own are many times as fast as arrays of two.
        self._lines = [(*point, *u) for point, u in zip(self.points.tolist(), self.directions.tolist())]
        self._corners: dict[tuple[int, int], tuple[float, float]] = {}
        # A cell is the list of lines around it, counterclockwise.
        cells: list[tuple[list[int], list[bool]]] = [([m, m + 1, m + 2, m + 3], [])]
        for line in range(m):
            cells = [part for cell in cells for part in self._split(*cell, line)]
        self.rings = [ring for ring, _ in cells]
        self.signs = np.array([signs for _, signs in cells], bool).reshape(len(cells), m)
        self.edges = self._shared_edges()

    def corner(self, name: tuple[int, int]) -> np.ndarray:
        """Return where two lines meet (m)."""
        return np.array(self._corner(name))

    def _corner(self, name: tuple[int, int]) -> tuple[float, float]:
        if name not in self._corners:
            (x, y, ux, uy), (other_x, other_y, vx, vy) = (self._lines[line] for line in name)
            way = ((other_x - x) * vy - (other_y - y) * vx) / (ux * vy - uy * vx)
            self._corners[name] = x + way * ux, y + way * uy
        return self._corners[name]

    def _is_left(self, line: int, name: tuple[int, int]) -> bool:
        (corner_x, corner_y), (x, y, ux, uy) = self._corner(name), self._lines[line]
        return ux * (corner_y - y) - uy * (corner_x - x) > 0

    def _split(self, ring: list[int], signs: list[bool], line: int) -> list[tuple[list[int], list[bool]]]:
        """Return the one or two parts of a cell, left part first, with one sign more each."""
        # Corner k is where side k begins.
        is_left = [self._is_left(line, _name(before, here)) for before, here in zip([ring[-1], *ring], ring)]
        if all(is_left) or not any(is_left):
            return [(ring, [*signs, is_left[0]])]
        parts = []
        for side in (True, False):
            part: list[int] = []
            for k, here in enumerate(ring):
                starts, ends = is_left[k] == side, is_left[(k + 1) % len(ring)] == side
                if starts or ends:
                    part.append(here)
                if starts and not ends:
                    part.append(line)
            parts.append((part, [*signs, side]))
        return parts

    def _shared_edges(self) -> list[Edge]:
        found: dict[tuple, tuple[int, tuple, tuple]] = {}
        edges = []
        for cell, ring in enumerate(self.rings):
            for before, here, after in zip([ring[-1], *ring], ring, [*ring[1:], ring[0]]):
                start, end = _name(before, here), _name(here, after)
                key = (here, *sorted((start, end)))
                if key in found:
                    edges.append(Edge(here, *found[key][1:], found[key][0], cell))
                else:
                    found[key] = (cell, start, end)
        m, nothing = self.signs.shape[1], len(self.rings)
        return edges + [
            Edge(key[0], start, end, cell, nothing) for key, (cell, start, end) in found.items() if key[0] >= m
        ]

    def cells_at(self, sides: np.ndarray) -> np.ndarray:
        """Return the cell (n,) of points that lie on these ``sides`` (n, m) of the lines, -1 where there is none."""
        keys, wanted = keys_of(self.signs), keys_of(sides)
        order = np.argsort(keys)
        cell = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)]
        # Rounding may put a point into a cell that is too small to exist.
        return np.where(keys[cell] == wanted, cell, -1)

    def outline(self, inside: np.ndarray) -> list[list[tuple[int, tuple[int, int]]]]:
        """Return the rings around the cells ``inside`` (cells,), bool: (line, corner where its edge begins) in order.

        Exteriors run counterclockwise and holes clockwise; edges on one line that follow each other are one.
        """
        following: dict[tuple[int, int], list[tuple[int, tuple[int, int]]]] = {}
        inside = np.append(inside, False)
        for edge in self.edges:
            if inside[edge.left] != inside[edge.right]:
                start, end = (edge.start, edge.end) if inside[edge.left] else (edge.end, edge.start)
                following.setdefault(start, []).append((edge.line, end))
        rings = []
        while following:
            start = next(iter(following))
            rings.append(self._walk(following, start))
        return rings

    def _walk(self, following: dict, start: tuple[int, int]) -> list[tuple[int, tuple[int, int]]]:
        """Take one ring out of ``following`` and return it."""
        here, came, ring = start, -1, []
        while True:
            ways = following[here]
            # Where two rings touch, leaving the line parts them.
            way = next((i for i, (line, _) in enumerate(ways) if line != came), 0) if len(ways) > 1 else 0
            line, end = ways.pop(way)
            if not ways:
                del following[here]
            if line != came:
                ring.append((line, here))
            here, came = end, line
            if here == start:
                break
        if len(ring) > 1 and ring[0][0] == came:
            ring.pop(0)
        return ring

    def cheapest(self, cost: np.ndarray, if_inside: np.ndarray, if_outside: np.ndarray) -> np.ndarray:
        """Return the cells (cells,), bool, whose choice costs least: a minimum cut.

        Parameters
        ----------
        cost : ndarray of shape (edges,)
            Of an edge with one of its cells inside and the other outside, >= 0.
        if_inside, if_outside : ndarray of shape (cells,)
            Of a cell that is inside, and of one that is not, >= 0.
        """
        n = len(self.rings)
        source, sink, cells = n, n + 1, np.arange(n)
        left, right = (np.array([getattr(edge, side) for edge in self.edges], int) for side in ("left", "right"))
        right = np.where(right == n, sink, right)
        rows = np.concatenate([left, right, np.full(n, source), cells])
        columns = np.concatenate([right, left, cells, np.full(n, sink)])
        costs = np.minimum(np.concatenate([cost, cost, if_outside, if_inside]), _LARGEST_COST)
        capacity = np.rint(costs * _STEPS).astype(np.int32)
        graph = sparse.csr_matrix((capacity, (rows, columns)), shape=(n + 2, n + 2))
        residual = graph - csgraph.maximum_flow(graph, source, sink).flow
        residual.data = np.maximum(residual.data, 0)
        residual.eliminate_zeros()
        reached = csgraph.breadth_first_order(residual, source, return_predecessors=False)
        inside = np.zeros(n + 2, bool)
        inside[reached] = True
        return inside[:n]


def sides_of(xy: np.ndarray, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Return whether each point (n, 2) lies to the left of each line (m), bool (n, m)."""
    normals = np.column_stack([-directions[:, 1], directions[:, 0]])
    return xy @ normals.T > np.einsum("ij,ij->i", points, normals)


def keys_of(sides: np.ndarray) -> np.ndarray:
    """Return the sides of lines (n, m), bool, as one number each: a sum of random ones, which no two cells share."""
    return sides @ np.random.default_rng(0).integers(1, 2**62, sides.shape[1])


def _name(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a < b else (b, a)
