"""Points sorted into small boxes, so that pairs of near points are found without a list of neighbors per point."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Callable

import numpy as np

from ..stage import Monitor
from ..threads import PAIRS_AT_ONCE
from .groups import components, placed, run_starts

# A near point lies at most this many boxes away.
_REACH = 2

Offset = tuple[int, int, int]


class Boxes:
    """Points sorted by the box of a regular grid that they lie in.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    side : float or ndarray of shape (3,)
        Sides of a box, m.
    from_zero : bool
        Whether boxes are at multiples of their sides, so that a part of a cloud has the boxes of the whole; else they
        begin at the least coordinates of the points.

    Attributes
    ----------
    order : ndarray of shape (n,)
        Points in the order of their boxes; ``xyz`` holds them in this order.
    keys : ndarray of shape (b,), int64
        Number of each occupied box, ascending.
    start, size : ndarray of shape (b,)
        Where a box's points start in ``order``, and how many they are.

    Raises
    ------
    ValueError
        If there are more boxes than 64-bit numbers, as the points are spread too far.
    """

    def __init__(self, xyz: np.ndarray, side, from_zero: bool = False) -> None:
        # Column by column: numpy works on three numbers at a time where rows are as short.
        sides = np.broadcast_to(np.asarray(side, float), 3)
        low = np.array([column.min() for column in xyz.T])
        start = np.floor(low / sides) * sides if from_zero else low
        box = [np.floor((xyz[:, axis] - start[axis]) / sides[axis]).astype(np.int64) for axis in range(3)]
        box = [column - column.min() for column in box]
        # A margin on all sides keeps neighbors from wrapping around.
        self.shape = np.array([column.max() for column in box]) + 2 * _REACH + 1
        # Numbers of boxes are of 64 bits.
        if math.prod(self.shape.tolist()) > np.iinfo(np.int64).max:
            spread = " by ".join(f"{extent:,.0f}" for extent in np.ptp(xyz, axis=0))
            raise ValueError(
                f"The points are spread over {spread} m, too far to be looked at in boxes of {np.min(side):.2g} m; "
                "remove points that lie far off, or choose larger distances."
            )
        key = (box[0] * self.shape[1] + box[1]) * self.shape[2] + box[2]
        order = np.argsort(key, kind="stable")
        self._fill(order, xyz.take(order, axis=0), key[order])

    def _fill(self, order: np.ndarray, xyz: np.ndarray, key: np.ndarray) -> None:
        """Take points (n,), their coordinates (n, 3) and the numbers of their boxes (n,), all in that order."""
        self.order, self.xyz = order, xyz
        self.start = run_starts(key)
        self.keys, self.size = key[self.start], np.diff(self.start, append=len(key))

    def __len__(self) -> int:
        return len(self.keys)

    def of(self, chosen: np.ndarray) -> Boxes:
        """Return the boxes of the ``chosen`` points only: a mask (n,) in the order of the boxes."""
        part = object.__new__(Boxes)
        part.shape = self.shape
        part._fill(self.order[chosen], self.xyz[chosen], np.repeat(self.keys, self.size)[chosen])
        return part

    def box(self) -> np.ndarray:
        """Return the number of the box (n,) of each point, in the order of the boxes."""
        return np.repeat(np.arange(len(self)), self.size)

    def _key(self, box: np.ndarray) -> np.ndarray:
        """Return the number (...) of a box (..., 3), or the difference of the numbers of two boxes by their offset."""
        return (box[..., 0] * self.shape[1] + box[..., 1]) * self.shape[2] + box[..., 2]

    def beside(self, other: Boxes, offset: Offset) -> tuple[np.ndarray, np.ndarray]:
        """Return the mask of boxes with a box of ``other`` (same grid) ``offset`` away, and the indices of those."""
        wanted = self.keys + self._key(np.array(offset))
        there = np.minimum(np.searchsorted(other.keys, wanted), len(other) - 1)
        here = np.flatnonzero(other.keys[there] == wanted) if len(other) else np.zeros(0, np.int64)
        return here, there[here]

    def beside_all(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield the pairs of occupied boxes that may hold near points, each pair once: which boxes, and which others.

        Others lie in one column of the boxes around; of two opposite columns the second has the same pairs.
        """
        half = {offset[:2] for offset in around() if offset > (0, 0, 0)}
        for column in sorted(half, key=lambda step: (step[0] ** 2 + step[1] ** 2, step)):
            lowest = -_REACH if any(column) else 1
            wanted = self.keys + self._key(np.array([*column, lowest]))
            there = np.searchsorted(self.keys, wanted)
            found = []
            for _ in range(lowest, _REACH + 1):
                here = np.flatnonzero(self.keys[np.minimum(there, len(self) - 1)] == wanted)
                found.append((here, there[here]))
                # Box numbers grow upward: the next box has the next number.
                there[here] += 1
                wanted += 1
            yield np.concatenate([one for one, _ in found]), np.concatenate([other for _, other in found])

    def pairs(
        self, here: np.ndarray, other: Boxes, there: np.ndarray
    ) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Yield chunks of (pair of boxes, point, point of ``other``) over all points of the pairs of boxes.

        Points are counted in the order of the boxes.
        """
        own, others = self.size[here], other.size[there]
        ends = np.cumsum(own * others)
        total = int(ends[-1]) if len(ends) else 0
        for first in range(0, total, PAIRS_AT_ONCE):
            number = np.arange(first, min(first + PAIRS_AT_ONCE, total))
            pair = np.searchsorted(ends, number, side="right")
            a, b = np.divmod(number - (ends[pair] - own[pair] * others[pair]), others[pair])
            yield pair, self.start[here[pair]] + a, other.start[there[pair]] + b


def around(reach: int = _REACH) -> list[Offset]:
    """Return the steps to the boxes around a box, nearest first."""
    steps = range(-reach, reach + 1)
    offsets = [(i, j, k) for i in steps for j in steps for k in steps if (i, j, k) != (0, 0, 0)]
    return sorted(offsets, key=lambda offset: (sum(step * step for step in offset), offset))


def connected(boxes: Boxes, is_near: Callable[[np.ndarray], np.ndarray], monitor: Monitor) -> np.ndarray:
    """Return components (b,) of boxes in which each holds a point near one of the next.

    Parameters
    ----------
    boxes : Boxes
        Boxes so small that all points of one are near each other.
    is_near : callable
        Returns for offsets (m, 3) between points whether the points are near (m,).
    monitor : Monitor
        Receives progress.

    Notes
    -----
    Two boxes are compared point by point only while nothing else has joined them yet, and before that by one point
    each, which joins most. Pairs of points are never all held at once, and memory follows the points.
    """
    component = np.arange(len(boxes))
    # Of so few points, comparing all pairs is faster than searching the boxes around each box.
    if len(boxes.order) <= 300:
        here, there = np.triu_indices(len(boxes.order), 1)
        near, box = is_near(boxes.xyz[here] - boxes.xyz[there]), boxes.box()
        monitor.progress(1.0)
        return _joined(component, box[here[near]], box[there[near]])
    n_columns = (2 * _REACH + 1) ** 2 // 2 + 1
    first = boxes.xyz[boxes.start]
    # Join the pairs of a whole column of boxes at once, as joining has a fixed cost.
    left: list[tuple[np.ndarray, np.ndarray]] = []
    for done, column in enumerate(boxes.beside_all(), start=1):
        here, there = _apart(column, component)
        touching = is_near(first[here] - first[there])
        component = _joined(component, here[touching], there[touching])
        left.append((here[~touching], there[~touching]))
        monitor.progress(done / (2 * n_columns))
    for done, pairs in enumerate(left, start=1):
        component = _joined(component, *_touching(boxes, *_apart(pairs, component), is_near))
        monitor.progress(0.5 + done / (2 * n_columns))
    return component


def _apart(pairs: tuple[np.ndarray, np.ndarray], component: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the pairs of boxes that nothing has joined yet."""
    here, there = pairs
    apart = component[here] != component[there]
    return here[apart], there[apart]


