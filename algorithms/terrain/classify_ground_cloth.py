"""Ground points by cloth simulation."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..geometry.grid import refuse_sparse
from ..geometry.groups import components, placed
from ..packages import ndimage
from ..rules import rule, rules
from ..stage import stage, tunable
from .cloth import NEIGHBORS, Cloth
from .ground_points import usable_points, with_ground

# A cloth of up to this many particles is simulated however few points there are: all steps take about a minute.
_MOST_PARTICLES = 500_000


@rules
class _RULES:
    """The rim of the cloth, particles without a point, and parts that hang over slopes."""

    border: int = rule(2, "particles", "beyond the points on each side, as in the authors' program")
    # The search grows with the square of the distance, and no point lies near particles farther away.
    by_links: int = rule(20, "cells", "up to which the floor of particles without a point is the authors', by links")
    part: int = rule(50, "particles", "of the largest part that hangs freely and stays, as in the authors' program")
    step: float = rule(0.3, "m", "of the floor between particles from which a part isn't let down: an object's side")


@stage(
    "Terrain",
    title="Classify ground points (cloth)",
    tags="ground,filter,terrain,bare earth,DTM,cloth simulation,CSF,PMF,SMRF,lasground",
    writes=("classification",),
)
def classify_ground_cloth(
    xyz,
    classification,
    *,
    cell_size: float = tunable(0.5, label="Grid cell size", within="[0.05, 100] m"),
    rigidness: int = tunable(3, within="[1, 3]"),
    threshold: float = tunable(0.5, label="Class threshold", within="(0, 100] m"),
    slope_processing: bool = tunable(True, label="Slope post-processing"),
    time_step: float = tunable(0.65, within="(0, 2]", advanced=True),
    iterations: int = tunable(500, within="[1, 10_000]", advanced=True),
    monitor=None,
):
    """Find the ground by letting a cloth fall onto the terrain turned upside down.

    Ground points get class 2. Points of class 7 and 18 (noise) are never used and keep their class, points that
    were ground before and are not found again become 1 (unclassified), all others keep their class. Classify
    noise first: a point far below the ground holds the cloth up.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        ASPRS classes, ground 2.

    Other Parameters
    ----------------
    cell_size
        Distance of the cloth's particles (grid resolution).
    rigidness
        Stiffness of the cloth: 1 follows steep slopes, 2 terraces, 3 is for flat land.
    threshold
        Points at most this far above or below the cloth are ground.
    slope_processing
        Let the cloth down where it hangs over slopes without a step of ``_RULES.step`` m from one particle to the next.
    time_step
        How far the cloth falls in one step; smaller is slower and steadier.
    iterations
        Most steps of the simulation.

    Raises
    ------
    ValueError
        If fewer than three points are left to look for ground in, all lie on one line, or they are spread so thinly
        that the cloud is nearly empty.

    Notes
    -----
    Each particle of the cloth falls until it reaches the height of the point nearest to it in plan, and stays there. In
    each step neighbors draw each other to a common height, the more often the more rigid the cloth is. The simulation
    ends when no particle moves by 5 mm. All returns are used: in woods where pulses pass through the leaves, 'Classify
    ground points (TIN)' finds more. The paper leaves open gravity, damping, in which order neighbors draw each other,
    particles without a point, and from where the cloth falls. These and the defaults are as in the program that its
    authors published, with three differences. Of two points equally near to a particle the lower is taken, where the
    program takes the first in the file, so that the order of points has no influence. Particles at the corners of the
    cloud are let down as all others are, where the program leaves some of them out. Particles more than
    ``_RULES.by_links`` grid cells from any point, with none in their row and column, take the height of the nearest
    point, where the program searches on over the links.

    References
    ----------
    Zhang, W., Qi, J., Wan, P., Wang, H., Xie, D., Wang, X., Yan, G., 2016. An easy-to-use airborne LiDAR data filtering
    method based on cloth simulation. Remote Sensing 8 (6), 501. [zhang2016]
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.2.
    [hrutka2022]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = classify_ground_cloth(xyz, np.zeros(len(xyz)))
    >>> bool((classes[z == 0] == 2).all()), bool((classes[z > 0] == 2).any())
    (True, False)
    """
    usable = usable_points(xyz, classification)
    points = xyz[usable]
    refuse_sparse(points, cell_size, _MOST_PARTICLES)
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    columns, rows = (np.floor((high - low) / cell_size).astype(np.int64) + 2 * _RULES.border).tolist()
    grid = _Particles(low, cell_size, rows, columns)
    cloth = Cloth(grid.floor(points), rigidness, time_step, top=-points[:, 2].min())
    cloth.settle(iterations, monitor.part(0, 0.95))
    height = _let_down(cloth) if slope_processing else cloth.height
    return with_ground(classification, usable[np.abs(grid.at(points, height) + points[:, 2]) <= threshold])


@dataclass(frozen=True)
class _Particles:
    """Where particles are in plan: ``size`` apart (m), the first ``_RULES.border`` of these before ``corner``."""

    corner: np.ndarray
    size: float
    rows: int
    columns: int

    def _positions(self, points: np.ndarray) -> np.ndarray:
        """Return the positions (n, 2) of points in columns and rows.

        Many coordinates are multiples of a centimeter and lie just between two particles. The order of addition decides
        where rounding takes them, so that it is done as in the authors' program on coordinates from the corner.
        """
        return (points[:, :2] - self.corner + _RULES.border * self.size) / self.size

    def floor(self, points: np.ndarray) -> np.ndarray:
        """Return the height (rows, columns) of the point nearest to each particle, upside down, m."""
        position = self._positions(points)
        column, row = np.floor(position + 0.5).astype(np.int64).T
        number = row * self.columns + column
        off = (position[:, 0] - column) ** 2 + (position[:, 1] - row) ** 2
        # Of two equally near ones the lower.
        order = np.lexsort((points[:, 2], off, number))
        held, first = np.unique(number[order], return_index=True)
        floor = placed(-points[order[first], 2], held, self.rows * self.columns, np.nan)
        return _filled(floor.reshape(self.rows, self.columns))

    def at(self, points: np.ndarray, height: np.ndarray) -> np.ndarray:
        """Return the height of the cloth (n,) at points, between the four particles around."""
        position = self._positions(points)
        column, row = position.astype(np.int64).T
        east, north = position[:, 0] - column, position[:, 1] - row
        south_side = height[row, column] * (1 - east) + height[row, column + 1] * east
        north_side = height[row + 1, column] * (1 - east) + height[row + 1, column + 1] * east
        return south_side * (1 - north) + north_side * north


def _filled(floor: np.ndarray) -> np.ndarray:
    """Give particles without a point the floor of the next that has one: eastward, westward, southward, northward.

    Where row and column have none, it is the one that comes first over the links of the cloth, or the nearest one where
    that would take too many links.
    """
    filled = floor
    for axis, backward in ((1, True), (1, False), (0, False), (0, True)):
        filled = np.where(np.isnan(filled), _carried(floor, axis, backward), filled)
    distance, nearest = ndimage.distance_transform_edt(np.isnan(floor), return_indices=True)
    filled = np.where(np.isnan(filled) & (distance > _RULES.by_links), floor[tuple(nearest)], filled)
    missing = np.argwhere(np.isnan(filled))
    for hops in _hops():
        if not len(missing):
            return filled
        for hop in hops:
            row, column = (missing + hop).T
            inside = (row >= 0) & (row < floor.shape[0]) & (column >= 0) & (column < floor.shape[1])
            found = placed(floor[row[inside], column[inside]], inside, len(missing), np.nan)
            filled[tuple(missing[~np.isnan(found)].T)] = found[~np.isnan(found)]
            missing = missing[np.isnan(found)]
    return filled


def _hops() -> Iterator[np.ndarray]:
    """Yield offsets (k, 2) in rows and columns that one link of the cloth leads to, that two lead to, and so on.

    Within each they are in the order in which a search in breadth comes upon them.
    """
    seen = {(0, 0)}
    last = [(0, 0)]
    while True:
        reached = ((row + down, column + right) for row, column in last for down, right in NEIGHBORS)
        last = [offset for offset in dict.fromkeys(reached) if offset not in seen]
        seen.update(last)
        yield np.array(last)


def _carried(floor: np.ndarray, axis: int, backward: bool) -> np.ndarray:
    """Return the last value before each cell along an axis, NaN at the start; backward: the next one after it."""
    lines = np.moveaxis(floor, axis, 1)
    lines = lines[:, ::-1] if backward else lines
    last = np.maximum.accumulate(np.where(np.isnan(lines), 0, np.arange(lines.shape[1])), axis=1)
    carried = np.take_along_axis(lines, last, axis=1)
    return np.moveaxis(carried[:, ::-1] if backward else carried, 1, axis)


def _let_down(cloth: Cloth) -> np.ndarray:
    """Return the height of the cloth with the large parts that hang over a slope let down onto it.

    A particle comes down if small steps of the floor lead from it to one that lies on the floor.
    """
    part, n_parts = ndimage.label(cloth.is_movable)
    hangs = (np.bincount(part.ravel(), minlength=n_parts + 1) > _RULES.part)[part] & cloth.is_movable
    number = np.arange(part.size).reshape(part.shape)
    links, is_held = [], np.zeros(part.size, bool)
    for first, second in ((np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:-1], np.s_[1:])):
        smooth = np.abs(cloth.floor[first] - cloth.floor[second]) < _RULES.step
        both = smooth & hangs[first] & hangs[second]
        links.append((number[first][both], number[second][both]))
        for one, other in ((first, second), (second, first)):
            is_held[number[one][smooth & hangs[one] & ~cloth.is_movable[other]]] = True
    rows, columns = (np.concatenate(ends) for ends in zip(*links))
    n_groups, group = components(rows, columns, part.size)
    comes_down = np.bincount(group, is_held, n_groups)[group].reshape(part.shape) > 0
    return np.where(comes_down, cloth.floor, cloth.height)
