"""Layout of a simulated plant: racks of pipes, tanks, spheres and clutter in bays with aisles between.

Each part has surfaces, which are scanned.
"""

from dataclasses import dataclass, field
from typing import Callable, Optional

import numpy as np

from ..geometry.polygons import axes_across
from ..shapes.searched_points import Shape

# Distance between the centers of bays (m): a rack and an aisle.
PITCH = 10.0

# Greatest length of the pipes of a rack (m), a common delivery length.
_LENGTH = 6.0

# Heights of the levels of a rack (m).
_LEVELS = (1.2, 2.4, 3.6)

# Width of a rack (m).
_WIDTH = 4.6

# The direction of the zenith.
_UP = np.array([0.0, 0.0, 1.0])

# Draws positions (k, 3) and outward normals (k, 3) of k random points on a surface.
Sampler = Callable[[np.random.Generator, int], tuple[np.ndarray, np.ndarray]]

# Distance between the bars of a grating (m).
_MESH = 0.04

# Height and thickness of the bars of a grating (m).
_BAR = (0.03, 0.004)


@dataclass(frozen=True)
class PlantPart:
    """One surface of a plant."""

    kind: str  #: "pipe", "tank", "sphere", "elbow", "flange", "beam", "grating", "roof", "floor" or "clutter"
    shape: int  #: Value of the dimension ``shape``
    area: float  #: Area, m²
    middle: np.ndarray  #: (3,): center (m)
    sample: Sampler  #: Draws points on the surface
    #: (2, 3): ends of the axis of a pipe or tank, or the center of a sphere in both rows (m)
    axis: Optional[np.ndarray] = None
    radius: float = 0.0  #: Radius of a pipe, tank or sphere (m), otherwise 0


def cylinder(kind: str, start: np.ndarray, end: np.ndarray, radius: float) -> PlantPart:
    """Return the lateral surface of a cylinder.

    Parameters
    ----------
    kind : str
        Kind of the part.
    start, end : ndarray of shape (3,)
        Centers of both ends, m.
    radius : float
        Radius, m.
    """
    length = float(np.linalg.norm(end - start))
    axis = (end - start) / length
    first, second = axes_across(axis)

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        angle = rng.uniform(0, 2 * np.pi, count)[:, None]
        away = np.cos(angle) * first + np.sin(angle) * second
        return start + rng.uniform(0, length, count)[:, None] * axis + radius * away, away

    shape = Shape.NONE if kind == "flange" else Shape.CYLINDER
    ends = np.array([start, end])
    return PlantPart(kind, shape, 2 * np.pi * radius * length, ends.mean(axis=0), sample, ends, radius)


def disk(kind: str, center: np.ndarray, normal: np.ndarray, inner: float, outer: float) -> PlantPart:
    """Return a disk or an annulus.

    Parameters
    ----------
    kind : str
        Kind of the part.
    center : ndarray of shape (3,)
        Center, m.
    normal : ndarray of shape (3,)
        Unit normal.
    inner, outer : float
        Radii, m.
    """
    first, second = axes_across(normal)

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        angle = rng.uniform(0, 2 * np.pi, count)[:, None]
        reach = np.sqrt(rng.uniform(inner**2, outer**2, count))[:, None]
        positions = center + reach * (np.cos(angle) * first + np.sin(angle) * second)
        return positions, np.broadcast_to(normal, positions.shape)

    shape = Shape.PLANE if kind == "roof" else Shape.NONE
    return PlantPart(kind, shape, float(np.pi * (outer**2 - inner**2)), center, sample)


def sphere(center: np.ndarray, radius: float) -> PlantPart:
    """Return a sphere with a center (3,) and radius, m."""

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        away = rng.normal(size=(count, 3))
        away /= np.linalg.norm(away, axis=1)[:, None]
        return center + radius * away, away

    return PlantPart("sphere", Shape.SPHERE, 4 * np.pi * radius**2, center, sample, np.array([center, center]), radius)


