"""Heights above a ground of a few points, worked out by hand, and above grounds given by formulas."""

import numpy as np
import pytest
from scipy.interpolate import LinearNDInterpolator

from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.terrain.compute_height_above_ground import compute_height_above_ground
from lidar_buildings.tests.builders import FAR


def test_few_points_by_hand():
    ground = [[0, 0, 10], [10, 0, 10], [10, 10, 20], [0, 10, 20]]  # rises by 1 m per meter of northing
    above = [[5, 5, 18], [2, 1, 11], [9, 9, 12], [4, 10, 20.5]]
    height = compute_height_above_ground(np.array(ground + above, float), [2, 2, 2, 2, 1, 6, 5, 18])
    assert height.dtype == np.float32
    np.testing.assert_allclose(height, [0, 0, 0, 0, 3, 0, -7, 0.5], atol=1e-6)


def test_height_over_a_bumpy_ground(rng):
    """Truth by formula: the ground is a wave, and the surface under a point misses it by less than its bend."""
    plan = rng.uniform(0, 80, (6000, 2))
    wave = 3 * np.sin(plan[:, 0] / 10) + 0.2 * plan[:, 1]
    lift = np.where(np.arange(6000) % 3 == 0, rng.uniform(0, 30, 6000), 0.0)
    inside = ((plan > 3) & (plan < 77)).all(axis=1)
    height = compute_height_above_ground(np.column_stack([plan, wave + lift]), np.where(lift == 0, 2, 1))
    np.testing.assert_allclose(height[inside], lift[inside], atol=0.08)


def test_outside_the_ground_the_nearest_ground_point_is_used_and_the_log_has_their_number():
    ground = np.array([[0, 0, 1], [4, 0, 2], [0, 4, 3], [4, 4, 4]], float)
    outside = np.array([[-3, -1, 6], [9, 5, 6], [2, 900, 6], [40_000, -30_000, 6]], float)
    inside = np.array([[2, 2, 6]], float)
    xyz = np.concatenate([ground, outside, inside])
    monitor = Monitor()
    height = compute_height_above_ground(xyz, [2] * 4 + [1] * 5, monitor=monitor)
    np.testing.assert_allclose(height[4:8], [5, 2, 6 - 3, 4], atol=1e-6)
    assert height[8] == pytest.approx(3.5)
    assert len(monitor.infos) == 1
    assert "4 of 9 points" in monitor.infos[0]


def test_inside_the_ground_nothing_is_reported():
    monitor = Monitor()
    compute_height_above_ground(np.array([[0, 0, 1], [4, 0, 2], [0, 4, 3], [1, 1, 4.0]]), [2, 2, 2, 1], monitor=monitor)
    assert monitor.warnings == monitor.infos == []


def test_every_point_over_the_hull_of_the_ground_is_measured_from_the_surface(rng):
    """On steep, sparse ground points within 0.3 m of the hull's edge were taken for outside, and were 2.6 m off."""
    plan = rng.uniform(0, 60, (1300, 2))
    # One point in each cell of 0.5 m: it is a node as it is.
    plan = plan[np.sort(np.unique(np.floor(plan / 0.5), axis=0, return_index=True)[1])][:1100]
    ground = np.column_stack([plan, plan[:, 0] + rng.normal(0, 0.3, 1100)])
    above = np.column_stack([rng.uniform(0, 60, (20_000, 2)), np.full(20_000, 100.0)])
    expected = 100 - LinearNDInterpolator(ground[:, :2], ground[:, 2])(above[:, :2])
    is_inside = np.isfinite(expected)
    monitor = Monitor()
    classes = np.repeat([2, 1], [1100, 20_000])
    height = compute_height_above_ground(np.concatenate([ground, above]), classes, monitor=monitor)[1100:]
    np.testing.assert_allclose(height[is_inside], expected[is_inside], atol=1e-4)
    assert f"{(~is_inside).sum()} of 21100 points" in monitor.infos[0]


def test_noise_of_single_ground_points_does_not_reach_heights(rng):
    ground = np.column_stack([rng.uniform(0, 30, (36_000, 2)), rng.normal(0, 0.05, 36_000)])
    above = np.column_stack([rng.uniform(1, 29, (5000, 2)), np.full(5000, 8.0)])
    height = compute_height_above_ground(np.concatenate([ground, above]), np.repeat([2, 1], [36_000, 5000]))[36_000:]
    # Ten points in a cell, and interpolation between three cells.
    assert np.std(height - 8.0) < 0.05 / np.sqrt(10)


