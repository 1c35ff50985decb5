"""What algorithms write: checked before, complete or absent after, and shown in QGIS."""

import os
import re
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Optional

from qgis.core import (
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingOutputLayerDefinition,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterPointCloudDestination,
    QgsProcessingParameterRasterDestination,
    QgsProperty,
)

from ..algorithms import packages
from ..algorithms.cloud import outputs
from ..algorithms.cloud.cloud import Cloud
from ..algorithms.cloud.copc_sidecar import check_copc_beside, copc_path
from ..algorithms.cloud.files import check_compression, write_cloud
from ..algorithms.cloud.outputs import COPC, ResultFiles, kind_of
from ..algorithms.stage import Monitor
from .clouds import reads_las
from .errors import sentence_of
from .memory_files import copy_folder, memory_folder
from .rasters import check_raster
from .styles import load_from, name_after
from .vectors import check_layer

# "memory:", "postgres://…", "ogr:dbname='x.gpkg' table=…": no files. A single letter is a drive.
_NO_FILE = re.compile(r"^[A-Za-z]{2,}:")
_TABLE_IN_FILE = re.compile(r"^ogr:dbname='([^']+)'")

# Formats that are several files, by the extension of the one that is named. Indexes and statistics of an older file
# would be wrong next to a newer one, and what SQLite has yet to write of an older one would damage it.
_BESIDE = {
    ".shp": (".dbf", ".shx", ".prj", ".cpg", ".qix", ".sbn", ".sbx"),
    ".tab": (".dat", ".map", ".id", ".ind"),
    ".gpkg": (".gpkg-wal", ".gpkg-shm", ".gpkg-journal"),
    ".sqlite": (".sqlite-wal", ".sqlite-shm", ".sqlite-journal"),
    ".tif": (".tif.aux.xml",),
    ".tiff": (".tiff.aux.xml",),
}

# An ending in the filter of a file's dialog.
_ENDING = re.compile(r"\*(\.[\w.]+)")

# Size (bytes) of the smallest results, such as an empty GeoPackage.
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


def check_targets(definitions: list, parameters: dict, inputs: list, clouds: Sequence[Path] = ()) -> None:
    """Refuse outputs that can't be written, before any work.

    Parameters
    ----------
    definitions : list of QgsProcessingDestinationParameter
        The algorithm's outputs.
    parameters : dict
        Values as the algorithm was given them.
    inputs : list of Path
        Files that are read and so must not be written: layers, clouds, and the tiles of virtual ones.
    clouds : sequence of Path
        Clouds whose points are written.

    Raises
    ------
    ValueError
        If an output has an extension of no format that can hold it, is an input or another output, or no ordinary
        file, or if its folder is absent, read-only or full. The same if a package to write it is missing.
    """
    seen: dict[Path, str] = {}
    for definition in definitions:
        value = parameters.get(definition.name())
        path = target_path(value)
        if path is None:
            _check_database(value)
            continue
        with outputs.os_errors_as_messages(path):
            for file in files_of(definition, value):
                other = seen.setdefault(file.resolve(), definition.name())
                if other != definition.name():
                    raise ValueError(f"{other} and {definition.name()} are the same file ({file}); give each its own.")
            _check_target(definition, path, inputs)
            if _is_cloud(definition):
                check_compression(path, clouds)


def _check_database(value: Any) -> None:
    """Refuse a table of a file that can't be written; a file that is there is kept, with its other tables."""
    plain = _plain(value)
    table = _TABLE_IN_FILE.match(plain) if isinstance(plain, str) else None
    if table is not None:
        with outputs.os_errors_as_messages(Path(table[1])):
            _check_file(Path(table[1]))


def _check_target(definition, path: Path, inputs: list) -> None:
    """Refuse a file that an output can't be written to, by its extension, its folder and the inputs."""
    if _is_cloud(definition):
        outputs.check_output(path, inputs)
        # The last step of a model reads the output of the step before, so it can't know the model's input.
        if kind_of(path) != COPC:
            check_copc_beside(path, inputs)
    elif isinstance(definition, QgsProcessingParameterRasterDestination):
        check_raster(path)
    elif isinstance(definition, QgsProcessingParameterFeatureSink):
        check_layer(path, definition.dataType())
    else:
        _check_ending(definition, path)
    for file in files_of(definition, str(path)):
        outputs.check_place(file, inputs)
    _check_file(path)


def _check_ending(definition, path: Path) -> None:
    """Refuse a name without an extension of a text file's formats."""
    endings = _ENDING.findall(definition.fileFilter())
    if not path.name.lower().endswith(tuple(endings)):
        what = definition.description()
        what = f"a {what.lower()}" if what.islower() or what[1:].islower() else what
        raise ValueError(f"{path.name} can't be written as {what}: give it the extension {' or '.join(endings)}.")


def _check_file(path: Path) -> None:
    """Refuse a file that can't be written where it is to be, because of its folder or because the disk is full."""
    outputs.check_place(path)
    folder = path.absolute().parent
    if path.exists() and not path.is_file():
        raise ValueError(f"{path} is a device, not a file; choose another name.")
    if not os.access(folder, os.W_OK) or (path.exists() and not os.access(path, os.W_OK)):
        raise ValueError(f"{path} can't be written: it or its folder is read-only; choose another one.")
    # Quotas and full disks show only when something is written.
    with tempfile.TemporaryFile(dir=folder) as file:
        file.write(bytes(_LEAST_SPACE))


