"""Footprints of simulated houses: positions, attributes and validity."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.footprints import extract_footprints as outlining
from lidar_buildings.algorithms.footprints.extract_footprints import extract_footprints
from lidar_buildings.algorithms.footprints.roof_points import is_under_roof
from lidar_buildings.algorithms.geometry.rings import signed_area
from lidar_buildings.algorithms.packages import spatial
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import roof, turned
from lidar_buildings.tests.monitors import Listening
from lidar_buildings.tests.polygon_validity import assert_valid


@pytest.fixture
def village(rng):
    """A house with walls below its eaves, a block around a courtyard, a shed that is too small, and a field."""
    house = roof(rng, 0, 0, 10, 8, 6.0, density=10)
    wall = np.column_stack([rng.uniform(0, 10, 150), rng.uniform(-0.1, 0.1, 150), rng.uniform(0.5, 5.9, 150)])
    block = roof(rng, 30, 0, 24, 24, 9.0, density=10)
    block = block[(np.abs(block[:, :2] - [42, 12]) > 6).any(axis=1)]
    shed = roof(rng, 70, 0, 1.5, 1.5, 2.5, density=10)
    field = roof(rng, 0, 40, 60, 10, 0.0, density=2)
    parts = [house, wall, block, shed, field]
    sizes = [len(part) for part in parts]
    xyz = np.concatenate(parts)
    return {
        "xyz": xyz,
        "classification": np.repeat([6, 6, 6, 6, 2], sizes),
        "cluster_id": np.repeat([3, 3, 7, 9, 0], sizes),
        "height_above_ground": (xyz[:, 2] + 1).astype(np.float32),
        "cluster_entropy": np.repeat([0.4, 0.4, 0.5, 0.6, np.nan], sizes).astype(np.float32),
        "confidence": np.repeat([0.9, 0.9, 0.8, 0.3, np.nan], sizes).astype(np.float32),
        "reason": np.repeat([Reason.SOLID_PLANE, Reason.ATTACHED, Reason.NEXT_TO_BUILDINGS, Reason.SOLID, 0], sizes),
    }


@pytest.mark.parametrize("regularize", [True, False])
def test_village(village, regularize):
    found = extract_footprints(**village, regularize=regularize)
    for rings in found.geometries:
        assert_valid(rings)
    table = found.columns
    assert table["id"] == [1, 2]
    assert table["cluster_id"] == [3, 7]
    assert table["area"] == pytest.approx([80, 24 * 24 - 144], rel=0.08)
    assert [len(rings) for rings in found.geometries] == [1, 2]
    assert table["regularized"] == [int(regularize)] * 2
    assert table["points"] == [(village["cluster_id"] == number).sum() for number in (3, 7)]
    assert table["height"] == pytest.approx([7, 10], abs=0.02)
    assert table["max_height"] == pytest.approx([7, 10], abs=0.1)
    assert table["ground_elevation"] == pytest.approx([-1, -1], abs=1e-5)
    # Flat roofs: eaves and ridges are where the roof is, and the space is a box.
    # Points of the wall down to a meter under the eaves count as points of the eaves.
    assert table["eave_height"] == pytest.approx([7, 10], abs=0.1)
    assert table["ridge_height"] == pytest.approx([7, 10], abs=0.1)
    assert table["volume"] == pytest.approx([7 * table["area"][0], 10 * table["area"][1]], rel=0.01)
    assert table["entropy"] == pytest.approx([0.4, 0.5])
    assert table["confidence"] == pytest.approx([0.9, 0.8])
    assert table["reason"] == ["Solid plane", "Next to buildings"]
    if regularize:
        assert [len(ring) - 1 for rings in found.geometries for ring in rings] == [4, 4, 4]
        assert table["perimeter"] == pytest.approx([36, 96 + 48], rel=0.04)


def test_the_reason_is_that_of_most_roof_points(village):
    """Points added to a building give no reason for it, and codes of other programs are not taken for reasons."""
    house = np.flatnonzero(village["cluster_id"] == 3)
    village["reason"][house] = Reason.ATTACHED
    village["reason"][house[:5]], village["reason"][house[5:8]] = Reason.SOLID, Reason.PLANE
    village["reason"][village["cluster_id"] == 7] = 200
    assert extract_footprints(**village).columns["reason"] == ["Solid", ""]
    del village["reason"]
    assert extract_footprints(**village).columns["reason"] == ["", ""]


def test_the_evidence_is_that_of_most_roof_points_of_the_main_reason(village):
    """A wall added later has none, nor have roofs of another reason a say, and without reasons there is none."""
    village["weakest_evidence"] = np.zeros(len(village["xyz"]), np.uint32)
    house, block = (np.flatnonzero(village["cluster_id"] == number) for number in (3, 7))
    village["weakest_evidence"][house] = 2_0712_0780
    village["weakest_evidence"][block], village["weakest_evidence"][block[:9]] = 3_0380_0400, 1_0079_0122
    village["reason"][house[:9]], village["weakest_evidence"][house[:9]] = Reason.SOLID, 4_0450_0400
    expected = ["entropy 0.71 (limit 0.78)", "38 % of the beam passes (limit 40 %)"]
    assert extract_footprints(**village).columns["evidence"] == expected
    del village["reason"]
    assert extract_footprints(**village).columns["evidence"] == ["", ""]


def test_a_point_without_a_height_leaves_the_volume_defined(village):
    """One made the volume of its building NaN."""
    whole = extract_footprints(**village).columns["volume"]
    heights = village["height_above_ground"].copy()
    heights[np.flatnonzero(village["cluster_id"] == 7)[0]] = np.nan
    village["height_above_ground"] = heights
    assert extract_footprints(**village).columns["volume"] == pytest.approx(whole, rel=0.01)


def test_eave_ridge_and_volume_of_a_gable_roof(rng):
    """12 m by 8 m, eaves at 5 m, ridge at 8 m, with a chimney and a dormer wall that don't matter."""
    n = 12 * 8 * 12
    plan = rng.uniform([0, 0], [12, 8], (n, 2))
    xyz = np.column_stack([plan, 8 - 0.75 * np.abs(plan[:, 1] - 4) + rng.normal(0, 0.02, n)])
    xyz[(np.abs(plan - [6, 4]) < 0.3).all(axis=1), 2] += 1.5
    xyz[:, 2] += 100
    found = extract_footprints(xyz, np.full(n, 6), None, (xyz[:, 2] - 100).astype(np.float32)).columns
    assert found["eave_height"] == pytest.approx([5], abs=0.4)
    assert found["ridge_height"] == pytest.approx([8], abs=0.15)
    assert found["max_height"] == pytest.approx([9.5], abs=0.1)
    assert found["ground_elevation"] == pytest.approx([100], abs=1e-4)
    assert found["volume"] == pytest.approx([12 * 8 * 6.5], rel=0.02)


