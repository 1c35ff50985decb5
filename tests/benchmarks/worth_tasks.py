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
from lidar_buildings.algorithms.facades.plan_segments import (  # noqa: E402
    PlanSegments,
    facade_segments,
    outline_segments,
)
from lidar_buildings.algorithms.facades.register_street import register  # noqa: E402
from lidar_buildings.algorithms.facades.segment_facade_lines import segment_facade_lines  # noqa: E402
from lidar_buildings.algorithms.facades.street_walls import fitted_to_walls  # noqa: E402
from lidar_buildings.algorithms.footprints.regularize_polygons import regularize_polygons  # noqa: E402
from lidar_buildings.algorithms.geometry.polygon_overlap import are_within  # noqa: E402
from lidar_buildings.algorithms.geometry.rings import distances_to_rings, sides_of_rings  # noqa: E402
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.quality import map_changes as changes  # noqa: E402
from lidar_buildings.algorithms.quality.assess_footprints import assess_footprints  # noqa: E402
from lidar_buildings.algorithms.quality.assess_models import assess_models  # noqa: E402
from lidar_buildings.algorithms.quality.compare_corners import compare_corners  # noqa: E402
from lidar_buildings.algorithms.quality.compare_surveys import compare_surveys  # noqa: E402
from lidar_buildings.algorithms.quality.report_buildings import report_buildings  # noqa: E402
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
from lidar_buildings.tests import blocks  # noqa: E402
from lidar_buildings.tests.aged_maps import aged, with_plain_corners  # noqa: E402
from lidar_buildings.tests.benchmarks.models import MAP, _outlines  # noqa: E402
from lidar_buildings.tests.benchmarks.results import ROOT, Table  # noqa: E402
from lidar_buildings.tests.benchmarks.worth import PACKAGE, Rule, _assigned, _numbers, _with  # noqa: E402
from lidar_buildings.tests.changed_towns import changed_town, house  # noqa: E402
from lidar_buildings.tests.changed_towns import cloud as cloud_of  # noqa: E402
from lidar_buildings.tests.hill_towns import hill, open_edges, town  # noqa: E402
from lidar_buildings.tests.industry import compared  # noqa: E402
from lidar_buildings.tests.overhanging_roofs import overhanging  # noqa: E402
from lidar_buildings.tests.polygon_matches import match_polygons  # noqa: E402
from lidar_buildings.tests.real.clouds import DELFT, detected  # noqa: E402
from lidar_buildings.tests.roof_shapes import SHAPES, moved  # noqa: E402
from lidar_buildings.tests.solid_validity import assert_valid_solid  # noqa: E402
from lidar_buildings.tests.traced_polygons import box, traced  # noqa: E402
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


