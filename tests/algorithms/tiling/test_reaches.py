"""Steps reach no farther than they declare: in a part of a real cloud they give what they give in all of it."""

from copy import copy

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.algorithms.geometry.grid import plan_box
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_stage, sampling_of
from lidar_buildings.algorithms.tiling.tiled_steps import in_blocks
from lidar_buildings.tests.real.clouds import DELFT, path_of

# Half the side of the square whose points are compared, and of the part of Delft that is the whole, m.
CORE, WHOLE = 20.0, 75.0

# Share of points that may differ: fewer than ten of those that are compared.
MOST = 0.001

# Dimensions with one value for a whole building or for its surface: a window that holds part of it has another.
OF_BUILDINGS = {"cluster_entropy", "confidence", "weakest_evidence", "building_probability"}

# Dimensions that number what points belong to: each window has its own numbers.
NUMBERED = {"segment_id", "cluster_id"}


@pytest.fixture(scope="module")
def cloud():
    """Houses of an old town, 150 m by 150 m with 4 points per m²."""
    whole = read_cloud(path_of(DELFT))
    plan = whole.get("xyz")[:, :2]
    rows = np.flatnonzero((np.abs(plan - np.median(plan, axis=0)) < WHOLE).all(axis=1))
    return whole.take(np.random.default_rng(1).permutation(rows)[: len(rows) // 4])


@pytest.fixture(scope="module")
def differing(cloud):
    """For each step of *Detect buildings* how many of the points of the core differ, by distance around the core."""
    found, sampling, current = {}, sampling_of(cloud), cloud.copy()
    for step, tunables in in_blocks(PIPELINES["detect_buildings"]).by_step({}):
        stage, before = step.stage, current.copy()
        given = sampling if stage.samples else None
        whole = run_stage(stage, current, sampling=given, **tunables).cloud
        of_part = copy(sampling)
        of_part.of_whole = {**sampling.found, **{name: learn(of) for name, (of, learn) in sampling.samples.items()}}
        reach = stage.reach_of(tunables)
        for around in {reach, 0.0} if reach else ():
            found[step.name, around == reach] = _differing(
                stage, before, whole, around, of_part if given else None, tunables
            )
        current = whole if stage.makes_cloud else current
    return found


def _differing(stage, cloud, whole, around, sampling, tunables):
    """Return the share of points of the core whose value is another one where a step sees only what is ``around``.

    Buildings of the core are seen whole, as blocks see them.
    """
    plan = cloud.get("xyz")[:, :2]
    is_core = (np.abs(plan - np.median(plan, axis=0)) < CORE).all(axis=1)
    seen = is_core
    if cloud.has("cluster_id") and around:
        cluster = cloud.get("cluster_id")
        seen = seen | np.isin(cluster, np.setdiff1d(cluster[is_core], [0]))
    box = plan_box(plan[seen]) + np.array([[-around], [around]])
    rows = np.flatnonzero(((plan >= box[0]) & (plan <= box[1])).all(axis=1))
    part = run_stage(stage, cloud.take(rows), sampling=sampling, **tunables).cloud
    core = is_core[rows]
    differs = np.zeros(core.sum(), bool)
    for name in set(stage.writes) - OF_BUILDINGS:
        values, expected = part.get(name)[core], whole.get(name)[rows][core]
        if name in NUMBERED:
            values, expected = values > 0, expected > 0
        differs |= ~np.isclose(values, expected, atol=1e-3, equal_nan=True)
    return differs.mean()


def test_what_lies_beyond_the_reach_of_a_step_changes_hardly_a_point(differing):
    beyond = {name: share for (name, is_reach), share in differing.items() if is_reach}
    assert len(beyond) == 11
    assert max(beyond.values()) < MOST, beyond


@pytest.mark.parametrize("name", ["height", "roofs", "buildings", "complete", "refine"])
def test_a_reach_that_is_too_short_would_be_noticed(differing, name):
    assert differing[name, False] > MOST