def elbow(start: np.ndarray, along: np.ndarray, toward: np.ndarray, bend: float, radius: float) -> PlantPart:
    """Return a quarter of a torus that connects two perpendicular pipes.

    Parameters
    ----------
    start : ndarray of shape (3,)
        End of the first pipe (m).
    along, toward : ndarray of shape (3,)
        Directions of the first and second pipe, unit vectors.
    bend, radius : float
        Radii of the bent axis and of the pipe, m.
    """
    center, side = start + bend * toward, np.cross(along, toward)

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        # The outside of a bend is longer: rejection sampling by area, from three times as many points as needed.
        turn, around, keep = rng.uniform(0, 1, (3, 3 * count))
        turn, around = turn * np.pi / 2, around * 2 * np.pi
        kept = np.flatnonzero(keep * (bend + radius) <= bend + radius * np.cos(around))[:count]
        turn, around = turn[kept, None], around[kept, None]
        outward = np.sin(turn) * along - np.cos(turn) * toward
        away = np.cos(around) * outward + np.sin(around) * side
        return center + bend * outward + radius * away, away

    return PlantPart("elbow", Shape.NONE, float(np.pi**2 * bend * radius), center, sample)


def plate(kind: str, corner: np.ndarray, first: np.ndarray, second: np.ndarray) -> PlantPart:
    """Return a thin plate, visible from both sides.

    Parameters
    ----------
    kind : str
        Kind of the part.
    corner, first, second : ndarray of shape (3,)
        A corner and the edges from it, m.
    """
    across = np.cross(first, second)
    area = float(np.linalg.norm(across))
    normal = across / area

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        share = rng.uniform(0, 1, (count, 2))
        side = np.where(rng.random(count) < 0.5, 1.0, -1.0)[:, None]
        # A plate is a centimeter thick.
        return corner + share[:, :1] * first + share[:, 1:] * second + 0.005 * side * normal, side * normal

    return PlantPart(kind, Shape.PLANE, 2 * area, corner + (first + second) / 2, sample)


def beam(start: np.ndarray, end: np.ndarray, height: float, width: float, up: np.ndarray) -> list[PlantPart]:
    """Return the web and the two flanges of an I-beam.

    Parameters
    ----------
    start, end : ndarray of shape (3,)
        Centers of both ends, m.
    height, width : float
        Height of the profile and width of the flanges, m.
    up : ndarray of shape (3,)
        Direction of the web.
    """
    along = end - start
    side = np.cross(along, up)
    side *= width / np.linalg.norm(side)
    rise = up * height
    web = plate("beam", start - rise / 2, along, rise)
    return [web, *(plate("beam", start + sign * rise / 2 - side / 2, along, side) for sign in (-1, 1))]


def grating(corner: np.ndarray, first: np.ndarray, second: np.ndarray) -> PlantPart:
    """Return a level grating from a corner (3,) along two edges (3,), m: upright bars with gaps."""
    long, wide = float(np.linalg.norm(first)), float(np.linalg.norm(second))
    n_bars, (high, thick) = max(1, int(wide / _MESH)), _BAR

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        along = rng.uniform(0, 1, count)[:, None]
        bar = (rng.integers(0, n_bars, count) / n_bars)[:, None]
        down = rng.uniform(0, high, count)[:, None]
        side = np.where(rng.random(count) < 0.5, 1.0, -1.0)[:, None]
        positions = corner + along * first + bar * second + thick / 2 * side * second / wide - down * _UP
        return positions, side * second / wide

    return PlantPart("grating", Shape.NONE, 2 * n_bars * long * high, corner + (first + second) / 2, sample)


def heap(center: np.ndarray, size: float) -> PlantPart:
    """Return clutter in a ball of radius ``size`` (m): surfaces with random normals, like hoses and bushes."""

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        away, normal = rng.normal(size=(2, count, 3))
        away *= size * np.cbrt(rng.random((count, 1))) / np.linalg.norm(away, axis=1)[:, None]
        return center + away, normal / np.linalg.norm(normal, axis=1)[:, None]

    return PlantPart("clutter", Shape.NONE, 4 * np.pi * size**2, center, sample)


