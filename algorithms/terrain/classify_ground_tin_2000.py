"""Ground points by progressive TIN densification, as published in 2000."""

from functools import partial
from typing import Optional

import numpy as np

from ..geometry.tin import CORNERS, Tin
from ..rules import rule, rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import stage, tunable
from .classify_ground_tin import EDGE_LENGTH, ITERATION_DISTANCE, SWEEP_DISTANCE
from .ground_points import in_plan_order, last_returns, usable_points, with_ground
from .ground_seeds import USUAL_BUILDING, seeds_by_lowest
from .tin_densification import DENSIFICATION, JoinRules, grow, offset_and_angle, surface_roughness, to_nearest_node


@rules
class _RULES:
    """How points join the surface; the ground filter of this project has its own."""

    edge: float = rule(2.0, "m", "least automatic edge length of facets; points are mirrored over half of it")
    bend: float = rule(0.5, "point spacings", "by which the surface may bend between points, when they join")
    sweep: float = rule(6.0, "deviations", "roughness of the finished surface within which points are ground")
    level: float = rule(20.0, "°", "slope beyond a breakline up to which the surface carries a mirrored point on")
    share: float = rule(0.25, "share", "of the distance at which others join, within which a mirrored point joins")


@stage(
    "Terrain",
    title="Classify ground points (TIN, as published 2000)",
    tags="ground,filter,terrain,bare earth,DTM,Axelsson,PTD",
    writes=("classification",),
    reach=lambda tunables: tunables["max_building_size"],
    cost=40.0,
)
def classify_ground_tin_2000(
    xyz,
    classification,
    return_number=None,
    number_of_returns=None,
    *,
    max_building_size: float = tunable(USUAL_BUILDING, within="[1, 1000] m"),
    terrain_angle: float = tunable(88.0, within="(0, 90]°", advanced=True),
    iteration_angle: float = tunable(20.0, within="(0, 90]°"),
    iteration_distance: Optional[float] = ITERATION_DISTANCE.with_automatic(
        f"{DENSIFICATION.deviations:g} times the roughness of the surface, estimated in each round; or half of that "
        f"and {_RULES.bend:g} point spacings, if that is more."
    ),
    edge_length: Optional[float] = EDGE_LENGTH.with_automatic(f"the point spacing, at least {_RULES.edge:g} m."),
    sweep_distance: Optional[float] = SWEEP_DISTANCE.with_automatic(
        f"{_RULES.sweep:g} times the roughness of the finished surface."
    ),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find the ground by letting a triangulated surface grow from the lowest point of each large cell.

    Ground points get class 2. Points of class 7 and 18 (noise) are never used and keep their class, points that
    were ground before and are not found again become 1 (unclassified), all others keep their class. Classify
    noise first: points far below the ground pull the surface down.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes.
    return_number, number_of_returns : ndarray of shape (n,), uint8, optional
        Where given, only last returns start and grow the surface; the final sweep takes all returns in.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        ASPRS classes, ground 2.

    Other Parameters
    ----------------
    max_building_size
        Cell whose lowest point starts the surface: the shorter side of the largest building. Smaller keeps more of
        narrow hilltops. In lasground, the tool that the authors of 2019 used, it is 5 m in nature, 10 m in towns, 25 m
        in cities and 50 m in the largest cities.
    terrain_angle
        Steepest line from a point to the nodes of its facet under which it joins the surface.
    iteration_angle
        Upper bound of the angle between a facet and the lines to its nodes under which a point joins the surface, which
        is estimated in each round. Larger follows steeper breaks and lets more low objects in.

    Raises
    ------
    ValueError
        If fewer than three points are left to look for ground in, all lie on one line, or they are spread so thinly
        that the cloud is nearly empty.

    Notes
    -----
    The lowest point of each cell as large as the largest building makes a first TIN. In each round at most one point
    per facet joins it: the one with the smallest angle to the facet's nodes, if angle and distance to the facet are
    under the thresholds. Both thresholds are estimated in each round from the nodes: 8 robust standard deviations of
    their distances from the plane of their neighbors, and of the angles under which these appear from the nearest
    node. A point that lies too high above its facet is tried again at its mirror image about the facet's highest node,
    if that is one of the first nodes. Rounds go on until no point qualifies, and every point is tried in each.

    The papers leave open how many deviations the thresholds are, and the part of the point spacing that the distance
    allows for. They have no bound of the angle, without which rough first nodes let the surface climb onto anything.
    They have no terrain angle either, with which programs in use bound the slope between nodes. Unlike there, facets
    with short edges are closed, and points near a node don't join, as they add nodes but no shape. The final sweep
    takes in the points within the noise of the finished surface, as the tools in use do; sweep distance 0 leaves it
    out. The paper of 2019 took 'city' of lasground, whose step is 25 m: that is a maximum building size of 25 m.

    References
    ----------
    Axelsson, P., 2000. DEM generation from laser scanner data using adaptive TIN models. International Archives of
    Photogrammetry and Remote Sensing 33 (B4), 110-117. [axelsson2000]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = classify_ground_tin_2000(xyz, np.zeros(len(xyz)))
    >>> bool((classes[z == 0] == 2).all()), bool((classes[z > 0] == 2).any())
    (True, False)
    """
    xyz = sampling.from_corner(xyz)
    usable, spacing = usable_points(xyz, classification), sampling.spacing
    usable = in_plan_order(xyz, usable, spacing)
    points, last = xyz[usable], last_returns(return_number, number_of_returns, usable)
    edge_length = max(_RULES.edge, spacing) if edge_length is None else edge_length
    least = sampling.height_resolution

    seeds = np.flatnonzero(last)[seeds_by_lowest(points[last], max_building_size)]
    rules = JoinRules(
        max_angle=iteration_angle,
        max_distance=iteration_distance,
        bend=_RULES.bend * spacing,
        edge_length=edge_length,
        least=least,
        estimates_angle=True,
        terrain_angle=terrain_angle,
        is_exhaustive=True,
        beyond=partial(mirrored_angle, longest=max(_RULES.edge / 2, spacing)),
    )
    surface, distance, angle = grow(points, seeds, last, rules, monitor.part(0, 0.9))
    if sweep_distance is None:
        sweep_distance = _RULES.sweep * surface_roughness(surface.nodes, least)
    monitor.resolved(iteration_distance=distance, last_angle=angle)
    monitor.resolved(edge_length=edge_length, sweep_distance=sweep_distance)
    return with_ground(classification, usable[surface.within(sweep_distance)])


def mirrored_angle(
    tin: Tin, facet: np.ndarray, points: np.ndarray, distance: float, n_start: int, *, longest: float
) -> np.ndarray:
    """Return the angles (°) of points that lie beyond a breakline, at their mirror images; inf where they don't fit.

    A point above its facet is turned about the facet's highest node (Axelsson's mirror point). Where the surface on
    that other side is nearly level and has the image, the point carries it on to the upper edge of a terrace. Only
    seeds mirror, so that the surface can't climb on by itself.

    Parameters
    ----------
    tin : Tin
        The surface.
    facet : ndarray of shape (n,), int
        The facet under each point.
    points : ndarray of shape (n, 3), float64
        Points, m.
    distance : float
        Largest distance at which a point joins its facet, m.
    n_start : int
        Number of seeds, the first nodes of the surface.
    longest : float
        Longest distance in plan over which a point is mirrored, m.
    """
    angle = np.full(len(points), np.inf)
    corners = tin.facets[facet]
    highest = corners[np.arange(len(corners)), np.argmax(tin.nodes[corners, 2], axis=1)]
    image = 2 * (tin.nodes[highest] + tin.shift) - points
    reach = np.linalg.norm(points[:, :2] - image[:, :2], axis=1) / 2
    rows = np.flatnonzero((corners >= CORNERS).all(axis=1) & (reach < longest) & (highest < CORNERS + n_start))
    rows = rows[points[rows, 2] > tin.elevation(points[rows], facet[rows])]
    image = image[rows]
    other_facet = tin.locate_near(image, highest[rows])
    offset, image_angle = offset_and_angle(tin, other_facet, image, to_nearest_node(tin, other_facet, image))
    level = (tin.slope_cosine() > np.cos(np.radians(_RULES.level))) & ~tin.is_extrapolated()
    fits = (offset <= _RULES.share * distance) & level[other_facet]
    angle[rows[fits]] = image_angle[fits]
    return angle
