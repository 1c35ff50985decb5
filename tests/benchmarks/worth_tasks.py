#!/usr/bin/env python3
"""Measure what each constant of a task other than *Detect buildings* is worth: ``worth_tasks.py TASK …``.

A task is measured on scenes with its own truth. Each constant of its rooms is set to 0 and to five times its value. The
table says in how many scenes the result changes at all, and how good it is then. A constant that changes no result
anywhere is a candidate for removal, until a scene of the case that it was written for, or a test, says otherwise.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import importlib
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.cloud import create_cloud  # noqa: E402
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline  # noqa: E402
from lidar_buildings.algorithms.shapes.segment_planes_hough import segment_planes_hough  # noqa: E402
from lidar_buildings.algorithms.shapes.segment_tree import segment_tree  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_tree import simulate_tree  # noqa: E402
from lidar_buildings.algorithms.stage import LayerFeatures  # noqa: E402
from lidar_buildings.algorithms.walls.extract_wall_footprints import extract_wall_footprints  # noqa: E402
from lidar_buildings.tests.benchmarks.models import MAP, _outlines  # noqa: E402
from lidar_buildings.tests.benchmarks.results import ROOT, Table  # noqa: E402
from lidar_buildings.tests.benchmarks.worth import PACKAGE, Rule, _assigned, _numbers, _with  # noqa: E402
from lidar_buildings.tests.industry import compared  # noqa: E402
from lidar_buildings.tests.real.clouds import DELFT, detected  # noqa: E402
from lidar_buildings.tests.villages import corner_distances, mapped, village  # noqa: E402

# What constants are multiplied by.
FACTORS = (0.0, 5.0)

Figures = dict[str, float]


@dataclass(frozen=True)
class Task:
    """A task: the rooms or modules that it is made of, its scenes, and what measures it on one."""

    modules: tuple[str, ...]
    scenes: tuple[Any, ...]
    measure: Callable[[Any], tuple[Figures, list[np.ndarray]]]


def _walls(scene: tuple[float, float, int]) -> tuple[Figures, list[np.ndarray]]:
    """Return how many buildings of a village have a footprint, how many are invented, and how far corners are off."""
    cloud, true, _ = _village(*scene)
    names = ("xyz", "cluster_id", "wall_of", "classification")
    made = extract_wall_footprints(**{name: cloud.get(name) for name in names})[0]
    distances, used = corner_distances(made, true)
    off = 100 * np.concatenate([*distances, np.zeros(0)])
    figures = {"found": len(distances), "invented": len(made) - len(used), "corners": float(off.mean())}
    return figures, [ring for rings in made.geometries for ring in rings]


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
    xyz, classes, true, _, axes, _ = simulate_plant(**{**scene, "pipes": 12, "tanks": 1, "spheres": 2})
    made = run_pipeline(PIPELINES["model_industry"], create_cloud({"xyz": xyz, "classification": classes}))
    assert made.cloud is not None
    found = made.cloud.get("segment_id")
    result = compared(true, axes, found, made.layers["axes"])
    figures = {"pipes": float(result.is_found.sum()), "invented": len(result.invented)}
    return {**figures, "spheres": len(made.layers["centers"])}, [found, made.cloud.get("shape")]


def _hough(scene: tuple[int, str]) -> tuple[Figures, list[np.ndarray]]:
    """Return what share of the points of a part of Delft is on planes."""
    cloud = detected(DELFT).cloud
    xyz = cloud.get("xyz")
    part = np.flatnonzero((np.abs(xyz[:, :2] - np.median(xyz[:, :2], axis=0) - scene[0]) < 25).all(axis=1))
    found = segment_planes_hough(xyz[part], np.zeros(len(part), np.uint8), method=scene[1])[0]
    return {"on planes, %": 100 * float((found > 0).mean()), "planes": float(found.max())}, [found]


def _models(scene: tuple[int, float]) -> tuple[Figures, list[np.ndarray]]:
    """Return how well models of a part of Delft's base map explain its points."""
    part, keep = scene
    xyz, classes, outlines = _cut(part, keep)
    made = reconstruct_roofs.stage.unpack(reconstruct_roofs(xyz, classes, outlines))
    columns = made.layers["buildings"].columns
    figures = {"rms, cm": 100 * float(np.mean(columns["rms"])), "explained": float(np.mean(columns["explained"]))}
    figures["2.2"] = columns["level"].count("2.2")
    return figures, [ring for rings in made.layers["roofs"].geometries for ring in rings]


@cache
def _cut(part: int, keep: float) -> tuple[np.ndarray, np.ndarray, LayerFeatures]:
    """Return the points and classes of a square of Delft, and the houses of the base map in it."""
    found = detected(DELFT)
    outlines, xyz = _outlines(MAP, found.cloud.origin), found.cloud.get("xyz")
    middles = np.array([rings[0].mean(axis=0) for rings in outlines.geometries])
    center = np.median(middles, axis=0) + (30.0 * part, -20.0 * part)
    chosen = np.flatnonzero((np.abs(middles - center) < 30.0).all(axis=1)).tolist()
    near = (np.abs(xyz[:, :2] - center) < 60.0).all(axis=1)
    rows = np.flatnonzero(near & (np.random.default_rng(0).random(len(xyz)) < keep))
    return (
        xyz[rows],
        found.classification[rows],
        LayerFeatures([outlines.geometries[i] for i in chosen], {"id": chosen}),
    )


TASKS = {
    "walls": Task(("walls",), ((50.0, 0.05, 2), (25.0, 0.04, 11)), _walls),
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
            "shapes.detect_spheres",
            "shapes.surface_normals",
            "shapes.search_settings",
            "shapes.searched_points",
            "shapes.shape_windows",
            "shapes.cylinder_evidence",
            "shapes.cylinder_fits",
            "shapes.joined_pieces",
        ),
        ({"seed": 1}, {"seed": 2, "noise": 0.008}),
        _plant,
    ),
    "hough": Task(
        ("shapes.segment_planes_hough", "shapes.hough_planes"),
        ((0, "points"), (0, "normals"), (40, "points")),
        _hough,
    ),
    "models": Task(("models3d",), ((1, 0.4),), _models),
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
    digest = hashlib.sha256(b"".join(np.ascontiguousarray(np.round(one, 6)).tobytes() for one in results))
    return figures, digest.hexdigest()


def main() -> None:
    """Measure the tasks that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", nargs="+", choices=TASKS)
    parser.add_argument("--rule", nargs="*", default=[""], help="parts of names of constants")
    chosen = parser.parse_args()
    for name in chosen.task:
        task = TASKS[name]
        rules = [Rule("usual"), *(r for r in _rules(task) if any(part in r.name for part in chosen.rule))]
        table = Table(f"worth_{name}", "rule", "scenes changed", "figures", texts=3)
        usual = [measured((name, scene, rules[0])) for scene in task.scenes]
        for rule in rules:
            found = [measured((name, scene, rule)) for scene in task.scenes]
            changed = sum(one[1] != other[1] for one, other in zip(found, usual))
            figures = "; ".join(" ".join(f"{k} {v:.2f}" for k, v in one.items()) or digest for one, digest in found)
            table.add(rule.name, str(changed), figures if changed or rule is rules[0] else "")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
