"""The outline of one building's walls: which lines between its corners are real."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..footprints.regularization import regularize_outline
from ..geometry.arrangement import Arrangement, keys_of, sides_of
from ..geometry.grid import refuse_sparse
from ..geometry.line_segments import edge_distances
from ..geometry.polylines import simplify_ring
from ..geometry.rings import signed_area
from ..packages import ndimage
from ..stage import Monitor
from .wall_lines import Scale, WallLine, find_lines, merge_lines, square_up, wall_scale

# Side of the cells in which a roof is held against walls (m); where they would be more than so many, larger ones are
# taken. Around the roof there is so much room (m).
_CELL, _LARGEST_CELL, _MOST_CELLS, _ROOM = 0.25, 1.0, 5e5, 2.0

# What an outline costs, in meters of wall that nobody sees: the cheapest one is taken.
# A square meter in the outline that is no roof. Room for noise and for the roof's own ragged edge (m) costs nothing.
_OUTSIDE, _BEYOND = 5.0, 0.4
# A square meter left out although it lies farther under the roof than the overhang and this distance (m) together.
_INSIDE, _WELL_INSIDE = 1.0, 0.3
# More for one farther under it than the largest overhang, or than this share of the depth of the deepest place, where
# the roof is small.
_DEEP, _DEEPER = 2.0, 0.6
# More than any wall: the deepest place left out, and the sides of the rectangle that everything lies in.
_CERTAIN = 1e5
# A meter of unseen wall where the roof says that there is one, and of any wall on top, seen or not.
_EXPECTED, _ANY = 0.6, 0.05
# A corner, and on top one that isn't square to within this (cosine of the angle between its walls).
_CORNER_COST, _SKEW_COST, _SQUARE = 0.6, 1.5, np.sin(np.deg2rad(2.0))

# Sides of a roof may wiggle by so much (m).
_WIGGLE = 0.4

# Holes at the edge of a roof bite pieces out of its outline. Straight sides that may lie so many wiggles off go over
# them; wider ones are taken only where the first make no outline.
_OVER_BITES = (1.5, 2.0)

# Where the roof says that there is a wall, so many points that cover this share of it are enough to show where.
_FEW, _LEAST_COVERED = 5, 0.2

# A wall shows no farther (m) beyond the roof than noise makes it.
_FLUSH = 0.2

# A side of the roof runs like a wall within this angle (radians), and is its eave within the second one.
_LIKE, _EAVE_ANGLE = np.deg2rad(8.0), np.deg2rad(3.0)

# The eave of a wall lies within this distance (m) of where it is expected, and as expected within the second.
_EAVE, _AS_EXPECTED = 0.3, 0.15

# Corners are left out where an edge is judged: so much on both sides (m), no more than this share of a short edge.
_CORNER, _CORNER_SHARE = 0.4, 0.25

# Places times lines that are looked at at once.
_AT_ONCE = 10_000_000


@dataclass(frozen=True)
class WallEdge:
    """One edge of a footprint.

    Attributes
    ----------
    start, end : ndarray of shape (2,)
        Its corners, m.
    quality : float
        Share of it that has wall points, corners left out, 0 to 1.
    points : int
        Wall points on it.
    deviation : float
        Standard deviation of these across it, m; NaN without any.
    precision : float
        Standard deviation of its own place across, m; NaN without points.
    """

    start: np.ndarray
    end: np.ndarray
    quality: float
    points: int
    deviation: float
    precision: float


@dataclass(frozen=True)
class WallOutline:
    """Rings of edges, exterior first, and the overhang of the roof (m)."""

    rings: list[list[WallEdge]]
    overhang: float

    @property
    def seen(self) -> float:
        """Share of the outline that has wall points, 0 to 1."""
        return share_seen(self.rings)


def share_seen(rings: list[list[WallEdge]]) -> float:
    """Return the share of the length of rings that has wall points, 0 to 1."""
    edges = [edge for ring in rings for edge in ring]
    length = np.array([np.hypot(*(edge.end - edge.start)) for edge in edges])
    return float(np.sum(length * [edge.quality for edge in edges]) / length.sum())


@dataclass(frozen=True)
class Limits:
    """What walls may be like: distance (m) of points to their line, shortest wall and widest overhang (m)."""

    tolerance: float
    min_length: float
    max_overhang: float


class _Roof:
    """Where a roof is, in small cells, and how deep (m) under it a place lies, negative beyond its edge."""

    def __init__(self, roof: np.ndarray) -> None:
        self.cell = float(np.clip(np.sqrt(np.ptp(roof, axis=0).prod() / _MOST_CELLS), _CELL, _LARGEST_CELL))
        refuse_sparse(roof, self.cell)
        room = int(_ROOM / self.cell)
        self.low = roof.min(axis=0) - _ROOM - self.cell
        column, row = ((roof - self.low) / self.cell).astype(np.int64).T
        mask = np.zeros((row.max() + room + 2, column.max() + room + 2), bool)
        mask[row, column] = True
        self.mask = ndimage.binary_fill_holes(ndimage.binary_closing(mask, np.ones((3, 3), bool), iterations=2))
        inside, outside = ndimage.distance_transform_edt(self.mask), ndimage.distance_transform_edt(~self.mask)
        self.depth = np.where(self.mask, inside - 0.5, 0.5 - outside) * self.cell
        rows, columns = np.indices(mask.shape).reshape(2, -1)
        self.places = np.column_stack([columns, rows]) * self.cell + self.cell / 2 + self.low
        self.high = self.low + np.array(mask.shape[::-1]) * self.cell

    def depth_at(self, xy: np.ndarray) -> np.ndarray:
        column, row = np.floor((xy - self.low) / self.cell).astype(np.int64).T
        rows, columns = self.depth.shape
        return self.depth[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)]


def outline_walls(
    walls: np.ndarray,
    roof: np.ndarray,
    traced: list,
    spacing: float,
    limits: Limits,
    rng: np.random.Generator,
    monitor: Monitor,
) -> Optional[WallOutline]:
    """Return the outline of a building's walls, None where no wall is seen.

    Parameters
    ----------
    walls, roof : ndarray of shape (n, 2), (m, 2)
        Points of walls and of the roof in plan, near the origin (m).
    traced : list of ndarray
        Rings of the roof's outline.
    spacing : float
        Mean distance between the roof's points, m.
    limits : Limits
        What walls may be like.
    rng : Generator
        Random numbers.
    monitor : Monitor
        Receives progress.
    """
    perimeter = float(np.hypot(*np.diff(simplify_ring(traced[0], 0.5), axis=0).T).sum())
    scale = wall_scale(len(walls), perimeter, limits.tolerance)
    cover = _Roof(roof)
    seen = find_lines(walls, scale, limits.min_length, rng, monitor.part(0.0, 0.3))
    seen = [line for line in seen if np.median(cover.depth_at(walls[line.points])) > -_FLUSH]
    seen = square_up(merge_lines(seen, walls, scale), walls)
    if not seen:
        return None
    sides = _sides(traced, spacing)
    on_walls = np.concatenate([walls[line.points] for line in seen])
    to_roof = edge_distances(on_walls, *np.moveaxis(sides, 1, 0)).min(axis=1)
    overhang = float(np.clip(np.median(to_roof), 0.0, limits.max_overhang))
    seen = [_expectation(line, sides, overhang) for line in seen]
    sides = np.concatenate([sides, _bends(traced, sides, spacing)])
    lines = [*seen, *_from_roof(seen, sides, overhang, walls, scale)]
    near = [_near(walls, line, scale) for line in lines]
    case = _Case(cover, scale, limits, overhang)
    patches = _patches(lines, case, monitor.part(0.3, 0.4))
    rings = _Trial(lines, near, patches, case).simplified(monitor.part(0.4, 1.0)).edges()
    return WallOutline(rings, overhang) if rings else None


def _sides(traced: list, spacing: float) -> np.ndarray:
    """Return the sides of the roof (k, 2, 2) (m): start and end, the building to the left."""
    straight = (regularize_outline(traced, times * _WIGGLE, spacing / 2) for times in _OVER_BITES)
    rings = next((rings for rings in straight if rings), None) or [simplify_ring(ring, _WIGGLE) for ring in traced]
    return _edges_of(rings)


def _bends(traced: list, sides: np.ndarray, spacing: float) -> np.ndarray:
    """Return the edges (k, 2, 2) of the roof's exterior as it was seen where the straight ``sides`` go over it (m)."""
    ring = simplify_ring(traced[0], max(_WIGGLE, 2 * spacing))
    is_over = edge_distances(ring, *np.moveaxis(sides, 1, 0)).min(axis=1) > _WIGGLE
    return _edges_of([ring])[is_over[:-1] | is_over[1:]]


