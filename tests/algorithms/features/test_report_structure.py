"""Figures of structure, against the stages that make features one by one."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.features import report_structure as module
from lidar_buildings.algorithms.features.classify_dimensionality import classify_dimensionality
from lidar_buildings.algorithms.features.compute_features import compute_features
from lidar_buildings.algorithms.features.report_structure import report_structure
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import Monitor

KINDS = ("linear", "planar", "volumetric")
FEATURES = ("linearity", "planarity", "scattering", "optimal_neighbors")


@pytest.fixture
def scene(rng):
    """Return a wire, a field and a bush, far from each other."""
    wire = np.column_stack([np.linspace(0, 100, 1000), np.full(1000, 50.0), np.full(1000, 20.0)])
    field = np.column_stack([rng.uniform(0, 30, (2000, 2)), np.zeros(2000)])
    bush = rng.uniform(0, 5, (1000, 3)) + [200, 0, 0]
    return np.concatenate([wire, field, bush]) + rng.normal(0, 0.01, (4000, 3))


def shares(xyz, **tunables):
    """Return the share (%) of each kind, and the numbers of neighbors, by the stages that are tested elsewhere."""
    made = compute_features(xyz, features=FEATURES, **tunables)
    linearity, planarity, scattering, neighbors = (one for one in made if one is not None)
    kinds = classify_dimensionality(linearity, planarity, scattering)
    return dict(zip(KINDS, 100 * np.bincount(kinds, minlength=4)[1:] / len(xyz))), neighbors


def test_shares_are_those_of_both_neighborhoods(scene):
    kinds = np.repeat([1, 2, 3, 0], [1000, 2000, 500, 500])
    values = report_structure(scene, kinds).values
    assert [values[f"cloud_{kind}"] for kind in KINDS] == [25.0, 50.0, 12.5]
    for of, tunables in (("nearest", {}), ("optimal", {"neighborhood": "optimal"})):
        expected, neighbors = shares(scene, **tunables)
        assert {kind: values[f"{of}_{kind}"] for kind in KINDS} == pytest.approx(expected)
    assert values["median_neighbors"] == np.median(neighbors)
    assert values["fewer_neighbors"] == pytest.approx(100 * np.mean(neighbors < 50))
    assert values["nearest_linear"] > 25, "the wire"


def test_some_points_stand_for_all(scene, monkeypatch):
    """Every fourth; with all others as their neighbors."""
    monkeypatch.setattr(module, "_COMPARED", 1000)
    report = report_structure(scene, np.ones(4000, int))
    assert report.values["nearest_linear"] == pytest.approx(shares(scene)[0]["linear"], abs=3)
    assert "Both neighborhoods were tried on 1,000 points" in report.html


@pytest.mark.parametrize(("count", "left"), [(5, 20.0), (None, np.nan)])
def test_what_thinning_left_is_counted_where_it_is_known(scene, count, left):
    monitor = Monitor()
    given = None if count is None else np.full(4000, count, np.uint32)
    values = report_structure(scene, np.ones(4000, int), given, monitor=monitor).values
    assert values["left"] == pytest.approx(left, nan_ok=True)
    assert values["points"] == 4000
    assert [one for one in monitor.infos if "Linear / planar / volumetric: " in one]
    assert any("Thinning left 4,000 of 20,000 points, 20.00 %" in one for one in monitor.infos) == (count == 5)


def test_the_page_has_a_histogram_and_a_map(scene):
    html = report_structure(scene, np.repeat([1, 2, 3], [1000, 2000, 1000])).html
    assert "Histogram: nearest points of least eigenentropy" in html
    assert html.count("<svg") == 1
    assert ">volumetric<" in html
    assert 'alt="Map of the result"' in html


def test_the_chain_reports_whatever_of_its_cloud_is_wanted(scene):
    chain = PIPELINES["interpret_structure"]
    results = run_pipeline(chain, [create_cloud({"xyz": scene})], wanted=("output",), voxels_voxel_size=0.5)
    kinds = results.cloud.get("dimensionality")
    assert results.report.values["cloud_linear"] == pytest.approx(100 * np.mean(kinds == 1))
    assert results.report.values["original_points"] == 4000
    assert results.report.values["left"] == pytest.approx(100 * len(kinds) / 4000)
