"""Lines through wall points: where they are, that they stop where walls do, and which of them are square."""

import tracemalloc

import numpy as np
import pytest

from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.walls import wall_lines
from lidar_buildings.algorithms.walls.wall_lines import find_lines, merge_lines, square_up, wall_scale


def wall(rng, start, end, per_meter=10, noise=0.03):
    start, end = np.array(start, float), np.array(end, float)
    length = np.hypot(*(end - start))
    share = rng.uniform(0, 1, round(length * per_meter))
    return start + share[:, None] * (end - start) + rng.normal(0, noise, (len(share), 2))


def found_in(xy, tolerance=0.1, min_length=1.2):
    length = 2 * np.ptp(xy, axis=0).sum()
    return find_lines(xy, wall_scale(len(xy), length, tolerance), min_length, np.random.default_rng(0), Monitor())


def angle_between(one, other):
    return np.rad2deg(np.arccos(np.clip(abs(one.direction @ other.direction), 0, 1)))


@pytest.mark.parametrize("per_meter", [6, 20, 100])
@pytest.mark.parametrize("noise", [0.02, 0.05])
def test_lines_lie_on_the_walls_within_what_noise_allows(rng, per_meter, noise):
    corners = np.array([(0, 0), (9, 0), (9, 6), (0, 6)], float)
    xy = np.concatenate([wall(rng, a, b, per_meter, noise) for a, b in zip(corners, np.roll(corners, -1, 0))])
    lines = found_in(xy, 3.5 * noise)
    assert len(lines) == 4
    for line in lines:
        which = int(np.argmax(np.abs(line.normal)))
        place = line.point[which]
        wanted = min((0, 9) if which == 0 else (0, 6), key=lambda value: abs(value - place))
        # Six deviations of the mean of its points.
        assert abs(place - wanted) < 6 * noise / np.sqrt(len(line.points))
        assert line.deviation == pytest.approx(noise, rel=0.35)
        assert np.rad2deg(np.arccos(np.abs(line.direction).max())) < 6 * np.rad2deg(line.angle_deviation)


def test_memory_follows_the_points_and_not_their_pairs(rng):
    """A wall three meters high, seen from near by, has hundreds of points within a step of each in plan."""
    xy = wall(rng, (0, 0), (4, 0), 1000)
    tracemalloc.start()
    lines = found_in(xy)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(lines) == 1
    assert peak < 60e6


def test_scattered_points_are_no_wall(rng):
    bush = rng.normal(0, 0.6, (200, 2))
    assert found_in(bush) == []


def test_a_short_piece_is_a_wall_only_where_such_are_looked_for(rng):
    piece = np.concatenate([wall(rng, (0, 0), (0.9, 0), 30), wall(rng, (5, 5), (5, 9), 30)])
    assert len(found_in(piece, min_length=1.2)) == 1
    assert len(found_in(piece, min_length=0.7)) == 2


def test_pieces_beside_a_gap_are_one_wall(rng):
    xy = np.concatenate([wall(rng, (0, 0), (3, 0), 15), wall(rng, (6, 0), (9, 0), 15), wall(rng, (0, 5), (9, 5), 15)])
    scale = wall_scale(len(xy), 30, 0.1)
    lines = found_in(xy)
    assert len(lines) == 3
    merged = merge_lines(lines, xy, scale)
    assert len(merged) == 2
    assert sorted(round(np.ptp(line.along)) for line in merged) == [9, 9]
    offset = np.concatenate([xy[:45], xy[45:90] + [0, 0.5], xy[90:]])
    assert len(merge_lines(found_in(offset), offset, scale)) == 3


@pytest.mark.parametrize(("angle", "squared"), [(90, True), (90.4, True), (86, False), (80, False), (60, False)])
def test_walls_become_square_where_their_points_allow_it(rng, angle, squared):
    turn = np.deg2rad(angle)
    end = np.array([10 * np.cos(turn), 10 * np.sin(turn)])
    xy = np.concatenate([wall(rng, (0, 0), (10, 0), 20, 0.02), wall(rng, (0, 0), end, 20, 0.02)])
    lines = square_up(found_in(xy), xy)
    between = angle_between(*lines)
    assert between == pytest.approx(90 if squared else min(angle, 180 - angle), abs=1e-6 if squared else 0.5)


