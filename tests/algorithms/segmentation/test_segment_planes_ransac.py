"""RANSAC in voxels on solids whose planes are known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidar_buildings.algorithms.planes import voxel_planes
from lidar_buildings.algorithms.segmentation.segment_planes_ransac import segment_planes_ransac
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import EXACT_FAR, gable, tilted
from lidar_buildings.tests.monitors import Listening


def segment(xyz, **tunables):
    return segment_planes_ransac(xyz, np.ones(len(xyz)), **tunables)[0]


def sizes(ids):
    """Return the share of points on no plane, and of each plane, largest first."""
    count = np.bincount(ids)
    return count[0] / len(ids), sorted(count[1:] / len(ids), reverse=True)


@pytest.mark.parametrize(("density", "noise"), [(4, 0.03), (15, 0.03), (50, 0.05), (200, 0.03)])
def test_a_gable_roof_has_two_planes_and_a_tree_none(density, noise, rng):
    roof, is_north = gable(rng, density, noise)
    crown = rng.uniform([20, 0, 2], [28, 8, 9], (100 * density, 3))
    ids, normals = segment_planes_ransac(np.concatenate([roof, crown]), np.ones(len(roof) + len(crown)), normals=True)
    of_roof = ids[: len(roof)]
    assert ids.max() == 2
    assert (ids[len(roof) :] == 0).all()
    for side in (is_north, ~is_north):
        found = np.bincount(of_roof[side], minlength=3)
        assert found.max() > 0.95 * side.sum()
        expected = [0, np.sin(np.radians(35)) * (1 if side is is_north else -1), np.cos(np.radians(35))]
        on_it = normals[: len(roof)][side & (of_roof == np.argmax(found))]
        np.testing.assert_allclose(on_it, np.broadcast_to(expected, on_it.shape), atol=0.01)
    assert np.isnan(normals[ids == 0]).all()


@given(st.floats(0, 90), st.integers(0, 2**31 - 1))
@settings(max_examples=15)
def test_a_plane_is_one_plane_at_any_slope(slope, seed):
    xyz = tilted(np.random.default_rng(seed), slope)
    nowhere, found = sizes(segment(xyz, max_slope=90.0, seed=seed))
    assert len(found) == 1
    assert nowhere < 0.03


@pytest.mark.parametrize(("slope", "kept"), [(0, True), (45, True), (58, True), (62, False), (90, False)])
def test_roofs_have_a_normal_within_60_degrees_of_the_vertical(slope, kept, rng):
    xyz = tilted(rng, slope)
    assert segment(xyz).any() == kept
    assert segment(xyz, min_slope=slope - 1 if slope else 0, max_slope=min(slope + 1, 90)).any()


def test_walls_are_kept_where_they_are_asked_for(rng):
    roof, wall = tilted(rng, 20), tilted(rng, 90) - [0.3, 0, 9]
    xyz = np.concatenate([roof, wall])
    assert segment(xyz)[: len(roof)].any()
    assert not segment(xyz)[len(roof) :].any()
    walls = segment(xyz, min_slope=70.0, max_slope=90.0)
    assert not walls[: len(roof)].any()
    assert (walls[len(roof) :] == 1).mean() > 0.97


def test_three_planes_of_one_voxel(rng):
    """The corner of a box of 1.5 m, all of it in one voxel of 2 m."""
    faces = rng.uniform(0, 1.5, (3, 400, 3))
    for axis in range(3):
        faces[axis, :, axis] = rng.normal(0, 0.01, 400)
    ids = segment(faces.reshape(-1, 3), voxel_size=2.0, tolerance=0.03, max_slope=90.0, min_area=1.0)
    assert ids.max() == 3
    for face in ids.reshape(3, 400):
        assert np.bincount(face, minlength=4).max() > 370
    only_one = segment(faces.reshape(-1, 3), voxel_size=2.0, tolerance=0.03, max_slope=90.0, min_area=1.0, max_planes=1)
    assert only_one.max() == 1


@pytest.mark.parametrize("voxel_size", [1.0, 1.5, 3.0])
def test_pieces_of_a_plane_are_joined_over_all_voxels(voxel_size, rng):
    nowhere, found = sizes(segment(tilted(rng, 25, size=15), voxel_size=voxel_size))
    assert len(found) == 1
    assert nowhere < 0.03


def test_a_plane_grows_along_a_strip_too_thin_for_a_plane_of_its_own(rng):
    """Four meters of a strip 0.4 m wide: about five points in a voxel, of which ten would be a plane by themselves."""
    strip = rng.uniform([8, 3.8, 0], [12, 4.2, 0], (70, 3)) + rng.normal(0, 0.01, (70, 3)) * [0, 0, 1]
    ids = segment(np.concatenate([tilted(rng, 0, noise=0.01, density=40), strip]), voxel_size=0.6, tolerance=0.06)
    assert ids.max() == 1
    assert (ids[-70:] == 1).mean() > 0.95


def test_a_plane_grows_past_a_few_points_that_lie_off_it(rng):
    """A third of a voxel's points may do so: a bird, a twig."""
    strip = rng.uniform([8, 3.7, 0], [12, 4.1, 0], (70, 3)) + rng.normal(0, 0.01, (70, 3)) * [0, 0, 1]
    above = np.column_stack([np.arange(8.3, 12, 0.6), np.full(7, 3.9), np.full(7, 0.3)])
    ids = segment(
        np.concatenate([tilted(rng, 0, noise=0.01, density=40), above, strip]), voxel_size=0.6, tolerance=0.06
    )
    assert (ids[-70:] == 1).mean() > 0.9
    assert not ids[-77:-70].any()


