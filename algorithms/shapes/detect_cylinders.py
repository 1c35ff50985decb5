"""Cylinders: axes by great circles on the Gaussian sphere, then circles across them, then least squares."""

from typing import Optional

from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from .cylinder_fits import LEAST_POINTS
from .cylinder_search import CylinderSearch, Found
from .joined_cylinders import joined, without_nested
from .joined_pieces import whole_axis
from .search_settings import MAX_RADIUS, MIN_RADIUS, SHAPE_TOLERANCE, reach_of_radius
from .searched_points import SEARCH_IN, MeasuredPoints, SearchedCloud, SearchTunables, Shape, search_shapes
from .surface_normals import NORMAL_POINTS

_FIELDS = (
    Field("id", int, "number of the cylinder, as SegmentID of its points", numbers="segment_id"),
    Field("radius", float, "radius", "m"),
    Field("length", float, "length of the axis", "m"),
    Field("points", int, "points on the cylinder"),
    Field("rms", float, "root mean square distance of the points from the cylinder", "m"),
    Field("seen", float, "share of the circumference that has points, 0 to 1"),
)


@stage(
    "Shapes",
    tags="cylinder,pipe,tank,column,pole,Hough,Gaussian sphere,industry,as-built",
    writes=("segment_id", "shape"),
    reach=lambda tunables: reach_of_radius(tunables["max_radius"]) + tunables["max_gap"],
    layers=(Layer("axes", "Axes of cylinders", "LineString", _FIELDS, radius="radius", whole=whole_axis),),
)
def detect_cylinders(
    xyz,
    classification,
    segment_id=None,
    shape=None,
    *,
    min_radius: Optional[float] = MIN_RADIUS,
    max_radius: Optional[float] = MAX_RADIUS,
    tolerance: Optional[float] = SHAPE_TOLERANCE,
    min_seen: float = tunable(0.2, label="Minimum share seen", within="[0.05, 1]"),
    min_points: int = tunable(40, within=f"[{LEAST_POINTS}, 1_000_000]"),
    max_gap: float = tunable(1.0, within="[0, 100] m"),
    search_in: str = SEARCH_IN,
    n_neighbors: Optional[int] = NORMAL_POINTS,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find cylinders (pipes, tanks, columns): axes with radius and length, and the points on each.

    In each window the normals of the points are plotted on the Gaussian sphere. The great circle along which they fill
    most of it gives the direction of an axis. The points of this circle are projected along the axis, and each votes
    along its normal, to both sides, for the center of a circle of every radius. The best circle is fitted by least
    squares, grown along its axis, and kept if its points look like a cylinder. They must be close to it, spread over
    enough of its circumference, without a bend and with little inside. The surface must end at the visible arc; the
    surface of a kerb goes on. Of cylinders inside others the one with most points is kept. Pieces of one pipe that a
    flange or the shadow of another object separates are put together, if one cylinder lies as close to the points of
    each as its own one.

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
        Cylinders from 1, in the order of their first points; 0 if unassigned. Numbers follow those that are kept.
    shape : ndarray of shape (n,), uint8
        2 on cylinders.
    axes : LayerFeatures
        The axis of each cylinder as a line with heights.

    Other Parameters
    ----------------
    min_seen
        Least share of the circumference that must have points, 0 to 1. A cylinder of which less is seen has an
        uncertain radius.
    min_points
        Points of the smallest cylinder.
    max_gap
        Longest part of an axis without points, behind a flange or in the shadow of another object, across which pieces
        of one radius in one line are put together; 0 leaves them apart. An end cap always separates them.

    Raises
    ------
    ValueError
        If the range of radii is empty, segments are asked for and missing, all points lie on one line, or the points
        are spread too far for the windows.

    Notes
    -----
    Deviations from the paper. Radii are searched octave by octave, from small to large, each in windows of four times
    the least radius and among points thinned accordingly. A window holds few objects, as the segments of the paper do,
    and time and memory don't grow with the radius. A bin of the Gaussian sphere counts at most a sixteenth of the
    normals, so that planes don't decide the direction. A cylinder is at least 1.5 diameters long, or one meter if that
    is less, and 0.3 diameters in any case: shorter pieces can't be distinguished from elbows and spheres. A
    bend, a cone or a bulge shows in the distances of the points from the cylinder. These must not follow their position
    on it by more than 0.6 of the noise and 0.3 % of the radius, the tolerance to which tanks are built. The inside is
    counted in ten slices along the axis, of which the middle one decides, so that a roof within the wall has no effect.
    The paper does not put pieces together; here they are also where they lie in different segments.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 4.2. [vosselman2004]
    Kimme, C., Ballard, D., Sklansky, J., 1975. Finding circles by an array of accumulators. Communications of the ACM
    18 (2), 120-122. [kimme1975]
    Rabbani, T., van den Heuvel, F., 2005. Efficient Hough transform for automatic detection of cylinders in point
    clouds. [rabbani2005]

    Examples
    --------
    >>> import numpy as np
    >>> angle, along = np.mgrid[0:6.28:0.05, 0:4:0.05].reshape(2, -1)
    >>> xyz = np.column_stack([along, 0.5 * np.cos(angle), 0.5 * np.sin(angle)])
    >>> ids, shapes, axes = detect_cylinders(xyz, np.zeros(len(xyz)))
    >>> len(axes), round(float(axes.columns["radius"][0]), 2)
    (1, 0.5)
    """

    def search(measured: MeasuredPoints, low: float, high: float, monitor: Monitor) -> list[Found]:
        search = CylinderSearch(measured, min_seen, min_points)
        in_place = [one.moved(-measured.shift[one.points[0]]) for one in search.find(low, high, monitor)]
        positions = search.evidence.positions
        return joined(without_nested(in_place), positions, measured.noise, measured.spacing, max_gap)

    cloud = SearchedCloud(xyz, classification, segment_id, shape, search_in)
    tunables = SearchTunables(min_radius, max_radius, tolerance, n_neighbors)
    found = search_shapes(cloud, Shape.CYLINDER, search, tunables, sampling, monitor)
    ones = found.shapes
    axes = LayerFeatures(
        [one.ends + found.points.origin for one in ones],
        {
            "id": found.numbers,
            "radius": [one.cylinder.radius for one in ones],
            "length": [one.high - one.low for one in ones],
            "points": [len(one.points) for one in ones],
            "rms": [one.rms for one in ones],
            "seen": [one.seen for one in ones],
        },
    )
    return found.segment_id, found.shape, axes
