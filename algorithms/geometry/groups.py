"""Items and groups: starts of runs, members of groups, components of pairs, and sets that pairs in portions join."""

from collections.abc import Iterator
from threading import Lock
from typing import Any

import numpy as np

from ..packages import csgraph, sparse


def run_starts(numbers: np.ndarray) -> np.ndarray:
    """Return the indices, int64, ascending, at which runs of equal numbers begin in ``numbers`` (n,)."""
    is_start = np.ones(len(numbers), bool)
    is_start[1:] = numbers[1:] != numbers[:-1]
    return np.flatnonzero(is_start)


def mask_of(length: Any, rows: Any) -> np.ndarray:
    """Return a mask of a ``length``, or of a shape, that is true in some rows or cells."""
    mask = np.zeros(length, bool)
    mask[rows] = True
    return mask


def placed(values: np.ndarray, rows: np.ndarray, length: int, otherwise: float = 0) -> np.ndarray:
    """Return values in their rows of a longer array of their type.

    Parameters
    ----------
    values : ndarray of shape (m, ...)
        Values.
    rows : ndarray of shape (m,), or bool of shape (length,)
        Row of each.
    length : int
        Number of rows.
    otherwise : float
        Value of all other rows.
    """
    whole = np.full((length, *values.shape[1:]), otherwise, values.dtype)
    whole[rows] = values
    return whole


def ordered(key: np.ndarray, *ties: np.ndarray) -> np.ndarray:
    """Return the positions (n,) in ascending order of ``key`` (n,); of equal ones in the order of ``ties``.

    Where few keys are equal, it takes little longer than sorting the keys alone.
    """
    order = np.argsort(key)
    in_order = key[order]
    same = np.append(False, in_order[1:] == in_order[:-1])[: len(key)]
    tied = np.flatnonzero(same | np.append(same[1:], False)[: len(key)])
    rows = order[tied]
    order[tied] = rows[np.lexsort((*(values[rows] for values in ties[::-1]), key[rows]))]
    return order


def topmost(elevation: np.ndarray, cell: np.ndarray, *ties: np.ndarray) -> np.ndarray:
    """Return the row of the highest point of each occupied cell (m,), int64, by cell.

    Parameters
    ----------
    elevation : ndarray of shape (n,)
        Of each point, m.
    cell : ndarray of shape (n,), int64
        Number of the cell that each is in.
    *ties : ndarrays of shape (n,)
        Of points equally high that with the greatest number counts; the first numbers before the second, and the last
        row where all are equal.
    """
    order = np.lexsort((*ties[::-1], elevation, cell))
    # Each run ends before the next one starts, the last one with the points.
    return order[np.append(run_starts(cell[order]), len(order))[1:] - 1]


def least_of(values: np.ndarray, group: np.ndarray, count: int) -> np.ndarray:
    """Return the least of the finite ``values`` (n,) of each ``group`` (n,), (count,); infinite where it has none.

    In numpy before 1.25 several times as fast as ``minimum.at``: any value of a group takes its place, and after that
    only those that are less.
    """
    least = np.full(count, np.inf)
    least[group] = values
    lower = np.flatnonzero(values < least[group])
    # Values in descending order are done at once; where many are left, as of a few groups, the order hardly matters.
    while 0 < 4 * len(lower) <= 3 * len(values):
        values, group = values[lower[::-1]], group[lower[::-1]]
        least[group] = values
        lower = np.flatnonzero(values < least[group])
    np.minimum.at(least, group[lower], values[lower])
    return least


def ranked_by_least(values: np.ndarray, group: np.ndarray) -> np.ndarray:
    """Return the rank (n,), int32, from 1, of the group of each item: groups ascend by their least values."""
    groups, which = np.unique(group, return_inverse=True)
    order = np.argsort(least_of(values, which, len(groups)), kind="stable")
    return placed(np.arange(1, len(groups) + 1, dtype=np.int32), order, len(groups))[which]


