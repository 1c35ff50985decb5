"""Virtual point clouds: tiles that are read as one cloud."""

import json

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import vpc
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import check_readable, count_points, read_cloud, read_extent, write_cloud
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.las_files import descriptor, random_records, vlr

RD = 'PROJCS["RD",UNIT["metre",1],AUTHORITY["EPSG","28992"]]'


@pytest.fixture
def make_vpc(tmp_path):
    def make(*hrefs, roles=("data",)):
        features = [{"type": "Feature", "assets": {"data": {"href": href, "roles": list(roles)}}} for href in hrefs]
        path = tmp_path / "all.vpc"
        path.write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")
        return path

    return make


def crs(wkt):
    return vlr("LASF_Projection", 2112, wkt.encode() + b"\0")


def test_tiles_of_different_scale_offset_format_and_dimensions_become_one(make_las, make_vpc, laspy):
    confidence = vlr("LASF_Spec", 4, descriptor("Confidence", 9))
    cluster = vlr("LASF_Spec", 4, descriptor("ClusterID", 6) + descriptor("Mine", 3))
    one = make_las("one.las", point_format=1, minor=2, extra=4, vlrs=(crs(RD), confidence), n=50)
    records = random_records(7, 36 + 6, 70, seed=2)
    two = make_las(
        "two.las", point_format=7, extra=6, vlrs=(cluster, crs(RD), vlr("someone", 5, b"z")), records=records,
        scale=(0.001, 0.01, 0.01), offset=(600_100.0, 5_000_000.5, 10.0),
    )  # fmt: skip
    cloud = read_cloud(make_vpc("./one.las", "two.las"))
    a, b = laspy.read(one), laspy.read(two)
    np.testing.assert_array_equal(cloud.header.scale, [0.001, 0.01, 0.001])
    np.testing.assert_allclose(cloud.get("xyz") + cloud.origin, np.concatenate((a.xyz, b.xyz)), atol=1e-6)
    assert cloud.header.layout.point_format == 7
    for name in ("intensity", "classification", "return_number", "gps_time", "user_data"):
        expected = np.concatenate((a[name], b[name]))
        np.testing.assert_array_equal(cloud.header.layout.get(cloud.points, name), expected, err_msg=name)
    np.testing.assert_array_equal(cloud.get("red"), np.concatenate((np.zeros(50), b.red)))
    np.testing.assert_array_equal(cloud.get("cluster_id"), np.concatenate((np.zeros(50), b["ClusterID"])))
    np.testing.assert_array_equal(cloud.get("confidence"), np.concatenate((a["Confidence"], np.full(70, np.nan))))
    assert [record.key for record in cloud.header.vlrs] == [
        (b"LASF_Projection", 2112), (b"LASF_Spec", 4), (b"someone", 5)
    ]  # fmt: skip


def test_a_tile_without_points_is_left_out_with_a_warning(make_las, make_vpc):
    make_las("none.las", n=0)
    make_las("one.las", n=50)
    monitor = Monitor()
    path = make_vpc("none.las", "one.las")
    cloud = read_cloud(path, monitor)
    assert len(cloud) == 50
    assert "1 of 2 tiles have no points and are left out: none.las." in monitor.warnings
    assert count_points(path) == 50
    check_readable(path)
    np.testing.assert_array_equal(read_extent(path)[0], read_extent(path.parent / "one.las")[0])


def test_a_merged_cloud_is_written_and_read(make_las, make_vpc, tmp_path):
    make_las("one.las", point_format=6, n=50)
    make_las("two.las", point_format=8, n=60)
    cloud = read_cloud(make_vpc("one.las", "two.las"))
    cloud.set("cluster_id", np.arange(110))
    write_cloud(cloud, tmp_path / "b.laz")
    again = read_cloud(tmp_path / "b.laz")
    np.testing.assert_array_equal(again.get("xyz"), cloud.get("xyz"))
    np.testing.assert_array_equal(again.get("cluster_id"), np.arange(110))


