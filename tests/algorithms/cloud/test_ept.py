"""Entwine point tiles, on this computer and on the web: the points that were written, from few files, or a sentence."""

import json
import sys
from types import SimpleNamespace

import numpy as np
import pytest
import zstandard

from lidar_buildings.algorithms.cloud import ept, web_cache, web_file
from lidar_buildings.algorithms.cloud.cloud import Cloud
from lidar_buildings.algorithms.cloud.files import (
    check_readable,
    count_points,
    read_cloud,
    read_extent,
    sizes_within,
    write_cloud,
)
from lidar_buildings.algorithms.cloud.web_file import WebFile
from lidar_buildings.algorithms.tiling.survey import open_survey
from lidar_buildings.tests.ept_files import SCALE, made_points, write_ept
from lidar_buildings.tests.web_server import serving

CORNER, SIDE, COUNT = np.array([600_000.0, 5_000_000.0]), 1000.0, 60_000
VIEW = np.array([[100.0, 100.0], [200.0, 200.0]]) + CORNER
POINTS = made_points(COUNT, CORNER, SIDE)
KINDS = ["laszip", "binary", "zstandard"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ept")
    for kind in KINDS:
        write_ept(folder / kind, POINTS, CORNER, SIDE, kind)
    return folder


@pytest.fixture
def made(tmp_path):
    """Return a function that writes tiles of fewer points, which a test may damage."""
    return lambda kind, **others: write_ept(tmp_path / "made", POINTS[:2000], CORNER, SIDE, kind, **others)


@pytest.fixture
def server(folder, monkeypatch):
    monkeypatch.setattr(web_file, "_WAITS", (0.01, 0.02, 0.03))
    with serving(folder) as server:
        yield server
    web_file._known.clear()


def inside(points, box):
    plan = np.column_stack([points["X"], points["Y"]]) * SCALE + CORNER
    return ((plan >= box[0]) & (plan <= box[1])).all(axis=1)


def check(cloud: Cloud, expected):
    order = np.argsort(cloud.get("gps_time"))
    np.testing.assert_array_equal(cloud.get("gps_time")[order], expected["GpsTime"])
    xyz = cloud.to_map(cloud.get("xyz"))[order]
    for i, axis in enumerate("XYZ"):
        np.testing.assert_allclose(xyz[:, i], expected[axis] * SCALE + (*CORNER, 0)[i], atol=1e-6)
    np.testing.assert_array_equal(cloud.get("classification")[order], expected["Classification"])
    np.testing.assert_array_equal(cloud.get("intensity")[order], expected["Intensity"])
    np.testing.assert_array_equal(cloud.named("Beam")[order], expected["Beam"])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("where", ["disk", "web"])
@pytest.mark.parametrize("box", [None, VIEW])
def test_the_points_are_those_that_were_written(server, folder, kind, where, box):
    name = f"{kind}/ept.json"
    source = folder / name if where == "disk" else server.address(name)
    check_readable(source, box=box)
    cloud = read_cloud(source, box=box)
    check(cloud, POINTS if box is None else POINTS[inside(POINTS, box)])
    assert cloud.crs.code == "EPSG:32631"


@pytest.mark.parametrize("kind", KINDS)
def test_an_extent_of_an_address_is_that_of_the_folder_byte_for_byte(server, folder, tmp_path, kind):
    for number, source in enumerate((server.address(f"{kind}/ept.json"), folder / kind / "ept.json")):
        write_cloud(read_cloud(source, box=VIEW), tmp_path / f"{number}.laz")
    assert (tmp_path / "0.laz").read_bytes() == (tmp_path / "1.laz").read_bytes()


@pytest.mark.parametrize("kind", KINDS)
def test_a_view_costs_its_nodes_and_pages(server, folder, kind):
    read_cloud(server.address(f"{kind}/ept.json"), box=VIEW)
    asked = [path for path, *_ in server.requests]
    assert len(asked) == len(set(asked))
    pages = [path for path in asked if "hierarchy" in path]
    nodes = [path for path in asked if "ept-data" in path]
    # The root, one node of each of the next two levels, and four of the last one.
    assert len(pages) == 2
    assert len(nodes) == 7
    needed = sum((folder / path).stat().st_size for path in asked)
    assert server.sent <= 1.05 * needed
    (_, (points, size)), *_ = sizes_within(server.address(f"{kind}/ept.json"), VIEW)
    assert inside(POINTS, VIEW).sum() < points < COUNT / 2
    assert 0.5 < size / sum((folder / path).stat().st_size for path in nodes) < 2


@pytest.mark.parametrize("kind", KINDS)
def test_a_spacing_reads_coarse_nodes_and_the_pages_that_lead_to_them(server, folder, kind):
    # The root shows points at a distance of its side / 128, the nodes below at a half of it.
    for side, nodes, pages in ((1.01, 1, 1), (0.99, 9, 5)):
        server.requests.clear()
        web_file._known.clear()
        ept._hierarchy.cache_clear()
        thin = read_cloud(server.address(f"{kind}/ept.json"), spacing=np.full(3, side * SIDE / 128))
        asked = [path for path, *_ in server.requests]
        assert sum("hierarchy" in path for path in asked) <= pages
        assert 1 <= sum("ept-data" in path for path in asked) <= nodes
        local = read_cloud(folder / kind / "ept.json", spacing=np.full(3, side * SIDE / 128))
        np.testing.assert_array_equal(thin.points, local.points)


def test_servers_without_ranges_have_nodes_as_whole_files(server):
    server.whole = True
    check(read_cloud(server.address("laszip/ept.json"), box=VIEW), POINTS[inside(POINTS, VIEW)])


@pytest.mark.parametrize("kind", KINDS)
def test_extent_and_count_are_those_of_the_description(folder, kind):
    low, high, crs = read_extent(folder / kind / "ept.json")
    np.testing.assert_array_equal([low, high], [[*CORNER, 0], [*(CORNER + SIDE), 30]])
    assert crs.identity
    assert count_points(folder / kind / "ept.json") == COUNT


@pytest.mark.parametrize("kind", KINDS)
def test_windows_of_a_survey_have_each_point_once(server, kind):
    extent = np.array([[100.0, 100.0], [600.0, 400.0]]) + CORNER
    survey = open_survey([server.address(f"{kind}/ept.json")], extent=extent)
    halves = [np.array([[100.0, 100.0], [350.0, 401.0]]), np.array([[350.0, 100.0], [601.0, 401.0]])]
    windows = [survey.window(half + CORNER * survey.crs.horizontal) for half in halves]
    positions = np.concatenate([window.position for window in windows])
    assert len(np.unique(positions)) == len(positions) == inside(POINTS, extent).sum()


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"dataType": "brotli"}, "the type brotli; only the types laszip, binary and zstandard can"),
        ({"points": 2001}, "it promises 2001 points, but its nodes hold 2000"),
        ({"points": -1}, "it is no description"),
        ({"points": 10**30}, "it is no description"),
        ({"bounds": [0, 0, 0, 1, 1]}, "it is no description"),
        ({"bounds": [0, 0, 0, 0, 1, 1]}, "it is no description"),
        ({"schema": [{"name": "X", "type": "signed", "size": 4}] * 2}, "it is no description"),
        ({"schema": [{"name": "X", "type": "signed", "size": 3}]}, "it is no description"),
        ({"schema": [{"name": "X", "type": "signed", "size": 4}]}, "its schema has no X, Y and Z"),
        ({"schema": {"name": "X"}}, "it is no description"),
    ],
)
def test_odd_descriptions_are_refused(made, changes, sentence):
    with pytest.raises(ValueError, match=sentence):
        read_cloud(made("binary", **changes))


