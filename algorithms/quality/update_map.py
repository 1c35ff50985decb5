"""A map of buildings kept right: what has changed since it was drawn is drawn anew, everything else stays as it is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Callable, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..footprints.extract_footprints import extract_footprints
from ..footprints.soft_shares import Lattice
from ..geometry.groups import components, split_groups
from ..geometry.points_in_polygons import are_within
from ..geometry.polygon_overlap import as_polygons, meeting_boxes
from ..geometry.rings import polygon_area, sides_of_rings
from ..models3d.model_inputs import require_ground, rows_near
from ..packages import ndimage, spatial
from ..params import MIN_BUILDING_AREA
from ..report.charts import BLUE, GRAY, RED, YELLOW
from ..report.page import Row, build_page
from ..report.polygon_map import draw_polygons
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import (
    Field,
    InputLayer,
    Layer,
    LayerFeatures,
    Measure,
    Monitor,
    Report,
    feature_names,
    stage,
    tunable,
)
from .building_maps import BuildingMap, clean_map, measure_overlap, refuse_elsewhere
from .map_drawing import draw_labels
from .map_fit import MapFit, fit_map, in_frame

UNCHANGED, MOVED, CHANGED = "unchanged", "moved", "changed"
HEIGHTENED, LOWERED = "heightened", "lowered"
NEW, GONE, UNSEEN, DOUBTFUL = "new", "gone", "not seen", "doubtful"

# Colors of the page that differ in all color visions (Tol's high-contrast and bright schemes).
COLORS = {UNCHANGED: BLUE, MOVED: "#66ccee", CHANGED: "#aa3377", HEIGHTENED: "#228833", LOWERED: "#ccbb44", NEW: RED}
COLORS.update({GONE: YELLOW, UNSEEN: GRAY, DOUBTFUL: "#222"})


@dataclass(frozen=True)
class _Rules:
    """How changes are distinguished from errors of the map and of the survey."""

    step: float = 0.25  #: Step of the lattice on which both maps are compared, m: finer than any change
    #: Least and greatest automatic width of a change, m, and the multiple of the median distance of walls that it is
    least_width: float = 1.0
    most_width: float = 4.0
    deviations: float = 3.0
    gone: float = 0.15  #: Share of a building up to which the new outlines may cover one that is gone
    there: float = 0.5  #: Share that these cover of one that is still there
    shown: float = 0.5  #: Share of an area where points must lie, or ground, for it to be seen, or to be empty
    new: float = 0.4  #: Share of new outlines up to which the map may have them for a building to be new
    strip: float = 1.5  #: Depth of a strip along the wall of a row, in widths of a change
    low: float = 1.0  #: Points up to this height (m) above the ground nearest to them show that no roof is there
    rise: float = 1.0  #: Roofs that rose or fell by more in the median (m) were heightened or lowered
    reach: float = 2.0  #: Points show the surroundings up to this multiple of their distance


RULES = _Rules()

_FIELDS = (
    Field(
        "status",
        str,
        f"{UNCHANGED}; {MOVED}: misdrawn as a whole; {CHANGED}: parts added or cut; {HEIGHTENED}, {LOWERED}: "
        f"since the earlier survey; {NEW}; {UNSEEN}: no points; "
        f"{DOUBTFUL}: kept as it was, though the points don't show it well",
    ),
    Field("confidence", float, "share of it on which map and points agree, 0 to 1"),
    Field("added", float, "area of the parts added", "m²"),
    Field("removed", float, "area of the parts cut off", "m²"),
    Field("shift_east", float, "how far it was shifted to the east", "m"),
    Field("shift_north", float, "how far it was shifted to the north", "m"),
    Field("height_change", float, "how far its roof has risen since the earlier survey, in the median", "m"),
)
_GONE_FIELDS = (Field("confidence", float, "share of it where points show the ground, 0 to 1"),)
_MEASURES = (
    Measure("old_buildings", "Buildings in the old map"),
    *(Measure(name.replace(" ", "_"), f"Buildings {name}") for name in COLORS),
    Measure("map_shift_east", "Shift of the points against the map eastward", "m"),
    Measure("map_shift_north", "Shift of the points against the map northward", "m"),
    Measure("overhang", "How far roofs reach beyond the walls of the map", "m"),
)


@stage(
    "Quality",
    tags="update,change detection,cadastre,base map,new,demolished,gone,extension,annex,shifted,maintenance,"
    "OpenStreetMap,conflation",
    input_layers=(
        InputLayer("old_map", "Old map", "Polygon", "Buildings with their attributes, from any source."),
        InputLayer(
            "footprints",
            "New footprints",
            "Polygon",
            "New outlines of buildings, from 'Detect buildings' or another source; without them they are extracted "
            "from the classified points.",
            optional=True,
        ),
    ),
    layers=(
        Layer("updated_map", "Updated map", "Polygon", _FIELDS, style="updated_map"),
        Layer("buildings_gone", "Buildings gone", "Polygon", _GONE_FIELDS),
    ),
    measures=_MEASURES,
    reference_title="Earlier point cloud",
    reference="A survey before this one, to find roofs that have risen or fallen since.",
    cost=20.0,
)
def update_map(
    xyz,
    classification,
    cluster_id=None,
    reference_xyz=None,
    reference_classification=None,
    old_map=None,
    footprints=None,
    *,
    min_area: float = MIN_BUILDING_AREA,
    least_width: Optional[float] = tunable(
        None,
        "Narrower strips that were added or removed are errors of the map or of the points.",
        within="[0.5, 20] m",
        automatic=f"{RULES.deviations:g} times the median distance between the walls of the map and the new ones, "
        f"{RULES.least_width:g} to {RULES.most_width:g} m.",
    ),
    id_field: str = tunable(
        "", "Attribute that identifies a building; new ones get new values of it. Empty: 'id' or 'fid'."
    ),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Update a map of buildings from a classified cloud: what has not changed stays as it is, with ids and attributes.

    Every building gets a status. Parts that were added or torn down are drawn along the old walls where these are still
    right. New buildings share the walls of those that they touch. Buildings that the points don't show stay.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points of class 6 are of buildings, points of class 2 are the ground.
    cluster_id : ndarray of shape (n,), optional
        Building of each point, from 1, to extract footprints.
    reference_xyz : ndarray of shape (m, 3), optional
        Coordinates (m) of the points of an earlier survey.
    reference_classification : ndarray of shape (m,), optional
        Their classes; where none has class 6, every point but noise may be of a roof.
    old_map : LayerFeatures
        Buildings of the map.
    footprints : LayerFeatures, optional
        New outlines.

    Returns
    -------
    updated_map : LayerFeatures
        The buildings of the map that are not gone, in their order, then the new ones, with the attributes of the map
        after the attributes of the update. Names that are used become ``map_…``.
    buildings_gone : LayerFeatures
        Those that are gone, with their attributes.
    report : Report
        Counts, and a page with a map.

    Raises
    ------
    ValueError
        If no point is called ground, the map has no attribute ``id_field``, or it lies over a kilometer from the new
        outlines.

    Notes
    -----
    The usual shift between the map and the new outlines, and how far these lie outside of its walls, are measured on
    all buildings and taken off the new outlines: new parts are drawn as the map draws its own. Buildings that touch
    are shifted together where all their walls lie elsewhere, by more than the others'.

    A part was added where the new outlines cover what the map does not, and removed where they don't and points show
    the ground on at least ``RULES.shown`` of it. Both are at least ``least_width`` wide and have ``min_area``. A
    building is gone if the new outlines cover at most ``RULES.gone`` of it and points show the ground on most of it.
    Where most of it has no points it was not seen. Otherwise, if the new outlines cover less than ``RULES.there`` of
    it, it is doubtful.

    Old walls, and new ones where these are farther than ``least_width`` from the line of an old one, divide the plane
    into cells. Each is of the building that most of it is to be of.

    References
    ----------
    Murakami, H., Nakagawa, K., Hasegawa, H., Shibata, T., Iwanami, E., 1999. Change detection of buildings using an
    airborne laser scanner. ISPRS Journal of Photogrammetry and Remote Sensing 54(2-3). [murakami1999]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> old = LayerFeatures([[ring], [ring + [0, 11]]], {"id": [7, 8]})
    >>> updated, gone, _ = update_map(np.column_stack([x, y, z]), np.where(z > 0, 6, 2), old_map=old)
    >>> updated.columns["id"], updated.columns["status"], gone.columns["id"]
    ([7], ['unchanged'], [8])
    """
    require_ground(classification)
    # Refuses an attribute that the map does not have.
    feature_names(old_map, id_field)
    old = clean_map(old_map, "buildings of the old map", monitor)
    if footprints is None:
        extracting = monitor.part(0.0, 0.5)
        footprints = extract_footprints(xyz, classification, cluster_id, sampling=sampling, monitor=extracting)
    new = clean_map(footprints, "new footprints", monitor)
    refuse_elsewhere(old, new, "old map", "new footprints")
    fit = fit_map(old, new)
    if least_width is None:
        least_width = float(np.clip(RULES.deviations * fit.deviation, RULES.least_width, RULES.most_width))
        monitor.resolved(least_width=least_width)
    update = _Update.of(old, new, fit)
    points = _Points.of(xyz, classification, fit, sampling)
    roofs = [_roofs(xyz, classification, fit)]
    roofs += [] if reference_xyz is None else [_roofs(reference_xyz, reference_classification, fit)]
    blocks = update.blocks(least_width)
    for number, (olds, news) in enumerate(blocks):
        _Block(update, points, olds, news, least_width, min_area).decide(roofs)
        monitor.progress(0.5 + 0.5 * (number + 1) / len(blocks))
    sure = footprints.columns.get("confidence")
    result = _Result.of(
        update, old_map, old.rows.tolist(), None if sure is None else np.array(sure)[new.rows], id_field
    )
    updated = result.layer(_FIELDS, lambda status: status != GONE)
    gone = result.layer(_GONE_FIELDS, lambda status: status == GONE)
    report = _report(update, updated, gone, fit)
    monitor.inform(_summary(report.values))
    if update.undrawn:
        monitor.warn(f"New buildings left out, as no outline fits between the buildings of the map: {update.undrawn}.")
    return updated, gone, report


