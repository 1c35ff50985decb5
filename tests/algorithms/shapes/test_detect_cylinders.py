"""Cylinders whose axes and radii are known, and objects that are not cylinders."""

import numpy as np
import pytest

from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.shapes.cylinder_fits import Cylinder, bends, fit_cylinder, fit_sphere
from lidar_buildings.algorithms.shapes.detect_cylinders import detect_cylinders
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import EXACT_FAR
from lidar_buildings.tests.industry import bent, edge, pipe, slab, tank_farm


def detect(xyz, *, segment_id=None, shape=None, **tunables):
    return detect_cylinders(xyz, np.ones(len(xyz), np.uint8), segment_id, shape, **tunables)


def angle_between(line, axis):
    """Return the angle (°) between a line (2, 3) and a direction (3,)."""
    along = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
    return np.degrees(np.arccos(np.clip(abs(along @ axis) / np.linalg.norm(axis), 0, 1)))


@pytest.mark.parametrize(
    ("radius", "length", "spacing", "noise"),
    [(0.025, 0.6, 0.008, 0.001), (0.15, 2.0, 0.03, 0.002), (0.3, 2.0, 0.05, 0.005), (5.0, 8.0, 0.5, 0.01)],
)
@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 0.3, 0.02), (1, 1, 1)])
def test_a_cylinder_of_any_size_and_direction_is_found(radius, length, spacing, noise, axis, rng):
    xyz = pipe(rng, radius, length, spacing, noise, axis, seen=0.5)
    ids, shape, axes = detect(xyz, max_radius=3 * radius)
    assert len(axes) == 1
    assert axes.columns["radius"] == pytest.approx([radius], rel=0.03)
    assert axes.columns["length"] == pytest.approx([length], rel=0.06)
    assert axes.columns["seen"] == pytest.approx([0.5], abs=0.1)
    assert axes.columns["rms"] == pytest.approx([noise], rel=0.2)
    assert axes.columns["points"] == [(ids == 1).sum()]
    assert (shape == 2 * (ids == 1)).all()
    assert (ids == 1).mean() > 0.9
    assert angle_between(axes.geometries[0], np.array(axis, float)) < 1.0


def test_planes_edges_bends_balls_and_clutter_are_no_cylinders(rng):
    spacing, noise = 0.03, 0.002
    ball = rng.normal(size=(3000, 3))
    ball = 0.4 * ball / np.linalg.norm(ball, axis=1)[:, None] + rng.normal(0, noise, ball.shape)
    parts = [
        slab(rng, 2.0, spacing, noise),
        edge(rng, 2.0, spacing, noise) + [4, 0, 0],
        bent(rng, 0.15, 0.45, spacing, noise) + [8, 0, 0],
        ball + [12, 0, 0],
        rng.uniform(-0.4, 0.4, (1500, 3)) + [16, 0, 0],
    ]
    monitor = Monitor()
    ids, _, axes = detect(np.concatenate(parts), max_radius=2.0, monitor=monitor)
    assert len(axes) == 0
    assert not ids.any()
    assert monitor.warnings == ["No cylinder was found; no point got a new SegmentID."]


def test_parallel_and_crossing_pipes_beside_a_floor_stay_apart(rng):
    radii = (0.1, 0.15, 0.08)
    pipes = [
        pipe(rng, radii[0], 2.0, 0.03, 0.002, (1, 0, 0)) + [0, 0, 0.5],
        pipe(rng, radii[1], 2.0, 0.03, 0.002, (1, 0, 0)) + [0, 0.4, 0.5],
        pipe(rng, radii[2], 2.0, 0.03, 0.002, (0, 1, 0)) + [0, 0.2, 1.0],
    ]
    xyz = np.concatenate([*pipes, slab(rng, 3.0, 0.03, 0.002)])
    ids, _, axes = detect(xyz, max_radius=0.5)
    assert sorted(axes.columns["radius"]) == pytest.approx(sorted(radii), rel=0.02)
    truth = np.repeat([0, 1, 2, 3], [*(len(one) for one in pipes), len(xyz) - sum(len(one) for one in pipes)])
    for number in range(3):
        own = np.bincount(ids[truth == number])
        assert own.argmax() > 0
        assert own.max() > 0.95 * (truth == number).sum()
    assert (ids[truth == 3] > 0).mean() < 0.01


def test_a_gap_in_a_pipe_is_bridged(rng):
    xyz = pipe(rng, 0.1, 2.0, 0.02, 0.002, (1, 0, 0))
    xyz = xyz[np.abs(xyz[:, 0]) > 0.08]
    assert detect(xyz, max_radius=0.4)[2].columns["length"] == pytest.approx([2.0], rel=0.03)


@pytest.mark.parametrize("axis", [(1, 0, 0), (1, 0.3, 0.5)])
def test_a_pipe_of_any_length_is_one(axis, rng):
    """A pipe of 1200 radii, longer than 60 steps of 6 radii to both sides, was two cylinders."""
    ids, _, axes = detect(pipe(rng, 0.05, 60.0, 0.02, 0.001, axis), min_radius=0.04, max_radius=0.07)
    assert axes.columns["length"] == pytest.approx([60.0], abs=0.1)
    assert (ids == 1).mean() > 0.9


