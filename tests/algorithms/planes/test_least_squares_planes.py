"""Planes kept as moments, against numpy's own decompositions."""

import numpy as np
import pytest

from lidar_buildings.algorithms.planes import least_squares_planes
from lidar_buildings.algorithms.planes.least_squares_planes import planes_of


@pytest.fixture
def patches(rng):
    """Five rough patches of different sizes and directions, far from the origin, and the patch of each point."""
    parts = []
    for size in (3, 10, 40, 100, 7):
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        parts.append(rng.normal(size=(size, 3)) * [3, 1, 0.1] @ turn + rng.uniform(-50, 50, 3) + [6e5, 5e6, 0])
    xyz, group = np.concatenate(parts), np.repeat(np.arange(5), [len(part) for part in parts])
    order = rng.permutation(len(xyz))
    return xyz[order], group[order]


def test_planes_are_those_of_a_singular_value_decomposition(patches):
    xyz, group = patches
    planes = planes_of(xyz, group, 5)
    for number in range(5):
        points = xyz[group == number]
        centered = points - points.mean(axis=0)
        _, size, axes = np.linalg.svd(centered)
        np.testing.assert_allclose(planes.center[number], points.mean(axis=0), rtol=1e-12)
        np.testing.assert_allclose(planes.eigenvalues[number], size**2 / len(points), rtol=1e-5, atol=1e-9)
        assert abs(planes.normal[number] @ axes[2]) == pytest.approx(1, abs=1e-6)
        assert planes.normal[number, 2] >= 0
        off = np.abs(centered @ axes[2])
        np.testing.assert_allclose(planes.distance(points, np.full(len(points), number)), off, atol=1e-6)


def test_deviation_is_the_root_mean_square_distance(patches):
    xyz, group = patches
    planes = planes_of(xyz, group, 5)
    points, plane = np.divmod(np.arange(25), 5)
    expected = [
        np.sqrt(np.mean(((xyz[group == i] - planes.center[j]) @ planes.normal[j]) ** 2)) for i, j in zip(points, plane)
    ]
    np.testing.assert_allclose(planes.deviation(points, plane), expected, rtol=1e-6, atol=1e-6)


def test_merged_planes_are_those_of_the_merged_points(patches):
    xyz, group = patches
    into = np.array([0, 1, 0, 1, 1])
    merged, expected = planes_of(xyz, group, 5).merged(into, 2), planes_of(xyz, into[group], 2)
    np.testing.assert_array_equal(merged.count, expected.count)
    np.testing.assert_allclose(merged.center, expected.center, rtol=1e-12)
    np.testing.assert_allclose(merged.covariance, expected.covariance, rtol=1e-6, atol=1e-6)


def test_area_is_that_of_the_rectangle(rng):
    xyz = np.column_stack([rng.uniform(0, 6, 20_000), np.zeros(20_000), rng.uniform(0, 4, 20_000)])
    assert planes_of(xyz, np.zeros(20_000, int), 1).area[0] == pytest.approx(24, rel=0.02)


def test_planes_of_points_in_chunks_are_those_of_all_at_once(patches, monkeypatch):
    xyz, group = patches
    whole = planes_of(xyz, group, 5)
    monkeypatch.setattr(least_squares_planes, "NEIGHBORS_AT_ONCE", 7)
    for planes in (planes_of(xyz, group, 5), planes_of(np.repeat(xyz, 2, axis=0), group, 5, 2 * np.arange(len(xyz)))):
        np.testing.assert_array_equal(planes.count, whole.count)
        np.testing.assert_allclose(planes.center, whole.center, rtol=1e-14)
        np.testing.assert_allclose(planes.covariance, whole.covariance, rtol=1e-6, atol=1e-9)
