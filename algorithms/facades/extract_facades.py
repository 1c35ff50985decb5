"""Facades as vertical polygons: planes, curved fronts as strips of planes, boundaries, and common borders."""

from dataclasses import replace
from typing import Optional

import numpy as np

from ..criteria import DEVIATIONS, PARALLEL
from ..geometry.grid import connected_cells, distinct, find_cells, grid_over, shared_cells
from ..geometry.groups import components, least_of, members
from ..params import BOUNDARY, COMPLETE_FACADES, CORNER_DISTANCE, FACADE_GAP, FACADE_TILT, SEED
from ..planes.least_squares_planes import Planes, off_planes, planes_of
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..segmentation.segment_planes_ransac import segment_planes_ransac
from ..stage import Field, Layer, LayerFeatures, Monitor, ProgressOnly, stage, tunable
from .common_borders import with_common_borders
from .facade_outline import Drawing
from .facade_surfaces import CELL, FARTHEST, ONE_FRONT, Facade, facade_features, plane_of, surfaces_of
from .segment_facade_lines import are_of_facade_lines

# Standard deviation (m) of plaster, joints and cladding about the plane of a wall, in addition to the noise.
_RELIEF = 0.01

# The choice that searches walls among all points.
ALL_POINTS = "all points"

# The choice that searches them among the points of facade lines only.
FACADE_LINES = "facade lines"

# Distance (m) from a corner within which the border of a facade, and its outer side, depend on the facade next to it.
AROUND_CORNER = 5.0

# Distance (m) of points that decide on a facade. Those up to 10 m before it show from which side it was seen; those up
# to 10 m before the facades next to it decide on its border. The length of the facade itself is not included.
_AROUND = 2 * FARTHEST

FACADE_FIELDS = (
    Field("id", int, "SegmentID of its points", numbers="segment_id"),
    Field("area", float, "Area of the polygon, openings left out", "m²"),
    Field("height", float, "Height from the lowest to the highest corner", "m"),
    Field("base", float, "Elevation of the lowest corner", "m"),
    Field("azimuth", float, "Direction that it faces, clockwise from north", "°"),
    Field("tilt", float, "Angle to the vertical, positive where it faces the sky", "°"),
    Field("normal_x", float, "Outward unit normal, eastward component"),
    Field("normal_y", float, "Outward unit normal, northward component"),
    Field("normal_z", float, "Outward unit normal, upward component"),
    Field("rms", float, "Root mean square distance of its points from the plane", "m"),
    Field("points", int, "Number of its points"),
    Field("density", float, "Points per square meter of the polygon", "points/m²"),
    Field("hull_share", float, "Area within the boundary, as a share of the convex hull of the points"),
    Field("seen_share", float, "Share of the area within the boundary that has points, openings with points included"),
    Field("neighbors", int, "Facades with which it has a common border"),
)

FACADES = Layer("facades", "Facades", "Polygon", FACADE_FIELDS, style="facades", deviation="rms", around=AROUND_CORNER)

# Least number of cells that two planes of a curved front share: one may be of a pole or a sign at a corner.
_TOUCHES = 2

# Side of a column, whose points are of one strip (tolerances): the noise of a strip fits into one.
_COLUMN_TOLERANCES = 2.0

# Least side of a column (m): finer ones hold too few points for a root mean square.
_LEAST_COLUMN = 0.1

# Number of rounds of fitting strips and assigning columns; both hardly change after the third.
_ROUNDS = 5


