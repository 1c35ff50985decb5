"""Divide the overlap of two polygons between them."""

import numpy as np

from ..criteria import MICROMETER
from .arrangement import Arrangement, sides_of
from .groups import components
from .rings import are_inside, sides_of_rings

# A polygon: its closed rings (k, 2), m, holes clockwise; of several parts, the exteriors of all.
Rings = list[np.ndarray]


def divide_overlap(one: Rings, other: Rings, of_one: np.ndarray, of_other: np.ndarray) -> tuple[Rings, Rings]:
    """Return two polygons without what they share: each piece of it stays in the polygon with more points there.

    Parameters
    ----------
    one, other : list of ndarray of shape (k, 2)
        Closed rings, m.
    of_one, of_other : ndarray of shape (n, 2), (m, 2)
        Points (m) that the polygons were drawn around.

    Returns
    -------
    one, other : list of ndarray of shape (k, 2)
        The lists given if nothing is lost; otherwise the rings of the remainder, perhaps in several parts or none.
        Pieces in which both have as many points stay in the first.
    """
    # Near the origin, where rounding is small.
    origin = one[0][0]
    near = [ring - origin for ring in one], [ring - origin for ring in other]
    start, end = np.moveaxis(sides_of_rings([*near[0], *near[1]]), 1, 0)
    way = (end - start) / np.hypot(*(end - start).T)[:, None]
    # The rectangle is larger, so that its sides bound no cell of the polygons.
    low, high = start.min(axis=0), start.max(axis=0)
    cells = Arrangement(start, way, low - (high - low), high + (high - low))
    middles = _middles(cells)
    in_one, in_other = (_are_within(middles, rings) for rings in near)
    is_shared = in_one & in_other
    left, right = cells.edges.left, cells.edges.right
    inner = is_shared[left] & is_shared[right]
    count, piece = components(left[inner], right[inner], cells.count)
    piece_of_shared = np.where(is_shared, piece, -1)
    n_one, n_other = (_counted(cells, piece_of_shared, count, points - origin) for points in (of_one, of_other))
    is_ones = (n_one >= n_other)[piece]
    lost = is_shared & ~is_ones, is_shared & is_ones
    left_of_one, left_of_other = (
        [ring + origin for ring in _rings(cells, inside & ~away)] if away.any() else rings
        for rings, inside, away in zip((one, other), (in_one, in_other), lost)
    )
    return left_of_one, left_of_other


def _middles(cells: Arrangement) -> np.ndarray:
    """Return the mean of the corners (cells, 2), m, of each cell; it lies inside, as cells are convex."""
    edges = cells.edges
    cell = np.concatenate([edges.left, edges.left, edges.right, edges.right])
    corner = cells.positions[np.concatenate([edges.start, edges.end, edges.start, edges.end])]
    count = np.maximum(np.bincount(cell, minlength=cells.count), 1)
    return np.column_stack([np.bincount(cell, along, cells.count) / count for along in corner.T])


def _are_within(points: np.ndarray, rings: Rings) -> np.ndarray:
    """Return the mask of points (n, 2) that lie in a polygon."""
    return np.sum([are_inside(points, ring) for ring in rings], axis=0) % 2 == 1


def _counted(cells: Arrangement, piece: np.ndarray, count: int, points: np.ndarray) -> np.ndarray:
    """Count the points in each piece (count,); ``piece`` (cells,) is the piece of each cell, -1 where it has none."""
    cell = cells.cells_at(sides_of(points, cells.points, cells.directions))
    of_piece = piece[cell[cell >= 0]]
    return np.bincount(of_piece[of_piece >= 0], minlength=count)


def _rings(cells: Arrangement, inside: np.ndarray) -> Rings:
    """Return the rings around cells (cells,), bool, without edges that are short as lines are moved."""
    rings = []
    for ring in cells.outline(inside):
        corners = cells.positions[[corner for _, corner in ring]]
        corners = corners[np.hypot(*(corners - np.roll(corners, 1, axis=0)).T) > MICROMETER]
        if len(corners) >= 3:
            rings.append(np.concatenate([corners, corners[:1]]))
    return rings