@pytest.mark.parametrize("slope", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("density", [4, 12, 40])
def test_walls_do_not_lower_the_eaves(rng, slope, density):
    """A house of 12 m by 8 m, its eaves at 5 m, with as many points per area on its two long walls as on the roof."""
    n, walls = 12 * 8 * density, 12 * 4 * density
    plan = rng.uniform([0, 0], [12, 8], (n, 2))
    house = np.column_stack([plan, 5 + slope * (4 - np.abs(plan[:, 1] - 4)) + rng.normal(0, 0.02, n)])
    side = np.where(rng.random(walls) < 0.5, 0.0, 8.0) + rng.normal(0, 0.03, walls)
    wall = np.column_stack([rng.uniform(0, 12, walls), side, rng.uniform(0.5, 5, walls)])
    xyz = np.concatenate([house, wall])
    found = extract_footprints(xyz, np.full(len(xyz), 6), None, xyz[:, 2].astype(np.float32)).columns
    assert found["eave_height"] == pytest.approx([5], abs=0.1)
    assert found["ridge_height"] == pytest.approx([5 + 4 * slope], abs=0.15)
    assert found["volume"] == pytest.approx([96 * (5 + 2 * slope)], rel=0.06)


def test_walls_do_not_widen_the_outline(village, rng):
    """Points down a wall that leans out by 20 cm count as points of the house and leave its outline alone."""
    only_roof = {name: values[:800] for name, values in village.items()}
    before = extract_footprints(**only_roof, regularize=False)
    along = rng.uniform(1, 9, 400)
    wall = np.column_stack([along, np.full(400, -0.2), rng.uniform(0.2, 4.5, 400)])
    more = {name: np.concatenate([values, values[:400]]) for name, values in only_roof.items()}
    more["xyz"] = np.concatenate([only_roof["xyz"], wall])
    after = extract_footprints(**more, regularize=False)
    assert after.columns["area"] == pytest.approx(before.columns["area"], rel=0.01)
    assert after.columns["points"] == [1200]


def test_what_was_attached_below_the_eaves_hardly_widens_the_outline(rng):
    """Bushes 30 cm from a house and 1.1 m below its eaves, where a steep roof could end, on 8 m of its wall."""
    grown = []
    for _ in range(6):
        house = roof(rng, 0, 0, 10, 8, 6.0, density=10)
        bushes = np.column_stack([rng.uniform(1, 9, 200), rng.uniform(-0.35, -0.3, 200), np.full(200, 4.9)])
        xyz, area = np.concatenate([house, bushes]), []
        for count, reason in ((len(house), 0), (len(xyz), Reason.SOLID_PLANE), (len(xyz), Reason.ATTACHED)):
            reasons = np.repeat([Reason.SOLID_PLANE, reason], [len(house), 200])[:count]
            made = extract_footprints(xyz[:count], np.full(count, 6), reason=reasons, regularize=False)
            area += made.columns["area"]
        grown.append(np.array(area[1:]) - area[0])
    as_roof, attached = np.mean(grown, axis=0)
    # As a roof, the row of bushes counts with the surroundings that a point has, a spacing of 0.32 m.
    assert 0.6 * 8 * 0.35 < as_roof < 1.1 * 8 * (0.35 + 0.32)
    assert attached < 0.5 * as_roof


@pytest.mark.parametrize("density", [4, 12, 40])
def test_steep_roofs_are_no_walls(rng, density):
    """A spire of 70° on a tower of 7 m, and a house whose roof rises by 62° from the ground."""
    plan = rng.uniform(0, 7, (49 * density, 2))
    spire = np.column_stack([plan, 15 + (3.5 - np.abs(plan - 3.5).max(axis=1)) * np.tan(np.radians(70))])
    plan = rng.uniform(0, [12, 8], (96 * density, 2))
    house = np.column_stack([plan + [20, 0], (4 - np.abs(plan[:, 1] - 4)) * np.tan(np.radians(62))])
    xyz = np.concatenate([spire, house])
    found = extract_footprints(xyz, np.full(len(xyz), 6))
    assert [len(rings) for rings in found.geometries] == [1, 1]
    assert found.columns["area"] == pytest.approx([49, 96], rel=0.12)


def test_what_is_seen_under_the_eaves_does_not_end_the_roof(rng):
    """A second flight line looks 1.5 m under the eaves of a house of 12 m by 8 m, at half the density."""
    areas = []
    for _ in range(6):
        house = roof(rng, 0, 0, 12, 8, 6.0, density=12)
        field = roof(rng, -4, -4, 20, 4, 0.0, density=12)
        under = roof(rng, 0, 0, 12, 1.5, 0.0, density=6)
        xyz = np.concatenate([house, field, under])
        areas += extract_footprints(xyz, np.repeat([6, 2, 2], [len(house), len(field), len(under)])).columns["area"]
    assert len(areas) == 6
    assert np.mean(areas) == pytest.approx(96, rel=0.03)


def test_a_roof_ends_in_the_middle_of_pulses_that_its_edge_splits():
    """Ground under such a pulse was left out, and the outline had nine tenths of the strip that these lie in."""
    size, beyond, areas = np.array([12.0, 9.0]), 0.1, []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        plan = rng.uniform(-8, size + 8, (11_200, 2))
        is_roof = ((plan >= -beyond) & (plan <= size + beyond)).all(axis=1)
        is_ground = ~((plan >= 0) & (plan <= size)).all(axis=1)
        sizes = [is_roof.sum(), is_ground.sum()]
        z = np.repeat([6.0, 0.0], sizes) + rng.normal(0, 0.02, sum(sizes))
        xyz = np.column_stack([np.concatenate([plan[is_roof], plan[is_ground]]), z])
        areas += extract_footprints(xyz, np.repeat([6, 2], sizes)).columns["area"]
    strip = np.prod(size + 2 * beyond) - np.prod(size)
    assert np.mean(areas) == pytest.approx(np.prod(size) + strip / 2, abs=strip / 4)


@pytest.mark.parametrize("density", [8, 16])
def test_a_roof_of_the_minimum_area_is_found_as_often_as_not(density):
    """Level lines are rounded at corners: of 24 squares of 4 m² at most two were drawn."""
    step, n_found = density**-0.5, 0
    lattice = np.stack(np.meshgrid(*[np.arange(-6, 8, step)] * 2), axis=-1).reshape(-1, 2)
    for seed in range(24):
        rng = np.random.default_rng(seed)
        plan = lattice + rng.uniform(0, step, 2) + rng.normal(0, 0.1 * step, lattice.shape)
        is_roof = ((plan >= 0) & (plan <= 2)).all(axis=1)
        xyz = np.column_stack([plan, np.where(is_roof, 3.0, 0.0)])
        n_found += len(extract_footprints(xyz, np.where(is_roof, 6, 2)))
    assert n_found >= 8


def test_of_a_part_that_is_asked_for_only_its_buildings_are_drawn_as_in_the_whole(rng):
    """The directions of a small shed are those of the block 20 m away, which is not drawn; a third lies farther off."""
    shed = turned(roof(rng, 0, 0, 4, 3.5, 3.0, density=4), 6.0)
    xyz = np.concatenate([shed, roof(rng, 24, 0, 40, 24, 9.0, density=4), roof(rng, 120, 0, 10, 10, 6.0, density=4)])
    sampling = CloudSampling.of(xyz)
    classes = np.full(len(xyz), 6)
    whole = extract_footprints(xyz, classes, sampling=sampling)
    sampling.asked = np.array([[-5.0, -5.0], [10.0, 10.0]])
    found = extract_footprints(xyz, classes, sampling=sampling)
    assert (len(whole), len(found)) == (3, 1)
    np.testing.assert_array_equal(found.geometries[0][0], whole.geometries[0][0])
    assert found.columns["area"] == whole.columns["area"][:1]
    alone = extract_footprints(shed, classes[: len(shed)], sampling=CloudSampling.of(shed))
    assert not np.array_equal(alone.geometries[0][0], whole.geometries[0][0])


def test_of_houses_that_touch_those_that_are_asked_for_are_given(rng):
    """They are drawn together, as they share a wall; each has the points that it has in the whole."""
    xyz = np.concatenate([roof(rng, 0, 0, 10, 8, 6.0, density=6), roof(rng, 10, 0, 12, 8, 9.0, density=6)])
    cluster_id = np.repeat([1, 2], [480, 576])
    sampling = CloudSampling.of(xyz)
    whole = extract_footprints(xyz, np.full(len(xyz), 6), cluster_id, sampling=sampling)
    sampling.asked = np.array([[2.0, 2.0], [5.0, 5.0]])
    found = extract_footprints(xyz, np.full(len(xyz), 6), cluster_id, sampling=sampling)
    assert whole.columns["cluster_id"] == [1, 2]
    assert found.columns["cluster_id"] == [1]
    np.testing.assert_array_equal(found.geometries[0][0], whole.geometries[0][0])
    assert found.columns["points"] == whole.columns["points"][:1]


def test_small_holes_are_filled(village):
    kept = extract_footprints(**village, min_hole_area=500.0)
    assert [len(rings) for rings in kept.geometries] == [1, 1]


def test_parts_of_a_cluster_are_separate_polygons_that_share_its_points(rng):
    xyz = np.concatenate([roof(rng, 0, 0, 6, 6, 5.0, 10), roof(rng, 12, 0, 6, 8, 5.0, 10)])
    found = extract_footprints(xyz, np.full(len(xyz), 6), np.ones(len(xyz), int))
    assert found.columns["cluster_id"] == [1, 1]
    assert sorted(found.columns["points"]) == [360, 480]


def test_without_clusters_what_lies_together_is_a_building(village):
    found = extract_footprints(village["xyz"], village["classification"])
    assert sorted(found.columns["area"]) == pytest.approx([80, 432], rel=0.08)
    assert np.isnan(found.columns["height"]).all()
    assert np.isnan(found.columns["entropy"]).all()


def test_minimum_area(village):
    assert len(extract_footprints(**village, min_area=1.0)) == 3
    assert len(extract_footprints(**village, min_area=100.0)) == 1


def test_position_changes_nothing(village):
    here = extract_footprints(**village)
    moved = {**village, "xyz": village["xyz"] + [600_000.0, 5_000_000.0, 300.0]}
    there = extract_footprints(**moved)
    assert there.columns["area"] == pytest.approx(here.columns["area"], rel=0.02)
    shift = there.geometries[0][0].mean(axis=0) - here.geometries[0][0].mean(axis=0)
    assert shift == pytest.approx([600_000, 5_000_000], abs=0.2)


def test_a_round_tower_stays_round(rng):
    angle, radius = rng.uniform(0, 2 * np.pi, 3000), 8 * np.sqrt(rng.uniform(0, 1, 3000))
    xyz = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(3000, 20.0)])
    found = extract_footprints(xyz, np.full(3000, 6), np.ones(3000, int), tolerance=0.3)
    assert found.columns["regularized"] == [0]
    assert_valid(found.geometries[0])
    ring = found.geometries[0][0]
    assert signed_area(ring) == pytest.approx(np.pi * 64, rel=0.06)
    # Chords, each of a few points, and all of them near the wall.
    assert len(ring) < 40
    middle = (ring[1:] + ring[:-1]) / 2
    assert (np.abs(np.hypot(*np.concatenate([ring, middle]).T) - 8) < 0.5).all()


