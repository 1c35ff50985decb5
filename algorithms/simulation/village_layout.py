"""Layout of a simulated village: streets with large plots, houses with overhanging eaves, sheds, plants and cars."""

from dataclasses import dataclass

import numpy as np

from ..cloud.asprs import PointClass
from ..stage import Monitor
from .bodies import Body, Rect, flat, gable, hip, inclined, lean_to
from .plants import plant_hedge, plant_trees
from .relief import make_relief
from .scene import Building, Scene
from .town_houses import Site, l_outline, placed
from .town_layout import CAR, park_car, plots_along_streets

# Plots per hectare of streets and plots: the largest density of houses.
MAX_HOMES = 15

# Thickness of roofs (m); walls end halfway in it.
_THICKNESS = 0.2


@dataclass(frozen=True)
class Village:
    """A village: scene, owners of roofs, and free plots."""

    scene: Scene  #: All objects
    #: (m,): by object id, the id of the building for roofs, and the object's own id otherwise
    owner: np.ndarray
    free: list[Rect]  #: Plots without a house


def build_village(
    size: float, slope: float, buildings: float, trees: float, overhang: float, clutter: bool, seed: int
) -> Village:
    """Return a simulated village.

    Parameters
    ----------
    size : float
        Side of the square, m.
    slope : float
        Mean slope of the ground, °.
    buildings, trees : float
        Houses and trees per hectare.
    overhang : float
        Overhang of the eaves, m.
    clutter : bool
        Whether to add cars, hedges and bushes.
    seed : int
        The same seed gives the same village.
    """
    rng = np.random.default_rng([seed, 2])
    # The height difference between hollows and hills is 2 m.
    scene = Scene(make_relief(size, slope, 2.0, 0.0, False, rng))
    plots = plots_along_streets(scene.relief, 60.0, 22.0, 26.0)
    count = min(len(plots), round(len(plots) * buildings / MAX_HOMES))
    order = rng.permutation(len(plots))
    built, free = [plots[i] for i in np.sort(order[:count])], [plots[i] for i in order[count:]]
    roofs = [roof for plot in built for roof in _build_homes(scene, plot, overhang, rng)]
    if clutter:
        _clutter(scene, built, rng)
    plant_trees(scene, trees, 0.0, rng, Monitor())
    owner = np.arange(scene.objects + 1)
    owner[roofs] = [building.object_id for building in scene.buildings]
    return Village(scene, owner, free)


def _clutter(scene: Scene, plots: list[Rect], rng: np.random.Generator) -> None:
    """Add cars on drives, hedges between plots, and bushes next to walls."""
    for plot in plots:
        car = plot.part(plot.length / 2 - 2.0, -plot.width / 2 + rng.uniform(2.5, 8.0), *CAR, np.pi / 2)
        if rng.random() < 0.4 and not scene.near_building(car.corners(), 0.4).any():
            park_car(scene, car)
        hedge = plot.part(-plot.length / 2, 0.0, plot.width - 4.0, 0.8, np.pi / 2)
        line = np.column_stack(hedge.at(np.linspace(-hedge.length / 2, hedge.length / 2, 20), 0.0))
        if rng.random() < 0.4 and not scene.near_building(line, 0.6).any():
            plant_hedge(scene, hedge, rng.uniform(1.2, 2.2))
    for building in scene.buildings:
        _plant_against_walls(scene, building, rng)


def _plant_against_walls(scene: Scene, building: Building, rng: np.random.Generator) -> None:
    """Plant up to three bushes close to the walls of a building."""
    ring = building.outline
    for _ in range(int(rng.integers(4))):
        k = int(rng.integers(len(ring) - 1))
        step = ring[k + 1] - ring[k]
        # The ring is counterclockwise: the outside is on the right of each wall.
        outward = np.array([step[1], -step[0]]) / np.hypot(*step)
        radius = rng.uniform(0.4, 0.8)
        x, y = ring[k] + rng.random() * step + rng.uniform(0.3, 0.7) * radius * outward
        ground = float(scene.relief.ground(x, y))
        scene.crowns.append((float(x), float(y), ground + 0.9 * radius, radius, radius, 0.15, scene.new_id()))


class Home(Site):
    """A site whose roof has its own object id, to distinguish it from the walls."""

    def __init__(self, scene: Scene, rect: Rect, eave: float) -> None:
        super().__init__(scene, rect, eave)
        self.roof_id = scene.new_id()

    def slab(self, rect: Rect, tops: np.ndarray, under: np.ndarray) -> Body:
        """Return a part of the roof between planes (a, b, c): ``tops`` (k, 3) and ``under`` (3,)."""
        a, b, c = under
        return Body(rect, tops, float((rect.corners() @ [a, b]).min() + c), PointClass.BUILDING, self.roof_id, under)

    def wing(self, rect: Rect, pitch: float, overhang: float, *cut: np.ndarray) -> list[Body]:
        """Return walls on ``rect`` and the two slabs of a gable roof, all limited by the planes ``cut`` above."""
        tops, half = gable(rect, self.eave, pitch), rect.width / 2
        solids = [self.solid(rect, np.vstack([tops, *cut]) - [0.0, 0.0, _THICKNESS / 2])]
        for side, top in zip((-1, 1), tops):
            slab = rect.part(0.0, side * (half + overhang) / 2, rect.length + 2 * overhang, half + overhang)
            solids.append(self.slab(slab, np.vstack([top, *cut]), top - [0.0, 0.0, _THICKNESS]))
        return solids


