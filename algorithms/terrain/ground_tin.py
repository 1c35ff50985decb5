"""Ground points by progressive TIN densification."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..cloud.cells import distinct, grid_over, plan_box
from ..cloud.density import point_density
from ..cloud.rounding import LEAST_DEVIATION, least_deviation
from ..stage import Monitor, Param, stage
from .seeds import USUAL_BUILDING, seeds_by_lowest, seeds_by_opening
from .tin import CORNERS, Tin, node_residuals, robust_deviation

# A point may join the TIN within this many times the measured roughness of the surface; half of that will do where
# this share of the point spacing, by which the surface bends where nothing was seen, makes it more.
_GROW_DEVIATIONS, _GROW_BEND = 8.0, 0.5

# It belongs to the finished ground within so many times the roughness; the latter is more than noise where
# plants stand, so that what lies over the first number is at most this share of a cell or the spacing.
_SWEEP_DEVIATIONS, _SWEEP_NOISE, _SWEEP_BEND = 6.0, 4.0, 0.1

# Where flight strips don't fit together, the surface follows the lowest. Others lie up to so far (m) above what is
# ground by these distances, at most as far again; and the air over them is empty, where plants and cars go on
# upward: in squares of so many point spacings, a band as high as all below has at most this share of their points.
_MISFIT, _REGION, _EMPTY = 0.15, 40.0, 0.1

# Beyond a breakline the surface goes on as it comes if it is not steeper than this (°), for points within this
# share of the distance at which they join.
_LEVEL, _MIRROR_SHARE = 20.0, 0.25

# What the kind of terrain means: shorter side of the largest building (m) and iteration angle (°).
_TERRAINS = {
    "nature": (20.0, 30.0),
    "village": (40.0, 20.0),
    "town": (USUAL_BUILDING, 20.0),
    "city": (120.0, 20.0),
    "industry": (250.0, 20.0),
}
_ANGLE = 20.0

# What granularity means: least cell (m), and cells per point spacing.
_GRANULARITIES = {"coarse": (2.0, 1.0), "medium": (1.0, 1.0), "fine": (1.0, 0.5), "extra fine": (0.5, 0.5)}

# Points are put in the order of squares so many point spacings wide.
_SQUARE = 10.0

# Rounds end when they add less than this share of the nodes.
_LEAST_GROWTH = 0.005
_MAX_ROUNDS = 50

# Candidates farther than this from the first TIN (in iteration distances) never come near it later.
_CANDIDATE_DISTANCES = 5.0


@stage(
    "Classify ground points (TIN)",
    group="Terrain",
    tags="ground,filter,terrain,bare earth,DTM,Axelsson,PTD",
    writes=("classification",),
)
def classify_ground_tin(
    xyz,
    classification,
    return_number=None,
    number_of_returns=None,
    *,
    terrain: Annotated[
        Optional[str],
        Param(
            "Terrain",
            "What the largest buildings are like: it sets the maximum building size (20, 40, 60, 120, 250 m) and the "
            "iteration angle (30° in nature, else 20°) where these are automatic.",
            choices=tuple(_TERRAINS),
            automatic="the smallest kind from town on that has room for the largest building found.",
        ),
    ] = None,
    granularity: Annotated[
        Optional[str],
        Param(
            "Granularity",
            "How finely the surface is started and refined: it sets the grid cell size where that is automatic, at "
            "least 2 m (coarse), 1 m (medium, fine) or 0.5 m (extra fine).",
            choices=tuple(_GRANULARITIES),
            automatic="fine where points are farther apart than 1 m, else medium.",
        ),
    ] = None,
    seeds: Annotated[
        str,
        Param(
            "Seeds",
            "Where the surface starts: 'opening' takes the lowest points that growing windows don't lift off the "
            "terrain, 'lowest' the lowest point of each cell as large as the largest building, as published in 2000.",
            choices=("opening", "lowest"),
        ),
    ] = "opening",
    max_building_size: Annotated[
        Optional[float],
        Param(
            "Maximum building size",
            "The shorter side of the largest building; smaller keeps more of narrow hilltops.",
            unit="m",
            low=1,
            high=1000,
            automatic="60 m, and any size for what stands free of the terrain on nearly all sides; or as the terrain "
            "says.",
        ),
    ] = None,
    cell_size: Annotated[
        Optional[float],
        Param(
            "Grid cell size",
            "Cell in which the lowest point is looked for (opening seeds).",
            unit="m",
            low=0.1,
            high=100,
            automatic="half the point spacing (coarse and medium: the whole), at least what the granularity says.",
            advanced=True,
        ),
    ] = None,
    iteration_angle: Annotated[
        Optional[float],
        Param(
            "Iteration angle",
            "Largest angle between a facet and the lines to its nodes under which a point joins the surface; "
            "larger follows steeper breaks and lets more low objects in.",
            unit="°",
            low=0,
            high=90,
            open_low=True,
            automatic="20°, in nature 30°.",
        ),
    ] = None,
    iteration_distance: Annotated[
        Optional[float],
        Param(
            "Iteration distance",
            "Largest distance from its facet at which a point joins the surface.",
            unit="m",
            low=0,
            high=100,
            open_low=True,
            automatic="8 times the roughness of the surface, measured again in each round; or half of that and "
            "half the point spacing, if that is more.",
            advanced=True,
        ),
    ] = None,
    edge_length: Annotated[
        Optional[float],
        Param(
            "Edge length",
            "Facets whose edges are all shorter are not refined.",
            unit="m",
            low=0,
            high=1000,
            automatic="twice the grid cell size.",
            advanced=True,
        ),
    ] = None,
    sweep_distance: Annotated[
        Optional[float],
        Param(
            "Sweep distance",
            "Points at most this far above or below the finished surface are ground too; 0 leaves its nodes only.",
            unit="m",
            low=0,
            high=100,
            automatic="6 times the roughness of the finished surface, the last third at most a tenth of a cell; where "
            "a higher flight strip shows, twice that, at most 0.15 m more.",
            advanced=True,
        ),
    ] = None,
    monitor=None,
):
    """Find the ground by letting a triangulated surface grow through the lowest points.

    Ground points get class 2. Points of class 7 and 18 (noise) are never used and keep their class, points that
    were ground before and are not found again become 1 (unclassified), all others keep their class. Classify
    noise first: points far below the ground pull any ground filter down.

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

    Raises
    ------
    ValueError
        If fewer than three points are left to look for ground in, all lie on one line, or they are spread so thinly
        that the cloud is nearly empty.

    Notes
    -----
    Seeds make a first TIN. In each round at most one point per facet joins it: the one with the smallest angle to
    the facet's nodes, if angle and distance to the facet are under the thresholds; the distance threshold is
    estimated in each round from the residuals of the nodes over the plane of their neighbors. It ends when hardly
    any point joins. Distances are measured across the facet, so that slopes don't loosen or tighten them.
    What stands free, with steps down all round, starts the surface nowhere and joins it nowhere (not with seeds
    'lowest').

    A point that lies too high above its facet is tried again at its mirror image about the facet's highest
    node: where the surface beyond is nearly level and has the image, it is the edge of a terrace.

    The paper leaves the points within the noise of the finished surface unclassified; the final sweep takes them
    in, and sweep distance 0 leaves it out. Seeds 'lowest' are those of the paper; as mirror images are taken about
    seeds only, hardly any point joins by one then. In any case the largest angle is fixed, which the paper estimates
    from the data too, and the distance follows the point spacing as well.

    Where strips overlap that were not adjusted to one another, the surface follows the lower one. The points of the
    other are told from plants by the empty air over them, and are ground too (not with seeds 'lowest').

    References
    ----------
    Axelsson, P., 2000. DEM generation from laser scanner data using adaptive TIN models. International Archives of
    Photogrammetry and Remote Sensing 33 (B4), 110-117.
    """
    usable = np.flatnonzero(~np.isin(classification, NOISE))
    points = refuse_degenerate(xyz[usable])
    spacing = 1 / np.sqrt(point_density(points))
    # What is near in plan lies near in memory then: triangulation and searches are faster, far more so if it was not.
    usable = usable[np.argsort(grid_over(points, _SQUARE * spacing).number(points), kind="stable")]
    points = xyz[usable]
    last = _last_returns(return_number, number_of_returns, usable)
    granularity, cell_size = _cell(granularity, cell_size, spacing)
    scale = max(cell_size, spacing)
    edge_length = 2 * cell_size if edge_length is None else edge_length
    by_terrain = _TERRAINS.get(terrain or "", (None, _ANGLE))
    size = by_terrain[0] if max_building_size is None else max_building_size
    angle = by_terrain[1] if iteration_angle is None else iteration_angle

    start, stands_free, size = _start(points[last], seeds, cell_size, spacing, size, monitor.part(0, 0.3))
    # Else the surface would climb the roofs of noisy clouds, a step at a time.
    may_join = last.copy()
    may_join[last] = ~stands_free
    start = np.flatnonzero(last)[start]
    terrain = _terrain(size) if terrain is None else terrain
    rules = _Rules(angle, iteration_distance, _GROW_BEND * spacing, edge_length, scale, least_deviation(points[:, 2]))
    surface, distance = _grow(points, start, may_join, rules, monitor.part(0.3, 0.9))
    bend, region = (np.inf, 0.0) if seeds == "lowest" else (_SWEEP_BEND * scale, _REGION * spacing)
    is_ground, sweep_distance = _sweep(surface, sweep_distance, bend, region, rules.least)
    monitor.resolved(terrain=terrain, granularity=granularity, max_building_size=size, cell_size=cell_size)
    monitor.resolved(
        iteration_angle=angle, iteration_distance=distance, edge_length=edge_length, sweep_distance=sweep_distance
    )

    result = np.where(classification == PointClass.GROUND, np.uint8(PointClass.UNCLASSIFIED), classification)
    result[usable[is_ground]] = PointClass.GROUND
    return result.astype(np.uint8)


def refuse_degenerate(points: np.ndarray) -> np.ndarray:
    """Return ``points`` if they span an area in plan."""
    if len(points) < 3:
        raise ValueError(
            f"Ground needs at least 3 points that are not noise, got {len(points)}; choose a larger cloud."
        )
    centered = points[:, :2] - points[:, :2].mean(axis=0)
    extent = np.linalg.svd(centered.T @ centered, compute_uv=False)
    if extent[1] <= LEAST_DEVIATION**2 * len(points):
        raise ValueError(
            f"All {len(points)} points lie on one line or at one place in plan; ground needs an area, "
            "choose a larger cloud, or reproject this one to meters if its coordinates are degrees."
        )
    return points


def _last_returns(return_number, number_of_returns, usable: np.ndarray) -> np.ndarray:
    """Return which of the usable points are last returns; all are where the numbers say nothing."""
    if return_number is None or number_of_returns is None:
        return np.ones(len(usable), bool)
    last = return_number[usable] >= number_of_returns[usable]
    return last if last.sum() >= 3 else np.ones(len(usable), bool)


def _cell(granularity: Optional[str], cell_size: Optional[float], spacing: float) -> tuple[str, float]:
    """Return the granularity and the cell (m) that go with a point spacing (m)."""
    if granularity is None:
        granularity = "fine" if spacing > 1 else "medium"
    least, cells = _GRANULARITIES[granularity]
    return granularity, max(least, cells * spacing) if cell_size is None else cell_size


def _start(
    points: np.ndarray, seeds: str, cell_size: float, spacing: float, size: Optional[float], monitor: Monitor
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return the indices of the seeds, which points (n,) stand free, and the size (m) of the largest building."""
    if seeds == "opening":
        return seeds_by_opening(points, cell_size, size, monitor, spacing)
    size = USUAL_BUILDING if size is None else size
    return seeds_by_lowest(points, size), np.zeros(len(points), bool), size


