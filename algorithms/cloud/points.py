"""Points of LAS and LAZ files: read in chunks, written in chunks by laspy."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from io import DEFAULT_BUFFER_SIZE, BufferedReader
from pathlib import Path
from typing import Any, BinaryIO, Callable, Optional, Union

import numpy as np

from ..geometry.groups import run_starts
from ..geometry.sparse_voxels import one_per_voxel
from ..stage import Monitor
from .copc_index import has_index, read_index
from .ept import Ept, EptOctree, is_ept
from .header import Header, read_header, truncated
from .laspy_library import explained, need_laspy
from .laz import POINTS_PER_CHUNK, first_records, has_variable_chunks, open_chunks, open_laz, writing_backend
from .octree import FETCHED, fetched_to
from .outputs import KeptFailure
from .point_records import fill_merged
from .web_file import WebStream, is_on_web

# Points that are read or written at once. A multiple of the LAZ chunk, so that every call decompresses whole chunks, in
# well under a second.
AT_ONCE = 10 * POINTS_PER_CHUNK

# Files that a warning names.
_NAMED = 5

# Number of points, spread over a file, that are checked against the bounds in its header before anything is read.
_PROBES = 16

# A box in plan that all points lie in.
EVERYWHERE = np.array([[-np.inf, -np.inf], [np.inf, np.inf]])


def open_header(path: Path) -> Header:
    """Return the header of a file that has points, after its number of points was compared with the size of the file.

    Bounds that can't be, as they are no numbers or points lie outside, are replaced by the points' bounds.

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

    Surveys are delivered with a tile for each cell of their lattice, also where nothing was measured. Headers have
    bounds that can be, see :func:`open_header`; the monitor is warned of those that were measured.

    Raises
    ------
    ValueError
        If one of the files can't be read, or none has points.
    """
    headers = [open_header(paths[0])] if len(paths) == 1 else [_checked_header(path) for path in paths]
    empty = [path for path, header in zip(paths, headers) if header.count == 0]
    if len(empty) == len(paths):
        raise ValueError(f"None of the {len(paths)} tiles, {paths[0].name} and others, has points; choose others.")
    if empty and monitor:
        monitor.warn(f"{len(empty)} of {len(paths)} tiles have no points and are left out: {_names(empty)}.")
    measured = [path for path, header in zip(paths, headers) if header.is_measured]
    if measured and monitor:
        monitor.warn(
            f"The bounds in the header of {_names(measured)} don't fit the points; they were measured instead."
        )
    found = [(path, header) for path, header in zip(paths, headers) if header.count]
    return [path for path, _ in found], [header for _, header in found]


def _names(paths: list[Path]) -> str:
    """Return the names of files for a warning, the first ones of many."""
    return ", ".join(path.name for path in paths[:_NAMED]) + (", …" if len(paths) > _NAMED else "")


def _checked_header(path: Path) -> Header:
    """Return the header of a file after its number of points and its bounds were checked against the file."""
    if is_ept(path):
        return Ept(path).header(_held_header)
    header = _held_header(path)
    if is_on_web(path):
        if not np.isfinite([header.low, header.high]).all():
            raise truncated(path, "the bounds in its header are no numbers")
        return header
    state = path.stat()
    if header.count == 0 or (measured := _measured(path, state.st_size, state.st_mtime_ns)) is None:
        return header
    return replace(header, low=measured[0], high=measured[1], is_measured=True)


def _held_header(path: Path) -> Header:
    """Return the header of a file after its number of points was held against its size."""
    header = read_header(path)
    left = path.stat().st_size - header.points_at
    # Points that are all alike come to 5,500 bytes per compressed byte in chunks of the usual size; nothing sound has
    # more.
    most = left * (10_000 if header.is_compressed else 1) // header.layout.dtype.itemsize
    if header.count > most:
        raise truncated(path, f"it promises {header.count} points, but {left} bytes hold at most {most}")
    return header


@lru_cache(maxsize=1024)
def _measured(path: Path, size: int, changed: int) -> Optional[tuple[np.ndarray, np.ndarray]]:  # noqa: ARG001
    """Return the bounds (3,) of the points of a file, low and high; None if those in its header can be.

    ``size`` and ``changed`` are the state of the file, for which the answer is kept.
    """
    header = read_header(path)
    if _can_be(header, *bounds_of(_probes(path, header), header)):
        return None
    found = [bounds_of(points, header) for _, points in read_chunks(path, header, Monitor())]
    low, high = np.min(found, axis=(0, 1)), np.max(found, axis=(0, 1))
    return None if _can_be(header, low, high) else (low, high)


def _can_be(header: Header, low: np.ndarray, high: np.ndarray) -> bool:
    """Whether the bounds in a header fit a file whose points reach from ``low`` to ``high`` (3,)."""
    if not np.isfinite([header.low, header.high]).all():
        return False
    # The bounds of some files are rounded.
    holds = (header.low - header.scale <= low) & (header.high + header.scale >= high)
    # If points take less than this share of the stated extent on an axis, all are measured: a bound that was never set
    # is 0, thousands of kilometers from the points.
    return bool((holds & (high - low >= 0.01 * (header.high - header.low))).all())


def bounds_of(points: np.ndarray, header: Header) -> np.ndarray:
    """Return the least and the greatest coordinates (2, 3) of records (n,)."""
    ends = np.array([[points[axis].min(), points[axis].max()] for axis in "XYZ"], float).T
    return ends * header.scale + header.offset


def _probes(path: Path, header: Header) -> np.ndarray:
    """Return some records of a file, spread over it; of LAZ those that chunks begin with, which are not compressed."""
    size = header.layout.dtype.itemsize
    with path.open("rb") as stream:
        starts: Sequence[int] = range(header.points_at, header.points_at + size * header.count, size)
        if header.is_compressed:
            starts = first_records(path, header, stream)
        chosen = {number * (len(starts) - 1) // (_PROBES - 1) for number in range(_PROBES)}
        raw = b""
        for number in sorted(chosen):
            stream.seek(starts[number])
            raw += stream.read(size)
    if len(raw) < size * len(chosen):
        raise truncated(path, "it ends within its points")
    return np.frombuffer(raw, header.layout.dtype)


def check_points(path: Path, header: Header) -> None:
    """Refuse a file whose points can't be read from the start on, without reading them.

    Raises
    ------
    ValueError
        If it is LAZ and its record or chunk table is damaged, or the package for it is missing.
    """
    if is_ept(path):
        EptOctree(path, header, _node_records)
    elif _is_read_by_chunks(path, header):
        with path.open("rb") as stream:
            open_chunks(path, header, stream)
    elif header.is_compressed and not is_on_web(path):
        # On the web it costs a request for each chunk, unless the whole file is fetched first.
        with path.open("rb") as stream:
            open_laz(path, header, stream)


def read_chunks(path: Path, header: Header, monitor: Monitor) -> Iterator[tuple[int, np.ndarray]]:
    """Yield (position of the first point, records) until all points are read; the array is used again."""
    if _is_read_by_chunks(path, header):
        yield from _indexed(path, header, EVERYWHERE, monitor)
        return
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
    if _is_read_by_chunks(path, header):
        for start, chunk in _indexed(path, header, EVERYWHERE, monitor):
            points[start : start + len(chunk)] = chunk
        return points
    for start, stop, read in _reads(path, header, monitor):
        read(points[start:stop])
    return points


def _is_read_by_chunks(path: Path, header: Header) -> bool:
    """Whether also the whole of a file is read by its index: several ranges of a file on the web come at once."""
    return is_ept(path) or (is_on_web(path) and has_octree(path, header))


def has_octree(path: Path, header: Header) -> bool:
    """Whether a part of a file can be read by its octree."""
    return is_ept(path) or (has_index(header) and has_variable_chunks(header))


def size_within(path: Path, header: Header, box: Optional[np.ndarray]) -> tuple[int, int]:
    """Return the numbers of points and bytes of a file that are read for a box (2, 2) in plan, None for all.

    Of an octree, only nodes that the spacing of the header needs count.
    """
    if not has_octree(path, header):
        return header.count, path.stat().st_size
    with _octree(path, replace(header, reach=box)) as octree:
        wanted = octree.nodes.touch(EVERYWHERE if box is None else box, header.spacing)
    return int(octree.chunks[wanted, 2].sum()), int(octree.chunks[wanted, 1].sum())


def points_within(path: Path, header: Header, box: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return the records that lie within a box (2, 2) in plan, in the file's order; at its edges they are within.

    Parameters
    ----------
    path : Path
        The file.
    header : Header
        Its header; with a spacing, see :func:`thinned`.
    box : ndarray of shape (2, 2)
        Least and greatest easting and northing, in coordinates of the file.
    monitor : Monitor
        Receives the progress.
    """
    found = [np.empty(0, header.layout.dtype)]
    chunks = (chunk[is_within(chunk, header, box)] for _, chunk in chunks_near(path, header, box, monitor))
    found += [thinned(chunk, header) for chunk in chunks]
    return thinned(np.concatenate(found), header)


