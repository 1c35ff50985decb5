"""The review of doubtful buildings: keys, decisions that are stored and undone, and outlines that change."""

from __future__ import annotations

import sys
from datetime import datetime
from types import SimpleNamespace

import pytest
from qgis.core import (
    NULL,
    QgsFeatureRequest,
    QgsGeometry,
    QgsLineString,
    QgsPoint,
    QgsPointCloudLayer,
    QgsProcessingContext,
    QgsProcessingOutputLayerDefinition,
    QgsProject,
    QgsRectangle,
    QgsVector3D,
    QgsVectorFileWriter,
    QgsVectorLayer,
)
from qgis.gui import QgsMapToolPan
from qgis.PyQt.QtCore import QCoreApplication, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QDockWidget, QPushButton

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import write_cloud
from lidar_buildings.provider import styles
from lidar_buildings.provider.menu import offer_reviews
from lidar_buildings.provider.review import Review, changes_between
from lidar_buildings.provider.review_dock import show_review
from lidar_buildings.tests.provider.helpers import run, vector

FIELDS = "&".join(
    f"field={one}"
    for one in (
        "id:int",
        "area:double",
        "volume:double",
        "points:int",
        "confidence:double",
        "reason:string",
        "evidence:string",
    )
)
EVIDENCE = "38 % of the beam passes (limit 40 %)"


def value_of(layer, feature, name):
    """By the fields of the layer: a feature lacks those that were added in this edit."""
    at = layer.fields().lookupField(name)
    return None if at < 0 or feature[at] == NULL else feature[at]


def square(x, size=10):
    return f"Polygon (({x} 0, {x + size} 0, {x + size} {size}, {x} {size}, {x} 0))"


@pytest.fixture
def offers(qgis_iface):
    """Reviews are offered, as the plugin does in a desktop."""
    end = offer_reviews(qgis_iface)
    yield
    end()


@pytest.fixture
def layer(qgis_iface):
    """Footprints in a GeoPackage's way: two that touch, one apart, and one without a confidence."""
    rows = [
        (square(0), [1, 100.0, 300.0, 200, 0.9, "Solid plane", ""]),
        (square(10, 5), [2, 25.0, 50.0, 40, 0.6, "Rough", EVIDENCE]),
        (square(40), [3, 100.0, 200.0, 100, 0.3, "Penetrated", "<b>"]),
        (square(60), [4, 100.0, 200.0, 100, None, None, None]),
    ]
    layer = vector("Polygon", rows, fields=FIELDS)
    QgsProject.instance().addMapLayer(layer)
    yield layer
    QgsProject.instance().clear()


@pytest.fixture
def dock(layer, qgis_iface):
    dock = show_review(qgis_iface, layer)
    dock.setFloating(True)
    QApplication.setActiveWindow(dock)
    QTest.qWaitForWindowActive(dock)
    yield dock
    dock.close()
    dock.setParent(None)
    dock.deleteLater()


def listed(dock):
    return [dock.list.topLevelItem(i).text(0) for i in range(dock.list.topLevelItemCount())]


def decisions(layer):
    return {value_of(layer, one, "id"): value_of(layer, one, "review") for one in layer.getFeatures()}


def press(dock, key, modifier=Qt.KeyboardModifier.NoModifier):
    QTest.keyClick(dock.list, key, modifier)
    QCoreApplication.processEvents()


def current(dock):
    return dock.list.currentItem().text(0)


def test_decisions_are_fields_of_a_type_that_the_provider_names(layer):
    """PostGIS made no column of a type without a name, and the whole review was lost."""
    review = Review(layer, lambda _: None)
    review.decide(review.buildings()[0].id(), "kept")
    review.end()
    names = {one.mTypeName for one in layer.dataProvider().nativeTypes()}
    field = layer.fields().field("review")
    assert field.typeName() == "text"
    assert field.typeName() in names
    assert value_of(layer, review.buildings("\"review\" = 'kept'")[0], "review") == "kept"


def test_the_least_sure_come_first_and_filters_choose(dock):
    assert listed(dock) == ["3", "2"]
    dock.filter.setCurrentIndex(2)
    assert listed(dock) == ["3", "2", "1", "4"]
    dock.filter.setCurrentIndex(1)
    press(dock, Qt.Key.Key_K)
    dock.fill()
    assert listed(dock) == ["2", "1", "4"]


