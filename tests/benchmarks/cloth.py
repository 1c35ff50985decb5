#!/usr/bin/env python3
"""Compare "Classify ground points (cloth)" with the package cloth-simulation-filter: classes that agree, and time.

    OMP_NUM_THREADS=1 .venv/bin/python tests/benchmarks/cloth.py [size of the simulated town in m, 150]

Needs the package (pip install cloth-simulation-filter), and says so where it is absent. Both run on the same points
with the same parameters, one after the other; ``cpu`` is summed over all cores, ``s`` is the time on the wall. With
more than one thread the package's own results differ from run to run. Real clouds are compared where they are. The
table goes to ``benchmarks/cloth.json`` too.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.asprs import PointClass  # noqa: E402
from lidar_buildings.algorithms.cloud.files import read_cloud  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_town import simulate_town  # noqa: E402
from lidar_buildings.algorithms.terrain.classify_ground_cloth import classify_ground_cloth  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, Table  # noqa: E402
from lidar_buildings.tests.real.clouds import GROUND_SAMPLES, path_of  # noqa: E402

# Slopes (°) of the terrain of simulated towns.
SLOPES = (0.0, 10.0, 20.0, 30.0)

# Real clouds.
CLOUDS = (*GROUND_SAMPLES, "buildings/ahn-amsterdam-1", "buildings/ahn3-delft-4", "buildings/ign-chalet")
# Their cells (m), rigidness, and whether slopes are processed.
SETTINGS = ((1.0, 3, True), (1.0, 3, False), (1.0, 1, True), (1.4, 2, True), (1.4, 2, False))


def by_package(csf, xyz: np.ndarray, rigidness: int, cell_size: float, slope_processing: bool = True) -> np.ndarray:
    """Return which points (n,) the package calls ground, with the defaults of the stage."""
    filter_ = csf.CSF()
    filter_.params.bSloopSmooth = slope_processing
    filter_.params.cloth_resolution = cell_size
    filter_.params.rigidness = rigidness
    filter_.params.time_step = 0.65
    filter_.params.class_threshold = 0.5
    filter_.params.interations = 500
    filter_.setPointCloud(xyz - xyz.min(axis=0))
    ground, others = csf.VecInt(), csf.VecInt()
    filter_.do_filtering(ground, others, False)
    is_ground = np.zeros(len(xyz), bool)
    is_ground[np.array(ground, int)] = True
    return is_ground


def timed(work, *arguments, **tunables) -> tuple[np.ndarray, float, float]:
    """Return what ``work`` makes of its arguments, its seconds on the wall and on all cores."""
    wall, cpu = time.perf_counter(), time.process_time()
    made = work(*arguments, **tunables)
    return made, time.perf_counter() - wall, time.process_time() - cpu


def scenes(size: float) -> Iterator[tuple[str, np.ndarray, float, int, bool]]:
    """Yield simulated towns and real clouds, each with cells, rigidness and whether slopes are processed."""
    for slope in SLOPES:
        xyz = simulate_town(size=size, slope=slope)[0]
        yield from ((f"town, {slope:g}°", xyz, 0.5, rigidness, True) for rigidness in (1, 2, 3))
    for name in CLOUDS:
        if path_of(name).exists():
            xyz = read_cloud(path_of(name)).get("xyz")
            yield from ((name, xyz, *setting) for setting in SETTINGS)


def main(arguments: list[str]) -> int:
    """Print the table."""
    try:
        import CSF as csf
    except ImportError:
        print("The package cloth-simulation-filter is not installed: nothing to compare with.")
        return 0
    size = float(arguments[0]) if arguments else 150.0
    times = ("ours, s", "ours, cpu", "package, s", "package, cpu")
    settings = ("cell, m", "rigidness", "slope post-processing")
    table = Table("cloth", "cloud", *settings, "points", "agree, %", *times, texts=4)
    for name, xyz, cell_size, rigidness, slope in scenes(size):
        how = {"rigidness": rigidness, "cell_size": cell_size, "slope_processing": slope}
        theirs, their_wall, their_cpu = timed(by_package, csf, xyz, **how)
        ours, wall, cpu = timed(classify_ground_cloth, xyz, np.ones(len(xyz)), **how)
        agree = 100 * float(((ours == PointClass.GROUND) == theirs).mean())
        row = (name, f"{cell_size:g}", str(rigidness), "yes" if slope else "no")
        table.add(*row, len(xyz), agree, wall, cpu, their_wall, their_cpu, digits=3)
    print(f"\n{table.write(FOLDER)}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
