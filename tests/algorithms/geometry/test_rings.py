"""Positions along rings: as dense as asked for, unless they would not fit into memory."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.rings import along_sides, sampled_rings, sides_of_rings

SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0, 0]])


def test_positions_are_at_most_a_step_apart():
    np.testing.assert_allclose(
        sampled_rings([SQUARE], 0.5), [[0, 0], [0.5, 0], [1, 0], [1, 0.5], [1, 1], [0.5, 1], [0, 1], [0, 0.5]]
    )


@pytest.mark.parametrize("side", [1e6, 1e12])
def test_a_polygon_as_large_as_a_country_has_a_million_positions(side):
    """A vertex of a map that was far off took gigabytes."""
    assert len(sampled_rings([SQUARE * side], 0.1)) == pytest.approx(1e6, rel=0.01)
    assert len(along_sides(sides_of_rings([SQUARE * side]), 0.1)[0]) == pytest.approx(1e6, rel=0.01)
