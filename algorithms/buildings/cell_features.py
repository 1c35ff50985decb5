"""Features of space cells: shape, height, returns and intensity of their points, and the column of each cell."""

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..geometry.grid import distinct
from ..geometry.groups import least_of
from ..neighborhoods.covariance import dimensionality, shannon_entropy, smallest_eigenvectors, symmetric_eigenvalues
from ..sampling.height_resolution import LEAST_RESOLUTION
from .space_cells import SpaceCells, covariances


@dataclass(frozen=True)
class CellPoints:
    """Points (n,) that are described: coordinates (m), heights above ground (m), whether they are ground.

    Attributes
    ----------
    returns : tuple of two ndarrays of shape (n,), uint8, optional
        Return number and number of returns; None where no pulse has several.
    intensity : ndarray of shape (n,), optional
        Strength of the return; None where it is the same everywhere.
    """

    xyz: np.ndarray
    height: np.ndarray
    is_ground: np.ndarray
    returns: Optional[tuple[np.ndarray, np.ndarray]]
    intensity: Optional[np.ndarray]


class CellFeatures:
    """The features of the ``chosen`` cells, computed for those rows that are asked for.

    Two neighborhoods give the shape: the cell, and the cell with those around it.

    Parameters
    ----------
    points : CellPoints
        Measures of the points.
    cells : SpaceCells
        All cells.
    chosen : ndarray of shape (k,), int64
        Rows of the cells that features are wanted of.
    around : sparse matrix of shape (k, m)
        Which cells touch each chosen one, see :meth:`.SpaceCells.around`.
    """

    def __init__(self, points: CellPoints, cells: SpaceCells, chosen: np.ndarray, around: Any) -> None:
        self._chosen, self._around = chosen, around
        # Computed first, as it takes the most memory.
        self._columns = _columns(points, cells, chosen)
        self._moments, self._height = cells.moments, cells.sums(points.height)
        self._returns: list[np.ndarray] = []
        self._strengths: list[np.ndarray] = []
        if points.returns is not None:
            number, of = points.returns
            self._returns = [cells.sums(values) for values in (number < of, number, of)]
        if points.intensity is not None:
            self._strengths = [cells.sums(points.intensity.astype(float) ** power) for power in (1, 2)]

    def of(self, rows: np.ndarray) -> np.ndarray:
        """Return the features (r, f), float64, of some ``rows`` (r,) of the chosen cells."""
        around, chosen = self._around[rows], self._chosen[rows]
        own, block = self._moments[chosen], around @ self._moments
        count = own[:, 0]
        features = [_shapes(block), _shapes(own), np.log(block[:, :1]), np.log(own[:, :1])]
        features.append((own[:, 3] / count - block[:, 3] / block[:, 0])[:, None])
        features.append((self._height[chosen] / count)[:, None])
        if self._returns:
            of_cells = [values[chosen] / count for values in self._returns]
            features.append(np.column_stack([*of_cells, around @ self._returns[0] / block[:, 0]]))
        if self._strengths:
            mean, squares = (around @ values / block[:, 0] for values in self._strengths)
            spread = np.sqrt(np.maximum(squares - mean**2, 0))
            features.append(np.column_stack([self._strengths[0][chosen] / count, mean, spread]))
        return np.column_stack([*features, self._columns[rows]])


def _shapes(moments: np.ndarray) -> np.ndarray:
    """Return the shape (k, 9) of groups of points with ``moments`` (k, 10).

    Linearity, planarity, scattering and their entropy; deviation from the plane, verticality as the normal's z, share
    of the spread that is upright, size and spread of elevations.
    """
    spread = covariances(moments)
    eigenvalues = np.maximum(symmetric_eigenvalues(spread), LEAST_RESOLUTION**2)
    normal = smallest_eigenvectors(spread, eigenvalues)
    shares = dimensionality(eigenvalues)
    total, upright = eigenvalues.sum(axis=1), np.maximum(spread[:, 2], 0)
    measures = shannon_entropy(*shares), np.sqrt(eigenvalues[:, 2]), normal[:, 2], upright / total
    return np.column_stack([*shares, *measures, np.sqrt(total), np.sqrt(upright)])


def _columns(points: CellPoints, cells: SpaceCells, chosen: np.ndarray) -> np.ndarray:
    """Return the columns (k, 5) in plan that the ``chosen`` cells (k,) are part of.

    Share of ground, height of the topmost point, distances of the middle of the cell's points from the topmost and the
    lowest point, and spread of elevations, m.
    """
    # A column is as wide as a cell with its neighbors, and holds each cell whole, also where rounding decides on its
    # edge.
    east, north = (cells.voxels[:, :2] // 3).T
    east, north = east - east.min(), north - north.min()
    values, of_cell = distinct(north * (int(east.max()) + 1) + east)
    column, of, level = of_cell[cells.cell], of_cell[chosen], cells.centers[chosen, 2]
    z, count = points.xyz[:, 2], np.bincount(column, minlength=len(values))
    top, bottom = -least_of(-z, column, len(values)), least_of(z, column, len(values))
    height = np.full(len(values), -np.inf)
    # Among equal topmost elevations take the point highest above ground, so that the order of the cloud doesn't matter.
    topmost = np.flatnonzero(z == top[column])
    np.maximum.at(height, column[topmost], points.height[topmost])
    above = z - bottom[column]
    mean, square = (np.bincount(column, above**power, len(values)) / count for power in (1, 2))
    ground = np.bincount(column, points.is_ground, len(values)) / count
    spread = np.sqrt(np.maximum(square - mean**2, 0))
    return np.column_stack([ground[of], height[of], top[of] - level, level - bottom[of], spread[of]])
