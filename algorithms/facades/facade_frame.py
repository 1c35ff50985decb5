"""The plane of a facade as a frame of its own: along the facade, up it, and out of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.grid import distinct

# Side (m) of the cells in which a facade is held against the points on both of its sides.
_CELL = 0.5

# Points farther from the plane than this (m) say nothing about the side from which a facade was seen.
_FARTHEST = 10.0

# A facade wider than this (cells) is judged without its two ends.
_LEAST_COLUMNS = 3


@dataclass(frozen=True)
class Frame:
    """Position along, up and out of a plane that is not level.

    Attributes
    ----------
    origin : ndarray of shape (3,)
        A point on the plane (m).
    along, up, normal : ndarray of shape (3,)
        Unit vectors: level and to the right, seen from outside; up the plane; out of the facade.
    """

    origin: np.ndarray
    along: np.ndarray
    up: np.ndarray
    normal: np.ndarray

    def local(self, xyz: np.ndarray) -> np.ndarray:
        """Return positions (n, 3) along, up and out of the facade (m) of points (n, 3)."""
        return (xyz - self.origin) @ np.column_stack([self.along, self.up, self.normal])

    def space(self, places: np.ndarray) -> np.ndarray:
        """Return the points (m, 3) at positions (m, 2) along and up the facade (m)."""
        return self.origin + places[:, :1] * self.along + places[:, 1:] * self.up

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


def facing_viewer(frame: Frame, own: np.ndarray, around: np.ndarray, thickness: float) -> Frame:
    """Return the frame turned so that its normal points to the side that the facade was seen from.

    Parameters
    ----------
    frame : Frame
        Of the facade, its normal to either side.
    own, around : ndarray of shape (n, 3), (m, 3)
        Points of the facade, and those of the whole cloud (m).
    thickness : float
        Points nearer to the plane than this (m) belong to the facade.

    Notes
    -----
    An opaque wall hides what is behind it. Points in front of a cell of wall are on the viewer's side (streets, cars,
    trees); points off the plane in cells without wall are seen through openings, on the other side.
    """
    own = frame.local(own)
    near = around[np.linalg.norm(around - frame.origin, axis=1) <= _FARTHEST + np.ptp(own, axis=0).max()]
    places, low = frame.local(near), own[:, :2].min(axis=0)
    cell = np.floor((places[:, :2] - low) / _CELL).astype(np.int64)
    own_cell = np.floor((own[:, :2] - low) / _CELL).astype(np.int64)
    count = own_cell.max(axis=0) + 1
    # Ground lies at the foot of the facade or a little below.
    cell[:, 1] += cell[:, 1] == -1
    inside = ((cell >= 0) & (cell < count)).all(axis=1)
    if count[0] > _LEAST_COLUMNS:
        # Walls at a right angle stand behind the ends of the facade.
        inside &= (places[:, 0] > own[:, 0].min() + _CELL) & (places[:, 0] < own[:, 0].max() - _CELL)
    off = np.abs(places[:, 2])
    inside &= (off > thickness) & (off <= _FARTHEST)
    points = np.bincount(own_cell @ [count[1], 1], minlength=int(count.prod()))
    # A cell at the rim of an opening has fewer points than half of the usual.
    is_wall = points >= 0.5 * np.median(points[points > 0])
    before = is_wall[cell[inside] @ [count[1], 1]]
    side = np.sign(places[inside, 2])
    votes = float(np.sum(np.where(before, side, -side)))
    return frame if votes >= 0 else frame_of(frame.origin, -frame.normal)


def thinned(xyz: np.ndarray, size: float = 0.1) -> np.ndarray:
    """Return the means (m, 3) of the points (n, 3) in each cube of ``size`` (m)."""
    low = xyz.min(axis=0)
    cell = np.floor((xyz - low) / size).astype(np.int64)
    shape = cell.max(axis=0) + 1
    which = distinct((cell[:, 0] * shape[1] + cell[:, 1]) * shape[2] + cell[:, 2])[1]
    count = np.bincount(which)
    return np.column_stack([np.bincount(which, column) / count for column in xyz.T])
