"""How a cloud was sampled: on which points, each measure once, whatever the order of points and questions."""

import pickle
from collections import Counter

import numpy as np
import pytest

from lidar_buildings.algorithms.neighborhoods.covariance import Nearest
from lidar_buildings.algorithms.neighborhoods.wide_in_plan import Wide
from lidar_buildings.algorithms.sampling import cloud_sampling as module
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling, without_noise
from lidar_buildings.algorithms.sampling.density import effective_density, point_density
from lidar_buildings.algorithms.sampling.height_resolution import height_resolution
from lidar_buildings.algorithms.sampling.surface_noise import plane_roughness, surface_density

MEASURES = ("density", "effective_density", "spacing", "surface_density", "noise", "roughness", "height_resolution")


def gentle_slope(rng, density=10.0, noise=0.03, count=20_000):
    """Return points spread at random over a square that rises by a tenth."""
    plan = rng.uniform(0, np.sqrt(count / density), (count, 2))
    return np.column_stack([plan, plan[:, 0] / 10 + rng.normal(0, noise, count)])


def all_of(sampling):
    return {name: getattr(sampling, name) for name in MEASURES}


@pytest.mark.parametrize(("density", "noise"), [(2.0, 0.02), (2.0, 0.1), (10.0, 0.05), (50.0, 0.02)])
def test_a_slope_is_sampled_as_it_was_made(density, noise, rng):
    sampling = CloudSampling.of(gentle_slope(rng, density, noise))
    assert sampling.density == pytest.approx(density, rel=0.03)
    assert sampling.effective_density == sampling.density
    assert sampling.spacing == pytest.approx(1 / np.sqrt(density), rel=0.02)
    assert sampling.noise == pytest.approx(noise, rel=0.04)
    assert sampling.height_resolution == 0.01
    assert sampling.roughness == plane_roughness(sampling.noise, sampling.surface_density)


def test_measures_are_those_of_their_functions(rng):
    """On lines, with rounded heights: where all measures differ."""
    xyz = gentle_slope(rng)
    xyz[:, 1:] = np.round(xyz[:, 1:] / [1.0, 0.1]) * [1.0, 0.1]
    sampling = CloudSampling.of(xyz)
    assert sampling.density == point_density(xyz)
    assert sampling.effective_density == effective_density(xyz) < sampling.density
    assert sampling.surface_density == surface_density(xyz)
    assert sampling.height_resolution == height_resolution(xyz[:, 2]) == pytest.approx(0.1 / np.sqrt(12))


def test_noise_points_do_not_count(rng):
    """Birds over four times the area would lower the density."""
    xyz = gentle_slope(rng)
    birds = rng.uniform([0, 0, 50], [90, 90, 90], (500, 3))
    classes = np.repeat([1, 18], [len(xyz), len(birds)])
    with_birds = CloudSampling.of(np.concatenate([xyz, birds]), classes)
    assert all_of(with_birds) == all_of(CloudSampling.of(xyz))
    assert CloudSampling.of(np.concatenate([xyz, birds])).density < 0.95 * with_birds.density


def test_where_all_points_are_noise_they_count():
    assert without_noise(np.array([1, 7, 2, 18])).tolist() == [True, False, True, False]
    assert without_noise(np.array([7, 18])).tolist() == [True, True]


def test_order_of_points_and_of_questions_changes_nothing(rng):
    xyz = gentle_slope(rng).round(3)
    sampling, shuffled = CloudSampling.of(xyz), CloudSampling.of(rng.permutation(xyz))
    backward = {name: getattr(shuffled, name) for name in reversed(MEASURES)}
    assert backward == pytest.approx(all_of(sampling), rel=1e-9)


def test_nothing_is_measured_before_it_is_asked_for_nor_twice(rng, monkeypatch):
    xyz, calls = gentle_slope(rng), Counter()
    for name in ("point_density", "effective_density", "height_resolution", "SurfaceSample"):
        measure = getattr(module, name)
        monkeypatch.setattr(module, name, lambda *given, name=name, of=measure: calls.update([name]) or of(*given))
    sampling = CloudSampling.of(xyz)
    assert not calls
    assert not sampling.measured
    assert sampling.spacing == sampling.density**-0.5
    assert (calls, list(sampling.measured)) == ({"point_density": 1}, ["density"])
    for _ in range(2):
        all_of(sampling)
        sampling.neighborhood(10.0, 0.05)
    assert set(calls.values()) == {1}
    assert len(calls) == 4


