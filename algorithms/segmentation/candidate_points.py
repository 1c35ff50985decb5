"""Candidate points of segments and clusters."""

from typing import Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass

# No object on the ground is of these classes.
NO_OBJECTS = (PointClass.GROUND, PointClass.WATER, PointClass.BRIDGE_DECK, PointClass.IGNORED_GROUND, *NOISE)

# Automatic distances between points of one segment are less than this (m) in clouds of 3.3 points per m² and more. What
# a window cuts off is joined with its part in the next one.
AUTOMATIC_REACH = 5.0


def candidates(classification: np.ndarray, height_above_ground: Optional[np.ndarray], min_height: float) -> np.ndarray:
    """Return the indices (m,) of the points whose class may be an object's, at least ``min_height`` (m) high.

    At a ``min_height`` of 0 the heights (n,), m, are not looked at.

    Raises
    ------
    ValueError
        If a minimum height is asked for and heights are missing.
    """
    is_candidate = ~np.isin(classification, NO_OBJECTS)
    if min_height > 0:
        if height_above_ground is None:
            raise ValueError(
                "A minimum height needs HeightAboveGround; run 'Height above ground' first or set it to 0."
            )
        is_candidate &= height_above_ground >= min_height
    return np.flatnonzero(is_candidate)