@dataclass
class _Update:
    """Both maps, and what becomes of each building: arrays (n,) by the rows of the old map."""

    rings: list  #: Rings of the old buildings, shifted where they were misdrawn
    outlines: list  #: Rings of the new outlines as the map would draw them
    covered: list[dict[int, float]]  #: For each new outline the areas (m²) that it shares with old buildings, by row
    is_new: np.ndarray  #: (k,), bool: new outlines that are of no old building
    status: list[str]
    confidence: np.ndarray
    added: np.ndarray
    removed: np.ndarray
    shift: np.ndarray  #: (n, 2), m
    rise: np.ndarray  #: (n,), m: rise of the roof since the earlier survey, NaN where unknown
    drawn: dict[int, list] = field(default_factory=dict)  #: Polygons of changed buildings, by row
    undrawn: int = 0  #: New buildings that could not be drawn
    built: list[tuple[int, list]] = field(default_factory=list)  #: New buildings: row of the outline, rings

    @classmethod
    def of(cls, old: BuildingMap, new: BuildingMap, fit: MapFit) -> _Update:
        """Return the two maps before anything is decided."""
        n = len(old.rings)
        rings = [[ring + by for ring in own] if by.any() else own for own, by in zip(old.rings, fit.moved)]
        outlines = in_frame(new, fit)
        shifted, framed = (_as_map(one) for one in (rings, outlines))
        overlap = measure_overlap(shifted, framed, np.zeros(2), Monitor())
        covered: list[dict[int, float]] = [{} for _ in outlines]
        for one, other, area in zip(overlap.one.tolist(), overlap.other.tolist(), overlap.shared.tolist()):
            if area > 0:
                covered[other][one] = area
        is_other = np.bincount(overlap.other, overlap.shared > RULES.there * overlap.area[overlap.one], len(outlines))
        is_new = (overlap.other_covered <= RULES.new) & (is_other == 0)
        status = [MOVED if by.any() else UNCHANGED for by in fit.moved]
        confidence, added, removed = np.zeros((3, n))
        return cls(rings, outlines, covered, is_new, status, confidence, added, removed, fit.moved, np.full(n, np.nan))

    def blocks(self, width: float) -> list[tuple[np.ndarray, np.ndarray]]:
        """Return the rows of old buildings and of new outlines whose boxes lie within a width (m) of each other."""
        boxes = as_polygons([*self.rings, *self.outlines]).box
        pairs = meeting_boxes(boxes + np.array([[-width], [width]]), boxes)
        count, group = components(*pairs, len(boxes))
        n = len(self.rings)
        return [(rows[rows < n], rows[rows >= n] - n) for rows in split_groups(group, count)]


