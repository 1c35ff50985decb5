"""Where roofs end in matched images: rounded edges, gaps, smeared walls, crowns next to them, vehicles."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.roof_extent import (
    RoofExtent,
    amid_rough,
    smallest_rectangle,
    without_vehicles,
)
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.packages import ndimage
from lidar_buildings.algorithms.sampling.top_surface import TopSurface
from lidar_buildings.tests.surfaces import box, mound, seen_from_above

ROOF = (8.0, 8.0, 18.0, 16.0)
# A gap (m) that is closed between roofs.
GAP = 1.5


class Site:
    """A surface, and the cells of the points that the stages before have found on roofs."""

    def __init__(self, rng, *parts):
        self.xyz, self.part = seen_from_above(rng, *parts)
        self.surface = TopSurface(self.xyz, self.xyz[:, 2], np.ones(len(self.xyz), bool), 40.0)

    def extent(self, found):
        cells = np.zeros(self.surface.height.shape, bool)
        cells[self.surface.cell[0][found], self.surface.cell[1][found]] = True
        return RoofExtent(self.surface, cells)

    def within(self, west, south, east, north):
        return ((self.xyz[:, :2] >= [west, south]) & (self.xyz[:, :2] <= [east, north])).all(axis=1)

    def at(self, cells):
        """Return the value at each point, its cell's."""
        return cells[self.surface.cell]


def inset(distance):
    west, south, east, north = ROOF
    return west + distance, south + distance, east - distance, north - distance


@pytest.fixture
def house(rng):
    """A roof of 10 m by 8 m, 5 m high, whose walls are smeared over half a meter to both sides."""
    return Site(rng, box(*ROOF, 5.0, smeared=0.5))


def test_roofs_reach_to_half_their_height(house):
    covered = house.at(house.extent(house.within(*inset(0.6))).covered(GAP))
    assert covered[house.within(*inset(0.3))].all()
    # Half of the height is where the wall is, cells are a quarter of a meter.
    assert not covered[~house.within(*inset(-0.3))].any()
    assert covered.sum() / 40 == pytest.approx(80.0, rel=0.06)


@pytest.mark.parametrize(
    ("width", "gap", "closed"),
    [(1.0, GAP, True), (3.0, GAP, False), (3.0, 4.0, True), (1.0, 0.0, False)],
)
def test_gaps_in_a_roof_are_closed_up_to_their_width(house, width, gap, closed):
    found = house.within(*inset(0.6)) & (np.abs(house.xyz[:, 0] - 13) > width / 2)
    covered = house.at(house.extent(found).covered(gap))
    # Edges reach on by 0.7 m: what lies farther from what was found is left to the gap.
    middle = (np.abs(house.xyz[:, 0] - 13) < 0.2) & house.within(*inset(1.5))
    if width > 1.5:
        assert covered[middle].all() == closed
    elif closed:
        assert covered[middle].all()


def test_a_yard_in_which_the_ground_shows_stays_open(rng):
    site = Site(rng, lambda x, y: box(*ROOF, 5.0)(x, y) * ~((np.abs(x - 13) < 0.6) & (np.abs(y - 12) < 0.6)))
    covered = site.at(site.extent(site.part == 1).covered(GAP))
    assert not covered[site.within(12.6, 11.6, 13.4, 12.4)].any()


def test_strips_narrower_than_a_building_are_left_out(rng):
    site = Site(rng, box(*ROOF, 5.0), box(2.0, 20.0, 25.0, 20.6, 3.0))
    extent = site.extent(site.part > 0)
    assert not site.at(extent.covered(GAP))[site.part == 2].any()


def test_smeared_walls_belong_to_the_building(house):
    extent = house.extent(house.within(*inset(0.6)))
    building = extent.covered(GAP).astype(np.int32)
    with_walls = house.at(extent.faces(building)) > 0
    is_wall = (house.part == 1) & (house.xyz[:, 2] > 1.0)
    assert not (house.at(building) > 0)[is_wall & (house.xyz[:, 2] < 1.5)].any()
    assert with_walls[is_wall].mean() > 0.97
    assert not with_walls[~house.within(*inset(-0.8))].any()


