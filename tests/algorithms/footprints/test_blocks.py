"""The outline of buildings that touch, in pieces: what is shared, and where borders end."""

import numpy as np
import pytest

from lidar_buildings.algorithms.footprints.blocks import split_blocks
from lidar_buildings.tests.tracings import grid, side_by_side


def test_a_house_by_itself_is_one_closed_piece():
    (block,) = split_blocks(grid(side_by_side(6)))
    ((piece,),) = block.outlines[0]
    assert piece.is_closed
    assert piece.ring == 0
    assert block.borders == block.junctions == ()
    np.testing.assert_array_equal(np.sort(piece.half_edges), np.sort(block.rings[0]))


def test_two_houses_share_one_border_that_ends_on_the_ring_around_both():
    (block,) = split_blocks(grid(side_by_side(5, 5)))
    assert len(block.rings) == len(block.borders) == 1
    assert sorted(junction.point for junction in block.junctions) == sorted(block.borders[0].ends)
    ring = block.mesh.starts[block.rings[0]]
    for junction in block.junctions:
        assert junction.ring == 0
        assert ring[junction.at] == junction.point
    for face, is_reversed in ((0, False), (1, True)):
        (pieces,) = block.outlines[face]
        assert sorted((piece.border is None, piece.ring is None) for piece in pieces) == [(False, True), (True, False)]
        assert [piece.is_reversed for piece in pieces if piece.border is not None] == [is_reversed]


def test_the_middle_house_of_a_row_has_a_border_on_either_side():
    (block,) = split_blocks(grid(side_by_side(4, 4, 4)))
    assert len(block.borders) == 2
    assert len(block.junctions) == 4
    assert sorted(len(rings[0]) for rings in block.outlines.values()) == [2, 2, 4]


def test_three_houses_meet_in_a_junction_inside_the_block():
    label = side_by_side(5, 5, height=8)
    label[4:] = 3
    (block,) = split_blocks(grid(label))
    inside = [junction for junction in block.junctions if junction.ring is None]
    assert len(block.borders) == 3
    assert len(inside) == 1
    assert sum(inside[0].point in border.ends for border in block.borders) == 3


def test_a_house_inside_another_has_a_closed_border_and_no_junction():
    label = np.ones((11, 11), int)
    label[4:7, 4:7] = 2
    (block,) = split_blocks(grid(label))
    (border,) = block.borders
    assert border.is_closed
    assert border.half_edges[0] == border.half_edges.min()
    assert block.junctions == ()
    assert [len(rings) for rings in block.outlines.values()] == [2, 1]


def test_houses_that_lie_apart_are_blocks():
    label = side_by_side(4, 3, 4)
    label[label == 2] = 0
    label[label == 3] = 2
    blocks = split_blocks(grid(label))
    assert [list(block.outlines) for block in blocks] == [[0], [1]]
    assert not any(block.borders for block in blocks)


@pytest.mark.parametrize("seed", range(6))
def test_pieces_go_around_each_face_once(seed):
    """Any division: each border has two pieces, one in either direction, and each half-edge one piece."""
    rng = np.random.default_rng(seed)
    tracing = grid(rng.integers(1, 5, (4, 4)).repeat(3, axis=0).repeat(3, axis=1))
    across = tracing.beyond(tracing.face)
    n_pieces = 0
    for block in split_blocks(tracing):
        rings = [ring for of_face in block.outlines.values() for ring in of_face]
        pieces = [piece for ring in rings for piece in ring]
        half_edges = np.concatenate([piece.half_edges for piece in pieces])
        assert len(np.unique(half_edges)) == len(half_edges)
        n_pieces += len(half_edges)
        uses = sorted((piece.border, piece.is_reversed) for piece in pieces if piece.border is not None)
        assert uses == [(number, back) for number in range(len(block.borders)) for back in (False, True)]
        for ring in rings:
            around = np.concatenate([piece.half_edges for piece in ring])
            np.testing.assert_array_equal(block.mesh.ends[around], np.roll(block.mesh.starts[around], -1))
    face = np.repeat(tracing.face, 3)
    assert n_pieces == ((face >= 0) & (face != across)).sum()


def test_twins_run_back_between_the_same_points():
    (block,) = split_blocks(grid(side_by_side(5, 5)))
    mesh = block.mesh
    inner = np.flatnonzero(mesh.twins >= 0)
    np.testing.assert_array_equal(mesh.starts[mesh.twins[inner]], mesh.ends[inner])
    np.testing.assert_array_equal(mesh.twins[mesh.twins[inner]], inner)
    # The hull of the points has no other side.
    assert (mesh.twins < 0).sum() >= 4


def test_samples_lie_outward_of_the_middle_of_edges():
    """East of the house, its edges run north: the samples lie as far east as the outset says."""
    (block,) = split_blocks(grid(side_by_side(6)))
    mesh, ring = block.mesh, block.rings[0]
    middle = (mesh.xy[mesh.starts[ring]] + mesh.xy[mesh.ends[ring]]) / 2
    center = middle.mean(axis=0)
    for share in (0.0, 0.5, 1.0):
        samples, length = mesh.samples(ring, share)
        np.testing.assert_allclose(np.hypot(*(samples - middle).T), share * mesh.outset[ring], atol=1e-12)
        assert (((samples - middle) * (middle - center)).sum(axis=1) >= 0).all()
        np.testing.assert_allclose(length, np.hypot(*(mesh.xy[mesh.ends[ring]] - mesh.xy[mesh.starts[ring]]).T))