def test_a_plane_does_not_grow_along_single_points(rng):
    """One in each voxel, all of them on it: so few lie there by chance."""
    x, y = np.meshgrid(np.arange(8.3, 14, 0.6), np.arange(0.3, 8, 0.6))
    single = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    ids = segment(np.concatenate([tilted(rng, 0, noise=0.01, density=40), single]), voxel_size=0.6, tolerance=0.06)
    assert not ids[-len(single) :][single[:, 0] > 9.2].any()


def test_a_plane_does_not_grow_into_leaves_beside_it(rng):
    crown = rng.uniform([8, 0, -2], [12, 8, 2], (6000, 3))
    ids = segment(np.concatenate([tilted(rng, 0, noise=0.01, density=40), crown]), voxel_size=0.6, tolerance=0.06)
    # By chance a few lie on it in the voxels next to it, and no farther.
    assert (ids[-6000:] > 0).mean() < 0.01
    assert not ids[-6000:][crown[:, 0] > 9.2].any()


def test_every_point_goes_to_the_nearest_plane(rng):
    """At the ridge points lie within the tolerance of both."""
    roof, is_north = gable(rng, density=40, noise=0.0)
    ids = segment(roof, tolerance=0.15)
    assert set(ids.tolist()) == {1, 2}
    # Those on the ridge itself are as near to one as to the other but for the planes' last digits.
    assert ((ids == ids[np.argmax(is_north)]) != is_north).mean() < 0.005


def test_terraces_half_a_meter_apart_stay_apart(rng):
    """Joined are planes that are the same, not planes that are parallel."""
    xyz = tilted(rng, 0, size=12)
    upper = xyz[:, 0] > 6
    xyz[upper, 2] += 0.5
    ids = segment(xyz)
    assert ids.max() == 2
    assert (ids[upper] == ids[upper][0]).mean() > 0.97
    assert (ids[~upper] == ids[~upper][0]).mean() > 0.97


def test_a_barrel_roof_is_cut_into_strips_that_hold_their_points(rng):
    angle, along = rng.uniform(-0.9, 0.9, 6000), rng.uniform(0, 12, 6000)
    xyz = np.column_stack([along, 8 * np.sin(angle), 8 * np.cos(angle)]) + rng.normal(0, 0.02, (6000, 3))
    monitor = Monitor()
    ids, normals = segment_planes_ransac(xyz, np.ones(6000), normals=True, monitor=monitor)
    assert (ids > 0).mean() > 0.9
    assert 4 <= ids.max() <= 40
    for number in range(1, ids.max() + 1):
        own = ids == number
        off = (xyz[own] - xyz[own].mean(axis=0)) @ normals[own][0]
        assert np.abs(off).max() <= 2.5 * monitor.values["tolerance"]


