"""DBSCAN against scikit-learn's, and against its definition."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.cluster import DBSCAN

from lidar_buildings.algorithms.geometry import boxes
from lidar_buildings.algorithms.neighborhoods.dbscan import dbscan
from lidar_buildings.algorithms.stage import Cancelled, Monitor
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
    monkeypatch.setattr(boxes, "PAIRS_AT_ONCE", 13)
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


def test_cancel_gets_through(rng):
    with pytest.raises(Cancelled):
        dbscan(rng.uniform(0, 9, (50, 3)), 1.0, 3, Listening(stop_at=0.0))
