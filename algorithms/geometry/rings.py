"""Measures of rings: closed polylines in plan, float64 (m, 2), the last vertex equal to the first.

An outline is a list of rings: first the exterior, counterclockwise, then the holes, clockwise.
"""

from __future__ import annotations

import numpy as np


def signed_area(ring: np.ndarray) -> float:
    """Return the area (m²) within a ring, negative when it runs clockwise."""
    x, y = (ring - ring[0]).T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def perimeter(ring: np.ndarray) -> float:
    """Return the length (m) of a ring."""
    return float(np.hypot(*np.diff(ring, axis=0).T).sum())
