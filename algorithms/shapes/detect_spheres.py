"""Spheres: centers where the normals of their points meet, radii, then least squares."""

from __future__ import annotations

from typing import Optional

from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from .search_settings import MAX_RADIUS, MIN_RADIUS, SHAPE_TOLERANCE, reach_of_radius
from .searched_points import SEARCH_IN, MeasuredPoints, SearchTunables, Shape, search_shapes
from .sphere_search import LEAST_POINTS, FoundSphere, SphereSearch
from .surface_normals import NORMAL_POINTS

CENTER_FIRST, _FOUR_DIMENSIONS = METHODS = ("center first", "four dimensions")

_FIELDS = (
    Field("id", int, "number of the sphere, as SegmentID of its points", numbers="segment_id"),
    Field("radius", float, "radius", "m"),
    Field("points", int, "points on the sphere"),
    Field("rms", float, "root mean square distance of the points from the sphere", "m"),
    Field("seen", float, "share of the sphere that has points, 0 to 1"),
)


@stage(
    "Shapes",
    tags="sphere,ball,vessel,dome,target,Hough,industry,as-built",
    writes=("segment_id", "shape"),
    reach=lambda tunables: reach_of_radius(tunables["max_radius"]),
    layers=(Layer("centers", "Centers of spheres", "Point", _FIELDS, radius="radius"),),
)
def detect_spheres(
    xyz,
    classification,
    segment_id=None,
    shape=None,
    *,
    method: str = tunable(
        CENTER_FIRST,
        "With center first, points vote for a center, and the voters of the best center for a radius. With four "
        "dimensions, they vote for both together, which takes more memory.",
        choices=METHODS,
    ),
    min_radius: Optional[float] = MIN_RADIUS,
    max_radius: Optional[float] = MAX_RADIUS,
    tolerance: Optional[float] = SHAPE_TOLERANCE,
    min_seen: float = tunable(
        0.15,
        "Least share of the sphere that must have points, 0 to 1. A sphere of which less is seen has an uncertain "
        "radius.",
        label="Minimum share seen",
        within="[0.05, 1]",
    ),
    min_points: int = tunable(40, "Points of the smallest sphere.", within=f"[{LEAST_POINTS}, 1_000_000]"),
    search_in: str = SEARCH_IN,
    n_neighbors: Optional[int] = NORMAL_POINTS,
    sampling: CloudSampling = MEASURED,
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
        ASPRS classes; ground (2, 20), noise (7, 18), water (9) and bridge decks (17) are left out.
    segment_id : ndarray of shape (n,), int32, optional
        Segments; needed to search in each of them.
    shape : ndarray of shape (n,), uint8, optional
        Shapes found before; points that have one are left as they are, except in a search of the whole cloud.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Spheres from 1, in the order of their first points; 0 if unassigned. Numbers follow those that are kept.
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
    the least radius and among points thinned accordingly. So time and memory don't grow with the radius. In a window
    only one sphere is looked for at a time; windows overlap by half.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 4.3. [vosselman2004]

    Examples
    --------
    >>> import numpy as np
    >>> angle, up = np.mgrid[0:6.28:0.05, -1.5:1.5:0.05].reshape(2, -1)
    >>> level = np.column_stack([np.cos(angle), np.sin(angle)]) * np.cos(up)[:, None]
    >>> xyz = np.column_stack([level, np.sin(up)])
    >>> ids, shapes, centers = detect_spheres(xyz, np.zeros(len(xyz)))
    >>> len(centers), round(float(centers.columns["radius"][0]), 2)
    (1, 1.0)
    """

    def search(measured: MeasuredPoints, low: float, high: float, monitor: Monitor) -> list[FoundSphere]:
        return SphereSearch(
            measured.xyz,
            measured.normals,
            measured.noise,
            measured.tolerance,
            min_seen,
            min_points,
            method == CENTER_FIRST,
        ).find(low, high, monitor)

    tunables = SearchTunables(min_radius, max_radius, tolerance, n_neighbors, search_in)
    found = search_shapes((xyz, classification, segment_id, shape), Shape.SPHERE, search, tunables, sampling, monitor)
    ones = found.shapes
    centers = LayerFeatures(
        [found.points.in_place(one.center, int(one.points[0])) for one in ones],
        {
            "id": found.numbers,
            "radius": [one.radius for one in ones],
            "points": [len(one.points) for one in ones],
            "rms": [one.rms for one in ones],
            "seen": [one.seen for one in ones],
        },
    )
    return found.segment_id, found.shape, centers
