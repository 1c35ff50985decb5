"""Segments in plan: whether they meet, whether rings of them are valid, and how far points are from them."""

from __future__ import annotations

import numpy as np

from ..threads import PAIRS_AT_ONCE
from .rings import sides_of_rings, signed_area


def is_valid(rings: list) -> bool:
    """Return whether the edges of closed rings meet only where they follow each other, and the holes lie inside."""
    if min(map(len, rings)) < 4:
        return False
    starts = np.concatenate([ring[:-1] for ring in rings])
    ends = np.concatenate([ring[1:] for ring in rings])
    # An edge shorter than a micrometer is a vertex given twice.
    if (np.hypot(*(ends - starts).T) < 1e-6).any():
        return False
    first = np.cumsum([0, *(len(ring) - 1 for ring in rings)])
    following = np.arange(1, len(starts) + 1)
    following[first[1:] - 1] = first[:-1]
    step = max(1, PAIRS_AT_ONCE // len(starts))
    for low in range(0, len(starts), step):
        rows = np.arange(low, min(low + step, len(starts)))
        meet = _meet(starts[rows], ends[rows], starts, ends)
        others = np.arange(len(starts))
        apart = (others > rows[:, None]) & (following[rows, None] != others) & (following[others] != rows[:, None])
        if (meet & apart).any():
            return False
    return all(is_inside(hole[0], rings[0]) for hole in rings[1:])


def is_inside(point: np.ndarray, ring: np.ndarray) -> bool:
    """Return whether a point (2,) lies inside a ring."""
    return bool(are_inside(point[None], ring)[0])


def are_inside(points: np.ndarray, ring: np.ndarray) -> np.ndarray:
    """Return the mask of points (n, 2) that lie inside a ring, by the parity of the edges to their east."""
    (x0, y0), (x1, y1) = ring[:-1].T, ring[1:].T
    slope = np.divide(x1 - x0, y1 - y0, out=np.zeros_like(x0), where=y0 != y1)
    inside, step = np.empty(len(points), bool), max(1, PAIRS_AT_ONCE // len(x0))
    for low in range(0, len(points), step):
        x, y = points[low : low + step, :, None].transpose(1, 0, 2)
        crosses = ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * slope)
        inside[low : low + step] = crosses.sum(axis=1) % 2
    return inside


def polygons_of(rings: list[np.ndarray]) -> list[list[int]]:
    """Return the numbers of the rings of each polygon, the exterior first, then its holes, which run clockwise."""
    areas = [signed_area(ring) for ring in rings]
    polygons = {i: [i] for i, area in enumerate(areas) if area > 0}
    outer = sorted(polygons, key=lambda i: areas[i])
    for hole in (i for i, area in enumerate(areas) if area <= 0):
        # A hole may touch the exterior in a vertex. Of exteriors within each other, the smallest around it counts.
        middle = rings[hole][:-1].mean(axis=0)
        around = next((i for i in outer if is_inside(middle, rings[i])), None)
        if around is not None:
            polygons[around].append(hole)
    return list(polygons.values())


def distances_to(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Return the distances (n,) (m) of points (n, 2) to the nearest position on a line (m, 2)."""
    return nearest_edge_distances(points, line[:-1], line[1:])


def farthest(points: np.ndarray, line: np.ndarray) -> float:
    """Return the largest distance (m) of points (n, 2) to the nearest position on a line."""
    return float(distances_to(points, line).max())


def nearest_edge_distances(points: np.ndarray, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return the distances (n,) (m) of points (n, 2) to the nearest of segments (m, 2), at least one."""
    nearest, step = np.empty(len(points)), max(1, PAIRS_AT_ONCE // len(starts))
    for low in range(0, len(points), step):
        nearest[low : low + step] = edge_distances(points[low : low + step], starts, ends).min(axis=1)
    return nearest


def distances_to_rings(points: np.ndarray, rings: list) -> np.ndarray:
    """Return the distances (n,), m, of points (n, 2) from the nearest side of rings."""
    starts, ends = np.moveaxis(sides_of_rings(rings), 1, 0)
    return nearest_edge_distances(points, starts, ends)


def edge_distances(points: np.ndarray, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return the distances (n, m) of points to segments."""
    along = ends - starts
    square = np.maximum(np.einsum("ij,ij->i", along, along), 1e-30)
    offset = points[:, None] - starts
    share = np.clip(np.einsum("nmi,mi->nm", offset, along) / square, 0, 1)
    return np.hypot(*np.moveaxis(offset - share[..., None] * along, -1, 0))


def _meet(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Return whether the segments ab (n, 2) and cd (m, 2) have a point in common, bool (n, m)."""

    def side(p, q, r):
        """Sign of the side of the line pq that r is on; zero within rounding."""
        cross = (q - p)[..., 0] * (r - p)[..., 1] - (q - p)[..., 1] * (r - p)[..., 0]
        return np.sign(np.where(np.abs(cross) < 1e-9, 0, cross))

    a, b, c, d = a[:, None], b[:, None], c[None], d[None]
    crossing = (side(a, b, c) * side(a, b, d) <= 0) & (side(c, d, a) * side(c, d, b) <= 0)
    # Segments on one line pass that test wherever they are: their boxes must meet too.
    boxes = (np.minimum(a, b) <= np.maximum(c, d)) & (np.minimum(c, d) <= np.maximum(a, b))
    return crossing & boxes.all(axis=-1)
