"""Move the walls of polygons along their normals, so that each polygon gets a given area."""

from itertools import combinations

import numpy as np

from ..criteria import PARALLEL
from .groups import components, split_groups


def with_areas(polygons: list, wanted: np.ndarray) -> list:
    """Return polygons with wanted areas (n,), m²: whole lines are moved, by least length times squared shift in all.

    The polygons are lists of closed rings (m, 2), m, and have common vertices where they touch. They keep these, and
    edges their directions.
    """
    vertices, loops = _loops(polygons)
    start, end = np.concatenate(loops), np.concatenate([np.roll(loop, -1) for loop in loops])
    owner = np.repeat(np.arange(len(polygons)), [sum(len(ring) - 1 for ring in own) for own in polygons])
    line, normal = _lines(vertices, start, end)
    # Areas are quadratic in the shifts: a few rounds leave a millionth of them.
    for _ in range(20):
        (x, y), way = vertices[start].T, vertices[end] - vertices[start]
        area = np.bincount(owner, (x * way[:, 1] - y * way[:, 0]) / 2, len(polygons))
        if (np.abs(wanted - area) <= 1e-6 * wanted).all():
            break
        length = np.hypot(*way.T)
        outward = np.sign(way[:, 1] * normal[line, 0] - way[:, 0] * normal[line, 1])
        gain = np.zeros((len(polygons), len(normal)))
        np.add.at(gain, (owner, line), outward * length)
        weight = np.bincount(line, length)
        shift = gain.T / weight[:, None] @ np.linalg.lstsq(gain / weight @ gain.T, wanted - area, rcond=1e-9)[0]
        offset = np.bincount(line, length * (normal[line] * vertices[start]).sum(axis=1)) / weight + shift
        vertices = _on_lines(vertices, start, end, line, normal, offset)
    return _rings(polygons, vertices, loops)


def welded(polygons: list, within: float) -> list:
    """Return polygons with common vertices, as for :func:`with_areas`, without edges shorter than ``within`` (m)."""
    vertices, loops = _loops(polygons)
    start, end = np.concatenate(loops), np.concatenate([np.roll(loop, -1) for loop in loops])
    is_short = np.hypot(*(vertices[end] - vertices[start]).T) < within
    _, group = components(start[is_short], end[is_short], len(vertices))
    first = np.unique(group, return_index=True)[1][group]
    return _rings(polygons, vertices, [loop[loop != np.roll(loop, 1)] for loop in (first[loop] for loop in loops)])


def _loops(polygons: list) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the different vertices (n, 2) of polygons, and the numbers of those around each ring, each once."""
    rings = [ring[:-1] for own in polygons for ring in own]
    vertices, at = np.unique(np.concatenate(rings), axis=0, return_inverse=True)
    return vertices, np.split(at.ravel(), np.cumsum([len(ring) for ring in rings])[:-1])


def _rings(polygons: list, vertices: np.ndarray, loops: list[np.ndarray]) -> list:
    """Return polygons with the closed rings that go around loops of vertices."""
    rings = iter([vertices[np.append(loop, loop[:1])] for loop in loops])
    return [[next(rings) for _ in own] for own in polygons]


def _lines(vertices: np.ndarray, start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the line (e,) of each edge, the same where edges go on straight, and the normals (l, 2) of lines."""
    ends, edge = np.unique(np.sort(np.column_stack([start, end])), axis=0, return_inverse=True)
    way = vertices[ends[:, 1]] - vertices[ends[:, 0]]
    length = np.hypot(*way.T)
    normal = np.column_stack([-way[:, 1], way[:, 0]]) / length[:, None]
    meeting = split_groups(ends.T.ravel(), len(vertices))
    pairs = np.array([pair for rows in meeting for pair in combinations(rows, 2)]).T
    # Away from the vertex in which they meet, within a thousandth of a radian: edges of a wedge fold back.
    (x, y), (u, v) = (np.concatenate([normal, -normal])[rows].T for rows in pairs)
    is_one = (np.abs(x * v - y * u) < 1e-3) & (x * u + y * v < 0)
    one, other = pairs % len(ends)
    count, line = components(one[is_one], other[is_one], len(ends))
    # Of values that go to one position the last one stays: the longest edge.
    longest, order = np.zeros(count, np.int64), np.argsort(length, kind="stable")
    longest[line[order]] = order
    return line[edge.ravel()], normal[longest]


def _on_lines(
    vertices: np.ndarray, start: np.ndarray, end: np.ndarray, line: np.ndarray, normal: np.ndarray, offset: np.ndarray
) -> np.ndarray:
    """Return vertices moved onto the lines that meet in them, by as little as that takes."""
    vertex, lines = np.unique(np.column_stack([np.append(start, end), np.append(line, line)]), axis=0).T
    moved = vertices.copy()
    for number, rows in enumerate(split_groups(vertex, len(vertices))):
        across = normal[lines[rows]]
        moved[number] += np.linalg.lstsq(across, offset[lines[rows]] - across @ vertices[number], rcond=PARALLEL)[0]
    return moved
