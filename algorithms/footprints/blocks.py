"""Blocks: buildings that touch, and the borders between them, as half-edges of the triangulation that traced them.

Every border is kept once, as seen from the building with the lower number, so that both buildings get the same line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.polylines import Line
from .alpha_shape import Tracing, pieces_of

# Half-edges that start or end at a point along a border: two edges meet there, each with a half-edge on either side.
# At a junction there are more, or fewer.
_HALF_EDGES_ALONG = 4


@dataclass(frozen=True)
class HalfEdges:
    """The half-edges of a triangulation, by number.

    Attributes
    ----------
    xy : ndarray of shape (n, 2), float64
        The points (m).
    starts, ends : ndarray of shape (e,), int
        Point that each half-edge starts from, and that it leads to.
    twins : ndarray of shape (e,), int64
        The half-edge on the other side of each, -1 at the rim of the triangulation.
    outset : ndarray of shape (e,), float64
        Distance (m) from each half-edge outward to the edge of the roof.
    """

    xy: np.ndarray
    starts: np.ndarray
    ends: np.ndarray
    twins: np.ndarray
    outset: np.ndarray

    def samples(self, half_edges: np.ndarray, outset: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the positions (m, 2) where the building ends beyond its half-edges, and their lengths (m,).

        ``outset`` is the share of the distances outward that counts, 0 to 1.
        """
        start, end = self.xy[self.starts[half_edges]], self.xy[self.ends[half_edges]]
        step = end - start
        length = np.hypot(*step.T)
        outward = np.column_stack([step[:, 1], -step[:, 0]]) / length[:, None]
        return (start + end) / 2 + outset * self.outset[half_edges, None] * outward, length

    def points(self, half_edges: np.ndarray, is_closed: bool) -> np.ndarray:
        """Return the positions (m, 2) of the points along consecutive half-edges; of open ones with the last end."""
        points = self.starts[half_edges]
        return self.xy[points if is_closed else np.append(points, self.ends[half_edges[-1]])]


@dataclass(frozen=True)
class Border:
    """The border between two buildings of a block, from junction to junction or closed.

    Attributes
    ----------
    half_edges : ndarray of shape (k,), int64
        Half-edges of the building with the lower number, in order; of a closed border the lowest first.
    is_closed : bool
        Whether it has no junction: the one building lies within the other.
    ends : tuple of int
        Points that it leads from and to.
    """

    half_edges: np.ndarray
    is_closed: bool
    ends: tuple[int, int]


@dataclass(frozen=True)
class Junction:
    """A point where borders end.

    Attributes
    ----------
    point : int
        Number of the point.
    ring : int, optional
        Ring around the block on which it lies; None inside of the block.
    at : int
        Position in that ring of the half-edge that starts here.
    """

    point: int
    ring: Optional[int] = None
    at: int = -1


@dataclass(frozen=True)
class Piece:
    """A part of the outline of one building, from junction to junction or closed.

    Attributes
    ----------
    half_edges : ndarray of shape (k,), int64
        Its half-edges in order, the building on their left.
    is_closed : bool
        Whether it is a whole ring.
    ends : tuple of int
        Points that it leads from and to.
    ring : int, optional
        Ring around the block that it is a part of.
    border : int, optional
        Border of the block that it runs along. Where this and the ring are None, it has no line of its own.
    is_reversed : bool
        Whether it runs against the direction of that border.
    """

    half_edges: np.ndarray
    is_closed: bool
    ends: tuple[int, int]
    ring: Optional[int] = None
    border: Optional[int] = None
    is_reversed: bool = False


@dataclass(frozen=True)
class Block:
    """Buildings that touch.

    Attributes
    ----------
    mesh : HalfEdges
        Half-edges and points by number.
    rings : tuple of ndarray
        Half-edges of the rings around the block, in order.
    borders : tuple of Border
        Borders between its buildings.
    junctions : tuple of Junction
        Points where these end.
    outlines : dict of int to list of list of Piece
        For each building (a face of the tracing) its rings, piece by piece.
    """

    mesh: HalfEdges
    rings: tuple[np.ndarray, ...]
    borders: tuple[Border, ...]
    junctions: tuple[Junction, ...]
    outlines: dict[int, list[list[Piece]]]

    def ring_lines(self, outset: float = 1.0) -> list[Line]:
        """Return the traced rings around the block, with a share of the outset."""
        return [Line(*self.mesh.samples(ring, outset), is_closed=True) for ring in self.rings]


