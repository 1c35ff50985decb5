"""Which points lie in which boxes, and which echo of a pulse is which."""

from __future__ import annotations

import numpy as np

from ..geometry.groups import items, run_starts


def in_boxes(points: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers (k,) of points (n, 2), and of boxes (m, 2) to (m, 2), with the point in the box."""
    if not len(points) or not len(low):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    first, last = points.min(axis=0), points.max(axis=0)
    box = np.flatnonzero((low <= last).all(axis=1) & (high >= first).all(axis=1))
    # Cells of eight points: a column of cells within a box is one run of the sorted points.
    cell = max(float(np.sqrt(np.prod(last - first + 0.1) * 8 / len(points))), 1e-3)
    shape = ((last - first) // cell).astype(np.int64) + 1
    row, column = (((at - start) // cell).astype(np.int64) for at, start in zip(points.T, first))
    key = row * shape[1] + column
    order = np.argsort(key, kind="stable")
    starts = np.searchsorted(key[order], np.arange(shape[0] * shape[1] + 1))
    start = np.clip((low[box] - first) // cell, 0, shape - 1).astype(np.int64)
    end = np.clip((high[box] - first) // cell, 0, shape - 1).astype(np.int64)
    which, column = items(end[:, 0] - start[:, 0] + 1)
    run = (start[which, 0] + column) * shape[1]
    begin, stop = starts[run + start[which, 1]], starts[run + end[which, 1] + 1]
    column_of_point, offset = items(stop - begin)
    point, box = order[begin[column_of_point] + offset], box[which[column_of_point]]
    inside = np.ones(len(point), bool)
    for at, least, most in zip(points.T, low.T, high.T):
        own = at.take(point)
        inside &= (own >= least.take(box)) & (own <= most.take(box))
    return point[inside], box[inside]


def rank(owner: np.ndarray) -> np.ndarray:
    """Return the number of each among its owner's, from 0; ``owner`` (n,) is sorted."""
    return items(np.diff(run_starts(owner), append=len(owner)))[1]
