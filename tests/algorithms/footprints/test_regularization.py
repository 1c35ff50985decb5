"""Wiggly outlines of known buildings become those buildings."""

from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.footprints.regularization import (
    _without_loops,
    chords,
    main_directions,
    regularize_outline,
    straighten,
)
from lidar_buildings.algorithms.geometry.line_segments import farthest, is_valid
from lidar_buildings.algorithms.geometry.polylines import Line, OutlineEdge, line_along
from lidar_buildings.algorithms.geometry.rings import signed_area
from lidar_buildings.tests.builders import L_SHAPE, turned
from lidar_buildings.tests.polygon_validity import assert_valid


def wiggly(ring, rng, noise=0.15, step=0.4):
    """Return a ring with a vertex every ``step``, each moved a little."""
    parts = []
    for a, b in zip(ring, ring[1:]):
        share = np.arange(0, 1, step / np.hypot(*(b - a)))
        parts.append(a + share[:, None] * (b - a))
    points = np.concatenate(parts)
    points = points + rng.uniform(-noise, noise, points.shape)
    return np.concatenate([points, points[:1]])


def straight(ring, tolerance=0.5):
    line = line_along(ring)
    directions = main_directions(line.edges(tolerance))
    corners = np.array(straighten(line, line.edges(tolerance, directions), directions, tolerance)[1])
    return np.concatenate([corners, corners[:1]])


@pytest.mark.parametrize("degrees", [0, 17, 45, 80])
def test_l_shape_gets_its_six_right_angles_back(rng, degrees):
    truth = turned(L_SHAPE, degrees) + [600_000, 5_000_000]
    ring = straight(wiggly(truth, rng))
    assert_valid([ring])
    edges = np.diff(ring, axis=0)
    following = np.roll(edges, -1, axis=0)
    assert len(edges) == 6
    np.testing.assert_allclose(np.einsum("ij,ij->i", edges, following), 0, atol=1e-6)
    # Noise of 15 cm in every sample: walls are fitted to all of theirs.
    assert farthest(truth[:-1], ring) < 0.1
    assert signed_area(ring) == pytest.approx(signed_area(truth), rel=0.01)


def test_diagonal_wall_keeps_its_direction(rng):
    truth = np.array([[0, 0], [20, 0], [20, 6], [14, 12], [0, 12], [0, 0]], float)  # a corner cut at 45°
    ring = straight(wiggly(truth, rng))
    assert_valid([ring])
    angle = np.rad2deg(np.arctan2(*np.diff(ring, axis=0).T[::-1])) % 180
    assert np.isclose(angle, 135, atol=3).sum() == 1
    assert farthest(truth[:-1], ring) < 0.2


def test_a_wall_that_is_five_degrees_off_is_not_bent(rng):
    """Turning a wall of 20 m by 5° would move its ends by 0.9 m."""
    truth = np.array([[0, 0], [20, 0], [20, 8], [0, 8 + 20 * np.tan(np.deg2rad(5))], [0, 0]])
    ring = straight(wiggly(truth, rng))
    assert len(ring) == 5
    assert farthest(truth[:-1], ring) < 0.15


def test_a_wing_of_another_direction_keeps_its_own(rng):
    """Two wings at an angle of 30°, each with right angles."""
    wing = turned(np.array([[0, 0], [18, 0], [18, 8], [4.6, 8]], float), 30) + [20, 0]
    truth = np.concatenate([[[0, 0]], wing, [[0, 8], [0, 0]]])
    ring = straight(wiggly(truth, rng))
    found = np.rad2deg(main_directions(line_along(wiggly(truth, rng)).edges(0.5)))
    off = np.abs((found[:, None] - [0, 30] + 45) % 90 - 45)
    assert (off.min(axis=0) < 2).all()
    assert farthest(truth[:-1], ring) < 0.25


def test_spikes_and_corners_that_no_point_has_hit_are_left_out(rng):
    spike = np.array([[0, 0], [9, 0], [9.1, -3], [9.2, 0], [20, 0], [20, 11.5], [19.5, 12], [0, 12], [0, 0]])
    ring = straight(wiggly(spike, rng, noise=0.02))
    assert len(ring) == 5
    assert farthest(np.array([[0, 0], [20, 0], [20, 12], [0, 12]]), ring) < 0.2


