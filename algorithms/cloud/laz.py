"""LAZ through laspy's backends, lazrs or laszip, after the claims of a file are checked against its size."""

import io
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Callable

import numpy as np

from .header import LASZIP, Header, truncated
from .laspy_library import explained, has_backend, need_laspy, need_lazrs
from .point_formats import Layout

# The size of LAZ chunks that laszip and lazrs use when nothing else is asked for.
POINTS_PER_CHUNK = 50_000
# laspy's names of its backends.
_LAZRS, _LAZRS_IN_TURN, _LASZIP = "LazrsParallel", "Lazrs", "Laszip"
# How points are compressed: all in one go, as before 2011, or in chunks.
_POINTWISE, _CHUNKED = 1, 2
# The number of points of a chunk in a LASzip record whose chunks have different numbers, each in the chunk table; many
# writers of COPC leave 0 there, which LASzip takes for the same.
_VARIABLE_CHUNKS, _UNSTATED_CHUNKS = 2**32 - 1, 0
# What a LASzip record has before its items: how points are compressed, coder, version, options, points of a chunk,
# number and bytes of further records, number of items.
_HEAD = np.dtype([
    ("compressor", "<u2"), ("coder", "<u2"), ("version", "V4"), ("options", "<u4"), ("chunk_size", "<u4"),
    ("n_evlrs", "<i8"), ("evlr_bytes", "<i8"), ("n_items", "<u2"),
])  # fmt: skip
# Type, size in bytes and version of an item of the record.
_ITEM = struct.Struct("<HHH")
# The position of the chunk table, and its head: version, number of chunks.
_TABLE_POSITION, _TABLE_START = struct.Struct("<q"), struct.Struct("<II")
# Layers that points of formats 6 to 10 are stored in, by the type of their item; extra bytes (type 14) have one a byte.
_LAYERS = {10: 9, 11: 1, 12: 2, 13: 1}
# Versions of the items of points in layers, and of all others; lazrs lacks the newest.
_LAYERED_VERSIONS, _PLAIN_VERSIONS = (3, 4), (1, 2)
_NOT_IN_LAZRS = max(_LAYERED_VERSIONS)
# Types of the items of each point format, and of extra bytes behind formats 0 to 5 and 6 to 10.
_TYPES = {
    0: (6,), 1: (6, 7), 2: (6, 8), 3: (6, 7, 8), 4: (6, 7, 9), 5: (6, 7, 8, 9),
    6: (10,), 7: (10, 11), 8: (10, 12), 9: (10, 13), 10: (10, 12, 13),
}  # fmt: skip
_EXTRA_TYPES = 0, 14
# Size of an item (bytes) by its type.
_SIZES = {6: 20, 7: 8, 8: 6, 9: 29, 10: 30, 11: 6, 12: 8, 13: 29}


