"""Share of each building at each position, smoothed on a lattice.

A share is soft: it changes by little when points move or when some of them are missing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..criteria import DEVIATIONS
from ..geometry.raster_filling import nearest_known
from ..packages import ndimage

# Nodes of the lattice per point spacing: at two, linear interpolation between nodes adds nothing to the smoothing.
NODES = 2

# Standard deviation (spacings) of the weights of points around a node. 1.0 joins buildings, so that fewer blocks of
# Delft's map are found; with 0.8 short sides of simulated houses are drawn askew.
_NEAR = 0.9

# Standard deviation (spacings) of the surroundings in which a roof's own density is measured: some hundred points.
_WIDE = 3.0

# Standard deviation (spacings) of the surroundings in which points are counted to weigh them. From 0.6 to 1.1 outlines
# are as near to maps and as stable.
_EVEN = 1.0

# Distance (spacings) from a point up to which it has a weight: a hundredth of the greatest.
REACH = _NEAR * DEVIATIONS

# Distance (spacings) beyond which buildings affect only the directions of each other's outlines, and points do not
# affect the attributes of an outline.
APART = 8.0

# Least spacing (m) assumed when outlines are drawn, and least step of the grid of heights in which rows of houses are
# separated. Gutters and small bays are no walls, and a fire wall is thicker.
LEAST_SPACING = 0.25

# Tolerance (spacings) of outlines: samples along an edge lie within one spacing of it, and corners are rounded.
TOLERANCE_SPACINGS = 1.75

# Least density of roofs, as a share of the usual density of one point per square spacing, below which a position is far
# from any.
_NOWHERE = 1e-3


@dataclass(frozen=True)
class Lattice:
    """Nodes at multiples of ``step`` (m) from zero.

    ``first`` is column and row of the south-western one, ``shape`` their rows and columns.
    """

    step: float
    first: tuple[int, int]
    shape: tuple[int, int]

    @classmethod
    def around(cls, plan: np.ndarray, spacing: float) -> Lattice:
        """Return the lattice around points (n, 2), m, with a margin for the smoothing."""
        step, room = spacing / NODES, int(np.ceil(REACH * NODES))
        low = np.floor(plan.min(axis=0) / step).astype(np.int64) - room
        high = np.ceil(plan.max(axis=0) / step).astype(np.int64) + room
        columns, rows = (high - low + 1).tolist()
        return cls(step, (int(low[0]), int(low[1])), (rows, columns))

    def in_plan(self, columns_rows: np.ndarray) -> np.ndarray:
        """Return easting and northing (n, 2), m, of columns and rows (n, 2)."""
        return (columns_rows + self.first) * self.step

    def nodes(self, plan: np.ndarray) -> np.ndarray:
        """Return column and row (n, 2) of positions (m), fractions of them included."""
        return plan / self.step - self.first

    def nearest(self, plan: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return row and column (...) of the nodes nearest to positions (..., 2), m."""
        column, row = np.moveaxis(np.rint(self.nodes(plan)).astype(np.int64), -1, 0)
        return row.clip(0, self.shape[0] - 1), column.clip(0, self.shape[1] - 1)

    @property
    def positions(self) -> np.ndarray:
        """Easting and northing (rows * columns, 2), m, of all nodes, row by row."""
        found = np.empty((*self.shape, 2))
        # Work axis by axis: lists of columns and rows would take several times the memory.
        for axis, count in enumerate(self.shape[::-1]):
            along = (np.arange(count) + self.first[axis]) * self.step
            found[..., axis] = along if axis == 0 else along[:, None]
        return found.reshape(-1, 2)

    def holds(self, plan: np.ndarray) -> np.ndarray:
        """Return the mask of positions (n, 2), m, within the lattice."""
        node = self.nodes(plan)
        return ((node >= 0) & (node < np.subtract(self.shape[::-1], 1))).all(axis=1)

    def part(self, window: tuple[slice, slice]) -> Lattice:
        """Return the nodes in some rows and columns, those beyond the last left out."""
        (row, last_row, _), (column, last_column, _) = (own.indices(n) for own, n in zip(window, self.shape))
        first = self.first[0] + column, self.first[1] + row
        return Lattice(self.step, first, (last_row - row, last_column - column))

    def window(self, inner: Lattice) -> tuple[slice, slice]:
        """Return the rows and columns of another lattice of the same step that lies in this one."""
        (column, row), (rows, columns) = np.subtract(inner.first, self.first).tolist(), inner.shape
        return slice(row, row + rows), slice(column, column + columns)

    def spread(self, plan: np.ndarray, weight: Optional[np.ndarray] = None) -> np.ndarray:
        """Return the weights (rows, columns) of points in the lattice, each shared among the four nodes around it."""
        node = self.nodes(plan)
        low = np.floor(node).astype(np.int64)
        (column, row), (east, north) = low.T, (node - low).T
        total = np.zeros(self.shape)
        for x, along in ((0, 1 - east), (1, east)):
            for y, up in ((0, 1 - north), (1, north)):
                number = (row + y) * self.shape[1] + column + x
                share = along * up if weight is None else along * up * weight
                total += np.bincount(number, share, total.size).reshape(self.shape)
        return total


