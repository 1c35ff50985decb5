"""Classes that are kept: what is remembered, and whole chains on a cloud that comes classified."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.landcover.keep_classes import keep_classes
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.simulation.simulate_town import simulate_town
from lidar_buildings.algorithms.stages import STAGES

CLASSES = np.array([0, 1, 2, 5, 6, 7, 9, 17], np.uint8)


@pytest.mark.parametrize(
    ("keep", "expected"),
    [
        ("ground", [0, 0, 2, 0, 0, 0, 0, 0]),
        ("ground and buildings", [0, 0, 2, 0, 6, 0, 0, 0]),
        ("all", [0, 0, 2, 5, 6, 7, 9, 17]),
    ],
)
def test_chosen_classes_are_remembered(keep, expected):
    assert keep_classes(np.zeros((8, 3)), CLASSES, keep=keep).tolist() == expected


def test_nothing_is_remembered_by_default_and_what_an_earlier_run_did_is_forgotten():
    cloud = create_cloud({"xyz": np.zeros((8, 3)), "classification": CLASSES})
    assert not run_stage(STAGES["keep_classes"], cloud).cloud.has("earlier_class")
    run_stage(STAGES["keep_classes"], cloud, keep="all")
    assert not run_stage(STAGES["keep_classes"], cloud).cloud.get("earlier_class").any()


@pytest.fixture(scope="module")
def town():
    """A town whose true classes are changed by hand: a lawn, half of the houses, and trees that are low plants."""
    xyz, true, number, count, _, _, _, _, object_id = simulate_town(size=90.0, density=2.5, seed=5)
    given = true.copy()
    x, y = (xyz[:, :2] - xyz[:, :2].min(axis=0)).T
    given[(true == 2) & (x < 20) & (y < 20)] = 1
    houses = np.unique(object_id[true == 6])
    given[(true == 6) & np.isin(object_id, houses[::2])] = 1
    given[(true == 5) & (y > 45)] = 3
    return {"xyz": xyz, "return_number": number, "number_of_returns": count}, true, given


@pytest.fixture(scope="module")
def detected(town):
    arrays, _, given = town

    def run(keep):
        cloud = create_cloud({**arrays, "classification": given})
        made = run_pipeline(PIPELINES["detect_buildings"], cloud, existing_keep=keep)
        return cloud, made.layers["footprints"]

    return {keep: run(keep) for keep in ("none", "ground", "ground and buildings", "all")}


def test_without_keeping_all_is_found_anew(town, detected):
    _, true, given = town
    made = detected["none"][0].get("classification")
    assert (made[(true == 6) & (given == 1)] == 6).mean() > 0.9
    assert (made[(true == 5) & (given == 3)] == 5).any()


@pytest.mark.parametrize(
    ("keep", "kept"), [("ground", (2,)), ("ground and buildings", (2, 6)), ("all", (2, 3, 4, 5, 6, 9, 17))]
)
def test_kept_classes_stay_as_they_are(town, detected, keep, kept):
    given, made = town[2], detected[keep][0].get("classification")
    for one in set(kept) & {2, 6}:
        np.testing.assert_array_equal(made == one, given == one)
    held = np.isin(given, kept)
    np.testing.assert_array_equal(made[held], given[held])


def test_with_kept_ground_buildings_are_found(town, detected):
    _, true, given = town
    made = detected["ground"][0].get("classification")
    assert (made[(true == 6) & (given == 1)] == 6).mean() > 0.9


def test_kept_buildings_have_footprints_and_no_others(town, detected):
    given, layer = town[2], detected["ground and buildings"][1]
    xyz = town[0]["xyz"]
    assert 0 < len(layer.geometries) < len(detected["ground"][1].geometries)
    cloud = detected["ground and buildings"][0]
    numbers = cloud.get("cluster_id")
    assert (numbers[given == 6] > 0).all()
    assert not numbers[given != 6].any()
    assert len(np.unique(numbers[given == 6])) >= len(layer.geometries)
    assert len(xyz) == len(cloud)


def test_with_everything_kept_only_open_points_get_a_class(town, detected):
    given, made = town[2], detected["all"][0].get("classification")
    np.testing.assert_array_equal(made[given > 1], given[given > 1])
    assert np.isin(made[given <= 1], (3, 4, 5)).any()


def test_the_switch_of_the_ground_step_that_saved_models_hold_still_works(town):
    arrays, _, given = town
    cloud = create_cloud({**arrays, "classification": given})
    run_pipeline(PIPELINES["detect_buildings"], cloud, ground_keep_ground=True)
    assert (cloud.get("classification")[given == 2] == 2).mean() > 0.99
