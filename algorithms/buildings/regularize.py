"""Straight walls and right angles: walls along an outline turned to main directions, and the corners between them."""

from __future__ import annotations

from dataclasses import replace
from typing import Optional

import numpy as np

from .lines import Line, Wall, cross, line_along, simplify
from .outlines import signed_area
from .segments import distances_to, is_valid

# Walls closer than this to a main direction may be meant to have it; others are diagonals and keep their own.
_MAX_TURN = np.deg2rad(22.5)

# What supports a direction, and the share of an outline that makes it a main one: by chance 22 % of a circle is within
# 10° of one direction and its normal, and a second direction needs a wing or a street of its own. Where no corner is
# square, parallel walls that are most of the outline make one.
_SUPPORT, _MIN_SHARE, _MIN_FURTHER_SHARE, _MOST = np.deg2rad(10), 0.35, 0.15, 0.6

# Diagonals up to so many tolerances long between parallel walls are steps.
_FILLER = 2.25

# A corner may be cut by a wall of this share of the walls beside it.
_CUT = 0.5

# Sine of the angle between walls that are taken for parallel, about a degree.
_PARALLEL = 0.02

# Sine of the angle in which two walls are a spike or a notch, 30°, or 60° where it is small.
_SPIKE, _SMALL_SPIKE = 0.5, 0.87

# A spike is nowhere wider than so many tolerances: the sharp end of a building is none.
_NARROW = 3.0

# Cosine of the angle below which a corner is sharp, 60°.
_SHARP = 0.5

# A step between parallel walls that is no larger (tolerances) is none.
_STEP = 0.75

# What is smaller than a square with sides of so many tolerances is no part of a building.
_SMALL = 1.5

# Turns (sine) between the walls along a curve, one after the other to the same side: 4° to 40°.
_LEAST_BEND, _MOST_BEND = 0.07, 0.64

# The ends of a wall are turned by no more than so many tolerances.
_SHIFT = 0.6

# Walls up to so many tolerances long don't know their direction well.
_SHORT = 4.5


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
        Rings in the same order, valid together; holes too small for three walls are left out.
    """
    lines = [line_along(ring, outset) for ring in rings]
    directions = main_directions([wall for line in lines for wall in line.walls(tolerance)])
    if not directions:
        return None
    made: list = []
    for line in lines:
        walls = line.walls(tolerance, directions)
        corners = np.array(straighten(line, walls, directions, tolerance)[1]).reshape(-1, 2)
        if len(corners) < 3 and made:
            continue
        if not is_near(corners, line, 2 * tolerance):
            return None
        made.append(np.concatenate([corners, corners[:1]]))
    return made if is_valid(made) else None


def is_near(places: np.ndarray, line: Line, limit: float) -> bool:
    """Return whether a straight line stays within ``limit`` (m) of a traced one, and nearly all of that one of it."""
    raw = line.samples
    if len(places) < (3 if line.is_closed else 2):
        return False
    if line.is_closed:
        places, raw = (np.concatenate([one, one[:1]]) for one in (places, raw))
        if signed_area(places) * signed_area(raw) <= 0:
            return False
    far = distances_to(line.samples, places) > limit
    # Spikes, which have no area, are left out: they are a small part of a building, or it is no good.
    return bool((distances_to(places, raw) <= limit).all() and line.weights[far].sum() <= 0.1 * line.weights.sum())


def main_directions(walls: list) -> list:
    """Return the directions (rad, in [0, pi/2)) that most walls, in order, have or are square to, the strongest first.

    There is none without a right angle or, as most of an outline, parallel walls: a round tower turns little at every
    corner.
    """
    # A long wall tells more of a direction than many short ones.
    length, angle = np.array([wall.length for wall in walls]) ** 2, np.array([wall.angle for wall in walls])
    is_left, found, least = np.ones(len(walls), bool), [], _MIN_SHARE
    # Four times the angle is the same for walls that are parallel or square to each other.
    apart = np.abs(np.angle(np.exp(4j * (angle[:, None] - angle)))) / 4
    corners = _right_angles(length, angle)
    is_parallel = np.abs(np.sin(angle[:, None] - angle)) <= np.sin(_SUPPORT / 2)
    is_most = length @ is_parallel >= _MOST * length.sum()
    while is_left.any():
        near = (apart <= _SUPPORT) & is_left[:, None]
        close = (apart <= _SUPPORT / 4) & is_left[:, None]
        has_corner = (near[corners[:, 0]] & near[corners[:, 1]]).any(axis=0)
        share = np.where(is_left & (has_corner | is_most), length @ near, 0.0)
        best = int(np.argmax(share))
        if share[best] < least * length.sum():
            break
        # What the most nearly agree on, not the mean of all: a wall that is a few degrees off doesn't bend the others.
        used = near[best] & (apart[int(np.argmax(np.where(near[best], length @ close, 0.0)))] <= _SUPPORT / 4)
        center = np.angle(np.sum(length[used] * np.exp(4j * angle[used]))) / 4
        found.append(float(np.mod(center, np.pi / 2)))
        is_left &= ~near[:, best]
        least = _MIN_FURTHER_SHARE
    return found


def _right_angles(length: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return the pairs (p, 2) of walls that follow each other at a right angle, but for a cut corner between them."""
    here = np.arange(len(length))
    found = []
    for step in (1, 2):
        there = np.roll(here, -step)
        is_square = np.abs(np.cos(angle - angle[there])) < np.sin(_SUPPORT)
        is_cut = np.roll(length, -1) < _CUT**2 * np.minimum(length, length[there])
        found.append(np.column_stack([here, there])[is_square & (is_cut | (step == 1))])
    return np.concatenate(found)


