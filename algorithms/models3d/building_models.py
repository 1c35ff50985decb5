"""One building: its roof planes, the partition of its footprint, and its solids at all levels of detail."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Optional

import numpy as np

from ..footprints.footprint_attributes import RIDGE
from ..geometry.groups import components, placed
from ..geometry.rings import distances_to_rings
from ..sampling.points_on_top import are_on_roof, distances, root_mean_square
from .mending import LARGE, mended
from .overhangs import overhanging, wall_rings
from .roof_limits import HeightsAround, share_off
from .roof_partition import FARTHEST, Partition, covered_share, divide_footprint, empty_partition
from .roof_planes import RoofPlanes, find_roof_planes, selected_planes, with_level_patches
from .solids import Solid

# Levels of detail, from the simplest. The one without dormers takes as long as the finest, so it is made only where it
# is asked for.
COARSE, FINE, OVERHANGS = "2.0", "2.2", "2.3"
LEVELS = ("1.2", "1.3", COARSE, FINE, OVERHANGS)

# Area (m²) of the smallest plane without dormers, as the level is defined, and its least share of the largest plane:
# roofs of small buildings keep all their sides.
_COARSE_AREA, _COARSE_SHARE = 10.0, 0.5

# Points of a parapet lie within this distance (m) of the outline, in plan, and between these heights (m) above a level
# face: above chimney caps and gutters, below a storey. There is a parapet if this share of the points along the outline
# is that high: one of 0.3 m has 55 to 72 %, in clouds of 4 to 20 points per m².
_RIM, _RAISED, _RIM_SHARE = 0.5, (0.15, 1.5), 0.4

# The model explains a roof point within this many tolerances.
_EXPLAINED = 1.5


@dataclass(frozen=True)
class Settings:
    """How buildings are modelled: lengths in m, area in m², slopes in °, ``percentile`` of the heights of flat tops."""

    spacing: float
    tolerance: float
    min_area: float
    max_slope: float
    min_step: float
    percentile: float
    level: str

    @property
    def min_points(self) -> int:
        """Points of the smallest plane."""
        return max(5, round(self.min_area / self.spacing**2))


@dataclass
class BuildingModel:
    """A building's solids by level of detail, and the facts about its best level."""

    base: float  #: Height of the ground (m), at which solids have their base
    level: str = ""  #: Best level of the building, "" without any
    reason: str = ""  #: Why ``level`` is not the level asked for, "" where it is
    #: Solids by level; parts of the footprint that only touch in a point are separate solids
    solids: dict[str, list[Solid]] = field(default_factory=dict)
    #: Closed rings (k, 2) of its walls on the ground (m), none where they are below the edges of the roof
    walls: list[np.ndarray] = field(default_factory=list)
    terrain: float = np.nan  #: Median height of the ground along the outline (m)
    ridge: float = np.nan  #: 98th percentile of the heights of the roof points (m)
    rms: float = np.nan  #: Root mean square height of the roof points above or below the best level (m)
    #: Root mean square distance (m) of the points on planes by level, each distance at most ``FARTHEST``
    rms_of: dict[str, float] = field(default_factory=dict)
    #: explained, off, covered: Share of the roof points that lie on the model, share of those that are off it, and
    #: share of the footprint's area that has points, 0 to 1
    explained: float = np.nan
    off: float = np.nan
    covered: float = np.nan
    #: Least share of the points of a plane of ``LARGE`` m² or more that lie on it, 1 without any such plane
    weakest: float = 1.0
    n_points: int = 0  #: Number of points of the building
    face_rms: dict[int, float] = field(default_factory=dict)  #: Root mean square by plane of the best level (m)
    face_on: dict[int, float] = field(default_factory=dict)  #: Share of the points of these planes that lie on them
    face_parapet: dict[int, float] = field(default_factory=dict)  #: Height above these planes at the outline (m)

    @property
    def best(self) -> list[Solid]:
        """The solids of the best level."""
        return self.solids.get(self.level, [])


