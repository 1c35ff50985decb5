"""Weights of points hardly change when points move a little, and even out what lies denser than a roof."""

import numpy as np

from lidar_buildings.algorithms.footprints.soft_shares import even_weights, find_shares


def test_two_strips_weigh_as_one():
    """Where a second strip lies over the first, each of its points counts about half."""
    plan = np.random.default_rng(1).uniform(0, 20, (800, 2))
    twice = np.concatenate([plan[plan[:, 0] < 10] + 1e-3, plan])
    weight = even_weights(twice, np.sqrt(0.5))
    inner = (np.abs(twice - 10) < 8).all(axis=1)
    left, right = (weight[inner & own].sum() for own in (twice[:, 0] < 9, twice[:, 0] > 11))
    assert left / right < 1.25
    assert (inner & (twice[:, 0] < 9)).sum() / (inner & (twice[:, 0] > 11)).sum() > 1.8


def test_points_that_move_a_little_change_shares_a_little():
    """A hundredth of a spacing changes them by 0.01 at most; where one point of each cell was chosen it was 0.17."""
    rng = np.random.default_rng(2)
    plan = rng.uniform(0, 20, (400, 2))
    moved = plan + rng.normal(0, 0.01, plan.shape)
    label, none = np.ones(len(plan), np.int64), np.zeros((0, 2))
    one, other = (find_shares(own, even_weights(own, 1.0), label, none, np.zeros(0), 1.0)[1] for own in (plan, moved))
    column, row = np.subtract(other.lattice.first, one.lattice.first)
    assert (column, row) == (0, 0)
    rows, columns = np.minimum(one.share.shape, other.share.shape)
    assert np.abs(one.share[:rows, :columns] - other.share[:rows, :columns]).max() < 0.02
