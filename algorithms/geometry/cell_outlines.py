"""Groups of cells as polygons."""

import numpy as np

from .grid import Grid, find_cells
from .groups import cycles
from .rings import signed_area

# Directions of a cell's sides, counterclockwise around it: the south side runs east, the east side north, …
_EAST, _NORTH, _WEST, _SOUTH = range(4)


def outline_cells(grid: Grid, cells: np.ndarray, group: np.ndarray) -> list:
    """Return the polygon of each group of cells.

    Parameters
    ----------
    grid : Grid
        The grid that the numbers belong to.
    cells : ndarray of shape (m,), int64
        Cell numbers, ascending and each once.
    group : ndarray of shape (m,), int
        Group of each cell from 0: cells that touch by a side or a corner have the same (:func:`.connected_cells`).

    Returns
    -------
    list
        For each group a list of closed rings (k, 2), m: the exterior counterclockwise, then the holes clockwise, all
        of them valid and without vertices along straight sides. Cells that touch by a corner only are joined by a
        neck as wide as a seventh of a cell.
    """
    start, direction, owner = _sides(grid, cells, group)
    following = _following(grid, start, direction)
    _, corner, sides_there = np.unique(start, return_inverse=True, return_counts=True)
    is_crowded = sides_there[corner] > 1
    polygons: list = [[] for _ in range(int(group.max(initial=-1)) + 1)]
    for sides in cycles(following):
        polygons[owner[sides[0]]].append(_ring(grid, start[sides], direction[sides], is_crowded[sides]))
    return [sorted(rings, key=signed_area, reverse=True) for rings in polygons]


def _sides(grid: Grid, cells: np.ndarray, group: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return start, direction and group of the sides that have no cell beyond them.

    A start is the number of the cell whose south-west corner it is.
    """
    beyond = {_EAST: -grid.columns, _NORTH: 1, _WEST: grid.columns, _SOUTH: -1}
    begins = {_EAST: 0, _NORTH: 1, _WEST: grid.columns + 1, _SOUTH: grid.columns}
    start, direction, owner = [], [], []
    for side, step in beyond.items():
        is_open = ~find_cells(cells, cells + step)[1]
        start.append(cells[is_open] + begins[side])
        direction.append(np.full(int(is_open.sum()), side))
        owner.append(group[is_open])
    return np.concatenate(start), np.concatenate(direction), np.concatenate(owner)


def _following(grid: Grid, start: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Return the side that follows each on its ring, of those that begin where it ends."""
    end = start + np.array([1, grid.columns, -1, -grid.columns])[direction]
    order = np.argsort(4 * start + direction)
    keys = (4 * start + direction)[order]
    following = np.full(len(start), -1)
    for turn in (1, 0, -1):
        position, found = find_cells(keys, 4 * end + (direction + turn) % 4)
        # Turns to the right are set last and so win: where four sides meet, the ring continues to the cell across the
        # corner.
        following[found] = order[position[found]]
    return following


def _ring(grid: Grid, start: np.ndarray, direction: np.ndarray, is_crowded: np.ndarray) -> np.ndarray:
    """Return the closed ring along sides: its turns only, those at a crowded corner cut off."""
    turned = np.flatnonzero(direction != np.roll(direction, 1))
    row, column = np.divmod(start[turned], grid.columns)
    corner = np.column_stack([column, row]) - 1.0
    forward = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]], float)
    before, after = forward[direction[turned - 1]], forward[direction[turned]]
    # Where cells touch in a corner only, a tenth of each side is cut off, so that rings don't touch.
    neck = 0.1 * is_crowded[turned, None]
    vertices = np.stack([corner - neck * before, corner + neck * after], axis=1).reshape(-1, 2)
    vertices = vertices[np.column_stack([np.ones(len(turned), bool), is_crowded[turned]]).ravel()]
    return np.concatenate([vertices, vertices[:1]]) * grid.size + grid.corner
