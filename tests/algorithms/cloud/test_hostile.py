"""Small files whose headers claim more than they hold: refused in one sentence, or read right, in little memory."""

import importlib.util
import io
import json
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import laz as laz_module
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import check_readable, read_cloud, write_cloud
from lidar_buildings.tests.attacks.mutants import pointwise
from lidar_buildings.tests.las_files import descriptor, evlr, vlr

ROOT = Path(__file__).resolve().parents[3]
POINTS = 150
# What a process may take that reads a hostile file (MB): Python with its packages, and the files of a few kB.
MOST_MEMORY = 600
READ = """
import json, re, sys
from pathlib import Path
import conftest
from lidar_buildings.algorithms.cloud.files import read_cloud
for path in sys.argv[1:]:
    try:
        said = len(read_cloud(path))
    except ValueError as error:
        said = str(error)
    print(json.dumps([said, int(re.search(r"VmHWM:\\s*([0-9]+)", Path("/proc/self/status").read_text())[1]) / 1024]))
"""
pytestmark = pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory is read from Linux's /proc")


@pytest.fixture(params=["old", "layered", "copc"])
def laz(request, make_las, tmp_path):
    """A sound file of a few kB for each way to compress, as bytes, with a path for files made from it."""
    source = make_las(point_format=3 if request.param == "old" else 7, n=POINTS)
    path = tmp_path / ("sound.copc.laz" if request.param == "copc" else "sound.laz")
    write_cloud(read_cloud(source), path)
    return path.read_bytes(), tmp_path / path.name.replace("sound", "hostile")


# Positions patched below. LAS header: 96 offset to points, 104 point format, 105 length of a record, 179 to 219 bounds,
# 227 waveforms, 247 number of points. LASzip record: 0 compressor, 12 points of a chunk, 32 number of items, then the
# type, size and version of each item.


def record_at(raw):
    """Return where the payload of the LASzip record starts: its user id is at byte 2 of a head of 54 bytes."""
    return raw.index(b"laszip encoded") - 2 + 54


def points_at(raw):
    return struct.unpack_from("<I", raw, 96)[0]


def patched(raw, at, kind, *values):
    raw = bytearray(raw)
    struct.pack_into(kind, raw, at, *values)
    return bytes(raw)


def readings(path, *hostile):
    """Read each content in a process of their own; return the number of points or the sentence for each."""
    paths = [path.with_name(f"{number}-{path.name}") for number in range(len(hostile))]
    for one, raw in zip(paths, hostile):
        one.write_bytes(raw)
    command = [sys.executable, "-W", "ignore", "-c", READ, *paths]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found = [json.loads(line) for line in done.stdout.splitlines()]
    assert [memory for _, memory in found if memory >= MOST_MEMORY] == []
    assert all(said == POINTS or (said.endswith(".") and "\n" not in said) for said, _ in found)
    return [said for said, _ in found]


def assert_refused(path, words, *hostile):
    assert [said for said in readings(path, *hostile) if words not in str(said)] == []


def test_chunks_of_more_points_than_there_are_take_no_memory(laz):
    """Lazrs made room for a whole chunk: 4 GB for 150 points, and with 2^31 points (96 GB) the process ended."""
    raw, path = laz
    if path.name.endswith(".copc.laz"):
        pytest.skip("chunks of COPC have no size in common")
    sizes = (10**8, 2**31, 2**32 - 2)
    assert readings(path, *(patched(raw, record_at(raw) + 12, "<I", size) for size in sizes)) == [POINTS] * 3


def test_chunks_of_an_unstated_number_of_points(laz):
    """To LASzip, 0 means that each chunk has its own number, as in many COPC; a table without numbers is damage."""
    raw, path = laz
    if path.name.endswith(".copc.laz"):
        assert readings(path, patched(raw, record_at(raw) + 12, "<I", 0)) == [POINTS]
    else:
        assert_refused(path, "damaged", patched(raw, record_at(raw) + 12, "<I", 0))


