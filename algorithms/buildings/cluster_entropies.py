"""The mean entropy of each cluster (equations 5 to 11 of dos Santos et al., 2019)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Union

import numpy as np

from ..neighborhoods.covariance import Nearest, neighborhood_eigenvalues, shannon_entropy_lps
from ..neighborhoods.wide_in_plan import Wide
from ..stage import Monitor


@dataclass(frozen=True)
class ClusterEntropies:
    """The entropies of k clustered points and of their m clusters.

    Attributes
    ----------
    rows : ndarray of shape (k,), int64
        Indices of the clustered points in the cloud.
    position : ndarray of shape (k,), int64
        The cluster of each, as an index into ``ids``.
    values : ndarray of shape (k,), float64
        Entropy of each clustered point, 0 to ln 3; NaN where its neighborhood has no extent.
    ids, sizes : ndarray of shape (m,), int64
        Number and points of each cluster.
    means : ndarray of shape (m,), float64
        Mean entropy of each cluster; NaN where no point of it has one.
    """

    rows: np.ndarray
    position: np.ndarray
    values: np.ndarray
    ids: np.ndarray
    sizes: np.ndarray
    means: np.ndarray

    def groups(self, n_points: int) -> np.ndarray:
        """Return the cluster of each of the cloud's points (n_points,), as an index into ``ids``; -1 for none."""
        group = np.full(n_points, -1)
        group[self.rows] = self.position
        return group

    def share_of(self, mask: np.ndarray) -> np.ndarray:
        """Return the share (m,) of each cluster's points that a mask (n_points,) has."""
        return np.bincount(self.position, mask[self.rows], len(self.ids)) / self.sizes


def cluster_entropies(
    xyz: np.ndarray, cluster_id: np.ndarray, around: Union[Nearest, Wide], monitor: Monitor
) -> ClusterEntropies:
    """Measure the entropy of each clustered point among the clustered points, and its mean in each cluster.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m).
    cluster_id : ndarray of shape (n,), int
        Clusters from 1, 0 for none; at least one point is in a cluster.
    around : Nearest or Wide
        The neighborhood of a point, itself included.
    monitor : Monitor
        Receives the progress.
    """
    rows = np.flatnonzero(cluster_id > 0)
    values = shannon_entropy_lps(neighborhood_eigenvalues(xyz[rows], around, monitor=monitor))
    ids, position, sizes = np.unique(cluster_id[rows], return_inverse=True, return_counts=True)
    return ClusterEntropies(rows, position, values, ids, sizes, _means(values, position, len(ids)))


def _means(values: np.ndarray, position: np.ndarray, count: int) -> np.ndarray:
    """Return the mean entropy of each of ``count`` clusters (equation 5), NaN where no point of it has one."""
    defined = np.isfinite(values)
    size = np.bincount(position[defined], minlength=count)
    total = np.bincount(position[defined], values[defined], count)
    return np.divide(total, size, out=np.full(count, np.nan), where=size > 0)
