"""Remove crowns that look like buildings by chance: of thousands in a forest, some are smooth and closed."""

from functools import partial
from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..cloud.reasons import Reason
from ..sampling.cloud_sampling import CloudSampling
from ..sampling.kinds import LASER
from ..stage import Monitor
from .cluster_decisions import HALF_SUPPORT, support
from .reviewed_buildings import NEVER, without_gaps

# Key of the survey-wide value that says whether doubtful buildings are chance.
CHANCE = "chance_buildings"

Found = tuple[np.ndarray, np.ndarray, np.ndarray, Optional[np.ndarray], Optional[np.ndarray]]


def without_chance(
    found: Found, height: np.ndarray, least_share: float, sampling: CloudSampling, monitor: Monitor
) -> Found:
    """Remove the doubtful buildings of a scene that has no sure one, where they are few among all that is raised.

    A building is sure from 0.75 on: the confidence of one of twice the minimum area without any contrary evidence.

    Parameters
    ----------
    found : tuple
        Classes, buildings from 1 (0 if unassigned), confidences, reasons or None, of points (n,), and anything.
    height : ndarray of shape (n,)
        Heights above ground, m.
    least_share : float
        Share of the raised points that doubtful buildings must hold to stay.
    sampling : CloudSampling
        Of the cloud; of a part of a survey it says whether the doubtful buildings of the whole are chance.
    monitor : Monitor
        Receives a message with the number of removed buildings.

    Returns
    -------
    tuple
        The same, where nothing is removed; else copies, with the reason ``BY_CHANCE``.
    """
    classification, cluster_id, confidence, reason, other = found
    points = np.bincount(cluster_id, minlength=1)
    mean = np.bincount(cluster_id, np.nan_to_num(confidence), 1) / np.maximum(points, 1)
    raised = np.count_nonzero((height > LASER.raised) & (cluster_id == 0) & ~np.isin(classification, NEVER))
    points[0], mean[0] = raised, 0.0
    (is_chance,) = sampling.learned(CHANCE, lambda: np.column_stack([points, mean]), partial(_is_chance, least_share))
    # The rest of the scene is no building, with a mean confidence of 0.
    doubtful = is_chance * (mean > 0) * (mean < _sure())
    if not doubtful.any():
        return found
    monitor.inform(
        f"No building of the scene is sure (confidence {_sure():g}), so {doubtful.sum():g} doubtful ones are left out."
    )
    gone = doubtful[cluster_id] > 0
    return (
        np.where(gone, np.uint8(PointClass.UNCLASSIFIED), classification),
        without_gaps(np.where(gone, 0, cluster_id)),
        np.where(gone, np.minimum(confidence, np.float32(0.5)), confidence),
        None if reason is None else np.where(gone, np.uint8(Reason.BY_CHANCE), reason),
        other,
    )


def _is_chance(least_share: float, scene: np.ndarray) -> tuple[float]:
    """Return 1.0 where the doubtful buildings of a scene are chance, 0.0 where not.

    ``scene`` (k, 2) has the points and the mean confidence of each building, and of all else that is raised, with 0.
    """
    points, mean = scene.T
    few = points[mean > 0].sum() < least_share * points.sum()
    return (float(few and (mean < _sure()).all()),)


def _sure() -> float:
    """Return the confidence from which a building is sure."""
    return float(0.5 + 0.5 * support(np.float64(HALF_SUPPORT)))
