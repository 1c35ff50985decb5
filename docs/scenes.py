"""Simulated scenes and views that the examples share."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

# Colors of the ASPRS classes.
COLORS = {
    0: "#bbbbbb",
    1: "#bbbbbb",
    2: "#a8793f",
    3: "#9ccc65",
    4: "#66bb6a",
    5: "#2e7d32",
    6: "#e53935",
    7: "#000000",
}
COLORS.update({9: "#42a5f5", 14: "#8e24aa", 15: "#5e35b1", 17: "#90a4ae", 18: "#000000"})


def simulated(stage: str, **tunables):
    """Return the results of a simulating stage: ``cloud`` and ``layers``."""
    return run_stage(STAGES[stage], **tunables)


def town(size: float = 80.0, density: float = 8.0, **tunables):
    """Return the cloud of a simulated town, without classes, and its true classes."""
    shown = {"buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False, "noise_points": 0.0, **tunables}
    cloud = simulated("simulate_town", size=size, density=density, **shown).cloud
    truth = cloud.get("classification").copy()
    cloud.set("classification", np.zeros(len(cloud), np.uint8))
    return cloud, truth


def after(pipeline: str, cloud, **tunables):
    """Return the results of a composite on a cloud."""
    return run_pipeline(PIPELINES[pipeline], cloud, **tunables)


def step(stage: str, cloud, **tunables):
    """Return the results of a stage on a cloud."""
    return run_stage(STAGES[stage], cloud, **tunables)


def plan(cloud, values=None, title: str = "", size: float = 2.0, ax=None, **options):
    """Draw points from above, the highest last, colored by values or by their classes."""
    ax = ax or plt.subplots(figsize=(7, 6))[1]
    xyz = cloud.get("xyz")
    order = np.argsort(xyz[:, 2], kind="stable")
    if values is None:
        colors = np.array([COLORS.get(int(code), "#bbbbbb") for code in cloud.get("classification")])[order]
        ax.scatter(*xyz[order, :2].T, s=size, c=colors, linewidths=0)
    else:
        drawn = ax.scatter(*xyz[order, :2].T, s=size, c=np.asarray(values)[order], linewidths=0, **options)
        if "cmap" in options:
            plt.colorbar(drawn, ax=ax, shrink=0.7)
    ax.set(aspect="equal", title=title, xlabel="easting (m)", ylabel="northing (m)")
    return ax


def group_colors(ids) -> np.ndarray:
    """Return a color (n, 4) for each id, gray for 0."""
    colors = plt.get_cmap("tab20")(np.asarray(ids) * 7 % 20)
    colors[np.asarray(ids) == 0] = (0.85, 0.85, 0.85, 1.0)
    return colors


def profile(cloud, low: float = -np.inf, high: float = np.inf, title: str = "", aspect: str = "equal"):
    """Draw the points of a strip from the side."""
    xyz = cloud.get("xyz")
    inside = (xyz[:, 1] >= low) & (xyz[:, 1] <= high)
    ax = plt.subplots(figsize=(8, 3.2))[1]
    colors = np.array([COLORS.get(int(code), "#bbbbbb") for code in cloud.get("classification")])
    ax.scatter(xyz[inside, 0], xyz[inside, 2], s=3, c=colors[inside], linewidths=0)
    ax.set(aspect=aspect, title=title, xlabel="m", ylabel="elevation (m)")
    return ax


def outlines(ax, features, **options):
    """Draw the rings of polygons."""
    for rings in features.geometries:
        for ring in rings:
            ax.plot(*np.asarray(ring)[:, :2].T, **{"color": "black", "linewidth": 1.2, **options})
