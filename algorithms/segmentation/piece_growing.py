"""Regions of straight pieces of scan lines: seeds of three, and the adjacent pieces that lie on their surface."""

from collections import deque
from dataclasses import dataclass
from functools import partial
from typing import Callable

import numpy as np

from ..planes.least_squares_planes import Planes
from ..stage import Monitor
from .adjacent_pieces import Adjacency
from .straight_pieces import Pieces


@dataclass(frozen=True)
class Growth:
    """When a piece belongs to a region."""

    tolerance: float  #: Distance of both ends of a piece from the plane, m
    seed_deviation: float  #: Root mean square distance of the points of a seed from its plane, m
    is_planar: bool  #: Whether the plane is fitted to the whole region, or to the pieces next to the new one


class Regions:
    """Regions that grow one after the other.

    Parameters
    ----------
    pieces : Pieces
        The pieces (m).
    adjacency : Adjacency
        Which of them lie side by side.
    growth : Growth
        Criteria of pieces of one region.

    Attributes
    ----------
    region : list of int
        Region of each piece, from 0; -1 if unassigned.
    plane : ndarray of shape (m, 4)
        Unit normal and its product with a point of the plane that each piece of a region lies on.
    """

    def __init__(self, pieces: Pieces, adjacency: Adjacency, growth: Growth) -> None:
        self.pieces, self.growth = pieces, growth
        self.adjacency = adjacency
        self.neighbors = adjacency.neighbors(len(pieces))
        self.first_pair = np.searchsorted(adjacency.one, np.arange(len(pieces))).tolist()
        self.region = [-1] * len(pieces)
        self.plane = np.full((len(pieces), 4), np.nan)
        self.moments = _moments(pieces.points)
        self.ends = pieces.ends

    def grow(self, min_overlap: float, monitor: Monitor) -> None:
        """Grow a region from each seed whose pieces are still free, the seed of most points first."""
        size = self.pieces.points.count
        triples = self.adjacency.triples(size, min_overlap)
        triples = triples[self._flat(triples)]
        triples = triples[np.lexsort((triples[:, 1], -size[triples].sum(axis=1)))]
        grow = self._grow_plane if self.growth.is_planar else self._grow_smooth
        number = 0
        for i, seed in enumerate(triples.tolist()):
            if all(self.region[piece] < 0 for piece in seed):
                grow(seed, number, partial(monitor.progress, i / len(triples)))
                number += 1
        monitor.progress(1.0)

    def _flat(self, triples: np.ndarray) -> np.ndarray:
        """Return the mask of triples (t, 3) that lie on a plane: their points on the whole, and all their ends."""
        if not len(triples):
            return np.zeros(0, bool)
        t = len(triples)
        points = self.pieces.points.chosen(triples.ravel()).merged(np.repeat(np.arange(t), 3), t)
        off = self.ends[triples].reshape(t, 6, 3) - points.center[:, None]
        distance = np.abs(np.einsum("ijk,ik->ij", off, points.normal)).max(axis=1)
        deviation = np.sqrt(np.maximum(points.eigenvalues[:, 2], 0))
        return (deviation <= self.growth.seed_deviation) & (distance <= self.growth.tolerance)

    def _grow_plane(self, seed: list[int], number: int, report: Callable[[], None]) -> None:
        """Add pieces that lie on the plane of the region, which is fitted anew with each, until none can be added."""
        members = list(seed)
        moments = self.moments[seed].sum(axis=0)
        plane = _plane(moments)
        for piece in seed:
            self.region[piece] = number
        waiting = deque(self._free(seed))
        rejected: list[int] = []
        n_before = 0
        while waiting:
            report()
            piece = waiting.popleft()
            if self.region[piece] >= 0:
                continue
            if self._is_on(piece, plane):
                self.region[piece] = number
                members.append(piece)
                moments += self.moments[piece]
                plane = _plane(moments)
                waiting.extend(self._free([piece]))
            else:
                rejected.append(piece)
            if not waiting and len(members) > n_before:
                # The plane has changed since these were looked at.
                n_before = len(members)
                waiting.extend(dict.fromkeys(rejected))
                rejected = []
        self.plane[members] = plane

    def _grow_smooth(self, seed: list[int], number: int, report: Callable[[], None]) -> None:
        """Add pieces that lie on the local plane of the piece next to them."""
        for piece in seed:
            self.region[piece] = number
        for piece in seed:
            self.plane[piece] = self._local_plane(piece, number)
        waiting = deque((piece, beside) for beside in seed for piece in self._free([beside]))
        while waiting:
            report()
            piece, beside = waiting.popleft()
            if self.region[piece] >= 0 or not self._continues(piece, beside):
                continue
            self.region[piece] = number
            self.plane[piece] = self._local_plane(piece, number)
            waiting.extend((other, piece) for other in self._free([piece]))

    def _local_plane(self, piece: int, number: int) -> np.ndarray:
        """Return the plane (4,) that holds a piece and the mean direction to the pieces of its region next to it."""
        start, others = self.first_pair[piece], self.neighbors[piece]
        rows = [row for row, other in enumerate(others, start) if self.region[other] == number]
        ways = self.adjacency.offset[rows]
        across = np.sign(ways @ ways[0]) @ ways
        normal = np.cross(self.pieces.direction[piece], across)
        normal /= max(float(np.linalg.norm(normal)), np.finfo(float).tiny)
        return np.append(normal, normal @ self.pieces.points.center[piece])

    def _free(self, pieces: list[int]) -> list[int]:
        """Return the pieces next to some that are of no region."""
        return [other for piece in pieces for other in self.neighbors[piece] if self.region[other] < 0]

    def _is_on(self, piece: int, plane: np.ndarray) -> bool:
        """Return whether both ends of a piece lie on a plane (4,)."""
        return bool((np.abs(self.ends[piece] @ plane[:3] - plane[3]) <= self.growth.tolerance).all())

    def _continues(self, piece: int, beside: int) -> bool:
        """Return whether the stretch of a piece next to another one lies on the plane there."""
        first, last = self.ends[piece]
        low, high = self.ends[beside] @ self.pieces.direction[beside]
        start, stop = self.ends[piece] @ self.pieces.direction[beside]
        way = stop - start
        shares = np.sort([(low - start) / way, (high - start) / way]).clip(0, 1) if way else np.array([0.0, 1.0])
        plane = self.plane[beside]
        off = (first + shares[:, None] * (last - first)) @ plane[:3] - plane[3]
        return bool((np.abs(off) <= self.growth.tolerance).all())


def _moments(points: Planes) -> np.ndarray:
    """Return number, sums and sums of products (m, 10) of the points of pieces."""
    x, y, z = points.center.T
    products = np.column_stack([x * x, y * y, z * z, x * y, x * z, y * z])
    return np.column_stack([np.ones(len(points)), points.center, points.covariance + products]) * points.count[:, None]


def _plane(moments: np.ndarray) -> np.ndarray:
    """Return the normal, and its product with the center (4,), of the plane of points with these moments (10,)."""
    center = moments[1:4] / moments[0]
    covariance = moments[[4, 7, 8, 7, 5, 9, 8, 9, 6]].reshape(3, 3) / moments[0] - np.outer(center, center)
    normal = np.linalg.eigh(covariance)[1][:, 0]
    return np.append(normal, normal @ center)
