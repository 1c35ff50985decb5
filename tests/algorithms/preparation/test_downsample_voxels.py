"""One point remains in every voxel, and it is the right one: held against dictionaries, fractions and brute force."""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidar_buildings.algorithms.preparation import downsample_voxels as voxels
from lidar_buildings.algorithms.preparation.downsample_voxels import downsample_voxels
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.monitors import Listening


def by_dictionary(steps: np.ndarray, scale: int, side: int) -> dict[tuple, list[int]]:
    """Return the points of each voxel, by integers: coordinates are steps / scale and sides side / scale (m)."""
    found = defaultdict(list)
    for i, place in enumerate(steps.tolist()):
        found[tuple(step // side for step in place)].append(i)
    return found


def cloud_of_centimeters(rng, n=4000, spread=60):
    """Points in whole centimeters, many of them on the sides of voxels and many at one place."""
    return rng.integers(-spread, spread, (n, 3))


def points_at(steps: np.ndarray, scale: int = 100) -> np.ndarray:
    """Return steps as coordinates (m), each rounded once, as a file's are."""
    return steps / scale


# --- Against independent opinions


def test_agrees_with_a_dictionary_in_exact_numbers(rng, monkeypatch):
    monkeypatch.setattr(voxels, "ROWS_AT_ONCE", 300)
    steps, classes = cloud_of_centimeters(rng), rng.integers(0, 19, 4000).astype(np.uint8)
    selected, center, majority, count = downsample_voxels(points_at(steps), classes, voxel_size=0.1)
    expected = by_dictionary(steps, 100, 10)
    assert len(selected) == len(expected)
    assert [tuple(v) for v in steps[selected] // 10] == sorted(expected)
    for row, members in enumerate(expected[key] for key in sorted(expected)):
        assert count[row] == len(members)
        mean = [Fraction(int(steps[members, i].sum()), len(members) * 100) for i in range(3)]
        np.testing.assert_allclose(center[row], [float(part) for part in mean], rtol=0, atol=1e-9)
        away = [sum((Fraction(int(v), 100) - m) ** 2 for v, m in zip(steps[i], mean)) for i in members]
        nearest = [i for i, distance in zip(members, away) if distance == min(away)]
        assert selected[row] == min(nearest, key=lambda i: (*steps[i].tolist(), i))
        number, often = np.unique(classes[members], return_counts=True)
        assert majority[row] == number[often == often.max()].min()


def test_agrees_with_numpy_unique(rng):
    xyz = rng.normal(0, 3, (20_000, 3))
    _, inverse, often = np.unique(np.floor(xyz / 0.37), axis=0, return_inverse=True, return_counts=True)
    inverse = inverse.ravel()
    _, center, majority, count = downsample_voxels(xyz, voxel_size=0.37)
    assert majority is None
    assert (count == often).all()
    mean = np.stack([np.bincount(inverse, xyz[:, i]) / often for i in range(3)], axis=1)
    np.testing.assert_allclose(center, mean, atol=1e-9)


# --- Properties


steps_of_points = st.lists(st.tuples(*[st.integers(-30, 30)] * 3), min_size=1, max_size=60)


@settings(max_examples=60)
@given(steps_of_points, st.integers(1, 40), st.randoms(use_true_random=False))
def test_the_order_of_the_points_changes_nothing(places, side, random):
    steps = np.array(places)
    order = np.arange(len(steps))
    random.shuffle(order)
    classes = (steps.sum(axis=1) % 7).astype(np.uint8)
    time = np.arange(len(steps)) % 5 * 0.5
    number = np.arange(len(steps), dtype=np.uint8)
    result, of_shuffled = (
        (
            rows,
            *downsample_voxels(points_at(steps[rows]), classes[rows], time[rows], number[rows], voxel_size=side / 100),
        )
        for rows in (np.arange(len(steps)), order)
    )
    assert (result[0][result[1]] == of_shuffled[0][of_shuffled[1]]).all()
    for one, other in zip(result[2:], of_shuffled[2:]):
        assert one.tobytes() == other.tobytes()


@settings(max_examples=60)
@given(steps_of_points, st.sampled_from([1, 2, 5, 10, 25]))
def test_the_position_of_the_cloud_changes_nothing(places, side):
    steps = np.array(places)
    at_origin = downsample_voxels(points_at(steps), voxel_size=side / 100)
    far_away = downsample_voxels(points_at(steps + [60_000_000, 500_000_000, 0]), voxel_size=side / 100)
    assert (at_origin[0] == far_away[0]).all()
    assert (at_origin[3] == far_away[3]).all()
    np.testing.assert_allclose(at_origin[1], far_away[1] - [6e5, 5e6, 0], rtol=0, atol=3e-9)


@settings(max_examples=40)
@given(steps_of_points, st.integers(1, 40))
def test_centers_stay_in_their_voxel_and_counts_add_up(places, side):
    steps = np.array(places)
    selected, center, _, count = downsample_voxels(points_at(steps), voxel_size=side / 100)
    assert count.sum() == len(steps)
    low = steps[selected] // side * (side / 100)
    assert (center >= low - 1e-9).all()
    assert (center < low + side / 100 + 1e-9).all()


def test_larger_voxels_that_hold_the_smaller_ones_are_not_more(rng):
    xyz = rng.uniform(0, 5, (5000, 3))
    counts = [len(downsample_voxels(xyz, voxel_size=side)[0]) for side in (0.1, 0.2, 0.4, 0.8, 1000)]
    assert sorted(counts, reverse=True) == counts
    assert counts[-1] == 1


# --- Exact at any coordinate


def test_a_country_in_centimeters(rng):
    """100 km by 100 km by 3 km have more voxels of 1 cm than 64 bits have numbers."""
    assert 10**7 * 10**7 * 3 * 10**5 > 2**64
    steps = rng.integers(0, (10**7, 10**7, 3 * 10**5), (3000, 3))
    steps[:2] = (0, 0, 0), (10**7 - 1, 10**7 - 1, 3 * 10**5 - 1)
    # Neighbors on all sides, and points whose numbers would be the same after 64 bits have overflowed.
    steps[100:1300] = steps[:1200] + rng.integers(-1, 2, (1200, 3))
    steps[1300:1400] = steps[:100]
    steps = np.clip(steps, 0, (10**7 - 1, 10**7 - 1, 3 * 10**5 - 1))
    for origin in ((0, 0, 0), (60_000_000, 500_000_000, -10_000)):
        placed = steps + np.array(origin)
        selected, center, _, count = downsample_voxels(points_at(placed), voxel_size=0.01)
        expected = by_dictionary(placed, 100, 1)
        assert [tuple(place) for place in placed[selected]] == sorted(expected)
        assert count.tolist() == [len(expected[key]) for key in sorted(expected)]
        assert (center == points_at(placed)[selected]).all()


def test_numbers_that_overflow_twice(rng):
    steps = rng.integers(-(2**44), 2**44, (500, 3))
    steps[250:] = steps[:250]
    selected, _, _, count = downsample_voxels(steps.astype(float), voxel_size=1.0)
    assert [tuple(place) for place in steps[selected]] == sorted(by_dictionary(steps, 1, 1))
    assert count.sum() == 500


@pytest.mark.parametrize("side", [1, 3, 7, 10, 33])
def test_points_on_the_sides_of_voxels_go_up_wherever_they_are(side):
    """0.3 / 0.1 is 2.9999999999999996 in binary numbers."""
    line = np.arange(0, 3000)
    for start in (0, 100_000_000 * side):
        steps = np.column_stack([line + start, np.zeros_like(line), -line])
        count = downsample_voxels(points_at(steps), voxel_size=side / 100)[3]
        expected = by_dictionary(steps, 100, side)
        assert count.tolist() == [len(expected[key]) for key in sorted(expected)]


# --- What is promised


def test_a_point_alone_stays_where_it_is(rng):
    xyz = rng.uniform(0, 1e6, (1000, 3))
    selected, center, _, count = downsample_voxels(xyz)
    assert (count == 1).all()
    assert (center == xyz[selected]).all()


def test_equal_votes_give_the_lowest_class():
    result = downsample_voxels(np.zeros((4, 3)), np.array([6, 2, 6, 2], np.uint8))[2]
    assert result.tolist() == [2]


def test_points_at_one_position_are_separated_by_time_then_by_return():
    xyz, time, number = np.ones((4, 3)), np.array([3.0, 2.0, np.nan, 2.0]), np.array([1, 2, 1, 1])
    assert downsample_voxels(xyz)[0].tolist() == [0]
    assert downsample_voxels(xyz, None, time + 1)[0].tolist() in ([1], [2])
    assert downsample_voxels(xyz[:2], None, time[:2])[0].tolist() == [1]
    assert downsample_voxels(xyz[[0, 1, 3]], None, time[[0, 1, 3]], number[[0, 1, 3]])[0].tolist() == [2]


def test_all_points_at_one_position(rng):
    selected, center, majority, count = downsample_voxels(np.full((5000, 3), 4.2e6), np.full(5000, 5))
    assert (len(selected), center[0].tolist(), majority[0], count[0]) == (1, [4.2e6] * 3, 5, 5000)


def test_dtypes_are_those_of_the_table(rng):
    result = downsample_voxels(rng.uniform(0, 1, (100, 3)), np.ones(100, np.int64))
    assert [array.dtype for array in result] == [np.int64, np.float64, np.uint8, np.uint32]


def test_too_fine_voxels_are_refused():
    with pytest.raises(ValueError, match=r"Voxels of 0.001 m are too fine for coordinates up to 1e\+15 m; take"):
        downsample_voxels(np.array([[0.0, 0, 0], [-1e15, 0, 0]]), voxel_size=0.001)


@pytest.mark.parametrize("side", [0.0, -0.1, np.nan, 2000.0, "0.1"])
def test_bad_sizes_are_refused(side):
    with pytest.raises(ValueError, match=r"Voxel size \(voxel_size\) must be"):
        downsample_voxels(np.zeros((2, 3)), voxel_size=side)


def test_it_can_be_cancelled(rng, monkeypatch):
    monkeypatch.setattr(voxels, "ROWS_AT_ONCE", 50)

    with pytest.raises(Cancelled):
        downsample_voxels(rng.uniform(0, 5, (1000, 3)), monitor=Listening(stop_at=0.5))
