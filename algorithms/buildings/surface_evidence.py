"""Evidence on clusters without returns: planar surfaces next to others of their kind, and color."""

from typing import Optional

import numpy as np

from ..cloud.reasons import Reason
from ..features.greenness import MOST_GREEN, greenness, greenness_between
from .cluster_decisions import Decisions
from .cluster_evidence import ClusterEvidence

# Surfaces larger than this (minimum building areas) give the colors of roofs, as smooth parts of crowns are smaller.
_LARGE = 10.0


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
        Least share of such surfaces among all surroundings of a building.

    Returns
    -------
    Decisions
        Confidences above 0.5 for buildings, and the reasons.

    Notes
    -----
    Crowns are closed and smooth over decimeters, but planar over meters in spots only, with rough leaves around.
    """
    is_surface = surface_share > 0.5
    is_green = is_surface & green
    is_candidate = is_surface & ~is_green
    share = evidence.share_around(is_candidate)
    is_building = is_candidate & (share >= min_share)
    applies = {Reason.GREEN: is_green, Reason.SURFACE: is_building, Reason.AMID_OTHERS: is_candidate}
    reasons = np.select(list(applies.values()), list(applies), Reason.ROUGH).astype(np.uint8)
    # Buildings have more than 0.5, also where ``min_share`` is 0.
    confidence = np.where(is_building, 0.5 + 0.5 * np.maximum(share, 0.02), 0.5 * share)
    return Decisions(confidence, reasons, share, min_share)


def without_green(decided: Decisions, is_green: np.ndarray) -> Decisions:
    """Refuse buildings (m,) that are as green as plants, where no returns distinguish leaves from roofs."""
    refused = decided.is_building & is_green
    reasons = np.where(refused, np.uint8(Reason.GREEN), decided.reasons)
    return Decisions(np.where(refused, 0.5, decided.confidence), reasons)


def green_clusters(
    colors: tuple[Optional[np.ndarray], ...], evidence: ClusterEvidence, is_surface: np.ndarray
) -> tuple[np.ndarray, Optional[float]]:
    """Return the mask of clusters (m,) as green as the plants of the scene, and the least such greenness.

    Parameters
    ----------
    colors : three ndarrays of shape (n,), or None
        Red, green and blue. Where one is missing, or where rough and smooth clusters are equally green, none is.
    evidence : ClusterEvidence
        The clusters among the points.
    is_surface : ndarray of shape (m,), bool
        Clusters that are smooth, as roofs are. Rough clusters and large smooth ones show the colors of plants and
        of roofs.
    """
    group, count = evidence.group, len(is_surface)
    nothing = np.zeros(count, bool)
    red, green, blue = colors
    if red is None or green is None or blue is None:
        return nothing, None
    values = greenness(red, green, blue)
    in_cluster = group >= 0
    is_large = is_surface & (evidence.areas >= _LARGE * evidence.min_area)
    rough, large = (in_cluster & np.append(of, False)[group] for of in (~is_surface, is_large))
    least = greenness_between(values[rough], values[large])
    if least is None:
        return nothing, None
    known = in_cluster & np.isfinite(values)
    share = np.bincount(group[known], values[known] > least, count)
    return share > MOST_GREEN * np.maximum(np.bincount(group[known], minlength=count), 1), least
