"""Recorded scan lines: the lines of a simulated scanner, their splitting by recursion, planes and smooth surfaces."""

import numpy as np
import pytest

from lidar_buildings.algorithms.segmentation.segment_recorded_lines import Recording, recorded_lines
from lidar_buildings.algorithms.segmentation.segment_recorded_lines import segment_recorded_lines as stage
from lidar_buildings.algorithms.segmentation.straight_pieces import split_lines
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening

GROUND, WEST, EAST, SHED = range(4)


def surface(x, y):
    """Return heights and surfaces of a gable house of 12 m by 10 m and a flat shed of 6 m by 5 m on level ground."""
    z, part = np.zeros(len(x)), np.full(len(x), GROUND)
    house = (np.abs(x - 15) < 6) & (np.abs(y - 15) < 5)
    z[house] = 8 - 0.6 * np.abs(x[house] - 15)
    part[house] = np.where(x[house] < 15, WEST, EAST)
    shed = (np.abs(x - 26) < 2.5) & (np.abs(y - 8) < 3)
    z[shed], part[shed] = 3.0, SHED
    return z, part


def scanned(height=surface, zigzag=True, noise=0.02, seed=5, side=30.0, turn=20.0):
    """Scan a square with lines 0.5 m apart and a point every 0.2 m: dimensions, true lines and true surfaces.

    Mirrors that go back and forth (``zigzag``) mark the ends of lines; polygon mirrors begin each line at its start.
    """
    rng = np.random.default_rng(seed)
    per_line, lines = round(side / 0.2), round(side / 0.5)
    number = np.repeat(np.arange(lines), per_line)
    share = np.tile((np.arange(per_line) + 0.5) / per_line, lines)
    across = np.where(zigzag & (number % 2 == 1), 1 - share, share) * side
    x, y = across, (number + share * zigzag) * 0.5
    z, part = height(x, y)
    xyz = np.column_stack([x, y, z]) + rng.normal(0, noise, (len(x), 3)) * [0, 0, 1]
    angle = np.radians(turn)
    xyz[:, :2] = xyz[:, :2] @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    edge = np.append(np.diff(number) > 0, True)
    recorded = {
        "gps_time": np.arange(len(x)) * 1e-5 + 1e5,
        "scan_angle": np.degrees(np.arctan2(across - side / 2, 600)).astype(np.float32),
        "scan_direction_flag": (number % 2).astype(np.uint8) * np.uint8(zigzag),
        "edge_of_flight_line": edge.astype(np.uint8),
    }
    return xyz, recorded, number, part


def segment_recorded_lines(xyz, recorded, **tunables):
    return stage(xyz, np.ones(len(xyz), np.uint8), **recorded, **tunables)


def same_groups(one, other):
    pairs = np.unique(np.column_stack([one, other]), axis=0)
    return len(pairs) == len(np.unique(one)) == len(np.unique(other))


@pytest.mark.parametrize(
    ("zigzag", "reported"),
    [
        (True, ("scan_direction_flag",)),
        (True, ("edge_of_flight_line", "scan_angle")),
        (True, ("scan_angle",)),
        (True, ()),
        (False, ("edge_of_flight_line", "scan_angle")),
        (False, ("scan_angle",)),
        (False, ()),
    ],
)
def test_lines_of_a_scanner_are_found_by_any_recorded_dimension(zigzag, reported):
    """With nothing but points and times, back and forth over level ground, a turn is seen to a point or two."""
    xyz, recorded, number, _ = scanned(lambda x, y: (0 * x, np.zeros(len(x), int)), zigzag)
    recording = Recording(gps_time=recorded["gps_time"], **{name: recorded[name] for name in reported})
    line = recorded_lines(xyz, recording, gap=5.0)
    if reported or not zigzag:
        np.testing.assert_array_equal(line, number)
    else:
        assert line.max() == number.max()
        assert (line == number).mean() > 0.98


def test_lines_end_at_pauses_gaps_and_between_flight_lines():
    xyz = np.column_stack([np.arange(40.0), np.zeros(40), np.zeros(40)])
    xyz[30:, 0] += 20
    time = np.arange(40.0)
    time[10:] += 100
    source = np.where(np.arange(40) < 20, 1, 2)
    line = recorded_lines(xyz, Recording(gps_time=time, point_source_id=source), gap=5.0)
    np.testing.assert_array_equal(line, np.repeat([0, 1, 2, 3], 10))


def recursively(points, first, last, tolerance):
    """Return the ends of the straight pieces of a line, by plain recursion."""
    chord = points[last] - points[first]
    off = points[first : last + 1] - points[first]
    away = np.linalg.norm(np.cross(off, chord / np.linalg.norm(chord)), axis=1)
    at = first + int(away.argmax())
    if away.max() <= tolerance:
        return [(first, last)]
    return recursively(points, first, at, tolerance) + recursively(points, at, last, tolerance)


def test_lines_are_split_as_by_recursion(rng):
    points = np.cumsum(rng.uniform([0.1, -0.1, -0.3], [0.3, 0.1, 0.3], (300, 3)), axis=0)
    line = np.repeat([0, 1, 2], 100)
    piece = split_lines(points, line, 0.4, 3, Monitor())
    ends = [pair for start in (0, 100, 200) for pair in recursively(points, start, start + 99, 0.4)]
    expected = np.full(300, -1)
    by_length = sorted(enumerate(ends), key=lambda one: (one[1][1] - one[1][0], -one[0]))
    for number, (first, last) in by_length:
        if last - first + 1 >= 3:
            expected[first : last + 1] = number
    kept = np.bincount(expected[expected >= 0], minlength=len(ends)) >= 3
    expected[(expected >= 0) & ~kept[expected]] = -1
    np.testing.assert_array_equal(piece >= 0, expected >= 0)
    assert same_groups(piece, expected)
    assert len(np.unique(piece)) > 10


