"""Polygons of buildings that touch: each border is made once, and both buildings have it.

The rings around all buildings that touch are made straight first, as if they were one building, then the borders
between them, which are cut off where they meet the rings. Buildings are put together of these pieces.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from ..stage import Monitor
from .lines import Line, Wall, simplify
from .outlines import Tracing, pieces_of, signed_area
from .regularize import chords, is_near, main_directions, straighten
from .segments import is_valid, meet_in_corners, segments_meet


@dataclass(frozen=True)
class _Manner:
    """How the borders of a group of buildings are made: along main directions or not, how closely, how far outside."""

    is_straight: bool = False
    is_traced: bool = False
    closeness: float = 1.0
    outset: float = 1.0


# Where one fails, the next is tried: straight, also closer to the traced borders; chords of these in their own
# directions, also closer, also at the outermost points; last, through the points.
_REGULAR = (
    _Manner(is_straight=True),
    _Manner(is_straight=True, closeness=0.5),
    _Manner(),
    _Manner(closeness=0.5),
    _Manner(closeness=0.5, outset=0.0),
    _Manner(is_traced=True, outset=0.0),
)
_AS_TRACED = (_Manner(is_traced=True), _Manner(is_traced=True, outset=0.0))


@dataclass
class _Arc:
    """A border between two buildings: its half-edges seen from the first, its ends, and what became of it."""

    edges: np.ndarray
    is_closed: bool
    ends: tuple[int, int]
    is_straight: bool = False
    walls: list = field(default_factory=list)
    corners: list = field(default_factory=list)
    places: Optional[np.ndarray] = None


class Coverage:
    """The polygons of the faces of a tracing.

    Attributes
    ----------
    polygons : list
        Rings of each face, the exterior first.
    is_straight : ndarray of shape (f,)
        Whether its outline was made straight.
    """

    def __init__(self, tracing: Tracing, tolerance: float, regularize: bool, monitor: Monitor) -> None:
        self.tracing, self.tolerance, self.monitor = tracing, tolerance, monitor
        self.starts, self.ends = tracing.starts, tracing.ends
        self.group_of_triangle = _groups(tracing)
        self.across = tracing.beyond(tracing.face)
        self._sort_rings()
        self.nodes = self._nodes()
        self.polygons: list = [[] for _ in tracing.labels]
        self.is_straight = np.zeros(len(tracing.labels), bool)
        self.manners = _REGULAR if regularize else _AS_TRACED
        self.manner = np.zeros(self.n_groups, np.int64)
        for group in range(self.n_groups):
            self._make(group)
            monitor.progress((group + 1) / self.n_groups)
        self._part_groups()

    def _sort_rings(self) -> None:
        """Find the rings of faces and of groups of faces that touch."""
        tracing = self.tracing
        self.n_groups = int(self.group_of_triangle.max(initial=-1)) + 1
        self.faces_of: list = [[] for _ in range(self.n_groups)]
        self.rings_of: list = [[] for _ in range(self.n_groups)]
        self.outer_of: list = [[] for _ in range(self.n_groups)]
        inside = tracing.face >= 0
        group_of_face = np.zeros(len(tracing.labels), np.int64)
        group_of_face[tracing.face[inside]] = self.group_of_triangle[inside]
        for face, group in enumerate(group_of_face.tolist()):
            self.faces_of[group].append(face)
        for face, ring in tracing.rings(tracing.face):
            self.rings_of[self.group_of_triangle[ring[0] // 3]].append((face, ring))
        for group, ring in tracing.rings(self.group_of_triangle):
            self.outer_of[group].append(ring)

    def _nodes(self) -> list:
        """Return for each group the points where borders between its buildings end.

        Where groups touch in a point, it may be one for the one and none for the other.
        """
        face, group = np.repeat(self.tracing.face, 3), np.repeat(self.group_of_triangle, 3)
        border = np.flatnonzero((face >= 0) & (face != self.across))
        is_inner, count = self.across[border] >= 0, len(self.tracing.xy)
        starts, ends = (group[border] * count + points[border] for points in (self.starts, self.ends))
        places, inverse = np.unique(np.concatenate([starts, ends]), return_inverse=True)
        # Each border between two buildings has two half-edges, any other one.
        degree = np.bincount(inverse, np.tile(np.where(is_inner, 1, 2), 2), len(places))
        found = places[np.isin(places, starts[is_inner]) & (degree != 4)]
        nodes: list = [set() for _ in range(self.n_groups)]
        for number, point in zip(*(values.tolist() for values in np.divmod(found, count))):
            nodes[number].add(point)
        return nodes

    def _make(self, group: int) -> None:
        """Make the polygons of a group in the best manner that gives valid ones near the traced ones."""
        while self.manner[group] < self._last:
            if self._made(group):
                return
            self.manner[group] += 1
        self._made(group)

    def _made(self, group: int) -> bool:
        """Make the polygons of a group; return whether they are good."""
        manner = self.manners[self.manner[group]]
        borders = _Borders(self, group, manner)
        if not borders.are_made:
            return False
        polygons: dict = {face: [] for face in self.faces_of[group]}
        for face, ring in self.rings_of[group]:
            polygons[face].append(borders.closed(face, ring))
        for face, made in polygons.items():
            rings = _ordered(made)
            if self.manner[group] < self._last and (rings is None or not is_valid(rings)):
                return False
            self.polygons[face] = rings
            self.is_straight[face] = manner.is_straight and face not in borders.traced_faces
        return len(polygons) == 1 or self.manner[group] == self._last or meet_in_corners(*self._segments(group))

    def _part_groups(self) -> None:
        """Give groups whose outlines run into each other's a lesser manner until none do.

        The smaller one goes first. Where none of its manners helps, the larger one runs over its points and has to.
        """
        boxes = [self._box(group) for group in range(self.n_groups)]
        size = [self._area(group) for group in range(self.n_groups)]
        left = list(range(self.n_groups))
        while left:
            manner = {}
            for one, other in sorted(self._meeting(left, np.array(boxes))):
                small, large = sorted((one, other), key=lambda group: (size[group], group))
                if self.manner[small] < self._last:
                    manner[small] = self.manner[small] + 1
                elif self.manner[large] < self._last:
                    manner.update({small: 0, large: self.manner[large] + 1})
            left = sorted(manner)
            for group in left:
                self.manner[group] = manner[group]
                self._make(group)
                boxes[group] = self._box(group)

    def _area(self, group: int) -> float:
        return sum(signed_area(ring) for face in self.faces_of[group] for ring in self.polygons[face])

    def _box(self, group: int) -> tuple:
        """Return the least and greatest coordinates of a group's polygons."""
        exteriors = [self.polygons[face][0] for face in self.faces_of[group]]
        low = np.min([ring.min(axis=0) for ring in exteriors], axis=0)
        return (*low, *np.max([ring.max(axis=0) for ring in exteriors], axis=0))

    def _segments(self, group: int) -> tuple[np.ndarray, np.ndarray]:
        rings = [ring for face in self.faces_of[group] for ring in self.polygons[face]]
        return np.concatenate([ring[:-1] for ring in rings]), np.concatenate([ring[1:] for ring in rings])

    def _meeting(self, groups: list, boxes: np.ndarray) -> set:
        """Return the pairs of groups, one of them among ``groups``, whose outlines meet."""
        found: set = set()
        for one in groups:
            beside = (boxes[:, :2] <= boxes[one, 2:]).all(axis=1) & (boxes[:, 2:] >= boxes[one, :2]).all(axis=1)
            for other in np.flatnonzero(beside).tolist():
                pair = min(one, other), max(one, other)
                if one == other or pair in found:
                    continue
                if segments_meet(*self._segments(one), *self._segments(other)):
                    found.add(pair)
        return found

    @property
    def _last(self) -> int:
        """The manner that always gives valid polygons that don't overlap."""
        return len(self.manners) - 1

    def samples(self, edges: np.ndarray, share: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        """Return the places (m, 2) where the building ends beyond its half-edges, and their lengths (m,).

        ``share`` is how much of the outset counts, from 0, at the points themselves, to 1.
        """
        a, b = self.tracing.xy[self.starts[edges]], self.tracing.xy[self.ends[edges]]
        step = b - a
        length = np.hypot(*step.T)
        outward = np.column_stack([step[:, 1], -step[:, 0]]) / length[:, None]
        return (a + b) / 2 + share * self.tracing.outset[edges, None] * outward, length


class _Borders:
    """All borders of one group of buildings that touch, made in one manner."""

    def __init__(self, coverage: Coverage, group: int, manner: _Manner) -> None:
        self.coverage, self.manner, self.limit = coverage, manner, 2 * coverage.tolerance
        self.tolerance = coverage.tolerance * manner.closeness
        # Through the points themselves, each border has its own and no other place.
        self.is_bare = manner.is_traced and not manner.outset
        self.outer, self.nodes = coverage.outer_of[group], coverage.nodes[group]
        self.place_of_edge = {
            edge: (number, at) for number, ring in enumerate(self.outer) for at, edge in enumerate(ring.tolist())
        }
        self.lines = [Line(*self._samples(ring), True) for ring in self.outer]
        self.traced_faces: set = set()
        self.positions: dict = {}
        self.arcs = self._arcs(group)
        self.rings = [line.samples for line in self.lines]
        self.is_straight = [False] * len(self.rings)
        self.are_made = not manner.is_straight or self._straighten()
        if self.are_made:
            self._cut_corners()
            self._place_nodes()

    def _samples(self, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.coverage.samples(edges, self.manner.outset)

    def _cut_corners(self) -> None:
        """Make chords of the rings that are not straight, which stay within the tolerance of the traced ones."""
        for number, line in enumerate(self.lines):
            if not self.is_straight[number] and not self.manner.is_traced:
                self.rings[number] = chords(line, self.tolerance)

    def _arcs(self, group: int) -> dict:
        """Return the borders between buildings of the group by their first half-edge."""
        arcs = {}
        for face, ring in self.coverage.rings_of[group]:
            for edges, is_closed in self._runs(ring):
                other = self.coverage.across[edges[0]]
                if other > face:
                    ends = int(self.coverage.starts[edges[0]]), int(self.coverage.ends[edges[-1]])
                    turned = np.roll(edges, -int(np.argmin(edges))) if is_closed else edges
                    arcs[int(turned[0])] = _Arc(turned, is_closed, ends)
        return arcs

    def _runs(self, ring: np.ndarray) -> list:
        """Return the pieces of a ring of half-edges from node to node, and whether they are closed."""
        starts = self.coverage.starts[ring]
        at = [i for i, point in enumerate(starts.tolist()) if point in self.nodes]
        if not at:
            return [(ring, True)]
        turned = np.roll(ring, -at[0])
        return [(run, False) for run in np.split(turned, np.array(at[1:], np.int64) - at[0])]

    def _straighten(self) -> bool:
        """Make borders straight where that stays close to the traced ones; return whether there is a main direction."""
        # Closer walls have other directions by chance: those of a round tower would find a right angle.
        directions = main_directions([wall for line in self.lines for wall in line.walls(self.coverage.tolerance)])
        if not directions:
            return False
        for number, line in enumerate(self.lines):
            _, corners = straighten(line, line.walls(self.tolerance, directions), directions, self.tolerance)
            ring = np.array(corners).reshape(-1, 2)
            if is_near(ring, line, self.limit):
                self.rings[number], self.is_straight[number] = ring, True
        for arc in self.arcs.values():
            samples, length = self._samples(arc.edges)
            if not arc.is_closed:
                ends = self.coverage.tracing.xy[list(arc.ends)]
                samples = np.concatenate([ends[:1], samples, ends[1:]])
                length = np.concatenate([[1e-3], length, [1e-3]])
            arc.is_straight = True
            # A border of a few points has no direction of its own.
            if arc.is_closed or length.sum() > 2 * self.tolerance:
                line = Line(samples, length, arc.is_closed)
                walls = line.walls(self.tolerance, directions)
                arc.walls, arc.corners = straighten(line, walls, directions, self.tolerance)
        return True

    def _place_nodes(self) -> None:
        """Put the ends of borders where they meet the rings and each other, then the borders between them."""
        ending: dict = {}
        for arc in self.arcs.values():
            if not arc.is_closed:
                ending.setdefault(arc.ends[0], []).append(arc.walls[:1])
                ending.setdefault(arc.ends[1], []).append(arc.walls[-1:])
        for ring_number, ring in enumerate(self.outer):
            starts = self.coverage.starts[ring].tolist()
            for at, point in enumerate(starts):
                if point in ending and point not in self.positions:
                    walls = [wall for one in ending[point] for wall in one]
                    self.positions[point] = self._on_ring(ring_number, at, walls)
        for point, walls in ending.items():
            if point not in self.positions:
                raw = self.coverage.tracing.xy[point]
                self.positions[point] = (None, _meeting_place(raw, [w for one in walls for w in one], self.tolerance))
        for arc in self.arcs.values():
            self._place_arc(arc)

    def _on_ring(self, number: int, at: int, walls: list) -> tuple:
        """Return where a border that ends before half-edge ``at`` of an outer ring meets it: segment, share; place."""
        if self.is_bare:
            return at, 0.0, self.coverage.tracing.xy[self.coverage.starts[self.outer[number][at]]]
        samples, ring = self.lines[number].samples, self.rings[number]
        raw = (samples[at - 1] + samples[at]) / 2
        if self.manner.is_traced:
            return (at - 1) % len(samples), 0.5, raw
        return _hit(ring, raw, walls, self.limit)

    def _place_arc(self, arc: _Arc) -> None:
        """Put together the places of a border from one end to the other."""
        xy, starts = self.coverage.tracing.xy, self.coverage.starts[arc.edges]
        if self.is_bare:
            places = xy[starts] if arc.is_closed else xy[np.append(starts, arc.ends[1])]
        else:
            samples, length = self._samples(arc.edges)
            raw = traced = self._between(arc, samples)
            if not self.manner.is_traced:
                traced = raw[simplify(raw, self.tolerance / 2, arc.is_closed)]
            places = self._between(arc, np.array(arc.corners).reshape(-1, 2))
            weights = length if arc.is_closed else np.concatenate([[0.0], length, [0.0]])
            arc.is_straight &= is_near(places, Line(raw, weights, arc.is_closed), self.limit)
            places = places if arc.is_straight else traced
        arc.places = places

    def _between(self, arc: _Arc, places: np.ndarray) -> np.ndarray:
        if arc.is_closed:
            return places
        first, last = (self.positions[end][-1] for end in arc.ends)
        return np.concatenate([first[None], places, last[None]])

    def closed(self, face: int, ring: np.ndarray) -> Optional[np.ndarray]:
        """Return a ring of half-edges of a face as a closed ring of places, None where its pieces don't fit."""
        parts = []
        for edges, is_closed in self._runs(ring):
            if self.coverage.across[edges[0]] < 0:
                part = self._outer_part(face, edges, is_closed)
            else:
                part = self._inner_part(face, edges, is_closed)
            if part is None:
                return None
            parts.append(part if is_closed else part[:-1])
        places = np.concatenate(parts)
        return np.concatenate([places, places[:1]])

    def _outer_part(self, face: int, edges: np.ndarray, is_closed: bool) -> Optional[np.ndarray]:
        number, at = self.place_of_edge[int(edges[0])]
        if not self.is_straight[number]:
            self.traced_faces.add(face)
        xy, starts = self.coverage.tracing.xy, self.coverage.starts
        if self.is_bare:
            return xy[starts[edges]] if is_closed else xy[np.append(starts[edges], self.coverage.ends[edges[-1]])]
        ring = self.rings[number]
        if is_closed:
            return ring
        ends = int(starts[edges[0]]), int(self.coverage.ends[edges[-1]])
        first, last = (self.positions[end] for end in ends)
        if len(first) < 3 or len(last) < 3 or self.place_of_edge[int(edges[-1])][0] != number:
            return None
        count = len(ring)
        ahead = (last[0] + last[1] - first[0] - first[1]) % count if ends[0] != ends[1] else count
        corners = [(first[0] + 1 + k) % count for k in range(int(np.floor(first[1] + ahead - 1e-9)))]
        return np.concatenate([first[2][None], ring[corners].reshape(-1, 2), last[2][None]])

    def _inner_part(self, face: int, edges: np.ndarray, is_closed: bool) -> Optional[np.ndarray]:
        """Return the places of a border between buildings, seen from one of them."""
        is_first = self.coverage.across[edges[0]] > face
        if not is_first:
            edges = _twins(self.coverage.tracing, edges)[::-1]
        arc = self.arcs.get(int(edges.min() if is_closed else edges[0]))
        if arc is None or arc.places is None:
            return None
        if not arc.is_straight:
            self.traced_faces.add(face)
        return arc.places if is_first else arc.places[::-1]


def _groups(tracing: Tracing) -> np.ndarray:
    """Return the group of each triangle: faces that share edges; -1 outside."""
    piece = pieces_of((tracing.face >= 0).astype(np.int64), tracing.neighbors)
    numbers = np.full(piece.max() + 1, -1)
    inside = np.unique(piece[tracing.face >= 0])
    numbers[inside] = np.arange(len(inside))
    return numbers[piece]


def _twins(tracing: Tracing, edges: np.ndarray) -> np.ndarray:
    """Return the half-edges on the other side of half-edges."""
    triangle, side = np.divmod(edges, 3)
    other = tracing.neighbors[triangle, side]
    return 3 * other + np.argmax(tracing.neighbors[other] == triangle[:, None], axis=1)


def _ordered(rings: list) -> Optional[list]:
    """Return the rings of a polygon, exterior first, None unless there is just one."""
    if any(ring is None or len(ring) < 4 for ring in rings):
        return None
    rings = sorted(rings, key=signed_area, reverse=True)
    areas = [signed_area(ring) for ring in rings]
    return rings if areas[0] > 0 and all(area < 0 for area in areas[1:]) else None


def _hit(ring: np.ndarray, raw: np.ndarray, walls: list[Wall], limit: float) -> tuple:
    """Return where the longest wall meets an open ring near a place, or the place on the ring that is nearest to it."""
    starts, ends = ring, np.roll(ring, -1, axis=0)
    along = ends - starts
    square = np.maximum((along**2).sum(axis=1), 1e-30)
    share = np.clip(((raw - starts) * along).sum(axis=1) / square, 0, 1)
    places = starts + share[:, None] * along
    away = np.hypot(*(places - raw).T)
    nearest = int(np.argmin(away))
    if walls:
        wall = max(walls, key=lambda one: one.length)
        start_offset = wall.direction[0] * (starts - wall.point)[:, 1] - wall.direction[1] * (starts - wall.point)[:, 0]
        end_offset = np.roll(start_offset, -1)
        crosses = np.flatnonzero((start_offset > 0) != (end_offset > 0))
        part = start_offset[crosses] / (start_offset[crosses] - end_offset[crosses])
        hits = starts[crosses] + part[:, None] * along[crosses]
        distance = np.hypot(*(hits - raw).T)
        # Where the ring steps along that wall, a little to one side of it, it is met at the wrong end of the step.
        if len(crosses) and distance.min() <= min(limit, away[nearest] + limit / 2):
            best = int(np.argmin(distance))
            return int(crosses[best]), float(part[best]), hits[best]
    return nearest, float(share[nearest]), places[nearest]


def _meeting_place(raw: np.ndarray, walls: list[Wall], limit: float) -> np.ndarray:
    """Return the place nearest to all walls that end at a node, ``raw`` where that is far off."""
    # A weak pull to the traced node settles what parallel walls leave open.
    matrix: list = [0.1 * np.eye(2)]
    right: list = [0.1 * raw]
    for wall in walls:
        normal = np.array([-wall.direction[1], wall.direction[0]])
        matrix.append(normal[None])
        right.append([normal @ wall.point])
    place = np.linalg.lstsq(np.concatenate(matrix), np.concatenate(right), rcond=None)[0]
    return place if np.hypot(*(place - raw)) <= limit else raw
