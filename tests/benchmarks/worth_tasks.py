#!/usr/bin/env python3
"""Measure what each constant of a task other than *Detect buildings* is worth: ``worth_tasks.py TASK …``.

A task is measured on scenes with its own truth. Each constant of its rooms is set to 0 and to five times its value. The
table says in how many scenes the result changes at all, and how good it is then. A constant that changes no result
anywhere is a candidate for removal, until a scene of the case that it was written for, or a test, says otherwise.

Each measurement is a process of its own. It is ended after five times the time that the scene usually takes and some
seconds, and may take a bounded amount of memory: with some values a search has no end.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import hashlib
import importlib
import multiprocessing
import resource
import sys
import time
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.cloud import Cloud, create_cloud  # noqa: E402
from lidar_buildings.algorithms.geometry.polygon_overlap import are_within  # noqa: E402
from lidar_buildings.algorithms.geometry.rings import sides_of_rings  # noqa: E402
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.quality import map_changes as changes  # noqa: E402
from lidar_buildings.algorithms.quality.compare_corners import compare_corners  # noqa: E402
from lidar_buildings.algorithms.quality.update_map import update_map  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline, run_stage, sampling_of  # noqa: E402
from lidar_buildings.algorithms.shapes.segment_planes_hough import segment_planes_hough  # noqa: E402
from lidar_buildings.algorithms.shapes.segment_tree import segment_tree  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_street import simulate_street  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_tree import simulate_tree  # noqa: E402
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor, StageResults  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.algorithms.walls.extract_wall_footprints import extract_wall_footprints  # noqa: E402
from lidar_buildings.tests.aged_maps import aged, with_plain_corners  # noqa: E402
from lidar_buildings.tests.benchmarks.models import MAP, _outlines  # noqa: E402
from lidar_buildings.tests.benchmarks.results import ROOT, Table  # noqa: E402
from lidar_buildings.tests.benchmarks.worth import PACKAGE, Rule, _assigned, _numbers, _with  # noqa: E402
from lidar_buildings.tests.changed_towns import changed_town, house  # noqa: E402
from lidar_buildings.tests.changed_towns import cloud as cloud_of  # noqa: E402
from lidar_buildings.tests.industry import compared  # noqa: E402
from lidar_buildings.tests.polygon_matches import match_polygons  # noqa: E402
from lidar_buildings.tests.real.clouds import DELFT, detected  # noqa: E402
from lidar_buildings.tests.roof_shapes import SHAPES, moved  # noqa: E402
from lidar_buildings.tests.villages import corner_distances, mapped, village  # noqa: E402

# A measurement is ended after this multiple of its usual time, and these seconds.
SLOWER, AT_LEAST = 5.0, 5.0

# Memory (bytes) that a measurement may take.
MEMORY = 8_000_000_000

# Measurements at a time.
PROCESSES = 2

# What constants are multiplied by.
FACTORS = (0.0, 5.0)

Figures = dict[str, float]


@dataclass(frozen=True)
class Task:
    """A task: the rooms or modules that it is made of, its scenes, and what measures it on one."""

    modules: tuple[str, ...]
    scenes: tuple[Any, ...]
    measure: Callable[[Any], tuple[Figures, list[np.ndarray]]]


def _made(results: StageResults) -> list[np.ndarray]:
    """Return everything that a stage made, as arrays."""
    found = [one for one in results.dimensions.values() if one is not None]
    for layer in results.layers.values():
        found += [np.atleast_1d(part) for one in layer.geometries for part in (one if isinstance(one, list) else [one])]
        found += [np.array(list(column)) for column in layer.columns.values()]
    return found if results.report is None else [*found, np.array(list(results.report.values.values()))]


def _walls(scene: tuple[float, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many buildings of a village have a footprint, how many are invented, and how far corners are off."""
    cloud, true, _ = _village(*scene)
    names = ("xyz", "cluster_id", "wall_of", "classification")
    made = extract_wall_footprints.stage.unpack(extract_wall_footprints(**{name: cloud.get(name) for name in names}))
    return _corners(made.layers["wall_footprints"], true), _made(made)


