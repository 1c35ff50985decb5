"""Model terrain: the raster under a bridge shows the road, and objects leave no trace."""

import numpy as np

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.simulation.simulate_bridges import simulate_bridges


def test_the_terrain_goes_on_under_a_bridge_and_trees_leave_no_trace():
    """A cutting 6 m deep with a bridge over it; the land around it is level."""
    xyz, true, *_, decks = simulate_bridges(kind="cutting", density=4.0, seed=3)
    cloud = create_cloud({"xyz": xyz})
    rasters = run_pipeline(PIPELINES["model_terrain"], cloud).rasters
    classes = cloud.get("classification")
    is_deck = true == PointClass.BRIDGE_DECK
    assert (classes[is_deck] == PointClass.BRIDGE_DECK).mean() > 0.85
    assert (classes[true == PointClass.GROUND] == PointClass.GROUND).mean() > 0.98
    dtm = rasters["dtm"]
    middle = decks.geometries[0][0][:4].mean(axis=0)
    column, row = int((middle[0] - dtm.west) / dtm.cell_size), int((dtm.north - middle[1]) / dtm.cell_size)
    np.testing.assert_allclose(dtm.values[row, column], -6.0, atol=0.2)
    # One car stands on the road before the bridge.
    assert (dtm.values > 0.3).mean() < 0.001
