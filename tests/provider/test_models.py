"""Composites: the model, the chain in memory and the stages one by one give the same; drift is a failure."""

from __future__ import annotations

import re

import numpy as np
import pytest
from qgis.core import (
    Qgis,
    QgsProcessing,
    QgsProcessingException,
    QgsVectorLayer,
)

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.crs import NO_CRS
from lidar_buildings.algorithms.cloud.dimensions import DIMENSIONS
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.help import pipeline_help
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant
from lidar_buildings.algorithms.stage import Layer, LayerFeatures
from lidar_buildings.provider import models
from lidar_buildings.provider.clouds import CloudsParameter
from lidar_buildings.tests.provider.helpers import opened, run, squares, values_of
from lidar_buildings.tests.toys import TOY_CHAIN, TOY_MAPPING


def same_clouds(one, other):
    assert len(one) == len(other)
    for name in DIMENSIONS:
        assert one.has(name) == other.has(name), name
        if one.has(name):
            np.testing.assert_array_equal(one.get(name), other.get(name), err_msg=name)


def test_model_memory_and_single_steps_agree(provider, context, log, town_file, out):
    result = run(
        "toychain",
        {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz"), "FOOTPRINTS": str(out / "f.gpkg"), "SECOND_STEP": 0.5},
        context,
        log,
    )
    in_memory = run_pipeline(TOY_CHAIN, read_cloud(town_file), second_step=0.5)
    same_clouds(read_cloud(out / "a.laz"), in_memory.cloud)

    run(
        "toylift",
        {"INPUT": str(town_file), "OUTPUT": str(out / "1.las"), "STEP": 2.5, "ONLY": ["building"]},
        context,
        log,
    )
    run("toylift", {"INPUT": str(out / "1.las"), "OUTPUT": str(out / "2.las"), "TIMES": 3, "STEP": 0.5}, context, log)
    run("toyoutline", {"INPUT": str(out / "2.las"), "FOOTPRINTS": str(out / "g.gpkg"), "MARGIN": 1.0}, context, log)
    same_clouds(read_cloud(out / "2.las"), in_memory.cloud)

    features = [next(QgsVectorLayer(str(out / name), "f", "ogr").getFeatures()) for name in ("f.gpkg", "g.gpkg")]
    assert features[0].attributes() == features[1].attributes()
    assert features[0].geometry().equals(features[1].geometry())
    assert features[0]["height"] == pytest.approx(float(in_memory.layers["footprints"].columns["height"][0]))
    assert features[0].geometry().boundingBox().xMinimum() == 84_999
    assert result["FIRST_BASE_USED"] == 10.0
    assert {"OUTPUT", "FOOTPRINTS"} <= set(result)


@pytest.fixture(scope="module")
def village(tmp_path_factory):
    """A slope of 44 m with a gable and a flat roof, two trees, a bird and withheld points, in a LAZ file."""
    random = np.random.default_rng(5)
    x, y = (axis.ravel() + random.uniform(0, 0.3, axis.size) for axis in np.meshgrid(*[np.arange(0, 44, 0.5)] * 2))
    z = 12 + 0.02 * x
    gable = (np.abs(x - 12) < 6) & (np.abs(y - 14) < 5)
    z[gable] = 20 - 0.5 * np.abs(y - 14)[gable]
    flat = (np.abs(x - 32) < 7) & (np.abs(y - 14) < 6)
    z[flat] = 18.0
    tree = np.minimum(np.hypot(x - 34, y - 34), np.hypot(x - 10, y - 34)) < 4
    z[tree] += random.uniform(0, 9, tree.sum())
    z += random.normal(0, 0.02, len(z))
    z[77] = 150
    xyz = np.column_stack([x + 85_000, y + 446_000, z])
    path = tmp_path_factory.mktemp("village") / "village.laz"
    cloud = create_cloud({"xyz": xyz, "classification": np.ones(len(z), np.uint8)}, "EPSG:28992")
    cloud.header.layout.put(cloud.points, "withheld", np.arange(len(z)) < 50)
    write_cloud(cloud, path)
    return path


@pytest.mark.parametrize("name", ["detect_buildings", "detect_buildings_2019"])
def test_shipped_composites_give_in_qgis_what_they_give_in_memory(name, provider, context, log, village, out):
    pipeline = PIPELINES[name]
    given = {"INPUT": str(village), "OUTPUT": str(out / "a.laz"), "FOOTPRINTS": str(out / "f.gpkg")}
    result = run(pipeline.id, given, context, log)
    in_memory = run_pipeline(pipeline, read_cloud(village))
    same_clouds(read_cloud(out / "a.laz"), in_memory.cloud)

    cloud = village
    for i, step in enumerate(pipeline.steps_for([made.name for made in pipeline.outputs], given=())):
        given = {"INPUT": str(cloud), **{tunable.upper(): value for tunable, value in step.tunables.items()}}
        given = {key: list(value) if isinstance(value, tuple) else value for key, value in given.items()}
        if step.stage.writes:
            cloud = out / f"{i}.las"
            given["OUTPUT"] = str(cloud)
        given.update({layer.name.upper(): str(out / f"{layer.name}.gpkg") for layer in step.stage.layers})
        fed = [layer for layer in step.stage.input_layers if not layer.optional]
        given.update({layer.name.upper(): str(out / f"{layer.name}.gpkg") for layer in fed})
        run(step.stage.id, given, context, log)
    same_clouds(read_cloud(cloud), in_memory.cloud)

    features = list(QgsVectorLayer(result["FOOTPRINTS"], "f", "ogr").getFeatures())
    singly = list(QgsVectorLayer(str(out / "footprints.gpkg"), "f", "ogr").getFeatures())
    assert len(features) == len(singly) == len(in_memory.layers["footprints"]) > 0
    for one, other in zip(features, singly):
        assert one.attributes() == other.attributes()
        assert one.geometry().equals(other.geometry())


def test_the_published_chain_gives_its_rates_with_a_reference_only(context, log, village, out):
    run("detectbuildings2019", {"INPUT": str(village), "OUTPUT": str(out / "true.laz")}, context, log)
    given = {"INPUT": str(village), "FOOTPRINTS": str(out / "f.gpkg"), "OBJECTS": str(out / "o.gpkg")}
    rates = {
        "ASSESSMENT_POINTS_COMPLETENESS": 100.0,
        "ASSESSMENT_POINTS_CORRECTNESS": 100.0,
        "ASSESSMENT_POINTS_F": 100.0,
    }
    result = run("detectbuildings2019", {**given, "REFERENCE": str(out / "true.laz")}, context, log)
    # The classes that a cloud has may be the reference.
    again = {**given, "INPUT": str(out / "true.laz"), "REFERENCE": str(out / "true.laz")}
    assert "ASSESSMENT_POINTS_F" in run("detectbuildings2019", again, context, log)
    assert rates.items() <= result.items()
    assert "OBJECTS" in result
    assert not {*rates, "OBJECTS"} & set(run("detectbuildings2019", given, context, log))
    assert any("not given: Found, missed and invented buildings" in one for one in log.infos)


@pytest.mark.parametrize("name", ["detect_buildings", "model_buildings"])
def test_the_graph_gives_what_the_composite_gives_in_memory(name, provider, context, log, village, out):
    """As a model of the user's own, as the designer runs it: each step reads and writes files."""
    import processing

    pipeline = PIPELINES[name]
    algorithm = provider.algorithm(pipeline.id).create()
    graph = models.build_model(pipeline)
    graph.initAlgorithm()
    outputs = {made.title: made for made in algorithm.made}
    tunables = {"models_terrain_tolerance": 0.2} if name == "model_buildings" else {}
    given = {"INPUT": str(village), **{tunable.upper(): value for tunable, value in tunables.items()}}
    for definition in graph.destinationParameterDefinitions():
        made = outputs[definition.description()]
        kinds = {"output": ".laz", "report": ".html", "obj": ".obj"}
        suffix = ".gpkg" if isinstance(made.declared, Layer) else kinds.get(made.key.split("_")[-1], ".city.json")
        given[definition.name()] = str(out / f"{made.name.lower()}{suffix}")
    processing.run(graph, given, context=context, feedback=log, is_child_algorithm=True)

    expected = run_pipeline(pipeline, read_cloud(village), **tunables)
    same_clouds(read_cloud(out / "output.laz"), expected.cloud)
    assert len(expected.layers["footprints"]) == 2
    for layer, features in expected.layers.items():
        written = list(QgsVectorLayer(str(out / f"{layer}.gpkg"), layer, "ogr").getFeatures())
        assert len(written) == len(features) > 0, layer
        # Rings and walls may begin elsewhere: a step that reads a file has coordinates that differ in the last digit.
        corners = [[vertex.x(), vertex.y()] for one in written for vertex in one.geometry().vertices()]
        rings = expected.cloud.to_map(np.concatenate([np.concatenate(one)[:, :2] for one in features.geometries]))
        apart = np.linalg.norm(np.array(corners)[:, None] - rings, axis=2)
        assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 2e-3, layer


def test_structure_of_two_clouds_is_in_qgis_what_it_is_in_memory(provider, context, log, village, out):
    cloud = read_cloud(village)
    other = create_cloud({"xyz": cloud.to_map(cloud.get("xyz")) + [30.0, 5.0, 2.0]}, "EPSG:28992")
    write_cloud(other, out / "other.laz")
    given = {"INPUTS": [str(village), str(out / "other.laz")], "VOXELS_VOXEL_SIZE": 0.8, "OUTPUT": str(out / "a.laz")}
    result = run("interpretstructure", given, context, log)
    seconds = {name: value for name, value in result.items() if name.endswith("_SECONDS")}
    assert set(seconds) == {f"{step.name.upper()}_SECONDS" for step in PIPELINES["interpret_structure"].steps}
    assert seconds["FEATURES_SECONDS"] > 0
    assert result["REPORT_LEFT"] == pytest.approx(100 * result["REPORT_POINTS"] / result["REPORT_ORIGINAL_POINTS"])
    clouds = [read_cloud(village), read_cloud(out / "other.laz")]
    expected = run_pipeline(PIPELINES["interpret_structure"], clouds, voxels_voxel_size=0.8).cloud
    assert set(expected.get("dimensionality")) >= {2, 3}
    same_clouds(read_cloud(out / "a.laz"), expected)


@pytest.mark.parametrize("with_map", [True, False])
def test_footprints_mapped_in_qgis_are_those_mapped_in_memory(with_map, provider, context, log, village, out):
    old_map = squares((85_007.0, 446_009.0), size=10.0)
    context.project().addMapLayer(old_map)
    targets = {"OUTPUT": "a.laz", "ROOFS_OUTPUT": "r.laz", "WALL_FOOTPRINTS": "f.gpkg", "WALL_EDGES": "e.gpkg"}
    targets["REPORT"] = "r.html"
    given = {name: str(out / file) for name, file in {**targets, "DTM": "dtm.tif"}.items()}
    given.update({"INPUT": str(village), "OLD_MAP": old_map if with_map else None})
    result = run("mapfootprints", given, context, log)

    cloud = read_cloud(village)
    ring = np.array([[7, 9], [17, 9], [17, 19], [7, 19], [7, 9]], float) + [85_000, 446_000]
    drawn = LayerFeatures([[cloud.from_map(ring)]], {"id": [1]}) if with_map else None
    expected = run_pipeline(PIPELINES["map_footprints"], cloud, input_layers={"old_map": drawn})
    same_clouds(read_cloud(out / "a.laz"), expected.cloud)
    same_clouds(read_cloud(out / "r.laz"), expected.clouds["roofs_output"])
    footprints = list(QgsVectorLayer(result["WALL_FOOTPRINTS"], "f", "ogr").getFeatures())
    assert [f["area"] for f in footprints] == pytest.approx(expected.layers["wall_footprints"].columns["area"])
    assert {f["source"] for f in footprints} == {"roof"}
    edges = QgsVectorLayer(result["WALL_EDGES"], "e", "ogr")
    assert edges.featureCount() == len(expected.layers["wall_edges"]) > 0
    values, wanted = values_of(opened(result["DTM"])), expected.rasters["dtm"].values
    np.testing.assert_array_equal(np.where(values == -9999, np.nan, values), wanted)
    assert ("COMPARISON_FOUND" in result) == ("REPORT" in result) == with_map
    assert (out / "r.html").exists() == with_map
    if with_map:
        assert result["COMPARISON_FOUND"] == 1
        shift = [result[f"COMPARISON_MEAN_{axis}"] for axis in ("DX", "DY")]
        wanted_shift = [expected.report.values[name] for name in ("mean_dx", "mean_dy")]
        assert shift == pytest.approx(wanted_shift, abs=2e-3)


def test_the_models_own_defaults_count(provider, context, log, town_file, out):
    run(
        "toychain",
        {"INPUT": str(town_file), "OUTPUT": str(out / "a.las"), "FOOTPRINTS": QgsProcessing.TEMPORARY_OUTPUT},
        context,
        log,
    )
    made, cloud = read_cloud(out / "a.las"), read_cloud(town_file)
    same_clouds(made, run_pipeline(TOY_CHAIN, cloud).cloud)
    stages_own = {
        f"{step.name}_{name}": tunable.default
        for step in TOY_CHAIN.steps
        for name, tunable in step.stage.tunables.items()
        if name in step.tunables
    }
    other = run_pipeline(TOY_CHAIN, cloud, **stages_own).cloud
    assert not np.array_equal(made.get("height_above_ground"), other.get("height_above_ground"))


def test_the_composite_shows_the_steps_parameters(provider):
    algorithm = provider.algorithm("toychain").create()
    names = [definition.name() for definition in algorithm.parameterDefinitions()]
    assert names[:6] == ["INPUT", "SECOND_STEP", "SIGN", "FIRST_STEP", "FIRST_BASE", "FIRST_TIMES"]
    assert names[-2:] == ["OUTPUT", "FOOTPRINTS"]
    step = algorithm.parameterDefinition("FIRST_STEP")
    assert (step.description(), step.defaultValue(), step.minimum(), step.maximum()) == (
        "First: step (m)",
        2.5,
        0,
        10,
    )
    assert algorithm.parameterDefinition("FIRST_ONLY").defaultValue() == ["building"]
    assert algorithm.parameterDefinition("SECOND_TIMES").defaultValue() == 3
    advanced = Qgis.ProcessingParameterFlag.Advanced
    shown = [d.name() for d in algorithm.parameterDefinitions() if not d.flags() & advanced and not d.isDestination()]
    assert shown == ["INPUT", "SECOND_STEP", "SIGN", "EXTENT"]
    assert algorithm.parameterDefinition("SIGN").description() == "Sign"
    assert {output.name() for output in algorithm.outputDefinitions()} >= {"OUTPUT", "FOOTPRINTS", "FIRST_BASE_USED"}
    assert (algorithm.name(), algorithm.displayName(), algorithm.group()) == ("toychain", "Toy chain", "Toys")


def test_what_steps_share_goes_to_all_of_them(provider, context, log, town_file, out):
    given = {"INPUT": str(town_file), "OUTPUT": str(out / "a.las"), "SIGN": "down"}
    run("toychain", given, context, log)
    in_memory = run_pipeline(TOY_CHAIN, read_cloud(town_file), sign="down")
    same_clouds(read_cloud(out / "a.las"), in_memory.cloud)
    assert (in_memory.cloud.get("height_above_ground") < 0).any()


def test_each_step_is_announced_and_no_warning_is_repeated(provider, context, log, town, out):
    path = out / "nowhere.las"
    write_cloud(create_cloud(town), path)
    steps = []
    log.pushFormattedMessage = lambda html, text: steps.append((html, text))
    given = {"INPUT": str(path), "OUTPUT": str(out / "a.las"), "FOOTPRINTS": str(out / "f.gpkg")}
    run("toychain", given, context, log)
    assert [text.split(":")[0] for _, text in steps] == [
        "Reading",
        "Toy lift",
        "Toy lift",
        "Toy outline",
        "Writing",
    ]
    assert all(re.match(r"<b>[^<]+: \d+\.\d s</b>", html) for html, _ in steps)
    assert ["next: Toy lift" in text for _, text in steps] == [True, True, False, False, False]
    assert len(log.warnings) == 1
    assert "no coordinate reference system" in log.warnings[0]


def test_a_missing_crs_is_warned_of_once_for_clouds_layers_and_steps(provider, context, log, mapping, town, out):
    for path in mapping["INPUTS"]:
        write_cloud(create_cloud(town), path)
    old = squares((85_000.0, 446_000.0), crs="")
    context.project().addMapLayer(old)
    given = {**mapping, "OLD": old, "OUTPUT": str(out / "mask.laz"), "ARROWS": str(out / "arrows.gpkg")}
    run("toymapping", given, context, log)
    assert log.warnings == [NO_CRS]


def test_a_damaged_input_is_refused_before_qgis_opens_it(provider, context, town_file, out):
    """As a model's input QGIS opens it as a layer too, and a truncated COPC can hang it."""
    broken = out / "broken.copc.laz"
    write_cloud(read_cloud(town_file), broken)
    broken.write_bytes(broken.read_bytes()[:2000])
    given = {"INPUT": str(broken), "OUTPUT": str(out / "a.laz")}
    accepted, message = provider.algorithm("toychain").create().checkParameterValues(given, context)
    assert not accepted
    assert message.startswith("broken.copc.laz is truncated")


def test_a_copc_that_is_not_the_results_view_is_kept(provider, context, town_file, out):
    write_cloud(read_cloud(town_file), out / "a.copc.laz")
    given = {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}
    accepted, message = provider.algorithm("toychain").create().checkParameterValues(given, context)
    assert not accepted
    assert "a.copc.laz lies next to the output a.laz" in message
    assert (out / "a.copc.laz").is_file()


def test_the_composite_runs_without_its_layer(provider, context, log, town_file, out):
    run("toychain", {"INPUT": str(town_file), "OUTPUT": str(out / "a.las")}, context, log)
    assert [path.name for path in out.iterdir()] == ["a.las"]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"SECOND_STEP": 0}, "Step (SECOND_STEP) must be greater than 0 m and at most 10 m, got 0.0."),
        ({"OUTPUT": "{input}"}, "is also an input"),
        ({"INPUT": "nowhere.laz"}, "nothing was found at nowhere.laz"),
        ({"OUTPUT": "a.doc"}, "extension"),
    ],
)
def test_wrong_values_are_refused_at_once(provider, context, log, town_file, out, change, sentence):
    given = {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz"), **change}
    given = {k: v.format(input=town_file) if isinstance(v, str) else v for k, v in given.items()}
    accepted, message = provider.algorithm("toychain").create().checkParameterValues(given, context)
    assert not accepted
    assert sentence in message


@pytest.mark.parametrize("error", [ValueError, ZeroDivisionError])
def test_a_step_that_fails_leaves_nothing(provider, context, log, town_file, out, monkeypatch, error):
    """The cloud is written when the layer can't be."""
    from lidar_buildings.provider import cloud_algorithm

    def refused(*args):
        assert list(out.glob("*/a.laz"))
        assert not (out / "a.laz").exists()
        raise error("There is nothing to draw; look at the points first.")

    monkeypatch.setattr(cloud_algorithm, "write_layer", refused)
    with pytest.raises(QgsProcessingException, match="nothing to draw"):
        run(
            "toychain",
            {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz"), "FOOTPRINTS": str(out / "f.gpkg")},
            context,
            log,
        )
    assert list(out.iterdir()) == []


def test_a_second_run_in_the_same_context_runs_again(provider, context, log, town_file, out):
    """QGIS took the steps of the first run for the second one's and wrote nothing."""
    for name, margin in (("a.gpkg", 0.0), ("b.gpkg", 5.0)):
        given = {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz"), "FOOTPRINTS": str(out / name)}
        result = run("toychain", {**given, "OUTLINE_MARGIN": margin}, context, log)
        assert result["FOOTPRINTS"] == str(out / name)
    small, large = (next(QgsVectorLayer(str(out / name), "f", "ogr").getFeatures()) for name in ("a.gpkg", "b.gpkg"))
    assert large.geometry().boundingBox().width() == small.geometry().boundingBox().width() + 10.0


@pytest.fixture(params=[*PIPELINES, "toy_chain", "toy_mapping"])
def pipeline(request, provider):
    return PIPELINES[request.param]


def test_the_graph_is_the_chain(pipeline):
    model = models.build_model(pipeline)
    children = model.childAlgorithms()
    assert list(children) == sorted(step.name for step in pipeline.steps)
    cloud = None
    for step in pipeline.steps:
        fed = children[step.name].parameterSources()
        assert children[step.name].algorithm() is not None
        for input_layer in step.stage.input_layers:
            (layer,) = fed[input_layer.name.upper()]
            if input_layer.name in step.layers:
                assert f"{layer.outputChildId()}.{layer.outputName().lower()}" == step.layers[input_layer.name]
            else:
                assert layer.parameterName() == input_layer.name.upper()
        if not step.stage.reads_cloud:
            assert "INPUT" not in fed
            continue
        (source,) = fed["INPUTS" if step.stage.merges else "INPUT"]
        if cloud is None:
            assert source.source() == Qgis.ProcessingModelChildParameterSource.ModelParameter
        else:
            assert (source.outputChildId(), source.outputName()) == (step.cloud or cloud, "OUTPUT")
        cloud = step.name if step.stage.makes_cloud else cloud
    assert model.validate()[0], model.validate()[1]


def test_nothing_in_the_graph_overlaps(pipeline):
    model = models.build_model(pipeline)
    parts = [*model.parameterComponents().values(), *model.childAlgorithms().values()]
    parts += [output for child in model.childAlgorithms().values() for output in child.modelOutputs().values()]
    boxes = [(p.position().x(), p.position().y(), p.size().width(), p.size().height()) for p in parts]
    for i, (x, y, width, height) in enumerate(boxes):
        for u, v, other_width, other_height in boxes[:i]:
            assert abs(x - u) >= (width + other_width) / 2 or abs(y - v) >= (height + other_height) / 2


# --- A chain of all kinds of stages -----------------------------------------------------------------------------------


@pytest.fixture
def mapping(town, tmp_path, context):
    """What the mapping chain is given: the two halves of the square, and an old map in the project."""
    paths = []
    for name, half in (("west", town["xyz"][:, 0] < 85_010), ("east", town["xyz"][:, 0] >= 85_010)):
        paths.append(str(tmp_path / f"{name}.laz"))
        write_cloud(create_cloud({k: v[half] for k, v in town.items()}, wkt="EPSG:28992"), paths[-1])
    old = squares((85_000.0, 446_000.0))
    context.project().addMapLayer(old)
    return {"INPUTS": paths, "OLD": old}


KEPT = {
    "LIFT_OUTPUT": "lift.las",
    "HIGH_OUTPUT": "high.laz",
    "OUTPUT": "mask.laz",
    "FOOTPRINTS": "footprints.gpkg",
    "TOP": "top.tif",
    "FLOOR": "floor.tif",
    "ARROWS": "arrows.gpkg",
    "REPORT": "report.html",
}


def in_memory(given, **tunables):
    clouds = [read_cloud(path) for path in given["INPUTS"]]
    ring = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]], float)
    old = LayerFeatures([[clouds[0].from_map(ring + [85_000, 446_000])]], {"id": [1], "height": [1.0], "word": [""]})
    return run_pipeline(TOY_MAPPING, clouds, input_layers={"old": old}, **tunables)