def test_one_ground_point_is_a_level_ground():
    height = compute_height_above_ground(np.array([[5, 5, 2], [9, 1, 10], [5, 5, 4.0]]), [2, 1, 1])
    np.testing.assert_allclose(height, [0, 8, 2])


def test_no_ground_is_refused():
    with pytest.raises(ValueError, match=r"no ground points \(class 2\); run 'Classify ground points \(TIN\)' first"):
        compute_height_above_ground(np.zeros((3, 3)), [1, 6, 7])


def test_order_and_position_change_nothing(rng):
    xyz = rng.uniform(0, 50, (2000, 3))
    classification = np.where(rng.random(2000) < 0.4, 2, 1)
    height = compute_height_above_ground(xyz, classification)
    order = rng.permutation(2000)
    np.testing.assert_array_equal(compute_height_above_ground(xyz[order], classification[order]), height[order])
    np.testing.assert_allclose(compute_height_above_ground(xyz + FAR, classification), height, atol=1e-4)
    lifted = compute_height_above_ground(xyz + [0, 0, 321.5], classification)
    np.testing.assert_allclose(lifted, height, atol=1e-5)


def test_points_above_change_nothing(rng):
    """Only ground makes ground: heights of points don't depend on each other."""
    xyz = rng.uniform(0, 50, (600, 3))
    classification = np.repeat([2, 1], 300)
    sampling = CloudSampling.of(xyz)
    everything = compute_height_above_ground(xyz, classification, sampling=sampling)
    some = compute_height_above_ground(xyz[:350], classification[:350], sampling=sampling)
    np.testing.assert_array_equal(everything[:350], some)


def test_heights_do_not_depend_on_where_the_cloud_lies(rng):
    """The cells whose means are nodes began at multiples of their size, wherever the cloud begins."""
    # Binary fractions, so that no sum is rounded.
    xyz = rng.integers(0, 50 * 1024, (6000, 3)) / 1024 * [1, 1, 1 / 64]
    classification = np.repeat([2, 1], 3000)
    height = compute_height_above_ground(xyz, classification)
    moved = compute_height_above_ground(xyz + [1234.375, 87.84375, 0], classification)
    np.testing.assert_allclose(moved, height, atol=1e-6)


def test_objects_on_a_bridge_are_measured_from_its_deck():
    """A deck 6 m over a road, a car on it, and a lamp next to the road under it."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0, 20, 0.5), np.arange(0, 20, 0.5)))
    road = np.column_stack([x, y, np.zeros(len(x))])
    deck = np.column_stack([x, y, np.full(len(x), 6.0)])[np.abs(y - 10) < 4]
    others = np.array([[10, 10, 7.5], [10, 10, 3.0], [10, 1, 3.0]])
    xyz = np.concatenate([road, deck, others])
    classes = np.repeat([2, 17, 1], [len(road), len(deck), 3]).astype(np.uint8)
    height = compute_height_above_ground(xyz, classes)
    np.testing.assert_allclose(height[-3:], [1.5, 3.0, 3.0])
    np.testing.assert_allclose(height[len(road) : -3], 6.0)


def test_a_house_beside_a_bridge_is_measured_from_the_ground():
    """A deck 6 m over the land, a truck that hides it from the scanner, and a roof 9 m high 1.5 m next to it."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0, 30, 0.5), np.arange(0, 30, 0.5)))
    on_deck, on_roof = np.abs(y - 10) < 4, (y > 14.5) & (y < 24)
    hidden = (np.abs(x - 12) < 3) & (np.abs(y - 10) < 1.3)
    deck = np.column_stack([x, y, np.full(len(x), 6.0)])[on_deck & ~hidden]
    truck = np.column_stack([x, y, np.full(len(x), 8.5)])[hidden]
    roof = np.column_stack([x, y, np.full(len(x), 9.0)])[on_roof]
    land = np.column_stack([x, y, np.zeros(len(x))])[~on_roof]
    xyz = np.concatenate([land, deck, truck, roof])
    classes = np.repeat([2, 17, 1, 1], [len(land), len(deck), len(truck), len(roof)]).astype(np.uint8)
    height = compute_height_above_ground(xyz, classes)
    np.testing.assert_allclose(height[-len(roof) :], 9.0)
    np.testing.assert_allclose(height[-len(roof) - len(truck) : -len(roof)], 2.5)
