"""Make the checkout importable as ``lidar_buildings``, whatever its folder is called."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent
PACKAGE = "lidar_buildings"

# Not a conftest below tests/: in a checkout that is itself called "tests" the two would have one name.
pytest_plugins = ["lidar_buildings.tests.fixtures"]


def _register() -> None:
    if PACKAGE in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)])
    sys.modules[PACKAGE] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[PACKAGE])


_register()
