"""Chains of stages in memory: results, names of tunables, messages, cancellation."""

import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms import run as module
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.features.classify_dimensionality import Dimensionality
from lidar_buildings.algorithms.pipeline import CLOUD, Pipeline, Step
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.sampling import cloud_sampling
from lidar_buildings.algorithms.stage import Cancelled, LayerFeatures, Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.builders import crown
from lidar_buildings.tests.monitors import Listening
from lidar_buildings.tests.toys import TOY_MAPPING, TOYS

ROOT = Path(__file__).resolve().parents[2]
FIELD, HOUSE, SHED, CROWN, BIRD = range(5)


def hamlet(seed=5, density=4):
    """Return points and truth: a gable house, a flat house and two trees on a slope, and a bird above."""
    random = np.random.default_rng(seed)
    plan = random.uniform(0, 60, (60 * 60 * density, 2))
    ground = 0.08 * plan[:, 0]
    z, truth = ground.copy(), np.full(len(plan), FIELD)
    house = ((plan > [10, 10]) & (plan < [22, 26])).all(axis=1)
    z[house], truth[house] = 4.5 + 4 + (6 - np.abs(plan[house, 0] - 16)) * 0.8, HOUSE
    shed = ((plan > [35, 12]) & (plan < [47, 20])).all(axis=1)
    z[shed], truth[shed] = 8.0, SHED
    trees = ((20, 45, 4.0), (42, 42, 3.0))
    crowns = [crown(random, x, y, r, 0.08 * x + 3 + r, int(30 * r**3 / 3)) for x, y, r in trees]
    leaves = np.concatenate(crowns)
    xyz = np.concatenate([np.column_stack([plan, z + random.normal(0, 0.02, len(plan))]), leaves, [[30.0, 30.0, 90.0]]])
    return xyz, np.concatenate([truth, np.full(len(leaves), CROWN), [BIRD]])


def made(density=4):
    xyz, truth = hamlet(density=density)
    return create_cloud({"xyz": xyz + [600_000.0, 5_000_000.0, 0.0]}), truth


@pytest.fixture(scope="module")
def detected():
    """The default chain's result on the hamlet."""
    cloud, truth = made()
    outcome = run_pipeline(PIPELINES["detect_buildings"], cloud)
    return outcome, truth


@pytest.mark.parametrize("shift", [(0.37, 0.83), (1234.37, 87.83)])
def test_the_same_classes_wherever_the_cloud_lies(shift):
    """Half a percent of the points changed their class in a cloud that was moved by less than a meter."""
    xyz = np.round(hamlet()[0], 3)
    one, other = (
        run_pipeline(PIPELINES["detect_buildings"], create_cloud({"xyz": np.round(xyz + by, 3)}), wanted=["output"])
        for by in ([500.0, 500.0, 0.0], [500.0 + shift[0], 500.0 + shift[1], 0.0])
    )
    np.testing.assert_array_equal(one.cloud.get("classification"), other.cloud.get("classification"))
    # Of the few points on the border of two cells rounding decides on the cell.
    off = np.abs(one.cloud.get("height_above_ground") - other.cloud.get("height_above_ground"))
    assert (off > 1e-3).mean() < 0.01


def test_the_default_chain_finds_the_hamlet(detected):
    outcome, truth = detected
    classes = outcome.cloud.get("classification")
    assert (classes[truth == FIELD] == 2).mean() > 0.98
    assert (classes[(truth == HOUSE) | (truth == SHED)] == 6).mean() > 0.98
    assert not (classes[truth == CROWN] == 6).any()
    assert classes[truth == BIRD].tolist() == [18]


def test_the_footprints_are_those_of_the_houses(detected):
    footprints = detected[0].layers["footprints"]
    assert len(footprints) == 2
    assert sorted(footprints.columns["area"]) == pytest.approx([12 * 8, 12 * 16], rel=0.08)
    # Also where points were added that have no entropy of their own.
    assert min(footprints.columns["confidence"]) > 0.8
    assert max(footprints.columns["entropy"]) < 0.75
    centers = [detected[0].cloud.to_map(rings[0][:-1].mean(axis=0)) for rings in footprints.geometries]
    expected = np.array([[600_016, 5_000_018], [600_041, 5_000_016]])
    for center in centers:
        assert np.linalg.norm(expected - center, axis=1).min() < 0.5