@dataclass
class Plant:
    """Parts of a plant, and the positions (3,), m, of the scanner's stations."""

    parts: list[PlantPart] = field(default_factory=list)
    stations: list[np.ndarray] = field(default_factory=list)


def build_plant(pipes: int, tanks: int, spheres: int, clutter: bool, rng: np.random.Generator) -> Plant:
    """Return a plant with straight pipes, tanks and spherical vessels.

    Parameters
    ----------
    pipes, tanks, spheres : int
        Numbers of straight pipes, of tanks and of spherical vessels.
    clutter : bool
        Whether to add beams, gratings and heaps.
    rng : numpy.random.Generator
        Source of random numbers.
    """
    plant, bay, remaining = Plant(), 0, pipes
    # With about 35 pipes per rack, there are about four times as many columns of bays as rows.
    columns = max(1, int(np.ceil(np.sqrt(max(1, pipes / 9)))))
    while remaining > 0:
        corner = np.array([bay % columns, bay // columns, 0.0]) * PITCH
        remaining -= _rack(plant, corner + PITCH / 2 * np.array([1.0, 1.0, 0.0]), remaining, clutter, rng)
        _stations(plant, corner)
        bay += 1
    width, depth = columns * PITCH, int(np.ceil(bay / columns)) * PITCH
    west = min(-2.0, _tanks(plant, tanks, depth, rng))
    _spheres(plant, spheres, width, rng)
    east = width + 2.0 + 6.0 * (spheres > 0)
    sides = np.array([east - west, 0.0, 0.0]), np.array([0.0, depth + 4.0, 0.0])
    plant.parts.append(plate("floor", np.array([west, -2.0, 0.0]), *sides))
    return plant


def _rack(plant: Plant, middle: np.ndarray, most: int, clutter: bool, rng: np.random.Generator) -> int:
    """Add a rack with at most ``most`` pipes; return their number."""
    turn = rng.uniform(0, np.pi)
    along, across = np.array([np.cos(turn), np.sin(turn), 0.0]), np.array([-np.sin(turn), np.cos(turn), 0.0])
    made = 0
    for level, height in enumerate(_LEVELS):
        at = -_WIDTH / 2
        while made < most:
            # Pipes have diameters of 5 to 60 cm and gaps of 15 to 50 cm.
            diameter, gap = float(np.exp(rng.uniform(*np.log((0.05, 0.6))))), float(rng.uniform(0.15, 0.5))
            if at + diameter > _WIDTH / 2:
                break
            center = middle + (at + diameter / 2) * across + height * _UP
            made += _pipe_run(plant, center, along, diameter / 2, level, most - made, rng)
            at += diameter + gap
    if clutter:
        _frame(plant, middle, along, across)
        plant.parts.append(heap(middle + 3.4 * across + 0.3 * _UP, 0.3))
    return made


def _pipe_run(
    plant: Plant, center: np.ndarray, along: np.ndarray, radius: float, level: int, most: int, rng: np.random.Generator
) -> int:
    """Add a pipe, possibly with a flange and an elbow to a second pipe up or down; return the number of pipes."""
    # Some pipes have a slope of up to 5 %.
    along = along + rng.choice([0.0, 0.0, rng.uniform(-0.05, 0.05)]) * _UP
    along /= np.linalg.norm(along)
    low, high = -_LENGTH / 2 + rng.uniform(0, 0.5), _LENGTH / 2 - rng.uniform(0, 0.5)
    start, end = center + low * along, center + high * along
    plant.parts.append(cylinder("pipe", start, end, radius))
    # Of the pipes 30 % have a flange.
    if rng.random() < 0.3:
        at, wide, thick = start + rng.uniform(0.3, 0.7) * (end - start), radius * 1.4 + 0.02, 0.02 + 0.1 * radius
        plant.parts.append(cylinder("flange", at - thick * along, at + thick * along, wide))
        plant.parts += [disk("flange", at + sign * thick * along, sign * along, radius, wide) for sign in (-1, 1)]
    # The common long-radius elbow has a radius of 1.5 pipe diameters.
    bend = 2 * 1.5 * radius
    # Of the pipes of the lowest and highest level 60 % turn down or up at their end.
    if level == 1 or most < 2 or rng.random() > 0.6:
        return 1
    side = np.cross(along, np.cross(_UP, along))
    toward = side / np.linalg.norm(side) * (1.0 if level else -1.0)
    length = float(rng.uniform(1.0, 2.5)) if level else float(end[2] - bend - 0.05)
    if length < max(0.4, 4 * radius):
        return 1
    plant.parts.append(elbow(end, along, toward, bend, radius))
    first = end + bend * (along + toward)
    plant.parts.append(cylinder("pipe", first, first + length * toward, radius))
    return 2


def _frame(plant: Plant, middle: np.ndarray, along: np.ndarray, across: np.ndarray) -> None:
    """Add the columns and beams of a rack, and a grating next to it."""
    for share in (-0.35, 0.35):
        position = middle + share * _LENGTH * along
        for side in (-1, 1):
            foot = position + side * (_WIDTH / 2 + 0.3) * across
            plant.parts += beam(foot, foot + 4.2 * _UP, 0.2, 0.2, along)
        for height in _LEVELS:
            # Beams lie under the widest pipe.
            first, last = (position + sign * (_WIDTH / 2 + 0.2) * across + (height - 0.45) * _UP for sign in (-1, 1))
            plant.parts += beam(first, last, 0.2, 0.15, _UP)
    corner = middle - 0.4 * _LENGTH * along + (_WIDTH / 2 + 0.5) * across + 1.0 * _UP
    plant.parts.append(grating(corner, 0.8 * _LENGTH * along, 0.8 * across))


def _stations(plant: Plant, corner: np.ndarray) -> None:
    """Add stations at the four corners of a bay, alternately low and high, unless they exist already."""
    for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)):
        position = corner + PITCH * np.array([i, j, 0.0])
        high = round(position[0] / PITCH + position[1] / PITCH) % 2
        position = position + (5.5 if high else 1.7) * _UP
        if not any(np.allclose(position, other) for other in plant.stations):
            plant.stations.append(position)


