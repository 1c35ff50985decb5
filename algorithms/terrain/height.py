"""Height above ground."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from ..params import GroundSpacing
from ..stage import stage
from .tin import Tin, thinned


@stage(
    "Height above ground",
    group="Terrain",
    tags="normalize,HAG,height,terrain,TIN",
    writes=("height_above_ground",),
)
def compute_height_above_ground(xyz, classification, *, ground_spacing: GroundSpacing = 0.0, monitor=None):
    """Measure how high each point lies above the ground points around it.

    The ground is the triangulated surface (TIN) of the points of class 2.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground is 2.

    Returns
    -------
    height_above_ground : ndarray of shape (n,), float32
        Elevation minus ground elevation, m; negative below the ground.

    Raises
    ------
    ValueError
        If no point is ground.

    Notes
    -----
    Points outside the hull of the ground points are measured from the nearest ground point; the log says how many.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022, section 2.2.
    """
    is_ground = classification == PointClass.GROUND
    if not is_ground.any():
        raise ValueError("The cloud has no ground points (class 2); run 'Classify ground points (TIN)' first.")
    tin = Tin(thinned(xyz[is_ground], ground_spacing))
    facet = tin.locate(xyz, monitor)
    height = xyz[:, 2] - tin.elevation(xyz, facet)
    outside = tin.is_extrapolated()[facet] & ~is_ground
    if outside.any():
        height[outside] = xyz[outside, 2] - tin.nearest_elevation(xyz[outside])
        monitor.warn(
            f"{int(outside.sum())} of {len(xyz)} points lie outside the ground; "
            "the nearest ground point gave their height."
        )
    return height.astype(np.float32)
