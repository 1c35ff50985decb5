"""Header, VLRs and EVLRs of a LAS file: laspy's header, and the raw bytes that laspy would rewrite or drop."""

from __future__ import annotations

import io
import struct
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, BinaryIO, Optional
from uuid import UUID

import numpy as np

from .extra_bytes import DESCRIPTOR_SIZE, fields_of, payload_of
from .laspy_library import need_laspy
from .outputs import PIECE
from .point_formats import FORMATS, Layout

# The header of LAS 1.4, which begins like earlier versions; the "old" numbers of points have 32 bits.
HEADER = np.dtype([
    ("signature", "S4"), ("source_id", "<u2"), ("encoding", "<u2"), ("guid", "V16"), ("major", "u1"), ("minor", "u1"),
    ("system", "S32"), ("software", "S32"), ("date", "V4"), ("size", "<u2"), ("points_at", "<u4"), ("n_vlrs", "<u4"),
    ("point_format", "u1"), ("length", "<u2"), ("old_count", "<u4"), ("old_returns", "<u4", 5), ("scale", "<f8", 3),
    ("offset", "<f8", 3), ("bounds", "<f8", 6), ("waveforms_at", "<u8"), ("evlrs_at", "<u8"), ("n_evlrs", "<u4"),
    ("count", "<u8"), ("returns", "<u8", 15),
])  # fmt: skip


def bytes_of(name: str) -> slice:
    """Return the bytes of a field of the header, by its name in ``HEADER``."""
    kind, start = HEADER.fields[name][:2]
    return slice(start, start + kind.itemsize)


# Reserved bytes, user id, record id, length and description before the payload of a VLR and of an EVLR.
_VLR = struct.Struct("<2s16sHH32s")
EVLR = struct.Struct("<2s16sHQ32s")
# Size of the header of each minor version.
SIZES = {**dict.fromkeys(range(3), bytes_of("bounds").stop), 3: bytes_of("waveforms_at").stop, 4: HEADER.itemsize}
# The first minor version of LAS that has a point format; laspy supports versions from 1.1 on.
_FIRST_MINOR = {0: 1, 1: 1, 2: 2, 3: 2, 4: 3, 5: 3}

# Bits of the encoding: the CRS is a WKT; waveforms are in the file, in a file of their own, in either.
WKT_BIT = 16
_WAVEFORMS_INSIDE, _WAVEFORMS_OUTSIDE = 2, 4
WAVEFORM_BITS = _WAVEFORMS_INSIDE | _WAVEFORMS_OUTSIDE
# Most bytes of the payload of a VLR, and most extra dimensions that it describes.
LARGEST_VLR = np.iinfo(np.uint16).max
MOST_EXTRAS = LARGEST_VLR // DESCRIPTOR_SIZE
# Largest coordinate of a record, in steps of the scale from the offset.
LARGEST_STEP = np.iinfo(np.int32).max
# Areas of cells whose sides are a smaller step are 0 in doubles.
_LEAST_STEP = float(np.sqrt(np.finfo(float).tiny))
# The name of the writing program, in the header of every file written here.
SOFTWARE = "LiDAR Buildings"
# User id and record id of VLRs.
LASZIP = (b"laszip encoded", 22204)
EXTRA_BYTES = (b"LASF_Spec", 4)
WAVEFORMS = (b"LASF_Spec", 65535)
COPC_INFO, COPC_HIERARCHY = (b"copc", 1), (b"copc", 1000)
# LAStools' index of the points by their positions in the file.
LAX = (b"LAStools", 30)
# Records that become invalid when points are recompressed, and when they change or are reordered; and those that a file
# of other points, or of other formats, lacks.
OF_OLD_CHUNKS = (LASZIP, COPC_INFO, COPC_HIERARCHY)
OF_OLD_POINTS = (*OF_OLD_CHUNKS, LAX)
OF_OLD_FILES = (*OF_OLD_POINTS, WAVEFORMS)


@dataclass
class Vlr:
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
        head = EVLR if extended else _VLR
        stream.write(head.pack(self.reserved, self.user_id, self.record_id, len(self), self.description))
        if self.path is None or self.data is not None:
            stream.write(self.data or b"")
            return
        with self.path.open("rb") as source:
            source.seek(self.start)
            for done in range(0, self.size, PIECE):
                stream.write(source.read(min(PIECE, self.size - done)))


