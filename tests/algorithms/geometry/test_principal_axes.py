"""Lines and planes of least squares, against the singular values of the points."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.principal_axes import principal_axes


@pytest.mark.parametrize("d", [2, 3])
def test_they_are_the_right_singular_vectors(d, rng):
    points = rng.normal(size=(40, d)) * [5.0, 1.0, 0.1][:d] @ np.linalg.qr(rng.normal(size=(d, d)))[0] + 1e4
    center, variances, axes = principal_axes(points)
    np.testing.assert_allclose(center, points.mean(axis=0), rtol=1e-12)
    _, size, rows = np.linalg.svd(points - points.mean(axis=0))
    np.testing.assert_allclose(variances, size[::-1] ** 2 / 40, rtol=1e-6)
    np.testing.assert_allclose(np.abs(np.einsum("ij,ji->i", rows[::-1], axes)), 1.0, atol=1e-9)


def test_of_one_point_the_variances_are_zero():
    assert principal_axes(np.array([[3.0, 4.0]]))[1].tolist() == [0.0, 0.0]
