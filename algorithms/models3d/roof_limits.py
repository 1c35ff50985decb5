"""Distances of models from the points of a roof, and the heights that these allow."""

import numpy as np

from ..packages import spatial

# Points within this distance (m) in plan limit the height of a corner: ridges and eaves are sampled that closely.
RADIUS = 1.5

# A roof point farther from the model than this (m), or a corner that is as much higher than the points around, is off:
# more than any noise, less than half a storey.
OFF = 0.5


def share_off(off: np.ndarray) -> float:
    """Return the share of distances (m) that are off the model, NaN without any."""
    return float(np.mean(np.abs(off) > OFF)) if len(off) else np.nan


class HeightsAround:
    """The heights up to which the points ``xyz`` (n, 3) of a building allow a roof."""

    def __init__(self, xyz: np.ndarray) -> None:
        self._z = xyz[:, 2]
        self._tree = spatial.cKDTree(xyz[:, :2])

    def highest(self, xy: np.ndarray) -> np.ndarray:
        """Return the height (k,), m, that a roof may have at positions (k, 2), infinite far from points."""
        found = self._tree.query_ball_point(xy, RADIUS)
        return np.array([self._z[rows].max() if rows else np.inf for rows in found]) + OFF
