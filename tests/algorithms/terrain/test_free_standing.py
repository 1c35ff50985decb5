"""Free-standing segments are separated from terrain by their edges alone, on surfaces whose every cell is known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.terrain.free_standing import find_free_standing

USUAL = 60.0


def slope(rows, columns, rise=0.0):
    """Return a surface that rises by a slope along its rows of cells of 1 m."""
    return np.repeat(rise * np.arange(rows, dtype=float)[:, None], columns, axis=1)


def block(surface, rows, columns, height):
    """Return which cells a block covers, after it was put on the surface: level, ``height`` over its lowest cell."""
    here = np.zeros(surface.shape, bool)
    here[rows, columns] = True
    surface[here] = surface[here].min() + height
    return here


@pytest.mark.parametrize("rise", [0.0, 0.1, 0.5])
@pytest.mark.parametrize(("side", "height"), [(8, 7.0), (30, 20.0)])
def test_a_house_is_free_standing_on_any_slope(rise, side, height):
    surface = slope(80, 80, rise)
    house = block(surface, slice(20, 20 + side), slice(20, 20 + side), height + rise * side)
    found, size = find_free_standing(surface, 1.0, USUAL)
    np.testing.assert_array_equal(found, house)
    assert size == side


@pytest.mark.parametrize("cell_size", [0.5, 1.0, 2.0])
def test_a_hall_may_be_larger_than_any_window(cell_size):
    surface = slope(300, 280)
    hall = block(surface, slice(20, 270), slice(30, 260), 7.0)
    found, size = find_free_standing(surface, cell_size, USUAL)
    np.testing.assert_array_equal(found, hall)
    assert size == 230 * cell_size
    assert not find_free_standing(surface, cell_size, USUAL, largest=USUAL)[0].any()


@pytest.mark.parametrize(
    ("width", "height", "is_object"),
    [(50, 0.8, False), (50, 1.2, True), (50, 1.5, True), (70, 1.5, False), (70, 1.9, False), (70, 2.1, True)],
)
def test_what_is_wider_than_usual_needs_walls_higher_than_quays(width, height, is_object):
    surface = slope(120, 120)
    block(surface, slice(10, 110), slice(10, 10 + width), height)
    assert find_free_standing(surface, 1.0, USUAL)[0].any() == is_object


@pytest.mark.parametrize(
    ("rise", "uphill", "low_uphill", "is_object"),
    [
        (0.05, 1.4, False, False),
        (0.05, 1.4, True, True),
        (0.02, 1.4, True, True),
        (0.05, 0.8, True, False),
        (0.0, 1.9, True, False),
        (0.0, 2.1, True, True),
    ],
)
def test_a_hall_on_a_slope_may_have_a_low_eave_uphill(rise, uphill, low_uphill, is_object):
    """Its walls downhill are high; walls of a quay are low all round."""
    surface = slope(120, 120, rise)
    hall = block(surface, slice(20, 90), slice(20, 90), 69 * rise + uphill + rise)
    found = find_free_standing(surface, 1.0, USUAL, low_uphill=low_uphill)[0]
    np.testing.assert_array_equal(found, hall & is_object)


@pytest.mark.parametrize(("height", "is_object"), [(4.0, True), (2.0, False)])
def test_steps_are_as_wide_as_points_are_apart(height, is_object):
    """Between points 2.4 m apart a heap of soil of 40° rises by 2 m at once, as it seems on cells of half of that."""
    surface = slope(60, 60)
    thing = block(surface, slice(20, 40), slice(20, 40), height)
    assert find_free_standing(surface, 1.2, USUAL)[0][thing].all()
    assert find_free_standing(surface, 1.2, USUAL, apart=2.4)[0][thing].all() == is_object


@pytest.mark.parametrize(("height", "is_object"), [(0.9, False), (1.1, True)])
def test_a_step_is_a_meter_high_however_small_the_cells(height, is_object):
    surface = slope(60, 60)
    block(surface, slice(20, 40), slice(20, 40), height)
    assert find_free_standing(surface, 0.5, USUAL)[0].any() == is_object


@pytest.mark.parametrize(("rise", "is_object"), [(1.8, False), (2.2, True)])
def test_a_hill_whose_flanks_soil_can_lie_on_has_no_walls(rise, is_object):
    """On cells of 2 m a flank of 42° rises 1.8 m from one cell to the next, one of 48° 2.2 m."""
    rows, columns = np.mgrid[:60, :60]
    hill = rise * np.clip(18.5 - np.maximum(np.abs(rows - 29.5), np.abs(columns - 29.5)), 0, 4)
    assert find_free_standing(hill, 2.0, USUAL)[0].any() == is_object


@pytest.mark.parametrize(("side", "is_object"), [(3, False), (4, True)])
def test_what_has_fewer_than_four_cells_off_its_edge_is_too_rough_to_tell(side, is_object):
    surface = slope(40, 40)
    thing = block(surface, slice(10, 10 + side), slice(20, 20 + side), 5.0)
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], thing & is_object)


@pytest.mark.parametrize(("length", "is_object"), [(4, True), (12, False)])
def test_what_the_terrain_is_above_on_more_than_a_tenth_of_the_edge_is_a_terrace(length, is_object):
    surface = slope(80, 80)
    house = block(surface, slice(30, 50), slice(30, 50), 3.5)
    surface[24:30, 30 : 30 + length] = 5.6  # a bank up to the wall
    surface[:24] = 5.6
    assert find_free_standing(surface, 1.0, USUAL)[0][house].all() == is_object


@pytest.mark.parametrize(("seen", "is_object"), [(5, True), (3, False)])
def test_two_fifths_of_the_edge_must_be_seen(seen, is_object):
    """A house of 12 m by 12 m between towers on two sides, and in front of parts of the others."""
    surface = slope(80, 80)
    house = block(surface, slice(30, 42), slice(30, 42), 4.0)
    for rows, columns in ((slice(20, 52), slice(42, 54)), (slice(20, 52), slice(18, 30))):
        block(surface, rows, columns, 20.0)
    surface[22:30, 30 + 2 * seen : 42] = surface[42:50, 30 + 2 * seen : 42] = 20.0
    assert find_free_standing(surface, 1.0, USUAL)[0][house].all() == is_object


@pytest.mark.parametrize(
    ("rows", "height", "is_object"), [(60, 1.9, False), (60, 2.1, True), (30, 3.3, False), (30, 3.5, True)]
)
def test_a_part_of_the_edge_may_lie_where_the_cloud_ends(rows, height, is_object):
    """A building of 25 m that crosses a cloud as long as that, if it is no causeway."""
    for turned in (np.asarray, np.transpose):
        surface = slope(rows, 80)
        crossing = block(surface, slice(None), slice(30, 55), height)
        np.testing.assert_array_equal(find_free_standing(turned(surface), 1.0, USUAL)[0], turned(crossing & is_object))


@pytest.mark.parametrize(("low", "high"), [(0.0, 4.0), (12.0, 30.0)])
def test_a_house_among_plants_is_free_standing_and_they_are_not(low, high, rng):
    """Shrubs all around, or trees along one side: too rough to decide whether they are lower or higher."""
    surface = slope(80, 80)
    plants = np.zeros(surface.shape, bool)
    plants[25:59, 25 : 59 if high < 8 else 34] = True
    surface[plants] = rng.uniform(low, high, plants.sum())
    house = np.zeros(surface.shape, bool)
    house[34:50, 34:50] = True
    surface[house] = 8.0
    found = find_free_standing(surface, 1.0, USUAL)[0]
    assert found[house].all()
    assert not found[plants & ~house].any()


@pytest.mark.parametrize(("height", "length"), [(8.0, 8), (3.5, 20)])
def test_machines_on_a_roof_make_no_terrain_of_it(height, length):
    """Also of one that is no higher than a quay, if they cover less than a tenth."""
    surface = slope(120, 120)
    hall = block(surface, slice(10, 110), slice(10, 110), height)
    for row in range(20, 100, 20):
        block(surface, slice(row, row + 8), slice(40, 40 + length), 2.0)
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], hall)


@pytest.mark.parametrize("height", [3.0, 6.0])
def test_a_house_with_a_penthouse_is_no_terrain(height):
    """Islands are wide: narrow ones may hold any object."""
    surface = slope(60, 60)
    house = block(surface, slice(20, 40), slice(20, 40), height)
    block(surface, slice(24, 36), slice(24, 36), 3.0)
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], house)


def test_houses_that_are_by_themselves_are_no_parts_of_a_hall():
    """Two of 25 m by 50 m side by side, with a step of 1.5 m between, where halls of more than 30 m are ruled out."""
    surface = slope(100, 100)
    houses = block(surface, slice(20, 70), slice(20, 70), 6.0)
    surface[20:70, 45:70] += 1.5
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, 30.0, largest=30.0)[0], houses)


def cut_across(surface, row, columns, rng):
    """Put a row of machines with gaps between them across a surface, too narrow to be anything but rough."""
    for column in range(columns.start, columns.stop, 4):
        surface[row : row + 3, column : column + 2] += rng.uniform(1.5, 4.0, (3, 2))


def test_machines_right_across_a_roof_make_no_terrain_of_its_halves(rng):
    """Each half goes on into the other without a step: both are free-standing, or neither, with the machines."""
    surface = slope(120, 120)
    hall = block(surface, slice(20, 100), slice(20, 90), 9.0)
    cut_across(surface, 58, slice(20, 90), rng)
    found, size = find_free_standing(surface, 1.0, USUAL)
    np.testing.assert_array_equal(found, hall)
    assert size == 70


def test_a_hall_and_a_wing_hardly_lower_are_one():
    """The step between them is not a hall's, and the wing's own edge is half at the hall."""
    surface = slope(140, 140)
    hall = block(surface, slice(20, 100), slice(20, 90), 6.5)
    wing = block(surface, slice(40, 80), slice(90, 102), 5.2)
    found, size = find_free_standing(surface, 1.0, USUAL)
    np.testing.assert_array_equal(found, hall | wing)
    assert size == 80


def test_plants_in_the_courtyard_of_a_hall_do_not_rest_on_it(rng):
    surface = slope(140, 140)
    hall = block(surface, slice(20, 100), slice(20, 90), 6.5)
    hall[50:58, 50:58] = False
    surface[50:58, 50:58] = rng.uniform(0, 4, (8, 8))
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], hall)


def test_machines_on_smaller_roofs_are_left_to_the_windows(rng):
    surface = slope(80, 80)
    house = block(surface, slice(20, 50), slice(20, 50), 6.5)
    surface[30:33, 30:33] += rng.uniform(2, 5, (3, 3))
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], house & (surface == 6.5))


def test_plants_at_the_walls_of_a_hall_do_not_rest_on_it(rng):
    """Shrubs are lower than its roof, and trees higher, but on most of their edge there is lawn."""
    surface = slope(140, 140)
    shrubs, trees = np.zeros((2, *surface.shape), bool)
    shrubs[20:60, 90:98] = trees[100:110, 30:70] = True
    surface[shrubs], surface[trees] = rng.uniform(0, 5, shrubs.sum()), rng.uniform(0, 18, trees.sum())
    hall = block(surface, slice(20, 100), slice(20, 90), 6.5)
    found = find_free_standing(surface, 1.0, USUAL)[0]
    assert found[hall].all()
    assert not found[shrubs].any()
    # Leaves as high as the eaves and next to them can't be separated from the roof.
    assert not found[trees][2 * 40 :].any()


def test_a_terrace_is_no_half_of_a_roof(rng):
    """It has walls on three sides; on the fourth, behind bushes in a row, it goes on into the hillside."""
    surface = np.maximum(slope(160, 120, 0.2) - 16.0, 0.0)
    terrace = block(surface, slice(20, 100), slice(20, 90), 4.0)
    cut_across(surface, 98, slice(20, 90), rng)
    assert not find_free_standing(surface, 1.0, USUAL)[0][terrace].any()


def test_houses_in_the_angle_of_a_hall_are_not_on_it():
    surface = slope(140, 140)
    hall = np.zeros(surface.shape, bool)
    hall[10:130, 10:75] = hall[65:130, 10:130] = True
    surface[hall] = 8.0
    house = block(surface, slice(12, 57), slice(83, 128), 6.0)
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], hall | house)


def test_a_low_house_beside_a_tower_is_judged_by_the_rest_of_its_edge():
    surface = slope(60, 60)
    low = block(surface, slice(20, 32), slice(20, 32), 4.0)
    tower = block(surface, slice(32, 42), slice(18, 34), 30.0)
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], low | tower)


@pytest.mark.parametrize(("height", "is_object"), [(1.2, False), (1.9, False), (2.1, True)])
def test_what_surrounds_a_house_is_as_high_as_a_roof_or_a_terrace(height, is_object):
    """Two terraces, each lower by ``height``, below a house whose walls are high."""
    surface = slope(60, 60)
    terraces = block(surface, slice(10, 50), slice(10, 50), height)
    terraces |= block(surface, slice(16, 44), slice(16, 44), height)
    house = block(surface, slice(24, 36), slice(24, 36), 4.0)
    found = find_free_standing(surface, 1.0, USUAL)[0]
    np.testing.assert_array_equal(found, house | (terraces & is_object))


def test_terraces_and_hills_are_terrain():
    """A terrace has its step on one side, and nothing is known of the others; a hill has no step, however high."""
    terraces = np.floor(slope(90, 60) + np.arange(90)[:, None] / 30) * 4.0
    assert not find_free_standing(terraces, 1.0, USUAL)[0].any()
    x, y = np.meshgrid(np.arange(100.0), np.arange(100.0))
    assert not find_free_standing(30.0 * np.exp(-((x - 50) ** 2 + (y - 50) ** 2) / 900), 1.0, USUAL)[0].any()


def test_a_house_at_the_end_of_the_cloud_is_free_standing_on_its_other_sides():
    surface = slope(60, 60)
    house = block(surface, slice(0, 14), slice(20, 34), 1.8)
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], house)


@pytest.mark.parametrize(
    ("rows", "columns", "lowest"),
    [
        (slice(0, 10), slice(10, 50), 2.8),  # of its outline 0.4 is cut off
        (slice(40, 60), slice(40, 60), 4.0),  # a corner: half
        (slice(30, 60), slice(0, 60), np.inf),  # two thirds: it may be the terrain from which something is dug out
    ],
)
def test_the_more_of_a_building_is_cut_off_the_higher_its_walls_must_be(rows, columns, lowest):
    for height in (1.2, 1.8, 2.7, 2.9, 3.8, 4.2, 9.0):
        for turned in (np.asarray, np.transpose, np.rot90):
            surface = slope(60, 60)
            building = block(surface, rows, columns, height)
            expected = turned(building & (height > lowest))
            np.testing.assert_array_equal(find_free_standing(turned(surface), 1.0, USUAL)[0], expected)


def test_machines_on_a_hall_that_is_cut_off_hide_nothing_of_its_walls():
    surface = slope(80, 80)
    hall = block(surface, slice(20, 80), slice(20, 80), 7.0)
    for row, column in ((30, 30), (30, 50), (50, 30), (50, 50)):
        surface[row : row + 6, column : column + 6] += 3.0
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], hall)


@pytest.mark.parametrize(("apart", "is_object"), [(0.5, True), (2.0, False)])
def test_the_walls_of_what_is_cut_off_are_steeper_than_slopes(apart, is_object):
    """Between points 2 m apart a rise of 5 m may be a bank of 68°."""
    surface = slope(60, 60)
    corner = block(surface, slice(40, 60), slice(40, 60), 5.0)
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL, apart=apart)[0], corner & is_object)


@pytest.mark.parametrize(
    ("rows", "height", "is_object"),
    [(slice(40, 60), 4.2, True), (slice(40, 60), 3.8, False), (slice(20), 5.95, True), (slice(20), 5.7, False)],
)
def test_half_of_what_is_left_of_the_walls_must_be_high(rows, height, is_object):
    """At a corner of the cloud, on a slope: 4 m are 23, 0, 20 and 18 of 40 m of walls, which get lower uphill."""
    surface = slope(60, 60, 0.1)
    corner = block(surface, rows, slice(40, 60), height)
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], corner & is_object)


@pytest.mark.parametrize(("seen", "is_object"), [(13, True), (11, False)])
def test_of_what_is_cut_off_two_fifths_of_the_whole_outline_must_be_seen(seen, is_object):
    """A corner of 20 m by 20 m, on one side behind a tower."""
    surface = slope(60, 60)
    corner = block(surface, slice(40, 60), slice(40, 60), 6.0)
    surface[28:40, 40 + seen : 60] = 30.0
    assert find_free_standing(surface, 1.0, USUAL)[0][corner].all() == is_object


def test_a_square_open_to_the_end_of_the_cloud_is_terrain():
    """Houses are on it, and on one side, which is a third of its own edge, it steps down to a canal."""
    surface = slope(60, 60)
    square = block(surface, slice(20, 60), slice(0, 60), 2.5)
    houses = np.zeros(surface.shape, bool)
    for row in (26, 44):
        for column in (6, 24, 42):
            houses |= block(surface, slice(row, row + 12), slice(column, column + 12), 7.0)
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], houses & square)


@pytest.mark.parametrize("side", [40, 80])
def test_a_courtyard_stays_terrain(side):
    surface = slope(side + 40, side + 40)
    ring = block(surface, slice(20, 20 + side), slice(20, 20 + side), 9.0)
    yard = (slice(32, 8 + side),) * 2
    surface[yard] = 0.0
    ring[yard] = False
    np.testing.assert_array_equal(find_free_standing(surface, 1.0, USUAL)[0], ring)


def test_turning_the_surface_turns_the_result(rng):
    surface = slope(60, 50, 0.05) + rng.normal(0, 0.03, (60, 50))
    block(surface, slice(10, 25), slice(12, 30), 3.0)
    found = find_free_standing(surface, 1.0, USUAL)[0]
    assert found.any()
    for turned in (np.rot90, np.flipud, np.transpose):
        np.testing.assert_array_equal(find_free_standing(turned(surface), 1.0, USUAL)[0], turned(found))


@pytest.mark.parametrize("shape", [(1, 1), (1, 40), (40, 1)])
def test_a_surface_of_one_row_or_one_cell_has_no_free_standing_segment(shape):
    """Its edge is the edge of the cloud: a step along it says nothing of the sides."""
    surface = np.zeros(shape)
    surface.ravel()[15:25] = 6.0
    found, size = find_free_standing(surface, 1.0, USUAL)
    assert found.shape == shape
    assert not found.any()
    assert size == 0.0


@pytest.mark.parametrize("seed", range(24))
def test_the_cloud_may_end_within_the_raster(seed):
    """Blocks of any size, some cut off, and rough patches on and next to them."""
    rng = np.random.default_rng(seed)
    surface = slope(80, 90, 0.05)
    for side in rng.integers(6, 60, 8):
        row, column = rng.integers(-20, 75, 2)
        rows, columns = slice(max(row, 0), max(row + side, 1)), slice(max(column, 0), max(column + side // 2, 1))
        block(surface, rows, columns, rng.uniform(1, 12))
    rough = np.kron(rng.random((8, 9)) < 0.1, np.ones((10, 10))) > 0
    surface[rough] += rng.uniform(0, 4, rough.sum())
    found, size = find_free_standing(surface, 1.0, 40.0)
    framed, framed_size = find_free_standing(np.pad(surface, (3, 9), constant_values=np.nan), 1.0, 40.0)
    np.testing.assert_array_equal(framed, np.pad(found, (3, 9)))
    assert framed_size == size
    assert found.any()
