"""The outline of one building's walls: which lines between its corners are real."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..footprints.regularization import regularize_outline
from ..geometry.arrangement import Arrangement, cheapest_cut, sides_of
from ..geometry.grid import refuse_sparse
from ..geometry.groups import components, members
from ..geometry.line_segments import are_inside, nearest_edge_distances
from ..geometry.polylines import simplify_ring
from ..geometry.rings import signed_area
from ..packages import ndimage
from ..stage import Monitor
from .wall_lines import Scale, WallLine, find_lines, merge_lines, square_up, wall_scale

# Side (m) of the cells in which a roof is compared with walls.
_CELL = 0.25

# Side (m) of the largest cells, which are taken where there would be more than the number that follows.
_LARGEST_CELL = 1.0

# Most cells of one building.
_MOST_CELLS = 5e5

# Width (m) of the margin around the roof in which walls are searched for.
_ROOM = 2.0

# The outline of least cost is taken. All costs are in meters of wall without points.

# Cost of a square meter of the outline without roof points.
_OUTSIDE = 5.0

# Distance (m) beyond the roof within which this costs nothing: noise and the uneven edge of the roof.
_BEYOND = 0.4

# Cost of a square meter of roof that is left out although it is farther from the edge than the overhang.
_INSIDE = 1.0

# Distance (m) from the edge, in addition to the overhang, up to which leaving roof out costs nothing.
_WELL_INSIDE = 0.3

# Additional cost of a square meter of roof left out farther from the edge than the largest overhang.
_DEEP = 2.0

# Distance from the edge from which this is due on small roofs (times that of the place farthest from the edge).
_DEEPER = 0.6

# A cost above that of any wall: of leaving out the place farthest from the edge, and of the surrounding rectangle.
_CERTAIN = 1e5

# Cost of a meter of wall without points where a side of the roof makes a wall likely.
_EXPECTED = 0.6

# Additional cost of a meter of any wall.
_ANY = 0.05

# Cost of a corner.
_CORNER_COST = 0.6

# Additional cost of a corner that is not square.
_SKEW_COST = 1.5

# Corners are square within 2°: the cosine of the angle between their walls is no more than this.
_SQUARE = np.sin(np.deg2rad(2.0))

# Tolerance (m) of the outline of a roof when its sides are made straight.
_WIGGLE = 0.4

# Larger tolerances (times the first) for roofs whose edges have bites from holes in the cloud; the larger one is used
# only where no outline comes of the smaller.
_OVER_BITES = (1.5, 2.0)

# Fewest points that show where a wall is, where a side of the roof makes it likely.
_FEW = 5

# Least share of the length of this wall that they cover.
_LEAST_COVERED = 0.2

# Largest distance (m) of a wall beyond the roof: that of noise.
_FLUSH = 0.2

# Largest angle (radians) between a side of the roof and walls that are seen, whose direction the side then takes.
_LIKE = np.deg2rad(8.0)

# Largest angle (radians) between a wall and its eave.
_EAVE_ANGLE = np.deg2rad(3.0)

# Largest distance (m) of the eave of a wall from where the overhang makes it likely.
_EAVE = 0.3

# Largest distance (m) at which it counts as lying right there.
_AS_EXPECTED = 0.15

# Length (m) at both ends of an edge that is left out where its quality is measured: corners are rounded.
_CORNER = 0.4

# The same as a share of a short edge.
_CORNER_SHARE = 0.25

# Largest distance (m) from the edges of a line within which leaving it out changes the outline: bumps and notches that
# are worth a line are no deeper, as each square meter of them costs as much as a meter of wall.
_NEARBY = 4.0

# Most places times lines that are compared at once.
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
    """The outline of one building's walls.

    Attributes
    ----------
    rings : list of list of WallEdge
        Edges in order, exteriors first.
    overhang : float
        Overhang of the roof, m.
    lines : list of WallLine
        All lines that the outline could have been made of.
    scale : Scale
        Tolerance and bins of this building's walls.
    low, high : ndarray of shape (2,)
        Corners of the rectangle that holds the roof and the room around it, m.
    """

    rings: list[list[WallEdge]]
    overhang: float
    lines: list[WallLine]
    scale: Scale
    low: np.ndarray
    high: np.ndarray

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

    def __init__(self, roof: np.ndarray, courtyards: list) -> None:
        self.cell = float(np.clip(np.sqrt(np.ptp(roof, axis=0).prod() / _MOST_CELLS), _CELL, _LARGEST_CELL))
        refuse_sparse(roof, self.cell)
        room = int(_ROOM / self.cell)
        self.low = roof.min(axis=0) - _ROOM - self.cell
        column, row = ((roof - self.low) / self.cell).astype(np.int64).T
        mask = np.zeros((row.max() + room + 2, column.max() + room + 2), bool)
        mask[row, column] = True
        rows, columns = np.indices(mask.shape).reshape(2, -1)
        self.places = np.column_stack([columns, rows]) * self.cell + self.cell / 2 + self.low
        self.mask = ndimage.binary_fill_holes(ndimage.binary_closing(mask, np.ones((3, 3), bool), iterations=2))
        for ring in courtyards:
            self.mask &= ~are_inside(self.places, ring).reshape(mask.shape) | mask
        inside, outside = ndimage.distance_transform_edt(self.mask), ndimage.distance_transform_edt(~self.mask)
        self.depth = np.where(self.mask, inside - 0.5, 0.5 - outside) * self.cell
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
    is_party: Callable[[np.ndarray], np.ndarray],
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
    is_party : callable
        Returns beside which sides (k, 2, 2) of the roof another roof begins: no eave juts out there.
    rng : Generator
        Random numbers.
    monitor : Monitor
        Receives progress.
    """
    perimeter = float(np.hypot(*np.diff(simplify_ring(traced[0], 0.5), axis=0).T).sum())
    scale = wall_scale(len(walls), perimeter, limits.tolerance)
    cover = _Roof(roof, traced[1:])
    seen = find_lines(walls, scale, limits.min_length, rng, monitor.part(0.0, 0.3))
    seen = [line for line in seen if np.median(cover.depth_at(walls[line.points])) > -_FLUSH]
    seen = square_up(merge_lines(seen, walls, scale), walls)
    if not seen:
        return None
    sides = _sides(traced, spacing)
    on_walls = np.concatenate([walls[line.points] for line in seen])
    to_roof = nearest_edge_distances(on_walls, *np.moveaxis(sides, 1, 0))
    overhang = float(np.clip(np.median(to_roof), 0.0, limits.max_overhang))
    straight, sides = len(sides), np.concatenate([sides, _bends(traced, sides, spacing)])
    overhangs = np.where(is_party(sides), 0.0, overhang)
    seen = [_expectation(line, sides[:straight], overhangs[:straight]) for line in seen]
    lines = [*seen, *_from_roof(seen, sides, overhangs, walls, scale)]
    near = [_near(walls, line, scale) for line in lines]
    case = _Case(cover, scale, limits, overhang)
    cells = _Cells(lines, near, case, monitor.part(0.3, 0.4))
    rings = cells.rings(_Simplification(cells).run(monitor.part(0.4, 1.0)))
    return WallOutline(rings, overhang, lines, scale, cover.low, cover.high) if rings else None


