"""Rasters of surfaces that are known by formula."""

import numpy as np
import pytest
from scipy.interpolate import LinearNDInterpolator

from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.algorithms.terrain.rasterize_terrain import rasterize_terrain, round_cell_size
from lidar_buildings.tests.monitors import Listening


def slope_with_house(rng, density=8.0):
    """Return points of a slope 30 m wide with a flat house on it, and their classes."""
    plan = rng.uniform(0, 30, (int(900 * density), 2))
    on_house = (np.abs(plan - 15) < 5).all(axis=1)
    z = np.where(on_house, 20.0, 0.2 * plan[:, 0] - 0.1 * plan[:, 1])
    return np.column_stack([plan, z]), np.where(on_house, 6, 2)


def middles(surface):
    rows, columns = surface.values.shape
    x = surface.west + (np.arange(columns) + 0.5) * surface.cell_size
    y = surface.north - (np.arange(rows) + 0.5) * surface.cell_size
    return np.meshgrid(x, y)


def test_terrain_is_interpolated_under_the_house_and_ends_at_the_hull(rng):
    xyz, classes = slope_with_house(rng)
    dtm, dsm, ndsm = rasterize_terrain(xyz, classes, cell_size=0.5)
    x, y = middles(dtm)
    expected = LinearNDInterpolator(xyz[classes == 2, :2], xyz[classes == 2, 2])(x, y)
    np.testing.assert_array_equal(np.isnan(dtm.values), np.isnan(expected))
    np.testing.assert_allclose(dtm.values, 0.2 * x - 0.1 * y + 0 * expected, atol=1e-4)
    on_house = (np.abs(x - 15) < 4.4) & (np.abs(y - 15) < 4.4)
    np.testing.assert_allclose(dsm.values[on_house], 20.0, atol=1e-5)
    np.testing.assert_allclose(ndsm.values, dsm.values - dtm.values, atol=1e-5)


def test_surface_is_the_highest_point_of_each_cell(rng):
    xyz, classes = slope_with_house(rng, density=3)
    xyz[:, 2] += rng.uniform(0, 5, len(xyz))
    dsm = rasterize_terrain(xyz, classes, cell_size=1.0, gap_distance=0.0)[1]
    for row, column in ((0, 0), (7, 3), (29, 29), (12, 20)):
        west, north = dsm.west + column, dsm.north - row
        inside = (xyz[:, 0] >= west) & (xyz[:, 0] < west + 1) & (xyz[:, 1] < north) & (xyz[:, 1] >= north - 1)
        expected = xyz[inside, 2].max() if inside.any() else np.nan
        assert dsm.values[row, column] == pytest.approx(expected, abs=1e-5, nan_ok=True)


def test_small_gaps_are_filled_and_large_ones_stay(rng):
    xyz, _ = slope_with_house(rng)
    xyz[:, 2] = 0.2 * xyz[:, 0]
    small, large = np.hypot(*(xyz[:, :2] - 6).T) < 1.5, np.hypot(*(xyz[:, :2] - 20).T) < 6
    is_kept = ~small & ~large
    dsm = rasterize_terrain(xyz[is_kept], np.full(is_kept.sum(), 2), cell_size=0.5, gap_distance=2.0)[1]
    x, y = middles(dsm)
    filled = np.hypot(x - 6, y - 6) < 1
    # The highest point of a cell lies up to half a cell higher on the slope.
    np.testing.assert_allclose(dsm.values[filled], 0.2 * x[filled], atol=0.06)
    from_middle = np.hypot(x - 20, y - 20)
    assert np.isnan(dsm.values[from_middle < 3]).all()
    assert np.isfinite(dsm.values[(from_middle > 4.8) & (from_middle < 6)]).all()
    unfilled = rasterize_terrain(xyz[is_kept], np.full(is_kept.sum(), 2), cell_size=0.5, gap_distance=0.0)[1]
    assert np.isnan(unfilled.values[filled]).all()


def test_noise_is_left_out(rng):
    xyz, classes = slope_with_house(rng)
    stray = np.array([[15.0, 15, 90], [15, 16, -50], [500, 500, 0]])
    with_noise = rasterize_terrain(np.vstack([xyz, stray]), np.append(classes, [18, 7, 7]), cell_size=1.0)
    for surface, expected in zip(with_noise, rasterize_terrain(xyz, classes, cell_size=1.0)):
        np.testing.assert_array_equal(surface.values, expected.values)


def test_round_numbers_are_the_nearest_in_proportion():
    """The widest step is that from 2 to 5: in proportion, no size is farther than half of it from a round one."""
    sizes = np.geomspace(0.04, 900, 200)
    rounded = np.array([round_cell_size(size) for size in sizes])
    assert (np.diff(rounded) >= 0).all()
    assert np.abs(np.log(rounded / sizes)).max() <= np.log(2.5) / 2 + 1e-9
    assert {f"{size:.0e}"[0] for size in rounded} == {"1", "2", "5"}
    assert (round_cell_size(1e-6), round_cell_size(1e6)) == (0.05, 1000)


