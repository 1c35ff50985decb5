"""The scene that most tests of classified buildings begin with."""

import numpy as np
import pytest

from lidar_buildings.tests.algorithms.buildings.parts import clusters
from lidar_buildings.tests.builders import crown, roof


@pytest.fixture
def garden(rng):
    """Three roofs and three crowns: clusters 1 to 6."""
    roofs = [roof(rng, 0, 0), roof(rng, 20, 0, 6, 6, 4), roof(rng, 40, 0, 20, 10, 9)]
    crowns = [crown(rng, 5, 30), crown(rng, 25, 30, 4, 9, 900), crown(rng, 45, 30, 2.5, 5, 250)]
    return clusters(*roofs, *crowns)


@pytest.fixture
def lawn(rng):
    """Points of the ground under the crowns of the garden: the beam passed these."""
    return np.column_stack([rng.uniform([-1, 24], [50, 36], (4000, 2)), rng.normal(0, 0.02, 4000)])
