"""Water: few returns, of one level, lower than the ground around."""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..params import SURFACE_NOISE
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..stage import stage, tunable
from .water_bodies import REACH, water_levels

# Points of these classes may be water, by their height.
_OPEN = (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED, PointClass.GROUND, PointClass.WATER)

# Points on a level surface lie within this many standard deviations of its level, all but one of 370 points.
_DEVIATIONS = 3.0


@stage(
    "Land cover",
    tags="water,river,canal,lake,pond,hydrography,shore,bank,breakline,hydro flattening",
    writes=("classification",),
    reach=REACH,
    cost=0.5,
)
def classify_water(
    xyz,
    classification,
    return_number=None,
    *,
    look_for: bool = tunable(
        True, "If not, no class changes. For models that contain this step.", label="Look for water"
    ),
    min_area: float = tunable(
        50.0, "Area of the smallest water body to be found.", label="Minimum water area", within="[10, 1_000_000] m²"
    ),
    noise: Optional[float] = SURFACE_NOISE,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Classify the points on water: where few pulses came back, from one level, lower than the ground around.

    Still water reflects most pulses away from the sensor. Where an area in the cloud has less than half of the pulses
    that land has, the ground in it is level and most of the ground around it is higher, it is water (9). Streams whose
    surface reflects as land does and falls by more than 1 % are not found. Clouds of matched images are left as they
    are.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes with ground (2); ground filters classify water as ground, too.
    return_number : ndarray of shape (n,), uint8, optional
        Only first returns are counted as pulses; without it all points are.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        The same with water (9) for points of 0, 1 and 2 on it. Earlier water (9) elsewhere stays.

    Raises
    ------
    ValueError
        If there are no ground points.

    Notes
    -----
    Gaps up to 20 m wide belong to the cloud. Shadows of buildings are gaps, too, but the ground in them is as high as
    next to them; roofs are no ground. A point is on water if its height differs from the nearest lowest point
    of the water body by at most three standard deviations of the noise. It also lies at most three cells from the body.

    References
    ----------
    Höfle, B., Vetter, M., Pfeifer, N., Mandlburger, G., Stötter, J., 2009. Water surface mapping from airborne laser
    scanning using signal intensity and elevation data. Earth Surface Processes and Landforms 34(12), 1635-1649.
    [hoefle2009]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> bool((classify_water(xyz, classes) == 9).any())
    False
    """
    classes = classification.astype(np.uint8)
    if not look_for:
        return classes
    if not (classification == PointClass.GROUND).any():
        raise ValueError("No ground points (class 2); run 'Classify ground points (TIN)' first.")
    noise = sampling.noise if noise is None else noise
    monitor.resolved(noise=noise)
    if sampling.is_closed_surface():
        return classes
    used = not_noise(classification)
    points = sampling.from_corner(xyz.take(used, axis=0))
    is_ground = np.isin(classification[used], (PointClass.GROUND, PointClass.WATER))
    is_pulse = np.ones(len(used), bool)
    if return_number is not None and return_number.any():
        is_pulse = return_number[used] == 1
    level = water_levels(points, is_ground, is_pulse, sampling.spacing, min_area, monitor)
    is_water = np.abs(points[:, 2] - level) <= _DEVIATIONS * noise
    classes[used[is_water & np.isin(classification[used], _OPEN)]] = PointClass.WATER
    return classes
