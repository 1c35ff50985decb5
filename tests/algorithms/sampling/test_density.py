"""Density of occupied area, in clouds whose density is known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.sampling.density import effective_density, point_density, point_spacing


@pytest.mark.parametrize("density", [0.2, 2, 20, 200])
def test_even_cloud(rng, density):
    side = np.sqrt(40_000 / density)
    xyz = rng.uniform(0, side, (40_000, 3)) + [600_000, 5_000_000, 0]
    assert point_density(xyz) == pytest.approx(density, rel=0.03)
    assert point_spacing(xyz) == pytest.approx(1 / np.sqrt(density), rel=0.02)


def test_empty_ground_does_not_count(rng):
    xyz = rng.uniform(0, 50, (20_000, 3))
    xyz[10_000:, :2] += 500  # two squares of 2500 m² far apart, 4 points per m² in each
    assert point_density(xyz) == pytest.approx(4, rel=0.08)


def test_scales_with_area(rng):
    xyz = rng.uniform(0, 50, (20_000, 3))
    assert point_density(3 * xyz) == pytest.approx(point_density(xyz) / 9, rel=0.01)


def test_points_on_a_line_have_a_finite_density():
    xyz = np.column_stack([np.arange(100.0), np.zeros(100), np.zeros(100)])
    assert 0.1 < point_density(xyz) < 2  # cells of five points are 5 m wide


@pytest.mark.parametrize("n_points", [100, 5000])
def test_points_above_each_other_share_a_position(n_points):
    """Twenty masts: cells that shrank until they held five points each would never do so."""
    x, y = np.meshgrid(np.arange(5.0), np.arange(4.0))
    xyz = np.concatenate([np.column_stack([x.ravel(), y.ravel(), np.full(20, z)]) for z in np.arange(n_points) / 100])
    assert point_density(xyz) == pytest.approx(n_points / 0.01**2)


def test_a_wall_stored_to_centimeters(rng):
    """Three meters of a wall that is 6 cm deep, with a hundred points at each position that the file can represent."""
    xyz = rng.uniform(0, [3, 0.06, 10], (180_000, 3)).round(2)
    assert point_density(xyz) == pytest.approx(180_000 / (3 * 0.06), rel=0.2)


def test_points_at_one_position_are_refused():
    with pytest.raises(ValueError, match=r"no extent in plan \(points: 7\), so it has no density; choose"):
        point_density(np.column_stack([np.ones(7), np.ones(7), np.arange(7)]))


@pytest.mark.parametrize("density", [0.5, 5, 50])
def test_evenly_spread_points_have_one_density(density, rng):
    xyz = rng.uniform(0, np.sqrt(20_000 / density), (20_000, 3))
    assert effective_density(xyz) == point_density(xyz)


def test_waters_and_gaps_between_strips_change_nothing(rng):
    """A river of a tenth of the area, and a hundred ponds."""
    xyz = rng.uniform(0, 100, (50_000, 3))
    pond = np.hypot(xyz[:, 0] % 10 - 5, xyz[:, 1] % 10 - 5) < 1.5
    xyz = xyz[~pond & (np.abs(xyz[:, 0] - 40) > 5)]
    assert effective_density(xyz) == point_density(xyz)


def test_lines_are_as_dense_as_their_gaps_let_them(rng):
    """Lines 2 m apart with a point every 12.5 cm: cells of 1.5 times half a meter miss most of them."""
    x, y = np.meshgrid(np.arange(0, 100, 0.125), np.arange(0, 100, 2.0))
    xyz = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]) + rng.normal(0, 0.02, (x.size, 3))
    turned = xyz @ np.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]])
    for cloud in (xyz, turned, turned + [600_000, 5_000_000, 0]):
        assert point_density(cloud) > 3.9
        assert effective_density(cloud) < 3


def test_a_sparse_half_is_what_counts(rng):
    """Half at 2 points per m² and half at 20: scales of 11 per m² would leave the sparse half in pieces."""
    sparse, dense = rng.uniform(0, 60, (7200, 2)), rng.uniform(0, 60, (72_000, 2)) + [60, 0]
    xyz = np.concatenate([sparse, dense])
    assert 2 <= effective_density(xyz) < 0.6 * point_density(xyz)


def test_pairs_are_hardly_more_than_their_halves(rng):
    once = rng.uniform(0, 80, (12_800, 2))
    xyz = np.concatenate([once, once + rng.normal(0, 0.03, once.shape)])
    assert effective_density(once) == point_density(once)
    assert 2 <= effective_density(xyz) < 3.2


def test_the_density_is_never_less_than_a_quarter(rng):
    """Clumps far apart: where they are, they are dense."""
    middles = rng.uniform(0, 500, (300, 1, 2))
    xyz = (middles + rng.normal(0, 0.3, (300, 50, 2))).reshape(-1, 2)
    assert effective_density(xyz) >= point_density(xyz) / 4.01


@pytest.mark.parametrize("size", [0.0, 5e-324, 1e-170])
def test_an_extent_whose_area_is_zero_has_no_density(rng, size):
    """With steps of 5e-324 m it was an error of Python's own."""
    xyz = np.column_stack([rng.integers(0, 9, (20, 2)) * size, np.arange(20.0)])
    with pytest.raises(ValueError, match="no extent in plan"):
        point_density(xyz)
