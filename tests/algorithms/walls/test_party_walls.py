"""Blocks of touching level roofs fall into houses where parapets or steps show the walls between them."""

import numpy as np
import pytest
from scipy import ndimage

from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.walls.classify_roofs import split_blocks

# Width and depth of a house, room around the block, cells in which matching rounds edges (m).
WIDTH, DEPTH, ROOM, CELL = 8.0, 9.0, 3.0, 0.1


def block(rng, levels, parapet=0.0, slope=0.0, density=40.0):
    """Return points of houses side by side on sloping ground, the house (from 1) that each is on, and heights (m)."""
    size = np.array([len(levels) * WIDTH, DEPTH]) + 2 * ROOM
    x, y = ((np.arange(round(length / CELL)) + 0.5) * CELL - ROOM for length in size)
    house = np.clip((x // WIDTH).astype(int), 0, len(levels) - 1)
    on_edge = np.minimum(x % WIDTH, WIDTH - x % WIDTH) < 0.3
    z = slope * np.tile(x, (len(y), 1))
    is_in = np.ix_((y >= 0) & (y < DEPTH), (x >= 0) & (x < len(levels) * WIDTH))
    is_edge = on_edge[None, :] | (np.minimum(y, DEPTH - y) < 0.3)[:, None]
    z[is_in] = (np.array(levels)[house][None, :] + parapet * is_edge)[is_in]
    z = ndimage.gaussian_filter(z, 0.15 / CELL)
    places = rng.uniform(0, size, (round(density * size.prod()), 2))
    column, row = (places / CELL).astype(int).T
    xyz = np.column_stack([places - ROOM, z[row, column] + rng.normal(0, 0.02, len(places))])
    height = xyz[:, 2] - slope * xyz[:, 0]
    return xyz, np.where(xyz[:, 2] > min(levels) - 0.5, house[column] + 1, 0), height


def parted(xyz, house, height):
    return split_blocks(xyz, height, (house > 0).astype(np.int32), 0.16, Monitor())


@pytest.mark.parametrize(
    ("levels", "parapet"),
    [((6, 6, 6, 6), 0.7), ((6, 6, 6, 6), 1.0), ((6, 6.5, 6, 6.5), 0.0), ((6, 7, 6), 0.0), ((6, 6.3, 6.6), 0.3)],
)
def test_walls_are_seen_by_parapets_and_steps(rng, levels, parapet):
    """On ground that falls by a meter and more next to the block."""
    xyz, house, height = block(rng, levels, parapet, slope=0.04)
    found = parted(xyz, house, height)
    assert found.max() == len(levels)
    # Houses are numbered from west to east, and points of the walls themselves may be on either side.
    assert (found == house).mean() > 0.97


@pytest.mark.parametrize("levels", [(6, 6, 6, 6), (6, 6.5)], ids=["nothing shows walls", "two are no row"])
def test_other_blocks_stay_one(rng, levels):
    xyz, house, height = block(rng, levels)
    np.testing.assert_array_equal(parted(xyz, house, height), house > 0)


def test_parts_of_a_building_beside_a_gap_stay_together(rng):
    """Two planes of one building two meters apart, which tracing parts."""
    xyz, house, height = block(rng, (6, 6))
    house[(xyz[:, 0] > 8) & (xyz[:, 0] < 11)] = 0
    np.testing.assert_array_equal(parted(xyz, house, height), house > 0)


@pytest.mark.parametrize("shape", ["a row", "far apart"])
def test_a_building_of_few_points_far_from_a_block_is_none_of_its_houses(rng, shape):
    """No triangle is drawn between points in a row, or too far apart."""
    xyz, house, height = block(rng, (6, 6.5, 6, 7))
    plan = [np.full(40, 80.0), np.linspace(0, 8, 40)] if shape == "a row" else rng.uniform(80, 100, (2, 40))
    xyz = np.concatenate([xyz, np.column_stack([*plan, np.full(40, 5.0)])])
    cluster_id = np.concatenate([house > 0, np.full(40, 2)]).astype(np.int32)
    found = split_blocks(xyz, np.append(height, np.full(40, 5.0)), cluster_id, 0.16, Monitor())
    assert found.max() == 5
    assert (found[-40:] == 5).all()
    assert (found[:-40] == house).mean() > 0.97


def test_the_order_of_points_does_not_matter(rng):
    xyz, house, height = block(rng, (6, 6.5, 6, 7))
    order = rng.permutation(len(xyz))
    expected = parted(xyz, house, height)[order]
    np.testing.assert_array_equal(parted(xyz[order], house[order], height[order]), expected)


def test_no_roof(rng):
    xyz = rng.uniform(0, 9, (50, 3))
    assert not split_blocks(xyz, xyz[:, 2], np.zeros(50, np.int32), 0.13, Monitor()).any()