def test_segments_are_searched_one_by_one(rng):
    """A pipe cut into two segments by hand is two cylinders with no gap allowed; what has a shape is left alone."""
    xyz = pipe(rng, 0.1, 2.0, 0.02, 0.002, (1, 0, 0))
    segment_id = np.where(xyz[:, 0] < 0, 3, 5).astype(np.int32)
    ids, shape, axes = detect(xyz, segment_id=segment_id, max_radius=0.4, max_gap=0, search_in="each segment")
    assert sorted(axes.columns["id"]) == [6, 7]
    for line in axes.geometries:
        assert np.abs(line).max() < 1.1, "axes lie where the points are"
    shape = np.where(segment_id == 3, 1, 0).astype(np.uint8)
    ids, shapes, axes = detect(xyz, segment_id=segment_id, shape=shape, max_radius=0.4, search_in="each segment")
    assert (ids[segment_id == 3] == 3).all()
    assert (shapes[segment_id == 3] == 1).all()
    assert len(axes) == 1


def parted(rng, gap, *, offset=0.0, second_radius=0.1, lean=0.0):
    """Return points (n, 3) of two pipes along x, of 2 m and 1.5 m, ``gap`` (m) apart, and the segment (n,) of each.

    The second one lies ``offset`` (m) off the line of the first and leans from it.
    """
    one = pipe(rng, 0.1, 2.0, 0.02, 0.002, (1, 0, 0)) - [1.0 + gap / 2, 0, 0]
    two = pipe(rng, second_radius, 1.5, 0.02, 0.002, (1, lean, 0)) + [0.75 + gap / 2, offset + lean * 0.75, 0]
    return np.concatenate([one, two]), np.repeat(np.int32([3, 5]), [len(one), len(two)])


@pytest.mark.parametrize("search_in", ["whole cloud", "each segment"])
def test_pieces_of_one_pipe_are_one_cylinder(rng, search_in):
    xyz, segment_id = parted(rng, 0.6)
    ids, _, axes = detect(xyz, segment_id=segment_id, max_radius=0.4, search_in=search_in)
    assert len(axes) == 1
    line = axes.geometries[0]
    assert np.sort(line[:, 0]) == pytest.approx([-2.3, 1.8], abs=0.05)
    assert np.abs(line[:, 1:]).max() < 0.001
    assert axes.columns["radius"] == pytest.approx([0.1], abs=0.0005)
    assert axes.columns["length"] == pytest.approx([4.1], abs=0.1)
    assert axes.columns["rms"] == pytest.approx([0.002], rel=0.1)
    assert axes.columns["points"] == [(ids == axes.columns["id"][0]).sum()]
    assert axes.columns["points"][0] > 0.95 * len(xyz)
    assert axes.columns["seen"] == pytest.approx([0.6], abs=0.1)


@pytest.mark.parametrize(
    ("gap", "other"),
    [(1.5, {}), (0.6, {"offset": 0.006}), (0.6, {"second_radius": 0.106}), (0.6, {"lean": 0.02})],
    ids=["far apart", "next to the line", "wider", "at an angle"],
)
def test_two_pipes_stay_two(rng, gap, other):
    """Offset, radius and angle differ by little more than the noise of 2 mm."""
    assert len(detect(parted(rng, gap, **other)[0], max_radius=0.4)[2]) == 2


def test_an_end_cap_parts_two_pipes(rng):
    xyz, _ = parted(rng, 0.6)
    turn, reach = rng.uniform(0, 2 * np.pi, 80), 0.1 * np.sqrt(rng.uniform(0, 1, 80))
    cap = np.column_stack([np.full(80, -0.3), reach * np.cos(turn), reach * np.sin(turn)])
    cap[:, 0] += rng.normal(0, 0.002, 80)
    assert len(detect(np.concatenate([xyz, cap]), max_radius=0.4)[2]) == 2


def test_position_and_order_do_not_matter(rng):
    xyz = np.round(pipe(rng, 0.3, 2.0, 0.05, 0.005, (1, 0.2, 0.1)) * 1024) / 1024
    expected, _, axes = detect(xyz, max_radius=1.0)
    far, _, far_axes = detect(xyz + EXACT_FAR, max_radius=1.0)
    np.testing.assert_array_equal(far, expected)
    np.testing.assert_allclose(far_axes.geometries[0] - EXACT_FAR, axes.geometries[0], atol=1e-6)
    order = rng.permutation(len(xyz))
    np.testing.assert_array_equal(detect(xyz[order], max_radius=1.0)[0], expected[order])


