"""Models of buildings in QGIS: layers with heights, text files, and what is refused."""

from __future__ import annotations

import json

import numpy as np
import pytest
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsProcessingException,
    QgsTiledSceneLayer,
    QgsVector3D,
    QgsVectorLayer,
)
from qgis.PyQt import sip

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.provider import stage_algorithm
from lidar_buildings.provider.paths import STYLES
from lidar_buildings.tests.blocks import seen_from
from lidar_buildings.tests.glb_reader import Glb
from lidar_buildings.tests.provider.helpers import run, vector
from lidar_buildings.tests.roof_shapes import SHAPES
from lidar_buildings.tests.solid_validity import assert_valid_cityjson, assert_valid_sequence

ORIGIN = (85_000.0, 446_000.0)


@pytest.fixture
def house(tmp_path):
    """A gable house on level ground, as a file, and its footprint as a layer."""
    points, ring = SHAPES["gable"].scanned(origin=ORIGIN)
    ground = np.random.default_rng(0).uniform((-5, -5, 0), (17, 13, 0), (1500, 3)) + [*ORIGIN, 0.0]
    classes = np.repeat([6, 2], [len(points), len(ground)]).astype(np.uint8)
    path = tmp_path / "house.las"
    write_cloud(create_cloud({"xyz": np.concatenate([points, ground]), "classification": classes}), path)
    wkt = f"Polygon (({', '.join(f'{x!r} {y!r}' for x, y in ring.tolist())}))"
    return {"INPUT": str(path), "FOOTPRINTS": vector("Polygon", [(wkt, [7, 0.0, ""])])}


@pytest.mark.parametrize(
    ("name", "check"), [("m.city.json", assert_valid_cityjson), ("m.jsonl", assert_valid_sequence)]
)
def test_layers_have_heights_and_files_the_format_of_their_extension(house, context, log, out, name, check):
    wanted = {layer: str(out / f"{layer.lower()}.gpkg") for layer in ("BUILDINGS", "ROOFS", "WALLS")}
    files = {"CITYJSON": str(out / name), "OBJ": str(out / "m.obj")}
    made = run("reconstructroofs", {**house, **wanted, **files}, context, log)
    counts = {"BUILDINGS": 1, "ROOFS": 2, "WALLS": 4}
    for output, count in counts.items():
        layer = QgsVectorLayer(made[output], output)
        assert layer.featureCount() == count
        assert layer.wkbType() == Qgis.WkbType.PolygonZ
        box = layer.extent3D()
        assert (box.xMinimum(), box.yMinimum()) == pytest.approx(ORIGIN, abs=0.02)
    assert QgsVectorLayer(made["ROOFS"], "").extent3D().zMaximum() == pytest.approx(7.2, abs=0.05)
    check((out / name).read_text(encoding="utf-8"))
    assert (out / "m.obj").read_text().count("\no ") == 1
    assert sorted(path.name for path in out.iterdir()) == sorted(
        ["m.obj", name, *(f"{o.lower()}.gpkg" for o in wanted)]
    )


def test_a_terrain_is_made_when_it_is_asked_for(provider, house, context, log, out):
    """Each model of buildings loaded an empty layer of terrain."""
    definitions = provider.algorithm("modelbuildings").destinationParameterDefinitions()
    assert [one.name() for one in definitions if not one.createByDefault()] == ["TERRAIN"]
    made = run("reconstructroofs", {**house, "TERRAIN": str(out / "t.gpkg")}, context, log)
    assert QgsVectorLayer(made["TERRAIN"], "").featureCount() == 0
    assert [one for one in log.warnings if "Terrain has no features; set the terrain tolerance" in one]
    made = run("reconstructroofs", {**house, "TERRAIN": str(out / "u.gpkg"), "TERRAIN_TOLERANCE": 0.2}, context, log)
    assert QgsVectorLayer(made["TERRAIN"], "").featureCount() > 10


def test_heights_of_a_large_cloud_are_measured_in_blocks(house, context, log, out, monkeypatch):
    """The same values, in the coordinates of the map."""
    rows = []
    for name, largest in (("whole", 10_000_000), ("blocks", 0)):
        monkeypatch.setattr(stage_algorithm, "LARGEST", largest)
        made = run("computebuildingheights", {**house, "BUILDINGS": str(out / f"{name}.gpkg")}, context, log)
        (feature,) = QgsVectorLayer(made["BUILDINGS"], name).getFeatures()
        rows.append((feature.attributes()[1:], feature.geometry().asWkt(3)))
    assert rows[0] == rows[1]
    assert rows[0][0][0] == "seen"
    assert "1 of 1 features touch the points; 1 blocks of" in " ".join(log.infos)


