"""The cloud in memory: units, dimensions, what is set and what comes back."""

import struct
from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.authority import authority_here
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.crs import crs_of_text
from lidar_buildings.algorithms.cloud.dimensions import DIMENSIONS
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.algorithms.cloud.crs_texts import ETRS_32
from lidar_buildings.tests.las_files import RECORD_SIZES, descriptor, random_records, vlr
from lidar_buildings.tests.monitors import Listening

FOOT, SURVEY_FOOT = 0.3048, 1200 / 3937
IN_FEET = f'PROJCS["a plane",GEOGCS["g",UNIT["degree",0.0174]],UNIT["US survey foot",{SURVEY_FOOT!r}]]'
HEIGHT_IN_FEET = f'COMPD_CS["both",PROJCS["a plane",UNIT["metre",1]],VERT_CS["height",UNIT["foot",{FOOT}]]]'


def wkt_vlr(wkt):
    return vlr("LASF_Projection", 2112, wkt.encode() + b"\0")


@pytest.fixture
def town(rng):
    n = 500
    return {
        "xyz": rng.uniform((85_000, 447_000, -2), (85_200, 447_300, 30), (n, 3)),
        "classification": rng.integers(0, 7, n).astype("u1"),
        "intensity": rng.integers(0, 65_536, n).astype("u2"),
        "gps_time": rng.uniform(0, 1e5, n),
        "height_above_ground": rng.normal(size=n).astype("f4"),
        "cluster_id": rng.integers(0, 9, n).astype("i4"),
        "normal": rng.normal(size=(n, 3)).astype("f4"),
    }


@pytest.mark.parametrize("name", ["a.las", "a.laz", "a.copc.laz"])
@pytest.mark.parametrize("wkt", ["", "EPSG:28992", IN_FEET, HEIGHT_IN_FEET])
def test_a_made_cloud_is_read_as_it_was_made(town, tmp_path, name, wkt):
    town["intensity"] = np.arange(500, dtype="u2")
    write_cloud(create_cloud(town, wkt), tmp_path / name)
    cloud = read_cloud(tmp_path / name)
    order = np.argsort(cloud.get("intensity"))
    assert cloud.crs.identity == crs_of_text(wkt, authority_here()).identity
    np.testing.assert_allclose(cloud.get("xyz")[order] + cloud.origin, town["xyz"], atol=0.000_501)
    for dimension in town.keys() - {"xyz"}:
        found = cloud.get(dimension)[order]
        assert found.dtype == np.dtype(DIMENSIONS[dimension].dtype)
        np.testing.assert_allclose(found, town[dimension], rtol=3e-7)


def test_local_meters_of_a_created_cloud_are_those_it_was_made_of(town):
    cloud = create_cloud(town)
    np.testing.assert_array_equal(cloud.origin, 0)
    np.testing.assert_allclose(cloud.get("xyz"), town["xyz"], atol=0.000_501)


def test_xyz_is_meters_from_a_round_origin_and_to_map_goes_back(make_las):
    records = random_records(1, 28, 50)
    path = make_las(records=records, point_format=1, vlrs=(wkt_vlr(IN_FEET),))
    cloud = read_cloud(path)
    steps = np.ascontiguousarray(records[:, :12]).view("<i4")
    in_file = steps * [0.01, 0.01, 0.001] + [600_000.0, 5_000_000.0, 0.0]
    np.testing.assert_allclose(cloud.get("xyz") + cloud.origin, in_file * SURVEY_FOOT, rtol=1e-14)
    np.testing.assert_allclose(cloud.to_map(cloud.get("xyz")), in_file, rtol=1e-14)
    np.testing.assert_allclose(cloud.to_map(cloud.get("xyz")[:, :2]), in_file[:, :2], rtol=1e-14)
    assert cloud.get("xyz")[:, :2].min() >= 0
    assert cloud.get("xyz")[:, :2].max() < 1100
    np.testing.assert_array_equal(cloud.origin % 1000, 0)
    assert cloud.origin[2] == 0


