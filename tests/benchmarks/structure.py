#!/usr/bin/env python3
"""Repeat the experiment of Weinmann et al. (2017) on a simulated flight; voxel grids, plants and surfaces of size.

    structure.py flight             merge, voxels, features with k = 50 and k_opt, shares of dimensionality
    structure.py flight --part 0.1  the same with a tenth of the scan lines
    structure.py voxels             10 million points: the voxel grid in units of reading them from LAZ
    structure.py plant              Model industry on a plant of 200 pipes, 3 tanks and 4 spheres
    structure.py plant --part 0.2   the same with a fifth of the pipes, one tank and one sphere
    structure.py surfaces           Segment surfaces on 20 million points: processor time and memory
    structure.py surfaces --part 0.2  the same on a fifth of them
    structure.py                    all
    structure.py --output folder    where the JSON files go (benchmarks)

Shares and counts are the same on every machine. Times are not: their ratios are compared, which are of one run, the two
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
from lidar_buildings.algorithms.cloud.asprs import VEGETATION, PointClass  # noqa: E402
from lidar_buildings.algorithms.cloud.cloud import Cloud, create_cloud  # noqa: E402
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud  # noqa: E402
from lidar_buildings.algorithms.packages import spatial  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline, run_stage  # noqa: E402
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling  # noqa: E402
from lidar_buildings.algorithms.segmentation.segment_surfaces import segment_surfaces  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant  # noqa: E402
from lidar_buildings.algorithms.stage import LayerFeatures  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, Table  # noqa: E402
from lidar_buildings.tests.benchmarks.surveys import Memory  # noqa: E402
from lidar_buildings.tests.industry import compared  # noqa: E402

LINES = STAGES["simulate_flight"].tunables["line_rate"].default
NEIGHBORHOODS = {"k = 50": {"neighborhood": "nearest", "n_neighbors": 50}, "k_opt": {"neighborhood": "optimal"}}
FEATURES = ("linearity", "planarity", "scattering", "optimal_neighbors")
OBJECTS = {
    "ground": (PointClass.GROUND,),
    "buildings": (PointClass.BUILDING,),
    "trees": VEGETATION,
}

# A town of this size (m) has 10 million points at this density (pulses per m²).
TOWN = {"size": 588.0, "density": 25.0}

# Runs of reading and of the voxel grid, in turns; the fastest counts.
ROUNDS = 4

# Towns of a million points each (8 pulses per m²), side by side.
TOWNS = 18

# Side of such a town, m.
TOWN_SIDE = 345.0


def made(name: str, cloud: Any = None, **tunables: Any) -> Cloud:
    """Return the cloud that a stage makes."""
    result = run_stage(STAGES[name], cloud, **tunables).cloud
    assert result is not None
    return result


def flight(part: float) -> list[Table]:
    """Print how many points there are at each step, and what they are called with both neighborhoods."""
    scans = [
        made("simulate_flight", scanners=scanner, line_rate=LINES * part) for scanner in ("horizontal", "vertical")
    ]
    union = made("merge_clouds", scans)
    voxels = made("downsample_voxels", union)
    counts = [len(cloud) for cloud in (*scans, union, voxels)]
    scanners = ("horizontal scanner", "vertical scanner")
    steps = Table("flight_points", "points", *scanners, "merged", "voxels of 0.1 m", "left, %")
    steps.add("published", 1_440_000, 5_290_000, 6_730_000, 310_000, 4.6)
    steps.add("simulated", *counts, 100 * counts[3] / counts[2])
    shares = ("linear, %", "planar, %", "volumetric, %", "unlike their nearest, %")
    table = Table("flight_dimensionality", "neighborhood", "points", *shares, "median k", "s", texts=2)
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
            took = seconds if of == "all" else None
            table.add(name, of, *share[1:].tolist(), float(rough), int(np.median(k[mask])), took)
    return [steps, table]


def voxels() -> list[Table]:
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
    print(f"\n{len(cloud):,d} points, {len(left):,d} voxels of 0.1 m")
    table = Table("voxels", "step", "s", "cpu s")
    best = [np.min(rows, axis=0) for rows in (reads, grids)]
    for name, row in (("read LAZ", best[0]), ("voxel grid", best[1]), ("ratio", best[1] / best[0])):
        table.add(name, *row.tolist(), digits=2)
    return [table]


def plant(part: float) -> list[Table]:
    """Print how many pipes of a simulated plant Model industry finds, how many it invents, and what it takes."""
    pipes = max(1, round(200 * part))
    xyz, classification, true_id, _, true_axes, true_centers = simulate_plant(
        pipes=pipes, tanks=max(1, round(3 * part)), spheres=max(1, round(4 * part))
    )
    start, start_cpu = time.perf_counter(), time.process_time()
    made_of = run_pipeline(PIPELINES["model_industry"], create_cloud({"xyz": xyz, "classification": classification}))
    took, took_cpu = time.perf_counter() - start, time.process_time() - start_cpu
    assert made_of.cloud is not None
    result = compared(true_id, true_axes, made_of.cloud.get("segment_id"), made_of.layers["axes"])
    is_pipe = np.array(true_axes.columns["kind"]) == "pipe"
    columns = (
        "found",
        "of",
        "invented",
        "pieces too many",
        "radius off by (median), %",
        "by (95 %), %",
        "points",
        "s",
        "cpu s",
    )
    table = Table("plant", "what", *columns)
    errors = (100 * np.percentile(result.error, [50, 95])).tolist() if len(result.error) else [None, None]
    table.add(
        "pipes of 5 to 60 cm",
        int(result.is_found[is_pipe].sum()),
        int(is_pipe.sum()),
        len(result.invented),
        len(made_of.layers["axes"]) - len(result.invented) - int(result.is_found.sum()),
        *errors,
        len(xyz),
        took,
        took_cpu,
        digits=2,
    )
    table.add("tanks", int(result.is_found[~is_pipe].sum()), int((~is_pipe).sum()), *[None] * 7)
    table.add("spheres", *_spheres_found(true_centers, made_of.layers["centers"]), *[None] * 6)
    return [table]


def _spheres_found(true: LayerFeatures, found: LayerFeatures) -> tuple[int, int, int]:
    """Return how many true spheres are found with center and radius within 5 % of it, of how many, and others found."""
    center, radius = np.array(true.geometries).reshape(-1, 3), np.array(true.columns["radius"])
    other, size = np.array(found.geometries).reshape(-1, 3), np.array(found.columns["radius"])
    off = np.linalg.norm(center[:, None] - other, axis=2)
    same = (np.maximum(off, np.abs(radius[:, None] - size)) <= 0.05 * radius[:, None]).astype(bool)
    return int(same.any(axis=1).sum()), len(center), int((~same.any(axis=0)).sum())


def surfaces(part: float) -> list[Table]:
    """Print what Segment surfaces takes on towns side by side: processor time, and memory beyond the cloud."""
    town = made("simulate_town", size=TOWN_SIDE).get("xyz").round(3)
    count = max(1, round(TOWNS * part))
    xyz = np.empty((count * len(town), 3))
    for number in range(count):
        xyz[number * len(town) : (number + 1) * len(town)] = town + [number * TOWN_SIDE, 0, 0]
    classification = np.ones(len(xyz), np.uint8)
    sampling = CloudSampling.of(xyz, classification)
    tunables = {"noise": sampling.noise, "density": sampling.surface_density}
    table = Table("surfaces", "planarity", "points", "segments", "cpu µs per point", "bytes per point beyond the cloud")
    for planarity in ("local", "global"):
        start_cpu = time.process_time()
        with Memory() as memory:
            time.sleep(1)
            before = memory.peak
            ids = segment_surfaces(xyz, classification, planarity=planarity, **tunables)
        each = (time.process_time() - start_cpu) / len(xyz), (memory.peak - before) / len(xyz)
        table.add(planarity, len(xyz), int(ids.max()), 1e6 * each[0], each[1])
    return [table]


def timed(work: Callable[[], Cloud]) -> tuple[tuple[float, float], Cloud]:
    """Return the seconds on the wall and over all cores that ``work`` takes, and what it makes."""
    start, start_cpu = time.perf_counter(), time.process_time()
    result = work()
    return (time.perf_counter() - start, time.process_time() - start_cpu), result


# Tables by name, for a share of the scan lines, of the plant or of the towns.
TABLES: dict[str, Callable[[float], list[Table]]] = {
    "flight": flight,
    "voxels": lambda _: voxels(),
    "plant": plant,
    "surfaces": surfaces,
}


def main() -> None:
    """Print the tables that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", choices=[*TABLES, []], help="which tables (all)")
    parser.add_argument("--part", type=float, default=1.0, help="share of the scan lines or of the plant (1)")
    parser.add_argument("--output", type=Path, default=FOLDER, help="folder of the JSON files (benchmarks)")
    chosen = parser.parse_args()
    for name in chosen.tables or TABLES:
        for table in TABLES[name](chosen.part):
            print(table.write(chosen.output))


if __name__ == "__main__":
    main()
