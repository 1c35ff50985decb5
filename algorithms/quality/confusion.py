"""Confusion matrices: counts by true and found class, and the figures from them."""

import numpy as np


def confusion(true: np.ndarray, called: np.ndarray, count: int) -> np.ndarray:
    """Return the confusion matrix (count, count), int64: true classes in rows, found ones in columns, both from 0."""
    return np.bincount(true.astype(np.int64) * count + called, minlength=count**2).reshape(count, count)


def class_rates(matrix: np.ndarray) -> dict[str, np.ndarray]:
    """Return completeness, correctness, F and IoU of each class, percent (m,); NaN where there are no items."""
    hits, true, called = np.diag(matrix), matrix.sum(axis=1), matrix.sum(axis=0)
    return {
        "completeness": _percent(hits, true),
        "correctness": _percent(hits, called),
        "f": _percent(2 * hits, true + called),
        "iou": _percent(hits, true + called - hits),
    }


def overall_accuracy(matrix: np.ndarray) -> float:
    """Return the share (percent) of items whose class is right; NaN without items."""
    return float(_percent(np.trace(matrix), matrix.sum()))


def cohens_kappa(matrix: np.ndarray) -> float:
    """Return the agreement (percent) beyond that by chance; NaN without items, and where chance explains all of it.

    References
    ----------
    Cohen, J., 1960. A coefficient of agreement for nominal scales. Educational and Psychological Measurement 20(1).
    [cohen1960]
    """
    total = matrix.sum()
    if not total:
        return float("nan")
    chance = float((matrix.sum(axis=1) / total) @ (matrix.sum(axis=0) / total))
    return 100.0 * (np.trace(matrix) / total - chance) / (1 - chance) if chance < 1 else float("nan")


def percentage(part: float, whole: float) -> float:
    """Return a part in percent of the whole, NaN of nothing."""
    return 100.0 * part / whole if whole else float("nan")


def _percent(part: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Return parts in percent of wholes, NaN of nothing."""
    whole = np.asarray(whole, float)
    return 100.0 * np.divide(part, whole, out=np.full(whole.shape, np.nan), where=whole > 0)
