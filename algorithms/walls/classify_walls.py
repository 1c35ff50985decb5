"""Find the points of walls and the roof above each."""

from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.groups import members
from ..neighborhoods import covariance
from ..packages import spatial
from ..params import SURFACE_NOISE
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.surface_noise import LEAST_NEIGHBORS, ON_PLANE, SURFACES, plane_roughness, surface_density
from ..segmentation.candidate_points import NO_OBJECTS
from ..stage import Monitor, stage, tunable
from ..threads import n_threads
from .surroundings import CELL, NEAR

# Radius of the neighborhood of a normal (times the roughness): large enough for an error of a few degrees.
_REACH_DEVIATIONS = SURFACES.reach

# Largest number of points of a normal that is set automatically: more would reach around corners.
_MOST_NEIGHBORS = 30

# Hull of a roof without area: one side with every point outside.
_NOWHERE = np.array([[0.0, 0.0, np.inf]])


@stage(
    "Buildings",
    tags="building,wall,facade,normal,vertical,photogrammetry,UAV,cadastre",
    writes=("classification", "wall_of"),
)
def classify_walls(
    xyz,
    classification,
    height_above_ground,
    cluster_id,
    *,
    min_height: float = tunable(0.3, within="[0, 10] m"),
    max_height: float = tunable(2.5, within="[0.5, 100] m"),
    max_tilt: float = tunable(30.0, within="[0, 90]°"),
    neighborhood: str = tunable("nearest", choices=("nearest", "radius")),
    n_neighbors: Optional[int] = tunable(
        None,
        label="Nearest points",
        within="[3, 1000]",
        automatic=(
            f"as many as reach {_REACH_DEVIATIONS:g} times the roughness at the density of low points near "
            "roofs, 8 to 30."
        ),
    ),
    radius: float = tunable(0.5, within="(0, 10] m"),
    noise: Optional[float] = SURFACE_NOISE,
    margin: float = tunable(0.3, label="Margin around roofs", within="[0, 20] m"),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find the points of walls below roofs: lower than roofs, upright, and inside the grown hull of a roof.

    Each wall point gets the number of the roof above it (WallOf) and becomes building (class 6); only roofs keep a
    ClusterID, so that both can be distinguished.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground, water and noise are no walls.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.
    cluster_id : ndarray of shape (n,), int32
        Buildings of roof points from 1, as "Classify roofs" finds them; 0 if unassigned.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Walls get 6.
    wall_of : ndarray of shape (n,), int32
        Building of each wall point; 0 if unassigned.

    Other Parameters
    ----------------
    min_height
        Lower points may be ground, kerbs and plants.
    max_height
        Walls are looked for up to this height above the ground.
    max_tilt
        Largest angle of a wall to the vertical.
    neighborhood
        Which points give a point its normal: a number of nearest ones, or all within a radius.
    n_neighbors
        Points that a normal is made of, the point itself among them; used by the neighborhood 'nearest'.
    radius
        Radius of the sphere around a point; used by the neighborhood 'radius'.
    margin
        How far the convex hull of a roof is grown; walls outside it belong to no roof.

    Raises
    ------
    ValueError
        If the minimum height is above the maximum height.

    Notes
    -----
    The normal belongs to the plane of the neighbors, which are low points near roofs; neighbors that lie on no plane
    (bushes, corners) make no wall. A point belongs to the nearest roof, if the hull of that roof holds it. The paper
    scales hulls up; here they grow by the same distance on all sides, whatever their size.

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
    >>> classes = np.where(z > 0, 6, 2)
    >>> found, roof = classify_walls(xyz, classes, z, np.where(z > 0, 1, 0))
    >>> int(roof.max())
    0
    """
    if min_height > max_height:
        raise ValueError(
            f"The minimum height of walls ({min_height:g} m) is above the maximum height ({max_height:g} m); lower it."
        )
    noise = sampling.noise if noise is None else noise
    roughness = plane_roughness(noise, sampling.surface_density)
    monitor.progress(0.2)
    wall_of = np.zeros(len(xyz), np.int32)
    is_low = (height_above_ground >= min_height) & (height_above_ground < max_height)
    low = np.flatnonzero(is_low & (cluster_id == 0) & ~np.isin(classification, NO_OBJECTS))
    owner = _owners(xyz[low, :2], xyz[:, :2], cluster_id, margin)
    low, owner = low[owner > 0], owner[owner > 0]
    monitor.progress(0.4)
    n_neighbors = _neighbors(xyz[low], roughness) if n_neighbors is None else n_neighbors
    monitor.resolved(noise=noise, n_neighbors=n_neighbors)
    if len(low):
        is_nearest = neighborhood == "nearest"
        chosen = covariance.Nearest(n_neighbors) if is_nearest else covariance.Within(radius)
        upright = _upright(xyz[low], chosen, max_tilt, ON_PLANE * roughness, monitor.part(0.4, 1))
        wall_of[low[upright]] = owner[upright]
    if cluster_id.any() and not wall_of.any():
        monitor.none_found("No wall was seen under any roof, so footprints can show the outlines of roofs only.")
    return np.where(wall_of > 0, np.uint8(PointClass.BUILDING), classification).astype(np.uint8), wall_of


def _neighbors(xyz: np.ndarray, roughness: float) -> int:
    """Return the number of neighbors for the normal of a wall: few if walls are precise or thinly covered."""
    if not len(xyz):
        return LEAST_NEIGHBORS
    # Use the density of walls, not of the cloud: from above and under eaves, walls have far fewer points.
    reached = np.pi * (_REACH_DEVIATIONS * roughness) ** 2 * surface_density(xyz)
    return int(np.clip(reached, LEAST_NEIGHBORS, _MOST_NEIGHBORS))


def _owners(xy: np.ndarray, all_xy: np.ndarray, cluster_id: np.ndarray, margin: float) -> np.ndarray:
    """Return the roof (n,) that is nearest to each point in plan and whose grown hull holds it; 0 where none does."""
    owner = np.zeros(len(xy), np.int32)
    roof = np.flatnonzero(cluster_id)
    if not len(roof) or not len(xy):
        return owner
    start = all_xy[roof[0]]
    roofs = members(cluster_id)
    cell = np.floor((all_xy[roof] - start) / CELL).astype(np.int64)
    _, first = np.unique(np.column_stack([cell, cluster_id[roof]]), axis=0, return_index=True)
    positions = (cell[first] + 0.5) * CELL
    nearest = spatial.cKDTree(positions).query(xy - start, distance_upper_bound=NEAR + margin, workers=n_threads())[1]
    found = np.flatnonzero(nearest < len(first))
    owner[found] = cluster_id[roof[first]][nearest[found]]
    for number, part in members(owner).items():
        sides = _hull(all_xy[roofs[number]] - start)
        owner[part[((xy[part] - start) @ sides[:, :2].T + sides[:, 2] > margin).any(axis=1)]] = 0
    return owner


def _hull(xy: np.ndarray) -> np.ndarray:
    """Return the sides (k, 3) of a convex hull: outward unit normal and offset, n·p + d <= 0 inside."""
    # A roof that is a line has no hull.
    is_wide = len(xy) >= 3 and np.linalg.eigvalsh(np.cov(xy.T))[0] > 1e-6
    return spatial.ConvexHull(xy).equations if is_wide else _NOWHERE


def _upright(
    xyz: np.ndarray, neighborhood: covariance.Neighborhood, max_tilt: float, max_deviation: float, monitor: Monitor
) -> np.ndarray:
    """Return the mask of points (n,) that lie on a steep plane with their neighbors (°, m)."""
    upright = np.zeros(len(xyz), bool)

    def keep(rows: np.ndarray, shapes: covariance.Shapes) -> None:
        eigenvalues = covariance.defined_eigenvalues(shapes.covariances, shapes.counts)
        lift = np.abs(covariance.smallest_eigenvectors(shapes.covariances, eigenvalues)[:, 2])
        with np.errstate(invalid="ignore"):
            upright[rows] = (lift <= np.sin(np.radians(max_tilt))) & (eigenvalues[:, 2] <= max_deviation**2)

    covariance.reduce_neighborhoods(xyz, neighborhood, keep, monitor=monitor)
    return upright
