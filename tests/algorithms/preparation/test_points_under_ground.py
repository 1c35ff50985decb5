"""Isolated points of simulated towns are found under the ground and in the air, and thin objects such as masts stay."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import NOISE, PointClass
from lidar_buildings.algorithms.preparation.classify_noise_air import classify_noise_air
from lidar_buildings.algorithms.preparation.classify_noise_histogram import classify_noise_histogram
from lidar_buildings.algorithms.preparation.classify_noise_statistical import classify_noise_statistical
from lidar_buildings.algorithms.preparation.points_under_ground import under_ground
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.noisy import noisy_town

# Objects and classes of the town that must stay.
STAYS = ("mast", "lamp", "wire", "chimney")
TOWN = (PointClass.GROUND, PointClass.BUILDING, PointClass.HIGH_VEGETATION)


def plain(rng, density=8.0, side=80.0, slope=0.0):
    plan = rng.uniform(0, side, (int(density * side * side), 2))
    return np.column_stack([plan, slope * plan[:, 0] + rng.normal(0, 0.02, len(plan))])


def by_histogram_and_in_the_air(xyz, classification):
    return classify_noise_air(xyz, classify_noise_histogram(xyz, classification))


@pytest.mark.parametrize("classify", [by_histogram_and_in_the_air, classify_noise_statistical])
@pytest.mark.parametrize(
    "differs",
    [
        {"density": 2.0},
        {"density": 8.0, "slope": 25.0},
        pytest.param({"density": 8.0, "forest": 0.6}, marks=pytest.mark.slow),
        pytest.param({"density": 30.0}, marks=pytest.mark.slow),
    ],
)
def test_noise_of_a_town_is_found_and_the_town_stays(classify, differs):
    town = noisy_town(seed=21, **differs)
    made = classify(town.xyz, np.ones(len(town.xyz), np.uint8))
    found = np.isin(made, NOISE)
    assert (found & town.is_noise).sum() >= 0.9 * town.is_noise.sum()
    assert (found & town.is_noise).sum() >= 0.9 * found.sum()
    for kind, share in (("bird", 0.9), ("dust", 0.95), ("far", 1.0), ("multipath", 0.6)):
        assert found[town.kind == kind].mean() >= share, kind
    assert not found[np.isin(town.kind, STAYS)].any()
    of_town = (town.kind == "") & np.isin(town.classification, TOWN)
    assert found[of_town].sum() <= 5e-4 * of_town.sum()
    assert not found[of_town & (town.classification == PointClass.BUILDING)].any()


def test_without_isolated_points_it_is_the_published_method(rng):
    xyz = np.concatenate([plain(rng), rng.uniform([20, 20, -1.5], [60, 60, -1.4], (10, 3))])
    one = np.ones(len(xyz), np.uint8)
    assert (classify_noise_histogram(xyz, one, isolated=False) == 1).all()
    made = classify_noise_histogram(xyz, one)
    assert (made[-10:] == 7).all()
    assert (made[:-10] == 1).all()


@pytest.mark.parametrize("density", [2.0, 10.0, 40.0])
@pytest.mark.parametrize("slope", [0.0, 0.5])
def test_depth_under_open_ground(rng, density, slope):
    xyz = plain(rng, density, slope=slope)
    plan = np.stack(np.meshgrid([20.0, 40, 60], [20.0, 40, 60]), axis=-1).reshape(-1, 2)
    low = np.column_stack([plan, slope * plan[:, 0] - 0.8 - np.arange(9)])
    found = under_ground(np.concatenate([xyz, low]), density**-0.5, 0.02, Monitor())
    assert found[-9:].all()
    assert not found[:-9].any()


def test_pits_ditches_steps_and_ground_between_leaves_stay(rng):
    xyz = plain(rng, 8.0)
    x, y = xyz[:, 0], xyz[:, 1]
    xyz[(np.abs(x - 20) < 1.5) & (np.abs(y - 20) < 1.5), 2] -= 3
    xyz[np.abs(y - 40 - 0.1 * x) < 0.4, 2] -= 1
    xyz[x > 70, 2] -= 4
    in_wood = (x > 30) & (x < 60) & (y < 35) & (rng.random(len(x)) < 0.85)
    xyz[in_wood, 2] += rng.uniform(4, 14, in_wood.sum())
    assert under_ground(xyz, 8.0**-0.5, 0.02, Monitor()).mean() <= 2e-4


def test_points_that_are_ground_for_each_other_stay(rng):
    """Four points of a hollow, seen here and there between leaves: 0.8 m apart and 0.2 m higher and lower."""
    hollow = np.array([[40.0, 40, -0.8], [40.8, 40, -0.6], [40.8, 40.8, -0.8], [40, 40.8, -0.6]])
    alone = np.array([[60.0, 60, -0.8]])
    found = under_ground(np.concatenate([plain(rng, 16.0), hollow, alone]), 0.25, 0.02, Monitor())
    assert not found[-5:-1].any()
    assert found[-1]


def test_points_that_share_a_level_are_a_floor_seen_through_glass(rng):
    """Nine returns of a shaft's floor, 3 m below a deck and level to 5 cm over 5 m, made the deck next to it ground."""
    deck = plain(rng, 10.0, 40.0)
    along = np.linspace(0, 5, 9)
    floor = np.column_stack([18 + along, 20 + 0.3 * rng.random(9), -3 + rng.uniform(-0.025, 0.025, 9)])
    spread = floor - [0, 0, 1] * np.linspace(0, 4, 9)[:, None]
    assert not under_ground(np.concatenate([deck, floor]), 10.0**-0.5, 0.02, Monitor()).any()
    assert under_ground(np.concatenate([deck, spread]), 10.0**-0.5, 0.02, Monitor())[-9:].all()


