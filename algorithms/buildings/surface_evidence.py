"""Evidence on clusters without returns: planar surfaces next to others of their kind, and greenness."""

from typing import Optional

import numpy as np

from ..cloud.reasons import Reason
from .cluster_decisions import Decisions
from .cluster_evidence import ClusterEvidence

# Surfaces larger than this (minimum building areas) give the colors of roofs, as smooth parts of crowns are smaller.
_LARGE = 10.0

# Darker than this share of the median brightness, color is noise of the camera.
_DARK = 0.1

# Least share of leaves above the threshold and of roofs below it, and of a cluster's points above it if it is green.
MOST_GREEN = 2 / 3


def decide_in_images(surfaces: np.ndarray, green: np.ndarray, evidence: ClusterEvidence, min_share: float) -> Decisions:
    """Decide on clusters of the surface seen from above.

    Parameters
    ----------
    surfaces : ndarray of shape (m,)
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
    is_surface = surfaces > 0.5
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


def greenness(red: np.ndarray, green: np.ndarray, blue: np.ndarray) -> np.ndarray:
    """Return the normalized excess green (n,), float64, of colors (n,): (2 G - R - B) / (R + G + B).

    From -1 to 2, 0 for gray; NaN for points that are nearly black. Shadow takes about the same share of all three and
    changes it little.

    References
    ----------
    Woebbecke, D. M., Meyer, G. E., Von Bargen, K., Mortensen, D. A., 1995. Color indices for weed identification under
    various soil, residue, and lighting conditions. Transactions of the ASAE 38(1), 259-269. [woebbecke1995]
    """
    r, g, b = (np.asarray(band, float) for band in (red, green, blue))
    total = r + g + b
    bright = total > _DARK * np.median(total) if len(total) else np.zeros(0, bool)
    return np.divide(2 * g - r - b, total, out=np.full(len(total), np.nan), where=bright)


def greenness_between(plants: np.ndarray, roofs: np.ndarray) -> Optional[float]:
    """Return the greenness that separates points known by their shape; None where it does not separate them.

    ``plants`` (n,) are points most of which are leaves, ``roofs`` (m,) points most of which are roofs; NaN where
    unknown. It is the middle between the two medians, so that dry crowns, hardly green, are distinguished from roofs,
    too.
    """
    plants, roofs = (values[np.isfinite(values)] for values in (plants, roofs))
    if not len(plants) or not len(roofs):
        return None
    # Gray to red materials are no plants.
    least = max(0.0, float(np.median(plants) + np.median(roofs)) / 2)
    return least if np.mean(plants > least) - np.mean(roofs > least) >= 2 * MOST_GREEN - 1 else None
