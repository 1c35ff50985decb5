"""Buildings that most divisions of a cloud agree on, by hand and one point at a time."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.agreed_buildings import agreed


def owners(*rows):
    return [np.array(row, np.int32) for row in rows]


def test_points_are_of_a_building_where_most_divisions_say_so():
    found = agreed(owners([1, 1, 1, 0, 0, 0], [1, 1, 0, 1, 0, 1], [1, 0, 0, 1, 1, 0]), np.arange(6))
    assert found.tolist() == [1, 1, 0, 1, 0, 0]
    assert found.dtype == np.int32


def test_one_division_decides_alone():
    np.testing.assert_array_equal(agreed(owners([2, 0, 1, 1]), np.array([5, 0, 9, 7])), [1, 0, 2, 2])


def test_a_building_is_that_of_the_first_division_and_else_the_one_it_shares_most_with():
    first = [1, 1, 1, 2, 2, 2, 0, 0]
    other = [7, 7, 7, 7, 4, 4, 4, 7]
    # The seventh point goes with building 4 of the others, which is building 2 of the first, the last one with 7.
    assert agreed(owners(first, other, other), np.arange(8)).tolist() == [1, 1, 1, 2, 2, 2, 2, 1]


def test_a_building_that_the_first_division_has_not_is_a_new_one_in_its_place():
    first, other = [0, 0, 1, 1], [3, 3, 5, 5]
    assert agreed(owners(first, other, other), np.arange(4)).tolist() == [1, 1, 2, 2]
    assert agreed(owners(first, other, other), np.arange(4)[::-1]).tolist() == [2, 2, 1, 1]


def test_no_building():
    assert agreed(owners([0, 0], [0, 1], [0, 0]), np.arange(2)).tolist() == [0, 0]


@pytest.mark.parametrize("seed", range(3))
def test_votes_counted_one_by_one(seed):
    rng = np.random.default_rng(seed)
    some = [rng.integers(0, 4, 200).astype(np.int32) for _ in range(3)]
    found = agreed(some, rng.permutation(200))
    for i in range(200):
        assert (found[i] > 0) == (sum(int(owner[i] > 0) for owner in some) >= 2)
    same = some[0] > 0
    pairs = {(one, now) for one, now in zip(some[0][same & (found > 0)].tolist(), found[same & (found > 0)].tolist())}
    # Points of one building of the first division keep one number.
    assert len({one for one, _ in pairs}) == len(pairs)