def _as_map(rings: list) -> BuildingMap:
    polygons = as_polygons(rings)
    return BuildingMap(rings, polygons, np.maximum(polygons.area, 1e-6), [], np.arange(len(rings)))


@dataclass(frozen=True)
class _Points:
    """Points in the order of their eastings, in the frame of the map."""

    xyz: np.ndarray  #: (n, 3), m
    is_low: np.ndarray  #: (n,), bool: of the ground, or near it and of no building
    spacing: float  #: Mean distance of neighboring points, m

    @classmethod
    def of(cls, xyz: np.ndarray, classification: np.ndarray, fit: MapFit, sampling: CloudSampling) -> _Points:
        """Return the points of a cloud, shifted as the map is."""
        order = np.argsort(xyz[:, 0], kind="stable")
        xyz, classification = xyz[order], classification[order]
        ground = xyz[classification == PointClass.GROUND]
        is_low = np.isin(classification, (PointClass.GROUND, PointClass.WATER, PointClass.ROAD_SURFACE))
        open_ = np.isin(classification, (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED))
        rest = np.flatnonzero(open_)
        _, nearest = spatial.cKDTree(ground[:, :2]).query(xyz[rest, :2])
        is_low[rest] = xyz[rest, 2] <= ground[nearest, 2] + RULES.low
        return cls(xyz - np.append(fit.shift, 0.0), is_low, sampling.spacing)


