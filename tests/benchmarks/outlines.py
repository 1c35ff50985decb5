"""How stable, regular and near to the map outlines are, compared with Building-Regulariser on the same traced rings."""

from __future__ import annotations

import functools
import os
import tempfile
from pathlib import Path
from typing import Callable

import numpy as np

from lidar_buildings.algorithms.cloud.cloud import Cloud
from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.algorithms.footprints.extract_footprints import extract_footprints
from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons, overlaps
from lidar_buildings.algorithms.geometry.ring_directions import along_two_directions
from lidar_buildings.algorithms.geometry.rings import signed_area
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.quality.polygon_comparison import hausdorff
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.simulation.town_layout import TownPlan, build_town
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.benchmarks import regulariser
from lidar_buildings.tests.benchmarks.results import Table
from lidar_buildings.tests.polygon_matches import match_polygons
from lidar_buildings.tests.real.clouds import DELFT, detected, path_of, run_on, truth

CLOUDS = (DELFT, "buildings/ahn3-delft-4", "buildings/ahn-amsterdam-1", "buildings/ign-stbarth")
DIMENSIONS = ("classification", "cluster_id", "height_above_ground", "reason")

# Smaller outlines (m²) are not compared.
LEAST_AREA = 10.0

# Simplification (m) of traced rings: much less than the distance of points.
TRACED = 0.05

# Sides (m) of the blocks whose footprints are compared with the whole cloud's.
SIDES = (100.0, 140.0)

# The cloud of this comparison.
IN_TILES = "buildings/ahn3-delft-4"

# Pulses per m² on simulated towns of 200 m, with as many buildings as fit.
DENSITIES = (8.0, 16.0)

# Seeds of these towns.
TOWNS = (1, 2, 3, 4)

# A corner with a smaller inner or outer angle (°) is sharp. Buildings have such corners at acute sites only.
SHARP = 70.0

# Least area (m²) of the houses of the map that are sought one by one.
HOUSE = 20.0

Drawing = Callable[[Cloud], list]


def outlines() -> list[Table]:
    """Print how far outlines move, how regular they are, how near to maps and towns, and how alike in blocks."""
    drawings = {"in blocks": functools.partial(drawn, merge_touching=True), "house by house": drawn}
    missing = regulariser.why_not()
    if missing:
        print(f"\nThe rows of Building-Regulariser are left out, as it can't be installed: {missing}")
    else:
        drawings["Building-Regulariser"] = regularised
    return [_stability(drawings), _of_map(drawings), _of_towns(), _of_blocks()]


def drawn(cloud: Cloud, **tunables: bool) -> list:
    """Return the polygons of a cloud with classes, in map coordinates."""
    arrays = {name: cloud.get(name) for name in DIMENSIONS if cloud.has(name)}
    return _in_map(cloud, extract_footprints(cloud.get("xyz"), **arrays, **tunables).geometries)


def regularised(cloud: Cloud) -> list:
    """Return what Building-Regulariser makes of the traced rings."""
    traced = drawn(cloud, merge_touching=True, regularize=False, tolerance=TRACED)
    made = regulariser.regularise([[ring.tolist() for ring in rings] for rings in traced])
    return [[np.array(ring) for ring in rings] for rings in made]


def _in_map(cloud: Cloud, geometries: list) -> list:
    return [[cloud.to_map(ring) for ring in rings] for rings in geometries]


def _stability(drawings: dict[str, Drawing]) -> Table:
    """Print how far outlines are from outlines of moved points and of nine tenths, and how regular they are."""
    how = [f"{what}, {classes} classes" for what in ("moved", "90 %") for classes in ("fixed", "own")]
    columns = [f"{one}: {measure}" for one in how for measure in ("IoU", "m")]
    table = Table("outlines", "drawing", "outlines", *columns, "along", "sharp, %", "corners per 100 m")
    pairs: dict[str, list] = {name: [] for name in drawings}
    made: dict[str, list] = {name: [] for name in drawings}
    for name in CLOUDS:
        clouds = [detected(name).cloud, *_others(name)]
        for drawing, draw in drawings.items():
            one, *others = map(draw, clouds)
            made[drawing] += one
            pairs[drawing].append([_compared(one, other) for other in others])
    for drawing, of_clouds in pairs.items():
        figures = [float(np.median(np.concatenate(values))) for each in zip(*of_clouds) for values in zip(*each)]
        table.add(drawing, sum(len(one[0][0]) for one in of_clouds), *figures, *_regularity(made[drawing]), digits=3)
    return table


def _regularity(geometries: list) -> tuple[float, float, float]:
    """Return how regular polygons are: share along two directions of their own, sharp corners (%), corners per 100 m.

    The share is of the length of all edges.
    """
    own, total, sharp, corners = 0.0, 0.0, 0, 0
    for rings in geometries:
        sides = [np.diff(ring, axis=0) for ring in rings]
        length, angle = _polar(np.concatenate(sides))
        own += along_two_directions(length, angle)
        total += float(length.sum())
        turns = np.concatenate([_turns(ring) for ring in sides])
        sharp += int((np.abs(turns) > 180.0 - SHARP).sum())
        corners += len(turns)
    return own / total, 100.0 * sharp / corners, 100.0 * corners / total


