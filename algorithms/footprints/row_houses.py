"""Houses of a row: where the roofs above an outline show that one house ends and the next begins.

A party wall is seen along a straight line from one side of a building to the other. There two roofs rise away from it
(the valley between gables side by side), parallel roofs step, or a wall rises above both.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Optional

import numpy as np

from ..geometry.groups import components
from ..geometry.line_segments import edge_distances, segments_meet
from ..packages import ndimage, spatial
from ..rules import rule
from .soft_shares import LEAST_SPACING, NODES, Lattice


@dataclass(frozen=True)
class RowRules:
    """What shows a party wall, and which walls are of a row."""

    step: float = rule(0.6, "point spacings", "step of the grid of heights, no finer than the points")
    along: float = rule(1.0, "m", "physics: heights are averaged over it along a line; less than a dormer is wide")
    near: float = rule(0.3, "m", "physics: from where the roof beside a line is measured, beyond the wall itself")
    far: float = rule(1.6, "m", "physics: to where the roof is measured, before the ridge of the narrowest house")
    rise: float = rule(0.25, "tangent", "physics: least slope of a roof that rises from a valley")
    parallel: float = rule(0.35, "tangent", "physics: slopes of parallel roofs differ by less")
    least_height: float = rule(
        0.2, "m", "physics: of a step between parallel roofs and of a wall over both; four times the noise of a scan"
    )
    rough: float = rule(0.25, "m", "physics: heights of roofs deviate less from a line; trees and machines more")
    large_step: float = rule(1.0, "m", "physics: a step between any two roofs, that of half a storey")
    least_share: float = rule(
        0.6, "share", "of the higher house's height that the lower one has: 2 of 3 storeys, not a wing with 1 of 2"
    )
    seen: float = rule(0.5, "share", "of a wall that shows a row: what is seen of it beside roofs")
    glimpsed: float = rule(
        0.3, "share", "of a further wall of a row that is seen beside roofs: hips hide valleys at their ends"
    )
    evident: float = rule(0.2, "m, or tangent", "mean strength of a wall; noise of matched images reaches 0.17")
    high: float = rule(0.5, "share", "of the median height: lower parts are no roof of a row")
    narrowest: float = rule(3.5, "m", "physics: least width and depth of a house")
    largest: float = rule(22.0, "m", "physics: greatest width and depth of a house")
    least_area: float = rule(25.0, "m²", "physics: smaller pieces that walls cut off are parts of a house next to them")
    angle: float = rule(10.0, "°", "physics: between party walls of one row, which are nearly parallel")
    same: float = rule(0.8, "m", "closer lines are the same wall")
    strong: float = rule(0.5, "share", "of the greatest strength, from which the line that parts roofs best is chosen")

    @property
    def wide(self) -> float:
        """Distance (m) at which half of a step has to be left, within the narrowest house; a dormer ends before."""
        return self.narrowest - self.same

    @property
    def max_spacing(self) -> float:
        """Spacing (m) up to which six samples of the grid fit in the roof beside a wall, so that noise makes no slope.

        With four and five points per m² simulated single houses were split.
        """
        return self.far / (6 * self.step)


ROWS = RowRules()

#: Distance (m) between the positions one of which the grid of a building goes through: about the size of a house.
#: With 22 m, outlines of Delft move by 0.19 instead of 0.08 m (median) when points move by 2 mm.
_FIXED = 16.0


@dataclass(frozen=True)
class Houses:
    """The houses of a building."""

    walls: np.ndarray  #: (w, 2, 2): ends of the party walls between them, m
    house: np.ndarray  #: (rows, columns), int64: house at each node of the lattice, from 1; 0 outside of the building


def split_row(
    lattice: Lattice, is_inside: np.ndarray, plan: np.ndarray, height: np.ndarray, angles: np.ndarray, spacing: float
) -> Houses:
    """Return the houses of a row, or the building as one.

    A party wall goes from one side of the building, or of a house parted before, to the other, and has another one
    beside it, a house away.

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
    whole = Houses(np.zeros((0, 2, 2)), is_inside.astype(np.int64))
    known = np.isfinite(height)
    if spacing > ROWS.max_spacing or is_inside.sum() * lattice.step**2 < 3 * ROWS.least_area or not known.any():
        return whole
    found = [_lines(lattice, is_inside, plan[known], height[known], np.radians(angle), spacing) for angle in angles]
    parted = _parted(lattice, is_inside, found)
    if parted is None or parted.house.max() == 1:
        return parted or whole
    # Each house again: a wall that ends at another party wall is one from side to side only of what these leave.
    walls, house = [parted.walls], np.zeros_like(parted.house)
    room = int((ROWS.wide + ROWS.along) / lattice.step) + 1
    for number, box in enumerate(ndimage.find_objects(parted.house), start=1):
        rows, columns = (slice(max(0, along.start - room), along.stop + room) for along in box)
        window = rows, columns
        part, is_own = lattice.part(window), parted.house[window] == number
        near = part.holds(plan)
        own = split_row(part, is_own, plan[near], height[near], angles, spacing)
        house[window] += np.where(is_own, own.house + house.max(), 0)
        walls.append(own.walls)
    return Houses(np.concatenate(walls), house)


