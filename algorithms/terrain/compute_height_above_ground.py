"""Height above ground."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.tiled_tin import TiledTin
from ..packages import spatial
from ..stage import stage

# Half the width of a usual building: how far the ground points are whose triangle a point is in (m).
_REACH = 10.0

# What stands on a bridge has points of its deck this near in plan (m), and none of its own this far (m) below them.
_ON_DECK, _BELOW_DECK = 1.0, 0.3


@stage(
    "Height above ground",
    group="Terrain",
    tags="normalize,HAG,height,terrain,TIN",
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
    the log says how many. Of ground points at one place in plan the lowest counts. Bridge decks are measured from the
    ground below them, and what stands on them, such as cars and parapets, from the decks.

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
    _lift_to_decks(xyz, classification, above, elevation)
    height = np.zeros(len(xyz), np.float32)
    height[above] = xyz[above, 2] - elevation
    return height


def _lift_to_decks(xyz: np.ndarray, classification: np.ndarray, above: np.ndarray, elevation: np.ndarray) -> None:
    """Lift the ``elevation`` (m,) under the points ``above`` (m,) that stand on bridge decks to these."""
    deck = xyz[classification == PointClass.BRIDGE_DECK]
    if not len(deck):
        return
    others = np.flatnonzero(classification[above] != PointClass.BRIDGE_DECK)
    distance, nearest = spatial.cKDTree(deck[:, :2]).query(xyz[above[others], :2], distance_upper_bound=_ON_DECK)
    near = np.isfinite(distance)
    others, level = others[near], deck[nearest[near], 2]
    stands = xyz[above[others], 2] >= level - _BELOW_DECK
    elevation[others[stands]] = np.maximum(elevation[others[stands]], level[stands])
