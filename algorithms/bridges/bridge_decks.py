"""Bridge decks: parts of the bare earth that are raised on both sides, smooth, and joined to it at both ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..geometry.boxes import connect
from ..geometry.grid import distinct, find_cells, fixed_grid_over
from ..geometry.groups import items, placed, run_starts, split_groups
from ..geometry.sparse_voxels import one_per_voxel
from ..packages import spatial
from ..rules import rule, rules
from ..sampling.closed_surface import CLOSED
from ..sampling.kinds import LASER
from ..segmentation.scan_line_pieces import NearPoints, ends_of, pieces_of_lines, slices
from ..stage import Monitor
from ..terrain.free_standing import FREE
from ..terrain.on_decks import ON_DECK
from ..threads import made_ahead


@rules
class DECK:
    """Rules by which decks of bridges are recognized."""

    directions: int = rule(8, "", "geometry: one of the lines crosses each bridge within 12° of its shortest section")
    least_directions: int = rule(
        2, "", "fitted: in which a deck is raised; with one, as crowns may be, F of a real bridge is 75 instead of 91"
    )
    most_below: float = rule(
        0.15,
        "share of points",
        "physics: beams pass through crowns, and not through decks; and least share of ground in terrain around a deck",
    )
    edge: float = rule(
        0.25,
        "share",
        "of the width of a section, seen under by beams 30° off the vertical; and of the length of a deck, its ends",
    )
    far: float = rule(
        4.0, "reaches", "water gives few points: to the next one beyond an edge, and to the ground ahead of an end"
    )
    least_cell: float = rule(1.0, "m", "least side of cells, and distance from an edge within which a bank shows")
    slope: float = rule(15.0, "°", "of sections and roads, fitted on canals: at 30° F is 34 to 59 instead of 80 to 95")
    noise_step: float = rule(4.0, "standard deviations", "statistics: largest difference in height that is noise")


@dataclass(frozen=True)
class Decks:
    """Criteria of bridges."""

    min_height: float  #: Height above the terrain next to it, m
    #: max_width, min_area: Widest section (m) and least area (m²)
    max_width: float
    min_area: float
    cell: float  #: Side of cells in which points are next to one another, and width of lines, m
    is_thinned: bool  #: Whether one point per third of a cell is looked at: in denser clouds the others show no more
    near: NearPoints  #: When points of a line belong to one section

    @property
    def reach(self) -> float:
        """Distance (m) within which points are next to one another."""
        return 2 * self.cell

    @classmethod
    def of(cls, min_height: float, max_width: float, min_area: float, spacing: float, noise: float) -> Decks:
        """Return the criteria of bridges in a cloud with this point spacing and noise, m."""
        cell = max(DECK.least_cell, CLOSED.cell * spacing)
        near = NearPoints(CLOSED.cell * cell, float(np.tan(np.radians(DECK.slope))), DECK.noise_step * noise)
        return cls(min_height, max_width, min_area, cell, cell > CLOSED.cell * spacing, near)

    def find(self, xyz: np.ndarray, is_earth: np.ndarray, is_terrain: np.ndarray, monitor: Monitor) -> np.ndarray:
        """Return the mask (n,) of points of the bare earth ``is_earth`` (n,) on decks that lead to ``is_terrain``."""
        is_deck = np.zeros(len(xyz), bool)
        if not self.max_width or not len(xyz):
            return is_deck
        if not self.is_thinned:
            return self._decks(xyz, is_earth, is_terrain, monitor)
        rows = one_per_voxel(xyz, self.cell / CLOSED.cell)
        deck = rows[self._decks(xyz[rows], is_earth[rows], is_terrain[rows], monitor)]
        is_deck[deck] = True
        if len(deck):
            is_deck[self._with_edges(xyz, deck, np.flatnonzero(is_earth & ~is_deck))] = True
        return is_deck

    def _decks(self, xyz: np.ndarray, is_earth: np.ndarray, is_terrain: np.ndarray, monitor: Monitor) -> np.ndarray:
        """Return the mask of points that are decks, see :meth:`find`."""
        votes = np.zeros(len(xyz), np.int8)
        # Directions of lines as doubled angles: their sum gives the one across which a deck is raised.
        across = np.zeros(len(xyz), np.complex64)
        count = DECK.directions
        directions = made_ahead(
            lambda number, _: self._raised(xyz, is_earth, 180 * number / count), count, monitor.part(0, 0.8)
        )
        for number, raised in enumerate(directions):
            votes += raised
            across[raised] += np.exp(2j * np.pi * number / count)
        candidates = np.flatnonzero(votes >= DECK.least_directions)
        is_deck = np.zeros(len(xyz), bool)
        if not len(candidates):
            return is_deck
        part = connect(xyz[candidates], self.reach, LASER.foot, monitor.part(0.8, 0.9))
        others = np.flatnonzero(is_earth & (votes < DECK.least_directions))
        # A filter may leave the last meters before a deck out of the ground: they count with the ground beyond.
        terrain = np.flatnonzero((is_terrain | is_earth) & (votes < DECK.least_directions))
        beside = connect(xyz.take(terrain, axis=0), self.reach, LASER.foot, monitor.part(0.9, 1))
        size = np.bincount(beside, minlength=1)
        ground = np.bincount(beside, is_terrain[terrain], len(size))
        size = np.where(ground >= DECK.most_below * size, size, 0)[beside]
        eastward = np.argsort(xyz[terrain, 0])
        terrain_xyz, size = xyz[terrain[eastward]], size[eastward]
        ground_tree = spatial.cKDTree(xyz[terrain[is_terrain[terrain]]] * self._stretch)
        for rows in self._large(xyz, candidates, part):
            # The tip of a pier does not count as terrain that a deck leads to.
            large = _around(xyz[rows], terrain_xyz, size, 1.5 * self.reach, FREE.open_edge * len(rows))
            angle = np.angle(across[rows].sum()) / 2 + np.pi / 2
            axis = np.array([np.cos(angle), np.sin(angle)])
            if self._is_joined(xyz[rows], large, axis) and self._leads_to(xyz[rows], ground_tree, axis):
                is_deck[self._with_edges(xyz, rows, others)] = True
                is_deck[self._with_corners(xyz, rows, others[votes[others] > 0])] = True
        return is_deck

    def _raised(self, xyz: np.ndarray, is_earth: np.ndarray, direction: float) -> np.ndarray:
        """Return the mask of points (n,) of pieces of one direction with lower points beyond both ends."""
        order, line = slices(xyz, direction, self.cell)
        points = xyz.take(order, axis=0)
        angle = np.radians(direction)
        along = points[:, 0] * np.cos(angle) + points[:, 1] * np.sin(angle)
        height = np.ascontiguousarray(points[:, 2])
        # One axis for all lines, with more room between them than any distance on them.
        along = along - along.min() + line * (2 * np.ptp(along) + 10 * self.reach + self.max_width)
        # A piece has three points or more: two always lie on a line.
        piece = pieces_of_lines(points, line, direction, self.near, 3, self.reach)
        piece[~is_earth[order]] = -1
        raised = np.zeros(len(xyz), bool)
        rows, number, count = _numbered(piece)
        if not count:
            return raised
        first, last = ends_of(rows, number, count)
        width = along[last] - along[first]
        chosen = np.flatnonzero((width <= self.max_width) & (width >= self.reach / 2))
        for sign, end in ((-1, first), (1, last)):
            chosen = chosen[self._ends_high(along, height, end[chosen], sign)]
        rows, number = _of_chosen(rows, number, chosen, count)
        size = np.bincount(number, minlength=len(chosen))
        is_smooth = _roughness(along[rows], height[rows], number, size) <= ON_DECK.rough
        below = _n_below(along, height, first[chosen], last[chosen], self.min_height)
        raised[order[rows[(is_smooth & (below <= DECK.most_below * size))[number]]]] = True
        return raised

    def _ends_high(self, along: np.ndarray, height: np.ndarray, end: np.ndarray, sign: int) -> np.ndarray:
        """Return the mask of rows ``end`` (m,) that have lower points beyond them, before or behind by ``sign``.

        Either some are within reach, or they come before the next point at the height of the end: parapets and the
        sides of a deck fulfill neither.
        """
        if sign < 0:
            count = end - np.searchsorted(along, along[end] - DECK.far * self.reach)
        else:
            count = np.searchsorted(along, along[end] + DECK.far * self.reach, side="right") - end - 1
        which, item = items(np.maximum(count, 0))
        rows = end[which] + sign * (item + 1)
        below = height[end][which] - height[rows]
        is_low = below >= self.min_height
        within = np.abs(along[rows] - along[end][which]) <= self.reach
        ends = np.bincount(which[is_low & within], minlength=len(end)) > 0
        # Points that are lower than the end, by less than the minimum height, show a bank. A few may be of the side of
        # a deck: as many as lie on its width in plan, at nine per cell.
        beside = (below > ON_DECK.rough) & ~is_low & (np.abs(along[rows] - along[end][which]) <= DECK.least_cell)
        follows = np.flatnonzero(is_low | (np.abs(below) <= ON_DECK.rough))
        first = follows[run_starts(which[follows])]
        ends[which[first[is_low[first]]]] = True
        most = ON_DECK.rough * CLOSED.cell**2 / self.cell
        return ends & (np.bincount(which[beside], minlength=len(end)) <= most)

    def _large(self, xyz: np.ndarray, candidates: np.ndarray, part: np.ndarray) -> list[np.ndarray]:
        """Return the rows of parts that are large enough."""
        grid = fixed_grid_over(xyz[candidates], self.reach / 2)
        cells = distinct(part.astype(np.int64) * (grid.rows * grid.columns) + grid.number(xyz[candidates]))[0]
        area = np.bincount(cells // (grid.rows * grid.columns)) * grid.size**2
        return [candidates[rows] for rows, size in zip(split_groups(part, len(area)), area) if size >= self.min_area]

    def _is_joined(self, deck: np.ndarray, others: np.ndarray, axis: np.ndarray) -> bool:
        """Return whether terrain continues a deck at both ends along its ``axis`` (2,)."""
        if not len(others):
            return False
        along = deck[:, :2] @ axis
        tree = spatial.cKDTree(others)
        # In thin clouds the nearest point may lie on the slope below the road: half of what a cell holds is looked at.
        count = int(CLOSED.cell**2 / 2)
        distance, nearest = tree.query(deck, k=count, distance_upper_bound=1.5 * self.reach)
        near, rank = np.nonzero(np.isfinite(distance))
        way = others[nearest[near, rank]] - deck[near]
        ahead = way[:, :2] @ axis
        aside = way[:, 0] * axis[1] - way[:, 1] * axis[0]
        # Terrain next to a deck is not ahead of its ends.
        is_next = (np.abs(way[:, 2]) <= LASER.foot) & (np.abs(ahead) >= np.abs(aside))
        low, high = along.min() + DECK.edge * np.ptp(along), along.max() - DECK.edge * np.ptp(along)
        across = deck[:, 0] * axis[1] - deck[:, 1] * axis[0]
        strip = np.floor((across - across.min()) / self.reach).astype(np.int64)
        ends = ((ahead < 0) & (along[near] <= low), (ahead > 0) & (along[near] >= high))
        least = max(1, FREE.open_edge * (strip.max() + 1))
        return all(len(np.unique(strip[near[is_next & end]])) >= least for end in ends)

    def _leads_to(self, deck: np.ndarray, ground: Any, axis: np.ndarray) -> bool:
        """Return whether ground lies ahead of both ends of a deck, at its height; ``ground`` is a stretched tree."""
        along = deck[:, :2] @ axis
        low, high = along.min() + DECK.edge * np.ptp(along), along.max() - DECK.edge * np.ptp(along)
        return self._goes_on(deck[along <= low], ground, -axis) and self._goes_on(deck[along >= high], ground, axis)

    def _goes_on(self, end: np.ndarray, ground: Any, axis: np.ndarray) -> bool:
        """Return whether ground lies ahead of an end of a deck, beyond the edge of a wall."""
        along = end[:, :2] @ axis
        to_tip = (along.max() - along)[:, None]
        forward = np.append(axis, 0.0)
        for step in range(1, int(DECK.far) + 1):
            positions = end + (to_tip + step * self.reach) * forward
            distance, _ = ground.query(positions * self._stretch, distance_upper_bound=self.reach / 2)
            if np.isfinite(distance).mean() >= FREE.open_edge:
                return True
        return False

    @property
    def _stretch(self) -> np.ndarray:
        """Factors (3,) of coordinates by which twice the height of a step counts as half the reach in plan."""
        return np.array([1.0, 1.0, self.reach / 2 / (2 * LASER.foot)])

    def _with_corners(self, xyz: np.ndarray, rows: np.ndarray, raised: np.ndarray) -> np.ndarray:
        """Return a deck with points next to it that are raised in one direction: corners of slanting and wide decks."""
        distance, nearest = spatial.cKDTree(xyz[rows]).query(xyz[raised], distance_upper_bound=1.5 * self.reach)
        near = np.isfinite(distance)
        raised, nearest = raised[near], nearest[near]
        return np.concatenate([rows, raised[np.abs(xyz[raised, 2] - xyz[rows[nearest], 2]) <= LASER.foot]])

    def _with_edges(self, xyz: np.ndarray, rows: np.ndarray, others: np.ndarray) -> np.ndarray:
        """Return a deck with the points in its cells that lie at its height, such as those at its edges."""
        grid = fixed_grid_over(xyz[np.concatenate([rows, others])], self.reach / 2)
        cells, which = distinct(grid.number(xyz[rows]))
        level = np.bincount(which, xyz[rows, 2]) / np.bincount(which)
        position, found = find_cells(cells, grid.number(xyz[others]))
        same = found & (np.abs(xyz[others, 2] - level[position]) <= LASER.foot)
        return np.concatenate([rows, others[same]])


def _around(deck: np.ndarray, xyz: np.ndarray, size: np.ndarray, distance: float, least: float) -> np.ndarray:
    """Return the points (k, 3) of terrain within a distance (m) of a deck that hold together with ``least`` others.

    The terrain is sorted from west to east (n, 3); ``size`` (n,) is the number of points connected with each, 0 where
    too few of these are ground. A tree of the points around a deck is made in a fraction of the time of one of the
    whole terrain.
    """
    low, high = deck.min(axis=0) - distance, deck.max(axis=0) + distance
    first, stop = np.searchsorted(xyz[:, 0], low[0]), np.searchsorted(xyz[:, 0], high[0], side="right")
    near, size = xyz[first:stop], size[first:stop]
    return near[(near[:, 1] >= low[1]) & (near[:, 1] <= high[1]) & (size >= least)]


def _numbered(piece: np.ndarray) -> tuple[np.ndarray, np.ndarray, int]:
    """Return the rows of the points of pieces, their piece numbers from 0 without gaps, and the number of pieces."""
    rows = np.flatnonzero(piece >= 0)
    is_there = np.bincount(piece[rows]) > 0
    return rows, (np.cumsum(is_there) - 1)[piece[rows]], int(is_there.sum())


def _of_chosen(rows: np.ndarray, number: np.ndarray, chosen: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows of ``chosen`` pieces out of ``count``, with their new numbers from 0."""
    renumbered = placed(np.arange(len(chosen)), chosen, count, -1)
    kept = renumbered[number] >= 0
    return rows[kept], renumbered[number[kept]]


def _n_below(along: np.ndarray, height: np.ndarray, first: np.ndarray, last: np.ndarray, least: float) -> np.ndarray:
    """Count the points (m,) at least ``least`` m under each piece, where slanting beams do not reach."""
    which, item = items(last - first + 1)
    rows = first[which] + item
    depth = np.minimum(height[first], height[last])[which] - height[rows]
    shown = DECK.edge * (along[last] - along[first])[which]
    hidden = np.minimum(along[rows] - along[first][which], along[last][which] - along[rows]) >= shown
    return np.bincount(which, (depth > least) & hidden, len(first))


def _roughness(along: np.ndarray, height: np.ndarray, number: np.ndarray, count: np.ndarray) -> np.ndarray:
    """Return how far (root mean square, m) the points of pieces lie off a straight line."""

    def mean(values: np.ndarray) -> np.ndarray:
        return np.bincount(number, values, len(count)) / count

    x, z = along - mean(along)[number], height - mean(height)[number]
    xx, xz, zz = mean(x * x), mean(x * z), mean(z * z)
    return np.sqrt(np.maximum(zz - np.divide(xz * xz, xx, out=np.zeros_like(xx), where=xx > 0), 0))
