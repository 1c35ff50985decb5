"""Two layers of polygons compared building by building, and how regular the outlines of one layer are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.line_segments import nearest_edge_distances
from ..geometry.polygon_overlap import as_polygons, overlaps
from ..geometry.ring_directions import along_two_directions
from ..geometry.rings import sampled_rings, sides_of_rings
from ..stage import Monitor

# Step (m) of the samples between which the distance of two outlines is measured: below the accuracy of outlines.
_STEP = 0.1

# A corner with a smaller inner or outer angle (°) is sharp. Buildings have such corners at acute sites only.
_SHARP = 70.0


@dataclass(frozen=True)
class Matches:
    """The polygons of one layer, each beside the one of another layer that it overlaps most."""

    #: one, other, (k,), int64: positions in the two layers
    one: np.ndarray
    other: np.ndarray
    iou: np.ndarray  #: (k,): intersection over union, 0 to 1


@dataclass(frozen=True)
class Regularity:
    """How regular the outlines of a layer are."""

    along: float  #: Share of the length of all edges along the two main directions of their own building, 0 to 1
    sharp: float  #: Share of the corners with an angle below 70°
    per_100_m: float  #: Vertices per 100 m of outline


def match_polygons(first: list, second: list, monitor: Monitor) -> Matches:
    """Return for each polygon of the first layer the one of the second with the greatest intersection over union.

    Parameters
    ----------
    first, second : list of list of ndarray
        Polygons as closed rings (k, 2), m, the exterior first.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    Matches
        Polygons that overlap no other one are left out.
    """
    polygons = as_polygons(first), as_polygons(second)
    one, other, shared = overlaps(*polygons, monitor)
    iou = shared / (polygons[0].area[one] + polygons[1].area[other] - shared)
    order = np.lexsort((other, -iou, one))
    order = order[shared[order] > 0]
    best = order[np.unique(one[order], return_index=True)[1]]
    return Matches(one[best], other[best], iou[best])


def one_to_one(first: list, second: list, monitor: Monitor, least: float = 0.5) -> int:
    """Return how many polygons of the second layer are one polygon of the first: their IoU exceeds ``least``.

    Parameters
    ----------
    first : list
        Polygons of the first layer.
    second : list
        Polygons of the second layer.
    monitor : Monitor
        Receives the progress.
    least : float
        Least IoU, 0 to 1.
    """
    return int((match_polygons(second, first, monitor).iou > least).sum())


def hausdorff(first: list[np.ndarray], second: list[np.ndarray]) -> float:
    """Return the greatest distance (m) from the outline of one polygon to that of the other, both ways."""
    return max(_farthest(first, second), _farthest(second, first))


def polis(first: list[np.ndarray], second: list[np.ndarray]) -> float:
    """Return the mean distance (m) of the vertices of polygons from the other's outline, in the mean of both ways."""
    ways = (first, second), (second, first)
    return float(
        np.mean([distances_from(np.concatenate([ring[:-1] for ring in one]), other).mean() for one, other in ways])
    )


def _farthest(rings: list[np.ndarray], others: list[np.ndarray]) -> float:
    return float(distances_from(positions_along(rings), others).max())


def distances_from(positions: np.ndarray, rings: list[np.ndarray]) -> np.ndarray:
    """Return the distances (n,), m, of positions (n, 2) from rings."""
    starts, ends = np.moveaxis(sides_of_rings(rings), 1, 0)
    return nearest_edge_distances(positions, starts, ends)


def positions_along(rings: list[np.ndarray]) -> np.ndarray:
    """Return positions (n, 2) along closed rings, at most 0.1 m apart, vertices among these."""
    return sampled_rings(rings, _STEP)


def squareness(rings: list[np.ndarray]) -> float:
    """Return the share (0 to 1) of the length of a polygon's edges along two directions that are square to each other.

    The two directions are those for which the share is greatest, within 3°.
    """
    length, angle = _polar(np.concatenate([np.diff(ring, axis=0) for ring in rings]))
    return along_two_directions(length, angle) / float(length.sum())


def regularity(geometries: list) -> Regularity:
    """Return how regular polygons, each a list of closed rings (k, 2), are."""
    own, total, sharp, corners = 0.0, 0.0, 0, 0
    for rings in geometries:
        sides = [np.diff(ring, axis=0) for ring in rings]
        length, angle = _polar(np.concatenate(sides))
        own += along_two_directions(length, angle)
        total += float(length.sum())
        turns = np.concatenate([_turns(ring) for ring in sides])
        sharp += int((np.abs(turns) > 180.0 - _SHARP).sum())
        corners += len(turns)
    if not corners:
        return Regularity(np.nan, np.nan, np.nan)
    return Regularity(own / total, sharp / corners, 100.0 * corners / total)


def _polar(sides: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return lengths (m) and directions (°) of edges (n, 2)."""
    return np.hypot(*sides.T), np.degrees(np.arctan2(sides[:, 1], sides[:, 0]))


def _turns(sides: np.ndarray) -> np.ndarray:
    """Return by how much (°, -180 to 180) a ring of edges (n, 2) turns after each."""
    angle = _polar(sides)[1]
    return (np.roll(angle, -1) - angle + 180.0) % 360.0 - 180.0