def _surveys(scene: tuple[float, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many buildings of two surveys have the right status."""
    earlier, later, wanted = _two_surveys(*scene)
    made = compare_surveys.stage.unpack(compare_surveys(later, earlier))
    columns = made.layers["buildings"].columns
    right = sum(wanted.get(key) == status for key, status in zip(columns["building"], columns["status"]))
    return {"of": len(columns["status"]), "right": right}, _made(made)


@cache
def _two_surveys(noise: float, rise: float, seed: int) -> tuple[LayerFeatures, LayerFeatures, dict[str, str]]:
    """Return the footprints of a town at two times, and what has happened to each building since.

    Corners and heights have noise (m), and all heights rise by ``rise`` m, as of another ground. Of every other row the
    two houses are one building in the later survey.
    """
    old, kinds, true = changed_town(8, 5)
    rng, now = np.random.default_rng(seed), iter(true)
    layers: tuple[dict, dict] = ({}, {})
    wanted, height = {}, {}
    for number, kind in enumerate(kinds):
        rings = None if kind == changes.GONE else next(now)
        for layer, own in zip(layers, (old.get(number), rings)):
            if own is not None:
                off = rng.normal(0, noise, own[0][:-1].shape)
                layer[number] = [own[0] + np.append(off, off[:1], axis=0)]
        is_higher = kind == "same" and number % 2 == 0
        height[number] = (4.0, 4.0 + rise + (2.5 if is_higher else 0.0)) + rng.normal(0, noise, 2)
        named = {"annex": "outline changed", "cut": "outline changed", changes.MOVED: "outline changed"}
        unchanged = "height changed" if is_higher else "unchanged"
        wanted[str(number)] = named.get(kind, kind if kind in (changes.NEW, changes.GONE) else unchanged)
    rows = [number for number, kind in enumerate(kinds) if kind == "row"]
    for one, other in list(zip(rows[::2], rows[1::2]))[::2]:
        corners = np.concatenate([layers[1][one][0][:2], layers[1].pop(other)[0][1:3], layers[1][one][0][2:4]])
        layers[1][one] = [np.append(corners[[0, 2, 3, 5]], corners[:1], axis=0)]
    earlier, later = (
        LayerFeatures([*layer.values()], {"id": [*layer], "height": [height[key][time] for key in layer]})
        for time, layer in enumerate(layers)
    )
    return earlier, later, wanted


def _assessed(scene: tuple[Any, ...]) -> tuple[Figures, list[np.ndarray]]:
    """Return what an assessment of models or of footprints counts, whose errors are known."""
    return _assessed_models(*scene[1:]) if scene[0] == "models" else _assessed_footprints(*scene[1:])


def _assessed_models(name: str, noise: float, rise: float) -> tuple[Figures, list[np.ndarray]]:
    """Return how many planes of a roof are missing in a gable ``rise`` m too high, and how many faces are invented.

    The model has its walls too, and the cloud points of one of these.
    """
    points, _ = SHAPES[name].scanned(noise=noise)
    rng = np.random.default_rng(0)
    ground = np.column_stack([rng.uniform(-2, 14, (800, 2)), np.zeros(800)])
    wall = np.column_stack([rng.uniform(0, 12, 600), rng.normal(0.05, 0.01, 600), rng.uniform(3.05, 3.8, 600)])
    corners = np.array([[0, 0, 4], [12, 0, 4], [12, 4, 7.2], [0, 4, 7.2], [12, 8, 4], [0, 8, 4]])
    faces = [[(corners + [0, 0, rise])[[*ring, ring[0]]]] for ring in ([0, 1, 2, 3], [3, 2, 4, 5])]
    foot = np.array([[0, 0, 0], [12, 0, 0], [12, 0, 4], [0, 0, 4], [0, 0, 0.0]])
    roofs = LayerFeatures([*faces, [foot]], {"building": ["a"] * 3})
    classes = np.repeat([6, 2], [len(points) + len(wall), len(ground)]).astype(np.uint8)
    made = assess_models.stage.unpack(assess_models(np.concatenate([points, wall, ground]), classes, roofs))
    return {name: float(made.report.values[name]) for name in ("missing", "invented", "rms")}, _made(made)


def _assessed_footprints(noise: float, seed: int) -> tuple[Figures, list[np.ndarray]]:
    """Return how many buildings of an aged map are found in footprints, of how many, and how far corners are off."""
    before = aged(_footprints_of_village(), shift=(0.0, 0.0), noise=noise, missing=3, gone=2, annexes=3, seed=seed)
    made = assess_footprints.stage.unpack(assess_footprints(_footprints_of_village(), before.layer))
    values = {name: float(made.report.values[name]) for name in ("found", "missed", "invented")}
    wanted = (before.counts["found"], before.counts["missed"], before.counts["new"])
    return {**values, **{f"true {name}": float(count) for name, count in zip(values, wanted)}}, _made(made)


def _report(scene: tuple[int, bool]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many buildings of a village the page calls doubtful, and how many are."""
    seed, has_points = scene
    rng, layer = np.random.default_rng(seed), _footprints_of_village()
    confidence = rng.uniform(0.3, 1.0, len(layer))
    height = rng.uniform(3, 9, len(layer))
    features = LayerFeatures(layer.geometries, {**layer.columns, "confidence": confidence, "height": height})
    middle = np.concatenate([rings[0] for rings in layer.geometries]).mean(axis=0)
    plan = middle + rng.uniform(-60, 60, (20000, 2))
    is_roof = are_within(plan, sides_of_rings([ring for rings in layer.geometries for ring in rings]))
    xyz, classes = np.column_stack([plan, 5.0 * is_roof]), np.where(is_roof, 6, 2).astype(np.uint8)
    report = report_buildings(*((xyz, classes) if has_points else (None, None)), features)
    figures = {"doubtful": float(report.values["doubtful"]), "true": float((confidence < 0.7).sum())}
    return figures, [np.frombuffer(report.html.encode(), np.uint8)]


def _regularized(scene: tuple[str, float, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return the corners of houses drawn anew from noisy cells, of how many, and how far outlines are off (cm)."""
    true, given = _traced_houses(*scene)
    made = regularize_polygons.stage.unpack(regularize_polygons(given))
    drawn = made.layers["regularized"]
    off = [
        np.concatenate([distances_to_rings(ring, rings) for ring in own]) for own, rings in zip(drawn.geometries, true)
    ]
    corners, wanted = (
        float(sum(len(ring) - 1 for rings in some for ring in rings)) for some in (drawn.geometries, true)
    )
    figures = {"corners": corners, "true corners": wanted, "off, cm": 100 * float(np.mean(np.concatenate(off)))}
    return {**figures, "redrawn": float(sum(drawn.columns["regularized"]))}, _made(made)


@cache
def _traced_houses(kind: str, cell: float, noise: float, seed: int) -> tuple[list, LayerFeatures]:
    """Return houses and their outlines traced from cells whose middles have noise (m)."""
    rng = np.random.default_rng(seed)
    if kind == "rows":
        deep = rng.uniform(8, 12, 12).round(1)
        houses = [[box(6.0 * k, 30.0 * j, 6, deep[4 * j + k])] for j in range(3) for k in range(4)]
    elif kind == "village":
        houses = _footprints_of_village().geometries
    else:
        court = [box(0, 0, 20, 16), box(6, 5, 7, 6)[::-1]]
        round_ = 8.0 * np.column_stack([np.cos(turn := np.linspace(0, 2 * np.pi, 91)), np.sin(turn)]) + [40, 10]
        stepped = np.array([[0, 0], [12, 0], [12, 5], [13.2, 5], [13.2, 8], [12, 8], [12, 12], [0, 12], [0, 0.0]])
        thin = [box(-20, 30, 9, 1.1), box(-5, 38, 3.5, 3.0)]
        houses = [court, [round_], [stepped + [25, 30]], *([ring] for ring in thin), [box(5, 30, 14, 9)]]
    made = traced(houses, noise, seed, cell)
    if kind == "mixed":  # A part that was drawn over its house.
        houses, made = [*houses, [box(7, 32, 6, 5)]], [*made, traced([[box(7, 32, 6, 5)]], noise, seed, cell)[0]]
    return houses, LayerFeatures(made, {"id": list(range(len(made)))})


def _registered(scene: tuple[tuple[float, float, float], float, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return how far (cm) the shift of a street scan is off whose walls have noise (m), in plan and in height."""
    off, overhang, noise, seed = scene
    rng = np.random.default_rng(seed)
    air, street = (blocks.seen_from(view)[0] for view in ("airplane", "vehicle"))
    walls = facade_segments(blocks.seen_from("vehicle")[1]["facades"]).moved(-np.array(off[:2]))
    ends = (one + rng.normal(0, noise, one.shape) for one in (walls.start, walls.end))
    walls = PlanSegments(*ends, walls.owner)
    outlines = outline_segments(blocks.outlines(overhang))
    ground = air["xyz"][air["classification"] == 2]
    found = register(walls, outlines, street["xyz"] - off, ground, 3.0)
    if found is None:
        return {"walls": 0.0}, []
    plan, height = 100 * np.hypot(*(found.shift - off)[:2]), 100 * abs(found.shift[2] - off[2])
    return {"plan": float(plan), "height": float(height), "walls": float(found.walls)}, [
        found.shift,
        np.array([found.residual, found.overhang, found.walls, found.ends, found.ground]),
    ]


def _walled(scene: tuple[float, float, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return how far (cm) front corners are off of footprints that take over the walls seen from the street.

    Footprints overhang these and have noise (m), some walls were not seen, and balconies stand before some.
    """
    overhang, noise, hidden, seed = scene
    rng = np.random.default_rng(seed)
    walls = facade_segments(blocks.seen_from("vehicle")[1]["facades"])
    fronts = np.concatenate([walls.start, walls.end])
    kept = np.flatnonzero(rng.random(len(walls)) >= hidden)
    ends = [one[kept] + rng.normal(0, noise / 3, (len(kept), 2)) for one in (walls.start, walls.end)]
    if hidden:
        # A balcony of 2 m, 1.2 m before the middle of each long wall, and the wall of a yard 5 m before another.
        long = [k for k in kept if walls.length[k] > 4.0]
        middle = ((walls.start + walls.end) / 2 + 1.2 * walls.normal)[long]
        more = [middle - walls.way[long], middle + walls.way[long]]
        ends = [np.concatenate([one, other]) for one, other in zip(ends, more)]
    seen = PlanSegments(*ends, np.arange(len(ends[0])))
    layer = blocks.outlines(overhang)
    rings = [[rings[0] + np.append(off := rng.normal(0, noise, (4, 2)), off[:1], axis=0)] for rings in layer.geometries]
    made, share = fitted_to_walls(LayerFeatures(rings, layer.columns), seen)
    corners = np.concatenate([ring[:-1] for (ring,) in made.geometries])
    off = np.linalg.norm(fronts[:, None] - corners, axis=2).min(axis=1)
    figures = {"corners": 100 * float(off.mean()), "median": 100 * float(np.median(off)), "seen": float(share.mean())}
    return figures, [share, *(ring for rings in made.geometries for ring in rings)]


def _facade_lines(scene: dict[str, Any]) -> tuple[Figures, list[np.ndarray]]:
    """Return F (%) of ground and facades among the segments of a vehicle's scan lines."""
    points = _scan_lines(**scene)
    made = segment_facade_lines.stage.unpack(
        segment_facade_lines(points["xyz"], points["gps_time"], points["point_source_id"])
    )
    layer = made.layers["lines"]
    kind = np.array(["none", *layer.columns["kind"]])[made.dimensions["segment_id"]]
    figures = {
        name: _f_score(kind == name, points["classification"] == code) for name, code in (("ground", 2), ("facade", 6))
    }
    return {**figures, "segments": float(len(layer))}, [
        made.dimensions["segment_id"],
        kind == "ground",
        kind == "facade",
    ]


@cache
def _scan_lines(**scene: Any) -> dict[str, np.ndarray]:
    return simulate_street.stage.unpack(simulate_street(**scene)).dimensions


def _terrain(scene: tuple[str, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return how far the terrain around models is off (cm), its triangles, gaps along walls, and faulty solids."""
    kind, tolerance, seed = scene
    xyz, classes, footprints, true = _hillside(kind, seed)
    level = "2.3" if kind == "eaves" else "2.2"
    made = reconstruct_roofs.stage.unpack(
        reconstruct_roofs(xyz, classes, footprints, terrain_tolerance=tolerance, level_of_detail=level)
    )
    layer, items = made.layers["terrain"], made.files["cityjson"].items
    middle = np.array([ring[:3].mean(axis=0) for (ring,) in layer.geometries])
    lower, gaps = open_edges(items, layer)
    solids = [solid for one in items if not one.is_terrain for solid in one.model.best]
    figures = {
        "off": 100 * float(np.abs(middle[:, 2] - true(*middle[:, :2].T)).mean()),
        "triangles": float(len(layer)),
        "edges": float(len(lower)),
        "gaps": float(len(gaps)),
        "faults": float(sum(not _is_valid(solid) for solid in solids)),
        "level ground": float(sum(solid.kinds.count("ground") == 1 for solid in solids)),
    }
    return figures, _made(made)


def _is_valid(solid: Any) -> bool:
    try:
        assert_valid_solid(solid.vertices, solid.faces)
    except AssertionError:
        return False
    return True


@cache
def _hillside(kind: str, seed: int) -> tuple[np.ndarray, np.ndarray, LayerFeatures, Callable]:
    """Return points, classes, footprints and the height of the terrain: a town, or a house whose eaves overhang."""
    if kind == "eaves":
        xyz, classes, footprints = overhanging(SHAPES["L"], turn=20.0 + 30 * seed)
        xyz[:, 2] += 0.1 * xyz[:, 0]
        return xyz, classes, footprints, lambda x, _: 0.1 * x
    xyz, classes, footprints = town(3, seed=seed)
    rng = np.random.default_rng(seed)
    # Maps have the wall of two houses twice, a millimeter apart.
    rings = [
        [ring + np.append(off := rng.normal(0, 0.001, (4, 2)), off[:1], axis=0)] for (ring,) in footprints.geometries
    ]
    return xyz, classes, LayerFeatures(rings, footprints.columns), hill


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
    "wall_points": Task(("walls.classify_roofs", "walls.classify_walls"), _VILLAGES[:2], _wall_points),
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
            "shapes.detect_cylinders",
            "shapes.detect_spheres",
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
            "quality.changed_block",
            "quality.map_changes",
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
    "surveys": Task(
        (
            "quality.building_maps",
            "quality.compare_surveys",
            "quality.corner_matching",
            "quality.polygon_comparison",
        ),
        ((0.1, 0.0, 1), (0.3, 0.2, 2), (0.0, 0.0, 3), (0.2, 1.0, 4)),
        _surveys,
    ),
    "assess": Task(
        ("quality.assess_footprints", "quality.assess_models", "quality.building_maps", "quality.corner_matching"),
        (
            ("models", "dormer", 0.03, 0.0),
            ("models", "gable", 0.05, 0.5),
            ("models", "hip", 0.1, 0.0),
            ("footprints", 0.05, 1),
            ("footprints", 0.3, 2),
        ),
        _assessed,
    ),
    "reports": Task(("quality.report_buildings", "report"), ((1, True), (2, False)), _report),
    "regularize": Task(
        (
            "footprints.drawn_blocks",
            "footprints.outline_pieces",
            "footprints.regularize_polygons",
            "footprints.soft_shares",
        ),
        (("rows", 0.5, 0.15, 1), ("mixed", 0.5, 0.2, 2), ("mixed", 1.0, 0.0, 3), ("village", 0.3, 0.2, 4)),
        _regularized,
    ),
    "register": Task(
        ("facades.plan_segments", "facades.register_street"),
        (
            ((1.4, -0.9, 0.6), 0.4, 0.05, 1),
            ((-2.2, 2.6, -1.1), 0.2, 0.1, 2),
            ((0.3, 0.2, 0.0), 0.8, 0.02, 3),
            ((1.4, -0.9, 0.6), 1.0, 0.0, 4),
        ),
        _registered,
    ),
    "street_walls": Task(
        ("facades.facade_outline", "facades.plan_segments", "facades.street_walls"),
        ((0.2, 0.1, 0.0, 1), (0.4, 0.2, 0.25, 2), (0.4, 0.3, 0.5, 3)),
        _walled,
    ),
    "facade_lines": Task(
        ("facades.segment_facade_lines",),
        (
            {"length": 16.0, "line_rate": 10.0, "angular_step": 0.5, "seed": 2},
            {"length": 16.0, "line_rate": 20.0, "angular_step": 0.3, "stoops": 1.0, "unevenness": 0.15, "seed": 3},
        ),
        _facade_lines,
    ),
    "terrain": Task(
        ("models3d.joined_terrain", "models3d.overhangs"),
        (("town", 0.15, 0), ("town", 0.1, 5), ("eaves", 0.1, 0), ("eaves", 0.05, 1)),
        _terrain,
    ),
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
