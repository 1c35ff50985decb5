"""A site from matched drone images with their errors: closed crowns, rounded edges, waves, holes, colors."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from ..cloud.asprs import PointClass
from ..packages import ndimage
from ..params import SEED
from ..stage import Layer, stage, tunable
from .beams import is_vegetation
from .bodies import Rect, flat
from .height_field import CELL, HeightField, see_from_above, smooth_noise
from .scanner import refuse_large
from .scene import Scene, footprint_fields, footprint_layer
from .town_houses import Site
from .town_layout import CAR, MAX_BUILDINGS, TownPlan, build_town, park_car

# Height (m) above which points over cells of ground belong to the nearest object, whose edge is smeared.
_SMEARED = 0.3

_FIELDS = footprint_fields("gable, hip, flat, L, row, shed or hall")[:3]

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


@stage(
    "Simulation",
    tags="synthetic,drone,UAV,photogrammetry,dense matching,color,shadow,demo,example,test,truth,teaching",
    creates=("xyz", "classification", "return_number", "number_of_returns", "red", "green", "blue", "segment_id"),
    layers=(Layer("footprints", "True footprints", "Polygon", _FIELDS),),
)
def simulate_drone_site(
    *,
    size: float = tunable(150.0, within="[40, 400] m"),
    density: float = tunable(40.0, label="Point density", within="[5, 400] points/m²"),
    slope: float = tunable(4.0, within="[0, 20]°"),
    terrace_height: float = tunable(1.5, label="Height of terraces", within="[0, 3] m"),
    buildings: float = tunable(16.0, within=f"[0, {MAX_BUILDINGS}] per ha"),
    trees: float = tunable(30.0, within="[0, 200] per ha"),
    halls: int = tunable(2, label="Flat halls", within="[0, 20]"),
    unevenness: float = tunable(0.12, label="Unevenness of the ground", within="[0, 0.5] m"),
    rounding: float = tunable(0.5, label="Rounding of edges", within="[0, 2] m"),
    waves: float = tunable(0.03, within="[0, 0.3] m"),
    walls: float = tunable(0.6, label="Share of walls", within="[0, 1]"),
    noise: float = tunable(0.01, within="[0, 0.2] m"),
    seed: int = SEED,
    monitor=None,
):
    """Simulate a point cloud from matched drone images, with typical errors of matching and the true class of points.

    The site has houses on slopes and terraces, sheds, rows, blocks of flat roofs, halls with parapets, cars, vans,
    trees, hedges and bushes. Crowns are closed lumpy surfaces. Edges are rounded, walls are smeared or missing, and
    surfaces are wavy. Dark, bright and reflecting surfaces have holes and spikes. Colors depend on material and light.

    Returns
    -------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m).
    classification : ndarray of shape (n,), uint8
        True class: 2 ground; 3, 4, 5 vegetation under 0.5 m, under 2 m and higher; 6 buildings; 1 cars and vans.
    return_number, number_of_returns : ndarray of shape (n,), uint8
        Always 1.
    red, green, blue : ndarray of shape (n,), uint16
        Colors.
    segment_id : ndarray of shape (n,), int32
        Number of the object, the same for all points of a building; 0 for ground.
    footprints : LayerFeatures
        Outlines of the walls of all buildings.

    Other Parameters
    ----------------
    size
        Side of the site, a square from (0, 0).
    density
        Point density on open ground, in plan.
    slope
        Mean slope of the ground.
    terrace_height
        Rise of each terrace.
    buildings
        Houses per hectare of streets and plots.
    trees
        Trees in gardens.
    halls
        Halls with flat roofs and parapets, 10 to 100 m long, if space permits.
    unevenness
        Standard deviation of the ground from the smooth slope, due to gardens, curbs and ruts.
    rounding
        Mean distance over which eaves and ridges are rounded.
    waves
        Standard deviation of errors that are correlated between neighboring points.
    walls
        Point density on walls, as a share of the density on open ground.
    noise
        Standard deviation of uncorrelated errors, the same in every direction.

    Raises
    ------
    ValueError
        If there would be more than 30 million points.

    Notes
    -----
    The true surface is a raster with cells of 0.1 m. Matching makes it smoother and adds correlated errors; points are
    sampled on the result. Steps are smoothed by Gaussians whose width varies over the site from half to one and a half
    times the mean. Points smeared beyond the edge of an object, ``_SMEARED`` m above the ground or more, belong to the
    object.

    Unevenness of the ground, waves and roughness of crowns match two real clouds, of a suburb and a beach. Open ground
    deviates from planes by 1 to 1.3 cm over 1 m and by 3 to 5 cm over 4 m.

    Not simulated: surfaces under eaves, crowns and bridges, double surfaces, seams between blocks of images.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_drone_site import simulate_drone_site
    >>> xyz, classification, *_, footprints = simulate_drone_site(size=60.0, density=8.0, halls=0)
    >>> bool((classification == 6).any()), len(footprints) > 0
    (True, True)
    """
    refuse_large("A site", size, density, "lower size or density", "points")
    # Hills are 2 m higher than hollows.
    plan = TownPlan(size, slope, 2.0, terrace_height, buildings, trees, forest=0.0, river=False, seed=seed)
    scene = build_site(plan, halls)
    rng = np.random.default_rng([seed, 6])
    monitor.progress(0.1)
    field = see_from_above(scene, unevenness, rng)
    monitor.progress(0.4)
    matched = match(field, rounding, waves, rng)
    monitor.progress(0.8)
    xyz, row, column = sample(field, matched, density, walls, noise, rng)
    row, column = _cells_of_objects(field, xyz, row, column)
    # Colors have 16 bits.
    colors = (matched.colors[row, column] * 257).astype(np.uint16)
    classes, objects = _truth(field, xyz, row, column)
    ones = np.ones(len(xyz), np.uint8)
    return xyz, classes, ones, ones.copy(), *colors.T.copy(), objects, footprint_layer(scene.buildings, _FIELDS)


def _cells_of_objects(
    field: HeightField, xyz: np.ndarray, row: np.ndarray, column: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells (n,) of points; points smeared beyond the edge of an object belong to its nearest cell."""
    is_ground = field.classification[row, column] == PointClass.GROUND
    is_smeared = is_ground & (xyz[:, 2] > field.ground[row, column] + _SMEARED)
    nearest_row, nearest_column = (nearest[row, column] for nearest in field.beside())
    return np.where(is_smeared, nearest_row, row), np.where(is_smeared, nearest_column, column)


