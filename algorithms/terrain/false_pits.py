"""Find groups of multipath points under the ground, which look like pits.

The range of a pulse that took a detour is too long, so that its point lies under the surface along the beam. Several of
them, from one mirror, make a pit: lower than the ground on all sides, with no terrain that leads down to it. A true pit
(a shaft, a cellar stair, an excavation) shows its floor to every pulse that enters it. That distinguishes the two.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..criteria import MAJORITY
from ..geometry.grid import connected_cells, distinct, find_cells, grid_over
from ..geometry.groups import split_groups
from ..geometry.tin import node_fits
from ..packages import spatial
from ..preparation.points_under_ground import UNDER_GROUND
from ..rules import rule, rules
from ..sampling.density import DENSITY
from ..stage import Monitor
from ..threads import ROWS_AT_ONCE, in_chunks


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
    below = np.flatnonzero((above < -depth) & is_last & ~is_node)
    return np.append(nodes[is_low], below), nodes[~is_low]


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
            right = np.einsum("mki,mk,mk->mi", design, weight, off[..., 2])
            plane = np.linalg.solve(normal, right[..., None])[..., 0]
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
        """Return whether a group is small, deep enough, has ground around, and does not fill its pit."""
        plan = self.xyz[group, :2]
        if np.ptp(plan, axis=0).max() > _widest(self.spacing):
            return False
        if len(group) < _RULES.group and self.height[group].max() > -_RULES.single_depth:
            return False
        around = self._tree.query_ball_point(self.xyz[group, :2], _rim_width(self.spacing))
        rim = np.setdiff1d(np.concatenate(around).astype(np.int64), group)
        is_ground = np.abs(self.height[rim]) <= self.limit[rim] / 2
        is_between = self.height[rim] < -self.limit[rim] / 2
        if is_between.sum() > _RULES.leads_down * is_ground.sum():
            return False
        x, y = (self.xyz[rim[is_ground], :2] - plan.mean(axis=0)).T
        sectors = np.unique(np.floor(np.arctan2(y, x) / (2 * np.pi) * 8))
        # No ground shows beyond a wall.
        return len(sectors) >= MAJORITY * 8 and not self._is_floor(plan, self.xyz[rim[is_ground], :2])

    def _is_floor(self, plan: np.ndarray, ground: np.ndarray) -> bool:
        """Return whether points (m, 2) fill the pit that they make, and points of the ground (k, 2) lie around it."""
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
