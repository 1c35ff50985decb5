"""A box of a COPC file is read through its index, from few chunks, with the points of the whole file."""

import shutil
import struct
from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import points
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.copc_index import ENTRY, INFO
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.header import COPC_HIERARCHY, COPC_INFO
from lidar_buildings.algorithms.cloud.points import chunks_near, open_header, read_points
from lidar_buildings.algorithms.stage import Monitor

CORNER = np.array([600_000.0, 5_000_000.0])
SIDE = 1000.0


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """400,000 points on a square kilometer: 30 chunks and more."""
    rng = np.random.default_rng(1)
    xyz = np.column_stack([rng.uniform(0, SIDE, (400_000, 2)) + CORNER, rng.uniform(0, 30, 400_000)])
    path = tmp_path_factory.mktemp("copc") / "a.copc.laz"
    write_cloud(create_cloud({"xyz": xyz, "gps_time": np.arange(400_000) * 1e-3}), path)
    return path


def box(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y1]]) + CORNER


@pytest.mark.parametrize(
    "window", [box(0, 0, 1000, 1000), box(100, 100, 130, 140), box(499.9, 0, 500.1, 1000), box(-50, -50, 3, 4)]
)
def test_the_points_are_those_of_the_whole_in_its_order(path, window):
    whole = read_cloud(path)
    plan = whole.to_map(whole.get("xyz"))[:, :2]
    inside = ((plan >= window[0]) & (plan <= window[1])).all(axis=1)
    part = read_cloud(path, box=window)
    assert 0 < len(part) == inside.sum()
    np.testing.assert_array_equal(part.get("gps_time"), whole.get("gps_time")[inside])


def test_positions_are_those_in_the_file(path, monkeypatch):
    monkeypatch.setattr(points, "AT_ONCE", 50_000)
    header = open_header(path)
    whole = read_points(path, header, Monitor())
    found = 0
    for start, records in chunks_near(path, header, box(200, 200, 600, 400), Monitor()):
        np.testing.assert_array_equal(records, whole[start : start + len(records)])
        found += len(records)
    assert 100_000 < found < 300_000


def test_a_small_window_decompresses_a_small_part(path):
    read = sum(len(records) for _, records in chunks_near(path, open_header(path), box(10, 10, 20, 20), Monitor()))
    # The upper levels, thinned to a point per cell, reach over the whole square.
    assert 0 < read < 200_000


def test_no_point_in_the_box_is_a_sentence(path):
    with pytest.raises(ValueError, match="no points within the extent"):
        read_cloud(path, box=box(2000, 2000, 2100, 2100))


