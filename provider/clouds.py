"""Point clouds as input: a path or a layer, also on builds of QGIS that can't open LAS and LAZ."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, Callable, Optional

from qgis.core import (
    Qgis,
    QgsMapLayer,
    QgsPointCloudLayer,
    QgsProcessingContext,
    QgsProcessingOutputLayerDefinition,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterPointCloudLayer,
    QgsProcessingUtils,
    QgsProperty,
    QgsProviderRegistry,
)

from ..algorithms.cloud.files import named_files_of
from ..algorithms.cloud.web_file import is_on_web
from .given import Given
from .web import web_file

SUFFIXES = (".las", ".laz", ".vpc", ".json")
FILTER = "Point clouds (*.las *.LAS *.laz *.LAZ *.vpc *.VPC *.json)"


def reads_las() -> bool:
    """Whether this build of QGIS opens LAS and LAZ files as layers (it has PDAL)."""
    return "pdal" in QgsProviderRegistry.instance().providerList()


class _TakesFiles:
    """What parameters for point clouds have in common: they take the paths of files that QGIS may be unable to open."""

    # Methods of QGIS's own class, which is the second base of each subclass.
    flags: Callable[[], Any]
    help: Callable[[], str]
    metadata: Callable[[], dict]

    def createFileFilter(self) -> str:  # noqa: N802 - QGIS asks for these names
        """Return the filter of the browse dialog, LAS and LAZ first."""
        return f"{FILTER};;{super().createFileFilter()}"  # type: ignore[misc]

    def checkValueIsAcceptable(self, value: Any, context: Optional[QgsProcessingContext] = None) -> bool:  # noqa: N802
        """Whether ``value`` may be a point cloud or several; what it really is, :func:`cloud_path` finds out."""
        is_optional = bool(self.flags() & Qgis.ProcessingParameterFlag.Optional)
        return isinstance(value, (QgsMapLayer, QgsProperty)) or bool(value) or is_optional

    def _as_this(self, copy: QgsProcessingParameterDefinition) -> QgsProcessingParameterDefinition:
        """Return ``copy`` with everything that is set after a parameter was made."""
        copy.setFlags(self.flags())
        copy.setHelp(self.help())
        copy.setMetadata(self.metadata())
        return copy


class CloudParameter(_TakesFiles, QgsProcessingParameterPointCloudLayer):
    """A point cloud layer, or the path of a file that QGIS itself may be unable to open."""

    def clone(self) -> CloudParameter:
        """Return a copy of this subclass; QGIS's clone() returns the base class."""
        return self._as_this(CloudParameter(self.name(), self.description(), self.defaultValue()))


# QGIS's own field for several clouds keeps layers alone; folders, and files that it can't open, are lost.
_LISTED = {"widget_wrapper": {"class": f"{__package__}.file_list.FilesWrapper"}}


class CloudsParameter(_TakesFiles, QgsProcessingParameterMultipleLayers):
    """Point clouds: layers, paths of files that QGIS itself may be unable to open, and of a survey also folders."""

    def __init__(self, name: str, description: str) -> None:
        super().__init__(name, description, Qgis.ProcessingSourceType.PointCloud)
        self.setMinimumNumberInputs(1)
        self.setMetadata(_LISTED)

    def clone(self) -> CloudsParameter:
        """Return a copy of this subclass; QGIS's clone() returns the base class."""
        return self._as_this(CloudsParameter(self.name(), self.description()))

    def valueAsPythonString(self, value: Any, context: QgsProcessingContext) -> str:  # noqa: N802
        """Return the clouds as a script and the log name them."""
        # QGIS writes down the layers that it can open, which leaves nothing of files that it can't.
        names = names_of(value)
        return super().valueAsPythonString(value, context) if names is None else repr(names)


def files_read(clouds: Iterable[Path]) -> list[Path]:
    """Return all files that hold the points of clouds: themselves, and the tiles of virtual point clouds.

    Raises
    ------
    ValueError
        If a virtual point cloud can't be read, or a tile is missing.
    """
    return [file for cloud in clouds for file in (cloud, *named_files_of(cloud))]


