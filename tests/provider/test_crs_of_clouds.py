"""Coordinate reference systems of clouds as QGIS has them: from GeoKeys and WKT into clouds, layers and rasters."""

from __future__ import annotations

import sqlite3
import struct
from contextlib import closing

import numpy as np
import pytest
from osgeo import gdal, osr
from qgis.core import QgsCoordinateReferenceSystem, QgsPointCloudLayer, QgsRasterLayer, QgsVectorLayer

from lidar_buildings.algorithms.cloud.authority import authority_here
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.crs import crs_of_text, read_crs
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.header import WKT_BIT, Vlr, read_header
from lidar_buildings.algorithms.cloud.point_formats import Layout
from lidar_buildings.provider.crs_authority import GDAL
from lidar_buildings.provider.layer_outputs import _UNDEFINED
from lidar_buildings.provider.memory_files import gdal_errors
from lidar_buildings.tests.algorithms.cloud.crs_texts import (
    COMPOUND_FEET,
    ETRS_32,
    IN_SIX_WAYS,
    MERCATOR,
    THREE_AXES,
    geokeys,
)
from lidar_buildings.tests.las_files import made_las, vlr
from lidar_buildings.tests.provider.helpers import run

FOOT = 1200 / 3937
# NAVD88 as a datum, which has its own key.
DATUM_OF_HEIGHTS = geokeys((1024, 1), (3072, 26915), (3076, 9001), (4096, 5103), (4099, 9003))
FEET_OF_HEIGHTS = geokeys((1024, 1), (3072, 26915), (3076, 9001), (4099, 9003))
# UTM zone 15 in US survey feet, which has no code: meridian, latitude, eastings, northings, scale.
OWN = geokeys(
    (1024, 1), (2048, 4269), (3072, 32767), (3074, 32767), (3075, 1), (3076, 9003),
    *((key, "double") for key in (3080, 3081, 3082, 3083, 3092)), doubles=(-93.0, 0.0, 1640416.6667, 0.0, 0.9996),
)  # fmt: skip


def header_of(text):
    header = geokeys()
    header.vlrs = [Vlr(b"LASF_Projection", 2112, text.encode() + b"\0")]
    return header


SYSTEMS = {
    "GeoKeys, heights in feet": (FEET_OF_HEIGHTS, 1.0, "EPSG:26915"),
    "compound": (header_of(COMPOUND_FEET), 1.0, "EPSG:26915"),
    "three axes": (header_of(THREE_AXES), 1.0, "EPSG:32615"),
    "user-defined": (OWN, FOOT, ""),
}


@pytest.fixture
def square(town, tmp_path):
    """Write the square of the town as a cloud of format 1 at a place in zone 15 with the records of a header."""

    def write(header, unit=1.0, name="in.las"):
        records = np.zeros(400, Layout(1).dtype)
        for axis, steps in zip("XYZ", np.rint((town["xyz"] + [415_000, 4_554_000, 0]) / [unit, unit, 1] * 100).T):
            records[axis] = steps
        Layout(1).put(records, "classification", town["classification"])
        vlrs = [vlr("LASF_Projection", one.record_id, one.data) for one in header.vlrs]
        raw = np.ascontiguousarray(records).view(np.uint8).reshape(400, -1)
        made = made_las(1, 2, records=raw, vlrs=vlrs, scale=(0.01, 0.01, 0.01), offset=(0, 0, 0))
        (tmp_path / name).write_bytes(made)
        return tmp_path / name

    return write


def plane_of(layer):
    crs = layer.crs()
    return (crs.horizontalCrs() if crs.verticalCrs().isValid() else crs).authid()


@pytest.mark.parametrize("name", SYSTEMS)
def test_rasters_and_layers_get_the_horizontal_part(provider, context, log, square, out, name):
    header, unit, plane = SYSTEMS[name]
    given = {"INPUT": str(square(header, unit)), "OUTPUT": str(out / "a.copc.laz")}
    run("toylift", given, context, log)
    for output, file in (("FOOTPRINTS", "a.gpkg"), ("FOOTPRINTS", "a.geojson"), ("FOOTPRINTS", "a.shp")):
        run("toyoutline", {**given, "OUTPUT": None, output: str(out / file)}, context, log)
        layer = QgsVectorLayer(str(out / file))
        assert layer.crs().isValid()
        if plane:
            assert (file, layer.crs().authid()) == (file, plane)
    run("toyheights", {"INPUT": given["INPUT"], "TOP": str(out / "a.tif")}, context, log)
    raster = QgsRasterLayer(str(out / "a.tif"))
    assert raster.crs().authid() == plane if plane else raster.crs().isValid()
    assert bool([one for one in log.warnings if "GeoJSON knows codes only" in one]) == (not plane)


def test_user_defined_geokeys_become_a_system_of_their_parameters(qgis_application):
    found = read_crs(OWN, GDAL)
    assert found.horizontal == pytest.approx(FOOT)
    crs = QgsCoordinateReferenceSystem.fromWkt(found.plane)
    assert crs.isValid()
    for part in ("+proj=tmerc", "+lon_0=-93", "+k=0.9996", "+units=us-ft", "+datum=NAD83"):
        assert part in crs.toProj()
    assert found.warnings == ()
    twice = crs_of_text(found.wkt.replace('"unnamed"', '"my feet"'), GDAL)
    assert twice.identity == found.identity


