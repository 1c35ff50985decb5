"""The kinds of stages besides those that write dimensions: selections, merged clouds, layers read, rasters made."""

from __future__ import annotations

import errno
import itertools
import os

import numpy as np
import pytest
from osgeo import gdal
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsGeometry,
    QgsPointCloudLayer,
    QgsProcessingException,
    QgsProcessingOutputLayerDefinition,
    QgsRasterLayer,
    QgsVectorFileWriter,
    QgsVectorLayer,
)

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.crs import NO_CRS
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.stage import InputLayer, Monitor, Raster, RasterSurface
from lidar_buildings.provider import cloud_algorithm, layer_outputs, rasters, stage_algorithm
from lidar_buildings.provider.given import Given
from lidar_buildings.provider.input_layers import GivenLayer, find_input_layer
from lidar_buildings.provider.places import place_of_cloud
from lidar_buildings.provider.styles import layer_style
from lidar_buildings.provider.vectors import qgis_features
from lidar_buildings.tests.provider.helpers import opened, run, squares, values_of, vector
from lidar_buildings.tests.toys import TOYS

FOOT = "EPSG:2234"


def refused(provider, name, given, context):
    accepted, message = provider.algorithm(name).create().checkParameterValues(given, context)
    assert not accepted
    return message


@pytest.mark.parametrize(("name", "own"), [("toylift", "INPUT"), ("toymerge", "INPUTS")])
def test_files_of_points_can_be_browsed_for(provider, name, own):
    algorithm = provider.algorithm(name).create()
    definition = algorithm.parameterDefinition(own)
    definition.setFlags(Qgis.ProcessingParameterFlag.Hidden)
    definition.setMetadata({"kept": 1})
    copy = definition.clone()
    assert type(copy) is type(definition)
    assert copy.help() == definition.help() != ""
    assert copy.flags() == Qgis.ProcessingParameterFlag.Hidden
    assert copy.metadata() == {"kept": 1}
    for each in (definition, copy):
        assert each.createFileFilter().startswith("Point clouds (*.las *.LAS *.laz *.LAZ *.vpc *.VPC *.json);;")
        assert each.checkValueIsAcceptable("tile.laz")
        assert not each.checkValueIsAcceptable("")


# --- selections and merged clouds -------------------------------------------------------------------------------------


def test_a_selection_is_written_with_its_points_moved(provider, context, log, town_file, out):
    given = {"INPUT": str(town_file), "OUTPUT": str(out / "roof.laz")}
    run("toykeep", given, context, log)
    roof = read_cloud(out / "roof.laz")
    assert len(roof) == 49
    assert set(roof.get("classification")) == {6}
    assert roof.get("cluster_id").tolist() == list(range(1, 50))
    assert set(roof.get("xyz")[:, 2]) == {16.0}
    run("toykeep", {**given, "OUTPUT": str(out / "low.las"), "SINK": 4}, context, log)
    assert set(read_cloud(out / "low.las").get("xyz")[:, 2]) == {12.0}


def test_a_dimension_is_named_as_text(provider, context, log, town_file, out):
    given = {"INPUT": str(town_file), "OUTPUT": str(out / "a.las")}
    run("toykeep", {**given, "DIMENSION": "classification", "LOW": 3}, context, log)
    assert len(read_cloud(out / "a.las")) == 49
    run("toykeep", {**given, "DIMENSION": "X", "LOW": 85_018}, context, log)
    assert len(read_cloud(out / "a.las")) == 40
    with pytest.raises(QgsProcessingException, match=r"^The cloud has no dimension 'Height'; it has X, Y, Z, Classif"):
        run("toykeep", {**given, "DIMENSION": "Height"}, context, log)


@pytest.fixture
def halves(town, tmp_path):
    """The square in two files of the same layout, west and east, and their layers."""
    paths = []
    for name, half in (("west", town["xyz"][:, 0] < 85_010), ("east", town["xyz"][:, 0] >= 85_010)):
        path = tmp_path / f"{name}.copc.laz"
        write_cloud(create_cloud({k: v[half] for k, v in town.items()}, wkt="EPSG:28992"), path)
        paths.append(path)
    return paths


