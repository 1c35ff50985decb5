"""Separate the houses of a row where steps, valleys or walls of the roof show a party wall.

A party wall runs straight from one side of a building to the other. There two roofs rise away from it (the valley
between gables side by side), parallel roofs step, or a wall rises above both. The walls of a row are chosen together:
those that cost least, by the evidence of each and how alike the houses between them are.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Callable

import numpy as np

from ..geometry.cheapest_labels import STEPS_OF_LABELS
from ..geometry.groups import components, split_groups
from ..packages import ndimage
from ..rules import rule
from .soft_shares import LEAST_SPACING, NODES, Lattice, spread_out


@dataclass(frozen=True)
class RowRules:
    """Evidence of party walls, and costs of walls and houses of a row."""

    step: float = rule(0.6, "point spacings", "step of the grid of heights, no finer than the points")
    along: float = rule(4.0, "point spacings", "heights are averaged over it along a line: enough points for a plane")
    near: float = rule(0.3, "m", "physics: from where the roof next to a line is measured, beyond the wall itself")
    far: float = rule(1.6, "m", "physics: to where the roof is measured, before the ridge of the narrowest house")
    rise: float = rule(0.25, "tangent", "physics: least slope of a roof that rises from a valley")
    parallel: float = rule(0.35, "tangent", "physics: slopes of parallel roofs differ by less")
    least_height: float = rule(
        0.2, "m", "physics: of a step between parallel roofs and of a wall over both; four times the noise of a scan"
    )
    rough: float = rule(0.25, "m", "physics: heights of roofs deviate less from a line; trees and machines more")
    large_step: float = rule(1.0, "m", "physics: a step between any two roofs, half a storey high")
    least_share: float = rule(
        0.6, "share", "of the higher house's height that the lower one has: 2 of 3 storeys, not a wing with 1 of 2"
    )
    wall: float = rule(
        0.15,
        "per spacing",
        "what a wall costs, where one clearly seen all along pays 1: noise of fewer points pays more",
    )
    row: float = rule(0.9, "walls", "what a row costs, and the most that one wall pays: two roofs may be one house")
    unlike: float = rule(0.1, "walls", "what a house e times as wide or narrow as the others of its row costs")
    narrowest: float = rule(3.5, "m", "physics: least width and depth of a house")
    deepest: float = rule(22.0, "m", "physics: greatest depth of a house")
    least_area: float = rule(25.0, "m²", "physics: smaller pieces that walls cut off are parts of a house next to them")
    same: float = rule(0.8, "m", "closer lines are the same wall")

    @property
    def wide(self) -> float:
        """Distance (m) at which half of a step has to be left, within the narrowest house; a dormer ends before."""
        return self.narrowest - self.same

    @property
    def max_spacing(self) -> float:
        """Spacing (m) up to which three samples of the grid fit in the roof next to a wall, as few as make a plane."""
        return self.far / (3 * self.step)


ROWS = RowRules()


#: The grid of a building passes through a multiple of this distance (m), about the size of a house. With 22 m, outlines
#: of Delft move by 0.19 instead of 0.08 m (median) when points move by 2 mm.
_FIXED = 16.0

# Widths (m) of the houses of a row that are tried, a fifth apart.
_WIDTHS = 4.0 * 1.2 ** np.arange(7)


@dataclass(frozen=True)
class Houses:
    """The houses of a building."""

    walls: np.ndarray  #: (w, 2, 2): ends of the party walls between them, m
    house: np.ndarray  #: (rows, columns), int64: house at each node of the lattice, from 1; 0 outside of the building


def split_row(
    lattice: Lattice, is_inside: np.ndarray, plan: np.ndarray, height: np.ndarray, angles: np.ndarray, spacing: float
) -> Houses:
    """Return the houses of a row, or the building as one.

    The row with the greatest saving is divided first, along one direction. Then each house is divided again, as a wall
    that ends at another party wall only crosses the part that is left.

    Parameters
    ----------
    lattice : Lattice
        Nodes around the building.
    is_inside : ndarray of shape (rows, columns), bool
        Which of these are the building.
    plan : ndarray of shape (n, 2)
        Points of its roof, m.
    height : ndarray of shape (n,)
        Their heights above the ground or one level, m; NaN where unknown.
    angles : ndarray of shape (k,)
        Its main directions, °.
    spacing : float
        Mean distance between neighboring points, m. Nothing is split where it is greater than ``ROWS.max_spacing``.
    """
    house, walls = is_inside.astype(np.int64), [np.zeros((0, 2, 2))]
    known = np.isfinite(height)
    if spacing > ROWS.max_spacing or is_inside.sum() * lattice.step**2 < 3 * ROWS.least_area or not known.any():
        return Houses(walls[0], house)
    plan, height = plan[known], height[known]
    tried = _directions(lattice, is_inside, plan, height, np.radians(angles))
    views = [view for angle in tried for view in _views(lattice, is_inside, plan, height, angle, spacing)]
    waiting = [1] if views else []
    while waiting:
        number = waiting.pop()
        is_own = house == number
        if is_own.sum() * lattice.step**2 < 2 * ROWS.least_area:
            continue
        row = max((view.best_row(is_own) for view in views), key=lambda row: row.saved)
        if row.saved > 0:
            count = int(house.max())
            house[is_own] = np.where(row.house > 0, count + row.house, number)[is_own]
            walls.append(row.walls)
            waiting += [number, *range(count + 1, int(house.max()) + 1)]
    return Houses(np.concatenate(walls), house)


def _directions(
    lattice: Lattice, is_inside: np.ndarray, plan: np.ndarray, height: np.ndarray, angles: np.ndarray
) -> list[float]:
    """Return the directions (rad) of a building, and the one in which most of its roof slopes, if that is another."""
    near = lattice.holds(plan)
    seen, total = (ndimage.gaussian_filter(lattice.spread(plan[near], own), NODES) for own in (None, height[near]))
    north, east = np.gradient(total / np.maximum(seen, 1e-9), lattice.step)
    # Neither level parts nor walls have a direction. Four times the angle is the same along a line and square to it.
    weight = ndimage.binary_erosion(is_inside, iterations=2 * NODES) * np.hypot(east, north) / (1 + east**2 + north**2)
    turn = np.angle((weight * np.exp(4j * np.arctan2(north, east))).sum()) / 4
    found = angles.tolist()
    # Two lines are the same if they diverge by less than a node along a wall.
    if (np.abs(np.angle(np.exp(4j * (angles - turn)))) > 4 * LEAST_SPACING / ROWS.deepest).all():
        found.append(float(turn))
    return found


def _views(
    lattice: Lattice, is_inside: np.ndarray, plan: np.ndarray, height: np.ndarray, angle: float, spacing: float
) -> list[_View]:
    """Return the evidence of walls along a direction (rad) and square to it."""
    step = max(LEAST_SPACING, ROWS.step * spacing)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    inside = lattice.in_plan(np.argwhere(is_inside)[:, ::-1])
    # The grid goes through a fixed position nearby, so that it does not move with the edge of the building.
    fixed = np.round(inside.mean(axis=0) / _FIXED) * _FIXED
    grid = Lattice.around((inside - fixed) @ turn, NODES * step)
    turned = (plan - fixed) @ turn
    near = grid.holds(turned)
    # Points are shared bilinearly among the four nodes around them, so that a wall does not depend on the grid.
    seen, total = (grid.spread(turned[near], weight) for weight in (None, height[near]))
    roof = total / np.maximum(seen, 1e-9)
    of_grid = np.ravel_multi_index(lattice.nearest(grid.positions @ turn.T + fixed), lattice.shape).reshape(grid.shape)
    of_lattice = grid.nearest((lattice.positions - fixed) @ turn)
    # Extend the line beyond the building on both sides, so that it divides it at notches of the outline, too.
    along = ROWS.along * spacing
    beyond = (along + spacing) / step

    def in_plan(along: np.ndarray, across: np.ndarray, axis: int) -> np.ndarray:
        ends = np.empty((len(across), 2, 2))
        ends[..., axis], ends[..., 1 - axis] = along + [-beyond, beyond], across[:, None]
        return grid.in_plan(ends) @ turn.T + fixed

    ways = ((roof.T, seen.T, of_grid.T, of_lattice[::-1]), (roof, seen, of_grid, of_lattice))
    return [
        _View(spacing, step, nodes, of_nodes, partial(in_plan, axis=axis), *_evidence(heights, counts, step, along))
        for axis, (heights, counts, nodes, of_nodes) in enumerate(ways)
    ]


@dataclass(frozen=True)
class _Row:
    """A row of houses within a part of a building."""

    saved: float  #: By how much its walls pay more than they cost, in steps
    walls: np.ndarray  #: (w, 2, 2): ends of its party walls, m
    house: np.ndarray  #: (rows, columns), int64: house, from 0, at the nodes of the lattice


@dataclass(frozen=True)
class _View:
    """Evidence of walls along the first axis of a grid, at its nodes (rows, columns)."""

    spacing: float  #: Mean distance between neighboring points, m
    step: float  #: Distance of nodes, m
    of_grid: np.ndarray  #: Number of the node of the lattice there
    of_lattice: tuple[np.ndarray, np.ndarray]  #: Row and column of the grid at each node of the lattice
    in_plan: Callable  #: Returns the ends (w, 2, 2), m, of walls by their first and last rows (w, 2) and columns (w,)
    strength: np.ndarray  #: Evidence of a wall, 0 to 1
    beside: np.ndarray  #: Height of the higher roof next to it, m; NaN where unknown

    @property
    def closed(self) -> int:
        """Number of nodes by which notches and gaps are closed, which end no wall: up to two point spacings wide."""
        return max(1, int(self.spacing / self.step + 0.5))

    def best_row(self, is_own: np.ndarray) -> _Row:
        """Return the row with the greatest saving in a part of a building (nodes of the lattice); 0 if none pays."""
        own = is_own.ravel()[self.of_grid]
        used = [np.flatnonzero(own.any(axis=axis)) for axis in (1, 0)]
        # Closing needs its reach on all sides, and the nearest node of the lattice may be one farther.
        start = tuple(max(0, int(at[0]) - self.closed - 1) for at in used)
        box = tuple(slice(low, int(at[-1]) + self.closed + 2) for low, at in zip(start, used))
        part = replace(self, strength=self.strength[box], beside=self.beside[box])
        inside = ndimage.binary_closing(own[box], iterations=self.closed)
        runs = _Runs.of(inside)
        sums = part._sums(runs, inside)
        pays = self._pays(*sums)
        found = [(*_chosen_walls(pays[chain], runs.length[chain], self.step), chain) for chain in runs.chains()]
        saved, walls, chain = max(found, key=lambda one: one[0], default=(0, *np.zeros((2, 0), np.int64)))
        house = runs.houses(chain, walls, self.step) if saved > 0 else np.zeros(1, np.int64)
        if not house.any():
            return _Row(0.0, np.zeros((0, 2, 2)), np.zeros(is_own.shape, np.int64))
        nodes = tuple(np.clip(at - low, 0, n - 1) for at, low, n in zip(self.of_lattice, start, inside.shape))
        label = spread_out(np.where(inside, 1 + house[runs.number], 0))[nodes] - 1
        ends = np.column_stack([runs.first[chain[walls]], runs.last[chain[walls]] - 1]) + start[0]
        places = start[1] + runs.column[chain[0]] + self._places(sums[1][chain], walls)
        return _Row(saved, self.in_plan(ends, places), label.reshape(is_own.shape))

    def _sums(self, runs: _Runs, inside: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Compute the length (m) of roofs that are not low along each run, and the length of wall (m) seen there."""
        known = self.beside[inside & np.isfinite(self.beside)]
        is_high = self.beside >= (ROWS.least_share * np.median(known) if len(known) else 0.0)
        # A wall that is slightly oblique shows in a neighboring column.
        near = ndimage.maximum_filter1d(self.strength, 3, axis=1)
        return runs.sums(is_high) * self.step, runs.sums(is_high * near) * self.step

    def _pays(self, counted: np.ndarray, seen: np.ndarray) -> np.ndarray:
        """Compute the value of a wall along each run, in steps: the share of it that is seen, less its cost."""
        pays = seen / np.maximum(counted, ROWS.narrowest) - ROWS.wall * self.spacing
        # A wall must pay by itself: likeness of the houses next to it is no evidence.
        is_wall = (counted >= ROWS.narrowest) & (counted <= ROWS.deepest) & (pays > 0)
        return np.where(is_wall, np.rint(np.minimum(pays, ROWS.row) * STEPS_OF_LABELS), -np.inf)

    def _places(self, seen: np.ndarray, walls: np.ndarray) -> np.ndarray:
        """Move walls (columns of the chain) to the middle of the evidence around them, by mean shift."""
        column, place = np.arange(len(seen)), walls.astype(float)
        # Mean shifts move a wall to the middle of the evidence around it; it hardly moves after half of these.
        for _ in range(10):
            near = seen * np.clip(1 - ((column - place[:, None]) * self.step / ROWS.far) ** 2, 0.0, None)
            total = near.sum(axis=1)
            place = np.where(total > 0, near @ column / np.where(total > 0, total, 1.0), place)
        # A house that would become too narrow by that keeps its width.
        narrow = np.flatnonzero(np.diff(place) * self.step < ROWS.narrowest)
        moved = np.union1d(narrow, narrow + 1)
        place[moved] = walls[moved]
        return place