@pytest.mark.parametrize(("half_width", "depth"), [(0.2, 1.3), (0.5, 1.2), (0.55, 1.3)])
def test_notches_as_wide_as_deep_are_left_out_where_they_are_small(half_width, depth):
    """At a tolerance of 1 m, notches of up to 1.1 m by 1.3 m tell of points that are missing."""
    notch = [[9 - half_width, 0], [9, depth], [9 + half_width, 0]]
    truth = np.array([[0, 0], *notch, [20, 0], [20, 12], [0, 12], [0, 0]])
    for seed in range(8):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.05, 0.2), 1.0)
        assert len(ring) == 5
        assert farthest(np.array([[0, 0], [20, 0], [20, 12], [0, 12]]), ring) < 0.25


def test_a_step_behind_a_spike_stays():
    """Left and right of it, the wall is 45 cm off, nearly the tolerance."""
    truth = np.array([[0, 0], [9, 0], [9.1, -1.5], [9.3, -1.5], [9.4, 0.45], [20, 0.45], [20, 12], [0, 12], [0, 0]])
    for seed in range(8):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.05, 0.3))
        assert farthest(np.array([[0, 0], [20, 0.45]]), ring) < 0.1


def test_parallel_walls_a_little_apart_follow_each_other_in_one_corner():
    """Two walls of one side, 45 cm apart: no step of two corners, which nobody has seen."""
    ring = np.array([[x, 0.0] for x in range(10)] + [[x, 0.45] for x in range(10, 20)], float)
    line = line_along(np.concatenate([ring, [[20, 0.45], [20, 12], [0, 12], [0, 0]]]))
    walls = [line.fitted(a, b, 0.5) for a, b in ((0, 9), (10, 19), (20, 21), (21, 22))]
    walls = [replace(wall, is_main=True) for wall in walls]
    corners = np.array(straighten(line, walls, [0.0], 0.5)[1])
    between = corners[(corners[:, 0] > 5) & (corners[:, 0] < 15) & (corners[:, 1] < 5)]
    assert between[:, 1] == pytest.approx([0.225], abs=0.05)


@pytest.mark.parametrize(("width", "depth", "off"), [(4.0, 1.2, 0.4), (2.0, 0.7, 0.8)])
def test_bays_stay(width, depth, off):
    """On the long side of a house, at a tolerance of 0.5 m."""
    bay = [[8, 0], [8, -depth], [8 + width, -depth], [8 + width, 0]]
    truth = np.array([[0, 0], *bay, [20, 0], [20, 12], [0, 12], [0, 0]])
    for seed in range(12):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.05, 0.3))
        assert len(ring) == 9
        assert farthest(truth, ring) < off
        assert signed_area(ring) == pytest.approx(240 + width * depth, abs=0.8)


@pytest.mark.parametrize("radius", [7, 10, 20])
@pytest.mark.parametrize("degrees", [0, 30])
def test_a_curved_wall_is_a_chain_of_chords(rng, radius, degrees):
    """A house with a round end: its walls stay straight, and the curve turns to one side only.

    A chord of length L on a curve of radius R adds 4/45 L (L²/8R)² to the squares, and costs tolerance³ as it lies in
    no main direction. At R = 20 m the sum is least with L = 6.2 m: ten chords, three walls and the first corner again.
    """
    angle = np.linspace(-np.pi / 2, np.pi / 2, 60)
    end = [20, radius] + radius * np.column_stack([np.cos(angle), np.sin(angle)])
    truth = turned(np.concatenate([[[0, 0]], end, [[0, 2 * radius], [0, 0]]]), degrees)
    ring = straight(wiggly(truth, rng))
    assert_valid([ring])
    assert farthest(truth, ring) < 0.75
    assert farthest(ring, truth) < 0.75
    assert len(ring) <= 15
    step = np.diff(ring, axis=0)
    after = np.roll(step, -1, axis=0)
    turn = np.arctan2(step[:, 0] * after[:, 1] - step[:, 1] * after[:, 0], (step * after).sum(axis=1))
    assert turn.min() > np.deg2rad(-2)


@pytest.mark.parametrize(("length", "turns"), [(5.4, [-30, -18, -6, 6, 18, 30]), (3.0, [-45, -15, 15, 45])])
def test_chords_of_a_bow_keep_their_directions(length, turns):
    """One that happens to be nearly parallel to the house is not turned to it.

    Those that cost least on such bows, as above, are 6.8 and 3.8 m long; far shorter ones would be joined.
    """
    steps = length * np.column_stack([np.cos(np.deg2rad(turns)), np.sin(np.deg2rad(turns))])
    bow = np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)])
    truth = np.concatenate([bow, [[bow[-1, 0], 20], [0, 20], [0, 0]]])
    for seed in range(6):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.03, 0.3))
        step = np.diff(ring, axis=0)
        bottom = step[(ring[1:, 1] + ring[:-1, 1] < 6) & (step[:, 0] > 0.5)]
        assert len(bottom) >= 3
        assert np.rad2deg(np.abs(np.arctan2(*bottom.T[::-1]))).min() > 4


