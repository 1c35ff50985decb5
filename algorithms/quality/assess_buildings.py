"""Assess detected buildings against a reference, per point, per cell and per object."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass, parse_classes
from ..geometry.cell_outlines import outline_cells
from ..geometry.grid import Grid, connected_cells, find_cells, grid_over
from ..geometry.groups import placed, topmost
from ..geometry.polygon_overlap import are_in_polygons, as_polygons
from ..params import IGNORED_CLASSES, MIN_BUILDING_AREA
from ..report.page import Row, build_page, draw_map, outcome_of, percent, rows_of
from ..stage import Field, InputLayer, Layer, LayerFeatures, Measure, Report, stage, tunable
from .confusion import percentage
from .point_matching import counted_points, match_points

_RATES = (
    ("completeness", "completeness", "%"),
    ("correctness", "correctness", "%"),
    ("f", "F-score", "%"),
    ("quality", "quality", "%"),
    ("hits", "found", ""),
    ("misses", "missed", ""),
    ("false", "falsely called building", ""),
)
_MEASURES = (
    *(
        Measure(f"{of}_{name}", f"{of.capitalize()}: {title}", unit)
        for of in ("points", "cells", "objects")
        for name, title, unit in _RATES
        if of != "objects" or name not in ("quality", "hits")
    ),
    Measure("objects_true", "Objects in the reference"),
    Measure("objects_predicted", "Objects in the input"),
    Measure("cell_size", "Cell size", "m"),
)

# Names of the objects of the layer, by their outcome.
FOUND, MISSED, INVENTED, MISSED_PART, INVENTED_PART = "found", "missed", "invented", "missed part", "invented part"
_OBJECTS = Layer(
    "objects",
    "Found, missed and invented buildings",
    "Polygon",
    (
        Field("id", int, "number of the object, from 1"),
        Field(
            "kind",
            str,
            f"{FOUND} or {MISSED}: a building of the reference; {INVENTED}: one of the input that is not true; "
            f"{MISSED_PART}, {INVENTED_PART}: what a building that was found lacks or has too much",
        ),
        Field("area", float, "area seen from above", "m²"),
        Field("points", int, "building points in it, of the side that it belongs to"),
        Field("covered", float, "share that is building on the other side too, 0 to 1"),
    ),
    style="objects",
)


@stage(
    "Quality",
    tags="accuracy,completeness,correctness,F-score,F1,quality,evaluation,reference,validation,IoU,overlap",
    layers=(_OBJECTS,),
    measures=_MEASURES,
    reference="The same points with the true values; or give polygons of the true buildings.",
    input_layers=(InputLayer("reference_map", "True buildings", optional=True),),
)
def assess_buildings(
    xyz,
    classification,
    reference_xyz=None,
    reference_classification=None,
    reference_map=None,
    *,
    ignored_classes: str = IGNORED_CLASSES,
    cell_size: Optional[float] = tunable(
        None,
        within="[0.05, 100] m",
        automatic="0.5 m where the cloud has more than 6 points per m² of its bounding rectangle, 1 m elsewhere.",
    ),
    min_area: float = MIN_BUILDING_AREA.with_default(10.0),
    monitor=None,
):
    """Compare the buildings of a classification with a reference: completeness, correctness, F-score, quality.

    It counts per point, per cell and per object. Cells are counted by the topmost point, which leaves walls out: some
    references call them building, some don't. An object is found when at least half of it is. A layer shows which
    buildings were found, missed and invented.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m) of the input.
    classification : ndarray of shape (n,)
        Classes of the input; 6 is building.
    reference_xyz : ndarray of shape (m, 3), optional
        Coordinates (m) of the reference: the same points in any order, perhaps with others.
    reference_classification : ndarray of shape (m,), optional
        True classes.
    reference_map : LayerFeatures, optional
        Polygons of the buildings in place of a reference cloud: a base map, a cadastre or an earlier result. Of the
        points within, all are building, crowns over a roof included.

    Returns
    -------
    objects : LayerFeatures
        Polygons of the buildings of the reference, found or missed; of the input's that are not true; and of
        what buildings that were found lack or have too much.
    report : Report
        Percentages and counts, and a page with a map. A percentage of nothing is NaN.

    Other Parameters
    ----------------
    cell_size
        Side of the cells that are compared from above.

    Raises
    ------
    ValueError
        If there is no reference, a point of the input is not in the reference, or every point is ignored.

    Notes
    -----
    Points that are building in both are TP, in the reference only FN and in the input only FP. Completeness is
    TP / (TP + FN), correctness TP / (TP + FP) and quality TP / (TP + FN + FP). F is the harmonic mean of the first two.
    Ignored by default are the reference's noise (7, 18), bridges (17; 26 in the Netherlands) and what other agencies
    keep for artefacts, civil works and virtual points (64-67). Objects are groups of building cells that touch by a
    side or a corner. Parts are distinguished from ragged edges by their size: they have the minimum area and are
    three cells wide somewhere.

    References
    ----------
    Wiedemann et al. (1998), Empirical evaluation of automatically extracted road axes. [wiedemann1998]
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept, section 3.2.
    [santos2019]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> objects, report = assess_buildings(xyz, classes, xyz, classes)
    >>> float(report.values["cells_f"])
    100.0
    """
    true_classes = _true_classes(xyz, reference_xyz, reference_classification, reference_map, classification, monitor)
    xyz, called, true = counted_points(xyz, classification, true_classes, parse_classes(ignored_classes))
    predicted, true = called == PointClass.BUILDING, true == PointClass.BUILDING
    if cell_size is None:
        per_square_meter = len(xyz) / max(float(np.ptp(xyz[:, :2], axis=0).prod()), 1.0)
        cell_size = 0.5 if per_square_meter > 6.0 else 1.0
        monitor.resolved(cell_size=cell_size)
    monitor.progress(0.3)
    grid = grid_over(xyz, cell_size)
    cell = grid.number(xyz)
    top = topmost(xyz[:, 2], cell)
    values = {f"points_{name}": value for name, value in rates(predicted, true).items()}
    values.update({f"cells_{name}": value for name, value in rates(predicted[top], true[top]).items()})
    monitor.progress(0.6)
    reference, result = (
        _side(grid, cell[top], own[top], other[top], cell[own], min_area)
        for own, other in ((true, predicted), (predicted, true))
    )
    values.update(_object_rates(reference, result), cell_size=cell_size)
    monitor.inform(_summary(values))
    objects = _objects(grid, reference, result, min_area)
    monitor.progress(0.9)
    return objects, Report(values, _page(xyz, predicted, true, values, min_area))


def _true_classes(xyz, reference_xyz, reference_classification, reference_map, classification, monitor) -> np.ndarray:
    """Return the true class (n,) of each point of the input; points in no polygon of a map keep their class."""
    if reference_xyz is None and reference_map is None:
        raise ValueError(
            "There is no reference; give a point cloud (REFERENCE) or polygons of the buildings (REFERENCE_MAP)."
        )
    if reference_xyz is not None:
        if reference_map is not None:
            monitor.warn("The reference cloud is compared with; the polygons are left out.")
        return reference_classification[match_points(xyz, reference_xyz)]
    inside = are_in_polygons(xyz[:, :2], as_polygons(reference_map.geometries), monitor.part(0.0, 0.3))
    others = np.where(classification == PointClass.BUILDING, PointClass.UNCLASSIFIED, classification)
    return np.where(inside & ~np.isin(classification, NOISE), PointClass.BUILDING, others)


def rates(predicted: np.ndarray, true: np.ndarray) -> dict[str, float]:
    """Return completeness, correctness, F and quality (percent, NaN of nothing), and what they are counted from."""
    hits, misses, false = (int(mask.sum()) for mask in (predicted & true, ~predicted & true, predicted & ~true))
    return {
        "completeness": percentage(hits, hits + misses),
        "correctness": percentage(hits, hits + false),
        "f": percentage(2 * hits, 2 * hits + misses + false),
        "quality": percentage(hits, hits + misses + false),
        "hits": hits,
        "misses": misses,
        "false": false,
    }


@dataclass(frozen=True)
class _Side:
    """The building cells (m,) of one of two classifications, and the objects (k,) that they make."""

    cells: np.ndarray  #: (m,), int64: numbers of the cells, ascending
    group: np.ndarray  #: (m,), int: object of each, from 0
    shared: np.ndarray  #: (m,), bool: cells that are building in the other classification too
    covered: np.ndarray  #: (k,): share of each object that is, 0 to 1
    is_large: np.ndarray  #: (k,), bool: objects that count, by their area
    of_points: np.ndarray  #: (p,), int64: cell of each building point

    @property
    def agreed(self) -> np.ndarray:
        """Which objects count and lie by half in the other classification's buildings."""
        return self.is_large & (self.covered >= 0.5)


