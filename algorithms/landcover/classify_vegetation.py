"""Vegetation: points above the ground that are neither of buildings nor of other solid objects."""

from __future__ import annotations

from typing import NamedTuple, Optional

import numpy as np

from ..cloud.asprs import VEGETATION, PointClass
from ..cloud.reasons import Reason
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import stage, tunable
from .solid_objects import REACH, are_opaque, find_solid_objects

# Points of these classes may be vegetation; all others stay.
_OPEN = (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED, *VEGETATION)


class Heights(NamedTuple):
    """Heights above the ground (m) from which vegetation is medium and high."""

    medium: float
    high: float


HEIGHTS = {
    "2 m and 5 m": Heights(2.0, 5.0),
    "0.5 m and 2 m": Heights(0.5, 2.0),
    "0.5 m and 1.5 m (IGN)": Heights(0.5, 1.5),
    "0.3 m and 2 m (ICSM)": Heights(0.3, 2.0),
}


@stage(
    "Land cover",
    tags="vegetation,tree,canopy,bush,hedge,crown,plant,forest,low,medium,high,car,pole,fence",
    writes=("classification",),
    reach=REACH,
    cost=1.0,
)
def classify_vegetation(
    xyz,
    classification,
    height_above_ground,
    number_of_returns=None,
    reason=None,
    *,
    look_for: bool = tunable(
        True, "If not, no class changes. For models that contain this step.", label="Look for vegetation"
    ),
    heights: str = tunable(
        "2 m and 5 m",
        "Height above the ground from which vegetation is medium (4), and that from which it is high (5); below "
        "both it is low (3). The last two are of the French and the Australian surveys.",
        label="Heights of medium and high vegetation",
        choices=tuple(HEIGHTS),
    ),
    min_height: float = tunable(
        0.1,
        "Points at least this high above the ground are vegetation; all others are unclassified.",
        within="[0, 10] m",
    ),
    medium_height: Optional[float] = tunable(
        None,
        "Height above the ground from which vegetation is medium (4).",
        label="Medium vegetation from",
        within="[0, 100] m",
        automatic="the lower one of the heights chosen above.",
        advanced=True,
    ),
    high_height: Optional[float] = tunable(
        None,
        "Height above the ground from which vegetation is high (5).",
        label="High vegetation from",
        within="[0, 100] m",
        automatic="the higher one of the heights chosen above.",
        advanced=True,
    ),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Classify low, medium and high vegetation: points above the ground without another class.

    Cars, garden walls, fences, boats and poles stay unclassified (1): objects whose surfaces are smooth and reflect the
    whole pulse, and slender upright ones. So do decks with ramps, footbridges among them, of any height. Ground,
    buildings, water, noise and all other classes stay as they are.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes. Points of 0 and 1 are looked at; earlier vegetation (3, 4, 5) is classified anew.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.
    number_of_returns : ndarray of shape (n,), uint8, optional
        Returns of each point's pulse. Without it all objects count as opaque.
    reason : ndarray of shape (n,), uint8, optional
        Reasons of 'Segment roofs', which finds raised surfaces that continue into the ground: decks with ramps.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Low, medium and high vegetation 3, 4 and 5; 1 for points that were examined and are not vegetation.

    Raises
    ------
    ValueError
        If high vegetation begins lower than medium vegetation.

    Notes
    -----
    Run it after 'Complete buildings': nearly all other points above the ground are vegetation then. An object is
    a group of points that are connected in plan and height. It is solid if it is no higher than 3.5 m and less than a
    fifth of its pulses had several returns, and half of its points have neighbors that deviate from a plane no more
    than points of roofs and walls do. It is a pole if it is four times as high as its extent in plan. In thin clouds
    few cars are recognized: there are too few points for a plane. Objects that touch a plant are vegetation with it.

    References
    ----------
    ASPRS, 2019. LAS specification 1.4, R15, table 17. [asprs2019]

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> xyz = rng.uniform(0, 5, (500, 3))
    >>> found = classify_vegetation(xyz, np.ones(500), xyz[:, 2])
    >>> sorted({int(code) for code in found})
    [1, 3, 4]
    """
    classes = classification.astype(np.uint8)
    if not look_for:
        return classes
    limits = HEIGHTS[heights]
    medium = limits.medium if medium_height is None else medium_height
    high = limits.high if high_height is None else high_height
    if high < medium:
        raise ValueError(
            f"High vegetation from (high_height) must be at least medium vegetation from ({medium:g} m), got {high:g} "
            "m; raise it or lower the other."
        )
    monitor.resolved(medium_height=medium, high_height=high)
    is_open = np.isin(classification, _OPEN)
    plants = np.flatnonzero(is_open & (height_above_ground >= min_height))
    has_passed = np.zeros(len(plants), bool) if number_of_returns is None else number_of_returns[plants] > 1
    is_solid = find_solid_objects(xyz[plants], height_above_ground[plants], has_passed, sampling, monitor)
    decks = np.flatnonzero(np.zeros(len(plants), bool) if reason is None else reason[plants] == Reason.INTO_GROUND)
    is_solid[decks] |= are_opaque(xyz[plants[decks]], has_passed[decks], sampling, monitor)
    classes[is_open] = PointClass.UNCLASSIFIED
    plants = plants[~is_solid]
    layer = np.searchsorted([medium, high], height_above_ground[plants], side="right")
    classes[plants] = np.array(VEGETATION, np.uint8)[layer]
    return classes
