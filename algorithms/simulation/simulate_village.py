"""Matched drone images of a village with known walls and roofs, and an old map with errors.

Images are views whose rays are cast onto the surfaces of the village.
"""

import itertools
from collections.abc import Iterator

import numpy as np

from ..cloud.asprs import PointClass
from ..packages import spatial
from ..params import SEED
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from .beams import BLOCK, Beams, Echoes, World, is_vegetation, join
from .pairs import in_boxes
from .relief import Relief
from .scanner import refuse_large
from .scene import Scene, footprint_fields, footprint_layer
from .village_layout import MAX_HOMES, Village, build_village

# Radius (m) of holes where matching fails, and side of the cells in which their centers are drawn.
_HOLE = 0.5

_FOOTPRINT_FIELDS = footprint_fields("rectangle, hip, L, bend or shed")

_MAP_FIELDS = (
    Field("id", int, "number of the building in the map, from 1"),
    Field("building", int, "object id of the building, 0 if demolished"),
    Field("state", str, "kept or demolished"),
)

# Width (m) of the margin into which rays are aimed, too: oblique rays meet walls before the ground.
_MARGIN = 10.0


@stage(
    "Simulation",
    tags="synthetic,drone,UAV,photogrammetry,oblique,walls,eaves,cadastre,demo,example,test,truth,teaching",
    creates=("xyz", "classification", "return_number", "number_of_returns", "red", "green", "blue", "segment_id"),
    layers=(
        Layer("footprints", "True wall footprints", "Polygon", _FOOTPRINT_FIELDS),
        Layer("old_map", "Old map", "Polygon", _MAP_FIELDS),
    ),
)
def simulate_village(
    *,
    size: float = tunable(150.0, within="[50, 1000] m"),
    density: float = tunable(100.0, label="Point density", within="[5, 1000] points/m²"),
    buildings: float = tunable(12.0, within=f"[0, {MAX_HOMES}] per ha"),
    trees: float = tunable(15.0, within="[0, 200] per ha"),
    slope: float = tunable(2.0, within="[0, 20]°"),
    overhang: float = tunable(0.5, label="Overhang of roofs", within="[0, 1] m"),
    clutter: bool = tunable(True, label="Cars, hedges and bushes"),
    noise: float = tunable(0.03, within="[0, 0.2] m"),
    holes: float = tunable(0.1, label="Share of holes", within="[0, 0.5]"),
    oblique: float = tunable(28.0, label="Oblique angle", within="[0, 30]°", advanced=True),
    noise_points: float = tunable(20.0, within="[0, 1000] per ha", advanced=True),
    map_shift: float = tunable(0.3, label="Shift of the old map", within="[0, 2] m"),
    map_noise: float = tunable(0.15, label="Noise of the old map", within="[0, 1] m"),
    map_changes: float = tunable(0.1, label="Changes since the old map", within="[0, 0.5]"),
    seed: int = SEED,
    monitor=None,
):
    """Simulate a village from matched drone images: points, the true footprints of the walls, and an old map.

    The village has detached houses (rectangular, L-shaped or bent) with overhanging eaves, sheds, cars, bushes next to
    walls, hedges and trees. A vertical and four oblique views give many points on roofs and few on walls.

    Returns
    -------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m).
    classification : ndarray of shape (n,), uint8
        True class: 2 ground; 3, 4, 5 vegetation under 0.5 m, under 2 m and higher; 6 buildings; 7 and 18 low and high
        noise; 1 cars.
    return_number, number_of_returns : ndarray of shape (n,), uint8
        Always 0, which means unknown.
    red, green, blue : ndarray of shape (n,), uint16
        Colors.
    segment_id : ndarray of shape (n,), int32
        Number of the object, the same for all points of a building; 0 for ground and noise.
    footprints : LayerFeatures
        Outlines of the walls of all buildings, without the eaves.
    old_map : LayerFeatures
        Footprints of the old map: with a common shift and noise of each corner, some missing and some demolished.

    Other Parameters
    ----------------
    size
        Side of the village, a square from (0, 0).
    density
        Density on open ground. Roofs have about the same, walls a tenth of it where a view reaches them.
    buildings
        Houses per hectare of streets and plots, two of three with a shed.
    trees
        Trees in gardens.
    slope
        Mean slope of the ground.
    overhang
        Overhang of the eaves beyond the walls; half of it at sheds.
    clutter
        Add objects that are not buildings, also next to walls.
    noise
        Standard deviation of points, the same in every direction.
    holes
        Approximate share of all surfaces without points, where matching fails.
    oblique
        Angle of the four oblique views to the vertical. Larger angles show more of the walls.
    noise_points
        Wrong matches, half of them above, half below the ground.
    map_shift
        Shift of the old map to the east and to the north.
    map_noise
        Standard deviation of the corners of the old map in easting and northing.
    map_changes
        Share of the buildings that are missing from the map. As many demolished ones are added on free plots.

    Raises
    ------
    ValueError
        If there would be more than 30 million points.

    Notes
    -----
    Projections are parallel; the first hit of a ray is a point. A wall that faces an oblique view of 28° has a tenth of
    the density of open ground (a fifth of the views, times the tangent of the angle), and no points right below the
    eaves. Hrutka, Siki and Takács (2022) report about the same of real clouds: 5 % as many points on walls as on
    roofs. Noise is the same in all directions.

    Not simulated: windows, reflecting surfaces, blurred edges, correlated errors, dormers.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_village import simulate_village
    >>> xyz, classification, *_, footprints, old_map = simulate_village(size=90.0, density=5.0)
    >>> bool((classification == 6).any()), len(footprints) > 0
    (True, True)
    """
    refuse_large("A village", size, density, "lower size or density", "points")
    village = build_village(size, slope, buildings, trees, overhang, clutter, seed)
    if buildings and not village.scene.buildings:
        monitor.warn(
            f"No house was built: too few plots lie wholly within {size:g} m; raise the size, or try another seed."
        )
    xyz, seen = photograph(village.scene, density=density, oblique=oblique, seed=seed, monitor=monitor.part(0.0, 0.8))
    rng = np.random.default_rng([seed, 4])
    kept = _outside_holes(xyz, holes, rng)
    xyz, seen = xyz[kept], seen.take(kept)
    colors = _colors(seen, village, rng)
    xyz = xyz + noise * rng.standard_normal(xyz.shape)
    monitor.progress(0.9)
    wrong = _wrong_matches(village.scene.relief, round(noise_points * size**2 / 1e4), rng)
    cloud = _joined(xyz, seen, village, colors, *wrong)
    old_map = _old_map(village, map_shift, map_noise, map_changes, rng)
    return (*cloud, footprint_layer(village.scene.buildings, _FOOTPRINT_FIELDS), old_map)


