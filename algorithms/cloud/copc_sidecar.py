"""The COPC file next to a LAS or LAZ file, which QGIS shows in its place.

A view is such a file, written here together with the LAS or LAZ file and for QGIS only. Its header carries a digest of
both files' content. By it a view differs from any other COPC file, and from a view or a LAS file that somebody has
changed since: nothing but an untouched view may be lost.
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

from .header import SIZES
from .outputs import COPC, LAS, same_file

# What the header of a view says of the program that wrote it.
VIEW_SOFTWARE = "LiDAR Buildings view"
# Position and size (bytes) of the project id (GUID) in the header of LAS 1.4, which holds the digest of a view.
_DIGEST_AT, _DIGEST_SIZE = 8, 16
# Positions (bytes) in that header of the name of the writing program and of the offsets to points and EVLRs.
_SOFTWARE_AT, _POINTS_AT, _EVLRS_AT = 58, 96, 235


def copc_path(path: Path) -> Path:
    """Return the COPC file that QGIS looks for next to a LAS or LAZ file."""
    # ".las" is as long as ".laz".
    return path.with_name(path.name[: -len(LAS)] + COPC)


def check_copc_beside(path: Path, sources: Iterable[Path]) -> None:
    """Refuse a LAS or LAZ output in whose place QGIS would show a file that may not be replaced.

    Raises
    ------
    ValueError
        If the COPC file next to it is one of ``sources``, or anything but the untouched view of the file at ``path``.
    """
    beside = copc_path(path)
    if any(same_file(beside, source) for source in sources):
        raise ValueError(
            f"The output {path.name} would take the place of the input {beside.name} next to it; choose another name."
        )
    if beside.exists() and not is_view(beside, path):
        raise ValueError(
            f"{beside.name} lies next to the output {path.name}, and QGIS would show it instead; "
            "choose another name for the output, or move that file."
        )


def is_view(copc: Path, path: Path) -> bool:
    """Whether ``copc`` was written as the view of ``path``, and neither has changed since."""
    if not (copc.is_file() and path.is_file()):
        return False
    with copc.open("rb") as view, path.open("rb") as shown:
        header = view.read(SIZES[4])
        if len(header) < SIZES[4] or not header[_SOFTWARE_AT:].startswith(VIEW_SOFTWARE.encode()):
            return False
        return _digest(view, shown) == header[_DIGEST_AT : _DIGEST_AT + _DIGEST_SIZE]


def seal(view: BinaryIO, shown: BinaryIO) -> None:
    """Put the digest of a complete view, and of the LAS or LAZ file that it shows, into the view's header.

    Both streams can be read from any position.
    """
    digest = _digest(view, shown)
    view.seek(_DIGEST_AT)
    view.write(digest)


def _digest(view: BinaryIO, shown: BinaryIO) -> bytes:
    """Digest the view's points and all of the other file; QGIS may add statistics behind the points."""
    view.seek(_POINTS_AT)
    (start,) = struct.unpack("<I", view.read(4))
    view.seek(_EVLRS_AT)
    (stop,) = struct.unpack("<Q", view.read(8))
    digest = hashlib.blake2b(digest_size=_DIGEST_SIZE)
    for stream, first, last in ((view, start, stop), (shown, 0, shown.seek(0, 2))):
        stream.seek(first)
        # In portions of a megabyte large files need little memory.
        while block := stream.read(max(0, min(1 << 20, last - stream.tell()))):
            digest.update(block)
    return digest.digest()
