"""Walls whose corners are known, scanned evenly with noise across them. Meters throughout."""

from __future__ import annotations

import numpy as np


def wall(
    rng: np.random.Generator, start, end, low: float = 0.0, high: float = 5.0, density: float = 150, noise: float = 0.01
) -> np.ndarray:
    """Return points (n, 3) of an upright wall from ``start`` to ``end`` (x, y), jittered on a square grid."""
    start, step = np.array(start, float), np.array(end, float) - np.array(start, float)
    length, spacing = float(np.hypot(*step)), 1 / np.sqrt(density)
    along, up = (np.linspace(0, 1, round(size / spacing) + 1) for size in (length, high - low))
    along, up = (grid.ravel() for grid in np.meshgrid(along, up))
    # The outermost points stay on the edge, so that the corners of the wall are its points'.
    jitter = rng.uniform(-0.3, 0.3, (2, len(along))) * spacing
    along = np.clip(along + jitter[0] / length, 0, 1)
    up = np.clip(up + jitter[1] / (high - low), 0, 1)
    across = np.array([-step[1], step[0]]) / length * rng.normal(0, noise, (len(along), 1))
    return np.column_stack([start + along[:, None] * step + across, low + up * (high - low)])


def without(points: np.ndarray, low, high) -> np.ndarray:
    """Return the points (n, 3) outside of a box from ``low`` to ``high`` (x, y, z)."""
    return points[~((points >= low) & (points <= high)).all(axis=1)]


def street_floor(rng: np.random.Generator, west: float, south: float, east: float, north: float, density=40.0):
    """Return points (n, 3) of level ground at elevation 0."""
    count = round((east - west) * (north - south) * density)
    return np.column_stack([rng.uniform((west, south), (east, north), (count, 2)), rng.normal(0, 0.01, count)])


def corner_errors(rings: list, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how far each true corner (m, 3) is from the nearest one found, and each one found from the true ones."""
    found = np.concatenate([ring[:-1] for polygon in rings for ring in polygon[:1]])
    distance = np.linalg.norm(found[:, None] - np.asarray(corners, float), axis=2)
    return distance.min(axis=0), distance.min(axis=1)
