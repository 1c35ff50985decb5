"""How a cloud was sampled, measured once per run and shared by all stages of it."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Callable, Optional, Union

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..criteria import MILLIMETER
from ..geometry.grid import plan_box
from ..neighborhoods.covariance import Nearest
from ..neighborhoods.wide_in_plan import Wide
from ..stage import Monitor
from .closed_surface import seen_through_share
from .density import effective_density, point_density
from .height_resolution import height_resolution, rounding_deviation
from .kinds import IMAGES, LASER, CloudKind
from .surface_noise import SURFACES, SurfaceSample, plane_roughness

# Measurements, each with its name and unit in the log.
_MEASURES = {
    "density": ("density", "points/m²"),
    "effective_density": ("effective density", "points/m²"),
    "surface_density": ("density on surfaces", "points/m²"),
    "noise": ("surface noise", "m"),
    "scan_noise": ("noise of the scan", "m"),
    "height_resolution": ("height resolution", "m"),
    "seen_through": ("share seen through", ""),
}

# Largest share of a closed surface that is seen through: between matched images and laser clouds without
# second returns, see :func:`.closed_surface.seen_through_share`.
_MOST_SEEN_THROUGH = 0.02

# Least density (points/m²) at which the share seen through alone distinguishes them, as it does for few crowns, too.
_LEAST_DENSITY = 8.0

# Name of the noise of the ground among what parts of a cloud take of the whole.
GROUND_NOISE = "ground_noise"

# The default of a stage's argument ``sampling``: where it is called alone, it is given its own points' sampling.
MEASURED: Any = None

# Returns the numbers that a table shows.
Learn = Callable[[np.ndarray], tuple[float, ...]]


class CloudSampling:
    """How a cloud samples its surfaces: how densely, how evenly, with how much noise.

    It is measured on the points that are neither withheld nor noise (classes 7 and 18), so that it is the same before
    and after every stage that leaves these as they are. Each measure is taken when it is first asked for, and kept.
    One survey has one sampling: stages take the one that they are given, also of other tiles of the survey.

    Parameters
    ----------
    points : callable
        Returns the coordinates (n, 3), m, n >= 1, of the points that it is measured on.
    single_returns : bool
        Whether no pulse is known to have more than one return. Clouds matched from images never have.
    corner : ndarray of shape (2,), optional
        Least easting and northing of the whole, m, where cells begin; of ``points``, unless given.
    has_colors : bool
        Whether points have colors, as in clouds of images.

    Attributes
    ----------
    of_whole : dict of str to float or tuple of floats
        Values that steps have measured on the whole of which the cloud is a part, by their names; empty for a whole.
    found : dict of str to float
        Values that steps have measured on this cloud.
    samples : dict of str to tuple
        Tables that steps have learned from on this cloud, each with the function that learns from several together.
    asked : ndarray of shape (2, 2), optional
        Least and greatest x and y, local m, of the part of the cloud whose features are asked for; None is all of it.

    Examples
    --------
    >>> lattice = np.stack(np.meshgrid(np.arange(50.0), np.arange(50.0), [7.0]), axis=-1).reshape(-1, 3)
    >>> sampling = CloudSampling.of(lattice)
    >>> round(sampling.density, 1), round(sampling.noise, 3)
    (1.0, 0.01)
    """

    def __init__(
        self,
        points: Callable[[], np.ndarray],
        single_returns: bool = False,
        corner: Optional[np.ndarray] = None,
        has_colors: bool = False,
    ) -> None:
        self._points = points
        self.single_returns, self.has_colors = single_returns, has_colors
        self.of_whole: dict[str, Any] = {}
        self.found: dict[str, float] = {}
        self.samples: dict[str, tuple[np.ndarray, Learn]] = {}
        self.asked: Optional[np.ndarray] = None
        if corner is not None:
            self.corner = corner

    @classmethod
    def of(cls, xyz: np.ndarray, classification: Optional[np.ndarray] = None) -> CloudSampling:
        """Return the sampling of points (n, 3), m, without those that are noise by their ``classification`` (n,)."""
        if classification is None:
            return cls(lambda: xyz)
        counted = without_noise(classification)
        return cls(lambda: xyz.compress(counted, axis=0), corner=plan_box(xyz)[0])

    @cached_property
    def corner(self) -> np.ndarray:
        """Least easting and northing (2,) of the cloud, or of the survey that it is a part of, m."""
        return plan_box(self._points())[0]

    def from_corner(self, xyz: np.ndarray) -> np.ndarray:
        """Return points (n, 3), m, with easting and northing from the corner, where the cells of all stages begin."""
        moved = xyz.copy()
        # Column by column: numpy is slow on rows of three.
        for axis, start in enumerate(self.corner):
            moved[:, axis] -= start
        return moved

    def without_noise(self, xyz: np.ndarray, classes: np.ndarray, monitor: Monitor) -> tuple[np.ndarray, np.ndarray]:
        """Return the points (m, 3) that are not noise, from the corner, m, and their rows (m,).

        Without an extent in plan they are none, of which the monitor is warned.
        """
        used = not_noise(classes)
        points = self.from_corner(xyz.take(used, axis=0))
        if not len(used) or not np.ptp(plan_box(points), axis=0).any():
            monitor.warn("No noise was looked for: the points that are not noise already have no extent in plan.")
            return points[:0], used[:0]
        return points, used

    def asks_for(self, box: np.ndarray, around: float = 0.0) -> bool:
        """Whether features in a box (2, 2), or up to ``around`` (m) from it, are asked for."""
        if self.asked is None:
            return True
        return bool((box[0] - around <= self.asked[1]).all() and (box[1] + around >= self.asked[0]).all())

    def shared(self, name: str, measure: Callable[[], float]) -> float:
        """Return the value of that name of the whole; where the cloud is the whole, the one that ``measure`` returns.

        A stage declares the names (``of_whole``), so that they are measured before parts of a cloud are worked on.
        """
        if name in self.of_whole:
            return self.of_whole[name]
        self.found[name] = measure()
        return self.found[name]

    def learned(self, name: str, sample: Callable[[], np.ndarray], learn: Learn) -> tuple[float, ...]:
        """Return the numbers of that name that were learned on the whole; on this cloud, where it is the whole.

        ``sample`` returns a table, a row for each item, and ``learn`` what it shows. Tables of parts of a survey are
        learned from together, one below the other.
        """
        if name in self.of_whole:
            return self.of_whole[name]
        self.samples[name] = sample(), learn
        return learn(self.samples[name][0])

    @cached_property
    def density(self) -> float:
        """Points per square meter of occupied area."""
        return point_density(self._points())

    @cached_property
    def effective_density(self) -> float:
        """Density (points/m²) of an evenly spread cloud with gaps as wide, less where points lie on lines."""
        return effective_density(self._points(), self.density)

    @property
    def spacing(self) -> float:
        """Mean distance between neighboring points in plan, m."""
        return 1 / float(np.sqrt(self.density))

    @cached_property
    def surface_density(self) -> float:
        """Points per square meter of the surfaces that they lie on, however steep these are."""
        return self._surfaces.density

    @cached_property
    def noise(self) -> float:
        """Standard deviation of points across smooth surfaces, m; at least the resolution of heights."""
        return self._surfaces.noise(self.height_resolution)

    def noise_with_ground(self, xyz: np.ndarray, classification: np.ndarray) -> float:
        """Return the noise, m, and where ground is known no more than its points'.

        In a forest nearly all points are of crowns, whose smoothest parts are rougher than any surface. Stages that ask
        for it declare ``GROUND_NOISE``.
        """
        known = {**self.found, **self.of_whole}
        if GROUND_NOISE not in known:
            ground = xyz.compress(classification == PointClass.GROUND, axis=0)
            if len(ground) < SURFACES.neighbors:
                return self.noise
            known[GROUND_NOISE] = self.found[GROUND_NOISE] = SurfaceSample(ground).noise(self.height_resolution)
        return min(self.noise, known[GROUND_NOISE])

    @cached_property
    def scan_noise(self) -> float:
        """Standard deviation of points across smooth surfaces, m, of scans finer than a centimeter, too.

        It is bounded by the rounding of heights only, where ``noise`` is at least a centimeter.
        """
        # Files keep coordinates to a millimeter, which leaves an error of rounding, too.
        of_files = MILLIMETER / float(np.sqrt(12))
        return self._surfaces.noise(max(rounding_deviation(self._points()[:, 2]), of_files))

    @property
    def roughness(self) -> float:
        """How far points of one roof or wall may lie off its plane (one standard deviation, m).

        The density of surfaces counts: seen from above, crowns and walls hold many times their points.
        """
        return plane_roughness(self.noise, self.surface_density)

    @cached_property
    def height_resolution(self) -> float:
        """Standard deviation below which no roughness can be measured, m."""
        return height_resolution(self._points()[:, 2])

    @cached_property
    def seen_through(self) -> float:
        """Share of the area in which points lie far beneath others, see :func:`.closed_surface.seen_through_share`."""
        return seen_through_share(self._points(), self.spacing)

    def is_closed_surface(self, source: str = "automatic") -> bool:
        """Whether the cloud holds one surface seen from above, from matched images: measured, or by its source."""
        if source != "automatic":
            return source == "matched images"
        return self.density >= (self.density_of_images if self.has_colors else _LEAST_DENSITY) and self._is_closed

    @property
    def density_of_images(self) -> float:
        """Density (points/m²) that the rules of images need: a point in a square as wide as the least surface."""
        return 1 / SURFACES.least_reach**2

    @property
    def lacks_points_of_images(self) -> bool:
        """Whether the cloud looks matched from images, but is too thin for the rules of such clouds."""
        return self.has_colors and self.density < self.density_of_images and self._is_closed

    @property
    def _is_closed(self) -> bool:
        """Whether hardly any pulse is known to pass through a crown."""
        return self.single_returns and self.seen_through <= _MOST_SEEN_THROUGH

    def kind(self, source: str = "automatic") -> CloudKind:
        """Return the kind of the cloud: measured, or by its source."""
        return IMAGES if self.is_closed_surface(source) else LASER

    def neighborhood(self, density: float, deviation: float) -> Union[Nearest, Wide]:
        """Return the neighbors that show the plane of a surface, see :class:`.surface_noise.SurfaceSample`."""
        return self._surfaces.neighborhood(density, deviation)

    @cached_property
    def _surfaces(self) -> SurfaceSample:
        points = self._points()
        low, high = plan_box(points)
        return SurfaceSample(points, self.spacing if (high > low).any() else None)

    @property
    def measured(self) -> dict[str, float]:
        """Measurements already made, by name."""
        return {name: self.__dict__[name] for name in _MEASURES if name in self.__dict__}

    def __str__(self) -> str:
        """Return the measurements already made, as the log shows them."""
        labeled = ((*_MEASURES[name], value) for name, value in self.measured.items())
        return ", ".join(f"{label} {value:.4g} {unit}".rstrip() for label, unit, value in labeled)

    def without_points(self) -> CloudSampling:
        """Return the sampling as numbers alone, all measured: for blocks of a survey, in other processes."""
        alone = CloudSampling(_no_points, self.single_returns, self.corner, self.has_colors)
        alone.__dict__.update({name: getattr(self, name) for name in _MEASURES})
        alone.__dict__["_surfaces"] = self._surfaces.measured()
        alone.of_whole = dict(self.of_whole)
        return alone


def _no_points() -> np.ndarray:
    """Refuse to give the points of a sampling that has numbers alone."""
    raise RuntimeError("A sampling without points has all its measures.")


def without_noise(classification: np.ndarray) -> np.ndarray:
    """Return the mask of points (n,) to measure a cloud on: those that are not noise; all where there are no others."""
    counted = ~np.isin(classification, NOISE)
    return counted if counted.any() else np.ones(len(counted), bool)


def not_noise(classification: np.ndarray) -> np.ndarray:
    """Return the rows (m,) of the points that are not noise, which stages work on: none where all are noise."""
    return np.flatnonzero(~np.isin(classification, NOISE))


def with_noise(classes: np.ndarray, low: np.ndarray, high: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return the classes with the noise that was found, and report how many points it has.

    Parameters
    ----------
    classes : ndarray of shape (n,), uint8
        Classes, which are changed.
    low, high : ndarray of shape (k,)
        Rows of low and of high noise.
    monitor : Monitor
        Receives their numbers.
    """
    classes[low], classes[high] = PointClass.LOW_NOISE, PointClass.HIGH_NOISE
    monitor.resolved(low_noise=len(low), high_noise=len(high))
    return classes