def split_blocks(tracing: Tracing) -> list[Block]:
    """Split the outlines of a tracing into pieces: rings around blocks, and borders between two buildings of a block.

    Parameters
    ----------
    tracing : Tracing
        Faces of buildings.

    Returns
    -------
    list of Block
        Every face belongs to one.
    """
    mesh = HalfEdges(tracing.xy, tracing.starts, tracing.ends, _twins(tracing.neighbors), tracing.outset)
    block_of_triangle = _blocks(tracing)
    across = tracing.beyond(tracing.face)
    is_junction = _starts_at_junction(tracing.face, block_of_triangle, across, mesh)
    count = int(block_of_triangle.max(initial=-1)) + 1
    faces: list[list[tuple[int, np.ndarray]]] = [[] for _ in range(count)]
    rings: list[list[np.ndarray]] = [[] for _ in range(count)]
    for face, ring in tracing.rings(tracing.face):
        faces[block_of_triangle[ring[0] // 3]].append((face, ring))
    for block, ring in tracing.rings(block_of_triangle):
        rings[block].append(ring)
    return [_block(mesh, across, is_junction, *of_block) for of_block in zip(faces, rings)]


def _blocks(tracing: Tracing) -> np.ndarray:
    """Return the block (t,) of each triangle: faces that share edges; -1 outside."""
    piece = pieces_of((tracing.face >= 0).astype(np.int64), tracing.neighbors)
    numbers = np.full(piece.max() + 1, -1)
    inside = np.unique(piece[tracing.face >= 0])
    numbers[inside] = np.arange(len(inside))
    return numbers[piece]


def _twins(neighbors: np.ndarray) -> np.ndarray:
    """Return the half-edge (3 t,) on the other side of each, -1 at the rim."""
    triangle = np.arange(len(neighbors))
    twins = np.full(neighbors.shape, -1, np.int64)
    for side in range(3):
        other = neighbors[:, side]
        twins[:, side] = np.where(other >= 0, 3 * other + np.argmax(neighbors[other] == triangle[:, None], axis=1), -1)
    return twins.ravel()


def _starts_at_junction(
    face: np.ndarray, block_of_triangle: np.ndarray, across: np.ndarray, mesh: HalfEdges
) -> np.ndarray:
    """Return which half-edges (3 t,) of borders and outlines start at a junction of their block.

    Where two blocks touch in a point, it may be a junction of the one and not of the other.
    """
    face, block = np.repeat(face, 3), np.repeat(block_of_triangle, 3)
    border = np.flatnonzero((face >= 0) & (face != across))
    is_inner, count = across[border] >= 0, len(mesh.xy)
    starts, ends = (block[border] * count + points[border] for points in (mesh.starts, mesh.ends))
    position, inverse = np.unique(np.concatenate([starts, ends]), return_inverse=True)
    # Each border between two buildings has two half-edges, any other one.
    degree = np.bincount(inverse, np.tile(np.where(is_inner, 1, 2), 2), len(position))
    junctions = position[np.isin(position, starts[is_inner]) & (degree != _HALF_EDGES_ALONG)]
    is_junction = np.zeros(len(across), bool)
    is_junction[border] = np.isin(starts, junctions)
    return is_junction


def _block(
    mesh: HalfEdges,
    across: np.ndarray,
    is_junction: np.ndarray,
    faces: list[tuple[int, np.ndarray]],
    rings: list[np.ndarray],
) -> Block:
    """Return the block of some faces, given by number and ring, within the rings around all of them."""
    runs = [(face, [*_runs(ring, is_junction, mesh)]) for face, ring in faces]
    borders = _borders([(face, run) for face, of_ring in runs for run in of_ring], across)
    number_of_border = {int(border.half_edges[0]): number for number, border in enumerate(borders)}
    ring_of_edge = {edge: number for number, ring in enumerate(rings) for edge in ring.tolist()}
    outlines: dict[int, list[list[Piece]]] = {face: [] for face in sorted({face for face, _ in faces})}
    for face, of_ring in runs:
        pieces = []
        for run in of_ring:
            other = across[run.half_edges[0]]
            if other < 0:
                pieces.append(_on_ring(run, ring_of_edge))
            else:
                pieces.append(_on_border(run, number_of_border, mesh.twins, is_reversed=bool(other < face)))
        outlines[face].append(pieces)
    return Block(mesh, tuple(rings), tuple(borders), _junctions(borders, rings, mesh), outlines)


def _runs(ring: np.ndarray, is_junction: np.ndarray, mesh: HalfEdges) -> list[Piece]:
    """Return the pieces of a ring of half-edges from junction to junction."""
    first = np.flatnonzero(is_junction[ring])
    runs = np.split(np.roll(ring, -first[0]), first[1:] - first[0]) if len(first) else [ring]
    ends = [(int(mesh.starts[run[0]]), int(mesh.ends[run[-1]])) for run in runs]
    return [Piece(run, not len(first), end) for run, end in zip(runs, ends)]


def _borders(runs: list[tuple[int, Piece]], across: np.ndarray) -> list[Border]:
    """Return the borders among the pieces of faces: those beyond which there is a face of a higher number."""
    borders = []
    for face, run in runs:
        if across[run.half_edges[0]] > face:
            turned = np.roll(run.half_edges, -int(np.argmin(run.half_edges)))
            borders.append(Border(turned if run.is_closed else run.half_edges, run.is_closed, run.ends))
    return borders


def _on_ring(run: Piece, ring_of_edge: dict[int, int]) -> Piece:
    """Return the piece with the ring around the block that it is a part of, if it is a part of one only."""
    first, last = (ring_of_edge[int(run.half_edges[end])] for end in (0, -1))
    return Piece(run.half_edges, run.is_closed, run.ends, ring=first if first == last else None)


def _on_border(run: Piece, number_of_border: dict[int, int], twins: np.ndarray, is_reversed: bool) -> Piece:
    """Return the piece with the border that it runs along, if there is one that begins where it does."""
    own = twins[run.half_edges][::-1] if is_reversed else run.half_edges
    border = number_of_border.get(int(own.min() if run.is_closed else own[0]))
    return Piece(run.half_edges, run.is_closed, run.ends, border=border, is_reversed=is_reversed)


def _junctions(borders: list[Border], rings: list[np.ndarray], mesh: HalfEdges) -> tuple[Junction, ...]:
    """Return the ends of borders, each with the first ring that leads through it."""
    ends = {end: Junction(end) for border in borders if not border.is_closed for end in border.ends}
    for number, ring in enumerate(rings):
        for at, point in enumerate(mesh.starts[ring].tolist()):
            if point in ends and ends[point].ring is None:
                ends[point] = Junction(point, number, at)
    return tuple(ends.values())
