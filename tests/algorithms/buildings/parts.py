"""Clusters of a scene, and the reasons that a stage gives for each of them."""

import numpy as np

from lidar_buildings.algorithms.cloud.reasons import Reason


def clusters(*parts):
    return np.concatenate(parts), np.repeat(np.arange(1, len(parts) + 1), [len(part) for part in parts])


def ones(values):
    return np.ones(len(values), np.uint8)


def reasons_of(classify, xyz, cluster_id, *more, **tunables):
    """Return the reason and the confidence of each cluster, and whether it is a building, by its number from 1."""
    found, _, _, confidence, reason, _, report = classify(xyz, ones(xyz), cluster_id, *more, **tunables)
    firsts = [np.flatnonzero(cluster_id == number)[0] for number in range(1, cluster_id.max() + 1)]
    for number, first in enumerate(firsts, start=1):
        assert len(np.unique(reason[cluster_id == number])) == 1
        assert len(np.unique(confidence[cluster_id == number])) == 1
        assert Reason(reason[first]).is_building == (found[first] == 6)
    assert (reason[cluster_id == 0] == Reason.NOT_LOOKED_AT).all()
    return [Reason(number) for number in reason[firsts]], confidence[firsts], report
