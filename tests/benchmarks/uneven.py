"""Real clouds as other scanners would have seen them: points chosen on lines, in bands, in pairs, or evenly.

Every function takes points (n, 3), m, and returns the rows that are chosen, some twice, and their new coordinates.
"""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.sampling.density import point_density

# Largest distance (m) of the points of a line from its middle.
_HALF_WIDTH = 0.075

# Largest distance in plan (m) between points of one pulse.
_PULSE = 0.1

# Direction of straight lines, radians counterclockwise from north.
_TURNED = 0.4

# Width of the swath of a zigzag (m).
_SWATH = 60.0

# Width of bands (m), at most half the cloud.
_BAND = 60.0

# Standard deviation (m) along each axis in plan between the points of a pair: 5 cm over both axes.
_PAIR = 0.05 / 1.4

# Standard deviation (m) in height between the points of a pair.
_PAIR_HEIGHT = 0.01

# More than the number of lines, rows and steps: makes one number of two.
_MANY = 1_000_000


def on_lines(xyz: np.ndarray, apart: float, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Choose points ``step`` (m) from each other on parallel lines that are ``apart`` (m)."""
    plan = xyz[:, :2] - xyz[:, :2].mean(axis=0)
    across = plan @ [np.cos(_TURNED), np.sin(_TURNED)]
    along = plan @ [-np.sin(_TURNED), np.cos(_TURNED)]
    line = np.floor(across / apart)
    near = np.abs(across - (line + 0.5) * apart) <= _HALF_WIDTH
    return _on_lines(xyz, np.where(near, line - line.min(), -1), along, step)


def on_zigzags(xyz: np.ndarray, apart: float, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Choose points ``step`` (m) from each other on lines that swing over a swath and are ``apart`` (m) on the mean."""
    along, north = (xyz[:, :2] - xyz[:, :2].min(axis=0)).T
    swing = 1 - np.abs(1 - (along / _SWATH) % 2)
    line = np.full(len(xyz), -1.0)
    for there_or_back, sign in enumerate((1, -1)):
        turn = north / (2 * apart) - sign * swing / 2
        near = np.abs(turn - np.floor(turn) - 0.5) * 2 * apart <= _HALF_WIDTH
        line = np.where(near & (line < 0), 2 * (np.floor(turn) + 1) + there_or_back, line)
    return _on_lines(xyz, line, along, step)


def in_bands(xyz: np.ndarray, sparse: float, dense: float) -> tuple[np.ndarray, np.ndarray]:
    """Choose points at random, at most one number per m² in every other band, and another in those between."""
    east = xyz[:, 0] - xyz[:, 0].min()
    is_sparse = np.floor(east / min(_BAND, east.max() / 2)) % 2 == 0
    share = np.where(is_sparse, sparse, dense) / point_density(xyz)
    rows = np.flatnonzero(np.random.default_rng(1).random(len(xyz)) < share)
    return rows, xyz[rows]


def in_pairs(xyz: np.ndarray, density: float) -> tuple[np.ndarray, np.ndarray]:
    """Choose ``density`` points per m² at random, and give each a second one close to it."""
    once = np.flatnonzero(np.random.default_rng(1).random(len(xyz)) < density / point_density(xyz))
    rng = np.random.default_rng(1)
    beside = np.column_stack([rng.normal(0, spread, len(once)) for spread in (_PAIR, _PAIR, _PAIR_HEIGHT)])
    return np.tile(once, 2), np.concatenate([xyz[once], xyz[once] + beside])


def evenly(xyz: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Choose about ``count`` points, a pulse in each cell of a grid."""
    plan = xyz[:, :2] - xyz[:, :2].min(axis=0)
    # Sizes of cells between which the wanted one lies; after 18 halvings they agree to 10⁻⁵.
    small, large = 0.2, 5.0
    for _ in range(18):
        cell_size = np.sqrt(small * large)
        cell = np.floor(plan / cell_size)
        off = np.linalg.norm(plan / cell_size - cell - 0.5, axis=1)
        rows = np.flatnonzero(_of_pulses(plan, cell @ [_MANY, 1], off))
        small, large = (cell_size, large) if len(rows) > count else (small, cell_size)
    return rows, xyz[rows]


def _on_lines(xyz: np.ndarray, line: np.ndarray, along: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Choose the pulses nearest to positions ``step`` (m) apart on lines, numbered from 0, negative off lines."""
    near = np.flatnonzero(line >= 0)
    number = np.floor(along[near] / step)
    off = np.abs(along[near] - (number + 0.5) * step)
    rows = near[_of_pulses(xyz[near, :2], line[near] * _MANY + number - number.min(), off)]
    return rows, xyz[rows]


def _of_pulses(plan: np.ndarray, group: np.ndarray, off: np.ndarray) -> np.ndarray:
    """Return which points (n,) belong to the pulse of the point that is least ``off`` in its ``group``."""
    _, which = np.unique(group, return_inverse=True)
    order = np.lexsort((off, which))
    first = order[np.unique(which[order], return_index=True)[1]]
    return np.linalg.norm(plan - plan[first[which]], axis=1) < _PULSE
