"""Adjacent planes merged by pairs, against the points of both."""

import numpy as np

from lidar_buildings.algorithms.planes.best_pairs import common_deviation, merge_best_pairs
from lidar_buildings.algorithms.planes.least_squares_planes import planes_of
from lidar_buildings.algorithms.stage import Monitor


def test_common_deviation_is_that_of_the_points_from_the_plane_of_both(rng):
    group = np.repeat(np.arange(12), rng.integers(4, 60, 12))
    xyz = rng.normal(size=(len(group), 3)) * [3, 2, 0.2] + rng.uniform(-5, 5, (12, 3))[group]
    one, other = (number.ravel() for number in np.meshgrid(np.arange(12), np.arange(12)))
    found = common_deviation(planes_of(xyz, group, 12), one, other)
    for a, b, deviation in zip(one, other, found):
        both = xyz[(group == a) | (group == b)]
        middle = both.mean(axis=0)
        normal = np.linalg.svd(both - middle)[2][2]
        expected = max(np.sqrt(np.mean(((xyz[group == i] - middle) @ normal) ** 2)) for i in (a, b))
        np.testing.assert_allclose(deviation, expected, rtol=1e-9)


def test_a_row_of_planes_that_are_all_alike_takes_few_rounds():
    """Each round merges about a third of them; by their numbers it would be one pair, 999 rounds in all."""
    xyz = np.array([[x + dx, dy, 0.0] for x in range(1000) for dx, dy in ((0, 0), (0.5, 0), (0, 1), (0.5, 1))])
    planes = planes_of(xyz, np.repeat(np.arange(1000), 4), 1000)
    rounds = []
    monitor = Monitor()
    monitor.progress = rounds.append
    merged, group = merge_best_pairs(
        planes, np.arange(999), np.arange(1, 1000), lambda _, one, other: np.zeros(len(one)), monitor
    )
    assert len(merged) == 1
    assert not group.any()
    assert len(rounds) < 40


def test_what_does_not_fit_at_first_may_fit_a_larger_plane_later():
    """A third plane fits no single one of the others, but both together."""
    xyz = np.array([[x + dx, dy, 0.0] for x in range(3) for dx, dy in ((0, 0), (0.5, 0), (0, 1), (0.5, 1))])

    def cost(planes, one, other):
        is_large = np.maximum(planes.count[one], planes.count[other]) > 4
        return np.where(is_large | (one + other == 1), 1.0, np.inf)

    merged, group = merge_best_pairs(
        planes_of(xyz, np.repeat(np.arange(3), 4), 3), np.array([0, 1]), np.array([1, 2]), cost, Monitor()
    )
    assert len(merged) == 1
    assert not group.any()
