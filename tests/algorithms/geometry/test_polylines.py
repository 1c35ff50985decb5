"""Vertices of lines that keep them within a tolerance."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.polylines import simplify
from lidar_buildings.algorithms.geometry.rings import nearest_edge_distances
from lidar_buildings.tests.builders import L_SHAPE


def farthest(points, line):
    """Return the largest distance of points from a line."""
    return nearest_edge_distances(points, line[:-1], line[1:]).max()


def traced(corners, rng, noise=0.1, step=0.3):
    """Return samples along the sides of a polygon, each moved a little."""
    corners = np.asarray(corners, float)
    sides = zip(corners, np.roll(corners, -1, axis=0))
    parts = [a + np.arange(0, 1, step / np.hypot(*(b - a)))[:, None] * (b - a) for a, b in sides]
    places = np.concatenate(parts)
    return places + rng.uniform(-noise, noise, places.shape)


def test_simplified_lines_keep_the_vertices_of_douglas_and_peucker(rng):
    def kept(line, low, high, tolerance):
        along, offset = line[high] - line[low], line[low + 1 : high] - line[low]
        share = np.clip(offset @ along / (along @ along), 0, 1)
        distance = np.hypot(*(offset - share[:, None] * along).T)
        if high - low < 2 or distance.max() <= tolerance:
            return [low]
        middle = low + 1 + int(np.argmax(distance))
        return kept(line, low, middle, tolerance) + kept(line, middle, high, tolerance)

    for tolerance in (0.05, 0.4, 3.0, 100.0):
        line = np.cumsum(rng.normal(size=(300, 2)), axis=0)
        expected = [*kept(line, 0, len(line) - 1, tolerance), len(line) - 1]
        assert simplify(line, tolerance, is_closed=False).tolist() == expected


def test_simplified_line_stays_within_the_tolerance(rng):
    raw = traced(L_SHAPE[:-1], rng)
    raw = np.concatenate([raw, raw[:1]])
    rows = simplify(raw[:-1], 0.5, is_closed=True)
    simple = raw[np.append(rows, rows[0])]
    assert len(simple) < 12
    assert (np.diff(rows) > 0).all()
    assert farthest(raw, simple) <= 0.5


@pytest.mark.parametrize("start", [0, 1, 40, 150])
def test_where_a_closed_line_begins_its_simplified_one_is_the_same(start, rng):
    raw = np.roll(traced(L_SHAPE[:-1], rng), start, axis=0)
    rows = simplify(raw, 0.5, is_closed=True)
    expected = simplify(np.roll(raw, -start, axis=0), 0.5, is_closed=True)
    assert sorted(((rows - start) % len(raw)).tolist()) == expected.tolist()


def test_of_a_closed_line_the_longest_extent_is_left_at_any_tolerance(rng):
    raw = traced(L_SHAPE[:-1], rng, noise=0.0)
    np.testing.assert_allclose(np.sort(raw[simplify(raw, 50.0, is_closed=True)], axis=0), [[0, 0], [20, 16]], atol=0.3)
