"""A site from matched drone images with their errors: closed crowns, rounded edges, waves, holes, colors."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from ..params import SEED
from ..stage import Field, Layer, stage, tunable
from .bodies import Body, Rect, flat
from .height_field import HeightField, see_from_above
from .image_matching import match, sample
from .scanner import refuse_large
from .scene import Scene, footprint_layer
from .town_houses import Site
from .town_layout import CAR, MAX_BUILDINGS, TownPlan, build_town, park_car

# Height (m) above which points over cells of ground belong to the nearest object, whose edge is smeared.
_SMEARED = 0.3

# Height (m) below which points of plants and cars are ground.
_GROUND = 0.1

# Number of the random stream of matching among the streams of one seed.
_STREAM = 6

# Height difference between hollows and hills, m.
_RELIEF = 2.0

_FIELDS = (
    Field("id", int, "object id of the building, as SegmentID of its points"),
    Field("kind", str, "gable, hip, flat, L, row, shed or hall"),
    Field("area", float, "area inside the walls", "m²"),
)

# Least and greatest length of halls (m).
_HALL_SIZES = (10.0, 100.0)

# Least and greatest height of the roofs of halls (m).
_HALL_HEIGHTS = (3.0, 9.0)

# Height of the parapets around the roofs of halls (m).
_PARAPET_HEIGHT = 0.6

# Width of parapets (m).
_PARAPET_WIDTH = 0.35

# Number of adjoining flat roofs in a block.
_BLOCK_ROOFS = 4

# Depth of a block (m).
_BLOCK_DEPTH = 12.0

# Largest deviation of a roof of a block from the mean height (m).
_BLOCK_STEP = 0.8

# Length and width of vans (m).
_VAN = (5.4, 2.0)

# Least and greatest height of vans (m).
_VAN_HEIGHT = (1.9, 2.6)

# Number of vans and cars per hectare.
_VANS = 8

# Most attempts to find a free position for an object.
_TRIES = 60

# Least distance of an object from buildings (m).
_ROOM = 3.0


@stage(
    "Simulation",
    tags="synthetic,drone,UAV,photogrammetry,dense matching,color,shadow,demo,example,test,truth,teaching",
    creates=("xyz", "classification", "return_number", "number_of_returns", "red", "green", "blue", "segment_id"),
    layers=(Layer("footprints", "True footprints", "Polygon", _FIELDS),),
)
def simulate_drone_site(
    *,
    size: float = tunable(150.0, "Side of the site, a square from (0, 0).", within="[40, 400] m"),
    density: float = tunable(
        40.0, "Point density on open ground, in plan.", label="Point density", within="[5, 400] points/m²"
    ),
    slope: float = tunable(4.0, "Mean slope of the ground.", within="[0, 20]°"),
    terrace_height: float = tunable(1.5, "Rise of each terrace.", label="Height of terraces", within="[0, 3] m"),
    buildings: float = tunable(16.0, "Houses per hectare of streets and plots.", within=f"[0, {MAX_BUILDINGS}] per ha"),
    trees: float = tunable(30.0, "Trees in gardens.", within="[0, 200] per ha"),
    halls: int = tunable(
        2,
        "Halls with flat roofs and parapets, 10 to 100 m long, if space permits.",
        label="Flat halls",
        within="[0, 20]",
    ),
    unevenness: float = tunable(
        0.12,
        "Standard deviation of the ground from the smooth slope, due to gardens, curbs and ruts.",
        label="Unevenness of the ground",
        within="[0, 0.5] m",
    ),
    rounding: float = tunable(
        0.5, "Mean distance over which eaves and ridges are rounded.", label="Rounding of edges", within="[0, 2] m"
    ),
    waves: float = tunable(
        0.03, "Standard deviation of errors that are correlated between neighboring points.", within="[0, 0.3] m"
    ),
    walls: float = tunable(
        0.6,
        "Point density on walls, as a share of the density on open ground.",
        label="Share of walls",
        within="[0, 1]",
    ),
    noise: float = tunable(
        0.01, "Standard deviation of uncorrelated errors, the same in every direction.", within="[0, 0.2] m"
    ),
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
    plan = TownPlan(size, slope, _RELIEF, terrace_height, buildings, trees, forest=0.0, river=False, seed=seed)
    scene = build_site(plan, halls)
    rng = np.random.default_rng([seed, _STREAM])
    monitor.progress(0.1)
    field = see_from_above(scene, unevenness, rng)
    monitor.progress(0.4)
    matched = match(field, rounding, waves, rng)
    monitor.progress(0.8)
    xyz, row, column = sample(field, matched, density, walls, noise, rng)
    row, column = _cells_of_objects(field, xyz, row, column)
    # From 8 to 16 bits.
    colors = (matched.colors[row, column] * 257).astype(np.uint16)
    classes, objects = _truth(field, xyz, row, column)
    ones = np.ones(len(xyz), np.uint8)
    return xyz, classes, ones, ones.copy(), *colors.T.copy(), objects, footprint_layer(scene.buildings)


def _cells_of_objects(
    field: HeightField, xyz: np.ndarray, row: np.ndarray, column: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells (n,) of points; points smeared beyond the edge of an object belong to its nearest cell."""
    is_ground = field.classification[row, column] == PointClass.GROUND
    is_smeared = is_ground & (xyz[:, 2] > field.ground[row, column] + _SMEARED)
    row_beside, column_beside = field.beside()
    return (
        np.where(is_smeared, row_beside[row, column], row),
        np.where(is_smeared, column_beside[row, column], column),
    )


