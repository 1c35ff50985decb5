#!/usr/bin/env python3
"""Repeat the experiment of Weinmann et al. (2017) on a simulated flight, and time the voxel grid.

    structure.py flight             merge, voxels, features with k = 50 and k_opt, shares of dimensionality
    structure.py flight --part 0.1  the same with a tenth of the scan lines
    structure.py voxels             10 million points: the voxel grid in units of reading them from LAZ
    structure.py                    both

Shares and counts are the same on every machine. Times are not: only ratios tell, which are of one run, the two
measured in turns, the best of some of each.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Callable

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.asprs import PointClass  # noqa: E402
from lidar_buildings.algorithms.cloud.cloud import Cloud, read_cloud, write_cloud  # noqa: E402
from lidar_buildings.algorithms.packages import spatial  # noqa: E402
from lidar_buildings.algorithms.run import run_stage  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402

LINES = STAGES["simulate_flight"].tunables["line_rate"].default
NEIGHBORHOODS = {"k = 50": {"neighborhood": "nearest", "n_neighbors": 50}, "k_opt": {"neighborhood": "optimal"}}
FEATURES = ("linearity", "planarity", "scattering", "optimal_neighbors")
OBJECTS = {
    "ground": (PointClass.GROUND,),
    "buildings": (PointClass.BUILDING,),
    "trees": (PointClass.LOW_VEGETATION, PointClass.MEDIUM_VEGETATION, PointClass.HIGH_VEGETATION),
}

# A town of so much (m) has 10 million points at this density (pulses per m²).
TOWN = {"size": 588.0, "density": 25.0}
ROUNDS = 4


def made(name: str, cloud: Any = None, **tunables: Any) -> Cloud:
    """Return the cloud that a stage makes."""
    result = run_stage(STAGES[name], cloud, **tunables).cloud
    assert result is not None
    return result


def flight(part: float) -> None:
    """Print how many points there are at each step, and what they are called with both neighborhoods."""
    scans = [
        made("simulate_flight", scanners=scanner, line_rate=LINES * part) for scanner in ("horizontal", "vertical")
    ]
    union = made("merge_clouds", scans)
    voxels = made("downsample_voxels", union)
    counts = [len(cloud) for cloud in (*scans, union, voxels)]
    print("| | horizontal scanner | vertical scanner | merged | voxels of 0.1 m | left |\n| --- |" + " ---: |" * 5)
    print("| published | 1.44 million | 5.29 million | 6.73 million | 310 thousand | 4.6 % |")
    print("| here | " + " | ".join(f"{count:,d}" for count in counts) + f" | {100 * counts[3] / counts[2]:.1f} % |\n")
    print("| neighborhood | points | linear | planar | volumetric | unlike their nearest | median k | s |")
    print("| --- | --- |" + " ---: |" * 6)
    xyz, classes = voxels.get("xyz"), voxels.get("classification")
    nearest = spatial.cKDTree(xyz).query(xyz, 2, workers=-1)[1][:, 1]
    for name, tunables in NEIGHBORHOODS.items():
        start = time.perf_counter()
        cloud = made("compute_features", voxels, features=FEATURES, **tunables)
        seconds = time.perf_counter() - start
        kinds = made("classify_dimensionality", cloud).get("dimensionality")
        k = cloud.get("optimal_neighbors")
        which = {"all": np.ones(len(xyz), bool), **{one: np.isin(classes, of) for one, of in OBJECTS.items()}}
        for of, mask in which.items():
            share = 100 * np.bincount(kinds[mask], minlength=4) / mask.sum()
            rough = 100 * np.mean(kinds[mask] != kinds[nearest[mask]])
            figures = " | ".join(f"{value:.1f}" for value in (*share[1:], rough))
            took = f"{seconds:.1f}" if of == "all" else ""
            print(f"| {name} | {of} | {figures} | {np.median(k[mask]):.0f} | {took} |", flush=True)


def voxels() -> None:
    """Print what the voxel grid takes, in units of reading the file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "town.laz"
        write_cloud(made("simulate_town", **TOWN), path)
        reads, grids = [], []
        for _ in range(ROUNDS):
            took, cloud = timed(lambda: read_cloud(path))
            reads.append(took)
            took, left = timed(lambda cloud=cloud: made("downsample_voxels", cloud))
            grids.append(took)
    print(f"\n{len(cloud):,d} points, {len(left):,d} voxels of 0.1 m\n\n| | s | cpu s |\n| --- | ---: | ---: |")
    best = [np.min(rows, axis=0) for rows in (reads, grids)]
    for name, row in (("read LAZ", best[0]), ("voxel grid", best[1]), ("ratio", best[1] / best[0])):
        print(f"| {name} | {row[0]:.2f} | {row[1]:.2f} |")


def timed(work: Callable[[], Cloud]) -> tuple[tuple[float, float], Cloud]:
    """Return the seconds on the wall and over all cores that ``work`` takes, and what it makes."""
    start, start_cpu = time.perf_counter(), time.process_time()
    result = work()
    return (time.perf_counter() - start, time.process_time() - start_cpu), result


def main() -> None:
    """Print what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", choices=["flight", "voxels", []], help="which tables (both)")
    parser.add_argument("--part", type=float, default=1.0, help="share of the scan lines of the flight (1)")
    chosen = parser.parse_args()
    if "flight" in (chosen.parts or ["flight"]):
        flight(chosen.part)
    if "voxels" in (chosen.parts or ["voxels"]):
        voxels()


if __name__ == "__main__":
    main()