def _touching(boxes: Boxes, here: np.ndarray, there: np.ndarray, is_near: Callable) -> tuple[np.ndarray, np.ndarray]:
    """Return the pairs of boxes whose points show that they touch."""
    touching = np.zeros(len(here), bool)
    for pair, a, b in boxes.pairs(here, boxes, there):
        touching[pair[is_near(boxes.xyz[a] - boxes.xyz[b])]] = True
    return here[touching], there[touching]


def _joined(component: np.ndarray, here: np.ndarray, there: np.ndarray) -> np.ndarray:
    """Return the components after joining the components of the boxes ``here`` and ``there``."""
    if not len(here):
        return component
    return components(component[here], component[there], int(component.max()) + 1)[1][component]


def by_first_point(component: np.ndarray) -> np.ndarray:
    """Renumber components (n,) from 0 in the order of their first points, int32; negative numbers become -1."""
    number, first, inverse = np.unique(component, return_index=True, return_inverse=True)
    negative = int(np.searchsorted(number, 0))
    order = negative + np.argsort(first[negative:])
    return placed(np.arange(len(order), dtype=np.int32), order, len(first), -1)[inverse]


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
        Receives progress.

    Returns
    -------
    ndarray of shape (n,), int32
        Component of each point, from 0, in the order of their first points.

    Notes
    -----
    Points of one box of ``plan_distance / sqrt(2)`` by ``height_distance`` are always linked, so boxes
    are joined instead of points.
    """
    if not len(xyz):
        return np.zeros(0, np.int32)
    # Slightly smaller, so that even a box's diagonal is strictly less than the distance.
    side = np.array([plan_distance / np.sqrt(2), plan_distance / np.sqrt(2), height_distance]) * (1 - 1e-9)
    boxes = Boxes(xyz, side)

    def is_near(offset: np.ndarray) -> np.ndarray:
        return (offset[:, 0] ** 2 + offset[:, 1] ** 2 < plan_distance**2) & (np.abs(offset[:, 2]) < height_distance)

    return by_first_point(placed(connected(boxes, is_near, monitor)[boxes.box()], boxes.order, len(xyz)))
