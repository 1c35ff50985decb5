"""Footprints: the outlines of building clusters as polygons."""

import itertools
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..buildings.reviewed_buildings import REVIEWED, ReviewedBuildings
from ..cloud.asprs import PointClass
from ..cloud.reasons import ADDED, Reason
from ..criteria import MILLIMETER
from ..geometry.grid import connected_cells, distinct, find_cells, fixed_grid_over, plan_box
from ..geometry.groups import split_groups
from ..geometry.polygon_overlap import as_polygons, meeting_boxes, overlaps
from ..params import MIN_BUILDING_AREA
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.density import point_spacing
from ..stage import Layer, LayerFeatures, Monitor, stage, tunable
from ..threads import made_ahead
from .drawn_blocks import BlockDrawing, Outlined, draw_block
from .footprint_attributes import FIELDS, PointMeasures, footprint_attributes
from .outline_pieces import NEIGHBORS, OutlinePiece, blocks_of, find_pieces, shared_directions
from .roof_points import edge_weights, find_non_building_points, find_roof_points
from .row_houses import ROWS, Houses, split_row
from .soft_shares import APART, LEAST_SPACING, TOLERANCE_SPACINGS, Shares, even_weights, find_shares

# Automatic tolerance in words, for the help.
_AUTOMATIC_TOLERANCE = (
    f"{TOLERANCE_SPACINGS:g} times the mean spacing of the building points, at least "
    f"{TOLERANCE_SPACINGS * LEAST_SPACING:.2g} m."
)

# The spacing is rounded to this many steps per factor of two, so that the same cloud with a tenth fewer points, or a
# part of it, mostly has the same spacing.
_STEPS_PER_OCTAVE = 4

# Name of the mean distance of building points of the whole.
_ROOF_SPACING = "roof_spacing"


