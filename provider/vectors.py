"""Layers that stages make, as QGIS features."""

from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsFeature,
    QgsField,
    QgsFields,
    QgsGeometry,
    QgsLineString,
    QgsPoint,
    QgsPolygon,
    QgsVectorFileWriter,
    QgsVectorLayer,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QMetaType

from ..algorithms.stage import Field, Layer, LayerFeatures, all_fields, column_on_map, plain
from .memory_files import memory_folder
from .qgis_crs import Conversion

_TYPES = {bool: QMetaType.Type.Bool, int: QMetaType.Type.Int, float: QMetaType.Type.Double, str: QMetaType.Type.QString}
WKB = {"Polygon": Qgis.WkbType.Polygon, "LineString": Qgis.WkbType.LineString, "Point": Qgis.WkbType.Point}
SOURCE_TYPES = {
    "Polygon": Qgis.ProcessingSourceType.VectorPolygon,
    "LineString": Qgis.ProcessingSourceType.VectorLine,
    "Point": Qgis.ProcessingSourceType.VectorPoint,
}

# Written to find out whether a format holds geometries and attributes: near the origin, which each system has.
_SAMPLES = {
    Qgis.ProcessingSourceType.VectorPolygon: "Polygon ((0 0, 1 0, 1 1, 0 0))",
    Qgis.ProcessingSourceType.VectorLine: "LineString (0 0, 1 1)",
    Qgis.ProcessingSourceType.VectorPoint: "Point (1 1)",
}
_WORD = "word"

# Features that are read or written, and pieces of texts that are written, between two looks at whether to stop.
BETWEEN_CHECKS = 1000


def check_layer(path: Path, kind: Qgis.ProcessingSourceType) -> None:
    """Refuse a file name whose extension is of no format that holds a layer: QGIS would write another file, or lose it.

    Raises
    ------
    ValueError
        If it has no extension, or the extension of a format without such geometries or without attributes.
    """
    extension = path.suffix.lower().lstrip(".")
    if extension not in QgsVectorFileWriter.supportedFormatExtensions() or not _holds(extension, kind):
        raise ValueError(f"{path.name} can't be written as a layer: give it the extension .gpkg, .shp or .geojson.")


@cache
def _holds(extension: str, kind: Qgis.ProcessingSourceType) -> bool:
    """Whether a feature comes back with geometry and attributes from a file with this extension: it is tried."""
    fields, options = QgsFields(), QgsVectorFileWriter.SaveVectorOptions()
    for number, of_type in enumerate(_TYPES.values()):
        fields.append(QgsField(f"field{number}", of_type))
    options.driverName = driver = QgsVectorFileWriter.driverForExtension(extension)
    options.datasourceOptions = QgsVectorFileWriter.defaultDatasetOptions(driver)
    options.layerOptions = QgsVectorFileWriter.defaultLayerOptions(driver)
    feature = QgsFeature(fields)
    feature.setGeometry(QgsGeometry.fromWkt(_SAMPLES[kind]))
    feature.setAttributes([True, 1, 1.5, _WORD])
    wkb, of_none = feature.geometry().wkbType(), (QgsCoordinateReferenceSystem(), QgsCoordinateTransformContext())
    with memory_folder() as folder:
        path = f"{folder}/trial.{extension}"
        writer = QgsVectorFileWriter.create(path, fields, wkb, *of_none, options)
        is_written = writer.hasError() == QgsVectorFileWriter.WriterError.NoError and writer.addFeature(feature)
        # The file is closed with the writer, and complete.
        del writer
        back = list(QgsVectorLayer(path, "trial", "ogr").getFeatures()) if is_written else []
        kinds = [one.geometry().type() for one in back if _WORD in one.attributes()]
    return kinds == [feature.geometry().type()]


def fields_of(layer: Layer, features: LayerFeatures) -> QgsFields:
    """Return the fields of a layer, and of other columns that its features have: attributes of a map."""
    fields = QgsFields()
    for declared in all_fields(layer, features):
        fields.append(QgsField(declared.name, _type_in_qgis(declared, features.columns[declared.name])))
    return fields


def _type_in_qgis(declared: Field, column: Sequence) -> QMetaType.Type:
    """Return the type of a field: with 64 bits where a whole number needs them, as keys of buildings in maps do."""
    is_long = declared.type is int and any(value is not None and abs(value) >= 2**31 for value in column)
    return QMetaType.Type.LongLong if is_long else _TYPES[declared.type]


def wkb_type(layer: Layer, features: LayerFeatures) -> Qgis.WkbType:
    """Return the geometry type: with Z when the stage gave heights."""
    flat = WKB[layer.geometry]
    return QgsWkbTypes.addZ(flat) if any(_width(geometry) == 3 for geometry in features.geometries[:1]) else flat


def _width(geometry: Any) -> int:
    return np.shape(geometry[0] if isinstance(geometry, (list, tuple)) else geometry)[-1]


def qgis_features(layer: Layer, features: LayerFeatures, to_map: Conversion) -> Iterator[QgsFeature]:
    """Yield the features of a layer, in the coordinates of the cloud's CRS.

    ``to_map`` turns local meters (m, 2 or 3) into map coordinates.
    """
    fields = fields_of(layer, features)
    make = _GEOMETRIES[layer.geometry]
    columns = [column_on_map(declared, features, to_map) for declared in all_fields(layer, features)]
    for row, geometry in enumerate(features.geometries):
        feature = QgsFeature(fields)
        source = features.sources[row] if features.sources else None
        feature.setGeometry(source or QgsGeometry(make(geometry, to_map)))
        feature.setAttributes([plain(column[row]) for column in columns])
        yield feature


def number(value: Any) -> Any:
    """Return a number of a run as QGIS lists it at the end of the log: with the seven digits that 32 bits hold."""
    value = plain(value)
    return float(f"{value:.7g}") if isinstance(value, float) else value


def _line(coordinates: np.ndarray, to_map: Conversion) -> QgsLineString:
    return QgsLineString(*(column.tolist() for column in np.asarray(to_map(np.asarray(coordinates))).T))


def _polygon(rings: list, to_map: Conversion) -> QgsPolygon:
    # One by one: rings given as a list stay Python's too, and are freed twice.
    polygon = QgsPolygon()
    polygon.setExteriorRing(_line(rings[0], to_map))
    for hole in rings[1:]:
        polygon.addInteriorRing(_line(hole, to_map))
    return polygon


def _point(coordinates: np.ndarray, to_map: Conversion) -> QgsPoint:
    return QgsPoint(*np.asarray(to_map(np.asarray(coordinates)[None]))[0].tolist())


_GEOMETRIES = {"Polygon": _polygon, "LineString": _line, "Point": _point}
