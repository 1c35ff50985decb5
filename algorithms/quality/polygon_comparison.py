"""Compare two layers of polygons building by building, and measure the squareness of outlines."""

import numpy as np

from ..geometry.ring_directions import along_two_directions
from ..geometry.rings import distances_to_rings, sampled_rings


def hausdorff(first: list[np.ndarray], second: list[np.ndarray]) -> float:
    """Return the greatest distance (m) between the outlines of two polygons, both ways."""
    return max(_farthest(first, second), _farthest(second, first))


def polis(first: list[np.ndarray], second: list[np.ndarray]) -> float:
    """Return the mean distance (m) of the vertices of polygons from the other's outline, in the mean of both ways."""
    found = []
    for one, other in ((first, second), (second, first)):
        corners = np.concatenate([ring[:-1] for ring in one])
        found.append(distances_to_rings(corners, other).mean())
    return float(np.mean(found))


def _farthest(rings: list[np.ndarray], others: list[np.ndarray]) -> float:
    return float(distances_to_rings(positions_along(rings), others).max())


def positions_along(rings: list[np.ndarray]) -> np.ndarray:
    """Return positions (n, 2) along closed rings, at most 0.1 m apart, vertices among these.

    The accuracy of outlines is lower.
    """
    return sampled_rings(rings, 0.1)


def squareness(rings: list[np.ndarray]) -> float:
    """Return the share (0 to 1) of the length of a polygon's edges along two directions that are square to each other.

    The two directions are those for which the share is greatest, within 3°.
    """
    sides = np.concatenate([np.diff(ring, axis=0) for ring in rings])
    length, angle = np.hypot(*sides.T), np.degrees(np.arctan2(sides[:, 1], sides[:, 0]))
    return along_two_directions(length, angle) / float(length.sum())