@pytest.mark.parametrize(
    "srs",
    [None, [], {}, {"wkt": 1}, {"horizontal": "9" * 400}, {"wkt": "http://x/a"}, {"wkt": 'PROJCS["\ud800"]'}],
)
def test_odd_systems_are_none(made, srs):
    assert read_cloud(made("binary", srs=srs)).crs.identity == ""


@pytest.mark.parametrize(
    "page", ["", "[]", '{"0-0-0-0": 2147483648}', '{"0-0-0-0": true}', '{"a": 1}', '{"0-0-0-0": 1.5}', '{"0-0-0": 1}']
)
def test_odd_pages_are_refused(made, page):
    path = made("binary")
    (path.parent / "ept-hierarchy" / "0-0-0-0.json").write_text(page)
    with pytest.raises(ValueError, match=r"0-0-0-0\.json is .*no page of the hierarchy|empty|truncated"):
        read_cloud(path)


@pytest.mark.parametrize("key", ["1-2-0-0", "43-0-0-0", "0-1-0-0"])
def test_nodes_outside_of_the_octree_are_refused(made, key):
    path = made("binary")
    page = path.parent / "ept-hierarchy" / "0-0-0-0.json"
    page.write_text(json.dumps({**json.loads(page.read_text()), key: 5}))
    with pytest.raises(ValueError, match="it names a node"):
        read_cloud(path)


@pytest.mark.parametrize("count", [5 * 10**8, 1])
@pytest.mark.parametrize("kind", KINDS)
def test_a_number_of_points_that_is_not_that_of_the_node_is_refused(made, kind, count):
    path = made(kind)
    page = path.parent / "ept-hierarchy" / "0-0-0-0.json"
    page.write_text(json.dumps({**json.loads(page.read_text()), "0-0-0-0": count}))
    with pytest.raises(ValueError, match=r"0-0-0-0\.(laz|bin|zst) is truncated or damaged: it"):
        read_cloud(path, box=VIEW)


