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
    is_candidate = is_surface & ~is_green
    share = evidence.share_around(is_candidate)
    is_building = is_candidate & (share >= min_share)
    found = {
        Reason.GREEN: is_green,
        Reason.SURFACE: is_building,
        Reason.AMID_OTHERS: is_candidate,
    }
    reasons = np.select(list(found.values()), list(found), Reason.ROUGH).astype(np.uint8)
    confidence = np.where(is_building, 0.5 + 0.5 * np.maximum(share, 0.02), 0.5 * share)
    return Decisions(confidence, reasons)


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
