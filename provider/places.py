"""Where the local meters of a run are on the map."""

from dataclasses import dataclass

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem, QgsProcessingFeatureSource

from ..algorithms.cloud.cloud import Cloud, origin_before
from ..algorithms.cloud.crs import NO_CRS
from ..algorithms.stage import Monitor
from .qgis_crs import Conversion, crs_of, crs_of_layer, meters_per_unit


@dataclass(frozen=True)
class Place:
    """A CRS, and how local meters become coordinates in it."""

    crs: QgsCoordinateReferenceSystem  #: The CRS of the map
    to_map: Conversion  #: Turns local meters (m, 2 or 3) into coordinates
    from_map: Conversion  #: Turns coordinates (m, 2 or 3) into local meters
    unit: float = 1.0  #: Meters per unit in plan
    code: str = ""  #: Code of the CRS with its heights, "" without one


def place_of_cloud(cloud: Cloud) -> Place:
    """Return the place of what stages make of ``cloud``."""
    return Place(crs_of(cloud.crs.plane), cloud.to_map, cloud.from_map, cloud.crs.horizontal, cloud.crs.code)


def place_of_layer(title: str, layer: QgsProcessingFeatureSource, monitor: Monitor) -> Place:
    """Return the place of what a stage makes of layers alone: in the CRS of the first, from a round origin at its edge.

    Raises
    ------
    ValueError
        If the coordinates of the first layer are degrees.
    """
    crs = crs_of_layer(layer)
    refuse_degrees(title, crs)
    if not crs.isValid():
        monitor.warn(NO_CRS)
    plane, height = meters_per_unit(crs)
    units = np.array([plane, plane, height])
    extent = layer.sourceExtent()
    corner = (0.0, 0.0) if extent.isNull() else (extent.xMinimum(), extent.yMinimum())
    origin = origin_before(np.array(corner) * plane)

    def to_map(local: np.ndarray) -> np.ndarray:
        axes = np.shape(local)[-1]
        return (np.asarray(local, float) + origin[:axes]) / units[:axes]

    def from_map(coordinates: np.ndarray) -> np.ndarray:
        axes = np.shape(coordinates)[-1]
        return np.asarray(coordinates, float) * units[:axes] - origin[:axes]

    return Place(crs, to_map, from_map, plane, crs.authid())


def refuse_degrees(title: str, crs: QgsCoordinateReferenceSystem) -> None:
    """Refuse a CRS in which nothing can be measured.

    Raises
    ------
    ValueError
        If its coordinates are degrees.
    """
    if crs.isValid() and crs.isGeographic():
        raise ValueError(
            f"The coordinates of {title} are degrees ({crs.userFriendlyIdentifier()}); "
            "reproject the layer to a projected system in meters or feet first."
        )