def test_layers_larger_than_their_chunk(laz):
    """Lazrs made room for every layer before it read it: 9 of 4 GB."""
    raw, path = laz
    size = struct.unpack_from("<H", raw, 105)[0]
    if raw[104] & 63 < 6:
        pytest.skip("points of old formats are not stored in layers")
    layers_at = points_at(raw) + 8 + size + 4
    nine, one = patched(raw, layers_at, "<9I", *[2**32 - 1] * 9), patched(raw, layers_at + 4, "<I", 10**9)
    assert_refused(path, "layers of", nine, one)


def test_more_chunks_than_bytes(laz):
    raw, path = laz
    (table,) = struct.unpack_from("<q", raw, points_at(raw))
    assert_refused(path, "chunks don't fit into", *(patched(raw, table + 4, "<I", n) for n in (2**32 - 1, 10**6)))
    assert_refused(path, "its chunks hold at most 0", patched(raw, table + 4, "<I", 0))


def test_a_chunk_table_outside_of_the_points(laz):
    raw, path = laz
    places = (0, -2, 2**62, 10**6)
    assert_refused(path, "chunk table should be at", *(patched(raw, points_at(raw), "<q", place) for place in places))


def with_table(raw, table, filled=0):
    """Return the file with a chunk table of (points, bytes) per chunk, moved back by ``filled`` bytes of 0."""
    lazrs = pytest.importorskip("lazrs")
    table_at = struct.unpack_from("<q", raw, points_at(raw))[0] + filled
    size = struct.unpack_from("<H", raw, record_at(raw) - 34)[0]
    raw = patched(raw, points_at(raw), "<q", table_at)
    stream = io.BytesIO(raw[: table_at - filled] + bytes(filled))
    stream.seek(table_at)
    lazrs.write_chunk_table(stream, table, lazrs.LazVlr(raw[record_at(raw) : record_at(raw) + size]))
    return stream.getvalue()


def test_a_chunk_table_that_promises_too_much(laz):
    raw, path = laz
    tables = ([(POINTS, 10**9)], [(POINTS, 2**31 - 1)], [(10**9, 100)], [(POINTS, 40), (0, 2**30)])
    assert_refused(path, "damaged", *(with_table(raw, table) for table in tables))


def test_a_chunk_that_begins_near_the_end_of_the_file(make_las, tmp_path):
    """The sizes of its layers were cut off, which numpy said in its own words."""
    path = tmp_path / "sound.laz"
    write_cloud(read_cloud(make_las(point_format=7, n=POINTS)), path)
    raw = path.read_bytes()
    room = struct.unpack_from("<q", raw, points_at(raw))[0] - points_at(raw) - 8
    hostile = [with_table(raw, [(POINTS - 1, room), (1, size)], size) for size in (1, 2, 5, 17, 30)]
    assert_refused(tmp_path / "hostile.laz", "ends before the sizes of its", *hostile)


def test_points_of_another_size_in_the_laszip_record(laz):
    raw, path = laz
    sizes = (patched(raw, record_at(raw) + 36, "<H", size) for size in (65_535, 1, 0))
    assert_refused(path, "its LASzip record describes points of", *sizes)


def test_more_items_in_the_laszip_record_than_it_has(laz):
    raw, path = laz
    assert_refused(path, "its LASzip record is too short", patched(raw, record_at(raw) + 32, "<H", 65_535))


def test_many_points_promised(laz):
    raw, path = laz
    hostile = [patched(raw, 247, "<Q", count) for count in (10**6, 7 * 10**6, 2**40)]
    if not path.name.endswith(".copc.laz"):
        hostile += [patched(one, record_at(raw) + 12, "<I", 2**31) for one in hostile]
    assert_refused(path, "truncated or damaged", *hostile)


def test_long_records_of_many_points(make_las, tmp_path):
    path = make_las(point_format=6, n=3, extra=2000)
    write_cloud(read_cloud(path), tmp_path / "long.laz")
    raw = (tmp_path / "long.laz").read_bytes()
    assert_refused(tmp_path / "hostile.laz", "it promises 100000000 points", patched(raw, 247, "<Q", 100_000_000))


