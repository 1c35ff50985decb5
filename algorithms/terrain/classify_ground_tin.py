"""Ground points by progressive TIN densification, from seeds by progressive opening.

In matched images, points on smeared small objects are left out.
"""

from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.grid import EIGHT, raster_cells, refuse_sparse
from ..geometry.groups import mask_of
from ..geometry.raster_opening import open_surface
from ..packages import ndimage
from ..params import POINT_SOURCE
from ..rules import rule, rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.density import DENSITY
from ..sampling.kinds import LASER, SCENE
from ..stage import stage, tunable
from .free_standing import FREE
from .ground_points import in_plan_order, last_returns, usable_points, with_ground
from .ground_seeds import USUAL_BUILDING, seeds_by_opening
from .tin_densification import DENSIFICATION, JoinRules, Surface, grow, surface_roughness


@rules
class GROUND:
    """How points of the ground join its surface, and lie near it."""

    bend: float = rule(0.5, "point spacings", "by which the surface may bend between points")
    sweep: float = rule(
        6.0, "deviations", "statistics: roughness of the finished surface within which points are ground"
    )
    sweep_noise: float = rule(4.0, "deviations", "beyond which low plants make the roughness larger than noise")
    sweep_bend: float = rule(0.1, "cells", "greatest increase of the distance beyond that, for bends of the surface")
    angle: float = rule(20.0, "°", "fitted on eight ISPRS samples: iteration angle where terrain is not nature")
    angle_in_nature: float = rule(
        30.0, "°", "physics: iteration angle in nature, where breaks are steeper and objects fewer"
    )


# Key of the roughness (m) of the finished surface, which blocks take from the whole survey.
_ROUGHNESS = "surface_roughness"

# The kinds of terrain, each with a largest building twice as wide as the one before.
_TERRAINS = ("nature", "village", "town", "city", "industry")


@rules
class SMEARED:
    """Small objects with smeared walls in matched images."""

    width: float = rule(
        4.5, "m", "physics: narrower raised surfaces are objects: a shed of 3 m, walls smeared over 0.7 m"
    )


def _largest_building(terrain: str) -> float:
    """Return the shorter side (m) of the largest building of a kind of terrain."""
    return USUAL_BUILDING * 2.0 ** (_TERRAINS.index(terrain) - _TERRAINS.index("town"))


# The granularities: least cell, m. Cells are at least as wide as the point spacing, half of it where fine.
_GRANULARITIES = {"coarse": 2.0, "medium": 1.0, "fine": 1.0, "extra fine": 0.5}

# Least distance (m) around a part of a cloud within which points decide on its ground. In blocks of Delft with this
# reach, buildings agree with the whole cloud on 99.8 % of the points, and on no more with twice the reach: the rest
# depends on where cells begin.
_REACH = 40.0


ITERATION_DISTANCE = tunable(
    None,
    "Largest distance from its facet at which a point joins the surface.",
    within="(0, 100] m",
    automatic=f"{DENSIFICATION.deviations:g} times the roughness of the surface, measured again in each round; "
    f"or half of that and {GROUND.bend:g} point spacings, if that is more.",
    advanced=True,
)


EDGE_LENGTH = tunable(
    None,
    "Facets whose edges are all shorter are not refined.",
    within="[0, 1000] m",
    automatic="twice the grid cell size.",
    advanced=True,
)


SWEEP_DISTANCE = tunable(
    None,
    "Points at most this far above or below the finished surface are ground too; 0 leaves its nodes only.",
    within="[0, 100] m",
    automatic=f"{GROUND.sweep_noise:g} times the roughness of the finished surface, or the surface noise where "
    f"that is more; increased by a half, but by {GROUND.sweep_bend:g} cells at most.",
    advanced=True,
)


