"""Objects above the ground that are no plants: with smooth and opaque surfaces, or upright and slender."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.components import connect
from ..geometry.groups import least_of
from ..neighborhoods.covariance import Nearest, reduce_neighborhoods, symmetric_eigenvalues
from ..neighborhoods.nearest_blocks import Shapes
from ..sampling.cloud_sampling import CloudSampling
from ..sampling.surface_noise import LEAST_NEIGHBORS, ON_PLANE
from ..stage import Monitor

# How far (m) from a point the points of its object are seen in a cloud that is worked on in parts: half the
# length of a car. Of longer objects the part within it decides.
REACH = 2.5


@dataclass(frozen=True)
class _Rules:
    """Rules by which solid objects are recognized."""

    #: gap_spacings, least_gap: Points of one object are closer in plan: 2 point spacings, as clusters of the building
    #: chain, at least 0.5 m
    gap_spacings: float = 2.0
    least_gap: float = 0.5
    #: Points of one object are closer in height (m): the distance between the bonnet of a car and its roof is less
    step: float = 1.0
    #: Highest smooth object (m): vans, containers and garden walls are lower, the smooth sides of crowns higher
    highest: float = 3.5
    #: Largest share of points whose pulse had several returns. Edges of cars give 0.1; crowns and bushes of the clouds
    #: with truth 0.3 to 0.9.
    most_passed: float = 0.2
    radius: float = 0.5  #: Surfaces are planes over at least this (m), leaves and twigs over less
    most_neighbors: int = 100  #: Most points of a neighborhood: more only take time
    smooth_share: float = 0.5  #: Least share of points on smooth surfaces: most points
    #: Least ratio of the height of poles to their extent in plan: lamps with an arm have 4, trees 1 to 2
    slenderness: float = 4.0


_RULES = _Rules()


def find_solid_objects(
    xyz: np.ndarray, height: np.ndarray, has_passed: np.ndarray, sampling: CloudSampling, monitor: Monitor
) -> np.ndarray:
    """Return the mask of points (n,) that are of cars, walls, fences, boats and the like, or of poles.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points above the ground that are of no building, m.
    height : ndarray of shape (n,)
        Their heights above the ground, m.
    has_passed : ndarray of shape (n,), bool
        Whether their pulses are known to have had several returns.
    sampling : CloudSampling
        How the whole cloud was sampled.
    monitor : Monitor
        Receives progress.
    """
    group, size, is_opaque = _groups(xyz, has_passed, sampling, monitor.part(0, 0.6))
    low, top = least_of(height, group, len(size)), -least_of(-height, group, len(size))
    has_enough = size >= LEAST_NEIGHBORS
    candidates = np.flatnonzero((is_opaque & has_enough & (top <= _RULES.highest))[group])
    is_smooth = _on_surfaces(xyz[candidates], sampling, monitor.part(0.6, 1))
    smooth = np.bincount(group[candidates], is_smooth, len(size))
    # Points of objects that are no candidates are not counted, so that these are never solid.
    is_solid = smooth >= np.maximum(_RULES.smooth_share * size, 1)
    rise = top - low
    is_pole = has_enough & (rise >= _RULES.slenderness * _extent(group, xyz, size))
    return (is_solid | is_pole)[group]


def are_opaque(xyz: np.ndarray, has_passed: np.ndarray, sampling: CloudSampling, monitor: Monitor) -> np.ndarray:
    """Return the mask of points (n,) of groups that hardly a pulse passes.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points, m.
    has_passed : ndarray of shape (n,), bool
        Whether their pulses are known to have had several returns.
    sampling : CloudSampling
        How the whole cloud was sampled.
    monitor : Monitor
        Receives progress.
    """
    group, size, is_opaque = _groups(xyz, has_passed, sampling, monitor)
    return (is_opaque & (size >= LEAST_NEIGHBORS))[group]


def _groups(
    xyz: np.ndarray, has_passed: np.ndarray, sampling: CloudSampling, monitor: Monitor
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the object of each point (n,), the points of each object (m,), and the mask of opaque objects (m,)."""
    gap = max(_RULES.gap_spacings * sampling.spacing, _RULES.least_gap)
    group = connect(xyz, gap, _RULES.step, monitor)
    size = np.bincount(group, minlength=1)
    return group, size, np.bincount(group, has_passed, len(size)) < _RULES.most_passed * size


def _extent(group: np.ndarray, xyz: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Return the longest extent in plan (m) of each group (m,): that of evenly spread points of the same deviation."""
    x, y = (xyz[:, :2] - xyz[:, :2].mean(axis=0)).T if len(xyz) else np.zeros((2, 0))
    count = np.maximum(size, 1)
    x, y = (values - (np.bincount(group, values, len(size)) / count)[group] for values in (x, y))
    xx, yy, xy = (np.bincount(group, product, len(size)) / count for product in (x * x, y * y, x * y))
    return np.sqrt(12 * ((xx + yy) / 2 + np.hypot((xx - yy) / 2, xy)))


def _on_surfaces(xyz: np.ndarray, sampling: CloudSampling, monitor: Monitor) -> np.ndarray:
    """Return the mask of points (n,) whose neighbors deviate from a plane no more than points of surfaces do."""
    is_smooth = np.zeros(len(xyz), bool)
    if len(xyz) < LEAST_NEIGHBORS:
        return is_smooth
    most = ON_PLANE * sampling.roughness

    def keep(rows: np.ndarray, shapes: Shapes) -> None:
        # A plane through k points leaves k - 3 degrees of freedom.
        variance = symmetric_eigenvalues(shapes.covariances)[:, 2] * shapes.counts / np.maximum(shapes.counts - 3, 1)
        is_smooth[rows] = (variance <= most**2) & (shapes.counts >= LEAST_NEIGHBORS)

    count = round(float(np.pi * _RULES.radius**2 * sampling.density))
    neighborhood = Nearest(min(max(count, LEAST_NEIGHBORS), _RULES.most_neighbors))
    reduce_neighborhoods(xyz, neighborhood, keep, monitor=monitor)
    return is_smooth
