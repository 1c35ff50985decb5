"""Footprints against a reference: squares whose overlaps, distances and corners are known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.quality.assess_footprints import (
    FOUND,
    INVENTED,
    MERGED,
    MISSED,
    SPLIT,
    assess_footprints,
)
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.builders import FAR, rectangle


def box(west, south, width=10.0, depth=10.0):
    return [rectangle(west, south, width, depth)]


def layer(*outlines, **columns):
    return LayerFeatures(list(outlines), columns)


def rows(features):
    return [dict(zip(features.columns, row)) for row in zip(*features.columns.values())]


def assessed(footprints, reference, **tunables):
    """Return the rows of the layer and the values of the report."""
    buildings, report = assess_footprints(layer(*footprints), layer(*reference), **tunables)
    assert len(buildings.geometries) == len(buildings.columns["id"])
    return rows(buildings), report.values


@pytest.mark.parametrize("times", [0, 1])
def test_a_moved_square(times):
    shift = FAR[:2] * times
    (row,), values = assessed([[ring + shift for ring in box(0.3, 0.4)]], [[ring + shift for ring in box(0, 0)]])
    shared = 9.7 * 9.6
    assert (row["status"], row["building"], row["counterpart"]) == (FOUND, "1", "1")
    assert row["iou"] == pytest.approx(shared / (200 - shared))
    assert row["covered"] == pytest.approx(shared / 100)
    assert row["area"] == pytest.approx(100)
    assert row["hausdorff"] == pytest.approx(0.5, abs=1e-6)
    assert (row["corners"], row["counterpart_corners"], row["matched"]) == (4, 4, 4)
    assert row["corner_distance"] == pytest.approx(0.5, abs=1e-6)
    assert row["squareness"] == row["counterpart_squareness"] == pytest.approx(1)
    assert (values["found"], values["merged"], values["split"]) == (1, 0, 0)
    assert (values["shift_east"], values["shift_north"]) == pytest.approx((0.3, 0.4), abs=1e-6)


def test_each_status_is_reported():
    reference = [box(0, 0), box(20, 0), box(30, 0), box(50, 0), box(70, 0)]
    footprints = [box(0, 0), box(20, 0, width=20), box(50, 0, width=5), box(55, 0, width=5), box(90, 0)]
    found, values = assessed(footprints, reference, compared="everywhere")
    assert [row["status"] for row in found] == [FOUND, MERGED, MERGED, SPLIT, MISSED, INVENTED]
    assert [row["counterpart"] for row in found] == ["1", "2", "2", "3, 4", "", ""]
    assert [row["iou"] for row in found] == pytest.approx([1, 0.5, 0.5, 0.5, np.nan, np.nan], nan_ok=True)
    assert [row["covered"] for row in found] == pytest.approx([1, 1, 1, 1, 0, 0])
    assert {name: values[name] for name in (FOUND, MERGED, SPLIT, MISSED, INVENTED)} == {
        FOUND: 1,
        MERGED: 2,
        SPLIT: 1,
        MISSED: 1,
        INVENTED: 1,
    }
    assert values["completeness"] == pytest.approx(80)
    assert values["correctness"] == pytest.approx(80)
    assert values["iou"] == pytest.approx(1)


def town(columns, row_numbers, skipped=()):
    """Return houses of 10 m on a grid of 20 m."""
    return [box(20 * x, 20 * y) for x in range(columns) for y in range(row_numbers) if (x, y) not in skipped]


def test_footprints_beyond_the_reference_are_not_compared():
    """The reference is the south-west quarter of a town and lacks one house amid the others."""
    found, values = assessed(town(8, 8), town(4, 4, skipped=[(1, 2)]))
    assert [row["status"] for row in found] == [FOUND] * 15 + [INVENTED]
    assert (values["all_footprints"], values["outside"], values["correctness"]) == (16, 48, 100 * 15 / 16)
    everything, values = assessed(town(8, 8), town(4, 4, skipped=[(1, 2)]), compared="everywhere")
    assert (values["invented"], values["outside"]) == (49, 0)


@pytest.mark.parametrize(("off", "is_compared"), [(40.0, True), (75.0, False)])
def test_the_reference_covers_a_square_as_wide_as_a_street_or_a_small_park(off, is_compared):
    """A footprint in the middle of eight buildings of the reference, so far from its own middle."""
    turns = np.radians(np.arange(0, 360, 45))
    around = [box(off * x - 5, off * y - 5) for x, y in np.column_stack([np.cos(turns), np.sin(turns)])]
    _, values = assessed([*around, box(-5, -5)], around)
    assert (values["invented"], values["outside"]) == ((1, 0) if is_compared else (0, 1))


def test_an_area_decides_what_is_compared_of_both_layers():
    """Houses of which half lies within: four of the reference of nine, of which one was not found."""
    area = layer(box(-5, -5, width=34, depth=34))
    buildings, report = assess_footprints(layer(*town(8, 8, skipped=[(1, 1)])), layer(*town(3, 3)), area)
    assert buildings.columns["status"] == [FOUND, FOUND, FOUND, MISSED]
    assert (report.values["reference_buildings"], report.values["outside"]) == (4, 60)
    assert "60 more lie outside the area compared." in report.html


def test_polis_by_hand():
    """A square moved by 0.3 m: two of its corners lie on lines of the other, but each is 0.3 m from its outline."""
    (row,), values = assessed([box(0.3, 0)], [box(0, 0)])
    # Two corners lie 0.3 m outside an edge's end; two lie on an edge of the other square.
    assert row["polis"] == pytest.approx((2 * 0.3 + 2 * 0) / 4)
    assert values["polis"] == row["polis"]


def test_the_best_counterpart_comes_first():
    (row,), _ = assessed([box(0, 0, width=3), box(3, 0, width=7)], [box(0, 0)])
    assert (row["status"], row["counterpart"]) == (SPLIT, "2, 1")
    assert row["iou"] == pytest.approx(0.7)
    assert row["hausdorff"] == pytest.approx(3)


@pytest.mark.parametrize(("width", "status"), [(5.0, FOUND), (4.9, MISSED)])
def test_half_of_a_building_must_be_covered(width, status):
    found, values = assessed([box(0, 0, width=width)], [box(0, 0)])
    assert found[0]["status"] == status
    assert values["invented"] == (status == MISSED)


@pytest.mark.parametrize(("min_overlap", "status"), [(0.2, FOUND), (0.4, MISSED)])
def test_the_minimum_overlap_can_be_set(min_overlap, status):
    found, _ = assessed([box(0, 0, width=3)], [box(0, 0)], min_overlap=min_overlap)
    assert found[0]["status"] == status


def test_a_neighbor_that_is_touched_is_not_merged():
    # The footprint of the left house reaches 2 m into the right one, which has its own.
    found, _ = assessed([box(0, 0, width=12), box(12, 0, width=8)], [box(0, 0), box(10, 0)])
    assert [row["status"] for row in found] == [FOUND, FOUND]
    assert [row["iou"] for row in found] == pytest.approx([100 / 120, 0.8])


def test_a_footprint_much_larger_than_its_building_is_invented():
    found, _ = assessed([box(0, 0, width=30)], [box(0, 0)])
    assert [row["status"] for row in found] == [FOUND, INVENTED]
    assert found[0]["iou"] == pytest.approx(1 / 3)
    assert found[1]["covered"] == pytest.approx(1 / 3)


def test_buildings_with_all_corners_within_a_distance_are_counted():
    """Moved by 0.2, 0.45 and 0.9 m, with one corner 1.2 m off, without one of four corners, and missed."""
    reference = [box(30 * at, 0) for at in range(6)]
    corner = np.array([[0, 0], [1.2, 0], [0, 0], [0, 0], [0, 0]])
    cut = [np.array([[120, 0], [130, 0], [130, 10], [120, 0.0]])]
    moved = [box(0.2, 0), box(30, 0.45), box(60.9, 0), [reference[3][0] + corner], cut]
    found, values = assessed(moved, reference, tolerance=2.0)
    farthest = [row["farthest_corner"] for row in found]
    assert farthest == pytest.approx([0.2, 0.45, 0.9, 1.2, np.nan, np.nan], nan_ok=True)
    assert [values[f"within_{most}_cm"] for most in (30, 50, 100)] == [1, 2, 3]


def test_names_are_those_of_the_layers():
    buildings, _ = assess_footprints(layer(box(0, 0), fid=[17]), layer(box(0, 0), id=["NL.12"]))
    assert rows(buildings)[0]["building"] == "NL.12"
    assert rows(buildings)[0]["counterpart"] == "17"


def test_corners_farther_apart_than_the_tolerance_are_not_the_same():
    moved = [box(0, 0)[0] + np.array([[0, 0], [0.6, 0], [0, 0], [0, 0], [0, 0]])]
    (row,), values = assessed([moved], [box(0, 0)], tolerance=0.5)
    assert (row["matched"], values["matched"]) == (3, 3)
    (row,), _ = assessed([moved], [box(0, 0)], tolerance=0.7)
    assert row["matched"] == 4
    assert row["corner_distance"] == pytest.approx(0.15)


def test_the_squareness_of_both_is_reported():
    cut = [np.array([[0, 0], [10, 0], [10, 6], [6, 10], [0, 10], [0, 0]], float)]
    (row,), values = assessed([cut], [box(0, 0)])
    expected = 32 / (32 + np.hypot(4, 4))
    assert (row["squareness"], row["counterpart_squareness"]) == pytest.approx((1, expected))
    assert (values["reference_squareness"], values["squareness"]) == pytest.approx((1, expected))
    assert (row["corners"], row["counterpart_corners"]) == (4, 5)


def test_a_layer_against_itself_agrees(rng):
    boxes = [box(30 * i, 0, *rng.uniform(5, 20, 2)) for i in range(20)]
    found, values = assessed(boxes, boxes)
    assert {row["status"] for row in found} == {FOUND}
    assert (values["iou"], values["hausdorff"], values["corner_distance"]) == pytest.approx((1, 0, 0))
    assert values["matched"] == values["corners"] == values["footprint_corners"] == 80


@pytest.mark.parametrize(
    ("footprints", "reference", "statuses"), [([], [box(0, 0)], [MISSED]), ([box(0, 0)], [], [INVENTED])]
)
def test_an_empty_layer_is_an_answer(footprints, reference, statuses):
    monitor = Monitor()
    found, values = assessed(footprints, reference, monitor=monitor)
    assert len(monitor.warnings) == 1
    assert monitor.warnings[0].startswith("There are no")
    assert [row["status"] for row in found] == statuses
    assert np.isnan(values["iou"])


def test_two_empty_layers_give_an_empty_one():
    found, values = assessed([], [])
    assert found == []
    assert np.isnan(values["completeness"])


def test_layers_far_apart_are_refused():
    with pytest.raises(ValueError, match="The footprints and the reference lie 50 km apart"):
        assessed([box(50_020, 0)], [box(0, 0)])


def test_the_page_shows_the_counts_the_map_and_the_worst():
    _, report = assess_footprints(layer(box(0, 0), box(20, 0, width=6)), layer(box(0, 0), box(20, 0), box(40, 0)))
    assert "Of 3 buildings of the reference, 2 have one footprint" in report.html
    assert report.html.count("<path fill=") == 3
    worst = report.html[report.html.index("Buildings that agree least") :]
    assert worst.index(">2<") < worst.index(">1<")
