"""A view of the results of a run in three dimensions, from the side."""

import math
from collections.abc import Iterator
from itertools import islice
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsLayerTree,
    QgsMapLayer,
    QgsPoint,
    QgsProject,
    QgsRectangle,
    QgsVector3D,
    QgsVectorLayer,
    QgsWkbTypes,
)
from qgis.gui import QgsProjectionSelectionDialog

from ..algorithms.criteria import MAJORITY
from ..algorithms.geometry.polygons import area_vector
from .named_clouds import SIMULATED_CRS
from .questions import push_with_button

# Angle (°) of the camera from straight down: seen from above, walls would be lines.
_PITCH = 55.0

# Angle (°) of the camera from south: seen from south, walls from south to north would be lines.
_YAW = 35.0

# The same in front of facades, seen nearly level.
_PITCH_OF_FRONT = 75.0

# Features of a layer that are looked at: some hundred show how high it lies, and where it looks.
_LOOKED_AT = 500

# Distance of the camera, in sides of the extent that is shown.
_AWAY = 1.8


def show_view(iface: Any) -> None:
    """Open a 3D view with the layers of the current group alone, or with all visible ones where it has no vectors."""
    layers = layers_to_show(iface.layerTreeView().currentGroupNode(), iface.mapCanvas().layers())
    if not layers:
        iface.messageBar().pushInfo("3D", "There is no layer to show; run a model first.")
        return
    _give_metric_system(iface, layers)
    canvas = iface.createNewMapCanvas3D(f"3D: {layers[0].name()}")
    settings = canvas.mapSettings()
    settings.setLayers(layers)
    # The flat terrain of a new view lies at 0 and hides what lies below.
    settings.setTerrainRenderingEnabled(False)
    extent = QgsRectangle()
    for layer in layers:
        change = QgsCoordinateTransform(layer.crs(), settings.crs(), QgsProject.instance())
        extent.combineExtentWith(change.transformBoundingBox(layer.extent()))
    look_at(canvas, extent, *heights_of(layers), *view_angles(layers))


def look_at(canvas: Any, extent: QgsRectangle, low: float, high: float, pitch: float, yaw: float) -> None:
    """Look at a box: its extent in the system of the view, its elevations, and the angles (°) of the camera."""
    middle, origin = extent.center(), canvas.mapSettings().origin()
    at = QgsVector3D(middle.x() - origin.x(), (low + high) / 2 - origin.z(), -(middle.y() - origin.y()))
    away = _AWAY * max(extent.width(), extent.height(), high - low, 1.0)
    canvas.cameraController().setLookingAtPoint(at, away, pitch, yaw)


def _give_metric_system(iface: Any, layers: list[QgsMapLayer]) -> None:
    """Give the project the system of a layer, or local meters, where it has none or degrees: views would be empty."""
    project = QgsProject.instance()
    if project.crs().isValid() and not project.crs().isGeographic():
        return
    systems = (layer.crs() for layer in layers)
    found = next((crs for crs in systems if crs.isValid() and not crs.isGeographic()), None)
    project.setCrs(found or QgsCoordinateReferenceSystem(SIMULATED_CRS))
    if found is not None:
        return
    text = "The layers name no coordinate reference system; they are shown in local meters."
    push_with_button(iface, "3D", text, "Choose a system…", lambda: _choose_system(iface))


def _choose_system(iface: Any) -> None:
    """Let the user choose the coordinate reference system of the project."""
    dialog = QgsProjectionSelectionDialog(iface.mainWindow())
    dialog.setCrs(QgsProject.instance().crs())
    if dialog.exec():
        QgsProject.instance().setCrs(dialog.crs())


def heights_of(layers: list[QgsMapLayer]) -> tuple[float, float]:
    """Return the least and the greatest elevation of the first layer with heights; 0 and 0 without."""
    for layer in layers:
        corners = [corner.z() for corner in _corners(layer) if corner.is3D()]
        if corners:
            return min(corners), max(corners)
    return 0.0, 0.0


def view_angles(layers: list[QgsMapLayer]) -> tuple[float, float]:
    """Return pitch and yaw (°) of the camera: in front of facades, from aside of everything else.

    Facades are upright polygons. Most of their area looks to one side, which the order of their corners says; walls of
    solids look to all sides.
    """
    fronts = np.array([normal for layer in layers for normal in _normals(layer)]).reshape(-1, 3)
    east, north, up = fronts.sum(axis=0).tolist()
    total = np.linalg.norm(fronts, axis=1).sum()
    if not len(fronts) or math.hypot(east, north) < MAJORITY * total or abs(up) > math.hypot(east, north):
        return _PITCH, _YAW
    return _PITCH_OF_FRONT, math.degrees(math.atan2(east, -north)) % 360.0


def _corners(layer: QgsMapLayer) -> Iterator[QgsPoint]:
    """Yield the corners of the first features of a vector layer."""
    if isinstance(layer, QgsVectorLayer):
        for feature in islice(layer.getFeatures(), _LOOKED_AT):
            yield from feature.geometry().vertices()


def _normals(layer: QgsMapLayer) -> Iterator[np.ndarray]:
    """Yield the normals (3,) of the first polygons of a layer in space, as long as their areas."""
    if not isinstance(layer, QgsVectorLayer) or not QgsWkbTypes.hasZ(layer.wkbType()):
        return
    for feature in islice(layer.getFeatures(), _LOOKED_AT):
        for part in feature.geometry().constParts():
            ring = part.exteriorRing() if hasattr(part, "exteriorRing") else None
            if ring is not None:
                yield area_vector(np.array([(corner.x(), corner.y(), corner.z()) for corner in ring.points()]))


def layers_to_show(group: QgsLayerTree, visible: list[QgsMapLayer]) -> list[QgsMapLayer]:
    """Return the visible layers of a group with vectors, else all visible layers, if they can be shown in space."""
    of_group = [node.layer() for node in group.findLayers() if node.isVisible()]
    chosen = of_group if any(isinstance(layer, QgsVectorLayer) for layer in of_group) else visible
    return [layer for layer in chosen if layer is not None and layer.renderer3D() is not None]
