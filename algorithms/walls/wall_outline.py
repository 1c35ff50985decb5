"""The outline of one building's walls: which lines between its corners are real."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..footprints.regularization import regularize_outline
from ..geometry.line_segments import nearest_edge_distances
from ..geometry.polylines import simplify_ring
from ..stage import Monitor
from .cheapest_outline import Limits, OutlineCase, OutlineCells, Simplification
from .roof_cover import RoofCover
from .wall_edges import WallEdge, points_near
from .wall_lines import Scale, WallLine, find_lines, merge_lines, square_up, wall_scale

# Tolerance (m) of the outline of a roof when its sides are made straight.
_WIGGLE = 0.4

# Larger tolerances (times the first) for roofs whose edges have bites from holes in the cloud; the larger one is used
# only where no outline comes of the smaller.
_OVER_BITES = (1.5, 2.0)

# Fewest points that show where a wall is, where a side of the roof makes it likely.
_FEW = 5

# Least share of the length of this wall that they cover.
_LEAST_COVERED = 0.2

# Largest distance (m) of a wall beyond the roof: that of noise.
_FLUSH = 0.2

# Largest angle (radians) between a side of the roof and walls that are seen, whose direction the side then takes.
_LIKE = np.deg2rad(8.0)

# Largest angle (radians) between a wall and its eave.
_EAVE_ANGLE = np.deg2rad(3.0)

# Largest distance (m) of the eave of a wall from where the overhang makes it likely.
_EAVE = 0.3

# Largest distance (m) at which it counts as lying right there.
_AS_EXPECTED = 0.15


@dataclass(frozen=True)
class WallOutline:
    """The outline of one building's walls.

    Attributes
    ----------
    rings : list of list of WallEdge
        Edges in order, exteriors first.
    overhang : float
        Overhang of the roof, m.
    lines : list of WallLine
        All lines that the outline could have been made of.
    scale : Scale
        Tolerance and bins of this building's walls.
    low, high : ndarray of shape (2,)
        Corners of the rectangle that holds the roof and the room around it, m.
    """

    rings: list[list[WallEdge]]
    overhang: float
    lines: list[WallLine]
    scale: Scale
    low: np.ndarray
    high: np.ndarray

    @property
    def seen(self) -> float:
        """Share of the outline that has wall points, 0 to 1."""
        return share_seen(self.rings)


def share_seen(rings: list[list[WallEdge]]) -> float:
    """Return the share of the length of rings that has wall points, 0 to 1."""
    edges = [edge for ring in rings for edge in ring]
    length = np.array([np.hypot(*(edge.end - edge.start)) for edge in edges])
    return float(np.sum(length * [edge.quality for edge in edges]) / length.sum())


def outline_walls(
    walls: np.ndarray,
    roof: np.ndarray,
    traced: list,
    spacing: float,
    limits: Limits,
    is_party: Callable[[np.ndarray], np.ndarray],
    rng: np.random.Generator,
    monitor: Monitor,
) -> Optional[WallOutline]:
    """Return the outline of a building's walls, None where no wall is seen.

    Parameters
    ----------
    walls, roof : ndarray of shape (n, 2), (m, 2)
        Points of walls and of the roof in plan, near the origin (m).
    traced : list of ndarray
        Rings of the roof's outline.
    spacing : float
        Mean distance between the roof's points, m.
    limits : Limits
        What walls may be like.
    is_party : callable
        Returns beside which sides (k, 2, 2) of the roof another roof begins: no eave juts out there.
    rng : Generator
        Random numbers.
    monitor : Monitor
        Receives progress.
    """
    perimeter = float(np.hypot(*np.diff(simplify_ring(traced[0], 0.5), axis=0).T).sum())
    scale = wall_scale(len(walls), perimeter, limits.tolerance)
    cover = RoofCover(roof, traced[1:])
    seen = find_lines(walls, scale, limits.min_length, rng, monitor.part(0.0, 0.3))
    seen = [line for line in seen if np.median(cover.depth_at(walls[line.points])) > -_FLUSH]
    seen = square_up(merge_lines(seen, walls, scale), walls)
    if not seen:
        return None
    sides = _sides(traced, spacing)
    on_walls = np.concatenate([walls[line.points] for line in seen])
    to_roof = nearest_edge_distances(on_walls, *np.moveaxis(sides, 1, 0))
    overhang = float(np.clip(np.median(to_roof), 0.0, limits.max_overhang))
    straight, sides = len(sides), np.concatenate([sides, _bends(traced, sides, spacing)])
    overhangs = np.where(is_party(sides), 0.0, overhang)
    seen = [_expectation(line, sides[:straight], overhangs[:straight]) for line in seen]
    lines = [*seen, *_from_roof(seen, sides, overhangs, walls, scale)]
    near = [points_near(walls, line, scale) for line in lines]
    case = OutlineCase(cover, scale, limits, overhang)
    cells = OutlineCells(lines, near, case, monitor.part(0.3, 0.4))
    rings = cells.rings(Simplification(cells).run(monitor.part(0.4, 1.0)))
    return WallOutline(rings, overhang, lines, scale, cover.low, cover.high) if rings else None


def outline_roof(roof: np.ndarray, traced: list, spacing: float, limits: Limits, monitor: Monitor) -> list:
    """Return the outline of a roof as rings of edges of which nothing was seen, made as those of walls are.

    The parameters are those of :func:`outline_walls`. Bites out of the edge of the roof are left out where they cost
    more corners than they are worth.

    Parameters
    ----------
    roof : ndarray of shape (n, 3)
        Points of the roof, m.
    traced : list
        Traced outlines of it.
    spacing : float
        Point spacing, m.
    limits : Limits
        What walls may be like.
    monitor : Monitor
        Receives the progress.
    """
    sides, nothing, scale = _sides(traced, spacing), np.zeros((0, 2)), Scale(limits.tolerance, 1.0)
    sides = np.concatenate([sides, _bends(traced, sides, spacing)])
    lines = _from_roof([], sides, np.zeros(len(sides)), nothing, scale)
    case = OutlineCase(RoofCover(roof, traced[1:]), scale, limits, 0.0)
    cells = OutlineCells(lines, [nothing] * len(lines), case, monitor.part(0.0, 0.5))
    return cells.rings(Simplification(cells).run(monitor.part(0.5, 1.0)))


def _sides(traced: list, spacing: float) -> np.ndarray:
    """Return the sides of the roof (k, 2, 2) (m): start and end, the building to the left."""
    straight = (regularize_outline(traced, times * _WIGGLE, spacing / 2) for times in _OVER_BITES)
    rings = next((rings for rings in straight if rings), None) or [simplify_ring(ring, _WIGGLE) for ring in traced]
    return _edges_of(rings)


def _bends(traced: list, sides: np.ndarray, spacing: float) -> np.ndarray:
    """Return the edges (k, 2, 2) of the roof's exterior as it was seen where the straight ``sides`` go over it (m)."""
    ring = simplify_ring(traced[0], max(_WIGGLE, 2 * spacing))
    is_over = nearest_edge_distances(ring, *np.moveaxis(sides, 1, 0)) > _WIGGLE
    return _edges_of([ring])[is_over[:-1] | is_over[1:]]


