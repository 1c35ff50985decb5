"""Loose points in the air are found; thin objects, and roofs and crowns that nothing supports, stay."""

import numpy as np

from lidar_buildings.algorithms.preparation.classify_noise_air import classify_noise_air
from lidar_buildings.algorithms.stage import Monitor


def test_what_hangs_by_form_or_density_stays(rng):
    plan = rng.uniform(0, 80, (51_200, 2))
    ground = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])
    roof = np.column_stack([rng.uniform(20, 30, (800, 2)), np.full(800, 12.0)])
    crown = rng.uniform([50, 50, 9], [58, 58, 14], (500, 3))
    along = np.arange(5, 75, 1.0)
    wire = np.column_stack([along, np.full(70, 65.0), 20 + 0.002 * (along - 40) ** 2])
    sparse_wire = np.column_stack([along[::4] + 0.3, np.full(18, 15.0), np.full(18, 18.0)])
    pane = np.column_stack([rng.uniform([35, 5], [45, 12], (40, 2)), np.full(40, 7.0)])
    lamp = rng.uniform([70, 40, 8], [70.4, 40.4, 8.1], (4, 3))
    stays = np.concatenate([ground, roof, crown, wire, sparse_wire, pane, lamp])
    birds = np.array([[40.0, 40, 8], [10, 50, 30], [25, 25, 20]])
    dust = rng.uniform([5, 25, 20], [17, 37, 26], (150, 3))
    xyz, monitor = np.concatenate([stays, birds, dust]), Monitor()
    made = classify_noise_air(xyz, np.ones(len(xyz), np.uint8), monitor=monitor)
    assert (made[: len(stays)] == 1).all()
    assert (made[len(stays) :] == 18).all()
    assert monitor.values["high_noise"] == len(birds) + len(dust)


def test_noise_keeps_its_class_and_a_cloud_without_extent_is_left_alone(rng):
    xyz = np.concatenate([rng.uniform(0, 40, (6400, 3)) * [1, 1, 0.001], [[20.0, 20, 30]]])
    classes = np.append(np.ones(6400, np.uint8), np.uint8(7))
    assert (classify_noise_air(xyz, classes) == classes).all()
    one_place = np.tile(xyz[:1], (5, 1))
    assert (classify_noise_air(one_place, np.ones(5, np.uint8)) == 1).all()
