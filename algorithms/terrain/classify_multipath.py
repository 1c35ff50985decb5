"""Groups of multipath points under the ground: low noise instead of pits.

The range of a pulse that took a detour is too long, so that its point lies under the surface along the beam. Several of
them, from one mirror, make a pit: lower than the ground on all sides, with no terrain that leads down to it. A true pit
(a shaft, a cellar stair, an excavation) shows its floor to every pulse that enters it. That distinguishes the two.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..cloud.asprs import PointClass
from ..criteria import MAJORITY
from ..geometry.grid import connected_cells, distinct, find_cells, grid_over
from ..geometry.groups import split_groups
from ..geometry.tin import node_fits
from ..packages import spatial
from ..preparation.points_under_ground import UNDER_GROUND
from ..rules import rule, rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.density import DENSITY
from ..stage import Monitor, stage
from ..threads import ROWS_AT_ONCE, in_chunks
from .classify_ground_tin import GROUND, sweep
from .ground_points import in_plan_order, last_returns, usable_points
from .ground_seeds import lowest_points
from .tin_densification import JoinRules, grow

# Least side (m) of the cells whose ground points make the surface, as of the ground filter.
_LEAST_CELL = 1.0

# Points within this distance (m) in plan of a group of multipath points are classified again, as it drew the surface
# down.
_REACH = 10.0


@rules
class _RULES:
    """What distinguishes a group of multipath points from a true pit."""

    around: int = rule(32, "nodes", "whose plane is the level of the ground: enough that a group is a minority of them")
    depth_spacings: float = rule(0.4, "point spacings", "the ground bends unseen between points")
    depth_deviations: float = rule(6.0, "standard deviations of the ground", "rough ground has true hollows")
    rough: float = rule(0.25, "m", "ground that deviates by more is too rough to show a pit")
    group: int = rule(3, "points", "of them that need no more than the least depth")
    single_depth: float = rule(1.0, "m", "physics: fewer points, less deep, are as likely a gutter or a hollow")
    widest: float = rule(3.0, "m, and point spacings", "physics: mirrors are panes, cars and wet spots")
    link_spacings: float = rule(1.5, "point spacings", "side of the touching cells of a group, in sparse clouds")
    rim: float = rule(2.0, "m", "width of the rim around a group that must be ground, or as many spacings as a group")
    leads_down: float = rule(0.05, "share of the rim's ground", "more points between both show terrain that leads down")
    floor: int = rule(6, "points", "with fewer it can't be decided whether they fill a pit")
    mixed: float = rule(0.15, "share of a floor's pulses", "that see ground: pulses see a true floor or the ground")
    crowded: float = rule(2.0, "standard deviations", "more points than its area has are no floor")


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
    rules = JoinRules(GROUND.angle, None, GROUND.bend * sampling.spacing, 2 * cell_size, sampling.height_resolution)
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


def false_pits(
    points: np.ndarray, is_node: np.ndarray, above: np.ndarray, is_last: np.ndarray, spacing: float, monitor: Monitor
) -> np.ndarray:
    """Return the points that are groups of multipath points under the ground.

    Parameters
    ----------
    points : ndarray of shape (n, 3), float64
        Coordinates, m.
    is_node : ndarray of shape (n,), bool
        Nodes of the surface of the ground, which pits draw down.
    above : ndarray of shape (n,), float64
        Height over that surface, m.
    is_last : ndarray of shape (n,), bool
        Last returns: others are never under the ground.
    spacing : float
        Point spacing, m.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    ndarray of shape (m,), int64
        Indices of the points, ascending.
    """
    if np.count_nonzero(is_node) < _RULES.around:
        return np.empty(0, np.int64)
    depth = max(UNDER_GROUND.depth, _RULES.depth_spacings * spacing)
    sunk, ground = _sunk(points, is_node, above, is_last, depth)
    if not len(sunk) or len(ground) < _RULES.around:
        return np.empty(0, np.int64)
    level = _levels(points[ground], points[sunk], monitor)
    limit = np.maximum(depth, _RULES.depth_deviations * level.deviation)
    is_deep = (points[sunk, 2] < level.height - limit) & (level.deviation < _RULES.rough)
    if not is_deep.any():
        return np.empty(0, np.int64)
    near = _Near.around(points, is_last, sunk[is_deep], level.take(is_deep), limit[is_deep], spacing)
    found = [group for group in near.groups() if near.is_false(group)]
    return np.sort(near.rows[np.concatenate(found)]) if found else np.empty(0, np.int64)


def _sunk(
    points: np.ndarray, is_node: np.ndarray, above: np.ndarray, is_last: np.ndarray, depth: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices of the points that may lie under the ground, and of the nodes that are ground next to them."""
    nodes = np.flatnonzero(is_node)
    # In a group, some neighbors of a node are low as well and pull their plane down.
    is_low = node_fits(points[nodes])[0] < -depth / 2
    return np.append(nodes[is_low], np.flatnonzero((above < -depth) & is_last & ~is_node)), nodes[~is_low]


