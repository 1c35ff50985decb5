"""Straight edges and right angles: edges along an outline turned to main directions, and the corners between them.

An edge here is a straight side of an outline, fitted to the samples along it (``OutlineEdge``).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Optional

import numpy as np

from ..geometry.line_segments import distances_to, is_valid
from ..geometry.polylines import Line, OutlineEdge, cross, line_along, simplify
from ..geometry.rings import signed_area

# Angle (rad) up to which an edge may be meant to have a main direction: half of the way to the next possible one, 45°
# on, beyond which it is a diagonal and keeps its own.
_MAX_TURN = np.deg2rad(22.5)

# Angle (rad) up to which an edge supports a direction or its normal.
_SUPPORT = np.deg2rad(10)

# Share of the squared lengths of all edges that makes a direction a main one: by chance 22 % of a circle support one.
_MIN_SHARE = 0.35

# The same for every further one, which needs no more than a wing of its own.
_MIN_FURTHER_SHARE = 0.15

# The same for parallel edges where no corner is square: most of the outline.
_PARALLEL_SHARE = 0.6

# Longest edge (tolerances) between two parallel ones that counts as a step rather than a diagonal. Fitted on simulated
# outlines of known buildings.
_STEP_EDGE = 2.25

# Longest edge that cuts a right angle off, as a share of the shorter edge beside it: half of a regular octagon's.
_CUT = 0.5

# Sine of the angle up to which edges are parallel, about a degree.
_PARALLEL = 0.02

# Sine of the angle up to which two edges back and forth are a spike or a notch: 30°.
_SPIKE = 0.5

# The same where the spike is smaller than any part of a building: 60°.
_SMALL_SPIKE = 0.87

# Greatest width (tolerances) of a spike: the sharp end of a building is wider.
_SPIKE_WIDTH = 3.0

# Cosine of the angle up to which a corner is sharp: 60°.
_SHARP = 0.5

# Greatest distance (tolerances) of parallel edges that are one: less than the wiggles of an outline.
_STEP = 0.75

# Side (tolerances) of the largest square that is no part of a building. Fitted on simulated bays and notches.
_SMALL = 1.5

# Sines of the least and the greatest turn between two edges along a curve: 4° and 40°.
_LEAST_BEND = 0.07
_MOST_BEND = 0.64

# Greatest distance (tolerances) by which the ends of an edge are turned: about a spacing of the points.
_SHIFT = 0.6

# Greatest length (tolerances) of an edge whose own direction is uncertain: wiggles turn it by 12° or more.
_SHORT = 4.5

# Longest way (tolerances) around a loop where edges cross, of an outline with main directions and of one of chords.
_LOOP = 4.0
_LOOP_OF_CHORDS = 8.0


def regularize_outline(rings: list, tolerance: float, outset: float = 0.0) -> Optional[list]:
    """Return an outline with straight edges along its main directions, None where that would change it too much.

    Parameters
    ----------
    rings : list of ndarray of shape (m, 2)
        Exterior counterclockwise, then holes clockwise, closed (m).
    tolerance : float
        Distance (m) that wiggles of the outline may have; no vertex moves farther than twice that.
    outset : float
        Distance (m) that edges are moved outward: the outermost points lie inside the eaves.

    Returns
    -------
    list of ndarray, or None
        Rings in the same order, valid together; holes too small for three edges are left out.
    """
    lines = [line_along(ring, outset) for ring in rings]
    directions = main_directions([edge for line in lines for edge in line.edges(tolerance)])
    if not directions:
        return None
    made: list = []
    for line in lines:
        edges = line.edges(tolerance, directions)
        corners = np.array(straighten(line, edges, directions, tolerance)[1]).reshape(-1, 2)
        if len(corners) < 3 and made:
            continue
        if not is_near(corners, line, 2 * tolerance):
            return None
        made.append(np.concatenate([corners, corners[:1]]))
    return made if is_valid(made) else None


def is_near(positions: np.ndarray, line: Line, limit: float) -> bool:
    """Return whether a straight line stays within ``limit`` (m) of a traced one, and nearly all of that one of it."""
    raw = line.samples
    if len(positions) < (3 if line.is_closed else 2):
        return False
    if line.is_closed:
        positions, raw = (np.concatenate([one, one[:1]]) for one in (positions, raw))
        if signed_area(positions) * signed_area(raw) <= 0:
            return False
    far = distances_to(line.samples, positions) > limit
    # Spikes, which have no area, are left out: they are a small part of a building, or it is no good.
    return bool((distances_to(positions, raw) <= limit).all() and line.weights[far].sum() <= 0.1 * line.weights.sum())


def main_directions(edges: list) -> list:
    """Return the directions (rad, in [0, pi/2)) that most edges, in order, have or are square to, the strongest first.

    A main direction needs a right angle or parallel edges that are most of the outline: a round tower, which turns
    little at every corner, has no such direction.
    """
    # A long edge determines a direction better than many short ones.
    length, angle = np.array([edge.length for edge in edges]) ** 2, np.array([edge.angle for edge in edges])
    is_left, found, least = np.ones(len(edges), bool), [], _MIN_SHARE
    # Four times the angle is the same for edges that are parallel or square to each other.
    apart = np.abs(np.angle(np.exp(4j * (angle[:, None] - angle)))) / 4
    corners = _right_angles(length, angle)
    is_parallel = np.abs(np.sin(angle[:, None] - angle)) <= np.sin(_SUPPORT / 2)
    is_most = length @ is_parallel >= _PARALLEL_SHARE * length.sum()
    while is_left.any():
        near = (apart <= _SUPPORT) & is_left[:, None]
        close = (apart <= _SUPPORT / 4) & is_left[:, None]
        has_corner = (near[corners[:, 0]] & near[corners[:, 1]]).any(axis=0)
        share = np.where(is_left & (has_corner | is_most), length @ near, 0.0)
        best = int(np.argmax(share))
        if share[best] < least * length.sum():
            break
        # What the most nearly agree on, not the mean of all: an edge that is a few degrees off doesn't bend the others.
        used = near[best] & (apart[int(np.argmax(np.where(near[best], length @ close, 0.0)))] <= _SUPPORT / 4)
        center = np.angle(np.sum(length[used] * np.exp(4j * angle[used]))) / 4
        found.append(float(np.mod(center, np.pi / 2)))
        is_left &= ~near[:, best]
        least = _MIN_FURTHER_SHARE
    return found


def _right_angles(length: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return the pairs (p, 2) of edges that follow each other at a right angle, but for a cut corner between them."""
    here = np.arange(len(length))
    found = []
    for step in (1, 2):
        there = np.roll(here, -step)
        is_square = np.abs(np.cos(angle - angle[there])) < np.sin(_SUPPORT)
        is_cut = np.roll(length, -1) < _CUT**2 * np.minimum(length, length[there])
        found.append(np.column_stack([here, there])[is_square & (is_cut | (step == 1))])
    return np.concatenate(found)


