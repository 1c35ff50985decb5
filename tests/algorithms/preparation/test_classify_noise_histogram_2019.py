"""The published cell histogram filter, by histograms that are plain to see."""

import numpy as np
import pytest

from lidar_buildings.algorithms.preparation.classify_noise_histogram import classify_noise_histogram
from lidar_buildings.algorithms.preparation.classify_noise_histogram_2019 import classify_noise_histogram_2019
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.monitors import Listening

CELLS = {"cell_size": 10.0, "bin_height": 1.0}


def at(*heights, x=5.0, y=5.0):
    """Return points above one another."""
    return np.column_stack([np.full(len(heights), x), np.full(len(heights), y), heights])


def found(*parts, **tunables):
    """Return the classes of the last part, the points asked about, in a scene of class 1."""
    xyz = np.concatenate(parts)
    classes = classify_noise_histogram_2019(xyz, np.ones(len(xyz), np.uint8), **{**CELLS, **tunables})
    return classes[-len(parts[-1]) :].tolist()


@pytest.fixture
def field(rng):
    """Two points per square meter of 40 m by 40 m, 0 to 0.9 m high: 200 in each cell."""
    return rng.uniform(0, 1, (3200, 3)) * [40, 40, 0.9]


def test_bins_are_walked_in_from_both_ends_up_to_the_first_full_one(field):
    """Poor bins are noise below the lowest full bin and above the highest; on a mast between them they stay."""
    roof = np.tile(at(10.5), (5, 1))
    asked = at(-2.5, -0.9, 3.5, 9.5, 11.5, 30.5)
    assert found(field, roof, asked) == [7, 7, 1, 1, 18, 18]
    assert found(field, roof, asked, min_frequency=6) == [7, 7, 18, 18, 18, 18]


@pytest.mark.parametrize(("count", "expected"), [(4, 7), (5, 1)])
def test_a_bin_needs_the_minimum_frequency(field, count, expected):
    assert found(field, np.tile(at(-3.5), (count, 1))) == [expected] * count


def test_low_points_right_below_a_field_are_found_and_not_by_the_filter_that_asks_for_a_gap(field):
    """Four points 1.8 to 2.9 m under a field, which become seeds of the ground where they stay."""
    low = at(-1.8, -2.1, -2.5, -2.9, x=15.0)
    assert found(field, low) == [7] * 4
    xyz = np.concatenate([field, low])
    assert (classify_noise_histogram(xyz, np.ones(len(xyz), np.uint8), isolated=False)[-4:] == 1).all()


def test_a_poor_cell_borrows_from_its_neighbors_and_a_lonely_one_from_the_nearest(field):
    """Next to the field lie a cell of three points, and one far from all others."""
    beside, lonely = at(0.5, -5.5, 5.5, x=45.0), at(0.5, -5.5, 5.5, x=500.0)
    assert found(field, beside) == [1, 7, 18]
    assert found(field, lonely) == [1, 7, 18]


def test_a_rich_cell_does_not_borrow():
    """A hill next to a field: pooled, its foot and the field would be one histogram, in which nothing is alone."""
    random = np.random.default_rng(1)
    low = random.uniform(0, 1, (500, 3)) * [10, 10, 0.9]
    high = low + [10, 0, 20]
    assert found(low, high, at(0.5, x=15.0)) == [7]
    assert found(low, high, at(20.5, x=5.0)) == [18]


def test_noise_stays_and_is_not_counted(field):
    xyz = np.concatenate([field, np.tile(at(-3.5), (6, 1))])
    classes = np.ones(len(xyz), np.uint8)
    classes[-6:-3] = 7
    assert (classify_noise_histogram_2019(xyz, classes, **CELLS)[-6:] == 7).all()


def test_without_a_full_bin_nothing_is_found_and_the_log_says_so():
    monitor = Monitor()
    xyz = np.array([[0.0, 0, 0], [5, 5, 50], [9, 9, 100]])
    assert (classify_noise_histogram_2019(xyz, np.ones(3, np.uint8), monitor=monitor) == 1).all()
    assert monitor.warnings == ["No noise was found: no bin of the histograms has 5 points."]


def test_order_and_position_change_nothing_and_automatic_values_are_reported(field, rng):
    xyz = np.concatenate([field, at(-3.5, 8.5, x=15.0)])
    monitor = Monitor()
    classes = classify_noise_histogram_2019(xyz, np.ones(len(xyz), np.uint8), monitor=monitor)
    assert classes[-2:].tolist() == [7, 18]
    assert (classes == 1).sum() == len(field)
    assert monitor.values["cell_size"] == pytest.approx(np.sqrt(4000 / 2), rel=0.05)
    assert monitor.values["bin_height"] == pytest.approx(2 / np.sqrt(2), rel=0.05)
    order = rng.permutation(len(xyz))
    again = classify_noise_histogram_2019(xyz[order], np.ones(len(xyz), np.uint8))
    np.testing.assert_array_equal(again, classes[order])


def test_cancel_gets_through(field):
    with pytest.raises(Cancelled):
        classify_noise_histogram_2019(field, np.ones(len(field), np.uint8), monitor=Listening(0.3))