def _truth(field: HeightField, xyz: np.ndarray, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return class and object (n,) of points by their cells; low points of plants and cars are ground."""
    classes, objects = field.classification[row, column], field.object_id[row, column]
    above = xyz[:, 2] - field.ground[row, column]
    is_ground = (classes != PointClass.BUILDING) & (above < _GROUND)
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
    for _ in range(round(_VANS * plan.size**2 / 1e4)):
        _add_van(scene, rng)
    return scene


def _free_rectangle(scene: Scene, long: float, wide: float, rng: np.random.Generator) -> Rect | None:
    """Return a free rectangle of given sides (m) at a random position, None without space."""
    reach = np.hypot(long, wide) / 2 + 1.0
    if 2 * reach >= scene.size:
        return None
    for _ in range(_TRIES):
        x, y = rng.uniform(reach, scene.size - reach, 2)
        rect = Rect(float(x), float(y), long, wide, scene.relief.angle + float(rng.choice([0.0, np.pi / 2])))
        across, along = (np.linspace(-0.5, 0.5, max(2, int(side / 2))) * side for side in (wide, long))
        grid = np.stack(np.meshgrid(along, across), axis=-1).reshape(-1, 2)
        if not scene.buildings or not scene.near_building(np.column_stack(rect.at(*grid.T)), _ROOM).any():
            return rect
    return None


def _clear(scene: Scene, rect: Rect) -> None:
    """Remove plants and vehicles from the footprint of a new building."""
    scene.crowns[:] = [row for row in scene.crowns if not rect.contains(row[0], row[1], row[3] + 0.5)]
    scene.solids[:] = [
        solid
        for solid in scene.solids
        if solid.classification == PointClass.BUILDING or not rect.contains(solid.rect.x, solid.rect.y, 2.5)
    ]


def _add_hall(scene: Scene, k: int, rng: np.random.Generator) -> None:
    """Add the k-th hall, with a flat roof and a parapet; lengths are spread evenly over their range."""
    least, most = _HALL_SIZES
    # Steps of the golden ratio spread the lengths evenly for any number of halls.
    long = min(least * (most / least) ** float(np.mod(0.35 + 0.382 * k, 1.0)), 0.6 * scene.size)
    rect = _free_rectangle(scene, long, long * rng.uniform(0.5, 0.8), rng)
    if rect is None:
        return
    _clear(scene, rect)
    site = Site(scene, rect, rng.uniform(*_HALL_HEIGHTS))
    scene.add_building("hall", rect.corners(), [site.solid(rect, flat(rect, site.eave)), *_parapets(site, rect)])


def _parapets(site: Site, rect: Rect) -> list[Body]:
    along, across = (rect.length - _PARAPET_WIDTH) / 2, (rect.width - _PARAPET_WIDTH) / 2
    parts = [rect.part(side * along, 0.0, _PARAPET_WIDTH, rect.width) for side in (-1, 1)]
    parts += [rect.part(0.0, side * across, rect.length, _PARAPET_WIDTH) for side in (-1, 1)]
    return [site.solid(part, flat(part, site.eave + _PARAPET_HEIGHT)) for part in parts]


def _add_block(scene: Scene, rng: np.random.Generator) -> None:
    """Add a block of adjoining flat roofs."""
    wide = rng.uniform(7.0, 11.0)
    rect = _free_rectangle(scene, _BLOCK_ROOFS * wide, _BLOCK_DEPTH, rng)
    if rect is None:
        return
    _clear(scene, rect)
    height = rng.uniform(5.0, 9.0)
    for k in range(_BLOCK_ROOFS):
        part = rect.part((k - (_BLOCK_ROOFS - 1) / 2) * wide, 0.0, wide, _BLOCK_DEPTH)
        site = Site(scene, part, height)
        top = site.eave + _BLOCK_STEP * float(rng.uniform(-1.0, 1.0))
        scene.add_building("flat", part.corners(), [site.solid(part, flat(part, top))])


def _add_van(scene: Scene, rng: np.random.Generator) -> None:
    """Add a van or a car at a free position."""
    rect = _free_rectangle(scene, *_VAN, rng)
    if rect is None:
        return
    if rng.random() < 0.5:
        park_car(scene, rect.part(0.0, 0.0, *CAR))
        return
    ground = float(scene.relief.ground(rect.x, rect.y))
    scene.add_box(rect, ground - 1.0, ground + rng.uniform(*_VAN_HEIGHT), PointClass.UNCLASSIFIED)
