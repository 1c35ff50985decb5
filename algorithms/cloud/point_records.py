"""The records that a cloud is written as: what was read, with what stages have set."""

import re
from collections import Counter
from typing import Optional, Union

import numpy as np

from .crs import Crs
from .dimensions import DIMENSIONS, Dimension
from .extra_bytes import ExtraField, new_field
from .header import LARGEST_STEP, Header
from .point_formats import FORMATS, OF_COPC, UPGRADED, Layout

Index = Union[slice, np.ndarray]
# Name of a field, and which one of that name.
_Key = tuple[str, int]


def find_extra(layout: Layout, dimension: Dimension, component: int = 0) -> Optional[int]:
    """Return the position among the extras that holds a component of ``dimension``, by name, then by alias, or None."""
    names = [field.name if field.is_scalar else "" for field in layout.extras]
    wanted = (dimension.disk[component], *(dimension.aliases if len(dimension.disk) == 1 else ()))
    return next((names.index(name) for name in wanted if name in names), None)


def unit_factor(dimension: Dimension, crs: Crs) -> float:
    """Return meters (or square meters) per unit of a stored dimension.

    Heights are stored in the vertical unit of the file and areas in its squared
    horizontal unit, so that QGIS and PDAL, which have one unit for a file, agree.
    """
    return {"m": crs.vertical, "m²": crs.horizontal**2}.get("" if dimension.standard else dimension.unit, 1.0)


class PointRecords:
    """Makes the output's records from those read and from the arrays set, for any part of the cloud.

    Parameters
    ----------
    points : structured array, (n,)
        As read, laid out as ``layout``.
    layout : Layout
        The input's.
    changes : dict of str to array
        What stages have set, by Python name, in meters.
    crs : Crs
        With the units of the file.
    for_copc : bool
        Whether the output has a point format that COPC takes: 6 to 8 only.
    """

    def __init__(
        self, points: np.ndarray, layout: Layout, changes: dict[str, np.ndarray], crs: Crs, for_copc: bool
    ) -> None:
        self.points, self.source = points, layout
        self._standard = {name: values for name, values in changes.items() if DIMENSIONS[name].standard}
        added = {name: values for name, values in changes.items() if name not in self._standard}
        needed = _needed_format(layout, self._standard)
        self.is_upgraded = needed != layout.point_format
        extras, self._added = _extras(layout, added, crs)
        self.layout = Layout(OF_COPC[needed] if for_copc else needed, extras)
        self._as_read = not changes and self.layout == layout

    def take(self, index: Index) -> np.ndarray:
        """Return the output's records of the points at ``index``, a slice or an array of positions."""
        points = self.points[index]
        if self._as_read:
            return points
        out = np.zeros(len(points), self.layout.dtype)
        self.source.copy_standard(points, self.layout, out)
        for name, values in self._standard.items():
            self.layout.put(out, name, values[index])
        for i in range(len(self.layout.extras)):
            values, factor = self._added.get(i, (None, 1.0))
            if values is None:
                out[f"extra{i}"] = points[f"extra{i}"]
            else:
                out[f"extra{i}"] = values[index] if factor == 1 else values[index] / factor
        return out


def _needed_format(layout: Layout, standard: dict[str, np.ndarray]) -> int:
    """Return the point format that holds the classes: 5 bits in formats 0-5, 8 in LAS 1.4's."""
    classes = standard.get("classification")
    # Formats 0 to 5 have 5 bits for the class.
    if layout.is_old and classes is not None and len(classes) and classes.max() > 31:
        return UPGRADED[layout.point_format]
    return layout.point_format


def _extras(
    layout: Layout, added: dict[str, np.ndarray], crs: Crs
) -> tuple[tuple[ExtraField, ...], dict[int, tuple[np.ndarray, float]]]:
    """Return the output's extra fields, old ones first, and by position the values set and meters (m²) per unit."""
    fields, values_at = list(layout.extras), {}
    for name, values in added.items():
        dimension = DIMENSIONS[name]
        for component, disk in enumerate(dimension.disk):
            at = find_extra(layout, dimension, component)
            field = new_field(disk, dimension.dtype, dimension.description)
            if at is None:
                at = len(fields)
                fields.append(field)
            else:
                # A field of the same name and numbers keeps what else the file says of it.
                fields[at] = fields[at].without_range() if is_stored_as(fields[at], disk, dimension) else field
            values_at[at] = values if values.ndim == 1 else values[:, component], unit_factor(dimension, crs)
    return tuple(fields), values_at


