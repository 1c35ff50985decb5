"""Walls moved so that polygons have their areas: borders stay common and edges keep their directions."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.kept_areas import with_areas
from lidar_buildings.algorithms.geometry.rings import polygon_area
from lidar_buildings.tests.polygon_validity import assert_valid


def box(west, south, east, north, *more):
    """Return a closed ring around a box, with more vertices (x, y) on its sides after its first corner."""
    return np.array([[west, south], *more, [east, south], [east, north], [west, north], [west, south]], float)


def directions(ring):
    """Return the directions of edges, modulo 180°."""
    return np.degrees(np.arctan2(*np.diff(ring, axis=0).T[::-1])) % 180


def test_neighbors_keep_a_common_border():
    """A wide house under two: the vertex in the middle of its wall belongs to all three."""
    below, left, right = box(0, 0, 10, 4), box(0, 4, 5, 9), box(5, 4, 10, 9)
    below = np.insert(below, 3, [5, 4], axis=0)
    wanted = np.array([43.0, 24.0, 26.0])
    made = with_areas([[below], [left], [right]], wanted)
    assert [polygon_area(rings) for rings in made] == pytest.approx(wanted, rel=1e-6)
    corners = [{tuple(place) for place in rings[0].tolist()} for rings in made]
    assert len(corners[0] & corners[1] & corners[2]) == 1
    assert len(corners[1] & corners[2]) == 2
    for rings, before in zip(made, (below, left, right)):
        assert_valid(rings)
        assert directions(rings[0]) == pytest.approx(directions(before), abs=1e-6)


def test_holes_take_part_and_right_areas_change_nothing():
    rings = [box(0, 0, 10, 10), box(4, 4, 6, 6)[::-1]]
    (same,) = with_areas([rings], np.array([96.0]))
    assert all((one == other).all() for one, other in zip(same, rings))
    (made,) = with_areas([rings], np.array([100.0]))
    assert polygon_area(made) == pytest.approx(100.0)
    assert abs(polygon_area([made[1]])) < 4
