"""The weakest evidence on a cluster, nearest to its limit or furthest beyond it: why a building is doubtful."""

from __future__ import annotations

from typing import NamedTuple, Optional

import numpy as np

from ..cloud.reasons import Evidence, packed_evidence
from .cluster_decisions import HALF_SUPPORT, Decisions, support
from .cluster_entropies import ClusterEntropies
from .entropy_split import Split


class _Measured(NamedTuple):
    """One kind of evidence: values (m,), the limit, and how far inside it (m,) they are: 1 certainly, below 0 not."""

    kind: Evidence
    value: np.ndarray
    limit: float
    margin: np.ndarray


def weakest_evidence(
    entropies: ClusterEntropies,
    smallest: float,
    split: Optional[Split] = None,
    penetration: Optional[np.ndarray] = None,
    max_penetration: float = np.nan,
    decided: Optional[Decisions] = None,
) -> np.ndarray:
    """Return the evidence (m,), packed, that is nearest to its limit for each cluster.

    Parameters
    ----------
    entropies : ClusterEntropies
        Sizes and mean entropies of the clusters.
    smallest : float
        Points of the smallest building.
    split : Split, optional
        The two means, where entropy decides.
    penetration : ndarray of shape (m,), optional
        Share of the beam that passes, where it decides.
    max_penetration : float
        Its limit.
    decided : Decisions, optional
        What was decided, with the shares of buildings around.

    Returns
    -------
    ndarray of shape (m,), uint32
        See :func:`~..cloud.reasons.packed_evidence`.
    """
    size = entropies.sizes / smallest
    found = [_Measured(Evidence.POINTS, entropies.sizes, HALF_SUPPORT * smallest, support(size))]
    if split is not None:
        middle, margin = (split.building + split.other) / 2, 2 * split.confidence(entropies.means) - 1
        found.append(_Measured(Evidence.ENTROPY, entropies.means, middle, margin))
    if penetration is not None:
        found.append(_Measured(Evidence.PENETRATION, penetration, max_penetration, 1 - penetration / max_penetration))
    if decided is not None and decided.around is not None:
        share, least = decided.around, decided.least_around
        found.append(_Measured(Evidence.SURROUNDINGS, share, least, (share - least) / max(1 - least, 1e-9)))
    # Ignore unknown margins.
    margins = np.array([np.where(np.isfinite(one.margin), one.margin, np.inf) for one in found])
    weakest, clusters = margins.argmin(axis=0), np.arange(margins.shape[1])
    kind, limit = (np.array([one[part] for one in found])[weakest] for part in (0, 2))
    return packed_evidence(kind, np.array([one.value for one in found])[weakest, clusters], limit)
