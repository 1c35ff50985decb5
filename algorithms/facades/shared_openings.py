"""Openings that belong to one wall only: where walls overlap or lie behind each other, each is drawn once."""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..packages import spatial
from .facade_surfaces import Facade
from .opening_search import Opening

# Openings that share this part of the points of one, or of its area, are one opening seen through two walls.
_SHARED = 0.5

# Walls whose normals enclose less than this angle (cosine: 20°) face the same way.
_SAME_WAY = np.cos(np.radians(20.0))

# A position lies on a wall with a point within this distance (spacings of the wall), as raster cells are counted.
_ON_WALL = 1.5

# Positions along and up an opening at which a wall is looked for before it.
_STEPS = 8

Found = list[tuple[Facade, list[Opening]]]


def drawn_once(found: Found, xyz: np.ndarray, max_depth: float) -> Found:
    """Return facades with their openings, without those that another wall hides or has as well.

    Of two openings that are the same the one with more wall around it is kept.

    Parameters
    ----------
    found : list of tuple of (Facade, list of Opening)
        Facades with all openings that were found in each for itself.
    xyz : ndarray of shape (n, 3)
        The whole cloud (m).
    max_depth : float
        How far (m) behind a wall its openings reach.
    """
    walls = [_Wall(facade, xyz) for facade, _ in found]
    candidates = [(own, opening) for own, (_, openings) in enumerate(found) for opening in openings]
    candidates.sort(key=lambda one: (-one[1].enclosed, -float(np.prod(one[1].size))))
    taken = np.zeros(len(xyz), bool)
    kept: list[list[Opening]] = [[] for _ in found]
    for own, opening in candidates:
        ring = found[own][0].frame.space(opening.ring)
        others = [wall for k, wall in enumerate(walls) if k != own and wall.faces_as(walls[own])]
        is_hidden = any(wall.hides(ring, max_depth) for wall in others)
        is_drawn = taken[opening.points].mean() >= _SHARED or any(wall.has(ring, max_depth) for wall in others)
        if not is_hidden and not is_drawn:
            kept[own].append(opening)
            walls[own].boxes.append(opening.box)
            taken[opening.points] = True
    return [
        (facade, [opening for opening in openings if any(opening is one for one in chosen)])
        for (facade, openings), chosen in zip(found, kept)
    ]


class _Wall:
    """A facade, its points in its plane, and the boxes of the openings that are drawn in it."""

    def __init__(self, facade: Facade, xyz: np.ndarray) -> None:
        self.facade = facade
        self.tree = spatial.cKDTree(facade.frame.local(xyz[facade.points])[:, :2])
        self.boxes: list[np.ndarray] = []

    def faces_as(self, other: _Wall) -> bool:
        """Return whether two walls face the same way."""
        return bool(self.facade.frame.normal @ other.facade.frame.normal >= _SAME_WAY)

    def _box(self, ring: np.ndarray, max_depth: float, nearest: float) -> Optional[np.ndarray]:
        """Return the box (2, 2) of a ring (m, 3) that is from ``nearest`` to a depth (m) behind the wall, else None."""
        local = self.facade.frame.local(ring)
        off = -float(local[:, 2].mean())
        return np.array([local[:, :2].min(axis=0), local[:, :2].max(axis=0)]) if nearest <= off <= max_depth else None

    def hides(self, ring: np.ndarray, max_depth: float) -> bool:
        """Return whether the wall lies before most of an opening (m, 3) of another one."""
        box = self._box(ring, max_depth, 3 * self.facade.rms)
        if box is None:
            return False
        share = (np.arange(_STEPS) + 0.5) / _STEPS
        along, up = np.meshgrid(*(box[0] + share[:, None] * (box[1] - box[0])).T)
        off = self.tree.query(np.column_stack([along.ravel(), up.ravel()]))[0]
        return bool(np.mean(off <= _ON_WALL * self.facade.spacing) > _SHARED)

    def has(self, ring: np.ndarray, max_depth: float) -> bool:
        """Return whether an opening of another wall is one that is drawn in this one."""
        box = self._box(ring, max_depth, -max_depth)
        if box is None or not self.boxes:
            return False
        own = np.array(self.boxes)
        shared = np.clip(np.minimum(own[:, 1], box[1]) - np.maximum(own[:, 0], box[0]), 0, None).prod(axis=1)
        smaller = np.minimum((own[:, 1] - own[:, 0]).prod(axis=1), (box[1] - box[0]).prod())
        return bool((shared >= _SHARED * smaller).any())
