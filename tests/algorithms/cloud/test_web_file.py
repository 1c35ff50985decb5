"""COPC files on the web: the points of the local file, from few bytes, and a sentence for every server that can't."""

import threading
import time

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import points, web_file, web_requests
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import (
    check_readable,
    count_points,
    dimension_names,
    read_cloud,
    read_extent,
    sizes_within,
    write_cloud,
)
from lidar_buildings.algorithms.cloud.points import open_header, size_within
from lidar_buildings.algorithms.cloud.web_addresses import redirected
from lidar_buildings.algorithms.cloud.web_file import WebFile, file_at
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.web_server import serving

CORNER = np.array([600_000.0, 5_000_000.0])
SIDE = 1000.0
VIEW = np.array([[300.0, 300.0], [400.0, 400.0]]) + CORNER


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """400,000 points on a square kilometer, as COPC and as LAZ."""
    rng = np.random.default_rng(1)
    xyz = np.column_stack([rng.uniform(0, SIDE, (400_000, 2)) + CORNER, rng.uniform(0, 30, 400_000)])
    folder = tmp_path_factory.mktemp("web")
    cloud = create_cloud({"xyz": xyz, "gps_time": np.arange(400_000) * 1e-3}, "EPSG:32631")
    write_cloud(cloud, folder / "a.copc.laz")
    write_cloud(cloud, folder / "b.laz")
    return folder


@pytest.fixture
def server(folder, monkeypatch):
    monkeypatch.setattr(web_file, "_WAITS", (0.01, 0.02, 0.03))
    with serving(folder) as server:
        yield server
    web_file._known.clear()


@pytest.mark.parametrize("box", [None, VIEW])
@pytest.mark.parametrize("name", ["a.copc.laz", "b.laz"])
def test_the_points_are_those_of_the_local_file(server, folder, tmp_path, name, box):
    for number, source in enumerate((server.address(name), folder / name)):
        write_cloud(read_cloud(source, box=box), tmp_path / f"{number}.las")
    assert (tmp_path / "0.las").read_bytes() == (tmp_path / "1.las").read_bytes()


def test_what_is_asked_before_a_run_costs_few_requests_and_is_that_of_the_local_file(server, folder):
    local, remote = folder / "a.copc.laz", server.address("a.copc.laz?key=secret")
    assert count_points(remote, VIEW) == count_points(local, VIEW)
    assert dimension_names(remote) == dimension_names(local)
    for one, other in zip(read_extent(remote), read_extent(local)):
        np.testing.assert_equal(one, other)
    assert len(server.requests) <= 4
    assert server.sent < 70_000


def test_a_file_without_index_is_checked_by_few_requests_and_fetched_once(server, folder, monkeypatch):
    monkeypatch.setattr(points, "FETCHED", 500_000)
    size = (folder / "b.laz").stat().st_size
    check_readable(server.address("b.laz"))
    assert len(server.requests) <= 4
    read_cloud(server.address("b.laz"))
    assert size > 1_000_000
    assert server.sent <= 1.1 * size


def test_a_view_costs_little_more_than_its_nodes(server, folder):
    _, needed = size_within(folder / "a.copc.laz", open_header(folder / "a.copc.laz"), VIEW)
    read_cloud(server.address("a.copc.laz"), box=VIEW)
    assert needed < 0.5 * (folder / "a.copc.laz").stat().st_size
    assert server.sent <= 1.3 * needed
    count = len(server.requests)
    read_cloud(server.address("a.copc.laz"), box=VIEW)
    assert len(server.requests) == count


def test_a_spacing_reads_fewer_bytes_and_the_points_of_the_local_file(server, folder):
    spacing = np.full(3, 10.0)
    (_, (points, size)), *_ = sizes_within(server.address("a.copc.laz"), None, spacing)
    thin = read_cloud(server.address("a.copc.laz"), spacing=spacing)
    np.testing.assert_array_equal(thin.points, read_cloud(folder / "a.copc.laz", spacing=spacing).points)
    assert len(thin) < points < 0.4 * 400_000
    assert size < 0.4 * (folder / "a.copc.laz").stat().st_size
    assert server.sent < 1.3 * size


def test_ranges_are_joined_and_come_at_once(server, folder, monkeypatch):
    # QGIS sends one after the other.
    monkeypatch.setattr(web_requests, "_transport", [web_requests._StandardLibrary()])
    server.delay = 0.5
    start = time.monotonic()
    read_cloud(server.address("a.copc.laz"), box=VIEW)
    chunks = [request for request in server.requests if request[2] - request[1] >= web_file._LEAST]
    assert len(chunks) > 1
    # One after the other they would take 0.5 s each.
    assert time.monotonic() - start < 0.5 * len(server.requests)


