"""Water: few returns, of one level, lower than the ground around."""

from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..criteria import DEVIATIONS, MAJORITY
from ..geometry.grid import EIGHT, raster_cells, refuse_sparse
from ..geometry.groups import least_of
from ..geometry.raster_filling import nearest_known
from ..packages import ndimage
from ..params import SURFACE_NOISE
from ..rules import rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..stage import Monitor, stage, tunable

# Points of these classes may be water, by their height.
_OPEN = (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED, PointClass.GROUND, PointClass.WATER)

# Distance (m) within which other points decide whether the surface at a point is level. Gaps of the cloud up to twice
# as wide are filled.
_REACH = 10.0


@rules
class _RULES:
    """What water is to a laser: most pulses are reflected away from the sensor, the others return from one level."""

    least_cell: float = 1.0  #: Least side of the cells, m
    cell_spacings: float = 1.5  #: Least side of the cells in point spacings, so that cells of land hold a point
    window: float = 5.0  #: Side (m) of the square in which pulses are counted: the least width of a ditch that is seen
    most_pulses: float = 0.5  #: Most pulses, as a share of land's: canals and simulated rivers give 0.1 to 0.4
    #: Quantile of the cells by their pulses that is land in one flight line: others lie in two, fewer in water
    land: float = 0.25
    #: Largest difference of height (m) on water within 10 m: waves, and the fall of rivers that are not torrents
    level: float = 0.15
    ring: int = 3  #: Width (cells) of the surroundings of water, and of the strip in which pulses from land hide it


@stage(
    "Land cover",
    tags="water,river,canal,lake,pond,hydrography,shore,bank,breakline,hydro flattening",
    writes=("classification",),
    reach=_REACH,
    cost=0.5,
)
def classify_water(
    xyz,
    classification,
    return_number=None,
    *,
    look_for: bool = tunable(True, label="Look for water"),
    min_area: float = tunable(50.0, label="Minimum water area", within="[10, 1_000_000] m²"),
    noise: Optional[float] = SURFACE_NOISE,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Classify the points on water: where few pulses came back, from one level, lower than the ground around.

    Still water reflects most pulses away from the sensor. Where an area in the cloud has less than half of the pulses
    that land has, the ground in it is level and most of the ground around it is higher, it is water (9). Streams whose
    surface reflects as land does and falls by more than 1 % are not found. Clouds of matched images are left as they
    are.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes with ground (2); ground filters classify water as ground, too.
    return_number : ndarray of shape (n,), uint8, optional
        Only first returns are counted as pulses; without it all points are.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        The same with water (9) for points of 0, 1 and 2 on it. Earlier water (9) elsewhere stays.

    Other Parameters
    ----------------
    look_for
        If not, no class changes. For models that contain this step.
    min_area
        Area of the smallest water body to be found.

    Raises
    ------
    ValueError
        If there are no ground points.

    Notes
    -----
    Gaps up to 20 m wide belong to the cloud. Shadows of buildings are gaps, too, but the ground in them is as high as
    next to them; roofs are no ground. A point is on water if its height differs from the nearest lowest point
    of the water body by at most three standard deviations of the noise. It also lies at most three cells from the body.

    References
    ----------
    Höfle, B., Vetter, M., Pfeifer, N., Mandlburger, G., Stötter, J., 2009. Water surface mapping from airborne laser
    scanning using signal intensity and elevation data. Earth Surface Processes and Landforms 34(12), 1635-1649.
    [hoefle2009]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> bool((classify_water(xyz, classes) == 9).any())
    False
    """
    classes = classification.astype(np.uint8)
    if not look_for:
        return classes
    if not (classification == PointClass.GROUND).any():
        raise ValueError("No ground points (class 2); run 'Classify ground points (TIN)' first.")
    noise = sampling.noise if noise is None else noise
    monitor.resolved(noise=noise)
    if sampling.is_closed_surface():
        return classes
    used = not_noise(classification)
    points = sampling.from_corner(xyz.take(used, axis=0))
    is_ground = np.isin(classification[used], (PointClass.GROUND, PointClass.WATER))
    is_numbered = return_number is not None and return_number.any()
    is_pulse = return_number[used] == 1 if is_numbered else np.ones(len(used), bool)
    level = water_levels(points, is_ground, is_pulse, sampling.spacing, min_area, monitor)
    is_water = np.abs(points[:, 2] - level) <= DEVIATIONS * noise
    classes[used[is_water & np.isin(classification[used], _OPEN)]] = PointClass.WATER
    return classes


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
    around = ndimage.minimum_filter(lowest, 2 * int(np.ceil(_REACH / size)) + 1)
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
    inside = _without_gaps(is_seen, _REACH / size)
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
    level = nearest_known(lowest, ~shows_level) if shows_level.any() else None
    return is_water, level


def _on_level(inside: np.ndarray, is_low: np.ndarray, lowest: np.ndarray) -> Optional[np.ndarray]:
    """Return the cells of a part that have its level, or None where it is not level or not lower than its banks."""
    seen = inside & is_low
    level = float(np.median(lowest[seen]))
    on_level = seen & (np.abs(lowest - level) <= _RULES.level)
    banks = ndimage.binary_dilation(inside, EIGHT, iterations=_RULES.ring) & ~inside & np.isfinite(lowest)
    if on_level.sum() < MAJORITY * seen.sum() or not banks.any():
        return None
    return on_level if (lowest[banks] > level + _RULES.level).mean() >= MAJORITY else None
