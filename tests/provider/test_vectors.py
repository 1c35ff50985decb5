"""Layers of stages as QGIS features: every geometry, with and without heights, and none at all."""

from __future__ import annotations

import numpy as np
import pytest
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsVariantUtils,
    QgsVectorFileWriter,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QMetaType

from lidar_buildings.algorithms.stage import Field, Layer, LayerFeatures
from lidar_buildings.provider.vectors import fields_of, plain, qgis_features, wkb_type

FIELDS = (Field("id", int, "Number."), Field("height", float, "Height.", "m"), Field("word", str, "Word."))
SQUARE = np.array([[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], float)
HOLE = np.array([[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]], float)


def raised(flat):
    return np.column_stack([flat, np.full(len(flat), 5.0)])


def shifted(coordinates):
    return coordinates + np.array([100.0, 200.0, 0.0])[: coordinates.shape[1]]


@pytest.mark.parametrize(
    ("kind", "geometry", "wkb", "wkt"),
    [
        (
            "Polygon",
            [SQUARE, HOLE],
            Qgis.WkbType.Polygon,
            "Polygon ((100 200, 104 200, 104 204, 100 204, 100 200),(101 201, 101 202, 102 202, 102 201, 101 201))",
        ),
        ("Polygon", [raised(HOLE)], Qgis.WkbType.PolygonZ, "((101 201 5, 101 202 5, 102 202 5, 102 201 5, 101 201 5))"),
        ("LineString", SQUARE[:2], Qgis.WkbType.LineString, "LineString (100 200, 104 200)"),
        ("LineString", raised(SQUARE[:2]), Qgis.WkbType.LineStringZ, "(100 200 5, 104 200 5)"),
        ("Point", np.array([1.0, 2.0]), Qgis.WkbType.Point, "Point (101 202)"),
        ("Point", np.array([1.0, 2.0, 3.0]), Qgis.WkbType.PointZ, "(101 202 3)"),
    ],
)
def test_geometries_come_out_in_map_coordinates(kind, geometry, wkb, wkt):
    layer = Layer("things", "Things", kind, FIELDS)
    features = LayerFeatures(
        [geometry], {"id": np.array([3], np.int32), "height": np.array([2.5], "f4"), "word": ["a"]}
    )
    (feature,) = qgis_features(layer, features, shifted)
    assert feature.geometry().wkbType() == wkb == wkb_type(layer, features)
    assert feature.geometry().asWkt(0).endswith(wkt)
    assert feature.attributes() == [3, 2.5, "a"]
    assert [type(value) for value in feature.attributes()] == [int, float, str]


def test_nothing_found_is_an_empty_layer():
    layer = Layer("things", "Things", "Polygon", FIELDS)
    empty = LayerFeatures([], {"id": [], "height": [], "word": []})
    assert list(qgis_features(layer, empty, shifted)) == []
    assert wkb_type(layer, empty) == Qgis.WkbType.Polygon
    assert fields_of(layer, empty).names() == ["id", "height", "word"]


@pytest.mark.parametrize(
    ("value", "wanted"),
    [
        (np.float32(0.5), 0.5),
        (np.int64(7), 7),
        (np.bool_(True), True),
        (float("nan"), None),
        (np.nan, None),
        (np.inf, None),
        ("a", "a"),
    ],
)
def test_values_are_pythons_own(value, wanted):
    assert plain(value) == wanted
    assert type(plain(value)) is type(wanted)


def test_positions_among_the_attributes_are_in_map_coordinates():
    east, north = (Field(name, float, "Position.", axis=axis) for axis, name in enumerate(("x1", "y1")))
    layer = Layer("places", "Places", "Point", (Field("id", int, "Number."), east, north))
    features = LayerFeatures([np.array([1.0, 2.0])], {"id": [1], "x1": [3.0], "y1": np.array([4.0])})
    (feature,) = qgis_features(layer, features, shifted)
    assert feature.attributes() == [1, 103.0, 204.0]


def test_other_columns_are_fields_of_their_type():
    """Attributes of a map that a stage keeps, which are not declared before the run."""
    layer = Layer("things", "Things", "Polygon", FIELDS)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]], float)
    columns = {"id": [1, 2], "height": [1.0, 2.0], "word": ["a", "b"]}
    others = {"year": [1652, None], "share": [0.5, 1], "name": ["x", None], "mixed": [1, "y"], "empty": [None, None]}
    others["listed"] = [True, None]
    made = LayerFeatures([[square]] * 2, {**columns, **others})
    fields = fields_of(layer, made)
    types = {field.name(): field.typeName().lower() for field in fields}
    assert list(types)[3:] == ["year", "share", "name", "mixed", "empty", "listed"]
    assert types["year"] == types["id"]
    assert types["share"] == types["height"]
    assert types["name"] == types["mixed"] == types["empty"] == types["word"]
    first, second = qgis_features(layer, made, shifted)
    assert (first["year"], first["share"], first["mixed"]) == (1652, 0.5, "1")
    assert second["mixed"] == "y"
    assert (first["listed"], fields["listed"].type()) == (True, QMetaType.Type.Bool)


def test_keys_of_a_map_with_more_than_32_bits_come_whole_into_a_file(tmp_path):
    layer = Layer("things", "Things", "Polygon", FIELDS)
    keys = [1680100000012345, None]
    made = LayerFeatures([[SQUARE]] * 2, {"id": [1, 2], "height": [1.0, 2.0], "word": ["a", "b"], "key": keys})
    path, options = str(tmp_path / "keys.gpkg"), QgsVectorFileWriter.SaveVectorOptions()
    crs, context = QgsCoordinateReferenceSystem("EPSG:28992"), QgsCoordinateTransformContext()
    writer = QgsVectorFileWriter.create(path, fields_of(layer, made), Qgis.WkbType.Polygon, crs, context, options)
    assert writer.addFeatures(list(qgis_features(layer, made, shifted))), writer.errorMessage()
    del writer
    read = QgsVectorLayer(path, "keys", "ogr").getFeatures()
    assert [None if QgsVariantUtils.isNull(one["key"]) else one["key"] for one in read] == keys
