"""Houses of a row: where the roofs above an outline say that one house ends and the next begins.

A party wall is seen where, along a straight line from one side of a building to the other, two roofs rise away from it
(the valley between gables side by side), parallel roofs step, or a wall stands above both of them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..packages import csgraph, ndimage, sparse
from .outlines import Tracing
from .regularize import edge_distances, line_along, main_directions, segments_meet

# Heights are looked at on a grid of this step (m, and in spacings), smoothed along the line over so much (m).
_STEP, _STEP_SPACINGS, _ALONG = 0.25, 0.6, 1.0

# The roof beside a line is what lies so far from it (m): beyond the wall itself, before the ridge of a narrow house.
_NEAR, _FAR = 0.3, 1.6

# Slope (tangent) from which a roof rises, and within which two are parallel.
_RISE, _PARALLEL = 0.25, 0.35

# Steps between parallel roofs, between any two, and what a wall stands above them (m).
_LEAST_STEP, _LARGE_STEP, _PARAPET = 0.4, 1.0, 0.3

# Heights (m) by which samples may be off the line fitted to a roof, and its greatest slope beside a large step.
_ROUGH, _STEEPEST = 0.25, 1.5

# A step goes on for so far (m) on both sides, by half at least: what ends before is a dormer.
_WIDE = 2.5

# The lower of two houses of a row is at least so high beside their wall (share of the higher): lower parts are wings.
_LEAST_SHARE = 0.75

# So much of a wall (share) is seen where it has roofs beside it that are at least so high (share of the median height).
_SEEN, _HIGH = 0.6, 0.5

# Lengths of party walls (m), distance of one from the next, and area (m²) of what they part: a house, not a part of it.
_SHORTEST, _DEEPEST, _NARROWEST, _WIDEST, _HOUSE = 4.0, 22.0, 3.5, 13.0, 25.0

# Cosine of the angle between walls of one row, 10°.
_NEARLY = 0.985

# Lines this close (m) are the same wall: the one, of those with so much (share) for them, that parts the roofs best.
_SAME, _STRONG = 0.8, 0.5


@dataclass(frozen=True)
class _Wall:
    """A line that may be a party wall: its ends (m), and how much speaks for it (m²: height times length)."""

    ends: np.ndarray
    strength: float

    @property
    def start(self) -> np.ndarray:
        return self.ends[0]

    @property
    def length(self) -> float:
        return float(np.hypot(*np.diff(self.ends, axis=0)[0]))

    @property
    def direction(self) -> np.ndarray:
        return (self.ends[1] - self.ends[0]) / self.length


def split_rows(tracing: Tracing, height: np.ndarray, spacing: float, tolerance: float) -> Tracing:
    """Return the tracing with the houses of rows as faces of their own, which have the label of the whole.

    A wall goes from one side of the face to the other and has another one beside it, a house away.

    Parameters
    ----------
    tracing : Tracing
        Faces of buildings.
    height : ndarray of shape (n,)
        Height above ground or elevation of its points (m).
    spacing, tolerance : float
        Mean distance between neighboring points, and how far wiggles of an outline may go (m).
    """
    face, labels = tracing.face.copy(), list(tracing.labels)
    area = tracing.areas
    rings: list = [[] for _ in labels]
    for number, edges in tracing.rings(tracing.face):
        places = tracing.xy[tracing.starts[edges]]
        rings[number].append(np.concatenate([places, places[:1]]))
    for number, own in enumerate(rings):
        rows = np.flatnonzero(tracing.face == number)
        if area[rows].sum() < 3 * _HOUSE:
            continue
        walls = [wall for ring in own for wall in line_along(ring).walls(tolerance)]
        found = [wall for angle in main_directions(walls) for wall in _lines(tracing, number, height, angle, spacing)]
        pieces = _parted(tracing, rows, area[rows], found)
        for piece in range(1, pieces.max() + 1):
            face[rows[pieces == piece]] = len(labels)
            labels.append(tracing.labels[number])
    return replace(tracing, face=face, labels=np.array(labels, tracing.labels.dtype))


def _lines(tracing: Tracing, face: int, height: np.ndarray, angle: float, spacing: float) -> list[_Wall]:
    """Return what may be party walls in a face, along a direction (rad) and square to it."""
    step = max(_STEP, _STEP_SPACINGS * spacing)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    places = tracing.xy[np.unique(tracing.triangles[tracing.face == face])] @ turn
    low, high = places.min(axis=0) - 2 * step, places.max(axis=0) + 2 * step
    axes = [np.arange(a, b, step) for a, b in zip(low, high)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    is_inside, roof = (
        values.reshape(grid.shape[:2]) for values in _sampled(tracing, face, height, grid.reshape(-1, 2) @ turn.T)
    )
    # Farther than the face on both sides, so that the line parts it where the outline has a notch, too.
    beyond = _ALONG + spacing
    walls = []
    for first, last, strength in _along_first_axis(roof, is_inside, step):
        ends = [axes[0][first[0]] - beyond, axes[0][last[0]] + beyond], [axes[1][first[1]]] * 2
        walls.append(_Wall(np.column_stack(ends) @ turn.T, strength))
    for first, last, strength in _along_first_axis(roof.T, is_inside.T, step):
        ends = [axes[0][first[1]]] * 2, [axes[1][first[0]] - beyond, axes[1][last[0]] + beyond]
        walls.append(_Wall(np.column_stack(ends) @ turn.T, strength))
    return walls


def _along_first_axis(roof: np.ndarray, is_inside: np.ndarray, step: float) -> list:
    """Return first and last place, (row, column), and strength (m²) of what may be walls along the first axis."""
    if not is_inside.any():
        return []
    weight, beside, misfit = _evidence(roof, is_inside, step)
    is_high = beside >= _HIGH * np.median(roof[is_inside])
    column, first, last = _runs(is_inside)
    length = (last - first) * step
    seen = ndimage.maximum_filter1d(weight, 3, axis=1) > 0
    counted, supported, strength, misfit = (
        _sums(values, column, first, last) * step for values in (is_high, seen & is_high, weight, misfit)
    )
    good = (length >= _SHORTEST) & (length <= _DEEPEST) & (supported >= np.maximum(_SHORTEST, _SEEN * counted))
    column, first, last, strength, misfit = (
        values[good] for values in (column, first, last, strength, misfit / length)
    )
    return [
        ((first[run], column[run]), (last[run] - 1, column[run]), float(strength[run]))
        for run in _distinct(column, first, last, strength, misfit, _SAME / step)
    ]


def _sampled(tracing: Tracing, face: int, height: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which places (n, 2) lie in a face, and the height there, 0 outside."""
    triangle, share = tracing.locate(places)
    is_inside = (triangle >= 0) & (tracing.face[triangle] == face)
    roof = np.where(is_inside, (height[tracing.triangles[triangle]] * share).sum(axis=1), 0.0)
    is_known = np.isfinite(roof)
    return is_inside & is_known, np.where(is_known, roof, 0.0)


