"""Corners of buildings, and which corners of two layers are the same."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..criteria import MILLIMETER
from ..geometry.grid import find_cells
from ..packages import spatial
from ..stage import Monitor

# A vertex at which the outline turns by less is no corner but a point on a straight or round wall, degrees.
_LEAST_TURN = 20.0

# Largest difference in direction between corners, or walls, that can be the same, degrees.
FACING = 60.0

# Search radius (m) for walls, and for corners before the tolerance is known; most walls are longer.
FARTHEST = 3.0

# Automatic tolerances (medians of the differences): where errors are normal, 99.8 % of distances in plan are less, and
# 96 % of differences in height.
MEDIANS = 3.0

# Least and greatest automatic tolerance (m): half of a short wall, and a room. Smaller changes are not built, and
# corners that have moved since the map was made are still matched. Larger differences are changes even where most
# buildings have changed.
LEAST_TOLERANCE, MOST_TOLERANCE = 1.0, 4.0

# Pairs farther apart than this share of the farthest are by chance.
_FAR_OFF = 2 / 3


@dataclass(frozen=True)
class Corners:
    """Corners (n, 2) of polygons, the polygon of each, the unit vector that it faces, and the number of polygons."""

    xy: np.ndarray
    building: np.ndarray
    facing: np.ndarray
    count: int

    @property
    def counts(self) -> np.ndarray:
        """Number of corners (count,) of each polygon."""
        return np.bincount(self.building, minlength=self.count)


@dataclass(frozen=True)
class MatchedCorners:
    """Corners of an old and of a new layer, and which of them are the same."""

    old: Corners
    new: Corners
    #: one, other, (k,), int64: rows of the corners of each pair in ``old`` and in ``new``
    one: np.ndarray
    other: np.ndarray

    @property
    def moved(self) -> np.ndarray:
        """Displacements (k, 2) of the corners of the old layer, m."""
        return self.new.xy[self.other] - self.old.xy[self.one]

    def of_buildings(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return for old buildings (n,) the number of matched corners, and their mean and greatest distance (m)."""
        building, distance, count = self.old.building[self.one], np.hypot(*self.moved.T), self.old.count
        matched = np.bincount(building, minlength=count)
        mean = np.where(matched > 0, np.bincount(building, distance, count) / np.maximum(matched, 1), np.nan)
        farthest = np.full(count, np.nan)
        np.fmax.at(farthest, building, distance)
        return matched, mean, farthest


def corners_of(polygons: list) -> Corners:
    """Return the corners of polygons: the vertices at which their outlines turn."""
    every = [(number, ring) for number, rings in enumerate(polygons) for ring in rings]
    found = [(number, *_turns(ring)) for number, ring in every]
    counts = [len(xy) for _, xy, _ in found]
    return Corners(
        np.concatenate([np.zeros((0, 2)), *(xy for _, xy, _ in found)]),
        np.repeat([number for number, *_ in found], counts).astype(np.int64),
        np.concatenate([np.zeros((0, 2)), *(facing for *_, facing in found)]),
        len(polygons),
    )


def _turns(ring: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of a closed ring, and the way each faces."""
    step = np.diff(ring, axis=0)
    is_long = np.hypot(*step.T) > MILLIMETER
    xy, step = ring[:-1][is_long], step[is_long]
    after = step / np.hypot(*step.T)[:, None]
    before = np.roll(after, 1, axis=0)
    turn = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], (before * after).sum(axis=1))
    chosen = np.abs(turn) >= np.deg2rad(_LEAST_TURN)
    facing = (before - after)[chosen]
    return xy[chosen], facing / np.hypot(*facing.T)[:, None]


def match_corners(
    old: Corners, new: Corners, same: tuple, shift: np.ndarray, tolerance: Optional[float], monitor: Monitor
) -> MatchedCorners:
    """Return the corners of the same buildings matched one to one.

    Parameters
    ----------
    old, new : Corners
        Corners of two layers.
    same : tuple of ndarray of shape (k,), int64
        Buildings of the one and of the other that are the same, in this order.
    shift : ndarray of shape (2,)
        By how much the new layer is off the old one, m.
    tolerance : float, optional
        Corners farther apart after the shift (m) are not the same; None for an automatic one.
    monitor : Monitor
        Receives the automatic tolerance.
    """
    one, other, distance = nearest_corners(old, new, same, shift, max(FARTHEST, tolerance or 0.0))
    if tolerance is None:
        tolerance = float(np.clip(MEDIANS * typical_distance(distance), LEAST_TOLERANCE, FARTHEST))
        monitor.resolved(tolerance=tolerance)
    near = distance <= tolerance
    return MatchedCorners(old, new, one[near], other[near])


def typical_distance(distance: np.ndarray) -> float:
    """Return the median of the distances (up to 3 m) that are not by chance, 0 without any."""
    # Random pairs are spread evenly in plan; their density shows at far distances, where no true pairs are left.
    ordered = np.sort(distance) / FARTHEST
    by_chance = min(float((ordered > _FAR_OFF).sum() / (1 - _FAR_OFF**2)), len(ordered))
    others = np.arange(1, len(ordered) + 1) - by_chance * ordered**2
    reached = np.flatnonzero(others >= (len(ordered) - by_chance) / 2)
    return float(ordered[reached[0]]) * FARTHEST if len(reached) else 0.0


def nearest_corners(
    old: Corners, new: Corners, same: tuple[np.ndarray, np.ndarray], shift: np.ndarray, reach: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return pairs of corners within ``reach`` (m) that can be the same, each corner once, the nearest pairs first.

    Parameters
    ----------
    old, new : Corners
        Corners of two layers.
    same : tuple of ndarray of shape (k,), int64
        Buildings of the one and of the other that are the same, in this order.
    shift : ndarray of shape (2,)
        By how much the new layer is off the old one, m.
    reach : float
        Greatest distance, m.

    Returns
    -------
    one, other : ndarrays of shape (k,), int64
        Rows of the corners of each pair in ``old`` and in ``new``.
    distance : ndarray of shape (k,)
        Distance between them after the shift, m.
    """
    if not len(same[0]) or not len(old.xy) or not len(new.xy):
        return np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0)
    trees = spatial.cKDTree(old.xy + shift), spatial.cKDTree(new.xy)
    near = trees[0].sparse_distance_matrix(trees[1], reach, output_type="ndarray")
    one, other, distance = near["i"], near["j"], near["v"]
    count = int(max(same[1].max(), new.building.max())) + 1
    linked = find_cells(same[0] * count + same[1], old.building[one] * count + new.building[other])[1]
    alike = linked & ((old.facing[one] * new.facing[other]).sum(axis=1) >= np.cos(np.deg2rad(FACING)))
    one, other, distance = one[alike], other[alike], distance[alike]
    order = np.lexsort((other, one, distance))
    taken: tuple[set, set] = set(), set()
    kept = []
    for row, i, j in zip(order.tolist(), one[order].tolist(), other[order].tolist()):
        if i not in taken[0] and j not in taken[1]:
            taken[0].add(i)
            taken[1].add(j)
            kept.append(row)
    return one[kept], other[kept], distance[kept]
