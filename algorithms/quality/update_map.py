"""Update a map of buildings: redraw what has changed, keep everything else as it is."""

from collections import Counter
from typing import Callable, Optional

import numpy as np

from ..footprints.extract_footprints import extract_footprints
from ..footprints.footprint_points import require_ground
from ..geometry.polygon_overlap import in_squares
from ..geometry.rings import polygon_area
from ..params import MIN_BUILDING_AREA
from ..report.page import Row, build_page
from ..report.polygon_map import draw_polygons
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Field, InputLayer, Layer, LayerFeatures, Measure, Monitor, Report, feature_names, stage, tunable
from .building_maps import AROUND, clean_map, refuse_apart
from .changed_block import ChangedBlock
from .corner_matching import LEAST_TOLERANCE, MEDIANS, MOST_TOLERANCE

# The docstring names RULES.
from .map_changes import COLORS, GONE, NEW, OLD, RULES, STATUS, MapUpdate, SeenPoints, roof_points  # noqa: F401
from .map_fit import MapFit, fit_map

_FIELDS = (
    STATUS,
    Field("confidence", float, "share of it on which map and points agree, 0 to 1"),
    Field("added", float, "area of the parts added", "m²"),
    Field("removed", float, "area of the parts cut off", "m²"),
    Field("shift_east", float, "how far it was shifted to the east", "m"),
    Field("shift_north", float, "how far it was shifted to the north", "m"),
    Field("height_change", float, "how far its roof has risen since the earlier survey, in the median", "m"),
)

# Side (m) of the squares in which buildings are decided on, which bounds the memory of their lattices.
_SIDE = 400.0

# Coordinates (n, 3), m, and classes (n,) of some points of a survey.
Points = tuple[np.ndarray, np.ndarray]

_GONE_FIELDS = (Field("confidence", float, "share of it where points show the ground, 0 to 1"),)
_MEASURES = (
    Measure("old_buildings", "Buildings in the old map"),
    *(Measure(name.replace(" ", "_"), f"Buildings {name}") for name in COLORS),
    Measure("map_shift_east", "Shift of the points against the map eastward", "m"),
    Measure("map_shift_north", "Shift of the points against the map northward", "m"),
    Measure("overhang", "How far roofs reach beyond the walls of the map", "m"),
)


def _update_in_windows(
    read: Callable[[np.ndarray], list[Points]],
    side: float,
    old_map: LayerFeatures,
    footprints: LayerFeatures,
    *,
    min_area: float,
    least_width: Optional[float],
    id_field: str,
    sampling: CloudSampling,
    monitor: Monitor,
) -> tuple[LayerFeatures, LayerFeatures, Report]:
    """Update a map square by square of a side (m), with the points that ``read`` returns in a box (2, 2), m.

    These are the points of the survey, and of the earlier one. The usual shift and overhang of the map are measured
    on all outlines before.
    """
    # Refuses an attribute that the map does not have.
    feature_names(old_map, id_field)
    old = clean_map(old_map, "buildings of the old map", monitor)
    new = clean_map(footprints, "new footprints", monitor)
    refuse_apart(old, new, "old map", "new footprints")
    fit = fit_map(old, new)
    if least_width is None:
        least_width = float(np.clip(MEDIANS * fit.deviation, LEAST_TOLERANCE, MOST_TOLERANCE))
        monitor.resolved(least_width=least_width)
    start = MapUpdate.of(old, new, fit)
    update, part, done, kinds = start.copied(), start.copied(), 0, np.zeros(0, np.uint8)
    for own, near, box in in_squares(start.boxes, AROUND, min(side, _SIDE)):
        clouds = read(box + fit.shift)
        kinds = np.union1d(kinds, clouds[0][1])
        points, roofs = SeenPoints.of(*clouds[0], fit, sampling), [roof_points(*one, fit) for one in clouds]
        for olds, news in start.blocks(least_width, near):
            ChangedBlock(part, points, olds, news, least_width, min_area).decide(roofs)
        update.take(part, own)
        part.take(start, near)
        part.drawn.clear()
        done += len(own)
        monitor.progress(done / len(start.boxes))
    if len(kinds):
        require_ground(kinds)
    sure = footprints.columns.get("confidence", [np.nan] * len(footprints))
    if not _new_ids(old_map, id_field, 0)[0]:
        monitor.inform("The map has no attribute 'id' or 'fid': its buildings are numbered in a new one, 'id'.")
    updated, gone = _layers(update, old_map, old.rows.tolist(), np.array(sure)[new.rows], id_field)
    report = _report(update, updated, gone, fit)
    monitor.inform(_summary(report.values))
    if update.undrawn:
        monitor.warn(f"New buildings left out, as no outline fits between the buildings of the map: {update.undrawn}.")
    return updated, gone, report


