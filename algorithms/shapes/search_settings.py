"""Tunables that the searches for cylinders and spheres share, and their automatic values."""

from typing import Optional

import numpy as np

from ..sampling.cloud_sampling import CloudSampling
from ..sampling.surface_noise import ROUGHNESS_OF_SPACING
from ..stage import tunable

# Least radius (point spacings): half a circumference has four points across it.
_RADIUS_SPACINGS = 1.2

# Least height of a visible arc above its chord (standard deviations of the noise): a flatter one is a plane. Half a
# circle is as high as its radius.
ARC_DEVIATIONS = 6.0

# Largest radius (m) that is searched for with nothing set: tanks have up to 20 m, and larger ones take more time.
_LARGEST_RADIUS = 20.0

# Distance around a point, as a share of the largest radius, that is read where a cloud is worked on in parts.
_REACH = 0.5

# Least ratio of the largest radius to the least, with nothing set.
_LEAST_RANGE = 2.0

MIN_RADIUS = tunable(
    None,
    "Least radius that is looked for.",
    within="[0.001, 1000] m",
    automatic=f"the larger of {_RADIUS_SPACINGS:g} times the point spacing and {ARC_DEVIATIONS:g} times the "
    "roughness of surfaces.",
)

MAX_RADIUS = tunable(
    None,
    "Largest radius that is looked for.",
    within="[0.001, 1000] m",
    automatic=f"{_LARGEST_RADIUS:g} m, but no more than half of the longest side of the cloud, and at least twice "
    "the minimum.",
)

SHAPE_TOLERANCE = tunable(
    None,
    "Distance within which a point lies on the surface.",
    within="(0, 10] m",
    automatic="3 times the roughness of surfaces, which is the root of the sum of the squares of the noise of "
    f"the scan and of {ROUGHNESS_OF_SPACING:g} point spacings.",
)


def reach_of_radius(max_radius: Optional[float]) -> float:
    """Return the reach (m) of points that decide on a point of a shape, by the largest radius (m; None if automatic).

    Within half a radius of a point lie a sixth of the circumference of a cylinder and a sixteenth of the area of a
    sphere.
    """
    return _REACH * (_LARGEST_RADIUS if max_radius is None else max_radius)


def point_noise(sampling: CloudSampling) -> float:
    """Return the standard deviation of points across the surface of a shape, m."""
    return float(np.hypot(sampling.scan_noise, ROUGHNESS_OF_SPACING / np.sqrt(sampling.surface_density)))


def check_radii(
    min_radius: Optional[float], max_radius: Optional[float], noise: float, spacing: float, xyz: np.ndarray
) -> tuple[float, float]:
    """Return the range of radii (m), automatic where it is None.

    Parameters
    ----------
    min_radius : float, optional
        Least radius, m.
    max_radius : float, optional
        Greatest radius, m.
    noise : float
        Standard deviation of points, m.
    spacing : float
        Point spacing, m.
    xyz : ndarray of shape (n, 3)
        Points, m.

    Raises
    ------
    ValueError
        If the range is empty.
    """
    low = max(_RADIUS_SPACINGS * spacing, ARC_DEVIATIONS * noise) if min_radius is None else min_radius
    # No shape in the cloud as a whole has a larger diameter.
    extent = float(np.ptp(xyz, axis=0).max())
    # The extent of a part of a cloud may be tiny: an automatic range is never empty, so that no error is raised.
    high = max(min(_LARGEST_RADIUS, extent / 2), _LEAST_RANGE * low) if max_radius is None else max_radius
    if low >= high:
        raise ValueError(
            f"The range of radii is empty: the minimum radius is {low:.3g} m and the maximum radius {high:.3g} m; "
            "set a larger maximum or a smaller minimum."
        )
    return low, high
