"""Cylinders: axes by great circles on the Gaussian sphere, then circles across them, then least squares."""

from __future__ import annotations

import math
from typing import Annotated, Optional

import numpy as np

from ..geometry.boxes import by_first_point
from ..sampling.cloud_sampling import CloudSampling
from ..stage import Field, Layer, LayerFeatures, Param, stage
from .cylinder_search import LEAST_POINTS, CylinderSearch, Found
from .search_settings import MaxRadius, MinRadius, ShapeTolerance, check_radii, point_noise
from .searched_points import WHOLE_CLOUD, SearchedPoints, SearchIn, Shape, named, searched_points
from .shape_windows import WINDOW
from .surface_normals import NormalPoints, normal_points, surface_normals

_FIELDS = (
    Field("id", int, "number of the cylinder, as SegmentID of its points"),
    Field("radius", float, "radius", "m"),
    Field("length", float, "length of the axis", "m"),
    Field("points", int, "points on the cylinder"),
    Field("rms", float, "root mean square distance of the points from the cylinder", "m"),
    Field("seen", float, "share of the circumference that has points, 0 to 1"),
)


@stage(
    "Detect cylinders",
    group="Shapes",
    tags="cylinder,pipe,tank,column,pole,Hough,Gaussian sphere,industry,as-built",
    writes=("segment_id", "shape"),
    # Shapes go on as far as they like: a part of a cloud does not tell where one ends.
    reach=math.inf,
    layers=(Layer("axes", "Axes of cylinders", "LineString", _FIELDS),),
)
def detect_cylinders(
    xyz,
    classification,
    segment_id=None,
    shape=None,
    *,
    min_radius: MinRadius = None,
    max_radius: MaxRadius = None,
    tolerance: ShapeTolerance = None,
    min_seen: Annotated[
        float,
        Param(
            "Minimum share seen",
            "Least share of the circumference that must have points, 0 to 1. A cylinder of which less is seen has an "
            "uncertain radius.",
            low=0.05,
            high=1,
        ),
    ] = 0.2,
    min_points: Annotated[
        int, Param("Minimum points", "Points of the smallest cylinder.", low=LEAST_POINTS, high=1_000_000)
    ] = 40,
    search_in: SearchIn = WHOLE_CLOUD,
    n_neighbors: NormalPoints = None,
    sampling: Optional[CloudSampling] = None,
    monitor=None,
):
    """Find cylinders (pipes, tanks, columns): axes with radius and length, and the points on each.

    In each window the normals of the points are plotted on the Gaussian sphere. The great circle along which they fill
    most of it gives the direction of an axis. The points of this circle are projected along the axis, and each votes
    along its normal, to both sides, for the center of a circle of every radius. The best circle is fitted by least
    squares, grown along its axis, and kept if its points look like a cylinder: close to it, spread over enough of its
    circumference, without a bend, and with nothing inside.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground (2), noise (7, 18), water (9) and ignored ground (20) are left out.
    segment_id : ndarray of shape (n,), int32, optional
        Segments; needed to search in each of them.
    shape : ndarray of shape (n,), uint8, optional
        Shapes found before: but in a search of the whole cloud, points that have one are left as they are.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Cylinders from 1, in the order of their first points; 0 is none. Numbers follow those that are kept.
    shape : ndarray of shape (n,), uint8
        2 on cylinders.
    axes : LayerFeatures
        The axis of each cylinder as a line with heights.

    Raises
    ------
    ValueError
        If the range of radii is empty, segments are asked for and missing, all points lie on one line, or the points
        are spread too far for the windows.

    Notes
    -----
    Deviations from the paper. Radii are searched octave by octave, from small to large, each in windows of four times
    the least radius and among points thinned accordingly: a window holds few objects, as the segments of the paper do,
    and time and memory don't grow with the radius. A bin of the Gaussian sphere counts at most a sixteenth of the
    normals, so that planes don't decide the direction. A cylinder is at least 1.5 diameters long, or one meter if its
    diameter is larger, and 0.3 diameters in any case: shorter pieces can't be told from elbows and spheres. A bend, a
    cone or a bulge shows in the distances of the points from the cylinder, which must not follow their position on it.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 4.2. Kimme, C., Ballard, D., Sklansky, J., 1975. Finding circles by an array of accumulators.
    Communications of the ACM 18 (2), 120-122. Rabbani, T., van den Heuvel, F., 2005. Efficient Hough transform for
    automatic detection of cylinders in point clouds.
    """
    sampling = sampling or CloudSampling.of(xyz, classification)
    spacing = 1 / float(np.sqrt(sampling.surface_density))
    noise = point_noise(sampling)
    tolerance = 3 * noise if tolerance is None else tolerance
    min_radius, max_radius = check_radii(min_radius, max_radius, noise, spacing, xyz)
    n_neighbors = normal_points(sampling) if n_neighbors is None else n_neighbors
    monitor.resolved(tolerance=tolerance, min_radius=min_radius, max_radius=max_radius, n_neighbors=n_neighbors)
    normals = surface_normals(xyz - xyz.min(axis=0), n_neighbors, monitor.part(0, 0.2))[0]
    points = searched_points(xyz, classification, segment_id, shape, search_in, WINDOW * max_radius)
    label, found = np.zeros(len(points.rows), np.int64), []
    if len(points.rows):
        # Noise is what the tolerance says where that is set.
        deviation = max(noise, tolerance / 3)
        search = CylinderSearch(points.xyz, normals[points.rows], deviation, tolerance, spacing, min_seen, min_points)
        found = search.find(min_radius, max_radius, monitor.part(0.2, 1))
        for number, one in enumerate(found, start=1):
            label[one.points] = number
    if not found:
        monitor.warn("No cylinder was found; no point got a new SegmentID.")
    inside = label > 0
    old, label[inside] = label[inside], by_first_point(label[inside]) + 1
    number_of = dict(zip(old.tolist(), label[inside].tolist()))
    ids, shapes, first = named(points, label, Shape.CYLINDER, segment_id, shape, len(xyz), search_in)
    return ids, shapes, _axes(points, found, number_of, first)


def _axes(points: SearchedPoints, found: list[Found], number_of: dict[int, int], first: int) -> LayerFeatures:
    """Return the axes of the cylinders, by number."""
    rows = sorted(((number_of[n], one) for n, one in enumerate(found, start=1)), key=lambda row: row[0])
    ones = [one for _, one in rows]
    return LayerFeatures(
        [points.in_place(one.ends, int(one.points[0])) for one in ones],
        {
            "id": [number + first for number, _ in rows],
            "radius": [one.cylinder.radius for one in ones],
            "length": [one.high - one.low for one in ones],
            "points": [len(one.points) for one in ones],
            "rms": [one.rms for one in ones],
            "seen": [one.seen for one in ones],
        },
    )
