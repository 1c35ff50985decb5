"""Coordinate reference systems, looked up in QGIS."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Optional

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsMapLayer,
    QgsProcessingFeatureSource,
    QgsUnitTypes,
)
from qgis.PyQt.QtCore import QThread

# The variant of WKT that is written: WKT 2, as the default of QGIS, WKT 1, has no words for many systems.
FULL = QgsCoordinateReferenceSystem.WktVariant.WKT_PREFERRED
_NO_LENGTHS = (Qgis.DistanceUnit.Unknown, Qgis.DistanceUnit.Degrees)


def crs_units(epsg: int) -> Optional[tuple[float, float, bool]]:
    """Return meters per horizontal and vertical unit of an EPSG code, and whether it is geographic; None if unknown."""
    crs = QgsCoordinateReferenceSystem.fromEpsgId(epsg)
    if not crs.isValid():
        return None
    return (*meters_per_unit(crs), crs.isGeographic())


def meters_per_unit(crs: QgsCoordinateReferenceSystem) -> tuple[float, float]:
    """Return meters per horizontal and per vertical unit; heights have the unit of the plane where none is named."""
    horizontal = _meters(crs)
    return horizontal, _meters(crs.verticalCrs()) if crs.verticalCrs().isValid() else horizontal


def _meters(crs: QgsCoordinateReferenceSystem) -> float:
    """Return meters per unit of a CRS, 1 where it has no length as its unit."""
    unit = crs.mapUnits()
    return 1.0 if unit in _NO_LENGTHS else QgsUnitTypes.fromUnitToUnitFactor(unit, Qgis.DistanceUnit.Meters)


def crs_of(wkt: str) -> QgsCoordinateReferenceSystem:
    """Return the horizontal CRS that a cloud names as WKT or as "EPSG:n"; invalid when it names none."""
    crs = _made(wkt)
    if is_hollow(crs):
        QgsCoordinateReferenceSystem.invalidateCache()
        crs = _made(wkt)
    return crs


def code_in_space(wkt: str) -> str:
    """Return the code of the CRS that a cloud names, with its heights where it has a code with them ("EPSG:7415")."""
    return _whole(wkt).authid() or crs_of(wkt).authid()


def _whole(wkt: str) -> QgsCoordinateReferenceSystem:
    """Return the CRS that a cloud names, with its heights."""
    if not wkt:
        return QgsCoordinateReferenceSystem()
    return QgsCoordinateReferenceSystem.fromWkt(wkt) if '"' in wkt else QgsCoordinateReferenceSystem(wkt)


def _made(wkt: str) -> QgsCoordinateReferenceSystem:
    """Return the horizontal CRS that a cloud names, as QGIS has it, hollow or not."""
    crs = _whole(wkt)
    # Layers hold heights as an attribute or in meters of the cloud's own vertical system, which GeoPackage can't name.
    horizontal = crs.horizontalCrs()
    return horizontal if horizontal.isValid() else crs


def is_hollow(crs: QgsCoordinateReferenceSystem) -> bool:
    """Whether a CRS has lost its definition.

    QGIS frees the definition with the thread in which a CRS was made, half a minute after a run, but goes on giving
    that CRS to whoever asks for it. Files that are written with it have none.
    """
    return crs.isValid() and not crs.toWkt()


def make_in_main_thread(wkts: Iterable[str]) -> list[QgsCoordinateReferenceSystem]:
    """Make the CRS of a run in the main thread, before the run asks for them in its own; keep the returned object.

    Outside of the main thread nothing is made: a step of a model has them from the model.
    """
    if not is_main_thread():
        return []
    QgsCoordinateReferenceSystem.invalidateCache()
    made = [crs_of(wkt) for wkt in wkts]
    # Layers in memory look up their CRS by its code.
    return made + [QgsCoordinateReferenceSystem(crs.authid()) for crs in made if crs.authid()]


def renew_in_main_thread(layers: Iterable[QgsMapLayer]) -> None:
    """Give layers of a run their CRS again, made in the main thread: one that the run made ends with its thread."""
    if not is_main_thread():
        return
    named = [(layer, layer.crs().authid(), layer.crs().toWkt(FULL)) for layer in layers if layer.crs().isValid()]
    QgsCoordinateReferenceSystem.invalidateCache()
    for layer, code, wkt in named:
        layer.setCrs(QgsCoordinateReferenceSystem(code) if code else QgsCoordinateReferenceSystem.fromWkt(wkt))


def is_main_thread() -> bool:
    """Whether this is the thread of the application, and not that of a run."""
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
