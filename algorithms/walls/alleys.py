"""Find alleys between houses whose roofs nearly touch: two walls that face each other show two houses."""

from itertools import combinations
from typing import Optional

import numpy as np

from ..criteria import MAJORITY
from ..geometry.rings import signed_area
from .wall_edges import closed
from .wall_lines import MOST, SAME_WALL, WallLine
from .wall_outline import Limits, WallOutline


def find_alley(outline: WallOutline, limits: Limits) -> Optional[WallLine]:
    """Return the middle of the widest alley across an outline, None without any: a line without points.

    Along it, what was taken for one building falls into two. Roofs that meet over an alley jut out from both sides.
    """
    seen = [line for line in outline.cells.lines if line.is_seen]
    widest, middle = SAME_WALL, None
    for one, other in combinations(seen, 2):
        alley = _between(one, other)
        if alley is None:
            continue
        width = abs(float(one.across(other.point[None])[0]))
        if widest <= width <= 2 * limits.max_overhang and _is_alley(alley, (one, other), outline, limits.min_area):
            widest, middle = width, alley
    return middle


def _between(one: WallLine, other: WallLine) -> Optional[WallLine]:
    """Return the line halfway between two that are nearly parallel, None if they are not."""
    sign = np.sign(one.direction @ other.direction)
    if abs(one.direction @ other.direction) < np.cos(MOST):
        return None
    direction = one.direction + sign * other.direction
    # If the lines are not quite parallel, halfway is measured at the midpoint of the second one's points.
    foot = one.point + ((other.point - one.point) @ one.direction) * one.direction
    nothing = np.zeros(0)
    return WallLine((foot + other.point) / 2, direction / np.hypot(*direction), nothing.astype(int), nothing, np.nan)


def _is_alley(alley: WallLine, walls: tuple[WallLine, WallLine], outline: WallOutline, min_area: float) -> bool:
    """Return whether walls on both sides are seen wherever a line crosses the outline, with houses behind both."""
    rings = [closed(ring) for ring in outline.rings]
    chords = _chords(alley, rings)
    if not len(chords):
        return False
    for wall in walls:
        positions = alley.point + chords[..., None] * alley.direction
        along = np.sort((positions - wall.point) @ wall.direction, axis=1)
        length = np.diff(along, axis=1)[:, 0]
        covered = [outline.cells.scale.covered(wall.along, low, high) if high > low else 0.0 for low, high in along]
        away = np.sign(alley.across(wall.point[None])[0]) * alley.normal
        behind = sum(signed_area(_clipped(ring, wall.point, away)) for ring in rings)
        if length @ covered < MAJORITY * length.sum() or behind < min_area:
            return False
    return True


def _chords(line: WallLine, rings: list[np.ndarray]) -> np.ndarray:
    """Return the pieces of a line inside rings (k, 2): start and end, m along its direction."""
    crossings = []
    for ring in rings:
        across, along = line.across(ring), (ring - line.point) @ line.direction
        cut = np.flatnonzero((across[:-1] > 0) != (across[1:] > 0))
        share = across[cut] / (across[cut] - across[cut + 1])
        crossings.append(along[cut] + share * (along[cut + 1] - along[cut]))
    return np.sort(np.concatenate(crossings)).reshape(-1, 2)


def _clipped(ring: np.ndarray, point: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the part of a closed ring on the side of a line that its normal points to, closed; Sutherland-Hodgman."""
    depth = (ring - point) @ normal
    kept = []
    for a, b, depth_a, depth_b in zip(ring, ring[1:], depth, depth[1:]):
        if depth_a >= 0:
            kept.append(a)
        if (depth_a >= 0) != (depth_b >= 0):
            kept.append(a + depth_a / (depth_a - depth_b) * (b - a))
    return np.array([*kept, kept[0]]) if kept else np.zeros((1, 2))