def test_every_step_leaves_its_dimensions(detected):
    cloud = detected[0].cloud
    for step in PIPELINES["detect_buildings"].steps:
        for name in step.stage.writes:
            # Nothing is remembered where no classes are kept.
            assert cloud.has(name) or name == "earlier_class", name


def test_the_published_chain_finds_the_houses_too():
    """Its regions keep to a height difference of ten noises, which parts a steep gable: it is found in pieces."""
    cloud, truth = made()
    outcome = run_pipeline(PIPELINES["detect_buildings_2019"], cloud, ground_max_building_size=20.0)
    classes = cloud.get("classification")
    assert (classes[truth == SHED] == 6).mean() > 0.9
    assert 0.3 < (classes[truth == HOUSE] == 6).mean() < 0.95
    assert (classes[truth == CROWN] == 6).mean() < 0.1
    assert len(outcome.layers["footprints"]) >= 2
    assert not cloud.has("height_above_ground")


@pytest.mark.slow
def test_the_published_chain_is_assessed_where_a_reference_is_given():
    """Table 3 of the paper in the same run, whatever else is wanted; nothing of it without a reference."""
    chain, (cloud, truth) = PIPELINES["detect_buildings_2019"], made()
    true = cloud.copy()
    is_building = np.isin(truth, (HOUSE, SHED))
    true.set("classification", np.where(is_building, 6, 1).astype(np.uint8))
    monitor = Monitor()
    given = {"ground_max_building_size": 20.0, "wanted": ("output",)}
    outcome = run_pipeline(chain, cloud, monitor, reference=true, **given)
    values, called = outcome.reports["assessment_report"].values, cloud.get("classification") == 6
    hits = (called & is_building).sum()
    assert values["points_completeness"] == pytest.approx(100 * hits / is_building.sum())
    assert values["points_correctness"] == pytest.approx(100 * hits / called.sum())
    assert [one for one in monitor.infos if one.startswith("Points: completeness")]
    assert len(outcome.layers["objects"]) >= 2
    without = run_pipeline(chain, made()[0], **given)
    assert "assessment_report" not in without.reports
    assert "objects" not in without.layers
    ring = np.array([[10, 10], [22, 10], [22, 26], [10, 26], [10, 10.0]]) + [600_000, 5_000_000]
    fresh = made()[0]
    drawn = LayerFeatures([[ring - fresh.origin[:2]]], {"id": [1]})
    by_map = run_pipeline(chain, fresh, input_layers={"reference_map": drawn}, **given)
    assert by_map.reports["assessment_report"].values["objects_true"] == 1


def test_a_chain_is_its_stages_one_after_the_other(detected):
    cloud, _ = made()
    outcomes = {}
    for step in PIPELINES["detect_buildings"].steps:
        sources = {name: source.split(".") for name, source in step.layers.items()}
        layers = {name: outcomes[earlier].layers[layer] for name, (earlier, layer) in sources.items()}
        outcomes[step.name] = run_stage(step.stage, cloud, input_layers=layers, **step.tunables)
    assert outcomes["report"].report.html == detected[0].report.html
    theirs = detected[0].cloud
    for name in ("classification", "cluster_id", "segment_id", "height_above_ground", "entropy", "confidence"):
        np.testing.assert_array_equal(cloud.get(name), theirs.get(name))
    for name, values in outcomes["footprints"].layers["footprints"].columns.items():
        np.testing.assert_array_equal(values, detected[0].layers["footprints"].columns[name])


@pytest.mark.parametrize(("with_bird", "clouds"), [(False, 1), (True, 2)])
def test_how_the_cloud_was_sampled_is_measured_once(with_bird, clouds, monkeypatch):
    """For seven steps, and the surfaces of the ground alone; again without the bird, which the noise filter finds."""
    calls = Counter()
    for name in ("point_density", "effective_density", "height_resolution", "SurfaceSample"):
        measure = getattr(cloud_sampling, name)
        monkeypatch.setattr(cloud_sampling, name, lambda *given, n=name, of=measure: calls.update([n]) or of(*given))
    xyz, _ = hamlet()
    run_pipeline(PIPELINES["detect_buildings"], create_cloud({"xyz": xyz if with_bird else xyz[:-1]}))
    with_noise = {"point_density": clouds, "height_resolution": clouds, "SurfaceSample": clouds + 1}
    assert calls == {**with_noise, "effective_density": 1}