def straighten(line: Line, edges: list, directions: list, tolerance: float) -> tuple[list, list]:
    """Return the edges along a line, turned to main directions where they nearly have them, and the corners between.

    Parameters
    ----------
    line : Line
        Samples along the outline.
    edges : list of OutlineEdge
        Its straight pieces.
    directions : list of float
        Main directions (rad), each with its normal.
    tolerance : float
        Distance (m) that wiggles may have; the ends of an edge are turned by little more than half of that.

    Returns
    -------
    edges : list of OutlineEdge
        At least one for an open line; none for a closed one that has no room for three edges.
    corners : list of ndarray of shape (2,)
        Of a closed line all around, from the end of the first edge; of an open one those between its ends.
    """
    edges = _turned(line, edges, directions, tolerance)
    edges = _without_fillers(edges, line, tolerance)
    count = len(edges) + 1
    while len(edges) < count:
        count = len(edges)
        edges = _merged(line, _without_spikes(edges, line, tolerance), tolerance)
    edges = _rebroken(line, edges, tolerance)
    if line.is_closed and len(edges) < 3:
        return [], []
    corners: list = []
    for here, there in _following(edges, line):
        corners += _joined(here, there, line, tolerance)
    return edges, _without_loops(corners, _LOOP * tolerance) if line.is_closed else corners


def chords(line: Line, tolerance: float) -> np.ndarray:
    """Return the corners (m, 2) of a closed line along its samples, where it has no main directions: few, and close."""
    made = np.array(straighten(line, line.edges(tolerance), [], tolerance)[1]).reshape(-1, 2)
    if is_near(made, line, 2 * tolerance) and is_valid([np.concatenate([made, made[:1]])]):
        return made
    positions = line.samples[simplify(line.samples, tolerance, line.is_closed)]
    return np.array(_without_loops(list(positions), _LOOP_OF_CHORDS * tolerance))


def _following(edges: list, line: Line) -> list:
    """Return the pairs of edges that follow each other."""
    return list(zip(edges, [*edges[1:], edges[0]] if line.is_closed else edges[1:]))


def _turned(line: Line, edges: list, directions: list, tolerance: float) -> list:
    """Return the edges turned to main directions: long ones to the nearest, short ones as the longest edge beside."""
    is_long = [edge.length > _SHORT * tolerance for edge in edges]
    is_bent = _along_curves(edges, line)
    turned = [
        _snapped(line, edge, directions, tolerance) if long and not bent else edge
        for edge, long, bent in zip(edges, is_long, is_bent)
    ]
    for number, edge in enumerate(edges):
        if is_long[number] or is_bent[number]:
            continue
        beside = [number + step for step in (-2, -1, 1, 2)]
        beside = [i % len(edges) for i in beside if line.is_closed or 0 <= i < len(edges)]
        longest = max((turned[i] for i in beside if is_long[i]), key=lambda one: one.length, default=None)
        own = directions if longest is None else [longest.angle]
        turned[number] = _snapped(line, edge, own, tolerance)
    return turned


