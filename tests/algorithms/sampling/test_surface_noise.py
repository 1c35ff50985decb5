"""The noise of smooth surfaces, put there by construction."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.neighborhoods import covariance as eigen
from lidar_buildings.algorithms.neighborhoods.covariance import Nearest
from lidar_buildings.algorithms.neighborhoods.wide_in_plan import Wide
from lidar_buildings.algorithms.sampling import surface_noise as module
from lidar_buildings.algorithms.sampling.height_resolution import height_resolution
from lidar_buildings.algorithms.sampling.surface_noise import SURFACES, SurfaceSample, plane_roughness, surface_density
from lidar_buildings.tests.builders import FAR


def surface_noise(xyz):
    """Return the noise that a sample of the points shows."""
    return SurfaceSample(xyz).noise(height_resolution(xyz[:, 2]))


def surface_neighbors(xyz, density, deviation):
    """Return the neighborhood that a sample of the points asks for."""
    return SurfaceSample(xyz).neighborhood(density, deviation)


def plane(rng, deviation, slope=0.0, count=4000, side=30.0):
    """Return points whose deviation across a plane of that slope (rise over run) is known."""
    plan = rng.uniform(0, side, (count, 2))
    across = rng.normal(0, deviation, count) * np.hypot(1, slope)
    return np.column_stack([plan, slope * plan[:, 0] + across])


@pytest.mark.parametrize(
    ("density", "deviation"), [(1.0, 0.02), (1.0, 0.05), (1.0, 0.2), (10.0, 0.02), (10.0, 0.05), (100.0, 0.02)]
)
@pytest.mark.parametrize("slope", [0.0, 1.0])
def test_noise_of_a_plane(density, deviation, slope, rng):
    """Of equally rough surroundings the smoothest fifth look a quarter smoother than they are, which is made good.

    The noise is at most a fifth of the spacing: with more, the 12 nearest points lie as far across the plane as along.
    """
    found = surface_noise(plane(rng, deviation, slope, count=20_000, side=np.sqrt(20_000 / density)))
    assert found == pytest.approx(deviation, rel=0.04)


@pytest.mark.parametrize(("share", "degrees"), [(0.2, 9), (0.05, 9), (0.2, 1)])
def test_the_smoothest_of_equally_rough_surroundings_by_hand(share, degrees, rng):
    """Sums of squares of normal numbers, drawn and sorted."""
    drawn = np.sqrt((rng.normal(size=(200_000, degrees)) ** 2).mean(axis=1))
    assert module._expected_quantile(share, degrees) == pytest.approx(np.quantile(drawn, share), rel=0.01)


def test_twice_the_noise_is_twice_the_figure(rng):
    here = plane(rng, 0.05)
    assert surface_noise(here * [1, 1, 2]) == pytest.approx(2 * surface_noise(here), rel=0.05)


def test_no_noise_is_a_centimeter(rng):
    assert surface_noise(plane(rng, 0.0)) == 0.01


@pytest.mark.parametrize("slope", [0.02, 0.5])
def test_rounded_heights_are_as_rough_as_rounding_makes_them(slope, rng):
    """On nearly level ground all points around most points lie on one level, as smooth as can be."""
    xyz = plane(rng, 0.02, slope, count=20_000, side=200.0)
    xyz[:, 2] = np.round(xyz[:, 2] / 0.3) * 0.3
    assert surface_noise(xyz) == pytest.approx(0.3 / np.sqrt(12), rel=0.1)


def test_the_plane_of_twelve_points_by_hand(rng):
    """Twelve points have one neighborhood: the figure is its least squares across, for 12 - 3 degrees of freedom.

    It counts as the noise of a smooth fifth, whose expected value is 0.773 of the true deviation.
    """
    xyz = rng.normal(size=(12, 3)) * [3, 2, 0.3]
    least = np.linalg.svd(xyz - xyz.mean(axis=0), compute_uv=False)[2]
    assert surface_noise(xyz) == pytest.approx(np.sqrt(least**2 / 9) / 0.773, rel=1e-3)


def test_trees_over_two_thirds_of_the_ground_do_not_count(rng):
    open_ground = plane(rng, 0.03, side=30, count=3000)
    crowns = rng.uniform([0, 30, 2], [30, 90, 12], (6000, 3))
    assert surface_noise(np.concatenate([open_ground, crowns])) == pytest.approx(0.03, rel=0.35)


def test_in_a_closed_forest_the_few_smooth_parts_show_the_noise(rng):
    """A tenth of the points lie on the ground: the smoothest fifth reaches into the crowns.

    The bound was 10 cm for a noise that was understated by the factor 0.773.
    """
    clearing = plane(rng, 0.03, side=20, count=1300)
    crowns = rng.uniform([0, 30, 2], [80, 110, 12], (11_700, 3))
    assert 0.02 < surface_noise(np.concatenate([clearing, crowns])) < 0.1 / 0.773


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_handful_of_points_has_the_least_noise(count):
    assert surface_noise(np.arange(3.0 * count).reshape(-1, 3)) == 0.01


def test_points_at_one_position_have_the_least_noise():
    assert surface_noise(np.zeros((50, 3))) == 0.01


def test_order_and_position_change_nothing(rng):
    xyz = plane(rng, 0.04).round(3)
    expected = surface_noise(xyz)
    assert surface_noise(rng.permutation(xyz)) == pytest.approx(expected, rel=1e-9)
    assert surface_noise((xyz + FAR).round(3)) == pytest.approx(expected, rel=1e-4)


@pytest.fixture
def small_sample(monkeypatch):
    """Let clouds of a few thousand points be sampled."""
    monkeypatch.setattr(module, "SURFACES", replace(SURFACES, sample=2000))


def test_a_sample_is_enough(rng, small_sample, monkeypatch):
    xyz = plane(rng, 0.04, count=60_000, side=120)
    sample = SurfaceSample(xyz)
    monkeypatch.setattr(module, "SURFACES", replace(SURFACES, sample=len(xyz)))
    whole = SurfaceSample(xyz)
    assert len(sample) < len(xyz) / 4 < len(whole)
    assert sample.noise(0.01) == pytest.approx(whole.noise(0.01), rel=0.05)
    assert sample.density == pytest.approx(whole.density, rel=0.05)
    assert sample.neighborhood(4.2, 0.15) == whole.neighborhood(4.2, 0.15)


def test_neighbors_of_the_sample_are_those_of_the_cloud(rng, small_sample):
    """The sixty points nearest to a point of the sample are at its place, too, but for thin spots at its edge."""
    xyz = plane(rng, 0.04, count=60_000, side=120)
    sample, tree = SurfaceSample(xyz), cKDTree(xyz)
    own = sample.columns[:, sample.rows].T
    is_same = np.isclose(sample.tree.query(own, [60])[0], tree.query(own, [60])[0], rtol=1e-9)
    assert is_same.mean() > 0.99


def test_a_sample_is_chosen_by_place(rng, small_sample):
    xyz = plane(rng, 0.04, count=60_000, side=120)

    def own(cloud):
        sample = SurfaceSample(cloud)
        return sample.columns[:, sample.rows].T

    here = own(xyz)
    assert 1500 < len(here) < 2500
    np.testing.assert_array_equal(np.unique(here, axis=0), np.unique(own(rng.permutation(xyz)), axis=0))
    # No quarter of the area is left out.
    quarter = (here[:, 0] > 60).astype(int) * 2 + (here[:, 1] > 60)
    assert np.bincount(quarter).min() > 0.15 * len(here)


@pytest.mark.parametrize("stretch", [[0, 0.001, 1], [0, 0, 0]])
def test_a_cloud_without_width_is_looked_at_whole(stretch, rng, small_sample):
    xyz = rng.uniform(0, 100, (10_000, 3)) * stretch
    sample = SurfaceSample(xyz)
    assert len(sample) == len(sample.rows) == len(xyz)


def test_a_cloud_on_few_positions_is_looked_at_whole(rng, small_sample):
    """Twenty masts of 500 points cover so few cells that a random sample would miss nearly all."""
    mast = np.column_stack([np.zeros((500, 2)), np.arange(500) / 50])
    xyz = (rng.uniform(0, 100, (20, 1, 3)) * [1, 1, 0] + mast).reshape(-1, 3)
    assert len(SurfaceSample(xyz)) == len(xyz)


def test_only_some_points_are_looked_at_at_once(rng, monkeypatch):
    """A cloud that is looked at whole may be large: memory must not grow with it."""
    xyz, at_once, moments = plane(rng, 0.03), [], eigen.Nearest.moments
    expected = surface_noise(xyz)
    monkeypatch.setattr(eigen, "NEIGHBORS_AT_ONCE", 6000)
    monkeypatch.setattr(eigen.Nearest, "moments", lambda *given: at_once.append(len(given[-1])) or moments(*given))
    assert surface_noise(xyz) == expected
    assert at_once == [500] * 8


def test_scattered_precise_points_need_few_neighbors(rng):
    assert surface_neighbors(plane(rng, 0.02), 4.4, 0.02) == Nearest(8)


def test_noisy_points_need_as_many_as_reach_six_times_the_noise(rng):
    """6.2 times 20 cm is a circle of 4.8 m², which holds 22 points."""
    assert surface_neighbors(plane(rng, 0.2), 4.4, 0.2) == Nearest(
        int(np.ceil(np.pi * (SURFACES.reach * 0.2) ** 2 * 4.4))
    )


def test_dense_points_need_as_many_as_reach_half_a_meter(rng):
    """Half a meter around is 0.785 m²: 24 points at 30 per m², and a hundred at the most."""
    assert surface_neighbors(plane(rng, 0.02), 30.0, 0.02) == Nearest(24)
    assert surface_neighbors(plane(rng, 0.02), 1000.0, 0.02) == Nearest(100)


@pytest.mark.parametrize(("density", "is_own"), [(25.0, False), (14.0, True), (5.0, True)])
def test_where_half_of_the_points_lie_far_more_densely_theirs_is_the_density(density, is_own, rng):
    """Half a meter holds 32 at 40 points per m², which counts where the cloud is taken for one of less than half."""
    dense, sparse = plane(rng, 0.02, count=16_000, side=20), plane(rng, 0.02, count=2000) + [50, 0, 0]
    xyz = np.concatenate([dense, sparse])
    assert (25 <= surface_neighbors(xyz, density, 0.02).count <= 40) == is_own
    assert is_own or surface_neighbors(xyz, density, 0.02).count == np.ceil(np.pi / 4 * density)
    assert surface_neighbors(sparse, 2.0, 0.02) == Nearest(8)


def scan_lines(rng):
    """Return points every 10 cm on lines 1 m apart."""
    x, y = np.meshgrid(np.arange(0, 30, 0.1), np.arange(0, 30, 1.0))
    return np.column_stack([x.ravel(), y.ravel(), rng.normal(0, 0.02, x.size)])


def test_points_along_scan_lines_need_neighbors_on_several_lines(rng):
    """The 8 or 12 nearest points are one line, which has no plane."""
    assert surface_neighbors(scan_lines(rng), 10.0, 0.02) == Wide(8)


def test_lines_over_half_of_the_cloud_are_enough_to_look_across_them(rng):
    """Four fifths of the neighborhoods must be wide, those between points that are not in lines are not enough."""
    lines = scan_lines(rng)
    scattered = rng.uniform([0, 40, 0], [30, 70, 0], lines.shape) + rng.normal(0, 0.02, lines.shape) * [0, 0, 1]
    assert surface_neighbors(scattered, 10.0, 0.02) == Nearest(8)
    assert surface_neighbors(np.concatenate([lines, scattered]), 10.0, 0.02) == Wide(8)


@pytest.mark.parametrize(("share", "expected"), [(0.1, Nearest(8)), (1 / 3, Wide(8))])
def test_more_than_a_fifth_of_the_neighborhoods_must_be_narrow(share, expected, rng):
    """On lines, as rough as the grid next to them, lies so much of the cloud; all other neighborhoods are wide."""
    x, y = np.meshgrid(np.arange(0, 60, 0.2), np.arange(0, 60 * share, 1.5))
    along, across = np.meshgrid(*2 * [np.arange(np.sqrt(x.size / share - x.size)) / 2])
    xyz = np.column_stack([np.append(x, along + 100), np.append(y, across), np.zeros(x.size + along.size)])
    xyz += rng.normal(0, [0.05, 0.05, 0.005], xyz.shape)
    assert surface_neighbors(xyz, 4.0, 0.01) == expected


def test_density_on_a_grid_by_hand():
    """At 1 m from each other: one at no distance, four at 1 m, four at 1.4 m and more than three at 2 m."""
    x, y = np.meshgrid(np.arange(40.0), np.arange(40.0))
    level = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    assert surface_density(level) == pytest.approx(12 / (np.pi * 2**2))
    wall = level[:, [0, 2, 1]]
    assert surface_density(wall) == surface_density(level)


def test_points_at_one_position_have_no_density():
    assert surface_density(np.full((20, 3), 7.0)) == np.inf


def test_roofs_are_rougher_than_the_smoothest_surfaces():
    least, of_spacing = SURFACES.least_roughness, SURFACES.roughness_of_spacing
    assert plane_roughness(0.0, 25.0) == pytest.approx(np.hypot(least, of_spacing / 5), rel=1e-3)
    assert plane_roughness(0.1, 4.0) == pytest.approx(np.hypot(0.1, of_spacing / 2), rel=1e-3)
