"""Third-party packages, imported when first used.

QGIS on some systems comes without scipy, scikit-learn, laspy or lazrs. The toolbox must
then still show every algorithm and each must say what is missing, so nothing here
is imported before a stage runs.
"""

import importlib
import importlib.util
from collections.abc import Collection
from types import ModuleType
from typing import Any

from .package_versions import too_old

# Import name -> name to install; the only list of what the plugin needs besides numpy. Each stage names those that it
# uses.
REQUIRED = {"scipy": "scipy", "sklearn": "scikit-learn", "laspy": "laspy"}
# Those that most stages need; the others stop few.
ESSENTIAL = ("scipy", "laspy")
# The package for LAZ that is installed where none is there; the libraries break where an old one is.
_LAZ = "lazrs"


class _Lazy(ModuleType):
    """A module that imports itself when one of its names is asked for."""

    def __getattr__(self, name: str):
        # Python itself asks for dunder names (doctest, inspect, copy), which must not import the module.
        if name.startswith("__"):
            raise AttributeError(name)
        value = getattr(importlib.import_module(self.__name__), name)
        # As an attribute of this module it is found directly the next time.
        setattr(self, name, value)
        return value


def missing(needed: Collection[str] = tuple(REQUIRED.values())) -> list[str]:
    """Return the needed packages that are not installed or too old, by the names to install them."""
    wanted = {module: name for module, name in REQUIRED.items() if name in needed}
    gone = [name for module, name in wanted.items() if importlib.util.find_spec(module) is None or too_old(name)]
    return [*gone, *([_LAZ] if too_old(_LAZ) else [])]


def has_laz() -> bool:
    """Whether LAZ can be read and written; LAS can without."""
    return any(importlib.util.find_spec(module) is not None for module in ("lazrs", "laszip"))


def zstandard() -> Any:
    """Return the module that unpacks zstandard, of Python 3.14 or of the package of this name; None without either."""
    found = [name for name in ("compression.zstd", "zstandard") if importlib.util.find_spec(name.partition(".")[0])]
    return importlib.import_module(found[0]) if found else None


def pyogrio() -> Any:
    """Return the module that reads and writes vector files, None where the package is not installed."""
    return importlib.import_module("pyogrio.raw") if importlib.util.find_spec("pyogrio") else None


def absent(needed: Collection[str] = tuple(REQUIRED.values())) -> list[str]:
    """Return all packages to install: the needed ones that are missing, and the one for LAZ."""
    return [*missing(needed), *([] if has_laz() else [_LAZ])]


spatial = _Lazy("scipy.spatial")
special = _Lazy("scipy.special")
ndimage = _Lazy("scipy.ndimage")
sparse = _Lazy("scipy.sparse")
csgraph = _Lazy("scipy.sparse.csgraph")
cluster = _Lazy("sklearn.cluster")
threadpoolctl = _Lazy("threadpoolctl")
