"""Fit an old map to new outlines: its shift, the overhang of eaves, and displaced buildings."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..criteria import PARALLEL
from ..geometry.groups import components, split_groups
from ..geometry.polygon_overlap import Polygons, are_in_polygons
from ..geometry.rings import along_sides, is_valid
from ..packages import spatial
from ..rules import rule, rules
from ..stage import Monitor
from .building_maps import BuildingMap
from .corner_matching import FACING, FARTHEST, MEDIANS


@rules
class _RULES:
    """Which walls of both maps are counterparts, and which buildings are displaced."""

    step: float = rule(0.25, "m", "distance of positions along walls: several on the shortest wall")
    beyond: float = rule(0.3, "m", "outside of a wall: another building within it hides the wall from above")
    full_weight: float = rule(0.1, "m", "off its counterpart, as an outline usually is; walls farther off weigh less")
    usual_shift: float = rule(0.005, "share", "of the walls' weight, of the usual shift: it holds rows along a street")
    usual_overhang: float = rule(0.05, "share", "of the walls' weight, of the usual overhang: it is alike on all sides")
    found: float = rule(0.6, "share", "of its walls that have a counterpart, of a building that is moved")
    nearer: float = rule(0.35, "ratio", "of the distances to the counterpart after a building is moved and before")
    least_shift: float = rule(0.75, "m", "by which the shift of a building that is moved differs from the usual one")
    most_shift: float = rule(2.0, "m", "by which a shift differs that is a building's own in any map")
    most_overhang: float = rule(1.0, "m", "physics: that is taken off new outlines; wider roofs are porches")


@dataclass(frozen=True)
class MapFit:
    """How an old map lies on new outlines."""

    shift: np.ndarray  #: (2,), m: from the map to the new outlines
    overhang: float  #: How far new outlines lie outside of the walls of the map, m
    deviation: float  #: Median distance of the walls of both maps after that, m
    moved: np.ndarray  #: (n, 2), m: shift of each building against the others, 0 of one that stays


def fit_map(old: BuildingMap, new: BuildingMap) -> MapFit:
    """Measure how an old map lies on new outlines, by the walls that both have; buildings that touch move together."""
    if not old.rings or not new.rings:
        return MapFit(np.zeros(2), 0.0, 0.0, np.zeros((len(old.rings), 2)))
    count, group = _touching(old.polygons)
    position, outward, building = _outer(old.polygons)
    there, normal, _ = _outer(new.polygons)
    walls = _Walls(position, outward, group[building], count, spatial.cKDTree(there), there, normal)
    usual = np.median(walls.fit(np.zeros(3)), axis=0)
    fits = walls.fit(usual)
    # A building that shifts and has another overhang was not misdrawn: a part of it was built or torn down.
    fits[:, 2] = usual[2]
    off, found = walls.deviations(fits)
    before, _ = walls.deviations(np.tile(usual, (count, 1)))
    apart = np.hypot(*(fits - usual)[:, :2].T)
    tolerance = np.clip(MEDIANS * np.median(apart), _RULES.least_shift, _RULES.most_shift)
    is_moved = (apart > tolerance) & (found >= _RULES.found) & (off < _RULES.nearer * before)
    shift = np.where(is_moved[:, None], fits[:, :2] - usual[:2], 0.0)
    overhang = float(np.clip(usual[2], -_RULES.most_overhang, _RULES.most_overhang))
    return MapFit(usual[:2], overhang, float(np.nanmedian(np.append(off[~is_moved], 0.0))), shift[group])


def in_frame(new: BuildingMap, fit: MapFit) -> list:
    """Return the rings of new outlines as the old map would draw them: shifted back, outer walls without overhang."""
    sides = new.polygons.edges
    way = sides[:, 1] - sides[:, 0]
    # A corner that comes twice makes a side without length: such an outline is shifted only.
    length = np.hypot(*way.T)[:, None]
    outward = np.column_stack([way[:, 1], -way[:, 0]]) / np.where(length > 0, length, 1.0)
    is_outer = ~are_in_polygons(sides.mean(axis=1) + _RULES.beyond * outward, new.polygons, Monitor())
    made, at = [], 0
    for rings in new.rings:
        own = []
        for ring in rings:
            rows = np.arange(at, at + len(ring) - 1)
            at += len(rows)
            across = np.stack([np.roll(outward[rows], 1, axis=0), outward[rows]], axis=1)
            by = -fit.overhang * np.column_stack([np.roll(is_outer[rows], 1), is_outer[rows]])
            corners = sides[rows, 0] - fit.shift + (np.linalg.pinv(across, PARALLEL) @ by[..., None])[..., 0]
            own.append(np.concatenate([corners, corners[:1]]))
        # Edges shorter than the overhang may turn around.
        made.append(own if is_valid(own) else [ring - fit.shift for ring in rings])
    return made


def _touching(polygons: Polygons) -> tuple[int, np.ndarray]:
    """Return the number of groups of polygons that touch, and the group of each (n,)."""
    position, side, _ = along_sides(polygons.edges, _RULES.step)
    building = _polygon_of(side, polygons)
    pairs = building[spatial.cKDTree(position).query_pairs(_RULES.beyond, output_type="ndarray")]
    return components(pairs[:, 0], pairs[:, 1], len(polygons.box))


def _outer(polygons: Polygons) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return positions (p, 2) along outer walls, m, unit vectors out of these, and the polygon of each."""
    position, side, outward = along_sides(polygons.edges, _RULES.step)
    is_outer = ~are_in_polygons(position + _RULES.beyond * outward, polygons, Monitor())
    return position[is_outer], outward[is_outer], _polygon_of(side[is_outer], polygons)


