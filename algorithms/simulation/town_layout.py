"""Layout of a simulated town: streets with plots, a river with bridges, a forest, and other objects."""

import itertools
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..stage import Monitor
from .bodies import Body, Rect, inclined
from .plants import in_forest, plant_hedge, plant_trees
from .relief import VALLEY, Relief, make_relief
from .scene import Scene
from .town_houses import build_hall, build_house

# Distance (m) between the axes of neighboring streets, with two rows of plots between them.
_STREET_SPACING = 40.0

# Width of a street (m).
_STREET_WIDTH = 8.0

# Least distance of plots and poles from the edges of the town (m).
_EDGE = 1.0

# Length and width of a car (m).
CAR = (4.3, 1.8)

# Buildings per hectare with all plots occupied: about the number of plots on a hectare of streets and plots.
MAX_BUILDINGS = 34


@dataclass(frozen=True)
class TownPlan:
    """Contents of a town: tunables of :func:`.simulate_town.simulate_town`."""

    size: float = 200.0  #: Side of the square, m
    slope: float = 3.0  #: Mean slope of the ground, °
    relief: float = 2.0  #: Height difference between hollows and hills, m
    terrace_height: float = 1.5  #: Rise of the terraces, m
    buildings: float = 20.0  #: Buildings per hectare
    trees: float = 20.0  #: Trees per hectare
    forest: float = 0.1  #: Share covered by forest
    river: bool = True  #: Whether there is a river
    clutter: bool = True  #: Whether there are cars, hedges, walls and wires
    seed: int = 1  #: The same seed gives the same town


def build_town(plan: TownPlan, monitor: Optional[Monitor] = None) -> Scene:
    """Return a simulated town, deterministic for a plan."""
    monitor = monitor or Monitor()
    rng = np.random.default_rng([plan.seed, 0])
    relief = make_relief(plan.size, plan.slope, plan.relief, plan.terrace_height, plan.river, rng)
    scene = Scene(relief)
    plots = _plots(scene, plan.forest)
    if plan.buildings:
        hall = _hall_position(scene, plots)
        if hall is not None:
            build_hall(scene, hall)
            plots = [plot for plot in plots if not hall.contains(*plot.corners(-1.0).T).any()]
        # The density of buildings refers to the plots outside river and forest.
        built = min(len(plots), round(len(plots) * plan.buildings / MAX_BUILDINGS))
        for k, i in enumerate(np.sort(rng.permutation(len(plots))[:built])):
            build_house(scene, plots[i], rng)
            monitor.progress(0.4 * k / built)
    if relief.river is not None:
        _build_bridges(scene, relief.river)
    if plan.clutter:
        _clutter(scene, plots, rng, monitor.part(0.4, 0.6))
    plant_trees(scene, plan.trees, plan.forest, rng, monitor.part(0.6, 1.0))
    return scene


def _street_lines(size: float, spacing: float = _STREET_SPACING) -> np.ndarray:
    """Return the positions of the streets in the direction *along* a town (m)."""
    reach = np.ceil(size / spacing)
    return (np.arange(-reach, reach) + 0.5) * spacing


