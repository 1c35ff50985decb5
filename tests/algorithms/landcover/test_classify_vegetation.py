"""Vegetation: its heights, objects that are no plants, and classes that never change."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.landcover.classify_vegetation import classify_vegetation
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.simulation.simulate_town import simulate_town

GROUND, BUSH, CAR, WALL, POLE, TREE = range(6)


def garden(density=25.0, seed=4):
    """A lawn of 40 m by 30 m with a bush, a car, a garden wall, a lamp post and a tree, and what each point is of."""
    rng = np.random.default_rng(seed)

    def box(kind, low, high, per_area):
        low, high = np.array(low, float), np.array(high, float)
        size = high - low
        count = max(12, round(per_area * size[0] * size[1]))
        return np.column_stack([rng.uniform(low, high, (count, 3)), np.full(count, kind)])

    lawn = box(GROUND, (0, 0, 0), (40, 30, 0), density)
    bush = box(BUSH, (5, 5, 0.2), (8, 8, 1.6), 2 * density)
    roof = box(CAR, (15, 5, 1.4), (18, 6.7, 1.4), density)
    bonnet = box(CAR, (18, 5, 0.9), (19.5, 6.7, 0.9), density)
    wall = np.column_stack([rng.uniform((5, 20, 0.2), (15, 20, 1.8), (400, 3)), np.full(400, WALL)])
    pole = np.column_stack([rng.uniform((30, 5, 0.2), (30.15, 5.15, 6), (60, 3)), np.full(60, POLE)])
    tree = box(TREE, (28, 18, 1.0), (34, 24, 9.0), 4 * density)
    points = np.concatenate([lawn, bush, roof, bonnet, wall, pole, tree])
    kind = points[:, 3].astype(int)
    xyz = points[:, :3] + rng.normal(0, 0.015, (len(points), 3))
    returns = np.where(np.isin(kind, (BUSH, TREE)), 1 + (rng.random(len(kind)) < 0.7), 1).astype(np.uint8)
    return xyz, kind, returns


def classified(**tunables):
    xyz, kind, returns = garden()
    classes = np.where(kind == GROUND, 2, 0).astype(np.uint8)
    height = np.where(kind == GROUND, 0, xyz[:, 2]).astype(np.float32)
    return classify_vegetation(xyz, classes, height, returns, **tunables), kind, height


def test_plants_are_vegetation_by_their_height():
    made, kind, height = classified()
    for low, high, number in ((0.3, 2.0, 3), (2.0, 5.0, 4), (5.0, 99.0, 5)):
        inside = np.isin(kind, (BUSH, TREE)) & (height >= low) & (height < high)
        assert inside.sum() > 50
        assert (made[inside] == number).mean() > 0.99
    assert (made[kind == GROUND] == 2).all()


def test_a_high_surface_that_goes_on_into_the_ground_is_no_plant_where_no_pulse_passes_it():
    """A footbridge of 6 m over a river was high vegetation for two thirds of its length."""
    rng = np.random.default_rng(2)
    deck = np.column_stack([rng.uniform((0, 0), (40, 4), (1500, 2)), rng.normal(6, 0.02, 1500)])
    crown = np.column_stack([rng.uniform((60, 0), (70, 10), (1500, 2)), rng.normal(6, 0.02, 1500)])
    xyz, height = np.concatenate([deck, crown]), np.full(3000, 6.0, np.float32)
    returns = np.where(np.arange(3000) < 1500, 1, 1 + (rng.random(3000) < 0.5))
    reason = np.full(3000, Reason.INTO_GROUND, np.uint8)
    made = classify_vegetation(xyz, np.ones(3000, np.uint8), height, returns, reason)
    assert (made[:1500] == 1).mean() > 0.99
    assert (made[1500:] == 5).mean() > 0.99
    assert (classify_vegetation(xyz, np.ones(3000, np.uint8), height, returns) == 5).all()


@pytest.mark.parametrize("solid", [CAR, WALL, POLE])
def test_what_is_solid_is_no_plant(solid):
    made, kind, _ = classified()
    assert (made[kind == solid] == 1).mean() > 0.9


def test_a_smooth_object_that_beams_pass_is_a_plant():
    xyz, kind, returns = garden()
    returns[kind == CAR] = 2
    classes = np.where(kind == GROUND, 2, 0).astype(np.uint8)
    made = classify_vegetation(xyz, classes, xyz[:, 2].astype(np.float32), returns)
    assert np.isin(made[kind == CAR], (3, 4, 5)).all()


def test_a_high_smooth_object_is_not_taken_for_a_car():
    xyz, kind, returns = garden()
    xyz[kind == CAR, 2] += 4.0
    classes = np.where(kind == GROUND, 2, 0).astype(np.uint8)
    made = classify_vegetation(xyz, classes, xyz[:, 2].astype(np.float32), returns)
    assert (made[kind == CAR] >= 3).all()


def test_limits_of_heights_are_those_chosen():
    made, kind, height = classified(heights="0.5 m and 1.5 m (IGN)")
    plant = np.isin(kind, (BUSH, TREE))
    np.testing.assert_array_equal(made[plant & (height > 0.1)] == 5, height[plant & (height > 0.1)] >= 1.5)
    made, _, _ = classified(medium_height=3.0, high_height=3.0)
    assert not (made == 4).any()
    made, _, _ = classified(min_height=1.0)
    assert (made[plant & (height < 1.0)] == 1).all()
    # Bounds are inclusive: the lowest leaf of the trees is of them.
    lowest = height[kind == TREE].min()
    made, _, _ = classified(min_height=float(lowest))
    assert (made[(kind == TREE) & (height == lowest)] >= 3).all()


def test_high_vegetation_is_not_lower_than_medium():
    with pytest.raises(ValueError, match=r"High vegetation from \(high_height\) must be at least .* got 1 m; raise it"):
        classified(high_height=1.0)


def test_other_classes_never_change():
    xyz, kind, returns = garden()
    for kept in (2, 6, 7, 9, 14, 17, 18, 26, 64):
        classes = np.full(len(xyz), kept, np.uint8)
        made = classify_vegetation(xyz, classes, xyz[:, 2].astype(np.float32), returns)
        np.testing.assert_array_equal(made, classes)


def test_nothing_changes_where_no_vegetation_is_looked_for():
    xyz, kind, returns = garden()
    classes = np.where(kind == TREE, 5, 0).astype(np.uint8)
    made = classify_vegetation(xyz, classes, xyz[:, 2].astype(np.float32), returns, look_for=False)
    np.testing.assert_array_equal(made, classes)


def test_earlier_vegetation_is_classified_anew():
    xyz, kind, returns = garden()
    classes = np.where(kind == GROUND, 2, 5).astype(np.uint8)
    made = classify_vegetation(xyz, classes, xyz[:, 2].astype(np.float32), returns)
    assert (made[kind == CAR] == 1).mean() > 0.9
    assert set(made[kind == BUSH]) <= {1, 3}


@pytest.mark.parametrize("density", [3.0, pytest.param(12.0, marks=pytest.mark.slow)])
def test_a_town_gets_its_trees_and_keeps_its_ground_and_buildings(density):
    """Of the merged classes: F of vegetation, and not a point of ground or building fewer than without the step."""
    xyz, true, number, count, *_ = simulate_town(size=100.0, density=density, river=False, seed=3)
    given = {"xyz": xyz, "return_number": number, "number_of_returns": count}
    made, plain = create_cloud(given), create_cloud(given)
    run_pipeline(PIPELINES["detect_buildings"], made)
    run_pipeline(PIPELINES["detect_buildings"], plain, vegetation_look_for=False)
    made, plain = made.get("classification"), plain.get("classification")
    for kept in (PointClass.GROUND, PointClass.BUILDING):
        np.testing.assert_array_equal(made == kept, plain == kept)
    is_plant, found = np.isin(true, (3, 4, 5)), np.isin(made, (3, 4, 5))
    assert 2 * (is_plant & found).sum() / (is_plant.sum() + found.sum()) > 0.96
    assert not np.isin(plain, (3, 4, 5)).any()
