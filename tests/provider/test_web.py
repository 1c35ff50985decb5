"""Point clouds on the web as inputs: addresses and layers, by QGIS's network manager."""

from __future__ import annotations

import json
import threading
import time

import numpy as np
import pytest
from qgis.core import (
    QgsApplication,
    QgsAuthMethodConfig,
    QgsPointCloudLayer,
    QgsProcessingException,
    QgsProject,
    QgsRectangle,
)

from lidar_buildings.algorithms.cloud import web_cache, web_file
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, sizes_within, write_cloud
from lidar_buildings.algorithms.cloud.vpc import write_vpc
from lidar_buildings.algorithms.cloud.web_requests import transport
from lidar_buildings.provider import menu, web
from lidar_buildings.provider.clouds import file_of_layer
from lidar_buildings.provider.menu import open_dialog, view_parameters
from lidar_buildings.provider.options import WEB_CACHE, WEB_HOSTS, WEB_LIMIT, apply_options
from lidar_buildings.provider.web import QgisTransport
from lidar_buildings.tests.ept_files import made_points, write_ept
from lidar_buildings.tests.provider.helpers import Interface, run
from lidar_buildings.tests.web_server import serving

VIEW = "85000,85300,446000,446300 [EPSG:28992]"
SRS = {"authority": "EPSG", "horizontal": "28992"}
BOX = np.array([[85_000.0, 446_000.0], [85_300.0, 446_300.0]])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """200,000 points on a square kilometer."""
    rng = np.random.default_rng(1)
    xyz = rng.uniform(0, [1000, 1000, 30], (200_000, 3)) + [85_000, 446_000, 0]
    folder = tmp_path_factory.mktemp("web")
    write_cloud(create_cloud({"xyz": xyz}, "EPSG:28992"), folder / "a.copc.laz")
    # Denser, with more than 1 MB in the view.
    dense = rng.uniform(0, [1000, 1000, 30], (800_000, 3)) + [85_000, 446_000, 0]
    write_cloud(create_cloud({"xyz": dense}, "EPSG:28992"), folder / "b.copc.laz")
    return folder


@pytest.fixture
def server(folder, qgis_application, monkeypatch):
    monkeypatch.setattr(web_file, "_WAITS", (0.01, 0.02))
    with serving(folder) as server:
        yield server
    web_file._known.clear()


def test_a_view_of_an_address_is_that_of_the_local_file(provider, context, log, server, folder, out):
    assert isinstance(transport(), QgisTransport)
    for name, source in (("a", server.address("a.copc.laz?key=secret")), ("b", str(folder / "a.copc.laz"))):
        given = {"INPUT": source, "EXTENT": VIEW, "OUTPUT": str(out / f"{name}.las")}
        run("toylift", given, context, log)
    assert (out / "a.las").read_bytes() == (out / "b.las").read_bytes()
    told = [one for one in log.infos if "points are read from 127.0.0.1" in one]
    assert len(told) == 1
    assert "a.copc.laz: " in told[0]
    assert not [one for one in (*log.infos, *log.warnings) if "secret" in one]


def test_more_than_the_limit_needs_an_extent(provider, context, log, server, out, monkeypatch):
    before = WEB_LIMIT.value
    WEB_LIMIT.set("1")
    try:
        given = {"INPUT": server.address("a.copc.laz"), "OUTPUT": str(out / "a.las")}
        accepted, why = provider.algorithm("toylift").checkParameterValues(given, context)
        assert not accepted
        assert "with 200,000 points, more than the 1 MB that are read at once; choose an extent" in why
        assert server.sent < 70_000
        WEB_LIMIT.set("nothing")
        assert "must be a whole number" in provider.algorithm("toylift").checkParameterValues(given, context)[1]
    finally:
        WEB_LIMIT.set(before)


@pytest.mark.parametrize(
    ("trouble", "value", "sentence"),
    [
        ("whole", True, "sends whole files only"),
        ("fail", 100, r"it answers 503"),
        ("cut", 100, "check the address and the connection"),
        ("missing_from", 0, "There is no file"),
        ("extra", b"more", "bytes from 0 on instead of"),
        ("token", "x", "may not be read"),
        ("redirect", "file:///etc/passwd", "is not followed"),
    ],
)
def test_servers_that_can_not_are_refused(provider, context, server, trouble, value, sentence, out):
    setattr(server, trouble, value)
    given = {"INPUT": server.address("a.copc.laz"), "OUTPUT": str(out / "a.las")}
    with pytest.raises(QgsProcessingException, match=sentence):
        run("toylift", given, context, None)