def _polygon_of(side: np.ndarray, polygons: Polygons) -> np.ndarray:
    return np.searchsorted(polygons.first, side, side="right") - 1


@dataclass(frozen=True)
class _Walls:
    """Positions (p, 2) along the outer walls of groups of buildings, m, and along new outlines."""

    position: np.ndarray
    outward: np.ndarray  #: (p, 2): unit vectors out of the walls
    group: np.ndarray  #: (p,), int64
    count: int  #: Number of groups
    tree: Any  #: Of positions along the new walls
    there: np.ndarray  #: (q, 2): these, m
    normal: np.ndarray  #: (q, 2): unit vectors out of these walls

    def fit(self, usual: np.ndarray) -> np.ndarray:
        """Return shift east and north and overhang (groups, 3), m, of each group.

        ``usual`` (3,) holds where its walls do not show it.
        """
        fits = np.tile(usual, (self.count, 1))
        factors = np.column_stack([self.outward, np.ones(len(self.outward))])
        held = np.array([_RULES.usual_shift, _RULES.usual_shift, _RULES.usual_overhang])
        # A shift of 3 m is found in five rounds.
        for _ in range(8):
            apart = self._apart(fits)
            found = np.flatnonzero(np.isfinite(apart))
            own, one = self.group[found], factors[found]
            off = apart[found] - fits[own, 2]
            # As in a fit of least absolute deviations.
            weight = 1 / np.maximum(np.abs(off), _RULES.full_weight)
            total = np.bincount(own, weight, self.count) + 1e-9
            matrix = np.zeros((self.count, 3, 3))
            np.add.at(matrix, own, weight[:, None, None] * one[:, :, None] * one[:, None, :])
            right = np.zeros((self.count, 3))
            np.add.at(right, own, (weight * off)[:, None] * one)
            right += total[:, None] * held * (usual - fits)
            matrix += total[:, None, None] * np.diag(held)
            fits = fits + np.linalg.solve(matrix, right[..., None])[..., 0]
        return fits

    def _apart(self, fits: np.ndarray) -> np.ndarray:
        """Return the distances (p,), m, of new walls from shifted ones, positive outside; NaN where none is found."""
        moved = self.position + fits[self.group, :2]
        # Several, as some are of walls across.
        _, near = self.tree.query(moved, 8, distance_upper_bound=FARTHEST)
        near = np.minimum(near, len(self.there))
        normal = np.vstack([self.normal, [0.0, 0.0]])[near]
        is_same = (normal * self.outward[:, None]).sum(axis=2) > np.cos(np.radians(FACING))
        first = near[np.arange(len(near)), is_same.argmax(axis=1)]
        apart = np.vstack([self.there, [np.nan, np.nan]])[first] - moved
        return np.where(is_same.any(axis=1), (apart * self.outward).sum(axis=1), np.nan)

    def deviations(self, fits: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the median distance (groups,), m, of walls from their counterparts, and the share that has one."""
        off = np.abs(self._apart(fits) - fits[self.group, 2])
        found = np.isfinite(off)
        median = np.full(self.count, np.nan)
        for number, rows in enumerate(split_groups(self.group, self.count)):
            median[number] = np.median(np.where(found[rows], off[rows], FARTHEST)) if len(rows) else np.nan
        size = np.maximum(np.bincount(self.group, minlength=self.count), 1)
        return median, np.bincount(self.group, found, self.count) / size
