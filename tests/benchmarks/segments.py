#!/usr/bin/env python3
"""Measure every stage that segments surfaces on the same scenes: ``segments.py [scene …]``, all by default.

``gables`` are six houses with roofs of 15 to 50° and noise of 2 cm, ``lines`` the same houses in lines of a scanner,
which also *Segment recorded lines* is measured on, ``plant`` is a rack of twelve pipes with beams
and gratings. Segments are compared with the truth as Hoover et al. (1996) do, with an overlap of 0.8; true segments of
fewer than 50 points are left out. The JSON file goes to ``--output``.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any, Callable

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.asprs import PointClass  # noqa: E402
from lidar_buildings.algorithms.cloud.cloud import create_cloud  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline, run_stage  # noqa: E402
from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, Table  # noqa: E402

METHODS: dict[str, tuple[str, dict[str, Any]]] = {
    "Segment planes (RANSAC)": ("segment_planes_ransac", {"max_slope": 90.0}),
    "Segment planes (Hough), points": ("segment_planes_hough", {"method": "points"}),
    "Segment planes (Hough), normals": ("segment_planes_hough", {"method": "normals"}),
    "Segment surfaces": ("segment_surfaces", {}),
    "Segment surfaces, planes": ("segment_surfaces", {"planarity": "global"}),
    "Segment TIN planes": ("segment_tin_planes", {}),
    "Model industry": ("model_industry", {}),
}
# Methods for the scene "lines" alone: they need the lines of the scanner, here from the order of the points.
IN_LINES: dict[str, tuple[str, dict[str, Any]]] = {
    "Segment recorded lines": ("segment_recorded_lines", {}),
}
# Measures of Hoover et al.
MATCHES = ("correct", "over", "under", "missed", "noise")


# Sides of a house (m), the ridge along the first; pitches (°) of the roofs; deviation of elevations (m).
SIDES, PITCHES, NOISE = (14, 9), (15, 22, 30, 35, 42, 50), 0.02


def gables() -> tuple[np.ndarray, np.ndarray]:
    """Return points of six gable houses, 12 per m², and the roof (from 1) that each lies on."""
    return _houses(lambda rng: rng.uniform(0, SIDES, (round(SIDES[0] * SIDES[1] * 12), 2)))


def lines() -> tuple[np.ndarray, np.ndarray]:
    """Return points of the same houses in the order of a scanner's lines, 0.29 m apart across the ridges."""
    return _houses(_scanned)


def _scanned(rng: np.random.Generator) -> np.ndarray:
    """Return positions (n, 2), m, on a house in lines: a mirror that turns begins each line on the same side."""
    x, y = (along.ravel() for along in np.meshgrid(*(np.arange(0, side, 0.29) for side in SIDES), indexing="ij"))
    return np.column_stack([x + 0.01 * y, y]) + rng.normal(0, 0.01, (len(x), 2))


def _houses(positions: Callable[[np.random.Generator], np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return points of six houses, three in a row, and their roofs; ``positions`` draws those on one, m."""
    rng, parts, ids = np.random.default_rng(3), [], []
    for house, pitch in enumerate(PITCHES):
        xy, middle = positions(rng), SIDES[1] / 2
        z = 6 + np.tan(np.radians(pitch)) * (middle - np.abs(xy[:, 1] - middle)) + rng.normal(0, NOISE, len(xy))
        parts.append(np.column_stack([xy[:, 0] + 25 * (house % 3), xy[:, 1] + 20 * (house // 3), z]))
        ids.append(2 * house + 1 + (xy[:, 1] > middle))
    return np.concatenate(parts), np.concatenate(ids)


def plant() -> tuple[np.ndarray, np.ndarray]:
    """Return the points of a simulated rack without the floor, and their true segments."""
    xyz, classification, segment_id, *_ = simulate_plant(pipes=12, tanks=0, spheres=0, density=8000.0)
    above = classification != PointClass.GROUND
    return xyz[above], segment_id[above]


SCENES: dict[str, Callable[[], tuple[np.ndarray, np.ndarray]]] = {
    "gables": gables,
    "lines": lines,
    "plant": plant,
}


def segmented(name: str, tunables: dict[str, Any], xyz: np.ndarray) -> Any:
    """Return the cloud that a stage or a composite makes of points without classes."""
    cloud = create_cloud({"xyz": xyz, "classification": np.ones(len(xyz), np.uint8)})
    if name in PIPELINES:
        return run_pipeline(PIPELINES[name], cloud, **tunables).cloud
    return run_stage(STAGES[name], cloud, **tunables).cloud


def main() -> None:
    """Print the table and write it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="*", help=f"{', '.join(SCENES)}; all by default")
    parser.add_argument("--output", type=Path, default=FOLDER)
    arguments = parser.parse_args()
    table = Table("segments", "scene", "method", *MATCHES, "of", "points in correct segments, %", texts=2)
    for scene in arguments.scene or SCENES:
        xyz, truth = SCENES[scene]()
        reference = create_cloud({"xyz": xyz, "segment_id": truth.astype(np.int32)})
        methods = {**METHODS, **IN_LINES} if scene == "lines" else METHODS
        for title, (name, tunables) in methods.items():
            cloud = segmented(name, tunables, xyz)
            report = run_stage(STAGES["assess_segments"], cloud, reference, min_points=50).report
            assert report is not None
            values = report.values
            table.add(
                scene,
                title,
                *(values[match] for match in MATCHES),
                values["reference_segments"],
                values["points_correct"],
            )
    table.write(arguments.output)


if __name__ == "__main__":
    main()