@pytest.mark.parametrize(
    "xyz",
    [
        np.zeros((5, 3)),
        np.column_stack([np.arange(9.0), np.zeros(9), np.zeros(9)]),
        np.column_stack([np.zeros(9), np.zeros(9), np.arange(9.0)]),
        [[0.0, 0, 0]],
    ],
)
def test_buildings_without_area_give_no_polygon(xyz):
    found = extract_footprints(np.asarray(xyz), np.full(len(xyz), 6), np.ones(len(xyz), int))
    assert len(found) == 0


def test_no_building_gives_an_empty_layer(village):
    monitor = Monitor()
    ground = np.full(len(village["xyz"]), 2)
    found = extract_footprints(village["xyz"], ground, village["cluster_id"], monitor=monitor)
    assert monitor.warnings == ["No point is called building (class 6), so there are no footprints."]
    assert found.geometries == []
    assert set(found.columns) == {field.name for field in extract_footprints.stage.layers[0].fields}
    assert all(len(values) == 0 for values in found.columns.values())


def test_buildings_without_a_number_are_distinguished_from_none():
    monitor = Monitor()
    xyz, classes = np.random.default_rng(1).uniform(0, 9, (50, 3)), np.full(50, 6, np.uint8)
    found = extract_footprints(xyz, classes, np.zeros(50, np.int32), monitor=monitor)
    assert len(found) == 0
    assert monitor.warnings == ["No point of class 6 (building) has a ClusterID, so there are no footprints."]


