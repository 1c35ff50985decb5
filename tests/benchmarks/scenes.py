"""Scenes far from a usual town, in which faults showed: simulated, with the truth, each a function of nothing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.simulation.bodies import Body, Rect, flat, gable, hip, lean_to
from lidar_buildings.algorithms.simulation.plants import plant_hedge, plant_tree, plant_trees
from lidar_buildings.algorithms.simulation.relief import Relief
from lidar_buildings.algorithms.simulation.scanner import AirSurvey, scan
from lidar_buildings.algorithms.simulation.scene import Scene
from lidar_buildings.algorithms.simulation.town_houses import Site
from lidar_buildings.algorithms.stage import Monitor

# Side of the scenes (m), but for the estate.
SIDE = 120.0

# Of strips that were not adjusted to one another, every second lies this much higher (m).
MISFIT = 0.08

# Height of maize (m).
MAIZE = 2.8

# Standard deviation (m) of how far below that leaves are, a fifth of them up to 2 m more.
LEAVES = 0.25

# Share of the pulses into maize that return from the ground.
THROUGH_MAIZE = 0.1


@dataclass
class Farmland(Scene):
    """A scene with fields of maize."""

    fields: tuple[Rect, ...] = ()


@dataclass(frozen=True)
class Steps(Relief):
    """A slope whose rise is gathered in steps of this height (m), 1.5 m wide, every 12 m."""

    step: float = 0.0

    def ground(self, x, y) -> np.ndarray:
        """Elevation (m) of the ground."""
        return self.plane(x, y) + self.step * (np.floor(x / 12) + np.clip((x % 12) / 1.5, 0, 1))

    @property
    def spread(self) -> float:
        """Height (m) that the ground never leaves the plane by."""
        return self.step * (self.size / 12 + 1)


def city() -> Scene:
    """Blocks as high as others are wide."""
    town = Scene(Relief(SIDE))
    for x in (30.0, 90.0):
        for y in (30.0, 90.0):
            _house(town, Rect(x, y, 36.0, 36.0, 0.05), 9.0 + x / 3)
    return town


def vineyard() -> Scene:
    """Terraces 2.2 m high with walls, vines and four huts."""
    hill = Scene(Steps(SIDE, gradient=0.07, step=2.2))
    huts = [Rect(x, y, 6.0, 5.0, 0.0) for x, y in ((31.0, 30.0), (55.0, 60.0), (79.0, 90.0), (103.0, 30.0))]
    for hut in huts:
        _house(hill, hut, 2.8, 25.0)
    for x in np.arange(12.0, SIDE, 12.0):
        for y in np.arange(4.0, SIDE, 8.0):
            hill.add_post(Rect(x + 1.7, y, 0.4, 8.0, 0.0), 0.7, 1.5)
            for row in (3.5, 5.5, 7.5, 9.5):
                vines = Rect(x + row, y, 8.0, 0.5, np.pi / 2)
                if not hill.near_building(vines.corners(), 1.0).any():
                    plant_hedge(hill, vines, 1.7)
    return hill


def forest() -> Scene:
    """Six houses in a closed forest."""
    wood, rng = Scene(Relief(SIDE, gradient=0.1)), np.random.default_rng(5)
    for i, (x, y) in enumerate(((25, 30), (70, 25), (95, 60), (40, 75), (80, 100), (20, 105))):
        _house(wood, Rect(x, y, 8.0 + i % 5, 7.0 + i % 3, 0.2 * i), 2.8 + i % 2 * 2.4, 22.0 + 4 * i)
    plant_trees(wood, 60.0, 1.0, rng, Monitor())
    return wood


def alps() -> Scene:
    """Huts on a slope of 38°, a fifth of it in forest."""
    slope, rng = Scene(Relief(SIDE, gradient=float(np.tan(np.deg2rad(38.0))))), np.random.default_rng(6)
    for i, (x, y) in enumerate(((20, 30), (55, 20), (90, 35), (30, 75), (65, 65), (85, 95), (45, 105))):
        _house(slope, Rect(x, y, 7.0 + i % 4, 6.0 + i % 3, 0.1 * i), 5.0, 22.0)
    plant_trees(slope, 60.0, 0.2, rng, Monitor())
    return slope


def solar_park() -> Scene:
    """Tilted tables, 2.6 m high at the back, and nothing else."""
    field = Scene(Relief(SIDE, gradient=0.03))
    for y in np.arange(10.0, SIDE, 8.0):
        table = Rect(SIDE / 2, y, 90.0, 4.2, 0.0)
        tops = lean_to(table, float(field.relief.ground(table.x, y)) + 0.8, 0.44)
        under = tops[0] - [0.0, 0.0, 0.1]
        field.solids.append(Body(table, tops, 0.0, PointClass.UNCLASSIFIED, field.new_id(), under))
    return field


def station() -> Scene:
    """Trains of five cars between platforms with roofs."""
    rails = Scene(Relief(SIDE))
    _house(rails, Rect(60.0, 108.0, 80.0, 14.0, 0.0), 10.0, 30.0)
    for y in (20.0, 48.0, 76.0):
        for x in (20.0, 46.0, 72.0, 98.0):
            rails.add_post(Rect(x, y, 25.0, 2.9, 0.0), 3.9, 1.5)
        rails.add_post(Rect(60.0, y + 8.0, 116.0, 7.0, 0.0), 0.75, 1.5)
        _house(rails, Rect(60.0, y + 8.0, 80.0, 5.0, 0.0), 4.2)
    return rails


def port() -> Scene:
    """Stacks of one to four containers, and a shed."""
    quay = Scene(Relief(SIDE))
    for i, (x, y) in enumerate((x, y) for x in np.arange(15.0, 90.0, 12.6) for y in np.arange(10.0, 110.0, 2.6)):
        if i % 7:
            quay.add_post(Rect(x, y, 12.2, 2.44, 0.0), 2.59 * (1 + i % 4), 1.5)
    _house(quay, Rect(106.0, 60.0, 18.0, 60.0, 0.0), 9.0)
    return quay


def estate() -> Scene:
    """Halls wider than 60 m with machines right across and with wings, some of them hardly lower."""
    land = Scene(Relief(2 * SIDE, gradient=0.01))
    for x, y, length, width, eave in ((70.0, 65.0, 105.0, 80.0, 6.5), (170.0, 170.0, 75.0, 95.0, 11.0)):
        hall, site = Rect(x, y, length, width, 0.1), Site(land, Rect(x, y, length, width, 0.1), eave)
        parts = [(0.0, 0.0, length, width, eave)]
        parts += [(along, 4.0, 2.5, 2.0, eave + 1.8) for along in np.arange(4.0 - length / 2, length / 2, 7.0)]
        parts += [(-12.0, across, 2.0, 3.0, eave + 1.4) for across in np.arange(4.0 - width / 2, width / 2, 8.0)]
        parts += [(8.0, width / 2 + 6.0, 50.0, 12.0, eave - 1.4), (0.0, -width / 2 - 4.5, 60.0, 9.0, 4.5)]
        parts += [(5.0, -width / 2 - 10.2, 40.0, 2.4, 3.0)]
        solids = [site.solid(hall.part(*part[:4]), flat(hall.part(*part[:4]), site.floor + part[4])) for part in parts]
        land.add_building("hall", hall.corners(), solids)
    return land


def churches() -> Scene:
    """Three churches with spires of 68° to 77°, four towers among trees, two of them with spires, and garden walls."""
    parish, rng = Scene(Relief(SIDE, gradient=0.03)), np.random.default_rng(8)
    for x, y, turn, side, eave, pitch in (
        (30, 25, 0.2, 6, 18, 4),
        (80, 25, 1.1, 7, 22, 2.5),
        (35, 60, 2.0, 5, 14, 4.5),
    ):
        nave = Rect(x, y, 24.0, 10.0, turn)
        site, tower = Site(parish, nave, 8.0), nave.part(-12.0 - side / 2, 0.0, side, side)
        roofs = (nave, gable(nave, site.floor + 8.0, 1.1)), (tower, hip(tower, site.floor + eave, pitch))
        parish.add_building("church", nave.corners(), [site.solid(*roof) for roof in roofs])
    for x, y, turn, side, eave, pitch in (
        (75, 62, 0.3, 5.0, 14, 4.5),
        (95, 60, 0.1, 4.5, 10, 4.0),
        (105, 90, 0.7, 6.0, 20, 1.0),
        (20, 95, 0.5, 5.0, 16, 0.05),
    ):
        parts = [Rect(x, y, side, side, turn + diagonal) for diagonal in (0.0, np.pi / 4)]
        site = Site(parish, parts[0], eave)
        roofs = [site.solid(part, hip(part, site.floor + eave, pitch)) for part in parts]
        parish.add_building("tower", parts[0].corners(), roofs)
        for across in (-4.5, 4.5):
            foot = parts[0].at(1.5, across)
            plant_tree(parish, (*map(float, foot), float(parish.relief.ground(*foot))), eave - 3.0, rng)
    for x, y, length, height in ((60, 112, 30, 2.6), (100, 112, 20, 4.0), (60, 76, 8, 6.0), (60, 50, 14, 2.2)):
        parish.add_post(Rect(x, y, length, 0.4, 0.3), height, 1.5)
    return parish


def farm() -> Scene:
    """Three houses at a field of maize."""
    land = Farmland(Relief(SIDE, gradient=0.02), fields=(Rect(60.0, 62.0, 90.0, 44.0, 0.0),))
    for x, y in ((25.0, 20.0), (95.0, 22.0), (60.0, 103.0)):
        _house(land, Rect(x, y, 14.0, 9.0, 0.2), 4.0, 35.0)
    return land


# Name, scene, and whether the strips don't fit together.
SCENES: tuple[tuple[str, Callable[[], Scene], bool], ...] = (
    ("blocks of a city", city, False),
    ("the same, strips 8 cm apart", city, True),
    ("terraced vineyard with huts", vineyard, False),
    ("houses in a closed forest", forest, False),
    ("huts on a slope of 38°", alps, False),
    ("halls with machines and wings", estate, False),
    ("churches and towers", churches, False),
    ("farm with a field of maize", farm, False),
    ("solar park, no building", solar_park, False),
    ("railway station with trains", station, False),
    ("container port", port, False),
)


def scanned(make: Callable[[], Scene], misfit: bool, density: float) -> dict[str, np.ndarray]:
    """Return the points of a scene at ``density`` pulses per m²."""
    scene = make()
    made = scan(scene, AirSurvey(density))
    made["xyz"][:, 2] += MISFIT * (misfit & (made["point_source_id"] % 2 == 0))
    if isinstance(scene, Farmland):
        _grow_maize(scene.fields, made)
    return made


def _grow_maize(fields: tuple[Rect, ...], made: dict[str, np.ndarray]) -> None:
    """Let maize grow in the fields."""
    rng = np.random.default_rng(0)
    in_field = np.any([field.contains(*made["xyz"][:, :2].T) for field in fields], axis=0)
    in_field &= made["classification"] == PointClass.GROUND
    leaves = np.flatnonzero(in_field & (rng.random(len(in_field)) >= THROUGH_MAIZE))
    below = np.abs(rng.normal(0, LEAVES, len(leaves)))
    below += (rng.random(len(leaves)) < 0.2) * rng.uniform(0, 2, len(leaves))
    made["xyz"][leaves, 2] += np.maximum(MAIZE - below, 0.3)
    made["classification"][leaves] = PointClass.MEDIUM_VEGETATION


def _house(scene: Scene, rect: Rect, eave: float, pitch: float = 0.0, kind: str = "house") -> None:
    """Put up a building with a flat roof, or a gable roof of ``pitch`` (°)."""
    site = Site(scene, rect, eave)
    top = site.floor + eave
    tops = gable(rect, top, float(np.tan(np.deg2rad(pitch)))) if pitch else flat(rect, top)
    scene.add_building(kind, rect.corners(), [site.solid(rect, tops)])
