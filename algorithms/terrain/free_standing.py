"""Free-standing segments of the lowest surface: roofs of any size; hills lack the steps at their edges."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.adjacent_cells import adjacent_cells
from ..geometry.groups import components
from ..packages import ndimage
from ..rules import rule, rules
from ..sampling.kinds import LASER
from ..stage import Monitor


@rules
class FREE:
    """Steps at the edge of a segment that make it a building."""

    step: float = rule(1.0, "m", "physics: least height of a step, lower than any eave")
    steep: float = rule(1.0, "tangent", "physics: least slope of a step, 45°, and of smeared walls; soil is less steep")
    free_edge: float = rule(0.9, "share", "of its open edge with steps down; the rest is trees against its walls")
    open_edge: float = rule(0.4, "share", "of its edge, neither hidden behind higher surfaces nor rough")
    most: float = rule(
        0.5, "share", "majority of steps, of the edge of a part, region or machine, or of the cells of a crest"
    )
    least_cells: int = rule(4, "cells", "of a segment; smaller ones are undecided, as rough cells are")


@dataclass(frozen=True)
class _Lengths:
    """Lengths of the edges of segments (s,), in cells."""

    whole: np.ndarray  #: (s,), int64: the whole edge without the end of the cloud
    open: np.ndarray  #: (s,), int64: its part that nothing hides
    down: np.ndarray  #: (s,), int64: its part with steps down


@dataclass(frozen=True)
class _Edges:
    """The edges of segments, cell by cell and side by side."""

    #: own, other, (e,), int: segment on this and on the other side
    own: np.ndarray
    other: np.ndarray
    step: np.ndarray  #: (e,), float64: how much higher this side is (m)

    def lengths(self, is_free: np.ndarray, least_step: np.ndarray) -> _Lengths:
        """Return the lengths of edges, with steps of at least some height (s,) (m).

        Free-standing segments (s,) and rough cells hide the edges next to them, unless these are steps down.
        """
        count = len(is_free)
        is_down = self.step >= least_step[self.own]
        is_hidden = ~is_down & (is_free[self.other] | (self.other == 0))
        whole = np.bincount(self.own, minlength=count)
        is_open = np.bincount(self.own[~is_hidden], minlength=count)
        return _Lengths(whole, is_open, np.bincount(self.own[is_down], minlength=count))


@dataclass(frozen=True)
class _Segments:
    """Numbered segments of a surface, from 1; 0 where too rough."""

    number: np.ndarray  #: (rows, columns), int: segment of each cell
    sides: np.ndarray  #: (2, s), int64: sides of each segment's box, in cells
    edges: _Edges  #: Where segments are next to others
    ends: np.ndarray  #: (s,), float64: length of each one's edge that is the end of the cloud, in cells

    @property
    def width(self) -> np.ndarray:
        """Shorter side (s,) of each segment's box, in cells."""
        return self.sides.min(axis=0)

    def mean_step_down(self, least: float) -> np.ndarray:
        """Return the mean height (s,) (m) of each one's steps down of at least some height (m), 0 without any."""
        is_down, count = self.edges.step >= least, self.sides.shape[1]
        total = np.bincount(self.edges.own[is_down], self.edges.step[is_down], count)
        return total / np.maximum(np.bincount(self.edges.own[is_down], minlength=count), 1)