def test_same_name_with_another_type_becomes_float64(make_las, make_vpc, laspy):
    one = make_las("one.las", extra=2, vlrs=(vlr("LASF_Spec", 4, descriptor("Theirs", 3, options=8, scale=0.5)),))
    two = make_las("two.las", extra=4, vlrs=(vlr("LASF_Spec", 4, descriptor("Theirs", 6)),))
    cloud = read_cloud(make_vpc("one.las", "two.las"))
    (field,) = cloud.header.layout.extras
    assert (field.name, field.dtype) == ("Theirs", np.dtype("<f8"))
    expected = np.concatenate((np.asarray(laspy.read(one)["Theirs"]), laspy.read(two)["Theirs"]))
    np.testing.assert_array_equal(cloud.points["extra0"], expected)


def test_fields_of_one_name_and_bytes_without_any_keep_their_own_values(make_las, make_vpc):
    twice = descriptor("Twice", 3) * 2 + descriptor("", 0, options=1) * 2
    paths = [make_las(f"{n}.las", extra=6, vlrs=(vlr("LASF_Spec", 4, twice),), n=n) for n in (30, 40)]
    cloud = read_cloud(make_vpc("30.las", "40.las"))
    parts = [read_cloud(path) for path in paths]
    assert len(cloud.header.layout.extras) == 4
    for name in ("extra0", "extra1", "extra2", "extra3"):
        expected = np.concatenate([part.points[name] for part in parts])
        np.testing.assert_array_equal(cloud.points[name], expected, err_msg=name)


def test_texts_of_other_encodings_keep_their_bytes_where_a_type_changes(make_las, make_vpc):
    latin = "Höhe über dem Gelände, in Fuß".encode("latin-1")
    raw = [descriptor("H", kind)[:160] + latin.ljust(32, b"\xdf") for kind in (3, 6)]
    make_las("one.las", extra=2, vlrs=(vlr("LASF_Spec", 4, raw[0]),))
    make_las("two.las", extra=4, vlrs=(vlr("LASF_Spec", 4, raw[1]),))
    (field,) = read_cloud(make_vpc("one.las", "two.las")).header.layout.extras
    assert field.dtype == np.dtype("<f8")
    assert field.raw[160:] == latin.ljust(32, b"\xdf")


def test_copc_tiles_and_overviews(tmp_path, rng):
    xyz = rng.uniform(0, 100, (1000, 3))
    for name, part in (("a", xyz[:600]), ("b", xyz[600:]), ("overview", xyz[::10])):
        write_cloud(create_cloud({"xyz": part}), tmp_path / f"{name}.copc.laz")
    assets = {"overview": {"href": "overview.copc.laz", "roles": ["overview"]}}
    features = [{"assets": {**assets, "data": {"href": f"{name}.copc.laz", "roles": ["data"]}}} for name in "ab"]
    (tmp_path / "all.vpc").write_text(json.dumps({"features": features}))
    cloud = read_cloud(tmp_path / "all.vpc")
    assert len(cloud) == 1000
    np.testing.assert_allclose(np.sort(cloud.get("xyz")[:, 0]), np.sort(xyz[:, 0]), atol=0.001)
    with pytest.raises(ValueError, match="take the place of the input b.copc.laz"):
        write_cloud(cloud, tmp_path / "b.las")
    write_cloud(cloud, tmp_path / "c.las")


def test_far_tiles_get_an_offset_between_them(make_las, make_vpc, laspy):
    one = make_las("one.las", offset=(0.0, 0.0, 0.0))
    two = make_las("two.las", offset=(3_000_000.0, 0.0, 0.0), scale=(0.001, 0.01, 0.001))
    for path, las in ((one, laspy.read(one)), (two, laspy.read(two))):
        las.write(path)
    cloud = read_cloud(make_vpc("one.las", "two.las"))
    expected = np.concatenate((laspy.read(one).x, laspy.read(two).x))
    np.testing.assert_allclose(cloud.get("xyz")[:, 0] + cloud.origin[0], expected, atol=1e-6)


def test_tiles_of_different_crs_are_refused(make_las, make_vpc):
    make_las("one.las", vlrs=(crs(RD),))
    make_las("two.las", vlrs=(crs('PROJCS["UTM",UNIT["metre",1],AUTHORITY["EPSG","32631"]]'),))
    with pytest.raises(ValueError, match=r"one.las and two.las have different coordinate .* \(EPSG:28992, "):
        read_cloud(make_vpc("one.las", "two.las"))


