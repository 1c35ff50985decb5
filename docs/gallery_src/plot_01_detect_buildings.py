"""
Detect buildings
================

*Detect buildings* runs with nothing set: noise, ground, heights, roofs, buildings, water and vegetation, then the
footprints, which are outlined in white.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

cloud = run_stage(STAGES["simulate_town"], size=110.0, density=12.0).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))  # as a scanner sees it
results = run_pipeline(PIPELINES["detect_buildings"], cloud)

# %%
# The points with the highest last, so that they are on top, in the colors of their classes.
found = results.cloud.take(np.argsort(results.cloud.get("xyz")[:, 2]))
colors = np.full(32, "gray", object)
colors[[2, 6, 9, 17]] = ["peru", "crimson", "deepskyblue", "orchid"]
colors[[3, 4, 5]] = ["yellowgreen", "limegreen", "forestgreen"]

plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 7))[1]
ax.scatter(*found.get("xyz")[:, :2].T, s=2, c=colors[found.get("classification")])
for rings in results.layers["footprints"].geometries:
    for ring in rings:
        ax.plot(*np.asarray(ring)[:, :2].T, color="white", linewidth=1.5)
ax.set(aspect="equal", xlabel="easting (m)", ylabel="northing (m)")
