"""Decide on points at the edges of buildings together, by a minimum cut in the graph of their nearest neighbors."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from ..geometry.cheapest_labels import cheapest_cut
from ..geometry.grid import lattice
from ..geometry.groups import run_starts
from ..packages import spatial
from ..sampling.surface_noise import SURFACES
from ..stage import Monitor


def decided_together(
    xyz: np.ndarray, gain: np.ndarray, spacing: float, side: float, margin: float, monitor: Monitor
) -> np.ndarray:
    """Return the mask of points (n,) of buildings that together contradict evidence and neighbors least.

    The cut is exact in each square of a fixed lattice with a margin around it; only the square itself is kept. So a
    part of a survey with these margins gives the same result as the whole. A cut of all points at once differs in few
    of them.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m, with easting and northing from the corner of the whole.
    gain : ndarray of shape (n,)
        Log odds of building of each point by itself; infinite where its class does not change.
    spacing : float
        Mean distance between neighboring points in plan, m.
    side, margin : float
        Side of the squares and width of their margin, at most half of it, m.
    monitor : Monitor
        Receives progress.

    References
    ----------
    Greig, D.M., Porteous, B.T., Seheult, A.H., 1989. Exact maximum a posteriori estimation for binary images. Journal
    of the Royal Statistical Society B 51(2), 271-279. [greig1989]
    """
    alone = gain > 0
    if not len(alone):
        return alone
    together, done = alone.copy(), 0
    for rows, is_own in _squares(xyz[:, :2], side, margin):
        # If all points lean to one class, there is nothing to decide.
        if alone[rows].any() and not alone[rows].all():
            together[rows[is_own]] = _cheapest(xyz[rows], gain[rows], spacing)[is_own]
        done += int(is_own.sum())
        monitor.progress(done / len(xyz))
    return together


def _squares(plan: np.ndarray, side: float, margin: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the rows of the points (n, 2) in each square with its margin, and which of them are in the square."""
    shifts = product((-margin, margin), repeat=2)
    squares = np.concatenate([lattice(plan, side), *(lattice(plan + shift, side) for shift in shifts)])
    east, north = (squares - squares.min(axis=0)).T
    number = east * (north.max() + 1) + north
    own, row = number[: len(plan)], np.tile(np.arange(len(plan)), 5)
    order = np.lexsort((row, number))
    number, row = number[order], row[order]
    once = np.append(True, (np.diff(number) != 0) | (np.diff(row) != 0))
    number, row = number[once], row[once]
    for rows, numbers in zip(*(np.split(values, run_starts(number)[1:]) for values in (row, number))):
        yield rows, own[rows] == numbers


def _cheapest(xyz: np.ndarray, gain: np.ndarray, spacing: float) -> np.ndarray:
    """Return the mask of points (n,) that the minimum cut puts on the side of buildings; n >= 2."""
    distance, near = spatial.cKDTree(xyz).query(xyz, min(SURFACES.neighbors + 1, len(xyz)))
    row = np.repeat(np.arange(len(xyz)), near.shape[1])
    # A neighbor at distance 0 weighs as much as odds of e to 1, one at the usual distance half as much.
    cost = 1 / (1 + (distance.ravel() / spacing) ** 2)
    is_other = near.ravel() != row
    ends = row[is_other], near.ravel()[is_other]
    return cheapest_cut(*ends, cost[is_other], np.maximum(-gain, 0.0), np.maximum(gain, 0.0))