def test_keys_decide_and_go_on_to_the_next(dock, layer):
    assert current(dock) == "3"
    press(dock, Qt.Key.Key_D)
    assert current(dock) == "2"
    assert EVIDENCE in dock.facts.text()
    press(dock, Qt.Key.Key_K)
    assert decisions(layer) == {1: None, 2: "kept", 3: "deleted", 4: None}
    when = {value_of(layer, one, "reviewed_at") for one in layer.getFeatures()}
    assert all(datetime.fromisoformat(one).tzinfo for one in when if one)
    assert "2 of 2 reviewed" in dock.count.text()
    press(dock, Qt.Key.Key_P)
    assert current(dock) == "3"
    assert "&lt;b&gt;" in dock.facts.text()
    press(dock, Qt.Key.Key_N)
    assert current(dock) == "2"


def test_keys_hold_on_the_map_and_only_while_the_window_is_open(dock, layer, qgis_iface):
    actions = [one for one in qgis_iface.mapCanvas().actions() if one.shortcut().toString() == "D"]
    assert [one.isEnabled() for one in actions] == [True]
    dock.hide()
    assert [one.isEnabled() for one in actions] == [False]


def test_a_step_is_undone_and_its_building_shown(dock, layer):
    before = layer.fields().names()
    press(dock, Qt.Key.Key_D)
    assert current(dock) == "2"
    assert "Steps to save: 1" in dock.count.text()
    next(one for one in dock.actions() if one.text() == "Undo").trigger()
    QCoreApplication.processEvents()
    assert current(dock) == "3"
    assert decisions(layer)[3] is None
    assert layer.fields().names() == before
    assert "Steps to save" not in dock.count.text()


def test_the_reviewed_layer_is_the_active_one_for_the_undo_of_qgis(dock, layer, qgis_iface):
    other = vector("Polygon", [])
    QgsProject.instance().addMapLayer(other)
    qgis_iface.setActiveLayer(other)
    press(dock, Qt.Key.Key_K)
    assert qgis_iface.activeLayer() == layer


def test_decisions_are_saved_with_the_layer_when_the_window_closes(layer, qgis_iface, tmp_path, request):
    options = QgsVectorFileWriter.SaveVectorOptions()
    path = str(tmp_path / "footprints.gpkg")
    QgsVectorFileWriter.writeAsVectorFormatV3(layer, path, QgsProject.instance().transformContext(), options)
    stored = QgsVectorLayer(path, "stored")
    QgsProject.instance().addMapLayer(stored)
    dock = request.getfixturevalue("dock")
    dock.follow(stored)
    press(dock, Qt.Key.Key_D)
    assert "Steps to save: 1" in dock.count.text()
    dock.close()
    assert decisions(QgsVectorLayer(path, "again")) == {1: None, 2: None, 3: "deleted", 4: None}
    again = show_review(qgis_iface, stored)
    assert again is dock
    assert current(again) == "2"


def test_deleted_buildings_are_faint_until_they_are_removed(dock, layer):
    press(dock, Qt.Key.Key_D)
    symbol = layer.renderer().symbol()
    opacity = symbol.dataDefinedProperties().property(symbol.Property.Opacity)
    assert "deleted" in opacity.expressionString()
    assert layer.featureCount() == 4
    next(one for one in dock.actions() if one.text() == "Remove deleted").trigger()
    QCoreApplication.processEvents()
    assert sorted(decisions(layer)) == [1, 2, 4]
    assert listed(dock) == ["2"]
    layer.undoStack().undo()
    QCoreApplication.processEvents()
    assert sorted(decisions(layer)) == [1, 2, 3, 4]


def test_a_building_is_merged_with_the_one_it_touches(dock, layer):
    press(dock, Qt.Key.Key_N)
    press(dock, Qt.Key.Key_M)
    assert listed(dock) == ["3"]
    merged = layer.getFeature(1)
    wanted = {"area": 125.0, "volume": 350.0, "points": 240, "confidence": 0.9, "review": "changed"}
    assert {name: value_of(layer, merged, name) for name in wanted} == wanted
    assert layer.featureCount() == 3


def test_buildings_apart_are_not_merged(dock, layer, qgis_iface):
    layer.selectByExpression('"id" = 1')
    press(dock, Qt.Key.Key_M)
    assert layer.featureCount() == 4
    assert not layer.undoStack().canUndo()
    with pytest.raises(ValueError, match="don't touch"):
        dock.review.merge(dock._fid)
    layer.removeSelection()
    with pytest.raises(ValueError, match="0 buildings touch this one"):
        dock.review.merge(dock._fid)