def _roofs(xyz: np.ndarray, classification: Optional[np.ndarray], fit: MapFit) -> np.ndarray:
    """Return the points (k, 3), m, that may be of roofs in the order of their eastings, in the frame of the map."""
    kinds = np.zeros(len(xyz)) if classification is None else classification
    is_roof = kinds == PointClass.BUILDING
    own = xyz[is_roof if is_roof.any() else ~np.isin(kinds, NOISE)]
    return own[np.argsort(own[:, 0], kind="stable")] - np.append(fit.shift, 0.0)


class _Block:
    """Old buildings and new outlines that lie together, on a lattice; the decisions go into the update."""

    def __init__(
        self, update: _Update, points: _Points, olds: np.ndarray, news: np.ndarray, width: float, min_area: float
    ) -> None:
        self.update, self.width, self.min_area = update, width, min_area
        self.olds, self.news = olds.tolist(), news.tolist()
        corners = [update.rings[row][0] for row in self.olds] + [update.outlines[row][0] for row in self.news]
        low, high = (
            np.min([ring.min(axis=0) for ring in corners], axis=0),
            np.max([ring.max(axis=0) for ring in corners], axis=0),
        )
        self.lattice = Lattice.around(np.array([low - 2 * width, high + 2 * width]), 2 * RULES.step)
        self.old, self.own = self._painted(self.olds, update.rings)
        self.new, _ = self._painted(self.news, update.outlines)
        self.box = [np.array([low - 2 * width, high + 2 * width])]
        near = rows_near(points.xyz, self.box)
        reach = max(RULES.reach * points.spacing, RULES.step)
        self.is_seen = self._around(points.xyz[near], reach)
        self.is_low = self._around(points.xyz[near[points.is_low[near]]], reach)

    def _painted(self, rows: list[int], polygons: list) -> tuple[np.ndarray, dict[int, tuple]]:
        """Return the polygon of each node by row, -1 without one, and the window and the mask of each."""
        painted, masks = np.full(self.lattice.shape, -1), {}
        for row in rows:
            rings = polygons[row]
            box = self.lattice.nodes(np.array([rings[0].min(axis=0), rings[0].max(axis=0)]))
            (west, south), (east, north) = np.floor(box[0]).astype(int), np.ceil(box[1]).astype(int) + 1
            window = slice(max(south, 0), north), slice(max(west, 0), east)
            inner = self.lattice.part(window)
            mask = are_within(inner.positions, sides_of_rings(rings)).reshape(inner.shape)
            painted[window][mask] = row
            masks[row] = window, mask
        return painted, masks

    def _around(self, xyz: np.ndarray, reach: float) -> np.ndarray:
        """Return the nodes (rows, columns), bool, within a distance (m) of points (n, 3)."""
        hit = np.zeros(self.lattice.shape, bool)
        hit[self.lattice.nearest(xyz[:, :2])] = True
        return _within(hit, reach / RULES.step)

    def decide(self, roofs: list[np.ndarray]) -> None:
        """Decide on all buildings, draw the changed and the new ones; ``roofs`` are the roof points of each survey."""
        self.wanted = np.full(self.lattice.shape, 0)
        self.labels: list[tuple[str, int]] = []
        for row in self.olds:
            self._decide_old(row)
        self._add_parts()
        self._draw()
        if len(roofs) > 1:
            self._compare_heights(*(self._surface(own[rows_near(own, self.box)]) for own in roofs))

    def _surface(self, xyz: np.ndarray) -> np.ndarray:
        """Return the highest elevation (rows, columns), m, around each node of the lattice, NaN without points."""
        top = np.full(self.lattice.shape, -np.inf)
        np.maximum.at(top, self.lattice.nearest(xyz[:, :2]), xyz[:, 2])
        top = ndimage.maximum_filter(top, round(RULES.rise / RULES.step))
        return np.where(np.isfinite(top), top, np.nan)

    def _compare_heights(self, new: np.ndarray, old: np.ndarray) -> None:
        """Measure how far the roofs that are still there have risen from one surface (rows, columns), m, to another."""
        update, risen = self.update, new - old
        for row in self.olds:
            window, mask = self.own[row]
            known = risen[window][mask & (self.new[window] >= 0) & np.isfinite(risen[window])]
            if len(known) and update.status[row] in (UNCHANGED, MOVED, CHANGED):
                update.rise[row] = by = float(np.median(known))
                if update.status[row] == UNCHANGED and abs(by) > RULES.rise:
                    update.status[row] = HEIGHTENED if by > 0 else LOWERED

    def _decide_old(self, row: int) -> None:
        """Decide whether an old building is there, and which parts of it are gone."""
        update, (window, mask) = self.update, self.own[row]
        if not mask.any():
            update.status[row] = DOUBTFUL
            return
        has_new, low, seen = (one[window][mask] for one in (self.new >= 0, self.is_low, self.is_seen))
        covered = float(has_new.mean())
        update.confidence[row] = covered
        is_empty = float((low & ~has_new).mean()) >= RULES.shown
        if covered < RULES.there and seen.mean() < RULES.shown:
            update.status[row], update.confidence[row] = UNSEEN, 0.0
        elif covered <= RULES.gone:
            update.status[row] = GONE if is_empty else DOUBTFUL
            update.confidence[row] = float(low.mean()) if is_empty else covered
        else:
            removed = self._removed(window, mask)
            if removed.any():
                self._label("old", row, window, mask & ~removed)
                update.removed[row] = removed.sum() * RULES.step**2
            elif covered < RULES.there:
                update.status[row] = DOUBTFUL

    def _removed(self, window: tuple, mask: np.ndarray) -> np.ndarray:
        """Return the nodes of a building (rows, columns), bool, that are of it no more."""
        lost = np.pad(mask & (self.new[window] < 0), 1)
        part, count = ndimage.label(_opened(lost, self.width / 2 / RULES.step)[1:-1, 1:-1])
        size = np.bincount(part.ravel(), minlength=count + 1) * RULES.step**2
        low = np.bincount(part.ravel(), self.is_low[window].ravel(), count + 1) * RULES.step**2
        is_gone = (size >= self.min_area) & (low >= RULES.shown * size)
        is_gone[0] = False
        gone, radius = is_gone[part], self.width / 2 / RULES.step
        # No strip is left along the parts cut off.
        kept = np.pad(mask & ~gone, 1)
        return gone | (kept & ~_opened(kept, radius))[1:-1, 1:-1] & _within(gone, 2 * radius)

    def _label(self, kind: str, row: int, window: tuple, mask: np.ndarray) -> None:
        """Want a building to have some nodes: an old one those that it keeps, and others that are added."""
        if (kind, row) not in self.labels:
            self.labels.append((kind, row))
        self.wanted[window][mask] = self.labels.index((kind, row)) + 1

    def _add_parts(self) -> None:
        """Find what the new outlines have and the map has not, and whose it is."""
        is_added = _opened((self.new >= 0) & (self.old < 0), self.width / 2 / RULES.step)
        part = ndimage.label(is_added)[0]
        pairs, number = np.unique(np.stack([part, self.new])[:, is_added], axis=1, return_inverse=True)
        part[is_added] = number.ravel() + 1
        parts = list(zip(ndimage.find_objects(part), pairs[1].tolist()))
        size = np.bincount(part.ravel(), minlength=len(parts) + 1)[1:] * RULES.step**2
        for number in np.argsort(-size, kind="stable")[: np.sum(size >= self.min_area)].tolist():
            window, outline = parts[number]
            kind, row = self._owner(outline, part == number + 1, size[number])
            if kind == "old":
                if ("old", row) not in self.labels:
                    self._label("old", row, *self.own[row])
                self.update.added[row] += size[number]
            self._label(kind, row, window, part[window] == number + 1)

    def _owner(self, outline: int, mask: np.ndarray, size: float) -> tuple[str, int]:
        """Return the building that a part of a new outline, with that size (m²), is of: one that it adjoins or its own.

        A part that is as large as the old building that it adjoins is a building of its own.
        """
        update = self.update
        if update.is_new[outline]:
            return "new", outline
        near, least = _within(mask, self.width / RULES.step), RULES.step**2
        may = [row for row in update.covered[outline] if update.status[row] in (UNCHANGED, MOVED)]
        may = [row for row in may if size < polygon_area(update.rings[row])]
        new = [number for number, (kind, _) in enumerate(self.labels, start=1) if kind == "new"]
        # Areas next to the part: the length of the border times the width of a change.
        old_side, row = max(((np.sum(self.old[near] == row) * least, row) for row in may), default=(0.0, -1))
        new_side, number = max(((np.sum(self.wanted[near] == one) * least, one) for one in new), default=(0.0, 0))
        # Walls of the map are known better than those that a survey has between roofs: a strip along one is the new
        # building's beyond.
        if new_side > old_side or (new_side and size < RULES.strip * old_side):
            return self.labels[number - 1]
        return ("old", row) if old_side else ("new", outline)

    def _draw(self) -> None:
        """Draw all buildings that have changed or are new, those that lie together at once."""
        stays = [row for row in self.olds if self.update.status[row] != GONE]
        is_fixed = (self.wanted == 0) & np.isin(self.old, stays)
        for kind, row in self.labels:
            if kind == "old":
                window, mask = self.own[row]
                is_fixed[window] &= ~mask
        wanted = np.where(is_fixed, -1, self.wanted)
        for labels, window, is_own in self._together(wanted):
            kind, row = self.labels[labels[0] - 1]
            is_alone = kind == "new" and not (is_own & (wanted[window] < 0)).any()
            if len(labels) > 1 or not is_alone or (self.old[self.new == row] >= 0).any():
                here = np.where(is_own | (wanted[window] <= 0), wanted[window], -1)
                drawn = self._drawn(window, here, labels, stays)
            else:
                drawn = {labels[0]: [self.update.outlines[row]]}
            for label in labels:
                self._keep(*self.labels[label - 1], drawn.get(label, []))

    def _together(self, wanted: np.ndarray) -> Iterator[tuple[list[int], tuple, np.ndarray]]:
        """Yield labels that are drawn together, the window around their nodes and which are near these, bool."""
        area, count = ndimage.label(_within(wanted > 0, self.width / RULES.step))
        there = np.unique(np.stack([area, wanted])[:, wanted > 0], axis=1)
        n_groups, group = components(there[0], count + there[1], count + len(self.labels) + 1)
        for number in np.unique(group[count + 1 :]).tolist() if n_groups else []:
            near = (group == number)[area] & (area > 0)
            window = ndimage.find_objects(near.astype(np.uint8))[0]
            yield (np.flatnonzero(group[count + 1 :] == number) + 1).tolist(), window, near[window]

    def _drawn(self, window: tuple, wanted: np.ndarray, labels: list[int], stays: list[int]) -> dict[int, list]:
        """Return the polygons of labels that lie together, along the walls of the map and of their new outlines."""
        lattice, update = self.lattice.part(window), self.update
        whose = [self.labels[label - 1] for label in labels]
        used = [row for kind, row in whose if kind == "new"]
        used += [one for one in self.news if any(("old", row) in whose for row in update.covered[one])]
        changed = [row for kind, row in whose if kind == "old"]
        around = np.array([[-self.width], [self.width]]) + lattice.positions[[0, -1]]
        here = meeting_boxes(around[None], as_polygons([update.rings[row] for row in stays]).box)[1]
        fixed = np.setdiff1d(np.array(stays, int)[here], changed).tolist()
        old, kept = ([update.rings[row] for row in rows] for rows in (changed, fixed))
        new = [update.outlines[row] for row in sorted(set(used))]
        return draw_labels(lattice, wanted, old, kept, new, self.width)

    def _keep(self, kind: str, row: int, drawn: list) -> None:
        """Take the polygons that were drawn of a building; an old one without any stays as it was."""
        update, polygons = self.update, [rings for rings in drawn if polygon_area(rings) >= self.min_area]
        if kind == "new":
            update.built += [(row, rings) for rings in polygons]
            update.undrawn += not polygons
        elif polygons:
            update.drawn[row], update.status[row] = polygons, CHANGED
        else:
            update.status[row] = DOUBTFUL


