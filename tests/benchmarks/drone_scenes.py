"""Places that are hard to map from a drone's photographs, simulated with the faults of dense matching.

A dense town of flat roofs, a campus with large flat roofs under trees, a hamlet cut into a slope: each a function
that returns a scene, whose buildings carry the true outlines of their walls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.simulation.bodies import Rect, flat
from lidar_buildings.algorithms.simulation.plants import plant_trees
from lidar_buildings.algorithms.simulation.relief import Relief
from lidar_buildings.algorithms.simulation.scene import Scene
from lidar_buildings.algorithms.simulation.simulate_village import photograph
from lidar_buildings.algorithms.simulation.town_houses import Site
from lidar_buildings.algorithms.simulation.town_layout import CAR, park_car
from lidar_buildings.algorithms.simulation.village_layout import Home
from lidar_buildings.algorithms.stage import Monitor

# A parapet on a flat roof: width and height (m).
_PARAPET = (0.3, 0.5)

# Length and width of the blocks of the town (m).
_BLOCK = (46.0, 24.0)

# Width of the streets between them (m).
_STREET = 8.0

# Cells (m) of the surface that matching smooths.
_CELL = 0.1

# Points lower than the surface by more than this (m) are of sides.
_BELOW = 0.4


@dataclass(frozen=True)
class Matching:
    """How dense matching errs, by standard deviations (m) and the share of sides of buildings that are ``missing``.

    ``rounding`` is for the window that smooths steps, eaves and ridges, ``waves`` for waves of some meters,
    ``noise`` for single points, and ``smear`` for points of walls across them.
    """

    rounding: float = 0.15
    waves: float = 0.04
    noise: float = 0.02
    smear: float = 0.08
    missing: float = 0.4


def dense_town(blocks: int = 3, seed: int = 1) -> Scene:
    """Blocks of touching flat roofs at 3 to 18 m, most with parapets, on both sides of narrow courts."""
    rng = np.random.default_rng(seed)
    pitch = np.array(_BLOCK) + _STREET
    town = Scene(Relief(float(blocks * pitch[0]) + 2 * _STREET, gradient=0.02))
    for column in range(blocks):
        for row in range(int((town.size - 2 * _STREET) // pitch[1])):
            middle = _STREET + pitch / 2 + [column, row] * pitch
            _block(town, Rect(*map(float, middle), *_BLOCK, 0.04), rng)
    for x, y in rng.uniform(0.0, town.size, (10 * blocks, 2)):
        car = Rect(float(x), float(y), *CAR, 0.04)
        if not town.near_building(car.corners(), 0.5).any():
            park_car(town, car)
    return town


def _block(town: Scene, block: Rect, rng: np.random.Generator) -> None:
    """Build two rows of houses back to back, each with its own height, depth and width."""
    for side in (-1, 1):
        along = -block.length / 2
        while block.length / 2 - along > 7.0:
            width = min(float(rng.uniform(7.0, 13.0)), block.length / 2 - along)
            depth = float(rng.uniform(8.0, block.width / 2))
            across = side * (block.width - depth) / 2
            _flat_house(town, block.part(along + width / 2, across, width, depth), float(rng.choice(range(3, 19, 3))))
            along += width


def _flat_house(scene: Scene, rect: Rect, eave: float) -> None:
    """Put up a house with a flat roof, a parapet around it and, on the large ones, a stair house."""
    site = Site(scene, rect, eave)
    width, height = _PARAPET
    level = site.floor + eave
    solids = [site.solid(rect, flat(rect, level))]
    for length, across, turn in ((rect.length, rect.width, 0.0), (rect.width, rect.length, np.pi / 2)):
        for side in (-1, 1):
            way = side * (across - width) / 2
            wall = rect.part(0.0, way, length, width) if not turn else rect.part(way, 0.0, length, width, turn)
            solids.append(site.solid(wall, flat(wall, level + height)))
    if rect.length * rect.width > 90.0:
        stairs = rect.part(0.0, 0.0, 3.0, 3.0)
        solids.append(site.solid(stairs, flat(stairs, level + 2.4)))
    scene.add_building("flat", rect.corners(), solids)


def campus() -> Scene:
    """A flat roof of 80 m by 70 m with a skylight, wings of 12 m, a hall of 45 m and tall trees around."""
    land = Scene(Relief(220.0, gradient=0.01))
    main = Rect(80.0, 80.0, 80.0, 70.0, 0.1)
    _flat_house(land, main, 9.0)
    for along, across, length, width, eave in ((50.0, 60.0, 12.0, 60.0, 6.0), (100.0, 20.0, 45.0, 45.0, 11.0)):
        _flat_house(land, main.part(along, across, length, width), eave)
    _flat_house(land, main.part(-20.0, 75.0, 70.0, 12.0), 6.5)
    plant_trees(land, 30.0, 0.0, np.random.default_rng(2), Monitor())
    return land


@dataclass(frozen=True)
class Terraced(Relief):
    """A slope in which each house has a level of its own, cut into the slope and filled up below."""

    levels: tuple[tuple[Rect, float], ...] = ()

    def ground(self, x, y) -> np.ndarray:
        """Elevation (m) of the ground: level around houses, and banks between."""
        z = super().ground(x, y)
        for rect, floor in self.levels:
            along, across = rect.local(x, y)
            away = np.maximum(np.maximum(np.abs(along) - rect.length / 2, np.abs(across) - rect.width / 2), 0.0)
            # Banks of 50° next to the level.
            z = np.clip(z, floor - 1.2 * away, floor + 1.2 * away)
        return z

    @property
    def spread(self) -> float:
        """Height (m) that the ground never leaves the plane by."""
        return super().spread + 6.0


def hamlet(seed: int = 3) -> Scene:
    """Twelve gable houses cut into a slope of 18°, uphill eaves 0.3 to 2.5 m above the terrain behind them."""
    rng = np.random.default_rng(seed)
    slope = Relief(120.0, 0.3, float(np.tan(np.deg2rad(18.0))))
    houses, levels = [], []
    for i, (x, y) in enumerate((x, y) for x in (22.0, 60.0, 98.0) for y in (18.0, 46.0, 74.0, 102.0)):
        turn = slope.angle + np.pi / 2 * (i % 3 == 1) + float(rng.uniform(-0.1, 0.1))
        rect = Rect(x + float(rng.uniform(-4, 4)), y + float(rng.uniform(-3, 3)), *rng.uniform((9, 7), (13, 9)), turn)
        uphill = float(slope.ground(*rect.corners(0.6).T).max())
        eave = float(rng.uniform(2.6, 4.5))
        floor = uphill + float(rng.uniform(0.3, 2.5)) - eave
        houses.append((rect, floor, eave, float(np.tan(np.deg2rad(rng.uniform(22.0, 38.0))))))
        levels.append((rect.part(-2.0, 0.0, rect.length, rect.width), floor))
    land = Scene(Terraced(120.0, 0.3, slope.gradient, levels=tuple(levels)))
    for rect, floor, eave, pitch in houses:
        home = Home(land, rect, eave)
        home.eave, home.bottom = floor + eave, floor - 6.0
        land.add_building("gable", rect.corners(), home.wing(rect, pitch, 0.6))
    plant_trees(land, 15.0, 0.0, rng, Monitor())
    return land


def stone_roofs(village: Scene) -> dict[int, float]:
    """Return the share of every third roof, by object id, of which nothing is found; of one roof a third."""
    # The roof of a home is the object after its walls.
    holes = {building.object_id + 1: 0.25 for building in village.buildings[::3]}
    return {**holes, village.buildings[5].object_id + 1: 0.35}


def matched(scene: Scene, density: float, matching: Matching, holes: dict[int, float], seed: int = 1) -> dict:
    """Return the cloud of a scene as dense matching gives it.

    Parameters
    ----------
    scene : Scene
        What there is.
    density : float
        Points per square meter of open ground.
    matching : Matching
        How it errs.
    holes : dict
        Share of the roof, by object id, that is found nowhere, in patches of a meter or so.
    seed : int
        Start of the random numbers.

    Returns
    -------
    dict of ndarray
        ``xyz`` (n, 3) and ``classification`` (n,), all 0.
    """
    rng = np.random.default_rng([seed, 9])
    xyz, seen = photograph(scene, density=density, oblique=28.0, seed=seed, monitor=Monitor())
    number = seen.object_id
    top, cell = _surface(xyz)
    is_side = (seen.classification == PointClass.BUILDING) & (xyz[:, 2] < top[cell] - _BELOW)
    smooth = ndimage.gaussian_filter(top, matching.rounding / _CELL)
    z = np.where(is_side | (xyz[:, 2] < top[cell] - _BELOW), xyz[:, 2], smooth[cell])
    across = matching.smear * _waves(xyz[:, :2], rng)[:, None] * is_side[:, None]
    made = np.column_stack([xyz[:, :2] + across, z + matching.waves * _waves(xyz[:, :2], rng)])
    kept = ~(is_side & _without_walls(scene, xyz, number, matching.missing, rng))
    kept &= _outside_patches(xyz[:, :2], np.array([holes.get(i, 0.0) for i in range(scene.objects + 1)])[number], rng)
    made = (made + matching.noise * rng.standard_normal(made.shape))[kept]
    return {"xyz": made, "classification": np.zeros(len(made), np.uint8)}


def _outside_patches(xy: np.ndarray, share: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return which points (n,) are found where a ``share`` (n,) of all is lost in patches of a meter or so."""
    patches = _waves(xy, rng, 1.0, 2.5)
    rank = np.empty(len(patches))
    rank[np.argsort(patches)] = np.arange(len(patches)) / len(patches)
    return rank < 1 - share


