"""Scans of a street with known facades, openings and corners, from a vehicle or an airplane.

The drive of the vehicle and its scanners are here too.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from ..params import SEED
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from .beams import Beams
from .bodies import Rect
from .drone import ANGULAR_STEP, LINE_RATE, Dimensions, LineScan, bearing
from .plants import plant_tree
from .relief import Relief
from .scanner import RANGE_NOISE, RECORDED, AirSurvey, refuse_large, refuse_many, scan
from .scene import Scene
from .street_fronts import KINDS, Front, Line, Truth, between
from .town_layout import CAR, park_car

_CREATED = (*RECORDED, "cluster_id")

_FACADE_FIELDS = (
    Field("id", int, "number of the facade, as SegmentID of its points"),
    Field("kind", str, "kind of its front: plain, recess, bay, curved or balconies"),
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

# Angle (°) between the vertical scan plane of each scanner and the perpendicular of the drive, positive forward, by
# point source id. As on most mapping vehicles, each scanner sees one side of a recess.
PLANES = {1: 45.0, 2: -45.0}


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
    length: float = tunable(60.0, within="[10, 2000] m"),
    width: float = tunable(16.0, within="[12, 60] m"),
    slope: float = tunable(1.0, within="[0, 10]°"),
    clutter: bool = tunable(True),
    stoops: float = tunable(0.0, label="Height of stoops", within="[0, 4] m"),
    unevenness: float = tunable(0.0, within="[0, 1] m"),
    houses: bool = tunable(False),
    view: str = tunable("vehicle", choices=("vehicle", "airplane")),
    density: float = tunable(12.0, label="Pulse density", within="[0.5, 100] pulses/m²", advanced=True),
    glass: float = tunable(70.0, within="[0, 100] %"),
    speed: float = tunable(5.0, within="[0.5, 30] m/s", advanced=True),
    line_rate: float = LINE_RATE.with_default(100.0),
    angular_step: float = ANGULAR_STEP,
    max_range: float = tunable(40.0, within="[5, 200] m", advanced=True),
    range_noise: float = RANGE_NOISE.with_default(0.01),
    seed: int = SEED,
    monitor=None,
):
    """Simulate a street scanned from a vehicle or an airplane, with the true facades, windows, doors and corners.

    Houses adjoin along both sides. Their fronts are plain, curved, or have a recess, a bay or balconies; all have
    windows and doors. Parked cars, trees, poles and people occlude parts of them. The vehicle drives along the street
    once, with two scanners whose scan planes are turned forward and backward.

    Returns
    -------
    xyz, intensity, gps_time : ndarray of shape (n, ...)
        As for :func:`.simulate_town.simulate_town`.
    classification : ndarray of shape (n,), uint8
        True class: 2 ground; 3, 4, 5 vegetation by height; 6 buildings with their balconies; 1 cars, poles and people.
    return_number, number_of_returns : ndarray of shape (n,), uint8
        1 from the vehicle, which records the first echo only; from the airplane as for "Simulate town".
    scan_angle : ndarray of shape (n,), float32
        Angle of the beam to the nadir (°), negative to the left.
    point_source_id : ndarray of shape (n,), uint16
        From the vehicle 1 for the scanner turned forward on its left side, 2 for the other one; else flight lines.
    segment_id : ndarray of shape (n,), int32
        Number of the facade; 0 for other points, including reveals, panes and frames.
    cluster_id : ndarray of shape (n,), int32
        Number of the opening of a pane or frame; 0 for other points.
    facades, openings : LayerFeatures
        Polygons with Z, counterclockwise seen from the street; openings are in the plane of the front.
    corners : LayerFeatures
        Corners of the facades, points with Z.
    outlines : LayerFeatures
        Outlines of the houses on the ground, polygons with Z; empty without ``houses``.

    Other Parameters
    ----------------
    length
        Length of the street.
    width
        Distance between the fronts of both sides.
    slope
        Slope along the street.
    clutter
        Add parked cars, trees, poles and people that occlude parts of the fronts.
    stoops
        Height of the doors above the street, with stairs up to them. From 1.4 m on there are cellar windows.
    unevenness
        Largest offset of the ends of a front, forward or backward, from the common line of the fronts. Small values
        give fronts nearly in one plane.
    houses
        Add houses with gable roofs behind the fronts; then no front is curved.
    view
        Platform of the scanner. With the same seed, both scan the same street.
    density
        Mean density of laser pulses from the airplane.
    glass
        Share of pulses that pass through window panes and are lost.
    speed
        Speed of the vehicle.
    max_range
        Maximum range of the scanners.

    Raises
    ------
    ValueError
        If there would be more than 50 million pulses, or no beam meets anything.

    Notes
    -----
    Stairs lead straight up to a landing of 1.2 m in front of raised doors. A curved front consists of six plane strips;
    walls of neighboring houses in one plane are one facade. The roofs of houses are flush with their walls. The
    airborne scan is as in "Simulate town". The position of the vehicle is known exactly; noise is along the beam.
    Frames are 10 cm and panes 16 cm behind the front. Not simulated: rooms behind panes, mirror images in glass, and
    echoes of the vehicle's scanners that mix two surfaces at an edge.

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
    scene, truth, street = build_street(StreetPlan(length, width, slope, clutter, stoops, unevenness, houses, seed))
    if view == "airplane":
        refuse_large("The site", scene.size, density, "shorten the street or lower the pulse density")
        made = scan(scene, AirSurvey(density, range_noise=range_noise, seed=seed), monitor)
    else:
        made = _drive(scene, street, speed).scanned(scene, settings, monitor)
    made = _with_numbers(_through_glass(made, truth, glass, seed), truth, range_noise)
    if not len(made["xyz"]):
        raise ValueError(f"Nothing is within {max_range:g} m of the scanners; raise the maximum range.")
    return (*(made[name] for name in _CREATED), *_layers(truth))


