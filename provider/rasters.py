"""Rasters that stages make, as tiled and compressed GeoTIFF that is read in part and at any scale (COG)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from osgeo import gdal
from qgis.core import QgsCoordinateReferenceSystem

from ..algorithms.cloud.outputs import replacing
from ..algorithms.stage import Cancelled, Monitor, Raster, RasterSurface
from .memory_files import copy_file, memory_folder
from .places import Place

EXTENSIONS = ("tif", "tiff")
NO_DATA = -9999.0
_OPTIONS = (
    "COMPRESS=DEFLATE",
    "PREDICTOR=FLOATING_POINT",
    "OVERVIEW_RESAMPLING=AVERAGE",
    "BIGTIFF=IF_SAFER",
    "NUM_THREADS=ALL_CPUS",
)


def check_raster(path: Path) -> None:
    """Refuse a file name that is none of a GeoTIFF."""
    if path.suffix.lower().lstrip(".") not in EXTENSIONS:
        raise ValueError(f"{path.name} can't be written as a raster: give it the extension .tif.")


def write_raster(raster: Raster, surface: RasterSurface, place: Place, path: Path, monitor: Monitor) -> None:
    """Write a raster; the file appears when it is complete.

    Parameters
    ----------
    raster : Raster
        What it is.
    surface : RasterSurface
        Its values and where they are, in local meters.
    place : Place
        Where local meters are on the map.
    path : Path
        In an existing folder.
    monitor : Monitor
        Receives progress.

    Raises
    ------
    ValueError
        If GDAL can't make it, or it can't be written.
    """
    check_raster(path)
    progress = _Progress(monitor)
    with memory_folder() as folder:
        made = f"{folder}/{path.name}"
        with _errors(path, progress):
            image = _in_memory(raster, surface, place)
            written = gdal.GetDriverByName("COG").CreateCopy(made, image, 0, list(_OPTIONS), progress)
            if written is None:
                raise RuntimeError(gdal.GetLastErrorMsg())
            # Complete when it is closed.
            del written
        with replacing(path) as stream:
            copy_file(made, stream)


class _Progress:
    """What GDAL calls between blocks: it can be told to stop, but not by an exception."""

    def __init__(self, monitor: Monitor) -> None:
        self.monitor, self.is_cancelled = monitor, False

    def __call__(self, fraction: float, message: str, data: object) -> int:
        try:
            self.monitor.progress(fraction)
        except Cancelled:
            self.is_cancelled = True
        return 0 if self.is_cancelled else 1


@contextmanager
def _errors(path: Path, progress: _Progress) -> Iterator[None]:
    """Have GDAL raise here, whatever it does elsewhere in QGIS, and the program's own errors come of that."""
    before = gdal.GetUseExceptions()
    gdal.UseExceptions()
    try:
        yield
    except RuntimeError as error:
        if progress.is_cancelled:
            raise Cancelled from None
        raise ValueError(f"{path} can't be made ({error}); choose larger cells.") from error
    finally:
        if not before:
            gdal.DontUseExceptions()


def _in_memory(raster: Raster, surface: RasterSurface, place: Place) -> gdal.Dataset:
    rows, columns = surface.values.shape
    values = np.where(np.isfinite(surface.values), surface.values, np.float32(NO_DATA)).astype("<f4")
    image = gdal.GetDriverByName("MEM").Create("", columns, rows, 1, gdal.GDT_Float32)
    west, north = place.to_map(np.array([[surface.west, surface.north]]))[0].tolist()
    step = surface.cell_size / place.unit
    image.SetGeoTransform((west, step, 0.0, north, 0.0, -step))
    if place.crs.isValid():
        image.SetProjection(place.crs.toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT_PREFERRED_GDAL))
    band = image.GetRasterBand(1)
    band.SetDescription(raster.title)
    band.SetUnitType(raster.unit)
    band.SetNoDataValue(NO_DATA)
    # As bytes: GDAL's own way with arrays fails where another numpy was installed after it.
    band.WriteRaster(0, 0, columns, rows, values.tobytes(), buf_type=gdal.GDT_Float32)
    return image
