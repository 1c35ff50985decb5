"""Regions against a literal, slow version of the published steps, and what thresholds and classes do."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.sampling.density import point_density
from lidar_buildings.algorithms.segmentation.segment_regions import segment_regions
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import FAR


def grow_regions(points, t_dxy, t_dh, t_np):
    """Return regions (lists of point numbers) by steps 1 to 13 of Santos et al. (2019), section 2.3, word by word."""
    radius = np.sqrt(t_dxy**2 + t_dh**2)  # equation 1

    def close_to(center, among):
        # Step 3: a sphere of that radius. Every pair that passes the criteria lies in it, and rounding on its
        # surface must not decide, so the sphere is a whisker larger.
        c = points[center]
        sphere = [i for i in among if np.linalg.norm(points[i] - c) <= radius * (1 + 1e-9)]
        # Step 4: equations 2 and 3, strictly.
        return {
            i
            for i in sphere
            if np.sqrt((points[i][0] - c[0]) ** 2 + (points[i][1] - c[1]) ** 2) < t_dxy
            and abs(points[i][2] - c[2]) < t_dh
        }

    s = list(range(len(points)))  # step 1
    regions = []
    while s:  # step 13
        seed = s[0]  # step 2
        b = {seed}
        a = close_to(seed, s)  # steps 3 and 4
        while True:
            t = set()
            for center in sorted(a):  # steps 5 to 8
                t |= close_to(center, s)
            before = len(b)
            b |= a | t  # step 9
            a = t - a  # step 10
            if len(b) == before:  # step 11
                break
        s = [i for i in s if i not in b]  # step 12
        regions.append(sorted(b))
    return [region for region in regions if len(region) >= t_np]  # equation 4


def literal_ids(points, t_dxy, t_dh, t_np):
    ids = np.zeros(len(points), int)
    for number, region in enumerate(grow_regions(points, t_dxy, t_dh, t_np), start=1):
        ids[region] = number
    return ids


def segment(xyz, t_dxy, t_dh, t_np):
    return segment_regions(
        xyz, np.ones(len(xyz)), plan_distance=t_dxy, height_distance=t_dh, min_area=t_np / 2, density=2.0
    )


# Eighths are exact in binary: many points then lie exactly a threshold apart.
eighths = st.integers(0, 30).map(lambda n: n / 8)


@given(
    st.lists(st.tuples(eighths, eighths, eighths), min_size=1, max_size=45),
    st.integers(1, 12).map(lambda n: n / 8),
    st.integers(1, 12).map(lambda n: n / 8),
    st.integers(1, 6),
)
@settings(max_examples=100)
def test_the_published_steps_on_grids_full_of_ties(points, t_dxy, t_dh, t_np):
    xyz = np.array(points)
    np.testing.assert_array_equal(segment(xyz, t_dxy, t_dh, t_np), literal_ids(xyz, t_dxy, t_dh, t_np))


@pytest.mark.parametrize("seed", range(6))
def test_the_published_steps_on_random_clouds(seed):
    random = np.random.default_rng(seed)
    xyz = random.uniform(0, [12, 9, 2], (250, 3)) + (FAR if seed % 2 else 0)
    t_dxy, t_dh = random.uniform(0.6, 1.0), random.uniform(0.2, 0.4)
    expected = literal_ids(xyz, t_dxy, t_dh, 4)
    np.testing.assert_array_equal(segment(xyz, t_dxy, t_dh, 4), expected)
    assert expected.max() > 2
    assert (expected == 0).any()


@pytest.mark.parametrize(("distance", "linked"), [(2.0, False), (np.nextafter(2.0, 0), True)])
def test_exactly_a_threshold_apart_is_two_regions(distance, linked):
    for offset in ([distance, 0, 0], [0, distance, 0], [0, 0, distance]):
        ids = segment(np.array([[0.0, 0, 0], offset]), 2.0, 2.0, 1)
        assert ids.tolist() == ([1, 1] if linked else [1, 2])


@pytest.mark.parametrize(("min_area", "density", "smallest"), [(4.0, 12.5, 50), (4.0, 4.0, 16), (1.0, 2.5, 3)])
def test_least_number_of_points_is_area_times_density(min_area, density, smallest):
    """The paper's two data sets: 4 m² at 12.5 and 4 points per m² are 50 and 16 points; fewer are left out."""
    sizes = [smallest - 1, smallest, smallest + 1]
    xyz = np.concatenate([np.full((size, 3), 10.0 * i) for i, size in enumerate(sizes)])
    ids = segment_regions(
        xyz, np.ones(len(xyz)), min_area=min_area, density=density, plan_distance=1.0, height_distance=1.0
    )
    assert np.bincount(ids).tolist() == sizes


def test_ground_noise_water_and_bridge_decks_are_in_no_region():
    left_out = [2, 7, 9, 17, 18, 20]
    xyz = np.column_stack([np.arange(10.0), np.zeros(10), np.zeros(10)])
    for number in left_out:
        classification = np.ones(10, int)
        classification[5] = number
        ids = segment_regions(xyz, classification, plan_distance=1.5, height_distance=1.0, min_area=2.0, density=1.0)
        assert ids.tolist() == [1, 1, 1, 1, 1, 0, 2, 2, 2, 2]
    ids = segment_regions(
        xyz, [0, 1, 3, 4, 5, 6, 13, 19, 64, 255], plan_distance=1.5, height_distance=1.0, min_area=1.0, density=1.0
    )
    assert ids.tolist() == [1] * 10


