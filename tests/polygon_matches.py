"""Polygons of two layers that are the same building, for tests and benchmarks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons, overlaps
from lidar_buildings.algorithms.stage import Monitor


@dataclass(frozen=True)
class Matches:
    """The polygons of one layer, each with the one of another layer that it overlaps most."""

    #: one, other, (k,), int64: positions in the two layers
    one: np.ndarray
    other: np.ndarray
    iou: np.ndarray  #: (k,): intersection over union, 0 to 1


def match_polygons(first: list, second: list, monitor: Monitor) -> Matches:
    """Return for each polygon of the first layer the one of the second with the greatest intersection over union.

    Parameters
    ----------
    first, second : list of list of ndarray
        Polygons as closed rings (k, 2), m, the exterior first.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    Matches
        Polygons that overlap no other one are left out.
    """
    polygons = as_polygons(first), as_polygons(second)
    one, other, shared = overlaps(*polygons, monitor)
    iou = shared / (polygons[0].area[one] + polygons[1].area[other] - shared)
    order = np.lexsort((other, -iou, one))
    order = order[shared[order] > 0]
    best = order[np.unique(one[order], return_index=True)[1]]
    return Matches(one[best], other[best], iou[best])
