"""Delaunay triangulations of many points in plan: made tile by tile on all cores, and mended where points are added.

A triangle belongs to the triangulation of all points when none of them lies inside its circle, whichever points it was
found among. So tiles are triangulated one by one, with their surroundings, and of each the triangles are kept
whose circles lie within what it saw. Holes remain, few and mostly where no positions are; the positions
around them make up one more, small triangulation, of which the triangles in the holes are taken. What new positions
spoil, the triangles with one of them in their circles, are such holes too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..criteria import ROUNDING
from ..packages import spatial
from ..stage import Monitor
from ..threads import in_chunks
from .grid import find_cells, plan_box
from .groups import components, mask_of

# Most positions of a tile: twice as fast per position as a hundred thousand at once. In smaller tiles, their overlap
# takes more.
TILE_POSITIONS = 3000

# Tiles that a thread triangulates between two reports of progress. Where there are no more, one triangulation takes
# less time.
TILES_AT_ONCE = 4

# Surroundings of a tile, in distances between positions: nearly all circles on its border end there.
_MARGIN = 3.0


@dataclass(frozen=True)
class Triangulation:
    """Triangles between positions in plan."""

    plan: np.ndarray  #: (n, 2), float64: positions (m)
    #: (f, 3), int32: the corners of each triangle, as numbers of nodes, counterclockwise. Of nodes at one position, one
    #: is used.
    facets: np.ndarray
    neighbors: np.ndarray  #: (f, 3), int32: the triangle across from each corner, -1 if unassigned

    def with_positions(self, plan: np.ndarray, facet: np.ndarray) -> tuple[Triangulation, np.ndarray]:
        """Return the triangulation with more positions (m, 2), and the new number of each facet (f,), -1 if it is gone.

        ``facet`` (m,) are the facets that the new positions lie in.
        """
        stays = ~self._spoilt(plan, facet) & (self.neighbors >= 0).all(axis=1)
        rows = np.append(np.unique(self.facets[~stays]), len(self.plan) + np.arange(len(plan)))
        whole = np.concatenate([self.plan, plan])
        part, became = _chosen(whole, self.facets, self.neighbors, stays)
        mended = _mended(part, rows)
        return (_by_qhull(whole), np.full_like(became, -1)) if mended is None else (mended, became)

    def _spoilt(self, plan: np.ndarray, facet: np.ndarray) -> np.ndarray:
        """Return the facets (f,) that have one of the new positions in their circles, found from one to the next."""
        spoilt = np.zeros(len(self.facets), bool)
        pairs, before = np.arange(len(plan)) * len(spoilt) + facet, np.empty(0, np.int64)
        while len(pairs):
            position, facet = np.divmod(pairs, len(spoilt))
            center, radius = circles(self.plan, self.facets[facet])
            distance = np.linalg.norm(plan[position] - center, axis=1)
            # If a facet has no circle, as its corners are collinear, a new position in it lies on its edge.
            inside = ~(distance > radius * (1 + ROUNDING))
            spoilt[facet[inside]] = True
            around = self.neighbors[facet[inside]].ravel()
            beside = (np.repeat(position[inside], 3) * len(spoilt) + around)[around >= 0]
            # What lies next to the facets of a step was found in that step, in the one before, or is new.
            pairs, before = np.setdiff1d(beside, np.concatenate([pairs, before])), pairs
        return spoilt


def triangulate(plan: np.ndarray, monitor: Optional[Monitor] = None) -> Triangulation:
    """Return the Delaunay triangulation of positions (n, 2), m, that are not all on one line."""
    mended = _by_tiles(plan, monitor or Monitor()) if len(plan) > TILES_AT_ONCE * TILE_POSITIONS else None
    return _by_qhull(plan) if mended is None else mended


def _by_tiles(plan: np.ndarray, monitor: Monitor) -> Optional[Triangulation]:
    """Return the triangulation of positions made of the tiles' triangulations, None if these don't fit together."""
    different = np.unique(np.ascontiguousarray(plan, float).view(complex), return_index=True)[1]
    tiles = list(_tiles(plan, different))
    parts: list[Triangulation] = [None] * len(tiles)  # type: ignore[list-item]

    def fill(some: np.ndarray) -> None:
        for tile in some:
            parts[tile] = _part(plan, *tiles[tile])

    in_chunks(fill, np.arange(len(tiles)), TILES_AT_ONCE, monitor)
    part = _joined(parts)
    is_done = np.zeros(len(plan), bool)
    is_done[part.facets] = True
    is_done[_open_sides(part)[2]] = False
    return _mended(part, different[~is_done[different]])


def circles(plan: np.ndarray, facets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return center (f, 2) and radius (f,) of the circles through the corners of facets, NaN if these are in line."""
    a, b, c = np.swapaxes(plan[facets], 0, 1)
    u, v = b - a, c - a
    uu, vv = np.einsum("ij,ij->i", u, u), np.einsum("ij,ij->i", v, v)
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    scale = np.divide(0.5, area, out=np.full(len(area), np.nan), where=area != 0)
    to_center = np.column_stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu]) * scale[:, None]
    return a + to_center, np.linalg.norm(to_center, axis=1)


def _by_qhull(plan: np.ndarray) -> Triangulation:
    """Return the triangulation of all positions (n, 2) at once."""
    found = spatial.Delaunay(plan)
    return Triangulation(plan, found.simplices, found.neighbors)


