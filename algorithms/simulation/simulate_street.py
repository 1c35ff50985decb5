"""A street scanned from a vehicle, of which every facade, opening and corner is known."""

from __future__ import annotations

import numpy as np

from ..params import SEED
from ..stage import Field, Layer, LayerFeatures, stage, tunable
from .drone import ANGULAR_STEP, LINE_RATE, LineScan
from .scanner import RANGE_NOISE, RECORDED, Survey, refuse_large, refuse_many, scan
from .scene import Scene
from .solids import Rect
from .street_fronts import Truth
from .street_scene import StreetPlan, build_street
from .vehicle import Drive, pulses_of

# The scanners are this high over the street (m).
_HEIGHT = 2.2

# Points of a wall farther than this (m) from its front, noise apart, are on its ends and reveals.
_ON_FRONT = 0.01

# Largest error by noise (standard deviations) of a point on the front: one of 16,000 is larger.
_DEVIATIONS = 4.0

# From where the street may be scanned.
VIEWS = ("vehicle", "airplane")

_CREATED = (*RECORDED, "cluster_id")

_FACADE_FIELDS = (
    Field("id", int, "number of the facade, as SegmentID of its points"),
    Field("kind", str, "kind of the front that it is part of: plain, recess, bay, curved or balconies"),
)
_OPENING_FIELDS = (
    Field("id", int, "number of the opening, as ClusterID of its points"),
    Field("facade", int, "number of its facade"),
    Field("kind", str, "window or door"),
    Field("width", float, "Width", "m"),
    Field("height", float, "Height", "m"),
)
_HOUSE_FIELDS = (
    Field("id", int, "number of the house"),
    Field("eave", float, "Elevation of the eaves", "m"),
    Field("ridge", float, "Elevation of the ridge", "m"),
)
_CORNER_FIELDS = (Field("facade", int, "number of the facade"),)


@stage(
    "Simulation",
    tags="synthetic,mobile mapping,vehicle,facade,window,street,demo,example,test,truth,teaching,generate",
    creates=_CREATED,
    layers=(
        Layer("facades", "True facades", "Polygon", _FACADE_FIELDS, style="facades"),
        Layer("openings", "True openings", "Polygon", _OPENING_FIELDS),
        Layer("corners", "True corners", "Point", _CORNER_FIELDS),
        Layer("outlines", "True outlines of houses", "Polygon", _HOUSE_FIELDS),
    ),
)
def simulate_street(
    *,
    length: float = tunable(60.0, "Length of the street.", within="[10, 2000] m"),
    width: float = tunable(16.0, "Distance between the fronts of both sides.", within="[12, 60] m"),
    slope: float = tunable(1.0, "Slope along the street.", within="[0, 10]°"),
    clutter: bool = tunable(
        True, "Put parked cars, trees, poles and people before the fronts, which hide parts of them."
    ),
    stoops: float = tunable(
        0.0,
        "Height of the doors over the street. Stairs lead up to them; from 1.4 m on there are cellar windows.",
        label="Height of stoops",
        within="[0, 4] m",
    ),
    unevenness: float = tunable(
        0.0,
        "How far the ends of a front are before or behind the line of its neighbors at most: fronts nearly in one "
        "plane.",
        within="[0, 1] m",
    ),
    houses: bool = tunable(False, "Put houses with gable roofs behind the fronts; no front is curved then."),
    view: str = tunable(
        "vehicle",
        "Scan the street from a vehicle or from an airplane. Both see the same street for the same seed.",
        choices=VIEWS,
    ),
    density: float = tunable(
        12.0,
        "Laser pulses of the scan from the air.",
        label="Pulse density",
        within="[0.5, 100] pulses/m²",
        advanced=True,
    ),
    glass: float = tunable(
        70.0, "Share of the pulses on window panes that pass them and are lost.", within="[0, 100] %"
    ),
    speed: float = tunable(5.0, "Speed of the vehicle.", within="[0.5, 30] m/s", advanced=True),
    line_rate: float = LINE_RATE.with_default(100.0),
    angular_step: float = ANGULAR_STEP,
    max_range: float = tunable(40.0, "How far the scanners see.", within="[5, 200] m", advanced=True),
    range_noise: float = RANGE_NOISE.with_default(0.01),
    seed: int = SEED,
    monitor=None,
):
    """Scan a made-up street from a vehicle or an airplane, with the true facades, windows, doors and corners.

    Houses are side by side along both sides: plain fronts, fronts with a recess, a bay, balconies, and curved ones,
    all with windows and doors. Parked cars, trees, poles and people hide parts of them. The vehicle drives through
    the street once, with two scanners whose planes look ahead and back.

    Returns
    -------
    xyz, intensity, gps_time : ndarray of shape (n, ...)
        As of :func:`.simulate_town.simulate_town`.
    classification : ndarray of shape (n,), uint8
        The truth: 2 ground; 3, 4, 5 vegetation by height; 6 buildings with their balconies; 1 cars, poles and people.
    return_number, number_of_returns : ndarray of shape (n,), uint8
        1: the vehicle's scanners record the first echo only. From the airplane as of "Simulate town".
    scan_angle : ndarray of shape (n,), float32
        Angle of the beam to the nadir (°), negative to the left.
    point_source_id : ndarray of shape (n,), uint16
        1 for the vehicle's scanner that looks ahead on the left, 2 for the other one; strips of the airplane.
    segment_id : ndarray of shape (n,), int32
        Number of the facade; 0 for everything else, reveals, panes and frames too.
    cluster_id : ndarray of shape (n,), int32
        Number of the opening that a pane or frame belongs to; 0 for everything else.
    facades, openings : LayerFeatures
        Polygons with Z, counterclockwise seen from the street; openings in the plane of the facade's front.
    corners : LayerFeatures
        Corners of the facades, points with Z.
    outlines : LayerFeatures
        Outlines of the houses on the ground, polygons with Z; none without ``houses``.

    Raises
    ------
    ValueError
        If there would be more than 50 million pulses, or no beam meets anything.

    Notes
    -----
    Stairs lead straight up to a landing of 1.2 m before raised doors. A curved front is made of six flat strips;
    walls of neighboring houses in one plane are one facade. The roofs of houses are flush with their walls. From the
    air the street is scanned as "Simulate town" does. The position of the vehicle is known exactly; the noise lies
    along the beam. Frames are 10 cm and panes 16 cm behind the front. Not simulated: rooms behind panes, mirror
    images in glass, and echoes of the vehicle's scanners that mix two surfaces at an edge.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_street import simulate_street
    >>> *_, facades, openings, corners, houses = simulate_street(length=20.0, line_rate=5.0, angular_step=2.0)
    >>> len(corners) >= 4 * len(facades)
    True
    """
    settings = LineScan(line_rate, angular_step, max_range, range_noise, seed)
    if view == "vehicle":
        remedy = "shorten it, lower the line rate, or take a larger speed or angular step"
        refuse_many(pulses_of(length, speed, settings), f"A street of {length:g} m", remedy)
    plan = StreetPlan(length, width, slope, clutter, stoops, unevenness, houses, seed)
    scene, truth, street = build_street(plan)
    if view == "airplane":
        refuse_large("The site", scene.size, density, "shorten the street or lower the pulse density")
        made = scan(scene, Survey(density, range_noise=range_noise, seed=seed), monitor)
    else:
        made = _drive(scene, street, speed).scanned(scene, settings, monitor)
    made = _with_numbers(_through_glass(made, truth, glass, seed), truth, range_noise)
    if not len(made["xyz"]):
        raise ValueError(f"Nothing is within {max_range:g} m of the scanners; raise the maximum range.")
    return (*(made[name] for name in _CREATED), *_layers(truth))


