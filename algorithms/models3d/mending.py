"""Solids of divided footprints; where one has a fault, the part of the roof there gets another plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.groups import components
from .heights_around import RADIUS, HeightsAround
from .roof_partition import Partition
from .roof_planes import planes_through
from .solid_faults import faults_of
from .solids import DECIMALS, ROOF, Levels, Solid, build_solid, turns_around

# Rounds in which positions where too many walls meet are cleared, in which small parts and high cells get another
# plane, and in which those with faults do.
_CLEARINGS, _ROUNDS, _MENDINGS = 60, 10, 40

# Parts of a footprint with less than this share of its area are not modelled.
_SLIVER = 0.01

# Parts of a roof with less area in plan (m²), or a smaller mean width (m), join a neighbor: they are smaller than
# dormers, and no wider than the distance of points.
_LEAST_AREA, _LEAST_WIDTH = 1.0, 0.4

# Distances off a plane count at most this much (m) when planes are compared for a part: points farther off are not
# roof.
_FARTHEST = 1.0


@dataclass
class _Piece:
    """A connected part of a footprint: its solid, the cells beside each face, and the plane of each cell."""

    solid: Solid
    cells: list[list[int]]
    label: np.ndarray


def mended(
    partition: Partition, base: float, xyz: np.ndarray, limits: Optional[HeightsAround], percentile: float
) -> tuple[list[Solid], str]:
    """Return valid solids of a partition, whose labels change where a fault is mended, and why there are no solids.

    Parameters
    ----------
    partition : Partition
        The footprint divided among planes; its labels and planes are changed.
    base : float
        Height of the ground (m).
    xyz : ndarray of shape (n, 3)
        The points (m) that its cells hold.
    limits : HeightsAround or None
        How high roofs may reach.
    percentile : float
        Of the heights of a part that becomes level.

    Notes
    -----
    A part with a fault takes the plane of a neighbor or becomes level, whichever is nearer to its points. A level part
    with a fault always joins a neighbor. All other parts stay as they are. Around a corner above its limit a part is
    cut off, which takes a plane that keeps to the limit.
    """
    if limits is not None:
        # Its cells may be cut; those of the simpler levels stay.
        partition.cells = partition.cells.copy()
    mending = _Mending(partition, xyz, limits, percentile)
    for _ in range(_MENDINGS):
        mending.lower_high_cells()
        mending.join_small_parts()
        pieces = _pieces(partition, base)
        if not pieces:
            break
        found = [(piece, *one) for piece in pieces for one in faults_of(piece.solid).items()]
        if not found:
            return [piece.solid for piece in pieces], ""
        if not mending.relabel([(piece, face) for piece, face, _ in found]):
            return [], found[0][2]
    return [], "no solid could be made"


def _pieces(partition: Partition, base: float) -> list[_Piece]:
    """Return the solids of the connected parts; labels become those that they have, none where one cannot be made."""
    areas = partition.cells.areas()
    total = areas[partition.label >= 0].sum()
    waiting, pieces = _connected(partition), []
    while waiting:
        part = waiting.pop()
        before = part.label >= 0
        partition.label[before] = -1
        # Slivers that touch the rest only in a point are no building.
        if areas[before].sum() <= _SLIVER * total:
            continue
        levels = _cleared(part, base)
        if levels is None:
            return []
        if (before & (part.label < 0)).any():
            waiting += _connected(part)
        else:
            label = part.label.copy()
            pieces.append(_Piece(*build_solid(levels), label))
        partition.label[before] = part.label[before]
    return pieces


def _connected(partition: Partition) -> list[Partition]:
    """Return the parts of a partition whose cells have edges in common."""
    inside = partition.label >= 0
    _, beside = partition.cells.edges()
    both = inside[beside].all(axis=1)
    _, group = components(beside[both, 0], beside[both, 1], len(inside))
    labels = [np.where(inside & (group == number), partition.label, -1) for number in np.unique(group[inside])]
    return [Partition(partition.cells.copy(), label, partition.coefficients, partition.cost) for label in labels]


def _cleared(partition: Partition, base: float) -> Optional[Levels]:
    """Give cells other planes until at most two walls meet in any edge; return the heights, None if that fails."""
    for _ in range(_CLEARINGS):
        levels = Levels(partition.cells, partition.label, partition.coefficients, base)
        crowded = levels.crowded()
        if not crowded:
            return levels
        touched: set[int] = set()
        is_changed = False
        for vertex in crowded:
            around = levels.cells_around(vertex)
            if touched.isdisjoint(around):
                touched.update(around)
                is_changed |= _clear(partition, levels, vertex, around)
        if not is_changed:
            break
    return None


def _clear(partition: Partition, levels: Levels, vertex: int, around: list[int]) -> bool:
    """Give one of the cells around a vertex the plane of another one, the cheapest that clears it, if any does."""
    present = sorted({int(partition.label[cell]) for cell in around})
    height = {label: levels.height(vertex, label) for label in present}
    best: Optional[tuple[float, int, int]] = None
    for position, cell in enumerate(around):
        own = int(partition.label[cell])
        if own < 0:
            continue
        area = partition.cells.area(partition.cells.loops[cell])
        for label in present:
            changed = [int(partition.label[c]) for c in around]
            changed[position] = label
            if label == own or turns_around([height[k] for k in changed]) > 2:
                continue
            loss = 3 * area if label < 0 else float(partition.cost[cell, label] - partition.cost[cell, own])
            if best is None or (loss + 0.01 * area, cell, label) < best:
                best = loss + 0.01 * area, cell, label
    if best is not None:
        partition.label[best[1]] = best[2]
    return best is not None


class _Mending:
    """Gives parts of a partition other planes."""

    def __init__(
        self, partition: Partition, xyz: np.ndarray, limits: Optional[HeightsAround], percentile: float
    ) -> None:
        self.partition, self.xyz, self.limits, self.percentile = partition, xyz, limits, percentile
        self.level: set[int] = set()
        self._measure()

    def _measure(self) -> None:
        """Take the measures of the cells."""
        cells, limits = self.partition.cells, self.limits
        self.areas = cells.areas()
        ends, self.beside = cells.edges()
        self.positions = np.array(cells.vertices)
        self.length = np.hypot(*(self.positions[ends[:, 0]] - self.positions[ends[:, 1]]).T)
        self.highest = np.full(len(self.positions), np.inf) if limits is None else limits.highest(self.positions)
        self.loops = [np.array(loop) for loop in cells.loops]

    def join_small_parts(self) -> None:
        """Give parts that are too small or too narrow the plane of a neighbor, the smallest one first."""
        for _ in range(_ROUNDS):
            part, area, is_small = self._small_parts()
            is_changed = False
            for number in sorted(np.flatnonzero(is_small).tolist(), key=lambda number: (area[number], number)):
                cells = np.flatnonzero(part == number)
                is_changed |= self._take(cells, self._neighbors(cells))
            if not is_changed:
                return

    def _small_parts(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the part (cells,) of equal planes that each cell is in, the parts' areas, and which are too small."""
        label = self.partition.label
        same = label[self.beside[:, 0]] == label[self.beside[:, 1]]
        count, part = components(self.beside[same, 0], self.beside[same, 1], len(label))
        area = np.bincount(part, self.areas, count)
        perimeter = np.bincount(part[self.beside[~same]].ravel(), np.repeat(self.length[~same], 2), count)
        is_small = (area < _LEAST_AREA) | (2 * area < _LEAST_WIDTH * perimeter)
        is_small[part[label < 0]] = False
        return part, area, is_small

    def lower_high_cells(self) -> None:
        """Give cells with a corner above its points another plane, or a level one.

        A whole cell changes where that is an improvement; of others what lies around the corner is cut off first.
        """
        if self.limits is None:
            return
        for _ in range(_ROUNDS):
            label = self.partition.label
            parts = [np.array([cell]) for cell in np.unique(self._high_corners()[0])]
            changes = [self._take(part, [int(label[part[0]]), *self._neighbors(part)], True) for part in parts]
            if not any(changes):
                break
        cells, corners = self._high_corners()
        self._cut_off(cells, corners)
        for corner in np.unique(corners).tolist():
            cells, high = self._high_corners()
            part = cells[high == corner]
            if len(part):
                self._take(part, self._neighbors(part), True, must_fit=True)

    def _high_corners(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the cells (k,) that have corners above the points around, and these corners (k,)."""
        used = np.flatnonzero(self.partition.label >= 0)
        cell = np.repeat(used, [len(self.loops[cell]) for cell in used])
        corner = np.concatenate([self.loops[cell] for cell in used])
        a, b, c = self.partition.coefficients[self.partition.label[cell]].T
        x, y = self.positions[corner].T
        is_high = a * x + b * y + c > self.highest[corner] + 10**-DECIMALS
        return cell[is_high], corner[is_high]

    def _cut_off(self, cells: np.ndarray, corners: np.ndarray) -> None:
        """Cut cells (k,) around their corners (k,), as far from them as points count for the heights there."""
        partition = self.partition
        places = partition.cells.vertices
        pieces: dict[int, list[int]] = {}
        for cell, corner in zip(cells.tolist(), corners.tolist()):
            own = pieces.setdefault(cell, [cell])
            piece = next(piece for piece in own if corner in partition.cells.loops[piece])
            inward = np.mean([places[v] for v in partition.cells.loops[piece]], axis=0) - places[corner]
            inward /= np.hypot(*inward)
            if partition.cells.cut_cell(piece, places[corner] + RADIUS * inward, np.array([-inward[1], inward[0]])):
                own.append(len(partition.label))
                partition.label = np.append(partition.label, partition.label[cell])
                partition.cost = np.vstack([partition.cost, partition.cost[cell]])
        if len(cells):
            self._measure()

    def relabel(self, faces: list[tuple[_Piece, int]]) -> bool:
        """Give the smallest part beside each face another plane; return whether any had one to take."""
        is_changed, touched = False, np.zeros(len(self.partition.label), bool)
        for piece, face in faces:
            roofs = [cells for cells, kind in zip(piece.cells, piece.solid.kinds) if kind == ROOF]
            beside = set(piece.cells[face])
            parts = [cells for cells in roofs if not beside or not beside.isdisjoint(cells)]
            part = np.array(min(parts, key=lambda cells: (self.areas[cells].sum(), cells[0])))
            if not touched[part].any():
                touched[part] = True
                own = int(self.partition.label[part[0]])
                is_changed |= self._take(part, self._neighbors(part), own not in self.level)
        return is_changed

    def _neighbors(self, part: np.ndarray) -> list[int]:
        """Return the planes of the neighbors of a part."""
        label = self.partition.label
        is_part = np.zeros(len(label), bool)
        is_part[part] = True
        around = label[self.beside[is_part[self.beside].sum(axis=1) == 1]].ravel()
        return sorted(set(around[(around >= 0) & (around != label[part[0]])].tolist()))

    def _take(self, part: np.ndarray, planes: list[int], may_be_level: bool = False, must_fit: bool = False) -> bool:
        """Give a part the best of some planes, or a level one; return whether that is another one.

        Planes that ``must_fit`` have no corner of the part above the points around.
        """
        partition = self.partition
        own = int(partition.label[part[0]])
        rows = np.concatenate([partition.cells.members[cell] for cell in part])
        corners = np.unique(np.concatenate([self.loops[cell] for cell in part]))
        options = [(plane, partition.coefficients[plane]) for plane in planes]
        new = len(partition.coefficients)
        if may_be_level and (must_fit or own not in self.level):
            options.append((new, self._level_plane(rows, corners, own)))
        if must_fit and len(rows) > 3:
            options.append((new, planes_through(self.xyz[rows], np.zeros(len(rows), int)).coefficients[0]))
        if not options:
            return False
        area = float(self.areas[part].sum())

        def loss(option: tuple) -> tuple[bool, float]:
            excess = self._excess(corners, option[1])
            return excess > 10**-DECIMALS and must_fit, self._loss(rows, area, option[1]) + excess

        best, coefficients = min(options, key=loss)
        if best == new:
            partition.coefficients = np.vstack([partition.coefficients, coefficients])
            partition.cost = np.column_stack([partition.cost, partition.cost[:, own]])
            self.level.add(best)
        partition.label[part] = best
        return best != own

    def _level_plane(self, rows: np.ndarray, corners: np.ndarray, own: int) -> np.ndarray:
        """Return the level plane (3,) at the height of some points, not above what corners may have."""
        a, b, c = self.partition.coefficients[own]
        height = float(np.mean(self.positions[corners] @ [a, b]) + c)
        if len(rows):
            height = float(np.percentile(self.xyz[rows, 2], self.percentile))
        return np.array([0.0, 0.0, min(height, float(self.highest[corners].min()))])

    def _loss(self, rows: np.ndarray, area: float, plane: np.ndarray) -> float:
        """Return how much a plane leaves out of a part (m³) by the heights of its points."""
        a, b, c = plane
        off = np.abs(self.xyz[rows, 2] - self.xyz[rows, :2] @ [a, b] - c)
        return float(np.minimum(off, _FARTHEST).mean()) * area if len(rows) else 0.0

    def _excess(self, corners: np.ndarray, plane: np.ndarray) -> float:
        """Return how far (m) a plane is above the points around corners at most."""
        a, b, c = plane
        return float(np.maximum(self.positions[corners] @ [a, b] + c - self.highest[corners], 0.0).max())
