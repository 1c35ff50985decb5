"""Objects that windows remove from a surface, terrain that is restored, and the slope of the remaining surface."""

import numpy as np
import pytest

from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.terrain.removed_objects import (
    ObjectRemoval,
    _slope,
    _windows,
)


@pytest.mark.parametrize("largest", [0.3, 1, 1.2, 5, 30, 99.5])
def test_windows_grow_from_one_to_the_largest(largest):
    windows = _windows(largest)
    assert windows[0] == 1
    assert windows[-1] == max(1, np.ceil(largest))
    assert all(a < b <= max(a + 1, 1.25 * a + 0.5) for a, b in zip(windows, windows[1:]))


def test_the_slope_of_a_crest_is_that_of_its_flanks_and_a_plane_keeps_its_own():
    across, along = np.meshgrid(np.arange(60.0), np.arange(50.0))
    np.testing.assert_allclose(_slope(0.3 * across - 0.4 * along, 1.0)[15:-15, 15:-15], 0.5, rtol=1e-3)
    crest = _slope(-0.5 * np.abs(across - 30), 1.0)
    assert (crest[:, 20:41] > 0.35).all()
    assert (crest < 0.5 + 1e-9).all()


def removed_square(side=10):
    """Return a level surface of 40 by 40 cells of 1 m and what windows removed from it: a square from (15, 15)."""
    removed = np.zeros((40, 40), bool)
    removed[15 : 15 + side, 15 : 15 + side] = True
    return np.zeros((40, 40)), removed


def objects_of(surface, removed, slope=0.0, free=False):
    everywhere = np.ones(surface.shape)
    removal = ObjectRemoval(surface, everywhere.astype(bool) & free, largest=60.0, cell_size=1.0)
    return removal.without_joined(removed, slope * everywhere)


@pytest.mark.parametrize(("smooth", "stays"), [(10, False), (9, True)])
def test_what_joins_the_terrain_on_half_of_its_edge_comes_back(smooth, stays):
    """Of a square of 10 m two sides and so much of a third join the terrain, or a little less; there are four."""
    surface, removed = removed_square()
    surface[:15] = surface[:, :15] = -2.0
    surface[25:, 15 : 25 - smooth] = -2.0
    np.testing.assert_array_equal(objects_of(surface, removed), removed & stays)


def test_what_is_free_standing_stays_an_object_in_a_region_that_comes_back():
    """It has no wall there: removed by the same windows, it joins the region around."""
    surface, removed = removed_square(side=20)
    free = np.zeros(removed.shape, bool)
    free[20:26, 20:26] = True
    np.testing.assert_array_equal(objects_of(surface, removed, free=free), free)
    np.testing.assert_array_equal(objects_of(surface, np.zeros_like(removed), free=free), free)


@pytest.mark.parametrize(("slope", "stays"), [(1.2, False), (1.9, False), (2.3, True)])
def test_flanks_as_steep_as_the_step_make_a_bank_of_it_up_to_a_slope_of_two(slope, stays):
    _, removed = removed_square()
    rows, columns = np.mgrid[:40, :40]
    pyramid = -slope * np.maximum(np.abs(rows - 19.5), np.abs(columns - 19.5))
    np.testing.assert_array_equal(objects_of(pyramid, removed), removed & stays)


@pytest.mark.parametrize(("slope", "stays"), [(0.0, True), (0.7, True), (0.8, False)])
def test_on_slopes_higher_steps_are_smooth(slope, stays):
    """A step of 0.6 m joins where terrain may rise by 0.3 m and 0.4 of its slope from cell to cell."""
    surface, removed = removed_square()
    surface[removed] = 0.6
    np.testing.assert_array_equal(objects_of(surface, removed, slope), removed & stays)


@pytest.mark.parametrize(
    ("side", "height", "slope", "is_removed"),
    [
        # The first window that is wider has a radius of 4 m: 0.1 m, a tenth of the radius, and the slope.
        (7, 0.55, 0.0, True),
        (7, 0.45, 0.0, False),
        (7, 1.35, 0.2, True),
        (7, 1.25, 0.2, False),
    ],
)
def test_a_window_removes_what_rises_more_than_terrain_may(side, height, slope, is_removed):
    """Looked at in the middle: corners are removed by smaller windows."""
    surface, square = np.zeros((140, 140)), slice(70 - side // 2, 71 + side // 2)
    surface[square, square] = height
    removal = ObjectRemoval(surface, np.zeros(surface.shape, bool), largest=60.0, cell_size=1.0)
    removed = removal.removed_by_opening(np.full(surface.shape, slope), Monitor())
    assert (removed[70, 70] > 0) == is_removed
    assert not removed[surface == 0].any()


@pytest.mark.parametrize("cell_size", [0.5, 2.0])
def test_the_slope_does_not_depend_on_the_cells(cell_size):
    """It is smoothed over meters, whatever the cells."""
    here, cells = np.arange(0.0, 80.0), np.arange(0.0, 80.0, cell_size)
    crests = [np.repeat(-0.5 * np.abs(x - 40)[:, None], 40, axis=1) for x in (here, cells)]
    expected, found = (_slope(crest, size)[:, 20] for crest, size in zip(crests, (1.0, cell_size)))
    np.testing.assert_allclose(np.interp(here, cells, found)[20:60], expected[20:60], atol=0.02)
