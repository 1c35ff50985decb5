"""The boundary of a facade in its plane: an alpha shape, reduced to corners, and pushed out to hold all points."""

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..criteria import PARALLEL, ROUNDING
from ..footprints.outline_pieces import sampled
from ..geometry.groups import components, least_of, mask_of, members, placed
from ..geometry.ring_directions import direction_weights, main_directions
from ..geometry.ring_drawing import Prices, draw_ring
from ..geometry.rings import are_inside, edge_distances, is_valid, nearest_edge_distances, rings_of_edges, signed_area
from ..packages import spatial

# The angle (°) between the edges at a boundary point below which it is no key point, in the first round (paper, section
# 3.3, step 3).
_FIRST_ANGLE = 10.0

# Rounds that follow, in each of which that angle is one degree larger (paper, the same step).
_ROUNDS = 30

# Longest edge of a triangle for key points (spacings), from the paper (section 3.3, step 2).
_PUBLISHED_EDGE = 1.5

# Longest edge of a triangle for straight edges (spacings): evenly scattered points then leave no gaps by chance.
_LONGEST_EDGE = 4.0

# Share of the points that the largest piece of a facade must hold before shadows are bridged.
_WHOLE = 0.95

# Factor by which the longest edge grows while shadows divide a facade.
_GROWTH = 1.5

# The spacing of points where they are farthest apart: this percentile of the points' smallest triangles.
_PERCENTILE = 95

# Tolerance of straight edges (spacings): the boundary of scattered points is as rough.
_TOLERANCE_SPACINGS = 2.0

# Least tolerance of straight edges (m): the relief of an edge of plaster or brick.
_LEAST_TOLERANCE = 0.05

# Largest tolerance of straight edges (share of the width of a facade), lest a narrow one become a line.
_TOLERANCE_SHARE = 0.2

# A corner costs as much as this many cubed tolerances of squared distance along the boundary; fitted on simulated
# outlines.
_CORNER = 0.5

# Angle (rad) to the horizontal within which an edge of the hull is the foot of a facade: streets are hardly steeper.
_FOOT_ANGLE = np.radians(12.0)

# Angle (rad) to the vertical within which an edge of the hull is a side: walls end upright, but for noise.
_SIDE_ANGLE = np.radians(4.0)

# Largest hidden corner of the foot, along and up the facade (m): a parked car or a bush.
_HIDDEN = (5.0, 2.5)

# Number of rounds of pushing the boundary out: a moved corner may leave a point of the next edge outside.
_PUSHES = 4

# A corner may move this many times as far as the edges next to it: a corner of less than 39° would become spikes.
_MITER = 3.0


@dataclass(frozen=True)
class Outline:
    """The boundary of a facade."""

    ring: np.ndarray  #: (m, 2): closed, counterclockwise, along and up the facade (m)
    spacing: float  #: Distance between points where they are farthest apart, m
    hull_area: float  #: Area of the convex hull of the points, m²
    seen_area: float  #: Area of the triangles between the points, m²


@dataclass(frozen=True)
class Drawing:
    """How facades are drawn: tunables of 'Extract facades' and 'Extract openings'."""

    max_tilt: float  #: Largest angle of a facade to the vertical, °
    max_gap: float  #: Widest shadow that is bridged, m
    boundary: str  #: "straight edges" by least squares, or "key points" of the boundary, where it turns
    complete: bool  #: Whether what cars and trees hide of the foot and the sides is filled


def outline_of(positions: np.ndarray, drawing: Drawing) -> Optional[Outline]:
    """Return the boundary of points (n, 2), m along and up a plane; None if they have no area."""
    triangulation = triangulated(positions)
    if triangulation is None:
        return None
    spacing = sparse_spacing(positions, triangulation.simplices)
    traced = _traced(positions, triangulation, spacing, drawing)
    if traced is None:
        return None
    seen = ring_area(traced)
    if drawing.complete:
        traced = completed(traced)
    hull = spatial.ConvexHull(positions)
    width = float(hull.volume) / float(np.linalg.norm(np.ptp(positions, axis=0)))
    tolerance = edge_tolerance(spacing, _TOLERANCE_SHARE * width)
    if drawing.boundary == "key points":
        ring, limit = key_points(traced), np.inf
    else:
        ring, limit = _straightened(traced, tolerance), 2 * tolerance
    if not is_valid([ring]):
        ring = traced
    return Outline(pushed_out(ring, traced[:-1], limit), spacing, float(hull.volume), seen)