def _terrain(size: float) -> str:
    """Return the kind of terrain whose largest building has room for ``size`` (m), from town on."""
    kinds = list(_TERRAINS)[list(_TERRAINS).index("town") :]
    return next((kind for kind in kinds if size <= _TERRAINS[kind][0]), kinds[-1])


@dataclass(frozen=True)
class _Rules:
    """When a point joins.

    Largest angle (°) and distance (m; None is measured, and ``bend`` comes on top), open edges (m), from how far
    a mirror image is taken (m), and the least roughness of a surface (m).
    """

    max_angle: float
    max_distance: Optional[float]
    bend: float
    edge_length: float
    reach: float
    least: float = LEAST_DEVIATION

    def distance(self, nodes: np.ndarray) -> float:
        """Return the largest distance (m) at which a point joins the TIN of ``nodes``."""
        if self.max_distance is not None:
            return self.max_distance
        if len(nodes) <= 3:
            return np.inf
        rough = _GROW_DEVIATIONS * robust_deviation(node_residuals(nodes), self.least)
        return max(rough, rough / 2 + self.bend)


def _grow(
    points: np.ndarray, start: np.ndarray, may_join: np.ndarray, rules: _Rules, monitor: Monitor
) -> tuple[_Surface, float]:
    """Let the TIN of the points ``start`` grow onto those that may join; return it and the last distance used."""
    surface = _Surface(points, start, monitor.part(0, 0.5))
    distance = rules.distance(surface.nodes)
    is_near = np.abs(surface.above()) <= _CANDIDATE_DISTANCES * distance
    is_near[start] = False
    candidates = np.flatnonzero(is_near & may_join)
    for step in range(_MAX_ROUNDS):
        n_nodes = len(surface.nodes)
        candidates, joining = _joining(surface, candidates, distance, rules, len(start))
        surface.add(joining)
        monitor.progress(0.5 + 0.5 * (step + 1) / _MAX_ROUNDS)
        if len(joining) <= _LEAST_GROWTH * n_nodes:
            break
        distance = rules.distance(surface.nodes)
    return surface, float(distance)


