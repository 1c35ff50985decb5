"""Line segments of a simulated vehicle's scan lines, and of profiles drawn by hand."""

import numpy as np
import pytest

from lidar_buildings.algorithms.facades.segment_facade_lines import segment_facade_lines
from lidar_buildings.algorithms.simulation.simulate_street import simulate_street
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import FAR


@pytest.fixture(scope="module")
def street():
    *arrays, _, _, _, _ = simulate_street(length=16.0, line_rate=10.0, angular_step=0.5, seed=2)
    return dict(zip(simulate_street.stage.creates, arrays))


def kinds_of(points, **tunables):
    """Return the kind of each point's segment, "none" for stray points, and the segments."""
    segment_id, lines = segment_facade_lines(points["xyz"], points["gps_time"], points["point_source_id"], **tunables)
    return np.array(["none", *lines.columns["kind"]])[segment_id], lines


def test_ground_facades_and_other_objects_are_separated(street):
    kind, _ = kinds_of(street)
    ground, building = street["classification"] == 2, street["classification"] == 6
    assert np.mean(kind[ground] == "ground") > 0.9
    assert np.mean(kind[building] == "facade") > 0.8
    assert np.mean(building[kind == "facade"]) > 0.85
    assert np.mean(ground[kind == "ground"]) > 0.98


def test_lines_are_the_turns_of_both_scanners(street):
    """Ten turns a second for 16 m at 5 m/s, of two scanners."""
    _, lines = kinds_of(street)
    assert len(np.unique(lines.columns["line"])) == pytest.approx(2 * 10 * 16 / 5, abs=2)


def profile(rng, line):
    """Return a line across a street: a wall at 8 m, ground, a car's side, ground and a wall at 8 m."""
    corners = np.array([[-8, 6], [-8, 0], [0, 0], [3, 0], [3, 1.2], [4.5, 1.2], [4.5, 0], [8, 0], [8, 6]], float)
    steps = np.diff(corners, axis=0)
    length = np.hypot(*steps.T)
    along = np.arange(0, length.sum(), 0.05)
    places = np.column_stack([np.interp(along, np.concatenate([[0], np.cumsum(length)]), c) for c in corners.T])
    places += rng.normal(0, 0.005, places.shape)
    xyz = np.column_stack([places[:, 0], np.full(len(along), 0.1 * line), places[:, 1]])
    # A third of each turn is sky.
    return xyz, line + 0.6 * np.arange(len(along)) / len(along)


def test_attributes_are_those_of_the_profile(rng):
    xyz, time = (np.concatenate(parts) for parts in zip(*(profile(rng, line) for line in range(5))))
    _, lines = segment_facade_lines(xyz, time)
    columns = {name: np.asarray(column) for name, column in lines.columns.items()}
    is_facade = columns["kind"] == "facade"
    assert sorted(np.unique(columns["line"])) == [1, 2, 3, 4, 5]
    assert np.bincount(columns["line"][is_facade])[1:].tolist() == [2] * 5
    assert columns["slope"][is_facade] == pytest.approx([90] * 10, abs=1)
    west = is_facade & (columns["x"] < 0)
    assert columns["x"][west] == pytest.approx([-8] * 5, abs=0.05)
    assert columns["z"][west] == pytest.approx([3] * 5, abs=0.15)
    assert columns["height"][west] == pytest.approx([3] * 5, abs=0.15)
    assert columns["length"][west] == pytest.approx([6] * 5, abs=0.3)
    assert (columns["kind"][(columns["z"] > 0.5) & (columns["x"] > 2.5) & (columns["x"] < 5)] == "other").all()


def test_pieces_are_straight(street):
    """By a singular value decomposition, points lie within the tolerance of their segment's line."""
    points = street["xyz"]
    segment_id, lines = segment_facade_lines(points, street["gps_time"], street["point_source_id"], tolerance=0.05)
    for number in np.random.default_rng(0).choice(len(lines), 40, replace=False) + 1:
        own = points[segment_id == number]
        offsets = own - own.mean(axis=0)
        direction = np.linalg.svd(offsets, full_matrices=False)[2][0]
        off = offsets - np.outer(offsets @ direction, direction)
        # The chord of Douglas and Peucker is another line than the one of least squares, and misses the way across.
        assert np.linalg.norm(off, axis=1).max() < 0.15


def test_thresholds_decide(street):
    kind, _ = kinds_of(street)
    assert np.sum(kinds_of(street, facade_distance=0.0)[0] == "facade") < np.sum(kind == "facade")
    # The lowest segment of each line is left, which has most of the points.
    lowest = kinds_of(street, max_ground_height=0.0)[1].columns["kind"]
    assert lowest.count("ground") <= 64 < kinds_of(street)[1].columns["kind"].count("ground")
    assert np.sum(kinds_of(street, min_points=40)[0] == "none") > np.sum(kind == "none")
    assert len(kinds_of(street, tolerance=0.3)[1]) < len(kinds_of(street, tolerance=0.02)[1])
    assert len(np.unique(kinds_of(street, line_duration=0.05)[1].columns["line"])) > 64


def test_position_and_order_change_nothing(street, rng):
    order = rng.permutation(len(street["xyz"]))
    expected, _ = kinds_of(street)
    moved = {name: street[name][order] for name in ("xyz", "gps_time", "point_source_id")}
    moved["xyz"] = moved["xyz"] + FAR
    assert np.mean(kinds_of(moved)[0] == expected[order]) > 0.999


def test_without_times_there_are_no_lines(street):
    with pytest.raises(
        ValueError, match=r"^All points have the same GPS time, so scan lines can't be distinguished; use"
    ):
        segment_facade_lines(street["xyz"], np.zeros(len(street["xyz"])))


def test_scattered_points_have_no_segments():
    xyz = np.random.default_rng(1).uniform(-5, 5, (60, 3))
    monitor = Monitor()
    segment_id, lines = segment_facade_lines(xyz, np.arange(60) * 1.0, min_points=20, monitor=monitor)
    assert not segment_id.any()
    assert not len(lines)
    assert monitor.warnings == ["No scan line has a straight segment; lower the minimum points or raise the tolerance."]