def test_more_points_than_any_node_has_are_refused_before_it_is_read(made):
    path = made("zstandard")
    page = path.parent / "ept-hierarchy" / "0-0-0-0.json"
    page.write_text(json.dumps({**json.loads(page.read_text()), "0-0-0-0": 10**9}))
    with pytest.raises(ValueError, match="no page of the hierarchy"):
        read_cloud(path)


@pytest.mark.parametrize("kind", KINDS)
def test_a_node_that_is_missing_or_cut_off_is_named(server, folder, made, kind):
    path = made(kind)
    (node, *_) = path.parent.glob("ept-data/1-*")
    node.write_bytes(node.read_bytes()[:-20])
    with pytest.raises(ValueError, match=f"{node.stem}.* is truncated or damaged"):
        read_cloud(path)
    node.unlink()
    with pytest.raises(ValueError, match="can't be read"):
        read_cloud(path)
    with (
        serving(path.parent) as other,
        pytest.raises(ValueError, match=rf"There is no file at http.*/{node.name} \(404\)"),
    ):
        read_cloud(other.address("ept.json"))


def test_a_node_that_unpacks_to_more_than_its_points_is_refused_unread(made):
    path = made("zstandard")
    node = path.parent / "ept-data" / "0-0-0-0.zst"
    node.write_bytes(zstandard.compress(bytes(2**28)))
    with pytest.raises(ValueError, match=r"0-0-0-0\.zst is .* points should take (\d+) bytes, and it has more"):
        read_cloud(path)
    node.write_bytes(b"no zstandard")
    with pytest.raises(ValueError, match="its points can't be unpacked"):
        read_cloud(path)


def test_without_a_package_for_zstandard_its_name_is_said(made, monkeypatch):
    monkeypatch.setitem(sys.modules, "zstandard", None)
    monkeypatch.setitem(sys.modules, "compression", None)
    with pytest.raises(ValueError, match="the Python package zstandard is missing; install it"):
        read_extent(made("zstandard"))
    module = SimpleNamespace(open=zstandard.open, ZstdError=zstandard.ZstdError)
    monkeypatch.setitem(sys.modules, "compression.zstd", module)
    monkeypatch.setitem(sys.modules, "compression", SimpleNamespace(zstd=module, __path__=[], __spec__=object()))
    assert len(read_cloud(made("zstandard"))) == 2000


def test_nodes_and_pages_are_kept_while_the_description_does_not_change(server, tmp_path, monkeypatch):
    monkeypatch.setattr(web_cache, "_folder", [str(tmp_path / "kept")])
    asked = []
    for server.version in ("1", "1", "2", "2"):
        web_file._known.clear()
        ept._hierarchy.cache_clear()
        server.requests.clear()
        check(read_cloud(server.address("binary/ept.json"), box=VIEW), POINTS[inside(POINTS, VIEW)])
        asked.append({path for path, *_ in server.requests})
    assert len(asked[0]) == 10
    assert asked[0] == asked[2]
    assert asked[1] == asked[3] == {"binary/ept.json"}


def test_a_hierarchy_that_leads_to_itself_or_has_no_end_is_refused(made, monkeypatch):
    path = made("binary")
    page = path.parent / "ept-hierarchy" / "0-0-0-0.json"
    page.write_text(json.dumps({**json.loads(page.read_text()), "0-0-0-0": -1}))
    with pytest.raises(ValueError, match="it promises 2000 points, but its nodes hold"):
        read_cloud(path)
    monkeypatch.setattr(ept, "_MOST_NODES", 10)
    ept._hierarchy.cache_clear()
    with pytest.raises(ValueError, match="its hierarchy has more than 10 nodes"):
        read_cloud(path)


@pytest.mark.parametrize(("trouble", "value"), [("cut", 3), ("fail", 3)])
def test_requests_are_repeated(server, trouble, value):
    setattr(server, trouble, value)
    check(read_cloud(server.address("binary/ept.json"), box=VIEW), POINTS[inside(POINTS, VIEW)])


def test_redirections_and_lies_of_servers(server, folder):
    assert isinstance(WebFile(server.address("binary/ept.json")).beside("ept-data/a.bin"), WebFile)
    server.redirect = "file:///etc/passwd"
    with pytest.raises(ValueError, match="which is not followed"):
        read_cloud(server.address("binary/ept.json"))
    server.redirect, server.total = "", 10**12
    web_file._known.clear()
    with pytest.raises(ValueError, match="bytes from .* instead of|can't be read"):
        read_cloud(server.address("binary/ept.json"))
