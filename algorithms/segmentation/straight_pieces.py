"""Straight pieces of scan lines: lines split at their farthest points until all are straight."""

from dataclasses import dataclass
from functools import partial
from typing import Callable

import numpy as np

from ..geometry.groups import items, run_starts
from ..neighborhoods.covariance import full_matrices
from ..planes.least_squares_planes import Planes, planes_of
from ..stage import Monitor
from ..threads import NEIGHBORS_AT_ONCE


@dataclass(frozen=True)
class Pieces:
    """Straight pieces of scan lines."""

    points: Planes  #: Number of points, center and covariance of each piece (m of them)
    direction: np.ndarray  #: (m, 3): unit vectors along them
    ends: np.ndarray  #: (m, 2, 3): ends of the straight line through the points of each by least squares, m

    def __len__(self) -> int:
        return len(self.points)


def split_lines(xyz: np.ndarray, line: np.ndarray, tolerance: float, min_points: int, monitor: Monitor) -> np.ndarray:
    """Split lines into straight pieces in space.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points line by line, in each along the line (m).
    line : ndarray of shape (n,), int
        Line of each point, ascending.
    tolerance : float
        Distance from the chord of a piece within which its points lie, m.
    min_points : int
        Least number of points of a piece.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    ndarray of shape (n,), int64
        Piece of each point, from 0 along the lines; -1 if unassigned.

    Notes
    -----
    All pieces that are too bent are split at once, at the point that is farthest from the chord (Douglas and Peucker).
    This point ends one piece and begins the next; in the end it belongs to the longer of the two.
    """
    first = run_starts(line)
    last = np.append(first[1:], len(line)) - 1
    done: list[np.ndarray] = []
    n_open = n_all = max(len(xyz), 1)
    while len(first):
        is_long = last - first + 1 >= min_points
        first, last = first[is_long], last[is_long]
        farthest, distance = _farthest_in_blocks(xyz, first, last, partial(monitor.progress, 1 - n_open / n_all))
        bent = distance > tolerance
        done.append(np.column_stack([first[~bent], last[~bent]]))
        first, last = (np.concatenate([first[bent], farthest[bent]]), np.concatenate([farthest[bent], last[bent]]))
        n_open = int((last - first).sum())
        monitor.progress(1 - n_open / n_all)
    return _numbered(np.concatenate(done) if done else np.zeros((0, 2), np.int64), len(xyz), min_points)


def _farthest_in_blocks(
    xyz: np.ndarray, first: np.ndarray, last: np.ndarray, report: Callable[[], None]
) -> tuple[np.ndarray, np.ndarray]:
    """Return what `_farthest` returns, for pieces of some 200,000 points at once; ``report`` is called for each."""
    block = np.cumsum(last - first + 1) // NEIGHBORS_AT_ONCE
    farthest, distance = np.zeros(len(first), np.int64), np.zeros(len(first))
    starts = run_starts(block)
    for start, stop in zip(starts, np.append(starts[1:], len(block))):
        report()
        farthest[start:stop], distance[start:stop] = _farthest(xyz, first[start:stop], last[start:stop])
    return farthest, distance


def _farthest(xyz: np.ndarray, first: np.ndarray, last: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the point of each piece that is farthest from the chord of its ends, and its distance (m)."""
    if not len(first):
        return first, np.zeros(0)
    which, item = items(last - first + 1)
    rows = first[which] + item
    chord = xyz[last] - xyz[first]
    length = np.linalg.norm(chord, axis=1)
    chord /= np.maximum(length, np.finfo(float).tiny)[:, None]
    off = xyz[rows] - xyz[first][which]
    off -= np.einsum("ij,ij->i", off, chord[which])[:, None] * chord[which]
    square = np.einsum("ij,ij->i", off, off)
    largest = np.maximum.reduceat(square, run_starts(which))
    at = np.flatnonzero(square == largest[which])
    return rows[at[run_starts(which[at])]], np.sqrt(largest)


def _numbered(pieces: np.ndarray, n: int, min_points: int) -> np.ndarray:
    """Return the piece (n,) of each point; a point that two share belongs to the longer one."""
    count = pieces[:, 1] - pieces[:, 0] + 1
    piece = np.full(n, -1, np.int64)
    # Longer pieces are written over shorter ones, of equal ones the earlier over the later.
    order = np.lexsort((-pieces[:, 0], count))
    which, item = items(count[order])
    piece[pieces[order, 0][which] + item] = order[which]
    size = np.bincount(piece[piece >= 0], minlength=len(pieces))
    first = np.argsort(pieces[:, 0], kind="stable")
    number = np.full(len(pieces), -1)
    kept = first[size[first] >= min_points]
    number[kept] = np.arange(len(kept))
    return np.where(piece >= 0, number[piece], -1) if len(pieces) else piece


def pieces_of(xyz: np.ndarray, piece: np.ndarray) -> Pieces:
    """Return the pieces that points (n, 3), m, of the pieces ``piece`` (n,), from 0, make."""
    count = int(piece.max(initial=-1)) + 1
    points = planes_of(xyz, piece, count)
    direction = np.linalg.eigh(full_matrices(points.covariance))[1][:, :, 2] if count else np.zeros((0, 3))
    along = np.einsum("ij,ij->i", xyz - points.center[piece], direction[piece])
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, piece, along)
    np.maximum.at(high, piece, along)
    ends = points.center[:, None] + np.stack([low, high], axis=1)[..., None] * direction[:, None]
    return Pieces(points, direction, ends)
