"""All classes of real clouds with whole truth: *Detect buildings* compared with Whitebox's ``classify_lidar``."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Optional

import numpy as np

from lidar_buildings.algorithms.cloud.asprs import NOISE, VEGETATION, PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.quality.confusion import class_rates, confusion, overall_accuracy
from lidar_buildings.tests.benchmarks.results import Table
from lidar_buildings.tests.real.clouds import path_of, run_on, truth

WITH_CLASSES = (
    "buildings/ahn3-delft-4",
    "buildings/amsterdam-centre-10",
    "buildings/ahn-amsterdam-1",
    "buildings/ign-stbarth-4",
    "buildings/ign-chalet",
    "buildings/ign-forest-none",
    "buildings/ign-bridge-none",
)

# Classes that count as one. Points of other true classes, such as 1, are left out.
MERGED = {
    "ground": (PointClass.GROUND,),
    "plants": VEGETATION,
    "buildings": (PointClass.BUILDING,),
    "water": (PointClass.WATER,),
    "wires": (PointClass.WIRE_CONDUCTOR, PointClass.TRANSMISSION_TOWER),
    "noise": NOISE,
}

# The environment variable that names a Python with the package whitebox_workflows; by default it is this one.
WHITEBOX = "WHITEBOX_PYTHON"
_BY_WHITEBOX = """
import sys, whitebox_workflows
environment = whitebox_workflows.WbEnvironment()
cloud = environment.read_lidar(sys.argv[1])
environment.write_lidar(environment.lidar.filtering_classification.classify_lidar(input=cloud), sys.argv[2])
"""


def classes() -> list[Table]:
    """Print the accuracy of merged classes and F of each, of *Detect buildings* and of Whitebox if installed."""
    figures = [f"F of {name}" for name in MERGED]
    table = Table("classes", "cloud", "program", "accuracy, %", *figures, texts=2)
    for name in WITH_CLASSES:
        for program, made in (("Detect buildings", run_on(read_cloud(path_of(name))).classification), _peer(name)):
            if made is not None:
                table.add(name.split("/")[1], program, *rates(truth(name), made))
    return [table]


def rates(true: np.ndarray, made: np.ndarray) -> list[Optional[float]]:
    """Return the accuracy of merged classes and F of each, percent; None for classes that the truth lacks."""
    is_true, is_made = (_merged(one) for one in (true, made))
    counted = is_true < len(MERGED)
    matrix = confusion(is_true[counted], is_made[counted], len(MERGED) + 1)
    f_scores = class_rates(matrix)["f"][:-1]
    return [overall_accuracy(matrix), *(float(f) if row.any() else None for f, row in zip(f_scores, matrix))]


def _merged(codes: np.ndarray) -> np.ndarray:
    """Return the number of the merged class of each point (n,), their count for others."""
    number = np.full(256, len(MERGED))
    for i, group in enumerate(MERGED.values()):
        number[list(group)] = i
    return number[codes]


def _peer(name: str) -> tuple[str, Optional[np.ndarray]]:
    """Return what Whitebox's ``classify_lidar`` makes of a cloud with nothing set; None where it is not installed."""
    python = os.environ.get(WHITEBOX, sys.executable)
    if subprocess.run([python, "-c", "import whitebox_workflows"], capture_output=True, check=False).returncode:
        print(f"No whitebox_workflows in {python}; {WHITEBOX} names a Python that has it.", file=sys.stderr)
        return "", None
    cloud = read_cloud(path_of(name))
    read = ("xyz", "return_number", "number_of_returns", "intensity", "gps_time")
    with tempfile.TemporaryDirectory() as folder:
        plain, classified = Path(folder) / "plain.las", Path(folder) / "classified.las"
        write_cloud(create_cloud({one: cloud.get(one) for one in read if cloud.has(one)}), plain)
        subprocess.run([python, "-c", _BY_WHITEBOX, str(plain), str(classified)], check=True, stdout=sys.stderr)
        return "Whitebox classify_lidar", read_cloud(classified).get("classification")
