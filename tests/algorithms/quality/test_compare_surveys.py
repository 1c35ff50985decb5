"""Footprints of two surveys: squares of which it is known what has changed."""

import numpy as np
import pytest

from lidar_buildings.algorithms.quality.compare_surveys import (
    BOTH,
    GONE,
    HEIGHT,
    NEW,
    OUTLINE,
    UNCHANGED,
    compare_surveys,
)
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.builders import rectangle


def box(west, south, width=10.0, depth=10.0):
    return [rectangle(west, south, width, depth)]


def compared(new, old, heights=None, **tunables):
    """Return the rows of the layer and the values of the report."""
    columns = [{"ridge_height": one} for one in heights] if heights else [{}, {}]
    buildings, report = compare_surveys(LayerFeatures(new, columns[0]), LayerFeatures(old, columns[1]), **tunables)
    assert len(buildings.geometries) == len(buildings.columns["id"])
    return [dict(zip(buildings.columns, row)) for row in zip(*buildings.columns.values())], report


def test_every_change_is_named():
    old = [box(0, 0), box(20, 0), box(40, 0), box(60, 0), box(80, 0)]
    new = [box(0, 0), box(20, 0, width=14), box(40, 0), box(60, 0, depth=13), box(100, 0)]
    rows, report = compared(new, old, ([5, 5, 8, 9, 5], [5.1, 5, 5, 5, 5]), outline_tolerance=1, height_tolerance=1)
    assert [row["status"] for row in rows] == [UNCHANGED, OUTLINE, HEIGHT, BOTH, NEW, GONE]
    assert [row["outline_change"] for row in rows] == pytest.approx([0, 4, 0, 3, np.nan, np.nan], nan_ok=True)
    assert [row["height_change"] for row in rows] == pytest.approx([-0.1, 0, 3, 4, np.nan, np.nan], nan_ok=True)
    assert [row["gained"] for row in rows] == pytest.approx([0, 40, 0, 30, 100, 0])
    assert [row["lost"] for row in rows] == pytest.approx([0, 0, 0, 0, 0, 100])
    assert [row["building"] for row in rows] == ["1", "2", "3", "4", "5", "5"]
    assert report.values == {
        "new_footprints": 5,
        "old_footprints": 5,
        "new": 1,
        "gone": 1,
        "height_changed": 2,
        "outline_changed": 2,
        "unchanged": 1,
        "new_area": pytest.approx(100),
        "gone_area": pytest.approx(100),
    }
    assert report.html.count("<path fill=") == 6


def test_a_building_that_is_drawn_as_two_has_not_changed():
    halves = [box(0, 0, width=5), box(5, 0, width=5)]
    for new, old in ((halves, [box(0, 0)]), ([box(0, 0)], halves)):
        rows, _ = compared(new, old, ([6.0] * len(new), [6.0] * len(old)))
        assert {row["status"] for row in rows} == {UNCHANGED}
        assert [row["outline_change"] for row in rows] == pytest.approx([0] * len(new), abs=1e-9)
    assert rows[0]["counterpart"] == "1, 2"


def test_the_height_of_a_group_is_the_mean_by_area():
    rows, _ = compared([box(0, 0)], [box(0, 0, width=8), box(8, 0, width=2)], ([9.0], [5.0, 10.0]))
    assert rows[0]["height_change"] == pytest.approx(3)


def test_a_part_that_was_torn_down_is_a_change_of_the_outline():
    rows, _ = compared([box(0, 0, width=4)], [box(0, 0)])
    assert [row["status"] for row in rows] == [OUTLINE]
    assert rows[0]["lost"] == pytest.approx(60)
    assert rows[0]["outline_change"] == pytest.approx(6)


@pytest.mark.parametrize(("offset", "expected"), [(0.1, 1.0), (0.6, 1.8), (2.0, 4.0)])
def test_the_automatic_outline_tolerance_follows_the_scatter(offset, expected):
    old = [box(30 * i, 0) for i in range(9)]
    monitor = Monitor()
    compared([box(30 * i + offset, 0) for i in range(9)], old, monitor=monitor)
    assert monitor.values["outline_tolerance"] == pytest.approx(expected)


@pytest.mark.parametrize(("offset", "expected"), [(0.1, 0.5), (0.4, 1.2), (5.0, 3.0)])
def test_the_automatic_height_tolerance_follows_the_scatter(offset, expected):
    boxes = [box(30 * i, 0) for i in range(9)]
    monitor = Monitor()
    compared(boxes, boxes, (np.full(9, 5.0) - offset, np.full(9, 5.0)), monitor=monitor)
    assert monitor.values["height_tolerance"] == pytest.approx(expected)


def test_heights_go_with_the_polygons_that_are_left():
    flat = [np.zeros((4, 2))]
    rows, _ = compared([flat, box(0, 0)], [box(0, 0)], ([50.0, 5.0], [5.0]))
    assert [(row["status"], row["height_change"]) for row in rows] == [(UNCHANGED, 0.0)]


def test_unknown_heights_are_no_change():
    rows, _ = compared([box(0, 0)], [box(0, 0)], ([np.nan], [5.0]))
    assert rows[0]["status"] == UNCHANGED
    assert np.isnan(rows[0]["height_change"])


@pytest.mark.parametrize("heights", [None, (["high"], ["low"]), ([[1, 2]], [[1, 2]])])
def test_layers_without_heights_are_compared_by_their_outlines(heights):
    """Text in the field of the height ended with an error of numpy."""
    monitor = Monitor()
    rows, _ = compared([box(0, 0)], [box(0, 0)], heights, monitor=monitor)
    assert rows[0]["status"] == UNCHANGED
    assert monitor.warnings == ["Heights are not compared: no attribute 'ridge_height' or 'height' is in both layers."]


@pytest.mark.parametrize(
    ("new", "old", "statuses"), [([], [box(0, 0)], [GONE]), ([box(0, 0)], [], [NEW]), ([], [], [])]
)
def test_an_empty_survey_is_an_answer(new, old, statuses):
    rows, _ = compared(new, old)
    assert [row["status"] for row in rows] == statuses


def test_surveys_far_apart_are_refused():
    with pytest.raises(ValueError, match="The footprints and the earlier survey lie 50 km apart"):
        compared([box(50_020, 0)], [box(0, 0)])
