"""Eigenvalues against LAPACK, neighborhoods against brute force, known shapes against their known values."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.neighborhoods import covariance as eigen
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.monitors import Listening

COVARIANCE_FACTORS = arrays(np.float64, (8, 3, 3), elements=st.floats(-100, 100).map(lambda number: round(number, 6)))


def six(matrices):
    return np.stack([matrices[:, a, b] for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))], axis=1)


def brute_covariances(xyz, neighbors):
    local = xyz - xyz[0]
    return np.array([np.cov(local[rows].T, bias=True) for rows in neighbors])


@settings(max_examples=150)
@given(COVARIANCE_FACTORS)
def test_eigenvalues_are_those_of_lapack(factors):
    matrices = factors @ factors.transpose(0, 2, 1)
    expected = np.maximum(np.linalg.eigvalsh(matrices)[:, ::-1], 0)
    found = eigen.symmetric_eigenvalues(six(matrices))
    assert (np.abs(found - expected) <= 1e-12 * expected[:, :1] + 1e-200).all()


def exact_covariance(xyz):
    """Return the covariance (3 x 3) of points in fractions: floats are fractions, so that nothing is rounded."""
    points = [[Fraction(float(value)) for value in point] for point in xyz]
    n = len(points)
    mean = [sum(column) / n for column in zip(*points)]
    return [[sum((p[a] - mean[a]) * (p[b] - mean[b]) for p in points) / n for b in range(3)] for a in range(3)]


def eigenvalues_above(matrix, bound):
    """Return how many eigenvalues are larger, exactly: all roots are real, so the polynomial's signs count them."""
    a, b, c = (matrix[i][i] - bound for i in range(3))
    d, e, f = matrix[0][1], matrix[0][2], matrix[1][2]
    polynomial = (
        Fraction(1),
        -(a + b + c),
        a * b + a * c + b * c - d * d - e * e - f * f,
        -(a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)),
    )
    signs = [value > 0 for value in polynomial if value]
    return sum(one != other for one, other in zip(signs, signs[1:]))


WHOLE = st.integers(-2000, 2000)


@settings(max_examples=150)
@given(
    arrays(np.int64, (9, 3), elements=WHOLE),
    arrays(np.int64, (3, 3), elements=st.integers(-30, 30)),
    st.integers(0, 3),
    st.sampled_from([0.0, 2.0**-20, 1.0]),
)
def test_eigenvalues_are_exact_for_points_lines_planes_and_volumes_far_away(steps, axes, rank, thickness):
    """Nine points in UTM, of steps of 1/1024 m along up to three axes, a micron of a third one among them."""
    local = (steps[:, :rank] @ axes[:rank]).astype(float) / 1024
    if rank == 3:
        local = ((steps[:, :2] @ axes[:2]) + thickness * steps[:, 2:] * axes[2]) / 1024
    xyz = local + [600_000, 5_000_000, 100]
    exact = exact_covariance(xyz)
    found = eigen.neighborhood_eigenvalues(xyz, eigen.Nearest(9))
    size = sum(exact[i][i] for i in range(3))
    if size == 0:
        assert np.isnan(found).all()
        return
    tolerance = size * Fraction(1, 10**13)
    for row in np.unique(found, axis=0):
        for i, value in enumerate(row):
            assert eigenvalues_above(exact, Fraction(float(value)) - tolerance) >= i + 1
            assert eigenvalues_above(exact, Fraction(float(value)) + tolerance) <= i


@settings(max_examples=150)
@given(COVARIANCE_FACTORS)
def test_normals_are_unit_eigenvectors_upward(factors):
    matrices = factors @ factors.transpose(0, 2, 1)
    covariances = six(matrices)
    eigenvalues = eigen.defined_eigenvalues(covariances, np.full(len(matrices), 9))
    normals = eigen.smallest_eigenvectors(covariances, eigenvalues)
    defined = ~np.isnan(eigenvalues[:, 0])
    assert np.isnan(normals[~defined]).all()
    normals, matrices, eigenvalues = normals[defined], matrices[defined], eigenvalues[defined]
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, rtol=1e-12)
    assert (normals[:, 2] >= 0).all()
    residual = np.einsum("nij,nj->ni", matrices, normals) - eigenvalues[:, 2:] * normals
    assert (np.abs(residual) <= 1e-8 * eigenvalues[:, :1]).all()


