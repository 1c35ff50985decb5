"""Old buildings and new outlines that lie together, compared on a lattice and drawn anew where they have changed.

Changed buildings are drawn along old walls as far as these are right.
"""

from collections.abc import Iterator

import numpy as np

from ..criteria import MAJORITY
from ..footprints.footprint_points import rows_near
from ..footprints.soft_shares import Lattice
from ..geometry.cell_polygons import cell_polygons
from ..geometry.grid import plan_box
from ..geometry.groups import components, mask_of
from ..geometry.polygon_overlap import are_within, as_polygons, meeting_boxes, overlaps
from ..geometry.rings import is_valid, perimeter, polygon_area, sides_of_rings
from ..geometry.subdivision import Subdivision
from ..packages import ndimage, spatial
from ..rules import rule, rules
from ..stage import Monitor
from . import map_changes
from .map_changes import BUILT, OLD, Label, MapUpdate, SeenPoints
from .map_changes import RULES as CHANGES


@rules
class _RULES:
    """Cuts along walls, the cells between them, and sound polygons."""

    # Maps have details of a centimeter; where lines nearly coincide, coarser cuts are sound.
    old_snaps: tuple[float, ...] = rule((0.002, 0.01, 0.05), "m", "at which cuts along old walls pass vertices")
    new_snap: float = rule(0.3, "widths of a change", "at which cuts along new walls pass vertices")
    thin: float = rule(0.025, "m", "area of a cell per length around it, below which it is a seam: a strip 5 cm wide")
    parallel: float = rule(0.17, "sine", "of the greatest angle between a new wall and the old one it continues, 10°")
    overlap: float = rule(
        0.001, "m", "area shared with buildings that stay, per length of the outline: maps have millimeters"
    )


