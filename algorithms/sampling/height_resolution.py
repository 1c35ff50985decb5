"""How finely the heights of a cloud are resolved: no roughness below that can be measured."""

from __future__ import annotations

import numpy as np

# Least resolution (m): coordinates are stored to a centimeter or finer, and smaller deviations from a line or a plane
# can't be distinguished from zero.
LEAST_RESOLUTION = 0.01

# Fewer levels than this are those of flat roofs, not of rounded heights.
_LEAST_LEVELS = 10

# Larger steps between levels (m) are those of storeys: nobody rounds so coarsely.
_MOST_STEP = 0.5

# Least share of the levels of rounded heights that follow the next lower one by the usual step.
_EVEN_SHARE = 0.5

# Steps are the same within this part of them.
_EVEN = 0.01


def rounding_deviation(elevation: np.ndarray) -> float:
    """Return the standard deviation of what rounding took from heights or added to them.

    Parameters
    ----------
    elevation : ndarray of shape (n,), float64
        Heights of points (m).

    Returns
    -------
    float
        The step between the levels on which all heights lie, over the square root of 12 (m); 0 where levels are
        uneven, as those of finely measured heights are, few, or as far from one another as storeys.
    """
    steps = np.diff(np.unique(elevation))
    if len(steps) < _LEAST_LEVELS:
        return 0.0
    step = float(np.median(steps))
    is_even = np.abs(steps - step) <= _EVEN * step
    return step / float(np.sqrt(12)) if step <= _MOST_STEP and is_even.mean() >= _EVEN_SHARE else 0.0


def height_resolution(elevation: np.ndarray) -> float:
    """Return the standard deviation (m) below which no roughness of a cloud of these heights (m) can be measured."""
    return max(LEAST_RESOLUTION, rounding_deviation(elevation))
