"""A site photographed by a drone and matched as real images are: closed crowns, rounded edges, waves, holes, color."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from ..params import SEED
from ..stage import Field, Layer, stage, tunable
from .drone_site import build_site
from .height_field import HeightField, see_from_above
from .image_matching import match, sample
from .scanner import MAX_POINTS, refuse_large
from .scene import footprint_layer
from .town_layout import MAX_BUILDINGS, TownPlan

# Height above the ground (m) from which points of cells of ground are of an adjacent object, whose edge is smeared.
_SMEARED = 0.3

# Height above the ground (m) below which points of plants and cars are ground.
_GROUND = 0.1

# Distinguishes the random numbers of matching from other parts of the simulation with the same seed.
_STREAM = 6

# Height from hollows to hills, m.
_RELIEF = 2.0

_FIELDS = (
    Field("id", int, "object id of the building, as SegmentID of its points"),
    Field("kind", str, "gable, hip, flat, L, row, shed or hall"),
    Field("area", float, "area inside the walls", "m²"),
)


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
        40.0, "Points on open ground, seen from above.", label="Point density", within="[5, 400] points/m²"
    ),
    slope: float = tunable(4.0, "Mean slope of the ground.", within="[0, 20]°"),
    terrace_height: float = tunable(1.5, "Rise of steps in the slope.", label="Height of terraces", within="[0, 3] m"),
    buildings: float = tunable(
        16.0, "Houses on a hectare of streets and plots.", within=f"[0, {MAX_BUILDINGS}] per ha"
    ),
    trees: float = tunable(30.0, "Trees in gardens.", within="[0, 200] per ha"),
    halls: int = tunable(
        2, "Flat roofs with parapets, 10 to 100 m long, where there is room.", label="Flat halls", within="[0, 20]"
    ),
    unevenness: float = tunable(
        0.12,
        "Standard deviation of the ground from the slope: gardens, kerbs, ruts.",
        label="Unevenness of the ground",
        within="[0, 0.5] m",
    ),
    rounding: float = tunable(
        0.5, "Distance over which eaves and ridges are rounded.", label="Rounding of edges", within="[0, 2] m"
    ),
    waves: float = tunable(0.03, "Standard deviation of errors that neighboring points share.", within="[0, 0.3] m"),
    walls: float = tunable(
        0.6, "Density of points on walls, as a share of that on open ground.", label="Share of walls", within="[0, 1]"
    ),
    noise: float = tunable(0.01, "Standard deviation of each point in every direction.", within="[0, 0.2] m"),
    seed: int = SEED,
    monitor=None,
):
    """Photograph a made-up site with a drone, match the images with all their errors, and store the true classes.

    Houses cut into slopes and terraces, sheds, rows, blocks of flat roofs, halls with parapets, cars and vans, trees,
    hedges and bushes. Crowns are closed lumpy surfaces, edges rounded, walls smeared or missing, surfaces wavy; dark,
    bright and shiny ones have holes and spikes. Every material has its color, in light and in shadow.

    Returns
    -------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m).
    classification : ndarray of shape (n,), uint8
        The truth: 2 ground; 3, 4, 5 vegetation under 0.5 m, under 2 m and higher; 6 buildings; 1 cars and the rest.
    return_number, number_of_returns : ndarray of shape (n,), uint8
        All 1.
    red, green, blue : ndarray of shape (n,), uint16
        Colors.
    segment_id : ndarray of shape (n,), int32
        Number of the object, the same for all points of a building; 0 for ground.
    footprints : LayerFeatures
        The walls of every building.

    Raises
    ------
    ValueError
        If there would be more than 30 million points.

    Notes
    -----
    The scene is a surface of cells of 0.1 m, and so are the errors: matching turns it into a smoother surface with
    errors that neighbors share, on which points are drawn. Steps are smeared by normal distributions whose width
    changes over the site from half to one and a half times the mean. Points that are smeared beyond the edge of an
    object, ``_SMEARED`` m above the ground or more, are of the object.

    Unevenness of the ground, waves and the roughness of crowns are as in two real clouds, a suburb and a beach. Open
    ground deviates from planes by 1 to 1.3 cm over 1 m and by 3 to 5 cm over 4 m.

    Not simulated: what lies under eaves, crowns and bridges, double surfaces, seams between blocks of images.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_drone_site import simulate_drone_site
    >>> xyz, classification, *_, footprints = simulate_drone_site(size=60.0, density=8.0, halls=0)
    >>> bool((classification == 6).any()), len(footprints) > 0
    (True, True)
    """
    refuse_large("A site", size, density, "lower size or density", "points", MAX_POINTS)
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
    """Return the cells (n,) that points are of: those smeared beyond the edge of an object are of the object."""
    is_ground = field.classification[row, column] == PointClass.GROUND
    is_smeared = is_ground & (xyz[:, 2] > field.ground[row, column] + _SMEARED)
    row_beside, column_beside = field.beside()
    return (
        np.where(is_smeared, row_beside[row, column], row),
        np.where(is_smeared, column_beside[row, column], column),
    )


def _truth(field: HeightField, xyz: np.ndarray, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return class and object (n,) of points of cells; ground is drawn under the edges of crowns."""
    classes, objects = field.classification[row, column], field.object_id[row, column]
    above = xyz[:, 2] - field.ground[row, column]
    is_ground = (classes != PointClass.BUILDING) & (above < _GROUND)
    return np.where(is_ground, PointClass.GROUND, classes).astype(np.uint8), np.where(is_ground, 0, objects)
