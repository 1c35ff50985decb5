"""Outputs appear complete or not at all, and never in the place of an input."""

import errno
import os

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import outputs
from lidar_buildings.algorithms.cloud.cloud import check_write, copc_path, create_cloud, read_cloud, write_cloud
from lidar_buildings.algorithms.stage import Cancelled, Monitor

KINDS = [".las", ".laz", ".copc.laz"]


@pytest.fixture
def cloud(rng):
    return create_cloud({"xyz": rng.uniform(0, 100, (3000, 3))})


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    return folder


class Stop(Monitor):
    """Cancels once something has been written."""

    def progress(self, fraction):
        if fraction >= 0.5:
            raise Cancelled


@pytest.mark.parametrize("kind", KINDS)
def test_cancel_leaves_what_was_there(cloud, folder, kind):
    target = folder / f"a{kind}"
    target.write_bytes(b"old")
    with pytest.raises(Cancelled):
        write_cloud(cloud, target, Stop())
    assert [path.name for path in folder.iterdir()] == [target.name]
    assert target.read_bytes() == b"old"


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("error", "message"),
    [
        (OSError(errno.ENOSPC, "No space left on device"), "The disk is full"),
        (PermissionError(errno.EACCES, "Permission denied"), "read-only or the file is in use"),
        (OSError(errno.EIO, "Input/output error"), r"can't be written \(Input/output error\)"),
    ],
)
def test_failed_writing_is_one_sentence_and_leaves_nothing(cloud, folder, monkeypatch, kind, error, message):
    class Failing(outputs._File):
        def write(self, data):
            self.failure = error
            raise error

    monkeypatch.setattr(outputs, "_File", Failing)
    with pytest.raises(ValueError, match=message):
        write_cloud(cloud, folder / f"a{kind}")
    monkeypatch.undo()
    assert not list(folder.iterdir())


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="root writes everywhere")
def test_read_only_folder(cloud, folder):
    folder.chmod(0o500)
    with pytest.raises(ValueError, match="its folder is read-only"):
        write_cloud(cloud, folder / "a.las")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("a.txt", "give it the extension .las, .laz or .copc.laz"),
        ("a", "give it the extension"),
        ("a.vpc", "give it the extension"),
        ("none/a.las", "does not exist; make it"),
    ],
)
def test_where_nothing_can_be_written(cloud, folder, name, message):
    with pytest.raises(ValueError, match=message):
        write_cloud(cloud, folder / name)
    with pytest.raises(ValueError, match=message):
        check_write(cloud, folder / name)
    assert not list(folder.iterdir())


def test_a_folder_with_the_name_of_the_output(cloud, folder):
    (folder / "a.las").mkdir()
    with pytest.raises(ValueError, match="is a folder"):
        write_cloud(cloud, folder / "a.las")


@pytest.mark.parametrize("spelling", ["a.laz", "../out/a.laz", "link.laz"])
def test_output_may_not_be_the_input(cloud, folder, spelling):
    write_cloud(cloud, folder / "a.laz")
    before = (folder / "a.laz").read_bytes()
    (folder / "link.laz").symlink_to(folder / "a.laz")
    with pytest.raises(ValueError, match="is also an input"):
        write_cloud(read_cloud(folder / "a.laz"), folder / spelling)
    assert (folder / "a.laz").read_bytes() == before


def test_permissions_are_those_of_any_new_file(cloud, folder):
    write_cloud(cloud, folder / "a.las")
    (folder / "plain").write_bytes(b"")
    assert (folder / "a.las").stat().st_mode == (folder / "plain").stat().st_mode


def test_copc_beside(cloud, folder):
    write_cloud(cloud, folder / "a.laz", copc_beside=True)
    assert sorted(path.name for path in folder.iterdir()) == ["a.copc.laz", "a.laz"]
    assert len(read_cloud(folder / "a.copc.laz")) == len(cloud)
    assert copc_path(folder / "a.las") == folder / "a.copc.laz"


@pytest.mark.parametrize("name", ["a.las", "a.laz"])
def test_own_stale_copc_beside_is_removed(cloud, folder, name):
    write_cloud(cloud, folder / "a.copc.laz")
    monitor = Monitor()
    write_cloud(cloud, folder / name, monitor)
    assert [path.name for path in folder.iterdir()] == [name]
    assert monitor.warnings == []


def test_copc_of_someone_else_is_left_and_told(cloud, folder):
    write_cloud(cloud, folder / "a.copc.laz")
    raw = bytearray((folder / "a.copc.laz").read_bytes())
    raw[58:90] = b"someone else".ljust(32, b"\0")
    (folder / "a.copc.laz").write_bytes(raw)
    monitor = Monitor()
    write_cloud(cloud, folder / "a.laz", monitor)
    assert (folder / "a.copc.laz").read_bytes() == raw
    assert any("a.copc.laz lies beside" in sentence for sentence in monitor.warnings)


def test_copc_that_is_the_input_is_neither_removed_nor_replaced(cloud, folder):
    write_cloud(cloud, folder / "a.copc.laz")
    source = read_cloud(folder / "a.copc.laz")
    with pytest.raises(ValueError, match="is also an input"):
        write_cloud(source, folder / "a.laz", copc_beside=True)
    monitor = Monitor()
    write_cloud(source, folder / "a.laz", monitor)
    assert (folder / "a.copc.laz").is_file()
    assert len(monitor.warnings) == 1


def test_a_damaged_copc_beside_is_left(cloud, folder):
    (folder / "a.copc.laz").write_bytes(b"LASF and no more")
    monitor = Monitor()
    write_cloud(cloud, folder / "a.laz", monitor)
    assert (folder / "a.copc.laz").read_bytes() == b"LASF and no more"
    assert len(monitor.warnings) == 1


def test_writing_twice_gives_the_same_bytes(cloud, folder):
    for name in ("a.laz", "b.laz"):
        write_cloud(cloud, folder / name)
    assert (folder / "a.laz").read_bytes() == (folder / "b.laz").read_bytes()
    np.testing.assert_array_equal(read_cloud(folder / "a.laz").points, cloud.points)
