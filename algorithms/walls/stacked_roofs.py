"""Roofs on or in other roofs: stair houses, lift shafts, penthouses and skylights."""

from __future__ import annotations

import numpy as np

from ..geometry.grid import find_cells, raster_cells
from ..geometry.groups import topmost

# A roof is part of a larger one if more than this share of its border meets that one. A house between two others shares
# at most a third with each, an annex in a nook half. A stair house at the edge of a roof has three quarters.
_ENCLOSED = 0.6

# Roofs meet across up to this many cells without a roof: parapets, and walls smeared by image matching.
_OVER = 2


def join_stacked(xyz: np.ndarray, cluster: np.ndarray, size: float) -> np.ndarray:
    """Return the roofs (n,) of points (n, 3), m, where one larger roof that surrounds others takes their place.

    ``cluster`` (n,) are the roofs before, from 0; -1 if unassigned. Cells have the ``size`` (m) of the distance within
    which points are of one roof.
    """
    joined = cluster.copy()
    while True:
        into = _surrounding(xyz, joined, size)
        if (into == np.arange(len(into))).all():
            return joined
        own = joined >= 0
        joined[own] = into[joined[own]]


def _surrounding(xyz: np.ndarray, cluster: np.ndarray, size: float) -> np.ndarray:
    """Return the roof (k,) that surrounds each roof, the roof itself where none does."""
    count = int(cluster.max(initial=-1)) + 1
    own = np.flatnonzero(cluster >= 0)
    into = np.arange(count)
    if count < 2:
        return into
    # A margin, so that the numbers of cells next to the border are unique.
    row, column = raster_cells(xyz[own], size, _OVER + 1)
    columns = int(column.max()) + _OVER + 2
    number = row * columns + column
    top = topmost(xyz[own, 2], number, -cluster[own])
    cells, label = number[top], cluster[own[top]]
    area = np.bincount(label, minlength=count)
    ending, beginning = _borders(cells, columns, label)
    length = np.bincount(ending, minlength=count)
    meets = beginning >= 0
    pairs, shared = np.unique(ending[meets] * count + beginning[meets], return_counts=True)
    one, other = np.divmod(pairs, count)
    inner = (shared > _ENCLOSED * length[one]) & (area[one] < area[other])
    # The surrounding roof is larger, so that there is no circle.
    into[one[inner]] = other[inner]
    return into


def _borders(cells: np.ndarray, columns: int, label: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the roof (k,) of each side of a cell where a roof ends, and the one that begins there, -1 for none.

    ``cells`` (m,) are numbers, ascending; from one row to the next they differ by ``columns``.
    """
    ending, beginning = [], []
    for step in (1, -1, columns, -columns):
        beside = np.full(len(cells), -1)
        for times in range(1, _OVER + 2):
            position, found = find_cells(cells, cells + times * step)
            beside = np.where((beside < 0) & found, label[position], beside)
        ends = beside != label
        ending.append(label[ends])
        beginning.append(beside[ends])
    return np.concatenate(ending), np.concatenate(beginning)
