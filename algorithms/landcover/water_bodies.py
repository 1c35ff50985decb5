"""Water bodies: areas that give few pulses back, whose ground is level and lower than what surrounds it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.grid import EIGHT, raster_cells, refuse_sparse
from ..geometry.groups import least_of
from ..packages import ndimage
from ..stage import Monitor

# Distance (m) within which other points decide whether the surface at a point is level. Gaps of the cloud up to twice
# as wide are filled.
REACH = 10.0


@dataclass(frozen=True)
class _Rules:
    """What water is to a laser: most pulses are reflected away from the sensor, the others return from one level."""

    least_cell: float = 1.0  #: Least side of the cells, m
    cell_spacings: float = 1.5  #: Least side of the cells in point spacings, so that cells of land hold a point
    window: float = 5.0  #: Side (m) of the square in which pulses are counted: the least width of a ditch that is seen
    most_pulses: float = 0.5  #: Most pulses, as a share of land's: canals and simulated rivers give 0.1 to 0.4
    most: float = 0.5  #: Least share of a body's ground that has its level, and of the ground around it that is higher
    #: Quantile of the cells by their pulses that is land in one flight line: others lie in two, fewer in water
    land: float = 0.25
    #: Largest difference of height (m) on water within 10 m: waves, and the fall of rivers that are not torrents
    level: float = 0.15
    ring: int = 3  #: Width (cells) of the surroundings of water, and of the strip in which pulses from land hide it


_RULES = _Rules()


def water_levels(
    xyz: np.ndarray, is_ground: np.ndarray, is_pulse: np.ndarray, spacing: float, min_area: float, monitor: Monitor
) -> np.ndarray:
    """Return the elevation (n,) of the water at each point, m; NaN without water.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points without noise, m, from the corner of the cloud.
    is_ground : ndarray of shape (n,), bool
        Points that a ground filter took for ground; water is among them.
    is_pulse : ndarray of shape (n,), bool
        One point of each pulse.
    spacing : float
        Point spacing, m.
    min_area : float
        Area of the smallest water body, m².
    monitor : Monitor
        Receives progress.
    """
    size = max(_RULES.least_cell, _RULES.cell_spacings * spacing)
    refuse_sparse(xyz, size)
    row, column = raster_cells(xyz, size, 0)
    shape = int(row.max()) + 1, int(column.max()) + 1
    cell = row * shape[1] + column
    lowest = least_of(xyz[is_ground, 2], cell[is_ground], shape[0] * shape[1]).reshape(shape)
    has_ground = np.isfinite(lowest)
    monitor.progress(0.3)
    is_seen = (np.bincount(cell, minlength=lowest.size) > 0).reshape(lowest.shape)
    pulses = np.bincount(cell[is_pulse], minlength=lowest.size).reshape(lowest.shape).astype(float)
    is_sparse = _sparse(pulses, is_seen, size)
    radius = int(np.ceil(REACH / size))
    around = ndimage.minimum_filter(lowest, 2 * radius + 1)
    is_low = has_ground & (lowest <= around + _RULES.level)
    monitor.progress(0.6)
    body, level = _bodies(is_sparse & (is_low | ~has_ground), is_low, lowest, min_area / size**2)
    if level is None:
        return np.full(len(xyz), np.nan)
    # Next to land, pulses that come back from it hide that water gives few.
    with_edge = ndimage.binary_dilation(body, EIGHT, iterations=_RULES.ring)
    monitor.progress(0.9)
    return np.where(with_edge, level, np.nan)[row, column]


def _sparse(pulses: np.ndarray, is_seen: np.ndarray, size: float) -> np.ndarray:
    """Return the mask of cells inside the cloud that are amid few pulses."""
    inside = _without_gaps(is_seen, REACH / size)
    side = 2 * round(_RULES.window / size / 2) + 1
    covered = ndimage.uniform_filter(inside.astype(float), side, mode="constant")
    density = ndimage.uniform_filter(pulses, side, mode="constant") / np.maximum(covered, 1 / side**2)
    return inside & (density < _RULES.most_pulses * np.quantile(density[is_seen], _RULES.land))


def _without_gaps(is_seen: np.ndarray, reach: float) -> np.ndarray:
    """Return the cells of the cloud with the gaps in it, up to twice as wide as ``reach`` (cells)."""
    near = ndimage.distance_transform_edt(~is_seen) <= reach
    # The end of the raster is no end of the surroundings: water goes on beyond a tile.
    return is_seen | (ndimage.distance_transform_edt(np.pad(near, 1, constant_values=True))[1:-1, 1:-1] > reach)


def _bodies(
    candidates: np.ndarray, is_low: np.ndarray, lowest: np.ndarray, min_cells: float
) -> tuple[np.ndarray, Optional[np.ndarray]]:
    """Return the cells of water bodies, and the level at each cell: the nearest water's; or None."""
    part, _ = ndimage.label(candidates, EIGHT)
    size, seen = np.bincount(part.ravel()), np.bincount(part[is_low], minlength=part.max() + 1)
    is_water = np.zeros(candidates.shape, bool)
    shows_level = np.zeros(candidates.shape, bool)
    for number, tight in enumerate(ndimage.find_objects(part), 1):
        if size[number] < min_cells or not seen[number]:
            continue
        box = tuple(slice(max(0, side.start - _RULES.ring), side.stop + _RULES.ring) for side in tight)
        inside = part[box] == number
        on_level = _on_level(inside, is_low[box], lowest[box])
        if on_level is not None:
            is_water[box] |= inside
            shows_level[box] |= on_level
    if not shows_level.any():
        return is_water, None
    nearest = ndimage.distance_transform_edt(~shows_level, return_distances=False, return_indices=True)
    return is_water, lowest[tuple(nearest)]


def _on_level(inside: np.ndarray, is_low: np.ndarray, lowest: np.ndarray) -> Optional[np.ndarray]:
    """Return the cells of a part that have its level, or None where it is not level or not lower than its banks."""
    seen = inside & is_low
    level = float(np.median(lowest[seen]))
    on_level = seen & (np.abs(lowest - level) <= _RULES.level)
    banks = ndimage.binary_dilation(inside, EIGHT, iterations=_RULES.ring) & ~inside & np.isfinite(lowest)
    if on_level.sum() < _RULES.most * seen.sum() or not banks.any():
        return None
    return on_level if (lowest[banks] > level + _RULES.level).mean() >= _RULES.most else None
