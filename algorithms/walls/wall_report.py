"""Numbers of points at each step from a cloud to its walls, and of the footprints and corners drawn."""

import math
from typing import Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..report.page import Row, build_page
from ..stage import Measure, Report
from .candidate_corners import CORNER

# Source of a footprint that is an outline of walls.
WALL = "wall"

# A dimension that a cloud may lack.
_Evidence = Optional[np.ndarray]

# Name and meaning of each number.
_ROWS = {
    "original_points": ("Points before thinning", "Of which the points of the cloud were made."),
    "points": ("Points", "In the cloud that footprints were made of."),
    "points_above_ground": ("Points above ground", "Neither ground nor noise."),
    "roof_points": ("Points of roofs", "In a building."),
    "wall_points": ("Points of walls", "Below the roof of a building."),
    "all_outlines": ("Footprints", "Of buildings that are large enough."),
    "wall_outlines": ("Footprints that are outlines of walls", "The others are outlines of roofs."),
    "candidates": ("Candidate corners", "Intersections of two walls of a building, seen or derived from its roof."),
    "kept_corners": (
        "Candidate corners that are corners of footprints",
        "The others lie on edges, off the outline, or on walls that no footprint has.",
    ),
}
MEASURES = tuple(Measure(name, title) for name, (title, _) in _ROWS.items())


def point_counts(
    cluster_id: np.ndarray, wall_of: _Evidence, classification: _Evidence, voxel_count: _Evidence
) -> dict[str, float]:
    """Return the number of points of each kind; NaN where evidence is missing, but 0 walls without ``wall_of``.

    Parameters
    ----------
    cluster_id : ndarray of shape (n,)
        Building of each roof point; 0 if unassigned.
    wall_of : ndarray of shape (n,), optional
        Building of each wall point; 0 if unassigned.
    classification : ndarray of shape (n,), optional
        ASPRS classes.
    voxel_count : ndarray of shape (n,), optional
        Points that each point was made of.
    """
    nan = math.nan
    left_out = (PointClass.GROUND, *NOISE)
    return {
        "original_points": nan if voxel_count is None else int(voxel_count.sum(dtype=np.int64)),
        "points": len(cluster_id),
        "points_above_ground": nan if classification is None else int((~np.isin(classification, left_out)).sum()),
        "roof_points": int((cluster_id > 0).sum()),
        "wall_points": 0 if wall_of is None else int((wall_of > 0).sum()),
    }


def wall_report(counts: dict[str, float], sources: list[str], outcomes: list[str]) -> Report:
    """Return the report of a run: ``counts`` of points, the source of each footprint and the outcome of each corner."""
    values = {
        **counts,
        "all_outlines": len(sources),
        "wall_outlines": sources.count(WALL),
        "candidates": len(outcomes),
        "kept_corners": outcomes.count(CORNER),
    }
    whole = counts["points"] if math.isnan(counts["original_points"]) else counts["original_points"]
    rows = {name: _row(name, values[name], whole) for name in _ROWS}
    points = [row for name, row in rows.items() if name in counts]
    made = [row for name, row in rows.items() if name not in counts]
    lead = (
        f"{values['wall_outlines']:,} of {values['all_outlines']:,} footprints are outlines of walls; "
        f"{values['kept_corners']:,} of {values['candidates']:,} candidate corners are corners of them."
    )
    return Report(values, build_page("From points to walls", lead, {"Points": points, "Footprints": made}, ""))


def _row(name: str, value: float, whole: float) -> Row:
    """Return the row of a number; points are also given as a share of the ``whole`` cloud."""
    title, meaning = _ROWS[name]
    if math.isnan(value):
        return Row(title, "unknown", "The cloud has no value of it.")
    share = f" {value / whole:.1%} of all points." if "points" in name and whole else ""
    return Row(title, f"{value:,}", meaning + share)
