"""Walls in plan: directed segments with the outside on their right, of facades and of footprints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.polygons import area_vector
from ..geometry.rings import sides_of_rings, signed_area
from ..stage import LayerFeatures

# Most heights at which the ends of a wall are looked at.
_HEIGHTS = 500


@dataclass(frozen=True)
class PlanSegments:
    """Directed segments in plan, with the building on their left."""

    #: start, end, (k, 2): ends, m
    start: np.ndarray
    end: np.ndarray
    owner: np.ndarray  #: (k,): facade or footprint, from 0, of each

    def __len__(self) -> int:
        return len(self.start)

    @property
    def length(self) -> np.ndarray:
        """Lengths (k,), m."""
        return np.hypot(*(self.end - self.start).T)

    @property
    def way(self) -> np.ndarray:
        """Unit vectors (k, 2) from start to end."""
        return (self.end - self.start) / self.length[:, None]

    @property
    def normal(self) -> np.ndarray:
        """Unit vectors (k, 2) to the outside."""
        x, y = self.way.T
        return np.column_stack([y, -x])

    def across(self, step: int) -> np.ndarray:
        """Return how far (k,), m, the segment before (-1) or after (1) each one in its ring extends square to it."""
        beside = np.arange(len(self)) + step
        for owner in np.unique(self.owner):
            own = np.flatnonzero(self.owner == owner)
            beside[own] = np.roll(own, -step)
        return np.abs(((self.end - self.start)[beside] * self.normal).sum(axis=1))

    def moved(self, shift: np.ndarray) -> PlanSegments:
        """Return the segments moved by a vector (2,), m."""
        return PlanSegments(self.start + shift, self.end + shift, self.owner)


def facade_segments(facades: LayerFeatures) -> PlanSegments:
    """Return the segment of each polygon with heights that is not level, at the middle of its height.

    Polygons run counterclockwise seen from outside, as "Extract facades" draws them. A wall ends where it does over
    most of its height: a car before its foot or leaves at its top do not make it longer.
    """
    ends = []
    for number, rings in enumerate(facades.geometries):
        ring = np.asarray(rings[0], float)
        if ring.shape[1] < 3:
            continue
        normal = area_vector(ring)
        across = np.hypot(*normal[:2])
        if across <= 1e-9:
            continue
        along = np.array([-normal[1], normal[0]]) / across
        middle = (ring[:, 2].min() + ring[:, 2].max()) / 2
        # The foot of the perpendicular from the first vertex, carried up or down the plane to the middle.
        base = ring[0, :2] - normal[:2] / across**2 * normal[2] * (middle - ring[0, 2])
        low, high = _ends((ring[:, :2] - base) @ along, ring[:, 2])
        ends.append((base + low * along, base + high * along, number))
    start, end, owner = zip(*ends) if ends else ((), (), ())
    return PlanSegments(np.array(start).reshape(-1, 2), np.array(end).reshape(-1, 2), np.array(owner, int))


def _ends(position: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return the first and last position (2,) of a closed ring (m,), in the median over its height ``z`` (m,), m."""
    levels = np.unique(z)
    # Some hundred heights show the median; a boundary of key points has thousands, each with all edges.
    levels = levels[np.linspace(0, len(levels) - 1, min(len(levels), _HEIGHTS)).astype(int)]
    middle, height = (levels[1:] + levels[:-1]) / 2, np.diff(levels)
    crosses = (z[:-1] > middle[:, None]) != (z[1:] > middle[:, None])
    rise = np.where(z[1:] == z[:-1], 1.0, z[1:] - z[:-1])
    at = position[:-1] + (middle[:, None] - z[:-1]) / rise * np.diff(position)
    found = []
    for ends in (np.where(crosses, at, np.inf).min(axis=1), np.where(crosses, at, -np.inf).max(axis=1)):
        order = np.argsort(ends, kind="stable")
        found.append(ends[order][np.searchsorted(np.cumsum(height[order]), height.sum() / 2)])
    return np.array(found)


def outline_segments(footprints: LayerFeatures) -> PlanSegments:
    """Return the edges of the exterior rings of footprints."""
    rings = [exterior(polygon) for polygon in footprints.geometries]
    count = np.array([len(ring) - 1 for ring in rings], int)
    start, end = np.moveaxis(sides_of_rings(rings), 1, 0)
    return PlanSegments(start, end, np.repeat(np.arange(len(rings)), count))


def exterior(rings: list) -> np.ndarray:
    """Return the exterior in plan, counterclockwise and without vertices that follow another one at once."""
    ring = np.asarray(rings[0], float)[:, :2]
    ring = ring if signed_area(ring) > 0 else ring[::-1]
    corners = ring[:-1][np.hypot(*np.diff(ring, axis=0).T) > 1e-6]
    return np.concatenate([corners, corners[:1]])
