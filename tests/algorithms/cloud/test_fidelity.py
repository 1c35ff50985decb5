"""What is written keeps everything that no stage has set."""

import importlib.util
import struct

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.las_files import FORMATS, RECORD_SIZES, descriptor, evlr, random_records, vlr

KEPT = (
    "source_id",
    "encoding",
    "guid",
    "major",
    "minor",
    "system",
    "day",
    "year",
    "scale",
    "offset",
    "user_bytes",
    "gap",
)
EXTRA = b"".join((
    descriptor("Amplitude", 3, options=24, scale=0.01, offset=5.0, text="of the echo"),
    descriptor("Deviation", 9, options=1, no_data=struct.pack("<d", -1.0)),
    descriptor("Vector", 29),
    descriptor("Hidden", 0, options=5),
))  # fmt: skip
EXTRA_SIZE = 2 + 4 + 12 + 5
VLRS = (
    vlr("someone", 7, b"anything \xff\x00\x01", "of theirs", reserved=0xAABB),
    vlr("LASF_Spec", 4, EXTRA, "extra bytes of theirs"),
    vlr("LASF_Projection", 2112, b'LOCAL_CS["here",UNIT["metre",1]]\0'),
    vlr("empty", 1, b""),
)


def versions(point_format):
    lowest = 0 if point_format < 2 else 2 if point_format < 4 else 3 if point_format < 6 else 4
    return range(lowest, 5)


ALL = [(point_format, minor) for point_format in FORMATS for minor in versions(point_format)]


@pytest.fixture
def made(make_las):
    def make(point_format, minor, **more):
        evlrs = (evlr("LASF_Spec", 65535, b"waveforms" * 50), evlr("someone", 9, b"x" * 70_000)) if minor == 4 else ()
        return make_las(
            point_format=point_format, minor=minor, extra=EXTRA_SIZE, vlrs=VLRS, evlrs=evlrs, encoding=1,
            waveforms=minor == 4 and point_format in (4, 5, 9, 10), gap=b"\xdd\xcc" if minor == 0 else b"gap", **more,
        )  # fmt: skip

    return make


WAVEFORMS = (4, 5, 9, 10)
NO_LASZIP = importlib.util.find_spec("laszip") is None


@pytest.mark.skipif(not NO_LASZIP, reason="laszip compresses waveforms")
@pytest.mark.parametrize("point_format", WAVEFORMS)
def test_waveforms_are_not_compressed_by_lazrs(made, tmp_path, point_format):
    # lazrs 0.8.2 lost bytes of the waveform references of formats 9 and 10; laszip could not read its formats 4 and 5.
    with pytest.raises(ValueError, match="write .las instead or install laszip"):
        write_cloud(read_cloud(made(point_format, 4)), tmp_path / "a.laz")
    assert not list(tmp_path.glob("*a.laz*"))


@pytest.mark.parametrize(("point_format", "minor"), ALL)
def test_every_format_and_version_comes_back_byte_by_byte(made, take_apart, tmp_path, point_format, minor):
    if point_format in WAVEFORMS and NO_LASZIP:
        pytest.skip("needs laszip")
    path = made(point_format, minor, user_bytes=b"user bytes")
    write_cloud(read_cloud(path), tmp_path / "a.laz")
    write_cloud(read_cloud(tmp_path / "a.laz"), tmp_path / "b.las")
    old, new = take_apart(path), take_apart(tmp_path / "b.las")
    for name in (*KEPT, "vlrs", "evlrs", "format", "size", "count", "waveforms_at"):
        assert new[name] == old[name], name
    np.testing.assert_array_equal(new["records"], old["records"])
    assert new["software"].rstrip(b"\0") == b"LiDAR Buildings"


@pytest.mark.parametrize(("point_format", "minor"), ALL)
def test_las_only_path_keeps_bytes(made, take_apart, tmp_path, point_format, minor):
    path = made(point_format, minor)
    write_cloud(read_cloud(path), tmp_path / "b.las")
    old, new = take_apart(path), take_apart(tmp_path / "b.las")
    np.testing.assert_array_equal(new["records"], old["records"])
    assert new["vlrs"] == old["vlrs"]
    assert new["rest"] == old["rest"]


