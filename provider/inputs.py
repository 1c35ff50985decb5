"""Inputs and outputs that algorithms have in common: their names, titles and parameters."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional

import numpy as np
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsMapLayer,
    QgsProcessingFeedback,
    QgsProcessingParameterCrs,
    QgsProcessingParameterExtent,
    QgsProcessingParameterNumber,
    QgsProject,
)
from qgis.core import QgsProcessingParameterDefinition as Definition

from ..algorithms.cloud.dimensions import DIMENSIONS
from ..algorithms.stage import Declared, Stage
from ..algorithms.tiling.settings import READ_SETTINGS, Setting
from .caller import is_step
from .clouds import CloudParameter, CloudsParameter, cloud_path, cloud_paths
from .given import Given
from .parameters import is_given
from .qgis_crs import crs_of
from .styles import subject_of_file

INPUT, INPUTS, REFERENCE, OUTPUT, REPORT = "INPUT", "INPUTS", "REFERENCE", "OUTPUT", "REPORT"
EXTENT, SPACING, CRS = "EXTENT", "SPACING", "CRS"

# Bounds of the spacing of points, m: of close scans, and of the overview of a country.
SPACINGS = 0.001, 1000.0


def with_help(definition: Definition, text: str) -> Definition:
    """Return the parameter with its tooltip."""
    definition.setHelp(text)
    return definition


def with_setting(definition: Definition, settings: dict[str, Setting]) -> Definition:
    """Return the parameter with title and tooltip of its setting."""
    setting = settings[definition.name()]
    definition.setDescription(setting.title)
    return with_help(definition, setting.help)


def input_parameter(several: bool, title: str = "Point cloud", is_needed: bool = True) -> Definition:
    """Return the parameter of the cloud, or of the clouds, that a stage or chain works on."""
    if several:
        return with_help(CloudsParameter(INPUTS, "Point clouds"), "Files, layers or addresses on the web, one or more.")
    of_one = "File or layer of the points, or an address on the web (https://…) of COPC, EPT, VPC or STAC items."
    return with_help(CloudParameter(INPUT, title, optional=not is_needed), of_one)


def reference_parameter(stage: Stage) -> Definition:
    """Return the parameter of the second cloud that a stage reads."""
    definition = CloudParameter(REFERENCE, stage.reference_title, optional=not stage.needs_reference)
    return with_help(definition, f"File or layer. {stage.reference}")


def input_paths(given: Given, several: bool) -> list[Path]:
    """Return the file of the cloud, or the files of the clouds, that an algorithm works on."""
    return cloud_paths(given, INPUTS) if several else [cloud_path(given, INPUT)]


def extent_parameter() -> Definition:
    """Return the parameter of the part of the cloud that is worked on."""
    return with_setting(QgsProcessingParameterExtent(EXTENT, "", optional=True), READ_SETTINGS)


def spacing_parameter() -> Definition:
    """Return the parameter of the level of detail of the cloud that is worked on."""
    number = Qgis.ProcessingNumberParameterType.Double
    definition = QgsProcessingParameterNumber(SPACING, "", number, None, True, *SPACINGS)
    definition.setFlags(definition.flags() | Qgis.ProcessingParameterFlag.Advanced)
    return with_setting(definition, READ_SETTINGS)


def crs_parameter(default: Optional[str] = None) -> Definition:
    """Return the parameter of the coordinate reference system of clouds that name none."""
    definition = QgsProcessingParameterCrs(CRS, "Coordinate reference system", default, optional=True)
    definition.setFlags(definition.flags() | Qgis.ProcessingParameterFlag.Advanced)
    of_clouds = "Of clouds that name none, and of their results. Clouds that name one keep it."
    return with_help(definition, "Of the simulated cloud." if default else of_clouds)


def given_crs(given: Given) -> QgsCoordinateReferenceSystem:
    """Return the coordinate reference system that a user gives for clouds that name none; an invalid one if not given.

    Raises
    ------
    ValueError
        If coordinates of it are degrees, or it is unknown.
    """
    raw = given.parameters.get(CRS)
    crs = given.read("Crs", CRS)
    if not crs.isValid():
        if given.has(CRS) and not (isinstance(raw, QgsCoordinateReferenceSystem) or hasattr(raw, "isNull")):
            raise ValueError(f"{raw!r} ({CRS}) is no coordinate reference system; give it as EPSG:code.")
        return crs
    if crs.isGeographic():
        raise ValueError(
            f"Coordinates of {crs.userFriendlyIdentifier()} ({CRS}) are degrees; choose a projected coordinate "
            "reference system."
        )
    return crs


def extent_box(given: Given, plane: str) -> Optional[np.ndarray]:
    """Return the extent that a user gives, (2, 2) in the CRS ``plane`` of a cloud; None where none is given.

    An extent in another coordinate reference system becomes the box around it.

    Raises
    ------
    ValueError
        If the text is not an extent.
    """
    if not given.has(EXTENT):
        return None
    rectangle = given.read("Extent", EXTENT, crs_of(plane))
    if rectangle.isNull() or not rectangle.isFinite():
        raise ValueError(f"{given.parameters[EXTENT]!r} is not an extent; give it as xmin,xmax,ymin,ymax.")
    return np.array([[rectangle.xMinimum(), rectangle.yMinimum()], [rectangle.xMaximum(), rectangle.yMaximum()]])


def given_spacing(given: Given, factors: np.ndarray) -> Optional[np.ndarray]:
    """Return the spacing of the points that a user gives, in units of the axes; None where all points are read.

    ``factors`` (3,) are meters per unit.

    Raises
    ------
    ValueError
        If it is no number within the bounds.
    """
    raw = given.parameters.get(SPACING)
    if not is_given(raw):
        return None
    spacing, (low, high) = given.read("Double", SPACING), SPACINGS
    if not low <= spacing <= high:
        raise ValueError(f"{raw!r} ({SPACING}) is no spacing; give meters from {low:g} to {high:g}.")
    return spacing / factors


def refuse_same(clouds: Sequence[Path], reference: Path) -> None:
    """Refuse to compare a cloud with itself: a dialog begins with the same layer for both.

    Raises
    ------
    ValueError
        If the reference is one of the clouds.
    """
    if any(cloud.resolve() == reference.resolve() for cloud in clouds):
        raise ValueError(f"{reference.name} is the point cloud and its reference at once; choose two clouds.")


def name_of_layer(given: Any) -> str:
    """Return the name of the project's layer that a parameter gives, "" for files; asked in the main thread only."""
    layer = given if isinstance(given, QgsMapLayer) else QgsProject.instance().mapLayer(str(given))
    return layer.name() if layer is not None else ""


