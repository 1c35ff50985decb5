"""Components of voxels: the labels of scipy.ndimage on the dense grid, and what morphology is for."""

import tracemalloc

import numpy as np
import pytest
from scipy import ndimage

from lidar_buildings.algorithms.segmentation.segment_voxels import segment_voxels as stage
from lidar_buildings.tests.builders import FAR


def segment_voxels(xyz, classification=None, **tunables):
    classification = np.ones(len(xyz), np.uint8) if classification is None else classification
    return stage(xyz, classification, **tunables)


def same_groups(one, other):
    """Whether two labelings (n,) hold the same groups, whatever their numbers."""
    pairs = np.unique(np.column_stack([one, other]), axis=0)
    return len(pairs) == len(np.unique(one)) == len(np.unique(other))


@pytest.mark.parametrize("neighbors", ["6", "18", "26"])
@pytest.mark.parametrize("min_count", [1, 2])
def test_segments_are_components_of_the_dense_grid(rng, neighbors, min_count):
    xyz = rng.uniform(0, [12, 10, 8], (300, 3))
    xyz[0] = 0.0
    grid = np.zeros((12, 10, 8), int)
    np.add.at(grid, tuple(np.floor(xyz).astype(int).T), 1)
    element = ndimage.generate_binary_structure(3, {"6": 1, "18": 2, "26": 3}[neighbors])
    labels = ndimage.label(grid >= min_count, element)[0][tuple(np.floor(xyz).astype(int).T)]
    ids, voxels = segment_voxels(xyz, voxel_size=1.0, neighbors=neighbors, min_count=min_count)
    np.testing.assert_array_equal(ids == 0, labels == 0)
    assert same_groups(ids, labels)
    assert len(voxels) == (grid >= min_count).sum()
    assert sum(voxels.columns["count"]) == grid[grid >= min_count].sum()
    assert set(voxels.columns["segment_id"]) == set(ids[ids > 0])


def two_blocks(rng, gap):
    """Two solid blocks of 3 m with a gap (m) between them, and a wire that hangs between their tops."""
    blocks = [rng.uniform((west, 0, 0), (west + 3, 3, 3), (6000, 3)) for west in (0.0, 3.0 + gap)]
    blocks[0][0] = 0.0
    wire = np.column_stack([np.linspace(3, 3 + gap, 40), np.full(40, 1.52), np.full(40, 1.52)])
    return np.concatenate([*blocks, wire]), np.repeat([0, 1, 2], [6000, 6000, 40])


def test_opening_cuts_a_wire_and_closing_fills_a_gap(rng):
    xyz, part = two_blocks(rng, 1.2)
    ids, _ = segment_voxels(xyz, voxel_size=0.3)
    assert (ids == 1).all()
    ids, _ = segment_voxels(xyz, voxel_size=0.3, operation="opening")
    assert (ids[part == 0] == 1).mean() > 0.99
    assert (ids[part == 1] == 2).mean() > 0.99
    assert (ids[part == 2] == 0).mean() > 0.8
    blocks = xyz[part < 2]
    assert segment_voxels(blocks, voxel_size=0.3)[0].max() == 2
    assert segment_voxels(blocks, voxel_size=0.3, operation="closing", steps=2)[0].max() == 1
    assert segment_voxels(blocks, voxel_size=0.3, operation="dilation", steps=2)[0].max() == 1
    eroded, voxels = segment_voxels(blocks, voxel_size=0.3, operation="erosion")
    assert (eroded > 0).sum() == sum(voxels.columns["count"]) < 0.7 * len(blocks)


def test_distances_and_skeleton_of_a_bar(rng):
    """A bar of 0.9 by 0.9 by 6 m: the distance in its middle, and one line through it.

    One voxel is empty by chance; a skeleton would keep the cavity as a hollow ball.
    """
    xyz = rng.uniform(0, [6, 0.9, 0.9], (40_000, 3))
    xyz[0] = 0.0
    ids, voxels = segment_voxels(xyz, voxel_size=0.1)
    assert max(voxels.columns["distance"]) == pytest.approx(0.5)
    thin_ids, line = segment_voxels(xyz, voxel_size=0.1, operation="closing", thin=True)
    np.testing.assert_array_equal(thin_ids, ids)
    centers = np.array(line.geometries)
    np.testing.assert_allclose(centers[:, 1:], 0.45, atol=1e-9)
    assert len(centers) == pytest.approx(54, abs=2)


def test_a_segment_of_too_few_points_and_noise_have_no_id(rng):
    xyz = np.concatenate([rng.uniform(0, 2, (200, 3)), rng.uniform(10, 10.4, (4, 3)), [[1.0, 1.0, 30.0]]])
    classification = np.repeat([1, 18], [204, 1]).astype(np.uint8)
    ids, voxels = segment_voxels(xyz, classification, voxel_size=1.0, min_points=5)
    assert ids.tolist() == [1] * 200 + [0] * 5
    assert 0 in set(voxels.columns["segment_id"])
    assert segment_voxels(xyz, classification, voxel_size=1.0)[0][-2:].tolist() == [2, 0]


def test_order_and_position_change_nothing(rng):
    xyz = rng.uniform(0, [20, 20, 5], (600, 3)).round(3)
    ids, voxels = segment_voxels(xyz, voxel_size=1.0, neighbors="6")
    order = rng.permutation(600)
    assert same_groups(segment_voxels(xyz[order], voxel_size=1.0, neighbors="6")[0], ids[order])
    far_ids, far = segment_voxels(xyz + FAR, voxel_size=1.0, neighbors="6")
    np.testing.assert_array_equal(far_ids, ids)
    np.testing.assert_allclose(np.array(far.geometries) - FAR, np.array(voxels.geometries), atol=1e-6)


def test_a_wire_across_a_valley_takes_no_grid(rng):
    """6 km of wire in voxels of 5 cm: the box has 10^14 cells."""
    along = np.linspace(0, 1, 150_000)[:, None]
    xyz = along * [6000.0, 6000.0, 300.0]
    tracemalloc.start()
    ids, _ = segment_voxels(xyz, voxel_size=0.1, operation="closing")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (ids == 1).all()
    assert peak < 1.2e9


def test_voxels_too_fine_are_refused():
    with pytest.raises(ValueError, match="more than can be numbered; remove points that lie far off"):
        segment_voxels(np.array([[0.0, 0, 0], [1e5, 1e5, 1e5]]), voxel_size=0.001)


def test_a_filter_of_counts_removes_scattered_points_and_bridges_a_gap():
    """A row of full voxels with one empty one, and a voxel with four points aside."""
    along = np.repeat([0.5, 1.5, 2.5, 4.5, 5.5, 6.5], 9)
    xyz = np.column_stack([np.append(along, [20.5] * 4), np.full(58, 0.5), np.full(58, 0.5)])
    assert segment_voxels(xyz, voxel_size=1.0)[0].max() == 3
    smooth, layer = segment_voxels(xyz, voxel_size=1.0, count_filter="binomial")
    np.testing.assert_array_equal(smooth, np.repeat([1, 0], [54, 4]))
    assert max(layer.columns["filtered"]) == pytest.approx(9 / 4)
    assert not segment_voxels(xyz, voxel_size=1.0, count_filter="median")[0].any()