class Run:
    """The outputs of a run while it is writing them: in working folders, each next to its target.

    ``parameters`` are the run's, with outputs in the working folders. Tables of databases and layers in memory
    stay.
    """

    def __init__(self, definitions: list, parameters: dict, context: QgsProcessingContext, files: ResultFiles) -> None:
        self._files = files
        self._with_view: list[Path] = []
        self.parameters = dict(parameters)
        for definition in definitions:
            value = parameters.get(definition.name())
            path = _file_to_write(definition, value, context)
            if path is None:
                continue
            if _is_cloud(definition) and kind_of(path) != COPC:
                self._with_view.append(path)
            beside = files.beside(path, files_of(definition, str(path))[1:])
            self.parameters[definition.name()] = _redirected(value, str(beside))

    def check(self) -> None:
        """Refuse to replace a file that was put where a cloud's view goes since the run began."""
        for path in self._with_view:
            check_copc_beside(path, ())

    def final(self, value: Any) -> Any:
        """Return results with each path in a working folder replaced by its target's."""
        if isinstance(value, dict):
            return {self.final(key): self.final(one) for key, one in value.items()}
        if isinstance(value, list):
            return [self.final(one) for one in value]
        return self._files.final(value) if isinstance(value, str) else value


@contextmanager
def all_in_place(
    definitions: list, parameters: dict, context: QgsProcessingContext, subject: str = "", title: str = ""
) -> Iterator[Run]:
    """Put the outputs of a run in place together when the block ends well, and have QGIS load them from there.

    Parameters
    ----------
    definitions : list of QgsProcessingDestinationParameter
        The algorithm's outputs.
    parameters : dict
        Values as the algorithm was given them.
    context : QgsProcessingContext
        The context of the run.
    subject : str
        What the results are of, added to the names of layers that are called like their output.
    title : str
        Title of the algorithm, for the group of the layers.

    Raises
    ------
    ValueError, QgsProcessingException
        As the block does, or if a target can't be replaced; nothing was written then.
    """
    with outputs.all_or_nothing() as files:
        run = Run(definitions, parameters, context, files)
        try:
            yield run
            run.check()
        except (ValueError, QgsProcessingException) as error:
            raise type(error)(run.final(str(error))) from error
        except OSError as error:
            raise ValueError(run.final(sentence_of(error))) from error
    load_from(context, run.final)
    if subject or title:
        name_after(context, {definition.description() for definition in definitions}, subject, title)


def _file_to_write(definition, value: Any, context: QgsProcessingContext) -> Optional[Path]:
    """Return the file that an output is to be; None for a layer in memory, a database or an output not wanted."""
    if _plain(value) != QgsProcessing.TEMPORARY_OUTPUT:
        return target_path(value)
    is_memory = isinstance(definition, QgsProcessingParameterFeatureSink)
    return None if is_memory else Path(definition.generateTemporaryDestination(context))


def _redirected(value: Any, path: str) -> Any:
    """Return an output's value with another file, and all else that it says of loading and creating."""
    if not isinstance(value, QgsProcessingOutputLayerDefinition):
        return path
    redirected = QgsProcessingOutputLayerDefinition(value)
    redirected.sink = QgsProperty.fromValue(path)
    return redirected


@contextmanager
def through_memory(
    parameters: dict, name: str, context: QgsProcessingContext
) -> Iterator[tuple[dict, Callable[[str], str]]]:
    """Let a layer that is to be a file be made in memory, and write the file when the block ends well.

    ``name`` is the layer's parameter; layers in memory and tables of databases are made where they are to be. Yields
    the parameters for the block, and a function that turns a path in memory into the file's.

    Raises
    ------
    ValueError, QgsProcessingException
        If the file can't be written, or as the block does.
    """
    path = target_path(parameters[name])
    if path is None:
        yield parameters, str
        return
    with memory_folder() as folder:

        def final(text: Any) -> Any:
            return text.replace(folder, str(path.parent)) if isinstance(text, str) else text

        try:
            yield {**parameters, name: _redirected(parameters[name], f"{folder}/{path.name}")}, final
        except QgsProcessingException as error:
            raise QgsProcessingException(final(str(error))) from error
        copy_folder(folder, path)
    load_from(context, final)


def write_for_qgis(cloud: Cloud, target: str, context: QgsProcessingContext, monitor: Monitor) -> str:
    """Write ``cloud`` to ``target`` and return the file that QGIS is to load.

    That is ``target``, or a COPC next to it where the result is to be loaded by a QGIS without PDAL. Without the
    package lazrs the COPC is neither written nor loaded.
    """
    path = Path(target)
    needs_copc = kind_of(path) != COPC and context.willLoadLayerOnCompletion(target) and not reads_las()
    can_be_shown = not needs_copc or packages.has_laz()
    write_cloud(cloud, path, monitor, copc_beside=needs_copc and can_be_shown)
    if not needs_copc:
        return target
    layers = context.layersToLoadOnCompletion()
    details, shown = layers.pop(target), str(copc_path(path))
    if can_be_shown:
        layers[shown] = details
    else:
        monitor.warn(
            f"{path.name} is written, but not shown: this QGIS shows COPC only, which needs the package lazrs."
        )
    context.setLayersToLoadOnCompletion(layers)
    return shown
