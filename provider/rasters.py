"""Rasters that stages make, as tiled and compressed GeoTIFF that is read in part and at any scale (COG)."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from osgeo import gdal
from qgis.core import QgsCoordinateReferenceSystem

from ..algorithms.cloud.outputs import os_errors_as_messages, replacing
from ..algorithms.criteria import NO_DATA
from ..algorithms.stage import Cancelled, Monitor, Raster, RasterSurface
from ..algorithms.tiling.joining import RasterMosaic
from .memory_files import copy_file, gdal_errors, memory_folder
from .places import Place

# Extensions of file names that are written, the first one by default.
EXTENSIONS = ("tif", "tiff")


# Options of GDAL's driver COG. With IF_SAFER files that might pass 4 GB become BigTIFF.
_OPTIONS = (
    "COMPRESS=DEFLATE",
    "PREDICTOR=FLOATING_POINT",
    "OVERVIEW_RESAMPLING=AVERAGE",
    "BIGTIFF=IF_SAFER",
    "NUM_THREADS=ALL_CPUS",
)


def check_raster(path: Path) -> None:
    """Refuse a file name that is not a GeoTIFF's.

    Raises
    ------
    ValueError
        If its extension is another.
    """
    if path.suffix.lower().lstrip(".") not in EXTENSIONS:
        raise ValueError(f"{path.name} can't be written as a raster: give it the extension .tif.")


def write_mosaic(raster: Raster, mosaic: RasterMosaic, place: Place, path: Path, monitor: Monitor) -> None:
    """Write a raster of any size, part by part; memory does not grow with it.

    ``mosaic`` has the values in parts; the other parameters and the errors are as of :func:`write_raster`.
    """
    check_raster(path)
    progress = _Progress(monitor)
    with tempfile.TemporaryDirectory(prefix=".raster-", dir=path.parent) as folder, _errors(path, progress):
        parts, whole = Path(folder) / "parts.tif", Path(folder) / path.name
        rows, columns = mosaic.shape
        # Parts that are empty take no space.
        options = ["TILED=YES", "SPARSE_OK=TRUE", "BIGTIFF=IF_SAFER", "COMPRESS=LZW"]
        image = gdal.GetDriverByName("GTiff").Create(str(parts), columns, rows, 1, gdal.GDT_Float32, options)
        _describe(image, raster, (mosaic.west, mosaic.north, mosaic.cell_size), place)
        band = image.GetRasterBand(1)
        for row, column, values in mosaic:
            # Ends the run here if the user has cancelled it.
            monitor.progress(0.0)
            height, width = values.shape
            band.WriteRaster(column, row, width, height, _filled(values), buf_type=gdal.GDT_Float32)
        image.FlushCache()
        _copy(image, str(whole), progress)
        del band, image
        with os_errors_as_messages(path):
            whole.replace(path)


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
            _copy(_in_memory(raster, surface, place), made, progress)
        with replacing(path) as stream:
            copy_file(made, stream)


class _Progress:
    """What GDAL calls between blocks: its result can stop GDAL, an exception can't."""

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
    """Have GDAL raise errors, and raise the program's own in their place."""
    try:
        with gdal_errors():
            yield
    except RuntimeError as error:
        if progress.is_cancelled:
            raise Cancelled from None
        raise ValueError(f"{path} can't be made ({error}); choose larger cells.") from error


def _copy(image: gdal.Dataset, path: str, progress: _Progress) -> None:
    """Write an image as a COG, which is complete when this returns: its end is written as the copy is closed."""
    if gdal.GetDriverByName("COG").CreateCopy(path, image, 0, list(_OPTIONS), progress) is None:
        raise RuntimeError(gdal.GetLastErrorMsg())


def _in_memory(raster: Raster, surface: RasterSurface, place: Place) -> gdal.Dataset:
    """Return an image in memory with the values of a surface."""
    rows, columns = surface.values.shape
    image = gdal.GetDriverByName("MEM").Create("", columns, rows, 1, gdal.GDT_Float32)
    _describe(image, raster, (surface.west, surface.north, surface.cell_size), place)
    # As bytes: GDAL's own way with arrays fails where another numpy was installed after it.
    image.GetRasterBand(1).WriteRaster(0, 0, columns, rows, _filled(surface.values), buf_type=gdal.GDT_Float32)
    return image


def _filled(values: np.ndarray) -> bytes:
    """Return cells as they are written: little-endian float32, ``NO_DATA`` where they are not finite."""
    return np.where(np.isfinite(values), values, np.float32(NO_DATA)).astype("<f4").tobytes()


def _describe(image: gdal.Dataset, raster: Raster, lattice: tuple[float, float, float], place: Place) -> None:
    """Set where the cells of an image are, by western and northern edge and size in local meters, and their kind."""
    west, north, size = lattice
    west, north = place.to_map(np.array([[west, north]]))[0].tolist()
    step = size / place.unit
    image.SetGeoTransform((west, step, 0.0, north, 0.0, -step))
    if place.crs.isValid():
        image.SetProjection(place.crs.toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT_PREFERRED_GDAL))
    band = image.GetRasterBand(1)
    band.SetDescription(raster.title)
    band.SetUnitType(raster.unit)
    band.SetNoDataValue(NO_DATA)
