"""Outcome for each building of a map, and the points that decide on it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..criteria import MAJORITY
from ..footprints.footprint_points import by_easting
from ..geometry.groups import components, split_groups
from ..geometry.polygon_overlap import as_polygons, meeting_boxes
from ..packages import spatial
from ..report.charts import BLUE, CYAN, GRAY, GREEN, PURPLE, RED, YELLOW
from ..rules import rules
from ..sampling.cloud_sampling import CloudSampling
from ..stage import Field, Monitor
from .building_maps import BuildingMap, measure_overlap
from .map_fit import MapFit, in_frame

UNCHANGED, MOVED, CHANGED = "unchanged", "moved", "changed"
HEIGHTENED, LOWERED = "heightened", "lowered"
NEW, GONE, UNSEEN, DOUBTFUL = "new", "gone", "not seen", "doubtful"

COLORS = {UNCHANGED: BLUE, MOVED: CYAN, CHANGED: PURPLE, HEIGHTENED: GREEN, LOWERED: "#ccbb44", NEW: RED}
COLORS.update({GONE: YELLOW, UNSEEN: GRAY, DOUBTFUL: "#222"})

STATUS = Field(
    "status",
    str,
    f"{UNCHANGED}; {MOVED}: misdrawn as a whole; {CHANGED}: parts added or cut; {HEIGHTENED}, {LOWERED}: "
    f"since the earlier survey; {NEW}; {UNSEEN}: no points; "
    f"{DOUBTFUL}: kept as it was, though the points don't show it well",
)

# Whether a label is of an old building or of a new outline.
OLD, BUILT = "old", "built"

# Which building is meant: old or built, and the row of the building or outline.
Label = tuple[str, int]


# Fields of an update that decisions are made in: arrays by row, and what was drawn.
_DECIDED = ("status", "confidence", "added", "removed", "rise", "drawn")


@rules
class RULES:
    """How changes are distinguished from errors of the map and of the survey."""

    step: float = 0.25  #: Step of the lattice on which both maps are compared, m: finer than any change
    gone: float = 0.15  #: Share of a building up to which the new outlines may cover one that is gone
    strip: float = 1.5  #: Depth of a strip along the wall of a row, in widths of a change
    side: float = 0.5  #: Share of the longest border of a part from which another building may own it
    low: float = 1.0  #: Points up to this height (m) above the ground nearest to them show that no roof is there
    rise: float = 1.0  #: Roofs that rose or fell by more in the median (m) were heightened or lowered
    reach: float = 2.0  #: Points show the surroundings up to this multiple of their distance


@dataclass
class MapUpdate:
    """Both maps, and the outcome for each building: arrays (n,) by the rows of the old map."""

    rings: list  #: Rings of the old buildings, shifted where they were misdrawn
    outlines: list  #: Rings of the new outlines as the map would draw them
    covered: list[list[int]]  #: For each new outline the rows of the old buildings that it overlaps
    is_new: np.ndarray  #: (k,), bool: new outlines that are of no old building
    status: np.ndarray  #: (n,), object: str
    confidence: np.ndarray
    added: np.ndarray
    removed: np.ndarray
    shift: np.ndarray  #: (n, 2), m
    rise: np.ndarray  #: (n,), m: rise of the roof since the earlier survey, NaN where unknown
    #: Polygons of changed and new buildings, none where all fail
    drawn: dict[Label, list] = field(default_factory=dict)

    @classmethod
    def of(cls, old: BuildingMap, new: BuildingMap, fit: MapFit) -> MapUpdate:
        """Return the two maps before anything is decided."""
        rings = [[ring + by for ring in own] if by.any() else own for own, by in zip(old.rings, fit.moved)]
        outlines = in_frame(new, fit)
        n, k = len(rings), len(outlines)
        shifted, framed = (BuildingMap(one, [], np.arange(len(one))) for one in (rings, outlines))
        overlap = measure_overlap(shifted, framed, np.zeros(2), Monitor())
        touching = split_groups(np.where(overlap.shared > 0, overlap.other, -1), k)
        is_other = np.bincount(overlap.other, overlap.shared > MAJORITY * overlap.area[overlap.one], k)
        is_new = (overlap.other_covered < MAJORITY) & (is_other == 0)
        status = np.where(fit.moved.any(axis=1), MOVED, UNCHANGED).astype(object)
        covered = [overlap.one[rows].tolist() for rows in touching]
        zero, unknown = np.zeros(n), np.full(n, np.nan)
        return cls(rings, outlines, covered, is_new, status, zero, zero.copy(), zero.copy(), fit.moved, unknown)

    @property
    def is_same(self) -> list[bool]:
        """Which old buildings have the outline that the map has."""
        return [status not in (MOVED, CHANGED) for status in self.status]

    @property
    def undrawn(self) -> int:
        """New buildings that could not be drawn."""
        return sum(kind == BUILT and not polygons for (kind, _), polygons in self.drawn.items())

    @property
    def built(self) -> list[tuple[int, list]]:
        """The new buildings: row of the outline, and rings."""
        return [(row, rings) for (kind, row), own in self.drawn.items() if kind == BUILT for rings in own]

    @cached_property
    def boxes(self) -> np.ndarray:
        """Boxes (n + k, 2, 2), m, of the old buildings and of the new outlines, in that order, which numbers them."""
        return as_polygons([*self.rings, *self.outlines]).box

    def blocks(self, width: float, near: np.ndarray) -> list[tuple[list[int], list[int]]]:
        """Return the rows of old buildings and of new outlines whose boxes lie within a width (m) of each other."""
        boxes, n = self.boxes[near], len(self.rings)
        count, group = components(*meeting_boxes(boxes + np.array([[-width], [width]]), boxes), len(boxes))
        blocks = [near[rows] for rows in split_groups(group, count)]
        return [(rows[rows < n].tolist(), (rows[rows >= n] - n).tolist()) for rows in blocks]

    def copied(self) -> MapUpdate:
        """Return a copy in which other decisions can be made."""
        return replace(self, **{name: getattr(self, name).copy() for name in _DECIDED})

    def take(self, part: MapUpdate, own: np.ndarray) -> None:
        """Take the decisions of a copy on some buildings and outlines, by their numbers."""
        n, olds, numbers = len(self.rings), own[own < len(self.rings)], set(own.tolist())
        for name in _DECIDED[:-1]:
            getattr(self, name)[olds] = getattr(part, name)[olds]
        self.drawn.update({one: of for one, of in part.drawn.items() if one[1] + n * (one[0] == BUILT) in numbers})


@dataclass(frozen=True)
class SeenPoints:
    """Points in the order of their eastings, in the frame of the map."""

    xyz: np.ndarray  #: (n, 3), m
    is_low: np.ndarray  #: (n,), bool: of the ground, or near it and of no building
    spacing: float  #: Mean distance of neighboring points, m

    @classmethod
    def of(cls, xyz: np.ndarray, classification: np.ndarray, fit: MapFit, sampling: CloudSampling) -> SeenPoints:
        """Return the points of a cloud, shifted as the map is."""
        order = np.argsort(xyz[:, 0], kind="stable")
        xyz, classification = xyz[order], classification[order]
        ground = xyz[classification == PointClass.GROUND]
        is_low = np.isin(classification, (PointClass.GROUND, PointClass.WATER, PointClass.ROAD_SURFACE))
        rest = np.flatnonzero(np.isin(classification, (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED)))
        if len(ground):
            _, nearest = spatial.cKDTree(ground[:, :2]).query(xyz[rest, :2])
            is_low[rest] = xyz[rest, 2] <= ground[nearest, 2] + RULES.low
        return cls(xyz - np.append(fit.shift, 0.0), is_low, sampling.spacing)


def roof_points(xyz: np.ndarray, kinds: np.ndarray, fit: MapFit) -> np.ndarray:
    """Return the points (k, 3), m, that may be of roofs by their classes (n,), by easting, in the frame of the map."""
    is_roof = kinds == PointClass.BUILDING
    return by_easting(xyz[is_roof if is_roof.any() else ~np.isin(kinds, NOISE)]) - np.append(fit.shift, 0.0)
