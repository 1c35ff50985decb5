"""Take the pictures of the README: a simulated town whose buildings were found, and the graph of the model.

Runs inside QGIS, with the plugin enabled in the profile, on a screen that need not be there::

    xvfb-run -s "-screen 0 1400x900x24" qgis --nologo --noversioncheck --code scripts/readme_pictures.py
    pngquant --force --ext .png 256 resources/readme/*.png
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
)
from qgis.PyQt.QtCore import QRectF, QSize, Qt, QTimer
from qgis.PyQt.QtGui import QImage, QPainter
from qgis.PyQt.QtWidgets import QDockWidget, QTreeView
from qgis.utils import iface

from lidar_buildings.provider.paths import PLUGIN

FOLDER = Path(PLUGIN).resolve() / "resources" / "readme"
WINDOW = QSize(1400, 900)
GRAPH_WIDTH = 1300  # pixels
REDRAW = 20000  # milliseconds until the map is drawn


def found_town() -> None:
    """Scan a town, find its buildings and load both results, as from the dialogs."""
    town = processing.run("lidarbuildings:simulatetown", {"OUTPUT": QgsProcessing.TEMPORARY_OUTPUT})["OUTPUT"]
    project = QgsProject.instance()
    targets = {
        name: QgsProcessingOutputLayerDefinition(QgsProcessing.TEMPORARY_OUTPUT, project)
        for name in ("OUTPUT", "FOOTPRINTS")
    }
    processing.runAndLoadResults("lidarbuildings:detectbuildings", {"INPUT": town, **targets})


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
QTimer.singleShot(REDRAW, lambda: follow([found_town, arranged_window, town_picture, graph_picture]))