def _along_curves(edges: list, line: Line) -> list:
    """Return which edges are chords of a curve: the edges before and after them turn a little to the same side."""
    turns = [
        cross(here.direction, there.direction) if here.direction @ there.direction > 0 else 1.0
        for here, there in _following(edges, line)
    ]
    is_bend = [_LEAST_BEND <= abs(turn) <= _MOST_BEND for turn in turns]
    around = range(len(edges)) if line.is_closed else range(1, len(edges) - 1)
    bent = [False] * len(edges)
    for i in around:
        bent[i] = is_bend[i - 1] and is_bend[i] and turns[i - 1] * turns[i] > 0
    return bent


def _snapped(line: Line, edge: OutlineEdge, directions: list, tolerance: float) -> OutlineEdge:
    """Return the edge turned to the nearest main direction, unless that moves its ends too far."""
    turns = [
        (direction + np.round((edge.angle - direction) / (np.pi / 2)) * np.pi / 2) - edge.angle
        for direction in directions
    ]
    turn = min(turns, key=abs, default=np.pi)
    if abs(turn) > _MAX_TURN or edge.length / 2 * np.sin(abs(turn)) > _SHIFT * tolerance:
        return edge
    angle = edge.angle + turn
    direction = np.array([np.cos(angle), np.sin(angle)])
    return replace(line.fitted(edge.first, edge.last, tolerance, direction), is_main=True)


def _without_fillers(edges: list, line: Line, tolerance: float) -> list:
    """Leave out short diagonals between edges of main directions: corners that no point has hit, and steps."""
    if len(edges) < 3:
        return edges
    kept = []
    around = zip([edges[-1], *edges], edges, [*edges[1:], edges[0]])
    for number, (before, here, after) in enumerate(around):
        is_end = not line.is_closed and number in (0, len(edges) - 1)
        is_corner = abs(before.direction @ after.direction) < _PARALLEL
        is_step = before.direction @ after.direction > 1 - _PARALLEL
        is_small = here.length <= tolerance * (2 * _SMALL * is_corner + _STEP_EDGE * is_step)
        if is_end or here.is_main or not is_small or not (before.is_main and after.is_main):
            kept.append(here)
    return kept


def _without_spikes(edges: list, line: Line, tolerance: float) -> list:
    """Leave out the shorter of two edges that lead to and fro: a strip too narrow to be a part of a building."""
    i = 0
    while len(edges) > 3 and i < len(edges) - (not line.is_closed):
        j = (i + 1) % len(edges)
        here, there = edges[i], edges[j]
        sine = abs(cross(here.direction, there.direction))
        is_small = sine * min(here.length, there.length) ** 2 / 2 < (_SMALL * tolerance) ** 2
        most = _SMALL_SPIKE if is_small else _SPIKE
        is_narrow = sine * min(here.length, there.length) < _SPIKE_WIDTH * tolerance
        if here.direction @ there.direction < 0 and sine < most and is_narrow:
            del edges[i if here.length < there.length else j]
            i = max(i - 2, 0)
        else:
            i += 1
    return edges


def _merged(line: Line, edges: list, tolerance: float) -> list:
    """Join edges that follow each other in one line, also over the rest of a spike between them."""
    number = 0
    while number < len(edges):
        for ahead in (1, 2):
            joined = _joined_ahead(line, edges, number, ahead, tolerance)
            if joined is not None:
                edges[number] = joined
                edges, n_before = _without_following(edges, number, ahead)
                # Three edges back, the joined one is two ahead.
                number = max(number - n_before - 3, -1)
                break
        number += 1
    return edges


def _joined_ahead(line: Line, edges: list, number: int, ahead: int, tolerance: float) -> Optional[OutlineEdge]:
    """Return an edge joined with the one that comes 1 or 2 ``ahead``, None where they are not in one line."""
    other = (number + ahead) % len(edges)
    least = 3 if line.is_closed else 1
    if len(edges) - ahead < least or (other < number and not line.is_closed):
        return None
    here, there = edges[number], edges[other]
    is_along = abs(cross(here.direction, there.direction)) < _PARALLEL and here.direction @ there.direction > 0
    if not is_along or abs(here.offset(there.point)) > _STEP * tolerance or not _is_small(line, here, there, tolerance):
        return None
    longer = here if here.length >= there.length else there
    last = there.last + len(line.samples) * (there.last < here.first)
    joined = line.fitted(here.first, last, tolerance, longer.direction)
    return replace(joined, is_main=here.is_main or there.is_main)


