"""Assess outlines of buildings, one by one, against trusted polygons."""

from dataclasses import dataclass
from typing import Callable, Optional

import numpy as np

from ..criteria import MILLIMETER
from ..report.charts import BLUE, CYAN, GREEN, RED, YELLOW, Mark, Series, draw_histogram
from ..report.page import build_page, decimal, draw_table, rows_of
from ..report.polygon_map import draw_polygons
from ..stage import Field, InputLayer, Layer, LayerFeatures, Measure, Monitor, Report, stage, tunable
from .building_maps import BuildingMap, Overlap, clean_map, joined_names, measure_overlap, refuse_apart, rounded_down
from .confusion import percentage
from .corner_matching import MatchedCorners, corners_of, match_corners
from .polygon_comparison import hausdorff, polis, squareness

FOUND, MERGED, SPLIT, MISSED, INVENTED = "found", "merged", "split", "missed", "invented"

AROUND, EVERYWHERE = "around the reference", "everywhere"

COLORS = {FOUND: BLUE, MERGED: GREEN, SPLIT: CYAN, MISSED: YELLOW, INVENTED: RED}

# Distances (m) within which agencies want all corners of a building.
_WITHIN = (0.3, 0.5, 1.0)

_BUILDINGS = Layer(
    "buildings",
    "Buildings found, merged, split, missed and invented",
    "Polygon",
    (
        Field("id", int, "number of the building, from 1"),
        Field(
            "status",
            str,
            f"{FOUND}: a building of the reference with one footprint of its own; {MERGED}: it shares its footprint "
            f"with others; {SPLIT}: it has several; {MISSED}: it has none; "
            f"{INVENTED}: a footprint that isn't in the reference",
        ),
        Field("building", str, "attribute id of the building in its own layer, or its number in it"),
        Field("counterpart", str, "names of the footprints that belong to it, the best first, separated by commas"),
        Field("area", float, "area", "m²"),
        Field("covered", float, "share of it that the other layer has too, 0 to 1"),
        Field("iou", float, "intersection over union with the best counterpart, 0 to 1"),
        Field("hausdorff", float, "greatest distance between its outline and its best counterpart's", "m"),
        Field("polis", float, "mean distance of the corners of both outlines from the other one (PoLiS)", "m"),
        Field("corners", int, "its corners"),
        Field("counterpart_corners", int, "corners of the best counterpart"),
        Field("matched", int, "its corners that the other layer has too"),
        Field("corner_distance", float, "mean distance of these", "m"),
        Field("farthest_corner", float, "greatest distance of these, where all of its corners are matched", "m"),
        Field("squareness", float, "share of its edges' length along two directions square to each other, 0 to 1"),
        Field("counterpart_squareness", float, "the same of the best counterpart"),
    ),
    style="assessed_footprints",
)
_MEASURES = (
    Measure("reference_buildings", "Buildings in the reference"),
    Measure("all_footprints", "Footprints"),
    Measure("found", "Buildings found one to one"),
    Measure("merged", "Buildings merged with others"),
    Measure("split", "Buildings split"),
    Measure("missed", "Buildings missed"),
    Measure("invented", "Footprints invented"),
    Measure("outside", "Footprints outside the area compared"),
    Measure("completeness", "Buildings found, merged or split", "%"),
    Measure("correctness", "Footprints that are in the reference", "%"),
    Measure("iou", "Median IoU of the buildings found one to one"),
    Measure("hausdorff", "Median Hausdorff distance of these", "m"),
    Measure("polis", "Median PoLiS distance of these", "m"),
    Measure("corners", "Corners of the buildings that have footprints"),
    Measure("footprint_corners", "Corners of the footprints that belong to buildings"),
    Measure("matched", "Corners matched"),
    Measure("corner_distance", "Median distance of matched corners", "m"),
    *(Measure(f"within_{100 * most:.0f}_cm", f"Buildings with all corners within {most:g} m") for most in _WITHIN),
    Measure("shift_east", "Median shift of the footprints eastward", "m"),
    Measure("shift_north", "Median shift of the footprints northward", "m"),
    Measure("squareness", "Median squareness of the footprints"),
    Measure("reference_squareness", "Median squareness of the reference"),
)


