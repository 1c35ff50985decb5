"""Layers of buildings that are compared: their usable polygons, what they share, and what another map shows."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..criteria import MICROMETER
from ..geometry.grid import plan_box
from ..geometry.polygon_overlap import Polygons, as_polygons, overlaps, shared_areas
from ..geometry.rings import sampled_rings, signed_area
from ..packages import spatial
from ..stage import LayerFeatures, Monitor, feature_names

# Footprints and a map farther apart than this (m) show different areas, even if both are incomplete.
_ELSEWHERE = 1000.0

# Surroundings (m) of a building: a wide street or a small park. A map covers the area within them, and what lies in
# them decides on the building; no part that is added to it reaches farther.
AROUND = 50.0


@dataclass(frozen=True)
class BuildingMap:
    """The usable polygons of a layer."""

    rings: list  #: Rings (m, 2) of each, m, the exterior first
    names: list[str]  #: What they are called
    rows: np.ndarray  #: (n,), int64: their positions in the layer

    @cached_property
    def polygons(self) -> Polygons:
        """The same as edges."""
        return as_polygons(self.rings)

    @cached_property
    def area(self) -> np.ndarray:
        """Area (n,) of each, m²."""
        return np.maximum(self.polygons.area, MICROMETER)

    def only(self, kept: np.ndarray) -> BuildingMap:
        """Return the map of some of the polygons (n,), bool."""
        rows = np.flatnonzero(kept).tolist()
        return BuildingMap([self.rings[row] for row in rows], [self.names[row] for row in rows], self.rows[rows])

    def __add__(self, other: BuildingMap) -> BuildingMap:
        """Return the polygons of both maps, the other map's last."""
        return BuildingMap(self.rings + other.rings, self.names + other.names, np.append(self.rows, other.rows))

    def shows(self, other: BuildingMap) -> np.ndarray:
        """Return the mask of buildings (n,) of another map in the area that this one shows.

        They overlap a building of it, or lie within the convex hull of its outlines around them: seen from their
        middle, these leave no gap of half a turn.
        """
        inside = measure_overlap(self, other, np.zeros(2), Monitor()).other_covered > 0
        rest = np.flatnonzero(~inside)
        if not len(rest) or not self.rings:
            return inside
        # Positions every 2 m, which no building is narrower than.
        outlines = sampled_rings([ring for rings in self.rings for ring in rings[:1]], 2.0)
        middles = np.array([plan_box(other.rings[row][0]).sum(axis=0) / 2 for row in rest])
        for row, middle, near in zip(rest, middles, spatial.cKDTree(outlines).query_ball_point(middles, AROUND)):
            angles = np.sort(np.arctan2(*(outlines[near] - middle).T))
            gaps = np.diff(angles, append=angles[:1] + 2 * np.pi)
            inside[row] = len(near) > 0 and gaps.max() < np.pi
        return inside

    def holds(self, other: BuildingMap) -> np.ndarray:
        """Return the mask of buildings (n,) of another map with half of their area within these polygons."""
        return measure_overlap(self, other, np.zeros(2), Monitor()).other_covered >= rounded_down(0.5)


def clean_map(features: LayerFeatures, called: str, monitor: Monitor) -> BuildingMap:
    """Return the polygons of a layer that have an area; say how many don't, and how many cross themselves."""
    names = feature_names(features)
    proper = [_proper(rings) for rings in features.geometries]
    usable = [row for row, rings in enumerate(proper) if rings]
    if len(usable) < len(features):
        monitor.warn(f"{len(features) - len(usable)} of {len(features)} {called} have no area and were left out.")
    found = BuildingMap([proper[row] for row in usable], [names[row] for row in usable], np.array(usable, np.int64))
    polygons, every = found.polygons, np.arange(len(usable))
    # Where rings wind twice, or the wrong way, the overlap of a polygon with itself differs from its area.
    own = shared_areas(polygons, polygons, every, every, Monitor())
    n_crossing = int((np.abs(own - polygons.area) > 0.01 * polygons.area).sum())
    if n_crossing:
        monitor.warn(
            f"{n_crossing} of {len(features)} {called} cross themselves, so that their areas may be wrong; "
            "run 'Fix geometries' on the layer first."
        )
    return found


