"""Parts of a building next to its roof surfaces, in scenes where each point's part is known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.complete_buildings import complete_buildings
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.sampling.density import point_density
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.surfaces import box, mound, seen_from_above

SIDE = 40.0


class Scene:
    """A field with roofs that the stages before have found; points that are added are not classified yet."""

    def __init__(self, rng, density=10):
        self.rng = rng
        plan = rng.uniform(0, SIDE, (int(SIDE**2 * density), 2))
        self.xyz = np.column_stack([plan, np.zeros(len(plan))])
        self.classification = np.full(len(plan), 2, np.uint8)

    def roof(self, west, south, east, north, elevation):
        """Lift the field to a roof that the stages before have found, and return its mask."""
        inside = self.within(west, south, east, north)
        self.xyz[inside, 2] = elevation(self.xyz[inside, 0]) if callable(elevation) else elevation
        self.classification[inside] = 6
        return inside

    def within(self, west, south, east, north):
        return ((self.xyz[:, :2] >= [west, south]) & (self.xyz[:, :2] <= [east, north])).all(axis=1)

    def remove(self, mask):
        self.xyz, self.classification = self.xyz[~mask], self.classification[~mask]

    def add(self, xyz, classification=1):
        """Add points and return their indices."""
        xyz = np.atleast_2d(np.asarray(xyz, float))
        self.xyz = np.concatenate([self.xyz, xyz])
        self.classification = np.append(self.classification, np.full(len(xyz), classification, np.uint8))
        return np.arange(len(self.xyz) - len(xyz), len(self.xyz))

    def box(self, low, high, count, classification=1):
        return self.add(self.rng.uniform(low, high, (count, 3)), classification)

    def complete(self, **tunables):
        return complete_buildings(self.xyz, self.classification, self.xyz[:, 2].astype(np.float32), **tunables)[:2]


@pytest.fixture
def scene(rng):
    return Scene(rng)


def gable(x):
    return 8 - 0.7 * np.abs(x - 15)


def test_a_house_gets_its_chimney_walls_and_objects_on_it(scene):
    scene.roof(10, 10, 20, 22, gable)
    chimney = scene.box([16, 15, 7.2], [16.6, 15.6, 7.7], 8)
    walls = np.concatenate([scene.box([10, 10, 0.6], [10.2, 22, 4], 60), scene.box([10, 21.8, 0.6], [20, 22, 4], 60)])
    inside = scene.box([12, 12, 1], [18, 20, 4], 30)
    found, number = scene.complete()
    for part in (chimney, walls, inside):
        assert (found[part] == 6).all()
        assert (number[part] == 1).all()
    assert found.dtype == np.uint8
    assert number.dtype == np.int32


def test_roofs_stay_and_the_field_stays(scene):
    roof = scene.roof(10, 10, 20, 22, gable)
    found, number = scene.complete()
    np.testing.assert_array_equal(found, scene.classification)
    np.testing.assert_array_equal(number, roof.astype(int))


def test_the_foot_of_a_wall_is_ground(scene):
    scene.roof(10, 10, 20, 20, 5.0)
    kerb, wall = scene.add([15, 15, 0.45]), scene.add([15, 15, 0.55])
    found, _ = scene.complete()
    assert (found[kerb], found[wall]) == (1, 6)


@pytest.mark.parametrize(("clearance", "expected"), [(1.0, False), (3.0, True)])
def test_a_crown_that_spreads_over_the_roof_is_left_out_by_its_clearance(scene, clearance, expected):
    scene.roof(10, 10, 20, 20, 5.0)
    crown = scene.box([10.1, 10.1, 6.5], [19.9, 19.9, 7.9], 3000)
    found, number = scene.complete(roof_clearance=clearance)
    assert (found[crown] == 6).mean() == expected
    assert (number[crown] > 0).mean() == expected


@pytest.mark.parametrize(("above", "expected"), [(0.8, True), (3.5, True), (6.0, False)])
def test_a_mast_belongs_to_the_roof_up_to_the_height_of_structures(scene, above, expected):
    scene.roof(10, 10, 20, 20, 5.0)
    mast = scene.add([15, 15, 5 + above])
    assert (scene.complete()[0][mast] == 6).all() == expected


def test_walls_just_outside_the_roof_belong_to_it_and_bushes_at_their_foot_do_not(scene):
    roof = scene.roof(10, 10, 20, 20, 5.0)
    # The cells of the outermost roof points end at most half a meter outside them.
    outside = scene.xyz[roof, 0].min() - 0.25
    wall = scene.box([outside, 12, 2.5], [outside + 0.05, 18, 4.8], 30)
    bush = scene.box([outside - 0.6, 12, 0.6], [outside - 0.5, 18, 1.2], 30)
    tree = scene.box([outside - 1.6, 12, 2.5], [outside - 1.4, 18, 4.8], 30)
    found, _ = scene.complete()
    assert (found[wall] == 6).all()
    assert (found[bush] == 1).all()
    assert (found[tree] == 1).all()


def test_the_wall_between_a_roof_and_a_higher_one_belongs_to_the_building(scene):
    scene.roof(10, 10, 20, 20, 4.0)
    tower = scene.roof(20, 10, 26, 20, 15.0)
    west, south = scene.xyz[tower, :2].min(axis=0)
    above_the_roof = scene.box([west - 0.4, 12, 6], [west - 0.2, 18, 14], 200)
    above_the_field = scene.box([19, south - 0.2, 6], [19.6, south - 0.1, 14], 20)
    too_high = scene.box([west - 1, 12, 15.1], [west - 0.8, 18, 17], 20)
    too_far = scene.box([west - 3, 12, 9], [west - 2, 18, 14], 20)
    found, number = scene.complete()
    for wall in (above_the_roof, above_the_field):
        assert (found[wall] == 6).all()
        assert (number[wall] == 1).all()
    assert (found[too_high] == 1).all()
    assert (found[too_far] == 1).all()


@pytest.mark.parametrize(
    ("eaves", "wall_from", "bush_to"), [pytest.param(15.0, 2.6, 2.4, id="tower"), pytest.param(4.0, 1.4, 1.2, id="low")]
)
def test_bushes_at_a_wall_are_low_and_no_higher_at_a_tower(scene, eaves, wall_from, bush_to):
    """At low houses up to a third of the eaves, at higher ones 2.5 m: higher points are wall."""
    roof = scene.roof(10, 10, 20, 20, eaves)
    outside = scene.xyz[roof, 0].min() - 0.25
    wall = scene.box([outside, 12, wall_from], [outside + 0.05, 18, wall_from + 1.0], 30)
    bush = scene.box([outside - 0.35, 12, 0.6], [outside - 0.25, 18, bush_to], 30)
    found, _ = scene.complete()
    assert (found[wall] == 6).all()
    assert (found[bush] == 1).all()


def test_a_tree_beside_the_house_is_left_out(scene):
    scene.roof(10, 10, 20, 20, 5.0)
    crown = scene.box([21.5, 12, 2], [25, 18, 5], 200)
    assert not (scene.complete()[0][crown] == 6).any()


@pytest.mark.parametrize(("first", "crown_is_wall"), [(1, False), (3, True), (None, True)])
def test_a_crown_that_touches_the_wall_is_distinguished_from_it_by_the_pulses_that_pass(scene, first, crown_is_wall):
    """Those on the other wall's balcony pass as well, but that is too narrow for a crown."""
    roof = scene.roof(10, 10, 20, 20, 5.0)
    west, east = scene.xyz[roof, 0].min(), scene.xyz[roof, 0].max()
    balcony = scene.box([east + 0.2, 12, 2.5], [east + 0.8, 18, 4.8], 200)
    crown = scene.box([west - 4, 12, 2.5], [west - 0.2, 18, 4.8], 500)
    wall, at_the_wall = balcony[scene.xyz[balcony, 0] < east + 0.25], crown[scene.xyz[crown, 0] > west - 0.25]
    returns = np.ones((2, len(scene.xyz)), np.uint8)
    returns[1, balcony] = 3
    returns[:, crown] = [[first or 1], [3]]
    arrays = {"return_number": returns[0], "number_of_returns": returns[1]} if first else {}
    found, _ = scene.complete(**arrays)
    assert (found[wall] == 6).all()
    assert (found[at_the_wall] == 6).all() == crown_is_wall
    assert (found[at_the_wall] == 6).mean() < 0.2 or crown_is_wall
    assert (found[crown[scene.xyz[crown, 0] < west - 1.1]] == 1).all()


