"""Groups of multipath points under the ground: low noise instead of pits."""

import numpy as np

from ..cloud.asprs import PointClass
from ..packages import spatial
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import stage
from .classify_ground_tin import GROUND, sweep
from .false_pits import false_pits
from .ground_points import in_plan_order, last_returns, usable_points
from .ground_seeds import lowest_points
from .tin_densification import JoinRules, grow

# Least side (m) of the cells whose ground points make the surface, as of the ground filter.
_LEAST_CELL = 1.0

# Points within this distance (m) in plan of a group of multipath points are classified again, as it drew the surface
# down.
_REACH = 10.0


@stage(
    "Terrain",
    title="Classify multipath under the ground",
    tags="multipath,noise,low points,pits,ground,DTM",
    writes=("classification",),
    reach=2 * _REACH,
)
def classify_multipath(
    xyz, classification, return_number=None, number_of_returns=None, *, sampling: CloudSampling = MEASURED, monitor=None
):
    """Find groups of multipath points under the ground, which a ground filter takes for pits.

    They become low noise (class 7), and the ground around them that they hid becomes ground (class 2). Small pools and
    sunken yards that few pulses reached become noise too, so look at the result.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes with ground (2).
    return_number, number_of_returns : ndarray of shape (n,), uint8, optional
        Where given, only last returns are looked for.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        ASPRS classes, ground 2, low noise 7.

    Raises
    ------
    ValueError
        If no point is ground.

    Notes
    -----
    Multipath points lie under the ground along their beams, and several from one mirror make a pit. Such a pit is a
    group of points up to 3 m wide, lower by 0.45 m or more than smooth ground all round. No terrain leads down to it,
    and its points do not cover it as a floor does. Either other pulses reach the ground between them, or they are
    closer together than pulses are, or they are fewer than six. Light shafts, cellar stairs and excavations, whose
    floors stop every pulse, stay ground. The surface grows from the lowest ground point of each cell onto the others,
    as in 'Classify ground points (TIN)'.

    References
    ----------
    Axelsson, P., 2000. DEM generation from laser scanner data using adaptive TIN models. International Archives of
    Photogrammetry and Remote Sensing 33 (B4), 110-117. [axelsson2000]
    The search for multipath is this project's.

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> low = np.vstack([xyz, [5.2, 5.2, -3]])
    >>> int(classify_multipath(low, np.where(low[:, 2] > 0, 1, 2))[-1])
    7
    """
    if not (classification == PointClass.GROUND).any():
        raise ValueError("The cloud has no ground points (class 2); run 'Classify ground points (TIN)' first.")
    xyz = sampling.from_corner(xyz)
    usable = in_plan_order(xyz, usable_points(xyz, classification), sampling.spacing)
    points, classes = xyz[usable], classification[usable].copy()
    is_last = last_returns(return_number, number_of_returns, usable)
    cell_size = max(_LEAST_CELL, sampling.spacing)
    is_ground = (classes == PointClass.GROUND) & is_last
    lowest = lowest_points(points[is_ground], cell_size)
    seeds = np.flatnonzero(is_ground)[lowest.points(lowest.index >= 0)]
    least = sampling.height_resolution
    rules = JoinRules(GROUND.angle, None, GROUND.bend * sampling.spacing, 2 * cell_size, least)
    surface, _, _ = grow(points, seeds, is_ground, rules, monitor.part(0, 0.5))
    low = false_pits(points, surface.is_node, surface.above(), is_last, sampling.spacing, monitor.part(0.5, 0.7))
    if len(low):
        # The surface that such a group drew down is examined again.
        is_ground, _ = sweep(surface.without(low, monitor.part(0.7, 0.9)), None, cell_size, sampling)
        near = np.isfinite(spatial.cKDTree(points[low, :2]).query(points[:, :2], distance_upper_bound=_REACH)[0])
        undecided = near & np.isin(classes, (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED, PointClass.GROUND))
        classes[undecided] = np.where(is_ground[undecided], PointClass.GROUND, PointClass.UNCLASSIFIED)
        classes[low] = PointClass.LOW_NOISE
    monitor.resolved(low_noise=len(low))
    result = classification.astype(np.uint8)
    result[usable] = classes
    return result
