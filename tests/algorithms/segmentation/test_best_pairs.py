"""Adjacent planes merged by pairs, against the points of both."""

import numpy as np

from lidar_buildings.algorithms.segmentation.best_pairs import common_deviation
from lidar_buildings.algorithms.segmentation.least_squares_planes import planes_of


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