@pytest.mark.parametrize("how", ["paths", "layers", "nested"])
def test_clouds_are_merged(provider, context, log, halves, out, how):
    layers = [QgsPointCloudLayer(str(path), path.stem, "copc") for path in halves]
    context.project().addMapLayers(layers)
    paths = [str(path) for path in halves]
    given = {"paths": paths, "layers": [layers[0], layers[1].id()], "nested": [[paths[0]], paths[1]]}[how]
    algorithm = provider.algorithm("toymerge").create()
    parameters = {"INPUTS": given, "OUTPUT": str(out / "a.laz")}
    assert algorithm.checkParameterValues(parameters, context) == (True, "")
    run("toymerge", parameters, context, log)
    merged = read_cloud(out / "a.laz")
    assert np.bincount(merged.get("point_source_id")).tolist() == [0, 200, 200]
    np.testing.assert_allclose(np.sort(merged.get("xyz")[:, 2]), np.repeat([10.0, 16.0], [351, 49]))
    assert merged.crs.plane == "EPSG:28992"


def test_merging_needs_clouds_that_are_no_output(provider, context, halves, out):
    west, east = map(str, halves)
    message = refused(provider, "toymerge", {"INPUTS": [], "OUTPUT": str(out / "a.laz")}, context)
    assert message == "Point clouds (INPUTS) are missing; choose a point cloud."
    assert "is also an input" in refused(provider, "toymerge", {"INPUTS": [west, east], "OUTPUT": east}, context)
    message = refused(provider, "toymerge", {"INPUTS": [west, "no.laz"], "OUTPUT": "a.laz"}, context)
    assert "nothing was found at no.laz" in message


# --- layers that are read ---------------------------------------------------------------------------------------------

BOX = "Polygon ((85004.5 446004.5, 85004.5 446009.5, 85009.5 446009.5, 85009.5 446004.5, 85004.5 446004.5))"


def test_a_layer_reaches_the_stage(provider, context, log, town_file, out):
    areas = vector("Polygon", [(BOX, [7, 1.5, "a"])])
    context.project().addMapLayer(areas)
    run("toymask", {"INPUT": str(town_file), "AREAS": areas, "OUTPUT": str(out / "a.las")}, context, log)
    cloud = read_cloud(out / "a.las")
    inside = cloud.to_map(cloud.get("xyz"))[cloud.get("cluster_id") == 7]
    assert len(inside) == 25
    np.testing.assert_array_equal(inside.min(axis=0)[:2], [85_005, 446_005])
    assert not log.warnings


@pytest.mark.parametrize("name", ["a" * 300 + ".las", "a" * 5000 + ".las"])
def test_a_name_that_no_file_can_have_is_a_sentence(provider, context, out, name):
    """It was an OSError with its traceback."""
    for given in ({"INPUT": str(out / name)}, {"INPUT": str(out / "a.las"), "OUTPUT": str(out / name)}):
        accepted, message = provider.algorithm("toylift").create().checkParameterValues(given, context)
        assert not accepted
        assert message.endswith((".", "…"))
        assert message.isprintable()


def test_an_optional_layer_may_be_left_out(provider, context, log, town_file, out):
    for given in ({}, {"AREAS": None}, {"AREAS": ""}):
        run("toymask", {"INPUT": str(town_file), "OUTPUT": str(out / "a.las"), **given}, context, log)
        assert not read_cloud(out / "a.las").get("cluster_id").any()


def test_a_layer_is_reprojected_to_the_cloud(provider, context, log, town_file, out):
    from qgis.core import QgsCoordinateTransform, QgsProject

    geometry = QgsGeometry.fromWkt(BOX)
    systems = [QgsCoordinateReferenceSystem(code) for code in ("EPSG:28992", "EPSG:4326")]
    geometry.transform(QgsCoordinateTransform(*systems, QgsProject.instance()))
    areas = vector("Polygon", [(geometry.asWkt(12), [7, 1.5, "a"])], "EPSG:4326")
    context.project().addMapLayer(areas)
    run("toymask", {"INPUT": str(town_file), "AREAS": areas, "OUTPUT": str(out / "a.las")}, context, log)
    assert (read_cloud(out / "a.las").get("cluster_id") == 7).sum() == 25


@pytest.fixture
def read(provider, context, town_file):
    """Return a layer as a stage would be given it, and the warnings, in meters from the town's origin."""

    def read(kind, rows, cloud=None, **options):
        input_layer = InputLayer("areas", "Areas", "Boxes.", kind, upright=options.pop("upright", False))
        layer = vector(options.pop("layer_kind", kind), rows, **options)
        context.project().addMapLayer(layer)
        algorithm = provider.algorithm("toymask").create()
        found = algorithm.parameterAsSource({"AREAS": layer}, "AREAS", context)
        monitor = Monitor()
        place = place_of_cloud(cloud or read_cloud(town_file))
        return GivenLayer(input_layer, found, context).read(place, monitor), monitor.warnings

    return read


