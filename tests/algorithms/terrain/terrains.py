"""Terrains known by formula, with flat houses on them, and how much of both a filter gets wrong."""

import numpy as np

WIDTH = 80.0


HOUSES = [(15, 15, 27, 25, 4), (45, 45, 68, 62, 6), (10, 50, 18, 70, 5)]  # west, south, east, north, height over ground


TERRAINS = {
    "level": lambda x, y: 0.0 * x,
    "slope": lambda x, y: 0.3 * x - 0.1 * y,
    "hill": lambda x, y: 10 * np.exp(-((x - 40) ** 2 + (y - 30) ** 2) / 600),
    "steep": lambda x, y: 0.6 * x,
    "terrace": lambda x, y: np.where(x > 35, 2.0, 0.0),
    "bumpy": lambda x, y: np.sin(x / 5) * np.cos(y / 6),
}


def scan(rng, terrain, houses=(), density=1.5, noise=0.03):
    """Return points (n, 3) of a terrain with flat houses on it, and which points are house."""
    plan = rng.uniform(0, WIDTH, (int(WIDTH**2 * density), 2))
    ground = terrain(*plan.T)
    z, is_house = ground.copy(), np.zeros(len(plan), bool)
    for west, south, east, north, height in houses:
        inside = ((plan >= [west, south]) & (plan <= [east, north])).all(axis=1)
        z[inside] = ground[inside].max() + height
        is_house |= inside
    return np.column_stack([plan, z + rng.normal(0, noise, len(plan))]), is_house


def unclassified(xyz):
    return np.ones(len(xyz), np.uint8)


def errors(found, is_object):
    """Return the share of ground that was missed and of objects that were taken for ground."""
    return (found[~is_object] != 2).mean(), (found[is_object] == 2).mean()
