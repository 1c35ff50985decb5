"""Shapes from blocks against brute force: any density, equal distances, precision, any batches."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.neighborhoods import nearest_blocks as blocks

UTM = np.array([600_000, 5_000_000, 100.0])


def nearest(xyz, count, extents=True, rows=None):
    tree = cKDTree(xyz)
    rows = tree.indices if rows is None else rows
    return blocks.nearest_shapes(np.ascontiguousarray(xyz.T), tree, rows, count, extents), rows


def within(xyz, radius, extents=True):
    tree = cKDTree(xyz)
    return blocks.shapes_within(np.ascontiguousarray(xyz.T), tree, tree.indices, radius, extents), tree.indices


def weights(xyz, point, count):
    """Return the weight of each point among the nearest: equally far points share the remaining weight."""
    distances = np.linalg.norm(xyz - point, axis=1)
    last = np.sort(distances)[count - 1]
    equal = np.abs(distances - last) <= 5e-8 * last
    below = (distances < last) & ~equal
    return below + equal * (count - below.sum()) / equal.sum()


def covariance(xyz, weight):
    weight = weight / weight.sum()
    off = xyz - weight @ xyz
    full = (off * weight[:, None]).T @ off
    return full[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def check(xyz, shapes, order, weigh, rows):
    position = dict(zip(order, range(len(order))))
    for row in rows:
        weight = weigh(xyz[row])
        inside, found = weight > 0, position[row]
        off = xyz[inside] - xyz[row]
        expected = covariance(xyz - xyz[row], weight)
        np.testing.assert_allclose(shapes.covariances[found], expected, rtol=0, atol=1e-12 * expected[:3].sum())
        assert shapes.counts[found] == round(weight.sum())
        assert shapes.height_range[found] == pytest.approx(np.ptp(off[:, 2]), abs=1e-9)
        assert shapes.plan_radius[found] == pytest.approx(np.hypot(off[:, 0], off[:, 1]).max(), abs=1e-9)


@pytest.fixture
def scene(rng):
    """A dense roof next to sparse ground, a wall, a crown, a wire and points on their own, in coordinates of UTM."""
    plan = rng.uniform(0, 1, (900, 2))
    parts = [
        np.column_stack([plan * 30, 0.02 * rng.normal(size=900)]),
        np.column_stack([plan * 3 + 12, 6 + plan[:, 0]]),
        np.column_stack([np.full(900, 9.0), plan * 5]),
        rng.normal(0, 2, (700, 3)) + [20, 5, 8],
        np.column_stack([np.linspace(0, 30, 200), np.full(200, 3.0), np.full(200, 9.0)]),
        rng.uniform(-300, 300, (20, 3)),
    ]
    return np.concatenate(parts) + UTM


@pytest.mark.parametrize("count", [1, 3, 10, 50, 120])
def test_nearest_points_are_those_of_brute_force(scene, count):
    """At the edges of the roof, the wall and the cloud some neighbors are no candidates of the block."""
    shapes, order = nearest(scene, count)
    rows = [*range(0, len(scene), 29), *range(len(scene) - 20, len(scene))]
    check(scene, shapes, order, lambda point: weights(scene, point, count), rows)


@pytest.mark.parametrize("radius", [0.4, 2.0, 40.0])
def test_points_within_a_radius_are_those_of_brute_force(scene, radius):
    shapes, order = within(scene, radius)
    rows = [*range(0, len(scene), 29), *range(len(scene) - 20, len(scene))]
    check(scene, shapes, order, lambda point: (np.linalg.norm(scene - point, axis=1) <= radius) * 1.0, rows)


@pytest.mark.parametrize("count", [5, 10, 50])
def test_equally_far_points_share_what_is_left(rng, count):
    """On a grid, whatever the order, a neighborhood keeps the symmetry of the grid."""
    grid = np.stack(np.meshgrid(*[np.arange(13)] * 3), -1).reshape(-1, 3) * 0.1 + UTM
    shapes, order = nearest(grid, count)
    check(grid, shapes, order, lambda point: weights(grid, point, count), range(0, len(grid), 41))
    middle = np.flatnonzero((np.abs(grid[order] - UTM - 0.6) < 0.01).all(axis=1))
    variances, products = np.split(shapes.covariances[middle[0]], 2)
    np.testing.assert_allclose(variances, variances[0], rtol=1e-7)
    np.testing.assert_allclose(products, 0, atol=1e-10)
    shuffled = rng.permutation(len(grid))
    again, order_again = nearest(grid[shuffled], count)
    ordered, of_shuffled = np.empty((len(grid), 6)), np.empty((len(grid), 6))
    ordered[order], of_shuffled[shuffled[order_again]] = shapes.covariances, again.covariances
    np.testing.assert_allclose(of_shuffled, ordered, atol=1e-12)


@pytest.mark.parametrize("n_equal", [8, 12])
def test_how_many_equally_far_points_share(rng, n_equal):
    """Six of them are wanted around a point: all count as long as they are among the 1.3 (sqrt(7) + 1)² nearest, 17."""
    angle = 2 * np.pi * np.arange(n_equal) / n_equal
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(n_equal)])
    xyz = np.concatenate([[[0.0, 0, 0]], ring, rng.uniform(3, 9, (500, 3))])
    shapes, order = nearest(xyz, 7)
    check(xyz, shapes, order, lambda point: weights(xyz, point, 7), [0])
    assert shapes.plan_radius[order == 0] == pytest.approx(1)


def test_points_on_the_radius_are_within():
    line = np.arange(40)[:, None] * [0.1, 0, 0] + UTM
    shapes, _ = within(line, 0.3)
    assert sorted(shapes.counts) == [4, 4, 5, 5, 6, 6, *[7] * 34]


def test_a_first_try_between_equal_distances_is_no_limit():
    squares = np.array([[[0, 1, 1 + 9e-8, 4, 9, 16]]])
    limits, weights = blocks._nearest(squares, 2, np.array([1.0]))
    np.testing.assert_allclose(weights[0, 0], [1, 0.5, 0.5, 0, 0, 0])
    assert limits[0, 0] == pytest.approx(1)


def test_small_clusters_in_large_blocks_keep_their_digits(rng):
    """One of each dozen points within a millimeter is asked for: the block around it spans tens of meters."""
    clusters = np.repeat(rng.uniform(0, 1000, (60, 3)), 12, axis=0) + rng.uniform(0, 0.001, (720, 3))
    xyz = np.concatenate([rng.uniform(0, 1000, (5000, 3)), clusters])
    shapes, order = nearest(xyz, 5, rows=np.r_[:5000, 5000:5720:12])
    check(xyz, shapes, order, lambda point: weights(xyz, point, 5), range(5000, 5720, 12))


def test_coincident_points_have_no_extent(rng):
    xyz = np.concatenate([np.full((300, 3), 7.0), rng.uniform(0, 20, (300, 3))]) + UTM
    shapes, order = nearest(xyz, 20)
    same = order < 300
    assert (shapes.covariances[same] == 0).all()
    assert (shapes.plan_radius[same] == 0).all()
    assert (shapes.covariances[~same, :3].sum(axis=1) > 0).all()


def test_batches_change_nothing(scene, monkeypatch):
    whole, order = nearest(scene, 12)
    around, _ = within(scene, 1.0)
    monkeypatch.setattr(blocks, "NEIGHBORS_AT_ONCE", 500)
    parts, _ = nearest(scene, 12)
    around_parts, _ = within(scene, 1.0)
    for one, other in ((whole, parts), (around, around_parts)):
        np.testing.assert_allclose(other.covariances, one.covariances, rtol=1e-9, atol=1e-15)
        assert (other.counts == one.counts).all()
