"""Several clouds as one, whatever their scales, offsets, point formats and extra dimensions."""

from __future__ import annotations

from dataclasses import replace
from typing import Optional

import numpy as np

from ..stage import Monitor
from .cloud import Cloud
from .dimensions import DIMENSIONS
from .header import Header
from .point_records import PointRecords, convert, find_extra, is_stored_as
from .units import Units, crs_identity
from .vpc import merged_header

# Points converted at once: the memory beside the clouds and their union stays small.
_CHUNK = 500_000


def merge_records(clouds: list[Cloud], xyz: Optional[np.ndarray], monitor: Optional[Monitor] = None) -> Cloud:
    """Return one cloud of the points of all, cloud after cloud, with what stages have set in them.

    It has the finest scale, the smallest point format that holds the standard fields of all (colors and times that a
    cloud lacks are 0), and the extra dimensions of all. Where a cloud lacks one, its points have NaN, or 0 in a
    dimension of whole numbers. Fields of the header and records (VLRs) are the first cloud's, with those records that
    only others have. A cloud without coordinate reference system is taken to be in that of the others.

    Parameters
    ----------
    clouds : list of Cloud
        One or more, of one origin, which the result has too. They are not changed.
    xyz : ndarray of shape (n, 3), float64, or None
        New coordinates of all points (m, relative to the common origin); None where none were moved.
    monitor : Monitor, optional
        Receives warnings about what can't be merged.

    Raises
    ------
    ValueError
        If the clouds have different coordinate reference systems, or span more than their scale can store.
    """
    monitor = monitor or Monitor()
    leader = _leader(clouds, monitor)
    records = [_records(cloud, leader.units) for cloud in clouds]
    positions = _positions(clouds, xyz, leader.units)
    headers = [_header(*one, leader.units) for one in zip(clouds, records, positions)]
    header = merged_header(headers, "clouds", monitor)
    points = np.zeros(header.count, header.layout.dtype)
    start = 0
    for one, position in zip(records, positions):
        _fill(points[start : start + len(position)], one, position, header)
        start += len(position)
    merged = Cloud(header, points, leader.units, [path for cloud in clouds for path in cloud.files])
    merged.wkt, merged.origin = leader.wkt, clouds[0].origin
    return merged


def _leader(clouds: list[Cloud], monitor: Monitor) -> Cloud:
    """Return the cloud whose coordinate reference system the union has: the first that has one."""
    named = [(number, cloud) for number, cloud in enumerate(clouds, start=1) if cloud.wkt]
    if not named:
        return clouds[0]
    first, leader = named[0]
    for number, cloud in named:
        one, other = crs_identity(leader.wkt), crs_identity(cloud.wkt)
        if one != other:
            raise ValueError(
                f"{_name(leader, first)} and {_name(cloud, number)} have different coordinate reference systems "
                f"({one[:40]}, {other[:40]}); reproject them to one first."
            )
    for number, cloud in enumerate(clouds, start=1):
        if not cloud.wkt:
            monitor.warn(
                f"{_name(cloud, number)} names no coordinate reference system; it is taken to be in that of "
                f"{_name(leader, first)}, in meters."
            )
    return leader


def _name(cloud: Cloud, number: int) -> str:
    return f"Cloud {number}" + (f" ({cloud.files[-1].name})" if cloud.files else "")


def _records(cloud: Cloud, units: Units) -> PointRecords:
    """Return what makes the cloud's records, its known dimensions with name, type and unit as in all the others."""
    cloud, layout, factors = cloud.copy(), cloud.header.layout, cloud.units.factors
    for name, dimension in DIMENSIONS.items():
        if dimension.standard or not cloud.has(name):
            continue
        found = [find_extra(layout, dimension, i) for i in range(len(dimension.disk))]
        fields = [(layout.extras[at], disk) for at, disk in zip(found, dimension.disk) if at is not None]
        is_usual = all(is_stored_as(field, disk, dimension) for field, disk in fields)
        if not is_usual or (dimension.unit in ("m", "m²") and (factors != units.factors).any()):
            cloud.set(name, cloud.get(name))
    cloud.units = units
    return cloud.records()


def _positions(clouds: list[Cloud], xyz: Optional[np.ndarray], units: Units) -> list[np.ndarray]:
    """Return the coordinates of each cloud (m, 3), on the map of the union."""
    ends = np.cumsum([len(cloud) for cloud in clouds])[:-1]
    parts = [cloud.get("xyz") for cloud in clouds] if xyz is None else np.split(xyz, ends)
    factors, origin = units.factors, clouds[0].origin
    is_on_map = not origin.any() and (factors == 1).all()
    return [part if is_on_map else (part + origin) / factors for part in parts]


def _header(cloud: Cloud, records: PointRecords, position: np.ndarray, units: Units) -> Header:
    """Return the cloud's header as if its file were one of the union's units, with the points where they are now."""
    scale = cloud.header.scale * (cloud.units.factors / units.factors)
    low, high = position.min(axis=0), position.max(axis=0)
    return replace(cloud.header, layout=records.layout, count=len(position), scale=scale, low=low, high=high)


def _fill(out: np.ndarray, records: PointRecords, position: np.ndarray, header: Header) -> None:
    """Write the records of one cloud, with its new coordinates, to their part of the union."""
    for start in range(0, len(out), _CHUNK):
        chunk = slice(start, start + _CHUNK)
        convert(records.take(chunk), records.layout, header.layout, out[chunk])
        for i, axis in enumerate("XYZ"):
            out[axis][chunk] = np.rint((position[chunk, i] - header.offset[i]) / header.scale[i])
