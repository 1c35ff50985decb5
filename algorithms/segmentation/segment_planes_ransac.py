"""Planes by sequential RANSAC in voxels."""

from typing import Optional

import numpy as np

from ..geometry.boxes import Boxes, by_first_point
from ..params import MIN_CLUSTER_HEIGHT, SEED
from ..planes.least_squares_planes import Planes
from ..planes.plane_merging import joined_planes
from ..planes.voxel_planes import VoxelPlanes
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.surface_noise import ON_PLANE, ROUGHNESS
from ..stage import Monitor, stage, tunable
from .candidate_points import candidates

# Number of points of a surface in a voxel: enough for a plane that is no chance.
_POINTS_IN_VOXEL = 20.0

# Least side of a voxel (tolerances): noise around a surface must not fill it.
_TOLERANCES_IN_VOXEL = 10.0

# Smallest voxel (m), from the paper.
_SMALLEST_VOXEL = 0.5

# Largest voxel (m), from the paper.
_LARGEST_VOXEL = 3.0


@stage(
    "Segmentation",
    title="Segment planes (RANSAC)",
    tags="plane,RANSAC,voxel,roof,wall,facade,planar,segmentation",
    writes=("segment_id", "normal"),
    written_if={"normal": "with 'Write normals'"},
    cost=2.0,
)
def segment_planes_ransac(
    xyz,
    classification,
    height_above_ground=None,
    *,
    voxel_size: Optional[float] = tunable(
        None,
        within="[0.1, 20] m",
        automatic=(
            f"wide enough for {_POINTS_IN_VOXEL:g} points of a surface and for {_TOLERANCES_IN_VOXEL:g} "
            f"tolerances, {_SMALLEST_VOXEL:g} to {_LARGEST_VOXEL:g} m."
        ),
    ),
    tolerance: Optional[float] = tunable(
        None, within="(0, 10] m", automatic=f"{ON_PLANE:.2g} times the roughness: {ROUGHNESS}."
    ),
    min_slope: float = tunable(0.0, within="[0, 90]°"),
    max_slope: float = tunable(60.0, within="[0, 90]°"),
    min_area: float = tunable(2.0, label="Minimum plane area", within="[0, 10_000] m²"),
    min_height: float = MIN_CLUSTER_HEIGHT,
    max_planes: int = tunable(4, label="Planes per voxel", within="[1, 20]", advanced=True),
    trials: int = tunable(100, within="[1, 10_000]", advanced=True),
    normals: bool = tunable(False, label="Write normals"),
    seed: int = SEED,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find planes among the points that are not ground: by RANSAC in voxels, joined where they continue each other.

    The cloud is cut into cubes. In each, planes through three random points are tried, the one with most points on it
    is fitted and taken out, and the next is looked for in the rest. Planes of neighboring cubes that are one
    plane are joined, and every point goes to the nearest of them. Planes are kept by their slope and area.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground (2, 20), noise (7, 18), water (9) and bridge decks (17) are left out.
    height_above_ground : ndarray of shape (n,), float32, optional
        Heights, m; needed for a minimum height.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Planes from 1, in the order of their first points; 0 if unassigned.
    normal : ndarray of shape (n, 3), float32, or None
        Upward normals of the planes, NaN on none; None unless asked for.

    Other Parameters
    ----------------
    voxel_size
        Side of the cubes in which planes are looked for; smaller finds smaller planes and needs denser points.
    tolerance
        Distance within which a point lies on a plane.
    min_slope
        Slope of the flattest plane that is kept; 70° keeps walls.
    max_slope
        Slope of the steepest plane that is kept; 90° keeps walls.
    min_area
        Area of the smallest plane, measured on it.
    max_planes
        Planes that are looked for in one voxel.
    trials
        Planes through three points that are tried for each plane.
    normals
        Give each point the normal of its plane (NormalX, NormalY, NormalZ); otherwise these are not written.

    Raises
    ------
    ValueError
        If a minimum height is asked for and heights are missing, the least slope is above the largest, or the points
        are spread too far for the voxels.

    Notes
    -----
    The slope of a plane is the angle of its normal from the vertical: roofs are kept up to 60°, walls have 90°. Leaves
    and other scattered points are no plane: it must have more points than a plane found by chance in one of a thousand
    voxels of scattered points. A strip narrower than 3.5 tolerances has no plane of its own. The result depends on the
    seed, not on the order of points or the number of threads.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.3.
    [hrutka2022]
    Fischler, M. A., Bolles, R. C., 1981. Random sample consensus: a paradigm for model fitting. Communications of the
    ACM 24 (6), 381-395. [fischler1981]
    Moisan, L., Stival, B., 2004. A probabilistic criterion to detect rigid point matches. International Journal of
    Computer Vision 57 (3), 201-218. [moisan2004]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> ids, normals = segment_planes_ransac(xyz, np.zeros(len(xyz)))
    >>> int(ids.max())
    2
    """
    if min_slope > max_slope:
        raise ValueError(f"The minimum slope ({min_slope:g}°) is above the maximum slope ({max_slope:g}°); lower it.")
    used = candidates(classification, height_above_ground, min_height)
    tolerance = ON_PLANE * sampling.roughness if tolerance is None else tolerance
    voxel_size = _voxel_size(sampling.surface_density, tolerance) if voxel_size is None else voxel_size
    monitor.resolved(voxel_size=voxel_size, tolerance=tolerance)

    plane, planes = np.full(len(xyz), -1), None
    if len(used):
        boxes = Boxes(xyz[used], voxel_size)
        label = VoxelPlanes(boxes, voxel_size, tolerance, max_planes, trials, seed).find(monitor.part(0, 0.6))
        planes, plane[used[boxes.order]] = joined_planes(boxes, label, tolerance, min_area, monitor.part(0.6, 1))
    return _within_slopes(plane, planes, min_slope, max_slope, normals, monitor)


def _voxel_size(density: float, tolerance: float) -> float:
    """Return the side of a voxel that suits the density of surfaces and the tolerance, m."""
    wide = max(float(np.sqrt(_POINTS_IN_VOXEL / density)), _TOLERANCES_IN_VOXEL * tolerance)
    return min(max(wide, _SMALLEST_VOXEL), _LARGEST_VOXEL)


def _within_slopes(
    plane: np.ndarray, planes: Optional[Planes], min_slope: float, max_slope: float, normals: bool, monitor: Monitor
) -> tuple[np.ndarray, Optional[np.ndarray]]:
    """Return ids of the planes (n,) with a slope in the range, and their normals (n, 3) if wanted."""
    normal = np.full((len(plane), 3), np.nan, np.float32) if normals else None
    segment_id = np.zeros(len(plane), np.int32)
    on_plane = plane >= 0
    if planes is None or not on_plane.any():
        monitor.none_found("No plane was found; no point has a SegmentID.")
        return segment_id, normal
    slope = np.degrees(np.arccos(np.clip(planes.normal[:, 2], 0, 1)))
    is_kept = (slope >= min_slope) & (slope <= max_slope)
    on_plane[on_plane] = is_kept[plane[on_plane]]
    if not on_plane.any():
        monitor.none_found(
            f"No plane has a slope from {min_slope:g}° to {max_slope:g}°, of {len(planes)} found; "
            "no point has a SegmentID."
        )
        return segment_id, normal
    segment_id[on_plane] = by_first_point(plane[on_plane]) + 1
    if normal is not None:
        normal[on_plane] = planes.normal[plane[on_plane]]
    return segment_id, normal
