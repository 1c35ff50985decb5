"""A view in three dimensions of what a run made, from the side."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsCoordinateTransform,
    QgsLayerTree,
    QgsMapLayer,
    QgsProject,
    QgsRectangle,
    QgsVector3D,
    QgsVectorLayer,
)

from .texts import tr

# Angle (°) of the camera from straight down: seen from above, walls would be lines.
_PITCH = 55.0

# Angle (°) of the camera from south: seen from south, walls from south to north would be lines.
_YAW = 35.0

# Distance of the camera, in sides of the extent that is shown.
_AWAY = 1.8


def show_view(iface: Any) -> None:
    """Open a 3D view with the layers of the current group alone, or with all visible ones where it has no vectors."""
    layers = layers_to_show(iface.layerTreeView().currentGroupNode(), iface.mapCanvas().layers())
    if not layers:
        iface.messageBar().pushInfo(tr("3D"), tr("There is no layer to show; run a model first."))
        return
    canvas = iface.createNewMapCanvas3D(tr("3D: {}").format(layers[0].name()))
    settings = canvas.mapSettings()
    settings.setLayers(layers)
    extent = QgsRectangle()
    for layer in layers:
        change = QgsCoordinateTransform(layer.crs(), settings.crs(), QgsProject.instance())
        extent.combineExtentWith(change.transformBoundingBox(layer.extent()))
    middle, origin = extent.center(), settings.origin()
    at = QgsVector3D(middle.x() - origin.x(), _elevation(layers) - origin.z(), -(middle.y() - origin.y()))
    canvas.cameraController().setLookingAtPoint(at, _AWAY * max(extent.width(), extent.height(), 1.0), _PITCH, _YAW)


def _elevation(layers: list[QgsMapLayer]) -> float:
    """Return the elevation of a corner of the first layer with heights, 0 without."""
    for layer in layers:
        feature = next(layer.getFeatures(), None) if isinstance(layer, QgsVectorLayer) else None
        corner = next(feature.geometry().vertices(), None) if feature is not None else None
        if corner is not None and corner.is3D():
            return float(corner.z())
    return 0.0


def layers_to_show(group: QgsLayerTree, visible: list[QgsMapLayer]) -> list[QgsMapLayer]:
    """Return the visible layers of a group with vectors, else all visible layers, if they can be shown in space."""
    of_group = [node.layer() for node in group.findLayers() if node.isVisible()]
    chosen = of_group if any(isinstance(layer, QgsVectorLayer) for layer in of_group) else visible
    return [layer for layer in chosen if layer is not None and layer.renderer3D() is not None]