def test_the_same_cloud_gives_the_same_result(detected):
    cloud, _ = made()
    run_pipeline(PIPELINES["detect_buildings"], cloud)
    np.testing.assert_array_equal(cloud.get("classification"), detected[0].cloud.get("classification"))
    np.testing.assert_array_equal(cloud.get("confidence"), detected[0].cloud.get("confidence"))


@pytest.mark.parametrize(
    ("name", "slope"), [("detect_buildings", 0.0), ("detect_buildings", 0.3), ("detect_buildings_2019", 0.0)]
)
def test_a_field_without_buildings_is_valid_and_has_none(name, slope, rng):
    plan = rng.uniform(0, 40, (2400, 2))
    cloud = create_cloud({"xyz": np.column_stack([plan, slope * plan[:, 1] + rng.normal(0, 0.02, 2400)])})
    outcome = run_pipeline(PIPELINES[name], cloud)
    assert (cloud.get("classification") == 2).mean() > 0.99
    assert not (cloud.get("classification") == 6).any()
    assert len(outcome.layers["footprints"]) == 0


# --- tunables --------------------------------------------------------------------------------------------------------


@pytest.fixture
def calls(monkeypatch):
    """What each stage of a chain is called with, without running it."""
    called = []

    def record(stage, cloud, reference=None, monitor=None, input_layers=None, sampling=None, **tunables):
        called.append((stage.name, tunables))
        return module.Outcome(cloud, dict.fromkeys(layer.name for layer in stage.layers))

    monkeypatch.setattr(module, "run_stage", record)
    return called


def test_tunables_go_to_the_step_that_their_name_begins_with(calls):
    tunables = {"ground_cell_size": 2.0, "footprints_tolerance": 0.9, "roofs_min_area": 7.0}
    run_pipeline(PIPELINES["detect_buildings"], None, **tunables)
    called = dict(calls)
    assert called["classify_ground_tin"] == {"cell_size": 2.0}
    assert called["extract_footprints"] == {"tolerance": 0.9}
    assert called["segment_roofs"] == {"min_area": 7.0}
    assert "min_area" not in called["complete_buildings"]
    assert called["classify_noise_histogram"] == {}
    assert [name for name, _ in calls] == [step.stage_name for step in PIPELINES["detect_buildings"].steps]


def test_shared_tunables_go_to_the_steps_that_share_them(calls):
    run_pipeline(PIPELINES["detect_buildings"], None, min_area=20.0)
    given = {name for name, tunables in calls if tunables.get("min_area") == 20.0}
    assert given == {"classify_buildings", "complete_buildings", "extract_footprints"}


@pytest.mark.parametrize("pipeline", PIPELINES.values(), ids=lambda pipeline: pipeline.name)
def test_what_steps_share_means_the_same_in_each(pipeline):
    steps = {step.name: step for step in pipeline.steps}
    for name, sharing in pipeline.shared.items():
        tunables = [steps[step].stage.tunables[name] for step in sharing]
        assert len({id(tunable.param) for tunable in tunables}) == 1
        assert len({steps[step].tunables.get(name, tunable.default) for step, tunable in zip(sharing, tunables)}) == 1
    assert set(pipeline.shown) <= set(pipeline.parameters)


def test_the_chains_own_defaults_hold_until_something_else_is_given(calls):
    own = {"min_area": 1.0}
    chain = Pipeline("one", "One", "Toys", "", "", "", "", (Step("regions", "segment_regions", own),))
    run_pipeline(chain, None)
    run_pipeline(chain, None, regions_plan_distance=3.0)
    run_pipeline(chain, None)
    # Nothing of a run stays behind for the next.
    assert [tunables for _, tunables in calls] == [own, {**own, "plan_distance": 3.0}, own]


