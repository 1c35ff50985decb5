"""Morphological opening of height rasters, at a cost that does not depend on the window."""

from __future__ import annotations

from typing import Callable, Optional

import numpy as np

from ..packages import ndimage


def open_surface(surface: np.ndarray, radius: int, absent: Optional[np.ndarray] = None) -> np.ndarray:
    """Return the opening of a raster by an octagon: its lower envelope by a plate of that radius.

    Parameters
    ----------
    surface : ndarray of shape (rows, columns), float64
        Heights, without gaps.
    radius : int
        Radius of the octagon in cells, at least 1.
    absent : ndarray of shape (rows, columns), bool, optional
        Cells that hold no plate up and over which no plate is centered; they keep their heights.

    Returns
    -------
    ndarray of shape (rows, columns)
        Away from the border nowhere above ``surface``, and planes stay as they are.

    Notes
    -----
    An octagon is a square swept over a diamond, a diamond is one diagonal line swept over the other, so four
    running minima and four running maxima do it.
    """
    if absent is None:
        absent = np.zeros(surface.shape, bool)
    eroded = _octagon(np.where(absent, np.inf, surface), radius, ndimage.minimum_filter1d, np.inf)
    opened = _octagon(np.where(absent, -np.inf, eroded), radius, ndimage.maximum_filter1d, -np.inf)
    return np.where(absent, surface, opened)


def _octagon(surface: np.ndarray, radius: int, running: Callable, outside: float) -> np.ndarray:
    """Run minima or maxima over an octagon; ``outside`` counts beyond the border along diagonals."""
    # A regular octagon of that radius: the diagonal half-length is 0.29 of it.
    diagonal = round(0.293 * radius)
    straight = radius - 2 * diagonal
    if straight:
        for axis in (0, 1):
            surface = running(surface, 2 * straight + 1, axis=axis, mode="nearest")
    if diagonal:
        for rising in (True, False):
            surface = _along_diagonals(surface, 2 * diagonal + 1, rising, running, outside)
    return surface


def _along_diagonals(surface: np.ndarray, length: int, rising: bool, running: Callable, outside: float) -> np.ndarray:
    """Run a one-dimensional filter along the diagonals: sheared, they are columns."""
    rows, columns = surface.shape
    if rows > columns:
        # Time grows with rows * (rows + columns): transposed there are fewer rows, and the same diagonals.
        return _along_diagonals(surface.T, length, rising, running, outside).T
    width = rows + columns - 1
    # Written in rows of width + 1 and read in rows of width, each row is shifted one cell more: diagonals are columns.
    sheared, filtered = np.full(rows * (width + 1), outside), np.empty(rows * (width + 1))
    order = slice(None, None, 1 if rising else -1)
    sheared.reshape(rows, width + 1)[:, :columns] = surface[order]
    whole, out = (flat[: rows * width].reshape(rows, width) for flat in (sheared, filtered))
    running(whole, length, axis=0, output=out, mode="constant", cval=outside)
    return filtered.reshape(rows, width + 1)[order, :columns]
