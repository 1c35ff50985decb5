"""Detached houses of a village: walls under roofs that overhang them, with square and with other corners."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from .scene import Scene
from .solids import Rect, Solid, flat, gable, hip, inclined, lean_to
from .town_houses import Site, l_outline

# Roofs are this thick (m); walls end in the middle of them.
_THICKNESS = 0.2

# Eaves over the floor of one and two storeys (m).
_EAVES = (2.9, 5.6)


class Home(Site):
    """A site whose roof has an object id of its own, so that roof and walls can be distinguished."""

    def __init__(self, scene: Scene, rect: Rect, eave: float) -> None:
        super().__init__(scene, rect, eave)
        self.roof_id = scene.new_id()

    def slab(self, rect: Rect, tops: np.ndarray, under: np.ndarray) -> Solid:
        """Return a piece of roof, between its ``tops`` (k, 3) and ``under`` (3,), which lies below the first of them.

        Planes are z = a x + b y + c, by a, b and c.
        """
        a, b, c = under
        lowest = float((rect.corners() @ [a, b]).min() + c)
        return Solid(rect, tops, lowest, PointClass.BUILDING, self.roof_id, under)

    def wing(self, rect: Rect, eave: float, pitch: float, overhang: float, cut: np.ndarray) -> list[Solid]:
        """Return the walls on ``rect`` and the two slabs of a gable roof, all of them under the planes ``cut``."""
        middle = [0.0, 0.0, _THICKNESS / 2]
        solids = [self.solid(rect, np.concatenate([gable(rect, eave, pitch), cut]) - middle)]
        half = rect.width / 2
        for side in (-1, 1):
            slab = rect.part(0.0, side * (half + overhang) / 2, rect.length + 2 * overhang, half + overhang)
            top = inclined(rect, 0.0, side * half, eave, 0.0, -side * pitch)
            solids.append(self.slab(slab, np.concatenate([top[None], cut]), top - [0.0, 0.0, _THICKNESS]))
        return solids


def build_homes(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> list[int]:
    """Put a house on the front of a plot, and a shed behind two of three; return the object ids of their roofs.

    Parameters
    ----------
    scene, plot : Scene, Rect
        Receives the objects; the plot.
    overhang : float
        Overhang of the eaves, m.
    rng : numpy.random.Generator
        Source of random numbers.
    """
    build = (_rectangle, _rectangle, _hip, _angle, _bend)[int(rng.integers(5))]
    roofs = [build(scene, plot, overhang, rng)]
    if rng.random() < 2 / 3:
        roofs.append(_shed(scene, plot, overhang, rng))
    return roofs


def _shed(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    """Build a shed or garage with a single slope in a back corner."""
    long, wide = rng.uniform(3.0, 6.0), rng.uniform(2.6, 4.0)
    along, across = rng.choice((-1, 1)) * (plot.length - long - 3.0) / 2, (plot.width - wide - 3.0) / 2
    rect = plot.part(float(along), across, long, wide, np.deg2rad(rng.uniform(-6.0, 6.0)))
    home, over = Home(scene, rect, 2.75), overhang / 2
    walls = lean_to(rect, home.eave, float(np.tan(np.deg2rad(rng.uniform(2.0, 9.0)))))
    top = walls[0]
    slab = home.slab(rect.part(0.0, 0.0, long + 2 * over, wide + 2 * over), walls, top - [0.0, 0.0, _THICKNESS])
    solids = [home.solid(rect, walls - [0.0, 0.0, _THICKNESS / 2]), slab]
    scene.add_building("shed", rect.corners(), solids)
    return home.roof_id


def _placed(plot: Rect, rng: np.random.Generator, length: tuple, width: tuple) -> Rect:
    """Return a rectangle some meters behind the street, turned at will against it."""
    long, wide = rng.uniform(*length), rng.uniform(*width)
    front = -plot.width / 2 + rng.uniform(3.5, 4.5)
    return plot.part(rng.uniform(-1.0, 1.0), front + wide / 2, long, wide, np.deg2rad(rng.uniform(-8.0, 8.0)))


def _roof(rng: np.random.Generator) -> tuple[float, float]:
    """Return the height of the eave over the floor (m) and the pitch (a tangent)."""
    return float(rng.choice(_EAVES)), float(np.tan(np.deg2rad(rng.uniform(25.0, 42.0))))


# Planes that cut a roof: none.
_WHOLE = np.zeros((0, 3))


def _rectangle(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    rect, (eave, pitch) = _placed(plot, rng, (9.0, 13.0), (6.5, 8.5)), _roof(rng)
    home = Home(scene, rect, eave)
    ridge = home.eave + pitch * rect.width / 2
    stack = rect.part(rng.uniform(-0.25, 0.25) * rect.length, 0.8, 0.6, 0.6)
    chimney = Solid(stack, flat(stack, ridge + 0.6), home.bottom, PointClass.BUILDING, home.roof_id)
    solids = home.wing(rect, home.eave, pitch, overhang, _WHOLE)
    scene.add_building("rectangle", rect.corners(), [*solids, chimney])
    return home.roof_id


def _hip(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    """Build a hip roof: a convex block with a level underside, as eaves with soffits have."""
    rect, (eave, pitch) = _placed(plot, rng, (9.5, 13.0), (7.0, 9.0)), _roof(rng)
    home = Home(scene, rect, eave)
    level = home.eave - pitch * overhang
    roof = rect.part(0.0, 0.0, rect.length + 2 * overhang, rect.width + 2 * overhang)
    tops = hip(roof, level, pitch)
    # A vertical fascia as high as the roof is thick.
    slab = home.slab(roof, tops + [0.0, 0.0, _THICKNESS], np.array([0.0, 0.0, level]))
    scene.add_building("hip", rect.corners(), [home.solid(rect, flat(rect, level)), slab])
    return home.roof_id


def _angle(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    """Build an L: a lower wing, flush with one gable, whose ridge runs into the roof of the main house."""
    main, (eave, pitch) = _placed(plot, rng, (11.0, 13.0), (6.5, 7.5)), _roof(rng)
    home = Home(scene, main, eave)
    wide, reach, side = rng.uniform(4.5, 5.5), rng.uniform(3.0, 5.0), rng.choice((-1.0, 1.0))
    a, c = main.length / 2, main.width / 2
    # From next to the middle of the house, so that no end of the wing's roof comes out in front.
    start = min(2 * overhang, c)
    wing = main.part(side * (a - wide / 2), (start + c + reach) / 2, c + reach - start, wide, np.pi / 2)
    solids = [part for rect in (main, wing) for part in home.wing(rect, home.eave, pitch, overhang, _WHOLE)]
    scene.add_building("L", l_outline(main, (wide, reach), side), solids)
    return home.roof_id


def _bend(scene: Scene, plot: Rect, overhang: float, rng: np.random.Generator) -> int:
    """Build a house with a bend: two wings of one width that meet at an angle of 140° to 165°."""
    first, (eave, pitch) = _placed(plot, rng, (6.0, 8.0), (6.0, 7.0)), _roof(rng)
    turn, long = np.deg2rad(rng.uniform(15.0, 40.0)), rng.uniform(5.0, 6.5)
    half = first.width / 2
    # The axes meet where the first one's ends, and both wings go on to the outer corner.
    past = half * np.tan(turn / 2)
    first = first.part(-0.35 * long, 0.0, first.length, first.width)
    joint = first.part(first.length / 2, 0.0, 0.0, first.width)
    bent = Rect(joint.x, joint.y, 0.0, first.width, first.angle + turn)
    home = Home(scene, bent.part(0.0, 0.0, first.length + long, first.width), eave)
    level = home.eave
    outer = [inclined(rect, 0.0, -half, level, 0.0, pitch)[None] for rect in (first, bent)]
    one = first.part(past / 2, 0.0, first.length + past, first.width)
    other = bent.part((long - past) / 2, 0.0, long + past, first.width)
    solids = home.wing(one, level, pitch, overhang, outer[1]) + home.wing(other, level, pitch, overhang, outer[0])
    ends = first.length / 2
    outline = [first.at(-ends, -half), first.at(ends + past, -half), bent.at(long, -half)]
    outline += [bent.at(long, half), first.at(ends - past, half), first.at(-ends, half)]
    scene.add_building("bend", np.array(outline, float), solids)
    return home.roof_id
