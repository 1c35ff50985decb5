"""Roofs on or in other roofs: stair houses, lift shafts, penthouses and skylights."""

from __future__ import annotations

import numpy as np

from ..geometry.grid import Grid, find_cells, grid_over
from ..geometry.groups import topmost

# A roof of which more than this share of the border meets one larger roof is a part of that one. A house between two
# others of its size has at most a third of it beside each, an annex in a nook half; a stair house at the edge of a
# roof has three quarters.
_ENCLOSED = 0.6

# Roofs meet over this many cells in which nothing is a roof: parapets, and walls that matching has smeared.
_OVER = 2


def join_stacked(xyz: np.ndarray, cluster: np.ndarray, size: float) -> np.ndarray:
    """Give roofs that one larger roof surrounds to that one.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points of roofs (m).
    cluster : ndarray of shape (n,), int
        Roof of each point from 0; -1 if unassigned.
    size : float
        Side (m) of the cells in which roofs are held against each other: the distance within which points are of one
        roof.

    Returns
    -------
    ndarray of shape (n,)
        The same numbers, those of surrounded roofs replaced by that of the roof around them.
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
    grid, cells, label = _labelled(xyz[own], cluster[own], size)
    area = np.bincount(label, minlength=count)
    here, there = _borders(grid, cells, label)
    length = np.bincount(here, minlength=count)
    meets = there >= 0
    pairs, shared = np.unique(here[meets] * count + there[meets], return_counts=True)
    one, other = np.divmod(pairs, count)
    inner = (shared > _ENCLOSED * length[one]) & (area[one] < area[other])
    # The surrounding roof is larger, so that there is no circle.
    into[one[inner]] = other[inner]
    return into


def _labelled(xyz: np.ndarray, cluster: np.ndarray, size: float) -> tuple[Grid, np.ndarray, np.ndarray]:
    """Return a grid, its cells (m,) with points, ascending, and the roof (m,) of the highest point in each."""
    tight = grid_over(xyz, size)
    # Room at the border, so that the numbers of cells beside it are of no other cells.
    room = _OVER + 1
    west, south = tight.origin
    grid = Grid((west - room * size, south - room * size), size, tight.rows + 2 * room, tight.columns + 2 * room)
    number = grid.number(xyz)
    top = topmost(xyz[:, 2], number, -cluster)
    return grid, number[top], cluster[top]


def _borders(grid: Grid, cells: np.ndarray, label: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the roof (k,) of each side of a cell where a roof ends, and the one that begins there, -1 for none."""
    here, there = [], []
    for step in (1, -1, grid.columns, -grid.columns):
        beside = np.full(len(cells), -1)
        for times in range(1, _OVER + 2):
            position, found = find_cells(cells, cells + times * step)
            beside = np.where((beside < 0) & found, label[position], beside)
        ends = beside != label
        here.append(label[ends])
        there.append(beside[ends])
    return np.concatenate(here), np.concatenate(there)
