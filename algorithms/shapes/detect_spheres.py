"""Spheres: centers where the normals of their points meet, radii, then least squares."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from .cylinder_evidence import EVIDENCE, FACING, MOST_LOOKED_AT, facing
from .cylinder_fits import LEAST_POINTS, explained, fit_sphere
from .hough_planes import PlaneDirections, unit
from .search_settings import MAX_RADIUS, MIN_RADIUS, SHAPE_TOLERANCE, reach_of_radius
from .searched_points import SEARCH_IN, MeasuredPoints, SearchedCloud, SearchTunables, Shape, search_shapes
from .shape_windows import BEYOND_LEVEL, CENTER_BIN, RADII_OF_LEVEL, WINDOW, level_of, levels
from .surface_normals import NORMAL_POINTS

CENTER_FIRST, _FOUR_DIMENSIONS = METHODS = ("center first", "four dimensions")

_FIELDS = (
    Field("id", int, "number of the sphere, as SegmentID of its points", numbers="segment_id"),
    Field("radius", float, "radius", "m"),
    Field("points", int, "points on the sphere"),
    Field("rms", float, "root mean square distance of the points from the sphere", "m"),
    Field("seen", float, "share of the sphere that has points, 0 to 1"),
)

# Least share of the variance of normals in each direction: they vary in two on a sphere, in one on a cylinder.
_LEAST_SPREAD = 0.02

# Largest deviation of the points from a sphere, in multiples of the noise.
_MOST_ROUGH = 1.25

# Radius of the surroundings of a sphere, in its radii.
_AROUND = 1.5

# Most points in the surroundings of a sphere per point on it: it lies in the air.
_MOST_AROUND = 0.6


@dataclass(frozen=True)
class FoundSphere:
    """A sphere: center (3,) and radius (m), the points (k,) on it, their deviation (m), and the share of it seen."""

    center: np.ndarray
    radius: float
    points: np.ndarray
    rms: float
    seen: float


class SphereSearch:
    """Spheres among points with normals.

    Parameters
    ----------
    measured : MeasuredPoints
        The points.
    min_seen : float
        Least share of the sphere with points.
    min_points : int
        Points of the smallest sphere.
    centers_first : bool
        Whether centers are voted for before radii, or both together in four dimensions.
    """

    def __init__(self, measured: MeasuredPoints, min_seen: float, min_points: int, centers_first: bool) -> None:
        self.xyz, self.normals = measured.xyz, measured.normals
        self.noise, self.tolerance = measured.noise, measured.tolerance
        self.min_seen, self.min_points, self.centers_first = min_seen, min_points, centers_first
        self.is_free = self.normals.any(axis=1)
        # Parts of a sphere that are seen or not: 48 on each half.
        self.parts = PlaneDirections(0.5)

    def find(self, min_radius: float, max_radius: float, monitor: Monitor) -> list[FoundSphere]:
        """Return the spheres with radii (m) in a range, the smallest first."""
        found: list[FoundSphere] = []
        ranges = levels(min_radius, max_radius)
        for (low, high), part in zip(ranges, monitor.parts(len(ranges))):
            level = level_of(self.xyz, self.is_free, low, high, LEAST_POINTS)
            for number, window in enumerate(level.windows):
                part.progress(number / len(level.windows))
                rows = level.rows[window]
                rows = rows[self.is_free[rows]]
                seed = self._seed(rows, low, high) if self._is_curved(rows) else None
                one = self._checked(*seed) if seed is not None else None
                if one is not None:
                    self.is_free[one.points] = False
                    found.append(one)
        monitor.progress(1.0)
        return found

    def _is_curved(self, rows: np.ndarray) -> bool:
        """Return whether the normals of points vary in two directions."""
        if len(rows) < LEAST_POINTS:
            return False
        normals = self.normals[rows]
        return bool(np.linalg.eigvalsh(normals.T @ normals / len(rows))[0] >= _LEAST_SPREAD)

    def _seed(self, rows: np.ndarray, low: float, high: float) -> Optional[tuple[np.ndarray, float]]:
        """Return the sphere for which most points of a window vote: each along its normal, to both sides."""
        middle = self.xyz[rows].mean(axis=0)
        radii = np.geomspace(low, high, RADII_OF_LEVEL)
        signed = np.concatenate([radii, -radii])
        centers = (self.xyz[rows] - middle)[:, None] + signed[:, None] * self.normals[rows][:, None]
        cell, reach = CENTER_BIN * low, WINDOW * low / 2 + 1.1 * high
        side = int(np.ceil(2 * reach / cell)) + 2
        index = np.floor((centers + reach) / cell).astype(np.int64)
        inside = ((index >= 0) & (index < side)).all(axis=2)
        position = (index[..., 0] * side + index[..., 1]) * side + index[..., 2]
        number = np.broadcast_to(np.tile(np.arange(RADII_OF_LEVEL), 2), inside.shape)
        if self.centers_first:
            best = int(np.argmax(np.bincount(position[inside])))
            of_center = inside & (position == best)
            radius = float(radii[np.argmax(np.bincount(number[of_center], minlength=RADII_OF_LEVEL))])
        else:
            best, k = divmod(int(np.argmax(np.bincount((position * RADII_OF_LEVEL + number)[inside]))), RADII_OF_LEVEL)
            radius = float(radii[k])
        center = middle + (np.array([best // side**2, best // side % side, best % side]) + 0.5) * cell - reach
        return self._fitted(rows, center, radius, low, high)

    def _fitted(
        self, rows: np.ndarray, center: np.ndarray, radius: float, low: float, high: float
    ) -> Optional[tuple[np.ndarray, float]]:
        """Return the least-squares sphere of the points around a start, None if its radius is out of range."""
        for reach in (CENTER_BIN * low, 2 * self.tolerance, self.tolerance):
            points = rows[self._is_on(rows, center, radius, max(reach, self.tolerance))]
            if len(points) < LEAST_POINTS:
                return None
            center, radius = fit_sphere(self.xyz[points[:: len(points) // MOST_LOOKED_AT + 1]], center, radius)
            if not low / BEYOND_LEVEL <= radius <= high * BEYOND_LEVEL:
                return None
        return (center, radius) if self._is_round(points, center, radius) else None

    def _is_on(self, rows: np.ndarray, center: np.ndarray, radius: float, tolerance: float) -> np.ndarray:
        """Return the mask of the points ``rows`` that lie on a sphere and face its center."""
        offset = self.xyz[rows] - center
        distance = np.linalg.norm(offset, axis=1)
        return (np.abs(distance - radius) <= tolerance) & (facing(offset, self.normals[rows]) >= FACING * distance)

    def _is_round(self, points: np.ndarray, center: np.ndarray, radius: float) -> bool:
        """Return whether points lie close to a sphere and their distances show no other shape."""
        points = points[:: len(points) // MOST_LOOKED_AT + 1]
        offset = self.xyz[points] - center
        away, residual = unit(offset), np.linalg.norm(offset, axis=1) - radius
        if np.sqrt((residual**2).mean()) > _MOST_ROUGH * self.noise:
            return False
        if np.median(facing(away, self.normals[points])) < np.cos(np.radians(EVIDENCE.median_angle)):
            return False
        x, y, z = away.T
        # An ellipsoid, a cylinder or a torus has waves of second order, faces have higher ones.
        waves = np.column_stack([x * y, x * z, y * z, x * x - y * y, 3 * z * z - 1, *(away**3).T, x * y * z])
        return explained(residual - residual.mean(), waves) <= EVIDENCE.bent * self.noise

    def _checked(self, center: np.ndarray, radius: float) -> Optional[FoundSphere]:
        """Return the sphere with all its points if these look like one."""
        reach = _AROUND * radius
        first, last = np.searchsorted(self.xyz[:, 2], [center[2] - reach, center[2] + reach])
        near = np.arange(first, last)
        near = near[self.is_free[near] & (np.abs(self.xyz[near, :2] - center[:2]) <= reach).all(axis=1)]
        points = near[self._is_on(near, center, radius, self.tolerance)]
        if len(points) < max(self.min_points, LEAST_POINTS):
            return None
        center, radius = fit_sphere(self.xyz[points], center, radius)
        points = near[self._is_on(near, center, radius, self.tolerance)]
        if len(points) < self.min_points or not self._is_round(points, center, radius):
            return None
        distance = np.linalg.norm(self.xyz[near] - center, axis=1)
        inside = distance < EVIDENCE.inner * radius - 2 * self.tolerance
        around = (distance > radius + 2 * self.tolerance) & (distance < reach)
        if inside.sum() > EVIDENCE.inside * len(points) or around.sum() > _MOST_AROUND * len(points):
            return None
        away = self.xyz[points] - center
        part = self.parts.bin_of(away) * 2 + (away[np.arange(len(away)), np.argmax(np.abs(away), axis=1)] > 0)
        seen = len(np.unique(part)) / (2 * len(self.parts))
        rms = float(np.sqrt(((np.linalg.norm(away, axis=1) - radius) ** 2).mean()))
        return FoundSphere(center, radius, points, rms, seen) if seen >= self.min_seen else None


@stage(
    "Shapes",
    tags="sphere,ball,vessel,dome,target,Hough,industry,as-built",
    writes=("segment_id", "shape"),
    reach=lambda tunables: reach_of_radius(tunables["max_radius"]),
    layers=(Layer("centers", "Centers of spheres", "Point", _FIELDS, radius="radius"),),
)
def detect_spheres(
    xyz,
    classification,
    segment_id=None,
    shape=None,
    *,
    method: str = tunable(CENTER_FIRST, choices=METHODS),
    min_radius: Optional[float] = MIN_RADIUS,
    max_radius: Optional[float] = MAX_RADIUS,
    tolerance: Optional[float] = SHAPE_TOLERANCE,
    min_seen: float = tunable(0.15, label="Minimum share seen", within="[0.05, 1]"),
    min_points: int = tunable(40, within=f"[{LEAST_POINTS}, 1_000_000]"),
    search_in: str = SEARCH_IN,
    n_neighbors: Optional[int] = NORMAL_POINTS,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find spheres (vessels, domes, targets): centers with radius, and the points on each.

    Every point and its normal define a line on which the center lies. In each window points vote along it, to both
    sides, for all radii. The best center and radius are fitted by least squares and kept if their points look like a
    sphere: close to it, spread over enough of it, not following another shape, and with nothing inside.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground (2, 20), noise (7, 18), water (9) and bridge decks (17) are left out.
    segment_id : ndarray of shape (n,), int32, optional
        Segments; needed to search in each of them.
    shape : ndarray of shape (n,), uint8, optional
        Shapes found before; points that have one are left as they are, except in a search of the whole cloud.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Spheres from 1, in the order of their first points; 0 if unassigned. Numbers follow those that are kept.
    shape : ndarray of shape (n,), uint8
        3 on spheres.
    centers : LayerFeatures
        The center of each sphere as a point with its height.

    Other Parameters
    ----------------
    method
        With center first, points vote for a center, and the voters of the best center for a radius. With four
        dimensions, they vote for both together, which takes more memory.
    min_seen
        Least share of the sphere that must have points, 0 to 1. A sphere of which less is seen has an uncertain radius.
    min_points
        Points of the smallest sphere.

    Raises
    ------
    ValueError
        If the range of radii is empty, segments are asked for and missing, all points lie on one line, or the points
        are spread too far for the windows.

    Notes
    -----
    Deviation from the paper: radii are searched octave by octave, from small to large, each in windows of four times
    the least radius and among points thinned accordingly. So time and memory don't grow with the radius. In a window
    only one sphere is looked for at a time; windows overlap by half.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 4.3. [vosselman2004]

    Examples
    --------
    >>> import numpy as np
    >>> angle, up = np.mgrid[0:6.28:0.05, -1.5:1.5:0.05].reshape(2, -1)
    >>> level = np.column_stack([np.cos(angle), np.sin(angle)]) * np.cos(up)[:, None]
    >>> xyz = np.column_stack([level, np.sin(up)])
    >>> ids, shapes, centers = detect_spheres(xyz, np.zeros(len(xyz)))
    >>> len(centers), round(float(centers.columns["radius"][0]), 2)
    (1, 1.0)
    """

    def search(measured: MeasuredPoints, low: float, high: float, monitor: Monitor) -> list[FoundSphere]:
        return SphereSearch(measured, min_seen, min_points, method == CENTER_FIRST).find(low, high, monitor)

    cloud = SearchedCloud(xyz, classification, segment_id, shape, search_in)
    tunables = SearchTunables(min_radius, max_radius, tolerance, n_neighbors)
    found = search_shapes(cloud, Shape.SPHERE, search, tunables, sampling, monitor)
    ones = found.shapes
    centers = LayerFeatures(
        [found.points.in_place(one.center, int(one.points[0])) for one in ones],
        {
            "id": found.numbers,
            "radius": [one.radius for one in ones],
            "points": [len(one.points) for one in ones],
            "rms": [one.rms for one in ones],
            "seen": [one.seen for one in ones],
        },
    )
    return found.segment_id, found.shape, centers