def test_attributes_come_with_their_types(read):
    point = "Point (85001 446002)"
    found, _ = read("Point", [(point, [1, 2.5, "a"]), (point, [2, None, None]), (point, [3, 1.0, "c"])])
    assert found.columns["id"].tolist() == [1, 2, 3]
    assert found.columns["id"].dtype == np.int64
    np.testing.assert_array_equal(found.columns["height"], [2.5, np.nan, 1.0])
    assert found.columns["word"] == ["a", None, "c"]
    np.testing.assert_array_equal(found.geometries, [[1, 2]] * 3)
    found, _ = read("Point", [(point, [1, 2.5, "a"]), (point, [None, 1.0, "b"])])
    np.testing.assert_array_equal(found.columns["id"], [1, np.nan])


def test_parts_come_one_by_one_with_the_attributes_of_the_whole(read):
    two = "MultiPolygon (((85000 446000, 85001 446000, 85001 446001, 85000 446000)),"
    two += "((85005 446000, 85006 446000, 85006 446001, 85005 446000)))"
    found, warnings = read("Polygon", [(two, [4, 1.0, "x"]), (BOX, [5, 1.0, "y"])], layer_kind="MultiPolygon")
    assert found.columns["id"].tolist() == [4, 4, 5]
    assert [rings[0].shape for rings in found.geometries] == [(4, 2), (4, 2), (5, 2)]
    assert not warnings


def test_rings_turn_as_promised_and_keep_holes_and_heights(read):
    ring = "(85000 446000 5, 85000 446009 5, 85009 446009 5, 85009 446000 5, 85000 446000 5)"
    hole = "(85002 446002 5, 85003 446002 5, 85003 446003 5, 85002 446002 5)"
    found, _ = read("Polygon", [(f"PolygonZ ({ring}, {hole})", [1, 1.0, ""])], layer_kind="PolygonZ")
    ((outer, inner),) = found.geometries
    np.testing.assert_array_equal(
        outer, np.array([[0, 0, 5], [9, 0, 5], [9, 9, 5], [0, 9, 5], [0, 0, 5]])[[0, 1, 2, 3, 4]]
    )
    np.testing.assert_array_equal(inner, [[2, 2, 5], [3, 3, 5], [3, 2, 5], [2, 2, 5]])


def test_arcs_become_lines_and_measures_go(read):
    arc = "CurvePolygon (CircularString (85000 446000, 85010 446000, 85000 446000))"
    found, _ = read("Polygon", [(arc, [1, 1.0, ""])], layer_kind="CurvePolygon")
    (circle,) = found.geometries[0]
    assert len(circle) > 90
    np.testing.assert_allclose(np.hypot(*(circle - [5, 0]).T), 5, atol=1e-3)
    found, _ = read(
        "LineString", [("LineStringM (85000 446000 1, 85001 446000 2)", [1, 1.0, ""])], layer_kind="LineStringM"
    )
    np.testing.assert_array_equal(found.geometries[0], [[0, 0], [1, 0]])


def test_geometries_that_are_not_sound_are_counted(read):
    bow = "Polygon ((85000 446000, 85001 446001, 85001 446000, 85000 446001, 85000 446000))"
    rows = [(BOX, [1, 1.0, ""]), (bow, [2, 1.0, ""]), (None, [3, 1.0, ""]), ("Polygon EMPTY", [4, 1.0, ""])]
    found, warnings = read("Polygon", rows)
    assert found.columns["id"].tolist() == [1]
    assert warnings == ["Areas: 3 of 4 features are left out; they have no valid geometry of polygons."]


@pytest.mark.parametrize(
    ("kind", "upright", "wkt"),
    [
        ("Polygon", False, "Polygon ((85000 446000, 85001 446000, 85001 446001, 85000 446000), ())"),
        ("Polygon", True, "PolygonZ ((85000 446000 5, 85000 446000 5, 85000 446000 5, 85000 446000 5))"),
        ("Polygon", True, "PolygonZ ((85000 446000 5, 85000 446000 9, 85000 446000 5, 85000 446000 5))"),
        ("LineString", False, "LineStringZ (85000 446000 5, 85000 446000 5, 85000 446000 5)"),
        ("LineString", True, "LineStringZ (85000 446000 5)"),
        ("Polygon", True, "PolygonZ ((85000 446000 5, 85001 446000 1e300, 85001 446001 5, 85000 446000 5))"),
    ],
)
def test_rings_without_corners_are_not_sound(read, kind, upright, wkt):
    """They passed, and algorithms ended with errors of numpy."""
    sound = {"Polygon": BOX, "LineString": "LineString (85000 446000, 85001 446000)"}[kind]
    rows = [(sound, [1, 1.0, ""]), (wkt, [2, 1.0, ""])]
    found, warnings = read(kind, rows, layer_kind="PolygonZ" if kind == "Polygon" else "LineStringZ", upright=upright)
    assert found.columns["id"].tolist() == [1]
    assert len(warnings) == 1
    assert "1 of 2 features are left out" in warnings[0]


