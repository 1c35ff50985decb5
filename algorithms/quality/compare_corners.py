"""Compare corners of buildings with an older map."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..criteria import MILLIMETER
from ..report.charts import BLUE, Mark, Series, draw_histogram, draw_scatter
from ..report.page import Row, build_page, meters
from ..stage import Field, InputLayer, Layer, LayerFeatures, Measure, Monitor, Report, stage, tunable
from .building_maps import BuildingMap, Overlap, clean_map, joined_names, measure_overlap, refuse_apart, rounded_down
from .corner_matching import FARTHEST, Corners, MatchedCorners, corners_of, match_corners, nearest_corners

FOUND, MISSED, NEW = "found", "missed", "new"

_DISPLACEMENTS = Layer(
    "displacements",
    "Displacements of corners",
    "LineString",
    (
        Field("id", int, "number of the displacement, from 1"),
        Field("old_building", str, "building of the old map: its attribute id, or its number"),
        Field("footprint", str, "footprint: its attribute id, or its number"),
        Field("length", float, "distance from the old corner to the new one", "m"),
        Field("dx", float, "eastward part of it", "m"),
        Field("dy", float, "northward part of it", "m"),
    ),
    style="displacements",
)
_BUILDINGS = Layer(
    "buildings",
    "Buildings found, missed and new",
    "Polygon",
    (
        Field("id", int, "number of the building, from 1"),
        Field("status", str, f"{FOUND} or {MISSED}: a building of the old map; {NEW}: a footprint that isn't in it"),
        Field("building", str, "its attribute id in its own map, or its number there"),
        Field("counterpart", str, "ids of its counterparts in the other map, separated by commas"),
        Field("area", float, "area", "m²"),
        Field("covered", float, "share of it that the other map has too, the shift taken off, 0 to 1"),
        Field("corners", int, "its corners"),
        Field("matched", int, "its corners that were found in the other map"),
        Field("mean_distance", float, "mean distance of these", "m"),
        Field("max_distance", float, "greatest distance of these", "m"),
    ),
    style="compared_buildings",
)
_MEASURES = (
    Measure("old_buildings", "Buildings in the old map"),
    Measure("all_footprints", "Footprints"),
    Measure("found", "Buildings found"),
    Measure("missed", "Buildings missed"),
    Measure("new", "New buildings"),
    Measure("corners", "Corners of the buildings found"),
    Measure("matched", "Corners matched"),
    Measure("mean", "Mean distance", "m"),
    Measure("minimum", "Minimum distance", "m"),
    Measure("maximum", "Maximum distance", "m"),
    Measure("median", "Median distance", "m"),
    Measure("deviation", "Standard deviation of the distances", "m"),
    Measure("mean_dx", "Mean shift eastward", "m"),
    Measure("mean_dy", "Mean shift northward", "m"),
)


@stage(
    "Quality",
    tags="cadastre,land registry,map,update,change detection,changes,displacement,shift,accuracy,footprints,RMSE",
    input_layers=(
        InputLayer("footprints", buildings=True),
        InputLayer("old_map", optional=True, buildings=True),
    ),
    layers=(_DISPLACEMENTS, _BUILDINGS),
    measures=_MEASURES,
    cost=0.1,
)
def compare_corners(
    footprints,
    old_map=None,
    *,
    min_overlap: float = tunable(0.5, within="(0, 1]"),
    tolerance: Optional[float] = tunable(
        None,
        within="(0, 100] m",
        automatic=(
            "three times the median distance of a corner from the nearest one of the other map, pairs by "
            "chance left out, 1 to 3 m."
        ),
    ),
    monitor=None,
):
    """Compare the corners of footprints with an older map: distances, shift, buildings found, missed and new.

    Buildings are the same where they overlap. Each corner of the old map is then matched with at most one of the
    footprints, the nearest pairs first, and arrows show from where to where it has moved.

    Parameters
    ----------
    footprints : LayerFeatures
        New outlines of buildings.
    old_map : LayerFeatures, optional
        Buildings to compare with, cut to the area that was surveyed; without a map, all footprints are new.

    Returns
    -------
    displacements : LayerFeatures
        A line from the old to the new corner for each pair that is more than a millimeter apart.
    buildings : LayerFeatures
        All buildings of the old map, found or missed, then the new ones.
    report : Report
        Counts and distances, and a page with charts. What there is nothing to compute from is NaN.

    Other Parameters
    ----------------
    min_overlap
        Share of a building's area that the other map must cover for the building to be the same.
    tolerance
        Corners farther apart, after the shift between the maps is removed, are not the same corner.

    Raises
    ------
    ValueError
        If footprints and map lie more than a kilometer apart.

    Notes
    -----
    A building of the old map is found when footprints cover at least the minimum overlap of it; a footprint is new
    unless at least as much of it lies in buildings that were found. Corners are compared between buildings that share
    the minimum overlap of the smaller one, so that a row of houses may be one outline in one of the maps.

    A corner is a vertex where the outline turns by 20° or more. Two corners can be the same when they face the same
    way, to 60°. A shift that all corners share (the median of the displacements) is found first and taken off while
    buildings and corners are matched. Distances, arrows and the mean shift are those between the maps as they are.
    The standard deviation has the divisor n.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 4,
    table 2. [hrutka2022]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> one = LayerFeatures([[ring]], {"id": [1]})
    >>> displacements, buildings, report = compare_corners(footprints=one, old_map=one)
    >>> report.values["corners"]
    4
    """
    if old_map is None:
        monitor.warn("There is no old map to compare with" + (", so all footprints are new." if footprints else "."))
        old_map = LayerFeatures([], {})
    new, old = clean_map(footprints, "footprints", monitor), clean_map(old_map, "buildings of the old map", monitor)
    refuse_apart(old, new, "footprints", "old map")
    corners = corners_of(old.rings), corners_of(new.rings)
    reach = max(FARTHEST, tolerance or 0.0)
    shift = _shift(*corners, _linked(old, new, min_overlap, np.zeros(2), monitor.part(0.0, 0.4)).same, reach)
    link = _linked(old, new, min_overlap, shift, monitor.part(0.4, 0.8))
    if len(old.area) and len(new.area) and not link.overlap.covered.any():
        monitor.warn("No footprint overlaps a building of the old map; check that both show the same area.")
    matched = match_corners(*corners, link.same, shift, tolerance, monitor)
    monitor.progress(0.9)
    values = _values(matched, link)
    layers = _displacements(old, new, matched), _buildings(old, new, matched, link)
    return (*layers, Report(values, _page(values, matched.moved)))


@dataclass(frozen=True)
class _Link:
    """Which buildings of two maps are the same."""

    overlap: Overlap
    same: tuple[np.ndarray, np.ndarray]  #: Buildings of the old map and footprints that are the same, in this order
    is_found: np.ndarray  #: bool: which buildings of the old map footprints cover
    is_new: np.ndarray  #: bool: which footprints are not in the old map


def _linked(old: BuildingMap, new: BuildingMap, min_overlap: float, shift: np.ndarray, monitor: Monitor) -> _Link:
    """Find the buildings that are the same in both maps, the old one moved by ``shift`` (2,)."""
    overlap, least = measure_overlap(old, new, shift, monitor), rounded_down(min_overlap)
    same, is_found = overlap.are_same(least), overlap.covered >= least
    is_new = overlap.other_covered_by(is_found) < least
    return _Link(overlap, (overlap.one[same], overlap.other[same]), is_found, is_new)


def _shift(old: Corners, new: Corners, same: tuple, reach: float) -> np.ndarray:
    """Return the shift (2,), m, from the old map to the new one: the median displacement of corners."""
    shift = np.zeros(2)
    for _ in range(10):
        one, other, _ = nearest_corners(old, new, same, shift, reach)
        before = shift
        shift = np.median(new.xy[other] - old.xy[one], axis=0) if len(one) else shift
        if np.hypot(*(shift - before)) < MILLIMETER:
            break
    return shift


def _values(corners: MatchedCorners, link: _Link) -> dict[str, float]:
    """Return the measures of the comparison; distances are NaN without corners that match."""
    dx, dy = corners.moved.T
    distance = np.hypot(dx, dy)
    measures = {"mean": np.mean, "minimum": np.min, "maximum": np.max, "median": np.median, "deviation": np.std}
    return {
        "old_buildings": len(link.is_found),
        "all_footprints": len(link.is_new),
        "found": int(link.is_found.sum()),
        "missed": int((~link.is_found).sum()),
        "new": int(link.is_new.sum()),
        "corners": int(link.is_found[corners.old.building].sum()),
        "matched": len(distance),
        **{name: float(measure(distance)) if len(distance) else np.nan for name, measure in measures.items()},
        "mean_dx": float(dx.mean()) if len(dx) else np.nan,
        "mean_dy": float(dy.mean()) if len(dy) else np.nan,
    }


def _displacements(old: BuildingMap, new: BuildingMap, corners: MatchedCorners) -> LayerFeatures:
    """Return the layer of arrows, by building of the old map."""
    features = []
    for i, j in sorted(zip(corners.one.tolist(), corners.other.tolist())):
        start, end = corners.old.xy[i], corners.new.xy[j]
        dx, dy = (end - start).tolist()
        facts = {"length": float(np.hypot(dx, dy)), "dx": dx, "dy": dy}
        if facts["length"] > MILLIMETER:
            names = old.names[corners.old.building[i]], new.names[corners.new.building[j]]
            facts |= {"old_building": names[0], "footprint": names[1]}
            features.append((np.stack([start, end]), facts))
    return LayerFeatures.numbered(features, _DISPLACEMENTS.fields)


def _buildings(old: BuildingMap, new: BuildingMap, corners: MatchedCorners, link: _Link) -> LayerFeatures:
    """Return the layer of buildings: of the old map, then the new ones."""
    every, n_new = old + new.only(link.is_new), int(link.is_new.sum())
    matched, mean, most = corners.of_buildings()
    none = np.full(n_new, np.nan)
    columns = {
        "id": np.arange(1, len(every.names) + 1),
        "status": [FOUND if is_found else MISSED for is_found in link.is_found] + [NEW] * n_new,
        "building": every.names,
        "counterpart": joined_names(link.same[0], [new.names[j] for j in link.same[1]], len(every.names)),
        "area": every.area,
        "covered": np.append(link.overlap.covered, link.overlap.other_covered[link.is_new]),
        "corners": np.append(corners.old.counts, corners.new.counts[link.is_new]),
        "matched": np.append(matched, np.zeros(n_new, np.int64)),
        "mean_distance": np.append(mean, none),
        "max_distance": np.append(most, none),
    }
    return LayerFeatures(every.rings, columns)


def _page(values: dict[str, float], moved: np.ndarray) -> str:
    lead = (
        f"{values['found']:,} of {values['old_buildings']:,} buildings of the old map were found among "
        f"{values['all_footprints']:,} footprints, and {values['matched']:,} of their {values['corners']:,} corners."
    )
    tables = {
        "Buildings": [
            Row("Found", f"{values['found']:,}", "Buildings of the old map that footprints cover."),
            Row("Missed", f"{values['missed']:,}", "Buildings of the old map that no footprint covers."),
            Row("New", f"{values['new']:,}", "Footprints that are not in the old map."),
        ],
        "Distances of corners": [
            Row("Mean", meters(values["mean"]), "From the corner in the old map to the new corner."),
            Row("Minimum", meters(values["minimum"]), "The corner that has moved least."),
            Row("Maximum", meters(values["maximum"]), "The corner that has moved most."),
            Row("Median", meters(values["median"]), "Half of the corners have moved by less."),
            Row("Standard deviation", meters(values["deviation"]), "How much the distances differ among themselves."),
        ],
        "Shift between the maps": _shift_rows(values, moved),
    }
    distance = np.hypot(*moved.T)
    marks = [Mark("mean", values["mean"]), Mark("median", values["median"])]
    bars = draw_histogram([Series("corners", BLUE, distance)], "Distance (m)", "Corners", marks)
    rose = draw_scatter(moved, "Displacement of a corner, north is up", "m", "mean shift")
    pictures = f"<h2>Distances</h2>\n{bars}<h2>Displacements</h2>\n{rose}"
    return build_page("Corners against the old map", lead, tables, pictures)


def _shift_rows(values: dict[str, float], moved: np.ndarray) -> list[Row]:
    """Return the systematic part of the displacements and the rest."""
    dx, dy = values["mean_dx"], values["mean_dy"]
    remaining = float(np.sqrt(moved.var(axis=0).sum())) if len(moved) else np.nan
    left = "Root mean square of the distances that were left if the shift were taken off."
    return [
        Row("Eastward", meters(dx), "Mean of the displacements to the east; negative is to the west."),
        Row("Northward", meters(dy), "Mean of the displacements to the north; negative is to the south."),
        Row("Together", meters(float(np.hypot(dx, dy))), "Length of the mean shift."),
        Row("Without it", meters(remaining), left),
    ]
