"""Extra bytes of LAS points: the descriptors of the Extra Bytes VLR (LAS 1.4 R15, table 24), kept as bytes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Optional

import numpy as np

from .laspy_library import need_laspy

# Where a descriptor has the number that means "no data", of the first of up to 3 axes.
_NO_DATA = slice(40, 48)
# Where it has minimum and maximum of 3 axes.
_RANGE = slice(64, 112)
# Where it has name and description.
_TEXTS = (slice(4, 36), slice(160, 192))
# Bytes of a descriptor, which ends with the description; and of the longest name, which ends with a 0.
DESCRIPTOR_SIZE = _TEXTS[1].stop
LONGEST_NAME = _TEXTS[0].stop - _TEXTS[0].start - 1
# Where it has what the numbers mean: options; "no data" of all axes; scales and offsets.
_MEANING = (slice(3, 4), slice(40, 64), slice(112, 160))
# Most bytes of unknown meaning that one descriptor holds: their number is stored in a byte.
_LONGEST_UNDOCUMENTED = np.iinfo(np.uint8).max


def _parsed(raw: bytes) -> Any:
    """Return laspy's view of a descriptor's 192 bytes."""
    return need_laspy().vlrs.known.ExtraBytesStruct.from_buffer_copy(raw)


@dataclass(frozen=True)
class ExtraField:
    """One extra dimension of a file.

    ``raw`` is its descriptor as in the file, 192 bytes, or None for bytes without a descriptor; ``dtype`` is the type
    in a record, before scale and offset.
    """

    name: str
    dtype: np.dtype
    raw: Optional[bytes]

    @property
    def descriptor(self) -> Any:
        """The descriptor's fields, an ExtraBytesStruct of laspy."""
        return _parsed(self.raw or bytes(DESCRIPTOR_SIZE))

    @property
    def description(self) -> str:
        """What the file says of it."""
        return (self.raw or bytes(DESCRIPTOR_SIZE))[_TEXTS[1]].split(b"\0")[0].decode("utf-8", "replace")

    @property
    def is_scalar(self) -> bool:
        """Whether a record holds one number of it (not bytes without meaning, not a vector)."""
        return self.dtype.kind in "iuf" and self.dtype.shape == ()

    @property
    def is_plain(self) -> bool:
        """Whether the numbers have neither scale nor offset."""
        descriptor = self.descriptor
        return self.is_scalar and descriptor.scale is None and descriptor.offset is None

    def same_numbers(self, other: ExtraField) -> bool:
        """Whether the stored numbers of two scalar fields mean the same."""
        mine, theirs = (field.without_range().raw or b"" for field in (self, other))
        return self.dtype == other.dtype and all(mine[part] == theirs[part] for part in _MEANING)

    def decode(self, stored: np.ndarray) -> np.ndarray:
        """Return ``stored`` (n,) as numbers that mean something: scaled, NaN where there is no data."""
        descriptor, values = self.descriptor, stored
        if not self.is_plain:
            scale = 1.0 if descriptor.scale is None else descriptor.scale[0]
            values = stored * scale + (0.0 if descriptor.offset is None else descriptor.offset[0])
        if descriptor.options & descriptor.NO_DATA_BIT_MASK:
            nothing = stored == self._no_data()
            if nothing.any():
                values = np.where(nothing, np.nan, values)
        return values

    def _no_data(self) -> np.generic:
        """Return the stored number that means "no data": 8 bytes, the widest type of its kind."""
        wide = {"u": "<u8", "i": "<i8", "f": "<f8"}[self.dtype.kind]
        return np.frombuffer((self.raw or bytes(DESCRIPTOR_SIZE))[_NO_DATA], wide)[0]

    def without_range(self) -> ExtraField:
        """Return the field without its minimum and maximum, which new values make untrue."""
        descriptor = self.descriptor
        descriptor.options &= ~(descriptor.MIN_BIT_MASK | descriptor.MAX_BIT_MASK)
        raw = bytearray(bytes(descriptor))
        raw[_RANGE] = bytes(_RANGE.stop - _RANGE.start)
        return replace(self, raw=bytes(raw))

    def as_numbers(self, dtype: str) -> ExtraField:
        """Return a field of the same name and description, byte for byte, that holds plain numbers of another type."""
        plain = new_field("", dtype, "")
        raw = bytearray(bytes(plain.descriptor))
        for part in _TEXTS:
            raw[part] = (self.raw or bytes(DESCRIPTOR_SIZE))[part]
        return replace(plain, name=self.name, raw=bytes(raw))


def new_field(name: str, dtype: str, description: str) -> ExtraField:
    """Return a field of numbers without scale; ``name`` and ``description`` take at most 31 bytes each."""
    descriptor, kind = _parsed(bytes(DESCRIPTOR_SIZE)), np.dtype(dtype).newbyteorder("<")
    descriptor.data_type = need_laspy().extradims.get_id_for_extra_dim_type(kind)
    descriptor.name, descriptor.description = name.encode(), description.encode()
    return ExtraField(name, kind, bytes(descriptor))


def fields_of(payload: bytes, size: int) -> tuple[ExtraField, ...]:
    """Return the fields that the VLR ``payload`` gives to the ``size`` extra bytes of a record.

    Descriptors that reach beyond the record are left out; bytes beyond the last
    descriptor come as one undocumented field.
    """
    fields: list[ExtraField] = []
    remaining = size
    for start in range(0, len(payload) - DESCRIPTOR_SIZE + 1, DESCRIPTOR_SIZE):
        field = _field(payload[start : start + DESCRIPTOR_SIZE])
        if field.dtype.itemsize > remaining:
            break
        fields.append(field)
        remaining -= field.dtype.itemsize
    return (*fields, ExtraField("", np.dtype(f"V{remaining}"), None)) if remaining else tuple(fields)


def _field(raw: bytes) -> ExtraField:
    """Return the field that a descriptor describes."""
    descriptor = _parsed(raw)
    # Types from 11 on are the vectors of earlier versions.
    if not 1 <= descriptor.data_type <= 30:
        # Type 0 keeps its number of bytes where the others keep their options.
        return ExtraField("", np.dtype(f"V{descriptor.options}"), raw)
    return ExtraField(descriptor.name.decode("utf-8", "replace"), descriptor.dtype().newbyteorder("<"), raw)


def payload_of(fields: tuple[ExtraField, ...]) -> bytes:
    """Return the VLR payload for ``fields``, in order; trailing undocumented bytes need no descriptor."""
    while fields and fields[-1].raw is None:
        fields = fields[:-1]
    return b"".join(field.raw if field.raw is not None else _descriptors(field.dtype.itemsize) for field in fields)


def _descriptors(size: int) -> bytes:
    """Describe bytes of unknown meaning, so that what follows them is found."""
    sizes = [_LONGEST_UNDOCUMENTED] * (size // _LONGEST_UNDOCUMENTED) + [size % _LONGEST_UNDOCUMENTED]
    # The fourth byte, which has the options of numbers, is the number of bytes.
    return b"".join(bytes((0, 0, 0, part)).ljust(DESCRIPTOR_SIZE, b"\0") for part in sizes if part)
