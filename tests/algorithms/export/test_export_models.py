"""Exported files are read back: surfaces closed, with the volumes and areas of the solids they were made of."""

import base64
import json
import re

import numpy as np
import pytest

from lidar_buildings.algorithms.export.cityjson_faces import read_cityjson
from lidar_buildings.algorithms.export.export_models import export_models, glb_pieces, page_pieces
from lidar_buildings.algorithms.models3d.cityjson import CITYJSON, CITYJSON_SEQ, cityjson_pieces
from lidar_buildings.algorithms.models3d.reconstruct_block import reconstruct_block
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame
from lidar_buildings.tests.glb_reader import Glb

FRAME = MapFrame(lambda local: np.asarray(local, float) + np.array([85_000.0, 447_000.0, 0.0]), "EPSG:28992")
RINGS = [np.array([[w, 4], [w + 8, 4], [w + 8, 14], [w, 14], [w, 4.0]]) for w in (5.0, 30.0)]


def scene():
    """Return points and classes of a gable house (ridge at 8 m, eaves at 6 m) and a flat one of 4 m."""
    x, y = np.mgrid[0:45:0.4, 0:20:0.4].reshape(2, -1)
    is_gable = (abs(x - 9) < 4) & (abs(y - 9) < 5)
    is_flat = (abs(x - 34) < 4) & (abs(y - 9) < 5)
    z = np.where(is_gable, 8 - 0.5 * abs(x - 9), np.where(is_flat, 4.0, 0.0))
    return np.column_stack([x, y, z]), np.where(is_gable | is_flat, 6, 2)


@pytest.fixture(scope="module")
def models():
    footprints = LayerFeatures([[ring] for ring in RINGS], {"id": ["a", "b"], "use": ["school", None]})
    return reconstruct_roofs(*scene(), footprints, id_field="id")


def glb_of(models, frame=FRAME):
    (raw,) = glb_pieces(models, "GLB", frame)
    return Glb(raw)


def from_layers(models):
    buildings, walls, roofs, *_ = models
    return export_models(buildings=buildings, walls=walls, roofs=roofs)[0]


def from_cityjson(models, called=CITYJSON):
    features, code = read_cityjson("".join(cityjson_pieces(models[4], called, FRAME)))
    assert code == FRAME.crs
    rings = [[ring - [85_000, 447_000, 0] for ring in rings] for rings in features.geometries]
    return export_models(cityjson=LayerFeatures(rings, features.columns))[0]


def assert_closed(triangles):
    """Fail unless each edge of triangles (n, 3, 3) is there once in each direction, with the same bits."""
    corners = [[tuple(corner) for corner in triangle] for triangle in triangles.tolist()]
    edges = [(one[i], one[(i + 1) % 3]) for one in corners for i in range(3)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)


@pytest.mark.parametrize("source", [from_layers, from_cityjson, lambda m: from_cityjson(m, CITYJSON_SEQ)])
def test_glb_has_the_volumes_and_areas_of_the_solids(models, source):
    glb = glb_of(source(models))
    positions, normals, building, _, material = glb.triangles()
    assert [glb.root["materials"][m]["name"] for m in np.unique(material)] == ["roof", "wall", "ground"]
    across = np.cross(positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0]) / 2
    area = np.linalg.norm(across, axis=1)
    np.testing.assert_allclose(across / area[:, None], normals[:, 0], atol=1e-5)
    for number, one in enumerate(models[4]):
        of_one = building == number
        assert_closed(positions[of_one])
        volume = np.einsum("ij,ij->", positions[of_one, 0], across[of_one]) / 3
        assert volume == pytest.approx(sum(solid.volume for solid in one.model.best), rel=1e-5)
    np.testing.assert_allclose(area[(material == 0) & (building == 0)].sum(), 80 * np.sqrt(1.25), rtol=0.01)
    assert positions.min(axis=(0, 1)) == pytest.approx([5, 4, 0], abs=0.05)
    assert positions.max(axis=(0, 1)) == pytest.approx([38, 14, 8], abs=0.05)


