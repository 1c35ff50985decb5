"""Connected components of points under a distance in plan and one in height, exactly and in little memory."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..packages import csgraph, sparse
from ..stage import Monitor

# Point pairs compared at once: 130 bytes each, so 130 MB.
_PAIRS_AT_ONCE = 1_000_000


def connect(xyz: np.ndarray, plan_distance: float, height_distance: float, monitor: Monitor) -> np.ndarray:
    """Find the components of "closer in plan and closer in height", transitively.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    plan_distance, height_distance : float
        Two points are linked when their planimetric distance and their height difference are
        both less than these (m).
    monitor : Monitor
        Hears progress.

    Returns
    -------
    ndarray of shape (n,), int32
        Component of each point, from 0, in the order of their first points.

    Notes
    -----
    Points of one box of ``plan_distance / sqrt(2)`` by ``height_distance`` are always linked, so boxes
    are joined instead of points. Two boxes are compared point by point only while nothing else has
    joined them yet, and pairs of points are never all held at once: memory follows the points, not
    the number of neighbors.
    """
    if not len(xyz):
        return np.zeros(0, np.int32)
    boxes = _Boxes(xyz, plan_distance, height_distance)
    component = np.arange(boxes.count)
    offsets = list(_offsets())
    for done, offset in enumerate(offsets, start=1):
        here, there = boxes.pairs(offset)
        apart = component[here] != component[there]
        here, there = here[apart], there[apart]
        linked = boxes.touching(here, there, plan_distance, height_distance)
        component = _joined(component, here[linked], there[linked])
        monitor.progress(done / len(offsets))
    return _by_first_point(component[boxes.of_point])


class _Boxes:
    """Points sorted into boxes that are small enough to link all that they hold."""

    def __init__(self, xyz: np.ndarray, plan_distance: float, height_distance: float) -> None:
        # A whisker smaller, so that even a box's diagonal is strictly less than the distance.
        size = np.array([plan_distance / np.sqrt(2), plan_distance / np.sqrt(2), height_distance]) * (1 - 1e-9)
        box = np.floor((xyz - xyz.min(axis=0)) / size).astype(np.int64)
        # Room for the offsets on all sides keeps neighbors from wrapping around.
        self.shape = box.max(axis=0) + 5
        key = self._key(box)
        self.order = np.argsort(key, kind="stable")
        self.keys, self.start, self.size, inverse = _runs(key[self.order])
        self.count = len(self.keys)
        self.of_point = np.empty(len(xyz), np.int64)
        self.of_point[self.order] = inverse
        self.xyz = xyz[self.order]

    def _key(self, box: np.ndarray) -> np.ndarray:
        return (box[..., 0] * self.shape[1] + box[..., 1]) * self.shape[2] + box[..., 2]

    def pairs(self, offset: tuple[int, int, int]) -> tuple[np.ndarray, np.ndarray]:
        """Return the numbers of occupied boxes that lie ``offset`` apart."""
        wanted = self.keys + self._key(np.array(offset))
        there = np.minimum(np.searchsorted(self.keys, wanted), self.count - 1)
        here = np.flatnonzero(self.keys[there] == wanted)
        return here, there[here]

    def touching(self, here: np.ndarray, there: np.ndarray, plan_distance: float, height_distance: float) -> np.ndarray:
        """Return which of the pairs of boxes hold a pair of points that is linked."""
        touching = np.zeros(len(here), bool)
        for pair, a, b in self._point_pairs(here, there):
            d = self.xyz[a] - self.xyz[b]
            linked = (d[:, 0] ** 2 + d[:, 1] ** 2 < plan_distance**2) & (np.abs(d[:, 2]) < height_distance)
            touching[pair[linked]] = True
        return touching

    def _point_pairs(self, here: np.ndarray, there: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Yield chunks of (box pair, point, point) over all pairs of points of the pairs of boxes."""
        sizes = self.size[here] * self.size[there]
        ends = np.cumsum(sizes)
        total = int(ends[-1]) if len(ends) else 0
        for first in range(0, total, _PAIRS_AT_ONCE):
            number = np.arange(first, min(first + _PAIRS_AT_ONCE, total))
            pair = np.searchsorted(ends, number, side="right")
            within = number - (ends[pair] - sizes[pair])
            a, b = np.divmod(within, self.size[there[pair]])
            yield pair, self.start[here[pair]] + a, self.start[there[pair]] + b


def _offsets() -> Iterator[tuple[int, int, int]]:
    """Yield the boxes around a box that can hold a linked point, one of each opposite pair, nearest first."""
    around = [(i, j, k) for i in range(-2, 3) for j in range(-2, 3) for k in (-1, 0, 1)]
    half = [offset for offset in around if offset > (0, 0, 0)]
    yield from sorted(half, key=lambda offset: (sum(abs(step) for step in offset), offset))


def _runs(keys: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return values, starts and lengths of the runs of a sorted array, and the run of each element."""
    is_start = np.append(True, keys[1:] != keys[:-1])
    start = np.flatnonzero(is_start)
    return keys[start], start, np.diff(np.append(start, len(keys))), np.cumsum(is_start) - 1


def _joined(component: np.ndarray, here: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Return the components after joining those of the boxes ``here`` and ``there``."""
    if not len(here):
        return component
    count = int(component.max()) + 1
    links = sparse.coo_matrix((np.ones(len(here), bool), (component[here], component[there])), (count, count))
    return csgraph.connected_components(links, directed=False)[1][component]


def _by_first_point(component: np.ndarray) -> np.ndarray:
    """Renumber components from 0 in the order of their first points."""
    _, first, inverse = np.unique(component, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int32)
    rank[np.argsort(first)] = np.arange(len(first), dtype=np.int32)
    return rank[inverse]


def number_large(component: np.ndarray, min_points: float) -> np.ndarray:
    """Return ids (n,), int32, from 1 for components of at least ``min_points`` points and 0 for the others.

    ``component`` holds numbers from 0; negative ones are no component.
    """
    inside = component >= 0
    size = np.bincount(component[inside]) if inside.any() else np.zeros(0, np.int64)
    large = (size >= min_points) & (size > 0)
    number = np.where(large, np.cumsum(large), 0).astype(np.int32)
    ids = np.zeros(len(component), np.int32)
    ids[inside] = number[component[inside]]
    return ids