class _Surface:
    """A TIN that some of the points are nodes of, and where the others lie on it.

    Attributes
    ----------
    points : ndarray of shape (n, 3), float64
        All points (m).
    facet : ndarray of shape (n,), int32
        The facet under each.
    is_node : ndarray of shape (n,), bool
    """

    def __init__(self, points: np.ndarray, start: np.ndarray, monitor: Monitor) -> None:
        self.points = points
        self.tin = Tin(points[start], plan_box(points), monitor.part(0, 0.5))
        self.facet = self.tin.locate(points, monitor.part(0.5, 1.0))
        self.is_node = np.zeros(len(points), bool)
        self.is_node[start] = True

    @property
    def nodes(self) -> np.ndarray:
        """The nodes (m, 3), m."""
        return self.points[self.is_node]

    def add(self, joining: np.ndarray) -> None:
        """Let the points with these indices become nodes."""
        self.facet = self.tin.add(self.points, self.facet, joining)
        self.is_node[joining] = True

    def above(self) -> np.ndarray:
        """Return how far (n,) the points lie above their facets, measured across these (m)."""
        return (self.points[:, 2] - self.tin.elevation(self.points, self.facet)) * self.tin.steepness()[self.facet]


def _joining(
    surface: _Surface, candidates: np.ndarray, distance: float, rules: _Rules, n_start: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the candidates that are left for later rounds, and those that join now, one per facet."""
    tin, facet = surface.tin, surface.facet[candidates]
    # Small facets only get smaller, and a point beside a node makes a sliver and tells nothing new.
    is_open = tin.longest_edge()[facet] > rules.edge_length
    candidates, facet = candidates[is_open], facet[is_open]
    apart = _to_nearest_node(tin, facet, surface.points[candidates]) > rules.edge_length / 4
    candidates, facet = candidates[apart], facet[apart]
    here = surface.points[candidates]
    offset, angle = _offset_and_angle(tin, facet, here)
    fits = (offset <= distance) & (angle <= rules.max_angle)
    mirrored = np.flatnonzero(~fits)
    angle[mirrored] = _mirrored_angle(tin, facet[mirrored], here[mirrored], distance, rules, n_start)
    fits |= angle <= rules.max_angle
    # Ties go to the south-west, so that the points' order doesn't matter.
    order = np.lexsort((here[fits, 1], here[fits, 0], angle[fits], facet[fits]))
    first = np.unique(facet[fits][order], return_index=True)[1]
    joining = candidates[fits][order][first]
    return np.setdiff1d(candidates, joining, assume_unique=True), joining


def _mirrored_angle(
    tin: Tin, facet: np.ndarray, here: np.ndarray, distance: float, rules: _Rules, n_start: int
) -> np.ndarray:
    """Return the angles (°) of points that lie beyond a breakline, at their mirror images; inf where they don't fit.

    A point above its facet is turned about the facet's highest node (Axelsson's mirror point). Where the surface on
    that other side is nearly level and has the image, the point carries it on to the upper edge of a terrace. Only
    seeds mirror, so that the surface can't climb on by itself.
    """
    angle = np.full(len(here), np.inf)
    corners = tin.facets[facet]
    highest = corners[np.arange(len(corners)), np.argmax(tin.nodes[corners, 2], axis=1)]
    image = 2 * (tin.nodes[highest] + tin.shift) - here
    reach = np.linalg.norm(here[:, :2] - image[:, :2], axis=1) / 2
    can = (corners >= CORNERS).all(axis=1) & (reach < rules.reach)
    can[can] = (highest[can] < CORNERS + n_start) & (here[can, 2] > tin.elevation(here[can], facet[can]))
    of, image = np.flatnonzero(can), image[can]
    there = tin.locate_near(image, highest[of])
    offset, found = _offset_and_angle(tin, there, image)
    level = (tin.steepness() > np.cos(np.radians(_LEVEL))) & ~tin.is_extrapolated()
    fits = (offset <= _MIRROR_SHARE * distance) & level[there]
    angle[of[fits]] = found[fits]
    return angle


def _offset_and_angle(tin: Tin, facet: np.ndarray, here: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the distance (m) of points to their facets, and the largest angle (°) to the nodes of these."""
    offset = np.abs(here[:, 2] - tin.elevation(here, facet)) * tin.steepness()[facet]
    nearest = _to_nearest_node(tin, facet, here)
    return offset, np.degrees(np.arcsin(np.clip(offset / np.maximum(nearest, 1e-9), 0, 1)))


