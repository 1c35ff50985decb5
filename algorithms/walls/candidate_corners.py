"""Candidate corners of a footprint: the intersections of the lines along which its walls were looked for."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..criteria import MICROMETER
from ..packages import spatial
from ..stage import Field
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

CORNER_FIELDS = (
    Field("id", int, "number of the candidate, from 1"),
    Field("cluster_id", int, "building that it belongs to"),
    Field(
        "outcome",
        str,
        "'corner': of the footprint. 'on an edge': the footprint runs straight on. 'off the outline': both walls have "
        "edges elsewhere. 'wall not used': one of them has no edge. 'outline of the roof': too few walls were seen. "
        "'too small': the footprint would be too small",
    ),
    Field("walls_seen", int, "how many of the two walls that meet in it have wall points, 0 to 2"),
    Field("angle", float, "angle between the two walls, 0 to 90", "°"),
    Field("gap", float, "distance to the nearest point on each of the walls, the larger of the two", "m"),
)


def candidate_corners(
    outline: WallOutline, rings: list[list[WallEdge]], is_used: bool
) -> Iterator[tuple[np.ndarray, dict[str, Any]]]:
    """Yield the crossings (m) of all pairs of a building's lines in the rectangle around its roof, with attributes.

    The footprint has the ``rings`` of its outline, none where it is too small, if the outline is used at all.
    """
    lines, (first, second) = outline.cells.lines, outline.cells.arrangement.crossing.T
    position = outline.cells.arrangement.positions[: len(first)]
    gap = np.maximum(_gaps(lines, first, position), _gaps(lines, second, position)).tolist()
    sine = [abs(float(lines[i].normal @ lines[j].direction)) for i, j in zip(first, second)]
    angle = np.degrees(np.arcsin(np.minimum(sine, 1.0))).tolist()
    is_seen = np.array([line.is_seen for line in lines], int)
    outcome = [TOO_SMALL if is_used else ROOF_OUTLINE] * len(position)
    if is_used and rings:
        outcome = _outcomes(outline, rings, position)
    for at, *facts in zip(position, outcome, (is_seen[first] + is_seen[second]).tolist(), angle, gap):
        yield at, dict(zip(("outcome", "walls_seen", "angle", "gap"), facts))


def _outcomes(outline: WallOutline, rings: list[list[WallEdge]], position: np.ndarray) -> list[str]:
    """Return the outcome of each position where two lines cross."""
    cells, inside = outline.cells, outline.inside
    is_kept = spatial.cKDTree([edge.start for ring in rings for edge in ring]).query(position)[0] < MICROMETER
    is_unused = ~cells.is_used(inside)[cells.arrangement.crossing].all(axis=1)
    around = inside[cells.arrangement.around]
    is_on = around.any(axis=1) & ~around.all(axis=1)
    outcomes = CORNER, WALL_UNUSED, TOO_SMALL, ON_EDGE
    return np.select([is_kept, is_unused, cells.corners(inside) > 0, is_on], outcomes, OFF_OUTLINE).tolist()


def _gaps(lines: list[WallLine], number: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Return the distance (m) from each position to the nearest point on its line, NaN for a line without points."""
    gaps = np.full(len(position), np.nan)
    for i in np.unique(number):
        line, own = lines[i], number == i
        if line.is_seen:
            along = (position[own] - line.point) @ line.direction
            gaps[own] = spatial.cKDTree(line.along[:, None]).query(along[:, None])[0]
    return gaps
