"""Measures of rings: closed polylines in plan, float64 (m, 2), the last vertex equal to the first.

An outline is a list of rings: first the exterior, counterclockwise, then the holes, clockwise.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

import numpy as np

from .groups import items

# Positions along rings, apart from their vertices: 100 km in steps of 0.1 m, more than any building has, in 50 MB.
_MOST_POSITIONS = 1_000_000


def signed_area(ring: np.ndarray) -> float:
    """Return the area (m²) within a ring, negative when it runs clockwise."""
    x, y = (ring - ring[0]).T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def polygon_area(rings: list[np.ndarray]) -> float:
    """Return the area (m²) of a polygon, the exterior of which comes first, without its holes."""
    return 2 * abs(signed_area(rings[0])) - sum(abs(signed_area(ring)) for ring in rings)


def perimeter(ring: np.ndarray) -> float:
    """Return the length (m) of a ring."""
    return float(np.hypot(*np.diff(ring, axis=0).T).sum())


def sides_of_rings(rings: list[np.ndarray]) -> np.ndarray:
    """Return start and end (k, 2, 2) of the sides of rings, one ring after the other."""
    return np.concatenate([np.zeros((0, 2, 2)), *(np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings)])


def rings_of_edges(edges: Iterable[tuple[int, int]]) -> list[list[int]]:
    """Return the open rings of vertices that directed edges make; where rings touch in a vertex they are parted."""
    following: dict[int, list[int]] = defaultdict(list)
    for a, b in edges:
        following[a].append(b)
    rings = []
    while following:
        path = [next(iter(following))]
        position = {path[0]: 0}
        while True:
            ways = following[path[-1]]
            step = ways.pop()
            if not ways:
                del following[path[-1]]
            if step in position:
                # A loop within the path is a ring of its own.
                at = position[step]
                rings.append(path[at:])
                for vertex in path[at + 1 :]:
                    del position[vertex]
                path = path[: at + 1]
                if at == 0 and step not in following:
                    break
            else:
                position[step] = len(path)
                path.append(step)
    return rings


def sampled_rings(rings: list[np.ndarray], step: float) -> np.ndarray:
    """Return positions (n, 2) along rings, vertices among these, at most ``step`` (m) apart or a millionth of all."""
    start, end = np.moveaxis(sides_of_rings(rings), 1, 0)
    length = np.hypot(*(end - start).T)
    step = max(step, float(length.sum()) / _MOST_POSITIONS)
    side, number = items(np.ceil(length / step).astype(np.int64).clip(1))
    return start[side] + (number / np.bincount(side)[side])[:, None] * (end - start)[side]


def along_sides(sides: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return positions (p, 2), m, at equal distances of about ``step`` (m) along sides (k, 2, 2), none at their ends.

    Further the side (p,) of each, and the unit vector (p, 2) to its right. Sides without a length have no position.
    """
    ways = sides[:, 1] - sides[:, 0]
    length = np.hypot(*ways.T)
    step = max(step, float(length.sum()) / _MOST_POSITIONS)
    count = np.where(length > 0, np.maximum(1, np.rint(length / step)), 0).astype(np.int64)
    side, number = items(count)
    positions = sides[side, 0] + ((number + 0.5) / count[side])[:, None] * ways[side]
    return positions, side, np.column_stack([ways[side, 1], -ways[side, 0]]) / length[side, None]
