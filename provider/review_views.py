"""The points around a building under review, from above and in sections, read from a cloud of the project."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional

import numpy as np
from qgis.core import (
    QgsApplication,
    QgsCoordinateTransform,
    QgsCsException,
    QgsGeometry,
    QgsPointCloudLayer,
    QgsProject,
    QgsTask,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QPixmap
from qgis.PyQt.QtWidgets import QGridLayout, QLabel, QWidget

from ..algorithms.cloud.asprs import CODES, NOISE
from ..algorithms.cloud.files import read_cloud
from ..algorithms.report.building_views import AROUND, draw_sections
from .clouds import file_of_layer
from .qgis_crs import crs_of_layer, meters_per_unit
from .styles import Styler
from .web import check_sizes

# A class of a style, and its color.
_CATEGORY = re.compile(r'<category value="(\d+)"[^>]* color="(\d+,\d+,\d+)')


# Rows, columns and rows that they span of the views, and their largest width and height, pixels.
_LAYOUT = ((0, 0, 2, 190, 260), (0, 1, 1, 250, 130), (1, 1, 1, 250, 130))


class PointViews(QWidget):
    """Pictures that are replaced when the points of another building have been read."""

    def __init__(self) -> None:
        super().__init__()
        self.pictures = []
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        for row, column, rows, width, height in _LAYOUT:
            picture = QLabel(wordWrap=True)
            picture.setFixedSize(width, height)
            grid.addWidget(picture, row, column, rows, 1)
            self.pictures.append(picture)
        self._task: Any = None

    def show_building(self, layer: QgsVectorLayer, outline: QgsGeometry) -> None:
        """Read and draw the points around an outline, if the project has a cloud there."""
        try:
            file, ring, around = _cloud_around(layer, outline)
        except ValueError as error:
            self._draw(error)
            return
        task: Any = QgsTask.fromFunction(
            "Points of a building",
            lambda _: sections_of(file, ring, around),
            on_finished=lambda *drawn: self._draw(*drawn) if task is self._task else None,
            flags=QgsTask.Flag.Hidden | QgsTask.Flag.Silent,
        )
        self._task = task
        QgsApplication.taskManager().addTask(task)

    def _draw(self, error: Optional[Exception], views: Sequence[str] = ()) -> None:
        """Show views, or why there are none."""
        for picture in self.pictures:
            picture.clear()
        self.pictures[0].setText(str(error or ""))
        for picture, view in zip(self.pictures, views):
            drawn = QPixmap()
            drawn.loadFromData(view.encode(), "SVG")
            modes = Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
            picture.setPixmap(drawn.scaled(picture.size(), *modes))


def sections_of(file: Path, ring: np.ndarray, around: float) -> list[str]:
    """Return the views of the points around a ring (m, 2), in coordinates of their file.

    Raises
    ------
    ValueError
        If they can't be read, or there are none.
    """
    box = np.array([ring.min(axis=0) - around, ring.max(axis=0) + around])
    check_sizes([file], box)
    cloud = read_cloud(file, box=box)
    kind = cloud.get("classification")
    is_shown = ~np.isin(kind, NOISE) & (kind < CODES - 1)
    return draw_sections(cloud.get("xyz")[is_shown], kind[is_shown], cloud.from_map(ring), _colors())


def _colors() -> np.ndarray:
    """Return the colors of the background and of all classes but the last, as on the map: a picture has 256 colors."""
    colors = np.full((CODES, 3), 128)
    colors[0] = 255
    for number, color in _CATEGORY.findall(Styler.file("classification").read_text(encoding="utf-8")):
        colors[1 + int(number)] = [int(part) for part in color.split(",")]
    return colors


def _cloud_around(layer: QgsVectorLayer, outline: QgsGeometry) -> tuple[Path, np.ndarray, float]:
    """Return the file of a cloud around an outline, of the same group if there is one, and in its coordinates the ring.

    The last number is the width of the surroundings in them.
    """
    for cloud in clouds_for(layer):
        moved = QgsGeometry(outline)
        try:
            moved.transform(QgsCoordinateTransform(crs_of_layer(layer), cloud.crs(), QgsProject.instance()))
        except QgsCsException:
            continue
        file = file_of_layer(cloud) if cloud.extent().intersects(moved.boundingBox()) else None
        if file is not None:
            ring = next(moved.constParts()).exteriorRing()
            corners = np.array([(corner.x(), corner.y()) for corner in ring.points()])
            return file, corners, AROUND / meters_per_unit(cloud.crs())[0]
    raise ValueError("The project has no point cloud here.")


def clouds_for(layer: QgsVectorLayer) -> list[QgsPointCloudLayer]:
    """Return the clouds of the project, first from the group of a layer."""
    root = QgsProject.instance().layerTreeRoot()
    node = root.findLayer(layer.id())
    nodes = [*(node.parent().findLayers() if node else ()), *root.findLayers()]
    return [node.layer() for node in nodes if isinstance(node.layer(), QgsPointCloudLayer)]
