"""Wiggly outlines of known buildings become those buildings; round ones are left alone."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.outlines import signed_area
from lidar_buildings.algorithms.buildings.regularize import (
    farthest,
    is_inside,
    is_valid,
    main_direction,
    regularize_outline,
    simplify_ring,
)

L_SHAPE = np.array([[0, 0], [20, 0], [20, 8], [9, 8], [9, 16], [0, 16], [0, 0]], float)


def wiggly(ring, rng, noise=0.15, step=0.4):
    """Return a ring with a vertex every ``step``, each moved a little."""
    parts = []
    for a, b in zip(ring, ring[1:]):
        share = np.arange(0, 1, step / np.hypot(*(b - a)))
        parts.append(a + share[:, None] * (b - a))
    points = np.concatenate(parts)
    points = points + rng.uniform(-noise, noise, points.shape)
    return np.concatenate([points, points[:1]])


def turned(ring, degrees):
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    return ring @ np.array([[c, s], [-s, c]])


@pytest.mark.parametrize("degrees", [0, 17, 45, 80])
def test_l_shape_gets_its_six_right_angles_back(rng, assert_valid, degrees):
    truth = turned(L_SHAPE, degrees) + [600_000, 5_000_000]
    (ring,) = regularize_outline([wiggly(truth, rng)], 0.5)
    assert_valid([ring])
    edges = np.diff(ring, axis=0)
    following = np.roll(edges, -1, axis=0)
    assert len(edges) == 6
    np.testing.assert_allclose(np.einsum("ij,ij->i", edges, following), 0, atol=1e-6)
    assert farthest(truth[:-1], ring) < 0.3
    assert signed_area(ring) == pytest.approx(signed_area(truth), rel=0.03)


def test_diagonal_wall_keeps_its_direction(rng, assert_valid):
    truth = np.array([[0, 0], [20, 0], [20, 6], [14, 12], [0, 12], [0, 0]], float)  # a corner cut at 45°
    (ring,) = regularize_outline([wiggly(truth, rng)], 0.5)
    assert_valid([ring])
    angle = np.rad2deg(np.arctan2(*np.diff(ring, axis=0).T[::-1])) % 180
    assert np.isclose(angle, 135, atol=6).sum() == 1
    assert farthest(truth[:-1], ring) < 0.5


def test_courtyard_is_straightened_too(rng, assert_valid):
    exterior = 2 * L_SHAPE
    hole = np.array([[5, 5], [5, 11], [13, 11], [13, 5], [5, 5]], float)
    made = regularize_outline([wiggly(exterior, rng), wiggly(hole, rng)], 0.5)
    assert_valid(made)
    assert len(made) == 2
    assert signed_area(made[1]) == pytest.approx(-48, rel=0.06)


def test_outset_moves_walls_outward(rng):
    raw = [wiggly(L_SHAPE, rng, noise=0.0)]
    (ring,) = regularize_outline(raw, 0.5, outset=0.2)
    assert signed_area(ring) == pytest.approx(signed_area(L_SHAPE) + 72 * 0.2 + 4 * 0.2**2, rel=1e-3)


def test_round_tower_is_left_alone():
    angle = np.linspace(0, 2 * np.pi, 200)
    circle = 8 * np.column_stack([np.cos(angle), np.sin(angle)])
    circle[-1] = circle[0]
    assert regularize_outline([circle], 0.1) is None


def test_main_direction_is_that_of_the_longest_walls():
    assert main_direction([turned(L_SHAPE, 30)]) == pytest.approx(np.deg2rad(30))
    assert main_direction([turned(L_SHAPE, 120)]) == pytest.approx(np.deg2rad(30))


def test_simplified_ring_stays_within_the_tolerance(rng):
    raw = wiggly(L_SHAPE, rng)
    simple = simplify_ring(raw, 0.5)
    assert len(simple) < 12
    assert (simple[0] == simple[-1]).all()
    assert farthest(raw, simple) <= 0.5
    assert {tuple(point) for point in simple} <= {tuple(point) for point in raw}


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
