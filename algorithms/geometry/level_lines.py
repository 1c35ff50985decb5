"""Level lines of a field on a lattice: closed rings around where it is positive, by marching squares."""

import numpy as np

from .groups import cycles


def level_lines(field: np.ndarray) -> list[np.ndarray]:
    """Return the rings along which a field is zero, positive values to the left.

    Parameters
    ----------
    field : ndarray of shape (rows, columns)
        Values at the nodes of a lattice. Beyond its edge they count as negative.

    Returns
    -------
    list of ndarray of shape (m, 2)
        Closed rings in columns and rows of the lattice, by their southernmost, westernmost cells. Exteriors run
        counterclockwise and holes clockwise. They do not touch each other.

    References
    ----------
    Lorensen, W. E., Cline, H. E., 1987. Marching cubes: a high resolution 3D surface construction algorithm. Computer
    Graphics 21 (4), 163-169. [lorensen1987]
    """
    # Replace exact zeros, so that no line passes through a node.
    padded = np.pad(np.where(field == 0, -1e-12, field).astype(np.float64), 1, constant_values=-1.0)
    starts, ends = _segments(padded)
    if not len(starts):
        return []
    positions = _crossings(padded, starts) - 1.0
    order = np.argsort(starts)
    following = order[np.searchsorted(starts[order], ends)]
    return [positions[[*ring, ring[0]]] for ring in cycles(following)]


def _segments(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the lattice edges (n,) that the line enters and leaves cells by, positive values to its left.

    The lattice edge to the east of node i has the number 2 i, that to its north 2 i + 1.
    """
    columns = values.shape[1]
    is_in = np.stack([values[:-1, :-1], values[:-1, 1:], values[1:, 1:], values[1:, :-1]]) > 0
    is_mixed = is_in.any(axis=0) & ~is_in.all(axis=0)
    row, column = np.nonzero(is_mixed)
    node, inside = row * columns + column, is_in[:, row, column]
    sides = np.stack([2 * node, 2 * (node + 1) + 1, 2 * (node + columns), 2 * node + 1])
    # Going around a cell counterclockwise, the line leaves where positive values begin, and enters where they end.
    leaves = ~inside & np.roll(inside, -1, axis=0)
    enters = inside & ~np.roll(inside, -1, axis=0)
    middle = values[row, column] + values[row, column + 1] + values[row + 1, column] + values[row + 1, column + 1]
    is_saddle = leaves.sum(axis=0) == 2
    # In a saddle the values in the middle say which of the two pairs of corners is joined.
    is_joined = is_saddle & (middle > 0)
    starts, ends = [], []
    for side in range(4):
        for step in (1, 2, 3):
            leaving = (side + step) % 4
            pairs = enters[side] & leaves[leaving]
            # In a saddle the line goes around one corner: to the next side if the middle is joined, else to the last.
            chosen = pairs & (~is_saddle | (is_joined == (step == 1)))
            starts.append(sides[side][chosen])
            ends.append(sides[leaving][chosen])
    return np.concatenate(starts), np.concatenate(ends)


def _crossings(values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return column and row (n, 2) of the zero on lattice edges (n,)."""
    node, is_north = np.divmod(edges, 2)
    row, column = np.divmod(node, values.shape[1])
    at, beyond = values[row, column], values[row + is_north, column + (1 - is_north)]
    share = at / (at - beyond)
    return np.column_stack([column + share * (1 - is_north), row + share * is_north])
