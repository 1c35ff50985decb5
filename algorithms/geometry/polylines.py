"""Simplify lines within a tolerance."""

import numpy as np


def simplify_ring(ring: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the closed ring with the vertices of Douglas and Peucker that keep it within ``tolerance`` (m)."""
    rows = simplify(ring[:-1], tolerance, is_closed=True)
    return ring[np.append(rows, rows[0])]


def simplify(positions: np.ndarray, tolerance: float, is_closed: bool) -> np.ndarray:
    """Return the rows of the vertices of Douglas and Peucker that keep a line within ``tolerance`` (m), ascending."""
    count = len(positions)
    # The two ends of the longest extent are corners of a closed line in any case.
    start = int(np.argmax(((positions - positions.mean(axis=0)) ** 2).sum(axis=1))) if is_closed else 0
    turned = np.roll(positions, -start, axis=0)
    if is_closed:
        turned = np.concatenate([turned, turned[:1]])
    last = len(turned) - 1
    far = int(np.argmax(((turned - turned[0]) ** 2).sum(axis=1))) if is_closed else last
    is_kept = np.zeros(last + 1, bool)
    is_kept[[0, far, last]] = True
    low, high = np.array([0, far]), np.array([far, last])
    while len(low):
        middle, distance = _farthest_from_chords(turned, low, high)
        wide = distance > tolerance
        low, middle, high = low[wide], middle[wide], high[wide]
        is_kept[middle] = True
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    kept = np.flatnonzero(is_kept[:-1] if is_closed else is_kept)
    return np.sort((kept + start) % count)


def _farthest_from_chords(line: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertex of each span of a line that is farthest from the segment between its ends, and how far (m).

    Spans lead from the vertices ``low`` (s,) to ``high`` (s,); where nothing is between, the distance is -1.
    """
    size = np.maximum(high - low - 1, 0)
    first = np.cumsum(size) - size
    span = np.repeat(np.arange(len(low)), size)
    vertex = np.arange(len(span)) + (low + 1 - first)[span]
    along = line[high] - line[low]
    square = np.maximum(along[:, 0] * along[:, 0] + along[:, 1] * along[:, 1], 1e-30)
    east, north = along[span].T
    offset_east, offset_north = (line[vertex] - line[low[span]]).T
    share = np.clip((offset_east * east + offset_north * north) / square[span], 0.0, 1.0)
    away = np.hypot(offset_east - share * east, offset_north - share * north)
    distance, middle = np.full(len(low), -1.0), low.copy()
    filled = np.flatnonzero(size)
    if len(filled):
        distance[filled] = np.maximum.reduceat(away, first[filled])
        # Of equally far vertices the first one counts, as it is written last.
        farthest = np.flatnonzero(away == distance[span])[::-1]
        middle[span[farthest]] = vertex[farthest]
    return middle, distance
