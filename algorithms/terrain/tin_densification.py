"""Progressive densification of a TIN: a surface that grows from ground seeds onto the points that fit it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Optional

import numpy as np

from ..geometry.grid import plan_box
from ..geometry.tin import Tin, node_fits, robust_deviation
from ..rules import rule, rules
from ..sampling.height_resolution import LEAST_RESOLUTION
from ..sampling.surface_noise import SURFACES
from ..stage import Monitor


@rules
class DENSIFICATION:
    """Constants of all ground filters that grow a TIN."""

    deviations: float = rule(
        8.0, "robust deviations", "of the nodes, of distances and of angles, within which points join"
    )
    node_distance: float = rule(0.25, "share", "of the edge length: nearer points make slivers and add no information")
    least_growth: float = rule(0.005, "share", "of the nodes that a round must add to have another one after it")


@dataclass(frozen=True)
class JoinRules:
    """Limits that differ between filters and clouds: when a point joins the TIN, and when rounds end."""

    max_angle: float  #: Largest angle between the facet and the lines to its nodes, °
    max_distance: Optional[float]  #: Largest distance from the facet, m; None is estimated in each round
    bend: float  #: What bends of the terrain between points add to half of an estimated distance, if that is more, m
    edge_length: float  #: Facets whose edges are all shorter are closed, m
    least: float = LEAST_RESOLUTION  #: Least roughness of a surface, m: of rounded heights
    #: Whether the largest angle is estimated in each round, and ``max_angle`` bounds the estimate
    estimates_angle: bool = False
    terrain_angle: float = 90.0  #: Steepest line from a point to the nodes of its facet, °
    #: Whether rounds go on until no point qualifies, and every point is tried in each. Else rounds that add little are
    #: the last, and points in closed facets are not tried again, which is faster.
    is_exhaustive: bool = False
    #: Returns the angles (°) of points that do not fit their facets as they lie, inf where they do not fit at all: see
    #: :func:`.classify_ground_tin_2000.mirrored_angle`
    beyond: Optional[Callable[[Tin, np.ndarray, np.ndarray, float, int], np.ndarray]] = None

    def is_last(self, n_joining: int, n_nodes: int) -> bool:
        """Return whether densification ends after a round in which points joined ``n_nodes`` nodes."""
        return n_joining <= (0 if self.is_exhaustive else DENSIFICATION.least_growth * n_nodes)

    def limits(self, nodes: np.ndarray) -> tuple[float, float]:
        """Return the largest distance (m) and angle (°) at which a point joins the TIN of ``nodes``."""
        # Roughness and angle are measured on a sample, or on all nodes if they are fewer.
        fits = node_fits(nodes) if self.estimates_angle and 3 < len(nodes) < 2 * SURFACES.sample else None
        return self.distance(nodes, fits), self.angle(nodes, fits)

    def angle(self, nodes: np.ndarray, fits: Optional[tuple[np.ndarray, np.ndarray]] = None) -> float:
        """Return the largest angle (°) at which a point joins the TIN of ``nodes``, whose ``fits`` may be known."""
        if not self.estimates_angle or len(nodes) <= 3:
            return self.max_angle
        residuals, nearest = fits or node_fits(nodes)
        angles = np.degrees(np.arctan2(np.abs(residuals), nearest))
        return min(self.max_angle, DENSIFICATION.deviations * robust_deviation(angles, 0.0))

    def distance(self, nodes: np.ndarray, fits: Optional[tuple[np.ndarray, np.ndarray]] = None) -> float:
        """Return the largest distance (m) at which a point joins the TIN of ``nodes``, as :meth:`angle`."""
        if self.max_distance is not None:
            return self.max_distance
        if len(nodes) <= 3:
            return np.inf
        roughness = robust_deviation(fits[0], self.least) if fits else surface_roughness(nodes, self.least)
        rough = DENSIFICATION.deviations * roughness
        return max(rough, rough / 2 + self.bend)


class Surface:
    """A TIN of some of the points, its nodes, with the facet of each of the others.

    Attributes
    ----------
    points : ndarray of shape (n, 3), float64
        All points (m).
    facet : ndarray of shape (n,), int32
        The facet under each.
    is_node : ndarray of shape (n,), bool
        Which points are nodes.
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
        return self.points.compress(self.is_node, axis=0)

    def add(self, joining: np.ndarray) -> None:
        """Let the points with these indices become nodes."""
        self.facet = self.tin.add(self.points, self.facet, joining)
        self.is_node[joining] = True

    def without(self, rows: np.ndarray, monitor: Monitor) -> Surface:
        """Return the surface of those nodes that are not among the points with the indices ``rows`` (m,)."""
        stays = self.is_node.copy()
        stays[rows] = False
        return Surface(self.points, np.flatnonzero(stays), monitor) if (stays != self.is_node).any() else self

    def above(self) -> np.ndarray:
        """Return the distances (n,), m, of points from their facets, positive above."""
        return (self.points[:, 2] - self.tin.elevation(self.points, self.facet)) * self.tin.slope_cosine()[self.facet]

    def within(self, distance: float) -> np.ndarray:
        """Return the mask of points (n,) that are nodes or lie at most ``distance`` (m) above or below the surface."""
        # At distance 0 points that happen to lie on a facet are no nodes.
        return self.is_node | ((np.abs(self.above()) <= distance) & (distance > 0))


