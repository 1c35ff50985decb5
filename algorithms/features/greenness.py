"""How green points are in light and in shadow, and the threshold from which on they are plants."""

from typing import Optional

import numpy as np

# Darker than this share of the median brightness, color is noise of the camera.
_DARK = 0.1

# Least share of leaves above the threshold and of roofs below it, and of a cluster's points above it if it is green.
MOST_GREEN = 2 / 3


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
    # Gray to red materials are no plants.
    least = max(0.0, float(np.median(plants) + np.median(roofs)) / 2)
    return least if np.mean(plants > least) - np.mean(roofs > least) >= 2 * MOST_GREEN - 1 else None