def _edges_of(rings: list) -> np.ndarray:
    """Return the edges (k, 2, 2) of closed rings."""
    return np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])


def _expectation(line: WallLine, sides: np.ndarray, overhang: float) -> WallLine:
    """Return a wall, marked as expected where it lies as a side of the roof says that it should."""
    expected = any(_is_eave_of(line, _expected(side, overhang, []), _AS_EXPECTED) for side in sides)
    return replace(line, expected=expected)


def _expected(side: np.ndarray, overhang: float, seen: list[WallLine]) -> WallLine:
    """Return the line, without points, where a wall below a side of the roof should be; it runs like those seen."""
    start, end = side
    direction = _like_walls((end - start) / np.hypot(*(end - start)), seen)
    middle = (start + end) / 2 + overhang * np.array([-direction[1], direction[0]])
    return WallLine(middle, direction, np.zeros(0, np.int64), np.zeros(0), np.nan, True)


def _like_walls(direction: np.ndarray, seen: list[WallLine]) -> np.ndarray:
    """Return the direction of the wall that is most nearly parallel or square to one, where that is near."""
    ways = [sign * way for line in seen for way in (line.direction, line.normal) for sign in (1, -1)]
    best = max(ways, key=lambda way: float(way @ direction), default=direction)
    return best if best @ direction > np.cos(_LIKE) else direction


