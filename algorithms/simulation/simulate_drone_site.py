"""A site from matched drone images with their errors: closed crowns, rounded edges, waves, holes, colors."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from ..params import SEED
from ..stage import Layer, stage, tunable
from .bodies import Rect, flat
from .height_field import HeightField, see_from_above
from .image_matching import match, sample
from .scanner import refuse_large
from .scene import Scene, footprint_fields, footprint_layer
from .town_houses import Site
from .town_layout import CAR, MAX_BUILDINGS, TownPlan, build_town, park_car

# Height (m) above which points over cells of ground belong to the nearest object, whose edge is smeared.
_SMEARED = 0.3

_FIELDS = footprint_fields("gable, hip, flat, L, row, shed or hall")[:3]


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
