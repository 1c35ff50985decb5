"""Pseudorandom numbers that depend on a cell alone, for sampling.

Every tenth item, say, is another one as soon as one item is missing; of a sample by these numbers only that one is.
"""

import numpy as np

# Odd numbers of 64 bits, one for each axis: digits of the golden ratio, of pi and of e have no pattern.
_MULTIPLIERS = np.array([0x9E3779B97F4A7C15, 0x243F6A8885A308D3, 0xB7E151628AED2A6B], np.uint64)


def scattered(cells: np.ndarray) -> np.ndarray:
    """Return numbers (m,), float64, evenly spread over 0 to 1, without order among neighboring cells.

    Parameters
    ----------
    cells : ndarray of shape (m, 2 or 3), int64
        Columns and rows, or columns, rows and layers; coordinates of points in steps of their file.
    """
    number = cells.astype(np.uint64) @ _MULTIPLIERS[: cells.shape[1]]
    # The lowest bits of a product depend on the lowest of its factors alone.
    number ^= number >> np.uint64(32)
    return (number * _MULTIPLIERS[0] >> np.uint64(11)) / float(1 << 53)