def test_detect_buildings_is_its_stages_with_nothing_set_but_for_bridges_and_classes_of_earlier_runs():
    own = {step.name: step.tunables for step in PIPELINES["detect_buildings"].steps if step.tunables}
    assert own == {
        "earlier": {"mapping": "3-5, 9, 14-15, 17=1"},
        "bridges": {"search": "gaps in the ground"},
    }


def test_one_stage_may_be_in_a_chain_twice(calls):
    twice = Pipeline(
        "twice", "Twice", "Toys", "", "", "", "",
        (Step("first", "segment_regions", {"min_area": 1.0}), Step("second", "segment_regions")),
    )  # fmt: skip
    run_pipeline(twice, None, second_min_area=3.0)
    assert calls == [("segment_regions", {"min_area": 1.0}), ("segment_regions", {"min_area": 3.0})]


@pytest.mark.parametrize("name", ["cell_size", "ground_cellsize", "classify_ground_tin_cell_size", "ground"])
def test_an_unknown_tunable_is_refused_before_anything_runs(calls, name):
    with pytest.raises(ValueError, match=f"^detect_buildings has no tunable '{name}'; it has .*ground_cell_size"):
        run_pipeline(PIPELINES["detect_buildings"], None, **{name: 1})
    assert calls == []


def test_tunables_are_checked_by_their_stage():
    cloud, _ = made()
    with pytest.raises(ValueError, match="Maximum building size"):
        run_pipeline(PIPELINES["detect_buildings"], cloud, ground_max_building_size=-5.0)


def test_the_steps_own_tunables_are_ones_that_their_stages_take():
    for pipeline in PIPELINES.values():
        for step in pipeline.steps:
            step.stage.check(step.tunables)
            assert step.stage is STAGES[step.stage_name]


# --- messages and progress ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", PIPELINES)
def test_progress_only_grows_and_every_step_is_heard_of(name):
    monitor = Listening()
    cloud = made(density=2)[0]
    reference = cloud.copy() if PIPELINES[name].needs_reference else None
    cloud = [cloud, cloud.copy()] if PIPELINES[name].merges else cloud
    run_pipeline(PIPELINES[name], cloud, monitor, reference=reference)
    assert monitor.heard == sorted(monitor.heard)
    assert monitor.heard[0] >= 0
    assert monitor.heard[-1] <= 1
    run = PIPELINES[name].steps_for([output.name for output in PIPELINES[name].outputs], given=())
    costs = [step.stage.cost for step in run]
    done = np.cumsum([0.0, *costs])
    assert set(done[:-1] / done[-1]) <= set(monitor.heard)
    # The longest step reports within it: a bar that stands for minutes looks dead.
    longest = int(np.argmax(costs))
    begins, ends = sum(costs[:longest]) / sum(costs), sum(costs[: longest + 1]) / sum(costs)
    assert sum(begins < fraction < ends for fraction in monitor.heard) >= 1


def test_only_steps_that_the_wanted_outputs_need_are_run():
    """OUTPUT alone had its footprints drawn and reported on: nearly half of the time."""
    ran = {}
    for wanted in ("output", "footprints", "report"):
        monitor = Listening()
        monitor.steps = []
        monitor.step = lambda name, *rest, m=monitor: m.steps.append(name) or Listening.step(m, name, *rest)
        results = run_pipeline(PIPELINES["detect_buildings"], made(density=2)[0], monitor, wanted=(wanted,))
        ran[wanted] = set(monitor.steps)
        assert (wanted == "output") != ("footprints" in results.layers)
    every = {step.name for step in PIPELINES["detect_buildings"].steps}
    assert ran["output"] == every - {"footprints", "report"}
    # The numbers of the report are given with the footprints.
    assert ran["footprints"] == ran["report"] == every - {"codes"}


