"""The simulated plant agrees with its truth."""

import numpy as np
import pytest

from lidar_buildings.algorithms.simulation import plant_layout
from lidar_buildings.algorithms.simulation import simulate_plant as module
from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant

PLANT = {"pipes": 6, "tanks": 1, "spheres": 1, "density": 300.0}


@pytest.fixture(scope="module")
def plant():
    return simulate_plant(**PLANT, noise=0.0)


def test_points_lie_on_their_pipes_and_spheres(plant):
    xyz, _, segment_id, shape, axes, centers = plant
    assert [kind for kind in axes.columns["kind"]].count("pipe") == 6
    for number, line, radius, points in zip(
        axes.columns["id"], axes.geometries, axes.columns["radius"], axes.columns["points"]
    ):
        own = xyz[segment_id == number]
        assert len(own) == points
        along = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
        np.testing.assert_allclose(np.linalg.norm(np.cross(own - line[0], along), axis=1), radius, atol=1e-9)
        assert set(shape[segment_id == number]) == {2}
    own = xyz[segment_id == centers.columns["id"][0]]
    np.testing.assert_allclose(
        np.linalg.norm(own - centers.geometries[0], axis=1), centers.columns["radius"][0], atol=1e-9
    )


def test_the_floor_under_a_tank_has_no_points(plant):
    xyz, classification, _, _, axes, _ = plant
    tank = axes.columns["kind"].index("tank")
    middle, radius = axes.geometries[tank][0], axes.columns["radius"][tank]
    floor = xyz[classification == 2]
    inside = np.linalg.norm(floor[:, :2] - middle[:2], axis=1) < radius - 0.5
    assert inside.mean() < 0.01


def test_density_and_seed_have_the_described_effect(monkeypatch):
    small = {"pipes": 1, "tanks": 0, "spheres": 0, "density": 200.0}
    plant = simulate_plant(**small, noise=0.0)
    again = simulate_plant(**small, noise=0.0)
    np.testing.assert_array_equal(again[0], plant[0])
    other = simulate_plant(**small, noise=0.0, seed=2)
    assert len(other[0]) != len(plant[0])
    noisy = simulate_plant(**small, noise=0.01)
    np.testing.assert_array_equal(noisy[2], plant[2])
    # The distance is the absolute value of a normal error along the beam: its deviation is smaller by this factor.
    assert np.linalg.norm(noisy[0] - plant[0], axis=1).std() == pytest.approx(0.01 * np.sqrt(1 - 2 / np.pi), rel=0.05)
    bare = simulate_plant(**small, clutter=False)
    assert (bare[2] == 0).sum() == 0
    monkeypatch.setattr(module, "_MAX_POINTS", 1e4)
    with pytest.raises(ValueError, match="The plant would need more than 0.01 million candidates for points"):
        simulate_plant(**small)


def test_an_elbow_joins_its_pipes(rng):
    """Every point of a quarter of a torus lies at the radius of the pipe from its bent axis."""
    elbow = plant_layout.elbow(np.zeros(3), np.array([1.0, 0, 0]), np.array([0, 0, 1.0]), 0.6, 0.2)
    places, normals = elbow.sample(rng, 2000)
    ring = np.hypot(places[:, 0], places[:, 2] - 0.6)
    np.testing.assert_allclose(np.hypot(ring - 0.6, places[:, 1]), 0.2, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    assert places[:, 0].min() > -1e-9
    assert places[:, 2].min() > -0.21
