"""Small scenes made by hand, seen from straight above, whose truth is a formula.

Each function returns a :class:`Scene`: coordinates in meters around (50, 50), true classes and return numbers, in
random order. ``SCENES`` names them all. The larger scenes, with oblique beams, are by ``simulate_town``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lidar_buildings.algorithms.cloud.asprs import PointClass

SIDE = 40.0


class Scene(NamedTuple):
    """A cloud and what is true of it: arrays of length n, ``xyz`` (n, 3)."""

    xyz: np.ndarray
    classification: np.ndarray
    return_number: np.ndarray
    number_of_returns: np.ndarray


class _Maker:
    """Scattered points of a square over which things are put one after the other."""

    def __init__(self, density: float, range_noise: float, seed: int) -> None:
        self.rng = np.random.default_rng(seed)
        self.range_noise = range_noise
        steps = np.arange(0.0, SIDE, 1 / np.sqrt(density))
        grid = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        # Jittered, so that no two points are very close and none are in line.
        self.x, self.y = (grid + self.rng.uniform(0.1, 0.9, grid.shape) / np.sqrt(density) + 30.0).T
        self.z = np.zeros(len(grid))
        self.classes = np.full(len(grid), PointClass.GROUND, np.uint8)
        self.extra: list[tuple] = []

    def put(self, where: np.ndarray, z: np.ndarray, classification: int) -> None:
        """Cover the points ``where`` with something."""
        self.z[where] = np.broadcast_to(z, self.z.shape)[where]
        self.classes[where] = classification

    def add_first_returns(self, where: np.ndarray, z: np.ndarray, classification: int) -> None:
        """Add a first return over the points ``where``, whose own return is then the second."""
        at = np.flatnonzero(where)
        self.extra.append((at, np.broadcast_to(z, self.z.shape)[at], classification))

    def done(self) -> Scene:
        """Return the scene, points in random order."""
        n, number = len(self.x), np.ones(len(self.x), int)
        for at, _, _ in self.extra:
            number[at] = 2
        source = np.concatenate([np.arange(n), *(at for at, _, _ in self.extra)])
        order = self.rng.permutation(len(source))
        z = np.concatenate([self.z, *(heights for _, heights, _ in self.extra)])
        z = z + self.range_noise * self.rng.standard_normal(len(z))
        classes = [self.classes, *(np.full(len(at), one, np.uint8) for at, _, one in self.extra)]
        return Scene(
            np.column_stack([self.x[source], self.y[source], z])[order],
            np.concatenate(classes)[order],
            np.append(number, np.ones(len(source) - n, int))[order].astype(np.uint8),
            number[source][order].astype(np.uint8),
        )


def _inside(maker: _Maker, half_x: float, half_y: float, x: float = 50.0, y: float = 50.0) -> np.ndarray:
    return (np.abs(maker.x - x) <= half_x) & (np.abs(maker.y - y) <= half_y)


def plane(slope: float = 0.0, density: float = 4.0, range_noise: float = 0.0, seed: int = 1) -> Scene:
    """Bare ground that rises eastward: z = tan(slope) (x - 50)."""
    maker = _Maker(density, range_noise, seed)
    maker.put(np.full(len(maker.x), True), np.tan(np.deg2rad(slope)) * (maker.x - 50), PointClass.GROUND)
    return maker.done()


def step(height: float = 3.0, density: float = 4.0, range_noise: float = 0.0, seed: int = 1) -> Scene:
    """Bare ground, sheer at x = 50: z = height east of it."""
    maker = _Maker(density, range_noise, seed)
    maker.put(maker.x > 50, np.array(height), PointClass.GROUND)
    return maker.done()


def gable_on_slope(
    slope: float = 10.0, pitch: float = 35.0, density: float = 4.0, range_noise: float = 0.0, seed: int = 1
) -> Scene:
    """A house of 12 m by 8 m on a slope, ridge to the east at y = 50: roof z = 6 + tan(pitch) (4 - abs(y - 50))."""
    maker = _Maker(density, range_noise, seed)
    maker.z = np.tan(np.deg2rad(slope)) * (maker.x - 50)
    roof = 6 + np.tan(np.deg2rad(pitch)) * (4 - np.abs(maker.y - 50))
    maker.put(_inside(maker, 6, 4), roof, PointClass.BUILDING)
    return maker.done()


def flat_roof_beside_tree(density: float = 4.0, range_noise: float = 0.0, seed: int = 1) -> Scene:
    """A flat roof at z = 5 (x 40 to 50, y 45 to 55) that touches a crown (radius 4, z 3 to 8) with ground below."""
    maker = _Maker(density, range_noise, seed)
    maker.put(_inside(maker, 5, 5, 45), np.array(5.0), PointClass.BUILDING)
    crown = np.hypot(maker.x - 54, maker.y - 50) < 4
    maker.add_first_returns(crown, maker.rng.uniform(3.0, 8.0, len(maker.x)), PointClass.HIGH_VEGETATION)
    return maker.done()


def wall(density: float = 16.0, range_noise: float = 0.0, seed: int = 1) -> Scene:
    """A free-standing wall: 20 m long, 0.6 m thick, top at z = 2.5."""
    maker = _Maker(density, range_noise, seed)
    maker.put(_inside(maker, 10, 0.3), np.array(2.5), PointClass.UNCLASSIFIED)
    return maker.done()


def bridge(density: float = 4.0, range_noise: float = 0.0, seed: int = 1) -> Scene:
    """A deck at z = 0, 8 m wide along y = 50, over a cut (x 44 to 56) whose bottom is at z = -5."""
    maker = _Maker(density, range_noise, seed)
    cut = np.abs(maker.x - 50) < 6
    maker.put(cut, np.array(-5.0), PointClass.GROUND)
    maker.put(cut & (np.abs(maker.y - 50) <= 4), np.array(0.0), PointClass.BRIDGE_DECK)
    return maker.done()


def noise(n_high: int = 5, n_low: int = 5, density: float = 4.0, range_noise: float = 0.0, seed: int = 1) -> Scene:
    """Level ground with points 40 to 80 m above it and 5 to 10 m below it."""
    maker = _Maker(density, range_noise, seed)
    which = maker.rng.permutation(len(maker.x))[: n_high + n_low]
    is_high, is_low = np.isin(np.arange(len(maker.x)), which[:n_high]), np.isin(np.arange(len(maker.x)), which[n_high:])
    maker.put(is_high, maker.rng.uniform(40, 80, len(maker.x)), PointClass.HIGH_NOISE)
    maker.put(is_low, maker.rng.uniform(-10, -5, len(maker.x)), PointClass.LOW_NOISE)
    return maker.done()


SCENES = {made.__name__: made for made in (plane, step, gable_on_slope, flat_roof_beside_tree, wall, bridge, noise)}