@dataclass
class _Laz:
    """A LAZ file whose claims are checked against its size before anything is decompressed."""

    path: Path
    header: Header
    stream: BinaryIO

    def record(self) -> bytes:
        """Return the LASzip record, as :func:`_plain_record` gives it, its items held against the header's records."""
        found = self.header.find(LASZIP)
        if found is None or found.data is None or len(found.data) < _HEAD.itemsize:
            raise truncated(self.path, "its LASzip record is missing")
        if len(found.data) < _HEAD.itemsize + int(_head(found.data)["n_items"]) * _ITEM.size:
            raise truncated(self.path, "its LASzip record is too short")
        items, layout = _items(found.data), self.header.layout
        size, expected = sum(item[1] for item in items), layout.dtype.itemsize
        if size != expected:
            raise truncated(self.path, f"its LASzip record describes points of {size} bytes, its header of {expected}")
        if not _fit(items, layout):
            raise truncated(self.path, f"its LASzip record does not describe point format {layout.point_format}")
        self._check_versions(items)
        return _plain_record(found.data)

    def _check_versions(self, items: list[tuple]) -> None:
        """Refuse versions of items that no package here reads: they are no damage."""
        known = _PLAIN_VERSIONS if self.header.layout.is_old else _LAYERED_VERSIONS
        unread = [version for _, _, version in items if version not in known or not _reads_version(version)]
        if unread:
            raise ValueError(
                f"{self.path.name} is compressed with version {unread[0]} of LASzip's items for point format "
                f"{self.header.layout.point_format}, which the installed packages can't read; save it as .las with the "
                "program that made it" + (" or install laszip." if unread[0] in known else ".")
            )

    def table_at(self, per_chunk: int) -> int:
        """Return the position of the chunk table, whose number of chunks was checked."""
        total = self.path.stat().st_size
        self.stream.seek(self.header.points_at)
        (position,) = self._unpacked(_TABLE_POSITION)
        if position == -1:
            # A writer that could not go back leaves the position in the last 8 bytes.
            self.stream.seek(total - _TABLE_POSITION.size)
            (position,) = self._unpacked(_TABLE_POSITION)
        if not self.chunks_at <= position < total:
            raise truncated(self.path, f"its chunk table should be at byte {position} of {total}")
        self._check_number(position, per_chunk)
        return position

    def _check_number(self, table_at: int, per_chunk: int) -> None:
        """Check the number of chunks against the bytes before the table, and the number of points against the chunks.

        Each chunk starts with one whole record.
        """
        self.stream.seek(table_at)
        _, n_chunks = self._unpacked(_TABLE_START)
        room = table_at - self.chunks_at
        if n_chunks * self.header.layout.dtype.itemsize > room:
            raise truncated(self.path, f"{n_chunks} chunks don't fit into {room} bytes")
        held = n_chunks * (per_chunk if per_chunk != _VARIABLE_CHUNKS else self.header.count)
        if self.header.count > held:
            raise truncated(self.path, f"it promises {self.header.count} points, but its chunks hold at most {held}")

    def check_chunks(self, table_at: int, record: bytes) -> np.ndarray:
        """Check the points and bytes of the chunk table against the file.

        Return position, bytes and number of points (m, 3) of each chunk, int64.
        """
        lazrs = need_lazrs()
        self.stream.seek(self.header.points_at)
        with explained(self.path, self.stream):
            chunks = lazrs.read_chunk_table(self.stream, lazrs.LazVlr(record))
        points, sizes = zip(*chunks)
        room = table_at - self.chunks_at
        if sum(sizes) > room:
            raise truncated(self.path, f"its chunks of {sum(sizes)} bytes don't fit into {room} bytes")
        if _chunk_size(record) == _VARIABLE_CHUNKS and sum(points) != self.header.count:
            raise truncated(self.path, f"it promises {self.header.count} points, but its chunks hold {sum(points)}")
        ends = self.chunks_at + np.cumsum(sizes, dtype=np.int64)
        return np.column_stack([ends - sizes, sizes, points]).astype(np.int64)

    def check_layers(self, chunks: np.ndarray, record: bytes, stream: BinaryIO, origin: int = 0) -> None:
        """Check the sizes of the layers, which are allocated before they are read, against the sizes of their chunks.

        The stream begins at position ``origin`` of the file.
        """
        if self.header.layout.is_old:
            return
        n_layers = sum(_LAYERS.get(kind, size) for kind, size, _ in _items(record))
        # A chunk begins with one whole record, its number of points and the size of each layer, 4 bytes each.
        head = self.header.layout.dtype.itemsize + 4
        for start, size in chunks[:, :2]:
            stream.seek(int(start) - origin + head)
            sizes_read = stream.read(n_layers * 4)
            if size and len(sizes_read) < n_layers * 4:
                raise truncated(self.path, f"a chunk of {size} bytes ends before the sizes of its {n_layers} layers")
            layers = np.frombuffer(sizes_read, "<u4", len(sizes_read) // 4)
            if size and head + layers.nbytes + layers.sum(dtype=np.int64) > size:
                raise truncated(self.path, f"a chunk of {size} bytes has layers of {layers.sum(dtype=np.int64)} bytes")

    @property
    def chunks_at(self) -> int:
        """Where the first chunk starts: behind the position of the chunk table."""
        return self.header.points_at + _TABLE_POSITION.size

    def _unpacked(self, kind: struct.Struct) -> tuple:
        raw = self.stream.read(kind.size)
        if len(raw) < kind.size:
            raise truncated(self.path, "it ends before its chunk table")
        return kind.unpack(raw)


class _OneChunk(io.RawIOBase):
    """The points of a LAZ file of before 2011, which has no chunks, as lazrs reads them: one chunk and its table."""

    def __init__(self, stream: BinaryIO, header: Header, record: bytes) -> None:
        super().__init__()
        self._stream, self._start, self._at = stream, header.points_at, 0
        size = stream.seek(0, io.SEEK_END) - header.points_at
        self._head = _TABLE_POSITION.pack(_TABLE_POSITION.size + size)
        table = io.BytesIO()
        need_lazrs().write_chunk_table(table, [(header.count, size)], need_lazrs().LazVlr(record))
        self._table, self._table_at = table.getvalue(), len(self._head) + size

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        start = {io.SEEK_SET: 0, io.SEEK_CUR: self._at, io.SEEK_END: self._table_at + len(self._table)}[whence]
        self._at = start + offset
        return self._at

    def readinto(self, buffer: Any) -> int:
        part = self._part(len(buffer))
        buffer[: len(part)] = part
        self._at += len(part)
        return len(part)

    def _part(self, size: int) -> bytes:
        """Return at most ``size`` bytes from the position on, of the head, the points or the table."""
        if self._at < len(self._head):
            return self._head[self._at : self._at + size]
        if self._at < self._table_at:
            self._stream.seek(self._start + self._at - len(self._head))
            return self._stream.read(min(size, self._table_at - self._at))
        return self._table[self._at - self._table_at :][:size]


def _plain_record(record: bytes) -> bytes:
    """Return a LASzip record with "variable" where its number of points of a chunk means nothing else."""
    if record[0] != _POINTWISE and _chunk_size(record) != _UNSTATED_CHUNKS:
        return record
    return _with_chunk_size(record, _VARIABLE_CHUNKS)


def _head(record: bytes) -> np.ndarray:
    """Return the head of a LASzip record, which comes before its items, as a view."""
    return np.frombuffer(record, _HEAD, 1)[0]


def _with_chunk_size(record: bytes, size: int) -> bytes:
    """Return a LASzip record with another number of points of a chunk."""
    head = _head(record).copy()
    head["chunk_size"] = size
    return head.tobytes() + record[_HEAD.itemsize :]


def _chunk_size(record: bytes) -> int:
    """Return the number of points of a chunk that a LASzip record states."""
    return int(_head(record)["chunk_size"])


def _items(record: bytes) -> list[tuple]:
    """Return type, size and version of the items that the points are compressed as."""
    return [_ITEM.unpack_from(record, _HEAD.itemsize + i * _ITEM.size) for i in range(int(_head(record)["n_items"]))]


def _fit(items: list[tuple], layout: Layout) -> bool:
    """Whether items fit the records of a file; lazrs may allocate GBs for others."""
    expected = [(kind, _SIZES[kind]) for kind in _TYPES[layout.point_format]]
    extra = layout.dtype.itemsize - sum(size for _, size in expected)
    expected += [(_EXTRA_TYPES[not layout.is_old], extra)] if extra else []
    return [item[:2] for item in items] == expected


def _reads_version(version: int) -> bool:
    """Whether an installed package reads a known version of the items."""
    return has_backend(_LASZIP) or version != _NOT_IN_LAZRS


def _is_for_lazrs(record: bytes) -> bool:
    """Whether lazrs is installed and reads a record's versions of the items."""
    return has_backend(_LAZRS) and all(version != _NOT_IN_LAZRS for _, _, version in _items(record))


def open_laz(path: Path, header: Header, stream: BinaryIO) -> Callable[[np.ndarray], Any]:
    """Return a function that fills bytes with the points of a LAZ or COPC file that come next, in the file's order.

    Raises
    ------
    ValueError
        If the file is shorter than its header states, or no package can read it.
    """
    laz = _Laz(path, header, stream)
    record = laz.record()
    backend = _backend(*((_LAZRS, _LASZIP) if _is_for_lazrs(record) else (_LASZIP, _LAZRS)))
    stream_at = header.points_at
    if record[0] == _POINTWISE:
        # laszip ends the process on layers in points that are compressed in one go.
        if not header.layout.is_old:
            raise truncated(path, "its LASzip record describes layered points without chunks")
        if has_backend(_LAZRS_IN_TURN):
            record = struct.pack("<H", _CHUNKED) + record[2:]
            backend, stream_at = need_laspy().LazBackend[_LAZRS_IN_TURN], 0
            with explained(path):
                stream = io.BufferedReader(_OneChunk(stream, header, record), 2**20)
    else:
        table_at = laz.table_at(_chunk_size(record))
        if has_backend(_LAZRS):
            laz.check_layers(laz.check_chunks(table_at, record), record, stream)
    if _chunk_size(record) != _VARIABLE_CHUNKS:
        # lazrs reserves the memory of a whole chunk: no chunk has more points than there are.
        record = _with_chunk_size(record, min(header.count, _chunk_size(record)))
    las = header.las()
    las.vlrs.append(need_laspy().vlrs.known.LasZipVlr(record))
    stream.seek(stream_at)
    with explained(path):
        reader = backend.create_reader(stream, las)
    # What laspy's read_n_points calls, without the copy of all points that it makes.
    return reader.decompressor.decompress_many if hasattr(reader, "decompressor") else reader.unzipper.decompress_into


def open_chunks(path: Path, header: Header, stream: BinaryIO) -> tuple[np.ndarray, Callable[[np.ndarray, Any], None]]:
    """Return the chunks of a LAZ file with chunks of any sizes, and a function that reads some of them.

    Returns
    -------
    chunks : ndarray of shape (m, 3), int64
        Position, bytes and number of points of each, in the order of the file.
    read : callable
        Fills bytes, its second argument, with the points of chunks (k, 3) that lie one behind the other.

    Raises
    ------
    ValueError
        If the file is shorter than its header states, or lazrs is not installed.
    """
    laz = _Laz(path, header, stream)
    record = laz.record()
    chunks = laz.check_chunks(laz.table_at(_chunk_size(record)), record)

    def read(some: np.ndarray, out: np.ndarray) -> None:
        stream.seek(int(some[0, 0]))
        raw = stream.read(int(some[:, 1].sum()))
        laz.check_layers(some, record, io.BytesIO(raw), int(some[0, 0]))
        with explained(path):
            table = [(int(points), int(size)) for _, size, points in some]
            need_lazrs().decompress_points_with_chunk_table(raw, record, out, table)

    return chunks, read


def first_records(path: Path, header: Header, stream: BinaryIO) -> list[int]:
    """Return the offsets (bytes) of the uncompressed first records of chunks; without lazrs of the first chunk only.

    Raises
    ------
    ValueError
        If the file is shorter than its header states.
    """
    laz = _Laz(path, header, stream)
    record = laz.record()
    if record[0] == _POINTWISE:
        return [header.points_at]
    table_at = laz.table_at(_chunk_size(record))
    if not has_backend(_LAZRS):
        return [laz.chunks_at]
    starts, sizes, _ = laz.check_chunks(table_at, record).T
    long_enough = starts[sizes >= header.layout.dtype.itemsize]
    if not len(long_enough):
        raise truncated(path, "its chunks are too short for a point")
    return long_enough.tolist()


def has_variable_chunks(header: Header) -> bool:
    """Whether chunks of a LAZ file may differ in their numbers of points, and lazrs can read some of them."""
    found = header.find(LASZIP)
    if found is None or found.data is None or len(found.data) < _HEAD.itemsize or found.data[0] == _POINTWISE:
        return False
    return _chunk_size(_plain_record(found.data)) == _VARIABLE_CHUNKS and _is_for_lazrs(found.data)


def _backend(preferred: str, other: str) -> Any:
    """Return laspy's backend of the first of two names that is installed."""
    for name in (preferred, other):
        if has_backend(name):
            return need_laspy().LazBackend[name]
    raise ValueError(
        "LAZ files need the Python package lazrs, which is not installed; install lazrs, or use LAS files."
    )


def writing_backend(point_format: int) -> Any:
    """Return laspy's backend that compresses a point format.

    lazrs 0.8 writes waveform references that laszip can't read (formats 4, 5) or
    that come back changed where there are several scanner channels (9, 10).

    Raises
    ------
    ValueError
        If the format has waveforms and laszip is not installed, or neither package is.
    """
    if not Layout(point_format).has_waveforms:
        return _backend(_LAZRS, _LASZIP)
    found = _backend(_LASZIP, _LAZRS)
    if found is not need_laspy().LazBackend.Laszip:
        raise ValueError(
            f"LAZ with waveforms (point format {point_format}) is written by the Python package laszip, "
            "which is not installed; write .las instead or install laszip."
        )
    return found
