"""Assess classified ground against a reference."""

import numpy as np

from ..cloud.asprs import PointClass, parse_classes
from ..params import IGNORED_CLASSES
from ..report.page import build_page, draw_map, outcome_of, rows_of
from ..stage import Measure, Report, stage
from .confusion import percentage
from .point_matching import counted_points, match_points

_MEASURES = (
    Measure("type_1", "Type I error", "%"),
    Measure("type_2", "Type II error", "%"),
    Measure("total", "Total error", "%"),
    Measure("kappa", "Cohen's kappa", "%"),
    Measure("points", "Points compared"),
    Measure("ground_points", "Ground points in the reference"),
)


@stage(
    "Quality",
    tags="accuracy,type I error,type II error,total error,kappa,evaluation,reference,filter,validation,RMSE",
    measures=_MEASURES,
)
def assess_ground(
    xyz,
    classification,
    reference_xyz,
    reference_classification,
    *,
    ignored_classes: str = IGNORED_CLASSES.with_default("7, 9, 17, 18, 26, 64-67"),
    monitor=None,
):
    """Compare the ground of a classification with a reference: type I, type II and total error, kappa.

    Type I errors are ground that was lost, type II errors are objects that were taken for ground.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m) of the input.
    classification : ndarray of shape (n,)
        Classes of the input; 2 is ground, all others are object.
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
    Type I is the share of the true ground that was called object, type II the share of the true objects that were
    called ground. Total is the share of all points that are wrong, and kappa the agreement beyond chance. Ignored by
    default are the reference's noise, water and bridges, and what agencies keep for artefacts and virtual points.

    References
    ----------
    Sithole and Vosselman (2004), Experimental comparison of filter algorithms for bare-Earth extraction. [sithole2004]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> report = assess_ground(xyz, classes, xyz, classes)
    >>> float(report.values["total"])
    0.0
    """
    true_classes = reference_classification[match_points(xyz, reference_xyz)]
    xyz, called, true = counted_points(xyz, classification, true_classes, parse_classes(ignored_classes))
    monitor.progress(0.5)
    called, ground = called == PointClass.GROUND, true == PointClass.GROUND
    values = ground_errors(called, ground)
    return Report(values, _page(xyz, called, ground, values))


def ground_errors(called: np.ndarray, ground: np.ndarray) -> dict[str, float]:
    """Return type I, type II, total error and kappa (percent, NaN of nothing), and the points counted."""
    n, n_ground = len(ground), int(ground.sum())
    agree, share_called, share_ground = (float(mask.mean()) for mask in (called == ground, called, ground))
    chance = share_called * share_ground + (1 - share_called) * (1 - share_ground)
    lost, taken = int((ground & ~called).sum()), int((~ground & called).sum())
    return {
        "type_1": percentage(lost, n_ground),
        "type_2": percentage(taken, n - n_ground),
        "total": 100.0 * (1 - agree),
        "kappa": 100.0 * (agree - chance) / (1 - chance) if chance < 1 else float("nan"),
        "points": n,
        "ground_points": n_ground,
    }


def _page(xyz: np.ndarray, called: np.ndarray, ground: np.ndarray, values: dict) -> str:
    lost, taken = int((ground & ~called).sum()), int((~ground & called).sum())
    objects = values["points"] - values["ground_points"]
    ground_lost = f"Ground that was lost: {lost:,} of {values['ground_points']:,} ground points were not called ground."
    meanings = {
        "total": ("Total error", f"{lost + taken:,} of {values['points']:,} points are wrong."),
        "type_1": ("Type I error", ground_lost),
        "type_2": (
            "Type II error",
            f"Objects in the terrain: {taken:,} of {objects:,} other points were called ground.",
        ),
        "kappa": ("Kappa", "Agreement beyond what chance would give; 100 % is perfect, 0 % is chance."),
    }
    lead = f"{values['points']:,} points were compared with the reference, {values['ground_points']:,} of them ground."
    legend = ("object in both", "ground in both", "ground that was lost", "falsely called ground")
    picture = draw_map(xyz, outcome_of(called, ground), legend)
    return build_page("Quality of the ground", lead, {"Errors": rows_of(values, _MEASURES, meanings)}, picture)
