"""What all tests share: fixtures, and what pytest is to know of this project (the conftest of the root names it)."""

from __future__ import annotations

import importlib
import importlib.util
import os
import shutil
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

from lidar_buildings.tests.shared_results import SHARED_RESULTS

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "lidar_buildings"

# The tests that import QGIS: where there is none, they are not even read.
QGIS_FOLDERS = (ROOT / "tests" / "provider", ROOT / "tests" / "qgis")

# A busy machine is no failure, and the same examples in every run make a failure one that can be repeated.
settings.register_profile("repeatable", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("repeatable")


def pytest_ignore_collect(collection_path):
    """Leave out what needs QGIS where there is none, and of tests/ what holds no tests: only the core has doctests."""
    needs_qgis = collection_path in QGIS_FOLDERS and importlib.util.find_spec("qgis") is None
    is_library = ROOT / "tests" in collection_path.parents and not collection_path.name.startswith("test_")
    return needs_qgis or (is_library and collection_path.is_file()) or None


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes(config, specs):
    """Give all workers a folder for what they share, and the QGIS of each settings of its own.

    Two that write one file of settings disturb each other. There are as many as cores: the linear algebra of each takes
    one thread, as further ones would only wait.
    """

    def folder(prefix: str) -> str:
        made = tempfile.mkdtemp(prefix=prefix)
        config.add_cleanup(lambda: shutil.rmtree(made, ignore_errors=True))
        return made

    shared = folder("shared-results-")
    for spec in specs:
        spec.env.update({SHARED_RESULTS: shared, "QGIS_CUSTOM_CONFIG_PATH": folder("qgis-settings-")})
        spec.env["OPENBLAS_NUM_THREADS"] = "1"


def pytest_collect_file(file_path):
    """Let the doctests of a module of the core run in the module that the tests import.

    Pytest names it by the folder of the checkout and would load it a second time, with classes of its own.
    """
    if file_path.suffix == ".py" and ROOT / "algorithms" in file_path.parents:
        parts = file_path.relative_to(ROOT).with_suffix("").parts
        parts = parts[:-1] if parts[-1] == "__init__" else parts
        sys.modules[".".join((ROOT.name, *parts))] = importlib.import_module(".".join((PACKAGE, *parts)))


def pytest_runtest_teardown(item):
    """End where ``scripts/check.py`` has no more time for further tests."""
    if time.time() > float(os.environ.get("TESTS_BEGIN_UNTIL", "inf")):
        item.session.shouldstop = "half a minute is over, which is no failure: 'make test' runs the other tests"


@pytest.fixture(scope="session")
def laspy():
    """Laspy as a second opinion; it imports pyproj, which may complain about its own installation."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip("laspy")


@pytest.fixture
def rng():
    """Random numbers that are the same in every run."""
    return np.random.default_rng(20190613)
