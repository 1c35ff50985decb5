"""How many decisions of a reviewer, who knows the truth, rid a result of its false buildings, and what that gains."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lidar_buildings.algorithms.buildings.reviewed_buildings import DELETED, KEPT, ReviewedBuildings
from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons, holders
from lidar_buildings.algorithms.quality.report_buildings import SURE
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.real.clouds import WITH_BUILDINGS, Result, detected, run_on, score_against, truth

from .results import Table

# Simulated towns: without return numbers and with many trees, by seed.
HARD_TOWN = {"size": 300.0, "density": 1.5, "trees": 120.0, "forest": 0.4, "slope": 12.0, "returns": False}
SEEDS = (1, 2)

# Of the scores, F of points and correctness of objects.
_RATES = (("points", "F"), ("objects", "correctness"))


def review() -> list[Table]:
    """Return decisions until no false building is left, in the order of the window and in random order, and the gain.

    A building is false if most of its points are of none.
    """
    columns = ("buildings", "false", "doubtful", "false of these", "decisions", "decisions at random")
    gains = ("F", "F after", "objects: corr.", "objects: corr. after")
    table = Table("review", "cloud", *columns, *gains)
    for name, result, true in _clouds():
        footprints = result.layers["footprints"]
        is_false = false_buildings(footprints, result, true)
        sure, count = np.array(footprints.columns["confidence"], float), int(is_false.sum())
        last = int(np.flatnonzero(is_false[np.argsort(sure)]).max(initial=-1)) + 1
        # The mean of the last of some places drawn from all.
        at_random = count * (len(sure) + 1) / (count + 1)
        is_doubtful = sure < SURE
        figures = len(sure), count, int(is_doubtful.sum()), int((is_doubtful & is_false).sum()), last, at_random
        before = score_against(true, "buildings", result)
        _delete(footprints, is_false, result)
        after = score_against(true, "buildings", result)
        f_scores, correct = ([of[kind][rate] for of in (before, after)] for kind, rate in _RATES)
        table.add(name, *figures, *f_scores, *correct, digits=2)
    return [table]


def _clouds() -> Iterator[tuple[str, Result, np.ndarray]]:
    """Yield name, result and truth of each cloud."""
    for name in WITH_BUILDINGS:
        yield name.split("/")[1], detected(name), truth(name)
    for seed in SEEDS:
        cloud = run_stage(STAGES["simulate_town"], seed=seed, **HARD_TOWN).cloud
        true = cloud.get("classification").copy()
        cloud.set("classification", np.zeros(len(cloud), np.uint8))
        yield f"town in trees {seed}", run_on(cloud), true


def false_buildings(footprints: LayerFeatures, result: Result, true: np.ndarray) -> np.ndarray:
    """Return which footprints (k,) are false."""
    own = holders(result.cloud.get("xyz")[:, :2], as_polygons(footprints.geometries), Monitor())
    own = np.where(result.classification == PointClass.BUILDING, own, -1)
    whole, right = (
        np.bincount(own[of & (own >= 0)], minlength=len(footprints)) for of in (own >= 0, true == PointClass.BUILDING)
    )
    return 2 * right < whole


def _delete(footprints: LayerFeatures, is_false: np.ndarray, result: Result) -> None:
    """Decide on all buildings, in place: false ones are deleted, all others kept."""
    decisions = np.where(is_false, DELETED, KEPT).tolist()
    reviewed = ReviewedBuildings.of(LayerFeatures(footprints.geometries, {"review": decisions}))
    cloud, height = result.cloud, result.cloud.get("height_above_ground")
    found = result.classification, cloud.get("cluster_id"), None, None
    cloud.set("classification", reviewed.decide(cloud.get("xyz"), height, found, Monitor())[0])
