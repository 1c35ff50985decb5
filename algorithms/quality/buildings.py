"""How good detected buildings are: against a reference, per point, per cell and per object."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from ..cloud.cells import Grid, connected_cells, find_cells, grid_over
from ..params import AssessmentCellSize, IgnoredClasses, MinBuildingArea
from ..stage import Measure, Report, stage
from .matching import compared_points, parse_classes
from .page import Row, build_page, draw_map, outcome_of, percent

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
    *(Measure(f"points_{name}", f"Points: {title}", unit) for name, title, unit in _RATES),
    *(Measure(f"cells_{name}", f"Cells: {title}", unit) for name, title, unit in _RATES),
    Measure("objects_completeness", "Objects: completeness", "%"),
    Measure("objects_correctness", "Objects: correctness", "%"),
    Measure("objects_true", "Objects in the reference"),
    Measure("objects_predicted", "Objects in the input"),
    Measure("cell_size", "Cell size", "m"),
)


@stage(
    "Assess buildings",
    group="Quality",
    tags="accuracy,completeness,correctness,F-score,F1,quality,evaluation,reference,validation",
    measures=_MEASURES,
)
def assess_buildings(
    xyz,
    classification,
    reference_xyz,
    reference_classification,
    *,
    ignored_classes: IgnoredClasses = "7, 17, 18, 26, 64-67",
    cell_size: AssessmentCellSize = None,
    min_area: MinBuildingArea = 10.0,
    monitor=None,
):
    """Compare the buildings of a classification with those of a reference: completeness, correctness, F-score, quality.

    Counted three ways: per point; per cell, by the topmost point, which is blind to walls (some references call them
    building, some don't); and per object, a building being found when at least half of it is.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m) of the input.
    classification : ndarray of shape (n,)
        Classes of the input; 6 is building.
    reference_xyz : ndarray of shape (m, 3)
        Coordinates (m) of the reference: the same points in any order, perhaps with others.
    reference_classification : ndarray of shape (m,)
        True classes.

    Returns
    -------
    Report
        Percentages and counts, and a page with a map. A percentage of nothing is NaN.

    Raises
    ------
    ValueError
        If a point of the input is not in the reference, or every point is ignored.

    Notes
    -----
    With TP points that are building in both, FN in the reference only and FP in the input only: completeness
    TP / (TP + FN), correctness TP / (TP + FP), quality TP / (TP + FN + FP), and F the harmonic mean of the first two.
    Ignored by default are the reference's noise (7, 18), bridges (17; 26 in the Netherlands) and what other agencies
    keep for artefacts, civil works and virtual points (64-67). Objects are groups of building cells that touch by a
    side or a corner.

    References
    ----------
    Wiedemann et al. (1998), Empirical evaluation of automatically extracted road axes.
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept, section 3.2.
    """
    xyz, called, true = compared_points(
        xyz, classification, reference_xyz, reference_classification, parse_classes(ignored_classes)
    )
    predicted, true = called == PointClass.BUILDING, true == PointClass.BUILDING
    if cell_size is None:
        cell_size = 0.5 if len(xyz) / max(float(np.ptp(xyz[:, :2], axis=0).prod()), 1.0) > 6 else 1.0
        monitor.resolved(cell_size=cell_size)
    monitor.progress(0.3)
    grid = grid_over(xyz, cell_size)
    cell = grid.number(xyz)
    top = topmost_points(cell, xyz[:, 2])
    values = {f"points_{name}": value for name, value in rates(predicted, true).items()}
    values.update({f"cells_{name}": value for name, value in rates(predicted[top], true[top]).items()})
    monitor.progress(0.6)
    values.update(_objects(grid, cell[top], predicted[top], true[top], min_area), cell_size=cell_size)
    return Report(values, _page(xyz, predicted, true, values, min_area))


def rates(predicted: np.ndarray, true: np.ndarray) -> dict[str, float]:
    """Return completeness, correctness, F and quality (percent, NaN of nothing), and what they are counted from."""
    hits, misses, false = (int(mask.sum()) for mask in (predicted & true, ~predicted & true, predicted & ~true))
    return {
        "completeness": _share(hits, hits + misses),
        "correctness": _share(hits, hits + false),
        "f": _share(2 * hits, 2 * hits + misses + false),
        "quality": _share(hits, hits + misses + false),
        "hits": hits,
        "misses": misses,
        "false": false,
    }


def topmost_points(cell: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    """Return the row of the highest point of each occupied cell, by cell; of equals the last."""
    order = np.lexsort((elevation, cell))
    return order[np.diff(cell[order], append=-1) != 0]


def _share(part: float, whole: float) -> float:
    return 100.0 * part / whole if whole else float("nan")


def _objects(grid: Grid, cells: np.ndarray, predicted: np.ndarray, true: np.ndarray, min_area: float) -> dict:
    """Return the share of the objects of each side that the other one covers by half, and their numbers."""
    completeness, n_true = _covered(grid, cells[true], cells[predicted], min_area)
    correctness, n_predicted = _covered(grid, cells[predicted], cells[true], min_area)
    return {
        "objects_completeness": completeness,
        "objects_correctness": correctness,
        "objects_true": n_true,
        "objects_predicted": n_predicted,
    }


def _covered(grid: Grid, of: np.ndarray, by: np.ndarray, min_area: float) -> tuple[float, int]:
    """Return the share of the groups of cells ``of`` that lie by half in the cells ``by``, and their number."""
    count, group = connected_cells(grid, of)
    size = np.bincount(group, minlength=count)
    hit = np.bincount(group[find_cells(by, of)[1]], minlength=count)
    large = size * grid.size**2 >= min_area
    return _share(int((hit[large] >= 0.5 * size[large]).sum()), int(large.sum())), int(large.sum())


def _page(xyz: np.ndarray, predicted: np.ndarray, true: np.ndarray, values: dict, min_area: float) -> str:
    lead = (
        f"Of {len(xyz):,} points, {values['points_hits'] + values['points_misses']:,} are building in the reference "
        f"and {values['points_hits'] + values['points_false']:,} in the classification that was assessed."
    )
    tables = {
        "Points": _rows(values, "points", "points"),
        f"Seen from above, in cells of {values['cell_size']:g} m": _rows(values, "cells", "cells"),
        f"Buildings of at least {min_area:g} m²": _object_rows(values),
    }
    legend = ("neither", "building in both", "missed", "falsely called building")
    return build_page("Quality of the buildings", lead, tables, draw_map(xyz, outcome_of(predicted, true), legend))


def _rows(values: dict, prefix: str, things: str) -> list[Row]:
    hits, misses, false = (values[f"{prefix}_{name}"] for name in ("hits", "misses", "false"))
    return [
        Row(
            "Completeness",
            percent(values[f"{prefix}_completeness"]),
            f"So much of the reference's buildings was found: {hits:,} of {hits + misses:,} {things}.",
        ),
        Row(
            "Correctness",
            percent(values[f"{prefix}_correctness"]),
            f"So much of what was called building is building: {hits:,} of {hits + false:,} {things}.",
        ),
        Row(
            "F-score",
            percent(values[f"{prefix}_f"]),
            "Completeness and correctness in one figure, their harmonic mean.",
        ),
        Row(
            "Quality",
            percent(values[f"{prefix}_quality"]),
            f"Of all {things} that are building on either side, so many are building on both.",
        ),
    ]


def _object_rows(values: dict) -> list[Row]:
    return [
        Row(
            "Completeness",
            percent(values["objects_completeness"]),
            f"So many of the reference's {values['objects_true']:,} buildings were found, by at least half.",
        ),
        Row(
            "Correctness",
            percent(values["objects_correctness"]),
            f"So many of the {values['objects_predicted']:,} buildings found are true, by half of their area or more.",
        ),
    ]
