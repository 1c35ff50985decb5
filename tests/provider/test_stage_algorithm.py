"""Any stage as an algorithm: run through Processing, with paths, layers, temporaries and errors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from qgis.core import (
    QgsApplication,
    QgsFeatureRequest,
    QgsPointCloudLayer,
    QgsProcessingException,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingOutputLayerDefinition,
    QgsProcessingUtils,
    QgsProject,
    QgsProperty,
    QgsVectorLayer,
    QgsVectorLayerCache,
    QgsWkbTypes,
)
from qgis.gui import QgsAttributeTableModel
from qgis.PyQt.QtCore import Qt

from lidar_buildings.algorithms import packages
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.provider import cloud_algorithm, clouds, errors, named_clouds
from lidar_buildings.tests.provider.helpers import run, squares


def heights(path):
    return sorted(set(read_cloud(path).get("height_above_ground").tolist()))


@pytest.mark.parametrize("name", ["lifted.las", "lifted.laz", "lifted.copc.laz"])
def test_a_path_goes_in_and_a_cloud_comes_out(provider, context, log, town_file, out, name):
    result = run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / name)}, context, log)
    assert result == {"OUTPUT": str(out / name), "BASE_USED": 10.0}
    assert type(result["BASE_USED"]) is float
    assert heights(out / name) == [3.0, 9.0]
    assert [path.name for path in out.iterdir()] == [name]


def test_the_log_has_automatic_values(provider, context, log, town_file, out):
    run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.las")}, context, log)
    assert "Base, automatic: 10 m" in log.infos


def test_the_log_has_what_is_taken_of_an_earlier_run(provider, context, log, town_file, out):
    run("toyoutline", {"INPUT": str(town_file), "FOOTPRINTS": str(out / "a.gpkg")}, context, log)
    assert not [one for one in log.infos if "earlier run" in one]
    run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.las")}, context, log)
    run("toyoutline", {"INPUT": str(out / "a.las"), "FOOTPRINTS": str(out / "b.gpkg")}, context, log)
    assert "The cloud has HeightAboveGround of an earlier run; they are taken as they are." in log.infos


@pytest.mark.parametrize(
    ("name", "given", "whole"),
    [
        ("clipcloud", {}, True),
        ("filterpoints", {}, True),
        ("filterpoints", {"DIMENSION": "Z"}, True),
        ("filterpoints", {"DIMENSION": "Z", "LOW": -1.0}, True),
        ("filterpoints", {"CLASSES": "6"}, False),
        ("clipcloud", {"EXTENT": "0,1e6,0,1e6"}, False),
        ("toylift", {}, False),
    ],
)
def test_a_selection_of_everything_is_reported(provider, context, log, town_file, out, name, given, whole):
    run(name, {"INPUT": str(town_file), "OUTPUT": str(out / "a.las"), **given}, context, log)
    sentence = "All 400 points stay: nothing that is set leaves any out."
    assert log.warnings == [sentence] * whole


def test_the_log_has_four_digits_and_the_results_seven(provider, context, log, out):
    xyz = np.column_stack([np.arange(9.0), np.arange(9.0), np.full(9, 12345.678)])
    write_cloud(create_cloud({"xyz": xyz, "classification": np.full(9, 2)}, "EPSG:28992"), out / "in.las")
    result = run("toylift", {"INPUT": str(out / "in.las"), "OUTPUT": str(out / "a.las")}, context, log)
    assert "Base, automatic: 12,350 m" in log.infos
    assert result["BASE_USED"] == 12345.68


def test_a_given_value_is_returned_and_not_called_automatic(provider, context, log, town_file, out):
    result = run("toylift", {"INPUT": str(town_file), "BASE": 4, "OUTPUT": str(out / "a.las")}, context, log)
    assert result["BASE_USED"] == 4.0
    assert not [line for line in log.infos if "automatic" in line]
    assert heights(out / "a.las") == [9.0, 15.0]


def test_every_kind_of_tunable_arrives(provider, context, log, town_file, out):
    given = {"STEP": 2, "TIMES": 1, "SIGN": "down", "ONLY": ["building"], "FLAT": False, "BASE": None}
    run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.las"), **given}, context, log)
    assert heights(out / "a.las") == [0.0, 4.0]


def test_values_as_text_and_expressions_arrive(provider, context, log, town_file, out):
    given = {"STEP": "2", "TIMES": QgsProperty.fromExpression("3 - 2"), "ONLY": "building", "FLAT": "false", "BASE": ""}
    run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.las"), **given}, context, log)
    assert heights(out / "a.las") == [0.0, 8.0]


@pytest.fixture
def layer(town_file, tmp_path, context):
    """The square as a layer of the project (COPC, which every build of QGIS opens)."""
    path = tmp_path / "input" / "layer.copc.laz"
    write_cloud(read_cloud(town_file), path)
    layer = QgsPointCloudLayer(str(path), "the square", "copc")
    assert layer.isValid()
    context.project().addMapLayer(layer)
    return layer


@pytest.mark.parametrize("how", ["object", "id", "name", "source", "expression"])
def test_a_layer_goes_in_by_any_name(provider, context, log, layer, out, how):
    given = {
        "object": layer,
        "id": layer.id(),
        "name": layer.name(),
        "source": layer.source(),
        "expression": QgsProperty.fromExpression(f"'{layer.source()}'"),
    }[how]
    run("toylift", {"INPUT": given, "OUTPUT": str(out / "a.laz")}, context, log)
    assert heights(out / "a.laz") == [3.0, 9.0]


def test_a_virtual_point_cloud_goes_in(provider, context, log, town, tmp_path, out):
    import json

    features = []
    for i, half in enumerate((town["xyz"][:, 0] < 85_010, town["xyz"][:, 0] >= 85_010)):
        write_cloud(create_cloud({k: v[half] for k, v in town.items()}, wkt="EPSG:28992"), tmp_path / f"{i}.laz")
        features.append({"type": "Feature", "assets": {"data": {"href": f"./{i}.laz"}}, "properties": {}})
    vpc = tmp_path / "town.vpc"
    vpc.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    run("toylift", {"INPUT": str(vpc), "OUTPUT": str(out / "a.laz")}, context, log)
    assert len(read_cloud(out / "a.laz")) == 400
    assert heights(out / "a.laz") == [3.0, 9.0]


def test_a_temporary_output_is_uncompressed_and_feeds_the_next_stage(provider, context, log, town_file):
    first = run("toylift", {"INPUT": str(town_file), "OUTPUT": "TEMPORARY_OUTPUT"}, context, log)["OUTPUT"]
    assert first.endswith(".las")
    footprints = run("toyoutline", {"INPUT": first, "FOOTPRINTS": "TEMPORARY_OUTPUT"}, context, log)["FOOTPRINTS"]
    layer = QgsProcessingUtils.mapLayerFromString(footprints, context)
    assert next(layer.getFeatures())["height"] == pytest.approx((49 * 9 + 351 * 3) / 400)


def test_footprints_have_geometry_fields_and_crs(provider, context, log, town_file, out):
    target = out / "footprints.gpkg"
    run("toyoutline", {"INPUT": str(town_file), "FOOTPRINTS": str(target)}, context, log)
    assert "Footprints: 1" in log.infos
    layer = QgsVectorLayer(str(target), "footprints", "ogr")
    assert layer.crs().authid() == "EPSG:28992"
    assert layer.wkbType() == QgsWkbTypes.Type.Polygon
    names = ["id", "height", "kind"]
    feature = next(layer.getFeatures(QgsFeatureRequest()))
    assert [feature[name] for name in names[::2]] == [7, "box"]
    assert not feature["height"], "NaN is NULL in a layer"
    geometry = feature.geometry()
    assert geometry.isGeosValid()
    assert geometry.area() == pytest.approx(19 * 19 * 0.75)
    assert geometry.boundingBox().xMinimum() == 85_000
    assert geometry.boundingBox().yMaximum() == 446_019


def test_a_comparison_gives_a_page_and_plain_numbers(provider, context, log, town_file, town, tmp_path, out):
    lower = tmp_path / "lower.las"
    write_cloud(create_cloud({"xyz": town["xyz"] - [0, 0, 2]}), lower)
    page = out / "page.html"
    result = run("toycompare", {"INPUT": str(town_file), "REFERENCE": str(lower), "REPORT": str(page)}, context, log)
    assert result["DIFFERENCE"] == pytest.approx(2.0)
    assert (type(result["DIFFERENCE"]), type(result["POINTS"])) == (float, int)
    assert "2.000" in page.read_text()


def test_a_cloud_is_not_compared_with_itself(provider, context, town_file, tmp_path):
    """The dialog begins with the same layer for both, and the page said that everything is right."""
    link = tmp_path / "link.las"
    link.symlink_to(town_file)
    for reference in (town_file, link):
        parameters = {"INPUT": str(town_file), "REFERENCE": str(reference)}
        algorithm = QgsApplication.processingRegistry().createAlgorithmById("lidarbuildings:toycompare")
        is_fine, why = algorithm.checkParameterValues(parameters, context)
        assert not is_fine
        assert why == f"{reference.name} is the point cloud and its reference at once; choose two clouds."


def test_a_report_is_not_needed(provider, context, log, town_file, reference_file):
    result = run("toycompare", {"INPUT": str(town_file), "REFERENCE": str(reference_file)}, context, log)
    assert result == {"DIFFERENCE": 0.0, "POINTS": 400}


@pytest.mark.parametrize(("least", "is_shown"), [(1, True), (1000, False)])
def test_a_layer_without_features_is_loaded_switched_off(provider, context, log, town_file, out, least, is_shown):
    target = shown(out / "a.gpkg", context)
    run("extractfootprints", {"INPUT": str(town_file), "FOOTPRINTS": target, "MIN_AREA": least}, context, log)
    (path,) = context.layersToLoadOnCompletion()
    layer = QgsVectorLayer(path, "Footprints", "ogr")
    QgsProject.instance().addMapLayer(layer)
    context.layerToLoadOnCompletionDetails(path).postProcessor().postProcessLayer(layer, context, log)
    assert (layer.featureCount() > 0) == is_shown
    assert QgsProject.instance().layerTreeRoot().findLayer(layer.id()).itemVisibilityChecked() == is_shown


def test_a_skipped_layer_is_not_written(provider, context, log, out):
    result = run("toymake", {"OUTPUT": str(out / "made.laz")}, context, log)
    assert set(result) == {"OUTPUT"}
    assert [path.name for path in out.iterdir()] == ["made.laz"]
    assert len(read_cloud(out / "made.laz")) == 10


def test_a_made_cloud_has_its_layer(provider, context, log, out):
    result = run("toymake", {"OUTPUT": str(out / "made.laz"), "TRUTH": str(out / "truth.gpkg")}, context, log)
    layer = QgsVectorLayer(result["TRUTH"], "truth", "ogr")
    assert QgsWkbTypes.hasZ(layer.wkbType())
    assert next(layer.getFeatures()).geometry().asWkt(0) in ("Point Z (1 2 3)", "PointZ (1 2 3)")


def wrong(**change):
    return change


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (wrong(STEP=0), "Step (STEP) must be greater than 0 m and at most 10 m, got 0.0."),
        (wrong(STEP=11), "Step (STEP) must be greater than 0 m and at most 10 m, got 11.0."),
        (wrong(STEP="much"), "Step (STEP) must be a number, got 'much'."),
        (wrong(TIMES=1.5), "Times (TIMES) must be a whole number, got 1.5."),
        (wrong(SIGN="left"), "Sign (SIGN) must be one of up, down, got 'left'."),
        (wrong(INPUT=""), "Point cloud (INPUT) is missing; choose a point cloud."),
        (
            wrong(INPUT="nowhere.laz"),
            "Point cloud (INPUT) must be a point cloud file or layer; nothing was found at nowhere.laz.",
        ),
        (wrong(OUTPUT="{input}"), "is also an input; choose another name."),
        (
            wrong(OUTPUT="{out}/a.txt"),
            "a.txt can't be written as a point cloud: give it the extension .las, .laz or .copc.laz.",
        ),
        (wrong(OUTPUT="{out}/none/a.laz"), "does not exist; make it or choose another one."),
    ],
)
def test_what_is_wrong_is_reported_in_one_sentence_before_and_in_the_run(
    provider, context, log, town_file, out, change, sentence
):
    parameters = {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz"), **change}
    filled = {"input": town_file, "out": out}
    parameters = {k: v.format(**filled) if isinstance(v, str) else v for k, v in parameters.items()}
    algorithm = provider.algorithm("toylift").create()
    accepted, message = algorithm.checkParameterValues(parameters, context)
    assert not accepted
    assert message.endswith(sentence)
    # A model's child is run without that check.
    results, ok = algorithm.run(parameters, context, log)
    assert not ok
    assert any(sentence in error for error in log.errors), log.errors
    assert not any("Traceback" in error for error in log.errors)
    assert list(out.iterdir()) == []


@pytest.mark.parametrize(("name", "meant"), [("toylift", "; is STEP meant?"), ("toychain", ".")])
def test_a_name_that_is_no_parameter_is_reported(provider, context, log, town_file, out, name, meant):
    """A slip on the command line would be a run with the default."""
    given = {"INPUT": str(town_file), "OUTPUT": str(out / "a.las"), "STEPP": 3}
    run(name, given, context, log)
    title = provider.algorithm(name).displayName()
    assert log.warnings == [f"STEPP is no parameter of '{title}', so it has no effect{meant}"]


def test_a_limit_that_is_not_set_is_not_called_automatic(provider, context, log, town_file, out):
    lifted = str(out / "lifted.las")
    run("toylift", {"INPUT": str(town_file), "OUTPUT": lifted}, context, log)
    run("filterpoints", {"INPUT": lifted, "OUTPUT": str(out / "a.las")}, context, log)
    assert f"Minimum height, none set, the cloud has: {heights(lifted)[0]:g} m" in log.infos


def test_two_outputs_may_not_be_one_file(provider, context, out):
    algorithm = provider.algorithm("toymake").create()
    given = {"OUTPUT": str(out / "a.laz"), "TRUTH": str(out / "a.laz")}
    accepted, message = algorithm.checkParameterValues(given, context)
    assert (accepted, "same file" in message) == (False, True)


def test_a_vector_layer_is_no_cloud(provider, context, out):
    layer = QgsVectorLayer("Point", "dots", "memory")
    context.project().addMapLayer(layer)
    accepted, message = (
        provider.algorithm("toylift")
        .create()
        .checkParameterValues({"INPUT": layer, "OUTPUT": str(out / "a.laz")}, context)
    )
    assert not accepted
    assert "must be a point cloud, got the layer 'dots'" in message


def test_an_error_of_the_core_is_its_sentence(provider, context, log, town_file, out):
    with pytest.raises(QgsProcessingException, match=r"^The field is empty; choose another.$"):
        run("toytrouble", {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}, context, log)
    assert list(out.iterdir()) == []


def test_a_fault_keeps_its_traceback(provider, context, log, town_file, out):
    with pytest.raises(QgsProcessingException, match=r"(?s)Traceback.*toys.*ZeroDivisionError: a fault"):
        run("toytrouble", {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz"), "KIND": "bug"}, context, log)
    assert list(out.iterdir()) == []


def test_too_little_memory_is_reported_in_a_sentence(provider, context, log, town_file, out):
    given = {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz"), "KIND": "memory"}
    with pytest.raises(QgsProcessingException, match="^This needs more memory than there is; cut the cloud into tiles"):
        run("toytrouble", given, context, log)
    assert list(out.iterdir()) == []


@pytest.mark.parametrize(("there", "reported"), [(159_999.0, True), (160_000.0, False), (float("inf"), False)])
def test_a_cloud_that_hardly_fits_into_memory_is_reported(
    provider, context, log, town_file, out, monkeypatch, there, reported
):
    monkeypatch.setattr(cloud_algorithm, "installed_memory", lambda: there)
    run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}, context, log)
    assert [warning.split(" may ")[0] for warning in log.warnings] == ["400 points"] * reported


def test_it_is_reported_before_the_cloud_is_read(provider, context, log, town_file, out, monkeypatch):
    def read(*arguments):
        raise MemoryError

    monkeypatch.setattr(cloud_algorithm, "installed_memory", lambda: 1.0)
    monkeypatch.setattr(named_clouds, "read_cloud", read)
    with pytest.raises(QgsProcessingException, match="^This needs more memory than there is"):
        run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}, context, log)
    assert [warning.split(" may ")[0] for warning in log.warnings] == ["400 points"]


def test_a_cancelled_stage_is_an_error_and_leaves_nothing(provider, context, log, town_file, out):
    with pytest.raises(QgsProcessingException, match="Cancelled; nothing was written"):
        run("toytrouble", {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz"), "KIND": "cancel"}, context, log)
    assert list(out.iterdir()) == []


def test_the_user_can_cancel(provider, context, log, town_file, out):
    log.cancel()
    assert run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}, context, log) == {}
    assert list(out.iterdir()) == []


def test_on_the_command_line_a_cancel_is_an_error(provider, context, log, town_file, out, monkeypatch):
    """Otherwise its exit code would be 0."""
    monkeypatch.setattr(errors, "on_command_line", lambda: True)
    log.cancel()
    with pytest.raises(QgsProcessingException, match="Cancelled; nothing was written"):
        run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}, context, log)


def shown(path, context):
    definition = QgsProcessingOutputLayerDefinition(str(path), context.project())
    definition.destinationName = "lifted"
    return definition


@pytest.mark.skipif(clouds.reads_las(), reason="this build of QGIS shows LAZ itself")
@pytest.mark.parametrize("name", ["a.laz", "a.las"])
def test_without_pdal_a_copc_is_shown_in_place_of_the_result(provider, context, log, town_file, out, name):
    run("toylift", {"INPUT": str(town_file), "OUTPUT": shown(out / name, context)}, context, log)
    loaded = context.layersToLoadOnCompletion()
    assert list(loaded) == [str(out / "a.copc.laz")]
    assert loaded[str(out / "a.copc.laz")].name == "lifted"
    assert loaded[str(out / "a.copc.laz")].postProcessor() is not None, "its style comes along"
    layer = QgsPointCloudLayer(str(out / "a.copc.laz"), "lifted", "copc")
    assert layer.isValid()
    assert layer.pointCount() == 400
    assert heights(out / name) == heights(out / "a.copc.laz")


@pytest.mark.parametrize("name", ["toylift", "toychain"])
def test_the_copc_beside_the_result_may_not_be_the_input(provider, context, layer, log, name):
    """A result x.laz takes the COPC x.copc.laz next to it away; once that was the composite's own input."""
    target = str(Path(layer.source()).with_name("layer.laz"))
    accepted, message = (
        provider.algorithm(name).create().checkParameterValues({"INPUT": layer, "OUTPUT": target}, context)
    )
    assert not accepted
    assert "would take the place of the input layer.copc.laz" in message
    with pytest.raises(QgsProcessingException):
        run(name, {"INPUT": layer.source(), "OUTPUT": target}, context, log)
    assert Path(layer.source()).is_file()


