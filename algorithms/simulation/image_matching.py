"""Effects of dense image matching on a surface: rounded edges, waves, holes, spikes, and colors."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from ..cloud.asprs import PointClass
from ..packages import ndimage
from .beams import is_vegetation
from .height_field import CELL, HeightField, smooth_noise

# Correlated errors of matching: wavelength (m) and relative standard deviation; the total is a tunable.
_WAVES = ((0.6, 0.4), (1.5, 0.5), (4.0, 0.6), (9.0, 0.7))

# Wavelength of the variation of the rounding of edges, m.
_ROUNDING_CHANGES = 8.0

# Additional errors on crowns, whose leaves move and differ from view to view: wavelength and standard deviation (m).
# With these, simulated crowns are as rough over 0.75 to 2 m as in a real suburb.
_LEAF_NOISE = ((0.6, 0.25), (1.6, 0.3))

# Standard deviation (m) of the uncorrelated error of heights on crowns.
_LEAF_SCATTER = 0.08

# Least and greatest factor of the errors of a crown: some crowns are matched better than others.
_LEAF_NOISE_FACTORS = (0.4, 1.6)

# Height (m) from which plants have the full errors of crowns.
_FULL_LEAF_NOISE = 2.0

# Azimuth of the sun, counterclockwise from east, and its elevation (rad), as on a summer morning.
_SUN = (np.radians(130.0), np.radians(38.0))

# Length of the longest shadows (m), cast by trees and houses of 20 m.
_SHADOW_REACH = 25.0

# Diffuse light of the sky (red, green, blue), as a share of sunlight.
_SHADE = np.array([0.38, 0.42, 0.5])

# Color of asphalt (red, green, blue, 0 to 255, as below).
_ASPHALT = (128, 126, 122)

# Color of grass.
_GRASS = (104, 124, 62)

# Color of bare soil.
_SOIL = (150, 128, 100)

# Colors of plants: two green, one yellow, one red.
_LEAVES = np.array([(62, 92, 40), (84, 110, 50), (92, 98, 44), (120, 74, 60)])

# Colors of roofs: tiles, slate and metal, bright and dark.
_ROOFS = np.array([(150, 76, 56), (112, 66, 56), (96, 97, 102), (132, 110, 92), (222, 222, 218), (60, 60, 64)])

# Colors of cars, bright and dark.
_CARS = np.array([(236, 236, 236), (40, 42, 46), (160, 30, 34), (70, 90, 150), (170, 172, 176)])

# Brightness (0 to 255) below which matching is difficult: shadows have no texture.
_DARK = 32.0

# Brightness (0 to 255) above which matching is difficult: the images are saturated.
_BRIGHT = 205.0

# Share of difficult surfaces where matching fails.
_FAILS = 0.35

# Share of cars, which reflect like mirrors, where matching fails.
_FAILS_ON_CARS = 0.35

# Share of other surfaces where matching fails.
_FAILS_ELSEWHERE = 0.005

# Where matching fails, there is a spike if smooth noise of unit deviation exceeds this (16 %), otherwise a hole.
_SPIKES_ABOVE = 1.0

# Standard deviation (m) of the heights of spikes.
_SPIKE = 0.5


@dataclass(frozen=True)
class Matched:
    """The matched surface."""

    top: np.ndarray  #: (rows, columns): elevations, m
    colors: np.ndarray  #: (rows, columns, 3): red, green and blue, 0 to 255
    is_hole: np.ndarray  #: (rows, columns), bool: cells without points


def match(field: HeightField, rounding: float, waves: float, rng: np.random.Generator) -> Matched:
    """Return the surface that matching reconstructs.

    Parameters
    ----------
    field : HeightField
        The true surface.
    rounding : float
        Mean distance (m) over which edges are rounded; it varies from half to one and a half times this.
    waves : float
        Standard deviation (m) of correlated errors.
    rng : Generator
        Source of random numbers.
    """
    shape = field.top.shape
    colors = _lit(field, _materials(field, rng), rng)
    top = _rounded(field.top, rounding, rng)
    shared = sum(share * smooth_noise(shape, length, rng) for length, share in _WAVES)
    # Errors of matching are larger on roofs, which have little texture.
    by_texture = np.where(field.classification == PointClass.BUILDING, 1.2, 0.8)
    top = top + waves * shared / np.sqrt(sum(share**2 for _, share in _WAVES)) * by_texture
    top += _leaf_noise(field, rng)
    fails = _fails(field, colors, rng)
    spike = fails & (smooth_noise(shape, 0.6, rng) > _SPIKES_ABOVE)
    top = np.where(spike, top + _SPIKE * smooth_noise(shape, 0.5, rng), top)
    return Matched(top, colors, fails & ~spike)


def _fails(field: HeightField, colors: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return the mask of cells where matching fails: patches of about a meter."""
    brightness = colors.mean(axis=2)
    is_difficult = (brightness < _DARK) | (brightness > _BRIGHT)
    is_car = field.classification == PointClass.UNCLASSIFIED
    patches = smooth_noise(field.top.shape, 1.2, rng)
    chances = ((~is_difficult, _FAILS_ELSEWHERE), (is_difficult, _FAILS), (is_car, _FAILS_ON_CARS))
    return np.any([of & (patches < NormalDist().inv_cdf(chance)) for of, chance in chances], axis=0)