@stage(
    "Facades",
    tags="facade,wall,street,mobile mapping,terrestrial,TIN,convex hull,boundary,polygon,3D,Peng",
    writes=("segment_id",),
    layers=(FACADES,),
    reach=_AROUND,
    cost=25.0,
)
def extract_facades(
    xyz,
    classification,
    gps_time=None,
    point_source_id=None,
    *,
    search_in: str = tunable(ALL_POINTS, choices=(ALL_POINTS, FACADE_LINES)),
    tolerance: Optional[float] = tunable(
        None,
        within="(0, 1] m",
        automatic=(
            f"{DEVIATIONS:g} times the root of the sum of the squares of the surface noise and of "
            f"{_RELIEF:g} m, the relief of walls."
        ),
    ),
    max_tilt: float = FACADE_TILT,
    min_area: float = tunable(2.0, label="Minimum facade area", within="[0.1, 10_000] m²"),
    min_height: float = tunable(2.5, label="Minimum facade height", within="[0, 100] m"),
    max_gap: float = FACADE_GAP,
    corner_distance: float = CORNER_DISTANCE,
    boundary: str = BOUNDARY,
    complete: bool = COMPLETE_FACADES,
    seed: int = SEED,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find the facades of buildings and draw each as a vertical polygon with its common borders.

    Steep planes are found and fitted by least squares. Each gets a boundary in its own plane: the rim of a
    triangulation without its long edges, drawn in straight edges and pushed out to hold its points. Where two facades
    meet, their border is the intersection line of the planes. A curved, recessed or protruding front is several planes.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground, water and noise are no facades. All points may be unclassified.
    gps_time : ndarray of shape (n,), float64, optional
        Time of each pulse, s, for facade lines.
    point_source_id : ndarray of shape (n,), uint16, optional
        Scanner of each point, for facade lines.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Facades from 1, from west to east; 0 if unassigned.
    facades : LayerFeatures
        Polygons with Z, counterclockwise seen from outside, with the fields ``FACADE_FIELDS``.

    Other Parameters
    ----------------
    search_in
        All points, or those on facade lines: the steep pieces of a vehicle's scan lines that lie farthest from the
        scanner, behind cars, trees and people. Facade lines need the GPS time of the points.
    tolerance
        Distance within which a point lies on the plane of a facade. Smaller divides a curved front into more strips and
        separates shallower recesses.
    min_area
        Area of the smallest facade, where it has points.
    min_height
        Height of the lowest facade; cars and hedges are lower than walls.

    Raises
    ------
    ValueError
        If the points are spread too far for the search of planes, or facade lines are wanted of points without time.

    Notes
    -----
    The paper clusters the normals of the triangles of a TIN around two means of their x and y components, which fits a
    building with two kinds of slopes. Vertical walls fold a TIN over the plan, and a street has facades in all
    directions; here the planes come from RANSAC in voxels ("Segment planes (RANSAC)"). Pieces are joined where their
    normals and offsets agree: the same clustering without a fixed number of clusters. Distances to the planes are
    perpendicular, not along z, which a vertical plane doesn't have.

    The paper removes triangles with an edge over 1.5 spacings and keeps the points where the boundary turns, which
    keeps every bite that chance takes out of it ("key points"). Straight edges are fitted by least squares to
    the boundary of triangles with edges up to 4 spacings. The spacing is measured where the points are farthest
    apart, since the mean over a vehicle's scan lines would tear the triangulation between them. Where shadows cut a
    facade, the longest edge grows until 95 % of the points are in one piece, at most to the widest gap.

    Cars, trees and people take bites out of the foot and the sides of a facade. Pockets between the boundary and its
    convex hull are filled where the hull is upright or follows the foot, and hidden corners of the foot are where side
    and foot meet. A passage that is open to the street is filled, too. Steps and gables at the top stay.

    The outer side is that from which points lie in front of the wall (street, cars), or close behind its openings;
    facades that meet at a corner face the same side of it.
    A window that is a plane of its own and large enough is a facade, too; "Extract openings" takes it as an opening.

    References
    ----------
    Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle
    LIDAR. EURASIP Journal on Image and Video Processing 2018:121, sections 3.1 to 3.3. [peng2018]

    Examples
    --------
    >>> x, z = np.mgrid[0:10:0.1, 0:6:0.1].reshape(2, -1)
    >>> xyz = np.column_stack([x, 0 * x, z])
    >>> ids, facades = extract_facades(xyz, np.zeros(len(xyz)))
    >>> len(facades)
    1
    """
    tolerance = DEVIATIONS * float(np.hypot(sampling.noise, _RELIEF)) if tolerance is None else tolerance
    monitor.resolved(tolerance=tolerance)
    searched = _is_stacked(xyz, min_height)
    if search_in == FACADE_LINES:
        searched &= are_of_facade_lines(xyz, gps_time, point_source_id)
    plane = np.zeros(len(xyz), np.int64)
    rows = np.flatnonzero(searched)
    if len(rows):
        plane[rows] = segment_planes_ransac(
            xyz[rows],
            classification[rows],
            tolerance=tolerance,
            min_slope=90.0 - max_tilt,
            max_slope=90.0,
            # Half: a facade may be found in two pieces, which are joined afterwards.
            min_area=min_area / 2,
            seed=seed,
            sampling=sampling,
            monitor=ProgressOnly(monitor.part(0, 0.6)),
        )[0]
    walls = as_strips(xyz, merged_planes(xyz, plane, tolerance, monitor.part(0.6, 0.65)), tolerance)
    pieces = split_at_gaps(xyz, walls, max_gap)
    _leave_low(xyz, pieces, min_height)
    facades = surfaces_of(xyz, pieces, Drawing(max_tilt, max_gap, boundary, complete), monitor.part(0.65, 0.95))
    # The area that was seen: the boundary of a post and of objects at its foot has a larger one.
    facades = [each for each in facades if min(each.area, each.seen_area) >= min_area and each.height >= min_height]
    facades.sort(key=lambda facade: tuple(np.round(facade.rings[0].min(axis=0), 2)))
    facades = [replace(facade, number=number) for number, facade in enumerate(facades, start=1)]
    if corner_distance:
        facades = with_common_borders(facades, corner_distance, monitor.part(0.95, 1.0))
    return _result(facades, len(xyz), min_area, min_height, monitor)


def _is_stacked(xyz: np.ndarray, min_height: float) -> np.ndarray:
    """Return the mask of points (n,) that share a cell in plan with points far above or below, as walls have them."""
    cells, cell = distinct(grid_over(xyz, CELL).number(xyz))
    low, high = least_of(xyz[:, 2], cell, len(cells)), -least_of(-xyz[:, 2], cell, len(cells))
    return (high - low >= min_height / 2)[cell]


def merged_planes(xyz: np.ndarray, segment_id: np.ndarray, tolerance: float, monitor: Monitor) -> np.ndarray:
    """Return numbers (n,) from 1 of planes, those that are one wall joined; 0 stays 0.

    A wall that is not quite flat is found as several planes that cross each other. Two planes are one wall if the
    points of the smaller lie within the tolerance (root mean square) of the plane of the larger.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m.
    segment_id : ndarray of shape (n,)
        Planes from 1; 0 unassigned.
    tolerance : float
        Largest distance of a point from its plane, m.
    monitor : Monitor
        Receives the progress.
    """
    on_plane = np.flatnonzero(segment_id > 0)
    result = np.zeros(len(xyz), np.int64)
    if not len(on_plane):
        return result
    _, group = np.unique(segment_id[on_plane], return_inverse=True)
    pieces = planes_of(xyz[on_plane] - xyz.min(axis=0), group, int(group.max()) + 1)
    result[on_plane] = _walls_of(pieces, tolerance, monitor)[group]
    return result


def _walls_of(pieces: Planes, tolerance: float, monitor: Monitor) -> np.ndarray:
    """Return the wall (m,) from 1 of each plane: the largest first takes in what fits it, and is fitted again."""
    wall, n_walls = np.zeros(len(pieces), np.int64), 0
    center, normal = np.empty((2, len(pieces), 3))
    for done, piece in enumerate(np.argsort(-pieces.count, kind="stable")):
        spread = np.broadcast_to(pieces.covariance[piece], (n_walls, 6))
        off = off_planes(pieces.center[piece] - center[:n_walls], spread, normal[:n_walls])
        best = int(np.argmin(off)) if n_walls and off.min() <= tolerance else n_walls
        n_walls = max(n_walls, best + 1)
        wall[piece] = best + 1
        whole = pieces.chosen(wall == best + 1)
        whole = whole.merged(np.zeros(len(whole), np.int64), 1)
        center[best], normal[best] = whole.center[0], whole.normal[0]
        monitor.progress((done + 1) / len(pieces))
    return wall


def split_at_gaps(xyz: np.ndarray, segment_id: np.ndarray, gap: float) -> np.ndarray:
    """Return new numbers (n,) from 1 of segments, each divided where its points leave a gap (m); 0 stays 0."""
    result, count = np.zeros(len(xyz), np.int64), 0
    for points in members(segment_id).values():
        positions = plane_of(xyz[points])[0].local(xyz[points])[:, :2]
        grid = grid_over(positions, gap / 2)
        number = grid.number(positions)
        cells = distinct(number)[0]
        found, group = connected_cells(grid, cells)
        result[points] = count + 1 + group[find_cells(cells, number)[0]]
        count += found
    return result


def _leave_low(xyz: np.ndarray, pieces: np.ndarray, min_height: float) -> None:
    """Remove pieces too low for a facade, in place, so that nearly half of a street's pieces need no boundary."""
    for points in members(pieces).values():
        if np.ptp(xyz[points, 2]) < min_height:
            pieces[points] = 0


def _result(
    facades: list[Facade], n_points: int, min_area: float, min_height: float, monitor: Monitor
) -> tuple[np.ndarray, LayerFeatures]:
    segment_id = np.zeros(n_points, np.int32)
    for facade in facades:
        segment_id[facade.points] = facade.number
    if not facades:
        monitor.none_found(
            f"No vertical plane of {min_area:g} m² and {min_height:g} m height was found, so there are no facades; "
            "lower these values, raise the maximum tilt, or use a cloud that was taken from the street or obliquely."
        )
    return segment_id, facade_features(facades)


def as_strips(xyz: np.ndarray, wall: np.ndarray, tolerance: float) -> np.ndarray:
    """Return wall numbers (n,) from 1, curved fronts as upright strips side by side; 0 stays 0.

    On a curved front the planes of walls overlap. A plane is left out if the points of each of its columns lie off
    another one by at most ``tolerance`` (root mean square, m).
    """
    result = wall.copy()
    for front in _fronts(xyz, wall, int(wall.max(initial=0))):
        rows = np.flatnonzero(np.isin(wall, front))
        strip = _strips(xyz[rows] - xyz.min(axis=0), np.searchsorted(front, wall[rows]), len(front), tolerance)
        result[rows] = front[strip]
    return result


def _fronts(xyz: np.ndarray, wall: np.ndarray, count: int) -> list[np.ndarray]:
    """Return the walls, ascending, of each front with two planes or more that touch at small angles."""
    rows = np.flatnonzero(wall > 0)
    if count < 2:
        return []
    normal = planes_of(xyz[rows] - xyz.min(axis=0), wall[rows] - 1, count).normal
    one, other, shared = shared_cells(xyz[rows], wall[rows] - 1, count, CELL)
    sine = np.linalg.norm(np.cross(normal[one], normal[other]), axis=1)
    # Parallel planes are one wall.
    touch = (shared >= _TOUCHES) & (sine >= PARALLEL) & (sine <= np.sin(ONE_FRONT))
    _, group = components(one[touch], other[touch], count)
    return [np.flatnonzero(group == number) + 1 for number in np.flatnonzero(np.bincount(group) > 1)]


def _strips(xyz: np.ndarray, label: np.ndarray, count: int, tolerance: float) -> np.ndarray:
    """Return the plane (n,) from 0 of each point, the same for all points of a column; as few planes as will do."""
    size = max(_COLUMN_TOLERANCES * tolerance, _LEAST_COLUMN)
    column = distinct(grid_over(xyz, size).number(xyz))[1]
    off = _deviations(xyz, label, count, column)
    alive = np.ones(count, bool)
    while True:
        for _ in range(_ROUNDS):
            label = np.argmin(np.where(alive, off, np.inf), axis=1)[column]
            # Three points always lie on a plane.
            alive &= np.bincount(label, minlength=count) > 3
            off = _deviations(xyz, label, count, column)
        dropped = _dispensable(off, alive, tolerance)
        if dropped is None:
            return label
        alive[dropped] = False


def _deviations(xyz: np.ndarray, label: np.ndarray, count: int, column: np.ndarray) -> np.ndarray:
    """Return the root mean square distance (columns, planes), m, of the points of columns from the planes."""
    number, group = np.unique(label, return_inverse=True)
    planes = planes_of(xyz, group, len(number))
    points = np.bincount(column)
    off = np.full((len(points), count), np.inf)
    for k, plane in enumerate(number):
        distance = (xyz - planes.center[k]) @ planes.normal[k]
        off[:, plane] = np.sqrt(np.bincount(column, distance**2) / points)
    return np.where(np.isnan(off), np.inf, off)


def _dispensable(off: np.ndarray, alive: np.ndarray, tolerance: float) -> Optional[int]:
    """Return the plane with fewest columns that the others can do without, None if they need all."""
    best = np.argmin(np.where(alive, off, np.inf), axis=1)
    columns = np.bincount(best, minlength=len(alive))
    for plane in np.argsort(columns, kind="stable"):
        if not alive[plane] or alive.sum() < 2:
            continue
        others = alive.copy()
        others[plane] = False
        own = np.flatnonzero(best == plane)
        if (np.where(others, off[own], np.inf).min(axis=1) <= tolerance).all():
            return int(plane)
    return None
