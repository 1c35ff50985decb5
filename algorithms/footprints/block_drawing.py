"""Outlines of the buildings of a block: straight, of chords, or as traced, each border drawn once.

A strategy draws the rings around the block and the borders between its buildings by themselves (straighten), lets the
borders end on the rings and on each other (attach), and puts the outlines of buildings together from these (assemble).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Callable, Optional

import numpy as np

from ..geometry.polylines import Line, OutlineEdge, simplify
from ..geometry.rings import signed_area
from .blocks import Block, Border, Junction, Piece
from .regularization import chords, is_near, main_directions, straighten

# Of the outline as traced, no vertex of a straight one lies farther than this many tolerances: one to either side.
_LIMIT = 2.0

# An open border up to this many tolerances long has no direction of its own: it is hardly longer than it may wiggle.
_SHORTEST_BORDER = 2.0

# Tolerance (of that of the outline) within which a border that is not straight keeps to its samples: unlike an outline,
# it has a building on either side, and points of both lie as close to it.
_BORDER_TOLERANCE = 0.5

# Weight (m) of the ends of an open border among its samples, which count by their lengths: next to nothing.
_END_WEIGHT = 1e-3

# Weight of the traced position of a junction against the lines that meet there: it settles what parallel ones leave
# open, and hardly moves a crossing of others.
_PULL = 0.1


@dataclass(frozen=True)
class Course:
    """The course of a ring around a block or of a border.

    Attributes
    ----------
    vertices : ndarray of shape (m, 2), float64
        Its vertices (m): of a closed one all around; of an open border those between its ends, until it is attached.
    is_straight : bool
        Whether it consists of straight edges along main directions, rather than of what was traced.
    edges : sequence of OutlineEdge
        The edges of an open border that is straight.
    """

    vertices: np.ndarray
    is_straight: bool = False
    edges: Sequence[OutlineEdge] = ()


@dataclass(frozen=True)
class Anchor:
    """Where a junction lies in the drawing.

    Attributes
    ----------
    position : ndarray of shape (2,), float64
        m.
    segment : int, optional
        Segment of the ring around the block on which it lies, None inside of the block.
    share : float
        How far along that segment, 0 to 1.
    """

    position: np.ndarray
    segment: Optional[int] = None
    share: float = 0.0


@dataclass(frozen=True)
class Drawing:
    """The outlines of the buildings of a block.

    Attributes
    ----------
    rings : dict of int to list of ndarray of shape (m, 2)
        Closed rings of each building (m), the exterior first.
    straight : frozenset of int
        Buildings whose whole outline is straight.
    """

    rings: dict[int, list[np.ndarray]]
    straight: frozenset[int] = frozenset()

    @property
    def segments(self) -> tuple[np.ndarray, np.ndarray]:
        """Starts and ends (s, 2) of all segments."""
        rings = [ring for of_face in self.rings.values() for ring in of_face]
        return np.concatenate([ring[:-1] for ring in rings]), np.concatenate([ring[1:] for ring in rings])

    @property
    def box(self) -> tuple[float, ...]:
        """Least and greatest coordinates: x, y, x, y (m)."""
        exteriors = np.concatenate([rings[0] for rings in self.rings.values()])
        return (*exteriors.min(axis=0), *exteriors.max(axis=0))

    @property
    def area(self) -> float:
        """Area of all buildings without their holes (m²)."""
        return sum(signed_area(ring) for of_face in self.rings.values() for ring in of_face)


Strategy = Callable[[Block, float], Optional[Drawing]]


def draw_straight(block: Block, tolerance: float, closeness: float = 1.0) -> Optional[Drawing]:
    """Draw a block with edges along its main directions where that stays close to what was traced.

    Parameters
    ----------
    block : Block
        Buildings that touch.
    tolerance : float
        Distance (m) that wiggles of a traced outline may have.
    closeness : float
        Share of the tolerance that counts for the edges, but not for their directions.

    Returns
    -------
    Drawing or None
        None without a main direction, or where the pieces of an outline don't fit together.
    """
    lines = block.ring_lines()
    # Edges within less have other directions by chance: those of a round tower would find a right angle.
    directions = main_directions([edge for line in lines for edge in line.edges(tolerance)])
    if not directions:
        return None
    limit, tolerance = _LIMIT * tolerance, closeness * tolerance
    rings = [_straight_ring(line, directions, tolerance, limit) for line in lines]
    borders = [_straight_border(block, border, directions, tolerance) for border in block.borders]
    anchors = _attach(block, lines, rings, borders, tolerance, limit)
    finished = [
        _finished(block, border, course, anchors, tolerance, limit) for border, course in zip(block.borders, borders)
    ]
    return _assemble(block, rings, finished, anchors)


def draw_chords(block: Block, tolerance: float, closeness: float = 1.0, outset: float = 1.0) -> Optional[Drawing]:
    """Draw a block with chords of what was traced, in directions of their own.

    ``closeness`` is the share of the tolerance (m) that counts, ``outset`` that of the distance from the outermost
    points to the edge of the roof. None where the pieces of an outline don't fit together.
    """
    limit, tolerance = _LIMIT * tolerance, closeness * tolerance
    lines = block.ring_lines(outset)
    rings = [Course(chords(line, tolerance)) for line in lines]
    anchors = _attach(block, lines, rings, [Course(np.zeros((0, 2)))] * len(block.borders), tolerance, limit)
    borders = [Course(_simplified(block, border, anchors, tolerance, outset)) for border in block.borders]
    return _assemble(block, rings, borders, anchors)


def draw_traced(block: Block, tolerance: float) -> Optional[Drawing]:
    """Draw a block through its samples, at the edges of the roofs; None where pieces of an outline don't fit."""
    rings = [Course(line.samples) for line in block.ring_lines()]
    anchors = {junction.point: _between_samples(block, rings, junction, tolerance) for junction in block.junctions}
    borders = [Course(_traced(block, border, anchors)) for border in block.borders]
    return _assemble(block, rings, borders, anchors)