@stage(
    "Buildings",
    tags="polygons,outlines,vectorize,regularize,right angles,level line,dynamic programming,las2building,lasboundary",
    input_layers=(REVIEWED,),
    layers=(Layer("footprints", "Footprints", "Polygon", FIELDS, style="footprints"),),
    of_whole=(_ROOF_SPACING,),
    cost=14.0,
)
def extract_footprints(
    xyz,
    classification,
    cluster_id=None,
    height_above_ground=None,
    cluster_entropy=None,
    confidence=None,
    reason=None,
    weakest_evidence=None,
    reviewed=None,
    *,
    min_area: float = MIN_BUILDING_AREA,
    min_hole_area: float = tunable(5.0, within="[0, 10_000] m²"),
    regularize: bool = tunable(True, label="Regularize outlines"),
    tolerance: Optional[float] = tunable(None, within="[0.01, 100] m", automatic=_AUTOMATIC_TOLERANCE, advanced=True),
    merge_touching: bool = tunable(False, label="Merge touching buildings"),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Outline each building as a polygon with its area, heights, volume, entropy and confidence.

    Each position in plan has a share of every building: its share of the points around. Outlines follow the lines
    where a building has the largest share, in straight walls along the two main directions of the building where that
    explains the line; other walls keep their own direction. Buildings that touch share their border exactly, and so do
    the houses of a row.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points of class 6 are outlined, lower ones next to them show where a roof ends.
    cluster_id : ndarray of shape (n,), optional
        Building of each point, from 1; points of 0 are left out. Without it, points that lie together are a building.
    height_above_ground : ndarray of shape (n,), optional
        Heights (m), for the attributes and to distinguish low parts from the houses of a row. Without it, the latter
        are measured from the lowest point of the buildings that lie together or next to them.
    cluster_entropy, confidence, weakest_evidence : ndarray of shape (n,), optional
        What :func:`.classify_buildings` returns of these names, for the attributes only.
    reason : ndarray of shape (n,), optional
        Why points are called building, see :class:`~..cloud.reasons.Reason`, for the attributes and to find walls.
    reviewed : LayerFeatures, optional
        Footprints with decisions: outlines that were kept or changed replace the outlines of the points that lie in
        them, deleted ones get none.

    Returns
    -------
    LayerFeatures
        One valid polygon per building part that is not connected with others, or per house of a row, in the order
        of cluster numbers; no two overlap. Attributes without the dimension they come from are NaN. No polygons where
        there is no building.

    Other Parameters
    ----------------
    min_hole_area
        Smaller holes are filled, larger ones are courtyards.
    regularize
        Make walls straight and, where they nearly are, parallel or square to each other.
    tolerance
        Scale of simplification: bays and steps up to about this depth are left out where they are short.
    merge_touching
        Outline buildings that touch as one block. Otherwise each has its own footprint, and so has each house of a row
        of three or more, where valleys between the roofs, steps or walls above them show the party walls.

    Notes
    -----
    A point lies on a wall if another one of its building is more than 0.4 m higher next to it, steeper than 72°. So
    does a point that a later step added to the building, if another one is more than a meter (or three spacings)
    higher. Points on walls belong to the building but don't widen its outline. One point counts for each cell with an
    area of half a spacing squared.

    Shares are of a lattice of half a spacing, with weights of a Gaussian of 0.9 spacings. Roof points count against the
    other points around them, and against what is missing to the density of the roofs around. Gaps with roofs all
    around are filled. The spacing is measured on the building points of the whole cloud or survey, in steps of a fifth.

    The walls of a ring are found by one dynamic program over all corners and directions. Its costs are squared
    distances from the line, a price for each corner by its angle, and a price for walls off the main directions. The
    walls of neighbors across a street count, too. Rings with many walls off these directions, and round ones,
    are drawn as chords. The walls of all buildings of a block cut the plane into cells, and a minimum cut gives each
    cell to a building or to the ground. Clusters whose points lie on one line have no area and give no polygon.

    Houses of a row are parted along straight lines from one side of a building to the other, in its main directions and
    in the one in which its roofs slope. Along such a line both roofs slope up from it, parallel roofs step by
    ``ROWS.least_height`` m, any by ``ROWS.large_step`` m, or a wall rises ``ROWS.least_height`` m above both. One
    dynamic program chooses all walls of a row. Each pays by the length on which it is seen, less its cost by its length
    without low parts. A row costs as much as one wall can pay, as two roofs may be one house. Houses cost more the less
    alike their widths are, from ``ROWS.narrowest`` m on. Each house is searched again for walls that end at these.
    Pieces under ``ROWS.least_area`` m² join a neighbor. At a step the lower house must have six tenths of the height of
    the higher one. Houses keep the number of their cluster.

    References
    ----------
    Boykov, Veksler and Zabih (2001), Fast approximate energy minimization via graph cuts. [boykov2001]
    Lorensen and Cline (1987), Marching cubes: a high resolution 3D surface construction algorithm. [lorensen1987]
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept. [santos2019]
    Perez and Vidal (1994), Optimum polygonal approximation of digitized curves. [perez1994]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> footprints = extract_footprints(xyz, classes)
    >>> len(footprints), round(float(footprints.columns["area"][0]))
    (1, 71)
    """
    review = ReviewedBuildings.of(reviewed)
    if review is not None and reason is not None:
        # The neighbors of deleted buildings are drawn as before.
        classification = np.where(reason == Reason.DELETED, PointClass.BUILDING, classification)
    building = _building_points(classification, cluster_id, monitor)
    if not len(building) or not np.ptp(plan_box(xyz.take(building, axis=0)), axis=0).any():
        return with_reviewed(_features([], min_area), review)
    # Not the spacing of the cloud: a roof stops every pulse once, while crowns and the ground under them return many.
    spacing = sampling.shared(_ROOF_SPACING, lambda: point_spacing(xyz[building]))
    spacing = max(LEAST_SPACING, 2.0 ** (round(np.log2(spacing) * _STEPS_PER_OCTAVE) / _STEPS_PER_OCTAVE))
    if not merge_touching and spacing > ROWS.max_spacing:
        monitor.inform(
            f"Points are {spacing:.1f} m apart, too far to see where the houses of a row part; they stay in one."
        )
    if tolerance is None:
        tolerance = TOLERANCE_SPACINGS * spacing
        monitor.resolved(tolerance=tolerance)
    how = BlockDrawing(spacing, tolerance / TOLERANCE_SPACINGS, min_area, min_hole_area, merge_touching)
    measured = height_above_ground, cluster_entropy, confidence, reason, weakest_evidence
    measures = PointMeasures(xyz, sampling.corner, *measured)
    cluster = np.ones(len(building), np.int64) if cluster_id is None else cluster_id[building].astype(np.int64)
    parts = _parts(measures, classification, building, cluster, spacing)
    parts, n_drawn = _asked_for(parts, measures, sampling, spacing)
    searching = monitor.part(0.0, 0.4)
    evidence = list(made_ahead(lambda number, _: _evidence_of(parts[number], measures, how), len(parts), searching))
    directions = [dict.fromkeys(one.shares, np.zeros(0)) for one in evidence]
    if regularize:
        known = iter(shared_directions([own for one in evidence for own in one.rings.values()]))
        directions = [{number: next(known) for number in one.rings} for one in evidence]
    outlines: list[list[Outlined]] = []

    def part_houses(number: int, _: Monitor) -> dict[int, Houses]:
        return _houses(parts[number], evidence[number], directions[number], measures, how)

    def describe(number: int, _: Monitor) -> list[dict[str, Any]]:
        return footprint_attributes(outlines[number], parts[number].roof, parts[number].members, measures, spacing)

    # Threads work on the arrays of houses and attributes; drawing is many small calls, which hold the interpreter.
    for houses, one, own in zip(made_ahead(part_houses, n_drawn, monitor.part(0.4, 0.9)), evidence, directions):
        drawn = (draw_block(block, one.shares, own, houses, how) for block in blocks_of(one.pieces, spacing))
        outlines.append(list(itertools.chain.from_iterable(drawn)))
    attributes = list(itertools.chain.from_iterable(made_ahead(describe, n_drawn, monitor.part(0.9, 1.0))))
    rings = [[ring + sampling.corner for ring in outlined.rings] for of_part in outlines for outlined in of_part]
    found = [one for one in zip(rings, attributes) if sampling.asks_for(plan_box(one[0][0]))]
    return with_reviewed(_features(found, min_area), review)


@dataclass(frozen=True)
class _Part:
    """Buildings that can be outlined by themselves."""

    members: np.ndarray  #: (m,), int64: all their points in the cloud
    roof: np.ndarray  #: (p,), int64: points of their roofs in the cloud
    beside: np.ndarray  #: (q,), int64: non-building ones next to
    label: np.ndarray  #: (p,), int64: cluster of each roof point


@dataclass(frozen=True)
class _Evidence:
    """Shares and pieces of the buildings of a part, and the rings of each building."""

    shares: dict[int, Shares]
    pieces: list[OutlinePiece]
    rings: dict[int, list[np.ndarray]]


def _building_points(classification: np.ndarray, cluster_id: Optional[np.ndarray], monitor: Monitor) -> np.ndarray:
    """Return the points (b,) to be outlined; without any, warn."""
    is_building = classification == PointClass.BUILDING
    building = np.flatnonzero(is_building & (cluster_id is None or cluster_id > 0))
    if not len(building):
        what = "of class 6 (building) has a ClusterID" if is_building.any() else "is called building (class 6)"
        monitor.none_found(f"No point {what}, so there are no footprints.")
    return building


def _parts(
    measures: PointMeasures, classification: np.ndarray, building: np.ndarray, cluster: np.ndarray, spacing: float
) -> list[_Part]:
    """Return the parts of building points that lie apart, with the points next to them that show where roofs end."""
    xyz, reason = measures.xyz, measures.reason
    # Sorted by cluster and coordinates, so that sums over points do not depend on the order of the cloud.
    order = np.lexsort((*xyz[building].T, cluster))
    building, cluster = building[order], cluster[order]
    is_attached = np.zeros(len(building), bool) if reason is None else np.isin(reason[building], ADDED)
    is_roof = find_roof_points(measures.local(building), cluster, is_attached, spacing)
    beside = find_non_building_points(xyz, classification, building[is_roof], spacing)
    beside = beside[np.lexsort(xyz[beside].T)]
    parts = []
    for rows, others in _apart(measures.plan(building), measures.plan(beside), APART * spacing):
        roof = rows[is_roof[rows]]
        # Roof points that span an area are a millimeter wide at least.
        if len(roof) > 2 and np.linalg.eigvalsh(np.cov(measures.plan(building[roof]).T))[0] > MILLIMETER**2:
            parts.append(_Part(building[rows], building[roof], beside[others], cluster[roof]))
    return parts


def _asked_for(
    parts: list[_Part], measures: PointMeasures, sampling: CloudSampling, spacing: float
) -> tuple[list[_Part], int]:
    """Return the parts that are asked for, then those whose walls count for directions; and the number of the first."""
    if sampling.asked is None:
        return parts, len(parts)
    boxes = np.array([plan_box(measures.xyz[part.members]) for part in parts]).reshape(-1, 2, 2)
    asked = np.flatnonzero([sampling.asks_for(box, APART * spacing) for box in boxes])
    near = meeting_boxes(boxes[asked] + np.array([[-1], [1]]) * NEIGHBORS, boxes)[1]
    return [parts[row] for row in (*asked, *np.setdiff1d(near, asked))], len(asked)


def _apart(building: np.ndarray, non_building: np.ndarray, apart: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the rows of building points that can be outlined alone, and of the non-building points next to them.

    All are positions in plan (n, 2) and (m, 2), m from the corner of the whole. A non-building point next to two groups
    of buildings shows for both where their roofs end.
    """
    grid = fixed_grid_over(np.concatenate([building, non_building]), apart)
    cells, cell = distinct(grid.number(building))
    count, group = connected_cells(grid, cells)
    own = group[cell]
    # Non-building points lie in a cell of a group or next to one.
    non_building_cell = grid.number(non_building)
    pairs = [np.zeros(0, np.int64)]
    for step in (0, *grid.around):
        position, there = find_cells(cells, non_building_cell + step)
        rows = np.flatnonzero(there)
        pairs.append(group[position[rows]] * len(non_building) + rows)
    beside, row = np.divmod(np.unique(np.concatenate(pairs)), max(len(non_building), 1))
    return list(zip(split_groups(own, count), np.split(row, np.searchsorted(beside, np.arange(1, count)))))


def _evidence_of(part: _Part, measures: PointMeasures, how: BlockDrawing) -> _Evidence:
    """Return the shares, pieces and rings of the buildings of a part."""
    roof, beside = measures.local(part.roof), measures.plan(part.beside)
    walls = np.setdiff1d(part.members, part.roof)
    even, even_beside = np.split(even_weights(np.concatenate([roof[:, :2], beside]), how.spacing), [len(roof)])
    weight = even * edge_weights(roof, measures.local(walls), how.spacing)
    shares = find_shares(roof[:, :2], weight, part.label, beside, even_beside, how.spacing)
    found = (find_pieces(number, own, how.spacing, how.min_area, how.min_hole_area) for number, own in shares.items())
    pieces = list(itertools.chain.from_iterable(found))
    rings: dict[int, list[np.ndarray]] = {}
    for piece in pieces:
        rings.setdefault(piece.building, []).extend(piece.rings)
    return _Evidence({number: shares[number] for number in rings}, pieces, rings)


def _houses(
    part: _Part, evidence: _Evidence, directions: dict[int, np.ndarray], measures: PointMeasures, how: BlockDrawing
) -> dict[int, Houses]:
    """Return the houses of each building of a part, {} where touching buildings are merged."""
    if how.is_merged:
        return {}
    height = measures.over_lowest(part.roof, part.members)
    found = {}
    for number, shares in evidence.shares.items():
        own = part.label == number
        plan = measures.plan(part.roof[own])
        is_inside = shares.share > shares.rest
        found[number] = split_row(shares.lattice, is_inside, plan, height[own], directions[number], how.spacing)
    return found


def _features(found: list[tuple[list, dict[str, Any]]], min_area: float) -> LayerFeatures:
    """Drop footprints (rings, attributes) below ``min_area``; number the rest by cluster, then from the south-west."""
    kept = [one for one in found if one[1]["area"] >= min_area]
    kept.sort(key=lambda one: (one[1]["cluster_id"], *map(float, one[0][0].min(axis=0))))
    return LayerFeatures.numbered(kept, FIELDS)


def with_reviewed(found: LayerFeatures, review: Optional[ReviewedBuildings]) -> LayerFeatures:
    """Return the outlines that stay as they were reviewed, with their attributes, before the others that were found.

    Those that are mostly where others were decided on are left out. Buildings keep their numbers of the reviewed layer.
    """
    if review is None:
        return found
    layer, staying = review.layer, review.rows[: review.stay]
    own, given = as_polygons(found.geometries), as_polygons(layer.geometries)
    # Ascending by shared area: of several, the one with the largest shared area is assigned last.
    one, other, shared = overlaps(own, given, Monitor())
    order = np.argsort(shared)
    one, other, shared = one[order], other[order], shared[order]
    is_decided = np.isin(other, review.rows)
    covered = np.bincount(one[is_decided], shared[is_decided], len(found))
    others = np.flatnonzero(2 * covered <= own.area).tolist()
    ids = np.asarray(layer.columns.get("id", ""))
    is_numbered = ids.dtype.kind in "if"
    # "fid" is the number that a GeoPackage gives its rows.
    kept = {key: of for key, of in layer.kept(staying, () if is_numbered else FIELDS[:1]).items() if key != "map_fid"}
    cluster = dict(zip(other.tolist(), one.tolist()))
    kept["cluster_id"] = [found.columns["cluster_id"][cluster[row]] if row in cluster else 0 for row in staying]
    new = {name: [values[row] for row in others] for name, values in found.columns.items()}
    is_same = ~is_decided & is_numbered & (2 * shared > np.maximum(own.area[one], given.area[other]))
    before = dict(zip(one[is_same].tolist(), ids[other[is_same]].tolist() if is_numbered else ()))
    new["id"] = [before.get(row) for row in others]
    none_kept, none_new = [None] * len(staying), [None] * len(others)
    columns = {name: [*kept.get(name, none_kept), *new.get(name, none_new)] for name in dict.fromkeys([*new, *kept])}
    free = itertools.count(1 + int(np.nanmax(ids, initial=0)) if is_numbered else 1)
    columns["id"] = [next(free) if number is None or np.isnan(number) else int(number) for number in columns["id"]]
    sources = [*(layer.sources[row] if layer.sources else None for row in staying), *none_new]
    outlines = [[np.asarray(ring, float)[:, :2] for ring in layer.geometries[row]] for row in staying]
    return LayerFeatures([*outlines, *(found.geometries[row] for row in others)], columns, sources)
