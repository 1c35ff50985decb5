"""Footprints: the outlines of building clusters as polygons."""

from __future__ import annotations

from typing import Annotated, Any, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..cloud.cells import connected_cells, find_cells, grid_over
from ..cloud.density import point_spacing
from ..packages import spatial
from ..params import MinBuildingArea
from ..stage import Features, Field, Layer, Param, stage
from .coverage import Coverage
from .outlines import Tracing, perimeter, signed_area, trace_outlines
from .reasons import Reason
from .rows import MAX_SPACING
from .rows import split_rows as split_into_houses

_FIELDS = (
    Field("id", int, "number of the footprint, from 1"),
    Field("cluster_id", int, "cluster that it outlines"),
    Field("area", float, "area without holes", "m²"),
    Field("perimeter", float, "length of the exterior and the holes", "m"),
    Field("ground_elevation", float, "median elevation of the ground under the roof's points", "m"),
    Field(
        "eave_height", float, "lower quartile of the heights above ground at which the roof ends along the outline", "m"
    ),
    Field("ridge_height", float, "98th percentile of the roof's heights above ground", "m"),
    Field("height", float, "median of the roof's heights above ground", "m"),
    Field("max_height", float, "greatest height above ground", "m"),
    Field("volume", float, "space between roof and ground: mean height of the roof's surface by area", "m³"),
    Field("points", int, "points of the building, walls among them"),
    Field("entropy", float, "mean entropy of the building's points' clusters"),
    Field("confidence", float, "0 unsure to 1 sure of being a building"),
    Field("reason", str, "why most of its roofs are called building"),
    Field("regularized", int, "1 straightened along main directions, 0 outline as traced or in chords of it"),
)

# Percentiles of roof heights: of those along the outline, where gables rise from eaves, and of all, but for chimneys.
_EAVE, _RIDGE = 25, 98

# Eaves are where the plane through so many points of the roof ends, each at least so many spacings from the outline.
# They lie this close to it (m), and it rises by no more than this (tangent), or it is none.
_PLANE, _INNER, _FLAT, _STEEPEST = 12, 2.0, 0.15, 2.5

# A point so far (m, and in spacings) under the roof beside it is no part of the roof, unless it belongs to a steep one:
# the roof rises to it by less than this (tangent).
_STEP, _STEP_SPACINGS, _UPRIGHT = 1.0, 3.0, 3.0

# Bare points that are farther from a roof than so many spacings tell nothing of where it ends.
_BESIDE = 3.0

# A place is under a roof that has, within so many spacings, this share of the points it has around the so many of its
# points that are nearest; a roof has at least this share of what the mean spacing would give.
_AROUND, _NEAREST, _UNDER, _DENSE = 2.0, 24, 0.7, 0.6

# Points farther apart than so many spacings are never joined: what lies between such gaps can be done by itself.
_APART = 8.0


