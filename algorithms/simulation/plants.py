"""Trees, bushes and hedges: ellipsoids of leaves, and stems."""

import numpy as np

from ..cloud.asprs import PointClass
from ..stage import Monitor, tunable
from .bodies import Rect
from .scene import Scene

FOREST = tunable(0.1, "Share of the area covered by forest.", label="Share of forest", within="[0, 1]")

# Trees per clump.
_CLUMP_SIZE = 4

# Distance between trees of the forest (m).
_FOREST_SPACING = 4.5


def plant_trees(scene: Scene, per_hectare: float, forest: float, rng: np.random.Generator, monitor: Monitor) -> None:
    """Plant single trees and clumps on open ground, and the forest.

    Parameters
    ----------
    scene : Scene
        Receives the objects.
    per_hectare, forest : float
        Trees per hectare outside the forest, and share of the area that is forest.
    rng : numpy.random.Generator
        Source of random numbers.
    monitor : Monitor
        Receives the progress.
    """
    n_trees = round(per_hectare * scene.size**2 / 1e4 * (1 - forest))
    # Of the trees 40 % grow in clumps, with a standard deviation of 2.5 m around the centers.
    n_clumps = round(0.4 * n_trees) // _CLUMP_SIZE
    alone = _open_positions(scene, n_trees - n_clumps * _CLUMP_SIZE, forest, rng)
    clumps = np.repeat(_open_positions(scene, n_clumps, forest, rng), _CLUMP_SIZE, axis=0)
    clumps = clumps + rng.normal(0.0, 2.5, clumps.shape)
    feet = _feet(scene, np.concatenate([alone, clumps[_is_free(scene, clumps)]]))
    for i, foot in enumerate(feet):
        plant_tree(scene, foot, rng.uniform(5.0, 16.0), rng)
        monitor.progress((1 - forest) * i / len(feet))
    _plant_forest(scene, forest, rng, monitor.part(1 - forest, 1.0))


def in_forest(scene: Scene, positions: np.ndarray, share: float) -> np.ndarray:
    """Return the mask of points (n, 2), m, in the forest: the eastern ``share`` of the square, with a wavy edge."""
    size = scene.size
    # Two whole periods keep the share; the amplitude vanishes as the share approaches 0 or 1.
    wave = 0.2 * size * share * (1 - share) * np.sin(4 * np.pi * positions[:, 1] / size)
    return positions[:, 0] > size * (1 - share) + wave


def _plant_forest(scene: Scene, share: float, rng: np.random.Generator, monitor: Monitor) -> None:
    """Plant trees and bushes on a jittered grid over the forest, except near buildings and water."""
    steps = np.arange(_FOREST_SPACING / 2, scene.size, _FOREST_SPACING)
    positions = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    positions = positions + rng.uniform(-0.35, 0.35, positions.shape) * _FOREST_SPACING
    feet = _feet(scene, positions[in_forest(scene, positions, share) & _is_free(scene, positions)])
    for i, (x, y, ground) in enumerate(feet):
        # Of the positions 90 % have a tree, 30 % a bush, and 20 % both.
        kind = rng.random()
        if kind < 0.9:
            plant_tree(scene, (x, y, ground), rng.uniform(10.0, 22.0), rng)
        if kind > 0.7:
            radius = rng.uniform(0.4, 1.0)
            scene.crowns.append((x, y, ground + 0.6 * radius, radius, radius, 0.8, scene.new_id()))
        monitor.progress(i / len(feet))


def _feet(scene: Scene, positions: np.ndarray) -> list[tuple[float, float, float]]:
    """Return easting, northing and elevation of the ground (m) at positions (n, 2)."""
    return [(float(x), float(y), float(z)) for (x, y), z in zip(positions, scene.relief.ground(*positions.T))]


def _open_positions(scene: Scene, count: int, forest: float, rng: np.random.Generator) -> np.ndarray:
    """Return up to ``count`` random free positions (m) outside the forest."""
    positions = np.zeros((0, 2))
    # A town full of houses or forest has no room for all trees.
    for _ in range(20):
        tries = rng.uniform(0.0, scene.size, (count, 2))
        free = _is_free(scene, tries) & ~in_forest(scene, tries, forest)
        positions = np.concatenate([positions, tries[free]])[:count]
        if len(positions) == count:
            break
    return positions


def _is_free(scene: Scene, positions: np.ndarray) -> np.ndarray:
    inside = ((positions > 0) & (positions < scene.size)).all(axis=1)
    return inside & ~scene.near_building(positions, 1.5) & ~scene.near_water(*positions.T)


def plant_tree(scene: Scene, foot: tuple[float, float, float], height: float, rng: np.random.Generator) -> None:
    """Plant a broadleaf tree or a conifer, with its stem.

    Parameters
    ----------
    scene : Scene
        Receives the objects.
    foot : tuple of float
        Easting, northing and elevation of the ground, m.
    height : float
        Height, m.
    rng : numpy.random.Generator
        Source of random numbers.
    """
    x, y, ground = foot
    number = scene.new_id()
    # Of the trees 30 % are conifers.
    (_conifer if rng.random() < 0.3 else _broadleaf)(scene, foot, height, number, rng)
    stem = Rect(x, y, 0.03 * height, 0.03 * height, 0.0)
    scene.add_box(stem, ground - 1.0, ground + 0.6 * height, PointClass.HIGH_VEGETATION, number)


def _conifer(scene: Scene, foot: tuple, height: float, number: int, rng: np.random.Generator) -> None:
    x, y, ground = foot
    radius = height * rng.uniform(0.14, 0.19)
    for level in (0.28, 0.47, 0.65, 0.82):
        scene.crowns.append((x, y, ground + level * height, 1.25 * radius * (1.05 - level), 0.18 * height, 0.9, number))


def _broadleaf(scene: Scene, foot: tuple, height: float, number: int, rng: np.random.Generator) -> None:
    """Plant a round lumpy crown of one large and five small ellipsoids."""
    x, y, ground = foot
    radius, middle = height * rng.uniform(0.22, 0.32), ground + 0.64 * height
    scene.crowns.append((x, y, middle, 0.8 * radius, 0.3 * height, 1.7, number))
    for _ in range(5):
        turn, z, out = rng.uniform(0.0, 2 * np.pi), middle + rng.uniform(-0.15, 0.22) * height, 0.6 * radius
        center = (x + out * np.cos(turn), y + out * np.sin(turn), z)
        scene.crowns.append((*center, 0.45 * radius, 0.14 * height, 1.1, number))


def plant_hedge(scene: Scene, line: Rect, height: float) -> None:
    """Plant a dense hedge along the length of a rectangle."""
    number = scene.new_id()
    line_of_bushes = np.column_stack(line.at(np.arange(-line.length / 2, line.length / 2, 0.5), 0.0))
    for x, y, ground in _feet(scene, line_of_bushes):
        scene.crowns.append((x, y, ground + height / 2, line.width / 2, height / 2, 0.25, number))
