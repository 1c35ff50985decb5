"""A drone with two line scanners: its flight, its beams and their first echoes."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..stage import Monitor, tunable
from .beams import BLOCK, Beams, Echoes, World, join
from .bodies import dot
from .pairs import in_boxes
from .scanner import recorded
from .scene import Scene
from .street_site import SIZE

LINE_RATE = tunable(40.0, "Scan lines of each scanner.", within="[1, 500] 1/s", advanced=True)

ANGULAR_STEP = tunable(0.25, "Angle between neighboring beams of a scanner.", within="[0.02, 5]°", advanced=True)

# Point source id of each scanner.
SCANNERS = {"horizontal": 1, "vertical": 2}

# Field of view of a scanner (°): all but the quarter behind it.
FIELD = 270.0

# Height of the scanners over the ground before take-off (m).
_STANDING = 0.4

# Share of the flight spent on the climb, and on the landing; in between the drone makes one turn.
_CLIMB = 0.2

# Periods of the deviations from the path due to wind and control (s).
_PERIODS = (3.1, 5.3, 11.7)

# Dimensions of points by name.
Dimensions = dict[str, np.ndarray]

# Returns the beams of a scanner at times (n,) (s), at a line rate (1/s), and the left axes (n, 3) of its platform.
Pulses = Callable[[int, np.ndarray, float], tuple[Beams, np.ndarray]]

# Pulses that are scanned together: point source id of the scanner, times (n,) (s), source of random numbers.
Block = tuple[int, np.ndarray, np.random.Generator]


@dataclass(frozen=True)
class LineScan:
    """Settings of line scanners with a rotating mirror that record the first echo."""

    line_rate: float  #: Scan lines per second
    angular_step: float  #: Angle between pulses, °
    max_range: float  #: Maximum range, m
    range_noise: float  #: Standard deviation of ranges, m
    seed: int  #: The same seed gives the same points

    def times(self, n_lines: int, pulses: np.ndarray, most: float) -> Iterator[np.ndarray]:
        """Yield the times (s) of the pulses, in blocks of whole scan lines of at most ``most`` (s).

        Each turn of the mirror is a scan line; ``pulses`` (k,) are the times of its pulses as shares of a turn.
        """
        step = max(1, min(BLOCK // len(pulses), int(most * self.line_rate)))
        for line in range(0, n_lines, step):
            yield (np.arange(line, min(line + step, n_lines))[:, None] + pulses).ravel() / self.line_rate

    def scanned(self, scene: Scene, pulses: Pulses, blocks: Sequence[Block], monitor: Monitor) -> Dimensions:
        """Return the dimensions of the points by name, sorted by time, of a scene scanned from a platform."""
        world, parts = DroneWorld(scene, self.max_range), []
        for i, (scanner, time, rng) in enumerate(blocks):
            beams, left = pulses(scanner, time, self.line_rate)
            echoes = first_met(world, beams, rng)
            nadir = np.rad2deg(np.arccos(np.clip(-echoes.direction[:, 2], -1.0, 1.0)))
            angle = np.where(dot(echoes.direction, left[echoes.pulse]) > 0, -nadir, nadir)
            part = recorded(echoes, time, angle, scanner, rng)
            # Range noise is along the beam.
            part["xyz"] = beams.at(echoes.pulse, echoes.range + self.range_noise * rng.standard_normal(len(echoes)))
            parts.append(part)
            monitor.progress((i + 1) / len(blocks))
        made = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        order = np.argsort(made["gps_time"], kind="stable")
        return {name: values[order] for name, values in made.items()}


@dataclass(frozen=True)
class Flight:
    """Position and attitude of a drone over time: it climbs, turns once and lands."""

    foot: np.ndarray  #: (3,): position of the scanners before take-off (m)
    climb: float  #: Height of the climb (m)
    duration: float  #: Time from take-off to landing (s)
    phases: np.ndarray  #: (6, 3): phases (rad) of the sway: east, north, up, roll, pitch, heading

    def positions(self, time: np.ndarray) -> np.ndarray:
        """Return the positions (n, 3) (m) of the scanners at times (n,) (s)."""
        share = time / self.duration
        # The largest deviation is 0.3 m.
        made = self.foot + 0.3 * self._sway(time, slice(0, 3))
        made[:, 2] += self.climb * np.clip(np.minimum(share, 1 - share) / _CLIMB, 0.0, 1.0)
        return made

    def axes(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the forward, left and up axes of the drone, (n, 3) each, at times (n,) (s)."""
        turn = np.clip((time / self.duration - _CLIMB) / (1 - _CLIMB - _CLIMB), 0.0, 1.0)
        # The largest deviation is 2° from level, and 0.5° from the heading.
        roll, pitch, yaw = np.deg2rad([2.0, 2.0, 0.5])[:, None] * self._sway(time, slice(3, 6)).T
        yaw = yaw + 2 * np.pi * turn
        (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
        forward = np.column_stack([cy * cp, sy * cp, -sp])
        left = np.column_stack([cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr])
        return forward, left, np.cross(forward, left)

    def _sway(self, time: np.ndarray, which: slice) -> np.ndarray:
        """Return the deviations (n, 3) at times (n,), as shares of the largest, -1 to 1."""
        waves = np.sin(2 * np.pi * time[:, None, None] / np.array(_PERIODS) + self.phases[which]).mean(axis=-1)
        # Deviations grow within 2 s after take-off, and fade before landing.
        return waves * np.clip(np.minimum(time, self.duration - time) / 2.0, 0.0, 1.0)[:, None]

    def scanned(self, scene: Scene, scanners: tuple[str, ...], scan: LineScan, monitor: Monitor) -> Dimensions:
        """Return the dimensions of the points by name, sorted by time, of a scene scanned by ``scanners``."""
        pulses = np.arange(pulses_per_line(scan.angular_step)) * (scan.angular_step / 360.0)
        # In a second the drone does not move far.
        times = list(scan.times(int(self.duration * scan.line_rate), pulses, 1.0))
        rngs = {name: np.random.default_rng([scan.seed, 4, SCANNERS[name]]) for name in scanners}
        blocks = [(SCANNERS[name], time, rngs[name]) for name in scanners for time in times]
        return scan.scanned(scene, self.pulses, blocks, monitor)

    def pulses(self, scanner: int, time: np.ndarray, line_rate: float) -> tuple[Beams, np.ndarray]:
        """Return the beams of a scanner at times (n,) (s), and the left axes (n, 3) of the drone."""
        forward, left, up = self.axes(time)
        angle = np.deg2rad(np.mod(time * line_rate, 1.0) * 360.0 - FIELD / 2)[:, None]
        ahead = forward if scanner == SCANNERS["horizontal"] else -up
        direction = np.cos(angle) * ahead + np.sin(angle) * left
        return Beams(np.arange(len(time)), self.positions(time), direction, np.column_stack(bearing(direction))), left


def plan_flight(scene: Scene, height: float, duration: float, seed: int) -> Flight:
    """Return a flight over the middle of a site.

    Parameters
    ----------
    scene : Scene
        The site.
    height : float
        Greatest height over the ground without sway, m.
    duration : float
        Duration, s.
    seed : int
        The same seed gives the same flight.
    """
    # The drone takes off in the street, a little off the middle of the site.
    x, y = SIZE / 2 + 0.8, SIZE / 2 + 3.0
    foot = np.array([x, y, float(scene.relief.ground(x, y)) + _STANDING])
    phases = np.random.default_rng([seed, 3]).uniform(0.0, 2 * np.pi, (6, len(_PERIODS)))
    return Flight(foot, height - _STANDING, duration, phases)


class DroneWorld(World):
    """A scene for beams in all directions; its ground is a plane."""

    def __init__(self, scene: Scene, reach: float) -> None:
        super().__init__(scene)
        self.reach = reach
        # The wide beams of small scanners meet the next leaf after 30 % of the mean path of a thin beam.
        self.crowns[:, 5] *= 0.3

    def ground(self, beams: Beams) -> np.ndarray:
        """Return the ranges (n,) (m) at which beams meet the ground, twice the reach for those that do not."""
        x, y, z = beams.origin.T
        height = z - self.relief.plane(x, y)
        east, north = self.relief.plane_gradient
        x, y, z = beams.direction.T
        sinking = east * x + north * y - z
        # Level and rising beams never meet the ground; a range out of reach excludes them.
        return np.where(sinking * self.reach > height, height / np.where(sinking > 0, sinking, 1.0), 2 * self.reach)

    def met(self, kind: str, beams: Beams) -> tuple[np.ndarray, np.ndarray]:
        """Return the candidate pairs (beam, object): beams toward the sphere around the object's bounding box."""
        low, high = self.boxes(kind)
        middle = beams.origin.mean(axis=0)
        away = (low + high) / 2 - middle
        radius = np.linalg.norm(high - low, axis=1) / 2 + np.linalg.norm(beams.origin - middle, axis=1).max()
        distance = np.linalg.norm(away, axis=1)
        near = np.flatnonzero(distance - radius < self.reach)
        middles = np.column_stack(bearing(away[near]))
        half = _half_widths(middles[:, 1], radius[near], distance[near])
        # Azimuths are periodic.
        turn = np.repeat([-2 * np.pi, 0.0, 2 * np.pi], len(near))[:, None] * [1.0, 0.0]
        middles, half = np.tile(middles, (3, 1)) + turn, np.tile(half, (3, 1))
        beam, target = in_boxes(beams.aim, middles - half, middles + half)
        return beam, np.tile(near, 3)[target]


def bearing(direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return azimuth from east and elevation (rad) of vectors (n, 3) of any length."""
    x, y, z = direction.T
    return np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))


def _half_widths(elevation: np.ndarray, radius: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Return half the angular extents (n, 2) of spheres in azimuth and elevation (rad)."""
    half = np.arcsin(np.minimum(radius / distance, 1.0))
    high = np.where(radius < distance, half, np.pi)
    # Spheres around the zenith, the nadir or the drone extend over all azimuths.
    share = np.sin(half) / np.maximum(np.cos(elevation), 1e-9)
    wide = np.where(np.abs(elevation) + high < np.pi / 2, np.arcsin(np.minimum(share, 1.0)), np.pi)
    return np.column_stack([wide, high])


def pulses_per_line(angular_step: float) -> int:
    """Return the number of pulses in the field of view, one per ``angular_step`` (°)."""
    return int(FIELD / angular_step + 1e-9) + 1


def first_met(world: DroneWorld, beams: Beams, rng: np.random.Generator) -> Echoes:
    """Return the first echo of each beam within reach, in the order of the beams."""
    ends = world.surfaces(beams, *world.met("solids", beams))
    echoes = join([ends, world.leaves(beams, *world.met("crowns", beams), rng)])
    # The minimum range is 0.1 m, as in data sheets.
    return echoes.take((echoes.range > 0.1) & (echoes.range < world.reach)).first()
