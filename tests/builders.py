"""What tests build their truth from: positions, outlines, roofs, terrains. Meters and degrees throughout.

Each function draws its points from the generator that it is given, so that a test repeats with its seed.
"""

from __future__ import annotations

import numpy as np

# Where surveys lie in UTM and national grids (m). Tests move scenes there: steps of float32 are 0.5 m at this northing.
FAR = np.array([600_000.0, 5_000_000.0, 0.0])

# The same for tests that demand equal results: coordinates in binary fractions stay exact next to powers of two.
EXACT_FAR = np.array([2.0**19, 2.0**22, 0.0])

# Closed outline of an L-shaped house of 20 m by 16 m, counterclockwise.
L_SHAPE = np.array([[0, 0], [20, 0], [20, 8], [9, 8], [9, 16], [0, 16], [0, 0]], float)


def roof(
    rng: np.random.Generator,
    west: float,
    south: float,
    width: float = 10.0,
    depth: float = 8.0,
    elevation: float = 6.0,
    density: float = 6.0,
    noise: float = 0.02,
) -> np.ndarray:
    """Return points (n, 3) of a flat roof with its southwest corner at (west, south), ``density`` per m²."""
    plan = rng.uniform([west, south], [west + width, south + depth], (int(width * depth * density), 2))
    return np.column_stack([plan, elevation + rng.normal(0, noise, len(plan))])


def crown(
    rng: np.random.Generator, x: float, y: float, radius: float = 3.0, middle: float = 7.0, count: int = 400
) -> np.ndarray:
    """Return points (n, 3) spread evenly over the ball of a crown whose center is ``middle`` high."""
    direction = rng.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return direction * radius * rng.random((count, 1)) ** (1 / 3) + [x, y, middle]


def gable(
    rng: np.random.Generator, density: float = 15.0, noise: float = 0.03, pitch: float = 35.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return points (n, 3) of a roof of 12 m by 8 m with an eastward ridge, and whether each is on its north side."""
    xy = rng.uniform(0, [12, 8], (round(96 * density), 2))
    z = 6 + np.tan(np.radians(pitch)) * (4 - np.abs(xy[:, 1] - 4))
    return np.column_stack([xy, z + rng.normal(0, noise, len(xy))]), xy[:, 1] > 4


def tilted(
    rng: np.random.Generator, slope: float, size: float = 8.0, density: float = 20.0, noise: float = 0.02
) -> np.ndarray:
    """Return points (n, 3) of a square that rises eastward with ``slope`` degrees, evenly dense on it."""
    along, across = rng.uniform(0, size, (2, round(size**2 * density)))
    off, angle = rng.normal(0, noise, len(along)), np.radians(slope)
    east, up = np.cos(angle) * along - np.sin(angle) * off, np.sin(angle) * along + np.cos(angle) * off
    return np.column_stack([east, across, up])


def rectangle(west: float, south: float, width: float = 10.0, depth: float = 10.0) -> np.ndarray:
    """Return the closed ring (5, 2) of a rectangle, counterclockwise."""
    return np.array([[0, 0], [width, 0], [width, depth], [0, depth], [0, 0]]) + [west, south]


def turned(points: np.ndarray, degrees: float) -> np.ndarray:
    """Return points (n, 2) or (n, 3) turned counterclockwise about the origin of the plan."""
    turned, (cos, sin) = np.array(points, float), (np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees)))
    turned[:, :2] = turned[:, :2] @ np.array([[cos, sin], [-sin, cos]])
    return turned


def is_inside(plan: np.ndarray, rings: list[np.ndarray]) -> np.ndarray:
    """Return which points (n, 2) a polygon holds, by the parity of crossings; its rings may be closed or not."""
    odd = np.zeros(len(plan), bool)
    for ring in rings:
        for (x0, y0), (x1, y1) in zip(ring, np.roll(ring, -1, axis=0)):
            crosses = (y0 > plan[:, 1]) != (y1 > plan[:, 1])
            with np.errstate(divide="ignore", invalid="ignore"):
                odd ^= crosses & (plan[:, 0] < x0 + (plan[:, 1] - y0) * (x1 - x0) / (y1 - y0))
    return odd


def star(rng: np.random.Generator, center: np.ndarray) -> list[np.ndarray]:
    """Return the closed rings of a polygon of 5 to 12 corners around a center, some pointing inward, some with a hole.

    Where the corners leave a gap of half a turn or more, the center may lie outside and the hole with it.
    """
    angle = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(5, 13)))
    reach = rng.uniform(1.5, 6, len(angle))
    ring = center + np.column_stack([reach * np.cos(angle), reach * np.sin(angle)])
    ring = np.concatenate([ring, ring[:1]])
    return [ring, (center + (ring - center) * 0.4)[::-1]] if rng.random() < 0.4 else [ring]
