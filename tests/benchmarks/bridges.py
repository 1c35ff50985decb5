#!/usr/bin/env python3
"""Measure how well bridges are found, by kind, angle and density: ``bridges.py``.

``bridges`` has simulated ones: F (%) of the points of decks with *Segment scan lines* and *Classify ground segments*,
and with *Classify bridges* on the true ground. Of kinds that are no bridges it has the points that are called deck.
``bridges_as_buildings`` has the points called building on the same sites by *Detect buildings*, without bridges and
with them. ``real_bridges`` has real clouds, where they are, with *Classify bridges* after *Classify ground points
(TIN)*. The JSON files go to ``--output``.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.asprs import PointClass  # noqa: E402
from lidar_buildings.algorithms.cloud.cloud import create_cloud  # noqa: E402
from lidar_buildings.algorithms.cloud.files import read_cloud  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline, run_stage  # noqa: E402
from lidar_buildings.algorithms.simulation.bridge_site import KINDS  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_bridges import simulate_bridges  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, Table  # noqa: E402
from lidar_buildings.tests.real.clouds import path_of, truth  # noqa: E402

# Points per m² of simulated sites.
DENSITIES = (4.0, 8.0)

# Angles (°) of bridges to the shortest way across.
ANGLES = (0.0, 20.0, 40.0)

# Seed of the sites.
SEED = 5

# Real clouds and the classes of their bridges.
REAL = {
    "buildings/ign-bridge-none": PointClass.BRIDGE_DECK,
    "buildings/ahn3-delft": 26,
    "buildings/amsterdam-centre-10": 26,
    "buildings/ign-chalet": PointClass.BRIDGE_DECK,
    "buildings/ign-stbarth": PointClass.BRIDGE_DECK,
}

# Stages that find decks, by the ground that they are given.
CHAINS = {
    "segments": ("segment_scan_lines", "classify_ground_segments"),
    "true ground": ("classify_bridges",),
}


def decks(chain: str, xyz: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Return which points (n,) a chain of stages calls deck; the last one is given the true ground and water."""
    ground = np.isin(true, (PointClass.GROUND, PointClass.WATER)) & (chain == "true ground")
    classes = np.where(ground, np.uint8(PointClass.GROUND), np.uint8(PointClass.UNCLASSIFIED))
    cloud: Any = create_cloud({"xyz": xyz, "classification": classes})
    for name in CHAINS[chain]:
        cloud = run_stage(STAGES[name], cloud).cloud
    return cloud.get("classification") == PointClass.BRIDGE_DECK


def figure(found: np.ndarray, true: np.ndarray) -> float:
    """Return F (%) of decks; in a scene without any, the number of points that are called deck."""
    if not true.any():
        return float(found.sum())
    return 200 * float((found & true).sum()) / float(found.sum() + true.sum())


def simulated() -> Table:
    """Print the figures of simulated bridges."""
    table = Table("bridges", "kind", "points per m²", "ground", *(f"{angle:.0f}°" for angle in ANGLES), texts=3)
    for kind in KINDS:
        angles = ANGLES if KINDS[kind].decks else ANGLES[:1]
        for density in DENSITIES:
            scenes = [simulate_bridges(kind=kind, angle=angle, density=density, seed=SEED)[:2] for angle in angles]
            for chain in CHAINS:
                row = [figure(decks(chain, xyz, true), true == PointClass.BRIDGE_DECK) for xyz, true in scenes]
                table.add(kind, f"{density:g}", chain, *row, *[None] * (len(ANGLES) - len(row)))
    return table


def as_buildings() -> Table:
    """Print how many points *Detect buildings* calls building on simulated bridges, where there is no building."""
    headings = (f"{angle:.0f}°, {how}" for angle in ANGLES for how in ("without", "with"))
    table = Table("bridges_as_buildings", "kind", "points per m²", *headings, texts=2)
    for kind in (kind for kind in KINDS if KINDS[kind].decks):
        for density in DENSITIES:
            row = []
            for angle in ANGLES:
                made = simulate_bridges(kind=kind, angle=angle, density=density, seed=SEED)
                for width in (0.0, 40.0):
                    # Without the numbers of returns a scan would pass for matched images.
                    cloud = create_cloud({"xyz": made[0], "return_number": made[2], "number_of_returns": made[3]})
                    run_pipeline(PIPELINES["detect_buildings"], cloud, bridges_max_width=width)
                    row.append(int((cloud.get("classification") == PointClass.BUILDING).sum()))
            table.add(kind, f"{density:g}", *row)
    return table


def real() -> Table:
    """Print the figures of real clouds."""
    table = Table("real_bridges", "cloud", "true points", "found", "of these true", "F, %")
    for name, number in REAL.items():
        if not path_of(name).exists():
            continue
        cloud: Any = read_cloud(path_of(name))
        cloud = run_stage(STAGES["classify_ground_tin"], cloud).cloud
        cloud = run_stage(STAGES["classify_bridges"], cloud, search="gaps in the ground").cloud
        found, true = cloud.get("classification") == PointClass.BRIDGE_DECK, truth(name) == number
        f_score = figure(found, true) if true.any() else None
        table.add(name.split("/")[1], int(true.sum()), int(found.sum()), int((found & true).sum()), f_score)
    return table


def main() -> None:
    """Print the tables and write them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=FOLDER)
    folder = parser.parse_args().output
    for table in (real(), simulated(), as_buildings()):
        table.write(folder)


if __name__ == "__main__":
    main()
