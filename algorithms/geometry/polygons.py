"""Measures of polygons in space: rings of corners, float64 (n, 3), m."""

from collections.abc import Sequence

import numpy as np


def area_vector(ring: np.ndarray) -> np.ndarray:
    """Return the vector (3,) across an open or closed ring, as long as its area (m²).

    Seen from its tip, the ring runs counterclockwise.
    """
    offset = ring - ring[0]
    return 0.5 * _cross(offset, np.concatenate([offset[1:], offset[:1]])).sum(axis=0)


def _cross(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the cross products (..., 3) of vectors, in half of the time that numpy takes for few of them."""
    (x, y, z), (u, v, w) = one.T, other.T
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def line_of_planes(origins: Sequence[np.ndarray], normals: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return a point (3,) on the line that two planes share, amid a point (3,) of each, and its unit direction (3,)."""
    direction = np.cross(*normals)
    direction /= np.linalg.norm(direction)
    middle = (origins[0] + origins[1]) / 2
    offsets = [normal @ (origin - middle) for normal, origin in zip(normals, origins)]
    return middle + np.linalg.solve(np.array([*normals, direction]), [*offsets, 0.0]), direction


def axes_across(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two unit vectors (3,) that span the plane of a unit normal, counterclockwise seen from its tip."""
    x, y, z = normal
    # Perpendicular to the coordinate axis that makes the largest angle with it. By numbers: numpy takes longer for one.
    least = int(np.argmin(np.abs(normal)))
    first = np.array([(0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0)][least])
    first /= np.sqrt(first @ first)
    a, b, c = first
    return first, np.array([y * c - z * b, z * a - x * c, x * b - y * a])
