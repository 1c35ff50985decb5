"""A drone's cloud and an old map in another reference system, through the composite in QGIS."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import write_cloud
from lidar_buildings.algorithms.simulation.simulate_village import simulate_village
from lidar_buildings.tests.provider.helpers import run

pytest.importorskip("qgis.core")

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsVectorFileWriter,
    QgsVectorLayer,
)

# Hungarian coordinates, as far from zero as the paper's villages.
CRS, CORNER = "EPSG:23700", np.array([650_000.0, 240_000.0])


@pytest.fixture(scope="module")
def village(tmp_path_factory):
    """The folder with cloud and old map, the true footprints' rings, and how many buildings have gone or come."""
    folder = tmp_path_factory.mktemp("village")
    *arrays, true, old_map = simulate_village(size=80.0, density=30.0, map_changes=0.25, seed=5)
    made = dict(zip(simulate_village.stage.creates, arrays))
    xyz = made["xyz"] + [*CORNER, 120.0]
    colors = {name: made[name] for name in ("red", "green", "blue")}
    write_cloud(create_cloud({"xyz": xyz, **colors}, CRS), folder / "village.laz")
    degrees(old_map, folder / "old.gpkg")
    states = list(old_map.columns["state"])
    return folder, true, states.count("demolished"), len(true) - states.count("kept")


def degrees(features, path):
    """Write polygons of the village as a layer in longitude and latitude."""
    layer = QgsVectorLayer("Polygon?crs=EPSG:4326&field=id:integer&field=state:string", "old", "memory")
    turn = QgsCoordinateTransform(
        QgsCoordinateReferenceSystem(CRS), QgsCoordinateReferenceSystem("EPSG:4326"), QgsCoordinateTransformContext()
    )
    for rings, number, state in zip(features.geometries, features.columns["id"], features.columns["state"]):
        shape = QgsGeometry.fromPolygonXY([[QgsPointXY(*point) for point in ring + CORNER] for ring in rings])
        shape.transform(turn)
        feature = QgsFeature(layer.fields())
        feature.setGeometry(shape)
        feature.setAttributes([int(number), str(state)])
        layer.dataProvider().addFeature(feature)
    options = QgsVectorFileWriter.SaveVectorOptions()
    written = QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(path), QgsCoordinateTransformContext(), options)
    assert written[0] == QgsVectorFileWriter.WriterError.NoError, written


def test_an_old_map_in_degrees_is_compared_in_meters(village, provider, context, log, out):
    folder, true, gone, come = village
    names = {"WALL_FOOTPRINTS": "walls.gpkg", "DISPLACEMENTS": "arrows.gpkg", "BUILDINGS": "buildings.gpkg"}
    given = {name: str(out / file) for name, file in {**names, "OUTPUT": "a.laz", "REPORT": "a.html"}.items()}
    given.update(INPUT=str(folder / "village.laz"), OLD_MAP=str(folder / "old.gpkg"))
    result = run("mapfootprints", given, context, log)

    assert gone > 0 < come
    reported = {name: result[f"COMPARISON_{name}"] for name in ("ALL_FOOTPRINTS", "FOUND", "MISSED", "NEW")}
    assert reported == {"ALL_FOOTPRINTS": len(true), "FOUND": len(true) - come, "MISSED": gone, "NEW": come}
    # The map lies 0.3 m to the east and to the north, and its corners are off by 0.15 m in each direction.
    assert [result["COMPARISON_MEAN_DX"], result["COMPARISON_MEAN_DY"]] == pytest.approx([-0.3, -0.3], abs=0.1)
    assert 0.3 < result["COMPARISON_MEAN"] < 0.3 * math.sqrt(2) + 0.15

    walls = QgsVectorLayer(result["WALL_FOOTPRINTS"], "walls", "ogr")
    arrows = QgsVectorLayer(result["DISPLACEMENTS"], "arrows", "ogr")
    assert {layer.crs().authid() for layer in (walls, arrows)} == {CRS}
    found = [feature.geometry().centroid().asPoint() for feature in walls.getFeatures()]
    for rings in true.geometries:
        shape = QgsGeometry.fromPolygonXY([[QgsPointXY(*point) for point in ring + CORNER] for ring in rings])
        assert sum(shape.buffer(0.5, 4).contains(QgsGeometry.fromPointXY(point)) for point in found) == 1
    lengths = [feature.geometry().length() for feature in arrows.getFeatures()]
    assert len(lengths) == result["COMPARISON_MATCHED"] >= 0.9 * result["COMPARISON_CORNERS"]
    states = [feature["status"] for feature in QgsVectorLayer(result["BUILDINGS"], "b", "ogr").getFeatures()]
    assert (states.count("missed"), states.count("new")) == (gone, come)
    assert "buildings of the old map were found" in (out / "a.html").read_text(encoding="utf-8")
    assert not log.warnings
