"""Header, VLRs and EVLRs of a LAS file, byte by byte, so that what is not understood is kept."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import BinaryIO, Optional

import numpy as np

from .extra_bytes import fields_of, payload_of
from .formats import FIELDS, Layout

# signature, source id, encoding, GUID, version, system, software, day, year, header size, offset to points,
# number of VLRs, format, record length, legacy count, legacy count by return
_START = struct.Struct("<4sHH16sBB32s32sHHHIIBHI5I")
# scale, offset, then maximum and minimum by axis
_NUMBERS = struct.Struct("<3d3d6d")
_WAVEFORM = struct.Struct("<Q")
_LONG = struct.Struct("<QIQ15Q")
_VLR = struct.Struct("<2s16sHH32s")
_EVLR = struct.Struct("<2s16sHQ32s")
SIZES = {0: 227, 1: 227, 2: 227, 3: 235, 4: 375}

WKT_BIT = 16
_WAVEFORMS_INSIDE = 2
_COMPRESSED = 128
_LARGEST_OLD_COUNT = 2**32 - 1
_LARGEST_VLR = 65_535
# Longer payloads (waveforms) stay in their file until they are copied.
_KEPT_IN_MEMORY = 2**24
_COPIED_AT_ONCE = 2**24
# Doubles may be this many steps of the scale apart; some files are written with far too fine a scale.
_COARSEST = 1000.0
LASZIP = (b"laszip encoded", 22204)
EXTRA_BYTES = (b"LASF_Spec", 4)
WAVEFORMS = (b"LASF_Spec", 65535)
COPC_INFO, COPC_HIERARCHY = (b"copc", 1), (b"copc", 1000)


@dataclass
class Record:
    """A VLR or EVLR; ``data`` is None where the payload is left in the file ``path``, from ``start``."""

    user_id: bytes
    record_id: int
    data: Optional[bytes]
    description: bytes = b""
    reserved: bytes = b"\0\0"
    path: Optional[Path] = None
    start: int = 0
    size: int = 0

    @property
    def key(self) -> tuple[bytes, int]:
        """User id without its padding, and record id."""
        return self.user_id.split(b"\0")[0], self.record_id

    def __len__(self) -> int:
        return self.size if self.data is None else len(self.data)

    def write(self, stream: BinaryIO, extended: bool) -> None:
        """Write the record as an EVLR (``extended``) or VLR."""
        head = _EVLR if extended else _VLR
        stream.write(head.pack(self.reserved, self.user_id, self.record_id, len(self), self.description))
        if self.path is None or self.data is not None:
            stream.write(self.data or b"")
            return
        with self.path.open("rb") as source:
            source.seek(self.start)
            for done in range(0, self.size, _COPIED_AT_ONCE):
                stream.write(source.read(min(_COPIED_AT_ONCE, self.size - done)))


@dataclass
class Header:
    """What a LAS file says of itself; texts are bytes as they stand there, with their padding."""

    minor: int = 4
    source_id: int = 0
    encoding: int = WKT_BIT
    guid: bytes = bytes(16)
    system: bytes = b"OTHER"
    software: bytes = b""
    day: int = 0
    year: int = 0
    user_bytes: bytes = b""
    gap: bytes = b""
    layout: Layout = Layout(6)
    is_compressed: bool = False
    count: int = 0
    returns: tuple[int, ...] = (0,) * 15
    scale: np.ndarray = field(default_factory=lambda: np.full(3, 0.001))
    offset: np.ndarray = field(default_factory=lambda: np.zeros(3))
    low: np.ndarray = field(default_factory=lambda: np.zeros(3))
    high: np.ndarray = field(default_factory=lambda: np.zeros(3))
    waveforms_at: int = 0
    points_at: int = 0
    evlrs_at: int = 0
    vlrs: list[Record] = field(default_factory=list)
    evlrs: list[Record] = field(default_factory=list)

    def find(self, key: tuple[bytes, int]) -> Optional[Record]:
        """Return the first VLR or EVLR of that user and record id, or None."""
        return next((record for record in (*self.vlrs, *self.evlrs) if record.key == key), None)

    def without(self, *keys: tuple[bytes, int]) -> Header:
        """Return a header that lacks the VLRs and EVLRs of these user and record ids."""
        vlrs = [record for record in self.vlrs if record.key not in keys]
        return replace(self, vlrs=vlrs, evlrs=[record for record in self.evlrs if record.key not in keys])

    def with_layout(self, layout: Layout) -> Header:
        """Return the header for records of ``layout``, its Extra Bytes VLR included and in its old place."""
        payload = payload_of(layout.extras)
        old = self.find(EXTRA_BYTES)
        if payload == (old.data if old else b""):
            return replace(self, layout=layout)
        if len(payload) > _LARGEST_VLR:
            raise ValueError(
                f"A LAS file describes at most 341 extra dimensions, got {len(payload) // 192}; remove some."
            )
        new = Record(*EXTRA_BYTES, payload, description=b"Extra bytes")
        if old not in self.vlrs:
            return replace(self.without(EXTRA_BYTES), layout=layout, vlrs=[*self.vlrs, new])
        same = [replace(new, description=old.description, reserved=old.reserved) if r is old else r for r in self.vlrs]
        return replace(self, layout=layout, vlrs=same)

    def write(self, stream: BinaryIO) -> None:
        """Write header, VLRs and the bytes up to the first point, from the stream's start."""
        stream.seek(0)
        self.points_at = self._size + sum(_VLR.size + len(record) for record in self.vlrs) + len(self.gap)
        stream.write(self._packed())
        for record in self.vlrs:
            record.write(stream, extended=False)
        stream.write(self.gap)

    def write_evlrs(self, stream: BinaryIO) -> None:
        """Write the EVLRs at the stream's position and note where they went; the header itself is for later."""
        self.evlrs_at = stream.tell() if self.evlrs else 0
        for record in self.evlrs:
            if record.key == WAVEFORMS and self.encoding & _WAVEFORMS_INSIDE:
                self.waveforms_at = stream.tell()
            record.write(stream, extended=True)

    @property
    def _size(self) -> int:
        return SIZES[self.minor] + len(self.user_bytes)

    def _packed(self) -> bytes:
        layout = self.layout
        # LAS 1.4 leaves the 32-bit counts at 0 where they can't be right or the format is a new one.
        legacy = layout.is_old and self.count <= _LARGEST_OLD_COUNT
        if self.minor < 4 and not legacy:
            raise ValueError(
                f"LAS 1.{self.minor} holds at most 4294967295 points, got {self.count}; write COPC or LAS 1.4."
            )
        packed = _START.pack(
            b"LASF", self.source_id, self.encoding, self.guid, 1, self.minor, self.system, self.software,
            self.day, self.year, self._size, self.points_at, len(self.vlrs),
            layout.point_format | (_COMPRESSED if self.is_compressed else 0), layout.dtype.itemsize,
            self.count if legacy else 0, *(self.returns[:5] if legacy else (0,) * 5),
        )  # fmt: skip
        extent = [value for pair in zip(self.high, self.low) for value in pair]
        packed += _NUMBERS.pack(*self.scale, *self.offset, *extent)
        if self.minor >= 3:
            packed += _WAVEFORM.pack(self.waveforms_at)
        if self.minor >= 4:
            packed += _LONG.pack(self.evlrs_at, len(self.evlrs), self.count, *self.returns)
        return packed + self.user_bytes