def test_a_layer_is_styled_when_it_is_loaded(provider, context, log, town_file, out):
    lifted = run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.las")}, context, log)["OUTPUT"]
    run("toyoutline", {"INPUT": lifted, "FOOTPRINTS": shown(out / "f.gpkg", context)}, context, log)
    (path,) = context.layersToLoadOnCompletion()
    layer = QgsVectorLayer(path, "f", "ogr")
    context.layerToLoadOnCompletionDetails(path).postProcessor().postProcessLayer(layer, context, log)
    assert layer.labelsEnabled()
    assert not log.warnings
    height = layer.fields().indexOf("height")
    assert [layer.attributeDisplayName(i) for i in (0, height)] == ["fid", "height (m)"]
    cache = QgsVectorLayerCache(layer, 10)
    table = QgsAttributeTableModel(cache)
    table.loadLayer()
    # 49 points at 9 m and 351 at 3 m, in single precision.
    assert table.data(table.index(0, height), Qt.ItemDataRole.DisplayRole) == "3.735"


@pytest.mark.parametrize(
    ("name", "given", "expected"),
    [
        ("toyoutline", "Footprints", "Footprints (town)"),
        ("toyoutline", "My houses", "My houses"),
        ("toychain", "Footprints", "Footprints (town)"),
    ],
)
def test_layers_are_named_after_what_they_are_of(provider, context, log, town_file, out, name, given, expected):
    """Two runs gave two layers "Footprints"."""
    definition = shown(out / "f.gpkg", context)
    definition.destinationName = given
    cloud = {"OUTPUT": str(out / "a.las")} if name == "toychain" else {}
    run(name, {"INPUT": str(town_file), "FOOTPRINTS": definition, **cloud}, context, log)
    (details,) = context.layersToLoadOnCompletion().values()
    assert details.name == expected


