"""A vehicle with two line scanners on its roof: its drive along a street, and what the beams meet first."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..stage import Monitor
from .beams import Beams
from .drone import DroneWorld, LineScan, bearing, first_met, in_time_order, recorded
from .scene import Scene

# Angle (°) from the perpendicular of the drive to the upright plane in which each scanner turns, positive ahead, by
# scanner number, the source id of its points. As on most mapping vehicles, each scanner sees one side of a recess.
PLANES = {1: 45.0, 2: -45.0}

# Longest distance (m) that the vehicle drives while it sends the pulses that are worked on at once.
_BLOCK_WAY = 1.0

# Distinguishes the random numbers of the drive from other parts of the simulation with the same seed.
_STREAM = 5


@dataclass(frozen=True)
class Drive:
    """A straight drive."""

    start: np.ndarray  #: (3,): where the scanners are at first (m)
    way: np.ndarray  #: (3,): unit vector of the drive
    #: length, speed: m and m/s
    length: float
    speed: float

    def positions(self, time: np.ndarray) -> np.ndarray:
        """Return the positions (n, 3) (m) of the scanners at times (n,) (s)."""
        return self.start + self.speed * time[:, None] * self.way

    def scanned(self, scene: Scene, scan: LineScan, monitor: Monitor) -> dict[str, np.ndarray]:
        """Return the dimensions of a scene scanned on the way by name, in the order of time."""
        world, parts = DroneWorld(scene, scan.max_range), []
        per_turn, n_lines = pulses_per_turn(scan.angular_step), max(1, int(self.length / self.speed * scan.line_rate))
        times = list(scan.times(n_lines, np.arange(per_turn) / per_turn, _BLOCK_WAY / self.speed))
        blocks = [(number, time) for number in PLANES for time in times]
        for i, (number, time) in enumerate(blocks):
            rng = np.random.default_rng([scan.seed, _STREAM, i])
            beams, left = self._pulses(PLANES[number], time, scan.line_rate)
            echoes = first_met(world, beams, rng)
            part = recorded(echoes, left, number, rng)
            part["gps_time"] = time[echoes.pulse]
            # The noise of the range lies along the beam.
            part["xyz"] = beams.at(echoes.pulse, echoes.range + scan.range_noise * rng.standard_normal(len(echoes)))
            parts.append(part)
            monitor.progress((i + 1) / len(blocks))
        return in_time_order(parts)

    def _pulses(self, turn: float, time: np.ndarray, line_rate: float) -> tuple[Beams, np.ndarray]:
        """Return the beams of pulses at times (n,) (s) in a plane turned by ``turn`` (°).

        Further the directions (n, 3) to the left of the vehicle.
        """
        cos, sin = np.cos(np.deg2rad(turn)), np.sin(np.deg2rad(turn))
        left = np.array([-self.way[1], self.way[0], 0.0]) / np.hypot(*self.way[:2])
        ahead = np.array([left[1], -left[0], 0.0])
        across = cos * left + sin * ahead
        # A line begins at the zenith and comes down on the left.
        angle = 2 * np.pi * np.mod(time * line_rate, 1.0)[:, None]
        direction = np.cos(angle) * [0.0, 0.0, 1.0] + np.sin(angle) * across
        aim = np.column_stack(bearing(direction))
        return Beams(np.arange(len(time)), self.positions(time), direction, aim), np.tile(left, (len(time), 1))


def pulses_of(length: float, speed: float, scan: LineScan) -> float:
    """Return how many pulses a drive of a length (m) has at a speed (m/s)."""
    return len(PLANES) * length / speed * scan.line_rate * pulses_per_turn(scan.angular_step)


def pulses_per_turn(angular_step: float) -> int:
    """Return how many pulses a scanner sends in one turn, which is one line."""
    return max(1, int(360.0 / angular_step + 1e-9))
