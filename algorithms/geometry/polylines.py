"""Lines of samples along an outline, and the straight edges that they are made of.

Samples are positions (m, 2) on an outline, one in the middle of each segment that was traced, with the length of that
segment as weight. The outline has the building on its left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

import numpy as np

# By how much (tolerances, cubed) one edge more has to reduce the squared distances to the samples, summed along the
# line. Fitted on simulated outlines of known buildings.
_PRICE = 0.5

# Edges are looked for between samples that describe the line to this share of the tolerance.
_FINE = 0.25


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
        """Return the place on this line that is nearest to a point."""
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
        Perez and Vidal (1994), Optimum polygonal approximation of digitized curves.
        Killick, Fearnhead and Eckley (2012), Optimal detection of changepoints with a linear computational cost.
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
        rows = self.rows(first, last)
        places, weights = self.samples[rows], self.weights[rows]
        chord = places[-1] - places[0]
        length = float(np.hypot(*chord))
        along = (places - places[0]) @ (chord / max(length, 1e-9))
        # Corners are rounded by half the tolerance, a spacing: what lies there belongs to no edge.
        inner = np.abs(along - length / 2) <= length / 2 - tolerance / 2
        if inner.sum() >= 3:
            places, weights = places[inner], weights[inner]
        if direction is None:
            direction = _principal(places, weights, chord)
        across = direction[0] * (places[:, 1] - places[0, 1]) - direction[1] * (places[:, 0] - places[0, 0])
        middle = _median(across, weights) * np.array([-direction[1], direction[0]])
        center = places[0] + ((places.mean(axis=0) - places[0]) @ direction) * direction
        return OutlineEdge(direction, center + middle, length, first, last)


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


def simplify(places: np.ndarray, tolerance: float, is_closed: bool) -> np.ndarray:
    """Return the rows of the vertices of Douglas and Peucker that keep a line within ``tolerance`` (m), ascending."""
    count = len(places)
    # The two ends of the longest extent are corners of a closed line in any case.
    start = int(np.argmax(((places - places.mean(axis=0)) ** 2).sum(axis=1))) if is_closed else 0
    turned = np.roll(places, -start, axis=0)
    if is_closed:
        turned = np.concatenate([turned, turned[:1]])
    last = len(turned) - 1
    far = int(np.argmax(((turned - turned[0]) ** 2).sum(axis=1))) if is_closed else last
    is_kept = np.zeros(last + 1, bool)
    is_kept[[0, far, last]] = True
    spans = [(0, far), (far, last)]
    while spans:
        low, high = spans.pop()
        if high - low < 2:
            continue
        distance = _distances_to_chord(turned[low : high + 1])
        at = int(np.argmax(distance))
        if distance[at] > tolerance:
            middle = low + 1 + at
            is_kept[middle] = True
            spans += [(low, middle), (middle, high)]
    kept = np.flatnonzero(is_kept[:-1] if is_closed else is_kept)
    return np.sort((kept + start) % count)


def _distances_to_chord(line: np.ndarray) -> np.ndarray:
    """Return the distances (m - 2,) of the inner vertices of a line (m, 2) to the segment between its ends."""
    along, offset = line[-1] - line[0], (line[1:-1] - line[0]).T
    share = np.clip((offset[0] * along[0] + offset[1] * along[1]) / max(along @ along, 1e-30), 0, 1)
    return np.hypot(offset[0] - share * along[0], offset[1] - share * along[1])


def _cheapest_chain(moments: tuple[np.ndarray, np.ndarray], price: float, directions: Sequence[float]) -> list:
    """Return the positions, from the first to the last, between which edges cost least.

    An edge costs its ``price`` (m³) and its squares; one that has none of the ``directions`` costs the price again.
    """
    before, after = moments
    angles = np.concatenate([directions, np.add(directions, np.pi / 2)])
    normals = np.stack([np.sin(angles) ** 2, -2 * np.sin(angles) * np.cos(angles), np.cos(angles) ** 2])
    cost, came = np.zeros(len(before)), np.zeros(len(before), np.int64)
    open_ = np.zeros(1, np.int64)
    for here in range(1, len(before)):
        spread = _spread(after[here] - before[open_])
        xx, xy, yy = spread
        squares = (xx + yy) / 2 - np.hypot((xx - yy) / 2, xy)
        if len(angles):
            squares = np.minimum(squares + price, (spread.T @ normals).min(axis=1))
        total = cost[open_] + np.maximum(squares, 0.0)
        best = int(np.argmin(total))
        cost[here], came[here] = total[best] + price, open_[best]
        # An edge that costs more than going on from here in two will do so farther on, too.
        open_ = np.append(open_[total <= cost[here] + price * bool(len(angles))], here)
    chain = [len(before) - 1]
    while chain[-1]:
        chain.append(int(came[chain[-1]]))
    return chain[::-1]


def _spread(moments: np.ndarray) -> np.ndarray:
    """Return the sums (3, n) of squares about the mean: xx, xy, yy."""
    weight, x, y, xx, xy, yy = moments.T
    weight = np.maximum(weight, 1e-12)
    return np.stack([xx - x * x / weight, xy - x * y / weight, yy - y * y / weight])


def cross(a: np.ndarray, b: np.ndarray) -> float:
    """Return the cross product of two vectors (2,): positive where the second turns left of the first."""
    return float(a[0] * b[1] - a[1] * b[0])


def _principal(places: np.ndarray, weights: np.ndarray, chord: np.ndarray) -> np.ndarray:
    """Return the unit direction of places, along the chord where they have none of their own."""
    moved = places - np.average(places, axis=0, weights=weights)
    xx, yy, xy = weights @ moved[:, 0] ** 2, weights @ moved[:, 1] ** 2, weights @ (moved[:, 0] * moved[:, 1])
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    direction = np.array([np.cos(angle), np.sin(angle)])
    along, length = float(direction @ chord), float(np.hypot(*chord))
    if abs(along) < 0.9 * length:
        return chord / length
    return direction if along > 0 else -direction


def _median(values: np.ndarray, weights: np.ndarray) -> float:
    order = np.argsort(values)
    total = np.cumsum(weights[order]) - weights[order] / 2
    return float(np.interp(total[-1] / 2 + weights[order[-1]] / 4, total, values[order]))
