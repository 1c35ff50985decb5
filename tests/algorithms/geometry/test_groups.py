"""Runs, items, members and components, held against loops."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidar_buildings.algorithms.geometry.groups import (
    components,
    items,
    least_of,
    members,
    ordered,
    run_starts,
    split_groups,
    topmost,
)

numbers = st.lists(st.integers(-1, 4), max_size=12).map(lambda values: np.array(values, np.int64))


@given(numbers)
def test_a_run_starts_where_the_number_before_is_another(values):
    wanted = [i for i in range(len(values)) if i == 0 or values[i] != values[i - 1]]
    assert run_starts(values).tolist() == wanted


@given(st.lists(st.integers(0, 4), max_size=8).map(lambda values: np.array(values, np.int64)))
def test_items_are_counted_from_0_in_each_group(counts):
    wanted = [(group, item) for group, count in enumerate(counts.tolist()) for item in range(count)]
    assert list(zip(*(part.tolist() for part in items(counts)))) == wanted


@given(st.lists(st.tuples(*[st.integers(0, 2)] * 4), max_size=30))
def test_the_topmost_point_of_each_cell_is_found(points):
    cell, elevation, tie, rest = np.array(points, np.int64).reshape(-1, 4).T
    keys = list(zip(elevation.tolist(), tie.tolist(), rest.tolist(), range(len(points))))
    wanted = [max(key for key, own in zip(keys, cell) if own == one)[-1] for one in np.unique(cell)]
    assert topmost(elevation, cell, tie, rest).tolist() == wanted


@given(st.lists(st.tuples(st.integers(0, 4), st.integers(-3, 3)), max_size=30))
def test_the_least_of_a_group_is_found_in_any_order(pairs):
    group, values = np.array(pairs, np.int64).reshape(-1, 2).T
    wanted = [min((value for own, value in pairs if own == one), default=np.inf) for one in range(5)]
    assert least_of(values.astype(float), group, 5).tolist() == wanted


@pytest.mark.parametrize("order", [slice(None), slice(None, None, -1)])
def test_the_least_of_sorted_values_is_found(order):
    values = np.arange(1000.0)[order]
    assert least_of(values, np.zeros(1000, np.int64), 1).tolist() == [0.0]


@given(numbers)
def test_members_are_the_positions_of_each_number_from_1(values):
    wanted = {n: np.flatnonzero(values == n).tolist() for n in np.unique(values).tolist() if n > 0}
    found = members(values)
    assert {n: part.tolist() for n, part in found.items()} == wanted
    assert list(found) == sorted(found)


@given(st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7)), max_size=10))
def test_items_are_of_one_group_if_a_chain_of_pairs_joins_them(pairs):
    one, other = np.array(pairs, np.int64).reshape(-1, 2).T
    count, group = components(one, other, 8)
    wanted = list(range(8))
    for _ in range(8):
        for a, b in pairs:
            wanted[a] = wanted[b] = min(wanted[a], wanted[b])
    first = {}
    assert group.tolist() == [first.setdefault(least, len(first)) for least in wanted]
    assert count == len(first)


def test_split_groups_gives_the_rows_of_each_in_order_and_leaves_out_minus_one():
    rows = split_groups(np.array([2, -1, 0, 2, 0, -1]), 4)
    assert [list(of_group) for of_group in rows] == [[2, 4], [], [0, 3], []]


@pytest.mark.parametrize("n_keys", [1, 5, 10_000])
def test_equal_keys_are_ordered_by_their_ties(rng, n_keys):
    """As tuples are sorted by Python."""
    key, first, second = rng.integers(0, n_keys, 300), rng.integers(0, 4, 300).astype(float), rng.normal(size=300)
    expected = sorted(range(300), key=lambda row: (key[row], first[row], second[row]))
    assert ordered(key, first, second).tolist() == expected


def test_the_order_of_no_keys_is_empty():
    assert ordered(np.zeros(0, np.int64), np.zeros(0)).tolist() == []
