"""Scan lines as the scanner recorded them: from times, marks of the line's end, scan angles, or the order of points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.groups import run_starts

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
        names = {
            "scan direction": self.scan_direction_flag,
            "edge of flight line": self.edge_of_flight_line,
            "scan angle": self.scan_angle,
        }
        return known + [name for name, values in names.items() if _varies(values)]

    @property
    def has_times(self) -> bool:
        """Whether the points have times that differ."""
        return _varies(self.gps_time)

    def order(self, xyz: np.ndarray) -> np.ndarray:
        """Return the order (n,) in which points (n, 3) were recorded, source by source.

        Points with one time keep the order of their coordinates; without times all keep the order of the cloud.
        """
        source = np.zeros(len(xyz), np.uint16) if self.point_source_id is None else self.point_source_id
        if not self.has_times:
            return np.argsort(source, kind="stable")
        return np.lexsort((*xyz.T, self.gps_time, source))

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
    """Return whether there are values (n,) and not all are the same."""
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
