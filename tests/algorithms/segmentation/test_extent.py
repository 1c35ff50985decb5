"""What stands around groups of points: by hand, and by comparing every box with every other."""

import numpy as np
import pytest

from lidar_buildings.algorithms.segmentation.extent import share_around


def test_shares_by_hand():
    """Boxes of 2 x 2 x 4 m in a row: three points of the first group, one of the second next to them, five apart."""
    easting = [0.1, 0.2, 0.3, 2.5, 8.1, 8.2, 8.3, 8.4, 8.5]
    xyz = np.column_stack([easting, np.zeros(9), np.zeros(9)])
    group = np.array([0, 0, 0, 1, 2, 2, 2, 2, 2])
    np.testing.assert_allclose(share_around(xyz, group, np.array([True, False, False])), [0.75, 0.75, 0])
    np.testing.assert_allclose(share_around(xyz, group, np.array([True, True, True])), 1)
    # What lies higher by a box and a half is as near as what lies a box beside, two boxes higher is not.
    above = np.where(np.isin(group, 1)[:, None], xyz + [0, 0, 6], xyz)
    np.testing.assert_allclose(share_around(above, group, np.array([True, False, False]))[:2], 0.75)
    far_above = np.where(np.isin(group, 1)[:, None], xyz + [0, 0, 9], xyz)
    np.testing.assert_allclose(share_around(far_above, group, np.array([True, False, False]))[:2], [1, 0])


@pytest.mark.parametrize("seed", range(3))
def test_shares_as_when_every_box_is_compared_with_every_other(seed):
    rng = np.random.default_rng(seed)
    xyz = rng.normal(0, 1, (400, 3)) * [8, 8, 5] + [6e5, 5e6, 100]
    group = rng.integers(-1, 6, 400)
    group[group == 3] = 2  # a number that no point has
    chosen = rng.random(6) < 0.5
    members = group >= 0
    box = np.floor((xyz[members] - xyz[members].min(axis=0)) / [2, 2, 4])
    near = np.abs(box[:, None] - box[None]).max(axis=2) <= 1
    of_point = (near & chosen[group[members]][None]).sum(axis=1) / near.sum(axis=1)
    expected = [of_point[group[members] == g].mean() if (group == g).any() else 0 for g in range(6)]
    np.testing.assert_allclose(share_around(xyz, group, chosen), expected)
