"""Clusters by density: DBSCAN."""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..geometry.boxes import Boxes, Offset, around, by_first_point, connected
from ..geometry.groups import placed
from ..params import MIN_CLUSTER_HEIGHT, POINT_DENSITY
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Monitor, stage, tunable
from .candidate_points import candidates

# A gap of three spacings is hardly due to random sampling of a surface: one point in 10^12 has such a hole around it.
_RADIUS_SPACINGS = 3.0

# A point at the corner of a surface has a quarter of the neighbors of one in its middle.
_CORNER = 0.25


@stage(
    "Segmentation",
    title="Segment clusters (DBSCAN)",
    tags="cluster,DBSCAN,density,segmentation,objects",
    writes=("cluster_id",),
)
def segment_clusters(
    xyz,
    classification,
    height_above_ground=None,
    segment_id=None,
    *,
    radius: Optional[float] = tunable(
        None,
        "Points at most this far apart are neighbors (eps); larger joins clusters over wider gaps.",
        within="(0, 100] m",
        automatic=f"{_RADIUS_SPACINGS:g} times the point spacing.",
    ),
    min_points: Optional[int] = tunable(
        None,
        "Points within the radius, the point itself among them, that make a point the core of a cluster; "
        "larger leaves out thin objects.",
        within="[1, 1_000_000]",
        automatic="a quarter of the points of a level surface within the radius, as at the corner of a roof.",
    ),
    min_height: float = MIN_CLUSTER_HEIGHT,
    segments_only: bool = tunable(
        False, "Gather only points that have a SegmentID, such as those on planes; it must be known."
    ),
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Gather the points that are not ground into clusters where they lie densely (DBSCAN).

    A point with enough others within the radius is the core of a cluster; cores within the radius of each other
    belong together, and so does every point within the radius of one. All other points are noise and get no id.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground (2, 20), noise (7, 18), water (9) and bridge decks (17) are left out.
    height_above_ground : ndarray of shape (n,), float32, optional
        Heights, m; needed for a minimum height.
    segment_id : ndarray of shape (n,), int32, optional
        Segments from 1; needed to gather points of segments only.

    Returns
    -------
    cluster_id : ndarray of shape (n,), int32
        Clusters from 1, in the order of their first cores; 0 if unassigned.

    Raises
    ------
    ValueError
        If a minimum height is asked for and heights are missing, segments are and these are missing, or the points are
        spread too far for the radius.

    Notes
    -----
    The clusters are as by scikit-learn's DBSCAN on the same points in the same order: a point within the radius
    of cores of several clusters goes to the first of them. Memory follows the points, not their neighbors.

    References
    ----------
    Ester, M., Kriegel, H.-P., Sander, J., Xu, X., 1996. A density-based algorithm for discovering clusters in large
    spatial databases with noise. KDD-96, 226-231. [ester1996]
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.3.
    [hrutka2022]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> ids = segment_clusters(xyz, classes)
    >>> bool((ids[z > 0] == 1).all()), int(ids.max())
    (True, 1)
    """
    used = candidates(classification, height_above_ground, min_height)
    if segments_only:
        if segment_id is None:
            raise ValueError("'Segments only' needs SegmentID; run 'Segment planes (RANSAC)' first or switch it off.")
        used = used[segment_id[used] > 0]
    density = sampling.density if density is None else density
    radius = _RADIUS_SPACINGS / float(np.sqrt(density)) if radius is None else radius
    min_points = points_at_corner(radius, density) if min_points is None else min_points
    monitor.resolved(density=density, radius=radius, min_points=min_points)
    return placed(dbscan(xyz[used], radius, min_points, monitor) + 1, used, len(xyz))


def points_at_corner(radius: float, density: float) -> int:
    """Return how many points, at least 1, lie within ``radius`` (m) of the corner of a level surface."""
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
        return by_first_point(_in_order(boxes, connected(boxes, is_near, monitor)[boxes.box()]))
    is_core = _cores(boxes, is_near, min_points, monitor.part(0, 0.4))
    if is_core.any():
        cores, others = boxes.of(is_core), boxes.of(~is_core)
        component = np.full(len(xyz), -1, np.int64)
        component[cores.order] = connected(cores, is_near, monitor.part(0.4, 0.8))[cores.box()]
        core = np.sort(cores.order)
        cluster[core] = by_first_point(component[core])
        cluster[others.order] = _first_cluster(others, cores, cluster[cores.order], is_near, monitor.part(0.8, 1))
    return cluster


def _in_order(boxes: Boxes, values: np.ndarray) -> np.ndarray:
    """Return values (n,) of points in the order of their boxes in the order of the points."""
    ordered = np.empty_like(values)
    ordered[boxes.order] = values
    return ordered


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
