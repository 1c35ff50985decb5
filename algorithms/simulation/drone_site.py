"""A made-up site for a drone: houses cut into slopes, sheds, vans, and large flat roofs with parapets."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from .bodies import Body, Rect, flat
from .scene import Scene
from .town_houses import Site
from .town_layout import CAR, TownPlan, build_town, park_car

# Least and greatest length of halls (m).
_HALL_SIZES = (10.0, 100.0)

# Least and greatest height of the roofs of halls (m).
_HALL_HEIGHTS = (3.0, 9.0)

# Height of the parapets around the roofs of halls (m).
_PARAPET_HEIGHT = 0.6

# Width of parapets (m).
_PARAPET_WIDTH = 0.35

# Number of flat roofs that touch in a block.
_BLOCK_ROOFS = 4

# Depth of a block (m).
_BLOCK_DEPTH = 12.0

# Largest difference of a roof of a block from the mean height of its roofs (m).
_BLOCK_STEP = 0.8

# Length and width of vans (m).
_VAN = (5.4, 2.0)

# Least and greatest height of vans (m).
_VAN_HEIGHT = (1.9, 2.6)

# Vans and cars added per hectare.
_VANS = 8

# Positions that are tried for each object before it is left out.
_TRIES = 60

# Least distance of an object from buildings (m).
_ROOM = 3.0


def build_site(plan: TownPlan, halls: int) -> Scene:
    """Return a made-up site: a town without wires, with flat halls, vans and a block; the same for the same plan."""
    scene = build_town(plan)
    # A camera doesn't see wires.
    scene.wires.clear()
    rng = np.random.default_rng([plan.seed, 5])
    for k in range(halls):
        _add_hall(scene, k, rng)
    if plan.buildings and halls:
        _add_block(scene, rng)
    for _ in range(round(_VANS * plan.size**2 / 1e4)):
        _add_van(scene, rng)
    return scene


def _free_rectangle(scene: Scene, long: float, wide: float, rng: np.random.Generator) -> Rect | None:
    """Return a free rectangle of these sides (m) anywhere on the site, None where none was found."""
    reach = np.hypot(long, wide) / 2 + 1.0
    if 2 * reach >= scene.size:
        return None
    for _ in range(_TRIES):
        x, y = rng.uniform(reach, scene.size - reach, 2)
        rect = Rect(float(x), float(y), long, wide, scene.relief.angle + float(rng.choice([0.0, np.pi / 2])))
        across, along = (np.linspace(-0.5, 0.5, max(2, int(side / 2))) * side for side in (wide, long))
        grid = np.stack(np.meshgrid(along, across), axis=-1).reshape(-1, 2)
        if not scene.buildings or not scene.near_building(np.column_stack(rect.at(*grid.T)), _ROOM).any():
            return rect
    return None


def _clear(scene: Scene, rect: Rect) -> None:
    """Remove plants and vehicles where a building is put."""
    scene.crowns[:] = [row for row in scene.crowns if not rect.contains(row[0], row[1], row[3] + 0.5)]
    scene.solids[:] = [
        solid
        for solid in scene.solids
        if solid.classification == PointClass.BUILDING or not rect.contains(solid.rect.x, solid.rect.y, 2.5)
    ]


def _add_hall(scene: Scene, k: int, rng: np.random.Generator) -> None:
    """Put a flat roof with a parapet, the k-th of sides spread evenly from the least to the greatest."""
    least, most = _HALL_SIZES
    # Steps of the golden ratio spread the lengths evenly, whatever the number of halls.
    long = min(least * (most / least) ** float(np.mod(0.35 + 0.382 * k, 1.0)), 0.6 * scene.size)
    rect = _free_rectangle(scene, long, long * rng.uniform(0.5, 0.8), rng)
    if rect is None:
        return
    _clear(scene, rect)
    site = Site(scene, rect, rng.uniform(*_HALL_HEIGHTS))
    scene.add_building("hall", rect.corners(), [site.solid(rect, flat(rect, site.eave)), *_parapets(site, rect)])


def _parapets(site: Site, rect: Rect) -> list[Body]:
    along, across = (rect.length - _PARAPET_WIDTH) / 2, (rect.width - _PARAPET_WIDTH) / 2
    parts = [rect.part(side * along, 0.0, _PARAPET_WIDTH, rect.width) for side in (-1, 1)]
    parts += [rect.part(0.0, side * across, rect.length, _PARAPET_WIDTH) for side in (-1, 1)]
    return [site.solid(part, flat(part, site.eave + _PARAPET_HEIGHT)) for part in parts]


def _add_block(scene: Scene, rng: np.random.Generator) -> None:
    """Put a block of touching flat roofs."""
    wide = rng.uniform(7.0, 11.0)
    rect = _free_rectangle(scene, _BLOCK_ROOFS * wide, _BLOCK_DEPTH, rng)
    if rect is None:
        return
    _clear(scene, rect)
    height = rng.uniform(5.0, 9.0)
    for k in range(_BLOCK_ROOFS):
        part = rect.part((k - (_BLOCK_ROOFS - 1) / 2) * wide, 0.0, wide, _BLOCK_DEPTH)
        site = Site(scene, part, height)
        top = site.eave + _BLOCK_STEP * float(rng.uniform(-1.0, 1.0))
        scene.add_building("flat", part.corners(), [site.solid(part, flat(part, top))])


def _add_van(scene: Scene, rng: np.random.Generator) -> None:
    """Park a van or a car where there is room."""
    rect = _free_rectangle(scene, *_VAN, rng)
    if rect is None:
        return
    if rng.random() < 0.5:
        park_car(scene, rect.part(0.0, 0.0, *CAR))
        return
    ground = float(scene.relief.ground(rect.x, rect.y))
    scene.add_box(rect, ground - 1.0, ground + rng.uniform(*_VAN_HEIGHT), PointClass.UNCLASSIFIED)
