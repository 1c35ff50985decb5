"""Points of LAS and LAZ files: read in chunks, written in chunks by laspy."""

from __future__ import annotations

from collections.abc import Iterator
from io import BufferedReader
from pathlib import Path
from typing import BinaryIO, Callable, Optional

import numpy as np

from ..geometry.groups import run_starts
from ..stage import Monitor
from .copc_index import has_index, read_index
from .header import Header, read_header, truncated
from .laspy_library import explained, need_laspy
from .laz import POINTS_PER_CHUNK, has_variable_chunks, open_chunks, open_laz, writing_backend

# Points that are read or written at once. A multiple of the LAZ chunk, so that every call decompresses whole chunks, in
# well under a second.
AT_ONCE = 10 * POINTS_PER_CHUNK

# Points that are all alike come to 5,500 bytes per compressed byte in chunks of the usual size; nothing sound has more.
_MOST_BYTES_PER_BYTE = 10_000

# Files without points that a warning names.
_NAMED = 5


def open_header(path: Path) -> Header:
    """Return the header of a file that has points, after its number of points was compared with the size of the file.

    Raises
    ------
    ValueError
        If there are no points, or more are promised than the file can hold.
    """
    header = _checked_header(path)
    if header.count == 0:
        raise ValueError(f"{path.name} has no points; choose another file.")
    return header


def open_headers(paths: list[Path], monitor: Optional[Monitor] = None) -> tuple[list[Path], list[Header]]:
    """Return those files of one cloud that have points, and their headers; the monitor is warned of the others.

    Surveys are delivered with a tile for each cell of their lattice, also where nothing was measured.

    Raises
    ------
    ValueError
        If one of the files can't be read, or none has points.
    """
    if len(paths) == 1:
        return paths, [open_header(paths[0])]
    headers = [_checked_header(path) for path in paths]
    empty = [path for path, header in zip(paths, headers) if header.count == 0]
    if len(empty) == len(paths):
        raise ValueError(f"None of the {len(paths)} tiles, {paths[0].name} and others, has points; choose others.")
    if empty and monitor:
        names = ", ".join(path.name for path in empty[:_NAMED]) + (", …" if len(empty) > _NAMED else "")
        monitor.warn(f"{len(empty)} of {len(paths)} tiles have no points and are left out: {names}.")
    found = [(path, header) for path, header in zip(paths, headers) if header.count]
    return [path for path, _ in found], [header for _, header in found]


def _checked_header(path: Path) -> Header:
    """Return the header of a file after its number of points was compared with the size of the file."""
    header = read_header(path)
    left = path.stat().st_size - header.points_at
    most = left * (_MOST_BYTES_PER_BYTE if header.is_compressed else 1) // header.layout.dtype.itemsize
    if header.count > most:
        raise truncated(path, f"it promises {header.count} points, but {left} bytes hold at most {most}")
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
            open_laz(path, header, stream)


def read_chunks(path: Path, header: Header, monitor: Monitor) -> Iterator[tuple[int, np.ndarray]]:
    """Yield (position of the first point, records) until all points are read; the array is used again."""
    buffer = np.empty(min(AT_ONCE, header.count), header.layout.dtype)
    for start, stop, read in _reads(path, header, monitor):
        points = buffer[: stop - start]
        read(points)
        yield start, points


def read_points(path: Path, header: Header, monitor: Monitor) -> np.ndarray:
    """Return all records of a file, structured (n,) as ``header.layout`` says, in the file's order."""
    try:
        points = np.empty(header.count, header.layout.dtype)
    except MemoryError:
        size = header.count * header.layout.dtype.itemsize / 1e9
        raise ValueError(
            f"{path.name} needs {size:.0f} GB of memory for its points, more than there is; cut it into tiles."
        ) from None
    for start, stop, read in _reads(path, header, monitor):
        read(points[start:stop])
    return points