@pytest.mark.parametrize("header", [FEET_OF_HEIGHTS, DATUM_OF_HEIGHTS], ids=["unit", "datum"])
def test_copc_of_geokeys_shows_its_system_with_the_unit_of_heights(provider, context, log, square, out, header):
    run("toylift", {"INPUT": str(square(header)), "OUTPUT": str(out / "a.copc.laz")}, context, log)
    layer = QgsPointCloudLayer(str(out / "a.copc.laz"), "a", "copc")
    assert plane_of(layer) == "EPSG:26915"
    assert layer.crs().verticalCrs().isValid()
    assert read_header(out / "a.copc.laz").encoding & WKT_BIT
    crs = read_cloud(out / "a.copc.laz").crs
    assert (crs.plane, crs.vertical) == ("EPSG:26915", pytest.approx(FOOT))


def test_codes_whose_units_the_keys_contradict_are_not_taken(qgis_application):
    """Clouds of Pennsylvania have the code of the system in meters, and feet."""
    found = read_crs(geokeys((1024, 1), (3072, 32128), (3076, 9003)), GDAL)
    assert found.horizontal == pytest.approx(FOOT)
    assert "32128" not in found.plane
    assert "32128" not in found.wkt


@pytest.mark.parametrize("text", IN_SIX_WAYS[1:], ids=["with code", "without", "decimals", "compound", "ESRI's names"])
def test_one_plane_merges_however_it_is_written(provider, context, log, square, out, text):
    first = square(geokeys((1024, 1), (3072, 25832), (3076, 9001)), name="first.las")
    second = square(header_of(text), name="second.las")
    run("toymerge", {"INPUTS": [str(first), str(second)], "OUTPUT": str(out / "a.las")}, context, log)
    assert read_cloud(out / "a.las").crs.plane == "EPSG:25832"
    assert not [one for one in log.warnings if "coordinate reference system" in one]


def test_a_cloud_without_a_system_is_in_that_of_the_other_with_a_warning(provider, context, log, square, out):
    first, second = square(geokeys(), name="first.las"), square(header_of(ETRS_32), name="second.las")
    run("toymerge", {"INPUTS": [str(first), str(second)], "OUTPUT": str(out / "a.las")}, context, log)
    said = "first.las names no coordinate reference system; it is taken to be in the system of second.las."
    assert log.warnings.count(said) == 1
    assert read_cloud(out / "a.las").crs.plane == "EPSG:25832"


def test_layers_of_clouds_without_a_system_are_no_degrees(provider, context, log, square, out):
    run("toyoutline", {"INPUT": str(square(geokeys())), "FOOTPRINTS": str(out / "a.gpkg")}, context, log)
    with closing(sqlite3.connect(out / "a.gpkg")) as tables:
        assert tables.execute("select srs_id from gpkg_contents where data_type = 'features'").fetchall() == [(-1,)]
    assert QgsVectorLayer(str(out / "a.gpkg")).crs().description() in _UNDEFINED


def test_areas_in_web_mercator_are_those_on_the_ground(provider, context, log, town, tmp_path, out):
    """The roof of the square is 7 by 7 points: 49 m² on the ground, 129 m² on the map."""
    scale = 1.6227
    xyz = (town["xyz"] - [85_000, 446_000, 0]) * [scale, scale, 1] + [494_000, 6_800_000, 0]
    cloud = create_cloud({"xyz": xyz, "classification": town["classification"]})
    cloud.header.vlrs = header_of(MERCATOR).vlrs
    write_cloud(cloud, tmp_path / "m.las")
    run("toyoutline", {"INPUT": str(tmp_path / "m.las"), "FOOTPRINTS": str(out / "a.gpkg")}, context, log)
    assert [one for one in log.warnings if "m on the map of EPSG:3857" in one]
    local = read_cloud(tmp_path / "m.las").get("xyz")
    assert np.ptp(local[:, :2], axis=0) == pytest.approx([19, 19], rel=0.003)


def test_this_process_has_one_authority(qgis_application):
    assert authority_here() is GDAL
    assert GDAL.define('http://127.0.0.1/"x"') is None


def test_gdal_is_left_as_it_was(qgis_application):
    before = gdal.GetConfigOption("GTIFF_REPORT_COMPD_CS"), gdal.GetUseExceptions()
    assert GDAL.define("", ((34735, struct.pack("<4H", 1, 1, 0, 0)),)) is None
    assert GDAL.define("nonsense") is None
    assert (gdal.GetConfigOption("GTIFF_REPORT_COMPD_CS"), gdal.GetUseExceptions()) == before


def test_exceptions_are_switched_off_in_the_reverse_order(qgis_application, monkeypatch):
    """GDAL refuses any other order, and no system was known where exceptions had not been in use before."""
    calls = []
    for name, library in (("gdal", gdal), ("osr", osr)):
        monkeypatch.setattr(library, "GetUseExceptions", lambda: False)
        for call in ("UseExceptions", "DontUseExceptions"):
            monkeypatch.setattr(library, call, lambda one=f"{name}.{call}": calls.append(one))
    with gdal_errors():
        pass
    first, second, third, last = calls
    assert (first.split(".")[0], second.split(".")[0]) == (last.split(".")[0], third.split(".")[0])
