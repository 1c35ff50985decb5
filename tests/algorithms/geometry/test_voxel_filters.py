"""Filters of the numbers of points in voxels, compared with scipy's on a whole grid."""

import numpy as np
import pytest
from scipy import ndimage

from lidar_buildings.algorithms.geometry.voxel_filters import FILTERS, filter_counts
from lidar_buildings.algorithms.stage import Monitor

BINOMIAL = np.einsum("i,j,k->ijk", *[[0.25, 0.5, 0.25]] * 3)

WHOLE = {
    "mean": lambda grid: ndimage.convolve(grid, np.full((3, 3, 3), 1 / 27), mode="constant"),
    "binomial": lambda grid: ndimage.convolve(grid, BINOMIAL, mode="constant"),
    "minimum": lambda grid: ndimage.minimum_filter(grid, 3, mode="constant"),
    "median": lambda grid: ndimage.median_filter(grid, 3, mode="constant"),
    "maximum": lambda grid: ndimage.maximum_filter(grid, 3, mode="constant"),
}


@pytest.mark.parametrize("name", FILTERS)
@pytest.mark.parametrize("share", [0.05, 0.9])
def test_a_filter_is_that_of_the_whole_grid(name, share, rng):
    grid = np.zeros((9, 12, 8))
    grid[2:-2, 2:-2, 2:-2] = rng.integers(1, 9, (5, 8, 4)) * (rng.random((5, 8, 4)) < share)
    cells = np.argwhere(grid > 0)
    found, value = filter_counts(cells, grid[tuple(cells.T)].astype(int), name, Monitor())
    expected = WHOLE[name](grid)
    expected[np.abs(expected) < 1e-12] = 0
    np.testing.assert_array_equal(found, np.argwhere(expected > 0))
    np.testing.assert_allclose(value, expected[tuple(found.T)])