def refuse_apart(old: BuildingMap, new: BuildingMap, called: str, other: str) -> None:
    """Refuse two maps that lie far from each other.

    Parameters
    ----------
    old : BuildingMap
        One map.
    new : BuildingMap
        The other map.
    called : str
        Name of the one in the message.
    other : str
        Name of the other in the message.

    Raises
    ------
    ValueError
        If they lie more than a kilometer apart.
    """
    if not old.rings or not new.rings:
        return
    boxes = [plan_box(np.concatenate([rings[0] for rings in one.rings])) for one in (old, new)]
    (low, high), (other_low, other_high) = boxes
    apart = float(np.hypot(*np.maximum(0.0, np.maximum(low - other_high, other_low - high))))
    if apart > _ELSEWHERE:
        raise ValueError(
            f"The {called} and the {other} lie {apart / 1000:,.0f} km apart; "
            "choose a map of this area, or check the coordinate reference systems of both."
        )


def _proper(rings: list) -> list:
    """Return the rings in plan that have an area, none without an exterior."""
    plan = [np.asarray(ring, float)[:, :2] for ring in rings]
    sound = [len(ring) > 3 and np.isfinite(ring).all() and abs(signed_area(ring)) > MICROMETER for ring in plan]
    return [ring for ring, is_sound in zip(plan, sound) if is_sound] if sound and sound[0] else []


@dataclass(frozen=True)
class Overlap:
    """What two layers of buildings share."""

    #: one, other, (k,), int64: pairs of buildings whose boxes meet, by the first layer, then by the second
    one: np.ndarray
    other: np.ndarray
    shared: np.ndarray  #: (k,): area that both have, m²
    #: area, other_area: Areas of all buildings of the two layers, m²
    area: np.ndarray
    other_area: np.ndarray

    @property
    def covered(self) -> np.ndarray:
        """Share (0 to 1) of each building of the first layer that the second one has too."""
        return np.minimum(np.bincount(self.one, self.shared, len(self.area)) / self.area, 1.0)

    @property
    def other_covered(self) -> np.ndarray:
        """Share (0 to 1) of each building of the second layer that the first one has too."""
        return self.other_covered_by(np.ones(len(self.area)))

    def other_covered_by(self, chosen: np.ndarray) -> np.ndarray:
        """Return the share (0 to 1) of each building of the second layer that chosen ones (n,) of the first share."""
        shared = np.bincount(self.other, self.shared * chosen[self.one], len(self.other_area))
        return np.minimum(shared / self.other_area, 1.0)

    @property
    def of_smaller(self) -> np.ndarray:
        """Share (k,) of the smaller building of each pair that both have."""
        return self.shared / np.minimum(self.area[self.one], self.other_area[self.other])

    @property
    def iou(self) -> np.ndarray:
        """Intersection over union (k,) of each pair."""
        return self.shared / (self.area[self.one] + self.other_area[self.other] - self.shared)

    def are_same(self, least: float) -> np.ndarray:
        """Return the mask of pairs (k,) with ``least`` of the smaller one shared and of the first one covered."""
        return (self.of_smaller >= least) & (self.covered >= least)[self.one]


def measure_overlap(first: BuildingMap, second: BuildingMap, shift: np.ndarray, monitor: Monitor) -> Overlap:
    """Return the overlaps of two layers of buildings, the first one moved by ``shift`` (2,), m.

    Parameters
    ----------
    first : BuildingMap
        Map that is moved.
    second : BuildingMap
        The other map.
    shift : ndarray of shape (2,)
        Shift of the first, m.
    monitor : Monitor
        Receives the progress.
    """
    return Overlap(*overlaps(first.polygons.moved(shift), second.polygons, monitor), first.area, second.area)


def joined_names(rows: np.ndarray, names: Iterable[str], count: int) -> list[str]:
    """Return, for each of ``count`` buildings, the names (k,) at its number in ``rows`` (k,), separated by commas."""
    of_each: list[list[str]] = [[] for _ in range(count)]
    for row, name in zip(rows.tolist(), names):
        of_each[row].append(name)
    return [", ".join(one) for one in of_each]


def rounded_down(share: float) -> float:
    """Return a least share (0 to 1) that an overlap of exactly this share reaches in spite of rounding."""
    return share * (1 - 1e-9)
