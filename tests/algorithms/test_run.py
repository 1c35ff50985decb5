"""What stands between a stage and a cloud: dimensions in, withheld points out, results back."""

from __future__ import annotations

from typing import Annotated

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import Features, Field, Layer, Measure, Monitor, Param, Report, stage
from lidar_buildings.algorithms.stages import STAGES


@stage("Count above", group="Toys", writes=("classification", "cluster_id", "entropy", "normal"))
def classify_toy(
    xyz,
    classification,
    height_above_ground=None,
    *,
    limit: Annotated[float, Param("Limit", "Higher points become 6.", unit="m", low=0)] = 2.0,
    monitor=None,
):
    """Make points over a limit class 6, and say how many points there were."""
    height = xyz[:, 2] if height_above_ground is None else height_above_ground
    monitor.resolved(seen=len(xyz), had_heights=height_above_ground is not None)
    found = np.where(height > limit, 6, classification)
    normal = np.tile([0.0, 0.0, 1.0], (len(xyz), 1))
    return found, np.arange(1, len(xyz) + 1), height / 10, normal


@stage("Only heights", group="Toys", writes=("height_above_ground", "entropy"))
def compute_toy(xyz, *, monitor=None):
    """Write one of two dimensions."""
    return None, xyz[:, 2]


@stage("Toy town", group="Toys", creates=("xyz", "classification"))
def simulate_toy(*, count: Annotated[int, Param("Count", "Points.", low=1, high=9)] = 3, monitor=None):
    """Make points in a row."""
    return np.outer(np.arange(count), [1.0, 2.0, 3.0]), np.full(count, 2)


@stage(
    "Toy marks",
    group="Toys",
    writes=("cluster_id",),
    layers=(Layer("marks", "Marks", "Point", (Field("id", int, "Number."),)),),
    measures=(Measure("points", "Points"),),
)
def extract_toy(xyz, *, monitor=None):
    """Write, draw and report."""
    marks = Features([xyz[0, :2]], {"id": [1]})
    return np.ones(len(xyz)), marks, Report({"points": len(xyz)}, "<html></html>")


@stage("Toy difference", group="Toys", measures=(Measure("distance", "Distance", "m"),))
def assess_toy(xyz, classification, reference_xyz, reference_classification, *, monitor=None):
    """Measure how far two clouds are apart."""
    same = np.array_equal(classification, reference_classification)
    return Report({"distance": float(np.abs(xyz - reference_xyz).max()), "same": same}, "")


@pytest.fixture
def cloud():
    """Five points, 1 m higher each, somewhere in UTM; the middle one has class 5."""
    xyz = np.array([600_000.0, 5_000_000.0, 0.0]) + np.arange(5.0)[:, None] * [1, 1, 1]
    return create_cloud({"xyz": xyz, "classification": np.array([1, 1, 5, 1, 1], np.uint8)})


def withhold(cloud, *numbers):
    cloud.header.layout.put(cloud.points, "withheld", np.isin(np.arange(len(cloud)), numbers))


def test_results_are_stored_under_their_names_and_in_their_types(cloud):
    outcome = run_stage(classify_toy.stage, cloud)
    assert outcome.cloud is cloud
    assert outcome.layers == {}
    assert outcome.report is None
    assert cloud.get("classification").tolist() == [1, 1, 5, 6, 6]
    assert cloud.get("cluster_id").tolist() == [1, 2, 3, 4, 5]
    assert cloud.get("classification").dtype == np.uint8
    assert cloud.get("cluster_id").dtype == np.int32
    assert cloud.get("entropy").dtype == np.float32
    assert cloud.get("normal").tolist() == [[0, 0, 1]] * 5


def test_tunables_reach_the_stage_and_are_checked_before_it(cloud):
    run_stage(classify_toy.stage, cloud, limit=0.5)
    assert cloud.get("classification").tolist() == [1, 6, 6, 6, 6]
    with pytest.raises(ValueError, match=r"Limit \(limit\) must be at least 0 m, got -1"):
        run_stage(classify_toy.stage, cloud, limit=-1)
    with pytest.raises(ValueError, match="classify_toy has no tunable 'limits'; it has limit"):
        run_stage(classify_toy.stage, cloud, limits=1)


def test_withheld_points_are_not_shown_and_not_changed(cloud):
    withhold(cloud, 2, 4)
    monitor = Monitor()
    run_stage(classify_toy.stage, cloud, monitor=monitor)
    assert monitor.values["seen"] == 3
    # The classification stays, ids are none, numbers are undefined.
    assert cloud.get("classification").tolist() == [1, 1, 5, 6, 1]
    assert cloud.get("cluster_id").tolist() == [1, 2, 0, 3, 0]
    np.testing.assert_allclose(cloud.get("entropy"), [0, 0.1, np.nan, 0.3, np.nan], rtol=1e-6)
    assert np.isnan(cloud.get("normal")).any(axis=1).tolist() == [False, False, True, False, True]


