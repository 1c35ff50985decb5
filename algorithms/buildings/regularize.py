"""Straight walls and right angles: outlines regularized to their main directions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from .outlines import signed_area

# Walls closer than this to a main direction are meant to have it; others are diagonals and keep their own.
_MAX_TURN = np.deg2rad(22.5)

# Sine of the angle between walls that are taken for parallel, about a degree.
_PARALLEL = 0.02

# Below this share of the outline within 10° of the main directions there are none; by chance 22 % of a circle is.
_MIN_SHARE = 0.35

# Pairs of segments or of points and segments that are compared at once.
_PAIRS_AT_ONCE = 1_000_000


def regularize_outline(rings: list, tolerance: float, outset: float = 0.0) -> Optional[list]:
    """Return an outline with straight walls along its main directions, None where that would change it too much.

    Parameters
    ----------
    rings : list of ndarray of shape (m, 2)
        Exterior counterclockwise, then holes clockwise, closed (m).
    tolerance : float
        Distance (m) that wiggles of the outline may have; no vertex moves farther than twice that.
    outset : float
        Distance (m) that walls are moved outward: the outermost points lie inside the eaves.

    Returns
    -------
    list of ndarray, or None
        Rings in the same order, valid together; holes smaller than the tolerance can resolve are left out.
    """
    simple = [simplify_ring(ring, tolerance) for ring in rings]
    direction = main_direction(simple)
    if direction is None or len(simple[0]) < 4:
        return None
    made = [_straightened(ring, direction, tolerance, outset) for ring in simple]
    if made[0] is None:
        return None
    kept = [(ring, raw) for ring, raw in zip(made, rings) if ring is not None]
    new, raw = [ring for ring, _ in kept], [raw for _, raw in kept]
    if any(signed_area(a) * signed_area(b) <= 0 for a, b in kept) or not is_valid(new):
        return None
    limit = 2 * tolerance
    near = all(farthest(a, b) <= limit and farthest(b[:-1], a) <= limit for a, b in zip(new, raw))
    return new if near else None


def simplify_ring(ring: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the closed ring with the vertices of Douglas and Peucker that keep it within ``tolerance`` (m)."""
    open_ring = ring[:-1]
    # The two ends of the longest extent are corners in any case.
    start = int(np.argmax(np.einsum("ij,ij->i", open_ring - open_ring.mean(0), open_ring - open_ring.mean(0))))
    turned = np.concatenate([np.roll(open_ring, -start, axis=0), open_ring[start : start + 1]])
    far = int(np.argmax(np.hypot(*(turned - turned[0]).T)))
    is_kept = np.zeros(len(turned), bool)
    is_kept[[0, far, -1]] = True
    spans = [(0, far), (far, len(turned) - 1)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        distance = edge_distances(turned[first + 1 : last], turned[first : first + 1], turned[last : last + 1])[:, 0]
        at = int(np.argmax(distance))
        if distance[at] > tolerance:
            middle = first + 1 + at
            is_kept[middle] = True
            spans += [(first, middle), (middle, last)]
    return turned[is_kept]


def main_direction(rings: list) -> Optional[float]:
    """Return the direction (rad, in [0, pi/2)) that most walls have or are square to, None where there is none."""
    edges = np.concatenate([np.diff(ring, axis=0) for ring in rings])
    length, angle = np.hypot(*edges.T), np.arctan2(edges[:, 1], edges[:, 0])
    # Four times the angle is the same for walls that are parallel or square to each other.
    candidates = np.mod(angle, np.pi / 2)
    apart = np.abs(np.angle(np.exp(4j * (angle[:, None] - candidates)))) / 4
    near = apart <= np.deg2rad(10)
    share = length @ near
    best = int(np.argmax(share))
    if share[best] < _MIN_SHARE * length.sum():
        return None
    supporting = near[:, best]
    # Long walls know their direction best.
    mean = np.sum(length[supporting] ** 2 * np.exp(4j * angle[supporting]))
    return float(np.mod(np.angle(mean) / 4, np.pi / 2))


def _straightened(ring: np.ndarray, direction: float, tolerance: float, outset: float) -> Optional[np.ndarray]:
    """Return a simplified ring with its walls turned to the main directions, None where nothing is left of it."""
    walls = [_wall(a, b, direction, tolerance) for a, b in zip(ring[:-1], ring[1:])]
    walls = _merged(_without_cut_corners(walls, tolerance), tolerance)
    if len(walls) < 3:
        return None
    walls = [replace(wall, point=wall.point + outset * wall.outward) for wall in walls]
    corners: list = []
    for here, there in zip(walls, [*walls[1:], walls[0]]):
        corners += _joined(here, there, tolerance)
    made = np.array([*corners, corners[0]])
    return made if abs(signed_area(made)) > tolerance**2 else None


@dataclass(frozen=True)
class _Wall:
    """A line of the outline: unit direction, a point on it, length, the vertex it starts from, whether main."""

    direction: np.ndarray
    point: np.ndarray
    length: float
    start: np.ndarray
    is_main: bool

    @property
    def outward(self) -> np.ndarray:
        """Unit vector across the line, away from the building."""
        return np.array([self.direction[1], -self.direction[0]])

    def offset(self, point: np.ndarray) -> float:
        """Return how far a point lies to the left of this line."""
        return _cross(self.direction, point - self.point)

    def foot(self, point: np.ndarray) -> np.ndarray:
        """Return the place on this line that is nearest to a point."""
        return self.point + ((point - self.point) @ self.direction) * self.direction


def _cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def _wall(start: np.ndarray, end: np.ndarray, direction: float, tolerance: float) -> _Wall:
    """Return the wall between two vertices, turned about its middle unless that moves its ends too far."""
    step = end - start
    length, angle = float(np.hypot(*step)), float(np.arctan2(step[1], step[0]))
    snapped = direction + np.round((angle - direction) / (np.pi / 2)) * np.pi / 2
    turn = abs(snapped - angle)
    is_main = bool(turn <= _MAX_TURN and length / 2 * np.sin(turn) <= tolerance)
    angle = snapped if is_main else angle
    return _Wall(np.array([np.cos(angle), np.sin(angle)]), (start + end) / 2, length, start, is_main)


def _without_cut_corners(walls: list, tolerance: float) -> list:
    """Leave out short diagonals between walls that are square to each other: corners that no point has hit."""
    kept = []
    for before, here, after in zip([walls[-1], *walls], walls, [*walls[1:], walls[0]]):
        is_corner = before.is_main and after.is_main and abs(before.direction @ after.direction) < _PARALLEL
        if here.is_main or here.length > 2.5 * tolerance or not is_corner:
            kept.append(here)
    return kept


def _merged(walls: list, tolerance: float) -> list:
    """Join walls that follow each other in one line."""
    i = 0
    while i < len(walls) and len(walls) > 3:
        here, there = walls[i], walls[(i + 1) % len(walls)]
        is_along = abs(_cross(here.direction, there.direction)) < _PARALLEL and here.direction @ there.direction > 0
        if is_along and abs(here.offset(there.point)) <= tolerance:
            total = here.length + there.length
            point = (here.point * here.length + there.point * there.length) / total
            longer = here if here.length >= there.length else there
            walls[i] = _Wall(longer.direction, point, total, here.start, longer.is_main)
            del walls[(i + 1) % len(walls)]
            i = max(i - 1, 0)
        else:
            i += 1
    return walls


def _joined(here: _Wall, there: _Wall, tolerance: float) -> list:
    """Return the corner between two walls, or the two ends of the jog between walls that are nearly parallel."""
    turn = _cross(here.direction, there.direction)
    if abs(turn) >= _PARALLEL:
        corner = here.point + _cross(there.point - here.point, there.direction) / turn * here.direction
        # Walls that are nearly parallel meet far away: a step between them is truer than that corner.
        if np.hypot(*(corner - there.start)) <= 2 * tolerance:
            return [corner]
    return [here.foot(there.start), there.foot(there.start)]


def is_valid(rings: list) -> bool:
    """Return whether no two segments of an outline meet but neighbors in their corner, and holes are inside."""
    starts = np.concatenate([ring[:-1] for ring in rings])
    ends = np.concatenate([ring[1:] for ring in rings])
    if (np.hypot(*(ends - starts).T) < 1e-6).any():
        return False
    first = np.cumsum([0, *(len(ring) - 1 for ring in rings)])
    following = np.arange(1, len(starts) + 1)
    following[first[1:] - 1] = first[:-1]
    step = max(1, _PAIRS_AT_ONCE // len(starts))
    for low in range(0, len(starts), step):
        rows = np.arange(low, min(low + step, len(starts)))
        meet = _meet(starts[rows], ends[rows], starts, ends)
        others = np.arange(len(starts))
        apart = (others > rows[:, None]) & (following[rows, None] != others) & (following[others] != rows[:, None])
        if (meet & apart).any():
            return False
    return all(is_inside(hole[0], rings[0]) for hole in rings[1:])


def is_inside(point: np.ndarray, ring: np.ndarray) -> bool:
    """Return whether a point (2,) lies inside a ring, by the parity of the walls to its east."""
    (x0, y0), (x1, y1) = ring[:-1].T, ring[1:].T
    crosses = (y0 > point[1]) != (y1 > point[1])
    slope = np.divide(x1 - x0, y1 - y0, out=np.zeros_like(x0), where=crosses)
    return bool(np.sum(crosses & (point[0] < x0 + (point[1] - y0) * slope)) % 2)


def farthest(points: np.ndarray, ring: np.ndarray) -> float:
    """Return the largest distance (m) of points (n, 2) to the nearest place on a ring."""
    step = max(1, _PAIRS_AT_ONCE // len(ring))
    chunks = (points[low : low + step] for low in range(0, len(points), step))
    return max(float(edge_distances(chunk, ring[:-1], ring[1:]).min(axis=1).max()) for chunk in chunks)


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
