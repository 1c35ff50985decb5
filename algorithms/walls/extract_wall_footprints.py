"""Footprints of walls: polygons with a quality for each edge, of roofs where no walls were seen."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Optional

import numpy as np

from ..criteria import MAJORITY
from ..geometry.disjoint_polygons import divide_overlap
from ..geometry.grid import SparsePointsError
from ..geometry.groups import members
from ..geometry.polygon_overlap import as_polygons, overlaps
from ..geometry.rings import perimeter, polygons_of, signed_area
from ..params import MIN_MAPPED_AREA, SEED
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.density import point_spacing
from ..sampling.surface_noise import ROUGHNESS
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from .alleys import find_alley
from .candidate_corners import CORNER_FIELDS, candidate_corners
from .roof_outline import RoofOutline, outline_roof
from .surroundings import Surroundings
from .wall_edges import WallEdge, closed, edge_between, points_near
from .wall_lines import WallLine
from .wall_outline import Limits, WallOutline, outline_walls, share_seen
from .wall_report import MEASURES, WALL, point_counts, wall_report

ROOF = "roof"

# A geometry and its attributes.
_Feature = tuple[Any, dict[str, Any]]

# Distance in plan within which points lie on a wall (times the roughness).
_ON_WALL = 3.1

_TOLERANCE = tunable(
    None,
    "Distance within which points lie on a wall.",
    within="[0.01, 2] m",
    automatic=f"{_ON_WALL:g} times the roughness: {ROUGHNESS}.",
)

_FIELDS = (
    Field("id", int, "number of the footprint, from 1"),
    Field("cluster_id", int, "building that it outlines"),
    Field("source", str, "wall: outline of the walls; roof: outline of the roof, as too few walls were seen"),
    Field("area", float, "area without courtyards", "m²"),
    Field("perimeter", float, "length of all edges", "m"),
    Field("edges", int, "number of edges"),
    Field("edges_seen", int, "edges of which at least half has wall points"),
    Field("quality", float, "share of the perimeter that has wall points, 0 to 1"),
    Field("worst_quality", float, "share of the least seen edge that has wall points, 0 to 1"),
    Field("deviation", float, "standard deviation of wall points across their edges", "m"),
    Field("overhang", float, "median distance from the walls to the edge of the roof", "m"),
    Field("height", float, "median height of the roof's points above ground", "m"),
    Field("points", int, "wall points on the edges"),
)

_EDGE_FIELDS = (
    Field("id", int, "number of the edge, from 1"),
    Field("footprint", int, "footprint that it belongs to", of="wall_footprints"),
    Field("edge", int, "number of the edge in its footprint, from 1, counterclockwise"),
    Field("source", str, "wall: seen; roof: derived from the edge of the roof"),
    Field("length", float, "length", "m"),
    Field("angle", float, "inner angle at the corner where it begins", "°"),
    Field("quality", float, "share of the edge that has wall points, corners left out, 0 to 1"),
    Field("points", int, "wall points on it"),
    Field("deviation", float, "standard deviation of its points across it", "m"),
    Field("precision", float, "standard deviation across its direction, from its points", "m"),
)


@stage(
    "Buildings",
    tags="polygons,walls,corners,RANSAC,lines,right angles,cadastre,land registry,vectorize,UAV",
    layers=(
        Layer("wall_footprints", "Wall footprints", "Polygon", _FIELDS),
        Layer("wall_edges", "Wall edges", "LineString", _EDGE_FIELDS),
        Layer("candidate_corners", "Candidate corners", "Point", CORNER_FIELDS),
    ),
    measures=MEASURES,
    cost=5.0,
)
def extract_wall_footprints(
    xyz,
    cluster_id,
    wall_of=None,
    height_above_ground=None,
    classification=None,
    voxel_count=None,
    *,
    min_area: float = MIN_MAPPED_AREA,
    min_length: float = tunable(1.2, label="Minimum wall length", within="[0.2, 100] m"),
    max_overhang: float = tunable(1.2, within="[0, 10] m"),
    min_seen: float = tunable(0.25, label="Minimum share of walls seen", within="[0, 1]"),
    tolerance: Optional[float] = _TOLERANCE,
    seed: int = SEED,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Outline the walls of each building, without the eaves: corners where walls meet, and a quality for every edge.

    Lines are fitted to the wall points of each building in plan, one after the other. They, and lines for sides of the
    roof under which no wall was seen, cut the plane into cells. The footprint is made of the cells whose outline runs
    along walls that were seen, as far as there are any. Walls that are nearly square or parallel become so where
    their points allow it.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    cluster_id : ndarray of shape (n,), int32
        Building of each roof point from 1; 0 if unassigned.
    wall_of : ndarray of shape (n,), int32, optional
        Building of each wall point from 1; 0 if unassigned. Without it, footprints are outlines of roofs.
    height_above_ground : ndarray of shape (n,), float32, optional
        Heights, m, for the attributes only.
    classification : ndarray of shape (n,), uint8, optional
        ASPRS classes, for the report only.
    voxel_count : ndarray of shape (n,), uint32, optional
        Points that each point was made of, for the report only.

    Returns
    -------
    wall_footprints : LayerFeatures
        One polygon per building, by cluster number. ``source`` says whether it is of walls or of the roof.
    wall_edges : LayerFeatures
        The edges of all footprints with the share seen and the points of each.
    candidate_corners : LayerFeatures
        The intersections of all pairs of a building's lines within 2 m of the box around its roof, and what became
        of each.
    report : Report
        Points of each kind, footprints and corners, and a page that shows them.

    Other Parameters
    ----------------
    min_length
        Length of the shortest wall that is looked for.
    max_overhang
        How far roofs may jut out over their walls; parts deeper under a roof are inside.
    min_seen
        Where less of the perimeter has wall points, the outline of the roof is given instead.

    Notes
    -----
    Thresholds follow the data of each building. The distance of points to their line follows from the noise. A wall is
    cut into pieces that should hold three points each, and is covered where they hold any. An edge of the outline is
    judged by its points between the corners, which are left out. The paper takes every pair of corners for a candidate
    edge. Here the whole outline is the one that costs least: unseen wall by the meter, corners by the piece and more
    where they aren't square, parts outside the roof by the area. It is found by a minimum cut, then line by line it is
    tried whether the outline is better off without.

    Gaps of a roof, and bites at its edge up to 4 m wide, are roof where no point is seen in them, as long as surfaces
    are seen all around. Gaps with points a meter and more below the eaves are courtyards. Sides next to which another
    roof begins are party walls: they lie under the edge of the roof, and are not counted in the share of walls seen.
    Parts of a roof inside of others are left out.

    Houses whose roofs nearly touch are one building by the distance between roofs. They are outlined one by one where
    two walls face each other across the whole building, no farther apart than twice the maximum overhang. At
    least half of each must be seen, and the smallest building or more lie behind both. The line halfway between the
    walls parts the roof. Passages under one roof are parted in the same way.

    Houses are outlined one by one. What two outlines share stays in the footprint with more roof points there, so that
    no two overlap.

    Parts deeper under a roof than it juts out over the other walls count as inside: loggias, porches. Sides
    without wall points lie as far inside the edge of the roof as the other walls in the median; ``quality`` 0 marks
    them. The result depends on the seed, and not on the order of points. A building whose points are spread so thinly
    that it would be nearly empty has no footprint; the log names it.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection.
    International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1, section
    2.4. [hrutka2022]
    Fischler, M. A., Bolles, R. C., 1981. Random sample consensus: a paradigm for model fitting. Communications of the
    ACM 24 (6), 381-395. [fischler1981]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> footprints, edges, corners, report = extract_wall_footprints(xyz, np.where(z > 0, 1, 0))
    >>> len(footprints)
    1
    """
    footprints: list[_Feature] = []
    edges: list[_Feature] = []
    corners: list[_Feature] = []
    buildings = _buildings(xyz, cluster_id, wall_of, sampling)
    if tolerance is None:
        tolerance = float(np.clip(_ON_WALL * sampling.roughness, _TOLERANCE.low, _TOLERANCE.high))
        monitor.resolved(tolerance=tolerance)
    limits = Limits(tolerance, min_length, max_overhang, min_area, min_seen, seed)
    outlined: list[_Outlined] = []
    for building, part in zip(buildings, monitor.parts(len(buildings))):
        try:
            outlined += [_outlined(*house, limits) for house in _houses(building, limits, part)]
        except SparsePointsError as error:
            monitor.warn(f"Building {building.number} has no footprint. {error}")
        part.progress(1.0)
    for one, parts in zip(outlined, _disjoint_parts(outlined, min_area)):
        for rings in parts:
            footprints.append(_footprint(rings, one, height_above_ground))
            edges += _edges(rings, len(footprints), one.house.origin)
        if one.outline is not None:
            found = candidate_corners(one.outline, [ring for rings in parts for ring in rings], one.used is not None)
            corners += [(at + one.house.origin, {"cluster_id": one.house.number, **facts}) for at, facts in found]
    layers = zip((footprints, edges, corners), (_FIELDS, _EDGE_FIELDS, CORNER_FIELDS))
    made = [LayerFeatures.numbered(features, fields) for features, fields in layers]
    _tell_unseen(made[0], monitor)
    counts = point_counts(cluster_id, wall_of, classification, voxel_count)
    return *made, wall_report(counts, made[0].columns["source"], made[2].columns["outcome"])


