"""Roofs of simulated planes: which are high and large enough, and what belongs together."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.walls.classify_roofs import classify_roofs

DENSITY = 20.0


def plane(rng, west, south, width, depth, height, slope=0.0):
    n = round(width * depth * DENSITY)
    xy = rng.uniform((west, south), (west + width, south + depth), (n, 2))
    return np.column_stack([xy, height + slope * (xy[:, 1] - south)])


@pytest.fixture
def scene(rng):
    """A gable roof of two planes, a shed, a car, a small plane, a house without planes, all on level ground."""
    parts = [
        plane(rng, 0, 0, 10, 4, 3.0, 0.5),
        plane(rng, 0, 4, 10, 4, 5.0, -0.5),
        plane(rng, 20, 0, 4, 3, 2.6),
        plane(rng, 30, 0, 4.3, 1.8, 1.4),
        plane(rng, 40, 0, 1.5, 1.5, 4.0),
        plane(rng, 50, 0, 8, 8, 4.0),
        plane(rng, 0, 20, 60, 20, 0.0),
    ]
    sizes = [len(part) for part in parts]
    xyz = np.concatenate(parts)
    return {
        "xyz": xyz,
        "classification": np.repeat([1, 6, 1, 6, 1, 1, 2], sizes).astype(np.uint8),
        "height_above_ground": xyz[:, 2].astype(np.float32),
        "segment_id": np.repeat([1, 2, 3, 4, 5, 0, 0], sizes).astype(np.int32),
    }, np.repeat(np.arange(7), sizes)


def test_planes_above_the_least_height_that_lie_together_are_buildings(scene):
    arrays, part = scene
    classification, cluster_id = classify_roofs(**arrays)
    # From west to east; the car, the small plane and points on no plane are none.
    assert [sorted(set(cluster_id[part == i])) for i in range(7)] == [[1], [1], [2], [0], [0], [0], [0]]
    assert [sorted(set(classification[part == i])) for i in range(7)] == [[6], [6], [6], [1], [1], [1], [2]]


def test_segments_of_other_programs_have_any_number(scene):
    """-1 for none was refused with numpy's own words, and a number of two billion needed 16 GB."""
    arrays, _ = scene
    numbers = np.array([-1, 2_000_000_000, 7, 2**31 - 1, -2, 15], np.int32)
    renumbered = {**arrays, "segment_id": numbers[arrays["segment_id"]]}
    # The small plane, -2 here, is too small to be a roof under either number.
    for one, other in zip(classify_roofs(**renumbered), classify_roofs(**arrays)):
        np.testing.assert_array_equal(one, other)


def test_tunables_have_the_described_effect(scene):
    arrays, part = scene

    def found(**tunables):
        return [int(i) for i in range(6) if classify_roofs(**arrays, **tunables)[1][part == i].any()]

    assert found(min_height=1.0) == [0, 1, 2, 3]
    assert found(min_height=2.7) == [0, 1]
    assert found(min_area=1.0) == [0, 1, 2, 4]
    assert found(min_area=50.0) == [0, 1]
    joined = classify_roofs(**arrays, gap=12.0)[1]
    assert joined[part == 0].max() == joined[part == 2].max()


def test_a_roof_goes_down_to_its_eaves(rng):
    """Slopes from 2 to 4 m and from 1 to 3.4 m above the ground are roofs as a whole, one from 0.4 to 2.8 m is none."""
    for low, slope, found in ((2.0, 0.5, True), (1.0, 0.6, True), (0.4, 0.6, False)):
        roof = plane(rng, 0, 0, 10, 4, low, slope)
        height = roof[:, 2].astype(np.float32)
        _, cluster_id = classify_roofs(roof, np.ones(len(roof), np.uint8), height, np.ones(len(roof), np.int32))
        assert cluster_id.all() if found else not cluster_id.any()


def test_noise_is_no_roof(scene):
    arrays, part = scene
    arrays["classification"][part == 2] = PointClass.HIGH_NOISE
    classification, cluster_id = classify_roofs(**arrays)
    assert not cluster_id[part == 2].any()
    assert (classification[part == 2] == PointClass.HIGH_NOISE).all()


def test_the_order_of_points_changes_nothing(scene, rng):
    arrays, _ = scene
    order = rng.permutation(len(arrays["xyz"]))
    np.testing.assert_array_equal(
        classify_roofs(**{name: values[order] for name, values in arrays.items()})[1],
        classify_roofs(**arrays)[1][order],
    )


def test_a_few_points_far_apart_do_not_widen_the_gap_without_end():
    xyz = np.array([[0, 0, 0], [300, 0, 1], [0, 300, 8]], float)
    monitor = Monitor()
    classify_roofs(xyz, np.ones(3, np.uint8), xyz[:, 2].astype(np.float32), np.zeros(3, np.int32), monitor=monitor)
    assert monitor.values["gap"] == 5


def test_without_planes_nothing_is_a_roof_and_the_log_says_so(scene):
    arrays, _ = scene
    monitor = Monitor()
    classification, cluster_id = classify_roofs(
        **{**arrays, "segment_id": np.zeros(len(arrays["xyz"]), np.int32)}, monitor=monitor
    )
    assert not cluster_id.any()
    assert PointClass.BUILDING not in classification
    assert "No plane of 6 m² lies 2 m or more above the ground" in monitor.warnings[0]
