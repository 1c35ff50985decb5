"""Effects of dense image matching on a surface: rounded edges, waves, holes, spikes, and colors."""

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from ..cloud.asprs import PointClass
from ..packages import ndimage
from .beams import is_vegetation
from .height_field import CELL, HeightField, smooth_noise

# Correlated errors of matching: wavelength (m) and relative standard deviation; the total is a tunable.
_WAVES = ((0.6, 0.4), (1.5, 0.5), (4.0, 0.6), (9.0, 0.7))

# Additional errors on crowns, whose leaves move and differ from view to view: wavelength and standard deviation (m).
# With these, simulated crowns are as rough over 0.75 to 2 m as in a real suburb.
_LEAF_NOISE = ((0.6, 0.25), (1.6, 0.3))

# Azimuth of the sun, counterclockwise from east, and its elevation (rad), as on a summer morning.
_SUN = (np.radians(130.0), np.radians(38.0))

# Diffuse light of the sky (red, green, blue), as a share of sunlight.
_SHADE = np.array([0.38, 0.42, 0.5])

# Colors of materials (red, green, blue, 0 to 255), of which each object has one.
_COLORS = {
    # Asphalt, grass and bare soil.
    PointClass.GROUND: np.array([(128, 126, 122), (104, 124, 62), (150, 128, 100)]),
    # Two green plants, a yellow and a red one.
    PointClass.HIGH_VEGETATION: np.array([(62, 92, 40), (84, 110, 50), (92, 98, 44), (120, 74, 60)]),
    # Tiles, slate and metal, bright and dark.
    PointClass.BUILDING: np.array(
        [(150, 76, 56), (112, 66, 56), (96, 97, 102), (132, 110, 92), (222, 222, 218), (60, 60, 64)]
    ),
    # Cars, bright and dark.
    PointClass.UNCLASSIFIED: np.array([(236, 236, 236), (40, 42, 46), (160, 30, 34), (70, 90, 150), (170, 172, 176)]),
}


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
    # Where matching fails, 16 % are spikes with a standard deviation of 0.5 m, and the rest holes.
    spike = fails & (smooth_noise(shape, 0.6, rng) > 1.0)
    top = np.where(spike, top + 0.5 * smooth_noise(shape, 0.5, rng), top)
    return Matched(top, colors, fails & ~spike)


def _fails(field: HeightField, colors: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return the mask of cells where matching fails: patches of about a meter."""
    brightness = colors.mean(axis=2)
    # Shadows have no texture, bright surfaces saturate the images, and cars reflect like mirrors.
    is_difficult = (brightness < 32.0) | (brightness > 205.0) | (field.classification == PointClass.UNCLASSIFIED)
    limits = [NormalDist().inv_cdf(share) for share in (0.005, 0.35)]
    return smooth_noise(field.top.shape, 1.2, rng) < np.where(is_difficult, limits[1], limits[0])


def _rounded(top: np.ndarray, rounding: float, rng: np.random.Generator) -> np.ndarray:
    """Return the surface with rounded edges; the radius varies over the site."""
    if not rounding:
        return top
    # A step smoothed by a Gaussian rises by most of its height over 2.5 standard deviations.
    sigma = rounding / 2.5 / CELL
    sharp, soft = (ndimage.gaussian_filter(top, factor * sigma) for factor in (0.5, 1.5))
    share = np.clip(0.5 + 0.35 * smooth_noise(top.shape, 8.0, rng), 0.0, 1.0)
    return sharp * (1 - share) + soft * share


def _leaf_noise(field: HeightField, rng: np.random.Generator) -> np.ndarray:
    """Return the errors (rows, columns), m, of crowns, 0 elsewhere; some crowns are matched better than others."""
    factor = rng.uniform(0.4, 1.6, int(field.object_id.max()) + 1)[field.object_id]
    errors = sum(deviation * smooth_noise(field.top.shape, length, rng) for length, deviation in _LEAF_NOISE)
    # The roughness of plants below 2 m is limited by their height.
    height = np.clip((field.top - field.ground) / 2.0, 0.0, 1.0)
    return np.where(is_vegetation(field.classification), factor * height * errors, 0.0)


def _materials(field: HeightField, rng: np.random.Generator) -> np.ndarray:
    """Return the colors (rows, columns, 3) of cells in uniform light."""
    shape, number = field.top.shape, field.object_id
    grass, soil = smooth_noise(shape, 25.0, rng), smooth_noise(shape, 12.0, rng)
    colors = _COLORS[PointClass.GROUND][np.where(grass > 0.1, 1, np.where(soil > 0.8, 2, 0))].astype(np.float32)
    kinds = np.where(is_vegetation(field.classification), PointClass.HIGH_VEGETATION, field.classification)
    for kind in (PointClass.HIGH_VEGETATION, PointClass.BUILDING, PointClass.UNCLASSIFIED):
        chosen = kinds == kind
        colors[chosen] = _COLORS[kind][(number[chosen] * 7919 % 104729) % len(_COLORS[kind])]
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
    # Trees and houses of 20 m have shadows of 25 m.
    for away in np.arange(0.2, 25.0, 0.2):
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
    # Heights on crowns have uncorrelated errors of 8 cm, too.
    is_leaf = field.classification[row, column] == PointClass.HIGH_VEGETATION
    z += np.where(is_leaf, 0.08, 0.0) * rng.standard_normal(count)
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
