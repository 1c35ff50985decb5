"""Vegetation: points above the ground that are neither of buildings nor of other solid objects."""

from typing import Optional

import numpy as np

from ..cloud.asprs import VEGETATION, PointClass
from ..cloud.reasons import Reason
from ..criteria import MAJORITY
from ..geometry.boxes import connect
from ..geometry.groups import least_of
from ..neighborhoods.covariance import Nearest, reduce_neighborhoods, symmetric_eigenvalues
from ..neighborhoods.nearest_blocks import Shapes
from ..rules import rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.density import link_distance
from ..sampling.surface_noise import LEAST_NEIGHBORS, ON_PLANE, SURFACES
from ..stage import Monitor, stage, tunable

# Points of these classes may be vegetation; all others stay.
_OPEN = (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED, *VEGETATION)


# Heights above the ground (m) from which vegetation is medium and high.
HEIGHTS = {
    "2 m and 5 m": (2.0, 5.0),
    "0.5 m and 2 m": (0.5, 2.0),
    "0.5 m and 1.5 m (IGN)": (0.5, 1.5),
    "0.3 m and 2 m (ICSM)": (0.3, 2.0),
}

# Reach (m) of objects in a cloud that is processed in parts: half the length of a car. Of longer objects the part
# within it decides.
_REACH = 2.5


@rules
class _RULES:
    """Rules by which solid objects are recognized."""

    #: Points of one object are closer in height (m): the distance between the bonnet of a car and its roof is less
    step: float = 1.0
    #: Highest smooth object (m): vans, containers and garden walls are lower, the smooth sides of crowns higher
    highest: float = 3.5
    #: Largest share of points whose pulse had several returns. Edges of cars give 0.1; crowns and bushes of the clouds
    #: with truth 0.3 to 0.9.
    most_passed: float = 0.2
    #: Least ratio of the height of poles to their extent in plan: lamps with an arm have 4, trees 1 to 2
    slenderness: float = 4.0


