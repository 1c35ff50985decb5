"""Clusters by density: DBSCAN (Ester et al., 1996), with memory that follows the points."""

import numpy as np

from ..geometry.boxes import Boxes, Offset, around, by_first_point, connected
from ..geometry.groups import placed
from ..stage import Monitor

# A point at the corner of a surface has a quarter of the neighbors of one in its middle.
_CORNER = 0.25


def points_at_corner(radius: float, density: float) -> int:
    """Return the number of points, at least 1, within ``radius`` (m) of the corner of a level surface."""
    return max(1, round(_CORNER * np.pi * radius**2 * density))


def dbscan(xyz: np.ndarray, radius: float, min_points: int, monitor: Monitor) -> np.ndarray:
    """Return the cluster (n,), int32, of each point from 0 in the order of their first cores; -1 is noise.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    radius : float
        Largest distance of neighbors, m.
    min_points : int
        Neighbors of a core, itself among them.
    monitor : Monitor
        Receives progress.

    Notes
    -----
    Points of one box with a diagonal of ``radius`` are neighbors: full boxes hold cores only and need no counting,
    and boxes of cores are joined instead of cores.
    """
    cluster = np.full(len(xyz), -1, np.int32)
    if not len(xyz):
        return cluster
    # A whisker smaller, so that rounding never puts the corners of a box farther apart than the radius.
    boxes = Boxes(xyz, radius / np.sqrt(3) * (1 - 1e-9))

    def is_near(offset: np.ndarray) -> np.ndarray:
        return (offset[:, 0] ** 2 + offset[:, 1] ** 2) + offset[:, 2] ** 2 <= radius * radius

    if min_points <= 1:
        # Every point is its own neighbor, so all are cores.
        return by_first_point(placed(connected(boxes, is_near, monitor)[boxes.box()], boxes.order, len(xyz)))
    is_core = _cores(boxes, is_near, min_points, monitor.part(0, 0.4))
    if is_core.any():
        cores, others = boxes.of(is_core), boxes.of(~is_core)
        joined = connected(cores, is_near, monitor.part(0.4, 0.8))
        component = placed(joined[cores.box()], cores.order, len(xyz), -1)
        core = np.sort(cores.order)
        cluster[core] = by_first_point(component[core])
        cluster[others.order] = _first_cluster(others, cores, cluster[cores.order], is_near, monitor.part(0.8, 1))
    return cluster


def _cores(boxes: Boxes, is_near, min_points: int, monitor: Monitor) -> np.ndarray:
    """Return the mask of points (n,), in the order of the boxes, with enough neighbors."""
    count = np.repeat(boxes.size, boxes.size)
    steps = around()
    for done, offset in enumerate(steps, start=1):
        box, beside = boxes.beside(boxes, offset)
        # Boxes in which every point has enough already need no more.
        is_open = np.minimum.reduceat(count, boxes.start)[box] < min_points
        box, beside = box[is_open], beside[is_open]
        for _, a, b in boxes.pairs(box, boxes, beside):
            near = a[is_near(boxes.xyz[a] - boxes.xyz[b])]
            if len(near):
                # Boxes come in order, so a chunk counts for a short stretch of points only.
                low = int(a[0])
                found = np.bincount(near - low)
                count[low : low + len(found)] += found
        monitor.progress(done / len(steps))
    return count >= min_points


def _first_cluster(others: Boxes, cores: Boxes, cluster: np.ndarray, is_near, monitor: Monitor) -> np.ndarray:
    """Return for the points of ``others`` the least cluster among the cores near them, -1 without any."""
    none = np.iinfo(np.int32).max
    least = np.full(len(others.order), none, np.int32)
    steps: list[Offset] = [(0, 0, 0), *around()]
    for done, offset in enumerate(steps, start=1):
        box, beside = others.beside(cores, offset)
        for _, a, b in others.pairs(box, cores, beside):
            near = is_near(others.xyz[a] - cores.xyz[b])
            np.minimum.at(least, a[near], cluster[b[near]])
        monitor.progress(done / len(steps))
    return np.where(least == none, np.int32(-1), least)
