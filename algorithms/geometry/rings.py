"""Rings, which are closed polylines in plan, float64 (m, 2), the last vertex equal to the first, and their segments.

An outline is a list of rings: first the exterior, counterclockwise, then the holes, clockwise.
"""

from collections import defaultdict
from collections.abc import Iterable

import numpy as np

from ..threads import PAIRS_AT_ONCE
from .groups import items


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
    step = max(step, float(length.sum()) / PAIRS_AT_ONCE)
    side, number = items(np.ceil(length / step).astype(np.int64).clip(1))
    return start[side] + (number / np.bincount(side)[side])[:, None] * (end - start)[side]


def along_sides(sides: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return positions (p, 2), m, at equal distances of about ``step`` (m) along sides (k, 2, 2), none at their ends.

    Further the side (p,) of each, and the unit vector (p, 2) to its right. Sides without a length have no position.
    """
    ways = sides[:, 1] - sides[:, 0]
    length = np.hypot(*ways.T)
    step = max(step, float(length.sum()) / PAIRS_AT_ONCE)
    count = np.where(length > 0, np.maximum(1, np.rint(length / step)), 0).astype(np.int64)
    side, number = items(count)
    positions = sides[side, 0] + ((number + 0.5) / count[side])[:, None] * ways[side]
    return positions, side, np.column_stack([ways[side, 1], -ways[side, 0]]) / length[side, None]


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
