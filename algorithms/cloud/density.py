"""How densely a cloud covers the ground: what automatic thresholds are made of."""

from __future__ import annotations

import numpy as np

from .cells import distinct, grid_over, plan_box

# With this many points per occupied cell on average, holes of random sampling are rare (one in 150)
# and courtyards, water and gaps between strips still show as empty.
_POINTS_PER_CELL = 5.0

# Coordinates are stored to a centimeter or finer: points of a wall or a mast share places, and cells smaller than these
# (m) would find the less area the smaller they are.
_LEAST_CELL = 0.01


def point_density(xyz: np.ndarray) -> float:
    """Return the points per square meter of the area that the points occupy in plan.

    Parameters
    ----------
    xyz : ndarray of shape (n, 2 or 3)
        Coordinates (m), n >= 1.

    Returns
    -------
    float
        Density (points/m²), greater than 0; the point spacing is ``1 / sqrt(density)``.

    Raises
    ------
    ValueError
        If all points lie at one place in plan, where density means nothing.

    Notes
    -----
    The area is that of the occupied cells of a grid whose cells hold five points on average;
    that size depends on the density in turn, so it is found by repetition. Cells are a centimeter wide at least.
    """
    low, high = plan_box(xyz)
    extent = high - low
    if not extent.any():
        raise ValueError(
            f"The cloud has no extent in plan (points: {len(xyz)}), so it has no density; choose a larger cloud."
        )
    # A line of points has no area either: it is taken as wide as its points are apart.
    area = max(float(extent.prod()), float(extent.max()) ** 2 / len(xyz))
    density = len(xyz) / area
    for _ in range(20):
        size = max(float(np.sqrt(_POINTS_PER_CELL / density)), _LEAST_CELL)
        occupied = len(distinct(grid_over(xyz, size).number(xyz))[0])
        found = len(xyz) / (occupied * size * size)
        if abs(found - density) < 0.01 * density:
            break
        density = float(np.sqrt(found * density))
    return found


def point_spacing(xyz: np.ndarray) -> float:
    """Return the mean distance between neighboring points in plan (m), ``1 / sqrt(density)``."""
    return 1.0 / float(np.sqrt(point_density(xyz)))
