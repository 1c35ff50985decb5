"""Numbers of cells as if drawn at random: even, without order among neighbors, and each of its cell alone."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.scattered import scattered


@pytest.mark.parametrize("axes", [2, 3])
def test_numbers_are_as_even_as_random_ones(axes):
    cells = np.stack(np.meshgrid(*[np.arange(-20, 20)] * axes), axis=-1).reshape(-1, axes)
    number = scattered(cells)
    assert 0 <= number.min() <= number.max() < 1
    counts = np.histogram(number, 16, (0, 1))[0]
    expected = len(cells) / 16
    # Four standard deviations of a count.
    assert np.abs(counts - expected).max() < 4 * np.sqrt(expected)
    # Every quarter of the cells has its share of the sample.
    taken = cells[number < 0.25]
    assert np.abs(taken.mean(axis=0) + 0.5).max() < 4 * 40 / np.sqrt(12 * len(taken))
    # Neighbors along an axis are no more alike than any two.
    along = number.reshape([40] * axes)
    for axis in range(axes):
        pairs = np.corrcoef(np.take(along, range(39), axis).ravel(), np.take(along, range(1, 40), axis).ravel())
        assert abs(pairs[0, 1]) < 4 / np.sqrt(len(cells))


def test_coordinates_stored_in_steps_give_numbers_as_even():
    """Heights of points are multiples of the step of their file, here of a centimeter in tenths of a millimeter."""
    points = 100 * np.random.default_rng(5).integers(0, 20_000, (50_000, 3))
    counts = np.histogram(scattered(points), 16, (0, 1))[0]
    assert np.abs(counts - len(points) / 16).max() < 4 * np.sqrt(len(points) / 16)


def test_a_number_is_of_its_cell_alone():
    cells = np.random.default_rng(3).integers(-(10**6), 10**6, (500, 3))
    np.testing.assert_array_equal(scattered(cells)[::-1], scattered(cells[::-1]))
    np.testing.assert_array_equal(scattered(cells[7:9]), scattered(cells)[7:9])
