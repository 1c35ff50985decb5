"""Spheres: centers where the normals of their points meet, radii, then least squares."""

from __future__ import annotations

import math
from typing import Annotated, Optional

import numpy as np

from ..geometry.boxes import by_first_point
from ..sampling.cloud_sampling import CloudSampling
from ..stage import Field, Layer, LayerFeatures, Param, stage
from .search_settings import MaxRadius, MinRadius, ShapeTolerance, check_radii, point_noise
from .searched_points import WHOLE_CLOUD, SearchedPoints, SearchIn, Shape, named, searched_points
from .shape_windows import WINDOW
from .sphere_search import LEAST_POINTS, FoundSphere, SphereSearch
from .surface_normals import NormalPoints, normal_points, surface_normals

METHODS = ("center first", "four dimensions")

_FIELDS = (
    Field("id", int, "number of the sphere, as SegmentID of its points"),
    Field("radius", float, "radius", "m"),
    Field("points", int, "points on the sphere"),
    Field("rms", float, "root mean square distance of the points from the sphere", "m"),
    Field("seen", float, "share of the sphere that has points, 0 to 1"),
)


@stage(
    "Detect spheres",
    group="Shapes",
    tags="sphere,ball,vessel,dome,target,Hough,industry,as-built",
    writes=("segment_id", "shape"),
    # Shapes go on as far as they like: a part of a cloud does not tell where one ends.
    reach=math.inf,
    layers=(Layer("centers", "Centers of spheres", "Point", _FIELDS),),
)
def detect_spheres(
    xyz,
    classification,
    segment_id=None,
    shape=None,
    *,
    method: Annotated[
        str,
        Param(
            "Method",
            "With center first, points vote for a center, and those of the best center for a radius. With four "
            "dimensions, they vote for both together, which takes more memory and tells nested spheres apart.",
            choices=METHODS,
        ),
    ] = "center first",
    min_radius: MinRadius = None,
    max_radius: MaxRadius = None,
    tolerance: ShapeTolerance = None,
    min_seen: Annotated[
        float,
        Param(
            "Minimum share seen",
            "Least share of the sphere that must have points, 0 to 1. A sphere of which less is seen has an uncertain "
            "radius.",
            low=0.05,
            high=1,
        ),
    ] = 0.15,
    min_points: Annotated[
        int, Param("Minimum points", "Points of the smallest sphere.", low=LEAST_POINTS, high=1_000_000)
    ] = 40,
    search_in: SearchIn = WHOLE_CLOUD,
    n_neighbors: NormalPoints = None,
    sampling: Optional[CloudSampling] = None,
    monitor=None,
):
    """Find spheres (vessels, domes, targets): centers with radius, and the points on each.

    Every point and its normal define a line on which the center lies. In each window points vote along it, to both
    sides, for all radii. The best center and radius are fitted by least squares and kept if their points look like a
    sphere: close to it, spread over enough of it, not following another shape, and with nothing inside.

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
        Spheres from 1, in the order of their first points; 0 is none. Numbers follow those that are kept.
    shape : ndarray of shape (n,), uint8
        3 on spheres.
    centers : LayerFeatures
        The center of each sphere as a point with its height.

    Raises
    ------
    ValueError
        If the range of radii is empty, segments are asked for and missing, all points lie on one line, or the points
        are spread too far for the windows.

    Notes
    -----
    Deviation from the paper: radii are searched octave by octave, from small to large, each in windows of four times
    the least radius and among points thinned accordingly, so that time and memory don't grow with the radius. In a
    window only one sphere is looked for at a time; windows overlap by half.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 4.3.
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
        deviation = max(noise, tolerance / 3)
        search = SphereSearch(
            points.xyz, normals[points.rows], deviation, tolerance, min_seen, min_points, method == METHODS[0]
        )
        found = search.find(min_radius, max_radius, monitor.part(0.2, 1))
        for number, one in enumerate(found, start=1):
            label[one.points] = number
    if not found:
        monitor.warn("No sphere was found; no point got a new SegmentID.")
    inside = label > 0
    old, label[inside] = label[inside], by_first_point(label[inside]) + 1
    number_of = dict(zip(old.tolist(), label[inside].tolist()))
    ids, shapes, first = named(points, label, Shape.SPHERE, segment_id, shape, len(xyz), search_in)
    return ids, shapes, _centers(points, found, number_of, first)


def _centers(points: SearchedPoints, found: list[FoundSphere], number_of: dict[int, int], first: int) -> LayerFeatures:
    """Return the centers of the spheres, by number."""
    rows = sorted(((number_of[n], one) for n, one in enumerate(found, start=1)), key=lambda row: row[0])
    ones = [one for _, one in rows]
    return LayerFeatures(
        [points.in_place(one.center, int(one.points[0])) for one in ones],
        {
            "id": [number + first for number, _ in rows],
            "radius": [one.radius for one in ones],
            "points": [len(one.points) for one in ones],
            "rms": [one.rms for one in ones],
            "seen": [one.seen for one in ones],
        },
    )