def _rounded(top: np.ndarray, rounding: float, rng: np.random.Generator) -> np.ndarray:
    """Return the surface with rounded edges; the radius varies over the site."""
    if not rounding:
        return top
    # A step smoothed by a Gaussian rises by most of its height over 2.5 standard deviations.
    sigma = rounding / 2.5 / CELL
    sharp, soft = (ndimage.gaussian_filter(top, factor * sigma) for factor in (0.5, 1.5))
    share = np.clip(0.5 + 0.35 * smooth_noise(top.shape, _ROUNDING_CHANGES, rng), 0.0, 1.0)
    return sharp * (1 - share) + soft * share


def _leaf_noise(field: HeightField, rng: np.random.Generator) -> np.ndarray:
    """Return the errors (rows, columns), m, of crowns, 0 elsewhere; each crown has its own factor."""
    factor = rng.uniform(*_LEAF_NOISE_FACTORS, int(field.object_id.max()) + 1)[field.object_id]
    errors = sum(deviation * smooth_noise(field.top.shape, length, rng) for length, deviation in _LEAF_NOISE)
    # The roughness of a low plant is limited by its height.
    height = np.clip((field.top - field.ground) / _FULL_LEAF_NOISE, 0.0, 1.0)
    return np.where(is_vegetation(field.classification), factor * height * errors, 0.0)


def _materials(field: HeightField, rng: np.random.Generator) -> np.ndarray:
    """Return the colors (rows, columns, 3) of cells in uniform light."""
    shape, number = field.top.shape, field.object_id
    grass, soil = smooth_noise(shape, 25.0, rng), smooth_noise(shape, 12.0, rng)
    ground = np.where((grass > 0.1)[..., None], _GRASS, np.where((soil > 0.8)[..., None], _SOIL, _ASPHALT))
    colors = ground.astype(np.float32)
    for chosen, palette in (
        (is_vegetation(field.classification), _LEAVES),
        (field.classification == PointClass.BUILDING, _ROOFS),
        (field.classification == PointClass.UNCLASSIFIED, _CARS),
    ):
        colors[chosen] = palette[(number[chosen] * 7919 % 104729) % len(palette)]
    texture = 1 + 0.08 * smooth_noise(shape, 0.4, rng) + 0.06 * smooth_noise(shape, 3.0, rng)
    return colors * texture[..., None]


