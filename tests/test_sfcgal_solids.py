"""What SFCGAL refuses, and that our triangles of faces are its own."""

import numpy as np
import pytest

from lidar_buildings.algorithms.models3d.face_triangles import triangulate_face
from lidar_buildings.tests.sfcgal_solids import assert_valid_for_sfcgal, triangulated
from lidar_buildings.tests.solid_validity import CUBE, SIDES


def test_sfcgal_sees_a_spike_through_the_bottom():
    """The tip of an upturned pyramid in the top of a cube lies below its bottom."""
    sides = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]]
    vertices = np.concatenate([CUBE, [[0.5, 0.5, -0.5]]])
    faces = [[ring] for ring in [SIDES[0], *SIDES[2:], *sides]]
    with pytest.raises(AssertionError, match="self intersects"):
        assert_valid_for_sfcgal(vertices, faces)


def test_a_triangle_upright_on_a_face_is_refused():
    """A corner 2 mm above the top and 5 mm next to another one turns a triangle by 22°."""
    vertices = np.concatenate([CUBE, [[0.995, 1, 1.002]]])
    faces = [SIDES[0], [4, 5, 7, 8, 6], *SIDES[2:4], [3, 2, 6, 8, 7], SIDES[5]]
    with pytest.raises(AssertionError, match="a triangle turns by"):
        assert_valid_for_sfcgal(vertices, [[ring] for ring in faces])


@pytest.mark.parametrize("seed", range(5))
def test_triangles_are_those_of_cgal(seed):
    """A sloping star with a hole: of all triangulations, the constrained Delaunay one has the widest angles."""
    rng = np.random.default_rng(seed)
    angle = np.arange(24) * 2 * np.pi / 24
    reach = np.concatenate([rng.uniform(4, 9, 24), rng.uniform(1, 3, 24)])
    xy = reach[:, None] * np.column_stack([np.cos([*angle, *angle]), np.sin([*angle, *angle])])
    vertices = np.column_stack([xy, xy @ [0.5, 0.2]])
    rings = [list(range(24)), list(range(47, 23, -1))]
    ours, theirs = (
        {frozenset(corners) for corners in made(vertices, rings)} for made in (triangulate_face, triangulated)
    )
    assert len(ours) == 24 + 24
    assert ours == theirs