def straighten(line: Line, walls: list, directions: list, tolerance: float) -> tuple[list, list]:
    """Return the walls along a line, turned to main directions where they nearly have them, and the corners between.

    Parameters
    ----------
    line : Line
        Samples along the outline.
    walls : list of Wall
        Its straight pieces.
    directions : list of float
        Main directions (rad), each with its normal.
    tolerance : float
        Distance (m) that wiggles may have; the ends of a wall are turned by little more than half of that.

    Returns
    -------
    walls : list of Wall
        At least one for an open line; none for a closed one that has no room for three walls.
    corners : list of ndarray of shape (2,)
        Of a closed line all around, from the end of the first wall; of an open one those between its ends.
    """
    walls = _turned(line, walls, directions, tolerance)
    walls = _without_fillers(walls, line, tolerance)
    count = len(walls) + 1
    while len(walls) < count:
        count = len(walls)
        walls = _merged(line, _without_spikes(walls, line, tolerance), tolerance)
    walls = _rebroken(line, walls, tolerance)
    if line.is_closed and len(walls) < 3:
        return [], []
    corners: list = []
    for here, there in _following(walls, line):
        corners += _joined(here, there, line, tolerance)
    return walls, _without_loops(corners, 4 * tolerance) if line.is_closed else corners


def chords(line: Line, tolerance: float) -> np.ndarray:
    """Return the corners (m, 2) of a closed line along its samples, where it has no main directions: few, and close."""
    made = np.array(straighten(line, line.walls(tolerance), [], tolerance)[1]).reshape(-1, 2)
    if is_near(made, line, 2 * tolerance) and is_valid([np.concatenate([made, made[:1]])]):
        return made
    places = line.samples[simplify(line.samples, tolerance, line.is_closed)]
    return np.array(_without_loops(list(places), 8 * tolerance))


def _following(walls: list, line: Line) -> list:
    """Return the pairs of walls that follow each other."""
    return list(zip(walls, [*walls[1:], walls[0]] if line.is_closed else walls[1:]))


def _turned(line: Line, walls: list, directions: list, tolerance: float) -> list:
    """Return the walls turned to main directions: long ones to the nearest, short ones as the longest wall beside."""
    is_long = [wall.length > _SHORT * tolerance for wall in walls]
    is_bent = _along_curves(walls, line)
    turned = [
        _snapped(line, wall, directions, tolerance) if long and not bent else wall
        for wall, long, bent in zip(walls, is_long, is_bent)
    ]
    for number, wall in enumerate(walls):
        if is_long[number] or is_bent[number]:
            continue
        beside = [number + step for step in (-2, -1, 1, 2)]
        beside = [i % len(walls) for i in beside if line.is_closed or 0 <= i < len(walls)]
        longest = max((turned[i] for i in beside if is_long[i]), key=lambda one: one.length, default=None)
        own = directions if longest is None else [longest.angle]
        turned[number] = _snapped(line, wall, own, tolerance)
    return turned


