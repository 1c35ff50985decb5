"""What stands free is told from terrain by its edges alone: surfaces of which every cell is known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.terrain.standing import free_standing

USUAL = 60.0


def slope(rows, columns, rise=0.0):
    """Return a surface that rises so much per cell of 1 m along its rows."""
    return np.repeat(rise * np.arange(rows, dtype=float)[:, None], columns, axis=1)


def block(surface, rows, columns, height):
    """Return which cells a block covers, after it was put on the surface: level, so high over its lowest place."""
    here = np.zeros(surface.shape, bool)
    here[rows, columns] = True
    surface[here] = surface[here].min() + height
    return here


@pytest.mark.parametrize("rise", [0.0, 0.1, 0.5])
@pytest.mark.parametrize(("side", "height"), [(8, 7.0), (30, 20.0)])
def test_a_house_stands_free_on_any_slope(rise, side, height):
    surface = slope(80, 80, rise)
    house = block(surface, slice(20, 20 + side), slice(20, 20 + side), height + rise * side)
    found, size = free_standing(surface, 1.0, USUAL)
    np.testing.assert_array_equal(found, house)
    assert size == side


@pytest.mark.parametrize("cell_size", [0.5, 1.0, 2.0])
def test_a_hall_may_be_larger_than_any_window(cell_size):
    surface = slope(300, 280)
    hall = block(surface, slice(20, 270), slice(30, 260), 7.0)
    found, size = free_standing(surface, cell_size, USUAL)
    np.testing.assert_array_equal(found, hall)
    assert size == 230 * cell_size
    assert not free_standing(surface, cell_size, USUAL, largest=USUAL)[0].any()


@pytest.mark.parametrize(("width", "is_object"), [(50, True), (70, False)])
def test_what_is_wider_than_usual_needs_walls_higher_than_quays(width, is_object):
    surface = slope(120, 120)
    block(surface, slice(10, 110), slice(10, 10 + width), 1.5)
    assert free_standing(surface, 1.0, USUAL)[0].any() == is_object


def test_an_island_with_houses_on_it_is_terrain_and_the_houses_are_not():
    surface = slope(160, 160)
    block(surface, slice(10, 150), slice(10, 150), 3.0)
    houses = np.zeros(surface.shape, bool)
    for row in range(20, 130, 30):
        for column in range(20, 130, 30):
            houses |= block(surface, slice(row, row + 14), slice(column, column + 10), 6.0)
    np.testing.assert_array_equal(free_standing(surface, 1.0, USUAL)[0], houses)


def test_machines_on_a_roof_make_no_terrain_of_it():
    surface = slope(120, 120)
    hall = block(surface, slice(10, 110), slice(10, 110), 8.0)
    for row in range(20, 100, 20):
        block(surface, slice(row, row + 5), slice(40, 48), 2.0)
    np.testing.assert_array_equal(free_standing(surface, 1.0, USUAL)[0], hall)


def test_a_low_house_beside_a_tower_is_judged_by_the_rest_of_its_edge():
    surface = slope(60, 60)
    low = block(surface, slice(20, 32), slice(20, 32), 4.0)
    tower = block(surface, slice(32, 42), slice(18, 34), 30.0)
    np.testing.assert_array_equal(free_standing(surface, 1.0, USUAL)[0], low | tower)


def test_terraces_below_a_forest_are_terrain(rng):
    """The upper edge of the first is too rough to tell, that of each of the others lies below one that is judged."""
    vineyard = np.floor(slope(130, 140) + np.arange(130)[:, None] / 12) * 3.0
    vineyard[118:] += rng.uniform(0.0, 15.0, vineyard[118:].shape)
    assert not free_standing(vineyard, 1.0, USUAL)[0][:118].any()
    hut = block(vineyard, slice(50, 57), slice(30, 36), 3.0)
    np.testing.assert_array_equal(free_standing(vineyard, 1.0, USUAL)[0][:118], hut[:118])


def test_terraces_and_hills_are_terrain():
    """A terrace has its step on one side, and nothing is known of the others; a hill has no step, however high."""
    terraces = np.floor(slope(90, 60) + np.arange(90)[:, None] / 30) * 4.0
    assert not free_standing(terraces, 1.0, USUAL)[0].any()
    x, y = np.meshgrid(np.arange(100.0), np.arange(100.0))
    assert not free_standing(30.0 * np.exp(-((x - 50) ** 2 + (y - 50) ** 2) / 900), 1.0, USUAL)[0].any()


def test_a_house_at_the_end_of_the_cloud_stands_free_on_its_other_sides():
    surface = slope(60, 60)
    house = block(surface, slice(0, 14), slice(20, 34), 5.0)
    corner = block(surface, slice(40, 60), slice(40, 60), 5.0)
    found = free_standing(surface, 1.0, USUAL)[0]
    assert found[house].all()
    assert not found[corner].any()


def test_a_courtyard_stays_terrain():
    surface = slope(80, 80)
    ring = block(surface, slice(20, 60), slice(20, 60), 9.0)
    surface[32:48, 32:48] = 0.0
    ring[32:48, 32:48] = False
    np.testing.assert_array_equal(free_standing(surface, 1.0, USUAL)[0], ring)


def test_turning_the_surface_turns_the_result(rng):
    surface = slope(60, 50, 0.05) + rng.normal(0, 0.03, (60, 50))
    block(surface, slice(10, 25), slice(12, 30), 3.0)
    found = free_standing(surface, 1.0, USUAL)[0]
    assert found.any()
    for turned in (np.rot90, np.flipud, np.transpose):
        np.testing.assert_array_equal(free_standing(turned(surface), 1.0, USUAL)[0], turned(found))


@pytest.mark.parametrize("shape", [(1, 1), (1, 40), (40, 1)])
def test_a_surface_of_one_row_or_one_cell_has_nothing_that_stands(shape):
    """Its edge is the edge of the cloud: a step on the way along it tells nothing of the sides."""
    surface = np.zeros(shape)
    surface.ravel()[15:25] = 6.0
    found, size = free_standing(surface, 1.0, USUAL)
    assert found.shape == shape
    assert not found.any()
    assert size == 0.0