def surface_roughness(nodes: np.ndarray, least: float) -> float:
    """Return the robust standard deviation of nodes (m, 3) across their surface, m, at least ``least``."""
    # Three nodes or fewer have no neighbors to differ from.
    residuals = node_fits(nodes, SURFACES.sample)[0] if len(nodes) > 3 else np.zeros(1)
    return robust_deviation(residuals, least)


def grow(
    points: np.ndarray, start: np.ndarray, may_join: np.ndarray, rules: JoinRules, monitor: Monitor
) -> tuple[Surface, float, float]:
    """Let the TIN of the points ``start`` grow onto those that may join.

    Parameters
    ----------
    points : ndarray of shape (n, 3)
        Points, m.
    start : ndarray of shape (k,), int
        Rows of the first nodes.
    may_join : ndarray of shape (n,), bool
        Points that may join.
    rules : JoinRules
        When they join.
    monitor : Monitor
        Receives the progress.

    Returns
    -------
    surface : Surface
        The finished surface.
    distance, angle : float
        The largest distance (m) and angle (°) of the last round.
    """
    surface, step = Surface(points, start, monitor.part(0, 0.5)), 0
    distance, angle = rules.limits(surface.nodes)
    candidates = np.flatnonzero(may_join & ~surface.is_node)
    is_last = False
    while not is_last:
        n_nodes, step = int(surface.is_node.sum()), step + 1
        open_candidates, joining = _joining(surface, candidates, distance, angle, rules, len(start))
        surface.add(joining)
        candidates = np.setdiff1d(candidates if rules.is_exhaustive else open_candidates, joining, assume_unique=True)
        monitor.progress(1 - 0.5 / step)
        is_last = rules.is_last(len(joining), n_nodes)
        distance, angle = (distance, angle) if is_last else rules.limits(surface.nodes)
    return surface, float(distance), float(angle)


def _joining(
    surface: Surface, candidates: np.ndarray, distance: float, max_angle: float, rules: JoinRules, n_start: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the candidates in open facets and away from nodes, and the ones that join now, one per facet."""
    tin, facet = surface.tin, surface.facet[candidates]
    # Skip points next to a node: they make slivers and add no information.
    is_open = tin.longest_edge()[facet] > rules.edge_length
    candidates, facet = candidates[is_open], facet[is_open]
    xyz = surface.points.take(candidates, axis=0)
    nearest = to_nearest_node(tin, facet, xyz)
    apart = nearest > DENSIFICATION.node_distance * rules.edge_length
    candidates, facet, xyz = candidates[apart], facet[apart], xyz.compress(apart, axis=0)
    offset, angle = offset_and_angle(tin, facet, xyz, nearest[apart])
    fits = (offset <= distance) & (angle <= max_angle) & _is_terrain(tin, facet, xyz, rules.terrain_angle)
    if rules.beyond is not None:
        others = np.flatnonzero(~fits)
        angle[others] = rules.beyond(tin, facet[others], xyz[others], distance, n_start)
        fits |= angle <= max_angle
    # Ties go to the south-west, so that the points' order doesn't matter.
    order = np.lexsort((xyz[fits, 1], xyz[fits, 0], angle[fits], facet[fits]))
    first = np.unique(facet[fits][order], return_index=True)[1]
    return candidates, candidates[fits][order][first]


def offset_and_angle(tin: Tin, facet: np.ndarray, xyz: np.ndarray, near: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the distance (n,), m, of points to their facets, and the largest angle (n,), °, to the nodes of these.

    Parameters
    ----------
    tin : Tin
        The triangulated ground.
    facet : ndarray of shape (n,), int
        Facet below or above each point.
    xyz : ndarray of shape (n, 3)
        The points (m).
    near : ndarray of shape (n,)
        Distance (m) to the nearest node of each point's facet.
    """
    offset = np.abs(xyz[:, 2] - tin.elevation(xyz, facet)) * tin.slope_cosine()[facet]
    return offset, np.degrees(np.arcsin(np.clip(offset / np.maximum(near, 1e-9), 0, 1)))


def _is_terrain(tin: Tin, facet: np.ndarray, xyz: np.ndarray, terrain_angle: float) -> np.ndarray:
    """Return whether no line from a point to the nodes of its facet is steeper than ``terrain_angle`` (°)."""
    if terrain_angle >= 90.0:
        return np.ones(len(xyz), bool)
    lines = tin.nodes[tin.facets[facet]] - (xyz - tin.shift)[:, None]
    slopes = np.arctan2(np.abs(lines[..., 2]), np.linalg.norm(lines[..., :2], axis=2))
    return np.degrees(slopes).max(axis=1) <= terrain_angle


def to_nearest_node(tin: Tin, facet: np.ndarray, xyz: np.ndarray) -> np.ndarray:
    """Return the distance (m) to the nearest node of each point's facet: the largest angle is there."""
    xyz, least = xyz - tin.shift, np.full(len(xyz), np.inf)
    for node in tin.facets.take(facet, axis=0).T:
        # Column by column: numpy is slow on rows of three.
        x, y, z = (tin.nodes.take(node, axis=0) - xyz).T
        least = np.minimum(least, x * x + y * y + z * z)
    return np.sqrt(least)
