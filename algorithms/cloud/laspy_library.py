"""The libraries of point cloud files: laspy, with lazrs or laszip beneath it. The only place that imports them."""

import importlib
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, Optional, cast

from ..memory import share_freed
from ..package_versions import requirement, too_old

# What laspy imports where it finds it, and is not needed here: pyproj, whose wheels bring another PROJ into QGIS, and
# requests, which takes longer to import than laspy itself.
_UNUSED = ("pyproj", "requests")


@cache
def need_laspy() -> Any:
    """Return laspy with its modules.

    The first threads of a run decompress points: from here on, threads share freed memory.

    Raises
    ------
    ValueError
        If it is not installed, or too old.
    """
    share_freed()
    old = too_old("laspy")
    if old:
        raise ValueError(
            f"Point clouds need the Python package {requirement('laspy')}, and {old} is installed; install a newer one."
        )
    try:
        with _without(*_UNUSED):
            importlib.import_module("laspy.vlrs.known")
            return importlib.import_module("laspy")
    except ModuleNotFoundError:
        raise ValueError("Point clouds need the Python package laspy, which is not installed; install laspy.") from None


@contextmanager
def _without(*names: str) -> Iterator[None]:
    """Hide packages that are not imported yet."""
    modules = cast("dict[str, Any]", sys.modules)
    hidden = [name for name in names if name not in modules]
    modules.update(dict.fromkeys(hidden))
    try:
        yield
    finally:
        for name in hidden:
            del modules[name]


def need_lazrs() -> Any:
    """Return lazrs, which alone writes chunks of chosen sizes.

    Raises
    ------
    ValueError
        If it is not installed.
    """
    if not has_backend("LazrsParallel"):
        raise ValueError("COPC files are written by the Python package lazrs, which is not installed; install lazrs.")
    return importlib.import_module("lazrs")


def has_backend(name: str) -> bool:
    """Whether laspy can use a package for LAZ, by the name of its backend: "LazrsParallel" or "Laszip"."""
    return need_laspy().LazBackend[name].is_available()


@contextmanager
def explained(path: Path, file: Optional[Any] = None) -> Iterator[None]:
    """Turn whatever a LAZ library raises, panics of Rust included, into one sentence.

    Raises
    ------
    ValueError
        If the library failed.
    OSError
        If it failed as ``file``, which it was reading and which keeps its ``failure``, could not be read.
    """
    try:
        yield
    except BaseException as error:
        # A panic in Rust is no Exception, and its class can't be imported.
        if type(error).__module__.split(".")[0] not in ("laspy", "lazrs", "laszip", "pyo3_runtime"):
            raise
        if getattr(file, "failure", None):
            raise cast(Any, file).failure from None
        raise ValueError(
            f"{path.name} is truncated or damaged: its points can't be decompressed; get the file again."
        ) from None