def _along_curves(walls: list, line: Line) -> list:
    """Return which walls are chords of a curve: the walls before and after them turn a little to the same side."""
    turns = [
        cross(here.direction, there.direction) if here.direction @ there.direction > 0 else 1.0
        for here, there in _following(walls, line)
    ]
    is_bend = [_LEAST_BEND <= abs(turn) <= _MOST_BEND for turn in turns]
    around = range(len(walls)) if line.is_closed else range(1, len(walls) - 1)
    bent = [False] * len(walls)
    for i in around:
        bent[i] = is_bend[i - 1] and is_bend[i] and turns[i - 1] * turns[i] > 0
    return bent


def _snapped(line: Line, wall: Wall, directions: list, tolerance: float) -> Wall:
    """Return the wall turned to the nearest main direction, unless that moves its ends too far."""
    turns = [
        (direction + np.round((wall.angle - direction) / (np.pi / 2)) * np.pi / 2) - wall.angle
        for direction in directions
    ]
    turn = min(turns, key=abs, default=np.pi)
    if abs(turn) > _MAX_TURN or wall.length / 2 * np.sin(abs(turn)) > _SHIFT * tolerance:
        return wall
    angle = wall.angle + turn
    direction = np.array([np.cos(angle), np.sin(angle)])
    return replace(line.fitted(wall.first, wall.last, tolerance, direction), is_main=True)


def _without_fillers(walls: list, line: Line, tolerance: float) -> list:
    """Leave out short diagonals between walls of main directions: corners that no point has hit, and steps."""
    if len(walls) < 3:
        return walls
    kept = []
    around = zip([walls[-1], *walls], walls, [*walls[1:], walls[0]])
    for number, (before, here, after) in enumerate(around):
        is_end = not line.is_closed and number in (0, len(walls) - 1)
        is_corner = abs(before.direction @ after.direction) < _PARALLEL
        is_step = before.direction @ after.direction > 1 - _PARALLEL
        is_small = here.length <= tolerance * (2 * _SMALL * is_corner + _FILLER * is_step)
        if is_end or here.is_main or not is_small or not (before.is_main and after.is_main):
            kept.append(here)
    return kept


def _without_spikes(walls: list, line: Line, tolerance: float) -> list:
    """Leave out the shorter of two walls that lead to and fro: a strip too narrow to be a part of a building."""
    i = 0
    while len(walls) > 3 and i < len(walls) - (not line.is_closed):
        j = (i + 1) % len(walls)
        here, there = walls[i], walls[j]
        sine = abs(cross(here.direction, there.direction))
        is_small = sine * min(here.length, there.length) ** 2 / 2 < (_SMALL * tolerance) ** 2
        most = _SMALL_SPIKE if is_small else _SPIKE
        is_narrow = sine * min(here.length, there.length) < _NARROW * tolerance
        if here.direction @ there.direction < 0 and sine < most and is_narrow:
            del walls[i if here.length < there.length else j]
            i = max(i - 2, 0)
        else:
            i += 1
    return walls


def _merged(line: Line, walls: list, tolerance: float) -> list:
    """Join walls that follow each other in one line, also over what is left of a spike between them."""
    i = 0
    while i < len(walls):
        for ahead in (1, 2):
            j = (i + ahead) % len(walls)
            if len(walls) - ahead < (3 if line.is_closed else 1) or (j < i and not line.is_closed):
                continue
            here, there = walls[i], walls[j]
            is_along = abs(cross(here.direction, there.direction)) < _PARALLEL and here.direction @ there.direction > 0
            if (
                is_along
                and abs(here.offset(there.point)) <= _STEP * tolerance
                and _is_small(line, here, there, tolerance)
            ):
                longer = here if here.length >= there.length else there
                last = there.last + len(line.samples) * (there.last < here.first)
                joined = line.fitted(here.first, last, tolerance, longer.direction)
                walls[i] = replace(joined, is_main=here.is_main or there.is_main)
                gone = {(i + k) % len(walls) for k in range(1, ahead + 1)}
                walls = [wall for k, wall in enumerate(walls) if k not in gone]
                i = max(i - sum(k < i for k in gone) - 3, -1)
                break
        i += 1
    return walls


