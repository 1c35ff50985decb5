"""The boundary of a facade in its own plane: traced, reduced to its corners, and pushed out to hold all points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..footprints.alpha_shape import Tracing, trace_outlines
from ..footprints.regularization import regularize_outline
from ..geometry.line_segments import edge_distances, is_valid
from ..geometry.polylines import simplify_ring
from ..geometry.rings import signed_area
from ..packages import spatial

# The angle (°) between the edges at a boundary point below which it is no key point: in the first round, and after as
# many rounds of one degree (paper, section 3.3, step 3).
_FIRST_ANGLE, _ROUNDS = 10.0, 30

# Longest edge of a triangle (spacings): of the paper (section 3.3, step 2), and for straight edges, where chance must
# take no bites out of the boundary of evenly scattered points.
_PUBLISHED_EDGE, _LONGEST_EDGE = 1.5, 4.0

# Share of the points that the largest piece of a facade must hold before shadows are bridged.
_WHOLE = 0.95

# By this factor the longest edge grows while shadows cut a facade into pieces.
_GROWTH = 1.5

# The spacing of points where they are farthest apart: this percentile of the points' smallest triangles.
_PERCENTILE = 95

# Tolerance of straight edges: spacings, and m.
_TOLERANCE_SPACINGS, _LEAST_TOLERANCE = 2.0, 0.05

# Times the boundary is pushed out: a corner that moves may leave a point of the edge beside it outside.
_PUSHES = 4

# Sine of the angle below which two edges count as parallel: their lines meet too far away to tell where.
_PARALLEL = 0.05


@dataclass(frozen=True)
class Outline:
    """The boundary of a facade.

    Attributes
    ----------
    ring : ndarray of shape (m, 2)
        Closed, counterclockwise, along and up the facade (m).
    spacing : float
        Distance between points where they are farthest apart, m.
    hull_area : float
        Area of the convex hull of the points, m².
    """

    ring: np.ndarray
    spacing: float
    hull_area: float


def longest_edge(boundary: str) -> float:
    """Return the longest edge of a triangle (spacings) for a kind of boundary."""
    return _PUBLISHED_EDGE if boundary == "key points" else _LONGEST_EDGE


def outline_of(places: np.ndarray, edge_factor: float, max_gap: float, boundary: str) -> Optional[Outline]:
    """Return the boundary of points on a plane, None where they have no area.

    Parameters
    ----------
    places : ndarray of shape (n, 2)
        Positions along and up the facade (m).
    edge_factor : float
        Longest edge of a triangle, in spacings.
    max_gap : float
        Widest shadow (m) that is bridged.
    boundary : str
        "straight edges": edges by least squares; "key points": the points of the boundary where it turns.
    """
    spacing = sparse_spacing(places)
    traced = _traced(places, spacing, edge_factor, max_gap) if spacing else None
    if traced is None:
        return None
    tolerance = max(_TOLERANCE_SPACINGS * spacing, _LEAST_TOLERANCE)
    if boundary == "key points":
        ring, limit = key_points(traced), np.inf
    else:
        found = regularize_outline([traced], tolerance)
        ring, limit = (found[0] if found else simplify_ring(traced, tolerance)), 2 * tolerance
    if not is_valid([ring]):
        ring = traced
    hull = spatial.ConvexHull(places)
    return Outline(pushed_out(ring, traced[:-1], limit), spacing, float(hull.volume))


def sparse_spacing(places: np.ndarray) -> float:
    """Return the distance (m) between points (n, 2) where they are farthest apart; 0 where they have no area.

    It is the longest edge of the smallest triangle at a point, over the square root of two, so that a square grid has
    its own spacing, and scan lines have that between the lines.
    """
    if len(places) < 3 or np.linalg.eigvalsh(np.cov(places.T))[0] < 1e-6:
        return 0.0
    triangles = spatial.Delaunay(places - places.mean(axis=0)).simplices
    corners = places[triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    smallest = np.full(len(places), np.inf)
    np.minimum.at(smallest, triangles.ravel(), np.repeat(longest, 3))
    return float(np.percentile(smallest[np.isfinite(smallest)], _PERCENTILE)) / np.sqrt(2)


def _traced(places: np.ndarray, spacing: float, edge_factor: float, max_gap: float) -> Optional[np.ndarray]:
    """Return the exterior ring of the largest piece of triangles without long edges."""
    label, max_edge = np.ones(len(places), np.int64), edge_factor * spacing
    while True:
        tracing = trace_outlines(places, label, spacing, max_edge, min_hole_area=np.inf)
        piece = None if tracing is None else _largest(tracing)
        if max_edge >= max_gap or (tracing is not None and piece is not None and _share(tracing, piece) >= _WHOLE):
            break
        max_edge = min(max_edge * _GROWTH, max_gap)
    return None if tracing is None or piece is None else tracing.parts[piece][0]


def _largest(tracing: Tracing) -> Optional[int]:
    inside = tracing.face >= 0
    return int(np.argmax(np.bincount(tracing.face[inside], tracing.areas[inside]))) if inside.any() else None


def _share(tracing: Tracing, piece: int) -> float:
    """Return the share of the points that a piece holds."""
    return len(np.unique(tracing.triangles[tracing.face == piece])) / len(tracing.xy)


def key_points(ring: np.ndarray) -> np.ndarray:
    """Return the closed ring of the points of a boundary where it turns.

    In each of 30 rounds the points at which the boundary turns by less than the threshold are removed; the threshold
    goes from 10° up by one degree a round. Of two neighbors only one is removed at a time, so that the angles are those
    of what is left.
    """
    places = ring[:-1]
    for angle in _FIRST_ANGLE + np.arange(_ROUNDS + 1):
        while len(places) > 4:
            turn = _turns(places)
            flat = turn < np.radians(angle)
            # The flattest of a run goes first.
            flat &= (turn <= np.roll(turn, 1)) & (turn < np.roll(turn, -1))
            if not flat.any() or len(places) - flat.sum() < 3:
                break
            places = places[~flat]
    return np.concatenate([places, places[:1]])


def _turns(places: np.ndarray) -> np.ndarray:
    """Return the angle (rad), 0 to pi, between the edges before and after each vertex (m, 2) of an open ring."""
    before, after = places - np.roll(places, 1, axis=0), np.roll(places, -1, axis=0) - places
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.abs(np.arctan2(cross, np.einsum("ij,ij->i", before, after)))


def pushed_out(ring: np.ndarray, places: np.ndarray, limit: float) -> np.ndarray:
    """Return a ring whose edges are moved outward, parallel, until it holds all places.

    Parameters
    ----------
    ring : ndarray of shape (m, 2)
        Closed, counterclockwise.
    places : ndarray of shape (n, 2)
        Vertices of the traced boundary (m).
    limit : float
        Places farther outside than this (m) are spikes, which stay outside.
    """
    for _ in range(_PUSHES):
        starts, ends = ring[:-1], ring[1:]
        outside = places[~inside_ring(places, ring)]
        if not len(outside):
            break
        distance = edge_distances(outside, starts, ends)
        out = signed_offsets(outside, starts, ends)
        # At a corner two edges are equally near: the one that is farther behind has to move.
        nearest = np.argmax(np.where(distance <= distance.min(axis=1, keepdims=True) + 1e-9, out, -np.inf), axis=1)
        rows = np.flatnonzero(distance.min(axis=1) <= limit)
        shift = np.zeros(len(starts))
        np.maximum.at(shift, nearest[rows], out[rows, nearest[rows]])
        moved = ring_of_lines(starts + shift[:, None] * _outward(starts, ends), ends - starts, starts)
        if shift.max() < 1e-9 or not is_valid([moved]):
            break
        ring = moved
    return ring


def signed_offsets(places: np.ndarray, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return how far (n, m) (m) places lie outside the lines of the edges of a counterclockwise ring."""
    outward = _outward(starts, ends)
    return places @ outward.T - np.einsum("ij,ij->i", starts, outward)


