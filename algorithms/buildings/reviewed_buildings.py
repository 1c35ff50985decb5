"""Apply the decisions of a review: the points of each building, and the outlines that stay."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..cloud.reasons import Reason
from ..geometry.groups import split_groups
from ..geometry.polygon_overlap import as_polygons, holders
from ..sampling.kinds import LASER
from ..stage import InputLayer, LayerFeatures, Monitor
from .roof_coverage import renumbered

# Attributes with a decision and its time, and the decisions.
REVIEW, REVIEWED_AT = "review", "reviewed_at"
KEPT, DELETED, CHANGED = "kept", "deleted", "changed"

REVIEWED = InputLayer(
    "reviewed",
    "Reviewed buildings",
    "Footprints of an earlier run after their review (attribute review). Buildings that were kept or changed stay as "
    "they are drawn, with their attributes; deleted ones stay away.",
    optional=True,
    advanced=True,
)

# Classes that never become building.
NEVER = (PointClass.GROUND, PointClass.WATER, PointClass.BRIDGE_DECK, *NOISE)


@dataclass(frozen=True)
class ReviewedBuildings:
    """The outlines that were decided on, those that stay before the deleted ones: rows of the layer, and rings."""

    layer: LayerFeatures
    rows: list[int]
    stay: int  #: How many of them stay

    @classmethod
    def of(cls, layer: Optional[LayerFeatures]) -> Optional[ReviewedBuildings]:
        """Return the decisions of a layer; None without a layer, or without decisions.

        Raises
        ------
        ValueError
            If the layer has no attribute for them.
        """
        if layer is None:
            return None
        if REVIEW not in layer.columns:
            raise ValueError(f"{REVIEWED.title} have no attribute {REVIEW!r}; choose footprints that were reviewed.")
        decided = list(enumerate(layer.columns[REVIEW]))
        staying = [row for row, decision in decided if decision in (KEPT, CHANGED)]
        rows = [*staying, *(row for row, decision in decided if decision == DELETED)]
        return cls(layer, rows, len(staying)) if rows else None

    @property
    def outlines(self) -> list:
        """Rings of the outlines, in the order of the rows."""
        return [self.layer.geometries[row] for row in self.rows]

    def decide(self, xyz: np.ndarray, height: np.ndarray, found: tuple, monitor: Monitor) -> tuple:
        """Return classes, buildings, confidences and reasons, (n,) each, as decided.

        Where an outline stays and a building was found in it, its points stay what they are, trees over it among them.

        Parameters
        ----------
        xyz : ndarray of shape (n, 3)
            Coordinates, m.
        height : ndarray of shape (n,)
            Heights above ground, m.
        found : tuple of four ndarrays of shape (n,)
            The values before the decisions; confidences and reasons may be None.
        monitor : Monitor
            Receives progress.
        """
        classification, cluster_id, confidence, reason = found
        owner = self._owners(xyz, cluster_id, monitor)
        is_building = classification == PointClass.BUILDING
        may = (owner >= 0) & (height > LASER.foot) & ~np.isin(classification, NEVER)
        raised, found = (np.bincount(owner[of], minlength=len(self.rows)) for of in (may, may & is_building))
        # On fifteen clouds, trees over a building left it at least a quarter of the points.
        becomes = np.flatnonzero(may & (owner < self.stay) & ~is_building & (4 * found < raised)[owner])
        ceases = np.flatnonzero(is_building & (owner >= self.stay))
        # Deleted buildings keep their number until outlines are drawn, so that their neighbors are drawn as before.
        number = cluster_id.copy()
        number[becomes] = cluster_id.max(initial=0) + 1 + owner[becomes]
        return (
            with_changed(classification, PointClass.BUILDING, becomes, PointClass.UNCLASSIFIED, ceases),
            without_gaps(number),
            None if confidence is None else with_changed(confidence, 1.0, becomes, 0.0, ceases),
            None if reason is None else with_changed(reason, Reason.KEPT, becomes, Reason.DELETED, ceases),
        )

    def _owners(self, xyz: np.ndarray, building: np.ndarray, monitor: Monitor) -> np.ndarray:
        """Return the index (n,), int64, of the outline that each point belongs to; -1 without one.

        It is the outline around the point, or else around most of the points of its ``building`` (n,), from 1; 0 if
        unassigned.
        """
        around = holders(xyz[:, :2], as_polygons(self.outlines), monitor)
        of_building = np.full(int(building.max(initial=0)) + 1, -1)
        for number, points in enumerate(split_groups(building, len(of_building))[1:], start=1):
            own, count = np.unique(around[points], return_counts=True)
            of_building[number] = own[count.argmax()] if 2 * count.max(initial=0) > len(points) else -1
        return np.where(around < 0, of_building[building], around)


def with_changed(values: np.ndarray, first: Any, becomes: np.ndarray, second: Any, ceases: np.ndarray) -> np.ndarray:
    """Return a copy of values of points, changed where these become building and where they cease to be.

    Parameters
    ----------
    values : ndarray of shape (n,)
        Values of all points.
    first, second : object
        New values, of the former and of the latter.
    becomes, ceases : ndarray of int, shape (k,), (m,)
        Rows of the former and of the latter.
    """
    changed = values.copy()
    changed[becomes], changed[ceases] = first, second
    return changed


def without_gaps(cluster_id: np.ndarray) -> np.ndarray:
    """Return the numbers (n,), int32, of buildings without gaps, in their order; 0 if unassigned."""
    return renumbered(np.bincount(cluster_id) > 0)[cluster_id]
