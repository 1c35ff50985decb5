"""The search for cylinders: seeds in windows by the Gaussian sphere and a circle transform, grown along their axes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..stage import Monitor
from .cylinder_fits import SECTORS, Cylinder, across_axis, bends, fit_cylinder, upward
from .hough_planes import PlaneDirections
from .shape_windows import WINDOW, level_of, levels

# Bins of directions on the Gaussian sphere (slope): 8°.
_DIRECTION_BIN = 0.14

# Normals that are of one great circle lie at most so far from it (°), while it is looked for and when it is fitted.
_ON_CIRCLE, _ON_FITTED_CIRCLE = 12.0, 15.0

# Bins of the Gaussian sphere that a great circle must fill: three would be the faces of a box.
_LEAST_BINS = 5

# Each bin counts at most this share of the normals, so that one plane doesn't decide the direction.
_MOST_IN_BIN = 1 / 16

# Bins of radii in one level, and side of the bins of centers (times the least radius).
_RADII, _CENTER_BIN = 8, 0.15

# Distances from the circle (times the least radius) at which a start is fitted again, before the tolerance counts.
_FIRST_FITS = (0.15, 0.06)

# Angle (°) between the normal of a point and the direction away from the axis.
_NORMAL_ANGLE = 30.0

# Points of a seed, and of a window in which one is looked for.
LEAST_POINTS = 16

# Cylinders of one window.
_MOST_IN_WINDOW = 4

# First step along the axis of a growing cylinder at both ends (radii): the direction of a seed is known for so long.
_FIRST_STEP = 6.0

# Widest gap along a cylinder (radii, spacings): another pipe in front of it, or chance.
_GAP_RADII, _GAP_SPACINGS = 2.0, 6.0

# Length of the shortest cylinder: diameters, but no more than so much (m), and of wide ones diameters.
_LENGTH, _LONG_ENOUGH, _SHORT = 1.5, 1.0, 0.3

# Largest deviation of the points (times the noise), and of what bends, cones and faces explain of it.
_MOST_ROUGH, _MOST_BENT = 1.25, 0.6

# Points at which a fit or a test looks at most: more don't change it.
_MOST_LOOKED_AT = 1500

# Median angle (°) between normals and the directions away from the axis: on the rounded normals of an edge it is more.
_MOST_MEDIAN_ANGLE = 10.0

# Around a cylinder there is air: points up to so many radii from its axis, per point on it. Plates go on.
_AROUND, _MOST_AROUND = 1.5, 0.6

# Least height of the arc that is seen over its chord (times the noise): a flatter one is a plane.
_LEAST_SAGITTA = 6.0

# Share of the cells of the surface, between its ends and where it is seen, that must hold points.
_LEAST_FILLED = 0.5

# A cylinder is empty: points inside it, per point on it.
_MOST_INSIDE = 0.15


@dataclass(frozen=True)
class Found:
    """A cylinder with ends.

    Attributes
    ----------
    cylinder : Cylinder
        Its axis and radius; the ends lie at ``low`` and ``high`` (m) along the axis from its center.
    points : ndarray of shape (k,)
        Points on it.
    rms : float
        Root mean square distance of the points from it, m.
    seen : float
        Share of the circumference that has points.
    """

    cylinder: Cylinder
    low: float
    high: float
    points: np.ndarray
    rms: float
    seen: float

    @property
    def ends(self) -> np.ndarray:
        """The ends of the axis (2, 3), m."""
        return self.cylinder.center + np.outer([self.low, self.high], self.cylinder.axis)


class CylinderSearch:
    """Cylinders among points with normals.

    Parameters
    ----------
    xyz, normals : ndarray of shape (n, 3)
        Points (m), sorted by elevation, and their unit normals; zero where there is none.
    noise : float
        Standard deviation across smooth surfaces, m.
    tolerance : float
        Distance within which a point lies on a cylinder, m.
    spacing : float
        Distance between points on surfaces, m.
    min_seen : float
        Least share of the circumference with points.
    min_points : int
        Points of the smallest cylinder.
    """

    def __init__(
        self,
        xyz: np.ndarray,
        normals: np.ndarray,
        noise: float,
        tolerance: float,
        spacing: float,
        min_seen: float,
        min_points: int,
    ) -> None:
        self.xyz, self.normals, self.noise, self.tolerance = xyz, normals, noise, tolerance
        self.spacing, self.min_seen, self.min_points = spacing, min_seen, min_points
        self.is_free = normals.any(axis=1)
        self.directions = PlaneDirections(_DIRECTION_BIN)
        self.bins = self.directions.bin_of(np.where(self.is_free[:, None], normals, [0.0, 0.0, 1.0]))
        # Which bins lie on the great circle across the middle of each.
        cosine = np.abs(self.directions.normal @ self.directions.normal.T)
        self.on_circle = (cosine <= np.sin(np.radians(_ON_CIRCLE))).astype(np.float32)

    def find(self, min_radius: float, max_radius: float, monitor: Monitor) -> list[Found]:
        """Return the cylinders with radii (m) in a range, those of the smallest radii first."""
        found: list[Found] = []
        ranges = levels(min_radius, max_radius)
        for step, (low, high) in enumerate(ranges):
            level = level_of(self.xyz, self.is_free, low, high, LEAST_POINTS)
            part = monitor.part(step / len(ranges), (step + 1) / len(ranges))
            for number, window in enumerate(level.windows):
                part.progress(number / len(level.windows))
                found += self._in_window(level.rows, window, low, high)
        monitor.progress(1.0)
        return found

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
            if one is not None and low * 0.9 <= one.cylinder.radius <= high * 1.1:
                self.is_free[one.points] = False
                found.append(one)
            # A seed without a cylinder is not looked at twice.
            left = left[~np.isin(left, points)]
        return found

    def _seed(self, rows: np.ndarray, low: float, high: float) -> Optional[tuple[Cylinder, np.ndarray]]:
        """Return the best cylinder of the points of a window, and which points lie on it."""
        axis = self._axis(rows)
        if axis is None:
            return None
        on_circle = rows[np.abs(self.normals[rows] @ axis) <= np.sin(np.radians(_ON_FITTED_CIRCLE))]
        if len(on_circle) < LEAST_POINTS:
            return None
        cylinder = self._circle(on_circle, axis, low, high)
        for reach in (*(share * low for share in _FIRST_FITS), 2 * self.tolerance, self.tolerance):
            points = on_circle[self._is_on(on_circle, cylinder, max(reach, self.tolerance))]
            if len(points) < LEAST_POINTS:
                return None
            cylinder = self._fitted(points, cylinder)
            if not 0.8 * low <= cylinder.radius <= 1.25 * high:
                return None
        return (cylinder, points) if self._is_round(rows, points, cylinder) else None

    def _fitted(self, points: np.ndarray, cylinder: Cylinder) -> Cylinder:
        return fit_cylinder(self.xyz[points[:: len(points) // _MOST_LOOKED_AT + 1]], cylinder)

    def _is_round(self, near: np.ndarray, points: np.ndarray, cylinder: Cylinder) -> bool:
        """Return whether ``points`` look like a cylinder among the points ``near`` it."""
        along, distance, away = cylinder.local(self.xyz[points])
        if np.sqrt(((distance - cylinder.radius) ** 2).mean()) > _MOST_ROUGH * self.noise:
            return False
        facing = np.abs(np.einsum("ij,ij->i", away, self.normals[points]))
        if np.median(facing) < np.cos(np.radians(_MOST_MEDIAN_ANGLE)):
            return False
        at, reach, _ = cylinder.local(self.xyz[near])
        margin = 0.05 * np.ptp(along) + 2 * self.tolerance
        between = (at > along.min() + margin) & (at < along.max() - margin)
        inside = between & (reach < 0.9 * cylinder.radius - 2 * self.tolerance)
        around = between & (reach > cylinder.radius + 2 * self.tolerance) & (reach < _AROUND * cylinder.radius)
        if inside.sum() > _MOST_INSIDE * len(points) or around.sum() > _MOST_AROUND * len(points):
            return False
        looked_at = points[:: len(points) // _MOST_LOOKED_AT + 1]
        return bends(cylinder, self.xyz[looked_at]) <= _MOST_BENT * self.noise

    def _axis(self, rows: np.ndarray) -> Optional[np.ndarray]:
        """Return the normal of the great circle along which normals fill most of the Gaussian sphere."""
        occupied, count = np.unique(self.bins[rows], return_counts=True)
        weight = np.minimum(count, max(1.0, _MOST_IN_BIN * len(rows))).astype(np.float32)
        is_common = count >= min(2, len(rows) // 20 + 1)
        if is_common.sum() < _LEAST_BINS:
            return None
        best = int(np.argmax(weight @ self.on_circle[occupied]))
        if self.on_circle[occupied[is_common], best].sum() < _LEAST_BINS:
            return None
        axis = self.directions.normal[best]
        for _ in range(2):
            near = rows[np.abs(self.normals[rows] @ axis) <= np.sin(np.radians(_ON_FITTED_CIRCLE))]
            # Bins count alike, so that the normals of a plane beside it don't turn the circle.
            share = 1 / np.bincount(self.bins[near], minlength=len(self.directions))[self.bins[near]]
            normals = self.normals[near]
            axis = np.linalg.eigh((normals * share[:, None]).T @ normals)[1][:, 0]
        return upward(axis)

    def _circle(self, rows: np.ndarray, axis: np.ndarray, low: float, high: float) -> Cylinder:
        """Return the circle across an axis for which most points vote: each along its normal, to both sides."""
        first, second = across_axis(axis)
        middle = self.xyz[rows].mean(axis=0)
        places = np.column_stack([(self.xyz[rows] - middle) @ first, (self.xyz[rows] - middle) @ second])
        toward = np.column_stack([self.normals[rows] @ first, self.normals[rows] @ second])
        toward /= np.maximum(np.linalg.norm(toward, axis=1), 1e-12)[:, None]
        radii = np.geomspace(low, high, _RADII)
        signed = np.concatenate([radii, -radii])
        centers = places[:, None] + signed[:, None] * toward[:, None]
        cell, reach = _CENTER_BIN * low, (WINDOW * low) / 2 + 1.1 * high
        side = int(np.ceil(2 * reach / cell)) + 2
        index = np.floor((centers + reach) / cell).astype(np.int64)
        inside = ((index >= 0) & (index < side)).all(axis=2)
        number = np.broadcast_to(np.tile(np.arange(_RADII), 2), inside.shape)
        key = (number * side + index[..., 0]) * side + index[..., 1]
        votes = np.bincount(key[inside], minlength=_RADII * side * side).reshape(_RADII, side, side)
        votes = votes[:, 1:] + votes[:, :-1]
        votes = votes[:, :, 1:] + votes[:, :, :-1]
        radius, i, j = np.unravel_index(int(np.argmax(votes)), votes.shape)
        x, y = (i + 1) * cell - reach, (j + 1) * cell - reach
        return Cylinder(middle + x * first + y * second, axis, float(radii[radius]))

    def _is_on(self, rows: np.ndarray, cylinder: Cylinder, tolerance: float) -> np.ndarray:
        """Return which of the points ``rows`` lie on an endless cylinder and face away from its axis or to it."""
        _, distance, away = cylinder.local(self.xyz[rows])
        facing = np.abs(np.einsum("ij,ij->i", away, self.normals[rows]))
        return (np.abs(distance - cylinder.radius) <= tolerance) & (facing >= np.cos(np.radians(_NORMAL_ANGLE)))

    def _grown(self, rows: np.ndarray, cylinder: Cylinder, seed: np.ndarray) -> Optional[Found]:
        """Return the cylinder that a seed grows to along its axis, None where it is none after all."""
        along = cylinder.local(self.xyz[seed])[0]
        ends = cylinder.center + np.outer([along.min(), along.max()], cylinder.axis)
        thinned = max(self.spacing, 0.15 * cylinder.radius)
        gap = max(_GAP_RADII * cylinder.radius, _GAP_SPACINGS * thinned)
        step = _FIRST_STEP * cylinder.radius
        while True:
            near = self._near(rows, ends, cylinder, step)
            points = near[self._is_on(near, cylinder, self.tolerance)]
            points = self._run(points, cylinder, ends.mean(axis=0), gap)
            if len(points) < LEAST_POINTS:
                return None
            fitted = self._fitted(points, cylinder)
            along = fitted.local(self.xyz[points])[0]
            grown = fitted.center + np.outer([along.min(), along.max()], fitted.axis)
            longer = np.linalg.norm(grown[1] - grown[0]) - np.linalg.norm(ends[1] - ends[0])
            cylinder, ends = fitted, grown
            if longer < thinned:
                break
            # The longer it is, the better its direction is known.
            step = 2 * step if longer >= step else step
        return self._checked(cylinder, ends, gap)

    def _near(self, rows: np.ndarray, ends: np.ndarray, cylinder: Cylinder, more: float) -> np.ndarray:
        """Return the free points of ``rows`` in the box around an axis, ``more`` (m) longer at both ends."""
        reach = _AROUND * cylinder.radius + self.tolerance
        longer = np.array([ends[0] - more * cylinder.axis, ends[1] + more * cylinder.axis])
        low, high = longer.min(axis=0) - reach, longer.max(axis=0) + reach
        # Points are sorted by elevation.
        first, last = np.searchsorted(self.xyz[:, 2], [low[2], high[2]])
        rows = rows[np.searchsorted(rows, first) : np.searchsorted(rows, last)]
        for axis in (0, 1):
            rows = rows[(self.xyz[rows, axis] >= low[axis]) & (self.xyz[rows, axis] <= high[axis])]
        return rows[self.is_free[rows]]

    def _run(self, points: np.ndarray, cylinder: Cylinder, middle: np.ndarray, gap: float) -> np.ndarray:
        """Return the points that follow each other along the axis without a gap, those around the middle."""
        along = cylinder.local(self.xyz[points])[0]
        order = np.argsort(along, kind="stable")
        run = np.concatenate([[0], np.cumsum(np.diff(along[order]) > gap)]).astype(np.int64)
        if not len(points):
            return points
        at = float((middle - cylinder.center) @ cylinder.axis)
        return np.sort(points[order[run == run[np.argmin(np.abs(along[order] - at))]]])

    def _checked(self, cylinder: Cylinder, ends: np.ndarray, gap: float) -> Optional[Found]:
        """Return the cylinder with all its points if these look like one."""
        every = np.arange(len(self.xyz))
        near = self._near(every, ends, cylinder, 0.5 * cylinder.radius)
        points = near[self._is_on(near, cylinder, self.tolerance)]
        points = self._run(points, cylinder, ends.mean(axis=0), gap)
        if len(points) < self.min_points:
            return None
        cylinder = fit_cylinder(self.xyz[points], cylinder)
        points = near[self._is_on(near, cylinder, self.tolerance)]
        points = self._run(points, cylinder, ends.mean(axis=0), gap)
        along, distance, away = cylinder.local(self.xyz[points])
        if len(points) < self.min_points or not self._is_long(along, cylinder):
            return None
        seen, filled = self._coverage(along, cylinder.angle(away), cylinder)
        sagitta = cylinder.radius * (1 - np.cos(np.pi * min(seen, 0.5)))
        if seen < self.min_seen or filled < _LEAST_FILLED or sagitta < _LEAST_SAGITTA * self.noise:
            return None
        rms = float(np.sqrt(((distance - cylinder.radius) ** 2).mean()))
        low, high = float(along.min()), float(along.max())
        return Found(cylinder, low, high, points, rms, seen) if self._is_round(near, points, cylinder) else None

    @staticmethod
    def _is_long(along: np.ndarray, cylinder: Cylinder) -> bool:
        diameter = 2 * cylinder.radius
        return bool(np.ptp(along) >= max(min(_LENGTH * diameter, _LONG_ENOUGH), _SHORT * diameter))

    def _coverage(self, along: np.ndarray, angle: np.ndarray, cylinder: Cylinder) -> tuple[float, float]:
        """Return the share of the circumference with points, and of the cells there that hold some."""
        sectors = int(np.clip(2 * np.pi * cylinder.radius / (2 * self.spacing), 8, SECTORS))
        sector = np.minimum(((angle / (2 * np.pi) + 0.5) * sectors).astype(np.int64), sectors - 1)
        length = float(np.ptp(along))
        slices = int(np.clip(length / max(3 * self.spacing, 0.5 * cylinder.radius), 1, 30))
        at = np.minimum(((along - along.min()) / max(length, 1e-9) * slices).astype(np.int64), slices - 1)
        cells = np.bincount(sector * slices + at, minlength=sectors * slices).reshape(sectors, slices) > 0
        # A sector with stray points only is not seen.
        is_seen = cells.mean(axis=1) >= 0.3
        return float(is_seen.mean()), float(cells[is_seen].mean()) if is_seen.any() else 0.0
