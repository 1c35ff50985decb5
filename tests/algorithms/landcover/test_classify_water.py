"""Water in classified ground: canals, ponds and rivers, and what looks like them from above."""

import numpy as np
import pytest

from lidar_buildings.algorithms.landcover.classify_water import classify_water
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.simulation.simulate_bridges import simulate_bridges
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.river_town import river_town


def canal(drop=1.0, width=12.0, share=0.2, fall=0.0, density=8.0, length=60.0, seed=2):
    """Land of 80 m by 60 m with a canal ``drop`` (m) lower that returns a ``share`` of the pulses, and which is water.

    Land falls by 1 % across the canal; the canal falls by ``fall`` along it.
    """
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(0, (80, 60), (round(80 * 60 * density), 2)).T
    is_water = (np.abs(x - 40) < width / 2) & (np.abs(y - 30) < length / 2)
    stays = ~is_water | (rng.random(len(x)) < share)
    x, y, is_water = x[stays], y[stays], is_water[stays]
    z = np.where(is_water, -drop - fall * y, 0.01 * (x - 40)) + rng.normal(0, 0.02, len(x))
    return np.column_stack([x, y, z]), is_water


def f_score(found, true):
    return 200 * (found & true).sum() / (found.sum() + true.sum())


def on_ground(xyz, **more):
    return classify_water(xyz, np.full(len(xyz), 2, np.uint8), **more) == 9


@pytest.mark.parametrize(("share", "fall"), [(0.05, 0.0), (0.2, 0.0), (0.3, 0.002)])
def test_a_canal_is_water_however_few_pulses_come_back(share, fall):
    xyz, is_water = canal(share=share, fall=fall)
    assert f_score(on_ground(xyz), is_water) > 95


def test_surfaces_that_return_all_pulses_are_no_water():
    assert not on_ground(canal(share=1.0)[0]).any()


def test_what_is_as_high_as_its_surroundings_is_no_water():
    """Wet asphalt, which gives few pulses back, is no lower than the street next to it."""
    assert not on_ground(canal(drop=0.0)[0]).any()
    assert not on_ground(canal(drop=-0.5)[0]).any()


def test_what_is_not_level_is_no_water():
    """A wet road in a cutting that falls by 4 %."""
    assert not on_ground(canal(fall=0.04)[0]).any()


def test_a_small_pit_is_no_water_unless_asked_for():
    xyz, is_water = canal(length=10.0)
    assert not on_ground(xyz, min_area=200.0).any()
    assert f_score(on_ground(xyz, min_area=20.0), is_water) > 90


def test_classes_that_are_no_water_stay():
    """Boats, roofs, bridges and noise at the height of the water; only ground and unclassified points become water."""
    xyz, is_water = canal()
    rng = np.random.default_rng(3)
    for kept in (3, 5, 6, 7, 14, 17, 18, 26):
        classes = np.where(is_water & (rng.random(len(xyz)) < 0.2), kept, 2).astype(np.uint8)
        made = classify_water(xyz, classes)
        np.testing.assert_array_equal(made == kept, classes == kept)
        assert (made[is_water & (classes == 2)] == 9).mean() > 0.9


def test_nothing_changes_without_looking_for_water_and_in_clouds_of_images():
    xyz, _ = canal(density=16.0)
    classes = np.full(len(xyz), 2, np.uint8)
    np.testing.assert_array_equal(classify_water(xyz, classes, look_for=False), classes)
    images = CloudSampling(lambda: xyz, single_returns=True)
    assert images.is_closed_surface()
    np.testing.assert_array_equal(classify_water(xyz, classes, sampling=images), classes)
    assert (classify_water(xyz, classes) == 9).any()


def test_ground_is_needed():
    with pytest.raises(ValueError, match=r"No ground points \(class 2\)"):
        classify_water(np.zeros((5, 3)), np.ones(5, np.uint8))


def test_order_and_position_change_nothing():
    xyz, _ = canal()
    xyz = (xyz * 1024).round() / 1024
    order = np.random.default_rng(3).permutation(len(xyz))
    made = on_ground(xyz)
    np.testing.assert_array_equal(on_ground(xyz[order]), made[order])
    assert (on_ground(xyz + FAR) == made).mean() > 0.999


@pytest.mark.parametrize("density", [3.0, pytest.param(8.0, marks=pytest.mark.slow)])
def test_the_river_of_a_town_is_water(density):
    found, true = river_town(density)
    assert f_score(found == 9, true == 9) > 88


def test_a_road_in_a_cutting_is_no_water():
    xyz, true, *_ = simulate_bridges(kind="cutting", density=4.0, seed=3)
    assert not (true == 9).any()
    assert not on_ground(xyz).any()
