"""Clouds that matched images show: one height for each place, as functions of the place, with their truth."""

from __future__ import annotations

from typing import Callable

import numpy as np

# Height (m) over places (x, y), and where it is the thing's own.
Part = Callable[[np.ndarray, np.ndarray], np.ndarray]


def box(west: float, south: float, east: float, north: float, height: float, smeared: float = 0.0) -> Part:
    """A flat roof whose walls are smeared evenly over ``smeared`` (m) to both sides."""

    def part(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        inside = np.minimum.reduce([x - west, east - x, y - south, north - y])
        return height * (np.clip(0.5 + inside / (2 * smeared), 0, 1) if smeared else inside >= 0)

    return part


def mound(middle: tuple[float, float], radius: float, height: float, rough: float = 0.0) -> Part:
    """A crown: half of an ellipsoid, with lumps of ``rough`` (m) a meter apart."""

    def part(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        away = np.hypot(x - middle[0], y - middle[1]) / radius
        lumps = rough * np.sin(2 * np.pi * x) * np.sin(2 * np.pi * y)
        return np.where(away < 1, height * np.sqrt(np.maximum(1 - away**2, 0)) + lumps, 0)

    return part


def seen_from_above(
    rng: np.random.Generator, *parts: Part, side: float = 30.0, density: float = 40.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return points (n, 3) on the highest of the parts and the level ground, and of which part (n,) each is, 0 ground.

    Points lie evenly: one at random in each square of a grid.
    """
    count = round(side * np.sqrt(density))
    xy = (np.stack(np.meshgrid(*2 * [np.arange(count)]), axis=-1).reshape(-1, 2) + rng.random((count**2, 2))) * (
        side / count
    )
    heights = np.array([np.zeros(len(xy)), *(part(*xy.T) for part in parts)])
    return np.column_stack([xy, heights.max(axis=0)]), np.argmax(heights, axis=0)