def test_a_short_noisy_wall_becomes_square_and_a_long_precise_one_does_not(rng):
    """A degree and a half off: within the noise of 2.5 m with few points, outside the noise of 12 m with many."""
    turn = np.deg2rad(88.5)
    way = np.array([np.cos(turn), np.sin(turn)])
    base = wall(rng, (0, 0), (12, 0), 30, 0.03)
    for length, per_meter, squared in ((2.5, 8, True), (12, 30, False)):
        xy = np.concatenate([base, wall(rng, (0, 0), length * way, per_meter, 0.03)])
        lines = square_up(found_in(xy, min_length=1.0), xy)
        assert len(lines) == 2
        assert (abs(angle_between(*lines) - 90) < 1e-6) == squared


def test_a_short_wall_that_a_bush_turns_keeps_the_direction_of_the_others(rng):
    """A bush at the foot of a garage wall of 3 m turned its line by 8 degrees, and a corner lay 28 cm off."""
    for seed in range(8):
        rng = np.random.default_rng(seed)
        sides = [wall(rng, a, b, 8, 0.05) for a, b in (((0, 0), (6, 0)), ((0, 3), (6, 3)), ((0, 0), (0, 3)))]
        bush = rng.normal((6.22, 0.4), (0.02, 0.2), (6, 2))
        xy = np.concatenate([*sides, wall(rng, (6, 0), (6, 3), 6, 0.04), bush])
        ends = np.cumsum([len(side) for side in sides])
        parts = np.split(np.arange(len(xy)), ends)
        raw = [wall_lines.fit_line(xy, part) for part in parts]
        short = square_up(raw, xy)[3]
        assert angle_between(raw[3], raw[0]) < 87.7
        assert angle_between(short, raw[0]) > 88.9
        assert abs(short.across(np.array([[6.0, 1.5]]))[0]) < abs(raw[3].across(np.array([[6.0, 0.2]]))[0])


def test_a_short_wall_without_anything_else_keeps_its_own_direction(rng):
    """Six degrees off at 3 m, as precise as the others: more than noise explains."""
    turn = np.deg2rad(84)
    sides = [wall(rng, (0, 0), (8, 0), 20, 0.02), wall(rng, (0, 5), (8, 5), 20, 0.02)]
    xy = np.concatenate([*sides, wall(rng, (8, 0), (8 + 3 * np.cos(turn), 3 * np.sin(turn)), 20, 0.02)])
    raw = [wall_lines.fit_line(xy, part) for part in np.split(np.arange(len(xy)), [160, 320])]
    assert angle_between(square_up(raw, xy)[2], raw[0]) == pytest.approx(84, abs=1.0)


def test_hypotheses_are_scored_as_by_brute_force(rng):
    xy, heading = rng.uniform(0, 6, (120, 2)), rng.uniform(0, np.pi, 40)
    directions, starts = np.column_stack([np.cos(heading), np.sin(heading)]), xy[:40]
    scale = wall_scale(120, 60.0, 0.3)
    ways = np.tile([1.0, 0.0], (120, 1))
    scored = wall_lines._lengths(xy, ways, starts, directions, scale)
    least = (directions @ xy.T).min()
    for (east, north), start, score in zip(directions, starts, scored):
        near = np.abs((xy - start) @ [-north, east]) <= scale.tolerance
        bins = (
            np.unique(np.floor((xy[near] @ [east, north] - least + 1e-9) / scale.bin))
            if abs(east) >= np.cos(np.pi / 6)
            else []
        )
        runs = np.split(bins, np.flatnonzero(np.diff(bins) > round(1.5 / scale.bin) + 1) + 1)
        assert score == max(len(run) for run in runs)
    assert scored.max() > 3