def _truth(field: HeightField, xyz: np.ndarray, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return class and object (n,) of points by their cells; points of plants and cars below 0.1 m are ground."""
    classes, objects = field.classification[row, column], field.object_id[row, column]
    is_ground = (classes != PointClass.BUILDING) & (xyz[:, 2] - field.ground[row, column] < 0.1)
    return np.where(is_ground, PointClass.GROUND, classes).astype(np.uint8), np.where(is_ground, 0, objects)


def build_site(plan: TownPlan, halls: int) -> Scene:
    """Return a site: a town without wires, with flat halls, vans and a block; deterministic for a plan."""
    scene = build_town(plan)
    # Wires are not visible in images.
    scene.wires.clear()
    rng = np.random.default_rng([plan.seed, 5])
    for k in range(halls):
        _add_hall(scene, k, rng)
    if plan.buildings and halls:
        _add_block(scene, rng)
    # There are eight more vans and cars per hectare.
    for _ in range(round(8 * plan.size**2 / 1e4)):
        _add_van(scene, rng)
    return scene


def _free_rectangle(scene: Scene, long: float, wide: float, rng: np.random.Generator) -> Rect | None:
    """Return a rectangle of given sides (m) at a random position 3 m off buildings, None after 60 attempts."""
    reach = np.hypot(long, wide) / 2 + 1.0
    for _ in range(60 if 2 * reach < scene.size else 0):
        x, y = rng.uniform(reach, scene.size - reach, 2)
        rect = Rect(float(x), float(y), long, wide, scene.relief.angle + float(rng.choice([0.0, np.pi / 2])))
        along, across = (np.linspace(-0.5, 0.5, max(2, int(side / 2))) * side for side in (long, wide))
        grid = np.stack(rect.at(*np.meshgrid(along, across)), axis=-1).reshape(-1, 2)
        if not scene.buildings or not scene.near_building(grid, 3.0).any():
            return rect
    return None


def _cleared_rectangle(scene: Scene, long: float, wide: float, rng: np.random.Generator) -> Rect | None:
    """Return a free rectangle, and remove plants and vehicles from it."""
    rect = _free_rectangle(scene, long, wide, rng)
    if rect is not None:
        scene.crowns[:] = [row for row in scene.crowns if not rect.contains(row[0], row[1], row[3] + 0.5)]
        scene.solids[:] = [
            solid
            for solid in scene.solids
            if solid.classification == PointClass.BUILDING or not rect.contains(solid.rect.x, solid.rect.y, 2.5)
        ]
    return rect


def _add_hall(scene: Scene, k: int, rng: np.random.Generator) -> None:
    """Add the k-th hall, with a flat roof and a parapet."""
    # Steps of the golden ratio spread the lengths evenly from 10 to 100 m for any number of halls.
    long = min(10.0 * 10.0 ** float(np.mod(0.35 + 0.382 * k, 1.0)), 0.6 * scene.size)
    rect = _cleared_rectangle(scene, long, long * rng.uniform(0.5, 0.8), rng)
    if rect is None:
        return
    site = Site(scene, rect, rng.uniform(3.0, 9.0))
    # Parapets are 0.35 m wide and 0.6 m high.
    along, across, wide = (rect.length - 0.35) / 2, (rect.width - 0.35) / 2, 0.35
    parts = [rect.part(side * along, 0.0, wide, rect.width) for side in (-1, 1)]
    parts += [rect.part(0.0, side * across, rect.length, wide) for side in (-1, 1)]
    parapets = [site.solid(part, flat(part, site.eave + 0.6)) for part in parts]
    scene.add_building("hall", rect.corners(), [site.solid(rect, flat(rect, site.eave)), *parapets])


def _add_block(scene: Scene, rng: np.random.Generator) -> None:
    """Add a block of four adjoining flat roofs."""
    wide = rng.uniform(7.0, 11.0)
    rect = _cleared_rectangle(scene, 4 * wide, 12.0, rng)
    if rect is None:
        return
    height = rng.uniform(5.0, 9.0)
    for k in range(4):
        part = rect.part((k - 1.5) * wide, 0.0, wide, rect.width)
        site = Site(scene, part, height)
        top = site.eave + 0.8 * float(rng.uniform(-1.0, 1.0))
        scene.add_building("flat", part.corners(), [site.solid(part, flat(part, top))])


def _add_van(scene: Scene, rng: np.random.Generator) -> None:
    """Add a van or a car at a free position."""
    rect = _free_rectangle(scene, 5.4, 2.0, rng)
    if rect is not None and rng.random() < 0.5:
        park_car(scene, rect.part(0.0, 0.0, *CAR))
    elif rect is not None:
        scene.add_post(rect, rng.uniform(1.9, 2.6))


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
    return colors * (1 + 0.08 * smooth_noise(shape, 0.4, rng) + 0.06 * smooth_noise(shape, 3.0, rng))[..., None]


def _lit(field: HeightField, colors: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return colors under direct light by angle of incidence, and diffuse light."""
    azimuth, elevation = _SUN
    sun = np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)])
    north, east = np.gradient(field.top, CELL)
    steep = np.sqrt(1 + east**2 + north**2)
    facing = np.clip((sun[2] - sun[0] * east - sun[1] * north) / steep, 0.0, 1.0)
    light = _SHADE + (facing * ~_shadowed(field.top, azimuth, elevation))[..., None] * (1.15 - _SHADE)
    return np.clip(colors * light * (1 + 0.03 * rng.standard_normal(field.top.shape))[..., None], 0.0, 255.0)


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
    xyz = np.concatenate([np.column_stack([xy, z])[kept], _faces(matched, density * walls, rng)])
    xyz += noise * rng.standard_normal(xyz.shape)
    xyz = xyz[((xyz[:, :2] >= 0) & (xyz[:, :2] < [columns * CELL, rows * CELL])).all(axis=1)]
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
