"""Find the planes that are roofs, and join the roofs of each building."""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..geometry.groups import placed, ranked_by_least
from ..neighborhoods.dbscan import dbscan, points_at_corner
from ..params import MIN_MAPPED_AREA, POINT_DENSITY, POINT_SOURCE
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..segmentation.cluster_measures import plan_areas
from ..stage import Monitor, stage, tunable
from .bent_roofs import bent_roofs, with_bent_roofs
from .party_walls import split_blocks
from .stacked_roofs import join_stacked

# Surfaces closer than this (m) belong to one roof: roofs of two buildings are seldom as close.
_LEAST_GAP = 0.6

# Surfaces closer than this (point spacings) belong to one roof, if it is more than the least distance.
_GAP_SPACINGS = 3.0

# Surfaces farther apart than this (m), the width of a lane, are different roofs at any density.
_MOST_GAP = 5.0


@stage(
    "Buildings",
    tags="building,roof,plane,cluster,DBSCAN,photogrammetry,UAV,cadastre",
    writes=("classification", "cluster_id"),
    cost=4.0,
)
def classify_roofs(
    xyz,
    classification,
    height_above_ground,
    segment_id,
    *,
    min_height: float = tunable(2.0, "Height above the ground over which half of a roof lies.", within="[0.5, 100] m"),
    min_area: float = MIN_MAPPED_AREA,
    gap: Optional[float] = tunable(
        None,
        "Points of planes at most this far apart belong to one building.",
        label="Gap between roofs",
        within="(0, 20] m",
        automatic="3 times the point spacing, from 0.6 to 5 m.",
    ),
    density: Optional[float] = POINT_DENSITY,
    source: str = POINT_SOURCE,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Gather the planes above a height into the roofs of buildings.

    Planes that lie higher above the ground than cars and hedges are roofs; those whose points lie near each other are
    one building (class 6).

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18) is left out.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.
    segment_id : ndarray of shape (n,), int32
        Planes from 1, as "Segment planes (RANSAC)" finds them; 0 if unassigned.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Roofs get 6; points of class 6 on no roof become 1.
    cluster_id : ndarray of shape (n,), int32
        Buildings from 1, from west to east; 0 if unassigned.

    Notes
    -----
    In clouds of matched images, in which roofs are bent, smooth surfaces next to the planes of a building belong to it.
    There, rows and blocks of three level roofs or more fall into houses where walls rise 0.3 m above both roofs or the
    roofs step by 0.4 m. Matching rounds both: parapets of half a meter between level roofs are not seen at 59 points
    per m², and of steps of 0.4 m every other one is.

    The clusters are made by DBSCAN with the gap as radius and a quarter of the points that a level roof has within it.
    A cluster that one larger cluster surrounds on more than three fifths of its border, seen from above, belongs to it:
    stair houses and penthouses on flat roofs, skylights in them. The paper takes the points above the height; here
    a plane is taken whole, down to eaves that are lower, if half of it is above. That height is 2 m and not the 2.5
    m up to which "Classify walls" looks for walls, so that lean-tos are roofs and walls have as many points.
    Numbers follow the westernmost points of clusters, not the order of points.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection.
    International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1, section
    2.3. [hrutka2022]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> found, clusters = classify_roofs(xyz, classes, z, np.where(z > 0, 1, 0))
    >>> bool((found[z > 0] == 6).all()), int(clusters.max())
    (True, 1)
    """
    density = sampling.density if density is None else density
    if gap is None:
        gap = float(np.clip(_GAP_SPACINGS / np.sqrt(density), _LEAST_GAP, _MOST_GAP))
    monitor.resolved(density=density, gap=gap)
    is_roof = _is_on_roof(segment_id, height_above_ground, min_height) & ~np.isin(classification, NOISE)
    roof = np.flatnonzero(is_roof)
    result = np.where(classification == PointClass.BUILDING, np.uint8(PointClass.UNCLASSIFIED), classification)
    cluster_id = placed(_clusters(xyz[roof], gap, min_area, density, monitor.part(0, 0.5)), roof, len(xyz))
    if sampling.is_closed_surface(source) and cluster_id.any():
        bent = bent_roofs(xyz, classification, height_above_ground, cluster_id, sampling, monitor.part(0.5, 0.9))
        is_bent = _is_on_roof(bent, height_above_ground, min_height) & (cluster_id == 0)
        cluster_id = with_bent_roofs(xyz, cluster_id, is_bent, gap, min_area, density, monitor.part(0.9, 0.95))
        # A plane whose building was only found with its bent parts is surrounded by these, from close by.
        cluster_id = join_stacked(xyz, cluster_id - 1, gap / 2) + 1
        cluster_id = split_blocks(xyz, height_above_ground, cluster_id, sampling.spacing, monitor.part(0.95, 1))
    result[cluster_id > 0] = PointClass.BUILDING
    if not cluster_id.any():
        monitor.none_found(
            f"No plane of {min_area:g} m² lies {min_height:g} m or more above the ground, so no roof was found; "
            "check that the cloud shows the ground next to the buildings."
        )
    return result.astype(np.uint8), cluster_id


def _is_on_roof(segment_id: np.ndarray, height: np.ndarray, min_height: float) -> np.ndarray:
    """Return the mask of points (n,) of planes of which half of the points at least lie above a height (m)."""
    # Other programs number segments as they like, and use -1 for points of no segment.
    number, segment = np.unique(segment_id, return_inverse=True)
    high = np.bincount(segment, height >= min_height)
    on_roof = (2 * high >= np.bincount(segment)) & (number > 0)
    return on_roof[segment]


def _clusters(xyz: np.ndarray, gap: float, min_area: float, density: float, monitor: Monitor) -> np.ndarray:
    """Return the building (n,) of each roof point, from 1 and from west to east; 0 where it is too small."""
    if not len(xyz):
        monitor.progress(1.0)
        return np.zeros(0, np.int32)
    cluster = join_stacked(xyz, dbscan(xyz, gap, points_at_corner(gap, density), monitor), gap)
    number = np.zeros(len(xyz), np.int32)
    member = np.flatnonzero(cluster >= 0)
    if len(member):
        member = member[(plan_areas(xyz[member], cluster[member], density) >= min_area)[cluster[member]]]
    if len(member):
        number[member] = ranked_by_least(xyz[member, 0], cluster[member])
    return number
