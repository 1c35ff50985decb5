"""Simulated towns with noise (birds, dust, multipath, strays) and with thin objects that must not be taken for noise.

What is noise is known point by point. Everything is in meters; how much noise there is and how far it lies off is as
surveyors report it: birds alone or in flocks, a plume of dust that stops some of the pulses, echoes that took a
detour over a wall and arrive too late, and wrong ranges from anywhere.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.simulation.simulate_town import simulate_town


class NoisyTown(NamedTuple):
    """Points of a town; ``kind`` (n,) is "" for the town itself, or the kind of thin object or noise."""

    xyz: np.ndarray
    classification: np.ndarray
    kind: np.ndarray
    is_noise: np.ndarray


NOISE_KINDS = ("bird", "flock", "dust", "multipath", "multipath group", "far")


class _Maker:
    """Adds thin objects and noise to a town; numbers ``n`` are points, or objects of several points."""

    def __init__(self, xyz: np.ndarray, classification: np.ndarray, density: float, seed: int) -> None:
        self.rng = np.random.default_rng(seed)
        self.density, self.xyz, self.all = density, xyz, xyz
        self.low, self.high = xyz[:, :2].min(axis=0) + 2, xyz[:, :2].max(axis=0) - 2
        is_ground = np.isin(classification, (PointClass.GROUND, PointClass.WATER))
        self.ground = xyz[is_ground]
        self.on_ground, self.in_plan = cKDTree(self.ground[:, :2]), cKDTree(xyz[:, :2])
        self.parts: list[tuple[np.ndarray, str]] = []

    def anywhere(self, n: int, inside: float = 0.0) -> np.ndarray:
        return self.rng.uniform(self.low + inside, self.high - inside, (n, 2))

    def ground_at(self, plan: np.ndarray) -> np.ndarray:
        return self.ground[self.on_ground.query(plan, 3)[1], 2].min(axis=1)

    def surface_at(self, plan: np.ndarray, radius: float) -> np.ndarray:
        """Return the highest elevation within ``radius`` (m) in plan."""
        around = self.in_plan.query_ball_point(plan, max(radius, 2 / np.sqrt(self.density)))
        return np.array([self.all[rows, 2].max() if rows else np.nan for rows in around])

    def add(self, kind: str, plan: np.ndarray, z: np.ndarray) -> None:
        points = np.column_stack([plan, z])
        self.parts.append((points[np.isfinite(points).all(axis=1)], kind))

    def settle(self) -> None:
        """Count the added points as part of the scene, from which noise keeps its distance."""
        self.all = np.concatenate([self.xyz, *(points for points, _ in self.parts)])
        self.in_plan = cKDTree(self.all[:, :2])

    def birds(self, n: int) -> None:
        plan = self.anywhere(n)
        self.add("bird", plan, self.surface_at(plan, 4.0) + self.rng.uniform(5, 100, n))

    def flock(self, n: int) -> None:
        # An object that the border cuts looks like the edge of a tree beyond it.
        middle = self.anywhere(1, 12.0)
        plan = middle + self.rng.normal(0, 3.0, (n, 2))
        over = self.surface_at(middle, 12.0) + self.rng.uniform(9, 90)
        self.add("flock", plan, over + self.rng.uniform(-3, 3, n))

    def dust(self, n: int) -> None:
        """Put up a plume that stops 15 % of the pulses."""
        radius = np.sqrt(n / (0.15 * self.density * np.pi))
        middle = self.rng.uniform(self.low + radius, self.high - radius, (1, 2))
        off = self.rng.normal(0, 1, (n, 3))
        off *= self.rng.random((n, 1)) ** (1 / 3) / np.linalg.norm(off, axis=1, keepdims=True)
        height = min(radius, 6.0)
        over = self.surface_at(middle, radius + 3)[0] + height + self.rng.uniform(5, 40)
        self.add("dust", middle + radius * off[:, :2], over + height * off[:, 2])

    def multipath(self, n: int) -> None:
        plan = self.anywhere(n)
        self.add("multipath", plan, self.ground_at(plan) - self.rng.uniform(0.5, 10, n))

    def multipath_group(self, n: int) -> None:
        plan = self.anywhere(1) + self.rng.normal(0, 1.0, (n, 2))
        depth = self.rng.uniform(1, 10) + self.rng.normal(0, 0.3, n)
        self.add("multipath group", plan, self.ground_at(plan) - np.maximum(depth, 0.5))

    def far(self, n: int) -> None:
        away = self.rng.uniform(150, 3000, n) * np.where(self.rng.random(n) < 0.6, 1, -1)
        plan = self.anywhere(n)
        self.add("far", plan, self.ground_at(plan) + away)

    def masts(self, n: int) -> None:
        """Put up thin masts of 8 to 30 m, with a point every 0.2 m (dense clouds) to 1.3 m (sparse ones) on average."""
        for plan in self.anywhere(n):
            up = np.cumsum(self.rng.uniform(0.3, 1.0, 100) * np.clip(2.5 / np.sqrt(self.density), 0.3, 2.0))
            up = up[up < self.rng.uniform(8, 30)]
            self.add("mast", plan + self.rng.normal(0, 0.05, (len(up), 2)), self.ground_at(plan[None]) + up)

    def lamps(self, n: int) -> None:
        """Hang lamps 6 to 12 m over the ground, whose poles give no point."""
        for plan in self.anywhere(n):
            size = max(3, round(0.5 * self.density))
            head = plan + self.rng.uniform(-0.3, 0.3, (size, 2))
            self.add("lamp", head, self.ground_at(plan[None]) + self.rng.uniform(6, 12) + np.zeros(size))

    def power_line(self) -> None:
        """Hang three conductors across the town, 20 to 30 m over their higher end, with a point every 0.2 to 1.5 m."""
        start, end = self.low, np.array([self.high[0], self.high[1] - 0.3 * (self.high[1] - self.low[1])])
        length = float(np.linalg.norm(end - start))
        base = float(self.ground_at(np.stack([start, end])).max())
        for aside in (-4.0, 0.0, 4.0):
            at = np.cumsum(self.rng.uniform(0.3, 1.7, 20_000) * np.clip(1 / np.sqrt(self.density), 0.2, 1.5))
            at = at[at < length] / length
            across = np.array([start[1] - end[1], end[0] - start[0]]) / length
            plan = start + at[:, None] * (end - start) + aside * across
            inside = ((plan > self.low) & (plan < self.high)).all(axis=1)
            self.add("wire", plan[inside], (base + 30 - 40 * at * (1 - at))[inside])

    def chimneys(self, roofs: np.ndarray, n: int) -> None:
        """Put stacks of 0.6 m, 1 to 2.5 m high, on roofs: one point or more each."""
        if not len(roofs):
            return
        for foot in roofs[self.rng.integers(0, len(roofs), n)]:
            size = max(1, self.rng.poisson(0.36 * self.density))
            plan = foot[:2] + self.rng.uniform(-0.3, 0.3, (size, 2))
            self.add("chimney", plan, np.full(size, foot[2] + self.rng.uniform(1, 2.5)))


def noisy_town(density: float = 8.0, size: float = 0.0, seed: int = 1, **differs) -> NoisyTown:
    """Return a town with noise, points in random order.

    ``size`` is its width (m); 0 takes the width of some 60,000 pulses. ``differs`` are other tunables of the town.
    """
    size = size or float(np.clip(np.sqrt(60_000 / density), 60, 200))
    xyz, classification, *_ = simulate_town(size=size, density=density, noise_points=0.0, seed=seed, **differs)
    maker = _Maker(xyz, classification, density, seed)
    hectares = size**2 / 1e4
    maker.masts(3)
    maker.lamps(5)
    maker.power_line()
    maker.chimneys(xyz[classification == PointClass.BUILDING], 10)
    maker.settle()
    maker.birds(round(20 * hectares) + 5)
    for n in maker.rng.integers(3, 16, round(2 * hectares) + 1):
        maker.flock(int(n))
    maker.dust(300)
    maker.multipath(round(30 * hectares) + 10)
    for n in maker.rng.integers(2, 9, round(4 * hectares) + 1):
        maker.multipath_group(int(n))
    maker.far(10)
    kind = np.concatenate([np.full(len(xyz), "", "U16"), *(np.full(len(part), name) for part, name in maker.parts)])
    points = np.concatenate([xyz, *(part for part, _ in maker.parts)])
    classes = np.concatenate([classification, np.ones(len(points) - len(xyz), np.uint8)])
    order = maker.rng.permutation(len(points))
    return NoisyTown(points[order], classes[order], kind[order], np.isin(kind[order], NOISE_KINDS))
