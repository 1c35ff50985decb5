"""Ground points by progressive TIN densification."""

from __future__ import annotations

from typing import Annotated, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..cloud.density import point_density
from ..params import MaxBuildingSize
from ..stage import Monitor, Param, stage
from .seeds import seeds_by_lowest, seeds_by_opening
from .tin import Tin, node_residuals, robust_deviation

# A point may join the TIN within this many times the measured roughness of the surface ...
_GROW_DEVIATIONS = 8.0

# ... and belongs to the finished ground within this many.
_SWEEP_DEVIATIONS = 6.0

# Rounds end when they add less than this share of the nodes.
_LEAST_GROWTH = 0.005
_MAX_ROUNDS = 50

# Coordinates are stored to a centimeter or finer: what deviates less from a line in plan is one, m.
_LEAST_WIDTH = 0.01

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
    seeds: Annotated[
        str,
        Param(
            "Seeds",
            "Where the surface starts: 'opening' takes the lowest points that growing windows don't lift off the "
            "terrain, 'lowest' the lowest point of each cell as large as the largest building, as published in 2000.",
            choices=("opening", "lowest"),
        ),
    ] = "opening",
    max_building_size: MaxBuildingSize = 60.0,
    cell_size: Annotated[
        Optional[float],
        Param(
            "Grid cell size",
            "Cell in which the lowest point is looked for (opening seeds).",
            unit="m",
            low=0.1,
            high=100,
            automatic="the point spacing, at least 1 m.",
            advanced=True,
        ),
    ] = None,
    iteration_angle: Annotated[
        float,
        Param(
            "Iteration angle",
            "Largest angle between a facet and the lines to its nodes under which a point joins the surface; "
            "larger follows steeper breaks and lets more low objects in.",
            unit="°",
            low=0,
            high=90,
            open_low=True,
        ),
    ] = 20.0,
    iteration_distance: Annotated[
        Optional[float],
        Param(
            "Iteration distance",
            "Largest distance from its facet at which a point joins the surface.",
            unit="m",
            low=0,
            high=100,
            open_low=True,
            automatic="8 times the roughness of the surface, measured again in each round.",
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
            automatic="6 times the roughness of the finished surface.",
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

    The paper leaves the points within the noise of the finished surface unclassified; the final sweep takes them
    in. With seeds 'lowest', sweep distance 0 is the method as published.

    References
    ----------
    Axelsson, P., 2000. DEM generation from laser scanner data using adaptive TIN models. International Archives of
    Photogrammetry and Remote Sensing 33 (B4), 110-117.
    """
    usable = np.flatnonzero(~np.isin(classification, NOISE))
    points = refuse_degenerate(xyz[usable])
    last = _last_returns(return_number, number_of_returns, usable)
    spacing = 1 / np.sqrt(point_density(points))
    cell_size = max(1.0, spacing) if cell_size is None else cell_size
    edge_length = 2 * cell_size if edge_length is None else edge_length

    growing = points[last]
    if seeds == "lowest":
        start = seeds_by_lowest(growing, max_building_size)
    else:
        start = seeds_by_opening(growing, cell_size, max_building_size, monitor.part(0, 0.3))
    is_node, distance = _grow(growing, start, iteration_angle, iteration_distance, edge_length, monitor.part(0.3, 0.8))
    is_ground, swept = _sweep(points, growing[is_node], sweep_distance, monitor.part(0.8, 1))
    is_ground[np.flatnonzero(last)[is_node]] = True
    monitor.resolved(cell_size=cell_size, iteration_distance=distance, edge_length=edge_length, sweep_distance=swept)

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
    if extent[1] <= _LEAST_WIDTH**2 * len(points):
        raise ValueError(
            f"All {len(points)} points lie on one line or at one place in plan; ground needs an area, "
            "choose a larger cloud."
        )
    return points


def _last_returns(return_number, number_of_returns, usable: np.ndarray) -> np.ndarray:
    """Return which of the usable points are last returns; all are where the numbers say nothing."""
    if return_number is None or number_of_returns is None:
        return np.ones(len(usable), bool)
    last = return_number[usable] >= number_of_returns[usable]
    return last if last.sum() >= 3 else np.ones(len(usable), bool)


def _grow(
    points: np.ndarray,
    start: np.ndarray,
    max_angle: float,
    max_distance: Optional[float],
    edge_length: float,
    monitor: Monitor,
) -> tuple[np.ndarray, float]:
    """Let the TIN of the points ``start`` grow; return which points are its nodes, and the last distance used."""
    is_node = np.zeros(len(points), bool)
    is_node[start] = True
    candidates: Optional[np.ndarray] = None
    distance = max_distance or 0.0
    for step in range(_MAX_ROUNDS):
        nodes = points[is_node]
        if max_distance is None:
            distance = _GROW_DEVIATIONS * robust_deviation(node_residuals(nodes)) if len(nodes) > 3 else np.inf
        tin = Tin(nodes)
        if candidates is None:
            candidates = _near(tin, points, _CANDIDATE_DISTANCES * distance, monitor.part(0, 0.5))
            candidates = candidates[~is_node[candidates]]
        candidates, joining = _joining(tin, points, candidates, distance, max_angle, edge_length)
        is_node[joining] = True
        monitor.progress(0.5 + 0.5 * (step + 1) / _MAX_ROUNDS)
        if len(joining) <= _LEAST_GROWTH * len(nodes):
            break
    return is_node, float(distance)


def _near(tin: Tin, points: np.ndarray, distance: float, monitor: Monitor) -> np.ndarray:
    """Return the indices of the points within ``distance`` of the surface."""
    facet = tin.locate(points, monitor)
    return np.flatnonzero(np.abs(points[:, 2] - tin.elevation(points, facet)) * tin.steepness()[facet] <= distance)


def _joining(
    tin: Tin, points: np.ndarray, candidates: np.ndarray, max_distance: float, max_angle: float, edge_length: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the candidates that are left for later rounds, and those that join now, one per facet."""
    facet = tin.locate(points[candidates])
    # Small facets only get smaller, and a point beside a node makes a sliver and tells nothing new.
    is_open = tin.longest_edge()[facet] > edge_length
    candidates, facet = candidates[is_open], facet[is_open]
    nearest = _to_nearest_node(tin, facet, points[candidates])
    apart = nearest > edge_length / 4
    candidates, facet, nearest = candidates[apart], facet[apart], nearest[apart]
    here = points[candidates]
    distance = np.abs(here[:, 2] - tin.elevation(here, facet)) * tin.steepness()[facet]
    angle = np.degrees(np.arcsin(np.clip(distance / np.maximum(nearest, 1e-9), 0, 1)))
    fits = (distance <= max_distance) & (angle <= max_angle)
    # Ties go to the south-west, so that the points' order doesn't matter.
    order = np.lexsort((here[fits, 1], here[fits, 0], angle[fits], facet[fits]))
    first = np.unique(facet[fits][order], return_index=True)[1]
    joining = candidates[fits][order][first]
    return np.setdiff1d(candidates, joining, assume_unique=True), joining


def _to_nearest_node(tin: Tin, facet: np.ndarray, here: np.ndarray) -> np.ndarray:
    """Return the distance (m) to the nearest node of each point's facet: the largest angle is there."""
    return np.linalg.norm(tin.nodes[tin.facets[facet]] - (here - tin.shift)[:, None], axis=2).min(axis=1)


def _sweep(
    points: np.ndarray, nodes: np.ndarray, distance: Optional[float], monitor: Monitor
) -> tuple[np.ndarray, float]:
    """Return which points lie within ``distance`` of the TIN of ``nodes``, and that distance."""
    if distance is None:
        distance = _SWEEP_DEVIATIONS * robust_deviation(node_residuals(nodes)) if len(nodes) > 3 else 0.0
    is_ground = np.zeros(len(points), bool)
    if distance > 0:
        is_ground[_near(Tin(nodes), points, distance, monitor)] = True
    return is_ground, float(distance)