def _build_homes(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> list[int]:
    """Add a house on a plot, and a shed for two houses of three; return the object ids of their roofs."""
    build = (_rectangle, _rectangle, _hip, _angle, _bend)[int(rng.integers(5))]
    roofs = [build(scene, plot, overhang, rng)]
    if rng.random() < 2 / 3:
        roofs.append(_shed(scene, plot, overhang, rng))
    return roofs


def _shed(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    """Add a shed or garage with a single roof plane in a back corner of the plot."""
    long, wide = rng.uniform(3.0, 6.0), rng.uniform(2.6, 4.0)
    along, across = rng.choice((-1, 1)) * (plot.length - long - 3.0) / 2, (plot.width - wide - 3.0) / 2
    rect = plot.part(float(along), across, long, wide, np.deg2rad(rng.uniform(-6.0, 6.0)))
    home, over = Home(scene, rect, 2.75), overhang / 2
    walls = lean_to(rect, home.eave, float(np.tan(np.deg2rad(rng.uniform(2.0, 9.0)))))
    slab = home.slab(rect.part(0.0, 0.0, long + 2 * over, wide + 2 * over), walls, walls[0] - [0.0, 0.0, _THICKNESS])
    scene.add_building("shed", rect.corners(), [home.solid(rect, walls - [0.0, 0.0, _THICKNESS / 2]), slab])
    return home.roof_id


def _drawn(plot: Rect, rng: np.random.Generator, length: tuple, width: tuple) -> tuple[Rect, float, float]:
    """Return a footprint, the height of the eaves above the floor (m), for one or two storeys, and a pitch."""
    rect = placed(plot, rng, length, width, front=3.5, play=2)
    return rect, float(rng.choice((2.9, 5.6))), float(np.tan(np.deg2rad(rng.uniform(25.0, 42.0))))


def _rectangle(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    rect, eave, pitch = _drawn(plot, rng, (9.0, 13.0), (6.5, 8.5))
    home = Home(scene, rect, eave)
    ridge = home.eave + pitch * rect.width / 2
    stack = rect.part(rng.uniform(-0.25, 0.25) * rect.length, 0.8, 0.6, 0.6)
    chimney = Body(stack, flat(stack, ridge + 0.6), home.bottom, PointClass.BUILDING, home.roof_id)
    scene.add_building("rectangle", rect.corners(), [*home.wing(rect, pitch, overhang), chimney])
    return home.roof_id


def _hip(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    """Add a house with a hip roof: a convex solid with a level underside, like eaves with soffits."""
    rect, eave, pitch = _drawn(plot, rng, (9.5, 13.0), (7.0, 9.0))
    home = Home(scene, rect, eave)
    level = home.eave - pitch * overhang
    roof = rect.part(0.0, 0.0, rect.length + 2 * overhang, rect.width + 2 * overhang)
    # A vertical fascia with the thickness of the roof.
    slab = home.slab(roof, hip(roof, level, pitch) + [0.0, 0.0, _THICKNESS], np.array([0.0, 0.0, level]))
    scene.add_building("hip", rect.corners(), [home.solid(rect, flat(rect, level)), slab])
    return home.roof_id


def _angle(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    """Add an L-shaped house: a lower wing, flush with one gable, whose ridge ends in the roof of the main house."""
    main, eave, pitch = _drawn(plot, rng, (11.0, 13.0), (6.5, 7.5))
    home = Home(scene, main, eave)
    wide, reach, side = rng.uniform(4.5, 5.5), rng.uniform(3.0, 5.0), rng.choice((-1.0, 1.0))
    a, c = main.length / 2, main.width / 2
    # The wing starts near the middle of the house, so that its roof does not emerge at the front.
    start = min(2 * overhang, c)
    wing = main.part(side * (a - wide / 2), (start + c + reach) / 2, c + reach - start, wide, np.pi / 2)
    solids = [part for rect in (main, wing) for part in home.wing(rect, pitch, overhang)]
    scene.add_building("L", l_outline(main, (wide, reach), side), solids)
    return home.roof_id


def _bend(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    """Add a bent house: two wings of the same width that meet at an angle of 140° to 165°."""
    first, eave, pitch = _drawn(plot, rng, (6.0, 8.0), (6.0, 7.0))
    turn, long = np.deg2rad(rng.uniform(15.0, 40.0)), rng.uniform(5.0, 6.5)
    half = first.width / 2
    # The axes meet at the end of the first one; both wings extend to the outer corner.
    past = half * np.tan(turn / 2)
    first = first.part(-0.35 * long, 0.0, first.length, first.width)
    joint = first.part(first.length / 2, 0.0, 0.0, first.width)
    bent = Rect(joint.x, joint.y, 0.0, first.width, first.angle + turn)
    home = Home(scene, bent.part(0.0, 0.0, first.length + long, first.width), eave)
    outer = [inclined(rect, 0.0, -half, home.eave, 0.0, pitch) for rect in (first, bent)]
    one = first.part(past / 2, 0.0, first.length + past, first.width)
    other = bent.part((long - past) / 2, 0.0, long + past, first.width)
    solids = home.wing(one, pitch, overhang, outer[1]) + home.wing(other, pitch, overhang, outer[0])
    ends = first.length / 2
    outline = [first.at(-ends, -half), first.at(ends + past, -half), bent.at(long, -half)]
    outline += [bent.at(long, half), first.at(ends - past, half), first.at(-ends, half)]
    scene.add_building("bend", np.array(outline, float), solids)
    return home.roof_id