def _evidence(roof: np.ndarray, is_inside: np.ndarray, step: float) -> tuple[np.ndarray, ...]:
    """Return how strongly (m) places look like a wall along the first axis, the height beside them, and misfits."""
    size = 2 * round(_ALONG / 2 / step) + 1
    weight = ndimage.uniform_filter1d(is_inside.astype(float), size, axis=0, mode="constant")
    roof = ndimage.uniform_filter1d(roof * is_inside, size, axis=0, mode="constant") / np.maximum(weight, 1e-9)
    is_known = weight >= 0.5
    left, left_rise, left_rough, left_mean = _side(roof, is_known, step, -1)
    right, right_rise, right_rough, right_mean = _side(roof, is_known, step, 1)
    jump = np.abs(right - left)
    is_valley = (left_rise > _RISE) & (right_rise > _RISE)
    is_ridge = (left_rise < -_RISE) & (right_rise < -_RISE)
    is_parallel = (jump > _LEAST_STEP) & (np.abs(left_rise + right_rise) < _PARALLEL)
    is_large = (jump > _LARGE_STEP) & (np.maximum(np.abs(left_rise), np.abs(right_rise)) < _STEEPEST) & ~is_ridge
    is_smooth = np.maximum(left_rough, right_rough) < _ROUGH
    is_house = np.minimum(left_mean, right_mean) >= _LEAST_SHARE * np.maximum(left_mean, right_mean)
    above = ndimage.maximum_filter1d(roof, 3, axis=1) - np.maximum(left, right)
    is_step = (is_parallel | is_large) & is_smooth & is_house & _goes_on(roof, is_known, right - left, step)
    is_parapet = (above > _PARAPET) & is_smooth
    strength = np.where(is_step, np.minimum(jump, 2 * _LARGE_STEP), np.where(is_parapet, above, 0.0))
    strength = np.where(is_valley, np.minimum(left_rise, right_rise), strength)
    rough = [np.nan_to_num(_side(roof, is_known, step, sign, 0.0)[2]) for sign in (-1, 1)]
    return strength, np.nan_to_num(np.maximum(left_mean, right_mean)), rough[0] + rough[1]


