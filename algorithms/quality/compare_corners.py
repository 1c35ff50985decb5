"""How far the corners of buildings are from where an older map has them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Optional

import numpy as np

from ..geometry.grid import find_cells
from ..geometry.polygon_overlap import Polygons, as_polygons, overlaps, shared_areas
from ..geometry.rings import signed_area
from ..packages import spatial
from ..report.charts import BLUE, Mark, Series, draw_histogram, draw_scatter
from ..report.page import Row, build_page
from ..stage import Field, InputLayer, Layer, LayerFeatures, Measure, Monitor, Param, Report, feature_names, stage

# A vertex at which the outline turns by less is no corner but a point on a straight or round wall, degrees.
_LEAST_TURN = 20.0

# Largest difference in direction between corners that can be the same, degrees.
_FACING = 60.0

# No corner is looked for farther off (m) while the tolerance isn't known; most walls are longer.
_FARTHEST = 3.0

# Automatic tolerance (medians of the distances): where errors are normal, 99.8 % of the distances are less.
_MEDIANS = 3.0

# Least automatic tolerance (m), half of a short wall: corners that have moved since the map was made are still matched.
_LEAST_TOLERANCE = 1.0

# Pairs farther apart than this share of the farthest are by chance.
_FAR_OFF = 2 / 3

# Change (m) of the shift between two maps in one round, below which it is known.
_STILL = 1e-3

# Most rounds in which the shift is searched for.
_MOST_ROUNDS = 10

# Footprints and a map that lie farther apart (m) show different places, whatever of one place each of them lacks.
_ELSEWHERE = 1000.0

# Area (m²) below which a polygon is left out.
_NO_AREA = 1e-6

# Length (m) below which a line is left out.
_NO_LENGTH = 1e-3

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
        Field("counterpart", str, "what it was compared with in the other map, separated by commas"),
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
    "Compare corners",
    group="Quality",
    tags="cadastre,land registry,map,update,change detection,changes,displacement,shift,accuracy,footprints,RMSE",
    input_layers=(
        InputLayer("footprints", "Footprints", "Polygon", "New outlines of buildings."),
        InputLayer(
            "old_map",
            "Old map",
            "Polygon",
            "Buildings to compare with, cut to the area that was surveyed; without a map, all footprints are new.",
            optional=True,
        ),
    ),
    layers=(_DISPLACEMENTS, _BUILDINGS),
    measures=_MEASURES,
)
def compare_corners(
    footprints,
    old_map=None,
    *,
    min_overlap: Annotated[
        float,
        Param(
            "Minimum overlap",
            "Share of a building's area that the other map must cover for the building to be the same.",
            low=0,
            high=1,
            open_low=True,
        ),
    ] = 0.5,
    tolerance: Annotated[
        Optional[float],
        Param(
            "Tolerance",
            "Corners farther apart, when the shift between the maps is taken off, are not the same corner.",
            unit="m",
            low=0,
            high=100,
            open_low=True,
            automatic="three times the median distance of nearest corners that are not so by chance, 1 to 3 m.",
        ),
    ] = None,
    monitor=None,
):
    """Compare the corners of footprints with those of an older map: distances, shift, buildings found, missed and new.

    Buildings are the same where they overlap. Each corner of the old map is then matched with at most one of the
    footprints, the nearest pairs first, and arrows show from where to where it has moved.

    Parameters
    ----------
    footprints : LayerFeatures
        Polygons of the new outlines.
    old_map : LayerFeatures, optional
        Polygons to compare with.

    Returns
    -------
    displacements : LayerFeatures
        A line from the old to the new corner for each pair that is more than a millimeter apart.
    buildings : LayerFeatures
        All buildings of the old map, found or missed, then the new ones.
    report : Report
        Counts and distances, and a page with charts. What there is nothing to compute from is NaN.

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
    buildings and corners are matched; distances, arrows and the mean shift are those between the maps as they are.
    The standard deviation has the divisor n.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 4,
    table 2.
    """
    if old_map is None:
        monitor.warn("There is no old map to compare with" + (", so all footprints are new." if footprints else "."))
        old_map = LayerFeatures([], {})
    new, old = _cleaned(footprints, "footprints", monitor), _cleaned(old_map, "buildings of the old map", monitor)
    _refuse_elsewhere(old, new)
    corners, others = _corners(old.rings), _corners(new.rings)
    reach = max(_FARTHEST, tolerance or 0.0)
    shift = _shift(corners, others, _linked(old, new, min_overlap, np.zeros(2), monitor.part(0.0, 0.4)), reach)
    link = _linked(old, new, min_overlap, shift, monitor.part(0.4, 0.8))
    if len(old.area) and len(new.area) and not link.old_covered.any():
        monitor.warn("No footprint overlaps a building of the old map; check that both show the same place.")
    pairs = _same_corners(corners, others, link, tolerance, shift, reach, monitor)
    monitor.progress(0.9)
    moved = others.xy[pairs[1]] - corners.xy[pairs[0]]
    values = _values(corners, link, moved)
    layers = _displacements(old, new, corners, others, pairs), _buildings(old, new, corners, others, link, pairs)
    return (*layers, Report(values, _page(values, moved)))


@dataclass(frozen=True)
class _Map:
    """The usable polygons of a layer: their rings, the same as edges, their areas (m²) and what they are called."""

    rings: list
    polygons: Polygons
    area: np.ndarray
    names: list[str]


def _cleaned(features: LayerFeatures, called: str, monitor: Monitor) -> _Map:
    """Return the polygons of a layer that have an area; say how many don't, and how many cross themselves."""
    usable = [(rings, name) for rings, name in zip(map(_proper, features.geometries), feature_names(features)) if rings]
    if len(usable) < len(features):
        monitor.warn(f"{len(features) - len(usable)} of {len(features)} {called} have no area and were left out.")
    rings = [rings for rings, _ in usable]
    polygons = as_polygons(rings)
    area, every = polygons.area, np.arange(len(rings))
    # Places around which the rings wind twice, or the wrong way, count otherwise in the overlap with itself.
    crossing = int((np.abs(shared_areas(polygons, polygons, every, every, Monitor()) - area) > 0.01 * area).sum())
    if crossing:
        monitor.warn(
            f"{crossing} of {len(features)} {called} cross themselves, so that their areas may be wrong; "
            "run 'Fix geometries' on the layer first."
        )
    return _Map(rings, polygons, np.maximum(area, _NO_AREA), [name for _, name in usable])


