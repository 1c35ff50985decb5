"""A disk that fills up while outputs are written: one sentence, old files as they were, nothing left over."""

from __future__ import annotations

import resource
import subprocess
from contextlib import contextmanager

import pytest
from qgis.core import QgsFeature, QgsGeometry, QgsProcessingException

from lidar_buildings.provider import layer_outputs, run_outputs

from .helpers import run

OUTPUTS = {
    "LAZ": ("toylift", "OUTPUT", "a.laz"),
    "COPC": ("toylift", "OUTPUT", "a.copc.laz"),
    "LAS": ("toylift", "OUTPUT", "a.las"),
    "raster": ("toypicture", "PICTURE", "a.tif"),
    "GeoPackage": ("toyoutline", "FOOTPRINTS", "a.gpkg"),
    "shapefile": ("toyoutline", "FOOTPRINTS", "a.shp"),
    "GeoJSON": ("toyoutline", "FOOTPRINTS", "a.geojson"),
    "page": ("toycompare", "REPORT", "a.html"),
    "cloud of a chain": ("toychain", "OUTPUT", "a.laz"),
    "layer of a chain": ("toychain", "FOOTPRINTS", "a.gpkg"),
}
# Those that are one file, written once.
SINGLE = ("LAZ", "COPC", "LAS", "raster", "page", "cloud of a chain")
# Sizes at which a write fails (bytes): at once, within the smallest output, and within the rows of a layer.
LIMITS = (0, 40, 3_000, 60_000, 120_000, 250_000)


@contextmanager
def no_file_larger_than(size):
    """Let writing fail after some bytes, as the system does it for any user (EFBIG); Python ignores the signal."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.fixture
def many_features(monkeypatch):
    """Let layers have 600 features of 50 corners, more than their formats keep in memory."""
    real = layer_outputs.qgis_features

    def many(*arguments):
        (feature,) = real(*arguments)
        geometry = QgsGeometry(feature.geometry()).densifyByCount(5)
        for _ in range(600):
            copy = QgsFeature(feature)
            copy.setGeometry(geometry)
            yield copy

    monkeypatch.setattr(layer_outputs, "qgis_features", many)


@pytest.fixture
def no_look_ahead(monkeypatch):
    """Leave out what finds out before a run that there is no space, so that the writing itself fails."""
    monkeypatch.setattr(run_outputs, "_LEAST_SPACE", 0)


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def given(kind, town_file, folder):
    name, output, file = OUTPUTS[kind]
    values = {
        "INPUT": str(town_file),
        "REFERENCE": str(town_file.with_name("reference.laz")),
        output: str(folder / file),
    }
    if name != "toycompare":
        del values["REFERENCE"]
    return name, values


@pytest.mark.parametrize("kind", OUTPUTS)
@pytest.mark.usefixtures("many_features", "no_look_ahead", "reference_file")
def test_writing_that_fails_leaves_the_older_outputs(provider, context, log, town_file, out, kind):
    name, values = given(kind, town_file, out)
    run(name, values, context, log)
    before, source = contents(out), town_file.read_bytes()
    largest = max(map(len, before.values()))
    for limit in (size for size in (*LIMITS, largest - 1) if size < largest):
        with no_file_larger_than(limit), pytest.raises(QgsProcessingException) as caught:
            run(name, values, context, log)
        said = str(caught.value)
        assert contents(out) == before, limit
        assert "can't be written" in said, (limit, said)
        assert f"{out}" in said
        assert ".part" not in said
        assert said.endswith(".")
        assert "\n" not in said
    assert town_file.read_bytes() == source


@pytest.fixture
def small_disk(tmp_path):
    """A disk of 300 kB, where the system lets this user mount one."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", str(folder)], capture_output=True, check=False
    )
    if mounted.returncode:
        pytest.skip("this user can't mount a disk")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.parametrize("kind", OUTPUTS)
@pytest.mark.usefixtures("many_features", "no_look_ahead", "reference_file")
def test_a_full_disk(provider, context, log, town_file, small_disk, kind):
    """As root in a container or a virtual machine; everyone has the limit above."""
    name, values = given(kind, town_file, small_disk)
    output = small_disk / OUTPUTS[kind][2]
    output.write_text("older")
    # With the older output, seven pages of 4 kB are free; "rest" leaves none to single files, and six to layers.
    (small_disk / "full").write_bytes(bytes(300 * 1024 - 8 * 4096))
    (small_disk / "rest").write_bytes(bytes(7 * 4096 if kind in SINGLE else 4096))
    before = contents(small_disk)
    with pytest.raises(QgsProcessingException) as caught:
        run(name, values, context, log)
    assert contents(small_disk) == before
    said = str(caught.value)
    assert "disk is full" in said or "free some space" in said
    assert str(output) in said
    assert said.endswith(".")


def test_a_disk_without_space_is_found_out_before_the_run(provider, context, log, town_file, out):
    name, values = given("LAZ", town_file, out)
    with no_file_larger_than(1000):
        accepted, message = provider.algorithm(name).create().checkParameterValues(values, context)
    assert not accepted
    assert "can't be written" in message
    assert not contents(out)
