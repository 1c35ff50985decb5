"""Bridge decks: parts of the bare earth that are raised on both sides, smooth, and joined to it at both ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.components import connect
from ..geometry.grid import distinct, find_cells, grid_over
from ..geometry.groups import items
from ..packages import spatial
from ..stage import Monitor
from .scan_line_pieces import NearPoints, pieces, slices

# Directions of lines: one of them crosses each bridge within 12° of its shortest section.
_DIRECTIONS = 8

# A point of a deck is raised in at least two of them.
_LEAST_DIRECTIONS = 2

# Points below a piece, as a share of its points: beams pass through crowns, and not through decks but at their sides.
_MOST_BELOW = 0.15

# Deviation of a piece from a straight line (root mean square, m): crown, camber and railings of a deck.
_MOST_ROUGH = 0.25

# A deck goes on into the terrain where heights differ by no more (m).
_SAME_LEVEL = 0.5

# Terrain at an end of a deck has at least this many times its points.
_LEAST_TERRAIN = 0.5

# Each end is this share of the length of a deck.
_END = 1 / 3


@dataclass(frozen=True)
class Decks:
    """What a bridge is.

    Attributes
    ----------
    min_height : float
        Height above what lies beside it, m.
    max_width, min_area : float
        Widest section (m) and least area (m²).
    reach : float
        Distance within which points are beside one another, m.
    line_width : float
        Width of a line, m.
    """

    min_height: float
    max_width: float
    min_area: float
    reach: float
    line_width: float

    def find(
        self, xyz: np.ndarray, is_earth: np.ndarray, is_terrain: np.ndarray, near: NearPoints, monitor: Monitor
    ) -> np.ndarray:
        """Return which points (n,) of the bare earth ``is_earth`` (n,) are decks that lead to ``is_terrain`` (n,)."""
        votes = np.zeros(len(xyz), np.int8)
        for number in range(_DIRECTIONS):
            votes += self._raised(xyz, is_earth, near, 180 * number / _DIRECTIONS)
            monitor.progress(0.8 * (number + 1) / _DIRECTIONS)
        candidates = np.flatnonzero(votes >= _LEAST_DIRECTIONS)
        is_deck = np.zeros(len(xyz), bool)
        if not len(candidates):
            return is_deck
        part = connect(xyz[candidates], self.reach, _SAME_LEVEL, monitor.part(0.8, 0.9))
        others = np.flatnonzero(is_earth & (votes < _LEAST_DIRECTIONS))
        terrain = np.flatnonzero(is_terrain & (votes < _LEAST_DIRECTIONS))
        beside = connect(xyz[terrain], self.reach, _SAME_LEVEL, monitor.part(0.9, 1))
        size = np.bincount(beside, minlength=1)[beside]
        for rows in self._large(xyz, candidates, part):
            # The tip of a pier is no terrain that it leads to.
            if self._is_joined(xyz[rows], xyz[terrain[size >= _LEAST_TERRAIN * len(rows)]]):
                is_deck[self._with_edges(xyz, rows, others)] = True
                is_deck[self._with_corners(xyz, rows, others[votes[others] > 0])] = True
        return is_deck

    def _raised(self, xyz: np.ndarray, is_earth: np.ndarray, near: NearPoints, direction: float) -> np.ndarray:
        """Return which points (n,) are of pieces of one direction that have lower points beyond both ends."""
        order, line = slices(xyz, direction, self.line_width)
        angle = np.radians(direction)
        along = xyz[order, 0] * np.cos(angle) + xyz[order, 1] * np.sin(angle)
        height = xyz[order, 2]
        # One axis for all lines, with more room between them than any distance on them.
        along = along - along.min() + line * (2 * np.ptp(along) + 10 * self.reach + self.max_width)
        piece = pieces(xyz, direction, self.line_width, near, 3)[order]
        piece[~is_earth[order]] = -1
        rows = np.flatnonzero(piece >= 0)
        raised = np.zeros(len(xyz), bool)
        if not len(rows):
            return raised
        _, number, count = np.unique(piece[rows], return_inverse=True, return_counts=True)
        first, last = _ends(rows, number, len(count))
        is_raised = (along[last] - along[first] <= self.max_width) & (along[last] - along[first] >= self.reach)
        low = height[first] - self.min_height, height[last] - self.min_height
        is_raised &= _lowest(height, np.searchsorted(along, along[first] - self.reach), first) <= low[0]
        stop = np.searchsorted(along, along[last] + self.reach, side="right")
        is_raised &= _lowest(height, last + 1, stop) <= low[1]
        is_raised &= _roughness(along[rows], height[rows], number, count) <= _MOST_ROUGH
        chosen = np.flatnonzero(is_raised)
        below = _count_below(height, first[chosen], last[chosen], np.minimum(*low)[chosen])
        chosen = chosen[below <= _MOST_BELOW * count[chosen]]
        kept = np.zeros(len(count), bool)
        kept[chosen] = True
        raised[order[rows[kept[number]]]] = True
        return raised

    def _large(self, xyz: np.ndarray, candidates: np.ndarray, part: np.ndarray):
        """Yield the rows of parts that are large enough."""
        grid = grid_over(xyz[candidates], self.reach / 2)
        cells = distinct(part.astype(np.int64) * (grid.rows * grid.columns) + grid.number(xyz[candidates]))[0]
        area = np.bincount(cells // (grid.rows * grid.columns)) * grid.size**2
        for number in np.flatnonzero(area >= self.min_area):
            yield candidates[part == number]

    def _is_joined(self, deck: np.ndarray, others: np.ndarray) -> bool:
        """Return whether a deck goes on into the terrain at both of its ends."""
        if not len(others):
            return False
        plan = deck[:, :2] - deck[:, :2].mean(axis=0)
        axis = np.linalg.svd(plan, full_matrices=False)[2][0]
        along = plan @ axis
        distance, nearest = spatial.cKDTree(others).query(deck, distance_upper_bound=1.5 * self.reach)
        near = np.flatnonzero(np.isfinite(distance))
        near = near[np.abs(others[nearest[near], 2] - deck[near, 2]) <= _SAME_LEVEL]
        if not len(near):
            return False
        low, high = along.min(), along.max()
        return bool(along[near].min() <= low + _END * (high - low) and along[near].max() >= high - _END * (high - low))

    def _with_corners(self, xyz: np.ndarray, rows: np.ndarray, raised: np.ndarray) -> np.ndarray:
        """Return a deck with points beside it that are raised in one direction: corners of slanting and wide decks."""
        distance, nearest = spatial.cKDTree(xyz[rows]).query(xyz[raised], distance_upper_bound=1.5 * self.reach)
        near = np.isfinite(distance)
        raised, nearest = raised[near], nearest[near]
        return np.concatenate([rows, raised[np.abs(xyz[raised, 2] - xyz[rows[nearest], 2]) <= _SAME_LEVEL]])

    def _with_edges(self, xyz: np.ndarray, rows: np.ndarray, others: np.ndarray) -> np.ndarray:
        """Return a deck with the points in its cells that lie at its height, such as those at its edges."""
        grid = grid_over(xyz[np.concatenate([rows, others])], self.reach / 2)
        cells, which = distinct(grid.number(xyz[rows]))
        level = np.bincount(which, xyz[rows, 2]) / np.bincount(which)
        place, found = find_cells(cells, grid.number(xyz[others]))
        same = found & (np.abs(xyz[others, 2] - level[place]) <= _SAME_LEVEL)
        return np.concatenate([rows, others[same]])


def _ends(rows: np.ndarray, number: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the first and the last row of each piece."""
    first, last = np.full(count, np.iinfo(np.int64).max), np.full(count, -1)
    np.minimum.at(first, number, rows)
    np.maximum.at(last, number, rows)
    return first, last


