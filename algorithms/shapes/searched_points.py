"""The points among which shapes are searched, and the numbers that these get."""

from dataclasses import dataclass
from enum import IntEnum
from typing import Callable, Generic, Optional, Protocol, TypeVar

import numpy as np

from ..criteria import DEVIATIONS
from ..geometry.boxes import by_first_point
from ..sampling.cloud_sampling import CloudSampling
from ..segmentation.candidate_points import candidates
from ..stage import Monitor, tunable
from .search_settings import check_radii, point_noise
from .shape_windows import WINDOW
from .surface_normals import normal_points, normals_of

# Segments are moved apart by this many window sides, so that no window holds points of two.
_SIDES_APART = 3.0


class Shape(IntEnum):
    """Values of the dimension ``shape``."""

    NONE = 0
    PLANE = 1
    CYLINDER = 2
    SPHERE = 3


WHOLE_CLOUD, WITHOUT_SHAPE, EACH_SEGMENT = SEARCHES = ("whole cloud", "points without a shape", "each segment")

SEARCH_IN = tunable(
    WHOLE_CLOUD,
    "Points to search: the whole cloud, whose segments and shapes found before are discarded; the points without "
    "a shape; or the points of each segment (SegmentID) by themselves. There, points on which no shape is found keep "
    "their segment.",
    choices=SEARCHES,
)


class FoundShape(Protocol):
    """Attributes that found shapes of all kinds have."""

    @property
    def points(self) -> np.ndarray:
        """Which of the searched points (k,) lie on it."""


F = TypeVar("F", bound=FoundShape)


@dataclass(frozen=True)
class SearchedPoints:
    """Points in an order of their own, which does not depend on the cloud's."""

    rows: np.ndarray  #: (k,), int64: which point of the cloud each is
    xyz: np.ndarray  #: (k, 3), float64: coordinates (m) from ``origin``, segments moved apart along x
    shift: np.ndarray  #: (k,), float64: how far (m) each was moved along x
    origin: np.ndarray  #: (3,): offset that was subtracted from the coordinates of the cloud (m)

    def in_place(self, positions: np.ndarray, point: int) -> np.ndarray:
        """Return positions (..., 3) found next to the point numbered ``point`` in the coordinates of the cloud, m."""
        return positions - np.array([self.shift[point], 0.0, 0.0]) + self.origin


@dataclass(frozen=True)
class SearchedCloud:
    """A cloud and what was found in it before, and which of its points are searched."""

    #: xyz, classification, (n, 3) and (n,): coordinates, m, and classes
    xyz: np.ndarray
    classification: np.ndarray
    #: segment_id, shape, (n,): segments and shapes found before
    segment_id: Optional[np.ndarray]
    shape: Optional[np.ndarray]
    search_in: str  #: One of ``SEARCHES``

    def points(self, side: float, corner: Optional[np.ndarray] = None) -> SearchedPoints:
        """Return the points that may be of objects by their class, and belong to the searched segments.

        Parameters
        ----------
        side : float
            Side of the largest window (m).
        corner : ndarray of shape (2,), optional
            Where windows begin in plan (m): coordinates are then from a corner of a window. Segments are moved apart by
            whole windows, so that a part of a cloud has the windows of the whole. Elevation 0 is at half the height of
            a window.

        Raises
        ------
        ValueError
            If segments are asked for and the cloud has none.
        """
        rows = candidates(self.classification, None, 0)
        if self.search_in != WHOLE_CLOUD and self.shape is not None:
            rows = rows[self.shape[rows] == Shape.NONE]
        if self.search_in == EACH_SEGMENT:
            if self.segment_id is None:
                raise ValueError(
                    "Searching in each segment needs SegmentID; run a segmentation first, or search the whole cloud."
                )
            rows = rows[self.segment_id[rows] > 0]
        origin, apart = self.xyz.min(axis=0), np.ptp(self.xyz[:, 0]) + _SIDES_APART * side
        if corner is not None:
            start = np.append(corner, side / 2)
            origin, apart = start + np.floor((origin - start) / side) * side, np.ceil(apart / side + 1) * side
        positions = self.xyz[rows] - origin
        order = np.lexsort(positions.T)
        rows, positions = rows[order], positions[order]
        shift = np.zeros(len(rows))
        if self.search_in == EACH_SEGMENT and self.segment_id is not None and len(rows):
            # Numbers of segments follow the first points in this order, as the order of the cloud must not matter.
            shift = by_first_point(self.segment_id[rows]) * apart
            positions[:, 0] += shift
        return SearchedPoints(rows, positions, shift, origin)

    def numbered(self, points: SearchedPoints, label: np.ndarray, kind: Shape) -> tuple[np.ndarray, np.ndarray, int]:
        """Return the dimensions ``segment_id`` and ``shape`` of the cloud in which shapes of one kind were found.

        A search of the whole cloud discards both dimensions of before. One of the points without a shape keeps the ids
        of points with a shape; a search in each segment keeps all.

        Parameters
        ----------
        points : SearchedPoints
            The points that were searched.
        label : ndarray of shape (k,), int
            Number of the shape that each lies on, from 1; 0 if unassigned.
        kind : Shape
            Shape found at each point.

        Returns
        -------
        segment_id, shape : ndarray of shape (n,), int32 and uint8
            New numbers follow the largest one that is kept.
        offset : int
            Number that is added to the numbers of the shapes.
        """
        ids, shapes = np.zeros(len(self.xyz), np.int32), np.zeros(len(self.xyz), np.uint8)
        if self.search_in == EACH_SEGMENT and self.segment_id is not None:
            ids[:] = self.segment_id
        if self.search_in != WHOLE_CLOUD and self.shape is not None:
            shapes[:] = self.shape
            has_shape = self.shape != Shape.NONE
            if self.segment_id is not None:
                ids[has_shape] = self.segment_id[has_shape]
        offset = int(ids.max(initial=0))
        found = label > 0
        ids[points.rows[found]] = label[found] + offset
        shapes[points.rows[found]] = kind
        return ids, shapes, offset


