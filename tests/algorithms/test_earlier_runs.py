"""Dimensions of an earlier run are never read as if they were of this one."""

from functools import cache

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.dimensions import DIMENSIONS
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.stages import STAGES

# Tests of the provider add others to them.
NAMES = tuple(PIPELINES)
TOWN = "simulate_town", {"size": 80.0, "density": 3.0, "forest": 0.0, "trees": 0.0}
VILLAGE = "simulate_village", {"size": 60.0, "density": 30.0, "trees": 0.0, "seed": 3}
SCENES = {
    "map_footprints": VILLAGE,
    "map_footprints_2022": VILLAGE,
    "model_facades": ("simulate_street", {"length": 20.0, "line_rate": 20.0, "angular_step": 0.5, "clutter": False}),
    "model_industry": ("simulate_plant", {"pipes": 1, "tanks": 0, "spheres": 1, "density": 1000.0, "clutter": False}),
    "interpret_structure": ("simulate_flight", {"duration": 6.0, "line_rate": 15.0, "trees": 1}),
}
# One composite of each kind of scene; all are read in test_no_step_reads_what_only_a_later_one_writes.
QUICK = ("detect_buildings", "model_buildings", "model_terrain", "model_facades", "interpret_structure")
# Read two clouds, or leave out points.
CHANGES_ITS_INPUT = {name for name, one in PIPELINES.items() if name.startswith("map_footprints") or one.merges}


def marked(names):
    """The composites, those that take long as slow."""
    return [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in names]


@cache
def scene(name):
    """The simulated cloud for a composite, and what it makes of it."""
    simulation, tunables = SCENES.get(name, TOWN)
    cloud = run_stage(STAGES[simulation], **tunables).cloud
    return cloud, modeled(name, cloud)


def modeled(name, cloud, monitor=None):
    merges = PIPELINES[name].merges
    given = [cloud.copy(), cloud.copy()] if merges else cloud.copy()
    return run_pipeline(
        PIPELINES[name], given, monitor, reference=street() if PIPELINES[name].needs_reference else None
    )


@cache
def street():
    """The second cloud of a composite that reads one."""
    simulation, tunables = SCENES["model_facades"]
    return run_stage(STAGES[simulation], **tunables).cloud


def written(name):
    """The dimensions besides LAS fields that steps of a composite write."""
    names = dict.fromkeys(name for step in PIPELINES[name].steps for name in step.stage.writes)
    return [one for one in names if not DIMENSIONS[one].standard]


def assert_same(one, other, name):
    assert {of: len(features) for of, features in one.layers.items()} == {
        of: len(features) for of, features in other.layers.items()
    }
    for of, features in one.layers.items():
        for mine, yours in zip(features.geometries, other.layers[of].geometries):
            np.testing.assert_equal(mine, yours)
        for column, values in features.columns.items():
            np.testing.assert_equal(np.asarray(values), np.asarray(other.layers[of].columns[column]))
    for of, raster in one.rasters.items():
        np.testing.assert_equal(raster.values, other.rasters[of].values)
    for dimension in written(name):
        if one.cloud.has(dimension):
            np.testing.assert_equal(one.cloud.get(dimension), other.cloud.get(dimension))


def aged(cloud, names, rng):
    """Return a cloud whose dimensions an earlier run, of anything, has left."""
    old = cloud.copy()
    for name in names:
        dimension = DIMENSIONS[name]
        shape = (len(cloud), len(dimension.disk)) if len(dimension.disk) > 1 else len(cloud)
        values = rng.integers(1, 4, shape)
        old.set(name, values.astype(dimension.dtype))
    return old


@pytest.mark.parametrize("name", marked(NAMES))
def test_a_composite_finds_the_same_whatever_an_earlier_run_has_left(name, rng):
    """Cylinders were looked for only among points without the Shape of an earlier run: 1 axis instead of 66."""
    cloud, first = scene(name)
    monitor = Monitor()
    assert_same(first, modeled(name, aged(cloud, written(name), rng), monitor), name)


@pytest.mark.parametrize("name", marked(one for one in NAMES if one not in CHANGES_ITS_INPUT))
def test_a_composite_finds_the_same_on_its_own_result(name):
    _, first = scene(name)
    assert_same(first, modeled(name, first.cloud), name)


@pytest.mark.parametrize("name", marked(NAMES))
def test_the_scenes_have_something_to_find(name):
    found = scene(name)[1].layers
    assert not found or any(map(len, found.values()))


def test_the_log_says_once_what_was_cleared():
    monitor = Monitor()
    modeled("model_industry", scene("model_industry")[1].cloud, monitor)
    cleared = [one for one in monitor.infos if one.startswith("Cleared")]
    assert cleared == ["Cleared Shape, as earlier runs left it: SegmentID is numbered anew."]
    monitor = Monitor()
    modeled("detect_buildings", scene("detect_buildings")[0], monitor)
    assert not [one for one in monitor.infos if one.startswith("Cleared")]


def test_numbering_anew_clears_what_described_the_old_numbers():
    xyz = np.arange(30.0).reshape(10, 3)
    cloud = create_cloud({"xyz": xyz, "segment_id": np.ones(10), "shape": np.full(10, 2), "wall_of": np.full(10, 3)})
    run_stage(STAGES["segment_voxels"], cloud, voxel_size=1.0)
    assert not cloud.get("shape").any()
    assert (cloud.get("wall_of") == 3).all(), "it describes clusters"


@pytest.mark.parametrize("name", PIPELINES)
def test_no_step_reads_what_only_a_later_one_writes(name):
    """A dimension that is read before a step of the composite has written or cleared it is of an earlier run."""
    # "Keep classes" reads what it forgets; "Restore classes" numbers kept buildings anew where any were numbered.
    known, stale = (
        {"earlier_class", "cluster_id"} if "existing" in [one.name for one in PIPELINES[name].steps] else set(),
        [],
    )
    for step in PIPELINES[name].steps:
        stage = step.stage
        reads = {one for one in (*stage.reads, *stage.optional) if one in written(name)}
        stale += [(step.name, one) for one in sorted(reads - known)]
        known |= set(stage.writes)
        known |= {one.name for one in DIMENSIONS.values() if one.of in stage.writes}
    assert stale == []