@pytest.mark.parametrize("point_format", FORMATS)
def test_new_dimensions_come_after_the_old_bytes(made, take_apart, tmp_path, point_format, rng):
    path = made(point_format, 4)
    cloud = read_cloud(path)
    ids = rng.integers(0, 1000, len(cloud)).astype("i4")
    normals = rng.normal(size=(len(cloud), 3)).astype("f4")
    cloud.set("cluster_id", ids)
    cloud.set("normal", normals)
    write_cloud(cloud, tmp_path / "b.las")
    old, new = take_apart(path), take_apart(tmp_path / "b.las")
    np.testing.assert_array_equal(new["records"][:, : old["size"]], old["records"])
    assert new["size"] == old["size"] + 16
    assert new["records"][:, old["size"] :].tobytes() == b"".join(
        i.tobytes() + n.tobytes() for i, n in zip(ids, normals)
    )
    expected = descriptor("ClusterID", 6, text="cluster; 0 if unassigned")
    added = new["vlrs"][1][54:][len(EXTRA) :]
    assert added[:192] == expected
    assert [added[i + 4 : i + 11] for i in range(192, 768, 192)] == [b"NormalX", b"NormalY", b"NormalZ"]
    assert [*new["vlrs"][:1], *new["vlrs"][2:]] == [*old["vlrs"][:1], *old["vlrs"][2:]]
    assert new["evlrs"] == old["evlrs"]


def test_bytes_that_no_descriptor_names_are_kept_before_new_dimensions(make_las, take_apart, tmp_path, laspy):
    path = make_las(point_format=1, minor=2, extra=3)
    cloud = read_cloud(path)
    cloud.set("cluster_id", np.arange(len(cloud)))
    write_cloud(cloud, tmp_path / "b.las")
    np.testing.assert_array_equal(take_apart(tmp_path / "b.las")["records"][:, :31], take_apart(path)["records"])
    np.testing.assert_array_equal(laspy.read(tmp_path / "b.las")["ClusterID"], np.arange(len(cloud)))


def test_waveforms_of_las_13_stay_where_the_header_says(make_las, take_apart, tmp_path):
    packets = evlr("LASF_Spec", 65535, bytes(range(256)) * 10)
    path = make_las(point_format=4, minor=3, waveforms=True, evlrs=(packets,))
    cloud = read_cloud(path)
    cloud.set("cluster_id", np.zeros(len(cloud)))
    write_cloud(cloud, tmp_path / "b.las")
    raw = (tmp_path / "b.las").read_bytes()
    assert raw[take_apart(tmp_path / "b.las")["waveforms_at"] :] == packets


@pytest.mark.parametrize(
    ("point_format", "encoding", "reported"), [(9, 4, True), (4, 4, True), (9, 0, False), (6, 4, False)]
)
def test_waveforms_in_a_file_of_their_own_are_reported(
    make_las, take_apart, tmp_path, point_format, encoding, reported
):
    """The output kept its references, and there was no file next to it to which they could refer, without a word."""
    path = make_las(point_format=point_format, minor=3 if point_format < 6 else 4, encoding=encoding)
    path.with_suffix(".wdp").write_bytes(b"waveforms")
    monitor = Monitor()
    write_cloud(read_cloud(path), tmp_path / "b.las", monitor)
    assert any(".wdp), which is not copied; copy it next to" in sentence for sentence in monitor.warnings) == reported
    assert take_apart(tmp_path / "b.las")["encoding"] == encoding
    assert not (tmp_path / "b.wdp").exists()


def test_long_evlrs_are_copied_without_being_held(make_las, take_apart, tmp_path, monkeypatch):
    monkeypatch.setattr("lidar_buildings.algorithms.cloud.header.PIECE", 1000)
    path = make_las(evlrs=(evlr("someone", 9, bytes(range(250)) * 30), evlr("someone", 10, b"short" * 200)))
    write_cloud(read_cloud(path), tmp_path / "b.las")
    assert take_apart(tmp_path / "b.las")["evlrs"] == take_apart(path)["evlrs"]


@pytest.mark.parametrize("point_format", FORMATS)
def test_laspy_reads_the_same_from_input_and_output(made, tmp_path, laspy, point_format):
    path = made(point_format, 4)
    target = tmp_path / ("b.las" if point_format in WAVEFORMS else "b.laz")
    write_cloud(read_cloud(path), target)
    old, new = laspy.read(path), laspy.read(target)
    for name in old.point_format.dimension_names:
        np.testing.assert_array_equal(np.asarray(new[name]), np.asarray(old[name]), err_msg=name)
    np.testing.assert_allclose(new.header.mins, old.xyz.min(axis=0))
    np.testing.assert_allclose(new.header.maxs, old.xyz.max(axis=0))
    counts = np.bincount(old.return_number, minlength=16)[1:16]
    np.testing.assert_array_equal(new.header.number_of_points_by_return, counts)