def model_building(
    xyz: np.ndarray, is_low: np.ndarray, around: np.ndarray, rings: list, base: float, settings: Settings
) -> BuildingModel:
    """Return the model of one building.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points of the building (m).
    is_low : ndarray of shape (n,), bool
        Which of these points have a higher one near them; see :func:`.are_low`.
    around : ndarray of shape (m, 3)
        Points of any building over the footprint and around it (m).
    rings : list of ndarray
        Closed rings of the footprint (m).
    base : float
        Height of the ground (m).
    settings : Settings
        Tolerances and level of the model.
    """
    origin = np.floor(rings[0][:, :2].min(axis=0))
    local, plan = xyz - [*origin, 0.0], [ring[:, :2] - origin for ring in rings]
    model = BuildingModel(base, n_points=len(xyz))
    planes = find_roof_planes(local, settings.tolerance, settings.max_slope, settings.min_points)
    planes = with_level_patches(local, ~is_low, planes, settings.spacing, settings.min_points)
    limits = HeightsAround(around - [*origin, 0.0])
    top = _Top(local, is_low, plan, planes, settings, base)
    if np.median(xyz[top.is_roof, 2]) <= base:
        model.reason = "its roof is not above the ground next to it"
        return model
    partition: Optional[Partition] = None
    for level in LEVELS[: LEVELS.index(settings.level) + 1]:
        if level == OVERHANGS or level == COARSE != settings.level:
            continue
        partition, why = _partition(top, level)
        if partition is not None:
            solids, why = _solids(model, level, top, partition, limits)
            if not why:
                above, label = partition.above(top.xyz)
                why = _worse(model, level, top, above)
            if not why:
                model.level, model.solids[level] = level, solids
                _describe(model, top, partition, above, label)
        if why:
            model.reason = f"{level}: {why}"
    if settings.level == OVERHANGS and model.level == FINE and partition is not None:
        model.reason = _overhang(model, top, partition, around - [*origin, 0.0])
    for solids in model.solids.values():
        for solid in solids:
            solid.vertices = solid.vertices + [*origin, 0.0]
    model.walls = [ring + origin for ring in model.walls]
    if model.level == settings.level:
        model.reason = ""
    return model


def _solids(
    model: BuildingModel, level: str, top: _Top, partition: Partition, limits: HeightsAround
) -> tuple[list[Solid], str]:
    """Return the solids of a partition, which may change, or none and why."""
    if level == "1.3" and len(partition.coefficients) == 1 and "1.2" in model.solids:
        # One part for all is the simplest level.
        return [replace(solid) for solid in model.solids["1.2"]], ""
    return mended(partition, top.base, top.xyz, limits if level >= COARSE else None, top.settings.percentile)


def _overhang(model: BuildingModel, top: _Top, partition: Partition, around: np.ndarray) -> str:
    """Set the walls of a model back from its eaves; return the reason if none is, else ""."""
    walls = wall_rings(around, top.rings, model.best, top.base, top.settings.spacing)
    if not walls:
        return f"{OVERHANGS}: no wall was seen under an overhanging eave"
    solids, why = overhanging(partition, top.base, walls)
    if why:
        return f"{OVERHANGS}: {why}"
    model.level, model.solids[OVERHANGS], model.walls = OVERHANGS, solids, walls
    return ""


@dataclass(frozen=True)
class _Top:
    """The input of the partitions of one building."""

    xyz: np.ndarray
    is_low: np.ndarray
    rings: list
    planes: RoofPlanes
    settings: Settings
    base: float

    @property
    def is_roof(self) -> np.ndarray:
        """Which points (n,) are on the roof: those on planes, or all where there is no plane."""
        on_plane = self.planes.label >= 0
        return on_plane if on_plane.any() else np.ones(len(self.xyz), bool)

    @cached_property
    def roof(self) -> Optional[Partition]:
        """The footprint divided among the planes, None without planes."""
        if not len(self.planes):
            return None
        spacing, tolerance = self.settings.spacing, self.settings.tolerance
        return divide_footprint(self.xyz, ~self.is_low, self.planes, self.rings, spacing, tolerance, self.base)


def _partition(top: _Top, level: str) -> tuple[Optional[Partition], str]:
    """Return the partition of the roof at a level of detail, or None with the reason."""
    if level == "1.2":
        return _single_top(top)
    if level == COARSE:
        top = replace(top, planes=_without_dormers(top.planes, top.settings.spacing))
    roof = top.roof
    if roof is None:
        return None, "no roof plane was found"
    return (_level_tops(top, roof) if level == "1.3" else replace(roof, label=roof.label.copy())), ""


def _single_top(top: _Top) -> tuple[Optional[Partition], str]:
    """Return the footprint under one level top."""
    roof = top.xyz[top.is_roof]
    # A top is half a meter above the ground at least, so that the walls of its solid have a height.
    height = max(float(np.percentile(roof[:, 2], top.settings.percentile)), top.base + 0.5)
    cells, inside = empty_partition(top.rings, top.xyz[:, :2])
    if not inside.any():
        return None, "its footprint has no area"
    return Partition(cells, np.where(inside, 0, -1), np.array([[0.0, 0.0, height]]), np.zeros((len(cells), 1))), ""


def _without_dormers(planes: RoofPlanes, spacing: float) -> RoofPlanes:
    """Return the planes that are no dormers, chimneys and other small parts of a roof."""
    area = np.bincount(planes.label[planes.label >= 0], minlength=len(planes)) * spacing**2
    return selected_planes(planes, area >= min(_COARSE_AREA, _COARSE_SHARE * area.max(initial=0.0)))


