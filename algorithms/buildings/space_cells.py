"""Cubic cells in space with the points in each, and sums over each cell and the 26 around it."""

from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np

from ..geometry.groups import placed
from ..geometry.sparse_voxels import neighbor_pairs, voxelize
from ..neighborhoods.nearest_blocks import PAIRS
from ..packages import sparse


class SpaceCells:
    """The occupied cells of a cubic lattice, with the points that each holds.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points, m, with easting and northing from the corner of the whole: a part of a cloud then has the same cells.
    size : float
        Side of a cell, m.

    Attributes
    ----------
    voxels : ndarray of shape (m, 3), int64
        Column, row and layer of each cell, sorted.
    cell : ndarray of shape (n,), int64
        The cell of each point.
    count : ndarray of shape (m,), int64
        Points of each cell.
    """

    def __init__(self, xyz: np.ndarray, size: float) -> None:
        self.xyz, self.size = xyz, size
        self.voxels, self.cell, self.count = voxelize(xyz, size)

    def sums(self, values: np.ndarray) -> np.ndarray:
        """Return the sum (m,) of the values (n,) of the points of each cell."""
        return np.bincount(self.cell, values, len(self.count))

    def around(self, chosen: np.ndarray) -> Any:
        """Return a sparse matrix (k, m): 1 for each of the cells ``chosen`` (k,) and the up to 26 that touch it."""
        one, other, _ = neighbor_pairs(self.voxels, 26)
        row = placed(np.arange(len(chosen), dtype=np.int32), chosen, len(self.count), -1)
        pairs = [(row[chosen], chosen)]
        for own, beside in ((one, other), (other, one)):
            is_own = row[own] >= 0
            pairs.append((row[own[is_own]], beside[is_own].astype(np.int32)))
        del one, other
        rows, columns = (np.concatenate(of_pairs, dtype=np.int32) for of_pairs in zip(*pairs))
        return sparse.csr_matrix((np.ones(len(rows), np.int8), (rows, columns)), (len(chosen), len(self.count)))

    @cached_property
    def centers(self) -> np.ndarray:
        """Middle of the points of each cell (m, 3), m."""
        return self._origin + self.moments[:, 1:4] / self.moments[:, :1]

    @cached_property
    def moments(self) -> np.ndarray:
        """Number of points, sums of x, y, z and of their six products (m, 10), m and m², about a point amid them."""
        products = (self._off(a) * self._off(b) for a, b in PAIRS)
        sums = [self.sums(values) for values in chain(map(self._off, range(3)), products)]
        return np.column_stack([self.count.astype(float), *sums])

    def _off(self, axis: int) -> np.ndarray:
        """Return how far (n,) the points are along an axis from a point amid them, m."""
        return self.xyz[:, axis] - self._origin[axis]

    @cached_property
    def _origin(self) -> np.ndarray:
        # Sum about a nearby point, as squares of large coordinates lose digits.
        return np.rint(self.xyz.mean(axis=0))


def covariances(moments: np.ndarray) -> np.ndarray:
    """Return the covariances (m, 6), m², of groups of points with ``moments`` (m, 10)."""
    means = moments[:, 1:] / moments[:, :1]
    return np.column_stack([means[:, 3 + i] - means[:, a] * means[:, b] for i, (a, b) in enumerate(PAIRS)])