def test_two_clouds_compare_after_taking_one_origin(town):
    one = create_cloud(town)
    other = create_cloud({"xyz": town["xyz"] + [5000, 0, 0]})
    other.origin = np.array([5000.0, 0.0, 0.0])
    np.testing.assert_allclose(one.get("xyz"), other.get("xyz"), atol=0.0011)


def test_vertical_feet_scale_elevations_and_heights_only(make_las, take_apart, tmp_path):
    records = random_records(6, 30, 50)
    cloud = read_cloud(make_las(records=records, vlrs=(wkt_vlr(HEIGHT_IN_FEET),)))
    steps = np.ascontiguousarray(records[:, :12]).view("<i4")
    np.testing.assert_allclose(cloud.get("xyz")[:, 2], steps[:, 2] * 0.001 * FOOT)
    np.testing.assert_allclose(cloud.get("xyz")[:, 0] + cloud.origin[0], steps[:, 0] * 0.01 + 600_000)
    cloud.set("height_above_ground", np.full(50, 3.048))
    cloud.set("omnivariance", np.full(50, 2.0))
    cloud.set("entropy", np.full(50, 0.5))
    write_cloud(cloud, tmp_path / "b.las")
    stored = np.ascontiguousarray(take_apart(tmp_path / "b.las")["records"][:, 30:]).view("<f4")
    np.testing.assert_allclose(stored, np.tile([10.0, 2.0, 0.5], (50, 1)), rtol=1e-6)
    again = read_cloud(tmp_path / "b.las")
    np.testing.assert_allclose(again.get("height_above_ground"), 3.048, rtol=1e-6)


def test_areas_are_stored_in_squared_feet(make_las, take_apart, tmp_path):
    cloud = read_cloud(make_las(n=5, vlrs=(wkt_vlr(IN_FEET),)))
    cloud.set("eigenvalue_sum", np.full(5, 1.0))
    write_cloud(cloud, tmp_path / "b.las")
    stored = np.ascontiguousarray(take_apart(tmp_path / "b.las")["records"][:, 30:]).view("<f4")
    np.testing.assert_allclose(stored, 1 / SURVEY_FOOT**2, rtol=1e-6)
    np.testing.assert_allclose(read_cloud(tmp_path / "b.las").get("eigenvalue_sum"), 1, rtol=1e-6)


def heights(n):
    """Records of format 1 with the registered "height above ground": int16 in steps of 0.01, then 4 bytes of theirs."""
    records = random_records(1, RECORD_SIZES[1] + 6, n)
    records[:, 28:30] = np.arange(n, dtype="<i2").reshape(n, 1).view(np.uint8)
    reported = descriptor("height above ground", 4, options=1 | 8, no_data=struct.pack("<q", 7), scale=0.01)
    return records, vlr("LASF_Spec", 4, reported + descriptor("Theirs", 9))


def test_alias_is_read_with_its_scale_and_no_data(make_las):
    records, reported = heights(20)
    cloud = read_cloud(make_las(records=records, point_format=1, extra=6, vlrs=(reported,)))
    expected = np.arange(20) * 0.01
    expected[7] = np.nan
    assert cloud.has("height_above_ground")
    np.testing.assert_allclose(cloud.get("height_above_ground"), expected, rtol=1e-6)


def test_setting_takes_the_place_of_the_alias(make_las, tmp_path, laspy):
    records, reported = heights(20)
    cloud = read_cloud(make_las(records=records, point_format=1, extra=6, vlrs=(reported,)))
    cloud.set("height_above_ground", np.linspace(0, 100, 20))
    write_cloud(cloud, tmp_path / "b.las")
    las = laspy.read(tmp_path / "b.las")
    assert list(las.point_format.extra_dimension_names) == ["HeightAboveGround", "Theirs"]
    assert las["HeightAboveGround"].dtype == np.float32
    np.testing.assert_allclose(las["HeightAboveGround"], np.linspace(0, 100, 20), rtol=1e-6)
    np.testing.assert_array_equal(np.array(las["Theirs"]).view("u1").reshape(20, 4), records[:, 30:])