def _lit(field: HeightField, colors: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return colors under direct light by angle of incidence, and diffuse light."""
    azimuth, elevation = _SUN
    sun = np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)])
    north, east = np.gradient(field.top, CELL)
    steep = np.sqrt(1 + east**2 + north**2)
    facing = np.clip((sun[2] - sun[0] * east - sun[1] * north) / steep, 0.0, 1.0)
    direct = facing * ~_shadowed(field.top, azimuth, elevation)
    light = _SHADE + direct[..., None] * (1.15 - _SHADE)
    noise = 1 + 0.03 * rng.standard_normal(field.top.shape)
    return np.clip(colors * light * noise[..., None], 0.0, 255.0)


def _shadowed(top: np.ndarray, azimuth: float, elevation: float) -> np.ndarray:
    """Return the mask of cells in the shadow of others."""
    shadowed = np.zeros(top.shape, bool)
    for away in np.arange(0.2, _SHADOW_REACH, 0.2):
        rows, columns = (round(away / CELL * part) for part in (np.sin(azimuth), np.cos(azimuth)))
        shadowed |= _moved(top, rows, columns) > top + away * np.tan(elevation) + 0.05
    return shadowed


def _moved(values: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """Return the raster shifted by rows and columns; beyond the edge, values of the edge repeat."""
    row = np.clip(np.arange(values.shape[0]) + rows, 0, values.shape[0] - 1)
    column = np.clip(np.arange(values.shape[1]) + columns, 0, values.shape[1] - 1)
    return values[np.ix_(row, column)]


def sample(
    field: HeightField, matched: Matched, density: float, walls: float, noise: float, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sample points on a matched surface.

    Parameters
    ----------
    field, matched
        The true and the matched surface.
    density : float
        Points per square meter in plan.
    walls : float
        Density on steep faces, as a share of the density in plan.
    noise : float
        Standard deviation of uncorrelated errors, m.
    rng : Generator
        Source of random numbers.

    Returns
    -------
    xyz : ndarray of shape (n, 3)
        Points (m).
    row, column : ndarray of shape (n,)
        Cell of each point.
    """
    rows, columns = field.top.shape
    count = round(density * rows * columns * CELL**2)
    xy = rng.uniform(0.0, [columns * CELL, rows * CELL], (count, 2))
    row, column = field.at(xy)
    kept = ~matched.is_hole[row, column]
    # Elevations are interpolated between the centers of cells.
    z = ndimage.map_coordinates(matched.top, (xy / CELL - 0.5).T[::-1], order=1, mode="nearest")
    is_leaf = field.classification[row, column] == PointClass.HIGH_VEGETATION
    z += np.where(is_leaf, _LEAF_SCATTER, 0.0) * rng.standard_normal(count)
    faces = _faces(matched, density * walls, rng)
    xyz = np.concatenate([np.column_stack([xy, z])[kept], faces])
    xyz += noise * rng.standard_normal(xyz.shape)
    inside = ((xyz[:, :2] >= 0) & (xyz[:, :2] < [columns * CELL, rows * CELL])).all(axis=1)
    xyz = xyz[inside]
    return xyz, *field.at(xyz[:, :2])


def _faces(matched: Matched, density: float, rng: np.random.Generator) -> np.ndarray:
    """Sample points (n, 3), m, by area on the steep faces between neighboring cells: smeared walls."""
    parts = []
    for axis in (0, 1):
        # At the last cell the step is 0.
        low = matched.top
        high = _moved(low, 1, 0) if axis == 0 else _moved(low, 0, 1)
        drop = np.abs(high - low)
        # Gentle slopes are sampled from above; walls are often missing over meters.
        drop = np.where((drop > CELL) & ~matched.is_hole, drop - CELL, 0.0)
        seen = smooth_noise(drop.shape, 6.0, rng) > -0.3
        count = rng.poisson(drop * seen * CELL * density)
        row, column = np.nonzero(count)
        times = count[row, column]
        row, column = np.repeat(row, times), np.repeat(column, times)
        share = rng.random(len(row))
        z = low[row, column] * (1 - share) + high[row, column] * share
        position = np.column_stack([column, row]) + rng.random((len(row), 2))
        position[:, 1 - axis] = np.column_stack([column, row])[:, 1 - axis] + 0.5 + share
        parts.append(np.column_stack([position * CELL, z]))
    return np.concatenate(parts)
