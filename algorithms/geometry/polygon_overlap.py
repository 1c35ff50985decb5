"""Polygons in plan: their areas of overlap, exactly, and the polygon that each of many points lies in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..stage import Monitor
from ..threads import PAIRS_AT_ONCE
from .groups import items, placed, split_groups
from .rings import signed_area


@dataclass(frozen=True)
class Polygons:
    """Polygons as edges: ``edges`` (m, 2, 2) from vertex to vertex, polygon i's from ``first[i]`` on.

    Exteriors run counterclockwise and holes clockwise. ``box`` (n, 2, 2) holds the least and the greatest coordinates.
    """

    edges: np.ndarray
    first: np.ndarray
    box: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """Number of edges of each polygon."""
        return np.diff(self.first)

    @property
    def area(self) -> np.ndarray:
        """Area (n,) of each polygon, m²; lobes of rings that cross themselves count against each other."""
        number = np.repeat(np.arange(len(self.box)), self.size)
        (x0, y0), (x1, y1) = np.moveaxis(self.edges - self.box[number, :1], 0, -1)
        return 0.5 * np.bincount(number, x0 * y1 - x1 * y0, len(self.box))

    def moved(self, shift: np.ndarray) -> Polygons:
        """Return the polygons moved by ``shift`` (2,), m."""
        return Polygons(self.edges + shift, self.first, self.box + shift)


def as_polygons(geometries: list) -> Polygons:
    """Return polygons, each a list of closed rings (k, 2 or 3), as edges, in the right direction."""
    edges = [np.concatenate([_edges(ring, i == 0) for i, ring in enumerate(rings)]) for rings in geometries]
    box = [np.stack([part.min(axis=(0, 1)), part.max(axis=(0, 1))]) for part in edges]
    first = np.cumsum([0, *map(len, edges)])
    return Polygons(np.concatenate([np.zeros((0, 2, 2)), *edges]), first, np.reshape(box, (-1, 2, 2)))


def _edges(ring: np.ndarray, is_exterior: bool) -> np.ndarray:
    """Return the edges (k, 2, 2) of a ring in plan: an exterior counterclockwise, a hole clockwise."""
    plan = np.asarray(ring, float)[:, :2]
    plan = plan if (signed_area(plan) > 0) == is_exterior else plan[::-1]
    return np.stack([plan[:-1], plan[1:]], axis=1)


def overlaps(first: Polygons, second: Polygons, monitor: Monitor) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the pairs of polygons whose boxes meet, and the area (m²) that each pair shares.

    Returns
    -------
    one, other : ndarrays of shape (k,), int64
        Positions in ``first`` and in ``second``.
    area : ndarray of shape (k,), float64
        Area that is in both, each position as often as the rings wind around it (once in a valid polygon).

    Notes
    -----
    A polygon is the signed sum of what lies below its edges. Two polygons share the signed sum of what lies below
    both of two edges, which is the integral of the smaller of two straight lines.
    """
    one, other = meeting_boxes(first.box, second.box)
    return one, other, shared_areas(first, second, one, other, monitor)