def draw_points(block: Block) -> Drawing:
    """Draw a block through its outermost points: always valid, and never across another block's outline."""
    rings = {}
    for face, outlines in block.outlines.items():
        edges = [np.concatenate([piece.half_edges for piece in pieces]) for pieces in outlines]
        rings[face] = [_closed(block.mesh.points(ring, is_closed=True)) for ring in edges]
    return Drawing({face: sorted(of_face, key=signed_area, reverse=True) for face, of_face in rings.items()})


# Where one fails, the next is tried, and after the last one the outermost points. Closer ones leave less room between
# blocks to run into each other.
REGULARIZED: tuple[Strategy, ...] = (
    draw_straight,
    partial(draw_straight, closeness=0.5),
    draw_chords,
    partial(draw_chords, closeness=0.5),
    partial(draw_chords, closeness=0.5, outset=0.0),
)
AS_TRACED: tuple[Strategy, ...] = (draw_traced,)


def _straight_ring(line: Line, directions: list[float], tolerance: float, limit: float) -> Course:
    """Return a ring along main directions, or chords of it if that one strays more than the limit (m)."""
    _, corners = straighten(line, line.edges(tolerance, directions), directions, tolerance)
    vertices = np.array(corners).reshape(-1, 2)
    return Course(vertices, is_straight=True) if is_near(vertices, line, limit) else Course(chords(line, tolerance))


def _straight_border(block: Block, border: Border, directions: list[float], tolerance: float) -> Course:
    """Return the straight edges of a border and the corners between these; a short one is a single line."""
    samples, length = block.mesh.samples(border.half_edges, outset=1.0)
    if not border.is_closed:
        ends = block.mesh.xy[list(border.ends)]
        samples = np.concatenate([ends[:1], samples, ends[1:]])
        length = np.concatenate([[_END_WEIGHT], length, [_END_WEIGHT]])
        if length.sum() <= _SHORTEST_BORDER * tolerance:
            return Course(np.zeros((0, 2)), is_straight=True)
    line = Line(samples, length, border.is_closed)
    edges, corners = straighten(line, line.edges(tolerance, directions), directions, tolerance)
    return Course(np.array(corners).reshape(-1, 2), is_straight=True, edges=edges)