def _lines(
    lattice: Lattice, is_inside: np.ndarray, plan: np.ndarray, height: np.ndarray, angle: float, spacing: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the ends (w, 2, 2) (m) and strengths (w,) (m²) of what may be party walls, and which (w,) are clear.

    They run along a direction (rad) or square to it.
    """
    step = max(LEAST_SPACING, ROWS.step * spacing)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    inside = lattice.in_plan(np.argwhere(is_inside)[:, ::-1])
    # The grid goes through a fixed position nearby, so that it does not move with the edge of the building.
    fixed = np.round(inside.mean(axis=0) / _FIXED) * _FIXED
    grid = Lattice.around((inside - fixed) @ turn, NODES * step)
    turned = (plan - fixed) @ turn
    near = grid.holds(turned)
    # A point counts at the four positions around it, the more the nearer, so that a wall does not depend on the grid.
    seen, total = (grid.spread(turned[near], weight) for weight in (None, height[near]))
    roof = total / np.maximum(seen, 1e-9)
    inside = is_inside[lattice.nearest(grid.positions @ turn.T + fixed)].reshape(grid.shape)
    # Farther than the building on both sides, so that the line parts it where the outline has a notch, too.
    beyond = (ROWS.along + spacing) / step
    found = []
    for axis, arrays in ((0, (roof.T, seen.T, inside.T)), (1, (roof, seen, inside))):
        runs = _along_first_axis(*arrays, step)
        ends = np.empty((len(runs.column), 2, 2))
        ends[:, 0, axis], ends[:, 1, axis] = runs.first - beyond, runs.last - 1 + beyond
        ends[..., 1 - axis] = (runs.column + runs.shift)[:, None]
        found.append((grid.in_plan(ends) @ turn.T + fixed, runs.strength, runs.is_clear))
    ends, strength, is_clear = map(np.concatenate, zip(*found))
    return ends, strength, is_clear


@dataclass(frozen=True)
class _Runs:
    """What may be party walls along the first axis of a grid, (r,) of each."""

    column: np.ndarray  #: int64: its column
    first: np.ndarray  #: int64: its first row
    last: np.ndarray  #: int64: the row after its last one
    shift: np.ndarray  #: Columns from its column to where two lines fit the roof best
    strength: np.ndarray  #: Sum of the strength of the evidence along it, m² (of valleys m)
    is_above: np.ndarray  #: bool: whether most of its strength is that of a wall above both roofs
    misfit: np.ndarray  #: Mean deviation of the roof from two lines that meet, m
    beyond: np.ndarray  #: Mean deviation of the roof from two lines that begin beyond a wall, m
    is_clear: np.ndarray  #: bool: whether most of it is seen

    def take(self, index: np.ndarray) -> _Runs:
        """Return some of them."""
        return _Runs(*(getattr(self, field.name)[index] for field in fields(self)))


def _along_first_axis(roof: np.ndarray, seen: np.ndarray, is_inside: np.ndarray, step: float) -> _Runs:
    """Return what may be party walls along the first axis, one of those that lie side by side."""
    counted = is_inside & (seen > 0)
    least = ROWS.high * np.median(roof[counted]) if counted.any() else 0.0
    runs = _runs_of_party_walls(roof, seen, is_inside, least, step)
    return runs.take(_distinct(runs, ROWS.same / step))


def _runs_of_party_walls(roof: np.ndarray, seen: np.ndarray, is_inside: np.ndarray, least: float, step: float) -> _Runs:
    """Return the runs like a party wall. Only beside roofs of the ``least`` height (m) a wall has to be seen."""
    weight, height, is_above, misfit, beyond = _evidence(roof, seen, step)
    is_high = height >= least
    column, first, last = _runs(is_inside)
    length = (last - first) * step
    is_seen = ndimage.maximum_filter1d(weight, 3, axis=1) > 0
    counted, supported, strength, above, beyond = (
        _sums_of_runs(values, column, first, last) * step
        for values in (is_high, is_seen & is_high, weight, is_above * weight, beyond)
    )
    beside = (np.clip(column + at, 0, roof.shape[1] - 1) for at in (-1, 0, 1))
    before, at_line, after = (_sums_of_runs(misfit, at, first, last) * step / length for at in beside)
    bend = before - 2 * at_line + after
    # Beside a wall above both roofs the misfit is that of the wall, and its least value is no evidence.
    is_sharp = bend > at_line / 2
    shift = np.where(is_sharp, np.clip((before - after) / np.where(is_sharp, 2 * bend, 1.0), -0.5, 0.5), 0.0)
    is_clear = (supported >= np.maximum(ROWS.narrowest, ROWS.seen * counted)) & (strength >= ROWS.evident * counted)
    is_long = (length >= ROWS.narrowest) & (length <= ROWS.largest)
    good = np.flatnonzero(is_long & (supported >= ROWS.glimpsed * np.maximum(ROWS.narrowest, counted)))
    is_wall = 2 * above > strength
    return _Runs(column, first, last, shift, strength, is_wall, at_line, beyond / length, is_clear).take(good)


def _evidence(roof: np.ndarray, seen: np.ndarray, step: float) -> tuple[np.ndarray, ...]:
    """Return the strength of party walls along the first axis at samples (m; of valleys a tangent).

    Further the height beside them (m), whether they are a wall above both roofs, and the misfits of roofs that meet and
    of those beyond a wall.
    """
    sums = _Sums.along(roof, seen, step)
    left, right = _side(sums, step, -1), _side(sums, step, 1)
    jump = np.abs(right.at_sample - left.at_sample)
    is_valley = (left.rise > ROWS.rise) & (right.rise > ROWS.rise)
    is_ridge = (left.rise < -ROWS.rise) & (right.rise < -ROWS.rise)
    is_parallel = (jump > ROWS.least_height) & (np.abs(left.rise + right.rise) < ROWS.parallel)
    is_large = (jump > ROWS.large_step) & ~is_ridge
    is_smooth = np.maximum(left.rough, right.rough) < ROWS.rough
    is_house = np.minimum(left.mean, right.mean) >= ROWS.least_share * np.maximum(left.mean, right.mean)
    above = _above(sums, left, right, step)
    goes_on = _goes_on(sums.mean(), sums.n >= 1, right.at_sample - left.at_sample, step)
    is_step = (is_parallel | is_large) & is_smooth & is_house & goes_on
    is_parapet = (above > ROWS.least_height) & is_smooth
    strength = np.where(is_step, np.minimum(jump, 2 * ROWS.large_step), np.where(is_parapet, above, 0.0))
    strength = np.where(is_valley, np.minimum(left.rise, right.rise), strength)
    is_above = is_parapet & ~is_step & (np.maximum(left.rise, right.rise) < ROWS.rise)
    misfit = np.nan_to_num(left.misfit) + np.nan_to_num(right.misfit)
    beyond = np.nan_to_num(left.rough) + np.nan_to_num(right.rough)
    return strength, np.nan_to_num(np.maximum(left.mean, right.mean)), is_above, misfit, beyond


@dataclass(frozen=True)
class _Sums:
    """Sums over the points within half a meter along a line: of 1, y, y², z, yz and z², y from the sample itself."""

    n: np.ndarray
    y: np.ndarray
    yy: np.ndarray
    z: np.ndarray
    yz: np.ndarray
    zz: np.ndarray

    @classmethod
    def along(cls, roof: np.ndarray, seen: np.ndarray, step: float) -> _Sums:
        """Return the sums at each sample of the mean heights (m) and numbers of points of cells."""
        half = round(ROWS.along / 2 / step)
        y = np.arange(-half, half + 1) * step
        count = seen.astype(float)

        def total(values: np.ndarray, exponent: int) -> np.ndarray:
            return ndimage.correlate1d(values, y**exponent, axis=0, mode="constant")

        # Points lie anywhere in their cells: a twelfth of the square of a side each.
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
    misfit: np.ndarray  #: The deviation where the fit begins at the sample itself, m


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
    for offset in range(1, first):
        own, other = slice(None, -offset), slice(offset, None)
        own, other = (own, other) if sign > 0 else (other, own)
        for one, (values, exponent) in zip(across, terms):
            one[:, own] += values[:, other] * (offset * step) ** exponent
    return _Side(at_sample, rise, slope, rough, mean, _fitted(across, last)[3])


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
    """Return how high (m) the roof is at each sample, or one beside it, above the planes of both sides."""
    level = sums.mean() - (left.slope + right.slope) / 2 * sums.y / np.maximum(sums.n, 1e-9)
    columns, above = np.arange(level.shape[1]), np.full(level.shape, -np.inf)
    for at in (-1, 0, 1):
        beside = level.take(np.clip(columns + at, 0, len(columns) - 1), axis=1)
        above = np.maximum(
            above, beside - np.maximum(left.at_sample - at * step * left.rise, right.at_sample + at * step * right.rise)
        )
    return above


def _goes_on(roof: np.ndarray, is_known: np.ndarray, jump: np.ndarray, step: float) -> np.ndarray:
    """Return where a step (m) to the right is still there farther from it, or nothing is seen of that.

    It has to be there from every line that may be the same wall: the line itself may be that far from a dormer's side.
    """
    away, same = round(ROWS.wide / step), 2 * int(ROWS.same / step) + 1
    known = np.pad(np.where(is_known, roof, np.nan), ((0, 0), (away, away)), constant_values=np.nan)
    farther = known[:, 2 * away :] - known[:, : -2 * away]
    up = ndimage.minimum_filter1d(np.nan_to_num(farther, nan=np.inf), same, axis=1)
    down = ndimage.maximum_filter1d(np.nan_to_num(farther, nan=-np.inf), same, axis=1)
    return np.where(jump > 0, up >= jump / 2, down <= jump / 2)


def _runs(is_inside: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the column of each run of cells inside along the first axis, its first row and the one after its last."""
    change = np.diff(np.pad(is_inside.T, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    column, first = np.nonzero(change == 1)
    return column, first, np.nonzero(change == -1)[1]


def _sums_of_runs(values: np.ndarray, column: np.ndarray, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Return the sum of the values in each run."""
    total = np.cumsum(np.pad(values.astype(float), ((1, 0), (0, 0))), axis=0)
    return total[last, column] - total[first, column]


def _distinct(runs: _Runs, same: float) -> np.ndarray:
    """Return one of the runs that lie side by side: where two lines fit best, of those with strong evidence."""
    found = []
    column, first, last, strength = runs.column, runs.first, runs.last, runs.strength
    is_open = np.ones(len(column), bool)
    for best in np.argsort(-strength, kind="stable").tolist():
        if not is_open[best]:
            continue
        shared = np.minimum(last, last[best]) - np.maximum(first, first[best])
        beside = is_open & (2 * shared > last[best] - first[best])
        near = beside & (np.abs(column - column[best]) <= same)
        strong = np.flatnonzero(near & (strength >= ROWS.strong * strength[best]))
        fit = runs.beyond if runs.is_above[best] else runs.misfit
        found.append(int(strong[np.argmin(fit[strong])]))
        is_open &= ~beside | (np.abs(column - column[found[-1]]) > same)
        is_open[best] = False
    return np.array(found, np.int64)


def _parted(lattice: Lattice, is_inside: np.ndarray, found: list) -> Optional[Houses]:
    """Return the houses between party walls, of which ``found`` are ends and strengths; None without any."""
    if not found:
        return None
    ends, strength, is_clear = (np.concatenate(values) for values in zip(*found))
    order = np.lexsort((-strength, ~is_clear))
    ends, is_clear = ends[order], is_clear[order]
    in_rows = _in_rows(ends, is_clear)
    ends, is_clear = ends[in_rows], is_clear[in_rows]
    if not len(ends):
        return None
    pairs, middle = _pairs(lattice, is_inside)
    area = lattice.step**2
    crossed = _crossed(ends, middle[pairs])
    # Nodes that no wall parts are one cell: there are many fewer of these.
    is_crossed = np.zeros(len(pairs), bool)
    is_crossed[np.concatenate(crossed)] = True
    cell = _pieces(pairs[~is_crossed], len(middle))
    pairs, number = cell[pairs[is_crossed]], np.cumsum(is_crossed) - 1
    crossed, size = [number[own] for own in crossed], area * np.bincount(cell)
    kept = _chosen_walls(ends, crossed, pairs, size)
    kept = kept[_in_rows(ends[kept], is_clear[kept])]
    walls = ends[kept]
    is_cut = np.zeros(len(pairs), bool)
    for wall in kept:
        is_cut[crossed[wall]] = True
    house = np.zeros(is_inside.shape, np.int64)
    house[is_inside] = 1 + _without_small(_pieces(pairs[~is_cut], len(size)), pairs, size)[cell]
    return Houses(walls, house) if len(walls) else None


def _chosen_walls(ends: np.ndarray, crossed: list, pairs: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Return the party walls, of those that come first, that leave room between them and part two houses.

    ``crossed`` are the ``pairs`` of cells that each parts, ``area`` (m²) is that of the cells.
    """
    kept: list = []
    is_cut, before, houses_before = np.zeros(len(pairs), bool), 1, 1
    for wall, own in enumerate(crossed):
        if kept and _is_close(ends[wall], ends[kept]):
            continue
        more = is_cut.copy()
        more[own] = True
        size = np.bincount(_pieces(pairs[~more], len(area)), area)
        houses = int((size >= ROWS.least_area).sum())
        # A wall beside a courtyard parts nothing before another one does on the other side.
        if houses > houses_before or len(size) == before:
            kept.append(wall)
            is_cut, before, houses_before = more, len(size), houses
    return np.array(kept, np.int64)


def _without_small(piece: np.ndarray, pairs: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Return the pieces of cells, from 0, with those smaller than a house in the one that they share most border with.

    The smallest comes first.
    """
    piece = piece.copy()
    while True:
        size = np.bincount(piece, area)
        beside = piece[pairs]
        beside = beside[beside[:, 0] != beside[:, 1]]
        small = np.flatnonzero((size > 0) & (size < ROWS.least_area) & np.isin(np.arange(len(size)), beside))
        if not len(small):
            return np.unique(piece, return_inverse=True)[1]
        own = beside == small[np.argmin(size[small])]
        piece[piece == small[np.argmin(size[small])]] = np.bincount(beside[own[:, ::-1]]).argmax()


def _pairs(lattice: Lattice, is_inside: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes (p, 2) of a building beside each other, counted among its own, and their positions (m)."""
    number = np.full(is_inside.shape, -1)
    number[is_inside] = np.arange(is_inside.sum())
    beside = [(number[:, :-1], number[:, 1:]), (number[:-1], number[1:])]
    both = np.concatenate([np.column_stack([one.ravel(), other.ravel()]) for one, other in beside])
    return both[(both >= 0).all(axis=1)], lattice.in_plan(np.argwhere(is_inside)[:, ::-1])


def _pieces(pairs: np.ndarray, count: int) -> np.ndarray:
    """Return the piece, from 0, of each of ``count`` cells that pairs of them connect."""
    return components(pairs[:, 0], pairs[:, 1], count)[1]


def _crossed(ends: np.ndarray, segments: np.ndarray) -> list:
    """Return for each party wall the segments (n, 2, 2) that lead across it."""
    middle, step = segments.mean(axis=1), ends[:, 1] - ends[:, 0]
    length, (east, north) = np.hypot(*step.T), np.ascontiguousarray(middle.T)
    half = np.hypot(*(segments[:, 1] - segments[:, 0]).T).max(initial=0.0) / 2
    found = []
    for start, (x, y), size in zip(ends[:, 0], step / length[:, None], length):
        # Few segments are as near as half of their length.
        own = np.flatnonzero(np.abs(x * (north - start[1]) - y * (east - start[0])) <= half)
        offset = segments[own] - start
        side = x * offset[..., 1] - y * offset[..., 0] > 0
        along = (middle[own] - start) @ [x, y]
        found.append(own[(side[:, 0] != side[:, 1]) & (along >= 0) & (along <= size)])
    return found


def _is_close(wall: np.ndarray, others: np.ndarray) -> bool:
    """Return whether a party wall (2, 2) crosses one of others (w, 2, 2), or leaves no room for a house beside it."""
    starts, stops = others[:, 0], others[:, 1]
    if segments_meet(wall[:1], wall[1:], starts, stops):
        return True
    from_wall, to_wall = edge_distances(wall, starts, stops), edge_distances(others.reshape(-1, 2), wall[:1], wall[1:])
    return bool(min(from_wall.min(), to_wall.min()) < ROWS.narrowest)


def _in_rows(ends: np.ndarray, is_clear: np.ndarray) -> np.ndarray:
    """Return which party walls (w,) are of a row: three houses or more, with two clear walls side by side."""
    length = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    reach = ROWS.largest + length.max(initial=0.0)
    near = spatial.cKDTree(ends.mean(axis=1)).query_pairs(reach, output_type="ndarray")
    near = np.concatenate([near, near[:, ::-1]])
    one, other = near[_are_next(ends[near[:, 0]], ends[near[:, 1]])].T
    count, row = components(one, other, len(ends))
    is_row = np.zeros(count, bool)
    is_row[row[one[is_clear[one] & is_clear[other]]]] = True
    return is_row[row]


def _are_next(walls: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Return which others (p, 2, 2) are nearly parallel to party walls (p, 2, 2) and as far away as a house is wide."""
    step, other_step = walls[:, 1] - walls[:, 0], others[:, 1] - others[:, 0]
    length, other_length = np.hypot(*step.T), np.hypot(*other_step.T)
    x, y = (step / length[:, None]).T
    offset_x, offset_y = np.moveaxis(others - walls[:, :1], 2, 0)
    along = np.sort(offset_x * x[:, None] + offset_y * y[:, None], axis=1)
    shared = np.minimum(along[:, 1], length) - np.maximum(along[:, 0], 0.0)
    apart = np.abs((x[:, None] * offset_y - y[:, None] * offset_x).mean(axis=1))
    is_parallel = (
        np.abs(x * other_step[:, 0] + y * other_step[:, 1]) >= float(np.cos(np.radians(ROWS.angle))) * other_length
    )
    is_beside = 2 * shared >= np.minimum(length, other_length)
    return is_parallel & is_beside & (apart >= ROWS.narrowest) & (apart <= ROWS.largest)
