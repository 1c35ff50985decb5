"""Rings drawn from samples along known shapes."""

from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry import ring_drawing
from lidar_buildings.algorithms.geometry.ring_directions import direction_weights, main_directions
from lidar_buildings.algorithms.geometry.ring_drawing import Prices, draw_ring
from lidar_buildings.tests.builders import L_SHAPE, turned

SPACING = 0.5


def sampled(corners):
    """Return samples a spacing apart along a ring, with deviations of a tenth of that."""
    ring = np.concatenate([corners, corners[:1]])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(ring, axis=0).T))])
    wanted = np.arange(0, along[-1], SPACING)
    samples = np.column_stack([np.interp(wanted, along, ring[:, axis]) for axis in (0, 1)])
    return samples + np.random.default_rng(3).normal(0, 0.1 * SPACING, samples.shape)


@pytest.mark.parametrize("degrees", [0, 20, 33, 77])
def test_an_l_has_six_edges_along_its_directions_wherever_its_samples_begin(degrees):
    shape = turned(np.asarray(L_SHAPE, float)[:6], degrees)
    samples = sampled(shape)
    weights = direction_weights(samples)
    directions = main_directions(weights, weights, len(samples))
    assert abs((directions[0] - degrees + 45) % 90 - 45) < 1.0
    for first in (0, 17, 40):
        edges = draw_ring(np.roll(samples, first, axis=0), directions, Prices(10 * SPACING**3))
        assert len(edges) == 6
        assert all(edge.is_main for edge in edges)
        corners = np.array([edge.start for edge in edges])
        assert np.hypot(*(shape[:, None] - corners).transpose(2, 0, 1)).min(axis=1).max() < 0.5 * SPACING


def test_a_dearer_corner_leaves_out_a_bay():
    """A bay 1 m deep and 2 m wide in a front of 20 m."""
    shape = np.array([[0, 0], [9, 0], [9, -1], [11, -1], [11, 0], [20, 0], [20, 10], [0, 10]], float)
    samples = sampled(shape)
    sizes = [len(draw_ring(samples, np.zeros(1), Prices(price))) for price in (0.1, 5.0)]
    assert sizes == [8, 4]


def test_a_circle_has_no_direction_and_is_drawn_in_chords():
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    samples = 8 * np.column_stack([np.cos(angle), np.sin(angle)])
    weights = direction_weights(samples)
    directions = main_directions(weights, weights, len(samples))
    assert len(directions) == 0
    edges = draw_ring(samples, directions, Prices(10 * SPACING**3))
    assert 8 <= len(edges) <= 30
    assert max(abs(np.hypot(*edge.start) - 8) for edge in edges) < SPACING


@pytest.mark.parametrize("directions", [np.zeros(0), np.array([12.0]), np.array([12.0, 40.0])])
def test_how_many_ends_are_worked_on_at_once_changes_nothing(directions, monkeypatch):
    samples = sampled(turned(3 * np.asarray(L_SHAPE, float)[:6], 12))
    rings = []
    for rounds in (1, 2, 7, 1000):
        monkeypatch.setattr(ring_drawing, "_AT_ONCE", rounds * ring_drawing._SHORTEST)
        edges = draw_ring(samples, directions, Prices(10 * SPACING**3))
        rings.append(np.array([[*edge.start, *edge.end] for edge in edges]))
    for ring in rings[1:]:
        np.testing.assert_array_equal(ring, rings[0])


def test_long_curved_walls_have_no_main_directions():
    """A hall of 20 m between half circles of 40 m: the curved walls cost less than a price for each of their edges."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, 400)
    arc = 40 * np.column_stack([np.cos(angle), np.sin(angle)]) + [10, 0]
    prices, along = Prices(10 * SPACING**3), np.zeros(1)
    free = [
        sum(not edge.is_main for edge in draw_ring(sampled(np.concatenate([arc, -arc])), along, one))
        for one in (prices, replace(prices, curved=np.inf))
    ]
    # Curved walls cost less with more edges than this: each saves the difference of the prices.
    least = prices.curved / (prices.other - prices.other_curved)
    assert free[0] > least >= free[1]
