"""How coarsely the heights of a cloud were rounded: no roughness below that can be told."""

from __future__ import annotations

import numpy as np

# Coordinates are stored to a centimeter or finer (m): what deviates less from a line or a plane can't be told from one.
LEAST_DEVIATION = 0.01

# A few even levels are those of flat roofs, and higher steps (m) those of storeys: nobody rounds so coarsely.
_LEAST_LEVELS, _MOST_STEP = 10, 0.5

# Of rounded heights at least this share of the levels follow the next lower one by the same step, but for this part.
_EVEN_SHARE, _EVEN = 0.5, 0.01


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


def least_deviation(elevation: np.ndarray) -> float:
    """Return the standard deviation (m) that no surface of a cloud of these heights (m) is known to be below."""
    return max(LEAST_DEVIATION, rounding_deviation(elevation))
