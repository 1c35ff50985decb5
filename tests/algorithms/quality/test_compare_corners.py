"""Corners against an old map: towns whose every corner was moved by a known distance, and against other routes."""

import statistics

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from lidar_buildings.algorithms.quality.compare_corners import FOUND, MISSED, NEW, compare_corners
from lidar_buildings.algorithms.quality.corner_matching import typical_distance
from lidar_buildings.algorithms.simulation.simulate_village import simulate_village
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.aged_maps import aged, with_plain_corners
from lidar_buildings.tests.builders import FAR


def house(west, south, width=10.0, depth=8.0, turn=0.0):
    """Return the closed outline of a house, counterclockwise, turned (radians) about its first corner."""
    plan = np.array([[0, 0], [width, 0], [width, depth], [0, depth], [0, 0]], float)
    cos, sin = np.cos(turn), np.sin(turn)
    return plan @ np.array([[cos, sin], [-sin, cos]]) + [west, south]


def layer(*outlines, **columns):
    """Return polygons of outlines, each a ring or a list of rings."""
    return LayerFeatures([rings if isinstance(rings, list) else [rings] for rings in outlines], columns)


def moved(ring, offsets):
    """Return a ring whose corners have moved by ``offsets`` (m, 2) or all by (2,)."""
    corners = ring[:-1] + offsets
    return np.concatenate([corners, corners[:1]])


def rows(features):
    return [dict(zip(features.columns, row)) for row in zip(*features.columns.values())]