def test_damage_in_the_chunk_table_and_the_heads_of_chunks(laz):
    """Of 60 files with two changed bytes in the table one ended the process, and ten took over 1 GB."""
    raw, path = laz
    rng = np.random.default_rng(1)
    (table_at,) = struct.unpack_from("<q", raw, points_at(raw))
    hostile = []
    for _ in range(60):
        damaged = bytearray(raw)
        for at in (*rng.integers(table_at, len(raw), 2), *rng.integers(points_at(raw), points_at(raw) + 90, 2)):
            damaged[at] = rng.integers(256)
        hostile.append(bytes(damaged))
    assert len(readings(path, *hostile)) == 60


def test_points_without_chunks_that_name_layers(laz):
    """Laszip ended the process with a segmentation fault."""
    raw, path = laz
    if raw[104] & 63 < 6:
        pytest.skip("points of old formats are not stored in layers")
    assert_refused(path, "describes layered points without chunks", patched(raw, record_at(raw), "<H", 1))


def test_a_header_that_places_waveforms_where_there_are_none(make_las, tmp_path):
    """Any record there was taken for them, and the output, whose header kept the position, could not be read."""
    evlrs = (evlr("someone", 7, b"anything"), evlr("LASF_Spec", 2047, bytes(64)))
    path = make_las(point_format=9, waveforms=True, evlrs=evlrs)
    cloud = read_cloud(path)
    cloud.set("cluster_id", np.zeros(len(cloud)))
    for name in ("b.las", "b.laz") if importlib.util.find_spec("laszip") else ("b.las",):
        write_cloud(cloud, tmp_path / name)
        again = read_cloud(tmp_path / name)
        assert [record.key for record in again.header.evlrs] == [(b"someone", 7), (b"LASF_Spec", 2047)]


def test_waveforms_farther_off_than_any_file_is_long(make_las):
    """A position of 2^64 - 1 was refused in Python's own words."""
    path = make_las(point_format=9, waveforms=True, evlrs=(evlr("someone", 7, b"anything"),))
    raw = path.read_bytes()
    hostile = [patched(raw, 227, "<Q", position) for position in (2**64 - 1, 2**63, len(raw) + 1)]
    assert_refused(path, "waveforms should start at byte", *hostile)


def test_points_of_other_kinds_in_the_laszip_record(laz):
    """Lazrs took points for colors, read the sizes of layers at a wrong position, and made room for 3 GB."""
    raw, path = laz
    first = record_at(raw) + 34
    hostile = [patched(raw, first, "<H", kind) for kind in (0, 7, 11, 12, 13, 14, 300)]
    assert_refused(path, "its LASzip record does not describe point format", *hostile)


def test_versions_of_the_laszip_record_that_are_not_known(laz):
    """A version of later years was called damage."""
    raw, path = laz
    unknown = (0, 5, 1 if raw[104] & 63 >= 6 else 3)
    hostile = [patched(raw, record_at(raw) + 38, "<H", version) for version in unknown]
    assert_refused(path, "is compressed with version", *hostile)


def test_a_version_that_lazrs_lacks(laz, monkeypatch):
    """Points of one scanner channel are the same in versions 3 and 4, which laszip reads and lazrs does not."""
    raw, path = laz
    if raw[104] & 63 < 6:
        pytest.skip("version 4 is of points in layers")
    sound = path.with_name(path.name.replace("hostile", "sound"))
    for item in range(struct.unpack_from("<H", raw, record_at(raw) + 32)[0]):
        raw = patched(raw, record_at(raw) + 38 + 6 * item, "<H", 4)
    path.write_bytes(raw)
    if importlib.util.find_spec("laszip"):
        np.testing.assert_array_equal(read_cloud(path).points["X"], read_cloud(sound).points["X"])
    has_backend = laz_module.has_backend
    monkeypatch.setattr(laz_module, "has_backend", lambda name: name != "Laszip" and has_backend(name))
    with pytest.raises(ValueError, match=r"compressed with version 4 of LASzip's items .* or install laszip\.$"):
        check_readable(path)


