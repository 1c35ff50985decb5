"""Clouds that name no coordinate reference system get the one of the others of the run, or the one that is given."""

from collections.abc import Sequence
from pathlib import Path
from typing import Optional

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem

from ..algorithms.cloud.cloud import Cloud
from ..algorithms.cloud.crs import common_crs
from ..algorithms.cloud.files import read_cloud, read_extent
from ..algorithms.stage import Monitor
from .crs_authority import crs_reader, text_of

# CRS of simulated clouds unless the user gives one: World Mercator, whose meters near (0, 0) are those on the ground.
SIMULATED_CRS = "EPSG:3395"


def read_clouds(
    paths: Sequence[Path],
    monitors: Sequence[Monitor],
    given: QgsCoordinateReferenceSystem,
    box: Optional[np.ndarray],
    spacing: Optional[np.ndarray],
) -> list[Cloud]:
    """Return the clouds of files that are worked on together.

    Parameters
    ----------
    paths : sequence of Path
        The files.
    monitors : sequence of Monitor
        One for each of them.
    given : QgsCoordinateReferenceSystem
        Of clouds that name none; an invalid one adds nothing.
    box, spacing : ndarray, optional
        As of :func:`.read_cloud`.

    Raises
    ------
    ValueError
        As :func:`.read_cloud`, or if two have different systems.
    """
    read = crs_reader(given)
    if len(paths) > 1:
        systems = [read_extent(path, read, box)[2] for path in paths]
        leader = common_crs(systems, [path.name for path in paths], monitors[0], whole=False)
        read = crs_reader(given, leader.wkt or leader.stated)
    return [read_cloud(path, monitor, read, box, spacing) for path, monitor in zip(paths, monitors)]


def names_of_crs(crs: QgsCoordinateReferenceSystem) -> list[str]:
    """Return the text that the system of a cloud may have; none of an invalid one."""
    return [text_of(crs)] if crs.isValid() else []


def named(cloud: Cloud, crs: QgsCoordinateReferenceSystem) -> Cloud:
    """Return a cloud that was made with the coordinate reference system; an invalid one adds nothing."""
    return cloud.in_crs(crs_reader(crs)(cloud.header)) if crs.isValid() else cloud
