"""Planes in windows of a cloud by the Hough transform, one maximum of the parameter space after the other."""

import itertools
from typing import Optional

import numpy as np

from ..geometry.boxes import Boxes
from ..geometry.principal_axes import principal_axes
from ..planes.local_planes import LEAST_POINTS, REFITS
from ..planes.voxel_planes import more_than_chance
from ..stage import Monitor
from ..threads import PAIRS_AT_ONCE, in_chunks

# Counters of the largest parameter space: of 8 bytes each, for each thread.
_MOST_BINS = 20_000_000

# Angle (°) between the normals of a plane and of its points: three deviations of normals of 3°, rounded up.
_MOST_ANGLE = 10.0


class PlaneDirections:
    """The slopes of the parameter space: bins of normals on the faces of a cube around the half sphere.

    Z = s_x X + s_y Y + d has no steep planes. On each of three faces another coordinate is written as a function of the
    two others, with slopes from -1 to 1, so that planes of every direction are there once.

    Parameters
    ----------
    slope_bin : float
        Width of a bin in both slopes.

    Attributes
    ----------
    normal : ndarray of shape (m, 3)
        Unit normals of the middles of the bins.
    """

    def __init__(self, slope_bin: float) -> None:
        self.per_side = max(1, int(np.ceil(2 / slope_bin)))
        self.normal = unit(self._cube(np.arange(3 * self.per_side**2)))

    def __len__(self) -> int:
        return len(self.normal)

    def _cube(self, number: np.ndarray) -> np.ndarray:
        """Return the middles (k, 3) of bins (k,) on the faces of a cube from -1 to 1."""
        face, cell = np.divmod(number, self.per_side**2)
        slopes = (np.column_stack(np.divmod(cell, self.per_side)) + 0.5) * 2 / self.per_side - 1
        cube = np.empty((len(number), 3))
        for axis in range(3):
            on_face = face == axis
            cube[np.ix_(on_face, [axis])] = 1.0
            cube[np.ix_(on_face, [i for i in range(3) if i != axis])] = slopes[on_face]
        return cube

    def bin_of(self, normal: np.ndarray) -> np.ndarray:
        """Return the bin (n,) of unit normals (n, 3) of either sign."""
        face = np.argmax(np.abs(normal), axis=1)
        every = np.arange(len(normal))
        others = np.array([[1, 2], [0, 2], [0, 1]])[face]
        slopes = normal[every[:, None], others] / normal[every, face][:, None]
        cell = np.clip(((slopes + 1) / 2 * self.per_side).astype(np.int64), 0, self.per_side - 1)
        return (face * self.per_side + cell[:, 0]) * self.per_side + cell[:, 1]


