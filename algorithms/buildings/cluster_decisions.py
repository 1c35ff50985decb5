"""Decisions on clusters: confidence, reason and weakest evidence, first by entropy, finally written to the points."""

from dataclasses import dataclass
from typing import Any, NamedTuple, Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..cloud.reasons import Evidence, Reason, packed_evidence
from ..geometry.groups import placed
from ..stage import Monitor, Report
from .cluster_entropies import ClusterEntropies
from .cluster_report import Clusters, build_report
from .entropy_split import Split

# The confidence above 0.5 is halved for a cluster with this many times the points of the smallest building, as a car of
# that size can look like a roof. It affects the confidence only, no decision.
HALF_SUPPORT = 2.0


@dataclass(frozen=True)
class Decisions:
    """The confidence (m,) that each cluster is a building, more than 0.5 if it is called one, and the reason (m,).

    ``around`` is the share (m,) of building points around it, where that decides, and ``least_around`` its limit.
    """

    confidence: np.ndarray
    reasons: np.ndarray
    around: Optional[np.ndarray] = None
    least_around: float = np.nan

    @property
    def is_building(self) -> np.ndarray:
        """Which clusters (m,) are called buildings."""
        return self.confidence > 0.5


def decide_by_entropy(means: np.ndarray, split: Split) -> Decisions:
    """Decide on clusters by their mean entropies (m,) alone."""
    confidence = split.confidence(means)
    undefined = ~np.isfinite(means)
    by_mean = np.where(confidence > 0.5, Reason.PLANE, Reason.ROUGH) if split.separates else Reason.ALIKE
    reasons = np.where(undefined, Reason.WITHOUT_ENTROPY, by_mean)
    return Decisions(np.where(undefined, 0.5, confidence), reasons.astype(np.uint8))


def written_to_points(
    classification: np.ndarray,
    reason: Optional[np.ndarray],
    entropies: ClusterEntropies,
    decisions: Decisions,
    weakest: np.ndarray,
    smallest: float,
    report: Report,
) -> tuple[Any, ...]:
    """Return the results of a stage that classifies buildings.

    That is class, entropy, mean entropy, confidence, reason and weakest evidence of its cluster for each point, and
    the report.

    Parameters
    ----------
    classification : ndarray of shape (n,), uint8
        ASPRS classes.
    reason : ndarray of shape (n,), uint8, optional
        Reasons that the segmentation gave to points outside the clusters, which they keep.
    entropies : ClusterEntropies
        Entropies of the clustered points, and the clusters.
    decisions : Decisions
        Decisions on the clusters.
    weakest : ndarray of shape (m,), uint32
        The weakest evidence on each cluster.
    smallest : float
        Points of the smallest building.
    report : Report
        Returned last.
    """
    sure = 0.5 + (decisions.confidence - 0.5) * support(entropies.sizes / smallest)
    confidence = np.where(decisions.is_building, sure, decisions.confidence)
    rows, position = entropies.rows, entropies.position
    classes, why = _without_buildings(classification, reason)
    classes[rows[decisions.is_building[position]]] = PointClass.BUILDING
    why[rows] = decisions.reasons[position]
    per_point = np.float32((entropies.values, entropies.means[position], confidence[position]))
    measures = (placed(values, rows, len(classes), np.nan) for values in per_point)
    return classes, *measures, why, placed(weakest[position].astype(np.uint32), rows, len(classes)), report


def no_clusters(classification: np.ndarray, reason: Optional[np.ndarray], monitor: Monitor) -> tuple[Any, ...]:
    """Return the results of a stage that classifies buildings where there are no clusters."""
    monitor.none_found("There are no clusters, so no buildings were found.")
    classes, why = _without_buildings(classification, reason)
    undefined = (np.full(len(classes), np.nan, np.float32) for _ in range(3))
    report = build_report(Clusters(np.zeros(0), np.zeros(0, np.uint8), Split(np.nan, np.nan)))
    return classes, *undefined, why, np.zeros(len(classes), np.uint32), report


def support(size: np.ndarray) -> np.ndarray:
    """Return the sureness (0 to 1) of clusters with ``size`` (m,) times the points of the smallest building."""
    return size**2 / (size**2 + HALF_SUPPORT**2)


def _without_buildings(classification: np.ndarray, reason: Optional[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return the classes with earlier buildings unclassified, and the reasons of earlier steps."""
    classes = np.where(classification == PointClass.BUILDING, np.uint8(PointClass.UNCLASSIFIED), classification)
    why = np.zeros(len(classes), np.uint8) if reason is None else reason.astype(np.uint8)
    return classes.astype(np.uint8), why


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
    found = [_Measured(Evidence.POINTS, entropies.sizes, HALF_SUPPORT * smallest, support(entropies.sizes / smallest))]
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
