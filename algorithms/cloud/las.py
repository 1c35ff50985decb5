"""Points of LAS and LAZ files: read in chunks, written in chunks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BufferedReader
from pathlib import Path
from typing import BinaryIO, Callable

import numpy as np

from ..stage import Monitor
from .header import LASZIP, Header, read_header
from .laz import POINTS_PER_CHUNK, Compressor, Decompressor

# A multiple of the LAZ chunk, so that every call decompresses whole chunks, in well under a second.
AT_ONCE = 10 * POINTS_PER_CHUNK
# Equal points compress to a few hundredths of a byte; nothing sound holds more points per byte than this.
_MOST_POINTS_PER_BYTE = 1000

# Gives the records from one position to another, laid out as the header says.
Source = Callable[[int, int], np.ndarray]


def open_header(path: Path) -> Header:
    """Return the header of a file that has points, its number of points held against the size of the file.

    Raises
    ------
    ValueError
        If there are no points, or more are promised than the file can hold.
    """
    header = read_header(path)
    if header.count == 0:
        raise ValueError(f"{path.name} has no points; choose another file.")
    left = path.stat().st_size - header.points_at
    most = left * _MOST_POINTS_PER_BYTE if header.is_compressed else left // header.layout.dtype.itemsize
    if header.count > most:
        raise ValueError(
            f"{path.name} promises {header.count} points, but {left} bytes hold at most {most}; "
            "it is truncated or damaged, get the file again."
        )
    return header


def check_points(path: Path, header: Header) -> None:
    """Refuse a file whose points can't be read from the start on, without reading them.

    Raises
    ------
    ValueError
        If it is LAZ and its record or chunk table is damaged, or the package for it is missing.
    """
    if header.is_compressed:
        with path.open("rb") as stream:
            Decompressor(path, header, stream)


def read_chunks(path: Path, header: Header, monitor: Monitor) -> Iterator[tuple[int, np.ndarray]]:
    """Yield (position of the first point, records) until all points are read; the array is used again."""
    buffer = np.empty(min(AT_ONCE, header.count), header.layout.dtype)
    for start, stop, read in _reads(path, header, monitor):
        points = buffer[: stop - start]
        read(points)
        yield start, points


def read_points(path: Path, header: Header, monitor: Monitor) -> np.ndarray:
    """Return all records of a file, structured (n,) as ``header.layout`` says, in the file's order."""
    points = _allocated(path, header)
    for start, stop, read in _reads(path, header, monitor):
        read(points[start:stop])
    return points


def _allocated(path: Path, header: Header) -> np.ndarray:
    try:
        return np.empty(header.count, header.layout.dtype)
    except MemoryError:
        size = header.count * header.layout.dtype.itemsize / 2**30
        raise ValueError(
            f"{path.name} needs {size:.0f} GB of memory for its points, more than there is; cut it into tiles."
        ) from None


def _reads(path: Path, header: Header, monitor: Monitor) -> Iterator[tuple[int, int, Callable]]:
    """Yield (start, stop, function that fills an array with these points), with progress between."""
    with path.open("rb") as stream:
        if header.is_compressed:
            read = Decompressor(path, header, stream).read
        else:
            stream.seek(header.points_at)
            read = _Plain(path, stream).read
        for start in range(0, header.count, AT_ONCE):
            monitor.progress(start / header.count)
            yield start, min(start + AT_ONCE, header.count), read
    monitor.progress(1.0)


class _Plain:
    """Points of an uncompressed file."""

    def __init__(self, path: Path, stream: BufferedReader) -> None:
        self.path, self.stream = path, stream

    def read(self, points: np.ndarray) -> None:
        if self.stream.readinto(points.view(np.uint8).data) < points.nbytes:
            raise ValueError(f"{self.path.name} is truncated: it ends within its points; get the file again.")


@dataclass
class Tally:
    """What a header says of the points, counted while they are written."""

    low: np.ndarray = field(default_factory=lambda: np.full(3, np.iinfo("i4").max))
    high: np.ndarray = field(default_factory=lambda: np.full(3, np.iinfo("i4").min))
    returns: np.ndarray = field(default_factory=lambda: np.zeros(16, int))

    def add(self, points: np.ndarray, header: Header) -> None:
        """Count ``points`` in."""
        for i, axis in enumerate("XYZ"):
            self.low[i] = min(self.low[i], points[axis].min())
            self.high[i] = max(self.high[i], points[axis].max())
        numbers = header.layout.get(points, "return_number")
        self.returns += np.bincount(numbers, minlength=16)[:16]

    def store(self, header: Header) -> None:
        """Put what was counted into ``header``."""
        ends = np.sort([self.low * header.scale + header.offset, self.high * header.scale + header.offset], axis=0)
        header.low, header.high = ends
        # LAS counts returns from 1; the few points of return 0 (unknown) are not counted anywhere.
        header.returns = tuple(int(n) for n in self.returns[1:])


def write_points(stream: BinaryIO, header: Header, records: Source, compressed: bool, monitor: Monitor) -> None:
    """Write a whole LAS or LAZ file to ``stream``: header, points, EVLRs.

    Parameters
    ----------
    stream : file
        New and empty.
    header : Header
        Its count, layout, VLRs and EVLRs are what is written; bounds and positions are found here.
    records : callable
        Gives the records from one position to another.
    compressed : bool
        LAZ instead of LAS.
    monitor : Monitor
        Hears progress.
    """
    header = header.without(LASZIP)
    tally = Tally()
    sink = Compressor(stream, header) if compressed else _PlainSink(stream, header)
    for start in range(0, header.count, AT_ONCE):
        monitor.progress(start / header.count)
        points = records(start, min(start + AT_ONCE, header.count))
        tally.add(points, header)
        sink.write(points)
    sink.done()
    finish(stream, header, tally)
    monitor.progress(1.0)


def finish(stream: BinaryIO, header: Header, tally: Tally) -> None:
    """Write the EVLRs behind the points and then the header, which now knows everything."""
    stream.seek(0, 2)
    header.write_evlrs(stream)
    tally.store(header)
    header.write(stream)


class _PlainSink:
    """Points into an uncompressed file."""

    def __init__(self, stream: BinaryIO, header: Header) -> None:
        self.stream = stream
        header.is_compressed = False
        header.write(stream)

    def write(self, points: np.ndarray) -> None:
        self.stream.write(points.view(np.uint8).data)

    def done(self) -> None:
        """Nothing is left to write."""