def split(layer):
    """What QGIS's tool does with a line across the third square."""
    layer.beginEditCommand("Features split")
    layer.splitFeatures(QgsLineString([QgsPoint(44, -1), QgsPoint(44, 11)]), False, False)
    layer.endEditCommand()


def test_a_window_that_is_closed_while_a_line_is_drawn_gives_the_tool_back(dock, layer, qgis_iface):
    canvas = qgis_iface.mapCanvas()
    before, drawing = QgsMapToolPan(canvas), QgsMapToolPan(canvas)
    canvas.setMapTool(before)
    press(dock, Qt.Key.Key_L)
    canvas.setMapTool(drawing)
    dock.close()
    assert (canvas.mapTool(), layer.selectedFeatureIds()) == (before, [])
    canvas.unsetMapTool(before)


def test_a_divided_building_shares_its_numbers(dock, layer, qgis_iface):
    press(dock, Qt.Key.Key_L)
    assert qgis_iface.actionSplitFeatures().trigger.called
    assert layer.selectedFeatureIds() == [dock._fid]
    split(layer)
    QCoreApplication.processEvents()
    parts = list(layer.getFeatures(QgsFeatureRequest().setFilterExpression("\"review\" = 'changed'")))
    found = sorted(
        (value_of(layer, one, "area"), value_of(layer, one, "volume"), value_of(layer, one, "points")) for one in parts
    )
    assert found == [(40.0, 80.0, 40), (60.0, 120.0, 60)]
    assert sorted(value_of(layer, one, "id") for one in parts) == [3, 5]
    layer.undoStack().undo()
    QCoreApplication.processEvents()
    assert decisions(layer) == {1: None, 2: None, 3: None, 4: None}
    assert layer.featureCount() == 4


def test_an_outline_that_any_tool_changes_is_recorded(layer):
    review = Review(layer, print)
    layer.startEditing()
    layer.beginEditCommand("Moved vertex")
    layer.changeGeometry(1, QgsGeometry.fromWkt(square(0, 20)))
    layer.endEditCommand()
    assert value_of(layer, layer.getFeature(1), "review") == "changed"
    assert value_of(layer, layer.getFeature(1), "area") == 400.0
    layer.undoStack().undo()
    assert value_of(layer, layer.getFeature(1), "review") is None
    assert layer.undoStack().canRedo()
    # What a tool gives up is undone while its command is open; here the attributes stay.
    review.decide(2, "kept")
    changed = []
    layer.attributeValueChanged.connect(lambda *given: changed.append(given))
    layer.beginEditCommand("Given up")
    layer.changeGeometry(1, QgsGeometry.fromWkt(square(0, 20)))
    changed.clear()
    layer.destroyEditCommand()
    assert "changed" not in [value for *_, value in changed]
    assert value_of(layer, layer.getFeature(1), "review") is None
    assert value_of(layer, layer.getFeature(1), "area") == 100.0
    review.end()


def wait_for(pictures, tries=200):
    while tries and (pictures[0].pixmap() is None or pictures[0].pixmap().isNull()):
        QTest.qWait(20)
        tries -= 1


def test_the_points_of_the_current_building_are_drawn_by_class(layer, dock, town, tmp_path):
    """A square with a roof of 8 m in its middle; the footprints of the layer lie elsewhere."""
    assert "no point cloud" in dock.views.pictures[0].text()
    path = tmp_path / "town.copc.laz"
    write_cloud(create_cloud(town, wkt="EPSG:28992"), path)
    QgsProject.instance().addMapLayer(QgsPointCloudLayer(str(path), "town", "copc"))
    outline = QgsGeometry.fromRect(QgsRectangle(85_006, 446_006, 85_014, 446_014))
    dock.views.show_building(layer, outline)
    wait_for(dock.views.pictures)
    for picture in dock.views.pictures:
        image = picture.pixmap().toImage()
        colors = [image.pixelColor(x, y) for x in range(image.width()) for y in range(image.height())]
        # Roofs are red and ground is brown, as in the style of classes; scaling has paled both.
        warm = [one.red() - one.green() for one in colors if one.red() - one.blue() > 40]
        assert max(warm) > 80
        assert min(warm) < 45


def test_keys_do_nothing_where_no_building_is_listed(dock, layer, qgis_iface):
    layer.setSubsetString("false")
    dock.fill()
    assert listed(dock) == []
    for key in "KDMLPN":
        press(dock, getattr(Qt.Key, f"Key_{key}"))
    assert not layer.isEditable()
    assert "No building is listed" in dock.facts.text()