@pytest.mark.parametrize("point_format", [0, 1, 3])
def test_laz_of_before_2011_has_no_chunks(make_las, tmp_path, point_format):
    """Only laszip read it, which trusts the file."""
    cloud = read_cloud(make_las(point_format=point_format, minor=2, n=POINTS, extra=3))
    write_cloud(cloud, tmp_path / "chunked.laz")
    (tmp_path / "whole.laz").write_bytes(pointwise((tmp_path / "chunked.laz").read_bytes()))
    assert read_cloud(tmp_path / "whole.laz").points.tobytes() == cloud.points.tobytes()
    # The number of points of a chunk means nothing there; some writers left 1.
    raw = (tmp_path / "whole.laz").read_bytes()
    (tmp_path / "one.laz").write_bytes(patched(raw, record_at(raw) + 12, "<I", 1))
    assert read_cloud(tmp_path / "one.laz").points.tobytes() == cloud.points.tobytes()
    (tmp_path / "cut.laz").write_bytes(raw[:-900])
    with pytest.raises(ValueError, match="can't be decompressed"):
        read_cloud(tmp_path / "cut.laz")


# --- units ------------------------------------------------------------------------------------------------------------


def geokeys(unit):
    keys = (1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 32767, 3077, 34736, 1, 0)
    return (
        vlr("LASF_Projection", 34735, struct.pack("<16H", *keys)),
        vlr("LASF_Projection", 34736, struct.pack("<d", unit)),
    )


@pytest.mark.parametrize("unit", [0.0, -0.0, -1.0, np.nan, np.inf, -np.inf, 1e-300, 1e300])
def test_a_unit_that_is_no_length(make_las, unit):
    """A unit of 1e-300 m ended in a division by zero, -1 mirrored the cloud, NaN was blamed on the points."""
    with pytest.raises(ValueError, match=r"^The file gives its unit of length as .* m, which is damaged"):
        read_cloud(make_las(vlrs=geokeys(unit)))
    if np.isfinite(unit):
        with pytest.raises(ValueError, match="which is damaged"):
            read_cloud(make_las(vlrs=(vlr("LASF_Projection", 2112, f'PROJCS["a",UNIT["b",{unit!r}]]\0'.encode()),)))


def test_every_tile_is_held_to_its_units(make_las, tmp_path):
    """One in degrees was refused before a run, but read in it."""
    code = 'AUTHORITY["EPSG","28992"]'
    for name, wkt in (("one.las", f'PROJCS["a",UNIT["metre",1],{code}]'), ("two.las", f'GEOGCS["a",{code}]')):
        make_las(name, vlrs=(vlr("LASF_Projection", 2112, wkt.encode() + b"\0"),))
    with pytest.raises(ValueError, match="The coordinates are degrees"):
        read_cloud(vpc(tmp_path, "one.las", "two.las"))


def test_axes_of_different_units(make_las):
    """The unit of the first axis was taken for both."""
    axes = 'AXIS["e",east,LENGTHUNIT["foot",0.3048]],AXIS["n",north,LENGTHUNIT["metre",1]]'
    wkt = f'PROJCRS["mixed",CS[Cartesian,2],{axes}]\0'.encode()
    with pytest.raises(ValueError, match=r"axes of the coordinates have different units \(0.3048 and 1 m\)"):
        read_cloud(make_las(vlrs=(vlr("LASF_Projection", 2112, wkt),)))


# --- virtual point clouds ---------------------------------------------------------------------------------------------


def vpc(tmp_path, *hrefs):
    path = tmp_path / "all.vpc"
    path.write_text(json.dumps({"features": [{"assets": {"data": {"href": href}}} for href in hrefs]}))
    return path


@pytest.mark.parametrize("at", [179, 187, 219])
@pytest.mark.parametrize("bound", [np.nan, np.inf, -np.inf])
def test_a_tile_without_finite_bounds(make_las, tmp_path, at, bound):
    """The merged cloud had NaN for an offset and could not be read again."""
    one, two = make_las("one.las"), make_las("two.las")
    two.write_bytes(patched(two.read_bytes(), at, "<d", bound))
    merged = read_cloud(vpc(tmp_path, one.name, two.name))
    np.testing.assert_array_equal(merged.header.offset, read_cloud(one).header.offset)
    assert len(merged) == 2 * len(read_cloud(two)) == 200


