"""Vectors across polygons in space, by triangles that cover them."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.polygons import area_vector, axes_across

L = np.array([[0, 0, 0], [4, 0, 2], [4, 2, 2], [2, 2, 1], [2, 5, 1], [0, 5, 0]], float)


def test_the_vector_is_as_long_as_the_area_and_the_same_for_a_closed_ring():
    # In plan 2 · 5 + 2 · 2 = 14 m², on a slope of one in two.
    assert area_vector(L) == pytest.approx([-7, 0, 14])
    assert area_vector(np.concatenate([L, L[:1]]) + 1e5) == pytest.approx([-7, 0, 14])
    assert area_vector(L[::-1]) == pytest.approx([7, 0, -14])


def test_axes_and_normal_are_square_and_right_handed(rng):
    normals = rng.normal(size=(20, 3))
    for normal in normals / np.linalg.norm(normals, axis=1, keepdims=True):
        axes = np.stack([*axes_across(normal), normal])
        assert axes @ axes.T == pytest.approx(np.eye(3))
        assert np.linalg.det(axes) == pytest.approx(1)
