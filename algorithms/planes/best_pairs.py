"""Merge adjacent planes in rounds: each pair that is the best one of both planes."""

from typing import Callable

import numpy as np

from ..geometry.groups import mask_of, placed
from ..neighborhoods.nearest_blocks import PAIRS
from ..stage import Monitor
from ..threads import ROWS_AT_ONCE, in_chunks
from .least_squares_planes import Planes, off_planes

# An odd number whose bits are spread evenly (2^64 over the golden ratio): a product with it, of 64 bits, is a shuffle.
_MIX = np.uint64(0x9E3779B97F4A7C15)

# Costs of merging the planes of pairs (k,), inf where they must not; costs only depend on the two planes.
Cost = Callable[[Planes, np.ndarray, np.ndarray], np.ndarray]


def merge_best_pairs(
    planes: Planes, one: np.ndarray, other: np.ndarray, cost: Cost, monitor: Monitor
) -> tuple[Planes, np.ndarray]:
    """Merge adjacent planes, the most similar first, until none are similar enough.

    Parameters
    ----------
    planes : Planes
        Planes (m,).
    one, other : ndarray of shape (k,), int
        Pairs of planes that are adjacent.
    cost : callable
        Dissimilarity of the planes of pairs, inf where they are not similar enough.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    planes : Planes
        What became of them.
    group : ndarray of shape (m,), int64
        The number of each plane there.

    Notes
    -----
    In a round every pair is merged that both of its planes prefer to all their others. The partition is as by a queue
    from which the most similar pair of all is taken each time. This holds if no merged plane is more similar to a third
    one than both of its parts were. A fixed shuffle of all pairs orders equal costs: in the order of their numbers, one
    pair of a row of equal planes would be merged in a round. Planes that are not similar enough may be so when one of
    them has been merged.
    """
    # The plane that each given plane has become, and the first one of the given planes in each.
    group, first = np.arange(len(planes)), np.arange(len(planes))
    low, high = np.minimum(one, other), np.maximum(one, other)
    low, high = np.divmod(np.unique(low[low != high].astype(np.int64) * len(planes) + high[low != high]), len(planes))
    price = cost(planes, low, high)
    n_first = max(len(planes), 1)
    while True:
        similar = np.flatnonzero(np.isfinite(price))
        if not len(similar):
            return planes, group
        best = similar[_mutually_best(low[similar], high[similar], price[similar], first, len(planes))]
        target = np.arange(len(planes))
        target[high[best]] = low[best]
        stays = target == np.arange(len(planes))
        became = (np.cumsum(stays) - 1)[target]
        planes = planes.merged(became, int(stays.sum()))
        group, first = became[group], first[stays]
        changed = mask_of(len(planes), became[low[best]])
        low, high, price = _adjacent(became[low], became[high], price, len(planes))
        again = changed[low] | changed[high]
        price[again] = cost(planes, low[again], high[again])
        monitor.progress(1 - len(planes) / n_first)


def _mutually_best(low: np.ndarray, high: np.ndarray, price: np.ndarray, first: np.ndarray, n: int) -> np.ndarray:
    """Return the positions of the pairs (k,) that are the best of both of their planes, of all ``n``.

    Of equal prices (k,) a shuffle decides, of the numbers ``first`` (n,) of the planes.
    """
    order = np.lexsort((_shuffled(first[low], first[high]), price))
    rank = placed(np.arange(len(order)), order, len(order))
    least = np.full(n, len(order))
    np.minimum.at(least, low, rank)
    np.minimum.at(least, high, rank)
    return np.flatnonzero((least[low] == rank) & (least[high] == rank))


def _shuffled(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return a number (k,), uint64, of each pair of numbers (k,) below 2^32: others for other pairs, in no order."""
    key = np.minimum(one, other).astype(np.uint64) << np.uint64(32) | np.maximum(one, other).astype(np.uint64)
    return (key ^ key >> np.uint64(32)) * _MIX


def _adjacent(one: np.ndarray, other: np.ndarray, price: np.ndarray, n: int) -> tuple:
    """Return each pair of two different planes once, with one of its prices."""
    low, high = np.minimum(one, other), np.maximum(one, other)
    apart = low != high
    key, position = np.unique(low[apart] * n + high[apart], return_index=True)
    return (*np.divmod(key, n), price[apart][position])


def common_deviation(planes: Planes, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the larger distance (root mean square, m) of the points of two planes from their common plane."""
    deviation = np.empty(len(one))

    def work(rows: np.ndarray) -> None:
        parts = planes.chosen(one[rows]), planes.chosen(other[rows])
        common = _of_both(*parts)
        off = (off_planes(part.center - common.center, part.covariance, common.normal) for part in parts)
        deviation[rows] = np.maximum(*off)

    in_chunks(work, np.arange(len(one)), ROWS_AT_ONCE, Monitor())
    return deviation


def _of_both(one: Planes, other: Planes) -> Planes:
    """Return the planes of the points of pairs of planes."""
    count = one.count + other.count
    share = other.count / count
    apart = other.center - one.center
    between = np.column_stack([apart[:, a] * apart[:, b] for a, b in PAIRS]) * (share * (1 - share))[:, None]
    within = one.covariance + (other.covariance - one.covariance) * share[:, None]
    return Planes(count, one.center + apart * share[:, None], within + between)
