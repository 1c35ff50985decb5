"""An airborne laser scanner: strips, scan patterns, and the returns of each pulse."""

from dataclasses import dataclass
from typing import Optional

import numpy as np
from numpy.random import Generator

from ..cloud.asprs import PointClass
from ..stage import Monitor, tunable
from .beams import BEAM_RADIUS, BLOCK, Beams, Echoes, World, is_vegetation, join
from .pairs import in_boxes, rank
from .relief import Relief
from .scene import Scene

# Scan patterns.
PATTERNS = ("lines", "zigzag", "random")

# Dimensions of simulated scans: those that scanners record, and the true class and object.
RECORDED = (
    "xyz",
    "classification",
    "return_number",
    "number_of_returns",
    "intensity",
    "scan_angle",
    "point_source_id",
    "gps_time",
    "segment_id",
)

PULSE_DENSITY = tunable(
    8.0,
    "Mean density of laser pulses. A pulse gives one point on open ground, several in trees, and rarely one on water.",
    label="Pulse density",
    within="[0.5, 100] pulses/m²",
)

RANGE_NOISE = tunable(0.02, "Standard deviation of measured ranges.", within="[0, 0.2] m", advanced=True)

# Most pulses of a scan and points of matched images that fit into the memory of an office computer: a pulse takes about
# 100 bytes, a point about 200.
_MOST = {"pulses": 5e7, "points": 3e7}

# Height of a survey flight over the ground (m).
_HEIGHT = 600.0

# Speed of a survey flight (m/s).
_SPEED = 60.0

# Range resolution (m): the scanner separates echoes at least half the length of a pulse apart.
_DEAD_ZONE = 0.7

# Most returns per pulse.
_MAX_RETURNS = 5

# Reflectance by class.
_REFLECTANCE = np.full(256, 0.3)
_REFLECTANCE[[PointClass.GROUND, PointClass.BUILDING, PointClass.WATER]] = (0.35, 0.45, 0.06)
_REFLECTANCE[[PointClass.LOW_NOISE, PointClass.HIGH_NOISE, PointClass.WIRE_CONDUCTOR]] = 0.05


