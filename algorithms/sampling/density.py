"""How densely a cloud covers the ground: the measure of automatic thresholds."""

from typing import Optional

import numpy as np

from ..geometry.grid import distinct, grid_over, plan_box
from ..rules import rule, rules
from .height_resolution import LEAST_RESOLUTION


@rules
class DENSITY:
    """How the area is measured that points occupy."""

    points_per_cell: float = rule(5.0, "points", "statistics: random points leave one such cell in 150 empty")
    filled_cell: float = rule(1.5, "point spacings", "statistics: random points leave a tenth of such cells empty")
    least_filled: float = rule(
        0.75, "share", "of filled cells that hold points at the right spacing; usual scanners fill four fifths"
    )
    link: float = rule(2.0, "point spacings", "statistics: random points of one object are hardly ever farther apart")
    least_link: float = rule(0.5, "m", "physics: points of one object are hardly ever farther apart in dense clouds")
    step: float = rule(2**0.125, "ratio", "of one trial of the spacing to the next")
    most_spacing: float = rule(
        2.0, "ratio", "of effective to mean spacing; beyond it dense parts are seen too coarsely"
    )


def link_distance(spacing: float) -> float:
    """Return the distance (m) in plan up to which points of one object lie next to each other, by their spacing (m)."""
    return max(DENSITY.least_link, DENSITY.link * spacing)


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
    The area is covered by the occupied cells of a grid whose cells hold five points on average;
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
    # It ends when the density changes by less than a hundredth, in a few rounds.
    for _ in range(20):
        size = max(float(np.sqrt(DENSITY.points_per_cell / density)), LEAST_RESOLUTION)
        found = len(xyz) / (len(distinct(grid_over(xyz, size).number(xyz))[0]) * size * size)
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
        As by :func:`point_density`, where it is known already.

    Returns
    -------
    float
        As by :func:`point_density` where points are spread evenly. It is down to a quarter of it where they lie on
        lines with gaps in between, in pairs, or far more densely in some parts than in others.

    Raises
    ------
    ValueError
        As of :func:`point_density`.

    Notes
    -----
    Cells of one and a half point spacings are examined that lie in occupied cells of twice their size. Evenly random
    points leave a tenth of them empty, and the clouds of usual scanners up to a fifth. Where it is more than a quarter,
    cells and the spacing with them grow until it is not.
    """
    density = point_density(xyz) if density is None else density
    size, growth = DENSITY.filled_cell / float(np.sqrt(density)), 1.0
    while growth < DENSITY.most_spacing and _filled(xyz, size * growth) < DENSITY.least_filled:
        growth *= DENSITY.step
    return density / growth**2


def _filled(xyz: np.ndarray, size: float) -> float:
    """Return the share of occupied cells of ``size`` (m) in cells of twice the size."""
    small, large = (len(distinct(grid_over(xyz, cell).number(xyz))[0]) for cell in (size, 2 * size))
    return small / (4 * large)


def point_spacing(xyz: np.ndarray) -> float:
    """Return the mean distance between neighboring points in plan (m), ``1 / sqrt(density)``."""
    return 1.0 / float(np.sqrt(point_density(xyz)))
