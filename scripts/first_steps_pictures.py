r"""Take the pictures of the first steps: QGIS with a tile, from the toolbox to the models in 3D.

Runs inside QGIS, with the plugin enabled in a new profile, on a screen of 1440 by 900 pixels with a window manager.
TILE is a COPC file; the pictures in the repository show ahn3-delft (AHN3, Dutch open data)::

    export TILE=Delft.copc.laz
    xvfb-run -s "-screen 0 1440x900x24 -dpi 96" sh -c \
        "openbox & qgis --nologo --noversioncheck --code $PWD/scripts/first_steps_pictures.py"
    pngquant --force --ext .png 64 docs/pictures/*.png

That of the page, which is copied to ``docs/pictures/report.html``, is taken with a browser, 840 by 1000 pixels.
"""

from __future__ import annotations

import os
import shutil
import sys
import traceback
from pathlib import Path
from typing import Callable, Optional

from processing import createAlgorithmDialog
from qgis.core import (
    QgsApplication,
    QgsColorRampShader,
    QgsPointCloudAttributeByRampRenderer,
    QgsPointCloudLayer,
    QgsProject,
    QgsRectangle,
    QgsStyle,
)
from qgis.PyQt.QtCore import QModelIndex, QPoint, QRect, Qt, QTimer
from qgis.PyQt.QtGui import QColor, QCursor, QImage, QPainter, QPen
from qgis.PyQt.QtWidgets import QDockWidget, QPushButton, QTextEdit, QToolBar, QTreeView
from qgis.utils import iface

from lidar_buildings.provider.menu import view_parameters
from lidar_buildings.provider.paths import PLUGIN
from lidar_buildings.provider.view3d import show_view

PICTURES = Path(PLUGIN).resolve() / "docs" / "pictures"
SCREEN = QRect(0, 0, 1440, 900)
DIALOG = QRect(200, 90, 930, 660)  # without its frame
VIEW = QRect(130, 80, 1240, 790)  # the 3D view, without its frame
MAP = QRect(500, 125, 760, 500)  # the part of the map that is shown
BARS = {"mFileToolBar", "mMapNavToolBar", "mAttributesToolBar", "mPluginToolBar"}
ELEVATIONS = -1.0, 14.0  # m, from the first to the last color
EXTENT = 130.0, 90.0  # m: width and height of the map with the map tip
RED = QColor("#e0301e")  # frames around what is clicked
SECOND = 1000  # milliseconds
SETTLED = 6  # seconds until a window is drawn
DRAWN = 25  # seconds until the 3D view is