@stage(
    "Quality",
    tags="assess,validation,cadastre,base map,change detection,accuracy,evaluation,reference,polygons,outlines,IoU,"
    "PoLiS,Hausdorff,corners,squareness,merged,split,completeness,correctness",
    input_layers=(
        InputLayer("footprints", buildings=True),
        InputLayer("reference_map", "Reference", buildings=True),
        InputLayer("area", "Area compared", optional=True),
    ),
    layers=(_BUILDINGS,),
    measures=_MEASURES,
)
def assess_footprints(
    footprints,
    reference_map,
    area=None,
    *,
    compared: str = tunable(AROUND, label="Footprints compared", choices=(AROUND, EVERYWHERE)),
    min_overlap: float = tunable(0.5, within="(0, 1]"),
    tolerance: Optional[float] = tunable(
        None,
        within="(0, 100] m",
        automatic=(
            "three times the median distance of a corner from the nearest one of the other layer, pairs by "
            "chance left out, 1 to 3 m."
        ),
        advanced=True,
    ),
    monitor=None,
):
    """Compare footprints with polygons of a reference, building by building, and mark what agrees and what doesn't.

    Any two polygon layers can be compared: footprints with a cadastre or base map, or with an earlier result. Each
    building is found, merged, split, missed or invented; its IoU, Hausdorff distance, corners and squareness are
    attributes.

    Parameters
    ----------
    footprints : LayerFeatures
        Outlines of buildings that are to be assessed.
    reference_map : LayerFeatures
        Buildings that are trusted: a cadastre, a base map, an earlier result.
    area : LayerFeatures, optional
        Where both layers are compared: buildings and footprints with half of their area within. Without it,
        'Footprints compared' decides.

    Returns
    -------
    buildings : LayerFeatures
        All buildings of the reference, then the footprints that are not in it.
    report : Report
        Counts and medians, and a page with charts and a map. Measures without any value to compute them from are NaN.

    Other Parameters
    ----------------
    compared
        Around the reference: footprints that overlap a building of the reference or lie amid its buildings; it may
        cover a part of the survey. Everywhere: all footprints, of which those without a building are invented.
    min_overlap
        Share of a building that the other layer must cover for the building to be in it.
    tolerance
        Corners farther apart are not the same corner.

    Raises
    ------
    ValueError
        If the layers lie more than a kilometer apart.

    Notes
    -----
    A footprint belongs to a building where both share the minimum overlap of the smaller one, and where all footprints
    together cover the minimum overlap of the building. Around the reference, footprints are compared that overlap one
    of its buildings or lie within the convex hull of those within 50 m. A building is missed if no footprint belongs to
    it. It is merged if one of its footprints belongs to other buildings too, and split if it has several footprints
    that don't. A footprint is invented if less of it than the minimum overlap lies in buildings that are not missed.

    The best counterpart is the footprint with the greatest IoU. Hausdorff distances are measured every 0.1 m along both
    outlines, courtyards included. PoLiS is the mean distance of vertices from the other outline, in the mean of both
    ways. A corner is a vertex where the outline turns by 20° or more; corners are matched one to one, the nearest
    first, if they face the same way to 60°. Squareness counts edges within 3° of two directions of the building's own.
    Positions are compared as they are: no shift between the layers is removed.

    References
    ----------
    Avbelj, J., Müller, R., Bamler, R., 2015. A metric for polygon comparison and building extraction evaluation. IEEE
    Geoscience and Remote Sensing Letters 12(1), 170-174 (PoLiS). [avbelj2015]
    Rutzinger, M., Rottensteiner, F., Pfeifer, N., 2009. A comparison of evaluation techniques for building extraction
    from airborne laser scanning. IEEE Journal of Selected Topics in Applied Earth Observations and Remote Sensing 2(1).
    [rutzinger2009]
    Huttenlocher, D. P., Klanderman, G. A., Rucklidge, W. J., 1993. Comparing images using the Hausdorff distance. IEEE
    Transactions on Pattern Analysis and Machine Intelligence 15(9). [huttenlocher1993]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> one = LayerFeatures([[ring]], {"id": [1]})
    >>> buildings, report = assess_footprints(footprints=one, reference_map=one)
    >>> buildings.columns["status"]
    ['found']
    """
    new = clean_map(footprints, "footprints", monitor)
    true = clean_map(reference_map, "buildings of the reference", monitor)
    refuse_apart(true, new, "footprints", "reference")
    true, new, outside = _compared(true, new, area, compared, monitor)
    if len(true.area) and not len(new.area):
        monitor.warn("There are no footprints, so all buildings of the reference are missed.")
    if len(new.area) and not len(true.area):
        monitor.warn("There are no buildings in the reference, so all footprints are invented.")
    match = _match(measure_overlap(true, new, np.zeros(2), monitor.part(0.0, 0.3)), min_overlap)
    same = match.building, match.footprint
    corners = match_corners(corners_of(true.rings), corners_of(new.rings), same, np.zeros(2), tolerance, monitor)
    table = _table(true, new, match, corners, monitor.part(0.4, 0.95))
    values = {**_values(table, match, corners), "outside": outside}
    monitor.inform(_summary(values))
    rings = (true + new.only(match.is_invented)).rings
    return LayerFeatures(rings, table), Report(values, _page(rings, table, values))


