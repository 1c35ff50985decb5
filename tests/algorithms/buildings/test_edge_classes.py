"""Points that are decided together with their neighbors, in squares with margins."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings import edge_classes
from lidar_buildings.algorithms.buildings.edge_classes import decided_together
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.monitors import Listening

SIDE, MARGIN = 10.0, 2.0


@pytest.fixture
def edge(rng):
    """A strip of 6 by 60 m with four points per m², whose southern half is a roof; a tenth of all points look wrong."""
    xyz = np.column_stack([rng.uniform(0, 60, 1440), rng.uniform(0, 6, 1440), np.full(1440, 5.0)])
    truth = xyz[:, 1] < 3
    gain = np.where(truth ^ (rng.random(1440) < 0.1), 1.5, -1.5)
    return xyz, truth, gain


def decided(xyz, gain):
    """Return the classes of points with a spacing of half a meter."""
    return decided_together(xyz, gain, 0.5, SIDE, MARGIN, Monitor())


def test_single_points_follow_their_neighbors(edge):
    xyz, truth, gain = edge
    away = np.abs(xyz[:, 1] - 3) > 0.5
    assert ((gain > 0) == truth)[away].mean() < 0.92
    assert (decided(xyz, gain) == truth)[away].mean() > 0.98


def test_points_far_apart_and_those_that_are_sure_keep_what_they_are(edge):
    xyz, _, gain = edge
    np.testing.assert_array_equal(decided(xyz * 100, gain), gain > 0)
    sure = np.where(gain > 0, np.inf, -np.inf)
    np.testing.assert_array_equal(decided(xyz, sure), gain > 0)


def test_nothing_costs_less_than_what_is_decided(rng):
    """All classes of ten points, one by one: two clusters in a square, with weak evidence."""
    xyz = np.column_stack([rng.uniform(3, 5, 10), rng.uniform(3, 5, 10), np.zeros(10)])
    gain = rng.normal(0, 2, 10)
    squares = np.sum((xyz[:, None] - xyz) ** 2, axis=2)
    # Every point is a neighbor of every other one, in both directions.
    pair = 2 / (1 + squares / 0.5**2)

    def cost(classes):
        return np.abs(gain[classes != (gain > 0)]).sum() + pair[classes][:, ~classes].sum()

    every = [np.array([number >> bit & 1 for bit in range(10)], bool) for number in range(1024)]
    found = decided(xyz, gain)
    assert cost(found) == pytest.approx(min(map(cost, every)), abs=0.02)
    assert not np.array_equal(found, gain > 0)


def test_a_part_with_the_margins_of_its_squares_decides_as_the_whole(edge):
    xyz, _, gain = edge
    whole = decided(xyz, gain)
    part = np.flatnonzero((xyz[:, 0] >= 17.9) & (xyz[:, 0] < 42.1))
    kept = (xyz[part, 0] >= 20) & (xyz[part, 0] < 40)
    np.testing.assert_array_equal(decided(xyz[part], gain[part])[kept], whole[part][kept])


def test_squares_decide_nearly_as_all_points_at_once(edge):
    xyz, _, gain = edge
    at_once = decided_together(xyz, gain, 0.5, 1000.0, MARGIN, Monitor())
    assert (decided(xyz, gain) == at_once).mean() > 0.995


def test_every_point_is_kept_in_one_square_and_seen_from_those_around(edge):
    plan = edge[0][:, :2]
    squares = list(edge_classes._squares(plan, SIDE, MARGIN))
    kept = np.concatenate([rows[is_own] for rows, is_own in squares])
    np.testing.assert_array_equal(np.sort(kept), np.arange(len(plan)))
    for rows, is_own in squares:
        if is_own.any():
            low = np.floor(plan[rows[is_own][0]] / SIDE) * SIDE
            inside = ((plan >= low - MARGIN) & (plan < low + SIDE + MARGIN)).all(axis=1)
            np.testing.assert_array_equal(np.flatnonzero(inside), rows)


def test_the_order_of_points_decides_nothing(edge, rng):
    xyz, _, gain = edge
    order = rng.permutation(len(xyz))
    np.testing.assert_array_equal(decided(xyz[order], gain[order]), decided(xyz, gain)[order])


def test_there_may_be_no_points_or_one():
    assert not len(decided(np.empty((0, 3)), np.empty(0)))
    np.testing.assert_array_equal(decided(np.zeros((1, 3)), np.array([2.0])), [True])


def test_progress_is_heard_from_square_to_square_where_the_work_can_be_stopped(edge):
    xyz, _, gain = edge
    listening = Listening()
    decided_together(xyz, gain, 0.5, SIDE, MARGIN, listening)
    # The strip has six squares.
    assert listening.heard == sorted(listening.heard)
    assert len(listening.heard) >= 6
    assert listening.heard[-1] == 1.0
    with pytest.raises(Cancelled):
        decided_together(xyz, gain, 0.5, SIDE, MARGIN, Listening(stop_at=0.5))