def test_setting_again_overwrites_in_place(town, tmp_path, laspy):
    write_cloud(create_cloud(town), tmp_path / "a.las")
    cloud = read_cloud(tmp_path / "a.las")
    cloud.set("cluster_id", np.full(500, 42))
    write_cloud(cloud, tmp_path / "b.las")
    old, new = laspy.read(tmp_path / "a.las"), laspy.read(tmp_path / "b.las")
    assert new.point_format == old.point_format
    assert (new["ClusterID"] == 42).all()
    np.testing.assert_array_equal(new["NormalY"], old["NormalY"])


def test_withheld_points_are_reported_and_kept(make_las, laspy):
    for point_format in (3, 7):
        path = make_las(point_format=point_format, n=300)
        cloud = read_cloud(path)
        assert cloud.withheld.dtype == bool
        assert 0 < cloud.withheld.sum() < len(cloud) == 300
        np.testing.assert_array_equal(cloud.withheld, np.asarray(laspy.read(path).withheld, bool))


def test_scan_angles_are_degrees_in_all_formats(make_las, laspy):
    old, new = make_las("a.las", point_format=1), make_las("b.las", point_format=6)
    np.testing.assert_array_equal(read_cloud(old).get("scan_angle"), laspy.read(old).scan_angle_rank)
    np.testing.assert_allclose(read_cloud(new).get("scan_angle"), laspy.read(new).scan_angle * 0.006, rtol=1e-6)


def test_nan_in_an_extra_dimension_is_kept(town, tmp_path):
    town["height_above_ground"][3] = np.nan
    write_cloud(create_cloud(town), tmp_path / "a.laz")
    np.testing.assert_array_equal(
        read_cloud(tmp_path / "a.laz").get("height_above_ground"), town["height_above_ground"]
    )


def test_absent_dimension_is_named(make_las):
    cloud = read_cloud(make_las(point_format=0))
    assert not cloud.has("gps_time")
    assert not cloud.has("height_above_ground")
    with pytest.raises(ValueError, match="The cloud has no HeightAboveGround dimension"):
        cloud.get("height_above_ground")
    with pytest.raises(ValueError, match="no dimension 'heigth'"):
        cloud.get("heigth")


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        ("cluster_id", np.zeros(9), "must have the shape"),
        ("normal", np.zeros(100), "must have the shape"),
        ("classification", np.full(100, 256), "must be from 0 to 255, got 256"),
        ("classification", np.full(100, -1), "must be from 0 to 255, got -1"),
        ("cluster_id", np.full(100, np.nan), "must be from"),
        ("xyz", np.zeros((100, 2)), "must have the shape"),
        ("red", np.zeros(100), "Red can't be set in point format 6"),
    ],
)
def test_what_does_not_fit_is_refused(make_las, name, values, message):
    with pytest.raises(ValueError, match=message):
        read_cloud(make_las(n=100)).set(name, values)


@pytest.mark.parametrize("xyz", [np.zeros((0, 3)), np.array([[0, 0, np.nan]]), np.array([[np.inf, 0, 0]])])
def test_a_cloud_needs_finite_points(xyz):
    with pytest.raises(ValueError, match="finite coordinates"):
        create_cloud({"xyz": xyz})


def test_a_cloud_too_wide_for_its_steps_is_refused():
    with pytest.raises(ValueError, match="spans 3000000 m"):
        create_cloud({"xyz": np.array([[0.0, 0, 0], [3e6, 0, 0]])})