def test_all_kinds_of_stages_give_in_qgis_what_they_give_in_memory(provider, context, log, mapping, out):
    given = {**mapping, **{name: str(out / file) for name, file in KEPT.items()}, "HEIGHTS_CELL_SIZE": 4.0}
    result = run("toymapping", given, context, log)
    expected = in_memory(mapping, heights_cell_size=4.0)
    assert sorted(path.name for path in out.iterdir()) == sorted(KEPT.values())
    assert {name: result[name] for name in KEPT} == {name: given[name] for name in KEPT}

    same_clouds(read_cloud(out / "mask.laz"), expected.cloud)
    same_clouds(read_cloud(out / "lift.las"), expected.clouds["lift_output"])
    same_clouds(read_cloud(out / "high.laz"), expected.clouds["high_output"])
    assert sorted(set(expected.cloud.get("cluster_id"))) == [0, 7]
    assert not expected.clouds["lift_output"].has("cluster_id"), "as the step left it"
    assert len(expected.clouds["high_output"]) == 49 < len(expected.cloud) == 400

    (footprint,) = QgsVectorLayer(result["FOOTPRINTS"], "f", "ogr").getFeatures()
    assert footprint["height"] == pytest.approx(float(expected.layers["footprints"].columns["height"][0]))
    for name in ("top", "floor"):
        values = values_of(opened(result[name.upper()]))
        np.testing.assert_array_equal(np.where(values == -9999, np.nan, values), expected.rasters[name].values)
    (arrow,) = QgsVectorLayer(result["ARROWS"], "a", "ogr").getFeatures()
    assert arrow["length"] == pytest.approx(expected.layers["arrows"].columns["length"][0])
    assert arrow.geometry().length() == pytest.approx(arrow["length"])
    # The roof's middle is at (10, 10), the old map's at (1, 1).
    assert arrow["length"] == pytest.approx(9 * np.sqrt(2))
    assert result["ARROWS_LONGEST"] == pytest.approx(expected.report.values["longest"])
    assert (out / "report.html").read_text() == expected.reports["report"].html


