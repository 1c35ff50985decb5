"""The COPC file next to a LAS or LAZ file, which QGIS shows in its place.

A view is such a file, written here together with the LAS or LAZ file and for QGIS only. Its header carries a digest of
both files' content. By it a view differs from any other COPC file, and from a view or a LAS file that somebody has
changed since: nothing but an untouched view may be lost.
"""

import hashlib
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

import numpy as np

from .header import HEADER, bytes_of
from .outputs import COPC, LAS, PIECE, same_file

# What the header of a view says of the program that wrote it.
VIEW_SOFTWARE = "LiDAR Buildings view"
# Bytes of the project id (GUID) in the header, which holds the digest of a view.
_DIGEST = bytes_of("guid")


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
        header = view.read(HEADER.itemsize)
        if len(header) < HEADER.itemsize or not header[bytes_of("software")].startswith(VIEW_SOFTWARE.encode()):
            return False
        return _digest(view, shown) == header[_DIGEST]


def seal(view: BinaryIO, shown: BinaryIO) -> None:
    """Put the digest of a complete view, and of the LAS or LAZ file that it shows, into the view's header.

    Both streams can be read from any position.
    """
    digest = _digest(view, shown)
    view.seek(_DIGEST.start)
    view.write(digest)


def _digest(view: BinaryIO, shown: BinaryIO) -> bytes:
    """Digest the view's points and all of the other file; QGIS may add statistics behind the points."""
    view.seek(0)
    fields = np.frombuffer(view.read(HEADER.itemsize), HEADER)[0]
    digest = hashlib.blake2b(digest_size=HEADER["guid"].itemsize)
    parts = ((view, int(fields["points_at"]), int(fields["evlrs_at"])), (shown, 0, shown.seek(0, 2)))
    for stream, first, last in parts:
        stream.seek(first)
        while block := stream.read(max(0, min(PIECE, last - stream.tell()))):
            digest.update(block)
    return digest.digest()
