"""The polygons that cells of a subdivision make, with common vertices along the borders that they share."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .groups import components
from .rings import signed_area
from .subdivision import Subdivision


@dataclass(frozen=True)
class CellPolygon:
    """A polygon of connected cells."""

    label: int  #: Label of its cells, at least 1
    cells: np.ndarray  #: (k,), int64: its cells, ascending
    rings: list[np.ndarray]  #: (m, 2) each, m: closed, the exterior first


def cell_polygons(cells: Subdivision, label: np.ndarray) -> list[CellPolygon]:
    """Return the polygons of all connected cells of one label; label 0 has none.

    Parameters
    ----------
    cells : Subdivision
    label : ndarray of shape (cells,), int64

    Returns
    -------
    list of CellPolygon
        By their first cells. They are valid, do not overlap, and share their borders vertex by vertex.
    """
    piece = joined_cells(cells, label)
    borders = _borders(cells, piece, label)
    corners = _corners(borders, cells.vertices)
    rings: dict[int, list[np.ndarray]] = {}
    for number, loop in _loops(borders, cells.vertices):
        ring = np.array([cells.vertices[v] for v in loop if v in corners])
        rings.setdefault(number, []).append(_from_south_west(ring))
    found = []
    for number in sorted(rings):
        members = np.flatnonzero(piece == number)
        found.append(CellPolygon(int(label[members[0]]), members, sorted(rings[number], key=signed_area, reverse=True)))
    return found


def _from_south_west(ring: np.ndarray) -> np.ndarray:
    """Return a closed ring that begins at its south-western vertex, to the millimeter."""
    first = np.lexsort(np.round(ring, 3).T)[0]
    return np.concatenate([ring[first:], ring[: first + 1]])


def joined_cells(cells: Subdivision, label: np.ndarray) -> np.ndarray:
    """Return the number (cells,) of the piece that each cell is in: cells of one label that share edges."""
    _, sides = cells.edges()
    same = sides[label[sides[:, 0]] == label[sides[:, 1]]]
    return components(same[:, 0], same[:, 1], len(cells))[1]


def _borders(cells: Subdivision, piece: np.ndarray, label: np.ndarray) -> list[tuple[int, int, int]]:
    """Return (piece, start, end) of each border edge whose left piece has a positive label."""
    return [
        (int(piece[cell]), start, end)
        for (start, end), cell in cells.cell_of.items()
        if label[cell] > 0 and ((end, start) not in cells.cell_of or piece[cells.cell_of[end, start]] != piece[cell])
    ]


def _corners(borders: list[tuple[int, int, int]], vertices: list[tuple[float, float]]) -> set[int]:
    """Return the vertices at which borders turn or more than two of them meet."""
    beside: dict[int, set[int]] = {}
    for _, start, end in borders:
        beside.setdefault(start, set()).add(end)
        beside.setdefault(end, set()).add(start)
    # Closer than 2 mm to the line between its neighbors it is no corner.
    return {
        vertex
        for vertex, others in beside.items()
        if len(others) != 2 or _bend(*(vertices[v] for v in (*sorted(others), vertex))) > 0.002
    }


def _bend(before: tuple, after: tuple, at: tuple) -> float:
    """Return the distance (m) of a position from the line through the one before and the one after it."""
    (x0, y0), (x1, y1), (x, y) = before, after, at
    length = float(np.hypot(x1 - x0, y1 - y0))
    return abs((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / length if length > 0 else np.inf


def _loops(borders: list[tuple[int, int, int]], vertices: list[tuple[float, float]]) -> Iterator[tuple[int, list[int]]]:
    """Yield the piece and the vertices of each ring; where a piece touches itself in a vertex, rings part there."""
    following: dict[tuple[int, int], list[int]] = {}
    for number, start, end in borders:
        following.setdefault((number, start), []).append(end)
    for number, start, second in borders:
        if second not in following[number, start]:
            continue
        following[number, start].remove(second)
        loop, end = [start], second
        while end != loop[0]:
            loop.append(end)
            ends = following[number, end]
            end = ends.pop(_rightmost(loop[-2], loop[-1], ends, vertices))
        yield number, loop


def _rightmost(before: int, at: int, ends: list[int], vertices: list[tuple[float, float]]) -> int:
    """Return the position of the end to which the way from one vertex through another turns farthest right."""
    if len(ends) == 1:
        return 0
    (x, y), (x0, y0) = vertices[at], vertices[before]
    came = np.arctan2(y - y0, x - x0)
    turns = [np.arctan2(vertices[end][1] - y, vertices[end][0] - x) - came for end in ends]
    return int(np.argmin([(turn + np.pi) % (2 * np.pi) for turn in turns]))