def plots_along_streets(relief: Relief, spacing: float, length: float, depth: float, per_block: int = 0) -> list[Rect]:
    """Return the plots at both sides of streets inside a town.

    Parameters
    ----------
    relief : Relief
        The terrain.
    spacing : float
        Distance between the axes of neighboring streets, m.
    length, depth : float
        Length along the street and depth of a plot, m.
    per_block : int
        Plots between side streets, which are half as wide as a plot; 0 for no side streets.
    """
    found, n_half = [], int(relief.size // length)
    for street, side, i in itertools.product(_street_lines(relief.size, spacing), (1, -1), range(-n_half, n_half)):
        across = (i + 0.5 * (i // per_block if per_block else 1)) * length
        along = street + side * (_STREET_WIDTH + depth) / 2
        plot = relief.frame.part(across, along, length, depth, 0.0 if side > 0 else np.pi)
        if plot.corners().min() > _EDGE and plot.corners().max() < relief.size - _EDGE:
            found.append(plot)
    return found


def _plots(scene: Scene, forest: float) -> list[Rect]:
    """Return the plots of 14 m by 16 m, except in the forest, 3 m around it, and in the river valley."""
    relief = scene.relief
    plots = plots_along_streets(relief, _STREET_SPACING, 14.0, 16.0, per_block=6)
    if relief.river is not None:
        # Half a plot from the valley floor to the center of a plot.
        plots = [plot for plot in plots if abs(relief.frame.local(plot.x, plot.y)[0] - relief.river) >= VALLEY + 7.0]
    return [plot for plot in plots if not in_forest(scene, plot.corners(3.0), forest).any()]


def _hall_position(scene: Scene, plots: list[Rect]) -> Optional[Rect]:
    """Return the footprint of a hall in the middle of a block of plots, None without sufficiently level ground."""
    x, y = np.array([(plot.x, plot.y) for plot in plots]).reshape(-1, 2).T
    for plot in plots:
        position = plot.part(0.0, plot.width / 2, 40.0, 27.0)
        # The hall covers three plots on both sides, with at most 5 m difference of the ground between its corners.
        if position.contains(x, y).sum() == 6 and np.ptp(scene.relief.ground(*position.corners().T)) < 5.0:
            return position
    return None


def _build_bridges(scene: Scene, river: float) -> None:
    """Add a bridge over the river for every street."""
    # The valley floor is at elevation 0.
    for street in _street_lines(scene.size):
        deck = scene.relief.frame.part(river, street, 2 * VALLEY - 8.0, 6.0)
        if np.abs(deck.corners() - scene.size / 2).max() > scene.size / 2:
            continue
        number, top = scene.new_id(), 0.15
        scene.add_box(deck, top - 0.9, top, PointClass.BRIDGE_DECK, number)
        for side in (-1, 1):
            rail = deck.part(0.0, side * 2.9, deck.length, 0.2)
            scene.add_box(rail, top - 0.9, top + 1.0, PointClass.UNCLASSIFIED, number)


def _clutter(scene: Scene, plots: list[Rect], rng: np.random.Generator, monitor: Monitor) -> None:
    """Add cars on the streets, hedges and walls between the plots, and wires along one street."""
    lines = [plot.part(-plot.length / 2, 3.0, plot.width - 6.0, 0.9, np.pi / 2) for plot in plots]
    corners = np.array([line.corners() for line in lines]).reshape(-1, 2)
    is_free = ~scene.near_building(corners, 0.2).reshape(-1, 4).any(axis=1)
    for i, (plot, line, free) in enumerate(zip(plots, lines, is_free)):
        car, border, position = rng.random(3)
        # Half of the plots have a car in front of them, 30 % a hedge and 20 % a wall at one side.
        if car < 0.5:
            park_car(scene, plot.part(8.0 * position - 4.0, -plot.width / 2 - 1.4, *CAR))
        if free and border < 0.3:
            plant_hedge(scene, line, 1.7)
        elif free and border < 0.5:
            wall = Rect(line.x, line.y, line.length, 0.3, line.angle)
            scene.solids.append(_follow_ground(scene, wall, 2.0, scene.new_id()))
        monitor.progress(i / len(plots))
    _string_wires(scene)


def _follow_ground(scene: Scene, rect: Rect, height: float, number: int) -> Body:
    """Return a solid with a top parallel to the ground at its center."""
    a, b, c = scene.relief.tangent(rect.x, rect.y)
    bottom = float(scene.relief.ground(*rect.corners().T).min()) - 1.0
    return Body(rect, np.array([[a, b, c + height]]), bottom, PointClass.UNCLASSIFIED, number)


def park_car(scene: Scene, body: Rect) -> None:
    """Add a car: body and cabin with inclined windows."""
    number = scene.new_id()
    cabin = body.part(-0.3, 0.0, 2.6, 1.6)
    ground = scene.relief.tangent(body.x, body.y)
    slants = [inclined(cabin, side * 1.3, 0.0, 0.85, side * -1.0, 0.0) + ground for side in (-1, 1)]
    roof = _follow_ground(scene, cabin, 1.45, number)
    scene.solids.append(_follow_ground(scene, body, 0.85, number))
    scene.solids.append(Body(cabin, np.vstack([roof.tops, slants]), roof.bottom, PointClass.UNCLASSIFIED, number))


def _string_wires(scene: Scene) -> None:
    """Add poles with three wires along the street through the middle of the town."""
    relief = scene.relief
    # Height of the poles, distance between them, and sag of the wires (m).
    height, span, sag = 8.5, 34.0, 0.8
    along = float(_street_lines(scene.size)[int(np.ceil(scene.size / _STREET_SPACING))]) + _STREET_WIDTH / 2 - 0.4
    x, y = relief.frame.at(np.arange(-scene.size, scene.size, span), along)
    # No pole is in the channel of the river.
    inside = (np.minimum(x, y) > _EDGE) & (np.maximum(x, y) < scene.size - _EDGE) & ~scene.near_water(x, y)
    feet = np.column_stack([x, y, relief.ground(x, y)])[inside]
    for foot in feet:
        pole = Rect(float(foot[0]), float(foot[1]), 0.3, 0.3, relief.angle)
        scene.add_box(pole, foot[2] - 1.0, foot[2] + height, PointClass.TRANSMISSION_TOWER)
    number, share = scene.new_id(), np.linspace(0.0, 1.0, 9)[:, None]
    for start, end in zip(feet, feet[1:]):
        for offset in (-0.9, 0.0, 0.9):
            shift = [-offset * np.sin(relief.angle), offset * np.cos(relief.angle), height - 0.2]
            line = start + share * (end - start) + shift - 4 * sag * share * (1 - share) * [0.0, 0.0, 1.0]
            scene.wires.extend((*p, *q, number) for p, q in zip(line, line[1:]))
