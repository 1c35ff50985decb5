"""What algorithms on surveys have in common: where a survey lies, and the virtual point cloud over its tiles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsPointXY, QgsProcessingContext

from ..algorithms.cloud.vpc import write_vpc
from ..algorithms.tiling.survey import Survey
from .places import Place, place_of_cloud

# The output that is the virtual point cloud.
VPC = "VPC"
WGS84 = "EPSG:4326"


def place_of_survey(survey: Survey) -> Place:
    """Return the place of what is made of a survey."""
    return place_of_cloud(survey.cloud(np.zeros(1, survey.header.layout.dtype)))


def write_survey(survey: Survey, tiles: list[Path], folder: Path, context: QgsProcessingContext) -> Path:
    """Write a virtual point cloud over tiles of a survey, named as their folder; return its path.

    Raises
    ------
    ValueError
        If it can't be written.
    """
    crs, to_degrees = place_of_survey(survey).crs, None
    if crs.isValid():
        change = QgsCoordinateTransform(crs, QgsCoordinateReferenceSystem(WGS84), context.transformContext())

        def to_degrees(coordinates: np.ndarray) -> np.ndarray:
            there = [change.transform(QgsPointXY(*place)) for place in coordinates.tolist()]
            return np.array([(place.x(), place.y()) for place in there])

    path = folder / f"{folder.name}.vpc"
    write_vpc(tiles, path, to_degrees)
    return path