@dataclass(frozen=True)
class _Outlined:
    """A house with its outline."""

    house: _Building
    outline: Optional[WallOutline]  #: Outline of its walls, None where there are too few
    used: Optional[WallOutline]  #: The same where enough of it was seen
    parts: list[list[list[WallEdge]]]  #: Rings of each part, of walls or of the roof

    def redrawn(self, rings: list[np.ndarray]) -> list[list[list[WallEdge]]]:
        """Return the parts within other rings (k, 2), m, with the seen share of their edges."""
        plan = [ring - self.house.origin for ring in rings]
        return _parts([[self._edge(start, end) for start, end in zip(ring, ring[1:])] for ring in plan])

    def _edge(self, start: np.ndarray, end: np.ndarray) -> WallEdge:
        """Return an edge with the wall points along it, none for outlines of roofs."""
        if self.used is None:
            return _bare_edge(start, end)
        walls, scale = self.house.walls, self.used.cells.scale
        direction = (end - start) / np.hypot(*(end - start))
        line = WallLine(start, direction, np.arange(len(walls)), np.zeros(0), np.nan)
        return edge_between(start, end, line, points_near(walls, line, scale), scale)


def _outlined(house: _Building, outline: Optional[WallOutline], limits: Limits) -> _Outlined:
    """Return a house with the outline of its walls, or of its roof where too little of them was seen."""
    used = outline if outline is not None and house.seen_of(outline) >= limits.min_seen else None
    parts = _parts(used.rings) if used is not None else _bare_parts(house)
    return _Outlined(house, outline, used, _large_parts(parts, limits.min_area))


