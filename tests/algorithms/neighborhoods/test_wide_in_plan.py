"""Neighborhoods that cross scan lines, against brute force."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.neighborhoods.covariance import (
    PAIRS,
    Nearest,
    neighborhood_eigenvalues,
    reduce_neighborhoods,
    symmetric_eigenvalues,
)
from lidar_buildings.algorithms.neighborhoods.wide_in_plan import Wide
from lidar_buildings.tests.builders import FAR


def lines(rng, gap, along, side=20.0, slope=0.0, noise=0.01):
    """Return points of a plane on lines ``gap`` apart, ``along`` between the points of one."""
    x, y = np.meshgrid(np.arange(0, side, along), np.arange(0, side, gap))
    plan = np.column_stack([x.ravel(), y.ravel()]) + rng.normal(0, 0.01, (x.size, 2))
    return np.column_stack([plan, slope * plan[:, 1] + rng.normal(0, noise, len(plan))])


def found(neighborhood, xyz):
    """Return neighbors, centers, covariances of all points, and counts and covariances by another way."""
    tree, rows = cKDTree(xyz), np.arange(len(xyz))
    counts, covariances = np.zeros(len(xyz), int), np.empty((len(xyz), 6))

    def keep(some, shapes):
        counts[some] += shapes.counts
        covariances[some] = shapes.covariances

    reduce_neighborhoods(xyz, neighborhood, keep, tree)
    return (*neighborhood.moments(tree, rows), counts, covariances)


def by_hand(xyz, count):
    """Return the neighbors of each point, one count after the other until they are wide in plan."""
    chosen = []
    for point in xyz:
        order, k = np.argsort(np.linalg.norm(xyz - point, axis=1), kind="stable"), min(count, len(xyz))
        while True:
            small, large = np.linalg.eigvalsh(np.cov(xyz[order[:k], :2].T, bias=True))
            if small >= 0.45**2 * large or k == min(60, len(xyz)):
                break
            k = min(int(np.ceil(1.5 * k)), 60, len(xyz))
        chosen.append(order[:k])
    return chosen


@pytest.mark.parametrize("n_points", [400, 30])
def test_the_smallest_wide_neighborhood_is_that_of_brute_force(n_points, rng):
    crown = rng.normal(0, 1.5, (200, 3)) + [10, 10, 3]
    xyz = rng.permutation(np.concatenate([lines(rng, 1.5, 0.3, slope=0.6), crown]))[:n_points] + FAR
    neighbors, centers, covariances, counts, again = found(Wide(8), xyz)
    expected = by_hand(xyz - FAR, 8)
    np.testing.assert_array_equal(counts, [len(own) for own in expected])
    np.testing.assert_allclose(centers, [xyz[own].mean(axis=0) for own in expected], atol=1e-6)
    by_cov = [np.cov((xyz[own] - FAR).T, bias=True)[tuple(zip(*PAIRS))] for own in expected]
    np.testing.assert_allclose(covariances, by_cov, atol=1e-7)
    np.testing.assert_allclose(again, covariances, atol=1e-12)
    assert all(np.isin(named, own).all() for named, own in zip(neighbors, expected))
    assert (neighbors[:, 0] == np.arange(len(xyz))).all()
    assert len(np.unique(counts)) > 1, "else nothing was chosen"


def test_scattered_points_need_no_more_than_the_count(rng):
    xyz = rng.uniform(0, 20, (1000, 3)) * [1, 1, 0]
    counts = found(Wide(12), xyz)[3]
    assert np.median(counts) == 12


def test_a_line_alone_stays_one_and_ends_at_sixty():
    line = np.outer(np.arange(200.0), [1.0, 2.0, 0.5])
    counts = found(Wide(8), line)[3]
    assert (counts == 60).all()
    assert (found(Wide(8), line[:20])[3] == 20).all()
    assert (found(Wide(8), line[:5])[3] == 5).all()
    assert (found(Wide(80), line)[3] == 80).all()


def test_points_at_one_position_are_no_error():
    eigenvalues = neighborhood_eigenvalues(np.zeros((70, 3)), Wide(8))
    assert np.isnan(eigenvalues).all()


def test_normals_of_a_roof_on_scan_lines(rng):
    """A roof of 45° across lines 1.5 m apart: eight points of one line lie on any plane through it."""
    xyz = lines(rng, 1.5, 0.25, slope=1.0, noise=0.02)
    slopes = []
    for neighborhood in (Nearest(8), Wide(8)):
        covariances = neighborhood.moments(cKDTree(xyz), np.arange(len(xyz)))[2]
        full = covariances[:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(-1, 3, 3)
        normals = np.linalg.eigh(full)[1][:, :, 0]
        slopes.append(np.degrees(np.arccos(np.abs(normals[:, 2]))))
    assert np.mean(np.abs(slopes[0] - 45) < 3) < 0.2
    assert np.mean(np.abs(slopes[1] - 45) < 3) > 0.95


def test_lines_through_a_crown_are_volumes(rng):
    """On one scan line alone, a crown is an upright plane; points across the line show its scattering."""
    crown = rng.uniform(0, [12, 12, 8], (40_000, 3))
    crown = crown[np.abs(crown[:, 1] % 1.5 - 0.75) < 0.04]
    flat = [
        np.median(np.divide(*symmetric_eigenvalues(found(near, crown)[4])[:, [2, 0]].T))
        for near in (Nearest(12), Wide(12))
    ]
    assert flat[0] < 0.02
    assert flat[1] > 3 * flat[0]


def test_the_order_of_points_changes_nothing(rng):
    xyz, order = lines(rng, 1.5, 0.3), rng.permutation(14 * 67)
    here, there = found(Wide(8), xyz)[3], found(Wide(8), xyz[order])[3]
    np.testing.assert_array_equal(here[order], there)