@dataclass(frozen=True)
class _Strip:
    """A flight line: number, northing (m), bounds of the swath (m north), scan lines, pulses per line."""

    number: int
    y: float
    low: float
    high: float
    n_lines: int
    per_line: int

    @property
    def blocks(self) -> list[np.ndarray]:
        """Numbers of the scan lines that are processed together."""
        step = max(1, BLOCK // self.per_line)
        return [np.arange(line, min(line + step, self.n_lines)) for line in range(0, self.n_lines, step)]


@dataclass(frozen=True)
class AirSurvey:
    """Settings of an airborne survey: tunables of :func:`.simulate_town.simulate_town`."""

    density: float = 8.0  #: Pulses per m²
    pattern: str = "lines"  #: Scan pattern, one of :data:`PATTERNS`
    max_scan_angle: float = 20.0  #: Angle to the vertical at the edge of a strip, °
    overlap: float = 0.3  #: Share of a strip that the next strip overlaps
    range_noise: float = 0.02  #: Standard deviation of ranges, m
    returns: bool = True  #: Whether all returns are recorded
    noise_points: float = 10.0  #: Noise points per hectare
    seed: int = 1  #: The same seed gives the same points


def refuse_many(count: float, what: str, remedy: str, unit: str = "pulses") -> None:
    """Refuse to simulate more pulses or points than fit into memory.

    Parameters
    ----------
    count : float
        Number of pulses or points.
    what : str
        Subject of the message.
    remedy : str
        Advice at the end of the message.
    unit : str
        "pulses" or "points".
    """
    most = _MOST[unit]
    if count > most:
        raise ValueError(f"{what} has {count / 1e6:.0f} million {unit}, more than {most / 1e6:.0f} million; {remedy}.")


def refuse_large(what: str, size: float, density: float, remedy: str, unit: str = "pulses") -> None:
    """Refuse a square site with more pulses or points than fit into memory.

    Parameters
    ----------
    what : str
        Name of the site in the message.
    size : float
        Side of the site, m.
    density : float
        Pulses or points per m².
    remedy : str
        Advice at the end of the message.
    unit : str
        "pulses" or "points".
    """
    refuse_many(density * size**2, f"{what} of {size:g} m with {density:g} {unit} per m²", remedy, unit)


def scan(scene: Scene, survey: AirSurvey, monitor: Optional[Monitor] = None) -> dict[str, np.ndarray]:
    """Scan a scene from the air; return the dimensions of the points by name, sorted by time, then by return.

    In addition to :data:`RECORDED` there is ``pulse``, the number of the pulse. The same scene and survey give the same
    points.
    """
    monitor = monitor or Monitor()
    rng = np.random.default_rng([survey.seed, 1])
    world = World(scene)
    blocks = [(strip, lines) for strip in _strips(scene.relief, survey) for lines in strip.blocks]
    firsts = np.cumsum([0] + [len(lines) * strip.per_line for strip, lines in blocks])
    noisy, heights = _noise(int(firsts[-1]), round(survey.noise_points * scene.size**2 / 1e4), rng)
    parts = []
    for i, (strip, lines) in enumerate(blocks):
        pulses, time = _pulses(world.relief, strip, lines, survey.pattern, rng)
        first, last = np.searchsorted(noisy, firsts[i : i + 2])
        noise = _noise_echoes(world, pulses.take(noisy[first:last] - firsts[i]), heights[first:last])
        echoes = _replaced(_recorded_echoes(world, pulses, strip, survey.returns, rng), noise)
        # Range noise is along the beam.
        ranges = echoes.range + survey.range_noise * rng.standard_normal(len(echoes))
        # Scan angles are negative to the left of the flight; odd strips are flown to the east.
        angle = np.rad2deg(np.arctan2(echoes.direction[:, 1], -echoes.direction[:, 2]))
        angle *= -1 if strip.number % 2 else 1
        part = recorded(echoes, time, angle, strip.number, rng, survey.returns)
        part["xyz"] = pulses.origin[echoes.pulse] + ranges[:, None] * echoes.direction
        part["pulse"] = echoes.pulse + firsts[i]
        parts.append(part)
        monitor.progress((i + 1) / len(blocks))
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _strips(relief: Relief, survey: AirSurvey) -> list[_Strip]:
    """Return the flight lines, alternately east and west, so that two of them overlap in the middle of the town."""
    tangent, rise = np.tan(np.deg2rad(survey.max_scan_angle)), relief.plane_gradient[1]
    # On a slope the swath is narrower on the uphill side.
    up, down = _HEIGHT * tangent / (1 + rise * tangent), _HEIGHT * tangent / (1 - rise * tangent)
    spacing = (up + down) * (1 - survey.overlap)
    start = (relief.size + spacing + down - up) / 2
    numbers = np.arange(np.floor(-(start + up) / spacing), np.ceil((relief.size + down - start) / spacing) + 1)
    swaths = [(float(y), max(0.0, y - down), min(relief.size, y + up)) for y in start + numbers * spacing]
    swaths = [(y, low, high) for y, low, high in swaths if low < high]
    # Overlaps have more pulses than the rest, as in every survey.
    cell = sum(high - low for _, low, high in swaths) / relief.size / survey.density
    strips = []
    for number, (y, low, high) in enumerate(swaths, start=1):
        per_line = max(1, round((high - low) / np.sqrt(cell)))
        strips.append(_Strip(number, y, low, high, round(relief.size * (high - low) / cell / per_line), per_line))
    return strips


def _pulses(relief: Relief, strip: _Strip, lines: np.ndarray, pattern: str, rng: Generator) -> tuple[Beams, np.ndarray]:
    """Return the beams of scan lines, aimed at the mean plane of the ground, and their times (s)."""
    size, per_line = relief.size, strip.per_line
    line = np.repeat(lines, per_line)
    share = np.tile((np.arange(per_line) + 0.5) / per_line, len(lines))
    ahead: np.ndarray = line + share
    if pattern == "random":
        forth = ahead = np.sort(lines[0] + len(lines) * rng.random(len(line)))
        across = rng.random(len(line))
    elif pattern == "zigzag":
        forth, across = ahead, np.where(line % 2 == 0, share, 1 - share)
    else:  # "lines"
        # Pulses of neighboring lines have different phases.
        phase = np.repeat(rng.random(len(lines)) - 0.5, per_line) / per_line
        forth, across = line + 0.5, share + phase
    way, x = ahead * size / strip.n_lines, forth * size / strip.n_lines
    x = x if strip.number % 2 else size - x
    aim = np.column_stack([x, strip.low + across * (strip.high - strip.low)])
    # The turn between two strips takes five minutes.
    time = (strip.number - 1) * (size / _SPEED + 300.0) + way / _SPEED
    origin = np.column_stack([x, np.full(len(x), strip.y), relief.plane(x, strip.y) + _HEIGHT])
    return _aimed(relief, np.arange(len(x)), origin, aim), time


def _aimed(relief: Relief, pulse: np.ndarray, origin: np.ndarray, aim: np.ndarray) -> Beams:
    """Return the beams from points (n, 3) to positions (n, 2) on the mean plane of the ground."""
    direction = np.column_stack([aim, relief.plane(*aim.T)]) - origin
    return Beams(pulse, origin, direction / np.linalg.norm(direction, axis=1)[:, None], aim)


def _beside(relief: Relief, beams: Beams, rng: Generator) -> Beams:
    """Return for each beam a ray to a random position in its footprint on the ground."""
    turn, out = rng.uniform(0.0, 2 * np.pi, len(beams)), BEAM_RADIUS * np.sqrt(rng.random(len(beams)))
    shift = np.column_stack([out * np.cos(turn), out * np.sin(turn)])
    return _aimed(relief, beams.pulse, beams.origin, beams.aim + shift)


def _met(world: World, kind: str, beams: Beams, strip: _Strip) -> tuple[np.ndarray, np.ndarray]:
    """Return the candidate pairs (beam, object): beams aimed into the shadow of the object's bounding box."""
    low, high = world.boxes(kind)
    corners = np.stack([low, high])
    planes = world.relief.plane(corners[:, None, :, 0], corners[None, :, :, 1]).reshape(4, -1)
    # Least and greatest height (m) of each box over the plane. Rays from the scanner past the edges of the box at these
    # heights meet the plane at the northings ``shadow`` (m).
    lift = np.stack([low[:, 2] - planes.max(axis=0), high[:, 2] - planes.min(axis=0)])
    shadow = strip.y + (corners[:, None, :, 1] - strip.y) * _HEIGHT / (_HEIGHT - lift[None])
    shadow = shadow.reshape(4, -1)
    near, far = np.column_stack([low[:, 0], shadow.min(axis=0)]), np.column_stack([high[:, 0], shadow.max(axis=0)])
    return in_boxes(beams.aim, near - BEAM_RADIUS, far + BEAM_RADIUS)


def _recorded_echoes(world: World, pulses: Beams, strip: _Strip, returns: bool, rng: Generator) -> Echoes:
    """Return the echoes of ``pulses`` that the scanner records, by pulse, then by range."""
    beam, solid = _met(world, "solids", pulses, strip)
    ends = world.surfaces(pulses, beam, solid)
    leaves = world.leaves(pulses, *_met(world, "crowns", pulses, strip), rng)
    porous = join([leaves, world.strands(pulses, *_met(world, "wires", pulses, strip), rng)])
    porous = porous.take(porous.range < ends.range[porous.pulse])
    # Near solids, such as at the edge of a roof, a second ray within the beam adds an echo if it ends elsewhere.
    beside = _beside(world.relief, pulses.take(np.unique(beam)), rng)
    others = world.surfaces(beside, *_met(world, "solids", beside, strip))
    others = others.take(np.abs(others.range - ends.range[others.pulse]) > _DEAD_ZONE)
    echoes = join([porous, ends, others]).in_order()
    kept = _separate(echoes, len(pulses), rng) if returns else rank(echoes.pulse) == 0
    # Water reflects like a mirror: it returns a quarter of vertical pulses, and 1/e of that at 12° to the vertical.
    slant = np.arccos(-echoes.direction[:, 2])
    lost = rng.random(len(echoes)) > 0.25 * np.exp(-((slant / np.deg2rad(12.0)) ** 2))
    return echoes.take(kept & ~((echoes.classification == PointClass.WATER) & lost))


def _separate(echoes: Echoes, n_pulses: int, rng: Generator) -> np.ndarray:
    """Return the mask of sorted echoes that a scanner separates until the energy of the pulse is used up."""
    pulse = echoes.pulse
    number = rank(pulse)
    # Behind a leaf 70 % of the pulses continue.
    goes_on = ~is_vegetation(echoes.classification) | (rng.random(len(echoes)) < 0.7)
    kept = np.zeros(len(echoes), bool)
    last, recorded = np.full(n_pulses, -np.inf), np.zeros(n_pulses, np.int64)
    for k in range(int(number.max()) + 1):
        at = np.flatnonzero(number == k)
        at = at[(echoes.range[at] - last[pulse[at]] > _DEAD_ZONE) & (recorded[pulse[at]] < _MAX_RETURNS)]
        kept[at] = True
        # A pulse that does not continue is used up.
        recorded[pulse[at]] += np.where(goes_on[at], 1, _MAX_RETURNS)
        last[pulse[at]] = echoes.range[at]
    return kept


def _noise(n_pulses: int, n_noise: int, rng: Generator) -> tuple[np.ndarray, np.ndarray]:
    """Return the sorted indices of noise pulses and their heights (m) above ground: birds and multipath."""
    which = np.sort(rng.choice(n_pulses, n_noise, replace=False, shuffle=False))
    is_bird = rng.permutation(n_noise) % 2 == 0
    return which, np.where(is_bird, rng.uniform(30.0, 120.0, n_noise), -rng.uniform(2.0, 15.0, n_noise))


def _noise_echoes(world: World, pulses: Beams, height: np.ndarray) -> Echoes:
    """Return the echoes of noise pulses at heights (m) above ground: birds and multipath."""
    ranges = world.ground(pulses) + height / pulses.direction[:, 2]
    classes = np.where(height > 0, PointClass.HIGH_NOISE, PointClass.LOW_NOISE)
    return pulses.echoes(slice(None), ranges, classes, np.zeros(len(pulses)))


def _replaced(echoes: Echoes, noise: Echoes) -> Echoes:
    """Return the echoes by pulse; echoes of noise pulses are replaced."""
    merged = join([echoes.take(~np.isin(echoes.pulse, noise.pulse)), noise])
    return merged.take(np.argsort(merged.pulse, kind="stable"))


def recorded(
    echoes: Echoes, time: np.ndarray, angle: np.ndarray, source: int, rng: Generator, returns: bool = True
) -> dict[str, np.ndarray]:
    """Return the dimensions of echoes, sorted by pulse, except their positions.

    Parameters
    ----------
    echoes : Echoes
        The echoes.
    time : ndarray
        Time of each pulse, s.
    angle : ndarray of shape (n,)
        Scan angle of each echo, °.
    source : int
        Point source id.
    rng : numpy.random.Generator
        Source of random numbers.
    returns : bool
        Whether the numbers of returns are known.
    """
    count = np.bincount(echoes.pulse, minlength=len(time))[echoes.pulse]
    return {
        "classification": echoes.classification,
        "return_number": (rank(echoes.pulse) + 1).astype(np.uint8) * np.uint8(returns),
        "number_of_returns": count.astype(np.uint8) * np.uint8(returns),
        "intensity": _brightness(echoes, count, rng),
        "scan_angle": angle.astype(np.float32),
        "point_source_id": np.full(len(echoes), source, np.uint16),
        "gps_time": time[echoes.pulse],
        "segment_id": echoes.object_id,
    }


def _brightness(echoes: Echoes, count: np.ndarray, rng: Generator) -> np.ndarray:
    """Return the intensity (n,), uint16, by material; the ``count`` returns of a pulse share its energy."""
    # Each object is up to 30 % brighter or darker: steps of the golden ratio distribute object ids evenly.
    bright = _REFLECTANCE[echoes.classification] * (0.7 + 0.6 * np.modf(echoes.object_id * 0.618034)[0])
    # A perfect reflector has 60,000, so that the brightest roofs stay below 65,535; the speckle is 8 %.
    return np.clip(60_000 * bright / count * (1 + 0.08 * rng.standard_normal(len(echoes))), 1, 65_535).astype(np.uint16)
