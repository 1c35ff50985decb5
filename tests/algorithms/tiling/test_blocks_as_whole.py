"""Composites whose steps reach far give the same result in blocks as on the whole cloud, point by point."""

from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.pipeline import Pipeline, Step
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import stage
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling import survey_sampling
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.tiled_steps import in_blocks, of_survey, preparing
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.builders import crown, roof
from lidar_buildings.tests.monitors import Listening

CORNER = np.array([600_010.0, 5_000_010.0, 3.0])
OPTIONS = TilesOptions(Workers(processes=1), 40.0, compressed=False)
SIZE = 90.0


@pytest.fixture(scope="module")
def cloud():
    """A slope with a step, two houses and a crown on 90 m by 90 m; edges of blocks of 40 m go through both houses."""
    rng = np.random.default_rng(8)
    plan = rng.uniform(0, SIZE, (int(2 * SIZE**2), 2))
    under = ((plan > [24, 20]) & (plan < [40, 35])).all(axis=1) | ((plan > [60, 58]) & (plan < [80, 74])).all(axis=1)
    ground = np.column_stack([plan, 0.05 * plan[:, 0] + 3.0 * (plan[:, 1] > 45) + rng.normal(0, 0.02, len(plan))])
    houses = [roof(rng, 24, 20, 16, 15, 9.0, density=2.0), roof(rng, 60, 58, 20, 16, 14.0, density=2.0)]
    xyz = np.concatenate([ground[~under], *houses, crown(rng, 15, 70)])
    xyz = np.round(xyz[rng.permutation(len(xyz))] + CORNER, 3)
    return create_cloud({"xyz": xyz, "gps_time": np.arange(len(xyz)) * 1e-5}, "EPSG:28992")


def tiles_of(cloud, folder):
    """Write three tiles that are no rectangles; return their paths."""
    x, y = cloud.get("xyz")[:, :2].T - cloud.get("xyz")[:, :2].min(axis=0)[:, None]
    parts = (x + y < 70, (x + y >= 70) & (y > 50), (x + y >= 70) & (y <= 50))
    paths = [folder / f"{number}.las" for number in range(len(parts))]
    for path, part in zip(paths, parts):
        write_cloud(cloud.take(np.flatnonzero(part)), path)
    return paths


def in_order(clouds, *names):
    """Return values of all points of clouds by their times; coordinates from the zero of the map."""
    clouds = list(clouds)
    order = np.argsort(np.concatenate([one.get("gps_time") for one in clouds]), kind="stable")
    return [
        np.concatenate([one.get(name) + (one.origin if name == "xyz" else 0) for one in clouds])[order]
        for name in names
    ]


@pytest.mark.parametrize(
    ("name", "tunables", "dimensions"),
    [
        (
            "interpret_structure",
            {"voxels_voxel_size": 0.5, "features_n_neighbors": 20},
            ("xyz", "voxel_count", "dimensionality", "linearity"),
        ),
        ("model_terrain", {"ground_max_object_area": 1_000.0, "ground_max_width": 10.0}, ("xyz", "classification")),
    ],
)
def test_blocks_give_what_the_whole_cloud_gives(cloud, tmp_path, name, tunables, dimensions):
    expected = run_pipeline(of_survey(PIPELINES[name]), cloud.copy(), **tunables).cloud
    (tmp_path / "tiles").mkdir()
    monitor = Listening()
    made = run_in_tiles(
        PIPELINES[name],
        tiles_of(cloud, tmp_path / "tiles"),
        tmp_path / "out",
        monitor,
        OPTIONS,
        **tunables,
    )
    assert made.blocks == 9
    assert not made.failures
    tiles = [read_cloud(path) for path in made.tiles]
    names = ("gps_time", *dimensions)
    for dimension, found, whole in zip(names, in_order(tiles, *names), in_order([expected], *names)):
        same = np.isclose(found, whole, rtol=0, atol=2e-3 if dimension == "xyz" else 1e-6)
        # Centers of two points lie between two millimeters, and either is written: rarely another point is the 20th
        # nearest then.
        assert same.mean() >= (0.9995 if dimension in ("dimensionality", "linearity") else 1.0), dimension


