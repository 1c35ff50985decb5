"""Files that GDAL makes in memory before they are written to a disk, and its errors.

When a disk is full, GDAL fails at closing a file, where it reports no error. Files copied from memory by this module
are complete, or copying raises the error of the system.
"""

import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from osgeo import gdal, osr

from ..algorithms.cloud.outputs import PIECE, os_errors_as_messages


@contextmanager
def gdal_errors() -> Iterator[None]:
    """Have GDAL raise errors and print nothing, whatever it does elsewhere in QGIS."""
    before = osr.GetUseExceptions(), gdal.GetUseExceptions()
    osr.UseExceptions()
    gdal.UseExceptions()
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    try:
        yield
    finally:
        gdal.PopErrorHandler()
        # In the reverse order, or GDAL refuses.
        if not before[1]:
            gdal.DontUseExceptions()
        if not before[0]:
            osr.DontUseExceptions()


@contextmanager
def memory_folder() -> Iterator[str]:
    """Give the path of an empty folder in GDAL's memory, which is removed when the block ends."""
    folder = f"/vsimem/{uuid.uuid4().hex}"
    gdal.Mkdir(folder, 0o755)
    try:
        yield folder
    finally:
        gdal.RmdirRecursive(folder)


def copy_file(made: str, stream: BinaryIO) -> None:
    """Copy a file of GDAL's into a stream, piece by piece."""
    file = gdal.VSIFOpenL(made, "rb")
    try:
        while piece := gdal.VSIFReadL(1, PIECE, file):
            stream.write(piece)
    finally:
        gdal.VSIFCloseL(file)


def copy_folder(made: str, target: Path) -> None:
    """Copy all files of a folder in GDAL's memory into the folder of ``target``, the name of one of them.

    Raises
    ------
    ValueError
        If a file can't be written.
    """
    with os_errors_as_messages(target):
        for name in gdal.ReadDirRecursive(made) or ():
            path = target.parent / name
            if name.endswith("/"):
                path.mkdir(exist_ok=True)
                continue
            with path.open("wb") as stream:
                copy_file(f"{made}/{name}", stream)