def _side(
    grid: Grid, cells: np.ndarray, own: np.ndarray, other: np.ndarray, of_points: np.ndarray, min_area: float
) -> _Side:
    """Return the objects of the cells that are ``own``, and how they look from the ``other`` classification.

    Parameters
    ----------
    grid : Grid
        Cells seen from above.
    cells : ndarray of shape (m,), int64
        Numbers of all cells with points, ascending.
    own : ndarray of shape (m,), bool
        Cells that are building in the one classification.
    other : ndarray of shape (m,), bool
        Cells that are building in the other one.
    of_points : ndarray of shape (p,), int64
        Cell of each building point of the one.
    min_area : float
        Area of the smallest object that counts, m².
    """
    count, group = connected_cells(grid, cells[own])
    size = np.bincount(group, minlength=count)
    covered = np.bincount(group, other[own], count) / np.maximum(size, 1)
    return _Side(cells[own], group, other[own], covered, size * grid.size**2 >= min_area, of_points)


def _object_rates(reference: _Side, result: _Side) -> dict[str, float]:
    """Return the share of the objects of each side that the other one covers by half, and their numbers."""
    found, true = int(reference.agreed.sum()), int(reference.is_large.sum())
    correct, predicted = int(result.agreed.sum()), int(result.is_large.sum())
    completeness, correctness = percentage(found, true), percentage(correct, predicted)
    return {
        "objects_completeness": completeness,
        "objects_correctness": correctness,
        "objects_f": percentage(2 * completeness * correctness / 100, completeness + correctness),
        "objects_true": true,
        "objects_predicted": predicted,
        "objects_misses": true - found,
        "objects_false": predicted - correct,
    }


