"""Outlines of point patterns whose outline is known."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from lidar_buildings.algorithms.facades.facade_outline import trace_outlines, triangulated
from lidar_buildings.algorithms.geometry.rings import perimeter, signed_area
from lidar_buildings.tests.polygon_validity import assert_valid


def even(west, south, width, depth, step=0.5):
    x, y = np.meshgrid(np.arange(west, west + width + 1e-9, step), np.arange(south, south + depth + 1e-9, step))
    return np.column_stack([x.ravel(), y.ravel()])


def traced(points, max_edge=2.0):
    triangulation = triangulated(points)
    return None if triangulation is None else trace_outlines(points, max_edge, triangulation)


def test_square():
    tracing = traced(even(600_000, 5_000_000, 10, 6))
    (ring,) = tracing.parts
    assert signed_area(ring) == pytest.approx(60)
    assert perimeter(ring) == pytest.approx(32)


def test_a_hole_is_filled():
    points = even(0, 0, 20, 20)
    points = points[(np.abs(points - 10) > 4).any(axis=1)]
    tracing = traced(points)
    (ring,) = tracing.parts
    assert_valid([ring])
    assert signed_area(ring) == pytest.approx(400)
    assert tracing.areas[tracing.face >= 0].sum() == pytest.approx(400)


def test_gap_parts_and_joins():
    points = np.concatenate([even(0, 0, 5, 5), even(8, 0, 5, 5)])
    assert len(traced(points).parts) == 2
    (joined,) = traced(points, max_edge=3.5).parts
    assert signed_area(joined) == pytest.approx(65)


def test_parts_that_touch_in_one_point_are_two():
    points = np.concatenate([even(0, 0, 4, 4), even(4, 4, 4, 4)])
    found = traced(np.unique(points, axis=0), max_edge=0.75).parts
    for ring in found:
        assert_valid([ring])
    assert sum(map(signed_area, found)) == pytest.approx(32, abs=0.3)


@pytest.mark.parametrize("max_edge", [0.7, 1.0, 1.5, 3.0])
def test_any_pattern_gives_valid_rings_around_the_kept_triangles(rng, max_edge):
    points = rng.uniform(0, 12, (350, 2))
    tracing = traced(points, max_edge)
    for ring in tracing.parts:
        assert_valid([ring])
    corners = points[Delaunay(points - points.mean(axis=0)).simplices]
    short = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1) <= max_edge
    assert (tracing.face[short] >= 0).all()
    # A piece that touches itself in a point has smaller rings next to its largest one.
    within = np.bincount(tracing.face[tracing.face >= 0], tracing.areas[tracing.face >= 0])
    around = np.array([signed_area(ring) for ring in tracing.parts])
    assert (around <= within + 1e-9).all()
    assert np.median(around / within) == pytest.approx(1)


def test_point_order_changes_nothing(rng):
    points = rng.uniform(0, 12, (350, 2))
    order = rng.permutation(350)
    areas = [sorted(map(signed_area, traced(p, 1.3).parts)) for p in (points, points[order])]
    assert areas[0] == pytest.approx(areas[1])


@pytest.mark.parametrize(
    "points", [np.zeros((0, 2)), [[1, 2]], [[0, 0], [1, 1]], np.ones((9, 2)), [[0, 0], [1, 1], [2, 2]]]
)
def test_points_without_area_have_no_outline(points):
    assert traced(np.asarray(points, float).reshape(-1, 2)) is None