@pytest.mark.parametrize("zigzag", [True, False])
def test_roofs_and_ground_are_one_segment_each(zigzag):
    xyz, recorded, _, part = scanned(zigzag=zigzag)
    ids = segment_recorded_lines(xyz, recorded)
    found = [np.bincount(ids[part == number]).argmax() for number in range(4)]
    assert len({0, *found}) == 5
    for number, segment in enumerate(found):
        assert (ids[part == number] == segment).mean() > 0.97
        assert (part[ids == segment] == number).mean() > 0.97


def test_a_dome_is_one_smooth_surface_and_many_planes():
    def dome(x, y):
        return 40 - np.sqrt(40**2 - (x - 15) ** 2 - (y - 15) ** 2), np.zeros(len(x), int)

    xyz, recorded, _, _ = scanned(dome)
    smooth = segment_recorded_lines(xyz, recorded, surfaces="smooth")
    assert np.bincount(smooth).max() > 0.95 * len(xyz)
    planar = segment_recorded_lines(xyz, recorded)
    assert len(np.unique(planar)) > 8
    for segment in np.unique(planar[planar > 0]):
        points = xyz[planar == segment]
        assert np.linalg.svd(points - points.mean(axis=0))[1][2] / np.sqrt(len(points)) < 0.06


def test_without_times_the_order_of_points_is_taken_and_reported():
    xyz, recorded, _, _ = scanned()
    monitor = Monitor()
    ids = segment_recorded_lines(xyz, {}, monitor=monitor)
    assert any("no GPS times" in warning for warning in monitor.warnings)
    assert len(set(ids) - {0}) == 4
    same = segment_recorded_lines(xyz, {"gps_time": np.zeros(len(xyz))})
    np.testing.assert_array_equal(same, ids)
    reported = Monitor()
    segment_recorded_lines(xyz, recorded, monitor=reported)
    assert not reported.warnings
    assert any("GPS time, scan direction, edge of flight line, scan angle" in info for info in reported.infos)


def test_order_and_position_change_nothing_where_there_are_times():
    xyz, recorded, _, _ = scanned()
    xyz = (xyz * 1024).round() / 1024
    ids = segment_recorded_lines(xyz, recorded)
    order = np.random.default_rng(2).permutation(len(xyz))
    again = segment_recorded_lines(xyz[order], {name: values[order] for name, values in recorded.items()})
    np.testing.assert_array_equal(again, ids[order])
    assert same_groups(segment_recorded_lines(xyz + FAR, recorded), ids)


def test_first_returns_are_not_on_the_lines_and_join_the_roof_below_them():
    """Every third pulse over the shed meets a branch 5 m above it first; every fifth has its first return on it."""
    xyz, recorded, _, part = scanned()
    shed = np.flatnonzero(part == SHED)
    branch, twice = shed[::3], shed[1::3]
    points = np.concatenate([xyz, xyz[branch] + [0, 0, 5], xyz[twice] + [0.01, 0, 0]])
    row = np.concatenate([np.arange(len(xyz)), branch, twice])
    recorded = {name: values[row] for name, values in recorded.items()}
    recorded["return_number"] = np.where(np.arange(len(points)) < len(xyz), 1, 0).astype(np.uint8) + np.uint8(1)
    recorded["number_of_returns"] = np.full(len(points), 2, np.uint8)
    ids = segment_recorded_lines(points, recorded)
    roof = np.bincount(ids[shed]).argmax()
    assert roof > 0
    assert (ids[shed] == roof).mean() > 0.97
    assert not ids[len(xyz) : len(xyz) + len(branch)].any()
    assert (ids[len(xyz) + len(branch) :] == roof).mean() > 0.97


def test_tunables_have_their_effect():
    xyz, recorded, _, part = scanned()
    assert len(np.unique(segment_recorded_lines(xyz, recorded, min_points=3000))) == 2
    assert not segment_recorded_lines(xyz, recorded, line_distance=0.2).any()
    assert not segment_recorded_lines(xyz, recorded, min_piece=200).any()
    ids = segment_recorded_lines(xyz, recorded, min_piece=40)
    assert not ids[part == SHED].any()
    coarse = segment_recorded_lines(xyz, recorded, tolerance=15.0, max_gap=20.0)
    assert len(set(coarse) - {0}) == 1
    assert not segment_recorded_lines(xyz, recorded, max_gap=0.1).any()


def test_one_line_few_points_and_noise_give_no_segment():
    xyz, recorded, number, _ = scanned()
    one = number == 3
    assert not segment_recorded_lines(xyz[one], {name: values[one] for name, values in recorded.items()}).any()
    assert not segment_recorded_lines(xyz[:1], {}, density=1.0, noise=0.1).any()
    classes = np.full(len(xyz), 7, np.uint8)
    classes[: len(xyz) // 2] = 1
    assert not stage(xyz, classes, **recorded)[len(xyz) // 2 :].any()


def test_cancel_gets_through():
    xyz, recorded, _, _ = scanned()
    with pytest.raises(Cancelled):
        segment_recorded_lines(xyz, recorded, monitor=Listening(stop_at=0.5))
