"""Sets that pairs join, in portions and in threads, against components of all pairs at once."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidar_buildings.algorithms.geometry.groups import DisjointSets, components


def first_items(pairs, count):
    """The first item of the component of each item."""
    group = components(pairs[:, 0], pairs[:, 1], count)[1]
    return np.unique(group, return_index=True)[1][group]


@given(st.lists(st.tuples(st.integers(0, 11), st.integers(0, 11)), max_size=20), st.integers(1, 6))
def test_sets_are_the_components_of_all_pairs(pairs, size):
    pairs = np.array(pairs, np.int64).reshape(-1, 2)
    sets = DisjointSets(12)
    for start in range(0, len(pairs), size):
        some = pairs[start : start + size]
        sets.join(some[:, 0], some[:, 1])
        assert not sets.apart(some[:, 0], some[:, 1]).any()
    np.testing.assert_array_equal(sets.first(np.arange(12)), first_items(pairs, 12))


@pytest.mark.parametrize("make", ["chain", "reversed chain", "random"])
def test_threads_join_the_same_sets(make, rng):
    count = 20_000
    chain = np.column_stack([np.arange(count - 1), np.arange(1, count)])
    chain = chain[rng.random(count - 1) < 0.999]
    pairs = {"chain": chain, "reversed chain": chain[::-1], "random": rng.integers(0, count, (count * 2 // 3, 2))}[make]
    sets = DisjointSets(count)
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda some: sets.join(some[:, 0], some[:, 1]), np.array_split(pairs, 200)))
    found = sets.first(np.arange(count))
    np.testing.assert_array_equal(found, first_items(pairs, count))
    assert 2 < len(np.unique(found)) < count / 2
