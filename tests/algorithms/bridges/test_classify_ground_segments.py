"""Bare earth and bridges on a valley with houses, trees and bridges of several kinds and directions."""

import numpy as np
import pytest

from lidar_buildings.algorithms.bridges.classify_ground_segments import classify_ground_segments
from lidar_buildings.algorithms.segmentation.segment_scan_lines import segment_scan_lines
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening

EARTH, WATER, DECK, ROOF, CROWN, PIER = range(6)


def valley(angle=20.0, width=8.0, arch=0.0, density=6.0, seed=4):
    """A canal 14 m wide and 3 m deep, with quays, a bridge across it, a pier, a house and a crown; 80 m by 60 m.

    The bridge crosses at an ``angle`` (°) from the shortest way; ``arch`` is the height of its middle over its ends
    (m).
    """
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(0, (80, 60), (round(80 * 60 * density), 2)).T
    part = np.where(np.abs(x - 40) < 7, WATER, EARTH)
    z = np.where(part == WATER, -3.0, 0.01 * y)
    off = (y - 30) - (x - 40) * np.tan(np.radians(angle))
    deck = (np.abs(off) * np.cos(np.radians(angle)) < width / 2) & (part == WATER)
    z[deck] = 0.01 * y[deck] + arch * (1 - ((x[deck] - 40) / 7) ** 2)
    part[deck] = DECK
    pier = (x > 33) & (x < 40) & (y > 5) & (y < 9)
    part[pier], z[pier] = PIER, 0.0
    house = (x > 10) & (x < 22) & (y > 10) & (y < 24)
    part[house], z[house] = ROOF, 5.0
    points = np.column_stack([x, y, z + rng.normal(0, 0.02, len(x))])
    crown = rng.normal(0, 1, (300, 3))
    crown *= rng.uniform(0.3, 1, (300, 1)) * 3 / np.linalg.norm(crown, axis=1, keepdims=True)
    return np.concatenate([points, crown + [62, 40, 5]]), np.append(part, np.full(300, CROWN))


def classified(xyz, **tunables):
    classes = np.ones(len(xyz), np.uint8)
    return classify_ground_segments(xyz, classes, segment_scan_lines(xyz, classes), **tunables)


def f_score(found, true):
    return 2 * (found & true).sum() / (found.sum() + true.sum())


@pytest.mark.parametrize(("angle", "width", "arch"), [(0, 4, 0), (20, 8, 0), (45, 8, 0), (0, 16, 0), (30, 5, 1.0)])
def test_bridges_of_several_kinds_are_found(angle, width, arch):
    xyz, part = valley(angle, width, arch)
    classes = classified(xyz)
    assert f_score(classes == 17, part == DECK) > 0.9
    assert (classes[part == EARTH] == 2).mean() > 0.98
    assert (classes[part == WATER] == 2).mean() > 0.95
    assert (classes[part == ROOF] == 1).mean() > 0.98
    assert (classes[part == CROWN] == 2).mean() < 0.1
    assert not (classes[(part == PIER) | (part == ROOF)] == 17).any()


def test_quays_banks_and_dikes_are_no_bridges():
    """A dike of 25° with a road on it, and a cutting with walls that has no bridge."""
    rng = np.random.default_rng(9)
    x, y = rng.uniform(0, 60, (20_000, 2)).T
    dike = np.clip(4 - 0.47 * np.maximum(np.abs(x - 20) - 3, 0), 0, None)
    cutting = np.where((np.abs(x - 45) < 4) & (y < 50), -4.0, 0.0)
    classes = classified(np.column_stack([x, y, dike + cutting + rng.normal(0, 0.02, 20_000)]))
    assert not (classes == 17).any()
    assert (classes == 2).mean() > 0.97


def test_limits_of_height_width_and_area():
    xyz, part = valley()
    assert not (classified(xyz, min_height=3.5) == 17).any()
    assert not (classified(xyz, max_width=3.0) == 17).any()
    assert not (classified(xyz, min_bridge_area=300.0) == 17).any()
    assert not (classified(xyz, min_area=50_000.0) == 2).any()


def test_noise_and_water_stay_and_earlier_decks_are_forgotten():
    xyz, part = valley()
    classes = np.ones(len(xyz), np.uint8)
    classes[part == WATER] = 9
    classes[part == ROOF] = 17
    classes[:50] = 18
    made = classify_ground_segments(xyz, classes, segment_scan_lines(xyz, classes))
    assert (made[:50] == 18).all()
    assert (made[classes == 9] == 9).all()
    assert (made[part == ROOF][50:] == 1).mean() > 0.95
    assert f_score(made == 17, part == DECK) > 0.9


def test_ground_of_a_filter_stays_and_bridges_lead_to_it():
    xyz, part = valley()
    ids = segment_scan_lines(xyz, np.ones(len(xyz), np.uint8))
    classes = np.where((part == EARTH) | (part == WATER), 2, 1).astype(np.uint8)
    made = classify_ground_segments(xyz, classes, ids)
    assert f_score(made == 17, part == DECK) > 0.9
    assert (made[part == EARTH] == 2).mean() > 0.98
    only_water = np.where(part == WATER, 2, 1).astype(np.uint8)
    np.testing.assert_array_equal(classify_ground_segments(xyz, only_water, ids), only_water)


def test_no_segments_no_bridges():
    xyz = np.random.default_rng(0).uniform(0, 20, (300, 3))
    for number in (1, 2):
        classes = np.full(300, number, np.uint8)
        np.testing.assert_array_equal(classify_ground_segments(xyz, classes, np.zeros(300, np.int32)), classes)


def test_order_and_position_change_nothing():
    xyz, part = valley()
    xyz = xyz.round(3)
    ones = np.ones(len(xyz), np.uint8)
    ids = segment_scan_lines(xyz, ones)
    classes = classify_ground_segments(xyz, ones, ids)
    order = np.random.default_rng(3).permutation(len(xyz))
    np.testing.assert_array_equal(classify_ground_segments(xyz[order], ones, ids[order]), classes[order])
    assert (classify_ground_segments(xyz + FAR, ones, ids) == classes).mean() > 0.999


def test_cancel_gets_through():
    xyz, part = valley()
    ones = np.ones(len(xyz), np.uint8)
    with pytest.raises(Cancelled):
        classify_ground_segments(xyz, ones, segment_scan_lines(xyz, ones), monitor=Listening(stop_at=0.5))


def test_segments_of_other_programs_may_have_any_numbers():
    xyz, part = valley()
    ones = np.ones(len(xyz), np.uint8)
    ids = segment_scan_lines(xyz, ones)
    classes = classify_ground_segments(xyz, ones, ids)
    spread = np.where(ids > 0, ids * (2_000_000_000 // ids.max()), 0).astype(np.int32)
    np.testing.assert_array_equal(classify_ground_segments(xyz, ones, spread), classes)
