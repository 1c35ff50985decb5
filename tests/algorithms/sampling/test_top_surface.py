"""The surface seen from above: heights of cells, points of walls below it, and points near at the same height."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.sampling.top_surface import TopSurface, highest_of_cells
from lidar_buildings.tests.builders import EXACT_FAR
from lidar_buildings.tests.surfaces import box, seen_from_above


def surface_of(xyz, counted=None, density=40.0):
    counted = np.ones(len(xyz), bool) if counted is None else counted
    return TopSurface(CloudSampling.of(xyz).from_corner(xyz), xyz[:, 2], counted, density)


def wall(rng, count=400):
    """Points of the wall under the eastern eave of the roof of :func:`house`."""
    return np.column_stack([np.full(count, 15.0), rng.uniform(6, 14, count), rng.uniform(0.0, 4.0, count)])


@pytest.fixture
def house(rng):
    return seen_from_above(rng, box(5, 5, 15, 15, 5.0))


def test_cells_have_the_height_of_their_highest_point(house):
    xyz, part = house
    surface = surface_of(xyz)
    row, column = surface.cell
    expected = np.array([xyz[(row == row[i]) & (column == column[i]), 2].max() for i in range(0, len(xyz), 97)])
    np.testing.assert_array_equal(surface.elevation[surface.cell][::97], expected)


def test_walls_are_below_the_surface_and_roofs_are_not(house, rng):
    xyz, part = house
    xyz = np.concatenate([xyz, wall(rng)])
    on_top = surface_of(xyz).on_top(xyz)
    assert on_top[: len(part)][part == 1].all()
    assert not on_top[len(part) :].any()


def test_a_roof_of_45_degrees_is_of_the_surface(rng):
    xyz = seen_from_above(rng, lambda x, y: np.maximum(8 - np.abs(x - 15), 0))[0]
    assert surface_of(xyz).on_top(xyz).all()


def test_points_that_do_not_count_have_no_height(house):
    xyz, _ = house
    bird = np.array([[10.0, 10.0, 60.0]])
    both = np.concatenate([xyz, bird])
    counted = np.arange(len(both)) < len(xyz)
    assert surface_of(both, counted).elevation.max() == 5.0
    assert surface_of(both).elevation.max() == 60.0


def test_small_gaps_take_the_height_beside_them_and_large_ones_have_none(house):
    xyz, _ = house
    hole = np.hypot(*(xyz[:, :2] - [10, 10]).T) < 0.35
    court = np.hypot(*(xyz[:, :2] - [22, 22]).T) < 3.0
    surface = surface_of(xyz[~hole & ~court])
    # Cells of the holes' middles; the southwest corner of the cloud is in the cell of the first point.
    low = xyz[~hole & ~court, :2].min(axis=0) - 4 * surface.size
    places = ((10, 10), (22, 22))
    hole_cell, court_cell = (np.floor((np.array(place) - low) / surface.size).astype(int)[::-1] for place in places)
    assert surface.height[tuple(hole_cell)] == 5.0
    assert surface.height[tuple(court_cell)] == 0.0
    assert np.isneginf(surface.elevation[tuple(court_cell)])


def test_nothing_depends_on_the_order_of_points_or_the_place_on_the_map(house, rng):
    xyz, _ = house
    order = rng.permutation(len(xyz))
    for moved in (xyz[order], xyz[order] + EXACT_FAR):
        surface = surface_of(moved)
        np.testing.assert_allclose(
            surface.elevation[surface.cell], surface_of(xyz).elevation[surface_of(xyz).cell][order], atol=1e-9
        )


def test_the_highest_points_of_cells(rng):
    xyz = rng.uniform(0, 3, (500, 3))
    highest, under = highest_of_cells(CloudSampling.of(xyz).from_corner(xyz), 1.0)
    cell = np.floor(xyz[:, :2] - xyz[:, :2].min(axis=0)).astype(int)
    for i in range(500):
        same = np.flatnonzero((cell == cell[i]).all(axis=1))
        assert highest[under[i]] == same[np.argmax(xyz[same, 2])]


def test_of_points_equally_high_the_eastern_one_counts():
    xyz = np.array([[0.2, 0.1, 1.0], [0.8, 0.1, 1.0], [0.5, 0.9, 1.0]])
    for order in ([0, 1, 2], [2, 1, 0], [1, 2, 0]):
        highest, under = highest_of_cells(xyz[order], 1.0)
        assert order[highest[0]] == 1
        np.testing.assert_array_equal(under, 0)
