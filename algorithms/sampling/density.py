"""How densely a cloud covers the ground: the measure of automatic thresholds."""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..geometry.grid import distinct, grid_over, plan_box

# Average points per occupied cell of the grid that measures the area. Random sampling leaves one such cell in 150
# empty; courtyards, water and gaps between strips still show as empty.
_POINTS_PER_CELL = 5.0

# Smallest cell (m) of that grid. Coordinates are stored to a centimeter or finer, so the points of a wall or a mast
# share positions, and ever smaller cells would find ever less area.
_LEAST_CELL = 0.01

# Cell in which the filling is measured (point spacings): evenly random points leave a tenth of such cells empty.
_FILLED_CELL_SPACINGS = 1.5

# Share of these cells that holds points where the spacing is the right scale; usual scanners fill four fifths.
_LEAST_FILLED = 0.75

# Factor from one trial of the spacing to the next.
_SPACING_STEP = 2**0.125

# Largest factor between effective and mean spacing. Beyond it the dense parts would be seen too coarsely.
_MOST_SPACING = 2.0


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
        If all points lie at one position in plan, where density means nothing.

    Notes
    -----
    The area is that of the occupied cells of a grid whose cells hold five points on average;
    that size depends on the density in turn, so it is found by repetition. Cells are a centimeter wide at least.
    """
    low, high = plan_box(xyz)
    extent = high - low
    # A line of points has no area either: it is taken as wide as its points are apart.
    area = max(float(extent.prod()), float(extent.max()) ** 2 / len(xyz))
    if not area:
        raise ValueError(
            f"The cloud has no extent in plan (points: {len(xyz)}), so it has no density; choose a larger cloud."
        )
    density = len(xyz) / area
    for _ in range(20):
        size = max(float(np.sqrt(_POINTS_PER_CELL / density)), _LEAST_CELL)
        occupied = len(distinct(grid_over(xyz, size).number(xyz))[0])
        found = len(xyz) / (occupied * size * size)
        if abs(found - density) < 0.01 * density:
            break
        density = float(np.sqrt(found * density))
    return found


def effective_density(xyz: np.ndarray, density: Optional[float] = None) -> float:
    """Return the density (points/m²) of the evenly spread cloud that would leave about as much of its area empty.

    Parameters
    ----------
    xyz : ndarray of shape (n, 2 or 3)
        Coordinates (m), n >= 1.
    density : float, optional
        That of :func:`point_density`, where it is known already.

    Returns
    -------
    float
        That of :func:`point_density` where points are spread evenly; down to a quarter of it where they lie on lines
        with gaps in between, in pairs, or far more densely in some parts than in others.

    Raises
    ------
    ValueError
        As of :func:`point_density`.

    Notes
    -----
    Of the cells of one and a half point spacings that lie in occupied cells of twice their size, evenly random points
    leave a tenth empty, and the clouds of usual scanners up to a fifth. Where it is more than a quarter, cells and
    the spacing with them grow until it is not.
    """
    density = point_density(xyz) if density is None else density
    size, growth = _FILLED_CELL_SPACINGS / float(np.sqrt(density)), 1.0
    while growth < _MOST_SPACING and _filled(xyz, size * growth) < _LEAST_FILLED:
        growth *= _SPACING_STEP
    return density / growth**2


def _filled(xyz: np.ndarray, size: float) -> float:
    """Return the share of occupied cells of ``size`` (m) in those of twice the size."""
    small, large = (len(distinct(grid_over(xyz, cell).number(xyz))[0]) for cell in (size, 2 * size))
    return small / (4 * large)


def point_spacing(xyz: np.ndarray) -> float:
    """Return the mean distance between neighboring points in plan (m), ``1 / sqrt(density)``."""
    return 1.0 / float(np.sqrt(point_density(xyz)))
