"""The plane of a facade as a frame of its own: along the facade, up it, and out of it."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..criteria import PARALLEL
from ..geometry.polygons import line_of_planes


@dataclass(frozen=True)
class Frame:
    """Axes along, up and out of a plane that is not level."""

    origin: np.ndarray  #: (3,): a point on the plane (m)
    #: along, up, normal, (3,): unit vectors: level and to the right, seen from outside; up the plane; out of the facade
    along: np.ndarray
    up: np.ndarray
    normal: np.ndarray

    def local(self, xyz: np.ndarray) -> np.ndarray:
        """Return positions (n, 3) along, up and out of the facade (m) of points (n, 3)."""
        return (xyz - self.origin) @ np.column_stack([self.along, self.up, self.normal])

    def space(self, positions: np.ndarray) -> np.ndarray:
        """Return the points (m, 3) at positions (m, 2) along and up the facade (m)."""
        return self.origin + positions[:, :1] * self.along + positions[:, 1:] * self.up

    @property
    def azimuth(self) -> float:
        """Direction (°) that the facade faces, clockwise from north, 0 to 360."""
        return float(np.degrees(np.arctan2(self.normal[0], self.normal[1])) % 360.0)

    @property
    def tilt(self) -> float:
        """Angle (°) of the plane to the vertical, positive where it faces the sky."""
        return float(np.degrees(np.arcsin(np.clip(self.normal[2], -1.0, 1.0))))


def frame_of(origin: np.ndarray, normal: np.ndarray) -> Frame:
    """Return the frame of the plane through a point (3,), m, with a unit normal (3,) that is not vertical."""
    along = np.array([-normal[1], normal[0], 0.0])
    along /= np.linalg.norm(along)
    return Frame(origin, along, np.cross(normal, along), normal)


def intersection_line(one: Frame, other: Frame) -> Optional[tuple[np.ndarray, np.ndarray]]:
    """Return a point (3,), m, and the unit direction (3,) of the line that two planes share, None if nearly parallel.

    The point is the one nearest to the middle between the origins of both.
    """
    if np.linalg.norm(np.cross(one.normal, other.normal)) < PARALLEL:
        return None
    return line_of_planes((one.origin, other.origin), (one.normal, other.normal))
