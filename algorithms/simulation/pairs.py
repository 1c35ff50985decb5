"""Pairs of points and boxes, and the order of echoes within their pulses."""

import numpy as np

from ..geometry.groups import items, run_starts


def in_boxes(points: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the pairs (point, box), indices (k,) each, of points (n, 2) inside boxes (m, 2) to (m, 2)."""
    if not len(points) or not len(low):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    first, last = points.min(axis=0), points.max(axis=0)
    box = np.flatnonzero((low <= last).all(axis=1) & (high >= first).all(axis=1))
    # Cells hold eight points on average; the cells of a box in one row are one run of the sorted points.
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
    """Return the position (n,) of each item among those with the same owner, from 0; ``owner`` (n,) is sorted."""
    return items(np.diff(run_starts(owner), append=len(owner)))[1]
