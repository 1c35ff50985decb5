"""Classes that a cloud came with, remembered for 'Restore classes'."""

import numpy as np

from ..cloud.asprs import PointClass
from ..stage import stage, tunable

# The choice by default.
_NONE = "none"

# Classes that are kept of a classified cloud, or None for all but the ones that mean unclassified.
_KEPT = {
    _NONE: (),
    "ground": (PointClass.GROUND,),
    "ground and buildings": (PointClass.GROUND, PointClass.BUILDING),
    "all": None,
}


@stage(
    "Land cover",
    tags="class,keep,existing,classified,freeze,lock,ground,building,reclassify",
    writes=("earlier_class",),
    written_if={"earlier_class": "where classes are kept"},
    cost=0.1,
    packages=(),
)
def keep_classes(
    xyz,
    classification,
    earlier_class=None,
    *,
    keep: str = tunable(_NONE, label="Keep existing classes", choices=tuple(_KEPT)),
    monitor=None,
):
    """Remember classes of a cloud that comes classified, for 'Restore classes' to put them back.

    The first step of a chain. Steps after it may change all classes.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes.
    earlier_class : ndarray of shape (n,), uint8, optional
        What an earlier run remembered; it is forgotten.

    Returns
    -------
    earlier_class : ndarray of shape (n,), uint8, or None
        The classes that are kept, 0 elsewhere; None where there is nothing to remember or to forget.

    Other Parameters
    ----------------
    keep
        Which classes of a cloud that comes classified stay as they are: none, ground (2), ground and buildings (6), or
        all but 0 and 1. Where ground or buildings are kept, no others are looked for.

    References
    ----------
    ASPRS, 2019. LAS specification 1.4, R15, table 17. [asprs2019]

    Examples
    --------
    >>> keep_classes([[0, 0, 0], [1, 0, 5]], np.array([2, 6]), keep="ground")
    array([2, 0], dtype=uint8)
    """
    if keep == _NONE and earlier_class is None:
        return None
    kept = _KEPT[keep]
    is_kept = classification > PointClass.UNCLASSIFIED if kept is None else np.isin(classification, kept)
    return np.where(is_kept, classification, 0).astype(np.uint8)