def test_automatic_values_are_reported(village):
    monitor = Monitor()
    extract_footprints(**village, monitor=monitor)
    assert 0.5 < monitor.values["tolerance"] < 0.8


def test_progress_of_several_parts_never_goes_back(village):
    monitor = Listening()
    extract_footprints(**village, monitor=monitor)
    assert monitor.heard == sorted(monitor.heard)
    assert monitor.heard[-1] == pytest.approx(1)


def test_what_lies_inside_the_edge_of_a_roof_is_under_it():
    """Rooms seen through windows, bushes and ground under eaves show no end of the roof; yards and corners of yards do.

    Of the points around it, a place a spacing inside the edge has four fifths, one beyond the edge less than half.
    """
    shares = []
    for seed in range(10):
        rng = np.random.default_rng(seed)
        roof = rng.uniform(0, 30, (3600, 2))
        roof = roof[(roof < 20).any(axis=1)]  # a yard in the corner
        along = rng.uniform(3, 17, 300)
        inside = np.column_stack([along, np.full(300, 0.5)])
        outside = np.column_stack([along, np.full(300, -0.15)])
        yard = np.full((300, 2), 20) + rng.uniform(0.3, 0.6, (300, 2))
        tree = spatial.cKDTree(roof)
        shares.append([is_under_roof(places, tree, 0.5).mean() for places in (inside, outside, yard)])
    inside, outside, yard = np.mean(shares, axis=0)
    assert inside > 0.65
    assert outside < 0.15
    assert yard < 0.2


