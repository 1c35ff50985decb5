"""The mean entropy of each cluster (equations 5 to 11 of dos Santos et al., 2019)."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.groups import placed
from ..geometry.scattered import scattered
from ..neighborhoods.covariance import Neighborhood, neighborhood_eigenvalues, shannon_entropy_lps
from ..packages import spatial
from ..stage import Monitor


@dataclass(frozen=True)
class ClusterEntropies:
    """The entropies of k clustered points and of their m clusters."""

    rows: np.ndarray  #: (k,), int64: indices of the clustered points in the cloud
    position: np.ndarray  #: (k,), int64: the cluster of each, as an index into ``ids``
    #: (k,), float64: entropy of each clustered point, 0 to ln 3; NaN where its neighborhood has no extent
    values: np.ndarray
    #: ids, sizes, (m,), int64: number and points of each cluster
    ids: np.ndarray
    sizes: np.ndarray
    means: np.ndarray  #: (m,), float64: mean entropy of each cluster; NaN where no point of it has one

    def groups(self, n_points: int) -> np.ndarray:
        """Return the cluster of each of the cloud's points (n_points,), as an index into ``ids``; -1 for none."""
        return placed(self.position, self.rows, n_points, -1)

    def share_of(self, mask: np.ndarray) -> np.ndarray:
        """Return the share (m,) of each cluster's points that a mask (n_points,) has."""
        return np.bincount(self.position, mask[self.rows], len(self.ids)) / self.sizes


def cluster_entropies(
    xyz: np.ndarray, cluster_id: np.ndarray, around: Neighborhood, monitor: Monitor, measured: Optional[int] = None
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
    measured : int, optional
        Points of each cluster, about, that are measured: the mean needs no more. All others have the mean of
        their cluster.

    Returns
    -------
    ClusterEntropies
        Entropies of points and means of clusters.
    """
    rows = np.flatnonzero(cluster_id > 0)
    ids, position, sizes = np.unique(cluster_id[rows], return_inverse=True, return_counts=True)
    clustered = xyz[rows]
    tree = spatial.cKDTree(clustered, balanced_tree=False)
    chosen = None if measured is None else _sample(clustered, np.minimum(1.0, measured / sizes)[position])
    values = shannon_entropy_lps(neighborhood_eigenvalues(clustered, around, tree, monitor, chosen))
    means = _means(values, position, len(ids))
    if chosen is not None:
        values = np.where(chosen, values, means[position])
    return ClusterEntropies(rows, position, values, ids, sizes, means)


def _sample(xyz: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Return a sample (n,), bool, that has each point (n, 3) with the probability ``share`` (n,).

    The coordinates alone decide, so that a cluster has the same sample in every part of a survey that holds it.
    """
    # Tenths of a millimeter: coordinates that were stored in steps may differ by rounding.
    chosen = scattered(np.rint(xyz * 1e4).astype(np.int64)) < share
    # Coincident points are chosen all together or not at all; if none is chosen, take all, as every cluster needs a
    # mean.
    return chosen if chosen.any() else np.ones(len(xyz), bool)


def _means(values: np.ndarray, position: np.ndarray, count: int) -> np.ndarray:
    """Return the mean entropy of each of ``count`` clusters (equation 5), NaN where no point of it has one."""
    defined = np.isfinite(values)
    size = np.bincount(position[defined], minlength=count)
    total = np.bincount(position[defined], values[defined], count)
    return np.divide(total, size, out=np.full(count, np.nan), where=size > 0)