@pytest.fixture
def town(rng):
    """Sixty houses of all sizes and directions, and by how much each corner of the map is off."""
    sizes = zip(np.arange(60), rng.uniform(6, 15, 60), rng.uniform(5, 12, 60), rng.uniform(0, 3, 60))
    houses = [house(30 * (i % 10), 30 * (i // 10), w, d, turn) for i, w, d, turn in sizes]
    return houses, rng.normal(0, 0.12, (60, 4, 2))


# --- truth by construction -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("place", [0, 1])
@pytest.mark.parametrize("shift", [(0.0, 0.0), (0.3, -0.2), (-1.6, 2.0)])
def test_every_corner_is_found_and_every_distance_reported(town, shift, place):
    houses, offsets = town
    offsets = offsets + np.array(shift)
    new = [moved(ring, offset) for ring, offset in zip(houses, offsets)]
    footprints, old_map = ([ring + place * FAR[:2] for ring in rings] for rings in (new, houses))
    arrows, buildings, report = compare_corners(layer(*footprints), layer(*old_map))
    distances = np.hypot(*offsets.reshape(-1, 2).T).tolist()
    expected = {
        "old_buildings": 60,
        "all_footprints": 60,
        "found": 60,
        "missed": 0,
        "new": 0,
        "corners": 240,
        "matched": 240,
        "mean": statistics.fmean(distances),
        "minimum": min(distances),
        "maximum": max(distances),
        "median": statistics.median(distances),
        "deviation": statistics.pstdev(distances),
        "mean_dx": offsets[..., 0].mean(),
        "mean_dy": offsets[..., 1].mean(),
    }
    assert report.values == pytest.approx(expected, abs=1e-6)
    assert set(report.values) == {measure.name for measure in compare_corners.stage.measures}
    reported = np.column_stack([arrows.columns["dx"], arrows.columns["dy"]])
    np.testing.assert_allclose(reported, offsets.reshape(-1, 2), atol=1e-8)
    for (start, end), row in zip(arrows.geometries, rows(arrows)):
        np.testing.assert_allclose(end - start, [row["dx"], row["dy"]], atol=1e-9)
        assert row["length"] == pytest.approx(np.hypot(row["dx"], row["dy"]))
    most = np.hypot(offsets[..., 0], offsets[..., 1]).max(axis=1)
    np.testing.assert_allclose(buildings.columns["max_distance"], most, atol=1e-8)


def test_missed_and_new_buildings_are_reported():
    old = [house(0, 0), house(30, 0), house(60, 0)]
    new = [moved(house(30, 0), [[0, 0.2], [0, 0.2], [0, -0.2], [0, -0.2]]), house(90, 0)]
    arrows, buildings, report = compare_corners(layer(*new), layer(*old))
    assert [(row["status"], row["building"], row["counterpart"]) for row in rows(buildings)] == [
        (MISSED, "1", ""),
        (FOUND, "2", "1"),
        (MISSED, "3", ""),
        (NEW, "2", ""),
    ]
    assert buildings.columns["area"] == pytest.approx([80] * 4)
    assert buildings.columns["covered"] == pytest.approx([0, 0.95, 0, 0])
    assert buildings.columns["corners"].tolist() == [4] * 4
    assert buildings.columns["matched"].tolist() == [0, 4, 0, 0]
    np.testing.assert_array_equal(buildings.geometries[3][0], new[1])
    np.testing.assert_array_equal(buildings.geometries[0][0], old[0])
    assert (report.values["found"], report.values["missed"], report.values["new"]) == (1, 2, 1)
    assert arrows.columns["old_building"] == ["2"] * 4
    assert arrows.columns["footprint"] == ["1"] * 4
    assert "1 of 3 buildings of the old map were found among 2 footprints" in report.html


def test_a_row_of_houses_may_be_one_outline():
    """Three houses of the map share walls; the outline has the four outer corners only."""
    old = [house(10 * i, 0) for i in range(3)]
    for footprints, old_map, found in (([house(0, 0.1, 30)], old, 3), (old, [house(0, 0.1, 30)], 1)):
        arrows, buildings, report = compare_corners(layer(*footprints), layer(*old_map))
        assert report.values["found"] == found
        assert (report.values["missed"], report.values["new"]) == (0, 0)
        assert report.values["matched"] == 4
        assert report.values["maximum"] == pytest.approx(0.1)
        assert len(arrows) == 4
    assert buildings.columns["counterpart"] == ["1, 2, 3"]


def test_another_building_at_the_same_place_is_no_building_found():
    """A hall was pulled down and a house built on its ground: the hall is missed and the house is new."""
    _, buildings, _ = compare_corners(layer(house(5, 5)), layer(house(0, 0, 40, 30)))
    assert buildings.columns["status"] == [MISSED, NEW]


@pytest.mark.parametrize(("width", "status"), [(5.0, FOUND), (4.99, MISSED)])
def test_half_is_enough(width, status):
    _, buildings, _ = compare_corners(layer(house(0, 0, width)), layer(house(0, 0, 10)))
    assert buildings.columns["status"][0] == status
    _, buildings, _ = compare_corners(layer(house(0, 0, width)), layer(house(0, 0, 10)), min_overlap=0.45)
    assert buildings.columns["status"] == [FOUND]


def test_courtyards_have_corners_too():
    old = [house(0, 0, 30, 30), house(10, 10, 10, 10)[::-1]]
    new = [moved(old[0], (0.1, 0)), moved(old[1], (0.1, 0))]
    report = compare_corners(layer(new), layer(old))[2]
    assert (report.values["corners"], report.values["matched"]) == (8, 8)
    assert report.values["mean_dx"] == pytest.approx(0.1)


def test_vertices_on_straight_and_round_walls_are_no_corners():
    ring = house(0, 0)
    dense = np.concatenate([ring[:1], [[3.0, 0.0]], ring[1:3], [[7.0, 8.05]], ring[3:]])
    angle = np.linspace(0, 2 * np.pi, 37)
    tower = 5 * np.column_stack([np.cos(angle), np.sin(angle)]) + [30, 4]
    report = compare_corners(layer(ring, tower), layer(dense, tower))[2]
    assert (report.values["found"], report.values["corners"], report.values["matched"]) == (2, 4, 4)


def test_corners_face_the_same_way():
    """A narrow wing was rebuilt next to its old place: its northern corner now is where its southern one was."""
    old = np.array([[0, 0], [10, 0], [10, 3], [14, 3], [14, 3.6], [10, 3.6], [10, 8], [0, 8], [0, 0]], float)
    new = np.array([[0, 0], [10, 0], [10, 2.4], [14, 2.4], [14, 3], [10, 3], [10, 8], [0, 8], [0, 0]], float)
    arrows, _, report = compare_corners(layer(new), layer(old))
    assert report.values["matched"] == 8
    assert arrows.columns["dy"] == pytest.approx([-0.6] * 4)
    assert arrows.columns["dx"] == pytest.approx([0] * 4)


def test_a_corner_is_matched_once():
    """A corner that was stepped in the map is a single one now."""
    old = np.array([[0, 0], [9.6, 0], [9.6, 0.5], [10, 0.5], [10, 8], [0, 8], [0, 0]], float)
    for footprints, old_map in ((house(0, 0), old), (old, house(0, 0))):
        arrows, _, report = compare_corners(layer(footprints), layer(old_map))
        assert report.values["matched"] == 4
        assert arrows.columns["length"] == pytest.approx([0.4])


def test_corners_of_other_buildings_are_not_matched():
    """The house was built out towards a shed, which is gone; the shed's corner is nearer than its own."""
    wider = np.array([[0, -0.6], [10, -0.6], [10, 8], [0, 8], [0, -0.6]], float)
    _, buildings, report = compare_corners(layer(wider), layer(house(0, 0), house(2, -1.1, 8, 0.6)))
    assert buildings.columns["status"] == [FOUND, MISSED]
    assert buildings.columns["matched"].tolist() == [4, 0]
    assert report.values["maximum"] == pytest.approx(0.6)


def test_walls_between_neighbors_keep_their_own_corners():
    """Corners of two houses at one place: each goes with its own house."""
    old = [house(0, 0), house(10, 0)]
    new = [house(0, 0, 9.7), house(9.7, 0, 10.3)]
    arrows = compare_corners(layer(*new), layer(*old))[0]
    assert (
        sorted((row["old_building"], row["footprint"]) for row in rows(arrows)) == [("1", "1")] * 2 + [("2", "2")] * 2
    )
    np.testing.assert_allclose(arrows.columns["dx"], -0.3)


# --- tolerance -------------------------------------------------------------------------------------------------------


def test_corners_beyond_the_tolerance_are_not_matched():
    old, new = house(0, 0, 20, 20), house(0, 0, 20, 20)
    new = moved(new, [[0, 0], [0, 0], [0, 0], [-0.8, 0]])
    assert compare_corners(layer(new), layer(old), tolerance=0.5)[2].values["matched"] == 3
    assert compare_corners(layer(new), layer(old), tolerance=0.9)[2].values["matched"] == 4


def test_automatic_tolerance_follows_the_map(rng):
    """One meter at least; where the map is poor, three times its typical error; what was rebuilt is left out."""
    houses = [house(40 * i, 0, 20, 20) for i in range(40)]
    for sigma, low, high in ((0.05, 1.0, 1.0), (0.5, 1.3, 2.2)):
        new = [moved(ring, rng.normal(0, sigma, (4, 2))) for ring in houses]
        new[0] = house(0, 0, 15, 20)
        monitor = Monitor()
        report = compare_corners(layer(*new), layer(*houses), monitor=monitor)[2]
        assert low <= monitor.values["tolerance"] <= high
        assert report.values["matched"] == pytest.approx(158, abs=2)


def test_pairs_by_chance_do_not_widen_the_automatic_tolerance(rng):
    """Corners 0.4 m off, and twice as many that are spread evenly over 3 m: three times 0.47 m, their median."""
    radius = 3 * np.sqrt(rng.random(4000))
    true = np.hypot(*rng.normal(0, 0.4, (2, 2000)))
    assert typical_distance(np.append(true, radius)) == pytest.approx(0.4 * np.sqrt(2 * np.log(2)), rel=0.1)
    assert typical_distance(true) == pytest.approx(np.median(true), rel=0.02)
    assert typical_distance(np.zeros(0)) == 0


def test_the_tolerance_counts_without_the_shift():
    """Two meters off as a whole, a centimeter among themselves: all corners are found with a tolerance of 5 cm."""
    houses = [house(30 * i, 0) for i in range(10)]
    new = [moved(ring, (2.0, 0.01 * (i % 2))) for i, ring in enumerate(houses)]
    report = compare_corners(layer(*new), layer(*houses), tolerance=0.05)[2]
    assert report.values["matched"] == 40
    assert report.values["minimum"] == pytest.approx(2.0, abs=1e-3)


# --- another route ---------------------------------------------------------------------------------------------------


def test_pairs_are_those_of_the_best_assignment(town):
    houses, offsets = town
    new = [moved(ring, offset) for ring, offset in zip(houses, offsets)]
    arrows = compare_corners(layer(*new), layer(*houses), tolerance=1.0)[0]
    starts, ends = (np.concatenate([ring[:-1] for ring in rings]) for rings in (houses, new))
    distance = np.linalg.norm(starts[:, None] - ends[None], axis=2)
    one, other = linear_sum_assignment(distance)
    assert arrows.columns["length"] == pytest.approx(distance[one, other].tolist())


def test_order_and_turning_of_the_rings_change_nothing(town, rng):
    houses, offsets = town
    new = [moved(ring, offset) for ring, offset in zip(houses, offsets)][5:]
    arrows, buildings, report = compare_corners(layer(*new), layer(*houses[:-7]))
    order = rng.permutation(len(new))
    back = [new[i][::-1] for i in order]
    again = compare_corners(layer(*back), layer(*(ring[::-1] for ring in houses[:-7])))
    assert again[2].values == pytest.approx(report.values)
    assert sorted(again[0].columns["length"]) == pytest.approx(sorted(arrows.columns["length"]))
    assert sorted(again[1].columns["status"]) == sorted(buildings.columns["status"])


def test_swapping_the_maps_turns_the_arrows():
    old, new = [house(0, 0), house(30, 0), house(60, 0)], [house(0.2, 0.1), house(30.1, 0)]
    there = compare_corners(layer(*new), layer(*old))
    back = compare_corners(layer(*old), layer(*new))
    assert there[0].columns["length"] == pytest.approx(back[0].columns["length"])
    assert there[2].values["mean_dx"] == pytest.approx(-back[2].values["mean_dx"])
    assert there[2].values["missed"] == back[2].values["new"] == 1


# --- parameters of users ---------------------------------------------------------------------------------------------


def test_buildings_are_called_by_their_id():
    old = layer(house(0, 0), house(30, 0), house(60, 0), ID=["A 17", None, "B 2"])
    new = layer(house(0, 0.1), house(30, 0.1), house(60, 0.1), fid=np.array([7.0, np.nan, 12.0]))
    buildings = compare_corners(new, old)[1]
    assert buildings.columns["building"] == ["A 17", "2", "B 2"]
    assert buildings.columns["counterpart"] == ["7", "2", "12"]


def test_heights_of_the_layers_are_not_used():
    flat = house(0, 0)
    raised = np.column_stack([flat, np.full(5, 9.0)])
    _, buildings, report = compare_corners(layer(raised), layer(flat))
    assert report.values["maximum"] == 0
    assert buildings.geometries[0][0].shape == (5, 2)


@pytest.mark.parametrize("away", [(1100.0, 0.0), (0.0, -1100.0), (-700.0, 800.0)])
def test_a_map_of_another_place_is_refused(away):
    """All its buildings would be counted as missed, which looks plausible in the counts alone."""
    footprints = layer(house(0, 0), house(30, 0))
    with pytest.raises(ValueError, match=r"^The footprints and the old map lie 1 km apart; choose a map of this area"):
        compare_corners(footprints, layer(house(0, 0) + away, house(30, 0) + away))
    near = layer(house(0, 0) + np.array(away) * 0.9, house(30, 0) + np.array(away) * 0.9)
    assert compare_corners(footprints, near)[2].values["missed"] == 2


def test_no_overlap_at_all_is_said():
    monitor = Monitor()
    arrows, buildings, report = compare_corners(layer(house(0, 0)), layer(house(500, 0)), monitor=monitor)
    assert monitor.warnings == ["No footprint overlaps a building of the old map; check that both show the same area."]
    assert len(arrows) == 0
    assert buildings.columns["status"] == [MISSED, NEW]
    assert report.values["matched"] == 0
    assert np.isnan([report.values[name] for name in ("mean", "minimum", "deviation", "mean_dx")]).all()
    assert "undefined" in report.html
    assert monitor.values == {"tolerance": 1.0}


@pytest.mark.parametrize(("new", "old"), [(0, 1), (1, 0), (0, 0)])
def test_empty_layers_are_no_error(new, old):
    monitor = Monitor()
    footprints, old_map = layer(*[house(0, 0)] * new), layer(*[house(0, 0)] * old)
    _, buildings, report = compare_corners(footprints, old_map, monitor=monitor)
    assert buildings.columns["status"] == [MISSED] * old + [NEW] * new
    assert (report.values["old_buildings"], report.values["all_footprints"]) == (old, new)
    assert monitor.warnings == []


def test_polygons_without_area_are_left_out_and_counted():
    line = np.array([[0, 0], [5, 5], [0, 0], [0, 0]], float)
    monitor = Monitor()
    report = compare_corners(layer(house(0, 0), line, [line[:2]], []), layer(house(0, 0)), monitor=monitor)[2]
    assert monitor.warnings == ["3 of 4 footprints have no area and were left out."]
    assert (report.values["all_footprints"], report.values["found"]) == (1, 1)


def test_polygons_that_cross_themselves_are_reported():
    bow = np.array([[0, 0], [10, 9], [10, 0], [0, 8], [0, 0]], float)
    monitor = Monitor()
    compare_corners(layer(house(0, 0)), layer(bow, house(30, 0)), monitor=monitor)
    assert monitor.warnings == [
        "1 of 2 buildings of the old map cross themselves, so that their areas may be wrong; "
        "run 'Fix geometries' on the layer first."
    ]


def test_repeated_vertices_do_no_harm():
    ring = np.repeat(house(0, 0), 2, axis=0)
    report = compare_corners(layer(ring), layer(house(0, 0)))[2]
    assert (report.values["corners"], report.values["matched"], report.values["maximum"]) == (4, 4, 0)


def test_without_an_old_map_all_is_new_and_the_log_says_so():
    monitor = Monitor()
    arrows, buildings, report = compare_corners(layer(house(0, 0), house(30, 0)), None, monitor=monitor)
    assert monitor.warnings == ["There is no old map to compare with, so all footprints are new."]
    monitor = Monitor()
    compare_corners(layer(), None, monitor=monitor)
    assert monitor.warnings == ["There is no old map to compare with."]
    assert buildings.columns["status"] == [NEW, NEW]
    assert (len(arrows), report.values["new"]) == (0, 2)


def test_missing_footprints_are_refused():
    with pytest.raises(ValueError, match=r"Footprints \(footprints\) is missing; choose a layer\."):
        compare_corners(None, layer(house(0, 0)))


@pytest.mark.parametrize("shift", [0.0, 1.5])
def test_a_village_and_its_old_map(shift):
    """Houses were pulled down and built since; the map is 15 cm off, and shifted as a whole."""
    *_, footprints, old_map = simulate_village(size=120.0, density=5.0, map_shift=shift, map_changes=0.2)
    _, buildings, report = compare_corners(footprints, old_map)
    state = dict(zip(map(str, old_map.columns["id"]), old_map.columns["state"]))
    reported = [row for row in rows(buildings) if row["status"] != NEW]
    assert {state[row["building"]] for row in reported if row["status"] == FOUND} == {"kept"}
    assert {state[row["building"]] for row in reported if row["status"] == MISSED} == {"demolished"}
    known = {str(number) for number in old_map.columns["building"]}
    new = {row["building"] for row in rows(buildings) if row["status"] == NEW}
    assert new == set(map(str, footprints.columns["id"])) - known
    assert report.values["matched"] >= 0.98 * report.values["corners"]
    assert [report.values["mean_dx"], report.values["mean_dy"]] == pytest.approx([-shift] * 2, abs=0.06)


@pytest.mark.parametrize("shift", [(0.4, -0.25), (-1.2, 0.8)])
def test_what_was_done_to_footprints_to_make_a_map_of_them_comes_back(shift):
    """A shift, noise, missing and vanished buildings, and wings that were added since."""
    *_, footprints, _ = simulate_village(size=150.0, density=5.0, seed=3)
    footprints = with_plain_corners(footprints)
    old = aged(footprints, shift=shift, noise=0.1, missing=3, gone=2, annexes=3)
    displacements, buildings, report = compare_corners(footprints, old.layer)
    assert {name: report.values[name] for name in old.counts} == old.counts
    # The wings have two corners each that were elsewhere.
    assert old.counts["corners"] - old.counts["matched"] == 6
    moved = np.concatenate([moved for _, moved in old.corners.values()])
    assert [report.values["mean_dx"], report.values["mean_dy"]] == pytest.approx(moved.mean(axis=0).tolist())
    assert report.values["mean"] == pytest.approx(np.hypot(*moved.T).mean())
    assert report.values["deviation"] == pytest.approx(np.hypot(*moved.T).std())
    lines = sorted(tuple(np.round([*line[0], *(line[1] - line[0])], 6)) for line in displacements.geometries)
    known = [(*place, *way) for places, ways in old.corners.values() for place, way in zip(places, ways)]
    np.testing.assert_allclose(lines, sorted(tuple(np.round(row, 6)) for row in known), atol=2e-6)
    reported = {row["building"]: row["status"] for row in rows(buildings) if row["status"] != NEW}
    names = list(map(str, old.layer.columns["id"]))
    assert reported == dict(zip(names, [FOUND] * (len(names) - 2) + [MISSED] * 2))