def test_an_empty_layer_has_its_columns(read):
    found, warnings = read("Polygon", [])
    assert (len(found), found.columns, warnings) == (0, {"id": [], "height": [], "word": []}, [])


def test_coordinates_are_meters_where_the_cloud_is_in_feet(read, town, tmp_path):
    write_cloud(create_cloud(town, QgsCoordinateReferenceSystem(FOOT).toWkt()), tmp_path / "feet.las")
    cloud = read_cloud(tmp_path / "feet.las")
    assert cloud.crs.horizontal == pytest.approx(0.3048, rel=1e-4)
    x, y = (cloud.to_map(np.array([[3.0, 4.0]]))[0]).tolist()
    found, warnings = read("Point", [(f"Point ({x!r} {y!r})", [1, 1.0, ""])], cloud, crs=FOOT)
    np.testing.assert_allclose(found.geometries, [[3, 4]], atol=1e-6)
    assert not warnings


def test_an_unknown_system_is_taken_as_the_same(read, town):
    point = "Point (85001 446002)"
    nowhere = create_cloud(town)
    nowhere.origin = np.array([85_000.0, 446_000.0, 0.0])
    found, warnings = read("Point", [(point, [1, 1.0, ""])], crs="")
    np.testing.assert_array_equal(found.geometries, [[1, 2]])
    assert [line.split(";")[0] for line in warnings] == ["Areas names no CRS"]
    found, warnings = read("Point", [(point, [1, 1.0, ""])], nowhere)
    np.testing.assert_array_equal(found.geometries, [[1, 2]])
    assert "EPSG:28992" in warnings[0]
    with pytest.raises(ValueError, match=r"^The coordinates of Areas are degrees \(EPSG:4326 - WGS 84\); reproject"):
        read("Point", [(point, [1, 1.0, ""])], nowhere, crs="EPSG:4326")


def test_a_stage_of_layers_alone_works_in_the_first_ones_system(provider, context, log, out):
    old, new = squares((85_000.0, 446_000.0)), squares((85_003.0, 446_004.0))
    context.project().addMapLayers([old, new])
    target = out / "arrows.gpkg"
    result = run("toyarrows", {"OLD": old, "NEW": new, "ARROWS": str(target)}, context, log)
    assert result["LONGEST"] == pytest.approx(5.0)
    layer = QgsVectorLayer(str(target), "arrows", "ogr")
    assert layer.crs().authid() == "EPSG:28992"
    (feature,) = layer.getFeatures()
    assert feature.geometry().asWkt(0) == "LineString (85001 446001, 85004 446005)"
    assert feature["length"] == pytest.approx(5.0)
    assert not log.warnings


def test_lengths_are_meters_where_layers_are_in_feet(provider, context, log, out):
    old, new = squares((3e6, 1e7), crs=FOOT), squares((3e6 + 300, 1e7 + 400), crs=FOOT)
    context.project().addMapLayers([old, new])
    result = run("toyarrows", {"OLD": old, "NEW": new, "ARROWS": str(out / "a.gpkg")}, context, log)
    assert result["LONGEST"] == pytest.approx(500 * 1200 / 3937)
    (feature,) = QgsVectorLayer(str(out / "a.gpkg"), "arrows", "ogr").getFeatures()
    assert feature.geometry().length() == pytest.approx(500)


