"""Isolated points are found, against brute force and in scenes where they are known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.preparation import classify_noise_statistical as noise_statistical
from lidar_buildings.algorithms.preparation.classify_noise_statistical import classify_noise_statistical
from lidar_buildings.algorithms.stage import Monitor


def test_agrees_with_brute_force(rng, monkeypatch):
    monkeypatch.setattr(noise_statistical, "ROWS_AT_ONCE", 70)
    xyz = np.concatenate([rng.uniform(0, 10, (300, 3)), rng.uniform(-40, 40, (10, 3))])
    distance = np.sort(np.linalg.norm(xyz[:, None] - xyz, axis=2), axis=1)[:, 1:6].mean(axis=1)
    expected = distance > distance.mean() + 1.5 * distance.std()
    made = classify_noise_statistical(xyz, np.ones(310, np.uint8), n_neighbors=5, deviations=1.5, isolated=False)
    assert expected.sum() >= 5
    assert (np.isin(made, (7, 18)) == expected).all()


def test_low_and_high(rng):
    flat = np.column_stack([rng.uniform(0, 30, (9000, 2)), rng.normal(0, 0.02, 9000)])
    xyz = np.concatenate([flat, [[10, 10, -6], [20, 20, 8]]])
    made = classify_noise_statistical(xyz, np.full(len(xyz), 2))
    assert made.dtype == np.uint8
    assert made[-2:].tolist() == [7, 18]
    assert (made[:-2] == 2).mean() > 0.999


@pytest.mark.parametrize("isolated", [False, True])
def test_position_and_point_order_change_nothing(rng, isolated):
    xyz = np.concatenate([rng.uniform(0, 10, (500, 3)), rng.uniform(-40, 40, (10, 3))])
    made = classify_noise_statistical(xyz, np.ones(510, np.uint8), deviations=2.0, isolated=isolated)
    order = rng.permutation(510)
    moved = xyz[order] + [6e5, 5e6, 0]
    there = classify_noise_statistical(moved, np.ones(510, np.uint8), deviations=2.0, isolated=isolated)
    assert (there == made[order]).all()


def test_fewer_deviations_find_more(rng):
    xyz = rng.normal(0, 5, (2000, 3))
    found = [
        np.isin(classify_noise_statistical(xyz, np.ones(2000, np.uint8), deviations=m, isolated=False), (7, 18))
        for m in (4.0, 2.0, 1.0)
    ]
    assert (found[0] <= found[1]).all()
    assert (found[1] <= found[2]).all()
    assert 0 < found[1].sum() < found[2].sum()


def test_known_noise_stays_and_is_not_counted(rng):
    flat = np.column_stack([rng.uniform(0, 30, (9000, 2)), np.zeros(9000)])
    pair = np.array([[15.0, 15, 40], [15, 15, 40.01]])
    classes = np.repeat([2, 18, 5], [9000, 1, 1])
    made = classify_noise_statistical(np.concatenate([flat, pair]), classes, n_neighbors=1)
    assert made[-2:].tolist() == [18, 18]


@pytest.mark.parametrize("n", [1, 8])
def test_too_few_points_give_a_warning(n):
    monitor = Monitor()
    made = classify_noise_statistical(np.zeros((n, 3)), np.ones(n, np.uint8), monitor=monitor)
    assert (made == 1).all()
    assert monitor.warnings == [f"No noise was looked for: {n} points are not enough for 8 neighbors."]


def test_points_all_alike_are_no_noise():
    assert (classify_noise_statistical(np.ones((50, 3)), np.ones(50, np.uint8)) == 1).all()


def test_sparse_parts_of_a_scene_stay_and_what_is_alone_goes(rng):
    """A facade that few beams hit: far from each other, its points are near enough to belong to it."""
    ground = np.column_stack([rng.uniform(0, 40, (16_000, 2)), rng.normal(0, 0.02, 16_000)])
    facade = np.array([[20.0, y, z] for y in range(10, 30, 2) for z in (2.0, 4.0, 6.0)])
    roof = np.column_stack([rng.uniform([20, 9], [26, 31], (1300, 2)), np.full(1300, 8.0)])
    stray = np.array([[5.0, 5, 30], [70, 20, 3], [-50, -50, 0]])
    xyz = np.concatenate([ground, facade, roof, stray])
    plain, made = (
        classify_noise_statistical(xyz, np.ones(len(xyz), np.uint8), deviations=3.0, isolated=isolated)
        for isolated in (False, True)
    )
    assert (plain[16_000:16_030] != 1).any()
    assert (made[:-3] == 1).all()
    assert (made[-3:] != 1).all()


def test_points_at_one_position_in_plan_are_no_noise():
    xyz = np.zeros((50, 3))
    xyz[:, 2] = np.arange(50.0)
    assert (classify_noise_statistical(xyz, np.ones(50, np.uint8)) == 1).all()


def test_a_sample_of_dense_parts_finds_the_same(rng, monkeypatch):
    """Of dense points a sample is measured, and its distances represent all; isolated points are all measured."""
    ground = np.column_stack([rng.uniform(0, 60, (40_000, 2)), rng.normal(0, 0.02, 40_000)])
    crowns = rng.normal([20.0, 20, 9], [4, 4, 1.5], (500, 3))
    stray = rng.uniform([-20, -20, -60], [80, 80, 90], (60, 3))
    xyz, found = np.concatenate([ground, crowns, stray]), []
    for sample in (2_000, 10**9):
        monkeypatch.setattr(noise_statistical, "_SAMPLE", sample)
        monitor = Monitor()
        found.append((classify_noise_statistical(xyz, np.ones(len(xyz), np.uint8), monitor=monitor), monitor.values))
    (part, of_part), (every, of_every) = found
    assert (part == every).all()
    assert np.isin(part, (7, 18)).sum() >= 20
    limits = of_part["max_mean_distance"], of_every["max_mean_distance"]
    assert limits[0] == pytest.approx(limits[1], rel=0.02)
    assert limits[0] != limits[1]


def test_piles_of_points_at_positions_that_no_sample_meets(monkeypatch):
    monkeypatch.setattr(noise_statistical, "_SAMPLE", 4)
    xyz = np.repeat([[0.0, 10, 0], [10, 0, 0]], 200, axis=0)
    assert (classify_noise_statistical(xyz, np.ones(400, np.uint8)) == 1).all()
