"""Ranges of files on the web are kept from run to run where the user says so: the same points from fewer bytes."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import web_cache, web_file
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.tests.web_server import serving

ROOT = Path(__file__).resolve().parents[3]
VIEW = np.array([[600_300.0, 5_000_300.0], [600_400.0, 5_000_400.0]])

# What another process does: it reads the view of an address, and prints a sum of its records.
READER = """
import sys, zlib
sys.path.insert(0, sys.argv[1])
import conftest, numpy as np
from lidar_buildings.algorithms.cloud import web_cache, web_file
from lidar_buildings.algorithms.cloud.files import read_cloud
# Many ranges.
web_file.MOST_AT_ONCE = 2**15
web_cache._MOST = int(sys.argv[3])
box = np.array(eval(sys.argv[4]))
print(zlib.crc32(read_cloud(sys.argv[2], box=box).points.tobytes()))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """300,000 points on a square kilometer, and others at the same places."""
    rng = np.random.default_rng(1)
    folder = tmp_path_factory.mktemp("web")
    for name in "ab":
        xyz = rng.uniform(0, [1000, 1000, 30], (300_000, 3)) + [600_000, 5_000_000, 0]
        write_cloud(create_cloud({"xyz": xyz}, "EPSG:32631"), folder / f"{name}.copc.laz")
    return folder


@pytest.fixture
def server(folder):
    with serving(folder) as server:
        yield server
    web_file._known.clear()


@pytest.fixture
def kept(tmp_path, monkeypatch):
    monkeypatch.setattr(web_cache, "_folder", [str(tmp_path / "kept")])
    return tmp_path / "kept"


def read_anew(server, name="a.copc.laz"):
    """Read the view as a new process does; return its records, and the bytes that the server sent."""
    web_file._known.clear()
    server.sent = 0
    return read_cloud(server.address(name), box=VIEW).points, server.sent


def test_a_later_run_reads_the_same_points_from_the_folder(server, folder, kept):
    first, sent = read_anew(server)
    again, sent_again = read_anew(server)
    np.testing.assert_array_equal(first, again)
    np.testing.assert_array_equal(again, read_cloud(folder / "a.copc.laz", box=VIEW).points)
    assert sent > 300_000
    # The head of the file, which shows that it has not changed.
    assert sent_again == web_file._LEAST
    assert sum(file.stat().st_size for file in kept.iterdir()) <= sent


def test_nothing_is_kept_unless_a_folder_is_named(server, tmp_path, monkeypatch):
    monkeypatch.setattr(web_cache, "_folder", [""])
    monkeypatch.chdir(tmp_path)
    read_anew(server)
    assert read_anew(server)[1] > 300_000
    assert not list(tmp_path.iterdir())


def test_another_version_is_read_anew(server, folder, kept):
    read_anew(server)
    for server.version in ("2", ""):
        sent = [read_anew(server)[1] for _ in range(2)]
        assert sent[0] > 300_000
        # What has no version may be another file each time.
        assert (sent[1] > 300_000) == (server.version == "")


def test_addresses_and_keys_are_in_no_name_and_other_keys_find_nothing(server, kept):
    address = server.address("a.copc.laz")
    read_cloud(f"{address}?key=secret", box=VIEW)
    names = [file.name for file in kept.iterdir()]
    assert names
    assert all(set(name.split(".")[0]) <= set("0123456789abcdef-") for name in names)
    web_file._known.clear()
    server.sent = 0
    read_cloud(f"{address}?key=other", box=VIEW)
    assert server.sent > 300_000


def test_the_oldest_ranges_go_first_and_other_files_stay(server, kept, monkeypatch):
    kept.mkdir()
    (kept / "a-b-c.txt").write_bytes(bytes(1000))
    read_anew(server)
    old = set(kept.iterdir()) - {kept / "a-b-c.txt"}
    for file in old:
        os.utime(file, (1, 1))
    monkeypatch.setattr(web_cache, "_MOST", sum(file.stat().st_size for file in old) + 1000)
    read_anew(server, "b.copc.laz")
    left = set(kept.iterdir()) - {kept / "a-b-c.txt"}
    assert (kept / "a-b-c.txt").exists()
    assert left - old
    assert len(left & old) < len(old)
    assert sum(file.stat().st_size for file in left) <= web_cache._MOST


def test_a_range_that_is_cut_off_is_read_anew(server, kept):
    first, _ = read_anew(server)
    for file in kept.iterdir():
        file.write_bytes(file.read_bytes()[:-1])
    again, sent = read_anew(server)
    np.testing.assert_array_equal(first, again)
    assert sent > 300_000


def test_ranges_that_another_process_removes_meanwhile_are_read_anew(server, kept, monkeypatch):
    first, _ = read_anew(server)
    listed = web_cache._oldest_first

    def removed(*arguments):
        found = listed(*arguments)
        for *_, file in found:
            file.unlink()
        return found

    monkeypatch.setattr(web_cache, "_oldest_first", removed)
    again, sent = read_anew(server)
    np.testing.assert_array_equal(first, again)
    assert sent > 300_000


def test_a_folder_that_can_not_be_written_is_a_sentence(server, kept):
    kept.write_text("a file")
    with pytest.raises(ValueError, match="can't be written"):
        read_anew(server)


def test_processes_at_once_write_and_remove_without_harm(server, folder, kept):
    expected = subprocess.run(
        [sys.executable, "-c", READER, str(ROOT), str(folder / "a.copc.laz"), "0", repr(VIEW.tolist())],
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    command = [sys.executable, "-c", READER, str(ROOT), server.address("a.copc.laz"), "150000", repr(VIEW.tolist())]
    environment = {**os.environ, web_cache._VARIABLE: str(kept)}
    started = [
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
        for _ in range(4)
    ]
    for process in started:
        found, errors = process.communicate(timeout=60)
        assert (found, errors) == (expected, "")
    assert 0 < sum(file.stat().st_size for file in kept.iterdir()) <= 150_000