@stage(
    "Quality",
    tags="update,change detection,cadastre,base map,new,demolished,gone,extension,annex,shifted,maintenance,"
    "OpenStreetMap,conflation",
    input_layers=(
        InputLayer("old_map", buildings=True),
        InputLayer("footprints", "New footprints", optional=True, buildings=True),
    ),
    layers=(
        Layer("updated_map", "Updated map", "Polygon", _FIELDS, style="updated_map"),
        Layer("buildings_gone", "Buildings gone", "Polygon", _GONE_FIELDS),
    ),
    measures=_MEASURES,
    reference_title="Earlier point cloud",
    reference="A survey before this one, to find roofs that have risen or fallen since.",
    cost=20.0,
    reach=AROUND,
    windowed=_update_in_windows,
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
        within="[0.5, 20] m",
        automatic=(
            f"{MEDIANS:g} times the median distance between the walls of the map and the new ones, "
            f"{LEAST_TOLERANCE:g} to {MOST_TOLERANCE:g} m."
        ),
    ),
    id_field: str = tunable(""),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Update a map of buildings from a classified cloud: what has not changed stays as it is, with ids and attributes.

    Every building gets a status. Parts that were added or torn down are drawn along the old walls where these are still
    right. New buildings share the walls of those that they touch. Buildings that the points don't show stay. Clouds of
    any size will do: with more than 10 million points, surveys of many tiles too, they are read part by part where new
    footprints are given, as from 'Detect buildings' in tiles.

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
        Buildings with their attributes, from any source.
    footprints : LayerFeatures, optional
        New outlines of buildings, from 'Detect buildings' or another source; without them they are extracted from the
        classified points.

    Returns
    -------
    updated_map : LayerFeatures
        The buildings of the map that are not gone, in their order, then the new ones, with the attributes of the map
        after the attributes of the update. Names that are used become ``map_…``.
    buildings_gone : LayerFeatures
        Those that are gone, with their attributes.
    report : Report
        Counts, and a page with a map.

    Other Parameters
    ----------------
    least_width
        Narrower strips that were added or removed are errors of the map or of the points.
    id_field
        Attribute that identifies a building; new ones get new values of it. Empty: 'id' or 'fid'; where the map has
        neither, all buildings are numbered in a new 'id'.

    Raises
    ------
    ValueError
        If no point is called ground, the map has no attribute ``id_field``, or it lies over a kilometer from the new
        outlines.

    Notes
    -----
    The usual shift between the map and the new outlines, and how far these lie outside of its walls, are measured on
    all buildings and taken off the new outlines: new parts are drawn as the map draws its own. Buildings that touch
    are shifted together where all their walls lie elsewhere, by more than the others'. Then points are read by squares
    of ``_SIDE`` m or less, and seen ``AROUND`` m around the buildings of each: each building is decided on in one.

    A part was added where the new outlines cover what the map does not, and removed where they don't and points show
    the ground on at least half of it. Both are at least ``least_width`` wide and have ``min_area``. A building is gone
    if the new outlines cover at most ``RULES.gone`` of it and points show the ground on most of it. Where most of it
    has no points it was not seen. Otherwise, if the new outlines cover less than half of it, it is doubtful.

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
    feature_names(old_map, id_field)
    if footprints is None:
        extracting = monitor.part(0.0, 0.5)
        footprints = extract_footprints(xyz, classification, cluster_id, sampling=sampling, monitor=extracting)
    clouds = [(xyz, classification)]
    if reference_xyz is not None:
        unknown = np.zeros(len(reference_xyz))
        clouds.append((reference_xyz, unknown if reference_classification is None else reference_classification))

    def read(box: np.ndarray) -> list[Points]:
        near = [((one[:, :2] >= box[0]) & (one[:, :2] < box[1])).all(axis=1) for one, _ in clouds]
        return [(one[is_near], kinds[is_near]) for is_near, (one, kinds) in zip(near, clouds)]

    return _update_in_windows(
        read,
        _SIDE,
        old_map,
        footprints,
        min_area=min_area,
        least_width=least_width,
        id_field=id_field,
        sampling=sampling,
        monitor=monitor.part(0.5, 1.0),
    )


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


def _layers(
    update: MapUpdate, old_map: LayerFeatures, rows: list[int], sure: np.ndarray, id_field: str
) -> tuple[LayerFeatures, LayerFeatures]:
    """Return the buildings that are there, the new ones last, and those that are gone, with the attributes of the map.

    ``rows`` are the old buildings in their layer, ``sure`` the confidences of the new outlines.
    """
    new = [rings for _, rings in update.built]
    same = update.is_same
    outlines = [old_map.geometries[at] if is_same else own for at, own, is_same in zip(rows, update.rings, same)]
    sources = [old_map.sources[at] if is_same and old_map.sources else None for at, is_same in zip(rows, same)]
    polygons = [update.drawn.get((OLD, row)) or [own] for row, own in enumerate(outlines)] + [[own] for own in new]
    zero, shift = [0.0] * len(new), np.where(np.array(same)[:, None], 0.0, update.shift)
    table = {
        "status": [*update.status, *[NEW] * len(new)],
        "confidence": [*update.confidence, *(sure[row] for row, _ in update.built)],
        "added": [*update.added, *map(polygon_area, new)],
        "removed": [*update.removed, *zero],
        "shift_east": [*shift[:, 0], *zero],
        "shift_north": [*shift[:, 1], *zero],
        "height_change": [*update.rise, *[np.nan] * len(new)],
    }
    key, ids = _new_ids(old_map, id_field, len(new))

    def layer(fields: tuple[Field, ...], is_wanted: Callable[[str], bool]) -> LayerFeatures:
        chosen = [row for row, status in enumerate(table["status"]) if is_wanted(status)]
        parts = [row for row in chosen for _ in polygons[row]]
        columns = {one.name: [table[one.name][row] for row in parts] for one in fields}
        for known, (name, values) in zip(old_map.columns, old_map.kept(rows, fields).items()):
            of_all = values + (ids if known == key else [None] * len(ids))
            columns[name] = [of_all[row] for row in parts]
        if not key:
            columns["id"] = [row + 1 for row in parts]
        every = [*sources, *[None] * len(new)]
        return LayerFeatures([own for row in chosen for own in polygons[row]], columns, [every[row] for row in parts])

    return layer(_FIELDS, lambda status: status != GONE), layer(_GONE_FIELDS, lambda status: status == GONE)


def _report(update: MapUpdate, updated: LayerFeatures, lost: LayerFeatures, fit: MapFit) -> Report:
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
