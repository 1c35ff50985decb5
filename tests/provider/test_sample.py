"""The sample data, and the view in three dimensions."""

from types import SimpleNamespace

import numpy as np
import pytest
from qgis.core import QgsProject, QgsVectorLayer
from qgis.PyQt.QtWidgets import QApplication

from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.provider import sample
from lidar_buildings.provider.sample import PROJECT, TOWN, TRUTH, fill_project, make_sample
from lidar_buildings.provider.view3d import heights_of, layers_to_show, view_angles
from lidar_buildings.tests.provider.helpers import vector


def test_the_sample_is_small_has_no_classes_and_is_a_project(provider, tmp_path):
    make_sample(tmp_path)
    assert (tmp_path / TOWN).stat().st_size < 3e6
    town, truth = read_cloud(tmp_path / TOWN), read_cloud(tmp_path / TRUTH)
    assert set(town.get("classification")) == {1}
    assert {2, 5, 6} <= set(truth.get("classification"))
    np.testing.assert_array_equal(town.get("xyz"), truth.get("xyz"))
    written = (tmp_path / TOWN).stat().st_mtime_ns
    make_sample(tmp_path)
    assert (tmp_path / TOWN).stat().st_mtime_ns == written, "it is made once"

    project = QgsProject()
    fill_project(project, tmp_path)
    assert project.crs().authid() == "EPSG:3395"
    again = QgsProject()
    assert again.read(str(tmp_path / PROJECT))
    layers = {layer.name(): layer for layer in again.mapLayers().values()}
    assert set(layers) == {"Town", "Town, true classes"}
    assert all(layer.isValid() and layer.crs().isValid() for layer in layers.values())
    low, high = (layers["Town"].renderer().minimum(), layers["Town"].renderer().maximum())
    assert low < high
    nodes = {node.name(): node.itemVisibilityChecked() for node in again.layerTreeRoot().findLayers()}
    assert nodes == {"Town": True, "Town, true classes": False}


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ValueError("Point clouds need laspy; install it."), "Point clouds need laspy; install it."),
        (OSError(28, "No space left on device"), "A file can't be read or written: No space left on device."),
    ],
)
def test_a_sample_that_can_t_be_made_is_a_sentence_and_keeps_the_project(monkeypatch, error, said):
    """It was a traceback, and an empty project."""

    def fail(folder):
        raise error

    told = []
    bar = SimpleNamespace(pushWarning=lambda title, text: told.append(text))
    iface = SimpleNamespace(messageBar=lambda: bar, newProject=lambda asks: pytest.fail("a new project"))
    monkeypatch.setattr(sample, "make_sample", fail)
    sample.open_sample(iface)
    assert told == [said]
    assert QApplication.overrideCursor() is None


def test_models_of_the_current_group_are_shown_alone(context):
    from qgis._3d import QgsPolygon3DSymbol, QgsVectorLayer3DRenderer

    root, layers = context.project().layerTreeRoot(), []
    for name in ("walls", "helper", "earlier", "flat"):
        layer = QgsVectorLayer("Polygon", name, "memory")
        if name != "flat":
            layer.setRenderer3D(QgsVectorLayer3DRenderer(QgsPolygon3DSymbol()))
        context.project().addMapLayer(layer, False)
        layers.append(layer)
    group = root.addGroup("run")
    for layer in layers[:2]:
        group.addLayer(layer)
    group.addLayer(layers[3])
    root.addLayer(layers[2])
    root.findLayer(layers[1].id()).setItemVisibilityChecked(False)
    visible = [layers[0], layers[2], layers[3]]
    assert layers_to_show(group, visible) == [layers[0]]
    assert layers_to_show(root.addGroup("empty"), visible) == [layers[0], layers[2]]


FRONT = "PolygonZ ((10 0 0, 10 8 0, 10 8 6, 10 0 6, 10 0 0))"
BACK = "PolygonZ ((0 8 0, 0 0 0, 0 0 6, 0 8 6, 0 8 0))"


def test_the_camera_stands_in_front_of_facades_and_aside_of_solids(context):
    """A facade was seen from behind, dark, whichever way it looked."""
    plain = view_angles([vector("PolygonZ", [(BACK, [1, 1.0, ""]), (FRONT, [2, 1.0, ""])])])
    pitch, yaw = view_angles([vector("PolygonZ", [(FRONT, [1, 1.0, ""])])])
    assert (pitch, yaw) == (75.0, 90.0), "counterclockwise from the east: it looks east, as does the camera's place"
    assert view_angles([vector("PolygonZ", [(BACK, [1, 1.0, ""])])])[1] == 270.0
    assert plain == view_angles([]) != (pitch, yaw)


def test_the_view_looks_at_the_middle_of_the_heights(context):
    assert heights_of([vector("Polygon", [("Polygon ((0 0, 1 0, 1 1, 0 0))", [1, 1.0, ""])])]) == (0.0, 0.0)
    assert heights_of([vector("PolygonZ", [(FRONT, [1, 1.0, ""])])]) == (0.0, 6.0)
