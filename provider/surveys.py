"""What algorithms on surveys have in common: where a survey lies, and the virtual point cloud over its tiles."""

from collections.abc import Iterable
from pathlib import Path
from typing import Optional

import numpy as np
from qgis.core import QgsCsException, QgsProcessingContext

from ..algorithms.cloud.outputs import VPC as VPC_SUFFIX
from ..algorithms.cloud.outputs import kind_of, same_file
from ..algorithms.cloud.vpc import write_vpc
from ..algorithms.stage import Monitor
from ..algorithms.tiling.survey import Survey
from .places import Place, place_of_cloud
from .qgis_crs import to_degrees

# The output that is the virtual point cloud.
VPC = "VPC"


def place_of_survey(survey: Survey) -> Place:
    """Return the place of the results of a survey."""
    return place_of_cloud(survey.cloud(np.zeros(1, survey.header.layout.dtype)))


def check_vpc(folder: Optional[Path], given: Iterable[Path]) -> None:
    """Refuse a folder of tiles, None for a temporary one, whose virtual point cloud would replace one that is read.

    ``given`` are the files and folders of the survey; virtual point clouds in a folder are read with it.

    Raises
    ------
    ValueError
        If there is such an input.
    """
    if folder is None:
        return
    made = _vpc_of(folder)
    for path in given:
        for read in path.iterdir() if path.is_dir() else (path,):
            if kind_of(read) == VPC_SUFFIX and same_file(read, made):
                raise ValueError(
                    f"{read.name} is an input, and the virtual point cloud over the tiles in {folder} would take its "
                    "place; choose another folder."
                )


def _vpc_of(folder: Path) -> Path:
    """Return the virtual point cloud over the tiles in a folder, named as the folder."""
    return folder / f"{folder.resolve().name}{VPC_SUFFIX}"


def write_survey(
    survey: Survey, tiles: list[Path], folder: Path, context: QgsProcessingContext, monitor: Monitor
) -> Path:
    """Write a virtual point cloud over tiles of a survey, named as their folder; return its path.

    Raises
    ------
    ValueError
        If it can't be written.
    """
    crs, path = place_of_survey(survey).crs, _vpc_of(folder)
    try:
        write_vpc(tiles, path, to_degrees(crs, context), survey.crs)
    except QgsCsException:
        # Coordinates far outside of the area of their system have no position in degrees.
        monitor.warn(
            f"Positions in {path.name} are not in degrees: they lie outside of {crs.userFriendlyIdentifier()}; "
            "check the coordinate reference system of the input."
        )
        write_vpc(tiles, path, None, survey.crs)
    return path
