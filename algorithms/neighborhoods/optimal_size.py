"""The neighborhood that suits each point best: as many nearest points as give the least eigenentropy."""

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..criteria import ROUNDING
from ..threads import ROWS_AT_ONCE
from .covariance import PAIRS, Nearest, Shapes, full_matrices, nearest_offsets
from .nearest_blocks import EQUAL_SQUARES, reach_of_ties

# Replaces zero in logarithms, as 0 ln 0 is 0.
_LEAST = np.finfo(float).tiny

# Where the largest eigenvalue is more than this share of the sum, the points are a line: the closed form leaves the two
# other eigenvalues little but rounding.
_LINE = 1 - 1e-4


@dataclass(frozen=True)
class Optimal:
    """The ``low``, ``low + step``, ... or at most ``high`` nearest points, whichever have the least eigenentropy."""

    low: int
    high: int
    step: int = 1

    def check(self, xyz: np.ndarray, tree: Any) -> None:
        """Raise ValueError when there is no number to choose."""
        if self.low > self.high:
            raise ValueError(
                f"The minimum of nearest points ({self.low}) is above the maximum ({self.high}); exchange the two."
            )

    def rows_per_chunk(self, n_points: int) -> int:
        """Return the number of points that are worked on at once."""
        return Nearest(self.high).rows_per_chunk(n_points)

    def shapes(self, columns: np.ndarray, tree: Any, rows: np.ndarray, extents: bool) -> Shapes:
        """Return the shapes of the best neighborhoods of the points ``rows``."""
        # One neighbor more than the largest scale shows whether the tie at its end is complete.
        best, is_cut = self._among(columns, tree, rows, self.high + 1, extents)
        cut = np.flatnonzero(is_cut)
        if len(cut):
            mended, _ = self._among(columns, tree, rows[cut], reach_of_ties(self.high), extents)
            for whole, part in zip(vars(best).values(), vars(mended).values()):
                if len(whole):
                    whole[cut] = part
        return best

    def _among(
        self, columns: np.ndarray, tree: Any, rows: np.ndarray, count: int, extents: bool
    ) -> tuple[Shapes, np.ndarray]:
        """Return the best shapes of ``rows`` (m,) among their ``count`` nearest points.

        Also return the rows (m,), bool, whose tie at the largest scale may go on beyond these.
        """
        _, offsets = nearest_offsets(tree, rows, count)
        size = max(1, ROWS_AT_ONCE // offsets[0].shape[1])
        parts = [
            self._best([offset[start : start + size] for offset in offsets], extents)
            for start in range(0, len(rows), size)
        ]
        *shapes, ends = (np.concatenate(values) for values in zip(*parts))
        return Shapes(*shapes), (ends == count) & (count < columns.shape[1])

    def _best(self, offsets: list, extents: bool) -> tuple:
        """Return the fields of the best :class:`Shapes`, and the end (m,) of the tie at the largest scale, in points.

        ``offsets`` are those (m, k) in x, y and z, m, nearest first.
        """
        x, y, z = offsets = [np.ascontiguousarray(offset.T) for offset in offsets]
        most = min(self.high, len(x))
        scales = np.arange(min(self.low, most), most + 1, self.step)
        ties = Ties(x * x + y * y + z * z)
        covariances = nested_covariances(offsets, scales, ties)
        best = _first_least(eigenentropies(covariances))
        every = np.arange(x.shape[1])
        best_covariances, counts, end = covariances[:, best, every].T, scales[best], ties.end(np.full(len(every), most))
        if not extents:
            return best_covariances, counts, np.empty(0), np.empty(0), end
        last = ties.end(counts) - 1
        ranges = np.maximum.accumulate(z) - np.minimum.accumulate(z)
        widths = np.sqrt(np.maximum.accumulate(x * x + y * y)[last, every])
        return best_covariances, counts, ranges[last, every], widths, end


class Ties:
    """Which neighbors are equally far from their point, by squared distances (k, m), m², of k neighbors, ascending."""

    def __init__(self, squares: np.ndarray) -> None:
        self._is_tied = np.zeros((len(squares) + 1, squares.shape[1]), bool)
        np.less_equal(squares[1:], squares[:-1] * (1 + EQUAL_SQUARES), out=self._is_tied[1:-1])

    def share(self, values: np.ndarray) -> None:
        """Replace the ``values`` (k, v, m) of neighbors that are equally far by their mean, in place."""
        point, neighbor = np.nonzero((self._is_tied[1:] | self._is_tied[:-1]).T)
        if not len(point):
            return
        first = np.flatnonzero(~self._is_tied[neighbor, point])
        count = np.diff(first, append=len(point))
        means = np.add.reduceat(values[neighbor, :, point], first) / count[:, None]
        values[neighbor, :, point] = np.repeat(means, count, axis=0)

    def end(self, count: np.ndarray) -> np.ndarray:
        """Return the number of neighbors (m,) that are no farther than the last of the ``count`` (m,) nearest."""
        count = count.copy()
        rows = np.arange(len(count))
        while len(rows):
            rows = rows[self._is_tied[count[rows], rows]]
            count[rows] += 1
        return count


def nested_covariances(offsets: list, scales: np.ndarray, ties: Optional[Ties] = None) -> np.ndarray:
    """Return the covariances (6, s, m) of the first ``scales`` (s,) of offsets (k, m) in x, y and z.

    One running sum over the neighbors, in order of their distance, has the moments of all scales in it. Of neighbors
    that are equally far each has the mean of their moments, so that their order does not matter.
    """
    sums = np.empty((len(offsets[0]), 9, offsets[0].shape[1]))
    for a in range(3):
        sums[:, a] = offsets[a]
    for i, (a, b) in enumerate(PAIRS, start=3):
        np.multiply(offsets[a], offsets[b], out=sums[:, i])
    if ties is not None:
        ties.share(sums)
    for k in range(1, scales[-1]):
        sums[k] += sums[k - 1]
    means = sums[scales - 1].transpose(1, 0, 2) / scales[:, None]
    covariances = np.ascontiguousarray(means[3:])
    for i, (a, b) in enumerate(PAIRS):
        covariances[i] -= means[a] * means[b]
    return covariances


def eigenentropies(covariances: np.ndarray) -> np.ndarray:
    """Return the entropies of the eigenvalues' shares of their sum, -sum e ln e.

    Parameters
    ----------
    covariances : ndarray of shape (6, ...)
        xx, yy, zz, xy, xz, yz of positive semidefinite matrices.

    Returns
    -------
    ndarray of shape (...), float64
        From 0 (a line) to ln 3, right to 1e-9; infinite where the matrix is zero.

    Notes
    -----
    The trigonometric solution of the characteristic polynomial, as in :func:`.symmetric_eigenvalues`. It leaves
    two nearly equal eigenvalues with half their digits, but in opposite directions, and the entropy, which treats both
    alike, loses nothing. Lines are the exception: both are next to nothing there and the entropy is steep. Those
    matrices go to LAPACK.
    """
    total = covariances[0] + covariances[1] + covariances[2]
    total[total <= 0] = np.nan
    xx, yy, zz, xy, xz, yz = shares = covariances / total
    shares[:3] -= 1 / 3
    spread = (xx * xx + yy * yy + zz * zz) / 6
    spread += (xy * xy + xz * xz + yz * yz) / 3
    determinant = xx * (yy * zz - yz * yz)
    determinant -= xy * (xy * zz - yz * xz)
    determinant += xz * (xy * yz - yy * xz)
    deviation = np.sqrt(spread)
    # Where all three are alike, any angle gives them.
    determinant /= np.maximum(2 * spread * deviation, _LEAST)
    cosine = np.cos(np.arccos(np.clip(determinant, -1, 1, out=determinant), out=determinant) / 3)
    first = 1 / 3 + 2 * deviation * cosine
    third = 1 / 3 - deviation * (cosine + np.sqrt(3 * np.maximum(1 - cosine * cosine, 0)))
    second = 1 - first - third
    lines = first > _LINE
    if lines.any():
        shares[:3] += 1 / 3
        third[lines], second[lines], first[lines] = np.linalg.eigvalsh(full_matrices(shares[:, lines].T)).T
    entropy = -sum(share * np.log(np.maximum(share, _LEAST)) for share in (first, second, third))
    entropy[np.isnan(entropy)] = np.inf
    return entropy


def _first_least(entropies: np.ndarray) -> np.ndarray:
    """Return the index (m,) of the first of the least entropies (s, m) of each point."""
    return np.argmax(entropies <= entropies.min(axis=0) + ROUNDING, axis=0)
