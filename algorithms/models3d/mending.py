"""Solids of divided footprints; where one has a fault, the part of the roof there gets another plane."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..geometry.groups import components, mask_of
from .roof_limits import RADIUS, HeightsAround
from .roof_partition import FARTHEST, FORBIDDEN, Partition
from .roof_planes import planes_through
from .solid_faces import build_solid
from .solid_faults import faults_of
from .solid_levels import Levels, is_crowded
from .solids import RESOLUTION, ROOF, Solid

# Most rounds of giving small parts and high cells another plane.
_ROUNDS = 10

# Most rounds of giving parts with faults another plane, and of clearing positions where too many walls meet.
_MENDINGS = 40

# Parts of a roof larger than this (m²) are no dormers: one fault must not cost the whole part.
LARGE = 5.0

# The first rounds lower parts with faults; in as many further rounds high cells may still change.
_LOWERINGS = _ROUNDS // 2

# A part with a fault is first lowered by this distance (m): more than the snapping distance of corners, less than the
# error of points. Where roofs cross, the corners move, and no longer meet an edge by chance.
_LOWERED = 0.02

# Parts of a roof with less area in plan (m²), or a smaller mean width (m), join a neighbor: they are smaller than
# dormers, and no wider than the distance of points.
_LEAST_AREA, _LEAST_WIDTH = 1.0, 0.4


@dataclass
class _Piece:
    """A connected part of a footprint: its solid, the cells next to each face, and the plane of each cell."""

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
    A part with a fault is lowered a little. If it still has one and is large, single cells at its border take planes
    of neighbors, the smallest first. Else it takes the plane of a neighbor or becomes level, whichever is nearer to its
    points. A level part with a fault always joins a neighbor. All other parts stay as they are. Where single cells
    changed, the same is done without them, and the result nearer to the points is kept. Around a corner above its limit
    a part is cut off, which takes a plane that keeps to the limit.
    """
    found = []
    for may_spare in (True, False):
        own = replace(partition, cells=partition.cells.copy(), label=partition.label.copy())
        mending = _Mending(own, xyz, limits, percentile, may_spare)
        found.append((*_mended(mending, base), mending))
        if not mending.changed:
            break
    solids, why, best = min(found, key=lambda one: one[2].off() if one[0] else np.inf)
    for name in ("cells", "label", "coefficients", "cost"):
        setattr(partition, name, getattr(best.partition, name))
    return solids, why


def _mended(mending: _Mending, base: float) -> tuple[list[Solid], str]:
    """Return valid solids, or none and why."""
    count = 0
    while count < _MENDINGS:
        # Lowering a corner may undo a mend that raised it, so later rounds lower none.
        if count < _ROUNDS:
            mending.lower_high_cells()
        mending.join_small_parts()
        pieces = _pieces(mending.partition, base, mending.highest)
        if not pieces:
            break
        found = [(piece, *one) for piece in pieces for one in faults_of(piece.solid).items()]
        if not found:
            return [piece.solid for piece in pieces], ""
        changed = len(mending.changed)
        if not mending.relabel([(piece, face) for piece, face, _ in found], count < _LOWERINGS):
            return [], found[0][2]
        # Single changed cells count these rounds.
        count += len(mending.changed) == changed
    return [], "no solid could be made"


def _pieces(partition: Partition, base: float, highest: np.ndarray) -> list[_Piece]:
    """Return the solids of the connected parts; labels become those that they have, none where one cannot be made."""
    areas = partition.cells.areas()
    total = areas[partition.label >= 0].sum()
    waiting, pieces = connected(partition), []
    while waiting:
        part = waiting.pop()
        before = part.label >= 0
        partition.label[before] = -1
        # Drop slivers that touch the rest in a point only.
        if areas[before].sum() <= min(_LEAST_AREA, total / 2):
            continue
        levels = _cleared(part, base, highest)
        if levels is None:
            return []
        if (before & (part.label < 0)).any():
            waiting += connected(part)
        else:
            pieces.append(_Piece(*build_solid(levels), part.label.copy()))
        partition.label[before] = part.label[before]
    return pieces


def connected(partition: Partition) -> list[Partition]:
    """Return the parts of a partition whose cells have edges in common."""
    inside = partition.label >= 0
    _, beside = partition.cells.edges()
    both = inside[beside].all(axis=1)
    _, group = components(beside[both, 0], beside[both, 1], len(inside))
    labels = [np.where(inside & (group == number), partition.label, -1) for number in np.unique(group[inside])]
    return [Partition(partition.cells.copy(), label, partition.coefficients, partition.cost) for label in labels]