def test_missing_packages_are_reported_everywhere(provider, context, log, town_file, out, monkeypatch):
    monkeypatch.setattr(packages, "missing", lambda needed: ["lazrs"])
    algorithm = provider.algorithm("toylift").create()
    parameters = {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}
    can, sentence = algorithm.canExecute()
    assert not can
    assert "missing: lazrs" in sentence
    assert "-m pip install --upgrade --no-deps --target" in sentence
    assert sentence.endswith("'lazrs>=0.6,<0.9'")
    assert provider.warningMessage() == sentence
    assert algorithm.checkParameterValues(parameters, context) == (False, sentence)
    results, ok = algorithm.run(parameters, context, log)
    assert not ok
    assert any(sentence in error for error in log.errors)
    assert provider.algorithm("toylift") is not None


def test_nothing_is_said_of_packages_that_are_there(provider):
    assert provider.warningMessage() == ""
    assert provider.algorithm("toylift").canExecute()[0]


def test_files_of_the_stage_are_gone_from_memory(provider, context, log, town_file, out):
    """The result stays when the input is removed: it holds a copy, no reference."""
    run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}, context, log)
    Path(town_file).unlink()
    assert np.isfinite(read_cloud(out / "a.laz").get("xyz")).all()


def test_buildings_are_assessed_with_polygons_in_place_of_a_reference_cloud(provider, context, log, town_file, out):
    polygons = squares((85_006.5, 446_006.5), size=7.0)
    context.project().addMapLayer(polygons)
    given = {"INPUT": str(town_file), "REFERENCE_MAP": polygons, "REPORT": str(out / "a.html")}
    result = run("assessbuildings", given, context, log)
    assert result["CELLS_COMPLETENESS"] == 100.0
    assert result["CELLS_CORRECTNESS"] == 100.0
    algorithm = provider.algorithm("assessbuildings").create()
    accepted, why = algorithm.checkParameterValues({"INPUT": str(town_file)}, context)
    assert accepted, why
    with pytest.raises(QgsProcessingException, match="There is no reference"):
        run("assessbuildings", {"INPUT": str(town_file)}, context, log)


