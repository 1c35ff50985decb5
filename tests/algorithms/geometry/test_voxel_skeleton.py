"""Skeletons: the topology of the object, and lines one voxel wide."""

import itertools

import numpy as np
import pytest
from scipy import ndimage

from lidar_buildings.algorithms.geometry.sparse_voxels import neighbor_offsets
from lidar_buildings.algorithms.geometry.voxel_skeleton import is_simple, skeleton
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.monitors import Listening

CUBE = np.ones((3, 3, 3))


def euler_number(grid):
    """Corners less edges plus faces less cubes of the closed voxels: objects with 26 neighbors."""
    padded = np.pad(grid, 1)
    number = 0
    for axes in itertools.product((0, 1), repeat=3):
        # A corner, an edge or a face is there if one of the voxels around it is.
        part = padded
        for axis in np.flatnonzero(axes):
            part = part.take(range(1, part.shape[axis]), axis) | part.take(range(part.shape[axis] - 1), axis)
        number += (-1) ** (3 - sum(axes)) * int(part.sum())
    return number


def topology(grid):
    """Objects, components of the background, Euler number: together they determine the number of tunnels too."""
    objects = ndimage.label(grid, CUBE)[1]
    return objects, ndimage.label(~np.pad(grid, 1))[1], euler_number(grid)


def thinned(grid):
    kept = skeleton(np.argwhere(grid), Monitor())
    made = grid.copy()
    made[grid] = kept
    return made


def ball(radius, hole=0.0):
    away = np.sqrt(((np.indices((2 * radius + 3,) * 3) - radius - 1).astype(float) ** 2).sum(axis=0))
    return (away <= radius) & (away >= hole)


def torus():
    x, y, z = np.indices((30, 30, 12)) - np.array([14.5, 14.5, 5.5])[:, None, None, None]
    return (np.hypot(x, y) - 10) ** 2 + z**2 <= 9


SHAPES = {"ball": ball(7), "shell": ball(8, 5.0), "torus": torus(), "box": np.ones((9, 5, 20), bool)}


@pytest.mark.parametrize("name", SHAPES)
def test_topology_of_solids_is_kept(name):
    made = thinned(SHAPES[name])
    assert topology(made) == topology(SHAPES[name])
    assert made.sum() < 0.5 * SHAPES[name].sum()


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 0.7, 0.9])
def test_topology_of_random_voxels_is_kept(rng, share):
    grid = rng.random((14, 13, 12)) < share
    made = thinned(grid)
    assert not (made & ~grid).any()
    assert topology(made) == topology(grid)
    # Nothing more can be removed.
    np.testing.assert_array_equal(thinned(made), made)


def test_a_torus_becomes_the_closed_line_in_its_middle():
    ring = thinned(torus())
    neighbors = ndimage.convolve(ring.astype(int), CUBE.astype(int), mode="constant")[ring] - 1
    assert (neighbors == 2).mean() > 0.9
    assert 50 < ring.sum() < 80
    x, y, z = (np.argwhere(ring) - [14.5, 14.5, 5.5]).T
    assert np.abs(np.hypot(x, y) - 10).max() < 2
    assert np.abs(z).max() < 1.5


def test_a_thick_letter_y_becomes_three_lines_in_its_middle():
    grid = np.zeros((60, 9, 60), bool)
    x, y, z = np.indices(grid.shape)
    stem = (np.hypot(x - 30, y - 4) <= 3) & (z < 30) & (z > 2)
    for direction in (-1, 1):
        branch = (np.hypot((x - 30) - direction * (z - 29), y - 4) <= 2.5) & (z >= 28) & (z < 54)
        grid |= branch
    grid |= stem
    made = thinned(grid)
    neighbors = ndimage.convolve(made.astype(int), CUBE.astype(int), mode="constant")[made] - 1
    assert (neighbors == 1).sum() == 3
    assert np.abs(np.argwhere(made)[:, 1] - 4).max() <= 1


def test_simple_points_by_definition(rng):
    """Removal is checked on 5 by 5 by 5 voxels with scipy: it must change neither components nor tunnels."""
    steps = neighbor_offsets(26)
    around = rng.integers(0, 2**26, 400).astype(np.uint32) & rng.integers(0, 2**26, 400).astype(np.uint32)
    around[:200] |= rng.integers(0, 2**26, 200).astype(np.uint32)
    for bits, simple in zip(around.tolist(), is_simple(around)):
        grid = np.zeros((5, 5, 5), bool)
        grid[tuple((steps[[bool(bits >> bit & 1) for bit in range(26)]] + 2).T)] = True
        without = topology(grid)
        grid[2, 2, 2] = True
        assert simple == (topology(grid) == without)


def test_a_line_and_a_lonely_voxel_stay():
    line = np.column_stack([np.arange(20), np.arange(20) // 2, np.zeros(20, int)])
    cells = np.concatenate([line, [[40, 0, 0]]])
    assert skeleton(cells, Monitor()).sum() >= 20
    assert skeleton(cells, Monitor())[-1]
    assert len(skeleton(np.zeros((0, 3), np.int64), Monitor())) == 0


def test_cancel_gets_through():
    with pytest.raises(Cancelled):
        skeleton(np.argwhere(np.ones((5, 5, 5))), Listening(stop_at=0.0))
