"""Styles load without complaint and know every class."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from osgeo import gdal
from qgis.core import (
    Qgis,
    QgsAbstract3DSymbol,
    QgsCoordinateReferenceSystem,
    QgsExpression,
    QgsExpressionContext,
    QgsFeature,
    QgsGeometry,
    QgsPointCloudLayer,
    QgsProcessingContext,
    QgsProcessingOutputLayerDefinition,
    QgsRasterLayer,
    QgsVectorLayer,
)
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QCoreApplication

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.dimensions import DIMENSIONS
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.features.classify_dimensionality import Dimensionality
from lidar_buildings.algorithms.quality import assess_footprints as footprints
from lidar_buildings.algorithms.quality import compare_corners as corners
from lidar_buildings.algorithms.quality import compare_surveys as surveys
from lidar_buildings.algorithms.quality import map_changes
from lidar_buildings.algorithms.quality.assess_buildings import FOUND, INVENTED, INVENTED_PART, MISSED, MISSED_PART
from lidar_buildings.algorithms.stage import Field
from lidar_buildings.algorithms.walls.extract_wall_footprints import ROOF, WALL
from lidar_buildings.provider.paths import STYLES
from lidar_buildings.provider.styles import (
    Styler,
    cloud_style,
    layer_style,
    load_from,
    name_after,
    put_below,
    show_on_load,
    stack_results,
    subject_of_file,
    switch_off,
)
from lidar_buildings.tests.provider.helpers import run, vector
from lidar_buildings.tests.toys import TOYS

OF_CLOUDS = sorted(path.stem for path in STYLES.glob("*.qml") if path.stem in DIMENSIONS)


@pytest.fixture(scope="module")
def cloud_file(town, tmp_path_factory):
    arrays = dict(town)
    for name in OF_CLOUDS:
        arrays.setdefault(name, np.zeros(400, DIMENSIONS[name].dtype))
    path = tmp_path_factory.mktemp("styles") / "all.copc.laz"
    write_cloud(create_cloud(arrays, "EPSG:28992"), path)
    return path


@pytest.mark.parametrize("stem", OF_CLOUDS)
def test_styles_of_clouds_load(stem, cloud_file, qgis_application):
    layer = QgsPointCloudLayer(str(cloud_file), stem, "copc")
    message, loaded = layer.loadNamedStyle(str(STYLES / f"{stem}.qml"))
    assert loaded, message
    assert layer.renderer().attribute() == DIMENSIONS[stem].disk[0]


def test_results_are_stacked_by_kind(context):
    """They were stacked by the names of their files: a cloud hid its footprints."""
    for path in ("a.gpkg", "b.laz", "c.tif", "d.gpkg"):
        context.addLayerToLoadOnCompletion(path, QgsProcessingContext.LayerDetails(path, context.project()))
    for path, kind in (("a.gpkg", "Polygon"), ("b.laz", "Cloud"), ("c.tif", "Raster"), ("d.gpkg", "LineString")):
        show_on_load(context, path, kind, Styler(None))
    load_from(context, lambda path: f"moved_{path}")
    keys = {path: details.layerSortKey for path, details in context.layersToLoadOnCompletion().items()}
    assert sorted(keys, key=keys.get) == ["moved_c.tif", "moved_b.laz", "moved_a.gpkg", "moved_d.gpkg"]


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 0, 2)])
def test_results_are_stacked_by_kind_among_other_layers_too(context, order):
    """Where a layer was selected, as after every run, QGIS put the cloud over its footprints again."""
    names = ("cloud", "polygons", "lines")
    layers = [QgsVectorLayer("Polygon", name, "memory") for name in names]
    others = [QgsVectorLayer("Polygon", name, "memory") for name in ("above", "below")]
    added = [others[0], *(layers[i] for i in order), others[1]]
    context.project().addMapLayers(added, False)
    for layer in added:
        context.project().layerTreeRoot().addLayer(layer)
    for layer, kind in zip(layers, ("Cloud", "Polygon", "LineString")):
        context.addLayerToLoadOnCompletion(layer.id(), QgsProcessingContext.LayerDetails("", context.project()))
        show_on_load(context, layer.id(), kind, Styler(None))
    stack_results(context)
    QCoreApplication.processEvents()
    drawn = [layer.name() for layer in context.project().layerTreeRoot().layerOrder()]
    assert drawn == ["above", "lines", "polygons", "cloud", "below"]
    assert len(context.project().mapLayers()) == len(added)


def test_clouds_are_drawn_in_3d_as_on_the_map(cloud_file, context, log):
    layer = QgsPointCloudLayer(str(cloud_file), "cloud", "copc")
    Styler("classification").postProcessLayer(layer, context, log)
    assert layer.renderer3D().symbol().symbolType() == "classification"


def test_footprints_lie_on_the_ground_in_3d(qgis_application):
    from qgis._3d import Qgs3D, QgsPolygon3DSymbol, QgsVectorLayer3DRenderer

    Qgs3D.initialize()
    layer = QgsVectorLayer("Polygon?field=height:double&field=ground_elevation:double", "f", "memory")
    layer.loadNamedStyle(str(STYLES / "footprints.qml"))
    symbol = sip.cast(sip.cast(layer.renderer3D(), QgsVectorLayer3DRenderer).symbol(), QgsPolygon3DSymbol)
    assert symbol.altitudeClamping() == Qgis.AltitudeClamping.Absolute
    properties = symbol.dataDefinedProperties()
    assert properties.property(QgsAbstract3DSymbol.Property.ExtrusionHeight).field() == "height"
    assert properties.property(QgsAbstract3DSymbol.Property.Height).field() == "ground_elevation"


def test_every_class_has_a_color(cloud_file, qgis_application):
    layer = QgsPointCloudLayer(str(cloud_file), "classes", "copc")
    layer.loadNamedStyle(str(STYLES / "classification.qml"))
    assert [category.value() for category in layer.renderer().categories()] == [int(code) for code in PointClass]
    colors = [category.color().name() for category in layer.renderer().categories()]
    assert len(set(colors)) == len(colors)


def test_every_reason_has_a_color_and_its_name(cloud_file, qgis_application):
    layer = QgsPointCloudLayer(str(cloud_file), "reasons", "copc")
    layer.loadNamedStyle(str(STYLES / "reason.qml"))
    shown = {category.value(): category.label() for category in layer.renderer().categories()}
    assert {number: name.rpartition(": ")[2].capitalize() for number, name in shown.items()} == {
        int(reason): reason.label for reason in Reason
    }
    assert all(name.startswith("Building: ") == Reason(number).is_building for number, name in shown.items())


def test_footprints_are_labeled(qgis_application):
    layer = QgsVectorLayer("Polygon?field=id:int&field=height:double", "f", "memory")
    message, loaded = layer.loadNamedStyle(str(STYLES / "footprints.qml"))
    assert loaded, message
    assert layer.labelsEnabled()


def test_a_feature_is_called_by_its_number_and_shows_what_matters_where_the_mouse_rests(context, log):
    fields = (Field("id", int, "number"), Field("height", float, "height", "m"), Field("reason", str, "why"))
    layer = QgsVectorLayer("Polygon?field=id:int&field=height:double&field=reason:string", "f", "memory")
    Styler(None, fields).postProcessLayer(layer, context, log)
    feature = QgsFeature(layer.fields())
    feature.setAttributes([7, 4.2345, None])
    of_feature = QgsExpressionContext()
    of_feature.setFeature(feature)
    assert QgsExpression(layer.displayExpression()).evaluate(of_feature) == 7
    tip = QgsExpression.replaceExpressionText(layer.mapTipTemplate(), of_feature)
    assert tip == "<b>7 · 4.2 m</b><br>"
    feature.setAttributes([8, None, "A solid plane"])
    of_feature.setFeature(feature)
    assert QgsExpression.replaceExpressionText(layer.mapTipTemplate(), of_feature) == "<b>8</b><br>A solid plane"


@pytest.mark.parametrize(
    ("stem", "field", "kinds"),
    [
        ("objects", "kind", {FOUND, MISSED, INVENTED, MISSED_PART, INVENTED_PART}),
        ("assessed_footprints", "status", set(footprints.COLORS)),
        ("compared_surveys", "status", set(surveys.COLORS)),
        ("regularized", "regularized", {0, 1}),
        ("updated_map", "status", set(map_changes.COLORS) - {map_changes.GONE}),
        ("compared_buildings", "status", {corners.FOUND, corners.MISSED, corners.NEW}),
    ],
)
def test_every_kind_has_a_style(stem, field, kinds, qgis_application):
    layer = QgsVectorLayer(f"Polygon?field={field}:string", "o", "memory")
    message, loaded = layer.loadNamedStyle(str(STYLES / f"{stem}.qml"))
    assert loaded, message
    assert layer.renderer().classAttribute() == field
    assert {category.value() for category in layer.renderer().categories()} == kinds


def test_walls_are_distinguished_from_roofs_and_edges_by_their_quality(qgis_application):
    layer = QgsVectorLayer("Polygon?field=source:string", "f", "memory")
    message, loaded = layer.loadNamedStyle(str(STYLES / "wall_footprints.qml"))
    assert loaded, message
    assert {category.value() for category in layer.renderer().categories()} == {WALL, ROOF}
    layer = QgsVectorLayer("LineString?field=quality:double", "e", "memory")
    message, loaded = layer.loadNamedStyle(str(STYLES / "wall_edges.qml"))
    assert loaded, message
    ranges = layer.renderer().ranges()
    assert [(one.lowerValue(), one.upperValue()) for one in ranges] == [(0, 0.25), (0.25, 0.5), (0.5, 0.75), (0.75, 1)]


def test_displacements_are_arrows_drawn_ten_times_as_long(qgis_application):
    layer = QgsVectorLayer("LineString", "d", "memory")
    message, loaded = layer.loadNamedStyle(str(STYLES / "displacements.qml"))
    assert loaded, message
    (rule,) = layer.renderer().rootRule().children()
    assert rule.label() == "Displacement × 10"
    expression = QgsExpression(rule.symbol().symbolLayer(0).geometryExpression())
    feature = QgsFeature()
    feature.setGeometry(QgsGeometry.fromWkt("LineString (600000 5000000, 600000.1 4999999.8)"))
    context = QgsExpressionContext()
    context.setFeature(feature)
    context.setGeometry(feature.geometry())
    assert expression.evaluate(context).asWkt(3) == "LineString (600000 5000000, 600001 4999998)"


def test_results_find_their_style(town):
    cloud = create_cloud(town)
    assert cloud_style(TOYS["toy_lift"], cloud) is None  # not asked for, so that there is nothing to draw
    cloud.set("height_above_ground", np.zeros(len(cloud), np.float32))
    assert cloud_style(TOYS["toy_lift"], cloud) == "height_above_ground"
    assert cloud_style(TOYS["toy_make"], cloud) == "classification"
    assert cloud_style(TOYS["toy_compare"], cloud) is None
    assert layer_style(TOYS["toy_outline"].layers[0]) == "footprints"
    assert layer_style(TOYS["toy_make"].layers[0]) is None


def test_every_kind_of_structure_has_a_color(cloud_file, qgis_application):
    layer = QgsPointCloudLayer(str(cloud_file), "structure", "copc")
    layer.loadNamedStyle(str(STYLES / "dimensionality.qml"))
    found = {category.value(): category.label().lower() for category in layer.renderer().categories()}
    assert found == {int(kind): kind.name.lower() for kind in Dimensionality}


@pytest.mark.parametrize(("stem", "kind"), [("terrain", "hillshade"), ("heights", "singlebandpseudocolor")])
def test_styles_of_rasters_load(stem, kind, tmp_path, qgis_application):
    path = tmp_path / "surface.tif"
    image = gdal.GetDriverByName("GTiff").Create(str(path), 4, 4, 1, gdal.GDT_Float32)
    image.GetRasterBand(1).WriteRaster(0, 0, 4, 4, np.arange(16, dtype=np.float32).tobytes())
    image = None
    layer = QgsRasterLayer(str(path), stem)
    message, loaded = layer.loadNamedStyle(str(STYLES / f"{stem}.qml"))
    assert loaded, message
    assert layer.renderer().type() == kind


def test_the_layers_of_a_run_make_a_group_that_is_named_after_its_input(context):
    from qgis.core import QgsProcessingContext, QgsProject

    for path, name in (("a.gpkg", "Footprints"), ("b.laz", "My own name")):
        details = QgsProcessingContext.LayerDetails(name, QgsProject.instance(), "OUTPUT")
        context.addLayerToLoadOnCompletion(path, details)
    name_after(context, ["Footprints", "Classified point cloud"], "delft")
    layers = context.layersToLoadOnCompletion()
    assert [(layers[path].name, layers[path].groupName) for path in ("a.gpkg", "b.laz")] == [
        ("Footprints", "delft"),
        ("My own name", "delft"),
    ]


def test_a_single_layer_makes_no_group(context):
    from qgis.core import QgsProcessingContext, QgsProject

    context.addLayerToLoadOnCompletion(
        "a.gpkg", QgsProcessingContext.LayerDetails("Footprints", QgsProject.instance(), "OUTPUT")
    )
    name_after(context, ["Footprints"], "delft")
    (details,) = context.layersToLoadOnCompletion().values()
    assert (details.name, details.groupName) == ("Footprints (delft)", "")


def test_results_are_named_after_the_layer_that_was_given(provider, context, log, town_file, tmp_path, out):
    """A layer with a name of its own gave results called after its file, OUTPUT."""
    write_cloud(read_cloud(town_file), tmp_path / "OUTPUT.copc.laz")
    layer = QgsPointCloudLayer(str(tmp_path / "OUTPUT.copc.laz"), "Delft", "copc")
    context.project().addMapLayer(layer)
    definition = QgsProcessingOutputLayerDefinition(str(out / "f.gpkg"), context.project())
    run("toyoutline", {"INPUT": layer.id(), "FOOTPRINTS": definition}, context, log)
    (details,) = context.layersToLoadOnCompletion().values()
    assert details.name == "Footprints (Delft)"


def test_styles_are_stored_in_a_geopackage(provider, context, log, town_file, out):
    """A GeoPackage that the command line had written came plain and pink."""
    run("toychain", {"INPUT": str(town_file), "FOOTPRINTS": str(out / "f.gpkg")}, context, log)
    layer = QgsVectorLayer(str(out / "f.gpkg"), "f", "ogr")
    count, _, names, *_ = layer.listStylesInDatabase()
    assert count == 2
    assert set(names) == {"Default", "Height"}
    assert layer.labelsEnabled(), "the style of footprints is the one that QGIS takes"
    assert "confidence" not in layer.mapTipTemplate()
    assert layer.displayExpression() == '"id"'


def test_styles_are_stored_by_the_method_that_newer_versions_of_qgis_have(
    provider, context, log, town_file, out, monkeypatch
):
    """QGIS 3.44 warned of a deprecated method with every layer in a GeoPackage."""
    stored = []

    def newer(layer, name, description, is_default, form):
        stored.append((name, is_default))
        return 0, ""

    monkeypatch.setattr(QgsVectorLayer, "saveStyleToDatabaseV2", newer, raising=False)
    run("toychain", {"INPUT": str(town_file), "FOOTPRINTS": str(out / "f.gpkg")}, context, log)
    assert stored == [("Height", False), ("Default", True)]


def test_a_layer_that_another_step_has_taken_further_is_loaded_switched_off(context):
    from qgis.core import QgsProcessingContext, QgsProcessingFeedback, QgsProject, QgsVectorLayer

    context.setProject(QgsProject.instance())
    layers = [QgsVectorLayer("Polygon", name, "memory") for name in ("helper", "result")]
    for layer in layers:
        QgsProject.instance().addMapLayer(layer)
        details = QgsProcessingContext.LayerDetails(layer.name(), QgsProject.instance(), "OUTPUT")
        context.addLayerToLoadOnCompletion(layer.id(), details)
        show_on_load(context, layer.id(), "Polygon", Styler("footprints"))
    switch_off(context, [layers[0].id(), "not loaded"])
    for layer in layers:
        context.layerToLoadOnCompletionDetails(layer.id()).postProcessor().postProcessLayer(
            layer, context, QgsProcessingFeedback()
        )
    root = QgsProject.instance().layerTreeRoot()
    assert [root.findLayer(layer.id()).itemVisibilityChecked() for layer in layers] == [False, True]
    QgsProject.instance().removeMapLayers([layer.id() for layer in layers])


def styles_of(layer):
    """Return the renderers of all styles of a layer by their names."""
    found = {}
    manager = layer.styleManager()
    current = manager.currentStyle()
    for name in manager.styles():
        manager.setCurrentStyle(name)
        found[name] = layer.renderer().clone()
    manager.setCurrentStyle(current)
    return found


def test_footprints_have_styles_to_switch(context, log):
    """There was one style only."""
    fields = "field=id:int&field=height:double&field=confidence:double&field=reason:string&field=empty:double"
    rows = [
        (f"Polygon (({x} 0, {x + 1} 0, {x} 1, {x} 0))", [x, 3.0 * x, 0.3 * x, reason, None])
        for x, reason in ((1, "Solid"), (2, "Plane"), (3, "Solid"))
    ]
    layer = vector("Polygon", rows, fields=fields)
    context.project().addMapLayer(layer)
    Styler("footprints", [Field("id", int, "")]).postProcessLayer(layer, context, log)
    assert layer.styleManager().currentStyle() == "default"
    found = styles_of(layer)
    assert list(found) == sorted(["default", "Height", "Confidence", "Reason"])
    assert found["default"].type() == "singleSymbol"
    assert [one.value() for one in found["Reason"].categories()] == ["Plane", "Solid"]
    ranges = found["Height"].ranges()
    assert ranges[0].lowerValue() <= 3.0
    assert ranges[-1].upperValue() >= 9.0
    assert [(one.lowerValue(), one.upperValue()) for one in found["Confidence"].ranges()] == [
        (0.0, 0.5),
        (0.5, 0.7),
        (0.7, 1.0),
    ]
    # The tips and labels are the same in all styles.
    layer.styleManager().setCurrentStyle("Reason")
    assert layer.mapTipTemplate()
    assert layer.labelsEnabled()


def test_clouds_have_styles_to_switch_by_the_dimensions_that_they_have(tmp_path, context, log):
    arrays = {"xyz": np.random.default_rng(1).uniform(0, 10, (50, 3)), "classification": np.full(50, 2, np.uint8)}
    cloud = create_cloud(arrays)
    cloud.set("height_above_ground", np.zeros(50, np.float32))
    write_cloud(cloud, tmp_path / "a.copc.laz")
    layer = QgsPointCloudLayer(str(tmp_path / "a.copc.laz"), "a", "copc")
    Styler("classification").postProcessLayer(layer, context, log)
    assert layer.styleManager().currentStyle() == "Class"
    found = styles_of(layer)
    assert {name: one.attribute() for name, one in found.items()} == {
        "Class": "Classification",
        "Height above ground": "HeightAboveGround",
    }


@pytest.mark.parametrize("highest", [3.0, 200.0])
def test_the_ramp_of_heights_follows_the_values(highest, tmp_path, context, log):
    """It ended at 40 m, whatever the raster held: villages were one color, and so were towers."""
    path = tmp_path / "ndsm.tif"
    values = np.linspace(0, highest, 100 * 100, dtype=np.float32).reshape(100, 100)
    image = gdal.GetDriverByName("GTiff").Create(str(path), 100, 100, 1, gdal.GDT_Float32)
    image.GetRasterBand(1).WriteRaster(0, 0, 100, 100, values.tobytes())
    del image
    layer = QgsRasterLayer(str(path), "ndsm")
    Styler("heights").postProcessLayer(layer, context, log)
    items = layer.renderer().shader().rasterShaderFunction().colorRampItemList()
    assert items[0].value == 0
    assert items[-1].value == pytest.approx(0.98 * highest, rel=0.01)
    assert items[1].value == pytest.approx(items[-1].value / 16)
    assert items[-1].label == f"{items[-1].value:.1f} m"


def test_a_raster_that_comes_alone_lies_below_what_is_there(context, tmp_path):
    """A new terrain covered the footprints of the run before."""
    gdal.GetDriverByName("GTiff").Create(str(tmp_path / "a.tif"), 2, 2, 1, gdal.GDT_Float32)
    footprints, raster = QgsVectorLayer("Polygon", "f", "memory"), QgsRasterLayer(str(tmp_path / "a.tif"), "terrain")
    project = context.project()
    group = project.layerTreeRoot().addGroup("run")
    project.addMapLayer(footprints, False)
    group.addLayer(footprints)
    project.addMapLayer(raster, False)
    project.layerTreeRoot().insertLayer(0, raster)
    put_below(raster, context)
    QCoreApplication.processEvents()
    assert [child.name() for child in project.layerTreeRoot().children()] == ["run", "terrain"]
    put_below(raster, context)
    assert [child.name() for child in project.layerTreeRoot().children()] == ["run", "terrain"]
    assert len(project.mapLayers()) == 2


def test_of_a_cloud_the_copc_that_is_loaded_is_switched_off(context):
    from qgis.core import QgsProject

    context.setProject(QgsProject.instance())
    details = QgsProcessingContext.LayerDetails("Cloud", QgsProject.instance(), "OUTPUT")
    context.addLayerToLoadOnCompletion("a.copc.laz", details)
    switch_off(context, ["a.laz"])
    assert context.layerToLoadOnCompletionDetails("a.copc.laz").postProcessor().is_off


def test_each_run_has_a_group_of_its_own(context):
    """A second run of the same input went into the group of the first, and hid its layers among those."""
    root = context.project().layerTreeRoot()
    names = []
    for _ in range(2):
        run = QgsProcessingContext()
        run.setProject(context.project())
        for path in ("a.gpkg", "b.laz"):
            run.addLayerToLoadOnCompletion(path, QgsProcessingContext.LayerDetails(path, context.project()))
        name_after(run, [], "delft", "Detect buildings")
        names.append(run.layersToLoadOnCompletion()["a.gpkg"].groupName)
        root.addGroup(names[-1])
    assert names == ["delft: Detect buildings", "delft: Detect buildings 2"]


def test_a_cloud_in_which_qgis_finds_no_system_gets_that_of_the_run(context, log, tmp_path):
    """Clouds of old formats name theirs by a code, which QGIS doesn't read of COPC: they lay nowhere."""
    write_cloud(create_cloud({"xyz": np.random.default_rng(1).uniform(0, 9, (50, 3))}), tmp_path / "bare.copc.laz")
    wkt = QgsCoordinateReferenceSystem("EPSG:28992").toWkt()
    layer = QgsPointCloudLayer(str(tmp_path / "bare.copc.laz"), "cloud", "copc")
    assert not layer.crs().isValid()
    Styler(None, crs=wkt).copy().postProcessLayer(layer, context, log)
    assert layer.crs().authid() == "EPSG:28992"
    write_cloud(create_cloud({"xyz": np.zeros((1, 3))}, wkt), tmp_path / "named.copc.laz")
    layer = QgsPointCloudLayer(str(tmp_path / "named.copc.laz"), "cloud", "copc")
    Styler(None, crs=QgsCoordinateReferenceSystem("EPSG:2154").toWkt()).postProcessLayer(layer, context, log)
    assert layer.crs().authid() == "EPSG:28992"