def _edges_of(rings: list) -> np.ndarray:
    """Return the edges (k, 2, 2) of closed rings."""
    return np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])


def _expectation(line: WallLine, sides: np.ndarray, overhangs: np.ndarray) -> WallLine:
    """Return a wall, marked as expected where it lies as a side of the roof says that it should."""
    walls = (_expected(side, overhang, []) for side, overhang in zip(sides, overhangs))
    return replace(line, expected=any(_is_eave_of(line, wall, _AS_EXPECTED) for wall in walls))


def _expected(side: np.ndarray, overhang: float, seen: list[WallLine]) -> WallLine:
    """Return the line, without points, where a wall below a side of the roof should be; it runs like those seen."""
    start, end = side
    direction = _like_walls((end - start) / np.hypot(*(end - start)), seen)
    middle = (start + end) / 2 + overhang * np.array([-direction[1], direction[0]])
    return WallLine(middle, direction, np.zeros(0, np.int64), np.zeros(0), np.nan, True)


def _like_walls(direction: np.ndarray, seen: list[WallLine]) -> np.ndarray:
    """Return the direction of the wall that is most nearly parallel or square to one, where that is near."""
    ways = [sign * way for line in seen for way in (line.direction, line.normal) for sign in (1, -1)]
    best = max(ways, key=lambda way: float(way @ direction), default=direction)
    return best if best @ direction > np.cos(_LIKE) else direction


def _is_eave_of(wall: WallLine, line: WallLine, within: float) -> bool:
    """Return whether a wall is the one that is expected on a ``line``, to ``within`` (m)."""
    parallel = abs(wall.direction @ line.direction) >= np.cos(_EAVE_ANGLE)
    return bool(parallel and abs(float(wall.across(line.point[None])[0])) <= within)


def _from_roof(
    seen: list[WallLine], sides: np.ndarray, overhangs: np.ndarray, walls: np.ndarray, scale: Scale
) -> list[WallLine]:
    """Return lines for sides of the roof without a known wall: through the few points there, or as expected."""
    lines: list[WallLine] = []
    length = np.hypot(*(sides[:, 1] - sides[:, 0]).T)
    # A long side meets more points than the rest of it beyond a notch, which would stand for it.
    for number in np.argsort(-length, kind="stable"):
        line = _expected(sides[number], float(overhangs[number]), seen)
        if not any(_is_eave_of(wall, line, _EAVE) for wall in [*seen, *lines]):
            lines.append(_through_few(line, float(length[number]) / 2, walls, scale))
    return lines


def _through_few(line: WallLine, half: float, walls: np.ndarray, scale: Scale) -> WallLine:
    """Return the line moved to the most points beside it, ``half`` (m) to both sides of its middle, if there are any.

    The direction is known, so that far fewer points determine a wall than without.
    """
    across, along = line.across(walls), (walls - line.point) @ line.direction
    beside = np.flatnonzero((np.abs(across) <= _EAVE) & (np.abs(along) <= half))
    if not len(beside):
        return line
    position, near = across[beside], scale.tolerance / 2
    ordered = np.sort(position)
    count = np.searchsorted(ordered, position + near, side="right") - np.searchsorted(ordered, position - near)
    best = beside[np.abs(position - position[np.argmax(count)]) <= near]
    if len(best) < _FEW or scale.covered(along[best], -half, half) < _LEAST_COVERED:
        return line
    moved = line.point + np.mean(across[best]) * line.normal
    return replace(line, point=moved, points=best, along=along[best], deviation=float(np.std(across[best])))
