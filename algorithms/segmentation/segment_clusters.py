"""Clusters by density: DBSCAN."""

from typing import Optional

import numpy as np

from ..criteria import GAP_SPACINGS
from ..geometry.groups import placed
from ..neighborhoods.dbscan import dbscan, points_at_corner
from ..params import MIN_CLUSTER_HEIGHT, POINT_DENSITY
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import stage, tunable
from .candidate_points import candidates


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
        None, within="(0, 100] m", automatic=f"{GAP_SPACINGS:g} times the point spacing."
    ),
    min_points: Optional[int] = tunable(
        None,
        within="[1, 1_000_000]",
        automatic="a quarter of the points of a level surface within the radius, as at the corner of a roof.",
    ),
    min_height: float = MIN_CLUSTER_HEIGHT,
    segments_only: bool = tunable(False),
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

    Other Parameters
    ----------------
    radius
        Points at most this far apart are neighbors (eps); larger joins clusters over wider gaps.
    min_points
        Points within the radius, the point itself among them, that make a point the core of a cluster; larger leaves
        out thin objects.
    segments_only
        Gather only points that have a SegmentID, such as those on planes; it must be known.

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
    radius = GAP_SPACINGS / float(np.sqrt(density)) if radius is None else radius
    min_points = points_at_corner(radius, density) if min_points is None else min_points
    monitor.resolved(density=density, radius=radius, min_points=min_points)
    return placed(dbscan(xyz[used], radius, min_points, monitor) + 1, used, len(xyz))
