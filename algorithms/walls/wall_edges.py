"""The edges of a wall outline: each on a line of wall points, with the points seen along it."""

from dataclasses import dataclass

import numpy as np

from .wall_lines import Scale, WallLine

# Length (m) at both ends of an edge that its quality leaves out, as corners are rounded.
_CORNER = 0.4

# Largest such length, as a share of the edge.
_CORNER_SHARE = 0.25


@dataclass(frozen=True)
class WallEdge:
    """One edge of a footprint."""

    #: start, end, (2,): its corners, m
    start: np.ndarray
    end: np.ndarray
    quality: float  #: Share of it that has wall points, corners left out, 0 to 1
    points: int  #: Wall points on it
    deviation: float  #: Standard deviation of these across it, m; NaN without any
    precision: float  #: Standard deviation of its own position across, m; NaN without points


def closed(ring: list[WallEdge]) -> np.ndarray:
    """Return the corners of a ring, closed (m, 2)."""
    return np.array([edge.start for edge in ring] + [ring[0].start])


def points_near(walls: np.ndarray, line: WallLine, scale: Scale) -> np.ndarray:
    """Return along and across (k, 2) of all wall points near a line (m)."""
    if not line.is_seen:
        return np.zeros((0, 2))
    across = line.across(walls)
    chosen = np.abs(across) <= scale.tolerance
    return np.column_stack([(walls[chosen] - line.point) @ line.direction, across[chosen]])


def edge_between(start: np.ndarray, end: np.ndarray, line: WallLine, near: np.ndarray, scale: Scale) -> WallEdge:
    """Return an edge between two corners (2,), m, on a line, with the evidence of the points near it.

    Parameters
    ----------
    start, end : ndarray of shape (2,)
        Its corners, m.
    line : WallLine
        Line of the wall.
    near : ndarray of shape (k, 2)
        Positions of points along and across the line, m.
    scale : Scale
        Spacing and noise.
    """
    low, high = sorted([float((start - line.point) @ line.direction), float((end - line.point) @ line.direction)])
    corner = min(_CORNER, _CORNER_SHARE * (high - low))
    low, high = low + corner, high - corner
    between = near[(near[:, 0] >= low) & (near[:, 0] < high)]
    quality = scale.covered(between[:, 0], low, high) if len(between) else 0.0
    deviation = float(np.sqrt(np.mean(between[:, 1] ** 2))) if len(between) else np.nan
    precision = deviation / np.sqrt(len(between)) if len(between) else np.nan
    return WallEdge(start, end, quality, len(between), deviation, precision)