def test_a_narrow_alley_in_which_the_ground_shows_is_not_closed(scene):
    """Two row houses a meter apart: points above the alley are no building."""
    scene.roof(5, 10, 14.5, 20, 6.0)
    scene.roof(15.5, 10, 25, 20, 6.0)
    alley = np.flatnonzero(scene.within(14.6, 11, 15.4, 19))
    cable = scene.add(scene.xyz[alley] + [0, 0, 6.5])
    found, _ = scene.complete()
    assert (found[alley] == 2).all()
    assert (found[cable] == 6).mean() < 0.25  # cells at the walls hold roof too


def test_a_few_points_far_apart_do_not_widen_the_gap_without_end():
    monitor = Monitor()
    xyz = np.array([[0, 0, 5], [300, 0, 5], [0, 300, 5]], float)
    complete_buildings(xyz, np.full(3, 6, np.uint8), np.full(3, 5, np.float32), monitor=monitor)
    assert monitor.values["gap"] == 20


def test_houses_farther_apart_than_the_gap_stay_two(scene):
    scene.roof(5, 10, 13, 20, 6.0)
    scene.roof(16, 10, 25, 20, 6.0)
    assert scene.complete()[1].max() == 2


def test_the_same_alley_without_ground_is_a_gutter_and_is_closed(scene):
    scene.roof(5, 10, 14.5, 20, 6.0)
    scene.roof(15.5, 10, 25, 20, 6.0)
    scene.remove(scene.within(14.4, 9, 15.6, 21) & (scene.xyz[:, 2] == 0))
    gutter = scene.box([14.6, 11, 5.2], [15.4, 19, 5.6], 20)
    found, number = scene.complete()
    assert (found[gutter] == 6).all()
    assert number.max() == 1
    assert scene.complete(gap=0.0)[1].max() == 2


