"""LAS point formats 0-10: the bytes of a point record and what its bits mean (LAS 1.4 R15, tables 7-17)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .extra_bytes import ExtraField

_START = (("X", "<i4"), ("Y", "<i4"), ("Z", "<i4"), ("intensity", "<u2"), ("return_byte", "u1"))
_OLD = (*_START, ("class_byte", "u1"), ("scan_angle", "i1"), ("user_data", "u1"), ("point_source_id", "<u2"))
_NEW = (
    *_START,
    ("flag_byte", "u1"),
    ("classification", "u1"),
    ("user_data", "u1"),
    ("scan_angle", "<i2"),
    ("point_source_id", "<u2"),
    ("gps_time", "<f8"),
)
_TIME = (("gps_time", "<f8"),)
_COLOR = (("red", "<u2"), ("green", "<u2"), ("blue", "<u2"))
_NIR = (("nir", "<u2"),)
_WAVE = (
    ("wave_index", "u1"),
    ("wave_offset", "<u8"),
    ("wave_size", "<u4"),
    ("wave_location", "<f4"),
    ("wave_x", "<f4"),
    ("wave_y", "<f4"),
    ("wave_z", "<f4"),
)
FIELDS = (
    _OLD,
    (*_OLD, *_TIME),
    (*_OLD, *_COLOR),
    (*_OLD, *_TIME, *_COLOR),
    (*_OLD, *_TIME, *_WAVE),
    (*_OLD, *_TIME, *_COLOR, *_WAVE),
    _NEW,
    (*_NEW, *_COLOR),
    (*_NEW, *_COLOR, *_NIR),
    (*_NEW, *_WAVE),
    (*_NEW, *_COLOR, *_NIR, *_WAVE),
)

# name -> (byte that holds it, lowest bit, number of bits)
_OLD_BITS = {
    "return_number": ("return_byte", 0, 3),
    "number_of_returns": ("return_byte", 3, 3),
    "scan_direction": ("return_byte", 6, 1),
    "flight_line_edge": ("return_byte", 7, 1),
    "classification": ("class_byte", 0, 5),
    "synthetic": ("class_byte", 5, 1),
    "key_point": ("class_byte", 6, 1),
    "withheld": ("class_byte", 7, 1),
}
_NEW_BITS = {
    "return_number": ("return_byte", 0, 4),
    "number_of_returns": ("return_byte", 4, 4),
    "synthetic": ("flag_byte", 0, 1),
    "key_point": ("flag_byte", 1, 1),
    "withheld": ("flag_byte", 2, 1),
    "overlap": ("flag_byte", 3, 1),
    "scanner_channel": ("flag_byte", 4, 2),
    "scan_direction": ("flag_byte", 6, 1),
    "flight_line_edge": ("flag_byte", 7, 1),
}

# Formats 6-10 count the scan angle in steps of 0.006 degrees, formats 0-5 in degrees.
_ANGLE_STEP = 0.006
_LARGEST_ANGLE = 30_000

# The smallest format of LAS 1.4 that holds everything of an older one.
UPGRADED = {0: 6, 1: 6, 2: 7, 3: 7, 4: 9, 5: 10}
# COPC allows 6, 7 and 8 only; waveform references have no place there.
OF_COPC = {**UPGRADED, 4: 6, 5: 7, 6: 6, 7: 7, 8: 8, 9: 6, 10: 8}
WITH_WAVEFORMS = (4, 5, 9, 10)


@dataclass(frozen=True)
class Layout:
    """What the records of one file look like: a point format and its extra bytes."""

    point_format: int
    extras: tuple[ExtraField, ...] = ()

    @cached_property
    def dtype(self) -> np.dtype:
        """Packed structured dtype; the extra bytes are ``extra0``, ``extra1``, … in the order of ``extras``."""
        added = [(f"extra{i}", field.dtype) for i, field in enumerate(self.extras)]
        return np.dtype([*FIELDS[self.point_format], *added])

    @property
    def extra_size(self) -> int:
        """Extra bytes of one record."""
        return sum(field.dtype.itemsize for field in self.extras)

    @property
    def is_old(self) -> bool:
        """Whether this is one of the formats 0-5, which have 5 bits for the class."""
        return self.point_format < 6

    @property
    def bits(self) -> dict[str, tuple[str, int, int]]:
        """Bit fields by name."""
        return _OLD_BITS if self.is_old else _NEW_BITS

    @property
    def names(self) -> tuple[str, ...]:
        """Names of everything that a standard record holds, bit fields unpacked."""
        whole = [name for name, _ in FIELDS[self.point_format] if not name.endswith("_byte")]
        return (*whole, *self.bits)

    def get(self, points: np.ndarray, name: str) -> np.ndarray:
        """Return a standard field of ``points`` (n,), scan angles in degrees, as a new array or a view."""
        if name in self.bits:
            byte, low, width = self.bits[name]
            return (points[byte] >> low) & ((1 << width) - 1)
        if name == "scan_angle":
            return points[name] * (np.float32(1) if self.is_old else np.float32(_ANGLE_STEP))
        return points[name]

    def put(self, points: np.ndarray, name: str, values: np.ndarray) -> None:
        """Store a standard field in ``points`` (n,).

        Raises
        ------
        ValueError
            If a value needs more bits than the format has.
        """
        if name in self.bits:
            byte, low, width = self.bits[name]
            largest = (1 << width) - 1
            if len(values) and values.max() > largest:
                raise ValueError(
                    f"Point format {self.point_format} holds {name} up to {largest}, got {values.max()}; "
                    "use a format of LAS 1.4 or smaller values."
                )
            kept = points[byte] & np.uint8(255 ^ (largest << low))
            points[byte] = kept | (values.astype("u1") << np.uint8(low))
        elif name == "scan_angle":
            step, limit = (1, 90) if self.is_old else (_ANGLE_STEP, _LARGEST_ANGLE)
            points[name] = np.clip(np.rint(values / step), -limit, limit)
        else:
            points[name] = values

    def copy_standard(self, points: np.ndarray, target: Layout, out: np.ndarray) -> None:
        """Copy the standard fields of ``points`` (n,) to ``out`` (n,), which is laid out as ``target``.

        Same generation of formats: bytes are copied as they are, reserved bits
        too. From formats 0-5 to 6-10: bit by bit; the class, 12 included, stays.
        """
        if self.is_old == target.is_old:
            for name, _ in FIELDS[target.point_format]:
                if name in points.dtype.names:
                    out[name] = points[name]
            return
        for name in self.names:
            if name in target.names:
                target.put(out, name, self.get(points, name))
