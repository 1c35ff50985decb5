"""Level lines of fields with known shapes, and of chance."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.level_lines import level_lines
from lidar_buildings.algorithms.geometry.rings import are_inside, is_valid, signed_area


def test_a_ring_has_an_exterior_and_a_hole():
    row, column = np.mgrid[:40, :50]
    distance = np.hypot(column - 20, row - 20)
    exterior, hole = level_lines(np.minimum(10 - distance, distance - 4))
    assert signed_area(exterior) == pytest.approx(np.pi * 100, rel=0.005)
    assert signed_area(hole) == pytest.approx(-np.pi * 16, rel=0.02)


def test_lines_part_positive_nodes_from_others(rng):
    """Saddles and edges of the lattice among them."""
    nodes = np.column_stack([axis.ravel() for axis in np.meshgrid(np.arange(15.0), np.arange(12.0))])
    for _ in range(20):
        field = rng.normal(0, 1, (12, 15))
        rings = level_lines(field)
        assert all(is_valid([ring]) for ring in rings)
        odd = sum(are_inside(nodes, ring).astype(int) for ring in rings) % 2
        np.testing.assert_array_equal(odd.reshape(12, 15), field > 0)


def test_nothing_positive_has_no_line():
    assert level_lines(np.zeros((3, 4))) == []