def _is_eave_of(wall: WallLine, line: WallLine, within: float) -> bool:
    """Return whether a wall is the one that is expected on a ``line``, to ``within`` (m)."""
    parallel = abs(wall.direction @ line.direction) >= np.cos(_EAVE_ANGLE)
    return bool(parallel and abs(float(wall.across(line.point[None])[0])) <= within)


def _from_roof(
    seen: list[WallLine], sides: np.ndarray, overhang: float, walls: np.ndarray, scale: Scale
) -> list[WallLine]:
    """Return lines for sides of the roof without a known wall: through the few points there, or as expected."""
    lines: list[WallLine] = []
    length = np.hypot(*(sides[:, 1] - sides[:, 0]).T)
    # A long side meets more points than the rest of it beyond a notch, which would stand for it.
    for number in np.argsort(-length, kind="stable"):
        line = _expected(sides[number], overhang, seen)
        if not any(_is_eave_of(wall, line, _EAVE) for wall in [*seen, *lines]):
            lines.append(_through_few(line, float(length[number]) / 2, walls, scale))
    return lines


def _through_few(line: WallLine, half: float, walls: np.ndarray, scale: Scale) -> WallLine:
    """Return the line moved to the most points beside it, ``half`` (m) to both sides of its middle, if there are any.

    The direction is known, so that far fewer points tell a wall than without.
    """
    across, along = line.across(walls), (walls - line.point) @ line.direction
    beside = np.flatnonzero((np.abs(across) <= _EAVE) & (np.abs(along) <= half))
    if not len(beside):
        return line
    place, near = across[beside], scale.tolerance / 2
    ordered = np.sort(place)
    count = np.searchsorted(ordered, place + near, side="right") - np.searchsorted(ordered, place - near)
    best = beside[np.abs(place - place[np.argmax(count)]) <= near]
    if len(best) < _FEW or scale.covered(along[best], -half, half) < _LEAST_COVERED:
        return line
    moved = line.point + np.mean(across[best]) * line.normal
    return replace(line, point=moved, points=best, along=along[best], deviation=float(np.std(across[best])))


@dataclass(frozen=True)
class _Case:
    """What all outlines of one building are judged by: its roof, its scale, limits, and the overhang (m)."""

    cover: _Roof
    scale: Scale
    limits: Limits
    overhang: float


