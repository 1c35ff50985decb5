"""Take the picture of the README in the 3D view: models of the buildings of a cloud.

Runs inside QGIS, with the plugin enabled in the profile, on a real or virtual screen. TILE is the cloud; the
picture in the repository shows ahn3-delft (AHN3, Dutch open data)::

    TILE=tile.laz xvfb-run -s "-screen 0 1400x900x24" qgis --nologo --noversioncheck --code scripts/readme_picture.py
    pngquant --force --ext .png 256 resources/readme/models.png
"""

from __future__ import annotations

import os
import sys
import traceback
from pathlib import Path

import processing
from qgis.core import QgsApplication, QgsProcessing, QgsProcessingOutputLayerDefinition, QgsProject, QgsVector3D
from qgis.PyQt.QtCore import QPoint, QRect, QSize, QTimer
from qgis.PyQt.QtWidgets import QToolBar
from qgis.utils import iface

from lidar_buildings.provider.paths import PLUGIN

PICTURE = Path(PLUGIN).resolve() / "resources" / "readme" / "models.png"
WINDOW = QSize(1400, 900)  # pixels: the whole of the screen
REDRAW = 20000  # milliseconds until the map is drawn
CAMERA = 210.0, 55.0, 30.0  # distance (m), angle from the vertical and azimuth (°) of the camera of the 3D view


def modelled_buildings() -> None:
    """Model the buildings of the tile and load their footprints, walls and roofs."""
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
        """Open the view."""
        self.canvas = iface.createNewMapCanvas3D("Models")
        shown = [window for window in QgsApplication.topLevelWidgets() if window.isVisible()]
        (self.window,) = (window for window in shown if window is not iface.mainWindow())
        self.window.setGeometry(QRect(QPoint(0, 0), WINDOW))

    def turn(self) -> None:
        """Look at the middle of the layers from above and aside."""
        middle, origin = iface.mapCanvas().fullExtent().center(), self.canvas.mapSettings().origin()
        center = QgsVector3D(middle.x() - origin.x(), 0, origin.y() - middle.y())
        self.canvas.cameraController().setLookingAtPoint(center, *CAMERA)

    def picture(self) -> None:
        """Save the view as the screen shows it, without its buttons."""
        bar = self.window.findChild(QToolBar).height()
        image = QgsApplication.primaryScreen().grabWindow(self.window.winId())
        # The window may be larger than the screen.
        image.copy(0, bar, WINDOW.width(), WINDOW.height() - bar).save(str(PICTURE))


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


VIEW = View()
QTimer.singleShot(REDRAW, lambda: follow([modelled_buildings, VIEW.open, VIEW.turn, VIEW.picture]))
