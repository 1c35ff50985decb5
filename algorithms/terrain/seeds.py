"""Seeds of the terrain: points that are ground beyond doubt, from which a TIN can grow."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..cloud.cells import plan_box, refuse_sparse
from ..groups import components
from ..packages import ndimage
from ..stage import Monitor
from .opening import open_surface
from .standing import free_standing, neighbors

# Step that terrain may make over any window, m: kerbs, ruts, tussocks.
_STEP = 0.1

# Slope that terrain may have beside the slope measured around it, and the share of that which it may add.
_FLAT_SLOPE, _SLOPE_SHARE = 0.1, 0.4

# Flat terrain may rise so far within a window of any size, m: less than the lowest of large buildings.
_FLAT_RISE = 1.0

# Slope allowed beside that while the terrain's own is not known yet.
_FIRST_SLOPE = 0.1

# A pit steeper than this on all sides is multipath, not terrain (5 m deep in a cell of 1 m), unless within so far (m)
# this share of the cells is as deep: a tenth of the pulses reach the ground of dense forest, far fewer go astray.
_PIT_SLOPE, _PIT_REACH, _PIT_SHARE = 5.0, 10.0, 0.1

# Cells are looked at one by one up to so far, and in as many steps beyond.
_PIT_STEPS = 10

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

# Without a largest building given, windows go up to this size (m); larger halls stand free.
USUAL_BUILDING = 60.0

# Windows over this share of the largest lift off spits and hilltops rather than houses.
_LARGE_WINDOW = 0.5

# Windows of the opening grow by this factor.
_GROWTH = 1.25

# Terrain slope is that of a surface smoothed over about the first distance (m), a root mean square over the second:
# on crests and beside cliffs, where windows lift terrain off, it is the flanks' that counts.
_SLOPE_SMOOTHING, _SLOPE_SCALE = 2.0, 4.0


@dataclass
class Lowest:
    """Lowest points of cells, ``index`` (rows, columns), -1 where empty; cell size (m), number of each point's cell."""

    index: np.ndarray
    cell_size: float
    cell: np.ndarray

    def points(self, chosen: np.ndarray) -> np.ndarray:
        """Return the indices of the points of the chosen, occupied cells."""
        index = self.index[chosen]
        return index[index >= 0]

    def at_points(self, values: np.ndarray) -> np.ndarray:
        """Return the value (n,) of each point's cell."""
        return values.ravel()[self.cell]


def lowest_points(xyz: np.ndarray, cell_size: float) -> Lowest:
    """Return the lowest point of each square cell of ``cell_size`` (m); refuse points that are spread too thinly."""
    refuse_sparse(xyz, cell_size)
    x, y, z = xyz.T
    west, south = plan_box(xyz)[0]
    row, column = (np.floor((axis - start) / cell_size).astype(np.int32) for axis, start in ((x, west), (y, south)))
    shape = int(row.max()) + 1, int(column.max()) + 1
    cell = np.ravel_multi_index((row, column), shape)
    least = np.full(shape, np.inf)
    np.minimum.at(least.ravel(), cell, z)
    as_low = np.flatnonzero(z == least.ravel()[cell])
    # The last one that is written stays: ties go to the south-west, whatever the order.
    as_low = as_low[np.lexsort((-y[as_low], -x[as_low]))]
    index = np.full(shape, -1, np.int64)
    index.ravel()[cell[as_low]] = as_low
    return Lowest(index, cell_size, cell)


def seeds_by_opening(
    xyz: np.ndarray, cell_size: float, max_building_size: Optional[float], monitor: Monitor, spacing: float = 0.0
) -> tuple[np.ndarray, np.ndarray, float]:
    """Find ground points by opening the lowest surface with growing windows.

    What stands free with steps down all round is an object, and so is what a window lifts off the surface by more
    than terrain of the local slope allows; of the latter, what joins the terrain smoothly on half of its edge comes
    back, and so do smooth parts that lie in the terrain around.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    cell_size : float
        Cell of the surface, m.
    max_building_size : float, optional
        Least extent of the largest building, m: the last window. None is 60 m, and any size for what stands free.
    monitor : Monitor
        Hears progress.
    spacing : float
        Point spacing (m), where that is more than a cell.

    Returns
    -------
    seeds : ndarray of shape (m,), int64
        Indices of the seeds.
    stands_free : ndarray of shape (n,), bool
        Points of what stands free, or over it: no terrain.
    size : float
        Least extent of the largest building that was looked for or found, m.

    Notes
    -----
    Progressive opening after Pingel et al. (2013), with a threshold that follows the slope of the result before, a
    coarse one first; the return of smoothly joined regions is this project's, and so are the segments that
    stand free. By these, low houses with large roofs on a slope are found, which windows shave down little by little,
    and halls that no window is large enough for.

    References
    ----------
    Pingel, T. J., Clarke, K. C., McBride, W. A., 2013. An improved simple morphological filter for the terrain
    classification of airborne LIDAR data. ISPRS Journal of Photogrammetry and Remote Sensing 77, 21-30.
    """
    lowest = lowest_points(xyz, cell_size)
    surface, known = _surface(xyz, lowest, monitor.part(0, 0.1))
    size = max_building_size or USUAL_BUILDING
    windows = _windows(size / 2 / cell_size)
    free, found = free_standing(surface, cell_size, size, max_building_size or np.inf, spacing, monitor.part(0.1, 0.3))
    first = np.full(surface.shape, _FIRST_SLOPE)
    # With what stands free taken away, a low roof beside a higher one is as narrow as it is.
    objects = free | (_lifted(surface, windows, first, cell_size, monitor.part(0.3, 0.5), absent=free) > 0)
    for start in (0.5, 0.75):
        slope = _slope(_interpolated(surface, objects), cell_size)
        part = monitor.part(start, start + 0.25)
        lifted = _lifted(surface, windows, _SLOPE_SHARE * slope, cell_size, part, absent=free)
        objects = _without_joined(lifted, free, windows[-1], surface, slope, cell_size, spacing)
    objects = _without_touching(objects, free, surface, _PART_SLOPE * max(cell_size, spacing))
    monitor.progress(1.0)
    # What is seen through a roof as through a pit lies lower than the surface there.
    stands_free = lowest.at_points(free) & (xyz[:, 2] >= lowest.at_points(surface))
    return lowest.points(known & ~objects), stands_free, max(size, found)


