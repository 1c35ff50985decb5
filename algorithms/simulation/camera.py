"""Matched drone images of a scene by ray casting: vertical and oblique views, one point per ray."""

import itertools
from collections.abc import Iterator
from typing import Optional

import numpy as np

from ..stage import Monitor
from .beams import BLOCK, Beams, Echoes, World, join
from .pairs import in_boxes
from .relief import Relief
from .scene import Scene

# Width (m) of the margin into which rays are aimed, too: oblique rays meet walls before the ground.
_MARGIN = 10.0


def photograph(
    scene: Scene, *, density: float, oblique: float, seed: int, monitor: Optional[Monitor] = None
) -> tuple[np.ndarray, Echoes]:
    """Return the points that a vertical view and four oblique views see of a scene.

    Parameters
    ----------
    scene : Scene
        The scene.
    density : float
        Points per square meter of open ground, all views together.
    oblique : float
        Angle of the oblique views to the vertical, degrees.
    seed : int
        The same seed gives the same points.
    monitor : Monitor, optional
        Receives progress.

    Returns
    -------
    xyz : ndarray of shape (n, 3)
        Exact positions (m) within the square of the scene.
    seen : Echoes
        Class and object of each point, in the same order.
    """
    monitor = monitor or Monitor()
    rng = np.random.default_rng([seed, 3])
    world = World(scene)
    directions = [(0.0, 0.0), *((np.deg2rad(oblique), scene.relief.angle + k * np.pi / 2) for k in range(4))]
    blocks = list(itertools.product(directions, _blocks(scene.size, density / len(directions))))
    positions, parts = [], []
    for i, ((tilt, heading), (low, high, count)) in enumerate(blocks):
        rays = _rays(scene.relief, rng.uniform(low, high, (count, 2)), tilt, heading)
        # Wires are thinner than a pixel.
        ends = world.surfaces(rays, *_met(world, "solids", rays))
        seen = join([ends, world.leaves(rays, *_met(world, "crowns", rays), rng)]).first()
        xyz = rays.at(seen.pulse, seen.range)
        inside = ((xyz[:, :2] >= 0) & (xyz[:, :2] <= scene.size)).all(axis=1)
        positions.append(xyz[inside])
        parts.append(seen.take(inside))
        monitor.progress((i + 1) / len(blocks))
    return np.concatenate(positions), join(parts)


def _blocks(size: float, density: float) -> Iterator[tuple[np.ndarray, np.ndarray, int]]:
    """Yield the lower and upper corner (m) of squares, and the number of rays aimed into each."""
    n = max(1, int(np.ceil((size + 2 * _MARGIN) * np.sqrt(density / BLOCK))))
    side = (size + 2 * _MARGIN) / n
    for row, column in itertools.product(range(n), range(n)):
        low = np.array([column, row]) * side - _MARGIN
        yield low, low + side, round(density * side**2)


def _rays(relief: Relief, aim: np.ndarray, tilt: float, heading: float) -> Beams:
    """Return parallel rays tilted by ``tilt`` toward ``heading`` (rad) that meet the plane of the ground at ``aim``."""
    direction = np.array([np.sin(tilt) * np.cos(heading), np.sin(tilt) * np.sin(heading), -np.cos(tilt)])
    end = np.column_stack([aim, relief.plane(*aim.T)])
    # Rays start 80 m above the ground, higher than all trees.
    return Beams(np.arange(len(aim)), end - 80.0 / np.cos(tilt) * direction, np.tile(direction, (len(aim), 1)), aim)


def _met(world: World, kind: str, rays: Beams) -> tuple[np.ndarray, np.ndarray]:
    """Return the candidate pairs (ray, object): rays aimed into the shadow of the object's bounding box."""
    low, high = world.boxes(kind)
    direction = rays.direction[0]
    shadows = []
    for corner in itertools.product(*zip(low.T, high.T)):
        x, y, z = corner
        # Distance along the ray from the corner to its shadow on the plane.
        fall = direction[2] - np.dot(world.relief.plane_gradient, direction[:2])
        way = (world.relief.plane(x, y) - z) / fall
        shadows.append(np.column_stack([x, y]) + way[:, None] * direction[:2])
    return in_boxes(rays.aim, np.min(shadows, axis=0), np.max(shadows, axis=0))
