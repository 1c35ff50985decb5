"""Groups of multipath points under the ground are low noise; shafts, stairs and excavations stay ground."""

import numpy as np
import pytest

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.terrain.classify_ground_tin import classify_ground_tin
from lidar_buildings.algorithms.terrain.classify_multipath import classify_multipath, false_pits
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.pits import scene

WIDTH = 50.0
MIDDLE = WIDTH / 2


def terrain(rng, density, slope=0.0, roughness=0.02):
    """Return points (n, 3) of a plane that rises eastward by ``slope`` (°)."""
    plan = rng.uniform(0, WIDTH, (int(density * WIDTH**2), 2))
    rise = np.tan(np.radians(slope)) * plan[:, 0]
    return np.column_stack([plan, rise + rng.normal(0, roughness, len(plan))])


def in_box(xyz, length, width):
    """Return which points lie in a rectangle in the middle."""
    return (np.abs(xyz[:, :2] - MIDDLE) <= [length / 2, width / 2]).all(axis=1)


def group(rng, count, radius, depth, slope=0.0):
    """Return multipath points (count, 3) from under the middle."""
    angle, far = rng.uniform(0, 2 * np.pi, count), radius * np.sqrt(rng.random(count))
    plan = MIDDLE + (far * [np.cos(angle), np.sin(angle)]).T
    return np.column_stack([plan, np.tan(np.radians(slope)) * plan[:, 0] - depth + rng.normal(0, 0.03, count)])


def classified(xyz):
    return classify_multipath(xyz, classify_ground_tin(xyz, np.ones(len(xyz), np.uint8)))


@pytest.mark.parametrize("slope", [0.0, 25.0])
@pytest.mark.parametrize("density", [2, 8, 30])
@pytest.mark.parametrize(("count", "radius", "depth"), [(3, 0.3, 0.7), (5, 0.8, 6.0), (12, 0.4, 1.5), (20, 0.8, 3.0)])
def test_a_group_is_low_noise_and_the_ground_over_it_stays(density, slope, count, radius, depth, rng):
    """In one town, 483 of 814 points of low noise had become ground, in groups of up to twenty: pits in every DTM."""
    ground = terrain(rng, density, slope)
    low = group(rng, count, radius, depth, slope)
    found = classified(np.concatenate([ground, low]))
    assert (found[len(ground) :] == 7).all()
    assert (found[: len(ground)] == 7).sum() == 0
    around = np.linalg.norm(ground[:, :2] - MIDDLE, axis=1) < 3
    assert (found[: len(ground)][around] == 2).mean() > 0.97


@pytest.mark.parametrize("density", [8, 30])
@pytest.mark.parametrize(
    ("length", "width", "depth"),
    [(2.0, 1.0, 2.0), (1.5, 1.5, 4.0), (9.0, 6.0, 2.0)],
    ids=["shaft", "well", "excavation"],
)
def test_a_pit_that_stops_every_pulse_is_no_noise(length, width, depth, density, rng):
    xyz = terrain(rng, density)
    xyz[in_box(xyz, length, width), 2] -= depth
    assert (classified(xyz) != 7).all()


def test_stairs_that_lead_down_are_no_noise(rng):
    xyz = terrain(rng, 8)
    inside = in_box(xyz, 5, 1.4)
    xyz[inside, 2] -= 0.18 * np.floor((xyz[inside, 0] - MIDDLE + 2.5) / 0.3)
    assert (classified(xyz) != 7).all()


def test_a_group_beside_a_wall(rng):
    """On one side of it no ground is seen."""
    ground = terrain(rng, 8)
    house = (ground[:, 0] > MIDDLE + 0.5) & (ground[:, 0] < MIDDLE + 11) & (np.abs(ground[:, 1] - MIDDLE) < 8)
    ground[house, 2] += 6
    found = classified(np.concatenate([ground, group(rng, 8, 0.4, 2.0)]))
    assert (found[len(ground) :] == 7).all()
    assert (found[: len(ground)] != 7).all()


def test_a_narrow_ditch_is_no_noise(rng):
    xyz = terrain(rng, 4)
    xyz[np.abs(xyz[:, 0] - MIDDLE) < 0.6, 2] -= 1.0
    assert (classified(xyz) != 7).all()


def test_hollows_of_rough_ground_are_no_noise(rng):
    """Blocks and stumps: surfaces as rough as this have true pits everywhere."""
    xyz = terrain(rng, 4, roughness=0.35)
    assert (classified(xyz) != 7).all()


def test_order_and_position_change_nothing(rng):
    ground = terrain(rng, 8, 10)
    xyz = np.concatenate([ground, group(rng, 9, 0.5, 1.2, 10)])
    xyz = np.round(xyz * 1024) / 1024
    found, order = classified(xyz), rng.permutation(len(xyz))
    assert (found == 7).sum() == 9
    np.testing.assert_array_equal(classified(xyz[order]), found[order])
    np.testing.assert_array_equal(classified(xyz + FAR), found)


def test_a_surface_without_pits_has_none(rng):
    xyz = terrain(rng, 2)
    every = np.ones(len(xyz), bool)
    assert len(false_pits(xyz, every, np.zeros(len(xyz)), every, 0.7, Monitor())) == 0
    few = every & (np.arange(len(xyz)) < 20)
    assert len(false_pits(xyz, few, np.zeros(len(xyz)), every, 0.7, Monitor())) == 0


@pytest.mark.parametrize(("density", "slope"), [(4.0, 15.0), pytest.param(12.0, 3.0, marks=pytest.mark.slow)])
def test_a_town_with_groups_and_pits(density, slope):
    """Aimed at: four fifths of the points under the ground at a correctness of nine tenths; true pits stay."""
    town = scene(density=density, slope=slope, groups=25, size=120.0, seed=11)
    for stage in ("classify_ground_tin", "classify_multipath"):
        run_stage(STAGES[stage], town.cloud)
    found = town.cloud.get("classification")
    is_low, is_group = found == 7, town.group > 0
    assert is_low[is_group].mean() > 0.8
    assert is_group[is_low].mean() > 0.9
    assert (found[is_group] == 2).mean() < 0.15
    seen = [number for number in np.unique(town.pit[town.pit > 0]) if (town.pit == number).sum() >= 8]
    assert len(seen) > 5
    assert not is_low[np.isin(town.pit, seen)].any()


@pytest.mark.parametrize("nodes", [0, 1, 2])
def test_a_surface_of_few_nodes_has_no_pits(nodes, rng):
    xyz, is_node = terrain(rng, 0.02), np.zeros(50, bool)
    is_node[:nodes] = True
    above = np.full(50, -3.0)
    assert not len(false_pits(xyz[:50], is_node, above, np.ones(50, bool), 7.0, Monitor()))


def test_a_cloud_without_ground_is_refused(rng):
    xyz = terrain(rng, 2)
    with pytest.raises(ValueError, match="no ground points"):
        classify_multipath(xyz, np.ones(len(xyz), np.uint8))
