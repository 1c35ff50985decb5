"""Filters of the numbers of points in voxels: convolutions and rank orders over a voxel and its 26 neighbors."""

from typing import Callable

import numpy as np

from ..stage import Monitor
from ..threads import ROWS_AT_ONCE
from .sparse_voxels import Keys, dilate, find_keys, neighbor_offsets

# A voxel and its neighbors, sorted; the voxel itself is in the middle.
_STEPS = np.insert(neighbor_offsets(26), 13, 0, axis=0)

# Binomial weights, 1 2 1 along each axis, whose sum is one: they fall with the distance as a Gaussian does.
_BINOMIAL = np.prod(2.0 - np.abs(_STEPS), axis=1) / 64

FILTERS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "mean": lambda counts: counts.mean(axis=1),
    "binomial": lambda counts: counts @ _BINOMIAL,
    "minimum": lambda counts: counts.min(axis=1),
    "median": lambda counts: np.median(counts, axis=1),
    "maximum": lambda counts: counts.max(axis=1),
}


def filter_counts(cells: np.ndarray, count: np.ndarray, name: str, monitor: Monitor) -> tuple[np.ndarray, np.ndarray]:
    """Filter the numbers of points in voxels, 0 in all that are not listed.

    Parameters
    ----------
    cells : ndarray of shape (m, 3), int64
        Occupied voxels, sorted.
    count : ndarray of shape (m,)
        Points in each.
    name : str
        One of ``FILTERS``.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    cells : ndarray of shape (k, 3), int64
        The voxels in which the filter gives more than 0, sorted.
    value : ndarray of shape (k,), float64
        What it gives there.
    """
    reached = dilate(cells, 26)
    box = Keys(reached)
    known, keys = box.of(cells), box.of(reached)
    steps, padded = box.step(_STEPS), np.append(count, 0).astype(float)
    value = np.zeros(len(reached))
    for start in range(0, len(reached), ROWS_AT_ONCE):
        monitor.progress(start / len(reached))
        part = slice(start, start + ROWS_AT_ONCE)
        around = keys[part, None] + steps
        value[part] = FILTERS[name](padded[find_keys(known, around.ravel()).reshape(around.shape)])
    return reached[value > 0], value[value > 0]