@dataclass(frozen=True)
class Shares:
    """The share of one building at the nodes of a lattice around it."""

    lattice: Lattice
    share: np.ndarray  #: (rows, columns), float32: share of the building, 0 to 1
    rest: np.ndarray  #: (rows, columns), float32: greatest share of anything else: the ground, or another building

    def at(self, positions: np.ndarray) -> np.ndarray:
        """Return the share (n,) at positions (n, 2), m; 0 beyond the lattice."""
        nodes = self.lattice.nodes(positions)[:, ::-1].T
        return ndimage.map_coordinates(self.share, nodes, order=1, mode="constant", cval=0.0)


def even_weights(plan: np.ndarray, spacing: float) -> np.ndarray:
    """Return weights (n,), 0 to 1, of points (n, 2), m: less where they are denser than one per square spacing.

    Walls and overlapping strips have many points in little area. The weights even the density out. Unlike a choice of
    one point per cell, they hardly change when points move a little.
    """
    if not len(plan):
        return np.zeros(0)
    lattice = Lattice.around(plan, spacing)
    nodes = lattice.nodes(plan)[:, ::-1].T
    return 1 / np.maximum(ndimage.map_coordinates(_density(lattice, plan, _EVEN), nodes, order=1), 1.0)


def find_shares(
    roof: np.ndarray,
    weight: np.ndarray,
    building: np.ndarray,
    beside: np.ndarray,
    beside_weight: np.ndarray,
    spacing: float,
) -> dict[int, Shares]:
    """Return the shares of buildings that lie close together.

    Parameters
    ----------
    roof : ndarray of shape (n, 2)
        Points of their roofs in plan, m.
    weight : ndarray of shape (n,)
        Weights of these, 0 to 1.
    building : ndarray of shape (n,), int64
        The building of each.
    beside : ndarray of shape (m, 2)
        Points that are no building next to and below the roofs.
    beside_weight : ndarray of shape (m,)
        Weights of these, 0 to 1.
    spacing : float
        Mean distance between neighboring points, m.

    Returns
    -------
    dict of int to Shares
        By the numbers of the buildings, ascending.

    Notes
    -----
    Where fewer points lie than the roofs around have, the rest is empty. It counts as roof as far as roofs with their
    own density lie around (a gap), and as no building elsewhere. At the edge of a roof where no ground was seen, half
    is empty, and the roof ends.
    """
    lattice = Lattice.around(roof, spacing)
    density, around = (_density(lattice, roof, width, weight) for width in (_NEAR, _WIDE))
    usual = smoothed(density * density, _WIDE) / np.maximum(smoothed(density, _WIDE), _NOWHERE)
    is_near = lattice.holds(beside)
    other = _density(lattice, beside[is_near], _NEAR, beside_weight[is_near])
    empty = np.maximum(usual - density - other, 0.0)
    filled = empty * np.clip(2 * around / np.maximum(usual, _NOWHERE) - 1, 0.0, 1.0)
    total = np.maximum(density + other + empty, _NOWHERE)
    numbers = np.unique(building)
    # A gap is shared among buildings in proportion to their roofs around it.
    of_gaps = filled / np.maximum(around, _NOWHERE)
    shares: dict[int, tuple[Lattice, np.ndarray]] = {}
    best, second = np.zeros((2, *lattice.shape), np.float32)
    leader = np.zeros(lattice.shape, np.int64)
    for number in numbers.tolist():
        is_own = building == number
        own, weights = roof[is_own], weight[is_own]
        inner = Lattice.around(own, spacing)
        window = lattice.window(inner)
        share = _density(inner, own, _NEAR, weights) + of_gaps[window] * _density(inner, own, _WIDE, weights)
        share /= total[window]
        shares[number] = inner, share
        is_best = share > best[window]
        second[window] = np.where(is_best, best[window], np.maximum(second[window], share))
        leader[window] = np.where(is_best, number, leader[window])
        best[window] = np.maximum(best[window], share)
    ground = 1 - (density + filled) / total
    found = {}
    for number, (inner, share) in shares.items():
        window = lattice.window(inner)
        of_others = np.where(leader[window] == number, second[window], best[window])
        found[number] = Shares(inner, share, np.maximum(ground[window], of_others))
    return found


def _density(lattice: Lattice, plan: np.ndarray, width: float, weight: Optional[np.ndarray] = None) -> np.ndarray:
    """Return points per square spacing, float32, smoothed by a Gaussian of standard deviation ``width`` (spacings)."""
    return smoothed(lattice.spread(plan, weight).astype(np.float32), width) * NODES**2


def smoothed(field: np.ndarray, width: float) -> np.ndarray:
    """Smooth a field on a lattice by a Gaussian of standard deviation ``width`` (spacings)."""
    return ndimage.gaussian_filter(field, width * NODES, mode="constant", truncate=DEVIATIONS)


def spread_out(label: np.ndarray) -> np.ndarray:
    """Return labels (rows, columns) in which each node without one, 0, has the nearest node's."""
    return nearest_known(label, label == 0)