@dataclass(frozen=True)
class _Levels:
    """The ground around some positions: its height (m,) there, slope (m, 2) and deviation (m,), in meters."""

    height: np.ndarray
    slope: np.ndarray
    deviation: np.ndarray

    def take(self, chosen: np.ndarray) -> _Levels:
        """Return some of them."""
        return _Levels(self.height[chosen], self.slope[chosen], self.deviation[chosen])


def _levels(ground: np.ndarray, positions: np.ndarray, monitor: Monitor) -> _Levels:
    """Return the planes of the nodes ``ground`` (k, 3) around positions (m, 3), on which most of them agree."""
    tree = spatial.cKDTree(ground[:, :2])
    made = _Levels(np.empty(len(positions)), np.empty((len(positions), 2)), np.empty(len(positions)))

    def fit(rows: np.ndarray) -> None:
        off = ground[tree.query(positions[rows, :2], _RULES.around)[1]] - positions[rows, None]
        design = np.concatenate([off[..., :2], np.ones((*off.shape[:2], 1))], axis=2)
        weight = np.ones(off.shape[:2])
        # After eight rounds, in which nodes far off their plane lose weight, planes change by millimeters.
        for _ in range(8):
            # A small term on the diagonal keeps the equations of collinear nodes solvable.
            normal = np.einsum("mki,mk,mkj->mij", design, weight, design) + 1e-6 * np.eye(3)
            plane = np.linalg.solve(normal, np.einsum("mki,mk,mk->mi", design, weight, off[..., 2])[..., None])[..., 0]
            residual = np.abs(off[..., 2] - np.einsum("mki,mi->mk", design, plane))
            # Least sum of absolute residuals: a few nodes far off do not count for more than others. All have their
            # full weight up to about the noise of a scanner (m).
            weight = 1 / np.maximum(residual, 0.05)
        made.height[rows], made.slope[rows] = positions[rows, 2] + plane[:, 2], plane[:, :2]
        # The standard deviation of normally distributed residuals is 1.4826 times their median.
        made.deviation[rows] = 1.4826 * np.median(residual, axis=1)

    in_chunks(fit, np.arange(len(positions)), ROWS_AT_ONCE, monitor)
    return made


def _widest(spacing: float) -> float:
    """Return the extent in plan (m) of the widest group."""
    return _RULES.widest * max(1.0, spacing)


def _rim_width(spacing: float) -> float:
    """Return the width (m) of the rim around a group that must be ground."""
    return max(_RULES.rim, _RULES.widest * spacing)


