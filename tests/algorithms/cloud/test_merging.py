"""Nothing is lost when clouds of different kinds become one: held against the parts, and read by laspy."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import Cloud, create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.merging import merge_records
from lidar_buildings.algorithms.preparation.merge_clouds import merge_clouds
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.las_files import descriptor, vlr

FORMATS = range(11)


def merged(*clouds: Cloud, monitor: Monitor | None = None, **tunables) -> Cloud:
    return run_stage(merge_clouds.stage, clouds, monitor=monitor, **tunables).cloud


def withhold_nothing(cloud: Cloud) -> None:
    """Clear the withheld flag of all points, which stages leave out: bit 7 in old point formats, bit 2 in new ones."""
    byte, others = ("raw_classification", 127) if cloud.header.layout.is_old else ("classification_flags", 251)
    cloud.points[byte] &= others


def on_map(*clouds: Cloud) -> np.ndarray:
    return np.concatenate([cloud.to_map(cloud.get("xyz")) for cloud in clouds])


def extras(*fields) -> tuple:
    return (vlr("LASF_Spec", 4, b"".join(descriptor(*field[:2], **field[2]) for field in fields)),)


# --- Standard fields


@pytest.mark.parametrize("first", FORMATS)
@pytest.mark.parametrize("second", FORMATS)
def test_every_field_of_every_point_format_is_kept(make_las, first, second):
    """Random bytes: all fields of both, bits too, are found in the union."""
    clouds = [read_cloud(make_las(name=f"{i}.las", point_format=kind, n=40)) for i, kind in enumerate((first, second))]
    for cloud in clouds:
        withhold_nothing(cloud)
    union = merged(*clouds)
    layout = union.header.layout
    np.testing.assert_array_equal(on_map(union), on_map(*clouds))
    start = 0
    for cloud in clouds:
        part = union.points[start : start + 40]
        start += 40
        for name in cloud.header.layout.names:
            if name in ("X", "Y", "Z", "point_source_id"):
                continue
            was, is_now = cloud.header.layout.get(cloud.points, name), layout.get(part, name)
            np.testing.assert_allclose(is_now, was, atol=0.003 if name == "scan_angle" else 0, err_msg=name)
        for name in set(layout.names) - set(cloud.header.layout.names):
            assert not layout.get(part, name).any(), f"{name} is 0 where the cloud lacks it"


@pytest.mark.parametrize(
    ("kinds", "union"),
    [((0, 0), 0), ((0, 1), 1), ((1, 2), 3), ((2, 4), 5), ((3, 6), 7), ((1, 6), 6), ((7, 8), 8), ((8, 9), 10)],
)
def test_the_smallest_format_that_loses_nothing_is_taken(make_las, kinds, union):
    clouds = [read_cloud(make_las(name=f"{i}.las", point_format=kind)) for i, kind in enumerate(kinds)]
    assert merge_records(clouds, None).header.layout.point_format == union


@pytest.mark.parametrize("kinds", [(3, 6), (1, 7), (0, 2)])
def test_laspy_reads_the_merged_file(laspy, make_las, tmp_path, kinds):
    paths = [
        make_las(name=f"{i}.las", point_format=kind, n=60, scale=(0.01, 0.01, 0.001 / (1 + 9 * i)))
        for i, kind in enumerate(kinds)
    ]
    clouds = [read_cloud(path) for path in paths]
    for cloud in clouds:
        withhold_nothing(cloud)
    write_cloud(merged(*clouds), tmp_path / "union.laz")
    union, parts = laspy.read(tmp_path / "union.laz"), [laspy.read(path) for path in paths]
    assert union.header.scales.tolist() == [0.01, 0.01, 0.0001]
    np.testing.assert_allclose(union.xyz, np.concatenate([part.xyz for part in parts]), rtol=0, atol=1e-9)
    np.testing.assert_array_equal(union.point_source_id, np.repeat([1, 2], 60))
    before = np.concatenate([part.point_source_id for part in parts])
    np.testing.assert_array_equal(union["PreviousSourceId"], before)
    for name in ("intensity", "user_data", "classification"):
        np.testing.assert_array_equal(union[name], np.concatenate([part[name] for part in parts]), err_msg=name)
    if 7 in kinds or 2 in kinds:
        np.testing.assert_array_equal(union.red, np.concatenate([np.zeros(60), parts[1].red]))
    if 0 not in kinds:
        np.testing.assert_array_equal(union.gps_time, np.concatenate([part.gps_time for part in parts]))


def test_classes_over_31_find_room(make_las):
    clouds = [read_cloud(make_las(name=f"{i}.las", point_format=1)) for i in range(2)]
    for cloud in clouds:
        withhold_nothing(cloud)
    clouds[1].set("classification", np.full(100, 64))
    union = merge_records(clouds, None)
    assert union.header.layout.point_format == 6
    assert (union.get("classification")[100:] == 64).all()


# --- Coordinates


def test_the_finest_scale_is_kept_and_offsets_may_differ(make_las):
    clouds = [
        read_cloud(make_las(name="a.las", scale=(0.01, 0.01, 0.01))),
        read_cloud(make_las(name="b.las", scale=(0.001, 0.1, 0.0001), offset=(600_050.0005, 5_000_000.0, 10.0))),
    ]
    for cloud in clouds:
        withhold_nothing(cloud)
    union = merged(*clouds)
    assert union.header.scale.tolist() == [0.001, 0.01, 0.0001]
    apart = np.abs(on_map(union) - on_map(*clouds))
    assert (apart <= union.header.scale / 2 + 1e-9).all()
    np.testing.assert_array_equal(union.points["Y"][:100], clouds[0].points["Y"])


def test_a_transform_turns_about_the_zero_of_the_map(make_las):
    """Whatever the origin of the cloud in memory is."""
    clouds = [read_cloud(make_las(name=f"{i}.las", offset=(6e5, 5e6, 0.0))) for i in range(2)]
    for cloud in clouds:
        withhold_nothing(cloud)
    before = on_map(clouds[1])
    union = merged(*clouds, transforms="0 0 90 5600000 4400000 0")
    wanted = np.column_stack([5.6e6 - before[:, 1], 4.4e6 + before[:, 0], before[:, 2]])
    np.testing.assert_allclose(on_map(union)[100:], wanted, rtol=0, atol=0.005 + 1e-6)
    np.testing.assert_array_equal(union.points["X"][:100], clouds[0].points["X"])


def test_clouds_too_far_apart_for_their_scale_are_refused():
    clouds = [create_cloud({"xyz": np.zeros((2, 3))}), create_cloud({"xyz": np.full((2, 3), 1e7)})]
    with pytest.raises(ValueError, match=r"^The clouds span 10000000 units, too far for their scale 0.001; take fewer"):
        merged(*clouds)


# --- Extra dimensions


def test_extra_dimensions_are_united(make_las):
    """Name, type; kinds 9 is float32, 4 int16, 2 int8, 3 uint16."""
    a = make_las(name="a.las", extra=6, vlrs=extras(("Range", 9, {}), ("Count", 3, {})))
    b = make_las(name="b.las", extra=3, vlrs=extras(("Quality", 2, {}), ("Count", 4, {})))
    clouds = [read_cloud(path) for path in (a, b)]
    union = merge_records(clouds, None)
    fields = {field.name: i for i, field in enumerate(union.header.layout.extras)}
    assert list(fields) == ["Range", "Count", "Quality"]
    stored = [union.points[f"extra{fields[name]}"] for name in fields]
    np.testing.assert_array_equal(stored[0][:100], clouds[0].points["extra0"])
    assert np.isnan(stored[0][100:]).all()
    # The same name for two types: one that holds both.
    assert stored[1].dtype == np.float64
    wanted = np.concatenate([clouds[0].points["extra1"].astype(float), clouds[1].points["extra1"].astype(float)])
    np.testing.assert_array_equal(stored[1], wanted)
    assert not stored[2][:100].any()
    np.testing.assert_array_equal(stored[2][100:], clouds[1].points["extra0"])


def test_extra_numbers_without_a_name_keep_their_places(make_las):
    """All of a point's nameless numbers once got the value of the last one; kinds 2 is int8, 4 int16, 6 int32."""
    nameless = extras(("", 2, {}), ("", 4, {}), ("", 6, {}))
    clouds = [read_cloud(make_las(name=name, extra=7, vlrs=nameless)) for name in ("a.las", "b.las")]
    union = merge_records(clouds, None)
    assert [field.dtype.itemsize for field in union.header.layout.extras] == [1, 2, 4]
    for i in range(3):
        parts = [cloud.points[f"extra{i}"] for cloud in clouds]
        np.testing.assert_array_equal(union.points[f"extra{i}"], np.concatenate(parts))