def test_coordinates_in_a_file_are_those_of_the_map(house, context, log, out):
    made = run("reconstructroofs", {**house, "BUILDINGS": "memory:", "CITYJSON": str(out / "m.json")}, context, log)
    whole = json.loads((out / "m.json").read_text())
    places = np.array(whole["vertices"]) * whole["transform"]["scale"] + whole["transform"]["translate"]
    assert places.min(axis=0) == pytest.approx([*ORIGIN, 0.0], abs=0.02)
    assert "OBJ" not in made


def test_layers_and_cityjson_are_exported_alike(house, provider, context, log, out):
    wanted = {name: str(out / f"{name}.gpkg") for name in ("BUILDINGS", "ROOFS", "WALLS")}
    text = str(out / "m.city.json")
    run("reconstructroofs", {**house, **wanted, "CITYJSON": text}, context, log)
    run("exportmodels", {**wanted, "GLB": str(out / "layers.glb")}, context, log)
    run("exportmodels", {"CITYJSON": text, "GLB": str(out / "file.glb")}, context, log)
    with pytest.raises(QgsProcessingException, match="has no colors"):
        run("exportmodels", {"CITYJSON": text, "INPUT": house["INPUT"], "GLB": str(out / "no.glb")}, context, log)
    layers, file = (Glb((out / f"{name}.glb").read_bytes()).triangles()[0] for name in ("layers", "file"))
    assert len(layers) == len(file) == 2 * 2 + 2 * 2 + 2 * 3 + 2
    corners = [np.unique(one.reshape(-1, 3).round(3), axis=0) for one in (layers, file)]
    assert corners[0] == pytest.approx(corners[1], abs=0.002)
    algorithm = provider.algorithm("exportmodels").create()
    (out / "other.json").write_text("{}")
    for given, why in (("other.json", "other.json: The file is no sound CityJSON"), ("no.json", "there is no file")):
        accepted, message = algorithm.checkParameterValues({"CITYJSON": str(out / given), "GLB": text[:-9]}, context)
        assert not accepted
        assert why in message
    with pytest.raises(QgsProcessingException, match="There is no model to export"):
        run("exportmodels", {"GLB": str(out / "none.glb")}, context, log)
    same = (out / "m.city.json").rename(out / "same.glb")
    with pytest.raises(QgsProcessingException, match="is also an input"):
        run("exportmodels", {"CITYJSON": str(same), "GLB": str(same)}, context, log)


def test_a_tileset_is_where_qgis_has_its_models(provider, context, log, out):
    """Positions are as by QGIS's own way to coordinates from the middle of the Earth, by another formula."""
    corners = [
        [500_000, 5_700_000, 100],
        [500_010, 5_700_000, 100],
        [500_010, 5_700_008, 104],
        [500_000, 5_700_008, 104],
    ]
    surface = {"type": "MultiSurface", "lod": "2.2", "boundaries": [[[0, 1, 2, 3]]]}
    objects = {"town hall": {"type": "Building", "geometry": [surface]}}
    head = {"type": "CityJSON", "version": "2.0", "metadata": {"referenceSystem": "urn:ogc:def:crs:EPSG::25832"}}
    (out / "m.city.json").write_text(json.dumps({**head, "CityObjects": objects, "vertices": corners}))
    given = {"CITYJSON": str(out / "m.city.json"), "GEOID_HEIGHT": 45.0, "TILESET": str(out / "t.json")}
    run("exportmodels", given, context, log)
    assert sorted(path.name for path in out.iterdir()) == ["m.city.json", "t-2.2.glb", "t.json"]
    matrix = np.array(json.loads((out / "t.json").read_text())["root"]["transform"]).reshape(4, 4).T
    placed = Glb((out / "t-2.2.glb").read_bytes()).triangles()[0].reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    systems = [QgsCoordinateReferenceSystem(f"EPSG:{code}") for code in (25832, 4978)]
    change = QgsCoordinateTransform(*systems, context.transformContext())
    true = [change.transform(QgsVector3D(x, y, z + 45)) for x, y, z in corners]
    true = np.array([(one.x(), one.y(), one.z()) for one in true])
    off = np.linalg.norm(placed[:, None] - true[None], axis=2)
    assert off.min(axis=0).max() < 1e-3
    assert off.min(axis=1).max() < 1e-3
    layer = QgsTiledSceneLayer(f"url=file://{out / 't.json'}", "tiles", "cesiumtiles")
    assert layer.isValid()
    longitudes = layer.extent().xMinimum(), layer.extent().xMaximum()
    assert longitudes[0] < 9.0001 < longitudes[1] < 9.001


