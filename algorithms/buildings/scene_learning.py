"""Learn the appearance of buildings from the scene's own classes: each half of the scene judges the other one."""

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..geometry.grid import lattice
from ..geometry.scattered import scattered
from ..rules import rule, rules
from ..sampling.surface_noise import SURFACES
from ..stage import Monitor
from ..threads import ROWS_AT_ONCE, in_chunks
from .cell_features import CellFeatures
from .logistic_regression import LogisticRegression
from .space_cells import SpaceCells


@rules
class RULES:
    """How a scene is learned; fitted on seven real airborne clouds, where a gain is of F, in percent."""

    half: float = rule(10.0, "m", "physics: side of the squares of the two halves, as of a small house")
    surface_share: float = rule(0.3, "", "fitted: what points of a roof surface take from its mean; 0 gains 0.13 less")


@dataclass(frozen=True)
class LabeledCells:
    """Cells with raised points, and what they are like."""

    cells: SpaceCells  #: All cells
    chosen: np.ndarray  #: (k,), int64: rows of those with raised points
    around: Any  #: sparse matrix of shape (k, m): 1 for each of these and the cells that touch it
    raised: np.ndarray  #: (k,): raised points of each
    label: np.ndarray  #: (k,): share of these that are building
    features: CellFeatures  #: features (k, f) of these

    @property
    def half(self) -> np.ndarray:
        """The half of the scene, 0 or 1, int64 (k,), that each cell is in."""
        return lattice(self.cells.centers[self.chosen, :2], RULES.half).sum(axis=1) % 2

    def sample(self, cluster_id: np.ndarray) -> np.ndarray:
        """Return cells (j, 4 + f) to learn from: number, half, mark of the building, label and features of each.

        Numbers, 0 to 1, depend on the cell alone; samples of parts of a survey are cells of the least numbers. Marks
        distinguish buildings, also of other parts; 0 is no building. ``cluster_id`` (n,) are the buildings of the
        points, from 1; 0 if unassigned.
        """
        is_building = cluster_id > 0
        east = np.bincount(cluster_id[is_building], self.cells.xyz[is_building, 0], int(cluster_id.max()) + 1)
        mark = np.zeros(len(self.cells.count))
        mark[self.cells.cell[is_building]] = 1.0 + np.abs(east[cluster_id[is_building]])
        # An additional cell, as at the edge of a cloud, changes no other row of the sample.
        number = scattered(self.cells.voxels[self.chosen])
        rows = _least(number)
        columns = number[rows], self.half[rows], mark[self.chosen[rows]], self.label[rows], self.features.of(rows)
        return np.column_stack(columns)

    def smooth(self, likely: np.ndarray) -> np.ndarray:
        """Return probabilities (k,) halfway to the mean of the cells around, which count by their raised points."""
        around = self.around[:, self.chosen]
        return (likely + around @ (self.raised * likely) / (around @ self.raised)) / 2


def learn_halves(sample: np.ndarray) -> tuple[float, ...]:
    """Return the two regressions, as numbers, that were learned on the halves of a sample (j, 4 + f).

    Empty where it has fewer than two buildings, or a half has only points of one kind.
    """
    marks = np.unique(sample[:, 2])
    # Merge the samples of parts of a survey into the one that the whole survey would give.
    sample = sample[_least(sample[:, 0])]
    half, label = sample[:, 1], sample[:, 3]
    halves = [half == number for number in (0, 1)]
    has_both = all(rows.any() and 0 < label[rows].mean() < 1 for rows in halves)
    # A single building has no other of its kind to learn from.
    if (marks > 0).sum() < 2 or not has_both:
        return ()
    fitted = [LogisticRegression.fit(sample[rows, 4:], label[rows]) for rows in halves]
    return tuple(np.concatenate([part for one in fitted for part in (one.mean, one.scale, one.weights)]).tolist())


def predict(learned: tuple[float, ...], features: CellFeatures, half: np.ndarray) -> np.ndarray:
    """Return the probability (k,) of building of cells, by the regression of the half (k,) that they are not in."""
    likely = np.zeros(len(half))
    for number, values in enumerate(np.reshape(learned, (2, -1))):
        # Of each feature its mean and its scale, and two weights; and a constant.
        count = len(values) // 4
        mean, scale, weights = np.split(values, (count, 2 * count))
        regression = LogisticRegression(mean, scale, weights)

        def work(rows: np.ndarray, regression: LogisticRegression = regression) -> None:
            likely[rows] = regression.predict(features.of(rows))

        # A row has ``count`` features, not three coordinates: chunks hold the same number of values.
        in_chunks(work, np.flatnonzero(half != number), max(1, ROWS_AT_ONCE * 3 // count), Monitor())
    return likely


def shared_by_surfaces(likely: np.ndarray, segment_id: Optional[np.ndarray]) -> np.ndarray:
    """Return probabilities (n,) of points, on roof surfaces drawn toward the mean of the surface."""
    if segment_id is None:
        return likely
    mean = np.bincount(segment_id, likely) / np.maximum(np.bincount(segment_id), 1)
    share = RULES.surface_share
    return np.where(segment_id > 0, (1 - share) * likely + share * mean[segment_id], likely)


def _least(numbers: np.ndarray) -> np.ndarray:
    """Return the rows of the least numbers, as many as a sample has at most, ascending."""
    return np.sort(np.argsort(numbers, kind="stable")[: SURFACES.sample])