def shared_areas(first: Polygons, second: Polygons, one: np.ndarray, other: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return the area (k,), m², that polygon ``one[i]`` of the first and ``other[i]`` of the second share.

    Parameters
    ----------
    first : Polygons
        Polygons of one layer.
    second : Polygons
        Polygons of the other layer.
    one : ndarray of shape (k,), int
        Polygons of the first.
    other : ndarray of shape (k,), int
        Polygons of the second.
    monitor : Monitor
        Receives the progress.
    """
    area = np.zeros(len(one))
    # Edges of the first polygons, each with all edges of the second of its pair.
    pair, edge = items(first.size[one])
    work = np.cumsum(second.size[other[pair]])
    start = 0
    while start < len(pair):
        done = work[start - 1] if start else 0
        end = max(start + 1, int(np.searchsorted(work, done + PAIRS_AT_ONCE)))
        low, high = pair[start], pair[end - 1] + 1
        rows = pair[start:end] - low, edge[start:end]
        area[low:high] += _shared(first, second, one[low:high], other[low:high], *rows)
        start = end
        monitor.progress(start / len(pair))
    return np.maximum(area, 0.0)


def meeting_boxes(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the pairs of boxes (n, 2, 2) and (m, 2, 2) that meet, by the first, then by the second."""
    if not len(first) or not len(second):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    order = np.argsort(second[:, 0, 0], kind="stable")
    west = second[order, 0, 0]
    # A box that begins farther west than the greatest width of any box can't reach this one.
    widest = float((second[:, 1, 0] - second[:, 0, 0]).max())
    low = np.searchsorted(west, first[:, 0, 0] - widest)
    count = np.searchsorted(west, first[:, 1, 0], side="right") - low
    # Each strip from south to north has many pairs; the pairs of a country do not fit in memory at once.
    part, found = np.cumsum(count) // PAIRS_AT_ONCE, []
    for rows in np.split(np.arange(len(first)), np.flatnonzero(np.diff(part)) + 1):
        near, step = items(count[rows])
        one, other = rows[near], order[low[rows[near]] + step]
        meet = (first[one, 0] <= second[other, 1]).all(axis=1) & (second[other, 0] <= first[one, 1]).all(axis=1)
        found.append((one[meet], other[meet]))
    one, other = (np.concatenate(rows) for rows in zip(*found))
    by_both = np.lexsort((other, one))
    return one[by_both], other[by_both]


def in_squares(boxes: np.ndarray, reach: float, side: float) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return rows of boxes (n, 2, 2) with middles in a square of a side (m), those within a reach (m), and their box.

    The squares begin at the corner of all; together they hold each row once.
    """
    corner = boxes[:, 0].min(axis=0, initial=np.inf)
    squares, square = np.unique((boxes.mean(axis=1) - corner) // side, axis=0, return_inverse=True)
    groups = split_groups(square.ravel(), len(squares))
    around = [[boxes[own, 0].min(axis=0) - reach, boxes[own, 1].max(axis=0) + reach] for own in groups]
    one, near = meeting_boxes(np.reshape(around, (-1, 2, 2)), boxes)
    return zip(groups, np.split(near, np.searchsorted(one, np.arange(1, len(groups)))), np.array(around))


def _shared(
    first: Polygons, second: Polygons, one: np.ndarray, other: np.ndarray, pair_of_edge: np.ndarray, edge: np.ndarray
) -> np.ndarray:
    """Return the area below the edges ``edge`` of the first polygon of pairs that the second of them shares."""
    row, column = items(second.size[other[pair_of_edge]])
    pair = pair_of_edge[row]
    # From a corner of the pair: large coordinates would lose the area's digits.
    origin = first.box[one[pair], 0][:, None]
    edges_of_first = first.edges[first.first[one[pair]] + edge[row]] - origin
    edges_of_second = second.edges[second.first[other[pair]] + column] - origin
    return np.bincount(pair, _below_both(edges_of_first, edges_of_second), len(one))


def _below_both(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return the signed area below both edges (k, 2, 2) of each pair: positive when they run the same way."""
    west = np.maximum(first[:, :, 0].min(axis=1), second[:, :, 0].min(axis=1))
    east = np.minimum(first[:, :, 0].max(axis=1), second[:, :, 0].max(axis=1))
    width = np.maximum(east - west, 0.0)
    at_west, at_east = (_height(first, x) - _height(second, x) for x in (west, east))
    total = sum(_height(edges, x) for edges in (first, second) for x in (west, east))
    # min(a, b) = (a + b)/2 - |a - b|/2, and the lines may cross in between.
    one, other = np.abs(at_west), np.abs(at_east)
    crossing = at_west * at_east < 0
    both = np.where(crossing, one + other, 1.0)
    apart = np.where(crossing, (one**2 + other**2) / both, one + other)
    sign = np.sign(first[:, 1, 0] - first[:, 0, 0]) * np.sign(second[:, 1, 0] - second[:, 0, 0])
    return sign * width * (total - apart) / 4


def _height(edges: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return the ordinates of the lines of edges (k, 2, 2) at ``x`` (k,); any for vertical ones, without a width."""
    (x0, y0), (x1, y1) = edges[:, 0].T, edges[:, 1].T
    run = np.where(x1 == x0, 1.0, x1 - x0)
    return y0 + (x - x0) / run * (y1 - y0)


def are_in_polygons(plan: np.ndarray, polygons: Polygons, monitor: Monitor) -> np.ndarray:
    """Return the mask of points that lie in at least one polygon, holes left out; arguments as for :func:`holders`."""
    return holders(plan, polygons, monitor) >= 0


def holders(plan: np.ndarray, polygons: Polygons, monitor: Monitor) -> np.ndarray:
    """Return the first polygon that each point lies in, holes left out; -1 where it lies in none.

    Parameters
    ----------
    plan : ndarray of shape (n, 2)
        Easting and northing, m.
    polygons : Polygons
        From :func:`.as_polygons`, in the same coordinates. They may overlap.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    ndarray of int64, shape (n,)
        Of two polygons with a common edge exactly one holds a point on it.

    Notes
    -----
    A point lies in a polygon if an odd number of its edges lie east of it. Points are sorted by northing, so that an
    edge is compared only with those at its own height, in the box of its polygon.
    """
    found = np.full(len(plan), -1)
    if not len(plan):
        return found
    rows = _Rows(plan)
    for number, box in enumerate(polygons.box):
        if number % 100 == 0:
            monitor.progress(number / len(polygons.box))
        near = rows.within(box)
        near = near[found[near] < 0]
        edges = polygons.edges[polygons.first[number] : polygons.first[number + 1]]
        found[near[are_within(plan[near], edges)]] = number
    monitor.progress(1.0)
    return found


class _Rows:
    """Points sorted into rows of equal height, and by easting within each."""

    def __init__(self, plan: np.ndarray) -> None:
        self.plan, self.low = plan, plan[:, 1].min()
        # A square as high as a row holds 1000 points on average.
        count = max(1, int(np.sqrt(len(plan) / 1000)))
        self.height = max(float(np.ptp(plan[:, 1])) / count, 1e-9)
        row = ((plan[:, 1] - self.low) / self.height).astype(np.int64)
        self.order = np.lexsort([plan[:, 0], row])
        self.easting = plan[self.order, 0]
        self.start = np.searchsorted(row[self.order], np.arange(row.max() + 2))

    def within(self, box: np.ndarray) -> np.ndarray:
        """Return the positions (m,) of the points in a box (2, 2), edges included."""
        bottom, top = np.clip((box[:, 1] - self.low) / self.height, -1, len(self.start) - 1).astype(np.int64)
        found = [np.zeros(0, np.int64)]
        for row in range(max(bottom, 0), min(top, len(self.start) - 2) + 1):
            of_row = slice(self.start[row], self.start[row + 1])
            first = self.start[row] + np.searchsorted(self.easting[of_row], box[0, 0], "left")
            last = self.start[row] + np.searchsorted(self.easting[of_row], box[1, 0], "right")
            found.append(self.order[first:last])
        near = np.concatenate(found)
        northing = self.plan[near, 1]
        return near[(northing >= box[0, 1]) & (northing <= box[1, 1])]


def are_within(plan: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return the mask of points (n, 2) within the edges (m, 2, 2) of rings: an odd number lies to their east."""
    order = np.argsort(plan[:, 1], kind="stable")
    x, y = plan[order].T
    # From the lower end of each edge to the upper one, which belongs to the next edge.
    upward = np.where((edges[:, :1, 1] <= edges[:, 1:, 1])[..., None], edges, edges[:, ::-1])
    first, last = np.searchsorted(y, upward[..., 1], "left").T
    is_odd = np.zeros(len(plan), bool)
    for ((x0, y0), (x1, y1)), start, stop in zip(upward, first, last):
        if start < stop:
            is_odd[start:stop] ^= x[start:stop] < x0 + (y[start:stop] - y0) * ((x1 - x0) / (y1 - y0))
    return placed(is_odd, order, len(plan))