def two_scans(rng):
    """Return two clouds with 1 cm noise, of the ground and of a wall, a wire and a crown, and where these are."""
    ground = np.column_stack([rng.uniform(0, 9, (24_000, 2)), np.zeros(24_000)])
    wall = np.column_stack([np.full(20_000, 16.0), rng.uniform([0, 2], [9, 8], (20_000, 2))])
    wire = np.column_stack([rng.uniform(0, 12, 2000), np.full(2000, 20.0), np.full(2000, 6.0)])
    crown = rng.uniform(-1.5, 1.5, (40_000, 3)) + [30, 6, 5]
    parts = [ground, np.concatenate([wall, wall[:5000], wire, crown])]
    parts = [part + rng.normal(0, 0.01, part.shape) + [600_000, 5_000_000, 0] for part in parts]
    inner = {"ground": [[1, 1, -1], [8, 8, 1]], "wall": [[15, 1, 3], [17, 8, 7]], "wire": [[1, 19, 5], [11, 21, 7]]}
    inner["crown"] = [[29, 5, 4], [31, 7, 6]]
    return [create_cloud({"xyz": part}) for part in parts], inner


def test_the_structure_of_one_cloud_is_that_of_the_merged_ones(rng):
    """One cloud was refused."""
    clouds = [cloud.take(np.arange(0, len(cloud), 3)) for cloud in two_scans(rng)[0]]
    whole = np.concatenate([cloud.to_map(cloud.get("xyz")) for cloud in clouds])
    merged = run_pipeline(PIPELINES["interpret_structure"], clouds).cloud
    monitor = Monitor()
    made = run_pipeline(PIPELINES["interpret_structure"], create_cloud({"xyz": whole}), monitor=monitor).cloud
    np.testing.assert_array_equal(made.get("dimensionality"), merged.get("dimensionality"))
    assert not monitor.warnings


def test_lines_surfaces_and_volumes_of_two_scanners_are_separated(rng):
    """The best neighborhoods are smaller than 50 points, and 50 points give the smoother picture, as published."""
    kinds = {"ground": "PLANAR", "wall": "PLANAR", "wire": "LINEAR", "crown": "VOLUMETRIC"}
    shares, chosen = {}, {}
    for neighborhood in ("nearest", "optimal"):
        clouds, inner = two_scans(rng)
        made = run_pipeline(PIPELINES["interpret_structure"], clouds, features_neighborhood=neighborhood).cloud
        assert len(made) < 0.6 * sum(len(cloud) for cloud in clouds)
        xyz, found = made.to_map(made.get("xyz")) - [600_000, 5_000_000, 0], made.get("dimensionality")
        for name, (low, high) in inner.items():
            inside = ((xyz > low) & (xyz < high)).all(axis=1)
            shares[neighborhood, name] = (found[inside] == Dimensionality[kinds[name]]).mean()
        chosen[neighborhood] = made.get("optimal_neighbors")
    assert (chosen["nearest"] == 50).all()
    assert chosen["optimal"].min() >= 10
    assert chosen["optimal"].mean() < 50
    assert min(shares["nearest", name] for name in kinds) > 0.9
    assert shares["optimal", "wire"] > 0.95
    for name in ("ground", "wall", "crown"):
        assert shares["optimal", name] < shares["nearest", name]


@pytest.mark.parametrize("stop_at", [0.01, 0.3, 0.5, 0.65])
def test_a_cancel_gets_through_at_once(stop_at):
    monitor = Listening(stop_at)
    with pytest.raises(Cancelled):
        run_pipeline(PIPELINES["detect_buildings"], made()[0], monitor)
    assert sum(fraction >= stop_at for fraction in monitor.heard) == 1


def test_automatic_values_and_warnings_of_all_steps_come_together():
    monitor = Monitor()
    run_pipeline(PIPELINES["detect_buildings"], made()[0], monitor)
    assert {
        "ground_iteration_distance",
        "roofs_density",
        "buildings_density",
        "roofs_noise",
        "buildings_building_entropy",
    } <= set(monitor.values)


def test_a_refusal_of_a_step_gets_through():
    cloud = create_cloud({"xyz": np.outer(np.arange(50.0), [1, 0, 0])})
    with pytest.raises(ValueError, match="lie on one line"):
        run_pipeline(PIPELINES["detect_buildings"], cloud)


# --- all kinds of stages in one chain --------------------------------------------------------------------------------


@pytest.fixture
def toys(monkeypatch):
    """The toy stages among the stages."""
    for name, stage in TOYS.items():
        monkeypatch.setitem(STAGES, name, stage)