def _outward(starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    step = ends - starts
    return np.column_stack([step[:, 1], -step[:, 0]]) / np.linalg.norm(step, axis=1)[:, None]


def inside_ring(places: np.ndarray, ring: np.ndarray) -> np.ndarray:
    """Return which places (n, 2) a closed ring holds, its own vertices included."""
    (x0, y0), (x1, y1) = ring[:-1].T, ring[1:].T
    odd = np.zeros(len(places), bool)
    for a, b, c, d in zip(x0, y0, x1, y1):
        crosses = (b > places[:, 1]) != (d > places[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            odd ^= crosses & (places[:, 0] < a + (places[:, 1] - b) * (c - a) / (d - b))
    rest = np.flatnonzero(~odd)
    if len(rest):
        odd[rest] = edge_distances(places[rest], ring[:-1], ring[1:]).min(axis=1) < 1e-9
    return odd


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
    is_parallel = np.abs(cross) < _PARALLEL
    share = (gap[:, 0] * unit[:, 1] - gap[:, 1] * unit[:, 0]) / np.where(is_parallel, 1.0, cross)
    meet = before + share[:, None] * other
    own = points + np.einsum("ij,ij->i", corners - points, unit)[:, None] * unit
    last = before + np.einsum("ij,ij->i", corners - before, other)[:, None] * other
    ring = np.where(is_parallel[:, None], (own + last) / 2, meet)
    return np.concatenate([ring, ring[:1]])


def ring_area(ring: np.ndarray) -> float:
    """Return the area (m²) within a ring, however it turns."""
    return abs(signed_area(ring))
