"""Eaves that overhang the walls: how far, where walls were seen under them, and solids with the walls set back."""

import numpy as np

from ..criteria import MAJORITY
from ..geometry.rings import edge_distances, sides_of_rings, signed_area
from ..geometry.subdivision import SNAP
from ..sampling.density import DENSITY, link_distance
from .mending import connected
from .roof_partition import Partition, are_inside
from .solid_faces import build_solid
from .solid_faults import fault_of
from .solid_levels import ON_OUTLINE, Levels
from .solids import Solid

# Least and greatest overhang (m): level 2.3 is defined from 0.2 m on; wider ones are porches and lower roofs.
_LEAST, _MOST = 0.2, 1.2

# Step (m) between tried positions of a wall, and tolerance (m) of its points: noise and niches.
_STEP, _OFF = 0.05, 0.1

# Points at least this far (m) below the lowest edge of the roof over a side, and above the ground, may be on its wall:
# gutters are higher, plants at its foot lower.
_CLEAR = 0.5


# A side has a common wall with the next house if this share of its pieces has points of buildings outside, farther from
# it than this (m). Nearer ones are the edge of its own roof.
_PARTY, _BESIDE = 0.25, 0.3

# Vertices nearer to a side than this (m), in plan, are on it.
_ON_SIDE = 0.02

# Walls that turn by less than this sine (10°) have a step between them, and no corner where their lines intersect.
_PARALLEL = 0.17

# Cuts snap to vertices within these distances (m): first as for footprints; after a fault, as for roofs.
_SNAPS = ON_OUTLINE, SNAP


def wall_rings(xyz: np.ndarray, rings: list, solids: list[Solid], base: float, spacing: float) -> list[np.ndarray]:
    """Return the rings of the walls under a roof, set back where they were seen; none where no side overhangs.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points of buildings over the roof and around it (m).
    rings : list of ndarray
        Closed rings of the roof (m).
    solids : list of Solid
        The building with walls below the edges of its roof.
    base, spacing : float
        Height of the ground, and mean distance of the roof's points (m).

    Notes
    -----
    Sides whose wall was not seen, and sides that have a neighbor, have their walls below the edge of the roof.
    """
    corners = np.concatenate([solid.vertices for solid in solids])
    corners, high = (xyz[xyz[:, 2] > base + _CLEAR] for xyz in (corners, xyz))
    overhangs, walls = [0.0], []
    step = link_distance(spacing)
    for number, ring in enumerate(rings):
        is_left = (signed_area(ring) > 0) == (number == 0)
        turned = ring if is_left else ring[::-1]
        own = [_overhang(high, side, corners, step) for side in sides_of_rings([turned])]
        overhangs += own
        walls.append(_set_back(turned, np.array(own)))
    return walls if max(overhangs) and all(map(len, walls)) else []


def _overhang(xyz: np.ndarray, side: np.ndarray, corners: np.ndarray, step: float) -> float:
    """Measure how far (m) a roof overhangs the wall under a side (2, 2), 0 where no wall was seen.

    The building is to the left of the side. The wall is looked for in points above the ground, by pieces of a length
    ``step`` (m); ``corners`` are the solid's.
    """
    start, way = side[0], side[1] - side[0]
    length = float(np.hypot(*way))
    eave = corners[edge_distances(corners[:, :2], side[:1], side[1:])[:, 0] < _ON_SIDE, 2]
    along, across = np.array([way, [-way[1], way[0]]]) @ (xyz[:, :2] - start).T / length
    is_near = (along > 0) & (along < length) & (np.abs(across) <= _MOST + _OFF)
    piece, across, z = (along[is_near] / step).astype(int), across[is_near], xyz[is_near, 2]
    n_pieces = int(length / step) + 1
    is_party = len(np.unique(piece[across < -_BESIDE])) >= _PARTY * n_pieces
    if length < 2 * DENSITY.least_link or not len(eave) or is_party:
        return 0.0
    is_under = (across >= -_OFF) & (z < eave.min() - _CLEAR)
    piece, across = piece[is_under], across[is_under]
    on_walls = np.abs(across - np.arange(0.0, _MOST + _STEP / 2, _STEP)[:, None]) <= _OFF
    on_wall = on_walls[np.argmax(on_walls.sum(axis=1))]
    # Floors and lower roofs lie at all distances: half of all points under the eave are on its wall, too.
    if not on_wall.any() or min(on_wall.mean(), len(np.unique(piece[on_wall])) / n_pieces) < MAJORITY:
        return 0.0
    overhang = float(np.median(across[on_wall]))
    return overhang if overhang >= _LEAST else 0.0


def _set_back(ring: np.ndarray, overhang: np.ndarray) -> np.ndarray:
    """Return a closed ring (k, 2) with each side moved to its left (m); sides that would turn around are left out."""
    way = np.diff(ring, axis=0)
    way = way / np.hypot(*way.T)[:, None]
    by = overhang[:, None] * np.column_stack([-way[:, 1], way[:, 0]])
    sides, kept = np.stack([ring[:-1] + by, ring[1:] + by], axis=1), np.arange(len(way))
    while len(kept) > 2:
        # Each side ends where the next one begins, or a step leads there.
        ends = np.array([_corner(sides[one], sides[two]) for one, two in zip(kept, np.roll(kept, -1))])
        moved = np.stack([np.roll(ends[:, 1], 1, axis=0), ends[:, 0]], axis=1)
        length = ((moved[:, 1] - moved[:, 0]) * way[kept]).sum(axis=1)
        if length.min() > 0:
            corners = moved.reshape(-1, 2)
            corners = corners[(corners != np.roll(corners, 1, axis=0)).any(axis=1)]
            return np.concatenate([corners, corners[:1]])
        kept = np.delete(kept, np.argmin(length))
    return np.zeros((0, 2))


def _corner(one: np.ndarray, two: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the end of a side (2, 2) and the start of the next one: their intersection, unless they are parallel."""
    (x, y), (u, v), (across, up) = one[1] - one[0], two[1] - two[0], two[0] - one[0]
    turn = x * v - y * u
    if abs(turn) < _PARALLEL * np.hypot(x, y) * np.hypot(u, v):
        return one[1], two[0]
    corner = one[0] + (across * v - up * u) / turn * (one[1] - one[0])
    return corner, corner


def overhanging(partition: Partition, base: float, walls: list[np.ndarray]) -> tuple[list[Solid], str]:
    """Return the solids of a roof over walls with these rings (m), or none and why.

    ``partition`` has a valid solid over its whole outline, on a level ground at the height ``base`` (m).
    """
    for snap in _SNAPS:
        solids, why = _overhanging(partition, base, walls, snap)
        if not why:
            break
    return solids, why


def _overhanging(partition: Partition, base: float, walls: list[np.ndarray], snap: float) -> tuple[list[Solid], str]:
    cells, label = partition.cells.copy(), partition.label
    for start, end in sides_of_rings(walls):
        label = np.append(label, label[cells.cut(start, end, snap)])
    is_eave = ~are_inside(cells, walls)
    solids = []
    for part in connected(Partition(cells, label, partition.coefficients, partition.cost)):
        levels = Levels(part.cells, part.label, part.coefficients, base)
        if levels.crowded():
            return [], "more than two walls would meet in an edge"
        solid, _ = build_solid(levels, is_eave)
        fault = fault_of(solid)
        if fault:
            return [], fault
        solids.append(solid)
    return solids, ""
