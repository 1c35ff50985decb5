"""Stems: round and upright shapes at breast height."""

from typing import Optional

import numpy as np

from ..geometry.boxes import connect
from ..geometry.grid import distinct, find_cells, grid_over
from ..geometry.groups import least_of, split_groups
from ..stage import Monitor
from .cylinder_fits import LEAST_POINTS, Cylinder, fit_cylinder

# Height above the ground at which stems are measured (m).
BREAST = 1.3

# Half of the height of the slice around it (m).
_HALF_SLICE = 0.3

# Largest distance between neighboring points of one stem in the slice (m).
_APART = 0.15

# Least share of the height of the slice that a stem crosses.
_CROSSED = 0.7

# Least and greatest radius of a stem (m).
_RADII = (0.015, 1.0)

# Largest median distance of the points from the cylinder, or from the middle line of a branch that is round, as a share
# of its radius.
ROUND = 0.2

# Largest median distance (m) of the points from a cylinder so thin that the share of its radius is less.
_ROUGHNESS = 0.01

# Distance from a cylinder or a line, in the median of these distances, beyond which points are of leaves and twigs: 0.9
# of those on bark lie nearer by chance.
FAR = 2.5

# Least cosine of the lean of a stem: 37°.
_LEAN = 0.8

# Side (m) of the cells in which the ground lies as low as their lowest point, or as the points of the cells around.
_GROUND_CELL = 1.0


def ground_level(xyz: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return the height (m) of the lowest of points (n, 3) in the cell of each position (m, 2) and the cells around it.

    Each position is one of the points.
    """
    grid = grid_over(xyz, _GROUND_CELL)
    cells, which = distinct(grid.number(xyz))
    lowest = least_of(xyz[:, 2], which, len(cells))
    around = lowest.copy()
    for step in grid.around:
        beside, known = find_cells(cells, cells + step)
        around[known] = np.minimum(around[known], lowest[beside[known]])
    return around[find_cells(cells, grid.number(positions))[0]]


def find_stems(xyz: np.ndarray, level: np.ndarray, monitor: Monitor) -> list[tuple[Cylinder, float]]:
    """Return the stems at breast height as cylinders, and the height (m) of the ground below each.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points of trees (m).
    level : ndarray of shape (n,)
        Height of the ground below each (m).
    monitor : Monitor
        Receives progress.
    """
    inside = np.flatnonzero(np.abs(xyz[:, 2] - level - BREAST) <= _HALF_SLICE)
    if not len(inside):
        return []
    cluster = connect(xyz[inside], _APART, _APART, monitor.part(0, 0.3))
    parts = split_groups(cluster, int(cluster.max()) + 1)
    found = []
    for number, part in enumerate(parts):
        monitor.progress(0.3 + 0.7 * number / len(parts))
        rows = inside[part]
        stem = _stem(xyz[rows]) if len(rows) >= LEAST_POINTS else None
        if stem is not None:
            found.append((stem, float(np.median(level[rows]))))
    return found


def _stem(xyz: np.ndarray) -> Optional[Cylinder]:
    """Return the upright cylinder of the points of a slice, None if they are no stem."""
    if np.ptp(xyz[:, 2]) < _CROSSED * 2 * _HALF_SLICE:
        return None
    middle = xyz.mean(axis=0)
    radius = float(np.median(np.linalg.norm(xyz[:, :2] - middle[:2], axis=1)))
    stem = Cylinder(middle, np.array([0.0, 0.0, 1.0]), max(radius, 1e-3))
    for _ in range(3):
        off = np.abs(stem.local(xyz)[1] - stem.radius)
        near = off <= max(FAR * float(np.median(off)), 1e-4)
        if near.sum() < LEAST_POINTS:
            return None
        stem = fit_cylinder(xyz[near], stem)
    off = float(np.median(np.abs(stem.local(xyz)[1] - stem.radius)))
    is_stem = _RADII[0] <= stem.radius <= _RADII[1] and abs(stem.axis[2]) > _LEAN
    return stem if is_stem and off <= max(ROUND * stem.radius, _ROUGHNESS) else None