@pytest.mark.parametrize("degrees", [3, 5])
def test_between_walls_that_turn_to_and_fro_there_is_no_curve(degrees):
    """A wall of 5 m, nearly parallel to the house, between two that stand askew."""
    angles = np.deg2rad([25, degrees, 25])
    steps = np.array([[8.0], [5.0], [8.0]]) * np.column_stack([np.cos(angles), np.sin(angles)])
    side = np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)])
    truth = np.concatenate([side, [[side[-1, 0], 25], [0, 25], [0, 0]]])
    for seed in range(6):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.05, 0.3))
        angle = np.rad2deg(np.arctan2(*np.diff(ring, axis=0).T[::-1]))
        assert np.abs(angle).min() < 1.5


def test_chords_follow_a_ring_better_than_its_own_points():
    """A round tower: walls fitted to the points along it, not from one stray point to the next."""
    angle = np.linspace(0, 2 * np.pi, 121)
    circle = 8 * np.column_stack([np.cos(angle), np.sin(angle)])
    circle[-1] = circle[0]
    for seed in range(6):
        ring = circle + np.random.default_rng(seed).uniform(-0.15, 0.15, circle.shape)
        ring[-1] = ring[0]
        made = chords(line_along(ring), 0.3)
        made = np.concatenate([made, made[:1]])
        assert is_valid([made])
        assert len(made) < 24
        assert signed_area(made) == pytest.approx(np.pi * 64, rel=0.015)


def test_courtyard_is_straightened_too(rng):
    exterior = 2 * L_SHAPE
    hole = np.array([[5, 5], [5, 11], [13, 11], [13, 5], [5, 5]], float)
    made = regularize_outline([wiggly(exterior, rng), wiggly(hole, rng)], 0.5)
    assert_valid(made)
    assert len(made) == 2
    assert signed_area(made[1]) == pytest.approx(-48, rel=0.03)


def test_outset_moves_walls_outward(rng):
    (ring,) = regularize_outline([wiggly(L_SHAPE, rng, noise=0.0)], 0.5, outset=0.2)
    assert signed_area(ring) == pytest.approx(signed_area(L_SHAPE) + 72 * 0.2 + 4 * 0.2**2, rel=1e-3)


def test_a_round_tower_has_no_main_direction():
    angle = np.linspace(0, 2 * np.pi, 200)
    circle = 8 * np.column_stack([np.cos(angle), np.sin(angle)])
    circle[-1] = circle[0]
    assert main_directions(line_along(circle).edges(0.1)) == []
    assert regularize_outline([circle], 0.1) is None


def test_main_direction_is_that_of_the_longest_walls(rng):
    for degrees in (30, 120):
        found = main_directions(line_along(wiggly(turned(L_SHAPE, degrees), rng, noise=0.0)).edges(0.1))
        assert found == pytest.approx([np.deg2rad(30)])


@pytest.mark.parametrize("end", [[[24, 0], [24, 24 * np.tan(np.deg2rad(25))]], [[24, 0], [24, 8], [20, 9.33]]])
def test_a_sharp_end_is_no_spike(rng, end):
    """A wedge of 25° keeps its three or four walls; its tip may be blunt, and goes nowhere beyond the points."""
    truth = np.array([[0, 0], *end, [0, 0]])
    ring = straight(wiggly(truth, rng, noise=0.05, step=0.3))
    assert len(ring) <= 5
    assert farthest(np.array([[12.0, 0], *end, [12, 5.6]]), ring) < 0.2
    assert farthest(truth[:1], ring) < 1.3
    assert ring[:, 0].min() > -0.1


@pytest.mark.parametrize(("width", "depth", "stays"), [(1.2, 3.0, False), (1.8, 4.0, True)])
def test_spikes_are_narrower_than_three_tolerances(width, depth, stays):
    """The wider triangle on a wall is a bay, and of the other less is left than it is wide."""
    spike = [[8, 0], [8 + width / 2, -depth], [8 + width, 0]]
    truth = np.array([[0, 0], *spike, [20, 0], [20, 12], [0, 12], [0, 0]])
    for seed in range(6):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.05, 0.3))
        assert (farthest(truth, ring) < 0.2) == stays
        assert stays or ring[:, 1].min() > -width