def test_a_bush_at_the_wall_is_no_wall(rng):
    site = Site(rng, box(*ROOF, 5.0, smeared=0.3), mound((19.6, 12.0), 1.6, 1.5))
    extent = site.extent(site.within(*inset(0.4)))
    walls = site.at(extent.faces(extent.covered(GAP).astype(np.int32))) > 0
    bush = (site.part == 2) & (site.xyz[:, 0] > 19.0)
    assert bush.sum() > 100
    assert not walls[bush].any()


def test_walls_have_the_number_of_their_building(rng):
    site = Site(rng, box(5, 5, 11, 11, 5.0, smeared=0.4), box(14, 5, 20, 11, 4.0, smeared=0.4))
    extent = site.extent(site.within(5.5, 5.5, 10.5, 10.5) | site.within(14.5, 5.5, 19.5, 10.5))
    number = ndimage.label(extent.covered(GAP), np.ones((3, 3)))[0].astype(np.int32)
    walls = site.at(extent.faces(number))
    assert set(walls[site.xyz[:, 0] < 12.4]) == {0, 1}
    assert set(walls[site.xyz[:, 0] > 12.6]) == {0, 2}


@pytest.mark.parametrize(
    ("width", "length", "height", "is_vehicle"),
    [
        (2.0, 5.4, 2.4, True),
        (1.8, 4.3, 1.5, True),
        (2.0, 5.4, 3.5, False),
        (2.0, 2.5, 2.2, False),
        (3.2, 5.4, 2.4, False),
        (1.8, 3.2, 2.3, False),
        (2.2, 9.0, 2.4, False),
    ],
    ids=["van", "car", "too high", "shed", "garage", "short", "long"],
)
@pytest.mark.parametrize("turn", [0.0, 30.0])
def test_vehicles_are_reported_by_their_size(rng, width, length, height, is_vehicle, turn):
    cos, sin = np.cos(np.deg2rad(turn)), np.sin(np.deg2rad(turn))

    def body(x, y):
        along, across = (x - 15) * cos + (y - 15) * sin, (y - 15) * cos - (x - 15) * sin
        return height * ((np.abs(along) < length / 2) & (np.abs(across) < width / 2))

    site = Site(rng, body)
    extent = site.extent(site.part == 1)
    building = (extent.is_roof).astype(np.int32)
    left, refused = without_vehicles(extent, building, np.zeros(building.shape, np.uint8))
    assert (left.max() == 0) == is_vehicle
    assert (refused[building > 0] == (Reason.VEHICLE if is_vehicle else 0)).all()


@pytest.mark.parametrize("turn", [0.0, 20.0, 45.0, 80.0])
def test_the_smallest_rectangle_of_a_turned_one(turn):
    row, column = np.mgrid[-60:60, -60:60] * 0.1
    cos, sin = np.cos(np.deg2rad(turn)), np.sin(np.deg2rad(turn))
    inside = (np.abs(column * cos + row * sin) < 3) & (np.abs(row * cos - column * sin) < 1)
    width, length = smallest_rectangle(inside, 0.1)
    assert width == pytest.approx(2.0, abs=0.25)
    assert length == pytest.approx(6.0, abs=0.25)


def test_smooth_spots_of_crowns_lie_amid_what_is_rough(rng):
    site = Site(rng, box(5, 5, 13, 11, 6.0), mound((20.0, 20.0), 4.0, 6.0, rough=0.5))
    spot = np.hypot(*(site.xyz[:, :2] - [20, 20]).T) < 0.9
    segment = np.where(site.part == 1, 1, np.where(spot, 2, 0)).astype(np.int32)
    amid = amid_rough(site.surface, site.xyz, segment)
    assert amid[spot].all()
    assert not amid[~spot].any()
    # Other programs number surfaces as they like.
    np.testing.assert_array_equal(amid_rough(site.surface, site.xyz, segment * 1_000_000_000), amid)


def test_a_shed_beside_a_bush_does_not(rng):
    site = Site(rng, box(5, 5, 8, 7.5, 2.2, smeared=0.2), mound((9.0, 6.2), 1.2, 2.4, rough=0.3))
    segment = (site.within(5.3, 5.3, 7.7, 7.2) & (site.part == 1)).astype(np.int32)
    assert not amid_rough(site.surface, site.xyz, segment).any()
