"""Roofs are separated from terrain, crowns and clutter in scenes whose truth is known by construction."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.classify_buildings import classify_buildings
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.sampling.density import point_density
from lidar_buildings.algorithms.segmentation.segment_roofs import segment_roofs
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import FAR, crown
from lidar_buildings.tests.monitors import Listening

FIELD, EAST, WEST, FLAT = range(4)
SIDE = 30.0


def village(rng, density=8.0, noise=0.02, slope=40.0):
    """Return points, heights and truth of a gable house of 12 m by 16 m and a flat one of 6 m by 8 m in a field."""
    plan = rng.uniform(0, SIDE, (int(SIDE**2 * density), 2))
    truth, height = np.full(len(plan), FIELD), np.zeros(len(plan))
    house = (np.abs(plan[:, 0] - 15) < 6) & (np.abs(plan[:, 1] - 15) < 8)
    truth[house] = np.where(plan[house, 0] > 15, EAST, WEST)
    height[house] = 3 + (6 - np.abs(plan[house, 0] - 15)) * np.tan(np.radians(slope))
    flat = (plan > [24, 0]).all(axis=1) & (plan[:, 1] < 8)
    truth[flat], height[flat] = FLAT, 2.8
    return np.column_stack([plan, height + rng.normal(0, noise, len(plan))]), height, truth


def ones(values):
    return np.ones(len(values), np.uint8)


def with_tree(rng, xyz, height, at, radius=3.0, middle=7.0, count=600):
    """Add a ball of leaves over the field."""
    ball = crown(rng, *at, radius, middle, count)
    return np.concatenate([xyz, ball]), np.concatenate([height, ball[:, 2]]), np.arange(len(xyz) + count) >= len(xyz)


@pytest.mark.parametrize("density", [2, 6, 20, 50])
@pytest.mark.parametrize("noise", [0.01, 0.03, 0.06])
def test_roofs_at_any_density_and_noise_with_nothing_to_set(density, noise, rng):
    xyz, height, truth = village(rng, density, noise)
    segment, cluster, _ = segment_roofs(xyz, ones(xyz), height)
    assert not cluster[truth == FIELD].any()
    for roof in (EAST, WEST, FLAT):
        # Where neighborhoods are smallest for their noise, normals scatter and a third of the points stay alone.
        assert (segment[truth == roof] > 0).mean() > (0.8 if noise < 0.05 else 0.6)
        assert (cluster[truth == roof] > 0).mean() > 0.8
    assert (segment[truth > 0] > 0).mean() > (0.9 if noise < 0.05 else 0.75)


def test_the_sides_of_a_gable_and_the_flat_roof_are_three_surfaces(rng):
    xyz, height, truth = village(rng)
    segment, cluster, _ = segment_roofs(xyz, ones(xyz), height)
    assert segment.dtype == cluster.dtype == np.int32
    numbers = [np.bincount(segment[truth == roof]).argmax() for roof in (EAST, WEST, FLAT)]
    assert len(set(numbers)) == 3
    assert 0 not in numbers
    for roof, number in zip((EAST, WEST, FLAT), numbers):
        assert (segment[truth == roof] == number).mean() > 0.95
        assert (truth[segment == number] == roof).mean() > 0.97


def test_roofs_keep_their_numbers_as_clusters_and_the_rest_follows(rng):
    xyz, height, _ = village(rng)
    xyz, height, is_leaf = with_tree(rng, xyz, height, (4, 4))
    segment, cluster, _ = segment_roofs(xyz, ones(xyz), height)
    np.testing.assert_array_equal(cluster[segment > 0], segment[segment > 0])
    assert sorted(set(segment[segment > 0])) == list(range(1, segment.max() + 1))
    assert sorted(set(cluster[cluster > 0])) == list(range(1, cluster.max() + 1))
    assert (segment[is_leaf] > 0).mean() < 0.05
    crown = np.bincount(cluster[is_leaf]).argmax()
    assert crown > segment.max()
    assert (cluster[is_leaf] == crown).mean() > 0.9
    assert is_leaf[cluster == crown].all()


@pytest.mark.parametrize(("max_slope", "apart"), [(90.0, True), (75.0, False)])
def test_a_wall_is_distinguished_from_the_crown_that_touches_it_unless_it_is_too_steep(max_slope, apart, rng):
    """A wall 6 m wide, seen from 2 to 14 m above the ground, and a crown of 3 m radius that reaches it."""
    along, up = rng.uniform([0, 2], [6, 14], (700, 2)).T
    wall = np.column_stack([along + 10, rng.normal(10, 0.02, 700), up])
    field = np.column_stack([rng.uniform(0, SIDE, (9000, 2)), np.zeros(9000)])
    xyz = np.concatenate([field, wall])
    xyz, height, is_crown = with_tree(rng, xyz, xyz[:, 2], at=(13, 12.8), middle=8.0)
    is_wall = ~is_crown & (xyz[:, 2] > 0)
    _, cluster, _ = segment_roofs(xyz, ones(xyz), height, max_slope=max_slope)
    of_wall, of_crown = (np.bincount(cluster[one]).argmax() for one in (is_wall, is_crown))
    assert of_wall > 0
    assert of_crown > 0
    assert (of_wall != of_crown) == apart
    if apart:
        assert (cluster[is_wall] == of_wall).mean() > 0.9
        assert (cluster[is_crown] == of_crown).mean() > 0.9


def test_low_and_small_surfaces_are_no_roofs(rng):
    xyz, height, truth = village(rng)
    is_flat = truth == FLAT
    assert not segment_roofs(xyz, ones(xyz), height, min_height=3.2)[0][is_flat].any()
    assert (segment_roofs(xyz, ones(xyz), height, min_height=2.5)[0][is_flat] > 0).mean() > 0.9
    assert not segment_roofs(xyz, ones(xyz), height, min_area=60)[0][is_flat].any()
    assert (segment_roofs(xyz, ones(xyz), height, min_area=35)[0][is_flat] > 0).mean() > 0.9


def test_what_goes_on_into_the_ground_is_no_roof(rng):
    """A ramp of 10 m that climbs from the ground to 6 m, 3 m on the mean, with a meter of ground on both sides."""
    plan = rng.uniform([0, 14], [40, 26], (3800, 2))
    is_ramp = np.abs(plan[:, 1] - 20) < 5
    height = np.where(is_ramp, 0.15 * plan[:, 0], 0.0)
    xyz = np.column_stack([plan, height + rng.normal(0, 0.02, 3800)])
    segment, _, reason = segment_roofs(xyz, ones(xyz), height)
    assert not segment.any()
    is_raised = height >= 1.5
    assert (reason[is_raised] == Reason.INTO_GROUND).mean() > 0.9
    assert not reason[~is_raised].any()
    assert reason.dtype == np.uint8


def test_a_bridge_on_scan_lines_is_no_roof(rng):
    """A deck 8 m wide over a river 40 m wide and 4 m deep, on lines 1.2 m apart, across which it hangs together."""
    x, y = rng.uniform([-60, -40], [60, 40], (115_200, 2)).T
    x = np.round(x / 1.2) * 1.2 + rng.normal(0, 0.03, len(x))
    is_road = np.abs(y) < 4
    ground = -4 * np.clip((22 - np.abs(x)) / 6, 0, 1)
    z = np.where(is_road, 0, ground) + rng.normal(0, 0.02, len(x))
    turned = np.column_stack([x * np.cos(0.5) - y * np.sin(0.5), x * np.sin(0.5) + y * np.cos(0.5), z])
    assert not segment_roofs(turned, ones(z), np.where(is_road, -ground, 0))[0].any()


def test_bridge_decks_and_objects_on_them_are_no_roofs(rng):
    """A deck 6 m high, a truck of 3 m on it that hides it, and a house of 6 m next to it."""
    deck, truck, house = (
        np.insert(rng.uniform(low, high, (8 * int(np.prod(np.subtract(high, low))), 2)), 2, z, axis=1)
        for low, high, z in (((0, 0), (40, 10), 6.0), ((15, 3), (27, 5), 9.0), ((0, 12), (10, 22), 6.0))
    )
    deck = deck[~((deck[:, 0] > 15) & (deck[:, 0] < 27) & (deck[:, 1] > 3) & (deck[:, 1] < 5))]
    xyz = np.concatenate([deck, truck, house])
    part = np.repeat([17, 1, 0], [len(deck), len(truck), len(house)])
    height = np.where(part == 1, 3.0, 6.0).astype(np.float32)
    classes = np.where(part == 17, 17, 1).astype(np.uint8)
    segment, cluster, _ = segment_roofs(xyz, classes, height)
    assert not cluster[part > 0].any()
    assert (segment[part == 0] > 0).mean() > 0.95
    assert (segment_roofs(xyz, np.ones_like(classes), height)[0][part == 1] > 0).any()


@pytest.mark.parametrize("noise", [0.1, 0.15])
def test_roofs_of_very_noisy_clouds_are_found(noise, rng):
    xyz, height, truth = village(rng, 40, noise)
    segment, _, _ = segment_roofs(xyz, ones(xyz), height)
    assert (segment[truth > 0] > 0).mean() > 0.75


def test_roofs_and_crowns_are_given_no_reason_yet(rng):
    xyz, height, _ = village(rng)
    xyz, height, _ = with_tree(rng, xyz, height, (4, 4))
    assert not segment_roofs(xyz, ones(xyz), height)[2].any()


def test_noise_is_in_no_cluster(rng):
    xyz, height, truth = village(rng)
    classification = np.where(truth == FLAT, 7, np.where(truth == EAST, 18, 1)).astype(np.uint8)
    segment, cluster, _ = segment_roofs(xyz, classification, height)
    assert not segment[truth != WEST].any()
    assert not cluster[truth != WEST].any()
    assert (segment[truth == WEST] > 0).mean() > 0.9


@pytest.mark.parametrize("side", [5.0, 10.0])
def test_a_porous_plane_is_no_building(rng, side):
    """A pergola, flat as a roof: half of the beams go through it. Solid roofs next to it are found."""
    plan = rng.uniform(0, 40, (16_000, 2))
    over, solid = (
        (np.abs(plan - middle) < reach).all(axis=1) for middle, reach in (([10, 20], side / 2), ([30, 20], 5))
    )
    caught = rng.random(len(plan)) < 0.5
    height = np.where(solid | (over & caught), 4.0, 0.0)
    xyz = np.column_stack([plan, height + rng.normal(0, 0.02, len(plan))])
    cluster = segment_roofs(xyz, ones(xyz), height)[1]
    found = classify_buildings(xyz, ones(xyz), cluster, n_neighbors=10)[0]
    assert (found[over] != 6).all()
    assert (found[solid] == 6).mean() > 0.95


def test_nothing_above_the_ground_gives_no_cluster(rng):
    plan = rng.uniform(0, 30, (3000, 2))
    xyz = np.column_stack([plan, rng.normal(0, 0.02, 3000)])
    segment, cluster, _ = segment_roofs(xyz, ones(xyz), xyz[:, 2])
    assert not segment.any()
    assert not cluster.any()


def test_only_a_tree_gives_no_roof(rng):
    """Where no surface is left at all, nothing may break either."""
    xyz, height, _ = with_tree(rng, np.empty((0, 3)), np.empty(0), (10, 10), radius=2)
    segment, cluster, _ = segment_roofs(xyz, ones(xyz), height, noise=0.02)
    assert (segment > 0).mean() < 0.1
    assert cluster.any()


@pytest.mark.parametrize("classification", [7, 1])
@pytest.mark.parametrize("count", [2, 5])
def test_a_few_points_do_no_harm(count, classification):
    xyz = np.column_stack([np.arange(count), np.zeros(count), np.full(count, 5.0)])
    segment, cluster, _ = segment_roofs(xyz, np.full(count, classification), xyz[:, 2])
    assert segment.tolist() == [0] * count
    assert len(cluster) == count
    assert not (classification == 7 and cluster.any())


def test_order_and_position_change_nothing(rng):
    xyz, height, _ = village(rng, 5)
    xyz, height, _ = with_tree(rng, xyz, height, (4, 4))
    xyz = xyz.round(3)
    cluster = segment_roofs(xyz, ones(xyz), height)[1]
    order = rng.permutation(len(xyz))
    shuffled = segment_roofs(xyz[order], ones(xyz), height[order])[1]
    moved = segment_roofs((xyz + FAR).round(3), ones(xyz), height)[1]
    for other, of in ((shuffled, cluster[order]), (moved, cluster)):
        assert ((other > 0) == (of > 0)).mean() > 0.999
        common = (other > 0) & (of > 0)
        assert len(set(zip(other[common].tolist(), of[common].tolist()))) == cluster.max() == other.max()


def test_automatic_values_are_reported(rng):
    monitor = Monitor()
    xyz, height, _ = village(rng, 8, 0.04)
    segment_roofs(xyz, ones(xyz), height, monitor=monitor)
    assert monitor.values["density"] == pytest.approx(8, rel=0.06)
    assert 0.02 < monitor.values["noise"] < 0.05


def test_gaps_between_scan_lines_are_no_gaps_of_the_cloud(rng):
    """On lines 2 m apart points are dense where they lie, and scales of the roofs must cross the gaps all the same."""
    monitor = Monitor()
    xyz, height, _ = village(rng, 8)
    xyz[:, 1] = 2 * np.round(xyz[:, 1] / 2)
    segment_roofs(xyz, ones(xyz), height, monitor=monitor)
    assert monitor.values["density"] < 0.6 * point_density(xyz)


@pytest.mark.parametrize(("stop_at", "stops"), [(0.76, 0.8), (0.81, 0.85)])
def test_cancel_gets_through_between_all_steps(stop_at, stops, rng):
    """After the decks, and after the surfaces."""
    xyz, height, _ = village(rng, 3)
    monitor = Listening(stop_at=stop_at)
    with pytest.raises(Cancelled):
        segment_roofs(xyz, ones(xyz), height, monitor=monitor)
    assert monitor.heard[-1] == pytest.approx(stops)