def _cleared(partition: Partition, base: float, highest: np.ndarray) -> Optional[Levels]:
    """Give cells other planes until at most two walls meet in any edge; return the heights, None if that fails."""
    for _ in range(_MENDINGS):
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
                is_changed |= _clear(partition, levels, vertex, highest)
        if not is_changed:
            break
    return None


def _clear(partition: Partition, levels: Levels, vertex: int, highest: np.ndarray) -> bool:
    """Give one of the cells around a vertex the plane of another one, the cheapest that clears it, if any does.

    A plane with a corner above its limit (vertices,), m, is the last resort.
    """
    around = levels.cells_around(vertex)
    present = sorted({int(partition.label[cell]) for cell in around})
    height = {label: levels.height(vertex, label) for label in present}
    planes = partition.coefficients
    changes = []
    for position, cell in enumerate(around):
        own = int(partition.label[cell])
        if own < 0:
            continue
        loop = partition.cells.loops[cell]
        area, limit = partition.cells.area(loop), highest[loop] + RESOLUTION
        corners = np.array([partition.cells.vertices[v] for v in loop])
        for label in present:
            changed = [int(partition.label[c]) for c in around]
            changed[position] = label
            if label == own or is_crowded([height[k] for k in changed]):
                continue
            loss = FORBIDDEN if label < 0 else float(partition.cost[cell, label] - partition.cost[cell, own])
            is_high = label >= 0 and bool((planes[label, :2] @ corners.T + planes[label, 2] > limit).any())
            changes.append((is_high, loss, area, cell, label))
    if changes:
        *_, cell, label = min(changes)
        partition.label[cell] = label
    return bool(changes)