def test_many_requests_at_once_end_well(server, folder, monkeypatch):
    # With threads of their own, or slots in Python, some of a hundred requests failed or ended the process.
    monkeypatch.setattr(web_file, "MOST_AT_ONCE", 2**14)
    expected = read_cloud(folder / "a.copc.laz").points
    for _ in range(10):
        web_file._known.clear()
        np.testing.assert_array_equal(read_cloud(server.address("a.copc.laz")).points, expected)
    assert len(server.requests) > 500


def test_requests_are_sent_six_at_once(server, monkeypatch):
    monkeypatch.setattr(web_file, "MOST_AT_ONCE", 2**16)
    server.delay = 0.3
    start = time.monotonic()
    read_cloud(server.address("a.copc.laz"))
    # One after the other they would take 0.3 s each.
    assert time.monotonic() - start < 0.6 * 0.3 * len(server.requests)


def test_redirections_are_followed_with_their_ranges(server, folder):
    with serving(folder) as other:
        other.redirect = server.address("a.copc.laz")
        assert len(read_cloud(other.address("a.copc.laz"), box=BOX)) == len(read_cloud(folder / "a.copc.laz", box=BOX))


@pytest.fixture
def login(qgis_application):
    """A configuration that gives a header, in an authentication database of its own."""
    manager = QgsApplication.authManager()
    manager.setMasterPassword("master", True)
    config = QgsAuthMethodConfig("APIHeader")
    config.setName("web")
    config.setConfig("Authorization", "Bearer token")
    assert manager.storeAuthenticationConfig(config)[0]
    yield config.id()
    manager.removeAuthenticationConfig(config.id())


def test_an_authentication_configuration_is_used_and_not_shown_to_others(provider, context, log, server, folder, login):
    server.token = "Bearer token"
    address = f"authcfg={login} url={server.address('a.copc.laz')}"
    given = {"INPUT": address, "EXTENT": VIEW, "OUTPUT": "TEMPORARY_OUTPUT"}
    made = run("toylift", given, context, log)
    assert len(read_cloud(made["OUTPUT"])) == len(read_cloud(folder / "a.copc.laz", box=BOX))
    with serving(folder) as other:
        server.redirect = other.address("a.copc.laz")
        web_file._known.clear()
        run("toylift", given, context, log)
        assert set(other.seen) == {""}


def test_a_vpc_by_address_and_one_whose_host_is_named_are_the_local_one(provider, context, server, folder, out):
    write_vpc([folder / "a.copc.laz"], folder / "all.vpc")
    local = {"type": "Feature", "assets": {"data": {"href": server.address("a.copc.laz")}}}
    (out / "item.json").write_text(json.dumps(local))
    given = {"EXTENT": VIEW, "INPUT": str(out / "item.json"), "OUTPUT": str(out / "c.las")}
    accepted, why = provider.algorithm("toylift").checkParameterValues(given, context)
    assert not accepted
    assert f"(add 127.0.0.1 to '{WEB_HOSTS.title.partition(' (')[0]}')" in why
    assert not server.requests
    WEB_HOSTS.set("example.org 127.0.0.1")
    try:
        sources = (server.address("all.vpc"), str(folder / "all.vpc"), str(out / "item.json"))
        for name, source in zip("abc", sources):
            run("toylift", {**given, "INPUT": source, "OUTPUT": str(out / f"{name}.las")}, context, None)
    finally:
        WEB_HOSTS.set("")
    assert (out / "a.las").read_bytes() == (out / "b.las").read_bytes() == (out / "c.las").read_bytes()


@pytest.mark.parametrize("kind", ["laszip", "binary"])
def test_ept_by_address_and_as_a_layer_is_the_local_one(provider, context, server, folder, out, kind):
    corner = np.array([85_000.0, 446_000.0])
    path = write_ept(folder / kind, made_points(40_000, corner, 1000.0), corner, 1000.0, kind, srs=SRS)
    address = server.address(f"{kind}/ept.json")
    for name, source in (("a", address), ("b", str(path))):
        run("toylift", {"INPUT": source, "EXTENT": VIEW, "OUTPUT": str(out / f"{name}.las")}, context, None)
    assert (out / "a.las").read_bytes() == (out / "b.las").read_bytes()
    assert len(read_cloud(out / "a.las")) == len(read_cloud(path, box=BOX)) > 1000
    assert file_of_layer(QgsPointCloudLayer(address, "a", "ept")) == web_file.WebFile(address)


def test_a_layer_is_its_address(qgis_application):
    layer = QgsPointCloudLayer("https://example.invalid/a.copc.laz?x=1", "a", "copc")
    assert file_of_layer(layer) == web_file.WebFile("https://example.invalid/a.copc.laz?x=1")


