"""Objects on the lowest surface: cells that an opening by windows removes, without those that join the terrain.

The opening after Pingel et al. (2013) removes cells that are higher than terrain of the local slope could be. Regions
of removed cells come back if they go on into the terrain around without a step, as banks, spits and hilltops do.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from ..geometry.adjacent_cells import adjacent_cells
from ..geometry.raster_filling import filled_by_means
from ..geometry.raster_opening import open_surface
from ..packages import ndimage
from ..rules import rule, rules
from ..stage import Monitor
from .free_standing import FREE, smooth_segments


@rules
class REMOVAL:
    """How steep terrain may be, and what joins it."""

    step: float = rule(0.1, "m", "physics: terrain has kerbs, ruts and tussocks as high within any window")
    flat_slope: float = rule(0.1, "tangent", "physics: slope that terrain may have besides the one measured around it")
    slope_share: float = rule(
        0.4, "share", "fitted on eight ISPRS samples: of the measured slope, which adds to the flat slope"
    )
    join_slope: float = rule(0.3, "tangent", "physics: of a step at the edge of a region that joins the terrain")
    level_share: float = rule(
        0.25, "share", "of the area of a smooth part, level with the terrain around, from which it is a bank"
    )
    steepest_bank: float = rule(2.0, "tangent", "physics: a step near a slope as steep as itself is a bank up to 63°")
    growth: float = rule(1.25, "ratio", "of one window to the one before: three windows to a doubling")
    smoothing: float = rule(
        2.0,
        "m",
        "physics: standard deviation of the smoothing of surfaces, half as much as of slopes; bushes are as wide",
    )


@dataclass(frozen=True)
class ObjectRemoval:
    """The removal of objects from a surface by windows of growing size."""

    surface: np.ndarray  #: (rows, columns), float64: lowest elevation of each cell, m
    #: (rows, columns), bool: cells of objects that are known already; windows leave them out
    is_free_standing: np.ndarray
    largest: float  #: Largest window, m
    #: cell_size, spacing: Size of the cells, and spacing of the points where that is more, m
    cell_size: float
    spacing: float = 0.0
    is_nearly_empty: bool = False  #: Whether there are far more cells than points
    _lowered: list[tuple[int, np.ndarray, np.ndarray]] = field(default_factory=list, init=False, repr=False)

    @property
    def windows(self) -> list[int]:
        """Radii of the windows, in cells."""
        return _windows(self.largest / 2 / self.cell_size)

    def slope(self, monitor: Monitor) -> np.ndarray:
        """Return the slope of the terrain (rise over run), measured twice, each time without the objects before."""
        first = np.full(self.surface.shape, REMOVAL.flat_slope)
        # Leave out free-standing objects; otherwise a low roof and a higher one next to it would count as one wide
        # object.
        removed = self.is_free_standing | (self.removed_by_opening(first, monitor.part(0, 0.5)) > 0)
        return self._slope_without(self.objects(self._slope_without(removed), monitor.part(0.5, 1)))

    def objects(self, slope: np.ndarray, monitor: Monitor) -> np.ndarray:
        """Return the mask of cells that are objects on terrain of this slope."""
        objects = self.without_joined(self.removed_by_opening(REMOVAL.slope_share * slope, monitor), slope)
        return self._without_level(objects)

    def rise(self, slope: np.ndarray, radius: int = 1) -> np.ndarray:
        """Return the greatest rise (m) of terrain over a ``radius`` (cells); ``slope`` adds to the flat slope."""
        return REMOVAL.step + (REMOVAL.flat_slope + slope) * (radius * self.cell_size)

    def removed_by_opening(self, slope: np.ndarray, monitor: Monitor) -> np.ndarray:
        """Return the radius (cells) of the first window that removes each cell, 0 where none does.

        Cells are removed that are higher than terrain may rise, see :meth:`rise`.
        """
        removed_by = np.zeros(self.surface.size, np.int32)
        for radius, cells, fall in self._lowered_by(monitor):
            removed = cells[fall > self.rise(slope.ravel()[cells], radius)]
            removed_by[removed[removed_by[removed] == 0]] = radius
        return removed_by.reshape(self.surface.shape)

    def _lowered_by(self, monitor: Monitor) -> list[tuple[int, np.ndarray, np.ndarray]]:
        """Return the radius of each window, the cells that it lowers by more than level terrain rises, and by how much.

        Whatever the slope, these are the same: they are found once.
        """
        if self._lowered:
            return self._lowered
        opened, lowered, level = self.surface, [], np.zeros(())
        for done, radius in enumerate(self.windows, start=1):
            previous, opened = opened, open_surface(opened, radius, self.is_free_standing)
            fall = (previous - opened).ravel()
            cells = np.flatnonzero(fall > self.rise(level, radius))
            lowered.append((radius, cells, fall[cells]))
            monitor.progress(done / len(self.windows))
        self._lowered.extend(lowered)
        return self._lowered

    def without_joined(self, removed_by: np.ndarray, slope: np.ndarray) -> np.ndarray:
        """Return the mask of cells of objects: free-standing ones, and removed ones whose region does not join it.

        Parameters
        ----------
        removed_by : ndarray of shape (rows, columns), int32
            Radius (cells) of the window that removed each cell, 0 for terrain.
        slope : ndarray of shape (rows, columns), float64
            Slope of the terrain (rise over run).
        """
        objects = (removed_by > 0) | self.is_free_standing
        # Judge cells removed by windows above half the largest separately: together with others, the banks of a cut
        # under a bridge would become an object.
        is_large = removed_by > self.windows[-1] / 2
        sides = [*_sides(self.surface, slope, self.cell_size, self.spacing)]
        for group in (objects & ~is_large, is_large):
            region, count = ndimage.label(group)
            objects &= ~_joining_terrain(region, count, objects, sides)[region] | self.is_free_standing
        return objects

    def _without_level(self, objects: np.ndarray) -> np.ndarray:
        """Return the objects but for smooth parts that are no higher than the terrain around on a share of their area.

        Parts end at steps: of a bank and the bushes on it, removed together, the bank comes back alone.
        """
        candidates = np.where(objects & ~self.is_free_standing, self.surface, np.nan)
        part = smooth_segments(candidates, REMOVAL.join_slope * max(self.cell_size, self.spacing))
        above = self.surface - self._interpolated(objects)
        level, area = np.bincount(part.ravel(), (above <= REMOVAL.step).ravel()), np.bincount(part.ravel())
        is_terrain = level >= REMOVAL.level_share * area
        is_terrain[0] = False
        return objects & ~is_terrain[part]

    def _slope_without(self, objects: np.ndarray) -> np.ndarray:
        """Return the slope of the surface across these cells, as if they were not there."""
        return _slope(self._interpolated(objects), self.cell_size)

    def _interpolated(self, objects: np.ndarray) -> np.ndarray:
        """Return the surface across these cells, as if they were not there."""
        return filled_by_means(self.surface, objects, self.is_nearly_empty)


# Slices of the cells of a surface and of their neighbors on one side, and which cells join these without a step.
_Side = tuple[tuple[slice, ...], tuple[slice, ...], np.ndarray]


def _sides(surface: np.ndarray, slope: np.ndarray, cell_size: float, spacing: float) -> Iterator[_Side]:
    """Yield the four sides of the cells of a surface, in the order of ``adjacent_cells``.

    Low steps join, and those next to which the surface goes on as steeply on either side: the flank of a bank. Flanks
    are measured from point to point, over a spacing where that is more than a cell.
    """
    bank_cells = max(1, round(spacing / cell_size))
    bank = bank_cells * cell_size
    allowed = (REMOVAL.join_slope + REMOVAL.slope_share * slope) * cell_size
    for (here, beside), (fall, fall_beyond) in zip(adjacent_cells(surface.ndim), _flanks(surface, bank_cells)):
        step = surface[here] - surface[beside]
        highest = np.minimum(np.maximum(fall, fall_beyond) + REMOVAL.join_slope * bank, REMOVAL.steepest_bank * bank)
        yield here, beside, (step < allowed[here]) | (step < highest)


def _joining_terrain(region: np.ndarray, count: int, objects: np.ndarray, sides: Iterable[_Side]) -> np.ndarray:
    """Return the mask (count + 1,) of regions, numbered from 1, that join the terrain on enough of their edge.

    Counted are the cells along it that have none of the ``objects`` next to them, one for each side.
    """
    at_edge, joined = np.zeros((2, count + 1), np.int64)
    for here, beside, joins in sides:
        own = region[here]
        is_open = (own > 0) & (region[beside] != own) & ~objects[beside]
        at_edge += np.bincount(own[is_open], minlength=count + 1)
        joined += np.bincount(own[is_open & joins], minlength=count + 1)
    is_terrain = joined >= FREE.most * np.maximum(at_edge, 1)
    is_terrain[0] = False
    return is_terrain


def _windows(largest: float) -> list[int]:
    """Return radii in cells from 1 to ``largest``, each larger than the one before by the factor of growth."""
    radii = [1]
    last = max(1, int(np.ceil(largest)))
    while radii[-1] < last:
        radii.append(min(last, max(radii[-1] + 1, round(radii[-1] * REMOVAL.growth))))
    return radii


def _slope(surface: np.ndarray, cell_size: float) -> np.ndarray:
    """Return the slope (rise over run) that the smoothed surface has around each cell."""
    smooth = ndimage.gaussian_filter(surface, REMOVAL.smoothing / cell_size, mode="nearest")
    # A raster one cell wide has no gradient across.
    axes = [axis for axis in (0, 1) if smooth.shape[axis] > 1]
    gradients = [np.gradient(smooth, cell_size, axis=axis) for axis in axes]
    squares = sum((gradient**2 for gradient in gradients), np.zeros_like(smooth))
    # The slope of a crest itself is zero; means over twice the distance give it the slope of its flanks.
    return np.sqrt(ndimage.gaussian_filter(squares, 2 * REMOVAL.smoothing / cell_size, mode="nearest"))


def _flanks(surface: np.ndarray, apart: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield for each side the fall (m) over ``apart`` cells up to the step there, and over as many cells beyond it.

    In the order of ``adjacent_cells``; it is -inf where the surface ends.
    """
    for axis in range(surface.ndim):
        for upward in (False, True):
            along = np.moveaxis(surface, axis, 0)
            along = along[::-1] if upward else along
            inner, outer = np.full((2, len(along) - 1, *along.shape[1:]), -np.inf)
            inner[apart:] = along[: -apart - 1] - along[apart:-1]
            outer[:-apart] = along[1:-apart] - along[1 + apart :]
            yield tuple(np.moveaxis(flank[::-1] if upward else flank, 0, axis) for flank in (inner, outer))
