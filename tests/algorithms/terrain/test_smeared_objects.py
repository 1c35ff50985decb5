"""Ground points on sheds and on the feet of walls, which a surface has climbed, and terrain that stays."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.terrain.smeared_objects import on_smeared_objects
from lidar_buildings.tests.builders import EXACT_FAR
from lidar_buildings.tests.surfaces import box, seen_from_above


def climbed(xyz, is_ground=None):
    return on_smeared_objects(xyz, np.ones(len(xyz), bool) if is_ground is None else is_ground, 0.16)


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_a_shed_is_found_on_any_slope(rng, slope):
    xyz, part = seen_from_above(rng, box(10, 10, 13, 13, 2.1, smeared=0.5))
    height = xyz[:, 2].copy()
    xyz[:, 2] += slope * xyz[:, 0]
    found = climbed(xyz)
    # Cells take in the slope within them.
    assert found[height > 0.5 + 2 * slope].all()
    assert not found[part == 0].any()


def test_the_ring_of_climbed_walls_around_a_house_is_found(rng):
    xyz, part = seen_from_above(rng, box(8, 8, 20, 20, 5.0, smeared=0.7))
    # The surface climbed the walls to 2.5 m; the roof itself is no ground.
    is_ground = xyz[:, 2] < 2.5
    found = climbed(xyz, is_ground)
    assert not found[~is_ground].any()
    assert found[is_ground & (xyz[:, 2] > 1.0)].mean() > 0.95
    assert not found[part == 0].any()


@pytest.mark.parametrize(
    "terrain",
    [
        lambda x, y: 0.6 * x + 0.2 * y,
        lambda x, y: 2.5 * np.clip((x - 15) / 2.5, 0, 1),
        lambda x, y: 1.5 * np.sin(x / 4) * np.sin(y / 5),
        lambda x, y: -2.0 * ((np.abs(x - 15) < 2) & (np.abs(y - 15) < 2)),
        lambda x, y: -np.tan(np.radians(20)) * np.abs(x + 0.3 * y - 19),
        lambda x, y: np.clip(2.5 - 0.6 * np.abs(y - 15), 0, 2),
    ],
    ids=["slope", "terrace", "hills", "pit", "ridge", "dike"],
)
def test_terrain_stays(rng, terrain):
    xyz = seen_from_above(rng, lambda x, y: terrain(x, y) + 10.0)[0]
    # At the very corners of the cloud no window reaches into the slope.
    in_corner = (np.abs(xyz[:, :2] - 15) > 14).all(axis=1)
    assert not climbed(xyz)[~in_corner].any()


def test_order_and_position_do_not_matter(rng):
    xyz = seen_from_above(rng, box(10, 10, 13, 13, 2.1, smeared=0.5))[0]
    xyz = np.round(xyz * 2**10) / 2**10
    order, found = rng.permutation(len(xyz)), climbed(xyz)
    assert found.any()
    np.testing.assert_array_equal(climbed(xyz[order] + EXACT_FAR), found[order])


def test_no_points():
    assert len(climbed(np.zeros((0, 3)))) == 0
