"""Planes by the Hough transform, in three dimensions or in two steps with normals."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..criteria import GAP_SPACINGS, WIDE_SPACING
from ..geometry.boxes import Boxes, by_first_point
from ..geometry.groups import split_groups
from ..neighborhoods.dbscan import dbscan
from ..planes.plane_merging import joined_planes
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.surface_noise import ON_PLANE, ROUGHNESS_OF_SPACING
from ..stage import Layer, Monitor, stage, tunable
from .hough_planes import HoughPlanes
from .joined_pieces import whole_plane
from .plane_polygons import PLANE_FIELDS, plane_polygons
from .search_settings import point_noise
from .searched_points import SEARCH_IN, SearchedCloud, SearchedPoints, Shape
from .surface_normals import NORMAL_POINTS, normal_points, normals_of, refuse_line

METHODS = ("points", "normals")

# Number of points of a surface in a window: enough for a maximum that is no chance.
_POINTS_IN_WINDOW = 40.0

# Least side of a window (tolerances): noise around a surface must not fill it.
_TOLERANCES_IN_WINDOW = 20.0

_DISTANCE_BIN = tunable(
    None,
    "Width of a bin in the distance of a plane. Smaller bins separate planes that lie closer; in bins "
    "smaller than the noise the points of one plane scatter over several, and its maximum is lost.",
    within="(0, 10] m",
    automatic="the tolerance: two bins side by side then hold a plane with its noise.",
)


_SLOPE_BIN = tunable(
    None,
    "Width of a bin in the slopes of a plane. Smaller bins separate directions, need more memory and time, "
    "and scatter a plane over several.",
    within="(0, 30]°",
    automatic="a plane off by half a bin is off by one distance bin at the side of the window; at most 11°.",
)


@stage(
    "Shapes",
    title="Segment planes (Hough)",
    tags="plane,Hough,Gaussian sphere,normal,roof,wall,facade,planar,segmentation,parameter space",
    writes=("segment_id", "shape"),
    reach=lambda tunables: (
        2 * (tunables["window_size"] or np.sqrt(_POINTS_IN_WINDOW) * WIDE_SPACING)
        + (tunables["max_gap"] or GAP_SPACINGS * WIDE_SPACING)
    ),
    layers=(Layer("planes", "Planes", "Polygon", PLANE_FIELDS, deviation="rms", whole=whole_plane),),
)
def segment_planes_hough(
    xyz,
    classification,
    segment_id=None,
    shape=None,
    *,
    method: str = tunable("points", choices=METHODS),
    search_in: str = SEARCH_IN,
    tolerance: Optional[float] = tunable(
        None,
        within="(0, 10] m",
        automatic=(
            f"{ON_PLANE:.2g} times the roughness of surfaces, which is the root of the sum of the squares of "
            f"the noise of the scan and of {ROUGHNESS_OF_SPACING:g} point spacings."
        ),
    ),
    distance_bin: Optional[float] = _DISTANCE_BIN,
    slope_bin: Optional[float] = _SLOPE_BIN,
    window_size: Optional[float] = tunable(
        None, within="(0, 100] m", automatic="wide enough for 40 points of a surface and for 20 tolerances."
    ),
    max_gap: Optional[float] = tunable(None, within="(0, 1000] m", automatic="3 times the point spacing on surfaces."),
    min_area: Optional[float] = tunable(
        None, label="Minimum plane area", within="[0, 10_000] m²", automatic="half the side of a window, squared."
    ),
    n_neighbors: Optional[int] = NORMAL_POINTS,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find planes as maxima of a parameter space, group their points by proximity, and draw them as polygons.

    In each window every point votes for all planes through it, in a space of two slopes and a distance; the bin with
    most votes is a plane. Its points are fitted, taken out, and the next maximum is looked for. With normals, the space
    is searched in two steps: first the direction on the Gaussian half sphere, then the distance. Planes that continue
    each other in neighboring windows are joined. Their points are then grouped by proximity, and groups that are large
    enough become segments.

    The bins decide between accuracy and reliability. Small bins give parameters more exactly and separate planes that
    are nearly the same. But in bins smaller than the noise the points of one plane scatter over several, until its
    maximum is no higher than of planes that exist by chance. Bins as wide as the noise are the best balance, since the
    parameters are determined by a least-squares fit to the points afterwards, and the automatic bins are as wide.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground (2, 20), noise (7, 18), water (9) and bridge decks (17) are left out.
    segment_id : ndarray of shape (n,), int32, optional
        Segments; needed to search in each of them.
    shape : ndarray of shape (n,), uint8, optional
        Shapes found before; points that have one are left as they are, except in a search of the whole cloud.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Planes from 1, in the order of their first points; 0 if unassigned. Numbers follow those that are kept.
    shape : ndarray of shape (n,), uint8
        1 on planes.
    planes : LayerFeatures
        The largest piece of each plane as a polygon with heights.

    Other Parameters
    ----------------
    method
        With points, each point votes for all planes through it. With normals, the normal of each point votes for a
        direction, then the point for a distance, which needs surfaces smooth enough for normals.
    tolerance
        Distance within which a point lies on a plane.
    window_size
        Side of the cubes in which planes are looked for; planes that continue in the next cube are joined.
    max_gap
        Points of a plane at most this far apart are of one surface; gaps wider than this, or than a window, part
        coplanar surfaces.
    min_area
        Area of the smallest surface, measured on it.

    Raises
    ------
    ValueError
        If segments are asked for and missing, all points lie on one line, the points are spread too far for the
        windows, or the parameter space would not fit into memory.

    Notes
    -----
    Deviations from the paper. Steep planes have no finite slope: on two further faces of a cube X and Y are written as
    functions of the other coordinates. The distance is that along the normal in place of the height at the origin, so
    that bins are as wide for steep planes. The space is of a window, not of the whole cloud: its maxima are not
    maxima of planes that exist by chance through all objects, and its memory does not grow with the cloud. A
    maximum counts with the bin next to it, where a plane at the border of two bins would be lost. A plane must hold
    more points than scattered points would have on one in a thousand windows.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 4.1. [vosselman2004]
    Hough, P. V. C., 1962. Method and means for recognizing complex patterns. U.S. Patent 3,069,654. [hough1962]
    Vosselman, G., Dijkman, S., 2001. 3D building model reconstruction from point clouds and ground plans.
    [vosselman2001]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> ids, shapes, planes = segment_planes_hough(xyz, np.zeros(len(xyz)))
    >>> len(planes)
    2
    """
    refuse_line(xyz)
    spacing = 1 / float(np.sqrt(sampling.surface_density))
    tolerance = ON_PLANE * point_noise(sampling) if tolerance is None else tolerance
    wide = max(np.sqrt(_POINTS_IN_WINDOW) * spacing, _TOLERANCES_IN_WINDOW * tolerance)
    window_size = float(wide) if window_size is None else window_size
    distance_bin = tolerance if distance_bin is None else distance_bin
    slope_bin = _slope_bin(distance_bin, window_size) if slope_bin is None else slope_bin
    max_gap = GAP_SPACINGS * spacing if max_gap is None else max_gap
    min_area = (window_size / 2) ** 2 if min_area is None else min_area
    monitor.resolved(tolerance=tolerance, window_size=window_size, distance_bin=distance_bin)
    monitor.resolved(slope_bin=slope_bin, max_gap=max_gap, min_area=min_area)
    if method == "normals":
        n_neighbors = normal_points(sampling) if n_neighbors is None else n_neighbors
        monitor.resolved(n_neighbors=n_neighbors)
    else:
        n_neighbors = None
    cloud = SearchedCloud(xyz, classification, segment_id, shape, search_in)
    points = cloud.points(window_size, sampling.corner)
    search = _Search(window_size, tolerance, distance_bin, slope_bin, n_neighbors, sampling)
    plane = search.planes(xyz, points, monitor.part(0, 0.8))
    label = _surfaces(points.xyz, plane, max_gap, min_area * sampling.surface_density, monitor.part(0.8, 1))
    if not label.any():
        monitor.none_found("No plane was found; no point got a new SegmentID.")
    ids, shapes, offset = cloud.numbered(points, label, Shape.PLANE)
    return ids, shapes, plane_polygons(xyz[points.rows], label, offset, sampling.surface_density)


