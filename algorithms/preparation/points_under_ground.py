"""Find isolated points under the ground: multipath echoes.

A laser pulse does not pass the ground, so that points under it on all sides are no part of the scene, unless they are a
floor. Points of multipath come at all depths, points of a floor at one.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

import numpy as np

from ..geometry.grid import Grid, distinct, find_cells, fixed_grid_over
from ..geometry.groups import mask_of, ordered
from ..packages import spatial
from ..rules import rule, rules
from ..sampling.density import DENSITY
from ..sampling.kinds import SCENE
from ..sampling.surface_noise import SURFACES
from ..stage import Monitor
from ..threads import ROWS_AT_ONCE, in_chunks


@rules
class UNDER_GROUND:
    """Points under the ground, and which of them are a floor."""

    depth: float = rule(0.45, "m", "physics: ground, grass, ruts and floors differ by less from cell to cell")
    few: int = rule(3, "points", "physics: at one height, as of a lamp or a wire; under the ground, more are a floor")


def under_ground(xyz: np.ndarray, spacing: float, noise: float, monitor: Monitor) -> np.ndarray:
    """Return the mask (n,) of the points under the ground, alone or without a common level.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates, m.
    spacing, noise : float
        Point spacing, and noise of surfaces, m.
    monitor : Monitor
        Receives progress.
    """
    cell = float(np.sqrt(DENSITY.points_per_cell)) * spacing
    grid = fixed_grid_over(xyz, cell)
    cells, which = distinct(grid.number(xyz))
    order = _by_cell_and_height(which, xyz)
    n_points = np.bincount(which)
    start = np.cumsum(n_points) - n_points
    size = max(SCENE.ground_within, 8 * cell)

    found, is_floor, is_deep = np.zeros((3, len(xyz)), bool)
    n_found = np.zeros(len(cells), np.int64)
    surface = _Surface.unknown(len(cells))
    near = np.arange(len(cells))
    # Points that are found hide others beneath the surface that they pull down.
    for turn in count(1):
        # Without the points found before, which were the lowest of their cells, their companions are now the lowest.
        ranks = n_found, (n_found + n_points) // 2
        lowest, middle = (xyz[order[start + np.minimum(rank, n_points - 1)]] for rank in ranks)
        lowest[n_found == n_points] = np.nan
        # Below the surface close by, below the ground around, and not next to others of the same height.
        surface.fit(grid, cells, lowest, middle, near)
        _find_deep(is_deep, xyz, which, mask_of(len(cells), near), surface)
        rows = np.flatnonzero(is_deep & ~(found | is_floor))
        around = _surroundings(lowest[n_found < n_points], xyz[rows], size)
        rows = rows[_is_under(xyz[rows, 2], surface.at(xyz, rows, which), surface.is_smooth[which[rows]], around)]
        near = near_cells(grid, cells, which[rows])
        beside = np.flatnonzero(mask_of(len(cells), near)[which] & ~found)
        rows = rows[_at_level(xyz[rows], xyz[beside], cell, UNDER_GROUND.depth) <= UNDER_GROUND.few]
        monitor.progress(1 - 0.5**turn)
        if not len(rows):
            return found
        found[rows] = True
        low = np.flatnonzero(found)
        is_floor[low] = _on_floor(xyz[low], noise)
        found &= ~is_floor
        n_found = np.bincount(which[found], minlength=len(cells))
        near = near_cells(grid, cells, which[rows])
    return found


def _by_cell_and_height(which: np.ndarray, xyz: np.ndarray) -> np.ndarray:
    """Return the rows (n,) by cells, from the lowest point of a cell up, of equally high ones from the west."""
    x, y, z = xyz.T
    # One key for both sorts three times as fast; it resolves heights to a part in two thousand million of their range.
    key = which.astype(np.int64) << 32
    key |= ((z - z.min()) * ((2**31 - 1) / max(float(np.ptp(z)), 1e-9))).astype(np.int64)
    return ordered(key, x, y)


def _find_deep(is_deep: np.ndarray, xyz: np.ndarray, which: np.ndarray, is_near: np.ndarray, surface: _Surface) -> None:
    """Set which points of some cells lie deep below the surface, or where it is not known."""

    def work(part: np.ndarray) -> None:
        is_deep[part] = ~(xyz[part, 2] >= surface.at(xyz, part, which) - UNDER_GROUND.depth)

    in_chunks(work, np.flatnonzero(is_near[which]), ROWS_AT_ONCE, Monitor())


def near_cells(grid: Grid, cells: np.ndarray, which: np.ndarray) -> np.ndarray:
    """Return the sorted indices into ``cells`` of the cells ``which`` and their neighbors."""
    at, is_cell = find_cells(cells, (cells[np.unique(which)][:, None] + [0, *grid.around]).ravel())
    return np.unique(at[is_cell])


def _is_under(z: np.ndarray, close: np.ndarray, is_smooth: np.ndarray, around: np.ndarray) -> np.ndarray:
    """Return the mask of elevations (m) below the surface close by that are below the ground, too."""
    lowest = around[:, 0]
    # Where ground is hidden, its lowest possible height is as far below the lowest neighbor as that lies below the
    # middle one.
    lowest_ground = np.where(is_smooth, lowest, 2 * lowest - around[:, 2])
    is_on_ground = is_smooth & (close <= lowest + UNDER_GROUND.depth)
    return (z < lowest_ground - UNDER_GROUND.depth) | is_on_ground


@dataclass(frozen=True)
class _Surface:
    """The lowest surface around each cell: a plane through ``origin`` with a slope, and whether neighbors agree.

    ``origin`` (m, 3) has NaN where the surface is not known; ``slope`` is (m, 2), ``is_smooth`` (m,).
    """

    origin: np.ndarray
    slope: np.ndarray
    is_smooth: np.ndarray

    @classmethod
    def unknown(cls, n_cells: int) -> _Surface:
        """Return a surface that is known nowhere."""
        return cls(np.full((n_cells, 3), np.nan), np.zeros((n_cells, 2)), np.zeros(n_cells, bool))

    def at(self, xyz: np.ndarray, rows: np.ndarray, which: np.ndarray) -> np.ndarray:
        """Return the elevation (m) of the surface at some points, ``which`` is the cell of each point."""
        cell = which[rows]
        return self.origin[cell, 2] + np.einsum("ij,ij->i", self.slope[cell], xyz[rows, :2] - self.origin[cell, :2])

    def fit(self, grid: Grid, cells: np.ndarray, lowest: np.ndarray, middle: np.ndarray, wanted: np.ndarray) -> None:
        """Fit the surface around the ``wanted`` cells (positions in ``cells``).

        ``lowest`` and ``middle`` are the points of each cell at these ranks in height. Up to three neighbors may hold
        companions of a low point. Most points of such a cell are on the surface, though; in a cell beyond an edge or
        farther along a ditch they are not.
        """

        def work(part: np.ndarray) -> None:
            around = [find_cells(cells, cells[part] + step) for step in grid.around]
            beside = _beside(around, lowest, middle[part])
            self.slope[part] = _slope(beside)
            low = _flattened(beside, self.slope[part])
            mid = _flattened(_beside(around, middle, middle[part]), self.slope[part])
            smooth = low[:, 4:] - low[:, :4] <= UNDER_GROUND.depth
            self.is_smooth[part] = smooth.any(axis=1)
            base = np.take_along_axis(low, np.argmax(smooth, axis=1)[:, None], axis=1)[:, 0]
            rough = low[:, 1] - (low[:, 3] - low[:, 1])
            self.origin[part, :2] = middle[part, :2]
            self.origin[part, 2] = np.minimum(np.where(self.is_smooth[part], base, rough), mid[:, 0])

        in_chunks(work, wanted, ROWS_AT_ONCE, Monitor())


def _surroundings(levels: np.ndarray, points: np.ndarray, size: float) -> np.ndarray:
    """Return elevations (m) of the ground in the eight cells of ``size`` (m) around points (m, 8), ascending."""
    grid = fixed_grid_over(levels, size)
    cells, which = distinct(grid.number(levels))
    order = _by_cell_and_height(which, levels)
    n_levels = np.bincount(which)
    start = np.cumsum(n_levels) - n_levels
    # A field of low points lowers many levels, and a forest shows few at the ground. So the lowest ones are skipped, as
    # many as the square root of twice their number: more in large cells, but a smaller share. Fitted on simulated
    # towns.
    chosen = levels[order[start + np.sqrt(2 * n_levels - 2).astype(np.int64)]]
    number = grid.number(points)
    beside = _beside([find_cells(cells, number + step) for step in grid.around], chosen, points)
    return _flattened(beside, _slope(beside))


def _beside(around: list[tuple[np.ndarray, np.ndarray]], levels: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """Return the levels of the eight cells around some (m, 8, 3), NaN if none; plan from ``origin``.

    ``around`` has for each of the eight where they are in ``levels``, and which of them are there.
    """
    beside = np.full((len(origin), 8, 3), np.nan)
    for column, (at, found) in enumerate(around):
        beside[found, column] = levels[at[found]]
    beside[:, :, :2] -= origin[:, None, :2]
    return beside


def _slope(beside: np.ndarray) -> np.ndarray:
    """Return rise eastward and northward (m, 2): the middle one of those between opposite neighbors.

    The middle one, so that one odd height does not change it.
    """
    # Positions of three neighbors each in the order of ``Grid.around``.
    west, east, south, north = ([0, 3, 5], [2, 4, 7], [0, 1, 2], [5, 6, 7])
    eastward = (beside[:, east, 2] - beside[:, west, 2]) / (beside[:, east, 0] - beside[:, west, 0])
    northward = (beside[:, north, 2] - beside[:, south, 2]) / (beside[:, north, 1] - beside[:, south, 1])
    return np.column_stack([_middle(eastward), _middle(northward)])


def _flattened(beside: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Return heights (m, 8) carried to the origin along the slope, ascending, NaN last."""
    return np.sort(beside[:, :, 2] - np.einsum("ikj,ij->ik", beside[:, :, :2], slope), axis=1)