@stage(
    "Extract footprints",
    group="Buildings",
    tags="polygons,outlines,alpha shape,concave hull,vectorize,regularize,right angles",
    layers=(Layer("footprints", "Footprints", "Polygon", _FIELDS, style="footprints"),),
)
def extract_footprints(
    xyz,
    classification,
    cluster_id=None,
    height_above_ground=None,
    cluster_entropy=None,
    confidence=None,
    reason=None,
    *,
    min_area: MinBuildingArea = 4.0,
    min_hole_area: Annotated[
        float,
        Param(
            "Minimum hole area", "Smaller holes are filled, larger ones are courtyards.", unit="m²", low=0, high=10_000
        ),
    ] = 5.0,
    max_edge: Annotated[
        Optional[float],
        Param(
            "Maximum edge length",
            "Points farther apart are not joined. Longer edges close gaps and round off corners that point inward.",
            unit="m",
            low=0.01,
            high=100,
            automatic="adapted to the spacing of the points of each cluster, from 4 to 8 times the mean spacing.",
            advanced=True,
        ),
    ] = None,
    regularize: Annotated[
        bool,
        Param(
            "Regularize outlines", "Make walls straight and, where they nearly are, parallel or square to each other."
        ),
    ] = True,
    tolerance: Annotated[
        Optional[float],
        Param(
            "Tolerance",
            "Wiggles of the traced outline that are taken for straight; an outline that would have to move by more "
            "than twice that becomes chords of what was traced.",
            unit="m",
            low=0.01,
            high=100,
            automatic="1.75 times the mean spacing of the building points, at least 0.4 m.",
            advanced=True,
        ),
    ] = None,
    split_rows: Annotated[
        bool,
        Param(
            "Split rows",
            "Outline three houses of a row or more one by one where valleys between their roofs, steps or walls above "
            "them show which is which.",
        ),
    ] = False,
    monitor=None,
):
    """Outline each building as a polygon with its area, heights, volume, entropy and confidence.

    Building points, seen from above, are divided among the buildings by an alpha shape that adapts to their spacing.
    Walls are then made straight along the main directions of each group of buildings that touch, where that stays close
    to the points; diagonals keep their direction. Buildings that touch share their border exactly, and so do the
    houses of a row that are split.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points of class 6 are outlined, lower ones beside them show where a roof ends.
    cluster_id : ndarray of shape (n,), optional
        Building of each point, from 1; points of 0 are left out. Without it, points that lie together are a building.
    height_above_ground : ndarray of shape (n,), optional
        Heights (m), for the attributes and to tell low parts from the houses of a row; for these it is otherwise taken
        over the lowest point of the buildings that lie together or beside them.
    cluster_entropy : ndarray of shape (n,), optional
        Mean entropy of the cluster, for the attributes only.
    confidence : ndarray of shape (n,), optional
        Sureness of being a building, 0 to 1, for the attributes only.
    reason : ndarray of shape (n,), optional
        Why points are called building, see :class:`~.reasons.Reason`, for the attributes and to tell walls.

    Returns
    -------
    Features
        One valid polygon per building part that is not connected with others, or per house of a row, largest cluster
        number last; no two overlap. Attributes without the dimension they come from are NaN. None at all where
        there is no building.

    Notes
    -----
    Points with another of their building more than a meter (or three spacings) higher beside them, at more than 72° or
    if they were only attached to the building, are walls: they count as points of the building but don't widen its
    outline. A roof ends half-way between its outermost points and the ground seen beside them, at most half a point
    spacing from its points. Walls are as few as describe the outline, those in main directions preferred, each fitted
    to all points along it, and turned to a main direction only where that moves its ends by about a point spacing at
    most; chords of curves are not. Outlines without a right angle and without parallel walls that are most of them, or
    that straight walls would change too much, become chords of what was traced, within about the tolerance. Clusters
    whose points lie on one line have no area and give no polygon.

    With 'Split rows', houses of a row are parted along straight lines from one side of a building to the other, in its
    main directions, where over 60 % of what is not low two roofs rise away from the line, parallel ones step by 0.4 m
    and any by 1 m, or a wall stands 0.3 m above both. At least two such lines side by side, 3.5 to 13 m apart, and
    25 m² of every house are asked for, and for a step that the lower house is not below three quarters of the higher
    one: two roofs may be one house, and what is low or small is a part of one. Houses keep the number of their cluster.

    References
    ----------
    Santos et al. (2019), Extraction of building roof boundaries from LiDAR data using an adaptive alpha shape.
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept.
    Perez and Vidal (1994), Optimum polygonal approximation of digitized curves.
    """
    is_building = classification == PointClass.BUILDING
    building = np.flatnonzero(is_building & (cluster_id is None or cluster_id > 0))
    found = Features([], {field.name: [] for field in _FIELDS})
    if not len(building):
        what = (
            "point of class 6 (building) has a ClusterID" if is_building.any() else "point is called building (class 6)"
        )
        monitor.warn(f"No {what}, so there are no footprints.")
    if not len(building) or not np.ptp(xyz[building, :2], axis=0).any():
        return found
    spacing = point_spacing(xyz[building])
    if tolerance is None:
        tolerance = max(0.4, 1.75 * spacing)
        monitor.resolved(tolerance=tolerance)
    if split_rows and spacing > MAX_SPACING:
        monitor.warn(
            f"Points are {spacing:.1f} m apart, too far to see where the houses of a row part; they are left in one."
        )

    cluster = np.ones(len(building), np.int64) if cluster_id is None else cluster_id[building].astype(np.int64)
    is_attached = np.zeros(len(building), bool) if reason is None else reason[building] == Reason.ATTACHED
    is_roof = _is_roof(xyz[building], cluster, is_attached, spacing)
    bare = _bare_points(xyz, classification, building[is_roof], spacing)
    measured = {"height": height_above_ground, "entropy": cluster_entropy, "confidence": confidence, "reason": reason}
    edges = []
    parts = _parts(xyz, building, bare, max(_APART * spacing, max_edge or 0.0))
    for done, (rows, beside) in enumerate(parts):
        part = monitor.part(done / len(parts), (done + 1) / len(parts))
        roof = rows[is_roof[rows]]
        points = np.concatenate([building[roof], bare[beside]])
        label = np.concatenate([cluster[roof], np.zeros(len(beside), np.int64)])
        traced = trace_outlines(xyz[points, :2], label, spacing, max_edge, min_area, min_hole_area)
        if traced is not None and len(traced.labels):
            if split_rows:
                height = _heights(xyz, height_above_ground, points, building[rows])
                traced = split_into_houses(traced, height, spacing, tolerance, part.part(0.0, 0.6))
            edges.append(traced.max_edge)
            coverage = Coverage(traced, tolerance, regularize, part.part(0.6, 1.0))
            _describe(found, xyz, building[rows], points, traced, coverage, measured, spacing)
        part.progress(1.0)
    if max_edge is None and edges:
        monitor.resolved(max_edge=float(np.median(edges)))
    return _sorted(found, min_area)


