"""Triangles of faces with holes: their areas are the faces'."""

import numpy as np
import pytest

from lidar_buildings.algorithms.models3d.face_triangles import triangulate_face

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]


def area_of(places, rings):
    """Return the area of the triangles of a level face, and how many there are."""
    vertices = np.column_stack([places, np.zeros(len(places))]).astype(float)
    triangles = np.array(triangulate_face(vertices, rings))
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    return np.cross(b - a, c - a)[:, 2].sum() / 2, len(triangles)


def test_a_face_with_two_holes_is_covered_but_for_them():
    holes = [(1, 1), (1, 2), (2, 2), (2, 1)], [(2.5, 2.5), (2.5, 3), (3, 3), (3, 2.5)]
    rings = [list(range(4)), list(range(4, 8)), list(range(8, 12))]
    # Triangles of a polygon with holes: vertices + 2 * holes - 2.
    assert area_of([*SQUARE, *holes[0], *holes[1]], rings) == (pytest.approx(16 - 1 - 0.25), 12 + 4 - 2)


@pytest.mark.parametrize("touches", [(4, 2), (4, 4)])
def test_a_hole_that_touches_the_boundary_stays_a_hole(touches):
    """A vertex of the hole lies on an edge or at a vertex of the boundary, which it sees at no angle."""
    hole = [touches, (2, 1.5), (1.5, 2), (2, 2.5)]
    x, y = np.array(hole, float).T
    size = abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
    rings = [list(range(4)), list(range(4, 8))]
    assert area_of([*SQUARE, *hole], rings)[0] == pytest.approx(16 - size)
