"""Clusters by density: what is gathered, and how dense it has to be."""

import numpy as np
import pytest

from lidar_buildings.algorithms.segmentation.segment_clusters import segment_clusters
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import FAR


def test_two_houses_and_stray_leaves_with_nothing_to_set(rng):
    """5 m between the houses, leaves too thin to be anything."""
    roofs = [
        np.column_stack([rng.uniform(west, west + 10, (1000, 1)), rng.uniform(0, 10, (1000, 1))]) for west in (0, 15)
    ]
    leaves = rng.uniform([0, 20, 2], [25, 60, 9], (200, 3))
    xyz = np.concatenate([np.column_stack([np.concatenate(roofs), rng.normal(5, 0.03, 2000)]), leaves])
    monitor = Monitor()
    ids = segment_clusters(xyz, np.ones(len(xyz)), monitor=monitor, density=10.0)
    assert monitor.values == {"density": 10.0, "radius": pytest.approx(3 / np.sqrt(10)), "min_points": 7}
    assert (ids[:1000] == 1).all()
    assert (ids[1000:2000] == 2).all()
    assert (ids[2000:] == 0).all()


def test_ground_noise_and_water_are_in_no_cluster_and_bridge_none():
    xyz = np.column_stack([np.arange(10.0), np.zeros(10), np.zeros(10)])
    for number in (2, 7, 9, 18, 20):
        classification = np.ones(10, int)
        classification[5] = number
        ids = segment_clusters(xyz, classification, radius=1.5, min_points=2)
        assert ids.tolist() == [1, 1, 1, 1, 1, 0, 2, 2, 2, 2]


def test_minimum_height_is_inclusive_and_needs_heights():
    xyz = np.column_stack([np.arange(6.0), np.zeros(6), np.zeros(6)])
    height = np.array([3, 2.5, 2.5, 1.9, 2.5, np.nan], np.float32)
    ids = segment_clusters(xyz, np.ones(6), height, min_height=2.5, radius=1.0, min_points=1)
    assert ids.tolist() == [1, 1, 1, 0, 2, 0]
    with pytest.raises(ValueError, match="needs HeightAboveGround; run 'Height above ground' first or set it to 0"):
        segment_clusters(xyz, np.ones(6), min_height=2.0)


def test_nothing_to_cluster_gives_no_id(rng):
    ids = segment_clusters(rng.uniform(0, 9, (50, 3)), np.full(50, 2))
    assert ids.dtype == np.int32
    assert not ids.any()
    assert segment_clusters(rng.uniform(0, 9, (50, 3)), np.ones(50), radius=0.001, min_points=2).max() == 0


def test_position_changes_nothing(rng):
    xyz = rng.uniform(0, [20, 20, 3], (800, 3)).round(3)
    ids = segment_clusters(xyz, np.ones(800), radius=1.0, min_points=4)
    assert ids.max() > 5
    np.testing.assert_array_equal(segment_clusters((xyz + FAR).round(3), np.ones(800), radius=1.0, min_points=4), ids)


def test_a_density_of_next_to_nothing_is_refused():
    """It made a radius whose square no float holds: an OverflowError."""
    with pytest.raises(ValueError, match=r"Point density \(density\) must be at least 0.001 points/m², got 1e-300"):
        segment_clusters(np.zeros((3, 3)), np.ones(3, np.uint8), density=1e-300)
    assert not segment_clusters(np.zeros((3, 3)), np.ones(3, np.uint8), density=0.001, min_points=4).any()


def test_only_points_of_segments_are_gathered_where_this_is_asked_for(rng):
    """Two roofs with a crown that touches both, without a plane: one cluster, or two."""
    xyz = np.column_stack([rng.uniform(0, 12, (3000, 1)), rng.uniform(0, 4, (3000, 1)), np.full((3000, 1), 5.0)])
    segment_id = np.where((xyz[:, 0] < 4) | (xyz[:, 0] > 8), 3, 0)
    nothing = np.zeros(len(xyz))
    assert segment_clusters(xyz, nothing, None, segment_id).max() == 1
    found = segment_clusters(xyz, nothing, None, segment_id, segments_only=True)
    assert found.max() == 2
    assert not found[segment_id == 0].any()
    with pytest.raises(ValueError, match="needs SegmentID"):
        segment_clusters(xyz, nothing, segments_only=True)
