"""Cells are numbered so that neighbors differ by fixed steps, and grouped as images of them are."""

import numpy as np
import pytest
from scipy import ndimage

from lidar_buildings.algorithms.geometry.grid import (
    connected_cells,
    distinct,
    find_cells,
    fixed_grid_over,
    grid_over,
    plan_box,
    raster_cells,
)


@pytest.mark.parametrize("make", [grid_over, fixed_grid_over])
def test_number_and_center_agree(rng, make):
    xyz = rng.uniform(0, 50, (500, 3)) + [600_000, 5_000_000, 0]
    grid = make(xyz, 2.0)
    number = grid.number(xyz)
    assert np.abs(grid.center(number) - xyz[:, :2]).max() <= 1.0 + 1e-6
    assert (number >= 0).all()
    assert number.max() < grid.rows * grid.columns


@pytest.mark.parametrize("size", [0.3, 2.0])
def test_a_part_of_a_cloud_has_the_cells_of_the_whole(rng, size):
    """Fixed cells begin at multiples of their size from zero; cells of a grid over points begin at the points."""
    xyz = rng.uniform(-20, 30, (500, 3))
    part = xyz[(xyz[:, 0] > 3.1) & (xyz[:, 1] < 7.7)]
    grid = fixed_grid_over(xyz, size)
    centers = grid.center(grid.number(part))
    fixed = fixed_grid_over(part, size)
    np.testing.assert_allclose(fixed.center(fixed.number(part)), centers, atol=1e-9)
    np.testing.assert_allclose(np.floor(part[:, :2] / size) * size + size / 2, centers, atol=1e-9)
    moving = grid_over(part, size)
    assert np.abs(moving.center(moving.number(part)) - centers).max() > 0.01 * size


@pytest.mark.parametrize("margin", [0, 2])
def test_rasters_have_the_cells_of_the_fixed_grid_and_a_margin(rng, margin):
    xyz = rng.uniform(-20, 30, (500, 3))
    row, column = raster_cells(xyz, 1.5, margin)
    assert (row.min(), column.min()) == (margin, margin)
    _, same = np.unique(fixed_grid_over(xyz, 1.5).number(xyz), return_inverse=True)
    _, of_raster = np.unique(row * 1000 + column, return_inverse=True)
    np.testing.assert_array_equal(of_raster, same)


def test_steps_lead_to_the_eight_neighbors():
    grid = grid_over(np.array([[0.0, 0, 0], [9, 9, 0]]), 1.0)
    here = grid.number(np.array([[4.5, 4.5, 0]]))
    around = grid.center(here + np.array(grid.around)) - grid.center(here)
    assert sorted(map(tuple, around)) == [(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y]


def test_groups_are_those_of_image_labels(rng):
    image = rng.random((40, 30)) < 0.3
    image[:, 0] = image[:, -1] = True  # columns at both sides never touch each other
    row, column = np.nonzero(image)
    xyz = np.column_stack([column + 0.5, row + 0.5, np.zeros(len(row))])
    grid = grid_over(np.concatenate([xyz, [[0, 0, 0]]]), 1.0)
    cells = grid.number(xyz)
    order = np.argsort(cells)
    count, group = connected_cells(grid, cells[order])
    label, expected = ndimage.label(image, np.ones((3, 3)))
    assert count == expected
    pairs = set(zip(group.tolist(), label[row, column][order].tolist()))
    assert len(pairs) == count


def test_no_cells_are_no_groups():
    count, group = connected_cells(grid_over(np.zeros((1, 3)), 1.0), np.zeros(0, np.int64))
    assert (count, len(group)) == (0, 0)


@pytest.mark.parametrize("cells", [[], [3], [1, 4, 9]])
def test_find(cells):
    wanted = np.array([0, 1, 3, 4, 10])
    position, found = find_cells(np.array(cells, np.int64), wanted)
    assert found.tolist() == [number in cells for number in wanted]
    assert all(cells[p] == number for p, number, there in zip(position, wanted, found) if there)


@pytest.mark.parametrize("span", [1, 100, 10**12], ids=["one number", "by a table", "by sorting"])
def test_distinct_numbers_are_those_of_numpy(rng, span):
    numbers = rng.integers(-span, span, 500) + 10**13
    values, which = distinct(numbers)
    expected, inverse = np.unique(numbers, return_inverse=True)
    np.testing.assert_array_equal(values, expected)
    np.testing.assert_array_equal(which, inverse)


def test_no_numbers_are_distinct():
    assert [len(part) for part in distinct(np.zeros(0, np.int64))] == [0, 0]


def test_box_in_plan():
    np.testing.assert_array_equal(plan_box(np.array([[3.0, 1, 9], [2, 7, -1], [5, 4, 0]])), [[2, 1], [5, 7]])
