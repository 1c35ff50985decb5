"""Runs never damage what they read, what others wrote, or an older result."""

from __future__ import annotations

import hashlib
import json
import sqlite3
from contextlib import closing

import numpy as np
import pytest
from qgis.core import QgsProcessingException, QgsVectorLayer

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.provider import cloud_algorithm, layer_outputs, run_outputs


def run(name, parameters, context, log):
    import processing

    return processing.run(f"lidarbuildings:{name}", parameters, context=context, feedback=log, is_child_algorithm=True)


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.fixture
def tiles(town, tmp_path):
    """A virtual point cloud of two tiles, and the tiles."""
    paths = []
    for i, half in enumerate((town["xyz"][:, 0] < 85_010, town["xyz"][:, 0] >= 85_010)):
        paths.append(tmp_path / f"{i}.laz")
        write_cloud(create_cloud({name: values[half] for name, values in town.items()}, wkt="EPSG:28992"), paths[-1])
    features = [{"type": "Feature", "assets": {"data": {"href": f"./{path.name}"}}, "properties": {}} for path in paths]
    vpc = tmp_path / "town.vpc"
    vpc.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return vpc, paths


@pytest.mark.parametrize(
    ("name", "inputs", "output"),
    [
        ("toychain", ["INPUT"], "OUTPUT"),
        ("toylift", ["INPUT"], "OUTPUT"),
        ("toycompare", ["INPUT", "REFERENCE"], "REPORT"),
    ],
)
def test_a_tile_of_a_virtual_cloud_is_never_an_output(provider, context, log, tiles, name, inputs, output):
    """A model with a virtual cloud as input replaced a tile of it, and a report replaced one."""
    vpc, (tile, _) = tiles
    before = digest(tile)
    given = {**dict.fromkeys(inputs, str(vpc)), output: str(tile)}
    accepted, message = provider.algorithm(name).create().checkParameterValues(given, context)
    assert not accepted
    with pytest.raises(QgsProcessingException, match=r"is also an input|extension \.html"):
        run(name, given, context, log)
    assert "is also an input" in message or "extension .html" in message
    assert digest(tile) == before


def test_a_report_is_a_page(provider, context, town_file, out):
    given = {"INPUT": str(town_file), "REFERENCE": str(town_file), "REPORT": str(out / "a.txt")}
    accepted, message = provider.algorithm("toycompare").create().checkParameterValues(given, context)
    assert not accepted
    assert message == "a.txt can't be written as a report: give it the extension .html."


def test_outputs_may_not_meet_in_a_file_that_one_writes_beside_its_own(provider, context, log, town_file, out):
    """QGIS would show the second in place of the first."""
    given = {"OUTPUT": str(out / "a.laz"), "TRUTH": str(out / "a.copc.laz")}
    accepted, message = provider.algorithm("toymake").create().checkParameterValues(given, context)
    assert not accepted
    assert "are the same file" in message