@dataclass(frozen=True)
class Drive:
    """A straight drive of a vehicle with two line scanners on its roof."""

    start: np.ndarray  #: (3,): first position of the scanners (m)
    way: np.ndarray  #: (3,): unit vector of the drive
    #: length, speed: length (m) and speed (m/s) of the drive
    length: float
    speed: float

    def positions(self, time: np.ndarray) -> np.ndarray:
        """Return the positions (n, 3) (m) of the scanners at times (n,) (s)."""
        return self.start + self.speed * time[:, None] * self.way

    def scanned(self, scene: Scene, scan: LineScan, monitor: Monitor) -> Dimensions:
        """Return the dimensions of the points of a scanned scene by name, sorted by time."""
        per_turn, n_lines = pulses_per_turn(scan.angular_step), max(1, int(self.length / self.speed * scan.line_rate))
        # The vehicle drives at most a meter during a block.
        drawn = itertools.product(PLANES, list(scan.times(n_lines, np.arange(per_turn) / per_turn, 1.0 / self.speed)))
        blocks = [(number, time, np.random.default_rng([scan.seed, 5, i])) for i, (number, time) in enumerate(drawn)]
        return scan.scanned(scene, self.pulses, blocks, monitor)

    def pulses(self, scanner: int, time: np.ndarray, line_rate: float) -> tuple[Beams, np.ndarray]:
        """Return the beams of a scanner at times (n,) (s), and the left axes (n, 3) of the vehicle."""
        turn = np.deg2rad(PLANES[scanner])
        cos, sin = np.cos(turn), np.sin(turn)
        left = np.array([-self.way[1], self.way[0], 0.0]) / np.hypot(*self.way[:2])
        ahead = np.array([left[1], -left[0], 0.0])
        across = cos * left + sin * ahead
        # A scan line starts at the zenith and descends on the left.
        angle = 2 * np.pi * np.mod(time * line_rate, 1.0)[:, None]
        direction = np.cos(angle) * [0.0, 0.0, 1.0] + np.sin(angle) * across
        aim = np.column_stack(bearing(direction))
        return Beams(np.arange(len(time)), self.positions(time), direction, aim), np.tile(left, (len(time), 1))


def _drive(scene: Scene, street: Rect, speed: float) -> Drive:
    """Return a drive in the right lane, at different distances from the fronts of both sides."""
    ends = [np.array(street.at(sign * street.length / 2, -street.width / 8)) for sign in (-1, 1)]
    # The scanners are 2.2 m above the street.
    ends = [np.array([*end, float(scene.relief.plane(*end)) + 2.2]) for end in ends]
    way = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    return Drive(ends[0], way, street.length, speed)


def _through_glass(made: dict[str, np.ndarray], truth: Truth, share: float, seed: int) -> dict[str, np.ndarray]:
    """Remove a share (%) of the points on panes: pulses that pass through glass are lost."""
    is_glass = np.isin(made["segment_id"], sorted(truth.glass))
    chance = np.random.default_rng([seed, 6]).random(len(is_glass))
    kept = ~is_glass | (chance >= share / 100)
    return {name: values[kept] for name, values in made.items()}


def _with_numbers(made: dict[str, np.ndarray], truth: Truth, noise: float) -> dict[str, np.ndarray]:
    """Replace object ids by the numbers of facades and openings."""
    number = made["segment_id"]
    facade, opening = np.zeros((2, int(number.max(initial=0)) + 1), np.int32)
    for of, table in ((truth.facade_of, facade), (truth.opening_of, opening)):
        for own, true in of.items():
            if own < len(table):
                table[own] = true
    on_facade = facade[number]
    # Reveals and the ends of walls are faces of the same solids, but no part of the front.
    start = np.array([ring[0] for ring in truth.facades])
    step = np.array([ring[1] - ring[0] for ring in truth.facades])
    across = np.column_stack([-step[:, 1], step[:, 0]]) / np.hypot(step[:, 0], step[:, 1])[:, None]
    own = on_facade - 1
    x, y = (made["xyz"] - start[own])[:, :2].T
    off = x * across[own, 0] + y * across[own, 1]
    # Only 1 in 16,000 points of a front deviates by more than four standard deviations.
    on_facade[np.abs(off) > 0.01 + 4.0 * noise] = 0
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