@stage("Toys", title="Cells", writes=("classification",), reach=5.0)
def classify_cells(xyz, *, sampling=None, monitor=None):
    """Write the parity of the cell that a point is in; none lies at an edge, where rounding would decide."""
    cell = np.floor(sampling.from_corner(xyz)[:, :2] / 7.00013)
    return (cell.sum(axis=1) % 2).astype(np.uint8)


def test_cells_of_a_part_of_a_survey_are_those_of_the_whole(cloud, tmp_path, monkeypatch):
    cells = Pipeline("cells", "Cells", "Tests", "", "", "", "", (Step("cells", "classify_cells"),))
    monkeypatch.setitem(STAGES, "classify_cells", classify_cells.stage)
    monkeypatch.setitem(PIPELINES, "cells", cells)
    expected = run_pipeline(cells, cloud.copy()).cloud
    (tmp_path / "tiles").mkdir()
    made = run_in_tiles(
        cells,
        tiles_of(cloud, tmp_path / "tiles"),
        tmp_path / "out",
        options=replace(OPTIONS, extent=np.array([[11.0, 24.0], [61.0, 83.0]]) + CORNER[:2]),
    )
    times, found = in_order([read_cloud(path) for path in made.tiles], "gps_time", "classification")
    whole_times, whole = in_order([expected], "gps_time", "classification")
    at = np.searchsorted(whole_times, times - 5e-6)
    assert 1_000 < len(at) < len(whole)
    np.testing.assert_array_equal(found, whole[at])


@stage("Toys", title="Middle", writes=("classification",), reach=5.0, of_whole=("middle",))
def classify_by_middle(xyz, *, sampling=None, monitor=None):
    """Write whether a point is higher than half of all points; refuse parts in the west."""
    if sampling.from_corner(xyz)[:, 0].max() < 30:
        raise ValueError("There is no middle in the west.")
    return (xyz[:, 2] > sampling.shared("middle", lambda: float(np.median(xyz[:, 2])))).astype(np.uint8)


@pytest.fixture
def middle(monkeypatch):
    """A composite of a step that prepares the points and one that takes a value of the whole."""
    steps = (Step("noise", "classify_noise_histogram"), Step("half", "classify_by_middle"))
    composite = Pipeline("middle", "Middle", "Tests", "", "", "", "", steps)
    monkeypatch.setitem(STAGES, "classify_by_middle", classify_by_middle.stage)
    monkeypatch.setitem(PIPELINES, "middle", composite)
    return composite


def in_blocks_of(pipeline, cloud, folder):
    """Return the classes of points by their times, of a survey in tiles."""
    (folder / "tiles").mkdir()
    made = run_in_tiles(pipeline, tiles_of(cloud, folder / "tiles"), folder / "out", options=OPTIONS)
    assert not made.failures
    return in_order(map(read_cloud, made.tiles), "classification")[0]


def test_cells_of_a_histogram_are_whole_in_blocks(tmp_path, monkeypatch):
    """Cells of 4,000 points are 45 m wide at 2 points/m². Five birds share a bin with one that is in another block."""
    random = np.random.default_rng(3)
    xyz = random.uniform(0, 1, (int(2 * SIZE**2), 3)) * [SIZE, SIZE, 0.9]
    birds = np.column_stack([[4, 6, 8, 10, 12, 37], np.full((6, 1), 20), np.full((6, 1), 30.5)])
    xyz = np.round(np.concatenate([xyz, birds]) + CORNER, 3)
    cloud = create_cloud({"xyz": xyz, "gps_time": np.arange(len(xyz)) * 1e-5}, "EPSG:28992")
    alone = Pipeline("alone", "Alone", "Tests", "", "", "", "", (Step("noise", "classify_noise_histogram_2019"),))
    monkeypatch.setitem(PIPELINES, "alone", alone)
    found = in_blocks_of(alone, cloud, tmp_path)
    np.testing.assert_array_equal(found[-6:], 0)
    np.testing.assert_array_equal(found, in_order([run_pipeline(alone, cloud.copy()).cloud], "classification")[0])


