"""LAZ compression by lazrs, or by laszip where lazrs is not installed.

Both are called without laspy: laspy imports pyproj, whose wheels bring a PROJ of
their own into QGIS, and it writes the VLRs that it understands anew.
"""

from __future__ import annotations

import importlib
import io
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO, Optional

import numpy as np

from .formats import WITH_WAVEFORMS
from .header import LASZIP, Header, Record, read_header

# The size of LAZ chunks that laszip and lazrs use when nothing else is asked for.
POINTS_PER_CHUNK = 50_000
_POINTWISE = 1
_VARIABLE_CHUNKS = 2**32 - 1
_TABLE_POSITION, _TABLE_START = struct.Struct("<q"), struct.Struct("<II")


def _package(name: str) -> Optional[Any]:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        return None


def _lazrs_or_laszip() -> tuple[Any, Any]:
    lazrs = _package("lazrs")
    laszip = _package("laszip")
    if lazrs is None and laszip is None:
        raise ValueError(
            "LAZ files need the Python package lazrs, which is not installed; install lazrs, or use LAS files."
        )
    return lazrs, laszip


def need_lazrs() -> Any:
    """Return lazrs, which alone writes chunks of chosen sizes.

    Raises
    ------
    ValueError
        If it is not installed.
    """
    lazrs = _package("lazrs")
    if lazrs is None:
        raise ValueError("COPC files are written by the Python package lazrs, which is not installed; install lazrs.")
    return lazrs


@contextmanager
def explained(path: Path) -> Iterator[None]:
    """Turn whatever a LAZ library raises, panics of Rust included, into one sentence.

    Raises
    ------
    ValueError
        If the library failed.
    """
    try:
        yield
    except BaseException as error:
        # A panic in Rust is no Exception, and its class can't be imported.
        if type(error).__module__.split(".")[0] not in ("lazrs", "laszip", "pyo3_runtime"):
            raise
        raise ValueError(
            f"{path.name} is truncated or damaged: its points can't be decompressed; get the file again."
        ) from None


class Decompressor:
    """Points of a LAZ or COPC file, in the file's order."""

    def __init__(self, path: Path, header: Header, stream: BinaryIO) -> None:
        record = header.find(LASZIP)
        if record is None or record.data is None or len(record.data) < 34:
            raise ValueError(f"{path.name} is truncated or damaged: its LASzip record is missing; get the file again.")
        lazrs, laszip = _lazrs_or_laszip()
        self.path = path
        with explained(path):
            if lazrs is not None and record.data[0] != _POINTWISE:
                _check_chunks(path, header, record.data, stream)
                stream.seek(header.points_at)
                self._read = lazrs.ParLasZipDecompressor(stream, record.data).decompress_many
            elif laszip is not None:
                stream.seek(0)
                self._read = laszip.LasUnZipper(stream).decompress_into
            else:
                raise ValueError(
                    f"{path.name} is LAZ of an old kind (before 2011); install the package laszip to read it."
                )

    def read(self, points: np.ndarray) -> None:
        """Fill ``points``, a contiguous structured array, with the points that come next."""
        with explained(self.path):
            self._read(points.view(np.uint8))


def _check_chunks(path: Path, header: Header, vlr: bytes, stream: BinaryIO) -> None:
    """Hold the number of points against the chunk table before anything is allocated.

    A chunk starts with one whole record, so that their number is bounded by the
    file's size, and they hold a fixed number of points each (COPC: any number).
    """
    total = path.stat().st_size
    stream.seek(header.points_at)
    (position,) = _unpacked(path, _TABLE_POSITION, stream)
    if position == -1:
        # A writer that could not go back leaves the position in the last 8 bytes.
        stream.seek(total - _TABLE_POSITION.size)
        (position,) = _unpacked(path, _TABLE_POSITION, stream)
    if not header.points_at < position < total:
        raise ValueError(
            f"{path.name} is truncated: its chunk table should be at byte {position} of {total}; get the file again."
        )
    stream.seek(position)
    _, n_chunks = _unpacked(path, _TABLE_START, stream)
    per_chunk = struct.unpack_from("<I", vlr, 12)[0]
    if n_chunks * header.layout.dtype.itemsize > total:
        raise ValueError(f"{path.name} is damaged: {n_chunks} chunks can't stand in {total} bytes; get the file again.")
    if per_chunk != _VARIABLE_CHUNKS and header.count > n_chunks * per_chunk:
        raise ValueError(
            f"{path.name} promises {header.count} points, but its {n_chunks} chunks hold at most "
            f"{n_chunks * per_chunk}; it is truncated or damaged, get the file again."
        )


def _unpacked(path: Path, kind: struct.Struct, stream: BinaryIO) -> tuple:
    raw = stream.read(kind.size)
    if len(raw) < kind.size:
        raise ValueError(f"{path.name} is truncated: it ends before its chunk table; get the file again.")
    return kind.unpack(raw)


def check_compressible(point_format: int) -> None:
    """Refuse to compress what no installed package compresses well.

    lazrs 0.8 writes waveform references that laszip can't read (formats 4, 5) or
    that come back changed where there are several scanner channels (9, 10).

    Raises
    ------
    ValueError
        If the format has waveforms and laszip is not installed, or neither package is.
    """
    _, laszip = _lazrs_or_laszip()
    if point_format in WITH_WAVEFORMS and laszip is None:
        raise ValueError(
            f"LAZ with waveforms (point format {point_format}) is written by the Python package laszip, "
            "which is not installed; write .las instead or install laszip."
        )


class Compressor:
    """Points into a LAZ stream; the header, with the LASzip record in it, is written first."""

    def __init__(self, stream: BinaryIO, header: Header) -> None:
        check_compressible(header.layout.point_format)
        lazrs, laszip = _lazrs_or_laszip()
        self._by_laszip = lazrs is None or header.layout.point_format in WITH_WAVEFORMS
        self._stream, self._header = stream, header
        header.is_compressed = not self._by_laszip
        if not self._by_laszip:
            vlr = lazrs.LazVlr.new_for_compression(header.layout.point_format, header.layout.extra_size)
            header.vlrs = [*header.vlrs, laszip_record(vlr)]
            header.write(stream)
            self._zipper = lazrs.ParLasZipCompressor(stream, vlr)
            self._write = self._zipper.compress_many
        else:
            plain = io.BytesIO()
            # laszip writes the header itself; the EVLRs, which follow later, are not promised yet.
            replace(header, evlrs=[], evlrs_at=0, waveforms_at=0).write(plain)
            self._zipper = laszip.LasZipper(stream, plain.getvalue())
            self._write = self._zipper.compress

    def write(self, points: np.ndarray) -> None:
        """Compress ``points``, a contiguous structured array."""
        self._write(points.view(np.uint8))

    def done(self) -> None:
        """Write the last chunk and the chunk table; the stream then stands behind them."""
        self._zipper.done()
        if self._by_laszip:
            self._take_over()

    def _take_over(self) -> None:
        """Learn which record laszip added to the VLRs, so that the final header has it."""
        self._stream.flush()
        self._stream.seek(0, io.SEEK_END)
        made = read_header(Path(self._stream.name))
        self._header.vlrs = [*self._header.vlrs, *(record for record in made.vlrs if record.key == LASZIP)]
        self._header.gap, self._header.is_compressed = made.gap, True


def laszip_record(vlr: Any) -> Record:
    """Return the VLR that tells readers how lazrs compressed the points."""
    return Record(*LASZIP, bytes(vlr.record_data()), description=b"LASzip by lazrs")
