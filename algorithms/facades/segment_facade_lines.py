"""Line segments of a vehicle's scan lines: ground, facades and other objects."""

from typing import Optional

import numpy as np

from ..geometry.groups import least_of, placed, run_starts
from ..geometry.polylines import simplify
from ..geometry.principal_axes import principal_axes
from ..neighborhoods.covariance import full_matrices
from ..planes.least_squares_planes import planes_of
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable

# Neighbors on a line farther apart than this (median steps of the line) belong to two segments; steps grow with the
# range.
_GAP_STEPS = 8.0

# Neighbors closer than this (m) belong to one segment: joints and sills leave such gaps.
_LEAST_GAP = 0.3

# Pauses this many times as long as the median one between two points may be the sky at the end of a turn.
_PAUSE = 20.0

# A pause of this share of a turn is the sky: 45°.
_SKY = 1 / 8

# Angle (°) to the horizontal up to which a segment is level enough for ground: ramps and gutters are less steep. The
# same angle to the vertical is upright enough for a facade: windshields and hoods lean more.
_LEVEL = 20.0

# Length (m) from which a steep segment may be of a facade.
_LEAST_FACADE = 0.5

# Kinds of segments, in the order of their numbers.
KINDS = ("other", "ground", "facade")
_OTHER, _GROUND, _FACADE = range(3)

LINE_FIELDS = (
    Field("id", int, "SegmentID of its points"),
    Field("line", int, "Number of the scan line, from 1, by scanner and time"),
    Field("kind", str, "ground, facade or other"),
    Field("slope", float, "Angle of the line through its points to the horizontal", "°"),
    Field("x", float, "Mean of the eastings of its first and last point, from the cloud's origin", "m"),
    Field("y", float, "Mean of the northings of its first and last point, from the cloud's origin", "m"),
    Field("z", float, "Mean of the elevations of its first and last point", "m"),
    Field("height", float, "That elevation over the lowest of its line", "m"),
    Field("distance", float, "Distance of its middle from the scanner in plan", "m"),
    Field("length", float, "Distance between its first and last point", "m"),
    Field("points", int, "Number of its points"),
)


@stage(
    "Facades",
    tags="scan line,vehicle,mobile mapping,facade,ground,street,segmentation,Peng",
    writes=("segment_id",),
    layers=(Layer("lines", "Line segments", "LineString", LINE_FIELDS),),
)
def segment_facade_lines(
    xyz,
    gps_time,
    point_source_id=None,
    *,
    line_duration: Optional[float] = tunable(
        None, within="(0, 60] s", automatic="the median time between two views of the sky, which give no points."
    ),
    tolerance: float = tunable(0.05, within="(0, 1] m"),
    max_ground_height: float = tunable(0.5, within="[0, 10] m"),
    facade_distance: float = tunable(1.5, within="[0, 50] m"),
    min_points: int = tunable(5, within="[3, 1000]"),
    monitor=None,
):
    """Divide a vehicle's scan lines into straight segments, and label ground, facades and other objects.

    Each line is split where it bends or leaves a gap. A segment gets its slope, the mean of its ends, its height over
    the lowest one of its line and its distance from the scanner. Level and low ones are ground; steep ones that are
    the farthest on their side are of the facade; all others are of cars, trees, people and signs.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    gps_time : ndarray of shape (n,), float64
        Time of each pulse, s.
    point_source_id : ndarray of shape (n,), uint16, optional
        Scanner of each point; lines are of one scanner each. Without it all points are of one.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Segments from 1, by scanner, line and time; 0 for stray points.
    lines : LayerFeatures
        A line with Z from the first to the last point of each segment, with the fields ``LINE_FIELDS``.

    Other Parameters
    ----------------
    line_duration
        Time of one turn of the scanner's mirror.
    tolerance
        Distance within which points lie on a line segment: a few standard deviations of the noise and of the relief of
        walls.
    max_ground_height
        Level segments at most this high over the lowest one of their line are ground (d0).
    facade_distance
        Steep segments at most this much nearer to the scanner than the farthest one on their side of the line are of
        the facade (h0).
    min_points
        Points of the shortest segment; shorter ones are stray points.

    Raises
    ------
    ValueError
        If all points have the same time.

    Notes
    -----
    The paper finds ground by Z' - min(Z') < d0 and facades by abs(Y' - max(Y')) < h0, with Y' across the way of the
    vehicle. Here Y' is the distance from the scanner in plan, on each of its two sides. A file doesn't say where the
    scanner was: it is taken to be over the point in the middle of the time of its line, which begins and ends with the
    sky. Lines end where no point comes for an eighth of a turn. They are split at gaps, and at their farthest point
    until all points are within the tolerance (Douglas and Peucker), which the paper leaves open.

    References
    ----------
    Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle
    LIDAR. EURASIP Journal on Image and Video Processing 2018:121, section 3.4. [peng2018]

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_street import simulate_street
    >>> xyz, *others = simulate_street(length=20.0, line_rate=20.0, clutter=False)
    >>> ids, lines = segment_facade_lines(xyz, others[6])
    >>> len(lines) > 0
    True
    """
    if np.ptp(gps_time) == 0:
        raise ValueError(
            "All points have the same GPS time, so scan lines can't be distinguished; use a cloud with times of its "
            "pulses, as the scanner recorded it."
        )
    source = np.zeros(len(xyz), np.int64) if point_source_id is None else point_source_id.astype(np.int64)
    # Points with one time keep the order of their coordinates, whatever the order of the file.
    order = np.lexsort((*xyz.T, gps_time, source))
    duration = _period(gps_time[order], source[order]) if line_duration is None else line_duration
    monitor.resolved(line_duration=duration)
    line = _lines(gps_time[order], source[order], duration)
    piece = _pieces(xyz[order], line, tolerance, monitor.part(0, 0.8))
    segment_id, features = _described(xyz[order], line, piece, (max_ground_height, facade_distance), min_points)
    if not features.geometries:
        monitor.none_found("No scan line has a straight segment; lower the minimum points or raise the tolerance.")
    return placed(segment_id, order, len(xyz)), features


