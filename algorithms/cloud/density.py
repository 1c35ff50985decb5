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

# Scales that grow with the spacing are right where cells of so many spacings are filled to this share at least. They
# grow in such steps, to no more than twice the spacing: beyond, the dense places would be seen too coarsely.
_CELL_SPACINGS, _LEAST_FILLED = 1.5, 0.75
_STEP, _MOST_GROWTH = 2**0.125, 2.0


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


def even_density(xyz: np.ndarray) -> float:
    """Return the density (points/m²) of the evenly spread cloud that would leave about as much of its area empty.

    Argument and errors as of :func:`point_density`.

    Returns
    -------
    float
        That of :func:`point_density` where points are spread evenly; down to a quarter of it where they lie on lines
        with gaps in between, in pairs, or in places far denser than in others.

    Notes
    -----
    Of the cells of one and a half point spacings that lie in occupied cells of twice their size, evenly random points
    leave a tenth empty, and the clouds of usual scanners up to a fifth. Where it is more than a quarter, cells and
    the spacing with them grow until it is not.
    """
    density = point_density(xyz)
    size, growth = _CELL_SPACINGS / float(np.sqrt(density)), 1.0
    while growth < _MOST_GROWTH and _filled(xyz, size * growth) < _LEAST_FILLED:
        growth *= _STEP
    return density / growth**2


def _filled(xyz: np.ndarray, size: float) -> float:
    """Return the share of occupied cells of ``size`` (m) in those of twice the size."""
    small, large = (len(distinct(grid_over(xyz, cell).number(xyz))[0]) for cell in (size, 2 * size))
    return small / (4 * large)


def point_spacing(xyz: np.ndarray) -> float:
    """Return the mean distance between neighboring points in plan (m), ``1 / sqrt(density)``."""
    return 1.0 / float(np.sqrt(point_density(xyz)))