def test_a_tile_named_twice_is_read_once(make_las, tmp_path):
    make_las("one.las")
    make_las("two.las", n=50)
    names = ("one.las", "two.las", "./one.las", "one.las", f"../{tmp_path.name}/two.las")
    assert len(read_cloud(vpc(tmp_path, *names))) == 150


@pytest.mark.parametrize("depth", [2000, 100_000])
def test_json_nested_deeply(tmp_path, depth):
    path = tmp_path / "deep.vpc"
    path.write_text("[" * depth + "]" * depth)
    with pytest.raises(ValueError, match=r"deep\.vpc is not a virtual point cloud"):
        read_cloud(path)


def test_a_name_with_line_breaks_stays_one_sentence(tmp_path):
    with pytest.raises(ValueError, match=r"^all\.vpc names the tile a b\.las, which is missing; .*\.$") as caught:
        read_cloud(vpc(tmp_path, "a\nb.las"))
    assert "\n" not in str(caught.value)


def test_json_takes_a_bounded_memory(tmp_path):
    """100 MB of JSON took 2.4 GB."""
    allowed, refused = [], []
    for value in ("[]", '"\u00e9b"', '"\U0001f332"', '{"":[]}'):
        size = len(value.encode()) + 1
        # As the reader estimates it: bytes per byte of text, and 90 for each value.
        cost = size * (2 if value.isascii() else 5) + 90 * sum(map(f"{value},".count, "[{,:"))
        number = 450_000_000 // cost
        allowed.append(f"[{','.join([value] * (number - 10))}]".encode())
        refused.append(f"[{','.join([value] * (number + 10))}]".encode())
    said = readings(tmp_path / "a.vpc", *allowed, *refused)
    assert all("is not a virtual point cloud" in sentence for sentence in said[: len(allowed)])
    assert all("larger than a virtual point cloud of thousands" in sentence for sentence in said[len(allowed) :])


def test_json_far_too_large_is_not_read(tmp_path):
    path = tmp_path / "a.vpc"
    with path.open("wb") as file:
        file.truncate(10**12)
    with pytest.raises(ValueError, match=r"a\.vpc \(1000000 MB\) is larger than"):
        read_cloud(path)


@pytest.mark.parametrize("name", ["\0.las", "\ud800.las", "\u202ea.las", "\x1b[2J.las", "x" * 5000 + ".las"])
def test_names_of_tiles_are_shown_in_one_printable_line(tmp_path, name):
    with pytest.raises(ValueError, match=r"^all\.vpc names the tile .*, which is missing") as caught:
        read_cloud(vpc(tmp_path, name))
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 200


def test_names_of_systems_and_dimensions_are_shown_in_one_printable_line(make_las):
    degrees = b'GEOGCS["\x1b\nWGS \x00"]\0'
    with pytest.raises(ValueError, match="The coordinates are degrees") as caught:
        read_cloud(make_las(vlrs=(vlr("LASF_Projection", 2112, degrees.replace(b'\x00"', b'"')),)))
    assert str(caught.value).isprintable()
    cloud = read_cloud(make_las(extra=1, vlrs=(vlr("LASF_Spec", 4, descriptor("a\n\x1bb", 1)),)))
    with pytest.raises(ValueError, match="has no dimension 'c'; it has .*, a b, ") as caught:
        cloud.named("c")
    assert str(caught.value).isprintable()


@pytest.mark.parametrize("scale", [(-0.01, 0.01, 0.001), (0.01, -0.01, 0.001), (0.01, 0.01, -0.001)])
def test_a_negative_scale_is_refused(make_las, scale):
    """It mirrored the cloud: buildings were found at the wrong place, or under the ground."""
    path = make_las(scale=scale)
    with pytest.raises(ValueError, match=r"^made\.las has a negative scale .* mirrors the cloud; get the file again"):
        read_cloud(path)


def test_points_that_are_all_alike_are_read(tmp_path):
    """Their ratio of compression is the highest possible, and must not be refused."""
    write_cloud(create_cloud({"xyz": np.zeros((1_000_000, 3))}), tmp_path / "alike.laz")
    assert (tmp_path / "alike.laz").stat().st_size < 20_000
    assert len(read_cloud(tmp_path / "alike.laz")) == 1_000_000
