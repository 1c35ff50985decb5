"""Candidate corners of a footprint: the intersections of the lines along which its walls were looked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.line_segments import nearest_edge_distances
from .wall_edges import WallEdge
from .wall_lines import WallLine
from .wall_outline import WallOutline

# What became of a candidate corner.
CORNER = "corner"
ON_EDGE = "on an edge"
OFF_OUTLINE = "off the outline"
WALL_UNUSED = "wall not used"
ROOF_OUTLINE = "outline of the roof"
TOO_SMALL = "too small"

# Two positions nearer to each other than this (m) are one: more than rounding, less than any wall is thick.
_SAME = 1e-6

# Lines whose directions differ by less than this (sine) are parallel: lines of one direction differ by rounding only.
_PARALLEL = 1e-9


@dataclass(frozen=True)
class CandidateCorners:
    """Intersections of the lines of one building, in pairs."""

    position: np.ndarray  #: (k, 2): positions, m
    angle: np.ndarray  #: (k,): angle between the two lines, 0 to 90 degrees
    n_seen: np.ndarray  #: (k,): how many of the two lines have wall points, 0 to 2
    #: (k,): distance to the nearest wall point on each line, the larger of the two, m; NaN where a line has no points
    gap: np.ndarray
    outcome: list[str]  #: What became of each


def candidate_corners(outline: WallOutline, rejected: str = "") -> CandidateCorners:
    """Return all corners that an outline could have had.

    Parameters
    ----------
    outline : WallOutline
        An outline with the lines that it was chosen from.
    rejected : str
        Why the whole outline was not used, if it was not.

    Returns
    -------
    CandidateCorners
        Intersections of all pairs of lines in the rectangle around the roof.
    """
    first, second = np.triu_indices(len(outline.lines), 1)
    point = np.array([line.point for line in outline.lines])
    direction = np.array([line.direction for line in outline.lines])
    sine = _cross(direction[first], direction[second])
    meet = np.abs(sine) >= _PARALLEL
    first, second, sine = first[meet], second[meet], sine[meet]
    along = _cross(point[second] - point[first], direction[second]) / sine
    position = point[first] + along[:, None] * direction[first]
    near = ((position >= outline.low) & (position <= outline.high)).all(axis=1)
    first, second, sine, position = first[near], second[near], sine[near], position[near]
    gaps = np.column_stack([_gaps(outline.lines, number, position) for number in (first, second)])
    return CandidateCorners(
        position=position,
        angle=np.degrees(np.arcsin(np.minimum(np.abs(sine), 1.0))),
        n_seen=np.isfinite(gaps).sum(axis=1),
        gap=gaps.max(axis=1),
        outcome=[rejected] * len(position) if rejected else _outcomes(outline, first, second, position),
    )


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the cross products (n,) of vectors (n, 2)."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _gaps(lines: list[WallLine], number: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Return the distance along each position's line to the nearest of its points (m), NaN where it has none."""
    gaps = np.full(len(position), np.nan)
    for i in np.unique(number):
        line, own = lines[i], number == i
        if line.is_seen:
            known, at = np.sort(line.along), (position[own] - line.point) @ line.direction
            after = np.searchsorted(known, at)
            beside = known[np.clip([after - 1, after], 0, len(known) - 1)]
            gaps[own] = np.abs(beside - at).min(axis=0)
    return gaps


def _outcomes(outline: WallOutline, first: np.ndarray, second: np.ndarray, position: np.ndarray) -> list[str]:
    """Return the outcome of each position where the lines of two numbers meet."""
    edges = [edge for ring in outline.rings for edge in ring]
    starts, ends = (np.array([getattr(edge, end) for edge in edges]) for end in ("start", "end"))
    used = np.array([_carries(line, edges) for line in outline.lines])
    is_corner = np.hypot(*(position[:, None] - starts).transpose(2, 0, 1)).min(axis=1) < _SAME
    is_unused = ~(used[first] & used[second])
    on_edge = nearest_edge_distances(position, starts, ends) < _SAME
    return np.select([is_corner, is_unused, on_edge], [CORNER, WALL_UNUSED, ON_EDGE], OFF_OUTLINE).tolist()


def _carries(line: WallLine, edges: list[WallEdge]) -> bool:
    """Return whether one of the edges lies on a line."""
    return any(np.abs(line.across(np.array([edge.start, edge.end]))).max() < _SAME for edge in edges)
