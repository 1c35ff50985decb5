"""The points on top of buildings, and how far models are from them."""

from dataclasses import dataclass

import numpy as np

from ..geometry.grid import find_cells, grid_over
from ..geometry.groups import least_of


@dataclass(frozen=True)
class Rules:
    """Which points lie on top, and how far distances count."""

    #: A point that lies under another one of a building by this (m), in its cell or in a neighboring one, is on a wall
    #: or on a floor seen through glass
    below: float = 1.0
    #: cell, cell_spacings: Side of the cells (m, and point spacings; the larger one counts)
    cell: float = 0.5
    cell_spacings: float = 1.5
    #: Distances count at most this much (m): a tree that is classified as building says nothing of the model
    farthest: float = 5.0

    def cell_size(self, spacing: float) -> float:
        """Return the size of the cells (m) for a point spacing (m)."""
        return max(self.cell, self.cell_spacings * spacing)


RULES = Rules()


def are_low(xyz: np.ndarray, spacing: float) -> np.ndarray:
    """Return the mask of points (n,) with a clearly higher one in their cell, or in a neighboring one."""
    grid = grid_over(xyz, RULES.cell_size(spacing))
    cells, inverse = np.unique(grid.number(xyz), return_inverse=True)
    top = -least_of(-xyz[:, 2], inverse, len(cells))
    highest = top.copy()
    for step in grid.around:
        position, is_used = find_cells(cells, cells + step)
        highest = np.where(is_used, np.maximum(highest, top[position]), highest)
    return highest[inverse] > xyz[:, 2] + RULES.below


def are_on_roof(above: np.ndarray, is_low: np.ndarray) -> np.ndarray:
    """Return the mask of points (n,) on top of a roof, by their heights ``above`` (n,), m, the face over or under them.

    Points that have a higher one next to them, ``is_low`` (n,), lie on walls if they are far under the model.
    """
    return ~is_low | (above > -RULES.below)


def distances(above: np.ndarray) -> np.ndarray:
    """Return heights above a model (n,), m, cut off at ``RULES.farthest`` above and below it."""
    return np.clip(above, -RULES.farthest, RULES.farthest)


def root_mean_square(off: np.ndarray) -> float:
    """Return the root mean square of distances, NaN without any."""
    return float(np.sqrt(np.mean(off**2))) if len(off) else np.nan
