"""The outline of one building's walls."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..criteria import PARALLEL
from ..geometry.rings import nearest_edge_distances, perimeter
from ..stage import Monitor
from .cheapest_outline import OutlineCells, simplified
from .roof_outline import RoofCover, RoofOutline
from .wall_edges import WallEdge
from .wall_lines import MOST, SAME_WALL, Scale, WallLine, find_lines, merge_lines, square_up, wall_scale

# The few points that locate a wall below a side of the roof cover at least this share of its length.
_LEAST_COVERED = 0.2


@dataclass(frozen=True)
class Limits:
    """What walls and footprints may be like."""

    tolerance: float  #: Distance of points from their line, m
    min_length: float  #: Shortest wall, m
    max_overhang: float  #: Widest overhang of a roof, m
    min_area: float  #: Smallest footprint, m²
    min_seen: float  #: Least share of the perimeter with wall points
    seed: int  #: Start of the random numbers


@dataclass(frozen=True)
class WallOutline:
    """The outline of one building's walls."""

    rings: list[list[WallEdge]]  #: Edges in order, exteriors first
    overhang: float  #: Overhang of the roof, m
    cells: OutlineCells  #: The cells that it could have been made of
    inside: np.ndarray  #: (cells,), bool: those that it was made of


def share_seen(rings: list[list[WallEdge]]) -> float:
    """Return the share of the length of rings that has wall points, 0 to 1."""
    edges = [edge for ring in rings for edge in ring]
    length = np.array([np.hypot(*(edge.end - edge.start)) for edge in edges])
    return float(np.sum(length * [edge.quality for edge in edges]) / length.sum())


def outline_walls(
    walls: np.ndarray,
    outline: RoofOutline,
    limits: Limits,
    is_party: Callable[[np.ndarray], np.ndarray],
    monitor: Monitor,
) -> Optional[WallOutline]:
    """Return the outline of a building's walls, None if no wall is seen.

    Parameters
    ----------
    walls : ndarray of shape (n, 2)
        Points of walls in plan, near the origin (m).
    outline : RoofOutline
        The roof's outline.
    limits : Limits
        What walls and footprints may be like.
    is_party : callable
        Returns the mask of the sides (k, 2, 2) of the roof next to which another roof begins: no eave juts out there.
    monitor : Monitor
        Receives progress.
    """
    scale = wall_scale(len(walls), perimeter(outline.parts[0][0]), limits.tolerance)
    cover = RoofCover([ring for rings in outline.parts for ring in rings])
    seen = find_lines(walls, scale, limits.min_length, np.random.default_rng(limits.seed), monitor.part(0.0, 0.3))
    seen = square_up(merge_lines(seen, walls, scale), walls)
    # Where no wall is seen, the sides are not drawn.
    if not seen or not len(outline.sides):
        return None
    sides = outline.sides
    on_walls = np.concatenate([walls[line.points] for line in seen])
    to_roof = nearest_edge_distances(on_walls, *np.moveaxis(sides, 1, 0))
    overhang = float(np.clip(np.median(to_roof), 0.0, limits.max_overhang))
    overhangs = np.where(is_party(sides), 0.0, overhang)
    seen = [_expectation(line, sides, overhangs) for line in seen]
    lines = [*seen, *_from_roof(seen, sides, overhangs, walls, scale)]
    cells = OutlineCells(lines, walls, cover, scale, overhang)
    inside = simplified(cells, monitor.part(0.4, 1.0))
    rings = cells.rings(inside)
    return WallOutline(rings, overhang, cells, inside) if rings else None


def _expectation(line: WallLine, sides: np.ndarray, overhangs: np.ndarray) -> WallLine:
    """Return a wall, marked as expected where it lies as a side of the roof says that it should."""
    walls = (_expected(side, overhang, []) for side, overhang in zip(sides, overhangs))
    return replace(line, expected=any(_is_eave_of(line, wall) for wall in walls))


def _expected(side: np.ndarray, overhang: float, seen: list[WallLine]) -> WallLine:
    """Return the line, without points, where a wall below a side of the roof should be; it runs like those seen."""
    start, end = side
    direction = _like_walls((end - start) / np.hypot(*(end - start)), seen)
    middle = (start + end) / 2 + overhang * np.array([-direction[1], direction[0]])
    return WallLine(middle, direction, np.zeros(0, np.int64), np.zeros(0), np.nan, True)


def _like_walls(direction: np.ndarray, seen: list[WallLine]) -> np.ndarray:
    """Return the direction of the wall that is most nearly parallel or square to one, where that is within ``MOST``."""
    ways = [sign * way for line in seen for way in (line.direction, line.normal) for sign in (1, -1)]
    best = max(ways, key=lambda way: float(way @ direction), default=direction)
    return best if best @ direction > np.cos(MOST) else direction


def _is_eave_of(wall: WallLine, line: WallLine) -> bool:
    """Return whether a wall is the one that is expected on a ``line``."""
    is_parallel = abs(wall.normal @ line.direction) < PARALLEL
    return bool(is_parallel and abs(float(wall.across(line.point[None])[0])) <= SAME_WALL)


def _from_roof(
    seen: list[WallLine], sides: np.ndarray, overhangs: np.ndarray, walls: np.ndarray, scale: Scale
) -> list[WallLine]:
    """Return lines for sides of the roof without a known wall: through the few points there, or as expected."""
    lines: list[WallLine] = []
    length = np.hypot(*(sides[:, 1] - sides[:, 0]).T)
    # Try long sides first: the remainder of a side beyond a notch has fewer points and would pass for the whole side.
    for number in np.argsort(-length, kind="stable"):
        line = _expected(sides[number], float(overhangs[number]), seen)
        if not any(_is_eave_of(wall, line) for wall in [*seen, *lines]):
            lines.append(_through_few(line, float(length[number]) / 2, walls, scale))
    return lines


def _through_few(line: WallLine, half: float, walls: np.ndarray, scale: Scale) -> WallLine:
    """Return the line moved to the most points next to it, ``half`` (m) to both sides of its middle, if there are any.

    With a known direction, far fewer points determine a wall.
    """
    across, along = line.across(walls), (walls - line.point) @ line.direction
    beside = np.flatnonzero((np.abs(across) <= SAME_WALL) & (np.abs(along) <= half))
    if not len(beside):
        return line
    position, near = across[beside], scale.tolerance / 2
    ordered = np.sort(position)
    count = np.searchsorted(ordered, position + near, side="right") - np.searchsorted(ordered, position - near)
    best = beside[np.abs(position - position[np.argmax(count)]) <= near]
    if scale.covered(along[best], -half, half) < _LEAST_COVERED:
        return line
    moved = line.point + np.mean(across[best]) * line.normal
    return replace(line, point=moved, points=best, along=along[best], deviation=float(np.std(across[best])))
