"""Noise is found in scenes where it is known, and no object of these becomes noise, hanging wires included."""

import numpy as np
import pytest

from lidar_buildings.algorithms.preparation.classify_noise_histogram import classify_noise_histogram
from lidar_buildings.algorithms.stage import Monitor


def terrain(xy, slope):
    return slope * xy[:, 0] + 0.5 * np.sin(xy[:, 1] / 9)


def scene(rng, density, slope=0.0, side=None):
    """Return a hillside with houses, chimneys, masts, lamps, wires, a wood; and the elevation of the ground."""
    side = side or float(np.clip(np.sqrt(60_000 / density), 100, 500))
    xy = rng.uniform(0, side, (int(density * side * side), 2))
    z = terrain(xy, slope)
    in_house = (xy[:, 0] % 40 < 10) & (xy[:, 1] % 40 < 12)
    z[in_house] += 6 + (5 - np.abs(xy[in_house, 0] % 40 - 5)) * 0.8
    in_wood = xy[:, 0] > 0.8 * side
    z[in_wood] += rng.uniform(0, 18, in_wood.sum()) * (rng.random(in_wood.sum()) < 0.8)
    chimney = in_house & (np.abs(xy[:, 0] % 40 - 5) < 0.4) & (np.abs(xy[:, 1] % 40 - 6) < 0.4)
    z[chimney] += 1.8
    parts = [np.column_stack([xy, z])]
    along = np.arange(0, 0.75 * side, min(2.0, 1 / density**0.5))
    wire = np.column_stack([along, np.full(len(along), 0.3 * side)])
    parts.append(np.column_stack([wire, terrain(wire, slope) + 25]))
    for at in (0.25, 0.5, 0.7):
        foot = np.array([[at * side, 0.5 * side]])
        mast = np.arange(0, 15, 1.5)
        parts.append(np.column_stack([np.repeat(foot, len(mast), 0), terrain(foot, slope) + mast]))
        lamp = foot + [3, 17] + rng.normal(0, 0.2, (3, 2))
        parts.append(np.column_stack([lamp, terrain(lamp, slope) + 8]))
    return np.concatenate(parts)


@pytest.mark.parametrize("slope", [0.0, 0.6])
@pytest.mark.parametrize("density", [0.3, 2, 20])
def test_nothing_of_the_scene_is_lost(rng, density, slope):
    xyz = scene(rng, density, slope)
    made = classify_noise_histogram(xyz, np.ones(len(xyz), np.uint8))
    assert np.isin(made, (7, 18)).sum() <= 2e-4 * len(xyz)


