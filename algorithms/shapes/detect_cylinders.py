"""Cylinders: axes by great circles on the Gaussian sphere, then circles across them, then least squares.

Pieces of one cylinder that a flange or the shadow of another object separates are joined.
"""

import heapq
from dataclasses import replace
from typing import Optional

import numpy as np

from ..packages import spatial
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from .cylinder_evidence import EVIDENCE
from .cylinder_fits import LEAST_POINTS, SECTORS, Cylinder, fit_cylinder
from .cylinder_search import CylinderSearch, Found
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

# Two pieces are joined if the deviation of the points of each grows by at most this (standard deviations of the noise)
# with the common cylinder. Pipes 2 m long with noise of 2 mm and axes 6 mm apart exceed it.
_MOST_APART = 0.2

# Largest ratio of the radii of two pieces: a loose bound that saves fits.
_RADII = 1.15

# Largest angle (°) between the axes of two pieces: a loose bound, too.
_ANGLE = 8.0

# Largest distance (radii) of the facing end of a piece from the axis of the other: another loose bound.
_BESIDE = 0.5

# Radius (share of the cylinder's) within which an end cap is looked for: clear of points of the wall.
_CAP_RADIUS = 0.7

# Two cylinders stay apart if the cap between them holds this share of the points expected from its area.
_CAP_SHARE = 0.3


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
        return joined(without_nested(in_place), search.evidence.positions, measured.noise, measured.spacing, max_gap)

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


def without_nested(found: list[Found]) -> list[Found]:
    """Return the cylinders without those in or around another one with more points: a wall is one surface.

    The stairs around a tank and plates that protrude from its wall look like further tanks. A cylinder is left out if
    its middle lies near the axis of the other one, between the ends of that.
    """
    order = sorted(range(len(found)), key=lambda n: (-len(found[n].points), int(found[n].points[0])))
    kept: list[int] = []
    for number in order:
        if not any(_is_within(found[number], found[other]) for other in kept):
            kept.append(number)
    return [found[number] for number in sorted(kept)]


def _is_within(one: Found, other: Found) -> bool:
    """Whether the middle of a cylinder lies in another one of about the same radius and direction."""
    offset = one.ends.mean(axis=0) - other.cylinder.center
    along = float(offset @ other.cylinder.axis)
    is_beside = float(offset @ offset) - along**2 <= (_BESIDE * other.cylinder.radius) ** 2
    return other.low <= along <= other.high and is_beside and _are_alike(one, other)


def joined(found: list[Found], xyz: np.ndarray, noise: float, spacing: float, max_gap: float) -> list[Found]:
    """Return cylinders, those that are pieces of one put together, closest pieces first.

    Parameters
    ----------
    found : list of Found
        Cylinders, in the coordinates of ``xyz``.
    xyz : ndarray of shape (n, 3)
        All points, m, sorted by elevation.
    noise, spacing : float
        Standard deviation across smooth surfaces and distance between points on them, m.
    max_gap : float
        Longest part (m) of the axis without points that is bridged.
    """
    if max_gap <= 0 or len(found) < 2:
        return found
    remaining: dict[int, Found] = dict(enumerate(found))
    beside = _neighbors(found, max_gap)
    pairs = [(one, other) for one, others in beside.items() for other in others if one < other]
    waiting = [(gap, *pair) for pair in pairs if (gap := _gap(*(remaining[one] for one in pair))) <= max_gap]
    heapq.heapify(waiting)
    number = len(found)
    while waiting:
        _, one, other = heapq.heappop(waiting)
        if one not in remaining or other not in remaining:
            continue
        whole = _as_one(remaining[one], remaining[other], xyz, noise, spacing)
        if whole is None:
            continue
        beside[number] = (beside[one] | beside[other]) - {one, other}
        for near in beside[number]:
            beside[near].add(number)
            if near in remaining and (gap := _gap(remaining[near], whole)) <= max_gap:
                heapq.heappush(waiting, (gap, near, number))
        del remaining[one], remaining[other]
        remaining[number] = whole
        number += 1
    return list(remaining.values())


def _neighbors(found: list[Found], max_gap: float) -> dict[int, set[int]]:
    """Return for each cylinder the numbers of those whose axes come as close as pieces of one do."""
    # Positions along each axis, its ends among them, at most the gap apart.
    positions, of = [], []
    for number, one in enumerate(found):
        count = int(np.ceil((one.high - one.low) / max_gap)) + 1
        positions.append(np.linspace(*one.ends, count))
        of += [number] * count
    owner, every = np.array(of), np.concatenate(positions)
    reach = max_gap + _BESIDE * np.array([one.cylinder.radius for one in found])[owner]
    near = spatial.cKDTree(every).query_ball_point(every, reach)
    beside: dict[int, set[int]] = {number: set() for number in range(len(found))}
    for number, others in zip(of, near):
        for other in owner[others].tolist():
            if other != number:
                beside[number].add(other)
                beside[other].add(number)
    return beside


