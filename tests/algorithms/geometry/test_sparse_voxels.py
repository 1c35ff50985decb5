"""Sparse voxels against scipy.ndimage on dense grids."""

import tracemalloc

import numpy as np
import pytest
from scipy import ndimage

from lidar_buildings.algorithms.geometry import sparse_voxels
from lidar_buildings.algorithms.geometry.sparse_voxels import (
    close_voxels,
    dilate,
    distance_to_background,
    erode,
    label_components,
    neighbor_offsets,
    neighbor_pairs,
    open_voxels,
    voxelize,
)

ELEMENTS = {6: ndimage.generate_binary_structure(3, 1), 18: ndimage.generate_binary_structure(3, 2)}
ELEMENTS[26] = ndimage.generate_binary_structure(3, 3)
FAR_CELLS = np.array([600_000_000, -5_000_000_000, 7])
each_connectivity = pytest.mark.parametrize("connectivity", [6, 18, 26])


@pytest.fixture(params=[0.15, 0.5, 0.85])
def dense(rng, request):
    """A grid with random voxels, with room around for dilations."""
    grid = np.zeros((14, 13, 12), bool)
    grid[3:-3, 3:-3, 3:-3] = rng.random((8, 7, 6)) < request.param
    return grid


def cells_of(grid):
    return np.argwhere(grid) + FAR_CELLS


def grid_of(cells, shape):
    grid = np.zeros(shape, bool)
    grid[tuple((cells - FAR_CELLS).T)] = True
    return grid


@each_connectivity
def test_components_are_those_of_the_dense_grid(dense, connectivity):
    expected, count = ndimage.label(dense, ELEMENTS[connectivity])
    labels = label_components(cells_of(dense), connectivity)
    assert labels.max() + 1 == count
    np.testing.assert_array_equal(labels, expected[dense] - 1)


@each_connectivity
@pytest.mark.parametrize("steps", [0, 1, 2, 3])
def test_morphology_is_that_of_the_dense_grid(dense, connectivity, steps):
    def opinion(operation, grid):
        return operation(grid, ELEMENTS[connectivity], iterations=steps) if steps else grid

    cells = cells_of(dense)
    grown, shrunk = opinion(ndimage.binary_dilation, dense), opinion(ndimage.binary_erosion, dense)
    np.testing.assert_array_equal(dilate(cells, connectivity, steps), cells_of(grown))
    np.testing.assert_array_equal(erode(cells, connectivity, steps), cells_of(shrunk))
    opened, closed = opinion(ndimage.binary_dilation, shrunk), opinion(ndimage.binary_erosion, grown)
    np.testing.assert_array_equal(open_voxels(cells, connectivity, steps), cells_of(opened))
    np.testing.assert_array_equal(close_voxels(cells, connectivity, steps), cells_of(closed))


def test_distances_are_those_of_the_dense_grid(dense):
    cells = cells_of(dense)
    np.testing.assert_allclose(distance_to_background(cells), ndimage.distance_transform_edt(dense)[dense])


@each_connectivity
def test_each_pair_of_neighbors_comes_once(dense, connectivity):
    cells = cells_of(dense)
    one, other, axes = neighbor_pairs(cells, connectivity)
    apart = np.abs(cells[:, None] - cells[None])
    n_axes = np.where(apart.max(axis=2) <= 1, apart.sum(axis=2), 0)
    expected = np.argwhere(np.tril((n_axes > 0) & (n_axes <= {6: 1, 18: 2, 26: 3}[connectivity])))
    order = np.lexsort((other, one))
    np.testing.assert_array_equal(np.column_stack([one, other])[order], expected)
    np.testing.assert_array_equal(axes, n_axes[one, other])


def test_opposite_steps_stand_at_opposite_ends():
    for connectivity in (6, 18, 26):
        steps = neighbor_offsets(connectivity)
        assert len(steps) == connectivity
        np.testing.assert_array_equal(steps, -steps[::-1])


def test_points_get_their_voxel_at_any_place(rng):
    xyz = rng.uniform(-3, 3, (500, 3)).round(3)
    cells, voxel, count = voxelize(xyz, 0.25)
    np.testing.assert_array_equal(cells[voxel], np.floor(xyz / 0.25 + 1e-9))
    np.testing.assert_array_equal(count, np.bincount(voxel))
    np.testing.assert_array_equal(np.unique(cells, axis=0), cells)
    far = voxelize(xyz + [600_000.0, 5_000_000.0, 0.0], 0.25)
    np.testing.assert_array_equal(far[1], voxel)
    np.testing.assert_array_equal(far[0] - cells, np.broadcast_to([2_400_000, 20_000_000, 0], cells.shape))
    order = rng.permutation(500)
    np.testing.assert_array_equal(voxelize(xyz[order], 0.25)[1], voxel[order])


def test_decimals_on_a_side_belong_to_the_upper_voxel():
    assert voxelize(np.array([[0.3, 0.6, 0.7]]), 0.1)[0].tolist() == [[3, 6, 7]]


def test_a_tall_thin_scene_takes_the_memory_of_its_voxels(rng):
    """A box of 10^15 cells around a mast, a wire and a far tree."""
    mast = np.column_stack([np.zeros(3000), np.zeros(3000), np.linspace(0, 300, 3000)])
    wire = np.column_stack([np.linspace(0, 2000, 9000), np.linspace(0, 2000, 9000), np.full(9000, 300.0)])
    xyz = np.concatenate([mast, wire, rng.normal([9000, -9000, 0], 2, (2000, 3))])
    tracemalloc.start()
    cells, _, _ = voxelize(xyz, 0.05)
    labels = label_components(close_voxels(cells, 26, 3), 26)
    distance_to_background(cells)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert labels.max() > 0
    assert peak < 600e6


def test_nothing_gives_nothing():
    none = np.zeros((0, 3), np.int64)
    assert voxelize(np.zeros((0, 3)), 1.0)[0].shape == (0, 3)
    for operation in (dilate, erode, open_voxels, close_voxels):
        assert operation(none, 26).shape == (0, 3)
    assert len(label_components(none, 6)) == len(distance_to_background(none)) == 0


def test_too_many_voxels_are_refused():
    with pytest.raises(ValueError, match="too fine for coordinates up to 1e[+]12 m"):
        voxelize(np.array([[0.0, 0, 0], [1e12, 0, 0]]), 0.001)
    with pytest.raises(ValueError, match="10,000,001 by 10,000,001 by 10,000,001 voxels, more than can be numbered"):
        voxelize(np.array([[0.0, 0, 0], [1e4, 1e4, 1e4]]), 0.001)
    assert sparse_voxels.find_keys(np.zeros(0, np.int64), np.arange(3)).tolist() == [-1, -1, -1]