def _lowest(height: np.ndarray, start: np.ndarray, stop: np.ndarray) -> np.ndarray:
    """Return the least height among the rows from ``start`` up to ``stop`` (m,), inf where there are none."""
    which, item = items(np.maximum(stop - start, 0))
    lowest = np.full(len(start), np.inf)
    np.minimum.at(lowest, which, height[start[which] + item])
    return lowest


def _count_below(height: np.ndarray, first: np.ndarray, last: np.ndarray, level: np.ndarray) -> np.ndarray:
    """Return how many points (m,) between the ends of pieces lie below a level."""
    which, item = items(last - first + 1)
    return np.bincount(which, height[first[which] + item] < level[which], len(first))


def _roughness(along: np.ndarray, height: np.ndarray, number: np.ndarray, count: np.ndarray) -> np.ndarray:
    """Return how far (root mean square, m) the points of pieces lie off a straight line."""

    def mean(values: np.ndarray) -> np.ndarray:
        return np.bincount(number, values, len(count)) / count

    x, z = along - mean(along)[number], height - mean(height)[number]
    xx, xz, zz = mean(x * x), mean(x * z), mean(z * z)
    return np.sqrt(np.maximum(zz - np.divide(xz * xz, xx, out=np.zeros_like(xx), where=xx > 0), 0))
