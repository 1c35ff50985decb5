"""Buildings that several divisions of a cloud into cells agree on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def agreed(owners: Sequence[np.ndarray], place: np.ndarray) -> np.ndarray:
    """Return the building (n,), int32, from 1, of points that most divisions call building; 0 for all other points.

    A building is that of the first division; where this one has no building at a point, it is the building that the
    point's building in a later division shares most points with, or a new one.

    Parameters
    ----------
    owners : sequence of ndarray of shape (n,), int32
        Building of each point from 1 by each division, 0 for points of no building.
    place : ndarray of shape (n,), int
        Buildings are numbered in the order of the least place of their points.
    """
    is_building = np.sum([owner > 0 for owner in owners], axis=0) > len(owners) / 2
    number = np.where(is_building, owners[0], 0)
    for owner in owners[1:]:
        left = is_building & (number == 0)
        if not left.any():
            break
        number[left] = _counterparts(owner, number)[owner[left]]
    return _in_order(number, place)


def _counterparts(owner: np.ndarray, number: np.ndarray) -> np.ndarray:
    """Return for each building of a division (m + 1,) the number that most of its points have, a new one for none."""
    count, known = int(owner.max()) + 1, int(number.max()) + 1
    both = (owner > 0) & (number > 0)
    pair, shared = np.unique(owner[both].astype(np.int64) * known + number[both], return_counts=True)
    # Of several that share as many points, the first building stays.
    order = np.lexsort((-pair, shared))
    becomes = known + np.arange(count)
    becomes[0] = 0
    becomes[pair[order] // known] = pair[order] % known
    return becomes


def _in_order(number: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return the numbers (n,) of buildings from 1 without gaps, in the order of their least place."""
    rows = np.flatnonzero(number)
    found, which = np.unique(number[rows], return_inverse=True)
    least = np.full(len(found), np.iinfo(np.int64).max)
    np.minimum.at(least, which, place[rows])
    rank = np.empty(len(found), np.int32)
    rank[np.argsort(least, kind="stable")] = np.arange(1, len(found) + 1, dtype=np.int32)
    final = np.zeros(len(number), np.int32)
    final[rows] = rank[which]
    return final