@pytest.mark.parametrize("noise", [None, -6.0, 1.0, 60.0])
def test_a_skylight_is_closed_also_when_multipath_shows_in_it(scene, noise):
    """Noise points, which have class 7 or 18, are no ground that shows."""
    scene.roof(10, 10, 22, 22, 6.0)
    scene.remove(scene.within(15.5, 15.5, 16.5, 16.5))
    frame = scene.box([15.6, 15.6, 5.9], [16.4, 16.4, 6.2], 6)
    if noise is not None:
        x, y = np.meshgrid([15.7, 16.0, 16.3], [15.7, 16.0, 16.3])
        scene.add(np.column_stack([x.ravel(), y.ravel(), np.full(9, noise)]), 7 if noise < 6 else 18)
    found, number = scene.complete()
    assert (found[frame] == 6).all()
    assert number.max() == 1


def test_a_courtyard_stays_open(scene):
    scene.roof(5, 5, 35, 35, 9.0)
    yard = scene.within(14, 14, 26, 26)
    scene.xyz[yard, 2], scene.classification[yard] = 0.0, 2
    tree = scene.box([18, 18, 2], [22, 22, 7], 100)
    found, number = scene.complete()
    assert not (found[np.flatnonzero(yard)] == 6).any()
    assert not (found[tree] == 6).any()
    assert number.max() == 1


def test_a_courtyard_without_points_stays_open_too(scene):
    """A pond returns nothing; a crown over it is still no building."""
    scene.roof(5, 5, 35, 35, 9.0)
    scene.remove(scene.within(14, 14, 26, 26))
    tree = scene.box([18, 18, 2], [22, 22, 7], 100)
    assert not (scene.complete()[0][tree] == 6).any()


def test_small_buildings_are_dropped(scene):
    large, small = scene.roof(5, 5, 15, 15, 5.0), scene.roof(25, 25, 27, 27, 3.0)
    found, number = scene.complete(min_area=12)
    assert (found[large] == 6).all()
    assert (found[small] == 1).all()
    assert (number[small] == 0).all()
    assert (scene.complete(min_area=2)[0][small] == 6).all()


