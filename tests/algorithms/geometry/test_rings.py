"""Rings that are valid, positions along them, and distances of segments."""

from fractions import Fraction

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry import rings as module
from lidar_buildings.algorithms.geometry.rings import (
    along_sides,
    edge_distances,
    is_inside,
    is_valid,
    nearest_edge_distances,
    sampled_rings,
    sides_of_rings,
)
from lidar_buildings.tests.builders import L_SHAPE

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


def meet_exactly(a, b, c, d):
    """Whether the segments ab and cd, of whole numbers and some length, have a point in common, by their parameters."""
    (ux, uy), (vx, vy), (wx, wy) = b - a, d - c, c - a
    turn = int(ux * vy - uy * vx)
    if turn:
        return all(0 <= Fraction(int(x), turn) <= 1 for x in (wx * vy - wy * vx, wx * uy - wy * ux))
    axis = int(abs(uy) > abs(ux))
    one, other = sorted([a[axis], b[axis]]), sorted([c[axis], d[axis]])
    return wx * uy == wy * ux and one[0] <= other[1] and other[0] <= one[1]


@pytest.mark.parametrize("at_once", [1, 7, 1000])
def test_rings_are_valid_as_in_exact_integer_arithmetic(at_once, rng, monkeypatch):
    """Sides may only meet the sides before and after them, however many are compared at once."""
    monkeypatch.setattr(module, "PAIRS_AT_ONCE", at_once)
    rings = [rng.integers(0, 6, (count, 2)) for count in (4, 5, 6) for _ in range(60)]
    found, expected = [], []
    for corners in rings:
        ring = np.concatenate([corners, corners[:1]])
        sides = list(zip(ring[:-1], ring[1:]))
        apart = [(one, other) for i, one in enumerate(sides) for other in sides[i + 2 : len(sides) - (i == 0)]]
        has_length = all((a != b).any() for a, b in sides)
        expected.append(has_length and not any(meet_exactly(*one, *other) for one, other in apart))
        found.append(is_valid([ring.astype(float)]))
    assert found == expected
    assert 20 < sum(expected) < 160


def test_distances_to_segments_by_hand():
    """Next to one, before it, beyond it; and to one without length."""
    points = np.array([[2.0, 3], [-3, 4], [8, 4]])
    starts, ends = np.array([[0.0, 0], [2, 0]]), np.array([[5.0, 0], [2, 0]])
    np.testing.assert_allclose(edge_distances(points, starts, ends), [[3, 3], [5, np.hypot(5, 4)], [5, np.hypot(6, 4)]])


@pytest.mark.parametrize("at_once", [1, 20, 1000])
def test_the_nearest_position_on_a_line_is_on_its_nearest_segment(at_once, rng, monkeypatch):
    monkeypatch.setattr(module, "PAIRS_AT_ONCE", at_once)
    points, line = rng.uniform(-5, 25, (31, 2)), L_SHAPE
    share = np.linspace(0, 1, 2001)[:, None, None]
    places = (line[:-1] + share * (line[1:] - line[:-1])).reshape(-1, 2)
    expected = np.hypot(*np.moveaxis(points[:, None] - places, -1, 0)).min(axis=1)
    np.testing.assert_allclose(nearest_edge_distances(points, line[:-1], line[1:]), expected, atol=1e-2)


def test_inside():
    assert is_inside(np.array([5.0, 5]), L_SHAPE)
    assert not is_inside(np.array([15.0, 12]), L_SHAPE)
