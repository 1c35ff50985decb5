"""Planes by the Hough transform on solids whose planes are known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.shapes.hough_planes import PlaneDirections
from lidar_buildings.algorithms.shapes.segment_planes_hough import METHODS, segment_planes_hough
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import EXACT_FAR, FAR, crown, gable, tilted

each_method = pytest.mark.parametrize("method", METHODS)


def square(rng, slope, size=6.0, noise=0.02):
    return tilted(rng, slope, size, 25.0, noise)


def segment(xyz, *, segment_id=None, shape=None, **tunables):
    return segment_planes_hough(xyz, np.ones(len(xyz), np.uint8), segment_id, shape, **tunables)


@each_method
def test_a_gable_roof_has_two_planes_and_a_crown_none(method, rng):
    roof, is_north = gable(rng, 20.0, 0.02)
    tree = crown(rng, 22, 4, 4, 6, 1500)
    ids, shape, planes = segment(np.concatenate([roof, tree]), method=method)
    assert ids.max() == len(planes) == 2
    assert not ids[len(roof) :].any()
    assert (shape == (ids > 0)).all()
    for side, aspect in ((is_north, 0.0), (~is_north, 180.0)):
        number = int(np.bincount(ids[: len(roof)][side]).argmax())
        assert (ids[: len(roof)][side] == number).mean() > 0.95
        row = planes.columns["id"].index(number)
        assert planes.columns["slope"][row] == pytest.approx(35, abs=0.5)
        assert np.cos(np.radians(planes.columns["aspect"][row] - aspect)) > np.cos(np.radians(2))
        assert planes.columns["area"][row] == pytest.approx(48 / np.cos(np.radians(35)), rel=0.15)
        # Noise of 0.02 m in height is less across the slope.
        assert planes.columns["rms"][row] == pytest.approx(0.02 * np.cos(np.radians(35)), rel=0.1)


@each_method
@pytest.mark.parametrize("slope", [0, 20, 44, 46, 70, 90])
def test_a_plane_of_any_slope_is_one_plane(method, slope, rng):
    ids, _, planes = segment(square(rng, slope), method=method)
    assert ids.max() == 1
    assert (ids == 1).mean() > 0.95
    assert planes.columns["slope"] == pytest.approx([slope], abs=0.5)
    assert planes.columns["area"] == pytest.approx([36], rel=0.12)


@each_method
def test_coplanar_surfaces_are_parted_by_a_gap(method, rng):
    """They have one maximum of the parameter space and are two surfaces."""
    one = square(rng, 0)
    ids, _, planes = segment(np.concatenate([one, one + [6.9, 0, 0]]), method=method)
    assert len(planes) == 2
    assert not set(ids[: len(one)]) & set(ids[len(one) :]) - {0}
    assert len(segment(np.concatenate([one, one + [6.9, 0, 0]]), method=method, max_gap=1.2)[2]) == 1


@each_method
def test_small_planes_are_left_out(method, rng):
    xyz = np.concatenate([square(rng, 0), square(rng, 0, size=2.0) + [20, 0, 0]])
    assert len(segment(xyz, method=method, min_area=1.0)[2]) == 2
    assert len(segment(xyz, method=method, min_area=5.0)[2]) == 1


def test_bins_smaller_than_the_noise_lose_the_maximum(rng):
    """The trade-off of the paper, section 4.1.1: the share found of a rough plane with bins of a tenth of its noise."""
    xyz = square(rng, 10, noise=0.1)
    wide = segment(xyz, tolerance=0.23, distance_bin=0.23, window_size=3.0, min_area=4.0)
    narrow = segment(
        xyz, tolerance=0.01, distance_bin=0.01, slope_bin=2.0, window_size=3.0, min_area=4.0, monitor=Monitor()
    )
    assert (wide[0] > 0).mean() > 0.9
    assert (narrow[0] > 0).mean() < 0.2


def test_votes_are_those_of_a_literal_accumulator(rng):
    """Brute force: for each point and each bin of slopes, the bin of the distance counts one."""
    from lidar_buildings.algorithms.geometry.boxes import Boxes
    from lidar_buildings.algorithms.shapes.hough_planes import HoughPlanes

    xyz = rng.uniform(-1, 1, (40, 3))
    hough = HoughPlanes(Boxes(xyz, 2.5), 2.0, 0.1, 0.2, 0.5)
    votes = np.zeros((len(hough.directions), hough.levels), int)
    for point in xyz:
        for number, normal in enumerate(hough.directions.normal):
            votes[number, int((point @ normal + hough.reach) / 0.2)] += 1
    np.testing.assert_array_equal(hough._votes(xyz), votes)


def test_each_direction_falls_into_the_bin_around_it(rng):
    directions = PlaneDirections(0.1)
    np.testing.assert_array_equal(directions.bin_of(directions.normal), np.arange(len(directions)))
    normal = rng.normal(size=(500, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    found = directions.normal[directions.bin_of(normal)]
    assert (np.degrees(np.arccos(np.abs((normal * found).sum(axis=1)))) < 5.0).all()
    np.testing.assert_array_equal(directions.bin_of(normal), directions.bin_of(-normal))


@each_method
def test_segments_are_searched_one_by_one(method, rng):
    """Two segments in one plane stay two, a shape found before is left alone, and numbers go on."""
    xyz = square(rng, 5, size=8.0)
    segment_id = np.where(xyz[:, 0] < 4, 1, 2).astype(np.int32)
    segment_id[:50] = 7
    shape = np.zeros(len(xyz), np.uint8)
    shape[:50] = 2
    ids, shapes, planes = segment(xyz, segment_id=segment_id, shape=shape, method=method, search_in="each segment")
    assert (ids[:50] == 7).all()
    assert (shapes[:50] == 2).all()
    assert sorted(planes.columns["id"]) == [8, 9]
    for old in (1, 2):
        assert set(ids[segment_id == old]) <= {old, 8, 9}
        assert len(set(ids[(segment_id == old) & (shapes == 1)])) == 1
    assert (shapes[50:] == 1).mean() > 0.9
    with pytest.raises(ValueError, match="Searching in each segment needs SegmentID; run a segmentation first"):
        segment(xyz, search_in="each segment")


@each_method
def test_position_and_order_do_not_matter(method, rng):
    xyz = np.round(np.concatenate([gable(rng, 20.0, 0.02)[0], square(rng, 70) + [15, 0, 0]]) * 1024) / 1024
    expected, _, planes = segment(xyz, method=method)
    far, _, far_planes = segment(xyz + EXACT_FAR, method=method)
    np.testing.assert_array_equal(far, expected)
    np.testing.assert_allclose(far_planes.geometries[0][0] - EXACT_FAR, planes.geometries[0][0], atol=1e-6)
    order = rng.permutation(len(xyz))
    shuffled = segment(xyz[order], method=method)[0]
    assert ((shuffled > 0) == (expected[order] > 0)).all()
    assert len(np.unique(np.column_stack([shuffled, expected[order]]), axis=0)) == len(np.unique(expected))


def test_polygons_lie_on_their_plane(rng):
    planes = segment(square(rng, 30, noise=0.005) + FAR)[2]
    ring = planes.geometries[0][0] - FAR
    assert np.abs(ring[:, 2] - np.tan(np.radians(30)) * ring[:, 0]).max() < 0.02
    np.testing.assert_array_equal(ring[0], ring[-1])


def test_bad_input_is_refused_in_a_sentence(rng):
    line = np.column_stack([np.arange(50.0)] * 3)
    with pytest.raises(ValueError, match="All points lie on one line, so that no surface has a normal"):
        segment(line)
    with pytest.raises(ValueError, match="Shapes need at least three points, got 2"):
        segment(line[:2])
    with pytest.raises(ValueError, match="would have [0-9,]+ million bins, more than 20 million; take larger bins"):
        segment(square(rng, 0), window_size=50.0, distance_bin=0.01, slope_bin=0.1)


def test_a_cloud_without_planes_says_so(rng):
    monitor = Monitor()
    ids, _, planes = segment(rng.uniform(0, 10, (3000, 3)), tolerance=0.1, window_size=2.0, monitor=monitor)
    assert not ids.any()
    assert len(planes) == 0
    assert monitor.warnings == ["No plane was found; no point got a new SegmentID."]


def test_grouping_the_points_of_one_large_plane_can_be_canceled(rng):
    """Progress was reported once per plane, however many points it had."""
    reported: list[float] = []
    monitor = Monitor()
    monitor.progress = reported.append
    segment(square(rng, 0.0, size=20.0), monitor=monitor)
    assert len([fraction for fraction in reported if 0.8 < fraction < 1]) > 10
    assert reported == sorted(reported)


def test_a_part_of_a_cloud_has_the_planes_of_the_whole(rng):
    """Forty plates at all angles, of which the first and part of the second of each row are cut off."""
    plates = []
    for number in range(40):
        axes = np.linalg.qr(rng.normal(size=(3, 3)))[0][:2]
        middle = np.array([number % 8, number // 8, 0]) * 1.5 + rng.uniform(0, 0.3, 3)
        plates.append(middle + rng.uniform(-0.6, 0.6, (300, 2)) @ axes + rng.normal(0, 0.004, (300, 3)))
    xyz = np.concatenate(plates)
    sampling = CloudSampling.of(xyz)
    kept = np.flatnonzero(xyz[:, 0] > 1.0)
    part = CloudSampling(lambda: xyz[kept], corner=sampling.corner)
    of_whole, of_part = (
        segment(points, window_size=0.7, sampling=sampled)[0]
        for points, sampled in ((xyz, sampling), (xyz[kept], part))
    )
    is_far = xyz[kept, 0] > 2.6
    pairs, count = np.unique(np.column_stack([of_whole[kept], of_part])[is_far], axis=0, return_counts=True)
    is_one = np.all([np.bincount(numbers)[numbers] == 1 for numbers in pairs.T], axis=0)
    # 0.92 here, 0.30 if windows begin at the corner of the part: a point that is near two planes decides on some.
    assert count[is_one].sum() > 0.75 * count.sum()