def test_roofs_that_touch_are_one_building_and_others_are_numbered_from_the_south_west(scene):
    parts = [scene.roof(2, 2, 10, 8, 4), scene.roof(20, 2, 28, 8, 4), scene.roof(28, 2, 34, 8, 7)]
    north = scene.roof(2, 30, 10, 36, 4)
    number = scene.complete()[1]
    for part, expected in zip([*parts, north], [1, 2, 2, 3]):
        assert (number[part] == expected).all()


def test_noise_on_the_roof_keeps_its_class_and_has_no_building(scene):
    scene.roof(10, 10, 20, 20, 5.0)
    noise = np.append(scene.box([12, 12, 5.1], [18, 18, 5.5], 5, 18), scene.box([12, 12, 1], [18, 18, 3], 5, 7))
    found, number = scene.complete()
    assert found[noise].tolist() == [18] * 5 + [7] * 5
    assert not number[noise].any()


def test_no_roof_gives_no_building(scene):
    found, number = scene.complete()
    np.testing.assert_array_equal(found, scene.classification)
    assert not number.any()
    assert number.dtype == np.int32


@pytest.mark.parametrize("count", [1, 2])
def test_a_few_roof_points_are_no_building(count):
    xyz = np.column_stack([np.arange(count + 1.0), np.zeros(count + 1), np.full(count + 1, 5.0)])
    classification = [6] * count + [1]
    found, number, *_ = complete_buildings(xyz, classification, xyz[:, 2], density=4.0)
    assert found.tolist() == [1] * (count + 1)
    assert not number.any()


def test_all_roof(rng):
    xyz = np.column_stack([rng.uniform(0, 20, (2000, 2)), np.full(2000, 5.0)])
    found, number, *_ = complete_buildings(xyz, np.full(2000, 6), xyz[:, 2])
    assert (found == 6).all()
    assert (number == 1).all()


@pytest.mark.parametrize(("density", "least"), [(2, 0.7), (25, 1.0)])
def test_any_density(rng, density, least):
    scene = Scene(rng, density)
    roof = scene.roof(8, 8, 24, 20, gable)
    walls = scene.box([8.05, 8, 0.6], [8.2, 20, 3], 20)
    found, number = scene.complete()
    # Next to the outermost roof points of a thin cloud a cell may hold none.
    assert (found[walls] == 6).mean() >= least
    assert (found[np.flatnonzero(roof)] == 6).all()
    assert number.max() == 1
    assert (found[~np.isin(np.arange(len(found)), walls) & (scene.xyz[:, 2] == 0)] == 2).all()


def test_order_and_position_change_nothing(scene, rng):
    scene.roof(10, 10, 20, 22, gable)
    scene.roof(25, 5, 36, 14, 4.0)
    scene.box([10, 10, 0.6], [12, 22, 4], 60)
    scene.xyz = scene.xyz.round(3)
    found, number = scene.complete()
    order = rng.permutation(len(scene.xyz))
    shuffled = complete_buildings(scene.xyz[order], scene.classification[order], scene.xyz[order, 2])
    moved = complete_buildings((scene.xyz + FAR).round(3), scene.classification, scene.xyz[:, 2])
    np.testing.assert_array_equal(shuffled[0], found[order])
    np.testing.assert_array_equal(shuffled[1], number[order])
    # Cells start at the least coordinates, where rounding may take a point to the cell beside.
    assert (moved[0] == found).mean() > 0.999
    assert (moved[1] == number).mean() > 0.999


def test_twice_is_once(scene):
    scene.roof(10, 10, 20, 22, gable)
    scene.box([10, 10, 0.6], [10.2, 22, 4], 60)
    found, number = scene.complete()
    scene.classification = found
    again = scene.complete()
    assert (again[0] != found).sum() == 0
    np.testing.assert_array_equal(again[1], number)


def test_density_is_reported(scene):
    monitor = Monitor()
    scene.complete(monitor=monitor)
    assert monitor.values["density"] == pytest.approx(10, rel=0.05)


