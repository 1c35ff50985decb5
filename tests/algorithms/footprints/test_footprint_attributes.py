"""Attributes of footprints: which outline each point belongs to."""

import numpy as np
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.footprints.drawn_blocks import Outlined
from lidar_buildings.algorithms.footprints.footprint_attributes import _Owners

SPACING = 0.5


def nodes_of(first, last):
    """Return the nodes of a lattice of half a spacing in a box, positions (k, 2)."""
    columns, rows = np.meshgrid(*(np.arange(low, high) for low, high in zip(first, last)))
    return np.column_stack([columns.ravel(), rows.ravel()]) * SPACING / 2


def test_points_belong_to_the_outline_of_the_nearest_node(rng):
    """Two touching buildings and one apart, against a search tree of all nodes; far from all there is none."""
    parts = [nodes_of((0, 0), (20, 30)), nodes_of((20, 5), (45, 25)), nodes_of((60, -20), (70, -5))]
    owners = _Owners([Outlined(number, [], nodes, True) for number, nodes in enumerate(parts)], SPACING)
    positions = rng.uniform([-10, -12], [25, 15], (5000, 2))
    face = np.repeat(np.arange(3), [len(nodes) for nodes in parts])
    distance, nearest = cKDTree(np.concatenate(parts)).query(positions)
    expected = np.where(distance < 8 * SPACING, face[nearest], -1)
    # Between two nodes equally near either may be taken.
    second = cKDTree(np.concatenate(parts)).query(positions, 2)[0][:, 1]
    clear = second - distance > 1e-9
    assert set(expected) == {-1, 0, 1, 2}
    np.testing.assert_array_equal(owners.at(positions)[clear], expected[clear])