@pytest.mark.parametrize(("degrees", "unseen", "is_blunt"), [(30, 0.7, True), (50, 0.6, True), (65, 0.5, False)])
def test_a_sharp_corner_that_was_not_seen_ends_blunt(degrees, unseen, is_blunt):
    """Points end so far before two walls would meet, of which the step to the corner is more than the tolerance."""
    along = np.arange(unseen, 14, 0.3)[:, None]
    direction = np.array([np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))])
    ring = np.concatenate([along * [1, 0], (along * direction)[::-1]])
    made = straight(np.concatenate([ring, ring[:1]]))
    assert (np.hypot(*made.T).min() > unseen - 0.25) == is_blunt
    assert is_blunt or len(made) == 4


def test_a_right_angle_is_found_beside_a_longer_wall_that_has_none():
    """The edge of the tile cuts a row of houses askew."""
    truth = np.array([[0, 0], [30, 0], [17, 16], [9, 9.5]], float)
    truth[2] = truth[3] + np.array([np.cos(0.68), np.sin(0.68)]) * 11
    truth[1] = [truth[2, 0] + truth[2, 1] * np.tan(0.68), 0]
    walls = line_along(wiggly(np.concatenate([truth, truth[:1]]), np.random.default_rng(0), 0.05, 0.3)).edges(0.5)
    assert 0.68 in np.round(main_directions(walls), 2)


def test_corners_that_are_cut_are_right_angles_all_the_same():
    truth = np.array([[0.5, 0], [9.5, 0], [10, 0.5], [10, 7.5], [9.5, 8], [0.5, 8], [0, 7.5], [0, 0.5], [0.5, 0]])
    ring = wiggly(turned(truth, 25), np.random.default_rng(0), noise=0.0, step=0.1)
    walls = line_along(ring).edges(0.1)
    assert len(walls) == 8
    assert main_directions(walls) == pytest.approx([np.deg2rad(25)], abs=1e-3)


def polygon(*sides):
    """Return the walls of a closed outline by length and direction (degrees), which is all that directions go by."""
    turned = [(length, np.array([np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))])) for length, angle in sides]
    return [OutlineEdge(direction, np.zeros(2), length, 0, 0) for length, direction in turned]


@pytest.mark.parametrize(
    ("long", "short", "cut", "has_main"),
    [
        (5.0, 5.0, 2.4, True),
        (5.0, 5.0, 2.6, False),
        # A cut of less than half of the one wall beside it, and of more than half of the other.
        (4.5, 3.0, 2.0, False),
    ],
)
def test_a_cut_corner_is_less_than_half_as_long_as_the_walls_beside_it(long, short, cut, has_main):
    """Eight walls that turn by 45° each: what is cut less than that is a rectangle, and else an octagon."""
    sides = [(length, 45 * i) for i, length in enumerate([long, cut, short, cut, long, cut, short, cut])]
    assert len(main_directions(polygon(*sides))) == has_main
    assert len(main_directions(polygon(*sides[1:], sides[0]))) == has_main


@pytest.mark.parametrize(("length", "apart", "is_main"), [(6, 0, True), (6, 4, True), (6, 7, False), (4.5, 0, False)])
def test_parallel_walls_that_are_most_of_an_outline_need_no_right_angle(length, apart, is_main):
    """A shed with pointed ends, in squares of its lengths: where its sides are short, it may be a round thing."""
    sides = [(length, 20), (3, 80), (3, 140), (length, 200 + apart), (3, 260), (3, 320)]
    found = main_directions(polygon(*sides))
    assert found == ([pytest.approx(np.deg2rad(20 + apart / 2), abs=0.04)] if is_main else [])


def test_a_boat_has_no_main_direction():
    """Its sides, bent by 6°, are most of the outline, but there is no right angle."""
    sides = [(12, -3), (12, 3), (4, 60), (4, 120), (12, 177), (12, 183), (4, 240), (4, 300)]
    assert main_directions(polygon(*sides)) == []


@pytest.mark.parametrize(("run", "rise", "is_step"), [(0.4, 0.8, True), (1.4, 1.4, False)])
def test_short_diagonals_between_parallel_walls_are_steps(run, rise, is_step):
    """At a tolerance of 0.5 m: one of 0.9 m stands for a wall across, one of 2 m is as it looks."""
    truth = np.array([[0, 0], [9, 0], [9 + run, rise], [20, rise], [20, 12], [0, 12], [0, 0]])
    for seed in range(6):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.03, 0.2))
        angle = np.rad2deg(np.arctan2(*np.diff(ring, axis=0).T[::-1]))
        assert len(ring) == 7
        assert (np.abs((angle + 45) % 90 - 45).max() < 1) == is_step
        assert is_step or farthest(ring, truth) < 0.1


