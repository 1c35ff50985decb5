"""One building: its roof planes, the partition of its footprint, and its solids at three levels of detail."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from ..geometry.groups import components
from .roof_partition import Partition, divide_footprint, empty_partition
from .roof_planes import RoofPlanes, find_roof_planes
from .solids import WALL, Levels, Solid, build_solid, fault_of, turns_around

# Levels of detail, from the simplest.
LEVELS = ("1.2", "1.3", "2.2")

# Rounds in which places where too many walls meet are cleared.
_MOST_ROUNDS = 60

# A roof of which less than this share is explained by planes has no LoD2.2.
_LEAST_EXPLAINED = 0.5

# Parts of a footprint with less than this share of its area are not modelled.
_SLIVER = 0.01

# Distances off the model count at most this much (m) when levels are compared: what is farther is no roof.
_FARTHEST = 1.0

# A point of the roof is explained by the model within this many tolerances.
_EXPLAINED = 1.5


@dataclass(frozen=True)
class Settings:
    """How buildings are modelled: lengths in m, slopes in °, ``percentile`` of the heights of flat tops."""

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
    """A building's solids by level of detail, and what is known of its best level.

    Attributes
    ----------
    level : str
        The best level that it has, "" where it has none.
    reason : str
        Why it is not the level that was wanted, "" where it is.
    solids : dict of str to list of Solid
        By level; parts of the footprint that only touch in a point are solids of their own.
    base : float
        Height of the ground (m).
    rms : float
        Root mean square distance of the points on roof planes to the best level (m).
    rms_of : dict of str to float
        The same of each level.
    explained, covered : float
        Shares of the building's points that lie on the model, and of its area that has points, 0 to 1.
    n_points : int
        Points of the building.
    face_rms : dict of int to float
        Of each plane of the best level (m).
    """

    base: float
    level: str = ""
    reason: str = ""
    solids: dict[str, list[Solid]] = field(default_factory=dict)
    rms: float = np.nan
    rms_of: dict[str, float] = field(default_factory=dict)
    explained: float = np.nan
    covered: float = np.nan
    n_points: int = 0
    face_rms: dict[int, float] = field(default_factory=dict)

    @property
    def best(self) -> list[Solid]:
        """The solids of the best level."""
        return self.solids.get(self.level, [])


def model_building(xyz: np.ndarray, rings: list, base: float, settings: Settings) -> BuildingModel:
    """Return the model of one building.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Its points (m).
    rings : list of ndarray
        Its footprint: closed rings (m).
    base : float
        Height of the ground (m).
    settings : Settings
        How it is modelled.
    """
    origin = np.floor(rings[0][:, :2].min(axis=0))
    local, around = xyz - [*origin, 0.0], [ring[:, :2] - origin for ring in rings]
    model = BuildingModel(base, n_points=len(xyz))
    planes = find_roof_planes(local, settings.tolerance, settings.max_slope, settings.min_points)
    tops = {"1.2": _single_top, "1.3": _level_tops, "2.2": _roof}
    top = _Top(local, around, planes, settings, base)
    if np.median(xyz[top.is_roof, 2]) <= base:
        model.reason = "its roof is not above the ground beside it"
        return model
    for level in LEVELS[: LEVELS.index(settings.level) + 1]:
        partition, why = tops[level](top)
        if partition is not None:
            solids = _solids(partition, base)
            why = _fault(solids)
            if not why:
                off, label = _off_model(top, partition, solids)
                why = _worse(model, level, top, off)
            if not why:
                _enter(model, level, top, partition, solids, off, label)
        if why:
            model.reason = f"{level}: {why}"
    for solids in model.solids.values():
        for solid in solids:
            solid.vertices = solid.vertices + [*origin, 0.0]
    if model.level == settings.level:
        model.reason = ""
    return model


class _Top:
    """What the partitions of one building are made of."""

    def __init__(self, xyz: np.ndarray, rings: list, planes: RoofPlanes, settings: Settings, base: float) -> None:
        self.xyz, self.rings, self.planes, self.settings, self.base = xyz, rings, planes, settings, base
        self._roof: Optional[Partition] = None

    @property
    def is_roof(self) -> np.ndarray:
        """Which points (n,) are on the roof: those on planes, or all where there is no plane."""
        on_plane = self.planes.label >= 0
        return on_plane if on_plane.any() else np.ones(len(self.xyz), bool)

    @property
    def roof(self) -> Optional[Partition]:
        """The footprint divided among the planes, None where there is none."""
        if self._roof is None and len(self.planes):
            s = self.settings
            self._roof = divide_footprint(self.xyz, self.planes, self.rings, s.spacing, s.tolerance, self.base)
        return self._roof


def _single_top(top: _Top) -> tuple[Optional[Partition], str]:
    """Return the footprint under one level top."""
    roof = top.xyz[top.is_roof]
    if not len(roof):
        return None, "it has no points"
    height = max(float(np.percentile(roof[:, 2], top.settings.percentile)), top.base + 0.5)
    cells, inside = empty_partition(top.rings, top.xyz[:, :2])
    if not inside.any():
        return None, "its footprint has no area"
    coefficients = np.array([[0.0, 0.0, height]])
    return Partition(cells, np.where(inside, 0, -1), coefficients, np.zeros((len(cells), 1))), ""


def _level_tops(top: _Top) -> tuple[Optional[Partition], str]:
    """Return the partition of the roof with level tops, one for all parts that are not clearly apart in height."""
    roof = top.roof
    if roof is None:
        return None, "no roof plane was found"
    part = _joined_parts(roof, top.settings.min_step)
    inside = roof.label >= 0
    n = int(part.max()) + 1
    heights = np.zeros(n)
    is_roof = top.is_roof
    for number in range(n):
        rows = np.concatenate([roof.cells.members[c] for c in np.flatnonzero(part == number)])
        rows = rows[is_roof[rows]]
        planes = np.unique(roof.label[part == number])
        z = top.xyz[rows, 2] if len(rows) else top.xyz[np.isin(top.planes.label, planes), 2]
        heights[number] = max(float(np.percentile(z, top.settings.percentile)), top.base + 0.5)
    coefficients = np.column_stack([np.zeros((n, 2)), heights])
    cost = np.zeros((len(roof.cells), n))
    return Partition(roof.cells, np.where(inside, part, -1), coefficients, cost), ""


def _roof(top: _Top) -> tuple[Optional[Partition], str]:
    """Return the partition of the roof."""
    roof = top.roof
    if roof is None:
        return None, "no roof plane was found"
    return Partition(roof.cells, roof.label, roof.coefficients, roof.cost), ""


def _joined_parts(roof: Partition, min_step: float) -> np.ndarray:
    """Return the part (cells,) of each cell, -1 outside: parts meet where roofs step by less than ``min_step`` (m)."""
    ends, beside = roof.cells.edges()
    one, other = roof.label[beside[:, 0]], roof.label[beside[:, 1]]
    rows = (one >= 0) & (other >= 0)
    places = np.array(roof.cells.vertices)
    planes = roof.coefficients
    step = np.zeros(len(ends))
    for k in (0, 1):
        xy = places[ends[:, k]]
        difference = planes[one] - planes[other]
        step = step + np.abs((difference[:, :2] * xy).sum(axis=1) + difference[:, 2]) / 2
    rows &= (one == other) | (step < min_step)
    _, group = components(beside[rows, 0], beside[rows, 1], len(roof.cells))
    part = np.full(len(roof.cells), -1)
    inside = roof.label >= 0
    part[inside] = np.unique(group[inside], return_inverse=True)[1]
    return part


def _solids(partition: Partition, base: float) -> list[Solid]:
    """Return the solids of a partition, one for each connected part, none where one cannot be made."""
    areas = partition.cells.areas()
    total = areas[partition.label >= 0].sum()
    waiting, solids = _connected(partition), []
    while waiting:
        part = waiting.pop()
        before = part.label >= 0
        # Slivers that touch the rest only in a point are no building.
        if areas[before].sum() <= _SLIVER * total:
            continue
        if not _cleared(part, base):
            return []
        if (before & (part.label < 0)).any():
            waiting += _connected(part)
        else:
            solids.append(build_solid(part.cells, part.label, part.coefficients, base))
    return solids


def _connected(partition: Partition) -> list[Partition]:
    """Return the parts of a partition whose cells have edges in common."""
    inside = partition.label >= 0
    _, beside = partition.cells.edges()
    both = inside[beside].all(axis=1)
    _, group = components(beside[both, 0], beside[both, 1], len(inside))
    labels = [np.where(inside & (group == number), partition.label, -1) for number in np.unique(group[inside])]
    return [Partition(partition.cells.copy(), label, partition.coefficients, partition.cost) for label in labels]


def _fault(solids: list[Solid]) -> str:
    """Return what is wrong with the solids of a building, "" where nothing is."""
    return next((fault for fault in map(fault_of, solids) if fault), "" if solids else "no solid could be made")


def _cleared(partition: Partition, base: float) -> bool:
    """Give cells another plane until no more than two walls meet in any edge; return whether that was possible."""
    for _ in range(_MOST_ROUNDS):
        levels = Levels(partition.cells, partition.label, partition.coefficients, base)
        crowded = levels.crowded()
        if not crowded:
            return True
        touched: set[int] = set()
        for vertex in crowded:
            around = levels.cells_around(vertex)
            if touched.isdisjoint(around):
                touched.update(around)
                _clear(partition, vertex, around, base)
    return False


def _clear(partition: Partition, vertex: int, around: list[int], base: float) -> None:
    """Give one of the cells around a vertex the plane of another one, the cheapest that clears the place."""
    x, y = partition.cells.vertices[vertex]
    present = sorted({int(partition.label[cell]) for cell in around})
    best: Optional[tuple[float, int, int]] = None
    for position, cell in enumerate(around):
        own = int(partition.label[cell])
        if own < 0:
            continue
        area = partition.cells.area(partition.cells.loops[cell])
        for label in present:
            changed = [int(partition.label[c]) for c in around]
            changed[position] = label
            if label == own or turns_around([_height(partition, k, x, y, base) for k in changed]) > 2:
                continue
            loss = 3 * area if label < 0 else float(partition.cost[cell, label] - partition.cost[cell, own])
            if best is None or (loss + 0.01 * area, cell, label) < best:
                best = loss + 0.01 * area, cell, label
    if best is not None:
        partition.label[best[1]] = best[2]


def _height(partition: Partition, label: int, x: float, y: float, base: float) -> float:
    if label < 0:
        return base
    a, b, c = partition.coefficients[label]
    return a * x + b * y + c


def _off_model(top: _Top, partition: Partition, solids: list[Solid]) -> tuple[np.ndarray, np.ndarray]:
    """Return the distance (n,), m, of the points to the model, and the planes above or below them.

    The distance is that to the plane or to a wall, whichever is less; NaN beside the model.
    """
    label = np.full(len(top.xyz), -1)
    for cell in np.flatnonzero(partition.label >= 0):
        label[partition.cells.members[cell]] = partition.label[cell]
    a, b, c = partition.coefficients[label].T
    off = np.abs(top.xyz[:, 2] - a * top.xyz[:, 0] - b * top.xyz[:, 1] - c) / np.sqrt(1 + a**2 + b**2)
    far = np.flatnonzero((label >= 0) & (off > top.settings.tolerance))
    if len(far):
        off[far] = np.minimum(off[far], _from_walls(top.xyz[far], solids))
    return np.where(label >= 0, off, np.nan), label


def _from_walls(xyz: np.ndarray, solids: list[Solid]) -> np.ndarray:
    """Return the distance (n,), m, of points to the nearest wall, each as the rectangle around it."""
    nearest = np.full(len(xyz), np.inf)
    for solid in solids:
        for face in np.flatnonzero([kind == WALL for kind in solid.kinds]):
            corners = solid.vertices[solid.faces[face][0]]
            away = corners[:, :2] - corners[0, :2]
            start = corners[0, :2]
            along = away[np.argmax((away**2).sum(axis=1))]
            length = max(float(np.hypot(*along)), 1e-9)
            along = along / length
            place = (xyz[:, :2] - start) @ along
            low, high = (away @ along).min(), (away @ along).max()
            beside = place - np.clip(place, low, high)
            across = (xyz[:, 0] - start[0]) * along[1] - (xyz[:, 1] - start[1]) * along[0]
            over = xyz[:, 2] - np.clip(xyz[:, 2], corners[:, 2].min(), corners[:, 2].max())
            nearest = np.minimum(nearest, beside**2 + across**2 + over**2)
    return np.sqrt(nearest)


def _root_mean_square(off: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.minimum(off, _FARTHEST) ** 2))) if len(off) else np.nan


def _worse(model: BuildingModel, level: str, top: _Top, off: np.ndarray) -> str:
    """Return why the next level is no improvement, "" where it is one."""
    off = off[top.is_roof & np.isfinite(off)]
    if not len(off):
        return "no points lie over it"
    if level == "2.2" and np.mean(off <= _EXPLAINED * top.settings.tolerance) < _LEAST_EXPLAINED:
        return "planes explain less than half of the roof"
    before = [rms for rms in model.rms_of.values() if np.isfinite(rms)]
    return (
        "it is farther from the points than a simpler model" if before and _root_mean_square(off) > min(before) else ""
    )


def _enter(
    model: BuildingModel,
    level: str,
    top: _Top,
    partition: Partition,
    solids: list[Solid],
    off: np.ndarray,
    label: np.ndarray,
) -> None:
    """Put a level into the model as its best one."""
    over = np.isfinite(off)
    counted = top.is_roof & over
    model.level, model.solids[level] = level, solids
    model.rms = model.rms_of[level] = _root_mean_square(off[counted])
    model.explained = float(np.mean(off[over] <= _EXPLAINED * top.settings.tolerance)) if over.any() else np.nan
    model.covered = _covered(top, partition)
    by_plane: dict[int, float] = defaultdict(lambda: np.nan)
    for plane in np.unique(label[counted]):
        by_plane[int(plane)] = _root_mean_square(off[counted & (label == plane)])
    model.face_rms = by_plane


def _covered(top: _Top, partition: Partition) -> float:
    """Return the share of the footprint that has points, counted in cells of two spacings."""
    size = 2 * top.settings.spacing
    area = float(partition.cells.areas()[partition.label >= 0].sum())
    rows = [partition.cells.members[c] for c in np.flatnonzero(partition.label >= 0)]
    cells = np.unique(np.floor(top.xyz[np.concatenate(rows), :2] / size), axis=0)
    return min(1.0, len(cells) * size**2 / area) if area > 0 else np.nan