def are_of_facade_lines(
    xyz: np.ndarray, gps_time: Optional[np.ndarray], point_source_id: Optional[np.ndarray]
) -> np.ndarray:
    """Return the mask of points (n,) on the facade lines that :func:`segment_facade_lines` finds by default."""
    if gps_time is None:
        raise ValueError(
            "Facade lines are found by the times of the pulses, and the cloud has no GPS time; search in all points."
        )
    segment_id, lines = segment_facade_lines(xyz, gps_time, point_source_id)
    is_facade = np.array([False, *(kind == KINDS[_FACADE] for kind in lines.columns["kind"])])
    return is_facade[segment_id]


def _period(gps_time: np.ndarray, source: np.ndarray) -> float:
    """Return the time (s) of one turn, from times (n,) in order by scanner: that between views of the sky."""
    step, is_same = np.diff(gps_time), np.diff(source) == 0
    forward = step[is_same & (step > 0)]
    if not len(forward):
        return float(np.ptp(gps_time))
    is_end = is_same & (step > _PAUSE * float(np.median(forward)))
    ends, scanner = gps_time[1:][is_end], source[1:][is_end]
    turns = np.diff(ends)[np.diff(scanner) == 0]
    return float(np.median(turns)) if len(turns) else float(np.ptp(gps_time))


def _lines(gps_time: np.ndarray, source: np.ndarray, duration: float) -> np.ndarray:
    """Return the line (n,) from 0 of points in order: a new one after the sky, or when a turn is over."""
    is_start = np.ones(len(gps_time), bool)
    is_start[1:] = (np.diff(gps_time) > _SKY * duration) | (np.diff(source) != 0)
    run = np.cumsum(is_start) - 1
    turn = np.floor((gps_time - gps_time[is_start][run]) / duration).astype(np.int64)
    is_start[1:] |= np.diff(turn) > 0
    return np.cumsum(is_start) - 1


def _pieces(xyz: np.ndarray, line: np.ndarray, tolerance: float, monitor: Monitor) -> np.ndarray:
    """Return the straight piece (n,) from 0 of points in the order of their lines."""
    starts = np.append(run_starts(line), len(line))
    is_start = np.zeros(len(line), bool)
    for done, (first, last) in enumerate(zip(starts[:-1], starts[1:])):
        is_start[first + _splits(xyz[first:last], tolerance)] = True
        if done % 100 == 0:
            monitor.progress(done / len(starts))
    return np.cumsum(is_start) - 1


