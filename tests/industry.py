"""Pieces of a plant whose geometry is known, for tests of shapes. Meters throughout."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lidar_buildings.algorithms.stage import LayerFeatures


def pipe(
    rng: np.random.Generator,
    radius: float,
    length: float,
    spacing: float,
    noise: float,
    axis: tuple[float, float, float],
    seen: float = 0.6,
) -> np.ndarray:
    """Return points (n, 3) on the share ``seen`` of a cylinder around zero, seen mostly from above."""
    count = round(2 * np.pi * radius * seen * length / spacing**2)
    along = np.array(axis, float) / np.linalg.norm(axis)
    first = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    first /= np.linalg.norm(first)
    second = np.cross(along, first)
    angle = np.pi * seen * rng.uniform(-1, 1, count)[:, None] - np.pi / 2
    away = np.cos(angle) * first + np.sin(angle) * second
    return (radius + rng.normal(0, noise, (count, 1))) * away + length * rng.uniform(-0.5, 0.5, (count, 1)) * along


def slab(rng: np.random.Generator, size: float, spacing: float, noise: float) -> np.ndarray:
    """Return points (n, 3) of a level square around zero."""
    count = round((size / spacing) ** 2)
    return np.column_stack([rng.uniform(-size / 2, size / 2, (count, 2)), rng.normal(0, noise, count)])


def edge(rng: np.random.Generator, size: float, spacing: float, noise: float) -> np.ndarray:
    """Return points (n, 3) of a square that is folded by 90° along its middle: an angle iron."""
    flat = slab(rng, size, spacing, noise)
    return np.where(flat[:, :1] > 0, flat, flat[:, [2, 1, 0]] * [1, 1, -1])


def bent(rng: np.random.Generator, radius: float, bend: float, spacing: float, noise: float) -> np.ndarray:
    """Return points (n, 3) of a quarter of a torus: an elbow."""
    count = round(np.pi**2 * bend * radius / spacing**2)
    turn, around = rng.uniform(0, np.pi / 2, count), rng.uniform(0, 2 * np.pi, count)
    reach = radius + rng.normal(0, noise, count)
    out = bend + reach * np.cos(around)
    return np.column_stack([out * np.cos(turn), out * np.sin(turn), reach * np.sin(around)])


@dataclass(frozen=True)
class Comparison:
    """Cylinders that were found, against the true ones.

    ``is_found`` (m,): true cylinders on which one was found with a radius within 5 % and an axis within a quarter of
    the radius; ``error`` (k,): relative errors of their radii; ``invented``: numbers of cylinders that belong to no
    true one.
    """

    is_found: np.ndarray
    error: np.ndarray
    invented: list[int]


def compared(true_id: np.ndarray, true_axes: LayerFeatures, found_id: np.ndarray, axes: LayerFeatures) -> Comparison:
    """Compare cylinders with the truth.

    Parameters
    ----------
    true_id, found_id : ndarray of shape (n,)
        Numbers of the parts and of the segments of the points.
    true_axes, axes : LayerFeatures
        Axes with ``id`` and ``radius`` (m).
    """
    number_of = {number: row for row, number in enumerate(true_axes.columns["id"])}
    is_found, errors, invented = np.zeros(len(true_axes), bool), [], []
    for number, line, radius in zip(axes.columns["id"], axes.geometries, axes.columns["radius"]):
        parts, count = np.unique(true_id[found_id == number], return_counts=True)
        row = number_of.get(int(parts[np.argmax(count)])) if 2 * count.max() > count.sum() else None
        if row is None:
            invented.append(number)
            continue
        start, end = np.array(true_axes.geometries[row])
        along = (end - start) / np.linalg.norm(end - start)
        off = np.linalg.norm(np.cross(np.array(line) - start, along), axis=1).max()
        true_radius = true_axes.columns["radius"][row]
        error = abs(radius / true_radius - 1)
        if error <= 0.05 and off <= 0.25 * true_radius:
            is_found[row] = True
            errors.append(error)
        else:
            invented.append(number)
    return Comparison(is_found, np.array(errors), invented)


@dataclass(frozen=True)
class TankFarm:
    """A tank farm seen by a drone: points (n, 3), m, and x, y and radius (m) of each tank (k, 3)."""

    xyz: np.ndarray
    tanks: np.ndarray


def tank_farm(
    rng: np.random.Generator, noise: float = 0.025, tanks: tuple = ((13.76, 0), (13.74, 34), (9.74, 64), (8.56, 90))
) -> TankFarm:
    """Return tanks in a row with what real ones have: plates, ladders, stairs, girders, roofs within the walls.

    Each tank is a radius and the position of its axis along x (m). Around them are the yard, a low wall, kerbs and
    hedges.
    """
    parts, feet = [], []
    for number, (radius, x) in enumerate(tanks):
        foot = np.array([float(x), 0.0, 0.0])
        parts += [part + foot for part in _tank(rng, radius, 13.0, noise, sunk=(1.2, 2.5, 0.8, 4.0)[number % 4])]
        feet.append((*foot[:2], radius))
    west, east = tanks[0][1] - 25.0, tanks[-1][1] + 25.0
    ground = rng.uniform([west, -25], [east, 25], (round(25 * 50 * (east - west)), 2))
    outside = np.all([np.hypot(*(ground - foot[:2]).T) > foot[2] for foot in feet], axis=0)
    parts.append(np.column_stack([ground, rng.normal(0, noise, len(ground))])[outside])
    length = east - west - 4
    parts += [_lane(rng, west + 2, y, length, _kerb, noise) for y in (-19.0, -22.0)]
    parts += [_lane(rng, west + 2, y, length, _low_wall, noise) for y in (18.5, -17.0)]
    parts += [_lane(rng, west + 2, y, 30.0, _hedge, 0.06) for y in (22.0, -24.0)]
    return TankFarm(np.concatenate(parts), np.array(feet))


def _tank(rng: np.random.Generator, radius: float, height: float, noise: float, sunk: float) -> list[np.ndarray]:
    """Return the parts of a tank around zero: its wall of plates, roof, ladder, stairs and wind girder."""

    def around(turn: np.ndarray, reach: np.ndarray, z: np.ndarray) -> np.ndarray:
        return np.column_stack([reach * np.cos(turn), reach * np.sin(turn), z])

    count = round(11.6 * 2 * np.pi * radius * height)
    turn, z = rng.uniform(0, 2 * np.pi, count), rng.uniform(0, height, count)
    columns = max(4, round(2 * np.pi * radius / 8.0))
    proud = noise * rng.uniform(1, 2, (6, columns)) * rng.choice([-1, 1], (6, columns))
    plate = proud[(z / height * 6).astype(int), (turn / (2 * np.pi) * columns).astype(int)]
    wall = around(turn, radius + plate + rng.normal(0, noise, count), z)
    reach = radius * np.sqrt(rng.uniform(0, 1, round(8 * np.pi * radius**2)))
    turn = rng.uniform(0, 2 * np.pi, len(reach))
    roof = around(turn, reach, height - sunk + (radius - reach) / 16 + rng.normal(0, noise, len(reach)))
    n = round(0.03 * count)
    ladder = around(
        rng.uniform(0.3, 0.3 + 0.7 / radius, n), radius + rng.uniform(0.15, 0.9, n), rng.uniform(0, height, n)
    )
    n = round(0.06 * count)
    share = rng.uniform(0, 1, n)
    stairs = around(2 + 2.5 * share, radius + rng.uniform(0.15, 1.0, n), height * share + rng.uniform(0, 1.1, n))
    n = round(0.04 * count)
    girder = around(rng.uniform(0, 2 * np.pi, n), radius + rng.uniform(0, 0.6, n), height - 1 + rng.normal(0, noise, n))
    return [wall, roof, ladder, stairs, girder]


def _lane(rng: np.random.Generator, x: float, y: float, length: float, profile, noise: float) -> np.ndarray:
    """Return points along x with a profile across it, 25 per square meter of a strip one meter wide."""
    count = round(40 * length)
    across, z = profile(rng, count)
    points = np.column_stack([x + rng.uniform(0, length, count), y + across, z])
    return points + rng.normal(0, noise, points.shape)


def _kerb(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return across (m) and elevation (m) of a kerb 15 cm high, 30 cm wide, with rounded edges."""
    across = rng.uniform(-0.25, 0.25, count)
    return across, 0.15 * np.clip((0.25 - np.abs(across)) / 0.1, 0, 1)


def _low_wall(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return across (m) and elevation (m) of a wall 1 m high and 30 cm wide."""
    at = rng.uniform(-1.15, 1.15, count)
    return np.clip(at, -0.15, 0.15), np.where(np.abs(at) < 0.15, 1.0, 1.15 - np.abs(at))


def _hedge(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return across (m) and elevation (m) of a hedge with a round top, 1.2 m wide and 1.6 m high."""
    turn = rng.uniform(0, np.pi, count)
    return 0.6 * np.cos(turn), 1.0 + 0.6 * np.sin(turn) - np.where(rng.random(count) < 0.4, rng.uniform(0, 1, count), 0)
