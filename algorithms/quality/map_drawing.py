"""Redraw changed buildings of a map, along old walls as far as these are right."""

import numpy as np

from ..footprints.soft_shares import Lattice
from ..geometry.cell_polygons import cell_polygons
from ..geometry.polygon_overlap import are_within, as_polygons, overlaps
from ..geometry.rings import is_valid, perimeter, polygon_area, sides_of_rings
from ..geometry.subdivision import Subdivision
from ..packages import spatial
from ..rules import rule, rules
from ..stage import Monitor


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
    """Return whether polygons are valid, about as large as that many nodes, and overlap nothing that stays."""
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
    label = np.where(are_within(cells.centers(), fixed), 0, _labels(cells, lattice, wanted))
    # Vertices nearer than twice the snap to an old vertex or wall are of it: cutting moves them less.
    for polygon in cell_polygons(cells, label):
        found.setdefault(polygon.label, []).append([_on_old(ring, walls, 2 * snaps[0]) for ring in polygon.rings])
    return {number: sorted(own, key=polygon_area, reverse=True) for number, own in found.items()}


def _labels(cells: Subdivision, lattice: Lattice, wanted: np.ndarray) -> np.ndarray:
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
