"""Curved fronts as upright strips: planes that cross each other at small angles, separated by plan position."""

from typing import Optional

import numpy as np

from ..criteria import PARALLEL
from ..geometry.grid import distinct, grid_over, shared_cells
from ..geometry.groups import components
from ..planes.least_squares_planes import planes_of
from .facade_surfaces import CELL, ONE_FRONT

# Least number of these cells: one may be of a pole or a sign at a corner.
_TOUCHES = 2

# Side of a column, whose points are of one strip (tolerances): the noise of a strip fits into one.
_COLUMN_TOLERANCES = 2.0

# Least side of a column (m): finer ones hold too few points for a root mean square.
_LEAST_COLUMN = 0.1

# Number of rounds of fitting strips and assigning columns; both hardly change after the third.
_ROUNDS = 5


def as_strips(xyz: np.ndarray, wall: np.ndarray, tolerance: float) -> np.ndarray:
    """Return wall numbers (n,) from 1, curved fronts as upright strips side by side; 0 stays 0.

    On a curved front the planes of walls overlap. A plane is left out if the points of each of its columns lie off
    another one by at most ``tolerance`` (root mean square, m).
    """
    result = wall.copy()
    count = int(wall.max(initial=0))
    for front in _fronts(xyz, wall, count):
        rows = np.flatnonzero(np.isin(wall, front))
        strip = _strips(xyz[rows] - xyz.min(axis=0), np.searchsorted(front, wall[rows]), len(front), tolerance)
        result[rows] = front[strip]
    return result


def _fronts(xyz: np.ndarray, wall: np.ndarray, count: int) -> list[np.ndarray]:
    """Return the walls, ascending, of each front with two planes or more that touch at small angles."""
    rows = np.flatnonzero(wall > 0)
    if count < 2:
        return []
    start = xyz.min(axis=0)
    normal = planes_of(xyz[rows] - start, wall[rows] - 1, count).normal
    one, other, shared = shared_cells(xyz[rows], wall[rows] - 1, count, CELL)
    sine = np.linalg.norm(np.cross(normal[one], normal[other]), axis=1)
    # Parallel planes are one wall.
    touch = (shared >= _TOUCHES) & (sine >= PARALLEL) & (sine <= np.sin(ONE_FRONT))
    _, group = components(one[touch], other[touch], count)
    return [np.flatnonzero(group == number) + 1 for number in np.flatnonzero(np.bincount(group) > 1)]


def _strips(xyz: np.ndarray, label: np.ndarray, count: int, tolerance: float) -> np.ndarray:
    """Return the plane (n,) from 0 of each point, the same for all points of a column; as few planes as will do."""
    size = max(_COLUMN_TOLERANCES * tolerance, _LEAST_COLUMN)
    column = distinct(grid_over(xyz, size).number(xyz))[1]
    off = _deviations(xyz, label, count, column)
    alive = np.ones(count, bool)
    while True:
        for _ in range(_ROUNDS):
            label = np.argmin(np.where(alive, off, np.inf), axis=1)[column]
            # Three points always lie on a plane.
            alive &= np.bincount(label, minlength=count) > 3
            off = _deviations(xyz, label, count, column)
        dropped = _dispensable(off, alive, tolerance)
        if dropped is None:
            return label
        alive[dropped] = False


def _deviations(xyz: np.ndarray, label: np.ndarray, count: int, column: np.ndarray) -> np.ndarray:
    """Return the root mean square distance (columns, planes), m, of the points of columns from the planes."""
    number, group = np.unique(label, return_inverse=True)
    planes = planes_of(xyz, group, len(number))
    points = np.bincount(column)
    off = np.full((len(points), count), np.inf)
    for k, plane in enumerate(number):
        distance = (xyz - planes.center[k]) @ planes.normal[k]
        off[:, plane] = np.sqrt(np.bincount(column, distance**2) / points)
    return np.where(np.isnan(off), np.inf, off)


def _dispensable(off: np.ndarray, alive: np.ndarray, tolerance: float) -> Optional[int]:
    """Return the plane with fewest columns that the others can do without, None if they need all."""
    best = np.argmin(np.where(alive, off, np.inf), axis=1)
    columns = np.bincount(best, minlength=len(alive))
    for plane in np.argsort(columns, kind="stable"):
        if not alive[plane] or alive.sum() < 2:
            continue
        others = alive.copy()
        others[plane] = False
        own = np.flatnonzero(best == plane)
        if (np.where(others, off[own], np.inf).min(axis=1) <= tolerance).all():
            return int(plane)
    return None