def _heights(
    xyz: np.ndarray, height_above_ground: Optional[np.ndarray], points: np.ndarray, of_buildings: np.ndarray
) -> np.ndarray:
    """Return the heights (n,) of points above the ground; where it is not known, above the lowest of all given (m)."""
    if height_above_ground is not None:
        return height_above_ground[points].astype(np.float64)
    return xyz[points, 2] - min(xyz[of_buildings, 2].min(), xyz[points, 2].min())


def _is_roof(xyz: np.ndarray, cluster: np.ndarray, is_attached: np.ndarray, spacing: float) -> np.ndarray:
    """Return which points have none of their cluster far and steeply above them in their cell of one spacing or beside.

    Above those that were attached to a building, none may be far. Only the highest point of each cell is looked at.
    """
    grid = grid_over(xyz, spacing)
    # One number for cell and cluster; a cluster's cells are as far from the next one's as the grid is large.
    number = np.unique(cluster, return_inverse=True)[1].ravel()
    cell = grid.number(xyz) + number * (grid.rows * grid.columns)
    order = np.lexsort((xyz[:, 2], cell))
    last = np.flatnonzero(np.diff(cell[order], append=-1))
    cells, top = cell[order][last], xyz[order[last]]
    step, is_roof = max(_STEP, _STEP_SPACINGS * spacing), np.ones(len(xyz), bool)
    steepest = np.where(is_attached, 0.0, _UPRIGHT)
    for offset in (0, *grid.around):
        position, found = find_cells(cells, cell + offset)
        x, y, rise = (top[position[found]] - xyz[found]).T
        is_roof[found] &= rise <= np.maximum(step, steepest[found] * np.hypot(x, y))
    return is_roof


def _bare_points(xyz: np.ndarray, classification: np.ndarray, roof: np.ndarray, spacing: float) -> np.ndarray:
    """Return the points beside roofs and clearly below them that are no building: there the roof has ended."""
    reach = _BESIDE * spacing
    grid = grid_over(xyz, reach)
    cells = np.unique(grid.number(xyz[roof]))
    near = np.unique(np.concatenate([cells, *(cells + step for step in grid.around)]))
    other = np.flatnonzero(~np.isin(classification, (PointClass.BUILDING, *NOISE)))
    other = other[find_cells(near, grid.number(xyz[other]))[1]]
    if not len(other):
        return other
    tree = spatial.cKDTree(xyz[roof, :2])
    distance, nearest = tree.query(xyz[other, :2], distance_upper_bound=reach)
    # A pulse that was split by the edge has a return on the ground right under that on the roof.
    beside = (distance > spacing / 2) & np.isfinite(distance)
    other, nearest = other[beside], nearest[beside]
    other = other[xyz[other, 2] < xyz[roof[nearest], 2] - _STEP]
    return other[~_is_under(xyz[other, :2], tree, spacing)]


def _is_under(places: np.ndarray, tree: Any, spacing: float) -> np.ndarray:
    """Return which places (n, 2) lie under a roof, given as a tree: it is about as dense there as around its points.

    From the side, a scanner sees the ground and the wall under the eaves.
    """
    if not len(places):
        return np.zeros(0, bool)
    count = tree.query_ball_point(places, _AROUND * spacing, return_length=True)
    _, nearest = tree.query(places, min(_NEAREST, tree.n))
    nearest = nearest.reshape(len(places), -1)
    beside, row = np.unique(nearest, return_inverse=True)
    usual = tree.query_ball_point(tree.data[beside], _AROUND * spacing, return_length=True)
    # Bushes beside a roof that are taken for it are thinner than a roof.
    least = _DENSE * np.pi * _AROUND**2
    return count > _UNDER * np.maximum(usual[row.reshape(nearest.shape)].mean(axis=1), least)