def _goes_on(roof: np.ndarray, is_known: np.ndarray, jump: np.ndarray, step: float) -> np.ndarray:
    """Return where a step (m) to the right is still there farther from it, or nothing is seen of that."""
    away = round(_WIDE / step)
    known = np.pad(np.where(is_known, roof, np.nan), ((0, 0), (away, away)), constant_values=np.nan)
    farther = known[:, 2 * away :] - known[:, : -2 * away]
    return ~(farther * np.sign(jump) < np.abs(jump) / 2)


def _side(
    roof: np.ndarray, is_known: np.ndarray, step: float, sign: int, near: float = _NEAR
) -> tuple[np.ndarray, ...]:
    """Return the line fitted to the roof on one side of each place: height here, rise outward, deviation, mean."""
    offsets = np.arange(max(1, int(np.ceil(near / step))), int(_FAR / step) + 1)
    far = offsets * step

    def total(values: np.ndarray, factor: np.ndarray) -> np.ndarray:
        kernel = np.zeros(2 * offsets[-1] + 1)
        kernel[offsets[-1] + sign * offsets] = factor
        return ndimage.correlate1d(values * is_known, kernel, axis=1, mode="constant")

    one = np.ones(len(far))
    n, x, xx = (total(np.ones(roof.shape), factor) for factor in (one, far, far**2))
    z, xz, zz = total(roof, one), total(roof, far), total(roof**2, one)
    det = n * xx - x**2
    good = (n >= 0.7 * len(far)) & (det > 1e-6)
    rise = np.where(good, n * xz - x * z, np.nan) / np.where(good, det, 1.0)
    here = (z - rise * x) / np.maximum(n, 1.0)
    rough = np.sqrt(np.maximum(zz - here * z - rise * xz, 0.0) / np.maximum(n, 1.0))
    return here, rise, rough, np.where(good, z / np.maximum(n, 1.0), np.nan)