def read_header(path: Path) -> Header:
    """Return the header of a LAS or LAZ file, with its VLRs, EVLRs and layout.

    Raises
    ------
    ValueError
        If the file is empty, not LAS, of an unknown version or format, or ends too early.
    """
    total = path.stat().st_size
    if total == 0:
        raise ValueError(f"{path.name} is empty (0 bytes); get the file again.")
    with path.open("rb") as stream:
        raw = stream.read(SIZES[4])
        if raw[:4] != b"LASF":
            raise ValueError(
                f"{path.name} is not a LAS or LAZ file: it starts with {raw[:4]!r} instead of b'LASF'; choose another."
            )
        if len(raw) < SIZES[0]:
            raise _truncated(path, f"its header has {len(raw)} bytes of {SIZES[0]}")
        return _Reader(path, stream, raw, total).header()


def _truncated(path: Path, how: str) -> ValueError:
    return ValueError(f"{path.name} is truncated or damaged: {how}; get the file again.")


class _Reader:
    """One reading of a header: the stream, the raw bytes and the length that all promises are held against."""

    def __init__(self, path: Path, stream: BinaryIO, raw: bytes, total: int) -> None:
        self.path, self.stream, self.raw, self.total = path, stream, raw, total
        self.start = _START.unpack_from(raw)

    def header(self) -> Header:
        (_, source_id, encoding, guid, major, minor, system, software, day, year, size, points_at, n_vlrs, kind,
         length, count, *returns) = self.start  # fmt: skip
        if major != 1 or minor not in SIZES:
            raise ValueError(f"{self.path.name} is LAS {major}.{minor}; LAS 1.0 to 1.4 can be read: convert it first.")
        if size < SIZES[minor] or not size <= points_at <= self.total:
            raise _truncated(self.path, f"points should start at byte {points_at} of {self.total}")
        numbers = _NUMBERS.unpack_from(self.raw, _START.size)
        header = Header(minor, source_id, encoding, guid, system, software, day, year, count=count)
        header.returns = (*returns, *(0,) * 10)
        header.scale, header.offset = np.array(numbers[:3]), np.array(numbers[3:6])
        header.high, header.low = np.array(numbers[6::2]), np.array(numbers[7::2])
        header.points_at, header.is_compressed = points_at, bool(kind & _COMPRESSED)
        self._check_scale(header)
        self.stream.seek(SIZES[minor])
        header.user_bytes = self.stream.read(size - SIZES[minor])
        header.vlrs = [self._record(_VLR, points_at) for _ in range(self._plausible(n_vlrs, size, points_at))]
        header.gap = self.stream.read(points_at - self.stream.tell())
        self._read_long(header)
        header.layout = self._layout(header, kind & 63, length)
        return header

    def _check_scale(self, header: Header) -> None:
        step = np.abs(header.scale)
        with np.errstate(over="ignore"):
            farthest = np.abs(header.offset) + 2.0**31 * step
        # Beyond, all coordinates are one and the same; of NaN and infinity the comparison is false.
        if not (np.spacing(farthest) <= _COARSEST * step).all():
            raise ValueError(
                f"{self.path.name} has no usable coordinates: scale {header.scale.tolist()}, offset "
                f"{header.offset.tolist()} in its header; get the file again."
            )

    def _plausible(self, n_vlrs: int, size: int, points_at: int) -> int:
        if n_vlrs * _VLR.size > points_at - size:
            raise _truncated(self.path, f"{n_vlrs} VLRs can't stand in {points_at - size} bytes")
        return n_vlrs

    def _read_long(self, header: Header) -> None:
        """Read what LAS 1.3 and 1.4 added: waveforms, EVLRs, 64-bit counts."""
        if header.minor >= 3:
            header.waveforms_at = _WAVEFORM.unpack_from(self.raw, SIZES[2])[0]
        if header.minor >= 4:
            header.evlrs_at, n_evlrs, count, *returns = _LONG.unpack_from(self.raw, SIZES[3])
            header.count, header.returns = (count, tuple(returns)) if count else (header.count, header.returns)
            if n_evlrs * _EVLR.size > max(self.total - header.evlrs_at, 0):
                raise _truncated(self.path, f"{n_evlrs} EVLRs should start at byte {header.evlrs_at} of {self.total}")
            # Without any, some writers leave a place that is none.
            if n_evlrs:
                self.stream.seek(header.evlrs_at)
                header.evlrs = [self._record(_EVLR, self.total) for _ in range(n_evlrs)]
        if header.waveforms_at and header.encoding & _WAVEFORMS_INSIDE and header.find(WAVEFORMS) is None:
            self.stream.seek(header.waveforms_at)
            header.evlrs.append(self._record(_EVLR, self.total))

    def _record(self, head: struct.Struct, end: int) -> Record:
        raw = self.stream.read(head.size)
        if len(raw) < head.size:
            raise _truncated(self.path, "it ends within its variable length records")
        reserved, user_id, record_id, size, description = head.unpack(raw)
        start = self.stream.tell()
        if start + size > end:
            name = user_id.split(b"\0")[0].decode("ascii", "replace")
            # In damaged files it is anything, and would spoil the sentence.
            known = f"{name} {record_id} " if name.isascii() and name.isprintable() else ""
            raise _truncated(self.path, f"a record {known}of {size} bytes runs past byte {end}")
        record = Record(user_id, record_id, None, description, reserved, self.path, start, size)
        if size > _KEPT_IN_MEMORY:
            self.stream.seek(start + size)
        else:
            record.data = self.stream.read(size)
        return record

    def _layout(self, header: Header, point_format: int, length: int) -> Layout:
        if point_format >= len(FIELDS):
            raise ValueError(f"{self.path.name} has point format {point_format}; formats 0 to 10 can be read.")
        extra = length - Layout(point_format).dtype.itemsize
        if extra < 0:
            raise _truncated(self.path, f"its points take {length} bytes, too few for point format {point_format}")
        described = header.find(EXTRA_BYTES)
        return Layout(point_format, fields_of((described.data or b"") if described else b"", extra))
