"""A made-up street for a vehicle: fronts on both sides, and trees, poles, cars and people before them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cloud.asprs import PointClass
from .plants import plant_tree
from .relief import Relief
from .scene import Scene
from .solids import Rect
from .street_fronts import KINDS, Front, Line, Truth, between
from .town_layout import park_car

# Least and greatest width of houses (m), before all widths are scaled to fill the street.
_WIDTHS = (8.0, 12.0)

# Least and greatest height of the eaves that is drawn for a side (m); each of its houses adds to it.
_EAVES = (7.0, 11.0)

# Most that a house adds to the height of the eaves of its side (m): less than a storey.
_DIFFERENCE = 0.8

# Least and greatest pitch of gable roofs (°).
_PITCHES = (30.0, 45.0)

# Distance of people from the fronts (m): they walk on the sidewalk.
_PEOPLE = 1.2

# Distance of trees from the fronts (m).
_TREES = 2.2

# Distance of poles from the fronts (m), in the row of trees.
_POLES = 2.4

# Distance of the middles of parked cars from the fronts (m), beyond the curb.
_CARS = 3.6

# Width and height of a person (m).
_PERSON = (0.45, 1.75)

# Width and height of a pole (m).
_POLE = (0.16, 6.0)


@dataclass(frozen=True)
class StreetPlan:
    """What a street holds: tunables of :func:`.simulate_street.simulate_street`."""

    length: float  #: Length of the street, m
    width: float  #: Distance from front to front, m
    slope: float  #: Slope along the street, °
    clutter: bool  #: Whether cars, trees, poles and people are before the fronts
    stoops: float  #: Height of the doors over the street, m
    unevenness: float  #: Greatest distance of the ends of fronts before or behind the line of the street, m
    houses: bool  #: Whether there are houses behind the fronts, none of which is curved then
    seed: int  #: The same seed makes the same street

    def off_line(self, line: Line, rng: np.random.Generator) -> Line:
        """Return a line with its ends moved at random before or behind the line of the street."""
        first, last = rng.uniform(-1.0, 1.0, 2) * self.unevenness
        return between(line.at(0.0, first), line.at(line.length, last)) if self.unevenness else line


def build_street(plan: StreetPlan) -> tuple[Scene, Truth, Rect]:
    """Return a made-up street, the truth of its fronts, and the area between these; the same for the same plan."""
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
    """Put fronts side by side, each of another kind than the one before, and houses behind them if the plan has any."""
    rng, of_fronts = chance
    # Seen along the line, the street is on the right: on the left of the street the line runs forward.
    start = np.array(street.at(-side * street.length / 2, side * street.width / 2))
    way = side * np.array([np.cos(street.angle), np.sin(street.angle)])
    eave = rng.uniform(*_EAVES)
    widths = _divided(street.length, rng)
    kinds = [kind for kind in KINDS if kind != "curved"] if plan.houses else KINDS
    first = int(rng.integers(len(kinds)))
    for k, width in enumerate(widths):
        kind = kinds[(first + k) % len(kinds)]
        height = eave + rng.uniform(0, _DIFFERENCE)
        front = Front(plan.off_line(Line(start, way, width), of_fronts), height, kind, plan.stoops)
        front.build(scene, truth)
        if plan.houses:
            front.build_house(scene, truth, float(of_fronts.uniform(*_PITCHES)))
        start = start + width * way


def _divided(length: float, rng: np.random.Generator) -> np.ndarray:
    """Return widths of houses that fill a length (m)."""
    count = max(1, round(length / np.mean(_WIDTHS)))
    share = rng.uniform(*_WIDTHS, count)
    return share / share.sum() * length


def _put_clutter(scene: Scene, street: Rect, side: int, rng: np.random.Generator) -> None:
    """Put what hides parts of the fronts of one side."""
    half = street.width / 2
    # A place to park each 6.5 m, of which six in ten are taken by cars of 4.3 m by 1.8 m.
    for along in np.arange(-street.length / 2 + 4.0, street.length / 2 - 3.0, 6.5):
        if rng.random() < 0.6:
            park_car(scene, street.part(float(along), side * (half - _CARS), 4.3, 1.8))
    # A tree each 15 m, up to 2 m off its place and 5 to 7 m high, and a pole 7 m beyond its place.
    for along in np.arange(-street.length / 2 + 6.0, street.length / 2 - 2.0, 15.0):
        x, y = street.at(along + rng.uniform(-2, 2), side * (half - _TREES))
        foot = (float(x), float(y), float(scene.relief.plane(x, y)))
        plant_tree(scene, foot, rng.uniform(5.0, 7.0), rng)
        _put_post(scene, street, along + 7.0, side * (half - _POLES), _POLE)
    # A person each 8 m on the average.
    for along in rng.uniform(-street.length / 2, street.length / 2, max(1, round(street.length / 8))):
        _put_post(scene, street, float(along), side * (half - _PEOPLE), _PERSON)


def _put_post(scene: Scene, street: Rect, along: float, across: float, size: tuple[float, float]) -> None:
    rect = street.part(along, across, size[0], size[0])
    ground = float(scene.relief.plane(rect.x, rect.y))
    scene.add_box(rect, ground - 0.5, ground + size[1], PointClass.UNCLASSIFIED)