class ChangedBlock:
    """Old buildings and new outlines that lie together, on a lattice; the decisions go into the update."""

    def __init__(
        self, update: MapUpdate, points: SeenPoints, olds: list[int], news: list[int], width: float, min_area: float
    ) -> None:
        self.update, self.olds, self.news, self.width, self.min_area = update, olds, news, width, min_area
        self.radius = width / 2 / CHANGES.step
        corners = [update.rings[row][0] for row in olds] + [update.outlines[row][0] for row in news]
        box = plan_box(np.concatenate(corners)) + [[-2 * width], [2 * width]]
        self.lattice, self.box = Lattice.around(box, 2 * CHANGES.step), [box]
        self.old, self.own = self._painted(olds, update.rings)
        self.new, _ = self._painted(news, update.outlines)
        near = rows_near(points.xyz, self.box)
        reach = max(CHANGES.reach * points.spacing, CHANGES.step)
        self.is_seen = self._around(points.xyz[near], reach)
        self.is_low = self._around(points.xyz[near[points.is_low[near]]], reach)
        self.wanted, self.labels = np.full(self.lattice.shape, 0), dict[Label, int]()

    def _painted(self, rows: list[int], polygons: list) -> tuple[np.ndarray, dict[int, tuple]]:
        """Return the polygon of each node by row, -1 without one, and the window and the mask of each."""
        painted, masks = np.full(self.lattice.shape, -1), {}
        for row in rows:
            rings = polygons[row]
            box = self.lattice.nodes(np.array([rings[0].min(axis=0), rings[0].max(axis=0)]))
            (west, south), (east, north) = np.floor(box[0]).astype(int), np.ceil(box[1]).astype(int) + 1
            window = slice(max(south, 0), north), slice(max(west, 0), east)
            inner = self.lattice.part(window)
            mask = are_within(inner.positions, sides_of_rings(rings)).reshape(inner.shape)
            painted[window][mask] = row
            masks[row] = window, mask
        return painted, masks

    def _around(self, xyz: np.ndarray, reach: float) -> np.ndarray:
        """Return the nodes (rows, columns), bool, within a distance (m) of points (n, 3)."""
        return _within(mask_of(self.lattice.shape, self.lattice.nearest(xyz[:, :2])), reach / CHANGES.step)

    def decide(self, roofs: list[np.ndarray]) -> None:
        """Decide on all buildings, draw the changed and the new ones; ``roofs`` are the roof points of each survey."""
        for row in self.olds:
            self._decide_old(row)
        self._add_parts()
        self._draw()
        if len(roofs) > 1:
            self._compare_heights(*(self._surface(own[rows_near(own, self.box)]) for own in roofs))

    def _surface(self, xyz: np.ndarray) -> np.ndarray:
        """Return the highest elevation (rows, columns), m, around each node of the lattice, NaN without points."""
        top = np.full(self.lattice.shape, -np.inf)
        np.maximum.at(top, self.lattice.nearest(xyz[:, :2]), xyz[:, 2])
        top = ndimage.maximum_filter(top, round(CHANGES.rise / CHANGES.step))
        return np.where(np.isfinite(top), top, np.nan)

    def _compare_heights(self, new: np.ndarray, old: np.ndarray) -> None:
        """Measure how far the roofs that are still there have risen from one surface (rows, columns), m, to another."""
        update, risen = self.update, new - old
        for row in self.olds:
            window, mask = self.own[row]
            known = risen[window][mask & (self.new[window] >= 0) & np.isfinite(risen[window])]
            if len(known) and update.status[row] in (map_changes.UNCHANGED, map_changes.MOVED, map_changes.CHANGED):
                update.rise[row] = by = float(np.median(known))
                if update.status[row] == map_changes.UNCHANGED and abs(by) > CHANGES.rise:
                    update.status[row] = map_changes.HEIGHTENED if by > 0 else map_changes.LOWERED

    def _decide_old(self, row: int) -> None:
        """Decide whether an old building is there, and which parts of it are gone."""
        update, (window, mask) = self.update, self.own[row]
        if not mask.any():
            update.status[row] = map_changes.DOUBTFUL
            return
        has_new, low, seen = (one[window][mask] for one in (self.new >= 0, self.is_low, self.is_seen))
        covered = float(has_new.mean())
        update.confidence[row] = covered
        is_empty = float((low & ~has_new).mean()) >= MAJORITY
        if covered < MAJORITY and seen.mean() < MAJORITY:
            update.status[row], update.confidence[row] = map_changes.UNSEEN, 0.0
        elif covered <= CHANGES.gone:
            update.status[row] = map_changes.GONE if is_empty else map_changes.DOUBTFUL
            update.confidence[row] = float(low.mean()) if is_empty else covered
        else:
            removed = self._removed(window, mask)
            if removed.any():
                self._label((OLD, row), window, mask & ~removed)
                update.removed[row] = removed.sum() * CHANGES.step**2
            elif covered < MAJORITY:
                update.status[row] = map_changes.DOUBTFUL

    def _removed(self, window: tuple, mask: np.ndarray) -> np.ndarray:
        """Return the nodes of a building (rows, columns), bool, that are of it no more."""
        lost = np.pad(mask & (self.new[window] < 0), 1)
        part, count = ndimage.label(_opened(lost, self.radius)[1:-1, 1:-1])
        size = np.bincount(part.ravel(), minlength=count + 1) * CHANGES.step**2
        low = np.bincount(part.ravel(), self.is_low[window].ravel(), count + 1) * CHANGES.step**2
        is_gone = (size >= self.min_area) & (low >= MAJORITY * size)
        is_gone[0] = False
        gone = is_gone[part]
        # No strip is left along the parts cut off.
        kept = np.pad(mask & ~gone, 1)
        return gone | (kept & ~_opened(kept, self.radius))[1:-1, 1:-1] & _within(gone, 2 * self.radius)

    def _label(self, label: Label, window: tuple, mask: np.ndarray) -> None:
        """Want a building to have some nodes: an old one those that it keeps, and others that are added."""
        self.wanted[window][mask] = self.labels.setdefault(label, len(self.labels) + 1)

    def _add_parts(self) -> None:
        """Find the parts that only the new outlines have, and the buildings that they belong to."""
        is_added = _opened((self.new >= 0) & (self.old < 0), self.radius)
        part = ndimage.label(is_added)[0]
        pairs, number = np.unique(np.stack([part, self.new])[:, is_added], axis=1, return_inverse=True)
        part[is_added] = number.ravel() + 1
        parts = list(zip(ndimage.find_objects(part), pairs[1].tolist()))
        size = np.bincount(part.ravel(), minlength=len(parts) + 1)[1:] * CHANGES.step**2
        for number in np.argsort(-size, kind="stable")[: np.sum(size >= self.min_area)].tolist():
            window, outline = parts[number]
            kind, row = label = self._owner(outline, part == number + 1, size[number])
            if kind == OLD:
                if label not in self.labels:
                    self._label(label, *self.own[row])
                self.update.added[row] += size[number]
            self._label(label, window, part[window] == number + 1)

    def _owner(self, outline: int, mask: np.ndarray, size: float) -> Label:
        """Return the building that a part of a new outline, with that size (m²), is of: one that it adjoins or its own.

        Of those that it adjoins along a long side, it is of the one whose walls go on along it: their convex hull grows
        least. A part that is as large as the old building that it adjoins is a building of its own.
        """
        update = self.update
        if update.is_new[outline]:
            return BUILT, outline
        near, least = _within(mask, self.width / CHANGES.step), CHANGES.step**2
        there = map_changes.UNCHANGED, map_changes.MOVED
        may = [row for row in update.covered[outline] if update.status[row] in there]
        may = [row for row in may if size < polygon_area(update.rings[row])]
        new = [number for (kind, _), number in self.labels.items() if kind == BUILT]
        # Areas next to the part: the length of the border times the width of a change.
        sides = {row: np.sum(self.old[near] == row) * least for row in may}
        most = max(sides.values(), default=0.0)
        wide = (row for row, side in sides.items() if side >= CHANGES.side * most)
        row = min(wide, key=lambda row: self._growth(row, mask), default=-1)
        old_side = sides.get(row, 0.0)
        new_side, number = max(((np.sum(self.wanted[near] == one) * least, one) for one in new), default=(0.0, 0))
        # Walls of the map are more accurate than a survey's borders between roofs, so a strip along one belongs to the
        # new building beyond it. Nodes of a strip lie a quarter of its depth from its sides.
        depth = 4 * CHANGES.step * ndimage.distance_transform_edt(mask)[mask].mean()
        if new_side > old_side or (new_side and depth < CHANGES.strip * self.width):
            return list(self.labels)[number - 1]
        return (OLD, row) if old_side else (BUILT, outline)

    def _growth(self, row: int, mask: np.ndarray) -> float:
        """Return the area (m²) by which the convex hull of an old building grows with a part of nodes, bool."""
        ring, part = self.update.rings[row][0], self.lattice.in_plan(np.argwhere(mask)[:, ::-1])
        return spatial.ConvexHull(np.concatenate([ring, part])).volume - spatial.ConvexHull(ring).volume

    def _draw(self) -> None:
        """Draw all buildings that have changed or are new, those that lie together at once."""
        stays = [row for row in self.olds if self.update.status[row] != map_changes.GONE]
        is_fixed = (self.wanted == 0) & np.isin(self.old, stays)
        for kind, row in self.labels:
            if kind == OLD:
                window, mask = self.own[row]
                is_fixed[window] &= ~mask
        wanted = np.where(is_fixed, -1, self.wanted)
        for numbers, window, is_own in self._together(wanted):
            labels = [list(self.labels)[number - 1] for number in numbers]
            kind, row = labels[0]
            is_alone = kind == BUILT and not (is_own & (wanted[window] < 0)).any()
            if len(labels) > 1 or not is_alone or (self.old[self.new == row] >= 0).any():
                here = np.where(is_own | (wanted[window] <= 0), wanted[window], -1)
                drawn = self._drawn(window, here, labels, stays)
            else:
                drawn = {numbers[0]: [self.update.outlines[row]]}
            for number, label in zip(numbers, labels):
                self._keep(label, drawn.get(number, []))

    def _together(self, wanted: np.ndarray) -> Iterator[tuple[list[int], tuple, np.ndarray]]:
        """Yield labels that are drawn together, the window around their nodes and which are near these, bool."""
        area, count = ndimage.label(_within(wanted > 0, self.width / CHANGES.step))
        there = np.unique(np.stack([area, wanted])[:, wanted > 0], axis=1)
        n_groups, group = components(there[0], count + there[1], count + len(self.labels) + 1)
        for number in np.unique(group[count + 1 :]).tolist() if n_groups else []:
            near = (group == number)[area] & (area > 0)
            window = ndimage.find_objects(near.astype(np.uint8))[0]
            yield (np.flatnonzero(group[count + 1 :] == number) + 1).tolist(), window, near[window]

    def _drawn(self, window: tuple, wanted: np.ndarray, whose: list[Label], stays: list[int]) -> dict[int, list]:
        """Return the polygons of labels that lie together, along the walls of the map and of their new outlines."""
        lattice, update = self.lattice.part(window), self.update
        used = {row for kind, row in whose if kind == BUILT}
        used |= {one for one in self.news if any((OLD, row) in whose for row in update.covered[one])}
        changed = [row for kind, row in whose if kind == OLD]
        around = np.array([[-self.width], [self.width]]) + lattice.positions[[0, -1]]
        here = meeting_boxes(around[None], as_polygons([update.rings[row] for row in stays]).box)[1]
        fixed = np.setdiff1d(np.array(stays, int)[here], changed).tolist()
        old, kept = ([update.rings[row] for row in rows] for rows in (changed, fixed))
        return draw_labels(lattice, wanted, old, kept, [update.outlines[row] for row in sorted(used)], self.width)

    def _keep(self, label: Label, drawn: list) -> None:
        """Take the polygons that were drawn of a building; an old one without any stays as it was."""
        polygons = [rings for rings in drawn if polygon_area(rings) >= self.min_area]
        self.update.drawn[label] = polygons
        if label[0] == OLD:
            self.update.status[label[1]] = map_changes.CHANGED if polygons else map_changes.DOUBTFUL


