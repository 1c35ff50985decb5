"""COPC: an octree that readers accept, with every point in it once."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import copc
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.las_files import FORMATS, evlr, vlr
from lidar_buildings.tests.monitors import Listening


@pytest.fixture
def small_leaves(monkeypatch):
    monkeypatch.setattr(copc, "POINTS_PER_CHUNK", 2000)
    monkeypatch.setattr(copc, "_GRID_LEVELS", 4)
    monkeypatch.setattr(copc, "_DEEPEST", copc._BITS - 4)
    monkeypatch.setattr(copc, "AT_ONCE", 7000)


@pytest.fixture
def tree(rng, tmp_path, small_leaves, laspy):
    """A surface with a dense corner, numbered; its COPC file, and what laspy says of it."""
    n = 40_000
    plane = np.concatenate((rng.uniform(0, 100, (n // 2, 2)), rng.uniform(0, 10, (n // 2, 2)))) + [85_000, 447_000]
    xyz = np.column_stack((plane, np.sin(plane[:, 0] / 9) * 5))
    cloud = create_cloud({"xyz": xyz, "cluster_id": np.arange(n), "gps_time": np.linspace(5, 9, n)})
    path = tmp_path / "a.copc.laz"
    write_cloud(cloud, path)
    with laspy.CopcReader.open(path) as reader:
        return path, reader.copc_info, reader.root_page.entries, laspy.read(path), reader.query()


def test_every_point_is_there_once_and_as_it_was(tree, rng):
    path, _, entries, las, queried = tree
    assert sum(entry.point_count for entry in entries.values()) == 40_000
    for points in (las, queried):
        np.testing.assert_array_equal(np.sort(points["ClusterID"]), np.arange(40_000))
    cloud = read_cloud(path)
    order = np.argsort(cloud.get("cluster_id"))
    np.testing.assert_allclose(cloud.get("gps_time")[order], np.linspace(5, 9, 40_000))


def test_points_lie_in_their_nodes_and_nodes_have_parents(tree):
    _, info, entries, las, _ = tree
    start = 0
    levels = {(key.level, key.x, key.y, key.z) for key in entries}
    for key, entry in sorted(entries.items(), key=lambda item: item[1].offset):
        points = las.xyz[start : start + entry.point_count]
        start += entry.point_count
        side = 2 * info.halfsize / 2**key.level
        low = info.center - info.halfsize + np.array([key.x, key.y, key.z]) * side
        assert (points >= low - 1e-6).all()
        assert (points <= low + side + 1e-6).all()
        assert key.level == 0 or (key.level - 1, key.x >> 1, key.y >> 1, key.z >> 1) in levels
    assert max(level for level, *_ in levels) > 2


def test_upper_nodes_show_one_point_per_cell(tree):
    _, info, entries, las, _ = tree
    root = next(entry for key, entry in entries.items() if key.level == 0)
    cells = np.floor((las.xyz[: root.point_count] - (info.center - info.halfsize)) / info.spacing)
    assert len(np.unique(cells, axis=0)) == root.point_count
    assert info.spacing == pytest.approx(2 * info.halfsize / 16)
    # The dense corner has more than half of the points on 1/64 of the area; an overview by area shows few of them.
    corner = (las.xyz[: root.point_count, :2] < [85_012.5, 447_012.5]).all(axis=1).mean()
    assert corner < 0.05


def test_info_shows_times_and_position(tree):
    path, info, _, las, _ = tree
    assert (info.gps_min, info.gps_max) == (5, 9)
    assert path.read_bytes()[375 + 2 : 375 + 6] == b"copc"
    np.testing.assert_allclose(las.header.mins, las.xyz.min(axis=0))


def test_the_same_cloud_gives_the_same_bytes(rng, tmp_path, small_leaves):
    cloud = create_cloud({"xyz": rng.uniform(0, 50, (9000, 3))})
    for name in ("a.copc.laz", "b.copc.laz"):
        write_cloud(cloud, tmp_path / name)
    assert (tmp_path / "a.copc.laz").read_bytes() == (tmp_path / "b.copc.laz").read_bytes()


@pytest.mark.parametrize("xyz", [np.zeros((1, 3)), np.zeros((5000, 3)), np.array([[0, 0, 0], [1e6, 0, 0]])])
def test_degenerate_clouds(xyz, tmp_path, small_leaves, laspy):
    write_cloud(create_cloud({"xyz": xyz}), tmp_path / "a.copc.laz")
    with laspy.CopcReader.open(tmp_path / "a.copc.laz") as reader:
        np.testing.assert_allclose(np.sort(reader.query().x), np.sort(xyz[:, 0]))


@pytest.mark.parametrize("point_format", FORMATS)
def test_old_formats_are_upgraded_and_said(make_las, tmp_path, laspy, point_format):
    path, monitor = make_las(point_format=point_format), Monitor()
    write_cloud(read_cloud(path), tmp_path / "a.copc.laz", monitor)
    expected = {0: 6, 1: 6, 2: 7, 3: 7, 4: 6, 5: 7, 6: 6, 7: 7, 8: 8, 9: 6, 10: 8}[point_format]
    old, new = laspy.read(path), laspy.read(tmp_path / "a.copc.laz")
    assert new.point_format.id == expected
    said = [*monitor.warnings, *monitor.infos]
    assert any("COPC holds point formats 6 to 8" in sentence for sentence in said) == (expected != point_format)
    assert any("waveform" in sentence for sentence in monitor.warnings) == (point_format in (4, 5, 9, 10))
    for name in ("X", "intensity", "classification", "withheld", "user_data", "point_source_id"):
        np.testing.assert_array_equal(np.sort(np.asarray(new[name])), np.sort(np.asarray(old[name])))


def test_copc_becomes_las_again_without_its_records(make_las, take_apart, tmp_path):
    path = make_las(vlrs=(vlr("someone", 3, b"x"),), evlrs=(evlr("someone", 4, b"y" * 99),))
    write_cloud(read_cloud(path), tmp_path / "a.copc.laz")
    write_cloud(read_cloud(tmp_path / "a.copc.laz"), tmp_path / "b.las")
    old, new = take_apart(path), take_apart(tmp_path / "b.las")
    assert (new["vlrs"], new["evlrs"]) == (old["vlrs"], old["evlrs"])
    np.testing.assert_array_equal(np.unique(new["records"], axis=0), np.unique(old["records"], axis=0))


def test_cancel_leaves_nothing(tmp_path, rng, small_leaves):
    with pytest.raises(Cancelled):
        write_cloud(
            create_cloud({"xyz": rng.uniform(0, 50, (20_000, 3))}), tmp_path / "a.copc.laz", Listening(stop_at=0.5)
        )
    assert not list(tmp_path.iterdir())