def _compared(
    true: BuildingMap, new: BuildingMap, area: Optional[LayerFeatures], compared: str, monitor: Monitor
) -> tuple[BuildingMap, BuildingMap, int]:
    """Return the buildings and the footprints that are compared, and how many footprints lie elsewhere."""
    if area is not None:
        polygons = clean_map(area, "polygons of the area", monitor)
        true, kept = true.only(polygons.holds(true)), polygons.holds(new)
    elif compared == AROUND and true.rings:
        kept = true.shows(new)
    else:
        kept = np.ones(len(new.rings), bool)
    return true, new.only(kept), int((~kept).sum())


@dataclass(frozen=True)
class _Match:
    """Which footprints belong to which buildings of the reference.

    ``building[k]`` and ``footprint[k]`` belong together, sorted by both, with their ``iou``. ``best`` and
    ``status`` are of each building: the footprint with the greatest IoU, -1 without one, and what became of it.
    ``is_invented`` is of each footprint.
    """

    overlap: Overlap
    building: np.ndarray
    footprint: np.ndarray
    iou: np.ndarray
    best: np.ndarray
    status: list[str]
    is_invented: np.ndarray


def _match(overlap: Overlap, min_overlap: float) -> _Match:
    """Decide which buildings are found, merged, split and missed, and which footprints are invented."""
    least = rounded_down(min_overlap)
    same = overlap.are_same(least)
    building, footprint, iou = overlap.one[same], overlap.other[same], overlap.iou[same]
    n_footprints = np.bincount(building, minlength=len(overlap.area))
    n_buildings = np.bincount(footprint, minlength=len(overlap.other_area))
    is_sharing = np.bincount(building, n_buildings[footprint] > 1, len(overlap.area)) > 0
    status = np.select([n_footprints == 0, is_sharing, n_footprints > 1], [MISSED, MERGED, SPLIT], FOUND)
    best = np.full(len(overlap.area), -1)
    # Of values that go to one position the last one stays, which has the greatest IoU.
    order = np.argsort(iou, kind="stable")
    best[building[order]] = footprint[order]
    is_invented = overlap.other_covered_by(n_footprints > 0) < least
    return _Match(overlap, building, footprint, iou, best, status.tolist(), is_invented)


