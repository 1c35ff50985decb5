"""The point cloud in memory."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Callable, Optional, cast
from weakref import ReferenceType, ref

import numpy as np

from .crs import Crs, crs_records, read_crs
from .dimensions import DIMENSIONS, Dimension
from .header import LARGEST_STEP, LAX, Header
from .point_formats import Layout
from .point_records import PointRecords, find_extra, is_written_as, unit_factor
from .printable import shown

# Origins are multiples of this (m): coordinates from there keep their digits, and neighboring clouds have the same one.
_ORIGIN_STEP = 1000.0


class Cloud:
    """A point cloud: the records of a file, and what stages have set.

    Memory: the records as they are in the file take 20 to 67 bytes per point plus extra bytes. Each array that was set
    takes 1 to 12 bytes per point. ``get("xyz")`` makes an array of 24 bytes per point, which all share that hold it;
    keep it no longer than needed.

    Attributes
    ----------
    header : Header
        The header of the file, or the one made for a new cloud.
    points : structured array, (n,)
        The records, laid out as ``header.layout``. The array is never changed; moving
        points puts another in its place.
    crs : Crs
        The coordinate reference system, with meters per unit of the file's coordinates.
    origin : float64 array, (3,)
        Meters; what ``get("xyz")`` is relative to. Set it to another cloud's
        before comparing the two. Its z is 0: elevations stay elevations.
    files : list of Path
        The files that were read.
    """

    def __init__(self, header: Header, points: np.ndarray, crs: Crs, files: Optional[list[Path]] = None) -> None:
        self.header, self.points, self.crs = header, points, crs
        self.files = files or []
        self._changes: dict[str, np.ndarray] = {}
        # Cache of the coordinates as long as someone holds them, with their records and origin.
        self._shared: Optional[tuple[ReferenceType[np.ndarray], np.ndarray, np.ndarray]] = None
        low = np.array([points[axis].min() for axis in "XY"]) * (header.scale[:2] * crs.horizontal)
        low += header.offset[:2] * crs.horizontal
        self.origin = origin_before(low)

    def __len__(self) -> int:
        return len(self.points)

    @property
    def withheld(self) -> np.ndarray:
        """Points that the file says not to use, bool (n,)."""
        return self.header.layout.get(self.points, "withheld").astype(bool)

    def has(self, name: str) -> bool:
        """Whether the cloud has the dimension of that Python name, read or set."""
        dimension = _dimension(name)
        if name == "xyz" or name in self._changes:
            return True
        if dimension.standard:
            return name in self.header.layout.names
        return all(find_extra(self.header.layout, dimension, i) is not None for i in range(len(dimension.disk)))

    def foreign(self, name: str) -> list[str]:
        """Return the names under which another program stored a dimension, by type or description; often none."""
        dimension, extras = _dimension(name), self.header.layout.extras
        if dimension.standard or name in self._changes:
            return []
        found = [(disk, find_extra(self.header.layout, dimension, i)) for i, disk in enumerate(dimension.disk)]
        stored = [(disk, extras[at]) for disk, at in found if at is not None]
        return [field.name for disk, field in stored if not is_written_as(field, disk, dimension)]

    def get(self, name: str) -> np.ndarray:
        """Return a dimension by its Python name, (n,) or (n, 3), in the dtype and unit of ``dimensions.py``.

        ``xyz`` is float64, meters from ``origin``, and can't be written to, as all who ask share it: change a copy, and
        set that. What was set comes back as it was set; don't change it. Heights and areas that the file holds in its
        own unit (also under an alias, with its scale) come in meters.

        Raises
        ------
        ValueError
            If the cloud lacks it.
        """
        dimension = _dimension(name)
        if name == "xyz":
            return self._xyz()
        if name in self._changes:
            return self._changes[name]
        if not self.has(name):
            raise ValueError(f"The cloud has no {dimension.disk[0]} dimension.")
        if dimension.standard:
            return self.header.layout.get(self.points, name).astype(dimension.dtype, copy=False)
        parts = [self._extra(dimension, i) for i in range(len(dimension.disk))]
        return parts[0] if len(parts) == 1 else np.stack(parts, axis=1)

    def _xyz(self) -> np.ndarray:
        if self._shared is not None:
            reference, points, origin = self._shared
            shared = reference()
            if shared is not None and points is self.points and np.array_equal(origin, self.origin):
                return shared
        xyz = np.empty((len(self), 3))
        scale = self.header.scale * self.crs.factors
        shift = self.header.offset * self.crs.factors - self.origin
        for i, axis in enumerate("XYZ"):
            np.multiply(self.points[axis], scale[i], out=xyz[:, i])
            xyz[:, i] += shift[i]
        xyz.flags.writeable = False
        self._shared = ref(xyz), self.points, self.origin.copy()
        return xyz

    def _extra(self, dimension: Dimension, component: int) -> np.ndarray:
        at = cast(int, find_extra(self.header.layout, dimension, component))
        values = self.header.layout.extras[at].decode(self.points[f"extra{at}"])
        factor = unit_factor(dimension, self.crs)
        if values.dtype.kind == "f" and dimension.dtype[0] != "f":
            values = np.nan_to_num(values)
        return (values if factor == 1 else values * factor).astype(dimension.dtype)

    def set(self, name: str, values: np.ndarray) -> None:
        """Store a dimension by its Python name; it takes the place of one that the file has, also under an alias.

        Parameters
        ----------
        name : str
            Any of ``dimensions.py``. ``xyz``, meters from ``origin``, is rounded to the scale of the file.
        values : array, (n,) or (n, 3)
            In meters where it has a unit. Kept, not copied, where the dtype fits.

        Raises
        ------
        ValueError
            If the shape or a value does not fit, or the point format lacks the standard field.
        """
        dimension = _dimension(name)
        fitting = _fitting(dimension, np.asarray(values), len(self))
        if name == "xyz":
            self.points, self.header = self._moved(fitting), self.header.without(LAX)
            return
        if dimension.standard and name not in self.header.layout.names:
            raise ValueError(f"{dimension.disk[0]} can't be set in point format {self.header.layout.point_format}.")
        self._changes[name] = fitting

    def _moved(self, xyz: np.ndarray) -> np.ndarray:
        """Return the records with other coordinates (m, from ``origin``), in steps of the file's scale."""
        points = self.points.copy()
        step = self.header.scale * self.crs.factors
        for i, axis in enumerate("XYZ"):
            steps = xyz[:, i] + (self.origin[i] - self.header.offset[i] * self.crs.factors[i])
            steps /= step[i]
            # Round half up: the center of two points is often a half, and half to even would depend on the offset. The
            # sum of large coordinates at a half has a rounding error.
            np.floor(steps + (0.5 + 1e-4), out=steps)
            if not max(steps.max(), -steps.min()) <= LARGEST_STEP:
                raise ValueError(
                    f"Points are moved too far for the file, which reaches {LARGEST_STEP * step[i]:.0f} m from "
                    f"its offset in {axis} at a scale of {step[i]:g} m; check the coordinates."
                )
            points[axis] = steps
        return points

    def take(self, index: np.ndarray) -> Cloud:
        """Return a cloud of the points at ``index``, int (m,), m >= 1, in that order, with all their dimensions.

        Header, CRS, origin and files are taken from this cloud, which is not changed.
        """
        # Many times as fast as points[index], which goes through the fields of every record.
        points = self.points.take(index)
        taken = Cloud(replace(self.header.without(LAX), count=len(index)), points, self.crs, self.files)
        taken.origin = self.origin
        taken._changes = {name: values[index] for name, values in self._changes.items()}
        return taken

    @property
    def changed(self) -> tuple[str, ...]:
        """Names of the dimensions that were set."""
        return tuple(self._changes)

    def in_crs(self, crs: Crs) -> Cloud:
        """Return the cloud with its coordinates taken to be in another system, itself where that is its own."""
        if crs == self.crs:
            return self
        named = Cloud(self.header, self.points, crs, self.files)
        if (crs.factors == self.crs.factors).all():
            named.origin = self.origin
        for name in self.changed:
            named.set(name, self.get(name))
        return named

    def copy(self) -> Cloud:
        """Return a cloud of the same points that can be changed apart from this one; arrays are shared."""
        copy = Cloud.__new__(Cloud)
        copy.__dict__.update(self.__dict__)
        copy._changes = dict(self._changes)
        return copy

    def named(self, name: str) -> np.ndarray:
        """Return any dimension that the cloud has, (n,), by the name that users see.

        Parameters
        ----------
        name : str
            On disk (``HeightAboveGround``, ``NormalX``, or what only this file has) or in
            Python (``height_above_ground``, ``user_data``), in upper or lower case.

        Returns
        -------
        array, (n,)
            As from :meth:`get`; but X and Y are not relative to ``origin``.

        Raises
        ------
        ValueError
            If the cloud has no dimension of that name; the message names those that it has.
        """
        known = self._known()
        wanted = name.strip().lower()
        if wanted in known:
            return known[wanted][1]()
        names = ", ".join(map(shown, self.dimension_names))
        raise ValueError(f"The cloud has no dimension {name!r}; it has {names}.")

    @property
    def dimension_names(self) -> list[str]:
        """Names of all dimensions as users see them, see :meth:`named`."""
        return list(dict.fromkeys(title for title, _ in self._known().values()))

    def _known(self) -> dict[str, tuple[str, Callable[[], np.ndarray]]]:
        """Return by name, in lower case, the spelling of each dimension for users and a function for its values."""
        layout = self.header.layout
        known: dict[str, tuple[str, Callable[[], np.ndarray]]] = {}
        for dimension in (one for one in DIMENSIONS.values() if self.has(one.name)):
            for i, disk in enumerate(dimension.disk):
                known[disk.lower()] = disk, partial(self._component, dimension, i)
            for alias in (dimension.name, *dimension.aliases) if len(dimension.disk) == 1 else ():
                known[alias.lower()] = known[dimension.disk[0].lower()]
        for at, extra in enumerate(layout.extras):
            if extra.is_scalar and extra.name:
                known.setdefault(extra.name.lower(), (extra.name, partial(extra.decode, self.points[f"extra{at}"])))
        for name in layout.names:
            disk = "".join(word.capitalize() for word in name.split("_"))
            value = known.get(name.lower()) or (disk, partial(layout.get, self.points, name))
            known.setdefault(name.lower(), value)
            known.setdefault(disk.lower(), value)
        return known

    def _component(self, dimension: Dimension, i: int) -> np.ndarray:
        values = self.get(dimension.name)
        values = values if values.ndim == 1 else values[:, i]
        return values + self.origin[i] if dimension.name == "xyz" else values

    def to_map(self, coordinates: np.ndarray) -> np.ndarray:
        """Return local meters (m, 2 or 3) as float64 coordinates of the file, in its CRS and units."""
        local = np.asarray(coordinates, float)
        axes = local.shape[-1]
        return (local + self.origin[:axes]) / self.crs.factors[:axes]

    def from_map(self, coordinates: np.ndarray) -> np.ndarray:
        """Return coordinates (m, 2 or 3) of the file's CRS as float64 local meters; the inverse of :meth:`to_map`."""
        of_file = np.asarray(coordinates, float)
        axes = of_file.shape[-1]
        return of_file * self.crs.factors[:axes] - self.origin[:axes]

    def records(self, for_copc: bool = False) -> PointRecords:
        """Return the settings of the output's records."""
        return PointRecords(self.points, self.header.layout, self._changes, self.crs, for_copc)


