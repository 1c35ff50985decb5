"""Ground points that a filter left out although they lie on its surface."""

import numpy as np

from ..cloud.asprs import PointClass
from ..stage import stage, tunable


@stage(
    "Terrain",
    tags="ground,terrain,bare earth,strip,overlap,grass,surface",
    writes=("classification",),
    cost=0.1,
    packages=(),
)
def complete_ground(
    xyz, classification, height_above_ground, *, max_distance: float = tunable(0.1, within="[0, 1] m"), monitor=None
):
    """Add to the ground the points on its surface that have no other class.

    A ground filter keeps a thin surface: where flight lines differ in height by a few centimeters, or grass is low, it
    takes one layer of points and leaves the other. Buildings, plants, water and other classes stay as they are.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; points of 0 and 1 are looked at.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        The same with more ground (2).

    Other Parameters
    ----------------
    max_distance
        Unclassified points no farther above or below the surface of the ground become ground; 0 adds none.

    Notes
    -----
    Buildings must be classified before: their steps and low walls are as near to the ground. The default of 0.1 m is
    the vertical accuracy that airborne surveys promise (root mean square) and the height from which
    'Classify vegetation' finds plants.

    References
    ----------
    ASPRS, 2014. Positional accuracy standards for digital geospatial data, edition 1, version 1.0, table 7.5.
    [asprs2014]

    Examples
    --------
    >>> xyz = [[0, 0, 0.0], [1, 0, 0.05], [2, 0, 0.9]]
    >>> complete_ground(xyz, np.array([2, 1, 1]), np.array([0.0, 0.05, 0.9]))
    array([2, 2, 1], dtype=uint8)
    """
    classes = classification.astype(np.uint8)
    is_open = np.isin(classification, (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED))
    is_near = is_open & (np.abs(height_above_ground) <= max_distance)
    if max_distance:
        classes[is_near] = PointClass.GROUND
    return classes
