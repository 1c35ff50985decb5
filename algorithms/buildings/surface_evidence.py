"""What matched images tell of clusters: surfaces that are planar over meters amid such surfaces, and color."""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..cloud.reasons import Reason
from ..features.greenness import greenness, plant_greenness
from .cluster_decisions import Decisions
from .cluster_evidence import ClusterEvidence

# Planes larger than this, in minimum building areas, may be green: roofs of copper and of grass.
_LARGE_PLANE = 10.0


# A surface that turns by more than this (rad) both ways over its width is the dome of a crown: planes don't turn, and
# vaults do one way. On real and simulated clouds, roofs with rounded edges turn by 0.3 at most. Surfaces smaller than
# this, in minimum building areas, are domes by their rounded edges alone.
_DOME, _SMALLEST_DOME = 0.6, 2.0


def decide_in_images(
    surface_share: np.ndarray, green: np.ndarray, evidence: ClusterEvidence, min_share: float
) -> Decisions:
    """Decide on clusters of the surface seen from above.

    Parameters
    ----------
    surface_share : ndarray of shape (m,)
        Share of each cluster's points that are on surfaces planar over meters.
    green : ndarray of shape (m,), bool
        Clusters as green as plants.
    evidence : ClusterEvidence
        The clusters among the points of the cloud.
    min_share : float
        Least share of such surfaces among all that stands around a building.

    Returns
    -------
    Decisions
        Crowns are closed and smooth over decimeters, but planar over meters in spots only, with rough leaves around.
    """
    is_surface = surface_share > 0.5
    is_green = is_surface & green & (evidence.areas < _LARGE_PLANE * evidence.min_area)
    is_large = evidence.areas >= _SMALLEST_DOME * evidence.min_area
    is_dome = is_large & (turning(evidence) > _DOME)
    is_candidate = is_surface & ~is_green & ~is_dome
    share = evidence.share_around(is_candidate)
    is_building = is_candidate & (share >= min_share)
    found = {
        Reason.GREEN: is_green,
        Reason.SURFACE: is_building,
        Reason.AMID_OTHERS: is_candidate,
        Reason.ROUGH: ~is_surface | is_dome,
    }
    reasons = np.select(list(found.values()), list(found), Reason.ROUGH).astype(np.uint8)
    confidence = np.where(is_building, 0.5 + 0.5 * np.maximum(share, 0.02), 0.5 * share)
    return Decisions(confidence, reasons)


def turning(evidence: ClusterEvidence) -> np.ndarray:
    """Return by how much (rad) the surface of each cluster (m,) turns over its width in the direction of least turning.

    The curvatures are those of the paraboloid of best fit; downward on both sides counts, other shapes turn by 0.
    """
    member = evidence.group >= 0
    group, count = evidence.group[member], len(evidence.numbers)
    size = np.maximum(np.bincount(group, minlength=count), 1)
    middle = np.column_stack([np.bincount(group, axis, count) / size for axis in evidence.xyz[member].T])
    x, y, z = (evidence.xyz[member] - middle[group]).T
    terms = (np.ones(len(x)), x, y, x * x, x * y, y * y)
    matrix, right = np.empty((count, 6, 6)), np.empty((count, 6, 1))
    for i, a in enumerate(terms):
        right[:, i, 0] = np.bincount(group, a * z, count)
        for j, b in enumerate(terms[: i + 1]):
            matrix[:, i, j] = matrix[:, j, i] = np.bincount(group, a * b, count)
    # A little of the identity keeps clusters of few points and of lines solvable, with hardly any curvature.
    fit = np.linalg.solve(matrix + 1e-6 * size[:, None, None] * np.eye(6), right)[:, :, 0]
    bending = np.stack([2 * fit[:, 3], fit[:, 4], fit[:, 4], 2 * fit[:, 5]], axis=1).reshape(-1, 2, 2)
    least = -np.linalg.eigvalsh(bending)[:, 1]
    return np.maximum(least, 0.0) * np.sqrt(evidence.areas)


def green_clusters(
    colors: tuple[Optional[np.ndarray], ...], group: np.ndarray, count: int
) -> tuple[np.ndarray, Optional[float]]:
    """Return which clusters (count,) are as green as the plants of the scene, and from which greenness on that is.

    Parameters
    ----------
    colors : three ndarrays of shape (n,), or None
        Red, green and blue. Where one is missing, or where the scene has no two kinds of greenness, none is green.
    group : ndarray of shape (n,), int
        Cluster of each point from 0, negative for none.
    count : int
        Number of clusters.
    """
    nothing = np.zeros(count, bool)
    red, green, blue = colors
    if red is None or green is None or blue is None:
        return nothing, None
    values = greenness(red, green, blue)
    least = plant_greenness(values)
    if least is None:
        return nothing, None
    known = (group >= 0) & np.isfinite(values)
    share = np.bincount(group[known], values[known] > least, count)
    return share > 0.5 * np.maximum(np.bincount(group[known], minlength=count), 1), least
