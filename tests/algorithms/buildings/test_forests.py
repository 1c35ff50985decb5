"""A closed forest at 1.5 points per m²: its crowns are no buildings, and a hut in it is one."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.packages import spatial
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline

DENSITY, SIDE = 1.5, 90.0

# West, south, east and north of a flat roof of 4 m in a clearing.
HUT = np.array([40.0, 40.0, 52.0, 50.0])


def forest(rng, hut=False):
    """Return the points of domes that touch, with leaves a meter deep; a tenth is of the ground below; and the roof."""
    plan = rng.uniform(0, SIDE, (round(DENSITY * SIDE**2), 2))
    trees = rng.uniform(0, SIDE, (round(SIDE**2 / 25), 2))
    distance, nearest = spatial.cKDTree(trees).query(plan)
    z = rng.uniform(12, 20, len(trees))[nearest] - 0.12 * distance**2 - rng.exponential(1.0, len(plan))
    passes = rng.random(len(plan)) < 0.1
    is_roof = hut & ((plan > HUT[:2]) & (plan < HUT[2:])).all(axis=1)
    around = hut & ((plan > HUT[:2] - 2) & (plan < HUT[2:] + 2)).all(axis=1)
    surface = np.where(is_roof, 4.0, 0.0) + rng.normal(0, 0.02, len(plan))
    z = np.where(passes & ~is_roof | around, surface, z)
    return np.column_stack([plan, z + plan[:, 0] / 10 * ~is_roof + 4.6 * is_roof]), is_roof


def found_in(xyz):
    cloud = create_cloud({"xyz": xyz})
    run_pipeline(PIPELINES["detect_buildings"], cloud, wanted=("output",))
    return cloud.get("classification") == PointClass.BUILDING


def area(xyz):
    return len(np.unique(np.floor(xyz[:, :2]), axis=0))


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2))])
def test_crowns_are_no_buildings(seed):
    """234 to 880 m² were, as smooth spots of crowns next to one another passed for surroundings of buildings."""
    xyz, _ = forest(np.random.default_rng(seed))
    assert area(xyz[found_in(xyz)]) <= 10


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2))])
def test_a_hut_in_it_is_one(seed):
    xyz, is_roof = forest(np.random.default_rng(seed), hut=True)
    is_building = found_in(xyz)
    assert is_building[is_roof].mean() > 0.85
    assert area(xyz[is_building & ~is_roof]) <= 25
