"""Components of "closer in plan and closer in height" against a graph of all pairs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from lidar_buildings.algorithms.geometry import boxes
from lidar_buildings.algorithms.geometry.boxes import by_first_point, connect
from lidar_buildings.algorithms.geometry.groups import number_large
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening


def by_all_pairs(xyz, plan_distance, height_distance):
    """Return components from 0 in the order of their first points, from the whole matrix of pairs."""
    d = xyz[:, None] - xyz[None]
    linked = (np.hypot(d[..., 0], d[..., 1]) < plan_distance) & (np.abs(d[..., 2]) < height_distance)
    component = connected_components(csr_matrix(linked), directed=False)[1]
    first = {}
    return np.array([first.setdefault(number, len(first)) for number in component.tolist()])


# Eighths are exact in binary, so that points can lie exactly a distance apart.
eighths = st.integers(0, 40).map(lambda n: n / 8)


@given(
    st.lists(st.tuples(eighths, eighths, eighths), min_size=1, max_size=60),
    st.integers(1, 16).map(lambda n: n / 8),
    st.integers(1, 16).map(lambda n: n / 8),
)
@settings(max_examples=150)
def test_grids_with_points_exactly_a_distance_apart(points, plan_distance, height_distance):
    xyz = np.array(points)
    found = connect(xyz, plan_distance, height_distance, Monitor())
    np.testing.assert_array_equal(found, by_all_pairs(xyz, plan_distance, height_distance))


@pytest.mark.parametrize("seed", range(8))
def test_random_clouds(seed):
    random = np.random.default_rng(seed)
    xyz = random.uniform(0, [30, 20, 6], (900, 3))
    plan_distance, height_distance = random.uniform(0.5, 2.0), random.uniform(0.1, 1.5)
    expected = by_all_pairs(xyz, plan_distance, height_distance)
    found = connect(xyz, plan_distance, height_distance, Monitor())
    np.testing.assert_array_equal(found, expected)
    assert 1 < len(set(expected)) < 900
    np.testing.assert_array_equal(connect(xyz + FAR, plan_distance, height_distance, Monitor()), expected)


def test_chunks_of_pairs_change_nothing(monkeypatch, rng):
    xyz = rng.uniform(0, [15, 15, 3], (700, 3))
    expected = by_all_pairs(xyz, 1.2, 0.4)
    monkeypatch.setattr(boxes, "PAIRS_AT_ONCE", 13)
    np.testing.assert_array_equal(connect(xyz, 1.2, 0.4, Monitor()), expected)


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, 1, 0), (0.6, 0.8, 0), (0, 0, 1), (0, 0, -1)])
def test_exactly_the_distance_apart_is_not_linked(direction):
    """The inequalities of the paper are strict."""
    pair = np.array([[0.0, 0, 0], direction]) * 2.5
    assert connect(pair, 2.5, 2.5, Monitor()).tolist() == [0, 1]
    assert connect(pair * (1 - 1e-12), 2.5, 2.5, Monitor()).tolist() == [0, 0]


def test_points_with_more_boxes_than_numbers_are_refused():
    """Boxes 2^20 apart in each row of 2^22 rows had the same number of 64 bits: such points were one component."""
    side = np.sqrt(2) * (1 + 1e-6)
    far = np.array([[0.0, 0, 0], [2.0**20, 0, 0], [0, 2.0**22 - 5, 2.0**22 - 5]])
    with pytest.raises(ValueError, match="spread over 1,048,576 by 4,194,299 by 4,194,299 m, .*remove points"):
        connect(far, side, 1.0, Monitor())


def test_both_distances_must_be_kept():
    """Near in plan but not in height, near in height but not in plan, and far by the sphere's radius only."""
    xyz = np.array([[0, 0, 0], [0, 0, 0.6], [1.2, 0, 0], [0.9, 0, 0.4]])
    assert connect(xyz, 1.0, 0.5, Monitor()).tolist() == [0, 0, 0, 0]  # all by way of the last
    assert connect(xyz[:3], 1.0, 0.5, Monitor()).tolist() == [0, 1, 2]
    corner = np.array([[0, 0, 0], [0.99, 0, 0.49]])  # 1.105 m apart in space, and linked
    assert connect(corner, 1.0, 0.5, Monitor()).tolist() == [0, 0]


def test_a_wall_and_a_stair():
    steps = np.column_stack([np.arange(50) * 0.25, np.zeros(50), np.arange(50) * 0.25])
    assert connect(steps, 0.3, 0.3, Monitor()).max() == 0
    assert connect(steps, 0.3, 0.25, Monitor()).max() == 49
    assert connect(steps * [0, 0, 1], 0.01, 0.3, Monitor()).max() == 0


def test_one_point_many_at_one_position_and_none():
    assert connect(np.zeros((1, 3)), 1.0, 1.0, Monitor()).tolist() == [0]
    assert connect(np.ones((5, 3)), 1.0, 1.0, Monitor()).tolist() == [0] * 5
    assert connect(np.zeros((0, 3)), 1.0, 1.0, Monitor()).shape == (0,)


def test_order_of_points_renumbers_and_regroups_nothing(rng):
    xyz = rng.uniform(0, [20, 20, 4], (600, 3))
    found = connect(xyz, 1.0, 0.5, Monitor())
    order = rng.permutation(600)
    shuffled = connect(xyz[order], 1.0, 0.5, Monitor())
    assert len(set(zip(found[order].tolist(), shuffled.tolist()))) == found.max() + 1 == shuffled.max() + 1
    firsts = np.unique(shuffled, return_index=True)[1]
    assert (np.diff(firsts) > 0).all()


def test_larger_distances_never_part_what_was_together(rng):
    xyz = rng.uniform(0, [20, 20, 4], (600, 3))
    fine = connect(xyz, 0.9, 0.4, Monitor())
    for plan_distance, height_distance in ((1.3, 0.4), (0.9, 0.8), (3.0, 2.0)):
        coarse = connect(xyz, plan_distance, height_distance, Monitor())
        assert len(set(zip(fine.tolist(), coarse.tolist()))) == fine.max() + 1


def test_cancel_gets_through(rng):
    with pytest.raises(Cancelled):
        connect(rng.uniform(0, 9, (50, 3)), 1.0, 1.0, Listening(stop_at=0.0))


def test_small_components_get_no_number_and_the_others_follow_each_other():
    component = np.array([0, 1, 1, 2, 2, 2, -1, 3, 3, -1], np.int32)
    assert number_large(component, 2).tolist() == [0, 1, 1, 2, 2, 2, 0, 3, 3, 0]
    assert number_large(component, 2.1).tolist() == [0, 0, 0, 1, 1, 1, 0, 0, 0, 0]
    assert number_large(component, 3).tolist() == [0, 0, 0, 1, 1, 1, 0, 0, 0, 0]
    assert number_large(component, 4).tolist() == [0] * 10
    assert number_large(component, 0).tolist() == [1, 2, 2, 3, 3, 3, 0, 4, 4, 0]
    assert number_large(np.full(3, -1), 1).tolist() == [0, 0, 0]
    assert number_large(component, 2).dtype == np.int32


def test_numbers_follow_first_points_and_none_stays_none():
    assert by_first_point(np.array([7, -1, 2, 7, -3, 0, 2])).tolist() == [0, -1, 1, 0, -1, 2, 1]
    assert by_first_point(np.array([-1, -1])).tolist() == [-1, -1]
    assert by_first_point(np.zeros(0, int)).tolist() == []
