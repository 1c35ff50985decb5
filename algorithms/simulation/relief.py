"""Terrain of a simulated town in closed form: a slope with hills, terraces and a river valley."""

from dataclasses import dataclass, field
from typing import Optional

import numpy as np
from numpy.random import Generator

from .bodies import Rect

# Half the width (m) of the level valley floor of a small regulated river.
VALLEY = 16.0

# Half the width (m) of the channel between the upper edges of the banks.
CHANNEL = 9.6

# Depth (m) of the channel below the valley floor.
_CHANNEL_DEPTH = 4.5

# Slope of the banks, a tangent.
_BANK_SLOPE = 0.8

# Depth of the water (m).
_WATER_DEPTH = 1.5

# Distance between terraces (m).
_TERRACE_LENGTH = 45.0


@dataclass(frozen=True)
class Relief:
    """Ground and water as functions of position.

    The frame of the town is rotated against east and north, with its origin at the town's center. The ground rises and
    streets run in the direction *across*; the river flows in the direction *along*.
    """

    size: float  #: Side of the town, a square from (0, 0) to (size, size), m
    angle: float = 0.0  #: Direction of *across*, radians from east
    gradient: float = 0.0  #: Tangent of the mean slope
    hills: float = 0.0  #: Approximate height difference between hollows and hills, m
    terrace_height: float = 0.0  #: Rise of the terraces, m
    river: Optional[float] = None  #: Position of the river's axis across the town, m; None for no river
    #: (k, 3): hills: wave numbers across and along (rad/m) and phase (rad)
    waves: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))

    @property
    def frame(self) -> Rect:
        """The town as a rectangle: length in the direction *across*, width *along*."""
        return Rect(self.size / 2, self.size / 2, self.size, self.size, self.angle)

    def plane(self, x, y) -> np.ndarray:
        """Return the elevation (m) of the mean plane of the ground."""
        return self.gradient * (self.frame.local(x, y)[0] - (self.river or 0.0))

    @property
    def plane_gradient(self) -> tuple[float, float]:
        """Gradient of :meth:`plane` to the east and to the north."""
        return self.gradient * float(np.cos(self.angle)), self.gradient * float(np.sin(self.angle))

    @property
    def spread(self) -> float:
        """Upper bound (m) of the vertical distance from the ground to :meth:`plane`."""
        return self.gradient * VALLEY + self.terrace_height + self.hills + _CHANNEL_DEPTH

    @property
    def water_level(self) -> float:
        """Elevation of the water (m)."""
        return _WATER_DEPTH - _CHANNEL_DEPTH

    def ground(self, x, y) -> np.ndarray:
        """Return the elevation (m) of the ground; under water, of the river bed."""
        return self._ground(*self.frame.local(x, y))

    def _ground(self, across, along) -> np.ndarray:
        distance = across - (self.river or 0.0)
        rise = distance if self.river is None else np.sign(distance) * np.maximum(np.abs(distance) - VALLEY, 0.0)
        z = self.gradient * rise + self._terrace(rise) + self._hill(across, along, rise)
        return z if self.river is None else z - np.clip((CHANNEL - np.abs(distance)) * _BANK_SLOPE, 0.0, _CHANNEL_DEPTH)

    def surface(self, x, y) -> np.ndarray:
        """Return the elevation (m) of ground or water, whichever is higher."""
        across, along = self.frame.local(x, y)
        z = self._ground(across, along)
        return z if self.river is None else np.where(self._is_water(across), self.water_level, z)

    def is_water(self, x, y) -> np.ndarray:
        """Return the mask of positions with water."""
        return np.zeros(np.shape(x), bool) if self.river is None else self._is_water(self.frame.local(x, y)[0])

    def _is_water(self, across) -> np.ndarray:
        # Half the width of the water surface, from the profile of the channel.
        return np.abs(across - self.river) < CHANNEL - (_CHANNEL_DEPTH - _WATER_DEPTH) / _BANK_SLOPE

    def tangent(self, x: float, y: float) -> np.ndarray:
        """Return the tangent plane (a, b, c), z = a x + b y + c, of the ground at a point (m)."""
        step = np.array([0.0, 1.0, -1.0, 0.0, 0.0])
        z, east, west, north, south = self.ground(x + step, y + step[[0, 3, 4, 1, 2]])
        a, b = (east - west) / 2, (north - south) / 2
        return np.array([a, b, z - a * x - b * y])

    def _terrace(self, rise):
        """Return the height (m) of terraces: steep risers and slightly falling treads, which keep the mean slope."""
        if not self.terrace_height:
            return 0.0
        # Beams up to 30° off the vertical meet ground with a gradient below 1 / tan 30° = 1.73 exactly once. The
        # gradient of the hills is at most 0.04 of their height.
        riser = self.terrace_height / (min(1.0, 1.7 - self.gradient - 0.04 * self.hills))
        at = np.mod(rise, _TERRACE_LENGTH)
        return self.terrace_height * np.minimum(at / riser, (_TERRACE_LENGTH - at) / (_TERRACE_LENGTH - riser))

    def _hill(self, across, along, rise):
        if not self.hills:
            return 0.0
        total = sum(np.sin(kx * across + ky * along + phase) for kx, ky, phase in self.waves)
        # Hills fade toward the level valley floor.
        fade = 1.0 if self.river is None else np.minimum(np.abs(rise) / 60.0, 1.0)
        return self.hills / (2 * len(self.waves)) * total * fade


def make_relief(size: float, slope: float, hills: float, terrace_height: float, river: bool, rng: Generator) -> Relief:
    """Return a random terrain.

    Parameters
    ----------
    size, hills, terrace_height : float
        Side of the square, height difference between hollows and hills, and rise of the terraces, m.
    slope : float
        Mean slope of the ground, °.
    river : bool
        Whether to add a river.
    rng : numpy.random.Generator
        Source of random numbers.
    """
    angle = float(np.deg2rad(rng.uniform(10.0, 35.0)))
    length = rng.uniform(80.0, 160.0, 4)
    direction = rng.uniform(0.0, np.pi, 4)
    number = 2 * np.pi / length
    waves = np.column_stack([np.cos(direction) * number, np.sin(direction) * number, rng.uniform(0.0, 2 * np.pi, 4)])
    axis = float(rng.uniform(-0.3, -0.2) * size)
    return Relief(size, angle, float(np.tan(np.deg2rad(slope))), hills, terrace_height, axis if river else None, waves)
