"""Measures of groups of points in plan: area, surroundings, and penetration by the beam."""

from itertools import product
from typing import Optional

import numpy as np

from ..geometry.grid import Grid, connected_cells, distinct, find_cells, fixed_grid_over, lattice
from ..geometry.groups import components, least_of
from ..sampling.closed_surface import CLOSED
from ..sampling.density import DENSITY
from ..terrain.free_standing import FREE

# Width, depth and height (m) of the boxes in which points around a group are counted, with the 26 next to each: a house
# or a tree is as wide, and trees are twice as high.
_BOX = np.array([2.0, 2.0, 4.0])


def plan_areas(xyz: np.ndarray, group: np.ndarray, density: float) -> np.ndarray:
    """Return the area (m²), seen from above, that each group of points occupies.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    group : ndarray of shape (n,), int
        Group of each point from 0.
    density : float
        Points per square meter.

    Returns
    -------
    ndarray of shape (group.max() + 1,)
        Occupied cells times their area.
    """
    grid, owner, _ = occupied_cells(xyz, group, density)
    return np.bincount(owner, minlength=int(group.max()) + 1) * grid.size**2


def penetration(xyz: np.ndarray, group: np.ndarray, density: float, goes_on: Optional[np.ndarray] = None) -> np.ndarray:
    """Return how much of the beam passes through each group of points, 0 to 1.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        All points of the cloud (m).
    group : ndarray of shape (n,), int
        Group of each point from 0, negative for none; at least one point has a group.
    density : float
        Points per square meter.
    goes_on : ndarray of shape (n,), bool, optional
        Whether the pulse of each went on to another return, as of :func:`pulses_going_on`.

    Returns
    -------
    ndarray of shape (group.max() + 1,)
        The share of a group's cells in which points lie well beneath it. Where returns are numbered,
        the mean of that and the share of its points that are not the last return of their pulse.

    Notes
    -----
    The beam passes through leaves and not through roofs. Along edges there are points beneath a roof too, so the share
    of a roof is small, but not zero. Cells hold the same number of points at any density, as larger numbers would raise
    the share.
    """
    owner, beneath = _columns(xyz, group, DENSITY.filled_cell / np.sqrt(density))
    share = np.bincount(owner, beneath > 0) / np.maximum(np.bincount(owner), 1)
    return share if goes_on is None else (share + non_last_share(group, goes_on)) / 2


def non_last_share(group: np.ndarray, goes_on: Optional[np.ndarray]) -> np.ndarray:
    """Return the share of each group's points that are not the last return of their pulse; 0 where none is numbered.

    Arguments as of :func:`penetration`.
    """
    member = group >= 0
    size = np.bincount(group[member])
    return np.zeros(len(size)) if goes_on is None else np.bincount(group[member], goes_on[member]) / np.maximum(size, 1)


def pulses_going_on(number: Optional[np.ndarray], count: Optional[np.ndarray]) -> Optional[np.ndarray]:
    """Return the mask (n,) of points whose pulse went on to another return; None where none is known to have several.

    Parameters
    ----------
    number, count : ndarray of shape (n,), optional
        Number of each return and of all returns of its pulse, where the scanner counted them.
    """
    if number is None or count is None or count.max(initial=0) <= 1:
        return None
    return number < count


def adjacent_groups(xyz: np.ndarray, group: np.ndarray, chosen: np.ndarray, density: float) -> np.ndarray:
    """Return a number for each group of points, the same for those that are adjacent, directly or over others.

    Parameters
    ----------
    xyz, group, density
        As of :func:`penetration`.
    chosen : ndarray of shape (group.max() + 1,), bool
        The groups that are looked at; every other has a number of its own.

    Returns
    -------
    ndarray of shape (group.max() + 1,), int32
        Numbers from 0. Groups are adjacent when a cell of one is a cell of the other or next to one.
    """
    grid, owner, cell = occupied_cells(xyz, group, density)
    owner, cell = (values[chosen[owner]] for values in (owner, cell))
    cells, which = distinct(cell)
    connected = connected_cells(grid, cells)[1][which]
    return components(owner, len(chosen) + connected, len(chosen) + len(cells))[1][: len(chosen)]


def share_around(xyz: np.ndarray, group: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return the share of the points around each group of points that belongs to the chosen groups.

    Parameters
    ----------
    xyz, group
        As of :func:`penetration`.
    chosen : ndarray of shape (group.max() + 1,), bool
        Which groups are meant.

    Returns
    -------
    ndarray of shape (group.max() + 1,)
        Share of the points around a point that belong to chosen groups, its own among them, in the mean over the points
        of each group. Around is within two to four meters in plan and twice that in height. 0 for groups without
        points.
    """
    member = np.flatnonzero(group >= 0)
    owner = group[member]
    # With an empty border the numbers of boxes next to one another differ by the same steps everywhere.
    box = lattice(xyz[member], _BOX)
    box += 1 - box.min(axis=0)
    shape = tuple((box.max(axis=0) + 2).tolist())
    boxes, which = distinct(np.ravel_multi_index(tuple(box.T), shape))
    n_chosen, n_points = (np.bincount(which, weight, len(boxes)) for weight in (chosen[owner], None))
    chosen_around, around = np.zeros((2, len(boxes)))
    for step in product((-1, 0, 1), repeat=3):
        there, found = find_cells(boxes, boxes + (step[0] * shape[1] + step[1]) * shape[2] + step[2])
        chosen_around += np.where(found, n_chosen[there], 0)
        around += np.where(found, n_points[there], 0)
    size = np.bincount(owner, minlength=len(chosen))
    return np.bincount(owner, (chosen_around / around)[which], len(chosen)) / np.maximum(size, 1)


def occupied_cells(xyz: np.ndarray, group: np.ndarray, density: float) -> tuple[Grid, np.ndarray, np.ndarray]:
    """Return the grid that area is counted in, and group and cell of each cell of a group (m,), sorted by both.

    Arguments as of :func:`plan_areas`; points of negative groups are left out.
    """
    grid = fixed_grid_over(xyz, max(CLOSED.least_spacing, DENSITY.filled_cell / np.sqrt(density)))
    member = group >= 0
    # Numbers of occupied cells are small, numbers of cells between far points times the groups may be too large.
    cells, which = distinct(grid.number(xyz)[member])
    owner, position = np.divmod(np.unique(group[member].astype(np.int64) * len(cells) + which), max(len(cells), 1))
    return grid, owner, cells[position]


def _columns(xyz: np.ndarray, group: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the group of each cell of ``size`` (m) of a group, and the points there well beneath that group's."""
    cell, member, count = distinct(fixed_grid_over(xyz, size).number(xyz))[1], group >= 0, int(group.max()) + 1
    # Sorted by cells, so that the groups in a point's cell are found by searching.
    pairs, which = distinct(cell[member].astype(np.int64) * count + group[member])
    where, owner = np.divmod(pairs, count)
    bottom = least_of(xyz[member, 2], which, len(pairs))
    first = np.searchsorted(where, cell)
    groups_there = np.searchsorted(where, cell, "right") - first
    beneath = np.zeros(len(pairs), np.int64)
    for nth in range(groups_there.max()):
        some = np.flatnonzero(groups_there > nth)
        pair = first[some] + nth
        beneath += np.bincount(pair[xyz[some, 2] < bottom[pair] - FREE.step], minlength=len(pairs))
    return owner, beneath