def _splits(xyz: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the first points of the straight pieces of one line, in the plane that the scanner turns in."""
    # Along the direction in plan in which the line extends most, and up.
    center, _, axes = principal_axes(xyz[:, :2])
    positions = np.column_stack([(xyz[:, :2] - center) @ axes[:, 1], xyz[:, 2]])
    step = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    gap = max(_GAP_STEPS * float(np.median(step)), _LEAST_GAP) if len(step) else _LEAST_GAP
    ends = np.concatenate([[0], np.flatnonzero(step > gap) + 1, [len(xyz)]])
    found = []
    for first, last in zip(ends[:-1], ends[1:]):
        bends = simplify(positions[first:last], tolerance, is_closed=False) if last - first > 2 else np.zeros(1, int)
        # The last vertex is the end of the last piece.
        found.append(first + (bends[:-1] if len(bends) > 1 else bends))
    return np.concatenate(found)


def _described(
    xyz: np.ndarray, line: np.ndarray, piece: np.ndarray, limits: tuple[float, float], min_points: int
) -> tuple[np.ndarray, LayerFeatures]:
    """Return the segment (n,) of each point in the order of the lines, and the segments with their attributes."""
    count, first = np.bincount(piece), run_starts(piece)
    last = first + count - 1
    kept = np.flatnonzero(count >= min_points)
    number = placed(np.arange(1, len(kept) + 1, dtype=np.int32), kept, len(count))
    start, end = xyz[first[kept]], xyz[last[kept]]
    middle, of_line = (start + end) / 2, line[first[kept]]
    slope = _slopes(xyz, piece, kept)
    side, distance = _sides(xyz, line, middle, of_line)
    height = middle[:, 2] - least_of(middle[:, 2], of_line, int(line[-1]) + 1)[of_line]
    length = np.linalg.norm(end - start, axis=1)
    columns = {
        "id": np.arange(1, len(kept) + 1),
        "line": of_line + 1,
        "kind": [],
        "slope": slope,
        **dict(zip("xyz", middle.T)),
        "height": height,
        "distance": distance,
        "length": length,
        "points": count[kept],
    }
    columns["kind"] = [KINDS[kind] for kind in _kinds(columns, 2 * of_line + side, limits)]
    return number[piece], LayerFeatures(list(np.stack([start, end], axis=1)), columns)


def _slopes(xyz: np.ndarray, piece: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Return the angle (°) to the horizontal of the line of least squares through the points of each piece."""
    planes = planes_of(xyz - xyz.mean(axis=0), piece, int(piece.max()) + 1).chosen(kept)
    values, vectors = np.linalg.eigh(full_matrices(planes.covariance))
    return np.degrees(np.arcsin(np.clip(np.abs(vectors[:, 2, 2]), 0, 1)))


def _sides(xyz: np.ndarray, line: np.ndarray, middle: np.ndarray, of_line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the side, 0 or 1, of the scanner that segments are on, and their distance from it in plan (m)."""
    starts = run_starts(line)
    below = xyz[(starts + np.append(starts[1:], len(line)) - 1) // 2, :2]
    away = middle[:, :2] - below[of_line]
    # Any direction across the way distinguishes the sides of one line: that to its first point.
    first = xyz[starts, :2] - below
    return (np.einsum("ij,ij->i", away, first[of_line]) < 0).astype(np.int64), np.hypot(*away.T)


def _kinds(columns: dict, side: np.ndarray, limits: tuple[float, float]) -> np.ndarray:
    """Return the kinds of segments (m,).

    ``side`` (m,) is the number of the side of a line that each is on. ``limits`` are greatest height of ground and
    distance of facades (m).
    """
    slope, height, distance, length = (columns[name] for name in ("slope", "height", "distance", "length"))
    kind = np.full(len(slope), _OTHER)
    kind[(slope <= _LEVEL) & (height <= limits[0])] = _GROUND
    steep = np.flatnonzero((slope >= 90.0 - _LEVEL) & (length >= _LEAST_FACADE))
    farthest = -least_of(-distance[steep], side[steep], int(side.max(initial=-1)) + 1)
    kind[steep[distance[steep] >= farthest[side[steep]] - limits[1]]] = _FACADE
    return kind
