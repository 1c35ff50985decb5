"""The fast opening against scipy's slow one with the same octagon, and what any opening must do."""

import tracemalloc

import numpy as np
import pytest
from scipy import ndimage

from lidar_buildings.algorithms.geometry.raster_opening import open_surface

RADII = [1, 3, 4, 5, 8, 12]


def plate(radius):
    """Return the octagon of cells (bool) whose diagonal sides, |i| + |j|, come nearest to a regular one's."""
    i, j = np.mgrid[-radius : radius + 1, -radius : radius + 1]
    # A diagonal half as long as d cells takes 2 d of that sum away.
    sides = [2 * radius - 2 * d for d in range(radius // 2 + 1)]
    return abs(i) + abs(j) <= min(sides, key=lambda side: abs(side - np.sqrt(2) * radius))


@pytest.mark.parametrize("radius", RADII)
def test_an_octagon_stays_and_one_without_its_rim_goes(radius):
    octagon = plate(radius)
    surface = np.pad(octagon.astype(float), radius)
    np.testing.assert_array_equal(open_surface(surface, radius), surface)
    for i, j in np.argwhere(octagon & ~ndimage.binary_erosion(octagon)):
        dented = surface.copy()
        dented[radius + i, radius + j] = 0
        assert open_surface(dented, radius).max() == 0


@pytest.mark.parametrize("radius", RADII)
def test_inside_it_is_the_opening_of_scipy(radius, rng):
    surface = rng.normal(size=(6 * radius + 15, 6 * radius + 10))
    slow = ndimage.grey_opening(surface, footprint=plate(radius))
    inside = (slice(2 * radius, -2 * radius),) * 2
    np.testing.assert_array_equal(open_surface(surface, radius)[inside], slow[inside])


@pytest.mark.parametrize("radius", RADII)
def test_inside_it_never_rises_and_twice_is_once(radius, rng):
    surface = rng.normal(size=(8 * radius + 15, 8 * radius + 10))
    opened = open_surface(surface, radius)
    inside = (slice(2 * radius, -2 * radius),) * 2
    assert (opened <= surface)[inside].all()
    deeper = (slice(4 * radius, -4 * radius),) * 2
    np.testing.assert_array_equal(open_surface(opened, radius)[deeper], opened[deeper])


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("slopes", [(0.0, 0.0), (0.5, 0.0), (-0.3, 0.7)])
def test_planes_stay_inside(radius, slopes):
    i, j = np.mgrid[: 5 * radius + 10, : 5 * radius + 7]
    plane = 10 + slopes[0] * i + slopes[1] * j
    inside = (slice(2 * radius, -2 * radius),) * 2
    np.testing.assert_allclose(open_surface(plane, radius)[inside], plane[inside], atol=1e-12)


@pytest.mark.parametrize("radius", [1, 2, 3, 7])
def test_objects_narrower_than_the_plate_go_and_pits_stay(radius):
    surface = np.full((60, 50), 2.0)
    surface[20 : 20 + 2 * radius, 5:45] = 9.0
    surface[50, 25] = -3.0
    opened = open_surface(surface, radius)
    assert opened.max() == 2.0
    assert opened[50, 25] == -3.0


def test_a_building_at_the_border_goes_too():
    surface = np.zeros((40, 40))
    surface[:6, :6] = 8.0
    assert open_surface(surface, 8).max() == 0


@pytest.mark.parametrize("shape", [(1, 1), (2, 3), (9, 7)])
def test_rasters_smaller_than_the_plate_become_level(shape, rng):
    surface = rng.normal(size=shape)
    opened = open_surface(surface, 40)
    assert opened.shape == shape
    np.testing.assert_array_equal(opened, surface.min())


def test_the_surface_given_is_left_alone(rng):
    surface = rng.normal(size=(20, 20))
    before = surface.copy()
    open_surface(surface, 3)
    np.testing.assert_array_equal(surface, before)


def test_plates_rest_on_cells_that_are_not_absent():
    """Next to absent cells a low shelf is not widened by them, and a valley between two such shelves stays."""
    surface = np.zeros((30, 60))
    absent = np.zeros(surface.shape, bool)
    absent[5:25, 10:20] = absent[5:25, 30:40] = True
    surface[absent] = 9.0
    surface[5:25, 20:23] = 2.0
    opened = open_surface(surface, 4, absent)
    assert (opened[absent] == 9.0).all()
    assert (opened[~absent] == 0.0).all()
    assert (open_surface(surface, 4)[5:25, 20:23] == 2.0).any()


@pytest.mark.parametrize("radius", [1, 3, 4, 5])
@pytest.mark.parametrize("level", [-50.0, 50.0])
def test_inside_it_is_the_highest_plate_over_a_cell_that_no_cell_is_below(radius, level, rng):
    """By definition, cell by cell: absent cells neither hold a plate up nor have one centered over them."""
    surface = level + rng.normal(size=(5 * radius + 12, 5 * radius + 9))
    absent = rng.random(surface.shape) < 0.3
    steps = np.argwhere(plate(radius)) - radius

    def under(center):
        """Return the cells, absent ones left out, that a plate over ``center`` covers."""
        return [tuple(cell) for cell in center + steps if not absent[tuple(cell)]]

    height = {
        (i, j): min(surface[cell] for cell in under((i, j)))
        for i, j in np.argwhere(~absent)
        if radius <= i < surface.shape[0] - radius and radius <= j < surface.shape[1] - radius
    }
    opened = open_surface(surface, radius, absent)
    for i in range(2 * radius, surface.shape[0] - 2 * radius):
        for j in range(2 * radius, surface.shape[1] - 2 * radius):
            expected = surface[i, j] if absent[i, j] else max(height[cell] for cell in under((i, j)))
            assert opened[i, j] == expected


@pytest.mark.parametrize("radius", RADII)
def test_the_level_of_a_surface_is_that_of_its_opening(radius, rng):
    """Also at the border, where plates reach beyond it: cells outside hold no plate up."""
    surface = np.round(rng.normal(0, 9, (40, 30)))
    absent = rng.random(surface.shape) < 0.2
    for level in (-512.0, 512.0):
        np.testing.assert_array_equal(open_surface(surface + level, radius), open_surface(surface, radius) + level)
        moved = open_surface(surface + level, radius, absent)
        np.testing.assert_array_equal(moved, open_surface(surface, radius, absent) + level)


def test_a_narrow_strip_takes_as_little_memory_along_as_across(rng):
    strip = rng.normal(size=(4000, 40))
    opened, peaks = [], []
    for surface in (strip, np.ascontiguousarray(strip.T)):
        tracemalloc.start()
        opened.append(open_surface(surface, 8))
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    np.testing.assert_array_equal(opened[0], opened[1].T)
    assert max(peaks) < 1.5 * min(peaks) < 20 * strip.nbytes
