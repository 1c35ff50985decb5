"""How finely the heights of a cloud are resolved: no roughness below that can be measured."""

import numpy as np

from ..rules import rule, rules


@rules
class HEIGHTS:
    """How coarsely heights are rounded."""

    least: float = rule(0.01, "m", "files keep a centimeter; smaller deviations can not be distinguished from zero")
    levels: int = rule(10, "levels", "fewer come of flat roofs, not of rounded heights")
    most_step: float = rule(0.5, "m", "physics: larger steps between levels come of storeys")
    even: float = rule(0.01, "share", "of the median step; at least half of all steps differ from it by no more")


LEAST_RESOLUTION = HEIGHTS.least


def rounding_deviation(elevation: np.ndarray) -> float:
    """Return the standard deviation of the errors of rounded heights.

    Parameters
    ----------
    elevation : ndarray of shape (n,), float64
        Heights of points (m).

    Returns
    -------
    float
        The step between the levels on which all heights lie, over the square root of 12 (m). It is 0 where levels are
        uneven, as of finely measured heights, few, or as far from one another as storeys.
    """
    steps = np.diff(np.unique(elevation))
    if len(steps) < HEIGHTS.levels:
        return 0.0
    step = float(np.median(steps))
    is_even = np.median(np.abs(steps - step)) <= HEIGHTS.even * step
    return step / float(np.sqrt(12)) if is_even and step <= HEIGHTS.most_step else 0.0


def height_resolution(elevation: np.ndarray) -> float:
    """Return the standard deviation (m) below which no roughness of a cloud of these heights (m) can be measured."""
    return max(HEIGHTS.least, rounding_deviation(elevation))