def test_withheld_points_stay_undefined_when_a_stage_runs_again(cloud):
    run_stage(classify_toy.stage, cloud)
    withhold(cloud, 0)
    run_stage(classify_toy.stage, cloud)
    assert cloud.get("cluster_id").tolist() == [0, 1, 2, 3, 4]
    assert np.isnan(cloud.get("entropy")[0])


def test_withheld_points_are_never_used_by_a_real_stage(cloud, rng):
    """A withheld point far below the ground would pull it down."""
    plan = rng.uniform(0, 40, (3000, 2))
    z = np.zeros(3000)
    z[:300] = -20.0
    wanted = STAGES["classify_ground_tin"]
    flagged = create_cloud({"xyz": np.column_stack([plan, z])})
    withhold(flagged, *range(300))
    run_stage(wanted, flagged)
    assert (flagged.get("classification")[:300] == 0).all()
    without = create_cloud({"xyz": np.column_stack([plan, z])[300:]})
    run_stage(wanted, without)
    np.testing.assert_array_equal(flagged.get("classification")[300:], without.get("classification"))
    assert (without.get("classification") == 2).all()


def test_all_points_withheld_is_refused(cloud):
    withhold(cloud, *range(5))
    with pytest.raises(ValueError, match="All 5 points are marked as withheld"):
        run_stage(classify_toy.stage, cloud)


def test_optional_dimensions_are_read_where_they_are(cloud):
    monitor = Monitor()
    run_stage(classify_toy.stage, cloud, monitor=monitor)
    assert monitor.values["had_heights"] is False
    cloud.set("height_above_ground", np.array([9, 0, 0, 0, 9], np.float32))
    run_stage(classify_toy.stage, cloud, monitor=monitor)
    assert monitor.values["had_heights"] is True
    assert cloud.get("classification").tolist() == [6, 1, 5, 6, 6]  # the fourth was 6 from the run before


def test_optional_dimensions_leave_withheld_points_out_too(cloud):
    cloud.set("height_above_ground", np.array([9, 0, 0, 0, 9], np.float32))
    withhold(cloud, 0)
    run_stage(classify_toy.stage, cloud)
    assert cloud.get("classification").tolist() == [1, 1, 5, 1, 6]


def test_a_missing_dimension_names_itself_and_the_stage_that_writes_it(cloud):
    with pytest.raises(ValueError, match=r"^The cloud has no ClusterID dimension; run 'Segment regions' first\.$"):
        run_stage(STAGES["classify_buildings"], cloud)
    with pytest.raises(ValueError, match=r"no HeightAboveGround dimension; run 'Height above ground' first\.$"):
        run_stage(STAGES["segment_roofs"], cloud)


def test_a_dimension_that_a_stage_leaves_out_is_not_made(cloud):
    run_stage(compute_toy.stage, cloud)
    assert not cloud.has("height_above_ground")
    assert cloud.get("entropy").tolist() == [0, 1, 2, 3, 4]


def test_a_stage_that_makes_a_cloud():
    outcome = run_stage(simulate_toy.stage, count=4)
    assert len(outcome.cloud) == 4
    np.testing.assert_allclose(outcome.cloud.get("xyz"), np.outer(np.arange(4), [1, 2, 3]))
    assert outcome.cloud.get("classification").tolist() == [2] * 4


def test_layers_and_report_come_back_by_name(cloud):
    outcome = run_stage(extract_toy.stage, cloud)
    assert cloud.get("cluster_id").tolist() == [1] * 5
    assert outcome.layers["marks"].columns == {"id": [1]}
    np.testing.assert_allclose(cloud.to_map(outcome.layers["marks"].geometries[0]), [600_000, 5_000_000])
    assert outcome.report.values == {"points": 5}


def test_two_clouds_are_compared_from_one_origin(cloud):
    """The same points in files whose local origins differ are the same points."""
    other = create_cloud({"xyz": cloud.get("xyz"), "classification": cloud.get("classification")})
    other.origin = np.array([599_000.0, 4_999_000.0, 0.0])
    assert np.abs(other.get("xyz") - cloud.get("xyz")).max() > 900
    report = run_stage(assess_toy.stage, cloud, reference=other).report
    assert report.values["distance"] == pytest.approx(0, abs=1e-6)
    assert report.values["same"]


def test_the_cloud_keeps_its_origin_when_a_reference_has_another(cloud):
    other = create_cloud({"xyz": cloud.get("xyz")})
    other.origin = np.array([500_000.0, 0.0, 0.0])
    before = cloud.origin.copy()
    run_stage(assess_toy.stage, cloud, reference=other)
    np.testing.assert_array_equal(cloud.origin, before)


def test_a_failing_stage_changes_nothing(cloud):
    before = cloud.get("classification").tolist()
    with pytest.raises(ValueError, match="one line"):
        run_stage(STAGES["classify_ground_tin"], cloud)
    assert cloud.get("classification").tolist() == before
