"""What blocks found each for itself, put together: numbers of segments, and features that several blocks found."""

import numpy as np

from lidar_buildings.algorithms.stage import Layer, LayerFeatures, Monitor
from lidar_buildings.algorithms.tiling.block_result import BlockResult
from lidar_buildings.algorithms.tiling.blocks import Block
from lidar_buildings.algorithms.tiling.joining import join_features, join_numbers

FOOTPRINTS = Layer("footprints", "Footprints", "Polygon", ())


def result(used, inside=(), beside=(), features=None):
    """Return what a block found: its cluster numbers, and (file, place, number) of records at its edges."""
    made = BlockResult(np.zeros(0, np.int32), np.zeros(0, np.int64), used={"cluster_id": np.array(used, np.int64)})
    made.inside = {"cluster_id": np.reshape(np.array(inside, np.int64), (-1, 3))}
    made.beside = {"cluster_id": np.reshape(np.array(beside, np.int64), (-1, 3))}
    ends = [number for *_, number in (*inside, *beside)]
    made.most = {"cluster_id": np.array([max(ends, default=0)], np.int64)}
    made.layers = {} if features is None else {"footprints": features}
    return made


def joined(*results):
    """Join blocks that lie side by side."""
    blocks = [Block(column, 0, 10.0) for column in range(len(results))]
    return join_numbers(blocks, list(results), lambda at: (results[at].inside, results[at].beside), {})


def square(west, south, side, number):
    ring = np.array([[0, 0], [side, 0], [side, side], [0, side], [0, 0]], float) + [west, south]
    return LayerFeatures([[ring]], {"id": [1], "cluster_id": [number]})


def test_segments_that_go_on_in_the_next_block_get_one_number():
    first = result([1, 3], inside=[(0, 7, 3)], beside=[(0, 8, 3)])
    second = result([1, 2], inside=[(0, 8, 2)], beside=[(0, 7, 2)])
    one, other = (numbers["cluster_id"] for numbers in joined(first, second))
    assert one.tolist() == [0, 1, 0, 2]
    assert other.tolist() == [0, 3, 2]


def test_a_feature_whose_points_are_all_in_other_blocks_is_no_error():
    """A survey ended with an IndexError: the box of a slanted building reached into a block, but none of its points."""
    first = result([1], features=square(5, 5, 2, 9))
    (numbers,) = joined(first)
    assert numbers["cluster_id"].tolist() == [0, 1, *[0] * 8]
    blocks = [Block(0, 0, 10.0)]
    found, _ = join_features(
        blocks, [first.layers["footprints"]], [numbers["cluster_id"]], np.zeros(3), Monitor(), FOOTPRINTS
    )
    assert found.columns == {"id": [1], "cluster_id": [0]}


def test_of_a_feature_that_two_blocks_found_that_of_its_middle_stays():
    blocks = [Block(0, 0, 10.0), Block(1, 0, 10.0)]
    layers = [square(7, 2, 5, 1), square(7.1, 2, 5, 1)]
    numbers = [np.array([0, 1]), np.array([0, 2])]
    found, _ = join_features(blocks, layers, numbers, np.zeros(3), Monitor(), FOOTPRINTS)
    assert len(found) == 1
    assert found.geometries[0][0][0].tolist() == [7, 2]
    # Where the block of the middle has not found it, the other's stays; two that share little are two.
    assert len(join_features(blocks[1:], layers[1:], numbers[1:], np.zeros(3), Monitor(), FOOTPRINTS)[0]) == 1
    apart = [square(7, 2, 5, 1), square(11, 2, 5, 1)]
    assert len(join_features(blocks, apart, numbers, np.zeros(3), Monitor(), FOOTPRINTS)[0]) == 2