def _attach(
    block: Block, lines: list[Line], rings: list[Course], borders: list[Course], tolerance: float, limit: float
) -> dict[int, Anchor]:
    """Return the anchors of junctions by point: on the ring, or where the borders that end there meet."""
    ending: dict[int, list[OutlineEdge]] = {junction.point: [] for junction in block.junctions}
    for border, course in zip(block.borders, borders):
        if not border.is_closed:
            ending[border.ends[0]] += course.edges[:1]
            ending[border.ends[1]] += course.edges[-1:]
    anchors = {}
    for junction in block.junctions:
        edges = ending[junction.point]
        if junction.ring is None:
            anchors[junction.point] = _where_lines_meet(block.mesh.xy[junction.point], edges, tolerance)
        else:
            samples = lines[junction.ring].samples
            traced = (samples[junction.at - 1] + samples[junction.at]) / 2
            anchors[junction.point] = _on_ring(rings[junction.ring].vertices, traced, edges, limit)
    return anchors


def _between_samples(block: Block, rings: list[Course], junction: Junction, tolerance: float) -> Anchor:
    """Return the anchor of a junction half-way between the samples before and after it."""
    if junction.ring is None:
        return _where_lines_meet(block.mesh.xy[junction.point], [], tolerance)
    samples = rings[junction.ring].vertices
    middle = (samples[junction.at - 1] + samples[junction.at]) / 2
    return Anchor(middle, (junction.at - 1) % len(samples), 0.5)


def _on_ring(ring: np.ndarray, traced: np.ndarray, edges: list[OutlineEdge], limit: float) -> Anchor:
    """Return where the longest edge meets an open ring near a position, or the nearest position on the ring."""
    starts, along = ring, np.roll(ring, -1, axis=0) - ring
    square = np.maximum((along**2).sum(axis=1), 1e-30)
    share = np.clip(((traced - starts) * along).sum(axis=1) / square, 0, 1)
    feet = starts + share[:, None] * along
    distance = np.hypot(*(feet - traced).T)
    nearest = int(np.argmin(distance))
    if edges:
        # Where the ring steps along that edge, a little to one side of it, it is met at the wrong end of the step.
        most = min(limit, distance[nearest] + limit / 2)
        met = _where_edge_meets(ring, traced, max(edges, key=lambda edge: edge.length), most)
        if met is not None:
            return met
    return Anchor(feet[nearest], nearest, float(share[nearest]))


def _where_edge_meets(ring: np.ndarray, traced: np.ndarray, edge: OutlineEdge, most: float) -> Optional[Anchor]:
    """Return where the line of an edge meets a ring nearest to a position, None beyond ``most`` (m) of it."""
    starts, along = ring, np.roll(ring, -1, axis=0) - ring
    offset = edge.direction[0] * (starts - edge.point)[:, 1] - edge.direction[1] * (starts - edge.point)[:, 0]
    end_offset = np.roll(offset, -1)
    crosses = np.flatnonzero((offset > 0) != (end_offset > 0))
    if not len(crosses):
        return None
    share = offset[crosses] / (offset[crosses] - end_offset[crosses])
    crossings = starts[crosses] + share[:, None] * along[crosses]
    distance = np.hypot(*(crossings - traced).T)
    best = int(np.argmin(distance))
    return Anchor(crossings[best], int(crosses[best]), float(share[best])) if distance[best] <= most else None


def _where_lines_meet(traced: np.ndarray, edges: list[OutlineEdge], limit: float) -> Anchor:
    """Return the position nearest to the lines of all edges that end at a junction, the traced one if that is far."""
    normals = [np.array([[-edge.direction[1], edge.direction[0]]]) for edge in edges]
    offsets = [normal @ edge.point for normal, edge in zip(normals, edges)]
    matrix, right = np.concatenate([_PULL * np.eye(2), *normals]), np.concatenate([_PULL * traced, *offsets])
    position = np.linalg.lstsq(matrix, right, rcond=None)[0]
    return Anchor(position if np.hypot(*(position - traced)) <= limit else traced)


def _finished(
    block: Block, border: Border, course: Course, anchors: dict[int, Anchor], tolerance: float, limit: float
) -> Course:
    """Return a straight border from anchor to anchor, or a simplified one where that strays from what was traced."""
    vertices = _between(border, anchors, course.vertices)
    _, length = block.mesh.samples(border.half_edges, outset=1.0)
    weights = length if border.is_closed else np.concatenate([[0.0], length, [0.0]])
    if is_near(vertices, Line(_traced(block, border, anchors), weights, border.is_closed), limit):
        return replace(course, vertices=vertices)
    return Course(_simplified(block, border, anchors, tolerance))


