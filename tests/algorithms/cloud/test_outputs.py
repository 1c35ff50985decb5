"""Outputs appear complete or not at all, and never in the place of an input."""

import errno
import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import files as files_module
from lidar_buildings.algorithms.cloud import outputs
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.copc_sidecar import copc_path
from lidar_buildings.algorithms.cloud.files import check_write, read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.outputs import all_or_nothing, replacing
from lidar_buildings.algorithms.cloud.points import write_points
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.monitors import Listening

KINDS = [".las", ".laz", ".copc.laz"]


@pytest.fixture
def cloud(rng):
    return create_cloud({"xyz": rng.uniform(0, 100, (3000, 3))})


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    return folder


@pytest.mark.parametrize("kind", KINDS)
def test_cancel_leaves_what_was_there(cloud, folder, kind):
    target = folder / f"a{kind}"
    target.write_bytes(b"old")
    with pytest.raises(Cancelled):
        write_cloud(cloud, target, Listening(stop_at=0.5))
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
    class Failing(outputs.KeptFailure):
        def write(self, data):
            self.failure = error
            raise error

    monkeypatch.setattr(outputs, "KeptFailure", Failing)
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
@pytest.mark.parametrize("again", [False, True])
def test_the_view_of_what_is_replaced_goes_with_it(cloud, folder, name, again):
    write_cloud(cloud, folder / name, copc_beside=True)
    cloud.set("classification", np.full(len(cloud), 6, np.uint8))
    write_cloud(cloud, folder / name, copc_beside=again)
    left = sorted(path.name for path in folder.iterdir())
    assert left == (["a.copc.laz", name] if again else [name])
    for path in folder.iterdir():
        assert (read_cloud(path).get("classification") == 6).all()


def test_statistics_that_qgis_adds_leave_a_view_a_view(cloud, folder):
    write_cloud(cloud, folder / "a.laz", copc_beside=True)
    with (folder / "a.copc.laz").open("ab") as file:
        file.write(b"statistics")
    write_cloud(cloud, folder / "a.laz")
    assert not (folder / "a.copc.laz").exists()


def _own(cloud, folder):
    """A result that was written under that name for its own sake."""
    write_cloud(cloud, folder / "a.copc.laz")


def _view_of_another(cloud, folder):
    write_cloud(cloud, folder / "a.laz", copc_beside=True)
    cloud.set("classification", np.full(len(cloud), 6, np.uint8))
    write_cloud(cloud, folder / "b.laz")
    (folder / "b.laz").replace(folder / "a.laz")


def _only_copy(cloud, folder):
    write_cloud(cloud, folder / "a.laz", copc_beside=True)
    (folder / "a.laz").unlink()