def square(side=10.0, height=0.0):
    """Return a cloud of a lattice with a block of 20 m in its middle."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(side), np.arange(side)))
    z = np.where((np.abs(x - side / 2) < 2) & (np.abs(y - side / 2) < 2), 20.0, 2.0) + height
    return create_cloud({"xyz": np.column_stack([x, y, z]), "classification": np.full(len(x), 2)})


OLD = LayerFeatures([[np.array([[1, 1], [3, 1], [3, 3], [1, 3], [1, 1]], float)]], {"id": [1]})


def test_a_chain_merges_branches_and_keeps(toys):
    clouds = [square(), square(height=1.0)]
    results = run_pipeline(TOY_MAPPING, clouds, input_layers={"old": OLD})
    assert [len(cloud) for cloud in clouds] == [100, 100]
    assert len(results.cloud) == 200
    assert list(results.clouds) == ["lift_output", "high_output"]
    high = results.clouds["high_output"]
    assert len(high) == 18
    # The second cloud is 1 m higher and lifted by the chain's own half meter.
    assert sorted(set(high.get("xyz")[:, 2])) == [20.0, 21.5]
    # The last step that writes works on the lifted cloud again, where the kept one has no cluster ids.
    assert not results.clouds["lift_output"].has("cluster_id")
    assert np.bincount(results.cloud.get("cluster_id")).tolist() == [182, 0, 0, 0, 0, 0, 0, 18]
    assert high.get("cluster_id").tolist() == list(range(1, 19))
    assert list(results.layers) == ["footprints", "arrows"]
    assert list(results.rasters) == ["top", "floor"]
    assert np.nanmax(results.rasters["top"].values) == 21.5
    assert results.reports == {"report": results.report}
    # From (2, 2), the old map's middle, to (5, 5), the block's.
    assert results.report.values["longest"] == pytest.approx(3 * np.sqrt(2))


def test_layers_are_asked_for_before_anything_runs(toys, calls):
    with pytest.raises(ValueError, match=r"^Old map \(old\) is missing; choose a layer\.$"):
        run_pipeline(TOY_MAPPING, [square(), square()])
    with pytest.raises(ValueError, match=r"^toy_mapping reads no layer 'areas'; it reads old, extra\.$"):
        run_pipeline(TOY_MAPPING, [square(), square()], input_layers={"old": OLD, "areas": OLD})
    assert calls == []


def test_outputs_that_would_have_one_name_have_their_steps(toys):
    twice = Pipeline(
        "twice", "Twice", "Toys", "", "", "", "",
        (Step("lift", "toy_lift"), Step("one", "toy_outline"), Step("two", "toy_outline"), Step("tops", "toy_heights")),
        kept=("lift",),
    )  # fmt: skip
    assert [output.name for output in twice.outputs] == ["output", "one_footprints", "two_footprints", "top", "floor"]
    assert list(run_pipeline(twice, square()).layers) == ["one_footprints", "two_footprints"]


def test_what_is_kept_is_not_changed_by_later_steps(toys):
    steps = (Step("first", "toy_lift", {"step": 1.0}), Step("second", "toy_lift", {"step": 3.0}))
    cloud = square()
    results = run_pipeline(Pipeline("two", "Two", "Toys", "", "", "", "", steps, kept=("first",)), cloud)
    assert results.cloud is cloud
    assert set(cloud.get("height_above_ground")) == {6.0, 24.0}
    assert set(results.clouds["first_output"].get("height_above_ground")) == {2.0, 20.0}


def test_a_chain_of_layers_needs_no_cloud(toys):
    arrows = Pipeline("arrows", "Arrows", "Toys", "", "", "", "", (Step("arrows", "toy_arrows"),))
    assert not arrows.reads_cloud
    results = run_pipeline(arrows, input_layers={"old": OLD, "new": OLD})
    assert results.cloud is None
    assert results.report.values == {"longest": 0.0}


def faults(pipeline):
    """Return what is wrong with a pipeline's wiring."""
    earlier, found = {}, []
    for step in pipeline.steps:
        stage = step.stage
        if step.cloud and (step.cloud not in earlier or not earlier[step.cloud].makes_cloud):
            found.append(f"{step.name} works on the cloud of {step.cloud}, which makes none before it")
        if pipeline.merges and not stage.merges and pipeline.cloud_of(step) == "":
            found.append(f"{step.name} can't work on several clouds")
        geometries = {input_layer.name: input_layer.geometry for input_layer in stage.input_layers}
        for input_layer, fed in step.layers.items():
            layers = {f"{name}.{layer.name}": layer for name, one in earlier.items() for layer in one.layers}
            if fed not in layers or geometries.get(input_layer) != layers[fed].geometry:
                found.append(f"{step.name} reads {fed} as {input_layer}, which does not fit")
        for input_layer in stage.input_layers:
            if input_layer.name not in step.layers and pipeline.input_layers[input_layer.name] != input_layer:
                found.append(f"two steps ask for different layers by the name {input_layer.name}")
        earlier[step.name] = stage
    found += [
        f"{name} keeps no cloud" for name in pipeline.kept if name not in earlier or not earlier[name].makes_cloud
    ]
    names = [
        *pipeline.parameters,
        *pipeline.input_layers,
        *(output.name for output in pipeline.outputs),
        "input",
        "inputs",
    ]
    return found + [f"{name} is two things" for name in set(names) if names.count(name) > 1]


