"""The points that shapes are looked for among, and what they are called afterwards."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Annotated, Optional

import numpy as np

from ..geometry.boxes import by_first_point
from ..segmentation.candidate_points import candidates
from ..stage import Param

# Segments are laid out side by side, so that no window holds points of two: this many window sides apart.
_SIDES_APART = 3.0


class Shape(IntEnum):
    """Values of the dimension ``shape``."""

    NONE = 0
    PLANE = 1
    CYLINDER = 2
    SPHERE = 3


WHOLE_CLOUD, WITHOUT_SHAPE, EACH_SEGMENT = SEARCHES = ("whole cloud", "points without a shape", "each segment")

SearchIn = Annotated[
    str,
    Param(
        "Search in",
        "What shapes are looked for in: the whole cloud, which forgets segments and shapes found before; the points "
        "that have no shape yet; or those of each segment (SegmentID) by itself, where points on which no shape is "
        "found keep their segment.",
        choices=SEARCHES,
    ),
]


@dataclass(frozen=True)
class SearchedPoints:
    """Points in an order of their own, which does not depend on that of the cloud.

    Attributes
    ----------
    rows : ndarray of shape (k,), int64
        Which point of the cloud each is.
    xyz : ndarray of shape (k, 3), float64
        Coordinates (m) from the least of the cloud, segments moved apart along x.
    shift : ndarray of shape (k,), float64
        How far (m) each was moved along x.
    origin : ndarray of shape (3,)
        What was subtracted from the coordinates of the cloud (m).
    """

    rows: np.ndarray
    xyz: np.ndarray
    shift: np.ndarray
    origin: np.ndarray

    def in_place(self, places: np.ndarray, point: int) -> np.ndarray:
        """Return places (..., 3) found beside the point numbered ``point`` in the coordinates of the cloud, m."""
        return places - np.array([self.shift[point], 0.0, 0.0]) + self.origin


def searched_points(
    xyz: np.ndarray,
    classification: np.ndarray,
    segment_id: Optional[np.ndarray],
    shape: Optional[np.ndarray],
    search_in: str,
    side: float,
) -> SearchedPoints:
    """Return the points that are neither ground, water nor noise, and belong to what is searched.

    Parameters
    ----------
    xyz, classification : ndarray of shape (n, 3) and (n,)
        The cloud.
    segment_id, shape : ndarray of shape (n,), optional
        Segments and shapes found before.
    search_in : str
        One of ``SEARCHES``.
    side : float
        Side of the largest window (m).

    Raises
    ------
    ValueError
        If segments are asked for and the cloud has none.
    """
    rows = candidates(classification, None, 0)
    if search_in != WHOLE_CLOUD and shape is not None:
        rows = rows[shape[rows] == Shape.NONE]
    if search_in == EACH_SEGMENT:
        if segment_id is None:
            raise ValueError(
                "Searching in each segment needs SegmentID; run a segmentation first, or search the whole cloud."
            )
        rows = rows[segment_id[rows] > 0]
    origin = xyz.min(axis=0)
    places = xyz[rows] - origin
    order = np.lexsort(places.T)
    rows, places = rows[order], places[order]
    shift = np.zeros(len(rows))
    if search_in == EACH_SEGMENT and segment_id is not None and len(rows):
        # Numbers of segments follow the first points in this order, as the order of the cloud must not matter.
        number = by_first_point(segment_id[rows])
        shift = number * (np.ptp(xyz[:, 0]) + _SIDES_APART * side)
        places[:, 0] += shift
    return SearchedPoints(rows, places, shift, origin)


def named(
    points: SearchedPoints,
    label: np.ndarray,
    kind: Shape,
    segment_id: Optional[np.ndarray],
    shape: Optional[np.ndarray],
    n: int,
    search_in: str,
) -> tuple[np.ndarray, np.ndarray, int]:
    """Return the dimensions ``segment_id`` and ``shape`` of a cloud in which shapes of one kind were found.

    Parameters
    ----------
    points : SearchedPoints
        The points that were searched.
    label : ndarray of shape (k,), int
        Number of the shape that each lies on, from 1; 0 is none.
    kind : Shape
        What was found.
    segment_id, shape : ndarray of shape (n,), optional
        What the cloud had before; kept but where the whole cloud was searched.
    n : int
        Points of the cloud.
    search_in : str
        One of ``SEARCHES``.

    Returns
    -------
    segment_id, shape : ndarray of shape (n,), int32 and uint8
        New numbers follow the largest one that is kept.
    first : int
        What is added to the numbers of the shapes.
    """
    ids, shapes = np.zeros(n, np.int32), np.zeros(n, np.uint8)
    if search_in == EACH_SEGMENT and segment_id is not None:
        ids[:] = segment_id
    if search_in != WHOLE_CLOUD and shape is not None:
        shapes[:] = shape
        has_shape = shape != Shape.NONE
        if segment_id is not None:
            ids[has_shape] = segment_id[has_shape]
    first = int(ids.max(initial=0))
    found = label > 0
    ids[points.rows[found]] = label[found] + first
    shapes[points.rows[found]] = kind
    return ids, shapes, first
