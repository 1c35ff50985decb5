"""Lines that cut a rectangle into cells."""

from dataclasses import dataclass

import numpy as np

from ..criteria import MICROMETER


@dataclass(frozen=True)
class Edges:
    """Pieces of lines between two crossings, in the direction of their lines."""

    #: line, start, end, left, right, (e,), int64: the line; the crossings at its ends; the cells next to it
    line: np.ndarray
    start: np.ndarray
    end: np.ndarray
    left: np.ndarray
    right: np.ndarray
    #: low, high, (e,): positions of its ends along the line, from the line's point (m)
    low: np.ndarray
    high: np.ndarray


class Arrangement:
    """All cells that lines cut out of a rectangle.

    Parameters
    ----------
    points, directions : ndarray of shape (m, 2)
        A point on each line (m), and the unit vector along it.
    low, high : ndarray of shape (2,)
        Corners of the rectangle (m), outside of all cells that may be chosen.

    Attributes
    ----------
    count : int
        Number of cells.
    edges : Edges
        What separates them.
    is_border : ndarray of shape (count,), bool
        Which cells touch the sides of the rectangle.
    crossing : ndarray of shape (k, 2), int64
        The two lines that meet in each crossing.
    positions : ndarray of shape (k + ends, 2)
        Where the crossings are (m), then the ends of lines at the sides of the rectangle; ``edges`` count them alike.
    around : ndarray of shape (k, 4), int64
        The cells around a crossing: left and right of its first line before it, left and right of that line after it.

    Notes
    -----
    A cell is identified by the lines to whose left it lies, as a sum of one random number for each. On the way along
    a line that number changes only where another line is crossed, so that it takes as long as sorting the crossings.
    """

    def __init__(self, points: np.ndarray, directions: np.ndarray, low: np.ndarray, high: np.ndarray) -> None:
        self.points, self.directions = np.asarray(points, float), np.asarray(directions, float)
        low, high, rng = np.asarray(low, float), np.asarray(high, float), np.random.default_rng(0)
        self._build(low, high)
        while not self._fits():
            self.points = self.points + rng.uniform(-MICROMETER, MICROMETER, self.points.shape)
            self._build(low, high)

    def _build(self, low: np.ndarray, high: np.ndarray) -> None:
        """Find crossings, edges and cells of the current lines."""
        numbers = _numbers(len(self.points))
        self.crossing, positions, ways = self._crossings(low, high)
        entry, leave = self._clipped(low, high)
        own, k = np.flatnonzero(entry < leave), len(self.crossing)
        none, ends = np.full(len(own), -1), k + np.arange(2 * len(own))
        # All positions on each line in order: where it enters the rectangle, crossings, where it leaves.
        line = np.concatenate([own, *self.crossing.T, own])
        other = np.concatenate([none, *self.crossing.T[::-1], none])
        node = np.concatenate([ends[: len(own)], np.tile(np.arange(k), 2), ends[len(own) :]])
        way = np.concatenate([entry[own], *ways.T, leave[own]])
        order = np.lexsort((way, line))
        line, other, node, way = line[order], other[order], node[order], way[order]
        at_sides = [self.points[own] + at[own, None] * self.directions[own] for at in (entry, leave)]
        self.positions = np.concatenate([positions, *at_sides])
        first = np.flatnonzero(line[1:] == line[:-1])
        right = self._right_keys(line, way, other, numbers)[first]
        corner = sides_of(low[None], self.points, self.directions) @ numbers
        self._keys, cell = np.unique(np.concatenate([right + numbers[line[first]], right, corner]), return_inverse=True)
        left, right = cell[: len(first)], cell[len(first) : -1]
        self.edges = Edges(line[first], node[first], node[first + 1], left, right, way[first], way[first + 1])
        self.count = len(self._keys)
        self.is_border = self._touching(low, high, np.concatenate(at_sides))
        self.around = self._cells_around(k)

    def _crossings(self, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return pairs of lines (k, 2) that meet in a rectangle, where (k, 2), and the ways there along both (m)."""
        first, second = np.triu_indices(len(self.points), 1)
        u, v, apart = self.directions[first], self.directions[second], self.points[second] - self.points[first]
        turn = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            way = (apart[:, 0] * v[:, 1] - apart[:, 1] * v[:, 0]) / turn
            other = (apart[:, 0] * u[:, 1] - apart[:, 1] * u[:, 0]) / turn
            positions = self.points[first] + way[:, None] * u
            meets = (turn != 0) & ((positions > low) & (positions < high)).all(axis=1)
        return np.column_stack([first, second])[meets], positions[meets], np.column_stack([way, other])[meets]

    def _clipped(self, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the distances along lines (m,) to entry into a rectangle and exit; entry > exit for lines outside."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ways = np.sort([(limit - self.points) / self.directions for limit in (low, high)], axis=0)
        level = self.directions == 0
        within = (self.points > low) & (self.points < high)
        entry = np.where(level, np.where(within, -np.inf, np.inf), ways[0]).max(axis=1, initial=-np.inf)
        leave = np.where(level, np.where(within, np.inf, -np.inf), ways[1]).min(axis=1, initial=np.inf)
        return entry, leave

    def _right_keys(self, line: np.ndarray, way: np.ndarray, other: np.ndarray, numbers: np.ndarray) -> np.ndarray:
        """Return the number of the cell to the right of each line behind each of the positions on it."""
        is_first = np.append(True, line[1:] != line[:-1])[: len(line)]
        starts, group = np.flatnonzero(is_first), np.cumsum(is_first) - 1
        own = line[starts]
        middle = (way[starts] + way[starts + 1]) / 2
        sides = sides_of(self.points[own] + middle[:, None] * self.directions[own], self.points, self.directions)
        sides[np.arange(len(own)), own] = False
        # Crossing a line from its right to its left adds its number.
        u, v = self.directions[line], self.directions[other]
        rises = np.sign(v[:, 0] * u[:, 1] - v[:, 1] * u[:, 0]).astype(np.int64)
        change = np.where(other >= 0, rises * numbers[other], 0)
        # Behind the first position of a line, where it enters, the number is measured.
        total = np.cumsum(change)
        return total - total[starts][group] + (sides @ numbers)[group]

    def _touching(self, low: np.ndarray, high: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Return the mask of cells (count,) that touch the sides of the rectangle."""
        corners = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
        touching = np.zeros(self.count, bool)
        on_sides = np.concatenate([ends, corners])
        for axis in (0, 1):
            for limit in (low[axis], high[axis]):
                own = np.sort(on_sides[np.abs(on_sides[:, axis] - limit) < MICROMETER * (1 + abs(limit)), 1 - axis])
                middles = np.empty((max(len(own) - 1, 0), 2))
                middles[:, axis], middles[:, 1 - axis] = limit, (own[1:] + own[:-1]) / 2
                cells = self.cells_at(sides_of(middles, self.points, self.directions))
                touching[cells[cells >= 0]] = True
        return touching

    def _cells_around(self, k: int) -> np.ndarray:
        """Return the cells (k, 4) around each crossing, seen from its first line."""
        edges, around = self.edges, np.full((k, 4), -1, np.int64)
        for node, column in ((edges.end, 0), (edges.start, 2)):
            own = np.flatnonzero(node < k)
            own = own[self.crossing[node[own], 0] == edges.line[own]]
            around[node[own], column], around[node[own], column + 1] = edges.left[own], edges.right[own]
        return around

    def _fits(self) -> bool:
        """Return whether both lines of each crossing see the same cells around it."""
        edges, k = self.edges, len(self.crossing)
        for node, is_after in ((edges.end, False), (edges.start, True)):
            own = np.flatnonzero(node < k)
            own = own[self.crossing[node[own], 1] == edges.line[own]]
            u, v = (self.directions[self.crossing[node[own], i]] for i in (0, 1))
            is_left = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 0) == is_after
            # Of the first line, seen along the second, the cells before are to its left or right.
            column = np.where(is_left, 0, 1)
            back, ahead = self.around[node[own], column], self.around[node[own], column + 2]
            leftward = is_left if is_after else ~is_left
            left, right = np.where(leftward, back, ahead), np.where(leftward, ahead, back)
            if (left != edges.left[own]).any() or (right != edges.right[own]).any():
                return False
        return True

    def cells_at(self, sides: np.ndarray) -> np.ndarray:
        """Return the cell (n,) of points that lie on these ``sides`` (n, m) of the lines, -1 if unassigned."""
        wanted = sides @ _numbers(sides.shape[1])
        cell = np.minimum(np.searchsorted(self._keys, wanted), self.count - 1)
        # By rounding, a point may lie in a cell too small to be kept.
        return np.where(self._keys[cell] == wanted, cell, -1)

    def outline(self, inside: np.ndarray) -> list[list[tuple[int, int]]]:
        """Return the rings around the cells ``inside`` (count,), bool: (line, crossing where its edge begins) in order.

        Exteriors run counterclockwise and holes clockwise; edges on one line that follow each other are one. Cells that
        touch the sides of the rectangle are left out, as no line ends them.
        """
        edges, inside = self.edges, inside & ~self.is_border
        cut = np.flatnonzero(inside[edges.left] != inside[edges.right])
        forward = inside[edges.left[cut]]
        starts, ends = np.where(forward, (edges.start[cut], edges.end[cut]), (edges.end[cut], edges.start[cut]))
        following: dict[int, list[tuple[int, int]]] = {}
        for line, start, end in zip(edges.line[cut].tolist(), starts.tolist(), ends.tolist()):
            following.setdefault(start, []).append((line, end))
        rings = []
        while following:
            rings.append(_walk(following, next(iter(following))))
        return rings


def sides_of(xy: np.ndarray, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Return whether each point (n, 2) lies to the left of each line (m), bool (n, m)."""
    normals = np.column_stack([-directions[:, 1], directions[:, 0]])
    return xy @ normals.T > np.einsum("ij,ij->i", points, normals)


def _numbers(m: int) -> np.ndarray:
    """Return a random number (m,) for each line: no two cells share the sum of those to whose left they lie."""
    return np.random.default_rng(0).integers(1, 2**62, m)


def _walk(following: dict, start: int) -> list[tuple[int, int]]:
    """Take one ring out of ``following`` and return it."""
    here, came, ring = start, -1, []
    while True:
        ways = following[here]
        # Where two rings touch, turn off the line to keep them apart.
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
