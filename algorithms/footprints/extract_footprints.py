"""Footprints: the outlines of building clusters as polygons."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..cloud.reasons import ADDED
from ..geometry.grid import connected_cells, find_cells, grid_over
from ..geometry.groups import split_groups
from ..params import MinBuildingArea
from ..sampling.density import point_spacing
from ..stage import Layer, LayerFeatures, Monitor, Param, stage
from ..threads import made_ahead
from .alpha_shape import Tracing, trace_outlines
from .footprint_attributes import FIELDS, PointMeasures, footprint_attributes
from .roof_points import find_non_building_points, find_roof_points
from .row_houses import MAX_SPACING
from .row_houses import split_rows as split_into_houses
from .shared_borders import outline_faces

# Distance (spacings) beyond which points are never joined: the longest edge within a building. Parts with such
# gaps between them are outlined one by one.
_APART = 8.0

# Tolerance (spacings) of outlines: samples along an edge lie within one spacing of it, and corners are rounded.
_TOLERANCE_SPACINGS = 1.75

# Least tolerance (m): gutters and small bays.
_LEAST_TOLERANCE = 0.4

# Share of the progress that tracing takes; drawing takes the rest.
_TRACING = 0.5


@stage(
    "Extract footprints",
    group="Buildings",
    tags="polygons,outlines,alpha shape,concave hull,vectorize,regularize,right angles,las2building,lasboundary",
    layers=(Layer("footprints", "Footprints", "Polygon", FIELDS, style="footprints"),),
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
            "than twice that becomes chords of the traced one.",
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
        Why points are called building, see :class:`~..cloud.reasons.Reason`, for the attributes and to tell walls.

    Returns
    -------
    LayerFeatures
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
    that straight walls would change too much, become chords of the traced outline, within about the tolerance. Clusters
    whose points lie on one line have no area and give no polygon.

    With 'Split rows', houses of a row are parted along straight lines from one side of a building to the other, in its
    main directions, where over 60 % of what is not low two roofs rise away from the line, parallel ones step by 0.4 m
    and any by 1 m, or a wall stands 0.3 m above both. At least two such lines side by side, 3.5 to 13 m apart, and
    25 m² of every house are asked for, and for a step that the lower house is not below three quarters of the higher
    one: two roofs may be one house, and low or small parts belong to one. Houses keep the number of their cluster.

    References
    ----------
    Santos et al. (2019), Extraction of building roof boundaries from LiDAR data using an adaptive alpha shape.
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept.
    Perez and Vidal (1994), Optimum polygonal approximation of digitized curves.
    """
    building = _building_points(classification, cluster_id, monitor)
    if not len(building) or not np.ptp(xyz[building, :2], axis=0).any():
        return _features([], [], min_area)
    # Not the spacing of the cloud: a roof stops every pulse once, while crowns and the ground under them return many.
    roof_spacing = point_spacing(xyz[building])
    if split_rows and roof_spacing > MAX_SPACING:
        monitor.warn(
            f"Points are {roof_spacing:.1f} m apart, too far to see where the houses of a row part; "
            "they are left in one."
        )
    if tolerance is None:
        tolerance = max(_LEAST_TOLERANCE, _TOLERANCE_SPACINGS * roof_spacing)
        monitor.resolved(tolerance=tolerance)
    how = _Outlining(roof_spacing, tolerance, max_edge, min_area, min_hole_area, regularize, split_rows)
    measures = PointMeasures(xyz, height_above_ground, cluster_entropy, confidence, reason)

    cluster = np.ones(len(building), np.int64) if cluster_id is None else cluster_id[building].astype(np.int64)
    parts = _parts(xyz, classification, building, cluster, reason, how)
    rings: list = []
    attributes: list = []
    edges = []
    tracings = made_ahead(
        lambda number, ahead: _traced(parts[number], measures, how, ahead), len(parts), monitor, _TRACING
    )
    for number, (part, traced) in enumerate(zip(parts, tracings)):
        done = monitor.part((number + _TRACING) / len(parts), (number + 1) / len(parts))
        if traced is not None:
            drawing = outline_faces(traced, how.tolerance, how.regularize, done)
            rings += [drawing.rings[face] for face in range(len(traced.labels))]
            attributes += footprint_attributes(traced, drawing, part.points, part.members, measures, roof_spacing)
            edges.append(traced.max_edge)
        done.progress(1.0)
    if max_edge is None and edges:
        monitor.resolved(max_edge=float(np.median(edges)))
    return _features(rings, attributes, min_area)