def _corners(made: LayerFeatures, true: LayerFeatures) -> Figures:
    """Return how many true buildings have a footprint, how many are invented, and how far corners (cm) are off."""
    if not len(made):
        return {"found": 0.0}
    distances, used = corner_distances(made, true)
    off = 100 * np.concatenate([*distances, np.zeros(0)])
    return {"found": len(distances), "invented": len(made) - len(used), "corners": float(off.mean())}


def _walls_2022(scene: tuple[float, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return the same of the walls as published in 2022."""
    cloud, true, _ = _village(*scene)
    made = run_stage(STAGES["extract_wall_footprints_2022"], cloud.copy())
    layers = made.layers
    return _corners(layers["wall_footprints"], true), [
        np.array([len(layer) for layer in layers.values()]),
        *(np.atleast_1d(ring) for layer in layers.values() for rings in layer.geometries for ring in rings),
    ]


def _wall_points(scene: tuple[float, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many roofs and points of walls are found in a village whose planes are known."""
    cloud = _village(*scene)[0].copy()
    for name in ("classify_roofs", "classify_walls"):
        cloud = run_stage(STAGES[name], cloud, sampling=_sampling(scene)).cloud
    found = [cloud.get(name) for name in ("classification", "cluster_id", "wall_of")]
    return {"roofs": float(found[1].max()), "points of walls": float((found[2] > 0).sum())}, found


@cache
def _sampling(scene: tuple[float, float, int]) -> Any:
    return _of_corner(_village(*scene)[0])


def _of_corner(cloud: Cloud) -> Any:
    return sampling_of(cloud, cloud.get("xyz")[:, :2].min(axis=0))


@cache
def _village(density: float, noise: float, seed: int) -> Any:
    """Return the cloud of a village with its walls, and the true footprints."""
    arrays, true, old_map = village(density=density, noise=noise, seed=seed, size=90.0)
    made = mapped(arrays, old_map)
    return made.cloud, true, old_map


def _tree(scene: dict[str, Any]) -> tuple[Figures, list[np.ndarray]]:
    """Return the share (%) of wood that has its branch, and the volume, branches and diameter of a tree."""
    xyz, classes, true, branches = simulate_tree(**scene)
    found, layer = segment_tree(xyz, classes)
    if not len(layer):
        return {"branches": 0.0}, [found]
    right = 0
    for number in branches.columns["id"]:
        own = found[(true == number) & (found > 0)]
        if len(own):
            best = int(np.bincount(own).argmax())
            of_best = np.bincount(true[found == best])
            right += int((own == best).sum()) * (int(of_best[1:].argmax()) + 1 == number)
    volume = float(np.sum(layer.columns["volume"]))
    figures = {"wood right, %": 100 * right / int((true > 0).sum()), "volume": volume, "branches": len(layer)}
    return {**figures, "dbh, cm": 100 * layer.columns["dbh"][0]}, [found, np.array(layer.columns["radius"])]


def _plant(scene: dict[str, Any]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many pipes and spheres of a plant are found and invented."""
    cloud, true, axes = _smooth_parts(**scene)
    cylinders = run_stage(STAGES["detect_cylinders"], cloud.copy(), search_in="each segment")
    spheres = run_stage(STAGES["detect_spheres"], cylinders.cloud, search_in="each segment")
    found = spheres.cloud.get("segment_id")
    result = compared(true, axes, found, cylinders.layers["axes"])
    figures = {"pipes": float(result.is_found.sum()), "invented": len(result.invented)}
    return {**figures, "spheres": len(spheres.layers["centers"])}, [
        found,
        spheres.cloud.get("shape"),
        *(np.array(list(cylinders.layers["axes"].columns[name])) for name in ("radius", "length")),
    ]


@cache
def _smooth_parts(**scene: Any) -> Any:
    """Return a small plant whose smooth surfaces are segments, the true parts of its points, and the true axes."""
    xyz, classes, true, _, axes, _ = simulate_plant(pipes=2, tanks=0, spheres=1, **scene)
    cloud = create_cloud({"xyz": xyz, "classification": classes})
    return run_stage(STAGES["segment_surfaces"], cloud).cloud, true, axes


def _hough(scene: tuple[int, str]) -> tuple[Figures, list[np.ndarray]]:
    """Return what share of the points of a part of Delft is on planes."""
    cloud = detected(DELFT).cloud
    xyz = cloud.get("xyz")
    part = np.flatnonzero((np.abs(xyz[:, :2] - np.median(xyz[:, :2], axis=0) - scene[0]) < 25).all(axis=1))
    made = segment_planes_hough.stage.unpack(
        segment_planes_hough(xyz[part], np.zeros(len(part), np.uint8), method=scene[1])
    )
    found = made.dimensions["segment_id"]
    return {"on planes, %": 100 * float((found > 0).mean()), "planes": float(found.max())}, _made(made)


def _land_cover(scene: tuple[str, tuple[tuple[str, Any], ...]]) -> tuple[Figures, list[np.ndarray]]:
    """Return F (%) of water, wires, masts and plants in a simulated scene whose ground and buildings are found."""
    cloud, true, sampling = _built_up(*scene)
    cloud = cloud.copy()
    for name in ("classify_water", "classify_wires", "classify_vegetation"):
        cloud = run_stage(STAGES[name], cloud, sampling=sampling).cloud
    found = cloud.get("classification")
    figures = {name: _f_score(np.isin(found, codes), np.isin(true, codes)) for name, codes in _COVERS.items()}
    return figures, [found]


# The classes of each kind of land cover.
_COVERS = {"water": (9,), "wires": (14,), "masts": (15,), "plants": (3, 4, 5)}


def _f_score(found: np.ndarray, true: np.ndarray) -> float:
    return 200.0 * float((found & true).sum()) / max(int(found.sum() + true.sum()), 1)


@cache
def _built_up(kind: str, changes: tuple[tuple[str, Any], ...]) -> Any:
    """Return a simulated cloud with ground and buildings as they are found, the true classes, and the sampling."""
    simulated = run_stage(STAGES[kind], **dict(changes)).cloud
    true, cloud = simulated.get("classification"), simulated.copy()
    cloud.set("classification", np.zeros(len(cloud), np.uint8))
    without = {f"{one}_look_for": False for one in ("water", "wires", "vegetation")}
    made = run_pipeline(PIPELINES["detect_buildings"], cloud, **without).cloud
    return made, true, _of_corner(made)


def _footprints(scene: tuple[int, float, float]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many houses of a part of Delft's base map are one footprint, and how far corners (m) are off."""
    cloud, outlines, sampling = _buildings_of_delft(*scene)
    made = run_stage(STAGES["extract_footprints"], cloud.copy(), sampling=sampling).layers["footprints"]
    found = match_polygons(outlines, made.geometries, Monitor())
    figures = {"houses": len(outlines), "one to one": float((found.iou > 0.5).sum()), "IoU": float(found.iou.mean())}
    results = [ring for rings in made.geometries for ring in rings]
    return figures, [*results, *(np.array(list(column)) for column in made.columns.values())]


@cache
def _buildings_of_delft(part: int, keep: float, noise: float) -> Any:
    """Return the buildings found in a square of Delft, thinned and with noise (m), the base map there, the sampling."""
    found, rng = detected(DELFT).cloud, np.random.default_rng(0)
    outlines, xyz = _outlines(MAP, found.origin), found.get("xyz")
    middles = np.array([rings[0].mean(axis=0) for rings in outlines.geometries])
    center = np.median(middles, axis=0) + (35.0 * part, -25.0 * part)
    chosen = np.flatnonzero((np.abs(middles - center) < 22.0).all(axis=1))
    rows = np.flatnonzero((np.abs(xyz[:, :2] - center) < 35.0).all(axis=1) & (rng.random(len(xyz)) < keep))
    cloud = found.take(rows)
    cloud.set("xyz", cloud.get("xyz") + rng.normal(0, noise, (len(rows), 3)))
    return cloud, [outlines.geometries[i] for i in chosen], _of_corner(cloud)


def _facades(scene: dict[str, Any]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many facades and openings are found in the scan of a street, and how many there are."""
    cloud, true = _street(**scene)
    layers = run_pipeline(PIPELINES["model_facades"], cloud.copy()).layers
    names = {"facades": "openings_facades", "openings": "openings"}
    figures = {name: float(len(layers[made])) for name, made in names.items()}
    figures.update({f"true {name}": float(len(true[name])) for name in names})
    results = [layers[made] for made in names.values()]
    rings = [ring for layer in results for own in layer.geometries for ring in own]
    return figures, [*rings, *(np.array(list(column)) for layer in results for column in layer.columns.values())]


@cache
def _street(**scene: Any) -> tuple[Cloud, dict[str, LayerFeatures]]:
    """Return the scan of a street of 12 m from a vehicle without classes, and its true layers."""
    made = simulate_street.stage.unpack(simulate_street(length=12.0, **scene))
    xyz = made.dimensions["xyz"]
    return create_cloud({"xyz": xyz, "classification": np.zeros(len(xyz), np.uint8)}), made.layers


def _map_update(scene: tuple[float, float]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many buildings of an old map, and of those built since, have the right status, and IoU of all."""
    old, kinds, true, clouds, footprints = _changed(*scene)
    made = update_map.stage.unpack(update_map(*clouds, old_map=old, footprints=footprints))
    updated, gone = made.layers["updated_map"], made.layers["buildings_gone"]
    status = dict(zip(updated.columns["id"], updated.columns["status"]))
    status.update(dict.fromkeys(gone.columns["id"], changes.GONE))
    wanted = {"annex": changes.CHANGED, "cut": changes.CHANGED, "same": changes.UNCHANGED, "row": changes.UNCHANGED}
    right = sum(status.get(key) == wanted.get(kinds[key], kinds[key]) for key in old.columns["id"])
    new = updated.columns["status"].count(changes.NEW) - kinds.count(changes.NEW)
    iou = match_polygons(true, updated.geometries, Monitor()).iou.mean()
    return {"of": len(old), "right": right, "new too many": new, "IoU": float(iou)}, _made(made)


@cache
def _changed(step: float, noise: float) -> Any:
    """Return an old map, what happened to its buildings, the true ones, two surveys and outlines with noise (m)."""
    old, kinds, true = changed_town(5, 4)
    rng = np.random.default_rng(3)
    xyz, classes = cloud_of(true, low=(-10, -10), high=(130, 90), trees=[house(60, 8)], step=step)
    xyz = xyz + rng.normal(0, noise, xyz.shape)
    earlier = xyz * [1.0, 1.0, 0.97]
    earlier[are_within(xyz[:, :2], sides_of_rings(true[3])), 2] -= 2.0
    footprints = [[ring + 0.4 + rng.normal(0, noise, 2) for ring in rings] for rings in true]
    layer = LayerFeatures([*old.values()], {"id": [*old]})
    return layer, kinds, true, (xyz, classes, None, earlier, classes), LayerFeatures(footprints, {})


def _map_corners(scene: dict[str, Any]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many corners of an aged map are matched, and how far their displacements (cm) are off."""
    before = aged(_footprints_of_village(), **scene)
    made = compare_corners.stage.unpack(compare_corners(_footprints_of_village(), before.layer))
    values = made.report.values
    figures = {name: float(values[name]) for name in ("found", "missed", "new", "matched")}
    wanted = {f"true {name}": float(before.counts[name]) for name in figures}
    return {**figures, **wanted}, _made(made)


@cache
def _footprints_of_village() -> LayerFeatures:
    return with_plain_corners(village(size=150.0, density=5.0, seed=6)[1])


def _roof(scene: tuple[str, float, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return how far ridge, eave and corners of a simulated roof are off (cm), and how the model is assessed."""
    name, density, noise, seed = scene
    shape, turn = SHAPES[name], 17.0 * seed
    points, ring = shape.scanned(density, noise, seed, turn)
    ground = np.random.default_rng(seed).uniform((-15, -15, 0), (25, 25, 0), (1500, 3))
    xyz, classes = np.concatenate([points, ground]), np.repeat([6, 2], [len(points), len(ground)]).astype(np.uint8)
    made = reconstruct_roofs.stage.unpack(reconstruct_roofs(xyz, classes, LayerFeatures([[ring]], {"id": [1]})))
    roofs = made.layers["roofs"]
    vertices = np.concatenate([ring for rings in roofs.geometries for ring in rings])
    true = np.column_stack([moved(shape.corners, turn, (0, 0)), shape.corners[:, 2]])
    off = np.sqrt(((true[:, None] - vertices) ** 2).sum(axis=2)).min(axis=1)
    return {"corners": 100 * float(off.mean()), "faces": len(roofs)}, _made(made)


def _models(scene: tuple[int, float]) -> tuple[Figures, list[np.ndarray]]:
    """Return how well models of a part of Delft's base map explain its points."""
    part, keep = scene
    xyz, classes, outlines = _cut(part, keep)
    made = reconstruct_roofs.stage.unpack(reconstruct_roofs(xyz, classes, outlines))
    columns = made.layers["buildings"].columns
    figures = {"rms, cm": 100 * float(np.mean(columns["rms"])), "explained": float(np.mean(columns["explained"]))}
    figures["2.2"] = columns["level"].count("2.2")
    return figures, _made(made)


@cache
def _cut(part: int, keep: float) -> tuple[np.ndarray, np.ndarray, LayerFeatures]:
    """Return the points and classes of a square of Delft, and the houses of the base map in it."""
    found = detected(DELFT)
    outlines, xyz = _outlines(MAP, found.cloud.origin), found.cloud.get("xyz")
    middles = np.array([rings[0].mean(axis=0) for rings in outlines.geometries])
    center = np.median(middles, axis=0) + (30.0 * part, -20.0 * part)
    chosen = np.flatnonzero((np.abs(middles - center) < 12.0).all(axis=1)).tolist()
    near = (np.abs(xyz[:, :2] - center) < 40.0).all(axis=1)
    rows = np.flatnonzero(near & (np.random.default_rng(0).random(len(xyz)) < keep))
    return (
        xyz[rows],
        found.classification[rows],
        LayerFeatures([outlines.geometries[i] for i in chosen], {"id": chosen}),
    )


_MODELS = tuple(
    f"models3d.{name}"
    for name in (
        "building_facts",
        "building_models",
        "joined_terrain",
        "mending",
        "overhangs",
        "reconstruct_roofs",
        "roof_limits",
        "roof_lines",
        "roof_partition",
        "roof_planes",
        "solid_faces",
        "solid_faults",
        "solid_levels",
    )
)

_VILLAGES = ((50.0, 0.05, 2), (25.0, 0.04, 11), (50.0, 0.02, 5), (12.0, 0.08, 7))

TASKS = {
    "walls": Task(
        (
            "walls.alleys",
            "walls.cheapest_outline",
            "walls.extract_wall_footprints",
            "walls.roof_outline",
            "walls.surroundings",
            "walls.wall_edges",
            "walls.wall_lines",
            "walls.wall_outline",
        ),
        _VILLAGES,
        _walls,
    ),
    "wall_points": Task(
        ("walls.bent_roofs", "walls.classify_roofs", "walls.classify_walls"), _VILLAGES[:2], _wall_points
    ),
    "walls_2022": Task(
        ("walls.extract_wall_footprints_2022", "walls.wall_lines"), (_VILLAGES[2], _VILLAGES[0]), _walls_2022
    ),
    "tree": Task(
        ("shapes.segment_tree", "shapes.tree_structure", "shapes.stem_search"),
        (
            {"height": 9.0, "dbh": 0.2, "n_branches": 8, "density": 3000.0},
            {"height": 12.0, "density": 1000.0, "noise": 0.006, "leaves": 1.0, "seed": 2},
            {"height": 16.0, "dbh": 0.4, "density": 600.0, "seed": 3},
        ),
        _tree,
    ),
    "plant": Task(
        (
            "shapes.cylinder_evidence",
            "shapes.cylinder_fits",
            "shapes.cylinder_search",
            "shapes.detect_spheres",
            "shapes.joined_cylinders",
            "shapes.joined_pieces",
            "shapes.search_settings",
            "shapes.searched_points",
            "shapes.shape_windows",
            "shapes.surface_normals",
        ),
        ({"seed": 1, "density": 400.0}, {"seed": 2, "density": 1000.0, "noise": 0.004, "clutter": False}),
        _plant,
    ),
    "hough": Task(
        ("shapes.segment_planes_hough", "shapes.hough_planes", "shapes.plane_polygons"),
        ((0, "points"), (0, "normals"), (40, "points")),
        _hough,
    ),
    "landcover": Task(
        (
            "landcover.classify_vegetation",
            "landcover.classify_water",
            "landcover.classify_wires",
            "landcover.masts",
            "landcover.wire_candidates",
            "landcover.wire_spans",
        ),
        (
            ("simulate_town", (("size", 100.0), ("density", 4.0), ("seed", 3))),
            ("simulate_town", (("size", 60.0), ("density", 16.0), ("seed", 5), ("range_noise", 0.06))),
            ("simulate_power_line", (("size", 130.0), ("density", 4.0), ("angle", 25.0), ("seed", 4))),
            ("simulate_power_line", (("size", 110.0), ("density", 12.0), ("seed", 1), ("range_noise", 0.05))),
            ("simulate_bridges", (("kind", "canal"), ("density", 3.0), ("seed", 3))),
        ),
        _land_cover,
    ),
    "footprints": Task(
        (
            "footprints.drawn_blocks",
            "footprints.extract_footprints",
            "footprints.footprint_attributes",
            "footprints.footprint_points",
            "footprints.outline_pieces",
            "footprints.roof_points",
            "footprints.row_houses",
            "footprints.soft_shares",
        ),
        ((0, 1.0, 0.0), (1, 0.25, 0.0), (-1, 1.0, 0.05)),
        _footprints,
    ),
    "facades": Task(
        (
            "facades.approaches",
            "facades.common_borders",
            "facades.curved_fronts",
            "facades.extract_facades",
            "facades.extract_openings",
            "facades.facade_frame",
            "facades.facade_outline",
            "facades.facade_surfaces",
            "facades.opening_search",
        ),
        (
            {"line_rate": 40.0, "angular_step": 0.4, "clutter": False, "seed": 2},
            {"line_rate": 60.0, "angular_step": 0.3, "stoops": 1.0, "unevenness": 0.15, "seed": 3},
        ),
        _facades,
    ),
    "update": Task(
        (
            "quality.map_changes",
            "quality.map_drawing",
            "quality.map_fit",
            "quality.update_map",
            "quality.corner_matching",
        ),
        ((0.5, 0.0), (1.0, 0.05), (0.7, 0.2)),
        _map_update,
    ),
    "corners": Task(
        ("quality.corner_matching", "quality.compare_corners", "quality.building_maps"),
        tuple(
            {"shift": (0.4, -0.3), "noise": noise, "missing": 3, "gone": 2, "annexes": 3, "seed": seed}
            for noise, seed in ((0.02, 1), (0.2, 2), (0.5, 3))
        ),
        _map_corners,
    ),
    "roofs": Task(
        _MODELS,
        (
            *((name, 12.0, 0.03, seed) for seed, name in enumerate(SHAPES)),
            ("hip", 4.0, 0.06, 3),
            ("half-hip", 20.0, 0.1, 2),
        ),
        _roof,
    ),
    "models": Task(_MODELS, ((0, 1.0), (-1, 0.2)), _models),
}


def constants_of(modules: tuple[str, ...]) -> list[tuple[str, Any, str]]:
    """Return the numbers in rooms or modules, as :func:`worth.constants` does for the steps of the chain."""
    found = []
    for path in sorted((ROOT / "algorithms").rglob("*.py")):
        short = ".".join(path.relative_to(ROOT / "algorithms").with_suffix("").parts)
        if any(short == one or short.startswith(one + ".") for one in modules):
            loaded = importlib.import_module(f"{PACKAGE}.{short}")
            tree = ast.parse(path.read_text(encoding="utf-8"))
            names = [name for node in tree.body for name in _assigned(node) if name.strip("_").isupper()]
            for name in dict.fromkeys(names):
                found += [(f"{short}:{name}", vars(loaded)[name], part) for part in _numbers(vars(loaded)[name])]
    return found


def _rules(task: Task) -> list[Rule]:
    return [
        Rule(f"{where} {part} x{factor:g}", ((where, _with(value, part, factor)),))
        for where, value, part in constants_of(task.modules)
        for factor in FACTORS
    ]


def measured(job: tuple[str, Any, Rule]) -> tuple[Figures, str]:
    """Return the figures of a task on a scene with a rule changed, and a digest of the result."""
    name, scene, rule = job
    with rule.applied():
        try:
            figures, results = TASKS[name].measure(scene)
        except Exception as error:  # A constant of no sense breaks the task, which is a change, too.
            return {}, repr(error)
    return figures, _digest(results)


def _digest(results: list[np.ndarray]) -> str:
    rounded = (np.round(one, 6) if one.dtype.kind == "f" else one for one in map(np.asarray, results))
    return hashlib.sha256(b"".join(np.ascontiguousarray(one).tobytes() for one in rounded)).hexdigest()


def bounded(jobs: Iterable[tuple[str, Any, Rule]], limits: Iterable[float]) -> list[tuple[Figures, str]]:
    """Return what is measured in processes of their own, which are ended after as many seconds as the limits say."""
    context = multiprocessing.get_context("fork")
    running = []
    for job, limit in zip(jobs, limits):
        receiver, sender = context.Pipe(duplex=False)
        process = context.Process(target=_send, args=(sender, job))
        process.start()
        sender.close()
        running.append((process, receiver, time.monotonic() + limit))
    found = []
    for process, receiver, end in running:
        try:
            in_time = receiver.poll(max(end - time.monotonic(), 0.0))
            found.append(receiver.recv() if in_time else ({}, "too slow"))
        except EOFError:
            found.append(({}, "ended"))
        process.kill()
        process.join()
    return found


def _send(sender: Any, job: tuple[str, Any, Rule]) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    warnings.simplefilter("ignore")
    with contextlib.redirect_stderr(None):
        sender.send(measured(job))


def main() -> None:
    """Measure the tasks that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", nargs="+", choices=TASKS)
    parser.add_argument("--rule", nargs="*", default=[""], help="parts of names of constants")
    chosen = parser.parse_args()
    for name in chosen.task:
        _table(name, [rule for rule in _rules(TASKS[name]) if any(part in rule.name for part in chosen.rule)])


def _table(name: str, rules: list[Rule]) -> None:
    """Print the table of a task, and the constants that change nothing."""
    scenes, usual, limits = TASKS[name].scenes, [], []
    for scene in scenes:
        TASKS[name].measure(scene)  # What scenes are made of is kept.
        start = time.monotonic()
        figures, results = TASKS[name].measure(scene)
        usual.append((figures, _digest(results)))
        limits.append(SLOWER * (time.monotonic() - start) + AT_LEAST)
    table = Table(f"worth_{name}", "rule", "scenes changed", "figures", texts=3)
    changes: dict[str, int] = {}
    table.add("usual", "", _in_words(usual))
    for rule in rules:
        found = []
        for at in range(0, len(scenes), PROCESSES):
            part = slice(at, at + PROCESSES)
            found += bounded([(name, scene, rule) for scene in scenes[part]], limits[part])
        changed = sum(one[1] != other[1] for one, other in zip(found, usual))
        table.add(rule.name, str(changed), _in_words(found) if changed else "")
        constant = rule.name.rpartition(" ")[0]
        changes[constant] = changes.get(constant, 0) + changed
    nothing = [constant for constant, changed in changes.items() if not changed]
    print(f"\n{len(nothing)} of {len(changes)} constants change nothing: {', '.join(nothing)}", flush=True)


def _in_words(found: list[tuple[Figures, str]]) -> str:
    return "; ".join(" ".join(f"{name} {value:.2f}" for name, value in one.items()) or why for one, why in found)


if __name__ == "__main__":
    main()
