"""Planes made of the triangles of a TIN, merged from the most similar pair on."""

from typing import Optional

import numpy as np

from ..criteria import BENDS
from ..geometry.boxes import by_first_point
from ..geometry.delaunay import triangulate
from ..geometry.groups import number_large, placed
from ..neighborhoods.nearest_blocks import PAIRS
from ..params import POINT_DENSITY, SURFACE_NOISE
from ..planes.best_pairs import common_deviation, merge_best_pairs
from ..planes.least_squares_planes import Planes
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..stage import stage, tunable

# Longest edge (point spacings) of a triangle that does not lie across a gap: of evenly spread points one
# edge in a thousand is longer.
_EDGE_SPACINGS = 4.0

# Distance of the two parts from their common plane (standard deviations of points): a triangle's has the full
# error of its three points.
_WITHIN = 2.0


@stage(
    "Segmentation",
    title="Segment TIN planes",
    tags="TIN,triangulation,mesh,merge,planes,roofs,region merging",
    writes=("segment_id",),
)
def segment_tin_planes(
    xyz,
    classification,
    *,
    tolerance: Optional[float] = tunable(
        None,
        within="(0, 100] m",
        automatic=(
            f"{_WITHIN:g} times the root of the sum of the squares of the surface noise and {BENDS:g} point spacings."
        ),
    ),
    max_edge: Optional[float] = tunable(None, within="(0, 10_000] m", automatic=f"{_EDGE_SPACINGS:g} point spacings."),
    min_area: float = tunable(2.0, within="[0, 1_000_000] m²"),
    noise: Optional[float] = SURFACE_NOISE,
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Merge the triangles of a TIN to planes, the most similar neighbors first.

    Each triangle of the Delaunay triangulation in plan starts as a surface. The two adjacent surfaces that are most
    similar merge and get a common plane, until no two are similar enough. For clouds with one surface above each
    position, such as airborne ones.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18) is left out.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Planes from 1 in the order of their first points; 0 if unassigned. A point has the plane with
        most of its triangles, by area.

    Other Parameters
    ----------------
    tolerance
        Two surfaces merge if neither lies farther than this from their common plane (root mean square).
    max_edge
        Triangles with a longer edge belong to no surface: they lie across walls and gaps.
    min_area
        Area of the smallest surface, along the surface.

    Notes
    -----
    Dissimilarity is the distance, as root mean square over the area of the triangles, of the worse of the two surfaces
    from their common plane. The queue of pairs is worked off in rounds, in each of which all mutually best pairs
    merge. Of points at one position in plan one counts, and the others get no id.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 3.2. [vosselman2004]
    Gorte, B., 2002. Segmentation of TIN-structured surface models. Joint International Symposium on Geospatial Theory,
    Processing and Applications, Ottawa. [gorte2002]

    Examples
    --------
    >>> x, y = np.mgrid[0:16:0.5, 0:16:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 8) < 5) & (abs(y - 8) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> ids = segment_tin_planes(xyz, np.zeros(len(xyz)))
    >>> int(ids.max())
    2
    """
    density = sampling.density if density is None else density
    noise = sampling.noise if noise is None else noise
    spacing = 1 / float(np.sqrt(density))
    tolerance = _WITHIN * float(np.hypot(noise, BENDS * spacing)) if tolerance is None else tolerance
    max_edge = _EDGE_SPACINGS * spacing if max_edge is None else max_edge
    monitor.resolved(density=density, noise=noise, tolerance=tolerance, max_edge=max_edge)
    used = not_noise(classification)
    if not len(used):
        return np.zeros(len(xyz), np.int32)
    points = xyz[used] - xyz[used].mean(axis=0)
    segment_id = np.zeros(len(xyz), np.int32)
    if len(used) < 3 or np.linalg.matrix_rank(points[:, :2] - points[0, :2]) < 2:
        monitor.inform("All points lie on one line in plan, so that there are no triangles.")
        return segment_id

    mesh = triangulate(points[:, :2], monitor.part(0, 0.3))
    planes = _triangle_planes(points, mesh.facets)
    is_surface = (_longest_edges(points, mesh.facets) <= max_edge) & (planes.count > 0)
    number = np.where(is_surface, np.cumsum(is_surface) - 1, -1)
    one = np.repeat(number, 3)
    other = np.append(number, -1)[mesh.neighbors.ravel()]
    adjacent = (one >= 0) & (one < other)
    planes = planes.chosen(is_surface)

    def cost(parts: Planes, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        deviation = common_deviation(parts, a, b)
        return np.where(deviation <= tolerance, deviation, np.inf)

    merged, group = merge_best_pairs(planes, one[adjacent], other[adjacent], cost, monitor.part(0.3, 0.9))
    group[merged.count[group] < min_area] = -1
    segment_id[used] = number_large(_of_points(mesh.facets[is_surface], group, planes.count, len(points)), 1)
    return segment_id


def _triangle_planes(points: np.ndarray, facets: np.ndarray) -> Planes:
    """Return the planes of triangles; in place of numbers of points they have the area, m²."""
    a, b, c = np.swapaxes(points[facets], 0, 1)
    center = (a + b + c) / 3
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    # Second moments of an even triangle: its corners', a twelfth instead of a third of them.
    offsets = [corner - center for corner in (a, b, c)]
    covariance = np.column_stack([sum(offset[:, i] * offset[:, j] for offset in offsets) / 12 for i, j in PAIRS])
    return Planes(area, center, covariance)


def _longest_edges(points: np.ndarray, facets: np.ndarray) -> np.ndarray:
    """Return the longest edge (m,) of each triangle, m."""
    corners = points[facets]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)


def _of_points(facets: np.ndarray, group: np.ndarray, area: np.ndarray, n: int) -> np.ndarray:
    """Return for each of n points the group with the largest area around it, numbered by first points, or -1."""
    inside = group >= 0
    point, which = facets[inside].ravel().astype(np.int64), np.repeat(group[inside], 3)
    weight = np.repeat(area[inside], 3)
    key, position = np.unique(point * (int(group.max(initial=0)) + 1) + which, return_inverse=True)
    total = np.bincount(position, weight)
    point, which = np.divmod(key, int(group.max(initial=0)) + 1)
    order = np.lexsort((which, -total, point))
    first = order[np.unique(point[order], return_index=True)[1]]
    return by_first_point(placed(which[first], point[first], n, -1))
