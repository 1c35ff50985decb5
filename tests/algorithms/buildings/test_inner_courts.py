"""Courts with buildings on all sides, built with their truth: decks are of the building, ground is ground."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.complete_buildings import complete_buildings
from lidar_buildings.tests.builders import crown

SIDE, MIDDLE = 90.0, 45.0


class Block:
    """A block of 44 m, 10 m wide and 12 m high, around a court of 24 m, on a terrain; the court has its own level."""

    def __init__(self, rng, terrain=lambda x, y: 0 * x, court=None, density=4):
        x, y = rng.uniform(0, SIDE, (2, int(SIDE**2 * density)))
        off = np.maximum(np.abs(x - MIDDLE), np.abs(y - MIDDLE))
        self.is_court, self.is_roof = off < 12, (off >= 12) & (off <= 22)
        ground = terrain(x, y)
        z = np.where(self.is_court & (court is not None), (court or terrain)(x, y), ground)
        z = np.where(self.is_roof, np.median(ground[self.is_roof]) + 12, z)
        self.xyz = np.column_stack([x, y, z + rng.normal(0, 0.02, len(z))])
        self.height = np.where(self.is_roof, z - ground, 0.0)
        self.classification = np.where(self.is_roof, 6, 2).astype(np.uint8)

    def add(self, points, height):
        """Add points of no class."""
        self.xyz, self.height = np.concatenate([self.xyz, points]), np.append(self.height, height)
        self.classification = np.append(self.classification, np.full(len(points), 1, np.uint8))

    def completed(self):
        """Return the classes and the buildings of the points."""
        return complete_buildings(self.xyz, self.classification, self.height.astype(np.float32))[:2]

    def is_deck(self):
        """Return the share of the court's points that become building."""
        return (self.completed()[0][: len(self.is_court)][self.is_court] == 6).mean()


def cone(slope):
    return lambda x, y: -slope * np.hypot(x - MIDDLE, y - MIDDLE)


def level(elevation):
    return lambda x, y: np.full(len(x), elevation)


@pytest.mark.parametrize("rise", [2.6, 4.0])
def test_the_deck_of_a_court_is_of_the_building_around_it(rng, rise):
    block = Block(rng, court=level(rise))
    found, number = block.completed()
    assert (found[block.is_court] == 6).mean() > 0.97
    assert (number[block.is_court & (found == 6)] == 1).all()
    street = ~block.is_court & ~block.is_roof
    assert (found[street] == 2).all()


def test_trees_on_a_deck_stay_what_they_are(rng):
    block = Block(rng, court=level(3.0))
    leaves = crown(rng, MIDDLE, MIDDLE, 3.0, 8.0)
    block.add(leaves, leaves[:, 2] - 3.0)
    assert block.is_deck() > 0.97
    assert (block.completed()[0][-len(leaves) :] == 1).all()


@pytest.mark.parametrize(
    "court",
    [
        pytest.param(level(0.0), id="at street level"),
        pytest.param(level(1.5), id="with a terrace"),
        pytest.param(level(-4.0), id="sunken"),
    ],
)
def test_ground_of_a_court_stays_ground(rng, court):
    assert Block(rng, court=court).is_deck() == 0.0


def test_of_a_ramp_in_a_court_only_the_deck_that_it_leads_to_is_building(rng):
    """It rises by 4 m from the south to the north: what is more than 2 m high."""
    block = Block(rng, court=lambda x, y: np.clip((y - 36) / 4, 0, 4))
    found = block.completed()[0]
    for low, high, share in ((33, 43, 0.0), (46, 57, 1.0)):
        part = block.is_court & (block.xyz[:, 1] > low) & (block.xyz[:, 1] < high)
        assert (found[part] == 6).mean() == pytest.approx(share, abs=0.06)


@pytest.mark.parametrize("slope", [0.1, 0.2, 0.35])
def test_the_court_of_a_castle_on_a_hilltop_is_ground(rng, slope):
    """The hill goes on in it, or it was made level: it lies over all ground outside by up to 7 m."""
    assert Block(rng, terrain=cone(slope)).is_deck() == 0.0
    assert Block(rng, terrain=cone(slope), court=level(-8 * slope)).is_deck() == 0.0


@pytest.mark.parametrize("slope", [0.1, 0.3])
def test_a_garden_on_a_slope_is_ground(rng, slope):
    """Made level at the middle of the slope, it is higher than the street below and lower than that above."""

    def terrain(x, y):
        return slope * (y - MIDDLE)

    assert Block(rng, terrain=terrain).is_deck() == 0.0
    assert Block(rng, terrain=terrain, court=level(0.0)).is_deck() == 0.0


def test_a_court_that_opens_to_the_street_is_ground(rng):
    """A gap of 6 m in the block, up a ramp to 3 m: what leads up is terrain."""
    block = Block(rng, court=level(3.0))
    gap = block.is_roof & (np.abs(block.xyz[:, 0] - MIDDLE) < 3) & (block.xyz[:, 1] < MIDDLE)
    block.xyz[gap, 2] = np.clip((block.xyz[gap, 1] - 23) * 0.3, 0, 3)
    block.height[gap], block.classification[gap] = 0.0, 2
    assert block.is_deck() == 0.0


def test_where_hardly_any_street_is_seen_nothing_is_a_deck(rng):
    block = Block(rng, court=level(3.0))
    kept = block.is_roof | block.is_court
    found, _ = complete_buildings(block.xyz[kept], block.classification[kept], block.height[kept].astype(np.float32))[
        :2
    ]
    assert (found[block.is_court[kept]] == 2).all()
