"""A drone's photographs of a scene, matched: points where the rays of a few oblique views first meet something."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Optional

import numpy as np

from ..stage import Monitor
from .beams import Beams, Echoes, World, join
from .pairs import in_boxes
from .relief import Relief
from .scene import Scene

# Rays worked on at once, which bounds memory.
_BLOCK = 50_000

# Height (m) over the ground from which rays start: over all trees.
_HEIGHT = 80.0

# Width (m) of the strip around the scene into which rays are aimed, too: oblique ones meet walls before the ground.
_MARGIN = 10.0

# Kinds of objects that views show: wires are thinner than a pixel.
_SEEN = ("solids", "crowns")


def photograph(
    scene: Scene, *, density: float, oblique: float, seed: int, monitor: Optional[Monitor] = None
) -> tuple[np.ndarray, Echoes]:
    """Return what straight down and four oblique views see of a scene.

    Parameters
    ----------
    scene : Scene
        The scene that is photographed.
    density : float
        Points per square meter of open ground, all views together.
    oblique : float
        Angle of the oblique views to the vertical, degrees.
    seed : int
        Start of the random numbers.
    monitor : Monitor, optional
        Receives progress.

    Returns
    -------
    xyz : ndarray of shape (n, 3)
        Exact positions (m), within the square of the scene in plan.
    seen : Echoes
        Objects that are seen, in the same order.
    """
    monitor = monitor or Monitor()
    rng = np.random.default_rng([seed, 3])
    world = World(scene)
    directions = [(0.0, 0.0), *((np.deg2rad(oblique), scene.relief.angle + k * np.pi / 2) for k in range(4))]
    blocks = list(itertools.product(directions, _blocks(scene.size, density / len(directions))))
    positions, parts = [], []
    for i, ((tilt, heading), (low, high, count)) in enumerate(blocks):
        rays = _rays(scene.relief, rng.uniform(low, high, (count, 2)), tilt, heading)
        solids, crowns = (_met(world, kind, rays) for kind in _SEEN)
        seen = join([world.surfaces(rays, *solids), world.leaves(rays, *crowns, rng)]).first()
        xyz = rays.at(seen.pulse, seen.range)
        inside = ((xyz[:, :2] >= 0) & (xyz[:, :2] <= scene.size)).all(axis=1)
        positions.append(xyz[inside])
        parts.append(seen.take(inside))
        monitor.progress((i + 1) / len(blocks))
    return np.concatenate(positions), join(parts)


def _blocks(size: float, density: float) -> Iterator[tuple[np.ndarray, np.ndarray, int]]:
    """Yield the corners (m) of squares and how many rays are aimed into each."""
    n = max(1, int(np.ceil((size + 2 * _MARGIN) * np.sqrt(density / _BLOCK))))
    side = (size + 2 * _MARGIN) / n
    for row, column in itertools.product(range(n), range(n)):
        low = np.array([column, row]) * side - _MARGIN
        yield low, low + side, round(density * side**2)


def _rays(relief: Relief, aim: np.ndarray, tilt: float, heading: float) -> Beams:
    """Return parallel rays that lean by ``tilt`` toward ``heading`` (rad) and meet the ground's plane at ``aim``."""
    direction = np.array([np.sin(tilt) * np.cos(heading), np.sin(tilt) * np.sin(heading), -np.cos(tilt)])
    end = np.column_stack([aim, relief.plane(*aim.T)])
    return Beams(np.arange(len(aim)), end - _HEIGHT / np.cos(tilt) * direction, np.tile(direction, (len(aim), 1)), aim)


def _met(world: World, kind: str, rays: Beams) -> tuple[np.ndarray, np.ndarray]:
    """Return the pairs (ray, thing) that may meet: the ray is aimed into the shadow of the thing's box."""
    low, high = world.boxes(kind)
    direction = rays.direction[0]
    shadows = []
    for corner in itertools.product(*zip(low.T, high.T)):
        x, y, z = corner
        # How far along the ray the corner's shadow falls on the plane.
        fall = direction[2] - np.dot(world.relief.plane_gradient, direction[:2])
        way = (world.relief.plane(x, y) - z) / fall
        shadows.append(np.column_stack([x, y]) + way[:, None] * direction[:2])
    return in_boxes(rays.aim, np.min(shadows, axis=0), np.max(shadows, axis=0))
