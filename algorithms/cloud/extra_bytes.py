"""Extra bytes of LAS points: the descriptors of the Extra Bytes VLR (LAS 1.4 R15, table 24)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

DESCRIPTOR = np.dtype(
    [
        ("reserved", "u1", 2),
        ("data_type", "u1"),
        ("options", "u1"),
        ("name", "S32"),
        ("unused", "u1", 4),
        ("no_data", "V8", 3),
        ("min", "V8", 3),
        ("max", "V8", 3),
        ("scale", "<f8", 3),
        ("offset", "<f8", 3),
        ("description", "S32"),
    ]
)
_TYPES = ("u1", "i1", "<u2", "<i2", "<u4", "<i4", "<u8", "<i8", "<f4", "<f8")
_HAS_NO_DATA, _HAS_RANGE, _HAS_SCALE, _HAS_OFFSET = 1, 2 | 4, 8, 16
_LONGEST_UNDOCUMENTED = 255


@dataclass(frozen=True)
class ExtraField:
    """One extra dimension of a file.

    ``raw`` is its descriptor as in the file, 192 bytes, or None for bytes that no
    descriptor tells of; ``dtype`` is what a record holds, before scale and offset.
    """

    name: str
    dtype: np.dtype
    raw: Optional[bytes]

    @property
    def descriptor(self) -> np.void:
        """The descriptor's fields."""
        return np.frombuffer(self.raw or bytes(DESCRIPTOR.itemsize), DESCRIPTOR)[0]

    @property
    def is_scalar(self) -> bool:
        """Whether a record holds one number of it (not bytes without meaning, not a vector)."""
        return self.dtype.kind in "iuf" and self.dtype.shape == ()

    @property
    def is_plain(self) -> bool:
        """Whether the numbers mean what they are: no scale and no offset."""
        return self.is_scalar and not self.descriptor["options"] & (_HAS_SCALE | _HAS_OFFSET)

    @property
    def description(self) -> str:
        """What the file says of it."""
        return self.descriptor["description"].split(b"\0")[0].decode("utf-8", "replace")

    def same_numbers(self, other: ExtraField) -> bool:
        """Whether the stored numbers of two scalar fields mean the same."""
        mine, theirs = self.descriptor, other.descriptor
        alike = all(mine[name].tobytes() == theirs[name].tobytes() for name in ("no_data", "scale", "offset"))
        flags = 255 ^ _HAS_RANGE
        return self.dtype == other.dtype and alike and mine["options"] & flags == theirs["options"] & flags

    def decode(self, stored: np.ndarray) -> np.ndarray:
        """Return ``stored`` (n,) as numbers that mean something: scaled, NaN where there is no data."""
        descriptor = self.descriptor
        options = int(descriptor["options"])
        values = stored
        if not self.is_plain:
            scale = descriptor["scale"][0] if options & _HAS_SCALE else 1.0
            offset = descriptor["offset"][0] if options & _HAS_OFFSET else 0.0
            values = stored * scale + offset
        if options & _HAS_NO_DATA:
            nothing = stored == self._no_data()
            if nothing.any():
                values = np.where(nothing, np.nan, values)
        return values

    def _no_data(self) -> np.generic:
        """Return the stored number that means "no data": 8 bytes, the widest type of its kind."""
        wide = {"u": "<u8", "i": "<i8", "f": "<f8"}[self.dtype.kind]
        return np.frombuffer(self.descriptor["no_data"][0].tobytes(), wide)[0]

    def without_range(self) -> ExtraField:
        """Return the field without its minimum and maximum, which new values make untrue."""
        descriptor = np.array([self.descriptor])
        descriptor["options"] &= 255 ^ _HAS_RANGE
        descriptor["min"] = descriptor["max"] = np.void(bytes(8))
        return replace(self, raw=descriptor.tobytes())


def new_field(name: str, dtype: str, description: str) -> ExtraField:
    """Return a field of numbers without scale; ``name`` and ``description`` take at most 31 bytes each."""
    little = np.dtype(dtype).newbyteorder("<")
    descriptor = np.zeros(1, DESCRIPTOR)
    descriptor["data_type"] = 1 + [np.dtype(kind) for kind in _TYPES].index(little)
    descriptor["name"], descriptor["description"] = name.encode(), description.encode()
    return ExtraField(name, little, descriptor.tobytes())


def undocumented(size: int, raw: Optional[bytes] = None) -> ExtraField:
    """Return ``size`` bytes that are kept and not understood."""
    return ExtraField("", np.dtype(f"V{size}"), raw)


def fields_of(payload: bytes, size: int) -> tuple[ExtraField, ...]:
    """Return the fields that the VLR ``payload`` gives to the ``size`` extra bytes of a record.

    Descriptors that reach beyond the record are left out; bytes beyond the last
    descriptor come as one undocumented field.
    """
    fields: list[ExtraField] = []
    left = size
    for start in range(0, len(payload) - DESCRIPTOR.itemsize + 1, DESCRIPTOR.itemsize):
        field = _field(payload[start : start + DESCRIPTOR.itemsize])
        if field.dtype.itemsize > left:
            break
        fields.append(field)
        left -= field.dtype.itemsize
    return (*fields, undocumented(left)) if left else tuple(fields)


def _field(raw: bytes) -> ExtraField:
    descriptor = np.frombuffer(raw, DESCRIPTOR)[0]
    kind, options = int(descriptor["data_type"]), int(descriptor["options"])
    if not 1 <= kind <= 3 * len(_TYPES):
        # Type 0 keeps its number of bytes where the others keep their options.
        return undocumented(options, raw)
    scalar, several = np.dtype(_TYPES[(kind - 1) % len(_TYPES)]), 1 + (kind - 1) // len(_TYPES)
    name = descriptor["name"].split(b"\0")[0].decode("utf-8", "replace")
    return ExtraField(name, scalar if several == 1 else np.dtype((scalar, several)), raw)


def payload_of(fields: tuple[ExtraField, ...]) -> bytes:
    """Return the VLR payload for ``fields``, in order; trailing undocumented bytes need no descriptor."""
    while fields and fields[-1].raw is None:
        fields = fields[:-1]
    return b"".join(field.raw if field.raw is not None else _descriptors(field.dtype.itemsize) for field in fields)


def _descriptors(size: int) -> bytes:
    """Describe bytes of unknown meaning, so that what follows them is found."""
    described = b""
    while size:
        descriptor = np.zeros(1, DESCRIPTOR)
        descriptor["options"] = min(size, _LONGEST_UNDOCUMENTED)
        size -= int(descriptor["options"][0])
        described += descriptor.tobytes()
    return described
