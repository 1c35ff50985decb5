"""Spheres whose centers and radii are known, and objects that are no spheres."""

import numpy as np
import pytest

from lidar_buildings.algorithms.shapes.detect_spheres import METHODS, detect_spheres
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import EXACT_FAR
from lidar_buildings.tests.industry import bent, edge, pipe, slab

each_method = pytest.mark.parametrize("method", METHODS)


def ball(rng, radius, spacing, noise, seen=0.5):
    """Return points (n, 3) on the upper share ``seen`` of a sphere around zero."""
    count = round(4 * np.pi * radius**2 * seen / spacing**2)
    z, angle = rng.uniform(1 - 2 * seen, 1, count), rng.uniform(0, 2 * np.pi, count)
    away = np.column_stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z])
    return (radius + rng.normal(0, noise, (count, 1))) * away


def detect(xyz, *, segment_id=None, shape=None, **tunables):
    return detect_spheres(xyz, np.ones(len(xyz), np.uint8), segment_id, shape, **tunables)


@each_method
@pytest.mark.parametrize(("radius", "spacing", "noise"), [(0.07, 0.008, 0.001), (0.5, 0.05, 0.004), (4.0, 0.4, 0.02)])
def test_a_sphere_of_any_size_is_found(method, radius, spacing, noise, rng):
    ids, shape, centers = detect(ball(rng, radius, spacing, noise) + [3, 4, 5], method=method, max_radius=3 * radius)
    assert len(centers) == 1
    assert centers.columns["radius"] == pytest.approx([radius], rel=0.02)
    assert centers.geometries[0] == pytest.approx([3, 4, 5], abs=0.03 * radius)
    assert centers.columns["seen"] == pytest.approx([0.5], abs=0.1)
    assert centers.columns["rms"] == pytest.approx([noise], rel=0.2)
    assert (ids == 1).mean() > 0.9
    assert (shape == 3 * ids).all()


@each_method
def test_planes_edges_pipes_elbows_and_clutter_are_no_spheres(method, rng):
    spacing, noise = 0.03, 0.002
    things = [
        slab(rng, 2.0, spacing, noise),
        edge(rng, 2.0, spacing, noise) + [4, 0, 0],
        bent(rng, 0.15, 0.45, spacing, noise) + [8, 0, 0],
        pipe(rng, 0.2, 2.0, spacing, noise, (1, 1, 0.2)) + [12, 0, 0],
        rng.uniform(-0.4, 0.4, (1500, 3)) + [16, 0, 0],
    ]
    monitor = Monitor()
    ids, _, centers = detect(np.concatenate(things), method=method, max_radius=2.0, monitor=monitor)
    assert len(centers) == 0
    assert not ids.any()
    assert monitor.warnings == ["No sphere was found; no point got a new SegmentID."]


@each_method
def test_two_spheres_on_a_floor_stay_apart(method, rng):
    one, other = ball(rng, 0.3, 0.03, 0.002) + [0, 0, 0.6], ball(rng, 0.4, 0.03, 0.002) + [0.9, 0, 0.6]
    ids, _, centers = detect(np.concatenate([one, other, slab(rng, 3.0, 0.03, 0.002)]), method=method, max_radius=1.0)
    assert sorted(centers.columns["radius"]) == pytest.approx([0.3, 0.4], rel=0.02)
    assert len(set(ids[: len(one)]) - {0}) == 1
    assert not ids[len(one) + len(other) :].any()


def test_points_with_a_shape_keep_it(rng):
    one, other = ball(rng, 0.3, 0.03, 0.002), ball(rng, 0.4, 0.03, 0.002) + [2, 0, 0]
    xyz = np.concatenate([one, other])
    shape = np.repeat([2, 0], [len(one), len(other)]).astype(np.uint8)
    segment_id = np.repeat([5, 0], [len(one), len(other)]).astype(np.int32)
    ids, shapes, centers = detect(
        xyz, segment_id=segment_id, shape=shape, max_radius=1.0, search_in="points without a shape"
    )
    assert (ids[: len(one)] == 5).all()
    assert (shapes[: len(one)] == 2).all()
    assert centers.columns["id"] == [6]
    assert set(ids[len(one) :]) <= {0, 6}


def test_position_and_order_do_not_matter(rng):
    xyz = np.round(ball(rng, 1.0, 0.1, 0.005) * 1024) / 1024
    expected, _, centers = detect(xyz, max_radius=2.0)
    far, _, far_centers = detect(xyz + EXACT_FAR, max_radius=2.0)
    np.testing.assert_array_equal(far, expected)
    np.testing.assert_allclose(far_centers.geometries[0] - EXACT_FAR, centers.geometries[0], atol=1e-6)
    order = rng.permutation(len(xyz))
    np.testing.assert_array_equal(detect(xyz[order], max_radius=2.0)[0], expected[order])


def test_bad_input_is_refused_in_a_sentence(rng):
    with pytest.raises(ValueError, match="The range of radii is empty"):
        detect(ball(rng, 0.3, 0.03, 0.002), min_radius=2.0, max_radius=1.0)
    with pytest.raises(ValueError, match="All points lie on one line"):
        detect(np.column_stack([np.arange(50.0)] * 3))
