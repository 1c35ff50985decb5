"""How rough smooth surfaces look in a cloud: the noise that tolerances are tied to."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..packages import spatial
from .eigen import Nearest, symmetric_eigenvalues

# Points whose surroundings are looked at, about.
_SAMPLE = 20_000

_NEIGHBORS = 12

# A plane's neighborhood reaches eight times the noise, which holds its normal's error to a few degrees.
_REACH_DEVIATIONS, LEAST_NEIGHBORS = 8.0, 8

# Leaves and twigs look smooth over less than this (m); roofs are planes over more.
_LEAST_REACH = 0.5

# A neighborhood is two-dimensional when it is at least so wide for its length; 60 points always are.
_LEAST_WIDTH, _MOST_ACROSS_LINES = 0.45, 60

# Half a metre around holds so many at 125 points/m²; with more, every neighborhood would cost and tell nothing new.
_MOST_NEIGHBORS = 100

# A fifth of the surroundings of any cloud with ground in it is open ground or roof.
_SMOOTH_SHARE = 0.2

# Coordinates are stored to a centimetre or a millimetre: no noise below that can be told.
_LEAST_NOISE = 0.01

# Roof tiles, gravel and gutters are rougher than the smoothest surfaces, by which the noise is measured,
# and the more so the farther apart the points are (m; share of the point spacing).
_LEAST_ROUGHNESS, _ROUGHNESS_OF_SPACING = 0.02, 0.05


def surface_noise(xyz: np.ndarray, tree: Any = None) -> float:
    """Return the standard deviation of points across the smooth surfaces of a cloud.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    tree : scipy.spatial.cKDTree, optional
        Tree of ``xyz``, built when absent.

    Returns
    -------
    float
        Noise (m), at least 0.01.

    Notes
    -----
    The deviation from the plane of the 12 nearest points at the smoothest fifth of the cloud: vegetation, edges
    and walls don't reach that far. In a cloud of planes and nothing else that is 0.77 of the true noise.
    """
    count = min(_NEIGHBORS, len(xyz))
    if count <= 3:
        return _LEAST_NOISE
    tree = spatial.cKDTree(xyz) if tree is None else tree
    covariances = Nearest(count).moments(np.ascontiguousarray(xyz.T), tree, _sample(xyz))[2]
    across = symmetric_eigenvalues(covariances)[:, 2] * count / (count - 3)
    return max(float(np.sqrt(np.quantile(across, _SMOOTH_SHARE))), _LEAST_NOISE)


def surface_density(xyz: np.ndarray, tree: Any = None) -> float:
    """Return the points per square metre of the surfaces that they lie on, however steep these are.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    tree : scipy.spatial.cKDTree, optional
        Tree of ``xyz``, built when absent.

    Returns
    -------
    float
        Density (points/m²) around the median point, counted in the circle of its 12 nearest; infinite where all lie
        at one place.
    """
    count = min(_NEIGHBORS, len(xyz))
    tree = spatial.cKDTree(xyz) if tree is None else tree
    reach = float(np.median(tree.query(xyz[_sample(xyz)], k=[count], workers=-1)[0]))
    return count / (np.pi * reach**2) if reach > 0 else float("inf")


def surface_roughness(xyz: np.ndarray, density: float, tree: Any = None) -> float:
    """Return how far points of one roof surface may lie off its plane (one standard deviation, m).

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    density : float
        Points per square metre.
    tree : scipy.spatial.cKDTree, optional
        Tree of ``xyz``, built when absent.
    """
    return float(np.hypot(max(surface_noise(xyz, tree), _LEAST_ROUGHNESS), _ROUGHNESS_OF_SPACING / np.sqrt(density)))


def surface_neighbors(xyz: np.ndarray, density: float, noise: float, tree: Any = None) -> int:
    """Return how many nearest points tell the plane of a surface.

    Few where points are precise, more where they are noisy or dense: the smooth side of a crown is a plane too
    when it is looked at closely enough. And enough to cross scan lines: scanners put points close together along a
    line and leave gaps between the lines, and a neighborhood that holds one line only has no plane.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    density : float
        Points per square metre.
    noise : float
        Standard deviation of points across a smooth surface, m.
    tree : scipy.spatial.cKDTree, optional
        Tree of ``xyz``, built when absent.

    Returns
    -------
    int
        The least count, from 8 to 100, that reaches half a metre and eight times the noise and with which four
        fifths of the smooth neighborhoods are at least 0.45 times as wide as long (or 60); at most n.
    """
    reach = max(_LEAST_REACH, _REACH_DEVIATIONS * noise)
    count = min(max(int(np.ceil(np.pi * reach**2 * density)), LEAST_NEIGHBORS), _MOST_NEIGHBORS)
    tree = spatial.cKDTree(xyz) if tree is None else tree
    columns, rows = np.ascontiguousarray(xyz.T), _sample(xyz)
    while count < min(_MOST_ACROSS_LINES, len(xyz)):
        eigenvalues = symmetric_eigenvalues(Nearest(count).moments(columns, tree, rows)[2])
        smooth = eigenvalues[:, 2] <= np.quantile(eigenvalues[:, 2], _SMOOTH_SHARE + 0.1)
        width = np.sqrt(eigenvalues[smooth, 1] / np.maximum(eigenvalues[smooth, 0], 1e-12))
        if np.quantile(width, 0.2) >= _LEAST_WIDTH:
            break
        count = min(int(np.ceil(count * 1.5)), _MOST_ACROSS_LINES)
    return min(count, len(xyz))


def _sample(xyz: np.ndarray) -> np.ndarray:
    """Return indices of about ``_SAMPLE`` points, chosen by where they lie, so that their order doesn't matter."""
    step = len(xyz) // _SAMPLE
    if step < 2:
        return np.arange(len(xyz))
    millimetres = np.rint((xyz - xyz.min(axis=0)) * 1000).astype(np.uint64)
    # Three large odd numbers mix the coordinates; the high bits of the product are the well mixed ones.
    mixed = (millimetres * np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)).sum(
        axis=1
    )
    return np.flatnonzero((mixed >> np.uint64(40)) % np.uint64(step) == 0)
