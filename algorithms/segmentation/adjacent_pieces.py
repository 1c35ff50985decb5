"""Find straight pieces of scan lines side by side on adjacent lines."""

from dataclasses import dataclass

import numpy as np

from ..geometry.groups import mask_of, run_starts
from ..neighborhoods.wide_in_plan import MOST_ACROSS_LINES
from ..packages import spatial
from ..stage import Monitor
from ..threads import NEIGHBORS_AT_ONCE, in_chunks
from .straight_pieces import Pieces


@dataclass(frozen=True)
class Adjacency:
    """Pairs of pieces on adjacent lines, each in both directions, sorted by the first piece."""

    #: one, other, (k,), int64: the two pieces
    one: np.ndarray
    other: np.ndarray
    #: (k,), float64: share of the points of the shorter piece that have a neighbor in the longer one
    overlap: np.ndarray
    offset: np.ndarray  #: (k, 3), float64: mean way to the neighbors across ``one``, m: to the side on which they lie

    def neighbors(self, count: int) -> list[list[int]]:
        """Return the adjacent pieces of each of ``count`` pieces."""
        ends = np.searchsorted(self.one, np.arange(count + 1)).tolist()
        others = self.other.tolist()
        return [others[start:stop] for start, stop in zip(ends[:-1], ends[1:])]

    def triples(self, size: np.ndarray, min_overlap: float) -> np.ndarray:
        """Return triples (t, 3) of pieces on three adjacent lines, at most one for each piece in the middle.

        Parameters
        ----------
        size : ndarray of shape (m,)
            Points of the pieces; of several on one side the largest is taken.
        min_overlap : float
            Least overlap with the piece in the middle.
        """
        beside = np.flatnonzero(self.overlap >= min_overlap)
        beside = beside[np.lexsort((self.other[beside], -size[self.other[beside]], self.one[beside]))]
        first = mask_of(len(beside), run_starts(self.one[beside]))
        best = beside[first]
        opposite = np.einsum("ij,ij->i", self.offset[beside], self.offset[best][np.cumsum(first) - 1]) < 0
        across = beside[opposite]
        middle, at = np.unique(self.one[across], return_index=True)
        partner = best[np.searchsorted(self.one[best], middle)]
        return np.column_stack([self.other[partner], middle, self.other[across[at]]])


def adjacent_pieces(xyz: np.ndarray, piece: np.ndarray, pieces: Pieces, distance: float, monitor: Monitor) -> Adjacency:
    """Find the pieces next to each other on adjacent lines.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points of pieces (m).
    piece : ndarray of shape (n,), int64
        Piece of each point, from 0.
    pieces : Pieces
        The pieces.
    distance : float
        Distance of neighboring points of adjacent lines at most, m.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    Adjacency
        Pairs of adjacent pieces.

    Notes
    -----
    Lines need no numbers. Of the points to the side of a point, more across its piece than along it, the nearest one is
    on an adjacent line. The nearest one on the opposite side is on the other.
    """
    n, count = len(xyz), min(MOST_ACROSS_LINES, len(xyz))
    tree = spatial.cKDTree(xyz)
    nearest = np.full((n, 2), -1, np.int64)

    def work(rows: np.ndarray) -> None:
        length, found = tree.query(xyz[rows], count, distance_upper_bound=distance)
        known = np.isfinite(length).reshape(len(rows), count)
        found = np.where(known, found.reshape(len(rows), count), rows[:, None])
        nearest[rows] = _beside(xyz, piece, pieces.direction, rows, found)

    in_chunks(work, np.arange(n), NEIGHBORS_AT_ONCE // max(count, 1), monitor)
    return _pairs(xyz, piece, pieces, nearest)


def _beside(
    xyz: np.ndarray, piece: np.ndarray, direction: np.ndarray, rows: np.ndarray, found: np.ndarray
) -> np.ndarray:
    """Return the nearest of the points ``found`` (r, k) on each side (r, 2) of a piece; -1 without one."""
    along = direction[piece[rows]]
    way = xyz[found] - xyz[rows][:, None]
    length = np.einsum("ijk,ik->ij", way, along)
    across = way - length[..., None] * along[:, None]
    square = np.einsum("ijk,ijk->ij", across, across)
    is_beside = (square > length * length) & (piece[found] != piece[rows][:, None])
    position = np.arange(len(rows))
    first = is_beside.argmax(axis=1)
    opposite = is_beside & (np.einsum("ijk,ik->ij", across, across[position, first]) < 0)
    one, other = found[position, first], found[position, opposite.argmax(axis=1)]
    return np.column_stack([np.where(is_beside.any(axis=1), one, -1), np.where(opposite.any(axis=1), other, -1)])


def _pairs(xyz: np.ndarray, piece: np.ndarray, pieces: Pieces, nearest: np.ndarray) -> Adjacency:
    """Return the pairs of pieces that points and the nearest points of adjacent lines make."""
    point, side = np.nonzero(nearest >= 0)
    there = nearest[point, side]
    m = len(pieces)
    key, which = np.unique(piece[point] * m + piece[there], return_inverse=True)
    way = xyz[there] - xyz[point]
    count = np.bincount(which, minlength=len(key))
    mean = np.column_stack([np.bincount(which, column, len(key)) for column in way.T]) / np.maximum(count, 1)[:, None]
    one, other = np.divmod(key, max(m, 1))
    # Keep each pair once in both directions, whichever side found it.
    key, at = np.unique(np.concatenate([key, other * m + one]), return_index=True)
    count, mean = np.tile(count, 2)[at], np.concatenate([mean, -mean])[at]
    one, other = np.divmod(key, max(m, 1))
    size = pieces.points.count
    along = pieces.direction[one]
    mean -= np.einsum("ij,ij->i", mean, along)[:, None] * along
    return Adjacency(one, other, np.minimum(count / np.minimum(size[one], size[other]), 1.0), mean)
