"""Coordinate reference systems, which only QGIS knows."""

from __future__ import annotations

from typing import Optional

from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsProcessingFeatureSource, QgsUnitTypes

_DISTANCES_UNKNOWN = (Qgis.DistanceUnit.Unknown, Qgis.DistanceUnit.Degrees)


def crs_units(epsg: int) -> Optional[tuple[float, float, bool]]:
    """Look an EPSG code up.

    Returns
    -------
    (float, float, bool) or None
        Meters per horizontal unit, meters per vertical unit, whether it is geographic; None if unknown.
    """
    crs = QgsCoordinateReferenceSystem.fromEpsgId(epsg)
    if not crs.isValid():
        return None
    return (*meters_per_unit(crs), crs.isGeographic())


def meters_per_unit(crs: QgsCoordinateReferenceSystem) -> tuple[float, float]:
    """Return meters per horizontal and per vertical unit; heights have the unit of the plane where none is named."""
    horizontal = _meters(crs)
    return horizontal, _meters(crs.verticalCrs()) if crs.verticalCrs().isValid() else horizontal


def _meters(crs: QgsCoordinateReferenceSystem) -> float:
    unit = crs.mapUnits()
    return 1.0 if unit in _DISTANCES_UNKNOWN else QgsUnitTypes.fromUnitToUnitFactor(unit, Qgis.DistanceUnit.Meters)


def crs_of(wkt: str) -> QgsCoordinateReferenceSystem:
    """Return the horizontal CRS that a cloud names as WKT or as "EPSG:n"; invalid when it names none."""
    crs = QgsCoordinateReferenceSystem()
    if wkt:
        crs = QgsCoordinateReferenceSystem.fromWkt(wkt) if '"' in wkt else QgsCoordinateReferenceSystem(wkt)
    # Layers hold heights as an attribute or in meters of the cloud's own vertical system, which GeoPackage can't name.
    horizontal = crs.horizontalCrs()
    return horizontal if horizontal.isValid() else crs


def crs_of_layer(layer: QgsProcessingFeatureSource) -> QgsCoordinateReferenceSystem:
    """Return the CRS of a layer, invalid when it names none.

    A GeoPackage without a CRS comes back from disk in an "Undefined geographic SRS", by the name that its standard
    gives it, which QGIS holds for valid; reprojecting to or from it would make degrees of meters.
    """
    crs = layer.sourceCrs()
    return QgsCoordinateReferenceSystem() if crs.description().lower().startswith("undefined ") else crs