def _outside_holes(xyz: np.ndarray, share: float, rng: np.random.Generator) -> np.ndarray:
    """Return the mask of points (n,) outside random holes where matching fails."""
    if not share:
        return np.full(len(xyz), True)
    candidates = np.unique(np.floor(xyz / _HOLE).astype(np.int64), axis=0, return_index=True)[1]
    # Random disks leave exp(-area of disks per area) of a surface; a surface crosses 1.1 cells per area of a cell.
    chance = -np.log(1 - share) / (1.1 / _HOLE**2 * np.pi * _HOLE**2)
    centers = xyz[candidates[rng.random(len(candidates)) < chance]]
    return ~np.isfinite(spatial.cKDTree(centers).query(xyz, distance_upper_bound=_HOLE)[0])


# Colors of ground, leaves, cars, walls and roofs (red, green, blue, 0 to 255); each house has one of each.
_COLORS = {
    "ground": np.array([(134, 124, 92)]),
    "leaves": np.array([(70, 96, 48)]),
    "cars": np.array([(150, 152, 158)]),
    "walls": np.array([(226, 218, 200), (212, 190, 140), (190, 186, 180), (205, 160, 130)]),
    "roofs": np.array([(150, 70, 50), (110, 60, 50), (95, 95, 100), (130, 105, 90)]),
}


def _colors(seen: Echoes, village: Village, rng: np.random.Generator) -> np.ndarray:
    """Return red, green and blue (n, 3), uint16, by material, with a factor per object and noise per point."""
    classes, number = seen.classification, seen.object_id
    is_roof = village.owner[number] != number
    is_building = classes == PointClass.BUILDING
    kinds = {"leaves": is_vegetation(classes), "cars": classes == PointClass.UNCLASSIFIED}
    kinds |= {"walls": is_building & ~is_roof, "roofs": is_building & is_roof}
    color = np.tile(_COLORS["ground"].astype(float), (len(seen), 1))
    for kind, chosen in kinds.items():
        color[chosen] = _COLORS[kind][number[chosen] % len(_COLORS[kind])]
    light = (0.85 + 0.3 * np.modf(number * 0.618034)[0])[:, None] * (1 + 0.06 * rng.standard_normal((len(seen), 1)))
    return np.clip(color * light * 257, 0, 65_535).astype(np.uint16)