def _parts(rings: list[list[WallEdge]]) -> list[list[list[WallEdge]]]:
    """Sort rings into parts: each exterior with the holes in it."""
    return [[rings[i] for i in part] for part in polygons_of(list(map(closed, rings)))]


def _large_parts(parts: list[list[list[WallEdge]]], min_area: float) -> list[list[list[WallEdge]]]:
    """Return the parts of at least ``min_area`` (m²)."""
    return [rings for rings in parts if sum(signed_area(closed(ring)) for ring in rings) >= min_area]


def _disjoint_parts(outlined: list[_Outlined], min_area: float) -> list[list[list[list[WallEdge]]]]:
    """Return the parts of each house, outlined alone, without pieces in which others have more roof points.

    The remainder of a part must have ``min_area`` (m²).
    """
    number = [at for at, one in enumerate(outlined) for _ in one.parts]
    whole = [[closed(ring) + one.house.origin for ring in rings] for one in outlined for rings in one.parts]
    left, polygons = list(whole), as_polygons(whole)
    for one, other, area in zip(*overlaps(polygons, polygons, Monitor())):
        if area > 0 and number[one] < number[other] and left[one] and left[other]:
            roofs = (outlined[number[at]].house.roof_xyz[:, :2] for at in (one, other))
            left[one], left[other] = divide_overlap(left[one], left[other], *roofs)
    parts: list[list[list[list[WallEdge]]]] = [[] for _ in outlined]
    drawn = [rings for one in outlined for rings in one.parts]
    for at, before, after, rings in zip(number, whole, left, drawn):
        parts[at] += [rings] if after is before else _large_parts(outlined[at].redrawn(after), min_area)
    return parts


