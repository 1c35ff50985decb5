"""Lines of samples and the walls that they are best made of."""

import itertools

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.line_segments import farthest
from lidar_buildings.algorithms.geometry.polylines import Line, simplify
from lidar_buildings.tests.builders import L_SHAPE

# As the module has it: what a wall costs, in tolerances cubed.
PRICE = 0.5


def traced(corners, rng, noise=0.1, step=0.3, closed=True):
    """Return samples along the sides of a polygon, each moved a little."""
    corners = np.asarray(corners, float)
    sides = zip(corners, np.roll(corners, -1, axis=0) if closed else corners[1:])
    parts = [a + np.arange(0, 1, step / np.hypot(*(b - a)))[:, None] * (b - a) for a, b in sides]
    places = np.concatenate(parts)
    return Line(places + rng.uniform(-noise, noise, places.shape), np.full(len(places), step), closed)


def squares(places, weights):
    """Weighted squares of the distances to the line that fits best, by singular values."""
    moved = (places - np.average(places, axis=0, weights=weights)) * np.sqrt(weights)[:, None]
    return np.linalg.svd(moved, compute_uv=False)[1] ** 2 if len(places) > 1 else 0.0


def squares_along(places, weights, angle):
    across = places @ [-np.sin(angle), np.cos(angle)]
    return weights @ (across - np.average(across, weights=weights)) ** 2


def cost_of(line, bends, tolerance, directions):
    price, total = PRICE * tolerance**3, 0.0
    for first, last in zip(bends, bends[1:]):
        places, weights = line.samples[first : last + 1], line.weights[first : last + 1]
        free = squares(places, weights) + price * bool(directions)
        total += price + min([free] + [squares_along(places, weights, angle) for angle in directions])
    return total


@pytest.mark.parametrize("directions", [(), (0.0, np.pi / 2)])
def test_bends_are_the_cheapest_of_all(directions):
    """Every choice of bends is tried on ten samples that go up and down."""
    for seed in range(8):
        rng = np.random.default_rng(seed)
        line = Line(np.column_stack([np.arange(10.0), rng.uniform(0, 1.2, 10)]), rng.uniform(0.5, 1.5, 10), False)
        rows = simplify(line.samples, 0.25, False).tolist()
        chains = [
            [rows[0], *inner, rows[-1]]
            for count in range(len(rows) - 1)
            for inner in itertools.combinations(rows[1:-1], count)
        ]
        least = min(cost_of(line, chain, 1.0, directions) for chain in chains)
        made = line.bends(1.0, directions[:1]).tolist()
        assert cost_of(line, made, 1.0, directions) == pytest.approx(least)


@pytest.mark.parametrize("directions", [(), (0.3, 0.3 + np.pi / 2)])
def test_bends_of_a_long_line_cost_as_little_as_those_of_one_step_after_the_other(rng, directions):
    """Costs are found for many ends at once; here each end looks at every start by itself."""
    line = traced([(0, 0), (9, 4), (6, 12), (20, 30), (50, 20)], rng, noise=0.6, closed=False)
    rows = simplify(line.samples, 0.25, False).tolist()
    assert len(rows) > 130
    cost = [0.0] + [np.inf] * (len(rows) - 1)
    for end in range(1, len(rows)):
        cost[end] = min(cost[start] + cost_of(line, [rows[start], rows[end]], 1.0, directions) for start in range(end))
    assert cost_of(line, line.bends(1.0, directions[:1]).tolist(), 1.0, directions) == pytest.approx(cost[-1])


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


@pytest.mark.parametrize("corners", [4, 6, 8])
def test_polygons_have_as_many_walls_as_sides(corners):
    angle = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    truth = 8 * np.column_stack([np.cos(angle), np.sin(angle)])
    for seed in range(8):
        walls = traced(truth, np.random.default_rng(seed)).edges(0.5)
        assert len(walls) == corners
        for wall in walls:
            off = np.sort([abs(wall.offset(corner)) for corner in truth])
            assert off[1] < 0.15


def test_chords_of_a_circle_turn_to_one_side():
    """Fitted to all samples between bends, none juts out as the farthest sample does."""
    angle = np.linspace(0, 2 * np.pi, 180, endpoint=False)
    for seed in range(8):
        rng = np.random.default_rng(seed)
        circle = (7 + rng.uniform(-0.12, 0.12, len(angle)))[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        walls = Line(circle, np.full(len(circle), 0.24), True).edges(0.45)
        turns = np.diff(np.unwrap([wall.angle for wall in [*walls, walls[0]]]))
        assert (turns > 0).all()
        assert 8 <= len(walls) <= 16
        assert max(abs(wall.offset(np.zeros(2)) - 7) for wall in walls) < 0.35


def test_steps_of_main_directions_are_no_slope():
    """Two steps of 1.2 m in 18 m: one slanting wall is nearly as close, but has no direction of the house."""
    truth = [[0, 0], [6, 0], [6, 1.2], [12, 1.2], [12, 2.4], [18, 2.4], [18, 12], [0, 12]]
    for seed in range(8):
        line = traced(truth, np.random.default_rng(seed), step=0.5)
        angles = [wall.angle for wall in line.edges(0.875, [0.0]) if wall.length > 3]
        off = np.abs((np.rad2deg(angles) + 45) % 90 - 45)
        assert len(angles) >= 6
        assert off.max() < 5


def test_where_a_closed_line_begins_changes_nothing(rng):
    line = traced(L_SHAPE[:-1], rng)
    walls = line.edges(0.5)
    moved = Line(np.roll(line.samples, 17, axis=0), line.weights, True).edges(0.5)
    assert len(moved) == len(walls) == 6
    places = sorted(tuple(np.round(wall.point, 9)) for wall in walls)
    assert sorted(tuple(np.round(wall.point, 9)) for wall in moved) == places


def test_simplified_line_stays_within_the_tolerance(rng):
    raw = traced(L_SHAPE[:-1], rng).samples
    raw = np.concatenate([raw, raw[:1]])
    rows = simplify(raw[:-1], 0.5, is_closed=True)
    simple = raw[np.append(rows, rows[0])]
    assert len(simple) < 12
    assert (np.diff(rows) > 0).all()
    assert farthest(raw, simple) <= 0.5


@pytest.mark.parametrize("start", [0, 1, 40, 150])
def test_where_a_closed_line_begins_its_simplified_one_is_the_same(start, rng):
    raw = np.roll(traced(L_SHAPE[:-1], rng).samples, start, axis=0)
    rows = simplify(raw, 0.5, is_closed=True)
    expected = simplify(np.roll(raw, -start, axis=0), 0.5, is_closed=True)
    assert sorted(((rows - start) % len(raw)).tolist()) == expected.tolist()


def test_of_a_closed_line_the_longest_extent_is_left_at_any_tolerance(rng):
    raw = traced(L_SHAPE[:-1], rng, noise=0.0).samples
    np.testing.assert_allclose(np.sort(raw[simplify(raw, 50.0, is_closed=True)], axis=0), [[0, 0], [20, 16]], atol=0.3)


@pytest.mark.parametrize("corner", [[2.0, 2.0], [1.0, 5.0]])
def test_a_wall_whose_samples_have_no_direction_has_that_of_its_ends(corner):
    """They are spread at 45° or 90° to the way from the first to the last."""
    line = Line(np.array([[0.0, 0.0], corner, [2.0, 0.0]]), np.ones(3), False)
    np.testing.assert_allclose(line.fitted(0, 2, 0.5).direction, [1, 0], atol=1e-9)
