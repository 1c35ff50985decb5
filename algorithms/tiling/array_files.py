"""Files of a run's own arrays, as numpy reads them: complete or not there."""

from __future__ import annotations

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
    except DiskFullError as error:
        # Users don't see the hidden folder of these files.
        raise DiskFullError(_FULL) from error
