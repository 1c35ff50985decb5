"""A vehicle with two line scanners on its roof: its drive along a street and the first echoes."""

import itertools
from dataclasses import dataclass

import numpy as np

from ..stage import Monitor
from .beams import Beams
from .drone import Dimensions, LineScan, bearing
from .scene import Scene

# Angle (°) between the vertical scan plane of each scanner and the perpendicular of the drive, positive forward, by
# point source id. As on most mapping vehicles, each scanner sees one side of a recess.
PLANES = {1: 45.0, 2: -45.0}


@dataclass(frozen=True)
class Drive:
    """A straight drive."""

    start: np.ndarray  #: (3,): first position of the scanners (m)
    way: np.ndarray  #: (3,): unit vector of the drive
    #: length, speed: length (m) and speed (m/s) of the drive
    length: float
    speed: float

    def positions(self, time: np.ndarray) -> np.ndarray:
        """Return the positions (n, 3) (m) of the scanners at times (n,) (s)."""
        return self.start + self.speed * time[:, None] * self.way

    def scanned(self, scene: Scene, scan: LineScan, monitor: Monitor) -> Dimensions:
        """Return the dimensions of the points of a scanned scene by name, sorted by time."""
        per_turn, n_lines = pulses_per_turn(scan.angular_step), max(1, int(self.length / self.speed * scan.line_rate))
        # The vehicle drives at most a meter during a block.
        times = list(scan.times(n_lines, np.arange(per_turn) / per_turn, 1.0 / self.speed))
        drawn = itertools.product(PLANES, times)
        blocks = [(number, time, np.random.default_rng([scan.seed, 5, i])) for i, (number, time) in enumerate(drawn)]
        return scan.scanned(scene, self, blocks, monitor)

    def pulses(self, scanner: int, time: np.ndarray, line_rate: float) -> tuple[Beams, np.ndarray]:
        """Return the beams of a scanner at times (n,) (s), and the left axes (n, 3) of the vehicle."""
        turn = np.deg2rad(PLANES[scanner])
        cos, sin = np.cos(turn), np.sin(turn)
        left = np.array([-self.way[1], self.way[0], 0.0]) / np.hypot(*self.way[:2])
        ahead = np.array([left[1], -left[0], 0.0])
        across = cos * left + sin * ahead
        # A scan line starts at the zenith and descends on the left.
        angle = 2 * np.pi * np.mod(time * line_rate, 1.0)[:, None]
        direction = np.cos(angle) * [0.0, 0.0, 1.0] + np.sin(angle) * across
        aim = np.column_stack(bearing(direction))
        return Beams(np.arange(len(time)), self.positions(time), direction, aim), np.tile(left, (len(time), 1))


def pulses_of(length: float, speed: float, scan: LineScan) -> float:
    """Return the number of pulses of a drive with a length (m) and speed (m/s)."""
    return len(PLANES) * length / speed * scan.line_rate * pulses_per_turn(scan.angular_step)


def pulses_per_turn(angular_step: float) -> int:
    """Return the number of pulses of a scan line, a full turn."""
    return max(1, int(360.0 / angular_step + 1e-9))