def test_blocks_take_what_a_step_measures_from_the_whole(cloud, tmp_path, middle):
    """Where half of the cloud is a slope, each block would have a value of its own."""
    whole = in_order([run_pipeline(middle, cloud.copy()).cloud], "classification")[0]
    np.testing.assert_array_equal(in_blocks_of(middle, cloud, tmp_path), whole)
    assert 0.4 < whole.mean() < 0.6


def test_of_a_large_survey_it_is_the_median_of_samples_but_of_those_that_a_step_refuses(
    cloud, tmp_path, middle, monkeypatch
):
    """Sixteen samples, of which the step refuses the four in the west."""
    monkeypatch.setattr(survey_sampling, "_SAMPLED_WHOLE", 10_000)
    given = []
    monkeypatch.setattr(survey_sampling, "_measured", keeping(given, survey_sampling._measured))
    found = in_blocks_of(middle, cloud, tmp_path)
    ((made, values),) = given
    assert len(made) == 12
    xyz, origin = in_order([cloud], "xyz")[0], cloud.origin
    expected = np.median([np.median(one.get("xyz")[:, 2]) for one in made])
    assert values == {"middle": pytest.approx(expected, abs=1e-9)}
    np.testing.assert_array_equal(found, xyz[:, 2] - origin[2] > values["middle"])


@stage("Toys", title="Mean", writes=("classification",), reach=5.0, of_whole=("mean",))
def classify_by_mean(xyz, *, sampling=None, monitor=None):
    """Write whether a point is higher than the mean of all, which is learned from a table of elevations."""
    (mean,) = sampling.learned("mean", lambda: xyz[:, 2:], lambda table: (float(table.mean()),))
    return (xyz[:, 2] > mean).astype(np.uint8)


def test_what_is_learned_on_a_large_survey_is_learned_on_all_samples_together(cloud, tmp_path, monkeypatch):
    """Samples of different size would have another mean of their means."""
    composite = Pipeline("mean", "Mean", "Tests", "", "", "", "", (Step("mean", "classify_by_mean"),))
    monkeypatch.setitem(STAGES, "classify_by_mean", classify_by_mean.stage)
    monkeypatch.setitem(PIPELINES, "mean", composite)
    monkeypatch.setattr(survey_sampling, "_SAMPLED_WHOLE", 10_000)
    given = []
    monkeypatch.setattr(survey_sampling, "_measured", keeping(given, survey_sampling._measured))
    found = in_blocks_of(composite, cloud, tmp_path)
    ((made, values),) = given
    assert len({len(one) for one in made}) > 1
    expected = np.concatenate([one.get("xyz")[:, 2] for one in made]).mean()
    assert values == {"mean": (pytest.approx(expected, abs=1e-9),)}
    xyz = in_order([cloud], "xyz")[0]
    np.testing.assert_array_equal(found, xyz[:, 2] - cloud.origin[2] > values["mean"][0])


def keeping(given, function):
    """Return a function whose results are kept."""

    def kept(*arguments):
        given.append(function(*arguments))
        return given[-1]

    return kept


@pytest.mark.parametrize("name", ["detect_buildings", "model_terrain"])
def test_steps_that_only_keep_classes_hide_none_that_prepares_the_points(name):
    """Blocks counted noise in how the survey was sampled, once a step that keeps classes came first."""
    steps = in_blocks(PIPELINES[name]).steps
    assert [step.name for step in preparing(in_blocks(PIPELINES[name]))] == [
        step.name for step in steps if step.stage.group == "Preparation"
    ]


def test_merging_is_no_part_of_a_survey():
    """The files are one cloud: tiles have no parameters of the merging."""
    pipeline = of_survey(PIPELINES["interpret_structure"])
    assert not pipeline.merges
    assert [step.name for step in pipeline.steps] == ["voxels", "features", "structure"]
    assert not [name for name in pipeline.parameters if name.startswith("merge")]
    assert "voxels_voxel_size" in pipeline.shown
