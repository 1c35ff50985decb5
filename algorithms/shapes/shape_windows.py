"""Windows for each range of radii, with size and point spacing in proportion."""

from dataclasses import dataclass

import numpy as np

from ..geometry.boxes import Boxes

# Side of a window, in least radii of its level: the diameter of the level's largest shape.
WINDOW = 4.0

# Spacing of the points of a level, in its least radii.
THINNING = 0.15

# Side of the bins for centers of circles and spheres (least radius of the level), as fine as the steps of the radius.
# Points so far from them are of their first fit.
CENTER_BIN = 0.15

# Factor by which the radius of a fit may lie outside the range of its level; the adjacent levels find it, too.
BEYOND_LEVEL = 1.25

# Radii that are tried in one level, an octave at most: steps of up to 10 %, which the first fit bridges.
RADII_OF_LEVEL = 8


@dataclass(frozen=True)
class Level:
    """Radii that are looked for together."""

    #: low, high: Their range (m)
    low: float
    high: float
    rows: np.ndarray  #: (k,): points that are left for it, thinned to one per cell
    windows: list[np.ndarray]  #: Which of ``rows`` lie in each window, the fullest window first


def levels(low: float, high: float) -> list[tuple[float, float]]:
    """Return the ranges of radii from ``low`` to ``high`` (m), each at most an octave wide."""
    edges = np.geomspace(low, high, max(1, int(np.ceil(np.log2(high / low) - 1e-9))) + 1)
    return list(zip(edges[:-1].tolist(), edges[1:].tolist()))


def level_of(xyz: np.ndarray, is_free: np.ndarray, low: float, high: float, min_points: int) -> Level:
    """Return a level of the free points of a cloud.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points (m), from zero.
    is_free : ndarray of shape (n,), bool
        Points that no shape has taken yet.
    low, high : float
        Range of the radii (m).
    min_points : int
        Points of the emptiest window.
    """
    free = np.flatnonzero(is_free)
    rows = free[np.sort(_one_per_cell(xyz[free], THINNING * low))] if len(free) else free
    windows: list[np.ndarray] = []
    if len(rows):
        side = WINDOW * low
        for shift in (0.0, 0.5):
            # A second set of windows, half a side apart, has in its middle what the first cuts in two.
            boxes = Boxes(np.concatenate([xyz[rows], [xyz[rows].min(axis=0) - shift * side]]), side)
            # Boxes keep the order of their points. The point added, which only moves them, is left out.
            is_point = boxes.order < len(rows)
            order, size = boxes.order[is_point], np.add.reduceat(is_point, boxes.start, dtype=np.int64)
            large, stop = np.flatnonzero(size >= min_points), np.cumsum(size)
            windows += [order[stop[box] - size[box] : stop[box]] for box in large.tolist()]
        windows.sort(key=lambda part: -len(part))
    return Level(low, high, rows, windows)


def _one_per_cell(xyz: np.ndarray, cell: float) -> np.ndarray:
    """Return the first point of each occupied cell."""
    boxes = Boxes(xyz, cell)
    return boxes.order[boxes.start]