def _gap(one: Found, other: Found) -> float:
    """Return the gap (m) between two pieces roughly in one line and of one radius, negative where they overlap.

    It is infinite where they are not.
    """
    if not _are_alike(one, other):
        return np.inf
    gaps = []
    for piece, other_piece in ((one, other), (other, one)):
        offset = other_piece.ends - piece.ends[0]
        along = offset @ piece.cylinder.axis
        beside = np.sqrt(np.maximum((offset**2).sum(axis=1) - along**2, 0))
        if beside.min() > _BESIDE * piece.cylinder.radius:
            return np.inf
        gaps.append(max(along.min() - (piece.high - piece.low), -along.max()))
    return float(max(gaps))


def _are_alike(one: Found, other: Found) -> bool:
    """Whether two cylinders have about the same radius and direction."""
    a, b = one.cylinder, other.cylinder
    is_as_wide = max(a.radius, b.radius) <= _RADII * min(a.radius, b.radius)
    return bool(is_as_wide and abs(a.axis @ b.axis) >= np.cos(np.radians(_ANGLE)))


def _as_one(one: Found, other: Found, xyz: np.ndarray, noise: float, spacing: float) -> Optional[Found]:
    """Return the cylinder of two pieces, None where the points of one of them or an end cap contradict it.

    The cylinder with the least squares on the points of both must be as close to the points of each as the cylinder of
    its own, but for chance. Five unknowns of k points explain 5 / k of the variance. So radius, offset and direction
    are compared at once, each as precisely as the lengths and the arcs of the pieces allow.
    """
    points = np.sort(np.concatenate([one.points, other.points]))
    longer = one if len(one.points) >= len(other.points) else other
    cylinder = fit_cylinder(xyz[points], longer.cylinder)
    for piece in (one, other):
        distance = cylinder.local(xyz[piece.points])[1] - cylinder.radius
        more = float((distance**2).mean()) - piece.rms**2
        # Twice what five unknowns explain.
        by_chance = 2 * 5 * piece.rms**2 / len(piece.points)
        if more > (_MOST_APART * noise) ** 2 + by_chance:
            return None
    along, distance, _ = cylinder.local(xyz[points])
    ends = sorted(
        (np.sort((piece.ends - cylinder.center) @ cylinder.axis) for piece in (one, other)), key=lambda two: two[0]
    )
    found = Found(cylinder, float(along.min()), float(along.max()), points, 0.0, 0.0)
    if _is_capped(found, float(ends[0][1]), float(ends[1][0]), xyz, spacing):
        return None
    rms = float(np.sqrt(((distance - cylinder.radius) ** 2).mean()))
    return replace(found, rms=rms, seen=_seen(cylinder, (one, other), xyz, spacing))


def _seen(cylinder: Cylinder, pieces: tuple[Found, Found], xyz: np.ndarray, spacing: float) -> float:
    """Return the share of the circumference on which one of the pieces has points, stray ones aside."""
    sectors = int(np.clip(2 * np.pi * cylinder.radius / (2 * spacing), 8, SECTORS))
    is_seen = np.zeros(sectors, bool)
    for piece in pieces:
        angle = cylinder.angle(cylinder.local(xyz[piece.points])[2])
        sector = np.minimum(((angle / (2 * np.pi) + 0.5) * sectors).astype(np.int64), sectors - 1)
        even = len(piece.points) / (sectors * piece.seen)
        is_seen |= np.bincount(sector, minlength=sectors) >= EVIDENCE.seen * even
    return float(is_seen.mean())


def _is_capped(found: Found, first: float, last: float, xyz: np.ndarray, spacing: float) -> bool:
    """Whether an end cap lies inside a cylinder between two positions along its axis (m from its center)."""
    cylinder = found.cylinder
    low, high = min(first, last) - cylinder.radius, max(first, last) + cylinder.radius
    corners = cylinder.center + np.outer([low, high], cylinder.axis)
    lowest, highest = corners.min(axis=0) - cylinder.radius, corners.max(axis=0) + cylinder.radius
    near = xyz[np.searchsorted(xyz[:, 2], lowest[2]) : np.searchsorted(xyz[:, 2], highest[2], side="right")]
    along, distance, _ = cylinder.local(near[((near >= lowest) & (near <= highest)).all(axis=1)])
    inside = (along >= low) & (along <= high) & (distance <= _CAP_RADIUS * cylinder.radius)
    expected = np.pi * (_CAP_RADIUS * cylinder.radius / spacing) ** 2
    return bool(inside.sum() > max(_CAP_SHARE * expected, 3))
