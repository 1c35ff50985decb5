"""Height above ground."""

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.grid import distinct, fixed_grid_over
from ..geometry.groups import placed
from ..geometry.tiled_tin import TiledTin
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.kinds import SCENE
from ..stage import stage
from .on_decks import on_decks


@stage(
    "Terrain",
    title="Height above ground",
    tags="normalize,normalise,normalization,nDSM,HAG,height,terrain,TIN,lasheight",
    writes=("height_above_ground",),
    reach=SCENE.ground_within,
    cost=3.5,
)
def compute_height_above_ground(xyz, classification, *, sampling: CloudSampling = MEASURED, monitor=None):
    """Measure how high each point lies above the ground points around it.

    The ground is the triangulated surface (TIN) of the points of class 2, evened out over half a meter.

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
    the log says how many. The paper subtracts a terrain raster; here heights are those over a triangulation, so that
    nothing is lost to cells on slopes. Its nodes are the means of the ground points in cells of ``SCENE.least_cell`` m,
    so that the noise of single points does not affect heights. The filter of heights above 0.3 m is a step of its own,
    'Filter points'. Bridge decks are measured from the ground below them, and objects on them, such as cars and
    parapets, from the decks.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.2.
    [hrutka2022]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> float(compute_height_above_ground(xyz, classes).max())
    5.0
    """
    is_ground = classification == PointClass.GROUND
    if not is_ground.any():
        raise ValueError("The cloud has no ground points (class 2); run 'Classify ground points (TIN)' first.")
    xyz = sampling.from_corner(xyz)
    above = np.flatnonzero(~is_ground)
    surface = TiledTin(_means(xyz[is_ground]))
    elevation = surface.elevation(xyz[above], monitor)
    outside = np.isnan(elevation)
    if outside.any():
        elevation[outside] = surface.nearest_elevation(xyz[above[outside]])
        monitor.inform(
            f"{int(outside.sum())} of {len(xyz)} points lie outside the ground; "
            "the nearest ground point gave their height."
        )
    is_deck = classification[above] == PointClass.BRIDGE_DECK
    on_deck, level = on_decks(xyz[above[~is_deck]], xyz[above[is_deck]])
    on_deck = np.flatnonzero(~is_deck)[on_deck]
    elevation[on_deck] = np.maximum(elevation[on_deck], level)
    return placed((xyz[above, 2] - elevation).astype(np.float32), above, len(xyz))


def _means(ground: np.ndarray) -> np.ndarray:
    """Return the mean (m, 3) of the ground points (n, 3) in each cell."""
    _, cell = distinct(fixed_grid_over(ground, SCENE.least_cell).number(ground))
    count, corner = np.bincount(cell), ground.min(axis=0)
    # Sums of small numbers keep their digits.
    return np.column_stack([np.bincount(cell, column) / count for column in (ground - corner).T]) + corner
