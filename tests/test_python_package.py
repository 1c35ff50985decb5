"""The core as a package: built, installed in an empty folder, and run there as a user does."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from lidar_buildings.algorithms import packages

ROOT = Path(__file__).resolve().parent.parent
TOWN = ("--size", "100", "--density", "3", "--buildings", "20")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("package")
    source = folder / "source"
    shutil.copytree(ROOT / "algorithms", source / "algorithms", ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "setup.py", "metadata.txt", "LICENSE", "docs/python.md"):
        (source / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, source / name)
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
    built = ["wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, source]
    subprocess.run([*pip, *built], check=True, capture_output=True)
    (path,) = folder.glob("*.whl")
    subprocess.run([*pip, "install", "--quiet", "--no-deps", "--target", folder / "site", path], check=True)
    return path


@pytest.fixture
def run(wheel, tmp_path):
    """Run the installed command in an empty folder."""

    def command(*words: str, python: str = "") -> subprocess.CompletedProcess:
        site = wheel.parent / "site"
        environment = {**os.environ, "PYTHONPATH": str(site)}
        asked = [sys.executable, "-c", python] if python else [sys.executable, site / "bin" / "lidar-buildings", *words]
        return subprocess.run(asked, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

    return command


def test_the_wheel_has_every_file_of_the_core_and_no_other(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
    files = [path for path in (ROOT / "algorithms").rglob("*") if path.suffix in (".py", ".html")]
    assert names == {f"lidar_buildings/{path.relative_to(ROOT).as_posix()}" for path in files}


def test_what_it_needs_is_what_the_plugin_needs(wheel):
    with zipfile.ZipFile(wheel) as archive:
        (metadata,) = (name for name in archive.namelist() if name.endswith("/METADATA"))
        text = archive.read(metadata).decode()
    needed = re.findall(r"^Requires-Dist: ([\w-]+)", text, re.MULTILINE)
    assert {*packages.REQUIRED.values(), "numpy", "lazrs", "pyogrio"} <= set(needed)


def test_a_town_is_made_and_its_buildings_are_found(run, tmp_path):
    made = run("simulate-town", *TOWN, "--output", "town.laz")
    assert made.returncode == 0, made.stderr
    found = run("detect", "town.laz", "--output", "classified.laz", "--footprints", "buildings.gpkg")
    assert found.returncode == 0, found.stderr
    layers = ("--footprints", "buildings.gpkg", "--reference-map", "buildings.gpkg")
    again = run("assess-footprints", *layers, "--report", "a.html")
    assert again.returncode == 0, again.stderr
    numbers = dict(line.split(": ") for line in again.stdout.splitlines())
    assert float(numbers["iou"]) == 1.0
    assert (tmp_path / "buildings.gpkg").read_bytes().startswith(b"SQLite format 3")


def test_it_is_imported_as_the_documentation_says(run):
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    blocks = [block.split("```")[0] for block in text.split("```python\n")[1:]]
    assert run("simulate-town", *TOWN, "--output", "tile.laz").returncode == 0
    done = run(python="\n".join([*blocks, "print(len(footprints.geometries), (classification == 2).mean())"]))
    assert done.returncode == 0, done.stderr
    buildings, ground = map(float, done.stdout.split())
    assert buildings >= 3
    assert 0.2 < ground < 0.9


def test_the_command_has_the_version_of_the_plugin(run):
    text = (ROOT / "metadata.txt").read_text(encoding="utf-8")
    (of_plugin,) = re.findall(r"^version=(.*)$", text, re.MULTILINE)
    assert run("--version").stdout.strip() == of_plugin


def test_the_command_says_what_is_wrong(run):
    done = run("detect", "nothing.laz", "--footprints", "f.geojson")
    assert (done.returncode, done.stderr.count("\n")) == (1, 1)
    assert "nothing.laz" in done.stderr