@pytest.mark.parametrize("density", [4.0, 12.0])
@pytest.mark.parametrize(
    ("slit", "bridge", "houses"),
    # Slits of two spacings are closed, too; bridges of two and three split in three quarters of all draws, or none.
    [(1.0, 0.0, 1), (3.5, 0.0, 2), (8.0, 1.0, 2), (8.0, 5.0, 1)],
)
def test_slits_and_bridges_part_houses_however_points_fall(slit, bridge, houses, density):
    """Two houses in one cluster, with a slit between them or a bridge of points, in spacings; all points, and 90 %."""
    spacing = 1 / np.sqrt(density)
    for seed in range(3):
        rng = np.random.default_rng(seed)
        x, y = rng.uniform(0, [40, 24], (int(960 * density), 2)).T
        from_middle = np.abs(x - 20) - slit * spacing / 2
        is_house = (np.abs(y - 12) < 6) & (from_middle > 0) & (from_middle < 11)
        is_house |= (np.abs(y - 12) < bridge * spacing / 2) & (from_middle <= 0)
        xyz = np.column_stack([x, y, 6.0 * is_house + rng.normal(0, 0.02, len(x))])
        for rows in (np.arange(len(x)), np.flatnonzero(rng.random(len(x)) < 0.9)):
            classes = np.where(is_house[rows], 6, 2)
            assert len(extract_footprints(xyz[rows], classes, is_house[rows].astype(np.int32))) == houses


def test_ground_between_two_houses_shows_for_both_where_they_end():
    """The cell of the ground lies next to both houses' cells; each house is outlined alone."""
    houses, ground = np.array([[0.5, 0.5], [2.5, 0.5], [2.6, 0.6]]), np.array([[1.5, 0.5], [9.5, 0.5]])
    parts = outlining._apart(houses, ground, 1.0)
    assert [(own.tolist(), beside.tolist()) for own, beside in parts] == [([0], [0]), ([1, 2], [0])]
