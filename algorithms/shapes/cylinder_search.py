"""The search for cylinders: seeds in windows by the Gaussian sphere and a circle transform, grown along their axes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Optional

import numpy as np

from ..criteria import GAP_SPACINGS, MAJORITY
from ..geometry.polygons import axes_across
from ..neighborhoods.covariance import symmetric_eigenvalues
from ..neighborhoods.nearest_blocks import PAIRS
from ..stage import Monitor
from .cylinder_evidence import FACING, MOST_LOOKED_AT, CylinderEvidence, Points, facing
from .cylinder_fits import LEAST_POINTS, Cylinder, fit_cylinder, upward
from .hough_planes import PlaneDirections
from .search_settings import ARC_DEVIATIONS
from .searched_points import MeasuredPoints
from .shape_windows import BEYOND_LEVEL, CENTER_BIN, RADII_OF_LEVEL, THINNING, WINDOW, Level, level_of, levels

# Width of a bin of the Gaussian sphere, as a slope: 8°, about three times the error of a normal.
_DIRECTION_BIN = 0.14

# Largest angle (°) between a normal and a great circle while the circle is searched for: a bin and half a bin.
_ON_CIRCLE = 12.0

# Sine of the largest angle between a normal and a great circle that is fitted to normals: 15°, as the direction that
# the fit begins with is off by up to half a bin.
_SINE_ON_FITTED = float(np.sin(np.radians(15.0)))

# Fewest bins that the normals of a cylinder fill along their great circle: the faces of a box fill three.
_LEAST_BINS = 5

# Least second eigenvalue of the mean product of the normals of a window: (4°)². Normals of planes, with an error of 3°,
# have less; a cylinder with 72° seen has 0.12, and 0.006 if it holds a twentieth of the points of a window.
_LEAST_SPREAD = 0.005

# Cylinders of one level may be thinner than its least radius and wider than its largest by this factor, so that those
# between two levels are found in one of them.
_WIDER = 1.1

# Rounds of each fit of a seed; it need not converge, as its points change afterwards.
_SEED_ROUNDS = 2

# Most seeds of one window, which is as wide as two of the thinnest cylinders of its level or one of the widest.
_MOST_IN_WINDOW = 4

# Widest gap along a cylinder (radii): the shadow of another pipe.
_GAP_RADII = 2.0


@lru_cache(maxsize=64)
def _radii(low: float, high: float) -> np.ndarray:
    """Return the radii (m) that are tried in a level."""
    return np.geomspace(low, high, RADII_OF_LEVEL)


@dataclass(frozen=True)
class Found:
    """A cylinder with ends."""

    cylinder: Cylinder  #: Its axis and radius; the ends lie at ``low`` and ``high`` (m) along the axis from its center
    low: float
    high: float
    points: np.ndarray  #: (k,): points on it
    rms: float  #: Root mean square distance of the points from it, m
    seen: float  #: Share of the circumference that has points

    @property
    def ends(self) -> np.ndarray:
        """The ends of the axis (2, 3), m."""
        return self.cylinder.center + np.outer([self.low, self.high], self.cylinder.axis)

    def moved(self, x: float) -> Found:
        """Return the cylinder moved along x (m)."""
        return replace(self, cylinder=replace(self.cylinder, center=self.cylinder.center + [x, 0.0, 0.0]))


class CylinderSearch:
    """Cylinders among points with normals.

    Parameters
    ----------
    measured : MeasuredPoints
        The points.
    min_seen : float
        Least share of the circumference with points.
    min_points : int
        Points of the smallest cylinder.
    """

    def __init__(self, measured: MeasuredPoints, min_seen: float, min_points: int) -> None:
        self.xyz, self.normals, self.shift = measured.xyz, measured.normals, measured.shift
        self.noise, self.tolerance, self.spacing = measured.noise, measured.tolerance, measured.spacing
        self.min_seen, self.min_points = min_seen, min_points
        # Segments are searched apart; the surroundings of a cylinder, and other pieces of it, lie in several.
        positions = self.xyz - np.column_stack([self.shift, np.zeros((len(self.shift), 2))])
        self.evidence = CylinderEvidence(self.noise, self.tolerance, self.spacing, positions)
        self.is_free = self.normals.any(axis=1)
        self.directions = PlaneDirections(_DIRECTION_BIN)
        self.bins = self.directions.bin_of(np.where(self.is_free[:, None], self.normals, [0.0, 0.0, 1.0]))
        # For each bin, the mask of bins on the great circle across its middle.
        cosine = np.abs(self.directions.normal @ self.directions.normal.T)
        self.on_circle = (cosine <= np.sin(np.radians(_ON_CIRCLE))).astype(np.float32)

    def find(self, min_radius: float, max_radius: float, monitor: Monitor) -> list[Found]:
        """Return the cylinders with radii (m) in a range, the smallest first."""
        found: list[Found] = []
        ranges = levels(min_radius, max_radius)
        for (low, high), part in zip(ranges, monitor.parts(len(ranges))):
            level = level_of(self.xyz, self.is_free, low, high, LEAST_POINTS)
            windows = [level.windows[n] for n in np.flatnonzero(self._is_curved(level))]
            for number, window in enumerate(windows):
                part.progress(number / len(windows))
                found += self._in_window(level.rows, window, low, high)
        monitor.progress(1.0)
        return found

    def _is_curved(self, level: Level) -> np.ndarray:
        """Return whether the normals of each window spread more than on a plane."""
        if not level.windows:
            return np.zeros(0, bool)
        starts = np.cumsum([0, *(len(window) for window in level.windows)])
        spread = np.empty((len(level.windows), 6))
        for column, (a, b) in enumerate(PAIRS):
            product = (self.normals[level.rows, a] * self.normals[level.rows, b])[np.concatenate(level.windows)]
            spread[:, column] = np.add.reduceat(product, starts[:-1]) / np.diff(starts)
        return symmetric_eigenvalues(spread)[:, 1] >= _LEAST_SPREAD

    def _in_window(self, rows: np.ndarray, window: np.ndarray, low: float, high: float) -> list[Found]:
        """Return the cylinders that have a seed in a window, and take their points."""
        found: list[Found] = []
        left = rows[window]
        for _ in range(_MOST_IN_WINDOW):
            left = left[self.is_free[left]]
            seed = self._seed(left, low, high) if len(left) >= LEAST_POINTS else None
            if seed is None:
                break
            cylinder, points = seed
            one = self._grown(rows, cylinder, points)
            if one is not None and low / _WIDER <= one.cylinder.radius <= high * _WIDER:
                self.is_free[one.points] = False
                found.append(one)
            # Don't try a seed without a cylinder twice.
            left = left[~np.isin(left, points)]
        return found

    def _seed(self, rows: np.ndarray, low: float, high: float) -> Optional[tuple[Cylinder, np.ndarray]]:
        """Return the best cylinder of the points of a window, and which points lie on it."""
        normals = self.normals[rows]
        axis = self._axis(normals, self.bins[rows])
        if axis is None:
            return None
        on_circle = rows[np.abs(normals @ axis) <= _SINE_ON_FITTED]
        if len(on_circle) < LEAST_POINTS:
            return None
        cylinder = self._circle(on_circle, axis, low, high)
        for reach in (CENTER_BIN * low, 2 * self.tolerance, self.tolerance):
            points = on_circle[self._is_on(on_circle, cylinder, max(reach, self.tolerance))]
            if len(points) < LEAST_POINTS:
                return None
            cylinder = self._fitted(points, cylinder, _SEED_ROUNDS)
            if not low / BEYOND_LEVEL <= cylinder.radius <= high * BEYOND_LEVEL:
                return None
        if not low / _WIDER <= cylinder.radius <= high * _WIDER:
            # It belongs to another level and is found in that one's windows; each window here would grow it again.
            return None
        return (cylinder, points) if self._is_round(rows, points, cylinder) else None

    def _fitted(self, points: np.ndarray, cylinder: Cylinder, *rounds: int) -> Cylinder:
        """Return the least-squares cylinder of points, from a start; as :func:`.fit_cylinder` takes ``rounds``."""
        return fit_cylinder(self.xyz[points[:: len(points) // MOST_LOOKED_AT + 1]], cylinder, *rounds)

    def _is_round(self, near: np.ndarray, points: np.ndarray, cylinder: Cylinder) -> bool:
        """Return whether ``points`` look like a cylinder among the points ``near`` it."""
        own, all_near = (Points(self.xyz[rows], self.normals[rows]) for rows in (points, near))
        return self.evidence.is_round(cylinder, own, all_near)

    def _axis(self, normals: np.ndarray, bins: np.ndarray) -> Optional[np.ndarray]:
        """Return the normal of the great circle near most normals (k, 3), in bins (k,); None if they fill too few."""
        every = np.bincount(bins, minlength=len(self.directions))
        occupied = np.flatnonzero(every)
        count = every[occupied]
        # Of twenty normals and more, a bin with one counts as noise.
        is_common = count >= min(2, len(bins) // 20 + 1)
        # Bins count alike, so that a plane does not decide the direction of the circle.
        filled = self.on_circle[occupied[is_common]].sum(axis=0)
        best = int(np.argmax(filled))
        if filled[best] < _LEAST_BINS:
            return None
        axis = self.directions.normal[best]
        for _ in range(2):
            is_near = np.abs(normals @ axis) <= _SINE_ON_FITTED
            near, own = normals[is_near], bins[is_near]
            share = 1 / np.bincount(own, minlength=len(self.directions))[own]
            axis = np.linalg.eigh((near * share[:, None]).T @ near)[1][:, 0]
        return upward(axis)

    def _circle(self, rows: np.ndarray, axis: np.ndarray, low: float, high: float) -> Cylinder:
        """Return the circle across an axis for which most points vote: each along its normal, to both sides."""
        first, second = axes_across(axis)
        middle = self.xyz[rows].mean(axis=0)
        positions = np.column_stack([(self.xyz[rows] - middle) @ first, (self.xyz[rows] - middle) @ second])
        toward = np.column_stack([self.normals[rows] @ first, self.normals[rows] @ second])
        toward /= np.maximum(np.linalg.norm(toward, axis=1), 1e-12)[:, None]
        radii = _radii(low, high)
        signed = np.concatenate([radii, -radii])
        cell, reach = CENTER_BIN * low, WINDOW * low / 2 + _WIDER * high
        side = int(np.ceil(2 * reach / cell)) + 2
        number = np.tile(np.arange(RADII_OF_LEVEL), 2)
        index = [
            np.floor((position + signed * way + reach) / cell).astype(np.int64)
            for position, way in ((positions[:, k, None], toward[:, k, None]) for k in (0, 1))
        ]
        inside = (index[0] >= 0) & (index[0] < side) & (index[1] >= 0) & (index[1] < side)
        key = (number * side + index[0]) * side + index[1]
        votes = np.bincount(key[inside], minlength=RADII_OF_LEVEL * side * side).reshape(RADII_OF_LEVEL, side, side)
        votes = votes[:, 1:] + votes[:, :-1]
        votes = votes[:, :, 1:] + votes[:, :, :-1]
        radius, i, j = np.unravel_index(int(np.argmax(votes)), votes.shape)
        x, y = (i + 1) * cell - reach, (j + 1) * cell - reach
        return Cylinder(middle + x * first + y * second, axis, float(radii[radius]))

    def _is_on(self, rows: np.ndarray, cylinder: Cylinder, tolerance: float) -> np.ndarray:
        """Return the mask of points ``rows`` on an endless cylinder that face away from its axis or to it."""
        _, distance, away = cylinder.local(self.xyz[rows])
        return (np.abs(distance - cylinder.radius) <= tolerance) & (facing(away, self.normals[rows]) >= FACING)

    def _grown(self, rows: np.ndarray, cylinder: Cylinder, seed: np.ndarray) -> Optional[Found]:
        """Return the cylinder that a seed grows to along its axis, None if its points do not fit a cylinder."""
        along = cylinder.local(self.xyz[seed])[0]
        ends = cylinder.center + np.outer([along.min(), along.max()], cylinder.axis)
        thinned_spacing = max(self.spacing, THINNING * cylinder.radius)
        gap = max(_GAP_RADII * cylinder.radius, GAP_SPACINGS * self.spacing)
        # The axis is accurate enough for its own length at both ends.
        step = float(np.linalg.norm(ends[1] - ends[0]))
        while True:
            near = self._near(rows, ends, cylinder, step)
            points = self._run(near, cylinder, ends.mean(axis=0), gap)
            if len(points) < LEAST_POINTS:
                return None
            fitted = self._fitted(points, cylinder)
            along = fitted.local(self.xyz[points])[0]
            grown = fitted.center + np.outer([along.min(), along.max()], fitted.axis)
            longer = np.linalg.norm(grown[1] - grown[0]) - np.linalg.norm(ends[1] - ends[0])
            cylinder, ends = fitted, grown
            if longer < thinned_spacing:
                break
            # A longer cylinder has a better known direction, so the step may grow.
            step = 2 * step if longer >= step else step
        return self._checked(cylinder, ends, gap)

    def _near(self, rows: np.ndarray, ends: np.ndarray, cylinder: Cylinder, more: float) -> np.ndarray:
        """Return the free points of ``rows`` in the box around an axis, ``more`` (m) longer at both ends."""
        reach = cylinder.radius + 2 * self.tolerance
        longer = np.array([ends[0] - more * cylinder.axis, ends[1] + more * cylinder.axis])
        low, high = longer.min(axis=0) - reach, longer.max(axis=0) + reach
        # Points are sorted by elevation.
        first, last = np.searchsorted(self.xyz[:, 2], [low[2], high[2]])
        rows = rows[np.searchsorted(rows, first) : np.searchsorted(rows, last)]
        for axis in (0, 1):
            rows = rows[(self.xyz[rows, axis] >= low[axis]) & (self.xyz[rows, axis] <= high[axis])]
        return rows[self.is_free[rows]]

    def _run(self, near: np.ndarray, cylinder: Cylinder, middle: np.ndarray, gap: float) -> np.ndarray:
        """Return the points on a cylinder that follow each other along its axis without a gap, around the middle."""
        points = near[self._is_on(near, cylinder, self.tolerance)]
        along = cylinder.local(self.xyz[points])[0]
        order = np.argsort(along, kind="stable")
        run = np.concatenate([[0], np.cumsum(np.diff(along[order]) > gap)]).astype(np.int64)
        if not len(points):
            return points
        at = float((middle - cylinder.center) @ cylinder.axis)
        return np.sort(points[order[run == run[np.argmin(np.abs(along[order] - at))]]])

    def _checked(self, cylinder: Cylinder, ends: np.ndarray, gap: float) -> Optional[Found]:
        """Return the cylinder with all its points if these look like one."""
        near = self._near(np.arange(len(self.xyz)), ends, cylinder, 0.5 * cylinder.radius)
        points = self._run(near, cylinder, ends.mean(axis=0), gap)
        if len(points) < self.min_points:
            return None
        cylinder = fit_cylinder(self.xyz[points], cylinder)
        points = self._run(near, cylinder, ends.mean(axis=0), gap)
        along, distance, away = cylinder.local(self.xyz[points])
        if len(points) < self.min_points or not self.evidence.is_long(along, cylinder):
            return None
        seen, filled = self.evidence.coverage(along, cylinder.angle(away), cylinder)
        sagitta = cylinder.radius * (1 - np.cos(np.pi * min(seen, 0.5)))
        # Half of the cells of its surface hold points at least, and a flatter arc is a plane.
        if seen < self.min_seen or filled < MAJORITY or sagitta < ARC_DEVIATIONS * self.noise:
            return None
        rms = float(np.sqrt(((distance - cylinder.radius) ** 2).mean()))
        one = Found(cylinder, float(along.min()), float(along.max()), points, rms, seen)
        if not self._is_round(near, points, cylinder):
            return None
        return None if self.evidence.goes_on(one.moved(-self.shift[points[0]]).cylinder, along) else one