@pytest.mark.parametrize("source", [from_layers, from_cityjson])
def test_buildings_and_faces_keep_their_attributes(models, source):
    glb = glb_of(source(models))
    of_buildings, of_faces = glb.table(0), glb.table(1)
    assert of_buildings["name"] == ["a", "b"]
    assert of_buildings["roof_type"] == ["gable", "flat"]
    assert of_buildings["use"] == ["school", None]
    assert of_buildings["points"] == models[0].columns["points"]
    np.testing.assert_allclose(of_buildings["volume"], models[0].columns["volume"], atol=0.001)
    assert "volume" not in of_faces
    assert of_faces["kind"] == ["roof"] * 3 + ["wall"] * 8 + ["ground"] * 2
    np.testing.assert_allclose(of_faces["slope"][:3], models[2].columns["slope"], atol=0.001)
    assert of_faces["slope"][3:] == [None] * 10
    _, _, building, face, _ = glb.triangles()
    assert sorted(set(building[face == 2])) == [1], "the third roof is the flat house's"


def test_glb_names_where_it_is(models):
    extras = glb_of(from_layers(models)).root["asset"]["extras"]
    assert extras == {"crs": "EPSG:28992", "origin": [85_000.0, 447_000.0, 0.0]}


def test_page_has_the_file_in_it(models):
    exported = from_layers(models)
    page = "".join(part if isinstance(part, str) else part.decode() for part in page_pieces(exported, "HTML", FRAME))
    (raw,) = glb_pieces(exported, "GLB", FRAME)
    (found,) = re.findall(r'<script id="glb" type="text/plain">(.*)</script>', page)
    assert base64.b64decode(found, validate=True) == raw
    assert not re.findall(r"(?:src|href)=|https?:|import|fetch", page.replace(found, "")), "it needs nothing else"


def test_windows_and_holes_stay_closed():
    front = [np.array([[5, 4, 0], [13, 4, 0], [13, 4, 6], [5, 4, 6], [5, 4, 0.0]])]
    window = [np.array([[8, 4, 2], [9, 4, 2], [9, 4, 3], [8, 4, 3], [8, 4, 2.0]])]
    footprints = LayerFeatures([[RINGS[0]]], {"id": ["a"]})
    facades, openings = LayerFeatures([front], {}), LayerFeatures([window], {"kind": ["window"]})
    buildings, walls, roofs, set_openings, _ = reconstruct_block(*scene(), footprints, facades, openings)
    glb = glb_of(export_models(buildings=buildings, walls=walls, roofs=roofs, openings=set_openings)[0])
    positions, _, _, _, material = glb.triangles()
    assert_closed(positions)
    across = np.cross(positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0]) / 2
    assert np.linalg.norm(across[material == 3], axis=1).sum() == pytest.approx(1.0)


def test_faces_of_other_programs_get_kinds_by_their_slope():
    corners = [[x, y, z] for z in (0, 3) for y in (0, 2) for x in (0, 2)]
    sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
    part = {"type": "Solid", "lod": 2, "boundaries": [[[side] for side in sides]]}
    line = {"type": "MultiSurface", "lod": 2, "boundaries": [[[0, 1, 1]], []]}
    lod0 = {"type": "MultiSurface", "lod": "0", "boundaries": [[sides[0]]]}
    text = json.dumps(
        {
            "type": "CityJSON",
            "version": "1.0",
            "metadata": {"referenceSystem": "urn:ogc:def:crs:EPSG::7415"},
            "CityObjects": {
                "NL.1": {"type": "Building", "attributes": {"year": 1900, "tags": ["a"], "none": None}},
                "NL.1-0": {"type": "BuildingPart", "parents": ["NL.1"], "geometry": [lod0, part, line]},
                "road": {"type": "Road", "geometry": [part]},
            },
            "vertices": corners,
        }
    )
    features, code = read_cityjson(text)
    assert code == "EPSG:7415"
    (model,) = export_models(cityjson=features)[0]
    assert (model.name, model.facts) == ("NL.1-0", {"year": 1900, "tags": '["a"]'})
    assert list(model.levels) == ["2"]
    assert [face.kind for face in model.best] == ["ground", "roof", "wall", "wall", "wall", "wall"]


HOLLOW = {"type": "Solid", "lod": "2", "boundaries": [[[[7, 8, 9]]]]}
DAMAGED = {"type": "CityJSON", "vertices": [], "CityObjects": {"a": {"type": "Building", "geometry": [HOLLOW]}}}


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{}", '{"type": "FeatureCollection"}', '{"type": "CityJSON"}', "[" * 100_000, json.dumps(DAMAGED)],
)
def test_other_files_are_refused(text):
    with pytest.raises(ValueError, match="no sound CityJSON"):
        read_cityjson(text)


def test_flat_polygons_are_refused():
    with pytest.raises(ValueError, match=r"no model to export \(1 polygons without heights\)"):
        export_models(buildings=LayerFeatures([[RINGS[0]]], {"id": [1]}))