def _table(true: BuildingMap, new: BuildingMap, match: _Match, corners: MatchedCorners, monitor: Monitor) -> dict:
    """Return the attributes of all buildings: of the reference, then of footprints that are invented."""
    every, invented = true + new.only(match.is_invented), np.flatnonzero(match.is_invented)
    nothing, zero = np.full(len(invented), np.nan), np.zeros(len(invented), np.int64)
    square = [np.array([squareness(rings) for rings in one.rings]) for one in (true, new)]
    iou = np.full(len(true.area), np.nan)
    np.fmax.at(iou, match.building, match.iou)
    counts, counts_of_new = corners.old.counts, corners.new.counts
    matched, distance, farthest = corners.of_buildings()
    farthest[matched < counts] = np.nan
    order = np.lexsort((match.footprint, -match.iou, match.building))
    partners = [new.names[row] for row in match.footprint[order]]
    return {
        "id": np.arange(1, len(every.names) + 1),
        "status": match.status + [INVENTED] * len(invented),
        "building": every.names,
        "counterpart": joined_names(match.building[order], partners, len(every.names)),
        "area": every.area,
        "covered": np.append(match.overlap.covered, match.overlap.other_covered[invented]),
        "iou": np.append(iou, nothing),
        "hausdorff": np.append(_distances(hausdorff, true, new, match.best, monitor), nothing),
        "polis": np.append(_distances(polis, true, new, match.best, Monitor()), nothing),
        "corners": np.append(counts, counts_of_new[invented]),
        # The value appended is the last one, which buildings without a counterpart take: their best is -1.
        "counterpart_corners": np.append(np.append(counts_of_new, 0)[match.best], zero),
        "matched": np.append(matched, zero),
        "corner_distance": np.append(distance, nothing),
        "farthest_corner": np.append(farthest, nothing),
        "squareness": np.append(square[0], square[1][invented]),
        "counterpart_squareness": np.append(np.append(square[1], np.nan)[match.best], nothing),
    }


def _distances(
    measure: Callable[[list, list], float], true: BuildingMap, new: BuildingMap, best: np.ndarray, monitor: Monitor
) -> np.ndarray:
    """Return the distance (m) of each building from its best counterpart by a ``measure``, NaN without one."""
    distance = np.full(len(best), np.nan)
    for row, other in enumerate(best.tolist()):
        if other >= 0:
            distance[row] = measure(true.rings[row], new.rings[other])
        monitor.progress((row + 1) / len(best))
    return distance


def _values(table: dict, match: _Match, corners: MatchedCorners) -> dict[str, float]:
    """Return the measures; medians of nothing are NaN."""
    n, n_new, moved = len(match.best), len(match.is_invented), corners.moved
    status = np.array(table["status"], dtype=object)
    found, has_footprint = status[:n] == FOUND, match.best >= 0
    n_invented = int(match.is_invented.sum())
    counts = {name: int((status == name).sum()) for name in (FOUND, MERGED, SPLIT, MISSED, INVENTED)}
    return {
        "reference_buildings": n,
        "all_footprints": n_new,
        **counts,
        "completeness": 100.0 * float(has_footprint.mean()) if n else np.nan,
        "correctness": percentage(n_new - n_invented, n_new),
        "iou": _median(table["iou"][:n][found]),
        "hausdorff": _median(table["hausdorff"][:n][found]),
        "polis": _median(table["polis"][:n][found]),
        "corners": int(has_footprint[corners.old.building].sum()),
        "footprint_corners": int(np.isin(corners.new.building, match.footprint).sum()),
        "matched": len(moved),
        "corner_distance": _median(np.hypot(*moved.T)),
        **{
            f"within_{100 * most:.0f}_cm": int((table["farthest_corner"] <= most + MILLIMETER).sum())
            for most in _WITHIN
        },
        "shift_east": _median(moved[:, 0]),
        "shift_north": _median(moved[:, 1]),
        "squareness": _median(table["counterpart_squareness"][:n][has_footprint]),
        "reference_squareness": _median(table["squareness"][:n][has_footprint]),
    }