class View3D:
    """What is asked of a 3D view: its origin, and where its camera looks."""

    def mapSettings(self):
        return self

    def origin(self):
        return QgsVector3D(100.0, 0.0, 0.0)

    def cameraController(self):
        return self

    def setLookingAtPoint(self, *given):
        self.given = given


def test_open_3d_views_look_at_the_building(dock, qgis_iface, monkeypatch):
    view = View3D()
    monkeypatch.setattr(qgis_iface, "mapCanvases3D", lambda: [view], raising=False)
    press(dock, Qt.Key.Key_N)
    at, away, pitch, _ = view.given
    # The second building is 5 m wide, from 10 m on.
    assert (at.x(), at.z()) == (12.5 - 100.0, -2.5)
    assert away > 10.0
    assert pitch == 55.0


@pytest.mark.usefixtures("offers")
def test_a_run_that_made_footprints_offers_the_review(layer, qgis_iface, context, log, request):
    # All tests of a process share the message bar.
    qgis_iface.messageBar().clearWidgets()
    styles.Styler("facades").postProcessLayer(layer, context, log)
    assert qgis_iface.messageBar().currentItem() is None
    styles.Styler("footprints").postProcessLayer(layer, context, log)
    item = qgis_iface.messageBar().currentItem()
    assert item.text() == "4 buildings, 2 of them doubtful."
    item.findChild(QPushButton).click()
    dock = qgis_iface.mainWindow().findChild(QDockWidget, "LidarBuildingsReview")
    assert dock.review.layer == layer
    # Only those without a decision are counted.
    dock.review.decide(dock._fid, "kept")
    styles.Styler("footprints").postProcessLayer(layer, context, log)
    assert qgis_iface.messageBar().currentItem().text() == "4 buildings, 1 of them doubtful."
    qgis_iface.messageBar().clearWidgets()
    assert request.getfixturevalue("dock") is dock


@pytest.mark.usefixtures("offers")
def test_a_map_that_was_updated_is_reviewed_by_what_changed(dock, layer, qgis_iface, context, log):
    rows = [
        (square(0), ["unchanged", 0.5]),
        (square(20), ["changed", 0.9]),
        (square(40), ["new", None]),
        (square(60), ["not seen", 0.8]),
    ]
    updated = vector("Polygon", rows, fields="field=status:string&field=confidence:double")
    QgsProject.instance().addMapLayer(updated)
    qgis_iface.messageBar().clearWidgets()
    styles.Styler("updated_map").postProcessLayer(updated, context, log)
    item = qgis_iface.messageBar().currentItem()
    assert item.text() == "4 buildings, 3 of them changed."
    item.findChild(QPushButton).click()
    assert dock.review.layer == updated
    shown = [number for number in range(dock.list.columnCount()) if not dock.list.isColumnHidden(number)]
    assert [dock.list.headerItem().text(number) for number in shown] == ["Confidence", "Change", "Review"]
    assert [dock.list.topLevelItem(row).text(shown[1]) for row in range(3)] == ["not seen", "changed", "new"]
    dock.filter.setCurrentIndex(dock.filter.findText("Doubtful"))
    assert [dock.list.topLevelItem(0).text(shown[1])] == ["unchanged"]
    # Another layer has its own filters and columns.
    dock.follow(layer)
    assert [dock.filter.itemText(at) for at in range(dock.filter.count())] == [
        "Doubtful",
        "Not yet reviewed",
        "All buildings",
    ]
    assert listed(dock) == ["3", "2"]
    qgis_iface.messageBar().clearWidgets()


def test_a_layer_that_leaves_the_project_is_forgotten(dock, layer):
    QgsProject.instance().removeMapLayer(layer)
    QCoreApplication.processEvents()
    assert dock.review is None
    assert listed(dock) == []


def test_the_run_is_offered_again_with_the_decisions(dock, layer, monkeypatch, town_file):
    given = []
    processing = SimpleNamespace(execAlgorithmDialog=lambda name, parameters: given.append(parameters))
    monkeypatch.setitem(sys.modules, "processing", processing)
    press(dock, Qt.Key.Key_D)
    next(one for one in dock.actions() if one.text() == "Run again…").trigger()
    cloud = QgsPointCloudLayer(str(town_file), "town", "pdal")
    QgsProject.instance().addMapLayer(cloud)
    next(one for one in dock.actions() if one.text() == "Run again…").trigger()
    assert given == [{"INPUT": one, "REVIEWED": layer.id()} for one in (None, cloud.id())]
    assert not layer.isModified(), "the run reads what is stored"


