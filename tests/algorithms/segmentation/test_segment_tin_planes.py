"""Merging TIN meshes: the partition of the literal queue, and roofs whose planes are known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.planes.best_pairs import common_deviation, merge_best_pairs
from lidar_buildings.algorithms.planes.least_squares_planes import planes_of
from lidar_buildings.algorithms.segmentation.segment_tin_planes import segment_tin_planes as stage
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening


def segment_tin_planes(xyz, **tunables):
    return stage(xyz, np.ones(len(xyz), np.uint8), **tunables)


def limited(tolerance):
    def cost(planes, one, other):
        deviation = common_deviation(planes, one, other)
        return np.where(deviation <= tolerance, deviation, np.inf)

    return cost


def literal(planes, pairs, cost):
    """Merge the most similar pair of all, one at a time."""
    groups = [frozenset([i]) for i in range(len(planes))]
    beside = {frozenset([groups[a], groups[b]]) for a, b in pairs}

    def plane_of(parts):
        return planes.chosen(np.array(sorted(parts))).merged(np.zeros(len(parts), int), 1)

    def price(pair):
        one, other = (plane_of(parts) for parts in pair)
        columns = zip((one.count, one.center, one.covariance), (other.count, other.center, other.covariance))
        both = type(planes)(*(np.concatenate(column) for column in columns))
        return float(cost(both, np.array([0]), np.array([1]))[0])

    prices = {pair: price(pair) for pair in beside}
    while prices and min(prices.values()) < np.inf:
        best = min(prices, key=prices.get)
        merged = frozenset().union(*best)
        around = {other for pair in prices if pair & best for other in pair - best}
        prices = {pair: value for pair, value in prices.items() if not pair & best}
        prices.update({pair: price(pair) for pair in (frozenset([merged, other]) for other in around)})
        groups = [group for group in groups if group not in best] + [merged]
    return {frozenset(group) for group in groups}


@pytest.mark.parametrize("seed", range(5))
def test_partition_is_that_of_the_literal_queue(seed):
    """Patches of 2 m on two planes that meet at a ridge, and a step, with noise."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(0, 12, (800, 2)).T
    z = np.where(y > 8, 7.0, np.where(x < 6, 0.7 * x, 0.7 * (12 - x))) + rng.normal(0, 0.02, 800)
    cell = (x // 2).astype(int) * 6 + (y // 2).astype(int)
    planes = planes_of(np.column_stack([x, y, z]), cell, 36)
    pairs = [(i, j) for i in range(36) for j in (i + 1, i + 6) if j < 36 and (j == i + 6 or j % 6)]
    cost = limited(0.06)
    _, group = merge_best_pairs(planes, *np.array(pairs).T, cost, Monitor())
    parts = {frozenset(np.flatnonzero(group == number).tolist()) for number in np.unique(group)}
    assert parts == literal(planes, pairs, cost)
    assert len(parts) == 3


@pytest.fixture(scope="module")
def house():
    """A gable on level ground, 6 points per m²."""
    rng = np.random.default_rng(3)
    x, y = rng.uniform(0, 30, (5400, 2)).T
    part = np.zeros(len(x), int)
    z = np.zeros(len(x))
    for number, (west, east, slope) in enumerate(((8, 14, 0.7), (14, 20, -0.7)), start=1):
        inside = (x > west) & (x <= east) & (y > 8) & (y < 22)
        part[inside], z[inside] = number, 8 + slope * (x[inside] - 14)
    return np.column_stack([x, y, z + rng.normal(0, 0.015, len(x))]), part


def test_roofs_and_ground_are_one_plane_each(house):
    xyz, part = house
    ids = segment_tin_planes(xyz)
    best = [np.bincount(ids[part == number]).argmax() for number in range(3)]
    assert len(set(best)) == 3
    assert 0 not in best
    for number, segment in enumerate(best):
        assert (ids[part == number] == segment).mean() > 0.93
        assert (part[ids == segment] == number).mean() > 0.97


def test_long_edges_and_small_planes_are_left_out(house):
    xyz, part = house
    roofs = xyz[part > 0]
    assert segment_tin_planes(roofs, min_area=200.0).max() == 0
    apart = np.concatenate([roofs, roofs + [40, 0, 0]])
    ids = segment_tin_planes(apart)
    assert not set(ids[: len(roofs)]) & set(ids[len(roofs) :]) - {0}
    level = np.concatenate([xyz[part == 0], xyz[part == 0] + [40, 0, 0]])
    assert segment_tin_planes(level, max_edge=50.0, min_area=0.0).max() < segment_tin_planes(level, min_area=0.0).max()


def test_order_and_position_change_nothing(house):
    xyz = house[0].round(3)
    ids = segment_tin_planes(xyz, tolerance=0.05, max_edge=2.0)
    order = np.random.default_rng(0).permutation(len(xyz))
    for other in (
        segment_tin_planes(xyz[order], tolerance=0.05, max_edge=2.0)[np.argsort(order)],
        segment_tin_planes(xyz + FAR, tolerance=0.05, max_edge=2.0),
    ):
        pairs, count = np.unique(np.column_stack([ids, other]), axis=0, return_counts=True)
        assert count[np.argsort(-count)[: len(np.unique(ids))]].sum() > 0.99 * len(ids)


def test_points_on_a_line_and_too_few_have_no_triangle():
    line = np.column_stack([np.arange(30.0), np.arange(30.0), np.zeros(30)])
    assert not segment_tin_planes(line).any()
    assert not segment_tin_planes(line[:2]).any()
    same = np.repeat(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]), 2, axis=0)
    assert segment_tin_planes(same, min_area=0.5, max_edge=2.0, tolerance=0.1).max() == 1


def test_cancel_gets_through(house):
    with pytest.raises(Cancelled):
        stage(house[0], np.ones(len(house[0]), np.uint8), monitor=Listening(stop_at=0.5))
