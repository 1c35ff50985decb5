"""Straight walls in plan: lines by sequential RANSAC, with thresholds from density and noise."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..criteria import DEVIATIONS, MAJORITY
from ..geometry.principal_axes import principal_axes
from ..geometry.tin import PLANE_POINTS
from ..neighborhoods.covariance import Shapes, Within, reduce_neighborhoods
from ..stage import Monitor

# RANSAC samples for each line: of a wall with a tenth of the points, one pair in a hundred lies on it.
TRIALS = 500

# Most points that hypotheses are scored on: a sample of as many ranks them as all do.
SCORED = 1500

# RANSAC samples two points at least this far apart (m); closer pairs give random directions.
LEAST_PAIR = 0.5

# A wall continues across a gap up to this length (m): bushes, cars and holes.
_GAP = 1.5

# Mean number of points in a bin of a wall: with as many, one bin in twenty is empty by chance.
_POINTS_PER_BIN = 3.0

# Lines closer in direction than this (radians) are parallel: walls are built no straighter.
_BUILT = np.deg2rad(0.7)

# Lines farther apart in direction than this (radians) are never parallel, however uncertain; within it a wall and a
# side of a roof are.
MOST = np.deg2rad(8.0)

# Points are rougher than noise if their variance about the line exceeds the noise's by this many standard errors.
_CERTAIN = 2.0

# Parallel lines within this distance (m) are one wall, and the edge of a roof is as uneven.
SAME_WALL = 0.3

# Radius (m) of the neighborhoods that show the direction of a wall at a point.
_AROUND = 0.6

# Least length of such a neighborhood (times its width).
_LONGER = 2.0

# Cosine of the largest angle between the direction at a point and its wall: at bushes and corners any angle occurs.
_ALONG = np.cos(np.deg2rad(30.0))

# Two lines are one wall if one line fits the points of both within this deviation (times the tolerance).
_ONE_WALL = 0.45


@dataclass(frozen=True)
class WallLine:
    """A straight wall in plan."""

    point: np.ndarray  #: (2,): middle of its points, m
    direction: np.ndarray  #: (2,): unit vector
    points: np.ndarray  #: (k,): numbers of the wall points on it; none where it was derived from the roof
    along: np.ndarray  #: (k,): where these lie along the direction from the middle, m
    deviation: float  #: Standard deviation of the points across the line, m
    #: Whether a side of the roof runs as far outside of it as the roof juts out over the other walls
    expected: bool = False

    @property
    def normal(self) -> np.ndarray:
        """Unit vector across, to the left."""
        return np.array([-self.direction[1], self.direction[0]])

    @property
    def is_seen(self) -> bool:
        """Whether it has wall points."""
        return len(self.points) > 0

    def excess(self, noise: float) -> float:
        """Return the deviation (m) that remains when the part due to noise of a standard deviation (m) is removed."""
        chance = 1 + _CERTAIN * np.sqrt(2 / max(len(self.points), 1))
        return float(np.sqrt(max(self.deviation**2 - chance * noise**2, 0.0)))

    @property
    def angle_deviation(self) -> float:
        """Standard deviation of the direction (radians), if deviations of the points are independent of each other."""
        spread = float(np.sqrt(np.sum(self.along**2)))
        return self.deviation / spread if spread > 0 else np.inf

    def angle_excess(self, noise: float) -> float:
        """Return the standard deviation of the direction (radians) due to the deviation beyond ``noise`` (m).

        It does not average out: a bush at one end of a wall turns it, however many points the wall has.
        """
        spread = float(np.sqrt(np.mean(self.along**2))) if self.is_seen else 0.0
        return self.excess(noise) / spread if spread > 0 else np.inf

    def across(self, xy: np.ndarray) -> np.ndarray:
        """Return the distances (m) of points (n, 2) to the left of the line."""
        return (xy - self.point) @ self.normal

    def turned(self, direction: np.ndarray, xy: np.ndarray) -> WallLine:
        """Return the line through the same middle in another direction."""
        if direction @ self.direction < 0:
            direction = -direction
        turned = replace(self, direction=direction)
        if not self.is_seen:
            return turned
        offsets = xy[self.points] - self.point
        deviation = float(np.sqrt(np.mean((offsets @ turned.normal) ** 2)))
        return replace(turned, along=offsets @ direction, deviation=deviation)

    def centered(self, xy: np.ndarray) -> WallLine:
        """Move the line across to the median of its points, which is robust to a few points of something else."""
        return replace(self, point=self.point + float(np.median(self.across(xy[self.points]))) * self.normal)


@dataclass(frozen=True)
class Scale:
    """Scale of a building's walls: tolerance of points about a line (m), and width of a bin (m) with several points."""

    tolerance: float
    bin: float

    def covered(self, along: np.ndarray, start: float, end: float) -> float:
        """Return the share of the stretch from ``start`` to ``end`` (m) whose bins hold points at ``along``."""
        count = max(1, int(np.ceil((end - start) / self.bin)))
        inside = along[(along >= start) & (along < end)]
        return np.count_nonzero(np.bincount(((inside - start) / (end - start) * count).astype(np.int64))) / count

    def seen_until(self, along: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Return the length (n,) (m) of the bins with points at ``along`` before each of ``ends`` (n,) (m)."""
        if not len(along):
            return np.zeros(len(ends))
        starts = np.unique(np.floor(along / self.bin)) * self.bin
        begun = np.searchsorted(starts, ends, side="right")
        last = starts[np.maximum(begun - 1, 0)]
        return np.where(begun > 0, (begun - 1) * self.bin + np.clip(ends - last, 0.0, self.bin), 0.0)


def wall_scale(n_points: int, perimeter: float, tolerance: float) -> Scale:
    """Return the scale of ``n_points`` on walls of a length ``perimeter`` (m) in all, with bins of 0.2 to 1 m."""
    return Scale(tolerance, float(np.clip(_POINTS_PER_BIN * perimeter / max(n_points, 1), 0.2, 1.0)))


def find_lines(
    xy: np.ndarray, scale: Scale, min_length: float, rng: np.random.Generator, monitor: Monitor
) -> list[WallLine]:
    """Return the walls among points in plan, longest first, about.

    Parameters
    ----------
    xy : ndarray of shape (n, 2)
        Wall points near the origin (m), in any order.
    scale : Scale
        Tolerance and bins.
    min_length : float
        Shortest wall, m.
    rng : Generator
        Random numbers.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    list of WallLine
        Lines through at least the minimum length of wall, most of it covered by points.
    """
    lines: list[WallLine] = []
    ways = _ways(xy, monitor.part(0.0, 0.3))
    left = np.flatnonzero(ways.any(axis=1))
    least = max(6, int(min_length / scale.bin))
    while len(left) >= least:
        line = _best_line(xy, ways, left, scale, rng)
        if line is None or len(line.points) < least:
            break
        start, end = line.along.min(), line.along.max()
        # A line is a wall where at least half of it has points.
        if end - start < min_length or scale.covered(line.along, start, end) < MAJORITY:
            break
        lines.append(line)
        left = left[~np.isin(left, line.points)]
        monitor.progress(1 - 0.7 * len(left) / len(xy))
    return lines


def _ways(xy: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return the main direction (n, 2) of the points around each point as a unit vector; 0 without a clear one."""
    ways = np.empty((len(xy), 2))

    def keep(rows: np.ndarray, shapes: Shapes) -> None:
        x, y, _, xy_, _, _ = shapes.covariances.T
        # Half the angle of (x - y, 2 xy) is the direction of the larger eigenvector.
        angle, apart = np.arctan2(2 * xy_, x - y) / 2, np.hypot(x - y, 2 * xy_)
        is_line = (shapes.counts >= PLANE_POINTS) & (x + y + apart >= _LONGER**2 * (x + y - apart))
        ways[rows] = np.column_stack([np.cos(angle), np.sin(angle)]) * is_line[:, None]

    reduce_neighborhoods(np.column_stack([xy, np.zeros(len(xy))]), Within(_AROUND), keep, monitor=monitor)
    return ways


def _best_line(
    xy: np.ndarray, ways: np.ndarray, left: np.ndarray, scale: Scale, rng: np.random.Generator
) -> Optional[WallLine]:
    """Return the line that covers the longest stretch of wall, fitted to its points; None without any."""
    scored = left if len(left) <= SCORED else np.sort(rng.choice(left, SCORED, replace=False))
    pair = xy[left[rng.integers(0, len(left), (TRIALS, 2))]]
    step = pair[:, 1] - pair[:, 0]
    length = np.hypot(*step.T)
    pair, step, length = (values[length >= LEAST_PAIR] for values in (pair, step, length))
    if not len(pair):
        return None
    directions = step / length[:, None]
    stretch = _lengths(xy[scored], ways[scored], pair[:, 0], directions, scale)
    best = int(np.argmax(stretch))
    return _fitted(xy, ways, left, pair[best, 0], directions[best], scale)


def _lengths(xy: np.ndarray, ways: np.ndarray, starts: np.ndarray, directions: np.ndarray, scale: Scale) -> np.ndarray:
    """Return for each line how many bins of its longest stretch hold points; a stretch goes on over small gaps."""
    normals = np.column_stack([-directions[:, 1], directions[:, 0]])
    across = normals @ xy.T - np.einsum("ij,ij->i", normals, starts)[:, None]
    line, point = np.nonzero(np.abs(across) <= scale.tolerance)
    runs_along = np.abs(np.einsum("ij,ij->i", directions[line], ways[point])) >= _ALONG
    line, point = line[runs_along], point[runs_along]
    along, least = np.einsum("ij,ij->i", directions[line], xy[point]), (directions @ xy.T).min()
    # Rounding may make this slightly negative.
    bins = np.maximum(np.floor((along - least) / scale.bin).astype(np.int64), 0)
    count = int(bins.max(initial=0)) + 1
    line, column = np.divmod(np.flatnonzero(np.bincount(line * count + bins)), count)
    is_new = np.ones(len(line), bool)
    is_new[1:] = (np.diff(line) > 0) | (np.diff(column) > round(_GAP / scale.bin) + 1)
    runs = np.flatnonzero(is_new)
    best = np.zeros(len(starts), np.int64)
    np.maximum.at(best, line[runs], np.diff(runs, append=len(line)))
    return best


def _fitted(
    xy: np.ndarray, ways: np.ndarray, left: np.ndarray, point: np.ndarray, direction: np.ndarray, scale: Scale
) -> Optional[WallLine]:
    """Fit a line by total least squares to the longest stretch of points near a line."""
    line = None
    for _ in range(4):
        offsets = xy[left] - point
        along, across = offsets @ direction, offsets @ [-direction[1], direction[0]]
        near = np.flatnonzero((np.abs(across) <= scale.tolerance) & (np.abs(ways[left] @ direction) >= _ALONG))
        near = near[_longest_run(along[near])]
        if len(near) < 3:
            return None
        line = fit_line(xy, left[near])
        point, direction = line.point, line.direction
    return line


def _longest_run(along: np.ndarray) -> np.ndarray:
    """Return the positions of the points of the longest stretch without a gap."""
    order = np.argsort(along, kind="stable")
    parts = np.split(order, np.flatnonzero(np.diff(along[order]) > _GAP) + 1)
    return max(parts, key=lambda part: np.ptp(along[part]) if len(part) else -1.0)


def fit_line(xy: np.ndarray, points: np.ndarray) -> WallLine:
    """Fit a line to points by total least squares."""
    middle, variances, axes = principal_axes(xy[points])
    direction = axes[:, 1]
    return WallLine(middle, direction, points, (xy[points] - middle) @ direction, float(np.sqrt(variances[0])))


def merge_lines(lines: list[WallLine], xy: np.ndarray, scale: Scale) -> list[WallLine]:
    """Join lines that are one wall: collinear pieces next to a gap, and doubles side by side."""
    merged: list[WallLine] = []
    for line in sorted(lines, key=lambda line: -np.ptp(line.along)):
        for i, other in enumerate(merged):
            if abs(other.direction @ line.direction) <= np.cos(2 * MOST):
                continue
            both = fit_line(xy, np.union1d(other.points, line.points))
            if both.deviation <= _ONE_WALL * scale.tolerance:
                merged[i] = both
                break
        else:
            merged.append(line)
    return merged


def square_up(lines: list[WallLine], xy: np.ndarray) -> list[WallLine]:
    """Make lines parallel or square to each other where their points allow it; others keep their direction.

    Each group of such lines gets the mean of their directions, weighted by their precision. Where the points of a line
    deviate by more than the median deviation, its direction and its position across are less certain.
    """
    if not lines:
        return []
    result = list(lines)
    noise = float(np.median(np.repeat([line.deviation for line in lines], [len(line.points) for line in lines])))
    # Standard deviations of the directions, without and with what exceeds the noise.
    angles = np.array([np.arctan2(line.direction[1], line.direction[0]) for line in lines])
    sure = np.array([np.hypot(line.angle_deviation, _BUILT / DEVIATIONS) for line in lines])
    unsure = np.hypot(sure, [line.angle_excess(noise) for line in lines])
    open_lines = list(np.argsort(sure, kind="stable"))
    while open_lines:
        first = open_lines[0]
        apart = np.abs(np.angle(np.exp(4j * (angles[open_lines] - angles[first]))) / 4)
        limits = (DEVIATIONS * np.hypot(own[open_lines], own[first]) for own in (sure, unsure))
        is_sure, may_be = (apart <= np.minimum(limit, MOST) for limit in limits)
        group = [i for i, near in zip(open_lines, may_be) if near]
        deviations = np.where(is_sure, sure[open_lines], unsure[open_lines])[may_be]
        mean = np.angle(np.sum(np.exp(4j * angles[group]) / deviations**2)) / 4
        for i, keeps in zip(group, is_sure[may_be]):
            angle = mean + np.round((angles[i] - mean) / (np.pi / 2)) * np.pi / 2
            turned = lines[i].turned(np.array([np.cos(angle), np.sin(angle)]), xy)
            result[i] = turned if keeps else turned.centered(xy)
        open_lines = [i for i in open_lines if i not in group]
    return result