def test_a_single_layer_beside_groups_has_its_own(context):
    """QGIS put the objects of *Assess buildings* into the group of the models, which was the current one."""
    context.project().layerTreeRoot().addGroup("delft: Model buildings")
    context.addLayerToLoadOnCompletion("a.gpkg", QgsProcessingContext.LayerDetails("Objects", context.project()))
    name_after(context, ["Objects"], "delft", "Assess buildings")
    assert context.layersToLoadOnCompletion()["a.gpkg"].groupName == "delft: Assess buildings"


def test_runs_on_temporary_results_are_named_after_the_first_input(context):
    """Layers of chained runs were called "Footprints (OUTPUT)"."""
    context.addLayerToLoadOnCompletion("/tmp/x/OUTPUT.laz", QgsProcessingContext.LayerDetails("", context.project()))
    name_after(context, [], "delft", "Detect buildings")
    assert subject_of_file(Path("/tmp/x/OUTPUT.laz")) == "delft"
    assert subject_of_file(Path("/tmp/y/tile_1.copc.laz")) == "tile_1"


def test_simulated_layers_without_an_input_make_a_group_of_their_own(context):
    """They went into the group of another run."""
    for path in ("a.gpkg", "b.laz"):
        context.addLayerToLoadOnCompletion(path, QgsProcessingContext.LayerDetails("True axes", context.project()))
    name_after(context, ["True axes"], "", "Simulate plant")
    layers = context.layersToLoadOnCompletion()
    assert {(one.name, one.groupName) for one in layers.values()} == {("True axes", "Simulate plant")}
    assert subject_of_file(Path("b.laz")) == "b"
