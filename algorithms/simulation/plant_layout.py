"""Layout of a simulated plant: racks of pipes, tanks, spheres and clutter in bays with aisles between them."""

from dataclasses import dataclass, field

import numpy as np

from .plant_parts import PlantPart, beam, cylinder, disk, elbow, grating, heap, plate, sphere

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
