"""The cheapest outline of a building's walls among the cells that all of its lines make, made simpler line by line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.arrangement import Arrangement, sides_of
from ..geometry.cheapest_labels import cheapest_cut
from ..geometry.groups import components, members
from ..geometry.rings import signed_area
from ..stage import Monitor
from .roof_cover import RoofCover
from .wall_edges import WallEdge, closed, edge_between
from .wall_lines import Scale, WallLine

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

# Distance from the edge from which this is due on small roofs (times that of the position farthest from the edge).
_DEEPER = 0.6

# A cost above that of any wall: of leaving out the position farthest from the edge, and of the surrounding rectangle.
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

# Largest distance (m) from the edges of a line within which leaving it out changes the outline. Bumps and notches that
# are worth a line are no deeper, as each square meter of them costs as much as a meter of wall.
_NEARBY = 4.0

# Most positions times lines that are compared at once.
_AT_ONCE = 10_000_000


@dataclass(frozen=True)
class Limits:
    """What walls may be like: distance (m) of points to their line, shortest wall and widest overhang (m)."""

    tolerance: float
    min_length: float
    max_overhang: float


@dataclass(frozen=True)
class OutlineCase:
    """Data by which all outlines of one building are judged: its roof, its scale, limits, and the overhang (m)."""

    cover: RoofCover
    scale: Scale
    limits: Limits
    overhang: float


class OutlineCells:
    """The cells that all lines of a building make, and the cost of an outline of some of them.

    An outline is given by the cells that are ``inside`` (cells,), and the lines it may run along by which are ``open``
    (lines,). All costs are sums over cells, edges and crossings, so that those near a change give its cost.
    """

    def __init__(self, lines: list[WallLine], near: list[np.ndarray], case: OutlineCase, monitor: Monitor) -> None:
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
        """Return the cost of an outline."""
        area = self.if_inside[inside].sum() + self.if_outside[~inside].sum()
        return float(self.cost[self.is_cut(inside)].sum() + area + self._corners(inside) @ self.corner_cost)

    def _corners(self, inside: np.ndarray) -> np.ndarray:
        """Return how many corners (crossings,) an outline has at each crossing."""
        left_before, right_before, left_after, right_after = inside[self.cells.around].T
        before, after = left_before != right_before, left_after != right_after
        is_touched_twice = before & after & (left_before != left_after)
        return np.where(is_touched_twice, 2, before != after)

    def is_used(self, inside: np.ndarray) -> np.ndarray:
        """Return which lines (lines,) an outline runs along."""
        return np.bincount(self.edges.line[self.is_cut(inside)], minlength=len(self.lines)) > 0

    def boxes(self, edges: np.ndarray, room: float = 0.0) -> np.ndarray:
        """Return the boxes (k, 4) around edges, with room (m): least x and y, largest x and y."""
        ends = np.stack([self.cells.positions[self.edges.start[edges]], self.cells.positions[self.edges.end[edges]]])
        return np.column_stack([ends.min(axis=0) - room, ends.max(axis=0) + room])

    def improved(
        self, inside: np.ndarray, is_open: np.ndarray, boxes: Optional[np.ndarray] = None, without: int = -1
    ) -> np.ndarray:
        """Return an outline, chosen anew where cells reach into boxes (k, 4), or everywhere; corners cost nothing.

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
        x, y = self.cells.positions[: len(self.cells.crossing)].T
        is_in = np.zeros(len(x), bool)
        for low_x, low_y, high_x, high_y in boxes.tolist():
            is_in |= (x > low_x) & (x < high_x) & (y > low_y) & (y < high_y)
        is_free = np.zeros(count, bool)
        is_free[group[self.cells.around[is_in].ravel()]] = True
        return is_free

    def rings(self, inside: np.ndarray) -> list[list[WallEdge]]:
        """Return the rings of edges of an outline, exterior first."""
        positions = self.cells.positions
        rings = [
            [
                edge_between(positions[here], positions[there], self.lines[line], self.near[line], self.case.scale)
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


def _cell_costs(cells: Arrangement, case: OutlineCase, monitor: Monitor) -> tuple[np.ndarray, np.ndarray]:
    """Return what each cell (cells,) costs inside an outline and outside, by the roof."""
    positions, depth = case.cover.positions, case.cover.depth.ravel()
    size = max(1, _AT_ONCE // max(1, len(cells.points)))
    cell = np.empty(len(positions), np.int64)
    for start in range(0, len(positions), size):
        part = slice(start, start + size)
        cell[part] = cells.cells_at(sides_of(positions[part], cells.points, cells.directions))
        monitor.progress(start / len(positions))

    def area(chosen: np.ndarray) -> np.ndarray:
        return np.bincount(cell[chosen & (cell >= 0)], minlength=cells.count) * case.cover.cell**2

    if_inside = _OUTSIDE * area(depth < -_BEYOND) + _CERTAIN * cells.is_border
    if_outside = _INSIDE * area(depth > case.overhang + _WELL_INSIDE)
    if_outside += _DEEP * area(depth > min(case.limits.max_overhang, _DEEPER * depth.max()))
    # The deepest position is inside at any cost.
    if_outside[cell[np.argmax(depth)]] += _CERTAIN
    return if_inside, if_outside


class Simplification:
    """The cheapest outline of some cells, made cheaper line by line.

    Leaving out a line changes the outline near its edges only: that part is chosen anew, and only lines near
    a change are tried again.
    """

    def __init__(self, cells: OutlineCells) -> None:
        self.cells = cells
        self.inside = cells.improved(np.zeros(cells.cells.count, bool), np.ones(len(cells.lines), bool))
        self.is_open = cells.is_used(self.inside)
        self.total = cells.total(self.inside)

    def run(self, monitor: Monitor) -> np.ndarray:
        """Leave out the lines that aren't worth their corners, the worst first; return the cells (cells,), bool."""
        # What leaving out a line saved when it was last tried, and whether nothing has changed near it since.
        saving = np.where(self.is_open, np.inf, -np.inf)
        is_known = ~self.is_open
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
        return self.inside

    def _without(self, line: int) -> np.ndarray:
        """Return the outline with what runs along a line chosen anew from the open ones."""
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
