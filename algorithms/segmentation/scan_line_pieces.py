"""Artificial scan lines: slices of a cloud in several directions, and the pieces that points near each other make."""

from dataclasses import dataclass, replace

import numpy as np

from ..geometry.grid import lattice, turned_in_plan
from ..geometry.groups import components, items, mask_of, ordered, placed
from ..sampling.surface_noise import LEAST_NEIGHBORS


@dataclass(frozen=True)
class NearPoints:
    """When two points of a line belong to one piece."""

    distance: float  #: Largest distance in space, m
    slope: float  #: Tangent of the steepest line between them
    step: float  #: Difference in height that is accepted at any distance in plan, as noise, m

    def hold(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Return the mask of points (k, 3) of a line that belong to the piece of others (k, 3), m."""
        east, north, up = (other - one).T
        plan = east * east + north * north
        near = plan + up * up <= self.distance**2
        return near & (np.abs(up) <= self.step + self.slope * np.sqrt(plan)) if np.isfinite(self.slope) else near


def slices(xyz: np.ndarray, direction: float, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Cut a cloud into artificial scan lines, whose middles lie at multiples of their width from zero.

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
    line = lattice(across + width / 2, width)
    line -= line.min(initial=0)
    # Put all lines one behind the other: sorting one key takes a fraction of the time of three.
    # Points at one position on a line go upward.
    order = ordered(along + line * (np.ptp(along) + 1), xyz[:, 2], across)
    return order, line[order]


def pieces(
    xyz: np.ndarray, direction: float, width: float, near: NearPoints, min_points: int, obstacle: float = 0.0
) -> np.ndarray:
    """Return the piece (n,) that each point belongs to on the lines of one direction, from 0; -1 if unassigned.

    Points of a line that are near each other, directly or through others, are a piece; it may pass over points that
    lie off it. Groups of fewer than ``min_points`` points are left out. A piece goes on behind an ``obstacle`` of at
    most that width (m) if the line between its ends on both sides meets the criteria of ``near`` but the distance.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m.
    direction : float
        Direction of the lines, °.
    width : float
        Width of a line, m.
    near : NearPoints
        When two points are near.
    min_points : int
        Fewest points of a piece.
    obstacle : float
        Width of obstacles that a piece goes on behind, m.
    """
    order, line = slices(xyz, direction, width)
    return placed(pieces_of_lines(xyz[order], line, direction, near, min_points, obstacle), order, len(order))


def pieces_of_lines(
    points: np.ndarray, line: np.ndarray, direction: float, near: NearPoints, min_points: int, obstacle: float
) -> np.ndarray:
    """Return pieces as :func:`pieces` for points (n, 3) in the order of :func:`slices`, with their lines (n,).

    Parameters
    ----------
    points : ndarray of shape (n, 3)
        Points, m, in the order of :func:`slices`.
    line : ndarray of shape (n,), int
        Their lines.
    direction : float
        Direction of the lines, °.
    near : NearPoints
        When two points are near.
    min_points : int
        Fewest points of a piece.
    obstacle : float
        Width of obstacles that a piece goes on behind, m.
    """
    number = _near_on_lines(points, line, near)
    large = np.bincount(number) >= min_points if len(number) else np.zeros(0, bool)
    number = np.where(large, np.cumsum(large) - 1, -1)[number]
    if obstacle > 0:
        along = turned_in_plan(points[:, :2], -direction)[:, 0]
        # Put all lines on one axis, farther apart than an obstacle is wide.
        along += line * (np.ptp(along) + 2 * obstacle)
        number = _over_obstacles(points, along, number, replace(near, distance=obstacle))
    return number


def _near_on_lines(points: np.ndarray, line: np.ndarray, near: NearPoints) -> np.ndarray:
    """Return a number (n,) for each point, the same where points of a line are near, directly or through others."""
    if not len(points):
        return np.zeros(0, np.int64)
    breaks = (line[1:] != line[:-1]) | ~near.hold(points[:-1], points[1:])
    # Most points are near the next one, so join such runs instead of points.
    run = np.concatenate([[0], np.cumsum(breaks)])
    ones, others = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    # Compare each point with several that follow it, as many as show a surface, so that a few outliers divide no piece.
    for step in range(2, min(LEAST_NEIGHBORS, len(points) - 1) + 1):
        first = np.flatnonzero((run[step:] != run[:-step]) & (line[step:] == line[:-step]))
        first = first[near.hold(points[first], points[first + step])]
        ones.append(run[first])
        others.append(run[first + step])
    return components(np.concatenate(ones), np.concatenate(others), int(run[-1]) + 1)[1][run]


def ends_of(rows: np.ndarray, number: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the first and the last of ascending ``rows`` (k,) of each ``number`` (k,); each of ``count`` has some."""
    first, last = np.empty((2, count), np.int64)
    # Where a number occurs more than once, the value written last remains.
    first[number[::-1]] = rows[::-1]
    last[number] = rows
    return first, last


def _over_obstacles(points: np.ndarray, along: np.ndarray, piece: np.ndarray, near: NearPoints) -> np.ndarray:
    """Return the pieces (n,) of points, joined where the end of one is near the start of another further ``along``."""
    rows = np.flatnonzero(piece >= 0)
    if not len(rows):
        return piece
    count = int(piece.max()) + 1
    first, last = ends_of(rows, piece[rows], count)
    starts = np.argsort(first)
    begin = np.searchsorted(first[starts], last, side="right")
    stop = np.searchsorted(along[first[starts]], along[last] + near.distance, side="right")
    one, item = items(np.maximum(stop - begin, 0))
    other = starts[begin[one] + item]
    joined = near.hold(points[last[one]], points[first[other]])
    return np.where(piece >= 0, components(one[joined], other[joined], count)[1][piece], -1)


def merged_pieces(piece_sets: list[np.ndarray]) -> np.ndarray:
    """Return the segment (n,), int32, of each point: pieces (n,) of all directions are one where they share a point.

    Numbers are 0 or more, not consecutive; -1 if unassigned.
    """
    n = len(piece_sets[0])
    first, ones, others = n, [], []
    for piece in piece_sets:
        points = np.flatnonzero(piece >= 0)
        ones.append(points)
        others.append(first + piece[points])
        first += int(piece.max(initial=-1)) + 1
    points = np.concatenate(ones)
    component = components(points, np.concatenate(others), first)[1][:n]
    return np.where(mask_of(n, points), component, -1).astype(np.int32)