def test_what_is_not_kept_is_not_written(provider, context, log, mapping, out):
    result = run("toymapping", {**mapping, "OUTPUT": str(out / "mask.laz")}, context, log)
    assert [path.name for path in out.iterdir()] == ["mask.laz"]
    assert set(result) & set(KEPT) == {"OUTPUT"}
    same_clouds(read_cloud(out / "mask.laz"), in_memory(mapping).cloud)
    # Neither are numbers of steps that were not run.
    assert "ARROWS_LONGEST" not in result


def test_a_run_without_outputs_is_refused(provider, context, mapping):
    """It ran all steps, made nothing, and ended well."""
    accepted, message = provider.algorithm("toymapping").create().checkParameterValues(mapping, context)
    assert not accepted
    assert "has nothing to make; give at least one of its outputs: OUTPUT, FOOTPRINTS, ARROWS" in message


def test_layers_can_be_all_that_is_asked_for(provider, context, log, mapping, out):
    """The classified cloud had to be written to get footprints alone."""
    result = run("toymapping", {**mapping, "ARROWS": str(out / "arrows.gpkg")}, context, log)
    assert [path.name for path in out.iterdir()] == ["arrows.gpkg"]
    assert set(result) & set(KEPT) == {"ARROWS"}


def test_the_mapping_chain_shows_what_it_is_given_and_makes(provider):
    algorithm = provider.algorithm("toymapping").create()
    definitions = {definition.name(): definition for definition in algorithm.parameterDefinitions()}
    assert list(definitions)[:3] == ["INPUTS", "OLD", "EXTRA"]
    assert isinstance(definitions["INPUTS"], CloudsParameter)
    optional = Qgis.ProcessingParameterFlag.Optional
    assert [bool(definitions[name].flags() & optional) for name in ("OLD", "EXTRA")] == [False, True]
    made = algorithm.destinationParameterDefinitions()
    assert [d.name() for d in made][0] == "OUTPUT"
    assert {d.name() for d in made} == set(KEPT)
    assert {d.name() for d in made if d.flags() & optional} == set(KEPT)
    assert definitions["HIGH_OUTPUT"].description() == "High: selected points"
    # Clouds between the steps, and rasters, which would cover the result, are made for those who ask.
    assert {d.name() for d in made if not d.createByDefault()} == {"LIFT_OUTPUT", "HIGH_OUTPUT", "TOP", "FLOOR"}
    assert [d.name() for d in definitions.values() if not d.help() and not d.isDestination()] == []


