"""What stands on bridge decks."""

from __future__ import annotations

import numpy as np

from ..packages import spatial

# What stands on a bridge has points of its deck this near in plan (m), and none of its own this far (m) below them.
_NEAR, _BELOW = 2.0, 0.3


def on_decks(points: np.ndarray, deck: np.ndarray, least: float = -_BELOW) -> tuple[np.ndarray, np.ndarray]:
    """Find the points that stand on bridge decks, such as those of cars and parapets.

    Parameters
    ----------
    points : ndarray of shape (n, 3), float64
        Points that are not of a deck, m.
    deck : ndarray of shape (m, 3), float64
        Points of decks, m.
    least : float
        Least height over the deck, m; negative for what begins in its surface.

    Returns
    -------
    rows : ndarray of shape (k,), int64
        Which points stand on one.
    level : ndarray of shape (k,), float64
        Elevation of the deck there, m.
    """
    if not len(deck) or not len(points):
        return np.zeros(0, np.int64), np.zeros(0)
    distance, nearest = spatial.cKDTree(deck[:, :2]).query(points[:, :2], distance_upper_bound=_NEAR)
    rows = np.flatnonzero(np.isfinite(distance))
    level = deck[nearest[rows], 2]
    stands = points[rows, 2] >= level + least
    return rows[stands], level[stands]
