"""Planes and smooth surfaces from the straight pieces of recorded scan lines.

Lines are found by times, marks of the line's end, scan angles, or the order of points.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..criteria import BENDS, DIFFERENCE, SMOOTH
from ..geometry.groups import number_large, placed, run_starts
from ..packages import spatial
from ..params import POINT_DENSITY, SURFACE_NOISE
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..stage import stage, tunable
from ..threads import n_threads
from .adjacent_pieces import adjacent_pieces
from .piece_growing import Growth, Regions
from .straight_pieces import pieces_of, split_lines

# Largest distance of adjacent lines, and largest step between points of a line, in mean distances of lines. Where
# strips do not overlap lines are twice as far apart as on the average, and pulses do not fall side by side.
_LINES = 3.0

# Largest step between points of a line in median steps of the lines, if that is more.
_STEP_GAPS = 10.0

# Nearest points on pieces whose regions a point on no piece may join.
_NEAREST = 3

# A pause longer than this (median time between pulses) ends a line: the mirror turned back, or pulses were lost over a
# gap that no straight piece should cross.
_PAUSE = 20.0

# A jump of the scan angle by more than this (median steps) starts a new line, as with polygon mirrors.
_JUMP = 10.0

# Number of steps before and after a point that show whether a line turns back there: together they exceed noise.
_STEPS = 3

# Cosine of the angle between the directions before and after a point from which a line turns back there (120°): bends
# at edges of the scene are less.
_TURN = -0.5


@stage(
    "Segmentation",
    tags="scan line,scan angle,GPS time,split,region growing,range image,planes,segmentation,Jiang,Bunke",
    writes=("segment_id",),
)
def segment_recorded_lines(
    xyz,
    classification,
    gps_time=None,
    scan_angle=None,
    point_source_id=None,
    scan_direction_flag=None,
    edge_of_flight_line=None,
    return_number=None,
    number_of_returns=None,
    *,
    surfaces: str = tunable("planar", choices=("planar", "smooth")),
    tolerance: Optional[float] = tunable(
        None,
        within="(0, 100] m",
        automatic=(
            f"{DIFFERENCE:.2g} times the root of the sum of the squares of the surface noise and {BENDS:g} point "
            "spacings."
        ),
    ),
    line_distance: Optional[float] = tunable(
        None, within="(0, 1000] m", automatic=f"{_LINES:g} times the mean distance of scan lines."
    ),
    max_gap: Optional[float] = tunable(
        None,
        label="Widest gap",
        within="(0, 1000] m",
        automatic=f"the larger of {_STEP_GAPS:g} median steps between points and {_LINES:g} distances of scan lines.",
    ),
    min_overlap: float = tunable(0.5, within="[0, 1]"),
    min_piece: int = tunable(5, label="Minimum points of a piece", within="[3, 10_000]"),
    min_points: int = tunable(30, within="[1, 10_000_000]"),
    noise: Optional[float] = SURFACE_NOISE,
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Split recorded scan lines into straight pieces, and merge pieces of adjacent lines to planes or smooth surfaces.

    Lines come from GPS times, scan angles and the scanner's marks; without times, from the order of the points. Each
    is split at its farthest point until its pieces are straight. Three long pieces side by side on adjacent lines that
    lie on a plane are a seed. It grows by adjacent pieces whose ends lie on its surface until none can be added.
    For clouds from scanners whose order is lost, run 'Segment scan lines', which lays lines of its own.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18) is left out.
    gps_time : ndarray of shape (n,), float64, optional
        Time of the pulses, s. Without it the points are taken in their order.
    scan_angle : ndarray of shape (n,), float32, optional
        Angles of the beams, °: lines end where they begin to grow or to shrink.
    point_source_id : ndarray of shape (n,), uint16, optional
        Flight line or scanner, each with lines of its own.
    scan_direction_flag, edge_of_flight_line : ndarray of shape (n,), uint8, optional
        Lines end where the mirror turns.
    return_number, number_of_returns : ndarray of shape (n,), uint8, optional
        The last return of a pulse is on the line.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Segments from 1, by the size of their seeds; 0 if unassigned.

    Other Parameters
    ----------------
    surfaces
        Pieces join a region near the plane of all its points (planar), as published, or near the plane of the pieces
        next to them (smooth), so that terrain, domes and ramps are one.
    tolerance
        Distance from the straight line through a piece, and of its ends from the plane of a region.
    line_distance
        Distance of neighboring points on adjacent scan lines at most.
    max_gap
        Scan lines end where two points in a row are farther apart.
    min_overlap
        Share of the shorter of two pieces of a seed that lies next to the other.
    min_piece
        Straight pieces with fewer points join nothing.
    min_points
        Segments with fewer points get no id.

    Notes
    -----
    The paper works on range images. Here adjacent lines are found by their points: the nearest one to the side of a
    piece, and the nearest one on the opposite side, also of another flight line. A piece ends where the
    straight line through its points by least squares does, so that noise of single points does not count. Points on no
    piece, such as at bends and first returns, join the region of one of the ``_NEAREST`` nearest points that have one
    if they lie on its plane. The published method merges planes only.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    sections 2.1 and 3.1. [vosselman2004]
    Jiang, X. Y., Bunke, H., 1994. Fast segmentation of range images into planar regions by scan line grouping. Machine
    Vision and Applications 7 (2), 115-122. [jiang1994]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> ids = segment_recorded_lines(xyz, np.zeros(len(xyz)))
    >>> int(ids.max())
    2
    """
    density = sampling.surface_density if density is None else density
    noise = sampling.noise if noise is None else noise
    deviation = float(np.hypot(noise, BENDS / np.sqrt(density)))
    tolerance = DIFFERENCE * deviation if tolerance is None else tolerance
    used = not_noise(classification)
    if not len(used):
        return np.zeros(len(xyz), np.int32)
    points = xyz[used] - xyz[used].min(axis=0)
    recording = Recording(gps_time, scan_angle, point_source_id, scan_direction_flag, edge_of_flight_line).take(used)
    if not recording.has_times:
        monitor.warn("The points have no GPS times, so scan lines are taken from the order of the points.")
    monitor.inform(f"Scan lines are distinguished by: {', '.join(recording.evidence)}.")

    has_returns = return_number is not None and number_of_returns is not None
    last = np.flatnonzero(return_number[used] >= number_of_returns[used]) if has_returns else np.arange(len(used))
    row = last[recording.take(last).order(points[last])]
    line_spacing = _distance_of_lines(points[row], density)
    line_distance = _LINES * line_spacing if line_distance is None else line_distance
    max_gap = max(_LINES * line_spacing, _STEP_GAPS * _median_step(points[row])) if max_gap is None else max_gap
    monitor.resolved(density=density, noise=noise, tolerance=tolerance, line_distance=line_distance, max_gap=max_gap)
    line = recorded_lines(points[row], recording.take(row), max_gap)
    piece = split_lines(points[row], line, tolerance, min_piece, monitor.part(0, 0.3))
    monitor.inform(f"{int(line.max(initial=-1)) + 1} scan lines, {int(piece.max(initial=-1)) + 1} straight pieces.")

    on_piece = piece >= 0
    row, piece = row[on_piece], piece[on_piece]
    pieces = pieces_of(points[row], piece)
    adjacency = adjacent_pieces(points[row], piece, pieces, line_distance, monitor.part(0.3, 0.6))
    regions = Regions(pieces, adjacency, Growth(tolerance, SMOOTH / DIFFERENCE * tolerance, surfaces == "planar"))
    regions.grow(min_overlap, monitor.part(0.6, 0.9))
    segment = _with_others(points, row, piece, regions, line_distance, tolerance)
    return placed(number_large(segment, min_points), used, len(xyz))