@pytest.mark.parametrize(("point_format", "upgraded"), [(0, 6), (1, 6), (2, 7), (3, 7), (4, 9), (5, 10)])
def test_class_over_31_upgrades_the_format_and_loses_nothing(made, tmp_path, laspy, point_format, upgraded):
    path = made(point_format, 3)
    cloud, monitor = read_cloud(path), Monitor()
    classes = cloud.get("classification").copy()
    classes[5] = 64
    cloud.set("classification", classes)
    write_cloud(cloud, tmp_path / "b.las", monitor)
    old, new = laspy.read(path), laspy.read(tmp_path / "b.las")
    assert (new.header.version.minor, new.point_format.id) == (4, upgraded)
    assert any("Classes over 31" in sentence for sentence in monitor.warnings)
    np.testing.assert_array_equal(new.classification, classes)
    np.testing.assert_allclose(new.scan_angle * 0.006, np.clip(old.scan_angle_rank, -180, 180), atol=0.003)
    for name in old.point_format.dimension_names:
        if name not in ("classification", "scan_angle_rank"):
            np.testing.assert_array_equal(np.asarray(new[name]), np.asarray(old[name]), err_msg=name)


def test_classes_up_to_31_keep_the_format(made, take_apart, tmp_path):
    path = made(3, 2)
    cloud = read_cloud(path)
    cloud.set("classification", np.full(len(cloud), 31))
    write_cloud(cloud, tmp_path / "b.las")
    old, new = take_apart(path), take_apart(tmp_path / "b.las")
    assert (new["format"], new["minor"]) == (3, 2)
    # Byte 15 holds the class and the flags synthetic, key-point and withheld.
    np.testing.assert_array_equal(new["records"][:, 15], old["records"][:, 15] & 0b11100000 | 31)
    np.testing.assert_array_equal(np.delete(new["records"], 15, axis=1), np.delete(old["records"], 15, axis=1))


def test_many_chunks_keep_the_order(make_las, take_apart, tmp_path, monkeypatch):
    monkeypatch.setattr("lidar_buildings.algorithms.cloud.points.AT_ONCE", 700)
    path = make_las(records=random_records(3, RECORD_SIZES[3], 5000), point_format=3, minor=2)
    write_cloud(read_cloud(path), tmp_path / "a.laz")
    write_cloud(read_cloud(tmp_path / "a.laz"), tmp_path / "b.las")
    np.testing.assert_array_equal(take_apart(tmp_path / "b.las")["records"], take_apart(path)["records"])


def of_each_kind(paths, laspy):
    """Return the smallest file of each maker, format and set of records."""
    kinds = {}
    for path in sorted(paths, key=lambda one: -one.stat().st_size):
        with laspy.open(path) as file:
            header = file.header
        records = tuple((record.user_id, record.record_id) for record in header.vlrs)
        kinds[header.generating_software, header.point_format.id, str(header.version), records] = path
    return list(kinds.values())


@pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_real_files_come_back(real_files, tmp_path, laspy, every):
    for path in real_files if every else of_each_kind(real_files, laspy):
        cloud = read_cloud(path)
        cloud.set("confidence", np.full(len(cloud), 0.5))
        write_cloud(cloud, tmp_path / "a.laz")
        old, new = laspy.read(path), laspy.read(tmp_path / "a.laz")
        for name in old.point_format.dimension_names:
            np.testing.assert_array_equal(np.asarray(new[name]), np.asarray(old[name]), err_msg=f"{path.name} {name}")
        stored = [(record.user_id, record.record_id, record.record_data_bytes()) for record in old.vlrs]
        again = [(record.user_id, record.record_id, record.record_data_bytes()) for record in new.vlrs]
        assert again[: len(stored)] == stored or [item for item in again if item[1] != 4] == stored
        for name in ("scales", "offsets", "creation_date", "system_identifier", "file_source_id", "uuid"):
            np.testing.assert_array_equal(getattr(new.header, name), getattr(old.header, name), err_msg=name)
        assert new.header.global_encoding.value == old.header.global_encoding.value