@dataclass(frozen=True)
class _Outlining:
    """How buildings are outlined: mean distance of their points (m), and the tunables of the stage."""

    roof_spacing: float
    tolerance: float
    max_edge: Optional[float]
    min_area: float
    min_hole_area: float
    regularize: bool
    split_rows: bool


@dataclass(frozen=True)
class _Part:
    """Buildings that can be outlined by themselves.

    Attributes
    ----------
    members : ndarray of shape (m,), int64
        All their points in the cloud.
    points : ndarray of shape (p,), int64
        Points of their roofs in the cloud, and non-building ones beside.
    label : ndarray of shape (p,), int64
        Cluster of these, 0 for the non-building ones.
    """

    members: np.ndarray
    points: np.ndarray
    label: np.ndarray


def _building_points(classification: np.ndarray, cluster_id: Optional[np.ndarray], monitor: Monitor) -> np.ndarray:
    """Return the points (b,) to be outlined; without any, warn."""
    is_building = classification == PointClass.BUILDING
    building = np.flatnonzero(is_building & (cluster_id is None or cluster_id > 0))
    if not len(building):
        what = (
            "point of class 6 (building) has a ClusterID" if is_building.any() else "point is called building (class 6)"
        )
        monitor.none_found(f"No {what}, so there are no footprints.")
    return building


def _parts(
    xyz: np.ndarray,
    classification: np.ndarray,
    building: np.ndarray,
    cluster: np.ndarray,
    reason: Optional[np.ndarray],
    how: _Outlining,
) -> list[_Part]:
    """Return the parts of building points that lie apart, with the points beside them that show where roofs end."""
    is_attached = np.zeros(len(building), bool) if reason is None else np.isin(reason[building], ADDED)
    is_roof = find_roof_points(xyz[building], cluster, is_attached, how.roof_spacing)
    non_building = find_non_building_points(xyz, classification, building[is_roof], how.roof_spacing)
    parts = []
    for rows, beside in _apart(xyz, building, non_building, max(_APART * how.roof_spacing, how.max_edge or 0.0)):
        roof = rows[is_roof[rows]]
        points = np.concatenate([building[roof], non_building[beside]])
        label = np.concatenate([cluster[roof], np.zeros(len(beside), np.int64)])
        parts.append(_Part(building[rows], points, label))
    return parts


def _apart(
    xyz: np.ndarray, building: np.ndarray, non_building: np.ndarray, apart: float
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the rows of building points that can be outlined alone, and of the non-building points beside them.

    A non-building point beside two groups of buildings shows for both where their roofs end.
    """
    grid = grid_over(xyz, apart)
    cell = grid.number(xyz[building])
    cells = np.unique(cell)
    count, group = connected_cells(grid, cells)
    own = group[np.searchsorted(cells, cell)]
    # Non-building points lie in a cell of a group or beside one.
    non_building_cell = grid.number(xyz[non_building])
    pairs = [np.zeros(0, np.int64)]
    for step in (0, *grid.around):
        position, there = find_cells(cells, non_building_cell + step)
        rows = np.flatnonzero(there)
        pairs.append(group[position[rows]] * len(non_building) + rows)
    beside, row = np.divmod(np.unique(np.concatenate(pairs)), max(len(non_building), 1))
    rows_beside = np.split(row, np.searchsorted(beside, np.arange(1, count)))
    return list(zip(split_groups(own, count), rows_beside))


def _traced(part: _Part, measures: PointMeasures, how: _Outlining, monitor: Monitor) -> Optional[Tracing]:
    """Return the faces of buildings, and of the houses of rows where these are split; None without any."""
    plan = measures.xyz[part.points, :2]
    traced = trace_outlines(plan, part.label, how.roof_spacing, how.max_edge, how.min_area, how.min_hole_area)
    if traced is None or not len(traced.labels):
        return None
    if not how.split_rows:
        return traced
    height = measures.over_lowest(part.points, part.members)
    return split_into_houses(traced, height, how.roof_spacing, how.tolerance, monitor)


def _features(geometries: list, attributes: list[dict[str, Any]], min_area: float) -> LayerFeatures:
    """Return the footprints that are large enough in the order of their clusters, from the south-west, numbered."""
    keys = [(of_one["cluster_id"], *map(float, rings[0].min(axis=0))) for rings, of_one in zip(geometries, attributes)]
    kept = sorted((i for i, of_one in enumerate(attributes) if of_one["area"] >= min_area), key=keys.__getitem__)
    names = [field.name for field in FIELDS if field.name != "id"]
    columns = {name: [attributes[i][name] for i in kept] for name in names}
    return LayerFeatures([geometries[i] for i in kept], {"id": list(range(1, len(kept) + 1)), **columns})
