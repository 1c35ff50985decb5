"""A part of a cloud instead of the whole: for stages, for composites, in whatever coordinates the extent is given."""

import numpy as np
import pytest
from qgis.core import Qgis, QgsCoordinateReferenceSystem

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import count_points, read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.vpc import write_vpc
from lidar_buildings.tests.builders import roof

WEST, SOUTH = 85_000.0, 447_000.0
EXTENT = f"{WEST + 10},{WEST + 40},{SOUTH + 5},{SOUTH + 45}"


@pytest.fixture(scope="module")
def tile(tmp_path_factory):
    """A field of 100 m by 50 m with a house within the extent and one beyond it."""
    rng = np.random.default_rng(5)
    plan = rng.uniform(0, [100, 50], (100 * 50 * 4, 2))
    under = ((plan > [20, 20]) & (plan < [32, 30])).all(axis=1) | ((plan > [70, 20]) & (plan < [82, 30])).all(axis=1)
    ground = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])[~under]
    houses = [roof(rng, x, 20, 12, 10, 5.0, density=4.0) for x in (20, 70)]
    xyz = np.concatenate([ground, *houses]) + [WEST, SOUTH, 0]
    path = tmp_path_factory.mktemp("extent") / "tile.laz"
    write_cloud(create_cloud({"xyz": xyz, "gps_time": np.arange(len(xyz)) * 1e-3}, "EPSG:28992"), path)
    return path


def inside(cloud):
    x, y = cloud.to_map(cloud.get("xyz"))[:, :2].T
    return (x >= WEST + 10) & (x <= WEST + 40) & (y >= SOUTH + 5) & (y <= SOUTH + 45)


def test_a_stage_reads_the_points_within_and_keeps_their_order(provider, context, log, tile, tmp_path):
    algorithm = provider.algorithm("classifynoisestatistical")
    given = {"INPUT": str(tile), "EXTENT": EXTENT, "OUTPUT": str(tmp_path / "part.laz")}
    results, succeeded = algorithm.run(given, context, log)
    assert succeeded, log.textLog()
    whole, part = read_cloud(tile), read_cloud(results["OUTPUT"])
    np.testing.assert_array_equal(part.get("gps_time"), whole.get("gps_time")[inside(whole)])


def test_a_composite_finds_the_house_within_and_no_other(provider, context, log, tile, tmp_path):
    from qgis.core import QgsVectorLayer

    algorithm = provider.algorithm("detectbuildings")
    target = tmp_path / "footprints.gpkg"
    given = {"INPUT": str(tile), "EXTENT": EXTENT, "OUTPUT": str(tmp_path / "part.laz"), "FOOTPRINTS": str(target)}
    results, succeeded = algorithm.run(given, context, log)
    assert succeeded, log.textLog()
    assert len(read_cloud(results["OUTPUT"])) == inside(read_cloud(tile)).sum()
    (house,) = QgsVectorLayer(str(target)).getFeatures()
    assert house.geometry().boundingBox().xMaximum() < WEST + 40


def test_an_extent_in_degrees_becomes_the_box_around_it(provider, context, log, tile, tmp_path):
    from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsProject, QgsRectangle

    rd, wgs84 = (QgsCoordinateReferenceSystem(name) for name in ("EPSG:28992", "EPSG:4326"))
    change = QgsCoordinateTransform(rd, wgs84, QgsProject.instance())
    box = change.transformBoundingBox(QgsRectangle(WEST + 10, SOUTH + 5, WEST + 40, SOUTH + 45))
    numbers = ",".join(map(repr, (box.xMinimum(), box.xMaximum(), box.yMinimum(), box.yMaximum())))
    given = {"INPUT": str(tile), "EXTENT": f"{numbers} [EPSG:4326]", "OUTPUT": str(tmp_path / "part.laz")}
    results, succeeded = provider.algorithm("classifynoisestatistical").run(given, context, log)
    assert succeeded, log.textLog()
    part = read_cloud(results["OUTPUT"])
    assert inside(part).sum() == inside(read_cloud(tile)).sum()
    assert len(part) < 1.1 * inside(part).sum()


def test_tiles_of_a_virtual_point_cloud_are_read_where_they_meet_the_extent(tile, tmp_path):
    cloud = read_cloud(tile)
    x = cloud.to_map(cloud.get("xyz"))[:, 0]
    for name, part in (("west", x < WEST + 30), ("east", x >= WEST + 30)):
        write_cloud(cloud.take(np.flatnonzero(part)), tmp_path / f"{name}.las")
    write_vpc([tmp_path / "west.las", tmp_path / "east.las"], tmp_path / "all.vpc")
    box = np.array([[WEST + 10, SOUTH + 5], [WEST + 40, SOUTH + 45]])
    part = read_cloud(tmp_path / "all.vpc", box=box)
    assert sorted(part.get("gps_time")) == sorted(cloud.get("gps_time")[inside(cloud)])


def test_an_extent_without_points_and_no_extent_are_sentences(provider, context, tile, tmp_path):
    from qgis.core import QgsProcessingException

    algorithm = provider.algorithm("classifynoisestatistical")
    given = {"INPUT": str(tile), "OUTPUT": str(tmp_path / "part.laz")}
    with pytest.raises(QgsProcessingException, match="tile.laz has no points within the extent"):
        algorithm.run({**given, "EXTENT": "0,1,0,1"}, context, log_of(), {}, False)
    accepted, why = algorithm.checkParameterValues({**given, "EXTENT": "here"}, context)
    assert not accepted
    assert "EXTENT" in why or "extent" in why.lower()
    assert not (tmp_path / "part.laz").exists()