def _refuse_elsewhere(old: _Map, new: _Map) -> None:
    """Refuse maps of which the one lies far from the other."""
    if not old.rings or not new.rings:
        return
    boxes = [np.concatenate([rings[0] for rings in one.rings]) for one in (old, new)]
    (low, high), (other_low, other_high) = [(box.min(axis=0), box.max(axis=0)) for box in boxes]
    apart = float(np.hypot(*np.maximum(0.0, np.maximum(low - other_high, other_low - high))))
    if apart > _ELSEWHERE:
        raise ValueError(
            f"The footprints and the old map lie {apart / 1000:,.0f} km apart; "
            "choose a map of this area, or check the coordinate reference systems of both."
        )


def _proper(rings: list) -> list:
    """Return the rings in plan that have an area, none without an exterior."""
    plan = [np.asarray(ring, float)[:, :2] for ring in rings]
    sound = [len(ring) > 3 and np.isfinite(ring).all() and abs(signed_area(ring)) > _NO_AREA for ring in plan]
    return [ring for ring, is_sound in zip(plan, sound) if is_sound] if sound and sound[0] else []


@dataclass(frozen=True)
class _Link:
    """Which buildings are the same: ``old[k]`` and ``new[k]``, in this order; and how much of each is covered."""

    old: np.ndarray
    new: np.ndarray
    old_covered: np.ndarray
    new_covered: np.ndarray
    is_found: np.ndarray
    is_new: np.ndarray


def _linked(old: _Map, new: _Map, min_overlap: float, shift: np.ndarray, monitor: Monitor) -> _Link:
    """Find the buildings that are the same in both maps, the old one moved by ``shift`` (2,)."""
    one, other, shared = overlaps(old.polygons.moved(shift), new.polygons, monitor)
    old_covered = np.minimum(np.bincount(one, shared, len(old.area)) / old.area, 1.0)
    new_covered = np.minimum(np.bincount(other, shared, len(new.area)) / new.area, 1.0)
    # Rounding must not lose an overlap of exactly the minimum.
    least = min_overlap * (1 - 1e-9)
    is_found = old_covered >= least
    known = np.bincount(other, shared * is_found[one], len(new.area)) / new.area
    same = is_found[one] & (shared >= least * np.minimum(old.area[one], new.area[other]))
    return _Link(one[same], other[same], old_covered, new_covered, is_found, known < least)


@dataclass(frozen=True)
class _Corners:
    """Corners (n, 2) of polygons, the polygon of each, and the unit vector that it faces."""

    xy: np.ndarray
    building: np.ndarray
    facing: np.ndarray


def _corners(polygons: list) -> _Corners:
    """Return the corners of polygons: the vertices at which their outlines turn."""
    every = [(number, ring) for number, rings in enumerate(polygons) for ring in rings]
    found = [(number, *_turns(ring)) for number, ring in every]
    counts = [len(xy) for _, xy, _ in found]
    return _Corners(
        np.concatenate([np.zeros((0, 2)), *(xy for _, xy, _ in found)]),
        np.repeat([number for number, *_ in found], counts).astype(np.int64),
        np.concatenate([np.zeros((0, 2)), *(facing for *_, facing in found)]),
    )


