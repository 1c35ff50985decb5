"""Assess all classes against a reference: the confusion matrix and the figures from it."""

import numpy as np

from ..cloud.asprs import CODES, NOISE, VEGETATION, PointClass, parse_classes
from ..geometry.groups import mask_of
from ..params import IGNORED_CLASSES
from ..report.charts import draw_matrix
from ..report.page import FALSE, HIT, MISS, REST, build_page, draw_map, draw_table, percent, rows_of
from ..stage import Measure, Report, stage, tunable
from .confusion import class_rates, cohens_kappa, confusion, overall_accuracy
from .point_matching import counted_points, match_points

# Classes that have an output of their own, by the names of these.
_KINDS = {
    "ground": (PointClass.GROUND,),
    "vegetation": VEGETATION,
    "building": (PointClass.BUILDING,),
    "water": (PointClass.WATER,),
    "wires": (
        PointClass.WIRE_GUARD,
        PointClass.WIRE_CONDUCTOR,
        PointClass.TRANSMISSION_TOWER,
        PointClass.WIRE_CONNECTOR,
    ),
    "bridges": (PointClass.BRIDGE_DECK,),
    "noise": NOISE,
}

# Names of the colors of the map.
_LEGEND = ("right", "another class called ground", "ground called another class", "other classes confused")


_MEASURES = (
    Measure("accuracy", "Overall accuracy", "%"),
    Measure("kappa", "Cohen's kappa", "%"),
    Measure("mean_iou", "Mean intersection over union", "%"),
    *(Measure(f"{kind}_f", f"F-score of {kind}", "%") for kind in _KINDS),
    *(Measure(f"{kind}_iou", f"Intersection over union of {kind}", "%") for kind in _KINDS),
    Measure("points", "Points compared"),
)


@stage(
    "Quality",
    tags="accuracy,confusion matrix,kappa,overall accuracy,IoU,F-score,F1,completeness,reference,validation",
    measures=_MEASURES,
)
def assess_classes(
    xyz,
    classification,
    reference_xyz,
    reference_classification,
    *,
    ignored_classes: str = IGNORED_CLASSES.with_default("64-67"),
    merged_classes: str = tunable("0, 1; 3-5; 7, 18; 13-16"),
    monitor=None,
):
    """Compare all classes with a reference: confusion matrix, accuracy, kappa, and figures of each class.

    The page shows the matrix as a heat map, completeness, correctness, F-score and intersection over union of each
    class, and a map of the errors.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m) of the input.
    classification : ndarray of shape (n,)
        Classes of the input.
    reference_xyz : ndarray of shape (m, 3)
        Coordinates (m) of the reference: the same points in any order, perhaps with others.
    reference_classification : ndarray of shape (m,)
        True classes.

    Returns
    -------
    Report
        Percentages, and a page with the matrix and a map. A percentage of nothing is NaN.

    Other Parameters
    ----------------
    merged_classes
        Classes that count as one: numbers and ranges separated by commas, and one such group from the next by a
        semicolon; empty merges none.

    Raises
    ------
    ValueError
        If a point of the input is not in the reference, every point is ignored, or a class is in two merged groups.

    Notes
    -----
    Points of a class in both are TP, in the reference only FN and in the input only FP. Completeness is TP / (TP + FN),
    correctness TP / (TP + FP), F their harmonic mean and intersection over union TP / (TP + FN + FP). The mean of the
    latter is over the classes, as merged, that the reference has. Figures of ground (2), vegetation (3-5), building
    (6), water (9), wires and masts (13-16), bridges (17) and noise (7, 18) are outputs, too, however classes are
    merged. Classes of a reference that mean "everything else" (1) are best ignored.

    References
    ----------
    Congalton, R. G., 1991. A review of assessing the accuracy of classifications of remotely sensed data. Remote
    Sensing of Environment 37(1), 35-46. [congalton1991]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> report = assess_classes(xyz, classes, xyz, classes)
    >>> float(report.values["accuracy"])
    100.0
    """
    groups = parse_groups(merged_classes)
    true_classes = reference_classification[match_points(xyz, reference_xyz)]
    xyz, called, true = counted_points(xyz, classification, true_classes, parse_classes(ignored_classes))
    monitor.progress(0.5)
    every = confusion(true, called, CODES)
    parts = merged(np.flatnonzero(every.any(axis=0) | every.any(axis=1)), groups)
    number = np.zeros(CODES, np.int64)
    for i, part in enumerate(parts):
        number[part] = i
    matrix = confusion(number[true], number[called], len(parts))
    rates = class_rates(matrix)
    values = {
        "accuracy": overall_accuracy(matrix),
        "kappa": cohens_kappa(matrix),
        "mean_iou": float(rates["iou"][matrix.sum(axis=1) > 0].mean()),
        **_of_kinds(every),
        "points": len(xyz),
    }
    monitor.progress(0.7)
    names = [_called(part) for part in parts]
    kinds = [number[called] == number[true], called == PointClass.GROUND, true == PointClass.GROUND]
    outcome = np.select(kinds, [REST, HIT, MISS], FALSE).astype(np.uint8)
    return Report(values, _page(matrix, names, values, _table(matrix, names, rates), draw_map(xyz, outcome, _LEGEND)))