def cloud_path(given: Given, name: str) -> Path:
    """Return the file of the point cloud that a parameter gives as layer, layer id, layer name, source or path.

    Raises
    ------
    ValueError
        If there is no such file or layer, or it is no point cloud with a file.
    """
    value = _plain(given, name, given.parameters.get(name))
    if not value:
        raise ValueError(f"{given.title(name)} ({name}) is missing; choose a point cloud.")
    return _path(given, name, value)


def cloud_paths(given: Given, name: str) -> list[Path]:
    """Return the files of the point clouds that a parameter gives, see :func:`cloud_path`; at least one."""
    values = _several(given, name)
    if not values:
        raise ValueError(f"{given.title(name)} ({name}) are missing; choose a point cloud.")
    return [_path(given, name, value) for value in values]


def survey_paths(given: Given, name: str) -> list[Path]:
    """Return the folders and the files of the point clouds that a parameter gives, see :func:`cloud_path`."""
    values = _several(given, name)
    if not values:
        raise ValueError(f"{given.title(name)} ({name}) is missing; choose a folder or files of points.")
    folders = [value if isinstance(value, str) and Path(value).is_dir() else "" for value in values]
    return [Path(folder) if folder else _path(given, name, value) for folder, value in zip(folders, values)]


def _several(given: Given, name: str) -> list:
    """Return the layers and texts that a parameter gives, without empty ones."""
    values = [_plain(given, name, value) for value in _flat(given.parameters.get(name))]
    return [value for value in values if value]


def _flat(value: Any) -> list:
    """Return single values: a model gives lists of lists, the command line a list or one path."""
    if isinstance(value, (list, tuple)):
        return [one for part in value for one in _flat(part)]
    return [value]


def _path(given: Given, name: str, value: Any) -> Path:
    title = given.title(name)
    if isinstance(value, str) and Path(value).is_file():
        return _known(title, Path(value))
    if isinstance(value, str) and (on_web := web_file(value)):
        return _known(title, on_web)
    find = QgsProcessingUtils.mapLayerFromString
    layer = value if isinstance(value, QgsMapLayer) else find(value, given.context, False)
    if layer is None:
        raise ValueError(f"{title} ({name}) must be a point cloud file or layer; nothing was found at {value}.")
    if not isinstance(layer, QgsPointCloudLayer):
        raise ValueError(
            f"{title} ({name}) must be a point cloud, got the layer {layer.name()!r}; choose a point cloud."
        )
    file = file_of_layer(layer)
    if file is None:
        raise ValueError(f"The layer {layer.name()!r} has no file ({layer.source()}); save it as LAZ first.")
    return _known(title, file)


def file_of_layer(layer: QgsPointCloudLayer) -> Optional[Path]:
    """Return the file of a point cloud layer, on this computer or on the web, None where it has none.

    Raises
    ------
    ValueError
        If the address of one on the web has a password in it.
    """
    return web_file(layer.source()) or (Path(layer.source()) if Path(layer.source()).is_file() else None)


def _known(title: str, path: Path) -> Path:
    if path.suffix.lower() not in SUFFIXES and (path.suffix or not is_on_web(path)):
        raise ValueError(
            f"{title} must be a .las, .laz, .copc.laz or .vpc file, ept.json or STAC items (.json), got {path.name}; "
            "convert it first."
        )
    return path


def names_of(value: Any) -> Optional[list]:
    """Return the sources of a list of layers and paths, without empty ones; None for any other value."""
    values = [one for one in _flat(value) if one is not None and one != ""]
    if not all(isinstance(one, (str, QgsMapLayer)) for one in values):
        return None
    return [one if isinstance(one, str) else one.source() for one in values]


def _plain(given: Given, name: str, value: Any) -> Any:
    """Return a parameter's value as a layer or text, whatever QGIS wrapped it in."""
    if isinstance(value, QgsProcessingOutputLayerDefinition):
        value = value.sink
    if isinstance(value, QgsProperty):
        value = replace(given, parameters={name: value}).read("String", name)
    if value is not None and not isinstance(value, (str, QgsMapLayer)):
        value = None if hasattr(value, "isNull") and value.isNull() else str(value)
    return value