def test_gaps_between_scan_lines_are_no_gaps_of_the_cloud(scene):
    """On lines 2 m apart points are dense where they lie, and scales of the roofs must cross the gaps all the same."""
    scene.xyz[:, 1] = 2 * np.round(scene.xyz[:, 1] / 2)
    monitor = Monitor()
    scene.complete(monitor=monitor)
    assert monitor.values["density"] < 0.6 * point_density(scene.xyz)


def test_a_point_far_off_is_refused_instead_of_filling_memory(rng):
    xyz = np.vstack([rng.uniform(0, 20, (500, 3)), [[300_000.0, 300_000.0, 5.0]]])
    with pytest.raises(ValueError, match="which is nearly empty in cells of .* m; remove points that lie far off"):
        complete_buildings(xyz, np.full(501, 6, np.uint8), np.full(501, 5.0, np.float32))


# --- reasons ---------------------------------------------------------------------------------------------------------


def explained(scene, confidence=0.9, **tunables):
    """Return classes, numbers, confidence and reasons of a scene whose roofs were called building with confidence."""
    sure = np.where(scene.classification == 6, confidence, 0.1).astype(np.float32)
    said = np.where(scene.classification == 6, Reason.SOLID_PLANE, Reason.ROUGH).astype(np.uint8)
    height = scene.xyz[:, 2].astype(np.float32)
    return complete_buildings(scene.xyz, scene.classification, height, sure, said, **tunables)


def test_what_is_added_has_a_reason_and_the_confidence_of_its_roofs(scene):
    roof = scene.roof(10, 10, 20, 22, gable)
    chimney = scene.box([16, 15, 7.2], [16.6, 15.6, 7.7], 8)
    tree = scene.box([2, 2, 2], [5, 5, 7], 80)
    _, number, confidence, reason = explained(scene)
    assert (reason[chimney] == Reason.ATTACHED).all()
    assert confidence[chimney] == pytest.approx(0.9)
    assert (reason[: len(roof)][roof] == Reason.SOLID_PLANE).all()
    assert (reason[tree] == Reason.ROUGH).all()
    assert confidence[tree] == pytest.approx(0.1)
    assert confidence.dtype == np.float32
    assert reason.dtype == np.uint8
    assert (number[tree] == 0).all()


def test_confidence_of_what_is_added_is_the_mean_of_its_own_roofs(scene):
    one, other = scene.roof(5, 5, 12, 12, 5.0), scene.roof(25, 25, 35, 35, 8.0)
    walls = scene.box([5, 5, 1], [12, 12, 4], 20), scene.box([25, 25, 1], [35, 35, 6], 20)
    sure = np.full(len(scene.xyz), np.nan, np.float32)
    sure[: len(one)][one], sure[: len(other)][other] = 0.6, 0.8
    said = np.full(len(sure), Reason.SOLID_PLANE, np.uint8)
    confidence = complete_buildings(scene.xyz, scene.classification, scene.xyz[:, 2], sure, said)[2]
    assert confidence[walls[0]] == pytest.approx(0.6)
    assert confidence[walls[1]] == pytest.approx(0.8)


def test_what_is_no_building_after_all_is_reported_why(scene):
    small = scene.roof(5, 5, 6.5, 6.5, 4.0)
    low = scene.roof(30, 30, 38, 38, 5.0) & scene.within(33, 33, 34, 34)
    scene.xyz[low, 2] = 0.2
    found, _, confidence, reason = explained(scene)
    for part, expected in ((small, Reason.TOO_SMALL), (low, Reason.TOO_LOW)):
        assert (found[part] == 1).all()
        assert (reason[part] == expected).all()
        assert (confidence[part] == 0.5).all()


def test_nothing_is_made_of_what_is_not_given(scene):
    scene.roof(10, 10, 20, 22, gable)
    assert complete_buildings(scene.xyz, scene.classification, scene.xyz[:, 2])[2:] == (None, None)


