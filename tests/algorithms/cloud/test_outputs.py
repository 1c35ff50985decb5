"""Outputs appear complete or not at all, and never in the place of an input."""

import errno
import os

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import outputs
from lidar_buildings.algorithms.cloud.cloud import check_write, create_cloud, read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.views import copc_path
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
        with pytest.raises(ValueError, match=r"a\.copc\.laz lies beside the output a\.laz"):
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
