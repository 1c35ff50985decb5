"""Pieces of buildings on the lattice: what each building has more of than anything else, with the rings around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.groups import components
from ..geometry.level_lines import level_lines
from ..geometry.line_segments import is_inside
from ..geometry.ring_directions import direction_weights, main_directions
from ..geometry.rings import perimeter, signed_area
from ..packages import spatial
from .soft_shares import Shares, find_shares

# Fewest samples of a ring.
_FEWEST = 12

# Pieces closer than this (spacings) are drawn together, since edges move by up to two spacings.
_TOGETHER = 4.0


@dataclass(frozen=True)
class Piece:
    """A connected part of a building."""

    building: int  #: Its number
    #: Samples (n, 2) at equal steps (m) along its rings, the exterior first, the first of each not repeated
    rings: list[np.ndarray]


def find_pieces(building: int, shares: Shares, spacing: float, min_area: float, min_hole_area: float) -> list[Piece]:
    """Return the pieces of a building that may reach ``min_area`` (m²), with their holes of ``min_hole_area`` (m²).

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
    min_hole_area : float
        Smallest hole, m².
    """
    rings = [shares.lattice.in_plan(ring) for ring in level_lines(shares.share - shares.rest)]
    sizes = [signed_area(ring) for ring in rings]
    holes = [ring for ring, size in zip(rings, sizes) if -size >= min_hole_area]
    pieces = []
    for ring, size in zip(rings, sizes):
        # A ring is rounded at corners; whether a small building is large enough is decided on its polygon.
        if size >= min_area / 2:
            own = [hole for hole in holes if is_inside(hole[0], ring)]
            pieces.append(Piece(building, [sampled(one, spacing) for one in [ring, *own]]))
    return pieces


def pieces_alone(roof: np.ndarray, spacing: float, least_area: float) -> tuple[Shares, list[Piece], np.ndarray]:
    """Return the shares, the pieces and the main directions (k,), °, of one building with the roof points (n, 2), m.

    ``least_area`` (m²) is that of its pieces and holes.
    """
    shares = find_shares(roof, np.ones(len(roof)), np.ones(len(roof), np.int64), np.zeros((0, 2)), spacing)[1]
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


def blocks_of(pieces: list[Piece], spacing: float) -> list[list[Piece]]:
    """Return the pieces in blocks that lie apart."""
    if not pieces:
        return []
    samples = np.concatenate([ring for piece in pieces for ring in piece.rings])
    of_piece = np.repeat(np.arange(len(pieces)), [sum(map(len, piece.rings)) for piece in pieces])
    near = of_piece[spatial.cKDTree(samples).query_pairs(_TOGETHER * spacing, output_type="ndarray")]
    count, block = components(near[:, 0], near[:, 1], len(pieces))
    return [[pieces[i] for i in np.flatnonzero(block == number)] for number in range(count)]