@stage(
    "Land cover",
    tags="vegetation,tree,canopy,bush,hedge,crown,plant,forest,low,medium,high,car,pole,fence",
    writes=("classification",),
    reach=_REACH,
    cost=1.0,
)
def classify_vegetation(
    xyz,
    classification,
    height_above_ground,
    number_of_returns=None,
    reason=None,
    *,
    look_for: bool = tunable(True, label="Look for vegetation"),
    heights: str = tunable("2 m and 5 m", label="Heights of medium and high vegetation", choices=tuple(HEIGHTS)),
    min_height: float = tunable(0.1, within="[0, 10] m"),
    medium_height: Optional[float] = tunable(
        None,
        label="Medium vegetation from",
        within="[0, 100] m",
        automatic="the lower one of the heights chosen above.",
        advanced=True,
    ),
    high_height: Optional[float] = tunable(
        None,
        label="High vegetation from",
        within="[0, 100] m",
        automatic="the higher one of the heights chosen above.",
        advanced=True,
    ),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Classify low, medium and high vegetation: points above the ground without another class.

    Cars, garden walls, fences, boats and poles stay unclassified (1): objects whose surfaces are smooth and reflect the
    whole pulse, and slender upright ones. So do decks with ramps, footbridges among them, of any height. Ground,
    buildings, water, noise and all other classes stay as they are.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes. Points of 0 and 1 are looked at; earlier vegetation (3, 4, 5) is classified anew.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.
    number_of_returns : ndarray of shape (n,), uint8, optional
        Returns of each point's pulse. Without it all objects count as opaque.
    reason : ndarray of shape (n,), uint8, optional
        Reasons of 'Segment roofs', which finds raised surfaces that continue into the ground: decks with ramps.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Low, medium and high vegetation 3, 4 and 5; 1 for points that were examined and are not vegetation.

    Other Parameters
    ----------------
    look_for
        If not, no class changes. For models that contain this step.
    heights
        Height above the ground from which vegetation is medium (4), and that from which it is high (5); below both it
        is low (3). The last two are of the French and the Australian surveys.
    min_height
        Points at least this high above the ground are vegetation; all others are unclassified.
    medium_height
        Height above the ground from which vegetation is medium (4).
    high_height
        Height above the ground from which vegetation is high (5).

    Raises
    ------
    ValueError
        If high vegetation begins lower than medium vegetation.

    Notes
    -----
    Run it after 'Complete buildings': nearly all other points above the ground are vegetation then. An object is
    a group of points that are connected in plan and height. It is solid if it is no higher than 3.5 m and less than a
    fifth of its pulses had several returns, and half of its points have neighbors that deviate from a plane no more
    than points of roofs and walls do. It is a pole if it is four times as high as its extent in plan. In thin clouds
    few cars are recognized: there are too few points for a plane. Objects that touch a plant are vegetation with it.

    References
    ----------
    ASPRS, 2019. LAS specification 1.4, R15, table 17. [asprs2019]

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> xyz = rng.uniform(0, 5, (500, 3))
    >>> found = classify_vegetation(xyz, np.ones(500), xyz[:, 2])
    >>> sorted({int(code) for code in found})
    [1, 3, 4]
    """
    classes = classification.astype(np.uint8)
    if not look_for:
        return classes
    medium, high = HEIGHTS[heights]
    medium = medium if medium_height is None else medium_height
    high = high if high_height is None else high_height
    if high < medium:
        raise ValueError(
            f"High vegetation from (high_height) must be at least medium vegetation from ({medium:g} m), got {high:g} "
            "m; raise it or lower the other."
        )
    monitor.resolved(medium_height=medium, high_height=high)
    is_open = np.isin(classification, _OPEN)
    plants = np.flatnonzero(is_open & (height_above_ground >= min_height))
    has_passed = np.zeros(len(plants), bool) if number_of_returns is None else number_of_returns[plants] > 1
    is_solid = find_solid_objects(xyz[plants], height_above_ground[plants], has_passed, sampling, monitor)
    decks = np.flatnonzero(np.zeros(len(plants), bool) if reason is None else reason[plants] == Reason.INTO_GROUND)
    is_solid[decks] |= are_opaque(xyz[plants[decks]], has_passed[decks], sampling, monitor)
    classes[is_open] = PointClass.UNCLASSIFIED
    plants = plants[~is_solid]
    layer = np.searchsorted([medium, high], height_above_ground[plants], side="right")
    classes[plants] = np.array(VEGETATION, np.uint8)[layer]
    return classes


def find_solid_objects(
    xyz: np.ndarray, height: np.ndarray, has_passed: np.ndarray, sampling: CloudSampling, monitor: Monitor
) -> np.ndarray:
    """Return the mask of points (n,) that are of cars, walls, fences, boats and the like, or of poles.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points above the ground that are of no building, m.
    height : ndarray of shape (n,)
        Their heights above the ground, m.
    has_passed : ndarray of shape (n,), bool
        Whether their pulses are known to have had several returns.
    sampling : CloudSampling
        How the whole cloud was sampled.
    monitor : Monitor
        Receives progress.
    """
    group, size, is_opaque = _groups(xyz, has_passed, sampling, monitor.part(0, 0.6))
    low, top = least_of(height, group, len(size)), -least_of(-height, group, len(size))
    has_enough = size >= LEAST_NEIGHBORS
    candidates = np.flatnonzero((is_opaque & has_enough & (top <= _RULES.highest))[group])
    smooth = np.bincount(group[candidates], _on_surfaces(xyz[candidates], sampling, monitor.part(0.6, 1)), len(size))
    # Points of objects that are no candidates are not counted, so that these are never solid.
    is_solid = smooth >= np.maximum(MAJORITY * size, 1)
    is_pole = has_enough & (top - low >= _RULES.slenderness * _extent(group, xyz, size))
    return (is_solid | is_pole)[group]


def are_opaque(xyz: np.ndarray, has_passed: np.ndarray, sampling: CloudSampling, monitor: Monitor) -> np.ndarray:
    """Return the mask of points (n,) of groups that hardly a pulse passes.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points, m.
    has_passed : ndarray of shape (n,), bool
        Whether their pulses are known to have had several returns.
    sampling : CloudSampling
        How the whole cloud was sampled.
    monitor : Monitor
        Receives progress.
    """
    group, size, is_opaque = _groups(xyz, has_passed, sampling, monitor)
    return (is_opaque & (size >= LEAST_NEIGHBORS))[group]


def _groups(
    xyz: np.ndarray, has_passed: np.ndarray, sampling: CloudSampling, monitor: Monitor
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the object of each point (n,), the points of each object (m,), and the mask of opaque objects (m,)."""
    group = connect(xyz, link_distance(sampling.spacing), _RULES.step, monitor)
    size = np.bincount(group, minlength=1)
    return group, size, np.bincount(group, has_passed, len(size)) < _RULES.most_passed * size


def _extent(group: np.ndarray, xyz: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Return the longest extent in plan (m) of each group (m,), as of evenly spread points of the same deviation."""
    x, y = (xyz[:, :2] - xyz[:, :2].mean(axis=0)).T if len(xyz) else np.zeros((2, 0))
    count = np.maximum(size, 1)
    x, y = (values - (np.bincount(group, values, len(size)) / count)[group] for values in (x, y))
    xx, yy, xy = (np.bincount(group, product, len(size)) / count for product in (x * x, y * y, x * y))
    return np.sqrt(12 * ((xx + yy) / 2 + np.hypot((xx - yy) / 2, xy)))


def _on_surfaces(xyz: np.ndarray, sampling: CloudSampling, monitor: Monitor) -> np.ndarray:
    """Return the mask of points (n,) whose neighbors deviate from a plane no more than points of surfaces do."""
    is_smooth = np.zeros(len(xyz), bool)
    if len(xyz) < LEAST_NEIGHBORS:
        return is_smooth
    most = ON_PLANE * sampling.roughness

    def keep(rows: np.ndarray, shapes: Shapes) -> None:
        # A plane through k points leaves k - 3 degrees of freedom.
        variance = symmetric_eigenvalues(shapes.covariances)[:, 2] * shapes.counts / np.maximum(shapes.counts - 3, 1)
        is_smooth[rows] = (variance <= most**2) & (shapes.counts >= LEAST_NEIGHBORS)

    count = round(float(np.pi * SURFACES.least_reach**2 * sampling.density))
    reduce_neighborhoods(xyz, Nearest(min(max(count, LEAST_NEIGHBORS), SURFACES.most_neighbors)), keep, monitor=monitor)
    return is_smooth