def items(counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the items of groups, one group after the other.

    Parameters
    ----------
    counts : ndarray of shape (m,), int
        How many items each group has.

    Returns
    -------
    group : ndarray of shape (n,), int64
        The group of each item, from 0.
    item : ndarray of shape (n,), int64
        Its number in the group, from 0.
    """
    group = np.repeat(np.arange(len(counts)), counts)
    return group, np.arange(len(group)) - np.repeat(np.cumsum(counts) - counts, counts)


def members(group: np.ndarray) -> dict[int, np.ndarray]:
    """Return the positions of each number from 1 on in ``group`` (n,): int64, ascending, by number."""
    positive = np.flatnonzero(group > 0)
    order = positive[np.argsort(group[positive], kind="stable")]
    return {int(group[part[0]]): part for part in np.split(order, run_starts(group[order])[1:]) if len(part)}


def components(one: np.ndarray, other: np.ndarray, count: int) -> tuple[int, np.ndarray]:
    """Group items that are connected by pairs, directly or through others.

    Parameters
    ----------
    one, other : ndarray of shape (k,), int
        The two items of each pair, numbered from 0.
    count : int
        Number of items.

    Returns
    -------
    n_groups : int
        Number of groups.
    group : ndarray of shape (count,), int32
        The group of each item, from 0 in the order of their first items.
    """
    pairs = sparse.coo_matrix((np.ones(len(one), bool), (one, other)), (count, count))
    return csgraph.connected_components(pairs, directed=False)


def cycles(successor: np.ndarray) -> Iterator[np.ndarray]:
    """Yield each cycle of a permutation as an array of its positions."""
    following, is_seen = successor.tolist(), [False] * len(successor)
    for first in range(len(following)):
        cycle, position = [], first
        while not is_seen[position]:
            is_seen[position] = True
            cycle.append(position)
            position = following[position]
        if cycle:
            yield np.array(cycle)


def split_groups(group: np.ndarray, count: int) -> list[np.ndarray]:
    """Return the rows of each group from 0 to ``count`` - 1; rows of -1 are left out."""
    order = np.argsort(group, kind="stable")
    return np.split(order, np.searchsorted(group[order], np.arange(count + 1)))[1:-1]


def number_large(component: np.ndarray, min_points: float) -> np.ndarray:
    """Return ids (n,), int32, from 1 for components of at least ``min_points`` points and 0 for the others.

    ``component`` holds numbers from 0; negative ones are no component.
    """
    inside = component >= 0
    size = np.bincount(component[inside]) if inside.any() else np.zeros(0, np.int64)
    large = (size >= min_points) & (size > 0)
    number = np.where(large, np.cumsum(large), 0).astype(np.int32)
    return placed(number[component[inside]], inside, len(component))


class DisjointSets:
    """Items from 0 to ``count`` - 1, each a set of its own at first. Threads may share them.

    The sets do not depend on the order of the pairs. They take 4 bytes for each item.

    References
    ----------
    Galler, B. A., Fisher, M. J., 1964. An improved equivalence algorithm. Communications of the ACM 7 (5), 301-303.
    [galler1964]

    Examples
    --------
    >>> sets = DisjointSets(5)
    >>> sets.join(np.array([4, 3]), np.array([1, 2]))
    >>> sets.apart(np.array([1, 1]), np.array([4, 3])).tolist()
    [False, True]
    >>> sets.first(np.arange(5)).tolist()
    [0, 1, 2, 2, 1]
    """

    def __init__(self, count: int) -> None:
        # Parent of each item, never larger than the item; a root is its own parent.
        self._lower = np.arange(count, dtype=np.int32)
        self._lock = Lock()

    def apart(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Return the mask of pairs (k,) that have their items in different sets."""
        return self.first(one) != self.first(other)

    def first(self, items: np.ndarray) -> np.ndarray:
        """Return the first item (m,), int32, of the set of each of ``items`` (m,)."""
        with self._lock:
            return self._first(items)

    def join(self, one: np.ndarray, other: np.ndarray) -> None:
        """Join the sets of the two items of each pair (k,)."""
        with self._lock:
            low, high = np.sort([self._first(one), self._first(other)], axis=0).astype(np.int64)
            low, high = np.divmod(np.unique(low[low < high] << 32 | high[low < high]), 2**32)
            items, pairs = np.unique(np.concatenate([low, high]), return_inverse=True)
            pairs = pairs.reshape(2, -1)
            group = components(pairs[0], pairs[1], len(items))[1]
            self._lower[items] = items[np.unique(group, return_index=True)[1]][group]

    def _first(self, items: np.ndarray) -> np.ndarray:
        path, lower = [items], self._lower[items]
        while ((lowest := self._lower[lower]) != lower).any():
            path.append(lower)
            lower = lowest
        # The next search along these items takes one step.
        for step in path:
            self._lower[step] = lower
        return lower