@pytest.mark.parametrize("mirror", [1, -1])
def test_short_diagonals_beside_a_wall_that_is_askew_stay(mirror):
    """A wall that is 8° off the main direction before or after one tells of no step."""
    truth = np.array([[0, 0], [9, 0], [9.4, 0.8], [20, 0.8 + 10.6 * np.tan(np.deg2rad(8))], [20, 12], [0, 12], [0, 0]])
    truth = (truth * [mirror, 1])[::mirror]
    for seed in range(6):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.03, 0.2))
        assert farthest(truth, ring) < 0.2


def test_stairs_of_main_directions_are_no_diagonals():
    """Each step of 1 m is as short as a diagonal that is left out."""
    truth = np.array([[0, 0], [8, 0], [8, 1], [9, 1], [9, 2], [20, 2], [20, 12], [0, 12], [0, 0]])
    for seed in range(6):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.05, 0.3))
        assert len(ring) == 9
        assert farthest(truth, ring) < 0.1


def test_a_cut_corner_of_a_bay_without_main_directions_stays():
    """Where neither wall beside it has a main direction, nothing says that there was a right angle."""
    side, front = (np.array([np.cos(angle), np.sin(angle)]) for angle in np.deg2rad([110, 200]))
    left = np.array([16, 12]) + 5 * side + 6 * front
    back = left - side * (left[1] - 12) / side[1]
    corner = np.array([16, 12]) + 5 * side
    truth = [
        [0, 0],
        [30, 0],
        [30, 12],
        [16, 12],
        corner - 0.9 * side,
        corner + 0.9 * front,
        left,
        back,
        [0, 12],
        [0, 0],
    ]
    for seed in range(6):
        ring = straight(wiggly(np.array(truth), np.random.default_rng(seed), 0.02, 0.1))
        assert farthest(np.array(truth), ring) < 0.1
        assert farthest(ring, np.array(truth)) < 0.1


def test_a_border_keeps_the_wall_it_begins_with():
    """A diagonal of 1.1 m has no wall before it, so that it cuts no corner."""
    corners = np.array([[0, 0], [0.8, 0.8], [10, 0.8], [10, 9]])
    places = np.concatenate([np.linspace(a, b, 90) for a, b in zip(corners, corners[1:])])
    line = Line(places, np.full(len(places), 0.1), is_closed=False)
    walls, _ = straighten(line, line.edges(0.5, [0.0]), [0.0], 0.5)
    assert np.rad2deg([wall.angle for wall in walls]) == pytest.approx([45, 0, 90], abs=3)


def test_slanting_sides_of_a_bay_are_no_spikes():
    """They lead back a little, and what is between each and the front is as narrow as a spike, but not as sharp."""
    bay = [[8, 0], [7.1, -1.2], [13.9, -1.2], [13, 0]]
    truth = np.array([[0, 0], *bay, [20, 0], [20, 12], [0, 12], [0, 0]])
    for seed in range(6):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.05, 0.3))
        assert farthest(truth, ring) < 0.2


@pytest.mark.parametrize("fin", [[[24, 0], [21.2, 1.1], [21, 12]], [[21, 0], [21.2, 10.9], [24, 12]]])
def test_a_fin_at_the_end_of_a_wall_is_a_spike(fin):
    """Three meters of it go on beyond the corner; the wall itself, before or after, is long."""
    truth = np.array([[0, 0], *fin, [0, 12], [0, 0]])
    for seed in range(6):
        ring = straight(wiggly(truth, np.random.default_rng(seed), 0.05, 0.3))
        assert len(ring) == 5
        assert farthest(np.array([[0, 0], [21, 0], [21, 12], [0, 12]]), ring) < 0.3


@pytest.mark.parametrize(
    ("loop", "cut"),
    [
        # The third side crosses the first, or the fourth does.
        ([[10, 0], [10, -0.4], [9.5, 0.4]], [[9.75, 0], [9.5, 0.4]]),
        ([[10, 0], [10.3, -0.3], [9.7, -0.3], [9.7, 5]], [[9.7, 0], [9.7, 5]]),
    ],
)
def test_loops_on_a_short_way_are_cut_off(loop, cut):
    ring = np.array([[0, 0], *loop, [5, 10], [0, 10]])
    way = np.hypot(*np.diff(ring[1:-2] if len(loop) == 3 else ring[1:-3], axis=0).T).sum()
    for start in range(len(ring)):
        turned = list(np.roll(ring, start, axis=0))
        found = np.array(_without_loops(turned, 1.01 * way))
        expected = np.array([[0, 0], *cut, [5, 10], [0, 10]])
        np.testing.assert_allclose(found[np.lexsort(found.T)], expected[np.lexsort(expected.T)], atol=1e-9)
        assert len(_without_loops(turned, 0.3)) == len(ring)
