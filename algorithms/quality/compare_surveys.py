"""Compare the footprints of two surveys: buildings new, gone, or with another height or outline."""

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..geometry.groups import components, split_groups
from ..geometry.rings import distances_to_rings
from ..report.charts import BLUE, CYAN, GREEN, PURPLE, RED, YELLOW, Mark, Series, draw_histogram
from ..report.page import Row, build_page
from ..report.polygon_map import draw_polygons
from ..rules import rules
from ..stage import Field, InputLayer, Layer, LayerFeatures, Measure, Monitor, Report, stage, tunable
from .building_maps import BuildingMap, Overlap, clean_map, joined_names, measure_overlap, refuse_apart, rounded_down
from .corner_matching import LEAST_TOLERANCE, MEDIANS, MOST_TOLERANCE
from .polygon_comparison import positions_along

UNCHANGED, HEIGHT, OUTLINE, BOTH = "unchanged", "height changed", "outline changed", "height and outline changed"
NEW, GONE = "new", "gone"

COLORS = {UNCHANGED: BLUE, HEIGHT: CYAN, OUTLINE: GREEN, BOTH: PURPLE, NEW: RED, GONE: YELLOW}


@rules
class RULES:
    """How changes are distinguished from the scatter between two surveys.

    Attributes
    ----------
    least_height, most_height : float
        Least and greatest automatic tolerance, m: smaller changes are not built, and differences of more than a storey
        are changes even where most buildings have changed.
    wall : float
        Outlines nearer to a neighbor of the same group are walls between these, m: the width of a double wall.
    """

    least_height: float = 0.5
    most_height: float = 3.0
    wall: float = 0.5


_BUILDINGS = Layer(
    "buildings",
    "Buildings new, gone and changed",
    "Polygon",
    (
        Field("id", int, "number of the building, from 1"),
        Field(
            "status",
            str,
            f"{NEW} or {GONE}: in the new or in the earlier survey only; {HEIGHT}, {OUTLINE}, {BOTH}; {UNCHANGED}",
        ),
        Field("building", str, "its attribute id in its own layer, or its number there"),
        Field("counterpart", str, "buildings of the other survey that it was compared with, separated by commas"),
        Field("area", float, "area", "m²"),
        Field("gained", float, "area that it and those compared with it have gained", "m²"),
        Field("lost", float, "area that these have lost", "m²"),
        Field("outline_change", float, "greatest distance between the outlines of both surveys", "m"),
        Field("height_change", float, "height in the new survey less that in the earlier one", "m"),
    ),
    style="compared_surveys",
)
_MEASURES = (
    Measure("new_footprints", "Buildings in the new survey"),
    Measure("old_footprints", "Buildings in the earlier survey"),
    Measure("new", "New buildings"),
    Measure("gone", "Buildings gone"),
    Measure("height_changed", "Buildings changed in height"),
    Measure("outline_changed", "Buildings changed in outline"),
    Measure("unchanged", "Buildings unchanged"),
    Measure("new_area", "Area of the new buildings", "m²"),
    Measure("gone_area", "Area of the buildings gone", "m²"),
)


