"""Height above ground."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.tiled_tin import TiledTin
from ..stage import stage
from .on_decks import on_decks

# Half the width of a usual building: how far the ground points are whose triangle a point is in (m).
_REACH = 10.0


@stage(
    "Height above ground",
    group="Terrain",
    tags="normalize,normalise,normalization,nDSM,HAG,height,terrain,TIN,lasheight",
    writes=("height_above_ground",),
    reach=_REACH,
)
def compute_height_above_ground(xyz, classification, *, monitor=None):
    """Measure how high each point lies above the ground points around it.

    The ground is the triangulated surface (TIN) of the points of class 2.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground is 2, bridge deck 17.

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
    Ground points are 0 m high. Points outside the hull of the ground points are measured from the nearest ground point;
    the log says how many. The paper subtracts a terrain raster; here heights are those over the triangulation itself,
    which the raster of 'Rasterize terrain' samples at the centers of its cells: on slopes nothing is lost to the cells.
    Its filter of heights above 0.3 m is a step of its own, 'Filter points'. Of ground points at one place in plan the
    lowest counts. Bridge decks are measured from the ground below them, and what stands on them, such as cars and
    parapets, from the decks.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022, section 2.2.
    """
    is_ground = classification == PointClass.GROUND
    if not is_ground.any():
        raise ValueError("The cloud has no ground points (class 2); run 'Classify ground points (TIN)' first.")
    above = np.flatnonzero(~is_ground)
    surface = TiledTin(xyz[is_ground])
    elevation = surface.elevation(xyz[above], monitor)
    outside = np.isnan(elevation)
    if outside.any():
        elevation[outside] = surface.nearest_elevation(xyz[above[outside]])
        monitor.inform(
            f"{int(outside.sum())} of {len(xyz)} points lie outside the ground; "
            "the nearest ground point gave their height."
        )
    is_deck = classification[above] == PointClass.BRIDGE_DECK
    stands, level = on_decks(xyz[above[~is_deck]], xyz[above[is_deck]])
    stands = np.flatnonzero(~is_deck)[stands]
    elevation[stands] = np.maximum(elevation[stands], level)
    height = np.zeros(len(xyz), np.float32)
    height[above] = xyz[above, 2] - elevation
    return height
