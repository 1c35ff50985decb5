"""Two mean entropies, of buildings and of everything else, held by reference values."""

from dataclasses import dataclass
from typing import Callable

import numpy as np

from ..neighborhoods.covariance import shannon_entropy_lps, symmetric_eigenvalues
from ..rules import rule, rules
from ..sampling.cloud_sampling import CloudSampling
from ..stage import Monitor


@rules
class SPLIT:
    """How two mean entropies are found."""

    weight: float = rule(10.0, "times the clusters", "chosen: clusters move a reference by a tenth of their distance")


# Keys of the two means among the values that blocks take from the whole survey.
MEAN_ENTROPIES = ("building_entropy", "other_entropy")


@dataclass(frozen=True)
class Split:
    """Two mean entropies, of buildings and of everything else; unless the first is less, clusters are undecided.

    With ``is_one_group`` all clusters are on one side, and the other mean is its reference value.
    """

    building: float
    other: float
    is_one_group: bool = False

    @property
    def separates(self) -> bool:
        """Whether there are two means and not one."""
        return self.building < self.other

    def confidence(self, means: np.ndarray) -> np.ndarray:
        """Return the distance to the others' mean over the sum of both distances, 0 to 1, for clusters (m,).

        Beyond its own mean a cluster has full confidence. Where the two means are one, all have 0.5.
        """
        if not self.separates:
            return np.full(len(means), 0.5)
        to_other, to_building = np.abs(means - self.other), np.abs(means - self.building)
        return np.select([means <= self.building, means >= self.other], [1.0, 0.0], to_other / (to_other + to_building))


def split_of_whole(sampling: CloudSampling, measure: Callable[[], Split]) -> Split:
    """Return the split of the whole that a cloud is a part of; of a whole the one that ``measure`` returns."""
    if all(name in sampling.of_whole for name in MEAN_ENTROPIES):
        building, other = (sampling.of_whole[name] for name in MEAN_ENTROPIES)
        return Split(building, other)
    split = measure()
    if split.separates:
        sampling.found.update(zip(MEAN_ENTROPIES, (split.building, split.other)))
    return split


def held_means(means: np.ndarray, plane: float, volume: float, monitor: Monitor) -> Split:
    """Separate the clusters' mean entropies (m,) as K-means does, from reference entropies and held by them.

    The references of planes and volumes each weigh ``SPLIT.weight`` times as much as all clusters. Two means alone
    would always find two groups, also among the thousands of clusters of a forest.

    Parameters
    ----------
    means : ndarray of shape (m,)
        Mean entropies of the clusters.
    plane : float
        Entropy of planes.
    volume : float
        Entropy of volumes.
    monitor : Monitor
        Receives warnings where the means do not separate.

    Returns
    -------
    Split
        The two means, and whether they separate.
    """
    known = np.sort(means[np.isfinite(means)])
    low, high, weight = plane, volume, SPLIT.weight * max(len(known), 1)
    # Each round but the last moves clusters in one direction, so that the rounds end.
    for _ in range(len(known) + 1):
        is_low = known <= (low + high) / 2
        before = low, high
        low = float((known[is_low].sum() + weight * plane) / (is_low.sum() + weight))
        high = float((known[~is_low].sum() + weight * volume) / ((~is_low).sum() + weight))
        if (low, high) == before:
            break
    is_one_group = bool(is_low.all() or not is_low.any())
    if is_one_group:
        monitor.warn(
            "The entropies of the clusters don't form two groups; the mean of the missing one was taken "
            f"from simulated planes ({plane:.2f}) or volumes ({volume:.2f})."
        )
    split = Split(low, high, is_one_group=is_one_group)
    if not split.separates:
        monitor.warn("At this noise planes have the entropy of volumes, so nothing was called a building.")
    return split


def reference_entropies(n_points: int, roughness: float = 0.0, trials: int = 400) -> tuple[float, float]:
    """Return the mean entropy of ``n_points`` random points on a disk and in a ball.

    Parameters
    ----------
    n_points : int
        Points of a neighborhood.
    roughness : float
        Standard deviation of the points across the disk, as a share of its radius.
    trials : int
        Disks and balls drawn.

    Returns
    -------
    plane, volume : float
        The random numbers are fixed: the same arguments always give the same two figures.
    """
    generator = np.random.default_rng(0)
    directions = generator.normal(size=(trials, n_points, 3))
    ball = directions / np.linalg.norm(directions, axis=2, keepdims=True)
    ball *= generator.random((trials, n_points, 1)) ** (1 / 3)
    angle = generator.random((trials, n_points)) * 2 * np.pi
    radius = np.sqrt(generator.random((trials, n_points)))
    across = roughness * generator.normal(size=angle.shape)
    disk = np.stack([radius * np.cos(angle), radius * np.sin(angle), across], axis=2)
    return _mean_entropy(disk), _mean_entropy(ball)


def _mean_entropy(points: np.ndarray) -> float:
    """Return the mean entropy of neighborhoods of points (trials, n_points, 3)."""
    offsets = points - points.mean(axis=1, keepdims=True)
    products = np.einsum("tni,tnj->tij", offsets, offsets) / points.shape[1]
    return float(shannon_entropy_lps(symmetric_eigenvalues(products[:, [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]])).mean())