def edge_tolerance(spacing: float, most: float = np.inf) -> float:
    """Return the distance (m) from a straight edge, ``most`` at most, up to which scattered points are along it."""
    return max(min(_TOLERANCE_SPACINGS * spacing, most), _LEAST_TOLERANCE)


def _straightened(traced: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the closed ring of straight edges along a traced one, to a tolerance (m)."""
    samples = sampled(traced, tolerance / _TOLERANCE_SPACINGS)
    weights = direction_weights(samples)
    edges = draw_ring(samples, main_directions(weights, weights, len(samples)), Prices(_CORNER * tolerance**3))
    return np.array([edge.start for edge in [*edges, edges[0]]])


def completed(ring: np.ndarray) -> np.ndarray:
    """Return a traced boundary without the bites that cars, trees and people take out of its foot and its sides.

    Bites are the pockets between the boundary and its convex hull. They are filled where the hull is upright or follows
    the foot of the facade; where a corner of the foot is hidden, the side goes on down to the line of the foot.
    Upward, a facade may have any shape: steps and gables stay. The ring (m, 2), m along and up the facade, is closed
    and counterclockwise.
    """
    positions = ring[:-1]
    corners = np.sort(spatial.ConvexHull(positions).vertices)
    lids = np.roll(positions[corners], -1, axis=0) - positions[corners]
    length = np.linalg.norm(lids, axis=1)
    is_foot = lids[:, 0] >= np.cos(_FOOT_ANGLE) * length
    is_side = np.abs(lids[:, 1]) >= np.cos(_SIDE_ANGLE) * length
    if not is_foot.any():
        return ring
    hidden = _hidden_corners(positions[corners], lids, length, is_foot, is_side)
    made = []
    for k, start in enumerate(corners):
        end = corners[(k + 1) % len(corners)]
        made.append(positions[start][None])
        if k in hidden:
            made.append(hidden[k])
        elif not (is_foot[k] or is_side[k]):
            made.append(positions[np.arange(start + 1, end if end > start else end + len(positions)) % len(positions)])
    found = np.concatenate(made)
    found = np.concatenate([found, found[:1]])
    return found if is_valid([found]) else ring


def _hidden_corners(
    corners: np.ndarray, lids: np.ndarray, length: np.ndarray, is_foot: np.ndarray, is_side: np.ndarray
) -> dict[int, np.ndarray]:
    """Return the corner (1, 2), or none (0, 2), that replaces each hull edge (k) between the foot and the sides."""
    foot = int(np.argmax(np.where(is_foot, length, 0.0)))
    hidden: dict[int, np.ndarray] = {}
    for step in (1, -1):
        run: list[int] = []
        last, k = foot, (foot + step) % len(corners)
        # Edges of the foot next to the longest one continue along it; then diagonal ones lead up to the side.
        while is_foot[k] and k != foot:
            last, k = k, (k + step) % len(corners)
        while not is_side[k] and len(run) < len(corners) and lids[k, 0] > 0:
            run.append(k)
            k = (k + step) % len(corners)
        if not run or not is_side[k]:
            continue
        low, side = (last + 1, k) if step == 1 else (last, k + 1)
        low_end, side_end = corners[low % len(corners)], corners[side % len(corners)]
        reach = np.abs(side_end - low_end)
        if reach[0] <= _HIDDEN[0] and reach[1] <= _HIDDEN[1]:
            slope = lids[foot, 1] / lids[foot, 0]
            corner = np.array([side_end[0], low_end[1] + slope * (side_end[0] - low_end[0])])
            hidden |= {edge: np.zeros((0, 2)) for edge in run}
            hidden[run[0] if step == 1 else run[-1]] = corner[None]
    return hidden


def sparse_spacing(positions: np.ndarray, triangles: np.ndarray) -> float:
    """Return the distance (m) between points (n, 2) where they are farthest apart, by their triangles (t, 3).

    It is the longest edge of the smallest triangle at a point, over the square root of two, so that a square grid has
    its own spacing, and scan lines have that between the lines.
    """
    corners = positions[triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    smallest = least_of(np.repeat(longest, 3), triangles.ravel(), len(positions))
    return float(np.percentile(smallest[np.isfinite(smallest)], _PERCENTILE)) / np.sqrt(2)


def _traced(positions: np.ndarray, triangulation: Any, spacing: float, drawing: Drawing) -> Optional[np.ndarray]:
    """Return the exterior ring of the largest piece of triangles without long edges."""
    longest_edge = _PUBLISHED_EDGE if drawing.boundary == "key points" else _LONGEST_EDGE
    # Cells of half a gap connect across their corners, which corresponds to triangle edges of √2 gaps.
    max_edge, max_gap = longest_edge * spacing, float(np.sqrt(2)) * drawing.max_gap
    while True:
        tracing, is_last = trace_outlines(positions, max_edge, triangulation), max_edge >= max_gap
        if tracing is not None:
            inside = tracing.face >= 0
            piece = int(np.argmax(np.bincount(tracing.face[inside], tracing.areas[inside])))
            held = np.unique(tracing.triangles[tracing.face == piece])
            if is_last or len(held) >= _WHOLE * len(positions):
                return tracing.parts[piece]
        elif is_last:
            return None
        max_edge = min(max_edge * _GROWTH, max_gap)


def key_points(ring: np.ndarray) -> np.ndarray:
    """Return the closed ring of the points of a boundary where it turns.

    In a first round and 30 that follow the points at which the boundary turns by less than the threshold are removed;
    the threshold goes from 10° up by one degree a round. Of two neighbors only one is removed at a time, as the
    other one turns by another angle then.
    """
    positions = ring[:-1]
    for angle in _FIRST_ANGLE + np.arange(_ROUNDS + 1):
        while len(positions) > 4:
            turn = _turns(positions)
            flat = turn < np.radians(angle)
            # The flattest of a run goes first.
            flat &= (turn <= np.roll(turn, 1)) & (turn < np.roll(turn, -1))
            if not flat.any() or len(positions) - flat.sum() < 3:
                break
            positions = positions[~flat]
    return np.concatenate([positions, positions[:1]])


def _turns(positions: np.ndarray) -> np.ndarray:
    """Return the angle (rad), 0 to pi, between the edges before and after each vertex (m, 2) of an open ring."""
    before, after = positions - np.roll(positions, 1, axis=0), np.roll(positions, -1, axis=0) - positions
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.abs(np.arctan2(cross, np.einsum("ij,ij->i", before, after)))


def pushed_out(ring: np.ndarray, positions: np.ndarray, limit: float) -> np.ndarray:
    """Return a ring whose edges are moved outward, parallel, until it holds all positions (n, 2) within a limit (m).

    Positions farther outside are spikes, which stay outside; with an infinite limit none does.
    """
    for _ in range(_PUSHES):
        starts, ends = ring[:-1], ring[1:]
        outside = positions[~inside_ring(positions, ring)]
        if not len(outside):
            break
        distance, outward = edge_distances(outside, starts, ends), _outward(starts, ends)
        # How far positions lie outside the lines of the edges.
        out = outside @ outward.T - np.einsum("ij,ij->i", starts, outward)
        # At a corner two edges are equally near; move the one that is farther behind.
        nearest = np.argmax(np.where(distance <= distance.min(axis=1, keepdims=True) + ROUNDING, out, -np.inf), axis=1)
        rows = np.flatnonzero(distance.min(axis=1) <= limit)
        shift = np.zeros(len(starts))
        np.maximum.at(shift, nearest[rows], out[rows, nearest[rows]])
        moved = ring_of_lines(starts + shift[:, None] * outward, ends - starts, starts)
        is_spike = np.isfinite(limit) and np.linalg.norm(moved - ring, axis=1).max() > _MITER * shift.max()
        if shift.max() < ROUNDING or is_spike or not is_valid([moved]):
            break
        ring = moved
    return ring


def _outward(starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    step = ends - starts
    return np.column_stack([step[:, 1], -step[:, 0]]) / np.linalg.norm(step, axis=1)[:, None]


def inside_ring(positions: np.ndarray, ring: np.ndarray) -> np.ndarray:
    """Return the mask of positions (n, 2) in a closed ring, its own vertices included."""
    inside = are_inside(positions, ring)
    rest = np.flatnonzero(~inside)
    if len(rest):
        inside[rest] = nearest_edge_distances(positions[rest], ring[:-1], ring[1:]) < ROUNDING
    return inside


def ring_of_lines(points: np.ndarray, directions: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return the closed ring of the edges on lines.

    Parameters
    ----------
    points, directions : ndarray of shape (m, 2)
        Of the line of each edge, in order.
    corners : ndarray of shape (m, 2)
        Where each edge began before; kept, up to its projection, where two lines in a row are nearly parallel.
    """
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    before, other = np.roll(points, 1, axis=0), np.roll(unit, 1, axis=0)
    cross = other[:, 0] * unit[:, 1] - other[:, 1] * unit[:, 0]
    gap = points - before
    is_parallel = np.abs(cross) < PARALLEL
    share = (gap[:, 0] * unit[:, 1] - gap[:, 1] * unit[:, 0]) / np.where(is_parallel, 1.0, cross)
    meet = before + share[:, None] * other
    own = points + np.einsum("ij,ij->i", corners - points, unit)[:, None] * unit
    last = before + np.einsum("ij,ij->i", corners - before, other)[:, None] * other
    ring = np.where(is_parallel[:, None], (own + last) / 2, meet)
    return np.concatenate([ring, ring[:1]])


def grown(ring: np.ndarray, distance: float) -> np.ndarray:
    """Return a closed counterclockwise ring whose edges are moved outward by a distance (m)."""
    starts, ends = ring[:-1], ring[1:]
    return ring_of_lines(starts + distance * _outward(starts, ends), ends - starts, starts)


def ring_area(ring: np.ndarray) -> float:
    """Return the area (m²) within a ring, however it turns."""
    return abs(signed_area(ring))


@dataclass(frozen=True)
class Tracing:
    """Triangles over points, and the piece that each is part of.

    An edge lies opposite a corner of its triangle and has the triangle on its left.
    """

    xy: np.ndarray  #: (n, 2): the points (m)
    #: triangles, neighbors, (t, 3): points of each triangle, counterclockwise, and the triangle across from each, -1
    #: for none
    triangles: np.ndarray
    neighbors: np.ndarray
    face: np.ndarray  #: (t,): piece of each triangle, from 0; -1 outside

    @property
    def areas(self) -> np.ndarray:
        """Area (m²) of each triangle."""
        corners = self.xy[self.triangles]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        return 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])

    @property
    def parts(self) -> list[np.ndarray]:
        """The closed ring (m) around each piece, counterclockwise: the largest of one that touches itself."""
        across = np.where(self.neighbors >= 0, self.face[self.neighbors], -1)
        triangle, corner = np.nonzero((self.face[:, None] >= 0) & (across != self.face[:, None]))
        start, end = (self.triangles[triangle, (corner + step) % 3] for step in (1, 2))
        edges = members(self.face[triangle] + 1).values()
        found = (rings_of_edges(zip(start[own].tolist(), end[own].tolist())) for own in edges)
        rings = ([self.xy[[*ring, ring[0]]] for ring in of_piece] for of_piece in found)
        return [max(of_piece, key=signed_area) for of_piece in rings]


