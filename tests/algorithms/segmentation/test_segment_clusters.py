"""DBSCAN against scikit-learn's, and against its definition."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.cluster import DBSCAN

from lidar_buildings.algorithms.geometry import boxes
from lidar_buildings.algorithms.segmentation.segment_clusters import dbscan, segment_clusters
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening


def of_sklearn(xyz, radius, min_points):
    return DBSCAN(eps=radius, min_samples=min_points).fit(xyz).labels_


# Eighths are exact in binary, so that points can lie exactly a radius apart.
eighths = st.integers(0, 24).map(lambda n: n / 8)


@given(
    st.lists(st.tuples(eighths, eighths, eighths), min_size=1, max_size=80),
    st.integers(1, 12).map(lambda n: n / 8),
    st.integers(1, 9),
)
@settings(max_examples=150)
def test_same_labels_as_scikit_learn_on_grids(points, radius, min_points):
    xyz = np.array(points)
    np.testing.assert_array_equal(dbscan(xyz, radius, min_points, Monitor()), of_sklearn(xyz, radius, min_points))


@pytest.mark.parametrize("seed", range(8))
def test_same_labels_as_scikit_learn_on_random_clouds(seed):
    random = np.random.default_rng(seed)
    xyz = random.uniform(0, [30, 20, 4], (1500, 3))
    radius, min_points = random.uniform(0.8, 1.5), int(random.integers(2, 8))
    expected = of_sklearn(xyz, radius, min_points)
    np.testing.assert_array_equal(dbscan(xyz, radius, min_points, Monitor()), expected)
    assert expected.max() >= 0
    assert (expected == -1).any()


def test_chunks_of_pairs_change_nothing(monkeypatch, rng):
    xyz = rng.uniform(0, [12, 12, 3], (600, 3))
    expected = of_sklearn(xyz, 1.0, 6)
    monkeypatch.setattr(boxes, "_PAIRS_AT_ONCE", 13)
    np.testing.assert_array_equal(dbscan(xyz, 1.0, 6, Monitor()), expected)


def test_a_border_point_goes_to_the_first_of_the_clusters_it_touches():
    """Two rows of core points with one point between them, which is near one core of each but is no core point."""
    y = np.array([0, 0.25, 0.5, 0.75, 1.75, 2.75, 3, 3.25, 3.5])
    xyz = np.column_stack([np.zeros(9), y, np.zeros(9)])
    assert dbscan(xyz, 1.0, 4, Monitor()).tolist() == [0, 0, 0, 0, 0, 1, 1, 1, 1]
    assert dbscan(xyz[::-1], 1.0, 4, Monitor()).tolist() == [0, 0, 0, 0, 0, 1, 1, 1, 1]
    # It is first, but the number of a cluster is its first core's.
    order = [4, 8, 7, 6, 5, 0, 1, 2, 3]
    assert dbscan(xyz[order], 1.0, 4, Monitor()).tolist() == [0, 0, 0, 0, 0, 1, 1, 1, 1]


def test_exactly_the_radius_apart_is_near():
    pair = np.array([[0.0, 0, 0], [1.5, 2.0, 0]])
    assert dbscan(pair, 2.5, 2, Monitor()).tolist() == [0, 0]
    assert dbscan(pair, np.nextafter(2.5, 0), 2, Monitor()).tolist() == [-1, -1]


def test_memory_follows_the_points_and_not_their_neighbors(rng):
    """With everything within reach of everything else, lists of neighbors would grow sixteenfold."""
    peaks = []
    for n in (4_000, 16_000):
        xyz = rng.uniform(0, [20, 20, 2], (n, 3))
        tracemalloc.start()
        labels = dbscan(xyz, 10.0, 100, Monitor())
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert (labels == 0).all()
    assert peaks[1] < 4.5 * peaks[0]


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


def test_cancel_gets_through(rng):
    with pytest.raises(Cancelled):
        dbscan(rng.uniform(0, 9, (50, 3)), 1.0, 3, Listening(stop_at=0.0))


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