def _houses(building: _Building, limits: Limits, monitor: Monitor) -> list[tuple[_Building, Optional[WallOutline]]]:
    """Return the houses that a building is made of, with their outlines; mostly the one that it is."""
    outline = building.walls_outline(limits, monitor)
    alley = None if outline is None else find_alley(outline, limits)
    if alley is not None:
        # The progress has counted the outline of the whole.
        rest = monitor.part(1.0, 1.0)
        houses = [house for part in building.parted(alley) for house in _houses(part, limits, rest)]
        if all(own is not None for _, own in houses):
            return houses
    return [(building, outline)]


def _tell_unseen(footprints: LayerFeatures, monitor: Monitor) -> None:
    """Say how many footprints are outlines of roofs, and how many rest on few walls."""
    source, quality = footprints.columns["source"], footprints.columns["quality"]
    if ROOF in source:
        monitor.warn(
            f"{source.count(ROOF)} of {len(footprints)} footprints are outlines of roofs, "
            "as too few of their walls were seen."
        )
    thin = sum(one == WALL and seen < MAJORITY for one, seen in zip(source, quality))
    if thin:
        monitor.warn(
            f"Of {thin} of {len(footprints)} footprints less than half of the walls was seen; "
            "where the others are (edges of quality 0) is guessed from the edge of the roof."
        )


@dataclass(frozen=True)
class _Building:
    """The points of one building."""

    number: int
    origin: np.ndarray  #: (2,): south-western corner of the roof's points, m
    roof: np.ndarray  #: (n, 2): points of the roof from the origin, m, sorted by their coordinates
    walls: np.ndarray  #: (k, 2): points of the walls in the same way
    roof_rows: np.ndarray  #: (n,): rows of the roof's points in the cloud
    surroundings: Surroundings

    @cached_property
    def roof_xyz(self) -> np.ndarray:
        """Points (n, 3) of the roof in the order of the rows, m, not from the origin."""
        return self.surroundings.xyz[self.roof_rows]

    @cached_property
    def roof_spacing(self) -> float:
        """Mean distance between points of the roof, m; 0 where they lie at one position.

        It differs from the cloud's spacing, as flight lines pass each roof at another distance and number.
        """
        return point_spacing(self.roof) if np.ptp(self.roof, axis=0).any() else 0.0

    @cached_property
    def roof_outline(self) -> Optional[RoofOutline]:
        """Outline of the roof, and of gaps in it where nothing was seen; None where it has no area."""
        if not self.roof_spacing:
            return None
        gaps = self.surroundings.gaps(self.roof_xyz, self.roof_spacing) - self.origin
        return outline_roof(np.concatenate([self.roof, gaps]), self.roof_spacing)

    def parted(self, line: WallLine) -> list[_Building]:
        """Return the parts left and right of a line."""
        left = [line.across(xy) > 0 for xy in (self.roof, self.walls, self.roof_xyz[:, :2] - self.origin)]
        return [
            replace(self, roof=self.roof[roof], walls=self.walls[walls], roof_rows=self.roof_rows[rows])
            for roof, walls, rows in (left, [~is_left for is_left in left])
        ]

    def is_party(self, sides: np.ndarray) -> np.ndarray:
        """Return the mask of the sides (k, 2, 2) of the roof next to which another roof begins."""
        return self.surroundings.is_party(sides + self.origin, self.number)

    def seen_of(self, outline: WallOutline) -> float:
        """Return the share of an outline that has wall points, 0 to 1, of the walls that can be seen from outside."""
        edges = [edge for ring in outline.rings for edge in ring]
        is_party = self.is_party(np.array([[edge.start, edge.end] for edge in edges]))
        free = [edge for edge, hidden in zip(edges, is_party) if not hidden]
        return share_seen([free] if free else outline.rings)

    def walls_outline(self, limits: Limits, monitor: Monitor) -> Optional[WallOutline]:
        """Return the outline of the walls near the origin, None where there are too few."""
        if not len(self.walls) or self.roof_outline is None:
            return None
        return outline_walls(self.walls, self.roof_outline, limits, self.is_party, monitor)