@dataclass(frozen=True)
class _Near:
    """The last returns near the points that lie under the ground."""

    rows: np.ndarray  #: (m,), int64: their indices in the cloud
    xyz: np.ndarray  #: (m, 3), float64: their coordinates, m
    height: np.ndarray  #: (m,), float64: their height over the ground around, m
    limit: np.ndarray  #: (m,), float64: depth from which on they are under it, m
    spacing: float  #: Point spacing of the cloud, m

    @classmethod
    def around(
        cls, xyz: np.ndarray, is_last: np.ndarray, deep: np.ndarray, level: _Levels, limit: np.ndarray, spacing: float
    ) -> _Near:
        """Return the last returns as near to the ``deep`` points as a group and its rim are."""
        reach = _widest(spacing) + _rim_width(spacing)
        grid = grid_over(xyz, reach)
        cells = np.unique(grid.number(xyz[deep])[:, None] + [0, *grid.around])
        rows = np.flatnonzero(find_cells(cells, grid.number(xyz))[1] & is_last)
        distance, nearest = spatial.cKDTree(xyz[deep, :2]).query(xyz[rows, :2], distance_upper_bound=reach)
        rows, nearest = rows[np.isfinite(distance)], nearest[np.isfinite(distance)]
        off = xyz[rows] - xyz[deep[nearest]]
        height = xyz[rows, 2] - level.height[nearest] - np.einsum("mi,mi->m", off[:, :2], level.slope[nearest])
        return cls(rows, xyz[rows], height, limit[nearest], spacing)

    @cached_property
    def _tree(self):  # noqa: ANN202 - scipy is imported when first used
        return spatial.cKDTree(self.xyz[:, :2])

    def groups(self) -> list[np.ndarray]:
        """Return the groups of points under the ground, by their positions here."""
        low = np.flatnonzero(self.height < -self.limit)
        grid = grid_over(self.xyz[low], max(DENSITY.least_link, _RULES.link_spacings * self.spacing))
        cells, which = distinct(grid.number(self.xyz[low]))
        n_groups, group = connected_cells(grid, cells)
        return [low[rows] for rows in split_groups(group[which], n_groups)]

    def is_false(self, group: np.ndarray) -> bool:
        """Whether a group is small, deep enough, has ground around, and does not fill its pit."""
        plan = self.xyz[group, :2]
        if np.ptp(plan, axis=0).max() > _widest(self.spacing):
            return False
        if len(group) < _RULES.group and self.height[group].max() > -_RULES.single_depth:
            return False
        around = self._tree.query_ball_point(self.xyz[group, :2], _rim_width(self.spacing))
        rim = np.setdiff1d(np.concatenate(around).astype(np.int64), group)
        is_ground = np.abs(self.height[rim]) <= self.limit[rim] / 2
        if (self.height[rim] < -self.limit[rim] / 2).sum() > _RULES.leads_down * is_ground.sum():
            return False
        x, y = (self.xyz[rim[is_ground], :2] - plan.mean(axis=0)).T
        sectors = np.unique(np.floor(np.arctan2(y, x) / (2 * np.pi) * 8))
        # No ground shows beyond a wall.
        return len(sectors) >= MAJORITY * 8 and not self._is_floor(plan, self.xyz[rim[is_ground], :2])

    def _is_floor(self, plan: np.ndarray, ground: np.ndarray) -> bool:
        """Whether points (m, 2) fill the pit that they make, and points of the ground (k, 2) lie around it."""
        # Points on a line have no hull.
        if len(plan) < _RULES.floor or np.linalg.matrix_rank(plan - plan[0], tol=1e-6) < 2:
            return False
        hull = spatial.ConvexHull(plan)
        inside = (ground @ hull.equations[:, :2].T + hull.equations[:, 2] <= 0).all(axis=1)
        density = self._density(plan.mean(axis=0))
        # Points of a floor have as much room beyond the outermost ones as between others. Of hulls in plan Qhull calls
        # the perimeter their area.
        step = density**-0.5
        expected = density * (hull.volume + hull.area * step / 2 + np.pi * step**2 / 4)
        is_crowded = len(plan) > expected + _RULES.crowded * np.sqrt(expected)
        return inside.sum() <= _RULES.mixed * min(len(plan), density * hull.volume) and not is_crowded

    def _density(self, position: np.ndarray) -> float:
        """Return the density of last returns around a position (2,), points/m², at least the cloud's."""
        radius = _rim_width(self.spacing)
        count = self._tree.query_ball_point(position, radius, return_length=True)
        return max(count / (np.pi * radius**2), self.spacing**-2)
