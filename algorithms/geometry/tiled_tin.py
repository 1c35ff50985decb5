"""The elevation of a triangulated surface at many positions, made tile by tile: any number of nodes in little memory.

A triangle belongs to the Delaunay triangulation of all nodes when none of them lies inside its circle, whichever nodes
it was found among. So only the nodes close to the points of a tile are triangulated, and every triangle under a point
is tested by that rule: the surface is one triangulation's, without seams.

The far corners that surround the nodes of a tile take no part: where one of them spoils the flat triangles along the
hull of the nodes, these are triangulated again without it.
"""

from collections.abc import Iterator
from typing import Optional

import numpy as np

from ..criteria import ROUNDING
from ..packages import spatial
from ..stage import Monitor
from ..threads import ROWS_AT_ONCE, in_chunks, n_threads
from .delaunay import TILE_POSITIONS, TILES_AT_ONCE, circles
from .grid import grid_over, plan_box
from .tin import CORNERS, Tin


class TiledTin:
    """The surface of :class:`Tin`, for positions that are all known beforehand.

    Parameters
    ----------
    nodes : ndarray of shape (m, 3), float64
        Nodes (m), m >= 1; of nodes at one position in plan, the lowest counts.
    """

    def __init__(self, nodes: np.ndarray) -> None:
        # Sorted, so that the order of the input has no influence.
        self.nodes = nodes = _lowest_of_each_position(nodes)
        self._box = plan_box(nodes)
        # Squares of coordinates near zero lose fewer digits. Triangulations of tiles have the same box and shift.
        self._shift = self._box.mean(axis=0)
        self._tree = spatial.cKDTree(nodes[:, :2] - self._shift, balanced_tree=False)

    def elevation(self, positions: np.ndarray, monitor: Optional[Monitor] = None) -> np.ndarray:
        """Return the elevation (n,) of the surface at positions (n, 2 or 3), NaN outside the hull of the nodes (m)."""
        monitor = monitor or Monitor()
        found = np.full(len(positions), np.nan)
        tiles = list(_tiles(self.nodes, positions))
        gaps: list[tuple[np.ndarray, np.ndarray]] = [(np.zeros(0, np.int64), np.zeros(0, np.int64))] * len(tiles)

        def fill(some: np.ndarray) -> None:
            for tile in some:
                rows, left = tiles[tile]
                close = _close(self.nodes, rows, positions[left])
                gaps[tile] = self._fill(close, left, positions, found, is_start=True)

        in_chunks(fill, np.arange(len(tiles)), TILES_AT_ONCE, monitor.part(0, 0.7))
        # The few positions that are left, in gaps of the ground, need the nodes around the gaps only.
        if tiles:
            around, within = (np.unique(np.concatenate(parts)) for parts in zip(*gaps))
            self._fill_gaps(around, within, positions, found, monitor.part(0.7, 1))
        self._fill_edge(np.flatnonzero(np.isnan(found)), positions, found)
        monitor.progress(1.0)
        return found

    def nearest_elevation(self, positions: np.ndarray) -> np.ndarray:
        """Return the elevation (n,) of the node nearest in plan to each position (n, 2 or 3), m."""
        return self.nodes[self._tree.query(positions[:, :2] - self._shift, workers=n_threads())[1], 2]

    def _fill_gaps(
        self, around: np.ndarray, within: np.ndarray, positions: np.ndarray, found: np.ndarray, monitor: Monitor
    ) -> None:
        """Write the elevations at positions ``within`` gaps to ``found``, starting from the nodes ``around`` these."""
        tiles = list(_tiles(self.nodes[around], positions[within]))

        def fill(some: np.ndarray) -> None:
            for tile in some:
                rows, left = around[tiles[tile][0]], within[tiles[tile][1]]
                while len(left):
                    more, left = self._fill(rows, left, positions, found, is_start=False)
                    rows = np.union1d(rows, more)

        in_chunks(fill, np.arange(len(tiles)), 1, monitor)

    def _fill(
        self, rows: np.ndarray, left: np.ndarray, positions: np.ndarray, found: np.ndarray, is_start: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """Write the elevations at positions among ``left`` whose triangles between the nodes ``rows`` are right.

        Returns the nodes that the other positions need, with those around them if it ``is_start``, and these positions.
        """
        if not len(rows):
            rows = self._nearest(positions[left])
        tin = Tin(self.nodes[rows], self._box)
        facet = tin.locate(positions[left])
        facets, of = np.unique(facet, return_inverse=True)
        intruders, is_wrong = self._intruders(*tin.circles(facets), rows)
        wrong = is_wrong[of]
        right = left[~wrong]
        elevation = tin.elevation(positions[right], facet[~wrong])
        found[right] = np.where(tin.is_extrapolated()[facet[~wrong]], np.nan, elevation)
        left = left[wrong]
        if is_start and len(left):
            ends = np.unique(tin.facets[facets[is_wrong]])
            nearest = self._nearest(positions[left])
            intruders = np.concatenate([rows[ends[ends >= CORNERS] - CORNERS], intruders, nearest])
        return intruders, left

    def _fill_edge(self, left: np.ndarray, positions: np.ndarray, found: np.ndarray) -> None:
        """Write the elevations at positions among ``left`` that lie in the hull of all nodes to ``found``.

        The far corners of a :class:`Tin` take away the flat triangles along its hull: these have such large circles
        that a corner lies inside.
        """
        plan = self.nodes[:, :2] - self._shift
        if not len(left) or not _has_area(plan):
            return
        rows = spatial.ConvexHull(plan).vertices
        while len(left):
            mesh = spatial.Delaunay(plan[rows])
            facet = mesh.find_simplex(positions[left, :2] - self._shift)
            left, facet = left[facet >= 0], facet[facet >= 0]
            facets, of = np.unique(facet, return_inverse=True)
            intruders, is_wrong = self._intruders(*circles(mesh.points, mesh.simplices[facets]), rows)
            right, facet, left = left[~is_wrong[of]], facet[~is_wrong[of]], left[is_wrong[of]]
            # Shares of the first two corners of a triangle in each position; the third has the rest.
            offset = positions[right, :2] - self._shift - mesh.transform[facet, 2]
            share = np.einsum("nij,nj->ni", mesh.transform[facet, :2], offset)
            corners = self.nodes[rows, 2][mesh.simplices[facet]]
            found[right] = corners[:, 2] + (share * (corners[:, :2] - corners[:, 2:])).sum(axis=1)
            rows = np.unique(np.concatenate([rows, intruders, self._nearest(positions[left])]))

    def _intruders(self, center: np.ndarray, radius: np.ndarray, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the rows of nodes inside circles that ``rows`` lack, and which circles have such.

        Circles have a ``center`` (c, 2), from the shift, and a ``radius`` (c,), m, both NaN for nodes on a line.
        """
        limit = radius * (1 - ROUNDING)
        # Nodes on a line have no circle, and no position lies between them.
        center[~np.isfinite(radius)], limit[~np.isfinite(radius)] = 0.0, 0.0
        is_wrong = self._tree.query(center)[0] < limit
        # Up to eight nodes inside a circle are added at once.
        distance, node = self._tree.query(center[is_wrong], np.arange(1, min(8, len(self.nodes)) + 1))
        is_new = (distance < limit[is_wrong, None]) & ~np.isin(node, rows)
        # Circles in which all nodes found were triangulated already are wrong by rounding only.
        is_wrong[is_wrong] = is_new.any(axis=1)
        return node[is_new], is_wrong

    def _nearest(self, positions: np.ndarray) -> np.ndarray:
        """Return the rows of the nodes that are nearest to positions, each once."""
        return np.unique(self._tree.query(positions[:, :2] - self._shift)[1])


def _has_area(plan: np.ndarray) -> bool:
    """Return whether nodes in plan (m, 2) span an area: they are not collinear."""
    extents = np.linalg.svd(plan - plan.mean(axis=0), compute_uv=False)
    return len(plan) > 2 and bool(extents[1] > ROUNDING * extents[0])


def _tiles(nodes: np.ndarray, positions: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Halve the plane until each part has few nodes and positions; yield the rows of both where there are positions.

    Nodes close to a part are in it too.
    """
    waiting = [(np.arange(len(nodes), dtype=np.int32), np.arange(len(positions), dtype=np.int32))]
    while waiting:
        rows, own = waiting.pop()
        if not len(own):
            continue
        low, high = plan_box(nodes[rows] if len(rows) > TILE_POSITIONS else positions[own])
        axis = int(np.argmax(high - low))
        middle = (low[axis] + high[axis]) / 2
        if (len(rows) <= TILE_POSITIONS and len(own) <= ROWS_AT_ONCE) or not low[axis] < middle:
            yield rows, own
            continue
        margin = 2 * _cell_size(nodes, rows)
        along, is_lower = nodes[rows, axis], positions[own, axis] < middle
        waiting += [(rows[along < middle + margin], own[is_lower]), (rows[along >= middle - margin], own[~is_lower])]


def _cell_size(nodes: np.ndarray, rows: np.ndarray) -> float:
    """Return the side (m) of cells that hold a few of some nodes, 0 where they have no area."""
    if not len(rows):
        return 0.0
    low, high = plan_box(nodes[rows])
    # Most triangles have their corners in a cell of one and a half distances between nodes, or the next.
    return 1.5 * float(np.sqrt((high - low).prod() / len(rows)))


def _close(nodes: np.ndarray, rows: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return the ``rows`` of nodes that lie in a cell with positions, or next to such a cell."""
    size = _cell_size(nodes, rows)
    if not size:
        return rows
    grid = grid_over(positions, size)
    cells = np.unique(grid.number(positions))
    # Nodes outside the grid may get the number of a distant cell, which does no harm.
    return rows[np.isin(grid.number(nodes[rows]), cells[:, None] + [0, *grid.around])]


def _lowest_of_each_position(nodes: np.ndarray) -> np.ndarray:
    """Return nodes in the order of their coordinates, only the lowest at each position in plan."""
    x, y, z = nodes.T
    order = np.lexsort((z, y, x))
    is_new = np.ones(len(nodes), bool)
    is_new[1:] = (np.diff(x[order]) != 0) | (np.diff(y[order]) != 0)
    return nodes[order[is_new]]