def _buildings(
    xyz: np.ndarray, cluster_id: np.ndarray, wall_of: Optional[np.ndarray], sampling: CloudSampling
) -> list[_Building]:
    """Return the buildings that have a roof, by number."""
    surroundings = Surroundings(xyz, cluster_id, sampling)
    roofs, walls = members(cluster_id), {} if wall_of is None else members(wall_of)
    buildings = []
    for number, rows in roofs.items():
        roof, own = (xyz[part[np.lexsort(xyz[part].T)], :2] for part in (rows, walls.get(number, rows[:0])))
        origin = roof.min(axis=0)
        buildings.append(_Building(number, origin, roof - origin, own - origin, rows, surroundings))
    return buildings


def _bare_parts(house: _Building) -> list[list[list[WallEdge]]]:
    """Return the outlines of the parts of a roof as rings of edges of which nothing was seen."""
    parts = house.roof_outline.parts if house.roof_outline else []
    return [[[_bare_edge(a, b) for a, b in zip(ring, ring[1:])] for ring in rings] for rings in parts]


def _bare_edge(start: np.ndarray, end: np.ndarray) -> WallEdge:
    """Return an edge of which nothing was seen."""
    return WallEdge(start, end, 0.0, 0, float("nan"), float("nan"))


def _footprint(rings: list[list[WallEdge]], one: _Outlined, height: Optional[np.ndarray]) -> _Feature:
    """Return a footprint of rings of edges, the exterior first."""
    corners = [closed(ring) for ring in rings]
    own_edges = [edge for ring in rings for edge in ring]
    quality = np.array([edge.quality for edge in own_edges])
    points = np.array([edge.points for edge in own_edges])
    facts = {
        "cluster_id": one.house.number,
        "source": ROOF if one.used is None else WALL,
        "area": sum(map(signed_area, corners)),
        "perimeter": sum(map(perimeter, corners)),
        "edges": len(own_edges),
        "edges_seen": int((quality >= MAJORITY).sum()),
        "quality": share_seen(rings),
        "worst_quality": float(quality.min()),
        "deviation": _pooled(np.array([edge.deviation for edge in own_edges]), points),
        "overhang": float("nan") if one.used is None else one.used.overhang,
        "height": float("nan") if height is None else float(np.median(height[one.house.roof_rows])),
        "points": int(points.sum()),
    }
    return [ring + one.house.origin for ring in corners], facts


def _pooled(deviation: np.ndarray, points: np.ndarray) -> float:
    """Return the deviation of all points from the points of each edge; NaN without any."""
    seen = points > 0
    return float(np.sqrt(np.average(deviation[seen] ** 2, weights=points[seen]))) if seen.any() else float("nan")


def _edges(rings: list[list[WallEdge]], footprint: int, origin: np.ndarray) -> Iterator[_Feature]:
    """Yield the edges of a footprint, ring by ring, numbered from 1."""
    pairs = [pair for ring in rings for pair in zip([ring[-1], *ring], ring)]
    for number, (before, edge) in enumerate(pairs, start=1):
        facts = {
            "footprint": footprint,
            "edge": number,
            "source": WALL if edge.quality >= MAJORITY else ROOF,
            "length": float(np.hypot(*(edge.end - edge.start))),
            "angle": _inner_angle(before, edge),
            "quality": edge.quality,
            "points": edge.points,
            "deviation": edge.deviation,
            "precision": edge.precision,
        }
        yield np.array([edge.start, edge.end]) + origin, facts


def _inner_angle(before: WallEdge, edge: WallEdge) -> float:
    """Return the angle (degrees) inside the building between an edge and the one before it."""
    (x0, y0), (x1, y1) = before.end - before.start, edge.end - edge.start
    return float(180.0 - np.degrees(np.arctan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1)))
