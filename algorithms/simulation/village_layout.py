"""A made-up village: streets with large plots, a house on most, a shed behind it, plants and parked cars."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from ..stage import Monitor
from .plants import plant_hedge, plant_trees
from .relief import make_relief
from .scene import Building, Scene
from .solids import Rect
from .town_layout import park_car
from .village_houses import build_homes

# Distance (m) between the axes of neighboring streets, with two rows of plots between these.
_STREET_SPACING = 60.0

# Width of a street (m).
_STREET_WIDTH = 8.0

# Length along the street and depth of a plot (m).
_PLOT = (22.0, 26.0)

# Plots, and so houses at most, on a hectare of streets and plots.
MAX_HOMES = 15

# Height from hollows to hills (m).
_HILLS = 2.0


@dataclass(frozen=True)
class Village:
    """A scene with its plots."""

    scene: Scene  #: All its objects
    #: (m,): by object id, the id of the building where the object is its roof; the object's own id elsewhere
    owner: np.ndarray
    free: list[Rect]  #: Plots without a house


@dataclass(frozen=True)
class VillagePlan:
    """What a village holds: tunables of :func:`.simulate_village.simulate_village`."""

    size: float  #: Side of the square, m
    slope: float  #: Slope of the ground, °
    buildings: float  #: Houses per hectare
    trees: float  #: Trees per hectare
    overhang: float  #: Overhang of the eaves, m
    clutter: bool  #: Whether there are cars, hedges and bushes
    seed: int  #: The same seed makes the same village


def build_village(plan: VillagePlan) -> Village:
    """Return a made-up village, the same for the same plan."""
    rng = np.random.default_rng([plan.seed, 2])
    scene = Scene(make_relief(plan.size, plan.slope, _HILLS, 0.0, False, rng))
    plots = _plots(scene)
    count = min(len(plots), round(len(plots) * plan.buildings / MAX_HOMES))
    order = rng.permutation(len(plots))
    built, free = [plots[i] for i in np.sort(order[:count])], [plots[i] for i in order[count:]]
    roofs = [roof for plot in built for roof in build_homes(scene, plot, plan.overhang, rng)]
    if plan.clutter:
        _clutter(scene, built, rng)
    plant_trees(scene, plan.trees, 0.0, rng, Monitor())
    owner = np.arange(scene.objects + 1)
    owner[roofs] = [building.object_id for building in scene.buildings]
    return Village(scene, owner, free)


def _plots(scene: Scene) -> list[Rect]:
    """Return the plots that lie in the village with some room around."""
    relief, found = scene.relief, []
    reach, n_half = int(scene.size // _STREET_SPACING) + 1, int(scene.size // _PLOT[0])
    for street, side, i in itertools.product(range(-reach, reach), (1, -1), range(-n_half, n_half)):
        along = (street + 0.5) * _STREET_SPACING + side * (_STREET_WIDTH + _PLOT[1]) / 2
        x, y = relief.frame.at((i + 0.5) * _PLOT[0], along)
        plot = Rect(float(x), float(y), *_PLOT, relief.angle + (0.0 if side > 0 else np.pi))
        if plot.corners().min() > 1.0 and plot.corners().max() < scene.size - 1.0:
            found.append(plot)
    return found


def _clutter(scene: Scene, plots: list[Rect], rng: np.random.Generator) -> None:
    """Put cars on drives, hedges between plots, bushes against walls."""
    for plot in plots:
        car = plot.part(plot.length / 2 - 2.0, -plot.width / 2 + rng.uniform(2.5, 8.0), 4.3, 1.8, np.pi / 2)
        if rng.random() < 0.4 and not scene.near_building(car.corners(), 0.4).any():
            park_car(scene, car)
        hedge = plot.part(-plot.length / 2, 0.0, plot.width - 4.0, 0.8, np.pi / 2)
        line = np.column_stack(hedge.at(np.linspace(-hedge.length / 2, hedge.length / 2, 20), 0.0))
        if rng.random() < 0.4 and not scene.near_building(line, 0.6).any():
            plant_hedge(scene, hedge, rng.uniform(1.2, 2.2))
    for building in scene.buildings:
        _plant_against_walls(scene, building, rng)


def _plant_against_walls(scene: Scene, building: Building, rng: np.random.Generator) -> None:
    """Plant up to three bushes, each with its middle a little before a wall."""
    ring = building.outline
    for _ in range(int(rng.integers(4))):
        k = int(rng.integers(len(ring) - 1))
        step = ring[k + 1] - ring[k]
        # The ring runs counterclockwise: what lies to the right of a wall is outside.
        outward = np.array([step[1], -step[0]]) / np.hypot(*step)
        radius = rng.uniform(0.4, 0.8)
        x, y = ring[k] + rng.random() * step + rng.uniform(0.3, 0.7) * radius * outward
        ground = float(scene.relief.ground(x, y))
        scene.crowns.append((float(x), float(y), ground + 0.9 * radius, radius, radius, 0.15, scene.new_id()))