def outline_roof(roof: np.ndarray, traced: list, spacing: float, limits: Limits, monitor: Monitor) -> list:
    """Return the outline of a roof as rings of edges of which nothing was seen, made as those of walls are.

    The parameters are those of :func:`outline_walls`. Bites out of the edge of the roof are left out where they cost
    more corners than they are worth.
    """
    sides, nothing, scale = _sides(traced, spacing), np.zeros((0, 2)), Scale(limits.tolerance, 1.0)
    sides = np.concatenate([sides, _bends(traced, sides, spacing)])
    lines = _from_roof([], sides, np.zeros(len(sides)), nothing, scale)
    case = _Case(_Roof(roof, traced[1:]), scale, limits, 0.0)
    cells = _Cells(lines, [nothing] * len(lines), case, monitor.part(0.0, 0.5))
    return cells.rings(_Simplification(cells).run(monitor.part(0.5, 1.0)))


def _sides(traced: list, spacing: float) -> np.ndarray:
    """Return the sides of the roof (k, 2, 2) (m): start and end, the building to the left."""
    straight = (regularize_outline(traced, times * _WIGGLE, spacing / 2) for times in _OVER_BITES)
    rings = next((rings for rings in straight if rings), None) or [simplify_ring(ring, _WIGGLE) for ring in traced]
    return _edges_of(rings)


def _bends(traced: list, sides: np.ndarray, spacing: float) -> np.ndarray:
    """Return the edges (k, 2, 2) of the roof's exterior as it was seen where the straight ``sides`` go over it (m)."""
    ring = simplify_ring(traced[0], max(_WIGGLE, 2 * spacing))
    is_over = nearest_edge_distances(ring, *np.moveaxis(sides, 1, 0)) > _WIGGLE
    return _edges_of([ring])[is_over[:-1] | is_over[1:]]