def thinned(records: np.ndarray, header: Header) -> np.ndarray:
    """Return the lowest of records (n,) in each cube of the header's spacing, in their order; all without one."""
    return records if header.spacing is None else records.take(lowest_rows(records, header))


def lowest_rows(records: np.ndarray, header: Header) -> np.ndarray:
    """Return the rows (m,), ascending, of the lowest of records (n,) in each cube of the header's spacing."""
    scale, offset = header.scale / header.spacing, header.offset / header.spacing
    cubes = [records[axis] * scale[i] + offset[i] for i, axis in enumerate("XYZ")]
    return one_per_voxel(np.column_stack(cubes), 1.0)


def chunks_near(path: Path, header: Header, box: np.ndarray, monitor: Monitor) -> Iterator[tuple[int, np.ndarray]]:
    """Yield (position of the first point, records) of the parts of a file that may have points in a box (2, 2) in plan.

    Of EPT and, where lazrs is installed, of a COPC file these are the nodes that touch the box. Of any other file they
    are all points if its bounds touch the box, none if not. The array is used again.

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
    if not may_hold(header, box):
        return
    yield from _indexed(path, header, box, monitor) if has_octree(path, header) else read_chunks(path, header, monitor)


def may_hold(header: Header, box: np.ndarray) -> bool:
    """Whether a file may have points in a box (2, 2) in plan, by the bounds in its header."""
    # The bounds of some files are rounded.
    step = header.scale[:2]
    return not ((box[1] < header.low[:2] - step).any() or (box[0] > header.high[:2] + step).any())


def _indexed(path: Path, header: Header, box: np.ndarray, monitor: Monitor) -> Iterator[tuple[int, np.ndarray]]:
    """Yield (position of the first point, records) of the nodes of an octree that touch a box."""
    with _octree(path, header) as octree:
        wanted, counts = np.flatnonzero(octree.nodes.touch(box, header.spacing)), octree.nodes.points
        ends = np.cumsum(counts)
        fetched = 0
        for done, some in enumerate(parts := _portions(wanted, counts)):
            if done == fetched:
                fetched = octree.fetch(parts, done, monitor)
            monitor.progress(done / len(parts))
            yield int(ends[some[0]] - counts[some[0]]), octree.read(some)
    monitor.progress(1.0)


@contextmanager
def _octree(path: Path, header: Header) -> Iterator[Union[_Copc, EptOctree]]:
    """Open the octree of a file that has one."""
    if is_ept(path):
        yield EptOctree(path, header, _node_records)
        return
    with path.open("rb") as stream:
        yield _Copc(path, header, stream)


class _Copc:
    """The octree of a COPC file."""

    def __init__(self, path: Path, header: Header, stream: Any) -> None:
        self.dtype, self.stream = header.layout.dtype, stream
        chunks, self._read = open_chunks(path, header, stream)
        self.chunks = chunks[chunks[:, 2] > 0]
        self.nodes = read_index(path, header, stream, self.chunks)

    def read(self, some: np.ndarray) -> np.ndarray:
        """Return the records of nodes that follow each other in the file."""
        records = np.empty(int(self.chunks[some, 2].sum()), self.dtype)
        self._read(self.chunks[some], records.view(np.uint8))
        return records

    def fetch(self, parts: list[np.ndarray], first: int, monitor: Monitor) -> int:
        """Fetch the chunks of portions from the first on, as many as are kept; return the portion behind them."""
        if not isinstance(self.stream, WebStream):
            return len(parts)
        last = fetched_to(self.chunks, parts, first)
        ranges = [(int(at), int(at + size)) for some in parts[first:last] for at, size in self.chunks[some, :2]]
        self.stream.prefetch(ranges, monitor.part(first / len(parts), last / len(parts)))
        return last


def _node_records(path: Path, count: int, header: Header) -> np.ndarray:
    """Return the points of a node in a LAZ file as records of the whole octree."""
    own = _held_header(path)
    if own.count != count:
        raise truncated(path, f"it holds {own.count} points instead of the {count} of its hierarchy")
    records = read_points(path, own, Monitor())
    out = np.zeros(count, header.layout.dtype)
    fill_merged(out, records, own, header)
    return out


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
    """Return the mask of records (n,) that lie within a box (2, 2) in plan, in the coordinates of the file."""
    within = np.ones(len(records), bool)
    for i, axis in enumerate("XY"):
        position = records[axis] * header.scale[i] + header.offset[i]
        within &= (position >= box[0, i]) & (position <= box[1, i])
    return within


def _reads(path: Path, header: Header, monitor: Monitor) -> Iterator[tuple[int, int, Callable]]:
    """Yield (start, stop, function that fills an array with these points), with progress between."""
    opened: Any = path.open("rb") if is_on_web(path) else KeptFailure(path)
    # Files on the web without an index are read in pieces of 4 MB.
    with opened as file, BufferedReader(file, 2**22 if is_on_web(path) else DEFAULT_BUFFER_SIZE) as stream:
        if is_on_web(path):
            file.prefetch([(0, min(path.stat().st_size, FETCHED))], monitor.part(0.0, 0.0))
        read = _compressed(path, header, stream, file) if header.is_compressed else _plain(path, header, stream)
        for start in range(0, header.count, AT_ONCE):
            monitor.progress(start / header.count)
            yield start, min(start + AT_ONCE, header.count), read
    monitor.progress(1.0)


def _compressed(path: Path, header: Header, stream: Any, file: KeptFailure) -> Callable:
    """Return a function that fills an array with the points of LAZ that come next."""
    fill = open_laz(path, header, stream)

    def read(points: np.ndarray) -> None:
        with explained(path, file):
            fill(points.view(np.uint8))

    return read


def _plain(path: Path, header: Header, stream: Any) -> Callable:
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
        writer.header.vlrs.append(las.vlrs.known.LasZipVlr(read_header(Path(stream.name)).vlrs[0].data))
    header.finish(stream, writer.header)
    monitor.progress(1.0)


def check_count(stream: BinaryIO, path: Path, count: int) -> None:
    """Read back how many points a file has that was just written, and refuse it if that is another number.

    Parameters
    ----------
    stream : file
        The file, which may have another name until it is complete.
    path : Path
        The name for the message.
    count : int
        Number of points that were to be written.

    Raises
    ------
    ValueError
        If it has more or fewer, or can't be read.
    """
    stream.flush()
    written = Path(stream.name)
    header = open_header(written)
    check_points(written, header)
    if header.count != count:
        raise ValueError(f"{path.name} would have {header.count:,} instead of {count:,} points; it is not written.")