@dataclass(frozen=True)
class _Runs:
    """Runs of nodes of a part of a building along the first axis of a grid, (r,) of each, column by column."""

    number: np.ndarray  #: (rows, columns), int64: run that each node is in; the last one elsewhere
    column: np.ndarray  #: int64: its column
    first: np.ndarray  #: int64: its first row
    last: np.ndarray  #: int64: the row after its last one
    beside: np.ndarray  #: (p, 2), int64: runs in columns side by side that have rows in common
    shared: np.ndarray  #: (p,), int64: how many

    @classmethod
    def of(cls, inside: np.ndarray) -> _Runs:
        """Return the runs of nodes inside."""
        change = np.diff(np.pad(inside.T, ((0, 0), (1, 1))).astype(np.int8), axis=1)
        column, first = np.nonzero(change == 1)
        number = np.cumsum((change == 1)[:, :-1].ravel()).reshape(inside.T.shape).T - 1
        both = inside[:, :-1] & inside[:, 1:]
        key = number[:, :-1][both] * len(column) + number[:, 1:][both]
        pairs, shared = np.unique(key, return_counts=True)
        beside = np.column_stack(np.divmod(pairs, max(len(column), 1)))
        return cls(number, column, first, np.nonzero(change == -1)[1], beside, shared)

    @property
    def length(self) -> np.ndarray:
        """Return the number of nodes of each."""
        return self.last - self.first

    def sums(self, values: np.ndarray) -> np.ndarray:
        """Return the sums of values (rows, columns) in each run."""
        total = np.cumsum(np.pad(values.astype(float), ((1, 0), (0, 0))), axis=0)
        return total[self.last, self.column] - total[self.first, self.column]

    def chains(self) -> list[np.ndarray]:
        """Return the runs that follow each other from column to column, each the one that shares most with the next."""
        one, other = self.beside.T
        order = np.argsort(self.shared, kind="stable")
        after, before = np.full((2, len(self.column)), -1)
        after[one[order]], before[other[order]] = other[order], one[order]
        follows = np.flatnonzero(before[after] == np.arange(len(after)))
        follows = follows[after[follows] >= 0]
        count, chain = components(follows, after[follows], len(after))
        return split_groups(chain, count)

    def houses(self, chain: np.ndarray, walls: np.ndarray, step: float) -> np.ndarray:
        """Return the house (r,), from 0, of each run, with walls before some runs of a chain."""
        is_cut = np.isin(self.beside[:, 1], chain[walls]) | np.isin(self.beside[:, 0], chain[walls - 1])
        one, other = self.beside[~is_cut].T
        piece = components(one, other, len(self.column))[1]
        return _without_small(piece, self.beside, self.shared, self.length * step**2)