def seeds_by_lowest(xyz: np.ndarray, max_building_size: float) -> np.ndarray:
    """Return the lowest point (its index) of each cell as large as the largest building, as Axelsson does."""
    lowest = lowest_points(xyz, max_building_size)
    return lowest.points(lowest.index >= 0)


def _surface(xyz: np.ndarray, lowest: Lowest, monitor: Monitor) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest surface without gaps and pits, and where it is a point's own height."""
    empty = lowest.index < 0
    height = np.where(empty, np.inf, xyz[lowest.index, 2])
    unknown = empty | _pits(height, lowest.cell_size, monitor)
    return _nearest(height, unknown), ~unknown


def _pits(height: np.ndarray, cell_size: float, monitor: Monitor) -> np.ndarray:
    """Return which cells hold stray points far below all others around, by their heights (inf where empty).

    Ground seen through the gaps of a forest is as far below the crowns beside it, but other gaps are near.
    """
    depth = _PIT_SLOPE * cell_size
    surface = _nearest(height, np.isinf(height))
    pits = (surface + open_surface(-surface, 1) < -depth) & np.isfinite(height)
    row, column = np.nonzero(pits)
    reach = max(1, round(_PIT_REACH / cell_size))
    step = -(-reach // _PIT_STEPS)
    offsets = step * np.arange(-(reach // step), reach // step + 1)
    around = np.pad(height, reach, constant_values=np.inf)
    level = height[row, column] + depth
    n_deep, n_known = np.zeros((2, len(row)))
    for done, down in enumerate(offsets, start=1):
        for right in offsets:
            other = around[row + reach + down, column + reach + right]
            n_deep += other < level
            n_known += np.isfinite(other)
        monitor.progress(done / len(offsets))
    # The cell itself is among them.
    pits[row, column] = n_deep - 1 < _PIT_SHARE * n_known
    return pits


def _nearest(surface: np.ndarray, unknown: np.ndarray) -> np.ndarray:
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
    return _nearest(filled, np.isnan(filled)) if np.isfinite(filled).any() else surface


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
    one from point to point, so that this is looked for a spacing on, where that is more than a cell.
    What smaller windows and what larger windows lifted off make regions of their own: a house stays
    lifted off, though the spit of land on which it stands comes back.
    """
    apart = max(1, round(spacing / cell_size))
    bank = apart * cell_size
    allowed = (_JOIN_SLOPE + _JOIN_SHARE * slope) * cell_size
    objects = (lifted > 0) | free
    is_large = lifted > _LARGE_WINDOW * largest
    for group in (objects & ~is_large, is_large):
        region, count = ndimage.label(group)
        whole, edge, joined = np.zeros(count + 1), np.zeros(count + 1), np.zeros(count + 1)
        for (here, there), flank in zip(neighbors(surface.ndim), _flanks(surface, apart)):
            outward = (region[here] > 0) & (region[there] != region[here])
            at_edge = outward & ~objects[there]
            step = surface[here] - surface[there]
            is_bank = step < np.minimum(flank + _JOIN_SLOPE * bank, _STEEPEST_BANK * bank)
            smooth = at_edge & ((step < allowed[here]) | is_bank)
            whole += np.bincount(region[here][outward], minlength=count + 1)
            edge += np.bincount(region[here][at_edge], minlength=count + 1)
            joined += np.bincount(region[here][smooth], minlength=count + 1)
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


def _flanks(surface: np.ndarray, apart: int) -> Iterator[np.ndarray]:
    """Yield, in the order of ``neighbors``, the larger rise (m) of so many cells before and after each step."""
    for axis in range(surface.ndim):
        for upward in (False, True):
            along = np.moveaxis(surface, axis, 0)
            along = along[::-1] if upward else along
            flank = np.full((len(along) - 1, *along.shape[1:]), -np.inf)
            flank[apart:] = along[: -apart - 1] - along[apart:-1]
            flank[:-apart] = np.maximum(flank[:-apart], along[1:-apart] - along[1 + apart :])
            yield np.moveaxis(flank[::-1] if upward else flank, 0, axis)