def _without_following(items: list, number: int, count: int) -> tuple[list, int]:
    """Leave out what follows an item of a closed sequence; return the rest, and how many were left out before it."""
    gone = {(number + k) % len(items) for k in range(1, count + 1)}
    return [item for k, item in enumerate(items) if k not in gone], sum(k < number for k in gone)


def _is_small(line: Line, here: OutlineEdge, there: OutlineEdge, tolerance: float) -> bool:
    """Return whether what the line encloses between two edges is too small for a bay or a recess."""
    first, last = here.last, there.first + len(line.samples) * (there.first < here.last)
    positions = line.samples[line.rows(first, last)]
    return abs(signed_area(np.concatenate([positions, positions[:1]]))) < (_SMALL * tolerance) ** 2


def _rebroken(line: Line, edges: list, tolerance: float) -> list:
    """Fit edges anew to the samples between the corners that they make."""
    corners = _samples_at_corners(line, edges)
    count = len(line.samples)
    refitted = []
    for number, edge in enumerate(edges):
        before = (number - 1) % len(edges) if line.is_closed else number - 1
        first, last = corners.get(before, edge.first), corners.get(number, edge.last)
        # Samples of a closed line are counted on from round to round.
        first += count * round((edge.first - first) / count)
        last += count * round((edge.last - last) / count)
        is_seen = last - first >= 2
        fitted = line.fitted(first, last, tolerance, edge.direction) if is_seen else edge
        refitted.append(replace(fitted, is_main=edge.is_main))
    return refitted


def _samples_at_corners(line: Line, edges: list) -> dict[int, int]:
    """Return the sample nearest to the corner after each edge, by its number, but for those that hardly turn there."""
    nearest = {}
    count = len(line.samples)
    for number, (here, there) in enumerate(_following(edges, line)):
        turn = cross(here.direction, there.direction)
        if abs(turn) >= _PARALLEL:
            middle, end = (here.first + here.last) // 2, (there.first + there.last) // 2
            between = line.samples[line.rows(middle, end + count * (end < middle))]
            nearest[number] = middle + int(np.argmin(((between - _crossing(here, there, turn)) ** 2).sum(axis=1)))
    return nearest


def _crossing(here: OutlineEdge, there: OutlineEdge, turn: float) -> np.ndarray:
    return here.point + cross(there.point - here.point, there.direction) / turn * here.direction


def _joined(here: OutlineEdge, there: OutlineEdge, line: Line, tolerance: float) -> list:
    """Return the corner between two edges, or the two ends of the jog between edges that are nearly parallel."""
    turn = cross(here.direction, there.direction)
    bend = line.samples[there.first % len(line.samples)]
    if abs(turn) >= _PARALLEL:
        corner = _crossing(here, there, turn)
        # Edges that are nearly parallel meet far away, and sharp ends beyond what was seen: a step between them, or a
        # blunt end, is truer than that corner.
        is_sharp = here.direction @ there.direction < -_SHARP
        if np.hypot(*(corner - bend)) <= (1 if is_sharp else 2) * tolerance:
            return [corner]
    ends = [here.foot(bend), there.foot(bend)]
    if here.direction @ there.direction > 0 and np.hypot(*(ends[1] - ends[0])) <= tolerance:
        return [(ends[0] + ends[1]) / 2]
    return ends


def _without_loops(corners: list, longest: float) -> list:
    """Cut off where a closed line crosses itself within a short way (m): steps that are narrower than their edges."""
    number = 0
    while number < len(corners) and len(corners) > 4:
        for ahead in (2, 3):
            crossing = _crossing_ahead(corners, number, ahead, longest)
            if crossing is not None:
                following = (number + 1) % len(corners)
                corners[following] = crossing
                corners, _ = _without_following(corners, following, ahead - 1)
                number = max(number - 3, -1)
                break
        number += 1
    return corners


def _crossing_ahead(corners: list, number: int, ahead: int, longest: float) -> Optional[np.ndarray]:
    """Return where the segment from a corner crosses the one that begins 2 or 3 corners ``ahead``.

    None if they don't cross, or if the way from the one to the other is longer than ``longest`` (m).
    """
    count = len(corners)
    a, b, *between, d = (corners[(number + k) % count] for k in range(ahead + 2))
    c = between[-1]
    turn = cross(b - a, d - c)
    way = sum(np.hypot(*(start - end)) for start, end in zip([b, *between], between))
    if ahead + 2 > count or way > longest or not turn:
        return None
    share, other = cross(c - a, d - c) / turn, cross(c - a, b - a) / turn
    return a + share * (b - a) if 0 <= share <= 1 and 0 <= other <= 1 else None