@pytest.mark.parametrize(
    ("diagonal", "expected"),
    [
        ((4, 0, 0), (4, 0, 0)),
        ((0, 3, 3), (3, 3, 0)),
        ((2, 2, 2), (2, 2, 2)),
        ((0, 0, 0), (0, 0, 0)),
        ((1, 5, 3), (5, 3, 1)),
        ((1e-12, 2e-12, 0), (2e-12, 1e-12, 0)),
        ((1, 1e-9, 1e-9), (1, 1e-9, 1e-9)),
    ],
)
def test_special_shapes_are_exact(diagonal, expected):
    found = eigen.symmetric_eigenvalues(np.array([[*diagonal, 0, 0, 0]], dtype=float))
    np.testing.assert_allclose(found[0], expected, rtol=0, atol=4e-15 * max(expected))


def test_line_square_and_coincident_points():
    line = np.column_stack([np.arange(20) * 0.5, np.zeros(20), np.zeros(20)]) + [6e5, 5e6, 100]
    first, second, third = eigen.neighborhood_eigenvalues(line, eigen.Nearest(5)).T
    assert first == pytest.approx(np.full(20, 0.5))  # 0.5² (4 + 1 + 0 + 1 + 4) / 5
    assert second == pytest.approx(0, abs=1e-15)
    assert third == pytest.approx(0, abs=1e-15)
    assert np.isnan(eigen.neighborhood_eigenvalues(np.ones((10, 3)), eigen.Nearest(5))).all()
    assert np.isnan(eigen.neighborhood_eigenvalues(line[:2], eigen.Nearest(5))).all()
    assert np.isnan(eigen.neighborhood_eigenvalues(line[:1], eigen.Nearest(1))).all()


def test_nearest_neighborhoods_are_those_of_brute_force(rng):
    xyz = rng.uniform(0, 10, (300, 3)) + [600_000, 5_000_000, 0]
    distance = np.linalg.norm(xyz[:, None] - xyz, axis=2)
    covariances = brute_covariances(xyz, np.argsort(distance, axis=1)[:, :12])
    expected = np.linalg.eigvalsh(covariances)[:, ::-1]
    np.testing.assert_allclose(eigen.neighborhood_eigenvalues(xyz, eigen.Nearest(12)), expected, atol=1e-12)


def test_radius_neighborhoods_are_those_of_brute_force(rng):
    xyz = rng.uniform(0, 10, (300, 3)) + [600_000, 5_000_000, 0]
    near = np.linalg.norm(xyz[:, None] - xyz, axis=2) <= 2.0
    found, counted = np.empty((300, 6)), np.zeros(300, int)

    def keep(rows, shapes):
        found[rows] = shapes.covariances
        counted[rows] += shapes.counts

    eigen.reduce_neighborhoods(xyz, eigen.Within(2.0), keep)
    assert (counted == near.sum(axis=1)).all()
    several = counted > 1
    expected = six(brute_covariances(xyz, [np.flatnonzero(row) for row in near[several]]))
    np.testing.assert_allclose(found[several], expected, atol=1e-12)


def test_chunks_and_point_order_change_nothing(rng, monkeypatch):
    xyz = rng.uniform(0, 10, (500, 3))
    whole = eigen.neighborhood_eigenvalues(xyz, eigen.Nearest(10), cKDTree(xyz))
    monkeypatch.setattr(eigen, "NEIGHBORS_AT_ONCE", 64)
    order = rng.permutation(500)
    np.testing.assert_allclose(eigen.neighborhood_eigenvalues(xyz[order], eigen.Nearest(10)), whole[order], atol=1e-13)


def test_entropy_of_equation_6_by_hand():
    eigenvalues = np.array([[1.0, 0, 0], [1, 1, 0], [1, 1, 1], [4, 2, 1], [np.nan] * 3])
    mixed = -(0.5 * np.log(0.5) + 0.25 * np.log(0.25) + 0.25 * np.log(0.25))
    np.testing.assert_allclose(eigen.shannon_entropy_lps(eigenvalues), [0, 0, 0, mixed, np.nan], atol=1e-15)


def test_a_radius_chosen_by_mistake_is_refused(rng, monkeypatch):
    monkeypatch.setattr(eigen, "_MAX_MEAN_NEIGHBORS", 50)
    xyz = rng.uniform(0, 1, (200, 3))
    with pytest.raises(ValueError, match=r"A radius of 9 m holds 200 points on average, more than 50; choose"):
        eigen.reduce_neighborhoods(xyz, eigen.Within(9.0), lambda *_: None)


def test_cancel_stops_the_threads(rng, monkeypatch):
    monkeypatch.setattr(eigen, "NEIGHBORS_AT_ONCE", 100)
    ran = []

    with pytest.raises(Cancelled):
        eigen.reduce_neighborhoods(
            rng.uniform(0, 9, (5000, 3)),
            eigen.Nearest(10),
            lambda rows, *_: ran.append(rows),
            monitor=Listening(stop_at=0.0),
        )
    assert len(ran) < 500