def _turns(ring: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of a closed ring, and the way each faces."""
    step = np.diff(ring, axis=0)
    is_long = np.hypot(*step.T) > _NO_LENGTH
    xy, step = ring[:-1][is_long], step[is_long]
    after = step / np.hypot(*step.T)[:, None]
    before = np.roll(after, 1, axis=0)
    turn = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], (before * after).sum(axis=1))
    chosen = np.abs(turn) >= np.deg2rad(_LEAST_TURN)
    facing = (before - after)[chosen]
    return xy[chosen], facing / np.hypot(*facing.T)[:, None]


def _shift(old: _Corners, new: _Corners, link: _Link, reach: float) -> np.ndarray:
    """Return by how much (2,), m, the new map is off the old one: the median of what the corners of both say."""
    shift = np.zeros(2)
    for _ in range(_MOST_ROUNDS):
        one, other, _ = _nearest_first(old, new, link, shift, reach)
        before = shift
        shift = np.median(new.xy[other] - old.xy[one], axis=0) if len(one) else shift
        if np.hypot(*(shift - before)) < _STILL:
            break
    return shift


def _same_corners(
    old: _Corners,
    new: _Corners,
    link: _Link,
    tolerance: Optional[float],
    shift: np.ndarray,
    reach: float,
    monitor: Monitor,
) -> tuple[np.ndarray, np.ndarray]:
    """Match corners of the same buildings one to one, the shift between the maps taken off."""
    one, other, distance = _nearest_first(old, new, link, shift, reach)
    if tolerance is None:
        tolerance = float(np.clip(_MEDIANS * typical_distance(distance), _LEAST_TOLERANCE, _FARTHEST))
        monitor.resolved(tolerance=tolerance)
    near = distance <= tolerance
    return one[near], other[near]


def typical_distance(distance: np.ndarray) -> float:
    """Return the median of the distances (up to 3 m) that are not by chance, 0 without any."""
    # Pairs by chance are spread evenly in plan: how many there are shows where no others are left, far off.
    ordered = np.sort(distance) / _FARTHEST
    by_chance = min(float((ordered > _FAR_OFF).sum() / (1 - _FAR_OFF**2)), len(ordered))
    others = np.arange(1, len(ordered) + 1) - by_chance * ordered**2
    reached = np.flatnonzero(others >= (len(ordered) - by_chance) / 2)
    return float(ordered[reached[0]]) * _FARTHEST if len(reached) else 0.0


def _nearest_first(
    old: _Corners, new: _Corners, link: _Link, shift: np.ndarray, reach: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return pairs of corners within ``reach`` (m) that can be the same, each corner once, the nearest pairs first."""
    if not len(link.old) or not len(old.xy) or not len(new.xy):
        return np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0)
    trees = spatial.cKDTree(old.xy + shift), spatial.cKDTree(new.xy)
    near = trees[0].sparse_distance_matrix(trees[1], reach, output_type="ndarray")
    one, other, distance = near["i"], near["j"], near["v"]
    count = len(link.is_new)
    linked = find_cells(link.old * count + link.new, old.building[one] * count + new.building[other])[1]
    facing = (old.facing[one] * new.facing[other]).sum(axis=1) >= np.cos(np.deg2rad(_FACING))
    alike = linked & facing
    one, other, distance = one[alike], other[alike], distance[alike]
    order = np.lexsort((other, one, distance))
    taken: tuple[set, set] = set(), set()
    kept = []
    for row, i, j in zip(order.tolist(), one[order].tolist(), other[order].tolist()):
        if i not in taken[0] and j not in taken[1]:
            taken[0].add(i)
            taken[1].add(j)
            kept.append(row)
    return one[kept], other[kept], distance[kept]


def _values(old: _Corners, link: _Link, moved: np.ndarray) -> dict[str, float]:
    """Return the measures of the comparison; those of distances are NaN without corners that match."""
    distance = np.hypot(*moved.T)
    undefined = not len(distance)
    return {
        "old_buildings": len(link.is_found),
        "all_footprints": len(link.is_new),
        "found": int(link.is_found.sum()),
        "missed": int((~link.is_found).sum()),
        "new": int(link.is_new.sum()),
        "corners": int(link.is_found[old.building].sum()),
        "matched": len(distance),
        **{
            name: float("nan") if undefined else float(measure(distance))
            for name, measure in (
                ("mean", np.mean),
                ("minimum", np.min),
                ("maximum", np.max),
                ("median", np.median),
                ("deviation", np.std),
            )
        },
        "mean_dx": float("nan") if undefined else float(moved[:, 0].mean()),
        "mean_dy": float("nan") if undefined else float(moved[:, 1].mean()),
    }


