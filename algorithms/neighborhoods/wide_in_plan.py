"""Neighborhoods as wide as they are long in plan, however unevenly the points are spread."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from .covariance import Nearest, nearest_offsets
from .nearest_blocks import Shapes
from .optimal_size import nested_covariances

# Least width in plan, as a share of the length, of a neighborhood that is not a line.
LEAST_WIDTH = 0.45

# Most points of a neighborhood: as many are nearly always wide enough, however they are spread. Lines three times as
# far apart as the points on them have as many within two distances of lines.
MOST_ACROSS_LINES = 60

# Factor by which a neighborhood grows until it is wide enough.
_GROWTH = 1.5

# Number of sampled neighbors, spread over their ranks.
_NAMED = 16


@dataclass(frozen=True)
class Wide:
    """The ``count`` nearest points, or as many more, up to 60, as are 0.45 times as wide as long in plan.

    Scanners put points close together along a line and leave gaps between the lines. The nearest points of one are
    points of its own line then: they have no plane, and a line through a crown is no crown. It is the plan that
    counts, for a line that is bent upward, over a wall or through a crown, is still one.
    """

    count: int

    @property
    def n_named(self) -> int:
        """How many neighbors :meth:`moments` names."""
        return _NAMED

    def check(self, xyz: np.ndarray, tree: Any) -> None:
        """Refuse nothing: the neighborhoods exist in every cloud."""

    def rows_per_chunk(self, n_points: int) -> int:
        """Return the number of points worked on at once: sums of nine moments take as much as the neighbors."""
        return max(1, Nearest(self._most).rows_per_chunk(n_points) // 4)

    def shapes(self, columns: np.ndarray, tree: Any, rows: np.ndarray, extents: bool) -> Shapes:
        """Return the shapes of the neighborhoods of the points ``rows``; extents are not known."""
        covariances, counts = self._smallest(nearest_offsets(tree, rows, self._most)[1])
        return Shapes(covariances, counts)

    def moments(self, tree: Any, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return 16 neighbors (m, 16), centers (m, 3) and covariances (m, 6) of the points ``rows``."""
        neighbors, offsets = nearest_offsets(tree, rows, self._most)
        covariances, counts = self._smallest(offsets)
        last = counts[:, None] - 1
        ranks = np.rint(np.linspace(0, 1, _NAMED) * last).astype(np.intp)
        means = [np.take_along_axis(np.cumsum(offset, axis=1), last, axis=1)[:, 0] / counts for offset in offsets]
        return np.take_along_axis(neighbors, ranks, axis=1), tree.data[rows] + np.column_stack(means), covariances

    @property
    def _most(self) -> int:
        return max(self.count, MOST_ACROSS_LINES)

    def _smallest(self, offsets: list) -> tuple[np.ndarray, np.ndarray]:
        """Return covariances (m, 6) and counts (m,) of the smallest wide ones, of offsets (m, k) nearest first."""
        scales = [min(self.count, offsets[0].shape[1])]
        while scales[-1] < offsets[0].shape[1]:
            scales.append(min(int(np.ceil(_GROWTH * scales[-1])), offsets[0].shape[1]))
        covariances = nested_covariances([np.ascontiguousarray(offset.T) for offset in offsets], np.array(scales))
        is_wide = _plan_width(covariances) >= LEAST_WIDTH
        is_wide[-1] = True
        first = np.argmax(is_wide, axis=0)
        return covariances[:, first, np.arange(covariances.shape[2])].T, np.array(scales)[first]


def _plan_width(covariances: np.ndarray) -> np.ndarray:
    """Return the ratio of width to length in plan of points with ``covariances`` (6, ...), 0 if they have no length."""
    xx, yy, _, xy = covariances[:4]
    middle, half = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    length, width = middle + half, np.maximum(middle - half, 0)
    return np.sqrt(np.divide(width, length, out=np.zeros_like(length), where=length > 0))