def _median_step(points: np.ndarray) -> float:
    """Return the median distance (m) of points that follow one another."""
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return float(np.median(step[step > 0])) if (step > 0).any() else 0.0


def _distance_of_lines(points: np.ndarray, density: float) -> float:
    """Return the mean distance (m) of lines on surfaces of a density (points/m²); at least the points' own."""
    step = _median_step(points)
    return max(1 / (density * step), 1 / float(np.sqrt(density))) if step > 0 else 1 / float(np.sqrt(density))


def _with_others(
    points: np.ndarray, row: np.ndarray, piece: np.ndarray, regions: Regions, distance: float, tolerance: float
) -> np.ndarray:
    """Return the region (n,) of each point: its piece's, or of points next to it on whose plane it is; or -1.

    ``row`` and ``piece`` are the points of pieces.
    """
    region = np.asarray(regions.region, np.int64)
    segment = placed(region[piece], row, len(points), -1)
    known = segment[row] >= 0
    others = np.flatnonzero(segment < 0)
    if not known.any() or not len(others):
        return segment
    row, piece = row[known], piece[known]
    count = min(_NEAREST, len(row))
    tree = spatial.cKDTree(points[row])
    _, found = tree.query(points[others], count, distance_upper_bound=distance, workers=n_threads())
    for near in found.reshape(len(others), count).T:
        free = np.flatnonzero((segment[others] < 0) & (near < len(row)))
        plane = regions.plane[piece[near[free]]]
        off = np.abs(np.einsum("ij,ij->i", points[others[free]], plane[:, :3]) - plane[:, 3])
        on = free[off <= tolerance]
        segment[others[on]] = region[piece[near[on]]]
    return segment