def test_waveforms_and_gps_times_that_do_not_merge_are_reported(make_las, make_vpc):
    from lidar_buildings.tests.las_files import evlr

    packets = evlr("LASF_Spec", 65535, b"w" * 100)
    make_las("one.las", point_format=9, waveforms=True, evlrs=(packets,), encoding=1)
    make_las("two.las", point_format=9)
    monitor = Monitor()
    cloud = read_cloud(make_vpc("one.las", "two.las"), monitor)
    assert cloud.header.evlrs == []
    assert any("waveforms" in sentence for sentence in monitor.warnings)
    assert any("GPS time" in sentence for sentence in monitor.warnings)
    make_las("one.las", point_format=9, encoding=4)
    monitor = Monitor()
    read_cloud(make_vpc("one.las", "two.las"), monitor)
    assert any("waveforms" in sentence for sentence in monitor.warnings)


@pytest.mark.parametrize("mark", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize(
    "href",
    ["a b%2.las", "./a%20b%252.las", "here\\..\\a b%2.las", ".\\a%20b%252.las", "file:a%20b%252.las", "{}/a b%2.las",
     "file://{}/a%20b%252.las", "file:{}/a%20b%252.las", "FILE://localhost{}/a%20b%252.las"],
)  # fmt: skip
def test_names_of_tiles_are_paths_or_uris(make_las, make_vpc, tmp_path, href, mark):
    """STAC has URIs, QGIS and PDAL write names as they are, and Windows has its own slashes and byte order marks."""
    make_las("a b%2.las", n=50)
    (tmp_path / "here").mkdir()
    path = make_vpc(href.format(tmp_path))
    path.write_text(path.read_text(encoding="utf-8"), encoding=mark)
    assert count_points(path) == 50


def test_a_name_that_is_also_a_uri_is_taken_as_it_is(make_las, make_vpc):
    make_las("a%20b.las", n=50)
    make_las("a b.las", n=70)
    assert count_points(make_vpc("a%20b.las")) == 50


@pytest.mark.parametrize(
    "href",
    ["//host/share/a.las", r"\\host\share\a.las", "/\\host/share/a.las", "%2F%2Fhost/share/a.las", "file://host/share/a.las",
     "file:////host/share/a.las", "file:%5C%5Chost/share/a.las", r"\\?\UNC\host\share\a.las", "smb://host/a.las"],
)  # fmt: skip
def test_no_tile_is_looked_for_on_another_computer(make_las, make_vpc, monkeypatch, href):
    """Windows sends a hash of the password to a computer that is merely asked for a file."""
    make_las("one.las")
    looked_up = []
    monkeypatch.setattr(vpc.os.path, "isfile", lambda path: looked_up.append(str(path)) or True)
    with pytest.raises(ValueError, match="which is not a local file; download it"):
        read_cloud(make_vpc(href))
    assert looked_up == []


@pytest.mark.parametrize(
    ("href", "message"),
    [
        ("gone.laz", "names the tile gone.laz, which is missing"),
        ("https://example.com/a.laz", r"is on the web; allow it .* \(add example\.com to"),
        ("https://example.com/a.txt", "not a local file"),
        ("a.xyz", "is no LAS, LAZ or COPC file"),
    ],
)
def test_bad_tiles_are_named(make_las, make_vpc, href, message):
    make_las("one.las")
    with pytest.raises(ValueError, match=message):
        read_cloud(make_vpc("one.las", href))


@pytest.mark.parametrize(
    "text", ["", "no json", "[]", "{}", '{"features": [1]}', '{"features": [{"assets": []}]}', '{"features": []}']
)
def test_what_is_no_collection_is_refused(tmp_path, text):
    path = tmp_path / "a.vpc"
    path.write_text(text)
    with pytest.raises(ValueError, match="a.vpc (is not a virtual point cloud|names no tiles)"):
        read_cloud(path)


def test_output_may_not_be_a_tile(make_las, make_vpc, tmp_path):
    make_las("one.las")
    make_las("two.las")
    cloud = read_cloud(make_vpc("one.las", "two.las"))
    with pytest.raises(ValueError, match="is also an input"):
        write_cloud(cloud, tmp_path / "two.las")