def _runs(is_inside: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the column of each run of places inside along the first axis, its first row and the one after its last."""
    change = np.diff(np.pad(is_inside.T, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    column, first = np.nonzero(change == 1)
    return column, first, np.nonzero(change == -1)[1]


def _sums(values: np.ndarray, column: np.ndarray, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Return the sum of the values in each run."""
    total = np.cumsum(np.pad(values.astype(float), ((1, 0), (0, 0))), axis=0)
    return total[last, column] - total[first, column]


def _distinct(
    column: np.ndarray, first: np.ndarray, last: np.ndarray, strength: np.ndarray, misfit: np.ndarray, same: float
) -> list[int]:
    """Return one of the runs that lie side by side: where two lines fit the roof best, of those with much for them."""
    found = []
    is_left = np.ones(len(column), bool)
    for best in np.argsort(-strength, kind="stable").tolist():
        if not is_left[best]:
            continue
        shared = np.minimum(last, last[best]) - np.maximum(first, first[best])
        beside = is_left & (2 * shared > last[best] - first[best])
        near = beside & (np.abs(column - column[best]) <= same)
        strong = np.flatnonzero(near & (strength >= _STRONG * strength[best]))
        found.append(int(strong[np.argmin(misfit[strong])]))
        is_left &= ~beside | (np.abs(column - column[found[-1]]) > same)
        is_left[best] = False
    return found


def _parted(tracing: Tracing, rows: np.ndarray, area: np.ndarray, walls: list[_Wall]) -> np.ndarray:
    """Return the house (t,), from 0, of each triangle of a face, given by its rows: pieces between party walls."""
    pairs, middle = _pairs(tracing, rows)
    kept: list = []
    cut = np.zeros(len(pairs), bool)
    for wall in sorted(_in_rows(walls), key=lambda wall: -wall.strength):
        if any(_are_close(wall, other) for other in kept):
            continue
        more = cut | _crosses(wall, middle[pairs])
        if np.bincount(_pieces(pairs[~more], len(rows)), area).min() >= _HOUSE:
            kept.append(wall)
            cut = more
    cut = np.zeros(len(pairs), bool)
    for wall in _in_rows(kept):
        cut |= _crosses(wall, middle[pairs])
    return _pieces(pairs[~cut], len(rows))


def _pairs(tracing: Tracing, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the triangles (p, 2) of a face that share an edge, counted in its rows, and the middle of each."""
    number = np.full(len(tracing.triangles), -1)
    number[rows] = np.arange(len(rows))
    beside = np.where(tracing.neighbors[rows] >= 0, number[tracing.neighbors[rows]], -1)
    one, side = np.nonzero(beside > np.arange(len(rows))[:, None])
    return np.column_stack([one, beside[one, side]]), tracing.xy[tracing.triangles[rows]].mean(axis=1)


def _pieces(pairs: np.ndarray, count: int) -> np.ndarray:
    graph = sparse.coo_matrix((np.ones(len(pairs), bool), tuple(pairs.T)), (count, count))
    return csgraph.connected_components(graph, directed=False)[1]


def _crosses(wall: _Wall, places: np.ndarray) -> np.ndarray:
    """Return which segments (n, 2, 2) lead across a wall."""
    (x, y), offset = wall.direction, places - wall.start
    side = x * offset[..., 1] - y * offset[..., 0]
    along = (offset @ wall.direction).mean(axis=1)
    return ((side[:, 0] > 0) != (side[:, 1] > 0)) & (along >= 0) & (along <= wall.length)


def _are_close(wall: _Wall, other: _Wall) -> bool:
    """Return whether two walls cross or leave no room for a house between them."""
    one, two = wall.ends, other.ends
    if segments_meet(one[:1], one[1:], two[:1], two[1:]):
        return True
    apart = min(edge_distances(a, b[:1], b[1:]).min() for a, b in ((one, two), (two, one)))
    return bool(apart < _NARROWEST)


def _in_rows(walls: list[_Wall]) -> list[_Wall]:
    """Return the walls that have another beside them, a house away: two roofs may be one house, three are a row."""
    while True:
        kept = [wall for wall in walls if any(_is_next(wall, other) for other in walls)]
        if len(kept) == len(walls):
            return kept
        walls = kept


def _is_next(wall: _Wall, other: _Wall) -> bool:
    """Return whether another wall is nearly parallel to a wall and as far away as a house is wide."""
    if abs(wall.direction @ other.direction) < _NEARLY:
        return False
    offset = other.ends - wall.start
    along = np.sort(offset @ wall.direction)
    shared = min(along[1], wall.length) - max(along[0], 0.0)
    x, y = wall.direction
    apart = abs(float((x * offset[:, 1] - y * offset[:, 0]).mean()))
    return bool(_NARROWEST <= apart <= _WIDEST and 2 * shared >= min(wall.length, other.length))