@pytest.mark.parametrize(("density", "cell"), [(16, 0.5), (12, 0.5), (4.5, 1.0), (1.2, 2.0)])
def test_automatic_cells_hold_about_four_points_and_are_round(rng, density, cell):
    xyz, classes = slope_with_house(rng, density=density)
    monitor = Monitor()
    dtm = rasterize_terrain(xyz, classes, monitor=monitor)[0]
    assert monitor.values["cell_size"] == cell
    assert monitor.values["gap_distance"] == 5 * monitor.values["cell_size"]
    assert dtm.cell_size == monitor.values["cell_size"]


def test_every_point_lies_in_the_raster_and_order_and_position_change_nothing(rng):
    xyz, classes = slope_with_house(rng)
    xyz = np.round(xyz * 1024) / 1024
    made = rasterize_terrain(xyz, classes, cell_size=0.75)
    rows, columns = made[0].values.shape
    assert made[0].west <= xyz[:, 0].min() <= xyz[:, 0].max() <= made[0].west + columns * 0.75
    assert made[0].north - rows * 0.75 <= xyz[:, 1].min() <= xyz[:, 1].max() <= made[0].north
    order = rng.permutation(len(xyz))
    for change in (
        rasterize_terrain(xyz[order], classes[order], cell_size=0.75),
        rasterize_terrain(xyz + [0.75 * 2.0**19, 0.75 * 2.0**22, 0], classes, cell_size=0.75),
    ):
        for surface, expected in zip(change, made):
            np.testing.assert_allclose(surface.values, expected.values, atol=1e-4)


def test_cells_lie_at_multiples_of_their_size_so_that_neighbors_have_no_seam(rng):
    xyz, classes = slope_with_house(rng)
    whole = rasterize_terrain(xyz, classes, cell_size=0.3, gap_distance=0.0)
    west, east = xyz[:, 0] < 17, xyz[:, 0] > 13
    for part in (west, east):
        for one, other in zip(rasterize_terrain(xyz[part], classes[part], cell_size=0.3, gap_distance=0.0), whole):
            row, column = round((other.north - one.north) / 0.3), round((one.west - other.west) / 0.3)
            assert one.west == pytest.approx(other.west + 0.3 * column, abs=1e-9)
            assert one.north == pytest.approx(other.north - 0.3 * row, abs=1e-9)
            rows, columns = one.values.shape
            overlap = other.values[row : row + rows, column : column + columns]
            # Away from the cut both have the same triangles and the same highest points.
            inside = slice(0, 35) if part is west else slice(columns - 35, columns)
            np.testing.assert_allclose(one.values[:, inside], overlap[:, inside], atol=1e-5)


def test_bad_clouds_are_refused(rng):
    xyz, classes = slope_with_house(rng)
    with pytest.raises(ValueError, match="no ground points"):
        rasterize_terrain(xyz, np.ones(len(xyz)))
    with pytest.raises(ValueError, match="nearly empty in cells of .* m; .* set larger cells"):
        rasterize_terrain(np.vstack([xyz, [1e6, 1e6, 0]]), np.append(classes, 2), cell_size=0.5)


def test_one_ground_point_makes_no_terrain(rng):
    xyz, classes = slope_with_house(rng)
    classes = np.where(np.arange(len(xyz)) == 0, 2, 1)
    monitor = Monitor()
    dtm, dsm, _ = rasterize_terrain(xyz, classes, cell_size=1.0, monitor=monitor)
    assert np.isnan(dtm.values).all()
    assert np.isfinite(dsm.values).any()
    assert monitor.warnings == ["The ground points span no area: the terrain model is empty."]


def test_cancel_gets_through(rng):
    xyz, classes = slope_with_house(rng)
    with pytest.raises(Cancelled):
        rasterize_terrain(xyz, classes, monitor=Listening(stop_at=0.0))


@pytest.mark.parametrize("cell_size", [0.2, 0.3, 0.7])
def test_points_that_touch_the_last_cell_are_in_a_cell(cell_size):
    """A tenth of a micrometer below the side of a cell counts as on it, whichever origin coordinates have."""
    for last in range(40, 400, 7):
        side = last * cell_size - 1e-7
        xyz = np.array([[side - 5, side - 5, 1.0], [side, side - 5, 2], [side - 5, side, 3], [side, side, 4]])
        dsm = rasterize_terrain(np.tile(xyz, (100, 1)), np.full(400, 2), cell_size=cell_size)[1]
        assert dsm.values[0, -1] == 4