def _polar(sides: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return lengths (m) and directions (°) of edges (n, 2)."""
    return np.hypot(*sides.T), np.degrees(np.arctan2(sides[:, 1], sides[:, 0]))


def _turns(sides: np.ndarray) -> np.ndarray:
    """Return by how much (°, -180 to 180) a ring of edges (n, 2) turns after each."""
    angle = _polar(sides)[1]
    return (np.roll(angle, -1) - angle + 180.0) % 360.0 - 180.0


def _others(name: str) -> list[Cloud]:
    """Return a cloud moved by 2 mm with the same classes and its own, and nine tenths of it with both."""
    cloud, whole = detected(name).cloud, read_cloud(path_of(name))
    rng = np.random.default_rng(1)
    step = rng.normal(0, 0.002, cloud.get("xyz").shape)
    kept = np.flatnonzero(rng.random(len(step)) < 0.9)
    made = []
    for one in (cloud.copy(), whole.copy()):
        one.set("xyz", one.get("xyz") + step)
        made.append(one)
    made += [cloud.take(kept), whole.take(kept)]
    for own in made[1::2]:
        run_on(own)
    return made


def _compared(one: list, other: list) -> tuple[np.ndarray, np.ndarray]:
    """Return IoU and Hausdorff distance (m) of outlines (n,) from those in another layer that they overlap most."""
    one = [rings for rings in one if sum(map(signed_area, rings)) >= LEAST_AREA]
    found = match_polygons(one, other, Monitor())
    iou, distance = np.zeros(len(one)), np.full(len(one), np.inf)
    iou[found.one] = found.iou
    distance[found.one] = [hausdorff(one[i], other[j]) for i, j in zip(found.one, found.other)]
    return iou, distance


def _of_map(drawings: dict[str, Drawing]) -> Table:
    """Print how far corners of Delft's map are from corners of outlines, and how many houses are found one to one."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from qgis.core import QgsApplication

    application = QgsApplication([], False)
    application.initQgis()
    from lidar_buildings.tests.real.base_map import base_map, corner_distances, polygon

    columns = "houses found", "their corners, m", "blocks found", "their corners, m (blocks)", "one to one"
    table = Table("outlines_of_map", "drawing", "classes", *columns, texts=2)
    true = read_cloud(path_of(DELFT))
    true.set("classification", truth(DELFT))
    houses = [_rings(house) for house in base_map()[0] if house.area() >= HOUSE]
    for classes, cloud in (("true", true), ("found", detected(DELFT).cloud)):
        for drawing, draw in drawings.items():
            made = draw(cloud)
            polygons = [polygon(rings) for rings in made]
            levels = [corner_distances(polygons, level) for level in base_map()]
            cells = [value for count, off in levels for value in (count, float(np.median(off)))]
            table.add(drawing, classes, *cells, _one_to_one(made, houses), digits=2)
    application.exitQgis()
    return table


def _one_to_one(made: list, houses: list) -> int:
    """Return how many houses are one polygon of the made ones: their intersection is over half of their union."""
    return int((match_polygons(houses, made, Monitor()).iou > 0.5).sum())


def _rings(geometry) -> list:
    return [np.array([(point.x(), point.y()) for point in ring]) for ring in geometry.asPolygon()]


def _of_towns() -> Table:
    """Print how many single houses of simulated towns are drawn in several parts, and how many of rows one by one."""
    columns = "single houses", "in several polygons", "houses of rows", "one to one"
    table = Table("outlines_of_towns", "pulses per m²", *columns)
    for density in DENSITIES:
        counts = np.zeros(4, int)
        for seed in TOWNS:
            cloud = run_stage(STAGES["simulate_town"], size=200.0, density=density, buildings=34.0, seed=seed).cloud
            cloud.set("classification", np.zeros(len(cloud), np.uint8))
            made = run_on(cloud).layers["footprints"].geometries
            built = build_town(TownPlan(size=200.0, buildings=34.0, seed=seed), Monitor()).buildings
            single, of_rows = ([[one.outline] for one in built if (one.kind == "row") is row] for row in (False, True))
            counts += len(single), _divided(made, single), len(of_rows), _one_to_one(made, of_rows)
        table.add(f"{density:g}", *map(int, counts))
    return table


def _divided(made: list, houses: list) -> int:
    """Return how many houses hold two polygons or more that have the greater part of their area in the house."""
    polygons = as_polygons(made)
    one, other, shared = overlaps(polygons, as_polygons(houses), Monitor())
    inside = shared > 0.5 * polygons.area[one]
    return int((np.bincount(other[inside], minlength=len(houses)) > 1).sum())


def _of_blocks() -> Table:
    """Print how many polygons of a cloud come again, within 5 cm, in blocks."""
    table = Table("outlines_in_blocks", "side, m", "polygons", "of the whole", "within 5 cm", "%")
    whole = _in_map(detected(IN_TILES).cloud, detected(IN_TILES).layers["footprints"].geometries)
    for side in SIDES:
        made = in_blocks(path_of(IN_TILES), side)
        table.add(f"{side:.0f}", len(made), len(whole), *_same(whole, made))
    return table


def in_blocks(path: Path, side: float) -> list:
    """Return the footprints, in map coordinates, of *Detect buildings* in blocks of a side (m)."""
    with tempfile.TemporaryDirectory() as folder:
        detect = PIPELINES["detect_buildings"]
        outcome = run_in_tiles(detect, [path], folder, options=TilesOptions(Workers(processes=1), side))
    origin = outcome.survey.origin[:2]
    return [[ring + origin for ring in rings] for rings in outcome.layers["footprints"].geometries]


def _same(whole: list, made: list) -> tuple[int, float]:
    """Return how many polygons of the whole come again within 5 cm, and their share in percent."""
    found = match_polygons(whole, made, Monitor())
    count = sum(hausdorff(whole[i], made[j]) <= 0.05 for i, j in zip(found.one, found.other))
    return count, 100 * count / len(whole)
