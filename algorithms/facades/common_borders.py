"""Intersection lines of neighboring facades as their common borders."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..criteria import SAME_WAY
from ..geometry.polygon_overlap import meeting_boxes
from ..geometry.rings import is_valid
from ..stage import Monitor
from .facade_frame import Frame, intersection_line
from .facade_outline import ring_of_lines
from .facade_surfaces import Facade

# Least length (m) of the part that the edges of two neighbors share.
_LEAST_COMMON = 0.3


def with_common_borders(facades: Sequence[Facade], reach: float, monitor: Monitor) -> list[Facade]:
    """Return facades whose neighboring edges, if within ``reach`` (m), lie on the intersection line of their planes."""
    # By facade and edge: distance (m) of the nearest line, a point on it and its direction.
    lines: list[dict[int, tuple]] = [{} for _ in facades]
    neighbors: list[set[int]] = [set() for _ in facades]
    for i, j in _near_pairs(facades, reach, monitor):
        line = intersection_line(facades[i].frame, facades[j].frame)
        if line is None:
            continue
        one, other = (_edges_along(facades[k], *line, reach) for k in (i, j))
        for edge_a, off_a in one:
            for edge_b, off_b in other:
                if _common(facades[i], edge_a, facades[j], edge_b, *line) < _LEAST_COMMON:
                    continue
                neighbors[i].add(j)
                neighbors[j].add(i)
                _offer(lines[i], edge_a, off_a, line)
                _offer(lines[j], edge_b, off_b, line)
    rings = [_moved(facade, own) for facade, own in zip(facades, lines)]
    return [replace(facade, ring=ring, neighbors=len(own)) for facade, ring, own in zip(facades, rings, neighbors)]


def _near_pairs(facades: Sequence[Facade], reach: float, monitor: Monitor) -> Iterator[tuple[int, int]]:
    """Yield the pairs of facades whose boxes, with a margin ``reach`` (m) around each, overlap."""
    corners = [facade.frame.space(facade.ring) for facade in facades]
    boxes = np.array([(ring.min(axis=0) - reach, ring.max(axis=0) + reach) for ring in corners]).reshape(-1, 2, 3)
    for i, j in zip(*meeting_boxes(boxes, boxes)):
        monitor.progress(i / len(facades))
        if i < j:
            yield int(i), int(j)


def _flat(frame: Frame, point: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return point and direction (2,) of a line of the plane in its own frame."""
    return frame.local(point[None])[0, :2], np.array([direction @ frame.along, direction @ frame.up])


def _edges_along(facade: Facade, point: np.ndarray, direction: np.ndarray, reach: float) -> list[tuple[int, float]]:
    """Return the edges of a facade that run along a line, with their distance (m) from it."""
    position, way = _flat(facade.frame, point, direction)
    steps = np.diff(facade.ring, axis=0)
    length = np.linalg.norm(steps, axis=1)
    across = np.array([-way[1], way[0]])
    corners_off = np.abs((facade.ring - position) @ across)
    off = np.maximum(corners_off[:-1], corners_off[1:])
    found = (np.abs(steps @ way) >= np.cos(np.radians(SAME_WAY)) * length) & (off <= reach) & (length >= _LEAST_COMMON)
    return [(int(edge), float(off[edge])) for edge in np.flatnonzero(found)]


def _common(one: Facade, edge: int, other: Facade, edge_of_other: int, point: np.ndarray, way: np.ndarray) -> float:
    """Return the length (m) of the line next to both edges."""
    spans = []
    for facade, number in ((one, edge), (other, edge_of_other)):
        ends = (facade.frame.space(facade.ring[number : number + 2]) - point) @ way
        spans.append((ends.min(), ends.max()))
    (low, high), (low_of_other, high_of_other) = spans
    return float(min(high, high_of_other) - max(low, low_of_other))


def _offer(lines: dict[int, tuple], edge: int, off: float, line: tuple) -> None:
    """Keep the nearest line of an edge."""
    if edge not in lines or off < lines[edge][0]:
        lines[edge] = (off, *line)


def _moved(facade: Facade, lines: dict[int, tuple]) -> np.ndarray:
    """Return the ring with edges moved onto lines; unchanged where that makes no valid ring."""
    if not lines:
        return facade.ring
    points, ways = facade.ring[:-1].copy(), np.diff(facade.ring, axis=0)
    for edge, (_, point, direction) in lines.items():
        position, way = _flat(facade.frame, point, direction)
        points[edge], ways[edge] = position, way if way @ ways[edge] > 0 else -way
    ring = ring_of_lines(points, ways, facade.ring[:-1])
    return ring if is_valid([ring]) else facade.ring
