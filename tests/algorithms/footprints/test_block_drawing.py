"""Blocks drawn by each strategy, and its steps by themselves."""

import numpy as np
import pytest

from lidar_buildings.algorithms.footprints import block_drawing as draw
from lidar_buildings.algorithms.footprints.blocks import split_blocks
from lidar_buildings.algorithms.geometry.polylines import OutlineEdge
from lidar_buildings.algorithms.geometry.rings import signed_area
from lidar_buildings.tests.polygon_validity import assert_valid
from lidar_buildings.tests.tracings import grid, side_by_side

SQUARE = np.array([[0, 0], [10, 0], [10, 10], [0, 10]], float)


def edge(point, degrees, length=5.0):
    angle = np.deg2rad(degrees)
    return OutlineEdge(np.array([np.cos(angle), np.sin(angle)]), np.array(point, float), length, 0, 1)


@pytest.fixture(scope="module")
def block():
    """Two houses of 7 m by 8 m, side by side."""
    return split_blocks(grid(side_by_side(8, 8, height=9)))[0]


@pytest.mark.parametrize("strategy", [*draw.REGULARIZED, *draw.AS_TRACED, lambda block, _: draw.draw_points(block)])
def test_every_strategy_draws_the_border_once(block, strategy):
    drawing = strategy(block, 0.5)
    vertices = []
    for rings in drawing.rings.values():
        assert_valid(rings)
        vertices.append({tuple(vertex) for vertex in rings[0].tolist()})
    assert len(vertices[0] & vertices[1]) >= 2
    # 16 by 9 points, a meter apart, and what lies outward of them.
    assert 15 * 8 - 2 < drawing.area < 16 * 9


def test_straight_houses_have_four_corners_and_their_border_two_ends(block):
    drawing = draw.draw_straight(block, 0.5)
    assert drawing.straight == {0, 1}
    assert [len(rings[0]) - 1 for rings in drawing.rings.values()] == [4, 4]


def test_chords_and_traced_outlines_are_not_called_straight(block):
    assert not draw.draw_chords(block, 0.5).straight
    assert not draw.draw_traced(block, 0.5).straight
    assert not draw.draw_points(block).straight


def test_without_a_main_direction_nothing_is_straightened():
    y, x = np.mgrid[-7:8, -7:8]
    (disc,) = split_blocks(grid((np.hypot(x, y) < 6.6).astype(int)))
    assert draw.draw_straight(disc, 0.4) is None
    assert draw.draw_chords(disc, 0.4) is not None


def test_the_points_themselves_are_drawn_with_nothing_outward(block):
    drawing = draw.draw_points(block)
    points = {tuple(point) for point in block.mesh.xy.tolist()}
    assert all(tuple(vertex) in points for rings in drawing.rings.values() for vertex in rings[0].tolist())
    assert drawing.area == pytest.approx(15 * 8, rel=0.01)


@pytest.mark.parametrize(
    ("edges", "expected"),
    [
        # Without an edge, the nearest position; with one, where it meets the ring within the limit.
        ([], ([5.0, 0.0], 0, 0.5)),
        ([edge([6, 5], 90)], ([6.0, 0.0], 0, 0.6)),
        # Of two edges the longer one counts.
        ([edge([6, 5], 90), edge([4, 5], 90, length=7.0)], ([4.0, 0.0], 0, 0.4)),
        # An edge that meets the ring too far away doesn't count.
        ([edge([9, 5], 90)], ([5.0, 0.0], 0, 0.5)),
    ],
)
def test_where_a_border_meets_the_ring(edges, expected):
    anchor = draw._on_ring(SQUARE, np.array([5.0, -0.5]), edges, limit=2.0)
    position, segment, share = expected
    assert anchor.position == pytest.approx(position)
    assert (anchor.segment, anchor.share) == (segment, pytest.approx(share))


@pytest.mark.parametrize(
    ("edges", "expected"),
    [
        ([edge([1, 9], 90), edge([9, 1], 0)], [1, 1]),
        # Parallel edges a little apart: half-way between, where the traced position leaves it along them.
        ([edge([0.8, 9], 90), edge([1.2, -9], 90)], [1, 0]),
        # Too far from the traced position.
        ([edge([3, 9], 90), edge([9, 3], 0)], [0, 0]),
        ([], [0, 0]),
    ],
)
def test_where_borders_meet_inside_a_block(edges, expected):
    anchor = draw._where_lines_meet(np.zeros(2), edges, limit=2.0)
    assert anchor.segment is None
    assert anchor.position == pytest.approx(expected, abs=0.02)


def on_square(segment, share):
    start, end = SQUARE[segment], SQUARE[(segment + 1) % 4]
    return draw.Anchor(start + share * (end - start), segment, share)


@pytest.mark.parametrize(
    ("first", "last", "corners"),
    [
        ((0, 0.2), (0, 0.7), []),
        ((0, 0.7), (0, 0.2), [1, 2, 3, 0]),
        ((0, 0.5), (2, 0.5), [1, 2]),
        ((3, 0.5), (1, 0.5), [0, 1]),
        # At the corner itself, which doesn't come twice.
        ((0, 0.5), (1, 0.0), []),
    ],
)
def test_the_part_of_a_ring_between_two_anchors(first, last, corners, block):
    piece = next(piece for piece in block.outlines[0][0] if piece.ring is not None)
    anchors = dict(zip(piece.ends, (on_square(*first), on_square(*last))))
    part = draw._part_of_ring(piece, SQUARE, anchors)
    np.testing.assert_array_equal(part[1:-1], SQUARE[corners].reshape(-1, 2))
    np.testing.assert_array_equal(part[[0, -1]], [anchors[end].position for end in piece.ends])


def test_a_ring_between_anchors_inside_the_block_does_not_fit(block):
    piece = next(piece for piece in block.outlines[0][0] if piece.ring is not None)
    anchors = dict(zip(piece.ends, (on_square(0, 0.5), draw.Anchor(np.zeros(2)))))
    assert draw._part_of_ring(piece, SQUARE, anchors) is None


def test_a_polygon_has_one_exterior():
    ring = np.concatenate([SQUARE, SQUARE[:1]])
    hole = 5 + (ring[::-1] - 5) / 2
    made = draw._exterior_first([hole, ring])
    assert [signed_area(one) for one in made] == [100, -25]
    assert draw._exterior_first([ring, ring + 20]) is None
    assert draw._exterior_first([hole]) is None
    assert draw._exterior_first([ring, None]) is None
    assert draw._exterior_first([ring, ring[[0, 1, 0]]]) is None
