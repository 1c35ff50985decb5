"""What lies on the surface of the ground is ground, and nothing else becomes it."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.terrain.complete_ground import complete_ground

HEIGHTS = np.array([-0.3, -0.1, 0.0, 0.05, 0.1, 0.11, 2.0], np.float32)
XYZ = np.column_stack([np.arange(7.0), np.zeros(7), HEIGHTS])


@pytest.mark.parametrize("looked_at", [0, 1])
def test_points_on_the_surface_become_ground(looked_at):
    made = complete_ground(XYZ, np.full(7, looked_at, np.uint8), HEIGHTS)
    np.testing.assert_array_equal(made == 2, np.abs(HEIGHTS) <= np.float32(0.1))


@pytest.mark.parametrize("kept", [2, 3, 6, 7, 9, 17, 64])
def test_other_classes_stay(kept):
    np.testing.assert_array_equal(complete_ground(XYZ, np.full(7, kept, np.uint8), HEIGHTS), kept)


def test_no_distance_adds_none():
    np.testing.assert_array_equal(complete_ground(XYZ, np.ones(7, np.uint8), HEIGHTS, max_distance=0.0), 1)


def test_a_second_flight_line_a_little_higher_is_ground():
    """Two strips 8 cm apart with 1 cm of noise: the filter takes the lower one, and the other has no class."""
    rng = np.random.default_rng(5)
    plan = rng.uniform(0, 40, (20_000, 2))
    step = np.repeat([0.0, 0.08], 10_000)
    cloud = create_cloud({"xyz": np.column_stack([plan, step + rng.normal(0, 0.01, 20_000)])})
    run_pipeline(PIPELINES["detect_buildings"], cloud)
    assert (cloud.get("classification") == 2).mean() > 0.99