def _edges_of(rings: list) -> np.ndarray:
    """Return the edges (k, 2, 2) of closed rings."""
    return np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])


def _expectation(line: WallLine, sides: np.ndarray, overhangs: np.ndarray) -> WallLine:
    """Return a wall, marked as expected where it lies as a side of the roof says that it should."""
    walls = (_expected(side, overhang, []) for side, overhang in zip(sides, overhangs))
    return replace(line, expected=any(_is_eave_of(line, wall, _AS_EXPECTED) for wall in walls))


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
    seen: list[WallLine], sides: np.ndarray, overhangs: np.ndarray, walls: np.ndarray, scale: Scale
) -> list[WallLine]:
    """Return lines for sides of the roof without a known wall: through the few points there, or as expected."""
    lines: list[WallLine] = []
    length = np.hypot(*(sides[:, 1] - sides[:, 0]).T)
    # A long side meets more points than the rest of it beyond a notch, which would stand for it.
    for number in np.argsort(-length, kind="stable"):
        line = _expected(sides[number], float(overhangs[number]), seen)
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


class _Cells:
    """The cells that all lines of a building make, and what an outline of some of them costs.

    An outline is told by which cells are ``inside`` (cells,), and the lines it may run along by which are ``open``
    (lines,). All costs are sums over cells, edges and crossings, so that what a change costs is told by those near it.
    """

    def __init__(self, lines: list[WallLine], near: list[np.ndarray], case: _Case, monitor: Monitor) -> None:
        self.lines, self.near, self.case = lines, near, case
        self._groups: Optional[tuple] = None
        points, directions = (np.array([getattr(line, of) for line in lines]) for of in ("point", "direction"))
        self.cells = Arrangement(points, directions, case.cover.low, case.cover.high)
        self.edges = self.cells.edges
        self.cost = _edge_costs(self.cells, lines, near, case.scale)
        self.if_inside, self.if_outside = _cell_costs(self.cells, case, monitor)
        u, v = (self.cells.directions[self.cells.crossing[:, i]] for i in (0, 1))
        self.corner_cost = _CORNER_COST + _SKEW_COST * (np.abs(np.einsum("ij,ij->i", u, v)) > _SQUARE)

    def is_cut(self, inside: np.ndarray) -> np.ndarray:
        """Return which edges (e,) an outline runs along."""
        return inside[self.edges.left] != inside[self.edges.right]

    def total(self, inside: np.ndarray) -> float:
        """Return what an outline costs."""
        area = self.if_inside[inside].sum() + self.if_outside[~inside].sum()
        return float(self.cost[self.is_cut(inside)].sum() + area + self._corners(inside) @ self.corner_cost)

    def _corners(self, inside: np.ndarray) -> np.ndarray:
        """Return how many corners (crossings,) an outline has at each crossing."""
        left_before, right_before, left_after, right_after = inside[self.cells.around].T
        before, after = left_before != right_before, left_after != right_after
        is_touched_twice = before & after & (left_before != left_after)
        return np.where(is_touched_twice, 2, before != after)

    def line_costs(self, inside: np.ndarray) -> np.ndarray:
        """Return what the edges of an outline cost on each line (lines,)."""
        cut = self.is_cut(inside)
        return np.bincount(self.edges.line[cut], self.cost[cut], len(self.lines))

    def is_used(self, inside: np.ndarray) -> np.ndarray:
        """Return which lines (lines,) an outline runs along."""
        return np.bincount(self.edges.line[self.is_cut(inside)], minlength=len(self.lines)) > 0

    def boxes(self, edges: np.ndarray, room: float = 0.0) -> np.ndarray:
        """Return the boxes (k, 4) around edges, with room (m): least x and y, largest x and y."""
        ends = np.stack([self.cells.places[self.edges.start[edges]], self.cells.places[self.edges.end[edges]]])
        return np.column_stack([ends.min(axis=0) - room, ends.max(axis=0) + room])

    def cheapest(self, is_open: np.ndarray) -> np.ndarray:
        """Return the cells of the cheapest outline along ``is_open`` lines, but for its corners."""
        return self.improved(np.zeros(self.cells.count, bool), is_open)

    def improved(
        self, inside: np.ndarray, is_open: np.ndarray, boxes: Optional[np.ndarray] = None, without: int = -1
    ) -> np.ndarray:
        """Return an outline, chosen anew where cells reach into boxes (k, 4), or everywhere.

        It runs along lines that are open, but not ``without`` one of them.
        """
        count, group, edges = self._joined(is_open)
        is_free = np.ones(count, bool) if boxes is None else self._reaching(boxes, group, count)
        was_inside = np.zeros(count, bool)
        was_inside[group] = inside
        left, right = group[self.edges.left[edges]], group[self.edges.right[edges]]
        some = np.flatnonzero(is_free[left] | is_free[right])
        left, right, edges = left[some], right[some], edges[some]
        cost = np.where(self.edges.line[edges] == without, _CERTAIN, self.cost[edges])
        if_inside, if_outside = (np.bincount(group, costs, count) for costs in (self.if_inside, self.if_outside))
        for one, other in ((left, right), (right, left)):
            held_in, held_out = (~is_free[other] & (was_inside[other] == held) for held in (True, False))
            if_outside += np.bincount(one[held_in], cost[held_in], count)
            if_inside += np.bincount(one[held_out], cost[held_out], count)
        both, number = is_free[left] & is_free[right], np.cumsum(is_free) - 1
        chosen = was_inside.copy()
        chosen[is_free] = cheapest_cut(
            number[left[both]], number[right[both]], cost[both], if_inside[is_free], if_outside[is_free]
        )
        return chosen[group]

    def _joined(self, is_open: np.ndarray) -> tuple[int, np.ndarray, np.ndarray]:
        """Return how many groups of cells open lines leave, the group of each cell, and the edges between groups."""
        # Many trials follow each other with the same lines.
        if self._groups is None or not np.array_equal(self._groups[0], is_open):
            left, right, is_between = self.edges.left, self.edges.right, is_open[self.edges.line]
            count, group = components(left[~is_between], right[~is_between], self.cells.count)
            self._groups = is_open.copy(), (count, group, np.flatnonzero(group[left] != group[right]))
        return self._groups[1]

    def _reaching(self, boxes: np.ndarray, group: np.ndarray, count: int) -> np.ndarray:
        """Return which groups (count,) of cells have a corner in one of the boxes."""
        x, y = self.cells.places[: len(self.cells.crossing)].T
        is_in = np.zeros(len(x), bool)
        for low_x, low_y, high_x, high_y in boxes.tolist():
            is_in |= (x > low_x) & (x < high_x) & (y > low_y) & (y < high_y)
        is_free = np.zeros(count, bool)
        is_free[group[self.cells.around[is_in].ravel()]] = True
        return is_free

    def rings(self, inside: np.ndarray) -> list[list[WallEdge]]:
        """Return the rings of edges of an outline, exterior first."""
        places = self.cells.places
        rings = [
            [
                _edge(places[here], places[there], self.lines[line], self.near[line], self.case.scale)
                for (line, here), (_, there) in zip(ring, [*ring[1:], ring[0]])
            ]
            for ring in self.cells.outline(inside)
            if len(ring) >= 3
        ]
        return sorted(rings, key=lambda ring: -signed_area(closed(ring)))