def _chosen_walls(pays: np.ndarray, length: np.ndarray, step: float) -> tuple[float, np.ndarray]:
    """Choose the walls of a chain of runs with the greatest saving: this (steps), and the runs behind them, ascending.

    Houses are ``ROWS.narrowest`` m wide at least and have ``ROWS.least_area`` m². A house e times as wide as the best
    width for the row costs ``ROWS.unlike`` walls.

    Parameters
    ----------
    pays : ndarray of shape (n,)
        Value of a wall before each run, in whole steps; -inf if no wall is possible.
    length : ndarray of shape (n,), int64
        Nodes of each run.
    step : float
        Distance of nodes, m.
    """
    count, narrowest = len(pays), int(np.ceil(ROWS.narrowest / step))
    # Each strip as wide as the narrowest house has one wall at most.
    if np.maximum.reduceat(pays, range(0, count, narrowest)).clip(0).sum() <= ROWS.row * STEPS_OF_LABELS:
        return 0.0, np.zeros(0, np.int64)
    area = np.concatenate([[0], np.cumsum(length)]) * step**2
    widths = np.arange(1, count + 1) * step
    unlike = np.rint(ROWS.unlike * STEPS_OF_LABELS * np.abs(np.log(widths / _WIDTHS[:, None])))
    saved = np.full((len(_WIDTHS), count + 1), -np.inf)
    before = np.zeros(saved.shape, np.int64)
    saved[:, 0] = 0
    for end in range(narrowest, count + 1):
        # The last house begins before this position; of equal costs the first counts.
        last = min(end - narrowest + 1, int(np.searchsorted(area, area[end] - ROWS.least_area, "right")))
        if last > 0:
            total = saved[:, :last] - unlike[:, end - last : end][:, ::-1]
            before[:, end] = total.argmax(axis=1)
            saved[:, end] = total.max(axis=1) + (pays[end] if end < count else -round(ROWS.row * STEPS_OF_LABELS))
    width = int(saved[:, count].argmax())
    walls, at = [], int(before[width, count])
    while at > 0:
        walls.append(at)
        at = int(before[width, at])
    return float(saved[width, count]), np.array(walls[::-1], np.int64)


