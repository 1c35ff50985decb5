"""Objects on the lowest surface: what windows lift off it and what does not go on into the terrain."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..groups import components
from ..packages import ndimage
from ..stage import Monitor
from .opening import open_surface
from .standing import neighbors

# Step that terrain may make over any window, m: kerbs, ruts, tussocks.
_STEP = 0.1

# Slope that terrain may have beside the slope measured around it, and the share of that which it may add.
_FLAT_SLOPE, _SLOPE_SHARE = 0.1, 0.4

# Flat terrain may rise so far within a window of any size, m: less than the lowest of large buildings.
_FLAT_RISE = 1.0

# Slope allowed beside that while the terrain's own is not known yet.
_FIRST_SLOPE = 0.1

# A region that was removed joins the terrain where a step at its edge is not steeper than this plus
# this share of the local slope, and it is terrain when half of its edge does.
_JOIN_SLOPE, _JOIN_SHARE, _JOINED = 0.3, 0.5, 0.5

# What joins the terrain does so on at least this share of its whole edge, other objects beside it included.
_JOINED_OF_ALL = 0.25

# A part of it is terrain, whatever its edge, if this share of it is no more than a step above the terrain around:
# objects stand off the ground everywhere. Parts end at steeper steps than the second; few cells tell nothing.
_TOUCHING, _PART_SLOPE, _LEAST_PART = 0.25, 0.4, 4

# Where the surface goes on as steeply as at the step itself, up to this slope, the step is a bank rather than a wall.
_STEEPEST_BANK = 2.0

# Soil lies on slopes up to 45°, and looks no steeper than this where its lowest points lie unevenly in their cells.
_STEEPEST_SOIL = 1.2

# Windows over this share of the largest lift off spits and hilltops rather than houses.
_LARGE_WINDOW = 0.5

# Windows of the opening grow by this factor.
_GROWTH = 1.25

# Terrain slope is that of a surface smoothed over about the first distance (m), a root mean square over the second:
# on crests and beside cliffs, where windows lift terrain off, it is the flanks' that counts.
_SLOPE_SMOOTHING, _SLOPE_SCALE = 2.0, 4.0


@dataclass(frozen=True)
class Opening:
    """A surface that windows of growing size are to open.

    Attributes
    ----------
    surface : ndarray of shape (rows, columns), float64
        Lowest elevation of each cell, m.
    free : ndarray of shape (rows, columns), bool
        What stands free on it: objects that windows don't see.
    largest : float
        Largest window, m.
    cell_size, spacing : float
        Size of the cells, and spacing of the points where that is more, m.
    """

    surface: np.ndarray
    free: np.ndarray
    largest: float
    cell_size: float
    spacing: float

    @property
    def windows(self) -> list[int]:
        """Radii of the windows, in cells."""
        return _windows(self.largest / 2 / self.cell_size)

    def slope(self, monitor: Monitor) -> np.ndarray:
        """Return the slope of the terrain (rise over run), measured twice, each time without the objects before."""
        first = np.full(self.surface.shape, _FIRST_SLOPE)
        # With what stands free taken away, a low roof beside a higher one is as narrow as it is.
        slope = self._slope_without(self.free | (self._lifted(first, monitor.part(0, 0.5)) > 0))
        return self._slope_without(self._not_joined(slope, monitor.part(0.5, 1)))

    def objects(self, slope: np.ndarray, monitor: Monitor) -> np.ndarray:
        """Return which cells are objects on terrain of this slope."""
        objects = self._not_joined(slope, monitor)
        return _without_touching(objects, self.free, self.surface, _PART_SLOPE * max(self.cell_size, self.spacing))

    def rise(self, slope: np.ndarray) -> np.ndarray:
        """Return how far (m) terrain of such slopes may rise within a cell."""
        return _STEP + (_FLAT_SLOPE + slope) * self.cell_size

    def _slope_without(self, objects: np.ndarray) -> np.ndarray:
        return _slope(_interpolated(self.surface, objects), self.cell_size)

    def _not_joined(self, slope: np.ndarray, monitor: Monitor) -> np.ndarray:
        lifted = self._lifted(_SLOPE_SHARE * slope, monitor)
        return _without_joined(lifted, self.free, self.windows[-1], self.surface, slope, self.cell_size, self.spacing)

    def _lifted(self, slope: np.ndarray, monitor: Monitor) -> np.ndarray:
        return _lifted(self.surface, self.windows, slope, self.cell_size, monitor, absent=self.free)


def nearest_known(surface: np.ndarray, unknown: np.ndarray) -> np.ndarray:
    """Fill unknown cells with the value of the nearest known one."""
    if not unknown.any():
        return surface
    row, column = ndimage.distance_transform_edt(unknown, return_distances=False, return_indices=True)
    return surface[row, column]


def _windows(largest: float) -> list[int]:
    """Return radii in cells from 1 to ``largest``, each a quarter larger than the one before."""
    radii = [1]
    last = max(1, int(np.ceil(largest)))
    while radii[-1] < last:
        radii.append(min(last, max(radii[-1] + 1, round(radii[-1] * _GROWTH))))
    return radii


def _lifted(
    surface: np.ndarray,
    windows: list[int],
    slope: np.ndarray,
    cell_size: float,
    monitor: Monitor,
    absent: Optional[np.ndarray] = None,
) -> np.ndarray:
    """Return the radius of the first window that lifts a cell off by more than terrain of ``slope`` allows, or 0.

    Windows don't see cells that are ``absent``.
    """
    lifted = np.zeros(surface.shape, np.int32)
    opened = surface
    for done, radius in enumerate(windows, start=1):
        previous, opened = opened, open_surface(opened, radius, absent)
        reach = radius * cell_size
        off = previous - opened > _STEP + min(_FLAT_SLOPE * reach, _FLAT_RISE) + slope * reach
        lifted[off & (lifted == 0)] = radius
        monitor.progress(done / len(windows))
    return lifted


def _interpolated(surface: np.ndarray, unknown: np.ndarray) -> np.ndarray:
    """Fill unknown cells with means of the known ones around, over ever larger surroundings."""
    filled = np.where(unknown, np.nan, surface)
    weight = (~unknown).astype(float)
    weighted = np.where(unknown, 0.0, surface)
    scale, widest = 1.0, 4.0 * max(surface.shape)
    while np.isnan(filled).any() and scale < widest:
        share = ndimage.gaussian_filter(weight, scale, mode="nearest")
        mean = ndimage.gaussian_filter(weighted, scale, mode="nearest")
        now = np.isnan(filled) & (share > 1e-3)
        filled[now] = mean[now] / share[now]
        scale *= 2
    return nearest_known(filled, np.isnan(filled)) if np.isfinite(filled).any() else surface


def _slope(surface: np.ndarray, cell_size: float) -> np.ndarray:
    """Return the slope (rise over run) that the smoothed surface has around each cell."""
    smooth = ndimage.gaussian_filter(surface, _SLOPE_SMOOTHING / cell_size, mode="nearest")
    # A raster one cell wide has no gradient across.
    axes = [axis for axis in (0, 1) if smooth.shape[axis] > 1]
    gradients = [np.gradient(smooth, cell_size, axis=axis) for axis in axes]
    squares = sum((gradient**2 for gradient in gradients), np.zeros_like(smooth))
    return np.sqrt(ndimage.gaussian_filter(squares, _SLOPE_SCALE / cell_size, mode="nearest"))


def _without_joined(
    lifted: np.ndarray,
    free: np.ndarray,
    largest: int,
    surface: np.ndarray,
    slope: np.ndarray,
    cell_size: float,
    spacing: float = 0.0,
) -> np.ndarray:
    """Return what stands free, and the lifted cells but for regions that join the terrain smoothly on half their edge.

    A step is smooth if it is low, or if the surface goes on as steeply on one of its sides: the flank of a bank. It is
    one from point to point, so that this is looked for a spacing on, where that is more than a cell. The eaves of a
    roof that reaches down to the ground don't count.
    What smaller windows and what larger windows lifted off make regions of their own: a house stays
    lifted off, though the spit of land on which it stands comes back.
    """
    apart = max(1, round(spacing / cell_size))
    bank = apart * cell_size
    # Within a cell the lowest point may lie anywhere: over two of them that matters less.
    eave = max(2, apart)
    steep = _STEEPEST_SOIL * eave * cell_size
    allowed = (_JOIN_SLOPE + _JOIN_SHARE * slope) * cell_size
    objects = (lifted > 0) | free
    is_large = lifted > _LARGE_WINDOW * largest
    for group in (objects & ~is_large, is_large):
        region, count = ndimage.label(group)
        whole, edge, joined = np.zeros(count + 1), np.zeros(count + 1), np.zeros(count + 1)
        eaves = []
        falls = zip(neighbors(surface.ndim), _flanks(surface, apart), _flanks(surface, eave))
        for (here, there), (inner, outer), (roof, beyond) in falls:
            outward = (region[here] > 0) & (region[there] != region[here])
            at_edge = outward & ~objects[there]
            step = surface[here] - surface[there]
            is_bank = step < np.minimum(np.maximum(inner, outer) + _JOIN_SLOPE * bank, _STEEPEST_BANK * bank)
            smooth = at_edge & ((step < allowed[here]) | is_bank)
            whole += np.bincount(region[here][outward], minlength=count + 1)
            edge += np.bincount(region[here][at_edge], minlength=count + 1)
            joined += np.bincount(region[here][smooth], minlength=count + 1)
            is_eave = smooth & (roof >= steep) & (beyond < steep)
            eaves.append(np.bincount(region[here][is_eave], minlength=count + 1))
        # A roof that reaches down to the ground rises from two sides that face one another, steeper than soil.
        joined -= 2 * (np.minimum(*eaves[:2]) + np.minimum(*eaves[2:]))
        terrain = (joined >= _JOINED * np.maximum(edge, 1)) & (joined >= _JOINED_OF_ALL * whole)
        terrain[0] = False
        objects &= ~terrain[region] | free
    return objects


def _without_touching(objects: np.ndarray, free: np.ndarray, surface: np.ndarray, step: float) -> np.ndarray:
    """Return the objects but for smooth parts that are no higher than the terrain around on a share of their area.

    Parts end at a ``step`` (m) or a higher one: of a bank and the bushes on it, what windows lifted off together, the
    bank comes back alone. What stands ``free`` stays.
    """
    part = _smooth_parts(objects & ~free, surface, step)
    above = surface - _interpolated(surface, objects)
    touching, area = np.bincount(part.ravel(), (above <= _STEP).ravel()), np.bincount(part.ravel())
    terrain = (touching >= _TOUCHING * area) & (area >= _LEAST_PART)
    terrain[0] = False
    return objects & ~terrain[part]


def _smooth_parts(chosen: np.ndarray, surface: np.ndarray, step: float) -> np.ndarray:
    """Label (from 1) the chosen cells that join by less than ``step`` (m) from cell to cell; 0 are all others."""
    number = np.cumsum(chosen).reshape(chosen.shape) - 1
    pairs = []
    # Neighbors come along each axis both ways.
    for here, there in list(neighbors(surface.ndim))[::2]:
        level = chosen[here] & chosen[there] & (np.abs(surface[here] - surface[there]) < step)
        pairs.append(np.stack([number[here][level], number[there][level]]))
    one, other = np.concatenate(pairs, axis=1)
    part = np.zeros(chosen.shape, np.int64)
    part[chosen] = components(one, other, int(chosen.sum()))[1] + 1
    return part


def _flanks(surface: np.ndarray, apart: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield, in the order of ``neighbors``, the fall (m) over so many cells up to each step, and from there on.

    It is -inf where the surface ends.
    """
    for axis in range(surface.ndim):
        for upward in (False, True):
            along = np.moveaxis(surface, axis, 0)
            along = along[::-1] if upward else along
            inner, outer = np.full((2, len(along) - 1, *along.shape[1:]), -np.inf)
            inner[apart:] = along[: -apart - 1] - along[apart:-1]
            outer[:-apart] = along[1:-apart] - along[1 + apart :]
            yield tuple(np.moveaxis(flank[::-1] if upward else flank, 0, axis) for flank in (inner, outer))
