"""Clusters by region growing under a distance in plan and one in height."""

from typing import Optional

import numpy as np

from ..geometry.boxes import connect
from ..geometry.groups import number_large, placed
from ..params import MIN_BUILDING_AREA, MIN_CLUSTER_HEIGHT, PAPER_THRESHOLDS, POINT_DENSITY, THRESHOLDS
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import stage, tunable
from .candidate_points import AUTOMATIC_REACH, candidates

# T_Dh over the surface noise: the paper takes 0.2 m and 0.3 m for scanners with range errors of 2-3 cm.
_HEIGHT_NOISE_FACTOR = 10.0

# Bounds of T_Dh (m), the paper's two values: with less, roofs of common slopes fall apart, and with more, in forests
# whose noise is measured too large, roofs and crowns grow together.
_HEIGHT_DISTANCES = (0.2, 0.3)


@stage(
    "Segmentation",
    tags="cluster,region growing,connected components,segmentation",
    writes=("cluster_id",),
    reach=lambda tunables: max(tunables["plan_distance"] or 0.0, AUTOMATIC_REACH),
    cost=2.0,
)
def segment_regions(
    xyz,
    classification,
    height_above_ground=None,
    *,
    thresholds: str = THRESHOLDS,
    plan_distance: Optional[float] = tunable(
        None, label="Planimetric distance", within="(0, 100] m", automatic="twice the point spacing."
    ),
    height_distance: Optional[float] = tunable(
        None,
        label="Height difference",
        within="(0, 100] m",
        automatic="10 times the measured surface noise, 0.2 to 0.3 m.",
    ),
    min_area: float = MIN_BUILDING_AREA,
    min_height: float = MIN_CLUSTER_HEIGHT,
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Gather the points that are not ground into clusters by region growing.

    Two points belong to one cluster when a chain of points leads from one to the other in which each step is
    shorter than the planimetric distance and than the height difference. Clusters with fewer points than the
    minimum building area holds at the cloud's density get no id.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground (2), noise (7, 18), water (9), bridge decks (17) and ignored
        ground (20) are left out.
    height_above_ground : ndarray of shape (n,), float32, optional
        Heights, m; needed for a minimum height.

    Returns
    -------
    cluster_id : ndarray of shape (n,), int32
        Clusters from 1, in the order of their first points; 0 if unassigned.

    Other Parameters
    ----------------
    plan_distance
        Points closer than this in plan, and close enough in height, belong together (T_Dxy; the paper has 0.6 m at 12.5
        and 1.4 m at 4 points/m²).
    height_distance
        Points whose heights differ by less than this, and that are close enough in plan, belong together (T_Dh; the
        paper has 0.2 m at 12.5 and 0.3 m at 4 points/m²).

    Raises
    ------
    ValueError
        If a minimum height is asked for and heights are missing, or the points are spread too far for the distances.

    Notes
    -----
    The paper's steps 1 to 13 grow one region after another with a sphere; their result is the transitive closure of
    equations 2 and 3, which does not depend on the order of points and is computed directly. The least number of points
    is the paper's: T_Np = Ar_min d, the minimum building area times the density. Its T_Dxy are twice the spacings that
    it states (0.3 and 0.7 m); here the spacing is s = 1 / sqrt(d), which is 0.28 and 0.5 m there. For T_Dh it names
    "internal altimetric accuracy" and takes 0.2 and 0.3 m, about ten times the range noise of the two scanners.
    Automatic is ten times the measured noise between these two values. 'Thresholds' takes the values of the paper's
    table 2 themselves.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy
    and the k-means concept, section 2.3. [santos2019]
    Sampath, A., Shan, J., 2007. Building boundary tracing and regularization from airborne LiDAR point clouds.
    Photogrammetric Engineering and Remote Sensing 73 (7), 805-812. [sampath2007]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> ids = segment_regions(xyz, classes)
    >>> bool((ids[z > 0] == 1).all()), int(ids.max())
    (True, 1)
    """
    used = candidates(classification, height_above_ground, min_height)
    if thresholds in PAPER_THRESHOLDS:
        published = PAPER_THRESHOLDS[thresholds]
        plan_distance = published.plan_distance if plan_distance is None else plan_distance
        height_distance = published.height_distance if height_distance is None else height_distance
        density = published.density if density is None else density
    density = sampling.density if density is None else density
    spacing = 1 / np.sqrt(density)
    plan_distance = 2 * spacing if plan_distance is None else plan_distance
    if height_distance is None:
        height_distance = float(np.clip(_HEIGHT_NOISE_FACTOR * sampling.noise, *_HEIGHT_DISTANCES))
    monitor.resolved(density=density, plan_distance=plan_distance, height_distance=height_distance)

    component = connect(xyz[used], plan_distance, height_distance, monitor)
    return number_large(placed(component, used, len(xyz), -1), min_area * density)