def is_stored_as(field: ExtraField, disk: str, dimension: Dimension) -> bool:
    """Whether a field has the name, type and plain numbers that this program gives a component of ``dimension``."""
    return field.name == disk and field.dtype == np.dtype(dimension.dtype) and field.is_plain


def is_written_as(field: ExtraField, disk: str, dimension: Dimension) -> bool:
    """Whether a field is stored and described as this program does it for a component of ``dimension``."""
    # Of the descriptions, only the first words are the same in all versions.
    of_field, own = (re.split(r"\W", text, maxsplit=1)[0] for text in (field.description, dimension.description))
    return is_stored_as(field, disk, dimension) and of_field == own


def merged_layout(layouts: list[Layout]) -> Layout:
    """Return a layout that holds the fields of all ``layouts``: their union, the first one's extras first.

    A name of different numbers (another type or scale) becomes float64.
    """
    names = {name for layout in layouts for name in layout.names}
    point_format = min(i for i in FORMATS if names <= set(Layout(i).names))
    extras: dict[_Key, ExtraField] = {}
    for key, field in (found for layout in layouts for found in _keyed(layout.extras)):
        if not _has_numbers(field):
            # Bytes of unknown meaning and vectors are one field only where name and type are the same.
            extras.setdefault(key, field)
            continue
        same = extras.setdefault(key, field.without_range())
        if not field.same_numbers(same):
            extras[key] = field.as_numbers("f8")
    return Layout(point_format, tuple(extras.values()))


def _has_numbers(field: ExtraField) -> bool:
    """Whether a field is one number with a name, by which the same one is known in other files."""
    return field.is_scalar and bool(field.name)


def _keyed(fields: tuple[ExtraField, ...]) -> list[tuple[_Key, ExtraField]]:
    """Return fields under names that are unique among the files that are merged.

    That is the name, or name and type, and which one of that name it is: some files have several.
    """
    seen: Counter[str] = Counter()
    keyed = []
    for field in fields:
        name = field.name if _has_numbers(field) else f"{field.name} {field.dtype}"
        keyed.append(((name, seen[name]), field))
        seen[name] += 1
    return keyed


def convert(points: np.ndarray, source: Layout, target: Layout, out: np.ndarray) -> None:
    """Copy ``points`` (n,) of ``source`` to ``out`` (n,) of a layout merged from it and others.

    Extra numbers that the source lacks become NaN where they can, else 0.

    Parameters
    ----------
    points : ndarray of shape (n,)
        Records to copy.
    source : Layout
        Their layout.
    target : Layout
        Layout of the result.
    out : ndarray of shape (n,)
        Receives the records.
    """
    source.copy_standard(points, target, out)
    given = {key: i for i, (key, _) in enumerate(_keyed(source.extras))}
    for i, (key, field) in enumerate(_keyed(target.extras)):
        at = given.get(key)
        if at is None:
            if field.is_scalar and field.dtype.kind == "f":
                out[f"extra{i}"] = np.nan
            continue
        stored = points[f"extra{at}"]
        same = not _has_numbers(field) or source.extras[at].same_numbers(field)
        out[f"extra{i}"] = stored if same else source.extras[at].decode(stored)


def fill_merged(out: np.ndarray, records: np.ndarray, tile: Header, merged: Header) -> None:
    """Write ``records`` (n,) of a tile to ``out`` (n,) as records of the merged cloud.

    Parameters
    ----------
    out : ndarray of shape (n,)
        Receives the records.
    records : ndarray of shape (n,)
        Records of the tile.
    tile : Header
        Header of the tile.
    merged : Header
        Header of the merged cloud.

    Raises
    ------
    ValueError
        If a point lies where the scale of the merged cloud doesn't reach.
    """
    convert(records, tile.layout, merged.layout, out)
    for i, axis in enumerate("XYZ"):
        if tile.scale[i] == merged.scale[i] and tile.offset[i] == merged.offset[i]:
            continue
        steps = np.rint((records[axis] * tile.scale[i] + (tile.offset[i] - merged.offset[i])) / merged.scale[i])
        if len(steps) and not np.abs(steps).max() <= LARGEST_STEP:
            raise ValueError("A tile has points outside the bounds in its header; repair its header first.")
        out[axis] = steps