def under_crowns(rng, ground=2_000, crowns=8_000):
    """Return a plane that rises by a tenth, with noise of 0.02 m, under crowns 8 m deep, and the classes of both."""
    below = gentle_slope(rng, 0.5, 0.02, ground)
    side = np.sqrt(ground / 0.5)
    above = np.column_stack([rng.uniform(0, side, (crowns, 2)), rng.uniform(12, 20, crowns)])
    return np.concatenate([below, above]), np.repeat([2, 1], [ground, crowns])


def test_in_a_forest_the_ground_shows_the_noise_and_nowhere_else_more_than_all_points(rng):
    xyz, classes = under_crowns(rng)
    sampling = CloudSampling.of(xyz)
    assert sampling.noise > 0.05
    assert sampling.noise_with_ground(xyz, classes) == pytest.approx(0.02, rel=0.1)
    # Of rough ground, and without any but a few points, the noise of all counts.
    few = np.where(np.arange(len(xyz)) < 11, 2, 1)
    for others in (3 - classes, few):
        assert CloudSampling.of(xyz).noise_with_ground(xyz, others) == sampling.noise


def test_parts_take_the_noise_of_the_ground_of_the_whole(rng):
    xyz, classes = under_crowns(rng)
    whole = CloudSampling.of(xyz)
    found = whole.noise_with_ground(xyz, classes)
    assert whole.found == {"ground_noise": found}
    part = whole.without_points()
    part.of_whole.update(whole.found)
    assert part.noise_with_ground(xyz[-100:], classes[-100:]) == found


def test_the_log_shows_what_was_measured(rng):
    sampling = CloudSampling.of(gentle_slope(rng))
    assert str(sampling) == ""
    assert f"density {sampling.density:.4g} points/m², surface noise {sampling.noise:.4g} m" in str(sampling)
    assert "effective" not in str(sampling)


def test_what_was_learned_on_the_whole_is_taken_and_else_learned_on_the_cloud(rng):
    sampling = CloudSampling.of(gentle_slope(rng))
    table = np.array([[1.0, 2.0], [3.0, 4.0]])
    assert sampling.learned("sums", lambda: table, lambda rows: tuple(rows.sum(axis=0))) == (4.0, 6.0)
    assert sampling.samples["sums"][0] is table
    assert not sampling.without_points().samples
    sampling.of_whole["sums"] = (7.0,)
    assert sampling.without_points().learned("sums", lambda: table, tuple) == (7.0,)


def test_blocks_are_given_the_measures_and_not_the_points(rng):
    """So that the blocks of a survey share one sampling, in a few hundred bytes."""
    xyz = gentle_slope(rng, count=100_000)
    sampling = CloudSampling.of(xyz)
    sampling.of_whole["surface_roughness"] = 0.02
    sent = pickle.dumps(sampling.without_points())
    there = pickle.loads(sent)
    assert there.of_whole == {"surface_roughness": 0.02}
    assert all_of(there) == all_of(sampling)
    for density, deviation in ((10.0, 0.3), (10.0, 0.05), (2.0, 0.02), (0.5, 0.02)):
        assert there.neighborhood(density, deviation) == sampling.neighborhood(density, deviation)
    assert len(sent) < 2000


def test_blocks_look_as_wide_as_the_whole_where_points_lie_on_lines(rng):
    along, across = np.meshgrid(np.arange(0, 60, 0.1), np.arange(0, 60, 1.5))
    xyz = np.column_stack([along.ravel(), across.ravel(), rng.normal(0, 0.01, along.size)])
    sampling = CloudSampling.of(xyz)
    alone = sampling.without_points()
    found = [sampling.neighborhood(density, 0.02) for density in (2.0, 12.0, 18.0, 30.0, 50.0, 70.0)]
    assert {type(one) for one in found} == {Nearest, Wide}
    assert [alone.neighborhood(density, 0.02) for density in (2.0, 12.0, 18.0, 30.0, 50.0, 70.0)] == found