def _within(mask: np.ndarray, reach: float) -> np.ndarray:
    """Return the nodes (rows, columns), bool, within a distance (nodes) of a mask."""
    return ndimage.distance_transform_edt(~mask) <= reach if mask.any() else mask


def _opened(mask: np.ndarray, radius: float) -> np.ndarray:
    """Return the parts of a mask that a disc of a radius (nodes) reaches within it."""
    return _within(ndimage.distance_transform_edt(mask) > radius, radius)


def draw_labels(
    lattice: Lattice, wanted: np.ndarray, old: list, fixed: list, new: list, width: float
) -> dict[int, list[list[np.ndarray]]]:
    """Return the polygons of each label from 1 on, as rings, m, the largest polygon first.

    Parameters
    ----------
    lattice : Lattice
        Nodes in and around these buildings.
    wanted : ndarray of shape (rows, columns), int64
        Label of the building that each node is to be of: 0 the ground, -1 what stays.
    old, fixed, new : list of list of ndarray
        Old buildings that are drawn, those that stay as they are, and new outlines, as rings, m.
    width : float
        Least width of a change, m. New walls nearer to the line of an old one go on along it.

    Returns
    -------
    dict of int to list of list of ndarray
        They overlap neither each other nor what stays, and where they keep an old wall they have its vertices. Labels
        that can't be drawn so are left out.
    """
    there, stays, built = (
        sides_of_rings([ring for rings in polygons for ring in rings]) for polygons in (old, fixed, new)
    )
    built = _along_old(built, np.concatenate([there, stays]), width)
    best: dict[int, list] = {}
    for snap in _RULES.old_snaps:
        drawn = _drawn(lattice, wanted, there, stays, built, (snap, _RULES.new_snap * width))
        sound = {one: own for one, own in drawn.items() if _is_sound(own, (wanted == one).sum(), lattice, fixed, width)}
        if len(sound) == len(drawn):
            return drawn
        best = max(best, sound, key=len)
    return best


