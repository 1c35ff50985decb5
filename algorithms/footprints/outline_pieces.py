"""Pieces of buildings on the lattice: areas where each building has the largest share, with the rings around them."""

from dataclasses import dataclass

import numpy as np

from ..geometry.grid import plan_box
from ..geometry.groups import components, split_groups
from ..geometry.level_lines import level_lines
from ..geometry.polygon_overlap import in_squares, meeting_boxes
from ..geometry.ring_directions import N_STEPS, RingPieces, direction_weights, main_directions, weights_of_pieces
from ..geometry.rings import is_inside, perimeter, signed_area
from ..packages import spatial
from .soft_shares import Shares, find_shares

# Fewest samples of a ring.
_FEWEST = 12

# Pieces closer than this (spacings) are drawn together, since edges move by up to two spacings.
_TOGETHER = 4.0

# Distance (m) up to which the walls of neighbors count for directions: across a street.
NEIGHBORS = 30.0

# Weight of all neighbors together, as a share of the building's own: a shed has the directions of the houses
# around, and a house that is turned against them has its own.
_INFLUENCE = 0.5


@dataclass(frozen=True)
class OutlinePiece:
    """A connected part of a building."""

    building: int  #: Its number
    #: Samples (n, 2) at equal steps (m) along its rings, the exterior first, the first of each not repeated
    rings: list[np.ndarray]


def find_pieces(building: int, shares: Shares, spacing: float, min_area: float, min_hole: float) -> list[OutlinePiece]:
    """Return the pieces of a building that may reach ``min_area`` (m²), with their holes of ``min_hole`` (m²).

    Parameters
    ----------
    building : int
        Number of the building.
    shares : Shares
        Shares of the buildings on a lattice.
    spacing : float
        Point spacing, m.
    min_area : float
        Smallest area of a polygon, m².
    min_hole : float
        Smallest hole, m².
    """
    rings = [shares.lattice.in_plan(ring) for ring in level_lines(shares.share - shares.rest)]
    sizes = [signed_area(ring) for ring in rings]
    holes = [ring for ring, size in zip(rings, sizes) if -size >= min_hole]
    pieces = []
    for ring, size in zip(rings, sizes):
        # A ring is rounded at corners; whether a small building is large enough is decided on its polygon.
        if size >= min_area / 2:
            own = [hole for hole in holes if is_inside(hole[0], ring)]
            pieces.append(OutlinePiece(building, [sampled(one, spacing) for one in [ring, *own]]))
    return pieces


def pieces_alone(roof: np.ndarray, spacing: float, least_area: float) -> tuple[Shares, list[OutlinePiece], np.ndarray]:
    """Return the shares, the pieces and the main directions (k,), °, of one building with the roof points (n, 2), m.

    ``least_area`` (m²) is the least area of its pieces and holes.
    """
    one = np.ones(len(roof), np.int64)
    shares = find_shares(roof, one.astype(float), one, np.zeros((0, 2)), np.zeros(0), spacing)[1]
    pieces = find_pieces(1, shares, spacing, least_area, least_area)
    rings = [ring for piece in pieces for ring in piece.rings]
    weights = np.sum([direction_weights(ring) for ring in rings], axis=0)
    return shares, pieces, main_directions(weights, weights, sum(map(len, rings))) if rings else np.zeros(0)


def sampled(ring: np.ndarray, step: float) -> np.ndarray:
    """Return positions (n, 2) at equal steps of about ``step`` (m) along a closed ring."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(ring, axis=0).T))])
    count = max(_FEWEST, round(perimeter(ring) / step))
    wanted = along[-1] * np.arange(count) / count
    return np.column_stack([np.interp(wanted, along, ring[:, axis]) for axis in (0, 1)])


def blocks_of(pieces: list[OutlinePiece], spacing: float) -> list[list[OutlinePiece]]:
    """Return the pieces in blocks that lie apart."""
    if not pieces:
        return []
    samples = np.concatenate([ring for piece in pieces for ring in piece.rings])
    of_piece = np.repeat(np.arange(len(pieces)), [sum(map(len, piece.rings)) for piece in pieces])
    near = of_piece[spatial.cKDTree(samples).query_pairs(_TOGETHER * spacing, output_type="ndarray")]
    count, block = components(near[:, 0], near[:, 1], len(pieces))
    return [[pieces[i] for i in rows] for rows in split_groups(block, count)]


def shared_directions(rings: list[list[np.ndarray]], side: float = 500.0) -> list[np.ndarray]:
    """Return the main directions (k,), °, of buildings, by samples along the rings of each.

    The walls of other buildings around count, the nearer the more. Memory: the buildings of a
    square with ``side`` (m), since pieces of a ring take hundreds of times its vertices.
    """
    boxes = np.array([plan_box(np.concatenate(own)) for own in rings]).reshape(-1, 2, 2)
    directions = dict[int, np.ndarray]()
    for own, near, _ in in_squares(boxes, NEIGHBORS, side):
        is_own = np.isin(near, own)
        found = _directions_near([rings[row] for row in near], boxes[near])
        directions.update({row: found[at] for at, row in zip(np.flatnonzero(is_own).tolist(), near[is_own].tolist())})
    return [directions[row] for row in range(len(rings))]


def _directions_near(rings: list[list[np.ndarray]], boxes: np.ndarray) -> list[np.ndarray]:
    """Return the main directions of buildings that are looked at together; ``boxes`` (n, 2, 2) are theirs, m."""
    pieces = [list(map(RingPieces, own)) for own in rings]
    weights = [sum(weights_of_pieces(own, [None] * len(own))) for own in pieces]
    one, other = meeting_boxes(boxes + np.array([[-NEIGHBORS], [NEIGHBORS]]), boxes)
    around = []
    for number, rows in enumerate(split_groups(one, len(rings))):
        neighbors = [(each, row) for each in other[rows].tolist() if each != number for row in range(len(rings[each]))]
        # Ignore walls farther away, even of the same neighbor: a block's window may lack them.
        low, high = boxes[number]
        off = (np.maximum(low - rings[each][row], rings[each][row] - high).clip(0.0) for each, row in neighbors)
        counts = [np.maximum(1 - np.hypot(*distance.T) / NEIGHBORS, 0.0) for distance in off]
        around.append(sum(weights_of_pieces([pieces[each][row] for each, row in neighbors], counts), np.zeros(N_STEPS)))
    together = [own + _INFLUENCE * own.sum() * other / (other.sum() or 1.0) for own, other in zip(weights, around)]
    counts = [sum(map(len, own)) for own in rings]
    return [main_directions(*each) for each in zip(together, weights, counts)]
