"""Several clouds as one, so far of equal layout, scale and offset only."""

from __future__ import annotations

from dataclasses import replace
from typing import Optional

import numpy as np

from .cloud import Cloud
from .units import crs_identity


def merge_records(clouds: list[Cloud], xyz: Optional[np.ndarray]) -> Cloud:
    """Return one cloud of the points of all, cloud after cloud, with what stages have set in them.

    Parameters
    ----------
    clouds : list of Cloud
        Two or more, of one origin, which the result has too. They are not changed. So far they
        must have the same point format, extra dimensions, scale and offset.
    xyz : ndarray of shape (n, 3), float64, or None
        New coordinates of all points (m, relative to the common origin); None where none were moved.

    Raises
    ------
    ValueError
        If the clouds have different coordinate reference systems, layouts, scales or offsets.
    """
    first = clouds[0]
    layouts = [cloud.records().layout for cloud in clouds]
    for cloud, layout in zip(clouds, layouts):
        if crs_identity(cloud.wkt) != crs_identity(first.wkt):
            raise ValueError("The clouds have different coordinate reference systems; reproject them to one first.")
        if (
            layout != layouts[0]
            or ((cloud.header.scale != first.header.scale) | (cloud.header.offset != first.header.offset)).any()
        ):
            raise ValueError("The clouds are stored in different ways; write them with one scale, offset and format.")
    points = np.concatenate([cloud.records().take(slice(None)) for cloud in clouds])
    header = replace(first.header.with_layout(layouts[0]), count=len(points))
    merged = Cloud(header, points, first.units, [path for cloud in clouds for path in cloud.sources])
    merged.wkt, merged.origin = first.wkt, first.origin
    if xyz is not None:
        merged.set("xyz", xyz)
    return merged
