"""Pieces of a plant whose geometry is known, for tests of shapes. Meters throughout."""

from __future__ import annotations

import numpy as np


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