@pytest.mark.usefixtures("offers")
def test_the_run_is_offered_again_with_its_own_parameters(
    dock, provider, qgis_iface, log, monkeypatch, town_file, tmp_path
):
    """And after it, how many buildings are others."""
    offered, context = [], QgsProcessingContext()
    processing = SimpleNamespace(execAlgorithmDialog=lambda *given: offered.append(given))
    context.setProject(QgsProject.instance())

    def load(parameters):
        target = tmp_path / f"{len(offered)}.gpkg"
        outputs = QgsProcessingOutputLayerDefinition(str(target), QgsProject.instance())
        run("extractfootprints", {**parameters, "FOOTPRINTS": outputs}, context, log)
        ((source, details),) = context.layersToLoadOnCompletion().items()
        layer = QgsProject.instance().addMapLayer(QgsVectorLayer(source, "found", "ogr"))
        details.postProcessor().postProcessLayer(layer, context, log)
        context.setLayersToLoadOnCompletion({})
        return layer

    layer = load({"INPUT": str(town_file), "MIN_AREA": 6.5, "MERGE_TOUCHING": True})
    dock.follow(layer)
    dock.review.decide(1, "kept")
    monkeypatch.setitem(sys.modules, "processing", processing)
    next(one for one in dock.actions() if one.text() == "Run again…").trigger()
    monkeypatch.undo()
    ((name, given),) = offered
    assert name == "lidarbuildings:extractfootprints"
    wanted = {"INPUT": str(town_file), "MIN_AREA": 6.5, "MERGE_TOUCHING": True, "REVIEWED": layer.id()}
    assert given == wanted
    load(given)
    assert qgis_iface.messageBar().currentItem().text().endswith("Since the review: 1 kept, 0 redrawn, 0 new, 0 gone.")
    qgis_iface.messageBar().clearWidgets()


def test_buildings_of_two_layers_are_kept_redrawn_new_or_gone():
    before, after = (
        vector("Polygon", [(square(*one), [0]) for one in rows], fields="field=id:int")
        for rows in ([(0,), (20,), (40,)], [(0,), (21, 9), (60,), (80,)])
    )
    assert changes_between(before, after) == {"kept": 1, "redrawn": 1, "new": 2, "gone": 1}


def test_an_outline_that_overlaps_its_neighbor_is_told(dock, layer):
    layer.startEditing()
    layer.beginEditCommand("Redrawn")
    layer.changeGeometry(2, QgsGeometry.fromWkt(square(8, 5)))
    layer.endEditCommand()
    dock.filter.setCurrentIndex(dock.filter.findText("All buildings"))
    dock.go_to(listed(dock).index("2"))
    assert dock.facts.text().endswith("Overlaps building 1: move a wall of one, or delete it.")
    dock.review.decide(1, "deleted")
    dock.fill()
    assert "Overlaps" not in dock.facts.text()


def test_reviewed_outlines_come_back_as_their_file_has_them(context, log, town_file, tmp_path):
    """To the last digit, with the number of the layer; what was deleted stays away."""
    before, after = tmp_path / "before.gpkg", tmp_path / "after.gpkg"
    found = {"INPUT": str(town_file), "FOOTPRINTS": str(before)}
    run("extractfootprints", found, context, log)
    layer = QgsVectorLayer(str(before), "before", "ogr")
    review = Review(layer, lambda _: None)
    (building,) = review.buildings()
    layer.startEditing()
    layer.beginEditCommand("Moved vertex")
    layer.moveVertex(85_004.123456789, 446_003.3, building.id(), 0)
    layer.endEditCommand()
    review.end()
    outline = layer.getGeometry(building.id()).asWkb().data()
    run("extractfootprints", {**found, "FOOTPRINTS": str(after), "REVIEWED": str(before)}, context, log)
    (feature,) = QgsVectorLayer(str(after), "after", "ogr").getFeatures()
    assert feature.geometry().asWkb().data() == outline
    assert (feature["id"], feature["review"]) == (building["id"], "changed")
    assert feature["reviewed_at"]
    review = Review(layer, lambda _: None)
    review.decide(building.id(), "deleted")
    review.end()
    run("extractfootprints", {**found, "FOOTPRINTS": str(after), "REVIEWED": str(before)}, context, log)
    assert QgsVectorLayer(str(after), "after", "ogr").featureCount() == 0