def _within(mask: np.ndarray, reach: float) -> np.ndarray:
    """Return the nodes (rows, columns), bool, within a distance (nodes) of a mask."""
    return ndimage.distance_transform_edt(~mask) <= reach if mask.any() else mask


def _opened(mask: np.ndarray, radius: float) -> np.ndarray:
    """Return the parts of a mask that a disc of a radius (nodes) reaches within it."""
    return _within(ndimage.distance_transform_edt(mask) > radius, radius)


def _new_ids(old_map: LayerFeatures, id_field: str, count: int) -> tuple[str, list]:
    """Return the attribute that identifies buildings, "" without one, and the values of it for some new buildings."""
    columns = {name.lower(): name for name in old_map.columns}
    name = id_field or columns.get("id", columns.get("fid", ""))
    values = list(old_map.columns.get(name, []))
    numbers = [value for value in values if isinstance(value, (int, float, np.number)) and np.isfinite(value)]
    if values and not numbers:
        return name, [f"new-{number}" for number in range(1, count + 1)]
    first = int(max(numbers, default=0)) + 1
    return name, list(range(first, first + count))


@dataclass(frozen=True)
class _Result:
    """All buildings: of the old map first, then the new ones."""

    polygons: list  #: Polygons of each, as rings
    sources: list  #: Its geometry as it was read, None where it is another one now
    table: dict[str, Any]  #: What was found out on each, by field
    old_map: LayerFeatures
    rows: list[int]  #: Rows of the old buildings in their layer
    new_ids: tuple[str, list]  #: Attribute that identifies buildings, and its values for the new ones

    @classmethod
    def of(cls, update: _Update, old_map: LayerFeatures, rows: list[int], sure: Any, id_field: str) -> _Result:
        """Return the result of an update; ``sure`` are the confidences of the new outlines, None if unknown."""
        new = [rings for _, rings in update.built]
        is_kept = [status not in (MOVED, CHANGED) for status in update.status]
        outlines = [old_map.geometries[at] if kept else own for at, own, kept in zip(rows, update.rings, is_kept)]
        sources = [old_map.sources[at] if kept and old_map.sources else None for at, kept in zip(rows, is_kept)]
        zero, shift = [0.0] * len(new), np.where(np.array(is_kept)[:, None], 0.0, update.shift)
        table = {
            "status": update.status + [NEW] * len(new),
            "confidence": [*update.confidence, *(np.nan if sure is None else sure[one] for one, _ in update.built)],
            "added": [*update.added, *map(polygon_area, new)],
            "removed": [*update.removed, *zero],
            "shift_east": [*shift[:, 0], *zero],
            "shift_north": [*shift[:, 1], *zero],
            "height_change": [*update.rise, *[np.nan] * len(new)],
        }
        polygons = [update.drawn.get(row, [own]) for row, own in enumerate(outlines)] + [[own] for own in new]
        return cls(polygons, sources + [None] * len(new), table, old_map, rows, _new_ids(old_map, id_field, len(new)))

    def layer(self, fields: tuple[Field, ...], is_wanted: Callable[[str], bool]) -> LayerFeatures:
        """Return the buildings whose status is wanted, with some fields and the attributes of the map."""
        chosen = [row for row, status in enumerate(self.table["status"]) if is_wanted(status)]
        parts = [row for row in chosen for _ in self.polygons[row]]
        columns = {one.name: [self.table[one.name][row] for row in parts] for one in fields}
        key, ids = self.new_ids
        for known, (name, values) in zip(self.old_map.columns, self.old_map.kept(self.rows, fields).items()):
            of_all = values + (ids if known == key else [None] * len(ids))
            columns[name] = [of_all[row] for row in parts]
        polygons = [rings for row in chosen for rings in self.polygons[row]]
        return LayerFeatures(polygons, columns, [self.sources[row] for row in parts])


def _report(update: _Update, updated: LayerFeatures, lost: LayerFeatures, fit: MapFit) -> Report:
    """Return the counts and the page."""
    counts = Counter([*update.status, *[NEW] * len(update.built)])
    values: dict[str, float] = {"old_buildings": len(update.status)}
    values.update({name.replace(" ", "_"): counts[name] for name in COLORS})
    values.update(map_shift_east=fit.shift[0], map_shift_north=fit.shift[1], overhang=fit.overhang)
    rows = [Row(name.capitalize(), f"{counts[name]:,}", "") for name in COLORS]
    kinds = [*updated.columns["status"], *[GONE] * len(lost)]
    drawn = draw_polygons([*updated.geometries, *lost.geometries], kinds, COLORS)
    return Report(values, build_page("Update of the map", _summary(values), {"Buildings": rows}, drawn))


def _summary(values: dict[str, float]) -> str:
    """Return the counts in one line."""
    counts = ", ".join(f"{values[name.replace(' ', '_')]:,} {name}" for name in COLORS if name != NEW)
    return f"Of {values['old_buildings']:,} buildings of the map: {counts}. {values['new']:,} are new."