def _drive(scene: Scene, street: Rect, speed: float) -> Drive:
    """Return a drive in the right lane, from which the fronts of both sides are seen at different distances."""
    ends = [np.array(street.at(sign * street.length / 2, -street.width / 8)) for sign in (-1, 1)]
    ends = [np.array([*end, float(scene.relief.plane(*end)) + _HEIGHT]) for end in ends]
    way = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    return Drive(ends[0], way, street.length, speed)


def _through_glass(made: dict[str, np.ndarray], truth: Truth, share: float, seed: int) -> dict[str, np.ndarray]:
    """Return the points that are left after panes let a share (%) of the pulses pass."""
    is_glass = np.isin(made["segment_id"], sorted(truth.glass))
    chance = np.random.default_rng([seed, 6]).random(len(is_glass))
    kept = ~is_glass | (chance >= share / 100)
    return {name: values[kept] for name, values in made.items()}


def _with_numbers(made: dict[str, np.ndarray], truth: Truth, noise: float) -> dict[str, np.ndarray]:
    """Return points with the numbers of facade and opening instead of those of objects."""
    number = made["segment_id"]
    facade, opening = np.zeros((2, int(number.max(initial=0)) + 1), np.int32)
    for of, table in ((truth.facade_of, facade), (truth.opening_of, opening)):
        for own, true in of.items():
            if own < len(table):
                table[own] = true
    on_facade = facade[number]
    # The sides of openings and the ends of walls are of the same solids, and not of the front.
    start = np.array([ring[0] for ring in truth.facades])
    step = np.array([ring[1] - ring[0] for ring in truth.facades])
    across = np.column_stack([-step[:, 1], step[:, 0]]) / np.hypot(step[:, 0], step[:, 1])[:, None]
    own = on_facade - 1
    x, y = (made["xyz"] - start[own])[:, :2].T
    off = x * across[own, 0] + y * across[own, 1]
    on_facade[np.abs(off) > _ON_FRONT + _DEVIATIONS * noise] = 0
    return {**made, "segment_id": on_facade, "cluster_id": opening[number]}


def _layers(truth: Truth) -> tuple[LayerFeatures, ...]:
    """Return the true facades, openings, corners and houses."""
    walls = truth.facades
    facades = [([ring], {"kind": kind}) for ring, kind in zip(walls, truth.kinds)]
    corners = [corner for ring in walls for corner in ring[:-1]]
    owner = np.repeat(np.arange(1, len(walls) + 1), [len(ring) - 1 for ring in walls]).tolist()
    return (
        LayerFeatures.numbered(facades, _FACADE_FIELDS),
        LayerFeatures.numbered(truth.openings, _OPENING_FIELDS),
        LayerFeatures(corners, {"facade": owner}),
        LayerFeatures.numbered(truth.houses, _HOUSE_FIELDS),
    )
