"""The line or plane of least squares through a few points."""

import numpy as np


def principal_axes(points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return center, variances and axes of points.

    Parameters
    ----------
    points : ndarray of shape (n, d)
        At least one point, m.

    Returns
    -------
    center : ndarray of shape (d,)
        Their mean, m.
    variances : ndarray of shape (d,)
        Variances along the axes, ascending, m².
    axes : ndarray of shape (d, d)
        A unit vector per column: the first is the normal of the line or plane, the last the direction of the line.
    """
    center = points.mean(axis=0)
    offset = points - center
    variances, axes = np.linalg.eigh(offset.T @ offset)
    return center, np.maximum(variances, 0.0) / len(points), axes
