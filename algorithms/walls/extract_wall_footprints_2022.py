"""Footprints of walls as published in 2022: corners of all pairs of lines, and edges where points are dense."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..criteria import MILLIMETER
from ..geometry.arrangement import Arrangement
from ..geometry.groups import components, members
from ..geometry.rings import perimeter, polygons_of, signed_area
from ..packages import csgraph, sparse
from ..params import MIN_MAPPED_AREA, SEED
from ..stage import Field, Layer, LayerFeatures, stage, tunable
from .candidate_corners import CORNER, OFF_OUTLINE
from .wall_lines import LEAST_PAIR, SCORED, TRIALS, WallLine, fit_line
from .wall_report import MEASURES, WALL, point_counts, wall_report

# A geometry and its attributes.
_Feature = tuple[Any, dict[str, Any]]

# Least length of a line: it has as many points as lie on this length (m) of an average wall.
_SHORTEST = 1.5

# Least number of points of a line that is set automatically: fewer lie on one by chance.
_LEAST_POINTS = 10

# An edge is real from this share of the median density along lines, as eaves and plants hide parts of walls.
_DENSE = 0.25

_FOOTPRINT_FIELDS = (
    Field("id", int, "number of the footprint, from 1"),
    Field("cluster_id", int, "building that it outlines"),
    Field("area", float, "area without courtyards", "m²"),
    Field("perimeter", float, "length of all edges", "m"),
)
_EDGE_FIELDS = (
    Field("id", int, "number of the edge, from 1"),
    Field("cluster_id", int, "building that it belongs to"),
    Field("length", float, "length", "m"),
    Field("points", int, "wall points in its buffer"),
    Field("density", float, "wall points per square meter of its buffer", "1/m²"),
)
_CORNER_FIELDS = (
    Field("id", int, "number of the corner, from 1"),
    Field("cluster_id", int, "building that it belongs to"),
    Field("edges", int, "edges that end in it"),
)

# Corners are searched up to this distance (m) outside the box around the wall points, as in the authors' program.
_AROUND = 10.0


@stage(
    "Buildings",
    title="Extract wall footprints (as published 2022)",
    tags="polygons,walls,corners,RANSAC,lines,right angles,cadastre,land registry,vectorize,UAV,Hrutka",
    layers=(
        Layer("wall_footprints", "Wall footprints", "Polygon", _FOOTPRINT_FIELDS),
        Layer("wall_edges", "Wall edges", "LineString", _EDGE_FIELDS),
        Layer("candidate_corners", "Candidate corners", "Point", _CORNER_FIELDS),
    ),
    measures=MEASURES,
    reach=np.inf,
    cost=5.0,
)
def extract_wall_footprints_2022(
    xyz,
    cluster_id,
    wall_of,
    classification=None,
    voxel_count=None,
    *,
    min_area: float = MIN_MAPPED_AREA,
    tolerance: float = tunable(0.1, within="[0.01, 2] m"),
    min_points: Optional[int] = tunable(
        None,
        label="Minimum points of a line",
        within="[2, 100_000]",
        automatic=(
            f"as many as lie on {_SHORTEST:g} m of wall, if the sides of the boxes around all walls have the "
            f"same number per meter; at least {_LEAST_POINTS}."
        ),
    ),
    max_skew: float = tunable(5.0, within="[0, 90]°"),
    width: float = tunable(0.2, label="Buffer", within="[0.01, 5] m"),
    ends: float = tunable(0.2, label="Corner distance", within="[0, 5] m"),
    min_density: Optional[float] = tunable(
        None,
        within="(0, 1_000_000] points/m²",
        automatic=f"{_DENSE:g} times the density around all lines in the median.",
    ),
    seed: int = SEED,
    monitor=None,
):
    """Draw the walls of each building as published: edges are the pairs of corners with many points between.

    Lines are found among the wall points of each building in plan, one after the other. All pairs of them that cross
    at right angles give corners. Each pair of corners with enough points in a rectangle along their connection is an
    edge. Footprints are what edges enclose. 'Extract wall footprints' closes outlines where no wall was seen.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    cluster_id : ndarray of shape (n,), int32
        Building of each roof point from 1, for the report only; 0 if unassigned.
    wall_of : ndarray of shape (n,), int32
        Building of each wall point from 1; 0 if unassigned.
    classification : ndarray of shape (n,), uint8, optional
        ASPRS classes, for the report only.
    voxel_count : ndarray of shape (n,), uint32, optional
        Points that each point was made of, for the report only.

    Returns
    -------
    wall_footprints : LayerFeatures
        What the edges of a building enclose; a building whose edges do not close has none.
    wall_edges : LayerFeatures
        Edges from corner to corner.
    candidate_corners : LayerFeatures
        All crossings of two lines at right angles up to 10 m around the walls.
    report : Report
        Points of each kind, footprints and corners, and a page that shows them.

    Other Parameters
    ----------------
    tolerance
        Distance within which points lie on a line.
    min_points
        Points of a line at least; the authors' program takes 90.
    max_skew
        Largest deviation of a corner from a right angle; others are no corners.
    width
        How far the buffer around an edge reaches to both sides.
    ends
        Length at both ends of an edge that its buffer leaves out.
    min_density
        Wall points per square meter in the buffer of an edge at least; the authors' program takes 90.

    Notes
    -----
    The paper gives no thresholds. Tolerance, buffer and corner distance are as in the program that its authors
    published (pc_utils, May 2022). So is that no other corner may lie in the buffer of an edge, and that the two points
    which a line is tried through are half a meter apart. Its numbers of points suit its clouds of about a
    thousand points per square meter, so that they follow the data here. The paper draws edges; the polygons are this
    project's. A line is fitted to its points by least squares. The result depends on the seed, and not on the order of
    points.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection.
    International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1, section
    2.4. [hrutka2022]

    Examples
    --------
    >>> side = np.arange(0, 8, 0.1)
    >>> x = np.concatenate([side, side, 0 * side, 0 * side + 8])
    >>> y = np.concatenate([0 * side, 0 * side + 8, side, side])
    >>> one = np.ones(len(x), int)
    >>> footprints, *_ = extract_wall_footprints_2022(np.column_stack([x, y, one]), 0 * one, one)
    >>> bool(abs(footprints.columns["area"][0] - 64) < 1)
    True
    """
    walls = {number: xyz[rows, :2] for number, rows in members(wall_of).items()}
    walls = {number: xy[np.lexsort(xy.T)] for number, xy in walls.items()}
    min_points = _min_points(walls) if min_points is None else min_points
    lines = {}
    for number, xy in walls.items():
        lines[number] = sequential_lines(xy - xy[0], tolerance, min_points, seed)
        monitor.progress(0.5 * len(lines) / len(walls))
    min_density = _min_density(lines, width) if min_density is None else min_density
    monitor.resolved(min_points=min_points, min_density=min_density)
    buffer = Buffer(width, ends, min_density)
    features: tuple[list[_Feature], ...] = [], [], []
    outcomes = []
    for done, (number, xy) in enumerate(walls.items(), start=1):
        found = corner_pairs(lines[number], xy - xy[0], max_skew, buffer)
        rings, is_vertex = found.outline()
        outcomes += [CORNER if one else OFF_OUTLINE for one in is_vertex]
        made = _polygons([ring + xy[0] for ring in rings], min_area), _edges(found, xy[0]), _corners(found, xy[0])
        for layer, own in zip(features, made):
            layer += [(geometry, {"cluster_id": number, **facts}) for geometry, facts in own]
        monitor.progress(0.5 + 0.5 * done / len(walls))
    counts = point_counts(cluster_id, wall_of, classification, voxel_count)
    report = wall_report(counts, [WALL] * len(features[0]), outcomes)
    return (*map(LayerFeatures.numbered, features, (_FOOTPRINT_FIELDS, _EDGE_FIELDS, _CORNER_FIELDS)), report)


def _min_points(walls: dict[int, np.ndarray]) -> int:
    """Return the least number of points of a line, from the wall points (n, 2), m, of each building."""
    around = sum(2 * float(np.ptp(xy, axis=0).sum()) for xy in walls.values())
    return max(_LEAST_POINTS, round(_SHORTEST * sum(map(len, walls.values())) / max(around, 1.0)))


def _min_density(lines: dict[int, list[WallLine]], width: float) -> float:
    """Return the least density (1/m²) of points in the buffer of an edge, from the lines of each building."""
    along = [len(line.points) / (2 * width * np.ptp(line.along)) for own in lines.values() for line in own]
    return _DENSE * float(np.median(along)) if along else 1.0


def _polygons(rings: list[np.ndarray], min_area: float) -> Iterator[_Feature]:
    """Yield the polygons of rings that have an area (m²) at least, with their attributes."""
    for part in polygons_of(rings):
        own = [rings[i] for i in part]
        area = sum(map(signed_area, own))
        if area >= min_area:
            yield own, {"area": area, "perimeter": sum(map(perimeter, own))}


def _edges(found: CornerPairs, origin: np.ndarray) -> Iterator[_Feature]:
    """Yield the edges of a building with their attributes."""
    for i, j, points, density in found.edges:
        line = found.corners[[i, j]] + origin
        yield line, {"length": float(np.hypot(*(line[1] - line[0]))), "points": points, "density": density}


def _corners(found: CornerPairs, origin: np.ndarray) -> Iterator[_Feature]:
    """Yield the corners of a building with their attributes."""
    count = np.bincount([at for edge in found.edges for at in edge[:2]], minlength=len(found.at))
    yield from ((at + origin, {"edges": int(edges)}) for at, edges in zip(found.corners, count))


@dataclass(frozen=True)
class Buffer:
    """The rectangle along the connection of two corners in which wall points are counted."""

    width: float  #: Reach to both sides, m
    ends: float  #: Length left out at both ends, m
    min_density: float  #: Points per m² at which the connection is an edge

    def count(self, xy: np.ndarray, start: np.ndarray, end: np.ndarray) -> tuple[int, float]:
        """Return the number of points (n, 2), m, in the rectangle between two corners, and their density per m²."""
        length = float(np.hypot(*(end - start)))
        if length <= 2 * self.ends:
            return 0, 0.0
        way, offset = (end - start) / length, xy - start
        along, across = offset @ way, offset @ [-way[1], way[0]]
        inside = (along > self.ends) & (along < length - self.ends) & (np.abs(across) < self.width)
        count = int(np.count_nonzero(inside))
        return count, count / (2 * self.width * (length - 2 * self.ends))


@dataclass(frozen=True)
class CornerPairs:
    """The corners of a building, and the pairs of them with a wall between."""

    cells: Arrangement  #: The cells that its lines cut
    at: np.ndarray  #: (c,): the crossings of lines that are corners
    edges: list[tuple[int, int, int, float]]  #: Two corners, and the wall points between them, also per m²

    @property
    def corners(self) -> np.ndarray:
        """Positions (c, 2) of the corners, m."""
        return self.cells.positions[self.at]

    def outline(self) -> tuple[list[np.ndarray], np.ndarray]:
        """Return rings (m, 2), m, around areas that edges enclose, and which corners (c,) are vertices of them.

        A cell is inside if the way out that crosses the fewest edges crosses an odd number; an even number means a
        courtyard.
        """
        cells, is_wall = self.cells, self._is_wall()
        left, right = cells.edges.left, cells.edges.right
        count, part = components(left[~is_wall], right[~is_wall], cells.count)
        passed = part[left[is_wall]], part[right[is_wall]]
        graph, start = sparse.coo_matrix((np.ones(is_wall.sum()), passed), (count, count)), np.argmax(cells.is_border)
        passes = csgraph.shortest_path(graph, directed=False, unweighted=True, indices=part[start])
        rings = [[at for _, at in ring] for ring in cells.outline(passes[part] % 2 == 1)]
        vertices = np.array([at for ring in rings for at in ring], np.int64)
        return [cells.positions[[*ring, ring[0]]] for ring in rings], np.isin(self.at, vertices)

    def _is_wall(self) -> np.ndarray:
        """Return the mask of pieces (e,) of lines between two crossings that lie on an edge."""
        pieces, lines = self.cells.edges, self.cells.crossing[self.at]
        is_wall = np.zeros(len(pieces.line), bool)
        for i, j, *_ in self.edges:
            for line in np.intersect1d(lines[i], lines[j]):
                ends = self.corners[[i, j]] - self.cells.points[line]
                low, high = np.sort(ends @ self.cells.directions[line])
                is_wall |= (pieces.line == line) & (pieces.low > low - MILLIMETER) & (pieces.high < high + MILLIMETER)
        return is_wall


def sequential_lines(xy: np.ndarray, tolerance: float, min_points: int, seed: int) -> list[WallLine]:
    """Return lines by sequential RANSAC: the points of a line are removed before the next is sought.

    Parameters
    ----------
    xy : ndarray of shape (n, 2), float64
        Positions in plan, m.
    tolerance : float
        Greatest distance of a point from its line, m.
    min_points : int
        Least number of points on a line.
    seed : int
        Start of the random numbers.
    """
    rng, left, lines = np.random.default_rng(seed), np.arange(len(xy)), []
    while len(left) >= min_points:
        on_line = left[_on_best_line(xy[left], tolerance, rng)]
        if len(on_line) < max(min_points, 2):
            break
        lines.append(fit_line(xy, on_line))
        left = np.setdiff1d(left, on_line, assume_unique=True)
    return lines


def _on_best_line(xy: np.ndarray, tolerance: float, rng: np.random.Generator) -> np.ndarray:
    """Return the mask of points (n,) on the best line through two of them: the one with most points."""
    start, end = xy[rng.integers(0, len(xy), (2, TRIALS))]
    step = end - start
    length = np.hypot(*step.T)
    is_long = length >= LEAST_PAIR
    if not is_long.any():
        return np.zeros(len(xy), bool)
    normal = np.column_stack([-step[is_long, 1], step[is_long, 0]]) / length[is_long, None]
    level = np.einsum("ij,ij->i", normal, start[is_long])
    scored = xy if len(xy) <= SCORED else xy[rng.choice(len(xy), SCORED, replace=False)]
    best = int(np.argmax(np.count_nonzero(np.abs(scored @ normal.T - level) <= tolerance, axis=0)))
    return np.abs(xy @ normal[best] - level[best]) <= tolerance


def corner_pairs(lines: list[WallLine], xy: np.ndarray, max_skew: float, buffer: Buffer) -> CornerPairs:
    """Return the corners of a building, where two lines are square within an angle (°), and those with a wall between.

    Parameters
    ----------
    lines : list of WallLine
        Its lines.
    xy : ndarray of shape (n, 2)
        Its wall points, m.
    max_skew : float
        Largest deviation from a right angle, °.
    buffer : Buffer
        Where points are counted.
    """
    points, ways = (np.array([getattr(line, name) for line in lines]).reshape(-1, 2) for name in ("point", "direction"))
    cells = Arrangement(points, ways, xy.min(axis=0) - _AROUND, xy.max(axis=0) + _AROUND)
    u, v = np.moveaxis(ways[cells.crossing], 1, 0)
    at = np.flatnonzero(np.abs(np.einsum("ij,ij->i", u, v)) <= np.sin(np.deg2rad(max_skew)))
    corners, edges = cells.positions[at], []
    for i, j in zip(*np.triu_indices(len(at), 1)):
        count, density = buffer.count(xy, corners[i], corners[j])
        if density >= buffer.min_density and not buffer.count(corners, corners[i], corners[j])[0]:
            edges.append((i, j, count, density))
    return CornerPairs(cells, at, edges)
