"""Segments of the lowest surface that stand free: roofs of any size, told from hills by the steps at their edges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..groups import components
from ..packages import ndimage
from ..stage import Monitor

# A step is at least so high (m) and so steep: lower than any eave, steeper than slopes that soil lies on.
_STEP, _STEEP = 1.0, 1.0

# Segments wider than usual buildings are halls if their steps are at least so high (m): quays are lower.
_HALL_STEP = 2.0

# A segment stands free with steps down on this share of its open edge; so much of its edge must be open, that is
# not hidden behind what stands higher or is too rough to tell; and where the end of the cloud cuts it off, so much
# of the outline that is left.
_FREE_EDGE, _OPEN_EDGE, _OPEN_IF_CUT = 0.9, 0.4, 0.7

# Walls are as high as they must be on this share of all steps down; beside the others a wing may stand.
_HIGH = 0.5

# So much of its steps down face others, those to the west some to the east: a terrace steps down on one side.
_FACING = 0.2

# Parts of a hall have steps down on more than this share of their open edge, each of them.
_PART_EDGE = 0.5

# What has a roof no higher than itself on more than this share of its edge rests on it.
_RESTS = 0.5

# Neighbors come along both axes, both ways.
_SIDES = 4

# Smaller segments (cells) are too rough to tell.
_LEAST_CELLS = 4

# On terrain other things stand on more than this share of its area; on roofs, chimneys and machines on less, but for
# those of podiums, whose walls are higher than quays and the walls of terraces (m).
_CARRIES, _HIGHEST_QUAY = 0.1, 4.0


@dataclass(frozen=True)
class _Cut:
    """What tells a roof that the end of the cloud cuts off, on at most this share of its outline.

    Most steps are so many times as high as the least ones, and may have to face one another: at a corner of the cloud
    none do. Walls so high and steep are no quays, terraces or slopes.
    """

    share: float
    steps: float
    must_face: bool


_ALMOST_WHOLE = _Cut(0.35, 1.0, True)
_CUTS = (_ALMOST_WHOLE, _Cut(0.5, 2.0, True), _Cut(0.55, 4.0, False), _Cut(0.7, 6.0, False))


@dataclass(frozen=True)
class _Edges:
    """The edges of segments, cell by cell.

    Segment on this and on the other side, m each; how far (m) this one is higher, and the direction to the other.
    """

    own: np.ndarray
    other: np.ndarray
    step: np.ndarray
    side: np.ndarray

    def lengths(self, stands: np.ndarray, needed: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the length (cells) of each segment's edge, of what nothing hides of it, and its steps to each side."""
        count = len(stands)
        down = self.step >= needed[self.own]
        hidden = ~down & (stands[self.other] | (self.other == 0))
        whole = np.bincount(self.own, minlength=count)
        open_ = np.bincount(self.own[~hidden], minlength=count)
        by_side = np.bincount(self.own[down] + count * self.side[down], minlength=_SIDES * count)
        return whole, open_, by_side.reshape(_SIDES, count)


def free_standing(
    surface: np.ndarray,
    cell_size: float,
    usual: float,
    largest: float = np.inf,
    apart: float = 0.0,
    monitor: Optional[Monitor] = None,
) -> tuple[np.ndarray, float]:
    """Find the smooth segments of a surface that are bounded by steps down all round.

    Parameters
    ----------
    surface : ndarray of shape (rows, columns), float64
        Lowest elevation of each cell, m; NaN beyond the end of the cloud.
    cell_size : float
        m.
    usual : float
        Shorter side (m) up to which low steps will do.
    largest : float
        Shorter side (m) over which nothing is taken for an object.
    apart : float
        Distance of the points (m), where that is more than a cell: between two of them slopes look like steps.
    monitor : Monitor, optional
        Hears progress.

    Returns
    -------
    free : ndarray of shape (rows, columns), bool
        Cells of such segments, on terrain of any slope.
    size : float
        Shorter side (m) of the largest.

    Notes
    -----
    What is wider than usual is looked at more closely: its parts are judged together, and what is too rough to tell on
    its roof belongs to it. Of smaller things windows see the whole, but for those that the end of the cloud cuts off:
    the more of one is cut off, the higher its walls must be.
    """
    monitor = monitor or Monitor()
    least = max(_STEP, _STEEP * max(cell_size, apart))
    segment = _segments(surface, least)
    monitor.progress(0.3)
    stands, width = _standing(surface, segment, least, usual / cell_size, largest / cell_size)
    monitor.progress(0.5)
    # Neither half of a hall that a row of skylights cuts in two stands while the other doesn't, nor does a hall
    # beside a wing that is hardly lower. Windows don't see the whole of a smaller one that the cloud's end cuts.
    hall = _reunited(surface, segment, stands, least)
    is_hall = (_sides(hall).min(axis=0) > usual / cell_size) | (_ends(surface, hall, hall.max() + 1) > 0)
    in_hall = is_hall[hall] & (hall > 0)
    segment = np.where(in_hall, len(stands) + hall, segment)
    monitor.progress(0.7)
    stands, width = _standing(surface, segment, least, usual / cell_size, largest / cell_size)
    free = stands[segment]
    monitor.progress(0.9)
    free |= _resting(surface, segment == 0, free & in_hall, least)
    monitor.progress(1.0)
    return free, float(width[stands].max(initial=0.0)) * cell_size


