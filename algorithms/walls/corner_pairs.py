"""The edges of a building as published in 2022: pairs of corners with many wall points between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.arrangement import Arrangement
from ..geometry.groups import components
from ..packages import csgraph, sparse
from .wall_lines import WallLine, fit_line

# Pairs of points that lines are tried through, for each line.
_TRIALS = 500

# Most points that trial lines are scored on: a sample of as many ranks them as all do.
_SCORED = 3000

# Least distance (m) between the two points of a trial line, as in the authors' program.
_LEAST_PAIR = 0.5

# Corners are looked for up to this far (m) outside of the box around the wall points, as in the authors' program.
_AROUND = 10.0

# Positions along a line that are nearer to each other than this (m) are the same.
_SAME = 1e-3


@dataclass(frozen=True)
class Buffer:
    """The rectangle along the connection of two corners in which wall points are counted."""

    width: float  #: Reach to both sides, m
    ends: float  #: Length left out at both ends, m
    min_density: float  #: Points per m² at which the connection is an edge

    def count(self, xy: np.ndarray, start: np.ndarray, end: np.ndarray) -> tuple[int, float]:
        """Return how many points (n, 2), m, lie in the rectangle between two corners, and per m² of it."""
        length = float(np.hypot(*(end - start)))
        if length <= 2 * self.ends:
            return 0, 0.0
        way, offset = (end - start) / length, xy - start
        along, across = offset @ way, offset @ [-way[1], way[0]]
        inside = (along > self.ends) & (along < length - self.ends) & (np.abs(across) < self.width)
        count = int(np.count_nonzero(inside))
        return count, count / (2 * self.width * (length - 2 * self.ends))


@dataclass(frozen=True)
class CornerPairs:
    """The corners of a building, and the pairs of them with a wall between."""

    cells: Arrangement  #: The cells that its lines cut
    at: np.ndarray  #: (c,): the crossings of lines that are corners
    edges: list[tuple[int, int, int, float]]  #: Two corners, and the wall points between them, also per m²

    @property
    def corners(self) -> np.ndarray:
        """Positions (c, 2) of the corners, m."""
        return self.cells.positions[self.at]

    def outline(self) -> tuple[list[np.ndarray], np.ndarray]:
        """Return rings (m, 2), m, around what edges enclose, and which corners (c,) are vertices of them.

        Inside are the cells from which a way outside passes an odd number of edges at least; further in are courtyards.
        """
        cells, is_wall = self.cells, self._is_wall()
        left, right = cells.edges.left, cells.edges.right
        count, part = components(left[~is_wall], right[~is_wall], cells.count)
        passed = part[left[is_wall]], part[right[is_wall]]
        passes = csgraph.shortest_path(
            sparse.coo_matrix((np.ones(is_wall.sum()), passed), (count, count)),
            directed=False,
            unweighted=True,
            indices=part[np.argmax(cells.is_border)],
        )
        rings = [[at for _, at in ring] for ring in cells.outline(passes[part] % 2 == 1)]
        vertices = np.array([at for ring in rings for at in ring], np.int64)
        return [cells.positions[[*ring, ring[0]]] for ring in rings], np.isin(self.at, vertices)

    def _is_wall(self) -> np.ndarray:
        """Return the mask of pieces (e,) of lines between two crossings that lie on an edge."""
        pieces, lines = self.cells.edges, self.cells.crossing[self.at]
        is_wall = np.zeros(len(pieces.line), bool)
        for i, j, *_ in self.edges:
            for line in np.intersect1d(lines[i], lines[j]):
                ends = self.corners[[i, j]] - self.cells.points[line]
                low, high = np.sort(ends @ self.cells.directions[line])
                is_wall |= (pieces.line == line) & (pieces.low > low - _SAME) & (pieces.high < high + _SAME)
        return is_wall


def sequential_lines(xy: np.ndarray, tolerance: float, min_points: int, seed: int) -> list[WallLine]:
    """Return lines by RANSAC, each taken out in turn.

    Parameters
    ----------
    xy : ndarray of shape (n, 2), float64
        Positions in plan, m.
    tolerance : float
        Greatest distance of a point from its line, m.
    min_points : int
        Least number of points on a line.
    seed : int
        Start of the random numbers.
    """
    rng, left, lines = np.random.default_rng(seed), np.arange(len(xy)), []
    while len(left) >= min_points:
        on_line = left[_on_best_line(xy[left], tolerance, rng)]
        if len(on_line) < max(min_points, 2):
            break
        lines.append(fit_line(xy, on_line))
        left = np.setdiff1d(left, on_line, assume_unique=True)
    return lines


def _on_best_line(xy: np.ndarray, tolerance: float, rng: np.random.Generator) -> np.ndarray:
    """Return the mask of points (n,) on the line that holds most, of those through pairs of points."""
    start, end = xy[rng.integers(0, len(xy), (2, _TRIALS))]
    step = end - start
    length = np.hypot(*step.T)
    is_long = length >= _LEAST_PAIR
    if not is_long.any():
        return np.zeros(len(xy), bool)
    normal = np.column_stack([-step[is_long, 1], step[is_long, 0]]) / length[is_long, None]
    level = np.einsum("ij,ij->i", normal, start[is_long])
    scored = xy if len(xy) <= _SCORED else xy[rng.choice(len(xy), _SCORED, replace=False)]
    best = int(np.argmax(np.count_nonzero(np.abs(scored @ normal.T - level) <= tolerance, axis=0)))
    return np.abs(xy @ normal[best] - level[best]) <= tolerance


def corner_pairs(lines: list[WallLine], xy: np.ndarray, max_skew: float, buffer: Buffer) -> CornerPairs:
    """Return the corners of a building, where two lines are square within an angle (°), and those with a wall between.

    Parameters
    ----------
    lines : list of WallLine
        Its lines.
    xy : ndarray of shape (n, 2)
        Its wall points, m.
    max_skew : float
        Largest deviation from a right angle, °.
    buffer : Buffer
        Where points are counted.
    """
    points, ways = (np.array([getattr(line, name) for line in lines]).reshape(-1, 2) for name in ("point", "direction"))
    cells = Arrangement(points, ways, xy.min(axis=0) - _AROUND, xy.max(axis=0) + _AROUND)
    u, v = np.moveaxis(ways[cells.crossing], 1, 0)
    at = np.flatnonzero(np.abs(np.einsum("ij,ij->i", u, v)) <= np.sin(np.deg2rad(max_skew)))
    corners, edges = cells.positions[at], []
    for i, j in zip(*np.triu_indices(len(at), 1)):
        count, density = buffer.count(xy, corners[i], corners[j])
        if density >= buffer.min_density and not buffer.count(corners, corners[i], corners[j])[0]:
            edges.append((i, j, count, density))
    return CornerPairs(cells, at, edges)
