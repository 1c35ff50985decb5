"""What several modules of these tests do: run an algorithm, draw a layer, open a raster."""

from __future__ import annotations

import numpy as np
from osgeo import gdal
from qgis.core import QgsCoordinateReferenceSystem, QgsFeature, QgsGeometry, QgsVectorLayer


def run(name, parameters, context, log):
    import processing

    return processing.run(f"lidarbuildings:{name}", parameters, context=context, feedback=log, is_child_algorithm=True)


def vector(kind, rows, crs="EPSG:28992", fields="field=id:int&field=height:double&field=word:string"):
    """A layer in memory of (WKT, attributes) rows."""
    layer = QgsVectorLayer(f"{kind}?crs={crs}&{fields}" if crs else f"{kind}?{fields}", "drawn", "memory")
    if not crs:
        layer.setCrs(QgsCoordinateReferenceSystem())
    for wkt, attributes in rows:
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromWkt(wkt) if wkt else QgsGeometry())
        feature.setAttributes(attributes)
        assert layer.dataProvider().addFeature(feature)
    return layer


def squares(*corners, crs="EPSG:28992", size=2.0):
    rows = []
    for x, y in corners:
        ring = [(x, y), (x + size, y), (x + size, y + size), (x, y + size), (x, y)]
        rows.append((f"Polygon (({', '.join(f'{u!r} {v!r}' for u, v in ring)}))", [1, 1.0, ""]))
    return vector("Polygon", rows, crs)


def opened(path):
    gdal.UseExceptions()
    return gdal.Open(str(path))


def values_of(image):
    band = image.GetRasterBand(1)
    raw = band.ReadRaster(buf_type=gdal.GDT_Float32)
    return np.frombuffer(raw, np.float32).reshape(image.RasterYSize, image.RasterXSize)


class Interface:
    """What the menu asks of QGIS's windows."""

    def __init__(self, active, visible, extent, crs):
        self.active, self.visible, self.extent, self.crs = active, visible, extent, QgsCoordinateReferenceSystem(crs)

    def activeLayer(self):
        return self.active

    def mapCanvas(self):
        crs = self.crs
        settings = type("S", (), {"destinationCrs": lambda self: crs})()
        visible, extent = self.visible, self.extent
        return type(
            "C",
            (),
            {"layers": lambda self: visible, "extent": lambda self: extent, "mapSettings": lambda self: settings},
        )()
