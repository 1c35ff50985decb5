#!/usr/bin/env python3
"""Draw a classified cloud (COPC) with its footprints over it, as QGIS shows them.

Usage: ``picture.py cloud.copc.laz footprints picture.png``
"""

from __future__ import annotations

import sys
from pathlib import Path

from qgis.core import (
    QgsApplication,
    QgsMapLayer,
    QgsMapRendererCustomPainterJob,
    QgsMapSettings,
    QgsPointCloudLayer,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor, QImage, QPainter

STYLES = Path(__file__).resolve().parent.parent / "resources" / "styles"
LONGER_SIDE = 1600  # pixels
MARGIN = 1.03  # the cloud's extent grown by this factor


def styled(layer: QgsMapLayer, style: str) -> QgsMapLayer:
    """Return the layer in one of the plugin's own styles.

    Raises
    ------
    ValueError
        If the layer or its style can't be opened.
    """
    if not layer.isValid():
        raise ValueError(f"QGIS can't open {layer.source()}: {layer.error().summary()}")
    message, is_styled = layer.loadNamedStyle(str(STYLES / f"{style}.qml"))
    if not is_styled:
        raise ValueError(f"The style {style} can't be loaded: {message}")
    return layer


def draw(layers: list[QgsMapLayer], extent) -> QImage:
    """Return the layers, the first on top, as an image."""
    longer = LONGER_SIDE / max(extent.width(), extent.height())
    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setDestinationCrs(layers[-1].crs())
    settings.setOutputSize(QSize(round(extent.width() * longer), round(extent.height() * longer)))
    settings.setExtent(extent)
    settings.setBackgroundColor(QColor("white"))
    image = QImage(settings.outputSize(), QImage.Format.Format_RGB32)
    image.fill(settings.backgroundColor())
    painter = QPainter(image)
    job = QgsMapRendererCustomPainterJob(settings, painter)
    job.start()
    job.waitForFinished()
    painter.end()
    return image


def main(cloud_path: str, footprints_path: str, picture_path: str) -> None:
    """Draw, save, and say how many buildings are to be seen."""
    cloud = styled(QgsPointCloudLayer(cloud_path, "Point cloud", "copc"), "classification")
    footprints = styled(QgsVectorLayer(footprints_path, "Buildings", "ogr"), "footprints")
    extent = cloud.extent()
    extent.scale(MARGIN)
    if not draw([footprints, cloud], extent).save(picture_path):
        raise ValueError(f"The picture can't be written to {picture_path}.")
    count = footprints.featureCount()
    print(f"{count} building{'' if count == 1 else 's'} found in {cloud.pointCount():,} points:")


if __name__ == "__main__":
    application = QgsApplication([], False)
    application.initQgis()
    try:
        main(*sys.argv[1:])
    except ValueError as error:
        sys.exit(str(error))
    finally:
        application.exitQgis()
