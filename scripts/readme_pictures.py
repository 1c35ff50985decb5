"""Take the pictures of the README: a simulated town and village whose buildings were found, and the graph of a model.

Runs inside QGIS, with the plugin enabled in the profile, on a screen that need not be there::

    xvfb-run -s "-screen 0 1400x900x24" qgis --nologo --noversioncheck --code scripts/readme_pictures.py
    pngquant --force --ext .png 256 resources/readme/*.png

With TILE, a cloud, in the environment it takes the picture of the 3D view instead, with models of the cloud's
buildings; README's shows ahn3-delft (AHN3, Dutch open data).
"""

from __future__ import annotations

import os
import sys
import traceback
from pathlib import Path

import processing
from processing.modeler.ModelerDialog import ModelerDialog
from qgis.core import (
    QgsApplication,
    QgsProcessing,
    QgsProcessingOutputLayerDefinition,
    QgsProject,
    QgsVector3D,
)
from qgis.PyQt.QtCore import QPoint, QRect, QRectF, QSize, Qt, QTimer
from qgis.PyQt.QtGui import QImage, QPainter
from qgis.PyQt.QtWidgets import QDockWidget, QToolBar, QTreeView
from qgis.utils import iface

from lidar_buildings.provider.paths import PLUGIN

FOLDER = Path(PLUGIN).resolve() / "resources" / "readme"
WINDOW = QSize(1400, 900)
GRAPH_WIDTH = 1300  # pixels
CLOSER = 0.72  # the part of the village that is shown
REDRAW = 20000  # milliseconds until the map is drawn
CAMERA = 210.0, 55.0, 30.0  # distance (m), angle from the vertical and azimuth (°) of the camera of the 3D view


def found_town() -> None:
    """Scan a town, find its buildings and load both results, as from the dialogs."""
    town = processing.run("lidarbuildings:simulatetown", {"OUTPUT": QgsProcessing.TEMPORARY_OUTPUT})["OUTPUT"]
    project = QgsProject.instance()
    targets = {
        name: QgsProcessingOutputLayerDefinition(QgsProcessing.TEMPORARY_OUTPUT, project)
        for name in ("OUTPUT", "FOOTPRINTS")
    }
    processing.runAndLoadResults("lidarbuildings:detectbuildings", {"INPUT": town, **targets})


def mapped_village() -> None:
    """Photograph a village, map its walls, compare them with the old map, and load what came of it."""
    project = QgsProject.instance()
    project.clear()
    names = ("OUTPUT", "OLD_MAP")
    made = processing.run(
        "lidarbuildings:simulatevillage", {"SIZE": 80, **dict.fromkeys(names, QgsProcessing.TEMPORARY_OUTPUT)}
    )
    targets = {
        name: QgsProcessingOutputLayerDefinition(QgsProcessing.TEMPORARY_OUTPUT, project)
        for name in ("OUTPUT", "WALL_FOOTPRINTS", "WALL_EDGES", "DISPLACEMENTS")
    }
    inputs = {"INPUT": made["OUTPUT"], "OLD_MAP": made["OLD_MAP"]}
    processing.runAndLoadResults("lidarbuildings:mapfootprints", {**inputs, **targets})


def close_window() -> None:
    """Show the layers with what their signs mean, and a few houses, whose eaves jut out over the walls."""
    window = iface.mainWindow()
    window.resize(WINDOW)
    window.statusBar().hide()
    for panel in ("Browser", "ProcessingToolbox"):
        window.findChild(QDockWidget, panel).hide()
    window.resizeDocks([window.findChild(QDockWidget, "Layers")], [300], Qt.Orientation.Horizontal)
    iface.messageBar().clearWidgets()
    iface.zoomFull()
    iface.mapCanvas().zoomByFactor(CLOSER)
    (cloud,) = QgsProject.instance().mapLayersByName("Classified point cloud")
    cloud.setSubsetString("Classification = 6")


def village_picture() -> None:
    """Save the window without its menus."""
    iface.messageBar().clearWidgets()
    window = iface.mainWindow()
    top = window.findChild(QDockWidget, "Layers").y()
    window.grab(QRect(0, top, window.width(), window.height() - top)).save(str(FOLDER / "village.png"))