@pytest.mark.parametrize("slope", [0.0, 0.6])
@pytest.mark.parametrize("density", [0.3, 2, 20])
def test_noise_is_found(rng, density, slope):
    """One point in a thousand, farther below or above the scene than its ground spans around a cell."""
    clean = scene(rng, density, slope)
    xy = rng.uniform(clean[:, :2].min(0), clean[:, :2].max(0), (len(clean) // 1000, 2))
    span = slope * 3 * np.sqrt(450 / density)
    off = rng.uniform(5 + span, 80 + span, len(xy)) * np.where(rng.random(len(xy)) < 0.5, -1, 1)
    noise = np.column_stack([xy, terrain(xy, slope) + off + 25 * (off > 0)])
    xyz, truth = np.concatenate([clean, noise]), np.repeat([False, True], [len(clean), len(noise)])
    made = classify_noise_histogram(xyz, np.ones(len(xyz), np.uint8))
    found = np.isin(made, (7, 18))
    assert (found & truth).sum() >= 0.95 * truth.sum()
    assert (found & truth).sum() >= 0.90 * found.sum()
    assert (made[len(clean) :][off < 0] != 18).all()
    assert (made[len(clean) :][off > 0] != 7).all()


def test_position_and_point_order_change_nothing(rng):
    xyz = np.concatenate([scene(rng, 5), [[50, 50, -30], [60, 20, 90]]])
    made = classify_noise_histogram(xyz, np.ones(len(xyz), np.uint8))
    assert (made[-2:] == [7, 18]).all()
    order = rng.permutation(len(xyz))
    assert (classify_noise_histogram(xyz[order], np.ones(len(xyz), np.uint8)) == made[order]).all()
    # Whole cells and bins away, as far as floats allow.
    far = np.round(xyz, 3) + [2.0**19, 2.0**22, 512.0]
    assert (classify_noise_histogram(far, np.ones(len(xyz), np.uint8), cell_size=8.0) != 1).sum() == (made != 1).sum()


def test_facade_between_ground_and_roof_stays(rng):
    flat = np.column_stack([rng.uniform(0, 60, (20_000, 2)), np.zeros(20_000)])
    flat[flat[:, 0] > 30, 2] = 40.0
    facade = np.column_stack([np.full(6, 30.0), rng.uniform(0, 60, 6), [6, 12, 18, 24, 30, 36]])
    xyz = np.concatenate([flat, facade])
    assert (classify_noise_histogram(xyz, np.ones(len(xyz), np.uint8)) == 1).all()


def test_a_dense_flock_far_up_is_noise_whatever_its_number(rng):
    flat = np.column_stack([rng.uniform(0, 60, (20_000, 2)), rng.normal(0, 0.02, 20_000)])
    flock = rng.normal(0, 0.7, (200, 3)) + [30, 30, 1300]
    xyz = np.concatenate([flat, flock])
    made = classify_noise_histogram(xyz, np.ones(len(xyz), np.uint8))
    assert (made[20_000:] == 18).all()
    assert (made[:20_000] == 1).all()
    kept = classify_noise_histogram(xyz, np.ones(len(xyz), np.uint8), max_clearance=2000.0)
    assert (kept[20_000:] == 18).mean() < 0.2


def test_more_frequency_never_finds_less(rng):
    clean = scene(rng, 4)
    noise = rng.uniform([0, 0, -60], [100, 100, 100], (400, 3))
    xyz = np.concatenate([clean, noise])
    found = [
        # The histograms alone, without the search for isolated points.
        np.isin(classify_noise_histogram(xyz, np.ones(len(xyz), np.uint8), min_frequency=f, isolated=False), (7, 18))
        for f in (2, 5, 10)
    ]
    assert (found[0] <= found[1]).all()
    assert (found[1] <= found[2]).all()
    assert found[0].sum() < found[2].sum()


def test_known_noise_stays_and_is_not_counted(rng):
    flat = np.column_stack([rng.uniform(0, 60, (20_000, 2)), np.zeros(20_000)])
    cloud = np.column_stack([rng.uniform(0, 60, (20_000, 2)), np.full(20_000, 30.0)])
    bird = np.array([[30.0, 30, 30]])
    classes = np.repeat([2, 18, 5], [20_000, 20_000, 1])
    made = classify_noise_histogram(np.concatenate([flat, cloud, bird]), classes)
    assert made.dtype == np.uint8
    assert (made == np.repeat([2, 18, 18], [20_000, 20_000, 1])).all()


def test_a_lonely_cell_borrows_its_neighbors_range(rng):
    flat = np.column_stack([rng.uniform(0, 60, (20_000, 2)), np.zeros(20_000)])
    beside = np.array([[90.0, 30, 0.5], [95, 30, 40], [95, 32, -40]])
    made = classify_noise_histogram(np.concatenate([flat, beside]), np.ones(20_003, np.uint8))
    assert made[-3:].tolist() == [1, 18, 7]


@pytest.mark.parametrize("xyz", [np.zeros((1, 3)), np.zeros((50, 3)), [[0, 0, 0], [0, 0, 9]]])
def test_nothing_to_judge_by_is_reported(xyz):
    monitor = Monitor()
    made = classify_noise_histogram(np.asarray(xyz, float), np.full(len(xyz), 2), monitor=monitor)
    assert (made == 2).all()
    assert len(monitor.warnings) == 1


def test_too_few_points_for_any_bin():
    monitor = Monitor()
    xyz = np.array([[0.0, 0, 0], [10, 0, 0], [0, 10, 100]])
    assert (classify_noise_histogram(xyz, np.ones(3, np.uint8), monitor=monitor) == 1).all()
    assert monitor.warnings == ["No noise was found: no bin of the histograms has 5 points."]


def test_automatic_values_are_reported(rng):
    monitor = Monitor()
    flat = np.column_stack([rng.uniform(0, 300, (90_000, 2)), np.zeros(90_000)])
    classify_noise_histogram(flat, np.ones(90_000, np.uint8), monitor=monitor)
    assert monitor.values["cell_size"] == pytest.approx(np.sqrt(450), rel=0.03)
    assert monitor.values["bin_height"] == pytest.approx(2.0, rel=0.03)
    assert (monitor.values["low_noise"], monitor.values["high_noise"]) == (0, 0)