@pytest.fixture
def damaged(path, tmp_path):
    """Return a function that writes other values into a copy of the file: of the root, or of entries of the octree."""

    def write(root=(), entries=()):
        copy = shutil.copy(path, tmp_path / path.name)
        info = next(one for one in open_header(path).vlrs if one.key == COPC_INFO).data
        raw = bytearray(path.read_bytes())
        at, size = INFO.unpack(info)[5:7]
        info_at = raw.index(info)
        for offset, value in root:
            raw[info_at + offset : info_at + offset + len(value)] = value
        pages = np.frombuffer(raw, ENTRY, size // ENTRY.itemsize, at)
        for row, name, value in entries:
            pages[name][row] = value(pages, at, size) if callable(value) else value
        copy.write_bytes(raw)
        return copy

    return write


ROOT_AT, ROOT_SIZE, HALF, SPACING = 40, 48, 24, 32


@pytest.mark.parametrize(
    ("root", "entries", "sentence"),
    [
        ([(ROOT_AT, struct.pack("<Q", 2**63))], [], "a page of .* should be at byte"),
        ([(ROOT_SIZE, struct.pack("<Q", 2**40))], [], "a page of .* should be at byte"),
        ([(ROOT_SIZE, struct.pack("<Q", 33))], [], "a page of 33 bytes"),
        ([(HALF, struct.pack("<d", np.nan))], [], "its root is a cube of nan"),
        ([(HALF, struct.pack("<d", 0.0))], [], "its root is a cube of 0"),
        ([], [(3, "count", 2_000_000_000)], "are not the"),
        ([], [(3, "count", -2)], "more nodes than"),
        ([], [(3, "offset", 2**60)], "are not the"),
        ([], [(3, "size", -5)], "are not the"),
        ([], [(3, "key", (-1, 0, 0, 0))], r"a node \(-1, 0, 0\)"),
        ([], [(3, "key", (2_000_000_000, 0, 0, 0))], r"a node \(2000000000, 0, 0\)"),
        ([], [(3, "key", (1, 0, 2, 0))], r"a node \(1, 0, 2\)"),
        # A page that leads to itself, and one beyond the end.
        ([], [(3, "count", -1), (3, "offset", lambda pages, at, size: at), (3, "size", 32)], "more than once"),
        ([], [(3, "count", -1), (3, "offset", 2**50), (3, "size", 32)], "a page of 32 bytes should be at byte"),
        ([], [(3, "offset", lambda pages, at, size: pages["offset"][4])], "are not the"),
    ],
)
def test_a_hostile_index_is_one_sentence(damaged, root, entries, sentence):
    path = damaged(root, entries)
    with pytest.raises(ValueError, match=sentence) as caught:
        read_cloud(path, box=box(10, 10, 20, 20))
    assert str(caught.value).startswith("a.copc.laz is truncated or damaged")
    assert "\n" not in str(caught.value)


def test_pages_of_further_nodes_are_followed(path, tmp_path):
    # The same octree, its last entries on a page of their own behind the end of the file.
    raw = bytearray(path.read_bytes())
    info = next(one for one in open_header(path).vlrs if one.key == COPC_INFO).data
    at, size = INFO.unpack(info)[5:7]
    entries = np.frombuffer(bytes(raw[at : at + size]), ENTRY).copy()
    first, rest = entries[:-5], entries[-5:]
    link = np.zeros(1, ENTRY)
    link["key"], link["offset"], link["size"], link["count"] = rest["key"][0], len(raw), rest.nbytes, -1
    root = first.tobytes() + link.tobytes()
    raw[at : at + len(root)] = root
    struct.pack_into("<Q", raw, raw.index(info) + ROOT_SIZE, len(root))
    paged = tmp_path / "paged.copc.laz"
    paged.write_bytes(bytes(raw) + rest.tobytes())
    window = box(100, 600, 900, 700)
    expected, part = read_cloud(path, box=window), read_cloud(paged, box=window)
    np.testing.assert_array_equal(part.get("gps_time"), expected.get("gps_time"))


def test_without_an_index_a_box_is_read_from_all_points(path, tmp_path):
    laz = tmp_path / "a.laz"
    write_cloud(read_cloud(path), laz)
    window = box(100, 100, 130, 140)
    a, b = (np.sort(read_cloud(one, box=window).get("gps_time")) for one in (path, laz))
    np.testing.assert_array_equal(a, b)


def spacing(side):
    return np.full(3, side)


@pytest.mark.parametrize("window", [None, box(300, 300, 700, 600)])
def test_of_every_cube_of_the_spacing_one_point_stays_the_lowest(path, tmp_path, window):
    write_cloud(read_cloud(path), tmp_path / "a.las")
    whole, thin = (read_cloud(tmp_path / "a.las", box=window, spacing=one) for one in (None, spacing(10.0)))
    xyz = [cloud.to_map(cloud.get("xyz")) for cloud in (whole, thin)]
    cubes = [list(map(tuple, np.floor(one / 10.0 + 1e-9).astype(int).tolist())) for one in xyz]
    lowest = {}
    for cube, z in zip(cubes[0], xyz[0][:, 2].tolist()):
        lowest[cube] = min(z, lowest.get(cube, np.inf))
    assert dict(zip(cubes[1], xyz[1][:, 2].tolist())) == lowest
    assert len(thin) == len(lowest) == thin.header.count


def test_a_spacing_reads_the_coarse_levels_alone(path):
    root = SIDE / 128
    numbers = []
    # A level is read as long as the one above it shows points farther apart than the spacing.
    for side, levels in ((100.0, 1), (1.05 * root, 1), (0.95 * root, 2), (0.55 * root, 2), (0.45 * root, 3)):
        header = replace(open_header(path), spacing=spacing(side))
        nodes, chunks = nodes_of_levels(path)
        read = sum(len(records) for _, records in chunks_near(path, header, points.EVERYWHERE, Monitor()))
        assert read == nodes[:levels].sum()
        assert points.size_within(path, header, None) == (read, chunks[:levels].sum())
        numbers.append(len(read_cloud(path, spacing=spacing(side))))
    assert numbers == sorted(numbers)
    assert numbers[0] == 10 * 10
    assert numbers[0] < numbers[-1] < 400_000


def nodes_of_levels(path):
    """Return the points and the bytes of each level, from the file itself."""
    header = open_header(path)
    (record,) = header.find_all(COPC_HIERARCHY)
    raw = path.read_bytes()[record.start : record.start + record.size]
    entries = np.frombuffer(raw, ENTRY)
    sums = [np.bincount(entries["key"][:, 0], entries[name]).astype(int) for name in ("count", "size")]
    assert sums[0].sum() == 400_000
    return sums


@pytest.mark.parametrize("stated", [0.0, -1.0, np.nan])
def test_without_a_stated_spacing_of_the_root_all_levels_are_read(damaged, stated):
    copy = damaged(root=[(SPACING, struct.pack("<d", stated))])
    header = replace(open_header(copy), spacing=spacing(100.0))
    assert sum(len(records) for _, records in chunks_near(copy, header, points.EVERYWHERE, Monitor())) == 400_000
