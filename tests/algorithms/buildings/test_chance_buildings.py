"""Doubtful buildings of a scene without a sure one, few among crowns."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.chance_buildings import CHANCE, without_chance
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import Monitor

#: Points of each of two smooth spots of crowns.
SPOT = 20


def forest(confidence, crowns=2000):
    """Return what is found in a forest on 100 ground points: two buildings of these confidences amid crowns."""
    cluster_id = np.repeat([0, 1, 2, 0], [100, SPOT, SPOT, crowns]).astype(np.int32)
    classification = np.select([np.arange(len(cluster_id)) < 100, cluster_id > 0], [2, 6], 1).astype(np.uint8)
    known = np.select([cluster_id == 1, cluster_id == 2], confidence, np.nan).astype(np.float32)
    reason = np.where(cluster_id > 0, Reason.SOLID_PLANE, Reason.ROUGH).astype(np.uint8)
    return (classification, cluster_id, known, reason, None), np.where(classification == 2, 0.0, 9.0)


def sampling(**of_whole):
    made = CloudSampling.of(np.zeros((1, 3)))
    made.of_whole.update(of_whole)
    return made


def test_no_doubtful_building_of_a_forest_is_left():
    (found, height), monitor = forest((0.6, 0.74)), Monitor()
    classes, number, confidence, reason, _ = without_chance(found, height, 0.05, sampling(), monitor)
    assert not (classes == 6).any()
    assert not number.any()
    assert (reason[100 : 100 + 2 * SPOT] == Reason.BY_CHANCE).all()
    assert (confidence[100 : 100 + 2 * SPOT] == 0.5).all()
    assert "2 doubtful ones" in monitor.infos[-1]
    # Nothing else changes.
    assert (classes[found[0] != 6] == found[0][found[0] != 6]).all()
    assert (reason[found[1] == 0] == Reason.ROUGH).all()


@pytest.mark.parametrize(
    ("confidence", "crowns"),
    [((0.6, 0.76), 2000), ((0.6, 0.6), 700)],
    ids=["a sure one keeps all", "a shed amid a few trees"],
)
def test_where_one_is_sure_or_crowns_are_few_all_stay(confidence, crowns):
    found, height = forest(confidence, crowns)
    assert without_chance(found, height, 0.05, sampling(), Monitor()) is found


def test_ground_and_low_points_do_not_count_as_crowns():
    found, height = forest((0.6, 0.6))
    assert without_chance(found, np.where(found[1] > 0, height, 1.4), 0.05, sampling(), Monitor()) is found


def test_a_share_of_nothing_keeps_all():
    found, height = forest((0.6, 0.6))
    assert without_chance(found, height, 0.0, sampling(), Monitor()) is found


def test_a_part_of_a_survey_does_as_the_whole_does():
    found, height = forest((0.6, 0.9))
    assert without_chance(found, height, 0.05, sampling(**{CHANCE: (0.0,)}), Monitor()) is found
    _, number, *_ = without_chance(found, height, 0.05, sampling(**{CHANCE: (1.0,)}), Monitor())
    assert set(number[found[1] == 1]) == {0}
    assert set(number[found[1] == 2]) == {1}


def test_a_survey_decides_on_all_of_its_parts_together():
    """A sure building in one part keeps the doubtful ones of the other."""
    tables, learn = [], None
    for confidence in ((0.6, 0.6), (0.9, 0.6)):
        part = sampling()
        without_chance(*forest(confidence), 0.05, part, Monitor())
        table, learn = part.samples[CHANCE]
        tables.append(table)
    assert learn(np.concatenate(tables)) == (0.0,)
    assert learn(tables[0]) == (1.0,)