def subject_of(clouds: Sequence[Path], layer: str, feedback: QgsProcessingFeedback) -> str:
    """Return the subject of a run, after which its results are named: its layer, or else the file of its first cloud.

    It is "" for a step of a user's chain, which reads temporaries.
    """
    return (layer or subject_of_file(clouds[0])) if clouds and not is_step(feedback) else ""


def result_title(stage: Stage, declared: Declared) -> str:
    """Return the title of a result of a stage other than a cloud; a page has the title of the stage's report."""
    return stage.report_title if isinstance(declared, str) else declared.title


def cloud_title(stages: Sequence[Stage]) -> str:
    """Return what the cloud is called that these stages make one after the other, in the dialog and as a layer."""
    # Selections and mergers only pass on dimensions that the points had before.
    of_their_own = [stage for stage in stages if not (stage.selects or stage.merges)]
    writes = [name for stage in of_their_own for name in stage.writes]
    if any(stage.creates for stage in stages):
        return "Simulated point cloud"
    if all(stage.merges for stage in stages):
        return "Merged point cloud"
    if all(stage.selects for stage in stages):
        return "Selected points"
    if "classification" in writes:
        return "Classified point cloud"
    if len(writes) == 1:
        return f"Point cloud with {DIMENSIONS[writes[0]].disk[0]}"
    return "Point cloud with new dimensions"