def test_what_stages_have_set_is_kept_and_known_dimensions_have_one_name(make_las):
    aliased = make_las(name="a.las", extra=2, vlrs=extras(("height above ground", 4, {"options": 8, "scale": 0.01})))
    clouds = [read_cloud(aliased), read_cloud(make_las(name="b.las")), read_cloud(make_las(name="c.las"))]
    clouds[1].set("height_above_ground", np.arange(100, dtype="f4"))
    clouds[2].set("segment_id", np.arange(100))
    union = merge_records(clouds, None)
    assert [field.name for field in union.header.layout.extras] == ["HeightAboveGround", "SegmentID"]
    heights = union.get("height_above_ground")
    np.testing.assert_array_equal(heights[:100], clouds[0].get("height_above_ground"))
    np.testing.assert_array_equal(heights[100:200], np.arange(100))
    assert np.isnan(heights[200:]).all()
    assert union.get("segment_id").tolist() == [0] * 200 + list(range(100))
    assert clouds[0].header.layout.extras[0].name == "height above ground", "the parts are not changed"


def test_a_merged_cloud_can_be_merged_again(make_las):
    clouds = [read_cloud(make_las(name=f"{i}.las", n=10)) for i in range(3)]
    for cloud in clouds:
        withhold_nothing(cloud)
    twice = merged(merged(clouds[0], clouds[1]), clouds[2])
    assert twice.get("point_source_id").tolist() == [1] * 20 + [2] * 10
    wanted = [*[1] * 10, *[2] * 10, *clouds[2].points["point_source_id"]]
    assert twice.get("previous_source_id").tolist() == wanted