@pytest.mark.parametrize("density", [8.0, 60.0])
def test_points_at_all_depths_under_a_surface_that_reflects_are_no_floor(rng, density):
    """Sixty points over 12 m pull the ground of their cells down, and some of any four are at one height by chance."""
    xyz = plain(rng, density, 60.0)
    low = np.column_stack([rng.uniform(24, 36, (60, 2)), rng.uniform(-6, -0.8, 60)])
    found = under_ground(np.concatenate([xyz, low]), density**-0.5, 0.02, Monitor())
    assert found[-60:].mean() > 0.75
    assert not found[:-60].any()


def test_a_group_at_nearly_one_height_is_no_floor(rng):
    """Points of a floor differ by noise (2 cm), these by 10 cm each."""
    group = np.column_stack([rng.uniform(30, 32, (6, 2)), -2 - 0.1 * np.arange(6)])
    found = under_ground(np.concatenate([plain(rng, 16.0, 60.0), group]), 0.25, 0.02, Monitor())
    assert found[-6:].all()
    assert not found[:-6].any()


def test_another_run_on_the_result_finds_hardly_anything():
    """Points found before are counted as companions of others no more."""
    first = again = 0
    for seed in (21, 22):
        town = noisy_town(seed=seed, density=2.0)
        xyz = town.xyz[town.kind != "far"]
        found = under_ground(xyz, 2.0**-0.5, 0.02, Monitor())
        first += found.sum()
        again += under_ground(xyz[~found], 2.0**-0.5, 0.02, Monitor()).sum()
    assert first > 200
    assert again <= 0.02 * first


@pytest.mark.parametrize("height_step", [0.0, 0.3])
def test_order_changes_nothing_where_heights_are_equal(rng, height_step):
    town = noisy_town(density=4.0, size=80.0, seed=5)
    xyz = town.xyz.copy()
    if height_step:
        xyz[:, 2] = height_step * np.round(xyz[:, 2] / height_step)
    spacing = 4.0**-0.5
    found = under_ground(xyz, spacing, 0.02, Monitor())
    assert found.any()
    for _ in range(3):
        order = rng.permutation(len(xyz))
        assert (under_ground(xyz[order], spacing, 0.02, Monitor()) == found[order]).all()


def test_position_and_order_change_nothing(rng):
    town = noisy_town(density=4.0, size=80.0, seed=5)
    made = classify_noise_histogram(town.xyz, np.ones(len(town.xyz), np.uint8))
    order = rng.permutation(len(made))
    assert (classify_noise_histogram(town.xyz[order], np.ones(len(made), np.uint8)) == made[order]).all()
    far = classify_noise_histogram(town.xyz + [6e5, 5e6, 0], np.ones(len(made), np.uint8))
    assert (far != made).sum() <= 0.01 * (made != 1).sum()
