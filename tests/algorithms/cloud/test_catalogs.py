"""Virtual point clouds and STAC items whose tiles are on the web: what is opened, and where names may lead."""

import json

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import vpc, web_addresses, web_file
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import NOWHERE, count_points, read_cloud, read_extent, write_cloud
from lidar_buildings.algorithms.cloud.points import open_header, size_within
from lidar_buildings.algorithms.cloud.vpc import tiles_of, write_vpc
from lidar_buildings.algorithms.cloud.web_addresses import allow_hosts
from lidar_buildings.algorithms.cloud.web_file import WebFile
from lidar_buildings.algorithms.tiling.survey import open_survey
from lidar_buildings.tests.web_server import serving

SIDE = 500.0
CORNER = np.array([600_000.0, 5_000_000.0])
# Within the first tile, and across the edge between it and the next.
VIEW = np.array([[100.0, 100.0], [160.0, 160.0]]) + CORNER
ACROSS = np.array([[480.0, 100.0], [520.0, 140.0]]) + CORNER


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Three tiles of 100,000 points side by side, and a virtual point cloud over them."""
    rng = np.random.default_rng(1)
    folder = tmp_path_factory.mktemp("tiles")
    for number in range(3):
        corner = CORNER + [number * SIDE, 0]
        xyz = np.column_stack([rng.uniform(0, SIDE, (100_000, 2)) + corner, rng.uniform(0, 30, 100_000)])
        write_cloud(create_cloud({"xyz": xyz}, "EPSG:32631"), folder / f"{number}.copc.laz")
    write_vpc([folder / f"{number}.copc.laz" for number in range(3)], folder / "all.vpc")
    return folder


@pytest.fixture
def server(folder, monkeypatch):
    monkeypatch.setattr(web_file, "_WAITS", (0.01, 0.02, 0.03))
    with serving(folder) as server:
        yield server
    web_file._known.clear()
    allow_hosts(())


def item(href, **others):
    """Return a STAC item with a point cloud among other assets."""
    assets = {"picture": {"href": "a.png", "roles": ["thumbnail"]}, "about": {"href": "a.xml", "roles": ["data"]}}
    return {"type": "Feature", "properties": {}, "assets": {**assets, "points": {"href": href}}, **others}


def collection(*items, **others):
    return {"type": "FeatureCollection", "features": list(items), **others}


def written(folder, name, content):
    path = folder / name
    path.write_text(json.dumps(content))
    return path


@pytest.mark.parametrize("box", [VIEW, ACROSS, None])
def test_a_vpc_by_address_is_the_local_one(server, folder, tmp_path, box):
    for number, source in enumerate((server.address("all.vpc?key=secret"), folder / "all.vpc")):
        write_cloud(read_cloud(source, box=box), tmp_path / f"{number}.las")
    assert (tmp_path / "0.las").read_bytes() == (tmp_path / "1.las").read_bytes()


def test_only_tiles_that_touch_the_extent_are_opened(server, folder):
    address = server.address("all.vpc")
    _, needed = size_within(folder / "0.copc.laz", open_header(folder / "0.copc.laz"), VIEW)
    assert read_extent(address, box=NOWHERE)[2] == read_extent(folder / "0.copc.laz")[2]
    assert count_points(address, VIEW) == count_points(folder / "all.vpc", VIEW)
    read_cloud(address, box=VIEW)
    assert {path for path, *_ in server.requests} == {"all.vpc", "0.copc.laz"}
    assert server.sent <= 1.3 * (needed + (folder / "all.vpc").stat().st_size)


def test_a_survey_of_an_address_opens_the_tiles_of_its_extent(server):
    survey = open_survey([server.address("all.vpc")], extent=ACROSS)
    assert [source.path.name for source in survey.sources] == ["0.copc.laz", "1.copc.laz"]
    assert "2.copc.laz" not in {path for path, *_ in server.requests}


def test_a_file_makes_no_request_unless_its_host_is_named(server, folder, tmp_path):
    path = written(tmp_path, "a.vpc", collection(item(server.address("0.copc.laz"))))
    with pytest.raises(ValueError, match=r"a\.vpc names the tile http.* is on the web.* \(add 127\.0\.0\.1 to"):
        read_cloud(path)
    allow_hosts(["example.org"])
    with pytest.raises(ValueError, match="allow it in the options"):
        read_cloud(path)
    assert not server.requests
    allow_hosts(["127.0.0.1"])
    assert len(read_cloud(path, box=VIEW)) == len(read_cloud(folder / "0.copc.laz", box=VIEW))


@pytest.mark.parametrize("content", [item, lambda href: collection(item(href))])
@pytest.mark.parametrize("where", ["disk", "web", "web without extension"])
def test_items_of_catalogs_are_point_clouds(server, folder, tmp_path, content, where):
    allow_hosts(["127.0.0.1"])
    if where == "disk":
        source = written(tmp_path, "item.json", content(server.address("0.copc.laz")))
    else:
        name = "item.json" if where == "web" else "item"
        source = server.address(written(folder, name, content("./0.copc.laz")).name)
    cloud = read_cloud(source, box=VIEW)
    np.testing.assert_array_equal(cloud.points, read_cloud(folder / "0.copc.laz", box=VIEW).points)


def test_items_are_read_of_servers_without_ranges_and_points_are_not(server, folder):
    server.whole = True
    assert len(tiles_of(WebFile(server.address("all.vpc")))) == 3
    with pytest.raises(ValueError, match=r"0\.copc\.laz sends whole files only"):
        read_cloud(server.address("all.vpc"), box=VIEW)


@pytest.mark.parametrize(("trouble", "value"), [("cut", 2), ("fail", 2)])
def test_whole_answers_are_asked_for_again_where_they_break_off(server, trouble, value):
    server.whole = True
    setattr(server, trouble, value)
    assert len(tiles_of(WebFile(server.address("all.vpc")))) == 3


@pytest.mark.parametrize(
    ("href", "sentence"),
    [
        ("file:///etc/a.laz", "leads to 'file:///etc/a.laz', which is not followed"),
        ("ftp://127.0.0.1/a.laz", "which is not followed"),
        ("C:\\a.laz", "which is not followed"),
        ("http://me:secret@127.0.0.1/a.laz", "which is not followed"),
        ("/etc/passwd", "which is no LAS, LAZ or COPC file"),
        ("gone.copc.laz", r"There is no file at http://127\.0\.0\.1:\d+/gone\.copc\.laz \(404\)"),
    ],
)
def test_names_on_the_web_lead_to_point_clouds_on_the_web_alone(server, folder, href, sentence):
    written(folder, "odd.vpc", collection(item(href)))
    with pytest.raises(ValueError, match=sentence):
        read_cloud(server.address("odd.vpc"))


def test_a_public_catalog_does_not_lead_into_the_network_of_the_user(monkeypatch):
    hosts = {"catalog.example": "93.184.216.34", "points.example": "8.8.8.8", "router.example": "192.168.1.1"}
    monkeypatch.setattr("socket.getaddrinfo", lambda host, _: [(0, 0, 0, "", (hosts[host], 0))])
    web_addresses._addresses.cache_clear()
    catalog = WebFile("https://catalog.example/a/all.vpc", "login")
    assert catalog.beside("https://points.example/a.laz") == WebFile("https://points.example/a.laz")
    assert catalog.beside("b/a.laz") == WebFile("https://catalog.example/a/b/a.laz", "login")
    assert catalog.beside("http://catalog.example/a.laz") == WebFile("http://catalog.example/a.laz")
    with pytest.raises(ValueError, match="leads to router.example, an address of this computer or its network"):
        catalog.beside("https://router.example/a.laz")


def leads_to(href, rel="next", **others):
    return [{"rel": "self", "href": "x"}, {"rel": rel, "href": href, **others}]


def test_items_in_pages_are_those_of_one_file(server, folder):
    for number in range(3):
        links = leads_to(f"./page?token={number + 1}") if number < 2 else []
        written(folder, f"page{number}", collection(item(f"{number}.copc.laz"), links=links))
    server.by_query = lambda path, query: f"{path}{query.removeprefix('token=')}" if query else path
    # The last page leads to itself and to the first one, which are read once.
    last = collection(item("2.copc.laz"), links=[*leads_to("page?token=2"), *leads_to("page0")])
    written(folder, "page2", last)
    found = read_cloud(server.address("page0"), box=ACROSS)
    np.testing.assert_array_equal(found.points, read_cloud(folder / "all.vpc", box=ACROSS).points)
    assert sum(path.startswith("page") for path, *_ in server.requests) == 3


@pytest.mark.parametrize("rel", ["items", "item"])
def test_a_collection_leads_to_its_items(server, folder, rel):
    made = collection(item("0.copc.laz"), item("1.copc.laz")) if rel == "items" else item("0.copc.laz")
    written(folder, "items.json", made)
    about = {"type": "Collection", "links": leads_to("items.json", rel), "assets": {"a": {"href": "a.png"}}}
    written(folder, "collection.json", about)
    assert len(tiles_of(WebFile(server.address("collection.json")))) == (2 if rel == "items" else 1)


@pytest.mark.parametrize(("allowed", "is_read"), [((), False), (["example.org"], False), (["127.0.0.1"], True)])
def test_a_page_on_disk_leads_to_hosts_that_are_allowed(server, folder, tmp_path, allowed, is_read):
    written(folder, "next.json", collection(item("1.copc.laz")))
    tile = tmp_path / "0.copc.laz"
    tile.write_bytes((folder / "0.copc.laz").read_bytes())
    path = written(tmp_path, "a.json", collection(item(tile.name), links=leads_to(server.address("next.json"))))
    allow_hosts(allowed)
    if is_read:
        assert len(tiles_of(path)) == 2
        return
    with pytest.raises(ValueError, match=r"a\.json is one page of several, and the next one, http.* allow its host"):
        read_cloud(path)
    assert not server.requests


@pytest.mark.parametrize(
    ("link", "sentence"),
    [
        (leads_to("https://93.184.216.34/b.json"), "the next one, https://93.184.216.34/b.json, is not read"),
        (leads_to("file:///etc/passwd"), "leads to 'file:///etc/passwd', which is not followed"),
        (leads_to("b.json", method="POST"), "ask for all at once"),
    ],
)
def test_pages_lead_to_no_other_host(server, folder, link, sentence):
    written(folder, "odd.json", collection(item("0.copc.laz"), links=link))
    with pytest.raises(ValueError, match=sentence):
        read_cloud(server.address("odd.json"))


@pytest.mark.parametrize(("bound", "most"), [("_MOST_PAGES", 3), ("_MOST_ITEMS", 4)])
def test_pages_without_end_are_refused(server, folder, monkeypatch, bound, most):
    monkeypatch.setattr(vpc, bound, most)
    for number in range(6):
        written(folder, f"{number}.json", collection(item("0.copc.laz"), links=leads_to(f"{number + 1}.json")))
    with pytest.raises(ValueError, match=r"0\.json leads to more than .* ask for the items of an extent"):
        read_cloud(server.address("0.json"))
    assert len(server.requests) <= 5


@pytest.mark.parametrize(
    "numbers", [None, "x", [1, 2, 3], [0, 0, float("nan"), 1], [[0], [1, 2]], {"a": 1}, [1e400] * 4]
)
def test_tiles_with_odd_bounds_are_opened(server, folder, numbers):
    properties = {"proj:bbox": numbers}
    written(folder, "odd.vpc", collection(item("0.copc.laz", properties=properties), item("1.copc.laz")))
    assert len(read_cloud(server.address("odd.vpc"), box=ACROSS)) == len(read_cloud(folder / "all.vpc", box=ACROSS))