def _parts(xyz: np.ndarray, building: np.ndarray, bare: np.ndarray, apart: float) -> list:
    """Return the rows of building points that can be outlined by themselves, and those of bare points beside them."""
    grid = grid_over(xyz, apart)
    cell = grid.number(xyz[building])
    cells = np.unique(cell)
    count, group = connected_cells(grid, cells)
    own = group[np.searchsorted(cells, cell)]
    # Bare points lie in a cell of the group or beside one.
    bare_cell = grid.number(xyz[bare])
    bare_group = np.full(len(bare), -1)
    for step in (0, *grid.around):
        position, there = find_cells(cells, bare_cell + step)
        bare_group = np.where(there, group[position], bare_group)
    return list(zip(_split(own, count), _split(bare_group, count)))


def _split(group: np.ndarray, count: int) -> list:
    """Return the rows of each group from 0 to ``count`` - 1."""
    order = np.argsort(group, kind="stable")
    return np.split(order, np.searchsorted(group[order], np.arange(count + 1)))[1:-1]


def _describe(
    found: Features,
    xyz: np.ndarray,
    members: np.ndarray,
    points: np.ndarray,
    traced: Tracing,
    coverage: Coverage,
    measured: dict,
    spacing: float,
) -> None:
    """Append the footprints of a tracing to those found, with what their points and shapes say of them."""
    count = len(traced.labels)
    roof_face = _face_of_points(traced, points)
    has = np.flatnonzero(roof_face >= 0)
    distance, nearest = spatial.cKDTree(traced.xy[has]).query(xyz[members, :2])
    member_face = np.where(distance <= traced.max_edge, roof_face[has[nearest]], -1)
    border = _outer_points(traced)
    height = measured["height"]
    over_ground = np.full(len(points), np.nan) if height is None else height[points].astype(np.float64)
    mean_height = _mean_heights(traced, over_ground)
    eaves = _eave_heights(traced, border, roof_face, over_ground, spacing)
    rows = zip(_split(roof_face, count), _split(member_face, count), _split(border[0], count))
    for face, (roof, own, outer) in enumerate(rows):
        rings = coverage.polygons[face]
        area = sum(map(signed_area, rings))
        described = {
            "cluster_id": int(traced.labels[face]),
            "area": area,
            "perimeter": sum(map(perimeter, rings)),
            "ground_elevation": _percentile(xyz[points[roof], 2] - over_ground[roof], 50),
            "eave_height": _percentile(eaves[outer], _EAVE),
            "ridge_height": _percentile(over_ground[roof], _RIDGE),
            "height": _percentile(over_ground[roof], 50),
            "max_height": _percentile(over_ground[roof], 100),
            "volume": area * mean_height[face],
            "points": len(own),
            "entropy": _mean(measured["entropy"], members[own]),
            "confidence": _mean(measured["confidence"], members[own]),
            "reason": _main_reason(measured["reason"], members[own]),
            "regularized": int(coverage.is_straight[face]),
        }
        found.geometries.append(rings)
        for name, value in described.items():
            found.columns[name].append(value)