def test_a_call_can_be_copied_as_python(provider, context, mapping, out):
    """QGIS writes no call of a model, and none of the files that it can't open itself."""
    given = {**mapping, "OLD": "old.gpkg", "OUTPUT": str(out / "mask.laz")}
    copied = provider.algorithm("toymapping").create().asPythonCommand(given, context)
    assert copied.startswith('processing.run("lidarbuildings:toymapping", {')
    assert f"'INPUTS':{mapping['INPUTS']!r}" in copied
    assert f"'OUTPUT':{given['OUTPUT']!r}" in copied


def test_the_dialog_begins_with_what_the_composite_is_for(provider):
    algorithm = provider.algorithm("mapfootprints").create()
    made = [d.name() for d in algorithm.destinationParameterDefinitions()]
    layers = ["WALL_FOOTPRINTS", "WALL_EDGES", "CANDIDATE_CORNERS", "DISPLACEMENTS", "BUILDINGS"]
    assert made[:6] == ["OUTPUT", *layers]
    assert made[6:11] == ["FOOTPRINTS_REPORT", "REPORT", "DTM", "DSM", "NDSM"]
    assert all(name.endswith("_OUTPUT") for name in made[11:])


def test_help_of_a_composite_describes_layers_and_what_is_kept():
    text = pipeline_help(TOY_MAPPING)
    assert "<b>OLD</b>: Old map, a layer of polygons. What it was." in text
    assert "<b>EXTRA</b>: Extra, a layer of points; may be left empty. Anything." in text
    assert "<b>AREAS</b>" not in text, "a step makes it"
    assert "<b>HIGH_OUTPUT</b>: the cloud as the step High leaves it." in text
    assert "<b>TOP</b>: Top (m), a raster." in text
    assert "<b>REPORT</b>: a page with Longest (m)" in text


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"OLD": None}, "Old map (OLD) is missing; choose a layer of polygons."),
        ({"INPUTS": []}, "Point clouds (INPUTS) are missing; choose a point cloud."),
        ({"HIGH_OUTPUT": "{one}"}, "is also an input; choose another name."),
        ({"TOP": "{out}/a.png"}, "a.png can't be written as a raster: give it the extension .tif."),
        ({"TOP": "{out}/a.tif", "FLOOR": "{out}/a.tif"}, "give each its own."),
        ({"HEIGHTS_CELL_SIZE": 0}, "Cell size (HEIGHTS_CELL_SIZE) must be at least 0.1 m, got 0.0."),
    ],
)
def test_what_is_wrong_with_a_mapping_is_refused_at_once(provider, context, mapping, out, change, sentence):
    def filled(value):
        if isinstance(value, list):
            return [filled(one) for one in value]
        return value.format(one=mapping["INPUTS"][0], out=out) if isinstance(value, str) else value

    given = {**mapping, "OUTPUT": str(out / "a.laz"), **{name: filled(value) for name, value in change.items()}}
    accepted, message = provider.algorithm("toymapping").create().checkParameterValues(given, context)
    assert not accepted
    assert message.endswith(sentence)