@dataclass(frozen=True)
class StreetPlan:
    """Contents of a street: tunables of :func:`.simulate_street.simulate_street`."""

    length: float  #: Length of the street, m
    width: float  #: Distance between opposite fronts, m
    slope: float  #: Slope along the street, °
    clutter: bool  #: Whether cars, trees, poles and people occlude the fronts
    stoops: float  #: Height of the doors above the street, m
    unevenness: float  #: Largest offset of the ends of fronts from their common line, m
    houses: bool  #: Whether there are houses behind the fronts; then no front is curved
    seed: int  #: The same seed gives the same street

    def off_line(self, line: Line, rng: np.random.Generator) -> Line:
        """Return a line with its ends moved at random forward or backward."""
        first, last = rng.uniform(-1.0, 1.0, 2) * self.unevenness
        return between(line.at(0.0, first), line.at(line.length, last)) if self.unevenness else line


def build_street(plan: StreetPlan) -> tuple[Scene, Truth, Rect]:
    """Return a street, the truth of its fronts, and the area between the fronts; deterministic for a plan."""
    rng, of_fronts = np.random.default_rng([plan.seed, 4]), np.random.default_rng([plan.seed, 7])
    angle = float(rng.uniform(0.0, 2 * np.pi))
    size = plan.length + 2 * plan.width
    scene, truth = Scene(Relief(size, angle, float(np.tan(np.deg2rad(plan.slope))))), Truth()
    street = Rect(size / 2, size / 2, plan.length, plan.width, angle)
    for side in (1, -1):
        _build_side(scene, truth, street, side, plan, (rng, of_fronts))
    if plan.clutter:
        for side in (1, -1):
            _put_clutter(scene, street, side, rng)
    return scene, truth, street


def _build_side(
    scene: Scene, truth: Truth, street: Rect, side: int, plan: StreetPlan, chance: tuple[np.random.Generator, ...]
) -> None:
    """Add adjoining fronts, with the kinds in turn, and houses behind them if planned."""
    rng, of_fronts = chance
    # The street is on the right of the line: on the left side of the street the line runs forward.
    start = np.array(street.at(-side * street.length / 2, side * street.width / 2))
    way = side * np.array([np.cos(street.angle), np.sin(street.angle)])
    eave = rng.uniform(7.0, 11.0)
    widths = _divided(street.length, rng)
    kinds = [kind for kind in KINDS if kind != "curved"] if plan.houses else KINDS
    first = int(rng.integers(len(kinds)))
    for k, width in enumerate(widths):
        kind = kinds[(first + k) % len(kinds)]
        # Eaves differ by less than a storey.
        front = Front(plan.off_line(Line(start, way, width), of_fronts), eave + rng.uniform(0, 0.8), kind, plan.stoops)
        front.build(scene, truth)
        if plan.houses:
            front.build_house(scene, truth, float(of_fronts.uniform(30.0, 45.0)))
        start = start + width * way


def _divided(length: float, rng: np.random.Generator) -> np.ndarray:
    """Return random widths of houses, about 8 to 12 m, that add up to a length (m)."""
    share = rng.uniform(8.0, 12.0, max(1, round(length / 10.0)))
    return share / share.sum() * length


def _put_clutter(scene: Scene, street: Rect, side: int, rng: np.random.Generator) -> None:
    """Add cars, trees, poles and people that occlude the fronts of one side."""
    half = street.width / 2
    # A parking space every 6.5 m, 3.6 m from the fronts; 60 % hold a car.
    for along in np.arange(-street.length / 2 + 4.0, street.length / 2 - 3.0, 6.5):
        if rng.random() < 0.6:
            park_car(scene, street.part(float(along), side * (half - 3.6), *CAR))
    # A tree of 5 to 7 m about every 15 m, up to 2 m off its position, and a pole of 6 m 7 m beyond that position.
    for along in np.arange(-street.length / 2 + 6.0, street.length / 2 - 2.0, 15.0):
        x, y = street.at(along + rng.uniform(-2, 2), side * (half - 2.2))
        plant_tree(scene, (float(x), float(y), float(scene.relief.plane(x, y))), rng.uniform(5.0, 7.0), rng)
        scene.add_post(street.part(along + 7.0, side * (half - 2.4), 0.16, 0.16), 6.0, 0.5)
    # A person per 8 m on average, 1.75 m tall, on the sidewalk.
    for along in rng.uniform(-street.length / 2, street.length / 2, max(1, round(street.length / 8))):
        scene.add_post(street.part(float(along), side * (half - 1.2), 0.45, 0.45), 1.75, 0.5)


def pulses_of(length: float, speed: float, scan: LineScan) -> float:
    """Return the number of pulses of a drive with a length (m) and speed (m/s)."""
    return len(PLANES) * length / speed * scan.line_rate * pulses_per_turn(scan.angular_step)


def pulses_per_turn(angular_step: float) -> int:
    """Return the number of pulses of a scan line, a full turn."""
    return max(1, int(360.0 / angular_step + 1e-9))
