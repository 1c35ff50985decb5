"""Coordinate reference systems of clouds, made and compared by the libraries of QGIS.

QGIS's own class has no way to leave out the third axis of a system, knows no GeoKeys, and loses its definition with the
thread that made it (see :func:`.crs.is_hollow`). GDAL, by which QGIS reads and writes layers, has none of these faults.
"""

import struct
from functools import lru_cache, partial
from typing import Optional

import numpy as np
from osgeo import gdal, osr
from qgis.core import QgsCoordinateReferenceSystem

from ..algorithms.cloud import authority
from ..algorithms.cloud.crs import CrsReader, read_crs
from .memory_files import gdal_errors, memory_folder

# LAS 1.4 asks for WKT 1; WKT 2 has words for all systems.
_WKT1, _WKT2 = ["FORMAT=WKT1_GDAL"], ["FORMAT=WKT2_2019"]
# GDAL's option to read the keys of heights, too.
_WITH_HEIGHTS = "GTIFF_REPORT_COMPD_CS"
# Type (TIFF's own code) and size in bytes of the values of GeoKeys' three tags.
_TAGS = {34735: (3, 2), 34736: (12, 8), 34737: (2, 1)}
# Tags of an image of one byte: width, height, bits, no compression, black is zero, position, rows and bytes.
_IMAGE = ((256, 1), (257, 1), (258, 8), (259, 1), (262, 1), (273, 0), (278, 1), (279, 1))


def crs_reader(given: QgsCoordinateReferenceSystem, otherwise: str = "") -> CrsReader:
    """Return what makes the systems of clouds; files that name none have the ``given`` one if it is valid."""
    return partial(read_crs, given=text_of(given) if given.isValid() else otherwise)


def text_of(crs: QgsCoordinateReferenceSystem) -> str:
    """Return the code of a system of QGIS, its WKT where GeoKeys can't hold the code."""
    is_code = crs.authid().startswith("EPSG:")
    return crs.authid() if is_code else crs.toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT_PREFERRED)


class _Gdal:
    """Systems by GDAL."""

    @lru_cache(maxsize=256)  # noqa: B019 - there is one for the life of the process
    def define(self, text: str, keys: tuple[tuple[int, bytes], ...] = ()) -> Optional[authority.Definition]:
        # As texts, which outlive the thread.
        try:
            with gdal_errors():
                whole = _system(text) if text else _of_keys(keys)
                return None if whole is None else _definition(whole)
        except RuntimeError:
            return None

    def to_radians(self, plane: str, positions: np.ndarray) -> tuple[np.ndarray, Optional[authority.Area]]:
        nowhere = np.full(np.shape(positions), np.inf)
        with gdal_errors():
            system = _system(plane)
            if not system.IsProjected():
                return nowhere, None
            found = system.GetAreaOfUse()
            corners = "west_lon_degree", "south_lat_degree", "east_lon_degree", "north_lat_degree"
            area = authority.Area(*(getattr(found, corner) for corner in corners)) if found else None
            on_ellipsoid = system.CloneGeogCS()
            for one in (system, on_ellipsoid):
                one.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
            try:
                change = osr.CoordinateTransformation(system, on_ellipsoid)
                made = np.array(change.TransformPoints(positions.tolist()))[:, :2]
            except RuntimeError:
                # Coordinates that the system has no place for, or a method without some of its parameters.
                return nowhere, area
            return made * on_ellipsoid.GetAngularUnits(), area


GDAL = _Gdal()
authority.use_authority(GDAL)


def _system(text: str) -> osr.SpatialReference:
    """Return the system of WKT or of a code; WKT is taken for nothing else, such as an address."""
    system = osr.SpatialReference()
    if '"' in text:
        system.ImportFromWkt(text)
    else:
        system.SetFromUserInput(text)
    return system


def _definition(whole: osr.SpatialReference) -> authority.Definition:
    system = whole.Clone()
    if system.IsCompound():
        system.StripVertical()
    system.DemoteTo2D()
    if not (system.IsProjected() or system.IsLocal()):
        return authority.Definition(_written(whole), "", _code(whole), "")
    own, wkt = _code(system), system.ExportToWkt(_WKT2)
    bare = _system(authority.nameless(wkt))
    found = [one.GetAuthorityCode(None) for one in _same(bare) if one.GetAuthorityName(None) == "EPSG"]
    identity = authority.identity_of(found, system.ExportToProj4() if system.IsProjected() else wkt)
    own = own or (identity if identity.startswith("EPSG:") else "")
    return authority.Definition(_written(whole), own or authority.without_code(wkt), _code(whole) or own, identity)


def _same(system: osr.SpatialReference) -> list[osr.SpatialReference]:
    """Return the systems of the database that are the same."""
    return [one for one, confidence in system.FindMatches() if confidence >= authority.SAME_PLANE]


def _code(system: osr.SpatialReference) -> str:
    """Return the code of a system, of the EPSG registry before others; "" where it has none."""
    names = [f"{one.GetAuthorityName(None)}:{one.GetAuthorityCode(None)}" for one in _same(system)]
    known = [name for name in names if "None" not in name]
    return next((name for name in known if name.startswith("EPSG:")), known[0] if known else "")


def _written(whole: osr.SpatialReference) -> str:
    """Return a system as text; its own code is left out where its parameters contradict it."""
    try:
        wkt = whole.ExportToWkt(_WKT1) or whole.ExportToWkt(_WKT2)
    except RuntimeError:
        wkt = whole.ExportToWkt(_WKT2)
    stated = whole.GetAuthorityCode(None)
    return authority.without_code(wkt) if stated and not _code(whole).endswith(f":{stated}") else wkt


def _of_keys(keys: tuple[tuple[int, bytes], ...]) -> Optional[osr.SpatialReference]:
    """Return the system of GeoKeys, which GDAL reads from an image of one byte: from their parameters, too."""
    before = gdal.GetConfigOption(_WITH_HEIGHTS)
    gdal.SetConfigOption(_WITH_HEIGHTS, "YES")
    try:
        with memory_folder() as folder:
            gdal.FileFromMemBuffer(f"{folder}/keys.tif", _image(keys))
            found = gdal.Open(f"{folder}/keys.tif").GetSpatialRef()
            return None if found is None else found.Clone()
    finally:
        gdal.SetConfigOption(_WITH_HEIGHTS, before)


def _image(keys: tuple[tuple[int, bytes], ...]) -> bytes:
    """Return a TIFF of one byte with GeoKeys."""
    tags = [(tag, 4, 1, struct.pack("<I", value)) for tag, value in _IMAGE]
    tags += [(tag, *_TAGS[tag][:1], len(data) // _TAGS[tag][1], data) for tag, data in keys if data]
    directory, values = b"", b""
    for tag, kind, count, data in tags:
        at = struct.pack("<I", 8 + 2 + 12 * len(tags) + 4 + len(values)) if len(data) > 4 else data.ljust(4, b"\0")
        directory += struct.pack("<HHI", tag, kind, count) + at
        values += data + b"\0" * (len(data) % 2) if len(data) > 4 else b""
    return struct.pack("<2sHIH", b"II", 42, 8, len(tags)) + directory + bytes(4) + values
