"""Clouds of matched images, real and simulated: what the default chain finds."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import ndimage

from lidar_buildings.algorithms.cloud.asprs import VEGETATION, PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.simulation.simulate_drone_site import simulate_drone_site
from lidar_buildings.tests.builders import is_inside
from lidar_buildings.tests.real.clouds import WITH_IMAGES, detected, path_of, run_on, score, score_against, truth

from .results import Table

# Simulated sites: tunables that differ from the defaults.
SITES: dict[str, dict[str, Any]] = {
    "as by default": {"size": 110.0},
    "another": {"size": 110.0, "seed": 2},
    "steep, terraces of 2.5 m": {"size": 110.0, "seed": 3, "slope": 12.0, "terrace_height": 2.5},
    "wavy, 20 points per m²": {"size": 110.0, "seed": 4, "waves": 0.05, "density": 20.0, "rounding": 0.8},
    "halls of up to 66 m": {"size": 110.0, "seed": 5, "halls": 8, "buildings": 4.0},
}

# Side of the cells that area is counted in (m).
_CELL = 0.5


def photos() -> list[Table]:
    """Print how well the default chain does on real clouds of matched images."""
    rates = ("completeness", "correctness", "F")
    table = Table("photos", "cloud", *rates, "cells: F", "objects: compl.", "largest false, m²", "s", texts=1)
    for name in WITH_IMAGES:
        result = detected(name)
        found = score("buildings", name, result)
        points, cells = found["points"], found["cells"]["F"]
        largest = largest_false(result.cloud.get("xyz"), result.classification, truth(name))
        figures = [points[rate] for rate in rates]
        table.add(name.split("/")[1], *figures, cells, found["objects"]["completeness"], largest, result.seconds)
    return [table, _mapped_photos()]


def _mapped_photos() -> Table:
    """Print how well Map footprints does on these clouds."""
    columns = ("footprints", "cells: completeness, %", "cells: correctness, %")
    table = Table("mapped_photos", "cloud", *columns, texts=1)
    for name in WITH_IMAGES:
        table.add(name.split("/")[1], *mapped_cells(name))
    return table


def mapped_cells(name: str) -> tuple[int, float, float]:
    """Return how many footprints Map footprints makes of a real cloud, and how alike they and the buildings are (%).

    Of the cells with a building point those that hold a point in a footprint, and the reverse.
    """
    cloud = read_cloud(path_of(name))
    xyz, origin = cloud.get("xyz").copy(), cloud.origin.copy()
    outcome = run_pipeline(PIPELINES["map_footprints"], cloud)
    made = outcome.layers["wall_footprints"].geometries
    moved = xyz + (origin - outcome.cloud.origin)
    inside = np.any([np.zeros(len(xyz), bool), *(is_inside(moved[:, :2], rings) for rings in made)], axis=0)
    cell = np.unique(np.floor(xyz[:, :2] / _CELL), axis=0, return_inverse=True)[1]
    true, found = (np.bincount(cell, of) > 0 for of in (truth(name) == PointClass.BUILDING, inside))
    both = (true & found).sum()
    return len(made), 100 * float(both / true.sum()), 100 * float(both / max(found.sum(), 1))


def drone() -> list[Table]:
    """Print how well the default chain and its ground do on simulated clouds of matched images."""
    rates = ("completeness", "correctness", "F")
    columns = (
        *rates,
        "buildings",
        "found",
        "plants called building, m²/ha",
        "roofs called ground, %",
        "ground lost, %",
    )
    table = Table("drone", "site", *columns, texts=1)
    for name, tunables in SITES.items():
        table.add(name, *_figures(simulated(**tunables), tunables["size"]))
    return [table]


def simulated(**tunables: Any) -> dict[str, Any]:
    """Return the dimensions of a simulated site, and its footprints."""
    return dict(zip((*simulate_drone_site.stage.creates, "footprints"), simulate_drone_site(**tunables)))


def _figures(site: dict[str, Any], size: float) -> list[float]:
    """Return the cells of a site of a size (m) in the table of :func:`drone`."""
    true, xyz, number = site["classification"], site["xyz"], site["segment_id"]
    given = {name: site[name] for name in ("xyz", "return_number", "number_of_returns", "red", "green", "blue")}
    result = run_on(create_cloud(given))
    called, is_roof = result.classification, true == PointClass.BUILDING
    points = score_against(true, "buildings", result)["points"]
    share = np.bincount(number[is_roof], called[is_roof] == PointClass.BUILDING) / np.maximum(
        np.bincount(number[is_roof]), 1
    )
    ids = np.unique(number[is_roof])
    plants = np.isin(true, VEGETATION) & (called == PointClass.BUILDING)
    area = len(np.unique(np.floor(xyz[plants, :2] / _CELL), axis=0)) * _CELL**2
    is_ground = true == PointClass.GROUND
    return [
        *(points[rate] for rate in ("completeness", "correctness", "F")),
        len(ids),
        int((share[ids] >= 0.5).sum()),
        area / (size**2 / 1e4),
        100 * float(np.mean(called[is_roof] == PointClass.GROUND)),
        100 * float(np.mean(called[is_ground] != PointClass.GROUND)),
    ]


def largest_false(xyz: np.ndarray, called: np.ndarray, true: np.ndarray) -> float:
    """Return the area (m²) of the largest object that is called building and touches no true one."""
    column, row = np.floor((xyz[:, :2] - xyz[:, :2].min(axis=0)) / _CELL).astype(np.int64).T
    made, right = np.zeros((2, row.max() + 1, column.max() + 1), bool)
    for cells, classes in ((made, called), (right, true)):
        chosen = classes == PointClass.BUILDING
        cells[row[chosen], column[chosen]] = True
    label, count = ndimage.label(made, np.ones((3, 3)))
    numbers = np.arange(1, count + 1)
    area, touched = (ndimage.sum_labels(of, label, numbers) for of in (made, right))
    return float(np.max(np.where(touched > 0, 0.0, area), initial=0.0)) * _CELL**2
