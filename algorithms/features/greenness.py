"""How green points are in light and in shadow, and the threshold from which on they are plants."""

from __future__ import annotations

from typing import Optional

import numpy as np

# Darker than this share of the median brightness, color is noise of the camera.
_DARK = 0.1

# Bins of the histogram of greenness.
_BINS = 128

# The two kinds of points must differ by this much greenness on the average. Leaves and grass have 0.1 to 0.4; gray,
# brown and red materials have -0.1 to 0.05.
_LEAST_GAP = 0.1

# Least difference of the shares of leaves and of roofs over the threshold, such as two thirds and one third.
_LEAST_PARTED = 1 / 3

# Share of the variance that lies between the two kinds. A single normal distribution has 0.64, cut in the middle.
_LEAST_BETWEEN = 0.7


def greenness(red: np.ndarray, green: np.ndarray, blue: np.ndarray) -> np.ndarray:
    """Return the normalized excess green (n,), float64, of colors (n,): (2 G - R - B) / (R + G + B).

    From -1 to 2, 0 for gray; NaN for points that are nearly black. Shadow takes about the same share of all three and
    changes it little.

    References
    ----------
    Woebbecke, D. M., Meyer, G. E., Von Bargen, K., Mortensen, D. A., 1995. Color indices for weed identification under
    various soil, residue, and lighting conditions. Transactions of the ASAE 38(1), 259-269. [woebbecke1995]
    """
    r, g, b = (np.asarray(band, float) for band in (red, green, blue))
    total = r + g + b
    bright = total > _DARK * np.median(total) if len(total) else np.zeros(0, bool)
    return np.divide(2 * g - r - b, total, out=np.full(len(total), np.nan), where=bright)


def greenness_between(plants: np.ndarray, roofs: np.ndarray) -> Optional[float]:
    """Return the greenness that separates points known by their shape; None where it does not separate them.

    ``plants`` (n,) are points most of which are leaves, ``roofs`` (m,) points most of which are roofs; NaN where
    unknown. It is the middle between the two medians, so that dry crowns, hardly green, are distinguished from roofs,
    too.
    """
    plants, roofs = (values[np.isfinite(values)] for values in (plants, roofs))
    if not len(plants) or not len(roofs):
        return None
    least = float(np.median(plants) + np.median(roofs)) / 2
    return least if np.mean(plants > least) - np.mean(roofs > least) >= _LEAST_PARTED else None


def plant_greenness(values: np.ndarray) -> Optional[float]:
    """Return the greenness from which on points of a scene are plants; None where it does not separate two kinds.

    Of values (n,), NaN where unknown, it is the middle between the means of the two kinds that the threshold with the
    largest variance between them makes.

    References
    ----------
    Otsu, N., 1979. A threshold selection method from gray-level histograms. IEEE Transactions on Systems, Man, and
    Cybernetics 9(1), 62-66. [otsu1979]
    """
    # Gray to red materials are one kind, however many colors there are.
    known = np.maximum(values[np.isfinite(values)], 0.0)
    if not len(known) or np.ptp(known) < _LEAST_GAP:
        return None
    count, edges = np.histogram(known, _BINS, (0.0, known.max()))
    middle, share = (edges[1:] + edges[:-1]) / 2, count / count.sum()
    below, mass = np.cumsum(share)[:-1], np.cumsum(share * middle)
    mean, mass = mass[-1], mass[:-1]
    is_split = (below > 0) & (below < 1)
    between = np.zeros(_BINS - 1)
    between[is_split] = (mean * below - mass)[is_split] ** 2 / (below * (1 - below))[is_split]
    best = int(np.argmax(between))
    variance = float(share @ (middle - mean) ** 2)
    if variance == 0 or between[best] < _LEAST_BETWEEN * variance:
        return None
    low, high = mass[best] / below[best], (mean - mass[best]) / (1 - below[best])
    # In the middle between the kinds: where nothing lies between them, all thresholds there have the same variance.
    return float(low + high) / 2 if high - low >= _LEAST_GAP else None