def _objects(grid: Grid, true: _Side, predicted: _Side, min_area: float) -> LayerFeatures:
    """Return the layer of found, missed and invented buildings, from both sides."""
    kinds = (
        (FOUND, true, true.agreed[true.group]),
        (MISSED, true, (true.is_large & ~true.agreed)[true.group]),
        (INVENTED, predicted, (predicted.is_large & ~predicted.agreed)[predicted.group]),
        (MISSED_PART, true, _parts(grid, true, min_area)),
        (INVENTED_PART, predicted, _parts(grid, predicted, min_area)),
    )
    return LayerFeatures.numbered([feature for kind in kinds for feature in _features(grid, *kind)], _OBJECTS.fields)


def _parts(grid: Grid, side: _Side, min_area: float) -> np.ndarray:
    """Return the mask of cells of agreed objects that lie in large, wide groups that the other classification lacks."""
    rows = np.flatnonzero(side.agreed[side.group] & ~side.shared)
    cells = side.cells[rows]
    count, group = connected_cells(grid, cells)
    # Ragged edges are one or two cells wide; a wide part has a cell with all eight around it.
    inner = np.logical_and.reduce([find_cells(cells, cells + step)[1] for step in grid.around])
    wide = np.bincount(group, inner, count) > 0
    large = np.bincount(group, minlength=count) * grid.size**2 >= min_area
    return placed((wide & large)[group], rows, len(side.cells))