def _simplified(
    block: Block, border: Border, anchors: dict[int, Anchor], tolerance: float, outset: float = 1.0
) -> np.ndarray:
    """Return the vertices of a border that keep it close to its samples."""
    traced = _traced(block, border, anchors, outset)
    return traced[simplify(traced, _BORDER_TOLERANCE * tolerance, border.is_closed)]


def _traced(block: Block, border: Border, anchors: dict[int, Anchor], outset: float = 1.0) -> np.ndarray:
    """Return a border through its samples."""
    return _between(border, anchors, block.mesh.samples(border.half_edges, outset)[0])


def _between(border: Border, anchors: dict[int, Anchor], vertices: np.ndarray) -> np.ndarray:
    """Return the vertices of a border with the anchors at its ends, if it has any."""
    if border.is_closed:
        return vertices
    first, last = (anchors[end].position for end in border.ends)
    return np.concatenate([first[None], vertices, last[None]])


def _assemble(
    block: Block, rings: list[Course], borders: list[Course], anchors: dict[int, Anchor]
) -> Optional[Drawing]:
    """Put the outlines of buildings together; None where a piece has no line, or one has no exterior or several."""
    drawn, straight = {}, set()
    for face, outlines in block.outlines.items():
        courses = [[_course(piece, rings, borders) for piece in pieces] for pieces in outlines]
        of_face = _exterior_first([_ring(pieces, own, anchors) for pieces, own in zip(outlines, courses)])
        if of_face is None:
            return None
        drawn[face] = of_face
        if all(course is not None and course.is_straight for own in courses for course in own):
            straight.add(face)
    return Drawing(drawn, frozenset(straight))


def _course(piece: Piece, rings: list[Course], borders: list[Course]) -> Optional[Course]:
    if piece.border is not None:
        return borders[piece.border]
    return None if piece.ring is None else rings[piece.ring]


def _ring(pieces: list[Piece], courses: list[Optional[Course]], anchors: dict[int, Anchor]) -> Optional[np.ndarray]:
    """Return the closed ring (m, 2) of consecutive pieces, None where one of them has no line."""
    parts = []
    for piece, course in zip(pieces, courses):
        part = None if course is None else _part(piece, course.vertices, anchors)
        if part is None:
            return None
        parts.append(part if piece.is_closed else part[:-1])
    return _closed(np.concatenate(parts))


def _part(piece: Piece, vertices: np.ndarray, anchors: dict[int, Anchor]) -> Optional[np.ndarray]:
    """Return the vertices of a piece from one end to the other, of a closed one all around."""
    if piece.border is not None:
        return vertices[::-1] if piece.is_reversed else vertices
    return vertices if piece.is_closed else _part_of_ring(piece, vertices, anchors)


def _part_of_ring(piece: Piece, ring: np.ndarray, anchors: dict[int, Anchor]) -> Optional[np.ndarray]:
    """Return the part of an open ring from one anchor on to another, None if one of these doesn't lie on it."""
    first, last = (anchors[end] for end in piece.ends)
    if first.segment is None or last.segment is None:
        return None
    count = len(ring)
    ahead = float(count)
    if piece.ends[0] != piece.ends[1]:
        ahead = (last.segment + last.share - first.segment - first.share) % count
    # An anchor at the end of a segment is the corner there: that one doesn't come again.
    corners = (first.segment + 1 + np.arange(int(np.floor(first.share + ahead - 1e-9)))) % count
    return np.concatenate([first.position[None], ring[corners], last.position[None]])


def _closed(ring: np.ndarray) -> np.ndarray:
    return np.concatenate([ring, ring[:1]])


def _exterior_first(rings: list[Optional[np.ndarray]]) -> Optional[list[np.ndarray]]:
    """Return the rings of a polygon, exterior first, None unless there is just one."""
    made = [ring for ring in rings if ring is not None and len(ring) >= 4]
    if len(made) < len(rings):
        return None
    made.sort(key=signed_area, reverse=True)
    areas = [signed_area(ring) for ring in made]
    return made if areas[0] > 0 and all(area < 0 for area in areas[1:]) else None
