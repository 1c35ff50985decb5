"""A scene of real objects, cut from a survey that nothing was tried on, set on a made-up slope."""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.algorithms.packages import spatial
from lidar_buildings.tests.real.clouds import DATA

# Classes of the objects in their file.
CAR, FENCE, POLE, TREE = 65, 66, 64, int(PointClass.HIGH_VEGETATION)

# Side of the lot of a house, m.
LOT = 70.0

# What is on a lot, on one side of the house each, the last on the first one's.
BESIDE = (TREE, TREE, CAR, FENCE, POLE)

# Distance (m) from the house of the first tree and the fence, and range of the others'.
TOUCHING, APART = 0.3, (1.0, 6.0)

# Height (m) of the eaves over the ground downhill and, at least, uphill: objects were cut out above the ground, some
# without any point of a wall.
EAVES, LEAST_UPHILL = 2.3, 1.5

# Points of open ground on a square meter.
GROUND_DENSITY = 14.0

# Standard deviation of their elevations, m.
GROUND_NOISE = 0.02


def scene(slope: float, share: float, seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return coordinates (m), true classes and object numbers (0 is ground) of houses with objects next to them.

    ``slope`` is the rise of the ground per meter, ``share`` how much of the points stays.
    """
    rng = np.random.default_rng(seed)
    objects = {kind: _objects(kind, rng) for kind in (PointClass.BUILDING, *set(BESIDE))}
    houses = objects[PointClass.BUILDING]
    columns = int(np.ceil(np.sqrt(len(houses))))
    placed: list[tuple[np.ndarray, int]] = []
    for lot, house in enumerate(houses):
        center = (np.array([lot % columns, lot // columns]) + 0.5) * LOT + rng.uniform(-5, 5, 2)
        placed.append((_founded(house, center, slope), int(PointClass.BUILDING)))
        for number, kind in enumerate(BESIDE):
            points = objects[kind][(lot + number * len(objects[kind]) // 2) % len(objects[kind])]
            if np.ptp(points[:, :2], axis=0).max() < 0.6 * LOT:
                placed.append((_beside(points, house, number, center, slope, rng), kind))
    sizes = [len(points) for points, _ in placed]
    xyz = np.concatenate([points for points, _ in placed])
    kinds = np.repeat([kind for _, kind in placed], sizes)
    ground = _ground(columns * LOT, slope, xyz, kinds, rng)
    xyz = np.concatenate([xyz, ground])
    kinds = np.concatenate([kinds, np.full(len(ground), PointClass.GROUND)])
    number = np.concatenate([np.repeat(np.arange(len(placed)) + 1, sizes), np.zeros(len(ground), int)])
    stays = rng.random(len(xyz)) < share
    return xyz[stays], kinds[stays], number[stays]


def elevation(plan: np.ndarray, slope: float) -> np.ndarray:
    """Return the elevation (m) of the ground: a slope with hills."""
    x, y = plan.T
    return slope * x + 1.5 * np.sin(x / 60) * np.cos(y / 80)


def _objects(kind: int, rng: np.random.Generator) -> list[np.ndarray]:
    """Return the objects of a class in a random order, each centered, its lowest point at 0."""
    xyz = read_cloud(DATA / "objects" / "dales-objects.laz").get("xyz")
    with np.load(DATA / "objects" / "dales-objects.truth.npz") as truth:
        number, classes = truth["object_id"], truth["classification"]
    found = [xyz[number == one] for one in rng.permutation(np.unique(number[classes == kind]))]
    return [points - [*points[:, :2].mean(axis=0), points[:, 2].min()] for points in found]


def _founded(house: np.ndarray, center: np.ndarray, slope: float) -> np.ndarray:
    """Return a house at its place, its eaves high enough over the ground downhill and uphill."""
    house = house + [*center, 0.0]
    house[:, 2] += max(0.0, EAVES - np.percentile(house[:, 2], 10))
    below = elevation(house[:, :2], slope)
    house[:, 2] += max(below.min(), below.max() - (EAVES - LEAST_UPHILL))
    return house


def _beside(
    points: np.ndarray, house: np.ndarray, number: int, center: np.ndarray, slope: float, rng: np.random.Generator
) -> np.ndarray:
    """Return an object next to the house at ``center``: numbers 0 to 3 on one side each, number 4 on the side of 0."""
    half, own = np.ptp(house[:, :2], axis=0) / 2, np.ptp(points[:, :2], axis=0) / 2
    axis, side = number % 2, 1 if number // 2 % 2 else -1
    apart = TOUCHING if number in (0, BESIDE.index(FENCE)) else rng.uniform(*APART)
    offset = np.zeros(2)
    offset[axis] = side * (half[axis] + own[axis] + apart)
    offset[1 - axis] = rng.uniform(-0.5, 0.5) * half[1 - axis]
    position = center + offset
    return points + [*position, elevation(position[None], slope)[0]]


def _ground(size: float, slope: float, xyz: np.ndarray, kinds: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return points of the ground, none under houses and half of them under trees."""
    plan = rng.uniform(0, size, (int(GROUND_DENSITY * size**2), 2))
    hidden = np.zeros(len(plan), bool)
    for kind, share in ((PointClass.BUILDING, 1.0), (TREE, 0.5)):
        distance, _ = spatial.cKDTree(xyz[kinds == kind, :2]).query(plan, distance_upper_bound=0.6)
        hidden |= np.isfinite(distance) & (rng.random(len(plan)) < share)
    plan = plan[~hidden]
    return np.column_stack([plan, elevation(plan, slope) + rng.normal(0, GROUND_NOISE, len(plan))])