def test_a_geopackage_without_a_system_is_in_that_of_the_other_layer(provider, context, log, out):
    """Its standard calls that "Undefined geographic SRS", from which QGIS would reproject as if it were degrees."""
    nowhere, path = squares((85_000.0, 446_000.0), crs=""), str(out / "nowhere.gpkg")
    options = QgsVectorFileWriter.SaveVectorOptions()
    assert QgsVectorFileWriter.writeAsVectorFormatV3(nowhere, path, QgsCoordinateTransformContext(), options)[0] == 0
    # QGIS before 3.44 holds that system for valid.
    stored, new = QgsVectorLayer(path, "stored", "ogr"), squares((85_003.0, 446_004.0))
    context.project().addMapLayers([stored, new])
    for first, second, warning in ((stored, new, NO_CRS), (new, stored, "New map names no CRS")):
        log.warnings.clear()
        result = run("toyarrows", {"OLD": first, "NEW": second, "ARROWS": str(out / "a.gpkg")}, context, log)
        assert result["LONGEST"] == pytest.approx(5.0)
        assert log.warnings[0].startswith(warning)


def test_layers_in_degrees_are_refused(provider, context, log, out):
    old = squares((5.0, 52.0), crs="EPSG:4326", size=0.001)
    context.project().addMapLayer(old)
    with pytest.raises(QgsProcessingException, match=r"^The coordinates of Old map are degrees"):
        run("toyarrows", {"OLD": old, "NEW": old, "ARROWS": str(out / "a.gpkg")}, context, log)


def test_what_is_no_layer_of_the_kind_is_refused(provider, context, out):
    old, dots = squares((85_000.0, 446_000.0)), vector("Point", [])
    context.project().addMapLayers([old, dots])
    given = {"OLD": old, "NEW": old, "ARROWS": str(out / "a.gpkg")}
    assert provider.algorithm("toyarrows").create().checkParameterValues(given, context) == (True, "")
    message = refused(provider, "toyarrows", {**given, "NEW": None}, context)
    assert message == "New map (NEW) is missing; choose a layer of polygons."
    message = refused(provider, "toyarrows", {**given, "NEW": "nowhere.gpkg"}, context)
    assert message == "New map (NEW) must be a vector layer; nothing was found at nowhere.gpkg."
    message = refused(provider, "toyarrows", {**given, "NEW": dots}, context)
    assert message == ("New map (NEW) must be a layer of polygons, got 'drawn' with point geometries; choose another.")


def test_a_layer_that_is_read_is_not_written(provider, context, log, out):
    old = squares((85_000.0, 446_000.0))
    context.project().addMapLayer(old)
    target = str(out / "arrows.gpkg")
    run("toyarrows", {"OLD": old, "NEW": old, "ARROWS": target}, context, log)
    run("toyoutline", {"INPUT": str(write_town(out)), "FOOTPRINTS": str(out / "f.gpkg")}, context, log)
    given = {"OLD": str(out / "f.gpkg"), "NEW": old, "ARROWS": str(out / "f.gpkg")}
    assert "is also an input" in refused(provider, "toyarrows", given, context)


def test_a_layer_outside_of_the_cloud_is_refused_before_any_work(provider, context, town_file, out):
    """A map of another place, or of this one in a wrong system, would show all its buildings as gone."""
    elsewhere = vector("Polygon", [(BOX.replace("8500", "9500"), [7, 1.5, "a"])])
    beyond = vector("Polygon", [("Polygon ((900 900, 910 900, 910 910, 900 900))", [7, 1.5, "a"])], crs="EPSG:4326")
    context.project().addMapLayers([elsewhere, beyond])
    given = {"INPUT": str(town_file), "OUTPUT": str(out / "a.las")}
    message = refused(provider, "toymask", {**given, "AREAS": elsewhere}, context)
    assert message.startswith(
        "Areas and the point cloud don't overlap: x 95004.5 to 95009.5, y 446004.5 to 446009.5 against x 85000"
    )
    assert message.endswith("; choose a layer of the same area, or check the coordinate reference systems of both.")
    message = refused(provider, "toymask", {**given, "AREAS": beyond}, context)
    assert message.startswith("Areas and the point cloud don't overlap: x 900 to 910, y 900 to 910 against x 4.")


def test_a_layer_of_the_whole_world_is_not_elsewhere(provider, context, log, town_file, out):
    """The box of the world, brought to a national system, isn't a box around the country."""
    places = ("-180 -90, -179 -90, -179 -89", "179 89, 180 89, 180 90", "4 51, 5 51, 4.5 53")
    world = [(f"Polygon (({place}, {place.split(',')[0]}))", [7, 1.5, "a"]) for place in places]
    areas = vector("Polygon", world, crs="EPSG:4326")
    context.project().addMapLayer(areas)
    run("toymask", {"INPUT": str(town_file), "OUTPUT": str(out / "a.las"), "AREAS": areas}, context, log)
    assert (out / "a.las").is_file()


