"""Lines of samples along an outline, and the straight edges that they are made of.

Samples are positions (m, 2) on an outline, one in the middle of each segment that was traced, with the length of that
segment as weight. The outline has the building on its left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Optional

import numpy as np

# By how much (tolerances, cubed) one edge more has to reduce the squared distances to the samples, summed along the
# line. Fitted on simulated outlines of known buildings.
_PRICE = 0.5

# Edges are looked for between samples that describe the line to this share of the tolerance.
_FINE = 0.25

# Samples at which edges end whose costs are computed at once: enough to pay for the calls of numpy, and no more.
_ENDS_AT_ONCE = 64


@dataclass(frozen=True)
class OutlineEdge:
    """A straight side of an outline.

    Attributes
    ----------
    direction : ndarray of shape (2,), float64
        Unit vector along it.
    point : ndarray of shape (2,), float64
        A point on it (m).
    length : float
        m.
    first, last : int
        Samples of the outline that it goes from and to; of a closed one they may be counted on beyond the last.
    is_main : bool
        Whether it has been turned to a main direction.
    """

    direction: np.ndarray
    point: np.ndarray
    length: float
    first: int
    last: int
    is_main: bool = False

    @property
    def angle(self) -> float:
        """Direction (rad) from east."""
        return float(np.arctan2(self.direction[1], self.direction[0]))

    def offset(self, point: np.ndarray) -> float:
        """Return how far a point lies to the left of this line."""
        return cross(self.direction, point - self.point)

    def foot(self, point: np.ndarray) -> np.ndarray:
        """Return the position on this line that is nearest to a point."""
        return self.point + ((point - self.point) @ self.direction) * self.direction


@dataclass(frozen=True)
class Line:
    """Samples (m, 2) along an outline or a part of it, with their weights (m,).

    A closed one has no end; of an open one the first and last sample are its ends.
    """

    samples: np.ndarray
    weights: np.ndarray
    is_closed: bool

    def rows(self, first: int, last: int) -> np.ndarray:
        """Return the samples from ``first`` to ``last``, which may be beyond the end of a closed line."""
        return np.arange(first, last + 1) % len(self.samples)

    def _between(self, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the samples from ``first`` to ``last`` and their weights."""
        positions, weights = self._twice
        start = first % len(self.samples)
        stop = start + last + 1 - first
        if stop > len(positions):
            rows = self.rows(first, last)
            return self.samples[rows], self.weights[rows]
        return positions[start:stop], weights[start:stop]

    @cached_property
    def _twice(self) -> tuple[np.ndarray, np.ndarray]:
        """Samples and weights; of a closed line two rounds, since a part of these is made faster than chosen rows."""
        if not self.is_closed:
            return self.samples, self.weights
        return np.concatenate([self.samples, self.samples]), np.concatenate([self.weights, self.weights])

    def edges(self, tolerance: float, directions: Sequence[float] = ()) -> list:
        """Return the edges that the line is best made of, wiggles of ``tolerance`` (m) aside, fitted to its samples.

        Those along main ``directions`` (rad) or square to them are preferred.
        """
        bends = self.bends(tolerance, directions).tolist()
        return [self.fitted(first, last, tolerance) for first, last in zip(bends, bends[1:])]

    def bends(self, tolerance: float, directions: Sequence[float] = ()) -> np.ndarray:
        """Return the samples from which edges go to the next: the squares of distances and a price per edge are least.

        The first is repeated at the end of a closed line, a round later.

        References
        ----------
        Perez and Vidal (1994), Optimum polygonal approximation of digitized curves. [perez1994]
        Killick, Fearnhead and Eckley (2012), Optimal detection of changepoints with a linear computational cost.
        [killick2012]
        """
        rows = simplify(self.samples, _FINE * tolerance, self.is_closed)
        if self.is_closed:
            # A place that is sure to be a bend, if there is any: the farthest one.
            away = self.samples[rows] - self.samples.mean(axis=0)
            start = int(np.argmax((away**2).sum(axis=1)))
            rows = np.concatenate([rows[start:], rows[: start + 1] + len(self.samples)])
        return rows[_cheapest_chain(self._moments(rows), _PRICE * tolerance**3, directions)]

    def _moments(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the sums (k, 6) of weights and their moments up to rows in order: without, and with the row itself."""
        within = self.rows(rows[0], rows[-1])
        x, y = (self.samples[within] - self.samples.mean(axis=0)).T
        moments = self.weights[within] * np.stack([np.ones(len(x)), x, y, x * x, x * y, y * y])
        sums = np.cumsum(np.pad(moments, ((0, 0), (1, 0))), axis=1).T
        return sums[rows - rows[0]], sums[rows - rows[0] + 1]

    def fitted(self, first: int, last: int, tolerance: float, direction: Optional[np.ndarray] = None) -> OutlineEdge:
        """Return the edge along the samples from ``first`` to ``last``, of a given direction or their own."""
        positions, weights = self._between(first, last)
        offset = positions - positions[0]
        chord = offset[-1]
        length = float(np.hypot(chord[0], chord[1]))
        along = offset @ (chord / max(length, 1e-9))
        # Corners are rounded by half the tolerance, a spacing: what lies there belongs to no edge.
        inner = np.abs(along - length / 2) <= length / 2 - tolerance / 2
        if np.count_nonzero(inner) >= 3:
            positions, weights = positions[inner], weights[inner]
            offset = positions - positions[0]
        if direction is None:
            direction = _principal(positions, weights, chord)
        east, north = direction.tolist()
        middle = _median(east * offset[:, 1] - north * offset[:, 0], weights)
        center = np.add.reduce(positions) / len(positions) - positions[0]
        point = positions[0] + (center @ direction) * direction + middle * np.array([-north, east])
        return OutlineEdge(direction, point, length, first, last)


def line_along(ring: np.ndarray, outset: float = 0.0) -> Line:
    """Return the samples in the middle of the segments of a closed ring, moved outward by ``outset`` (m)."""
    step = np.diff(ring, axis=0)
    length = np.hypot(*step.T)
    outward = np.column_stack([step[:, 1], -step[:, 0]]) / np.maximum(length, 1e-9)[:, None]
    return Line(ring[:-1] + step / 2 + outset * outward, length, is_closed=True)


def simplify_ring(ring: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the closed ring with the vertices of Douglas and Peucker that keep it within ``tolerance`` (m)."""
    rows = simplify(ring[:-1], tolerance, is_closed=True)
    return ring[np.append(rows, rows[0])]


def simplify(positions: np.ndarray, tolerance: float, is_closed: bool) -> np.ndarray:
    """Return the rows of the vertices of Douglas and Peucker that keep a line within ``tolerance`` (m), ascending."""
    count = len(positions)
    # The two ends of the longest extent are corners of a closed line in any case.
    start = int(np.argmax(((positions - positions.mean(axis=0)) ** 2).sum(axis=1))) if is_closed else 0
    turned = np.roll(positions, -start, axis=0)
    if is_closed:
        turned = np.concatenate([turned, turned[:1]])
    last = len(turned) - 1
    far = int(np.argmax(((turned - turned[0]) ** 2).sum(axis=1))) if is_closed else last
    is_kept = np.zeros(last + 1, bool)
    is_kept[[0, far, last]] = True
    low, high = np.array([0, far]), np.array([far, last])
    while len(low):
        middle, distance = _farthest_from_chords(turned, low, high)
        wide = distance > tolerance
        low, middle, high = low[wide], middle[wide], high[wide]
        is_kept[middle] = True
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    kept = np.flatnonzero(is_kept[:-1] if is_closed else is_kept)
    return np.sort((kept + start) % count)


def _farthest_from_chords(line: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertex of each span of a line that is farthest from the segment between its ends, and how far (m).

    Spans lead from the vertices ``low`` (s,) to ``high`` (s,); where nothing is between, the distance is -1.
    """
    size = np.maximum(high - low - 1, 0)
    first = np.cumsum(size) - size
    span = np.repeat(np.arange(len(low)), size)
    vertex = np.arange(len(span)) + (low + 1 - first)[span]
    along = line[high] - line[low]
    square = np.maximum(along[:, 0] * along[:, 0] + along[:, 1] * along[:, 1], 1e-30)
    east, north = along[span].T
    offset_east, offset_north = (line[vertex] - line[low[span]]).T
    share = np.minimum(np.maximum((offset_east * east + offset_north * north) / square[span], 0.0), 1.0)
    away = np.hypot(offset_east - share * east, offset_north - share * north)
    distance, middle = np.full(len(low), -1.0), low.copy()
    filled = np.flatnonzero(size)
    if len(filled):
        distance[filled] = np.maximum.reduceat(away, first[filled])
        # Of several that are as far, the first one: it is written last.
        farthest = np.flatnonzero(away == distance[span])[::-1]
        middle[span[farthest]] = vertex[farthest]
    return middle, distance


def _cheapest_chain(moments: tuple[np.ndarray, np.ndarray], price: float, directions: Sequence[float]) -> list:
    """Return the positions, from the first to the last, between which edges cost least.

    An edge costs its ``price`` (m³) and its squares; one that has none of the ``directions`` costs the price again.
    """
    before, after = moments
    cost, came = np.zeros(len(before)), np.zeros(len(before), np.int64)
    # An edge that costs more than going on from here in two will do so farther on, too.
    room = price * bool(len(directions))
    starts = np.zeros(1, np.int64)
    for first in range(1, len(before), _ENDS_AT_ONCE):
        ends = np.arange(first, min(first + _ENDS_AT_ONCE, len(before)))
        starts = np.append(starts, ends)
        squares = _squares(after[ends], before[starts], price, directions)
        so_far = np.full(len(starts), np.inf)
        n_earlier = len(starts) - len(ends)
        so_far[:n_earlier] = cost[starts[:n_earlier]]
        for row, end in enumerate(ends.tolist()):
            total = so_far + squares[row]
            best = total.argmin()
            cost[end] = least = total[best] + price
            came[end] = starts[best]
            so_far[total > least + room] = np.inf
            so_far[n_earlier + row] = least
        starts = starts[so_far < np.inf]
    chain = [len(before) - 1]
    while chain[-1]:
        chain.append(int(came[chain[-1]]))
    return chain[::-1]


def _squares(after: np.ndarray, before: np.ndarray, price: float, directions: Sequence[float]) -> np.ndarray:
    """Return the squares (e, s) of edges from starts to ends, with the ``price`` of those that have no direction.

    ``after`` (e, 6) are the sums of moments up to the ends, ``before`` (s, 6) those up to the starts.
    """
    weight, x, y, xx, xy, yy = after.T[:, :, None] - before.T[:, None]
    weight = np.maximum(weight, 1e-12)
    xx, xy, yy = xx - x * x / weight, xy - x * y / weight, yy - y * y / weight
    squares = (xx + yy) / 2 - np.hypot((xx - yy) / 2, xy)
    if len(directions):
        squares += price
    for angle in np.concatenate([directions, np.add(directions, np.pi / 2)]):
        sine, cosine = np.sin(angle), np.cos(angle)
        np.minimum(squares, sine**2 * xx - 2 * sine * cosine * xy + cosine**2 * yy, out=squares)
    return np.maximum(squares, 0.0)


def cross(a: np.ndarray, b: np.ndarray) -> float:
    """Return the cross product of two vectors (2,): positive where the second turns left of the first."""
    return float(a[0] * b[1] - a[1] * b[0])


def _principal(positions: np.ndarray, weights: np.ndarray, chord: np.ndarray) -> np.ndarray:
    """Return the unit direction of positions, along the chord where they have none of their own."""
    x, y = (positions - np.add.reduce(positions * weights[:, None]) / np.add.reduce(weights)).T
    xx, yy, xy = weights @ (x * x), weights @ (y * y), weights @ (x * y)
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    direction = np.array([np.cos(angle), np.sin(angle)])
    along, length = float(direction @ chord), float(np.hypot(chord[0], chord[1]))
    if abs(along) < 0.9 * length:
        return chord / length
    return direction if along > 0 else -direction


def _median(values: np.ndarray, weights: np.ndarray) -> float:
    order = np.argsort(values)
    values, weights = values[order], weights[order]
    total = weights.cumsum() - weights / 2
    return float(np.interp(total[-1] / 2 + weights[-1] / 4, total, values))