def _tanks(plant: Plant, count: int, depth: float, rng: np.random.Generator) -> float:
    """Add tanks west of the racks with stations around them; return the easting (m) of their western end."""
    edge = -4.0
    for number in range(count):
        # Diameters are from 5 to 30 m.
        share = number / (count - 1) if count > 1 else 0.3
        radius = float(np.exp(np.log(5.0) + share * np.log(30.0 / 5.0))) / 2
        height = float(rng.uniform(0.6, 0.9) * min(2 * radius, 12.0))
        foot = np.array([edge - radius, depth / 2, 0.0])
        top = foot + height * _UP
        plant.parts += [cylinder("tank", foot, top, radius), disk("roof", top, _UP, 0.0, radius)]
        for turn in (0.25 * np.pi, 0.9 * np.pi, 1.5 * np.pi):
            away = np.array([np.cos(turn), np.sin(turn), 0.0]) * (radius + 5.0)
            plant.stations.append(foot + away + (height + 3.0 if turn < 1.0 else 1.7) * _UP)
        edge -= 2 * radius + 4.0
    return edge


def _spheres(plant: Plant, count: int, east: float, rng: np.random.Generator) -> None:
    """Add spherical vessels east of the racks."""
    for number in range(count):
        radius = float(rng.uniform(0.5, 1.5))
        center = np.array([east + 4.0, 3.0 + 5.0 * number, radius + 0.8])
        plant.parts.append(sphere(center, radius))
        plant.stations += [center + np.array([x, y, 1.7 - center[2]]) for x, y in ((-4.0, -3.0), (3.0, 3.0))]
