"""The map of polygons in the colors of their kinds."""

import re

import numpy as np

from lidar_buildings.algorithms.report.page import with_coordinates
from lidar_buildings.algorithms.report.polygon_map import draw_polygons
from lidar_buildings.tests.builders import rectangle

COLORS = {"kept": "#004488", "<lost>": "#ddaa33"}


def test_polygons_have_the_colors_of_their_kinds_the_last_kind_on_top():
    drawn = draw_polygons(
        [[rectangle(0, 0)], [rectangle(20, 0)], [rectangle(40, 0)]], ["<lost>", "kept", "kept"], COLORS
    )
    assert re.findall('<path fill="([^"]+)"', drawn) == ["#004488", "#004488", "#ddaa33"]
    assert "&lt;lost&gt;" in drawn
    assert "50 m wide and 10 m high" in drawn


def test_north_is_up_and_scale_is_kept():
    drawn = draw_polygons([[rectangle(0, 0)], [rectangle(0, 30)]], ["kept", "kept"], COLORS)
    south, north = (
        np.array([point.split(",") for point in path.split()], float) for path in re.findall('d="M([^Z]+)Z"', drawn)
    )
    assert north[:, 1].max() < south[:, 1].min()
    assert np.allclose(np.ptp(north, axis=0), np.ptp(south, axis=0), atol=0.2)
    assert np.isclose(*np.ptp(south, axis=0), atol=0.2)


def test_courtyards_are_rings_of_the_same_path():
    drawn = draw_polygons([[rectangle(0, 0), rectangle(4, 4, 2, 2)[::-1]]], ["kept"], COLORS)
    assert drawn.count("<path") == 1
    assert drawn.count("Z") == 2


def test_without_polygons_there_is_no_map():
    assert draw_polygons([], [], COLORS) == ""


def test_points_are_shaded_below_the_polygons_and_extend_the_map(rng):
    corners = [[-20.0, -20.0, 0.0], [30.0, 30.0, 0.0]]
    xyz = np.concatenate([corners, np.column_stack([rng.uniform(-20, 30, (500, 2)), rng.normal(size=500)])])
    drawn = draw_polygons([[rectangle(0, 0)]], ["kept"], COLORS, xyz)
    assert drawn.index("<image") < drawn.index("<path")
    assert "50 m wide and 50 m high" in drawn


def test_the_map_says_where_its_corner_is():
    drawn = with_coordinates(draw_polygons([[rectangle(3, 4)]], ["kept"], COLORS), lambda xy: xy * 10)
    assert "lower left corner is at 30.0 E, 40.0 N." in drawn
