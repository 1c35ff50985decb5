"""Two mean entropies, of buildings and of everything else, by two-class K-means of the clusters."""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..packages import cluster
from ..stage import Monitor
from .entropy_split import Split

# Means closer together are equal: clusters differ by 0.01 and more.
_SAME = 1e-3

# Runs of K-means, of which the best counts: the default of scikit-learn for years.
_STARTS = 10


def two_means(means: np.ndarray, monitor: Monitor) -> Split:
    """Separate the clusters' mean entropies (m,) in two so that the sum of squares within both classes is least.

    This is what two-class K-means approaches by rounds. In one dimension each class is an interval, so that trying
    every gap between the sorted values finds the optimum.
    """
    known = np.sort(means[np.isfinite(means)])
    alike = _alike(known, monitor)
    if alike is not None:
        return alike
    n_low = np.flatnonzero(np.diff(known) > 0) + 1
    low = np.cumsum(known)[n_low - 1] / n_low
    high = (known.sum() - n_low * low) / (len(known) - n_low)
    # The sum of squares between the classes is greatest where that within them is least.
    best = np.argmax(n_low * (len(known) - n_low) * (high - low) ** 2)
    return Split(float(low[best]), float(high[best]))


def k_means(means: np.ndarray, monitor: Monitor) -> Split:
    """Separate the clusters' mean entropies (m,) by scikit-learn's K-means with two classes, from ten random starts."""
    known = np.sort(means[np.isfinite(means)])
    alike = _alike(known, monitor)
    if alike is not None:
        return alike
    found = cluster.KMeans(n_clusters=2, n_init=_STARTS, random_state=0).fit(known[:, None])
    building, other = np.sort(found.cluster_centers_.ravel())
    return Split(float(building), float(other))


def _alike(known: np.ndarray, monitor: Monitor) -> Optional[Split]:
    """Return the split of ascending mean entropies that can't be separated, and say so; None where they can."""
    if len(known) >= 2 and np.ptp(known) >= _SAME:
        return None
    only = "are only clusters of the same entropy"
    if len(known) < 2:
        only = "is only one cluster" if len(known) else "is no cluster with an entropy"
    monitor.warn(f"There {only}: nothing to separate, so nothing was called a building.")
    same = float(known.mean()) if len(known) else np.nan
    return Split(same, same)
