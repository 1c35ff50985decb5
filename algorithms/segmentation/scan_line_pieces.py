"""Artificial scan lines: slices of a cloud in several directions, and the pieces that points near each other make."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..geometry.grid import turned_in_plan
from ..geometry.groups import components, items

# Points of a line that each point is compared with: enough to pass over a few outliers between two points of a surface.
_WINDOW = 8


@dataclass(frozen=True)
class NearPoints:
    """When two points of a line belong to one piece.

    Attributes
    ----------
    distance : float
        Largest distance in space, m.
    slope : float
        Tangent of the steepest line between them.
    step : float
        Difference in height that needs no distance: noise, m.
    """

    distance: float
    slope: float
    step: float

    def hold(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Return which points (k, 3) of a line belong to the piece of others (k, 3), m."""
        east, north, up = (other - one).T
        plan = east * east + north * north
        near = plan + up * up <= self.distance**2
        return near & (np.abs(up) <= self.step + self.slope * np.sqrt(plan)) if np.isfinite(self.slope) else near


def slices(xyz: np.ndarray, direction: float, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Cut a cloud into artificial scan lines.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    direction : float
        Direction of the lines, counterclockwise from east, degrees.
    width : float
        Width of a line, m.

    Returns
    -------
    order : ndarray of shape (n,), int64
        Points line by line, in each along the line.
    line : ndarray of shape (n,), int64
        Line of each point in this order, ascending.
    """
    along, across = turned_in_plan(xyz[:, :2], -direction).T
    line = np.floor((across - across.min()) / width).astype(np.int64)
    order = np.lexsort((xyz[:, 2], along, line))
    return order, line[order]


def pieces(
    xyz: np.ndarray, direction: float, width: float, near: NearPoints, min_points: int, obstacle: float = 0.0
) -> np.ndarray:
    """Return the piece (n,) that each point belongs to on the lines of one direction, from 0; -1 is none.

    Points of a line that are near each other, directly or through others, are a piece; it may pass over points that
    lie off it. Pieces of fewer than ``min_points`` points are none. One goes on behind an ``obstacle`` of at most that
    width (m) if the line between their ends meets the criteria of ``near`` but the distance.
    """
    order, line = slices(xyz, direction, width)
    points = xyz[order]
    links = []
    for step in range(1, min(_WINDOW, len(order) - 1) + 1):
        joined = line[step:] == line[:-step]
        joined &= near.hold(points[:-step], points[step:])
        one = np.flatnonzero(joined)
        links.append((one, one + step))
    one, other = (np.concatenate(ends) for ends in zip(*links)) if links else (np.zeros(0, int),) * 2
    count, component = components(one, other, len(order))
    large = np.bincount(component, minlength=count) >= min_points
    number = np.where(large, np.cumsum(large) - 1, -1)[component]
    if obstacle > 0:
        along = turned_in_plan(points[:, :2], -direction)[:, 0]
        # One axis for all lines, with more room between them than an obstacle is wide.
        along += line * (np.ptp(along) + 2 * obstacle)
        number = _over_obstacles(points, along, number, replace(near, distance=obstacle))
    piece = np.empty(len(order), np.int64)
    piece[order] = number
    return piece


def _over_obstacles(points: np.ndarray, along: np.ndarray, piece: np.ndarray, near: NearPoints) -> np.ndarray:
    """Return the pieces (n,) of points, joined where the end of one is near the start of another further ``along``."""
    rows = np.flatnonzero(piece >= 0)
    if not len(rows):
        return piece
    count = int(piece.max()) + 1
    first, last = np.full(count, len(piece)), np.full(count, -1)
    np.minimum.at(first, piece[rows], rows)
    np.maximum.at(last, piece[rows], rows)
    starts = np.argsort(first)
    begin = np.searchsorted(first[starts], last, side="right")
    stop = np.searchsorted(along[first[starts]], along[last] + near.distance, side="right")
    one, item = items(np.maximum(stop - begin, 0))
    other = starts[begin[one] + item]
    joined = near.hold(points[last[one]], points[first[other]])
    group = components(one[joined], other[joined], count)[1]
    return np.where(piece >= 0, group[piece], -1)


def merged_pieces(piece_sets: list[np.ndarray]) -> np.ndarray:
    """Return the segment (n,), int32, of each point: pieces (n,) of all directions are one where they share a point.

    Segments count from 0; -1 is none.
    """
    n = len(piece_sets[0])
    first, ones, others = n, [], []
    for piece in piece_sets:
        points = np.flatnonzero(piece >= 0)
        ones.append(points)
        others.append(first + piece[points])
        first += int(piece.max(initial=-1)) + 1
    component = components(np.concatenate(ones), np.concatenate(others), first)[1][:n]
    in_piece = np.zeros(n, bool)
    for points in ones:
        in_piece[points] = True
    return np.where(in_piece, component, -1).astype(np.int32)
