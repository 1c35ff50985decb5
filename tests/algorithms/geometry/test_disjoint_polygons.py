"""What two polygons share is divided by the points in it."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.disjoint_polygons import divide_overlap
from lidar_buildings.algorithms.geometry.rings import signed_area


def box(west, south, east, north):
    return np.array([(west, south), (east, south), (east, north), (west, north), (west, south)], float)


def areas(rings):
    return sorted(round(signed_area(ring), 3) for ring in rings)


ONE, OTHER = [box(0, 0, 10, 5)], [box(8, 1, 20, 4)]
IN_ONE, IN_BOTH = np.array([[5.0, 2.0]]), np.array([[9.0, 2.0]])


@pytest.mark.parametrize("shift", [0.0, 6e5])
def test_what_is_shared_stays_where_more_points_are(shift):
    one, other = ([ring + shift for ring in rings] for rings in (ONE, OTHER))
    left_of_one, left_of_other = divide_overlap(one, other, IN_ONE + shift, IN_BOTH + shift)
    assert areas(left_of_one) == [44.0]
    assert left_of_other is other
    left_of_one, left_of_other = divide_overlap(one, other, IN_BOTH + shift, IN_ONE + shift)
    assert left_of_one is one
    assert areas(left_of_other) == [30.0]


def test_what_touches_or_lies_apart_stays():
    for other in ([box(10, 0, 20, 5)], [box(30, 0, 40, 5)]):
        assert divide_overlap(ONE, other, IN_ONE, IN_BOTH) == (ONE, other)


def test_a_polygon_within_another_cuts_a_hole_or_goes():
    inner = [box(2, 1, 4, 3)]
    left_of_one, left_of_inner = divide_overlap(ONE, inner, IN_BOTH, np.array([[3.0, 2.0]]))
    assert areas(left_of_one) == [-4.0, 50.0]
    assert left_of_inner is inner
    assert divide_overlap(ONE, inner, np.array([[3.0, 2.0]]), IN_BOTH)[1] == []


def test_each_piece_stays_with_its_own_points_and_a_polygon_may_fall_into_parts():
    across = [box(2, -2, 4, 8), box(6, -2, 8, 8)]
    points = np.array([[3.0, 2.0]])
    left_of_one, left_of_across = divide_overlap(ONE, across, IN_ONE, points)
    assert areas(left_of_one) == [10.0, 30.0]
    # The second strip has no points in the first polygon, where both have none it stays.
    assert areas(left_of_across) == [4.0, 6.0, 20.0]