@stage(
    "Terrain",
    title="Classify ground points (TIN)",
    tags="ground,filter,terrain,bare earth,DTM,Axelsson,PTD,PTIN,PMF,SMRF,lasground",
    writes=("classification",),
    reach=lambda tunables: max(tunables["max_building_size"] or 0.0, _REACH),
    of_whole=(_ROUGHNESS,),
    cost=6.0,
)
def classify_ground_tin(
    xyz,
    classification,
    return_number=None,
    number_of_returns=None,
    *,
    terrain: Optional[str] = tunable(
        None,
        "Kind of terrain and of its buildings: it sets the maximum building size "
        f"({', '.join(f'{_largest_building(kind):g}' for kind in _TERRAINS)} m) and the iteration angle "
        f"({GROUND.angle_in_nature:g}° in nature, else {GROUND.angle:g}°) where these are automatic.",
        choices=_TERRAINS,
        automatic="the smallest kind from town on that has room for the largest building found.",
    ),
    granularity: Optional[str] = tunable(
        None, choices=tuple(_GRANULARITIES), automatic="fine where points are farther apart than 1 m, else medium."
    ),
    max_building_size: Optional[float] = tunable(
        None,
        within="[1, 1000] m",
        automatic=(
            f"{USUAL_BUILDING:g} m, and any size for segments that are free-standing on nearly all sides; or "
            "as the kind of terrain has it."
        ),
    ),
    cell_size: Optional[float] = tunable(
        None,
        label="Grid cell size",
        within="[0.1, 100] m",
        automatic="half the point spacing (coarse and medium: the whole), at least the granularity's.",
        advanced=True,
    ),
    iteration_angle: Optional[float] = tunable(
        None, within="(0, 90]°", automatic=f"{GROUND.angle:g}°, in nature {GROUND.angle_in_nature:g}°."
    ),
    iteration_distance: Optional[float] = ITERATION_DISTANCE,
    edge_length: Optional[float] = EDGE_LENGTH,
    sweep_distance: Optional[float] = SWEEP_DISTANCE,
    keep_ground: bool = tunable(False, label="Keep existing ground"),
    source: str = POINT_SOURCE,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find the ground by letting a triangulated surface grow through the lowest points.

    Ground points get class 2. Points of class 7 and 18 (noise) are never used and keep their class, points that were
    ground before and are not found again become 1 (unclassified), all others keep their class. Classify noise first:
    points far below the ground pull any ground filter down. 'Classify multipath under the ground' finds pits of noise.

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
    granularity
        How finely the surface is started and refined: it sets the grid cell size where that is automatic, at least 2 m
        (coarse), 1 m (medium, fine) or 0.5 m (extra fine).
    max_building_size
        The shorter side of the largest building; smaller keeps more of narrow hilltops.
    cell_size
        Cell in which the lowest point is looked for.
    iteration_angle
        Largest angle between a facet and the lines to its nodes under which a point joins the surface; larger follows
        steeper breaks and lets more low objects in.
    keep_ground
        Where the cloud has ground (2) already, it stays as it is and no other is looked for.

    Raises
    ------
    ValueError
        If fewer than three points are left to look for ground in, all lie on one line, or they are spread so thinly
        that the cloud is nearly empty.

    Notes
    -----
    Seeds make a first TIN: the lowest points of cells that stay when the lowest surface is opened with growing windows.
    In each round at most one point per facet joins it: the one with the smallest angle to the facet's nodes, if angle
    and distance to the facet are under the thresholds. The distance threshold is estimated in each round from the
    residuals of the nodes over the plane of their neighbors, and allows for the point spacing; the largest angle is
    fixed. The growth ends when hardly any point joins. Distances are measured across the facet, so that slopes don't
    loosen or tighten them. Free-standing segments, with steps down all round, are excluded from the seeds and from
    densification.

    The final sweep adds the points within the noise of the finished surface, which the paper leaves unclassified.
    Where strips overlap that were not adjusted to one another, the surface follows the lower one; 'Complete ground'
    takes the points of the other in.

    In clouds of matched images walls are smeared to slopes that the surface climbs; ground points on objects narrower
    than 4.5 m, and on the feet of walls, are taken out again. Halls on slopes, whose uphill eaves are 1 m or more above
    the terrain, are free-standing there if the steps around them are 2 m high on the mean.

    The kinds of terrain are this stage's own. The steps of lasground by the same names are smaller. 'Classify ground
    points (TIN, as published 2000)' starts from the seeds of the paper, and has none of the additions.

    References
    ----------
    Axelsson, P., 2000. DEM generation from laser scanner data using adaptive TIN models. International Archives of
    Photogrammetry and Remote Sensing 33 (B4), 110-117. [axelsson2000]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = classify_ground_tin(xyz, np.zeros(len(xyz)))
    >>> bool((classes[z == 0] == 2).all()), bool((classes[z > 0] == 2).any())
    (True, False)
    """
    if keep_ground and (classification == PointClass.GROUND).any():
        return classification.astype(np.uint8)
    xyz = sampling.from_corner(xyz)
    usable, spacing = usable_points(xyz, classification), sampling.spacing
    usable = in_plan_order(xyz, usable, spacing)
    points, is_last = xyz.take(usable, axis=0), last_returns(return_number, number_of_returns, usable)
    granularity, cell_size = _cell(granularity, cell_size, spacing)
    edge_length = 2 * cell_size if edge_length is None else edge_length
    size = _largest_building(terrain) if max_building_size is None and terrain else max_building_size
    usual_angle = GROUND.angle_in_nature if terrain == "nature" else GROUND.angle
    angle = usual_angle if iteration_angle is None else iteration_angle

    # 1. Seeds. Free-standing segments may not join either: the surface would climb noisy roofs a step at a time.
    kind = sampling.kind(source)
    seeds, stands_free, size = seeds_by_opening(
        points[is_last], cell_size, size, monitor.part(0, 0.3), spacing, low_uphill=kind.is_surface
    )
    may_join = is_last.copy()
    may_join[is_last] = ~stands_free
    if terrain is None:
        kinds = _TERRAINS[_TERRAINS.index("town") :]
        terrain = next((kind for kind in kinds if size <= _largest_building(kind)), kinds[-1])
    monitor.resolved(terrain=terrain, granularity=granularity, max_building_size=size, cell_size=cell_size)

    # 2. The surface grows from them.
    scale, least = max(cell_size, spacing), sampling.height_resolution
    rules = JoinRules(angle, iteration_distance, GROUND.bend * spacing, edge_length, least)
    surface, distance, _ = grow(points, np.flatnonzero(is_last)[seeds], may_join, rules, monitor.part(0.3, 0.9))

    # 3. Points near the finished surface are ground.
    is_ground, sweep_distance = sweep(surface, sweep_distance, scale, sampling)
    monitor.resolved(iteration_angle=angle, iteration_distance=distance)
    monitor.resolved(edge_length=edge_length, sweep_distance=sweep_distance)
    if kind.is_surface:
        is_ground &= ~on_smeared_objects(points, is_ground, spacing)
    return with_ground(classification, usable[is_ground])


def _cell(granularity: Optional[str], cell_size: Optional[float], spacing: float) -> tuple[str, float]:
    """Return the granularity and the cell (m) that go with a point spacing (m)."""
    if granularity is None:
        granularity = "fine" if spacing > 1 else "medium"
    least, cells = _GRANULARITIES[granularity], 0.5 if granularity.endswith("fine") else 1.0
    return granularity, max(least, cells * spacing) if cell_size is None else cell_size


def sweep(
    surface: Surface, distance: Optional[float], scale: float, sampling: CloudSampling
) -> tuple[np.ndarray, float]:
    """Return the mask of points that lie within ``distance`` of the surface or are its nodes, and that distance.

    Parameters
    ----------
    surface : Surface
        The finished surface.
    distance : float, optional
        Largest distance from it, m; None takes it from the roughness, and adds a share of ``scale`` for bends.
    scale : float
        Length over which the surface bends, m: cell size or point spacing.
    sampling : CloudSampling
        How the cloud was sampled.
    """
    if distance is not None:
        return surface.within(distance), distance
    of_nodes = sampling.shared(_ROUGHNESS, lambda: surface_roughness(surface.nodes, sampling.height_resolution))
    # The lowest points of a dense cloud agree better than others do.
    roughness = max(of_nodes, sampling.noise)
    distance = min(GROUND.sweep * roughness, GROUND.sweep_noise * roughness + GROUND.sweep_bend * scale)
    return surface.within(distance), distance


def on_smeared_objects(xyz: np.ndarray, is_ground: np.ndarray, spacing: float) -> np.ndarray:
    """Return the mask of ground points (n,) on small objects: a ground surface climbs them over smeared walls.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    is_ground : ndarray of shape (n,), bool
        Points that the filter has found to be ground.
    spacing : float
        Point spacing (m).

    Notes
    -----
    The lowest ground points of cells are opened with a window of ``SMEARED.width`` m. Planes of any slope and plateaus
    wider than the window stay as they are. Sheds are removed, and so is the ring of ground points on the smeared walls
    of a house, since no window is centered on its roof. Ridges and dikes narrower than the window rise above the
    opened surface as well: objects longer than two windows stay, except for such rings.
    """
    if not is_ground.any():
        return np.zeros(len(xyz), bool)
    size = max(SCENE.least_cell, DENSITY.filled_cell * spacing)
    refuse_sparse(xyz, size)
    radius = max(1, round(SMEARED.width / 2 / size))
    row, column = raster_cells(xyz, size, radius + 1)
    lowest = np.full((row.max() + radius + 2, column.max() + radius + 2), np.inf)
    np.minimum.at(lowest, (row[is_ground], column[is_ground]), xyz[is_ground, 2])
    has_ground, is_occupied = np.isfinite(lowest), mask_of(lowest.shape, (row, column))
    is_far = ndimage.distance_transform_edt(~has_ground) > radius
    opened = open_surface(lowest, radius, is_far | (is_occupied & ~has_ground))
    # On a slope a point may lie higher than the lowest one of its cell, but not higher than the lowest one of the next
    # cell uphill.
    highest = ndimage.maximum_filter(np.where(has_ground, opened, -np.inf), 3)
    is_above = is_ground & (xyz[:, 2] > highest[row, column] + LASER.foot)
    above = mask_of(lowest.shape, (row[is_above], column[is_above]))
    return is_above & _of_objects(above, is_occupied & ~has_ground, size)[row, column]


def _of_objects(above: np.ndarray, is_other: np.ndarray, size: float) -> np.ndarray:
    """Return the mask of cells (rows, columns) ``above`` the surface, of small objects or next to large ones.

    Cells of large ones are ``is_other`` (rows, columns): they have points, and no ground.
    """
    # Parts are joined over a cell: noise interrupts crests of terrain. Parts longer than two windows are such crests.
    part, count = ndimage.label(ndimage.binary_dilation(above, EIGHT), EIGHT)
    is_short = np.zeros(count + 1, bool)
    for number, box in enumerate(ndimage.find_objects(part), 1):
        is_short[number] = max(side.stop - side.start - 2 for side in box) * size <= 2 * SMEARED.width
    to_other = ndimage.distance_transform_edt(~is_other) * size if is_other.any() else np.full(above.shape, np.inf)
    cells = np.bincount(part[above], minlength=count + 1)
    beside = np.bincount(part[above & (to_other <= SMEARED.width / 2)], minlength=count + 1)
    return above & (is_short | (beside >= FREE.most * np.maximum(cells, 1)))[part]
