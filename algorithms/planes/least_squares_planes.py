"""Least-squares planes of groups of points, kept as moments so that groups can be merged without their points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Optional

import numpy as np

from ..neighborhoods.covariance import smallest_eigenvectors, symmetric_eigenvalues
from ..neighborhoods.nearest_blocks import PAIRS
from ..threads import NEIGHBORS_AT_ONCE


@dataclass(frozen=True)
class Planes:
    """Planes of m groups of points."""

    count: np.ndarray  #: (m,): points of each group
    center: np.ndarray  #: (m, 3): their mean, m
    covariance: np.ndarray  #: (m, 6): their xx, yy, zz, xy, xz, yz, with the divisor n, m²

    def __len__(self) -> int:
        return len(self.count)

    @cached_property
    def eigenvalues(self) -> np.ndarray:
        """Variances (m, 3), descending: along, across in the plane, and off the plane, m²."""
        return symmetric_eigenvalues(self.covariance)

    @cached_property
    def normal(self) -> np.ndarray:
        """Unit normals (m, 3), upward; NaN where all points lie at one position."""
        return smallest_eigenvectors(self.covariance, self.eigenvalues)

    @property
    def area(self) -> np.ndarray:
        """Area (m,) of the rectangle on which evenly spread points vary as these do, m²."""
        return 12 * np.sqrt(self.eigenvalues[:, 0] * self.eigenvalues[:, 1])

    def distance(self, xyz: np.ndarray, plane: np.ndarray) -> np.ndarray:
        """Return the distance (n,) of points (n, 3) to the planes numbered ``plane`` (n,), m."""
        return np.abs(np.einsum("ij,ij->i", xyz - self.center[plane], self.normal[plane]))

    def deviation(self, points: np.ndarray, plane: np.ndarray) -> np.ndarray:
        """Return how far (root mean square, m) the points of the groups ``points`` lie off the planes ``plane``."""
        return off_planes(self.center[points] - self.center[plane], self.covariance[points], self.normal[plane])

    def chosen(self, which: np.ndarray) -> Planes:
        """Return the planes ``which``, a mask or numbers."""
        return Planes(self.count[which], self.center[which], self.covariance[which])

    def merged(self, group: np.ndarray, n_groups: int) -> Planes:
        """Return the planes of the points of all groups with the same number in ``group`` (m,)."""
        count = np.bincount(group, self.count, n_groups)
        center = _means(self.center, group, count, self.count)
        offset = self.center - center[group]
        between = np.column_stack([offset[:, a] * offset[:, b] for a, b in PAIRS])
        return Planes(count, center, _means(self.covariance + between, group, count, self.count))


def planes_of(xyz: np.ndarray, group: np.ndarray, n_groups: int, rows: Optional[np.ndarray] = None) -> Planes:
    """Return the planes of points (n, 3) by their ``group`` (n,) from 0; each group has a point.

    With ``rows`` (m,) only these points count, and ``group`` (m,) is theirs.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m.
    group : ndarray of shape (n,) or (m,), int
        Group of each point, from 0.
    n_groups : int
        Number of groups.
    rows : ndarray of shape (m,), optional
        Points that count.
    """
    # Each chunk makes sums of all groups: with fewer points than groups it would take longer than the points.
    size = max(NEIGHBORS_AT_ONCE, n_groups)
    parts = [slice(start, start + size) for start in range(0, len(group), size)]
    count, center, covariance = np.zeros(n_groups, np.int64), np.zeros((n_groups, 3)), np.zeros((n_groups, 6))
    for part in parts:
        points = xyz[part] if rows is None else xyz[rows[part]]
        count += np.bincount(group[part], minlength=n_groups)
        center += np.column_stack([np.bincount(group[part], column, n_groups) for column in points.T])
    center /= count[:, None]
    for part in parts:
        offset = (xyz[part] if rows is None else xyz[rows[part]]) - center[group[part]]
        products = (offset[:, a] * offset[:, b] for a, b in PAIRS)
        covariance += np.column_stack([np.bincount(group[part], product, n_groups) for product in products])
    return Planes(count, center, covariance / count[:, None])


def _means(values: np.ndarray, group: np.ndarray, count: np.ndarray, weight: np.ndarray) -> np.ndarray:
    return np.column_stack([np.bincount(group, column * weight, len(count)) / count for column in values.T])


def off_planes(offset: np.ndarray, covariance: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return how far (root mean square, m) points lie off planes.

    Parameters
    ----------
    offset : ndarray of shape (m, 3)
        The center of the points, from a point on the plane (m).
    covariance : ndarray of shape (m, 6)
        Covariance of the points (m²).
    normal : ndarray of shape (m, 3)
        Unit normals of the planes.
    """
    spread = np.zeros(len(offset))
    for column, (a, b) in enumerate(PAIRS):
        spread += (1 if a == b else 2) * covariance[:, column] * normal[:, a] * normal[:, b]
    return np.sqrt(np.einsum("ij,ij->i", offset, normal) ** 2 + np.maximum(spread, 0))
