"""Outlines as an old map would draw them."""

import numpy as np
import pytest

from lidar_buildings.algorithms.quality.building_maps import BuildingMap
from lidar_buildings.algorithms.quality.map_fit import MapFit, in_frame


@pytest.mark.parametrize(("twice", "box"), [(False, [-0.7, 0.3, 8.7, 7.7]), (True, [-1.0, 0.0, 9.0, 8.0])])
def test_outlines_are_shifted_back_and_lose_their_overhang_but_with_a_corner_twice(twice, box):
    """The house is 10 by 8 m with an overhang of 0.3 m, and lies 1 m farther east than in the map."""
    ring = np.array([[0, 0], [10, 0], [10, 8], [0, 8], [0, 0]], float)
    ring = ring[[0, 1, 1, 2, 3, 4]] if twice else ring
    new = BuildingMap([[ring]], ["house"], np.zeros(1, np.int64))
    ((made,),) = in_frame(new, MapFit(np.array([1.0, 0.0]), 0.3, 0.0, np.zeros((1, 2))))
    assert [*made.min(axis=0), *made.max(axis=0)] == pytest.approx(box)
