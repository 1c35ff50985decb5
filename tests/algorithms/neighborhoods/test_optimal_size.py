"""The best neighborhood against brute force over all scales, its entropies against LAPACK, and ties."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.neighborhoods.covariance import PAIRS, reduce_neighborhoods
from lidar_buildings.algorithms.neighborhoods.optimal_size import Optimal, eigenentropies

FACTORS = arrays(np.float64, (8, 3, 3), elements=st.floats(-100, 100).map(lambda number: round(number, 6)))


def entropies_by_lapack(matrices):
    """Eigenentropy of each matrix; infinite where it is zero."""
    total = np.trace(matrices, axis1=-2, axis2=-1)
    with np.errstate(invalid="ignore"):
        shares = np.nan_to_num(matrices / total[..., None, None])
    shares = np.maximum(np.linalg.eigvalsh(shares), 1e-300)
    return np.where(total > 0, -(shares * np.log(shares)).sum(axis=-1), np.inf)


def six(matrices):
    return np.stack([matrices[..., a, b] for a, b in PAIRS])


def best(xyz, low, high, step=1):
    """Return counts and covariances of the best neighborhoods."""
    counts, covariances = np.zeros(len(xyz), int), np.empty((len(xyz), 6))

    def keep(rows, shapes):
        counts[rows] += shapes.counts
        covariances[rows] = shapes.covariances

    reduce_neighborhoods(xyz, Optimal(low, high, step), keep)
    return counts, covariances


def by_hand(xyz, scales):
    """Return entropies (s, n) and covariances (s, n, 3, 3) of the nearest points, one scale at a time."""
    xyz = xyz - xyz[0]
    distance = np.linalg.norm(xyz[:, None] - xyz, axis=2)
    order = np.argsort(distance, axis=1, kind="stable")
    covariances = np.array([[np.cov(xyz[rows[:k]].T, bias=True) for rows in order] for k in scales])
    return entropies_by_lapack(covariances), covariances


@settings(max_examples=100)
@given(FACTORS)
@example(np.array([[[47, 2.5, 39.5], [0.5, 0, 0], [0, 0, 0]]]))  # hardly wider than a line, and flat
def test_entropies_are_those_of_lapack(factors):
    matrices = factors @ factors.transpose(0, 2, 1)
    np.testing.assert_allclose(eigenentropies(six(matrices)), entropies_by_lapack(matrices), rtol=0, atol=1e-9)


@settings(max_examples=200)
@given(
    arrays(np.float64, (3, 3), elements=st.integers(-9, 9).map(float)),
    st.sampled_from([0, 1e-20, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-2, 1]),
    st.sampled_from([0, 1e-16, 1e-12, 1e-8, 1e-6, 1e-3, 1]),
)
def test_entropies_hold_for_lines_planes_and_balls_in_any_direction(axes, second, ratio):
    turn = np.linalg.qr(axes + 10 * np.eye(3))[0]
    values = np.array([1, second, second * ratio])
    matrix = (turn * values) @ turn.T
    shares = np.maximum(values / values.sum(), 1e-300)
    expected = -(shares * np.log(shares)).sum()
    assert eigenentropies(six(matrix)[:, None])[0] == pytest.approx(expected, abs=1e-9)


def test_entropies_of_shapes_and_of_nothing():
    diagonals = np.array([[1.0, 0, 0], [2, 2, 0], [3, 3, 3], [0, 0, 0], [0, 1e-200, 1e-200]])
    matrices = diagonals[:, :, None] * np.eye(3)
    expected = [0, np.log(2), np.log(3), np.inf, np.log(2)]
    np.testing.assert_allclose(eigenentropies(six(matrices)), expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("step", [1, 7])
def test_the_best_neighborhood_is_that_of_brute_force(rng, step):
    roof = np.column_stack([rng.uniform(0, 6, (250, 2)), rng.normal(0, 0.03, 250)])
    crown = rng.normal(0, 1, (150, 3)) + [8, 3, 1]
    xyz = np.concatenate([roof, crown]) + [600_000, 5_000_000, 0]
    scales = np.arange(10, 61, step)
    entropies, covariances = by_hand(xyz, scales)
    counts, found = best(xyz, 10, 60, step)
    chosen = np.searchsorted(scales, counts)
    every = np.arange(len(xyz))
    assert (scales[chosen] == counts).all()
    assert (entropies[chosen, every] <= entropies.min(axis=0) + 2e-9).all()
    np.testing.assert_allclose(found, six(covariances[chosen, every]).T, rtol=0, atol=1e-12)
    assert len(np.unique(counts)) > 5, "else nothing was chosen"


def test_edges_stay_sharp_and_smooth_surfaces_take_many(rng):
    """At a wire over a plane the best neighborhood ends before the wire does; on noise-free planes any is as good."""
    wire = np.column_stack([np.arange(0, 10, 0.1), np.full(100, 5.0), np.full(100, 3.0)])
    wire += rng.normal(0, 0.001, wire.shape)
    ground = np.column_stack([rng.uniform(0, 10, (4000, 2)), rng.normal(0, 0.02, 4000)])
    counts, covariances = best(np.concatenate([wire, ground]), 10, 100)
    linear = np.linalg.eigvalsh(covariances[:100][:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(-1, 3, 3))
    assert (linear[:, 1] < 0.01 * linear[:, 2]).all()
    assert counts[100:].max() > 60


def test_equal_ones_are_decided_for_the_smallest():
    line = np.arange(60)[:, None] * [0.37, -0.11, 0.23] + [600_000.5, 5_000_000.25, 80.125]
    assert (best(line, 10, 50)[0] == 10).all()
    assert (best(np.ones((60, 3)), 10, 50)[0] == 10).all()  # coincident: undefined at any scale


def test_duplicates_do_not_end_the_search(rng):
    """Eleven points at one place have no shape; the first neighborhood that has one counts."""
    xyz = rng.uniform(0, 5, (200, 3))
    xyz[:11] = xyz[0]
    counts, covariances = best(xyz, 10, 40)
    assert (counts[:11] > 11).all()
    assert (covariances[:11, :3].sum(axis=1) > 0).all()


@pytest.mark.parametrize("n", [1, 2, 5, 9, 10, 11, 30])
def test_fewer_points_than_asked_for_are_all_taken(rng, n):
    counts, _ = best(rng.uniform(0, 1, (n, 3)), 10, 100)
    assert (counts >= min(n, 10)).all()
    assert (counts <= n).all()


def test_the_same_as_pgeof(rng):
    """Pgeof works in float32: where it chooses another neighborhood, that one is about as good."""
    pgeof = pytest.importorskip("pgeof")
    roof = np.column_stack([rng.uniform(0, 8, (500, 2)), rng.normal(0, 0.03, 500)])
    xyz = np.concatenate([roof, rng.normal(0, 1.5, (200, 3)) + [15, 5, 3]])
    neighbors = cKDTree(xyz).query(xyz, k=50)[1].astype(np.uint32)
    starts = np.arange(len(xyz) + 1, dtype=np.uint32) * 50
    theirs = pgeof.compute_features_optimal(xyz.astype(np.float32), neighbors.ravel(), starts, 1, 1, 10)[:, 11]
    entropies, _ = by_hand(xyz, np.arange(10, 51))
    assert (entropies[theirs.astype(int) - 10, np.arange(len(xyz))] <= entropies.min(axis=0) + 0.005).all()
    assert (best(xyz, 10, 50)[0] == theirs).mean() > 0.98


def test_cloud_moved_turned_and_shuffled_chooses_the_same(rng):
    xyz = np.concatenate([rng.uniform(0, 5, (300, 3)) * [1, 1, 0.02], rng.normal(0, 1, (100, 3)) + [9, 0, 0]])
    xyz = np.round(xyz * 1024) / 1024
    order = rng.permutation(400)
    turn = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])
    here = best(xyz, 10, 50)[0]
    assert (best(xyz[order] + [6e5, 5e6, 100], 10, 50)[0] == here[order]).all()
    assert (best(xyz @ turn.T, 10, 50)[0] == here).mean() > 0.99  # turned points are rounded anew


def lattice(rng, step=0.1):
    """Return the points of a lattice whose heights are on its planes, in no order."""
    x, y = np.meshgrid(np.arange(40.0), np.arange(30.0))
    heights = np.round(rng.normal(0, 0.5, x.size))
    return rng.permutation(np.column_stack([x.ravel(), y.ravel(), heights])) * step


@pytest.mark.parametrize("corner", [[0, 0, 0], [600_000, 5_000_000, 80]], ids=["near", "map"])
def test_order_decides_nothing_where_distances_tie(rng, corner):
    """On a lattice of 0.1 m, 236 of 1,200 points chose another number, by up to 89, in another order of points."""
    xyz = lattice(rng) + corner
    order = rng.permutation(len(xyz))
    counts, covariances = best(xyz, 10, 100)
    counts_again, covariances_again = best(xyz[order], 10, 100)
    np.testing.assert_array_equal(counts_again, counts[order])
    np.testing.assert_allclose(covariances_again, covariances[order], rtol=0, atol=1e-12)
    assert len(np.unique(counts)) > 20, "else nothing was chosen"


def test_extents_are_those_of_all_in_a_tie(rng):
    xyz = lattice(rng)
    order = rng.permutation(len(xyz))

    def extents(points):
        made = np.empty((2, len(points)))

        def keep(rows, shapes):
            made[:, rows] = shapes.height_range, shapes.plan_radius

        reduce_neighborhoods(points, Optimal(10, 100), keep, extents=True)
        return made

    np.testing.assert_allclose(extents(xyz[order]), extents(xyz)[:, order], rtol=0, atol=1e-12)


def test_neighbors_in_a_tie_count_in_part(rng):
    """Independent opinion: the mean of the covariances' moments over all choices among neighbors in a tie."""
    xyz = np.round(rng.uniform(0, 7, (400, 3)) * [1, 1, 0.4])
    off = xyz[:, None] - xyz
    square = (off**2).sum(axis=2)
    scales = np.arange(10, 41)
    covariances = np.empty((len(scales), len(xyz), 3, 3))
    for row in range(len(xyz)):
        for at, k in enumerate(scales):
            last = np.sort(square[row])[k - 1]
            nearer, tied = square[row] < last, square[row] == last
            weight = (nearer + tied * (k - nearer.sum()) / tied.sum()) / k
            mean = weight @ off[row]
            covariances[at, row] = (weight * off[row].T) @ off[row] - np.outer(mean, mean)
    entropies = entropies_by_lapack(covariances)
    counts, found = best(xyz, 10, 40)
    every = np.arange(len(xyz))
    np.testing.assert_allclose(found, six(covariances[counts - 10, every]).T, rtol=0, atol=1e-12)
    assert (entropies[counts - 10, every] <= entropies.min(axis=0) + 2e-9).all()


def test_fewest_more_than_most_is_refused(rng):
    with pytest.raises(ValueError, match=r"minimum of nearest points \(50\) is above the maximum \(20\); exchange"):
        best(rng.uniform(0, 1, (90, 3)), 50, 20)
