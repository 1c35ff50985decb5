"""A simulated town on a river, and the classes that the default chain gives it."""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.simulation.simulate_town import simulate_town
from lidar_buildings.tests.shared_results import made_once


def river_town(density: float) -> tuple[np.ndarray, np.ndarray]:
    """Return found and true classes (n,) of a town of ``density`` pulses per m²; made once per run of the tests."""
    return made_once(f"river town {density}", lambda: _classified(density))


def _classified(density: float) -> tuple[np.ndarray, np.ndarray]:
    xyz, true, number, count, *_ = simulate_town(size=120.0, density=density, seed=3)
    cloud = create_cloud({"xyz": xyz, "return_number": number, "number_of_returns": count})
    run_pipeline(PIPELINES["detect_buildings"], cloud)
    return cloud.get("classification"), true