def triangulated(xy: np.ndarray) -> Optional[Any]:
    """Return the Delaunay triangulation of points (n, 2), m, about their middle; None where they have no area."""
    # With a standard deviation below a millimeter across, the points lie on a line.
    if len(xy) < 3 or np.linalg.eigvalsh(np.cov((xy - xy.mean(axis=0)).T))[0] < 1e-6:
        return None
    return spatial.Delaunay(xy - xy.mean(axis=0))


def trace_outlines(xy: np.ndarray, max_edge: float, triangulation: Any) -> Optional[Tracing]:
    """Return the pieces of triangles that share edges and have none longer than ``max_edge`` (m), holes filled.

    The triangulation is made of the points ``xy`` (n, 2), m; None where no triangle is left.

    References
    ----------
    Edelsbrunner et al. (1983), On the shape of a set of points in the plane. [edelsbrunner1983]
    Santos et al. (2019), Extraction of building roof boundaries from LiDAR data using an adaptive alpha shape.
    [santosroofs2019]
    """
    triangles, neighbors = triangulation.simplices, triangulation.neighbors
    corners = xy[triangles]
    is_kept = (np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2) <= max_edge).all(axis=1)
    if not is_kept.any():
        return None
    piece = pieces_of(is_kept, neighbors)
    reaches_rim = mask_of(piece.max() + 1, piece[(neighbors < 0).any(axis=1)])
    is_kept |= ~reaches_rim[piece]
    piece = np.unique(pieces_of(is_kept, neighbors)[is_kept], return_inverse=True)[1]
    return Tracing(xy, triangles, neighbors, placed(piece, is_kept, len(triangles), -1))


def pieces_of(value: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """Return the number (t,) from 0 of the piece that each triangle is in: triangles of one value that share edges."""
    rows, sides = np.nonzero((neighbors >= 0) & (value[neighbors] == value[:, None]))
    return components(rows, neighbors[rows, sides], len(value))[1]