def test_a_layer_without_a_sound_feature_is_refused(provider, context, log, town_file, out):
    """Nothing but crossed outlines is a broken layer; as an empty one it would be taken for a field without houses."""
    crossed = "Polygon ((85004 446004, 85009 446009, 85009 446004, 85004 446009, 85004 446004))"
    areas = vector("Polygon", [(crossed, [7, 1.5, "a"])] * 2)
    context.project().addMapLayer(areas)
    with pytest.raises(
        QgsProcessingException, match=r"^Areas has no usable feature: none of 2 has a valid geometry of"
    ):
        run("toymask", {"INPUT": str(town_file), "AREAS": areas, "OUTPUT": str(out / "a.las")}, context, log)
    assert list(out.iterdir()) == []


def write_town(folder):
    path = folder / "square.las"
    write_cloud(create_cloud({"xyz": np.array([[0.0, 0, 0], [9, 9, 9]])}, "EPSG:28992"), path)
    return path


# --- rasters ----------------------------------------------------------------------------------------------------------


def test_a_raster_is_a_cog_at_its_place(provider, context, log, town_file, out):
    result = run("toyheights", {"INPUT": str(town_file), "TOP": str(out / "top.tif")}, context, log)
    assert result == {"TOP": str(out / "top.tif")}
    assert [path.name for path in out.iterdir()] == ["top.tif"]
    image = opened(out / "top.tif")
    assert image.GetGeoTransform() == (85_000, 2, 0, 446_020, 0, -2)
    assert image.GetMetadata("IMAGE_STRUCTURE")["COMPRESSION"] == "DEFLATE"
    assert image.GetMetadata("IMAGE_STRUCTURE")["LAYOUT"] == "COG"
    band = image.GetRasterBand(1)
    assert (band.GetNoDataValue(), band.GetUnitType(), band.GetDescription()) == (-9999, "m", "Top")
    assert QgsCoordinateReferenceSystem.fromWkt(image.GetProjection()).authid() == "EPSG:28992"
    values = values_of(image)
    # The roof is from 7 to 13 m in both directions: columns begin at 0, 2, … m, rows end at 20, 18, … m.
    wanted = np.full((11, 10), 10.0)
    wanted[3:7, 3:7] = 16.0
    np.testing.assert_array_equal(values, wanted)


@pytest.mark.parametrize("nothing", [None, ""])
def test_results_named_without_a_file_are_not_made(provider, context, log, town_file, out, nothing):
    """``FLOOR=`` on the command line was an error that named no file."""
    given = {"INPUT": str(town_file), "TOP": str(out / "top.tif"), "FLOOR": nothing}
    assert run("toyheights", given, context, log) == {"TOP": str(out / "top.tif")}
    given = {"OUTPUT": str(out / "a.las"), "TRUTH": nothing}
    assert run("toymake", given, context, log) == {"OUTPUT": str(out / "a.las")}


def test_a_raster_in_feet_and_where_there_is_nothing(provider, context, log, town, tmp_path, out):
    write_cloud(create_cloud(town, QgsCoordinateReferenceSystem(FOOT).toWkt()), tmp_path / "feet.las")
    run("toypicture", {"INPUT": str(tmp_path / "feet.las"), "PICTURE": str(out / "a.tif")}, context, log)
    image = opened(out / "a.tif")
    west, step, _, north, _, _ = image.GetGeoTransform()
    foot = 1200 / 3937
    origin = read_cloud(tmp_path / "feet.las").origin
    assert (west * foot, north * foot, step * foot) == pytest.approx((*origin[:2], 3))
    assert values_of(image).tolist() == [[1.5, -9999]]
    layer = QgsRasterLayer(str(out / "a.tif"), "a")
    assert layer.isValid()
    assert layer.crs().authid() == FOOT


def test_big_rasters_are_tiled_with_overviews(context, tmp_path, town_file):
    values = np.add.outer(np.arange(1100.0), np.arange(1300.0)).astype(np.float32)
    values[:600, :700] = np.nan
    place = place_of_cloud(read_cloud(town_file))
    rasters.write_raster(Raster("a", "A"), RasterSurface(values, 0, 0, 1), place, tmp_path / "a.tif", Monitor())
    image = opened(tmp_path / "a.tif")
    band = image.GetRasterBand(1)
    assert band.GetBlockSize() == [512, 512]
    assert band.GetOverviewCount() >= 1
    np.testing.assert_array_equal(values_of(image), np.where(np.isnan(values), -9999, values))
    assert (tmp_path / "a.tif").stat().st_size < values.nbytes / 3
    overview = band.GetOverview(0)
    small = np.frombuffer(overview.ReadRaster(buf_type=gdal.GDT_Float32), np.float32)
    assert set(small[(small < 600)].tolist()) == {-9999}, "nothing is averaged with no data"


