"""Outlines of buildings: how far two are apart, and how square one is."""

from __future__ import annotations

import numpy as np

from ..geometry.groups import items
from ..geometry.line_segments import nearest_edge_distances

# Step (m) of the positions along outlines between which a distance is measured: below the accuracy of outlines.
_STEP = 0.1

# An edge runs along a direction within this angle (°): that of an edge of 6 m whose ends lie 0.3 m apart across.
_ALONG = 3.0


def hausdorff(first: list[np.ndarray], second: list[np.ndarray]) -> float:
    """Return the greatest distance (m) from the outline of one polygon to that of the other, both ways.

    Parameters
    ----------
    first, second : list of ndarray of shape (k, 2)
        Closed rings, m. Holes are part of the outline.

    Notes
    -----
    Measured every 0.1 m and at all vertices, so that it is at most 0.05 m too small.
    """
    return max(farthest_from(positions_along(first), second), farthest_from(positions_along(second), first))


def farthest_from(positions: np.ndarray, rings: list[np.ndarray]) -> float:
    """Return the greatest distance (m) of positions (n, 2) from rings, NaN without positions."""
    return float(distances_from(positions, rings).max()) if len(positions) else np.nan


def distances_from(positions: np.ndarray, rings: list[np.ndarray]) -> np.ndarray:
    """Return the distances (n,), m, of positions (n, 2) from rings."""
    starts, ends = (np.concatenate([ring[part] for ring in rings]) for part in (slice(None, -1), slice(1, None)))
    return nearest_edge_distances(positions, starts, ends)


def positions_along(rings: list[np.ndarray]) -> np.ndarray:
    """Return positions (n, 2) along closed rings, at most 0.1 m apart, vertices among these."""
    return np.concatenate([_positions(ring) for ring in rings])


def _positions(ring: np.ndarray) -> np.ndarray:
    step = np.diff(ring, axis=0)
    edge, number = items(np.ceil(np.hypot(*step.T) / _STEP).astype(np.int64).clip(1))
    share = number / np.bincount(edge)[edge]
    return ring[edge] + share[:, None] * step[edge]


def squareness(rings: list[np.ndarray]) -> float:
    """Return the share (0 to 1) of the length of edges that run along two directions square to each other.

    The two directions are those of the polygon for which the share is greatest; edges within 3° count.
    """
    step = np.concatenate([np.diff(ring, axis=0) for ring in rings])
    length, angle = np.hypot(*step.T), np.degrees(np.arctan2(step[:, 1], step[:, 0]))
    off = np.abs((angle[:, None] - angle + 45.0) % 90.0 - 45.0)
    return float(((off <= _ALONG) * length).sum(axis=1).max() / length.sum())