def _displacements(old: _Map, new: _Map, corners: _Corners, others: _Corners, pairs: tuple) -> LayerFeatures:
    """Return the layer of arrows, by building of the old map."""
    order = np.lexsort((pairs[1], pairs[0]))
    layer = LayerFeatures([], {declared.name: [] for declared in _DISPLACEMENTS.fields})
    for i, j in zip(pairs[0][order].tolist(), pairs[1][order].tolist()):
        dx, dy = (others.xy[j] - corners.xy[i]).tolist()
        length = float(np.hypot(dx, dy))
        if length <= _NO_LENGTH:
            continue
        row = (len(layer) + 1, old.names[corners.building[i]], new.names[others.building[j]], length, dx, dy)
        layer.geometries.append(np.stack([corners.xy[i], others.xy[j]]))
        for column, value in zip(layer.columns.values(), row):
            column.append(value)
    return layer


def _buildings(
    old: _Map, new: _Map, corners: _Corners, others: _Corners, link: _Link, pairs: tuple[np.ndarray, np.ndarray]
) -> LayerFeatures:
    """Return the layer of buildings: those of the old map, then the new ones."""
    distance = np.hypot(*(others.xy[pairs[1]] - corners.xy[pairs[0]]).T)
    building, n = corners.building[pairs[0]], len(old.names)
    matched = np.bincount(building, minlength=n)
    most = np.full(n, np.nan)
    np.fmax.at(most, building, distance)
    mean = np.where(matched > 0, np.bincount(building, distance, n) / np.maximum(matched, 1), np.nan)
    partners: list[list[str]] = [[] for _ in old.names]
    for i, j in zip(link.old.tolist(), link.new.tolist()):
        partners[i].append(new.names[j])
    fresh = np.flatnonzero(link.is_new)
    none = np.full(len(fresh), np.nan)
    columns = {
        "id": np.arange(1, n + len(fresh) + 1),
        "status": [FOUND if is_found else MISSED for is_found in link.is_found] + [NEW] * len(fresh),
        "building": old.names + [new.names[j] for j in fresh],
        "counterpart": [", ".join(names) for names in partners] + [""] * len(fresh),
        "area": np.append(old.area, new.area[fresh]),
        "covered": np.append(link.old_covered, link.new_covered[fresh]),
        "corners": np.append(
            np.bincount(corners.building, minlength=n), np.bincount(others.building, minlength=len(new.names))[fresh]
        ),
        "matched": np.append(matched, np.zeros(len(fresh), np.int64)),
        "mean_distance": np.append(mean, none),
        "max_distance": np.append(most, none),
    }
    return LayerFeatures(old.rings + [new.rings[j] for j in fresh], columns)


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
            Row("Mean", _meters(values["mean"]), "From the corner in the old map to the new corner."),
            Row("Minimum", _meters(values["minimum"]), "The corner that has moved least."),
            Row("Maximum", _meters(values["maximum"]), "The corner that has moved most."),
            Row("Median", _meters(values["median"]), "Half of the corners have moved by less."),
            Row("Standard deviation", _meters(values["deviation"]), "How much the distances differ among themselves."),
        ],
        "Shift between the maps": _shift_rows(moved),
    }
    distance = np.hypot(*moved.T)
    marks = [Mark("mean", values["mean"]), Mark("median", values["median"])]
    bars = draw_histogram([Series("corners", BLUE, distance)], "Distance (m)", "Corners", marks)
    rose = draw_scatter(moved, "Displacement of a corner, north is up", "m", "mean shift")
    pictures = f"<h2>Distances</h2>\n{bars}<h2>Displacements</h2>\n{rose}"
    return build_page("Corners against the old map", lead, tables, pictures)


def _shift_rows(moved: np.ndarray) -> list[Row]:
    """Return what is systematic in the displacements and what is left without it."""
    undefined = float("nan")
    dx, dy = moved.mean(axis=0).tolist() if len(moved) else (undefined, undefined)
    left = float(np.sqrt(((moved - [dx, dy]) ** 2).sum(axis=1).mean())) if len(moved) else undefined
    return [
        Row("Eastward", _meters(dx), "Mean of the displacements to the east; negative is to the west."),
        Row("Northward", _meters(dy), "Mean of the displacements to the north; negative is to the south."),
        Row("Together", _meters(float(np.hypot(dx, dy))), "Length of the mean shift."),
        Row(
            "Without it", _meters(left), "Root mean square of the distances that were left if the shift were taken off."
        ),
    ]


def _meters(value: float) -> str:
    """Return a length as people read it."""
    return "undefined" if math.isnan(value) else f"{value:.3f} m"