def test_pages_are_named_after_their_algorithm_where_all_runs_are_listed(provider):
    for name, title in (("assessbuildings", "Assess buildings"), ("detectbuildings", "Detect buildings")):
        algorithm = provider.algorithm(name).create()
        assert algorithm.outputDefinition("REPORT").description() == f"Report ({title})"
        assert algorithm.parameterDefinition("REPORT").description() == "Report"


def test_outlines_that_are_selected_in_the_map_are_the_segments_that_get_the_class(provider, context, log, tmp_path):
    x, y = np.mgrid[0:20:0.5, 0:20:0.5].reshape(2, -1)
    segment = 1 + (x > 10) + 2 * (y > 10)
    arrays = {"xyz": np.column_stack([x, y, 3.0 * segment]), "segment_id": segment.astype(np.int32)}
    write_cloud(create_cloud(arrays, "EPSG:28992"), tmp_path / "in.las")
    given = {"INPUT": str(tmp_path / "in.las"), "OUTPUT": str(tmp_path / "classes.las")}
    path = run("classifysegments", {**given, "SEGMENTS": str(tmp_path / "s.gpkg")}, context, log)["SEGMENTS"]
    assert not np.any(read_cloud(given["OUTPUT"]).get("classification") == 2)
    layer = QgsVectorLayer(path, "Segments", "ogr")
    layer.selectByExpression("id in (2, 3)")
    QgsProject.instance().addMapLayer(layer)
    selected = QgsProcessingFeatureSourceDefinition(layer.id(), selectedFeaturesOnly=True)
    run("classifysegments", {**given, "SELECTION": selected}, context, log)
    QgsProject.instance().removeMapLayer(layer)
    classes = read_cloud(given["OUTPUT"]).get("classification")
    np.testing.assert_array_equal(classes == 2, np.isin(segment, (2, 3)))
