"""Points around and beneath groups of points: by hand, and by comparing everything with everything."""

import numpy as np
import pytest

from lidar_buildings.algorithms.segmentation.cluster_measures import (
    adjacent_groups,
    penetration,
    plan_areas,
    pulses_going_on,
    share_around,
)


def test_shares_by_hand():
    """Boxes of 2 x 2 x 4 m in a row: three points of the first group, one of the second next to them, five apart."""
    easting = [0.1, 0.2, 0.3, 2.5, 8.1, 8.2, 8.3, 8.4, 8.5]
    xyz = np.column_stack([easting, np.zeros(9), np.zeros(9)])
    group = np.array([0, 0, 0, 1, 2, 2, 2, 2, 2])
    np.testing.assert_allclose(share_around(xyz, group, np.array([True, False, False])), [0.75, 0.75, 0])
    np.testing.assert_allclose(share_around(xyz, group, np.array([True, True, True])), 1)
    # Points higher by a box and a half are as near as those in the next box; points two boxes higher are not.
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
    box = np.floor(xyz[members] / [2, 2, 4])
    near = np.abs(box[:, None] - box[None]).max(axis=2) <= 1
    of_point = (near & chosen[group[members]][None]).sum(axis=1) / near.sum(axis=1)
    expected = [of_point[group[members] == g].mean() if (group == g).any() else 0 for g in range(6)]
    np.testing.assert_allclose(share_around(xyz, group, chosen), expected)


def at_cells(*columns, z=5.0):
    """Return points in square cells of 1.5 m, one each, in columns of a row at height z."""
    return np.column_stack([1.51 * np.array(columns), np.zeros(len(columns)), np.full(len(columns), z)])


def test_areas_are_cells_of_one_and_a_half_spacings_that_hold_points():
    group = np.array([0, 0, 0, 2, 2])
    np.testing.assert_allclose(plan_areas(at_cells(0, 1, 1, 1, 7), group, 1.0), [2 * 2.25, 0, 2 * 2.25])


def test_areas_do_not_depend_on_a_point_far_away():
    """Ten trillion cells by two million groups are more than there are numbers of 64 bits."""
    group = np.array([0, 0, 0, 2**21, 2**21])
    xyz = at_cells(0, 1, 1, 1, 7)
    xyz[4, :2] = 6e6
    areas = plan_areas(xyz, group, 1.0)
    assert areas[0] == pytest.approx(2 * 2.25)
    assert areas[-1] == pytest.approx(2 * 2.25)
    assert areas.sum() == pytest.approx(4 * 2.25)


@pytest.mark.parametrize(("depth", "expected"), [(0.9, 0.0), (1.1, 2 / 5)])
def test_penetration_by_hand(depth, expected):
    """Of five cells of a group two have other points at that depth; one point of ten is not a last return."""
    group = np.repeat([1, 1, -1, 0], [5, 5, 1, 1])
    own = at_cells(0, 1, 2, 3, 4)
    xyz = np.concatenate([own, own + [0, 0, 2], at_cells(1, z=5 - depth), at_cells(3, z=5 - depth)])
    assert penetration(xyz, group, 1.0).tolist() == [0.0, expected]
    goes_on = pulses_going_on(np.ones(12), np.where(np.arange(12) == 7, 2, 1))
    assert penetration(xyz, group, 1.0, goes_on)[1] == pytest.approx((expected + 0.1) / 2)


def test_adjacent_groups_by_hand():
    """In a row: a group, three that touch one another, and one apart; and two over each other far off."""
    groups = [(0,), (1, 2, 3, 4, 5), (6, 7), (8, 9, 10, 11, 12, 13), (15, 16), (30,), (30,)]
    xyz = at_cells(*[column for columns in groups for column in columns])
    group = np.repeat(np.arange(7), [len(columns) for columns in groups])
    everything = np.ones(7, bool)
    assert_same_partition(adjacent_groups(xyz, group, everything, 1.0), [0, 0, 0, 0, 4, 5, 5])
    # Without the second, the first is alone.
    assert_same_partition(adjacent_groups(xyz, group, np.arange(7) != 1, 1.0), [0, 1, 2, 2, 4, 5, 5])
    without = np.where(group == 1, -1, group)
    assert_same_partition(adjacent_groups(xyz, without, everything, 1.0), [0, 1, 2, 2, 4, 5, 5])
    assert_same_partition(adjacent_groups(xyz, group, ~everything, 1.0), np.arange(7))


def test_parts_of_one_group_are_adjacent_to_all_that_either_is():
    xyz, group = at_cells(0, 10, 1, 11), np.array([0, 0, 1, 2])
    assert_same_partition(adjacent_groups(xyz, group, np.ones(3, bool), 1.0), [0, 0, 0])


def assert_same_partition(found, expected):
    np.testing.assert_array_equal(np.equal.outer(found, found), np.equal.outer(expected, expected))


def test_what_lies_beneath_by_hand():
    """Cells of 1.5 m: a group of two points over three more than a meter lower, one less than that, one beside."""
    xyz = np.array([[0, 0, 5], [1, 1, 6], [0, 1, 3.9], [1, 0, 3.9], [0.5, 0.5, 0], [0.2, 0.2, 4.2], [3.2, 0, 0]], float)
    group = np.array([0, 0, -1, -1, -1, -1, -1])
    np.testing.assert_allclose(penetration(xyz, group, density=1.0), [1])


@pytest.mark.parametrize("density", [4.0, 12.0, 40.0, 80.0])
def test_what_passes_a_surface_is_the_same_at_any_density(rng, density):
    """A third of the points of 20 m by 20 m lie on the ground, the others on a roof."""
    plan = rng.uniform(0, 20, (int(400 * density), 2))
    passes = rng.random(len(plan)) < 1 / 3
    xyz, group = np.column_stack([plan, np.where(passes, 0.0, 5.0)]), np.where(passes, -1, 0)
    # Cells hold 2.25 points on the mean; of those with a roof point 1 - exp(-0.75) have one beneath.
    assert penetration(xyz, group, density)[0] == pytest.approx(0.53, abs=0.05)
