"""Footprints whose walls are those that were seen from the street, and the outlines from the air elsewhere."""

from dataclasses import dataclass

import numpy as np

from ..geometry.rings import is_valid, perimeter
from ..rules import rules
from ..stage import LayerFeatures
from .facade_outline import ring_of_lines
from .plan_segments import PlanSegments, exterior


@rules
class _RULES:
    """Rules for assigning walls to footprints and joining both."""

    # A wall is of the footprint within this distance (m): eaves jut out up to 1 m, recesses are 1 to 2 m deep.
    reach: float = 1.6
    # Ends of two walls within this distance (m) are one corner, and so are the ends of a wall and of a footprint.
    corner: float = 0.3
    # Walls and edges run the same way within this angle (sine: 20°).
    same_way: float = 0.34
    # An edge at most this far (m) before or behind a wall shows the same wall, such as by its eaves, and moves onto it.
    eaves: float = 0.5
    # Walls of one footprint with less than this along it between them (m) are joined: a tree or a car hides as much.
    gap: float = 3.0
    # Successive walls offset by less than this (m) need no step between them.
    step: float = 0.1
    # A row of walls that overlaps a longer one by more than this share lies before or behind it, as balconies do.
    shared: float = 0.3
    # Distance (m) of the positions at which walls are compared with footprints: less than an outline is off.
    sample: float = 0.25
    # Shortest row of walls (m) that is taken: shorter ones are of porches and pillars.
    shortest: float = 1.0


# An edge of a ring: a point (2,) and the way (2,) of its line, and where it began before (2,), m.
_Line = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class _Piece:
    """Walls in a row on one footprint: their corners (m, 2), and positions (m) along its ring of first and last one."""

    corners: np.ndarray
    first: float
    last: float