def log_of():
    from qgis.core import QgsProcessingFeedback

    return QgsProcessingFeedback()


def test_the_points_of_a_part_are_estimated_from_the_headers(tile):
    """The warning of little memory counts on them; points are spread nearly evenly here."""
    box = np.array([[WEST + 10, SOUTH + 5], [WEST + 40, SOUTH + 45]])
    assert count_points(tile, box) == pytest.approx(inside(read_cloud(tile)).sum(), rel=0.1)
    assert count_points(tile, box + 1000.0) == 0
    assert count_points(tile, np.array([[0.0, 0.0], [1e6, 1e6]])) == count_points(tile)


def test_a_survey_is_cut_within_an_extent(provider, context, log, tile, tmp_path):
    given = {"INPUT": str(tile), "SIDE": 20.0, "EXTENT": EXTENT, "OUTPUT": str(tmp_path / "tiles")}
    results, succeeded = provider.algorithm("cutintotiles").run(given, context, log)
    assert succeeded, log.textLog()
    whole = read_cloud(tile)
    written = np.sort(read_cloud(results["VPC"]).get("gps_time"))
    np.testing.assert_allclose(written, np.sort(whole.get("gps_time")[inside(whole)]))


def test_a_survey_is_worked_on_within_an_extent(provider, context, log, tile, tmp_path):
    from qgis.core import QgsVectorLayer

    target = tmp_path / "footprints.gpkg"
    given = {"INPUT": str(tile), "EXTENT": EXTENT, "OUTPUT": str(tmp_path / "tiles"), "FOOTPRINTS": str(target)}
    results, succeeded = provider.algorithm("detectbuildingsintiles").run({**given, "PROCESSES": 1}, context, log)
    assert succeeded, log.textLog()
    assert results["POINTS"] == len(read_cloud(results["VPC"])) == inside(read_cloud(tile)).sum()
    (house,) = QgsVectorLayer(str(target)).getFeatures()
    assert house.geometry().boundingBox().xMaximum() < WEST + 40


def test_points_are_clipped_with_polygons_and_an_extent(provider, context, log, tile, tmp_path):
    from qgis.core import QgsFeature, QgsGeometry, QgsRectangle, QgsVectorLayer

    layer = QgsVectorLayer("Polygon?crs=EPSG:28992", "areas", "memory")
    area = QgsFeature()
    area.setGeometry(QgsGeometry.fromRect(QgsRectangle(WEST + 20, SOUTH - 10, WEST + 90, SOUTH + 60)))
    layer.dataProvider().addFeature(area)
    given = {"INPUT": str(tile), "POLYGONS": layer, "EXTENT": EXTENT, "OUTPUT": str(tmp_path / "part.laz")}
    algorithm = provider.algorithm("clipcloud")
    results, succeeded = algorithm.run(given, context, log)
    assert succeeded, log.textLog()
    whole = read_cloud(tile)
    east = whole.to_map(whole.get("xyz"))[:, 0] > WEST + 20
    expected = whole.get("gps_time")[inside(whole) & east]
    np.testing.assert_array_equal(read_cloud(results["OUTPUT"]).get("gps_time"), expected)
    outside, succeeded = algorithm.run({**given, "OUTSIDE": True, "OUTPUT": str(tmp_path / "b.laz")}, context, log)
    assert succeeded, log.textLog()
    assert len(read_cloud(outside["OUTPUT"])) == inside(whole).sum() - len(expected)


def test_a_spacing_leaves_the_lowest_point_of_each_cube_in_meters(provider, context, log, tile, tmp_path):
    # In feet, so that the sides of the cubes are other numbers in the file.
    feet = tmp_path / "feet.laz"
    cloud = read_cloud(tile)
    wkt = QgsCoordinateReferenceSystem("EPSG:2263").toWkt(Qgis.CrsWktVariant.Wkt1Gdal)
    write_cloud(create_cloud({"xyz": cloud.get("xyz") + cloud.origin}, wkt), feet)
    assert read_cloud(feet).crs.horizontal == pytest.approx(0.3048, rel=1e-4)
    for source in (tile, feet):
        given = {"INPUT": str(source), "SPACING": 2.0, "OUTPUT": str(tmp_path / "thin.laz")}
        algorithm = provider.algorithm("classifynoisestatistical")
        results, succeeded = algorithm.run(given, context, log)
        assert succeeded, log.textLog()
        thin, whole = read_cloud(results["OUTPUT"]), read_cloud(source)
        xyz = [cloud.get("xyz") + cloud.origin for cloud in (thin, whole)]
        cubes = [np.unique(np.floor(one / 2.0 + 1e-7), axis=0) for one in xyz]
        assert len(thin) == len(cubes[0]) == len(cubes[1]) < 0.2 * len(whole)
        told = f"{source.name}: {len(thin):,} of {len(whole):,} points are used, one of each cube of 2 m."
        assert log.infos.count(told) == 1


@pytest.mark.parametrize("value", ["0", "-1", "much", "nan"])
def test_a_spacing_that_is_none_is_refused(provider, context, tile, value):
    given = {"INPUT": str(tile), "SPACING": value, "OUTPUT": "TEMPORARY_OUTPUT"}
    accepted, why = provider.algorithm("classifynoisestatistical").checkParameterValues(given, context)
    assert not accepted
    assert "Spacing" in why or "SPACING" in why