def test_unknown_units_are_warned_of_and_known_ones_not(make_las):
    monitor = Monitor()
    read_cloud(make_las("a.las"), monitor)
    assert any("taken as meters" in sentence for sentence in monitor.warnings)
    assert monitor.infos == []
    monitor = Monitor()
    in_feet = ETRS_32.replace(',UNIT["metre",1],AUTHORITY["EPSG","25832"]', f',UNIT["US survey foot",{SURVEY_FOOT!r}]')
    read_cloud(make_las("b.las", vlrs=(wkt_vlr(in_feet),)), monitor)
    assert monitor.warnings == []
    assert monitor.infos == [
        "A unit of the coordinates is 0.304801 m, of heights 0.304801 m; parameters, the log and attributes are in "
        "meters."
    ]


def test_wkt_that_is_supplied_later_is_written_to_formats_that_need_it(make_las, tmp_path):
    cloud = read_cloud(make_las(point_format=6)).in_crs(crs_of_text(IN_FEET))
    write_cloud(cloud, tmp_path / "b.las")
    assert read_cloud(tmp_path / "b.las").crs.stated == IN_FEET


@pytest.mark.parametrize("name", ["b.las", "b.laz", "b.copc.laz"])
def test_progress_is_reported_in_order(make_las, tmp_path, monkeypatch, name):
    monkeypatch.setattr("lidar_buildings.algorithms.cloud.points.AT_ONCE", 10)
    monkeypatch.setattr("lidar_buildings.algorithms.cloud.copc.AT_ONCE", 10)

    reading, writing = Listening(), Listening()
    cloud = read_cloud(make_las(n=100), reading)
    write_cloud(cloud, tmp_path / name, writing)
    for heard in (reading.heard, writing.heard):
        assert len(heard) > 10
        assert heard == sorted(heard)
        assert heard[-1] == 1


# --- other points, other places ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["a.las", "a.laz", "a.copc.laz"])
def test_points_taken_are_written_with_all_that_they_have(town, tmp_path, name):
    town["intensity"] = np.arange(500, dtype="u2")
    write_cloud(create_cloud(town, IN_FEET), tmp_path / "whole.las")
    whole = read_cloud(tmp_path / "whole.las")
    whole.set("entropy", np.arange(500) / 500)
    index = np.array([400, 3, 77, 3])
    part = whole.take(index)
    np.testing.assert_array_equal(part.get("xyz"), whole.get("xyz")[index])
    write_cloud(part, tmp_path / name)
    back = read_cloud(tmp_path / name)
    order = np.argsort(back.get("intensity"), kind="stable")
    assert back.get("intensity")[order].tolist() == [3, 3, 77, 400]
    assert back.crs.stated == IN_FEET
    for dimension in ("classification", "gps_time", "cluster_id", "normal", "entropy"):
        np.testing.assert_array_equal(back.get(dimension)[order], whole.get(dimension)[[3, 3, 77, 400]])


def test_moved_points_are_rounded_to_the_scale_of_the_file(make_las):
    records = random_records(1, 28, 50)
    path = make_las(records=records, point_format=1, vlrs=(wkt_vlr(IN_FEET),))
    cloud = read_cloud(path)
    before, read = cloud.get("xyz"), cloud.points
    cloud.set("xyz", before + [12.3456, -7.0, 100.0])
    # The made file has steps of 0.01 and, in z, 0.001 survey feet.
    np.testing.assert_allclose(cloud.get("xyz"), before + [12.3456, -7.0, 100.0], atol=0.0051 * SURVEY_FOOT)
    assert np.abs(cloud.get("xyz")[:, 2] - before[:, 2] - 100).max() <= 0.00051 * SURVEY_FOOT
    np.testing.assert_array_equal(read_cloud(path).points, read)
    assert cloud.points is not read