@pytest.mark.parametrize(("high", "kept"), [(5, True), (40, False)])
def test_what_is_mostly_no_roof_surface_is_no_building(scene, high, kept):
    """A smooth spot of 36 m² in a crown: with few leaves around it a shed, with many a tree."""
    spot = scene.roof(10, 10, 16, 16, 5.0)
    scene.box([10, 10, 5.2], [16, 16, 9], high * 36)
    segment_id = np.append(spot.astype(np.int32), np.zeros(high * 36, np.int32))
    height = scene.xyz[:, 2].astype(np.float32)
    said = np.full(len(height), Reason.SOLID_PLANE, np.uint8)
    given = (scene.xyz, scene.classification, height, None, said, segment_id)
    classification, cluster_id, _, reason = complete_buildings(*given)
    assert (classification[: len(spot)][spot] == 6).all() == kept
    assert cluster_id.any() == kept
    assert (reason[: len(spot)][spot] == (Reason.SOLID_PLANE if kept else Reason.MOSTLY_OTHER)).all()
    assert complete_buildings(*given, min_roof_share=0.0)[1].any()
    assert complete_buildings(scene.xyz, scene.classification, height)[1].any()


@pytest.mark.parametrize(("low", "high"), [(6.3, 12.0), (0.6, 3.7)])
def test_leaves_above_a_roof_and_walls_below_don_t_count_as_its_share(scene, low, high):
    """A shed of 36 m² at 5 m, and ten times as many points a good meter above it, or below."""
    spot = scene.roof(10, 10, 16, 16, 5.0)
    count = 10 * int(spot.sum())
    scene.box([10, 10, low], [16, 16, high], count)
    segment_id = np.append(spot.astype(np.int32), np.zeros(count, np.int32))
    height = scene.xyz[:, 2].astype(np.float32)
    classification = complete_buildings(scene.xyz, scene.classification, height, None, None, segment_id)[0]
    assert (classification[: len(spot)][spot] == 6).all()


def complete_images(xyz, part, found, **tunables):
    """Complete the parts that the stages before have found in a cloud of matched images; each part is a surface."""
    segment = np.where(found, part, 0).astype(np.int32)
    classification = np.where(found, 6, 1).astype(np.uint8)
    arrays = xyz, classification, xyz[:, 2].astype(np.float32), None, np.zeros(len(xyz), np.uint8), segment
    made = complete_buildings(*arrays, source="matched images", **tunables)
    return made[0] == 6, made[3]


def test_in_images_walls_go_down_to_their_feet_and_the_bush_beside_them_stays(rng):
    xyz, part = seen_from_above(rng, box(8, 8, 18, 16, 5.0, smeared=0.4), mound((20.0, 12.0), 2.0, 1.5))
    building, _ = complete_images(xyz, part, (part == 1) & (xyz[:, 2] > 4.9))
    assert building[(part == 1) & (xyz[:, 2] > 0.5)].mean() > 0.98
    assert not building[(part == 2) & (xyz[:, 0] > 19.2)].any()
    assert not building[part == 0].any()


@pytest.mark.parametrize(("gap", "closed"), [(1.0, False), (4.0, True)])
def test_the_gap_to_close_holds_in_images(rng, gap, closed):
    xyz, part = seen_from_above(rng, box(5, 5, 25, 20, 5.0))
    in_gap = np.abs(xyz[:, 0] - 15) < 1.5
    building, _ = complete_images(xyz, part, (part == 1) & ~in_gap, gap=gap)
    middle = (np.abs(xyz[:, 0] - 15) < 0.3) & (np.abs(xyz[:, 1] - 12) < 5)
    assert building[middle].all() == closed


def test_a_bridge_deck_beside_a_roof_stays_deck_in_images(rng):
    """A walkway at half the height of a house begins in its smeared wall."""
    xyz, part = seen_from_above(rng, box(8, 8, 18, 16, 5.0, smeared=0.4), box(17.5, 11, 24, 14, 2.5))
    classification = np.where((part == 1) & (xyz[:, 2] > 4.9), 6, np.where(part == 2, 17, 1)).astype(np.uint8)
    height = xyz[:, 2].astype(np.float32)
    result, cluster, *_ = complete_buildings(xyz, classification, height, source="matched images")
    assert (result[(part == 1) & (xyz[:, 2] > 4.9)] == 6).all()
    assert (result[part == 2] == 17).all()
    assert not cluster[part == 2].any()
