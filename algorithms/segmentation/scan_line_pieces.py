"""Artificial scan lines: slices of a cloud in several directions, and the pieces that points near each other make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.grid import turned_in_plan
from ..geometry.groups import components

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


def pieces(xyz: np.ndarray, direction: float, width: float, near: NearPoints, min_points: int) -> np.ndarray:
    """Return the piece (n,) that each point belongs to on the lines of one direction, from 0; -1 is none.

    Points of a line that are near each other, directly or through others, are a piece; it may pass over points that
    lie off it. Pieces of fewer than ``min_points`` points are none.
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
    number = np.where(large, np.cumsum(large) - 1, -1)
    piece = np.empty(len(order), np.int64)
    piece[order] = number[component]
    return piece


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