def _is_small(line: Line, here: Wall, there: Wall, tolerance: float) -> bool:
    """Return whether the line has no bay or recess that counts between two walls."""
    first, last = here.last, there.first + len(line.samples) * (there.first < here.last)
    places = line.samples[line.rows(first, last)]
    return abs(signed_area(np.concatenate([places, places[:1]]))) < (_SMALL * tolerance) ** 2


def _rebroken(line: Line, walls: list, tolerance: float) -> list:
    """Fit walls anew to the samples between the corners that they make."""
    breaks = {}
    count = len(line.samples)
    for number, (here, there) in enumerate(_following(walls, line)):
        turn = cross(here.direction, there.direction)
        if abs(turn) < _PARALLEL:
            continue
        corner = _crossing(here, there, turn)
        middle, end = (here.first + here.last) // 2, (there.first + there.last) // 2
        rows = line.rows(middle, end + count * (end < middle))
        nearest = int(np.argmin(((line.samples[rows] - corner) ** 2).sum(axis=1)))
        breaks[number] = middle + nearest
    made = []
    for number, wall in enumerate(walls):
        before = (number - 1) % len(walls) if line.is_closed else number - 1
        first, last = breaks.get(before, wall.first), breaks.get(number, wall.last)
        first += count * round((wall.first - first) / count)
        last += count * round((wall.last - last) / count)
        if last - first >= 2:
            fitted = line.fitted(first, last, tolerance, wall.direction)
            made.append(replace(fitted, is_main=wall.is_main))
        else:
            made.append(wall)
    return made


def _crossing(here: Wall, there: Wall, turn: float) -> np.ndarray:
    return here.point + cross(there.point - here.point, there.direction) / turn * here.direction


def _joined(here: Wall, there: Wall, line: Line, tolerance: float) -> list:
    """Return the corner between two walls, or the two ends of the jog between walls that are nearly parallel."""
    turn = cross(here.direction, there.direction)
    bend = line.samples[there.first % len(line.samples)]
    if abs(turn) >= _PARALLEL:
        corner = _crossing(here, there, turn)
        # Walls that are nearly parallel meet far away, and sharp ends beyond what was seen: a step between them, or a
        # blunt end, is truer than that corner.
        is_sharp = here.direction @ there.direction < -_SHARP
        if np.hypot(*(corner - bend)) <= (1 if is_sharp else 2) * tolerance:
            return [corner]
    ends = [here.foot(bend), there.foot(bend)]
    if here.direction @ there.direction > 0 and np.hypot(*(ends[1] - ends[0])) <= tolerance:
        return [(ends[0] + ends[1]) / 2]
    return ends


def _without_loops(corners: list, longest: float) -> list:
    """Cut off where a closed line crosses itself within a short way (m): steps that are narrower than their walls."""
    i = 0
    while i < len(corners) and len(corners) > 4:
        count = len(corners)
        for ahead in (2, 3):
            a, b, c, d = (corners[(i + k) % count] for k in (0, 1, ahead, ahead + 1))
            turn = cross(b - a, d - c)
            way = sum(np.hypot(*(corners[(i + k) % count] - corners[(i + k + 1) % count])) for k in range(1, ahead))
            if ahead + 2 > count or way > longest or not turn:
                continue
            share, other = cross(c - a, d - c) / turn, cross(c - a, b - a) / turn
            if 0 <= share <= 1 and 0 <= other <= 1:
                corners[(i + 1) % count] = a + share * (b - a)
                gone = {(i + k) % count for k in range(2, ahead + 1)}
                corners = [corner for k, corner in enumerate(corners) if k not in gone]
                i = max(i - 3, -1)
                break
        i += 1
    return corners