@dataclass(frozen=True)
class _Search:
    """Windows, tolerance and bins (m; slopes in °), and points of a normal; None if only points vote."""

    window_size: float
    tolerance: float
    distance_bin: float
    slope_bin: float
    n_neighbors: Optional[int]
    sampling: CloudSampling

    def planes(self, xyz: np.ndarray, points: SearchedPoints, monitor: Monitor) -> np.ndarray:
        """Return the plane (k,), from 0, that each searched point of a cloud (n, 3) is on; -1 for none."""
        plane = np.full(len(points.rows), -1, np.int64)
        if not len(plane):
            return plane
        boxes = Boxes(points.xyz, self.window_size, from_zero=True)
        normals = None
        if self.n_neighbors is not None:
            # Measured in the whole cloud.
            measured = normals_of(xyz, self.n_neighbors, self.sampling, monitor.part(0, 0.375))
            normals = measured[points.rows[boxes.order]]
        slope = float(np.tan(np.radians(self.slope_bin)))
        hough = HoughPlanes(boxes, self.window_size, self.tolerance, self.distance_bin, slope)
        planes = hough.find(monitor.part(0.375, 0.875), normals)
        plane[boxes.order] = joined_planes(boxes, planes, self.tolerance, 0.0, monitor.part(0.875, 1))[1]
        return plane


def _slope_bin(distance_bin: float, window_size: float) -> float:
    """Return the width of a bin of slopes (°) that suits the width of a bin of distances (m)."""
    # In a smaller window than an automatic one bins get no coarser: they would merge planes of different directions.
    return float(np.degrees(np.arctan(4 * min(distance_bin / window_size, 1 / _TOLERANCES_IN_WINDOW))))


def _surfaces(xyz: np.ndarray, plane: np.ndarray, max_gap: float, min_points: float, monitor: Monitor) -> np.ndarray:
    """Return the surface (k,) of each point, from 1, by its plane (k,), -1 for none; 0 without, and on small ones."""
    label = np.zeros(len(plane), np.int64)
    n_planes = int(plane.max(initial=-1)) + 1
    for number, part in enumerate(split_groups(plane, n_planes)):
        monitor.progress(number / n_planes)
        if len(part) >= min_points:
            group = dbscan(xyz[part], max_gap, 1, monitor.part(number / n_planes, (number + 1) / n_planes))
            large = np.bincount(group)[group] >= min_points
            label[part[large]] = label.max(initial=0) + 1 + group[large]
    return by_first_point(label - 1) + 1
