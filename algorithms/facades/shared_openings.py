"""Openings that belong to one wall only: where walls overlap or lie behind each other, each is drawn once."""

from __future__ import annotations

import numpy as np

from ..packages import spatial
from .facade_surfaces import Facade
from .opening_search import OFF_WALL, Opening

# An opening is left out where others have this share of its points, as it is one of them seen through another wall.
# It is left out, too, where a wall lies in front of more than this share of it. Half is the greater part of both.
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

    Of two openings that are the same the one with more wall around it is kept. Openings reach ``max_depth`` (m) behind
    their wall; ``xyz`` (n, 3), m, is the whole cloud.
    """
    walls = [_Wall(facade, xyz) for facade, _ in found]
    normals = np.array([facade.frame.normal for facade, _ in found]).reshape(-1, 3)
    candidates = [(own, opening) for own, (_, openings) in enumerate(found) for opening in openings]
    candidates.sort(key=lambda one: (-one[1].enclosed, -float(np.prod(one[1].size))))
    taken = np.zeros(len(xyz), bool)
    kept: list[list[Opening]] = [[] for _ in found]
    for own, opening in candidates:
        frame = found[own][0].frame
        ring, faces_as = frame.space(opening.ring), normals @ frame.normal >= _SAME_WAY
        others = [wall for k, wall in enumerate(walls) if k != own and faces_as[k]]
        is_drawn = taken[opening.points].mean() >= _SHARED
        if not is_drawn and not any(wall.hides(ring, max_depth) for wall in others):
            kept[own].append(opening)
            taken[opening.points] = True
    return [
        (facade, [opening for opening in openings if any(opening is one for one in chosen)])
        for (facade, openings), chosen in zip(found, kept)
    ]


class _Wall:
    """A facade and its points in its plane."""

    def __init__(self, facade: Facade, xyz: np.ndarray) -> None:
        self.facade = facade
        self.tree = spatial.cKDTree(facade.frame.local(xyz[facade.points])[:, :2])

    def hides(self, ring: np.ndarray, max_depth: float) -> bool:
        """Return whether the wall lies before most of an opening (m, 3) of another one."""
        local = self.facade.frame.local(ring)
        if not OFF_WALL * self.facade.rms <= -local[:, 2].mean() <= max_depth:
            return False
        low, size = local[:, :2].min(axis=0), np.ptp(local[:, :2], axis=0)
        share = (np.arange(_STEPS) + 0.5) / _STEPS
        along, up = np.meshgrid(*(low + share[:, None] * size).T)
        off = self.tree.query(np.column_stack([along.ravel(), up.ravel()]))[0]
        return bool(np.mean(off <= _ON_WALL * self.facade.spacing) > _SHARED)