def test_the_view_of_a_layer_on_the_web_is_run(provider, context, log, server, folder, out):
    layer = QgsPointCloudLayer(server.address("a.copc.laz"), "a", "copc")
    assert layer.isValid()
    QgsProject.instance().addMapLayer(layer)
    try:
        part = QgsRectangle(BOX[0, 0] - 50, BOX[0, 1] - 50, *BOX[1])
        given = view_parameters(Interface(layer, [], part, "EPSG:28992"))
        run("toylift", {**given, "OUTPUT": str(out / "a.las")}, context, log)
    finally:
        QgsProject.instance().removeMapLayer(layer)
    assert len(read_cloud(out / "a.las")) == len(read_cloud(folder / "a.copc.laz", box=BOX))


class Window(Interface):
    """The windows of QGIS, with what is shown and asked in them."""

    def __init__(self, layer, view):
        super().__init__(layer, [], view, "EPSG:28992")
        self.shown, self.warned = [], []

    def mainWindow(self):
        return None

    def messageBar(self):
        shown, warned = self.shown, self.warned
        bar = {"pushMessage": lambda self, *words: shown.append(words[-1])}
        return type("Bar", (), {**bar, "pushWarning": lambda self, *words: warned.append(words[-1])})()


@pytest.fixture
def button(provider, server, monkeypatch):
    """Return a function that presses the red button over the layer of a file; and what was opened and asked."""
    import processing

    opened, asked = [], []
    monkeypatch.setattr(processing, "execAlgorithmDialog", lambda *arguments: opened.append(arguments))
    monkeypatch.setattr(web, "_agreed", [0])

    def press(layer, answer=True):
        monkeypatch.setattr(menu, "is_answered_yes", lambda *words: asked.append(words[-1]) or answer)
        QgsProject.instance().addMapLayer(layer, False)
        window = Window(layer, QgsRectangle(BOX[0, 0] - 50, BOX[0, 1] - 50, *BOX[1]))
        try:
            open_dialog(window)
        finally:
            QgsProject.instance().takeMapLayer(layer)
        return window

    yield press, opened, asked
    WEB_LIMIT.set(WEB_LIMIT.default)


def test_the_button_says_how_much_the_view_has_before_anything_is_read(server, folder, button):
    press, opened, asked = button
    options = QgsPointCloudLayer.LayerOptions()
    # QGIS would read points for them meanwhile.
    options.skipStatisticsCalculation = True
    layer = QgsPointCloudLayer(server.address("a.copc.laz"), "a", "copc", options)
    server.sent, before = 0, len(server.requests)
    window = press(layer)
    (_, (points, size)), *_ = sizes_within(web_file.WebFile(server.address("a.copc.laz")), BOX)
    expected = f"a.copc.laz: {size / 1e6:.1f} MB with {points:,} points are in this view."
    assert window.shown == [f"{expected} Finding buildings in them takes about 1 min."]
    assert (len(opened), asked) == (1, [])
    assert len(server.requests) - before <= 4
    assert server.sent < 0.1 * (folder / "a.copc.laz").stat().st_size


@pytest.mark.parametrize("answer", [True, False])
def test_the_button_asks_where_the_view_is_over_the_limit(provider, context, server, button, out, answer):
    press, opened, asked = button
    WEB_LIMIT.set("1")
    layer = QgsPointCloudLayer(server.address("b.copc.laz"), "b", "copc")
    given = {"INPUT": server.address("b.copc.laz"), "EXTENT": VIEW, "OUTPUT": str(out / "a.las")}
    assert not provider.algorithm("toylift").checkParameterValues(given, context)[0]
    press(layer, answer)
    assert "more than the 1 MB that are read at once. Read it all the same?" in asked[0]
    assert len(opened) == answer
    # What was agreed to is read, and more is not.
    assert provider.algorithm("toylift").checkParameterValues(given, context)[0] is answer
    assert not provider.algorithm("toylift").checkParameterValues({**given, "EXTENT": ""}, context)[0]


def test_the_button_says_what_is_wrong_with_a_server_and_opens_the_dialog(server, button):
    press, opened, _ = button
    layer = QgsPointCloudLayer(server.address("a.copc.laz"), "a", "copc")
    server.missing_from = 0
    window = press(layer)
    assert "There is no file at" in window.warned[0]
    assert len(opened) == 1


def test_the_button_asks_nothing_of_files_on_this_computer(folder, button):
    press, opened, asked = button
    layer = QgsPointCloudLayer(str(folder / "a.copc.laz"), "a", "copc")
    assert press(layer).shown == asked == []
    assert len(opened) == 1


def test_the_limit_is_for_all_tiles_together(provider, context, server, folder, out):
    write_vpc([folder / "a.copc.laz", folder / "b.copc.laz"], folder / "both.vpc")
    small, large = ((folder / name).stat().st_size / 1e6 for name in ("a.copc.laz", "b.copc.laz"))
    limit = int(large + small)
    assert large < limit
    WEB_LIMIT.set(str(limit))
    try:
        given = {"INPUT": server.address("both.vpc"), "OUTPUT": str(out / "a.las")}
        accepted, why = provider.algorithm("toylift").checkParameterValues(given, context)
        assert not accepted
        assert "a.copc.laz and 1 more files is on the web" in why
    finally:
        WEB_LIMIT.set(WEB_LIMIT.default)