def points_within(path: Path, header: Header, box: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return the records that lie within a box (2, 2) in plan, in the file's order; at its edges they are within.

    Parameters
    ----------
    path : Path
        The file.
    header : Header
        Its header.
    box : ndarray of shape (2, 2)
        Least and greatest easting and northing, in coordinates of the file.
    monitor : Monitor
        Receives the progress.
    """
    found = [np.empty(0, header.layout.dtype)]
    found += [chunk[is_within(chunk, header, box)] for _, chunk in chunks_near(path, header, box, monitor)]
    return np.concatenate(found)


def chunks_near(path: Path, header: Header, box: np.ndarray, monitor: Monitor) -> Iterator[tuple[int, np.ndarray]]:
    """Yield (position of the first point, records) of the parts of a file that may have points in a box (2, 2) in plan.

    Of a COPC file, where lazrs is installed, these are the chunks whose nodes touch the box. Of any other file they are
    all points if its bounds touch the box, none if not. The array is used again.

    Parameters
    ----------
    path : Path
        The file.
    header : Header
        Its header.
    box : ndarray of shape (2, 2)
        Least and greatest easting and northing, in coordinates of the file.
    monitor : Monitor
        Receives the progress.

    Raises
    ------
    ValueError
        If the file or its index is damaged.
    """
    # The bounds of some files are rounded.
    step = header.scale[:2]
    if (box[1] < header.low[:2] - step).any() or (box[0] > header.high[:2] + step).any():
        return
    if has_index(header) and has_variable_chunks(header):
        yield from _indexed(path, header, box, monitor)
    else:
        yield from read_chunks(path, header, monitor)


def _indexed(path: Path, header: Header, box: np.ndarray, monitor: Monitor) -> Iterator[tuple[int, np.ndarray]]:
    """Yield (position of the first point, records) of the chunks of a COPC file whose nodes touch a box."""
    with path.open("rb") as stream:
        chunks, read = open_chunks(path, header, stream)
        chunks = chunks[chunks[:, 2] > 0]
        wanted = np.flatnonzero(read_index(path, header, stream, chunks).touch(box))
        ends = np.cumsum(chunks[:, 2])
        for done, some in enumerate(parts := _portions(wanted, chunks[:, 2])):
            monitor.progress(done / len(parts))
            records = np.empty(int(chunks[some, 2].sum()), header.layout.dtype)
            read(chunks[some], records.view(np.uint8))
            yield int(ends[some[0]] - chunks[some[0], 2]), records
    monitor.progress(1.0)


def _portions(wanted: np.ndarray, points: np.ndarray) -> list[np.ndarray]:
    """Return the wanted chunks (m,) in portions: consecutive in the file, with about ``AT_ONCE`` points at most."""
    if not len(wanted):
        return []
    before = np.cumsum(points[wanted]) - points[wanted]
    # The same for chunks that follow each other in the file.
    run = wanted - np.arange(len(wanted))
    starts = np.union1d(run_starts(run), run_starts(before // AT_ONCE))
    return np.split(wanted, starts[1:])


def is_within(records: np.ndarray, header: Header, box: np.ndarray) -> np.ndarray:
    """Return which records (n,) lie within a box (2, 2) in plan, in the coordinates of the file."""
    within = np.ones(len(records), bool)
    for i, axis in enumerate("XY"):
        position = records[axis] * header.scale[i] + header.offset[i]
        within &= (position >= box[0, i]) & (position <= box[1, i])
    return within


def _reads(path: Path, header: Header, monitor: Monitor) -> Iterator[tuple[int, int, Callable]]:
    """Yield (start, stop, function that fills an array with these points), with progress between."""
    with path.open("rb") as stream:
        read = _compressed(path, header, stream) if header.is_compressed else _plain(path, header, stream)
        for start in range(0, header.count, AT_ONCE):
            monitor.progress(start / header.count)
            yield start, min(start + AT_ONCE, header.count), read
    monitor.progress(1.0)


def _compressed(path: Path, header: Header, stream: BinaryIO) -> Callable:
    """Return a function that fills an array with the points of LAZ that come next."""
    fill = open_laz(path, header, stream)

    def read(points: np.ndarray) -> None:
        with explained(path):
            fill(points.view(np.uint8))

    return read


def _plain(path: Path, header: Header, stream: BufferedReader) -> Callable:
    """Return a function that fills an array with the points that come next; laspy would copy them once more."""
    stream.seek(header.points_at)

    def read(points: np.ndarray) -> None:
        if stream.readinto(points.view(np.uint8).data) < points.nbytes:
            raise truncated(path, "it ends within its points")

    return read


def write_points(
    stream: BinaryIO, header: Header, chunks: Callable[[int, int], np.ndarray], compressed: bool, monitor: Monitor
) -> None:
    """Write a whole LAS or LAZ file to ``stream``: header, points, EVLRs.

    Parameters
    ----------
    stream : file
        New and empty.
    header : Header
        Its count, layout, VLRs and EVLRs are written; bounds and positions are found here.
    chunks : callable
        Gives the records from one position to another, laid out as the header says.
    compressed : bool
        LAZ instead of LAS.
    monitor : Monitor
        Receives progress.
    """
    backend = writing_backend(header.layout.point_format) if compressed else None
    las = need_laspy()
    writer = las.LasWriter(stream, header.las(), do_compress=compressed, laz_backend=backend, closefd=False)
    for start in range(0, header.count, AT_ONCE):
        monitor.progress(start / header.count)
        points = chunks(start, min(start + AT_ONCE, header.count))
        header.count_in(writer.header, points)
        writer.point_writer.write_points(header.layout.records(points))
    writer.close()
    if backend is las.LazBackend.Laszip:
        # laszip put its record before the other VLRs itself.
        stream.flush()
        laszip_record = read_header(Path(stream.name)).vlrs[0]
        writer.header.vlrs.append(las.vlrs.known.LasZipVlr(laszip_record.data))
    header.finish(stream, writer.header)
    monitor.progress(1.0)