@dataclass(frozen=True)
class _Patches:
    """Pieces of the rectangle that no line parts: their sides of the lines (k, m), costs (k,) inside and outside."""

    is_left: np.ndarray
    if_inside: np.ndarray
    if_outside: np.ndarray

    def of(self, chosen: list[int]) -> _Patches:
        """Return the same with some of the lines."""
        return replace(self, is_left=self.is_left[:, chosen])

    def costs_in(self, cells: Arrangement) -> tuple[np.ndarray, np.ndarray]:
        """Return what each cell costs inside the outline, and outside, as far as the roof tells."""
        cell, count = cells.cells_at(self.is_left), len(cells.rings)
        known = cell >= 0
        if_inside, if_outside = (
            np.bincount(cell[known], cost[known], count) for cost in (self.if_inside, self.if_outside)
        )
        return if_inside, if_outside


def _patches(lines: list[WallLine], case: _Case, monitor: Monitor) -> _Patches:
    """Return what each patch between lines costs inside an outline and outside; its places are looked at only once."""
    places, depth = case.cover.places, case.cover.depth.ravel()
    points, directions = _points_and_directions(lines)
    size = max(1, _AT_ONCE // max(1, len(lines)))
    keys = np.zeros(len(places), np.int64)
    for start in range(0, len(places), size):
        keys[start : start + size] = keys_of(sides_of(places[start : start + size], points, directions))
        monitor.progress(start / len(places))
    _, first, patch = np.unique(keys, return_index=True, return_inverse=True)

    def area(chosen: np.ndarray) -> np.ndarray:
        return np.bincount(patch[chosen], minlength=len(first)) * case.cover.cell**2

    if_inside = _OUTSIDE * area(depth < -_BEYOND)
    if_outside = _INSIDE * area(depth > case.overhang + _WELL_INSIDE)
    if_outside += _DEEP * area(depth > min(case.limits.max_overhang, _DEEPER * depth.max()))
    # The deepest place is inside at any cost.
    if_outside[patch[np.argmax(depth)]] += _CERTAIN
    return _Patches(sides_of(places[first], points, directions), if_inside, if_outside)


def _points_and_directions(lines: list[WallLine]) -> tuple[np.ndarray, np.ndarray]:
    """Return a point on each line and its direction (m, 2)."""
    return np.array([line.point for line in lines]), np.array([line.direction for line in lines])


class _Trial:
    """The best outline that some lines can make, and what it costs."""

    def __init__(self, lines: list[WallLine], near: list[np.ndarray], patches: _Patches, case: _Case) -> None:
        self.lines, self.near, self.patches, self.case = lines, near, patches, case
        self.cells = Arrangement(*_points_and_directions(lines), case.cover.low, case.cover.high)
        cost = np.array([_cost(self.cells, edge, lines, near, case.scale) for edge in self.cells.edges])
        if_inside, if_outside = patches.costs_in(self.cells)
        inside = self.cells.cheapest(cost, if_inside, if_outside)
        line, left, right = (
            np.array([getattr(e, of) for e in self.cells.edges], int) for of in ("line", "left", "right")
        )
        cut = inside[left] != np.append(inside, False)[right]
        self.rings = self.cells.outline(inside)
        self.line_cost = np.bincount(line[cut], cost[cut], len(self.cells.points))
        self.total = float(self.line_cost.sum() + if_inside[inside].sum() + if_outside[~inside].sum() + self._corners())

    def _corners(self) -> float:
        """Return what the corners cost."""
        total = 0.0
        for ring in self.rings:
            for (line, _), (other, _) in zip(ring, [*ring[1:], ring[0]]):
                turn = abs(float(self.cells.directions[line] @ self.cells.directions[other]))
                total += _CORNER_COST + _SKEW_COST * (turn > _SQUARE)
        return total

    def simplified(self, monitor: Monitor) -> _Trial:
        """Return the cheapest outline found that some of the lines make."""
        best = first = self._descended(monitor.part(0.0, 0.5))
        # Going down can end at a chord over a corner, so what costs more than one is also left out from the start.
        doubtful = np.flatnonzero(first.line_cost[: len(first.lines)] > _CORNER_COST + _SKEW_COST)
        for done, number in enumerate(doubtful):
            part = monitor.part(0.5 + done / len(doubtful) / 2, 0.5 + (done + 1) / len(doubtful) / 2)
            rest = [i for i, line in enumerate(self.lines) if line is not first.lines[number]]
            if len(rest) > 3:
                best = min(best, self.only(rest)._descended(part), key=lambda trial: trial.total)
        return best

    def _descended(self, monitor: Monitor) -> _Trial:
        """Return the outline without the lines that are not worth their corners, the worst left out first."""
        best, used = self, sorted({line for ring in self.rings for line, _ in ring if line < len(self.lines)})
        if 0 < len(used) < len(self.lines):
            best = self.only(used)
        # What leaving out a line saved when it was last tried, and whether that was with this outline.
        saving, is_known = np.full(len(best.lines), np.inf), np.zeros(len(best.lines), bool)
        while len(best.lines) > 3 and (saving.max() > 0 or not is_known.all()):
            if saving.max() <= 0:
                saving[~is_known] = np.inf
            line = int(np.argmax(saving))
            monitor.progress(1 - len(best.lines) / len(self.lines))
            without = best.only([i for i in range(len(best.lines)) if i != line])
            if is_known[line]:
                best, saving = without, np.delete(saving, line)
                is_known = np.zeros(len(saving), bool)
            else:
                saving[line], is_known[line] = best.total - without.total, True
        return best

    def only(self, chosen: list[int]) -> _Trial:
        """Return the best outline of some of the lines."""
        lines, near = [self.lines[i] for i in chosen], [self.near[i] for i in chosen]
        return _Trial(lines, near, self.patches.of(chosen), self.case)

    def edges(self) -> list[list[WallEdge]]:
        """Return the rings of edges, exterior first."""
        rings = [
            [
                _edge(
                    self.cells.corner(here),
                    self.cells.corner(there),
                    self.lines[line],
                    self.near[line],
                    self.case.scale,
                )
                for (line, here), (_, there) in zip(ring, [*ring[1:], ring[0]])
            ]
            for ring in self.rings
            if len(ring) >= 3 and all(line < len(self.lines) for line, _ in ring)
        ]
        return sorted(rings, key=lambda ring: -signed_area(closed(ring)))


def closed(ring: list[WallEdge]) -> np.ndarray:
    """Return the corners of a ring, closed (m, 2)."""
    return np.array([edge.start for edge in ring] + [ring[0].start])


def _near(walls: np.ndarray, line: WallLine, scale: Scale) -> np.ndarray:
    """Return along and across (k, 2) of all wall points near a line (m)."""
    if not line.is_seen:
        return np.zeros((0, 2))
    across = line.across(walls)
    chosen = np.abs(across) <= scale.tolerance
    return np.column_stack([(walls[chosen] - line.point) @ line.direction, across[chosen]])


def _stretch(line: WallLine, start: np.ndarray, end: np.ndarray) -> tuple[float, float]:
    """Return where two places lie along a line (m), the lower first."""
    low, high = sorted([float((start - line.point) @ line.direction), float((end - line.point) @ line.direction)])
    return low, high


def _cost(cells: Arrangement, edge, lines: list[WallLine], near: list[np.ndarray], scale: Scale) -> float:
    """Return what an edge costs: its length as far as nothing is seen of it."""
    if edge.line >= len(lines):
        return _CERTAIN
    line = lines[edge.line]
    low, high = _stretch(line, cells.corner(edge.start), cells.corner(edge.end))
    if high - low <= 0:
        return 0.0
    missing = 1 - scale.covered(near[edge.line][:, 0], low, high)
    return (high - low) * (missing * (_EXPECTED if line.expected else 1.0) + _ANY)


def _edge(start: np.ndarray, end: np.ndarray, line: WallLine, near: np.ndarray, scale: Scale) -> WallEdge:
    """Return an edge with what the points between its corners say of it."""
    low, high = _stretch(line, start, end)
    corner = min(_CORNER, _CORNER_SHARE * (high - low))
    low, high = low + corner, high - corner
    between = near[(near[:, 0] >= low) & (near[:, 0] < high)]
    quality = scale.covered(between[:, 0], low, high) if len(between) else 0.0
    deviation = float(np.sqrt(np.mean(between[:, 1] ** 2))) if len(between) else np.nan
    precision = deviation / np.sqrt(len(between)) if len(between) else np.nan
    return WallEdge(start, end, quality, len(between), deviation, precision)