def arranged_window() -> None:
    """Show the layers on the left, the town in the middle and the plugin's algorithms on the right."""
    window = iface.mainWindow()
    window.resize(WINDOW)
    window.findChild(QDockWidget, "Browser").hide()
    # The town is nowhere on earth: the scale that QGIS shows there is absurd.
    window.statusBar().hide()
    toolbox = window.findChild(QDockWidget, "ProcessingToolbox")
    toolbox.show()
    window.resizeDocks([window.findChild(QDockWidget, "Layers"), toolbox], [240, 270], Qt.Orientation.Horizontal)
    tree = toolbox.findChild(QTreeView)
    model = tree.model()
    for row in range(model.rowCount()):
        index = model.index(row, 0)
        if index.data() == "LiDAR Buildings":
            tree.expandRecursively(index)
            tree.scrollTo(index, QTreeView.ScrollHint.PositionAtTop)
    iface.messageBar().clearWidgets()
    iface.zoomFull()


def town_picture() -> None:
    """Save the window."""
    iface.messageBar().clearWidgets()
    iface.mainWindow().grab().save(str(FOLDER / "town.png"))


def graph_picture() -> None:
    """Save the graph that the model designer shows."""
    algorithm = QgsApplication.processingRegistry().createAlgorithmById("lidarbuildings:detectbuildings")
    designer = ModelerDialog.create(algorithm.as_model())
    scene = designer.view().scene()
    area = scene.itemsBoundingRect().adjusted(-20, -20, 20, 20)
    image = QImage(GRAPH_WIDTH, round(area.height() * GRAPH_WIDTH / area.width()), QImage.Format.Format_RGB32)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    scene.render(painter, QRectF(image.rect()), area)
    painter.end()
    image.save(str(FOLDER / "model.png"))


def modelled_buildings() -> None:
    """Model the buildings of the tile and load roofs, walls and grounds."""
    project = QgsProject.instance()
    project.clear()
    targets = {
        name: QgsProcessingOutputLayerDefinition(QgsProcessing.TEMPORARY_OUTPUT, project)
        for name in ("BUILDINGS", "WALLS", "ROOFS")
    }
    inputs = {"INPUT": os.environ["TILE"], "OUTPUT": QgsProcessing.TEMPORARY_OUTPUT}
    processing.runAndLoadResults("lidarbuildings:modelbuildings", {**inputs, **targets})
    (layer, *_) = project.mapLayers().values()
    project.setCrs(layer.crs())
    iface.mapCanvas().setDestinationCrs(layer.crs())
    iface.zoomFull()


class View:
    """The 3D view over the whole window."""

    def open(self) -> None:
        """Open it."""
        self.canvas = iface.createNewMapCanvas3D("Models")
        shown = [window for window in QgsApplication.topLevelWidgets() if window.isVisible()]
        (self.window,) = (window for window in shown if window is not iface.mainWindow())
        self.window.setGeometry(QRect(QPoint(0, 0), WINDOW))

    def turn(self) -> None:
        """Look at the middle of the layers from above and aside."""
        middle, origin = iface.mapCanvas().fullExtent().center(), self.canvas.mapSettings().origin()
        place = QgsVector3D(middle.x() - origin.x(), 0, origin.y() - middle.y())
        self.canvas.cameraController().setLookingAtPoint(place, *CAMERA)

    def picture(self) -> None:
        """Save it as the screen shows it, without its buttons."""
        bar = self.window.findChild(QToolBar).height()
        image = QgsApplication.primaryScreen().grabWindow(self.window.winId())
        # The window may be larger than the screen.
        image.copy(0, bar, WINDOW.width(), WINDOW.height() - bar).save(str(FOLDER / "models.png"))


def follow(steps: list) -> None:
    """Take the steps one by one, with time to draw between them, and end QGIS."""
    try:
        steps[0]()
    except Exception:  # QGIS would show it in a window and wait for ever
        traceback.print_exc()
        os._exit(1)
    if len(steps) == 1:
        sys.stdout.flush()
        os._exit(0)
    QTimer.singleShot(REDRAW, lambda: follow(steps[1:]))


FOLDER.mkdir(parents=True, exist_ok=True)
TOWN = [found_town, arranged_window, town_picture]
VILLAGE = [mapped_village, close_window, village_picture]
VIEW = View()
MODELS = [modelled_buildings, VIEW.open, VIEW.turn, VIEW.picture]
QTimer.singleShot(REDRAW, lambda: follow(MODELS if os.environ.get("TILE") else [*TOWN, graph_picture, *VILLAGE]))
