"""Real clouds with their truth, the results of stages and chains on them, and the scores."""

from __future__ import annotations

import functools
import importlib.util
import os
import time
import warnings
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.cloud import Cloud, create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.sampling.density import point_density
from lidar_buildings.algorithms.stage import LayerFeatures
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.shared_results import made_once

# A folder next to the checkout, or wherever the variable says: clouds with their truth, in folders by subject.
DATA = Path(os.environ.get("LIDAR_BUILDINGS_DATA", Path(__file__).resolve().parents[3] / "shared" / "data"))
SCORER = DATA.parent / "tools" / "score.py"

# The clouds of the tables, as "<folder>/<cloud>".
DELFT = "buildings/ahn3-delft"
WITH_BUILDINGS = (
    DELFT,
    "buildings/ahn3-delft-4",
    "buildings/ign-stbarth",
    "buildings/ign-stbarth-4",
    "buildings/ahn-amsterdam-1",
    "buildings/ign-chalet",
    "buildings/amsterdam-centre-10",
)
WITHOUT_BUILDINGS = ("buildings/ign-forest-none", "buildings/ign-bridge-none")

# Of these, those that take long and show what a quicker one shows too.
SLOW = ("buildings/ahn3-delft-4", "buildings/ign-stbarth", "buildings/ign-chalet", "buildings/ign-bridge-none")

# Clouds matched from a drone's images: no returns, closed crowns.
WITH_IMAGES = ("photo/uk-photo-100", "photo/brighton-beach")

# Samples of the filter test of ISPRS WG III/3, and a town.
GROUND_SAMPLES = tuple(f"ground/samp{number}" for number in (11, 12, 22, 31, 41, 52, 53, 61))
GROUND_IN_TOWN = (DELFT,)

# A cloud with the points that its makers rejected.
OUTLIERS = "outliers/ign-crop3"

# Side (m) of the cells in which the area called building is counted: every roof cell should hold a point.
_CELL = 0.5

# The side (m) in sparse clouds.
_SPARSE_CELL = 1.0

# Density (points/m²) up to which a cloud is sparse.
_SPARSE_DENSITY = 6.0


@dataclass(frozen=True)
class Result:
    """What a stage or chain made of a cloud, with nothing set, and how long it took (s)."""

    cloud: Cloud
    layers: dict[str, LayerFeatures]
    seconds: float

    @property
    def classification(self) -> np.ndarray:
        return self.cloud.get("classification")

    @property
    def area(self) -> float:
        """Area (m²) of the cells with a point that is called building."""
        xyz = self.cloud.get("xyz")
        cell = _CELL if point_density(xyz) > _SPARSE_DENSITY else _SPARSE_CELL
        plan = xyz[self.classification == PointClass.BUILDING, :2]
        return len(np.unique(np.floor(plan / cell), axis=0)) * cell**2


def each(names: Iterable[str], slow: Collection[str] = SLOW) -> list:
    """Return clouds as parameters of a test, the slow ones marked."""
    return [pytest.param(name, marks=[pytest.mark.slow] if name in slow else []) for name in names]


def path_of(name: str) -> Path:
    """Return the file of ``<folder>/<cloud>``."""
    return DATA / f"{name}.laz"


def truth(name: str) -> np.ndarray:
    """Return the true classes, in the order of the points."""
    with np.load(DATA / f"{name}.truth.npz") as arrays:
        return arrays["classification"]


def detected(name: str, pipeline: str = "detect_buildings") -> Result:
    """Run a chain; once per run of the tests, since it takes its time. Don't change what it returns."""
    return _detected(name, pipeline)


@functools.cache
def _detected(name: str, pipeline: str) -> Result:
    return made_once(f"{pipeline} of {name}", lambda: run_on(read_cloud(path_of(name)), pipeline))


def run_on(cloud: Cloud, pipeline: str = "detect_buildings") -> Result:
    """Run a chain on a cloud, which it changes."""
    start = time.perf_counter()
    outcome = run_pipeline(PIPELINES[pipeline], cloud)
    return Result(cloud, outcome.layers, time.perf_counter() - start)


@functools.cache
def classified(name: str, stage: str) -> Result:
    """Run a single stage; once per session. Don't change what it returns."""
    cloud = read_cloud(path_of(name))
    start = time.perf_counter()
    outcome = run_stage(STAGES[stage], cloud)
    return Result(cloud, outcome.layers, time.perf_counter() - start)


def made_harder(
    name: str, keep: float = 1.0, noise: float = 0.0, returns: bool = True, step: float = 0.0
) -> tuple[Cloud, np.ndarray]:
    """Return a cloud with a share of its points, noise or steps in its heights (m), and returns or none; and its truth.

    The same every time. Other dimensions of the file are left out.
    """
    cloud, rng = read_cloud(path_of(name)), np.random.default_rng(0)
    kept = rng.random(len(cloud)) < keep
    xyz = cloud.get("xyz")[kept]
    xyz[:, 2] += rng.normal(0.0, noise, len(xyz))
    if step:
        xyz[:, 2] = np.round(xyz[:, 2] / step) * step
    counted = ("return_number", "number_of_returns") if returns else ()
    return create_cloud({"xyz": xyz, **{name: cloud.get(name)[kept] for name in counted}}), truth(name)[kept]


def score(what: str, name: str, result: Result) -> dict:
    """Return the scores (%) of "buildings", "ground" or "noise", by the program that lies with the data."""
    return score_against(truth(name), what, result)


def score_against(true: np.ndarray, what: str, result: Result) -> dict:
    """Return the scores of a result whose true classes are given; see :func:`score`."""
    return _scorer().SCORES[what](result.cloud.get("xyz"), result.classification, true)


@functools.cache
def _scorer() -> ModuleType:
    spec = importlib.util.spec_from_file_location("score_of_real_clouds", SCORER)
    module = importlib.util.module_from_spec(spec)
    with warnings.catch_warnings():
        # It imports laspy, which imports pyproj, which may complain about its own installation.
        warnings.simplefilter("ignore")
        spec.loader.exec_module(module)
    return module
