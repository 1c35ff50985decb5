"""Buildings of a town by the shape of their roofs.

The length of a plot is parallel to the street, which is on its right side.
"""

from collections.abc import Callable

import numpy as np
from numpy.random import Generator

from ..cloud.asprs import PointClass
from .bodies import Body, Rect, flat, gable, hip, inclined, lean_to
from .scene import Building, Scene


class Site:
    """Elevations (m) of the floor, eaves and underground bottom of a building, and its object id."""

    def __init__(self, scene: Scene, rect: Rect, eave: float) -> None:
        self.object_id = scene.new_id()
        x, y = np.concatenate([rect.corners(1.0), [(rect.x, rect.y)]]).T
        ground = scene.relief.ground(x, y)
        # On the uphill side the eaves are at least 1.5 m above the ground.
        self.floor = float(max(ground.mean(), ground.max() + 1.5 - eave))
        self.eave = self.floor + eave
        self.bottom = float(ground.min()) - 1.0

    def solid(self, rect: Rect, tops: np.ndarray) -> Body:
        """Return a part of the building with top planes ``tops``."""
        return Body(rect, tops, self.bottom, PointClass.BUILDING, self.object_id)


def build_house(scene: Scene, plot: Rect, rng: Generator) -> None:
    """Add a house or a short row on a plot; half of the plots have a shed, too."""
    before, kinds = len(scene.buildings), list(_KINDS)
    kinds[int(rng.choice(len(kinds), p=list(_KINDS.values())))](scene, plot, rng)
    if rng.random() < 0.5:
        _shed(scene, plot, scene.buildings[before:], rng)


def placed(plot: Rect, rng: Generator, length: tuple, width: tuple, front: float = 2.0, play: int = 1) -> Rect:
    """Return the footprint of a house on a plot.

    Parameters
    ----------
    plot : Rect
        The plot.
    rng : numpy.random.Generator
        Source of random numbers.
    length, width : tuple of float
        Least and greatest length and width, m.
    front : float
        Least distance behind the street, m; the greatest is 1 m more.
    play : int
        Largest offset along the street (0.5 m) and turn against it (4°), times this.
    """
    long, wide = rng.uniform(*length), rng.uniform(*width)
    across = -plot.width / 2 + rng.uniform(front, front + 1.0) + wide / 2
    return plot.part(rng.uniform(-0.5, 0.5) * play, across, long, wide, np.deg2rad(rng.uniform(-4.0, 4.0) * play))


def _pitched(scene: Scene, rect: Rect, pitches: tuple, rng: Generator, eaves: tuple = (3.0, 5.7)) -> tuple[Site, float]:
    """Return a site with eaves at one of some heights (m), and a random pitch (a tangent) from a range (°)."""
    eave, pitch = rng.choice(eaves), np.tan(np.deg2rad(rng.uniform(*pitches)))
    return Site(scene, rect, eave), pitch


def _gable_house(scene: Scene, plot: Rect, rng: Generator) -> None:
    rect = placed(plot, rng, (9.0, 12.0), (7.0, 9.0))
    site, pitch = _pitched(scene, rect, (28.0, 48.0), rng)
    solids = [site.solid(rect, gable(rect, site.eave, pitch)), _chimney(site, rect, pitch, rng)]
    # Roofs steeper than 35° can have dormers.
    if pitch > 0.7:
        positions = rng.choice([-0.25, 0.0, 0.25], int(rng.integers(0, 3)), replace=False) * rect.length
        solids += [_dormer(site, rect, pitch, position, side) for position in positions for side in (-1, 1)]
    scene.add_building("gable", rect.corners(), solids)


def _hip_house(scene: Scene, plot: Rect, rng: Generator) -> None:
    rect = placed(plot, rng, (9.5, 12.0), (7.5, 9.5))
    site, pitch = _pitched(scene, rect, (22.0, 38.0), rng)
    solids = [site.solid(rect, hip(rect, site.eave, pitch)), _chimney(site, rect, pitch, rng)]
    scene.add_building("hip", rect.corners(), solids)


def _flat_house(scene: Scene, plot: Rect, rng: Generator) -> None:
    rect = placed(plot, rng, (9.0, 12.5), (8.0, 10.5))
    site = Site(scene, rect, rng.choice((3.2, 6.2, 9.2)))
    lift = rect.part(0.2 * rect.length, 0.1 * rect.width, 3.0, 2.5)
    solids = [site.solid(rect, flat(rect, site.eave)), site.solid(lift, flat(lift, site.eave + 2.2))]
    scene.add_building("flat", rect.corners(), solids)