def _surface(xyz: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Return the highest elevation (m) in each cell, filled, and the cell of each point."""
    row, column = (np.floor(xyz[:, axis] / _CELL).astype(np.int64) for axis in (1, 0))
    row, column = row - row.min(), column - column.min()
    top = np.full((row.max() + 1, column.max() + 1), -np.inf)
    np.maximum.at(top, (row, column), xyz[:, 2])
    nearest = ndimage.distance_transform_edt(np.isinf(top), return_distances=False, return_indices=True)
    return top[tuple(nearest)], (row, column)


def _waves(xy: np.ndarray, rng: np.random.Generator, shortest: float = 2.0, longest: float = 8.0) -> np.ndarray:
    """Return a smooth random field (n,) of unit deviation at positions (n, 2), m."""
    count = 24
    length, heading, phase = rng.uniform((shortest, 0, 0), (longest, 2 * np.pi, 2 * np.pi), (count, 3)).T
    total = np.zeros(len(xy))
    for wave, way, start in zip(length, heading, phase):
        total += np.sin(2 * np.pi / wave * (xy @ [np.cos(way), np.sin(way)]) + start)
    return total * np.sqrt(2 / count)


def _without_walls(
    scene: Scene, xyz: np.ndarray, number: np.ndarray, share: float, rng: np.random.Generator
) -> np.ndarray:
    """Return which points (n,) are of sides of buildings that matching finds nothing of."""
    lost = np.zeros(len(xyz), bool)
    for building in scene.buildings:
        own = np.flatnonzero(number == building.object_id)
        ring = building.outline
        normals = np.column_stack([np.diff(ring[:, 1]), -np.diff(ring[:, 0])])
        normals /= np.hypot(*normals.T)[:, None]
        away = np.abs(np.einsum("nkj,kj->nk", xyz[own, None, :2] - ring[None, :-1], normals))
        lost[own] = (rng.random(len(normals)) < share)[np.argmin(away, axis=1)]
    return lost


def places() -> list[tuple[str, Scene, dict]]:
    """Return the places by name: the scene and the cloud of it."""
    town, land, slope = dense_town(), campus(), hamlet()
    return [
        ("dense town of flat roofs", town, matched(town, 59.0, Matching(), {})),
        ("campus with large flat roofs", land, matched(land, 58.0, Matching(), {})),
        ("hamlet cut into a slope", slope, matched(slope, 104.0, Matching(), stone_roofs(slope))),
    ]