def _features(grid: Grid, kind: str, side: _Side, chosen: np.ndarray) -> Iterator[tuple[list, dict[str, Any]]]:
    """Yield the groups of the chosen cells of a side with their attributes."""
    cells = side.cells[chosen]
    count, group = connected_cells(grid, cells)
    position, inside = find_cells(cells, side.of_points)
    size, points = np.bincount(group, minlength=count), np.bincount(group[position[inside]], minlength=count)
    covered = np.bincount(group, side.shared[chosen], count) / size
    columns = (size * grid.size**2).tolist(), points.tolist(), covered.tolist()
    for rings, *facts in zip(outline_cells(grid, cells, group), *columns):
        yield rings, {"kind": kind, **dict(zip(("area", "points", "covered"), facts))}


def _summary(values: dict) -> str:
    """Return the rates of points and of buildings in a sentence each."""
    return " ".join(
        f"{title}: completeness {percent(values[f'{of}_completeness'])}, "
        f"correctness {percent(values[f'{of}_correctness'])}, F-score {percent(values[f'{of}_f'])}."
        for of, title in (("points", "Points"), ("objects", "Buildings"))
    )


def _page(xyz: np.ndarray, predicted: np.ndarray, true: np.ndarray, values: dict, min_area: float) -> str:
    lead = (
        f"Of {len(xyz):,} points, {values['points_hits'] + values['points_misses']:,} are building in the reference "
        f"and {values['points_hits'] + values['points_false']:,} in the classification that was assessed."
    )
    tables = {
        "Points": _rates_of(values, "points"),
        f"Seen from above, in cells of {values['cell_size']:g} m": _rates_of(values, "cells"),
        f"Buildings of at least {min_area:g} m²": rows_of(values, _MEASURES, _meanings_of_objects(values)),
    }
    legend = ("neither", "building in both", "missed", "falsely called building")
    return build_page("Quality of the buildings", lead, tables, draw_map(xyz, outcome_of(predicted, true), legend))


def _rates_of(values: dict, objects: str) -> list[Row]:
    """Return the rates of points or cells."""
    hits, misses, false = (values[f"{objects}_{name}"] for name in ("hits", "misses", "false"))
    called = f"{hits:,} of {hits + false:,} {objects}"
    meanings = {
        "completeness": f"Share of the reference's buildings that was found: {hits:,} of {hits + misses:,} {objects}.",
        "correctness": f"Share of the {objects} called building that are building: {called}.",
        "f": "Completeness and correctness in one figure, their harmonic mean.",
        "quality": f"Share of the {objects} called building by either side that both call building.",
    }
    titles = {name: title.capitalize() for name, title, _ in _RATES}
    named = {f"{objects}_{name}": (titles[name], meaning) for name, meaning in meanings.items()}
    return rows_of(values, _MEASURES, named)


def _meanings_of_objects(values: dict) -> dict[str, tuple[str, str]]:
    """Return name and meaning of the rates of objects."""
    completeness = (
        f"Share of the reference's {values['objects_true']:,} buildings found, by at least half; "
        f"{values['objects_misses']:,} were missed."
    )
    correctness = (
        f"Share of the {values['objects_predicted']:,} buildings found that are true, by half of their area; "
        f"{values['objects_false']:,} were invented."
    )
    both = "Completeness and correctness in one figure; the layer of objects shows each of them."
    return {
        "objects_completeness": ("Completeness", completeness),
        "objects_correctness": ("Correctness", correctness),
        "objects_f": ("F-score", both),
    }