def test_fit_is_the_least_squares_cylinder(rng):
    """Compared with scipy's general minimizer, from the same start."""
    from scipy.optimize import least_squares

    xyz = pipe(rng, 1.0, 3.0, 0.2, 0.05, (0.2, 0.1, 1.0), seen=0.4)
    start = Cylinder(np.zeros(3), np.array([0.0, 0.0, 1.0]), 1.2)
    fitted = fit_cylinder(xyz, start)

    def residuals(p):
        axis = np.array([p[2], p[3], 1.0]) / np.sqrt(p[2] ** 2 + p[3] ** 2 + 1)
        return np.linalg.norm(np.cross(xyz - [p[0], p[1], 0.0], axis), axis=1) - p[4]

    best = least_squares(residuals, [0, 0, 0, 0, 1.2], xtol=1e-12, ftol=1e-12).x
    assert fitted.radius == pytest.approx(best[4], abs=1e-6)
    assert fitted.axis[:2] / fitted.axis[2] == pytest.approx(best[2:4], abs=1e-6)


def test_fit_of_a_sphere_is_exact_on_one(rng):
    away = rng.normal(size=(50, 3))
    xyz = np.array([3.0, -2.0, 1.0]) + 2.5 * away / np.linalg.norm(away, axis=1)[:, None]
    center, radius = fit_sphere(xyz, np.array([2.7, -1.8, 1.2]), 2.0)
    assert center == pytest.approx([3, -2, 1], abs=1e-7)
    assert radius == pytest.approx(2.5, abs=1e-7)


def test_bends_show_in_the_residuals(rng):
    straight = pipe(rng, 0.15, 0.6, 0.02, 0.002, (0, 0, 1))
    start = Cylinder(np.zeros(3), np.array([0.0, 0.0, 1.0]), 0.15)
    assert bends(fit_cylinder(straight, start), straight) < 0.0005
    waist = straight.copy()
    waist[:, :2] *= 1 + 0.2 * waist[:, 2:] ** 2
    assert bends(fit_cylinder(waist, start), waist) > 0.0005


def test_a_small_part_of_a_cloud_is_no_mistake(rng):
    """Half of its extent is less than the least radius that the sampling of the whole allows: a block was refused."""
    few = rng.uniform(0, 0.05, (30, 3))
    sampling = CloudSampling.of(pipe(rng, 0.3, 2.0, 0.1, 0.005, (1, 0, 0)))
    assert not detect_cylinders(few, np.ones(30, np.uint8), sampling=sampling)[0].any()


def test_an_empty_range_of_radii_is_refused(rng):
    xyz = pipe(rng, 0.3, 2.0, 0.05, 0.005, (1, 0, 0))
    with pytest.raises(
        ValueError, match="The range of radii is empty: the minimum radius is 2 m and the maximum radius"
    ):
        detect(xyz, min_radius=2.0, max_radius=1.0)
    with pytest.raises(ValueError, match="Searching in each segment needs SegmentID"):
        detect(xyz, search_in="each segment")
    with pytest.raises(ValueError, match="All points lie on one line"):
        detect(np.column_stack([np.arange(50.0)] * 3))


@pytest.mark.slow
def test_real_tanks_are_found_in_a_yard_and_nothing_else_is(rng):
    """Plates that protrude by one to two deviations, ladders, stairs and sunk roofs: of four tanks none was found."""
    farm = tank_farm(rng, tanks=((13.74, 0), (8.56, 26)))
    _, _, axes = detect(farm.xyz, min_radius=0.2)
    found = sorted(zip(axes.columns["radius"], [line[:, :2].mean(axis=0) for line in axes.geometries]), reverse=True)
    assert [radius for radius, _ in found] == pytest.approx([13.74, 8.56], abs=0.03)
    assert np.array([position for _, position in found]) == pytest.approx(farm.tanks[:, :2], abs=0.05)


def test_a_kerb_is_no_pipe(rng):
    """Its surface goes on in the road on both sides; a pipe as round ends in the air."""
    half = pipe(rng, 0.2, 10.0, 0.05, 0.01, (1, 0, 0), seen=0.5)
    half[:, 2] = np.abs(half[:, 2])
    road = rng.uniform([-5, -1], [5, 1], (8000, 2))
    road = np.column_stack([road, rng.normal(0, 0.01, len(road))])[np.abs(road[:, 1]) > 0.2]
    assert len(detect(half, max_radius=1.0)[2]) == 1
    assert len(detect(np.concatenate([half, road]), max_radius=1.0)[2]) == 0


def test_one_tank_is_not_three_in_each_other(rng):
    """The stairs around a wall, which bend as it does, looked like wider tanks."""
    tank = pipe(rng, 8.56, 12.0, 0.25, 0.02, (0, 0, 1), seen=1.0)
    shells = [pipe(rng, 8.56 + more, 12.0, 0.45, 0.02, (0, 0, 1), seen=0.5) for more in (0.24, 0.41)]
    _, _, axes = detect(np.concatenate([tank, *shells]), min_radius=5.0)
    assert axes.columns["radius"] == pytest.approx([8.56], abs=0.01)