@dataclass(frozen=True)
class MeasuredPoints:
    """Searched points with their normals, and how exact they are."""

    #: xyz, normals, (k, 3): searched points (m), sorted by elevation, and their unit normals; zero if undefined
    xyz: np.ndarray
    normals: np.ndarray
    noise: float  #: Standard deviation across smooth surfaces, m
    tolerance: float  #: Distance within which a point lies on a surface, m
    spacing: float  #: Distance between points on surfaces, m
    shift: np.ndarray  #: (k,): how far each point was moved along x, m, as segments are searched apart


@dataclass(frozen=True)
class SearchResult(Generic[F]):
    """Shapes of one kind in a cloud."""

    #: segment_id, shape, (n,), int32 and uint8: the dimensions of the cloud
    segment_id: np.ndarray
    shape: np.ndarray
    shapes: list[F]  #: The shapes, by number
    numbers: list[int]  #: Their numbers in ``segment_id``
    points: SearchedPoints  #: The points that were searched


@dataclass(frozen=True)
class SearchTunables:
    """Tunables of all searches for shapes; None is automatic."""

    min_radius: Optional[float]
    max_radius: Optional[float]
    tolerance: Optional[float]
    n_neighbors: Optional[int]


def search_shapes(
    cloud: SearchedCloud,
    kind: Shape,
    search: Callable[[MeasuredPoints, float, float, Monitor], list[F]],
    tunables: SearchTunables,
    sampling: CloudSampling,
    monitor: Monitor,
) -> SearchResult[F]:
    """Find the shapes of one kind in a cloud and number them in the order of their first points.

    Parameters
    ----------
    cloud : SearchedCloud
        The cloud.
    kind : Shape
        Kind of the shapes.
    search : callable
        Returns the shapes among points, for the least and the largest radius (m).
    tunables : SearchTunables
        Tunables of the stages.
    sampling : CloudSampling
        How the cloud was sampled.
    monitor : Monitor
        Receives automatic values, a warning where nothing is found, and progress.

    Returns
    -------
    SearchResult
        The shapes, and the numbers of the points.

    Raises
    ------
    ValueError
        If the range of radii is empty, segments are asked for and missing, or all points lie on one line.
    """
    spacing = 1 / float(np.sqrt(sampling.surface_density))
    noise = point_noise(sampling)
    tolerance = DEVIATIONS * noise if tunables.tolerance is None else tunables.tolerance
    min_radius, max_radius = check_radii(tunables.min_radius, tunables.max_radius, noise, spacing, cloud.xyz)
    n_neighbors = normal_points(sampling) if tunables.n_neighbors is None else tunables.n_neighbors
    monitor.resolved(tolerance=tolerance, min_radius=min_radius, max_radius=max_radius, n_neighbors=n_neighbors)
    normals = normals_of(cloud.xyz, n_neighbors, sampling, monitor.part(0, 0.2))
    points = cloud.points(WINDOW * max_radius)
    label, found = np.zeros(len(points.rows), np.int64), []
    if len(points.rows):
        # A tolerance set by the user implies a noise.
        noise = max(noise, tolerance / DEVIATIONS)
        around = MeasuredPoints(points.xyz, normals[points.rows], noise, tolerance, spacing, points.shift)
        found = search(around, min_radius, max_radius, monitor.part(0.2, 1))
    for number, one in enumerate(found, start=1):
        label[one.points] = number
    if not found:
        monitor.none_found(f"No {kind.name.lower()} was found; no point got a new SegmentID.")
    inside = label > 0
    old, label[inside] = label[inside], by_first_point(label[inside]) + 1
    order = sorted(dict(zip(label[inside].tolist(), old.tolist())).items())
    ids, shapes, offset = cloud.numbered(points, label, kind)
    return SearchResult(ids, shapes, [found[n - 1] for _, n in order], [n + offset for n, _ in order], points)