def _is_sound(polygons: list, count: int, lattice: Lattice, fixed: list, width: float) -> bool:
    """Whether polygons are valid, about as large as that many nodes, and overlap nothing that stays."""
    edges = as_polygons(polygons)
    around = sum(perimeter(ring) for rings in polygons for ring in rings)
    # More than half the width of a change along the outline is a wall that was not cut.
    is_sized = abs(edges.area.sum() - count * lattice.step**2) <= 0.5 * width * around
    shared = overlaps(edges, as_polygons(fixed), Monitor())[2]
    return is_sized and bool((shared <= _RULES.overlap * around).all()) and all(map(is_valid, polygons))


def _drawn(
    lattice: Lattice, wanted: np.ndarray, old: np.ndarray, fixed: np.ndarray, new: np.ndarray, snaps: tuple
) -> dict[int, list[list[np.ndarray]]]:
    """Return the polygons of each label where cuts along old and new walls pass vertices closer than ``snaps`` (m)."""
    positions, walls = lattice.positions, np.concatenate([old, fixed])
    low, high = positions[0] - 0.3 * lattice.step, positions[-1] + 0.3 * lattice.step
    cells = Subdivision(low, high, positions)
    for sides, snap in zip((walls, new), snaps):
        for number in np.argsort(-np.hypot(*(sides[:, 1] - sides[:, 0]).T), kind="stable"):
            start, end = sides[number]
            cells.cut(start, end, snap)
    found: dict[int, list] = {}
    label = np.where(are_within(cells.centers(), fixed), 0, _labels(cells, wanted))
    # Vertices nearer than twice the snap to an old vertex or wall are of it: cutting moves them less.
    for polygon in cell_polygons(cells, label):
        found.setdefault(polygon.label, []).append([_on_old(ring, walls, 2 * snaps[0]) for ring in polygon.rings])
    return {number: sorted(own, key=polygon_area, reverse=True) for number, own in found.items()}


