"""Morphological opening of height rasters, at a cost that grows with the logarithm of the window's size."""

from typing import Optional

import numpy as np


def open_surface(surface: np.ndarray, radius: int, absent: Optional[np.ndarray] = None) -> np.ndarray:
    """Return the opening of a raster by an octagon: the surface that an octagonal plate reaches from below.

    Parameters
    ----------
    surface : ndarray of shape (rows, columns), float64
        Heights, without gaps.
    radius : int
        Radius of the octagon in cells, at least 1.
    absent : ndarray of shape (rows, columns), bool, optional
        Cells that do not bound the plate and over which no plate is centered; they keep their heights.

    Returns
    -------
    ndarray of shape (rows, columns)
        Away from the border nowhere above ``surface``, and planes stay as they are.

    Notes
    -----
    An octagon is a square swept over a diamond, a diamond is one diagonal line swept over the other, so four
    running minima and four running maxima do it. Each takes the extremes of one cell and the next, then of two and the
    next two, then of four and the next four. These are whole arrays, and a line twice as long takes one step more.
    """
    if absent is None:
        absent = np.zeros(surface.shape, bool)
    eroded = _octagon(np.where(absent, np.inf, surface), radius, np.minimum, np.inf)
    opened = _octagon(np.where(absent, -np.inf, eroded), radius, np.maximum, -np.inf)
    return np.where(absent, surface, opened)


def _octagon(surface: np.ndarray, radius: int, extreme: np.ufunc, outside: float) -> np.ndarray:
    """Run minima or maxima over an octagon; ``outside`` counts beyond the border."""
    # A regular octagon of that radius: the diagonal half-length is 0.29 of it.
    diagonal = round(0.293 * radius)
    straight = radius - 2 * diagonal
    if straight:
        for down, right in ((1, 0), (0, 1)):
            surface = _along(surface, straight, down, right, extreme, outside)
    if diagonal:
        # Rising diagonals fall in the mirror image.
        surface = _along(surface[:, ::-1], diagonal, 1, 1, extreme, outside)[:, ::-1]
        surface = _along(surface, diagonal, 1, 1, extreme, outside)
    return surface


def _along(surface: np.ndarray, half: int, down: int, right: int, extreme: np.ufunc, outside: float) -> np.ndarray:
    """Run minima or maxima over a line of ``half`` cells to both sides, a step of which is ``down`` and ``right``."""
    rows, columns = surface.shape
    found = np.full((rows + 2 * half * down, columns + 2 * half * right), outside)
    found[half * down :, half * right :][:rows, :columns] = surface
    length, done = 2 * half + 1, 1
    while done < length:
        more = min(done, length - done)
        rows, columns = found.shape
        found = extreme(found[: rows - more * down, : columns - more * right], found[more * down :, more * right :])
        done += more
    return found
