"""Clouds that name no coordinate reference system get the one that the user gives."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem

from ..algorithms.cloud.cloud import Cloud
from ..algorithms.cloud.files import read_cloud, with_crs
from ..algorithms.cloud.units import NO_CRS
from ..algorithms.stage import Monitor, ProgressOnly
from .crs import FULL, crs_units

# CRS of simulated clouds unless the user gives one: UTM zone 31, in which coordinates near (0, 0) are valid, too.
SIMULATED_CRS = "EPSG:32631"


def read_named(path: Path, monitor: Monitor, crs: QgsCoordinateReferenceSystem, box: Optional[np.ndarray]) -> Cloud:
    """Return the cloud of a file, with the given system where it names none; an invalid one adds nothing.

    Raises
    ------
    ValueError
        As :func:`.read_cloud`.
    """
    if not crs.isValid():
        return read_cloud(path, monitor, crs_units, box)
    quietly = ProgressOnly(monitor)
    cloud = named(read_cloud(path, quietly, crs_units, box), crs)
    for warning in quietly.warnings:
        if warning != NO_CRS:
            monitor.warn(warning)
    return cloud


def names_of_crs(crs: QgsCoordinateReferenceSystem) -> list[str]:
    """Return the names that a cloud may have for a system, WKT and code; no names of an invalid one."""
    return [name for name in (crs.toWkt(FULL), crs.authid()) if name] if crs.isValid() else []


def named(cloud: Cloud, crs: QgsCoordinateReferenceSystem) -> Cloud:
    """Return a cloud with the coordinate reference system where it names none; an invalid one adds nothing."""
    return with_crs(cloud, crs.toWkt(FULL), code_of(crs), crs_units) if crs.isValid() else cloud


def code_of(crs: QgsCoordinateReferenceSystem) -> str:
    """Return the code by which old point formats name a system, "" where it has none."""
    return crs.authid() if crs.authid().startswith("EPSG:") else ""
