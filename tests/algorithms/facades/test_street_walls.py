"""Footprints on the walls that were seen from the street."""

import numpy as np
import pytest

from lidar_buildings.algorithms.facades.plan_segments import PlanSegments
from lidar_buildings.algorithms.facades.street_walls import fitted_to_walls
from lidar_buildings.algorithms.stage import LayerFeatures


@pytest.mark.parametrize(("offset", "corners"), [(0.07, 5), (0.15, 6)])
def test_walls_that_go_on_behind_a_tree_have_a_step_where_they_are_clearly_offset(offset, corners):
    """A front of 20 m of which a tree hides 1 m; a scan is off by a few centimeters, a pilaster by more."""
    ring = np.array([[0, 0], [20, 0], [20, 10], [0, 10], [0, 0]], float)
    walls = PlanSegments(np.array([[0.0, 0], [10.5, -offset]]), np.array([[9.5, 0], [20.0, -offset]]), np.arange(2))
    made, seen = fitted_to_walls(LayerFeatures([[ring]], {}), walls)
    (outline,) = made.geometries[0]
    assert len(outline) - 1 == corners
    assert outline[:, 1].min() == pytest.approx(-offset)
    assert seen == pytest.approx([18.5 / 60], abs=0.02)