def test_a_name_without_a_format_is_refused(house, provider, context, out):
    given = {**house, "BUILDINGS": "memory:", "CITYJSON": str(out / "m.gml")}
    accepted, message = provider.algorithm("reconstructroofs").create().checkParameterValues(given, context)
    assert not accepted
    assert "m.gml can't be written as CityJSON: give it the extension .city.json" in message


def test_a_run_that_fails_leaves_no_file(house, context, log, out):
    far = vector(
        "Polygon", [("Polygon ((85005 446001, 85005.1 446001, 85005.1 446001.1, 85005 446001))", [1, 0.0, ""])]
    )
    given = {**house, "FOOTPRINTS": far, "BUILDINGS": "memory:", "CITYJSON": str(out / "m.json")}
    with pytest.raises(QgsProcessingException, match="has an area"):
        run("reconstructroofs", given, context, log)
    assert list(out.iterdir()) == []


@pytest.mark.parametrize("stem", ["model_roofs", "model_walls", "model_grounds"])
def test_styles_draw_at_their_heights_in_3d(provider, stem):
    from qgis._3d import Qgs3D, QgsPolygon3DSymbol, QgsVectorLayer3DRenderer

    Qgs3D.initialize()
    layer = vector("PolygonZ", [])
    message, loaded = layer.loadNamedStyle(str(STYLES / f"{stem}.qml"))
    assert loaded, message
    symbol = sip.cast(sip.cast(layer.renderer3D(), QgsVectorLayer3DRenderer).symbol(), QgsPolygon3DSymbol)
    assert symbol.altitudeClamping() == Qgis.AltitudeClamping.Absolute
    assert symbol.extrusionHeight() == 0
    assert not symbol.dataDefinedProperties().hasActiveProperties()


@pytest.mark.slow
def test_a_block_from_street_and_air_is_in_qgis_what_it_is_in_memory(provider, context, log, out):
    """Two files, 1.2 m off each other, become one CityJSON with windows; the shift is an output."""
    air, street = (seen_from(view)[0] for view in ("airplane", "vehicle"))
    recorded = ("return_number", "number_of_returns", "scan_angle", "gps_time")
    place, off = np.array([85_000.0, 446_000.0, 0.0]), np.array([1.0, -0.6, 0.4])
    write_cloud(create_cloud({"xyz": air["xyz"] + place, **{n: air[n] for n in recorded}}, "EPSG:28992"), out / "a.laz")
    write_cloud(create_cloud({"xyz": street["xyz"] + place - off}, "EPSG:28992"), out / "s.laz")
    names = {"OUTPUT": "b.laz", "CITYJSON": "b.city.json", "SET_OPENINGS": "o.gpkg", "WALLS": "w.gpkg"}
    given = {"INPUT": str(out / "a.laz"), "REFERENCE": str(out / "s.laz")}
    made = run("modelcityblock", {**given, **{name: str(out / file) for name, file in names.items()}}, context, log)
    expected = run_pipeline(
        PIPELINES["model_city_block"], read_cloud(out / "a.laz"), reference=read_cloud(out / "s.laz")
    )
    openings = list(QgsVectorLayer(made["SET_OPENINGS"], "o", "ogr").getFeatures())
    assert len(openings) == len(expected.layers["set_openings"]) > 10
    assert made["STREET_SHIFT_X"] == pytest.approx(expected.report.values["shift_x"], abs=1e-6)
    assert_valid_cityjson((out / "b.city.json").read_text())
    written = json.loads((out / "b.city.json").read_text())
    kinds = [
        surface["type"]
        for building in written["CityObjects"].values()
        for geometry in building["geometry"]
        for surface in geometry["semantics"]["surfaces"]
    ]
    assert kinds.count("Window") + kinds.count("Door") == len(openings)
