"""The neighborhood that suits each point best: as many nearest points as give the least eigenentropy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .eigen import PAIRS, Nearest, Shapes, full_matrices, nearest_offsets

# Numbers in each array over all scales: as large as lets a handful of them stay in the second-level cache.
_CACHED = 16_000

# Entropies closer than this are equal but for rounding; of equal ones the smallest neighborhood is taken.
_EQUAL = 1e-9

# Stands for zero where zero can't: 0 ln 0 is 0.
_LEAST = 1e-300

# Beyond this share of the largest eigenvalue the others are what rounding leaves of a line's width.
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
        """Return how many points are worked on at once."""
        return Nearest(self.high).rows_per_chunk(n_points)

    def shapes(self, columns: np.ndarray, tree: Any, rows: np.ndarray, extents: bool) -> Shapes:
        """Return the shapes of the best neighborhoods of the points ``rows``."""
        _, offsets = nearest_offsets(columns, tree, rows, self.high)
        size = max(1, _CACHED // offsets[0].shape[1])
        parts = [
            self._best([offset[start : start + size] for offset in offsets], extents)
            for start in range(0, len(rows), size)
        ]
        return Shapes(*(np.concatenate(values) for values in zip(*parts)))

    def _best(self, offsets: list, extents: bool) -> tuple:
        """Return the :class:`Shapes` of the best of the offsets (m, k) in x, y and z, nearest first, as a row."""
        x, y, z = offsets = [np.ascontiguousarray(offset.T) for offset in offsets]
        scales = np.arange(min(self.low, len(x)), len(x) + 1, self.step)
        covariances = nested_covariances(offsets, scales)
        best = _first_least(eigenentropies(covariances))
        every = np.arange(x.shape[1])
        made, counts = covariances[:, best, every].T, scales[best]
        if not extents:
            return made, counts, np.empty(0), np.empty(0)
        last = counts - 1
        ranges = np.maximum.accumulate(z) - np.minimum.accumulate(z)
        return made, counts, ranges[last, every], np.sqrt(np.maximum.accumulate(x * x + y * y)[last, every])


def nested_covariances(offsets: list, scales: np.ndarray) -> np.ndarray:
    """Return the covariances (6, s, m) of the first ``scales`` (s,) of offsets (k, m) in x, y and z.

    One running sum over the neighbors, in order of their distance, has the moments of all scales in it.
    """
    sums = np.empty((len(offsets[0]), 9, offsets[0].shape[1]))
    for a in range(3):
        sums[:, a] = offsets[a]
    for i, (a, b) in enumerate(PAIRS, start=3):
        np.multiply(offsets[a], offsets[b], out=sums[:, i])
    for k in range(1, len(sums)):
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
    The trigonometric solution of the characteristic polynomial, as in :func:`~.eigen.symmetric_eigenvalues`. It
    leaves two nearly equal eigenvalues with half their digits, but in opposite directions, and the entropy, which
    treats both alike, loses nothing: but for lines, where both are next to nothing and the entropy is steep.
    Those matrices go to LAPACK.
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
    return np.argmax(entropies <= entropies.min(axis=0) + _EQUAL, axis=0)