def _level_tops(top: _Top, roof: Partition) -> Partition:
    """Return the partition of the roof with level tops, one for all parts that are not clearly apart in height."""
    part = _joined_parts(roof, top.settings.min_step)
    n = int(part.max()) + 1
    heights = np.zeros(n)
    is_roof = top.is_roof
    for number in range(n):
        rows = np.concatenate([roof.cells.members[c] for c in np.flatnonzero(part == number)])
        rows = rows[is_roof[rows]]
        planes = np.unique(roof.label[part == number])
        z = top.xyz[rows, 2] if len(rows) else top.xyz[np.isin(top.planes.label, planes), 2]
        heights[number] = max(float(np.percentile(z, top.settings.percentile)), top.base + 0.5)
    return Partition(roof.cells, part, np.column_stack([np.zeros((n, 2)), heights]), np.zeros((len(roof.cells), n)))


def _joined_parts(roof: Partition, min_step: float) -> np.ndarray:
    """Return the part (cells,) of each cell, -1 outside: one where roofs step by less than ``min_step`` (m)."""
    ends, beside = roof.cells.edges()
    one, other = roof.label[beside[:, 0]], roof.label[beside[:, 1]]
    rows = (one >= 0) & (other >= 0)
    positions = np.array(roof.cells.vertices)
    difference = roof.coefficients[one] - roof.coefficients[other]
    at_ends = (difference[:, None, :2] * positions[ends]).sum(axis=2) + difference[:, 2:]
    rows &= (one == other) | (np.abs(at_ends).mean(axis=1) < min_step)
    _, group = components(beside[rows, 0], beside[rows, 1], len(roof.cells))
    inside = roof.label >= 0
    return placed(np.unique(group[inside], return_inverse=True)[1], inside, len(roof.cells), -1)


def _off(top: _Top, above: np.ndarray, is_wanted: np.ndarray) -> np.ndarray:
    """Return the heights (k,), m, above the model, cut off, of the wanted points (n,), bool, that are on top."""
    wanted = above[is_wanted]
    return distances(wanted[are_on_roof(wanted, top.is_low[is_wanted])])


def _worse(model: BuildingModel, level: str, top: _Top, above: np.ndarray) -> str:
    """Return why a level is worse than the simpler ones, "" if it is not; keep its deviation in the model."""
    off = np.minimum(np.abs(above[np.isfinite(above) & top.is_roof & ~top.is_low]), FARTHEST)
    if not len(off):
        return "no points lie over it"
    model.rms_of[level] = root_mean_square(off)
    is_near = model.rms_of[level] <= min(model.rms_of.values()) + top.settings.tolerance
    return "" if is_near else "it is farther from the points than a simpler model"


def _describe(model: BuildingModel, top: _Top, partition: Partition, above: np.ndarray, label: np.ndarray) -> None:
    """Measure how well the best level explains the points, which lie ``above`` planes (m) of these labels."""
    over = np.isfinite(above)
    off = _off(top, above, over)
    model.rms = root_mean_square(off)
    model.explained = _explained(off, top)
    model.off = share_off(off)
    roof = over & are_on_roof(above, top.is_low)
    model.ridge = float(np.percentile(top.xyz[roof, 2], RIDGE)) if roof.any() else np.nan
    model.covered = covered_share(top.rings, top.xyz, top.settings.spacing)
    off_of = {int(plane): _off(top, above, label == plane) for plane in np.unique(label[over])}
    model.face_rms = {plane: root_mean_square(off) for plane, off in off_of.items()}
    inside = partition.label >= 0
    area = np.bincount(partition.label[inside], partition.cells.areas()[inside])
    model.face_on = {plane: _explained(off, top) for plane, off in off_of.items() if len(off)}
    on_rim = over & ~top.is_low & (distances_to_rings(top.xyz[:, :2], top.rings) <= _RIM)
    model.face_parapet = {plane: _parapet(above[on_rim & (label == plane)]) for plane in off_of}
    model.weakest = min((on for plane, on in model.face_on.items() if area[plane] >= LARGE), default=1.0)


def _parapet(above: np.ndarray) -> float:
    """Return the height (m) of a parapet, of points at the outline above a face (n,), m; NaN without any."""
    low, high = _RAISED
    raised = above[(above > low) & (above < high)]
    return float(np.median(raised)) if len(raised) > _RIM_SHARE * len(above) else np.nan


def _explained(off: np.ndarray, top: _Top) -> float:
    """Return the share of points with heights (n,), m, above the model that it explains; NaN without points."""
    return float(np.mean(np.abs(off) <= _EXPLAINED * top.settings.tolerance)) if len(off) else np.nan
