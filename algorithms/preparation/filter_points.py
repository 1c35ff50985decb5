"""Points chosen by class, by height above ground, and by any other dimension."""

from typing import Optional

import numpy as np

from ..cloud.asprs import parse_classes
from ..stage import Monitor, stage, tunable

# Numbers of 32 bits, and times in seconds from 1970, are smaller.
_LARGEST = 10_000_000_000

_NO_LIMIT = "no limit; the log gives the range of the cloud."


@stage(
    "Preparation",
    tags="las,laz,copc,pdal,select,extract,subset,class,height,range,limits,remove,split,expression,las2las",
    selects=True,
    packages=(),
)
def filter_points(
    xyz,
    classification,
    height_above_ground=None,
    values=None,
    *,
    classes: str = tunable(""),
    min_height: Optional[float] = tunable(None, within="[-10_000, 10_000] m", empty=_NO_LIMIT),
    max_height: Optional[float] = tunable(None, within="[-10_000, 10_000] m", empty=_NO_LIMIT),
    dimension: str = tunable(""),
    low: Optional[float] = tunable(None, label="Minimum value", within=f"[{-_LARGEST}, {_LARGEST}]", empty=_NO_LIMIT),
    high: Optional[float] = tunable(None, label="Maximum value", within=f"[{-_LARGEST}, {_LARGEST}]", empty=_NO_LIMIT),
    invert: bool = tunable(False),
    monitor=None,
):
    """Keep the points that are of some classes, between two heights above the ground, and in a range of any dimension.

    A limit that is not set excludes nothing; points must be within all limits that are set. Points at a limit
    are kept.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates, m.
    classification : ndarray of shape (n,)
        ASPRS classes.
    height_above_ground : ndarray of shape (n,), optional
        Heights, m; needed to limit them.
    values : ndarray of shape (n,), optional
        The dimension that is named; needed to limit it.

    Returns
    -------
    selected : ndarray of shape (m,), int64
        Positions of the points that are kept, ascending.

    Other Parameters
    ----------------
    classes
        Keep points of these classes: numbers and ranges, separated by commas (2, 6-9); empty keeps every class.
    min_height
        Keep points at least this high above the ground: 0.3 m removes ground and grass.
    max_height
        Greatest height above the ground of the points kept: 2.5 m leaves everything lower than roofs.
    dimension
        Any dimension of the cloud, by name (Intensity, NormalZ, Z), whose range is to be limited.
    low
        Keep points that have at least this in the dimension.
    high
        Keep points that have at most this in the dimension.
    invert
        Keep the points that any of the limits leaves out, and leave out the others.

    Raises
    ------
    ValueError
        If a limit is set on heights or on a dimension that is not there, or a minimum is above its maximum.

    Notes
    -----
    A point whose height or value is undefined is within no limit. A result without points is refused when it would
    have to be written: a cloud must have points.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.2
    (heights of 0.3 and 2.5 m). [hrutka2022]

    Examples
    --------
    >>> filter_points([[0, 0, 0], [1, 0, 0], [2, 0, 9]], [2, 6, 6], classes="6")
    array([1, 2])
    """
    kept = np.ones(len(xyz), bool)
    numbers = parse_classes(classes, "Classes")
    if len(numbers):
        kept &= np.isin(classification, numbers)
    monitor.progress(0.3)
    if height_above_ground is None and (min_height is not None or max_height is not None):
        raise ValueError("Limits of the height need HeightAboveGround; run 'Height above ground' first or set none.")
    if height_above_ground is not None:
        kept &= within_limits(height_above_ground, min_height, max_height, ("min_height", "max_height"), monitor)
    monitor.progress(0.6)
    if values is None and (low is not None or high is not None):
        raise ValueError(
            "Minimum and maximum value are limits of a dimension; name it (Intensity, NormalZ) or set none."
        )
    if values is not None:
        kept &= within_limits(values, low, high, ("low", "high"), monitor)
    return np.flatnonzero(~kept if invert else kept)


def within_limits(
    values: np.ndarray, low: Optional[float], high: Optional[float], names: tuple[str, str], monitor: Monitor
) -> np.ndarray:
    """Find values between two limits, all without limits; log the range that they have.

    Parameters
    ----------
    values : ndarray of shape (n,)
        Values, NaN where undefined: these are within no limit.
    low, high : float, optional
        Limits that are set.
    names : tuple of str
        Their names; one that is not set is logged as the least or the greatest value.
    monitor : Monitor
        Receives the log.

    Returns
    -------
    ndarray of shape (n,), bool
        Which are within the limits.
    """
    defined = values[np.isfinite(values)]
    for name, limit, found in zip(names, (low, high), (defined.min, defined.max)):
        if limit is None and len(defined):
            monitor.resolved(**{name: float(found())})
    if low is not None and high is not None and low > high:
        raise ValueError(f"The minimum ({low:g}) is above the maximum ({high:g}); exchange them.")
    within = np.ones(len(values), bool)
    if low is not None:
        within &= values >= low
    if high is not None:
        within &= values <= high
    return within