def origin_before(low: np.ndarray) -> np.ndarray:
    """Return the origin (3,), m, for coordinates from easting and northing ``low`` (2,), m."""
    return np.append(np.floor(low / _ORIGIN_STEP) * _ORIGIN_STEP, 0.0)


def _dimension(name: str) -> Dimension:
    if name not in DIMENSIONS:
        raise ValueError(f"There is no dimension {name!r}; dimensions.py lists those there are.")
    return DIMENSIONS[name]


def _fitting(dimension: Dimension, values: np.ndarray, n: int) -> np.ndarray:
    """Return ``values`` in the dimension's dtype, or refuse what would be lost."""
    shape = (n,) if len(dimension.disk) == 1 else (n, len(dimension.disk))
    if values.shape != shape:
        raise ValueError(f"{dimension.name} must have the shape {shape}, got {values.shape}.")
    dtype = np.dtype(dimension.dtype)
    if dtype.kind in "iu" and values.dtype != dtype and n:
        low, high = values.min(), values.max()
        limits = np.iinfo(dtype)
        if not (limits.min <= low and high <= limits.max):
            raise ValueError(f"{dimension.name} must be from {limits.min} to {limits.max}, got {low} to {high}.")
    return values.astype(dtype, copy=False)


def create_cloud(arrays: dict[str, np.ndarray], wkt: str = "") -> Cloud:
    """Make a cloud from dimensions: LAS 1.4, format 6 or, with colors, 7, scale 0.001.

    Parameters
    ----------
    arrays : dict of str to array
        By Python name; ``xyz`` (n, 3) in meters is needed.
    wkt : str
        WKT, "EPSG:code" or "": the cloud's CRS.

    Returns
    -------
    Cloud
        Its origin is 0, so that its local meters are ``xyz``.

    Raises
    ------
    ValueError
        If there are no points, or a coordinate is not finite or too large to store.
    """
    xyz = np.asarray(arrays["xyz"], float)
    if not len(xyz) or not np.isfinite(xyz).all():
        raise ValueError("A cloud needs points with finite coordinates; it has no points, or some are not finite.")
    header = Header(count=len(xyz), layout=Layout(7 if "red" in arrays else 6))
    header.vlrs, header.encoding = crs_records(wkt)
    crs = read_crs(header)
    coordinates = xyz / crs.factors
    header.offset = np.floor(coordinates.min(axis=0) / _ORIGIN_STEP) * _ORIGIN_STEP
    steps = np.rint((coordinates - header.offset) / header.scale)
    if steps.max() > LARGEST_STEP:
        span = np.ptp(xyz, axis=0).max()
        raise ValueError(f"The cloud spans {span:.0f} m, more than a file of millimeters can hold.")
    points = np.zeros(len(xyz), header.layout.dtype)
    for i, axis in enumerate("XYZ"):
        points[axis] = steps[:, i]
    for name in ("return_number", "number_of_returns"):
        header.layout.put(points, name, np.ones(len(xyz), np.uint8))
    cloud = Cloud(header, points, crs)
    cloud.origin = np.zeros(3)
    for name, values in arrays.items():
        if name != "xyz":
            cloud.set(name, values)
    return cloud
