"""The validator of solids: what it lets pass, and what not."""

import numpy as np
import pytest

from lidar_buildings.tests.solid_validity import (
    CUBE,
    SIDES,
    assert_valid_solid,
    assert_vertices_have_one_umbrella,
)


def test_a_cube_is_valid_and_an_open_one_is_not():
    assert_valid_solid(CUBE, [[ring] for ring in SIDES])
    with pytest.raises(AssertionError, match="open"):
        assert_valid_solid(CUBE, [[ring] for ring in SIDES[1:]])


def test_cubes_that_touch_in_a_corner_are_not_one_solid():
    # The second cube's corner 0 is the first one's corner 7.
    vertices = np.concatenate([CUBE, CUBE[1:] + 1])
    faces = [[ring] for ring in SIDES] + [[[7 + vertex for vertex in ring]] for ring in SIDES]
    with pytest.raises(AssertionError, match="touch in vertex 7 only"):
        assert_valid_solid(vertices, faces)


def test_a_hole_may_touch_the_edge_of_its_face():
    """The top has a pit with four sides, a corner of which is a corner of the top."""
    vertices = np.concatenate([CUBE, [[0.2, 0.5, 1], [0.6, 0.6, 1], [0.5, 0.2, 1], [0.3, 0.3, 0.5]]])
    hole = [4, 8, 9, 10]
    pit = [[[after, before, 11]] for before, after in zip(hole, [*hole[1:], hole[0]])]
    faces = [[ring] for ring in SIDES]
    faces[1].append(hole)
    assert_valid_solid(vertices, faces + pit)


def test_a_repeated_vertex_does_not_go_on_forever():
    faces = [[ring] for ring in SIDES]
    faces[0] = [[0, 2, 0, 3, 1]]
    with pytest.raises(AssertionError):
        assert_vertices_have_one_umbrella(CUBE, faces)
