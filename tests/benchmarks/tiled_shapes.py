#!/usr/bin/env python3
"""Compare facades, openings, pipes, spheres and planes of a survey in tiles with the same cloud's at once.

    tiled_shapes.py street            Model facades on a simulated street of 100 m, in blocks of 40 m
    tiled_shapes.py plant             Model industry on a simulated plant, in blocks of 20 m
    tiled_shapes.py street --part 0.5   the same on half of it
    tiled_shapes.py                   both
    tiled_shapes.py --output folder   where the JSON files go (benchmarks)

The row "cells moved" is the whole cloud with one point more, off its corner, so that cells begin elsewhere: what
differs there depends on where cells fall, not on tiles. Times are processor time; compare their ratios only.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.cloud import Cloud, create_cloud  # noqa: E402
from lidar_buildings.algorithms.cloud.files import write_cloud  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_street import simulate_street  # noqa: E402
from lidar_buildings.algorithms.stage import LayerFeatures  # noqa: E402
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles  # noqa: E402
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions  # noqa: E402
from lidar_buildings.algorithms.tiling.workers import Workers  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, Table  # noqa: E402

# Where clouds are put: edges of blocks lie anywhere on them.
PLACE = np.array([600_013.0, 5_000_017.0, 30.0])

# How far (m) the point lies off the corner that moves the cells.
OFF = np.array([0.37, 0.41, 0.23])

COLUMNS = ("features", "of the whole", "within 1 cm", "within 10 cm", "areas or lengths, %", "cpu s")


def as_cloud(xyz: np.ndarray, classification: np.ndarray) -> Cloud:
    """Return a cloud with times, which identify its points."""
    times = np.arange(len(xyz)) * 1e-5
    return create_cloud({"xyz": xyz, "classification": classification, "gps_time": times}, "EPSG:25832")


def compare(
    name: str, composite: str, xyz: np.ndarray, classification: np.ndarray, side: float, **tunables: Any
) -> Table:
    """Print how many features of the whole come again in tiles, and where cells are moved."""
    xyz = np.round(xyz + PLACE, 4)
    table = Table(name, "layer", "how", *COLUMNS, texts=2)
    pipeline = PIPELINES[composite]
    start = time.process_time()
    cloud = as_cloud(xyz, classification)
    whole, origin = run_pipeline(pipeline, cloud, **tunables).layers, cloud.origin
    took = [time.process_time() - start]
    start = time.process_time()
    moved = as_cloud(np.concatenate([[xyz.min(axis=0) - OFF], xyz]), np.append(np.uint8(1), classification))
    others = {"cells moved": (run_pipeline(pipeline, moved, **tunables).layers, moved.origin)}
    took.append(time.process_time() - start)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cloud.las"
        write_cloud(as_cloud(xyz, classification), path)
        start = time.process_time()
        options = TilesOptions(Workers(processes=1), side, compressed=False)
        outcome = run_in_tiles(pipeline, [path], Path(folder) / "tiles", options=options, **tunables)
        took.append(time.process_time() - start)
    others[f"{outcome.blocks} blocks"] = outcome.layers, outcome.survey.origin
    for layer, features in whole.items():
        table.add(layer, "whole", len(features), *[None] * 4, took[0])
        for (how, (layers, own_origin)), cpu in zip(others.items(), took[1:]):
            off = nearest(vertices(features, origin), vertices(layers[layer], own_origin))
            near = [int((off < limit).sum()) for limit in (0.01, 0.1)]
            table.add(layer, how, len(layers[layer]), len(features), *near, 100 * share(features, layers[layer]), cpu)
    return table


def vertices(features: LayerFeatures, origin: np.ndarray) -> list[np.ndarray]:
    """Return the outer vertices (m, 3) of each feature in map coordinates."""
    rings = [one[0] if isinstance(one, list) else np.atleast_2d(one) for one in features.geometries]
    return [ring + origin for ring in rings]


def nearest(first: list[np.ndarray], second: list[np.ndarray]) -> np.ndarray:
    """Return for each feature how far off (m) the most similar other one is, by the corners of their boxes."""
    one, other = (np.array([[part.min(axis=0), part.max(axis=0)] for part in some]) for some in (first, second))
    if not len(one) or not len(other):
        return np.full(len(one), np.inf)
    return np.abs(one[:, None] - other).max(axis=(2, 3)).min(axis=1)


def share(features: LayerFeatures, others: LayerFeatures) -> float:
    """Return the sum of areas, lengths or radii of features as a share of others'."""
    name = next(name for name in ("area", "length", "radius") if name in features.columns)
    return float(np.sum(others.columns[name]) / np.sum(features.columns[name]))


def street(part: float) -> Table:
    """Model facades on a street."""
    xyz, classification, *_ = simulate_street(length=max(20.0, 100.0 * part))
    return compare("tiled_street", "model_facades", xyz, np.where(classification == 2, 2, 1).astype(np.uint8), 40.0)


def plant(part: float) -> Table:
    """Model industry on a plant."""
    pipes, tanks, spheres = (max(1, round(count * part)) for count in (40, 2, 3))
    xyz, classification, *_ = simulate_plant(pipes=pipes, tanks=tanks, spheres=spheres, density=2000.0)
    return compare("tiled_plant", "model_industry", xyz, classification, 20.0, max_radius=5.0)


def main() -> None:
    """Run the measurements that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", choices=["street", "plant", []], default=[])
    parser.add_argument("--part", type=float, default=1.0)
    parser.add_argument("--output", type=Path, default=FOLDER)
    given = parser.parse_args()
    for run in (street, plant):
        if not given.what or run.__name__ in given.what:
            run(given.part).write(given.output)


if __name__ == "__main__":
    main()
