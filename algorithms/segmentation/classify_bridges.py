"""Bridges in the ground of a filter, by how they lie over what they cross."""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..cloud.asprs import VEGETATION, PointClass
from ..params import BRIDGE_AREA, BRIDGE_HEIGHT, BRIDGE_WIDTH, POINT_DENSITY, SURFACE_NOISE
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..sampling.kinds import LASER
from ..stage import stage, tunable
from ..terrain.on_decks import on_decks
from .bridge_decks import Decks
from .deck_sites import deck_sites

# No deck is of these classes.
_NO_DECK = (*VEGETATION, PointClass.BUILDING, PointClass.WATER)

# Where bridges are looked for.
_EVERYWHERE, _OVER_GAPS = "everywhere", "gaps in the ground"


@stage(
    "Terrain",
    tags="bridge,fly-over,bridge deck,footbridge,viaduct,ground,terrain,DTM,Sithole,Vosselman",
    writes=("classification",),
    reach=lambda tunables: tunables["max_width"] * (2 if tunables["search"] == _EVERYWHERE else 0.5),
    cost=1.0,
)
def classify_bridges(
    xyz,
    classification,
    *,
    min_height: float = BRIDGE_HEIGHT,
    max_width: float = BRIDGE_WIDTH,
    min_bridge_area: float = BRIDGE_AREA,
    search: str = tunable(
        _EVERYWHERE,
        "Where bridges are looked for: everywhere, or only around level surfaces over a gap in the ground with "
        "ground at their height at both ends, in a fraction of the time.",
        choices=(_EVERYWHERE, _OVER_GAPS),
    ),
    noise: Optional[float] = SURFACE_NOISE,
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find bridges and fly-overs in a cloud with classified ground, also where the ground filter took them for ground.

    On lines in eight directions the sections of a bridge are smooth, opaque and raised on both sides. Such parts become
    bridge deck (17) if they are large enough and go on into the ground at both ends. Bridges whose ends are not in the
    cloud, and embankments, are not found. A run in tiles reads twice the maximum width around each block, or half
    the maximum width where bridges are looked for at gaps only. Bridges of which an end lies farther out are not found
    in that block. For long ones set a larger block or maximum width.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes with ground (2); vegetation, buildings and water are no decks, earlier bridge deck (17) is
        discarded where bridges are looked for.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        The same with bridge deck (17); unchanged where no bridges are looked for.

    Raises
    ------
    ValueError
        If there are no ground points.

    Notes
    -----
    This is the second step of 'Classify ground segments', for the ground of any filter and without segments. All points
    can be of a deck, unless their class is no deck.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 5.3. [vosselman2004]
    Sithole, G., Vosselman, G., 2003. Automatic structure detection in a point cloud of an urban landscape. URBAN 2003,
    Berlin, 67-71. [sithole2003]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> bool((classify_bridges(xyz, classes) == 17).any())
    False
    """
    if not max_width:
        return classification.astype(np.uint8)
    if not (classification == PointClass.GROUND).any():
        raise ValueError("No ground points (class 2); run 'Classify ground points (TIN)' first.")
    density = sampling.density if density is None else density
    noise = sampling.noise if noise is None else noise
    monitor.resolved(density=density, noise=noise)
    used = not_noise(classification)
    points = sampling.from_corner(xyz.take(used, axis=0))
    decks = Decks.of(min_height, max_width, min_bridge_area, 1 / float(np.sqrt(density)), noise)
    may_be_deck = ~np.isin(classification[used], _NO_DECK)
    if search == _OVER_GAPS:
        is_level = np.isin(classification[used], (PointClass.GROUND, PointClass.WATER))
        near = deck_sites(points, may_be_deck, is_level, decks)
        used, points, may_be_deck = used[near], points[near], may_be_deck[near]
    is_deck = decks.find(points, may_be_deck, classification[used] == PointClass.GROUND, monitor)
    classes = classification.astype(np.uint8)
    classes[used[classification[used] == PointClass.BRIDGE_DECK]] = PointClass.UNCLASSIFIED
    ground = np.flatnonzero((classification[used] == PointClass.GROUND) & ~is_deck)
    # Ground points on a deck are of cars and parapets; ground that rises next to the deck stays ground.
    classes[used[ground[on_decks(points[ground], points[is_deck], LASER.foot)[0]]]] = PointClass.UNCLASSIFIED
    classes[used[is_deck]] = PointClass.BRIDGE_DECK
    return classes
