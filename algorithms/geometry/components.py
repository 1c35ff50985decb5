"""Connected components of points under a distance in plan and one in height, exactly and in little memory."""

from __future__ import annotations

import numpy as np

from ..stage import Monitor
from .boxes import Boxes, by_first_point, connected
from .groups import placed


def connect(xyz: np.ndarray, plan_distance: float, height_distance: float, monitor: Monitor) -> np.ndarray:
    """Find the components of "closer in plan and closer in height", transitively.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    plan_distance, height_distance : float
        Two points are linked when their planimetric distance and their height difference are
        both less than these (m).
    monitor : Monitor
        Receives progress.

    Returns
    -------
    ndarray of shape (n,), int32
        Component of each point, from 0, in the order of their first points.

    Notes
    -----
    Points of one box of ``plan_distance / sqrt(2)`` by ``height_distance`` are always linked, so boxes
    are joined instead of points.
    """
    if not len(xyz):
        return np.zeros(0, np.int32)
    # Slightly smaller, so that even a box's diagonal is strictly less than the distance.
    side = np.array([plan_distance / np.sqrt(2), plan_distance / np.sqrt(2), height_distance]) * (1 - 1e-9)
    boxes = Boxes(xyz, side)

    def is_near(offset: np.ndarray) -> np.ndarray:
        return (offset[:, 0] ** 2 + offset[:, 1] ** 2 < plan_distance**2) & (np.abs(offset[:, 2]) < height_distance)

    return by_first_point(placed(connected(boxes, is_near, monitor)[boxes.box()], boxes.order, len(xyz)))


def number_large(component: np.ndarray, min_points: float) -> np.ndarray:
    """Return ids (n,), int32, from 1 for components of at least ``min_points`` points and 0 for the others.

    ``component`` holds numbers from 0; negative ones are no component.
    """
    inside = component >= 0
    size = np.bincount(component[inside]) if inside.any() else np.zeros(0, np.int64)
    large = (size >= min_points) & (size > 0)
    number = np.where(large, np.cumsum(large), 0).astype(np.int32)
    return placed(number[component[inside]], inside, len(component))
