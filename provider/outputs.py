"""What algorithms write: checked before, complete or absent after, and shown in QGIS."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Optional

from qgis.core import (
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingOutputLayerDefinition,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterPointCloudDestination,
    QgsProcessingParameterRasterDestination,
    QgsProperty,
)

from ..algorithms.cloud.cloud import Cloud, write_cloud
from ..algorithms.cloud.outputs import COPC, check_output, kind_of, same_file, written_or_told
from ..algorithms.cloud.views import check_place, copc_path
from ..algorithms.stage import Monitor
from .clouds import reads_las
from .rasters import check_raster
from .vectors import check_layer

# "memory:", "postgres://…", "ogr:dbname='x.gpkg' table=…": no files. A single letter is a drive.
_NO_FILE = re.compile(r"^[A-Za-z]{2,}:")
_TABLE_IN_FILE = re.compile(r"^ogr:dbname='([^']+)'")

# Formats that are several files, by the extension of the one that is named.
_BESIDE = {".shp": (".dbf", ".shx", ".prj", ".cpg"), ".tab": (".dat", ".map", ".id", ".ind")}

# The smallest results, an empty GeoPackage among them, need about so much (bytes).
_LEAST_SPACE = 2**18


def _plain(value: Any) -> Any:
    """Return the value of an output parameter, whatever QGIS wrapped it in."""
    if isinstance(value, QgsProcessingOutputLayerDefinition):
        value = value.sink
    return value.staticValue() if isinstance(value, QgsProperty) else value


def target_path(value: Any) -> Optional[Path]:
    """Return the file that an output parameter's value names; None for a temporary, skipped or database output."""
    value = _plain(value)
    if not isinstance(value, str) or not value or value == QgsProcessing.TEMPORARY_OUTPUT or _NO_FILE.match(value):
        return None
    return Path(value)


def files_of(definition, value: Any) -> list:
    """Return the files that writing an output may touch."""
    path = target_path(value)
    if path is None:
        return []
    if _is_cloud(definition):
        return [path, copc_path(path)] if kind_of(path) else [path]
    return [path, *(path.with_suffix(suffix) for suffix in _BESIDE.get(path.suffix.lower(), ()))]


def _is_cloud(definition) -> bool:
    return isinstance(definition, QgsProcessingParameterPointCloudDestination)


def check_targets(definitions: list, parameters: dict, inputs: list) -> None:
    """Refuse outputs that can't be written, before any work.

    Parameters
    ----------
    definitions : list of QgsProcessingDestinationParameter
        The algorithm's outputs.
    parameters : dict
        Values as the algorithm was given them.
    inputs : list of Path
        Files that are read and so must not be written.

    Raises
    ------
    ValueError
        If an output has an unknown extension, is an input or another output, or a folder itself, or if its folder is
        absent, read-only or full.
    """
    seen: dict[Path, str] = {}
    for definition in definitions:
        value = parameters.get(definition.name())
        path = target_path(value)
        if path is None:
            _check_database(value)
            continue
        other = seen.setdefault(path.absolute(), definition.name())
        if other != definition.name():
            raise ValueError(f"{other} and {definition.name()} are the same file ({path}); give each its own.")
        _check_target(definition, path, inputs)


def _check_database(value: Any) -> None:
    """Refuse a table of a file that can't be written; a file that is there is kept, with its other tables."""
    plain = _plain(value)
    table = _TABLE_IN_FILE.match(plain) if isinstance(plain, str) else None
    if table is not None:
        _check_file(Path(table[1]))


def _check_target(definition, path: Path, inputs: list) -> None:
    if _is_cloud(definition):
        check_output(path, inputs)
        # The last step of a model reads what the step before it wrote, so it can't know the first input itself.
        if kind_of(path) != COPC:
            check_place(path, inputs)
    elif isinstance(definition, QgsProcessingParameterRasterDestination):
        check_raster(path)
    elif isinstance(definition, QgsProcessingParameterFeatureSink):
        check_layer(path)
    if any(same_file(path, source) for source in inputs):
        raise ValueError(f"The output {path} is also an input; choose another name.")
    _check_file(path)


def _check_file(path: Path) -> None:
    """Refuse a file that can't be written where it is to be, because of its folder or for want of space."""
    folder = path.absolute().parent
    if not folder.is_dir():
        raise ValueError(f"The folder {folder} does not exist; make it or choose another one.")
    if path.is_dir():
        raise ValueError(f"{path} is a folder; give the name of a file.")
    if not os.access(folder, os.W_OK) or (path.exists() and not os.access(path, os.W_OK)):
        raise ValueError(f"{path} can't be written: it or its folder is read-only; choose another one.")
    # What a disk allows shows only when something is written.
    with written_or_told(path), tempfile.TemporaryFile(dir=folder) as file:
        file.write(bytes(_LEAST_SPACE))


def _state(path: Path) -> Optional[tuple[int, int, int]]:
    """Return what changes when a file is written; None when there is none."""
    if not path.is_file():
        return None
    facts = path.stat()
    return facts.st_mtime_ns, facts.st_size, facts.st_ino


@contextmanager
def nothing_left_on_failure(paths: list) -> Iterator[list]:
    """Remove the files that the block wrote when it fails; files that it did not touch stay.

    The block may append to the list what it is about to make under a name that it found itself.
    """
    before = {path: _state(path) for path in paths}
    try:
        yield paths
    except BaseException:
        for path in paths:
            if path.is_file() and _state(path) != before.get(path):
                path.unlink()
        raise


def write_for_qgis(cloud: Cloud, target: str, context: QgsProcessingContext, monitor: Monitor) -> str:
    """Write ``cloud`` to ``target`` and return the file that QGIS is to load.

    That is ``target``, or a COPC beside it where the result is to be loaded by a QGIS without PDAL.
    """
    path = Path(target)
    needs_copc = kind_of(path) != COPC and context.willLoadLayerOnCompletion(target) and not reads_las()
    write_cloud(cloud, path, monitor, copc_beside=needs_copc)
    if not needs_copc:
        return target
    layers = context.layersToLoadOnCompletion()
    shown = str(copc_path(path))
    layers[shown] = layers.pop(target)
    context.setLayersToLoadOnCompletion(layers)
    return shown