def test_a_late_cancel_leaves_the_older_results(provider, context, log, town_file, out, monkeypatch):
    """With the cloud written and the layer to come, neither the old cloud nor a new one was there after a cancel."""
    given = {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz"), "FOOTPRINTS": str(out / "f.gpkg")}
    run("toychain", given, context, log)
    before = [digest(out / name) for name in ("a.laz", "f.gpkg")]

    def cancelled(self, *args):
        raise Cancelled

    monkeypatch.setattr(cloud_algorithm, "write_layer", cancelled)
    with pytest.raises(QgsProcessingException, match="Cancelled"):
        run("toychain", {**given, "SECOND_STEP": 2.5}, context, log)
    assert [digest(out / name) for name in ("a.laz", "f.gpkg")] == before
    assert sorted(path.name for path in out.iterdir()) == ["a.laz", "f.gpkg"]


def test_a_cancelled_run_leaves_what_another_one_wrote_meanwhile(provider, context, log, town_file, out, monkeypatch):
    target = out / "a.laz"

    def meanwhile(*args, **kwargs):
        write_cloud(*args, **kwargs)
        write_cloud(create_cloud({"xyz": np.zeros((3, 3))}), target)
        log.cancel()

    monkeypatch.setattr(run_outputs, "write_cloud", meanwhile)
    assert run("toylift", {"INPUT": str(town_file), "OUTPUT": str(target)}, context, log) == {}
    assert len(read_cloud(target)) == 3
    assert [path.name for path in out.iterdir()] == ["a.laz"]


def test_a_layer_is_replaced_when_the_new_one_is_complete(provider, context, log, town_file, out, monkeypatch):
    """Killed while it wrote a GeoPackage, QGIS left neither the old layer nor a new one that could be read."""
    target = out / "f.gpkg"
    given = {"INPUT": str(town_file), "FOOTPRINTS": str(target)}
    run("toyoutline", given, context, log)
    before = digest(target)
    seen = []
    real = layer_outputs.qgis_features

    def watched(*arguments):
        for feature in real(*arguments):
            seen.append(digest(target))
            yield feature

    monkeypatch.setattr(layer_outputs, "qgis_features", watched)
    run("toyoutline", {**given, "MARGIN": 5.0}, context, log)
    assert seen == [before]
    assert digest(target) != before
    layer = QgsVectorLayer(str(target), "f", "ogr")
    assert layer.featureCount() == 1
    assert layer.dataProvider().subLayers()[0].split("!!::!!")[1] == "f", "the table has the name of the file"
    assert [path.name for path in out.iterdir()] == ["f.gpkg"]


def test_an_older_journal_is_not_applied_to_a_new_layer(provider, context, log, town_file, out):
    """A journal that SQLite finds next to a database is taken for its own, whichever file it was written for."""
    target = out / "f.gpkg"
    given = {"INPUT": str(town_file), "FOOTPRINTS": str(target)}
    run("toyoutline", given, context, log)
    editing = sqlite3.connect(target)
    editing.execute("PRAGMA journal_mode=WAL")
    editing.execute("CREATE TABLE edited (x)")
    editing.commit()
    assert (out / "f.gpkg-wal").stat().st_size > 0
    run("toyoutline", given, context, log)
    editing.close()
    (feature,) = QgsVectorLayer(str(target), "f", "ogr").getFeatures()
    assert feature["kind"] == "box"
    with closing(sqlite3.connect(target)) as database:
        assert not list(database.execute("SELECT * FROM sqlite_master WHERE name = 'edited'"))


def test_errors_name_the_file_that_the_user_gave(provider, context, log, town_file, out, monkeypatch):
    def full(cloud, path, *args, **kwargs):
        if path.name != "a.laz":
            return write_cloud(cloud, path, *args, **kwargs)
        raise ValueError(f"The disk is full: {path} was not written; free some space or choose another folder.")

    monkeypatch.setattr(run_outputs, "write_cloud", full)
    for name in ("toylift", "toychain"):
        with pytest.raises(QgsProcessingException, match=f"The disk is full: {out / 'a.laz'} was not written"):
            run(name, {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}, context, log)
    assert list(out.iterdir()) == []


@pytest.mark.parametrize("name", ["toylift", "toychain"])
def test_a_cancelled_run_logs_this_and_no_error(provider, context, log, town_file, out, monkeypatch, name):
    """The dialog said "Error encountered" and "Execution failed" to whoever pressed Cancel."""

    def cancelled(*args, **kwargs):
        write_cloud(*args, **kwargs)
        log.cancel()

    monkeypatch.setattr(run_outputs, "write_cloud", cancelled)
    results = run(name, {"INPUT": str(town_file), "OUTPUT": str(out / "a.laz")}, context, log)
    assert results == {}
    assert log.infos.count("Cancelled; nothing was written.") == 1
    assert not log.errors
    assert list(out.iterdir()) == []
