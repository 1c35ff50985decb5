"""CityJSON and CityJSONSeq pass the official schemas, version 2.0.2, where CITYJSON_SCHEMAS names a folder of them.

These are cityjson.min.schema.json and cityjsonfeature.min.schema.json, as github.com/cityjson/specs publishes them.
"""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.export.textured_cityjson import cityjson_pieces as textured_pieces
from lidar_buildings.algorithms.models3d.cityjson import CITYJSON, CITYJSON_SEQ, cityjson_pieces
from lidar_buildings.algorithms.models3d.reconstruct_block import reconstruct_block
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame
from lidar_buildings.tests.colored_models import exported, points

jsonschema = pytest.importorskip("jsonschema", reason="the package jsonschema is not installed")

SCHEMAS = os.environ.get("CITYJSON_SCHEMAS", "")
pytestmark = pytest.mark.skipif(not SCHEMAS, reason="CITYJSON_SCHEMAS names no folder with the official schemas")


def errors(whole, kind):
    schema = json.loads(Path(SCHEMAS, f"{kind}.min.schema.json").read_text("utf-8"))
    return [error.message for error in jsonschema.Draft7Validator(schema).iter_errors(whole)]


@pytest.fixture(scope="module")
def models():
    """Two houses with all levels of detail; one has a window and a door."""
    x, y = np.mgrid[0:45:0.4, 0:20:0.4].reshape(2, -1)
    is_gable, is_flat = ((abs(x - middle) < 4) & (abs(y - 9) < 5) for middle in (9, 34))
    z = np.where(is_gable, 8 - 0.5 * abs(x - 9), np.where(is_flat, 4.0, 0.0))
    rings = [np.array([[w, 4], [w + 8, 4], [w + 8, 14], [w, 14], [w, 4.0]]) for w in (5.0, 30.0)]
    front = np.array([[5, 4, 0], [13, 4, 0], [13, 4, 6], [5, 4, 6], [5, 4, 0.0]])
    window, door = (
        np.array([[w, 4, low], [w + 1, 4, low], [w + 1, 4, high], [w, 4, high], [w, 4, low]])
        for w, low, high in ((7, 2.0, 3.0), (10, 0.1, 2.2))
    )
    footprints = LayerFeatures([[ring] for ring in rings], {"id": ["a", "b"]})
    openings = LayerFeatures([[window], [door]], {"kind": ["window", "door"]})
    classes = np.where(is_gable | is_flat, 6, 2)
    return reconstruct_block(np.column_stack([x, y, z]), classes, footprints, LayerFeatures([[front]], {}), openings)[
        -1
    ]


@pytest.mark.parametrize("crs", ["EPSG:7415", ""])
def test_cityjson_passes_the_schema(models, crs):
    whole = json.loads("".join(cityjson_pieces(models, CITYJSON, MapFrame(np.asarray, crs))))
    kinds = {
        surface["type"]
        for one in whole["CityObjects"].values()
        for geometry in one["geometry"]
        for surface in geometry["semantics"]["surfaces"]
    }
    assert kinds == {"RoofSurface", "WallSurface", "GroundSurface", "Window", "Door"}
    assert errors(whole, "cityjson") == []


def test_a_file_without_models_passes_the_schema():
    whole = json.loads("".join(cityjson_pieces([], CITYJSON, MapFrame(np.asarray, "EPSG:7415"))))
    assert errors(whole, "cityjson") == []


def test_each_line_of_a_sequence_passes_its_schema(models):
    head, *features = map(json.loads, "".join(cityjson_pieces(models, CITYJSON_SEQ, MapFrame(np.asarray))).splitlines())
    assert errors(head, "cityjson") == []
    assert len(features) == 2
    assert [errors(feature, "cityjsonfeature") for feature in features] == [[], []]


@pytest.mark.parametrize("called", [CITYJSON, CITYJSON_SEQ])
def test_terrain_passes_the_schema(called):
    x, y = np.mgrid[0:20:0.5, 0:20:0.5].reshape(2, -1)
    is_house = (abs(x - 9) < 4) & (abs(y - 9) < 5)
    ring = np.array([[5, 4], [13, 4], [13, 14], [5, 14], [5, 4.0]])
    xyz = np.column_stack([x, y, np.where(is_house, 8.0, 0.1 * x)])
    house = LayerFeatures([[ring]], {})
    items = reconstruct_roofs(xyz, np.where(is_house, 6, 2), house, terrain_tolerance=0.2)[4]
    lines = "".join(cityjson_pieces(items, called, MapFrame(np.asarray))).strip()
    wholes = [json.loads(line) for line in lines.split("\n" if called == CITYJSON_SEQ else "\0")]
    objects = {name: one for whole in wholes for name, one in whole["CityObjects"].items()}
    assert objects["terrain 0 0"]["type"] == "TINRelief"
    kinds = ["cityjson", *["cityjsonfeature"] * 2]
    assert [error for whole, kind in zip(wholes, kinds) for error in errors(whole, kind)] == []


def test_faces_with_images_pass_the_schema():
    pieces = textured_pieces(exported(*points()), CITYJSON, MapFrame(np.asarray, "EPSG:7415"))
    whole = json.loads("".join(piece for piece in pieces if isinstance(piece, str)))
    assert len(whole["appearance"]["textures"]) == 1
    assert errors(whole, "cityjson") == []


def test_the_schema_finds_faults(models):
    whole = json.loads("".join(cityjson_pieces(models, CITYJSON, MapFrame(np.asarray))))
    next(iter(whole["CityObjects"].values()))["geometry"][0]["semantics"]["surfaces"][0]["type"] = "Roof"
    assert errors(whole, "cityjson")
