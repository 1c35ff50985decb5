"""Numbers that decide whether a position is in a sample: as good as random, and the same in every run and block."""

from __future__ import annotations

import numpy as np

# Large odd numbers mix the bits of coordinates; the high bits of the products are mixed best.
_MIXERS = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)

# Bits of the mixed number that are used.
_BITS = 24


def mixed(positions: np.ndarray) -> np.ndarray:
    """Return a number (n,), float64, from 0 to below 1, that depends on positions (n, 2 or 3), int64, alone.

    Examples
    --------
    >>> bool((mixed(np.arange(3000).reshape(1000, 3)) < 0.25).mean().round(1) == 0.2)
    True
    """
    number = np.zeros(len(positions), np.uint64)
    for column, mixer in zip(positions.T, _MIXERS):
        number += column.astype(np.uint64) * np.uint64(mixer)
        number ^= number >> np.uint64(29)
    number *= np.uint64(_MIXERS[0])
    return (number >> np.uint64(64 - _BITS)) / 2.0**_BITS