@stage(
    "Quality",
    tags="change detection,changes,update,new,demolished,epochs,earlier survey,monitoring,cadastre,footprints,height",
    input_layers=(
        InputLayer("footprints", buildings=True),
        InputLayer("earlier", "Footprints of the earlier survey", buildings=True),
    ),
    layers=(_BUILDINGS,),
    measures=_MEASURES,
)
def compare_surveys(
    footprints,
    earlier,
    *,
    min_overlap: float = tunable(0.5, within="(0, 1]"),
    outline_tolerance: Optional[float] = tunable(
        None,
        within="[0, 100] m",
        automatic=(
            f"{MEDIANS:g} times the median distance between the outlines of both surveys, "
            f"{LEAST_TOLERANCE:g} to {MOST_TOLERANCE:g} m."
        ),
    ),
    height_tolerance: Optional[float] = tunable(
        None,
        within="[0, 100] m",
        automatic=(
            f"{MEDIANS:g} times the median difference between the heights of both surveys, "
            f"{RULES.least_height:g} to {RULES.most_height:g} m."
        ),
    ),
    monitor=None,
):
    """Find the buildings that are new, gone, or changed in height or outline since an earlier survey.

    Both surveys are layers of footprints, as *Extract footprints* and *Detect buildings* make them from a cloud.
    Heights are compared where both have the attribute 'ridge_height', or else 'height'.

    Parameters
    ----------
    footprints : LayerFeatures
        Buildings of the new survey, cut to the area of both.
    earlier : LayerFeatures
        Buildings of the earlier survey, cut to the area of both.

    Returns
    -------
    buildings : LayerFeatures
        All buildings of the new survey, then those that are gone.
    report : Report
        Counts, and a page with a map. What there is nothing to compute from is NaN.

    Other Parameters
    ----------------
    min_overlap
        Share of the smaller building that both surveys must have for two buildings to be the same.
    outline_tolerance
        An outline has changed if it is farther than this from the earlier one somewhere.
    height_tolerance
        A height has changed if it differs by more.

    Raises
    ------
    ValueError
        If the surveys lie more than a kilometer apart.

    Notes
    -----
    Buildings that share the minimum overlap of the smaller one are compared. Where several of one survey are one in the
    other, they are compared as a group: a house that was drawn as two has not changed. The height of a group is the
    mean by area. Distances of outlines are measured every 0.1 m, walls between buildings of a group left out.

    References
    ----------
    Murakami, H., Nakagawa, K., Hasegawa, H., Shibata, T., Iwanami, E., 1999. Change detection of buildings using an
    airborne laser scanner. ISPRS Journal of Photogrammetry and Remote Sensing 54(2-3). [murakami1999]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> old = LayerFeatures([[ring]], {"id": [1]})
    >>> new = LayerFeatures([[ring], [ring + 20]], {"id": [1, 2]})
    >>> buildings, report = compare_surveys(footprints=new, earlier=old)
    >>> buildings.columns["status"]
    ['unchanged', 'new']
    """
    new = clean_map(footprints, "footprints", monitor)
    old = clean_map(earlier, "footprints of the earlier survey", monitor)
    refuse_apart(old, new, "footprints", "earlier survey")
    overlap = measure_overlap(old, new, np.zeros(2), monitor.part(0.0, 0.3))
    groups = _groups(overlap, min_overlap)
    height = _height_changes((footprints, earlier), (new, old), groups, monitor)
    outline = _outline_changes(old, new, groups, monitor.part(0.3, 0.95))
    tolerances = {
        "outline_tolerance": _tolerance(outline_tolerance, outline, LEAST_TOLERANCE, MOST_TOLERANCE),
        "height_tolerance": _tolerance(height_tolerance, height, RULES.least_height, RULES.most_height),
    }
    monitor.resolved(**tolerances)
    status = _status(groups, outline > tolerances["outline_tolerance"], np.abs(height) > tolerances["height_tolerance"])
    changes = {**_area_changes(overlap, groups), "outline_change": outline, "height_change": height}
    every, table = _table(old, new, groups, {"status": status, **changes})
    values = _values(table, len(old.area), len(new.area))
    return LayerFeatures(every.rings, table), Report(values, _page(every.rings, table, values, tolerances))


@dataclass(frozen=True)
class _Groups:
    """The group of each building of the earlier and of the new survey: those that are the same have one number."""

    old: np.ndarray
    new: np.ndarray
    count: int


def _groups(overlap: Overlap, min_overlap: float) -> _Groups:
    """Return groups of buildings that share at least ``min_overlap`` of the smaller one with another of the group."""
    same = overlap.of_smaller >= rounded_down(min_overlap)
    n = len(overlap.area)
    count, group = components(overlap.one[same], n + overlap.other[same], n + len(overlap.other_area))
    return _Groups(group[:n], group[n:], count)


def _height_changes(
    layers: tuple[LayerFeatures, LayerFeatures],
    maps: tuple[BuildingMap, BuildingMap],
    groups: _Groups,
    monitor: Monitor,
) -> np.ndarray:
    """Return the rise (m) of each group from the earlier to the new survey, the new one first; NaN where unknown."""
    for name in ("ridge_height", "height"):
        found = (_numbers(layer.columns.get(name)) for layer in layers)
        columns = [column for column in found if column is not None]
        if len(columns) == len(layers):
            new, old = (
                _group_heights(column[one.rows], one.area, group, groups.count)
                for column, one, group in zip(columns, maps, (groups.new, groups.old))
            )
            return new - old
    monitor.warn("Heights are not compared: no attribute 'ridge_height' or 'height' is in both layers.")
    return np.full(groups.count, np.nan)


def _numbers(values: Any) -> Optional[np.ndarray]:
    """Return the values (n,) of an attribute, NaN if missing; None if it is absent or has other values."""
    try:
        found = np.array(values, float)
    except (TypeError, ValueError):
        return None
    return found if found.ndim == 1 else None


def _area_changes(overlap: Overlap, groups: _Groups) -> dict[str, np.ndarray]:
    """Return the areas (m²) that each group has gained and lost."""
    one, other = groups.old[overlap.one], groups.new[overlap.other]
    shared = np.bincount(one[one == other], overlap.shared[one == other], groups.count)
    sides = {"gained": (groups.new, overlap.other_area), "lost": (groups.old, overlap.area)}
    return {name: np.maximum(np.bincount(*side, groups.count) - shared, 0.0) for name, side in sides.items()}


def _group_heights(height: np.ndarray, area: np.ndarray, group: np.ndarray, count: int) -> np.ndarray:
    """Return the mean height (m) of each group by area, NaN without heights."""
    known = np.isfinite(height)
    total = np.bincount(group[known], (height * area)[known], count)
    weight = np.bincount(group[known], area[known], count)
    return np.where(weight > 0, total / np.where(weight > 0, weight, 1.0), np.nan)


