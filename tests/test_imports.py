"""Who may import what: the layers of the house, read from the source and not from a run."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
QGIS = {"qgis", "osgeo", "processing", "PyQt5", "PyQt6", "console"}
POINT_CLOUD_FILES = {"laspy", "lazrs", "laszip", "copclib"}
NUMERICAL = {"scipy", "sklearn"}
# Functions that import what their first argument says.
IMPORTERS = {"import_module", "__import__", "_Lazy"}


def imported(source: str) -> Iterator[str]:
    """Yield what a source imports, however deep inside: "scipy.spatial", or "..provider" when relative."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            start = "." * node.level + (node.module or "")
            yield from ([start] if node.module else (start + alias.name for alias in node.names))
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if called in IMPORTERS:
                yield str(node.args[0].value)


def packages_of(path: Path) -> set[str]:
    """Return the packages that a file imports by absolute name."""
    names = imported(path.read_text(encoding="utf-8"))
    return {name.split(".")[0] for name in names if not name.startswith(".")}


def sources(*folders: str) -> list[str]:
    return sorted(str(path.relative_to(ROOT)) for folder in folders for path in (ROOT / folder).rglob("*.py"))


CORE = sources("algorithms")
PLUGIN = ["__init__.py", *CORE, *sources("provider")]


def test_reader_of_imports_sees_every_way_to_import():
    source = """
import numpy as np, scipy.ndimage
from qgis.core import Qgis
from . import stage
from .cloud import asprs
from ..provider.crs import crs_of
def late():
    import laspy
    importlib.import_module("sklearn.cluster")
ndimage = _Lazy("scipy.ndimage")
"""
    assert sorted(imported(source)) == sorted(
        ["numpy", "scipy.ndimage", "qgis.core", ".stage", ".cloud", "..provider.crs", "laspy"]
        + ["sklearn.cluster", "scipy.ndimage"]
    )


def test_there_are_sources_to_read():
    assert "algorithms/stages.py" in CORE
    assert "provider/plugin.py" in PLUGIN


@pytest.mark.parametrize("path", ["__init__.py", *CORE])
def test_only_the_provider_knows_qgis(path):
    assert not packages_of(ROOT / path) & QGIS


@pytest.mark.parametrize("path", [path for path in PLUGIN if not path.startswith("algorithms/cloud/")])
def test_only_the_cloud_knows_files_of_points(path):
    assert not packages_of(ROOT / path) & POINT_CLOUD_FILES


@pytest.mark.parametrize("path", [path for path in PLUGIN if path != "algorithms/packages.py"])
def test_scipy_and_scikit_learn_come_through_packages_only(path):
    assert not packages_of(ROOT / path) & NUMERICAL


@pytest.mark.parametrize("path", CORE)
def test_core_does_not_import_the_provider(path):
    names = imported((ROOT / path).read_text(encoding="utf-8"))
    assert not [name for name in names if "provider" in name.lstrip(".").split(".")]


@pytest.mark.parametrize("path", CORE)
def test_core_imports_nothing_but_what_the_readme_names(path):
    allowed = {"numpy"} | (POINT_CLOUD_FILES if path.startswith("algorithms/cloud/") else set())
    allowed |= NUMERICAL if path == "algorithms/packages.py" else set()
    assert not packages_of(ROOT / path) - allowed - set(sys.stdlib_module_names)


@pytest.mark.parametrize("absent", [POINT_CLOUD_FILES | NUMERICAL, QGIS])
def test_stages_load_where_packages_are_missing(absent):
    # A None in sys.modules makes Python say "not installed".
    script = f"""
import sys
sys.modules.update(dict.fromkeys({sorted(absent)}))
import conftest
from lidar_buildings.algorithms import STAGES, pipelines
"""
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_every_stage_loads_from_the_package_alone():
    """What a stage and its tests need stands in ``algorithms.stage``, whichever of its modules it is in."""
    parts = [path.stem for path in (ROOT / "algorithms" / "stage").glob("*.py") if path.stem != "__init__"]
    deep = [
        path
        for path in sources("algorithms", "provider", "tests")
        if not path.startswith("algorithms/stage/")
        for name in imported((ROOT / path).read_text(encoding="utf-8"))
        if any(name.endswith(f"stage.{part}") for part in parts)
    ]
    assert not deep
