"""Files of a run's own arrays, as numpy reads them: complete or not there."""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from zipfile import ZipFile

import numpy as np

from ..cloud.outputs import DiskFullError, replacing

_FULL = "The disk is full; free some space and start the same run again, which goes on with what was done."


def write_arrays(path: Path, arrays: Mapping[str, np.ndarray]) -> None:
    """Write arrays, which hold no objects, by name to an .npz file.

    numpy's own ``savez`` leaves the archive open where the disk is full, and Python complains when it takes it apart.

    Raises
    ------
    ValueError
        If the file can't be written.
    """
    try:
        with replacing(path) as stream, ZipFile(stream, "w") as archive:
            for name, values in arrays.items():
                # Its size is not known before, and may be more than 4 GB.
                with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                    np.lib.format.write_array(member, np.asanyarray(values), allow_pickle=False)
            archive.comment = _seal(archive)
    except DiskFullError as error:
        # Users don't see the hidden folder of these files.
        raise DiskFullError(_FULL) from error


def is_as_written(path: Path) -> bool:
    """Whether a file is one of :func:`write_arrays`, and nothing in it has changed since.

    Nothing of it is parsed before: an array that was planted or damaged may have any shape and type.
    """
    try:
        with ZipFile(path) as archive:
            # Other bytes may come before an archive for Python's reader, but for numpy the file is then a pickle.
            is_whole_file = archive.infolist()[0].header_offset == 0
            return is_whole_file and archive.comment == _seal(archive) and archive.testzip() is None
    except Exception:
        # Python's reader fails on damaged archives in a dozen ways, and all of them mean the same.
        return False


def _seal(archive: ZipFile) -> bytes:
    """Return a digest of the names, sizes and checksums of the arrays in a file."""
    members = [(one.filename, one.file_size, one.CRC) for one in archive.infolist()]
    return hashlib.sha256(repr(members).encode()).hexdigest().encode()
