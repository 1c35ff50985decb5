"""A site for a drone flight: a street with houses on one side and at one end, parked cars, lamps and trees."""

import itertools

import numpy as np

from ..cloud.asprs import PointClass
from .bodies import Body, Rect, flat, gable
from .plants import plant_tree
from .relief import Relief
from .scene import Scene
from .town_layout import CAR, park_car

# Side of the site (m): more than twice the range of 30 m of a drone's scanner in its middle.
SIZE = 80.0

# Houses: center relative to the middle of the site, length and width (m), direction of the length (°), height of the
# eaves (m), whether the roof is a gable roof. The front is on the right of the direction.
_HOUSES = (
    (-7.5, 17.0, 14.0, 10.0, 0.0, 6.4, False),
    (6.5, 17.0, 14.0, 10.0, 0.0, 3.4, True),
    (23.0, -6.0, 11.0, 8.0, -90.0, 3.4, True),
)


def build_site(trees: int, slope: float, seed: int) -> Scene:
    """Return a site with a number of ``trees`` on a plane with a ``slope`` (°).

    The seed determines cars, trees, balconies and the direction of the slope.
    """
    rng = np.random.default_rng([seed, 2])
    angle = float(rng.uniform(0.0, 2 * np.pi))
    scene = Scene(Relief(SIZE, angle, float(np.tan(np.deg2rad(slope)))))
    for x, y, length, width, turn, eave, has_gable in _HOUSES:
        _build_house(scene, Rect(*_position(x, y), length, width, np.deg2rad(turn)), eave, has_gable, rng)
    # Cars in two rows along the street, up to 0.4 m and 3° off their positions.
    for y, x in itertools.product((8.2, -1.8), (-16.0, -10.5, -5.0, 6.5, 12.0)):
        park_car(scene, Rect(*_position(x + rng.uniform(-0.4, 0.4), y), *CAR, np.deg2rad(rng.uniform(-3.0, 3.0))))
    # Lamps of 6 m between the street and the houses.
    for x in (-18.0, -1.0, 16.0):
        scene.add_post(Rect(*_position(x, 9.8), 0.15, 0.15, 0.0), 6.0)
    for x, y in _tree_positions(trees, rng):
        foot = (*_position(x, y), float(scene.relief.ground(*_position(x, y))))
        plant_tree(scene, foot, rng.uniform(6.0, 11.0), rng)
    return scene


def _position(x: float, y: float) -> tuple[float, float]:
    """Return the coordinates (m) of a position relative to the middle of the site."""
    return SIZE / 2 + x, SIZE / 2 + y


def _build_house(scene: Scene, rect: Rect, eave: float, has_gable: bool, rng: np.random.Generator) -> None:
    """Add a house with balconies on its front; heights are above the ground at the center of the house."""
    number, ground = scene.new_id(), float(scene.relief.ground(rect.x, rect.y))
    tops = gable(rect, ground + eave, np.tan(np.deg2rad(38.0))) if has_gable else flat(rect, ground + eave)
    solids = [Body(rect, tops, ground - 3.0, PointClass.BUILDING, number)]
    # Storeys are 3 m high. Their balconies of 2.6 m by 1.2 m have parapets of 1 m; there is one every 5 m with a
    # probability of 70 %, at least 2 m below the eaves.
    for floor in np.arange(3.0, eave - 2.0, 3.0):
        for along in np.arange(-rect.length / 2 + 3.0, rect.length / 2 - 2.0, 5.0):
            if rng.random() < 0.7:
                slab = rect.part(float(along), -(rect.width + 1.2) / 2, 2.6, 1.2)
                solids.append(Body(slab, flat(slab, ground + floor + 1.0), ground + floor, PointClass.BUILDING, number))
    scene.add_building("block", rect.corners(), solids)


def _tree_positions(count: int, rng: np.random.Generator) -> list[tuple[float, float]]:
    """Return positions (m from the middle): first in front of the houses, then in rows 6 m apart to the south.

    Trees are up to 0.8 m off their positions.
    """
    in_rows = itertools.product((-9.0, -15.0, -21.0, -27.0), (-6.0, 6.0, 0.0, -12.0, 12.0))
    positions = [(-12.0, 5.0), (12.0, 4.0), *((x, y) for y, x in in_rows)][:count]
    return [(float(x + rng.uniform(-0.8, 0.8)), float(y + rng.uniform(-0.8, 0.8))) for x, y in positions]