def test_a_map_of_any_of_several_clouds_is_not_elsewhere(provider, context, mapping, out):
    check = provider.algorithm("toymapping").create().checkParameterValues
    given = {**mapping, "OUTPUT": str(out / "a.laz")}
    # The second of the clouds begins at x = 85 010.
    east, elsewhere = squares((85_015.0, 446_003.0)), squares((85_030.0, 446_003.0))
    context.project().addMapLayers([east, elsewhere])
    assert check({**given, "OLD": east}, context) == (True, "")
    accepted, message = check({**given, "OLD": elsewhere}, context)
    assert not accepted
    assert message.startswith(
        "Old map and the point clouds don't overlap: x 85030 to 85032, y 446003 to 446005 against x 85000 to 85019, "
    )


def test_a_mapping_that_fails_late_leaves_nothing(provider, context, log, mapping, out, monkeypatch):
    from lidar_buildings.provider import cloud_algorithm

    def refused(self, *args):
        assert list(out.glob("*/footprints.gpkg"))
        raise ValueError("No page.")

    monkeypatch.setattr(cloud_algorithm._Writer, "write_pages", refused)
    given = {**mapping, **{name: str(out / file) for name, file in KEPT.items()}}
    with pytest.raises(QgsProcessingException, match="No page"):
        run("toymapping", given, context, log)
    assert list(out.iterdir()) == []


def test_a_model_finds_the_same_on_a_cloud_of_an_earlier_run(provider, context, log, tmp_path):
    """Of a plant with the Shape of an earlier run one axis of 66 was found."""
    xyz, _, segment_id, shape, *_ = simulate_plant(pipes=1, tanks=0, spheres=0, density=1000.0, clutter=False)
    found = []
    for number, old in enumerate(({}, {"segment_id": segment_id, "shape": shape})):
        write_cloud(create_cloud({"xyz": xyz, **old}), tmp_path / f"{number}.las")
        results = run(
            "modelindustry",
            {
                "INPUT": str(tmp_path / f"{number}.las"),
                "OUTPUT": str(tmp_path / f"made{number}.las"),
                "AXES": str(tmp_path / f"axes{number}.gpkg"),
            },
            context,
            log,
        )
        axes = QgsVectorLayer(results["AXES"])
        found.append(sorted(feature.geometry().asWkt() for feature in axes.getFeatures()))
    assert found[0]
    assert found[0] == found[1]
    assert [one for one in log.infos if one.startswith("Cleared")] == [
        "Cleared Shape, as earlier runs left it: SegmentID is numbered anew."
    ]
