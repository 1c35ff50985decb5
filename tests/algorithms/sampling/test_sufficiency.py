"""Clouds that can hardly show buildings: a warning in the log and on the page, and no building that is sure."""

import time
from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.sampling import sufficiency
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.sampling.sufficiency import SUFFICIENCY, doubted, why_doubtful
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.algorithms.stages import STAGES

SURE = 0.7


def square(rng, side, density):
    """Random points in a square."""
    count = round(side * side * density)
    return np.column_stack([rng.uniform(0, side, (count, 2)), np.zeros(count)])


def houses(rng, side=60.0, density=4.0):
    """Ground with nine houses of 10 m by 10 m, and which points are on them."""
    xyz = square(rng, side, density)
    is_roof = ((xyz[:, :2] % 20 > 5) & (xyz[:, :2] % 20 < 15)).all(axis=1)
    xyz[:, 2] = np.where(is_roof, 6.0, 0.0) + rng.normal(0, 0.02, len(xyz))
    return xyz, is_roof


def why(xyz, classes):
    return why_doubtful(xyz, np.asarray(classes, np.uint8), CloudSampling.of(xyz))


def test_a_town_is_shown(rng):
    xyz, is_roof = houses(rng)
    assert why(xyz, np.where(is_roof, 6, 2)) == ""


@pytest.mark.parametrize(("density", "is_thin"), [(0.6, False), (0.4, True), (0.001, True)])
def test_thin_clouds(rng, density, is_thin):
    xyz = square(rng, 100.0 if density > 0.01 else 1200.0, density)
    said = why(xyz, np.full(len(xyz), 2))
    assert ("points per m² where it is thin, and 0.5 are needed" in said) == is_thin
    assert bool(said) == is_thin


@pytest.mark.parametrize(("side", "is_small"), [(35.0, False), (25.0, True)])
def test_small_clouds(rng, side, is_small):
    xyz = square(rng, side, 4.0)
    assert ("it covers less than 900 m²" in why(xyz, np.full(len(xyz), 2))) == is_small


def test_roofs_alone_are_islands(rng):
    xyz, is_roof = houses(rng, side=100.0)
    assert "its points lie in islands with nothing around" in why(xyz[is_roof], np.full(is_roof.sum(), 6))


def test_hardly_any_ground(rng):
    xyz = square(rng, 60.0, 4.0)
    edge = xyz[:, 0] < 3
    assert "hardly any ground is seen in it" in why(xyz, np.where(edge, 2, 6))
    assert why(xyz, np.where(xyz[:, 0] < 12, 2, 6)) == ""
    assert why(xyz, np.ones(len(xyz))) == "", "what is not classified shows its ground to nobody"


def test_a_wide_scan_whose_points_are_dense_at_its_middle(rng):
    """Points lie along rays, ever farther apart: hardly any cell has a neighbor on all sides."""
    distance = np.exp(rng.uniform(0, np.log(600.0), 10_000))
    angle = rng.uniform(0, 2 * np.pi, 10_000)
    xyz = np.column_stack([distance * np.cos(angle), distance * np.sin(angle), np.zeros(10_000)])
    assert "points per m² where it is thin" in why(xyz, np.full(10_000, 2))


def test_a_part_of_a_survey_is_judged_by_the_density_of_the_survey_alone(rng):
    xyz = square(rng, 20.0, 4.0)
    sampling = CloudSampling.of(xyz)
    sampling.of_whole = {"anything": 1.0}
    assert why_doubtful(xyz, np.full(len(xyz), 2), sampling) == ""


def test_doubt_changes_no_decision():
    confidence = np.array([np.nan, 0.2, 0.5, 0.51, 1.0])
    np.testing.assert_allclose(doubted(confidence), [np.nan, 0.2, 0.5, 0.503, 0.65])
    assert 0.5 + 0.5 * SUFFICIENCY.doubt < SURE


def test_no_building_of_such_a_cloud_is_sure(rng, monkeypatch):
    """1,065 points over 1.4 km² were "1 building, 16,977 m², 0 doubtful"."""
    xyz, _ = houses(rng, side=120.0, density=0.3)
    monitor, pipeline = Monitor(), PIPELINES["detect_buildings"]
    results = run_pipeline(pipeline, create_cloud({"xyz": xyz}), monitor=monitor)
    said = [one for one in monitor.warnings if "can hardly show buildings" in one]
    assert len(said) == 1, "once for all steps"
    assert said[0] in results.reports["report"].html
    values = results.reports["report"].values
    assert values["doubtful"] == values["buildings"] > 0
    found = results.layers["footprints"]
    assert max(found.columns["confidence"]) < SURE
    # Without doubt classes and outlines are the same.
    monkeypatch.setattr(sufficiency, "SUFFICIENCY", replace(SUFFICIENCY, density=0.0))
    trusted = run_pipeline(pipeline, create_cloud({"xyz": xyz}))
    assert max(trusted.layers["footprints"].columns["confidence"]) > SURE
    for name in ("classification", "cluster_id", "reason"):
        np.testing.assert_array_equal(results.cloud.get(name), trusted.cloud.get(name))
    assert found.columns["area"] == trusted.layers["footprints"].columns["area"]


def test_the_page_on_footprints_of_others_says_so_too(rng):
    xyz = square(rng, 25.0, 4.0)
    ring = np.array([[5, 5], [15, 5], [15, 15], [5, 15], [5, 5.0]])
    layer = LayerFeatures([[ring], [ring]], {"id": [1, 2], "confidence": [0.9, np.nan]})
    cloud = create_cloud({"xyz": xyz, "classification": np.full(len(xyz), 2)})
    monitor = Monitor()
    made = run_stage(STAGES["report_buildings"], cloud, monitor=monitor, input_layers={"footprints": layer})
    assert made.report.values["doubtful"] == 1, "of one nothing is known"
    assert "it covers less than 900 m²" in made.report.html
    alone = run_stage(STAGES["report_buildings"], monitor=Monitor(), input_layers={"footprints": layer})
    assert alone.report.values["doubtful"] == 0


def test_a_wide_scan_takes_time_by_its_points(rng):
    """A million cells for ten thousand points took 40 s of processor time, nearly all of it in means over gaps."""
    count = 10_000
    near = rng.normal(0, 30.0, (count - 40, 2))
    far = rng.uniform(-550, 550, (40, 2))
    xy = np.concatenate([near, far])
    # Everything far off is high: a free-standing surface of hundreds of meters.
    xyz = np.column_stack([xy, np.where(np.abs(xy).max(axis=1) > 150, 40.0, 0.0)])
    began = time.process_time()
    run_stage(STAGES["classify_ground_tin"], create_cloud({"xyz": xyz}))
    assert time.process_time() - began < 5.0
