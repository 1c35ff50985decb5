"""Merge clouds of any scales, offsets, point formats and extra dimensions."""

from dataclasses import replace
from typing import Optional

import numpy as np

from ..stage import Monitor
from .cloud import Cloud
from .crs import Crs, common_crs
from .dimensions import DIMENSIONS
from .header import Header
from .point_records import PointRecords, convert, find_extra, is_stored_as
from .points import AT_ONCE
from .vpc import merged_header


def merge_records(clouds: list[Cloud], xyz: Optional[np.ndarray], monitor: Optional[Monitor] = None) -> Cloud:
    """Return one cloud of the points of all, cloud after cloud, with the dimensions that stages have set.

    It has the finest scale, the smallest point format that holds the standard fields of all (colors and times that a
    cloud lacks are 0), and the extra dimensions of all. Where a cloud lacks one, its points have NaN, or 0 in a
    dimension of whole numbers. Fields of the header and records (VLRs) are the first cloud's, with those records that
    only others have. A cloud without coordinate reference system is taken to be in the system of the others.

    Parameters
    ----------
    clouds : list of Cloud
        One or more, of one origin, which the result has too. They are not changed.
    xyz : ndarray of shape (n, 3), float64, or None
        New coordinates of all points (m, relative to the common origin); None if none were moved.
    monitor : Monitor, optional
        Receives warnings about parts that can't be merged.

    Raises
    ------
    ValueError
        If the clouds have different coordinate reference systems, or span more than their scale can store.
    """
    monitor = monitor or Monitor()
    clouds = in_one_crs(clouds, monitor)
    crs = next((cloud.crs for cloud in clouds if cloud.crs.identity), clouds[0].crs)
    records = [_records(cloud, crs) for cloud in clouds]
    positions = _positions(clouds, xyz, crs)
    header = merged_header([_header(*one, crs) for one in zip(clouds, records, positions)], "clouds", monitor)
    points = np.zeros(header.count, header.layout.dtype)
    start = 0
    for one, position in zip(records, positions):
        _fill(points[start : start + len(position)], one, position, header)
        start += len(position)
    merged = Cloud(header, points, crs, [path for cloud in clouds for path in cloud.files])
    merged.origin = clouds[0].origin
    return merged


def in_one_crs(clouds: list[Cloud], monitor: Monitor) -> list[Cloud]:
    """Return clouds that are worked on together, all with the meters of one coordinate reference system.

    Clouds without any are taken to be in the others'; of all others the heights may have another unit.

    Raises
    ------
    ValueError
        If two have different systems.
    """
    systems = [cloud.crs for cloud in clouds]
    leader = common_crs(systems, [_name(*one) for one in enumerate(clouds, start=1)], monitor, whole=False)
    # The scale of a map differs from place to place.
    own = (replace(crs if crs.identity else leader, horizontal=leader.horizontal) for crs in systems)
    return [cloud.in_crs(crs) for cloud, crs in zip(clouds, own)]


def _name(number: int, cloud: Cloud) -> str:
    return f"Cloud {number}" + (f" ({cloud.files[-1].name})" if cloud.files else "")


def _records(cloud: Cloud, crs: Crs) -> PointRecords:
    """Return the settings of the cloud's records, with name, type and unit of known dimensions as in all the others."""
    cloud, layout, factors = cloud.copy(), cloud.header.layout, cloud.crs.factors
    for name, dimension in DIMENSIONS.items():
        if dimension.standard or not cloud.has(name):
            continue
        found = [find_extra(layout, dimension, i) for i in range(len(dimension.disk))]
        fields = [(layout.extras[at], disk) for at, disk in zip(found, dimension.disk) if at is not None]
        is_usual = all(is_stored_as(field, disk, dimension) for field, disk in fields)
        if not is_usual or (dimension.unit in ("m", "m²") and (factors != crs.factors).any()):
            cloud.set(name, cloud.get(name))
    cloud.crs = crs
    return cloud.records()


def _positions(clouds: list[Cloud], xyz: Optional[np.ndarray], crs: Crs) -> list[np.ndarray]:
    """Return the coordinates of each cloud (m, 3), on the map of the union."""
    ends = np.cumsum([len(cloud) for cloud in clouds])[:-1]
    parts = [cloud.get("xyz") for cloud in clouds] if xyz is None else np.split(xyz, ends)
    factors, origin = crs.factors, clouds[0].origin
    is_on_map = not origin.any() and (factors == 1).all()
    return [part if is_on_map else (part + origin) / factors for part in parts]


def _header(cloud: Cloud, records: PointRecords, position: np.ndarray, crs: Crs) -> Header:
    """Return the cloud's header as if its file were one of the union's system, with the points where they are now."""
    scale = cloud.header.scale * (cloud.crs.factors / crs.factors)
    low, high = position.min(axis=0), position.max(axis=0)
    return replace(cloud.header, layout=records.layout, count=len(position), scale=scale, low=low, high=high)


def _fill(out: np.ndarray, records: PointRecords, position: np.ndarray, header: Header) -> None:
    """Write the records of one cloud, with its new coordinates, to their part of the union."""
    # So that the memory in addition to the clouds and their union stays small.
    for start in range(0, len(out), AT_ONCE):
        chunk = slice(start, start + AT_ONCE)
        convert(records.take(chunk), records.layout, header.layout, out[chunk])
        for i, axis in enumerate("XYZ"):
            out[axis][chunk] = np.rint((position[chunk, i] - header.offset[i]) / header.scale[i])