@dataclass(frozen=True)
class Recording:
    """What a scanner recorded of its points, each array (n,), or None where the cloud lacks it."""

    gps_time: Optional[np.ndarray] = None  #: Time of the pulses, s
    scan_angle: Optional[np.ndarray] = None  #: Angles of the beams, °
    point_source_id: Optional[np.ndarray] = None  #: Flight line or scanner
    #: scan_direction_flag, edge_of_flight_line: Direction in which the mirror turns, and whether a point is the last
    #: one before it turns
    scan_direction_flag: Optional[np.ndarray] = None
    edge_of_flight_line: Optional[np.ndarray] = None

    @property
    def evidence(self) -> list[str]:
        """What distinguishes lines, in words; the points themselves always do."""
        known = ["GPS time"] if _varies(self.gps_time) else ["order of the points"]
        recorded = self.scan_direction_flag, self.edge_of_flight_line, self.scan_angle
        named = zip(("scan direction", "edge of flight line", "scan angle"), recorded)
        return known + [name for name, values in named if _varies(values)]

    @property
    def has_times(self) -> bool:
        """Whether the points have times that differ."""
        return _varies(self.gps_time)

    def order(self, xyz: np.ndarray) -> np.ndarray:
        """Return the order (n,) in which points (n, 3) were recorded, source by source.

        Points with one time keep the order of their coordinates; without times all keep the order of the cloud.
        """
        source = np.zeros(len(xyz), np.uint16) if self.point_source_id is None else self.point_source_id
        return np.lexsort((*xyz.T, self.gps_time, source)) if self.has_times else np.argsort(source, kind="stable")

    def take(self, rows: np.ndarray) -> Recording:
        """Return the recording of some points."""
        return Recording(*(None if values is None else values[rows] for values in self.__dict__.values()))


def recorded_lines(xyz: np.ndarray, recording: Recording, gap: float) -> np.ndarray:
    """Return the line (n,) of points (n, 3), m, in the order of their recording, from 0 ascending.

    A line ends where the source changes, or the mirror turns: by its flags, by the scan angle, or by points that turn
    back. It also ends after a pause, and where two points are farther apart than ``gap`` (m).
    """
    starts = np.zeros(len(xyz), bool)
    starts[:1] = True
    starts[1:] |= np.linalg.norm(np.diff(xyz, axis=0), axis=1) > gap
    if recording.point_source_id is not None:
        starts[run_starts(recording.point_source_id)] = True
    if recording.has_times and recording.gps_time is not None:
        starts[1:] |= _is_long(np.diff(recording.gps_time), _PAUSE)
    has_turns = False
    if _varies(recording.scan_direction_flag) and recording.scan_direction_flag is not None:
        starts[run_starts(recording.scan_direction_flag)] = True
        has_turns = True
    if _varies(recording.edge_of_flight_line) and recording.edge_of_flight_line is not None:
        starts[1:] |= recording.edge_of_flight_line[:-1] > 0
    if _varies(recording.scan_angle) and recording.scan_angle is not None:
        starts |= _turns_by_angle(recording.scan_angle)
        has_turns = True
    if not has_turns:
        starts |= _turns_back(xyz)
    return np.cumsum(starts) - 1


def _varies(values: Optional[np.ndarray]) -> bool:
    """Whether there are values (n,) and not all are the same."""
    return values is not None and len(values) > 0 and bool((values != values[0]).any())


def _is_long(step: np.ndarray, factor: float) -> np.ndarray:
    """Return the mask of steps (n,) that are longer than ``factor`` times the median one, zeros left out."""
    size = np.abs(step)
    positive = size[size > 0]
    return size > factor * np.median(positive) if len(positive) else np.zeros(len(step), bool)


def _turns_by_angle(angle: np.ndarray) -> np.ndarray:
    """Return at which points (n,) the scan angle jumps, or begins to grow or to shrink."""
    step = np.diff(angle.astype(float))
    is_jump = _is_long(step, _JUMP)
    trend = np.sign(np.where(is_jump, 0, step))
    changes = np.flatnonzero(trend)
    turned = np.zeros(len(angle), bool)
    turned[1:] = is_jump
    if len(changes):
        # After a jump the trend goes on as before: only changes between two jumps are turns.
        stretch = np.cumsum(is_jump)[changes]
        differs = (np.diff(trend[changes]) != 0) & (np.diff(stretch) == 0)
        # Angles that are equal at the turn, such as rounded ones, are of both lines.
        turned[(changes[:-1] + changes[1:] + 2)[differs] // 2] = True
    return turned


def _turns_back(xyz: np.ndarray) -> np.ndarray:
    """Return the points (n,) at which the way through the points turns back."""
    turned = np.zeros(len(xyz), bool)
    if len(xyz) <= 2 * _STEPS:
        return turned
    middle = slice(_STEPS, len(xyz) - _STEPS)
    before, after = xyz[middle] - xyz[: -2 * _STEPS], xyz[2 * _STEPS :] - xyz[middle]
    length = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    is_back = np.zeros(len(xyz), bool)
    is_back[middle] = np.einsum("ij,ij->i", before, after) < _TURN * length
    # Some points before and after the turn qualify, too: the middle one is the turn.
    first = np.flatnonzero(is_back & ~np.roll(is_back, 1))
    last = np.flatnonzero(is_back & ~np.roll(is_back, -1))
    turned[(first + last + 1) // 2] = True
    return turned
