"""Segments that meet and rings that are valid, by hand."""

import numpy as np

from lidar_buildings.algorithms.buildings.segments import is_inside, is_valid, meet_in_corners, segments_meet

L_SHAPE = np.array([[0, 0], [20, 0], [20, 8], [9, 8], [9, 16], [0, 16], [0, 0]], float)


def test_validity():
    square = np.array([[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], float)
    bow_tie = np.array([[0, 0], [4, 4], [4, 0], [0, 4], [0, 0]], float)
    hole = square[::-1] / 4 + 1
    assert is_valid([square])
    assert not is_valid([bow_tie])
    assert is_valid([square, hole])
    assert not is_valid([square, hole + 10])
    assert not is_valid([square, hole + 2.5])
    assert not is_valid([square, hole, hole])
    spike = np.array([[0, 0], [4, 0], [8, 0], [4, 0], [4, 4], [0, 4], [0, 0]], float)
    assert not is_valid([spike])


def test_inside():
    assert is_inside(np.array([5.0, 5]), L_SHAPE)
    assert not is_inside(np.array([15.0, 12]), L_SHAPE)


def test_segments_that_meet():
    a, b = np.array([[0, 0], [10, 0]], float), np.array([[4, 0], [10, 4]], float)
    assert segments_meet(a, b, np.array([[2.0, -1]]), np.array([[2.0, 1]]))
    assert not segments_meet(a, b, np.array([[5.0, -1]]), np.array([[5.0, 1]]))


def test_borders_meet_in_corners_only():
    """Two squares that share a side, given once by each, and the same with a third line through both."""
    starts = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [1, 1], [1, 0], [2, 0], [2, 1]], float)
    ends = np.array([[1, 0], [1, 1], [0, 1], [0, 0], [1, 0], [2, 0], [2, 1], [1, 1]], float)
    assert meet_in_corners(starts, ends)
    assert not meet_in_corners(np.vstack([starts, [[0, 0]]]), np.vstack([ends, [[2, 0.5]]]))
    # A corner on another's side is no corner of both.
    assert not meet_in_corners(np.vstack([starts, [[0.5, 0]]]), np.vstack([ends, [[0.5, 0.5]]]))