def _outline_changes(old: BuildingMap, new: BuildingMap, groups: _Groups, monitor: Monitor) -> np.ndarray:
    """Return the greatest distance (m) between the outlines of both surveys in each group, NaN where one lacks it."""
    distance = np.full(groups.count, np.nan)
    members = zip(*(split_groups(group, groups.count) for group in (groups.old, groups.new)))
    for number, (olds, news) in enumerate(members):
        first, second = [old.rings[row] for row in olds], [new.rings[row] for row in news]
        if first and second:
            distance[number] = max(_farthest(first, second), _farthest(second, first))
        monitor.progress(number / groups.count)
    return distance


def _farthest(buildings: list, others: list) -> float:
    """Return the greatest distance (m) of the outer walls of buildings from the outlines of others."""
    rings = [ring for building in others for ring in building]
    off = 0.0
    for row, building in enumerate(buildings):
        positions = positions_along(building)
        neighbors = [ring for other in buildings[:row] + buildings[row + 1 :] for ring in other]
        if neighbors:
            positions = positions[distances_to_rings(positions, neighbors) > RULES.wall]
        if len(positions):
            off = max(off, float(distances_to_rings(positions, rings).max()))
    return off


def _tolerance(given: Optional[float], differences: np.ndarray, least: float, most: float) -> float:
    """Return the given tolerance (m), or one from the differences of all groups."""
    if given is not None:
        return given
    known = np.abs(differences[np.isfinite(differences)])
    return float(np.clip(MEDIANS * np.median(known), least, most)) if len(known) else least


def _status(groups: _Groups, outline: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Return the status of each group, given whether its outline and its height have changed."""
    in_old, in_new = (np.isin(np.arange(groups.count), group) for group in (groups.old, groups.new))
    chosen = [~in_old, ~in_new, outline & height, outline, height]
    return np.select(chosen, [NEW, GONE, BOTH, OUTLINE, HEIGHT], UNCHANGED)


def _table(
    old: BuildingMap, new: BuildingMap, groups: _Groups, found: dict[str, np.ndarray]
) -> tuple[BuildingMap, dict]:
    """Return the buildings of the new survey, then those that are gone, and the attributes of their groups."""
    is_gone = ~np.isin(groups.old, groups.new)
    every, group = new + old.only(is_gone), np.append(groups.new, groups.old[is_gone])
    names = joined_names(groups.old, old.names, groups.count)
    return every, {
        "id": np.arange(1, len(group) + 1),
        "status": found["status"][group].tolist(),
        "building": every.names,
        "counterpart": [names[number] for number in groups.new] + [""] * int(is_gone.sum()),
        "area": every.area,
        **{name: values[group] for name, values in found.items() if name != "status"},
    }


def _values(table: dict, n_old: int, n_new: int) -> dict[str, float]:
    status = np.array(table["status"], dtype=object)
    return {
        "new_footprints": n_new,
        "old_footprints": n_old,
        "new": int((status == NEW).sum()),
        "gone": int((status == GONE).sum()),
        "height_changed": int(np.isin(status, [HEIGHT, BOTH]).sum()),
        "outline_changed": int(np.isin(status, [OUTLINE, BOTH]).sum()),
        "unchanged": int((status == UNCHANGED).sum()),
        "new_area": float(table["area"][status == NEW].sum()),
        "gone_area": float(table["area"][status == GONE].sum()),
    }


def _page(rings: list, table: dict, values: dict[str, float], tolerances: dict[str, float]) -> str:
    lead = (
        f"Of {values['new_footprints']:,} buildings, {values['new']:,} are new and {values['unchanged']:,} unchanged; "
        f"{values['gone']:,} of {values['old_footprints']:,} buildings of the earlier survey are gone."
    )
    outline, height = tolerances["outline_tolerance"], tolerances["height_tolerance"]
    rows = [
        Row("New", f"{values['new']:,}", f"Buildings of the new survey only, {values['new_area']:,.0f} m²."),
        Row("Gone", f"{values['gone']:,}", f"Buildings of the earlier survey only, {values['gone_area']:,.0f} m²."),
        Row("Outline changed", f"{values['outline_changed']:,}", f"By more than {outline:.2f} m somewhere."),
        Row("Height changed", f"{values['height_changed']:,}", f"By more than {height:.2f} m."),
        Row("Unchanged", f"{values['unchanged']:,}", "Buildings of both surveys within these tolerances."),
    ]
    pictures = [draw_polygons(rings, table["status"], COLORS)]
    for name, heading, limits in (
        ("outline_change", "Distance of the outlines (m)", [Mark("tolerance", outline)]),
        ("height_change", "Difference in height (m)", [Mark("tolerance", height), Mark("tolerance", -height)]),
    ):
        if np.isfinite(table[name]).any():
            bars = draw_histogram([Series("buildings", BLUE, table[name])], heading, "Buildings", limits)
            pictures.append(f"<h2>{heading}</h2>\n{bars}")
    return build_page("Changes since the earlier survey", lead, {"Buildings": rows}, "\n".join(pictures))
