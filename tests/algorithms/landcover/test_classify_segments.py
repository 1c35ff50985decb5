"""Segments picked by number, in the map and by their measures: a scene whose measures are known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import parse_classes
from lidar_buildings.algorithms.geometry.polygon_overlap import are_within
from lidar_buildings.algorithms.geometry.rings import polygon_area, sides_of_rings
from lidar_buildings.algorithms.landcover.classify_segments import classify_segments
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.polygon_validity import assert_valid

# Numbers of the segments, as other programs give them: with gaps.
TERRAIN, ROOF, PITCH, HEDGE = 3, 7, 12, 40


def scene():
    """Return points, segments and heights: terrain of 40 m by 40 m around a house, its roofs 5 m up, a rough hedge."""
    x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1) + 0.25
    segment = np.full(len(x), TERRAIN)
    segment[(x > 10) & (x < 20) & (y > 10) & (y < 18)] = ROOF
    segment[(x > 20) & (x < 30) & (y > 10) & (y < 18)] = PITCH
    segment[(x > 34) & (x < 36) & (y > 10) & (y < 30)] = HEDGE
    segment[(x > 2) & (x < 4) & (y > 2) & (y < 4)] = 0
    height = np.zeros(len(x))
    height[segment == ROOF] = 5.0
    height[segment == PITCH] = 5.0 + (25 - x[segment == PITCH])
    # Up and down from point to point, across and along.
    height[segment == HEDGE] = 1.0 + 0.4 * (-1.0) ** np.floor(2 * (x + y))[segment == HEDGE]
    return np.column_stack([x + 300, y + 200, 100 + height]), segment, height


XYZ, SEGMENT, HEIGHT = scene()
BEFORE = np.full(len(XYZ), 1, np.uint8)


def picked(*, heights=HEIGHT, selection=None, **set_to):
    """Return the numbers of the segments whose points have class 64 then; all others keep class 1."""
    classes, segments = classify_segments(XYZ, BEFORE, SEGMENT, heights, selection, code=64, **set_to)
    numbers = np.unique(SEGMENT[classes == 64]).tolist()
    np.testing.assert_array_equal(classes, np.where(np.isin(SEGMENT, numbers), 64, 1))
    columns = segments.columns
    assert [one for one, is_picked in zip(columns["id"], columns["picked"]) if is_picked] == numbers
    return numbers


@pytest.mark.parametrize(
    ("set_to", "expected"),
    [
        ({}, []),
        ({"numbers": "3"}, [TERRAIN]),
        ({"numbers": "4-12, 40"}, [ROOF, PITCH, HEDGE]),
        ({"numbers": "5"}, []),
        ({"min_area": 200.0}, [TERRAIN]),
        ({"max_area": 60.0}, [HEDGE]),
        ({"min_height": 4.0}, [ROOF, PITCH]),
        ({"max_height": 1.5}, [TERRAIN, HEDGE]),
        ({"min_slope": 30.0}, [PITCH]),
        ({"max_slope": 30.0}, [TERRAIN, ROOF, HEDGE]),
        ({"min_roughness": 0.2}, [HEDGE]),
        ({"max_roughness": 0.2}, [TERRAIN, ROOF, PITCH]),
        ({"numbers": "3, 7", "min_height": 4.0}, [ROOF]),
        ({"min_height": 4.0, "max_slope": 30.0}, [ROOF]),
        ({"numbers": "3", "min_height": 4.0}, []),
    ],
)
def test_segments_that_meet_all_that_is_set_are_picked(set_to, expected):
    assert picked(**set_to) == expected


def test_what_is_measured_is_what_the_scene_was_made_of():
    columns = classify_segments(XYZ, BEFORE, SEGMENT, HEIGHT)[1].columns
    assert columns["id"] == [TERRAIN, ROOF, PITCH, HEDGE]
    assert columns["points"] == [(one == SEGMENT).sum() for one in columns["id"]]
    # Cells reach over the edges, by a tenth of the hedge, which is three cells wide.
    assert columns["area"] == pytest.approx([1396, 80, 80, 40], rel=0.15)
    assert columns["height"] == pytest.approx([0, 5, 5, 1])
    assert columns["slope"] == pytest.approx([0, 0, 45, 0], abs=2)
    # Independently: the least singular value of the points around their mean.
    of = [XYZ[one == SEGMENT] for one in columns["id"]]
    least = [np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[2] / np.sqrt(len(points)) for points in of]
    assert columns["roughness"] == pytest.approx(least, abs=1e-6)
    assert columns["roughness"][3] == pytest.approx(0.4, abs=0.02)


def test_outlines_hold_their_points_and_no_others():
    segments = classify_segments(XYZ, BEFORE, SEGMENT)[1]
    for rings, number, area in zip(segments.geometries, segments.columns["id"], segments.columns["area"]):
        assert_valid(rings)
        assert polygon_area(rings) == pytest.approx(area, rel=0.1)
        inside = are_within(XYZ[:, :2], sides_of_rings(rings))
        assert (inside == (number == SEGMENT)).mean() > 0.98
    assert len(segments.geometries[0]) == 4


def test_outlines_selected_in_the_map_are_the_segments_picked():
    made = classify_segments(XYZ, BEFORE, SEGMENT)[1]
    chosen = LayerFeatures(made.geometries[1:3], {name: values[1:3] for name, values in made.columns.items()})
    assert picked(selection=chosen) == [ROOF, PITCH]
    assert picked(selection=chosen, max_slope=30.0) == [ROOF]
    assert picked(selection=chosen, numbers="3-11") == [ROOF]
    assert picked(selection=LayerFeatures([], {"id": []})) == []
    assert picked(selection=LayerFeatures([None, None], {"id": np.array([np.nan, 40.0])})) == [HEDGE]


def test_heights_are_empty_where_they_are_not_known():
    assert np.isnan(classify_segments(XYZ, BEFORE, SEGMENT)[1].columns["height"]).all()
    some = np.where(XYZ[:, 0] < 315, HEIGHT, np.nan)
    heights = classify_segments(XYZ, BEFORE, SEGMENT, some)[1].columns["height"]
    assert heights[:2] == pytest.approx([0, 5])
    assert np.isnan(heights[2:]).all()
    assert picked(heights=some, min_height=-1.0) == [TERRAIN, ROOF]


def test_the_run_says_what_was_picked():
    monitor = Monitor()
    classify_segments(XYZ, BEFORE, SEGMENT, HEIGHT, numbers="7, 12", monitor=monitor)
    assert monitor.infos[-1] == "2 of 4 segments are picked; 640 points get class 2."
    assert monitor.values["max_height"] == pytest.approx(5)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"numbers": "41"}, "Numbers of segments must be numbers from 0 to 40"),
        ({"numbers": "seven"}, "'seven'"),
        ({"min_height": 2.0}, "'Height above ground'"),
        ({"min_slope": 20.0, "max_slope": 10.0}, "exchange"),
        ({"selection": LayerFeatures([None], {"name": ["a"]})}, "attribute id .* got name"),
        ({"selection": LayerFeatures([None], {"id": ["a"]})}, "attribute id"),
    ],
)
def test_what_can_not_be_picked_is_refused(given, said):
    with pytest.raises(ValueError, match=said):
        classify_segments(XYZ, BEFORE, SEGMENT, **given)


def test_a_cloud_without_segments_is_refused():
    with pytest.raises(ValueError, match="'Segment surfaces'"):
        classify_segments(XYZ, BEFORE, np.zeros(len(XYZ), int))


def test_lists_of_other_numbers_than_classes_are_read():
    assert parse_classes("300, 7-9", "Numbers", 300).tolist() == [7, 8, 9, 300]
    with pytest.raises(ValueError, match="from 0 to 300"):
        parse_classes("301", "Numbers", 300)