def _middle(values: np.ndarray) -> np.ndarray:
    """Return the median (m,) of three values each, 0 where none is known."""
    values = np.sort(values, axis=1)
    known = np.isfinite(values).sum(axis=1)
    middle = np.where(known == 2, (values[:, 0] + values[:, 1]) / 2, np.where(known == 1, values[:, 0], values[:, 1]))
    return np.where(known > 0, middle, 0.0)


def _on_floor(low: np.ndarray, noise: float) -> np.ndarray:
    """Return the mask of low points (n, 3), m, on a floor seen here and there; ``noise``, m, is of surfaces.

    Points of a floor differ by noise alone, and most low points around are on it, while multipath lies at all depths.
    """
    reach = SCENE.ground_within / 2
    at_level = _at_level(low, low, reach, 2 * SURFACES.on_plane * noise)
    return (at_level > UNDER_GROUND.few) & (2 * at_level >= _at_level(low, low, reach, np.inf))


def _at_level(points: np.ndarray, others: np.ndarray, reach: float, height: float) -> np.ndarray:
    """Return how many of others (m, 3) lie up to ``reach`` (m) in plan and ``height`` (m) from points (n, 3)."""
    # Heights are stretched so that the neighborhood is a flat disk.
    stretch = [1.0, 1.0, reach / height]
    return spatial.cKDTree(others * stretch).query_ball_point(points * stretch, reach, return_length=True)