def find_free_standing(
    surface: np.ndarray,
    cell_size: float,
    usual: float,
    largest: float = np.inf,
    apart: float = 0.0,
    monitor: Optional[Monitor] = None,
    low_uphill: bool = False,
) -> tuple[np.ndarray, float]:
    """Find the smooth segments of a surface that are bounded by steps down all round.

    Parameters
    ----------
    surface : ndarray of shape (rows, columns), float64
        Lowest elevation of each cell, m; NaN beyond the end of the cloud.
    cell_size : float
        Side of a cell, m.
    usual : float
        Shorter side (m) up to which low steps will do.
    largest : float
        Shorter side (m) over which nothing is taken for an object.
    apart : float
        Distance of the points (m), where that is more than a cell: between two of them slopes look like steps.
    monitor : Monitor, optional
        Receives progress.
    low_uphill : bool
        Whether steps around a wide segment have to be high only on the mean.

    Returns
    -------
    is_free : ndarray of shape (rows, columns), bool
        Cells of such segments, on terrain of any slope.
    size : float
        Shorter side (m) of the largest.

    Notes
    -----
    Segments wider than usual buildings are examined more closely: parts of a hall are judged together, and undecided
    rough cells on its roof belong to it. The windows of the ground filter see smaller segments whole, unless the end of
    the cloud cuts them off: the more of one is cut off, the higher its walls must be.

    Segments at the walls of free-standing ones are judged by the rest of their edge. Their steps have to be as high as
    the lowest roof on the mean: wings are, and terraces below a house or below one another are not.

    A level roof on a slope has its highest steps downhill and its lowest uphill, as low as any roof's. Quays
    and platforms are low all round, so that with ``low_uphill`` the mean of the steps distinguishes these from halls.
    """
    monitor = monitor or Monitor()
    least = max(FREE.step, FREE.steep * max(cell_size, apart))
    usual_cells, largest_cells = usual / cell_size, largest / cell_size
    number = smooth_segments(surface, least)
    monitor.progress(0.3)
    segments = _measured(surface, number)
    is_free = _are_free_standing(segments, least, usual_cells, largest_cells, low_uphill)
    monitor.progress(0.5)
    # Half of a hall that skylights divide is not free-standing by itself, nor is a hall next to a wing that is hardly
    # lower. A smaller one at the end of the cloud is not whole in the windows of the ground filter.
    hall = _reunited(segments, is_free, least)
    is_hall = (_box_sides(hall).min(axis=0) > usual_cells) | (_ends(surface, hall, hall.max() + 1) > 0)
    in_hall = is_hall[hall] & (hall > 0)
    segments = _measured(surface, np.where(in_hall, len(is_free) + hall, number))
    monitor.progress(0.7)
    is_free = _are_free_standing(segments, least, usual_cells, largest_cells, low_uphill)
    monitor.progress(0.9)
    cells = is_free[segments.number]
    cells |= _on_roof(surface, segments.number == 0, cells & in_hall, least)
    monitor.progress(1.0)
    return cells, float(segments.width[is_free].max(initial=0.0)) * cell_size


def _measured(surface: np.ndarray, number: np.ndarray) -> _Segments:
    """Return the segments of a surface with the numbers of its cells."""
    sides = _box_sides(number)
    return _Segments(number, sides, _edges(surface, number), _ends(surface, number, sides.shape[1]))


def _are_free_standing(segments: _Segments, least: float, usual: float, largest: float, low_uphill: bool) -> np.ndarray:
    """Return the mask of segments (s,) that are free-standing.

    ``least`` is the least height of a step (m), ``usual`` and ``largest`` are widths in cells. With ``low_uphill``,
    wide segments need high steps on average only.
    """
    is_wide, is_high = segments.width > usual, segments.mean_step_down(least) >= LASER.lowest_roof
    is_low = is_wide & ~is_high if low_uphill else is_wide
    least_step = np.where(is_low, max(LASER.lowest_roof, least), least)
    least_step[segments.width > largest] = np.inf
    is_free = _bounded_by_steps(segments, np.zeros(len(segments.width), bool), least_step, least)
    # Lower segments at walls of these are judged by the rest of their edge: wings are as high as a roof there, and the
    # steps of terraces below one another are lower.
    while True:
        found = _bounded_by_steps(segments, is_free, least_step, least) & is_high & ~is_free
        if not found.any():
            return is_free
        is_free |= found


def _bounded_by_steps(segments: _Segments, is_free: np.ndarray, least_step: np.ndarray, least: float) -> np.ndarray:
    """Return the mask of segments (s,) with steps down on most of the edge that nothing hides, if enough is open.

    Parameters
    ----------
    segments : _Segments
        The segments.
    is_free : ndarray of shape (s,), bool
        Those that are known to be free-standing: they hide the edges of others.
    least_step : ndarray of shape (s,), float64
        Least height (m) of the steps of each.
    least : float
        Least height (m) of any step, of which the heights of walls that are cut off are multiples.
    """
    lengths = segments.edges.lengths(is_free, least_step)
    # Use the outline of its box, which neither a jagged edge nor segments inside make longer.
    outline = np.minimum(lengths.whole + segments.ends, 2 * segments.sides.sum(axis=0))
    # The more the end of the cloud cuts off, the higher walls must be: four times as high if half of the edge is left.
    remaining = np.maximum(outline - segments.ends, 1)
    high = segments.edges.lengths(is_free, np.maximum(least_step, least * (outline / remaining) ** 2))
    # Enough must be open of the whole edge, machines included, and of the outline, the end of the cloud included.
    is_seen = lengths.open >= FREE.open_edge * lengths.whole
    is_seen &= np.minimum(lengths.open, remaining) >= FREE.open_edge * outline
    is_high = (lengths.down > 0) & (high.down >= FREE.most * lengths.down)
    return is_seen & is_high & (lengths.down >= FREE.free_edge * lengths.open)


