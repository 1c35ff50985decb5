"""Sets of items that pairs join, for pairs that come in portions: no pair is kept."""

from threading import Lock

import numpy as np

from .groups import components


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