class _Ring:
    """A closed counterclockwise ring (m, 2) and positions along it (m)."""

    def __init__(self, ring: np.ndarray) -> None:
        self.corners = ring[:-1]
        self.way = np.diff(ring, axis=0)
        self.length = np.hypot(*self.way.T)
        self.way = self.way / self.length[:, None]
        self.start = np.concatenate([[0.0], np.cumsum(self.length)])

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return distance (n,) of points (n, 2) from the ring and the position (n,) along it that is nearest, m."""
        offset = points[:, None] - self.corners
        along = np.clip(np.einsum("ijk,jk->ij", offset, self.way), 0, self.length)
        off = np.linalg.norm(offset - along[..., None] * self.way, axis=2)
        edge = off.argmin(axis=1)
        rows = np.arange(len(points))
        return off[rows, edge], self.start[edge] + along[rows, edge]

    def edge(self, position: float) -> int:
        """Return the edge on which a position lies."""
        return min(int(np.searchsorted(self.start, position, side="right")) - 1, len(self.way) - 1)

    def between(self, first: float, last: float) -> float:
        """Return the way (m) along the ring from one position to another."""
        return float((last - first) % self.start[-1])


def fitted_to_walls(footprints: LayerFeatures, walls: PlanSegments) -> tuple[LayerFeatures, np.ndarray]:
    """Return footprints with their exterior on the walls that were seen, and which share (n,) of each was seen.

    Attributes and holes are kept, and a footprint that would cross itself stays as it is.
    """
    outlines = [exterior(rings) for rings in footprints.geometries]
    pieces = _pieces(_chains(walls), [_Ring(ring) for ring in outlines])
    geometries, seen = [], np.zeros(len(outlines))
    for number, (rings, outline) in enumerate(zip(footprints.geometries, outlines)):
        ring = _joined(_Ring(outline), pieces[number]) if pieces[number] else outline
        holes = [np.asarray(hole, float)[:, :2] for hole in rings[1:]]
        if pieces[number] and is_valid([ring, *holes]):
            seen[number] = min(1.0, sum(perimeter(piece.corners) for piece in pieces[number]) / perimeter(ring))
        else:
            ring = outline
        geometries.append([ring, *holes])
    return LayerFeatures(geometries, dict(footprints.columns)), seen


def _chains(walls: PlanSegments) -> list[np.ndarray]:
    """Return the corners (m, 2) of walls in a row, each of which ends where the next begins."""
    gap = np.linalg.norm(walls.end[:, None] - walls.start, axis=2)
    np.fill_diagonal(gap, np.inf)
    after: dict[int, int] = {}
    for one, other in zip(*np.unravel_index(np.argsort(gap, axis=None), gap.shape)):
        if gap[one, other] > _RULES.corner:
            break
        if one not in after and other not in after.values() and not _closes(after, int(one), int(other)):
            after[int(one)] = int(other)
    chains = []
    for first in sorted(set(range(len(walls))) - set(after.values())):
        corners, wall = [walls.start[first]], first
        while wall in after:
            corners.append((walls.end[wall] + walls.start[after[wall]]) / 2)
            wall = after[wall]
        chains.append(np.array([*corners, walls.end[wall]]))
    return chains


def _closes(after: dict[int, int], one: int, other: int) -> bool:
    """Return whether a wall is the last of the row that begins with another one."""
    while other in after:
        other = after[other]
    return other == one


def _pieces(chains: list[np.ndarray], rings: list[_Ring]) -> list[list[_Piece]]:
    """Return the parts of chains that lie along each ring, in their order along it."""
    pieces: list[list[_Piece]] = [[] for _ in rings]
    for chain in chains if rings else []:
        samples, is_corner = _sampled(chain)
        found = [ring.nearest(samples) for ring in rings]
        distance = np.array([off for off, _ in found])
        owner = np.where(distance.min(axis=0) <= _RULES.reach, distance.argmin(axis=0), -1)
        ends = np.flatnonzero(np.diff(owner)) + 1
        for run in np.split(np.arange(len(samples)), ends):
            number = int(owner[run[0]])
            if number < 0:
                continue
            corners = samples[run][is_corner[run] | (np.arange(len(run)) % (len(run) - 1 or 1) == 0)]
            first, last = rings[number].nearest(corners[[0, -1]])[1]
            length = perimeter(corners)
            # Walls that run against the ring are of a yard or of another building.
            if length >= _RULES.shortest and rings[number].between(first, last) <= 2 * length + _RULES.gap:
                pieces[number].append(_Piece(corners, float(first), float(last)))
    return [_apart(some, ring) for some, ring in zip(pieces, rings)]


def _apart(pieces: list[_Piece], ring: _Ring) -> list[_Piece]:
    """Return pieces in their order along a ring, without those that are next to longer ones, as balconies are."""
    kept: list[_Piece] = []
    for piece in sorted(pieces, key=lambda piece: -ring.between(piece.first, piece.last)):
        length = ring.between(piece.first, piece.last)
        if all(_overlap(piece, other, ring) <= _RULES.shared * length for other in kept):
            kept.append(piece)
    return sorted(kept, key=lambda piece: piece.first)


def _overlap(one: _Piece, other: _Piece, ring: _Ring) -> float:
    """Return the way (m) along a ring that two pieces share."""
    size, start = ring.between(one.first, one.last), ring.between(one.first, other.first)
    length = ring.between(other.first, other.last)
    ahead = max(0.0, min(size, start + length) - start)
    # The other one begins before and comes around.
    return ahead + max(0.0, min(size, start + length - float(ring.start[-1])))


def _sampled(chain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (n, 2) along a chain, its corners among them, and which (n,) are corners."""
    samples, is_corner = [], []
    for start, end in zip(chain[:-1], chain[1:]):
        count = max(1, int(np.hypot(*(end - start)) / _RULES.sample))
        samples.append(start + np.arange(count)[:, None] / count * (end - start))
        is_corner.append(np.arange(count) == 0)
    return np.concatenate([*samples, chain[-1:]]), np.concatenate([*is_corner, [True]])