@dataclass
class Header:
    """The header of a LAS file; texts and the date are bytes as they are stored, with their padding."""

    minor: int = 4
    source_id: int = 0
    encoding: int = WKT_BIT
    guid: bytes = bytes(16)
    system: bytes = b"OTHER"
    software: str = SOFTWARE
    date: bytes = bytes(4)
    user_bytes: bytes = b""  #: Bytes of the header beyond its version's
    gap: bytes = b""  #: Bytes between the VLRs and the points
    layout: Layout = Layout(6)
    is_compressed: bool = False
    count: int = 0
    #: (3,): units of the file per step; steps of new clouds are finer than the noise of any scanner
    scale: np.ndarray = field(default_factory=lambda: np.full(3, 0.001))
    offset: np.ndarray = field(default_factory=lambda: np.zeros(3))
    #: low, high, (3,): bounds in coordinates of the file
    low: np.ndarray = field(default_factory=lambda: np.zeros(3))
    high: np.ndarray = field(default_factory=lambda: np.zeros(3))
    is_measured: bool = False  #: Whether the bounds are measured, as those in the file can't be of its points
    waveforms_at: int = 0  #: Position of the waveforms in the file, 0 without any
    points_at: int = 0  #: Position of the points in the file
    vlrs: list[Vlr] = field(default_factory=list)
    evlrs: list[Vlr] = field(default_factory=list)
    #: (2, 2): box in plan that nothing is read outside of, None for everywhere; it is not written
    reach: Optional[np.ndarray] = None
    #: (3,): sides of cubes of which one point each is read, in units of the file, None for all points; not written
    spacing: Optional[np.ndarray] = None
    named: str = ""  #: CRS (WKT or "EPSG:code") that a virtual point cloud names for the file; it is not written

    @property
    def has_waveforms_outside(self) -> bool:
        """Whether the points refer to waveforms in a file of their own (.wdp)."""
        return self.layout.has_waveforms and bool(self.encoding & _WAVEFORMS_OUTSIDE)

    def find(self, key: tuple[bytes, int]) -> Optional[Vlr]:
        """Return the first VLR or EVLR of that user and record id, or None."""
        return next(iter(self.find_all(key)), None)

    def find_all(self, key: tuple[bytes, int]) -> list[Vlr]:
        """Return all VLRs and EVLRs of that user and record id, in the order of the file."""
        return [record for record in (*self.vlrs, *self.evlrs) if record.key == key]

    def without(self, *keys: tuple[bytes, int]) -> Header:
        """Return a header that lacks the VLRs and EVLRs of these user and record ids."""
        vlrs = [record for record in self.vlrs if record.key not in keys]
        return replace(self, vlrs=vlrs, evlrs=[record for record in self.evlrs if record.key not in keys])

    def with_layout(self, layout: Layout) -> Header:
        """Return the header for records of ``layout``, with one Extra Bytes VLR in the place of the first there is."""
        payload = payload_of(layout.extras)
        found = self.find_all(EXTRA_BYTES)
        old = found[0] if found else None
        if len(found) < 2 and payload == (old.data if old else b""):
            return replace(self, layout=layout)
        if len(payload) > LARGEST_VLR:
            raise ValueError(
                f"A LAS file describes at most {MOST_EXTRAS} extra dimensions, got "
                f"{len(payload) // DESCRIPTOR_SIZE}; remove some."
            )
        new = Vlr(*EXTRA_BYTES, payload, description=b"Extra bytes")
        if old not in self.vlrs:
            return replace(self.without(EXTRA_BYTES), layout=layout, vlrs=[*self.vlrs, new])
        new = replace(new, description=old.description, reserved=old.reserved)
        vlrs = [new if record is old else record for record in self.vlrs if record is old or record.key != EXTRA_BYTES]
        return replace(self.without(EXTRA_BYTES), layout=layout, vlrs=vlrs)

    def las(self) -> Any:
        """Return a new LasHeader of laspy, which has the VLRs as bytes of no known meaning and bounds in steps."""
        lowest = _FIRST_MINOR.get(self.layout.point_format, 4)
        las_header = need_laspy().LasHeader(version=f"1.{max(self.minor, lowest)}", point_format=self.layout.las)
        las_header.vlrs.clear()
        las_header.file_source_id, las_header.uuid = self.source_id, UUID(bytes_le=self.guid)
        las_header.global_encoding.value, las_header.generating_software = self.encoding, self.software
        las_header.partial_reset()
        las_header.scales, las_header.offsets = np.ones(3), np.zeros(3)
        las_header.start_of_waveform_data_packet_record = self.waveforms_at
        las_header.are_points_compressed, las_header.extra_header_bytes = self.is_compressed, self.user_bytes
        with io.BytesIO() as records:
            for record in self.vlrs:
                record.write(records, extended=False)
            las_header.extra_vlr_bytes = records.getvalue() + self.gap
        return las_header

    def count_in(self, las: Any, points: np.ndarray) -> None:
        """Count ``points`` into laspy's header ``las``, in a third of the time of its own ``grow``."""
        las.point_count += len(points)
        numbers = np.bincount(self.layout.get(points, "return_number"), minlength=16)[1:16]
        las.number_of_points_by_return += numbers.astype(las.number_of_points_by_return.dtype)
        for i, axis in enumerate("XYZ"):
            steps = points[axis].copy()
            las.mins[i], las.maxs[i] = min(las.mins[i], steps.min()), max(las.maxs[i], steps.max())

    def write(self, stream: BinaryIO, las: Any) -> None:
        """Write laspy's header ``las`` to the stream's start, with those bytes put back that laspy does not keep."""
        with io.BytesIO() as packed:
            las.write_to(packed)
            raw = bytearray(packed.getvalue())
        self.points_at = las.offset_to_point_data
        if SIZES[self.minor] == SIZES[las.version.minor]:
            raw[bytes_of("minor").start] = self.minor
        raw[bytes_of("system")], raw[bytes_of("date")] = self.system.ljust(32, b"\0"), self.date
        struct.pack_into("<I", raw, bytes_of("n_vlrs").start, len(self.vlrs) + len(las.vlrs))
        # LAS 1.4 has the number of points in the old place too, where it fits and the format is an old one.
        if self.minor == 4 and self.layout.is_old and las.point_count < 2**32:
            returns = map(int, las.number_of_points_by_return[:5])
            struct.pack_into("<6I", raw, bytes_of("old_count").start, las.point_count, *returns)
        stream.seek(0)
        stream.write(raw)

    def finish(self, stream: BinaryIO, las: Any) -> None:
        """Write the EVLRs behind the points and then the header; ``las`` has counted the points, in steps."""
        las.start_of_first_evlr = stream.seek(0, 2) if self.evlrs else 0
        las.number_of_evlrs = len(self.evlrs)
        for record in self.evlrs:
            if record.key == WAVEFORMS and self.encoding & _WAVEFORMS_INSIDE:
                las.start_of_waveform_data_packet_record = stream.tell()
            record.write(stream, extended=True)
        las.mins, las.maxs = (bound * self.scale + self.offset for bound in (las.mins, las.maxs))
        las.scales, las.offsets = self.scale, self.offset
        self.write(stream, las)


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
            raise truncated(path, f"its header has {len(raw)} bytes of {SIZES[0]}")
        return _Reader(path, stream, raw, total).header()


