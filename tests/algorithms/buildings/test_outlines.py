"""Outlines of point patterns whose outline is known, and valid ones of any pattern."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from lidar_buildings.algorithms.buildings.outlines import perimeter, signed_area, trace_outlines


def even(west, south, width, depth, step=0.5):
    x, y = np.meshgrid(np.arange(west, west + width + 1e-9, step), np.arange(south, south + depth + 1e-9, step))
    return np.column_stack([x.ravel(), y.ravel()])


def test_square():
    outlines = trace_outlines(even(600_000, 5_000_000, 10, 6), 0.5)
    ((ring,),) = outlines.parts
    assert signed_area(ring) == pytest.approx(60)
    assert perimeter(ring) == pytest.approx(32)
    assert (outlines.part_of_point == 0).all()


def test_courtyard_is_a_hole(assert_valid):
    points = even(0, 0, 20, 20)
    points = points[(np.abs(points - 10) > 4).any(axis=1)]
    ((exterior, hole),) = trace_outlines(points, 0.5).parts
    assert_valid([exterior, hole])
    assert signed_area(exterior) == pytest.approx(400)
    assert signed_area(hole) == pytest.approx(-81, rel=0.05)  # from 5.5 to 14.5, corners rounded


def test_gap_parts_and_joins():
    points = np.concatenate([even(0, 0, 5, 5), even(8, 0, 5, 5)])
    outlines = trace_outlines(points, 0.5)
    assert len(outlines.parts) == 2
    assert len(set(outlines.part_of_point.tolist())) == 2
    (joined,) = trace_outlines(points, 0.5, max_edge=3.5).parts
    assert signed_area(joined[0]) == pytest.approx(65)


def test_parts_that_touch_in_one_point_are_two(assert_valid):
    points = np.concatenate([even(0, 0, 4, 4), even(4, 4, 4, 4)])
    outlines = trace_outlines(np.unique(points, axis=0), 0.5, max_edge=0.75)
    outer = [rings[0] for rings in outlines.parts if len(rings)]
    for rings in outlines.parts:
        assert_valid(rings)
    assert sum(map(signed_area, outer)) == pytest.approx(32, abs=0.3)


def test_scan_lines_far_apart_stay_together():
    # Points every 10 cm on lines that are 1 m apart: the mean spacing is 0.32 m.
    x, y = np.meshgrid(np.arange(0, 10, 0.1), np.arange(0, 10, 1.0))
    outlines = trace_outlines(np.column_stack([x.ravel(), y.ravel()]), 0.32)
    assert len(outlines.parts) == 1
    assert len(outlines.parts[0]) == 1
    assert signed_area(outlines.parts[0][0]) == pytest.approx(9.9 * 9, rel=0.01)


@pytest.mark.parametrize("max_edge", [0.7, 1.0, 1.5, 3.0])
def test_any_pattern_gives_valid_polygons_of_the_kept_triangles(rng, assert_valid, max_edge):
    points = rng.uniform(0, 12, (350, 2))
    outlines = trace_outlines(points, 0.64, max_edge)
    for rings in outlines.parts:
        assert_valid(rings)
    # Independent: the area of all triangles without a long edge.
    corners = points[Delaunay(points).simplices]
    short = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1) <= max_edge
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    expected = 0.5 * np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])[short].sum()
    assert sum(signed_area(ring) for rings in outlines.parts for ring in rings) == pytest.approx(expected, rel=1e-6)


def test_point_order_changes_nothing(rng):
    points = rng.uniform(0, 12, (350, 2))
    order = rng.permutation(350)
    areas = [
        sorted(sum(map(signed_area, rings)) for rings in trace_outlines(p, 0.64).parts) for p in (points, points[order])
    ]
    assert areas[0] == pytest.approx(areas[1])


@pytest.mark.parametrize(
    "points", [np.zeros((0, 2)), [[1, 2]], [[0, 0], [1, 1]], np.ones((9, 2)), [[0, 0], [1, 1], [2, 2]]]
)
def test_points_without_area_have_no_outline(points):
    outlines = trace_outlines(np.asarray(points, float).reshape(-1, 2), 0.5)
    assert outlines.parts == []
    assert (outlines.part_of_point == -1).all()