def test_minimum_height_is_inclusive_and_needs_heights():
    xyz = np.column_stack([np.arange(6.0), np.zeros(6), np.zeros(6)])
    height = np.array([3, 2.5, 2, 1.9, 2, np.nan], np.float32)
    given_distances = {"plan_distance": 1.5, "height_distance": 1.0, "min_area": 1.0, "density": 1.0}
    assert segment_regions(xyz, np.ones(6), height, min_height=2.0, **given_distances).tolist() == [1, 1, 1, 0, 2, 0]
    assert segment_regions(xyz, np.ones(6), height, **given_distances).tolist() == [1] * 6
    with pytest.raises(ValueError, match="needs HeightAboveGround; run 'Height above ground' first or set it to 0"):
        segment_regions(xyz, np.ones(6), min_height=2.0)


def test_automatic_thresholds_come_from_density_and_noise(rng):
    plan = rng.uniform(0, 40, (6000, 2))
    xyz = np.column_stack([plan, rng.normal(0, 0.025, 6000)])
    monitor = Monitor()
    segment_regions(xyz, np.ones(6000), monitor=monitor)
    assert monitor.values["density"] == pytest.approx(6000 / 1600, rel=0.05)
    assert monitor.values["density"] == point_density(xyz)
    assert monitor.values["plan_distance"] == pytest.approx(2 / np.sqrt(point_density(xyz)))
    assert monitor.values["height_distance"] == 10 * CloudSampling.of(xyz).noise
    assert monitor.values["height_distance"] == pytest.approx(0.25, rel=0.05)


@pytest.mark.parametrize(("noise", "distance"), [(0.01, 0.2), (0.06, 0.3)])
def test_the_height_difference_is_between_those_of_the_paper(noise, distance, rng):
    """With 0.11 to 0.18 m, ten times a noise that was understated, sloping roofs of sparse clouds fell apart."""
    monitor = Monitor()
    xyz = np.column_stack([rng.uniform(0, 40, (6000, 2)), rng.normal(0, noise, 6000)])
    segment_regions(xyz, np.ones(6000), monitor=monitor)
    assert monitor.values["height_distance"] == distance


@pytest.mark.parametrize(
    ("thresholds", "distances", "points"),
    [("12.5 points/m² (table 2)", (0.6, 0.2), 50), ("4 points/m² (table 2)", (1.4, 0.3), 16)],
)
def test_thresholds_of_the_paper_whatever_the_cloud_is_like(thresholds, distances, points):
    """Rows of points, each as dense as the others, of which those with T_Np points and more are regions."""
    sizes = (points - 1, points, points + 5)
    xyz = np.vstack([[[0.1 * i, 20.0 * row, 0] for i in range(size)] for row, size in enumerate(sizes)])
    monitor = Monitor()
    found = segment_regions(xyz, np.ones(len(xyz)), thresholds=thresholds, monitor=monitor)
    assert (monitor.values["plan_distance"], monitor.values["height_distance"]) == distances
    np.testing.assert_array_equal(found, np.repeat([0, 1, 2], sizes))
    segment_regions(xyz, np.ones(len(xyz)), thresholds=thresholds, plan_distance=0.9, monitor=monitor)
    assert (monitor.values["plan_distance"], monitor.values["height_distance"]) == (0.9, distances[1])


def test_two_houses_and_a_field_with_nothing_to_set(rng):
    field = np.column_stack([rng.uniform(0, 60, (14_000, 2)), rng.normal(0, 0.03, 14_000)])
    field[((field[:, :2] > [10, 10]) & (field[:, :2] < [22, 18])).all(axis=1), 2] += 5
    field[((field[:, :2] > [25, 10]) & (field[:, :2] < [40, 30])).all(axis=1), 2] += 7
    house = np.where(field[:, 2] > 6, 2, np.where(field[:, 2] > 4, 1, 0))
    ids = segment_regions(field, np.where(house > 0, 1, 2))
    pairs = set(zip(house.tolist(), ids.tolist())) - {(1, 0), (2, 0)}
    assert pairs in ({(0, 0), (1, 1), (2, 2)}, {(0, 0), (1, 2), (2, 1)})
    # Four points in a thousand have no neighbor within twice the spacing and the height threshold.
    assert (ids[house > 0] == 0).mean() < 0.01


def test_only_ground_gives_no_region(rng):
    ids = segment_regions(rng.uniform(0, 9, (50, 3)), np.full(50, 2))
    assert ids.dtype == np.int32
    assert not ids.any()


def test_order_and_position_change_nothing(rng):
    xyz = rng.uniform(0, [20, 20, 3], (800, 3)).round(3)
    tunables = {"height_distance": 0.3, "min_area": 2.0}
    ids = segment_regions(xyz, np.ones(800), **tunables)
    assert ids.max() > 5
    order = rng.permutation(800)
    shuffled = segment_regions(xyz[order], np.ones(800), **tunables)
    assert len(set(zip(ids[order].tolist(), shuffled.tolist()))) == ids.max() + 1 == shuffled.max() + 1
    there = segment_regions((xyz + FAR).round(3), np.ones(800), **tunables)
    np.testing.assert_array_equal(there, ids)


def test_memory_follows_the_points_and_not_their_neighbors(rng):
    """With everything within reach of everything else, pairs would grow sixteenfold where points grow fourfold."""
    peaks = []
    for n in (4_000, 16_000):
        xyz = rng.uniform(0, [20, 20, 2], (n, 3))
        tracemalloc.start()
        ids = segment_regions(xyz, np.ones(n), plan_distance=10.0, height_distance=1.0, density=1.0)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert (ids == 1).all()
    assert peaks[1] < 4.5 * peaks[0]
    assert peaks[1] < 400e6  # the 6e7 pairs within reach would take 1 GB
