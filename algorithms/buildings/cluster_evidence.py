"""Evidence on clusters other than entropy: penetration by the beam, adjacent clusters, surroundings."""

from dataclasses import dataclass
from functools import cached_property
from typing import Optional

import numpy as np

from ..cloud.reasons import Reason
from ..geometry.groups import placed
from ..sampling.kinds import SCENE
from ..segmentation.cluster_measures import adjacent_groups, non_last_share, penetration, plan_areas, share_around
from .cluster_decisions import Decisions

# Planar clusters with up to this share of points that are not last returns may be edges of roofs, where some pulses
# split.
_SPLIT_AT_EDGES = 0.3


@dataclass(frozen=True)
class ClusterEvidence:
    """Clusters (m,) among all points (n,) of a cloud."""

    xyz: np.ndarray  #: (n, 3), float64: coordinates (m)
    group: np.ndarray  #: (n,), int: cluster of each point from 0, negative for none
    numbers: np.ndarray  #: (m,), int: the clusters that have points, ascending
    density: float  #: Points per square meter
    min_area: float  #: Area of the smallest building, m²
    goes_on: Optional[np.ndarray]  #: (n,), bool: whether the pulse of each went on; None where none has several returns

    @cached_property
    def areas(self) -> np.ndarray:
        """The area (m,) of each cluster in plan, m²."""
        member = self.group >= 0
        return plan_areas(self.xyz[member], self.group[member], self.density)[self.numbers]

    def penetration(self) -> np.ndarray:
        """Return the share (m,) of the beam that passes through each cluster."""
        return penetration(self.xyz, self.group, self.density, self.goes_on)[self.numbers]

    def non_last_return_share(self) -> np.ndarray:
        """Return the share (m,) of each cluster's points that are not the last return of their pulse."""
        return non_last_share(self.group, self.goes_on)[self.numbers]

    def share_around(self, is_chosen: np.ndarray) -> np.ndarray:
        """Return the share (m,) of the points around each cluster that belong to the chosen clusters (m,)."""
        return share_around(self.xyz, self.group, self._by_number(is_chosen))[self.numbers]

    def with_adjacent(self, is_solid: np.ndarray, is_plane: np.ndarray) -> np.ndarray:
        """Return the solid clusters (m,) of a building's size, and adjacent ones that are solid or plane."""
        strong, chosen = is_solid & (self.areas >= self.min_area), is_solid | is_plane
        joined = self.adjacent(chosen)
        return chosen & np.isin(joined, joined[strong])

    def adjacent(self, is_chosen: np.ndarray) -> np.ndarray:
        """Return a number (m,) for each cluster, the same for those chosen (m,) that are adjacent, as of a building."""
        return adjacent_groups(self.xyz, self.group, self._by_number(is_chosen), self.density)[self.numbers]

    def mean_of_buildings(self, values: np.ndarray, building: np.ndarray) -> np.ndarray:
        """Return the mean of values (m,) over the points of all clusters with the same number ``building`` (m,)."""
        points = np.bincount(self.group[self.group >= 0])[self.numbers]
        return (np.bincount(building, points * values) / np.maximum(np.bincount(building, points), 1))[building]

    def _by_number(self, mask: np.ndarray) -> np.ndarray:
        """Return a mask of the clusters as one of all numbers, False for numbers without points."""
        return placed(mask, self.numbers, int(self.numbers[-1]) + 1)


def with_penetration(by_entropy: Decisions, through: np.ndarray, limit: float, evidence: ClusterEvidence) -> Decisions:
    """Decide by entropy and by the penetration ``through`` (m,) of each cluster.

    Parameters
    ----------
    by_entropy : Decisions
        What entropy decided.
    through : ndarray of shape (m,)
        Share of pulses that pass each cluster.
    limit : float
        Share above which a cluster is no building.
    evidence : ClusterEvidence
        The clusters.

    Returns
    -------
    Decisions
        Confidence of each cluster, above 0.5 for buildings, and the reason.
    """
    confidence = by_entropy.confidence
    undefined = by_entropy.reasons == Reason.WITHOUT_ENTROPY
    is_planar = (confidence > 0.5) & ~undefined
    # A cluster without entropy stays undecided, however solid it is.
    both = np.where(undefined, 0.5, _with_solidity(confidence, through, limit))
    is_solid = both > 0.5
    is_building = evidence.with_adjacent(is_solid, is_planar & (evidence.non_last_return_share() < _SPLIT_AT_EDGES))
    # The first that applies is the reason.
    applies = {
        Reason.WITHOUT_ENTROPY: undefined,
        Reason.SOLID_PLANE: is_building & is_solid & is_planar,
        Reason.SOLID: is_building & is_solid,
        Reason.NEXT_TO_BUILDINGS: is_building,
        Reason.TOO_SMALL: is_solid,
        Reason.PENETRATED: is_planar,
    }
    reasons = np.select(list(applies.values()), list(applies), Reason.ROUGH).astype(np.uint8)
    return Decisions(np.where(is_building, np.where(is_solid, both, confidence), np.minimum(both, 0.5)), reasons)


def with_surroundings(decided: Decisions, min_share: float, evidence: ClusterEvidence) -> Decisions:
    """Decide again, given the share of building points around each cluster and around each whole building.

    In a forest, spots of crowns that are smooth by chance lie next to each other and pass for surroundings of
    buildings, but none of them is sure. So the share around a whole building is multiplied by its mean confidence,
    unless the building is so large that ground would show between trees.
    """
    around = evidence.share_around(decided.is_building)
    is_building = decided.is_building & (around >= min_share)
    building = evidence.adjacent(is_building)
    sure = evidence.mean_of_buildings(decided.confidence, building)
    sure *= evidence.mean_of_buildings(evidence.share_around(is_building), building)
    is_large = np.bincount(building, evidence.areas)[building] >= np.pi * SCENE.ground_within**2
    amid_others = decided.is_building & ~(is_building & (is_large | (sure >= min_share)))
    reasons = np.where(amid_others, Reason.AMID_OTHERS, decided.reasons)
    return Decisions(np.where(amid_others, 0.5, decided.confidence), reasons.astype(np.uint8), around, min_share)


def _with_solidity(confidence: np.ndarray, through: np.ndarray, max_penetration: float) -> np.ndarray:
    """Return the geometric mean of the entropy's confidence and of solidity, 0 at twice the penetration allowed."""
    solid = np.clip(1 - through / (2 * max_penetration), 0, 1)
    # The mean is geometric, so that neither makes up for the other: a dense crown stops the beam and is no roof.
    both = np.sqrt(confidence * solid)
    return np.where(through <= max_penetration, both, np.minimum(both, 0.5))
