"""Find the polygon that each of many points lies in."""

from __future__ import annotations

import numpy as np

from ..stage import Monitor
from .groups import placed
from .polygon_overlap import Polygons

# Points are sorted into rows so high that a square of that height holds this many of them on average.
_PER_ROW = 1000

# Polygons between two looks at whether to stop.
_BETWEEN_LOOKS = 100


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
        if number % _BETWEEN_LOOKS == 0:
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
        count = max(1, int(np.sqrt(len(plan) / _PER_ROW)))
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