def _edge_costs(cells: Arrangement, lines: list[WallLine], near: list[np.ndarray], scale: Scale) -> np.ndarray:
    """Return what edges (e,) cost: their length as far as nothing is seen of it."""
    edges, seen = cells.edges, np.zeros(len(cells.edges.line))
    for number, own in members(edges.line + 1).items():
        along = near[number - 1][:, 0]
        seen[own] = scale.seen_until(along, edges.high[own]) - scale.seen_until(along, edges.low[own])
    weight = np.array([_EXPECTED if line.expected else 1.0 for line in lines])
    length = edges.high - edges.low
    return weight[edges.line] * np.maximum(length - seen, 0.0) + _ANY * length


def _cell_costs(cells: Arrangement, case: _Case, monitor: Monitor) -> tuple[np.ndarray, np.ndarray]:
    """Return what each cell (cells,) costs inside an outline and outside, as far as the roof tells."""
    places, depth = case.cover.places, case.cover.depth.ravel()
    size = max(1, _AT_ONCE // max(1, len(cells.points)))
    cell = np.empty(len(places), np.int64)
    for start in range(0, len(places), size):
        part = slice(start, start + size)
        cell[part] = cells.cells_at(sides_of(places[part], cells.points, cells.directions))
        monitor.progress(start / len(places))

    def area(chosen: np.ndarray) -> np.ndarray:
        return np.bincount(cell[chosen & (cell >= 0)], minlength=cells.count) * case.cover.cell**2

    if_inside = _OUTSIDE * area(depth < -_BEYOND) + _CERTAIN * cells.is_border
    if_outside = _INSIDE * area(depth > case.overhang + _WELL_INSIDE)
    if_outside += _DEEP * area(depth > min(case.limits.max_overhang, _DEEPER * depth.max()))
    # The deepest place is inside at any cost.
    if_outside[cell[np.argmax(depth)]] += _CERTAIN
    return if_inside, if_outside


class _Simplification:
    """The cheapest outline of some cells, made cheaper line by line.

    Leaving out a line changes the outline near its edges only: that part is chosen anew, and only lines near
    a change are tried again.
    """

    def __init__(self, cells: _Cells) -> None:
        self.cells = cells
        self.inside = cells.cheapest(np.ones(len(cells.lines), bool))
        self.is_open = cells.is_used(self.inside)
        self.total = cells.total(self.inside)

    def run(self, monitor: Monitor) -> np.ndarray:
        """Return the cells (cells,), bool, of the cheapest outline found."""
        # Going down can end at a chord over a corner, so what costs more than one is also left out from the start.
        doubtful = np.flatnonzero(self.cells.line_costs(self.inside) > _CORNER_COST + _SKEW_COST)
        self._descend(self.is_open, monitor.part(0.0, 0.5))
        for done, line in enumerate(doubtful.tolist()):
            self._restart_without(
                line, monitor.part(0.5 + done / len(doubtful) / 2, 0.5 + (done + 1) / len(doubtful) / 2)
            )
        return self.inside

    def _descend(self, is_tried: np.ndarray, monitor: Monitor) -> None:
        """Leave out the lines that aren't worth their corners, of those ``is_tried`` (lines,), the worst first."""
        # What leaving out a line saved when it was last tried, and whether nothing has changed near it since.
        saving = np.where(is_tried & self.is_open, np.inf, -np.inf)
        is_known = np.isneginf(saving)
        latest = -1
        while self.is_open.sum() > 3 and (saving.max() > 0 or not is_known.all()):
            if saving.max() <= 0:
                saving[~is_known] = np.inf
            line = int(np.argmax(saving))
            if line != latest:
                inside, latest = self._without(line), line
                total = self.cells.total(inside)
            if is_known[line] and total < self.total:
                near = self._near(self.inside, inside) & self.is_open
                self.inside, self.total, self.is_open[line] = inside, total, False
                saving[near & np.isneginf(saving)] = np.inf
                saving[line], is_known[near], is_known[line], latest = -np.inf, False, True, -1
            else:
                saving[line], is_known[line] = self.total - total, True
            monitor.progress(1 - self.is_open.mean())

    def _without(self, line: int) -> np.ndarray:
        """Return the outline with what runs along a line chosen anew."""
        own = np.flatnonzero((self.cells.edges.line == line) & self.cells.is_cut(self.inside))
        if not len(own):
            return self.inside
        return self.cells.improved(self.inside, self.is_open, self.cells.boxes(own, _NEARBY), line)

    def _near(self, before: np.ndarray, after: np.ndarray) -> np.ndarray:
        """Return which lines (lines,) have edges near those that two outlines have not in common."""
        was_cut, is_cut = self.cells.is_cut(before), self.cells.is_cut(after)
        changed, edges = self.cells.boxes(np.flatnonzero(was_cut != is_cut), _NEARBY), np.flatnonzero(is_cut)
        own, meets = self.cells.boxes(edges), np.zeros(len(edges), bool)
        for low_x, low_y, high_x, high_y in changed.tolist():
            meets |= (own[:, 2] > low_x) & (own[:, 0] < high_x) & (own[:, 3] > low_y) & (own[:, 1] < high_y)
        return np.bincount(self.cells.edges.line[edges[meets]], minlength=len(self.is_open)) > 0

    def _restart_without(self, line: int, monitor: Monitor) -> None:
        """Choose what runs along a line from all others, simplify that, and keep it if it is cheaper."""
        best = self.inside, self.is_open, self.total
        own = np.flatnonzero((self.cells.edges.line == line) & self.cells.is_cut(self.inside))
        if not len(own):
            return
        everything = np.ones(len(self.is_open), bool)
        self.inside = self.cells.improved(best[0], everything, self.cells.boxes(own, _NEARBY), line)
        self.is_open, self.total = best[1] | self.cells.is_used(self.inside), self.cells.total(self.inside)
        self.is_open[line] = False
        self._descend(self._near(best[0], self.inside), monitor)
        if self.total >= best[2]:
            self.inside, self.is_open, self.total = best


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