def _labels(cells: Subdivision, wanted: np.ndarray) -> np.ndarray:
    """Return the label (cells,) of most nodes in each cell, 0 for -1; of a seam that beyond most of its border."""
    pairs, sides = cells.edges()
    length = np.hypot(*np.diff(np.array(cells.vertices)[pairs], axis=1)[:, 0].T)
    around = np.bincount(sides.ravel(), np.repeat(length, 2), len(cells))
    is_seam = (cells.areas() < _RULES.thin * around) | np.array([len(nodes) == 0 for nodes in cells.members])
    label, flat = np.full(len(cells), -1), wanted.ravel() + 1
    for cell in np.flatnonzero(~is_seam):
        label[cell] = np.bincount(flat[cells.members[cell]]).argmax() - 1
    border = np.zeros((len(cells), label.max() + 2))
    for one, other in (sides.T, sides.T[::-1]):
        is_border = is_seam[one] & (label[other] >= 0)
        np.add.at(border, (one[is_border], label[other[is_border]]), length[is_border])
    return np.where(is_seam, border.argmax(axis=1), np.maximum(label, 0))


def _along_old(new: np.ndarray, old: np.ndarray, width: float) -> np.ndarray:
    """Return new walls (n, 2, 2), those near the line of an old wall and parallel to it moved onto that line."""
    start, way = old[:, 0], old[:, 1] - old[:, 0]
    length = np.hypot(*way.T)
    along = way / length[:, None]
    moved = new.copy()
    for number, side in enumerate(new):
        (x, y), own = (side[1] - side[0]) / np.hypot(*(side[1] - side[0])), side[:, None] - start
        reach = (own * along).sum(axis=2)
        across = own[..., 1] * along[:, 0] - own[..., 0] * along[:, 1]
        gap = np.maximum(reach.min(axis=0) - length, -reach.max(axis=0))
        off = np.abs(across).max(axis=0)
        is_near = (np.abs(along[:, 0] * y - along[:, 1] * x) < _RULES.parallel) & (off < width) & (gap < width)
        if is_near.any():
            best = np.where(is_near, off + np.maximum(gap, 0.0), np.inf).argmin()
            moved[number] = start[best] + reach[:, best, None] * along[best]
    return moved


def _on_old(ring: np.ndarray, old: np.ndarray, same: float) -> np.ndarray:
    """Return a closed ring with the vertices of old walls (m, 2, 2) within a distance (m), as exact as these are."""
    if not len(old):
        return ring
    corners = np.unique(old.reshape(-1, 2), axis=0)
    off, nearest = spatial.cKDTree(corners).query(ring, distance_upper_bound=same)
    ring = np.where(np.isfinite(off)[:, None], corners[np.minimum(nearest, len(corners) - 1)], ring)
    ring = _without_spikes(ring)
    corners, made = corners[~(corners[:, None] == ring).all(axis=2).any(axis=1)], []
    for start, end in zip(ring[:-1], ring[1:]):
        way, own = end - start, corners - start
        share = own @ way / (way @ way)
        across = np.abs(own[:, 0] * way[1] - own[:, 1] * way[0]) / np.hypot(*way)
        inner = np.flatnonzero((across < same) & (share > 0) & (share < 1))
        made += [start, *corners[inner[np.argsort(share[inner])]]]
    return _without_spikes(np.array([*made, ring[0]]))


def _without_spikes(ring: np.ndarray) -> np.ndarray:
    """Return a closed ring without vertices that repeat the one before, or from which it goes straight back."""
    corners = [tuple(corner) for corner in ring[:-1].tolist()]
    at = 0
    while at < len(corners) > 2:
        before, after = corners[at - 1], corners[(at + 1) % len(corners)]
        if corners[at] == before or before == after:
            del corners[at]
            at = max(at - 2, 0)
        else:
            at += 1
    return np.array([*corners, corners[0]])