def _wrong_matches(relief: Relief, count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Return the positions (count, 3) of noise points, half above and half below the ground, and their classes."""
    xy = rng.uniform(0.0, relief.size, (count, 2))
    is_high = np.arange(count) % 2 == 0
    height = np.where(is_high, rng.uniform(20.0, 60.0, count), -rng.uniform(2.0, 10.0, count))
    classes = np.where(is_high, PointClass.HIGH_NOISE, PointClass.LOW_NOISE)
    return np.column_stack([xy, relief.ground(*xy.T) + height]), classes.astype(np.uint8)


def _joined(
    xyz: np.ndarray, seen: Echoes, village: Village, colors: np.ndarray, wrong: np.ndarray, classes: np.ndarray
) -> tuple:
    """Return the dimensions of all points, noise last."""
    gray = np.full((len(wrong), 3), 32_768, np.uint16)
    unknown = np.zeros(len(xyz) + len(wrong), np.uint8)
    return (
        np.concatenate([xyz, wrong]),
        np.concatenate([seen.classification, classes]).astype(np.uint8),
        unknown,
        unknown.copy(),
        *np.concatenate([colors, gray]).T.copy(),
        np.concatenate([village.owner[seen.object_id], np.zeros(len(wrong))]).astype(np.int32),
    )


def _old_map(village: Village, shift: float, noise: float, changes: float, rng: np.random.Generator) -> LayerFeatures:
    """Return the old map: displaced footprints, with some buildings missing and some demolished."""
    buildings = village.scene.buildings
    count = round(changes * len(buildings))
    missing = set(rng.permutation(len(buildings))[:count].tolist())
    known = [(b.outline[:-1], b.object_id) for i, b in enumerate(buildings) if i not in missing]
    # Demolished buildings are on plots without a house.
    plots = [village.free[i] for i in rng.permutation(len(village.free))[:count]]
    gone = [plot.part(0.0, 0.0, *rng.uniform(6.0, 10.0, 2), rng.uniform(0.0, np.pi)) for plot in plots]
    known += [(house.corners(), 0) for house in gone]
    rings = [ring + shift + noise * rng.standard_normal(ring.shape) for ring, _ in known]
    facts = [{"building": number, "state": "kept" if number else "demolished"} for _, number in known]
    closed = [[np.concatenate([ring, ring[:1]])] for ring in rings]
    return LayerFeatures.numbered(list(zip(closed, facts)), _MAP_FIELDS)


def photograph(scene: Scene, density: float, oblique: float, seed: int, monitor: Monitor) -> tuple[np.ndarray, Echoes]:
    """Return the points that a vertical view and four oblique views see of a scene.

    Parameters
    ----------
    scene : Scene
        The scene.
    density : float
        Points per square meter of open ground, all views together.
    oblique : float
        Angle of the oblique views to the vertical, degrees.
    seed : int
        The same seed gives the same points.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    xyz : ndarray of shape (n, 3)
        Exact positions (m) within the square of the scene.
    seen : Echoes
        Class and object of each point, in the same order.
    """
    rng = np.random.default_rng([seed, 3])
    world = World(scene)
    directions = [(0.0, 0.0), *((np.deg2rad(oblique), scene.relief.angle + k * np.pi / 2) for k in range(4))]
    blocks = list(itertools.product(directions, _blocks(scene.size, density / len(directions))))
    positions, parts = [], []
    for i, ((tilt, heading), (low, high, count)) in enumerate(blocks):
        rays = _rays(scene.relief, rng.uniform(low, high, (count, 2)), tilt, heading)
        # Wires are thinner than a pixel.
        ends = world.surfaces(rays, *_met(world, "solids", rays))
        seen = join([ends, world.leaves(rays, *_met(world, "crowns", rays), rng)]).first()
        xyz = rays.at(seen.pulse, seen.range)
        inside = ((xyz[:, :2] >= 0) & (xyz[:, :2] <= scene.size)).all(axis=1)
        positions.append(xyz[inside])
        parts.append(seen.take(inside))
        monitor.progress((i + 1) / len(blocks))
    return np.concatenate(positions), join(parts)


def _blocks(size: float, density: float) -> Iterator[tuple[np.ndarray, np.ndarray, int]]:
    """Yield the lower and upper corner (m) of squares, and the number of rays aimed into each."""
    n = max(1, int(np.ceil((size + 2 * _MARGIN) * np.sqrt(density / BLOCK))))
    side = (size + 2 * _MARGIN) / n
    for row, column in itertools.product(range(n), range(n)):
        low = np.array([column, row]) * side - _MARGIN
        yield low, low + side, round(density * side**2)


def _rays(relief: Relief, aim: np.ndarray, tilt: float, heading: float) -> Beams:
    """Return parallel rays tilted by ``tilt`` toward ``heading`` (rad) that meet the plane of the ground at ``aim``."""
    direction = np.array([np.sin(tilt) * np.cos(heading), np.sin(tilt) * np.sin(heading), -np.cos(tilt)])
    end = np.column_stack([aim, relief.plane(*aim.T)])
    # Rays start 80 m above the ground, higher than all trees.
    return Beams(np.arange(len(aim)), end - 80.0 / np.cos(tilt) * direction, np.tile(direction, (len(aim), 1)), aim)


def _met(world: World, kind: str, rays: Beams) -> tuple[np.ndarray, np.ndarray]:
    """Return the candidate pairs (ray, object): rays aimed into the shadow of the object's bounding box."""
    low, high = world.boxes(kind)
    direction = rays.direction[0]
    shadows = []
    for corner in itertools.product(*zip(low.T, high.T)):
        x, y, z = corner
        # Distance along the ray from the corner to its shadow on the plane.
        fall = direction[2] - np.dot(world.relief.plane_gradient, direction[:2])
        way = (world.relief.plane(x, y) - z) / fall
        shadows.append(np.column_stack([x, y]) + way[:, None] * direction[:2])
    return in_boxes(rays.aim, np.min(shadows, axis=0), np.max(shadows, axis=0))