def _standing(
    surface: np.ndarray, segment: np.ndarray, least: float, usual: float, largest: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return which segments stand free, and the shorter side of each; sizes in cells."""
    sides = _sides(segment)
    width = sides.min(axis=0)
    wide = width > usual
    needed = np.where(wide, max(_HALL_STEP, least), least)
    needed[width > largest] = np.inf
    stands = np.zeros(len(width), bool)
    edges, ends = _edges(surface, segment), _ends(surface, segment, len(width))
    # The highest come first; what stands at their walls is judged by the rest of its edge.
    while True:
        found = _stands(edges, ends, sides, stands, needed, least) & ~stands
        if not found.any():
            break
        stands |= found
    # An island with houses on it has quays all round; what has higher walls carries towers.
    walls = np.full(len(width), max(_HIGHEST_QUAY, least))
    may_be_island = stands & wide & ~_stands(edges, ends, sides, stands, walls, least)
    return stands & ~_carries(segment, stands, np.flatnonzero(may_be_island)), width


def _segments(surface: np.ndarray, least: float) -> np.ndarray:
    """Label (from 1) cells that join without a step; 0 are rough cells that have steps on all sides or nearly so."""
    beside = np.isnan(surface)
    for here, there in neighbors(surface.ndim):
        beside[here] |= np.abs(surface[here] - surface[there]) >= least
    segment, _ = ndimage.label(~beside)
    small = np.bincount(segment.ravel()) < _LEAST_CELLS
    segment[small[segment]] = 0
    # The cells at a step go to the segment beside them from which they differ least.
    for _ in range(2):
        best = np.full(surface.shape, least)
        grown = segment.copy()
        for here, there in neighbors(surface.ndim):
            step = np.abs(surface[here] - surface[there])
            takes = (segment[here] == 0) & (segment[there] > 0) & (step < best[here])
            best[here] = np.where(takes, step, best[here])
            grown[here] = np.where(takes, segment[there], grown[here])
        segment = grown
    return segment


def _reunited(surface: np.ndarray, segment: np.ndarray, stands: np.ndarray, least: float) -> np.ndarray:
    """Give segments that meet without the step of a hall one number, if most of the edge of each steps down."""
    count = len(stands)
    edges = _edges(surface, segment)
    _, open_, by_side = edges.lengths(stands, np.full(count, least))
    is_part = ~stands & (by_side.sum(axis=0) > _PART_EDGE * open_)
    level = is_part[edges.own] & is_part[edges.other] & (np.abs(edges.step) < max(_HALL_STEP, least))
    # Components are numbered by their first segments: that of 0, which is no part, stays 0.
    return components(edges.own[level], edges.other[level], count)[1][segment]


def _resting(surface: np.ndarray, rough: np.ndarray, roof: np.ndarray, least: float) -> np.ndarray:
    """Return the rough cells that rest on a roof: machines and skylights, but no bushes at its walls."""
    thing, count = ndimage.label(rough & ~np.isnan(surface))
    whole, on_roof = np.zeros((2, count + 1))
    for here, there in neighbors(surface.ndim):
        edge = (thing[here] > 0) & ~rough[there]
        no_higher = edge & roof[there] & (surface[there] - surface[here] < least)
        whole += np.bincount(thing[here][edge], minlength=count + 1)
        on_roof += np.bincount(thing[here][no_higher], minlength=count + 1)
    return (on_roof > _RESTS * whole)[thing]


def _sides(segment: np.ndarray) -> np.ndarray:
    """Return the sides (2, number of segments) of each segment's box, in cells."""
    boxes = ndimage.find_objects(segment)
    return np.array([(0, 0)] + [tuple(side.stop - side.start for side in box) if box else (0, 0) for box in boxes]).T


def _stands(
    edges: _Edges, ends: np.ndarray, sides: np.ndarray, stands: np.ndarray, needed: np.ndarray, least: float
) -> np.ndarray:
    """Return which segments have steps down on most of the edge that nothing hides, and enough of that.

    ``ends`` is how much of each one's edge is the end of the cloud, ``sides`` are those of its box, in cells.
    """
    whole, open_, by_side = edges.lengths(stands, needed)
    down = by_side.sum(axis=0)
    # The outline of its box is no longer for a jagged edge, nor for what stands inside.
    outline = np.minimum(whole + ends, 2 * sides.sum(axis=0))
    found = np.zeros(len(stands), bool)
    for cut in _CUTS:
        high = edges.lengths(stands, np.maximum(needed, cut.steps * least))[2]
        # Neighbors come along each axis both ways.
        faces = 2 * np.minimum(high[::2], high[1::2]).sum(axis=0) >= _FACING * high.sum(axis=0)
        may_stand = faces | ((ends > _ALMOST_WHOLE.share * outline) & (not cut.must_face))
        needs_open = _OPEN_EDGE * (whole + ends) if cut is _ALMOST_WHOLE else _OPEN_IF_CUT * (outline - ends)
        is_seen = (ends <= cut.share * outline) & (open_ >= needs_open)
        found |= may_stand & is_seen & (high.sum(axis=0) >= _HIGH * down)
    return found & (down > 0) & (down >= _FREE_EDGE * open_)


def _edges(surface: np.ndarray, segment: np.ndarray) -> _Edges:
    """Return the edges of all segments but 0."""
    parts = []
    for side, (here, there) in enumerate(neighbors(surface.ndim)):
        edge = (segment[here] > 0) & (segment[here] != segment[there]) & ~np.isnan(surface[there])
        step = surface[here][edge] - surface[there][edge]
        parts.append((segment[here][edge], segment[there][edge], step, np.full(len(step), side)))
    return _Edges(*(np.concatenate(part) for part in zip(*parts)))


def _ends(surface: np.ndarray, segment: np.ndarray, count: int) -> np.ndarray:
    """Return how much of each segment's edge is the end of the surface, in cells."""
    ends = np.zeros(count)
    for here, there in neighbors(segment.ndim):
        ends += np.bincount(segment[here][np.isnan(surface[there])], minlength=count)
    for axis in range(segment.ndim):
        for side in (0, -1):
            ends += np.bincount(np.take(segment, side, axis).ravel(), minlength=count)
    return ends


def _carries(segment: np.ndarray, stands: np.ndarray, which: np.ndarray) -> np.ndarray:
    """Tell which of the numbered segments have standing ones inside them on more than a share of their area."""
    count = len(stands)
    area = np.bincount(segment.ravel(), minlength=count)
    boxes = ndimage.find_objects(segment, count - 1)
    carries = np.zeros(count, bool)
    for number in which:
        box = boxes[number - 1]
        inside = ndimage.binary_fill_holes(segment[box] == number) & (segment[box] != number)
        carries[number] = (inside & stands[segment[box]]).sum() > _CARRIES * area[number]
    return carries


def neighbors(dimensions: int) -> Iterator[tuple[tuple[slice, ...], tuple[slice, ...]]]:
    """Yield the slices of an array and of itself moved by one cell, along each axis, both ways."""
    for axis in range(dimensions):
        for inside, outside in ((slice(None, -1), slice(1, None)), (slice(1, None), slice(None, -1))):
            yield (slice(None),) * axis + (inside,), (slice(None),) * axis + (outside,)