def _joined(ring: _Ring, pieces: list[_Piece]) -> np.ndarray:
    """Return the closed ring of walls and of the edges between them."""
    lines: list[_Line] = []
    for number, piece in enumerate(pieces):
        following = pieces[(number + 1) % len(pieces)]
        lines += [(start, _unit(end - start), start) for start, end in zip(piece.corners[:-1], piece.corners[1:])]
        gap = ring.between(piece.last, following.first)
        is_only = len(pieces) == 1
        is_same_edge = ring.edge(piece.last) == ring.edge(following.first) and following.first >= piece.last
        is_overlap = ring.between(following.first, piece.last) <= _RULES.gap
        if not is_only and (gap <= _RULES.gap or is_same_edge or is_overlap):
            lines += _step(piece.corners, following.corners)
        else:
            lines += _edges(ring, piece, following)
    return ring_of_lines(*(np.array(part) for part in zip(*lines)))


def _step(one: np.ndarray, other: np.ndarray) -> list[_Line]:
    """Return the line of the step between two rows of walls that follow each other, none where they meet or go on.

    Of two parallel walls the outer one hides the end of the inner one: the step is at the end of the outer one.
    """
    way, following = _unit(one[-1] - one[-2]), _unit(other[1] - other[0])
    outward = np.array([way[1], -way[0]])
    off = float((other[0] - one[-1]) @ outward)
    if abs(_cross(way, following)) >= _RULES.same_way or abs(off) <= _RULES.step:
        return []
    return [(other[0] if off > 0 else one[-1], outward * np.sign(off), one[-1])]


def _edges(ring: _Ring, piece: _Piece, following: _Piece) -> list[_Line]:
    """Return the lines of the outline from the end of a row of walls to the start of the next one."""
    count = len(ring.way)
    first, last = ring.edge(piece.last), ring.edge(following.first)
    n_between = (last - first) % count
    if n_between == 0 and (following.first < piece.last or piece is following):
        n_between = count
    edges = [(first + k) % count for k in range(n_between + 1)]
    points = {k: ring.corners[edge] for k, edge in enumerate(edges)}
    ends = (
        (0, 1, piece.corners[-1], _unit(piece.corners[-1] - piece.corners[-2])),
        (len(edges) - 1, len(edges) - 2, following.corners[0], _unit(following.corners[1] - following.corners[0])),
    )
    steps: dict[int, list[_Line]] = {}
    for own, beside, end, way in ends:
        edge_way = ring.way[edges[own]]
        if abs(_cross(way, edge_way)) >= _RULES.same_way or way @ edge_way < 0:
            continue
        outward = np.array([way[1], -way[0]])
        off = float((points[own] - end) @ outward)
        if abs(off) > _RULES.eaves:
            steps[own] = [(end, outward * np.sign(off) * (1 if own == 0 else -1), end)]
            continue
        # The wall takes the place of the edge; the edge next to it passes through the end of the wall if that is
        # the corner.
        del points[own]
        if beside in points and _ends_at(end, way if own == 0 else -way, points[beside], ring.way[edges[beside]]):
            points[beside] = end
    kept = [(points[k], ring.way[edge], ring.corners[edge]) for k, edge in enumerate(edges) if k in points]
    return [*steps.pop(0, []), *kept, *steps.pop(len(edges) - 1, [])]


def _ends_at(end: np.ndarray, way: np.ndarray, point: np.ndarray, edge_way: np.ndarray) -> bool:
    """Return whether a wall that runs a way (2,) to its end (2,) ends at an edge through a point (2,)."""
    turn = _cross(way, edge_way)
    if abs(turn) < _RULES.same_way:
        return False
    distance = _cross(point - end, edge_way) / turn
    return bool(abs(distance) <= _RULES.corner)


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.hypot(*vector)


def _cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