def parse_groups(text: str) -> list[np.ndarray]:
    """Return the merged classes of a text such as ``"3-5; 7, 18"``, each group ascending.

    Raises
    ------
    ValueError
        If a group is no list of numbers and ranges, or a class is in two.
    """
    groups = [parse_classes(part, "Merged classes") for part in text.split(";") if part.strip()]
    numbers, counts = np.unique(np.concatenate(groups or [np.zeros(0, np.int64)]), return_counts=True)
    if (counts > 1).any():
        raise ValueError(
            f"Merged classes (merged_classes) must have each class in one group, got {numbers[counts > 1][0]} in two; "
            "leave it out of one."
        )
    return groups


def merged(occurring: np.ndarray, groups: list[np.ndarray]) -> list[np.ndarray]:
    """Return the classes that occur (m,), each group together, in ascending order of the first of each."""
    in_groups = np.concatenate([*groups, np.zeros(0, np.int64)])
    parts = [np.intersect1d(group, occurring) for group in groups]
    parts += [np.array([single]) for single in np.setdiff1d(occurring, in_groups)]
    return sorted((part for part in parts if len(part)), key=lambda part: int(part[0]))


def _called(numbers: np.ndarray) -> str:
    """Return the names of classes for users: their numbers, and the name of their kind or of the class."""
    classes = {int(number) for number in numbers}
    kinds = {"unclassified": (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED), **_KINDS}
    kind = next((name for name, members in kinds.items() if len(classes) > 1 and classes <= set(members)), "")
    standard = {int(one): one.name.replace("_", " ").lower() for one in PointClass}
    names = [kind] if kind else [standard[number] for number in sorted(classes) if number in standard]
    return f"{', '.join(map(str, sorted(classes)))} {', '.join(names)}".strip()


def _of_kinds(matrix: np.ndarray) -> dict[str, float]:
    """Return F and intersection over union (percent) of the kinds of classes that are outputs."""
    found = {}
    for kind, members in _KINDS.items():
        inside = mask_of(len(matrix), list(members))
        hits, true, called = matrix[np.ix_(inside, inside)].sum(), matrix[inside].sum(), matrix[:, inside].sum()
        # The second class is everything else; its correct points don't count.
        rates = class_rates(np.array([[hits, true - hits], [called - hits, 0]]))
        found[f"{kind}_f"], found[f"{kind}_iou"] = float(rates["f"][0]), float(rates["iou"][0])
    return found


def _table(matrix: np.ndarray, names: list[str], rates: dict[str, np.ndarray]) -> str:
    """Return the HTML of the figures of each class."""
    head = ["Class", "Points in the reference", "Points in the input", "Completeness", "Correctness", "F-score", "IoU"]
    figures = zip(*(rates[name].tolist() for name in ("completeness", "correctness", "f", "iou")))
    counts = zip(names, matrix.sum(axis=1), matrix.sum(axis=0), figures)
    rows = [[name, f"{true:,}", f"{called:,}", *map(percent, of_class)] for name, true, called, of_class in counts]
    return draw_table("Classes", head, rows)


def _page(matrix: np.ndarray, names: list[str], values: dict, table: str, picture: str) -> str:
    """Return the page: figures of all classes, the matrix, and the HTML of a table and a map."""
    meanings = {
        "accuracy": (
            "Overall accuracy",
            f"{int(np.trace(matrix)):,} of {values['points']:,} points have the class of the reference.",
        ),
        "kappa": ("Kappa", "Agreement beyond what chance would give; 100 % is perfect."),
        "mean_iou": (
            "Mean IoU",
            "Points of a class in both among those in either, the mean over the classes of the reference.",
        ),
    }
    lead = f"{values['points']:,} points of {len(names)} classes were compared with the reference."
    heat = "<h2>Confusion matrix</h2>\n" + draw_matrix(matrix, names, "Class of the input", "True class")
    tables = {"All classes": rows_of(values, _MEASURES, meanings)}
    return build_page("Quality of the classes", lead, tables, heat + table + picture)