@pytest.mark.parametrize("pipeline", [*PIPELINES.values(), TOY_MAPPING], ids=lambda pipeline: pipeline.name)
def test_the_wiring_of_every_chain_is_sound(toys, pipeline):
    assert faults(pipeline) == []


@pytest.mark.parametrize(
    ("wrong", "fault"),
    [
        ({"steps": (Step("one", "toy_outline"), Step("two", "toy_lift", cloud="one"))}, "makes none before it"),
        ({"steps": (Step("one", "toy_merge"), Step("two", "toy_lift", cloud="three"))}, "makes none before it"),
        ({"steps": (Step("one", "toy_lift"), Step("two", "toy_merge"))}, "can't work on several clouds"),
        ({"steps": (Step("two", "toy_mask", layers={"areas": "one.footprints"}),)}, "does not fit"),
        ({"steps": (Step("one", "toy_lift"),), "kept": ("two",)}, "keeps no cloud"),
        ({"steps": (Step("old", "toy_arrows"), Step("top", "toy_arrows"))}, ""),
    ],
)
def test_faults_in_the_wiring_are_seen(toys, wrong, fault):
    found = faults(Pipeline("wrong", "", "", "", "", "", "", **wrong))
    assert bool(found) == bool(fault)
    assert fault in " ".join(found)


@pytest.mark.parametrize("pipeline", PIPELINES.values(), ids=lambda pipeline: pipeline.name)
def test_layers_that_are_switched_off_are_outputs_and_not_all_of_them(pipeline):
    layers = {one.name for one in pipeline.outputs if one.of in [layer.name for layer in one.step.stage.layers]}
    assert set(pipeline.switched_off) <= {*layers, CLOUD}
    assert not layers or not layers <= set(pipeline.switched_off)


_WITH_THREADS = """
import sys, conftest, numpy as np
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.threads import use_threads
use_threads(int(sys.argv[1]))
made = run_pipeline(PIPELINES["detect_buildings"], create_cloud({"xyz": np.load(sys.argv[2])}))
write_cloud(made.cloud, sys.argv[3])
outlines = made.layers["footprints"].geometries
print(len(outlines), [ring.tolist() for rings in outlines for ring in rings])
"""


def test_any_number_of_threads_gives_the_same_bytes(tmp_path):
    """Also those that compress the file, which has three chunks."""
    np.save(tmp_path / "xyz.npy", hamlet(density=30)[0])
    made = []
    for count in ("1", "3"):
        file = tmp_path / f"{count}.laz"
        command = [sys.executable, "-c", _WITH_THREADS, count, str(tmp_path / "xyz.npy"), str(file)]
        environment = {**os.environ, "RAYON_NUM_THREADS": count}
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        made.append((done.stdout, file.read_bytes()))
    assert made[0][0].startswith("2 ")
    assert made[0] == made[1]
