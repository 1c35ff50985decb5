"""Distances of outlines and squareness, of shapes for which both are known."""

import numpy as np
import pytest
from scipy.spatial.distance import directed_hausdorff

from lidar_buildings.algorithms.quality.polygon_comparison import hausdorff, positions_along, squareness


def ring(*corners):
    return np.array([*corners, corners[0]], float)


SQUARE = ring((0, 0), (10, 0), (10, 10), (0, 10))


@pytest.mark.parametrize("shift", [(0.0, 0.0), (0.7, 0.0), (0.3, 0.4)])
def test_the_distance_of_a_moved_square_is_the_length_of_the_shift(shift):
    assert hausdorff([SQUARE], [SQUARE + shift]) == pytest.approx(np.hypot(*shift))


def test_both_ways_count():
    longer = ring((0, 0), (14, 0), (14, 10), (0, 10))
    assert hausdorff([SQUARE], [longer]) == hausdorff([longer], [SQUARE]) == pytest.approx(4)


def test_a_courtyard_that_one_outline_lacks_counts():
    courtyard = ring((4, 3), (4, 7), (6, 7), (6, 3))
    assert hausdorff([SQUARE, courtyard], [SQUARE]) == pytest.approx(4, abs=0.05)


def test_a_bulge_between_vertices_counts():
    # The middle of the edge from (2, 3) to (8, 3) is 3 m above the south edge.
    notch = ring((0, 0), (1, 0), (2, 3), (8, 3), (9, 0), (10, 0), (10, 10), (0, 10))
    assert hausdorff([SQUARE], [notch]) == pytest.approx(3, abs=0.05)


def test_distances_are_those_of_scipy(rng):
    for _ in range(20):
        one, other = (ring(*rng.uniform(0, 20, (6, 2))) for _ in range(2))
        a, b = positions_along([one]), positions_along([other])
        theirs = max(directed_hausdorff(a, b)[0], directed_hausdorff(b, a)[0])
        # They compare positions with positions: half a step more at most.
        assert theirs - 0.06 <= hausdorff([one], [other]) <= theirs + 1e-9


def test_positions_are_close_and_hold_the_vertices():
    positions = positions_along([SQUARE])
    assert np.hypot(*np.diff(np.vstack([positions, positions[:1]]), axis=0).T).max() <= 0.1 + 1e-9
    assert all(np.hypot(*(positions - corner).T).min() < 1e-9 for corner in SQUARE)


@pytest.mark.parametrize("turn", [0.0, 17.0, 45.0, 89.9])
def test_rectangles_are_square_however_they_lie(turn):
    cos, sin = np.cos(np.deg2rad(turn)), np.sin(np.deg2rad(turn))
    assert squareness([SQUARE @ np.array([[cos, sin], [-sin, cos]])]) == pytest.approx(1)


def test_an_edge_across_the_corner_is_not_along_the_directions():
    cut = ring((0, 0), (10, 0), (10, 6), (6, 10), (0, 10))
    skew = np.hypot(4, 4)
    assert squareness([cut]) == pytest.approx(32 / (32 + skew))


@pytest.mark.parametrize(("turn", "counts"), [(5.4, True), (6.6, False)])
def test_edges_within_three_degrees_of_the_directions_count(turn, counts):
    """Two edges are turned against the other two; the directions lie halfway between, half the turn from both."""
    rise = 10 * np.tan(np.deg2rad(turn))
    tilted = 20 / np.cos(np.deg2rad(turn))
    expected = 1.0 if counts else tilted / (20 + tilted)
    assert squareness([ring((0, 0), (10, rise), (10, 10 + rise), (0, 10))]) == pytest.approx(expected)