def _median(values: np.ndarray) -> float:
    return float(np.median(values)) if len(values) else np.nan


def _summary(values: dict[str, float]) -> str:
    """Return the counts in one line."""
    beyond = f" {values['outside']:,} more lie outside the area compared." if values["outside"] else ""
    return (
        f"Of {values['reference_buildings']:,} buildings of the reference, {values['found']:,} have one footprint of "
        f"their own, {values['merged']:,} are merged, {values['split']:,} split and {values['missed']:,} missed. "
        f"Of {values['all_footprints']:,} footprints, {values['invented']:,} are invented.{beyond}"
    )


def _page(rings: list, table: dict, values: dict[str, float]) -> str:
    tables = {name: rows_of(values, _MEASURES, meanings, 2) for name, meanings in _meanings(values).items()}
    is_found = np.array(table["status"], dtype=object) == FOUND
    pictures = [draw_polygons(rings, table["status"], COLORS)]
    for name, heading, axis in (("iou", "IoU", "IoU"), ("hausdorff", "Distances", "Hausdorff distance (m)")):
        series = [Series("buildings found one to one", BLUE, table[name][is_found])]
        bars = draw_histogram(series, axis, "Buildings", [Mark("median", values[name])])
        pictures.append(f"<h2>{heading}</h2>\n{bars}")
    pictures.append(_worst(table))
    return build_page("Quality of the footprints", _summary(values), tables, "\n".join(pictures))


def _meanings(values: dict[str, float]) -> dict[str, dict[str, tuple[str, str]]]:
    """Return names and meanings of the rows of the page, by its tables."""
    near = "Buildings of which every corner has been matched that near."
    square = (
        "Median share of a footprint's edges along two directions square to each other; "
        f"{decimal(values['reference_squareness'], 3)} in the reference."
    )
    of_footprints = f"Of the footprints that belong to buildings; {values['corners']:,} of these buildings."
    return {
        "Buildings": {
            "found": ("Found", "Buildings of the reference with one footprint of their own."),
            "merged": ("Merged", "Buildings that share a footprint with others."),
            "split": ("Split", "Buildings with several footprints."),
            "missed": ("Missed", "Buildings without a footprint."),
            "invented": ("Invented", "Footprints that are not in the reference."),
            "completeness": ("Completeness", "Share of the buildings found, merged or split."),
            "correctness": ("Correctness", "Share of the footprints that are in the reference."),
        },
        "Outlines": {
            "iou": ("IoU", "Median intersection over union of the buildings found one to one."),
            "hausdorff": ("Hausdorff distance", "Median of these: where two outlines are farthest apart."),
            "polis": ("PoLiS", "Median of the mean distances of corners from the other outline."),
            "squareness": ("Squareness", square),
        },
        "Corners": {
            "footprint_corners": ("Corners", of_footprints),
            "matched": ("Matched", "Corners that both layers have."),
            "corner_distance": ("Distance", "Median distance between matched corners."),
            **{f"within_{100 * most:.0f}_cm": (f"All within {most:g} m", near) for most in _WITHIN},
            "shift_east": ("Shift eastward", "Median displacement to the east; negative is to the west."),
            "shift_north": ("Shift northward", "Median displacement to the north."),
        },
    }


def _worst(table: dict) -> str:
    """Return the table of the buildings that agree least with their footprints."""
    order = [row for row in np.argsort(table["iou"], kind="stable").tolist() if np.isfinite(table["iou"][row])]
    forms = {"building": "", "status": "", "area": ",.0f", "iou": ".2f", "hausdorff": ".2f"}
    rows = [[format(table[name][row], form) for name, form in forms.items()] for row in order[:10]]  # one screen
    head = ["Building", "Status", "Area (m²)", "IoU", "Hausdorff distance (m)"]
    return draw_table("Buildings that agree least", head, rows) if rows else ""
