"""How a stage is run on a cloud: dimensions in, withheld points out, results back."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipeline import Pipeline, Step
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.sampling.density import point_density
from lidar_buildings.algorithms.stage import (
    Field,
    InputLayer,
    Layer,
    LayerFeatures,
    Measure,
    Monitor,
    Raster,
    RasterSurface,
    Report,
    stage,
    tunable,
)
from lidar_buildings.algorithms.stages import STAGES


@stage("Toys", title="Count above", writes=("classification", "cluster_id", "entropy", "normal"))
def classify_toy(
    xyz,
    classification,
    height_above_ground=None,
    *,
    limit: float = tunable(2.0, "Higher points become 6.", within="[0, inf) m"),
    monitor=None,
):
    """Make points over a limit class 6, and say how many points there were."""
    height = xyz[:, 2] if height_above_ground is None else height_above_ground
    monitor.resolved(seen=len(xyz), had_heights=height_above_ground is not None)
    found = np.where(height > limit, 6, classification)
    normal = np.tile([0.0, 0.0, 1.0], (len(xyz), 1))
    return found, np.arange(1, len(xyz) + 1), height / 10, normal


@stage("Toys", title="Only heights", writes=("height_above_ground", "entropy"))
def compute_toy(xyz, *, monitor=None):
    """Write one of two dimensions."""
    return None, xyz[:, 2]


@stage("Toys", title="Toy town", creates=("xyz", "classification"))
def simulate_toy(*, count: int = tunable(3, "Points.", within="[1, 9]"), monitor=None):
    """Make points in a row."""
    return np.outer(np.arange(count), [1.0, 2.0, 3.0]), np.full(count, 2)


@stage(
    "Toys",
    title="Toy marks",
    writes=("cluster_id",),
    layers=(Layer("marks", "Marks", "Point", (Field("id", int, "Number."),)),),
    measures=(Measure("points", "Points"),),
)
def extract_toy(xyz, *, monitor=None):
    """Write, draw and report."""
    marks = LayerFeatures([xyz[0, :2]], {"id": [1]})
    return np.ones(len(xyz)), marks, Report({"points": len(xyz)}, "<html></html>")


@stage("Toys", title="Toy difference", measures=(Measure("distance", "Distance", "m"),))
def assess_toy(xyz, classification, reference_xyz, reference_classification, *, monitor=None):
    """Measure how far two clouds are apart."""
    same = np.array_equal(classification, reference_classification)
    return Report({"distance": float(np.abs(xyz - reference_xyz).max()), "same": same}, "")


@stage("Toys", title="Keep toy", writes=("xyz", "cluster_id"), selects=True)
def filter_toy(
    xyz,
    values=None,
    *,
    dimension: str = tunable("", "What is looked at."),
    low: float = tunable(2.0, "Lower values go.", within="[-1e9, inf)"),
    step: float = tunable(0.0, "Moved east.", within="[0, inf) m"),
    monitor=None,
):
    """Keep what is high, the last point first, and move it east."""
    kept = np.flatnonzero((xyz[:, 2] if values is None else values) >= low)[::-1]
    return kept, xyz[kept] + [step, 0, 0], np.arange(1, len(kept) + 1)


@stage("Toys", writes=("xyz", "point_source_id"), merges=True)
def merge_toy(
    xyz,
    classification,
    cluster_id=None,
    *,
    lift: float = tunable(0.0, "How far later clouds are lifted.", within="[0, inf) m"),
    monitor=None,
):
    """Put clouds together, each higher than the one before."""
    monitor.resolved(sizes=[len(one) for one in xyz], has_ids=cluster_id is not None, classes=len(classification))
    moved = [one + [0, 0, lift * i] for i, one in enumerate(xyz)]
    return np.concatenate(moved) if lift else None, np.repeat(np.arange(1, len(xyz) + 1), [len(one) for one in xyz])


@stage(
    "Toys",
    title="Toy raster",
    input_layers=(
        InputLayer("area", help="Where."),
        InputLayer("spots", "Spots", "What.", "Point", optional=True),
    ),
    rasters=(Raster("low", "Lowest"), Raster("high", "Highest")),
    measures=(Measure("spots", "Spots"),),
)
def rasterize_toy(xyz, intensity=None, area=None, spots=None, *, monitor=None):
    """Say how low and how high the points are."""
    lowest, highest = (np.full((1, 2), height, np.float32) for height in (xyz[:, 2].min(), xyz[:, 2].max()))
    report = Report({"spots": -1 if spots is None else len(spots), "areas": len(area)}, "")
    return RasterSurface(lowest, 0.0, 1.0, 1.0), RasterSurface(highest, 0.0, 1.0, 1.0), report


@stage(
    "Toys",
    title="Toy map",
    input_layers=(InputLayer("old", "Old map", "Before."),),
    measures=(Measure("n", "N"),),
)
def compare_toy(old, *, monitor=None):
    """Count polygons."""
    return Report({"n": len(old)}, "")


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
    # The classification stays, ids are 0, numbers are undefined.
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
    with pytest.raises(ValueError, match=r"^The cloud has no ClusterID dimension; run 'Segment roofs' first\.$"):
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


def test_withheld_points_of_a_reference_are_not_shown_either(cloud):
    """Of the same points, those left out of the cloud were compared with the points of the reference after them."""
    withhold(cloud, 1)
    report = run_stage(assess_toy.stage, cloud, reference=cloud.copy()).report
    assert report.values == {"distance": 0.0, "same": True}


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


# --- a selection ------------------------------------------------------------------------------------------------------


def test_a_selection_is_a_new_cloud_with_everything_of_the_points_kept(cloud):
    cloud.set("intensity", np.arange(10, 15))
    cloud.set("entropy", np.arange(5) / 10)
    outcome = run_stage(filter_toy.stage, cloud)
    assert len(cloud) == 5
    kept = outcome.cloud
    assert kept.get("intensity").tolist() == [14, 13, 12]
    assert kept.get("classification").tolist() == [1, 1, 5]
    assert kept.get("cluster_id").tolist() == [1, 2, 3]
    np.testing.assert_array_equal(kept.get("entropy"), np.float32([0.4, 0.3, 0.2]))
    np.testing.assert_allclose(kept.to_map(kept.get("xyz")), 600_004 - np.arange(3)[:, None] + [0, 4.4e6, -6e5])
    np.testing.assert_array_equal(kept.origin, cloud.origin)
    assert kept.header.count == 3


def test_kept_points_may_be_moved_and_the_cloud_they_come_from_is_not(cloud):
    before = cloud.get("xyz").copy()
    moved = run_stage(filter_toy.stage, cloud, step=0.25).cloud
    np.testing.assert_allclose(moved.get("xyz"), before[[4, 3, 2]] + [0.25, 0, 0], atol=1e-6)
    np.testing.assert_array_equal(cloud.get("xyz"), before)


def test_withheld_points_are_left_out_of_a_selection(cloud):
    cloud.set("intensity", np.arange(10, 15))
    withhold(cloud, 0, 3)
    kept = run_stage(filter_toy.stage, cloud).cloud
    assert kept.get("intensity").tolist() == [14, 12]
    assert not kept.withheld.any()


def test_a_selection_of_nothing_is_refused(cloud):
    with pytest.raises(ValueError, match=r"^Keep toy leaves none of the points; choose wider limits\.$"):
        run_stage(filter_toy.stage, cloud, low=99.0)


@pytest.mark.parametrize(
    ("name", "low", "kept"),
    [
        ("Classification", 5, [12]),
        ("classification", 5, [12]),
        ("HEIGHTABOVEGROUND", 3, [14, 13]),
        ("height_above_ground", 3, [14, 13]),
        ("X", 600_003, [14, 13]),
        ("z", 4, [14]),
        ("NormalZ", 0.5, [14, 13, 12, 11, 10]),
        ("UserData", 7, [11]),
        ("user_data", 7, [11]),
    ],
)
def test_values_are_those_of_the_dimension_that_is_named(cloud, name, low, kept):
    cloud.set("intensity", np.arange(10, 15))
    cloud.set("height_above_ground", np.arange(5, dtype="f4"))
    cloud.set("normal", np.tile([0, 0, 1.0], (5, 1)))
    cloud.points["user_data"][1] = 7
    assert run_stage(filter_toy.stage, cloud, dimension=name, low=low).cloud.get("intensity").tolist() == kept


def test_an_unknown_dimension_names_those_there_are(cloud):
    cloud.set("entropy", np.zeros(5))
    with pytest.raises(ValueError, match=r"^The cloud has no dimension 'Hight'; it has X, Y, Z, .*Entropy.*UserData"):
        run_stage(filter_toy.stage, cloud, dimension="Hight")


# --- several clouds ---------------------------------------------------------------------------------------------------


def parted(cloud):
    return cloud.take(np.array([0, 1])), cloud.take(np.array([2, 3, 4]))


def test_clouds_are_merged_one_after_the_other(cloud):
    monitor = Monitor()
    clouds = parted(cloud)
    merged = run_stage(merge_toy.stage, clouds, monitor=monitor).cloud
    assert monitor.values == {"sizes": [2, 3], "has_ids": False, "classes": 2}
    np.testing.assert_array_equal(merged.get("xyz"), cloud.get("xyz"))
    assert merged.get("classification").tolist() == [1, 1, 5, 1, 1]
    assert merged.get("point_source_id").tolist() == [1, 1, 2, 2, 2]
    assert [len(one) for one in clouds] == [2, 3]


def test_merged_clouds_share_one_origin_and_may_be_moved(cloud):
    first, second = parted(cloud)
    second.origin = np.array([599_000.0, 0.0, 0.0])
    merged = run_stage(merge_toy.stage, [first, second], lift=2.0).cloud
    wanted = cloud.to_map(cloud.get("xyz")) + np.array([0, 0, 2, 2, 2])[:, None] * [0, 0, 1]
    np.testing.assert_allclose(merged.to_map(merged.get("xyz")), wanted, atol=1e-6)
    np.testing.assert_array_equal(merged.origin, first.origin)


def test_withheld_points_are_left_out_of_merged_clouds(cloud):
    first, second = parted(cloud)
    withhold(second, 1)
    merged = run_stage(merge_toy.stage, [first, second], lift=1.0).cloud
    assert merged.get("point_source_id").tolist() == [1, 1, 2, 2]
    assert merged.get("classification").tolist() == [1, 1, 5, 1]


def test_an_optional_dimension_is_merged_where_all_clouds_have_it(cloud):
    cloud.set("cluster_id", np.arange(5))
    monitor = Monitor()
    merged = run_stage(merge_toy.stage, parted(cloud), monitor=monitor).cloud
    assert monitor.values["has_ids"]
    assert merged.get("cluster_id").tolist() == [0, 1, 2, 3, 4]


def test_one_cloud_is_merged_with_nothing(cloud):
    merged = run_stage(merge_toy.stage, [cloud]).cloud
    assert len(merged) == len(cloud) - np.count_nonzero(cloud.withheld)
    assert (merged.get("point_source_id") == 1).all()


def test_an_empty_cloud_is_reported_by_its_number():
    xyz, classes = np.zeros((2, 3)), np.zeros(2)
    with pytest.raises(ValueError, match=r"^The point cloud 2 has no points; choose another\.$"):
        merge_toy([xyz, xyz[:0]], [classes, classes[:0]])


# --- layers that are read, rasters ------------------------------------------------------------------------------------

SQUARE = LayerFeatures([[np.array([[0, 0], [1, 0], [1, 1], [0, 0]], float)]], {"id": [1]})


def test_layers_reach_the_stage_and_rasters_come_back_by_name(cloud):
    outcome = run_stage(rasterize_toy.stage, cloud, input_layers={"area": SQUARE})
    assert outcome.report.values == {"spots": -1, "areas": 1}
    assert list(outcome.rasters) == ["low", "high"]
    assert outcome.rasters["low"].values.tolist() == [[0, 0]]
    assert outcome.rasters["high"].values.tolist() == [[4, 4]]
    spots = LayerFeatures([np.zeros(2)] * 3, {})
    report = run_stage(rasterize_toy.stage, cloud, input_layers={"area": SQUARE, "spots": spots}).report
    assert report.values["spots"] == 3


def test_a_missing_or_unknown_layer_is_reported(cloud):
    with pytest.raises(ValueError, match=r"^Area \(area\) is missing; choose a layer\.$"):
        run_stage(rasterize_toy.stage, cloud, input_layers={"spots": SQUARE})
    with pytest.raises(ValueError, match=r"^rasterize_toy reads no layer 'hole'; it reads area, spots\.$"):
        run_stage(rasterize_toy.stage, cloud, input_layers={"area": SQUARE, "hole": SQUARE})


def test_a_stage_of_layers_needs_no_cloud():
    assert not compare_toy.stage.reads_cloud
    outcome = run_stage(compare_toy.stage, input_layers={"old": SQUARE})
    assert outcome.cloud is None
    assert outcome.report.values == {"n": 1}


# --- declarations that no run could keep to ---------------------------------------------------------------------------


# --- how the cloud was sampled ---------------------------------------------------------------------------------------


@stage("Toys", title="Toy sampling", writes=("classification",))
def classify_sampled(xyz, classification, *, sampling=None, monitor=None):
    """Call a point in a hundred noise, and say which sampling was given."""
    monitor.resolved(given=sampling, density=sampling.density)
    return np.where(np.arange(len(xyz)) % 100 == 0, 18, classification)


@stage("Toys", title="Toy halves", selects=True)
def filter_halves(xyz, *, monitor=None):
    """Keep every other point."""
    return np.arange(0, len(xyz), 2)


@stage("Toys", title="Toy east", selects=True)
def filter_east(xyz, *, monitor=None):
    """Keep the points in the eastern half."""
    return np.flatnonzero(xyz[:, 0] > xyz[:, 0].mean())


@pytest.fixture
def lattice(monkeypatch):
    """A square of one point per m², and toys in the chains."""
    for toy in (classify_sampled, filter_halves, filter_east):
        monkeypatch.setitem(STAGES, toy.stage.name, toy.stage)
    x, y = np.meshgrid(np.arange(60.0), np.arange(60.0))
    return create_cloud({"xyz": np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])})


def sampled(cloud, *names, **given):
    """Return what each step of a chain was given as the sampling, and the monitor."""
    steps = tuple(Step(f"step{i}", name) for i, name in enumerate(names))
    monitor = Monitor()
    run_pipeline(Pipeline("toys", "Toys", "Toys", "", "", "", "", steps), cloud, monitor, **given)
    return [value for name, value in monitor.values.items() if name.endswith("_given")], monitor


def test_a_stage_alone_is_given_the_sampling_of_its_points(lattice):
    """Neither of those that are withheld nor of noise: those left fill half of the area."""
    points = lattice.get("xyz")
    withhold(lattice, *np.flatnonzero((points[:, 0] < 30) & (points[:, 1] < 30)))
    lattice.set("classification", np.where((points[:, 0] < 30) & (points[:, 1] >= 30), 7, 1).astype(np.uint8))
    monitor = Monitor()
    run_stage(classify_sampled.stage, lattice, monitor=monitor)
    assert monitor.values["sampling"] is monitor.values["given"]
    assert monitor.values["density"] == point_density(points[points[:, 0] >= 30])


def test_a_sampling_from_outside_is_used_and_not_logged(lattice):
    outside, monitor = CloudSampling.of(lattice.get("xyz") * 3), Monitor()
    run_stage(classify_sampled.stage, lattice, monitor=monitor, sampling=outside)
    assert monitor.values["given"] is outside
    assert "sampling" not in monitor.values
    (first, second), monitor = sampled(lattice, "classify_sampled", "classify_sampled", samplings={"": outside})
    assert first is second is outside
    assert "sampling" not in monitor.values


def test_steps_share_a_sampling_until_the_points_that_count_are_others(lattice):
    """The first step calls points noise, the second finds the same ones, and the third has half of the points."""
    names = ("classify_sampled", "classify_sampled", "classify_sampled", "filter_halves", "classify_sampled")
    (raw, cleaned, again, halved), monitor = sampled(lattice, *names)
    assert raw is not cleaned
    assert cleaned is again
    assert halved.density == pytest.approx(cleaned.density / 2, rel=0.1)
    assert monitor.values["sampling"] is halved


def test_a_sampling_from_outside_holds_until_a_step_makes_another_cloud(lattice):
    outside = CloudSampling.of(lattice.get("xyz") * 3)
    first, second, third = sampled(
        lattice, "classify_sampled", "classify_sampled", "filter_halves", "classify_sampled", samplings={"": outside}
    )[0]
    assert first is second is outside
    assert third.density > 3 * outside.density


def test_cells_begin_at_the_corner_of_all_points_but_withheld_ones(lattice):
    """Noise counts, as it is found in cells; points that a step makes noise or leaves out do not move the cells."""
    points = lattice.get("xyz")
    withhold(lattice, *np.flatnonzero(points[:, 0] < 1))
    lattice.set("classification", np.where(points[:, 0] < 5, 7, 1).astype(np.uint8))
    corner = points[:, :2].min(axis=0) + [1, 0]
    monitor = Monitor()
    run_stage(classify_sampled.stage, lattice, monitor=monitor)
    np.testing.assert_array_equal(monitor.values["given"].corner, corner)
    np.testing.assert_array_equal(CloudSampling.of(points, lattice.get("classification")).corner, corner - [1, 0])
    steps = sampled(lattice, "classify_sampled", "filter_east", "classify_sampled")[0]
    for sampling in steps:
        np.testing.assert_array_equal(sampling.corner, corner)


def test_sampling_needs_the_points_of_one_cloud():
    with pytest.raises(TypeError, match="must read the xyz of one cloud"):
        stage("Toys", title="Toy")(lambda intensity, *, sampling=None, monitor=None: None)
    with pytest.raises(TypeError, match="must read the xyz of one cloud"):
        stage("Toys", title="Toy", merges=True)(lambda xyz, *, sampling=None, monitor=None: None)
    with pytest.raises(TypeError, match="must take the sampling None"):
        stage("Toys", title="Toy")(lambda xyz, *, sampling, monitor=None: None)


@pytest.mark.parametrize(
    ("declared", "sentence"),
    [
        ({"of_whole": ("middle",)}, "takes 'middle' of the whole, so it must take its sampling"),
        ({"input_layers": (InputLayer("map"),)}, "has no argument of that name"),
        ({"creates": ("xyz",)}, "can't read anything"),
        ({"selects": True, "merges": True}, "make it two stages"),
        ({"writes": ("xyz",)}, "it must select them"),
    ],
)
def test_what_can_not_be_kept_is_refused_when_it_is_declared(declared, sentence):
    with pytest.raises(TypeError, match=sentence):
        stage("Toys", title="Toy", **declared)(lambda xyz, monitor=None: None)


def test_values_need_the_tunable_that_names_them():
    with pytest.raises(TypeError, match="has no tunable 'dimension'"):
        stage("Toys", title="Toy", selects=True)(lambda xyz, values: None)


SHARED = tunable(1.0, "Radius.")


def test_a_tunable_needs_its_type_and_its_declaration():
    with pytest.raises(TypeError, match="must declare 'radius' with its type"):
        stage("Toys", title="Toy")(lambda xyz, *, radius=SHARED, monitor=None: None)

    def compute_toys(xyz, *, radius: float = 1.0, monitor=None):
        """Compute."""

    with pytest.raises(TypeError, match="'radius: float = tunable"):
        stage("Toys", title="Toy")(compute_toys)


def test_every_stage_takes_a_monitor():
    with pytest.raises(TypeError, match="must take 'monitor=None'"):
        stage("Toys", title="Toy")(lambda xyz: None)