def test_rasters_have_a_style_when_they_are_loaded(provider, context, log, town_file, out, monkeypatch, tmp_path):
    from lidar_buildings.provider import styles

    (tmp_path / "top.qml").write_text("<qgis></qgis>")
    monkeypatch.setattr(styles, "STYLES", tmp_path)
    assert [layer_style(raster) for raster in TOYS["toy_heights"].rasters] == ["top", "top"]
    definition = QgsProcessingOutputLayerDefinition(str(out / "floor.tif"), context.project())
    run("toyheights", {"INPUT": str(town_file), "FLOOR": definition}, context, log)
    (path,) = context.layersToLoadOnCompletion()
    assert path == str(out / "floor.tif")
    assert context.layerToLoadOnCompletionDetails(path).postProcessor() is not None


def test_a_temporary_raster_is_a_tif(provider, context, log, town_file):
    result = run("toypicture", {"INPUT": str(town_file), "PICTURE": "TEMPORARY_OUTPUT"}, context, log)
    assert result["PICTURE"].endswith(".tif")
    assert opened(result["PICTURE"]).RasterXSize == 2


def test_only_tif_is_written(provider, context, town_file, out):
    given = {"INPUT": str(town_file), "PICTURE": str(out / "a.png")}
    message = refused(provider, "toypicture", given, context)
    assert message == "a.png can't be written as a raster: give it the extension .tif."
    given = {"INPUT": str(town_file), "TOP": str(out / "a.tif"), "FLOOR": str(out / "a.tif")}
    assert "same file" in refused(provider, "toyheights", given, context)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"FOOTPRINTS": "{out}/a.foo"}, "a.foo can't be written as a layer: give it the extension .gpkg, .shp or"),
        ({"FOOTPRINTS": "{out}/a"}, "a can't be written as a layer: give it the extension"),
        *(
            ({"FOOTPRINTS": f"{{out}}/a.{ending}"}, f"a.{ending} can't be written as a layer: give it the extension")
            for ending in ("csv", "xlsx", "ods", "dxf", "gpx", "json")
        ),
        ({"FOOTPRINTS": "{out}/folder.gpkg"}, "folder.gpkg is a folder; give the name of a file."),
        ({"FOOTPRINTS": "ogr:dbname='{out}/none/a.gpkg' table=\"a\" (geom)"}, "none does not exist; make it"),
        ({"FOOTPRINTS": "ogr:dbname='{out}/folder.gpkg' table=\"a\" (geom)"}, "folder.gpkg is a folder"),
    ],
)
def test_where_no_layer_can_be_written_is_reported_before_the_work(provider, context, town_file, out, change, sentence):
    (out / "folder.gpkg").mkdir()
    given = {"INPUT": str(town_file), **{name: value.format(out=out) for name, value in change.items()}}
    assert sentence in refused(provider, "toyoutline", given, context)


def test_a_table_is_added_to_a_file(provider, context, log, town_file, out):
    for name in ("a", "b"):
        target = f"ogr:dbname='{out}/all.gpkg' table=\"{name}\" (geom)"
        run("toyoutline", {"INPUT": str(town_file), "FOOTPRINTS": target}, context, log)
    for name in ("a", "b"):
        assert QgsVectorLayer(f"{out}/all.gpkg|layername={name}", name, "ogr").featureCount() > 0


@pytest.mark.parametrize(("name", "file"), [("OUTPUT", "a.laz"), ("PICTURE", "a.tif"), ("FOOTPRINTS", "a.gpkg")])
def test_a_full_disk_is_reported_before_the_work(provider, context, town_file, out, monkeypatch, name, file):
    class Full:
        def __enter__(self):
            return self

        def __exit__(self, *_):
            return None

        def write(self, _):
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("lidar_buildings.provider.run_outputs.tempfile.TemporaryFile", lambda dir: Full())
    algorithm = {"OUTPUT": "toylift", "PICTURE": "toypicture", "FOOTPRINTS": "toyoutline"}[name]
    message = refused(provider, algorithm, {"INPUT": str(town_file), name: str(out / file)}, context)
    assert message == f"The disk is full: {out / file} was not written; free some space or choose another folder."


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="root writes everywhere")
def test_a_read_only_folder_is_reported_before_the_work(provider, context, town_file, out):
    out.chmod(0o500)
    given = {"INPUT": str(town_file), "FOOTPRINTS": str(out / "a.gpkg")}
    assert "its folder is read-only" in refused(provider, "toyoutline", given, context)


