"""Coordinate reference systems, looked up in QGIS."""

from collections.abc import Iterable
from typing import Callable, Optional

import numpy as np
from qgis.core import (
    Qgis,
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsLineString,
    QgsMapLayer,
    QgsProcessingContext,
    QgsProcessingFeatureSource,
    QgsUnitTypes,
)
from qgis.PyQt.QtCore import QThread

from .crs_authority import text_of

WGS84 = "EPSG:4326"
# Turns positions (n, 2 or 3) of one system into those of another.
Conversion = Callable[[np.ndarray], np.ndarray]
_NO_LENGTHS = (Qgis.DistanceUnit.Unknown, Qgis.DistanceUnit.Degrees)


def meters_per_unit(crs: QgsCoordinateReferenceSystem) -> tuple[float, float]:
    """Return meters per horizontal and per vertical unit; heights have the unit of the plane where none is named."""
    horizontal = _meters(crs)
    return horizontal, _meters(crs.verticalCrs()) if crs.verticalCrs().isValid() else horizontal


def _meters(crs: QgsCoordinateReferenceSystem) -> float:
    """Return meters per unit of a CRS, 1 where it has no length as its unit."""
    unit = crs.mapUnits()
    return 1.0 if unit in _NO_LENGTHS else QgsUnitTypes.fromUnitToUnitFactor(unit, Qgis.DistanceUnit.Meters)


def crs_of(plane: str) -> QgsCoordinateReferenceSystem:
    """Return the CRS of layers of a cloud, by the horizontal part of its own (:attr:`.Crs.plane`); invalid for none."""
    crs = _made(plane)
    if is_hollow(crs):
        QgsCoordinateReferenceSystem.invalidateCache()
        crs = _made(plane)
    return crs


def _made(text: str) -> QgsCoordinateReferenceSystem:
    """Return the CRS of a text, as QGIS has it, hollow or not."""
    return QgsCoordinateReferenceSystem.fromWkt(text) if '"' in text else QgsCoordinateReferenceSystem(text)


def is_hollow(crs: QgsCoordinateReferenceSystem) -> bool:
    """Whether a CRS has lost its definition.

    QGIS frees the definition with the thread in which a CRS was made, half a minute after a run, but goes on giving
    that CRS to whoever asks for it. Files that are written with it have none.
    """
    return crs.isValid() and not crs.toWkt()


def make_in_main_thread(planes: Iterable[str]) -> list[QgsCoordinateReferenceSystem]:
    """Make the CRS of a run in the main thread, before the run asks for them in its own; keep the returned object.

    Outside of the main thread nothing is made: a step of a model has them from the model.
    """
    if not is_main_thread():
        return []
    QgsCoordinateReferenceSystem.invalidateCache()
    made = [crs_of(plane) for plane in planes]
    # Layers in memory look up their CRS by its code.
    return made + [QgsCoordinateReferenceSystem(crs.authid()) for crs in made if crs.authid()]


def renew_in_main_thread(layers: Iterable[QgsMapLayer]) -> None:
    """Give layers of a run their CRS again, made in the main thread: one that the run made ends with its thread."""
    if not is_main_thread():
        return
    named = [(layer, layer.crs().authid() or text_of(layer.crs())) for layer in layers if layer.crs().isValid()]
    QgsCoordinateReferenceSystem.invalidateCache()
    for layer, text in named:
        layer.setCrs(crs_of(text))


def to_degrees(crs: QgsCoordinateReferenceSystem, context: QgsProcessingContext) -> Optional[Conversion]:
    """Return what turns coordinates (n, 2) in a CRS into longitudes and latitudes; None for an invalid one."""
    change = QgsCoordinateTransform(crs, QgsCoordinateReferenceSystem(WGS84), context.transformContext())

    def transformed(coordinates: np.ndarray) -> np.ndarray:
        # As one line: a hundred times as fast as point by point.
        line = QgsLineString(*np.asarray(coordinates).T.tolist())
        line.transform(change)
        found = np.frombuffer(bytes(line.asWkb()), "<f8", offset=9).reshape(-1, 2)
        if not np.isfinite(found).all():
            # Of points QGIS says so itself.
            raise QgsCsException("Coordinates lie outside of their system.")
        return found

    return transformed if crs.isValid() else None


def is_main_thread() -> bool:
    """Whether this is the thread of the application, and not of a run."""
    return QThread.currentThread() == QgsApplication.instance().thread()


def crs_of_layer(layer: QgsProcessingFeatureSource) -> QgsCoordinateReferenceSystem:
    """Return the CRS of a layer, invalid when it names none.

    QGIS reads a GeoPackage without a CRS as one in "Undefined geographic SRS", as the standard of GeoPackage calls it,
    and takes this for a valid CRS. Reprojecting to or from it would make degrees of meters.
    """
    crs = layer.sourceCrs()
    if is_hollow(crs):
        return crs_of(crs.authid())
    return QgsCoordinateReferenceSystem() if crs.description().lower().startswith("undefined ") else crs
