"""Clouds that name no coordinate reference system get one: read, made, in steps and in composites."""

from __future__ import annotations

import numpy as np
import pytest
from qgis.core import QgsVectorLayer

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.provider.crs_authority import crs_reader
from lidar_buildings.provider.qgis_crs import crs_of
from lidar_buildings.tests.las_files import made_las
from lidar_buildings.tests.provider.helpers import run

CRS = "EPSG:28992"


@pytest.fixture
def nameless(town, tmp_path):
    """The square without a coordinate reference system."""
    write_cloud(create_cloud(town), tmp_path / "nameless.las")
    return tmp_path / "nameless.las"


def system(path):
    return read_cloud(path).crs.plane


@pytest.mark.parametrize("name", ["toylift", "toychain"])
def test_a_step_and_a_composite_name_it_in_what_they_make(provider, context, log, nameless, out, name):
    run(name, {"INPUT": str(nameless), "OUTPUT": str(out / "a.las"), "CRS": CRS}, context, log)
    assert system(out / "a.las") == CRS
    assert not [one for one in log.warnings if "no coordinate reference system" in one]
    before, after = read_cloud(nameless), read_cloud(out / "a.las")
    np.testing.assert_equal(after.to_map(after.get("xyz")), before.to_map(before.get("xyz")))


def test_layers_are_in_it(provider, context, log, nameless, out):
    run("toyoutline", {"INPUT": str(nameless), "FOOTPRINTS": str(out / "a.gpkg"), "CRS": CRS}, context, log)
    assert QgsVectorLayer(str(out / "a.gpkg")).crs().authid() == CRS


def test_a_cloud_keeps_its_own(provider, context, log, town_file, out):
    run("toylift", {"INPUT": str(town_file), "OUTPUT": str(out / "a.las"), "CRS": "EPSG:32631"}, context, log)
    assert system(out / "a.las") == CRS


def test_an_extent_in_another_system_is_in_that_of_the_parameter(provider, context, log, nameless, out):
    part = "85000,85005,446000,446019 [EPSG:28992]"
    given = {"INPUT": str(nameless), "OUTPUT": str(out / "a.las"), "CRS": CRS, "EXTENT": part}
    run("toylift", given, context, log)
    assert len(read_cloud(out / "a.las")) == 6 * 20


@pytest.mark.parametrize("wrong", ["EPSG:4326", "nonsense"])
def test_degrees_and_nonsense_are_refused(provider, context, nameless, out, wrong):
    given = {"INPUT": str(nameless), "OUTPUT": str(out / "a.las"), "CRS": wrong}
    accepted, why = provider.algorithm("toylift").checkParameterValues(given, context)
    assert not accepted
    assert "(CRS)" in why


def test_simulators_name_one(provider, context, log, out):
    run("toymake", {"OUTPUT": str(out / "a.las"), "MARKS": str(out / "a.gpkg")}, context, log)
    assert system(out / "a.las") == "EPSG:3395"
    run("toymake", {"OUTPUT": str(out / "b.las"), "CRS": CRS}, context, log)
    assert system(out / "b.las") == CRS


@pytest.mark.parametrize("point_format", [3, 6])
def test_old_formats_keep_the_code_and_new_ones_the_text(qgis_application, tmp_path, point_format):
    path = tmp_path / "a.las"
    path.write_bytes(made_las(point_format=point_format, minor=2 if point_format == 3 else 4))
    write_cloud(read_cloud(path, read=crs_reader(crs_of(CRS))), tmp_path / "b.las")
    stated = read_cloud(tmp_path / "b.las").crs.stated
    assert stated == CRS if point_format == 3 else stated.startswith('PROJCS["Amersfoort / RD New"')


def test_feet_are_read_as_feet(qgis_application, nameless):
    made = read_cloud(nameless, read=crs_reader(crs_of("EPSG:2263")))
    assert made.crs.horizontal == pytest.approx(0.3048, rel=1e-4)
    assert np.ptp(made.get("xyz")[:, 0]) == pytest.approx(19 * 0.3048, rel=1e-4)