def test_the_message_of_the_writer_of_a_layer_is_reported(provider, context, log, town_file, out, monkeypatch):
    """A disk that fills up while features are written."""

    class Full:
        def addFeature(self, *_):
            return False

        def lastError(self):
            return "no space"

    target = str(out / "a.gpkg")
    monkeypatch.setattr(stage_algorithm.StageAlgorithm, "parameterAsSink", lambda *_: (Full(), target))
    with pytest.raises(QgsProcessingException, match=r"can't be written to .*a\.gpkg \(no space\); free some space or"):
        run("toyoutline", {"INPUT": str(town_file), "FOOTPRINTS": target}, context, log)


@pytest.mark.parametrize("name", ["a.shp", "a.gpkg", "a.geojson", "a.tab"])
@pytest.mark.parametrize("n_written", [0, 10])
def test_a_layer_while_or_after_which_something_fails_is_removed(
    provider, context, log, out, monkeypatch, name, n_written
):
    """Of a shapefile the attributes stayed behind, of a GeoPackage its journal, which nobody had closed."""

    def some(*arguments):
        yield from itertools.islice(qgis_features(*arguments), n_written)
        raise ValueError("No more; look below.")

    monkeypatch.setattr(layer_outputs, "qgis_features", some)
    with pytest.raises(QgsProcessingException, match=r"^No more; look below.$"):
        run("toymake", {"OUTPUT": str(out / "a.las"), "TRUTH": str(out / name)}, context, log)
    assert list(out.iterdir()) == []


def test_a_raster_after_which_something_fails_is_removed(provider, context, log, town_file, out, monkeypatch):
    def later(raster, surface, place, path, monitor):
        if raster.name == "floor":
            assert list(out.glob("*/top.tif"))
            raise ValueError("No floor; look below.")
        rasters.write_raster(raster, surface, place, path, monitor)

    monkeypatch.setattr(cloud_algorithm, "write_raster", later)
    given = {"INPUT": str(town_file), "TOP": str(out / "top.tif"), "FLOOR": str(out / "floor.tif")}
    with pytest.raises(QgsProcessingException, match=r"^No floor; look below.$"):
        run("toyheights", given, context, log)
    assert list(out.iterdir()) == []


def test_a_cancel_while_a_raster_is_written_leaves_the_older_one(provider, context, log, town_file, out, monkeypatch):
    (out / "a.tif").write_bytes(b"older")
    monkeypatch.setattr(rasters._Progress, "__call__", stop)
    with pytest.raises(QgsProcessingException, match="Cancelled"):
        run("toypicture", {"INPUT": str(town_file), "PICTURE": str(out / "a.tif")}, context, log)
    assert [(path.name, path.read_bytes()) for path in out.iterdir()] == [("a.tif", b"older")]


def stop(progress, *_):
    progress.is_cancelled = True
    return 0


def test_gdals_own_words_are_reported(town_file, tmp_path, monkeypatch):
    before = gdal.GetUseExceptions()
    surface = RasterSurface(np.zeros((2, 2), np.float32), 0, 0, 1)
    place = place_of_cloud(read_cloud(town_file))
    with pytest.raises(ValueError, match=r"a\.tif can't be written \(.*No such file.*\); choose another folder"):
        rasters.write_raster(Raster("a", "A"), surface, place, tmp_path / "none" / "a.tif", Monitor())
    monkeypatch.setattr(rasters, "_OPTIONS", ("BLOCKSIZE=7",))
    with pytest.raises(ValueError, match=r"a\.tif can't be made \(.+\); choose larger cells"):
        rasters.write_raster(Raster("a", "A"), surface, place, tmp_path / "a.tif", Monitor())
    assert gdal.GetUseExceptions() == before
    assert not list(tmp_path.glob("*.tif*"))
    assert not gdal.ReadDir("/vsimem/")


def test_what_is_given_as_nothing_is_missing(provider, context):
    input_layer = TOYS["toy_arrows"].input_layers[0]
    with pytest.raises(ValueError, match="Old map"):
        find_input_layer(Given(provider.algorithm("toyarrows").create(), {}, context), input_layer)
