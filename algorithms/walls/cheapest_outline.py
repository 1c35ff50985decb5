"""The cheapest outline of a building's walls in the cells cut by all of its lines, simplified line by line.

The unit of all costs is a meter of wall without points.
"""

import numpy as np

from ..geometry.arrangement import Arrangement, sides_of
from ..geometry.cheapest_labels import cheapest_cut
from ..geometry.groups import components, members
from ..geometry.rings import signed_area
from ..stage import Monitor
from ..threads import PAIRS_AT_ONCE
from .roof_outline import RoofCover
from .wall_edges import WallEdge, closed, edge_between, points_near
from .wall_lines import SAME_WALL, Scale, WallLine

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
