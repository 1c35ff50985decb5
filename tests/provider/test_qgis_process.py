"""The command line: exit codes, sentences and files, in a fresh profile."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.tests.profiles import QGIS_PROCESS, Profile

pytestmark = pytest.mark.skipif(QGIS_PROCESS is None, reason="there is no qgis_process")

STAGE = "lidarbuildings:classifynoisehistogram"


@pytest.fixture(scope="module")
def qgis_process(tmp_path_factory):
    return Profile(tmp_path_factory.mktemp("profile"), ("laspy", "lazrs"))


@pytest.fixture(scope="module")
def field(tmp_path_factory):
    """A field of 60 m with one bird."""
    x, y = np.meshgrid(np.arange(0, 60, 0.7), np.arange(0, 60, 0.7))
    xyz = np.column_stack([x.ravel(), y.ravel(), 0.05 * np.sin(x.ravel())]) + [85_000, 446_000, 0]
    xyz[1000, 2] = 80
    path = tmp_path_factory.mktemp("field") / "field.laz"
    write_cloud(create_cloud({"xyz": xyz, "classification": np.ones(len(xyz), np.uint8)}, "EPSG:28992"), path)
    return path


def test_a_laz_goes_through(qgis_process, field, tmp_path):
    target = tmp_path / "out.laz"
    given = json.dumps({"inputs": {"INPUT": str(field), "OUTPUT": str(target)}})
    done = qgis_process("--json", "run", STAGE, "-", stdin=given)
    assert done.returncode == 0, done.stderr
    results = json.loads(done.stdout)["results"]
    assert results["OUTPUT"] == str(target)
    assert isinstance(results["CELL_SIZE_USED"], (int, float))
    assert read_cloud(target).get("classification")[1000] in (7, 18)
    assert [path.name for path in tmp_path.iterdir()] == ["out.laz"]


def test_a_layer_comes_without_words_of_other_libraries(qgis_process, field, tmp_path):
    """QGIS must not be asked to open the cloud as a layer: it tries all kinds, and libraries print what they can't."""
    given = {"INPUT": str(field), "OUTPUT": str(tmp_path / "out.laz"), "PLANES": str(tmp_path / "planes.geojson")}
    done = qgis_process("--json", "run", "lidarbuildings:segmentplaneshough", "-", stdin=json.dumps({"inputs": given}))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "planes.geojson").is_file()
    assert "Unable to load" not in done.stdout + done.stderr


def test_help_names_every_parameter_and_output(qgis_process):
    done = qgis_process("help", "lidarbuildings:detectbuildings")
    assert done.returncode == 0, done.stderr
    for name in ("INPUT: ", "OUTPUT: ", "FOOTPRINTS: ", "Outputs"):
        assert name in done.stdout
    assert "<b>" not in done.stdout
    assert done.stdout.count("Find the buildings in a point cloud") == 1


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"OUTPUT": "{folder}/out.txt"}, "give it the extension .las, .laz or .copc.laz"),
        ({"INPUT": "{folder}/text.las"}, "text.las"),
    ],
)
def test_what_is_wrong_is_one_sentence_and_exit_code_1(qgis_process, field, tmp_path, given, sentence):
    (tmp_path / "text.las").write_text("This is no point cloud, whatever its name says.")
    values = {"INPUT": str(field), "OUTPUT": "{folder}/out.laz", **given}
    arguments = [f"{name}={value.format(folder=tmp_path)}" for name, value in values.items()]
    done = qgis_process("run", STAGE, "--", *arguments)
    assert done.returncode == 1
    said = done.stdout + done.stderr
    assert sentence in said
    assert "Traceback" not in said
    assert [path.name for path in tmp_path.iterdir()] == ["text.las"]


@pytest.mark.skipif(
    Path("/usr/lib/python3/dist-packages/lazrs").exists(), reason="lazrs is part of the system and can't be missing"
)
def test_without_its_packages_it_says_how_to_get_them(tmp_path_factory, field, tmp_path):
    bare = Profile(tmp_path_factory.mktemp("bare"), ())
    shown = bare("list")
    assert STAGE in shown.stdout
    done = bare("run", STAGE, "--", f"INPUT={field}", f"OUTPUT={tmp_path / 'out.laz'}")
    assert done.returncode == 1
    said = done.stdout + done.stderr
    assert "Python package is missing: laspy." in said
    assert "-I -m pip install --upgrade --no-deps --target" in said
    assert f"{bare.folder}/config/profiles/default/python 'laspy>=2.5,<3' 'lazrs>=0.6,<0.9'" in said
    assert "Traceback" not in said