# --- Coordinate reference systems


def flat(wkt="", z=0.0, **more):
    xyz = np.column_stack([np.arange(5) + 1000.0, np.arange(5) + 2000.0, np.full(5, z)])
    return create_cloud({"xyz": xyz, **more}, wkt)


FEET = (
    'PROJCS["NAD83 / Oregon (ftUS)",GEOGCS["NAD83",DATUM["D",SPHEROID["GRS 1980",6378137,298.257222101]],'
    'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Lambert_Conformal_Conic_2SP"],'
    'UNIT["US survey foot",0.304800609601219],AUTHORITY["EPSG","2270"]]'
)


def test_different_systems_are_refused():
    with pytest.raises(
        ValueError, match=r"^Cloud 1 and Cloud 3 have different coordinate reference systems \(EPSG:28992"
    ):
        merged(flat("EPSG:28992"), flat(), flat("EPSG:25832"))


def test_a_cloud_without_system_is_taken_to_be_in_that_of_the_others(tmp_path):
    for clouds, number in (((flat("EPSG:28992"), flat()), 2), ((flat(), flat("EPSG:28992")), 1)):
        monitor = Monitor()
        union = merged(*clouds, monitor=monitor)
        assert union.crs.identity == "EPSG:28992"
        assert monitor.warnings == [
            f"Cloud {number} names no coordinate reference system; it is taken to be in the system of "
            f"Cloud {3 - number}."
        ]
        write_cloud(union, tmp_path / "a.las")
        assert read_cloud(tmp_path / "a.las").crs.identity == "EPSG:28992"


def test_none_has_a_system_and_nothing_is_said():
    monitor = Monitor()
    assert merged(flat(), flat(), monitor=monitor).crs.stated == ""
    assert monitor.warnings == []


@pytest.mark.parametrize("feet_first", [True, False])
def test_a_cloud_without_system_has_the_unit_of_the_others_too(feet_first, tmp_path):
    foot = 1200 / 3937
    feet, nameless = flat(FEET, z=100 * foot), flat(z=50.0)
    for cloud in (feet, nameless):
        cloud.set("height_above_ground", np.full(5, 3.0, "f4"))
    clouds = (feet, nameless) if feet_first else (nameless, feet)
    write_cloud(merged(*clouds), tmp_path / "a.las")
    union = read_cloud(tmp_path / "a.las")
    assert union.crs.horizontal == pytest.approx(foot)
    np.testing.assert_allclose(union.get("height_above_ground"), 3.0, rtol=1e-6)
    z = union.get("xyz")[:, 2]
    np.testing.assert_allclose(z, np.repeat([100, 50] if feet_first else [50, 100], 5) * foot, atol=0.001)


def test_old_and_new_formats_of_one_system_keep_it(make_las, tmp_path, laspy):
    keys = np.array([1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 28992], "<u2").tobytes()
    wkt = 'PROJCS["Amersfoort / RD New",UNIT["metre",1],AUTHORITY["EPSG","28992"]]'
    old = make_las(name="a.las", point_format=1, minor=2, vlrs=(vlr("LASF_Projection", 34735, keys),))
    new = make_las(name="b.las", vlrs=(vlr("LASF_Projection", 2112, wkt.encode() + b"\0"),), encoding=16)
    union = merge_records([read_cloud(old), read_cloud(new)], None)
    write_cloud(union, tmp_path / "u.las")
    header = laspy.read(tmp_path / "u.las").header
    assert header.point_format.id == 6
    assert header.global_encoding.wkt
    assert read_cloud(tmp_path / "u.las").crs.identity == "EPSG:28992"


def test_a_cloud_of_each_kind_of_gps_time_is_reported(make_las):
    monitor = Monitor()
    clouds = [read_cloud(make_las(name=f"{i}.las", encoding=i)) for i in range(2)]
    merge_records(clouds, None, monitor)
    assert monitor.warnings == ["The clouds count GPS time in different ways; the values are kept as they are."]