def _without_small(piece: np.ndarray, pairs: np.ndarray, shared: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Merge pieces smaller than a house into the neighbor with the longest shared border; renumber from 0.

    The smallest piece is merged first.
    """
    piece = piece.copy()
    while True:
        size = np.bincount(piece, area)
        beside = piece[pairs]
        is_border = beside[:, 0] != beside[:, 1]
        beside, border = beside[is_border], shared[is_border]
        small = np.flatnonzero((size > 0) & (size < ROWS.least_area) & np.isin(np.arange(len(size)), beside))
        if not len(small):
            return np.unique(piece, return_inverse=True)[1]
        own = beside == small[np.argmin(size[small])]
        weight = np.repeat(border, own.sum(axis=1))
        piece[piece == small[np.argmin(size[small])]] = np.bincount(beside[own[:, ::-1]], weight).argmax()


def _evidence(roof: np.ndarray, seen: np.ndarray, step: float, along: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the evidence, 0 to 1, of walls along the first axis, and the height (m) of the higher roof next to each.

    It is 0 up to the least step that counts, 0.5 at twice that, and tends to 1.
    """
    sums = _Sums.along(roof, seen, step, along)
    left, right = _side(sums, step, -1), _side(sums, step, 1)
    jump = np.abs(right.at_sample - left.at_sample)
    is_valley = (left.rise > ROWS.rise) & (right.rise > ROWS.rise)
    is_ridge = (left.rise < -ROWS.rise) & (right.rise < -ROWS.rise)
    is_parallel = np.abs(left.rise + right.rise) < ROWS.parallel
    is_large = (jump > ROWS.large_step) & ~is_ridge
    is_smooth = np.maximum(left.rough, right.rough) < ROWS.rough
    is_house = np.minimum(left.mean, right.mean) >= ROWS.least_share * np.maximum(left.mean, right.mean)
    goes_on = _goes_on(sums.mean(), sums.n >= 1, right.at_sample - left.at_sample, step)
    is_step = (is_parallel | is_large) & is_smooth & is_house & goes_on
    above = np.where(is_smooth, _above(sums, left, right, step), 0.0)
    times = np.maximum(np.where(is_step, jump, 0.0), above) / ROWS.least_height
    times = np.where(is_valley, np.maximum(times, np.minimum(left.rise, right.rise) / ROWS.rise), times)
    return 1 - 1 / np.maximum(np.nan_to_num(times), 1.0), np.maximum(left.mean, right.mean)


@dataclass(frozen=True)
class _Sums:
    """Sums over the points near each sample along a line: of 1, y, y², z, yz and z², y from the sample itself."""

    n: np.ndarray
    y: np.ndarray
    yy: np.ndarray
    z: np.ndarray
    yz: np.ndarray
    zz: np.ndarray

    @classmethod
    def along(cls, roof: np.ndarray, seen: np.ndarray, step: float, along: float) -> _Sums:
        """Return the sums at each sample of the mean heights (m) and numbers of points of cells."""
        half = round(along / 2 / step)
        y = np.arange(-half, half + 1) * step
        count = seen.astype(float)

        def total(values: np.ndarray, exponent: int) -> np.ndarray:
            return ndimage.correlate1d(values, y**exponent, axis=0, mode="constant")

        # Points are uniform within their cells: their variance along an axis is a twelfth of the squared side.
        n, z = total(count, 0), count * roof
        yy = total(count, 2) + n * step**2 / 12
        return cls(n, total(count, 1), yy, total(z, 0), total(z, 1), total(z * roof, 0))

    def mean(self) -> np.ndarray:
        """Return the mean heights, m."""
        return self.z / np.maximum(self.n, 1e-9)


@dataclass(frozen=True)
class _Side:
    """The plane fitted to the roof on one side of each sample."""

    at_sample: np.ndarray  #: Its height at the sample, m
    rise: np.ndarray  #: How it rises outward
    slope: np.ndarray  #: How it rises along the line
    rough: np.ndarray  #: Root mean square deviation of the points, m
    mean: np.ndarray  #: Their mean height, m


def _side(sums: _Sums, step: float, sign: int) -> _Side:
    """Return the planes fitted to the roof on one side; NaN where less than seven tenths of their columns are seen."""
    first, last = max(1, int(np.ceil(ROWS.near / step))), int(ROWS.far / step)
    # The kernel reaches from the sample itself to one side only.
    origin = last // 2 if sign < 0 else -((last + 1) // 2)
    terms = (
        *((sums.n, 0), (sums.n, 1), (sums.n, 2), (sums.y, 0), (sums.y, 1)),
        *((sums.yy, 0), (sums.z, 0), (sums.z, 1), (sums.yz, 0), (sums.zz, 0), (np.where(sums.n >= 1, 1.0, 0.0), 0)),
    )

    def total(values: np.ndarray, exponent: int) -> np.ndarray:
        kernel = np.zeros(last + 1)
        kernel[first:] = (np.arange(first, last + 1) * step) ** exponent
        return ndimage.correlate1d(values, kernel[::sign], axis=1, mode="constant", origin=origin)

    across = [total(*term) for term in terms]
    at_sample, rise, slope, rough = _fitted(across, last + 1 - first)
    mean = np.where(np.isfinite(rise), across[6] / np.maximum(across[0], 1.0), np.nan)
    return _Side(at_sample, rise, slope, rough, mean)


def _fitted(across: list, count: int) -> tuple[np.ndarray, ...]:
    """Return planes by least squares: height at the sample, rise across, slope along, deviation.

    ``across`` are sums of 1, x, x², y, xy, y², z, xz, yz, z² and the number of columns seen, of ``count``.
    """
    n, x, xx, y, xy, yy, z, xz, yz, zz, columns = across
    n = np.maximum(n, 1.0)
    xx, xy, yy = xx - x * x / n, xy - x * y / n, yy - y * y / n
    xz, yz, zz = xz - x * z / n, yz - y * z / n, zz - z * z / n
    det = xx * yy - xy * xy
    good = (columns >= 0.7 * count) & (det > 1e-6)
    det = np.where(good, det, 1.0)
    rise = np.where(good, xz * yy - yz * xy, np.nan) / det
    slope = np.where(good, yz * xx - xz * xy, np.nan) / det
    at_sample = (z - rise * x - slope * y) / n
    return at_sample, rise, slope, np.sqrt(np.maximum(zz - rise * xz - slope * yz, 0.0) / n)


def _above(sums: _Sums, left: _Side, right: _Side, step: float) -> np.ndarray:
    """Compute the height (m) of the roof above the planes of both sides, at each sample or an adjacent one."""
    level = sums.mean() - (left.slope + right.slope) / 2 * sums.y / np.maximum(sums.n, 1e-9)
    columns, above = np.arange(level.shape[1]), np.full(level.shape, -np.inf)
    for at in (-1, 0, 1):
        beside = level.take(np.clip(columns + at, 0, len(columns) - 1), axis=1)
        planes = np.maximum(left.at_sample - at * step * left.rise, right.at_sample + at * step * right.rise)
        above = np.maximum(above, beside - planes)
    return above


def _goes_on(roof: np.ndarray, is_known: np.ndarray, jump: np.ndarray, step: float) -> np.ndarray:
    """Return the mask of steps (m) to the right that continue farther away, or are not seen there.

    The step must continue as seen from every line that may be the same wall, as the line may lie that far from the
    side of a dormer.
    """
    away, same = round(ROWS.wide / step), 2 * int(ROWS.same / step) + 1
    known = np.pad(np.where(is_known, roof, np.nan), ((0, 0), (away, away)), constant_values=np.nan)
    farther = known[:, 2 * away :] - known[:, : -2 * away]
    up = ndimage.minimum_filter1d(np.nan_to_num(farther, nan=np.inf), same, axis=1)
    down = ndimage.maximum_filter1d(np.nan_to_num(farther, nan=-np.inf), same, axis=1)
    return np.where(jump > 0, up >= jump / 2, down <= jump / 2)
