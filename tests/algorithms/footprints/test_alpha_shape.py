"""Outlines of point patterns whose outline is known, and a division of any pattern among its labels."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from lidar_buildings.algorithms.footprints.alpha_shape import trace_outlines, without_inside
from lidar_buildings.algorithms.geometry.rings import perimeter, signed_area
from lidar_buildings.tests.polygon_validity import assert_valid


def even(west, south, width, depth, step=0.5):
    x, y = np.meshgrid(np.arange(west, west + width + 1e-9, step), np.arange(south, south + depth + 1e-9, step))
    return np.column_stack([x.ravel(), y.ravel()])


def traced(points, spacing=0.5, label=None, **kwargs):
    return trace_outlines(points, np.ones(len(points), int) if label is None else label, spacing, **kwargs)


def test_square():
    tracing = traced(even(600_000, 5_000_000, 10, 6))
    ((ring,),) = tracing.parts
    assert signed_area(ring) == pytest.approx(60)
    assert perimeter(ring) == pytest.approx(32)


def test_courtyard_is_a_hole():
    points = even(0, 0, 20, 20)
    points = points[(np.abs(points - 10) > 4).any(axis=1)]
    ((exterior, hole),) = traced(points).parts
    assert_valid([exterior, hole])
    assert signed_area(exterior) == pytest.approx(400)
    assert signed_area(hole) == pytest.approx(-81, rel=0.05)  # from 5.5 to 14.5, corners rounded
    assert len(traced(points, min_hole_area=60.0).parts[0]) == 2
    assert len(traced(points, min_hole_area=90.0).parts[0]) == 1


@pytest.mark.parametrize("step", [0.0, 0.8])
def test_outlines_are_the_same_without_the_points_inside(rng, step):
    """A roof with a courtyard and a notch, its points by chance or on scan lines that make longer edges."""
    points = rng.uniform(0, 30, (36_000, 2))
    if step:
        points = points[np.abs(points[:, 1] % step - step / 2) < 0.1]
    points = points[(np.abs(points - 15) > 3).any(axis=1) & ~((points[:, 0] > 20) & (points[:, 1] > 24))]
    spacing = 0.9 / np.sqrt(len(points) / 820)
    few, stands_for = without_inside(points, spacing)
    assert len(few) < (0.6 if not step else 1.01) * len(points)
    assert stands_for.sum() + (stands_for == 0).sum() == len(points)
    whole, part = traced(points, spacing), traced(few, spacing, stands_for=stands_for)
    assert part.max_edge == pytest.approx(whole.max_edge, rel=0.05)
    for one, other in zip(
        whole.parts[0][:1] + [min(whole.parts[0][1:], key=signed_area)],
        part.parts[0][:1] + [min(part.parts[0][1:], key=signed_area)],
    ):
        assert {tuple(place) for place in one} == {tuple(place) for place in other}


def test_gap_parts_and_joins():
    points = np.concatenate([even(0, 0, 5, 5), even(8, 0, 5, 5)])
    assert len(traced(points).parts) == 2
    ((joined,),) = traced(points, max_edge=3.5).parts
    assert signed_area(joined) == pytest.approx(65)


def test_bare_points_keep_houses_apart_that_are_nearer_than_the_longest_edge():
    points = np.concatenate([even(0, 0, 5, 5), even(6.5, 0, 5, 5), even(5.75, 0, 0, 5)])
    label = np.repeat([1, 1, 0], [121, 121, 11])
    assert len(traced(points[:242]).parts) == 1
    both = traced(points, label=label)
    assert [signed_area(rings[0]) for rings in both.parts] == pytest.approx([25, 25])


def test_parts_that_touch_in_one_point_are_two():
    points = np.concatenate([even(0, 0, 4, 4), even(4, 4, 4, 4)])
    found = traced(np.unique(points, axis=0), max_edge=0.75).parts
    for rings in found:
        assert_valid(rings)
    assert sum(signed_area(rings[0]) for rings in found) == pytest.approx(32, abs=0.3)


def test_scan_lines_far_apart_stay_together():
    # Points every 10 cm on lines that are 1 m apart: the mean spacing is 0.32 m.
    x, y = np.meshgrid(np.arange(0, 10, 0.1), np.arange(0, 10, 1.0))
    found = traced(np.column_stack([x.ravel(), y.ravel()]), 0.32).parts
    assert [len(rings) for rings in found] == [1]
    assert signed_area(found[0][0]) == pytest.approx(9.9 * 9, rel=0.01)


def test_neighbors_share_their_border_half_way():
    # Rows at 0, 0.5, ..., 4.5 and 5, 5.5, ..., 9.5: the border lies between 4.5 and 5.
    points = even(0, 0, 9.5, 6)
    tracing = traced(points, label=1 + (points[:, 0] > 4.75))
    left, right = (signed_area(rings[0]) for rings in tracing.parts)
    assert left + right == pytest.approx(9.5 * 6)
    assert 4.5 * 6 <= left <= 5 * 6
    across = tracing.beyond(tracing.face)
    inner = np.flatnonzero((np.repeat(tracing.face, 3) == 0) & (across == 1))
    assert (tracing.outset[inner] == 0).all()
    assert set(points[tracing.starts[inner], 0].tolist()) <= {4.5, 5.0}


def test_a_piece_that_is_too_small_goes_to_the_building_around_it():
    points = even(0, 0, 10, 10)
    label = 1 + (np.abs(points - 5) < 0.8).all(axis=1)
    assert traced(points, label=label).labels.tolist() == [1, 2]
    merged = traced(points, label=label, min_area=4.0)
    assert merged.labels.tolist() == [1]
    assert signed_area(merged.parts[0][0]) == pytest.approx(100)
    assert traced(even(0, 0, 1, 1), min_area=4.0).labels.tolist() == []


def test_a_roof_ends_half_way_to_the_ground_and_never_beyond_it():
    """Of points on both sides of a wall at x = 5, the samples lie around that wall, wherever the points are."""
    rng = np.random.default_rng(3)
    points = rng.uniform(0, 10, (4000, 2))
    tracing = traced(points, 0.16, label=(points[:, 0] < 5).astype(int))
    face, across = np.repeat(tracing.face, 3), tracing.beyond(tracing.face)
    edges = np.flatnonzero((face >= 0) & (across < 0))
    middle = (points[tracing.starts[edges]] + points[tracing.ends[edges]]) / 2
    edges = edges[(middle[:, 0] > 4.5) & (np.abs(middle[:, 1] - 5) < 4.5)]
    a, b = points[tracing.starts[edges]], points[tracing.ends[edges]]
    reached = (a + b)[:, 0] / 2 + tracing.outset[edges] * (b - a)[:, 1] / np.hypot(*(b - a).T)
    assert np.average(reached, weights=np.hypot(*(b - a).T)) == pytest.approx(5, abs=0.02)


@pytest.mark.parametrize("max_edge", [0.7, 1.0, 1.5, 3.0])
def test_any_pattern_gives_valid_polygons_of_the_kept_triangles(rng, max_edge):
    points = rng.uniform(0, 12, (350, 2))
    found = traced(points, 0.64, max_edge=max_edge).parts
    for rings in found:
        assert_valid(rings)
    # Independent: the area of all triangles without a long edge.
    corners = points[Delaunay(points).simplices]
    short = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1) <= max_edge
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    expected = 0.5 * np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])[short].sum()
    assert sum(signed_area(ring) for rings in found for ring in rings) == pytest.approx(expected, rel=1e-6)


def test_point_order_changes_nothing(rng):
    points = rng.uniform(0, 12, (350, 2))
    order = rng.permutation(350)
    areas = [sorted(sum(map(signed_area, rings)) for rings in traced(p, 0.64).parts) for p in (points, points[order])]
    assert areas[0] == pytest.approx(areas[1])


@pytest.mark.parametrize(
    "points", [np.zeros((0, 2)), [[1, 2]], [[0, 0], [1, 1]], np.ones((9, 2)), [[0, 0], [1, 1], [2, 2]]]
)
def test_points_without_area_have_no_outline(points):
    assert traced(np.asarray(points, float).reshape(-1, 2)) is None