@pytest.mark.parametrize("moved", [0, 1, 2**20 + 1])
def test_halves_of_a_step_are_rounded_up_whatever_the_offset(town, moved):
    """Also where the sum of large coordinates misses the half by a rounding error."""
    cloud = create_cloud(town)
    halves = cloud.get("xyz") + cloud.header.scale / 2
    cloud.header = replace(cloud.header, offset=cloud.header.offset - moved * cloud.header.scale)
    cloud.set("xyz", halves)
    np.testing.assert_allclose(cloud.get("xyz"), halves + cloud.header.scale / 2, atol=1e-7)


@pytest.mark.parametrize("far", [3e6, np.nan])
def test_points_moved_out_of_the_file_are_refused(town, far):
    cloud = create_cloud(town)
    before = cloud.points
    xyz = cloud.get("xyz").copy()
    xyz[3, 1] += far
    with pytest.raises(ValueError, match=r"^Points are moved too far for the file, which reaches 2147484 m .* in Y "):
        cloud.set("xyz", xyz)
    assert cloud.points is before


def test_coordinates_are_shared_by_those_that_hold_them_until_points_move(town):
    cloud = create_cloud(town)
    held = cloud.get("xyz")
    assert cloud.get("xyz") is held
    assert cloud.copy().get("xyz") is held
    with pytest.raises(ValueError, match="read-only"):
        held += 1.0
    east = held + [1.0, 0.0, 0.0]
    cloud.set("xyz", east)
    np.testing.assert_allclose(cloud.get("xyz"), east, rtol=0, atol=1e-3)
    before = cloud.get("xyz")
    cloud.origin = cloud.origin + [10.0, 0.0, 0.0]
    np.testing.assert_allclose(cloud.get("xyz"), before - [10.0, 0.0, 0.0], rtol=0, atol=1e-6)


def test_a_copy_is_changed_apart(town):
    cloud = create_cloud(town)
    copy = cloud.copy()
    copy.set("classification", np.full(500, 9))
    copy.set("xyz", cloud.get("xyz") + 1)
    np.testing.assert_array_equal(cloud.get("classification"), town["classification"])
    np.testing.assert_allclose(cloud.get("xyz"), town["xyz"], atol=0.000_501)


def test_from_map_is_the_inverse_of_to_map(make_las):
    cloud = read_cloud(make_las(vlrs=(wkt_vlr(HEIGHT_IN_FEET),)))
    xyz = cloud.get("xyz")
    np.testing.assert_allclose(cloud.from_map(cloud.to_map(xyz)), xyz, atol=1e-6)
    np.testing.assert_allclose(cloud.from_map(cloud.to_map(xyz)[:, :2]), xyz[:, :2], atol=1e-6)


def test_any_dimension_goes_by_the_name_it_has_in_the_file(make_las):
    extras = vlr(
        "LASF_Spec", 4, descriptor("Amplitude [dB]", 3, options=8, scale=0.01) + descriptor("height above ground", 9)
    )
    records = random_records(7, 36 + 6, 20)
    records[:, 36:38] = np.arange(100, 120, dtype="<u2").view("u1").reshape(-1, 2)
    records[:, 38:42] = np.arange(20, dtype="<f4").view("u1").reshape(-1, 4)
    cloud = read_cloud(make_las(records=records, point_format=7, extra=6, vlrs=(extras,)))
    np.testing.assert_allclose(cloud.named("amplitude [db]"), np.arange(100, 120) / 100)
    np.testing.assert_array_equal(cloud.named("HeightAboveGround"), np.arange(20))
    np.testing.assert_array_equal(cloud.named("height above ground"), np.arange(20))
    np.testing.assert_array_equal(cloud.named(" Red "), cloud.get("red"))
    np.testing.assert_array_equal(cloud.named("ScannerChannel"), cloud.points["classification_flags"] >> 4 & 3)
    np.testing.assert_allclose(cloud.named("x"), cloud.points["X"] * 0.01 + 600_000)
    with pytest.raises(ValueError, match=r"no dimension 'Nir'; it has X, Y, Z, .*Amplitude \[dB\]"):
        cloud.named("Nir")