def _angled_house(scene: Scene, plot: Rect, rng: Generator) -> None:
    """Add an L-shaped house: a wing whose lower ridge ends in the roof of the main house."""
    main = placed(plot, rng, (11.0, 12.5), (6.5, 7.0))
    site, pitch = _pitched(scene, main, (30.0, 45.0), rng)
    wide, reach = rng.uniform(4.8, 6.0), rng.uniform(3.0, 4.0)
    # The wing extends from below the main ridge to behind the house, flush with one gable.
    side = rng.choice((-1.0, 1.0))
    long = main.width / 2 + reach
    wing = main.part(side * (main.length - wide) / 2, long / 2, long, wide, np.pi / 2)
    solids = [site.solid(rect, gable(rect, site.eave, pitch)) for rect in (main, wing)]
    solids.append(_chimney(site, main, pitch, rng))
    scene.add_building("L", l_outline(main, (wide, reach), side), solids)


def l_outline(main: Rect, size: tuple[float, float], side: float) -> np.ndarray:
    """Return the outline (6, 2), m, of an L-shaped house.

    ``size`` is the width of the wing and its length behind the main house; it is at the end ``side`` (1 or -1).
    """
    wide, reach = size
    a, c, inner = main.length / 2, main.width / 2, main.length / 2 - wide
    ring = [(-a, -c), (a, -c), (a, c + reach), (inner, c + reach), (inner, c), (-a, c)]
    # Mirrored for a wing at the other end; reversed to keep the ring counterclockwise.
    ring = ring if side > 0 else [(-along, across) for along, across in reversed(ring)]
    return np.array([main.at(along, across) for along, across in ring])


def _row(scene: Scene, plot: Rect, rng: Generator) -> None:
    """Add two houses with a party wall that fill the plot, so that rows on neighboring plots adjoin."""
    depth = 10.0
    for side in (-0.25, 0.25):
        rect = plot.part(side * plot.length, -plot.width / 2 + 2.0 + depth / 2, plot.length / 2, depth)
        site, pitch = _pitched(scene, rect, (25.0, 45.0), rng, (5.4, 6.0, 8.4))
        tops = flat(rect, site.eave + 1.0) if rng.random() < 0.15 else gable(rect, site.eave, pitch)
        scene.add_building("row", rect.corners(), [site.solid(rect, tops)])


def _shed(scene: Scene, plot: Rect, houses: list[Building], rng: Generator) -> None:
    """Add a shed in a back corner of the garden, if space permits."""
    rect = plot.part(rng.choice((-1, 1)) * (plot.length / 2 - 2.2), plot.width / 2 - 1.7, *rng.uniform(2.2, 3.0, 2))
    height, pitch = rng.uniform(2.0, 2.4), np.tan(np.deg2rad(rng.uniform(0.0, 15.0)))
    if any(house.contains(*rect.corners(0.5).T).any() for house in houses):
        return
    site = Site(scene, rect, height)
    scene.add_building("shed", rect.corners(), [site.solid(rect, lean_to(rect, site.eave, pitch))])


def build_hall(scene: Scene, rect: Rect) -> None:
    """Add a large hall with a low gable roof and three skylights."""
    site, pitch = Site(scene, rect, 8.0), np.tan(np.deg2rad(4.0))
    solids = [site.solid(rect, gable(rect, site.eave, pitch))]
    ridge = site.eave + pitch * rect.width / 2
    for position in (-0.3, 0.0, 0.3):
        light = rect.part(position * rect.length, 0.0, 3.0, 0.7 * rect.width)
        solids.append(site.solid(light, flat(light, ridge + 0.8)))
    scene.add_building("hall", rect.corners(), solids)


def _chimney(site: Site, rect: Rect, pitch: float, rng: Generator) -> Body:
    ridge = site.eave + pitch * rect.width / 2
    stack = rect.part(rng.uniform(-0.12, 0.12) * rect.length, rng.uniform(-1.0, 1.0), 0.7, 0.7)
    return site.solid(stack, flat(stack, ridge + 0.8))


def _dormer(site: Site, rect: Rect, pitch: float, along: float, side: int) -> Body:
    """Return a dormer whose nearly flat roof ends in the roof plane behind it."""
    depth, back = 2.4, rect.width / 2 - 3.0
    box = rect.part(along, side * (back + depth / 2), 1.9, depth)
    behind = site.eave + pitch * (rect.width / 2 - back)
    return site.solid(box, inclined(box, 0.0, side * -depth / 2, behind, 0.0, side * -0.08)[None])


# Builders of houses, with the share of the plots that each is for.
_KINDS: dict[Callable[[Scene, Rect, Generator], None], float] = {
    _gable_house: 0.28,
    _hip_house: 0.16,
    _flat_house: 0.14,
    _angled_house: 0.16,
    _row: 0.26,
}