@pytest.mark.parametrize(("trouble", "count"), [("cut", 3), ("fail", 3)])
def test_requests_are_repeated(server, folder, trouble, count):
    setattr(server, trouble, count)
    found = read_cloud(server.address("a.copc.laz"), box=VIEW)
    np.testing.assert_array_equal(found.points, read_cloud(folder / "a.copc.laz", box=VIEW).points)


@pytest.mark.parametrize(
    ("trouble", "value", "sentence"),
    [
        ("whole", True, "sends whole files only, no ranges of bytes; download"),
        ("fail", 100, r"a\.copc\.laz can't be read \(it answers 503\)"),
        ("cut", 100, r"can't be read \(.* check the address"),
        ("missing_from", 100_000, r"There is no file at http://127\.0\.0\.1:\d+/a\.copc\.laz \(404\)"),
        ("total", 10**15, "bytes from .* instead of|truncated or damaged"),
        ("total", 1000, "bytes from 0 on instead of|truncated or damaged"),
        ("extra", b"more", "bytes from 0 on instead of"),
        ("token", "Bearer x", r"may not be read \(401\); choose an authentication"),
        ("redirect", "file:///etc/passwd", "leads to 'file:///etc/passwd', which is not followed"),
        ("redirect", "ftp://127.0.0.1/a.copc.laz", "which is not followed"),
        ("redirect", "http://u:p@127.0.0.1/a.copc.laz", "which is not followed"),
        ("redirect", "a.copc.laz", r"the server answers 302"),
    ],
)
def test_servers_that_can_not_are_refused_in_a_sentence(server, trouble, value, sentence):
    setattr(server, trouble, value)
    with pytest.raises(ValueError, match=sentence) as error:
        read_cloud(server.address("a.copc.laz?key=secret"), box=VIEW)
    assert "secret" not in str(error.value)
    assert "\n" not in str(error.value)


def test_a_file_that_changes_is_refused_and_read_the_next_time(server):
    address = server.address("a.copc.laz")
    read_extent(address)
    server.version = "2"
    with pytest.raises(ValueError, match="has changed while it was read"):
        read_cloud(address, box=VIEW)
    assert len(read_cloud(address, box=VIEW))


def test_redirections_are_followed(server, folder):
    with serving(folder) as other:
        other.redirect = server.address("a.copc.laz")
        assert len(read_cloud(other.address("moved.copc.laz"), box=VIEW))


def test_a_public_address_does_not_lead_into_the_network_of_the_user(monkeypatch):
    hosts = {"public.example": "93.184.216.34", "router.example": "192.168.1.1", "other.example": "8.8.8.8"}
    monkeypatch.setattr("socket.getaddrinfo", lambda host, _: [(0, 0, 0, "", (hosts.get(host, host), 0))])
    public = "https://public.example/a.copc.laz"
    assert redirected(public, "http://other.example/b.copc.laz") == "http://other.example/b.copc.laz"
    assert redirected("http://10.0.0.1/a", "http://router.example/b") == "http://router.example/b"
    for host in ("router.example", "127.0.0.1", "169.254.169.254"):
        with pytest.raises(ValueError, match=f"leads to {host}, an address of this computer or its network"):
            redirected(public, f"http://{host}/a.copc.laz")


def test_cancel_ends_within_two_seconds(server):
    address, asked = server.address("a.copc.laz"), threading.Event()
    read_extent(address)
    server.pace = 0.5

    class Impatient(Monitor):
        def progress(self, fraction):
            if asked.is_set():
                raise Cancelled

    threading.Timer(0.5, asked.set).start()
    start = time.monotonic()
    with pytest.raises(Cancelled):
        read_cloud(address, Impatient(), box=VIEW)
    assert 0.4 < time.monotonic() - start < 2.5


@pytest.mark.parametrize("address", ["http://", "https:///a.laz", "http://a b/c.laz", "http://h:x/a.laz", "http:/a"])
def test_what_is_no_address_is_refused(address):
    with pytest.raises(ValueError, match="is no address on the web"):
        file_at(address)


def test_names_and_passwords_in_addresses_are_refused_and_not_repeated():
    with pytest.raises(ValueError, match="has a user name or password") as error:
        file_at("https://me:secret@example.org/a.copc.laz")
    assert "secret" not in str(error.value)


def test_keys_in_addresses_are_not_shown():
    file = WebFile("https://example.org/b/a.copc.laz?key=secret#x")
    assert (str(file), file.name, file.parent) == (
        "https://example.org/b/a.copc.laz",
        "a.copc.laz",
        "https://example.org/b",
    )
