"""The two mean entropies that parts of a cloud take of the whole."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.classify_buildings import classify_buildings
from lidar_buildings.algorithms.buildings.classify_buildings_2019 import classify_buildings_2019
from lidar_buildings.algorithms.buildings.entropy_split import MEAN_ENTROPIES, Split, held_means, split_of_whole
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import crown, roof


@pytest.fixture
def sampling(rng):
    return CloudSampling.of(rng.uniform(0, 20, (1000, 3)))


def test_a_whole_measures_and_keeps_its_split(sampling):
    assert split_of_whole(sampling, lambda: Split(0.5, 0.9)) == Split(0.5, 0.9)
    assert sampling.found == dict(zip(MEAN_ENTROPIES, (0.5, 0.9)))
    assert not sampling.of_whole


def test_one_mean_is_not_kept_for_the_whole(sampling):
    assert not split_of_whole(sampling, lambda: Split(0.7, 0.7)).separates
    assert not sampling.found


@pytest.mark.parametrize("count", [5, 3000])
def test_rough_clusters_alone_are_not_split_in_two_however_many_there_are(count):
    """Among 3,000 clusters of a forest, the mean of the lower half became the buildings': 0.84 instead of 0.65."""
    split = held_means(np.linspace(0.75, 1.05, count), 0.65, 0.98, Monitor())
    assert split.building == pytest.approx(0.65, abs=0.03)
    assert split.other == pytest.approx(0.97, abs=0.03)


@pytest.mark.parametrize("classify", [classify_buildings, classify_buildings_2019])
def test_a_part_is_decided_by_the_split_of_the_whole(rng, classify):
    """Three roofs and three crowns; the confidence of each follows from the two means that are given."""
    parts = [roof(rng, 20 * i, 0, 8, 8, 5.0) for i in range(3)] + [crown(rng, 20 * i + 4, 30) for i in range(3)]
    xyz, number = np.concatenate(parts), np.repeat(np.arange(1, 7), [len(part) for part in parts])
    given = CloudSampling.of(xyz)
    given.of_whole = dict(zip(MEAN_ENTROPIES, (0.2, 0.4)))
    monitor = Monitor()
    classify(xyz, np.ones(len(xyz), np.uint8), number.astype(np.int32), sampling=given, monitor=monitor)
    assert [monitor.values[name] for name in MEAN_ENTROPIES] == [0.2, 0.4]
    assert not given.found
    own = CloudSampling.of(xyz)
    classify(xyz, np.ones(len(xyz), np.uint8), number.astype(np.int32), sampling=own, monitor=monitor)
    assert [monitor.values[name] for name in MEAN_ENTROPIES] == [own.found[name] for name in MEAN_ENTROPIES]
    assert own.found["building_entropy"] > 0.4