def unit(vectors: np.ndarray) -> np.ndarray:
    """Return vectors (n, 3) of length one; zero stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


class HoughPlanes:
    """The Hough transform in the windows of a cloud.

    Parameters
    ----------
    boxes : Boxes
        The windows.
    side : float
        Side of a window, m.
    tolerance : float
        Distance within which a point lies on a plane, m.
    distance_bin : float
        Width of a bin in the distance of a plane, m.
    slope_bin : float
        Width of a bin in both slopes of a plane.

    Raises
    ------
    ValueError
        If the parameter space has too many bins for the memory.
    """

    def __init__(self, boxes: Boxes, side: float, tolerance: float, distance_bin: float, slope_bin: float) -> None:
        self.boxes, self.tolerance, self.distance_bin = boxes, tolerance, distance_bin
        self.reach = side * np.sqrt(3) / 2
        self.levels = int(np.ceil(2 * self.reach / distance_bin)) + 1
        n_bins = 3 * np.ceil(2 / slope_bin) ** 2 * self.levels
        if n_bins > _MOST_BINS:
            raise ValueError(
                f"The parameter space of a window would have {n_bins / 1e6:,.0f} million bins, more than "
                f"{_MOST_BINS / 1e6:.0f} million; take larger bins or smaller windows."
            )
        self.directions = PlaneDirections(slope_bin)
        # The largest section of a cube is the root of two times a face.
        self.by_chance = min(0.99, 2 * np.sqrt(2) * tolerance / side)
        self.trials = int(n_bins)
        self.cosine = np.cos(np.radians(_MOST_ANGLE))

    def find(self, monitor: Monitor, normals: Optional[np.ndarray] = None) -> np.ndarray:
        """Return the plane (n,), int32, of each point in the order of the boxes: from 1 in each window, or 0.

        With the normals (n, 3) of the points in this order the transform is in two steps.
        """
        plane = np.zeros(len(self.boxes.order), np.int32)

        def work(windows: np.ndarray) -> None:
            for window in windows:
                start = self.boxes.start[window]
                own = slice(start, start + self.boxes.size[window])
                xyz = self.boxes.xyz[own]
                centered = xyz - (xyz.min(axis=0) + xyz.max(axis=0)) / 2
                plane[own] = self._by_points(centered) if normals is None else self._by_normals(centered, normals[own])

        in_chunks(work, np.flatnonzero(self.boxes.size >= LEAST_POINTS), 1, monitor)
        return plane

    def _by_points(self, xyz: np.ndarray) -> np.ndarray:
        """Return the plane (k,) of each point of a window: every point votes for all planes through it."""
        plane, free = np.zeros(len(xyz), np.int32), np.arange(len(xyz))
        votes = self._votes(xyz)
        for number in itertools.count(1):
            # Planes at the border between two bins share their points among these.
            direction, level = np.divmod(int(np.argmax(votes[:, :-1] + votes[:, 1:])), self.levels - 1)
            normal = self.directions.normal[direction]
            on_plane = self._refined(xyz[free], normal, (level + 1) * self.distance_bin - self.reach)
            if not self._is_plane(on_plane.sum(), len(free)):
                break
            plane[free[on_plane]] = number
            votes -= self._votes(xyz[free[on_plane]])
            free = free[~on_plane]
        return plane

    def _votes(self, xyz: np.ndarray) -> np.ndarray:
        """Return the number of points (k, 3) on the plane of each bin (m, levels)."""
        directions = self.directions.normal
        votes = np.zeros(len(directions) * self.levels, np.int64)
        step = max(1, PAIRS_AT_ONCE // len(directions))
        for first in range(0, len(xyz), step):
            level = ((xyz[first : first + step] @ directions.T + self.reach) / self.distance_bin).astype(np.int64)
            level += np.arange(len(directions)) * self.levels
            votes += np.bincount(level.ravel(), minlength=len(votes))
        return votes.reshape(len(directions), self.levels)

    def _by_normals(self, xyz: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Return the plane (k,) of each point of a window: its normal votes for a direction, then it for a distance."""
        plane = np.zeros(len(xyz), np.int32)
        free = np.flatnonzero(normals.any(axis=1))
        bins = self.directions.bin_of(normals[free]) if len(free) else free
        for number in itertools.count(1):
            if len(free) < LEAST_POINTS:
                break
            direction = self._direction(bins)
            is_alike = np.abs(normals[free] @ direction) >= self.cosine
            alike = free[is_alike]
            if len(alike) < LEAST_POINTS:
                break
            signs = np.sign(normals[alike] @ direction)
            normal = unit((normals[alike] * signs[:, None]).sum(axis=0))
            level = ((xyz[alike] @ normal + self.reach) / self.distance_bin).astype(np.int64)
            votes = np.bincount(level, minlength=self.levels)
            distance = (int(np.argmax(votes[:-1] + votes[1:])) + 1) * self.distance_bin - self.reach
            on_plane = self._refined(xyz[alike], normal, distance)
            if self._is_plane(on_plane.sum(), len(alike)):
                plane[alike[on_plane]] = number
                gone = plane[free] > 0
            else:
                # There are many directions without a plane, as in a crown; leave the points out.
                gone = is_alike
            free, bins = free[~gone], bins[~gone]
        return plane

    def _direction(self, bins: np.ndarray) -> np.ndarray:
        """Return the maximum (3,) on the Gaussian half sphere: the bin around which most normals lie."""
        occupied, count = np.unique(bins, return_counts=True)
        normal = self.directions.normal[occupied]
        return normal[np.argmax((np.abs(normal @ normal.T) >= self.cosine) @ count)]

    def _is_plane(self, found: int, count: int) -> bool:
        """Return whether ``found`` of ``count`` points lie on a plane by more than chance."""
        return found >= LEAST_POINTS and bool(more_than_chance(found, count, self.by_chance, self.trials))

    def _refined(self, xyz: np.ndarray, normal: np.ndarray, distance: float) -> np.ndarray:
        """Return the mask of points (k,) that lie on the least-squares plane of the points around a maximum."""
        # The middle of a bin is off a plane in it by up to half a bin in distance and, at the end of the window, by
        # about as much for its slopes.
        on_plane = np.abs(xyz @ normal - distance) <= self.tolerance + self.distance_bin
        for _ in range(REFITS):
            if on_plane.sum() < LEAST_POINTS:
                return np.zeros(len(xyz), bool)
            center, _, axes = principal_axes(xyz[on_plane])
            on_plane = np.abs((xyz - center) @ axes[:, 0]) <= self.tolerance
        return on_plane