@pytest.mark.parametrize("id_", ["cutintotiles", "detectbuildingsintiles"])
def test_the_limit_is_for_surveys_in_tiles_as_well(provider, context, server, out, monkeypatch, id_):
    monkeypatch.setattr(web, "is_over_limit", lambda size: size.bytes > 1e6)
    given = {"INPUT": [server.address("a.copc.laz")], "OUTPUT": str(out / "tiles")}
    accepted, why = provider.algorithm(id_).checkParameterValues(given, context)
    assert not accepted
    assert "with 200,000 points, more than the" in why
    assert provider.algorithm(id_).checkParameterValues({**given, "EXTENT": VIEW}, context)[0]
    assert server.sent < 150_000


def test_a_spacing_in_tiles_reads_coarse_levels_and_gives_the_points_of_one_run(
    provider, context, log, server, folder, out
):
    given = {"INPUT": [server.address("a.copc.laz")], "EXTENT": VIEW, "SPACING": 12.0, "BLOCK_SIDE": 100.0}
    made = run("detectbuildingsintiles", {**given, "PROCESSES": 1, "OUTPUT": str(out / "tiles")}, context, log)
    found, wanted = read_cloud(made["VPC"]), read_cloud(folder / "a.copc.laz", box=BOX, spacing=np.full(3, 12.0))
    np.testing.assert_array_equal(*(np.sort(one.to_map(one.get("xyz")), axis=0) for one in (found, wanted)))
    assert made["POINTS"] == len(wanted)
    assert "are read from 127.0.0.1" in " ".join(log.infos)
    # The margin of a block reaches beyond the extent, and what is read does not.
    sent = server.sent
    (_, (_, needed)) = sizes_within(server.address("a.copc.laz"), BOX, np.full(3, 12.0))[0]
    assert sent <= 1.3 * needed


def test_what_was_read_is_kept_in_the_folder_of_the_options(provider, context, server, out):
    given = {"INPUT": server.address("a.copc.laz"), "EXTENT": VIEW, "OUTPUT": "TEMPORARY_OUTPUT"}
    sent = []
    WEB_CACHE.set(str(out / "kept"))
    try:
        for _ in range(2):
            web_file._known.clear()
            server.sent = 0
            run("toylift", given, context, None)
            sent.append(server.sent)
    finally:
        WEB_CACHE.set("")
        apply_options()
    assert sent[0] > 10 * sent[1] > 0
    assert list((out / "kept").iterdir())
    assert web_cache._folder == [""]


def test_cancel_ends_within_two_seconds(provider, context, log, server, out):
    server.pace = 0.4
    started = time.monotonic()
    threading.Timer(1.5, log.cancel).start()
    given = {"INPUT": server.address("a.copc.laz"), "OUTPUT": str(out / "a.las")}
    run("toylift", given, context, log)
    assert 1.4 < time.monotonic() - started < 3.5
    assert not (out / "a.las").exists()


def test_a_survey_on_the_web_is_cut_into_tiles_of_its_extent(provider, context, log, server, folder, out):
    given = {"INPUT": [server.address("a.copc.laz")], "SIDE": 100.0, "EXTENT": VIEW, "OUTPUT": str(out / "tiles")}
    made = run("cutintotiles", given, context, log)
    found, wanted = read_cloud(made["VPC"]), read_cloud(folder / "a.copc.laz", box=BOX)
    assert made["TILES"] >= 9
    np.testing.assert_array_equal(*(np.sort(one.to_map(one.get("xyz")), axis=0) for one in (found, wanted)))
    assert server.sent < 0.6 * (folder / "a.copc.laz").stat().st_size


@pytest.mark.parametrize("processes", [pytest.param(1, marks=pytest.mark.slow), 2])
def test_blocks_of_tiles_read_their_own_ranges(provider, context, log, server, folder, out, processes):
    given = {"EXTENT": "85000,85100,446000,446100 [EPSG:28992]", "PROCESSES": processes, "BLOCK_SIDE": 50.0}
    points = []
    for name, source in (("a", server.address("a.copc.laz")), ("b", str(folder / "a.copc.laz"))):
        made = run("detectbuildingsintiles", {**given, "INPUT": [source], "OUTPUT": str(out / name)}, context, log)
        cloud = read_cloud(made["VPC"])
        points.append(np.column_stack([cloud.to_map(cloud.get("xyz")), cloud.get("classification")]))
    np.testing.assert_array_equal(*points)
