"""How high roofs may reach: no higher than the points around."""

from __future__ import annotations

import numpy as np

from ..packages import spatial

# Distance (m) in plan within which points limit the height of a corner: ridges and eaves are sampled that closely.
RADIUS = 1.5

# Height (m) above the highest of these points up to which a corner may lie: noise is less.
_ABOVE = 0.5


class HeightsAround:
    """The heights up to which the points ``xyz`` (n, 3) of a building allow a roof."""

    def __init__(self, xyz: np.ndarray) -> None:
        self._z = xyz[:, 2]
        self._tree = spatial.cKDTree(xyz[:, :2])

    def highest(self, xy: np.ndarray) -> np.ndarray:
        """Return the height (k,), m, that a roof may have at positions (k, 2), infinite far from points."""
        found = self._tree.query_ball_point(xy, RADIUS, return_sorted=False)
        count = np.array([len(rows) for rows in found])
        rows = np.concatenate([np.asarray(some, int) for some in found if some] or [np.zeros(0, int)])
        highest = np.full(len(xy), np.inf)
        is_near = count > 0
        if is_near.any():
            start = np.cumsum(count[is_near]) - count[is_near]
            highest[is_near] = np.maximum.reduceat(self._z[rows], start)
        return highest + _ABOVE