def truncated(path: Path, how: str) -> ValueError:
    """Return the error for a file that is shorter than its header states, or otherwise damaged."""
    return ValueError(f"{path.name} is truncated or damaged: {how}; get the file again.")


class _Reader:
    """One reading of a header: the stream, the raw bytes, and the length against which all sizes are checked.

    What would make laspy read without end, or more than there is, is refused before laspy sees it.
    """

    def __init__(self, path: Path, stream: BinaryIO, raw: bytes, total: int) -> None:
        self.path, self.stream, self.raw, self.total = path, stream, raw, total
        fields = np.frombuffer(raw.ljust(HEADER.itemsize, b"\0"), HEADER)[0]
        self.major, self.minor, kind = (int(fields[name]) for name in ("major", "minor", "point_format"))
        names = ("size", "points_at", "n_vlrs", "length", "old_count")
        self.size, self.points_at, self.n_vlrs, self.length, self.old_count = (int(fields[name]) for name in names)
        # LASzip marks compressed files in the upper two bits of the point format.
        self.point_format, self.is_compressed = kind & 63, bool(kind & 128)

    def header(self) -> Header:
        self._check()
        las = self._parsed()
        header = Header(
            minor=self.minor, source_id=las.file_source_id, encoding=las.global_encoding.value,
            guid=las.uuid.bytes_le, system=self.raw[bytes_of("system")],
            date=self.raw[bytes_of("date")], user_bytes=las.extra_header_bytes,
            is_compressed=self.is_compressed, scale=las.scales, offset=las.offsets, low=las.mins, high=las.maxs,
            count=las.point_count or self.old_count, points_at=self.points_at,
            waveforms_at=las.start_of_waveform_data_packet_record,
        )  # fmt: skip
        self._check_scale(header)
        self._read_records(header, las)
        header.layout = self._layout(header)
        # Several lists of extra bytes are one, which others read as a whole.
        return header.with_layout(header.layout) if len(header.find_all(EXTRA_BYTES)) > 1 else header

    def _check(self) -> None:
        if self.major != 1 or self.minor not in SIZES:
            raise ValueError(
                f"{self.path.name} is LAS {self.major}.{self.minor}; LAS 1.0 to 1.4 can be read: convert it first."
            )
        if self.size < SIZES[self.minor] or not self.size <= self.points_at <= self.total:
            raise truncated(self.path, f"points should start at byte {self.points_at} of {self.total}")
        if self.n_vlrs * _VLR.size > self.points_at - self.size:
            raise truncated(self.path, f"{self.n_vlrs} VLRs don't fit into {self.points_at - self.size} bytes")
        if self.point_format not in FORMATS:
            raise ValueError(f"{self.path.name} has point format {self.point_format}; formats 0 to 10 can be read.")
        if self.length < Layout(self.point_format).dtype.itemsize:
            raise truncated(
                self.path, f"its points take {self.length} bytes, too few for point format {self.point_format}"
            )

    def _parsed(self) -> Any:
        """Return laspy's header, with the VLRs as bytes before the points."""
        self.stream.seek(0)
        plain = bytearray(self.stream.read(self.points_at))
        # Points by return are counted anew; laspy 2.5 has 32 bits for each.
        for name in ("n_vlrs", "old_returns", *(["returns"] if self.minor >= 4 else [])):
            plain[bytes_of(name)] = bytes(HEADER[name].itemsize)
        return need_laspy().LasHeader.read_from(io.BytesIO(plain))

    def _check_scale(self, header: Header) -> None:
        step = header.scale
        if (step < 0).any():
            # laspy and PDAL multiply by it as it is, and lasvalidate fails such a file: the sign is an error.
            raise ValueError(
                f"{self.path.name} has a negative scale in its header, {step.tolist()}, which mirrors the cloud; get "
                "the file again, or have its header repaired."
            )
        with np.errstate(over="ignore"):
            farthest = np.abs(header.offset) + 2.0**31 * step
        # Beyond, all coordinates are one and the same; of NaN and infinity the comparison is false. Below, areas are 0.
        # Largest spacing of doubles (steps of the scale); some files have far too fine a scale.
        if not ((np.spacing(farthest) <= 1000.0 * step) & (step >= _LEAST_STEP)).all():
            raise ValueError(
                f"{self.path.name} has no usable coordinates: scale {header.scale.tolist()}, offset "
                f"{header.offset.tolist()} in its header; get the file again."
            )

    def _read_records(self, header: Header, las: Any) -> None:
        self.stream.seek(self.size)
        header.vlrs = [self._record(_VLR, self.points_at) for _ in range(self.n_vlrs)]
        header.gap = self.stream.read(self.points_at - self.stream.tell())
        n_evlrs, start = las.number_of_evlrs, las.start_of_first_evlr
        if n_evlrs * EVLR.size > max(self.total - start, 0):
            raise truncated(self.path, f"{n_evlrs} EVLRs should start at byte {start} of {self.total}")
        # Without EVLRs, some writers store an invalid position.
        if n_evlrs:
            self.stream.seek(start)
            header.evlrs = [self._record(EVLR, self.total) for _ in range(n_evlrs)]
        if header.waveforms_at and header.encoding & _WAVEFORMS_INSIDE and header.find(WAVEFORMS) is None:
            if header.waveforms_at > self.total:
                raise truncated(self.path, f"waveforms should start at byte {header.waveforms_at} of {self.total}")
            self.stream.seek(header.waveforms_at)
            record = self._record(EVLR, self.total)
            if record.key == WAVEFORMS:
                header.evlrs.append(record)
            else:
                # A position without waveforms would lie anywhere in the output.
                header.waveforms_at = 0

    def _record(self, head: struct.Struct, end: int) -> Vlr:
        raw = self.stream.read(head.size)
        if len(raw) < head.size:
            raise truncated(self.path, "it ends within its variable length records")
        reserved, user_id, record_id, size, description = head.unpack(raw)
        start = self.stream.tell()
        if start + size > end:
            name = user_id.split(b"\0")[0].decode("ascii", "replace")
            # In damaged files the name is often random bytes, which are of no use in a message.
            known = f"{name} {record_id} " if name.isascii() and name.isprintable() else ""
            raise truncated(self.path, f"a record {known}of {size} bytes runs past byte {end}")
        record = Vlr(user_id, record_id, None, description, reserved, self.path, start, size)
        # Long payloads (waveforms), and indexes, stay in their file until they are copied.
        if size > PIECE or record.key == COPC_HIERARCHY:
            self.stream.seek(start + size)
        else:
            record.data = self.stream.read(size)
        return record

    def _layout(self, header: Header) -> Layout:
        lists = [record.data or b"" for record in header.find_all(EXTRA_BYTES)]
        described = b"".join(one[: len(one) // DESCRIPTOR_SIZE * DESCRIPTOR_SIZE] for one in lists)
        extra = self.length - Layout(self.point_format).dtype.itemsize
        return Layout(self.point_format, fields_of(described, extra))
