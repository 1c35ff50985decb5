"""Footprints of walls as published in 2022: corners of all pairs of lines, and edges where points are dense."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Optional

import numpy as np

from ..geometry.groups import members
from ..geometry.line_segments import polygons_of
from ..geometry.rings import perimeter, signed_area
from ..params import MIN_BUILDING_AREA, SEED
from ..stage import Field, Layer, LayerFeatures, stage, tunable
from .candidate_corners import CORNER, OFF_OUTLINE
from .corner_pairs import Buffer, CornerPairs, corner_pairs, sequential_lines
from .wall_lines import WallLine
from .wall_report import MEASURES, WALL, point_counts, wall_report

# A geometry and its attributes.
_Feature = tuple[Any, dict[str, Any]]

# A line has as many points as lie on this length (m) of wall in the mean.
_SHORTEST = 1.5

# Least number of points of a line that is set automatically: fewer lie on one by chance.
_LEAST_POINTS = 10

# Share of the density along lines, in the median, at which an edge is real: eaves and plants hide parts of walls.
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
    min_area: float = MIN_BUILDING_AREA.with_default(6.0),
    tolerance: float = tunable(0.1, "Distance within which points lie on a line.", within="[0.01, 2] m"),
    min_points: Optional[int] = tunable(
        None,
        "Points of a line at least; the authors' program takes 90.",
        label="Minimum points of a line",
        within="[2, 100_000]",
        automatic=f"as many as lie on {_SHORTEST:g} m of wall, if the sides of the boxes around all walls have the "
        f"same number per meter; at least {_LEAST_POINTS}.",
    ),
    max_skew: float = tunable(
        5.0, "Largest deviation of a corner from a right angle; others are no corners.", within="[0, 90]°"
    ),
    width: float = tunable(
        0.2, "How far the buffer around an edge reaches to both sides.", label="Buffer", within="[0.01, 5] m"
    ),
    ends: float = tunable(
        0.2, "Length at both ends of an edge that its buffer leaves out.", label="Corner distance", within="[0, 5] m"
    ),
    min_density: Optional[float] = tunable(
        None,
        "Wall points per square meter in the buffer of an edge at least; the authors' program takes 90.",
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
    """Return how many points a line has at least, from the wall points (n, 2), m, of each building."""
    around = sum(2 * float(np.ptp(xy, axis=0).sum()) for xy in walls.values())
    return max(_LEAST_POINTS, round(_SHORTEST * sum(map(len, walls.values())) / max(around, 1.0)))


def _min_density(lines: dict[int, list[WallLine]], width: float) -> float:
    """Return how dense (1/m²) points are in the buffer of an edge at least, from the lines of each building."""
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
