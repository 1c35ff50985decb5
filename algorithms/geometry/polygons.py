"""Measures of polygons in space: rings of corners, float64 (n, 3), m."""

from __future__ import annotations

import numpy as np


def area_vector(ring: np.ndarray) -> np.ndarray:
    """Return the vector (3,) across an open or closed ring, as long as its area (m²).

    Seen from its tip, the ring runs counterclockwise.
    """
    offset = ring - ring[0]
    return 0.5 * np.cross(offset, np.roll(offset, -1, axis=0)).sum(axis=0)


def axes_across(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two unit vectors (3,) that span the plane of a unit normal, counterclockwise seen from its tip."""
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first /= np.linalg.norm(first)
    return first, np.cross(normal, first)