def _face_of_points(traced: Tracing, points: np.ndarray) -> np.ndarray:
    """Return the face (n,) that has the most of the triangles around a point of it; -1 of those in none or bare."""
    face, count = np.full(len(points), -1), len(traced.labels)
    inside = traced.face >= 0
    corner, of = traced.triangles[inside].ravel(), np.repeat(traced.face[inside], 3)
    is_own = traced.label[corner] == traced.labels[of]
    pairs, inverse = np.unique(corner[is_own] * count + of[is_own], return_inverse=True)
    # The largest comes last for each point, and stays.
    pairs = pairs[np.argsort(np.bincount(inverse, np.repeat(traced.areas[inside], 3)[is_own]), kind="stable")]
    face[pairs // count] = pairs % count
    return face


def _outer_points(traced: Tracing) -> tuple[np.ndarray, np.ndarray]:
    """Return faces and points along the outlines; those along borders between buildings only where it has no others."""
    face, across = np.repeat(traced.face, 3), traced.beyond(traced.face)
    is_border = (face >= 0) & (face != across)
    has_outer = np.bincount(face[is_border & (across < 0)], minlength=len(traced.labels)) > 0
    used = np.flatnonzero(is_border & ((across < 0) | ~has_outer[face]))
    return face[used], traced.starts[used]


def _eave_heights(
    traced: Tracing, border: tuple, roof_face: np.ndarray, height: np.ndarray, spacing: float
) -> np.ndarray:
    """Return the height (b,) of the roof above each point of the outlines, continued from the roof beside it.

    Many points of an outline are those of the wall below, down to where they are no longer taken for a roof's.
    """
    face, point = border
    distance, _ = spatial.cKDTree(traced.xy[np.unique(point)]).query(traced.xy)
    inner = np.flatnonzero((roof_face >= 0) & (distance >= _INNER * spacing) & np.isfinite(height))
    if not len(inner):
        return height[point]
    distance, nearest = spatial.cKDTree(traced.xy[inner]).query(traced.xy[point], min(_PLANE, len(inner)))
    beside = inner[nearest.reshape(len(point), -1)]
    is_near = distance.reshape(beside.shape) <= _APART * spacing
    weight = (is_near & (roof_face[beside] == face[:, None])).astype(float)
    step = traced.xy[beside] - traced.xy[point][:, None]
    factors = np.concatenate([np.ones((*weight.shape, 1)), step], axis=2)
    # A pull to the level, which only points in one line feel.
    matrix = np.einsum("ni,nij,nik->njk", weight, factors, factors) + np.diag([1e-6, *[spacing**2 / 10] * 2])
    right = np.einsum("ni,nij,ni->nj", weight, factors, height[beside])
    planes = np.linalg.solve(matrix, right[..., None])
    off = ((factors @ planes)[..., 0] - height[beside]) ** 2
    is_roof = (weight.sum(axis=1) >= _PLANE / 2) & (np.hypot(*planes[:, 1:, 0].T) <= _STEEPEST)
    is_plane = is_roof & ((weight * off).sum(axis=1) <= _FLAT**2 * weight.sum(axis=1))
    return np.where(is_plane, planes[:, 0, 0], height[point])


def _mean_heights(traced: Tracing, height: np.ndarray) -> np.ndarray:
    """Return the mean height (f,) of the roof's surface in each face."""
    is_roof = (traced.face >= 0) & (traced.label[traced.triangles] > 0).all(axis=1)
    face, triangles = traced.face[is_roof], traced.triangles[is_roof]
    a, b = (traced.xy[triangles[:, k]] - traced.xy[triangles[:, 0]] for k in (1, 2))
    area = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    count = len(traced.labels)
    return np.bincount(face, area * height[triangles].mean(axis=1), count) / np.bincount(face, area, count)


def _percentile(values: np.ndarray, percent: float) -> float:
    """Return a percentile of the values that are defined, NaN without any."""
    defined = values[np.isfinite(values)]
    return float(np.percentile(defined, percent)) if len(defined) else float("nan")


def _mean(values: Optional[np.ndarray], rows: np.ndarray) -> float:
    """Return the mean of the values that are defined: points that were added to a building later have none."""
    if values is None:
        return float("nan")
    defined = values[rows][np.isfinite(values[rows])]
    return float(np.mean(defined, dtype=np.float64)) if len(defined) else float("nan")


def _main_reason(values: Optional[np.ndarray], rows: np.ndarray) -> str:
    """Return the sentence of the reason that most points have, "" without any; what was added later has none itself."""
    given = [] if values is None else values[rows].astype(np.int64)
    counts = np.bincount(given, minlength=max(Reason) + 1)
    roofs = [reason for reason in Reason if reason.is_building and reason != Reason.ATTACHED and counts[reason]]
    return max(roofs, key=lambda reason: counts[reason]).text if roofs else ""


def _sorted(found: Features, min_area: float) -> Features:
    """Return the footprints that are large enough in the order of their clusters, from the south-west, numbered."""
    lowest = [(*map(float, rings[0].min(axis=0)),) for rings in found.geometries]
    keys = list(zip(found.columns["cluster_id"], lowest))
    kept = [i for i in range(len(keys)) if found.columns["area"][i] >= min_area]
    kept.sort(key=keys.__getitem__)
    columns = {name: [values[i] for i in kept] for name, values in found.columns.items() if name != "id"}
    return Features([found.geometries[i] for i in kept], {"id": list(range(1, len(kept) + 1)), **columns})
