"""The outline of one building's walls: the cheapest in the cells cut by all of its lines, simplified line by line.

The unit of all costs is a meter of wall without points.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..criteria import PARALLEL
from ..geometry.arrangement import Arrangement, sides_of
from ..geometry.cheapest_labels import cheapest_cut
from ..geometry.groups import components, members
from ..geometry.rings import nearest_edge_distances, perimeter, signed_area
from ..stage import Monitor
from ..threads import PAIRS_AT_ONCE
from .roof_outline import RoofCover, RoofOutline
from .wall_edges import WallEdge, closed, edge_between, points_near
from .wall_lines import MOST, SAME_WALL, Scale, WallLine, find_lines, merge_lines, square_up, wall_scale

# The few points that locate a wall below a side of the roof cover at least this share of its length.
_LEAST_COVERED = 0.2

# Cost of a square meter of the outline without roof points.
_OUTSIDE = 5.0

# Cost of a square meter of roof that is left out although it is farther from the edge than the overhang.
_INSIDE = 1.0

# More than any wall costs: for leaving out the deepest position, or including the rim.
_CERTAIN = 1e5

# Cost of a meter of wall without points where a side of the roof makes a wall likely.
_EXPECTED = 0.6

# Additional cost of a meter of any wall.
_ANY = 0.05

# Cost of a corner, and additional cost of one that is not square within 2°: few houses have such corners.
_CORNER_COST, _SKEW_COST = 0.6, 1.5


class OutlineCells:
    """The cells that all lines of a building make, and the cost of an outline of some of them.

    An outline is given by the cells that are ``inside`` (cells,). Its cost is a sum over cells, edges and crossings.
    The ``overhang`` is the distance (m) by which the roof juts out over the ``walls`` (n, 2).
    """

    def __init__(
        self, lines: list[WallLine], walls: np.ndarray, cover: RoofCover, scale: Scale, overhang: float
    ) -> None:
        self.lines, self.scale = lines, scale
        self.near = [points_near(walls, line, scale) for line in lines]
        points, directions = (np.array([getattr(line, name) for line in lines]) for name in ("point", "direction"))
        self.arrangement = Arrangement(points, directions, cover.low, cover.high)
        self.edges = self.arrangement.edges
        self.cost = _edge_costs(self.arrangement, lines, self.near, scale)
        self.if_inside, self.if_outside = _cell_costs(self.arrangement, cover, overhang)
        u, v = (directions[self.arrangement.crossing[:, i]] for i in (0, 1))
        is_skew = np.abs(np.einsum("ij,ij->i", u, v)) > np.sin(np.deg2rad(2.0))
        self.corner_cost = _CORNER_COST + _SKEW_COST * is_skew

    def is_cut(self, inside: np.ndarray) -> np.ndarray:
        """Return the mask of edges (e,) along which an outline runs."""
        return inside[self.edges.left] != inside[self.edges.right]

    def total(self, inside: np.ndarray) -> float:
        """Return the cost of an outline."""
        area = self.if_inside[inside].sum() + self.if_outside[~inside].sum()
        return float(self.cost[self.is_cut(inside)].sum() + area + self.corners(inside) @ self.corner_cost)

    def corners(self, inside: np.ndarray) -> np.ndarray:
        """Return the number of corners (crossings,) of an outline at each crossing."""
        left_before, right_before, left_after, right_after = inside[self.arrangement.around].T
        before, after = left_before != right_before, left_after != right_after
        is_touched_twice = before & after & (left_before != left_after)
        return np.where(is_touched_twice, 2, before != after)

    def is_used(self, inside: np.ndarray) -> np.ndarray:
        """Return the mask of lines (lines,) along which an outline runs."""
        return np.bincount(self.edges.line[self.is_cut(inside)], minlength=len(self.lines)) > 0

    def cheapest(self, is_open: np.ndarray) -> np.ndarray:
        """Return the cheapest outline along open lines (lines,), bool; corners cost nothing."""
        left, right, is_between = self.edges.left, self.edges.right, is_open[self.edges.line]
        count, group = components(left[~is_between], right[~is_between], self.arrangement.count)
        own = np.flatnonzero(group[left] != group[right])
        if_inside, if_outside = (np.bincount(group, cost, count) for cost in (self.if_inside, self.if_outside))
        return cheapest_cut(group[left[own]], group[right[own]], self.cost[own], if_inside, if_outside)[group]

    def rings(self, inside: np.ndarray) -> list[list[WallEdge]]:
        """Return the rings of edges of an outline, exterior first."""
        positions = self.arrangement.positions
        rings = [
            [
                edge_between(positions[start], positions[end], self.lines[line], self.near[line], self.scale)
                for (line, start), (_, end) in zip(ring, [*ring[1:], ring[0]])
            ]
            for ring in self.arrangement.outline(inside)
            if len(ring) >= 3
        ]
        return sorted(rings, key=lambda ring: -signed_area(closed(ring)))


def _edge_costs(cells: Arrangement, lines: list[WallLine], near: list[np.ndarray], scale: Scale) -> np.ndarray:
    """Return the costs of edges (e,): their unseen length."""
    edges, seen = cells.edges, np.zeros(len(cells.edges.line))
    for number, own in members(edges.line + 1).items():
        along = near[number - 1][:, 0]
        seen[own] = scale.seen_until(along, edges.high[own]) - scale.seen_until(along, edges.low[own])
    weight = np.array([_EXPECTED if line.expected else 1.0 for line in lines])
    length = edges.high - edges.low
    return weight[edges.line] * np.maximum(length - seen, 0.0) + _ANY * length


def _cell_costs(cells: Arrangement, cover: RoofCover, overhang: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the cost of each cell (cells,) inside an outline and outside, by the roof."""
    positions, depth = cover.positions, cover.depth
    size = max(1, PAIRS_AT_ONCE // max(1, len(cells.points)))
    parts = [positions[start : start + size] for start in range(0, len(positions), size)]
    cell = np.concatenate([cells.cells_at(sides_of(part, cells.points, cells.directions)) for part in parts])

    def area(chosen: np.ndarray) -> np.ndarray:
        return np.bincount(cell[chosen & (cell >= 0)], minlength=cells.count) * cover.cell**2

    if_inside = _OUTSIDE * area(depth < -SAME_WALL) + _CERTAIN * cells.is_border
    if_outside = _INSIDE * area(depth > overhang)
    # The deepest position is inside at any cost.
    if_outside[cell[np.argmax(depth)]] += _CERTAIN
    return if_inside, if_outside


def simplified(cells: OutlineCells, monitor: Monitor) -> np.ndarray:
    """Return the cheapest outline (cells,), bool, without the lines that aren't worth their corners.

    The line that saves most is removed first. Savings are measured again before, as they change with the lines left.
    """
    inside = cells.cheapest(np.ones(len(cells.lines), bool))
    is_open, total = cells.is_used(inside), cells.total(inside)
    # What leaving out a line saved when it was last tried, and whether none was left out since.
    saving, is_known = np.where(is_open, np.inf, -np.inf), ~is_open
    while is_open.sum() > 3 and (saving.max() > 0 or not is_known.all()):
        if saving.max() <= 0:
            saving[~is_known] = np.inf
        line = int(np.argmax(saving))
        is_open[line], saving[line] = False, -np.inf
        trial = cells.cheapest(is_open)
        cost = cells.total(trial)
        if cost < total and total - cost >= saving.max():
            inside, total, is_known = trial, cost, ~is_open
        else:
            is_open[line], saving[line], is_known[line] = True, total - cost, True
        monitor.progress(1 - is_open.mean())
    return inside


@dataclass(frozen=True)
class Limits:
    """What walls and footprints may be like."""

    tolerance: float  #: Distance of points from their line, m
    min_length: float  #: Shortest wall, m
    max_overhang: float  #: Widest overhang of a roof, m
    min_area: float  #: Smallest footprint, m²
    min_seen: float  #: Least share of the perimeter with wall points
    seed: int  #: Start of the random numbers


@dataclass(frozen=True)
class WallOutline:
    """The outline of one building's walls."""

    rings: list[list[WallEdge]]  #: Edges in order, exteriors first
    overhang: float  #: Overhang of the roof, m
    cells: OutlineCells  #: The cells that it could have been made of
    inside: np.ndarray  #: (cells,), bool: those that it was made of


def share_seen(rings: list[list[WallEdge]]) -> float:
    """Return the share of the length of rings that has wall points, 0 to 1."""
    edges = [edge for ring in rings for edge in ring]
    length = np.array([np.hypot(*(edge.end - edge.start)) for edge in edges])
    return float(np.sum(length * [edge.quality for edge in edges]) / length.sum())


def outline_walls(
    walls: np.ndarray, roof: RoofOutline, limits: Limits, is_party: Callable[[np.ndarray], np.ndarray], monitor: Monitor
) -> Optional[WallOutline]:
    """Return the outline of a building's walls, None if no wall is seen.

    Parameters
    ----------
    walls : ndarray of shape (n, 2)
        Points of walls in plan, near the origin (m).
    roof : RoofOutline
        The roof's outline.
    limits : Limits
        What walls and footprints may be like.
    is_party : callable
        Returns the mask of the sides (k, 2, 2) of the roof next to which another roof begins: no eave juts out there.
    monitor : Monitor
        Receives progress.
    """
    scale = wall_scale(len(walls), perimeter(roof.parts[0][0]), limits.tolerance)
    cover = RoofCover([ring for rings in roof.parts for ring in rings])
    seen = find_lines(walls, scale, limits.min_length, np.random.default_rng(limits.seed), monitor.part(0.0, 0.3))
    seen = square_up(merge_lines(seen, walls, scale), walls)
    # Where no wall is seen, the sides are not drawn.
    if not seen or not len(roof.sides):
        return None
    sides = roof.sides
    on_walls = np.concatenate([walls[line.points] for line in seen])
    to_roof = nearest_edge_distances(on_walls, *np.moveaxis(sides, 1, 0))
    overhang = float(np.clip(np.median(to_roof), 0.0, limits.max_overhang))
    overhangs = np.where(is_party(sides), 0.0, overhang)
    seen = [_expectation(line, sides, overhangs) for line in seen]
    cells = OutlineCells([*seen, *_from_roof(seen, sides, overhangs, walls, scale)], walls, cover, scale, overhang)
    inside = simplified(cells, monitor.part(0.4, 1.0))
    rings = cells.rings(inside)
    return WallOutline(rings, overhang, cells, inside) if rings else None


def _expectation(line: WallLine, sides: np.ndarray, overhangs: np.ndarray) -> WallLine:
    """Return a wall, marked as expected where it lies as a side of the roof says that it should."""
    walls = (_expected(side, overhang, []) for side, overhang in zip(sides, overhangs))
    return replace(line, expected=any(_is_eave_of(line, wall) for wall in walls))


def _expected(side: np.ndarray, overhang: float, seen: list[WallLine]) -> WallLine:
    """Return the line, without points, where a wall below a side of the roof should be; it runs like those seen."""
    start, end = side
    direction = _like_walls((end - start) / np.hypot(*(end - start)), seen)
    middle = (start + end) / 2 + overhang * np.array([-direction[1], direction[0]])
    return WallLine(middle, direction, np.zeros(0, np.int64), np.zeros(0), np.nan, True)


def _like_walls(direction: np.ndarray, seen: list[WallLine]) -> np.ndarray:
    """Return the direction of the wall that is most nearly parallel or square to one, where that is within ``MOST``."""
    ways = [sign * way for line in seen for way in (line.direction, line.normal) for sign in (1, -1)]
    best = max(ways, key=lambda way: float(way @ direction), default=direction)
    return best if best @ direction > np.cos(MOST) else direction


def _is_eave_of(wall: WallLine, line: WallLine) -> bool:
    """Return whether a wall is the one that is expected on a ``line``."""
    is_parallel = abs(wall.normal @ line.direction) < PARALLEL
    return bool(is_parallel and abs(float(wall.across(line.point[None])[0])) <= SAME_WALL)


def _from_roof(
    seen: list[WallLine], sides: np.ndarray, overhangs: np.ndarray, walls: np.ndarray, scale: Scale
) -> list[WallLine]:
    """Return lines for sides of the roof without a known wall: through the few points there, or as expected."""
    lines: list[WallLine] = []
    length = np.hypot(*(sides[:, 1] - sides[:, 0]).T)
    # Try long sides first: the remainder of a side beyond a notch has fewer points and would pass for the whole side.
    for number in np.argsort(-length, kind="stable"):
        line = _expected(sides[number], float(overhangs[number]), seen)
        if not any(_is_eave_of(wall, line) for wall in [*seen, *lines]):
            lines.append(_through_few(line, float(length[number]) / 2, walls, scale))
    return lines


def _through_few(line: WallLine, half: float, walls: np.ndarray, scale: Scale) -> WallLine:
    """Return the line moved to the most points next to it, ``half`` (m) to both sides of its middle, if there are any.

    With a known direction, far fewer points determine a wall.
    """
    across, along = line.across(walls), (walls - line.point) @ line.direction
    beside = np.flatnonzero((np.abs(across) <= SAME_WALL) & (np.abs(along) <= half))
    if not len(beside):
        return line
    position, near = across[beside], scale.tolerance / 2
    ordered = np.sort(position)
    count = np.searchsorted(ordered, position + near, side="right") - np.searchsorted(ordered, position - near)
    best = beside[np.abs(position - position[np.argmax(count)]) <= near]
    if scale.covered(along[best], -half, half) < _LEAST_COVERED:
        return line
    moved = line.point + np.mean(across[best]) * line.normal
    return replace(line, point=moved, points=best, along=along[best], deviation=float(np.std(across[best])))