class Walk:
    """The windows of QGIS, and what is done with them."""

    def __init__(self) -> None:
        self.main = iface.mainWindow()
        self.toolbox = self.main.findChild(QDockWidget, "ProcessingToolbox")
        self.runs = False

    def load(self) -> None:
        """Load the tile, colored by elevation, with the layers on the left and the toolbox on the right."""
        self.main.showNormal()
        self.main.setGeometry(SCREEN)
        self.layer = QgsPointCloudLayer(os.environ["TILE"], Path(os.environ["TILE"]).name.split(".")[0], "copc")
        renderer, shader = QgsPointCloudAttributeByRampRenderer(), QgsColorRampShader(*ELEVATIONS)
        shader.setSourceColorRamp(QgsStyle.defaultStyle().colorRamp("Viridis"))
        shader.classifyColorRamp(10)
        renderer.setAttribute("Z")
        renderer.setMinimum(ELEVATIONS[0])
        renderer.setMaximum(ELEVATIONS[1])
        renderer.setColorRampShader(shader)
        renderer.setPointSize(0.6)
        self.layer.setRenderer(renderer)
        QgsProject.instance().addMapLayer(self.layer)
        QgsProject.instance().setCrs(self.layer.crs())
        iface.setActiveLayer(self.layer)
        for dock in self.main.findChildren(QDockWidget):
            dock.setVisible(dock.objectName() in ("ProcessingToolbox", "Layers"))
        for bar in self.main.findChildren(QToolBar):
            bar.setVisible(bar.objectName() in BARS)
        self.main.resizeDocks([self.toolbox], [300], Qt.Orientation.Horizontal)
        self.main.resizeDocks([self.main.findChild(QDockWidget, "Layers")], [230], Qt.Orientation.Horizontal)

    def find_model(self) -> None:
        """Show *Detect buildings* in the toolbox."""
        iface.messageBar().clearWidgets()
        iface.zoomFull()
        tree = self.toolbox.findChild(QTreeView)
        provider = self._child(QModelIndex(), "LiDAR Buildings")
        group = self._child(provider, "Models")
        tree.expand(provider)
        tree.expand(group)
        tree.setCurrentIndex(self._child(group, "Detect buildings"))
        tree.scrollTo(provider, QTreeView.ScrollHint.PositionAtTop)

    def _child(self, parent: QModelIndex, text: str) -> QModelIndex:
        model = self.toolbox.findChild(QTreeView).model()
        rows = (model.index(row, 0, parent) for row in range(model.rowCount(parent)))
        return next(row for row in rows if str(row.data()).strip() == text)

    def picture_toolbox(self) -> None:
        """Save the window with frames around the button and the model."""
        tree = self.toolbox.findChild(QTreeView)
        model = tree.visualRect(tree.currentIndex()).translated(tree.viewport().mapTo(self.main, QPoint()))
        bar = self.main.findChild(QToolBar, "mPluginToolBar")
        (find,) = (one for one in bar.actions() if one.text().startswith("Find buildings"))
        button = bar.widgetForAction(find)
        marked = [model, QRect(button.mapTo(self.main, QPoint()), button.size())]
        image = self._screen(SCREEN)
        painter = QPainter(image)
        painter.setPen(QPen(RED, 3))
        corner = self.main.mapToGlobal(QPoint())
        for one in marked:
            painter.drawRoundedRect(one.translated(corner), 5, 5)
        painter.end()
        image.scaledToWidth(1000, Qt.TransformationMode.SmoothTransformation).save(str(PICTURES / "toolbox.png"))

    def open_dialog(self, algorithm: str) -> None:
        """Open the dialog of an algorithm with the tile."""
        iface.setActiveLayer(self.layer)
        iface.zoomFull()
        self.runs = False
        self.dialog = createAlgorithmDialog(f"lidarbuildings:{algorithm}", view_parameters(iface))
        self.dialog.setGeometry(DIALOG)
        self.dialog.show()

    def run(self) -> None:
        """Click *Run*."""
        (button,) = (one for one in self.dialog.findChildren(QPushButton) if one.text().replace("&", "") == "Run")
        button.click()
        self.runs = True

    def has_finished(self) -> bool:
        """Whether the log of the dialog ends with its layers loaded."""
        return self._log() is not None and not self._log().document().find("' finished").isNull()

    def _log(self) -> Optional[QTextEdit]:
        logs = (one for one in self.dialog.findChildren(QTextEdit) if "Input parameters" in one.toPlainText())
        return next(logs, None)

    def show_summary(self) -> None:
        """Scroll the log so that the last steps and the summary are seen."""
        log = self._log()
        found = log.document().find("Execution completed")
        found.clearSelection()
        log.setTextCursor(found)
        bar = log.verticalScrollBar()
        bar.setValue(bar.value() + log.cursorRect(found).top() - log.height() * 2 // 3)

    def look_closer(self) -> None:
        """Close the dialog, and show a part of the map with map tips."""
        self._close_dialog()
        for dock in self.main.findChildren(QDockWidget):
            dock.setVisible(dock.objectName() == "Layers")
        iface.messageBar().clearWidgets()
        iface.mapCanvas().setExtent(QgsRectangle.fromCenterAndSize(self.layer.extent().center(), *EXTENT))
        iface.mapCanvas().refresh()
        if not iface.actionMapTips().isChecked():
            iface.actionMapTips().trigger()

    def _close_dialog(self) -> None:
        self.runs = False
        self.dialog.close()

    def rest_on_building(self) -> None:
        """Rest the mouse on a house in the middle."""
        canvas = iface.mapCanvas()
        (footprints,) = QgsProject.instance().mapLayersByName("Footprints")
        iface.setActiveLayer(footprints)
        middle = QgsRectangle(canvas.extent())
        middle.scale(0.5)
        house = max(footprints.getFeatures(middle), key=lambda one: one["area"] if one["area"] < 160 else 0.0)
        point = canvas.getCoordinateTransform().transform(house.geometry().pointOnSurface().asPoint())
        QCursor.setPos(canvas.mapToGlobal(QPoint(int(point.x()) - 20, int(point.y()))))
        QTimer.singleShot(SECOND, lambda: QCursor.setPos(canvas.mapToGlobal(QPoint(int(point.x()), int(point.y())))))

    def show_models(self) -> None:
        """Show the models in 3D."""
        self._close_dialog()
        before = set(QgsApplication.topLevelWidgets())
        iface.layerTreeView().setCurrentLayer(QgsProject.instance().mapLayersByName("Roofs")[0])
        show_view(iface)
        (self.view,) = (one for one in QgsApplication.topLevelWidgets() if one.isVisible() and one not in before)
        self.view.setGeometry(VIEW)
        camera = iface.mapCanvases3D()[-1].cameraController()
        camera.setLookingAtPoint(camera.lookingAtPoint(), camera.distance() * 0.42, camera.pitch(), camera.yaw())

    def keep_report(self) -> None:
        """Copy the page of the run."""
        page = next(word for word in self._log().toPlainText().split() if word.endswith("/REPORT.html"))
        shutil.copy(page, PICTURES / "report.html")

    def picture(self, name: str, part: QRect) -> None:
        """Save a part of the screen."""
        self._screen(part).save(str(PICTURES / f"{name}.png"))

    def _screen(self, part: QRect) -> QImage:
        return QgsApplication.primaryScreen().grabWindow(0).copy(part).toImage()


def steps(walk: Walk) -> list[tuple[Callable[[], None], int]]:
    """Return what is done one after the other, with the seconds that it is then waited."""
    return [
        (walk.load, SETTLED),
        (walk.find_model, SETTLED),
        (walk.picture_toolbox, 1),
        (lambda: walk.open_dialog("detectbuildings"), SETTLED),
        (lambda: walk.picture("dialog", walk.dialog.frameGeometry()), 1),
        (walk.run, SETTLED),
        (walk.show_summary, 1),
        (lambda: walk.picture("log", walk.dialog.frameGeometry()), 1),
        (walk.keep_report, 1),
        (walk.look_closer, SETTLED),
        (walk.rest_on_building, SETTLED),
        (lambda: walk.picture("map", MAP), 1),
        (lambda: walk.open_dialog("modelbuildings"), SETTLED),
        (walk.run, SETTLED),
        (walk.show_models, DRAWN),
        (lambda: walk.picture("models", walk.view.frameGeometry()), 1),
    ]


def follow(walk: Walk, left: list) -> None:
    """Take the steps one by one, each after the run of the one before, and end QGIS."""
    if not left:
        sys.stdout.flush()
        os._exit(0)
    if walk.runs and not walk.has_finished():
        QTimer.singleShot(SECOND, lambda: follow(walk, left))
        return
    step, seconds = left[0]
    try:
        step()
    except Exception:  # QGIS would show it in a window and wait for ever
        traceback.print_exc()
        os._exit(1)
    QTimer.singleShot(seconds * SECOND, lambda: follow(walk, left[1:]))


WALK = Walk()
QTimer.singleShot(SETTLED * SECOND, lambda: follow(WALK, steps(WALK)))