class _Mending:
    """Gives parts of a partition other planes.

    ``own`` are planes made for one part, level or fitted to it; ``lowered`` are planes a little below another one.
    """

    def __init__(
        self, partition: Partition, xyz: np.ndarray, limits: Optional[HeightsAround], percentile: float, may_spare: bool
    ) -> None:
        self.partition, self.xyz, self.limits, self.percentile = partition, xyz, limits, percentile
        # Whether single cells may change, each once, and those that have.
        self.may_spare = may_spare
        self.changed: set[int] = set()
        self.own: set[int] = set()
        self.lowered: set[int] = set()
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
        """Give parts that are too small or too narrow the plane of a neighbor, the smallest one first.

        They stay where all neighbors' planes would have corners above the points.
        """
        for _ in range(_ROUNDS):
            part = self._parts()
            area, is_small = self._small(part)
            is_changed = False
            for number in sorted(np.flatnonzero(is_small).tolist(), key=lambda number: (area[number], number)):
                cells = np.flatnonzero(part == number)
                corners = np.unique(np.concatenate([self.loops[cell] for cell in cells]))
                low = (k for k in self._neighbors(cells) if not self._is_high(corners, self.partition.coefficients[k]))
                is_changed |= self._take(cells, list(low))
            if not is_changed:
                return

    def _parts(self) -> np.ndarray:
        """Return the part (cells,) of one plane that each cell is in."""
        label = self.partition.label
        same = label[self.beside[:, 0]] == label[self.beside[:, 1]]
        return components(self.beside[same, 0], self.beside[same, 1], len(label))[1]

    def _small(self, part: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the areas (m²) of parts, and which of them are roof that is too small or too narrow."""
        count = int(part.max()) + 1
        apart = part[self.beside[:, 0]] != part[self.beside[:, 1]]
        area = np.bincount(part, self.areas, count)
        perimeter = np.bincount(part[self.beside[apart]].ravel(), np.repeat(self.length[apart], 2), count)
        is_small = (area < _LEAST_AREA) | (2 * area < _LEAST_WIDTH * perimeter)
        is_small[part[self.partition.label < 0]] = False
        return area, is_small

    def _is_small(self, cells: np.ndarray) -> bool:
        """Return whether cells (k,) together are too small or too narrow a part."""
        part = np.zeros(len(self.areas), int)
        part[cells] = 1
        return bool(self._small(part)[1][1])

    def lower_high_cells(self) -> None:
        """Give cells with a corner above its points another plane, or a level one.

        A whole cell changes if that is an improvement; else the part around the corner is cut off first.
        """
        if self.limits is None:
            return
        for _ in range(_ROUNDS):
            cells, corners = map(np.unique, self._high_corners())
            if not len(cells):
                return
            if not any([self._lower(np.array([cell])) for cell in cells]):
                self._cut_off_at(corners)

    def _cut_off_at(self, corners: np.ndarray) -> None:
        """Cut off parts that are too high at some corners, and give it another plane."""
        for corner in corners.tolist():
            for cell in self._high_at(corner):
                if cell in self._high_at(corner):
                    turned, piece = self._cut_off(cell, corner), np.array([cell])
                    self._take(piece, self._neighbors(piece), True, turned)

    def _lower(self, part: np.ndarray) -> bool:
        """Give a part a better plane, if there is one; return whether it did. A small level one would join again."""
        return self._take(part, [int(self.partition.label[part[0]]), *self._neighbors(part)], not self._is_small(part))

    def _high_at(self, corner: int) -> list[int]:
        """Return the cells that are too high at a corner."""
        cells, corners = self._high_corners()
        return cells[corners == corner].tolist()

    def _high_corners(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the cells (k,) that have corners above the points around, and these corners (k,)."""
        used = np.flatnonzero(self.partition.label >= 0)
        cell = np.repeat(used, [len(self.loops[cell]) for cell in used])
        corner = np.concatenate([self.loops[cell] for cell in used])
        a, b, c = self.partition.coefficients[self.partition.label[cell]].T
        x, y = self.positions[corner].T
        is_high = a * x + b * y + c > self.highest[corner] + RESOLUTION
        return cell[is_high], corner[is_high]

    def _cut_off(self, cell: int, corner: int) -> np.ndarray:
        """Cut a cell at the distance from one of its corners within which points limit the height there.

        Return the plane (3,) of the part with the corner, turned down about the cut.
        """
        at, inward, partition = self.positions[corner], self._way_in(cell, corner), self.partition
        # The part with the corner lies to the left of the cut and keeps the number of the cell.
        if partition.cells.cut_cell(cell, at + RADIUS * inward, np.array([-inward[1], inward[0]])):
            partition.label = np.append(partition.label, partition.label[cell])
            partition.cost = np.vstack([partition.cost, partition.cost[cell]])
        self._measure()
        corners = self.loops[cell]
        depth = RADIUS - (self.positions[corners] - at) @ inward
        is_deep = depth > RADIUS / 2
        plane = partition.coefficients[partition.label[cell]]
        slope = (self._above(corners[is_deep], plane) / depth[is_deep]).max()
        return plane + slope * np.array([*inward, -RADIUS - at @ inward])

    def _way_in(self, cell: int, corner: int) -> np.ndarray:
        """Return the unit vector (2,) from a corner of a cell to the middle of its corners."""
        inward = self.positions[self.loops[cell]].mean(axis=0) - self.positions[corner]
        return inward / np.hypot(*inward)

    def relabel(self, faces: list[tuple[_Piece, int]], may_lower: bool) -> bool:
        """Give the smallest part next to each face another plane; return whether any had one to take.

        With ``may_lower``, first try the same plane slightly lower.
        """
        is_changed, touched = False, np.zeros(len(self.partition.label), bool)
        for piece, face in faces:
            roofs = [cells for cells, kind in zip(piece.cells, piece.solid.kinds) if kind == ROOF]
            beside = set(piece.cells[face])
            parts = [cells for cells in roofs if not beside or not beside.isdisjoint(cells)]
            part = np.array(min(parts, key=lambda cells: (self.areas[cells].sum(), cells[0])))
            if not touched[part].any():
                touched[part] = True
                own = int(self.partition.label[part[0]])
                if may_lower and own not in self.lowered:
                    self.lowered.add(self._add_plane(part, self.partition.coefficients[own] - [0.0, 0.0, _LOWERED]))
                    is_changed = True
                else:
                    is_changed |= self._spare(part) or self._take(part, self._neighbors(part), own not in self.own)
        return is_changed

    def _spare(self, part: np.ndarray) -> bool:
        """Give the smallest cell at the border of a large part the plane of a neighbor; return whether one was left."""
        if not self.may_spare or self.areas[part].sum() <= LARGE:
            return False
        is_part = mask_of(len(self.areas), part)
        edges = self.beside[is_part[self.beside].sum(axis=1) == 1]
        inner, outer = np.where(is_part[edges], edges, 0).sum(axis=1), np.where(is_part[edges], 0, edges).sum(axis=1)
        cells = set(inner[self.partition.label[outer] >= 0].tolist()) - self.changed
        if not cells:
            return False
        cell = np.array([min(cells, key=lambda cell: (self.areas[cell], cell))])
        self.changed.add(int(cell[0]))
        return self._take(cell, self._neighbors(cell))

    def off(self) -> float:
        """Return the sum of the distances (m) of points above and below the roof."""
        return float(np.fmin(np.abs(self.partition.above(self.xyz)[0]), FARTHEST).sum())

    def _neighbors(self, part: np.ndarray) -> list[int]:
        """Return the planes of the neighbors of a part."""
        label = self.partition.label
        is_part = mask_of(len(label), part)
        around = label[self.beside[is_part[self.beside].sum(axis=1) == 1]].ravel()
        return sorted(set(around[(around >= 0) & (around != label[part[0]])].tolist()))

    def _take(
        self, part: np.ndarray, planes: list[int], may_be_level: bool = False, turned: Optional[np.ndarray] = None
    ) -> bool:
        """Give a part the best of some planes, or a level one; return whether that is another one.

        With a plane ``turned`` (3,) down, that one and the one through its points are tried as well, and those that
        have a corner of the part above the points around only if all have.
        """
        partition = self.partition
        own = int(partition.label[part[0]])
        rows = np.concatenate([partition.cells.members[cell] for cell in part])
        corners = np.unique(np.concatenate([self.loops[cell] for cell in part]))
        options = [(plane, partition.coefficients[plane]) for plane in planes]
        new = len(partition.coefficients)
        if may_be_level and (turned is not None or own not in self.own):
            options.append((new, self._level_plane(rows, corners, own)))
        if turned is not None:
            options.append((new, turned))
            if len(rows) > 3:
                options.append((new, planes_through(self.xyz[rows], np.zeros(len(rows), int)).coefficients[0]))
        if not options:
            return False
        area = float(self.areas[part].sum())

        def loss(option: tuple) -> tuple[bool, float]:
            is_high = turned is not None and self._is_high(corners, option[1])
            return is_high, self._loss(rows, area, option[1]) + max(float(self._above(corners, option[1]).max()), 0.0)

        best, coefficients = min(options, key=loss)
        if best == new:
            self.own.add(self._add_plane(part, coefficients))
        else:
            partition.label[part] = best
        return best != own

    def _add_plane(self, part: np.ndarray, coefficients: np.ndarray) -> int:
        """Give a part a plane of its own; return the number of that plane."""
        partition, new = self.partition, len(self.partition.coefficients)
        own = partition.label[part[0]]
        partition.coefficients = np.vstack([partition.coefficients, coefficients])
        partition.cost = np.column_stack([partition.cost, partition.cost[:, own]])
        partition.label[part] = new
        return new

    def _level_plane(self, rows: np.ndarray, corners: np.ndarray, own: int) -> np.ndarray:
        """Return the level plane (3,) at the height of some points, not above the limits of corners."""
        a, b, c = self.partition.coefficients[own]
        height = float(np.mean(self.positions[corners] @ [a, b]) + c)
        if len(rows):
            height = float(np.percentile(self.xyz[rows, 2], self.percentile))
        return np.array([0.0, 0.0, min(height, float(self.highest[corners].min()))])

    def _loss(self, rows: np.ndarray, area: float, plane: np.ndarray) -> float:
        """Return the volume (m³) of a part that a plane leaves out, by the heights of its points."""
        a, b, c = plane
        off = np.abs(self.xyz[rows, 2] - self.xyz[rows, :2] @ [a, b] - c)
        return float(np.minimum(off, FARTHEST).mean()) * area if len(rows) else 0.0

    def _is_high(self, corners: np.ndarray, plane: np.ndarray) -> bool:
        """Return whether a plane exceeds the height limit at any of the corners."""
        return bool((self._above(corners, plane) > RESOLUTION).any())

    def _above(self, corners: np.ndarray, plane: np.ndarray) -> np.ndarray:
        """Return the heights (k,), m, of a plane above the limits of corners."""
        return self.positions[corners] @ plane[:2] + plane[2] - self.highest[corners]