def _edited_view(cloud, folder):
    write_cloud(cloud, folder / "a.laz", copc_beside=True)
    raw = bytearray((folder / "a.copc.laz").read_bytes())
    raw[len(raw) // 2] ^= 0xFF
    (folder / "a.copc.laz").write_bytes(raw)


def _damaged(cloud, folder):
    (folder / "a.copc.laz").write_bytes(b"LASF and no more")


@pytest.mark.parametrize("found", [_own, _view_of_another, _only_copy, _edited_view, _damaged])
@pytest.mark.parametrize("copc_beside", [False, True])
def test_any_other_copc_beside_is_kept_and_the_output_refused(cloud, folder, found, copc_beside):
    found(cloud, folder)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    for attempt in (check_write, write_cloud):
        with pytest.raises(ValueError, match=r"a\.copc\.laz lies next to the output a\.laz"):
            attempt(cloud, folder / "a.laz", copc_beside=copc_beside)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_cancelled_view_leaves_the_old_pair(cloud, folder):
    write_cloud(cloud, folder / "a.laz", copc_beside=True)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    with pytest.raises(Cancelled):
        write_cloud(cloud, folder / "a.laz", Listening(stop_at=0.5), copc_beside=True)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize("copc_beside", [False, True])
def test_a_copc_that_is_the_input_is_neither_removed_nor_replaced(cloud, folder, copc_beside):
    write_cloud(cloud, folder / "a.laz", copc_beside=True)
    source = read_cloud(folder / "a.copc.laz")
    with pytest.raises(ValueError, match=r"take the place of the input a\.copc\.laz"):
        write_cloud(source, folder / "a.laz", copc_beside=copc_beside)
    assert len(read_cloud(folder / "a.copc.laz")) == len(cloud)


def test_writing_twice_gives_the_same_bytes(cloud, folder):
    for name in ("a.laz", "b.laz"):
        write_cloud(cloud, folder / name)
    assert (folder / "a.laz").read_bytes() == (folder / "b.laz").read_bytes()
    np.testing.assert_array_equal(read_cloud(folder / "a.laz").points, cloud.points)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_files_of_a_run_take_their_places_together(folder):
    old, new = folder / "old.txt", folder / "new.txt"
    old.write_text("older")
    with all_or_nothing() as files:
        for target in (old, new):
            files.beside(target).write_text("newer")
        assert old.read_text() == "older"
        assert not new.exists()
    assert [old.read_text(), new.read_text()] == ["newer", "newer"]
    assert names(folder) == ["new.txt", "old.txt"]


def test_a_run_that_fails_removes_nothing_that_another_one_wrote(folder):
    """A second run of the same outputs ended well while the first was busy; the first was cancelled then."""
    target = folder / "a.txt"

    def cancelled():
        with all_or_nothing() as files:
            files.beside(target).write_text("mine")
            target.write_text("of the other run")
            raise Cancelled

    pytest.raises(Cancelled, cancelled)
    assert target.read_text() == "of the other run"
    assert names(folder) == ["a.txt"]


def test_if_one_file_can_not_be_put_in_place_the_others_are_as_before(folder):
    first, second, third = (folder / name for name in ("a.txt", "b.txt", "c.txt"))
    first.write_text("older")

    def blocked():
        with all_or_nothing() as files:
            for target in (first, second, third):
                files.beside(target).write_text("newer")
            (third / "of the user").mkdir(parents=True)

    with pytest.raises(ValueError, match="c.txt can't be written \\(a folder is in its place\\)"):
        blocked()
    assert first.read_text() == "older"
    assert names(folder) == ["a.txt", "c.txt"]
    assert names(third) == ["of the user"]


def test_what_belongs_to_an_older_file_goes_with_it(folder):
    target, journal = folder / "a.db", folder / "a.db-wal"
    journal.write_text("of the older file")

    def cancelled():
        with all_or_nothing() as files:
            files.beside(target, [journal]).write_text("newer")
            raise Cancelled

    pytest.raises(Cancelled, cancelled)
    assert names(folder) == ["a.db-wal"]
    with all_or_nothing() as files:
        files.beside(target, [journal]).write_text("newer")
    assert names(folder) == ["a.db"]


def test_permissions_of_what_is_replaced_are_kept(folder):
    (folder / "a.laz").write_text("older")
    (folder / "a.laz").chmod(0o664)
    with replacing(folder / "a.laz") as stream:
        stream.write(b"newer")
    assert (folder / "a.laz").stat().st_mode & 0o777 == 0o664


@pytest.mark.parametrize("leads_to", ["diary.txt", "nothing", "link.laz"])
def test_a_link_is_replaced_and_what_it_leads_to_stays(folder, tmp_path, leads_to):
    """A link of the name of a tile led to somebody's text, which became a point cloud."""
    diary = tmp_path / "diary.txt"
    diary.write_text("mine")
    (folder / "link.laz").symlink_to(folder / leads_to if leads_to == "link.laz" else tmp_path / leads_to)
    with replacing(folder / "link.laz") as stream:
        stream.write(b"newer")
    assert not (folder / "link.laz").is_symlink()
    assert (folder / "link.laz").read_bytes() == b"newer"
    assert diary.read_text() == "mine"
    assert names(folder) == ["link.laz"]
    assert names(tmp_path) == ["diary.txt", "out"]


def test_a_link_is_there_again_where_its_run_fails(folder, tmp_path):
    (tmp_path / "diary.txt").write_text("mine")
    (folder / "a.txt").symlink_to(tmp_path / "diary.txt")

    def blocked():
        with all_or_nothing() as files:
            for name in ("a.txt", "b.txt"):
                files.beside(folder / name).write_text("newer")
            (folder / "b.txt").mkdir()

    with pytest.raises(ValueError, match="a folder is in its place"):
        blocked()
    assert (folder / "a.txt").is_symlink()
    assert (tmp_path / "diary.txt").read_text() == "mine"


def test_an_older_file_may_vanish_while_it_is_replaced(folder, monkeypatch):
    """Processes that share a folder of what was read from the web remove the oldest while others write the same."""
    target = folder / "a.bin"
    target.write_bytes(b"old")
    link = os.link

    def vanishes(path, *rest):
        Path(path).unlink()
        link(path, *rest)

    monkeypatch.setattr(os, "link", vanishes)
    with replacing(target) as stream:
        stream.write(b"new")
    assert [path.name for path in folder.iterdir()] == ["a.bin"]
    assert target.read_bytes() == b"new"


def test_a_link_to_the_folder_is_followed(folder, tmp_path):
    (tmp_path / "here").symlink_to(folder)
    with replacing(tmp_path / "here" / "a.laz") as stream:
        stream.write(b"newer")
    assert names(folder) == ["a.laz"]
    assert (tmp_path / "here").is_symlink()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
def test_a_pipe_is_refused(folder):
    # A pipe stands for all that is no ordinary file, such as a device: a test can make one.
    pipe = folder / "pipe"
    os.mkfifo(pipe)
    (folder / "a.txt").symlink_to(pipe)
    for target in (pipe, folder / "a.txt"):
        with pytest.raises(ValueError, match="no ordinary file"), replacing(target):
            pass
    assert names(folder) == ["a.txt", "pipe"]
    assert pipe.is_fifo()


def test_a_name_may_be_as_long_as_the_file_system_allows(cloud, folder):
    target = folder / ("a" * 246 + ".copc.laz")
    assert len(target.name) == 255
    write_cloud(cloud, target)
    assert names(folder) == [target.name]


KILLED = """
import sys, os, conftest
from pathlib import Path
from lidar_buildings.algorithms.cloud.outputs import all_or_nothing
with all_or_nothing() as files:
    files.beside(Path(sys.argv[1])).write_text("half of a large file")
    os._exit(9)
"""


def test_what_a_killed_run_left_is_swept_and_what_a_running_one_writes_is_not(folder):
    root = Path(__file__).parents[3]
    done = subprocess.run([sys.executable, "-c", KILLED, str(folder / "a.txt")], cwd=root, check=False)
    assert done.returncode == 9
    (left,) = folder.iterdir()
    with all_or_nothing() as running:
        beside = running.beside(folder / "a.txt")
        beside.write_text("of a run that goes on")
        for path in (left, beside.parent):
            os.utime(path, (time.time() - 60,) * 2)
        with replacing(folder / "a.txt") as stream:
            stream.write(b"newer")
        assert names(folder) == sorted(["a.txt", beside.parent.name])
    assert (folder / "a.txt").read_text() == "of a run that goes on"
    assert names(folder) == ["a.txt"]


def test_a_folder_of_someone_else_is_not_swept(folder):
    theirs, empty = folder / ".lb-theirs.part", folder / ".lb-empty.part"
    for path in (theirs, empty):
        path.mkdir()
    (theirs / "notes.txt").write_text("not ours")
    os.utime(empty, (time.time() - 60,) * 2)
    os.utime(theirs, (time.time() - 60,) * 2)
    with replacing(folder / "a.txt") as stream:
        stream.write(b"newer")
    assert names(folder) == [theirs.name, "a.txt"]


def test_what_another_computer_writes_is_not_swept(folder, monkeypatch):
    """Locks of some network disks hold on one computer only: it looked abandoned to all others."""
    with monkeypatch.context() as there:
        there.setattr(outputs.platform, "node", lambda: "elsewhere")
        files = outputs.ResultFiles()
        theirs = files.beside(folder / "b.txt")
    theirs.write_text("half of a large file")
    (left,) = folder.iterdir()
    os.utime(left, (time.time() - 60,) * 2)
    monkeypatch.setattr(outputs.fcntl, "flock", lambda *_: None)
    for computer, names_left in (("here", [left.name, "a.txt"]), ("elsewhere", ["a.txt"])):
        monkeypatch.setattr(outputs.platform, "node", lambda computer=computer: computer)
        with replacing(folder / "a.txt") as stream:
            stream.write(b"newer")
        assert names(folder) == names_left
    files.discard()


@pytest.mark.skipif(outputs.fcntl is None, reason="flock is for all but Windows")
@pytest.mark.parametrize(("error", "is_free"), [("EWOULDBLOCK", False), ("EOPNOTSUPP", True), ("ENOLCK", True)])
def test_a_disk_without_locks_is_no_other_run(folder, monkeypatch, error, is_free):
    """Every survey on it was refused: another run was said to write there."""
    number, said = getattr(errno, error), []

    def flock(*_):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(outputs.fcntl, "flock", flock)
    with outputs.locked_folder(folder, said.append) as found:
        assert found == is_free
    assert len(said) == is_free
    assert all("has no locks" in sentence for sentence in said)
    with replacing(folder / "a.txt") as stream:
        stream.write(b"newer")
    assert (folder / "a.txt").read_bytes() == b"newer"


def test_a_file_that_holds_other_points_than_were_to_be_written_is_refused(cloud, folder, monkeypatch):
    def losing(stream, header, chunks, *rest):
        write_points(stream, replace(header, count=header.count - 1), chunks, *rest)

    monkeypatch.setattr(files_module, "write_points", losing)
    for name in ("a.las", "a.laz"):
        with pytest.raises(ValueError, match=f"{name} would have 2,999 instead of 3,000 points"):
            write_cloud(cloud, folder / name)
    assert names(folder) == []


def test_a_folder_is_locked_where_there_is_no_flock(folder, monkeypatch):
    # As Windows has it: a range of bytes of a file, which one program alone may hold.
    held = set()

    class Msvcrt:
        LK_NBLCK = 2

        @staticmethod
        def locking(descriptor, mode, length):
            assert (mode, length, os.lseek(descriptor, 0, os.SEEK_CUR)) == (2, 1, 0)
            place = os.fstat(descriptor).st_ino
            if place in held:
                raise PermissionError(errno.EACCES, "Permission denied")
            held.add(place)

    monkeypatch.setattr(outputs, "fcntl", None)
    monkeypatch.setattr(outputs, "msvcrt", Msvcrt)
    with outputs.locked_folder(folder) as is_ours, outputs.locked_folder(folder) as is_ours_again:
        assert (is_ours, is_ours_again) == (True, False)
