"""Model industry on a simulated plant: its pipes, its tank and its sphere are found, and nothing else."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant
from lidar_buildings.tests.industry import compared


@pytest.fixture(scope="module")
def plant():
    return simulate_plant(pipes=4, tanks=0, spheres=1, density=3000.0, clutter=False)


@pytest.fixture(scope="module")
def modeled(plant):
    xyz, classification, *_ = plant
    return run_pipeline(PIPELINES["model_industry"], create_cloud({"xyz": xyz, "classification": classification}))


def test_every_pipe_is_found_and_no_other_cylinder(plant, modeled):
    _, _, true_id, _, true_axes, _ = plant
    result = compared(true_id, true_axes, modeled.cloud.get("segment_id"), modeled.layers["axes"])
    assert result.is_found.all()
    assert not result.invented
    assert np.median(result.error) < 0.01


def test_the_sphere_is_found(plant, modeled):
    true, found = plant[5], modeled.layers["centers"]
    assert len(found) == 1
    assert found.columns["radius"] == pytest.approx(true.columns["radius"], rel=0.01)
    np.testing.assert_allclose(found.geometries[0], true.geometries[0], atol=0.01)


def test_points_of_a_surface_without_a_shape_keep_its_number(plant, modeled):
    """Elbows are part of the surface of their pipes, and of no cylinder."""
    without = (modeled.cloud.get("shape") == 0) & (modeled.cloud.get("segment_id") > 0)
    assert without.any()
    shaped = modeled.cloud.get("segment_id")[modeled.cloud.get("shape") > 0]
    assert not np.isin(modeled.cloud.get("segment_id")[without], shaped).any()
