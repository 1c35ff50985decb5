"""Smooth surfaces and planes by surface growing."""

from typing import Any, Optional

import numpy as np

from ..criteria import BENDS, DEVIATIONS, GAP_SPACINGS, PLANE_NEIGHBORS, SMOOTH, WIDE_SPACING
from ..geometry.delaunay import triangulate
from ..geometry.groups import items, number_large, placed
from ..params import POINT_DENSITY
from ..planes.local_planes import Criteria, local_planes
from ..planes.surface_growing import grow_planes, grow_surfaces
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..stage import Monitor, stage, tunable

# Tolerance (radii) up to which the noise of a cloud, at least a centimeter, is used; beyond, the scan's if finer.
_OF_RADIUS = 0.25

# Reach within which neighborhoods decide on neighborhoods next to them (radii).
_GROWTH = 4.0


@stage(
    "Segmentation",
    tags="surface growing,region growing,plane growing,smooth,normals,Hough,planes,segmentation",
    writes=("segment_id",),
    # The reach of the decision on neighboring points; surfaces themselves may be larger.
    reach=lambda tunables: _GROWTH * (tunables["radius"] or GAP_SPACINGS * WIDE_SPACING),
)
def segment_surfaces(
    xyz,
    classification,
    *,
    seeds: str = tunable("least squares", choices=("least squares", "robust", "hough")),
    planarity: str = tunable("local", choices=("local", "global", "none")),
    smooth_normals: bool = tunable(False),
    proximity: str = tunable("radius", choices=("radius", "edges")),
    radius: Optional[float] = tunable(
        None, within="(0, 1000] m", automatic=f"{GAP_SPACINGS:g} times the point spacing on surfaces."
    ),
    neighbors: int = tunable(PLANE_NEIGHBORS, within="[6, 200]"),
    tolerance: Optional[float] = tunable(
        None,
        within="(0, 100] m",
        automatic=(
            f"{DEVIATIONS:g} times the root of the sum of the squares of the surface noise and {BENDS:g} point "
            "spacings."
        ),
    ),
    max_angle: float = tunable(15.0, within="(0, 90]°"),
    min_points: int = tunable(20, within="[1, 10_000_000]"),
    noise: Optional[float] = tunable(
        None,
        label="Surface noise",
        within="(0, 10] m",
        automatic=(
            "measured on the cloud, on its smoothest fifth; at least 0.01 m, or a twelfth of the radius "
            "where that is less."
        ),
        advanced=True,
    ),
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Grow surfaces from smooth seeds to the points next to them.

    A plane is fitted to the neighborhood of each point. Where it fits well, the neighborhood is a seed surface.
    Surfaces grow from seeds to points near them, as long as these lie on the plane of the surface and, on request,
    have a similar normal. Roofs, terrain, curved ramps, domes and pipes become one segment each; crowns and other
    scattered points get none. With *global* planarity each segment is a plane.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18) is left out.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Surfaces from 1; 0 if unassigned.

    Other Parameters
    ----------------
    seeds
        How the plane of a neighborhood is found. Least squares is quick and finds seeds where all points around are of
        one surface; robust least squares leaves outliers out. The local Hough transform finds planes among outliers and
        at edges, in 4 times the time.
    planarity
        Local: points are accepted near the plane of the surface around the nearest of its points, so that smooth curved
        surfaces are one. Global: near the plane of all points of the surface (plane growing). None: at any distance
        from a plane.
    smooth_normals
        Points are accepted only if their normals are like the normal of the surface next to them.
    proximity
        Points are near if they are among the nearest within the radius, or joined by an edge of the triangulation in
        plan that is no longer (for clouds with one surface above each position).
    radius
        Reach of the neighborhood in which planes are fitted, and of growth.
    neighbors
        Nearest points within the radius that are used, the point included.
    tolerance
        Distance to the plane of a surface within which points belong to it; larger joins rougher and more curved
        surfaces.
    max_angle
        Largest angle between the normals of a point and of the surface, with smooth normals only.
    min_points
        Surfaces with fewer points get no id.
    noise
        Standard deviation of the points across a smooth surface.

    Notes
    -----
    The paper grows one surface after the other. Here all grow together in rounds, and neighboring seeds that fit the
    planes of one another are one surface. A point that several surfaces could take joins its nearest neighbor's.
    Where it does not fit the plane there, the next neighbor is tried, even if that belongs to the same surface. A point
    that joins gets the least squares plane of the surface around it, as the paper asks for. The paper accepts seeds by
    the sum of squared distances. Here the limit is a root mean square distance of ``SMOOTH`` standard deviations,
    corrected for the degrees of freedom. The local Hough transform votes for 128 directions of planes through each
    point. In *global* mode planes start from the smoothest seed of each neighborhood and are joined in mutually best
    pairs where they meet.

    The neighbors and the plane of each point are kept; links between seeds are not, only the sets that they join. The
    memory beyond the cloud is 100 bytes for each point, 120 in *global* mode, with ``PLANE_NEIGHBORS`` neighbors; each
    further neighbor takes 4 bytes, and a copy without noise 30.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    sections 2.2, 3.1 and 4.1. [vosselman2004]
    Hoover, A., et al., 1996. An experimental comparison of range image segmentation algorithms. IEEE Transactions on
    Pattern Analysis and Machine Intelligence 18 (7), 673-689. [hoover1996]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> ids = segment_surfaces(xyz, np.zeros(len(xyz)))
    >>> int(ids.max())
    2
    """
    density = sampling.surface_density if density is None else density
    spacing = 1 / float(np.sqrt(density))
    radius = GAP_SPACINGS * spacing if radius is None else radius
    noise = _noise(sampling, radius) if noise is None else noise
    tolerance = DEVIATIONS * float(np.hypot(noise, BENDS * spacing)) if tolerance is None else tolerance
    monitor.resolved(density=density, noise=noise, radius=radius, tolerance=tolerance)
    used = not_noise(classification)
    if not len(used):
        return np.zeros(len(xyz), np.int32)
    if len(used) == len(xyz):
        # A slice takes no memory, and the points that it names are not copied.
        used = slice(None)
    points = xyz[used]

    planes = local_planes(points, neighbors, radius, seeds, tolerance, monitor.part(0, 0.5))
    if proximity == "edges":
        planes.neighbors = _edge_neighbors(points, radius, monitor.part(0.5, 0.6))
    is_seed = planes.deviation <= SMOOTH / DEVIATIONS * tolerance
    cosine = float(np.cos(np.radians(max_angle))) if smooth_normals else None
    criteria = Criteria(tolerance if planarity != "none" else None, cosine)
    growing = monitor.part(0.6, 1)
    if planarity == "global":
        surface = grow_planes(planes, is_seed, criteria, SMOOTH / DEVIATIONS * tolerance, growing)
    else:
        surface = grow_surfaces(planes, is_seed, criteria, growing)
    return placed(number_large(surface, min_points), used, len(xyz))


def _noise(sampling: CloudSampling, radius: float) -> float:
    """Return the surface noise (m), less than a centimeter in scans so dense that it would blur neighborhoods."""
    most = _OF_RADIUS * radius / DEVIATIONS
    return sampling.noise if sampling.noise <= most else min(sampling.noise, max(sampling.scan_noise, most))


def _edge_neighbors(points: np.ndarray, longest: float, monitor: Monitor) -> np.ndarray:
    """Return the nodes (n, k), nearest first, that edges of the triangulation in plan join to each point.

    Edges longer than ``longest`` (m) are left out; the point itself fills rows with fewer nodes.
    """
    n = len(points)
    itself = np.arange(n, dtype=np.int32)[:, None]
    if n < 3 or np.linalg.matrix_rank(points[:, :2] - points[0, :2]) < 2:
        return itself
    facets = triangulate(points[:, :2] - points[0, :2], monitor).facets.astype(np.int64)
    ends = np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [2, 0]]])
    one, other = np.divmod(np.unique(np.concatenate([ends @ [n, 1], ends @ [1, n]])), n)
    length = np.linalg.norm(points[one] - points[other], axis=1)
    order: Any = np.lexsort((length, one))
    order = order[length[order] <= longest]
    one, other = one[order], other[order]
    count = np.bincount(one, minlength=n)
    rank = items(count)[1]
    neighbors = np.repeat(itself, max(int(count.max(initial=1)), 1), axis=1)
    neighbors[one, rank] = other
    return neighbors
