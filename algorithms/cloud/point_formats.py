"""The records of one file: a point format of laspy and its extra bytes (LAS 1.4 R15, tables 7-17)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .extra_bytes import ExtraField
from .laspy_library import need_laspy

FORMATS = range(11)
# Step of the scan angle in formats 6-10, degrees; formats 0-5 count degrees.
_ANGLE_STEP = 0.006
# laspy has another name for the scan angle of the formats 0-5.
_NAMES = {"scan_angle_rank": "scan_angle"}

# The smallest format of LAS 1.4 that holds everything of an older one.
UPGRADED = {0: 6, 1: 6, 2: 7, 3: 7, 4: 9, 5: 10}
# COPC allows 6, 7 and 8 only; waveform references have no field there.
OF_COPC = {**UPGRADED, 4: 6, 5: 7, 6: 6, 7: 7, 8: 8, 9: 6, 10: 8}


@dataclass(frozen=True)
class Layout:
    """What the records of one file look like: a point format and its extra bytes."""

    point_format: int
    extras: tuple[ExtraField, ...] = ()

    def __getstate__(self) -> dict[str, Any]:
        """Return the state to pickle: without the cached objects of laspy, which the other process makes again."""
        return {"point_format": self.point_format, "extras": self.extras}

    @cached_property
    def standard(self) -> np.dtype:
        """Packed structured dtype of the standard fields, with laspy's names; bit fields share bytes."""
        fields = need_laspy().PointFormat(self.point_format).dtype().descr
        return np.dtype([(_NAMES.get(name, name), kind) for name, kind in fields])

    @cached_property
    def dtype(self) -> np.dtype:
        """Packed structured dtype; the extra bytes are ``extra0``, ``extra1``, … in the order of ``extras``."""
        added = [(f"extra{i}", field.dtype) for i, field in enumerate(self.extras)]
        return np.dtype([*self.standard.descr, *added])

    @cached_property
    def las(self) -> Any:
        """PointFormat of laspy, all extra bytes as one field: it refuses duplicate names and names of its own."""
        laspy = need_laspy()
        made = laspy.PointFormat(self.point_format)
        size = sum(field.dtype.itemsize for field in self.extras)
        if size:
            kind = np.dtype("u1") if size == 1 else np.dtype(("u1", size))
            made.add_extra_dimension(laspy.ExtraBytesParams("extra", kind))
        return made

    @property
    def is_old(self) -> bool:
        """Whether this is one of the formats 0-5, which have 5 bits for the class."""
        return self.point_format < 6

    @property
    def has_waveforms(self) -> bool:
        """Whether records refer to waveforms."""
        return "wavepacket_index" in self.standard.fields

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of everything that a standard record holds, bit fields unpacked."""
        return tuple(_NAMES.get(name, name) for name in self.las.standard_dimension_names)

    def records(self, points: np.ndarray) -> Any:
        """Return ``points`` (n,) as laspy's point records."""
        return need_laspy().PackedPointRecord(points, self.las)

    def get(self, points: np.ndarray, name: str) -> np.ndarray:
        """Return a standard field of ``points`` (n,), scan angles in degrees, as a new array or a view."""
        if name == "scan_angle":
            return points[name] * (np.float32(1) if self.is_old else np.float32(_ANGLE_STEP))
        return np.asarray(self.records(points)[name])

    def put(self, points: np.ndarray, name: str, values: np.ndarray) -> None:
        """Store a standard field in ``points`` (n,), scan angles in degrees and within the bounds of the format.

        Raises
        ------
        ValueError
            If a value of a bit field needs more bits than the format has.
        """
        if name == "scan_angle":
            # The largest angles are 90 and 180 degrees, in steps.
            step, limit = (1, 90) if self.is_old else (_ANGLE_STEP, 30_000)
            points[name] = np.clip(np.rint(values / step), -limit, limit)
            return
        if name in points.dtype.names:
            points[name] = values
            return
        largest = self.las.dimension_by_name(name).max
        if len(values) and values.max() > largest:
            raise ValueError(
                f"Point format {self.point_format} holds {name} up to {largest}, got {values.max()}; "
                "use a format of LAS 1.4 or smaller values."
            )
        self.records(points)[name][:] = values.astype("u1")

    def copy_standard(self, points: np.ndarray, target: Layout, out: np.ndarray) -> None:
        """Copy the standard fields of ``points`` (n,) to ``out`` (n,), which is laid out as ``target``.

        Same generation of formats: bytes are copied as they are. From formats 0-5 to
        6-10: field by field; the class, 12 included, stays.
        """
        if self.is_old == target.is_old:
            for name in target.standard.names:
                if name in self.standard.names:
                    out[name] = points[name]
            return
        for name in self.names:
            if name in target.names:
                target.put(out, name, self.get(points, name))