def smooth_segments(surface: np.ndarray, least: float) -> np.ndarray:
    """Label (from 1) cells that join without a step; 0 are rough cells that have steps on all sides or nearly so."""
    beside = np.isnan(surface)
    for here, other in adjacent_cells(surface.ndim):
        beside[here] |= np.abs(surface[here] - surface[other]) >= least
    segment, _ = ndimage.label(~beside)
    segment[(np.bincount(segment.ravel()) < FREE.least_cells)[segment]] = 0
    # The cells at a step go to the segment next to them from which they differ least; in a second
    # round, cells that were only next to such cells.
    for _ in range(2):
        best = np.full(surface.shape, least)
        grown = segment.copy()
        for here, other in adjacent_cells(surface.ndim):
            step = np.abs(surface[here] - surface[other])
            takes = (segment[here] == 0) & (segment[other] > 0) & (step < best[here])
            best[here] = np.where(takes, step, best[here])
            grown[here] = np.where(takes, segment[other], grown[here])
        segment = grown
    return segment


def _reunited(segments: _Segments, is_free: np.ndarray, least: float) -> np.ndarray:
    """Give segments that meet without the step of a hall one number, if most of the edge of each steps down."""
    count = len(is_free)
    lengths = segments.edges.lengths(is_free, np.full(count, least))
    is_part = ~is_free & (lengths.down > FREE.most * lengths.open)
    own, other = segments.edges.own, segments.edges.other
    is_level = is_part[own] & is_part[other] & (np.abs(segments.edges.step) < max(LASER.lowest_roof, least))
    # Components are numbered by their first segments: 0, which is no part, stays 0.
    return components(own[is_level], other[is_level], count)[1][segments.number]


def _on_roof(surface: np.ndarray, is_rough: np.ndarray, is_roof: np.ndarray, least: float) -> np.ndarray:
    """Return the rough cells on a roof: machines and skylights, but no bushes at its walls."""
    component, count = ndimage.label(is_rough & ~np.isnan(surface))
    whole, on_roof = np.zeros((2, count + 1))
    for here, other in adjacent_cells(surface.ndim):
        edge = (component[here] > 0) & ~is_rough[other]
        no_higher = edge & is_roof[other] & (surface[other] - surface[here] < least)
        whole += np.bincount(component[here][edge], minlength=count + 1)
        on_roof += np.bincount(component[here][no_higher], minlength=count + 1)
    return (on_roof > FREE.most * whole)[component]


def _box_sides(segment: np.ndarray) -> np.ndarray:
    """Return the sides (2, number of segments) of each segment's box, in cells."""
    boxes = ndimage.find_objects(segment)
    return np.array([(0, 0)] + [tuple(side.stop - side.start for side in box) if box else (0, 0) for box in boxes]).T


def _edges(surface: np.ndarray, segment: np.ndarray) -> _Edges:
    """Return the edges of all segments but 0."""
    parts = []
    for here, other in adjacent_cells(surface.ndim):
        is_edge = (segment[here] > 0) & (segment[here] != segment[other]) & ~np.isnan(surface[other])
        step = surface[here][is_edge] - surface[other][is_edge]
        parts.append((segment[here][is_edge], segment[other][is_edge], step))
    return _Edges(*(np.concatenate(part) for part in zip(*parts)))


def _ends(surface: np.ndarray, segment: np.ndarray, count: int) -> np.ndarray:
    """Return how much of each segment's edge is the end of the surface, in cells."""
    ends = np.zeros(count)
    for here, other in adjacent_cells(segment.ndim):
        ends += np.bincount(segment[here][np.isnan(surface[other])], minlength=count)
    for axis in range(segment.ndim):
        for side in (0, -1):
            ends += np.bincount(np.take(segment, side, axis).ravel(), minlength=count)
    return ends