def _to_nearest_node(tin: Tin, facet: np.ndarray, here: np.ndarray) -> np.ndarray:
    """Return the distance (m) to the nearest node of each point's facet: the largest angle is there."""
    return np.linalg.norm(tin.nodes[tin.facets[facet]] - (here - tin.shift)[:, None], axis=2).min(axis=1)


def _sweep(
    surface: _Surface, distance: Optional[float], bend: float, region: float, least: float
) -> tuple[np.ndarray, float]:
    """Return which points lie within ``distance`` of the surface or are its nodes, and that distance.

    Where it is measured, points of higher strips are ground too, looked for in squares of ``region`` (m; 0 is not).
    """
    is_measured = distance is None
    if distance is None:
        # So few have no neighbors to differ from.
        residuals = node_residuals(surface.nodes) if len(surface.nodes) > 3 else np.zeros(1)
        roughness = robust_deviation(residuals, least)
        distance = min(_SWEEP_DEVIATIONS * roughness, _SWEEP_NOISE * roughness + bend)
    if distance == 0:
        return surface.is_node, 0.0
    above = surface.above()
    is_ground = surface.is_node | (np.abs(above) <= distance)
    if is_measured and region:
        square = distinct(grid_over(surface.points, region).number(surface.points))[1]
        is_ground |= _of_higher_strips(above, square, distance)
    return is_ground, float(distance)


def _of_higher_strips(above: np.ndarray, square: np.ndarray, distance: float) -> np.ndarray:
    """Return which points (n,) lie farther ``above`` the surface (m) than ``distance`` because their strip does.

    Squares are numbered from 0, none left out.
    """
    top = distance + min(distance, _MISFIT)
    higher = (above > distance) & (above <= top)
    over = (above > top) & (above <= 2 * top)
    count = [np.bincount(square[band], minlength=square.max() + 1) for band in (higher, over)]
    return higher & (count[1] <= _EMPTY * count[0])[square]
