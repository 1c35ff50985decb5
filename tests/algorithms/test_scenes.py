"""Scenes made by hand, whose truth is a formula: their arrays agree, and the chain finds their buildings only."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import NOISE, PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.tests.scenes import SCENES, gable_on_slope


@pytest.mark.parametrize("name", SCENES)
def test_scenes_made_by_hand_fit_together(name):
    made = SCENES[name]()
    assert made.xyz.shape == (len(made.classification), 3)
    assert (made.return_number >= 1).all()
    assert (made.return_number <= made.number_of_returns).all()
    assert (made.number_of_returns == 2).sum() == 2 * (made.return_number == 2).sum()
    np.testing.assert_array_equal(made.xyz, SCENES[name]().xyz)


def test_gable_on_slope_has_its_roof_where_the_formula_says():
    made = gable_on_slope(slope=10.0, pitch=35.0)
    is_roof = made.classification == PointClass.BUILDING
    x, y, z = made.xyz.T
    assert is_roof.sum() == pytest.approx(12 * 8 * 4, rel=0.1)
    np.testing.assert_allclose(z[is_roof], 6 + np.tan(np.deg2rad(35)) * (4 - np.abs(y[is_roof] - 50)))
    np.testing.assert_allclose(z[~is_roof], np.tan(np.deg2rad(10)) * (x[~is_roof] - 50))


@pytest.mark.parametrize("name", SCENES)
def test_the_default_chain_finds_roofs_and_takes_nothing_else_for_one(name):
    """No step in the terrain, crown at a wall, free-standing wall, bridge or bird becomes a building."""
    scene = SCENES[name](range_noise=0.02)
    given = {one: getattr(scene, one) for one in ("xyz", "return_number", "number_of_returns")}
    cloud = create_cloud(given)
    run_pipeline(PIPELINES["detect_buildings"], cloud)
    found, true = cloud.get("classification"), scene.classification
    is_building = true == PointClass.BUILDING
    assert (found[is_building] == PointClass.BUILDING).all()
    # A leaf that touches the eaves at the height of the roof may go with it.
    assert (found[~is_building] == PointClass.BUILDING).sum() <= 2
    assert (found[true == PointClass.GROUND] == PointClass.GROUND).mean() > 0.95
    np.testing.assert_array_equal(found[np.isin(true, NOISE)], true[np.isin(true, NOISE)])


# A step at the shore (m), and the share of the pulses that return from the water.
@pytest.mark.parametrize(("step", "share"), [(0.5, 1.0), (2.5, 0.05), (4.0, 0.3), (4.0, 0.0)])
def test_no_terrain_of_a_beach_that_is_half_water_is_called_building(step, share):
    """A tile of 40 by 48 m whose beach ends at the sea and at the border, up to a storey higher than the sea."""
    rng = np.random.default_rng(0)
    x, y = rng.uniform(0, [40, 48], (15 * 40 * 48, 2)).T
    shore = 20 + 2 * np.sin(y / 5)
    is_sand = x < shore
    z = np.where(is_sand, step + 0.08 * (shore - x), 0.03 * np.sin(x / 2)) + rng.normal(0, 0.02, len(x))
    kept = is_sand | (rng.random(len(x)) < share)
    cloud = create_cloud({"xyz": np.column_stack([x, y, z])[kept]})
    run_pipeline(PIPELINES["detect_buildings"], cloud)
    assert not (cloud.get("classification") == PointClass.BUILDING).any()
