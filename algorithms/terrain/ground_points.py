"""The points that a ground filter looks at, and the classes that it returns."""

from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.grid import grid_over
from ..geometry.tin import PLANE_POINTS
from ..sampling.cloud_sampling import not_noise
from ..sampling.height_resolution import LEAST_RESOLUTION
from ..sampling.surface_noise import SURFACES


def usable_points(xyz: np.ndarray, classification: np.ndarray) -> np.ndarray:
    """Return the indices (m,) of the points (n, 3), m, that are not noise, by their classes (n,).

    Raises
    ------
    ValueError
        If these are fewer than three, or span no area in plan.
    """
    usable = not_noise(classification)
    if len(usable) < PLANE_POINTS:
        raise ValueError(
            f"Ground needs at least {PLANE_POINTS} points that are not noise, got {len(usable)}; choose a larger cloud."
        )
    # Column by column: numpy is slow on rows of two.
    centered = np.stack([column - column.mean() for column in (xyz[:, axis].take(usable) for axis in (0, 1))])
    extent = np.linalg.svd(centered @ centered.T, compute_uv=False)
    if extent[1] <= LEAST_RESOLUTION**2 * len(usable):
        raise ValueError(
            f"All {len(usable)} points lie on one line or at one position in plan; ground needs an area, "
            "choose a larger cloud, or reproject this one to meters if its coordinates are degrees."
        )
    return usable


def in_plan_order(xyz: np.ndarray, usable: np.ndarray, spacing: float) -> np.ndarray:
    """Return the indices ``usable`` sorted by squares in plan: points near in plan are near in memory then.

    Triangulation and searches are faster, far more so where the order was random. Some 300 points share a square, which
    fit a cache; ``spacing`` is theirs, m.
    """
    points = xyz.take(usable, axis=0)
    squares = grid_over(points, SURFACES.square * spacing)
    # The shortest integers that hold the numbers: integers of two bytes are sorted many times as fast.
    number = squares.number(points).astype(np.min_scalar_type(squares.rows * squares.columns))
    return usable[np.argsort(number, kind="stable")]


def last_returns(
    return_number: Optional[np.ndarray], number_of_returns: Optional[np.ndarray], usable: np.ndarray
) -> np.ndarray:
    """Return the mask of last returns among usable points; all where these are not numbered or fewer than three."""
    if return_number is None or number_of_returns is None:
        return np.ones(len(usable), bool)
    last = return_number[usable] >= number_of_returns[usable]
    return last if last.sum() >= PLANE_POINTS else np.ones(len(usable), bool)


def with_ground(classification: np.ndarray, ground: np.ndarray) -> np.ndarray:
    """Return the classes with the points of the indices ``ground`` as ground, and no others."""
    classes = np.where(classification == PointClass.GROUND, np.uint8(PointClass.UNCLASSIFIED), classification)
    classes[ground] = PointClass.GROUND
    return classes.astype(np.uint8)