def test_seed_decides_and_order_position_and_chunks_do_not(monkeypatch, rng):
    roof, _ = gable(rng)
    xyz = np.round(np.concatenate([roof, rng.uniform([0, 0, 4], [12, 8, 10], (800, 3))]) * 1024) / 1024
    ids = segment(xyz)
    np.testing.assert_array_equal(segment(xyz), ids)
    np.testing.assert_array_equal(segment(xyz + EXACT_FAR), ids)
    order = rng.permutation(len(xyz))
    shuffled = segment(xyz[order])
    assert (
        len(set(zip(ids[order].tolist(), shuffled.tolist()))) == len(set(ids.tolist())) == len(set(shuffled.tolist()))
    )
    monkeypatch.setattr(voxel_planes, "PAIRS_AT_ONCE", 5000)
    np.testing.assert_array_equal(segment(xyz), ids)
    assert any((segment(xyz, trials=3, seed=seed) != segment(xyz, trials=3)).any() for seed in range(2, 6))


def test_many_points_at_one_position_and_lines_are_no_plane(rng):
    xyz = np.concatenate([np.zeros((500, 3)), np.column_stack([np.linspace(5, 30, 500), np.zeros((500, 2))])])
    monitor = Monitor()
    ids, _ = segment_planes_ransac(xyz, np.ones(1000), max_slope=90.0, monitor=monitor)
    assert not ids.any()
    assert monitor.warnings == ["No plane was found; no point has a SegmentID."]


@pytest.mark.parametrize("n", [1, 2, 3])
def test_fewer_points_than_a_plane(n):
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])[:n]
    ids, normals = segment_planes_ransac(xyz, np.ones(n), normals=True)
    assert ids.tolist() == [0] * n
    assert ids.dtype == np.int32
    assert np.isnan(normals).all()


def test_a_cloud_of_walls_alone_gives_a_warning_on_the_slope(rng):
    monitor = Monitor()
    xyz = tilted(rng, 90)
    assert not segment_planes_ransac(xyz, np.ones(len(xyz)), monitor=monitor)[0].any()
    assert monitor.warnings == ["No plane has a slope from 0° to 60°, of 1 found; no point has a SegmentID."]


def test_ground_is_left_out_and_minimum_height_needs_heights(rng):
    xyz = tilted(rng, 10)
    height = np.where(xyz[:, 1] > 4, 3, 1).astype(np.float32)
    assert not segment_planes_ransac(xyz, np.full(len(xyz), 2))[0].any()
    ids = segment_planes_ransac(xyz, np.ones(len(xyz)), height, min_height=2.0)[0]
    assert not ids[height < 2].any()
    assert (ids[height > 2] == 1).mean() > 0.95
    with pytest.raises(ValueError, match="needs HeightAboveGround"):
        segment_planes_ransac(xyz, np.ones(len(xyz)), min_height=2.0)


def test_slopes_in_the_wrong_order_are_refused(rng):
    with pytest.raises(ValueError, match=r"minimum slope \(70°\) is above the maximum slope \(60°\); lower it"):
        segment_planes_ransac(tilted(rng, 10), np.ones(1280), min_slope=70.0)


def test_automatic_values_follow_density_and_noise(rng):
    coarse, fine = Monitor(), Monitor()
    segment_planes_ransac(tilted(rng, 0, size=30, density=5, noise=0.02), np.ones(4500), monitor=coarse)
    segment_planes_ransac(tilted(rng, 0, size=10, density=100, noise=0.02), np.ones(10_000), monitor=fine)
    assert coarse.values["voxel_size"] == pytest.approx(np.sqrt(20 / 5), rel=0.1)
    assert fine.values["voxel_size"] == pytest.approx(10 * fine.values["tolerance"])
    assert 0.06 <= fine.values["tolerance"] <= 0.08


def test_cancel_gets_through(rng):
    with pytest.raises(Cancelled):
        segment_planes_ransac(tilted(rng, 10), np.ones(1280), monitor=Listening(stop_at=0.0))