def _tiles(plan: np.ndarray, rows: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Halve the plane until each part has few positions; yield the rows of these and those around, and both boxes."""
    everywhere = np.array([[-np.inf, -np.inf], [np.inf, np.inf]])
    waiting = [(rows.astype(np.int32), plan[rows], everywhere, everywhere)]
    while waiting:
        rows, near, box, seen = waiting.pop()
        own = near[_within(near, box)]
        low, high = plan_box(own) if len(own) else np.zeros((2, 2))
        axis = int(np.argmax(high - low))
        # Off the middle, where no lines of regular grids are: circles with the same center have one owner.
        middle = 0.5137 * low[axis] + 0.4863 * high[axis]
        if len(own) <= TILE_POSITIONS or not low[axis] < middle < high[axis]:
            yield rows, box, seen
            continue
        margin = _MARGIN * np.sqrt((high - low).prod() / len(own))
        for upper, chosen in enumerate((near[:, axis] < middle + margin, near[:, axis] >= middle - margin)):
            half, wider = box.copy(), seen.copy()
            half[1 - upper, axis] = middle
            wider[1 - upper, axis] = middle - margin if upper else middle + margin
            waiting.append((rows[chosen], near[chosen], half, wider))


def _within(plan: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Return the mask of positions that lie in a box, its upper sides not in it."""
    (left, bottom), (right, top) = box
    x, y = plan.T
    return (x >= left) & (x < right) & (y >= bottom) & (y < top)


def _part(plan: np.ndarray, rows: np.ndarray, box: np.ndarray, seen: np.ndarray) -> Triangulation:
    """Return those triangles between ``rows`` of the positions that have their circles' centers in ``box``.

    Left out are those whose circles aren't all within what was ``seen``.
    """
    # Near the origin squares keep their digits.
    near = plan[rows] - plan[rows[0]]
    if np.linalg.matrix_rank(near) < 2:
        no_facets = np.empty((0, 3), np.int32)
        return Triangulation(plan, no_facets, no_facets)
    found = _by_qhull(near)
    facets = rows[found.facets]
    center, radius = circles(plan, facets)
    x, y = center.T
    (left, bottom), (right, top) = seen
    is_known = (x - radius > left) & (x + radius < right) & (y - radius > bottom) & (y + radius < top)
    # Triangles at the hull of these positions have an edge without neighbor, which fits no other tile.
    is_known &= (found.neighbors >= 0).all(axis=1)
    return _chosen(plan, facets, found.neighbors, is_known & _within(center, box))[0]


def _chosen(
    plan: np.ndarray, facets: np.ndarray, neighbors: np.ndarray, stays: np.ndarray
) -> tuple[Triangulation, np.ndarray]:
    """Return some of the facets, and the new number of each of all, -1 if it is gone."""
    became = np.where(stays, np.cumsum(stays, dtype=np.int32) - np.int32(1), np.int32(-1))
    beside = neighbors[stays]
    return Triangulation(plan, facets[stays], np.where(beside >= 0, became[beside], np.int32(-1))), became


def _joined(parts: list[Triangulation]) -> Triangulation:
    """Return triangulations of the same positions as one, neighbors where they have the same side."""
    facets = np.concatenate([part.facets for part in parts])
    first = np.cumsum([0] + [len(part.facets) for part in parts[:-1]], dtype=np.int32)
    neighbors = np.concatenate([part.neighbors + (part.neighbors >= 0) * start for part, start in zip(parts, first)])
    whole = Triangulation(parts[0].plan, facets, neighbors)
    facet, corner, ends = _open_sides(whole)
    # A side and the same side of the other facet run in opposite directions.
    key, opposite_key = ends @ [len(whole.plan), 1], ends @ [1, len(whole.plan)]
    order = np.argsort(key)
    mate, found = find_cells(key[order], opposite_key)
    neighbors[facet[found], corner[found]] = facet[order[mate[found]]]
    return whole


def _open_sides(mesh: Triangulation) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return facet, corner across, and both ends (m, 2), counterclockwise, of the sides that have no neighbor."""
    facet, corner = np.nonzero(mesh.neighbors < 0)
    return facet, corner, mesh.facets[facet[:, None], (corner[:, None] + [1, 2]) % 3].astype(np.int64)


def _mended(part: Triangulation, rows: np.ndarray) -> Optional[Triangulation]:
    """Return a triangulation whose holes, between the positions ``rows``, are filled; None if a seam stays open."""
    patch = _by_qhull(part.plan[rows] - part.plan[rows[0]])
    facets = rows[patch.facets].astype(np.int32)
    sides = _open_sides(Triangulation(part.plan, facets, np.full_like(facets, -1)))[2]
    border = _open_sides(part)[2] @ [len(part.plan), 1]
    outside = np.isin(sides @ [len(part.plan), 1], border).reshape(-1, 3)
    inside = np.isin(sides @ [1, len(part.plan)], border).reshape(-1, 3)
    # Facets of the patch that no border separates lie in the same hole, or in none.
    neighbors = np.where(outside | inside, -1, patch.neighbors)
    links = neighbors >= 0
    which = components(np.nonzero(links)[0], neighbors[links], len(facets))[1]
    fills = ~np.isin(which, which[outside.any(axis=1)])
    whole = _joined([part, _chosen(part.plan, facets, neighbors, fills)[0]])
    return whole if inside.sum() == len(border) and _is_whole(whole) else None


def _is_whole(mesh: Triangulation) -> bool:
    """Check by Euler's formula whether facets neither leave holes nor lie on one another."""
    used = mask_of(len(mesh.plan), mesh.facets)
    return len(mesh.facets) == 2 * int(used.sum()) - 2 - int((mesh.neighbors < 0).sum())
