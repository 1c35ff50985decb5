"""Bad input: one sentence each, and no memory allocated by counts in a header alone."""

import errno
import importlib
import json
import os
import struct
import tracemalloc

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import laz, outputs, points
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import check_readable, read_cloud, write_cloud
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.las_files import vlr


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A sound file of each kind, as bytes."""
    rng, folder, found = np.random.default_rng(20190613), tmp_path_factory.mktemp("good"), {}
    cloud = create_cloud({"xyz": rng.uniform(0, 100, (60_000, 3)), "intensity": rng.integers(0, 9, 60_000)})
    for kind in (".las", ".laz", ".copc.laz"):
        write_cloud(cloud, folder / f"good{kind}")
        found[kind] = (folder / f"good{kind}").read_bytes()
    return found


@pytest.fixture
def good(made, tmp_path):
    """A sound file of each kind in the folder of the test, as bytes."""
    for kind, raw in made.items():
        (tmp_path / f"good{kind}").write_bytes(raw)
    return made


def refuse(path, message):
    """Reading raises one ValueError, which has ``message`` in its one sentence, and takes little memory."""
    tracemalloc.start()
    try:
        with pytest.raises(ValueError, match=message) as caught:
            read_cloud(path)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert "\n" not in str(caught.value)
    assert str(caught.value).endswith(".")
    assert peak < 2e8


@pytest.mark.parametrize("kind", [".las", ".laz", ".copc.laz"])
def test_a_look_at_the_header_finds_what_is_wrong(good, tmp_path, kind):
    """Before a model starts: QGIS opens its input too, and a truncated COPC can hang it."""
    path = tmp_path / f"a{kind}"
    path.write_bytes(good[kind])
    check_readable(path)
    path.write_bytes(good[kind][: len(good[kind]) // 2])
    with pytest.raises(ValueError, match=r"a\..*truncated"):
        check_readable(path)
    path.write_bytes(patched(good[kind], 247, "<Q", 10**12))
    with pytest.raises(ValueError, match="promises"):
        check_readable(path)
    with pytest.raises(ValueError, match="does not exist"):
        check_readable(tmp_path / "none.las")


@pytest.mark.parametrize("place", [10**12, 2**64 - 1])
def test_the_start_of_extended_records_is_ignored_where_there_are_none(good, tmp_path, place):
    (tmp_path / "a.las").write_bytes(patched(good[".las"], 235, "<Q", place))
    assert len(read_cloud(tmp_path / "a.las")) == 60_000


def test_the_name_of_a_damaged_record_is_left_out_if_it_can_not_be_shown(good, tmp_path):
    """The bytes of the name have a line break and control characters."""
    path = tmp_path / "a.laz"
    raw = good[".laz"]
    assert raw[377:391] == b"laszip encoded"
    path.write_bytes(raw[:377] + b"\xff\n\x1b[31m\x07" + raw[385:395] + b"\xff\xff" + raw[397:])
    refuse(path, "truncated or damaged: a record of 65535 bytes runs past byte")
    path.write_bytes(raw[:395] + b"\xff\xff" + raw[397:])
    refuse(path, "truncated or damaged: a record laszip encoded 22204 of 65535 bytes runs past byte")


def patched(raw, at, kind, value):
    raw = bytearray(raw)
    struct.pack_into(kind, raw, at, value)
    return bytes(raw)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.las", b"", r"a.las is empty \(0 bytes\)"),
        ("a.laz", b"", r"a.laz is empty \(0 bytes\)"),
        ("a.las", b"x y z\n1 2 3\n" * 50, "a.las is not a LAS or LAZ file: it starts with b'x y '"),
        ("a.las", b"LASF", "truncated"),
        ("a.xyz", b"1 2 3", "a.xyz is no point cloud that can be read; choose a .las"),
        ("a", b"1 2 3", "a is no point cloud that can be read"),
    ],
)
def test_what_is_no_las(tmp_path, name, content, message):
    (tmp_path / name).write_bytes(content)
    refuse(tmp_path / name, message)


def test_missing_file_and_folder(tmp_path):
    refuse(tmp_path / "none.las", "none.las does not exist")
    refuse(tmp_path, "is a folder")


def test_no_points(make_las):
    refuse(make_las(n=0), "made.las has no points")


@pytest.mark.parametrize("kind", [".las", ".laz", ".copc.laz"])
@pytest.mark.parametrize("part", [0.0005, 0.001, 0.01, 0.5, 0.99, 0.99999])
def test_truncated(good, tmp_path, kind, part):
    path = tmp_path / f"a{kind}"
    path.write_bytes(good[kind][: int(len(good[kind]) * part)])
    refuse(path, r"a\..*(is truncated|truncated or damaged)")


@pytest.mark.parametrize("kind", [".las", ".laz", ".copc.laz"])
@pytest.mark.parametrize("count", [10**12, 2**63, 120_000])
def test_more_points_promised_than_there_are(good, tmp_path, kind, count):
    path = tmp_path / f"a{kind}"
    path.write_bytes(patched(good[kind], 247, "<Q", count))
    refuse(path, "promises|decompressed")


@pytest.mark.parametrize(
    ("at", "kind", "value", "message"),
    [
        (131, "<d", np.nan, "no usable coordinates"),
        (155, "<d", np.inf, "no usable coordinates"),
        (139, "<d", 0.0, "no usable coordinates"),
        (131, "<d", 5e-324, "no usable coordinates"),
        (147, "<d", 1e-160, "no usable coordinates"),
        (155, "<d", 1e300, "no usable coordinates"),
        (131, "<d", 1e300, "no usable coordinates"),
        (100, "<I", 2**31, "VLRs"),
        (96, "<I", 2**31, "points should start at byte 2147483648"),
        (104, "<B", 11, "has point format 11"),
        (25, "<B", 9, "is LAS 1.9"),
        (24, "<B", 2, "is LAS 2.4"),
        (105, "<H", 3, "too few for point format"),
        (243, "<I", 2**31, "EVLRs"),
    ],
)
def test_damaged_header(good, tmp_path, at, kind, value, message):
    path = tmp_path / "a.las"
    path.write_bytes(patched(good[".las"], at, kind, value))
    refuse(path, message)


def test_vlr_that_runs_over_is_refused(make_las):
    path = make_las(vlrs=(vlr("someone", 3, b"x" * 10),))
    path.write_bytes(patched(path.read_bytes(), 375 + 20, "<H", 60_000))
    refuse(path, "record someone 3 of 60000 bytes")


@pytest.mark.parametrize("seed", range(5))
def test_damaged_laz_is_refused_or_read_but_never_crashes(good, tmp_path, seed):
    raw = bytearray(good[".laz"])
    for at in np.random.default_rng(seed).integers(600, len(raw), 40):
        raw[at] ^= 0xFF
    path = tmp_path / "a.laz"
    path.write_bytes(bytes(raw))
    try:
        said = f"{len(read_cloud(path))} points"
    except ValueError as error:
        said = str(error)
    assert said == "60000 points" or "damaged" in said


def test_laz_without_its_record(good, tmp_path):
    path = tmp_path / "a.laz"
    path.write_bytes(good[".laz"].replace(b"laszip encoded", b"laszip gone!!!"))
    refuse(path, "LASzip record is missing")


def test_no_laz_package(good, tmp_path, monkeypatch):
    for name in ("lazrs", "laszip"):
        monkeypatch.setattr(importlib.import_module(f"laspy._compression.{name}backend"), name, None)
    refuse(tmp_path / "good.laz", "Python package lazrs, which is not installed")
    cloud = read_cloud(tmp_path / "good.las")
    for name in ("b.laz", "b.copc.laz"):
        with pytest.raises(ValueError, match="lazrs, which is not installed"):
            write_cloud(cloud, tmp_path / name)
    write_cloud(cloud, tmp_path / "b.las")
    assert not list(tmp_path.glob("*b.*laz*"))


def test_too_little_memory_is_refused(make_las, monkeypatch):
    def none_left(*_):
        raise MemoryError

    path = make_las()
    monkeypatch.setattr(points.np, "empty", none_left)
    refuse(path, "GB of memory")


def test_degrees_are_refused(make_las):
    refuse(make_las(vlrs=(vlr("LASF_Projection", 2112, b'GEOGCS["WGS 84",UNIT["degree",0.0174]]\0'),)), "degrees")


def test_an_unreadable_file_is_refused(make_las, monkeypatch):
    path = make_las()

    def closed(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(type(path), "open", closed)
    refuse(path, r"can't be read \(Permission denied\)")


def test_cancel_while_reading_passes_through(make_las):
    class Stop(Monitor):
        def progress(self, fraction):
            raise InterruptedError if fraction > 2 else KeyError("cancelled")

    with pytest.raises(KeyError, match="cancelled"):
        read_cloud(make_las(), Stop())


def test_vpc_tile_that_is_damaged_is_named(tmp_path, good):
    (tmp_path / "bad.las").write_bytes(good[".las"][:1000])
    features = [{"assets": {"data": {"href": name}}} for name in ("good.las", "bad.las")]
    (tmp_path / "a.vpc").write_text(json.dumps({"features": features}))
    refuse(tmp_path / "a.vpc", "bad.las is truncated or damaged")


@pytest.mark.parametrize("backend", ["LazrsParallel", "Laszip"])
def test_a_disk_that_fails_amid_a_file_is_no_damage(tmp_path, rng, monkeypatch, backend):
    """The user was told to get the file again."""
    path = tmp_path / "a.laz"
    write_cloud(create_cloud({"xyz": rng.uniform(0, 100, (300_000, 3))}), path)
    half = path.stat().st_size // 2

    def unreadable(_):
        raise OSError(errno.EIO, "Input/output error")

    class Failing(outputs.KeptFailure):
        def _kept(self, call, data):
            return super()._kept(unreadable if half < self.tell() < 1.2 * half else call, data)

    has_backend = laz.has_backend
    monkeypatch.setattr(laz, "has_backend", lambda name: name == backend and has_backend(name))
    monkeypatch.setattr(points, "KeptFailure", Failing)
    if not laz.has_backend(backend):
        pytest.skip(f"{backend} is not installed")
    with pytest.raises(ValueError, match=r"a\.laz can't be read \(Input/output error\); check the file"):
        read_cloud(path)


def test_a_file_that_changes_while_it_is_read_is_refused(good, tmp_path):
    """A download that went on: half of the points were of the older file."""
    path = tmp_path / "a.las"
    path.write_bytes(good[".las"])

    class Changing(Monitor):
        def progress(self, fraction):
            os.utime(path, ns=(0, 0))

    with pytest.raises(ValueError, match="a.las has changed while it was read; run it again when it is complete"):
        read_cloud(path, Changing())
